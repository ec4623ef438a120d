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

Lemma stretch_sym at_ h u a b : stretch at_ h u b a = stretch at_ h u a b.
Proof. unfold stretch, dot, sub. cbn [fst snd]. ring. Qed.

(** How fast the spoke from [v] to [a] turns in the plane. *)
Definition turning (at_ : nat -> point) (u : nat -> point) (v a : nat) : R :=
  dot (sub (u a) (u v)) (J (spoke at_ v a)) / dot (spoke at_ v a) (spoke at_ v a).

(** In a face the lengths, the turning of two spokes and the curvature are one equation. *)
Lemma stretch_turning at_ h u v a b : cross (spoke at_ v a) (spoke at_ v b) <> 0 ->
  let d := spoke at_ v a in let d' := spoke at_ v b in
  stretch at_ h u a b =
    stretch at_ h u v a * (1 - dot d d' / dot d d) + stretch at_ h u v b * (1 - dot d d' / dot d' d') +
    2 * cross d d' * (turning at_ u v b - turning at_ u v a - wedge d d' (h a - h v) (h b - h v)).
Proof.
  intros C. cbv zeta. pose proof (cross_left _ _ C) as M. pose proof (cross_right _ _ C) as M'.
  unfold stretch, turning, wedge, spoke, sub, cross, dot, J in *. cbn [fst snd] in *. field. auto.
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
  - repeat split; [exists (x, y, z)|exists (y, z, x)|exists (z, x, y)]; (split; [reflexivity|apply All; simpl; tauto]).
  - repeat split; [exists (y, z, x)|exists (z, x, y)|exists (x, y, z)]; (split; [reflexivity|apply All; simpl; tauto]).
  - repeat split; [exists (z, x, y)|exists (x, y, z)|exists (y, z, x)]; (split; [reflexivity|apply All; simpl; tauto]).
Qed.

Lemma keeps_turning fs h u v a b : keeps fs h u -> In (v, a, b) (corners fs) ->
  cross (spoke v a) (spoke v b) <> 0 ->
  wedge (spoke v a) (spoke v b) (h a - h v) (h b - h v) = turning at_ u v b - turning at_ u v a.
Proof.
  intros Kp Hc C. destruct (corner_sides fs v a b Hc) as (S1 & S2 & S3).
  pose proof (stretch_turning at_ h u v a b C) as E. cbv zeta in E.
  rewrite (Kp _ _ S1), (Kp _ _ S2), stretch_sym, (Kp _ _ S3) in E.
  set (t := turning at_ u v b - turning at_ u v a) in *. set (w := wedge _ _ _ _) in *.
  set (c := cross (spoke v a) (spoke v b)) in *. set (p := 1 - _ / _) in E. set (q := 1 - _ / _) in E.
  assert (F : c * (t - w) = 0) by lra. apply Rmult_integral in F. destruct F; [contradiction|lra].
Qed.

Lemma around v : In v (inner S) -> exists z l, fan S v = z :: l ++ [z].
Proof.
  intros Hi. destruct (inner_full S v Hi) as (z & up & p & q & down & F & _).
  exists z, (up ++ p :: q :: down). rewrite F, <- app_assoc. reflexivity.
Qed.

