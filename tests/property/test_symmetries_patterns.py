"""A count belongs to the sheet: labels, position, size, side and gauge do not change it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from fractions import Fraction
from itertools import combinations

import pytest
from hypothesis import given, reject, settings
from hypothesis import strategies as st
from sampling import slow_after
from sheets import (
    SQUARE,
    mapped,
    mirrored,
    reflex_corners,
    relabelled,
    rotated,
    scrambled,
    straight_side,
    turn,
)

from exactfold import BranchCount, random_square
from exactfold._support.verdict import PROVED
from exactfold.branches import count_branches
from exactfold.branches.values.roots import BoxRoot
from exactfold.errors import UsageError
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.families import flat_vertex_square
from exactfold.rigidity import curvature_form, project
from exactfold.rigidity.equations.branch_system import BranchSystem, Chart
from exactfold.rigidity.equations.sign_rows import Functionals
from exactfold.solve.certify.isolation import isolate
from exactfold.solve.numeric.homotopy import homotopy

few = settings(max_examples=12, deadline=None)
seeds = st.integers(0, 10**6)


@st.composite
def patterns(draw: st.DrawFn) -> CreasePattern:
    """Convex and not, far from Delaunay, with flat vertices or rigid triangles now and then."""
    seed, inside = draw(seeds), draw(st.integers(2, 4))
    kind = draw(st.sampled_from(["random", "scrambled", "reflex", "straight", "flat"]))
    if kind == "random":
        return random_square(inside, seed=seed)
    if kind == "scrambled":
        return scrambled(seed, SQUARE, inside)
    if kind == "reflex":
        return scrambled(seed, reflex_corners(seed), inside)
    return flat_vertex_square() if kind == "flat" else straight_side(smallest=seed % 2 == 0)


Description = tuple[frozenset[tuple[int, int]], frozenset[tuple[frozenset[int], str]], int]


def described(result: BranchCount, names: Sequence[int]) -> Counter[Description]:
    """Branches up to the sign of the ray, vertex v called names[v]."""
    found: Counter[Description] = Counter()
    for branch in result.branches:
        sides = []
        for side in (1, -1):
            letters = {"M": "V", "V": "M", "F": "F"} if side < 0 else {x: x for x in "MVF"}
            signs = frozenset((names[v], side * s) for v, s in branch.vertex_signs.items())
            folds = frozenset(
                (frozenset(names[v] for v in fold), letters[x])
                for fold, x in branch.assignment.items()
            )
            sides.append((signs, folds, branch.multiplicity))
        found[min(sides, key=lambda part: (sorted(part[0]), sorted(map(str, part[1]))))] += 1
    return found


def check_same(
    first: CreasePattern, second: CreasePattern, names: Sequence[int] | None = None
) -> None:
    """`names[v]` is the vertex of `first` that is vertex v of `second`."""
    same = list(range(len(first.vertices)))
    one, other = count_branches(first), count_branches(second)
    assert one.status is other.status is PROVED
    for key in ("distinct", "with_multiplicity", "real", "nonreal", "true_branches"):
        assert getattr(one, key) == getattr(other, key)
    assert described(one, same) == described(other, names or same)


@few
@given(pattern=patterns(), data=st.data())
def test_relabelling(pattern: CreasePattern, data: st.DataObject) -> None:
    order = data.draw(st.permutations(range(len(pattern.vertices))))
    check_same(pattern, relabelled(pattern, order), order)


@few
@given(pattern=patterns(), shift=st.tuples(st.fractions(-9, 9), st.fractions(-9, 9)))
def test_rigid_motion(pattern: CreasePattern, shift: tuple[Fraction, Fraction]) -> None:
    def move(point: tuple[Fraction, Fraction]) -> tuple[Fraction, Fraction]:
        x, y = rotated(point)
        return x + shift[0], y + shift[1]

    check_same(pattern, mapped(pattern, move))


@few
@given(
    pattern=patterns(),
    scale=st.sampled_from([Fraction(3, 7), Fraction(10**20), Fraction(-1, 10**15)]),
)
def test_scaling(pattern: CreasePattern, scale: Fraction) -> None:
    check_same(pattern, mapped(pattern, lambda p: (scale * p[0], scale * p[1])))


@few
@given(pattern=patterns())
def test_reflection_keeps_signs_and_folds(pattern: CreasePattern) -> None:
    """Turning the drawing over left to right, not the sheet: what was up stays up."""
    check_same(pattern, mapped(pattern, mirrored))


@few
@given(pattern=patterns(), entries=st.lists(st.integers(-9, 9), min_size=9, max_size=9))
def test_projective_map(pattern: CreasePattern, entries: list[int]) -> None:
    """Theorem 10 of docs/generic.md; the first column is the denominator of the map."""
    furthest = max(abs(x) + abs(y) for x, y in pattern.vertices)
    rows = [entries[:3], entries[3:6], entries[6:]]
    slope = max(abs(rows[1][0]), abs(rows[2][0]))
    rows[0][0] = int(slope * furthest) + 1
    rows[1][1] += 20 if rows[1][1] >= 0 else -20
    try:
        image = project(pattern, rows)
    except UsageError:
        reject()
    heights = {v: Fraction(v**2 % 7) for v in range(len(pattern.vertices))}
    for v in pattern.interior:
        before = curvature_form(pattern, v)(heights)
        after = curvature_form(image.pattern, v)(image.heights(heights))
        assert after * image.determinant == image.factors[v] * before
    check_same(pattern, image.pattern)


def test_a_reflection_reverses_the_boundary_but_not_the_saddle_ray() -> None:
    pattern = random_square(3, seed=6)
    image = mapped(pattern, mirrored)
    assert image.boundary == (0, *pattern.boundary[:0:-1])
    for one, other in zip(
        count_branches(pattern).branches, count_branches(image).branches, strict=True
    ):
        assert (one.sign_text, one.assignment_text) == (other.sign_text, other.assignment_text)


@few
@given(pattern=patterns())
def test_all_solutions_are_real_and_add_up(pattern: CreasePattern) -> None:
    result = count_branches(pattern)
    assert result.with_multiplicity == 2**pattern.Vi
    assert sum(b.multiplicity for b in result.branches) == result.with_multiplicity
    assert result.nonreal == 0


# --- gauges --------------------------------------------------------------------------------------


def census(chart: Chart) -> Counter[tuple[tuple[int | None, ...], tuple[int | None, ...]]]:
    """Signs of all vertices and folds of every certified root, up to the sign of the ray."""
    isolation = isolate(chart.system, homotopy(chart.system))
    assert isolation.complete is PROVED
    rows = Functionals(chart)
    found: Counter[tuple[tuple[int | None, ...], tuple[int | None, ...]]] = Counter()
    for box in isolation.boxes:
        root = BoxRoot(box)
        up = tuple(root.sign(row) for row in rows.vertices.values())
        folds = tuple(root.sign(row) for row in rows.folds.values())
        assert None not in up + folds
        down = tuple(-s for s in up if s is not None), tuple(-s for s in folds if s is not None)
        found[max((up, folds), down)] += 1
    return found


@pytest.mark.parametrize(
    "pattern",
    slow_after(
        1,
        [
            random_square(2, seed=3),
            random_square(3, seed=7),
            scrambled(3, reflex_corners(3), 2, loose=True),
            straight_side(smallest=False),
        ],
    ),
)
def test_choice_of_pinned_triangle(pattern: CreasePattern) -> None:
    expected = census(BranchSystem(pattern).chart)
    assert sum(expected.values()) == 2**pattern.Vi
    points = pattern.vertices
    for pinned in combinations(range(len(points)), 3):
        if turn(*(points[v] for v in pinned)) != 0:
            chart = BranchSystem(pattern, pinned).chart
            assert chart.branch_system.pinned == pinned
            assert census(chart) == expected


@pytest.mark.parametrize("vertex", [0, 4, 5, 6])
def test_choice_of_chart(vertex: int) -> None:
    """Another height is set to 1 in place of the saddle; no branch lies at its infinity here."""
    pattern = random_square(3, seed=7)
    system = BranchSystem(pattern)
    assert vertex in system.variables
    other = Chart(system, {vertex: Fraction(1)}, vertex)
    assert census(other) == census(system.chart)
