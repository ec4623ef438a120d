(** Heights in a box on which all curvatures are almost 0 are near a solution of K_v = 0. *)
From Coq Require Import Reals List Lra Lia Arith FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Box Nappes Sheet Identities Star KeyLemma Flat Theorems Curve Displacements.
Import ListNotations.
Open Scope R_scope.

Lemma lipschitz_sum {A} (l : list A) vs (f : A -> vec -> R) : (forall a, In a l -> exists L, lipschitz L vs (f a)) ->
  exists L, lipschitz L vs (fun x => sum l (fun a => f a x)).
Proof.
  induction l as [|a l IH]; intros H.
  - exists 0. intros x y _. cbn [sum]. rewrite Rminus_0_r, Rabs_R0. lra.
  - destruct (H a (or_introl eq_refl)) as (L & HL). destruct IH as (L' & HL'); [intros; apply H; now right|].
    exists (L + L'). intros x y E. cbn [sum]. specialize (HL x y E). specialize (HL' x y E).
    replace (f a x + sum l (fun a => f a x) - (f a y + sum l (fun a => f a y))) with
      ((f a x - f a y) + (sum l (fun a => f a x) - sum l (fun a => f a y))) by ring.
    rewrite Rmult_plus_distr_r. now apply sum_bound.
Qed.

Lemma clip_close B x y : Rabs (Rmax (- B) (Rmin B x) - Rmax (- B) (Rmin B y)) <= Rabs (x - y).
Proof.
  unfold Rmax, Rmin. repeat destruct Rle_dec; unfold Rabs; repeat destruct Rcase_abs; lra.
Qed.

Lemma abs_le x r : Rabs x <= r -> - r <= x <= r.
Proof. unfold Rabs. destruct Rcase_abs; lra. Qed.

Lemma clip_inside B x : Rabs x <= B -> Rmax (- B) (Rmin B x) = x.
Proof. intros H. apply abs_le in H. rewrite Rmin_right, Rmax_right; lra. Qed.

Lemma clip_bound B x : 0 <= B -> Rabs (Rmax (- B) (Rmin B x)) <= B.
Proof. intros P. apply Rabs_le. unfold Rmax, Rmin. repeat destruct Rle_dec; lra. Qed.

Lemma norm_difference I a b : Rabs (norm I a - norm I b) <= norm I (minus a b).
Proof.
  unfold norm. replace (sum I (fun i => Rabs (a i)) - sum I (fun i => Rabs (b i))) with
    (sum I (fun i => Rabs (a i) + -1 * Rabs (b i))) by (rewrite sum_plus, sum_scal; ring).
  eapply Rle_trans; [apply sum_abs|]. apply sum_le. intros i _. unfold minus.
  replace (Rabs (a i) + -1 * Rabs (b i)) with (Rabs (a i) - Rabs (b i)) by ring. apply Rabs_triang_inv2.
Qed.

Section Gap.
Variable S : sheet.
Notation I := (inner S).
Variable r : vec.
Variable B : R.
Hypothesis PB : 0 <= B.

(** The nearest heights in the box that have the rim [r]. *)
Definition clip (x : vec) : vec := fun i => if in_dec Nat.eq_dec i I then Rmax (- B) (Rmin B (x i)) else r i.
Definition rim_part : vec := fun i => if in_dec Nat.eq_dec i I then 0 else r i.

Lemma clip_rim x : has_rim S r (clip x).
Proof. intros i Hi. unfold clip. now destruct in_dec. Qed.

Lemma clip_norm x y : norm I (minus (clip x) (clip y)) <= norm I (minus x y).
Proof.
  apply sum_le. intros i Hi. unfold minus, clip. destruct in_dec; [|contradiction]. apply clip_close.
Qed.

Lemma clip_id x : has_rim S r x -> (forall i, In i I -> Rabs (x i) <= B) -> clip x = x.
Proof.
  intros Rx Bx. apply functional_extensionality. intros i. unfold clip. destruct in_dec as [Hi|Hi].
  - now apply clip_inside, Bx.
  - symmetry. now apply Rx.
Qed.

