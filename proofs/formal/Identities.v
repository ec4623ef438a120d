(** The curvatures of all vertices, with weights: Theorem 1 of docs/theorem.md. *)
From Coq Require Import Reals List Permutation Lra Lia Arith.
From Exactfold Require Import Sums Vectors Sheet.
Import ListNotations.
Open Scope R_scope.

Ltac coordinates := unfold dot, cross, sub, J in *; cbn [fst snd] in *.

Lemma dot_pos d : 0 <= dot d d.
Proof. unfold dot. pose proof (Rle_0_sqr (fst d)). pose proof (Rle_0_sqr (snd d)). unfold Rsqr in *. lra. Qed.

Lemma dot_zero d : dot d d = 0 -> d = (0, 0).
Proof.
  unfold dot. destruct d as [x y]. cbn. intros E.
  pose proof (Rle_0_sqr x). pose proof (Rle_0_sqr y). unfold Rsqr in *.
  f_equal; apply Rsqr_0_uniq; unfold Rsqr; lra.
Qed.

Lemma cross_left d d' : cross d d' <> 0 -> dot d d <> 0.
Proof. intros C E. apply C. rewrite (dot_zero d E). unfold cross. cbn. ring. Qed.

Lemma cross_right d d' : cross d d' <> 0 -> dot d' d' <> 0.
Proof. intros C E. apply C. rewrite (dot_zero d' E). unfold cross. cbn. ring. Qed.

(** ** One face *)

Lemma gradient_left d d' x x' : cross d d' <> 0 -> dot (gradient d d' x x') d = x.
Proof. intros C. unfold gradient. coordinates. field. assumption. Qed.

Lemma gradient_right d d' x x' : cross d d' <> 0 -> dot (gradient d d' x x') d' = x'.
Proof. intros C. unfold gradient. coordinates. field. assumption. Qed.

(** (g . d)(g . Jd) / |d|^2 *)
Definition twist (g d : point) := dot g d * dot g (J d) / dot d d.

(** Identity (1). *)
Lemma wedge_gradient g d d' : cross d d' <> 0 ->
  wedge d d' (dot g d) (dot g d') = / 2 * (twist g d - twist g d').
Proof.
  intros C. pose proof (cross_left _ _ C) as N. pose proof (cross_right _ _ C) as N'.
  unfold wedge, twist. destruct g as [g1 g2], d as [x y], d' as [x' y']. coordinates.
  field. auto.
Qed.

(** What a side contributes to (3). *)
Definition flux (c a b : point) (x : R) : R :=
  x * x * dot (sub ((fst a + fst b) / 2, (snd a + snd b) / 2) c) (J (sub b a)) / dot (sub b a) (sub b a).

Lemma flux_reverse c a b x : flux c a b x = - flux c b a (- x).
Proof.
  unfold flux. replace (dot (sub a b) (sub a b)) with (dot (sub b a) (sub b a)) by (coordinates; ring).
  unfold Rdiv. rewrite <- Ropp_mult_distr_l_reverse. f_equal. coordinates. field.
Qed.

Lemma flux_twist c g a b : dot (sub b a) (sub b a) <> 0 ->
  twist g (sub b a) * (dot (sub a c) (sub a c) - dot (sub b c) (sub b c)) / 2 + flux c a b (dot g (sub b a)) =
  dot g (sub b a) * cross g (sub ((fst a + fst b) / 2, (snd a + snd b) / 2) c).
Proof.
  intros N. unfold flux, twist. destruct g, c, a, b. coordinates. field. assumption.
Qed.

Section Face.
Variables (c pa pb pc g : point).
Hypothesis C : 0 < cross (sub pb pa) (sub pc pa).

Lemma face_cross_b : cross (sub pc pb) (sub pa pb) = cross (sub pb pa) (sub pc pa).
Proof. coordinates. ring. Qed.
Lemma face_cross_c : cross (sub pa pc) (sub pb pc) = cross (sub pb pa) (sub pc pa).
Proof. coordinates. ring. Qed.

Let ka := wedge (sub pb pa) (sub pc pa) (dot g (sub pb pa)) (dot g (sub pc pa)).
Let kb := wedge (sub pc pb) (sub pa pb) (dot g (sub pc pb)) (dot g (sub pa pb)).
Let kc := wedge (sub pa pc) (sub pb pc) (dot g (sub pa pc)) (dot g (sub pb pc)).

Lemma twist_reverse a b : twist g (sub a b) = twist g (sub b a).
Proof.
  unfold twist. replace (dot (sub a b) (sub a b)) with (dot (sub b a) (sub b a)) by (coordinates; ring).
  f_equal. coordinates. ring.
Qed.

Lemma face_wedges : let tab := twist g (sub pb pa) in let tbc := twist g (sub pc pb) in
  let tca := twist g (sub pa pc) in
  ka = / 2 * (tab - tca) /\ kb = / 2 * (tbc - tab) /\ kc = / 2 * (tca - tbc).
Proof.
  cbn zeta. unfold ka, kb, kc. rewrite !wedge_gradient.
  - rewrite (twist_reverse pc pa), (twist_reverse pa pb), (twist_reverse pb pc). repeat split.
  - rewrite face_cross_c. lra.
  - rewrite face_cross_b. lra.
  - lra.
Qed.

(** Identity (2). *)
Lemma face_sum : ka + kb + kc = 0.
Proof. destruct face_wedges as (-> & -> & ->). ring. Qed.

(** Identity (3). *)
Lemma face_moment :
  dot (sub pa c) (sub pa c) * ka + dot (sub pb c) (sub pb c) * kb + dot (sub pc c) (sub pc c) * kc
  + cross (sub pb pa) (sub pc pa) / 2 * dot g g
  + (flux c pa pb (dot g (sub pb pa)) + flux c pb pc (dot g (sub pc pb)) + flux c pc pa (dot g (sub pa pc))) = 0.
Proof.
  destruct face_wedges as (-> & -> & ->).
  assert (Nab : dot (sub pb pa) (sub pb pa) <> 0) by (apply (cross_left _ (sub pc pa)); lra).
  assert (Nbc : dot (sub pc pb) (sub pc pb) <> 0)
    by (apply (cross_left _ (sub pa pb)); rewrite face_cross_b; lra).
  assert (Nca : dot (sub pa pc) (sub pa pc) <> 0)
    by (apply (cross_left _ (sub pb pc)); rewrite face_cross_c; lra).
  pose proof (flux_twist c g pa pb Nab) as Eab. pose proof (flux_twist c g pb pc Nbc) as Ebc.
  pose proof (flux_twist c g pc pa Nca) as Eca.
  set (tab := twist _ _) in *. set (tbc := twist g (sub pc pb)) in *. set (tca := twist g (sub pa pc)) in *.
  set (fab := flux _ pa pb _) in *. set (fbc := flux _ pb pc _) in *. set (fca := flux _ pc pa _) in *.
  set (ra := dot (sub pa c) (sub pa c)) in *. set (rb := dot (sub pb c) (sub pb c)) in *.
  set (rc := dot (sub pc c) (sub pc c)) in *.
  assert (E : dot g (sub pb pa) * cross g (sub ((fst pa + fst pb) / 2, (snd pa + snd pb) / 2) c) +
    dot g (sub pc pb) * cross g (sub ((fst pb + fst pc) / 2, (snd pb + snd pc) / 2) c) +
    dot g (sub pa pc) * cross g (sub ((fst pc + fst pa) / 2, (snd pc + snd pa) / 2) c) +
    cross (sub pb pa) (sub pc pa) / 2 * dot g g = 0).
  { clear. destruct c, pa, pb, pc, g. coordinates. field. }
  lra.
Qed.
End Face.

(** ** Sums over corners and sides *)

Lemma sum_filter {A} (P : A -> bool) l f : sum (filter P l) f = sum l (fun a => if P a then f a else 0).
Proof. induction l as [|a l IH]; simpl; [reflexivity|]. destruct (P a); simpl; rewrite IH; ring. Qed.

Lemma sum_indicator (vs : list nat) u (f : nat -> R) : NoDup vs -> In u vs ->
  sum vs (fun v => if Nat.eqb u v then f v else 0) = f u.
Proof.
  induction vs as [|v vs IH]; intros D Hu; [easy|]. inversion D as [|? ? Nv Dv]; subst. simpl.
  destruct Hu as [->|Hu].
  - rewrite Nat.eqb_refl. rewrite sum_zero; [ring|]. intros w Hw.
    destruct (Nat.eqb_spec u w) as [->|]; [contradiction|reflexivity].
  - rewrite IH by assumption. destruct (Nat.eqb_spec u v) as [->|]; [contradiction|ring].
Qed.

(** Antisymmetric terms cancel. *)
Lemma sum_antisymmetric (l : list (nat * nat)) (f : nat -> nat -> R) : NoDup l ->
  (forall a b, f a b = - f b a) ->
  (forall a b, In (a, b) l -> In (b, a) l \/ f a b = 0) ->
  sum l (fun s => let '(a, b) := s in f a b) = 0.
Proof.
  intros D Anti Paired.
  assert (Dec : forall s t : nat * nat, {s = t} + {s <> t}) by (repeat decide equality).
  set (swap := fun s : nat * nat => let '(a, b) := s in (b, a)).
  assert (SS : forall s, swap (swap s) = s) by now intros [a b].
  set (back := fun s => if in_dec Dec (swap s) l then true else false).
  set (l' := filter back l).
  assert (Perm : Permutation (map swap l') l').
  { apply NoDup_Permutation.
    - apply FinFun.Injective_map_NoDup; [|now apply NoDup_filter].
      intros s t E. apply (f_equal swap) in E. now rewrite !SS in E.
    - now apply NoDup_filter.
    - intros s. assert (M : forall s, In s l' <-> In s l /\ In (swap s) l).
      { intros r. unfold l'. rewrite filter_In. unfold back. destruct in_dec; intuition congruence. }
      rewrite in_map_iff. split.
      + intros (r & <- & Hr). apply M in Hr. apply M. rewrite SS. tauto.
      + intros Hs. exists (swap s). rewrite SS. split; [reflexivity|].
        apply M. rewrite SS. apply M in Hs. tauto. }
  assert (E : sum l (fun s => let '(a, b) := s in f a b) = sum l' (fun s => let '(a, b) := s in f a b)).
  { unfold l'. rewrite sum_filter. apply sum_ext. intros [a b] Hs. unfold back. simpl.
    destruct in_dec as [|N]; [reflexivity|]. now destruct (Paired a b Hs). }
  rewrite E. pose proof (sum_perm _ _ (fun s => let '(a, b) := s in f a b) Perm) as E'.
  rewrite sum_map in E'. rewrite (sum_ext l' _ (fun s => -1 * (let '(a, b) := s in f a b))) in E'.
  - rewrite sum_scal in E'. lra.
  - intros [a b] _. simpl. rewrite Anti. ring.
Qed.

Section Identity.
Variable S : sheet.
Notation at_ := (at_ S).
Notation spoke := (spoke at_).

Lemma sum_faces (f : nat -> nat -> nat -> R) :
  sum (corners (faces S)) (fun t => let '(v, a, b) := t in f v a b) =
  sum (faces S) (fun t => let '(a, b, c) := t in f a b c + f b c a + f c a b).
Proof.
  unfold corners. rewrite sum_flat_map. apply sum_ext. intros [[a b] c] _. simpl. ring.
Qed.

Lemma sum_corners (f : nat -> nat -> nat -> R) :
  sum (inner S ++ rim S) (fun v => sum (steps (fan S v)) (fun s => let '(a, b) := s in f v a b)) =
  sum (corners (faces S)) (fun t => let '(v, a, b) := t in f v a b).
Proof.
  rewrite (sum_ext _ _ (fun v => sum (corners (faces S))
    (fun t => if Nat.eqb (fst (fst t)) v then f v (snd (fst t)) (snd t) else 0))).
  - rewrite sum_swap. apply sum_ext. intros [[v a] b] Ht. cbn [fst snd].
    rewrite (sum_indicator _ v (fun u => f u a b)); [reflexivity|apply vertices_once|].
    eapply faces_on_vertices; eassumption.
  - intros v Hv. rewrite (sum_perm _ _ _ (fans S v Hv)). unfold link. rewrite sum_map, sum_filter.
    apply sum_ext. intros [[u a] b] _. cbn [fst snd].
    destruct (Nat.eqb_spec u v) as [->|]; reflexivity.
Qed.

Lemma face_of_corner v a b : In (v, a, b) (corners (faces S)) ->
  0 < cross (spoke v a) (spoke v b).
Proof.
  unfold corners. rewrite in_flat_map. intros ([[p q] r] & Hf & Hc).
  pose proof (oriented S _ _ _ Hf) as O. unfold Sheet.spoke.
  simpl in Hc. destruct Hc as [E|[E|[E|[]]]]; injection E as <- <- <-.
  - assumption.
  - now rewrite face_cross_b.
  - now rewrite face_cross_c.
Qed.

(** The steps of a fan are corners, so that they turn left. *)
Lemma step_corner v a b : In v (inner S ++ rim S) -> In (a, b) (steps (fan S v)) ->
  In (v, a, b) (corners (faces S)).
Proof.
  intros Hv Hs. apply (Permutation_in _ (fans S v Hv)) in Hs. unfold link in Hs.
  apply in_map_iff in Hs. destruct Hs as ([[u a'] b'] & E & Hf). injection E as -> ->.
  apply filter_In in Hf. destruct Hf as (Hf & Eq). apply Nat.eqb_eq in Eq. now subst u.
Qed.

Lemma step_left v a b : In v (inner S ++ rim S) -> In (a, b) (steps (fan S v)) ->
  0 < cross (spoke v a) (spoke v b).
Proof. intros. now apply face_of_corner, step_corner. Qed.

(** The gradient of a face has the right differences. *)
Lemma gradient_differences a b c h : In (a, b, c) (faces S) ->
  let g := face_gradient S (a, b, c) h in
  h b - h a = dot g (spoke a b) /\ h c - h a = dot g (spoke a c) /\
  h c - h b = dot g (spoke b c) /\ h a - h b = dot g (spoke b a) /\
  h a - h c = dot g (spoke c a) /\ h b - h c = dot g (spoke c b).
Proof.
  intros Hf. cbn zeta. pose proof (oriented S _ _ _ Hf) as O.
  assert (N : cross (spoke a b) (spoke a c) <> 0) by (unfold Sheet.spoke; lra).
  unfold face_gradient.
  pose proof (gradient_left _ _ (h b - h a) (h c - h a) N) as L.
  pose proof (gradient_right _ _ (h b - h a) (h c - h a) N) as R.
  set (g := gradient _ _ _ _) in *. clearbody g. unfold Sheet.spoke in *.
  destruct g, (at_ a), (at_ b), (at_ c). coordinates. repeat split; lra.
Qed.

(** Theorem 1. *)
Theorem weighted_curvatures (c : point) (R2 : R) (w : vec) :
  (forall b, In b (rim S) -> w b = 0) ->
  sum (inner S) (fun v => multiplier S c R2 v * K S v w) =
  energy S w - sum (rim S) (fun b => multiplier S c R2 b * K S b w).
Proof.
  intros Z.
  set (k := fun v a b => wedge (spoke v a) (spoke v b) (w a - w v) (w b - w v)).
  set (r := fun v => dot (sub (at_ v) c) (sub (at_ v) c)).
  assert (All : sum (inner S ++ rim S) (fun v => multiplier S c R2 v * K S v w) = energy S w).
  { rewrite (sum_ext _ _ (fun v => sum (steps (fan S v)) (fun s => let '(a, b) := s in (R2 - r v) * k v a b))).
    2:{ intros v _. unfold K. rewrite <- sum_scal. apply sum_ext. intros [a b] _. reflexivity. }
    rewrite (sum_corners (fun v a b => (R2 - r v) * k v a b)), (sum_faces (fun v a b => (R2 - r v) * k v a b)).
    set (fl := fun a b => flux c (at_ a) (at_ b) (w b - w a)).
    assert (Fl : sum (faces S) (fun t => let '(a, b, c) := t in fl a b + fl b c + fl c a) = 0).
    { rewrite <- (sum_faces (fun a b _ => fl a b)).
      rewrite <- (sum_antisymmetric (sides (faces S)) fl).
      - unfold sides. rewrite sum_map. apply sum_ext. now intros [[a b] d] _.
      - apply sides_once.
      - intros a b. unfold fl. rewrite flux_reverse. do 2 f_equal. ring.
      - intros a b Hs. destruct (sides_paired S a b Hs) as [|[Ha Hb]]; [now left|right].
        unfold fl, flux. rewrite (Z a Ha), (Z b Hb). unfold Rdiv. ring. }
    assert (E : sum (faces S) (fun t => let '(a, b, c) := t in
        (R2 - r a) * k a b c + (R2 - r b) * k b c a + (R2 - r c) * k c a b) =
      sum (faces S) (fun t => area S t * dot (face_gradient S t w) (face_gradient S t w)
        + (let '(a, b, c) := t in fl a b + fl b c + fl c a))).
    { apply sum_ext. intros [[a b] d] Hf. pose proof (oriented S _ _ _ Hf) as O.
      destruct (gradient_differences a b d w Hf) as (E1 & E2 & E3 & E4 & E5 & E6).
      set (g := face_gradient S (a, b, d) w) in *.
      pose proof (face_sum _ _ _ g O) as F2. pose proof (face_moment c _ _ _ g O) as F3.
      unfold k, fl, r, area. unfold Sheet.spoke in *.
      rewrite E1, E2, E3, E4, E5, E6.
      set (ka := wedge _ _ (dot g (sub (at_ b) (at_ a))) _) in *.
      set (kb := wedge _ _ (dot g (sub (at_ d) (at_ b))) _) in *.
      set (kd := wedge _ _ (dot g (sub (at_ a) (at_ d))) _) in *.
      replace kd with (- ka - kb) in * by lra. lra. }
    rewrite E, sum_plus, Fl. unfold energy. ring. }
  rewrite sum_app in All. lra.
Qed.

End Identity.
