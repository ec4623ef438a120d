"""Proved radii against exact counts of sheets within them, and of the sheet that shows `upper`."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from panel_sheets import mesh, ring
from sampling import slow_after

import exactfold
from exactfold import CreasePattern, PanelPattern
from exactfold.branches import count_branches, find_branch
from exactfold.branches.values.letters import UPSIDE_DOWN
from exactfold.design import Tolerance, tolerance_of_branches, tolerance_of_panels
from exactfold.errors import NotApplicableError, NotCountedError, UndecidedBranchError, UsageError
from exactfold.motion import panel_ways
from exactfold.panels import decompose
from exactfold.pattern.opening import panels

SHEETS = {
    "two-vertex": exactfold.pattern.load("two-vertex"),
    "one vertex": exactfold.pattern.load("single-vertex-4"),
    "flat-octahedron": exactfold.pattern.load("flat-octahedron"),
    "square 3": exactfold.random_square(3, seed=2),
    "square 4": exactfold.random_square(4, seed=1),
    "dart": CreasePattern(
        [(0, 0), (4, -4), (1, 0), (4, 4), ("1/2", "1/7")],
        [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)],
    ),
    "square 6": exactfold.random_square(6, seed=1),
}


def letters(texts):
    return sorted(min(text, text.translate(UPSIDE_DOWN)) for text in texts)


def of_branches(pattern):
    count = count_branches(pattern)
    assert count.status is exactfold.PROVED
    return letters(branch.assignment_text for branch in count.branches)


def of_panels(pattern):
    result = decompose(pattern)
    folds = pattern.folds
    return letters(
        "".join(way.letters.get(fold, "F") for fold in folds) for way in panel_ways(result)
    )


def moved(pattern, radius, seed, only=None):
    """The sheet with every vertex, or only one, moved by nearly the radius at random."""
    angles = np.random.default_rng(seed).uniform(0, 2 * np.pi, len(pattern.vertices))
    points = []
    for v, (x, y) in enumerate(pattern.vertices):
        r = radius * 0.999 if only in (None, v) else 0.0
        dx, dy = r * np.cos(angles[v]), r * np.sin(angles[v])
        points.append((x + Fraction(dx), y + Fraction(dy)))
    if isinstance(pattern, CreasePattern):
        return CreasePattern(points, pattern.triangles)
    return PanelPattern(points, pattern.edges)


def shifted(tolerance: Tolerance, factor=1):
    """The sheet that shows `upper`, or one on the way to it."""
    pattern = tolerance.pattern
    pairs = zip(pattern.vertices, tolerance.changed.moves, strict=True)
    points = [(x + factor * dx, y + factor * dy) for (x, y), (dx, dy) in pairs]
    if isinstance(pattern, CreasePattern):
        return CreasePattern(points, pattern.triangles)
    return PanelPattern(points, pattern.edges)


@pytest.mark.parametrize("name", slow_after(4, SHEETS))
def test_sheets_within_the_radius_have_the_same_letters_and_one_beyond_has_not(name):
    pattern = SHEETS[name]
    found = tolerance_of_branches(count_branches(pattern))
    assert found.status is exactfold.PROVED
    assert 0 < found.radius < found.upper
    known = of_branches(pattern)
    for seed in range(3):
        assert of_branches(moved(pattern, found.radius, seed)) == known
    worst = found.radius / found.upper * 0.999
    assert of_branches(shifted(found, Fraction(worst))) == known
    assert of_branches(shifted(found)) != known
    for v, radius in found.vertices.items():
        assert radius >= found.radius
        assert of_branches(moved(pattern, radius, v, only=v)) == known


@pytest.mark.parametrize("way", slow_after(2, range(1, 5)))
def test_one_branch_keeps_its_letters_within_its_radius(way):
    pattern = SHEETS["two-vertex"]
    found = exactfold.tolerance(pattern, way=way)
    branch = count_branches(pattern)[way - 1]
    assert found.way == f"branch {branch.sign_text}"
    for seed in range(4):
        other = find_branch(moved(pattern, found.radius, seed), branch.sign_text)
        assert other.assignment_text == branch.assignment_text
    other = find_branch(shifted(found), branch.sign_text)
    assert other.assignment_text != branch.assignment_text
    assert branch.sign_text in found.limit


def test_a_way_moves_at_least_as_far_as_all_ways():
    whole = exactfold.tolerance("two-vertex")
    each = [exactfold.tolerance("two-vertex", way=k).radius for k in range(1, 5)]
    assert min(each) == pytest.approx(whole.radius, rel=1e-6)


def test_coordinates_that_are_no_doubles_and_the_same_sheet_of_another_size():
    pattern = SHEETS["two-vertex"]
    third = [(x / 3, y / 3) for x, y in pattern.vertices]
    found = tolerance_of_branches(count_branches(CreasePattern(third, pattern.triangles)))
    whole = tolerance_of_branches(count_branches(pattern))
    assert found.radius == pytest.approx(whole.radius / 3, rel=1e-2)
    assert found.radius < whole.upper / 3


def test_panels_with_irrational_coordinates_agree_with_exact_counts():
    opened = exactfold.read("fish-base")
    found = exactfold.tolerance(opened)
    assert found.status is exactfold.PROVED
    assert 0.1 < found.radius / found.upper < 1
    known = of_panels(opened.sheet)
    rounded = [[Fraction(float(c)) for c in point] for point in opened.sheet.vertices]
    near = PanelPattern(rounded, opened.sheet.edges)
    assert of_panels(moved(near, found.radius * 0.999, 5)) == known
    assert of_panels(shifted(found)) != known


@pytest.mark.parametrize("pattern", slow_after(1, [mesh(2, 1, 1), ring(2), mesh(3, 1, 4), ring(5)]))
def test_panels_with_isolated_ways_agree_with_exact_counts(pattern):
    found = exactfold.tolerance(pattern)
    assert found.status is exactfold.PROVED
    assert 0 < found.radius < found.upper
    known = of_panels(pattern)
    assert found.ways == len(known)
    for seed in range(2):
        assert of_panels(moved(pattern, found.radius, seed)) == known
    assert of_panels(shifted(found)) != known


def test_thin_panels_lose_their_shape_first():
    pattern = exactfold.random_square(1, seed=1)
    found = exactfold.tolerance(pattern)
    assert found.changed is None
    assert found.limit == "vertex 4 comes to lie on the line of edge 0-3, and a panel has no shape"
    assert found.upper == pytest.approx(float(pattern.vertices[4][0]) / 2)


def test_a_triangulated_sheet_is_the_same_as_its_panels():
    pattern = SHEETS["two-vertex"]
    one = tolerance_of_panels(decompose(panels(pattern)))
    other = tolerance_of_branches(count_branches(pattern))
    assert one.radius == pytest.approx(other.radius, rel=1e-9)
    assert one.upper == pytest.approx(other.upper, rel=1e-9)
    assert one.changed.moves == other.changed.moves


def test_a_flat_star_is_lost_at_once():
    found = exactfold.tolerance("flat-vertex")
    assert (found.status, found.radius, found.upper) == (exactfold.PROVED, 0.0, 0.0)
    assert found.limit == "on branch +0 the star of vertex 5 is flat"
    assert exactfold.tolerance("flat-vertex", way=1).radius > 0.01
    assert of_branches(moved(found.pattern, 1e-6, 1)) != of_branches(found.pattern)


def test_a_loop_is_lost_at_once():
    found = exactfold.tolerance("square-twist", way=2)
    assert (found.status, found.radius, found.upper) == (exactfold.PROVED, 0.0, 0.0)
    assert found.closings[0][1].vertices == (4, 5, 6, 7)
    assert not panel_ways(decompose(moved(found.pattern, 1e-3, 1)))


def test_a_nearly_singular_sheet_is_undecided():
    base = exactfold.pattern.load("flat-vertex")
    found = exactfold.tolerance(moved(base, 1e-13, 3))
    assert (found.status, found.radius) == (exactfold.UNDECIDED, 0.0)
    assert "nearly" in found.reason


def test_the_estimate_depends_on_the_seed_only():
    one, same, other = (exactfold.tolerance("two-vertex", seed=s).estimate for s in (0, 0, 1))
    assert one == same
    assert one.radius != other.radius
    assert one.samples == 100


@pytest.mark.parametrize(
    ("sheet", "options", "error", "words"),
    [
        ("waterbomb", {}, NotCountedError, "form families"),
        ("bird-base", {}, NotCountedError, "families of at least 5 dimensions"),
        ("two-vertex", {"way": 9}, UsageError, "there is no way 9"),
        ("miura", {"way": 99}, UsageError, "there is no way 99"),
        ("two-vertex", {"way": 1, "up": [4]}, UsageError, "by one of"),
        (exactfold.random_square(13, seed=0), {}, NotCountedError, "2^13 branches"),
        ([(0, 0), (3, 0), (0, 3)], {}, NotCountedError, "three vertices"),
    ],
)
def test_what_is_refused(sheet, options, error, words):
    if isinstance(sheet, list):
        sheet = CreasePattern(sheet, [(0, 1, 2)])
    with pytest.raises(error) as caught:
        exactfold.tolerance(sheet, **options)
    assert words in str(caught.value)


def test_undecided_counts_are_refused():
    count = replace(count_branches("two-vertex"), status=exactfold.UNDECIDED)
    with pytest.raises(UndecidedBranchError, match="not all branches are proved"):
        tolerance_of_branches(count)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_eight_vertices_against_exact_counts(seed):
    pattern = exactfold.random_square(8, seed=seed)
    found = exactfold.tolerance(pattern)
    known = of_branches(pattern)
    assert found.status is exactfold.PROVED
    assert of_branches(moved(pattern, found.radius, seed)) == known
    assert of_branches(shifted(found, Fraction(found.radius / found.upper * 0.999))) == known
    assert of_branches(shifted(found)) != known


@pytest.mark.parametrize("digits", [12, 13])
def test_a_letter_that_is_nearly_flat_is_not_taken_for_flat(digits):
    centre = (Fraction(1, 2), Fraction(1, 2) + Fraction(1, 10**digits))
    fans = [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]
    pattern = CreasePattern([(0, 0), (1, 0), (1, 1), (0, 1), centre], fans)
    for found in (exactfold.tolerance(pattern), exactfold.tolerance(panels(pattern))):
        assert found.upper > 0
        assert found.limit != "on branch - fold 0-4 is flat"


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("exponent", [20, 90, -90])
def test_a_huge_or_tiny_sheet_has_the_radius_of_one_of_ordinary_size(exponent):
    pattern = exactfold.random_square(2, seed=3)
    scale = Fraction(10) ** exponent
    points = [(x * scale, y * scale) for x, y in pattern.vertices]
    found = exactfold.tolerance(CreasePattern(points, pattern.triangles))
    ordinary = exactfold.tolerance(pattern)
    assert found.radius / float(scale) == pytest.approx(ordinary.radius)
    assert found.upper / float(scale) == pytest.approx(ordinary.upper)


@pytest.mark.parametrize(("scale", "shift"), [(10**200, 0), (10**400, 0), (1, 10**16)])
def test_sheets_that_doubles_do_not_hold_are_refused(scale, shift):
    pattern = exactfold.random_square(2, seed=3)
    points = [(x * scale + shift, y * scale) for x, y in pattern.vertices]
    with pytest.raises(NotApplicableError, match="scale or move this one"):
        exactfold.tolerance(CreasePattern(points, pattern.triangles))
