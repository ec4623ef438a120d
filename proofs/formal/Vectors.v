(** Vectors with finitely many unknown coordinates, and n linear equations in n of them.

    A vector is a function from [nat]; the unknown coordinates are those in a list [I]. *)
From Coq Require Import Reals List Permutation Lra Lia Arith FunctionalExtensionality.
From Exactfold Require Import Sums.
Import ListNotations.
Open Scope R_scope.

Definition vec := nat -> R.
Definition zero : vec := fun _ => 0.
(** [move a s b] is a + s b. *)
Definition move (a : vec) (s : R) (b : vec) : vec := fun i => a i + s * b i.
Definition minus (a b : vec) : vec := fun i => a i - b i.
Definition upd (a : vec) (i : nat) (s : R) : vec := fun j => if Nat.eq_dec j i then s else a j.
Definition unit (i : nat) : vec := upd zero i 1.

(** [a] vanishes at all places that are not in [I]. *)
Definition zero_off (I : list nat) (a : vec) := forall i, ~ In i I -> a i = 0.
Definition norm (I : list nat) (a : vec) := sum I (fun i => Rabs (a i)).
Definition linear (f : vec -> R) := forall a s b, f (move a s b) = f a + s * f b.

Ltac vec := apply functional_extensionality; intro;
  unfold move, minus, zero; try ring.

Lemma upd_same a i s : upd a i s i = s.
Proof. unfold upd. now destruct Nat.eq_dec. Qed.

Lemma upd_other a i s j : j <> i -> upd a i s j = a j.
Proof. unfold upd. now destruct Nat.eq_dec. Qed.

Lemma upd_upd a i s s' : upd (upd a i s) i s' = upd a i s'.
Proof. apply functional_extensionality; intro j. unfold upd. now destruct Nat.eq_dec. Qed.

Lemma upd_id a i : upd a i (a i) = a.
Proof. apply functional_extensionality; intro j. unfold upd. destruct Nat.eq_dec; congruence. Qed.

Lemma minus_move a b : minus a b = move a (-1) b.
Proof. vec. Qed.

Lemma move_minus a b : move b 1 (minus a b) = a.
Proof. vec. Qed.

Lemma linear_zero f : linear f -> f zero = 0.
Proof.
  intros L. pose proof (L zero (-1) zero) as E.
  replace (move zero (-1) zero) with zero in E by vec. lra.
Qed.

Lemma norm_nonneg I a : 0 <= norm I a.
Proof. apply sum_nonneg. intros. apply Rabs_pos. Qed.

Lemma norm_zero I a : zero_off I a -> norm I a <= 0 -> a = zero.
Proof.
  intros Z N. apply functional_extensionality; intro i. unfold zero.
  destruct (in_dec Nat.eq_dec i I) as [Hi|Hi]; [|now apply Z].
  pose proof (sum_nonneg_null I (fun i => Rabs (a i)) (fun i _ => Rabs_pos (a i)) N i Hi) as E.
  simpl in E. destruct (Req_dec (a i) 0) as [|D]; [assumption|].
  apply Rabs_no_R0 in D. contradiction.
Qed.

(** Removing one coordinate. *)
Lemma zero_off_cons i I a : zero_off (i :: I) a -> zero_off I (move a (- a i) (unit i)).
Proof.
  intros Z j Hj. unfold move, unit. destruct (Nat.eq_dec j i) as [->|D].
  - rewrite upd_same. ring.
  - rewrite (upd_other _ _ _ _ D). rewrite Z; [unfold zero; ring|].
    simpl. intros [E|E]; [now apply D|contradiction].
Qed.

Lemma move_unit_other i a s j : j <> i -> move a s (unit i) j = a j.
Proof. intros D. unfold move, unit. rewrite upd_other by assumption. unfold zero. ring. Qed.

Lemma linear_coordinates f I a : linear f -> NoDup I -> zero_off I a ->
  f a = sum I (fun i => f (unit i) * a i).
