(** The test of one branch in integers: what depends on the sheet only is prepared once and verified
    once, so that a branch costs a few products for each corner of a face. *)
From Coq Require Import Reals ZArith List Lra Lia Arith Bool FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Nappes Sheet Identities Star KeyLemma Flat Theorems Branches
  Drawing Rational Certificate.
Import ListNotations.
Open Scope R_scope.

(** ** What is prepared: nothing in it is trusted *)

(** A corner of a face at a vertex, between the spokes to [left] and [right]: [scale] times its part of
    the curvature is  cross x y - square x^2 - square' y^2  for heights x, y of their ends above the
    vertex, and twice [scale] times its part of K(mountain, .) is  side x + side' y. *)
Record wedge_form := Wedge {
  left : nat; right : nat;
  mixed : Z; square : Z; square' : Z;
  side : Z; side' : Z
}.

(** An interior vertex; [scale] > 0 is a common denominator. [share] bounds what its curvature adds to
    the distance; [here] are folds that end at it. *)
Record hub := Hub {
  at_vertex : nat;
  scale : Z;
  wedges : list wedge_form;
  mountain_at : nat -> Z;
  share : Z;
  here : list nat
}.

(** The fold number [name] from [i] to [j], with the third corners [l] on its left and [m] on its
    right. Its bend, multiplied by the areas of both parallelograms, is  along x + toward_l y + toward_m z
    for heights x, y, z of j, l, m above i; it must exceed [slack2] times the distance, squared. *)
Record fold_form := Fold {
  name : nat;
  ends : nat * nat * nat * nat;
  along : Z; toward_l : Z; toward_m : Z;
  slack2 : Z
}.

(** [centre2] is twice the centre of a disk that holds the sheet, [radius4] four times its squared
    radius; distances are counted in units of 1 / [units]. *)
Record prepared := Prepared {
  hubs : list hub;
  folds : list fold_form;
  centre2 : zvector;
  radius4 : Z;
  units : Z
}.

Definition zheights := nat -> Z.
Definition reals (h : zheights) : vec := fun u => IZR (h u).

(** Curvature, and side of the mountain, of heights around a vertex with the height [x0]. *)
Fixpoint measured (h : zheights) (x0 : Z) (ws : list wedge_form) : Z * Z :=
  match ws with
  | [] => (0, 0)%Z
  | w :: ws =>
    let x := (h (left w) - x0)%Z in let y := (h (right w) - x0)%Z in
    let (k, s) := measured h x0 ws in
    (k + (x * (mixed w * y - square w * x) - square' w * (y * y)), s + (side w * x + side' w * y))%Z
  end.

Definition bent (h : zheights) (f : fold_form) : Z :=
  let '(i, j, l, m) := ends f in let x0 := h i in
  (along f * (h j - x0) + toward_l f * (h l - x0) + toward_m f * (h m - x0))%Z.

Definition letter := option bool.  (* a valley, a mountain, or not asked for *)

Definition fold_passes (h : zheights) (asked : nat -> letter) (far unit : Z) (f : fold_form) : bool :=
  match asked (name f) with
  | None => true
  | Some valley => let b := bent h f in
    (if valley then 0 <? b else b <? 0)%Z && (slack2 f * far <? unit * (b * b))%Z
  end.

Definition is_asked (asked : nat -> letter) (k : nat) : bool :=
  match asked k with Some _ => true | None => false end.

(** The bound of the distance to the solution with the same curvature at the vertices that are [kept], and
    with curvature 0 at the others; if every vertex passes. *)
Fixpoint distance_of (kept up : nat -> bool) (h : zheights) (bs : list hub) : option Z :=
  match bs with
  | [] => Some 0%Z
  | b :: bs =>
    let (k, s) := measured h (h (at_vertex b)) (wedges b) in
    if (0 <? k)%Z && (if up (at_vertex b) then 0 <? s else s <? 0)%Z
    then match distance_of kept up h bs with
      | Some far => Some (if kept (at_vertex b) then far else far + share b * k)%Z
      | None => None
      end
    else None
  end.

(** A fold at the vertex has a letter that is asked for. *)
Definition is_bent (asked : nat -> letter) (b : hub) : bool := existsb (is_asked asked) (here b).

(** The test of one branch. *)
Definition passes (p : prepared) (kept up : nat -> bool) (h : zheights) (asked : nat -> letter) : bool :=
  match distance_of kept up h (hubs p) with
  | None => false
  | Some far => forallb (fold_passes h asked far (units p)) (folds p)
  end.

(** ** What is prepared is verified *)

Section Prepared.
Variable d : drawing.
Variable p : prepared.
(** Tables: places, neighbours, whether a vertex is on the sheet, and folds by their numbers. *)
Variable at_z : nat -> zvector.
Variable fan_of : nat -> list nat.
Variable known : nat -> bool.
Variable fold_at : nat -> option fold_form.

Definition arm (v u : nat) : zvector := (fst (at_z u) - fst (at_z v), snd (at_z u) - snd (at_z v))%Z.

Definition wedge_ok (v : nat) (D : Z) (t : nat -> Z) (w : wedge_form) : bool :=
  let a := arm v (left w) in let b := arm v (right w) in
  let c := zturn a b in let s := (D * zdot a b)%Z in
  let y := (t (left w) - t v)%Z in let y' := (t (right w) - t v)%Z in
  (mixed w * c =? D)%Z && (square w * (2 * c * zdot a a) =? s)%Z && (square' w * (2 * c * zdot b b) =? s)%Z &&
  (side w =? mixed w * y' - 2 * square w * y)%Z && (side' w =? mixed w * y - 2 * square' w * y')%Z.

(** Four times the multiplier of a vertex. *)
Definition multiplier4 (v : nat) : Z :=
  let x := (2 * fst (at_z v) - fst (centre2 p))%Z in
  let y := (2 * snd (at_z v) - snd (centre2 p))%Z in (radius4 p - (x * x + y * y))%Z.

Fixpoint same_steps (ws : list wedge_form) (ss : list (nat * nat)) : bool :=
  match ws, ss with
  | [], [] => true
  | w :: ws, (a, b) :: ss => Nat.eqb (left w) a && Nat.eqb (right w) b && same_steps ws ss
  | _, _ => false
  end.

Definition touches (v k : nat) : bool :=
  match fold_at k with
  | Some f => let '(i, j, _, _) := ends f in Nat.eqb (name f) k && (Nat.eqb i v || Nat.eqb j v)
  | None => false
  end.

Definition hub_ok (b : hub) : bool :=
  let v := at_vertex b in let fan := fan_of v in let t := mountain_at b in
  (0 <? scale b)%Z && same_steps (wedges b) (steps fan) && forallb (wedge_ok v (scale b) t) (wedges b) &&
  (0 <? fst (measured t (t v) (wedges b)))%Z && forallb (fun u => t u <? t v)%Z fan &&
  (multiplier4 v * units p <=? share b * (4 * scale b))%Z && forallb (touches v) (here b).

Definition is_step (v : nat) (s : nat * nat) : bool := mem2 s (steps (fan_of v)).

Definition form_ok (f : fold_form) : bool :=
  let '(i, j, l, m) := ends f in
  let e := arm i j in let a := arm i l in let b := arm i m in
  let c := zturn e a in let c' := zturn b e in let n := zdot e e in
  known i && is_step i (j, l) && is_step i (m, j) &&
  (along f =? - (c' * zdot a e + c * zdot b e))%Z && (toward_l f =? c' * n)%Z && (toward_m f =? c * n)%Z &&
  (slack2 f =? 2 * n * (c + c') * (c * c'))%Z.

Fixpoint same_list (l l' : list nat) : bool :=
  match l, l' with
  | [], [] => true
  | a :: l, b :: l' => Nat.eqb a b && same_list l l'
  | _, _ => false
  end.

Definition prepared_ok : bool :=
  same_list (map at_vertex (hubs p)) (inside d) && forallb hub_ok (hubs p) && forallb form_ok (folds p) &&
  (0 <? units p)%Z && forallb (fun v => 0 <=? multiplier4 v)%Z (inside d ++ border d).

(** ** What they mean *)

Lemma corner_turned (fs : list face) a b c : In (a, b, c) (corners fs) -> In (b, c, a) (corners fs).
Proof.
  unfold corners. rewrite !in_flat_map. intros ([[x y] z] & Hf & Hc). exists (x, y, z). split; [assumption|].
  simpl in *. destruct Hc as [E|[E|[E|[]]]]; injection E as <- <- <-; tauto.
Qed.

Ltac inReals H := repeat rewrite ?plus_IZR, ?minus_IZR, ?mult_IZR, ?opp_IZR in H.
Ltac inGoal := repeat rewrite ?plus_IZR, ?minus_IZR, ?mult_IZR, ?opp_IZR.

Hypothesis ok : check d = true.
Hypothesis at_eq : at_z = place d.
Hypothesis fan_eq : fan_of = fun v => nth v (fans_of d) [].
Hypothesis known_in : forall v, known v = true -> In v (inside d ++ border d).
Hypothesis fold_in : forall k f, fold_at k = Some f -> In f (folds p).
Notation S := (sheet_of d ok).

Lemma arm_eq : arm = zspoke d.
Proof. unfold arm, zspoke. now rewrite at_eq. Qed.

Lemma same_list_eq l l' : same_list l l' = true -> l = l'.
Proof.
  revert l'. induction l as [|a l IH]; intros [|b l']; simpl; try easy.
  rewrite andb_true_iff, Nat.eqb_eq. intros (-> & H). now rewrite (IH l' H).
Qed.

Lemma wedge_R v D t w (x y : R) : In v (inside d ++ border d) ->
  In (left w, right w) (steps (nth v (fans_of d) [])) -> wedge_ok v D t w = true ->
  let a := spoke (at_ S) v (left w) in let b := spoke (at_ S) v (right w) in
  x * (IZR (mixed w) * y - IZR (square w) * x) - IZR (square' w) * (y * y) = IZR D * wedge2 a b x y x y /\
  IZR (side w) * x + IZR (side' w) * y =
    2 * IZR D * wedge2 a b (IZR (t (left w)) - IZR (t v)) (IZR (t (right w)) - IZR (t v)) x y.
Proof.
  intros Hv Hs W. pose proof (step_left S v _ _ Hv Hs) as C. cbv zeta. unfold wedge_ok in W. rewrite arm_eq in W.
  rewrite !(spoke_R d ok) in *. set (A := zspoke d v (left w)) in *. set (B := zspoke d v (right w)) in *.
  apply Rgt_not_eq in C. pose proof (cross_left _ _ C) as M. pose proof (cross_right _ _ C) as M'.
  unfold wedge2. rewrite !dot_R, turn_R in *. rewrite !andb_true_iff, !Z.eqb_eq in W.
  destruct W as ((((W1 & W2) & W3) & W4) & W5). apply (f_equal IZR) in W1, W2, W3, W4, W5.
  inReals W1. inReals W2. inReals W3. inReals W4. inReals W5.
  assert (E1 : IZR (mixed w) = IZR D / IZR (zturn A B)) by (rewrite <- W1; field; assumption).
  assert (E2 : IZR (square w) = IZR D * IZR (zdot A B) / (2 * IZR (zturn A B) * IZR (zdot A A)))
    by (rewrite <- W2; field; split; assumption).
  assert (E3 : IZR (square' w) = IZR D * IZR (zdot A B) / (2 * IZR (zturn A B) * IZR (zdot B B)))
    by (rewrite <- W3; field; split; assumption).
  rewrite W4, W5, E1, E2, E3. split; field; repeat split; assumption.
Qed.

Lemma measured_R v D t h ws ss : In v (inside d ++ border d) ->
  (forall s, In s ss -> In s (steps (nth v (fans_of d) []))) ->
  same_steps ws ss = true -> forallb (wedge_ok v D t) ws = true ->
  let k := fun g h => sum ss (fun s => let '(a, b) := s in
    wedge2 (spoke (at_ S) v a) (spoke (at_ S) v b) (g a - g v) (g b - g v) (h a - h v) (h b - h v)) in
  IZR (fst (measured h (h v) ws)) = IZR D * k (reals h) (reals h) /\
  IZR (snd (measured h (h v) ws)) = 2 * IZR D * k (reals t) (reals h).
Proof.
  intros Hv. revert ss. induction ws as [|w ws IH]; intros [|[a b] ss]; try easy.
  { intros _ _ _. cbn [measured fst snd sum]. split; ring. }
  intros Sub. cbn [same_steps forallb]. rewrite !andb_true_iff, !Nat.eqb_eq. intros ((Ea & Eb) & Ss) (W & Ws).
  specialize (IH ss (fun s Hs => Sub s (or_intror Hs)) Ss Ws). cbv zeta in IH |- *. destruct IH as (IH1 & IH2).
  subst a b. pose proof (Sub _ (or_introl eq_refl)) as Hs.
  destruct (wedge_R v D t w (reals h (left w) - reals h v) (reals h (right w) - reals h v) Hv Hs W) as (W1 & W2).
  cbn [measured]. destruct (measured h (h v) ws) as (k, s). cbn [fst snd sum] in *.
  unfold reals in *. inReals IH1. inGoal.
  rewrite IH1, IH2, !Rmult_plus_distr_l, <- W1, <- W2. split; ring.
Qed.

Lemma hub_means b : prepared_ok = true -> In b (hubs p) -> In (at_vertex b) (inside d) /\ hub_ok b = true.
Proof.
  unfold prepared_ok. rewrite !andb_true_iff, !forallb_forall. intros ((((Same & Hb) & _) & _) & _) In_b.
  split; [|now apply Hb]. rewrite <- (same_list_eq _ _ Same). now apply in_map.
Qed.

(** What a vertex that passes shows. *)
Lemma hub_R b (up : nat -> bool) h : prepared_ok = true -> In b (hubs p) ->
  let v := at_vertex b in let (k, s) := measured h (h v) (wedges b) in
  IZR k = IZR (scale b) * K S v (reals h) /\
  ((0 < k)%Z -> (if up v then 0 < s else s < 0)%Z ->
    0 < K S v (reals h) /\ 0 < sign (up v) * K2 S v (cone S v) (reals h)).
Proof.
  intros Ok Hb. destruct (hub_means b Ok Hb) as (Hi & H). cbv zeta. set (v := at_vertex b) in *.
  assert (Hv : In v (inside d ++ border d)) by (apply in_or_app; now left).
  unfold hub_ok in H. fold v in H. rewrite fan_eq in H. rewrite !andb_true_iff, !forallb_forall in H.
  destruct H as ((((((Ps & Ss) & Ws) & Pt) & Down) & _) & Near).
  rewrite <- forallb_forall in Ws. apply Z.ltb_lt, IZR_lt in Ps.
  set (t := mountain_at b) in *.
  pose proof (measured_R v (scale b) t h (wedges b) (steps (nth v (fans_of d) [])) Hv (fun s Hs => Hs) Ss Ws) as M.
  pose proof (measured_R v (scale b) t t (wedges b) (steps (nth v (fans_of d) [])) Hv (fun s Hs => Hs) Ss Ws) as Mt.
  cbv zeta in M, Mt. destruct Mt as (Mt & _). apply Z.ltb_lt, IZR_lt in Pt. rewrite Mt in Pt.
  destruct (measured h (h v) (wedges b)) as (k, s). cbn [fst snd] in M. destruct M as (Mk & Msd).
  change (IZR k = IZR (scale b) * K2 S v (reals h) (reals h)) in Mk.
  change (IZR s = 2 * IZR (scale b) * K2 S v (reals t) (reals h)) in Msd.
  change (0 < IZR (scale b) * K2 S v (reals t) (reals t)) in Pt.
  assert (Pt' : 0 < K2 S v (reals t) (reals t)).
  { apply (Rmult_lt_reg_l (IZR (scale b))); [assumption|].
    now rewrite Rmult_0_r. }
  split; [now rewrite <- K_polar_sheet by assumption|]. intros Pk Sd.
  assert (Pk' : 0 < K2 S v (reals h) (reals h)).
  { apply IZR_lt in Pk. rewrite Mk in Pk. apply (Rmult_lt_reg_l (IZR (scale b))); [assumption|].
    now rewrite Rmult_0_r. }
  split; [now rewrite <- K_polar_sheet by assumption|].
  apply (side_by_mountain S v (reals t)); try assumption.
  - intros u Hu. unfold reals. apply IZR_lt, Z.ltb_lt. now apply Down.
  - assert (Two : 0 < 2 * IZR (scale b)) by lra.
    apply (Rmult_lt_reg_l (2 * IZR (scale b))); [assumption|]. rewrite Rmult_0_r.
    destruct (up v); apply IZR_lt in Sd; rewrite Msd in Sd; unfold sign; lra.
Qed.

(** A vertex that is bent has a fold whose letter is asked for. *)
Lemma bent_means b asked : prepared_ok = true -> In b (hubs p) -> is_bent asked b = true ->
  exists f i j l m valley, In f (folds p) /\ ends f = (i, j, l, m) /\ asked (name f) = Some valley /\
    (i = at_vertex b \/ j = at_vertex b).
Proof.
  intros Ok Hb As. destruct (hub_means b Ok Hb) as (_ & H). unfold hub_ok in H.
  rewrite !andb_true_iff, !forallb_forall in H. destruct H as (_ & Near).
  apply existsb_exists in As. destruct As as (x & Hx & As). specialize (Near x Hx). unfold touches in Near.
  destruct (fold_at x) as [f|] eqn:Hf; [|discriminate]. destruct (ends f) as [[[i j] l] m] eqn:E.
  rewrite andb_true_iff, orb_true_iff, !Nat.eqb_eq in Near. destruct Near as (Nm & T).
  unfold is_asked in As. destruct (asked x) as [valley|] eqn:A; [|easy].
  exists f, i, j, l, m, valley. rewrite Nm. repeat split; try assumption. now apply (fold_in x).
Qed.

Lemma distance_means (kept up : nat -> bool) h far :
  prepared_ok = true -> distance_of kept up h (hubs p) = Some far ->
  (forall v, In v (inside d) -> 0 < K S v (reals h) /\ 0 < sign (up v) * K2 S v (cone S v) (reals h)) /\
  sum (inside d) (fun v => if kept v then 0 else IZR (multiplier4 v) * K S v (reals h)) <=
    4 * IZR far / IZR (units p).
Proof.
  intros Ok. assert (Pu : 0 < IZR (units p)).
  { pose proof Ok as O. unfold prepared_ok in O. rewrite !andb_true_iff in O. destruct O as ((_ & O) & _).
    now apply IZR_lt, Z.ltb_lt. }
  assert (E : inside d = map at_vertex (hubs p)).
  { pose proof Ok as O. unfold prepared_ok in O. rewrite !andb_true_iff in O. destruct O as ((((O & _) & _) & _) & _).
    symmetry. now apply same_list_eq. }
  rewrite E, sum_map. assert (Sub : forall b, In b (hubs p) -> In b (hubs p)) by auto.
  revert Sub far. generalize (hubs p) at 1 3 4 5. induction l as [|b l IH]; intros Sub far.
  { intros [= <-]. split; [easy|]. cbn [sum]. unfold Rdiv. lra. }
  cbn [distance_of map sum].
  pose proof (hub_R b up h Ok (Sub b (or_introl eq_refl))) as M. cbv zeta in M.
  destruct (hub_means b Ok (Sub b (or_introl eq_refl))) as (_ & H).
  destruct (measured h (h (at_vertex b)) (wedges b)) as (k, s). destruct M as (Mk & M).
  destruct (_ && _) eqn:C; [|discriminate]. rewrite andb_true_iff in C. destruct C as (Pk & Sd).
  destruct (distance_of kept up h l) as [rest|] eqn:D; [|discriminate]. intros [= <-].
  destruct (IH (fun c Hc => Sub c (or_intror Hc)) rest eq_refl) as (All & Far).
  apply Z.ltb_lt in Pk.
  assert (Sd' : (if up (at_vertex b) then 0 < s else s < 0)%Z) by (destruct (up (at_vertex b)); now apply Z.ltb_lt).
  destruct (M Pk Sd') as (PK & M').
  split.
  - intros v [<-|Hv]; [now split|]. now apply All.
  - unfold hub_ok in H. rewrite !andb_true_iff in H. destruct H as ((((((Ps & _) & _) & _) & _) & W) & _).
    apply Z.ltb_lt, IZR_lt in Ps. apply Z.leb_le, IZR_le in W. rewrite !mult_IZR in W.
    destruct (kept (at_vertex b)); [lra|]. rewrite plus_IZR, mult_IZR, Mk.
    set (w := IZR (multiplier4 (at_vertex b))) in *. set (u := IZR (units p)) in *.
    set (D' := IZR (scale b)) in *. set (K0 := K S (at_vertex b) (reals h)) in *. set (om := IZR (share b)) in *.
    replace (4 * (IZR rest + om * (D' * K0)) / u) with (om * (4 * D') * K0 / u + 4 * IZR rest / u)
      by (field; lra).
    apply Rplus_le_compat; [|exact Far].
    apply (Rmult_le_reg_r u); [assumption|].
    replace (om * (4 * D') * K0 / u * u) with (om * (4 * D') * K0) by (field; lra).
    replace (w * K0 * u) with (w * u * K0) by ring. apply Rmult_le_compat_r; lra.
Qed.

Lemma mem2_step v a b : is_step v (a, b) = true -> In (a, b) (steps (fan S v)).
Proof. unfold is_step. rewrite fan_eq. intros H. now apply mem2_in in H. Qed.

(** The bend of a fold, from either end. *)
Lemma tilt_turned i j l h : cross (spoke (at_ S) i j) (spoke (at_ S) i l) <> 0 -> tilt S j l i h = tilt S i j l h.
Proof.
  intros C. unfold tilt, gradient, Sheet.spoke, sub, cross in *. cbn [fst snd] in *.
  set (x := fst (at_ S i)) in *. set (y := snd (at_ S i)) in *. set (x1 := fst (at_ S j)) in *.
  set (y1 := snd (at_ S j)) in *. set (x2 := fst (at_ S l)) in *. set (y2 := snd (at_ S l)) in *.
  assert (C' : (x2 - x1) * (y - y1) - (y2 - y1) * (x - x1) <> 0) by (intros E; apply C; lra).
  f_equal; field; repeat split; assumption.
Qed.

Lemma bend_turned i j l m h : In (i, j, l) (corners (faces S)) -> In (i, m, j) (corners (faces S)) ->
  bend S j i m l h = bend S i j l m h.
Proof.
  intros H1 H2. pose proof (face_of_corner S _ _ _ H1) as C1. pose proof (face_of_corner S _ _ _ H2) as C2.
  unfold bend. rewrite (tilt_turned i j l h) by lra.
  assert (C3 : cross (spoke (at_ S) m j) (spoke (at_ S) m i) <> 0).
  { intros E. unfold cross, Sheet.spoke, sub in *. cbn [fst snd] in *. lra. }
  rewrite (tilt_turned m j i h C3), (tilt_turned i m j h) by lra.
  unfold dot, sub, J, Sheet.spoke. unfold sub. cbn [fst snd]. ring.
Qed.

Lemma bent_R h f i j l m : ends f = (i, j, l, m) -> form_ok f = true ->
  In (i, j, l) (corners (faces S)) /\ In (i, m, j) (corners (faces S)) /\
  (let s := spoke (at_ S) in let c := cross (s i j) (s i l) in let c' := cross (s i m) (s i j) in
   IZR (bent h f) = c * c' * bend S i j l m (reals h) /\
   IZR (slack2 f) = 2 * dot (s i j) (s i j) * (c + c') * (c * c')).
Proof.
  intros E H. unfold form_ok in H. rewrite E in H. rewrite !andb_true_iff in H.
  destruct H as ((((((Hi & S1) & S2) & A) & L) & M) & Sl). apply known_in in Hi. rewrite arm_eq in *.
  apply mem2_step in S1, S2. apply (step_corner S i _ _ Hi) in S1, S2.
  split; [assumption|]. split; [assumption|]. cbv zeta.
  pose proof (face_of_corner S _ _ _ S1) as C1. pose proof (face_of_corner S _ _ _ S2) as C2.
  rewrite !Z.eqb_eq in *. apply (f_equal IZR) in A, L, M, Sl.
  unfold bent. rewrite E. unfold bend, tilt, gradient, reals.
  rewrite !(spoke_R d ok) in *. rewrite !dot_R, !turn_R in *.
  inReals A. inReals L. inReals M. inReals Sl.
  set (e := zspoke d i j) in *. set (a := zspoke d i l) in *. set (b := zspoke d i m) in *.
  split.
  - rewrite ?plus_IZR, ?mult_IZR, ?minus_IZR, A, L, M. unfold dot, sub, J, to_point. cbn [fst snd].
    unfold zdot. inGoal. rewrite turn_R in C1, C2 || idtac. field.
    split; lra.
  - rewrite Sl. ring.
Qed.

(** The folds with letters that are asked for, from both ends. *)
Definition asked_folds (asked : nat -> letter) : list (nat * nat * nat * nat * bool) :=
  flat_map (fun f => match asked (name f) with
    | Some valley => let '(i, j, l, m) := ends f in [(i, j, l, m, valley); (j, i, m, l, valley)]
    | None => []
    end) (folds p).

(** What passes the test is proved: exactly one solution with these heights of the rim, and with these
    curvatures at the vertices that are kept, lies in these closed nappes; it has these signs where it is
    bent, and its folds have the letters asked for. *)
Theorem passed (kept up : nat -> bool) h asked : prepared_ok = true -> passes p kept up h asked = true ->
  let k := fun v => if kept v then K S v (reals h) else 0 in
  (forall v, In v (inside d) -> 0 < K S v (reals h)) /\
  exists g, has_rim S (reals h) g /\ solves S k g /\ in_nappes S up g /\
    (forall b, In b (hubs p) -> is_bent asked b = true ->
      0 < sign (up (at_vertex b)) * K2 S (at_vertex b) (cone S (at_vertex b)) g) /\
    (forall g', has_rim S (reals h) g' -> solves S k g' -> in_nappes S up g' -> g' = g) /\
    (forall f i j l m valley, In f (folds p) -> ends f = (i, j, l, m) -> asked (name f) = Some valley ->
      0 < sign valley * bend S i j l m g).
Proof.
  intros Ok. unfold passes. destruct (distance_of kept up h (hubs p)) as [far|] eqn:D; [|discriminate].
  rewrite forallb_forall. intros Fs. destruct (distance_means kept up h far Ok D) as (Vs & Far).
  split; [intros v Hv; now apply Vs|].
  pose proof Ok as O. unfold prepared_ok in O. rewrite !andb_true_iff, !forallb_forall in O.
  destruct O as (((_ & Forms) & Pu) & Ws). apply Z.ltb_lt, IZR_lt in Pu.
  set (c := (IZR (fst (centre2 p)) / 2, IZR (snd (centre2 p)) / 2) : point).
  assert (Weight : forall v, multiplier S c (IZR (radius4 p) / 4) v = IZR (multiplier4 v) / 4).
  { intros v. unfold multiplier, multiplier4, c, dot, sub. rewrite at_eq.
    cbn [fst snd at_ sheet_of]. unfold at_R. cbn [fst snd].
    inGoal. field. }
  assert (Fold : forall f i j l m valley, In f (folds p) -> ends f = (i, j, l, m) -> asked (name f) = Some valley ->
    In (i, j, l) (corners (faces S)) /\ In (i, m, j) (corners (faces S)) /\
    0 < sign valley * bend S i j l m (reals h) /\
    (let s := spoke (at_ S) in
     dot (s i j) (s i j) * (2 / cross (s i j) (s i l) + 2 / cross (s i m) (s i j)) * (IZR far / IZR (units p)) <
       bend S i j l m (reals h) * bend S i j l m (reals h))).
  { intros f i j l m valley Hf E As. destruct (bent_R h f i j l m E (Forms f Hf)) as (C1 & C2 & B & Sl).
    specialize (Fs f Hf). unfold fold_passes in Fs. rewrite As, andb_true_iff in Fs. destruct Fs as (Sg & Big).
    split; [assumption|]. split; [assumption|].
    pose proof (face_of_corner S _ _ _ C1) as P1. pose proof (face_of_corner S _ _ _ C2) as P2.
    cbv zeta in B, Sl |- *. set (a := cross (spoke (at_ S) i j) (spoke (at_ S) i l)) in *.
    set (b := cross (spoke (at_ S) i m) (spoke (at_ S) i j)) in *.
    set (n := dot (spoke (at_ S) i j) (spoke (at_ S) i j)) in *. set (w := bend S i j l m (reals h)) in *.
    assert (Pab : 0 < a * b) by now apply Rmult_lt_0_compat.
    apply Z.ltb_lt, IZR_lt in Big. rewrite !mult_IZR, B, Sl in Big. split.
    - apply (Rmult_lt_reg_l (a * b)); [assumption|]. rewrite Rmult_0_r.
      destruct valley; apply Z.ltb_lt, IZR_lt in Sg; rewrite B in Sg; unfold sign; lra.
    - apply (Rmult_lt_reg_l (a * b * (a * b) * IZR (units p))); [repeat apply Rmult_lt_0_compat; assumption|].
      replace (_ * (w * w)) with (IZR (units p) * (a * b * w * (a * b * w))) by ring.
      replace (_ * _) with (2 * n * (a + b) * (a * b) * IZR far) by (field; lra). exact Big. }
  destruct (near_solution S up kept (reals h) c (IZR (radius4 p) / 4) (IZR far / IZR (units p)) (asked_folds asked))
    as (g & Gr & Gs & Gn & Sg & U & _ & Lt).
  - intros v Hv. now apply Vs.
  - intros v Hv. rewrite Weight. specialize (Ws v Hv). apply Z.leb_le, IZR_le in Ws. lra.
  - rewrite (sum_ext _ _ (fun v => / 4 * (if kept v then 0 else IZR (multiplier4 v) * K S v (reals h)))).
    + rewrite sum_scal. unfold Rdiv in *. change (inner S) with (inside d). lra.
    + intros v _. rewrite Weight. destruct (kept v); field.
  - intros i j l m valley Hf. unfold asked_folds in Hf. apply in_flat_map in Hf. destruct Hf as (f & Hf & Hc).
    destruct (asked (name f)) as [w|] eqn:As; [|easy]. destruct (ends f) as [[[i0 j0] l0] m0] eqn:E.
    destruct (Fold f i0 j0 l0 m0 w Hf E As) as (C1 & C2 & Sg & Big).
    destruct Hc as [[= <- <- <- <- <-]|[[= <- <- <- <- <-]|[]]]; [now repeat split|].
    assert (R1 : In (j0, i0, m0) (corners (faces S))) by now apply corner_turned, corner_turned.
    assert (R2 : In (j0, l0, i0) (corners (faces S))) by now apply corner_turned.
    split; [assumption|]. split; [assumption|]. rewrite (bend_turned i0 j0 l0 m0) by assumption.
    split; [assumption|]. cbv zeta in Big |- *.
    replace (dot (spoke (at_ S) j0 i0) (spoke (at_ S) j0 i0)) with (dot (spoke (at_ S) i0 j0) (spoke (at_ S) i0 j0))
      by (unfold dot, Sheet.spoke, sub; cbn [fst snd]; ring).
    replace (cross (spoke (at_ S) j0 i0) (spoke (at_ S) j0 m0)) with (cross (spoke (at_ S) i0 m0) (spoke (at_ S) i0 j0))
      by (unfold cross, Sheet.spoke, sub; cbn [fst snd]; ring).
    replace (cross (spoke (at_ S) j0 l0) (spoke (at_ S) j0 i0)) with (cross (spoke (at_ S) i0 j0) (spoke (at_ S) i0 l0))
      by (unfold cross, Sheet.spoke, sub; cbn [fst snd]; ring).
    rewrite (Rplus_comm (2 / cross (spoke (at_ S) i0 m0) (spoke (at_ S) i0 j0))). exact Big.
  - exists g. split; [assumption|]. split; [assumption|]. split; [assumption|]. split; [|split; [assumption|]].
    + intros b Hb Bn. destruct (bent_means b asked Ok Hb Bn) as (f & i & j & l & m & w & Hf & E & A & T).
      destruct (hub_means b Ok Hb) as (Hi & _).
      destruct T as [T|T]; [apply (Sg _ j l m w Hi)|apply (Sg _ i m l w Hi)];
        apply in_flat_map; exists f; (split; [assumption|]); rewrite A, E, <- T; simpl; tauto.
    + intros f i j l m valley Hf E As. apply Lt, in_flat_map. exists f. split; [assumption|]. rewrite As, E. now left.
Qed.
End Prepared.
