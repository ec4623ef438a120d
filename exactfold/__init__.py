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

from importlib import import_module

from exactfold.errors import ExactfoldError, InputError
from exactfold.verdict import PROVED, REFUTED, UNDECIDED, Verdict

__version__ = "0.1.0"

TYPE_CHECKING = False  # as in typing, which takes longer to load than all that is imported here
if TYPE_CHECKING:
    from exactfold.algebra.degree_four import split_form
    from exactfold.algebra.from_roots import parametrisation_from_roots
    from exactfold.algebra.groebner import groebner, quotient_algebra
    from exactfold.algebra.hermite import hermite_counts
    from exactfold.branches.angles import fold_angles
    from exactfold.branches.branch import Branch
    from exactfold.branches.export import export_branch
    from exactfold.branches.result import BranchCount
    from exactfold.bridges.export import (
        to_homotopy_continuation,
        to_macaulay2,
        to_msolve,
        to_singular,
        to_sympy,
    )
    from exactfold.certify.arb_krawczyk import arb_krawczyk
    from exactfold.certify.interval_newton import interval_newton
    from exactfold.certify.isolation import isolate
    from exactfold.certify.krawczyk import krawczyk
    from exactfold.count.batch import count_many
    from exactfold.count.collect import count_branches
    from exactfold.count.dask_engine import dask_engine
    from exactfold.count.find import BranchFinder, find_branch, find_branches, neighbours
    from exactfold.count.pools import dask_pool
    from exactfold.count.solvers import METHODS, find_candidates, register_solver, solvers
    from exactfold.count.stream import StreamedCount, stream_branches
    from exactfold.data import EXAMPLES, example_path, examples
    from exactfold.evidence.check import check_compact
    from exactfold.evidence.entries import write_certificate
    from exactfold.evidence.listing import certificate
    from exactfold.evidence.read import read_branches
    from exactfold.exact.factor_degrees import factor_degrees
    from exactfold.exact.forms import QuadraticForm
    from exactfold.exact.numbers import as_rational
    from exactfold.pattern import degenerate, families
    from exactfold.pattern.crease_pattern import CreasePattern
    from exactfold.pattern.delaunay import delaunay
    from exactfold.pattern.fold import FoldFile, load_fold, read_fold
    from exactfold.pattern.fold_writing import write_fold
    from exactfold.pattern.load import load
    from exactfold.pattern.near_degenerate import near_degenerate
    from exactfold.pattern.random_squares import random_square
    from exactfold.problem.branch_system import BranchSystem, Chart
    from exactfold.problem.perturbed import perturbed
    from exactfold.problem.quadratic import QuadraticSystem
    from exactfold.rigidity.all_real import decide_all_branches_real
    from exactfold.rigidity.curvature import curvature_form, stress_form, wheel_stress
    from exactfold.rigidity.definite_stress import definite_stress
    from exactfold.rigidity.facts import pattern_facts
    from exactfold.rigidity.self_stress import rigidity_matrix, self_stresses
    from exactfold.schemas import schema
    from exactfold.solve.candidates import Candidates
    from exactfold.solve.homotopy import homotopy
    from exactfold.solve.newton_ends import nappe_ends
    from exactfold.solve.popping import popping

