(** Branches with flat stars: a flat vertex agrees with both signs. If each sign vector agrees with exactly one
    of some branches, there are no others. *)
From Coq Require Import Reals List Lra Lia Arith Bool FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Nappes Sheet Star KeyLemma Flat Complex Theorems Branches.
Import ListNotations.
Open Scope R_scope.

(** ** Sign vectors *)

Section Patterns.
Context {A : Type}.
(** The signs of the vertices on a branch: [None] where the star is flat. *)
Variable signs : A -> nat -> option bool.

Definition fits (a : A) (v : nat) (up : bool) : bool := match signs a v with Some e => Bool.eqb e up | None => true end.
Definition agree (I : list nat) (e : nat -> bool) (a : A) : bool := forallb (fun v => fits a v (e v)) I.
Definition flats (I : list nat) (a : A) : list nat :=
  filter (fun v => match signs a v with None => true | Some _ => false end) I.

(** Each sign vector agrees with exactly one element of the list. *)
Fixpoint splits (I : list nat) (l : list A) : bool :=
  match I with
  | [] => match l with [_] => true | _ => false end
  | v :: J => splits J (filter (fun a => fits a v true) l) && splits J (filter (fun a => fits a v false) l)
  end.

Lemma filter_both {B} (f g : B -> bool) l : filter f (filter g l) = filter (fun a => g a && f a) l.
Proof. induction l as [|a l IH]; [reflexivity|]. simpl. destruct (g a); simpl; rewrite IH; reflexivity. Qed.

Lemma splits_one I l : splits I l = true -> forall e, exists a, filter (agree I e) l = [a].
Proof.
  revert l. induction I as [|v I IH]; intros l H e.
  - destruct l as [|a [|b l]]; try discriminate. now exists a.
  - simpl in H. apply andb_prop in H. destruct H as (H1 & H2).
    assert (H : splits I (filter (fun a => fits a v (e v)) l) = true) by (destruct (e v); assumption).
    destruct (IH _ H e) as (a & E). exists a. now rewrite <- E, filter_both.
Qed.

Lemma agree_ext I e e' a : (forall v, In v I -> e v = e' v) -> agree I e a = agree I e' a.
Proof.
  unfold agree. induction I as [|v I IH]; intros E; [reflexivity|]. simpl. rewrite (E v) by now left.
  rewrite IH; [reflexivity|]. intros u Hu. apply E. now right.
Qed.

Lemma filter_map_length {B C} (f : C -> bool) (g : B -> C) l :
  length (filter f (map g l)) = length (filter (fun b => f (g b)) l).
Proof. induction l as [|b l IH]; [reflexivity|]. simpl. destruct (f (g b)); simpl; now rewrite IH. Qed.

Lemma filter_none {B} (l : list B) : filter (fun _ => false) l = [].
Proof. induction l; auto. Qed.

(** How many sign vectors agree with a branch. *)
Lemma agree_count I a : NoDup I ->
  length (filter (fun e => agree I e a) (sign_vectors I)) = (2 ^ length (flats I a))%nat.
Proof.
  induction I as [|v I IH]; intros D; [reflexivity|]. inversion D as [|? ? N D']; subst. specialize (IH D').
  cbn [sign_vectors]. rewrite filter_app, app_length, filter_map_length.
  rewrite (filter_ext_in (fun e => agree (v :: I) e a) (fun e => fits a v false && agree I e a)).
  2: { intros e He. unfold agree. cbn [forallb]. now rewrite (sign_vectors_off I e v He N). }
  rewrite (filter_ext (fun e => agree (v :: I) (fun u => if Nat.eqb u v then true else e u) a)
    (fun e => fits a v true && agree I e a)).
  2: { intros e. unfold agree at 1. cbn [forallb]. rewrite Nat.eqb_refl. f_equal. apply agree_ext.
       intros u Hu. destruct (Nat.eqb_spec u v) as [->|]; [contradiction|reflexivity]. }
  unfold flats in *. cbn [filter]. unfold fits. destruct (signs a v) as [[|]|]; cbn [Bool.eqb andb length Nat.pow].
  - rewrite filter_none. exact IH.
  - rewrite filter_none, Nat.add_0_r. exact IH.
  - rewrite IH. lia.
Qed.

Lemma sum_count {E} (f : A -> E -> bool) (l : list A) (t : list E) :
  list_sum (map (fun a => length (filter (f a) t)) l) =
  list_sum (map (fun e => length (filter (fun a => f a e) l)) t).
