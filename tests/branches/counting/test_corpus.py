"""Independent solvers agree on every kind of pattern: counts, multiplicities, isolating boxes.

Popping paths, complex homotopy paths, the exact engine and Hermite's trace form, three certifiers,
and the proved count with its certificate, over a corpus with every kind of degeneracy.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache

import numpy as np
import pytest
from certifiers import CERTIFIERS, Certifier
from flint import fmpq, fmpq_mat
from rivals.hermite import hermite_counts
from sampling import slow_after
from sheets import SQUARE, reflex_corners, scrambled, straight_side

from exactfold import PROVED, UNDECIDED, CreasePattern, checker, random_square
from exactfold.branches import certificate, count_branches, find_candidates
from exactfold.exact.linalg import from_fmpq, inertia
from exactfold.pattern.degenerate import (
    DEGENERATE,
    bent_off_path,
    chorded_square,
    gridded_square,
    nested_triangles,
    notched,
    ringed_square,
    straight_path,
    with_vertex,
)
from exactfold.pattern.families import (
    collinear_folds,
    flat_octahedron_in_square,
    h1_sequence,
)
from exactfold.rigidity import Chart
from exactfold.rigidity.equations.branch_system import BranchSystem, notch_chart
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve import isolate
from exactfold.solve.algebraic import groebner_bases as engine
from exactfold.solve.algebraic.exact_solution import ExactSolution
from exactfold.solve.algebraic.msolve import find_msolve, msolve_classes
from exactfold.solve.algebraic.quotient import QuotientAlgebra, from_groebner_basis
from exactfold.solve.certify.box import IsolatingBox
from exactfold.solve.numeric.candidates import Candidates

BITS = 160


def notched_path() -> CreasePattern:
    """A non-convex sheet with a straight crease path 3-4-6 and flat vertices on some branches."""
    points = [(7, -1), (5, -6), (9, 2), (0, -8), ("23/5", "-16/5"), ("23/3", "-1/3")]
    points += [("92/15", "-8/5"), ("923/165", "-122/55")]
    faces = [(2, 3, 4), (0, 1, 5), (1, 2, 5), (2, 4, 6), (0, 6, 7), (4, 7, 6), (0, 5, 6)]
    return CreasePattern(points, [*faces, (2, 6, 5), (0, 7, 3), (3, 7, 4)])


def notched_chord() -> CreasePattern:
    """A non-convex quadrilateral cut by the chord at its reflex corner, a vertex in each half."""
    cut = CreasePattern([(4, -4), (1, 0), (4, 4), (-4, 0)], [(0, 1, 3), (1, 2, 3)])
    return with_vertex(with_vertex(cut, 1), 0, (1, 2, 3))


CORPUS: dict[str, CreasePattern] = {
    # triangulated triangles: nested, several, and together with flat vertices
    **{f"nested triangles {k}": nested_triangles(k) for k in (1, 3)},
    "flat octahedron": flat_octahedron_in_square(),
    "triangle in a random square": with_vertex(random_square(3, seed=8), 2, (1, 2, 2)),
    "triangle beside a straight path": with_vertex(bent_off_path(), 0, (2, 1, 1)),
    # collinear folds and crosses, straight paths from boundary to boundary, flat vertices
    **{f"straight path {k}": straight_path(k) for k in (1, 3)},
    # symmetric patterns
    "ring of four": ringed_square(4, hub=False),
    "ring of five": ringed_square(5, hub=False),
    "row of three": gridded_square(1, 3),
    # chords
    "chord, three vertices": chorded_square((2, 1)),
    "chord, no vertex on one side": chorded_square((1, 0)),
    "chord at a reflex corner": notched_chord(),
    # non-convex boundary quadrilaterals, and a boundary angle of pi
    **{f"notched {k}": notched(k) for k in (2, 3)},
    "notched with a straight path": notched_path(),
    "reflex": scrambled(1, reflex_corners(1), 3),
    "straight side": straight_side(smallest=False),
    # far from Delaunay, H1, and the ensemble of the literature
    "scrambled": scrambled(2, SQUARE, 4),
    "h1": h1_sequence(4, seed=2),
    **{f"random square {n}-{s}": random_square(n, s) for n in (1, 2, 3, 4) for s in (10, 11)},
    **{name: build() for name, build in DEGENERATE.items() if name != "ring"},  # "grid" is quicker
}
SOLVABLE = [name for name, pattern in CORPUS.items() if pattern.Vi > pattern.Vt]
FEW = [  # for tests that take long where coefficients are
    name
    for name in SOLVABLE
    if CORPUS[name].Vi - CORPUS[name].Vt <= (3 if collinear_folds(CORPUS[name]) else 2)
]

every = pytest.mark.parametrize("name", CORPUS)
solvable = pytest.mark.parametrize("name", SOLVABLE)


@cache
def chart_of(name: str) -> Chart:
    reduced, _ = CORPUS[name].without_rigid_parts()
    return BranchSystem(reduced).chart if reduced.is_convex else notch_chart(reduced)


@cache
def candidates_of(name: str, method: str) -> Candidates:
    return find_candidates(chart_of(name), method)


@cache
def exact_of(name: str) -> ExactSolution:
    return engine.groebner(chart_of(name).system)


@dataclass(frozen=True)
class ExactRoot:
    """A real zero between exact bounds less than 2^-BITS apart."""

    bounds: tuple[tuple[Fraction, Fraction], ...]
    multiplicity: int

    def is_in(self, box: IsolatingBox) -> bool:
        """Whether the zero is in the box; decided by the bounds, or the test fails."""
        sides = [box.interval(k) for k in range(len(box.real))]
        pairs = list(zip(self.bounds, sides, strict=True))
        inside = all(a <= low and high <= b for (low, high), (a, b) in pairs)
        assert inside or any(high < a or b < low for (low, high), (a, b) in pairs)
        return inside

    @property
    def point(self) -> list[float]:
        return [float((low + high) / 2) for low, high in self.bounds]


@cache
def roots_of(name: str) -> tuple[ExactRoot, ...]:
    return tuple(ExactRoot(bounds, m) for bounds, m in exact_of(name).real_points(BITS))


def check_boxes(name: str, boxes: Sequence[IsolatingBox]) -> None:
    """One box for each simple zero, around it and no other; none around a multiple one."""
    assert all(box.is_real for box in boxes)
    for box in boxes:
        (root,) = (root for root in roots_of(name) if root.is_in(box))
        assert root.multiplicity == 1
    for root in roots_of(name):
        assert sum(root.is_in(box) for box in boxes) == (root.multiplicity == 1)


@solvable
def test_exact_engine_finds_all_zeros_real(name: str) -> None:
    """2^n with multiplicity, none at infinity, none complex: Theorem 2 of docs/theorem.md."""
    exact, n = exact_of(name), chart_of(name).system.size
    assert exact.dimension == 1 << n
    assert exact.at_infinity == 0
    assert exact.distinct == len(roots_of(name))
    assert sum(root.multiplicity for root in roots_of(name)) == 1 << n


@pytest.mark.parametrize(
    ("name", "method"),
    slow_after(
        12,
        (
            (name, method)
            for name in SOLVABLE
            for method in ("newton", "popping", "homotopy")
            if method != "homotopy" or CORPUS[name].Vi < 5
        ),
    ),
)
def test_boxes_around_path_ends_hold_the_exact_simple_zeros(name: str, method: str) -> None:
    found = isolate(chart_of(name).system, candidates_of(name, method))
    check_boxes(name, found.boxes)
    simple = all(root.multiplicity == 1 for root in roots_of(name))
    assert found.complete is (PROVED if simple else UNDECIDED)
    assert bool(found.failures) == (not simple)


@solvable
@pytest.mark.parametrize("method", ["newton", "popping", "homotopy"])
def test_as_many_paths_end_at_a_zero_as_its_multiplicity(name: str, method: str) -> None:
    """Exactly so for newton and popping; homotopy keeps one or more of the paths that meet."""
    ends = candidates_of(name, method).points
    points = np.array([root.point for root in roots_of(name)])
    distance = np.abs(ends[:, None, :] - points[None, :, :]).max(axis=2)
    scale = 1 + np.abs(points).max(axis=1)
    assert (distance.min(axis=1) <= 1e-3 * scale[distance.argmin(axis=1)]).all()
    arrived = Counter(distance.argmin(axis=1).tolist())
    for k, root in enumerate(roots_of(name)):
        assert arrived[k] == root.multiplicity or (
            method == "homotopy" and 1 <= arrived[k] < root.multiplicity
        )


@pytest.mark.parametrize("name", FEW)
@pytest.mark.parametrize("certifier", CERTIFIERS, ids=str)
def test_certifiers_accept_simple_zeros_and_refuse_multiple_ones(
    name: str, certifier: Certifier
) -> None:
    points = [root.point for root in roots_of(name)]
    results = certifier.certify(chart_of(name).system, points, precisions=(106, 212))
    for root, result in zip(roots_of(name), results, strict=True):
        assert isinstance(result, IsolatingBox) == (root.multiplicity == 1)
    check_boxes(name, [result for result in results if isinstance(result, IsolatingBox)])


def algebra_of(system: QuadraticSystem) -> QuotientAlgebra:
    algebra = from_groebner_basis(engine._flint_basis(system), system.size)
    assert isinstance(algebra, QuotientAlgebra)
    return algebra


def trace_form(algebra: QuotientAlgebra) -> list[list[Fraction]]:
    """Hermite's form (a, b) -> Tr(ab) from the definition: full matrices of all products."""
    matrices = []
    for exponent in algebra.basis:
        matrix = fmpq_mat(
            [
                [fmpq(int(i == j)) for j in range(algebra.dimension)]
                for i in range(algebra.dimension)
            ]
        )
        for k, power in enumerate(exponent):
            for _ in range(power):
                matrix = algebra.matrices[k] * matrix
        matrices.append(matrix)
    return [
        [from_fmpq(fmpq(sum((a * b)[i, i] for i in range(algebra.dimension)))) for b in matrices]
        for a in matrices
    ]


