(** Near the flat sheet (docs/motion.md, section 4): the true motion that begins along a solution of K_v = 0, and how
    far the vertices of any configuration move in the plane. *)
From Coq Require Import Reals List Permutation Lra Lia Arith Bool FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Nappes Sheet Identities Star KeyLemma Flat Complex Theorems Branches
  Drawing Curve Flex Displacements Motion.
Import ListNotations.
Open Scope R_scope.

Section Near.
Variable S : sheet.
Notation at_ := (at_ S).
Notation I := (inner S).
Notation vertices := (inner S ++ rim S).
Notation F := (faces S).

(** ** The vertices of a disk *)

Lemma in_a_side v : In v vertices -> exists a, In (v, a) (sides F).
Proof.
  intros Hv. assert (St : exists s, In s (steps (fan S v))).
  { apply in_app_or in Hv. destruct Hv as [Hi|Hr].
    - destruct (inner_full S v Hi) as (u & up & p & q & down & E & _). rewrite E.
      destruct up as [|z up]; eexists; now left.
    - destruct (rim_convex S v Hr) as (u & mid & q & E & _). rewrite E. destruct mid as [|z mid]; eexists; now left. }
  destruct St as ([a b] & Hs). exists a. exact (proj1 (corner_sides F v a b (step_corner S v a b Hv Hs))).
Qed.

Lemma corner_vertices a b c : In (a, b, c) (corners F) -> In a vertices /\ In b vertices /\ In c vertices.
Proof.
  intros H. assert (R : In (b, c, a) (corners F) /\ In (c, a, b) (corners F)).
  { unfold corners in *. rewrite in_flat_map in H. destruct H as ([[x y] z] & Hf & Hc). rewrite !in_flat_map.
    simpl in Hc. destruct Hc as [E|[E|[E|[]]]]; injection E as <- <- <-; split; exists (x, y, z);
      (split; [assumption|simpl; tauto]). }
  destruct R as (R1 & R2). repeat split; eapply faces_on_vertices; eassumption.
Qed.

Lemma glued_in J vs fs : glued S J vs fs -> (forall v, In v vs -> In v vertices) /\
  forall s, In s (sides fs) -> In s (sides F).
Proof.
  assert (Side : forall a b c fs s, In (a, b, c) (corners F) -> (In s (sides fs) -> In s (sides F)) ->
    In s (sides ((a, b, c) :: fs)) -> In s (sides F)).
  { intros a b c fs0 [x y] Hc IH H. destruct (corner_sides F a b c Hc) as (S1 & S2 & S3).
    apply sides_cons in H. destruct H as [E|[E|[E|H]]]; [now rewrite E..|now apply IH]. }
  induction 1 as [a b c Hc|vs fs a b c G (IH & IS) Hc Sd New|vs fs v a b G (IH & IS) Hc _ _ _ _ _ _].
  - destruct (corner_vertices a b c Hc) as (Ha & Hb & Hd). split.
    + intros v [<-|[<-|[<-|[]]]]; assumption.
    + intros s. now apply Side.
  - destruct (corner_vertices a b c Hc) as (_ & _ & Hd). split.
    + intros v [<-|Hv]; auto.
    + intros s. apply (Side a b c); auto.
  - split; [exact IH|]. intros s. apply (Side v a b); auto.
Qed.

Hypothesis Disk : disk S I F.

(** The sheet is glued from its faces, and has all their vertices. *)
Lemma gluing : (forall v, In v I -> In v I /\ all_at S F v) /\ exists vs fs, glued S I vs fs /\
  (forall s, In s (sides F) <-> In s (sides fs)) /\ (forall v, In v vs <-> In v vertices).
Proof.
  destruct Disk as (Inside & vs & fs & G & All). split; [exact Inside|]. exists vs, fs.
  destruct (glued_in I vs fs G) as (On & Sd). split; [exact G|]. split.
  - intros s. split; [apply All|apply Sd].
  - intros v. split; [apply On|]. intros Hv. destruct (in_a_side v Hv) as (a & Ha).
    apply All in Ha. exact (proj1 (glued_on S I vs fs G v a Ha)).
Qed.

(** One vertex is held, and another one on its line with the first. *)
Variables p q : nat.
Hypothesis Hp : In p vertices.
Hypothesis Hq : In q vertices.
Hypothesis Apart : at_ p <> at_ q.
Notation d := (sub (at_ q) (at_ p)).

Lemma apart : dot d d <> 0.
Proof.
  intros E. apply dot_zero in E. apply Apart. destruct (at_ p), (at_ q). unfold sub in E. cbn [fst snd] in E.
  injection E as E1 E2. f_equal; lra.
