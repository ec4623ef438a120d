"""exactfold: proven branch counts of triangulated origami near the unfolded state.

Given a flat triangulated sheet with rational coordinates, `count_branches` says in how many ways it
starts to fold, proves it, and tells the ways apart by vertex signs and mountain-valley assignments.

>>> import exactfold
>>> result = exactfold.count_branches(exactfold.read_fold(exactfold.example_path("two-vertex")))
>>> result
<BranchCount: proved, 4 branches, <CreasePattern: 2 interior and 4 boundary vertices>>
>>> [branch.sign_text for branch in result.branches]
['--', '-+', '+-', '++']
"""

from exactfold.branches.branch import Branch
from exactfold.branches.claims import certificate
from exactfold.branches.result import BranchCount
from exactfold.certify.arb_krawczyk import arb_krawczyk
from exactfold.certify.certificate import write_certificate
from exactfold.certify.interval_newton import interval_newton
from exactfold.certify.isolation import isolate
from exactfold.certify.krawczyk import krawczyk
from exactfold.count import METHODS, count_branches
from exactfold.data import EXAMPLES, example_path
from exactfold.errors import ExactfoldError, InputError
from exactfold.exact.factor_degrees import factor_degrees
from exactfold.exact.forms import QuadraticForm
from exactfold.exact.numbers import as_rational
from exactfold.ondemand.find import BranchFinder, find_branch, find_branches, neighbours
from exactfold.ondemand.result import SignedBranch
from exactfold.pattern import degenerate, families
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.delaunay import delaunay
from exactfold.pattern.fold import FoldFile, load_fold, read_fold
from exactfold.pattern.fold_writing import write_fold
from exactfold.pattern.random_squares import random_square
from exactfold.rigidity.all_real import decide_all_branches_real
from exactfold.rigidity.curvature import curvature_form, stress_form, wheel_stress
from exactfold.rigidity.definite_stress import definite_stress
from exactfold.rigidity.facts import pattern_facts
from exactfold.rigidity.framework import rigidity_matrix, self_stresses
from exactfold.scale.check import check_compact
from exactfold.scale.dask_engine import dask_engine
from exactfold.scale.read import read_branches
from exactfold.scale.stream import StreamedCount, count_streaming
from exactfold.solve.from_roots import parametrisation_from_roots
from exactfold.solve.groebner import groebner, quotient_algebra
from exactfold.solve.hermite import hermite_counts
from exactfold.solve.homotopy import homotopy
from exactfold.solve.methods import find_candidates
from exactfold.solve.nappe_ends import nappe_ends
from exactfold.solve.popping import popping
from exactfold.solve.splitting import split_form
from exactfold.system.branch_system import BranchSystem, Chart
from exactfold.system.export import (
    to_homotopy_continuation,
    to_macaulay2,
    to_msolve,
    to_singular,
    to_sympy,
)
from exactfold.system.perturbed import perturbed
from exactfold.system.quadratic import QuadraticSystem
from exactfold.verdict import PROVED, REFUTED, UNDECIDED, Verdict

__all__ = [
    "EXAMPLES",
    "METHODS",
    "PROVED",
    "REFUTED",
    "UNDECIDED",
    "Branch",
    "BranchCount",
    "BranchFinder",
    "BranchSystem",
    "Chart",
    "CreasePattern",
    "ExactfoldError",
    "FoldFile",
    "InputError",
    "QuadraticForm",
    "QuadraticSystem",
    "SignedBranch",
    "StreamedCount",
    "Verdict",
    "arb_krawczyk",
    "as_rational",
    "certificate",
    "check_compact",
    "count_branches",
    "count_streaming",
    "curvature_form",
    "dask_engine",
    "decide_all_branches_real",
    "definite_stress",
    "degenerate",
    "delaunay",
    "example_path",
    "factor_degrees",
    "families",
    "find_branch",
    "find_branches",
    "find_candidates",
    "groebner",
    "hermite_counts",
    "homotopy",
    "interval_newton",
    "isolate",
    "krawczyk",
    "load_fold",
    "nappe_ends",
    "neighbours",
    "parametrisation_from_roots",
    "pattern_facts",
    "perturbed",
    "popping",
    "quotient_algebra",
    "random_square",
    "read_branches",
    "read_fold",
    "rigidity_matrix",
    "self_stresses",
    "split_form",
    "stress_form",
    "to_homotopy_continuation",
    "to_macaulay2",
    "to_msolve",
    "to_singular",
    "to_sympy",
    "wheel_stress",
    "write_certificate",
    "write_fold",
]
