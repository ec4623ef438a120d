"""Rings of panels whose ways are all isolated: their number, their letters, and what is refused."""

from __future__ import annotations

from fractions import Fraction
from functools import cache
from itertools import product

import numpy as np
import pytest
from panel_sheets import ring

from exactfold._support.clock import Clock
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED
from exactfold.app.viewer.families import representative
from exactfold.exact.surds import float_bounds
from exactfold.motion.panels.listing import panel_ways
from exactfold.panels import isolated
from exactfold.panels.decomposition import decompose
from exactfold.panels.isolated import isolated_ways
from exactfold.panels.result import Decomposition
from exactfold.panels.spaces.kernel import first_order
from exactfold.panels.spaces.subspaces import Leaf
from exactfold.panels.vertex.stars import Star, stars
from exactfold.pattern.families import single_vertex
from exactfold.pattern.opened import panels
from exactfold.pattern.panel_pattern import PanelPattern

FOUR, SIX = (4, 4, 4, 5), (4, 4, 4, 4, 4, 5)


@cache
def counted(seed: int, degrees: tuple[int, ...] = FOUR) -> Decomposition:
    return decompose(ring(seed, degrees))


def test_splitting_finds_the_same_ways(monkeypatch: pytest.MonkeyPatch) -> None:
    result = counted(2)
    monkeypatch.setattr(isolated, "_FEWEST_ROOTS", 99)
    exact = decompose(ring(2))
    assert (result.second_order, result.true) == (exact.second_order, exact.true)
    lines, ways = exact.parts[0].spaces, result.parts[0].spaces
    assert len(lines) == len(ways) == len({_place(way, lines) for way in ways})


def _place(way: Leaf, lines: tuple[Leaf, ...]) -> int:
    """The only line whose quotients of densities the bounds of a way allow."""
    fold, *others = way.folds
    low, high = way.densities[fold]
    found = []
    for k, line in enumerate(lines):
        assert line.folds == way.folds
        quotients = [float_bounds(line.rows[e][0] / line.rows[fold][0]) for e in others]
        scaled = [sorted((low * Fraction(x), high * Fraction(x))) for x, _ in quotients]
        bounds = [way.densities[e] for e in others]
        if all(abs(a - c) < 1e-9 * abs(a) for (a, _), (c, _) in zip(bounds, scaled, strict=True)):
            found.append(k)
    [only] = found
    return only


def test_more_roots_than_splitting_can_hold() -> None:
    result = counted(1, SIX)
    assert result.status is PROVED
    assert result.rigid is REFUTED
    assert result.second_order == result.true == {1: _by_signs(ring(1, SIX))}
    document = result.to_dict()
    assert (document["real"], document["nonreal"]) == (result.ways, 64 - (result.ways or 0))


def _by_signs(pattern: PanelPattern) -> int:
    """The number of real ways, from the two local modes of each vertex of degree 4, in floats."""
    moving = stars(pattern)
    rows, _ = first_order(moving)
    edges = list(rows)
    space = np.array([[float(x) for x in rows[edge]] for edge in edges])
    forms = []
    for star in moving.values():
        form = np.zeros((len(edges), len(edges)))
        for k, (e, d) in enumerate(zip(star.folds, star.directions, strict=True)):
            for f, c in zip(star.folds[:k], star.directions[:k], strict=True):
                form[edges.index(e), edges.index(f)] = float(c[0] * d[1] - c[1] * d[0])
        forms.append(space.T @ (form + form.T) @ space)
    *flat, last = forms
    factors = []
    for form in flat:
        values, vectors = np.linalg.eigh(form)
        below, above = vectors[:, 0] * np.sqrt(-values[0]), vectors[:, -1] * np.sqrt(values[-1])
        factors.append((above - below, above + below))
    count = 0
    for chosen in product(*factors):
        plane = np.linalg.svd(np.array(chosen))[2][-2:]
        count += 2 * bool(np.linalg.det(plane @ last @ plane.T) < 0)
    return count


def test_a_ring_without_real_ways_is_rigid() -> None:
    result = counted(8)
    assert result.rigid is PROVED
    assert result.second_order == result.true == {0: 1}
    assert result.still == result.pattern.folds
    assert (result.to_dict()["real"], result.to_dict()["nonreal"]) == (0, 16)


def test_ways_are_listed_with_their_letters() -> None:
    result = counted(1)
    ways = panel_ways(result)
    assert len(ways) == result.ways
    for way in ways:
        [leaf] = way.spaces
        assert repr(leaf) == "<Leaf: 13 folds, one line>"
        wanted = {fold: "VM"[letter == "V"] for fold, letter in way.letters.items()}
        shown = representative(way, result, wanted)
        assert shown is not None
        assert {fold: "VM"[x < 0] for fold, x in shown.densities.items()} == wanted


def test_the_numbers_of_zeros_are_those_of_the_whole_sheet() -> None:
    """A panel more, at a fold from boundary to boundary, adds a dimension to each way."""
    sheet = ring(1)
    first, second = len(sheet.interior), len(sheet.interior) + 1
    (a, b), (c, d) = sheet.vertices[first], sheet.vertices[second]
    number = len(sheet.vertices)
    points = [*sheet.vertices, ((a + c) * Fraction(3, 5), (b + d) * Fraction(3, 5))]
    free = decompose(PanelPattern(points, [*sheet.edges, (first, number), (second, number)]))
    assert free.second_order == {2: counted(1).ways}
    assert free.to_dict()["real"] is None


def star(*directions: tuple[int, int]) -> Star:
    return Star(0, tuple((0, k + 1) for k in range(len(directions))), directions)


def line(*densities: float) -> Leaf:
    rows = {(0, k + 1): (Fraction(x),) for k, x in enumerate(densities)}
    return Leaf(rows, 1, (0,), ((Fraction(1), Fraction(1)),))


def test_exact_lines_are_better_for_ways_that_may_be_linear_and_for_flat_folds() -> None:
    """A pair of straight creases stays linear; a fold whose bounds hold 0 may be flat."""
    cross = {0: star((1, 0), (0, 1), (-1, 0), (0, -1))}
    assert not isolated._may_be_taken(cross, line(1, 0, 1, 0))
    other = {0: star((2, 1), (-1, 1), (-1, -1), (1, -2))}
    assert isolated._may_be_taken(other, line(1, 2, 3, 5))
    assert not isolated._may_be_taken(other, line(1, 2, 0, 5))


def test_other_parts_are_left_to_splitting() -> None:
    star = panels(single_vertex(5))
    moving = stars(star)
    assert isolated_ways(moving, *first_order(moving)) is None


def test_the_clock_ends_the_search() -> None:
    assert decompose(ring(1, SIX), clock=Clock(0)).status is UNDECIDED