_HOMES = {
    "exactfold.branches.angles": ("fold_angles",),
    "exactfold.branches.branch": ("Branch",),
    "exactfold.branches.export": ("export_branch",),
    "exactfold.evidence.listing": ("certificate",),
    "exactfold.branches.result": ("BranchCount",),
    "exactfold.certify.arb_krawczyk": ("arb_krawczyk",),
    "exactfold.evidence.entries": ("write_certificate",),
    "exactfold.certify.interval_newton": ("interval_newton",),
    "exactfold.certify.isolation": ("isolate",),
    "exactfold.certify.krawczyk": ("krawczyk",),
    "exactfold.count.collect": ("count_branches",),
    "exactfold.count.batch": ("count_many",),
    "exactfold.data": ("EXAMPLES", "example_path", "examples"),
    "exactfold.exact.factor_degrees": ("factor_degrees",),
    "exactfold.exact.forms": ("QuadraticForm",),
    "exactfold.exact.numbers": ("as_rational",),
    "exactfold.count.find": ("BranchFinder", "find_branch", "find_branches", "neighbours"),
    "exactfold.pattern": ("degenerate", "families"),
    "exactfold.pattern.crease_pattern": ("CreasePattern",),
    "exactfold.pattern.delaunay": ("delaunay",),
    "exactfold.pattern.fold": ("FoldFile", "load_fold", "read_fold"),
    "exactfold.pattern.fold_writing": ("write_fold",),
    "exactfold.pattern.load": ("load",),
    "exactfold.pattern.near_degenerate": ("near_degenerate",),
    "exactfold.pattern.random_squares": ("random_square",),
    "exactfold.rigidity.all_real": ("decide_all_branches_real",),
    "exactfold.rigidity.curvature": ("curvature_form", "stress_form", "wheel_stress"),
    "exactfold.rigidity.definite_stress": ("definite_stress",),
    "exactfold.rigidity.facts": ("pattern_facts",),
    "exactfold.rigidity.self_stress": ("rigidity_matrix", "self_stresses"),
    "exactfold.evidence.check": ("check_compact",),
    "exactfold.count.pools": ("dask_pool",),
    "exactfold.count.dask_engine": ("dask_engine",),
    "exactfold.evidence.read": ("read_branches",),
    "exactfold.count.stream": ("StreamedCount", "stream_branches"),
    "exactfold.algebra.from_roots": ("parametrisation_from_roots",),
    "exactfold.algebra.groebner": ("groebner", "quotient_algebra"),
    "exactfold.algebra.hermite": ("hermite_counts",),
    "exactfold.schemas": ("schema",),
    "exactfold.solve.homotopy": ("homotopy",),
    "exactfold.count.solvers": ("METHODS", "find_candidates", "register_solver", "solvers"),
    "exactfold.solve.candidates": ("Candidates",),
    "exactfold.solve.newton_ends": ("nappe_ends",),
    "exactfold.solve.popping": ("popping",),
    "exactfold.algebra.degree_four": ("split_form",),
    "exactfold.problem.branch_system": ("BranchSystem", "Chart"),
    "exactfold.bridges.export": (
        "to_homotopy_continuation",
        "to_macaulay2",
        "to_msolve",
        "to_singular",
        "to_sympy",
    ),
    "exactfold.problem.perturbed": ("perturbed",),
    "exactfold.problem.quadratic": ("QuadraticSystem",),
}
_HOME = {name: home for home, names in _HOMES.items() for name in names}

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
    "Candidates",
    "Chart",
    "CreasePattern",
    "ExactfoldError",
    "FoldFile",
    "InputError",
    "QuadraticForm",
    "QuadraticSystem",
    "StreamedCount",
    "Verdict",
    "arb_krawczyk",
    "as_rational",
    "certificate",
    "check_compact",
    "count_branches",
    "count_many",
    "curvature_form",
    "dask_engine",
    "dask_pool",
    "decide_all_branches_real",
    "definite_stress",
    "degenerate",
    "delaunay",
    "example_path",
    "examples",
    "export_branch",
    "factor_degrees",
    "families",
    "find_branch",
    "find_branches",
    "find_candidates",
    "fold_angles",
    "groebner",
    "hermite_counts",
    "homotopy",
    "interval_newton",
    "isolate",
    "krawczyk",
    "load",
    "load_fold",
    "nappe_ends",
    "near_degenerate",
    "neighbours",
    "parametrisation_from_roots",
    "pattern_facts",
    "perturbed",
    "popping",
    "quotient_algebra",
    "random_square",
    "read_branches",
    "read_fold",
    "register_solver",
    "rigidity_matrix",
    "schema",
    "self_stresses",
    "solvers",
    "split_form",
    "stream_branches",
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

if not TYPE_CHECKING:  # type checkers read the imports above, and know every name

    def __getattr__(name: str) -> object:
        """Import a public name where it is first used: few programs need all of them."""
        if name not in _HOME:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        home = import_module(_HOME[name])
        value = getattr(home, name, None) or import_module(f"{_HOME[name]}.{name}")
        globals()[name] = value
        return value

    def __dir__() -> list[str]:
        return sorted({*globals(), *__all__})
