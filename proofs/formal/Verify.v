(** The program that verifies certificates (docs/formal.md): what passes is true. The numbers that it is
    given, and what it prepares from them, are not trusted. *)
From Coq Require Import Reals ZArith List Lra Lia Arith Bool FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Nappes Sheet Star KeyLemma Flat Complex Theorems Branches
  Drawing Tables Rational Certificate Integers.
Import ListNotations.
Open Scope R_scope.

(** ** One branch *)

(** A drawing is a sheet, and what was prepared belongs to it. *)
Definition sound (d : drawing) (p : prepared) : bool :=
  let places := places d in let fans := fans_table d in
  let known := set_of (inside d ++ border d) in let fold_table := table (folds p) in
  swift_check d places fans &&
  prepared_ok d p (look places (0, 0)%Z) (look fans []) (has known) (fun k => Map.find (key k) fold_table).

(** What a test of one branch proves. *)
Definition proved (d : drawing) (p : prepared) (ok : check d = true) up h asked : Prop :=
  let S := sheet_of d ok in
  exists g, has_rim S (reals h) g /\ solves S (fun _ => 0) g /\ in_nappes S up g /\
    (forall b, In b (hubs p) -> is_bent asked b = true ->
      0 < sign (up (at_vertex b)) * K2 S (at_vertex b) (cone S (at_vertex b)) g) /\
    (forall g', has_rim S (reals h) g' -> solves S (fun _ => 0) g' -> in_nappes S up g' -> g' = g) /\
    (forall f i j l m valley, In f (folds p) -> ends f = (i, j, l, m) -> asked (name f) = Some valley ->
      0 < sign valley * bend S i j l m g).

Lemma sound_means d p : sound d p = true ->
  exists ok : check d = true, inside d = map at_vertex (hubs p) /\
    forall up h asked, passes p up h asked = true -> proved d p ok up h asked.
Proof.
  unfold sound. cbv zeta. rewrite andb_true_iff. intros (Sw & Ok). exists (swift_checked d Sw). split.
  { unfold prepared_ok in Ok. rewrite !andb_true_iff in Ok. destruct Ok as ((((E & _) & _) & _) & _).
    symmetry. now apply same_list_eq. }
  intros up h asked.
  apply (passed d p _ _ _ _ (swift_checked d Sw)) with (5 := Ok).
  - exact (table_nth _ _).
  - exact (table_nth _ _).
  - intros v Hv. now apply has_In in Hv.
  - intros k f Hf. now apply table_In in Hf.
Qed.

Definition verify_one (d : drawing) (p : prepared) (up : nat -> bool) (h : zheights) (asked : nat -> letter) : bool :=
  sound d p && passes p up h asked.

Theorem one_verified d p up h asked : verify_one d p up h asked = true ->
  exists ok : check d = true, proved d p ok up h asked.
Proof.
  unfold verify_one. rewrite andb_true_iff. intros (So & Pass). destruct (sound_means d p So) as (ok & _ & H).
  exists ok. now apply H.
Qed.

(** ** All branches *)

(** A test of all sign vectors, one after the other. *)
Fixpoint every (l : list nat) (test : (nat -> bool) -> bool) : bool :=
  match l with
  | [] => test (fun _ => false)
  | v :: l => every l test && every l (fun e => test (fun u => if Nat.eqb u v then true else e u))
  end.

