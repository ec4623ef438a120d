(** A square with one vertex inside: the hypotheses of a sheet can be met, and are decided by
    computation.  `exactfold export PATTERN.fold --coq` writes such a file. *)
From Coq Require Import Reals ZArith List Lra.
From Exactfold Require Import Vectors Nappes Sheet Flat Complex Theorems Branches Drawing.
Import ListNotations.
Open Scope nat_scope.

Definition d : drawing := {|
  points := [(0, 0); (4, 0); (4, 4); (0, 4); (1, 2)]%Z;
  inside := [4];
  border := [0; 1; 2; 3];
  triangles := [(0, 1, 4); (1, 2, 4); (2, 3, 4); (3, 0, 4)];
  fans_of := [[1; 4; 3]; [2; 4; 0]; [3; 4; 1]; [0; 4; 2]; [0; 1; 2; 3; 0]]
|}.
Definition square : sheet := sheet_of d (eq_refl true).

(** With any heights of the rim there are exactly two shapes with curvature 1 at the vertex. *)
Theorem square_has_two_domes (r : vec) : exists l : list vec, length l = 2 /\ NoDup l /\
  forall h, In h l -> has_rim square r h /\ solves square (fun _ => 1%R) h.
Proof.
  destruct (list_of_solutions square (fun _ => 1%R) r) as (l & Len & Sol & Once); [intros; lra|].
  exists l. split; [exact Len|]. split; [|intros h; apply Sol].
  apply Once. intros h _ Hs v Hv. left. rewrite (Hs v Hv). lra.
Qed.

Theorem square_has_at_most_two_branches : exists l : list vec, length l = 2 /\
  forall z, complex_solution square z ->
    complex_affine square z \/ exists s h, In h l /\ on_branch square z s h.
Proof.
  destruct (at_most_2_to_the_n square 0 1 2 3 eq_refl) as (l & Len & _ & Sol).
  - change (cross (sub (at_R d 1) (at_R d 0)) (sub (at_R d 2) (at_R d 0)) <> 0%R).
    rewrite cross_IZR. now apply (IZR_neq _ 0).
  - now exists l.
Qed.
