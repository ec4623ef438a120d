(** Existence and uniqueness of the solution in the nappes of a sign vector.

    For each [i] in the finite list [I] let [q i] be a symmetric bilinear form, and [t i] a vector
    with q(t, t) > 0 such that the reversed Cauchy inequality q(t, t) q(w, w) <= q(t, w)^2 holds
    (so that [q i] has one positive direction).  Let w = 0 be the only vector that vanishes off [I]
    and has q_i(w, w) <= 0 for all [i] (this is what the key lemma gives).  Then for every vector
    [r], all signs [e] and all right sides [k] >= 0 there is exactly one [h] that agrees with [r]
    off [I] and has q_i(h, h) = k_i and e_i q_i(t_i, h) >= 0 for all [i] in [I].

    No Bezout, no degree, no invariance of domain: with l = q(t, .) / sqrt q(t, t) and the positive
    semidefinite n = l^2 - q, the solutions are the zeros of G = l - e sqrt (n + k).  The sum of the
    |G_i| is Lipschitz and takes its least value; where k > 0, a step of Newton makes it smaller. *)
From Coq Require Import Reals List Permutation Lra Lia Arith FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Box.
Import ListNotations.
Open Scope R_scope.

Definition sign (b : bool) : R := if b then 1 else -1.

Lemma sign_sqr b : sign b * sign b = 1.
Proof. destruct b; simpl; ring. Qed.

Lemma sign_abs b x : Rabs (sign b * x) = Rabs x.
Proof. destruct b; simpl; [rewrite Rmult_1_l|replace (-1 * x) with (- x) by ring; rewrite Rabs_Ropp]; reflexivity. Qed.

(** A quadratic polynomial in [s] that is never negative. *)
Lemma discriminant a b c : 0 <= c -> (forall s, 0 <= a + 2 * s * b + s * s * c) -> b * b <= a * c.
Proof.
  intros Pc H. destruct (Req_dec c 0) as [->|Nc].
  - destruct (Req_dec b 0) as [->|Nb]; [lra|].
    specialize (H (- (a + 1) / (2 * b))). exfalso.
    replace (a + 2 * (- (a + 1) / (2 * b)) * b + _) with (-1) in H by (field; assumption). lra.
  - specialize (H (- b / c)).
    replace (a + 2 * (- b / c) * b + (- b / c) * (- b / c) * c) with ((a * c - b * b) / c) in H
      by (field; assumption).
    apply (Rmult_le_compat_r c) in H; [|assumption]. unfold Rdiv in H.
    rewrite Rmult_assoc, Rinv_l, Rmult_0_l in H by assumption. lra.
Qed.

Lemma abs_le_root x a : x * x <= a -> Rabs x <= sqrt a.
Proof. intros H. rewrite <- sqrt_Rsqr_abs. now apply sqrt_le_1_alt. Qed.

Lemma root_le x a : 0 <= x -> a <= x * x -> sqrt a <= x.
Proof. intros Px H. rewrite <- (sqrt_square x Px). now apply sqrt_le_1_alt. Qed.

(** The root to first order, with a bound of the error. *)
Lemma root_expansion a u : 0 < a -> 0 <= a + u ->
  Rabs (sqrt (a + u) - sqrt a - u / (2 * sqrt a)) <= u * u / (2 * sqrt a * a).
Proof.
  intros Pa Pu. set (s := sqrt a). set (r := sqrt (a + u)).
  assert (0 < s) by now apply sqrt_lt_R0. assert (0 <= r) by apply sqrt_pos.
  assert (S : s * s = a) by (apply sqrt_sqrt; lra). assert (T : r * r = a + u) by now apply sqrt_sqrt.
  replace u with (r * r - s * s) by lra. rewrite <- S.
  replace (r - s - (r * r - s * s) / (2 * s)) with (- ((r - s) * (r - s) / (2 * s))) by (field; lra).
  rewrite Rabs_Ropp, Rabs_right.
  - replace ((r * r - s * s) * (r * r - s * s) / (2 * s * (s * s))) with
      ((r - s) * (r - s) / (2 * s) * (((r + s) * (r + s)) / (s * s))) by (field; lra).
    rewrite <- (Rmult_1_r ((r - s) * (r - s) / (2 * s))) at 1. apply Rmult_le_compat_l.
    + apply Rmult_le_pos; [apply Rle_0_sqr|]. apply Rlt_le, Rinv_0_lt_compat. lra.
    + apply (Rmult_le_reg_r (s * s)); [now apply Rmult_lt_0_compat|].
      unfold Rdiv. rewrite Rmult_assoc, Rinv_l by (apply Rgt_not_eq; now apply Rmult_lt_0_compat).
      assert (0 <= r * r) by (now apply Rmult_le_pos). assert (0 <= r * s) by (apply Rmult_le_pos; lra). lra.
  - apply Rle_ge, Rmult_le_pos; [apply Rle_0_sqr|]. apply Rlt_le, Rinv_0_lt_compat. lra.
Qed.

Section Nappes.
Variable I : list nat.
Variable q : nat -> vec -> vec -> R.
Variable t : nat -> vec.
Hypothesis once : NoDup I.
Hypothesis q_sym : forall i a b, q i a b = q i b a.
Hypothesis q_move : forall i a b s c, q i a (move b s c) = q i a b + s * q i a c.
Hypothesis t_pos : forall i, In i I -> 0 < q i (t i) (t i).
Hypothesis cauchy : forall i w, In i I ->
  q i (t i) (t i) * q i w w <= q i (t i) w * q i (t i) w.