Qed.

(** A simple solution begins a true motion of the sheet. *)
Theorem true_motion_exists h : solves S (fun _ => 0) h -> nonsingular S h ->
  exists t1 delta C P z, true_motion S I vertices F p q h t1 delta C P z.
Proof.
  intros Sol Non. destruct gluing as (Inside & vs & fs & G & Same & Vs).
  destruct (motion S I vs F fs (inner_once S) Inside G Same p q (proj2 (Vs p) Hp) (proj2 (Vs q) Hq) apart h Sol)
    as (t1 & delta & C & P & z & P1 & Pd & PC & Moves & Lip & Only).
  { intros g Zg Kg. destruct (Non zero) as (w & _ & U).
    rewrite <- (U g), <- (U zero); [reflexivity| |]; split; try easy.
    intros v Hv. apply linear_zero. intros a s b. apply K2_move. }
  exists t1, delta, C, P, z. split; [exact P1|]. split; [exact Pd|]. split; [exact PC|]. split; [exact Moves|]. split.
  - intros t t' Ht Ht' v Hv. apply Lip; try assumption. now apply Vs.
  - intros t P' z' Ht Nt True Held Rim Near High v Hv. apply Only; try assumption; try (now apply Vs).
    + intros u Hu. apply Rim. now apply Vs.
    + intros u Hu. apply Near. now apply Vs.
Qed.

(** ** Configurations near the flat sheet *)

Notation held := (Displacements.held S p q).
Notation holding := (Displacements.holding S vertices p q).

(** How far the vertices move in the plane is bounded by how much the lengths change. *)
Lemma stable_in_plane : exists C, 0 <= C /\ forall u rho, holding u ->
  (forall a b, In (a, b) (sides F) -> Rabs (widen at_ u a b) <= rho) -> forall v, bounded (C * rho) (u v).
Proof.
  destruct gluing as (_ & vs & fs & G & Same & Vs). set (U := unknowns [] vs p q).
  destruct (left_bound (sides F) U (fun e w => widen at_ (shift S p q w) (fst e) (snd e)) (unknowns_once [] vs p q))
    as (C & PC & St).
  { intros e a s b. unfold shift, move. points. ring. }
  { intros w Zw H. destruct (zero_off_parts S [] vs p q w Zw) as (W & Hw & Gw).
    rewrite (unpack S p q apart w), W. apply (pack_zero S p q apart).
    - apply (rigid_in_plane S I vs F fs G Same p q (proj2 (Vs p) Hp) (proj2 (Vs q) Hq) apart); [exact Hw|].
      intros a b Hab. exact (H (a, b) Hab).
    - intros v. apply Gw. easy. }
  exists ((Rabs (fst d) + Rabs (snd d)) * C). split.
  { apply Rmult_le_pos; [|assumption]. apply Rplus_le_le_0_compat; apply Rabs_pos. }
  intros u rho (Up & Uq & Off) W v. set (w := pack S p q 0 u zero).
  assert (Zw : zero_off U w).
  { apply zero_off_pack; [exact apart| |easy]. split; [exact Up|]. split; [exact Uq|].
    intros x Hx. apply Off. now rewrite <- Vs. }
  assert (N : norm U w <= C * rho).
  { apply St; [exact Zw|]. intros [a b] Hab. unfold widen, w. rewrite !(shift_pack S p q apart). now apply W. }
  destruct (shift_bound S p q w (C * rho) v) as (B & _).
  { intros i. eapply Rle_trans; [exact (at_norm U w i Zw)|exact N]. }
  unfold w in B. rewrite (shift_pack S p q apart) in B. now rewrite Rmult_assoc.
Qed.

Lemma load_bound : exists C, 0 <= C /\ forall c rho v, In v I -> both_ways c ->
  (forall a b, In (a, b) (sides F) -> Rabs (c a b) <= rho) -> Rabs (load S c v) <= C * rho.
