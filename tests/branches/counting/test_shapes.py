"""How many shapes there are with given angle deficits."""

from __future__ import annotations

from fractions import Fraction

import pytest
from independent import curvature
from sheets import HEXAGON, scrambled
from test_rims import fan

from exactfold import PROVED, UNDECIDED, random_square
from exactfold.app.report import shapes_report
from exactfold.app.report.terminal import console
from exactfold.app.schemas import schema
from exactfold.branches import count_shapes
from exactfold.errors import BadCurvatureError
from exactfold.pattern.crease_pattern import CreasePattern

SIX = scrambled(5, HEXAGON, 12)
THREE = CreasePattern(
    [(0, 0), (4, 0), (4, 4), (0, 4), (-3, 2), (2, 1), (-1, 2), (2, 3)],
    [*fan(5, 0, 1, 2, 7), *fan(7, 2, 3, 0)[:2], *fan(6, 0, 3, 4)],
)


def test_positive_deficits_leave_nothing_to_find() -> None:
    found = count_shapes(SIX, dict.fromkeys(SIX.interior, Fraction(1, 3)))
    assert (found.status, found.distinct, found.signs) == (PROVED, 2**12, ())


def test_flat_stars_are_counted_once() -> None:
    # Vertices 5 and 7 lie behind a fold from boundary to boundary; nothing bends them. The deficit
    # is one with rational heights, so that they are proved flat.
    deficit = curvature(THREE, {v: Fraction(v == 6) for v in range(8)}, 6)
    found = count_shapes(THREE, {6: deficit})
    assert (found.status, found.distinct, found.with_multiplicity) == (PROVED, 2, 8)
    assert found.signs == ("0+0", "0-0")


def test_what_is_not_proved_flat_leaves_bounds() -> None:
    found = count_shapes(THREE, {6: 1})
    assert (found.status, found.distinct, found.bounds) == (UNDECIDED, None, (2, 8))
    many = count_shapes(random_square(11, seed=2), {4: 1})
    assert (many.status, many.bounds) == (UNDECIDED, (2, 2**11))
    assert "10 vertices without a deficit" in many.reason


def test_negative_deficits_are_refused() -> None:
    with pytest.raises(BadCurvatureError, match="vertex 6"):
        count_shapes(THREE, {6: -1})


def test_the_table_and_the_object_say_the_same() -> None:
    found = count_shapes(THREE, {6: 1})
    out = console()
    with out.capture() as captured:
        out.print(shapes_report(found))
    assert "at least 2, at most 8; 8 with multiplicity" in " ".join(captured.get().split())
    assert sorted(found.to_dict()) == sorted(schema("shapes")["required"])