Hypothesis key : forall w, zero_off I w -> (forall i, In i I -> q i w w <= 0) -> w = zero.

Definition l i (w : vec) := q i (t i) w / sqrt (q i (t i) (t i)).
Definition n i (a b : vec) := l i a * l i b - q i a b.
Definition p i (w : vec) := sqrt (n i w w).

Lemma l_move i a s b : l i (move a s b) = l i a + s * l i b.
Proof. unfold l. rewrite q_move. unfold Rdiv. ring. Qed.

Lemma n_sym i a b : n i a b = n i b a.
Proof. unfold n. rewrite (q_sym i a b). ring. Qed.

Lemma n_move i a b s c : n i a (move b s c) = n i a b + s * n i a c.
Proof. unfold n. rewrite l_move, q_move. ring. Qed.

Lemma n_square i a s b : n i (move a s b) (move a s b) = n i a a + 2 * s * n i a b + s * s * n i b b.
Proof.
  rewrite n_move, (n_sym i (move a s b) a), (n_sym i (move a s b) b), !n_move.
  rewrite (n_sym i b a). ring.
Qed.

Section One.
Variable i : nat.
Hypothesis Hi : In i I.

Lemma root_t : 0 < sqrt (q i (t i) (t i)).
Proof. apply sqrt_lt_R0. auto. Qed.

Lemma n_pos w : 0 <= n i w w.
Proof.
  unfold n, l. pose proof root_t as P. pose proof (cauchy i w Hi) as C.
  assert (S : sqrt (q i (t i) (t i)) * sqrt (q i (t i) (t i)) = q i (t i) (t i))
    by (apply sqrt_sqrt, Rlt_le; auto).
  rewrite <- S in C. set (s := sqrt (q i (t i) (t i))) in *.
  apply (Rmult_le_reg_l (s * s)); [now apply Rmult_lt_0_compat|].
  replace (s * s * (q i (t i) w / s * (q i (t i) w / s) - q i w w))
    with (q i (t i) w * q i (t i) w - s * s * q i w w) by (field; lra).
  lra.
Qed.

Lemma p_pos w : 0 <= p i w.
Proof. apply sqrt_pos. Qed.

Lemma p_sqr w : p i w * p i w = n i w w.
Proof. apply sqrt_sqrt, n_pos. Qed.

Lemma n_cauchy a b : Rabs (n i a b) <= p i a * p i b.
Proof.
  unfold p. rewrite <- sqrt_mult by apply n_pos. apply abs_le_root. apply discriminant; [apply n_pos|].
  intros s. rewrite <- n_square. apply n_pos.
Qed.

Lemma p_move a s b : p i (move a s b) <= p i a + Rabs s * p i b.
Proof.
  assert (P : 0 <= Rabs s) by apply Rabs_pos. pose proof (p_pos a). pose proof (p_pos b).
  apply root_le. { pose proof (Rmult_le_pos _ _ P (p_pos b)). lra. }
  rewrite n_square, <- !p_sqr.
  assert (E : s * s = Rabs s * Rabs s) by (rewrite <- Rabs_mult, Rabs_right; [reflexivity|apply Rle_ge, Rle_0_sqr]).
  assert (s * n i a b <= Rabs s * (p i a * p i b)).
  { eapply Rle_trans; [apply Rle_abs|]. rewrite Rabs_mult. apply Rmult_le_compat_l; [assumption|apply n_cauchy]. }
  rewrite E. replace ((p i a + Rabs s * p i b) * (p i a + Rabs s * p i b)) with
    (p i a * p i a + 2 * (Rabs s * (p i a * p i b)) + Rabs s * Rabs s * (p i b * p i b)) by ring.
  lra.
Qed.

(** The roots sqrt (n(x) + k) at two points differ by at most p(x - y). *)
Lemma root_step k y w : 0 <= k ->
  sqrt (n i (move y 1 w) (move y 1 w) + k) <= sqrt (n i y y + k) + p i w.
Proof.
  intros Pk. set (r := sqrt (n i y y + k)).
  assert (Pr : 0 <= r) by apply sqrt_pos. pose proof (p_pos w).
  assert (S : r * r = n i y y + k) by (apply sqrt_sqrt; pose proof (n_pos y); lra).
  apply root_le; [lra|]. rewrite n_square.
  assert (p i y <= r) by (apply sqrt_le_1_alt; lra).
  assert (n i y w <= p i y * p i w) by (eapply Rle_trans; [apply Rle_abs|apply n_cauchy]).
  assert (p i y * p i w <= r * p i w) by (apply Rmult_le_compat_r; assumption).
  replace ((r + p i w) * (r + p i w)) with (r * r + 2 * (r * p i w) + p i w * p i w) by ring.
  rewrite S, p_sqr. lra.
Qed.

Lemma roots_close k x y : 0 <= k ->
  Rabs (sqrt (n i x x + k) - sqrt (n i y y + k)) <= p i (minus x y).
Proof.
  intros Pk.
  pose proof (root_step k y (minus x y) Pk) as A. rewrite move_minus in A.
  pose proof (root_step k x (minus y x) Pk) as B. rewrite move_minus in B.
  assert (E : p i (minus y x) = p i (minus x y)).
  { unfold p. f_equal. rewrite !minus_move, !n_square, (n_sym i y x). ring. }
  rewrite E in B. apply Rabs_le. lra.
