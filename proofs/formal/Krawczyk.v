(** Krawczyk's test: a box that holds exactly one zero of n quadrics in n unknowns.

    It is the test of exactfold/checker/core/krawczyk.py.  As the equations are of second degree,
    F(x) - F(y) = F'((x + y) / 2) (x - y) exactly, and no mean value theorem is needed. *)
From Coq Require Import Reals List Lra Lia Arith FunctionalExtensionality.
From Exactfold Require Import Sums Vectors.
Import ListNotations.
Open Scope R_scope.

Section Krawczyk.
(** The unknowns, and the equations q_p(x, x) = k_p with bilinear forms q_p.  Coordinates that are
    not in [I] are given; one of them can stand for 1, so that linear terms are allowed. *)
Variable I : list nat.
Variable q : nat -> vec -> vec -> R.
Variable k : nat -> R.
Hypothesis once : NoDup I.
Hypothesis q_sym : forall p a b, q p a b = q p b a.
Hypothesis q_move : forall p a b s c, q p a (move b s c) = q p a b + s * q p a c.

(** The box |x - m| <= r, and the matrix Y. *)
Variable m : vec.
Variable r : R.
Variable Y : nat -> nat -> R.
Definition in_box (x : vec) : Prop :=
  (forall i, ~ In i I -> x i = m i) /\ forall i, In i I -> Rabs (x i - m i) <= r.

(** Y F(x), the matrix Y F'(m), and Y times the second derivatives. *)
Definition residual (i : nat) (x : vec) : R := sum I (fun p => Y i p * (q p x x - k p)).
Definition entry (i j : nat) : R := sum I (fun p => Y i p * (2 * q p m (unit j))).
Definition second (i j l : nat) : R := sum I (fun p => Y i p * (2 * q p (unit j) (unit l))).
Definition delta (i j : nat) : R := if Nat.eq_dec i j then 1 else 0.

Variables eta k0 M : R.
Hypothesis Pr : 0 <= r.
Hypothesis Eta : forall i, In i I -> Rabs (residual i m) <= eta.
Hypothesis Inverse : forall i, In i I -> sum I (fun j => Rabs (delta i j - entry i j)) <= k0.
Hypothesis Second : forall i, In i I -> sum I (fun j => sum I (fun l => Rabs (second i j l))) <= M.
Hypothesis Contracts : k0 + r * M < 1.
Hypothesis Inside : eta + (k0 + r * M) * r <= r.
Notation c := (k0 + r * M).

Lemma q_move_left p a s b d : q p (move a s b) d = q p a d + s * q p b d.
Proof. now rewrite q_sym, q_move, (q_sym p d a), (q_sym p d b). Qed.

(** (Id - Y F'(z)) w *)
Definition slope (z : vec) (i : nat) (w : vec) : R := w i - sum I (fun p => Y i p * (2 * q p z w)).

Lemma slope_linear z i : linear (slope z i).
Proof.
  intros a s b. unfold slope.
  rewrite (sum_ext I _ (fun p => Y i p * (2 * q p z a) + s * (Y i p * (2 * q p z b)))).
  - rewrite sum_plus, sum_scal. unfold move. ring.
  - intros p _. rewrite q_move. ring.
Qed.

Lemma slope_at_unit z i j : In i I -> In j I -> in_box z ->
  Rabs (slope z i (unit j)) <= Rabs (delta i j - entry i j) + r * sum I (fun l => Rabs (second i l j)).
Proof.
  intros Hi Hj (Off & Box). set (u := minus z m).
  assert (Zu : zero_off I u) by (intros l Hl; unfold u, minus; rewrite (Off l Hl); ring).
  assert (Q : forall p, q p z (unit j) = q p m (unit j) + sum I (fun l => q p (unit l) (unit j) * u l)).
  { intros p. rewrite <- (linear_coordinates (fun a => q p a (unit j)) I u);
      [|intros a s b; apply q_move_left|assumption|assumption].
    replace z with (move m 1 u) at 1 by (unfold u; vec). rewrite q_move_left. ring. }
  assert (E : slope z i (unit j) = delta i j - entry i j + - sum I (fun l => second i l j * u l)).
  { unfold slope, entry.
    replace (unit j i) with (delta i j).
    2:{ unfold delta, unit. destruct (Nat.eq_dec i j) as [->|N]; [now rewrite upd_same|].
        now rewrite upd_other. }
    rewrite (sum_ext I (fun p => Y i p * (2 * q p z (unit j)))
      (fun p => Y i p * (2 * q p m (unit j)) +
        sum I (fun l => Y i p * (2 * q p (unit l) (unit j)) * u l))).
    - rewrite sum_plus, sum_swap. unfold second.
      rewrite (sum_ext I (fun l => sum I (fun p => Y i p * (2 * q p (unit l) (unit j))) * u l)
        (fun l => sum I (fun p => Y i p * (2 * q p (unit l) (unit j)) * u l))); [ring|].
      intros l _. rewrite Rmult_comm, <- sum_scal. apply sum_ext. intros; ring.
    - intros p _. rewrite Q.
      rewrite (sum_ext I (fun l => Y i p * (2 * q p (unit l) (unit j)) * u l)
        (fun l => Y i p * 2 * (q p (unit l) (unit j) * u l))) by (intros; ring).
      rewrite sum_scal. ring. }
  rewrite E. eapply Rle_trans; [apply Rabs_triang|]. apply Rplus_le_compat_l. rewrite Rabs_Ropp.
  eapply Rle_trans; [apply sum_abs|]. rewrite <- sum_scal. apply sum_le. intros l Hl.
  rewrite Rabs_mult, Rmult_comm. apply Rmult_le_compat_r; [apply Rabs_pos|]. now apply Box.
Qed.

(** On the box Id - Y F' makes vectors smaller by the factor c, in the norm max |w_i|. *)
Lemma slope_bound z i w s : In i I -> in_box z -> zero_off I w ->
  (forall j, In j I -> Rabs (w j) <= s) -> Rabs (slope z i w) <= c * s.
Proof.
  intros Hi Bz Zw Bw. assert (Ps : 0 <= s) by (eapply Rle_trans; [apply Rabs_pos|exact (Bw i Hi)]).
  rewrite (linear_coordinates (slope z i) I w (slope_linear z i) once Zw).
  eapply Rle_trans; [apply sum_abs|].
  apply Rle_trans with (s * sum I (fun j => Rabs (slope z i (unit j)))).
  - rewrite <- sum_scal. apply sum_le. intros j Hj. rewrite Rabs_mult, Rmult_comm.
    apply Rmult_le_compat_r; [apply Rabs_pos|auto].
  - rewrite Rmult_comm. apply Rmult_le_compat_r; [assumption|].
    apply Rle_trans with
      (sum I (fun j => Rabs (delta i j - entry i j) + r * sum I (fun l => Rabs (second i l j)))).
    + apply sum_le. intros j Hj. now apply slope_at_unit.
    + rewrite sum_plus, sum_scal, sum_swap. apply Rplus_le_compat; [auto|].
      apply Rmult_le_compat_l; [assumption|auto].
Qed.

Lemma factor_pos i : In i I -> 0 <= c.
Proof.
  intros Hi. apply Rplus_le_le_0_compat.
  - eapply Rle_trans; [|apply (Inverse i Hi)]. apply sum_nonneg. intros. apply Rabs_pos.
  - apply Rmult_le_pos; [assumption|]. eapply Rle_trans; [|apply (Second i Hi)].
    apply sum_nonneg. intros. apply sum_nonneg. intros. apply Rabs_pos.
Qed.

(** So Y F'(z), and with it F'(z), is nonsingular. *)
Lemma small z w : in_box z -> zero_off I w ->
  (forall i, In i I -> sum I (fun p => Y i p * (2 * q p z w)) = 0) -> w = zero.
Proof.
  intros Bz Zw E. apply functional_extensionality. intros j. unfold zero.
  destruct (in_dec Nat.eq_dec j I) as [Hj|]; [|auto].
  destruct (arg_max I (fun i => Rabs (w i))) as (i & Hi & Max); [now intros ->|].
  assert (Wi : Rabs (w i) <= c * Rabs (w i)).
  { replace (w i) with (slope z i w) at 1 by (unfold slope; rewrite (E i Hi); ring). now apply slope_bound. }
  assert (Rabs (w i) <= 0) by (pose proof (Rabs_pos (w i)); nra).
  specialize (Max j Hj). destruct (Req_dec (w j) 0) as [|N]; [assumption|].
  pose proof (Rabs_pos_lt _ N). lra.
Qed.

(** Krawczyk's map. *)
Definition next (x : vec) : vec := fun i => if in_dec Nat.eq_dec i I then x i - residual i x else x i.

Lemma middle_in_box x y : in_box x -> in_box y -> in_box (move y (1 / 2) (minus x y)).
Proof.
  intros (Ox & Bx) (Oy & By). unfold move, minus. split; intros i Hi.
  - rewrite (Ox i Hi), (Oy i Hi). field.
  - specialize (Bx i Hi). specialize (By i Hi).
    replace (y i + 1 / 2 * (x i - y i) - m i) with (/ 2 * (x i - m i) + / 2 * (y i - m i)) by field.
    eapply Rle_trans; [apply Rabs_triang|]. rewrite !Rabs_mult, (Rabs_right (/ 2)) by lra. lra.
Qed.

Lemma residual_difference x y i :
  residual i x - residual i y = sum I (fun p => Y i p * (2 * q p (move y (1 / 2) (minus x y)) (minus x y))).
Proof.
  unfold residual.
  replace (sum I (fun p => Y i p * (q p x x - k p)) - sum I (fun p => Y i p * (q p y y - k p)))
    with (sum I (fun p => Y i p * (q p x x - k p)) + -1 * sum I (fun p => Y i p * (q p y y - k p))) by ring.
  rewrite <- sum_scal, <- sum_plus. apply sum_ext. intros p _.
  rewrite !minus_move, !q_move_left, !q_move, (q_sym p y x). field.
Qed.

Lemma next_difference x y i : In i I ->
  next x i - next y i = slope (move y (1 / 2) (minus x y)) i (minus x y).
Proof.
  intros Hi. unfold next. destruct in_dec as [_|]; [|easy].
  pose proof (residual_difference x y i) as E. unfold slope. rewrite <- E. unfold minus. ring.
Qed.

Lemma next_contracts x y i s : In i I -> in_box x -> in_box y ->
  (forall j, In j I -> Rabs (x j - y j) <= s) -> Rabs (next x i - next y i) <= c * s.
Proof.
  intros Hi Bx By S. rewrite next_difference by assumption. apply slope_bound; try assumption.
  - now apply middle_in_box.
  - intros j Hj. unfold minus. rewrite (proj1 Bx j Hj), (proj1 By j Hj). ring.
Qed.

Lemma center_in_box : in_box m.
Proof. split; [easy|]. intros i _. replace (m i - m i) with 0 by ring. now rewrite Rabs_R0. Qed.

Lemma next_in_box x : in_box x -> in_box (next x).
Proof.
  intros Bx. split; intros i Hi.
  - unfold next. destruct in_dec; [contradiction|]. now apply Bx.
  - replace (next x i - m i) with ((next x i - next m i) + (next m i - m i)) by ring.
    eapply Rle_trans; [apply Rabs_triang|].
    pose proof (next_contracts x m i r Hi Bx center_in_box (proj2 Bx)).
    assert (Rabs (next m i - m i) <= eta); [|lra].
    unfold next. destruct in_dec; [|contradiction].
    replace (m i - residual i m - m i) with (- residual i m) by ring. rewrite Rabs_Ropp. auto.
Qed.

Fixpoint iterate (n : nat) : vec := match n with O => m | S n => next (iterate n) end.

Lemma iterate_in_box n : in_box (iterate n).
Proof. induction n; [apply center_in_box|now apply next_in_box]. Qed.

Lemma iterate_step n i : In i I -> Rabs (iterate (S n) i - iterate n i) <= r * c ^ n.
Proof.
  revert i. induction n as [|n IH]; intros i Hi.
  - simpl pow. rewrite Rmult_1_r. exact (proj2 (iterate_in_box 1) i Hi).
  - replace (r * c ^ S n) with (c * (r * c ^ n)) by (simpl; ring).
    change (iterate (S (S n))) with (next (iterate (S n))). change (iterate (S n)) with (next (iterate n)) at 2.
    apply next_contracts; auto using iterate_in_box.
Qed.

Lemma iterate_far n j i : In i I -> Rabs (iterate (n + j) i - iterate n i) * (1 - c) <= r * c ^ n.
Proof.
  intros Hi. pose proof (factor_pos i Hi) as Pc.
  assert (H : Rabs (iterate (n + j) i - iterate n i) * (1 - c) <= r * c ^ n - r * c ^ (n + j)).
  { induction j as [|j IH].
    - rewrite Nat.add_0_r. replace (iterate n i - iterate n i) with 0 by ring. rewrite Rabs_R0. lra.
    - rewrite Nat.add_succ_r. pose proof (iterate_step (n + j) i Hi) as Step.
      assert (T : Rabs (iterate (S (n + j)) i - iterate n i) <=
        Rabs (iterate (S (n + j)) i - iterate (n + j) i) + Rabs (iterate (n + j) i - iterate n i)).
      { eapply Rle_trans; [|apply Rabs_triang]. right. f_equal. ring. }
      assert (Q : Rabs (iterate (S (n + j)) i - iterate n i) * (1 - c) <=
        (Rabs (iterate (S (n + j)) i - iterate (n + j) i) + Rabs (iterate (n + j) i - iterate n i)) * (1 - c))
        by (apply Rmult_le_compat_r; lra).
      assert (Q' : Rabs (iterate (S (n + j)) i - iterate (n + j) i) * (1 - c) <= r * c ^ (n + j) * (1 - c))
        by (apply Rmult_le_compat_r; lra).
      replace (c ^ S (n + j)) with (c * c ^ (n + j)) by reflexivity. lra. }
  assert (0 <= r * c ^ (n + j)); [|lra]. apply Rmult_le_pos; [assumption|now apply pow_le].
Qed.

Lemma powers_vanish eps i : In i I -> 0 < eps -> exists n, forall j, (j >= n)%nat -> r * c ^ j < eps.
Proof.
  intros Hi Pe. pose proof (factor_pos i Hi) as Pc.
  destruct (pow_lt_1_zero c ltac:(apply Rabs_def1; lra) (eps / (r + 1))) as (n & Hn).
  { apply Rdiv_lt_0_compat; lra. }
  exists n. intros j Hj. specialize (Hn j Hj). rewrite Rabs_right in Hn by (apply Rle_ge; now apply pow_le).
  apply Rle_lt_trans with ((r + 1) * c ^ j).
  - apply Rmult_le_compat_r; [now apply pow_le|lra].
  - replace eps with ((r + 1) * (eps / (r + 1))) by (field; lra). apply Rmult_lt_compat_l; lra.
Qed.

(** The limit of the iterates, and how far they are from it. *)
Lemma limit i : In i I -> { x : R | forall n, Rabs (x - iterate n i) * (1 - c) <= r * c ^ n }.
Proof.
  intros Hi. destruct (R_complete (fun n => iterate n i)) as (x & Hx).
  - intros eps Pe. destruct (powers_vanish (eps / 2 * (1 - c)) i Hi) as (n & Hn).
    { apply Rmult_lt_0_compat; lra. }
    assert (Near : forall j, (j >= n)%nat -> Rabs (iterate j i - iterate n i) < eps / 2).
    { intros j Hj. apply (Rmult_lt_reg_r (1 - c)); [lra|].
      eapply Rle_lt_trans; [|apply (Hn n); lia].
      replace j with (n + (j - n))%nat by lia. now apply iterate_far. }
    exists n. intros j l Hj Hl. unfold R_dist.
    replace (iterate j i - iterate l i) with
      ((iterate j i - iterate n i) + - (iterate l i - iterate n i)) by ring.
    eapply Rle_lt_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp.
    pose proof (Near j Hj). pose proof (Near l Hl). lra.
  - exists x. intros n. destruct (Rle_lt_dec (Rabs (x - iterate n i) * (1 - c)) (r * c ^ n)) as [|Gt];
      [assumption|exfalso].
    set (gap := Rabs (x - iterate n i) * (1 - c) - r * c ^ n).
    destruct (Hx (gap / (1 - c))) as (N & HN).
    { apply Rdiv_lt_0_compat; unfold gap; lra. }
    specialize (HN (n + N)%nat ltac:(lia)). unfold R_dist in HN.
    pose proof (iterate_far n N i Hi) as Far.
    assert (T : Rabs (x - iterate n i) <=
      Rabs (iterate (n + N) i - x) + Rabs (iterate (n + N) i - iterate n i)).
    { rewrite (Rabs_minus_sym (iterate (n + N) i) x). eapply Rle_trans; [|apply Rabs_triang].
      right. f_equal. ring. }
    apply (Rmult_lt_compat_r (1 - c)) in HN; [|lra].
    replace (gap / (1 - c) * (1 - c)) with gap in HN by (field; lra).
    apply (Rmult_le_compat_r (1 - c)) in T; [|lra]. unfold gap in HN. lra.
Qed.

Definition fixed : vec := fun i =>
  match in_dec Nat.eq_dec i I with left Hi => proj1_sig (limit i Hi) | right _ => m i end.

Lemma fixed_near i n : In i I -> Rabs (fixed i - iterate n i) * (1 - c) <= r * c ^ n.
Proof.
  intros Hi. unfold fixed. destruct in_dec as [H|]; [|contradiction].
  exact (proj2_sig (limit i H) n).
Qed.

Lemma small_limit i a b : In i I -> 0 <= b ->
  (forall n, Rabs a * (1 - c) <= b * (1 - c) + 2 * (r * c ^ n)) -> Rabs a <= b.
Proof.
  intros Hi Pb H. destruct (Rle_lt_dec (Rabs a) b) as [|Gt]; [assumption|exfalso].
  destruct (powers_vanish ((Rabs a - b) * (1 - c) / 2) i Hi) as (n & Hn).
  { apply Rdiv_lt_0_compat; [apply Rmult_lt_0_compat|]; lra. }
  specialize (Hn n (le_n _)). specialize (H n). lra.
Qed.

Lemma fixed_in_box : in_box fixed.
Proof.
  split; intros i Hi.
  - unfold fixed. now destruct in_dec.
  - apply (small_limit i _ _ Hi Pr). intros n.
    pose proof (fixed_near i n Hi) as F. pose proof (proj2 (iterate_in_box n) i Hi) as B.
    assert (T : Rabs (fixed i - m i) <= Rabs (fixed i - iterate n i) + Rabs (iterate n i - m i)).
    { eapply Rle_trans; [|apply Rabs_triang]. right. f_equal. ring. }
    apply (Rmult_le_compat_r (1 - c)) in T; [|lra].
    apply (Rmult_le_compat_r (1 - c)) in B; [|lra].
    assert (0 <= r * c ^ n) by (apply Rmult_le_pos, pow_le, (factor_pos i Hi); assumption). lra.
Qed.

Lemma fixed_next i : In i I -> next fixed i = fixed i.
Proof.
  intros Hi. pose proof (factor_pos i Hi) as Pc.
  assert (E : Rabs (next fixed i - fixed i) <= 0).
  { apply (small_limit i _ _ Hi (Rle_refl 0)). intros n.
    pose proof (fixed_near i (S n) Hi) as F. change (iterate (S n)) with (next (iterate n)) in F.
    assert (N : Rabs (next fixed i - next (iterate n) i) <= c * (r * c ^ n / (1 - c))).
    { apply next_contracts; auto using fixed_in_box, iterate_in_box. intros j Hj.
      apply (Rmult_le_reg_r (1 - c)); [lra|].
      replace (r * c ^ n / (1 - c) * (1 - c)) with (r * c ^ n) by (field; lra). now apply fixed_near. }
    assert (T : Rabs (next fixed i - fixed i) <=
      Rabs (next fixed i - next (iterate n) i) + Rabs (fixed i - next (iterate n) i)).
    { rewrite (Rabs_minus_sym (fixed i)). eapply Rle_trans; [|apply Rabs_triang]. right. f_equal. ring. }
    apply (Rmult_le_compat_r (1 - c)) in T, N; [|lra|lra].
    replace (c * (r * c ^ n / (1 - c)) * (1 - c)) with (r * (c * c ^ n)) in N by (field; lra).
    simpl pow in F. assert (r * (c * c ^ n) <= r * c ^ n).
    { apply Rmult_le_compat_l; [assumption|]. pose proof (pow_le c n Pc) as P.
      apply (Rmult_le_compat_r (c ^ n)) in Pc; [|assumption]. nra. }
    lra. }
  destruct (Req_dec (next fixed i - fixed i) 0) as [|N]; [lra|]. pose proof (Rabs_pos_lt _ N). lra.
Qed.

Lemma residual_zero x : in_box x -> (forall i, In i I -> residual i x = 0) ->
  forall p, In p I -> q p x x = k p.
Proof.
  intros Bx R.
  destruct (solve I (fun p w => 2 * q p x w) once) with (b := fun p => q p x x - k p) as (w & Zw & Hw).
  - intros p _ a s b. rewrite q_move. ring.
  - intros w Zw N. apply (small x); [assumption|assumption|]. intros i Hi. apply sum_zero.
    intros p Hp. rewrite (N p Hp). ring.
  - assert (W : w = zero).
    { apply (small x); [assumption|assumption|]. intros i Hi. rewrite <- (R i Hi). apply sum_ext.
      intros p Hp. now rewrite (Hw p Hp). }
    intros p Hp. specialize (Hw p Hp). rewrite W in Hw.
    rewrite (linear_zero (q p x)) in Hw by (intros a s b; apply q_move). lra.
Qed.

Lemma fixed_solves : in_box fixed /\ forall p, In p I -> q p fixed fixed = k p.
Proof.
  split; [apply fixed_in_box|]. apply residual_zero; [apply fixed_in_box|]. intros i Hi.
  pose proof (fixed_next i Hi) as E. unfold next in E. destruct in_dec; [lra|contradiction].
Qed.

(** Krawczyk's theorem: the box holds exactly one solution. *)
Theorem krawczyk : exists! x, in_box x /\ forall p, In p I -> q p x x = k p.
Proof.
  exists fixed. split.
  - exact fixed_solves.
  - intros y (By & Sy). pose proof fixed_in_box as Bx.
    assert (Sx : forall i, In i I -> residual i fixed = 0).
    { intros i Hi. pose proof (fixed_next i Hi) as E. unfold next in E.
      destruct in_dec; [lra|contradiction]. }
    assert (W : minus fixed y = zero).
    { apply (small (move y (1 / 2) (minus fixed y))).
      - now apply middle_in_box.
      - intros i Hi. unfold minus. rewrite (proj1 Bx i Hi), (proj1 By i Hi). ring.
      - intros i Hi. rewrite <- residual_difference, (Sx i Hi).
        unfold residual. rewrite sum_zero; [ring|]. intros p Hp. rewrite (Sy p Hp). ring. }
    apply functional_extensionality. intros i. apply (f_equal (fun a => a i)) in W.
    unfold minus, zero in W. lra.
Qed.

(** The equations have a nonsingular Jacobian on the whole box. *)
Theorem krawczyk_nonsingular x w : in_box x -> zero_off I w ->
  (forall p, In p I -> q p x w = 0) -> w = zero.
Proof.
  intros Bx Zw E. apply (small x); [assumption|assumption|]. intros i Hi. apply sum_zero.
  intros p Hp. rewrite (E p Hp). ring.
Qed.
End Krawczyk.

(** The bound of the second derivatives that the checker computes. *)
Lemma second_bound I q Y i :
  sum I (fun j => sum I (fun l => Rabs (second I q Y i j l))) <=
  sum I (fun p => Rabs (Y i p) * sum I (fun j => sum I (fun l => Rabs (2 * q p (unit j) (unit l))))).
Proof.
  apply Rle_trans with (sum I (fun j => sum I (fun l =>
    sum I (fun p => Rabs (Y i p) * Rabs (2 * q p (unit j) (unit l)))))).
  - apply sum_le. intros j _. apply sum_le. intros l _. unfold second.
    eapply Rle_trans; [apply sum_abs|]. right. apply sum_ext. intros p _. apply Rabs_mult.
  - right. rewrite (sum_ext I _ (fun j => sum I (fun p =>
      Rabs (Y i p) * sum I (fun l => Rabs (2 * q p (unit j) (unit l)))))).
    + rewrite sum_swap. apply sum_ext. intros p _. now rewrite sum_scal.
    + intros j _. rewrite sum_swap. apply sum_ext. intros p _. now rewrite sum_scal.
Qed.
