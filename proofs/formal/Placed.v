(** Every configuration near the flat sheet can be moved so that one vertex is at its place, another one on its line
    with the first, and a third one in the plane. *)
From Coq Require Import Reals List Lra Lia Arith FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Sheet Identities Displacements.
Import ListNotations.
Open Scope R_scope.

(** ** Vectors of space: a point over which, and a height *)

Definition vec3 := (point * R)%type.
Definition sub3 (x y : vec3) : vec3 := (sub (fst x) (fst y), snd x - snd y).
Definition dot3 (x y : vec3) : R := fst (fst x) * fst (fst y) + snd (fst x) * snd (fst y) + snd x * snd y.
Definition cross3 (x y : vec3) : vec3 :=
  ((snd (fst x) * snd y - snd x * snd (fst y), snd x * fst (fst y) - fst (fst x) * snd y),
   fst (fst x) * snd (fst y) - snd (fst x) * fst (fst y)).

(** A frame of three vectors at right angles gives the length of any vector. *)
Lemma frame a n x : dot3 n a = 0 -> 0 < dot3 a a -> 0 < dot3 n n -> let m := cross3 n a in
  dot3 x x = dot3 x a * dot3 x a / dot3 a a + dot3 x m * dot3 x m / dot3 m m + dot3 x n * dot3 x n / dot3 n n.
Proof.
  intros O Pa Pn m.
  assert (M : dot3 m m = dot3 n n * dot3 a a).
  { transitivity (dot3 n n * dot3 a a - dot3 n a * dot3 n a); [|rewrite O; ring].
    unfold m, dot3, cross3. cbn [fst snd]. ring. }
  assert (G : dot3 x m * dot3 x m = dot3 x x * (dot3 n n * dot3 a a) - dot3 n n * (dot3 x a * dot3 x a) -
    dot3 a a * (dot3 x n * dot3 x n)).
  { transitivity (dot3 x x * (dot3 n n * dot3 a a) - dot3 n n * (dot3 x a * dot3 x a) -
      dot3 a a * (dot3 x n * dot3 x n) - dot3 x x * (dot3 n a * dot3 n a) +
      2 * (dot3 x n * dot3 n a * dot3 x a)); [|rewrite O; ring].
    unfold m, dot3, cross3. cbn [fst snd]. ring. }
  rewrite M, G. field. lra.
Qed.