Qed.

Lemma below_p : seminorm (fun w => Rabs (l i w) + p i w).
Proof.
  split; [|split].
  - rewrite (linear_zero (l i)) by (intros a s b; apply l_move).
    pose proof (p_move zero (-1) zero) as H. replace (move zero (-1) zero) with zero in H by vec.
    assert (E : n i zero zero = 0).
    { pose proof (linear_zero (n i zero) (fun a s b => n_move i zero a s b)). assumption. }
    unfold p. rewrite E, sqrt_0, Rabs_R0. ring.
  - intros a. pose proof (p_pos a). pose proof (Rabs_pos (l i a)). lra.
  - intros a s b. rewrite l_move. pose proof (p_move a s b).
    pose proof (Rabs_triang (l i a) (s * l i b)) as T. rewrite Rabs_mult in T. lra.
Qed.

End One.

(** The function whose zeros are the solutions. *)
Definition G (e : nat -> bool) (k : nat -> R) (h : vec) (i : nat) :=
  l i h - sign (e i) * sqrt (n i h h + k i).
Definition F e k h := sum I (fun i => Rabs (G e k h i)).

Lemma G_zero e k h i : In i I -> 0 <= k i ->
  (G e k h i = 0 <-> q i h h = k i /\ 0 <= sign (e i) * q i (t i) h).
Proof.
  intros Hi Pk. unfold G.
  assert (Pn : 0 <= n i h h + k i) by (pose proof (n_pos i Hi h); lra).
  set (r := sqrt (n i h h + k i)). assert (0 <= r) by apply sqrt_pos.
  assert (S : r * r = n i h h + k i) by now apply sqrt_sqrt.
  assert (Q : q i h h = l i h * l i h - n i h h) by (unfold n; ring).
  assert (E2 := sign_sqr (e i)). assert (Pt := root_t i Hi).
  assert (El : sign (e i) * q i (t i) h = sign (e i) * l i h * sqrt (q i (t i) (t i)))
    by (unfold l; field; lra).
  split.
  - intros Z. assert (Lh : l i h = sign (e i) * r) by lra. split.
    + rewrite Q, Lh. replace (sign (e i) * r * (sign (e i) * r)) with ((sign (e i) * sign (e i)) * (r * r)) by ring.
      rewrite E2, S. ring.
    + rewrite El, Lh. replace (sign (e i) * (sign (e i) * r)) with ((sign (e i) * sign (e i)) * r) by ring.
      rewrite E2, Rmult_1_l. apply Rmult_le_pos; lra.
  - intros (Qk & Pe). rewrite El in Pe.
    assert (Pl : 0 <= sign (e i) * l i h).
    { apply (Rmult_le_reg_r (sqrt (q i (t i) (t i)))); [assumption|lra]. }
    assert (Sq : (sign (e i) * l i h) * (sign (e i) * l i h) = r * r).
    { replace (sign (e i) * l i h * (sign (e i) * l i h)) with ((sign (e i) * sign (e i)) * (l i h * l i h)) by ring.
      rewrite E2, S. lra. }
    apply Rsqr_inj in Sq; [|assumption|assumption].
    rewrite <- Sq. replace (sign (e i) * (sign (e i) * l i h)) with ((sign (e i) * sign (e i)) * l i h) by ring.
    rewrite E2. ring.
Qed.

Lemma G_below e k x y i : In i I -> 0 <= k i ->
  Rabs (l i (minus x y)) - p i (minus x y) <= Rabs (G e k x i - G e k y i).
Proof.
  intros Hi Pk. pose proof (roots_close i Hi (k i) x y Pk) as R. unfold G.
  rewrite <- (sign_abs (e i)) in R.
  set (d := sign (e i) * _) in R. rewrite minus_move at 1. rewrite l_move.
  replace (l i x - _ - _) with ((l i x + -1 * l i y) - d) by (unfold d; ring).
  pose proof (Rabs_triang_inv (l i x + -1 * l i y) d). lra.
Qed.

Lemma G_above e k x y i : In i I -> 0 <= k i ->
  Rabs (G e k x i - G e k y i) <= Rabs (l i (minus x y)) + p i (minus x y).
Proof.
  intros Hi Pk. pose proof (roots_close i Hi (k i) x y Pk) as R. unfold G.
  rewrite <- (sign_abs (e i)) in R.
  set (d := sign (e i) * _) in R. rewrite minus_move at 1. rewrite l_move.
  replace (l i x - _ - _) with ((l i x + -1 * l i y) + - d) by (unfold d; ring).
  pose proof (Rabs_triang (l i x + -1 * l i y) (- d)) as T. rewrite Rabs_Ropp in T. lra.
Qed.

(** The sum of the positive parts of |l| - p is at least a multiple of the norm. *)
Definition part i w := Rmax 0 (Rabs (l i w) - p i w).
Definition Phi w := sum I (fun i => part i w).

Lemma part_pos i w : 0 <= part i w.
Proof. apply Rmax_l. Qed.

Lemma Phi_positive w : zero_off I w -> w <> zero -> 0 < Phi w.
Proof.
  intros Z N. destruct (Rlt_le_dec 0 (Phi w)) as [|H]; [assumption|]. exfalso. apply N, key; [assumption|].
  intros i Hi. pose proof (sum_nonneg_null I (fun i => part i w) (fun i _ => part_pos i w) H i Hi) as E.
  simpl in E. assert (A : Rabs (l i w) <= p i w).
  { pose proof (Rmax_r 0 (Rabs (l i w) - p i w)). unfold part in E. lra. }
  assert (B : Rabs (l i w) * Rabs (l i w) <= p i w * p i w)
    by (apply Rmult_le_compat; try assumption; apply Rabs_pos).
  rewrite p_sqr in B by assumption. rewrite <- Rabs_mult, Rabs_right in B by apply Rle_ge, Rle_0_sqr.
  unfold n in B. lra.
