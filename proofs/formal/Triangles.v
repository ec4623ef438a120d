(** Triangulated triangles (docs/theorem.md, section 4: three boundary vertices): vertices inside a triangle
    of edges stay in its plane, and the curvatures of all others are those of the sheet without them. *)
From Coq Require Import Reals List Permutation Lra Lia Arith FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Nappes Sheet Identities Star KeyLemma Flat Complex Theorems Branches.
Import ListNotations.
Open Scope R_scope.

(** The curvature that the faces of a list give to a vertex, of complex heights. *)
Definition faces_curvature (at_ : nat -> point) (fs : list face) (v : nat) (z : cvec) : complex :=
  csum (link fs v) (fun s => let '(a, b) := s in
    cwedge (spoke at_ v a) (spoke at_ v b) (csub (z a) (z v)) (csub (z b) (z v))).

Lemma faces_curvature_fan S v z : In v (inner S ++ rim S) -> faces_curvature (at_ S) (faces S) v z = KC S v z.
Proof. intros Hv. unfold faces_curvature, KC, csum. f_equal; apply sum_perm, Permutation_sym, fans; assumption. Qed.

Lemma link_app fs fs' v : link (fs ++ fs') v = link fs v ++ link fs' v.
Proof. unfold link, corners. now rewrite flat_map_app, filter_app, map_app. Qed.

