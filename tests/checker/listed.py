"""Sheets whose listings are checked, with the kind of their evidence."""

import json

import pytest
from old_listing import old_listing
from sheets import (
    SQUARE,
    TRIANGLE,
    dart,
    mapped,
    nested_triangles,
    random_wheel,
    reflex_corners,
    scrambled,
    straight_side,
    two_triangles,
    wheel,
    with_point,
)

from exactfold import PROVED, random_square
from exactfold.branches import count_branches
from exactfold.checker.sheets.sheet import Sheet
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.families import FAMILIES, hypar, two_vertex

SHEETS = {
    **{name: build() for name, build in FAMILIES.items()},
    "hypar proper": hypar(1, twist=0),
    "random": random_square(5, seed=1),
    "rigid vertex": with_point(two_vertex(), 1, (1, 2, 2)),
    "two rigid vertices": two_triangles(),
    "nested": nested_triangles(),
    "chord": with_point(CreasePattern(SQUARE, [(0, 1, 2), (0, 2, 3)]), 0, (1, 1, 1)),
    "dart": dart(),
    "reflex": scrambled(4, reflex_corners(4), 3),
    "straight side": straight_side(smallest=True),
    "cross": wheel([(1, 0), (0, 2), (-3, 0), (0, -1)]),
    "triangle": scrambled(2, TRIANGLE, 4),
    "nine folds": random_wheel(1, 9),
    "huge numbers": mapped(random_square(2, seed=1), lambda p: (10**4500 * p[0], 10**4500 * p[1])),
}
EVIDENCE = {
    **dict.fromkeys(SHEETS, "isolated"),
    **dict.fromkeys(["flat-vertex", "hypar proper"], "algebraic"),
    **dict.fromkeys(["waterbomb", "nine folds"], "single vertex"),
    "triangle": "rigid",
}
sheets = pytest.mark.parametrize("name", SHEETS)


def proof(name):
    result = count_branches(SHEETS[name])
    assert result.status is PROVED
    return json.loads(json.dumps(old_listing(result)))


def checked_sheet(pattern):
    return Sheet(dict(enumerate(pattern.vertices)), [tuple(t) for t in pattern.triangles])
