(** Certificates of one branch (docs/branch.md): the test of the checker, and that it proves. *)
From Coq Require Import Reals QArith Qreals ZArith List Lra Lia Arith Bool FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Nappes Sheet Identities Star KeyLemma Flat Theorems Branches
  Drawing Rational.
Import ListNotations.
Open Scope R_scope.

(** ** The bend at a fold *)

Section Bend.
Variable S : sheet.
Notation spoke := (spoke (at_ S)).

(** The gradient of a face, from its corner at [i]. *)
Definition tilt (i j l : nat) (h : vec) : point :=
  gradient (spoke i j) (spoke i l) (h j - h i) (h l - h i).

(** The length of the fold ij times the jump of the slope across it, positive for a valley; [l] is
    the third corner of the face on its left, [m] of that on its right. *)
Definition bend (i j l m : nat) (h : vec) : R :=
  dot (sub (tilt i j l h) (tilt i m j h)) (J (spoke i j)).

Lemma bend_minus i j l m h g : bend i j l m h = bend i j l m g + bend i j l m (minus h g).
Proof. unfold bend, tilt, gradient, dot, sub, J, minus. cbn [fst snd]. unfold Rdiv. ring. Qed.

Lemma gradient_of_plane g a b : cross a b <> 0 -> gradient a b (dot g a) (dot g b) = g.
Proof.
  intros C. unfold gradient, dot, cross in *. destruct g as [x y], a, b. cbn [fst snd] in *.
  f_equal; field; assumption.
Qed.

(** The face of a corner, with its gradient and area. *)
Lemma corner_face v a b h : In (v, a, b) (corners (faces S)) -> exists f, In f (faces S) /\
  In (v, a, b) (corners [f]) /\ face_gradient S f h = tilt v a b h /\
  area S f = cross (spoke v a) (spoke v b) / 2.
Proof.
  intros Hc. pose proof (face_of_corner S v a b Hc) as C.
  unfold corners in Hc. rewrite in_flat_map in Hc. destruct Hc as ([[x y] z] & Hf & Hc).
  exists (x, y, z). split; [assumption|]. split; [unfold corners; simpl in *; tauto|].
  pose proof (gradient_differences S x y z h Hf) as D. cbv zeta in D.
  set (g := face_gradient S (x, y, z) h) in *. destruct D as (D1 & D2 & D3 & D4 & D5 & D6).
  simpl in Hc. destruct Hc as [E|[E|[E|[]]]]; injection E as <- <- <-; split;
    try (unfold tilt; first [rewrite D1, D2|rewrite D3, D4|rewrite D5, D6]; symmetry; apply gradient_of_plane; lra);
    unfold area, Sheet.spoke, cross, sub; cbn [fst snd]; field.
Qed.

Lemma sum_two_terms {A} (l : list A) f a b : (forall x, In x l -> 0 <= f x) -> In a l -> In b l -> a <> b ->
  f a + f b <= sum l f.