Lemma faces_curvature_app at_ fs fs' v z : faces_curvature at_ (fs ++ fs') v z =
  cadd (faces_curvature at_ fs v z) (faces_curvature at_ fs' v z).
Proof. unfold faces_curvature, csum, cadd. rewrite link_app, !sum_app. reflexivity. Qed.

(** A vertex that is on none of the faces. *)
Lemma off_faces at_ fs v z : (forall a b, ~ In (v, a, b) (corners fs)) -> faces_curvature at_ fs v z = real 0.
Proof.
  intros Off. unfold faces_curvature, link.
  destruct (filter _ _) as [|[[u a] b] l] eqn:F; [reflexivity|exfalso].
  assert (H : In (u, a, b) ((u, a, b) :: l)) by now left. rewrite <- F in H. apply filter_In in H.
  destruct H as (H & E). apply Nat.eqb_eq in E. subst u. exact (Off a b H).
Qed.

(** ** A plane over the star of a corner *)

Definition twist2 (g g' d : point) : R := (dot g d * dot g' (J d) + dot g' d * dot g (J d)) / (4 * dot d d).

Lemma wedge2_planes g g' d d' : cross d d' <> 0 ->
  wedge2 d d' (dot g d) (dot g d') (dot g' d) (dot g' d') = twist2 g g' d - twist2 g g' d'.
Proof.
  intros C. pose proof (cross_left _ _ C) as N. pose proof (cross_right _ _ C) as N'.
  unfold wedge2, twist2. destruct g as [g1 g2], g' as [k1 k2], d as [x y], d' as [x' y'].
  unfold dot, cross, J in *. cbn [fst snd] in *. field. auto.
Qed.

Section Triangle.
Variable S : sheet.
Variables a b c : nat.
Notation at_ := (at_ S).
Notation spoke := (spoke at_).
Notation vertices := (inner S ++ rim S).
Hypothesis Rim : rim S = [a; b; c].
Hypothesis Left : 0 < cross (sub (at_ b) (at_ a)) (sub (at_ c) (at_ a)).

Lemma affine_spoke h g v u : affine S h g u - affine S h g v = dot g (spoke v u).
Proof. unfold affine, dot, Sheet.spoke, sub. cbn [fst snd]. ring. Qed.

(** At a corner the faces inside turn from one side of the triangle to the other. *)
Lemma corner_ends v u q : In (v, u, q) (corners [(a, b, c)]) -> exists mid, fan S v = u :: mid ++ [q].
Proof.
  intros Hc.
  assert (Hv : In v (rim S)) by (rewrite Rim; simpl in *;
    destruct Hc as [E|[E|[E|[]]]]; injection E; intros; subst; auto).
  destruct (rim_convex S v Hv) as (u' & mid & q' & F & Hu & Hq & Mid & Turn).
  assert (V : In v vertices) by (apply in_or_app; now right).
  assert (Self : spoke v v = (0, 0)) by (unfold Sheet.spoke, sub; f_equal; ring).
  assert (U : u' <> v /\ q' <> v /\ u' <> q').
  { assert (First : exists x, In (u', x) (steps (fan S v))).
    { rewrite F. destruct mid as [|x mid]; [exists q'|exists x]; now left. }
    assert (Last : exists x, In (x, q') (steps (fan S v)) /\ (x = u' \/ 0 < cross (spoke v u') (spoke v x))).
    { rewrite F. destruct mid as [|x mid] using rev_ind.
      - exists u'. split; [now left|now left].
      - exists x. split; [|right; apply Mid, in_or_app; right; now left].
        rewrite <- app_assoc. cbn [app]. change (u' :: mid ++ x :: [q']) with ((u' :: mid) ++ x :: [q']).
        rewrite steps_split. apply in_or_app. right. now left. }
    destruct First as (x & St). pose proof (step_left S v u' x V St) as P.
    destruct Last as (y & St' & Y). pose proof (step_left S v y q' V St') as P'. repeat split.
    - intros ->. rewrite Self in P. unfold cross in P. cbn [fst snd] in P. lra.
    - intros ->. rewrite Self in P'. unfold cross in P'. cbn [fst snd] in P'. lra.
    - intros <-. destruct Y as [->|Y]; unfold cross in *; lra. }
  destruct U as (Nu & Nq & Nuq). rewrite Rim in Hu, Hq.
  assert (E : u' = u /\ q' = q); [|destruct E as (-> & ->); now exists mid].
  unfold Sheet.spoke in Turn. unfold cross, sub in Left, Turn. cbn [fst snd] in Left, Turn.
  simpl in Hc, Hu, Hq.
  destruct Hc as [E|[E|[E|[]]]]; injection E as <- <- <-;
    destruct Hu as [<-|[<-|[<-|[]]]]; destruct Hq as [<-|[<-|[<-|[]]]]; try congruence; try (now split);
    exfalso; lra.
Qed.

(** Affine heights: all faces inside give a corner what the whole triangle gives. *)
Lemma corner_planes v u q h g h' g' : In (v, u, q) (corners [(a, b, c)]) ->
  K2 S v (affine S h g) (affine S h' g') =
  wedge2 (spoke v u) (spoke v q) (affine S h g u - affine S h g v) (affine S h g q - affine S h g v)
    (affine S h' g' u - affine S h' g' v) (affine S h' g' q - affine S h' g' v).
Proof.
  intros Hc. destruct (corner_ends v u q Hc) as (mid & F).
  assert (Hv : In v vertices).
  { apply in_or_app. right. rewrite Rim. simpl in *. destruct Hc as [E|[E|[E|[]]]]; injection E; intros; subst; auto. }
  assert (C : cross (spoke v u) (spoke v q) <> 0).
  { apply Rgt_not_eq. unfold Sheet.spoke, cross, sub in *. cbn [fst snd] in *. simpl in Hc.
    destruct Hc as [E|[E|[E|[]]]]; injection E as <- <- <-; lra. }
  unfold K2. rewrite (sum_ext _ _ (fun s => let '(x, y) := s in
    twist2 g g' (spoke v x) - twist2 g g' (spoke v y))).
  - rewrite F, (telescope (fun x => twist2 g g' (spoke v x))), !affine_spoke. symmetry. now apply wedge2_planes.
  - intros [x y] Hs. pose proof (step_left S v x y Hv Hs). rewrite !affine_spoke. apply wedge2_planes. lra.
Qed.

(** The plane parts of complex heights. *)
Lemma parts_of z h g h' g' : (forall u, In u vertices -> z u = (affine S h g u, affine S h' g' u)) ->
  forall u, In u vertices -> re_part z u = affine S h g u /\ im_part z u = affine S h' g' u.
Proof. intros E u Hu. unfold re_part, im_part. now rewrite (E u Hu). Qed.

Lemma corner_distinct v u q : In (v, u, q) (corners [(a, b, c)]) -> link [(a, b, c)] v = [(u, q)].
Proof.
  assert (D : NoDup [a; b; c]).
  { rewrite <- Rim. pose proof (vertices_once S) as D. induction (inner S) as [|v0 l IH]; [exact D|].
    cbn [app] in D. inversion D. auto. }
  inversion D as [|? ? N1 D1]; subst. inversion D1 as [|? ? N2 _]; subst. simpl in N1, N2.
  assert (a <> b /\ a <> c /\ b <> c) as (Nab & Nac & Nbc) by (repeat split; intros ->; tauto).
  pose proof (not_eq_sym Nab). pose proof (not_eq_sym Nac). pose proof (not_eq_sym Nbc).
  apply Nat.eqb_neq in Nab, Nac, Nbc, H, H0, H1.
  simpl. intros [E|[E|[E|[]]]]; injection E as <- <- <-; unfold link; simpl;
    rewrite ?Nat.eqb_refl, ?Nab, ?Nac, ?Nbc, ?H, ?H0, ?H1; reflexivity.
Qed.

Theorem triangle_curvature z v : complex_affine S z -> ~ In v (inner S) ->
  faces_curvature at_ (faces S) v z = faces_curvature at_ [(a, b, c)] v z.
Proof.
  intros (h & g & h' & g' & E) Nv.
  destruct (in_dec Nat.eq_dec v (rim S)) as [Hv|Hv].
  - assert (Hc : exists u q, In (v, u, q) (corners [(a, b, c)])).
    { rewrite Rim in Hv. simpl in *. destruct Hv as [<-|[<-|[<-|[]]]]; eauto 8. }
    destruct Hc as (u & q & Hc). pose proof (in_or_app (inner S) (rim S) v (or_intror Hv)) as V.
    rewrite faces_curvature_fan by assumption. rewrite KC_parts by assumption.
    destruct (corner_ends v u q Hc) as (mid & F).
    assert (Onto : forall x, In x [a; b; c] -> In x vertices) by (intros; apply in_or_app; right; now rewrite Rim).
    assert (Uq : In u vertices /\ In q vertices).
    { simpl in Hc. destruct Hc as [X|[X|[X|[]]]]; injection X as <- <- <-; split; apply Onto; simpl; auto. }
    destruct Uq as (Hu & Hq).
    assert (Fan : forall x, In x (fan S v) -> In x vertices).
    { intros x Hx. rewrite F in Hx.
      assert (St : exists y y', In (y, y') (steps (fan S v)) /\ (x = y \/ x = y')).
      { rewrite F. destruct Hx as [<-|Hx].
        - destruct mid as [|y mid]; [exists u, q|exists u, y]; split; auto; now left.
        - destruct (in_split _ _ Hx) as (l1 & l2 & Sp). rewrite Sp. destruct l1 as [|y l1] using rev_ind.
          + exists u, x. split; [destruct l2; now left|auto].
          + exists y, x. split; [|auto]. clear. rewrite <- app_assoc. cbn [app].
            change (u :: l1 ++ y :: x :: l2) with ((u :: l1) ++ y :: x :: l2).
            rewrite steps_split. apply in_or_app. right. now left. }
      destruct St as (y & y' & St & Y). apply (step_corner S v y y' V) in St.
      assert (H : In (y, y', v) (corners (faces S)) /\ In (y', v, y) (corners (faces S))).
      { unfold corners in *. rewrite in_flat_map in St. destruct St as ([[x0 y0] z0] & Hf & Hc0).
        rewrite !in_flat_map. simpl in Hc0.
        destruct Hc0 as [E0|[E0|[E0|[]]]]; injection E0 as <- <- <-;
          split; exists (x0, y0, z0); (split; [assumption|simpl; tauto]). }
      destruct H as (Ha & Hb). destruct Y as [->| ->]; eapply faces_on_vertices; eassumption. }
    assert (Same : forall x, In x vertices -> re_part z x = affine S h g x /\ im_part z x = affine S h' g' x)
      by now apply parts_of.
    assert (K2s : forall f f' p p', (forall x, In x vertices -> f x = f' x) ->
      (forall x, In x vertices -> p x = p' x) ->
      K2 S v f p = K2 S v f' p').
    { intros f f' p p' Ef Ep. rewrite (fan_values S v f f' p), K2_sym, (fan_values S v p p' f'), K2_sym;
        [reflexivity| |];
        intros x Hx; rewrite ?Ef, ?Ep by auto; reflexivity. }
    unfold faces_curvature. rewrite (corner_distinct v u q Hc). unfold csum. cbn [sum].
    rewrite <- !K_polar_sheet by assumption.
    rewrite (K2s (re_part z) (affine S h g) (re_part z) (affine S h g)) by (intros; now apply Same).
    rewrite (K2s (im_part z) (affine S h' g') (im_part z) (affine S h' g')) by (intros; now apply Same).
    rewrite (K2s (re_part z) (affine S h g) (im_part z) (affine S h' g')) by (intros; now apply Same).
    rewrite !(corner_planes v u q) by assumption.
    rewrite (E u Hu), (E q Hq), (E v V).
    unfold cwedge, wedge2, csub, cadd, cmul, real, re, im. cbn [fst snd].
    assert (C : cross (spoke v u) (spoke v q) <> 0).
    { apply Rgt_not_eq. unfold Sheet.spoke, cross, sub in *. cbn [fst snd] in *. simpl in Hc.
      destruct Hc as [X|[X|[X|[]]]]; injection X as <- <- <-; lra. }
    pose proof (cross_left _ _ C) as M. pose proof (cross_right _ _ C) as M'.
    f_equal; field; repeat split; assumption.
  - assert (Off : forall x y, ~ In (v, x, y) (corners (faces S))).
    { intros x y H. apply (faces_on_vertices S) in H. apply in_app_or in H. tauto. }
    rewrite !off_faces; [reflexivity| |assumption].
    intros x y H. apply Hv. rewrite Rim. simpl in *. destruct H as [X|[X|[X|[]]]]; injection X; intros; subst; auto.
Qed.

(** Planes solve the equations inside. *)
Lemma plane_solves z : complex_affine S z -> complex_solution S z.
Proof.
  intros (h & g & h' & g' & E) v Hv. rewrite KC_parts by now apply inner_vertex.
  pose proof (parts_of z h g h' g' E) as P.
  rewrite (K_vertices S v (re_part z) (affine S h g)), (K_vertices S v (im_part z) (affine S h' g')),
    (K2_vertices S v (re_part z) (affine S h g) (im_part z) (affine S h' g'));
    try assumption; try (intros u Hu; now apply P).
  assert (Z : forall k p, minus (affine S k p) (affine S k p) = zero) by (intros; vec).
  rewrite <- (K_affine S v (affine S h g) h g), <- (K_affine S v (affine S h' g') h' g'),
    <- (K2_affine S v (affine S h g) (affine S h' g') h g h' g'), !Z by assumption.
  rewrite (linear_zero (K2 S v zero)) by (intros x s y; apply K2_move).
  unfold real. f_equal; ring.
Qed.

(** The equations inside say that the triangle stays flat. *)
Theorem triangle_flat z :
  (forall v, In v (inner S) -> faces_curvature at_ (faces S) v z = real 0) <-> complex_affine S z.
Proof.
  split.
  - intros H. apply (rigid S a b c z Rim); [lra|]. intros v Hv.
    rewrite <- faces_curvature_fan by now apply inner_vertex. now apply H.
  - intros H v Hv. rewrite faces_curvature_fan by now apply inner_vertex. now apply plane_solves.
Qed.
End Triangle.
