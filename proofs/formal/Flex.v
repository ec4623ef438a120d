(** What the equations mean (statement 2 of docs/mathematics.md): heights h satisfy K_v(h) = 0 at all vertices
    inside if and only if they extend to a motion (U + t^2 u, t h) that keeps all lengths to second order.
    That the sheet is a disk is used through an order in which its faces can be glued to each other. *)
From Coq Require Import Reals List Permutation Lra Lia Arith Bool.
From Exactfold Require Import Sums Vectors Nappes Sheet Identities Star KeyLemma Flat Drawing Tables.
Import ListNotations.
Open Scope R_scope.

(** The coefficient of t^2 in the change of the squared length between two vertices. *)
Definition stretch (at_ : nat -> point) (h : vec) (u : nat -> point) (a b : nat) : R :=
  2 * dot (sub (at_ b) (at_ a)) (sub (u b) (u a)) + (h b - h a) * (h b - h a).

(** How fast the spoke from [v] to [a] turns in the plane. *)
Definition turning (at_ : nat -> point) (u : nat -> point) (v a : nat) : R :=
  dot (sub (u a) (u v)) (J (spoke at_ v a)) / dot (spoke at_ v a) (spoke at_ v a).

(** Half of the change of the squared length between two vertices that move by [u] in the plane, to first order. *)
Definition widen (at_ : nat -> point) (u : nat -> point) (a b : nat) : R := dot (sub (at_ b) (at_ a)) (sub (u b) (u a)).