@pytest.mark.parametrize("name", FEW)
def test_hermite_form_counts_the_real_zeros(name: str) -> None:
    """Rank: different zeros; signature: real ones (Basu, Pollack, Roy, theorem 4.102)."""
    algebra = algebra_of(chart_of(name).system)
    positive, negative, zero = inertia(trace_form(algebra))
    exact = exact_of(name)
    assert hermite_counts(algebra) == (positive + negative, positive - negative)
    assert positive + negative == exact.distinct
    assert positive - negative == len(roots_of(name))
    assert zero == (exact.dimension or 0) - exact.distinct


@pytest.mark.skipif(find_msolve() is None, reason="msolve is not installed")
@solvable
def test_msolve_finds_the_same_zeros(name: str) -> None:
    """Its parametrisation is verified by substitution; the zeros are compared one by one."""
    classes = msolve_classes(chart_of(name).system)
    assert sum(c.degree for c in classes) == exact_of(name).distinct
    points = [point for c in classes for point in c.real_points(BITS)]
    assert len(points) == len(roots_of(name))
    for root in roots_of(name):
        meets = [
            all(
                a <= high and low <= b
                for (low, high), (a, b) in zip(root.bounds, point, strict=True)
            )
            for point in points
        ]
        assert sum(meets) == 1


