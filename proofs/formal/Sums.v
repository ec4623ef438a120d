(** Finite sums of real numbers over lists, and what else is needed of lists. *)
From Coq Require Import Reals List Permutation Lra.
Import ListNotations.
Open Scope R_scope.

Fixpoint sum {A : Type} (l : list A) (f : A -> R) : R :=
  match l with [] => 0 | a :: l => f a + sum l f end.

Section Sums.
Context {A : Type}.
Implicit Types (l : list A) (f g : A -> R).

Lemma sum_ext l f g : (forall a, In a l -> f a = g a) -> sum l f = sum l g.
Proof.
  induction l as [|a l IH]; simpl; intros E; [reflexivity|].
  rewrite (E a), IH; auto.
Qed.

Lemma sum_le l f g : (forall a, In a l -> f a <= g a) -> sum l f <= sum l g.
Proof.
  induction l as [|a l IH]; simpl; intros E; [lra|].
  pose proof (E a (or_introl eq_refl)). assert (sum l f <= sum l g) by auto. lra.
Qed.

Lemma sum_plus l f g : sum l (fun a => f a + g a) = sum l f + sum l g.
Proof. induction l; simpl; lra. Qed.

Lemma sum_scal l s f : sum l (fun a => s * f a) = s * sum l f.
Proof. induction l as [|a l IH]; simpl; [|rewrite IH]; ring. Qed.

Lemma sum_zero l f : (forall a, In a l -> f a = 0) -> sum l f = 0.
Proof.
  intros E. rewrite (sum_ext l f (fun a => 0 * 0)).
  - rewrite (sum_scal l 0 (fun _ => 0)). ring.
  - intros a Ha. rewrite (E a Ha). ring.
Qed.

Lemma sum_nonneg l f : (forall a, In a l -> 0 <= f a) -> 0 <= sum l f.
Proof. intros E. rewrite <- (sum_zero l (fun _ => 0)) by auto. now apply sum_le. Qed.

Lemma sum_nonpos l f : (forall a, In a l -> f a <= 0) -> sum l f <= 0.
Proof. intros E. rewrite <- (sum_zero l (fun _ => 0)) by auto. now apply sum_le. Qed.

Lemma sum_app l l' f : sum (l ++ l') f = sum l f + sum l' f.
Proof. induction l; simpl; lra. Qed.

Lemma sum_perm l l' f : Permutation l l' -> sum l f = sum l' f.
Proof. induction 1; simpl; lra. Qed.

Lemma sum_abs l f : Rabs (sum l f) <= sum l (fun a => Rabs (f a)).
Proof.
  induction l as [|a l IH]; simpl; [rewrite Rabs_R0; lra|].
  eapply Rle_trans; [apply Rabs_triang|lra].
Qed.

(** A sum of nonnegative terms is at least each of them. *)
Lemma sum_ge_term l f a : (forall b, In b l -> 0 <= f b) -> In a l -> f a <= sum l f.
Proof.
  intros P Ha. destruct (in_split _ _ Ha) as (l1 & l2 & ->).
  rewrite sum_app. simpl.
  assert (0 <= sum l1 f) by (apply sum_nonneg; intros; apply P, in_or_app; auto).
  assert (0 <= sum l2 f) by (apply sum_nonneg; intros; apply P, in_or_app; simpl; auto).
  lra.
Qed.

Lemma sum_nonneg_null l f :
  (forall a, In a l -> 0 <= f a) -> sum l f <= 0 -> forall a, In a l -> f a = 0.
Proof.
  intros P S a Ha. pose proof (sum_ge_term l f a P Ha). pose proof (P a Ha). lra.
Qed.

Lemma sum_pos l f : l <> [] -> (forall a, In a l -> 0 < f a) -> 0 < sum l f.
Proof.
  intros N P. destruct l as [|a l]; [easy|]. simpl.
  assert (0 <= sum l f) by (apply sum_nonneg; intros; apply Rlt_le, P; simpl; auto).
  pose proof (P a (or_introl eq_refl)). lra.
Qed.

Lemma sum_map {B} (h : B -> A) (l : list B) f : sum (map h l) f = sum l (fun b => f (h b)).
Proof. induction l; simpl; congruence. Qed.

Lemma sum_flat_map {B} (h : B -> list A) (l : list B) f :
  sum (flat_map h l) f = sum l (fun b => sum (h b) f).
Proof. induction l as [|b l IH]; simpl; [|rewrite sum_app, IH]; reflexivity. Qed.

Lemma sum_const_le l f c : (forall a, In a l -> f a <= c) -> sum l f <= INR (length l) * c.
Proof.
  induction l as [|a l IH]; intros E; [simpl; lra|].
  change (length (a :: l)) with (S (length l)). rewrite S_INR. simpl sum.
  pose proof (E a (or_introl eq_refl)).
  assert (sum l f <= INR (length l) * c) by (apply IH; intros; apply E; simpl; auto).
  lra.
Qed.

(** Finitely many positive bounds have a common one. *)
Lemma common_bound l (P : A -> R -> Prop) :
  (forall a c d, P a c -> d <= c -> P a d) ->
  (forall a, In a l -> exists c, 0 < c /\ P a c) -> exists c, 0 < c /\ forall a, In a l -> P a c.
Proof.
  intros M. induction l as [|a l IH]; intros E.
  - exists 1. split; [lra|easy].
  - destruct (E a (or_introl eq_refl)) as (c & Pc & Hc).
    destruct IH as (d & Pd & Hd); [intros; apply E; simpl; auto|].
    exists (Rmin c d). split; [now apply Rmin_pos|].
    intros b [->|Hb]; eapply M; eauto using Rmin_l, Rmin_r.
Qed.

(** A nonempty list has an element with the largest value. *)
Lemma arg_max l f : l <> [] -> exists a, In a l /\ forall b, In b l -> f b <= f a.
Proof.
  induction l as [|a l IH]; [easy|intros _].
  destruct l as [|a' l]; [exists a; simpl; split; [auto|intros b [->|[]]; lra]|].
  destruct IH as (m & Hm & M); [easy|].
  destruct (Rle_lt_dec (f m) (f a)).
  - exists a. split; [now left|]. intros b [->|Hb]; [lra|]. specialize (M b Hb). lra.
  - exists m. split; [now right|]. intros b [->|Hb]; [lra|]. auto.
Qed.

End Sums.

Lemma sum_swap {A B} (l : list A) (m : list B) (f : A -> B -> R) :
  sum l (fun a => sum m (f a)) = sum m (fun b => sum l (fun a => f a b)).
Proof.
  induction l as [|a l IH]; simpl.
  - symmetry. now apply sum_zero.
  - rewrite IH, <- sum_plus. reflexivity.
Qed.
