(** A sheet, written by exactfold.  Coordinates are multiplied by 840.
    Once `make -C proofs/formal` is done: coqc -Q proofs/formal Exactfold THIS_FILE.v *)
From Coq Require Import Reals ZArith List Lra.
From Exactfold Require Import Vectors Nappes Sheet Flat Complex Theorems Branches Drawing.
Import ListNotations.
Open Scope nat_scope.

Definition sheet_drawing : drawing := {|
  points := [(0, 0); (840, 0); (840, 840); (0, 840); (280, 336); (525, 480)]%Z;
  inside := [4; 5];
  border := [1; 2; 3; 0];
  triangles := [(0, 1, 4); (1, 5, 4); (1, 2, 5); (2, 3, 5); (3, 4, 5); (0, 4, 3)];
  fans_of := [[1; 4; 3]; [2; 5; 4; 0]; [3; 5; 1]; [0; 4; 5; 2]; [0; 1; 5; 3; 0]; [1; 2; 3; 4; 1]]
|}.

(** The hypotheses of a convex sheet, decided by computation. *)
Lemma sheet_checked : check sheet_drawing = true.
Proof. vm_compute. reflexivity. Qed.
Definition this_sheet : sheet := sheet_of sheet_drawing sheet_checked.
Lemma size : length (inner this_sheet) = 2.
Proof. reflexivity. Qed.

(** For given boundary heights and curvatures > 0: 2^2 shapes. *)
Theorem shapes (k : nat -> R) (r : vec) : (forall v, In v (inside sheet_drawing) -> (0 < k v)%R) ->
  exists l : list vec, length l = 2 ^ 2 /\ NoDup l /\
    forall h, In h l <-> has_rim this_sheet r h /\ solves this_sheet k h.
Proof.
  intros P. destruct (list_of_solutions this_sheet k r) as (l & Len & Sol & Once).
  - intros v Hv. apply Rlt_le, P, Hv.
  - rewrite size in Len. exists l. refine (conj Len (conj _ Sol)).
    apply Once. intros h _ Hs v Hv. left. rewrite (Hs v Hv). apply P, Hv.
Qed.

Lemma corners : cross (sub (at_R sheet_drawing 2) (at_R sheet_drawing 1))
  (sub (at_R sheet_drawing 3) (at_R sheet_drawing 1)) <> 0%R.
Proof. rewrite cross_IZR. now apply (IZR_neq _ 0). Qed.

(** At most 2^2 branches, all real.  The file with all certificates (`--all`) proves that they are
    exactly so many, as its certificates show that no star is flat on any branch. *)
Theorem at_most : exists l : list vec, length l = 2 ^ 2 /\
  (forall h, In h l <-> representative this_sheet 0 h) /\
  forall z, complex_solution this_sheet z ->
    complex_affine this_sheet z \/ exists s h, In h l /\ on_branch this_sheet z s h.
Proof.
  pose proof (at_most_2_to_the_n this_sheet 1 2 3 0 eq_refl corners) as H.
  rewrite size in H. exact H.
Qed.