Proof.
  intros P Ha Hb N. destruct (in_split _ _ Ha) as (l1 & l2 & ->). rewrite sum_app. simpl.
  assert (Hb' : In b (l1 ++ l2)).
  { apply in_app_or in Hb. apply in_or_app. destruct Hb as [|[|]]; [tauto|contradiction|tauto]. }
  pose proof (sum_ge_term (l1 ++ l2) f b) as T. rewrite sum_app in T.
  assert (f b <= sum l1 f + sum l2 f); [|lra]. apply T; [|assumption].
  intros x Hx. apply P, in_or_app. apply in_app_or in Hx. simpl. tauto.
Qed.

(** A function with small energy bends a fold little. *)
Lemma bend_bound i j l m w :
  In (i, j, l) (corners (faces S)) -> In (i, m, j) (corners (faces S)) ->
  bend i j l m w * bend i j l m w <= dot (spoke i j) (spoke i j) *
    (2 / cross (spoke i j) (spoke i l) + 2 / cross (spoke i m) (spoke i j)) * energy S w.
Proof.
  intros H1 H2. pose proof (face_of_corner S _ _ _ H1) as C1. pose proof (face_of_corner S _ _ _ H2) as C2.
  destruct (corner_face i j l w H1) as (f1 & F1 & K1 & G1 & A1).
  destruct (corner_face i m j w H2) as (f2 & F2 & K2 & G2 & A2).
  assert (N : f1 <> f2).
  { intros <-. destruct f1 as [[x y] z]. unfold corners in K1, K2. simpl in K1, K2.
    destruct K1 as [E|[E|[E|[]]]], K2 as [E'|[E'|[E'|[]]]]; injection E; injection E'; intros; subst;
      unfold Sheet.spoke, cross, sub in C1, C2; cbn [fst snd] in C1, C2; lra. }
  pose proof (sum_two_terms (faces S)
    (fun f => area S f * dot (face_gradient S f w) (face_gradient S f w)) f1 f2) as En.
  cbv beta in En. fold (energy S w) in En. rewrite G1, G2, A1, A2 in En.
  unfold bend. set (g := tilt i j l w) in *. set (g' := tilt i m j w) in *.
  set (c := cross (spoke i j) (spoke i l)) in *. set (c' := cross (spoke i m) (spoke i j)) in *.
  specialize (En ltac:(intros f Hf; apply Rmult_le_pos; [now apply Rlt_le, area_pos|apply dot_pos]) F1 F2 N).
  set (e := spoke i j). clearbody g g' e. clear G1 G2 A1 A2 F1 F2 N K1 K2 H1 H2 f1 f2.
  assert (P : dot (sub g g') (sub g g') <= (2 / c + 2 / c') * (c / 2 * dot g g + c' / 2 * dot g' g')).
  { set (u := (c * fst g + c' * fst g', c * snd g + c' * snd g') : point).
    replace ((2 / c + 2 / c') * (c / 2 * dot g g + c' / 2 * dot g' g')) with
      (dot (sub g g') (sub g g') + dot u u * / (c * c'))
      by (unfold u, dot, sub; cbn [fst snd]; field; lra).
    pose proof (Rinv_0_lt_compat _ (Rmult_lt_0_compat _ _ C1 C2)) as Pi.
    pose proof (Rmult_le_pos _ _ (dot_pos u) (Rlt_le _ _ Pi)). lra. }
  assert (Q : dot (sub g g') (J e) * dot (sub g g') (J e) <= dot e e * dot (sub g g') (sub g g')).
  { replace (dot e e * dot (sub g g') (sub g g')) with
      (dot (sub g g') (J e) * dot (sub g g') (J e) + dot (sub g g') e * dot (sub g g') e)
      by (unfold dot, sub, J; cbn [fst snd]; ring).
    pose proof (Rle_0_sqr (dot (sub g g') e)) as Sq. unfold Rsqr in Sq. lra. }
  eapply Rle_trans; [exact Q|]. rewrite Rmult_assoc. apply Rmult_le_compat_l; [apply dot_pos|].
  eapply Rle_trans; [exact P|]. apply Rmult_le_compat_l; [|exact En].
  apply Rplus_le_le_0_compat; apply Rlt_le, Rdiv_lt_0_compat; lra.
Qed.

Lemma same_sign a b s B : 0 < s * a -> B < a * a -> (b - a) * (b - a) <= B -> 0 < s * b.
Proof.
  intros Sa Ha Hb. destruct (Rlt_le_dec 0 (s * b)) as [|N]; [assumption|exfalso].
  assert (s * s * (a * b) <= 0) by (replace (s * s * (a * b)) with (s * a * (s * b)) by ring; nra).
  assert (0 < s * s) by nra. assert (a * b <= 0) by nra. nra.
Qed.

(** ** The side of a vertex, by a mountain that is easier to compute than the round cone *)

Lemma cone_and_mountain v t : In v (inner S) -> (forall u, In u (fan S v) -> t u < t v) ->
  0 < K2 S v (cone S v) t.
Proof.
  intros Hi Down. assert (Hv : In v (inner S ++ rim S)) by (apply in_or_app; now left).
  apply sum_pos.
  - destruct (inner_full S v Hi) as (u & up & p & q & down & F & _). rewrite F. destruct up; discriminate.
  - intros [a b] Hs. pose proof (step_left S v a b Hv Hs) as C.
    assert (Ha : In a (fan S v) /\ In b (fan S v)).
    { destruct (fan S v) as [|u l]; [easy|]. destruct (steps_in u l a b Hs). simpl. tauto. }
    destruct Ha as (Ha & Hb). apply Down in Ha, Hb.
    pose proof (cross_left _ _ (Rgt_not_eq _ _ C)) as M. pose proof (cross_right _ _ (Rgt_not_eq _ _ C)) as M'.
    unfold cone. replace (dot (spoke v v) (spoke v v)) with 0
      by (unfold Sheet.spoke, dot, sub; cbn [fst snd]; ring).
    rewrite sqrt_0.
    assert (Lag : dot (spoke v a) (spoke v b) * dot (spoke v a) (spoke v b) +
      cross (spoke v a) (spoke v b) * cross (spoke v a) (spoke v b) =
      dot (spoke v a) (spoke v a) * dot (spoke v b) (spoke v b))
      by (unfold dot, cross; ring).
    pose proof (dot_pos (spoke v a)) as Pa. pose proof (dot_pos (spoke v b)) as Pb.
    set (ra := sqrt (dot (spoke v a) (spoke v a))). set (rb := sqrt (dot (spoke v b) (spoke v b))).
    assert (Ra : ra * ra = dot (spoke v a) (spoke v a)) by now apply sqrt_sqrt.
    assert (Rb : rb * rb = dot (spoke v b) (spoke v b)) by now apply sqrt_sqrt.
    assert (Qa : 0 <= ra) by apply sqrt_pos. assert (Qb : 0 <= rb) by apply sqrt_pos.
    unfold wedge2. rewrite <- Ra, <- Rb in *.
    set (c := cross (spoke v a) (spoke v b)) in *. set (s := dot (spoke v a) (spoke v b)) in *.
    assert (0 < ra) by (destruct Qa as [|<-]; [assumption|exfalso; lra]).
    assert (0 < rb) by (destruct Qb as [|<-]; [assumption|exfalso; lra]).
    assert (Less : s < ra * rb).
    { assert (0 < c * c) by now apply Rmult_lt_0_compat.
      assert (0 < ra * rb) by now apply Rmult_lt_0_compat.
      destruct (Rlt_le_dec s (ra * rb)) as [|Ge]; [assumption|exfalso].
      assert (ra * rb * (ra * rb) <= s * s) by (apply Rmult_le_compat; lra). lra. }
    replace (_ - _) with ((ra * rb - s) * ((t v - t a) * rb + (t v - t b) * ra) / (2 * c * (ra * rb)))
      by (field; repeat split; lra).
    apply Rdiv_lt_0_compat; [apply Rmult_lt_0_compat; [lra|]|].
    + apply Rplus_lt_0_compat; apply Rmult_lt_0_compat; lra.
    + apply Rmult_lt_0_compat; [lra|]. now apply Rmult_lt_0_compat.
Qed.

Lemma side_by_mountain v t h s : In v (inner S) -> (forall u, In u (fan S v) -> t u < t v) ->
  0 < K2 S v t t -> 0 < K2 S v h h -> 0 < s * K2 S v t h -> 0 < s * K2 S v (cone S v) h.
Proof.
  intros Hi Down Pt Ph Side. pose proof (cone_and_mountain v t Hi Down) as Tc.
  assert (Hv : In v (inner S ++ rim S)) by (apply in_or_app; now left).
  pose proof (cone_positive S v Hi) as Pc. rewrite K_polar_sheet in Pt, Ph by assumption.
  destruct (Rlt_le_dec 0 (s * K2 S v (cone S v) h)) as [|N]; [assumption|exfalso].
  set (a := s * K2 S v t h) in *. set (b := - (s * K2 S v (cone S v) h)).
  set (g := move (move zero b t) a (cone S v)).
  assert (Z : forall x, K2 S v x zero = 0) by (intros x; apply (linear_zero (K2 S v x)); intros y r z; apply K2_move).
  assert (O : K2 S v g h = 0).
  { destruct (Req_dec s 0) as [E|E]; [unfold a in Side; rewrite E in Side; lra|].
    apply (Rmult_eq_reg_l s); [|assumption]. unfold g. rewrite K2_sym, !K2_move, Z.
    rewrite (K2_sym S v h t), (K2_sym S v h (cone S v)). unfold a, b. ring. }
  assert (Pg : 0 < K S v g).
  { unfold g. rewrite !K_move by assumption. rewrite <- (K_polar_sheet S v zero), Z by assumption.
    rewrite (K2_sym S v zero t), Z, (K2_sym S v (move zero b t)), K2_move, Z.
    assert (0 <= b) by (unfold b; lra).
    assert (0 <= b * b * K S v t) by (apply Rmult_le_pos; [now apply Rmult_le_pos|lra]).
    assert (0 < a * a * K S v (cone S v)) by (apply Rmult_lt_0_compat; [now apply Rmult_lt_0_compat|assumption]).
    assert (0 <= a * b * K2 S v (cone S v) t) by (apply Rmult_le_pos; [apply Rmult_le_pos|]; lra). lra. }
  pose proof (L S v g h Hi Pg O). lra.
Qed.

Lemma bent_not_flat i j l m h : In (i, j, l) (corners (faces S)) -> In (i, m, j) (corners (faces S)) ->
  In i (inner S) -> bend i j l m h <> 0 -> ~ flat_star S i h.
Proof.
  intros H1 H2 Hi B (g & Fl). apply B.
  pose proof (face_of_corner S _ _ _ H1) as C1. pose proof (face_of_corner S _ _ _ H2) as C2.
  assert (Hv : In i (inner S ++ rim S)) by (apply in_or_app; now left).
  assert (Fan : forall a b, In (i, a, b) (corners (faces S)) -> In a (fan S i) /\ In b (fan S i)).
  { intros a b Hc.
    assert (Hs : In (a, b) (steps (fan S i))).
    { apply (Permutation.Permutation_in _ (Permutation.Permutation_sym (fans S i Hv))).
      unfold link. apply in_map_iff. exists (i, a, b). split; [reflexivity|].
      apply filter_In. split; [assumption|apply Nat.eqb_refl]. }
    destruct (fan S i) as [|u t]; [easy|]. destruct (steps_in u t a b Hs). simpl. tauto. }
  destruct (Fan _ _ H1) as (Fj & Fk), (Fan _ _ H2) as (Fm & _).
  unfold bend, tilt. rewrite (Fl j Fj), (Fl l Fk), (Fl m Fm), !gradient_of_plane by lra.
  unfold dot, sub, J. cbn [fst snd]. ring.
Qed.
End Bend.

(** ** One branch near heights with positive curvatures *)

(** Heights on the right side of each vertex are near exactly one solution of K_v = 0, or of K_v = K_v(r) at
    the vertices that are [kept]. Its folds bend like theirs where they bend more than the distance allows.
    A vertex where such a fold ends is not flat. *)
Theorem near_solution S (up kept : nat -> bool) (r : vec) (c : point) (R2 dist : R)
  (folds : list (nat * nat * nat * nat * bool)) :
  (forall v, In v (inner S) -> 0 < K S v r /\ 0 < sign (up v) * K2 S v (cone S v) r) ->
  (forall v, In v (inner S ++ rim S) -> 0 <= multiplier S c R2 v) ->
  sum (inner S) (fun v => if kept v then 0 else multiplier S c R2 v * K S v r) <= dist ->
  (forall i j l m valley, In (i, j, l, m, valley) folds ->
    In (i, j, l) (corners (faces S)) /\ In (i, m, j) (corners (faces S)) /\ 0 < sign valley * bend S i j l m r /\
    (let p := spoke (at_ S) in
     dot (p i j) (p i j) * (2 / cross (p i j) (p i l) + 2 / cross (p i m) (p i j)) * dist <
       bend S i j l m r * bend S i j l m r)) ->
  let k := fun v => if kept v then K S v r else 0 in
  exists h, has_rim S r h /\ solves S k h /\ in_nappes S up h /\
    (forall v j l m valley, In v (inner S) -> In (v, j, l, m, valley) folds ->
      0 < sign (up v) * K2 S v (cone S v) h) /\
    (forall g, has_rim S r g -> solves S k g -> in_nappes S up g -> g = h) /\
    energy S (minus h r) <= dist /\
    (forall i j l m valley, In (i, j, l, m, valley) folds -> 0 < sign valley * bend S i j l m h).
Proof.
  intros Vs Ws Dist Fs k.
  assert (Pk : forall v, In v (inner S) -> 0 <= k v).
  { intros v Hv. unfold k. destruct (Vs v Hv). destruct (kept v); lra. }
  destruct (one_solution_per_sign_vector S k r up Pk) as (h & (Hr & Hs & Hn) & U).
  assert (Rn : in_nappes S up r) by (intros v Hv; destruct (Vs v Hv); split; lra).
  assert (En : energy S (minus h r) <= dist).
  { eapply Rle_trans; [apply (distance S c R2 up h r); try assumption; exact Hr|].
    eapply Rle_trans; [|exact Dist]. right. apply sum_ext. intros v Hv.
    rewrite (Hs v Hv). unfold k. destruct (kept v); [ring|]. f_equal. rewrite sqrt_0. destruct (Rn v Hv) as (P & _).
    replace (K S v r) with (sqrt (K S v r) * sqrt (K S v r)) at 3 by now apply sqrt_sqrt. ring. }
  assert (Letters : forall i j l m valley, In (i, j, l, m, valley) folds -> 0 < sign valley * bend S i j l m h).
  { intros i j l m valley Hf. destruct (Fs _ _ _ _ _ Hf) as (C1 & C2 & Sg & Far).
    apply (same_sign (bend S i j l m r) _ _ _ Sg Far).
    rewrite (bend_minus S i j l m h r).
    replace (bend S i j l m r + bend S i j l m (minus h r) - bend S i j l m r) with
      (bend S i j l m (minus h r)) by ring.
    eapply Rle_trans; [apply (bend_bound S i j l m (minus h r)); assumption|].
    apply Rmult_le_compat_l; [|assumption].
    pose proof (face_of_corner S _ _ _ C1). pose proof (face_of_corner S _ _ _ C2).
    apply Rmult_le_pos; [apply dot_pos|].
    apply Rplus_le_le_0_compat; apply Rlt_le, Rdiv_lt_0_compat; lra. }
  exists h. split; [assumption|]. split; [assumption|]. split; [assumption|]. split; [|split; [|split; assumption]].
  - intros v j l m valley Hv Hf. destruct (Hn v Hv) as (_ & P).
    assert (N : K2 S v (cone S v) h <> 0).
    { intros Z. destruct (Fs _ _ _ _ _ Hf) as (C1 & C2 & _). pose proof (Letters _ _ _ _ _ Hf) as B.
      apply (bent_not_flat S v j l m h C1 C2 Hv).
      - intros B0. rewrite B0 in B. lra.
      - apply (both_nappes_flat S v h Hv); [|assumption]. rewrite (Hs v Hv). auto. }
    destruct P as [P|P]; [assumption|]. exfalso. apply N. destruct (up v); simpl in P; lra.
  - intros g Gr Gs Gn. symmetry. apply U. auto.
Qed.

(** The same without vertices that are kept: a branch. *)
Theorem near_branch S (up : nat -> bool) (r : vec) (c : point) (R2 dist : R)
  (folds : list (nat * nat * nat * nat * bool)) :
  (forall v, In v (inner S) -> 0 < K S v r /\ 0 < sign (up v) * K2 S v (cone S v) r) ->
  (forall v, In v (inner S ++ rim S) -> 0 <= multiplier S c R2 v) ->
  sum (inner S) (fun v => multiplier S c R2 v * K S v r) <= dist ->
  (forall i j l m valley, In (i, j, l, m, valley) folds ->
    In (i, j, l) (corners (faces S)) /\ In (i, m, j) (corners (faces S)) /\ 0 < sign valley * bend S i j l m r /\
    (let p := spoke (at_ S) in
     dot (p i j) (p i j) * (2 / cross (p i j) (p i l) + 2 / cross (p i m) (p i j)) * dist <
       bend S i j l m r * bend S i j l m r)) ->
  exists h, has_rim S r h /\ solves S (fun _ => 0) h /\ in_nappes S up h /\
    (forall v j l m valley, In v (inner S) -> In (v, j, l, m, valley) folds ->
      0 < sign (up v) * K2 S v (cone S v) h) /\
    (forall g, has_rim S r g -> solves S (fun _ => 0) g -> in_nappes S up g -> g = h) /\
    energy S (minus h r) <= dist /\
    (forall i j l m valley, In (i, j, l, m, valley) folds -> 0 < sign valley * bend S i j l m h).
Proof. exact (near_solution S up (fun _ => false) r c R2 dist folds). Qed.

(** ** The certificate *)

Record certificate := Certificate {
  near : list Q;                    (* heights, vertex by vertex *)
  ups : list nat;                   (* the interior vertices that pop up; the others pop down *)
  cones : list (list (nat * Z));    (* for each vertex a mountain around it, heights by vertex *)
  centre : Q * Q;                   (* of a disk that holds the sheet *)
  radius2 : Q;
  distance2 : Q;
  letters : list (nat * nat * nat * nat * bool)
    (* folds i, j with the third corners of the faces on the left and on the right: valley? *)
}.

Section Check.
Variable d : drawing.
Variable c : certificate.

Definition height : heights := fun u => nth u (near c) 0%Q.
Definition mountain (v : nat) : heights := fun u =>
  match find (fun p => Nat.eqb (fst p) u) (nth v (cones c) []) with
  | Some p => inject_Z (snd p)
  | None => 0%Q
  end.
Definition pops_up (v : nat) : bool := mem v (ups c).
Definition signed (b : bool) (x : Q) : Q := if b then x else (- x)%Q.
Definition curvature (v : nat) : Q := qK2 d v height height.
Definition weight (v : nat) : Q := qmultiplier d (centre c) (radius2 c) v.

Definition vertex_ok (v : nat) : bool :=
  below 0 (curvature v) && below 0 (qK2 d v (mountain v) (mountain v)) &&
  forallb (fun u => below (mountain v u) (mountain v v)) (nth v (fans_of d) []) &&
  below 0 (signed (pops_up v) (qK2 d v (mountain v) height)) &&
  existsb (fun f => let '(i, _, _, _, _) := f in Nat.eqb i v) (letters c).

Definition distance_ok : bool :=
  forallb (fun v => at_most 0 (weight v)) (inside d ++ border d) &&
  at_most (qsum (inside d) (fun v => (weight v * curvature v)%Q)) (distance2 c).

Definition qtilt (i j l : nat) : Q * Q :=
  qgradient (zspoke d i j) (zspoke d i l) (height j - height i) (height l - height i).
Definition qbend (i j l m : nat) : Q :=
  let g := qtilt i j l in let g' := qtilt i m j in let e := zspoke d i j in
  ((fst g - fst g') * inject_Z (- snd e) + (snd g - snd g') * inject_Z (fst e))%Q.
Definition slack (i j l m : nat) : Q :=
  let e := zspoke d i j in
  (inject_Z (zdot e e) * (inject_Z 2 / inject_Z (zturn e (zspoke d i l)) +
    inject_Z 2 / inject_Z (zturn (zspoke d i m) e)) * distance2 c)%Q.
Definition is_corner (f : face) : bool :=
  let '(v, a, b) := f in
  existsb (fun g => let '(v', a', b') := g in Nat.eqb v v' && Nat.eqb a a' && Nat.eqb b b')
    (corners (triangles d)).
Definition fold_ok (f : nat * nat * nat * nat * bool) : bool :=
  let '(i, j, l, m, valley) := f in let b := qbend i j l m in
  is_corner (i, j, l) && is_corner (i, m, j) && below 0 (signed valley b) &&
  below (slack i j l m) (b * b).

(** The test of the checker. *)
Definition check_branch : bool :=
  forallb vertex_ok (inside d) && distance_ok && forallb fold_ok (letters c).

Hypothesis ok : check d = true.
Notation S := (sheet_of d ok).
Notation r := (real_heights height).

Lemma is_corner_in f : is_corner f = true -> In f (corners (faces S)).
Proof.
  destruct f as [[v a] b]. unfold is_corner. rewrite existsb_exists. intros ([[v' a'] b'] & Hf & E).
  rewrite !andb_true_iff, !Nat.eqb_eq in E. destruct E as ((-> & ->) & ->). exact Hf.
Qed.

Lemma signed_R b x : Q2R (signed b x) = sign b * Q2R x.
Proof. destruct b; simpl; [ring|]. rewrite Q2R_opp. ring. Qed.

Lemma Q2R_0 : Q2R 0 = 0.
Proof. unfold Q2R. simpl. ring. Qed.

Lemma vertex_proved v : In v (inside d) -> vertex_ok v = true ->
  0 < K S v r /\ 0 < sign (pops_up v) * K2 S v (cone S v) r.
Proof.
  intros Hi. assert (Hv : In v (inside d ++ border d)) by (apply in_or_app; now left).
  unfold vertex_ok. rewrite !andb_true_iff, forallb_forall. intros ((((Pk & Pt) & Down) & Side) & _).
  apply below_R in Pk, Pt, Side. rewrite Q2R_0 in *.
  rewrite signed_R in Side. unfold curvature in Pk. rewrite (qK2_R d ok) in Pk, Pt, Side by assumption.
  split.
  - rewrite <- K_polar_sheet by exact Hv. exact Pk.
  - apply (side_by_mountain S v (real_heights (mountain v))); try assumption.
    intros u Hu. apply below_R. now apply Down.
Qed.

Lemma qbend_R i j l m : In (i, j, l) (corners (faces S)) -> In (i, m, j) (corners (faces S)) ->
  Q2R (qbend i j l m) = bend S i j l m r.
Proof.
  intros H1 H2. pose proof (face_of_corner S _ _ _ H1) as C1. pose proof (face_of_corner S _ _ _ H2) as C2.
  unfold bend, tilt. rewrite !(spoke_R d ok) in *. unfold real_heights. rewrite <- !Q2R_minus.
  rewrite <- !qgradient_R by lra. unfold qbend, qtilt, dot, sub, J, to_plane, to_point. cbn [fst snd].
  now rewrite Q2R_plus, !Q2R_mult, !Q2R_minus, !Q2R_Z, opp_IZR.
Qed.

Lemma slack_R i j l m : In (i, j, l) (corners (faces S)) -> In (i, m, j) (corners (faces S)) ->
  let p := spoke (at_ S) in
  Q2R (slack i j l m) = dot (p i j) (p i j) * (2 / cross (p i j) (p i l) + 2 / cross (p i m) (p i j)) *
    Q2R (distance2 c).
Proof.
  intros H1 H2. pose proof (face_of_corner S _ _ _ H1) as C1. pose proof (face_of_corner S _ _ _ H2) as C2.
  cbv zeta. rewrite !(spoke_R d ok) in *. rewrite turn_R in C1, C2.
  assert (N1 : zturn (zspoke d i j) (zspoke d i l) <> 0%Z) by (intros E; rewrite E in C1; lra).
  assert (N2 : zturn (zspoke d i m) (zspoke d i j) <> 0%Z) by (intros E; rewrite E in C2; lra).
  unfold slack. rewrite !Q2R_mult, Q2R_plus, !Q2R_over, !Q2R_Z, dot_R, !turn_R by assumption. reflexivity.
Qed.

(** What passes the test is proved: there is one branch with these signs, its distance from the
    heights is bounded, and its folds have these letters. *)
Theorem certified : check_branch = true -> exists h,
  has_rim S r h /\ solves S (fun _ => 0) h /\ has_signs S pops_up h /\
  (forall g, has_rim S r g -> solves S (fun _ => 0) g -> in_nappes S pops_up g -> g = h) /\
  energy S (minus h r) <= Q2R (distance2 c) /\
  (forall i j l m valley, In (i, j, l, m, valley) (letters c) -> 0 < sign valley * bend S i j l m h).
Proof.
  unfold check_branch, distance_ok. rewrite !andb_true_iff, !forallb_forall.
  intros ((Vs & (Ws & Dist)) & Fs).
  destruct (near_branch S pops_up r (to_plane (centre c)) (Q2R (radius2 c)) (Q2R (distance2 c)) (letters c))
    as (h & Hr & Hs & _ & Sg & Rest).
  - intros v Hv. now apply vertex_proved, Vs.
  - intros v Hv. specialize (Ws v Hv). apply at_most_R in Ws. rewrite Q2R_0 in Ws.
    unfold weight in Ws. now rewrite (qmultiplier_R d ok) in Ws.
  - apply at_most_R in Dist. rewrite qsum_R in Dist. eapply Rle_trans; [|exact Dist]. right.
    apply sum_ext. intros v Hv. assert (Hv' : In v (inside d ++ border d)) by (apply in_or_app; now left).
    rewrite Q2R_mult. unfold weight, curvature. rewrite (qmultiplier_R d ok), (qK2_R d ok) by assumption.
    now rewrite K_polar_sheet by exact Hv'.
  - intros i j l m valley Hf. specialize (Fs _ Hf). unfold fold_ok in Fs. rewrite !andb_true_iff in Fs.
    destruct Fs as (((C1 & C2) & Sg) & Far). apply is_corner_in in C1, C2. apply below_R in Sg, Far.
    rewrite Q2R_0, signed_R, qbend_R in Sg by assumption.
    rewrite Q2R_mult, qbend_R, slack_R in Far by assumption. auto.
  - exists h. split; [assumption|]. split; [assumption|]. split; [|exact Rest].
    intros v Hv. specialize (Vs v Hv). unfold vertex_ok in Vs. rewrite !andb_true_iff, existsb_exists in Vs.
    destruct Vs as (_ & ([[[[i j] l] m] valley] & Hf & E)). apply Nat.eqb_eq in E. subst i.
    exact (Sg v j l m valley Hv Hf).
Qed.

End Check.
