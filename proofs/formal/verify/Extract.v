(** The programs of Verify.v in OCaml: numbers of vertices become machine integers, integers become
    those of Zarith (integer.ml). *)
From Coq Require Import ZArith Extraction ExtrOcamlBasic ExtrOcamlNatInt ExtrOcamlZBigInt.
From Exactfold Require Import Drawing Integers Verify Charts Emptied Exact Space Rooted Listed Reflex Flex.

Extract Inlined Constant Nat.eqb => "Int.equal".
Extract Inlined Constant Nat.eq_dec => "Int.equal".
Extract Constant Pos.of_succ_nat => "(fun n -> Integer.of_int (n + 1))".
Extract Inlined Constant Z.add => "Integer.add".
Extract Inlined Constant Z.sub => "Integer.sub".
Extract Inlined Constant Z.mul => "Integer.mul".
Extract Inlined Constant Z.opp => "Integer.neg".
Extract Inlined Constant Z.ltb => "Integer.lt".
Extract Inlined Constant Z.leb => "Integer.leq".
Extract Inlined Constant Z.eqb => "Integer.equal".

Extraction "verified.ml" verify_all verify_one verify_all_notched verify_one_notched sound closes emptied passes
  raised_passes measured is_bent verify_exact verify_exact_notched exact_hub exact_fold names_side
  weight within moves_as_a_disk curved sided polar powers paired root_ok verify_listed reflex_ok verify_reflex.
