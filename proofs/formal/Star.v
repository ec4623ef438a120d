(** One star: Picone's identity, Wirtinger's inequality, one positive direction.

    No integrals, no angles, no Fourier series: for a direction [d0] let P(d) be half of
    rho^2 cot theta, where theta is the angle from [d0] to [d] and rho the slope along [d].  Then
    the contribution of a face is the difference of P at its two spokes minus a square. *)
From Coq Require Import Reals List Permutation Lra Lia Arith.
From Exactfold Require Import Sums Vectors Nappes Sheet Identities.
Import ListNotations.
Open Scope R_scope.

(** ** Lists *)

Lemma steps_split l a l' : steps (l ++ a :: l') = steps (l ++ [a]) ++ steps (a :: l').
Proof.
  induction l as [|b l IH]; [reflexivity|].
  destruct l as [|b' l]; [reflexivity|].
  cbn [app] in *. change (steps (b :: b' :: l ++ a :: l')) with ((b, b') :: steps (b' :: l ++ a :: l')).
  rewrite IH. reflexivity.
Qed.

Lemma steps_in a l x y : In (x, y) (steps (a :: l)) -> In x (a :: l) /\ In y l.
Proof.
  revert a. induction l as [|b l IH]; intros a H; [easy|].
  destruct H as [E|H].
  - injection E as <- <-. simpl. auto.
  - destruct (IH b H). simpl in *. tauto.
Qed.

(** Differences along a list add up. *)
Lemma telescope (P : nat -> R) l : forall a z,
  sum (steps (a :: l ++ [z])) (fun s => let '(x, y) := s in P x - P y) = P a - P z.
Proof.
  induction l as [|b l IH]; intros a z; [simpl; lra|].
  change (steps (a :: (b :: l) ++ [z])) with ((a, b) :: steps (b :: l ++ [z])).
  cbn [sum]. rewrite IH. ring.
Qed.

(** ** Picone's identity *)

Definition picone (d0 d : point) (x : R) : R := dot d0 d / (2 * cross d0 d) * (x * x / dot d d).

Lemma turn_left d0 d d' : cross d0 d' * dot d d = dot d0 d * cross d d' + cross d0 d * dot d d'.
Proof. coordinates. ring. Qed.
Lemma turn_right d0 d d' : cross d0 d * dot d' d' = dot d d' * cross d0 d' - dot d0 d' * cross d d'.
Proof. coordinates. ring. Qed.
Lemma turn_base d0 d d' : cross d d' * dot d0 d0 = dot d0 d * cross d0 d' - cross d0 d * dot d0 d'.
Proof. coordinates. ring. Qed.

Lemma wedge_picone d0 d d' x x' : cross d d' <> 0 -> cross d0 d <> 0 -> cross d0 d' <> 0 ->
  wedge d d' x x' = picone d0 d x - picone d0 d' x' -
    (x * cross d0 d' - x' * cross d0 d) * (x * cross d0 d' - x' * cross d0 d) /
    (2 * cross d d' * (cross d0 d * cross d0 d')).
Proof.
  intros C B B'. pose proof (cross_left _ _ C) as M. pose proof (cross_right _ _ C) as M'.
  pose proof (turn_left d0 d d') as TL. pose proof (turn_right d0 d d') as TR.
  unfold wedge, picone.
  set (c := cross d d') in *. set (b := cross d0 d) in *. set (b' := cross d0 d') in *.
  set (m := dot d d) in *. set (m' := dot d' d') in *. set (s := dot d d') in *.
  assert (EA : dot d0 d = (b' * m - b * s) / c) by (rewrite TL; field; assumption).
  assert (EA' : dot d0 d' = (s * b' - b * m') / c) by (rewrite TR; field; assumption).
  rewrite EA, EA'. field. auto.
Qed.

(** A step along which the slopes allow no gain: both spokes on one side of [d0], or the slopes are
    those of a function that is constant along [d0]. *)
Definition good (d0 d d' : point) (x x' : R) : Prop :=
  0 < cross d0 d * cross d0 d' \/
  (x * cross d0 d' = x' * cross d0 d /\ (cross d0 d = 0 -> x = 0) /\ (cross d0 d' = 0 -> x' = 0)).

Lemma wedge_good d0 d d' x x' : 0 < cross d d' -> dot d0 d0 <> 0 -> good d0 d d' x x' ->
  wedge d d' x x' <= picone d0 d x - picone d0 d' x'.
Proof.
  intros C N0 G. assert (C' : cross d d' <> 0) by lra.
  pose proof (cross_left _ _ C') as M. pose proof (cross_right _ _ C') as M'.
  pose proof (turn_left d0 d d') as TL. pose proof (turn_right d0 d d') as TR. pose proof (turn_base d0 d d') as TB.
  destruct (Req_dec (cross d0 d) 0) as [B|B], (Req_dec (cross d0 d') 0) as [B'|B'].
  - exfalso. rewrite B, B' in TB. apply (Rmult_integral_contrapositive_currified _ _ C' N0). lra.
  - destruct G as [G|(_ & X & _)]; [rewrite B in G; lra|]. rewrite (X B). right.
    unfold wedge, picone. rewrite B in TR.
    assert (E : dot d d' = dot d0 d' * cross d d' / cross d0 d').
    { apply (Rmult_eq_reg_r (cross d0 d')); [|assumption].
      unfold Rdiv. rewrite Rmult_assoc, Rinv_l by assumption. lra. }
    rewrite E, B.
    replace (dot d0 d / (2 * 0) * (0 * 0 / dot d d)) with 0 by (unfold Rdiv; ring).
    field. auto.
  - destruct G as [G|(_ & _ & X)]; [rewrite B' in G; lra|]. rewrite (X B'). right.
    unfold wedge, picone. rewrite B' in TL.
    assert (E : dot d d' = - (dot d0 d * cross d d') / cross d0 d).
    { apply (Rmult_eq_reg_r (cross d0 d)); [|assumption].
      unfold Rdiv. rewrite Rmult_assoc, Rinv_l by assumption. lra. }
    rewrite E, B'.
    replace (dot d0 d' / (2 * 0) * (0 * 0 / dot d' d')) with 0 by (unfold Rdiv; ring).
    field. auto.
  - rewrite (wedge_picone d0) by assumption.
    set (u := x * cross d0 d' - x' * cross d0 d).
    assert (0 <= u * u / (2 * cross d d' * (cross d0 d * cross d0 d'))); [|lra].
    destruct G as [G|(E & _)].
    + apply Rmult_le_pos; [apply Rle_0_sqr|]. apply Rlt_le, Rinv_0_lt_compat.
      apply Rmult_lt_0_compat; lra.
    + replace u with 0 by (unfold u; lra). unfold Rdiv. rewrite !Rmult_0_l. lra.
Qed.

Lemma good_one_side d0 d d' x x' :
  0 <= cross d0 d * cross d0 d' -> (cross d0 d = 0 -> x = 0) -> (cross d0 d' = 0 -> x' = 0) ->
  good d0 d d' x x'.
Proof.
  intros B X X'. unfold good.
  destruct (Req_dec (cross d0 d) 0) as [Z|Z]; [right|].
  { rewrite (X Z), Z. repeat split; auto. ring. }
  destruct (Req_dec (cross d0 d') 0) as [Z'|Z']; [right|left].
  { rewrite (X' Z'), Z'. repeat split; auto. ring. }
  destruct B as [B|B]; [assumption|]. symmetry in B. apply Rmult_integral in B. tauto.
Qed.

Section Star.
Variable S : sheet.
Notation at_ := (at_ S).
Notation spoke := (spoke at_).
Notation vertices := (inner S ++ rim S).

(** The form depends only on the heights above [v]. *)
Lemma K_ext v g h : (forall u, g u - g v = h u - h v) -> K S v g = K S v h.
Proof. intros E. apply sum_ext. intros [a b] _. now rewrite !E. Qed.

Lemma K_good v h u l z : In v vertices -> fan S v = u :: l ++ [z] -> h u = h v -> h z = h v ->
  (forall x y, In (x, y) (steps (fan S v)) ->
    good (spoke v u) (spoke v x) (spoke v y) (h x - h v) (h y - h v)) ->
  K S v h <= 0.
Proof.
  intros Hv F Hu Hz Good.
  assert (N0 : dot (spoke v u) (spoke v u) <> 0).
  { assert (St : exists y, In (u, y) (steps (fan S v))).
    { rewrite F. destruct l as [|y l]; [exists z|exists y]; now left. }
    destruct St as (y & St). apply (cross_left _ (spoke v y)).
    pose proof (step_left S v u y Hv St). lra. }
  apply Rle_trans with (sum (steps (fan S v)) (fun s => let '(x, y) := s in
    picone (spoke v u) (spoke v x) (h x - h v) - picone (spoke v u) (spoke v y) (h y - h v))).
  - apply sum_le. intros [x y] Hs. apply wedge_good; auto. now apply step_left.
  - rewrite F, (telescope (fun x => picone (spoke v u) (spoke v x) (h x - h v))).
    unfold picone. rewrite Hu, Hz. replace (h v - h v) with 0 by ring. unfold Rdiv. lra.
Qed.

(** Wirtinger. *)
Theorem wirtinger b w : In b (rim S) -> (forall c, In c (rim S) -> w c = 0) -> K S b w <= 0.
Proof.
  intros Hb Z. assert (Hv : In b vertices) by (apply in_or_app; now right).
  destruct (rim_convex S b Hb) as (u & mid & q & F & Hu & Hq & Pos & Posq).
  apply (K_good b w u mid q Hv F); [now rewrite !Z|now rewrite !Z|].
  intros x y Hs. rewrite F in Hs. apply steps_in in Hs. destruct Hs as (Hx & Hy).
  assert (M : forall x, In x (u :: mid ++ [q]) ->
    0 <= cross (spoke b u) (spoke b x) /\ (cross (spoke b u) (spoke b x) = 0 -> w x - w b = 0)).
  { intros a [<-|Ha]; [|apply in_app_or in Ha; destruct Ha as [Ha|[<-|[]]]].
    - split; [coordinates; lra|]. intros _. rewrite !Z by assumption. ring.
    - specialize (Pos a Ha). split; lra.
    - split; [assumption|]. intros _. rewrite !Z by assumption. ring. }
  destruct (M x Hx). destruct (M y (or_intror Hy)).
  apply good_one_side; auto. now apply Rmult_le_pos.
Qed.

(** ** Bilinear *)

Lemma K2_sym v g h : K2 S v g h = K2 S v h g.
Proof. apply sum_ext. intros [a b] _. unfold wedge2, Rdiv. ring. Qed.

Lemma K2_move v g a s b : K2 S v g (move a s b) = K2 S v g a + s * K2 S v g b.
Proof.
  unfold K2. rewrite <- sum_scal, <- sum_plus. apply sum_ext. intros [x y] _.
  unfold wedge2, move, Rdiv. ring.
Qed.

Lemma K_polar v h : (forall a b, In (a, b) (steps (fan S v)) -> 0 < cross (spoke v a) (spoke v b)) ->
  K2 S v h h = K S v h.
Proof.
  intros P. apply sum_ext. intros [a b] Hs. specialize (P a b Hs).
  pose proof (cross_left (spoke v a) (spoke v b) ltac:(lra)).
  pose proof (cross_right (spoke v a) (spoke v b) ltac:(lra)).
  unfold wedge, wedge2. field. repeat split; lra.
Qed.

Lemma K_polar_sheet v h : In v vertices -> K2 S v h h = K S v h.
Proof. intros Hv. apply K_polar. intros. now apply step_left. Qed.

Lemma K_move v a s b : In v vertices ->
  K S v (move a s b) = K S v a + 2 * s * K2 S v a b + s * s * K S v b.
Proof.
  intros Hv. rewrite <- !K_polar_sheet by assumption.
  rewrite K2_move, (K2_sym v (move a s b) a), (K2_sym v (move a s b) b), !K2_move, (K2_sym v b a). ring.
Qed.

(** ** A full star *)

(** Planes do not change the curvature. *)
Definition plane (g : point) : vec := fun u => dot g (at_ u).

Lemma wedge_plane g d d' x x' : cross d d' <> 0 ->
  wedge d d' (x - dot g d) (x' - dot g d') = wedge d d' x x' +
    ((dot g d / 2 - x) * dot g (J d) / dot d d - (dot g d' / 2 - x') * dot g (J d') / dot d' d').
Proof.
  intros C. pose proof (cross_left _ _ C) as M. pose proof (cross_right _ _ C) as M'.
  unfold wedge. destruct g, d, d'. coordinates. field. auto.
Qed.

Lemma K_plane v g h : In v (inner S) -> K S v (minus h (plane g)) = K S v h.
Proof.
  intros Hi. assert (Hv : In v vertices) by (apply in_or_app; now left).
  destruct (inner_full S v Hi) as (u & up & p & q & down & F & _).
  replace (up ++ p :: q :: down ++ [u]) with ((up ++ p :: q :: down) ++ [u]) in F
    by (now rewrite <- app_assoc).
  unfold K. rewrite (sum_ext _ _ (fun s => (let '(a, b) := s in
      wedge (spoke v a) (spoke v b) (h a - h v) (h b - h v)) + (let '(a, b) := s in
      (fun a => (dot g (spoke v a) / 2 - (h a - h v)) * dot g (J (spoke v a)) / dot (spoke v a) (spoke v a)) a -
      (fun a => (dot g (spoke v a) / 2 - (h a - h v)) * dot g (J (spoke v a)) / dot (spoke v a) (spoke v a)) b))).
  - rewrite sum_plus. rewrite F at 2. rewrite (telescope (fun a =>
      (dot g (spoke v a) / 2 - (h a - h v)) * dot g (J (spoke v a)) / dot (spoke v a) (spoke v a))). ring.
  - intros [a b] Hs. rewrite <- wedge_plane by (pose proof (step_left S v a b Hv Hs); lra).
    f_equal; unfold minus, plane, Sheet.spoke, dot, sub; cbn [fst snd]; ring.
Qed.

(** K_v <= 0 on a hyperplane: the functions that have opposite slopes along the first spoke and the
    direction opposite to it. *)
Lemma negative_hyperplane v : In v (inner S) ->
  exists f : vec -> R, linear f /\ forall h, f h = 0 -> K S v h <= 0.
Proof.
  intros Hi. assert (Hv : In v vertices) by (apply in_or_app; now left).
  destruct (inner_full S v Hi) as (u & up & p & q & down & F & Up & Q & Down).
  set (d0 := spoke v u) in *. set (g := fun h : vec => (h u - h v) / dot d0 d0).
  set (y := fun h z => (h z - h v) - g h * dot d0 (spoke v z)).
  exists (fun h => y h p * cross d0 (spoke v q) - y h q * cross d0 (spoke v p)). split.
  { intros a s b. unfold y, g, move, Rdiv. ring. }
  intros h Y.
  assert (N0 : dot d0 d0 <> 0).
  { assert (St : exists z, In (u, z) (steps (fan S v))).
    { rewrite F. destruct up as [|z up]; [exists p|exists z]; now left. }
    destruct St as (z & St). apply (cross_left _ (spoke v z)). unfold d0.
    pose proof (step_left S v u z Hv St). lra. }
  set (h' := minus h (plane (g h * fst d0, g h * snd d0))).
  assert (E : forall z, h' z - h' v = y h z).
  { intros z. unfold h', minus, plane, y, Sheet.spoke, dot, sub. cbn [fst snd]. ring. }
  assert (Yu : y h u = 0). { unfold y. fold d0. unfold g. field. assumption. }
  rewrite <- (K_plane v (g h * fst d0, g h * snd d0) h Hi). fold h'.
  assert (Hu : h' u = h' v) by (specialize (E u); lra).
  assert (F' : fan S v = u :: (up ++ p :: q :: down) ++ [u]) by (rewrite F, <- app_assoc; reflexivity).
  apply (K_good v h' u _ u Hv F'); [assumption|assumption|].
  assert (Pp : 0 < cross d0 (spoke v p)) by (apply Up, in_or_app; right; now left).
  assert (Yq : cross d0 (spoke v q) = 0 -> y h q = 0).
  { intros Z. rewrite Z in Y. destruct (Rmult_integral (y h q) (cross d0 (spoke v p))); lra. }
  assert (Cu : cross d0 (spoke v u) = 0) by (unfold d0; coordinates; ring).
  intros a b Hs. rewrite !E. fold d0. rewrite F in Hs.
  change (u :: up ++ p :: q :: down ++ [u]) with ((u :: up) ++ p :: q :: down ++ [u]) in Hs.
  rewrite steps_split in Hs. apply in_app_or in Hs.
  destruct Hs as [Hs|Hs]; [|destruct Hs as [Hs|Hs]].
  - cbn [app] in Hs. apply steps_in in Hs. destruct Hs as (Ha & Hb).
    assert (M : forall z, In z (u :: up ++ [p]) ->
      0 <= cross d0 (spoke v z) /\ (cross d0 (spoke v z) = 0 -> y h z = 0)).
    { intros z [<-|Hz]; [split; [lra|auto]|]. specialize (Up z Hz). split; lra. }
    destruct (M a Ha), (M b (or_intror Hb)). apply good_one_side; auto. now apply Rmult_le_pos.
  - injection Hs as <- <-. right. split; [lra|]. split; [lra|assumption].
  - change (In (a, b) (steps (q :: down ++ [u]))) in Hs. apply steps_in in Hs. destruct Hs as (Ha & Hb).
    assert (M : forall z, In z (q :: down ++ [u]) ->
      cross d0 (spoke v z) <= 0 /\ (cross d0 (spoke v z) = 0 -> y h z = 0)).
    { intros z [<-|Hz]; [split; assumption|]. apply in_app_or in Hz. destruct Hz as [Hz|[<-|[]]].
      - specialize (Down z Hz). split; lra.
      - split; [lra|auto]. }
    destruct (M a Ha) as (Na & ?), (M b (or_intror Hb)) as (Nb & ?). apply good_one_side; auto.
    pose proof (Rmult_le_pos (- cross d0 (spoke v a)) (- cross d0 (spoke v b)) ltac:(lra) ltac:(lra)). lra.
Qed.

(** One positive direction: the reversed Cauchy inequality. *)
Theorem one_positive_direction v g h : In v (inner S) -> 0 < K S v g ->
  K S v g * K S v h <= K2 S v g h * K2 S v g h.
Proof.
  intros Hi Pg. assert (Hv : In v vertices) by (apply in_or_app; now left).
  destruct (negative_hyperplane v Hi) as (f & L & Neg).
  assert (Ng : f g <> 0) by (intros Z; specialize (Neg g Z); lra).
  set (s := - (f h / f g)).
  assert (Z : f (move h s g) = 0) by (rewrite L; unfold s; field; assumption).
  apply Neg in Z. rewrite K_move, (K2_sym v h g) in Z by assumption.
  set (a := K S v g) in *. set (b := K S v h) in *. set (c := K2 S v g h) in *.
  apply (Rmult_le_compat_l a) in Z; [|lra].
  pose proof (Rle_0_sqr (c + s * a)) as Sq. unfold Rsqr in Sq.
  replace (a * (b + 2 * s * c + s * s * a)) with (a * b - c * c + (c + s * a) * (c + s * a)) in Z by ring.
  lra.
Qed.

(** (L), its first part. *)
Corollary L v h w : In v (inner S) -> 0 < K S v h -> K2 S v h w = 0 -> K S v w <= 0.
Proof.
  intros Hi P O. pose proof (one_positive_direction v h w Hi P) as H. rewrite O in H.
  apply (Rmult_le_reg_l (K S v h)); lra.
Qed.

(** The round cone has positive curvature. *)
Theorem cone_positive v : In v (inner S) -> 0 < K S v (cone S v).
Proof.
  intros Hi. assert (Hv : In v vertices) by (apply in_or_app; now left).
  apply sum_pos.
  - destruct (inner_full S v Hi) as (u & up & p & q & down & F & _). rewrite F.
    destruct up; discriminate.
  - intros [a b] Hs. pose proof (step_left S v a b Hv Hs) as C.
    pose proof (cross_left _ _ (Rgt_not_eq _ _ C)) as M. pose proof (cross_right _ _ (Rgt_not_eq _ _ C)) as M'.
    unfold cone. replace (dot (spoke v v) (spoke v v)) with 0 by (unfold Sheet.spoke; coordinates; ring).
    rewrite sqrt_0.
    assert (Lag : dot (spoke v a) (spoke v b) * dot (spoke v a) (spoke v b) +
      cross (spoke v a) (spoke v b) * cross (spoke v a) (spoke v b) =
      dot (spoke v a) (spoke v a) * dot (spoke v b) (spoke v b)) by (coordinates; ring).
    pose proof (dot_pos (spoke v a)) as Pa. pose proof (dot_pos (spoke v b)) as Pb.
    set (ra := sqrt (dot (spoke v a) (spoke v a))). set (rb := sqrt (dot (spoke v b) (spoke v b))).
    assert (Ra : ra * ra = dot (spoke v a) (spoke v a)) by now apply sqrt_sqrt.
    assert (Rb : rb * rb = dot (spoke v b) (spoke v b)) by now apply sqrt_sqrt.
    assert (0 <= ra) by apply sqrt_pos. assert (0 <= rb) by apply sqrt_pos.
    unfold wedge. rewrite <- Ra, <- Rb in *.
    set (c := cross (spoke v a) (spoke v b)) in *. set (s := dot (spoke v a) (spoke v b)) in *.
    assert (ra <> 0) by (intros Z; rewrite Z in M; lra). assert (rb <> 0) by (intros Z; rewrite Z in M'; lra).
    replace (_ - _) with ((ra * rb - s) / c) by (field; repeat split; lra).
    apply Rdiv_lt_0_compat; [|assumption].
    assert (0 <= ra * rb) by now apply Rmult_le_pos.
    destruct (Rle_lt_dec s (ra * rb)) as [[Lt|Eq]|Gt]; [lra| |].
    + exfalso. assert (0 < c * c) by now apply Rmult_lt_0_compat. rewrite Eq in Lag. lra.
    + exfalso. assert (0 < c * c) by now apply Rmult_lt_0_compat.
      assert (ra * rb * (ra * rb) <= s * s) by (apply Rmult_le_compat; lra). lra.
Qed.

End Star.