Lemma turning_closes u v : In v (inner S) ->
  sum (steps (fan S v)) (fun s => let '(a, b) := s in turning at_ u v a - turning at_ u v b) = 0.
Proof. intros Hi. destruct (around v Hi) as (z & l & F). rewrite F, (telescope (turning at_ u v)). ring. Qed.

(** The faces are all those at [v]. *)
Definition all_at (fs : list face) (v : nat) : Prop :=
  forall s, In s (steps (fan S v)) -> In (v, fst s, snd s) (corners fs).

(** A motion that keeps all lengths has curvature 0. *)
Theorem flex_curvature fs h u v : keeps fs h u -> In v (inner S) -> all_at fs v -> K S v h = 0.
Proof.
  intros Kp Hi All. pose proof (inner_vertex S v Hi) as Hv.
  rewrite <- (turning_closes (fun x => sub (0, 0) (u x)) v Hi).
  apply sum_ext. intros [a b] Hs. pose proof (step_left S v a b Hv Hs) as C.
  rewrite (keeps_turning fs h u v a b Kp); [|exact (All _ Hs)|lra].
  unfold turning, sub, dot, J, Sheet.spoke. cbn [fst snd].
  pose proof (cross_left _ _ (Rgt_not_eq _ _ C)). pose proof (cross_right _ _ (Rgt_not_eq _ _ C)).
  unfold Sheet.spoke, sub, dot in *. cbn [fst snd] in *. field. auto.
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
Lemma tip_moves (h : vec) (u : nat -> point) a b c : cross (spoke c a) (spoke c b) <> 0 ->
  exists w : point,
    2 * dot (sub (at_ a) (at_ c)) (sub (u a) w) + (h a - h c) * (h a - h c) = 0 /\
    2 * dot (sub (at_ b) (at_ c)) (sub (u b) w) + (h b - h c) * (h b - h c) = 0.
Proof.
  intros C. set (d := spoke c a) in *. set (d' := spoke c b) in *.
  set (p := dot d (u a) + (h a - h c) * (h a - h c) / 2).
  set (q := dot d' (u b) + (h b - h c) * (h b - h c) / 2).
  exists (gradient d d' p q).
  pose proof (gradient_left d d' p q C) as L. pose proof (gradient_right d d' p q C) as R.
  change (sub (at_ a) (at_ c)) with d. change (sub (at_ b) (at_ c)) with d'. clearbody d d'.
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

(** Heights with curvature 0 move: face by face. *)
Lemma glued_flex h : (forall v, In v J -> K S v h = 0) ->
  forall vs fs, glued vs fs -> exists u, keeps fs h u.
Proof.
  intros Z.
  assert (Tip : forall vs fs u a b c, keeps fs h u -> (forall x y, In (x, y) (sides fs) -> In x vs /\ In y vs) ->
    In (a, b, c) (corners (faces S)) -> a <> c -> b <> c -> stretch at_ h u a b = 0 -> ~ In c vs ->
    exists u', keeps ((a, b, c) :: fs) h u').
  { intros vs fs u a b c Kp On Hc Na Nb Ab New.
    destruct (tip_moves h u a b c) as (w & W & W'); [pose proof (corner_left a b c Hc); lra|].
    exists (fun x => if Nat.eq_dec x c then w else u x). intros x y H. apply sides_cons in H. unfold stretch.
    destruct H as [E|[E|[E|H]]]; try (injection E as -> ->).
    - destruct (Nat.eq_dec a c), (Nat.eq_dec b c); try contradiction. exact Ab.
    - destruct (Nat.eq_dec b c), (Nat.eq_dec c c); try contradiction.
      unfold dot, sub in *. cbn [fst snd] in *. lra.
    - destruct (Nat.eq_dec c c), (Nat.eq_dec a c); try contradiction.
      unfold dot, sub in *. cbn [fst snd] in *. lra.
    - destruct (On x y H) as (Hx & Hy).
      destruct (Nat.eq_dec x c) as [->|], (Nat.eq_dec y c) as [->|]; try contradiction. now apply Kp. }
  assert (Dif : forall a b c, In (a, b, c) (corners (faces S)) -> a <> c /\ b <> c /\ a <> b).
  { intros a b c Hc. pose proof (face_of_corner S _ _ _ Hc) as C. unfold Sheet.spoke, sub, cross in C.
    cbn [fst snd] in C.
    repeat split; intros ->; lra. }
  induction 1 as [a b c Hc|vs fs a b c G (u & Kp) Hc Sd New|vs fs v a b G (u & Kp) Hc Hi Hj S1 S2 Others Hs].
  - (* the first face: two vertices as they are wanted, and the tip *)
    destruct (Dif a b c Hc) as (Na & Nb & Nab).
    set (d := sub (at_ b) (at_ a)). set (x := (h b - h a) * (h b - h a)).
    assert (M : dot d d <> 0).
    { pose proof (face_of_corner S _ _ _ Hc) as C. apply (cross_left _ (spoke a c)).
      unfold d, Sheet.spoke in *. lra. }
    set (u := fun y => if Nat.eq_dec y b then (- x / (2 * dot d d) * fst d, - x / (2 * dot d d) * snd d) else (0, 0)).
    apply (Tip [a; b] [] u a b c); try assumption; try easy.
    + unfold stretch, u. destruct (Nat.eq_dec b b), (Nat.eq_dec a b); try contradiction. fold d x.
      unfold sub, dot in *. cbn [fst snd] in *. field. assumption.
    + simpl. intuition congruence.
  - destruct (Dif a b c Hc) as (Na & Nb & _).
    apply (Tip vs fs u a b c); try assumption; [now apply glued_on|].
    destruct Sd as [Sd|Sd]; [now apply Kp|]. rewrite <- stretch_sym. now apply Kp.
  - exists u. pose proof (inner_vertex S v Hi) as Hv.
    assert (Va : stretch at_ h u v a = 0) by (destruct S1 as [S1|S1]; [|rewrite <- stretch_sym]; now apply Kp).
    assert (Vb : stretch at_ h u v b = 0) by (destruct S2 as [S2|S2]; [|rewrite <- stretch_sym]; now apply Kp).
    pose proof (step_left S v a b Hv Hs) as C.
    assert (W : wedge (spoke v a) (spoke v b) (h a - h v) (h b - h v) = turning at_ u v b - turning at_ u v a).
    { set (f := fun s : nat * nat => let '(x, y) := s in
        wedge (spoke v x) (spoke v y) (h x - h v) (h y - h v) + (turning at_ u v x - turning at_ u v y)).
      assert (F : f (a, b) = 0); [|unfold f in F; lra].
      apply (sum_one (steps (fan S v)) f (a, b) Hs).
      - intros [x y] Hxy. destruct (Others _ Hxy) as [E|E]; [now left|right]. cbn [fst snd] in E. unfold f.
        pose proof (step_left S v x y Hv Hxy). rewrite (keeps_turning fs h u v x y Kp E); lra.
      - transitivity (sum (steps (fan S v)) (fun s => let '(x, y) := s in
            wedge (spoke v x) (spoke v y) (h x - h v) (h y - h v)) +
          sum (steps (fan S v)) (fun s => let '(x, y) := s in turning at_ u v x - turning at_ u v y)).
        + rewrite <- sum_plus. apply sum_ext. intros [x y] _. reflexivity.
        + rewrite turning_closes by assumption. change (K S v h + 0 = 0). rewrite (Z v Hj). ring. }
    intros x y H. apply sides_cons in H. destruct H as [E|[E|[E|H]]]; try (injection E as -> ->).
    + exact Va.
    + rewrite (stretch_turning at_ h u v a b) by lra. cbv zeta. rewrite Va, Vb, W. ring.
    + rewrite <- stretch_sym. exact Vb.
    + now apply Kp.
Qed.

(** A disk of the faces [F] with the vertices [J] inside: all faces can be glued. *)
Definition disk (F : list face) : Prop := (forall v, In v J -> In v (inner S) /\ all_at F v) /\
  exists vs fs, glued vs fs /\ forall s, In s (sides F) -> In s (sides fs).

Theorem flex_iff F h : disk F -> ((forall v, In v J -> K S v h = 0) <-> exists u, keeps F h u).
Proof.
  intros (Inside & vs & fs & G & All). split.
  - intros Z. destruct (glued_flex h Z vs fs G) as (u & Kp). exists u. intros a b H. now apply Kp, All.
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
          if mem a (inside d) && mem a J && has_side a b fs && has_side a c fs && mem2 (b, c) star && forallb (fun s =>
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