Proof.
  induction l as [|a l IH]; cbn [map list_sum fold_right filter].
  - induction t as [|e t IH]; [reflexivity|exact IH].
  - unfold list_sum in IH |- *. cbn [fold_right map]. rewrite IH. clear IH.
    induction t as [|e t IH]; [reflexivity|]. cbn [filter map fold_right].
    destruct (f a e); cbn [length]; rewrite <- IH; lia.
Qed.

(** Counted so, there are 2^n branches. *)
Lemma all_counted I l : NoDup I -> (forall e, exists a, filter (agree I e) l = [a]) ->
  list_sum (map (fun a => 2 ^ length (flats I a)) l)%nat = (2 ^ length I)%nat.
Proof.
  intros D One. rewrite <- sign_vectors_length.
  rewrite (map_ext _ (fun a => length (filter (fun e => agree I e a) (sign_vectors I))))
    by (intros a; symmetry; now apply agree_count).
  rewrite (sum_count (fun a e => agree I e a)).
  induction (sign_vectors I) as [|e t IH]; [reflexivity|]. cbn [map length].
  destruct (One e) as (a & E). unfold list_sum in *. cbn [fold_right].
  change (fun a0 => agree I e a0) with (agree I e). rewrite E, IH. reflexivity.
Qed.

(** Vertices that are flat on all branches. *)
Lemma agree_more I J e a : (forall v, In v J -> signs a v = None) -> agree (I ++ J) e a = agree I e a.
Proof.
  intros Fl. unfold agree. rewrite forallb_app. replace (forallb _ J) with true; [apply andb_true_r|].
  symmetry. apply forallb_forall. intros v Hv. unfold fits. now rewrite (Fl v Hv).
Qed.
End Patterns.

(** ** Representatives of branches *)

(** What lies in nappes of its own, alone there, is listed if each sign vector agrees with exactly one pattern. *)
Section Core.
Context {A : Type}.
Variable signs : A -> nat -> option bool.
Variable J : list nat.
Variable represents : vec -> Prop.
Variable lies_in : (nat -> bool) -> vec -> Prop.
Variable shown : A -> vec -> Prop.
Hypothesis shown_represents : forall a h, shown a h -> represents h.
Hypothesis shown_agrees : forall a h e, shown a h -> (lies_in e h <-> agree signs J e a = true).
Hypothesis lies_somewhere : forall h, represents h -> exists e, lies_in e h.
Hypothesis alone : forall e h h', represents h -> represents h' -> lies_in e h -> lies_in e h' -> h = h'.

Lemma shown_in a l hs : Forall2 shown l hs -> In a l -> exists h, In h hs /\ shown a h.
Proof.
  induction 1 as [|b h l hs Hb _ IH]; [easy|]. intros [->|Ha]; [exists h; simpl; auto|].
  destruct (IH Ha) as (g & Hg & Sg). exists g. simpl. auto.
Qed.

Lemma in_shown h l hs : Forall2 shown l hs -> In h hs -> exists a, In a l /\ shown a h.
Proof.
  induction 1 as [|b g l hs Hb _ IH]; [easy|]. intros [->|Hh]; [exists b; simpl; auto|].
  destruct (IH Hh) as (a & Ha & Sa). exists a. simpl. auto.
Qed.

Theorem all_listed l hs : (forall e, exists a, filter (agree signs J e) l = [a]) -> Forall2 shown l hs ->
  NoDup hs /\ forall h, In h hs <-> represents h.