Lemma every_all l test : every l test = true -> forall e, In e (sign_vectors l) -> test e = true.
Proof.
  revert test. induction l as [|v l IH]; intros test; simpl.
  - intros H e [<-|[]]. exact H.
  - rewrite andb_true_iff. intros (H & H') e He. apply in_app_or in He. destruct He as [He|He]; [now apply (IH test)|].
    apply in_map_iff in He. destruct He as (e' & <- & He'). exact (IH _ H' e' He').
Qed.

Section All.
Variable d : drawing.
Variable p : prepared.
(** For each sign vector: the height of the last corner, the heights inside, and letters of folds. *)
Variable top : (nat -> bool) -> Z.
Variable given : (nat -> bool) -> zheights.
Variable asked : (nat -> bool) -> nat -> letter.

(** Heights of a representative, times [top]: the other corners are at height 0. *)
Definition with_rim (b4 : nat) (s : Z) (h : zheights) : zheights := fun u =>
  if mem u (inside d) then h u else if Nat.eqb u b4 then s else 0%Z.

Definition test (b4 : nat) (e : nat -> bool) : bool :=
  (0 <? top e)%Z && forallb (is_bent (asked e)) (hubs p) && passes p e (with_rim b4 (top e) (given e)) (asked e).

Definition verify_all : bool :=
  match border d with
  | [b1; b2; b3; b4] =>
    sound d p && negb (zcross d b1 b2 b3 =? 0)%Z && every (inside d) (test b4)
  | _ => false
  end.

Definition scaled_up (s : R) (h : vec) : vec := move zero s h.

Lemma K2_scaled S v s g h : K2 S v g (scaled_up s h) = s * K2 S v g h.
Proof.
  unfold scaled_up. rewrite K2_move, (linear_zero (K2 S v g)) by (intros x y z; apply K2_move). ring.
Qed.

Lemma K_scaled S v s h : In v (inner S) -> K S v (scaled_up s h) = s * s * K S v h.
Proof.
  intros Hv. apply inner_vertex in Hv. rewrite <- !K_polar_sheet by assumption.
  rewrite K2_scaled, K2_sym, K2_scaled. ring.
Qed.

Lemma bend_scaled S i j l m s h : bend S i j l m (scaled_up s h) = s * bend S i j l m h.
Proof. unfold bend, tilt, gradient, scaled_up, move, zero, dot, sub, J, Rdiv. cbn [fst snd]. ring. Qed.

(** Exactly 2^n branches, complex ones included, all real and simple, one for each sign vector, with the
    letters that were asked for. *)
Theorem all_verified : verify_all = true ->
  exists (ok : check d = true) (b1 b2 b3 b4 : nat), border d = [b1; b2; b3; b4] /\
  let S := sheet_of d ok in exists l : list vec,
    length l = (2 ^ length (inside d))%nat /\ NoDup l /\
    (forall h, In h l <-> representative S b4 h) /\
    (forall h, In h l -> nonsingular S h) /\
    (forall e, exists! h, In h l /\ has_signs S e h) /\
    (forall z, complex_solution S z -> complex_affine S z \/
       exists h, In h l /\ (exists s, on_branch S z s h) /\
         forall h' s', In h' l -> on_branch S z s' h' -> h' = h) /\
    (forall e h f i j l m valley, In e (sign_vectors (inside d)) -> representative S b4 h -> has_signs S e h ->
       In f (folds p) -> ends f = (i, j, l, m) -> asked e (name f) = Some valley ->
       0 < sign valley * bend S i j l m h).
Proof.
  unfold verify_all. destruct (border d) as [|b1 [|b2 [|b3 [|b4 [|b5 r]]]]] eqn:Rim; try discriminate.
  rewrite !andb_true_iff. intros ((So & Cor) & All). destruct (sound_means d p So) as (ok & Hubs & Ok).
  exists ok, b1, b2, b3, b4. split; [reflexivity|].
  set (S := sheet_of d ok). assert (All' := every_all _ _ All).
  (* every representative has a certified multiple *)
  assert (Near : forall h, representative S b4 h -> forall e, In e (sign_vectors (inside d)) -> in_nappes S e h ->
    exists s, 0 < s /\ has_signs S e h /\ forall f i j l m valley,
      In f (folds p) -> ends f = (i, j, l, m) -> asked e (name f) = Some valley -> 0 < sign valley * bend S i j l m h).
  { intros h (Hr & Hs) e He Hn. specialize (All' e He). unfold test in All'.
    rewrite !andb_true_iff, forallb_forall in All'.
    destruct All' as ((Pt & Bent) & Pass). apply Z.ltb_lt, IZR_lt in Pt. set (s := IZR (top e)) in *.
    destruct (Ok e _ _ Pass) as (g & Gr & Gs & _ & Gb & U & Lt).
    change (sheet_of d ok) with S in Gr, Gs, Gb, U, Lt.
    assert (E : scaled_up s h = g).
    { apply U.
      - intros u Hu. unfold scaled_up, move, zero. rewrite (Hr u Hu). unfold reals, with_rim.
        assert (M : mem u (inside d) = false) by (unfold mem; now destruct in_dec).
        rewrite M. unfold unit, upd, zero. fold s. destruct (Nat.eq_dec u b4) as [->|N].
        + rewrite Nat.eqb_refl. fold s. ring.
        + apply Nat.eqb_neq in N. rewrite N. ring.
      - intros v Hv. rewrite K_scaled, (Hs v Hv) by assumption. ring.
      - intros v Hv. destruct (Hn v Hv) as (P & Q). rewrite K_scaled, K2_scaled by assumption. split.
        + repeat apply Rmult_le_pos; lra.
        + replace (sign (e v) * (s * K2 S v (cone S v) h)) with (s * (sign (e v) * K2 S v (cone S v) h)) by ring.
          apply Rmult_le_pos; lra. }
    exists s. split; [assumption|]. split.
    - intros v Hv. change (inner S) with (inside d) in Hv. rewrite Hubs in Hv. apply in_map_iff in Hv.
      destruct Hv as (b & <- & Hb). pose proof (Gb b Hb (Bent b Hb)) as Gn. rewrite <- E, K2_scaled in Gn.
      apply (Rmult_lt_reg_l s); [assumption|]. lra.
    - intros f i j l m valley Hf En As. specialize (Lt f i j l m valley Hf En As). rewrite <- E, bend_scaled in Lt.
      apply (Rmult_lt_reg_l s); [assumption|]. lra. }
  assert (NF : forall h, representative S b4 h -> forall v, In v (inner S) -> ~ flat_star S v h).
  { intros h Rh v Hv Fl. destruct (Near h Rh (signs_of S h)) as (s & Ps & Sg & _).
    - apply sign_vectors_all. intros u Hu. unfold signs_of. now destruct in_dec.
    - apply signs_of_nappes. intros u Hu. destruct Rh as (_ & Hs). rewrite (Hs u Hu). lra.
    - specialize (Sg v Hv). rewrite K2_sym, (flat_null S v h Hv Fl) in Sg. lra. }
  apply negb_true_iff, Z.eqb_neq in Cor.
  destruct (branches S b1 b2 b3 b4 Rim) as (l & Len & D & Rep & Signs & Complete).
  { change (cross (sub (at_R d b2) (at_R d b1)) (sub (at_R d b3) (at_R d b1)) <> 0). rewrite cross_IZR.
    intros E. apply Cor. now apply eq_IZR. }
  { exact NF. }
  exists l. split; [exact Len|]. split; [exact D|]. split; [exact Rep|]. split.
  { intros h Hh. apply Rep in Hh. apply simple_iff_no_flat_star; [now destruct Hh|now apply NF]. }
  split; [exact Signs|].
  split; [exact Complete|].
  intros e h f i j l' m valley He Rh Sg Hf En As. destruct (Near h Rh e He) as (s & _ & _ & Lt).
  - intros v Hv. destruct Rh as (_ & Hs). rewrite (Hs v Hv). specialize (Sg v Hv). split; lra.
  - exact (Lt f i j l' m valley Hf En As).
Qed.
End All.
