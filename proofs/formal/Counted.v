(** Exactly 2^n branches, where each sign vector has a certificate: no star is flat on any branch. *)
From Coq Require Import Reals QArith Qreals List Lra Lia Arith Bool FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Nappes Sheet Star KeyLemma Flat Complex Theorems Branches
  Drawing Rational Certificate.
Import ListNotations.
Open Scope R_scope.

Section Counted.
Variable d : drawing.
Variables b1 b2 b3 b4 : nat.
Variable cs : list certificate.

(** The heights of the rim are those of a representative: 1 at [b4], else 0. *)
Definition pinned (c : certificate) : bool :=
  Nat.ltb b4 (length (near c)) && forallb (fun u => mem u (inside d) ||
    Qeq_bool (height c u) (if Nat.eqb u b4 then 1%Q else 0%Q)) (seq 0 (length (near c))).

(** Some certificate is of the branch with the signs [e]. *)
Definition has_certificate (e : nat -> bool) : bool :=
  existsb (fun c => forallb (fun v => Bool.eqb (pops_up c v) (e v)) (inside d)) cs.

Definition check_all : bool :=
  forallb (check_branch d) cs && forallb pinned cs && forallb has_certificate (sign_vectors (inside d)).

Hypothesis ok : check d = true.
Notation S := (sheet_of d ok).

Lemma pinned_rim c u : pinned c = true -> ~ In u (inside d) -> real_heights (height c) u = unit b4 u.
Proof.
  unfold pinned. rewrite andb_true_iff, forallb_forall, Nat.ltb_lt. intros (Lt & All) Hu.
  unfold unit, upd, zero. destruct (le_lt_dec (length (near c)) u) as [Ge|Less].
  - destruct (Nat.eq_dec u b4) as [->|]; [lia|]. unfold real_heights, height.
    rewrite nth_overflow by assumption. unfold Q2R. simpl. ring.
  - specialize (All u). rewrite orb_true_iff, mem_in in All.
    destruct All as [|E]; [apply in_seq; lia|contradiction|].
    apply Qeq_bool_eq, Qeq_eqR in E. unfold real_heights. rewrite E.
    destruct (Nat.eq_dec u b4) as [->|N].
    + rewrite Nat.eqb_refl. unfold Q2R. simpl. field.
    + apply Nat.eqb_neq in N. rewrite N. unfold Q2R. simpl. ring.
Qed.

(** If all sign vectors have certificates, no star is flat on any branch. *)
Theorem no_star_is_flat : check_all = true -> forall h, representative S b4 h ->
  forall v, In v (inner S) -> ~ flat_star S v h.
Proof.
  unfold check_all. rewrite !andb_true_iff, !forallb_forall. intros ((Cs & Ps) & Es) h (Hr & Hs) v Hv Fl.
  assert (Hn : in_nappes S (signs_of S h) h).
  { apply signs_of_nappes. intros u Hu. rewrite (Hs u Hu). lra. }
  assert (He : In (signs_of S h) (sign_vectors (inside d))).
  { apply sign_vectors_all. intros u Hu. unfold signs_of. now destruct in_dec. }
  apply Es in He. unfold has_certificate in He. apply existsb_exists in He. destruct He as (c & Hc & Eq).
  rewrite forallb_forall in Eq.
  destruct (certified d c ok (Cs c Hc)) as (g & _ & _ & Gs & U & _).
  assert (E : h = g).
  { apply U; [|exact Hs|].
    - intros u Hu. rewrite (Hr u Hu). symmetry. now apply pinned_rim; [apply Ps|].
    - intros u Hu. specialize (Eq u Hu). apply Bool.eqb_prop in Eq. rewrite Eq. now apply Hn. }
  specialize (Gs v Hv). rewrite <- E in Gs.
  rewrite K2_sym, (flat_null S v h Hv Fl) in Gs. lra.
Qed.

(** Then there are exactly 2^n branches, one for each sign vector. *)
Theorem counted : rim S = [b1; b2; b3; b4] ->
  cross (sub (at_ S b2) (at_ S b1)) (sub (at_ S b3) (at_ S b1)) <> 0 -> check_all = true ->
  exists l : list vec, length l = (2 ^ length (inner S))%nat /\ NoDup l /\
    (forall h, In h l <-> representative S b4 h) /\
    (forall e, exists! h, In h l /\ forall v, In v (inner S) -> 0 < sign (e v) * K2 S v (cone S v) h) /\
    (forall z, complex_solution S z -> complex_affine S z \/
       exists h, In h l /\ (exists s, on_branch S z s h) /\
         forall h' s', In h' l -> on_branch S z s' h' -> h' = h).
Proof. intros Rim Cor All. exact (branches S b1 b2 b3 b4 Rim Cor (no_star_is_flat All)). Qed.
End Counted.
