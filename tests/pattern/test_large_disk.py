"""Sheets with many triangles are checked in arrays, with the same results and the same errors."""

import random
from collections import Counter
from fractions import Fraction

import pytest

from exactfold.errors import PatternError
from exactfold.pattern import large_disk
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.triangulating.delaunay_sheets import delaunay

CORNERS = [(0, 0), (20, 0), (20, 20), (0, 20)]
SQUARE = [(Fraction(x), Fraction(y)) for x, y in CORNERS]


def damaged(source: random.Random) -> tuple[list, list]:
    """The vertices and triangles of a sheet, to which something was done in most cases."""
    inside = {
        (source.randrange(1, 20), source.randrange(1, 20)) for _ in range(source.randrange(9))
    }
    pattern = delaunay([*CORNERS, *sorted(inside)])
    vertices, triangles = list(pattern.vertices), list(pattern.triangles)
    k, (a, b, c) = max(enumerate(triangles), key=lambda _: source.random())
    match source.randrange(9):
        case 0:
            triangles = [(a, c, b) for a, b, c in triangles]
        case 1:
            triangles = source.sample(triangles, source.randint(1, len(triangles)))
        case 2:
            vertices.append(source.choice(vertices))
        case 3:
            triangles[k] = (a, c, b)
        case 4:
            vertices[source.randrange(len(vertices))] = (
                Fraction(7, 2),
                Fraction(source.randrange(20)),
            )
        case 5:
            triangles.append(
                source.choice([(a, b, c), (a, b, len(vertices)), (a, b, -1), (a, a, b)])
            )
        case 6:
            away, n = source.choice([0, 20, 30]), len(vertices)
            vertices += [(x + away, y) for x, y in vertices]
            triangles += [(a + n, b + n, c + n) for a, b, c in triangles]
    return vertices, triangles


def made(vertices: list, triangles: list) -> object:
    try:
        pattern = CreasePattern(vertices, triangles)
    except PatternError as error:
        return type(error).__name__, str(error)
    return pattern.vertices, pattern.triangles, pattern.boundary, pattern.edges, pattern.star(0)


def test_arrays_decide_as_loops_do(monkeypatch):
    source, kinds = random.Random(9), Counter[str]()
    for _ in range(200):
        sheet = damaged(source)
        monkeypatch.setattr(large_disk, "MANY", 10**9)
        expected = made(*sheet)
        monkeypatch.setattr(large_disk, "MANY", 0)
        assert made(*sheet) == expected
        kinds[expected[0] if isinstance(expected[0], str) else "valid"] += 1
    assert len(kinds) == 6, kinds


@pytest.mark.parametrize(
    "triangles",
    [[(0, 1, True)], [(0, 1, 2.0)], [[0, 1, 2], (0, 2, 3)], ["012"], [(0, 1, 2**70)], [(0, 1)]],
)
def test_what_is_no_triple_of_integers_is_left_to_the_loops(triangles, monkeypatch):
    expected = made(SQUARE, triangles)
    monkeypatch.setattr(large_disk, "MANY", 0)
    assert made(SQUARE, triangles) == expected


def test_a_vertex_with_two_closed_fans_is_no_disk(monkeypatch):
    wheel = [(0, 1, 4), (1, 2, 4), (2, 3, 4), (0, 4, 3)]
    other = [(4, 5, 6), (4, 6, 7), (4, 7, 8), (4, 8, 5)]
    points = [*CORNERS, (10, 10), (5, 5), (15, 5), (15, 15), (5, 15)]
    assert large_disk.oriented_disk(points[:5], wheel) is None  # they are few
    monkeypatch.setattr(large_disk, "MANY", 0)
    assert large_disk.oriented_disk(points[:5], wheel) == (tuple(wheel), (0, 1, 2, 3))
    assert large_disk.oriented_disk(points, wheel + other) is None
