"""All pairs of faces are there once, by what they share, and folds know when they are closed."""

from __future__ import annotations

from fractions import Fraction

import pytest
from sheets import nested_triangles, reflex_corners, star_in

from exactfold.motion.contacts.face_pairs import FacePairs
from exactfold.motion.curves.framework import Framework
from exactfold.pattern.triangulating.random_squares import random_square

SHEETS = pytest.mark.parametrize(
    "pattern",
    [random_square(4, seed=1), nested_triangles(), star_in(reflex_corners(1))],
    ids=["square", "triangles", "reflex"],
)


@SHEETS
def test_all_pairs_of_faces_are_looked_at(pattern):
    framework = Framework.of(pattern)
    pairs = FacePairs(framework)
    faces = framework.sheet.triangles
    number = len(pairs.apart) + len(pairs.corner) + len(framework.sheet.folds)
    assert number == len(faces) * (len(faces) - 1) // 2
    for row, (v, a, b, c, d) in enumerate(pairs.corners):
        one, two = pairs.names(row, "corner")
        assert ({v, a, b}, {v, c, d}) == (set(one), set(two))
    for row in range(len(pairs.apart)):
        one, two = pairs.names(row, "apart")
        assert not set(one) & set(two)


@SHEETS
def test_the_distance_across_a_closed_fold_is_that_of_the_mirror_image_and_never_less(pattern):
    framework = Framework.of(pattern)
    sheet = framework.sheet
    scale = 1 << framework.bits
    points = [(Fraction(x, scale), Fraction(y, scale)) for x, y in framework.points]
    for fold, found in zip(sheet.folds, FacePairs(framework).closed, strict=True):
        (ax, ay), (bx, by) = (points[v] for v in fold)
        (lx, ly), (rx, ry) = (points[v] for v in sheet.opposite(fold))
        dx, dy = bx - ax, by - ay
        share = ((rx - ax) * dx + (ry - ay) * dy) / (dx * dx + dy * dy)
        mx, my = 2 * (ax + share * dx) - rx, 2 * (ay + share * dy) - ry
        exact = (lx - mx) ** 2 + (ly - my) ** 2
        assert exact <= Fraction(float(found)) <= exact * (1 + Fraction(1, 10**11))
