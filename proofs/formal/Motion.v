(** True motions (docs/motion.md, section 4): a simple solution of the equations K_v = 0 begins a motion in which all
    edges keep their lengths exactly. With positions U + t^2 u and heights t g the length of an edge is kept if and
    only if 2 U_e . u_e + g_e^2 + s |u_e|^2 = 0, where s = t^2, and Curve.v solves these equations. *)
From Coq Require Import Reals List Lra Lia Arith Bool FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Nappes Sheet Identities Star KeyLemma Flat Krawczyk Curve Flex Displacements.
Import ListNotations.
Open Scope R_scope.

Section Motion.
Variable S : sheet.
Notation at_ := (at_ S).

(** The faces [F] with the vertices [J] inside, glued to a disk with the vertices [vs]. *)
Variables J vs : list nat.
Variables F fs : list face.
Hypothesis OnceJ : NoDup J.
Hypothesis Inside : forall v, In v J -> In v (inner S) /\ all_at S F v.
Hypothesis Glued : glued S J vs fs.
Hypothesis Same : forall s, In s (sides F) <-> In s (sides fs).

(** One vertex is held, and another one on its line with the first. *)
Variables p q : nat.
Hypothesis Hp : In p vs.
Hypothesis Hq : In q vs.
Notation d := (sub (at_ q) (at_ p)).
Notation D := (Rabs (fst d) + Rabs (snd d)).
Hypothesis Apart : dot d d <> 0.

Notation holding := (Displacements.holding S vs p q).
Notation held := (Displacements.held S p q).
Notation pack := (Displacements.pack S p q).
Notation shift := (Displacements.shift S p q).
Notation I := (unknowns J vs p q).
Notation in_vs := (Displacements.in_vs S J vs F fs Glued Same).
Notation hold := (Displacements.hold S J vs F fs Glued Same p q Hp Hq Apart).
Notation shift_pack := (Displacements.shift_pack S p q Apart).
Notation height_pack := (Displacements.height_pack S p q).
Notation unpack := (Displacements.unpack S p q Apart).
Notation zero_off_pack := (Displacements.zero_off_pack S J vs p q Apart).
Notation zero_off_parts := (Displacements.zero_off_parts S J vs p q).
Notation shift_bound := (Displacements.shift_bound S p q).
Notation extent := (Displacements.extent vs).

(** ** The equations of the lengths *)

Definition edge_form (e : nat * nat) (x y : vec) : R := let '(a, b) := e in
  x O * widen at_ (shift y) a b + y O * widen at_ (shift x) a b +
  (height x b - height x a) * (height y b - height y a).
Definition edge_square (e : nat * nat) (x y : vec) : R := let '(a, b) := e in
  dot (sub (shift x b) (shift x a)) (sub (shift y b) (shift y a)).

Lemma edge_form_sym e x y : edge_form e x y = edge_form e y x.
Proof. destruct e. unfold edge_form. ring. Qed.
Lemma edge_form_move e x y s z : edge_form e x (move y s z) = edge_form e x y + s * edge_form e x z.
Proof. destruct e as [a b]. unfold edge_form, shift, height, move. points. ring. Qed.
Lemma edge_square_sym e x y : edge_square e x y = edge_square e y x.
Proof. destruct e. unfold edge_square, dot. ring. Qed.
Lemma edge_square_move e x y s z : edge_square e x (move y s z) = edge_square e x y + s * edge_square e x z.
Proof. destruct e as [a b]. unfold edge_square, shift, move. points. ring. Qed.

(** ** The solution that begins the motion *)

Variable h : vec.
Hypothesis Null : forall v, In v J -> K S v h = 0.
Hypothesis Simple : forall g, zero_off J g -> (forall v, In v J -> K2 S v h g = 0) -> g = zero.

