(** Sheets with three and with four boundary vertices (docs/theorem.md, section 4). *)
From Coq Require Import Reals List Permutation Lra Lia Arith FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Nappes Sheet Identities Star KeyLemma Flat Complex Theorems.
Import ListNotations.
Open Scope R_scope.

Section Branches.
Variable S : sheet.
Notation at_ := (at_ S).
Notation I := (inner S).
Notation n := (length (inner S)).
Notation vertices := (inner S ++ rim S).

(** The curvature depends on the heights of the sheet's vertices only. *)
Lemma fan_vertices v u : In v I -> In u (fan S v) -> In u vertices.
Proof.
  intros Hi Hu.
  assert (St : exists a b, In (a, b) (steps (fan S v)) /\ (u = a \/ u = b)).
  { destruct (inner_full S v Hi) as (f & up & p & q & down & F & _).
    assert (F' : exists a b l, fan S v = a :: b :: l).
    { rewrite F. destruct up as [|a up]; simpl; eauto. }
    destruct F' as (a & b & l & F'). rewrite F' in *. clear F F'.
    revert a b Hu. induction l as [|c l IH]; intros a b Hu.
    - simpl in *. exists a, b. split; [auto|]. intuition.
    - destruct Hu as [->|Hu].
      + exists u, b. split; [now left|now left].
      + destruct (IH b c Hu) as (x & y & Hs & E). exists x, y. split; [now right|assumption]. }
  destruct St as (a & b & Hs & E). apply (step_corner S v a b (inner_vertex S v Hi)) in Hs.
  assert (H : In (a, b, v) (corners (faces S)) /\ In (b, v, a) (corners (faces S))).
  { unfold corners in *. rewrite in_flat_map in Hs. destruct Hs as ([[x y] z] & Hf & Hc).
    rewrite !in_flat_map. simpl in Hc.
    destruct Hc as [E0|[E0|[E0|[]]]]; injection E0 as <- <- <-;
      split; exists (x, y, z); (split; [assumption|simpl; tauto]). }
  destruct H as (Ha & Hb). destruct E as [->| ->]; eapply faces_on_vertices; eassumption.
Qed.

Lemma K2_vertices v a a' b b' : In v I -> (forall u, In u vertices -> a u = a' u) ->
  (forall u, In u vertices -> b u = b' u) -> K2 S v a b = K2 S v a' b'.
Proof.
  intros Hi A B. rewrite (fan_values S v a a' b), K2_sym, (fan_values S v b b' a'), K2_sym; [reflexivity| |];
    intros u Hu; rewrite ?A, ?B; try reflexivity; try (now apply inner_vertex); now apply (fan_vertices v).
Qed.

Lemma K_vertices v a a' : In v I -> (forall u, In u vertices -> a u = a' u) -> K S v a = K S v a'.
Proof.
  intros Hi A. rewrite <- !K_polar_sheet by now apply inner_vertex. now apply K2_vertices.
Qed.

Lemma K2_combine v c a b r s : K2 S v c (fun u => r * a u + s * b u) = r * K2 S v c a + s * K2 S v c b.
Proof.
  replace (fun u => r * a u + s * b u) with (move (move zero r a) s b) by vec.
  rewrite !K2_move, (linear_zero (K2 S v c)) by (intros x t y; apply K2_move). ring.
Qed.

Lemma K2_combine2 v a b p q r s : In v I ->
  K2 S v (fun u => p * a u + q * b u) (fun u => r * a u + s * b u) =
  p * r * K S v a + (p * s + q * r) * K2 S v a b + q * s * K S v b.
Proof.
  intros Hi. rewrite K2_combine, (K2_sym S v _ a), (K2_sym S v _ b), !K2_combine, (K2_sym S v b a).
  rewrite !K_polar_sheet by now apply inner_vertex. ring.
Qed.

(** A plane through three heights. *)
Lemma interpolate b1 b2 b3 (h : vec) : cross (sub (at_ b2) (at_ b1)) (sub (at_ b3) (at_ b1)) <> 0 ->
  exists c g, affine S c g b1 = h b1 /\ affine S c g b2 = h b2 /\ affine S c g b3 = h b3.
Proof.
  intros N. set (g := gradient (sub (at_ b2) (at_ b1)) (sub (at_ b3) (at_ b1)) (h b2 - h b1) (h b3 - h b1)).
  exists (h b1 - dot g (at_ b1)), g.
  pose proof (gradient_left _ _ (h b2 - h b1) (h b3 - h b1) N) as L.
  pose proof (gradient_right _ _ (h b2 - h b1) (h b3 - h b1) N) as R. fold g in L, R.
  clearbody g. unfold affine. unfold dot, sub in *. cbn [fst snd] in *. repeat split; lra.
Qed.

Lemma affine_zero b1 b2 b3 c g : cross (sub (at_ b2) (at_ b1)) (sub (at_ b3) (at_ b1)) <> 0 ->
  affine S c g b1 = 0 -> affine S c g b2 = 0 -> affine S c g b3 = 0 -> forall u, affine S c g u = 0.
Proof.
  intros N E1 E2 E3 u. unfold affine in *.
  assert (G : g = (0, 0)).
  { unfold cross, sub, dot in *. destruct g as [x y]. cbn [fst snd] in *.
    set (x2 := fst (at_ b2) - fst (at_ b1)) in *. set (y2 := snd (at_ b2) - snd (at_ b1)) in *.
    set (x3 := fst (at_ b3) - fst (at_ b1)) in *. set (y3 := snd (at_ b3) - snd (at_ b1)) in *.
    assert (L2 : x * x2 + y * y2 = 0) by (unfold x2, y2; lra).
    assert (L3 : x * x3 + y * y3 = 0) by (unfold x3, y3; lra).
    f_equal; apply (Rmult_eq_reg_r (x2 * y3 - y2 * x3)); try assumption; rewrite Rmult_0_l.
    - replace (x * (x2 * y3 - y2 * x3)) with ((x * x2 + y * y2) * y3 - (x * x3 + y * y3) * y2) by ring.
      rewrite L2, L3. ring.
    - replace (y * (x2 * y3 - y2 * x3)) with ((x * x3 + y * y3) * x2 - (x * x2 + y * y2) * x3) by ring.
      rewrite L2, L3. ring. }
  rewrite G in *. unfold dot in *. cbn [fst snd] in *. lra.
Qed.

(** Complex heights that are linear on the whole sheet: the real and the imaginary part are. *)
Definition complex_affine (z : cvec) : Prop :=
  exists c g c' g', forall u, In u vertices -> z u = (affine S c g u, affine S c' g' u).

(** Complex solutions of K_v = 0. *)
Definition complex_solution (z : cvec) : Prop := forall v, In v I -> KC S v z = real 0.

(** Three boundary vertices: the sheet is rigid, to second order. *)
Theorem rigid b1 b2 b3 z : rim S = [b1; b2; b3] ->
  cross (sub (at_ b2) (at_ b1)) (sub (at_ b3) (at_ b1)) <> 0 ->
  complex_solution z -> complex_affine z.
Proof.
  intros Rim N Sol.
  destruct (interpolate b1 b2 b3 (re_part z) N) as (c & g & A1 & A2 & A3).
  destruct (interpolate b1 b2 b3 (im_part z) N) as (c' & g' & B1 & B2 & B3).
  exists c, g, c', g'.
  set (a := minus (re_part z) (affine S c g)). set (b := minus (im_part z) (affine S c' g')).
  set (z' := fun u => if in_dec Nat.eq_dec u I then (a u, b u) else real 0 : complex).
  assert (R : forall u, In u (rim S) -> a u = 0 /\ b u = 0).
  { intros u Hu. rewrite Rim in Hu. unfold a, b, minus. simpl in Hu.
    destruct Hu as [<-|[<-|[<-|[]]]]; lra. }
  assert (Val : forall u, In u vertices -> re_part z' u = a u /\ im_part z' u = b u).
  { intros u Hu. unfold re_part, im_part, z'. destruct in_dec as [|Nu]; [easy|].
    apply in_app_or in Hu. destruct Hu as [|Hu]; [contradiction|]. destruct (R u Hu) as (-> & ->). easy. }
  assert (Z : forall u, z' u = real 0).
  { apply (no_zero_at_infinity S).
    - intros u Hu. unfold z'. now destruct in_dec.
    - intros v Hv. destruct (KC_equation S v z 0 Hv (Sol v Hv)) as (E1 & E2).
      rewrite KC_parts by now apply inner_vertex.
      rewrite (K_vertices v (re_part z') a), (K_vertices v (im_part z') b),
        (K2_vertices v (re_part z') a (im_part z') b);
        try assumption; try (intros u Hu; now apply Val).
      unfold a, b. rewrite !K_affine, K2_affine by assumption. unfold real. f_equal; lra. }
  intros u Hu. destruct (Val u Hu) as (Ea & Eb).
  assert (Q : re_part z' u = 0 /\ im_part z' u = 0) by (unfold re_part, im_part; rewrite (Z u); easy).
  destruct Q as (Qa & Qb). rewrite Qa in Ea. rewrite Qb in Eb. unfold a, b, minus, re_part, im_part, re, im in Ea, Eb.
  destruct (z u) as [x y]. cbn [fst snd] in *. f_equal; lra.
Qed.

Section Quadrilateral.
Variables b1 b2 b3 b4 : nat.
Hypothesis Rim : rim S = [b1; b2; b3; b4].
(** The corners that are pinned are not in line. *)
Hypothesis Corners : cross (sub (at_ b2) (at_ b1)) (sub (at_ b3) (at_ b1)) <> 0.

(** The representative of a branch: three boundary vertices are pinned, the fourth has height 1. *)
Definition representative (h : vec) : Prop := has_rim S (unit b4) h /\ solves S (fun _ => 0) h.

(** [z] is [s] times [h] plus a complex plane. *)
Definition on_branch (z : cvec) (s : complex) (h : vec) : Prop :=
  s <> real 0 /\ complex_affine (fun u => csub (z u) (cmul s (real (h u)))).

Lemma rim_once : NoDup [b1; b2; b3; b4].
Proof.
  rewrite <- Rim. pose proof (vertices_once S) as D. induction I as [|v l IH]; [exact D|].
  cbn [app] in D. inversion D. auto.
Qed.

Lemma unit_rim : unit b4 b1 = 0 /\ unit b4 b2 = 0 /\ unit b4 b3 = 0 /\ unit b4 b4 = 1.
Proof.
  pose proof rim_once as D. inversion D as [|? ? N1 D1]; subst. inversion D1 as [|? ? N2 D2]; subst.
  inversion D2 as [|? ? N3 D3]; subst. simpl in *. unfold unit. rewrite upd_same.
  rewrite !upd_other by (intros ->; tauto). easy.
Qed.

(** Every solution of the homogeneous system, real or complex, is flat or on the branch of a real
    representative: its boundary saddle is not 0. *)
Theorem every_solution_on_a_branch z : complex_solution z ->
  complex_affine z \/ exists s h, representative h /\ on_branch z s h.
Proof.
  intros Sol. pose proof unit_rim as (U1 & U2 & U3 & U4).
  destruct (interpolate b1 b2 b3 (re_part z) Corners) as (c & g & A1 & A2 & A3).
  destruct (interpolate b1 b2 b3 (im_part z) Corners) as (c' & g' & B1 & B2 & B3).
  set (a := minus (re_part z) (affine S c g)). set (b := minus (im_part z) (affine S c' g')).
  assert (Kab : forall v, In v I -> K S v a = K S v b /\ K2 S v a b = 0).
  { intros v Hv. destruct (KC_equation S v z 0 Hv (Sol v Hv)) as (E1 & E2).
    unfold a, b. rewrite !K_affine, K2_affine by assumption. lra. }
  assert (R : forall u, In u (rim S) -> u = b4 \/ (a u = 0 /\ b u = 0 /\ unit b4 u = 0)).
  { intros u Hu. rewrite Rim in Hu. unfold a, b, minus. simpl in Hu.
    destruct Hu as [<-|[<-|[<-|[<-|[]]]]]; [right|right|right|now left]; repeat split; lra. }
  assert (Zs : z = fun u => (a u + affine S c g u, b u + affine S c' g' u)).
  { apply functional_extensionality. intros u. unfold a, b, minus, re_part, im_part, re, im.
    destruct (z u). cbn [fst snd]. f_equal; ring. }
  destruct (Req_dec (a b4 * a b4 + b b4 * b b4) 0) as [S0|S0].
  - left. assert (a b4 = 0 /\ b b4 = 0) as (Sa & Sb).
    { pose proof (Rle_0_sqr (a b4)). pose proof (Rle_0_sqr (b b4)). unfold Rsqr in *.
      split; apply Rsqr_0_uniq; unfold Rsqr; lra. }
    set (z' := fun u => if in_dec Nat.eq_dec u I then (a u, b u) else real 0 : complex).
    assert (Val : forall u, In u vertices -> re_part z' u = a u /\ im_part z' u = b u).
    { intros u Hu. unfold re_part, im_part, z'. destruct in_dec as [|Nu]; [easy|].
      apply in_app_or in Hu. destruct Hu as [|Hu]; [contradiction|].
      destruct (R u Hu) as [->|(-> & -> & _)]; [rewrite Sa, Sb|]; easy. }
    assert (Z : forall u, z' u = real 0).
    { apply (no_zero_at_infinity S).
      - intros u Hu. unfold z'. now destruct in_dec.
      - intros v Hv. destruct (Kab v Hv) as (E1 & E2).
        rewrite KC_parts by now apply inner_vertex.
        rewrite (K_vertices v (re_part z') a), (K_vertices v (im_part z') b),
          (K2_vertices v (re_part z') a (im_part z') b);
          try assumption; try (intros u Hu; now apply Val).
        rewrite E1, E2. unfold real. f_equal; ring. }
    exists c, g, c', g'. intros u Hu. destruct (Val u Hu) as (Ea & Eb).
    unfold re_part, im_part in Ea, Eb. rewrite (Z u) in Ea, Eb. cbn in Ea, Eb.
    rewrite Zs, <- Ea, <- Eb. f_equal; ring.
  - right. set (m := a b4 * a b4 + b b4 * b b4) in *. set (p := a b4 / m). set (q := - b b4 / m).
    set (a' := fun u => p * a u + - q * b u). set (b' := fun u => q * a u + p * b u).
    set (z' := fun u => if in_dec Nat.eq_dec u I then (a' u, b' u) else real (unit b4 u) : complex).
    assert (Val : forall u, In u vertices -> re_part z' u = a' u /\ im_part z' u = b' u).
    { intros u Hu. unfold re_part, im_part, z'. destruct in_dec as [|Nu]; [easy|].
      apply in_app_or in Hu. destruct Hu as [|Hu]; [contradiction|]. unfold a', b', real, re, im. cbn [fst snd].
      destruct (R u Hu) as [->|(-> & -> & ->)]; [|split; ring].
      rewrite U4. unfold p, q, m in *. split; field; assumption. }
    assert (Kz : forall v, In v I -> KC S v z' = real 0).
    { intros v Hv. destruct (Kab v Hv) as (E1 & E2).
      rewrite KC_parts by now apply inner_vertex.
      rewrite (K_vertices v (re_part z') a'), (K_vertices v (im_part z') b'),
        (K2_vertices v (re_part z') a' (im_part z') b');
        try assumption; try (intros u Hu; now apply Val).
      rewrite <- (K_polar_sheet S v a'), <- (K_polar_sheet S v b') by now apply inner_vertex.
      unfold a', b'. rewrite !K2_combine2, E1, E2 by assumption. unfold real. f_equal; ring. }
    assert (Im : forall u, im (z' u) = 0).
    { apply (all_real S (fun _ => 0) (unit b4)); [intros; lra| |assumption].
      intros u Hu. unfold z'. now destruct in_dec. }
    assert (Sn : (a b4, b b4) <> real 0).
    { intros E. injection E as E1 E2. apply S0. unfold m. rewrite E1, E2. ring. }
    exists (a b4, b b4), (re_part z'). split; [split|split].
    + intros u Hu. unfold re_part, z'. now destruct in_dec.
    + intros v Hv. destruct (KC_equation S v z' 0 Hv (Kz v Hv)) as (E1 & _). rewrite E1, Rplus_0_r.
      replace (im_part z') with zero by (apply functional_extensionality; intro; symmetry; apply Im).
      rewrite <- K_polar_sheet by now apply inner_vertex.
      apply (linear_zero (K2 S v zero)). intros x s y. apply K2_move.
    + exact Sn.
    + exists c, g, c', g'. intros u Hu. destruct (Val u Hu) as (Ea & Eb).
      assert (Ib : b' u = 0) by (rewrite <- Eb; apply Im).
      rewrite Zs, Ea. unfold csub, cmul, real, re, im. cbn [fst snd].
      assert (Xa : a u = a b4 * a' u - b b4 * b' u) by (unfold a', b', p, q, m in *; field; assumption).
      assert (Xb : b u = b b4 * a' u + a b4 * b' u) by (unfold a', b', p, q, m in *; field; assumption).
      rewrite Ib in Xa, Xb. rewrite Xa at 1. rewrite Xb at 1. f_equal; ring.
Qed.

(** Different representatives are on different branches. *)
Theorem branch_has_one_representative z s s' h h' : representative h -> representative h' ->
  on_branch z s h -> on_branch z s' h' -> h = h' /\ s = s'.
Proof.
  intros (Hr & Hs) (Hr' & Hs') (Ns & c & g & d & k & E) (Ns' & c' & g' & d' & k' & E').
  pose proof unit_rim as (U1 & U2 & U3 & U4).
  assert (Rb : forall b, In b (rim S) -> h b = unit b4 b /\ h' b = unit b4 b).
  { intros b Hb. split; [apply Hr|apply Hr']; now apply rim_not_inner. }
  assert (V : forall b, In b (rim S) -> In b vertices) by (intros; apply in_or_app; now right).
  assert (In1 : In b1 (rim S)) by (rewrite Rim; simpl; auto).
  assert (In2 : In b2 (rim S)) by (rewrite Rim; simpl; auto).
  assert (In3 : In b3 (rim S)) by (rewrite Rim; simpl; auto).
  assert (In4 : In b4 (rim S)) by (rewrite Rim; simpl; auto 6).
  assert (D : forall u, In u vertices ->
    re s * h u - re s' * h' u = - affine S (c - c') (fst g - fst g', snd g - snd g') u /\
    im s * h u - im s' * h' u = - affine S (d - d') (fst k - fst k', snd k - snd k') u).
  { intros u Hu. specialize (E u Hu). specialize (E' u Hu).
    unfold csub, cmul, real, re, im in *. cbn [fst snd] in *. injection E as Ea Eb. injection E' as Ea' Eb'.
    unfold affine, dot in *. cbn [fst snd]. split; lra. }
  assert (Za : forall u, affine S (c - c') (fst g - fst g', snd g - snd g') u = 0).
  { apply (affine_zero b1 b2 b3 _ _ Corners).
    - destruct (D b1 (V b1 In1)) as (X & _). destruct (Rb b1 In1) as (Y & Y'). rewrite Y, Y', U1 in X. lra.
    - destruct (D b2 (V b2 In2)) as (X & _). destruct (Rb b2 In2) as (Y & Y'). rewrite Y, Y', U2 in X. lra.
    - destruct (D b3 (V b3 In3)) as (X & _). destruct (Rb b3 In3) as (Y & Y'). rewrite Y, Y', U3 in X. lra. }
  assert (Zb : forall u, affine S (d - d') (fst k - fst k', snd k - snd k') u = 0).
  { apply (affine_zero b1 b2 b3 _ _ Corners).
    - destruct (D b1 (V b1 In1)) as (_ & X). destruct (Rb b1 In1) as (Y & Y'). rewrite Y, Y', U1 in X. lra.
    - destruct (D b2 (V b2 In2)) as (_ & X). destruct (Rb b2 In2) as (Y & Y'). rewrite Y, Y', U2 in X. lra.
    - destruct (D b3 (V b3 In3)) as (_ & X). destruct (Rb b3 In3) as (Y & Y'). rewrite Y, Y', U3 in X. lra. }
  assert (Es : s = s').
  { destruct (D b4 (V b4 In4)) as (X & X'). destruct (Rb b4 In4) as (Y & Y'). rewrite Y, Y', U4, Za in X.
    rewrite Y, Y', U4, Zb in X'. unfold re, im in *. destruct s, s'. cbn [fst snd] in *. f_equal; lra. }
  split; [|assumption]. subst s'. apply functional_extensionality. intros u.
  destruct (in_dec Nat.eq_dec u I) as [Hu|Hu]; [|now rewrite Hr, Hr'].
  destruct (D u (inner_vertex S u Hu)) as (X & X'). rewrite Za in X. rewrite Zb in X'.
  destruct (Req_dec (re s) 0) as [Rz|Rz].
  - assert (im s <> 0). { intros Iz. apply Ns. unfold real, re, im in *. destruct s. cbn in *. now subst. }
    apply (Rmult_eq_reg_l (im s)); [lra|assumption].
  - apply (Rmult_eq_reg_l (re s)); [lra|assumption].
Qed.

(** There are at most 2^n branches, and all are real. *)
Theorem at_most_2_to_the_n : exists l : list vec, length l = (2 ^ n)%nat /\
  (forall h, In h l <-> representative h) /\
  forall z, complex_solution z -> complex_affine z \/ exists s h, In h l /\ on_branch z s h.
Proof.
  destruct (list_of_solutions S (fun _ => 0) (unit b4)) as (l & Len & Sol & _); [intros; lra|].
  exists l. split; [assumption|]. split; [exact Sol|]. intros z Hz.
  destruct (every_solution_on_a_branch z Hz) as [|(s & h & Rh & Oh)]; [now left|right].
  exists s, h. split; [now apply Sol|assumption].
Qed.

(** If no star is flat on any branch, there are exactly 2^n branches, all real, exactly one
    representative for each sign vector. *)
Theorem branches : (forall h, representative h -> forall v, In v I -> ~ flat_star S v h) ->
  exists l : list vec, length l = (2 ^ n)%nat /\ NoDup l /\
    (forall h, In h l <-> representative h) /\
    (forall e, exists! h, In h l /\ forall v, In v I -> 0 < sign (e v) * K2 S v (cone S v) h) /\
    (forall z, complex_solution z -> complex_affine z \/
       exists h, In h l /\ (exists s, on_branch z s h) /\ forall h' s', In h' l -> on_branch z s' h' -> h' = h).
Proof.
  intros NF.
  assert (Reg : forall h, has_rim S (unit b4) h -> solves S (fun _ => 0) h -> regular S h).
  { intros h Hr Hs v Hv. right. split; [now apply Hs|]. apply NF; [split; assumption|assumption]. }
  destruct (list_of_solutions S (fun _ => 0) (unit b4)) as (l & Len & Sol & D); [intros; lra|]. specialize (D Reg).
  exists l. split; [assumption|]. split; [assumption|]. split; [exact Sol|]. split.
  - intros e. destruct (one_solution_per_sign_vector S (fun _ => 0) (unit b4) e)
      as (h & (Hr & Hs & Hn) & U); [intros; lra|].
    exists h. split.
    + split; [apply Sol; now split|]. intros v Hv. destruct (Hn v Hv) as (_ & P).
      pose proof (regular_sign S h v (Reg h Hr Hs) Hv) as N.
      destruct P as [P|P]; [assumption|]. exfalso. apply N. destruct (e v); simpl in P; lra.
    + intros g (Hg & Ps). apply Sol in Hg. destruct Hg as (Gr & Gs). apply U. split; [assumption|].
      split; [assumption|]. intros v Hv. rewrite (Gs v Hv). split; [lra|]. apply Rlt_le. auto.
  - intros z Hz. destruct (every_solution_on_a_branch z Hz) as [|(s & h & Rh & Oh)]; [now left|right].
    exists h. split; [now apply Sol|]. split; [now exists s|].
    intros h' s' Hh' Oh'. apply Sol in Hh'.
    now destruct (branch_has_one_representative z s' s h' h Hh' Rh Oh' Oh).
Qed.

(** The vertex signs of [h] are those of [e], and no vertex is neutral. *)
Definition has_signs (e : nat -> bool) (h : vec) : Prop :=
  forall v, In v I -> 0 < sign (e v) * K2 S v (cone S v) h.

(** Exactly two branches for each pair of opposite sign vectors (h and -h are on one branch). *)
Theorem two_branches_per_pair : I <> [] ->
  (forall h, representative h -> forall v, In v I -> ~ flat_star S v h) ->
  forall e, exists h1 h2, h1 <> h2 /\ forall h,
    (representative h /\ (has_signs e h \/ has_signs (fun v => negb (e v)) h)) <-> h = h1 \/ h = h2.
Proof.
  intros Ne NF e. destruct (branches NF) as (l & _ & _ & Sol & One & _).
  destruct (One e) as (h1 & (In1 & S1) & U1). destruct (One (fun v => negb (e v))) as (h2 & (In2 & S2) & U2).
  exists h1, h2. split.
  - intros E. assert (Ex : exists v, In v I) by (destruct I as [|v l']; [easy|exists v; now left]).
    destruct Ex as (v & Hv). specialize (S1 v Hv). specialize (S2 v Hv). rewrite E in S1.
    destruct (e v); simpl in S1, S2; lra.
  - intros h. split.
    + intros (Rh & [Sg|Sg]); [left; symmetry; apply U1|right; symmetry; apply U2]; (split; [now apply Sol|exact Sg]).
    + intros [->| ->]; split; try (now apply Sol); [left|right]; assumption.
Qed.

End Quadrilateral.
End Branches.
