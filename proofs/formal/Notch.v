(** Sheets with a reflex corner (docs/theorem.md, section 4). A triangle closes the notch: its corner [r]
    becomes a vertex inside, whose curvature is not asked to vanish, and three corners are left. *)
From Coq Require Import Reals List Lra Lia Arith FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Nappes Sheet Identities Star KeyLemma Flat Complex Theorems Branches.
Import ListNotations.
Open Scope R_scope.

(** Complex square roots. *)
Lemma complex_root x y : exists p q, p * p - q * q = x /\ 2 * (p * q) = y.
Proof.
  set (m := sqrt (x * x + y * y)).
  assert (Pm : 0 <= x * x + y * y) by (pose proof (Rle_0_sqr x); pose proof (Rle_0_sqr y); unfold Rsqr in *; lra).
  assert (Mm : m * m = x * x + y * y) by now apply sqrt_sqrt.
  assert (P0 : 0 <= m) by apply sqrt_pos.
  assert (A : Rabs x <= m) by (apply abs_le_root; pose proof (Rle_0_sqr y); unfold Rsqr in *; lra).
  assert (Hp : 0 <= (m + x) / 2) by (pose proof (Rle_abs (- x)); rewrite Rabs_Ropp in *; lra).
  assert (Hq : 0 <= (m - x) / 2) by (pose proof (Rle_abs x); lra).
  set (p := sqrt ((m + x) / 2)). set (q := sqrt ((m - x) / 2)).
  assert (Pp : p * p = (m + x) / 2) by now apply sqrt_sqrt.
  assert (Qq : q * q = (m - x) / 2) by now apply sqrt_sqrt.
  assert (Pq : 0 <= 2 * (p * q)) by (pose proof (sqrt_pos ((m + x) / 2)); pose proof (sqrt_pos ((m - x) / 2));
    pose proof (Rmult_le_pos p q); unfold p, q in *; lra).
  assert (Sq : 2 * (p * q) = Rabs y).
  { apply Rsqr_inj; [assumption|apply Rabs_pos|]. rewrite <- Rsqr_abs. unfold Rsqr.
    replace (2 * (p * q) * (2 * (p * q))) with (4 * ((p * p) * (q * q))) by ring. rewrite Pp, Qq.
    replace (4 * ((m + x) / 2 * ((m - x) / 2))) with (m * m - x * x) by field. lra. }
  destruct (Rle_lt_dec 0 y) as [H|H].
  - exists p, q. rewrite Rabs_right in Sq by lra. split; lra.
  - exists p, (- q). rewrite Rabs_left in Sq by lra. split; lra.
Qed.

(** Solutions that are chosen one for each of a list, and differ. *)
Lemma chosen {A B} (P : A -> B -> Prop) t : (forall e, exists h, P e h) -> NoDup t ->
  (forall e e' h, In e t -> In e' t -> P e h -> P e' h -> e = e') ->
  exists l, length l = length t /\ NoDup l /\ (forall h, In h l -> exists e, In e t /\ P e h) /\
    forall e, In e t -> exists h, In h l /\ P e h.
