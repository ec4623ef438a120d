(** Flat stars: K_v(h, .) = 0 if and only if the star of [v] is flat in [h]. *)
From Coq Require Import Reals List Permutation Lra Lia Arith FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Nappes Sheet Identities Star KeyLemma.
Import ListNotations.
Open Scope R_scope.

(** ** Lists without repetition *)

Lemma NoDup_map_filter {A B} (f : A -> B) (P : A -> bool) l : NoDup (map f l) -> NoDup (map f (filter P l)).
Proof.
  induction l as [|a l IH]; simpl; intros D; [constructor|]. inversion D as [|? ? N D']; subst.
  destruct (P a); simpl; [|auto]. constructor; [|auto].
  intros H. apply N. apply in_map_iff in H. destruct H as (b & E & Hb). rewrite <- E.
  apply in_map. now apply filter_In in Hb.
Qed.

Lemma sum_key {A} (l : list (A * A)) (Dec : forall a b : A, {a = b} + {a <> b}) (key : A * A -> A) s (f : A * A -> R) :
  NoDup (map key l) -> In s l -> sum l (fun t => if Dec (key t) (key s) then f t else 0) = f s.
Proof.
  induction l as [|t l IH]; simpl; intros D Hs; [easy|]. inversion D as [|? ? N D']; subst.
  destruct Hs as [->|Hs].
  - destruct Dec as [_|]; [|easy]. rewrite sum_zero; [ring|]. intros t Ht.
    destruct Dec as [E|]; [|reflexivity]. exfalso. apply N. rewrite <- E. now apply in_map.
  - rewrite IH by assumption. destruct Dec as [E|]; [|ring]. exfalso. apply N. rewrite E. now apply in_map.
Qed.

Section Flat.
Variable S : sheet.
Notation at_ := (at_ S).
Notation spoke := (spoke at_).

(** The star of [v] is flat in [h]: on the star [h] is linear. *)
Definition flat_star (v : nat) (h : vec) : Prop :=
  exists g : point, forall u, In u (fan S v) -> h u - h v = dot g (spoke v u).

Lemma firsts_once v : In v (inner S) -> NoDup (map fst (steps (fan S v))).
Proof.
  intros Hi. apply inner_vertex in Hi.
  apply (Permutation_NoDup (Permutation_map fst (Permutation_sym (fans S v Hi)))).
  unfold link. rewrite map_map. apply (NoDup_map_inv (fun a => (v, a))). rewrite map_map.
  pose proof (NoDup_map_filter _ (fun f => let '(u, a, b) := f in Nat.eqb u v) _ (sides_once S)) as D.
  erewrite map_ext_in; [exact D|]. intros [[u a] b] H. apply filter_In in H. destruct H as (_ & E).
  apply Nat.eqb_eq in E. now subst.
Qed.

Lemma seconds_once v : In v (inner S) -> NoDup (map snd (steps (fan S v))).
Proof.
  intros Hi. apply inner_vertex in Hi.
  apply (Permutation_NoDup (Permutation_map snd (Permutation_sym (fans S v Hi)))).
  unfold link. rewrite map_map. apply (NoDup_map_inv (fun b => (b, v))). rewrite map_map.
  assert (D0 : NoDup (map (fun f : face => let '(u, a, b) := f in (b, u)) (corners (faces S)))).
  { apply (Permutation_NoDup (l := sides (faces S))); [|apply sides_once].
    unfold sides, corners. induction (faces S) as [|[[a b] c] l IH]; [constructor|].
    simpl. eapply perm_trans; [|apply perm_swap]. apply perm_skip.
    eapply perm_trans; [apply perm_swap|]. do 2 apply perm_skip. assumption. }
  pose proof (NoDup_map_filter _ (fun f => let '(u, a, b) := f in Nat.eqb u v) _ D0) as D.
  erewrite map_ext_in; [exact D|]. intros [[u a] b] H. apply filter_In in H. destruct H as (_ & E).
  apply Nat.eqb_eq in E. now subst.
Qed.

(** What the neighbour on the first, or on the second spoke of a face contributes to K_v(h, .). *)
Definition pull (d d' : point) (x x' : R) : R :=
  dot (gradient d d' x x') (J d) / (2 * dot d d).
Definition pull' (d d' : point) (x x' : R) : R :=
  dot (gradient d d' x x') (J d') / (2 * dot d' d').

Lemma wedge2_pull d d' x x' y y' : cross d d' <> 0 ->
  wedge2 d d' x x' y y' = y * pull d d' x x' - y' * pull' d d' x x'.
Proof.
  intros C. pose proof (cross_left _ _ C) as M. pose proof (cross_right _ _ C) as M'.
  unfold wedge2, pull, pull', gradient. destruct d, d'. coordinates. field. auto.
Qed.

Section Vertex.
Variable v : nat.
Variable h : vec.
Hypothesis Hi : In v (inner S).
Hypothesis Null : forall z, K2 S v h z = 0.

Definition grad (a b : nat) : point := gradient (spoke v a) (spoke v b) (h a - h v) (h b - h v).

Lemma spokes_turn a b : In (a, b) (steps (fan S v)) -> 0 < cross (spoke v a) (spoke v b).
Proof. apply step_left. now apply inner_vertex. Qed.

(** The two faces at a spoke have the same gradient. *)
Lemma same_gradient a b c : In (a, b) (steps (fan S v)) -> In (b, c) (steps (fan S v)) -> grad a b = grad b c.
Proof.
  intros Hab Hbc. pose proof (spokes_turn a b Hab) as Ca. pose proof (spokes_turn b c Hbc) as Cb.
  assert (Nv : b <> v).
  { intros ->. unfold Sheet.spoke, cross, sub in Ca. cbn [fst snd] in Ca. lra. }
  pose proof (Null (unit b)) as E. unfold K2 in E.
  rewrite (sum_ext _ _ (fun s =>
      (if Nat.eq_dec (fst s) (fst (b, c)) then
        pull (spoke v (fst s)) (spoke v (snd s)) (h (fst s) - h v) (h (snd s) - h v) else 0) +
      -1 * (if Nat.eq_dec (snd s) (snd (a, b)) then
        pull' (spoke v (fst s)) (spoke v (snd s)) (h (fst s) - h v) (h (snd s) - h v) else 0))) in E.
  - rewrite sum_plus, sum_scal in E.
    rewrite (sum_key _ Nat.eq_dec fst (b, c)
      (fun s => pull (spoke v (fst s)) (spoke v (snd s)) (h (fst s) - h v) (h (snd s) - h v))) in E
      by (try assumption; now apply firsts_once).
    rewrite (sum_key _ Nat.eq_dec snd (a, b)
      (fun s => pull' (spoke v (fst s)) (spoke v (snd s)) (h (fst s) - h v) (h (snd s) - h v))) in E
      by (try assumption; now apply seconds_once).
    cbn [fst snd] in E. unfold pull, pull' in E. fold (grad a b) in E. fold (grad b c) in E.
    assert (M : dot (spoke v b) (spoke v b) <> 0) by (apply (cross_left _ (spoke v c)); lra).
    pose proof (gradient_right _ _ (h a - h v) (h b - h v) (Rgt_not_eq _ _ Ca)) as X. fold (grad a b) in X.
    pose proof (gradient_left _ _ (h b - h v) (h c - h v) (Rgt_not_eq _ _ Cb)) as Y. fold (grad b c) in Y.
    set (g := grad a b) in *. set (g' := grad b c) in *. set (d := spoke v b) in *.
    assert (E' : dot g' (J d) = dot g (J d)).
    { apply (Rmult_eq_reg_r (/ (2 * dot d d))); [unfold Rdiv in E; lra|].
      apply Rinv_neq_0_compat. lra. }
    assert (D : sub g g' = (0, 0)).
    { clearbody g g' d. clear - X Y E' M. destruct g as [g1 g2], g' as [k1 k2], d as [x y].
      unfold dot, sub, J in *. cbn [fst snd] in *.
      f_equal; apply (Rmult_eq_reg_r (x * x + y * y)); try assumption; rewrite Rmult_0_l.
      - replace ((g1 - k1) * (x * x + y * y)) with
          (x * ((g1 * x + g2 * y) - (k1 * x + k2 * y)) + y * ((k1 * - y + k2 * x) - (g1 * - y + g2 * x))) by ring.
        rewrite X, Y, E'. ring.
      - replace ((g2 - k2) * (x * x + y * y)) with
          (y * ((g1 * x + g2 * y) - (k1 * x + k2 * y)) - x * ((k1 * - y + k2 * x) - (g1 * - y + g2 * x))) by ring.
        rewrite X, Y, E'. ring. }
    destruct g, g'. unfold sub in D. cbn [fst snd] in D. injection D. intros. f_equal; lra.
  - intros [x y] Hs. cbn [fst snd]. rewrite wedge2_pull by (pose proof (spokes_turn x y Hs); lra).
    assert (U : forall z, unit b z - unit b v = if Nat.eq_dec z b then 1 else 0).
    { intros z. unfold unit, upd, zero. destruct (Nat.eq_dec v b); [congruence|].
      destruct (Nat.eq_dec z b); ring. }
    rewrite !U. destruct (Nat.eq_dec x b), (Nat.eq_dec y b); ring.
Qed.

Lemma null_flat : flat_star v h.
Proof.
  destruct (inner_full S v Hi) as (u & up & p & q & down & F & _).
  assert (F' : exists l, fan S v = u :: l ++ [u] /\ l <> []).
  { exists (up ++ p :: q :: down). rewrite F, <- app_assoc. split; [reflexivity|]. now destruct up. }
  destruct F' as (l & F' & _). clear F.
  assert (B : exists b, In (u, b) (steps (fan S v))).
  { rewrite F'. destruct l as [|b l]; [exists u|exists b]; now left. }
  destruct B as (b0 & B0). exists (grad u b0).
  assert (All : forall l1 a l2, fan S v = l1 ++ a :: l2 -> l2 <> [] ->
    forall b, In (a, b) (steps (fan S v)) -> grad a b = grad u b0).
  { induction l1 as [|c l1 IH] using rev_ind; intros a l2 E N b Hb.
    - rewrite E in F'. cbn [app] in F'. injection F' as -> _.
      pose proof (firsts_once v Hi) as D.
      assert (b = b0) as ->; [|reflexivity].
      clear - D Hb B0. induction (steps (fan S v)) as [|[x y] t IH]; [easy|].
      simpl in D. inversion D as [|? ? Nx Dt]; subst.
      destruct Hb as [Hb|Hb], B0 as [B0|B0]; auto.
      + congruence.
      + injection Hb as -> ->. exfalso. apply Nx. apply (in_map fst _ _ B0).
      + injection B0 as -> ->. exfalso. apply Nx. apply (in_map fst _ _ Hb).
    - assert (Hca : In (c, a) (steps (fan S v))).
      { rewrite E, <- app_assoc. cbn [app]. rewrite steps_split. apply in_or_app. right. now left. }
      rewrite <- (same_gradient c a b Hca Hb). apply (IH c (a :: l2)).
      + rewrite E, <- app_assoc. reflexivity.
      + discriminate.
      + assumption. }
  intros a Ha.
  assert (Hb : exists b, In (a, b) (steps (fan S v)) /\ grad a b = grad u b0).
  { rewrite F' in Ha. change (u :: l ++ [u]) with ((u :: l) ++ [u]) in Ha.
    apply in_app_or in Ha. destruct Ha as [Ha|[<-|[]]]; [|eauto].
    destruct (in_split _ _ Ha) as (l1 & l2 & E).
    assert (F2 : fan S v = l1 ++ a :: l2 ++ [u]).
    { rewrite F'. change (u :: l ++ [u]) with ((u :: l) ++ [u]). rewrite E, <- app_assoc. reflexivity. }
    assert (Hs : exists b, In (a, b) (steps (fan S v))).
    { rewrite F2, steps_split. destruct l2 as [|b l2]; [exists u|exists b]; apply in_or_app; right; now left. }
    destruct Hs as (b & Hs). exists b. split; [assumption|].
    apply (All l1 a (l2 ++ [u]) F2); [now destruct l2|assumption]. }
  destruct Hb as (b & Hb & <-). unfold grad. rewrite gradient_left; [reflexivity|].
  pose proof (spokes_turn a b Hb). lra.
Qed.
End Vertex.

(** Functions that are linear on the whole sheet change nothing. *)
Definition affine (c : R) (g : point) : vec := fun u => c + dot g (at_ u).

Lemma K_affine v h c g : In v (inner S) -> K S v (minus h (affine c g)) = K S v h.
Proof.
  intros Hi. rewrite <- (K_plane S v g h Hi). apply K_ext. intros u. unfold minus, affine, plane. ring.
Qed.

Lemma K2_half v a b : In v (inner S) -> K2 S v a b = (K S v (move a 1 b) - K S v a - K S v b) / 2.
Proof. intros Hi. rewrite K_move by now apply inner_vertex. field. Qed.

Lemma K2_affine v a b c g c' g' : In v (inner S) ->
  K2 S v (minus a (affine c g)) (minus b (affine c' g')) = K2 S v a b.
Proof.
  intros Hi. rewrite !K2_half, !K_affine by assumption.
  rewrite <- (K_affine v (move a 1 b) (c + c') (fst g + fst g', snd g + snd g') Hi).
  do 3 f_equal. apply K_ext. intros u. unfold move, minus, affine, dot. cbn [fst snd]. ring.
Qed.

Lemma fan_values v a a' b : (forall u, In u (fan S v) -> a u - a v = a' u - a' v) -> K2 S v a b = K2 S v a' b.
Proof.
  intros E. apply sum_ext. intros [x y] Hs.
  assert (H : In x (fan S v) /\ In y (fan S v)).
  { destruct (fan S v) as [|z l]; [easy|]. apply steps_in in Hs. simpl in *. tauto. }
  now rewrite !E.
Qed.

Lemma flat_null v h : In v (inner S) -> flat_star v h -> forall z, K2 S v h z = 0.
Proof.
  intros Hi (g & E) z. rewrite (fan_values v h (affine 0 g)).
  - replace (affine 0 g) with (minus zero (affine 0 (- fst g, - snd g))).
    + replace z with (minus z (affine 0 (0, 0))).
      * rewrite K2_affine by assumption. rewrite K2_sym.
        apply (linear_zero (K2 S v z)). intros a s b. apply K2_move.
      * apply functional_extensionality. intro u. unfold minus, affine, dot. cbn [fst snd]. ring.
    + apply functional_extensionality. intro u. unfold minus, affine, dot, zero. cbn [fst snd]. ring.
  - intros u Hu. rewrite (E u Hu). unfold affine, dot, Sheet.spoke, sub. cbn [fst snd]. ring.
Qed.

Theorem flat_star_iff v h : In v (inner S) -> (flat_star v h <-> forall z, K2 S v h z = 0).
Proof. intros Hi. split; [now apply flat_null|now apply null_flat]. Qed.

End Flat.
