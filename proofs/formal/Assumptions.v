(** What the theorems assume: printed by the build, compared by tests/proofs/test_formal.py. *)
From Exactfold Require Import Nappes Sheet Identities Star KeyLemma Flat Complex Theorems Branches Notch
  Krawczyk Drawing Rational Boxes Certificate Counted Tables Integers Verify Charts Triangles Emptied Exact
  Patterns Space Contracting Rooted Within Listed Reflex Flex
  Curve Displacements Motion Near Gap Placed Ways Example BranchExample.

Print Assumptions key_lemma.
Print Assumptions one_solution_per_sign_vector.
Print Assumptions all_real.
Print Assumptions exactly_2_to_the_n.
Print Assumptions distance.
Print Assumptions branches.
Print Assumptions krawczyk.
Print Assumptions certified.
Print Assumptions counted.
Print Assumptions all_verified.
Print Assumptions one_verified.
Print Assumptions distance_verified.
Print Assumptions all_notched_verified.
Print Assumptions one_notched_verified.
Print Assumptions chart_verified.
Print Assumptions emptied_verified.
Print Assumptions all_emptied_verified.
Print Assumptions all_notched_emptied_verified.
Print Assumptions exact_verified.
Print Assumptions exact_notched_verified.
Print Assumptions listed_verified.
Print Assumptions reflex_verified.
Print Assumptions disk_moves.
Print Assumptions curve.
Print Assumptions motion.
Print Assumptions true_motion_exists.
Print Assumptions ways.
Print Assumptions near_flat.
Print Assumptions all_continue.
Print Assumptions one_continues.
Print Assumptions exact_continues.

(** The others together. *)
Definition others :=
  (one_solution, weighted_curvatures, wirtinger, one_positive_direction, L, L_flat, flat_star_iff,
   key_energy, no_zero_at_infinity, definite_stress, jacobian_nonsingular, jacobian_singular,
   simple_iff_no_flat_star, different_sign_vectors, list_of_solutions, rigid,
   every_solution_on_a_branch, branch_has_one_representative, at_most_2_to_the_n,
   two_branches_per_pair, krawczyk_nonsingular, unique, cone_positive, sheet_of, Example.shapes, Example.at_most,
   boxed, no_star_is_flat, near_branch, near_solution, passed,
   open_solution_on_a_branch, branch_has_one_raised, notched, triangle_curvature,
   triangle_flat, flex_curvature, flex_iff, disk_checked, swift_checked, the_branch, gap, placing,
   @all_counted, @all_listed, @listed, @raised_listed, listed_continue).
Print Assumptions others.