(** Curvatures are Lipschitz functions on the box. *)
Lemma curvature_lipschitz v : In v I -> exists L, lipschitz L I (fun x => Rabs (K S v (clip x))).
Proof.
  intros Hv. pose proof (inner_vertex S v Hv) as V.
  assert (Lin : forall g, linear (K2 S v g)) by (intros g a s b; apply K2_move).
  set (c := fun i => Rabs (K2 S v (unit i) rim_part) + B * sum I (fun j => Rabs (K2 S v (unit i) (unit j)))).
  assert (Small : forall i x, Rabs (K2 S v (unit i) (clip x)) <= c i).
  { intros i x. set (w := minus (clip x) rim_part).
    replace (clip x) with (move rim_part 1 w) by (unfold w; vec). rewrite Lin, Rmult_1_l.
    apply sum_bound; [lra|]. apply linear_on_box; [apply Lin|apply inner_once| |].
    - intros j Hj. unfold w, minus, clip, rim_part. destruct in_dec; [contradiction|ring].
    - intros j Hj. unfold w, minus, clip, rim_part. destruct in_dec; [|contradiction].
      rewrite Rminus_0_r. now apply clip_bound. }
  assert (Pc : forall i, 0 <= c i).
  { intros i. eapply Rle_trans; [apply Rabs_pos|apply (Small i zero)]. }
  set (M := 2 * sum I c). exists M. intros x y _.
  eapply Rle_trans; [apply Rabs_triang_inv2|]. set (a := clip x). set (b := clip y). set (w := minus a b).
  assert (E : K S v a - K S v b = sum I (fun i => (K2 S v (unit i) a + K2 S v (unit i) b) * w i)).
  { replace a with (move b 1 w) at 1 by (unfold w; vec). rewrite K_move by assumption.
    assert (Zw : zero_off I w).
    { intros i Hi. unfold w, minus, a, b. rewrite (clip_rim x i Hi), (clip_rim y i Hi). ring. }
    replace (K S v b + 2 * 1 * K2 S v b w + 1 * 1 * K S v w - K S v b) with (K2 S v a w + K2 S v b w).
    - rewrite (linear_coordinates (K2 S v a) I w (Lin a) (inner_once S) Zw),
        (linear_coordinates (K2 S v b) I w (Lin b) (inner_once S) Zw), <- sum_plus.
      apply sum_ext. intros i _. rewrite (K2_sym S v a), (K2_sym S v b). ring.
    - replace a with (move b 1 w) by (unfold w; vec). rewrite (K2_sym S v (move b 1 w)), Lin.
      rewrite K_polar_sheet, (K2_sym S v w b) by assumption. ring. }
  rewrite E. eapply Rle_trans; [apply sum_abs|].
  apply Rle_trans with (M * norm I w); [|apply Rmult_le_compat_l; [|apply clip_norm]].
  - unfold norm. rewrite <- sum_scal. apply sum_le. intros i Hi. rewrite Rabs_mult.
    apply Rmult_le_compat_r; [apply Rabs_pos|]. unfold M.
    pose proof (sum_ge_term I c i (fun j _ => Pc j) Hi). pose proof (sum_bound _ _ _ _ (Small i x) (Small i y)).
    unfold a, b. lra.
  - unfold M. assert (0 <= sum I c) by (apply sum_nonneg; auto). lra.
Qed.

(** Let [hs] hold all solutions with the rim [r]. *)
Theorem gap hs rho : 0 < rho ->
  (forall g, has_rim S r g -> solves S (fun _ => 0) g -> In g hs) ->
  exists eps, 0 < eps /\ forall g, has_rim S r g -> (forall i, In i I -> Rabs (g i) <= B) ->
    sum I (fun v => Rabs (K S v g)) < eps -> exists h, In h hs /\ norm I (minus g h) < rho.