@every
def test_proved_count_has_the_exact_multiplicities(name: str) -> None:
    """And each is 2 to the number of flat vertices (docs/theorem.md, Theorem 3)."""
    pattern = CORPUS[name]
    result = count_branches(pattern)
    assert result.status is PROVED, result.reason
    assert result.with_multiplicity == 1 << pattern.Vi
    assert result.nonreal == 0
    expected = Counter(root.multiplicity for root in roots_of(name)) if name in SOLVABLE else {1: 1}
    assert Counter(branch.multiplicity >> pattern.Vt for branch in result.branches) == expected
    assert result.distinct == len(result.branches) == sum(expected.values())
    for branch in result.branches:
        flat = sum(sign == 0 for sign in branch.vertex_signs.values())
        assert branch.multiplicity == 1 << flat
    claims = checker.check(certificate(result))
    assert claims["distinct"] == result.distinct


# --- the corpus is what it says ------------------------------------------------------------------


def test_every_kind_is_in_the_corpus() -> None:
    patterns = CORPUS.values()
    several = [p for p in patterns if len(p.triangulated_triangles) > 1]
    nested = [p for p in patterns if any(len(v) > 1 for _, v in p.triangulated_triangles)]
    straight = [p for p in patterns if collinear_folds(p)]
    crosses = [
        p
        for p in straight
        if any(
            n == 2 and p.degree(v) == 4
            for v, n in Counter(v for _, v, _ in collinear_folds(p)).items()
        )
    ]
    multiple = [name for name in SOLVABLE if any(root.multiplicity > 1 for root in roots_of(name))]
    assert min(map(len, (several, nested, crosses))) >= 2
    assert len(straight) >= 10
    assert sum(bool(p.chords) for p in patterns) >= 4
    assert sum(not p.is_convex for p in patterns) >= 6
    assert len(multiple) >= 7
    assert any(not CORPUS[name].is_convex for name in multiple)
    assert any(CORPUS[name].Vt for name in multiple)
    assert {root.multiplicity for name in multiple for root in roots_of(name)} == {1, 2, 4}
