(** A Lipschitz function takes its least value on a box, by induction on the number of coordinates. *)
From Coq Require Import Reals List Permutation Lra Lia Arith FunctionalExtensionality.
From Exactfold Require Import Sums Vectors.
Import ListNotations.
Open Scope R_scope.

Definition lipschitz (L : R) (vs : list nat) (f : vec -> R) :=
  forall x y, (forall i, ~ In i vs -> x i = y i) -> Rabs (f x - f y) <= L * norm vs (minus x y).

Lemma least_value (f : R -> R) (L B : R) : 0 <= B ->
  (forall s t, Rabs (f s - f t) <= L * Rabs (s - t)) ->
  { m : R | (exists t, - B <= t <= B /\ f t = m) /\ forall t, - B <= t <= B -> m <= f t }.
Proof.
  intros PB Lip.
  assert (C : forall c, - B <= c <= B -> continuity_pt f c).
  { intros c _ eps Pe. assert (0 <= Rabs L) by apply Rabs_pos.
    exists (eps / (Rabs L + 1)). split; [apply Rdiv_lt_0_compat; lra|].
    intros x [_ Hx]. simpl in *. unfold R_dist in *.
    eapply Rle_lt_trans; [apply Lip|].
    apply Rle_lt_trans with ((Rabs L + 1) * Rabs (x - c)).
    - apply Rmult_le_compat_r; [apply Rabs_pos|]. pose proof (Rle_abs L). lra.
    - replace eps with ((Rabs L + 1) * (eps / (Rabs L + 1))) by (field; lra).
      apply Rmult_lt_compat_l; lra. }
  destruct (completeness (fun y => exists t, - B <= t <= B /\ y = - f t)) as (M & Up & Least).
  - destruct (continuity_ab_min f (- B) B) as (t & T & Ht); [lra|assumption|].
    exists (- f t). intros y (s & Hs & ->). specialize (T s Hs). lra.
  - exists (- f 0), 0. split; [lra|reflexivity].
  - exists (- M). split.
    + destruct (continuity_ab_min f (- B) B) as (t & T & Ht); [lra|assumption|].
      exists t. split; [assumption|].
      assert (M <= - f t). { apply Least. intros y (s & Hs & ->). specialize (T s Hs). lra. }
      assert (- f t <= M) by (apply Up; eauto). lra.
    + intros t Ht. assert (- f t <= M) by (apply Up; eauto). lra.
Qed.

Lemma norm_upd vs x y v t : ~ In v vs -> norm (v :: vs) (minus (upd x v t) (upd y v t)) = norm vs (minus x y).
Proof.
  intros H. unfold norm. simpl. unfold minus at 1. rewrite !upd_same.
  replace (t - t) with 0 by ring. rewrite Rabs_R0, Rplus_0_l.
  apply sum_ext. intros u Hu. unfold minus. rewrite !upd_other; [reflexivity| |]; intros ->; contradiction.
Qed.

Lemma norm_upd_both vs x v s t : ~ In v vs -> norm (v :: vs) (minus (upd x v s) (upd x v t)) = Rabs (s - t).
Proof.
  intros H. unfold norm. simpl. unfold minus at 1. rewrite !upd_same.
  rewrite sum_zero; [ring|]. intros u Hu. unfold minus.
  rewrite !upd_other; [|intros ->; contradiction|intros ->; contradiction].
  replace (x u - x u) with 0 by ring. apply Rabs_R0.
Qed.

Lemma least_on_box (L B : R) : 0 <= B -> forall vs, NoDup vs -> forall f, lipschitz L vs f ->
  forall x0 : vec, exists x, (forall i, ~ In i vs -> x i = x0 i) /\ (forall i, In i vs -> - B <= x i <= B) /\
    forall y, (forall i, ~ In i vs -> y i = x0 i) -> (forall i, In i vs -> - B <= y i <= B) -> f x <= f y.
Proof.
  intros PB. induction vs as [|v vs IH]; intros D f Lip x0.
  { exists x0. repeat split; try easy. intros y Hy _.
    replace y with x0; [lra|]. apply functional_extensionality; intro. symmetry. auto. }
  inversion D as [|? ? Nv Dvs]; subst.
  assert (L1 : forall x s t, Rabs (f (upd x v s) - f (upd x v t)) <= L * Rabs (s - t)).
  { intros x s t. rewrite <- (norm_upd_both vs x v s t Nv). apply Lip.
    intros i Hi. rewrite !upd_other; [reflexivity| |]; intros ->; apply Hi; now left. }
  set (g := fun x => proj1_sig (least_value (fun t => f (upd x v t)) L B PB (L1 x))).
  assert (G1 : forall x, exists t, - B <= t <= B /\ f (upd x v t) = g x)
    by (intros x; exact (proj1 (proj2_sig (least_value _ L B PB (L1 x))))).
  assert (G2 : forall x t, - B <= t <= B -> g x <= f (upd x v t))
    by (intros x; exact (proj2 (proj2_sig (least_value _ L B PB (L1 x))))).
  assert (G3 : forall x y, (forall i, ~ In i vs -> x i = y i) -> g x <= g y + L * norm vs (minus x y)).
  { intros x y E. destruct (G1 y) as (t & Ht & <-). specialize (G2 x t Ht).
    assert (E' : forall i, ~ In i (v :: vs) -> upd x v t i = upd y v t i).
    { intros i Hi. simpl in Hi. rewrite !upd_other; auto. }
    pose proof (Lip _ _ E') as H. rewrite (norm_upd vs x y v t Nv) in H.
    pose proof (Rle_abs (f (upd x v t) - f (upd y v t))). lra. }
  destruct (IH Dvs g) with (x0 := x0) as (x & X0 & XB & Least).
  { intros x y E. assert (norm vs (minus y x) = norm vs (minus x y)) as N.
    { apply sum_ext. intros. unfold minus. apply Rabs_minus_sym. }
    pose proof (G3 x y E). pose proof (G3 y x (fun i Hi => eq_sym (E i Hi))). rewrite N in *.
    apply Rabs_le. lra. }
  destruct (G1 x) as (t & Ht & Et). exists (upd x v t). split; [|split].
  - intros i Hi. simpl in Hi. rewrite upd_other; auto.
  - intros i [<-|Hi]; [now rewrite upd_same|]. rewrite upd_other; auto. intros ->. contradiction.
  - intros y Y0 YB. rewrite Et.
    set (y' := upd y v (x0 v)).
    assert (g x <= g y').
    { apply Least; unfold y'; intros i Hi.
      - destruct (Nat.eq_dec i v) as [->|Ne]; [now rewrite upd_same|].
        rewrite upd_other by assumption. apply Y0. simpl. intuition.
      - rewrite upd_other; [apply YB; now right|]. intros ->. contradiction. }
    assert (g y' <= f (upd y' v (y v))) by (apply G2, YB; now left).
    unfold y' in *. rewrite upd_upd, upd_id in *. lra.
Qed.