Proof.
  intros Pr All.
  set (far := fun h x => Rmax 0 (rho - norm I (minus (clip x) h))).
  set (f := fun x => sum I (fun v => Rabs (K S v (clip x))) + sum hs (fun h => far h x)).
  assert (Lf : exists L, lipschitz L I f).
  { destruct (lipschitz_sum I I (fun v x => Rabs (K S v (clip x)))) as (L & HL); [exact curvature_lipschitz|].
    destruct (lipschitz_sum hs I far) as (L' & HL').
    { intros h _. exists 1. intros x y _. rewrite Rmult_1_l. eapply Rle_trans; [|apply clip_norm].
      replace (minus (clip x) (clip y)) with (minus (minus (clip x) h) (minus (clip y) h)) by vec.
      eapply Rle_trans; [|apply norm_difference]. unfold far.
      unfold Rmax. repeat destruct Rle_dec; unfold Rabs; repeat destruct Rcase_abs; lra. }
    exists (L + L'). intros x y E. specialize (HL x y E). specialize (HL' x y E). unfold f.
    rewrite Rmult_plus_distr_r. pose proof (sum_bound _ _ _ _ HL HL') as Q. eapply Rle_trans; [|exact Q]. right.
    f_equal. ring. }
  destruct Lf as (L & HL).
  destruct (least_on_box L B PB I (inner_once S) f HL r) as (x & Xr & Xb & Least).
  assert (PK : forall y, 0 <= sum I (fun v => Rabs (K S v y))) by (intros; apply sum_nonneg; intros; apply Rabs_pos).
  assert (PF : forall h y, 0 <= far h y) by (intros; apply Rmax_l).
  exists (f x). split.
  - destruct (Rle_lt_dec (f x) 0) as [Le|]; [exfalso|assumption]. unfold f in Le.
    assert (Ps : 0 <= sum hs (fun h => far h x)) by (apply sum_nonneg; intros; apply PF).
    pose proof (PK (clip x)) as P.
    assert (Z : solves S (fun _ => 0) (clip x)).
    { intros v Hv. pose proof (sum_nonneg_null I (fun v => Rabs (K S v (clip x))) (fun v _ => Rabs_pos _)
        ltac:(lra) v Hv) as E. cbn beta in E. destruct (Req_dec (K S v (clip x)) 0) as [|N]; [assumption|].
      now apply Rabs_no_R0 in N. }
    pose proof (All _ (clip_rim x) Z) as Hin.
    pose proof (sum_nonneg_null hs (fun h => far h x) (fun h _ => PF h x) ltac:(lra) _ Hin) as E. cbn beta in E.
    unfold far in E. replace (minus (clip x) (clip x)) with zero in E by vec.
    replace (norm I zero) with 0 in E by (symmetry; apply sum_zero; intros; apply Rabs_R0).
    rewrite Rmax_right in E; lra.
  - intros g Rg Bg Kg. assert (Fg : f x <= f g).
    { apply Least; [exact Rg|]. intros i Hi. now apply abs_le, Bg. }
    unfold f at 2 in Fg. rewrite (clip_id g Rg Bg) in Fg.
    assert (Ps : 0 < sum hs (fun h => far h g)) by lra. clear - Ps PF Bg Rg.
    induction hs as [|h hs IH]; cbn [sum] in Ps; [lra|]. destruct (Rle_lt_dec (far h g) 0) as [Le|Lt].
    + destruct IH as (h' & H' & N'); [lra|]. exists h'. split; [now right|exact N'].
    + exists h. split; [now left|]. unfold far in Lt. rewrite (clip_id g Rg Bg) in Lt.
      unfold Rmax in Lt. destruct Rle_dec; lra.
Qed.
End Gap.

Section Grows.
Variable S : sheet.
Notation I := (inner S).

(** Heights that are 0 on the boundary have a curvature. *)
Lemma grows : exists eps, 0 < eps /\ forall w, zero_off I w ->
  eps * (norm I w * norm I w) <= sum I (fun v => Rabs (K S v w)).
Proof.
  destruct (gap S zero 1 ltac:(lra) [zero] 1 ltac:(lra)) as (eps & Pe & Gap).
  { intros g Rg Sg. left. symmetry. apply (key_lemma S); [exact Rg|]. intros v Hv. rewrite (Sg v Hv). lra. }
  exists eps. split; [exact Pe|]. intros w Zw. set (N := norm I w). pose proof (norm_nonneg I w) as PN. fold N in PN.
  destruct (Rle_lt_dec N 0) as [Le|Lt].
  { replace N with 0 by lra. rewrite Rmult_0_l, Rmult_0_r. apply sum_nonneg. intros. apply Rabs_pos. }
  set (g := move zero (/ N) w).
  assert (G1 : norm I g = 1).
  { unfold norm, g. rewrite (sum_ext I _ (fun i => / N * Rabs (w i))).
    - rewrite sum_scal. fold (norm I w). fold N. field. lra.
    - intros i _. unfold move, zero. rewrite Rplus_0_l, Rabs_mult, (Rabs_right (/ N)); [reflexivity|].
      apply Rle_ge, Rlt_le, Rinv_0_lt_compat, Lt. }
  assert (Rg : has_rim S zero g) by (intros i Hi; unfold g, move, zero; rewrite (Zw i Hi); ring).
  assert (Kg : forall v, In v I -> K S v w = N * N * K S v g).
  { intros v Hv. pose proof (inner_vertex S v Hv) as V. unfold g. rewrite K_move by assumption.
    rewrite (K2_sym S v zero), <- (K_polar_sheet S v zero V).
    rewrite (linear_zero (K2 S v w)), (linear_zero (K2 S v zero)) by (intros a s b; apply K2_move). field. lra. }
  rewrite (sum_ext I _ (fun v => N * N * Rabs (K S v g))).
  2:{ intros v Hv. rewrite (Kg v Hv), Rabs_mult, (Rabs_right (N * N)); [reflexivity|]. nra. }
  rewrite sum_scal, Rmult_comm. apply Rmult_le_compat_l; [nra|].
  destruct (Rle_lt_dec eps (sum I (fun v => Rabs (K S v g)))) as [|Less]; [assumption|exfalso].
  destruct (Gap g Rg) as (h & [<-|[]] & Nh); [|exact Less|].
  - intros i Hi. rewrite <- G1. apply at_norm. exact Rg.
  - replace (minus g zero) with g in Nh by vec. lra.
Qed.
End Grows.
