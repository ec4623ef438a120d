(** Displacements of a disk that hold one vertex and the direction to another one: in the plane they are determined by
    how they change the lengths. All displacements and heights are written into one vector. *)
From Coq Require Import Reals List Lra Lia Arith Bool FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Nappes Sheet Identities Star KeyLemma Flat Drawing Curve Flex.
Import ListNotations.
Open Scope R_scope.

Definition add (a b : point) : point := (fst a + fst b, snd a + snd b).
Definition scale (s : R) (a : point) : point := (s * fst a, s * snd a).
Definition origin : point := (0, 0).
(** Both coordinates are at most [r]. *)
Definition bounded (r : R) (a : point) : Prop := Rabs (fst a) <= r /\ Rabs (snd a) <= r.

Ltac points := unfold widen, add, scale, origin, cross, dot, J, sub in *; cbn [fst snd] in *.

(** A configuration: the vertices are over the points [P] of the plane, at the heights [z]. All edges of [F] have
    the lengths of the flat sheet. *)
Definition true_lengths (at_ : nat -> point) (F : list face) (P : nat -> point) (z : vec) : Prop :=
  forall a b, In (a, b) (sides F) ->
    dot (sub (P b) (P a)) (sub (P b) (P a)) + (z b - z a) * (z b - z a) =
    dot (sub (at_ b) (at_ a)) (sub (at_ b) (at_ a)).

(** What the length of an edge is. *)
Lemma length_identity (at_ : nat -> point) P z t u (g : vec) a b : P a = add (at_ a) (scale (t * t) (u a)) ->
  P b = add (at_ b) (scale (t * t) (u b)) ->
  z a = t * g a -> z b = t * g b ->
  dot (sub (P b) (P a)) (sub (P b) (P a))
    + (z b - z a) * (z b - z a) = dot (sub (at_ b) (at_ a)) (sub (at_ b) (at_ a)) +
    t * t * (2 * widen at_ u a b + (g b - g a) * (g b - g a) + t * t * dot (sub (u b) (u a)) (sub (u b) (u a))).
Proof. intros -> -> -> ->. points. ring. Qed.