Lemma moved_square (d o : point) l a m n a' m' n' : l <> 0 ->
  let P := fun a m => add o (add (scale (a / l) d) (scale (m / l) (J d))) in
  let w := sub3 (P a m, n) (P a' m', n') in
  dot3 w w = ((a - a') * (a - a') + (m - m') * (m - m')) * (dot d d / (l * l)) + (n - n') * (n - n').
Proof.
  intros Nl. destruct d as [x y], o as [p q]. cbv zeta. unfold dot3, sub3, sub, add, scale, J, dot. cbn [fst snd].
  field. exact Nl.
Qed.

(** ** Limits at the flat sheet *)

Section Placed.
Variable at_ : nat -> point.
Variable vertices : list nat.

Definition configuration := ((nat -> point) * vec)%type.
Definition position (c : configuration) (v : nat) : vec3 := (fst c v, snd c v).
(** All vertices are near their places in the flat sheet. *)
Definition near (delta : R) (c : configuration) : Prop :=
  forall v, In v vertices -> bounded delta (sub (fst c v) (at_ v)) /\ Rabs (snd c v) <= delta.
Definition tends (q : configuration -> R) (l : R) : Prop :=
  forall eps, 0 < eps -> exists delta, 0 < delta /\ forall c, near delta c -> Rabs (q c - l) <= eps.

Lemma nearer delta delta' c : delta <= delta' -> near delta c -> near delta' c.
Proof. intros Le N v Hv. destruct (N v Hv) as ((A & B) & C). repeat split; lra. Qed.

Lemma tends_eq q l l' : tends q l -> l = l' -> tends q l'.
Proof. now intros T <-. Qed.

Lemma tends_const l : tends (fun _ => l) l.
Proof. intros eps Pe. exists 1. split; [lra|]. intros c _. unfold Rminus. rewrite Rplus_opp_r, Rabs_R0. lra. Qed.

Lemma tends_plus q q' l l' : tends q l -> tends q' l' -> tends (fun c => q c + q' c) (l + l').
Proof.
  intros T T' eps Pe. destruct (T (eps / 2)) as (d & Pd & H); [lra|].
  destruct (T' (eps / 2)) as (d' & Pd' & H'); [lra|].
  exists (Rmin d d'). split; [now apply Rmin_pos|]. intros c N.
  replace (q c + q' c - (l + l')) with ((q c - l) + (q' c - l')) by ring. replace eps with (eps / 2 + eps / 2) by field.
  apply sum_bound; [apply H|apply H']; (eapply nearer; [|exact N]); [apply Rmin_l|apply Rmin_r].
Qed.

Lemma tends_comp f q l : continuity_pt f l -> tends q l -> tends (fun c => f (q c)) (f l).
Proof.
  intros C T eps Pe. destruct (C eps Pe) as (alp & Pa & H). simpl in H. unfold R_dist in H.
  destruct (T (alp / 2)) as (d & Pd & Hd); [lra|]. exists d. split; [exact Pd|]. intros c N.
  destruct (Req_dec (q c) l) as [->|Ne]; [unfold Rminus; rewrite Rplus_opp_r, Rabs_R0; lra|].
  apply Rlt_le, H. split; [split; [exact I|auto]|]. specialize (Hd c N). lra.
Qed.

Lemma tends_scal s q l : tends q l -> tends (fun c => s * q c) (s * l).
Proof. apply (tends_comp (fun x => s * x)). apply continuity_pt_scal, derivable_continuous_pt, derivable_pt_id. Qed.

Lemma tends_opp q l : tends q l -> tends (fun c => - q c) (- l).
Proof. apply (tends_comp (fun x => - x)). apply continuity_pt_opp, derivable_continuous_pt, derivable_pt_id. Qed.

Lemma tends_minus q q' l l' : tends q l -> tends q' l' -> tends (fun c => q c - q' c) (l - l').
Proof. intros T T'. exact (tends_plus _ _ _ _ T (tends_opp _ _ T')). Qed.