Qed.

Lemma p_scal i s w : In i I -> p i (move zero s w) = Rabs s * p i w.
Proof.
  intros Hi. unfold p. rewrite n_square.
  assert (E : forall b, n i zero b = 0).
  { intros b. rewrite n_sym. apply (linear_zero (n i b)). intros a u c. apply n_move. }
  rewrite !E. replace (0 + 2 * s * 0 + s * s * n i w w) with (s * s * n i w w) by ring.
  rewrite sqrt_mult by (try apply Rle_0_sqr; now apply n_pos).
  rewrite <- (sqrt_Rsqr_abs s). reflexivity.
Qed.

Lemma Phi_scal s w : Phi (move zero s w) = Rabs s * Phi w.
Proof.
  unfold Phi. rewrite <- sum_scal. apply sum_ext. intros i Hi. unfold part.
  rewrite p_scal, l_move by assumption.
  rewrite (linear_zero (l i)) by (intros a u b; apply l_move).
  rewrite Rplus_0_l, Rabs_mult, <- Rmult_minus_distr_l.
  rewrite <- RmaxRmult by apply Rabs_pos. now rewrite Rmult_0_r.
Qed.

Lemma minus_zero_off x y : (forall i, ~ In i I -> x i = y i) -> zero_off I (minus x y).
Proof. intros E i Hi. unfold minus. rewrite (E i Hi). ring. Qed.

(** Sums of functions that change by at most |l(x - y)| + p(x - y) are Lipschitz. *)
Lemma sum_lipschitz : exists L, 0 <= L /\ forall f : nat -> vec -> R,
  (forall i x y, In i I -> Rabs (f i x - f i y) <= Rabs (l i (minus x y)) + p i (minus x y)) ->
  forall r, lipschitz L I (fun x => sum I (fun i => f i (move r 1 x))).
Proof.
  assert (B : forall J, (forall i, In i J -> In i I) -> exists L, 0 <= L /\
    forall w, zero_off I w -> sum J (fun i => Rabs (l i w) + p i w) <= L * norm I w).
  { induction J as [|i J IH]; intros Sub.
    - exists 0. split; [lra|]. intros w _. simpl. lra.
    - destruct IH as (L & PL & HL); [intros; apply Sub; now right|].
      destruct (seminorm_bound _ I (below_p i (Sub i (or_introl eq_refl))) once) as (M & PM & HM).
      exists (M + L). split; [lra|]. intros w Z. simpl. specialize (HL w Z). specialize (HM w Z). lra. }
  destruct (B I (fun i H => H)) as (L & PL & HL). exists L. split; [assumption|].
  intros f Hf r x y E. simpl.
  eapply Rle_trans; [|apply HL, minus_zero_off, E].
  replace (sum I _ - sum I _) with (sum I (fun i => f i (move r 1 x) - f i (move r 1 y))).
  - eapply Rle_trans; [apply sum_abs|]. apply sum_le. intros i Hi.
    replace (minus x y) with (minus (move r 1 x) (move r 1 y)) by vec. auto.
  - unfold Rminus. rewrite sum_plus. f_equal.
    rewrite (sum_ext I _ (fun i => -1 * f i (move r 1 y))) by (intros; ring). rewrite sum_scal. ring.
Qed.

Lemma part_change i x y : In i I -> Rabs (part i x - part i y) <= Rabs (l i (minus x y)) + p i (minus x y).
Proof.
  intros Hi.
  assert (M : forall a b, Rabs (Rmax 0 a - Rmax 0 b) <= Rabs (a - b)).
  { intros a b. unfold Rmax. destruct (Rle_dec 0 a), (Rle_dec 0 b); unfold Rabs;
    repeat match goal with |- context [Rcase_abs ?x] => destruct (Rcase_abs x) end; lra. }
  eapply Rle_trans; [apply M|].
  pose proof (roots_close i Hi 0 x y (Rle_refl 0)) as R. rewrite !Rplus_0_r in R.
  fold (p i x) in R. fold (p i y) in R.
  assert (A : Rabs (Rabs (l i x) - Rabs (l i y)) <= Rabs (l i (minus x y))).
  { eapply Rle_trans; [apply Rabs_triang_inv2|]. rewrite minus_move, l_move. right. f_equal. ring. }
  replace (_ - _ - _) with ((Rabs (l i x) - Rabs (l i y)) + - (p i x - p i y)) by ring.
  eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp. lra.
Qed.

Lemma Phi_bound_one v : In v I -> exists c, 0 < c /\
  forall w, zero_off I w -> (forall u, In u I -> Rabs (w u) <= 1) -> w v = 1 -> c <= Phi w.
