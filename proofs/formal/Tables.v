(** The test of a drawing with tables, so that large sheets take little time: what passes it passes [check]. *)
From Coq Require Import Reals ZArith List Permutation Lia Arith Bool FunctionalExtensionality FMapPositive.
From Exactfold Require Import Sums Vectors Sheet Drawing.
Import ListNotations.
Open Scope nat_scope.

Module Map := PositiveMap.
Definition key (u : nat) : positive := Pos.of_succ_nat u.

Lemma key_inj u v : key u = key v -> u = v.
Proof. unfold key. intros E. apply (f_equal Pos.to_nat) in E. rewrite !SuccNat2Pos.id_succ in E. lia. Qed.

(** ** Lists as tables *)

Fixpoint fill {A} (l : list A) (k : nat) (m : Map.t A) : Map.t A :=
  match l with [] => m | a :: l => fill l (S k) (Map.add (key k) a m) end.

Definition look {A} (m : Map.t A) (default : A) (u : nat) : A :=
  match Map.find (key u) m with Some a => a | None => default end.

Lemma fill_find {A} (l : list A) : forall k m u, Map.find (key u) (fill l k m) =
  if le_lt_dec k u then match nth_error l (u - k) with Some a => Some a | None => Map.find (key u) m end
  else Map.find (key u) m.
Proof.
  induction l as [|a l IH]; intros k m u; simpl.
  - destruct le_lt_dec; [now destruct (u - k)|reflexivity].
  - rewrite IH. destruct (le_lt_dec (S k) u), (le_lt_dec k u); try lia.
    + replace (u - k) with (S (u - S k)) by lia. simpl. destruct nth_error; [reflexivity|].
      rewrite Map.gso; [reflexivity|]. intros E. apply key_inj in E. lia.
    + assert (u = k) as -> by lia. rewrite Nat.sub_diag. simpl. now rewrite Map.gss.
    + rewrite Map.gso; [reflexivity|]. intros E. apply key_inj in E. lia.
Qed.

Definition table {A} (l : list A) : Map.t A := fill l 0 (Map.empty A).

Lemma table_nth {A} (l : list A) default : look (table l) default = fun u => nth u l default.
Proof.
  apply functional_extensionality. intros u. unfold look, table. rewrite fill_find. simpl. rewrite Nat.sub_0_r.
  rewrite Map.gempty. destruct (nth_error l u) as [a|] eqn:E.
  - symmetry. now apply nth_error_nth.
  - symmetry. apply nth_overflow. now apply nth_error_None.
Qed.

Lemma table_In {A} (l : list A) u a : Map.find (key u) (table l) = Some a -> In a l.
Proof.
  unfold table. rewrite fill_find. simpl. rewrite Nat.sub_0_r, Map.gempty.
  destruct (nth_error l u) as [b|] eqn:E; [|discriminate]. intros [= ->]. now apply nth_error_In in E.
Qed.

(** ** Sets *)

Definition set_of (l : list nat) : Map.t Datatypes.unit := fold_right (fun a m => Map.add (key a) tt m) (Map.empty _) l.
Definition has (m : Map.t Datatypes.unit) (a : nat) : bool :=
  match Map.find (key a) m with Some _ => true | None => false end.

Lemma has_In l a : has (set_of l) a = true <-> In a l.
Proof.
  unfold has. induction l as [|b l IH]; simpl.
  - rewrite Map.gempty. easy.
  - destruct (Nat.eq_dec b a) as [->|N].
    + rewrite Map.gss. tauto.
    + rewrite Map.gso by (intros E; apply key_inj in E; congruence). tauto.
Qed.

Fixpoint fresh (l : list nat) (m : Map.t Datatypes.unit) : bool :=
  match l with [] => true | a :: l => negb (has m a) && fresh l (Map.add (key a) tt m) end.

Lemma fresh_NoDup l : forall m, fresh l m = true -> NoDup l /\ forall a, In a l -> has m a = false.
Proof.
  induction l as [|a l IH]; intros m; simpl; [split; [constructor|easy]|].
  rewrite andb_true_iff, negb_true_iff. intros (N & F). destruct (IH _ F) as (D & H). split.
  - constructor; [|assumption]. intros Ha. specialize (H a Ha). unfold has in H. now rewrite Map.gss in H.
  - intros b [<-|Hb]; [assumption|]. specialize (H b Hb). unfold has in *.
    destruct (Nat.eq_dec b a) as [->|Ne]; [now rewrite Map.gss in H|].
    now rewrite Map.gso in H by (intros E; apply key_inj in E; congruence).
Qed.