Lemma tends_mult q q' l l' : tends q l -> tends q' l' -> tends (fun c => q c * q' c) (l * l').
Proof.
  intros T T'. assert (Sq : forall r k, tends r k -> tends (fun c => r c * r c) (k * k)).
  { intros r k. apply (tends_comp (fun x => x * x)).
    apply continuity_pt_mult; apply derivable_continuous_pt, derivable_pt_id. }
  pose proof (tends_scal (/ 4) _ _
    (tends_minus _ _ _ _ (Sq _ _ (tends_plus _ _ _ _ T T')) (Sq _ _ (tends_minus _ _ _ _ T T'))))
    as R. cbn beta in R.
  replace (fun c => q c * q' c) with
    (fun c => / 4 * ((q c + q' c) * (q c + q' c) - (q c - q' c) * (q c - q' c)))
    by (apply functional_extensionality; intro; field).
  apply (tends_eq _ _ _ R). field.
Qed.

Lemma tends_inv q l : l <> 0 -> tends q l -> tends (fun c => / q c) (/ l).
Proof.
  intros Nl. apply (tends_comp (fun x => / x)).
  apply (continuity_pt_inv (fun x => x)); [apply derivable_continuous_pt, derivable_pt_id|exact Nl].
Qed.

Lemma tends_sqrt q l : 0 <= l -> tends q l -> tends (fun c => sqrt (q c)) (sqrt l).
Proof. intros Pl. apply (tends_comp sqrt). now apply continuity_pt_sqrt. Qed.

Lemma tends_positive q l : 0 < l -> tends q l -> exists delta, 0 < delta /\ forall c, near delta c -> 0 < q c.
Proof.
  intros Pl T. destruct (T (l / 2)) as (d & Pd & H); [lra|]. exists d. split; [exact Pd|]. intros c N.
  specialize (H c N).
  unfold Rabs in H. destruct Rcase_abs; lra.
Qed.

Definition tends3 (q : configuration -> vec3) (l : vec3) : Prop :=
  tends (fun c => fst (fst (q c))) (fst (fst l)) /\ tends (fun c => snd (fst (q c))) (snd (fst l)) /\
  tends (fun c => snd (q c)) (snd l).

Lemma tends_arrow u v : In u vertices -> In v vertices ->
  tends3 (fun c => sub3 (position c v) (position c u)) (sub (at_ v) (at_ u), 0).
Proof.
  intros Hu Hv. assert (T : forall w, In w vertices -> tends (fun c => fst (fst c w)) (fst (at_ w)) /\
    tends (fun c => snd (fst c w)) (snd (at_ w)) /\ tends (fun c => snd c w) 0).
  { intros w Hw. repeat split; intros eps Pe; exists eps; (split; [exact Pe|]); intros c N;
      destruct (N w Hw) as ((A & B) & C); unfold sub in A, B; cbn [fst snd] in A, B; try assumption.
      now rewrite Rminus_0_r. }
  destruct (T u Hu) as (U1 & U2 & U3). destruct (T v Hv) as (V1 & V2 & V3).
  unfold sub3, sub, position. repeat split; cbn [fst snd]; try (now apply tends_minus).
  apply (tends_eq _ (0 - 0)); [now apply tends_minus|ring].
Qed.

Lemma tends_dot3 q q' l l' : tends3 q l -> tends3 q' l' -> tends (fun c => dot3 (q c) (q' c)) (dot3 l l').
Proof. intros (A & B & C) (A' & B' & C'). unfold dot3. repeat apply tends_plus; now apply tends_mult. Qed.

Lemma tends_cross3 q q' l l' : tends3 q l -> tends3 q' l' -> tends3 (fun c => cross3 (q c) (q' c)) (cross3 l l').
Proof.
  intros (A & B & C) (A' & B' & C'). unfold cross3.
  repeat split; cbn [fst snd]; apply tends_minus; now apply tends_mult.
Qed.

(** ** The frame of three vertices *)

Variables b1 b2 b3 : nat.
Hypothesis In1 : In b1 vertices.
Hypothesis In2 : In b2 vertices.
Hypothesis In3 : In b3 vertices.
Notation d := (sub (at_ b2) (at_ b1)).
Notation turn := (cross d (sub (at_ b3) (at_ b1))).
Hypothesis Corners : turn <> 0.

Definition along (c : configuration) : vec3 := sub3 (position c b2) (position c b1).
Definition normal (c : configuration) : vec3 :=
  let n := cross3 (along c) (sub3 (position c b3) (position c b1)) in (scale turn (fst n), turn * snd n).
Definition across (c : configuration) : vec3 := cross3 (normal c) (along c).
Definition coordinate (c : configuration) (e x : vec3) : R := dot3 x e / sqrt (dot3 e e).
Definition placed (c : configuration) : configuration :=
  let l := sqrt (dot d d) in let x := fun v => sub3 (position c v) (position c b1) in
  (fun v => add (at_ b1) (add (scale (coordinate c (along c) (x v) / l) d)
     (scale (coordinate c (across c) (x v) / l) (J d))), fun v => coordinate c (normal c) (x v)).

Lemma d_positive : 0 < dot d d.
Proof.
  destruct (Rle_lt_dec (dot d d) 0) as [Le|]; [exfalso|assumption]. pose proof (dot_pos d).
  apply (cross_left _ _ Corners). lra.
Qed.

Lemma tends_along : tends3 along (d, 0).
Proof. now apply tends_arrow. Qed.

Lemma tends_normal : tends3 normal (origin, turn * turn).
Proof.
  destruct (tends_cross3 _ _ _ _ tends_along (tends_arrow b1 b3 In1 In3)) as (A & B & C).
  unfold normal. repeat split; cbn [fst snd scale origin].
  - eapply tends_eq; [apply tends_scal; exact A|]. unfold cross3. cbn [fst snd]. ring.
  - eapply tends_eq; [apply tends_scal; exact B|]. unfold cross3. cbn [fst snd]. ring.
  - eapply tends_eq; [apply tends_scal; exact C|]. unfold cross3, cross. cbn [fst snd]. ring.
Qed.

Lemma tends_across : tends3 across (scale (turn * turn) (J d), 0).
Proof.
  destruct (tends_cross3 _ _ _ _ tends_normal tends_along) as (A & B & C). unfold across.
  repeat split; [apply (tends_eq _ _ _ A)|apply (tends_eq _ _ _ B)|apply (tends_eq _ _ _ C)];
    unfold cross3, scale, J, origin; cbn [fst snd]; ring.
Qed.

Lemma tends_coordinate e l v : tends3 e l -> 0 < dot3 l l -> In v vertices ->
  tends (fun c => coordinate c (e c) (sub3 (position c v) (position c b1)))
    (dot3 (sub (at_ v) (at_ b1), 0) l / sqrt (dot3 l l)).
Proof.
  intros T P Hv. unfold coordinate, Rdiv. apply tends_mult.
  - apply tends_dot3; [now apply tends_arrow|exact T].
  - apply tends_inv; [pose proof (sqrt_lt_R0 _ P); lra|]. apply tends_sqrt; [lra|]. now apply tends_dot3.
Qed.

Lemma tends_placed v : In v vertices -> tends (fun c => fst (fst (placed c) v)) (fst (at_ v)) /\
  tends (fun c => snd (fst (placed c) v)) (snd (at_ v)) /\ tends (fun c => snd (placed c) v) 0.
Proof.
  intros Hv. pose proof d_positive as Pd. set (k := turn) in *. set (l := sqrt (dot d d)).
  assert (Pl : 0 < l) by now apply sqrt_lt_R0. assert (Ll : l * l = dot d d) by (apply sqrt_sqrt; lra).
  assert (Pk : 0 < k * k) by nra. set (y := sub (at_ v) (at_ b1)).
  assert (E1 : dot3 (d, 0) (d, 0) = dot d d) by (unfold dot3, dot; cbn [fst snd]; ring).
  assert (E2 : dot3 (scale (k * k) (J d), 0) (scale (k * k) (J d), 0) = k * k * l * (k * k * l)).
  { transitivity (k * k * (k * k) * (l * l)); [rewrite Ll|ring]. unfold dot3, scale, J, dot. cbn [fst snd]. ring. }
  assert (E3 : dot3 (origin, k * k) (origin, k * k) = k * k * (k * k)) by (unfold dot3, origin; cbn [fst snd]; ring).
  assert (Pkl : 0 < k * k * l) by now apply Rmult_lt_0_compat.
  pose proof (tends_coordinate along _ v tends_along ltac:(rewrite E1; exact Pd) Hv) as T1.
  pose proof (tends_coordinate across _ v tends_across ltac:(fold k; rewrite E2; now apply Rmult_lt_0_compat) Hv) as T2.
  pose proof (tends_coordinate normal _ v tends_normal ltac:(fold k; rewrite E3; now apply Rmult_lt_0_compat) Hv) as T3.
  fold k in T2, T3. fold y in T1, T2, T3. rewrite E1 in T1. fold l in T1. rewrite E2, sqrt_square in T2 by lra.
  rewrite E3, sqrt_square in T3 by lra.
  assert (Y : forall w : point, dot y d / (l * l) * fst d + dot y (J d) / (l * l) * - snd d = fst y /\
    dot y d / (l * l) * snd d + dot y (J d) / (l * l) * fst d = snd y).
  { intros _. rewrite Ll. unfold dot in Pd |- *. unfold J. cbn [fst snd].
    split; field; unfold sub in *; cbn [fst snd] in *; lra. }
  destruct (Y y) as (Y1 & Y2). unfold placed. cbv zeta. fold l. unfold add, scale. cbn [fst snd]. repeat split.
  - eapply tends_eq.
    + apply tends_plus; [apply tends_const|]. apply tends_plus; apply tends_mult; try apply tends_const;
        unfold Rdiv; apply tends_mult; [exact T1|apply tends_const|exact T2|apply tends_const].
    + transitivity (fst (at_ b1) + fst y); [|unfold y, sub; cbn [fst snd]; ring]. rewrite <- Y1.
      unfold dot3, scale, dot, J. cbn [fst snd]. field. repeat split; try lra; intros Z; subst k; rewrite Z in Pk; lra.
  - eapply tends_eq.
    + apply tends_plus; [apply tends_const|]. apply tends_plus; apply tends_mult; try apply tends_const;
        unfold Rdiv; apply tends_mult; [exact T1|apply tends_const|exact T2|apply tends_const].
    + transitivity (snd (at_ b1) + snd y); [|unfold y, sub; cbn [fst snd]; ring]. rewrite <- Y2.
      unfold dot3, scale, dot, J. cbn [fst snd]. field. repeat split; try lra; intros Z; subst k; rewrite Z in Pk; lra.
  - apply (tends_eq _ _ _ T3). unfold dot3, origin. cbn [fst snd]. field. lra.
Qed.

Lemma normal_along c : dot3 (normal c) (along c) = 0.
Proof. unfold normal, dot3, cross3, scale. cbn [fst snd]. ring. Qed.

Lemma coordinate_difference c e v u : coordinate c e (sub3 (position c v) (position c b1)) -
  coordinate c e (sub3 (position c u) (position c b1)) = coordinate c e (sub3 (position c v) (position c u)).
Proof. unfold coordinate, dot3, sub3, sub, Rdiv. cbn [fst snd]. ring. Qed.

Lemma coordinate_square c e x : 0 < dot3 e e -> coordinate c e x * coordinate c e x = dot3 x e * dot3 x e / dot3 e e.
Proof.
  intros P. unfold coordinate. pose proof (sqrt_lt_R0 _ P). rewrite <- (sqrt_sqrt (dot3 e e)) at 3 by lra. field. lra.
Qed.

Definition same_distances (c c' : configuration) : Prop := forall u v, In u vertices -> In v vertices ->
  dot3 (sub3 (position c v) (position c u)) (sub3 (position c v) (position c u)) =
  dot3 (sub3 (position c' v) (position c' u)) (sub3 (position c' v) (position c' u)).

(** The configuration is moved, all distances stay the same, and it stays near the flat sheet. *)
Theorem placing eps : 0 < eps -> exists delta, 0 < delta /\ forall c, near delta c ->
  same_distances c (placed c) /\ near eps (placed c) /\ fst (placed c) b1 = at_ b1 /\
  cross d (sub (fst (placed c) b2) (at_ b1)) = 0 /\
  snd (placed c) b1 = 0 /\ snd (placed c) b2 = 0 /\ snd (placed c) b3 = 0.
Proof.
  intros Pe. pose proof d_positive as Pd.
  assert (Pk : 0 < turn * turn) by (pose proof (Rsqr_pos_lt turn Corners) as X; exact X).
  assert (Ta : tends (fun c => dot3 (along c) (along c)) (dot d d)).
  { apply (tends_eq _ _ _ (tends_dot3 _ _ _ _ tends_along tends_along)). unfold dot3, dot. cbn [fst snd]. ring. }
  assert (Tn : tends (fun c => dot3 (normal c) (normal c)) (turn * turn * (turn * turn))).
  { apply (tends_eq _ _ _ (tends_dot3 _ _ _ _ tends_normal tends_normal)).
    unfold dot3, origin. cbn [fst snd]. ring. }
  destruct (tends_positive _ _ Pd Ta) as (d1 & P1 & A).
  destruct (tends_positive _ _ (Rmult_lt_0_compat _ _ Pk Pk) Tn) as (d2 & P2 & N).
  destruct (common_bound vertices (fun v delta => forall c, near delta c ->
    bounded eps (sub (fst (placed c) v) (at_ v)) /\ Rabs (snd (placed c) v) <= eps)) as (d3 & P3 & Close).
  { intros v x y H Le c Nc. apply H. now apply (nearer y x). }
  { intros v Hv. destruct (tends_placed v Hv) as (T1 & T2 & T3).
    destruct (T1 eps Pe) as (e1 & Q1 & H1). destruct (T2 eps Pe) as (e2 & Q2 & H2).
    destruct (T3 eps Pe) as (e3 & Q3 & H3). exists (Rmin e1 (Rmin e2 e3)). split; [now repeat apply Rmin_pos|].
    intros c Nc. pose proof (Rmin_l e1 (Rmin e2 e3)). pose proof (Rmin_r e1 (Rmin e2 e3)).
    pose proof (Rmin_l e2 e3). pose proof (Rmin_r e2 e3).
    split; [split|]; cbn [sub fst snd].
    - apply H1. apply (nearer (Rmin e1 (Rmin e2 e3))); [lra|exact Nc].
    - apply H2. apply (nearer (Rmin e1 (Rmin e2 e3))); [lra|exact Nc].
    - rewrite <- (Rminus_0_r (snd (placed c) v)). apply H3. apply (nearer (Rmin e1 (Rmin e2 e3))); [lra|exact Nc]. }
  exists (Rmin d1 (Rmin d2 d3)). split; [now repeat apply Rmin_pos|]. intros c Nc.
  pose proof (Rmin_l d1 (Rmin d2 d3)). pose proof (Rmin_r d1 (Rmin d2 d3)).
  pose proof (Rmin_l d2 d3). pose proof (Rmin_r d2 d3).
  assert (Pa : 0 < dot3 (along c) (along c)) by (apply A; apply (nearer (Rmin d1 (Rmin d2 d3))); [lra|exact Nc]).
  assert (Pn : 0 < dot3 (normal c) (normal c)) by (apply N; apply (nearer (Rmin d1 (Rmin d2 d3))); [lra|exact Nc]).
  assert (Cl : near eps (placed c)).
  { intros v Hv. apply (Close v Hv). apply (nearer (Rmin d1 (Rmin d2 d3))); [lra|exact Nc]. }
  set (l := sqrt (dot d d)). assert (Pl : 0 < l) by now apply sqrt_lt_R0.
  assert (Ll : l * l = dot d d) by (apply sqrt_sqrt; lra).
  pose proof (normal_along c) as O.
  assert (Zero : forall e, coordinate c e (sub3 (position c b1) (position c b1)) = 0).
  { intros e. unfold coordinate, dot3, sub3, sub, Rdiv. cbn [fst snd]. ring. }
  assert (Oa : coordinate c (across c) (along c) = 0).
  { unfold coordinate, across, dot3, cross3, Rdiv. cbn [fst snd]. ring. }
  assert (On : coordinate c (normal c) (along c) = 0).
  { unfold coordinate. replace (dot3 (along c) (normal c)) with (dot3 (normal c) (along c)) by (unfold dot3; ring).
    rewrite O. unfold Rdiv. ring. }
  split; [|split; [exact Cl|split; [|split; [|split; [|split]]]]].
  - intros u v Hu Hv. set (w := sub3 (position c v) (position c u)).
    assert (Pm : 0 < dot3 (across c) (across c)).
    { replace (dot3 (across c) (across c)) with (dot3 (normal c) (normal c) * dot3 (along c) (along c) -
        dot3 (normal c) (along c) * dot3 (normal c) (along c)) by (unfold across, dot3, cross3; cbn [fst snd]; ring).
      rewrite O. pose proof (Rmult_lt_0_compat _ _ Pn Pa). lra. }
    rewrite (frame (along c) (normal c) w O Pa Pn). cbv zeta. fold (across c).
    rewrite <- !(coordinate_square c) by assumption. unfold w.
    rewrite <- (coordinate_difference c (along c) v u), <- (coordinate_difference c (across c) v u),
      <- (coordinate_difference c (normal c) v u).
    symmetry. etransitivity.
    + exact (moved_square d (at_ b1) l (coordinate c (along c) (sub3 (position c v) (position c b1)))
        (coordinate c (across c) (sub3 (position c v) (position c b1)))
        (coordinate c (normal c) (sub3 (position c v) (position c b1)))
        (coordinate c (along c) (sub3 (position c u) (position c b1)))
        (coordinate c (across c) (sub3 (position c u) (position c b1)))
        (coordinate c (normal c) (sub3 (position c u) (position c b1))) ltac:(lra)).
    + rewrite Ll. unfold Rdiv. rewrite Rinv_r by lra. ring.
  - unfold placed. cbv zeta. cbn [fst]. rewrite !Zero. destruct (at_ b1). unfold add, scale, Rdiv. cbn [fst snd].
    f_equal; ring.
  - unfold placed. cbv zeta. cbn [fst]. fold (along c). rewrite Oa. unfold add, scale, cross, sub, Rdiv.
    cbn [fst snd]. ring.
  - apply Zero.
  - exact On.
  - unfold placed. cbv zeta. cbn [snd]. unfold coordinate.
    replace (dot3 (sub3 (position c b3) (position c b1)) (normal c)) with 0; [unfold Rdiv; ring|].
    unfold normal, dot3, cross3, scale. cbn [fst snd]. ring.
Qed.
End Placed.
