(** Near the flat sheet there are these ways to fold and no others (docs/motion.md, section 4): all true configurations
    lie on the motions that begin along the solutions of K_v = 0. *)
From Coq Require Import Reals ZArith List Lra Lia Arith Bool FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Nappes Sheet Identities Star KeyLemma Flat Complex Theorems Branches
  Drawing Integers Verify Exact Curve Flex Displacements Motion Near Gap
  Placed.
Import ListNotations.
Open Scope R_scope.

(** Heights that begin a motion, and the positions and heights along it. *)
Definition way := (vec * (R -> nat -> point) * (R -> vec))%type.
Definition heights_of (m : way) : vec := fst (fst m).

Lemma list_of_ways (l : list vec) (Q : way -> R -> Prop) : (forall m c c', Q m c -> c' <= c -> Q m c') ->
  (forall h, In h l -> exists P z c, 0 < c /\ Q (h, P, z) c) ->
  exists ms c, 0 < c /\ map heights_of ms = l /\ forall m, In m ms -> Q m c.
Proof.
  intros Mono. induction l as [|h l IH]; intros H.
  - exists [], 1. split; [lra|]. split; [reflexivity|easy].
  - destruct (H h (or_introl eq_refl)) as (P & z & c & Pc & Qc). destruct IH as (ms & c' & Pc' & E & Qs).
    { intros. apply H. now right. }
    exists ((h, P, z) :: ms), (Rmin c c'). split; [now apply Rmin_pos|]. split; [cbn; now rewrite E|].
    intros m [<-|Hm]; [apply (Mono _ c); [exact Qc|apply Rmin_l]|apply (Mono _ c'); [auto|apply Rmin_r]].
Qed.

Lemma smaller (P Q : R -> Prop) : (exists c, 0 < c /\ forall x, 0 < x <= c -> P x) ->
  (exists c, 0 < c /\ forall x, 0 < x <= c -> Q x) -> exists c, 0 < c /\ forall x, 0 < x <= c -> P x /\ Q x.
Proof.
  intros (c & Pc & Hc) (c' & Pc' & Hc'). exists (Rmin c c'). split; [now apply Rmin_pos|].
  intros x (Px & Hx). pose proof (Rmin_l c c'). pose proof (Rmin_r c c'). split; [apply Hc|apply Hc']; lra.
Qed.

(** If N^2 is at most t^2 times a number, N is at most t times another one. *)
Lemma square_root N t Q : 0 <= N -> 0 <= t -> 0 <= Q -> N * N <= t * t * Q -> N <= t * (Q + 1).
Proof.
  intros PN Pt PQ H. destruct (Rle_lt_dec N (t * (Q + 1))) as [|Lt]; [assumption|exfalso].
  assert (P : 0 <= t * (Q + 1)) by (apply Rmult_le_pos; lra).
  assert (t * (Q + 1) * (t * (Q + 1)) < N * N) by (apply Rmult_le_0_lt_compat; assumption).
  assert (0 <= t * t) by nra. assert (t * t * Q <= t * t * ((Q + 1) * (Q + 1))) by (apply Rmult_le_compat_l; nra). lra.
Qed.

Section Ways.
Variable S : sheet.
Notation at_ := (at_ S).
Notation I := (inner S).
Notation vertices := (inner S ++ rim S).
Notation F := (faces S).
Hypothesis Disk : disk S I F.
Variables p q : nat.
Hypothesis Hp : In p vertices.
Hypothesis Hq : In q vertices.
Hypothesis Apart : at_ p <> at_ q.
Notation held := (Displacements.held S p q).

(** Heights [r] of the boundary, over which no star is flat in any solution. *)
Variable r : vec.
Hypothesis Folded : forall h, has_rim S r h -> solves S (fun _ => 0) h -> forall v, In v I -> ~ flat_star S v h.

(** The heights of a configuration grow at most like those of its boundary. *)
Lemma heights_bounded : exists R0 C delta, 0 <= R0 /\ 0 <= C /\ 0 < delta /\ forall t P z,
  Rabs t <= delta -> true_lengths at_ F P z -> held P -> (forall v, In v (rim S) -> z v = t * r v) ->
  (forall v, In v vertices -> bounded delta (sub (P v) (at_ v)) /\ Rabs (z v) <= delta) ->
  (forall v, In v vertices -> Rabs (z v) <= R0 * Rabs t) /\
  (forall v, In v vertices -> bounded (C * (t * t)) (sub (P v) (at_ v))) /\
  sum I (fun v => Rabs (K S v z)) <= C * (t * t * (t * t)).
Proof.
  destruct (settled S Disk p q Hp Hq Apart) as (d1 & C1 & Pd1 & PC1 & Set1). destruct (grows S) as (eps & Pe & Gr).
  set (n := INR (length I)). assert (Pn : 0 <= n) by apply pos_INR.
  set (H := sum (rim S) (fun v => Rabs (r v))). assert (PH : 0 <= H) by (apply sum_nonneg; intros; apply Rabs_pos).
  set (r0 := rim_part S r).
  set (a := sum I (fun v => Rabs (K S v r0))).
  set (b := sum I (fun v => sum I (fun i => Rabs (K2 S v r0 (unit i))))).
  assert (Pa : 0 <= a) by (apply sum_nonneg; intros; apply Rabs_pos).
  assert (Pb : 0 <= b) by (apply sum_nonneg; intros; apply sum_nonneg; intros; apply Rabs_pos).
  assert (PnC : 0 <= n * C1) by now apply Rmult_le_pos.
  assert (PnH : 0 <= (n + H) * (n + H)) by (apply Rmult_le_pos; lra).
  destruct (small_factor (n * C1 * ((n + H) * (n + H))) (eps / 8)) as (d2 & Pd2 & Small); [now apply Rmult_le_pos|lra|].
  set (Q := 2 / eps * (eps / 4 * (H * H) + 4 / eps * (b * b) + a)).
  assert (PHH : 0 <= H * H) by now apply Rmult_le_pos. assert (Pbb : 0 <= b * b) by now apply Rmult_le_pos.
  assert (PQ0 : 0 <= eps / 4 * (H * H) + 4 / eps * (b * b) + a).
  { apply Rplus_le_le_0_compat; [|assumption]. apply Rplus_le_le_0_compat; apply Rmult_le_pos; try assumption; [lra|].
    apply Rlt_le, Rdiv_lt_0_compat; lra. }
  assert (PQ : 0 <= Q) by (apply Rmult_le_pos; [apply Rlt_le, Rdiv_lt_0_compat; lra|assumption]).
  set (R0 := Q + 1 + H). set (delta := Rmin 1 (Rmin d1 d2)).
  assert (Pd : 0 < delta) by (repeat apply Rmin_pos; lra).
  assert (D1 : delta <= 1) by apply Rmin_l.
  assert (D2 : delta <= d1) by (eapply Rle_trans; [apply Rmin_r|apply Rmin_l]).
  assert (D3 : delta <= d2) by (eapply Rle_trans; [apply Rmin_r|apply Rmin_r]). clearbody delta.
  assert (PR : 0 <= R0) by (unfold R0; lra). assert (PRR : 0 <= R0 * R0) by now apply Rmult_le_pos.
  assert (PCR : 0 <= C1 * (R0 * R0)) by now apply Rmult_le_pos.
  assert (PnR : 0 <= n * C1 * (R0 * R0 * (R0 * R0))) by (apply Rmult_le_pos; [|apply Rmult_le_pos]; assumption).
  exists R0, (C1 * (R0 * R0) + n * C1 * (R0 * R0 * (R0 * R0))), delta. split; [exact PR|]. split; [lra|].
  split; [exact Pd|]. intros t P z Ht True Held Rim Near. set (tau := Rabs t) in *.
  assert (Pt : 0 <= tau) by apply Rabs_pos.
  assert (Tt : tau * tau = t * t) by (unfold tau; rewrite <- Rabs_mult; apply Rabs_right; nra).
  set (w := fun v => if in_dec Nat.eq_dec v I then z v else 0).
  assert (Zw : zero_off I w) by (intros v Hv; unfold w; now destruct in_dec).
  set (N := norm I w). assert (PN : 0 <= N) by apply norm_nonneg.
  assert (Wz : forall v, In v I -> w v = z v) by (intros v Hv; unfold w; now destruct in_dec).
  assert (Nd : N <= n * delta).
  { apply sum_const_le. intros v Hv. rewrite (Wz v Hv). now apply Near, inner_vertex. }
  assert (Hr : forall v, In v (rim S) -> Rabs (r v) <= H)
    by (intros v Hv; apply (sum_ge_term (rim S) (fun v => Rabs (r v))); [intros; apply Rabs_pos|assumption]).
  set (zeta := N + tau * H). assert (PtH : 0 <= tau * H) by now apply Rmult_le_pos.
  assert (Zz : forall v, In v vertices -> Rabs (z v) <= zeta).
  { intros v Hv. apply in_app_or in Hv. destruct Hv as [Hv|Hv].
    - rewrite <- (Wz v Hv). pose proof (at_norm I w v Zw) as X. fold N in X. unfold zeta. lra.
    - rewrite (Rim v Hv). pose proof (product_bound t (r v) tau H (Rle_refl _) (Hr v Hv)). unfold zeta. lra. }
  destruct (Set1 P z zeta True Held) as (Bp & Bk).
  { intros v Hv. split; [|now apply Zz]. destruct (Near v Hv) as ((A & A') & _). split; lra. }
  assert (Pz : 0 <= zeta * zeta) by nra.
  assert (Sk : sum I (fun v => Rabs (K S v z)) <= n * (C1 * (zeta * zeta * (zeta * zeta)))) by now apply sum_const_le.
  (* the curvatures of [w] *)
  assert (Kw : sum I (fun v => Rabs (K S v w)) <= sum I (fun v => Rabs (K S v z)) + (2 * tau * (N * b) + t * t * a)).
  { unfold a, b. rewrite <- !sum_scal, <- !sum_plus. apply sum_le. intros v Hv.
    pose proof (inner_vertex S v Hv) as V.
    assert (E : K S v z = K S v (move w t r0)).
    { apply K_vertices; [exact Hv|]. intros u Hu. unfold move, w, r0, rim_part. destruct in_dec; [ring|].
      apply in_app_or in Hu. destruct Hu as [|Hu]; [contradiction|]. rewrite (Rim u Hu). ring. }
    rewrite E, K_move by assumption.
    assert (L : Rabs (K2 S v w r0) <= N * sum I (fun i => Rabs (K2 S v r0 (unit i)))).
    { rewrite K2_sym. apply linear_on_box; [intros x s y; apply K2_move|apply inner_once|exact Zw|].
      intros i Hi. exact (at_norm I w i Zw). }
    replace (K S v w) with ((K S v w + 2 * t * K2 S v w r0 + t * t * K S v r0) + - (2 * t * K2 S v w r0
      + t * t * K S v r0))
      at 1 by ring.
    eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp. apply Rplus_le_compat_l.
    eapply Rle_trans; [apply Rabs_triang|]. rewrite (Rabs_mult (t * t)), (Rabs_right (t * t)) by nra.
    apply Rplus_le_compat_r. rewrite !Rabs_mult, (Rabs_right 2) by lra. fold tau.
    apply Rmult_le_compat_l; [lra|exact L]. }
  pose proof (Gr w Zw) as G. fold N in G.
  assert (Z1 : n * C1 * (zeta * zeta) <= eps / 8).
  { apply Rle_trans with (n * C1 * ((n + H) * (n + H)) * delta); [|apply Small; lra].
    rewrite !Rmult_assoc. apply Rmult_le_compat_l; [assumption|]. apply Rmult_le_compat_l; [assumption|].
    assert (Zd : 0 <= zeta <= (n + H) * delta) by (unfold zeta; split; [lra|]; nra).
    assert (zeta * zeta <= (n + H) * delta * ((n + H) * delta)) by (apply Rmult_le_compat; lra).
    assert ((n + H) * (n + H) * (delta * delta) <= (n + H) * (n + H) * delta) by (apply Rmult_le_compat_l; nra). nra. }
  assert (Z2 : zeta * zeta <= 2 * (N * N) + 2 * (tau * tau * (H * H))).
  { unfold zeta. pose proof (Rle_0_sqr (N - tau * H)) as X. unfold Rsqr in X. nra. }
  assert (Z3 : n * (C1 * (zeta * zeta * (zeta * zeta))) <= eps / 8 * (2 * (N * N) + 2 * (tau * tau * (H * H)))).
  { replace (n * (C1 * (zeta * zeta * (zeta * zeta)))) with (n * C1 * (zeta * zeta) * (zeta * zeta)) by ring.
    apply Rmult_le_compat; try assumption. apply Rmult_le_pos; assumption. }
  assert (Z4 : 2 * tau * (N * b) <= eps / 4 * (N * N) + 4 / eps * (b * b) * (tau * tau)).
  { pose proof (Rle_0_sqr (eps * N - 4 * (b * tau))) as X. unfold Rsqr in X.
    apply (Rmult_le_reg_l (4 * eps)); [lra|]. field_simplify; [|lra]. nra. }
  assert (Nt : N <= tau * (Q + 1)).
  { apply square_root; try assumption. unfold Q. apply (Rmult_le_reg_l (eps / 2)); [lra|].
    replace (eps / 2 * (tau * tau * (2 / eps * (eps / 4 * (H * H) + 4 / eps * (b * b) + a)))) with
      (eps / 4 * (tau * tau * (H * H)) + 4 / eps * (b * b) * (tau * tau) + tau * tau * a) by (field; lra).
    rewrite <- Tt in Kw. lra. }
  assert (Zt : 0 <= zeta <= R0 * tau) by (unfold zeta, R0; split; lra).
  assert (Zq : zeta * zeta <= R0 * R0 * (t * t)).
  { rewrite <- Tt. replace (R0 * R0 * (tau * tau)) with (R0 * tau * (R0 * tau)) by ring. apply Rmult_le_compat; lra. }
  split; [|split].
  - intros v Hv. eapply Rle_trans; [now apply Zz|]. lra.
  - intros v Hv. destruct (Bp v Hv) as (A & A').
    assert (C1 * (zeta * zeta) <= C1 * (R0 * R0 * (t * t))) by now apply Rmult_le_compat_l.
    assert (0 <= n * C1 * (R0 * R0 * (R0 * R0)) * (t * t)) by (apply Rmult_le_pos; [assumption|nra]). split; lra.
  - eapply Rle_trans; [exact Sk|].
    assert (Y : zeta * zeta * (zeta * zeta) <= R0 * R0 * (t * t) * (R0 * R0 * (t * t)))
      by (apply Rmult_le_compat; assumption).
    apply Rle_trans with (n * C1 * (R0 * R0 * (t * t) * (R0 * R0 * (t * t)))).
    + rewrite <- Rmult_assoc. now apply Rmult_le_compat_l.
    + assert (0 <= C1 * (R0 * R0) * (t * t * (t * t))) by (apply Rmult_le_pos; [assumption|nra]). lra.
Qed.

(** Each solution begins a true motion, and all true configurations near the flat sheet with a boundary at the heights
    t r are on these motions. *)
Theorem ways : exists ms delta, 0 < delta /\
  length ms = (2 ^ length I)%nat /\ NoDup (map heights_of ms) /\
  (forall h, In h (map heights_of ms) <-> has_rim S r h /\ solves S (fun _ => 0) h) /\
  (forall h P z, In (h, P, z) ms -> exists t1 d C, delta <= t1 /\ true_motion S I vertices F p q h t1 d C P z) /\
  forall t P z, Rabs t <= delta -> true_lengths at_ F P z -> held P -> (forall v, In v (rim S) -> z v = t * r v) ->
    (forall v, In v vertices -> bounded delta (sub (P v) (at_ v)) /\ Rabs (z v) <= delta) ->
    exists h P' z', In (h, P', z') ms /\ forall v, In v vertices -> P v = P' t v /\ z v = z' t v.
Proof.
  destruct (list_of_solutions S (fun _ => 0) r) as (l & Len & Sol & Once); [intros; lra|].
  assert (Reg : forall h, has_rim S r h -> solves S (fun _ => 0) h -> regular S h).
  { intros h Hr Hs v Hv. right. split; [now apply Hs|now apply Folded]. }
  specialize (Once Reg).
  destruct (list_of_ways l (fun m c => exists t1 d C, c <= t1 /\ c <= d /\
    true_motion S I vertices F p q (heights_of m) t1 d C (snd (fst m)) (snd m))) as (ms & c0 & Pc0 & Ms & Mo).
  { intros m c c' (t1 & d & C & A & B & M) Le. exists t1, d, C. split; [lra|]. split; [lra|exact M]. }
  { intros h Hh. apply Sol in Hh. destruct Hh as (Hr & Hs).
    destruct (true_motion_exists S Disk p q Hp Hq Apart h Hs (jacobian_nonsingular S h (Reg h Hr Hs)))
      as (t1 & d & C & P & z & M). exists P, z, (Rmin t1 d). destruct M as (M1 & M2 & M). split; [now apply Rmin_pos|].
    exists t1, d, C. split; [apply Rmin_l|]. split; [apply Rmin_r|]. cbn. split; [exact M1|].
    split; [exact M2|exact M]. }
  destruct heights_bounded as (R0 & C1 & d1 & PR & PC & Pd1 & Hb).
  destruct (gap S r R0 PR l c0 Pc0) as (eps & Pe & Gap). { intros g Rg Sg. now apply Sol. }
  destruct (small_factor C1 (eps / 2)) as (d2 & Pd2 & Small); [assumption|lra|].
  set (delta := Rmin (Rmin 1 c0) (Rmin d1 d2)).
  assert (Pd : 0 < delta) by (repeat apply Rmin_pos; lra).
  assert (D0 : delta <= 1) by (eapply Rle_trans; [apply Rmin_l|apply Rmin_l]).
  assert (D1 : delta <= c0) by (eapply Rle_trans; [apply Rmin_l|apply Rmin_r]).
  assert (D2 : delta <= d1) by (eapply Rle_trans; [apply Rmin_r|apply Rmin_l]).
  assert (D3 : delta <= d2) by (eapply Rle_trans; [apply Rmin_r|apply Rmin_r]). clearbody delta.
  exists ms, delta. split; [exact Pd|]. split; [now rewrite <- Len, <- Ms, map_length|]. rewrite Ms.
  split; [exact Once|]. split; [exact Sol|]. split.
  { intros h P z Hm. destruct (Mo _ Hm) as (t1 & d & C & A & _ & M). exists t1, d, C. split; [lra|exact M]. }
  intros t P z Ht True Held Rim Near.
  destruct (Hb t P z) as (Bz & Bp & Bk); [lra|exact True|exact Held|exact Rim| |].
  { intros v Hv. destruct (Near v Hv) as ((A & A') & B). repeat split; lra. }
  destruct (Req_dec t 0) as [T0|Nt].
  - (* the flat sheet is on all of them *)
    destruct ms as [|[[h P'] z'] ms].
    { exfalso. cbn in Ms. rewrite <- Ms in Len. cbn in Len. pose proof (Nat.pow_nonzero 2 (length I)). lia. }
    exists h, P', z'. split; [now left|]. destruct (Mo _ (or_introl eq_refl)) as (t1 & d & C & A & _ & M).
    cbn [heights_of fst snd] in M. destruct M as (M1 & _ & _ & M & _).
    destruct (M t) as (_ & _ & _ & At); [lra|]. intros v Hv. destruct (At v) as ((X & Y) & Z).
    specialize (Bz v Hv). destruct (Bp v Hv) as (X' & Y'). subst t.
    rewrite Rabs_R0 in Bz, Z. rewrite !Rmult_0_r in *. rewrite Rmult_0_l in Z. apply abs_le in X, Y, X', Y', Z, Bz.
    unfold sub in *. cbn [fst snd] in *. destruct (P v), (P' 0 v), (at_ v). cbn [fst snd] in *.
    split; [f_equal; lra|lra].
  - set (g := fun v => if in_dec Nat.eq_dec v I then z v / t else r v).
    assert (Pt : 0 < Rabs t) by now apply Rabs_pos_lt.
    assert (Rg : has_rim S r g) by (intros v Hv; unfold g; now destruct in_dec).
    assert (Gz : forall v, In v vertices -> z v = t * g v).
    { intros v Hv. unfold g. destruct in_dec; [field; exact Nt|]. apply in_app_or in Hv.
      destruct Hv as [|Hv]; [contradiction|auto]. }
    assert (Bg : forall v, In v I -> Rabs (g v) <= R0).
    { intros v Hv. pose proof (inner_vertex S v Hv) as V. specialize (Bz v V). rewrite (Gz v V), Rabs_mult in Bz.
      apply (Rmult_le_reg_l (Rabs t)); lra. }
    assert (Kg : forall v, In v I -> K S v z = t * t * K S v g).
    { intros v Hv. pose proof (inner_vertex S v Hv) as V.
      rewrite (K_vertices S v z (move zero t g))
        by (try assumption; intros u Hu; rewrite (Gz u Hu); unfold move, zero; ring).
      rewrite K_move, (K2_sym S v zero), <- (K_polar_sheet S v zero V) by assumption.
      rewrite (linear_zero (K2 S v g)), (linear_zero (K2 S v zero)) by (intros a s b; apply K2_move). ring. }
    assert (Ptt : 0 < t * t) by nra.
    assert (Sg : sum I (fun v => Rabs (K S v g)) < eps).
    { rewrite (sum_ext I _ (fun v => t * t * Rabs (K S v g))) in Bk
        by (intros v Hv; rewrite (Kg v Hv), Rabs_mult, (Rabs_right (t * t)); [reflexivity|lra]).
      rewrite sum_scal in Bk.
      assert (B : sum I (fun v => Rabs (K S v g)) <= C1 * (t * t)) by (apply (Rmult_le_reg_l (t * t)); lra).
      assert (t * t <= d2).
      { replace (t * t) with (Rabs t * Rabs t) by (rewrite <- Rabs_mult; apply Rabs_right; lra).
        apply Rle_trans with (Rabs t * 1); [|lra]. apply Rmult_le_compat_l; lra. }
      pose proof (Small (t * t)). lra. }
    destruct (Gap g Rg Bg Sg) as (h & Hh & Nh). rewrite <- Ms in Hh. apply in_map_iff in Hh.
    destruct Hh as ([[h' P'] z'] & E & Hm). cbn in E. subst h'. exists h, P', z'. split; [exact Hm|].
    destruct (Mo _ Hm) as (t1 & d & C & A & A' & M). cbn [heights_of fst snd] in M.
    destruct M as (_ & _ & _ & _ & _ & Only).
    assert (Hh : has_rim S r h) by (apply Sol; rewrite <- Ms; apply in_map_iff; now exists (h, P', z')).
    apply (Only t P z); try assumption; [lra| | |].
    + intros v Hv Ni. apply in_app_or in Hv. destruct Hv as [|Hv]; [contradiction|]. rewrite (Hh v Ni). auto.
    + intros v Hv. destruct (Near v Hv) as ((X & Y) & _). split; lra.
    + intros v Hv. rewrite (Gz v) by now apply inner_vertex. rewrite <- Rmult_minus_distr_l, Rabs_mult, Rmult_comm.
      apply Rmult_le_compat_r; [lra|].
      pose proof (sum_ge_term I (fun i => Rabs (minus g h i)) v (fun i _ => Rabs_pos _) Hv) as X.
      fold (norm I (minus g h)) in X. unfold minus in X at 1. lra.
Qed.
End Ways.

(** Four boundary vertices: there are 2^n motions, which begin along the branches, such that every true configuration
    near the flat sheet, moved in space, is on one of them. *)
Definition these_ways_only S b1 b2 b4 : Prop := let vertices := inner S ++ rim S in
  exists ms t0 delta, 0 < t0 /\ 0 < delta /\ length ms = (2 ^ length (inner S))%nat /\ NoDup (map heights_of ms) /\
    (forall h, In h (map heights_of ms) <-> representative S b4 h) /\
    (forall h P z, In (h, P, z) ms -> exists t1 d C, t0 <= t1 /\
      true_motion S (inner S) vertices (faces S) b1 b2 h t1 d C P z) /\
    forall c, true_lengths (at_ S) (faces S) (fst c) (snd c) -> near (at_ S) vertices delta c ->
      exists h P z t, In (h, P, z) ms /\ Rabs t <= t0 /\ same_distances vertices c (P t, z t).

Theorem near_flat S b1 b2 b3 b4 : rim S = [b1; b2; b3; b4] ->
  cross (sub (at_ S b2) (at_ S b1)) (sub (at_ S b3) (at_ S b1)) <> 0 -> disk S (inner S) (faces S) ->
  (forall h, representative S b4 h -> forall v, In v (inner S) -> ~ flat_star S v h) -> these_ways_only S b1 b2 b4.
Proof.
  intros Rim Cor Disk NF.
  assert (On : forall b, In b [b1; b2; b3; b4] -> In b (inner S ++ rim S)).
  { intros b Hb. apply in_or_app. right. now rewrite Rim. }
  assert (Apart : at_ S b1 <> at_ S b2).
  { intros E. apply Cor. rewrite E. unfold cross, sub. cbn [fst snd]. ring. }
  destruct (ways S Disk b1 b2) with (r := unit b4) as (ms & t0 & Pt & Len & Once & Sol & Mo & All).
  { apply On. now left. } { apply On. right. now left. } { exact Apart. }
  { intros h Hr Hs. apply NF. now split. }
  destruct (placing (at_ S) (inner S ++ rim S) b1 b2 b3) with (eps := t0) as (delta & Pd & Place);
    try assumption; try (apply On; simpl; tauto).
  exists ms, t0, delta. split; [exact Pt|]. split; [exact Pd|]. split; [exact Len|]. split; [exact Once|].
  split; [exact Sol|]. split; [exact Mo|]. intros c True Near.
  destruct (Place c Near) as (Same & Near' & H1 & H2 & Z1 & Z2 & Z3). set (c' := placed (at_ S) b1 b2 b3 c) in *.
  destruct (All (snd c' b4) (fst c') (snd c')) as (h & P & z & Hm & E).
  - apply Near', On. simpl. tauto.
  - intros a b Hab. rewrite <- (True a b Hab).
    assert (V : In a (inner S ++ rim S) /\ In b (inner S ++ rim S)).
    { destruct (gluing S Disk) as (_ & vs & fs & G & Sd & Vs). apply Sd in Hab.
      destruct (glued_on S _ vs fs G a b Hab). split; now apply Vs. }
    destruct V as (Ha & Hb). specialize (Same a b Ha Hb). unfold dot3, sub3, position in Same. unfold dot.
    cbn [fst snd] in *. lra.
  - now split.
  - destruct (unit_rim S b1 b2 b3 b4 Rim Cor) as (U1 & U2 & U3 & U4). intros v Hv.
    rewrite Rim in Hv. destruct Hv as [<-|[<-|[<-|[<-|[]]]]]; rewrite ?U1, ?U2, ?U3, ?U4, ?Z1, ?Z2, ?Z3; ring.
  - exact Near'.
  - exists h, P, z, (snd c' b4). split; [exact Hm|]. split; [apply Near', On; simpl; tauto|].
    intros u v Hu Hv. rewrite (Same u v Hu Hv). unfold position. cbn [fst snd].
    destruct (E u Hu) as (-> & ->). now destruct (E v Hv) as (-> & ->).
Qed.

(** What the program accepts as a file of all branches, and as a disk. *)
Theorem all_continue d p top given asked ms : verify_all d p top given asked = true ->
  moves_as_a_disk d (inside d) (triangles d) ms = true ->
  exists (ok : check d = true) b1 b2 b3 b4, border d = [b1; b2; b3; b4] /\ these_ways_only (sheet_of d ok) b1 b2 b4.
Proof.
  intros V M.
  destruct (all_verified d p top given asked V) as (ok & b1 & b2 & b3 & b4 & Rim & l & _ & _ & Rep & Non & _).
  exists ok, b1, b2, b3, b4. split; [exact Rim|]. unfold moves_as_a_disk in M. apply andb_prop in M.
  apply (near_flat _ b1 b2 b3 b4); [exact Rim| |exact (disk_checked d (inside d) ok (triangles d) ms (proj2 M))|].
  - unfold verify_all in V. rewrite Rim, !andb_true_iff, negb_true_iff, Z.eqb_neq in V. destruct V as ((_ & N) & _).
    change (cross (sub (at_R d b2) (at_R d b1)) (sub (at_R d b3) (at_R d b1)) <> 0). rewrite cross_IZR.
    intros E. apply N. now apply eq_IZR.
  - intros h Hh v Hv Fl. exact (jacobian_singular _ h v Hv Fl (Non h (proj2 (Rep h) Hh))).
Qed.

(** What the program accepts as a file of one branch with signs at all vertices, and as a disk. *)
Theorem one_continues d p up h asked ms : verify_one d p up h asked = true -> forallb (is_bent asked) (hubs p) = true ->
  moves_as_a_disk d (inside d) (triangles d) ms = true ->
  exists ok : check d = true, let S := sheet_of d ok in let vertices := inner S ++ rim S in
  exists g, has_rim S (reals h) g /\ solves S (fun _ => 0) g /\ in_nappes S up g /\
    forall b1 b2, In b1 vertices -> In b2 vertices -> at_ S b1 <> at_ S b2 ->
      exists t1 delta C P z, true_motion S (inner S) vertices (faces S) b1 b2 g t1 delta C P z.
Proof.
  unfold verify_one. rewrite andb_true_iff, forallb_forall. intros (So & Pass) Bent M.
  destruct (sound_means d p So) as (ok & Hubs & H). destruct (H _ _ _ _ Pass) as (_ & g & Gr & Gs & Gn & Sg & _).
  unfold moves_as_a_disk in M. apply andb_prop in M. exists ok. cbv zeta. exists g.
  split; [exact Gr|]. split; [exact Gs|]. split; [exact Gn|]. intros b1 b2 H1 H2 Apart.
  apply true_motion_exists; try assumption; [exact (disk_checked d (inside d) ok (triangles d) ms (proj2 M))|].
  apply jacobian_nonsingular. intros v Hv. right. split; [now apply Gs|]. intros Fl.
  assert (Hin : In v (map at_vertex (hubs p))) by (rewrite <- Hubs; exact Hv).
  apply in_map_iff in Hin. destruct Hin as (b & <- & Hb). specialize (Sg b Hb (Bent b Hb)).
  rewrite K2_sym, (flat_null _ _ g Hv Fl) in Sg. lra.
Qed.

(** The same of heights that solve the equations exactly. *)
Theorem exact_continues d p claimed h letters ms : verify_exact d p (fun _ => false) claimed h letters = true ->
  forallb (fun v => match claimed v with Some _ => true | None => false end) (inside d) = true ->
  moves_as_a_disk d (inside d) (triangles d) ms = true ->
  exists ok : check d = true, let S := sheet_of d ok in let vertices := inner S ++ rim S in
  forall b1 b2, In b1 vertices -> In b2 vertices -> at_ S b1 <> at_ S b2 ->
    exists t1 delta C P z, true_motion S (inner S) vertices (faces S) b1 b2 (reals h) t1 delta C P z.
Proof.
  rewrite forallb_forall. intros V Bent M. destruct (exact_verified _ _ _ _ _ _ V) as (ok & Gs & Sg & _).
  unfold moves_as_a_disk in M. apply andb_prop in M. exists ok. cbv zeta. intros b1 b2 H1 H2 Apart.
  apply true_motion_exists; try assumption; [exact (disk_checked d (inside d) ok (triangles d) ms (proj2 M))|].
  apply jacobian_nonsingular. intros v Hv. right. split; [now apply Gs|]. intros Fl.
  specialize (Bent v Hv). destruct (claimed v) as [e|] eqn:E; [|discriminate]. specialize (Sg v e Hv E).
  rewrite K2_sym, (flat_null _ _ (reals h) Hv Fl) in Sg. lra.
Qed.