Proof.
  intros Hv. destruct sum_lipschitz as (L & PL & HL).
  pose proof (HL part part_change zero) as Lip. clear HL.
  assert (M : forall x, move zero 1 x = x) by (intros; vec).
  destruct (least_on_box L 1 ltac:(lra) I once (fun x => Phi (upd x v 1))) with (x0 := zero)
    as (x & X0 & XB & Least).
  { intros x y E.
    assert (E' : forall i, ~ In i I -> upd x v 1 i = upd y v 1 i).
    { intros i Hi. rewrite !upd_other; [auto| |]; intros ->; contradiction. }
    specialize (Lip _ _ E'). simpl in Lip. unfold Phi.
    rewrite (sum_ext I _ (fun i => part i (upd x v 1))) in Lip by (intros; now rewrite M).
    rewrite (sum_ext I (fun i => part i (move zero 1 (upd y v 1))) (fun i => part i (upd y v 1))) in Lip
      by (intros; now rewrite M).
    eapply Rle_trans; [exact Lip|]. apply Rmult_le_compat_l; [assumption|].
    apply sum_le. intros u _. unfold minus, upd. destruct Nat.eq_dec; [|lra].
    replace (1 - 1) with 0 by ring. rewrite Rabs_R0. apply Rabs_pos. }
  assert (Z : zero_off I (upd x v 1)).
  { intros i Hi. rewrite upd_other; [|intros ->; contradiction]. now rewrite X0. }
  exists (Phi (upd x v 1)). split.
  - apply Phi_positive; [assumption|]. intros E. apply (f_equal (fun a => a v)) in E.
    rewrite upd_same in E. unfold zero in E. lra.
  - intros w Zw Bw Wv. rewrite <- (upd_id w v), Wv. apply Least; [assumption|].
    intros u Hu. specialize (Bw u Hu).
    pose proof (Rle_abs (w u)). pose proof (Rle_abs (- w u)). rewrite Rabs_Ropp in *. lra.
Qed.

Lemma Phi_bound : exists c, 0 < c /\ forall w, zero_off I w -> c * norm I w <= Phi w.
Proof.
  destruct (common_bound I (fun v c => forall w, zero_off I w ->
    (forall u, In u I -> Rabs (w u) <= 1) -> w v = 1 -> c <= Phi w)) as (c & Pc & Hc).
  { intros v c d H D w Z B W. specialize (H w Z B W). lra. }
  { exact Phi_bound_one. }
  set (m := INR (length I) + 1). assert (Pm : 0 < m) by (pose proof (pos_INR (length I)); unfold m; lra).
  exists (c / m). split; [now apply Rdiv_lt_0_compat|]. intros w Z.
  assert (NI : I = [] \/ I <> []) by (destruct I; [left|right]; easy).
  destruct NI as [NI|NI]; [unfold norm, Phi; rewrite NI; simpl; lra|].
  destruct (arg_max I (fun v => Rabs (w v))) as (v & Hv & Max); [exact NI|].
  assert (Nw : norm I w <= INR (length I) * Rabs (w v)) by now apply sum_const_le.
  destruct (Req_dec (w v) 0) as [E|E].
  { rewrite E, Rabs_R0, Rmult_0_r in Nw. pose proof (norm_nonneg I w).
    replace (norm I w) with 0 by lra. rewrite Rmult_0_r. apply sum_nonneg. intros; apply part_pos. }
  assert (Pw : 0 < Rabs (w v)) by now apply Rabs_pos_lt.
  assert (H : c <= Phi (move zero (/ w v) w)).
  { apply (Hc v Hv).
    - intros i Hi. unfold move. rewrite (Z i Hi). unfold zero. ring.
    - intros u Hu. unfold move, zero. rewrite Rplus_0_l, Rabs_mult, Rabs_inv.
      apply (Rmult_le_reg_l (Rabs (w v))); [assumption|]. rewrite <- Rmult_assoc, Rinv_r by lra.
      rewrite Rmult_1_l, Rmult_1_r. auto.
    - unfold move, zero. field. assumption. }
  rewrite Phi_scal, Rabs_inv in H.
  apply (Rmult_le_compat_r (Rabs (w v))) in H; [|lra].
  replace (/ Rabs (w v) * Phi w * Rabs (w v)) with (Phi w) in H by (field; lra).
  eapply Rle_trans; [|exact H].
  apply (Rmult_le_reg_r m); [assumption|].
  replace (c / m * norm I w * m) with (c * norm I w) by (field; lra).
  rewrite Rmult_assoc. apply Rmult_le_compat_l; [lra|].
  replace (Rabs (w v) * m) with (INR (length I) * Rabs (w v) + Rabs (w v)) by (unfold m; ring). lra.
Qed.

(** |G(x) - G(y)| >= c |x - y|. *)
Lemma G_injective_bound e k : (forall i, In i I -> 0 <= k i) ->
  exists c, 0 < c /\ forall x y, (forall i, ~ In i I -> x i = y i) ->
    c * norm I (minus x y) <= sum I (fun i => Rabs (G e k x i - G e k y i)).
Proof.
  intros Pk. destruct Phi_bound as (c & Pc & Hc). exists c. split; [assumption|]. intros x y E.
  eapply Rle_trans; [apply Hc, minus_zero_off, E|].
  apply sum_le. intros i Hi. apply Rmax_lub; [apply Rabs_pos|]. apply G_below; auto.
Qed.

Definition agree (h r : vec) := forall i, ~ In i I -> h i = r i.

Lemma agree_move r w : zero_off I w -> agree (move r 1 w) r.
Proof. intros Z i Hi. unfold move. rewrite (Z i Hi). ring. Qed.

Theorem unique e k x y : (forall i, In i I -> 0 <= k i) -> agree x y ->
  (forall i, In i I -> G e k x i = 0) -> (forall i, In i I -> G e k y i = 0) -> x = y.
Proof.
  intros Pk E Zx Zy. destruct (G_injective_bound e k Pk) as (c & Pc & H). specialize (H x y E).
  rewrite sum_zero in H.
  - assert (N : minus x y = zero).
    { apply (norm_zero I); [now apply minus_zero_off|].
      apply (Rmult_le_reg_l c); [assumption|]. lra. }
    rewrite <- (move_minus x y), N. vec.
  - intros i Hi. rewrite Zx, Zy by assumption. replace (0 - 0) with 0 by ring. apply Rabs_R0.
Qed.

(** The sum of the |G_i| takes its least value. *)
Lemma F_least e k r : (forall i, In i I -> 0 <= k i) ->
  exists x, agree x r /\ forall y, agree y r -> F e k x <= F e k y.
Proof.
  intros Pk. destruct (G_injective_bound e k Pk) as (c & Pc & Low).
  destruct sum_lipschitz as (L & PL & HL).
  assert (Lip : lipschitz L I (fun x => F e k (move r 1 x))).
  { apply (HL (fun i x => Rabs (G e k x i))). intros i x y Hi.
    eapply Rle_trans; [apply Rabs_triang_inv2|]. apply G_above; auto. }
  assert (PF : forall h, 0 <= F e k h) by (intros; apply sum_nonneg; intros; apply Rabs_pos).
  set (B := 2 * F e k r / c).
  assert (PB : 0 <= B). { apply Rmult_le_pos; [pose proof (PF r); lra|]. now apply Rlt_le, Rinv_0_lt_compat. }
  destruct (least_on_box L B PB I once _ Lip zero) as (x & X0 & XB & Least).
  exists (move r 1 x). split; [apply agree_move; exact X0|]. intros y Ey.
  set (w := minus y r). assert (Zw : zero_off I w) by now apply minus_zero_off.
  replace y with (move r 1 w) by (unfold w; vec).
  destruct (Rle_lt_dec (norm I w) B) as [Small|Large].
  - apply Least; [exact Zw|]. intros i Hi.
    pose proof (sum_ge_term I (fun i => Rabs (w i)) i (fun i _ => Rabs_pos (w i)) Hi) as T. fold (norm I w) in T.
    simpl in T. pose proof (Rle_abs (w i)). pose proof (Rle_abs (- w i)). rewrite Rabs_Ropp in *. lra.
  - assert (F e k (move r 1 x) <= F e k r).
    { replace r with (move r 1 zero) at 2 by vec. apply Least; [easy|]. intros. unfold zero. lra. }
    specialize (Low (move r 1 w) r (agree_move r w Zw)).
    replace (minus (move r 1 w) r) with w in Low by vec.
    assert (sum I (fun i => Rabs (G e k (move r 1 w) i - G e k r i)) <= F e k (move r 1 w) + F e k r).
    { unfold F. rewrite <- sum_plus. apply sum_le. intros i _. unfold Rminus.
      eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp. lra. }
    assert (2 * F e k r = c * B) by (unfold B; field; lra).
    assert (c * B <= c * norm I w) by (apply Rmult_le_compat_l; lra). lra.
Qed.

(** Newton's step: for k > 0 the linear equations of the step can be solved. *)
Definition slope k x i (w : vec) (e : nat -> bool) :=
  l i w - sign (e i) * (n i x w / sqrt (n i x x + k i)).

Lemma step_exists e k x b : (forall i, In i I -> 0 < k i) ->
  exists w, zero_off I w /\ forall i, In i I -> slope k x i w e = b i.
Proof.
  intros Pk. apply (solve I (fun i w => slope k x i w e)); [exact once| |].
  - intros i Hi a s c. unfold slope. rewrite l_move, n_move. unfold Rdiv. ring.
  - intros w Z E. destruct (Rle_lt_dec (Phi w) 0) as [H|H].
    + destruct (Phi_bound) as (c & Pc & B). specialize (B w Z). apply (norm_zero I); [assumption|].
      apply (Rmult_le_reg_l c); [assumption|]. lra.
    + exfalso. assert (Phi w <= 0); [|lra]. apply sum_nonpos. intros i Hi.
      apply Rmax_lub; [lra|]. specialize (E i Hi). unfold slope in E.
      assert (El : l i w = sign (e i) * (n i x w / sqrt (n i x x + k i))) by lra.
      rewrite El, sign_abs. specialize (Pk i Hi).
      assert (Ps : 0 < sqrt (n i x x + k i)). { apply sqrt_lt_R0. pose proof (n_pos i Hi x). lra. }
      assert (Px : p i x <= sqrt (n i x x + k i)) by (apply sqrt_le_1_alt; lra).
      unfold Rdiv. rewrite Rabs_mult, Rabs_inv, (Rabs_right (sqrt _)) by lra.
      assert (Rabs (n i x w) * / sqrt (n i x x + k i) <= p i w); [|lra].
      apply (Rmult_le_reg_r (sqrt (n i x x + k i))); [assumption|].
      rewrite Rmult_assoc, Rinv_l, Rmult_1_r by lra.
      eapply Rle_trans; [now apply n_cauchy|]. rewrite Rmult_comm.
      apply Rmult_le_compat_l; [now apply p_pos|assumption].
Qed.

(** G along a line, to first order. *)
Lemma G_along e k x w i : In i I -> 0 < k i -> exists C, 0 <= C /\ forall s, 0 <= s <= 1 ->
  Rabs (G e k (move x s w) i - (G e k x i + s * slope k x i w e)) <= C * (s * s).
Proof.
  intros Hi Pk. set (a := n i x x + k i).
  assert (Pa : 0 < a) by (pose proof (n_pos i Hi x); unfold a; lra).
  assert (Pr : 0 < sqrt a) by now apply sqrt_lt_R0.
  set (m := 2 * Rabs (n i x w) + n i w w). assert (Pn := n_pos i Hi w).
  assert (Pm : 0 <= m) by (pose proof (Rabs_pos (n i x w)); unfold m; lra).
  set (D := / (2 * sqrt a * a)).
  assert (PD : 0 <= D).
  { apply Rlt_le, Rinv_0_lt_compat. apply Rmult_lt_0_compat; lra. }
  exists (m * m * D + n i w w / (2 * sqrt a)). split.
  { pose proof (Rmult_le_pos _ _ (Rmult_le_pos _ _ Pm Pm) PD).
    assert (0 <= n i w w / (2 * sqrt a)); [|lra].
    apply Rmult_le_pos; [assumption|]. apply Rlt_le, Rinv_0_lt_compat. lra. }
  intros s Hs. unfold G, slope. fold a. rewrite l_move, n_square.
  set (u := 2 * s * n i x w + s * s * n i w w).
  replace (n i x x + 2 * s * n i x w + s * s * n i w w + k i) with (a + u) by (unfold a, u; ring).
  assert (Pu : 0 <= a + u).
  { replace (a + u) with (n i (move x s w) (move x s w) + k i) by (rewrite n_square; unfold a, u; ring).
    pose proof (n_pos i Hi (move x s w)). lra. }
  pose proof (root_expansion a u Pa Pu) as X.
  replace (l i x + s * l i w - sign (e i) * sqrt (a + u) -
    (l i x - sign (e i) * sqrt a + s * (l i w - sign (e i) * (n i x w / sqrt a)))) with
    (sign (e i) * (- (sqrt (a + u) - sqrt a - u / (2 * sqrt a)) + - (s * s * (n i w w / (2 * sqrt a)))))
    by (unfold u; field; lra).
  rewrite sign_abs. eapply Rle_trans; [apply Rabs_triang|]. rewrite !Rabs_Ropp.
  assert (Q : 0 <= s * s * (n i w w / (2 * sqrt a))).
  { apply Rmult_le_pos; [apply Rle_0_sqr|]. apply Rmult_le_pos; [assumption|].
    apply Rlt_le, Rinv_0_lt_compat. lra. }
  rewrite (Rabs_right (s * s * _)) by lra.
  assert (U : Rabs u <= s * m).
  { unfold u, m. replace (2 * s * n i x w + s * s * n i w w) with (s * (2 * n i x w + s * n i w w)) by ring.
    rewrite Rabs_mult, (Rabs_right s) by lra. apply Rmult_le_compat_l; [lra|].
    eapply Rle_trans; [apply Rabs_triang|].
    rewrite !Rabs_mult, (Rabs_right 2), (Rabs_right s), (Rabs_right (n i w w)) by lra.
    assert (s * n i w w <= 1 * n i w w) by (apply Rmult_le_compat_r; lra). lra. }
  assert (UU : u * u <= s * m * (s * m)).
  { rewrite <- (Rabs_right (u * u)) by apply Rle_ge, Rle_0_sqr. rewrite Rabs_mult.
    apply Rmult_le_compat; try assumption; apply Rabs_pos. }
  unfold Rdiv in X at 2. fold D in X.
  assert (u * u * D <= s * m * (s * m) * D) by (apply Rmult_le_compat_r; assumption).
  replace ((m * m * D + n i w w / (2 * sqrt a)) * (s * s)) with
    (s * m * (s * m) * D + s * s * (n i w w / (2 * sqrt a))) by ring.
  lra.
Qed.

Lemma exists_positive e k r : (forall i, In i I -> 0 < k i) ->
  exists x, agree x r /\ forall i, In i I -> G e k x i = 0.
Proof.
  intros Pk. destruct (F_least e k r) as (x & Ex & Least); [intros; apply Rlt_le; auto|].
  exists x. split; [assumption|].
  assert (PG : forall i, In i I -> 0 <= Rabs (G e k x i)) by (intros; apply Rabs_pos).
  assert (F0 : F e k x <= 0).
  { destruct (step_exists e k x (fun i => - G e k x i) Pk) as (w & Zw & W).
    assert (B : forall J, (forall i, In i J -> In i I) -> exists C, 0 <= C /\ forall s, 0 <= s <= 1 ->
      sum J (fun i => Rabs (G e k (move x s w) i)) <= (1 - s) * sum J (fun i => Rabs (G e k x i)) + C * (s * s)).
    { induction J as [|i J IH]; intros Sub; [exists 0; split; [lra|]; intros; simpl; lra|].
      destruct IH as (C & PC & HC); [intros; apply Sub; now right|].
      assert (Hi : In i I) by (apply Sub; now left).
      destruct (G_along e k x w i Hi (Pk i Hi)) as (D & PD & HD).
      exists (D + C). split; [lra|]. intros s Hs. specialize (HC s Hs). specialize (HD s Hs).
      rewrite (W i Hi) in HD. simpl.
      assert (Rabs (G e k (move x s w) i) <= (1 - s) * Rabs (G e k x i) + D * (s * s)); [|lra].
      set (g' := G e k (move x s w) i) in *. set (g := G e k x i) in *.
      replace g' with ((1 - s) * g + (g' - (g + s * - g))) by ring.
      eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_mult, (Rabs_right (1 - s)) by lra. lra. }
    destruct (B I (fun i H => H)) as (C & PC & HC). clear B.
    destruct (Rle_lt_dec (F e k x) 0) as [|Pos]; [assumption|exfalso].
    set (f := F e k x) in *. set (s := Rmin 1 (f / (2 * (C + 1)))).
    assert (Ps : 0 < s). { apply Rmin_pos; [lra|]. apply Rdiv_lt_0_compat; lra. }
    assert (s <= 1) by apply Rmin_l.
    assert (S : s <= f / (2 * (C + 1))) by apply Rmin_r.
    specialize (HC s). assert (0 <= s <= 1) as Hs by lra. specialize (HC Hs).
    fold (F e k (move x s w)) in HC. fold (F e k x) in HC. fold f in HC.
    assert (f <= F e k (move x s w)).
    { apply Least. intros i Hi. unfold move. rewrite (Zw i Hi), Rmult_0_r, Rplus_0_r. now apply Ex. }
    apply (Rmult_le_compat_r (2 * (C + 1))) in S; [|lra].
    replace (f / (2 * (C + 1)) * (2 * (C + 1))) with f in S by (field; lra).
    assert (s * f <= s * (C * s)) by lra.
    assert (f <= C * s) by (apply (Rmult_le_reg_l s); assumption).
    assert (0 <= s * C) by (apply Rmult_le_pos; lra). lra. }
  intros i Hi. pose proof (sum_nonneg_null I _ PG F0 i Hi) as E. simpl in E.
  destruct (Req_dec (G e k x i) 0) as [|N]; [assumption|]. apply Rabs_no_R0 in N. contradiction.
Qed.

Lemma exists_nonnegative e k r : (forall i, In i I -> 0 <= k i) ->
  exists x, agree x r /\ forall i, In i I -> G e k x i = 0.
Proof.
  intros Pk. destruct (F_least e k r Pk) as (x & Ex & Least). exists x. split; [assumption|].
  assert (PG : forall i, In i I -> 0 <= Rabs (G e k x i)) by (intros; apply Rabs_pos).
  assert (B : forall d, 0 < d -> F e k x <= INR (length I) * d).
  { intros d Pd. destruct (exists_positive e (fun i => k i + d * d) r) as (y & Ey & Gy).
    { intros i Hi. specialize (Pk i Hi). assert (0 < d * d) by now apply Rmult_lt_0_compat. lra. }
    apply Rle_trans with (F e k y); [now apply Least|]. apply sum_const_le. intros i Hi.
    specialize (Gy i Hi). specialize (Pk i Hi). unfold G in *. pose proof (n_pos i Hi y) as Pn.
    set (a := n i y y + k i) in *.
    replace (n i y y + (k i + d * d)) with (a + d * d) in Gy by (unfold a; ring).
    replace (l i y) with (sign (e i) * sqrt (a + d * d)) by lra.
    rewrite <- Rmult_minus_distr_l, sign_abs.
    assert (Pa : 0 <= a) by (unfold a; lra). assert (0 <= d * d) by apply Rle_0_sqr.
    assert (sqrt a <= sqrt (a + d * d)) by (apply sqrt_le_1_alt; lra).
    rewrite Rabs_right by lra.
    assert (sqrt (a + d * d) <= sqrt a + d); [|lra].
    pose proof (sqrt_pos a) as Pr. apply root_le; [lra|].
    assert (sqrt a * sqrt a = a) by now apply sqrt_sqrt. assert (0 <= sqrt a * d) by (apply Rmult_le_pos; lra). lra. }
  assert (F0 : F e k x <= 0).
  { destruct (Rle_lt_dec (F e k x) 0) as [|Pos]; [assumption|exfalso].
    set (f := F e k x) in *. set (m := INR (length I)) in *.
    assert (Pm : 0 <= m) by apply pos_INR.
    specialize (B (f / (2 * (m + 1)))).
    assert (f <= m * (f / (2 * (m + 1)))) by (apply B, Rdiv_lt_0_compat; lra).
    assert (m * (f / (2 * (m + 1))) <= (m + 1) * (f / (2 * (m + 1)))).
    { apply Rmult_le_compat_r; [|lra]. apply Rlt_le, Rdiv_lt_0_compat; lra. }
    assert ((m + 1) * (f / (2 * (m + 1))) = f / 2) by (field; lra). lra. }
  intros i Hi. pose proof (sum_nonneg_null I _ PG F0 i Hi) as E. simpl in E.
  destruct (Req_dec (G e k x i) 0) as [|N]; [assumption|]. apply Rabs_no_R0 in N. contradiction.
Qed.

(** The theorem. *)
Theorem one_solution e k r : (forall i, In i I -> 0 <= k i) ->
  exists! h, agree h r /\ forall i, In i I -> q i h h = k i /\ 0 <= sign (e i) * q i (t i) h.
Proof.
  intros Pk. destruct (exists_nonnegative e k r Pk) as (x & Ex & Gx). exists x. split.
  - split; [assumption|]. intros i Hi. apply G_zero; auto.
  - intros y (Ey & Hy). apply (unique e k); auto.
    + intros i Hi. now rewrite Ex, Ey.
    + intros i Hi. apply G_zero; auto.
Qed.

End Nappes.