Proof.
  intros L D. revert a. induction I as [|i I IH]; intros a Z; simpl.
  - replace a with zero; [now apply linear_zero|]. vec. symmetry. now apply Z.
  - inversion D as [|? ? Hi DI]; subst.
    specialize (IH DI _ (zero_off_cons _ _ _ Z)). rewrite L in IH.
    rewrite (sum_ext I _ (fun i => f (unit i) * a i)) in IH; [lra|].
    intros j Hj. rewrite move_unit_other; [reflexivity|]. intros ->. contradiction.
Qed.

Lemma sum_unit l k (f : nat -> R) : NoDup l -> In k l -> sum l (fun j => unit k j * f j) = f k.
Proof.
  induction l as [|j l IH]; [easy|]. intros D H. inversion D as [|? ? N D']; subst. cbn [sum].
  destruct (Nat.eq_dec j k) as [->|Ne].
  - unfold unit at 1. rewrite upd_same, sum_zero; [ring|]. intros i Hi. unfold unit.
    rewrite upd_other; [unfold zero; ring|].
    intros ->. contradiction.
  - destruct H as [->|H]; [contradiction|]. rewrite IH by assumption. unfold unit. rewrite upd_other by assumption.
    unfold zero. ring.
Qed.

(** A seminorm is bounded by a multiple of the sum of the coordinates. *)
Definition seminorm (p : vec -> R) :=
  p zero = 0 /\ (forall a, 0 <= p a) /\ forall a s b, p (move a s b) <= p a + Rabs s * p b.

Lemma seminorm_bound p I : seminorm p -> NoDup I ->
  exists L, 0 <= L /\ forall a, zero_off I a -> p a <= L * norm I a.
Proof.
  intros (P0 & PP & T) D. exists (sum I (fun i => p (unit i))). split.
  { apply sum_nonneg. auto. }
  cut (forall a, zero_off I a -> p a <= sum I (fun i => Rabs (a i) * p (unit i))).
  { intros C a Z. eapply Rle_trans; [now apply C|]. rewrite Rmult_comm, <- sum_scal.
    apply sum_le. intros i Hi. apply Rmult_le_compat_r; [auto|].
    apply (sum_ge_term I (fun i => Rabs (a i))); [intros; apply Rabs_pos|assumption]. }
  induction I as [|i I IH]; intros a Z; simpl.
  - replace a with zero; [rewrite P0; lra|]. vec. symmetry. now apply Z.
  - inversion D as [|? ? Hi DI]; subst.
    specialize (IH DI _ (zero_off_cons _ _ _ Z)).
    rewrite (sum_ext I _ (fun i => Rabs (a i) * p (unit i))) in IH.
    + replace a with (move (move a (- a i) (unit i)) (a i) (unit i)) at 1 by vec.
      eapply Rle_trans; [apply T|]. lra.
    + intros j Hj. rewrite move_unit_other; [reflexivity|]. intros ->. contradiction.
Qed.

(** Fewer homogeneous linear equations than unknowns have a solution that is not 0. *)
Lemma nontrivial_solution : forall n (eqs : list vec) vs,
  length eqs = n -> NoDup vs -> (n < length vs)%nat ->
  exists c : vec, (exists v, In v vs /\ c v <> 0) /\
    forall a, In a eqs -> sum vs (fun v => a v * c v) = 0.
Proof.
  induction n as [|n IH]; intros eqs vs Len D Lt.
  { destruct eqs; [|easy]. destruct vs as [|v vs]; [simpl in Lt; lia|].
    exists (unit v). split; [|easy]. exists v. split; [now left|]. unfold unit. rewrite upd_same. lra. }
  destruct eqs as [|a eqs]; [easy|]. simpl in Len.
  assert (C : (exists v, In v vs /\ a v <> 0) \/ forall v, In v vs -> a v = 0).
  { clear. induction vs as [|v vs [(u & Hu & Au)|Z]].
    - right. easy.
    - left. exists u. simpl. auto.
    - destruct (Req_dec (a v) 0) as [E|E].
      + right. intros u [->|Hu]; auto.
      + left. exists v. simpl. auto. }
  destruct C as [(p & Hp & Ap)|Z].
  - destruct (in_split _ _ Hp) as (l1 & l2 & ->).
    set (vs := l1 ++ l2).
    assert (Perm : Permutation (l1 ++ p :: l2) (p :: vs)) by (symmetry; apply Permutation_middle).
    assert (Dp : NoDup (p :: vs)) by now apply (Permutation_NoDup Perm).
    inversion Dp as [|? ? Np Dvs]; subst.
    set (f := fun (b : vec) v => b v - b p / a p * a v).
    destruct (IH (map f eqs) vs) as (c & (v & Hv & Cv) & Hc).
    { rewrite map_length. lia. } { assumption. }
    { apply Permutation_length in Perm. simpl in Perm. lia. }
    set (s := - sum vs (fun v => a v * c v) / a p).
    exists (upd c p s).
    assert (K : forall b, sum (l1 ++ p :: l2) (fun v => b v * upd c p s v) =
      b p * s + sum vs (fun v => b v * c v)).
    { intros b. rewrite (sum_perm _ _ _ Perm). simpl. rewrite upd_same. f_equal. apply sum_ext.
      intros u Hu. rewrite upd_other; [reflexivity|]. intros ->. contradiction. }
    split.
    + exists v. split.
      * apply (Permutation_in v (Permutation_sym Perm)). now right.
      * rewrite upd_other; [assumption|]. intros ->. contradiction.
    + intros b [<-|Hb]; rewrite K; unfold s.
      * field. assumption.
      * pose proof (Hc (f b) (in_map f _ _ Hb)) as E. unfold f in E.
        rewrite (sum_ext vs _ (fun v => b v * c v + - (b p / a p) * (a v * c v))) in E
          by (intros; ring).
        rewrite sum_plus, sum_scal in E. rewrite <- E. field. assumption.
  - destruct (IH eqs vs) as (c & Nc & Hc); [lia|assumption|lia|].
    exists c. split; [assumption|]. intros b [<-|Hb]; [|auto].
    apply sum_zero. intros v Hv. rewrite Z by assumption. ring.
Qed.

(** n linear equations in n unknowns with the only solution 0 for right side 0 can be solved. *)
Lemma solve (I : list nat) (m : nat -> vec -> R) : NoDup I ->
  (forall i, In i I -> linear (m i)) ->
  (forall w, zero_off I w -> (forall i, In i I -> m i w = 0) -> w = zero) ->
  forall b : vec, exists w, zero_off I w /\ forall i, In i I -> m i w = b i.
Proof.
  intros D L Inj b.
  set (z := S (list_max I)).
  assert (Nz : ~ In z I).
  { intros H. pose proof (proj1 (list_max_le I (list_max I)) (le_n _)) as F.
    rewrite Forall_forall in F. specialize (F z H). unfold z in F. lia. }
  destruct (nontrivial_solution (length I)
    (map (fun i => upd (fun v => m i (unit v)) z (- b i)) I) (z :: I)) as (c & (v & Hv & Cv) & Hc).
  { apply map_length. } { now constructor. } { simpl. lia. }
  set (w := fun v => if in_dec Nat.eq_dec v I then c v else 0).
  assert (Zw : zero_off I w). { intros u Hu. unfold w. now destruct in_dec. }
  assert (W : forall u, In u I -> w u = c u). { intros u Hu. unfold w. now destruct in_dec. }
  assert (E : forall i, In i I -> m i w = b i * c z).
  { intros i Hi. specialize (Hc _ (in_map _ _ _ Hi)). simpl in Hc. rewrite upd_same in Hc.
    rewrite (linear_coordinates _ I) by auto.
    rewrite (sum_ext I _ (fun u => m i (unit u) * w u)) in Hc; [lra|].
    intros u Hu. rewrite upd_other, W; [reflexivity|assumption|]. intros ->. contradiction. }
  assert (Cz : c z <> 0).
  { intros Z. apply Cv. destruct Hv as [<-|Hv]; [assumption|].
    rewrite <- (W v Hv). replace w with zero; [reflexivity|]. symmetry. apply Inj; [assumption|].
    intros i Hi. rewrite E by assumption. rewrite Z. ring. }
  exists (fun v => w v / c z). split.
  - intros u Hu. rewrite Zw by assumption. field. assumption.
  - intros i Hi.
    replace (fun v => w v / c z) with (move zero (/ c z) w) by (vec; field; assumption).
    rewrite L, linear_zero, E by auto. field. assumption.
Qed.
