(** Boxes of a listing (docs/certificate.md): Krawczyk's test for the curvatures of a sheet, computed
    in rational numbers. *)
From Coq Require Import Reals QArith Qabs Qreals List Lra Lia Arith Bool FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Nappes Sheet Star KeyLemma Flat Theorems Branches Drawing Rational
  Krawczyk.
Import ListNotations.
Open Scope R_scope.

(** A box around heights, the matrix Y by vertices, and the bounds of Y F, Id - Y F' and Y F''. *)
Record box := Box {
  middle : list Q;
  radius : Q;
  matrix : list (list Q);
  bound_F : Q;
  bound_F1 : Q;
  bound_F2 : Q
}.

Lemma Q2R_abs x : Q2R (Qabs x) = Rabs (Q2R x).
Proof.
  destruct (Qlt_le_dec x 0) as [N|P].
  - rewrite (Qeq_eqR _ (- x)) by (apply Qabs_neg, Qlt_le_weak, N). rewrite Q2R_opp.
    apply Qlt_Rlt in N. replace (Q2R 0) with 0 in N by (unfold Q2R; simpl; ring). now rewrite Rabs_left.
  - rewrite (Qeq_eqR _ x) by (apply Qabs_pos, P).
    apply Qle_Rle in P. replace (Q2R 0) with 0 in P by (unfold Q2R; simpl; ring).
    rewrite Rabs_right; [reflexivity|now apply Rle_ge].
Qed.

Lemma Q2R_one : Q2R 1 = 1.
Proof. unfold Q2R. simpl. field. Qed.

Lemma Q2R_nought : Q2R 0 = 0.
Proof. unfold Q2R. simpl. ring. Qed.

Section Boxes.
Variable d : drawing.
Variable b : box.
Notation I := (inside d).

Definition middle_at : heights := fun u => nth u (middle b) 0%Q.
Definition weight_at (i p : nat) : Q := nth p (nth i (matrix b) []) 0%Q.
Definition qunit (j : nat) : heights := fun u => if Nat.eqb u j then 1%Q else 0%Q.
Definition qresidual (i : nat) : Q := qsum I (fun p => (weight_at i p * qK2 d p middle_at middle_at)%Q).
Definition qentry (i j : nat) : Q :=
  qsum I (fun p => (weight_at i p * (2 * qK2 d p middle_at (qunit j)))%Q).
Definition qsecond (i j l : nat) : Q :=
  qsum I (fun p => (weight_at i p * (2 * qK2 d p (qunit j) (qunit l)))%Q).
Definition row_ok (i : nat) : bool :=
  at_most (Qabs (qresidual i)) (bound_F b) &&
  at_most (qsum I (fun j => Qabs ((if Nat.eqb i j then 1 else 0) - qentry i j)%Q)) (bound_F1 b) &&
  at_most (qsum I (fun j => qsum I (fun l => Qabs (qsecond i j l)))) (bound_F2 b).

(** Krawczyk's test. *)
Definition check_box : bool :=
  let c := (bound_F1 b + radius b * bound_F2 b)%Q in
  at_most 0 (radius b) && forallb row_ok I && below c 1 && at_most (bound_F b + c * radius b) (radius b).

Hypothesis ok : check d = true.
Notation S := (sheet_of d ok).
Notation m := (real_heights middle_at).

Lemma unit_R j : real_heights (qunit j) = unit j.
Proof.
  apply functional_extensionality. intros u. unfold real_heights, qunit, unit, upd, zero.
  destruct (Nat.eq_dec u j) as [->|N].
  - rewrite Nat.eqb_refl. apply Q2R_one.
  - apply Nat.eqb_neq in N. rewrite N. apply Q2R_nought.
Qed.

Notation Y := (fun i p => Q2R (weight_at i p)).

Lemma residual_R i : Q2R (qresidual i) = residual I (K2 S) (fun _ => 0) Y i m.
Proof.
  unfold qresidual, residual. rewrite qsum_R. apply sum_ext. intros p Hp.
  rewrite Q2R_mult, (qK2_R d ok) by (apply in_or_app; now left). now rewrite Rminus_0_r.
Qed.

Lemma twice_R x : Q2R (2 * x) = 2 * Q2R x.
Proof. rewrite Q2R_mult. f_equal. unfold Q2R. simpl. field. Qed.

Lemma entry_R i j : Q2R (qentry i j) = entry I (K2 S) m Y i j.
Proof.
  unfold qentry, entry. rewrite qsum_R. apply sum_ext. intros p Hp.
  rewrite Q2R_mult, twice_R, (qK2_R d ok) by (apply in_or_app; now left). now rewrite unit_R.
Qed.

Lemma second_R i j l : Q2R (qsecond i j l) = second I (K2 S) Y i j l.
Proof.
  unfold qsecond, second. rewrite qsum_R. apply sum_ext. intros p Hp.
  rewrite Q2R_mult, twice_R, (qK2_R d ok) by (apply in_or_app; now left). now rewrite !unit_R.
Qed.

(** What passes the test is proved: the box holds exactly one solution, and no star is flat in it. *)
Theorem boxed : check_box = true -> exists x,
  has_rim S m x /\ solves S (fun _ => 0) x /\
  (forall v, In v I -> Rabs (x v - m v) <= Q2R (radius b)) /\
  (forall v, In v I -> ~ flat_star S v x) /\
  (forall y, has_rim S m y -> solves S (fun _ => 0) y ->
    (forall v, In v I -> Rabs (y v - m v) <= Q2R (radius b)) -> y = x).
Proof.
  unfold check_box. rewrite !andb_true_iff, forallb_forall. intros (((Pr & Rows) & C) & Ins).
  apply at_most_R in Pr, Ins. apply below_R in C. rewrite Q2R_nought in Pr. rewrite Q2R_one in C.
  rewrite !Q2R_plus, !Q2R_mult, !Q2R_plus, !Q2R_mult in Ins. rewrite Q2R_plus, Q2R_mult in C.
  pose proof (inner_once S) as Once. change (inner S) with I in Once.
  assert (E : forall i, In i I -> Rabs (residual I (K2 S) (fun _ => 0) Y i m) <= Q2R (bound_F b)).
  { intros i Hi. specialize (Rows i Hi). unfold row_ok in Rows. rewrite !andb_true_iff in Rows.
    destruct Rows as ((R & _) & _). apply at_most_R in R. now rewrite Q2R_abs, residual_R in R. }
  assert (F : forall i, In i I ->
    sum I (fun j => Rabs (delta i j - entry I (K2 S) m Y i j)) <= Q2R (bound_F1 b)).
  { intros i Hi. specialize (Rows i Hi). unfold row_ok in Rows. rewrite !andb_true_iff in Rows.
    destruct Rows as ((_ & R) & _). apply at_most_R in R. rewrite qsum_R in R.
    eapply Rle_trans; [|exact R]. right. apply sum_ext. intros j Hj.
    rewrite Q2R_abs, Q2R_minus, entry_R. do 2 f_equal. unfold delta.
    destruct (Nat.eqb_spec i j), (Nat.eq_dec i j); try contradiction; now rewrite ?Q2R_one, ?Q2R_nought. }
  assert (G : forall i, In i I ->
    sum I (fun j => sum I (fun l => Rabs (second I (K2 S) Y i j l))) <= Q2R (bound_F2 b)).
  { intros i Hi. specialize (Rows i Hi). unfold row_ok in Rows. rewrite !andb_true_iff in Rows.
    destruct Rows as (_ & R). apply at_most_R in R. rewrite qsum_R in R.
    eapply Rle_trans; [|exact R]. right. apply sum_ext. intros j Hj. rewrite qsum_R. apply sum_ext.
    intros l Hl. now rewrite Q2R_abs, second_R. }
  assert (Pol : forall x, solves S (fun _ => 0) x <-> forall p, In p I -> K2 S p x x = 0).
  { intros x. split; intros H p Hp; specialize (H p Hp).
    - rewrite K_polar_sheet by (apply in_or_app; now left). exact H.
    - rewrite K_polar_sheet in H by (apply in_or_app; now left). exact H. }
  destruct (krawczyk I (K2 S) (fun _ => 0) Once (K2_sym S) (K2_move S) m (Q2R (radius b)) Y
    (Q2R (bound_F b)) (Q2R (bound_F1 b)) (Q2R (bound_F2 b)) Pr E F G C Ins) as (x & ((Off & Bx) & Sx) & U).
  exists x. split; [exact Off|]. split; [now apply Pol|]. split; [exact Bx|]. split.
  - assert (Inj : forall w, zero_off I w -> (forall v, In v I -> K2 S v x w = 0) -> w = zero).
    { intros w Zw O. apply (krawczyk_nonsingular I (K2 S) (fun _ => 0) Once (K2_sym S) (K2_move S) m (Q2R (radius b)) Y
        (Q2R (bound_F b)) (Q2R (bound_F1 b)) (Q2R (bound_F2 b)) Pr E F G C x w); [now split|exact Zw|exact O]. }
    assert (Lin : forall v, linear (fun w => K2 S v x w)) by (intros v a s e; apply K2_move).
    apply (simple_iff_no_flat_star S x); [now apply Pol|]. intros e.
    destruct (solve I (fun v w => K2 S v x w) Once (fun v _ => Lin v) Inj e) as (w & Zw & Hw).
    exists w. split; [now split|]. intros w' (Zw' & Hw').
    assert (Z : minus w w' = zero).
    { apply Inj.
      - intros u Hu. unfold minus. rewrite (Zw u Hu), (Zw' u Hu). ring.
      - intros v Hv. rewrite minus_move, K2_move, (Hw v Hv), (Hw' v Hv). ring. }
    apply functional_extensionality. intros u. apply (f_equal (fun a => a u)) in Z.
    unfold minus, zero in Z. lra.
  - intros y Oy Sy By. symmetry. apply U. split; [now split|]. now apply Pol.
Qed.
End Boxes.