Lemma NoDup_once l : NoDup l -> once l = true.
Proof.
  induction 1 as [|a l N D IH]; [reflexivity|]. simpl. rewrite IH, andb_true_r. apply negb_true_iff.
  destruct (mem a l) eqn:M; [|reflexivity]. now apply mem_in in M.
Qed.

Lemma NoDup_once2 l : NoDup l -> once2 l = true.
Proof.
  induction 1 as [|a l N D IH]; [reflexivity|]. simpl. rewrite IH, andb_true_r. apply negb_true_iff.
  destruct (mem2 a l) eqn:M; [|reflexivity]. now apply mem2_in in M.
Qed.

(** ** Links *)

Definition links (cs : list face) : Map.t (list (nat * nat)) :=
  fold_right (fun c m => let '(v, a, b) := c in Map.add (key v) ((a, b) :: look m [] v) m) (Map.empty _) cs.

Lemma links_link faces : look (links (corners faces)) [] = link faces.
Proof.
  apply functional_extensionality. intros v. unfold link. induction (corners faces) as [|[[u a] b] cs IH].
  - unfold look. simpl. now rewrite Map.gempty.
  - simpl. unfold look at 1. destruct (Nat.eqb_spec u v) as [->|N].
    + rewrite Map.gss, IH. reflexivity.
    + rewrite Map.gso by (intros E; apply key_inj in E; congruence). exact IH.
Qed.

Lemma sides_from_links faces vs : (forall v a b, In (v, a, b) (corners faces) -> In v vs) ->
  (forall v, In v vs -> NoDup (map fst (link faces v))) -> NoDup (sides faces).
Proof.
  intros All D. assert (D' : forall v, NoDup (map fst (link faces v))).
  { intros v. destruct (in_dec Nat.eq_dec v vs) as [Hv|Hv]; [now apply D|].
    assert (E : link faces v = []); [|rewrite E; constructor].
    unfold link. destruct (filter _ _) as [|[[u a] b] l] eqn:F; [reflexivity|exfalso].
    assert (H : In (u, a, b) ((u, a, b) :: l)) by now left. rewrite <- F in H. apply filter_In in H.
    destruct H as (H & E). apply Nat.eqb_eq in E. subst u. apply Hv. now apply (All v a b). }
  clear D All. unfold sides, link in *. induction (corners faces) as [|[[u a] b] cs IH]; [constructor|].
  simpl. constructor.
  - intros H. apply in_map_iff in H. destruct H as ([[u' a'] b'] & E & H). injection E as -> ->.
    specialize (D' u). simpl in D'. rewrite Nat.eqb_refl in D'. simpl in D'. inversion D' as [|? ? N _]; subst. apply N.
    apply in_map_iff. exists (a, b'). split; [reflexivity|]. apply in_map_iff. exists (u, a, b'). split; [reflexivity|].
    apply filter_In. split; [assumption|]. apply Nat.eqb_refl.
  - apply IH. intros v. specialize (D' v). simpl in D'. destruct (Nat.eqb u v); [|exact D'].
    simpl in D'. now inversion D'.
Qed.

Lemma side_in_link faces a b : In a (map fst (link faces b)) -> In (b, a) (sides faces).
Proof.
  unfold link, sides. rewrite map_map. intros H. apply in_map_iff in H. destruct H as ([[u x] y] & E & H).
  apply filter_In in H. destruct H as (H & E'). apply Nat.eqb_eq in E'. simpl in E. subst u x.
  apply in_map_iff. now exists (b, a, y).
Qed.

(** ** The test *)

Section Swift.
Local Open Scope Z_scope.
Variable at_z : nat -> Z * Z.
Variable fan_of : nat -> list nat.
Variable on_rim : nat -> bool.

Definition turn_of (v a b : nat) : Z :=
  let (x, y) := at_z v in let (x1, y1) := at_z a in let (x2, y2) := at_z b in
  (x1 - x) * (y2 - y) - (y1 - y) * (x2 - x).

Definition full_star_of (v : nat) : bool :=
  match fan_of v with
  | [] => false
  | u :: l =>
    match span (fun z => 0 <? turn_of v u z) l with
    | (_ :: _, q :: b :: r) =>
      let down := b :: r in
      (turn_of v u q <=? 0) && forallb (fun z => turn_of v u z <? 0) (removelast down) && Nat.eqb (last down q) u
    | _ => false
    end
  end.

Definition convex_of (v : nat) : bool :=
  match fan_of v with
  | u :: a :: l' =>
    let l := a :: l' in
    on_rim u && on_rim (last l u) && forallb (fun z => 0 <? turn_of v u z) (removelast l) &&
    (0 <=? turn_of v u (last l u))
  | _ => false
  end.
End Swift.

Lemma turn_of_zcross d v a b : turn_of (place d) v a b = zcross d v a b.
Proof. unfold turn_of, zcross. destruct (place d v), (place d a), (place d b). reflexivity. Qed.

Section Check.
Variable d : drawing.

(** The table of places and of fans: made once, and given to the tests of branches, too. *)
Definition places : Map.t (Z * Z) := table (points d).
Definition fans_table : Map.t (list nat) := table (fans_of d).

Definition swift_check (places : Map.t (Z * Z)) (fans : Map.t (list nat)) : bool :=
  let at_z := look places (0, 0)%Z in let fan := look fans [] in
  let known := set_of (inside d ++ border d) in let rim := set_of (border d) in
  let cs := corners (triangles d) in let link := look (links cs) [] in
  fresh (inside d ++ border d) (Map.empty _) &&
  forallb (fun c => let '(v, a, b) := c in has known v) cs &&
  forallb (fun f => let '(a, b, c) := f in 0 <? turn_of at_z a b c)%Z (triangles d) &&
  forallb (fun v => once (map fst (link v))) (inside d ++ border d) &&
  forallb (fun c => let '(a, b, _) := c in existsb (Nat.eqb a) (map fst (link b)) || (has rim a && has rim b)) cs &&
  forallb (fun v => same2 (steps (fan v)) (link v)) (inside d ++ border d) &&
  forallb (full_star_of at_z fan) (inside d) && forallb (convex_of at_z fan (has rim)) (border d).

Lemma has_mem l a : has (set_of l) a = mem a l.
Proof.
  destruct (mem a l) eqn:E.
  - apply has_In. now apply mem_in.
  - destruct (has (set_of l) a) eqn:H; [|reflexivity]. apply has_In, mem_in in H. congruence.
Qed.

Theorem swift_checked : swift_check places fans_table = true -> check d = true.
Proof.
  unfold swift_check, places, fans_table. cbv zeta. rewrite links_link, !table_nth.
  change (fun u => nth u (points d) (0, 0)%Z) with (place d).
  rewrite !andb_true_iff, !forallb_forall. intros (((((((H1 & H2) & H3) & H4) & H5) & H6) & H7) & H8).
  assert (V : forall v a b, In (v, a, b) (corners (triangles d)) -> In v (inside d ++ border d)).
  { intros v a b Hc. specialize (H2 _ Hc). now apply has_In in H2. }
  unfold check. rewrite !andb_true_iff, !forallb_forall. repeat split.
  - apply NoDup_once. now apply (fresh_NoDup _ (Map.empty _)).
  - intros [[v a] b] Hc. apply mem_in. now apply (V v a b).
  - intros [[a b] c] Hf. specialize (H3 _ Hf). cbv beta iota in H3. now rewrite turn_of_zcross in H3.
  - apply NoDup_once2, (sides_from_links _ _ V). intros v Hv. apply once_NoDup. now apply H4.
  - intros [a b] Hs. unfold sides in Hs. apply in_map_iff in Hs. destruct Hs as ([[a' b'] c] & E & Hc).
    injection E as -> ->. specialize (H5 _ Hc). cbv beta iota in H5. cbn [fst snd].
    rewrite orb_true_iff, andb_true_iff, existsb_exists, !has_mem in H5. rewrite orb_true_iff, andb_true_iff, mem2_in.
    destruct H5 as [(x & Hx & E)|H]; [left|now right]. apply Nat.eqb_eq in E. subst x. now apply side_in_link.
  - intros v Hv. now apply H6.
  - intros v Hv. specialize (H7 v Hv). unfold full_star_of in H7. unfold full_star.
    destruct (nth v (fans_of d) []) as [|u l]; [easy|].
    replace (fun z => turn_of (place d) v u z) with (fun z => zcross d v u z) in H7
      by (apply functional_extensionality; intros z; symmetry; apply turn_of_zcross).
    replace (turn_of (place d) v u) with (zcross d v u) in H7
      by (apply functional_extensionality; intros z; symmetry; apply turn_of_zcross).
    exact H7.
  - intros v Hv. specialize (H8 v Hv). unfold convex_of in H8. unfold convex_at.
    destruct (nth v (fans_of d) []) as [|u [|a l]]; try easy. cbv zeta in *.
    replace (turn_of (place d) v u) with (zcross d v u) in H8
      by (apply functional_extensionality; intros z; symmetry; apply turn_of_zcross).
    now rewrite !has_mem in H8.
Qed.
End Check.
