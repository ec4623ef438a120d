(** Quadratic equations with a parameter: near a regular zero at s = 0 there is exactly one zero for every small s,
    and it depends on s as a Lipschitz function (docs/motion.md, section 2; the contraction is that of Krawczyk.v). *)
From Coq Require Import Reals List Lra Lia Arith FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Krawczyk.
Import ListNotations.
Open Scope R_scope.

(** ** Linear algebra *)

Lemma choose {B} (l : list nat) (P : nat -> B -> Prop) (b : B) :
  (forall i, In i l -> exists a, P i a) -> exists f, forall i, In i l -> P i (f i).
Proof.
  induction l as [|j l IH]; intros H.
  - exists (fun _ => b). easy.
  - destruct (H j (or_introl eq_refl)) as (a & Ha). destruct IH as (f & Hf); [intros; apply H; now right|].
    exists (fun i => if Nat.eq_dec i j then a else f i). intros i Hi.
    destruct (Nat.eq_dec i j) as [->|Ne]; [exact Ha|]. destruct Hi as [->|Hi]; [contradiction|auto].
Qed.

Lemma sum_unit I w i : NoDup I -> In i I -> sum I (fun p => w p * unit i p) = w i.
Proof.
  intros D Hi. induction I as [|j I IH]; [easy|]. inversion D as [|? ? Nj D']; subst. simpl.
  destruct (Nat.eq_dec i j) as [->|Ne].
  - unfold unit at 1. rewrite upd_same, sum_zero; [ring|]. intros p Hp. unfold unit.
    rewrite upd_other by (intros ->; contradiction). unfold zero. ring.
  - destruct Hi as [->|Hi]; [contradiction|]. unfold unit at 1. rewrite upd_other by auto. unfold zero at 1.
    rewrite (IH D' Hi). ring.
Qed.

Lemma sum_delta I f i : NoDup I -> In i I -> sum I (fun p => delta i p * f p) = f i.
Proof.
  intros D Hi. rewrite <- (sum_unit I f i D Hi). apply sum_ext. intros p _. rewrite Rmult_comm. f_equal.
  unfold delta, unit, upd, zero. destruct (Nat.eq_dec i p), (Nat.eq_dec p i); congruence.
Qed.

(** A linear function on a box. *)
Lemma linear_on_box f I r v : linear f -> NoDup I -> zero_off I v -> (forall i, In i I -> Rabs (v i) <= r) ->
  Rabs (f v) <= r * sum I (fun i => Rabs (f (unit i))).
Proof.
  intros L D Z B. rewrite (linear_coordinates f I v L D Z), <- sum_scal.
  eapply Rle_trans; [apply sum_abs|]. apply sum_le. intros i Hi. rewrite Rabs_mult, Rmult_comm.
  apply Rmult_le_compat_r; [apply Rabs_pos|auto].
Qed.

(** Linear equations whose only solution for right side 0 is 0 have a left inverse. *)
Lemma left_inverse {A} (E : list A) I (L : A -> vec -> R) : NoDup I -> (forall e, linear (L e)) ->
  (forall w, zero_off I w -> (forall e, In e E -> L e w = 0) -> w = zero) ->
  exists Z : nat -> A -> R, forall i w, In i I -> zero_off I w -> sum E (fun e => Z i e * L e w) = w i.
Proof.
  intros D Lin Inj. set (M := fun p w => sum E (fun e => L e (unit p) * L e w)).
  assert (Pair : forall v w, zero_off I v -> sum I (fun p => v p * M p w) = sum E (fun e => L e v * L e w)).
  { intros v w Zv. unfold M. rewrite (sum_ext I _ (fun p => sum E (fun e => L e (unit p) * v p * L e w)))
      by (intros; rewrite <- sum_scal; apply sum_ext; intros; ring).
    rewrite sum_swap. apply sum_ext. intros e _. rewrite (linear_coordinates (L e) I v (Lin e) D Zv).
    rewrite (Rmult_comm _ (L e w)), <- sum_scal. apply sum_ext. intros. ring. }
  assert (ML : forall p, linear (M p)).
  { intros p a s b. unfold M. rewrite <- sum_scal, <- sum_plus. apply sum_ext. intros e _. rewrite (Lin e a s b).
    ring. }
  assert (MI : forall w, zero_off I w -> (forall p, In p I -> M p w = 0) -> w = zero).
  { intros w Zw Hw. apply Inj; [assumption|].
    assert (S0 : sum E (fun e => L e w * L e w) <= 0).
    { rewrite <- (Pair w w Zw). right. apply sum_zero. intros p Hp. rewrite (Hw p Hp). ring. }
    intros e He. pose proof (sum_nonneg_null E _ (fun e _ => Rle_0_sqr (L e w)) S0 e He) as Q.
    unfold Rsqr in Q. apply Rmult_integral in Q. tauto. }
  destruct (choose I (fun i y => zero_off I y /\ forall p, In p I -> M p y = unit i p) zero) as (y & Hy).
  { intros i _. apply (solve I M D (fun p _ => ML p) MI (unit i)). }
  exists (fun i e => L e (y i)). intros i w Hi Zw. destruct (Hy i Hi) as (Zy & My).
  rewrite <- (sum_unit I w i D Hi). rewrite (sum_ext I _ (fun p => w p * M p (y i))) by (intros p Hp; now rewrite My).
  rewrite Pair by assumption. apply sum_ext. intros. ring.
Qed.

(** So they determine the unknowns stably. *)
Lemma left_bound {A} (E : list A) I (L : A -> vec -> R) : NoDup I -> (forall e, linear (L e)) ->
  (forall w, zero_off I w -> (forall e, In e E -> L e w = 0) -> w = zero) ->
  exists C, 0 <= C /\ forall w r, zero_off I w -> (forall e, In e E -> Rabs (L e w) <= r) -> norm I w <= C * r.
Proof.
  intros D Lin Inj. destruct (left_inverse E I L D Lin Inj) as (Z & HZ).
  exists (sum I (fun i => sum E (fun e => Rabs (Z i e)))). split.
  { apply sum_nonneg. intros. apply sum_nonneg. intros. apply Rabs_pos. }
  intros w r Zw B. unfold norm. rewrite Rmult_comm, <- sum_scal. apply sum_le. intros i Hi.
  rewrite <- (HZ i w Hi Zw), <- sum_scal. eapply Rle_trans; [apply sum_abs|]. apply sum_le. intros e He.
  rewrite Rabs_mult, Rmult_comm. apply Rmult_le_compat_r; [apply Rabs_pos|auto].
Qed.

(** ** As many equations as unknowns, with the derivative Id at s = 0 *)

Section Square.
Variable I : list nat.
Variables a b : nat -> vec -> vec -> R.
Variable k : nat -> R.
Variable m : vec.
Hypothesis once : NoDup I.
Hypothesis a_sym : forall i x y, a i x y = a i y x.
Hypothesis a_move : forall i x y s z, a i x (move y s z) = a i x y + s * a i x z.
Hypothesis b_sym : forall i x y, b i x y = b i y x.
Hypothesis b_move : forall i x y s z, b i x (move y s z) = b i x y + s * b i x z.
Hypothesis Zero : forall i, In i I -> a i m m = k i.
Hypothesis Identity : forall i w, In i I -> zero_off I w -> 2 * a i m w = w i.

Definition form (s : R) (i : nat) (x y : vec) : R := a i x y + s * b i x y.

Lemma form_sym s i x y : form s i x y = form s i y x.
Proof. unfold form. now rewrite a_sym, b_sym. Qed.
Lemma form_move s i x y t z : form s i x (move y t z) = form s i x y + t * form s i x z.
Proof. unfold form. rewrite a_move, b_move. ring. Qed.

(** One number that bounds all constants of Krawczyk's test. *)
Definition bound (i : nat) : R :=
  Rabs (b i m m) + sum I (fun j => Rabs (2 * b i m (unit j))) +
  sum I (fun j => sum I (fun l => Rabs (2 * a i (unit j) (unit l)) + Rabs (2 * b i (unit j) (unit l)))).
Definition size : R := sum I bound.

Lemma double_pos (f : nat -> nat -> R) : (forall j l, 0 <= f j l) -> 0 <= sum I (fun j => sum I (f j)).
Proof. intros P. apply sum_nonneg. intros. apply sum_nonneg. auto. Qed.

Lemma bound_parts i : 0 <= Rabs (b i m m) /\ 0 <= sum I (fun j => Rabs (2 * b i m (unit j))) /\
  0 <= sum I (fun j => sum I (fun l => Rabs (2 * a i (unit j) (unit l)) + Rabs (2 * b i (unit j) (unit l)))).
Proof.
  split; [apply Rabs_pos|]. split; [apply sum_nonneg; intros; apply Rabs_pos|]. apply double_pos. intros.
  apply Rplus_le_le_0_compat; apply Rabs_pos.
Qed.

Lemma bound_size i : In i I -> bound i <= size.
Proof.
  intros Hi. apply (sum_ge_term I bound); [|assumption]. intros j _. pose proof (bound_parts j). unfold bound. lra.
Qed.

Lemma size_pos : 0 <= size.
Proof. apply sum_nonneg. intros j _. pose proof (bound_parts j). unfold bound. lra. Qed.

Notation q := form.
Notation Y := delta.

Lemma residual_form s i x : In i I -> residual I (q s) k Y i x = q s i x x - k i.
Proof. intros Hi. unfold residual. exact (sum_delta I (fun p => q s p x x - k p) i once Hi). Qed.

Lemma res_bound s i : In i I -> Rabs (residual I (q s) k Y i m) <= Rabs s * size.
Proof.
  intros Hi. rewrite residual_form by assumption. unfold form. rewrite Zero by assumption.
  replace (k i + s * b i m m - k i) with (s * b i m m) by ring. rewrite Rabs_mult.
  apply Rmult_le_compat_l; [apply Rabs_pos|]. pose proof (bound_size i Hi). pose proof (bound_parts i).
  unfold bound in *. lra.
Qed.

Lemma unit_zero_off j : In j I -> zero_off I (unit j).
Proof. intros Hj l Hl. unfold unit. rewrite upd_other; [reflexivity|]. intros ->. contradiction. Qed.

Lemma inv_bound s i : In i I -> sum I (fun j => Rabs (delta i j - entry I (q s) m Y i j)) <= Rabs s * size.
Proof.
  intros Hi. apply Rle_trans with (Rabs s * sum I (fun j => Rabs (2 * b i m (unit j)))).
  - rewrite <- sum_scal. apply sum_le. intros j Hj. unfold entry.
    rewrite (sum_delta I (fun p => 2 * q s p m (unit j)) i once Hi). unfold form.
    replace (delta i j) with (2 * a i m (unit j)).
    + right. rewrite <- Rabs_mult, <- Rabs_Ropp. f_equal. ring.
    + rewrite Identity by (try assumption; now apply unit_zero_off). unfold delta, unit, upd, zero.
      destruct (Nat.eq_dec i j); congruence.
  - apply Rmult_le_compat_l; [apply Rabs_pos|]. pose proof (bound_size i Hi). pose proof (bound_parts i).
    unfold bound in *. lra.
Qed.

Lemma sec_bound s i : Rabs s <= 1 -> In i I ->
  sum I (fun j => sum I (fun l => Rabs (second I (q s) Y i j l))) <= size.
Proof.
  intros Ps Hi. apply Rle_trans with (sum I (fun j => sum I (fun l =>
    Rabs (2 * a i (unit j) (unit l)) + Rabs (2 * b i (unit j) (unit l))))).
  - apply sum_le. intros j _. apply sum_le. intros l _. unfold second.
    rewrite (sum_delta I (fun p => 2 * q s p (unit j) (unit l)) i once Hi). unfold form.
    replace (2 * (a i (unit j) (unit l) + s * b i (unit j) (unit l))) with
      (2 * a i (unit j) (unit l) + s * (2 * b i (unit j) (unit l))) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. apply Rplus_le_compat_l. rewrite Rabs_mult.
    pose proof (Rabs_pos (2 * b i (unit j) (unit l))). nra.
  - pose proof (bound_size i Hi). pose proof (bound_parts i). unfold bound in *. lra.
Qed.

(** How far the parameter may go, and how far the zero may be. *)
Definition reach : R := / (4 * (size + 1)).
Definition width : R := reach / (2 * (size + 1)).
Definition slope_of (s : R) : R := Rabs s * size + reach * size.

Lemma sizes : 0 < reach /\ reach <= 1 / 4 /\ 0 < width /\ width <= 1 /\ reach * size <= 1 / 4 /\
  width * size <= reach / 2.
Proof.
  pose proof size_pos as P. assert (Q : reach * (size + 1) = 1 / 4) by (unfold reach; field; lra).
  assert (Pr : 0 < reach) by (apply Rinv_0_lt_compat; lra). assert (0 <= reach * size) by (apply Rmult_le_pos; lra).
  assert (T : width * (size + 1) = reach / 2) by (unfold width; field; lra).
  assert (Pt : 0 < width) by (apply Rdiv_lt_0_compat; lra). repeat split; nra.
Qed.

Lemma slope_small s : Rabs s <= width -> 0 <= slope_of s <= 1 / 2.
Proof.
  intros H. pose proof sizes. pose proof size_pos. pose proof (Rabs_pos s). unfold slope_of.
  assert (0 <= Rabs s * size <= width * size) by (split; [apply Rmult_le_pos|apply Rmult_le_compat_r]; lra).
  assert (0 <= reach * size) by (apply Rmult_le_pos; lra). lra.
Qed.

Lemma growth i y : In i I -> in_box I m reach y -> Rabs (b i y y) <= size.
Proof.
  intros Hi (Off & Box). destruct sizes as (Pr & Pr1 & _). set (v := minus y m).
  assert (Zv : zero_off I v) by (intros j Hj; unfold v, minus; rewrite (Off j Hj); ring).
  assert (Bv : forall j, In j I -> Rabs (v j) <= reach) by exact Box.
  assert (Lin : forall x, linear (b i x)) by (intros x c t d; apply b_move).
  replace (b i y y) with (b i m m + 2 * b i m v + b i v v).
  2:{ replace y with (move m 1 v) by (unfold v; vec).
      rewrite b_move, !(b_sym i (move m 1 v)), !b_move, (b_sym i v m). ring. }
  assert (B1 : Rabs (2 * b i m v) <= sum I (fun j => Rabs (2 * b i m (unit j)))).
  { eapply Rle_trans; [apply (linear_on_box (fun w => 2 * b i m w) I reach v); try assumption|].
    - intros c t d. rewrite b_move. ring.
    - rewrite <- (Rmult_1_l (sum I _)) at 2. apply Rmult_le_compat_r; [apply bound_parts|lra]. }
  assert (B2 : Rabs (b i v v) <= sum I (fun j => sum I (fun l => Rabs (2 * b i (unit j) (unit l))))).
  { eapply Rle_trans; [apply (linear_on_box (b i v) I reach v (Lin v) once Zv Bv)|]. rewrite <- sum_scal.
    apply sum_le. intros j Hj. rewrite b_sym.
    pose proof (linear_on_box (b i (unit j)) I reach v (Lin _) once Zv Bv) as H.
    assert (P : 0 <= sum I (fun l => Rabs (b i (unit j) (unit l)))) by (apply sum_nonneg; intros; apply Rabs_pos).
    apply Rle_trans with (sum I (fun l => Rabs (b i (unit j) (unit l)))).
    - pose proof (Rabs_pos (b i (unit j) v)). nra.
    - apply sum_le. intros l _. rewrite Rabs_mult, (Rabs_right 2) by lra.
      pose proof (Rabs_pos (b i (unit j) (unit l))). lra. }
  assert (B3 : sum I (fun j => sum I (fun l => Rabs (2 * b i (unit j) (unit l)))) <= sum I (fun j => sum I (fun l =>
    Rabs (2 * a i (unit j) (unit l)) + Rabs (2 * b i (unit j) (unit l))))).
  { apply sum_le. intros j _. apply sum_le. intros l _. pose proof (Rabs_pos (2 * a i (unit j) (unit l))). lra. }
  pose proof (bound_size i Hi). unfold bound in *.
  pose proof (Rabs_triang (b i m m + 2 * b i m v) (b i v v)). pose proof (Rabs_triang (b i m m) (2 * b i m v)). lra.
Qed.

Definition zero_at (s : R) (x : vec) : Prop := in_box I m reach x /\ forall i, In i I -> q s i x x = k i.

(** Two zeros are no farther apart than their parameters, up to a factor; for one parameter they are equal. *)
Lemma zeros_near s s' x y : Rabs s <= width -> zero_at s x -> zero_at s' y ->
  forall i, In i I -> Rabs (x i - y i) <= 2 * size * Rabs (s - s').
Proof.
  intros Hs (Bx & Zx) (By & Zy) i Hi. destruct sizes as (Pr & _ & _ & Pw & _).
  destruct (arg_max I (fun j => Rabs (x j - y j))) as (j & Hj & Max); [now intros ->|].
  apply Rle_trans with (1 := Max i Hi).
  assert (C : Rabs (next I (q s) k Y x j - next I (q s) k Y y j) <= slope_of s * Rabs (x j - y j)).
  { apply (next_contracts I (q s) k once (form_sym s) (form_move s) m reach Y (Rabs s * size) size); try assumption.
    - lra.
    - intros l Hl. now apply inv_bound.
    - intros l Hl. apply sec_bound; [lra|assumption]. }
  assert (Nx : next I (q s) k Y x j = x j).
  { unfold next. destruct in_dec; [|contradiction]. rewrite residual_form by assumption. rewrite Zx by assumption.
    ring. }
  assert (Ny : next I (q s) k Y y j = y j - (s - s') * b j y y).
  { unfold next. destruct in_dec; [|contradiction]. rewrite residual_form by assumption.
    rewrite <- (Zy j Hj). unfold form. ring. }
  rewrite Nx, Ny in C. pose proof (growth j y Hj By) as G. pose proof (slope_small s Hs) as Sl.
  assert (T : Rabs (x j - y j) <= Rabs (x j - (y j - (s - s') * b j y y)) + Rabs ((s - s') * b j y y)).
  { replace (x j - y j) with ((x j - (y j - (s - s') * b j y y)) + - ((s - s') * b j y y)) at 1 by ring.
    eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp. lra. }
  rewrite Rabs_mult in T. pose proof (Rabs_pos (s - s')). pose proof (Rabs_pos (x j - y j)).
  assert (Rabs (s - s') * Rabs (b j y y) <= Rabs (s - s') * size) by (apply Rmult_le_compat_l; assumption).
  assert (slope_of s * Rabs (x j - y j) <= 1 / 2 * Rabs (x j - y j)) by (apply Rmult_le_compat_r; lra). lra.
Qed.

Lemma test s : Rabs s <= width ->
  (forall i, In i I -> Rabs (residual I (q s) k Y i m) <= Rabs s * size) /\
  (forall i, In i I -> sum I (fun j => Rabs (delta i j - entry I (q s) m Y i j)) <= Rabs s * size) /\
  (forall i, In i I -> sum I (fun j => sum I (fun l => Rabs (second I (q s) Y i j l))) <= size) /\
  Rabs s * size + reach * size < 1 /\ Rabs s * size + (Rabs s * size + reach * size) * reach <= reach.
Proof.
  intros H. pose proof sizes as (Pr & _ & _ & Pw & Rs & Ws). pose proof (slope_small s H) as Sl.
  unfold slope_of in Sl.
  pose proof size_pos. pose proof (Rabs_pos s). repeat split; intros; auto using res_bound, inv_bound.
  - apply sec_bound; [lra|assumption].
  - lra.
  - assert (Rabs s * size <= width * size) by (apply Rmult_le_compat_r; lra).
    assert ((Rabs s * size + reach * size) * reach <= 1 / 2 * reach) by (apply Rmult_le_compat_r; lra). lra.
Qed.

(** The zero for the parameter s. *)
Definition along (s : R) : vec :=
  match Rle_dec (Rabs s) width with
  | left H => fixed I (q s) k once (form_sym s) (form_move s) m reach Y (Rabs s * size) (Rabs s * size) size
      (Rlt_le _ _ (proj1 sizes)) (proj1 (test s H)) (proj1 (proj2 (test s H))) (proj1 (proj2 (proj2 (test s H))))
      (proj1 (proj2 (proj2 (proj2 (test s H))))) (proj2 (proj2 (proj2 (proj2 (test s H)))))
  | right _ => m
  end.

Lemma along_zero s : Rabs s <= width -> zero_at s (along s).
Proof. intros H. unfold along. destruct (Rle_dec (Rabs s) width) as [T|]; [|contradiction]. apply fixed_solves. Qed.

Lemma regular_near s x w : Rabs s <= width -> in_box I m reach x -> zero_off I w ->
  (forall i, In i I -> q s i x w = 0) -> w = zero.
Proof.
  intros H. destruct (test s H) as (E1 & E2 & E3 & E4 & E5).
  apply (krawczyk_nonsingular I (q s) k once (form_sym s) (form_move s) m reach Y (Rabs s * size) (Rabs s * size) size);
    try assumption. apply Rlt_le, sizes.
Qed.
End Square.

(** ** Any number of equations *)

Section Curve.
Context {A : Type}.
Variable E : list A.
Variable I : list nat.
Variables q q' : A -> vec -> vec -> R.
Variable k : A -> R.
Variable m : vec.
Hypothesis once : NoDup I.
Hypothesis q_sym : forall e x y, q e x y = q e y x.
Hypothesis q_move : forall e x y s z, q e x (move y s z) = q e x y + s * q e x z.
Hypothesis q'_sym : forall e x y, q' e x y = q' e y x.
Hypothesis q'_move : forall e x y s z, q' e x (move y s z) = q' e x y + s * q' e x z.
Hypothesis Zero : forall e, In e E -> q e m m = k e.

(** The derivative at the zero [m] for s = 0: one-to-one, and onto all values of the equations. *)
Hypothesis Injective : forall w, zero_off I w -> (forall e, In e E -> q e m w = 0) -> w = zero.
Hypothesis Onto : forall s x, (forall i, ~ In i I -> x i = m i) ->
  exists w, zero_off I w /\ forall e, In e E -> q e m w = q e x x + s * q' e x x - k e.

Definition solution (s : R) (x : vec) : Prop :=
  (forall i, ~ In i I -> x i = m i) /\ forall e, In e E -> q e x x + s * q' e x x = k e.
Definition close (r : R) (x : vec) : Prop := forall i, In i I -> Rabs (x i - m i) <= r.

(** There is exactly one solution near [m] for every small s; it is a Lipschitz function of s, and regular. *)
Theorem curve : exists s1 r C (x : R -> vec), 0 < s1 /\ 0 < r /\ 0 <= C /\ x 0 = m /\
  (forall s, Rabs s <= s1 -> solution s (x s) /\ close r (x s) /\
    (forall y, solution s y -> close r y -> y = x s) /\
    (forall w, zero_off I w -> (forall e, In e E -> q e (x s) w + s * q' e (x s) w = 0) -> w = zero)) /\
  (forall s s', Rabs s <= s1 -> Rabs s' <= s1 -> forall i, Rabs (x s i - x s' i) <= C * Rabs (s - s')).
Proof.
  destruct (left_inverse E I (fun e w => 2 * q e m w) once) as (Z & HZ).
  { intros e a s b. rewrite q_move. ring. }
  { intros w Zw H. apply Injective; [assumption|]. intros e He. specialize (H e He). lra. }
  set (P := fun i (f : A -> R) => sum E (fun e => Z i e * f e)).
  assert (Pext : forall i f g, (forall e, In e E -> f e = g e) -> P i f = P i g).
  { intros i f g H. apply sum_ext. intros e He. now rewrite H. }
  assert (Padd : forall i f s g, P i (fun e => f e + s * g e) = P i f + s * P i g).
  { intros i f s g. unfold P. rewrite <- sum_scal, <- sum_plus. apply sum_ext. intros. ring. }
  set (a := fun i x y => P i (fun e => q e x y)). set (b := fun i x y => P i (fun e => q' e x y)).
  set (k' := fun i => P i k).
  assert (As : forall i x y, a i x y = a i y x) by (intros; apply Pext; auto).
  assert (Bs : forall i x y, b i x y = b i y x) by (intros; apply Pext; auto).
  assert (Am : forall i x y s z, a i x (move y s z) = a i x y + s * a i x z)
    by (intros; unfold a; rewrite <- Padd; apply Pext; auto).
  assert (Bm : forall i x y s z, b i x (move y s z) = b i x y + s * b i x z)
    by (intros; unfold b; rewrite <- Padd; apply Pext; auto).
  assert (Z0 : forall i, In i I -> a i m m = k' i) by (intros; apply Pext; auto).
  assert (Id : forall i w, In i I -> zero_off I w -> 2 * a i m w = w i).
  { intros i w Hi Zw. rewrite <- (HZ i w Hi Zw). unfold a, P. rewrite <- sum_scal. apply sum_ext. intros. ring. }
  assert (Val : forall s i x y, form a b s i x y = P i (fun e => q e x y + s * q' e x y)).
  { intros. unfold form, a, b. now rewrite Padd. }
  (* the equations hold if and only if those of the square system do *)
  assert (Same : forall s x, (forall i, ~ In i I -> x i = m i) ->
    ((forall e, In e E -> q e x x + s * q' e x x = k e) <-> forall i, In i I -> form a b s i x x = k' i)).
  { intros s x Off. split.
    - intros H i _. rewrite Val. now apply Pext.
    - intros H. destruct (Onto s x Off) as (w & Zw & Hw).
      assert (W0 : w = zero).
      { apply functional_extensionality. intros i. destruct (in_dec Nat.eq_dec i I) as [Hi|Hi]; [|now apply Zw].
        rewrite <- (Id i w Hi Zw). unfold a.
        rewrite (Pext i _ (fun e => (q e x x + s * q' e x x) + -1 * k e)) by (intros e He; rewrite (Hw e He); ring).
        rewrite Padd, <- Val, H by assumption. unfold k', zero. ring. }
      intros e He. specialize (Hw e He). rewrite W0 in Hw.
      rewrite (linear_zero (q e m)) in Hw by (intros c t d; apply q_move). lra. }
  pose proof (sizes I a b m) as (Pr & Pr1 & Pw & _). pose proof (size_pos I a b m) as Ps.
  set (x := along I a b k' m once As Am Bs Bm Z0 Id).
  assert (Zx : forall s, Rabs s <= width I a b m -> zero_at I a b k' m s (x s)) by (intros; now apply along_zero).
  assert (Near : forall s s' y z, Rabs s <= width I a b m -> zero_at I a b k' m s y -> zero_at I a b k' m s' z ->
    forall i, Rabs (y i - z i) <= 2 * size I a b m * Rabs (s - s')).
  { intros s s' y z Hs Hy Hz i. destruct (in_dec Nat.eq_dec i I) as [Hi|Hi].
    - now apply (zeros_near I a b k' m once As Am Bs Bm Z0 Id s s' y z).
    - rewrite (proj1 (proj1 Hy) i Hi), (proj1 (proj1 Hz) i Hi). unfold Rminus. rewrite Rplus_opp_r, Rabs_R0.
      pose proof (Rabs_pos (s - s')). unfold Rminus in *. nra. }
  assert (Only : forall s y z, Rabs s <= width I a b m -> zero_at I a b k' m s y -> zero_at I a b k' m s z -> y = z).
  { intros s y z Hs Hy Hz. apply functional_extensionality. intros i. pose proof (Near s s y z Hs Hy Hz i) as H.
    unfold Rminus in H at 2. rewrite Rplus_opp_r, Rabs_R0, Rmult_0_r in H.
    destruct (Req_dec (y i - z i) 0) as [|Ne]; [lra|]. pose proof (Rabs_pos_lt _ Ne). lra. }
  exists (width I a b m), (reach I a b m), (2 * size I a b m), x. split; [assumption|]. split; [assumption|].
  split; [lra|]. split; [|split].
  - assert (H0 : Rabs 0 <= width I a b m) by (rewrite Rabs_R0; lra). apply (Only 0); auto. split.
    + split; [easy|]. intros i _. unfold Rminus. rewrite Rplus_opp_r, Rabs_R0. lra.
    + apply Same; [easy|]. intros e He. rewrite Zero by assumption. ring.
  - intros s Hs. destruct (Zx s Hs) as ((Off & Box) & Sol). split; [|split; [exact Box|split]].
    + split; [exact Off|]. now apply Same.
    + intros y (Oy & Sy) By. apply (Only s); auto. split; [now split|]. now apply Same.
    + intros w Zw H. apply (regular_near I a b k' m once As Am Bs Bm Z0 Id s (x s)); auto; [now split|].
      intros i _. rewrite Val. rewrite (Pext i _ (fun _ => 0)) by auto. apply sum_zero. intros. ring.
  - intros s s' Hs Hs' i. apply Near; auto.
Qed.
End Curve.