Proof.
  intros One Hl. split.
  - assert (Le : forall e, (length (filter (agree signs J e) l) <= 1)%nat)
      by (intros e; destruct (One e) as (a & ->); auto).
    clear One. induction Hl as [|a h l hs Sa Hl IH]; [constructor|]. constructor.
    + intros Hin. destruct (in_shown h l hs Hl Hin) as (b & Hb & Sb).
      set (e := fun v => match signs a v with Some s => s | None => true end).
      assert (Aa : agree signs J e a = true).
      { unfold agree. apply forallb_forall. intros v _. unfold fits, e. destruct (signs a v) as [[|]|]; reflexivity. }
      assert (Ab : agree signs J e b = true) by (apply (shown_agrees b h e Sb), (shown_agrees a h e Sa), Aa).
      specialize (Le e). cbn [filter] in Le. rewrite Aa in Le. cbn [length] in Le.
      assert (Hb' : In b (filter (agree signs J e) l)) by now apply filter_In.
      destruct (filter (agree signs J e) l); [easy|]. cbn [length] in Le. lia.
    + apply IH. intros e. specialize (Le e). cbn [filter] in Le. destruct (agree signs J e a); cbn [length] in Le; lia.
  - intros h. split.
    + intros Hh. destruct (in_shown h l hs Hl Hh) as (a & _ & Sa). now apply (shown_represents a).
    + intros Rh. destruct (lies_somewhere h Rh) as (e & He). destruct (One e) as (a & E).
      assert (Ha : In a (filter (agree signs J e) l)) by (rewrite E; now left).
      apply filter_In in Ha. destruct Ha as (Ha & Ag). destruct (shown_in a l hs Hl Ha) as (g & Hg & Sg).
      apply (shown_agrees a g e Sg) in Ag. now rewrite (alone e h g Rh (shown_represents a g Sg) He Ag).
Qed.
End Core.

(** ** Branches *)

Section Listed.
Variable S : sheet.
Variables b1 b2 b3 b4 : nat.
Hypothesis Rim : rim S = [b1; b2; b3; b4].
Hypothesis Corners : cross (sub (at_ S b2) (at_ S b1)) (sub (at_ S b3) (at_ S b1)) <> 0.
Context {A : Type}.
Variable signs : A -> nat -> option bool.
Notation I := (inner S).

(** [h] represents a branch with these signs, whose stars are flat where there are none. *)
Definition shown (a : A) (h : vec) : Prop := representative S b4 h /\
  (forall v e, In v I -> signs a v = Some e -> 0 < sign e * K2 S v (cone S v) h) /\
  (forall v, In v I -> signs a v = None -> flat_star S v h).

(** The sign vectors in whose closed nappes it lies are those that agree. *)
Lemma shown_nappes a h e : shown a h -> (in_nappes S e h <-> agree signs I e a = true).
Proof.
  intros ((_ & Hs) & Sg & Fl). unfold agree. rewrite forallb_forall. split.
  - intros Hn v Hv. destruct (Hn v Hv) as (_ & P). unfold fits. destruct (signs a v) as [s|] eqn:E; [|reflexivity].
    specialize (Sg v s Hv E). destruct s, (e v); simpl in *; try reflexivity; lra.
  - intros Ag v Hv. rewrite (Hs v Hv). split; [lra|]. specialize (Ag v Hv). unfold fits in Ag.
    destruct (signs a v) as [s|] eqn:E.
    + apply Bool.eqb_prop in Ag. rewrite <- Ag. apply Rlt_le. now apply Sg.
    + rewrite K2_sym, (flat_null S v h Hv (Fl v Hv E)). lra.
Qed.

Lemma shown_simple a h : shown a h -> (nonsingular S h <-> flats signs I a = []).
Proof.
  intros ((_ & Hs) & Sg & Fl). rewrite (simple_iff_no_flat_star S h Hs). unfold flats. split.
  - intros NF. destruct (filter _ I) as [|v l] eqn:E; [reflexivity|exfalso].
    assert (Hv : In v (filter (fun v => match signs a v with None => true | Some _ => false end) I))
      by (rewrite E; now left).
    apply filter_In in Hv. destruct Hv as (Hv & N). destruct (signs a v) eqn:Sv; [discriminate|].
    exact (NF v Hv (Fl v Hv Sv)).
  - intros E v Hv F. destruct (signs a v) as [s|] eqn:Sv.
    + specialize (Sg v s Hv Sv). rewrite K2_sym, (flat_null S v h Hv F) in Sg. lra.
    + assert (H : In v []); [|easy]. rewrite <- E. apply filter_In. now rewrite Sv.
Qed.

Theorem listed l hs : (forall e, exists a, filter (agree signs I e) l = [a]) -> Forall2 shown l hs ->
  NoDup hs /\ (forall h, In h hs <-> representative S b4 h) /\
  forall z, complex_solution S z -> complex_affine S z \/
    exists h, In h hs /\ (exists s, on_branch S z s h) /\ forall h' s', In h' hs -> on_branch S z s' h' -> h' = h.
Proof.
  intros One Hl.
  destruct (all_listed signs I (representative S b4) (in_nappes S) shown) with (l := l) (hs := hs) as (D & Rep);
    [now intros a h (R & _)|exact shown_nappes|intros h (_ & Hs)|
      intros e h h' (Hr & Hs) (Hr' & Hs')|exact One|exact Hl|].
  - exists (signs_of S h). apply signs_of_nappes. intros v Hv. rewrite (Hs v Hv). lra.
  - now apply (different_sign_vectors S (unit b4)).
  - split; [exact D|]. split; [exact Rep|].
    intros z Hz.
    destruct (every_solution_on_a_branch S b1 b2 b3 b4 Rim Corners z Hz) as [|(s & h & Rh & Oh)]; [now left|right].
    exists h. split; [now apply Rep|]. split; [now exists s|]. intros h' s' Hh' Oh'. apply Rep in Hh'.
    now destruct (branch_has_one_representative S b1 b2 b3 b4 Rim Corners z s' s h' h Hh' Rh Oh' Oh).
Qed.
End Listed.
