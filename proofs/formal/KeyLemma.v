(** The key lemma: with the heights of the rim at 0, curvatures that are all <= 0 are those of the
    flat sheet. *)
From Coq Require Import Reals List Permutation Lra Lia Arith FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Nappes Sheet Identities Star.
Import ListNotations.
Open Scope R_scope.

Section Key.
Variable S : sheet.
Notation at_ := (at_ S).
Notation spoke := (spoke at_).
Notation vertices := (inner S ++ rim S).

Lemma inner_vertex v : In v (inner S) -> In v vertices.
Proof. intros. apply in_or_app. now left. Qed.

Lemma rim_not_inner b : In b (rim S) -> ~ In b (inner S).
Proof.
  intros Hb Hi. pose proof (vertices_once S) as D. revert Hi.
  induction (inner S) as [|v l IH]; [easy|]. cbn [app] in D. inversion D as [|? ? N D']; subst.
  intros [->|Hl]; [apply N, in_or_app; now right|]. now apply IH.
Qed.

Lemma zero_on_rim w : zero_off (inner S) w -> forall b, In b (rim S) -> w b = 0.
Proof. intros Z b Hb. apply Z. now apply rim_not_inner. Qed.

Lemma area_pos f : In f (faces S) -> 0 < area S f.
Proof.
  destruct f as [[a b] c]. intros Hf. pose proof (oriented S a b c Hf). unfold area, Sheet.spoke. lra.
Qed.

Lemma energy_pos w : 0 <= energy S w.
Proof.
  apply sum_nonneg. intros f Hf. apply Rmult_le_pos; [now apply Rlt_le, area_pos|apply dot_pos].
Qed.

(** Without energy the sides of the faces are level. *)
Lemma level w : energy S w <= 0 -> forall v a b, In (v, a, b) (corners (faces S)) -> w a = w v.
Proof.
  intros E v a b Hc. unfold corners in Hc. rewrite in_flat_map in Hc.
  destruct Hc as ([[x y] z] & Hf & Hc).
  assert (Z := sum_nonneg_null (faces S) (fun f => area S f * dot (face_gradient S f w) (face_gradient S f w))
    (fun f Hf => Rmult_le_pos _ _ (Rlt_le _ _ (area_pos f Hf)) (dot_pos _)) E _ Hf). cbv beta in Z.
  apply Rmult_integral in Z. destruct Z as [Z|Z]; [pose proof (area_pos _ Hf); lra|].
  apply dot_zero in Z. destruct (gradient_differences S x y z w Hf) as (E1 & E2 & E3 & E4 & E5 & E6).
  rewrite Z in *. unfold dot in *. cbn [fst snd] in *.
  simpl in Hc. destruct Hc as [E0|[E0|[E0|[]]]]; injection E0 as <- <- <-; lra.
Qed.

(** A full star has a spoke to the right, or straight up. *)
Lemma spoke_beyond v : In v (inner S) -> exists a b, In (a, b) (steps (fan S v)) /\
  (0 < fst (spoke v a) \/ (fst (spoke v a) = 0 /\ 0 < snd (spoke v a))).
Proof.
  intros Hi. destruct (inner_full S v Hi) as (u & up & p & q & down & F & Up & Q & _).
  assert (Left := fun a b => step_left S v a b (inner_vertex v Hi)). rewrite F in *.
  assert (Hpq : In (p, q) (steps (u :: up ++ p :: q :: down ++ [u]))).
  { change (u :: up ++ p :: q :: down ++ [u]) with ((u :: up) ++ p :: q :: down ++ [u]).
    rewrite steps_split. apply in_or_app. right. now left. }
  assert (Hu : exists b, In (u, b) (steps (u :: up ++ p :: q :: down ++ [u]))).
  { destruct up as [|z up]; [exists p|exists z]; now left. }
  assert (Hq : exists b, In (q, b) (steps (u :: up ++ p :: q :: down ++ [u]))).
  { replace (u :: up ++ p :: q :: down ++ [u]) with ((u :: up ++ [p]) ++ q :: down ++ [u])
      by (cbn [app]; now rewrite <- app_assoc).
    rewrite steps_split. destruct down as [|z down]; [exists u|exists z]; apply in_or_app; right; now left. }
  destruct Hu as (bu & Hu), Hq as (bq & Hq).
  pose proof (Left _ _ Hpq) as C. pose proof (Up p ltac:(apply in_or_app; right; now left)) as P.
  pose proof (Left _ _ Hu) as Cu. pose proof (Left _ _ Hq) as Cq.
  set (beyond := fun a => 0 < fst (spoke v a) \/ (fst (spoke v a) = 0 /\ 0 < snd (spoke v a))).
  assert (Dec : forall a, beyond a \/ (fst (spoke v a) < 0 \/ (fst (spoke v a) = 0 /\ snd (spoke v a) <= 0))).
  { intros a. unfold beyond. destruct (Rtotal_order (fst (spoke v a)) 0) as [|[|]]; [tauto| |tauto].
    destruct (Rle_lt_dec (snd (spoke v a)) 0); tauto. }
  destruct (Dec u) as [|Du]; [eauto|]. destruct (Dec q) as [|Dq]; [eauto|].
  destruct (Dec p) as [|Dp]; [eauto|]. exfalso. clear Dec beyond Hu Hq Hpq.
  assert (Cup : cross (spoke v u) (spoke v p) > 0) by exact P. clear P Up Left F.
  assert (E : forall c : point -> R, c = fst \/ c = snd ->
    c (spoke v u) * cross (spoke v p) (spoke v q) + c (spoke v p) * - cross (spoke v u) (spoke v q)
    + c (spoke v q) * cross (spoke v u) (spoke v p) = 0).
  { intros c [->| ->]; unfold cross; ring. }
  pose proof (E fst (or_introl eq_refl)) as Ex. pose proof (E snd (or_intror eq_refl)) as Ey. clear E.
  assert (Nu : spoke v u <> (0, 0)) by (intros Z; rewrite Z in Cu; unfold cross in Cu; cbn in Cu; lra).
  assert (Nq : spoke v q <> (0, 0)) by (intros Z; rewrite Z in Cq; unfold cross in Cq; cbn in Cq; lra).
  set (cpq := cross (spoke v p) (spoke v q)) in *. set (cup := cross (spoke v u) (spoke v p)) in *.
  set (cuq := cross (spoke v u) (spoke v q)) in *.
  assert (Neg : forall x c, x <= 0 -> 0 <= c -> x * c <= 0).
  { intros x c Hx Hc. pose proof (Rmult_le_pos (- x) c). lra. }
  assert (Neg' : forall x c, x < 0 -> 0 < c -> x * c < 0).
  { intros x c Hx Hc. pose proof (Rmult_lt_0_compat (- x) c). lra. }
  pose proof (Neg (fst (spoke v p)) (- cuq)) as Np.
  pose proof (Neg (fst (spoke v u)) cpq). pose proof (Neg (fst (spoke v q)) cup).
  assert (Xu : fst (spoke v u) = 0).
  { destruct Du as [Du|Du]; [|tauto]. pose proof (Neg' _ cpq Du C). lra. }
  assert (Xq : fst (spoke v q) = 0).
  { destruct Dq as [Dq|Dq]; [|tauto]. pose proof (Neg' _ cup Dq Cup). lra. }
  assert (Yu : snd (spoke v u) < 0).
  { destruct Du as [|[_ [Y|Y]]]; [lra|assumption|]. exfalso. apply Nu.
    destruct (spoke v u); cbn in *. now subst. }
  assert (Yq : snd (spoke v q) < 0).
  { destruct Dq as [|[_ [Y|Y]]]; [lra|assumption|]. exfalso. apply Nq.
    destruct (spoke v q); cbn in *. now subst. }
  pose proof (Neg' _ _ Yu C). pose proof (Neg' _ _ Yq Cup).
  assert (Cuq : cuq = 0) by (unfold cuq, cross; rewrite Xu, Xq; ring). rewrite Cuq in Ey. lra.
Qed.

(** A sheet without energy whose rim has height 0 is flat: otherwise look at the rightmost vertex
    that is not at height 0 (of several, the uppermost). *)
Lemma energy_definite w : zero_off (inner S) w -> energy S w <= 0 -> w = zero.
Proof.
  intros Z E. apply functional_extensionality. intros v0.
  destruct (Req_dec (w v0) 0) as [|N0]; [assumption|exfalso].
  set (up := fun v => if Req_EM_T (w v) 0 then false else true).
  assert (Up : forall v, In v (filter up (inner S)) <-> In v (inner S) /\ w v <> 0).
  { intros v. rewrite filter_In. unfold up. destruct Req_EM_T; intuition congruence. }
  assert (I0 : In v0 (inner S)).
  { destruct (in_dec Nat.eq_dec v0 (inner S)) as [|H]; [assumption|]. now specialize (Z v0 H). }
  destruct (arg_max (filter up (inner S)) (fun v => fst (at_ v))) as (v1 & H1 & M1).
  { intros H. assert (I1 : In v0 (filter up (inner S))) by now apply Up. now rewrite H in I1. }
  set (best := fun v => if Req_EM_T (fst (at_ v)) (fst (at_ v1)) then true else false).
  assert (Best : forall v, In v (filter best (filter up (inner S))) <->
    (In v (inner S) /\ w v <> 0) /\ fst (at_ v) = fst (at_ v1)).
  { intros v. rewrite filter_In, Up. unfold best. destruct Req_EM_T; intuition congruence. }
  destruct (arg_max (filter best (filter up (inner S))) (fun v => snd (at_ v))) as (v & Hv & M).
  { intros H. assert (I1 : In v1 (filter best (filter up (inner S)))) by (apply Best; apply Up in H1; tauto).
    now rewrite H in I1. }
  apply Best in Hv. destruct Hv as ((Hi & Nv) & Xv).
  destruct (spoke_beyond v Hi) as (a & b & Hs & Beyond).
  pose proof (step_corner S v a b (inner_vertex v Hi) Hs) as Hc.
  pose proof (level w E v a b Hc) as La.
  assert (Na : w a <> 0) by lra.
  assert (Ia : In a (inner S)).
  { destruct (in_dec Nat.eq_dec a (inner S)) as [|H]; [assumption|]. now specialize (Z a H). }
  pose proof (M1 a (proj2 (Up a) (conj Ia Na))) as Ma.
  unfold Sheet.spoke, sub in Beyond. cbn [fst snd] in Beyond.
  destruct Beyond as [B|(B & B')]; [lra|].
  assert (Ha : In a (filter best (filter up (inner S)))) by (apply Best; repeat split; auto; lra).
  specialize (M a Ha). cbv beta in M. lra.
Qed.

(** The key lemma, with the multipliers of a disk. *)
Theorem key_energy c R2 w : (forall b, In b (rim S) -> 0 <= multiplier S c R2 b) ->
  zero_off (inner S) w ->
  energy S w <= sum (inner S) (fun v => multiplier S c R2 v * K S v w).
Proof.
  intros Pm Z. pose proof (zero_on_rim w Z) as Zr.
  rewrite (weighted_curvatures S c R2 w Zr).
  assert (sum (rim S) (fun b => multiplier S c R2 b * K S b w) <= 0); [|lra].
  apply sum_nonpos. intros b Hb. pose proof (wirtinger S b w Hb Zr). specialize (Pm b Hb).
  pose proof (Rmult_le_pos (multiplier S c R2 b) (- K S b w)). lra.
Qed.

(** There is a disk that contains the sheet. *)
Lemma disk c : exists R2, forall v, In v vertices -> 0 < multiplier S c R2 v.
Proof.
  exists (sum vertices (fun v => dot (sub (at_ v) c) (sub (at_ v) c)) + 1). intros v Hv. unfold multiplier.
  pose proof (sum_ge_term vertices (fun v => dot (sub (at_ v) c) (sub (at_ v) c)) v
    (fun v _ => dot_pos _) Hv) as H. cbv beta in H. lra.
Qed.

Theorem key_lemma w : zero_off (inner S) w -> (forall v, In v (inner S) -> K S v w <= 0) -> w = zero.
Proof.
  intros Z N. destruct (disk (0, 0)) as (R2 & Pm). apply energy_definite; [assumption|].
  eapply Rle_trans; [apply (key_energy (0, 0) R2 w); [|assumption]|].
  - intros b Hb. apply Rlt_le, Pm, in_or_app. now right.
  - apply sum_nonpos. intros v Hv. specialize (N v Hv). specialize (Pm v (inner_vertex v Hv)).
    pose proof (Rmult_le_pos (multiplier S (0, 0) R2 v) (- K S v w)). lra.
Qed.

End Key.