Proof.
  intros Ex. induction t as [|e t IH]; intros D Dif; [exists []; repeat split; try constructor; easy|].
  inversion D as [|? ? N D']; subst.
  destruct IH as (l & Len & Dl & From & To); [assumption|intros; eapply Dif; simpl; eauto|].
  destruct (Ex e) as (h & Hh). exists (h :: l). repeat split.
  - simpl. now rewrite Len.
  - constructor; [|assumption]. intros Hin. destruct (From h Hin) as (e' & He' & Pe').
    apply N. rewrite (Dif e e' h); simpl; auto.
  - intros g [<-|Hg]; [exists e; simpl; auto|]. destruct (From g Hg) as (e' & ? & ?). exists e'. simpl. auto.
  - intros e' [<-|He]; [exists h; simpl; auto|]. destruct (To e' He) as (g & ? & ?). exists g. simpl. auto.
Qed.

Section Notch.
Variable S : sheet.
Variables b1 b2 b3 r : nat.
Notation at_ := (at_ S).
Notation I := (inner S).
Notation vertices := (inner S ++ rim S).
Hypothesis Rim : rim S = [b1; b2; b3].
Hypothesis Corners : cross (sub (at_ b2) (at_ b1)) (sub (at_ b3) (at_ b1)) <> 0.
Hypothesis Hr : In r I.

(** The vertices inside the sheet with the notch. *)
Definition others : list nat := filter (fun v => negb (Nat.eqb v r)) I.

Lemma others_in v : In v others <-> In v I /\ v <> r.
Proof. unfold others. rewrite filter_In. destruct (Nat.eqb_spec v r); simpl; intuition congruence. Qed.

(** Complex solutions of K_v = 0 there. *)
Definition open_solution (z : cvec) : Prop := forall v, In v others -> KC S v z = real 0.

(** Curvature 1 at [r], 0 elsewhere. *)
Definition one_at (v : nat) : R := if Nat.eqb v r then 1 else 0.

(** The representative of a branch: three corners are pinned, and [r] pops up and has curvature 1. *)
Definition raised (h : vec) : Prop :=
  has_rim S zero h /\ solves S one_at h /\ 0 < K2 S r (cone S r) h.

Lemma one_at_nonneg v : 0 <= one_at v.
Proof. unfold one_at. destruct (Nat.eqb v r); lra. Qed.

Lemma one_at_r : one_at r = 1.
Proof. unfold one_at. now rewrite Nat.eqb_refl. Qed.

Lemma one_at_other v : v <> r -> one_at v = 0.
Proof. intros N. unfold one_at. apply Nat.eqb_neq in N. now rewrite N. Qed.

(** [r] is not neutral where its curvature is positive. *)
Lemma r_pops h : 0 < K S r h -> K2 S r (cone S r) h <> 0.
Proof. intros P O. pose proof (L S r (cone S r) h Hr (cone_positive S r Hr) O). lra. Qed.

Lemma K2_times v s g h : K2 S v g (fun u => s * h u) = s * K2 S v g h.
Proof.
  replace (fun u => s * h u) with (move zero s h) by vec.
  rewrite K2_move, (linear_zero (K2 S v g)) by (intros x y z; apply K2_move). ring.
Qed.

Lemma K_times v s h : In v I -> K S v (fun u => s * h u) = s * s * K S v h.
Proof.
  intros Hv. apply inner_vertex in Hv. rewrite <- !K_polar_sheet by assumption.
  rewrite K2_times, K2_sym, K2_times. ring.
Qed.

Lemma nonzero_solution z : open_solution z -> KC S r z <> real 0 -> exists s h, raised h /\ on_branch S z s h.
Proof.
  intros Sol N0.
  destruct (interpolate S b1 b2 b3 (re_part z) Corners) as (c & g & A1 & A2 & A3).
  destruct (interpolate S b1 b2 b3 (im_part z) Corners) as (c' & g' & B1 & B2 & B3).
  set (a := minus (re_part z) (affine S c g)). set (b := minus (im_part z) (affine S c' g')).
  assert (R : forall u, In u (rim S) -> a u = 0 /\ b u = 0).
  { intros u Hu. rewrite Rim in Hu. unfold a, b, minus. simpl in Hu.
    destruct Hu as [<-|[<-|[<-|[]]]]; lra. }
  assert (Zs : forall u, z u = (a u + affine S c g u, b u + affine S c' g' u)).
  { intros u. unfold a, b, minus, re_part, im_part, re, im. destruct (z u). cbn [fst snd]. f_equal; ring. }
  assert (KCz : forall v, In v I -> KC S v z = (K S v a - K S v b, 2 * K2 S v a b)).
  { intros v Hv. rewrite KC_parts by now apply inner_vertex. unfold a, b. now rewrite !K_affine, K2_affine. }
  assert (Kab : forall v, In v others -> K S v a = K S v b /\ K2 S v a b = 0).
  { intros v Hv. pose proof (Sol v Hv) as E. apply others_in in Hv. rewrite KCz in E by apply Hv.
    unfold real in E. injection E as E1 E2. lra. }
  rewrite (KCz r Hr) in N0.
  destruct (complex_root (K S r a - K S r b) (2 * K2 S r a b)) as (p & q & Pq & Pq2).
  set (m := p * p + q * q).
  assert (M0 : m <> 0).
  { intros E. apply N0. assert (p * p = 0 /\ q * q = 0) as (Ep & Eq).
    { pose proof (Rle_0_sqr p). pose proof (Rle_0_sqr q). unfold m, Rsqr in *. split; lra. }
    assert (p = 0) by (apply Rsqr_0_uniq; exact Ep).
    rewrite <- Pq, <- Pq2, Ep, Eq, H. unfold real. f_equal; ring. }
  set (a' := fun u => p / m * a u + q / m * b u). set (b' := fun u => - q / m * a u + p / m * b u).
  set (z' := fun u => if in_dec Nat.eq_dec u I then (a' u, b' u) else real 0 : complex).
  assert (Val : forall u, In u vertices -> re_part z' u = a' u /\ im_part z' u = b' u).
  { intros u Hu. unfold re_part, im_part, z'. destruct in_dec as [|Nu]; [easy|].
    apply in_app_or in Hu. destruct Hu as [|Hu]; [contradiction|]. destruct (R u Hu) as (Ea & Eb).
    unfold a', b', real, re, im. cbn [fst snd]. rewrite Ea, Eb. split; ring. }
  assert (Kz : forall v, In v I -> KC S v z' = real (one_at v)).
  { intros v Hv. rewrite KC_parts by now apply inner_vertex.
    rewrite (K_vertices S v (re_part z') a'), (K_vertices S v (im_part z') b'),
      (K2_vertices S v (re_part z') a' (im_part z') b');
      try assumption; try (intros u Hu; now apply Val).
    rewrite <- (K_polar_sheet S v a'), <- (K_polar_sheet S v b') by now apply inner_vertex.
    unfold a', b'. rewrite !K2_combine2 by assumption. unfold real.
    destruct (Nat.eq_dec v r) as [->|N].
    - rewrite one_at_r. set (x := K S r a) in *. set (y := K S r b) in *. set (w := K2 S r a b) in *.
      assert (Ex : x = y + (p * p - q * q)) by lra. assert (Ew : w = p * q) by lra.
      f_equal; rewrite Ex, Ew; unfold m in *; field; assumption.
    - rewrite one_at_other by assumption. destruct (Kab v) as (E1 & E2); [now apply others_in|].
      rewrite E1, E2. f_equal; field; assumption. }
  assert (Im : forall u, im (z' u) = 0).
  { apply (all_real S one_at zero); [intros; apply one_at_nonneg| |assumption].
    intros u Hu. unfold z'. now destruct in_dec. }
  set (h := re_part z').
  assert (Hh : solves S one_at h).
  { intros v Hv. destruct (KC_equation S v z' _ Hv (Kz v Hv)) as (E1 & _). unfold h. rewrite E1.
    replace (im_part z') with zero by (apply functional_extensionality; intro; symmetry; apply Im).
    rewrite <- (K_polar_sheet S v zero) by now apply inner_vertex.
    rewrite (linear_zero (K2 S v zero)) by (intros x s y; apply K2_move). ring. }
  assert (Rh : has_rim S zero h) by (intros u Hu; unfold h, re_part, z'; now destruct in_dec).
  assert (Parts : forall u, In u vertices -> a u = p * h u /\ b u = q * h u).
  { intros u Hu. destruct (Val u Hu) as (Ea & Eb). fold h in Ea. rewrite Ea.
    assert (Ib : b' u = 0) by (rewrite <- Eb; apply Im).
    assert (Xa : a u = p * a' u - q * b' u) by (unfold a', b', m in *; field; assumption).
    assert (Xb : b u = q * a' u + p * b' u) by (unfold a', b', m in *; field; assumption).
    rewrite Ib in Xa, Xb. rewrite Xa at 1. rewrite Xb at 1. split; ring. }
  assert (Pr : 0 < K S r h) by (rewrite (Hh r Hr), one_at_r; lra).
  pose proof (r_pops h Pr) as Side.
  assert (Flip : exists t, t * t = 1 /\ 0 < t * K2 S r (cone S r) h).
  { destruct (Rle_lt_dec 0 (K2 S r (cone S r) h)); [exists 1|exists (-1)]; split; lra. }
  destruct Flip as (t & Tt & Up).
  exists (t * p, t * q), (fun u => t * h u). split; [split; [|split]|split].
  - intros u Hu. rewrite (Rh u Hu). unfold zero. ring.
  - intros v Hv. rewrite K_times, Tt, (Hh v Hv) by assumption. ring.
  - now rewrite K2_times.
  - intros E. injection E as E1 E2. apply M0. unfold m.
    replace (p * p + q * q) with (t * t * (p * p + q * q)) by (rewrite Tt; ring).
    replace (t * t * (p * p + q * q)) with ((t * p) * (t * p) + (t * q) * (t * q)) by ring.
    rewrite E1, E2. ring.
  - exists c, g, c', g'. intros u Hu. destruct (Parts u Hu) as (Ea & Eb).
    rewrite Zs, Ea, Eb. unfold csub, cmul, real, re, im. cbn [fst snd].
    replace (t * p * (t * h u)) with (t * t * (p * h u)) by ring.
    replace (t * q * (t * h u)) with (t * t * (q * h u)) by ring.
    rewrite Tt. f_equal; ring.
Qed.

(** Every solution, real or complex, is flat or on the branch of a real representative. *)
Theorem open_solution_on_a_branch z : open_solution z ->
  complex_affine S z \/ exists s h, raised h /\ on_branch S z s h.
Proof.
  intros Sol.
  assert (D : KC S r z = real 0 \/ KC S r z <> real 0).
  { destruct (KC S r z) as (x, y). unfold real. destruct (Req_dec x 0) as [->|N]; [|right; congruence].
    destruct (Req_dec y 0) as [->|N]; [now left|right; congruence]. }
  destruct D as [E|N]; [left|right; now apply nonzero_solution].
  apply (rigid S b1 b2 b3 z Rim Corners). intros v Hv. destruct (Nat.eq_dec v r) as [->|N]; [assumption|].
  apply Sol. now apply others_in.
Qed.

(** A branch has one representative. *)
Theorem branch_has_one_raised z s s' h h' : raised h -> raised h' ->
  on_branch S z s h -> on_branch S z s' h' -> h' = h.
Proof.
  intros (Rh & Sh & Up) (Rh' & Sh' & Up') (Ns & c & g & d & k & E) (Ns' & c' & g' & d' & k' & E').
  assert (Rb : forall b, In b (rim S) -> h b = 0 /\ h' b = 0).
  { intros b Hb. split; [apply Rh|apply Rh']; now apply rim_not_inner. }
  assert (D : forall u, In u vertices ->
    re s * h u - re s' * h' u = - affine S (c - c') (fst g - fst g', snd g - snd g') u /\
    im s * h u - im s' * h' u = - affine S (d - d') (fst k - fst k', snd k - snd k') u).
  { intros u Hu. specialize (E u Hu). specialize (E' u Hu).
    unfold csub, cmul, real, re, im in *. cbn [fst snd] in *. injection E as Ea Eb. injection E' as Ea' Eb'.
    unfold affine, dot in *. cbn [fst snd]. split; lra. }
  assert (Z : forall b, In b (rim S) -> affine S (c - c') (fst g - fst g', snd g - snd g') b = 0 /\
    affine S (d - d') (fst k - fst k', snd k - snd k') b = 0).
  { intros b Hb. destruct (D b) as (X & X'); [apply in_or_app; now right|]. destruct (Rb b Hb) as (Y & Y').
    rewrite Y, Y' in X, X'. lra. }
  assert (In1 : In b1 (rim S)) by (rewrite Rim; simpl; auto).
  assert (In2 : In b2 (rim S)) by (rewrite Rim; simpl; auto).
  assert (In3 : In b3 (rim S)) by (rewrite Rim; simpl; auto).
  assert (Za : forall u, affine S (c - c') (fst g - fst g', snd g - snd g') u = 0)
    by (apply (affine_zero S b1 b2 b3 _ _ Corners); now apply Z).
  assert (Zb : forall u, affine S (d - d') (fst k - fst k', snd k - snd k') u = 0)
    by (apply (affine_zero S b1 b2 b3 _ _ Corners); now apply Z).
  assert (T : exists t, forall u, h' u = t * h u).
  { assert (All : forall u, re s * h u = re s' * h' u /\ im s * h u = im s' * h' u).
    { intros u. destruct (in_dec Nat.eq_dec u I) as [Hu|Hu].
      - destruct (D u (inner_vertex S u Hu)) as (X & X'). rewrite Za in X. rewrite Zb in X'. lra.
      - rewrite (Rh u Hu), (Rh' u Hu). unfold zero. lra. }
    destruct (Req_dec (re s') 0) as [Rz|Rz].
    - assert (Iz : im s' <> 0). { intros Iz. apply Ns'. unfold real, re, im in *. destruct s'. cbn in *. now subst. }
      exists (im s / im s'). intros u. destruct (All u) as (_ & X).
      apply (Rmult_eq_reg_l (im s')); [|assumption]. rewrite <- X. field. assumption.
    - exists (re s / re s'). intros u. destruct (All u) as (X & _).
      apply (Rmult_eq_reg_l (re s')); [|assumption]. rewrite <- X. field. assumption. }
  destruct T as (t & Ht). assert (Ht' : h' = fun u => t * h u) by (apply functional_extensionality; exact Ht).
  pose proof (Sh' r Hr) as K'. rewrite Ht', K_times, (Sh r Hr), one_at_r, Rmult_1_r in K' by assumption.
  rewrite Ht', K2_times in Up'.
  assert (T1 : t = 1).
  { assert (Pt : 0 < t) by (apply (Rmult_lt_reg_r (K2 S r (cone S r) h)); [assumption|lra]).
    assert (F : (t - 1) * (t + 1) = 0) by lra. apply Rmult_integral in F. destruct F; lra. }
  rewrite Ht', T1. apply functional_extensionality. intros u. ring.
Qed.

(** The signs [e] inside, and [r] up. *)
Definition with_r (e : nat -> bool) (v : nat) : bool := if Nat.eqb v r then true else e v.

(** The vertex signs of [h] are those of [e] inside the sheet with the notch, and no vertex is neutral. *)
Definition has_open_signs (e : nat -> bool) (h : vec) : Prop :=
  forall v, In v others -> 0 < sign (e v) * K2 S v (cone S v) h.

Lemma raised_nappes e h : raised h -> (forall v, In v others -> 0 <= sign (e v) * K2 S v (cone S v) h) ->
  in_nappes S (with_r e) h.
Proof.
  intros (_ & Sh & Up) Sg v Hv. rewrite (Sh v Hv). split; [apply one_at_nonneg|].
  unfold with_r. destruct (Nat.eqb_spec v r) as [->|N]; [simpl; lra|]. apply Sg. now apply others_in.
Qed.

Lemma one_raised e : exists! h, raised h /\ in_nappes S (with_r e) h.
Proof.
  destruct (one_solution_per_sign_vector S one_at zero (with_r e)) as (h & (Rh & Sh & Nh) & U).
  { intros. apply one_at_nonneg. }
  exists h. split.
  - split; [|assumption]. split; [assumption|]. split; [assumption|].
    assert (Pr : 0 < K S r h) by (rewrite (Sh r Hr), one_at_r; lra).
    pose proof (r_pops h Pr). destruct (Nh r Hr) as (_ & P). unfold with_r in P.
    rewrite Nat.eqb_refl in P. simpl in P. lra.
  - intros g ((Rg & Sg & _) & Ng). now apply U.
Qed.

(** If no star is flat on any branch, there are exactly 2^n branches, n the number of vertices inside the
    sheet with the notch; all are real, and each sign vector of these vertices belongs to exactly one. *)
Theorem notched : (forall h, raised h -> forall v, In v others -> ~ flat_star S v h) ->
  exists l : list vec, length l = (2 ^ length others)%nat /\ NoDup l /\
    (forall h, In h l <-> raised h) /\
    (forall h, In h l -> nonsingular S h) /\
    (forall e, exists! h, In h l /\ has_open_signs e h) /\
    (forall z, open_solution z -> complex_affine S z \/
       exists h, In h l /\ (exists s, on_branch S z s h) /\
         forall h' s', In h' l -> on_branch S z s' h' -> h' = h).
Proof.
  intros NF.
  assert (Reg : forall h, raised h -> regular S h).
  { intros h Rh v Hv. pose proof Rh as (_ & Sh & _). rewrite (Sh v Hv). destruct (Nat.eq_dec v r) as [->|N].
    - left. rewrite one_at_r. lra.
    - right. split; [now apply one_at_other|]. apply NF; [assumption|now apply others_in]. }
  assert (One : forall e, exists! h, raised h /\ has_open_signs e h).
  { intros e. destruct (one_raised e) as (h & (Rh & Nh) & U). exists h. split.
    - split; [assumption|]. intros v Hv. apply others_in in Hv. destruct Hv as (Hv & N).
      destruct (Nh v Hv) as (_ & P). unfold with_r in P. apply Nat.eqb_neq in N. rewrite N in P.
      pose proof (regular_sign S h v (Reg h Rh) Hv) as N0. destruct (e v); simpl in *; lra.
    - intros g (Rg & Sg). apply U. split; [assumption|]. apply raised_nappes; [assumption|].
      intros v Hv. apply Rlt_le. now apply Sg. }
  assert (Dif : forall e e' h, In e (sign_vectors others) -> In e' (sign_vectors others) ->
    raised h /\ has_open_signs e h -> raised h /\ has_open_signs e' h -> e = e').
  { intros e e' h He He' (_ & Sg) (_ & Sg'). apply functional_extensionality. intros u.
    destruct (in_dec Nat.eq_dec u others) as [Hu|Hu].
    - specialize (Sg u Hu). specialize (Sg' u Hu). destruct (e u), (e' u); simpl in *; try reflexivity; lra.
    - now rewrite (sign_vectors_off others e u He Hu), (sign_vectors_off others e' u He' Hu). }
  assert (Once : NoDup others) by (apply NoDup_filter, inner_once).
  destruct (chosen (fun e h => raised h /\ has_open_signs e h) (sign_vectors others)) as (l & Len & D & From & To).
  { intros e. destruct (One e) as (h & Hh & _). now exists h. }
  { now apply sign_vectors_once. }
  { exact Dif. }
  assert (Rep : forall h, In h l <-> raised h).
  { intros h. split; [intros Hh; destruct (From h Hh) as (e & _ & Rh & _); exact Rh|].
    intros Rh. set (e := fun v => if in_dec Nat.eq_dec v others then signs_of S h v else false).
    assert (He : In e (sign_vectors others)).
    { apply sign_vectors_all. intros u Hu. unfold e. now destruct in_dec. }
    assert (Sg : has_open_signs e h).
    { intros v Hv. unfold e. destruct in_dec as [_|]; [|contradiction]. apply others_in in Hv. destruct Hv as (Hv & _).
      assert (Pos : forall u, In u I -> 0 <= K S u h).
      { intros u Hu. destruct Rh as (_ & Sh & _). rewrite (Sh u Hu). apply one_at_nonneg. }
      destruct (signs_of_nappes S h Pos v Hv) as (_ & P). pose proof (regular_sign S h v (Reg h Rh) Hv) as N0.
      destruct (signs_of S h v); simpl in *; lra. }
    destruct (To e He) as (g & Hg & Rg). destruct (One e) as (x & _ & U).
    replace h with g; [assumption|]. rewrite <- (U g Rg), <- (U h); [reflexivity|now split]. }
  exists l. split; [now rewrite Len, sign_vectors_length|]. split; [assumption|]. split; [exact Rep|]. split; [|split].
  - intros h Hh. apply jacobian_nonsingular, Reg. now apply Rep.
  - intros e. destruct (One e) as (h & (Rh & Sg) & U). exists h. split; [split; [now apply Rep|assumption]|].
    intros g (Hg & Gs). apply U. split; [now apply Rep|assumption].
  - intros z Hz. destruct (open_solution_on_a_branch z Hz) as [|(s & h & Rh & Oh)]; [now left|right].
    exists h. split; [now apply Rep|]. split; [now exists s|].
    intros h' s' Hh' Oh'. apply Rep in Hh'. exact (branch_has_one_raised z s s' h h' Rh Hh' Oh Oh').
Qed.
End Notch.
