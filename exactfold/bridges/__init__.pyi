from exactfold.bridges.export import to_homotopy_continuation as to_homotopy_continuation
from exactfold.bridges.export import to_macaulay2 as to_macaulay2
from exactfold.bridges.export import to_msolve as to_msolve
from exactfold.bridges.export import to_singular as to_singular
from exactfold.bridges.export import to_sympy as to_sympy