Proof.
  set (k := fun v (s : nat * nat) => let e := spoke at_ v (fst s) in let e' := spoke at_ v (snd s) in
    (1 + Rabs (1 - dot e e' / dot e e) + Rabs (1 - dot e e' / dot e' e')) * Rabs (/ (2 * cross e e'))).
  assert (Pk : forall v s, 0 <= k v s).
  { intros v s. unfold k. cbv zeta. apply Rmult_le_pos; [|apply Rabs_pos].
    apply Rplus_le_le_0_compat; [apply Rplus_le_le_0_compat; [lra|]|]; apply Rabs_pos. }
  assert (Pv : forall v, 0 <= sum (steps (fan S v)) (k v)) by (intros; apply sum_nonneg; intros; apply Pk).
  exists (sum I (fun v => sum (steps (fan S v)) (k v))). split; [apply sum_nonneg; auto|].
  intros c rho v Hv Ev B. pose proof (inner_vertex S v Hv) as V.
  apply Rle_trans with (rho * sum (steps (fan S v)) (k v)).
  - rewrite <- sum_scal. eapply Rle_trans; [apply sum_abs|]. apply sum_le. intros [x y] Hs.
    destruct (corner_sides F v x y (step_corner S v x y V Hs)) as (S1 & S2 & S3).
    apply B in S1, S2, S3. rewrite Ev in S3. unfold share, k. cbv zeta. cbn [fst snd].
    set (e := spoke at_ v x). set (e' := spoke at_ v y).
    pose proof (difference_bound _ _ _ _ (difference_bound _ _ _ _ S2
      (product_bound _ _ _ _ S1 (Rle_refl (Rabs (1 - dot e e' / dot e e)))))
      (product_bound _ _ _ _ S3 (Rle_refl (Rabs (1 - dot e e' / dot e' e'))))) as Q.
    eapply Rle_trans; [exact (product_bound _ _ _ _ Q (Rle_refl (Rabs (/ (2 * cross e e')))))|]. right. ring.
  - rewrite Rmult_comm. apply Rmult_le_compat_r.
    + destruct (in_a_side v V) as (a & Ha). eapply Rle_trans; [apply Rabs_pos|exact (B v a Ha)].
    + apply (sum_ge_term I (fun v => sum (steps (fan S v)) (k v))); auto.
Qed.

(** A small multiple of a number is small. *)
Lemma small_factor A e : 0 <= A -> 0 < e -> exists delta, 0 < delta /\ forall x, 0 <= x <= delta -> A * x <= e.
Proof.
  intros PA Pe. exists (e / (A + 1)). split; [apply Rdiv_lt_0_compat; lra|]. intros x (Px & Hx).
  apply Rle_trans with ((A + 1) * (e / (A + 1))); [|right; field; lra].
  apply Rmult_le_compat; lra.
Qed.

(** Near the flat sheet: the vertices move in the plane by the square of the heights, and the curvatures of the
    heights are bounded by the fourth power. *)
Lemma settled : exists delta C, 0 < delta /\ 0 <= C /\ forall P z zeta, true_lengths at_ F P z -> held P ->
  (forall v, In v vertices -> bounded delta (sub (P v) (at_ v)) /\ Rabs (z v) <= zeta) ->
  (forall v, In v vertices -> bounded (C * (zeta * zeta)) (sub (P v) (at_ v))) /\
  forall v, In v I -> Rabs (K S v z) <= C * (zeta * zeta * (zeta * zeta)).
Proof.
  destruct stable_in_plane as (C1 & P1 & St). destruct load_bound as (C2 & P2 & Lo).
  set (n := INR (length vertices)). assert (Pn : 0 <= n) by apply pos_INR.
  assert (Pn1 : 0 <= n * C1) by now apply Rmult_le_pos.
  destruct (small_factor (16 * (n * C1)) 1) as (delta & Pd & Small); [lra|lra|].
  set (C3 := 8 * (n * C1)). assert (P3 : 0 <= C3) by (unfold C3; lra).
  assert (P33 : 0 <= C2 * (C3 * C3)) by (apply Rmult_le_pos; [|apply Rmult_le_pos]; assumption).
  exists delta, (C3 + 8 * (C2 * (C3 * C3))). split; [exact Pd|]. split; [lra|].
  intros P z zeta True (Hp0 & Hq0) Near.
  set (u := fun v => if in_dec Nat.eq_dec v vertices then sub (P v) (at_ v) else origin).
  assert (Ui : forall v, In v vertices -> u v = sub (P v) (at_ v)) by (intros v Hv; unfold u; now destruct in_dec).
  assert (Hu : holding u).
  { split; [|split].
    - rewrite (Ui p Hp), Hp0. points. f_equal; ring.
    - rewrite (Ui q Hq). rewrite <- Hq0. points. ring.
    - intros v Hv. unfold u. now destruct in_dec. }
  assert (On : forall a b, In (a, b) (sides F) -> In a vertices /\ In b vertices).
  { intros a b H. destruct gluing as (_ & vs & fs & G & Same & Vs). apply Same in H.
    destruct (glued_on S I vs fs G a b H). split; now apply Vs. }
  assert (Eq : forall a b, In (a, b) (sides F) ->
    2 * widen at_ u a b + (z b - z a) * (z b - z a) + dot (sub (u b) (u a)) (sub (u b) (u a)) = 0).
  { intros a b H. destruct (On a b H) as (Ha & Hb). specialize (True a b H).
    rewrite (length_identity at_ P z 1 u z a b) in True; try ring; [lra| |].
    - rewrite (Ui a Ha). destruct (P a). points. f_equal; ring.
    - rewrite (Ui b Hb). destruct (P b). points. f_equal; ring. }
  set (mu := extent vertices u). assert (Pmu : 0 <= mu) by apply extent_pos.
  assert (Sq : forall r s a b, In (a, b) (sides F) -> (forall v, In v vertices -> bounded r (u v)) ->
    (forall v, In v vertices -> bounded s (u v)) -> Rabs (dot (sub (u b) (u a)) (sub (u b) (u a))) <= 8 * (r * s)).
  { intros r s a b H Br Bs. destruct (On a b H) as (Ha & Hb).
    pose proof (dot_bound _ _ _ _ (sub_bound _ _ _ _ (Br b Hb) (Br a Ha)) (sub_bound _ _ _ _ (Bs b Hb) (Bs a Ha))).
    lra. }
  assert (Bd : forall v, In v vertices -> bounded delta (u v)) by (intros v Hv; rewrite (Ui v Hv); now apply Near).
  assert (Bm : forall v, In v vertices -> bounded mu (u v)) by (intros v Hv; now apply extent_at).
  assert (Wi : forall a b, In (a, b) (sides F) -> Rabs (widen at_ u a b) <= 4 * (delta * mu) + 2 * (zeta * zeta)).
  { intros a b H. destruct (On a b H) as (Ha & Hb). pose proof (Sq delta mu a b H Bd Bm) as Q.
    destruct (Near a Ha) as (_ & Za). destruct (Near b Hb) as (_ & Zb).
    pose proof (product_bound _ _ _ _ (difference_bound _ _ _ _ Zb Za) (difference_bound _ _ _ _ Zb Za)) as Q'.
    pose proof (sum_bound _ _ _ _ Q Q') as Q2. replace (widen at_ u a b) with
      (- / 2 * (dot (sub (u b) (u a)) (sub (u b) (u a)) + (z b - z a) * (z b - z a))) by (specialize (Eq a b H); lra).
    rewrite Rabs_mult, Rabs_Ropp, (Rabs_right (/ 2)) by lra. lra. }
  assert (Mu : mu <= C3 * (zeta * zeta)).
  { assert (M : mu <= n * (2 * (C1 * (4 * (delta * mu) + 2 * (zeta * zeta))))).
    { apply sum_const_le. intros v _. destruct (St u _ Hu Wi v) as (A & A'). lra. }
    assert (16 * (n * C1) * delta * mu <= 1 * mu) by (apply Rmult_le_compat_r; [assumption|apply Small; lra]).
    unfold C3. lra. }
  assert (Bz : forall v, In v vertices -> bounded (C3 * (zeta * zeta)) (u v)).
  { intros v Hv. destruct (Bm v Hv). split; lra. }
  assert (Pz : 0 <= zeta * zeta) by (pose proof (Rle_0_sqr zeta) as Q; exact Q). split.
  - intros v Hv. rewrite <- (Ui v Hv). destruct (Bz v Hv) as (A & A').
    assert (0 <= C2 * (C3 * C3) * (zeta * zeta)) by now apply Rmult_le_pos. split; lra.
  - intros v Hv. destruct (proj1 Disk v Hv) as (_ & At).
    set (sq := fun a b => dot (sub (u b) (u a)) (sub (u b) (u a))).
    assert (Ev : both_ways sq) by (intros a b; unfold sq; points; ring).
    assert (E : load S (fun x y => - / 2 * ((z y - z x) * (z y - z x))) v =
      load S (fun x y => widen at_ u x y + / 2 * sq x y) v).
    { apply (load_ext S F); [apply even_heights| |exact At|].
      - intros a b. rewrite Ev, even_widen. reflexivity.
      - intros a b H. specialize (Eq a b H). unfold sq. lra. }
    rewrite load_squares, load_add, load_widen in E by assumption.
    replace (K S v z) with (load S sq v) by lra.
    eapply Rle_trans; [apply (Lo sq (8 * (C3 * (zeta * zeta) * (C3 * (zeta * zeta)))) v Hv Ev)|].
    + intros a b H. now apply Sq.
    + assert (0 <= C3 * (zeta * zeta * (zeta * zeta))) by (apply Rmult_le_pos; [|apply Rmult_le_pos]; assumption). lra.
Qed.
End Near.
