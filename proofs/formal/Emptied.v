(** Sheets with triangulated triangles: what is verified of the sheet without the vertices inside them holds
    for the sheet of the file. *)
From Coq Require Import Reals ZArith List Lra Lia Permutation Arith Bool FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Nappes Sheet Identities Star KeyLemma Flat Complex Theorems Branches
  Triangles Notch Drawing Tables Rational
  Certificate Integers Verify.
Import ListNotations.
Open Scope R_scope.

(** A triangle of the drawing, counter-clockwise, with the vertices [hidden] inside it, the faces that fill it
    in the file, and their neighbours by vertex. *)
Record part := Part {
  corner_a : nat; corner_b : nat; corner_c : nat;
  hidden : list nat;
  pieces : list face;
  fans_in : list (list nat)
}.

Definition whole (q : part) : face := (corner_a q, corner_b q, corner_c q).

Definition same_face (f f' : face) : bool :=
  let '(a, b, c) := f in let '(x, y, z) := f' in Nat.eqb a x && Nat.eqb b y && Nat.eqb c z.

Fixpoint same_faces (l l' : list face) : bool :=
  match l, l' with
  | [], [] => true
  | f :: l, f' :: l' => same_face f f' && same_faces l l'
  | _, _ => false
  end.

Lemma same_faces_eq l : forall l', same_faces l l' = true -> l = l'.
Proof.
  induction l as [|[[a b] c] l IH]; intros [|[[x y] z] l']; simpl; try easy.
  rewrite !andb_true_iff, !Nat.eqb_eq. intros (((-> & ->) & ->) & H). now rewrite (IH l' H).
Qed.

Lemma cadd_zero z : cadd (real 0) z = z.
Proof. destruct z. unfold cadd, real, re, im. cbn [fst snd]. f_equal; ring. Qed.

Section Emptied.
Variable d : drawing.

(** The sheet in a triangle. *)
Definition filled (q : part) : drawing :=
  Drawing (points d) (hidden q) [corner_a q; corner_b q; corner_c q] (pieces q) (fans_in q).

Definition part_ok (at_z : Map.t (Z * Z)) (known : nat -> bool) (q : part) : bool :=
  swift_check (filled q) at_z (fans_table (filled q)) &&
  (0 <? zcross d (corner_a q) (corner_b q) (corner_c q))%Z &&
  forallb known [corner_a q; corner_b q; corner_c q].

(** The faces [opened] of the drawing are these triangles and [common] ones, which the file has, too. *)
Definition emptied (opened common : list face) (parts : list part) : bool :=
  let set := set_of (inside d ++ border d) in let known := has set in let at_z := places d in
  same_faces opened (map whole parts ++ common) &&
  forallb (fun c => let '(v, a, b) := c in known v) (corners common) &&
  fresh ((inside d ++ border d) ++ flat_map hidden parts) (Map.empty _) && forallb (part_ok at_z known) parts.

(** The heights are those of a plane on the triangle, with all that is inside. *)
Definition flat_in (z : cvec) (q : part) : Prop :=
  exists c g c' g', forall u, In u (hidden q ++ [corner_a q; corner_b q; corner_c q]) ->
    z u = (c + dot g (at_R d u), c' + dot g' (at_R d u)).

(** The faces of the file, and the equations at its vertices: those in [J] and those in the triangles. *)
Definition file_faces (common : list face) (parts : list part) : list face := flat_map pieces parts ++ common.
Definition file_solution (J : list nat) (common : list face) (parts : list part) (z : cvec) : Prop :=
  forall v, In v (J ++ flat_map hidden parts) -> faces_curvature (at_R d) (file_faces common parts) v z = real 0.

(** What is verified of a triangle. *)
Definition good (q : part) : Prop :=
  check (filled q) = true /\
  0 < cross (sub (at_R d (corner_b q)) (at_R d (corner_a q))) (sub (at_R d (corner_c q)) (at_R d (corner_a q))) /\
  forall v, In v [corner_a q; corner_b q; corner_c q] -> In v (inside d ++ border d).

Lemma part_good q : part_ok (places d) (has (set_of (inside d ++ border d))) q = true -> good q.
Proof.
  unfold part_ok. rewrite !andb_true_iff, forallb_forall. intros ((Sw & Left) & On). split; [|split].
  - now apply swift_checked.
  - rewrite cross_IZR. now apply IZR_lt, Z.ltb_lt.
  - intros v Hv. now apply has_In, On.
Qed.

Lemma plane_in_triangle q z v : good q -> flat_in z q -> ~ In v (hidden q) ->
  faces_curvature (at_R d) (pieces q) v z = faces_curvature (at_R d) [whole q] v z.
Proof.
  intros (ok & Left & _) Fl Nv.
  exact (triangle_curvature (sheet_of (filled q) ok) _ _ _ eq_refl Left z v Fl Nv).
Qed.

Lemma flat_in_iff q z : good q ->
  ((forall v, In v (hidden q) -> faces_curvature (at_R d) (pieces q) v z = real 0) <-> flat_in z q).
Proof. intros (ok & Left & _). exact (triangle_flat (sheet_of (filled q) ok) _ _ _ eq_refl Left z). Qed.

Lemma off_part q v z : good q -> ~ In v (inside d ++ border d) -> ~ In v (hidden q) ->
  faces_curvature (at_R d) (pieces q) v z = real 0.
Proof.
  intros (ok & _ & On) Nk Nh. apply off_faces. intros a b H.
  apply (faces_on_vertices (sheet_of (filled q) ok)) in H. apply in_app_or in H. destruct H as [H|H]; [easy|].
  apply Nk. now apply On.
Qed.

(** At vertices outside the triangles. *)
Lemma outside_curvature parts z v : (forall q, In q parts -> good q) -> (forall q, In q parts -> flat_in z q) ->
  ~ In v (flat_map hidden parts) ->
  faces_curvature (at_R d) (flat_map pieces parts) v z = faces_curvature (at_R d) (map whole parts) v z.
Proof.
  induction parts as [|q parts IH]; intros Ok Fl Nv; [reflexivity|].
  cbn [flat_map] in *. change (map whole (q :: parts)) with ([whole q] ++ map whole parts).
  rewrite !faces_curvature_app. f_equal.
  - apply plane_in_triangle; [apply Ok; now left|apply Fl; now left|]. intros H. apply Nv, in_or_app. now left.
  - apply IH; [intros; apply Ok; now right|intros; apply Fl; now right|]. intros H. apply Nv, in_or_app. now right.
Qed.

(** At vertices inside one of them. *)
Lemma off_parts parts z v : (forall q, In q parts -> good q) -> ~ In v (inside d ++ border d) ->
  ~ In v (flat_map hidden parts) -> faces_curvature (at_R d) (flat_map pieces parts) v z = real 0.
Proof.
  induction parts as [|q parts IH]; intros Ok Nk Nv; [reflexivity|]. cbn [flat_map] in *.
  rewrite faces_curvature_app, (off_part q), cadd_zero.
  - apply IH; [intros; apply Ok; now right|assumption|]. intros H. apply Nv, in_or_app. now right.
  - apply Ok. now left.
  - assumption.
  - intros H. apply Nv, in_or_app. now left.
Qed.

Lemma hidden_curvature parts q z v : (forall q, In q parts -> good q) -> NoDup (flat_map hidden parts) ->
  In q parts -> In v (hidden q) -> ~ In v (inside d ++ border d) ->
  faces_curvature (at_R d) (flat_map pieces parts) v z = faces_curvature (at_R d) (pieces q) v z.
Proof.
  induction parts as [|q' parts IH]; intros Ok D Hq Hv Nk; [easy|]. cbn [flat_map] in *.
  assert (Apart : ~ (In v (hidden q') /\ In v (flat_map hidden parts))).
  { intros (H & H'). clear - D H H'. induction (hidden q') as [|u l IH]; [easy|]. cbn [app] in D.
    inversion D as [|? ? N D']; subst. destruct H as [->|H]; [|now apply IH]. apply N, in_or_app. now right. }
  assert (D' : NoDup (flat_map hidden parts)).
  { clear - D. induction (hidden q') as [|u l IH]; [exact D|]. cbn [app] in D. inversion D. auto. }
  rewrite faces_curvature_app. destruct Hq as [->|Hq].
  - rewrite (off_parts parts z v); [|intros; apply Ok; now right|assumption|tauto].
    destruct (faces_curvature (at_R d) (pieces q) v z). unfold cadd, real, re, im. cbn [fst snd]. f_equal; ring.
  - rewrite (off_part q' v z), cadd_zero; [|apply Ok; now left|assumption|].
    + apply IH; [intros; apply Ok; now right|assumption..].
    + intros H. apply Apart. split; [assumption|]. apply in_flat_map. now exists q.
Qed.

(** The equations of the file are those of the drawing, and that all these triangles stay flat. *)
Theorem emptied_verified J opened common parts : emptied opened common parts = true ->
  (forall v, In v J -> In v (inside d)) ->
  forall z, file_solution J common parts z <->
    (forall v, In v J -> faces_curvature (at_R d) opened v z = real 0) /\ (forall q, In q parts -> flat_in z q).
Proof.
  unfold emptied. cbv zeta. rewrite !andb_true_iff, !forallb_forall. intros (((Same & Com) & Fr) & Ok) HJ z.
  apply same_faces_eq in Same. assert (Good : forall q, In q parts -> good q) by (intros; now apply part_good, Ok).
  destruct (fresh_NoDup _ _ Fr) as (D & _).
  assert (DH : NoDup (flat_map hidden parts)).
  { clear - D. induction (inside d ++ border d) as [|u l IH]; [exact D|]. cbn [app] in D. inversion D. auto. }
  assert (Apart : forall v, In v (inside d ++ border d) -> ~ In v (flat_map hidden parts)).
  { clear - D. intros v. induction (inside d ++ border d) as [|u l IH]; [easy|]. cbn [app] in D.
    inversion D as [|? ? N D']; subst. intros [->|H]; [|now apply IH]. intros H. apply N, in_or_app. now right. }
  assert (InJ : forall v, In v J -> ~ In v (flat_map hidden parts)).
  { intros v Hv. apply Apart, in_or_app. left. now apply HJ. }
  assert (Hid : forall q v, In q parts -> In v (hidden q) ->
    faces_curvature (at_R d) (file_faces common parts) v z = faces_curvature (at_R d) (pieces q) v z).
  { intros q v Hq Hv. assert (Nk : ~ In v (inside d ++ border d)).
    { intros H. apply (Apart v H). apply in_flat_map. now exists q. }
    unfold file_faces. rewrite faces_curvature_app, (hidden_curvature parts q) by assumption.
    rewrite (off_faces _ common).
    - destruct (faces_curvature (at_R d) (pieces q) v z). unfold cadd, real, re, im. cbn [fst snd]. f_equal; ring.
    - intros a b H. apply Nk. apply (Com (v, a, b)) in H. now apply has_In in H. }
  assert (Out : forall v, In v J -> (forall q, In q parts -> flat_in z q) ->
    faces_curvature (at_R d) (file_faces common parts) v z = faces_curvature (at_R d) opened v z).
  { intros v Hv Fl. unfold file_faces. rewrite Same, !faces_curvature_app. f_equal.
    apply outside_curvature; auto. }
  split.
  - intros Sol. assert (Fl : forall q, In q parts -> flat_in z q).
    { intros q Hq. apply flat_in_iff; [auto|]. intros v Hv. rewrite <- (Hid q v Hq Hv). apply Sol, in_or_app. right.
      apply in_flat_map. now exists q. }
    split; [|assumption]. intros v Hv. rewrite <- (Out v Hv Fl). apply Sol, in_or_app. now left.
  - intros (Sol & Fl) v Hv. apply in_app_or in Hv. destruct Hv as [Hv|Hv].
    + rewrite (Out v Hv Fl). now apply Sol.
    + apply in_flat_map in Hv. destruct Hv as (q & Hq & Hv). rewrite (Hid q v Hq Hv).
      apply (flat_in_iff q z (Good q Hq)); auto.
Qed.
End Emptied.

(** All branches of a sheet with triangulated triangles: exactly 2^n, n the number of vertices outside of them. *)
Theorem all_emptied_verified d p top given asked common parts :
  verify_all d p top given asked = true -> emptied d (triangles d) common parts = true ->
  exists (ok : check d = true) b1 b2 b3 b4, border d = [b1; b2; b3; b4] /\
  let S := sheet_of d ok in exists l : list vec,
    length l = (2 ^ length (inside d))%nat /\ NoDup l /\
    (forall h, In h l <-> representative S b4 h) /\
    (forall h, In h l -> nonsingular S h) /\
    (forall e, exists! h, In h l /\ has_signs S e h) /\
    (forall z, file_solution d (inside d) common parts z ->
       (forall q, In q parts -> flat_in d z q) /\ (complex_affine S z \/
       exists h, In h l /\ (exists s, on_branch S z s h) /\
         forall h' s', In h' l -> on_branch S z s' h' -> h' = h)) /\
    (forall z, complex_solution S z -> (forall q, In q parts -> flat_in d z q) ->
       file_solution d (inside d) common parts z) /\
    (forall e h f i j l m valley, In e (sign_vectors (inside d)) -> representative S b4 h -> has_signs S e h ->
       In f (folds p) -> ends f = (i, j, l, m) -> asked e (name f) = Some valley ->
       0 < sign valley * bend S i j l m h).
Proof.
  intros Ver Em. destruct (all_verified d p top given asked Ver)
    as (ok & b1 & b2 & b3 & b4 & Rim & l & Len & D & Rep & Sim & Signs & Complete & Lt).
  pose proof (emptied_verified d (inside d) (triangles d) common parts Em (fun v H => H)) as E.
  assert (Eq : forall v z, In v (inside d) ->
    faces_curvature (at_R d) (triangles d) v z = KC (sheet_of d ok) v z).
  { intros v z Hv. apply (faces_curvature_fan (sheet_of d ok)). apply in_or_app. now left. }
  exists ok, b1, b2, b3, b4. split; [exact Rim|]. exists l. repeat (split; [assumption|]). split; [|split; [|exact Lt]].
  - intros z Hz. apply E in Hz. destruct Hz as (Sol & Fl). split; [exact Fl|]. apply Complete.
    intros v Hv. rewrite <- Eq by exact Hv. now apply Sol.
  - intros z Hz Fl. apply E. split; [|exact Fl]. intros v Hv. rewrite Eq by exact Hv. now apply Hz.
Qed.

(** The same with a reflex corner. *)
Theorem all_notched_emptied_verified d p r given asked common parts :
  verify_all_notched d p r given asked = true -> emptied d (tl (triangles d)) common parts = true ->
  exists (ok : check d = true), notch_closed d r ok (tl (triangles d)) /\
  let S := sheet_of d ok in exists l : list vec,
    length l = (2 ^ length (others S r))%nat /\ NoDup l /\
    (forall h, In h l <-> raised S r h) /\
    (forall h, In h l -> nonsingular S h) /\
    (forall e, exists! h, In h l /\ has_open_signs S r e h) /\
    (forall z, file_solution d (others S r) common parts z ->
       (forall q, In q parts -> flat_in d z q) /\ (complex_affine S z \/
       exists h, In h l /\ (exists s, on_branch S z s h) /\
         forall h' s', In h' l -> on_branch S z s' h' -> h' = h)) /\
    (forall z, open_solution S r z -> (forall q, In q parts -> flat_in d z q) ->
       file_solution d (others S r) common parts z) /\
    (forall e h f i j l m valley, In e (sign_vectors (others S r)) -> raised S r h -> has_open_signs S r e h ->
       In f (folds p) -> ends f = (i, j, l, m) -> asked e (name f) = Some valley ->
       0 < sign valley * bend S i j l m h).
Proof.
  intros Ver Em. destruct (all_notched_verified d p r given asked Ver)
    as (ok & opened & Op & l & Len & D & Rep & Sim & Signs & Complete & Lt).
  assert (Tl : tl (triangles d) = opened).
  { destruct Op as (b & c & b1 & b2 & b3 & Tr & _). now rewrite Tr. }
  rewrite Tl in *. exists ok. split; [exact Op|].
  assert (Sub : forall v, In v (others (sheet_of d ok) r) -> In v (inside d)).
  { intros v Hv. apply others_in in Hv. now destruct Hv. }
  pose proof (emptied_verified d (others (sheet_of d ok) r) opened common parts Em Sub) as E.
  exists l. repeat (split; [assumption|]). split; [|split; [|exact Lt]].
  - intros z Hz. apply E in Hz. destruct Hz as (Sol & Fl). split; [exact Fl|]. apply Complete. exact Sol.
  - intros z Hz Fl. apply E. split; [|exact Fl]. intros v Hv.
    transitivity (KC (sheet_of d ok) v z); [exact (opened_curvature d r ok opened v z Op Hv)|now apply Hz].
Qed.
