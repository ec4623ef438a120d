"""Straight creases from boundary to boundary: found, closed at every vertex, and truly folding."""

from fractions import Fraction

import pytest
from panel_sheets import mesh
from test_folding_modes import boxes

from exactfold._support.clock import Clock
from exactfold._support.verdict import PROVED, REFUTED
from exactfold.panels.decomposition import decompose
from exactfold.panels.folding_modes import folding_mode
from exactfold.panels.spaces.kernel import number
from exactfold.panels.spaces.straight import straight_creases
from exactfold.panels.vertex.stars import stars
from exactfold.pattern.panel_pattern import PanelPattern


@pytest.mark.parametrize(("slants", "diagonals"), [("/", 7), ("\\", 7), ("/  ", 3), (" ", 0)])
def test_the_straight_creases_of_a_grid_are_its_lines_and_diagonals(
    slants: str, diagonals: int
) -> None:
    pattern = boxes(5, slants)
    moving = stars(pattern)
    creases = straight_creases(moving)
    assert len(creases) == 8 + diagonals
    for crease in creases:
        w = {fold: number(row[0]) for fold, row in crease.items()}
        for star in moving.values():
            pairs = [(w.get(f, 0), d) for f, d in zip(star.folds, star.directions, strict=True)]
            assert sum(x * d[0] for x, d in pairs) == sum(x * d[1] for x, d in pairs) == 0
            assert star.form([x for x, _ in pairs]) == 0
        mode = folding_mode(pattern, moving, crease)
        assert mode is not None
        assert (mode.extends.verdict, len(set(mode.assignment.values()))) == (PROVED, 1)


def test_a_bent_crease_is_none() -> None:
    assert straight_creases(stars(mesh(3, 3, seed=1))) == []
    plain = boxes(5, " ")
    points = list(plain.vertices)
    points[14] = (points[14][0] + Fraction(1, 100), points[14][1])
    bent = straight_creases(stars(PanelPattern(points, plain.edges)))
    assert len(bent) == 7


def test_parallel_creases_fold_independently() -> None:
    """Without time 11 diagonals are found that share no vertex; 2 more cut off corners."""
    found = decompose(boxes(7, "/"), clock=Clock(0))
    assert found.rigid is REFUTED
    assert found.freedom is not None
    assert (found.freedom.least, len(found.free)) == (13, 2)
