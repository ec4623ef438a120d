(** Complex heights: only what is needed to state that all solutions are real. *)
From Coq Require Import Reals List Lra FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Nappes Sheet Identities Star KeyLemma Flat.
Import ListNotations.
Open Scope R_scope.

Definition complex := (R * R)%type.
Definition re (z : complex) : R := fst z.
Definition im (z : complex) : R := snd z.
Definition real (x : R) : complex := (x, 0).
Definition cadd (z w : complex) : complex := (re z + re w, im z + im w).
Definition csub (z w : complex) : complex := (re z - re w, im z - im w).
Definition cmul (z w : complex) : complex := (re z * re w - im z * im w, re z * im w + im z * re w).
Definition csum {A} (l : list A) (f : A -> complex) : complex :=
  (sum l (fun a => re (f a)), sum l (fun a => im (f a))).

Definition cvec := nat -> complex.
Definition re_part (z : cvec) : vec := fun u => re (z u).
Definition im_part (z : cvec) : vec := fun u => im (z u).

(** [wedge] with complex heights. *)
Definition cwedge (d d' : point) (x x' : complex) : complex :=
  csub (cmul (real (/ cross d d')) (cmul x x'))
    (cmul (real (dot d d' / (2 * cross d d')))
      (cadd (cmul (real (/ dot d d)) (cmul x x)) (cmul (real (/ dot d' d')) (cmul x' x')))).

Section Complex.
Variable S : sheet.

(** The curvature form with complex heights. *)
Definition KC (v : nat) (z : cvec) : complex :=
  csum (steps (fan S v)) (fun s => let '(a, b) := s in
    cwedge (spoke (at_ S) v a) (spoke (at_ S) v b) (csub (z a) (z v)) (csub (z b) (z v))).

Lemma KC_parts v z : In v (inner S ++ rim S) -> KC v z =
  (K S v (re_part z) - K S v (im_part z), 2 * K2 S v (re_part z) (im_part z)).
Proof.
  intros Hv. unfold KC, csum. f_equal.
  - replace (K S v (re_part z) - K S v (im_part z)) with (K S v (re_part z) + -1 * K S v (im_part z)) by ring.
    unfold K. rewrite <- sum_scal, <- sum_plus. apply sum_ext. intros [a b] Hs.
    pose proof (step_left S v a b Hv Hs) as C.
    pose proof (cross_left _ _ (Rgt_not_eq _ _ C)). pose proof (cross_right _ _ (Rgt_not_eq _ _ C)).
    unfold cwedge, wedge, csub, cadd, cmul, real, re_part, im_part, re, im. cbn [fst snd].
    field. repeat split; lra.
  - unfold K2. rewrite <- sum_scal. apply sum_ext. intros [a b] Hs.
    pose proof (step_left S v a b Hv Hs) as C.
    pose proof (cross_left _ _ (Rgt_not_eq _ _ C)). pose proof (cross_right _ _ (Rgt_not_eq _ _ C)).
    unfold cwedge, wedge2, csub, cadd, cmul, real, re_part, im_part, re, im. cbn [fst snd].
    field. repeat split; lra.
Qed.

Lemma KC_equation v z k : In v (inner S) -> KC v z = real k ->
  K S v (re_part z) = K S v (im_part z) + k /\ K2 S v (re_part z) (im_part z) = 0.
Proof.
  intros Hi E. rewrite KC_parts in E by now apply inner_vertex.
  unfold real in E. injection E as E1 E2. lra.
Qed.

End Complex.