Lemma start : exists u, holding u /\ keeps S F h u.
Proof.
  destruct (glued_flex S J h (fun v Hv => proj1 (Inside v Hv)) Null vs fs Glued) as (u & Kp).
  destruct (hold u) as (u' & Hu & W). exists u'. split; [exact Hu|]. rewrite keeps_widen in Kp. rewrite keeps_widen.
  intros a b H. rewrite (W a b H). now apply Kp, Same.
Qed.

Section Started.
Variable u0 : nat -> point.
Hypothesis Held0 : holding u0.
Hypothesis Keeps0 : keeps S F h u0.
Definition beginning : vec := pack 1 u0 h.
Notation m := beginning.

Lemma edge_form_at w a b : w O = 0 ->
  edge_form (a, b) m w = widen at_ (shift w) a b + (h b - h a) * (height w b - height w a).
Proof. intros W. unfold edge_form. rewrite W. unfold m. rewrite !height_pack. cbn [pack]. ring. Qed.

Lemma beginning_solves e : In e (sides F) -> edge_form e m m = 0.
Proof.
  destruct e as [a b]. intros H. specialize (Keeps0 a b H). unfold stretch in Keeps0. unfold edge_form, m.
  rewrite !height_pack. cbn [pack]. unfold widen. rewrite !shift_pack. lra.
Qed.

Lemma injective w : zero_off I w -> (forall e, In e (sides F) -> edge_form e m w = 0) -> w = zero.
Proof.
  intros Zw E. destruct (zero_off_parts w Zw) as (W & Hw & Gw).
  assert (Wi : forall a b, In (a, b) (sides F) ->
    widen at_ (shift w) a b = -1 * ((h b - h a) * (height w b - height w a))).
  { intros a b H. specialize (E _ H). rewrite edge_form_at in E by assumption. lra. }
  assert (G : height w = zero).
  { apply Simple; [exact Gw|]. intros v Hv. destruct (Inside v Hv) as (Hi & At).
    pose proof (load_ext S F _ _ v (even_widen S (shift w)) (even_heights (-1) h (height w)) At Wi) as L.
    rewrite load_widen in L by assumption.
    assert (L' : load S (fun x y => -1 * ((h y - h x) * (height w y - height w x))) v =
      -1 * load S (fun x y => (h y - h x) * (height w y - height w x)) v).
    { unfold load. rewrite <- sum_scal. apply sum_ext. intros [x y] _. unfold share, Rdiv. ring. }
    rewrite L', load_heights in L by assumption. lra. }
  assert (U : forall v, shift w v = origin).
  { apply (rigid_in_plane S J vs F fs Glued Same p q Hp Hq Apart); [exact Hw|]. intros a b H. rewrite (Wi a b H), G.
    unfold zero. ring. }
  rewrite (unpack w), W. apply pack_zero; [exact Apart|exact U|]. intros v. now rewrite G.
Qed.

Lemma onto s x : exists w, zero_off I w /\
  forall e, In e (sides F) -> edge_form e m w = edge_form e x x + s * edge_square e x x - 0.
Proof.
  set (c := fun a b => edge_form (a, b) x x + s * edge_square (a, b) x x).
  assert (Ev : both_ways c).
  { intros a b. unfold c, edge_form, edge_square. points. ring. }
  destruct (solve J (fun v g => K2 S v h g) OnceJ) with (b := fun v => - load S c v) as (g & Zg & Kg).
  { intros v _ a t b. apply K2_move. } { exact Simple. }
  set (c' := fun a b => c a b + -1 * ((h b - h a) * (g b - g a))).
  destruct (glued_moves S J c') with (vs := vs) (fs := fs) as (u & Hu).
  { intros a b. unfold c'. rewrite (Ev a b). ring. }
  { intros v Hv. unfold c'. rewrite (load_add S c), load_heights, Kg; [ring|assumption|now apply Inside]. }
  { exact Glued. }
  destruct (hold u) as (u' & Held' & W). exists (pack 0 u' g). split; [now apply zero_off_pack|].
  intros [a b] H. rewrite edge_form_at by reflexivity. rewrite !height_pack. unfold widen. rewrite !shift_pack.
  fold (widen at_ u' a b). rewrite (W a b H), Hu by now apply Same. unfold c', c. ring.
Qed.

(** The linear equations determine displacements and heights stably. *)
Lemma stable : exists C, 0 <= C /\ forall w r, zero_off I w ->
  (forall e, In e (sides F) -> Rabs (edge_form e m w) <= r) -> norm I w <= C * r.
Proof.
  apply (left_bound (sides F) I (fun e => edge_form e m)); [apply unknowns_once| |exact injective].
  intros e a s b. apply edge_form_move.
Qed.

Lemma form_at s x a b : x O = 1 -> edge_form (a, b) x x + s * edge_square (a, b) x x =
  2 * widen at_ (shift x) a b + (height x b - height x a) * (height x b - height x a) +
  s * dot (sub (shift x b) (shift x a)) (sub (shift x b) (shift x a)).
Proof. intros X. unfold edge_form, edge_square. rewrite X. ring. Qed.

(** A configuration near the beginning of the motion is a solution of the equations near [m]. *)
Lemma configuration_near r : 0 < r -> exists delta, 0 < delta /\ forall t P z, t <> 0 ->
  true_lengths at_ F P z -> held P -> (forall v, In v vs -> ~ In v J -> z v = t * h v) ->
  (forall v, In v vs -> bounded delta (sub (P v) (at_ v))) ->
  (forall v, In v J -> Rabs (z v - t * h v) <= delta * Rabs t) ->
  exists y, (forall i, ~ In i I -> y i = m i) /\ close I m r y /\
    (forall e, In e (sides F) -> edge_form e y y + t * t * edge_square e y y = 0) /\
    forall v, In v vs -> P v = add (at_ v) (scale (t * t) (shift y v)) /\ z v = t * height y v.
Proof.
  intros Pr. destruct stable as (C & PC & St). set (U := extent u0).
  assert (PU : 0 <= U).
  { apply extent_pos. }
  assert (PD : 0 <= D) by (pose proof (Rabs_pos (fst d)); pose proof (Rabs_pos (snd d)); lra).
  set (b1 := 8 * C * D + 1). set (b2 := 2 * C * (2 + 4 * U) + 1).
  assert (PCD : 0 <= C * D) by now apply Rmult_le_pos.
  assert (PCU : 0 <= C * U) by now apply Rmult_le_pos.
  set (delta := Rmin 1 (Rmin (/ b1) (r / b2))).
  assert (Pd : 0 < delta).
  { unfold delta. apply Rmin_pos; [lra|].
    apply Rmin_pos; [apply Rinv_0_lt_compat|apply Rdiv_lt_0_compat]; unfold b1, b2; lra. }
  assert (D1 : delta <= 1) by apply Rmin_l.
  assert (D2 : delta * b1 <= 1).
  { assert (delta <= / b1) by (unfold delta; eapply Rle_trans; [apply Rmin_r|apply Rmin_l]).
    replace 1 with (/ b1 * b1) by (field; unfold b1; lra). apply Rmult_le_compat_r; [unfold b1; lra|assumption]. }
  assert (D3 : delta * b2 <= r).
  { assert (delta <= r / b2) by (unfold delta; eapply Rle_trans; [apply Rmin_r|apply Rmin_r]).
    replace r with (r / b2 * b2) by (field; unfold b2; lra). apply Rmult_le_compat_r; [unfold b2; lra|assumption]. }
  clearbody delta. exists delta. split; [exact Pd|]. intros t P z Nt True (Hp0 & Hq0) Rim Near High.
  assert (Ptt : 0 < t * t) by (pose proof (Rsqr_pos_lt t Nt) as X; exact X).
  set (uw := fun v => if in_dec Nat.eq_dec v vs then sub (scale (/ (t * t)) (sub (P v) (at_ v))) (u0 v) else origin).
  set (gw := fun v => if in_dec Nat.eq_dec v J then z v / t - h v else 0).
  set (w := pack 0 uw gw). destruct Held0 as (U0p & U0q & U0off).
  assert (Zw : zero_off I w).
  { apply zero_off_pack.
    - split; [|split].
      + unfold uw. destruct in_dec; [|contradiction]. rewrite Hp0, U0p. points. f_equal; ring.
      + unfold uw. destruct in_dec; [|contradiction].
        replace (cross d (sub (scale (/ (t * t)) (sub (P q) (at_ q))) (u0 q))) with
          (/ (t * t) * cross d (sub (P q) (at_ p)) - cross d (u0 q)) by (points; ring). rewrite Hq0, U0q. ring.
      + intros v Hv. unfold uw. now destruct in_dec.
    - intros v Hv. unfold gw. now destruct in_dec. }
  set (y := move m 1 w). exists y.
  assert (Yoff : forall i, ~ In i I -> y i = m i) by (intros i Hi; unfold y, move; rewrite (Zw i Hi); ring).
  assert (Y0 : y O = 1) by (unfold y, move, m, w; cbn [pack]; ring).
  assert (Yu : forall v, In v vs -> shift y v = scale (/ (t * t)) (sub (P v) (at_ v))).
  { intros v Hv. unfold y. rewrite shift_move. unfold m, w. rewrite !shift_pack. unfold uw.
    destruct in_dec; [|contradiction]. points. f_equal; ring. }
  assert (Yh : forall v, In v vs -> z v = t * height y v).
  { intros v Hv. unfold y, height, move. fold (height m v). fold (height w v). unfold m, w. rewrite !height_pack.
    unfold gw.
    destruct in_dec as [|N]; [field; exact Nt|]. rewrite (Rim v Hv N). ring. }
  assert (Yp : forall v, In v vs -> P v = add (at_ v) (scale (t * t) (shift y v))).
  { intros v Hv. rewrite (Yu v Hv). destruct (P v). points. f_equal; field; exact Nt. }
  assert (Eq : forall e, In e (sides F) -> edge_form e y y + t * t * edge_square e y y = 0).
  { intros [a b] He. destruct (in_vs a b He) as (Ha & Hb). rewrite (form_at (t * t) y a b Y0).
    pose proof (length_identity at_ P z t (shift y) (height y) a b (Yp a Ha) (Yp b Hb) (Yh a Ha) (Yh b Hb)) as L.
    rewrite (True a b He) in L. set (v := _ + t * t * dot _ _) in *. assert (t * t * v = 0) by lra. nra. }
  split; [exact Yoff|]. split; [|split; [exact Eq|intros v Hv; split; auto]].
  set (rho := norm I w). assert (Prho : 0 <= rho) by apply norm_nonneg.
  assert (Small : forall v, bounded (D * rho) (shift w v)) by (intros v; apply shift_bound; intros; now apply at_norm).
  assert (G : forall v, Rabs (gw v) <= delta).
  { intros v. unfold gw. destruct in_dec as [Hv|Hv]; [|rewrite Rabs_R0; lra].
    replace (z v / t - h v) with ((z v - t * h v) / t) by (field; exact Nt). unfold Rdiv. rewrite Rabs_mult, Rabs_inv.
    apply (Rmult_le_reg_r (Rabs t)); [now apply Rabs_pos_lt|]. rewrite Rmult_assoc, Rinv_l, Rmult_1_r; [auto|].
    now apply Rabs_no_R0. }
  assert (B : rho <= C * (delta * (2 + 4 * U + 4 * (D * rho)))).
  { apply St; [exact Zw|]. intros [a b] He. destruct (in_vs a b He) as (Ha & Hb).
    assert (E : 2 * edge_form (a, b) m w = - ((gw b - gw a) * (gw b - gw a) +
      dot (sub (scale (t * t) (shift y b)) (scale (t * t) (shift y a))) (sub (shift y b) (shift y a)))).
    { pose proof (Eq _ He) as E. unfold y at 1 2 in E.
      rewrite edge_form_move, (edge_form_sym _ (move m 1 w)), edge_form_move,
        (edge_form_sym _ (move m 1 w) w), edge_form_move, (edge_form_sym _ w m), (beginning_solves _ He) in E.
      replace (edge_form (a, b) w w) with ((gw b - gw a) * (gw b - gw a)) in E
        by (unfold edge_form, w; rewrite !height_pack; cbn [pack]; ring).
      unfold edge_square in E.
      replace (dot (sub (scale (t * t) (shift y b)) (scale (t * t) (shift y a))) (sub (shift y b) (shift y a))) with
        (t * t * dot (sub (shift y b) (shift y a)) (sub (shift y b) (shift y a))) by (points; ring). lra. }
    assert (T : forall v, In v vs -> bounded delta (scale (t * t) (shift y v))).
    { intros v Hv. replace (scale (t * t) (shift y v)) with (sub (P v) (at_ v)); [now apply Near|].
      rewrite (Yp v Hv). destruct (at_ v). points. f_equal; ring. }
    assert (V : forall v, In v vs -> bounded (U + D * rho) (shift y v)).
    { intros v Hv. unfold y. rewrite shift_move. unfold m. rewrite shift_pack. apply add_bound; [now apply extent_at|].
      replace (scale 1 (shift w v)) with (shift w v) by (destruct (shift w v); points; f_equal; ring). apply Small. }
    pose proof (product_bound _ _ _ _ (difference_bound _ _ _ _ (G b) (G a))
      (difference_bound _ _ _ _ (G b) (G a))) as Q1.
    pose proof (dot_bound _ _ _ _ (sub_bound _ _ _ _ (T b Hb) (T a Ha)) (sub_bound _ _ _ _ (V b Hb) (V a Ha))) as Q2.
    pose proof (sum_bound _ _ _ _ Q1 Q2) as Q. rewrite <- Rabs_Ropp, <- E, Rabs_mult, (Rabs_right 2) in Q by lra.
    assert (delta * delta <= delta) by nra. lra. }
  assert (X : C * (delta * (4 * (D * rho))) <= rho / 2).
  { replace (C * (delta * (4 * (D * rho)))) with (delta * (8 * C * D) * (rho / 2)) by field.
    assert (delta * (8 * C * D) <= 1) by (unfold b1 in D2; lra). nra. }
  assert (Y : rho <= r) by (unfold b2 in D3; lra).
  intros i Hi. replace (y i - m i) with (w i) by (unfold y, move; ring).
  eapply Rle_trans; [exact (at_norm I w i Zw)|exact Y].
Qed.

Lemma near_beginning C s x : (forall i, Rabs (x i - m i) <= C * s) -> forall v,
  bounded (extent u0 + D * (C * s)) (shift x v) /\ Rabs (height x v - h v) <= C * s.
Proof.
  intros B v. pose proof (shift_bound (minus x m) (C * s) v B) as (Pl & H). split.
  - replace (shift x v) with (add (u0 v) (shift (minus x m) v)).
    + apply add_bound; [|exact Pl]. destruct (in_dec Nat.eq_dec v vs); [now apply extent_at|].
      destruct Held0 as (_ & _ & Off). rewrite Off by assumption. pose proof (extent_pos vs u0).
      split; cbn; rewrite Rabs_R0; lra.
    + rewrite <- (shift_pack 1 u0 h v). fold m. unfold shift, minus. points. f_equal; ring.
  - unfold height, minus in H. fold (height x v) in H. fold (height m v) in H. unfold m in H.
    now rewrite height_pack in H.
Qed.
End Started.

(** The true motion: for small t positions P(t) and heights z(t) = t h + O(t^3), with all edges as long as in the flat
    sheet, and no other such configurations that are near the flat sheet, with heights near t h. *)
Definition true_motion (t1 delta C : R) (P : R -> nat -> point) (z : R -> vec) : Prop :=
  0 < t1 /\ 0 < delta /\ 0 <= C /\
  (forall t, Rabs t <= t1 -> true_lengths at_ F (P t) (z t) /\ held (P t) /\
    (forall v, ~ In v J -> z t v = t * h v) /\
    forall v, bounded (C * (t * t)) (sub (P t v) (at_ v)) /\ Rabs (z t v - t * h v) <= C * (t * t * Rabs t)) /\
  (forall t t', Rabs t <= t1 -> Rabs t' <= t1 -> forall v, In v vs ->
    bounded (C * Rabs (t - t')) (sub (P t v) (P t' v)) /\ Rabs (z t v - z t' v) <= C * Rabs (t - t')) /\
  (forall t P' z', Rabs t <= t1 -> t <> 0 -> true_lengths at_ F P' z' -> held P' ->
    (forall v, In v vs -> ~ In v J -> z' v = t * h v) ->
    (forall v, In v vs -> bounded delta (sub (P' v) (at_ v))) ->
    (forall v, In v J -> Rabs (z' v - t * h v) <= delta * Rabs t) ->
    forall v, In v vs -> P' v = P t v /\ z' v = z t v).

Theorem motion : exists t1 delta C P z, true_motion t1 delta C P z.
Proof.
  destruct start as (u0 & Held0 & Keeps0). set (m := beginning u0).
  destruct (curve (sides F) I edge_form edge_square (fun _ => 0) m (unknowns_once J vs p q)
    edge_form_sym edge_form_move edge_square_sym
    edge_square_move (beginning_solves u0 Keeps0) (injective u0)) as (s1 & r & Cx & x & Ps & Pr & PC & X0 & Sol & Lip).
  { intros s y _. apply onto. }
  destruct (configuration_near u0 Held0 Keeps0 r Pr) as (delta & Pd & Only).
  set (B := extent u0 + D * Cx). set (H := sum vs (fun v => Rabs (h v))).
  assert (PD : 0 <= D) by (pose proof (Rabs_pos (fst d)); pose proof (Rabs_pos (snd d)); lra).
  assert (PDC : 0 <= D * Cx) by now apply Rmult_le_pos.
  assert (PB : 0 <= B) by (pose proof (extent_pos vs u0); unfold B; lra).
  assert (PH : 0 <= H) by (apply sum_nonneg; intros; apply Rabs_pos).
  set (t1 := Rmin 1 s1). set (C := 3 * Cx + H + 2 * (D * Cx) + 2 * B).
  assert (P1 : 0 < t1) by (apply Rmin_pos; lra). assert (L1 : t1 <= 1) by apply Rmin_l.
  assert (L2 : t1 <= s1) by apply Rmin_r. clearbody t1.
  assert (T1 : forall t, Rabs t <= t1 -> Rabs t <= 1 /\ Rabs (t * t) <= s1 /\ 0 <= t * t <= 1 /\ Rabs (t * t) = t * t).
  { intros t Ht. pose proof (Rabs_pos t).
    pose proof (Rle_0_sqr t) as Sq. unfold Rsqr in Sq.
    assert (E : Rabs (t * t) = t * t) by now apply Rabs_right, Rle_ge.
    assert (E' : t * t = Rabs t * Rabs t) by (rewrite <- Rabs_mult; symmetry; exact E).
    rewrite E. repeat split; nra. }
  assert (Part : forall a t, 0 <= a -> Rabs t <= t1 -> a * (t * t) <= a).
  { intros a t Pa Ht. destruct (T1 t Ht) as (_ & _ & (_ & Q) & _). rewrite <- (Rmult_1_r a) at 2.
    now apply Rmult_le_compat_l. }
  assert (Near : forall t, Rabs t <= t1 -> forall i, Rabs (x (t * t) i - m i) <= Cx * (t * t)).
  { intros t Ht i. destruct (T1 t Ht) as (_ & Hs & _ & E). rewrite <- X0.
    replace (t * t) with (Rabs (t * t - 0)) at 2 by (rewrite Rminus_0_r; exact E).
    apply Lip; [exact Hs|]. rewrite Rabs_R0. lra. }
  set (P := fun t v => add (at_ v) (scale (t * t) (shift (x (t * t)) v))).
  set (z := fun t v => t * height (x (t * t)) v). exists t1, delta, C, P, z.
  split; [exact P1|]. split; [exact Pd|]. split; [unfold C; lra|]. split; [|split].
  - intros t Ht. destruct (T1 t Ht) as (H1 & Hs & (P2 & Q2) & E2). destruct (Sol _ Hs) as ((Off & Eq) & _).
    pose proof (near_beginning u0 Held0 Cx (t * t) _ (Near t Ht)) as Nb.
    assert (Zw : zero_off I (minus (x (t * t)) m)) by (intros i Hi; unfold minus; rewrite (Off i Hi); ring).
    destruct (zero_off_parts _ Zw) as (Z0 & (Zp & Zq & _) & Zh).
    assert (Pl : forall v, shift (x (t * t)) v = add (u0 v) (shift (minus (x (t * t)) m) v)).
    { intros v. rewrite <- (shift_pack 1 u0 h v). unfold shift, minus, m, beginning. points. f_equal; ring. }
    split; [|split; [|split]].
    + intros a b He.
      rewrite (length_identity at_ (P t) (z t) t (shift (x (t * t))) (height (x (t * t))) a b) by reflexivity.
      rewrite <- form_at; [rewrite (Eq (a, b) He); ring|]. unfold minus in Z0. unfold m, beginning in Z0.
      cbn [pack] in Z0. lra.
    + destruct Held0 as (Up & Uq & _). split.
      * unfold P. rewrite Pl, Zp, Up. destruct (at_ p). points. f_equal; ring.
      * unfold P. rewrite Pl.
        replace (cross d (sub (add (at_ q) (scale (t * t) (add (u0 q) (shift (minus (x (t * t)) m) q)))) (at_ p)))
          with (t * t * (cross d (u0 q) + cross d (shift (minus (x (t * t)) m) q))) by (points; ring). rewrite Uq, Zq.
          ring.
    + intros v Hv. specialize (Zh v Hv). unfold z. replace (height (x (t * t)) v) with (h v); [reflexivity|].
      rewrite <- (height_pack 1 u0 h v). unfold height, minus, m, beginning in *. lra.
    + intros v. destruct (Nb v) as (A1 & A2). unfold P, z. split.
      * replace (sub (add (at_ v) (scale (t * t) (shift (x (t * t)) v))) (at_ v)) with
          (scale (t * t) (shift (x (t * t)) v))
          by (destruct (shift (x (t * t)) v); points; f_equal; ring).
        destruct A1 as (A & A'). 
        assert (L : extent u0 + D * (Cx * (t * t)) <= C).
        { pose proof (Part (D * Cx) t PDC Ht). pose proof (extent_pos vs u0). rewrite <- Rmult_assoc. unfold C, B.
          lra. }
        split; unfold scale; cbn [fst snd]; rewrite (Rmult_comm C); apply product_bound; lra.
      * replace (t * height (x (t * t)) v - t * h v) with (t * (height (x (t * t)) v - h v)) by ring.
        pose proof (product_bound _ _ _ _ (Rle_refl (Rabs t)) A2) as A. eapply Rle_trans; [exact A|].
        replace (Rabs t * (Cx * (t * t))) with (Cx * (t * t * Rabs t)) by ring.
        apply Rmult_le_compat_r; [|unfold C; lra].
        apply Rmult_le_pos; [assumption|apply Rabs_pos].
  - intros t t' Ht Ht' v Hv. destruct (T1 t Ht) as (H1 & Hs & (P2 & Q2) & E2).
    destruct (T1 t' Ht') as (H1' & Hs' & (P2' & Q2') & E2').
    destruct (near_beginning u0 Held0 Cx (t' * t') _ (Near t' Ht') v) as (A1 & A2).
    assert (Sq : Rabs (t * t - t' * t') <= 2 * Rabs (t - t')).
    { replace (t * t - t' * t') with ((t + t') * (t - t')) by ring. apply product_bound; [|lra].
      replace 2 with (1 + 1) by ring. now apply sum_bound. }
    assert (Pt : 0 <= Rabs (t - t')) by apply Rabs_pos.
    assert (Dx : forall i, Rabs (minus (x (t * t)) (x (t' * t')) i) <= Cx * (2 * Rabs (t - t'))).
    { intros i. eapply Rle_trans; [now apply Lip|]. apply Rmult_le_compat_l; assumption. }
    destruct (shift_bound _ _ v Dx) as (B1 & B2).
    assert (Hh : Rabs (h v) <= H)
      by (apply (sum_ge_term vs (fun v => Rabs (h v))); [intros; apply Rabs_pos|assumption]).
    unfold P, z. split.
    + replace (sub (add (at_ v) (scale (t * t) (shift (x (t * t)) v)))
        (add (at_ v) (scale (t' * t') (shift (x (t' * t')) v)))) with
        (add (scale (t * t) (shift (minus (x (t * t)) (x (t' * t'))) v))
          (scale (t * t - t' * t') (shift (x (t' * t')) v)))
        by (unfold shift, minus; points; f_equal; ring).
      assert (L : extent u0 + D * (Cx * (t' * t')) <= B).
      { pose proof (Part (D * Cx) t' PDC Ht'). rewrite <- Rmult_assoc. unfold B. lra. }
      pose proof (add_bound _ _ _ _ (scale_bound (t * t) _ _ 1 ltac:(lra) B1) (scale_bound _ _ _ _ Sq A1)) as (R1 & R2).
      assert (Le : 1 * (D * (Cx * (2 * Rabs (t - t')))) + 2 * Rabs (t - t') * (extent u0 + D * (Cx * (t' * t'))) <=
        C * Rabs (t - t')).
      { apply Rle_trans with (1 * (D * (Cx * (2 * Rabs (t - t')))) + 2 * Rabs (t - t') * B).
        - apply Rplus_le_compat_l. apply Rmult_le_compat_l; [lra|exact L].
        - apply Rle_trans with ((2 * (D * Cx) + 2 * B) * Rabs (t - t')); [right; ring|].
          apply Rmult_le_compat_r; [exact Pt|unfold C; lra]. }
      split; lra.
    + replace (t * height (x (t * t)) v - t' * height (x (t' * t')) v) with
        (t * height (minus (x (t * t)) (x (t' * t'))) v + (t - t') * (h v + (height (x (t' * t')) v - h v)))
        by (unfold height, minus; ring).
      pose proof (sum_bound _ _ _ _ (product_bound _ _ _ _ H1 B2)
        (product_bound _ _ _ _ (Rle_refl (Rabs (t - t'))) (sum_bound _ _ _ _ Hh A2))) as Q.
      eapply Rle_trans; [exact Q|]. pose proof (Part Cx t' PC Ht').
      apply Rle_trans with ((3 * Cx + H) * Rabs (t - t')).
      * apply Rle_trans with (Rabs (t - t') * (2 * Cx + (H + Cx))); [|right; ring].
        apply Rle_trans with (Rabs (t - t') * (2 * Cx + (H + Cx * (t' * t')))); [right; ring|].
        apply Rmult_le_compat_l; [exact Pt|lra].
      * apply Rmult_le_compat_r; [exact Pt|unfold C; lra].
  - intros t P' z' Ht Nt True Hd Rim Nr High v Hv. destruct (T1 t Ht) as (_ & Hs & _ & _).
    destruct (Only t P' z' Nt True Hd Rim Nr High) as (y & Oy & Cy & Ey & Py).
    destruct (Sol _ Hs) as (_ & _ & U & _). rewrite (U y) in Py; [now apply Py| |exact Cy]. split; [exact Oy|exact Ey].
Qed.
End Motion.