(** What a face gives to the sum of numbers [c] on the edges at [v], times the wheel stress of [v]. *)
Definition share (at_ : nat -> point) (c : nat -> nat -> R) (v a b : nat) : R :=
  let d := spoke at_ v a in let d' := spoke at_ v b in
  (c a b - c v a * (1 - dot d d' / dot d d) - c v b * (1 - dot d d' / dot d' d')) / (2 * cross d d').

(** Of lengths it is how much the angle grows, of heights the curvature. *)
Lemma share_widen at_ u v a b : cross (spoke at_ v a) (spoke at_ v b) <> 0 ->
  share at_ (widen at_ u) v a b = / 2 * (turning at_ u v b - turning at_ u v a).
Proof.
  intros C. pose proof (cross_left _ _ C) as M. pose proof (cross_right _ _ C) as M'.
  unfold share, widen, turning, spoke, sub, cross, dot, J in *. cbn [fst snd] in *. field. auto.
Qed.

Lemma share_heights at_ g h v a b : cross (spoke at_ v a) (spoke at_ v b) <> 0 ->
  share at_ (fun x y => (g y - g x) * (h y - h x)) v a b =
    - wedge2 (spoke at_ v a) (spoke at_ v b) (g a - g v) (g b - g v) (h a - h v) (h b - h v).
Proof.
  intros C. pose proof (cross_left _ _ C) as M. pose proof (cross_right _ _ C) as M'. cbv zeta.
  unfold share. set (d := spoke at_ v a) in *. set (d' := spoke at_ v b) in *. unfold wedge2.
  clearbody d d'. field. auto.
Qed.

Section Flex.
Variable S : sheet.
Notation at_ := (at_ S).
Notation spoke := (spoke at_).

(** The motion keeps the lengths of the sides of these faces, to second order. *)
Definition keeps (fs : list face) (h : vec) (u : nat -> point) : Prop :=
  forall a b, In (a, b) (sides fs) -> stretch at_ h u a b = 0.

Lemma corner_sides fs v a b : In (v, a, b) (corners fs) ->
  In (v, a) (sides fs) /\ In (a, b) (sides fs) /\ In (b, v) (sides fs).
Proof.
  unfold sides, corners. intros H. apply in_flat_map in H. destruct H as ([[x y] z] & Hf & Hc).
  rewrite !in_map_iff.
  assert (All : forall c, In c [(x, y, z); (y, z, x); (z, x, y)] ->
    In c (flat_map (fun f : face => let '(a, b, c) := f in [(a, b, c); (b, c, a); (c, a, b)]) fs)).
  { intros c Hc'. apply in_flat_map. exists (x, y, z). now split. }
  simpl in Hc. destruct Hc as [E|[E|[E|[]]]]; injection E as <- <- <-.
  - repeat split; [exists (x, y, z)|exists (y, z, x)|exists (z, x, y)];
      (split; [reflexivity|apply All; simpl; tauto]).
  - repeat split; [exists (y, z, x)|exists (z, x, y)|exists (x, y, z)];
      (split; [reflexivity|apply All; simpl; tauto]).
  - repeat split; [exists (z, x, y)|exists (x, y, z)|exists (y, z, x)];
      (split; [reflexivity|apply All; simpl; tauto]).
Qed.

Lemma around v : In v (inner S) -> exists z l, fan S v = z :: l ++ [z].
Proof.
  intros Hi. destruct (inner_full S v Hi) as (z & up & p & q & down & F & _).
  exists z, (up ++ p :: q :: down). rewrite F, <- app_assoc. reflexivity.
Qed.

(** The sum of numbers [c] on the edges, times the wheel stress of [v]. *)
Definition load (c : nat -> nat -> R) (v : nat) : R :=
  sum (steps (fan S v)) (fun s => let '(a, b) := s in share at_ c v a b).

Lemma load_add c s c' v : load (fun a b => c a b + s * c' a b) v = load c v + s * load c' v.
Proof.
  unfold load. rewrite <- sum_scal, <- sum_plus. apply sum_ext. intros [a b] _. unfold share, Rdiv. ring.
Qed.

Lemma load_widen u v : In v (inner S) -> load (widen at_ u) v = 0.
Proof.
  intros Hi. unfold load. rewrite (sum_ext _ _ (fun s => - / 2 * (let '(a, b) := s in
    turning at_ u v a - turning at_ u v b))).
  - destruct (around v Hi) as (z & l & F). rewrite sum_scal, F, (telescope (turning at_ u v)). ring.
  - intros [a b] Hs. rewrite share_widen; [ring|]. pose proof (step_left S v a b (inner_vertex S v Hi) Hs). lra.
Qed.

Lemma load_heights g h v : In v (inner S) -> load (fun x y => (g y - g x) * (h y - h x)) v = - K2 S v g h.
Proof.
  intros Hi. replace (- K2 S v g h) with (-1 * K2 S v g h) by ring. unfold load, K2. rewrite <- sum_scal.
  apply sum_ext. intros [a b] Hs. rewrite share_heights; [ring|].
  pose proof (step_left S v a b (inner_vertex S v Hi) Hs). lra.
Qed.

(** The faces are all those at [v]. *)
Definition all_at (fs : list face) (v : nat) : Prop :=
  forall s, In s (steps (fan S v)) -> In (v, fst s, snd s) (corners fs).

Definition both_ways (c : nat -> nat -> R) : Prop := forall a b, c b a = c a b.

Lemma share_ext fs c c' v a b : both_ways c -> both_ways c' -> (forall x y, In (x, y) (sides fs) -> c x y = c' x y) ->
  In (v, a, b) (corners fs) -> share at_ c v a b = share at_ c' v a b.
Proof.
  intros Ev Ev' E Hc. destruct (corner_sides fs v a b Hc) as (S1 & S2 & S3). unfold share.
  now rewrite (E _ _ S1), (E _ _ S2), (Ev b v), (Ev' b v), (E _ _ S3).
Qed.

Lemma load_ext fs c c' v : both_ways c -> both_ways c' -> all_at fs v ->
  (forall x y, In (x, y) (sides fs) -> c x y = c' x y) -> load c v = load c' v.
Proof. intros Ev Ev' All E. apply sum_ext. intros [a b] Hs. apply (share_ext fs); try assumption. exact (All _ Hs).
Qed.

Lemma even_widen u : both_ways (widen at_ u).
Proof. intros a b. unfold widen, dot, sub. cbn [fst snd]. ring. Qed.
Lemma even_heights s (g h : vec) : both_ways (fun x y => s * ((g y - g x) * (h y - h x))).
Proof. intros a b. ring. Qed.

Lemma keeps_widen fs h u : keeps fs h u <->
  forall a b, In (a, b) (sides fs) -> widen at_ u a b = - / 2 * ((h b - h a) * (h b - h a)).
Proof. unfold keeps, stretch, widen. split; intros H a b Hs; specialize (H a b Hs); lra. Qed.

Lemma load_squares h v : In v (inner S) -> load (fun x y => - / 2 * ((h y - h x) * (h y - h x))) v = / 2 * K S v h.
Proof.
  intros Hi. rewrite <- K_polar_sheet by now apply inner_vertex.
  transitivity (load (fun x y => 0 + - / 2 * ((h y - h x) * (h y - h x))) v).
  - apply sum_ext. intros [a b] _. unfold share, Rdiv. ring.
  - rewrite (load_add (fun _ _ => 0)), load_heights by assumption.
    replace (load (fun _ _ => 0) v) with 0; [ring|]. symmetry. apply sum_zero. intros [a b] _. unfold share, Rdiv.
    ring.
Qed.

(** A motion that keeps all lengths has curvature 0. *)
Theorem flex_curvature fs h u v : keeps fs h u -> In v (inner S) -> all_at fs v -> K S v h = 0.
Proof.
  intros Kp Hi All. rewrite keeps_widen in Kp.
  pose proof (load_ext fs _ _ v (even_widen u) (even_heights _ h h) All Kp) as E.
  rewrite load_widen, load_squares in E by assumption. lra.
Qed.

(** ** Gluing

    [glued vs fs]: the faces [fs] with the vertices [vs] are glued one by one: each has a new vertex and one
    side in common with those before it, or it closes the star of a vertex in [J]. *)
Variable J : list nat.

Inductive glued : list nat -> list face -> Prop :=
| glued_first a b c : In (a, b, c) (corners (faces S)) -> glued [a; b; c] [(a, b, c)]
| glued_tip vs fs a b c : glued vs fs -> In (a, b, c) (corners (faces S)) ->
    In (a, b) (sides fs) \/ In (b, a) (sides fs) -> ~ In c vs -> glued (c :: vs) ((a, b, c) :: fs)
| glued_close vs fs v a b : glued vs fs -> In (v, a, b) (corners (faces S)) -> In v (inner S) -> In v J ->
    In (v, a) (sides fs) \/ In (a, v) (sides fs) -> In (v, b) (sides fs) \/ In (b, v) (sides fs) ->
    (forall s, In s (steps (fan S v)) -> s = (a, b) \/ In (v, fst s, snd s) (corners fs)) ->
    In (a, b) (steps (fan S v)) -> glued vs ((v, a, b) :: fs).

Lemma sides_cons a b c fs x y : In (x, y) (sides ((a, b, c) :: fs)) ->
  (x, y) = (a, b) \/ (x, y) = (b, c) \/ (x, y) = (c, a) \/ In (x, y) (sides fs).
Proof. unfold sides, corners. simpl. intuition congruence. Qed.

Lemma in_sides_cons f fs s : In s (sides fs) -> In s (sides (f :: fs)).
Proof. destruct f as [[a b] c]. unfold sides, corners. simpl. tauto. Qed.

Lemma glued_on vs fs : glued vs fs -> forall x y, In (x, y) (sides fs) -> In x vs /\ In y vs.
Proof.
  induction 1 as [a b c _|vs fs a b c _ IH _ Sd _|vs fs v a b _ IH _ _ _ S1 S2 _ _]; intros x y H.
  - apply sides_cons in H. destruct H as [E|[E|[E|[]]]]; injection E as -> ->; simpl; auto.
  - assert (Hab : In a vs /\ In b vs) by (destruct Sd as [Sd|Sd]; apply IH in Sd; tauto).
    apply sides_cons in H. destruct H as [E|[E|[E|H]]]; [injection E as -> ->; simpl; tauto..|].
    apply IH in H. simpl. tauto.
  - assert (Hva : In v vs /\ In a vs) by (destruct S1 as [S1|S1]; apply IH in S1; tauto).
    assert (Hb : In b vs) by (destruct S2 as [S2|S2]; apply IH in S2; tauto).
    apply sides_cons in H. destruct H as [E|[E|[E|H]]]; [injection E as -> ->; tauto..|]. now apply IH.
Qed.

Lemma corner_left a b c : In (a, b, c) (corners (faces S)) -> 0 < cross (spoke c a) (spoke c b).
Proof.
  intros H. pose proof (face_of_corner S _ _ _ H) as C. unfold Sheet.spoke, sub, cross in *. cbn [fst snd] in *. lra.
Qed.

(** The third vertex of a face, if those of one side have moved. *)
Lemma tip_moves (u : nat -> point) x y a b c : cross (spoke c a) (spoke c b) <> 0 ->
  exists w : point, dot (spoke c a) (sub (u a) w) = x /\ dot (spoke c b) (sub (u b) w) = y.
Proof.
  intros C. set (d := spoke c a) in *. set (d' := spoke c b) in *.
  set (p := dot d (u a) - x). set (q := dot d' (u b) - y). exists (gradient d d' p q).
  pose proof (gradient_left d d' p q C) as L. pose proof (gradient_right d d' p q C) as R. clearbody d d'.
  set (g := gradient d d' p q) in *. clearbody g. unfold p, q in *. unfold dot, sub in *. cbn [fst snd] in *.
  split; lra.
Qed.

Lemma sum_one {A} (l : list A) (f : A -> R) s : In s l -> (forall t, In t l -> t = s \/ f t = 0) ->
  sum l f = 0 -> f s = 0.
Proof.
  intros Hs Z E.
  assert (Cnt : forall l, (forall t, In t l -> t = s \/ f t = 0) -> exists k : nat, sum l f = INR k * f s /\
    (In s l -> f s = 0 \/ (0 < k)%nat)).
  { clear. induction l as [|t l IH]; intros Z.
    - exists 0%nat. split; [simpl; ring|easy].
    - destruct IH as (k & E & P); [intros; apply Z; now right|]. destruct (Z t (or_introl eq_refl)) as [->|Zt].
      + exists (Datatypes.S k). split; [rewrite S_INR; simpl sum; rewrite E; ring|]. intros _. right. lia.
      + exists k. split; [simpl sum; rewrite E, Zt; ring|]. intros [->|Hs]; [now left|auto]. }
  destruct (Cnt l Z) as (k & Ek & P). destruct (P Hs) as [|Pk]; [assumption|]. rewrite Ek in E.
  apply Rmult_integral in E. destruct E as [E|]; [|assumption]. apply lt_0_INR in Pk. lra.
Qed.

Lemma distinct a b c : In (a, b, c) (corners (faces S)) -> a <> c /\ b <> c /\ a <> b.
Proof.
  intros Hc. pose proof (face_of_corner S _ _ _ Hc) as C. unfold Sheet.spoke, sub, cross in C. cbn [fst snd] in C.
  repeat split; intros ->; lra.
Qed.

(** Changes of the lengths that are 0 times all wheel stresses come from a motion in the plane: face by face. *)
Lemma glued_moves c : both_ways c -> (forall v, In v J -> load c v = 0) ->
  forall vs fs, glued vs fs -> exists u, forall a b, In (a, b) (sides fs) -> widen at_ u a b = c a b.
Proof.
  intros Ev Z. set (moved := fun fs u => forall a b, In (a, b) (sides fs) -> widen at_ u a b = c a b).
  assert (Rev : forall u a b, widen at_ u b a = c b a -> widen at_ u a b = c a b)
    by (intros u a b H; now rewrite <- (even_widen u a b), H, Ev).
  assert (Tip : forall vs fs u x y z, moved fs u -> (forall a b, In (a, b) (sides fs) -> In a vs /\ In b vs) ->
    In (x, y, z) (corners (faces S)) -> widen at_ u x y = c x y -> ~ In z vs -> exists u',
      moved ((x, y, z) :: fs) u').
  { intros vs fs u x y z Kp On Hc Xy New. destruct (distinct x y z Hc) as (Nx & Ny & _).
    destruct (tip_moves u (c z x) (c z y) x y z) as (w & W & W'); [pose proof (corner_left x y z Hc); lra|].
    set (u' := fun v => if Nat.eq_dec v z then w else u v). exists u'.
    assert (Uz : u' z = w) by (unfold u'; destruct (Nat.eq_dec z z); [reflexivity|easy]).
    assert (U : forall v, v <> z -> u' v = u v) by (intros v N; unfold u'; destruct (Nat.eq_dec v z);
      [contradiction|reflexivity]).
    intros a b H. apply sides_cons in H. destruct H as [E|[E|[E|H]]]; try (injection E as -> ->).
    - unfold widen. now rewrite !U.
    - apply Rev. unfold widen. now rewrite U, Uz.
    - unfold widen. now rewrite U, Uz.
    - destruct (On a b H) as (Ha & Hb). unfold widen. rewrite !U by (intros ->; contradiction). now apply Kp. }
  induction 1 as [x y z Hc|vs fs x y z G (u & Kp) Hc Sd New|vs fs v x y G (u & Kp) Hc Hi Hj S1 S2 Others Hs].
  - (* the first face: two vertices as they are wanted, and the tip *)
    destruct (distinct x y z Hc) as (Nx & Ny & Nxy). set (d := sub (at_ y) (at_ x)).
    assert (M : dot d d <> 0).
    { pose proof (face_of_corner S _ _ _ Hc) as C. apply (cross_left _ (spoke x z)). unfold d, Sheet.spoke in *.
      lra. }
    set (u := fun v => if Nat.eq_dec v y then (c x y / dot d d * fst d, c x y / dot d d * snd d) else (0, 0)).
    apply (Tip [x; y] [] u x y z); try assumption; try easy.
    + unfold widen, u. destruct (Nat.eq_dec y y), (Nat.eq_dec x y); try contradiction. fold d.
      unfold sub, dot in *. cbn [fst snd] in *. field. assumption.
    + simpl. intuition congruence.
  - apply (Tip vs fs u x y z); try assumption; [now apply glued_on|]. destruct Sd; [|apply Rev]; now apply Kp.
  - exists u. pose proof (inner_vertex S v Hi) as Hv.
    assert (Vx : widen at_ u v x = c v x) by (destruct S1; [|apply Rev]; now apply Kp).
    assert (Vy : widen at_ u v y = c v y) by (destruct S2; [|apply Rev]; now apply Kp).
    pose proof (step_left S v x y Hv Hs) as C.
    assert (W : share at_ c v x y + -1 * share at_ (widen at_ u) v x y = 0).
    { set (f := fun s : nat * nat => let '(a, b) := s in share at_ c v a b + -1 * share at_ (widen at_ u) v a b).
      apply (sum_one (steps (fan S v)) f (x, y) Hs).
      - intros [a b] Hab. destruct (Others _ Hab) as [E|E]; [now left|right]. cbn [fst snd] in E. unfold f.
        rewrite (share_ext fs c (widen at_ u) v a b Ev (even_widen u)); [ring| |exact E]. intros. symmetry.
        now apply Kp.
      - transitivity (load c v + -1 * load (widen at_ u) v).
        + unfold load. rewrite <- sum_scal, <- sum_plus. apply sum_ext. intros [a b] _. reflexivity.
        + rewrite load_widen, Z by assumption. ring. }
    assert (Xy : widen at_ u x y = c x y).
    { unfold share in W. rewrite Vx, Vy in W. apply (Rmult_eq_reg_r (/ (2 * cross (spoke v x) (spoke v y)))).
      - unfold Rdiv in W. lra.
      - apply Rinv_neq_0_compat. lra. }
    intros a b H. apply sides_cons in H. destruct H as [E|[E|[E|H]]]; try (injection E as -> ->);
      [assumption|assumption|now apply Rev|now apply Kp].
Qed.

(** Heights with curvature 0 move. *)
Lemma glued_flex h : (forall v, In v J -> In v (inner S)) -> (forall v, In v J -> K S v h = 0) ->
  forall vs fs, glued vs fs -> exists u, keeps fs h u.
Proof.
  intros Sub Z vs fs G. destruct (glued_moves _ (even_heights (- / 2) h h)) with (2 := G) as (u & Hu).
  - intros v Hv. rewrite load_squares by auto. rewrite (Z v Hv). ring.
  - exists u. now rewrite keeps_widen.
Qed.

(** A disk of the faces [F] with the vertices [J] inside: all faces can be glued. *)
Definition disk (F : list face) : Prop := (forall v, In v J -> In v (inner S) /\ all_at F v) /\
  exists vs fs, glued vs fs /\ forall s, In s (sides F) -> In s (sides fs).

Theorem flex_iff F h : disk F -> ((forall v, In v J -> K S v h = 0) <-> exists u, keeps F h u).
Proof.
  intros (Inside & vs & fs & G & All). split.
  - intros Z. destruct (glued_flex h (fun v Hv => proj1 (Inside v Hv)) Z vs fs G) as (u & Kp). exists u.
    intros a b H. now apply Kp, All.
  - intros (u & Kp) v Hv. destruct (Inside v Hv). now apply (flex_curvature F h u v).
Qed.
End Flex.

(** ** A disk, decided by computation *)

Section Glue.
Variable d : drawing.
Variable J : list nat.

Definition has_face (c : face) (fs : list face) : bool :=
  existsb (fun f => let '(x, y, z) := f in let '(a, b, e) := c in Nat.eqb a x && Nat.eqb b y && Nat.eqb e z) fs.
Definition has_side (a b : nat) (fs : list face) : bool := mem2 (a, b) (sides fs) || mem2 (b, a) (sides fs).

Lemma has_face_in c fs : has_face c fs = true -> In c fs.
Proof.
  unfold has_face. rewrite existsb_exists. intros ([[x y] z] & H & E). destruct c as [[a b] e].
  rewrite !andb_true_iff, !Nat.eqb_eq in E. destruct E as ((-> & ->) & ->). exact H.
Qed.

Lemma has_side_in a b fs : has_side a b fs = true -> In (a, b) (sides fs) \/ In (b, a) (sides fs).
Proof. unfold has_side. rewrite orb_true_iff, !mem2_in. tauto. Qed.

(** Faces in the reverse of the order in which they are glued, with whether they close a star. *)
Fixpoint glue (ms : list (bool * face)) : option (list nat * list face) :=
  match ms with
  | [] => None
  | (closing, (a, b, c)) :: rest =>
    if has_face (a, b, c) (corners (triangles d)) then
      match glue rest with
      | None => match rest with [] => Some ([a; b; c], [(a, b, c)]) | _ => None end
      | Some (vs, fs) =>
        let star := steps (nth a (fans_of d) []) in
        if closing then
          if mem a (inside d) && mem a J && has_side a b fs && has_side a c fs && mem2 (b,
            c) star && forallb (fun s =>
            (Nat.eqb (fst s) b && Nat.eqb (snd s) c) || has_face (a, fst s, snd s) (corners fs)) star
          then Some (vs, (a, b, c) :: fs) else None
        else if has_side a b fs && negb (mem c vs) then Some (c :: vs, (a, b, c) :: fs) else None
      end
    else None
  end.

Definition is_disk (F : list face) (ms : list (bool * face)) : bool :=
  forallb (fun v => mem v (inside d) && forallb (fun s => has_face (v, fst s, snd s) (corners F))
    (steps (nth v (fans_of d) []))) J &&
  match glue ms with
  | None => false
  | Some (_, fs) => let known := sides fs in forallb (fun s => mem2 s known) (sides F)
  end.

Lemma glue_glued (ok : check d = true) ms : forall vs fs, glue ms = Some (vs, fs) -> glued (sheet_of d ok) J vs fs.
Proof.
  induction ms as [|[closing [[a b] c]] ms IH]; intros vs fs; [discriminate|]. cbn [glue].
  destruct (has_face (a, b, c) (corners (triangles d))) eqn:F; [|discriminate]. apply has_face_in in F.
  destruct (glue ms) as [[vs0 fs0]|]; [|destruct ms; [intros [= <- <-]; now apply glued_first|discriminate]].
  specialize (IH _ _ eq_refl). destruct closing.
  - destruct (_ && _) eqn:Ck; [|discriminate]. rewrite !andb_true_iff, forallb_forall in Ck.
    destruct Ck as (((((Ha & Hj) & S1) & S2) & St) & Others). intros [= <- <-].
    apply glued_close; try assumption; try (now apply has_side_in);
      [now apply mem_in|now apply mem_in| |now apply mem2_in].
    intros [x y] Hs. specialize (Others _ Hs). cbn [fst snd] in *.
    rewrite orb_true_iff, andb_true_iff, !Nat.eqb_eq in Others.
    destruct Others as [(-> & ->)|O]; [now left|right; now apply has_face_in].
  - destruct (_ && _) eqn:Ck; [|discriminate]. rewrite andb_true_iff, negb_true_iff in Ck. destruct Ck as (Sd & New).
    intros [= <- <-]. apply glued_tip; try assumption; [now apply has_side_in|].
    intros H. apply mem_in in H. congruence.
Qed.

Theorem disk_checked (ok : check d = true) F ms : is_disk F ms = true -> disk (sheet_of d ok) J F.
Proof.
  unfold is_disk. rewrite andb_true_iff, forallb_forall. intros (Inside & G'). split.
  { intros v Hv. specialize (Inside v Hv). rewrite andb_true_iff, forallb_forall, mem_in in Inside.
    destruct Inside as (Hi & At). split; [exact Hi|]. intros s Hs. apply has_face_in. now apply At. }
  revert G'. destruct (glue ms) as [[vs fs]|] eqn:G; [|discriminate]. cbv zeta. rewrite forallb_forall. intros All.
  exists vs, fs. split; [now apply (glue_glued ok ms)|]. intros s Hs. apply mem2_in. now apply All.
Qed.
End Glue.

(** On a disk the equations say that the heights begin a motion that keeps all lengths to second order. With a
    closed notch [F] are the faces without the triangle that closes it, and its corner is not in [J]. *)
Definition moves_as_a_disk d J F ms : bool := swift_check d (places d) (fans_table d) && is_disk d J F ms.

Theorem disk_moves d J F ms : moves_as_a_disk d J F ms = true -> exists ok : check d = true, forall h,
  (forall v, In v J -> K (sheet_of d ok) v h = 0) <-> exists u, keeps (sheet_of d ok) F h u.
Proof.
  unfold moves_as_a_disk. rewrite andb_true_iff. intros (Sw & H). exists (swift_checked d Sw). intros h.
  exact (flex_iff _ J F h (disk_checked d J _ F ms H)).
Qed.