Lemma two_dots d d' w : cross d d' <> 0 -> dot d w = 0 -> dot d' w = 0 -> w = origin.
Proof.
  intros C A B. destruct d as [x y], d' as [x' y'], w as [p q]. points.
  f_equal; apply (Rmult_eq_reg_r (x * y' - y * x')); try assumption.
  - replace (p * (x * y' - y * x')) with (y' * (x * p + y * q) - y * (x' * p + y' * q)) by ring. rewrite A, B. ring.
  - replace (q * (x * y' - y * x')) with (x * (x' * p + y' * q) - x' * (x * p + y * q)) by ring. rewrite A, B. ring.
Qed.

Lemma thirds v : ((3 * v) / 3 = v /\ (3 * v + 1) / 3 = v /\ (3 * v + 2) / 3 = v /\
  (3 * v) mod 3 = 0 /\ (3 * v + 1) mod 3 = 1 /\ (3 * v + 2) mod 3 = 2)%nat.
Proof.
  pose proof (Nat.div_mod (3 * v) 3). pose proof (Nat.div_mod (3 * v + 1) 3). pose proof (Nat.div_mod (3 * v + 2) 3).
  pose proof (Nat.mod_upper_bound (3 * v) 3). pose proof (Nat.mod_upper_bound (3 * v + 1) 3).
  pose proof (Nat.mod_upper_bound (3 * v + 2) 3). lia.
Qed.

(** ** Bounds *)

Lemma product_bound x y r s : Rabs x <= r -> Rabs y <= s -> Rabs (x * y) <= r * s.
Proof. intros X Y. rewrite Rabs_mult. apply Rmult_le_compat; auto using Rabs_pos. Qed.

Lemma sum_bound x y r s : Rabs x <= r -> Rabs y <= s -> Rabs (x + y) <= r + s.
Proof. intros X Y. eapply Rle_trans; [apply Rabs_triang|lra]. Qed.

Lemma difference_bound x y r s : Rabs x <= r -> Rabs y <= s -> Rabs (x - y) <= r + s.
Proof. intros X Y. unfold Rminus. apply sum_bound; [assumption|now rewrite Rabs_Ropp]. Qed.

Lemma dot_bound a b r s : bounded r a -> bounded s b -> Rabs (dot a b) <= 2 * (r * s).
Proof.
  intros (A1 & A2) (B1 & B2). unfold dot. replace (2 * (r * s)) with (r * s + r * s) by ring.
  apply sum_bound; now apply product_bound.
Qed.

Lemma sub_bound a b r s : bounded r a -> bounded s b -> bounded (r + s) (sub a b).
Proof. intros (A1 & A2) (B1 & B2). split; now apply difference_bound. Qed.

Lemma add_bound a b r s : bounded r a -> bounded s b -> bounded (r + s) (add a b).
Proof. intros (A1 & A2) (B1 & B2). split; now apply sum_bound. Qed.

Lemma scale_bound c a r s : Rabs c <= s -> bounded r a -> bounded (s * r) (scale c a).
Proof. intros C (A1 & A2). split; now apply product_bound. Qed.

Lemma at_norm I w i : zero_off I w -> Rabs (w i) <= norm I w.
Proof.
  intros Z. destruct (in_dec Nat.eq_dec i I) as [Hi|Hi].
  - apply (sum_ge_term I (fun i => Rabs (w i))); [intros; apply Rabs_pos|assumption].
  - rewrite (Z i Hi), Rabs_R0. apply norm_nonneg.
Qed.

Section Displacements.
Variable S : sheet.
Notation at_ := (at_ S).

(** The faces [F] with the vertices [J] inside, glued to a disk with the vertices [vs]. *)
Variables J vs : list nat.
Variables F fs : list face.
Hypothesis Glued : glued S J vs fs.
Hypothesis Same : forall s, In s (sides F) <-> In s (sides fs).

(** One vertex is held, and another one on its line with the first. *)
Variables p q : nat.
Hypothesis Hp : In p vs.
Hypothesis Hq : In q vs.
Notation d := (sub (at_ q) (at_ p)).
Notation D := (Rabs (fst d) + Rabs (snd d)).
Hypothesis Apart : dot d d <> 0.
Definition held (P : nat -> point) : Prop := P p = at_ p /\ cross d (sub (P q) (at_ p)) = 0.
Definition extent (u : nat -> point) : R := sum vs (fun v => Rabs (fst (u v)) + Rabs (snd (u v))).

Lemma extent_pos u : 0 <= extent u.
Proof. apply sum_nonneg. intros v _. pose proof (Rabs_pos (fst (u v))). pose proof (Rabs_pos (snd (u v))). lra. Qed.

Lemma extent_at u v : In v vs -> bounded (extent u) (u v).
Proof.
  intros Hv. pose proof (sum_ge_term vs (fun v => Rabs (fst (u v)) + Rabs (snd (u v))) v) as H.
  fold (extent u) in H. pose proof (Rabs_pos (fst (u v))). pose proof (Rabs_pos (snd (u v))).
  assert (Rabs (fst (u v)) + Rabs (snd (u v)) <= extent u).
  { apply H; [|assumption]. intros b _. pose proof (Rabs_pos (fst (u b))). pose proof (Rabs_pos (snd (u b))). lra. }
  split; lra.
Qed.

(** ** Motions in the plane *)

(** Displacements that hold these two vertices. *)
Definition holding (u : nat -> point) : Prop :=
  u p = origin /\ cross d (u q) = 0 /\ forall v, ~ In v vs -> u v = origin.

Lemma in_vs a b : In (a, b) (sides F) -> In a vs /\ In b vs.
Proof. intros H. apply Same in H. exact (glued_on S J vs fs Glued a b H). Qed.

Lemma hold u : exists u', holding u' /\ forall a b, In (a, b) (sides F) -> widen at_ u' a b = widen at_ u a b.
Proof.
  set (w := cross d (sub (u q) (u p)) / dot d d).
  exists (fun v => if in_dec Nat.eq_dec v vs
    then sub (sub (u v) (u p)) (scale w (Sheet.J (sub (at_ v) (at_ p)))) else origin).
  split; [split; [|split]|].
  - destruct in_dec; [|contradiction]. points. f_equal; ring.
  - destruct in_dec; [|contradiction].
    replace (cross d (sub (sub (u q) (u p)) (scale w (Sheet.J d)))) with (cross d (sub (u q) (u p)) - w * dot d d)
      by (points; ring).
    unfold w. field. exact Apart.
  - intros v Hv. destruct in_dec; [contradiction|reflexivity].
  - intros a b H. destruct (in_vs a b H). unfold widen.
    destruct (in_dec Nat.eq_dec a vs), (in_dec Nat.eq_dec b vs); try contradiction. points. ring.
Qed.

Definition turned (c : point) (w : R) (u : nat -> point) (v : nat) : Prop := u v = add c (scale w (Sheet.J (at_ v))).

Lemma tip_turned c w u x y z : In (x, y, z) (corners (faces S)) -> turned c w u x -> turned c w u y ->
  widen at_ u z x = 0 -> widen at_ u z y = 0 -> turned c w u z.
Proof.
  intros Hc X Y Zx Zy. unfold turned in *.
  assert (E : sub (u z) (add c (scale w (Sheet.J (at_ z)))) = origin).
  { apply (two_dots (spoke at_ z x) (spoke at_ z y)).
    - pose proof (corner_left S x y z Hc). lra.
    - unfold widen in Zx. rewrite X in Zx. unfold spoke. points. lra.
    - unfold widen in Zy. rewrite Y in Zy. unfold spoke. points. lra. }
  destruct (u z) as [e f]. points. injection E as E1 E2. f_equal; lra.
Qed.

Lemma glued_turned u vs0 fs0 : glued S J vs0 fs0 -> (forall a b, In (a, b) (sides fs0) -> widen at_ u a b = 0) ->
  exists c w, forall v, In v vs0 -> turned c w u v.
Proof.
  induction 1 as [x y z Hc|vs0 fs0 x y z G IH Hc Sd New|vs0 fs0 v x y G IH Hc _ _ _ _ _ _]; intros Z.
  - destruct (corner_sides [(x, y, z)] x y z (or_introl eq_refl)) as (S1 & S2 & S3).
    apply Z in S1, S2, S3. set (e := sub (at_ y) (at_ x)).
    assert (M : dot e e <> 0).
    { pose proof (face_of_corner S _ _ _ Hc) as C. apply (cross_left _ (spoke at_ x z)). unfold e, spoke in *. lra. }
    set (w := cross e (sub (u y) (u x)) / dot e e). set (c := sub (u x) (scale w (Sheet.J (at_ x)))).
    assert (Tx : turned c w u x) by (unfold turned, c; destruct (u x); points; f_equal; ring).
    assert (Ty : turned c w u y).
    { unfold turned. assert (E : sub (sub (u y) (u x)) (scale w (Sheet.J e)) = origin).
      { apply (two_dots e (Sheet.J e)).
        - replace (cross e (Sheet.J e)) with (dot e e) by (points; ring). exact M.
        - unfold widen in S1. fold e in S1. points. lra.
        - replace (dot (Sheet.J e) (sub (sub (u y) (u x)) (scale w (Sheet.J e)))) with
            (cross e (sub (u y) (u x)) - w * dot e e) by (points; ring). unfold w. field. exact M. }
      unfold c. unfold e in E. destruct (u y), (u x). points. injection E as E1 E2. f_equal; lra. }
    exists c, w. intros v [<-|[<-|[<-|[]]]]; [exact Tx|exact Ty|].
    apply (tip_turned c w u x y z Hc Tx Ty); [exact S3|]. rewrite even_widen. exact S2.
  - destruct IH as (c & w & T); [intros; apply Z; now apply (in_sides_cons (x, y, z))|].
    destruct (corner_sides ((x, y, z) :: fs0) x y z (or_introl eq_refl)) as (S1 & S2 & S3). apply Z in S2, S3.
    exists c, w. intros v [<-|Hv]; [|auto].
    assert (Xy : In x vs0 /\ In y vs0) by (destruct Sd as [Sd|Sd]; apply (glued_on S J vs0 fs0 G) in Sd; tauto).
    apply (tip_turned c w u x y z Hc); [now apply T|now apply T|exact S3|]. rewrite even_widen. exact S2.
  - apply IH. intros. apply Z. now apply (in_sides_cons (v, x, y)).
Qed.

Lemma rigid_in_plane u : holding u -> (forall a b, In (a, b) (sides F) -> widen at_ u a b = 0) ->
  forall v, u v = origin.
Proof.
  intros (Up & Uq & Off) Z. destruct (glued_turned u vs fs Glued) as (c & w & T).
  { intros a b H. apply Z. now apply Same. }
  pose proof (T p Hp) as Tp. pose proof (T q Hq) as Tq. unfold turned in Tp, Tq. rewrite Up in Tp. rewrite Tq in Uq.
  assert (W : w * dot d d = 0).
  { points. injection Tp as E1 E2. replace (fst c) with (w * snd (at_ p)) in Uq by lra.
    replace (snd c) with (- (w * fst (at_ p))) in Uq by lra. rewrite <- Uq. ring. }
  apply Rmult_integral in W. destruct W as [W|]; [|contradiction].
  intros v. destruct (in_dec Nat.eq_dec v vs) as [Hv|Hv]; [|auto]. rewrite (T v Hv). subst w.
  points. injection Tp as E1 E2. f_equal; lra.
Qed.

(** ** Coordinates of the motion in one vector: 1, and for each vertex along [d], across, and its height *)

Definition pack (c : R) (u : nat -> point) (g : vec) : vec := fun i =>
  match i with
  | O => c
  | Datatypes.S j => let v := (j / 3)%nat in
    match (j mod 3)%nat with O => dot d (u v) / dot d d | 1%nat => cross d (u v) / dot d d | _ => g v end
  end.
Definition shift (x : vec) (v : nat) : point :=
  add (scale (x (Datatypes.S (3 * v))) d) (scale (x (Datatypes.S (3 * v + 1))) (Sheet.J d)).
Definition height (x : vec) (v : nat) : R := x (Datatypes.S (3 * v + 2)).
Definition free (i : nat) : bool :=
  match i with
  | O => false
  | Datatypes.S j => let v := (j / 3)%nat in
    match (j mod 3)%nat with
    | O => mem v vs && negb (Nat.eqb v p)
    | 1%nat => mem v vs && negb (Nat.eqb v p) && negb (Nat.eqb v q)
    | _ => mem v J
    end
  end.
Definition unknowns : list nat := filter free (seq 0 (3 * list_max (vs ++ J) + 4)).
Notation I := unknowns.

Lemma unknown i : In i I <-> free i = true.
Proof.
  unfold unknowns. rewrite filter_In, in_seq. split; [tauto|]. intros Fr. split; [|assumption].
  assert (M : forall v, In v (vs ++ J) -> (v <= list_max (vs ++ J))%nat).
  { apply Forall_forall. now apply list_max_le. }
  destruct i as [|j]; [discriminate|]. cbn [free] in Fr.
  pose proof (Nat.div_mod j 3 ltac:(easy)) as Dm. pose proof (Nat.mod_upper_bound j 3 ltac:(easy)).
  assert (Hv : In (j / 3)%nat (vs ++ J)).
  { apply in_or_app. destruct (j mod 3)%nat as [|[|r]]; rewrite ?andb_true_iff, mem_in in Fr; tauto. }
  specialize (M _ Hv). lia.
Qed.

Lemma unknowns_once : NoDup I.
Proof. apply NoDup_filter, seq_NoDup. Qed.

Lemma shift_pack c u g v : shift (pack c u g) v = u v.
Proof.
  destruct (thirds v) as (E1 & E2 & _ & E4 & E5 & _). unfold shift, pack. rewrite E1, E2, E4, E5.
  destruct (u v). points. f_equal; field; exact Apart.
Qed.

Lemma height_pack c u g v : height (pack c u g) v = g v.
Proof. destruct (thirds v) as (_ & _ & E3 & _ & _ & E6). unfold height, pack. now rewrite E3, E6. Qed.

Lemma unpack x : x = pack (x O) (shift x) (height x).
Proof.
  apply functional_extensionality. intros [|j]; [reflexivity|]. cbn [pack].
  pose proof (Nat.div_mod j 3 ltac:(easy)) as Dm. pose proof (Nat.mod_upper_bound j 3 ltac:(easy)) as Lt.
  unfold shift, height. set (v := (j / 3)%nat) in *. destruct (j mod 3)%nat as [|[|[|r]]]; [| | |lia].
  - replace (3 * v)%nat with j by lia. set (a := x (Datatypes.S j)). set (b := x _). clearbody a b. points. field.
    exact Apart.
  - replace (3 * v + 1)%nat with j by lia. set (b := x (Datatypes.S j)). set (a := x _). clearbody a b. points. field.
    exact Apart.
  - now replace (3 * v + 2)%nat with j by lia.
Qed.

Lemma pack_zero u g : (forall v, u v = origin) -> (forall v, g v = 0) -> pack 0 u g = zero.
Proof.
  intros U G. apply functional_extensionality. intros [|j]; [reflexivity|]. cbn [pack]. unfold zero. rewrite U, G.
  destruct (j mod 3)%nat as [|[|r]]; points; try reflexivity; field; exact Apart.
Qed.

Lemma zero_off_pack u g : holding u -> zero_off J g -> zero_off I (pack 0 u g).
Proof.
  intros (Up & Uq & Off) Zg [|j] Hi; [reflexivity|]. rewrite unknown in Hi. cbn [pack free] in *.
  set (v := (j / 3)%nat) in *.
  assert (Out : mem v vs = false -> u v = origin).
  { intros M. apply Off. intros H. apply mem_in in H. congruence. }
  destruct (j mod 3)%nat as [|[|r]].
  - assert (E : u v = origin).
    { destruct (mem v vs) eqn:M; [|auto]. destruct (Nat.eqb_spec v p) as [->|]; [exact Up|now elim Hi]. }
    rewrite E. points. field. exact Apart.
  - assert (E : cross d (u v) = 0).
    { destruct (mem v vs) eqn:M; [|rewrite Out by reflexivity; points; ring].
      destruct (Nat.eqb_spec v p) as [->|]; [rewrite Up; points; ring|].
      destruct (Nat.eqb_spec v q) as [->|]; [exact Uq|now elim Hi]. }
    rewrite E. field. exact Apart.
  - apply Zg. intros H. apply Hi. now apply mem_in.
Qed.

Lemma zero_off_parts w : zero_off I w -> w O = 0 /\ holding (shift w) /\ zero_off J (height w).
Proof.
  intros Z. assert (N : forall i, free i = false -> w i = 0).
  { intros i Fr. apply Z. rewrite unknown. congruence. }
  assert (Fr : forall v, free (Datatypes.S (3 * v)) = mem v vs && negb (Nat.eqb v p) /\
    free (Datatypes.S (3 * v + 1)) = mem v vs && negb (Nat.eqb v p) && negb (Nat.eqb v q) /\
    free (Datatypes.S (3 * v + 2)) = mem v J).
  { intros v. destruct (thirds v) as (E1 & E2 & E3 & E4 & E5 & E6). cbn [free]. now rewrite E1, E2, E3, E4, E5, E6. }
  assert (Out : forall v, mem v vs = false \/ v = p -> shift w v = origin).
  { intros v H. destruct (Fr v) as (F1 & F2 & _).
    assert (E : mem v vs && negb (Nat.eqb v p) = false).
    { destruct H as [-> | ->]; [reflexivity|]. rewrite Nat.eqb_refl. apply andb_false_r. }
    rewrite E in F1, F2. unfold shift. rewrite (N _ F1), (N _ F2). points. f_equal; ring. }
  split; [now apply N|]. split; [split; [|split]|].
  - apply Out. now right.
  - destruct (Fr q) as (_ & F2 & _). rewrite Nat.eqb_refl, andb_false_r in F2. unfold shift. rewrite (N _ F2). points.
    ring.
  - intros v Hv. apply Out. left. destruct (mem v vs) eqn:M; [|reflexivity]. now apply mem_in in M.
  - intros v Hv. apply N. destruct (Fr v) as (_ & _ & ->). destruct (mem v J) eqn:M; [|reflexivity].
    now apply mem_in in M.
Qed.

Lemma shift_move a s b v : shift (move a s b) v = add (shift a v) (scale s (shift b v)).
Proof. unfold shift, move. points. f_equal; ring. Qed.

Lemma shift_bound w r v : (forall i, Rabs (w i) <= r) -> bounded (D * r) (shift w v) /\ Rabs (height w v) <= r.
Proof.
  intros W. split; [|apply W]. unfold shift.
  pose proof (Rle_refl (Rabs (fst d))) as R1. pose proof (Rle_refl (Rabs (snd d))) as R2.
  split; points.
  - replace ((Rabs (fst (at_ q) - fst (at_ p)) + Rabs (snd (at_ q) - snd (at_ p))) * r) with
      (r * Rabs (fst (at_ q) - fst (at_ p)) + r * Rabs (snd (at_ q) - snd (at_ p))) by ring.
    apply sum_bound; apply product_bound; auto. now rewrite Rabs_Ropp.
  - replace ((Rabs (fst (at_ q) - fst (at_ p)) + Rabs (snd (at_ q) - snd (at_ p))) * r) with
      (r * Rabs (snd (at_ q) - snd (at_ p)) + r * Rabs (fst (at_ q) - fst (at_ p))) by ring.
    apply sum_bound; apply product_bound; auto.
Qed.
End Displacements.
