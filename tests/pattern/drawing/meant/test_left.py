"""Relations that a sheet nearly has are told from those that it has, and from chance."""

import random
from fractions import Fraction

import pytest

from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.data import EXAMPLES
from exactfold.pattern.degenerate import DEGENERATE
from exactfold.pattern.drawing.meant import left
from exactfold.pattern.drawing.meant.left import left_relations
from exactfold.pattern.loading import open_sheet
from exactfold.pattern.opening import panels
from exactfold.pattern.panel_pattern import PanelPattern

KITE = [(0, 0), (3, 0), (2, 2), (0, 1)]
SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]
FAN = [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]


@pytest.mark.parametrize("name", [*EXAMPLES, *DEGENERATE])
def test_exact_sheets_have_no_relation_nearly(name):
    sheet = open_sheet(name).sheet if name in EXAMPLES else DEGENERATE[name]()
    assert left_relations(sheet) == ()


def test_the_defect_is_an_angle_times_the_shortest_edge_over_the_size():
    off = Fraction("1e-8")
    sheet = CreasePattern([*KITE, (Fraction(1, 2) + off, Fraction(1, 2) - off)], FAN)
    (near,) = left_relations(sheet)
    assert (near.kind, near.name, near.parts) == ("straight", "straight@4:0-2", 1)
    assert dict(near.terms) == {(0, 4): 1, (2, 4): -1}
    short, long = 0.5 * 2**0.5, 1.5 * 2**0.5
    assert near.defect == pytest.approx(1e-8 * 2**0.5 * (1 / short + 1 / long) * short / 3)
    assert left_relations(panels(sheet)) == (near,)


def test_defects_far_below_floats_are_seen():
    off = Fraction(1, 10**40)
    (near,) = left_relations(CreasePattern([*KITE, (Fraction(1, 2) + off, Fraction(1, 2))], FAN))
    assert near.defect == pytest.approx(1e-40 * 0.5**0.5 * 4 / 3 / 3, rel=1e-6)


def test_a_border_that_is_nearly_straight():
    bent = CreasePattern([(0, 0), (1, "-1e-12"), (2, 0), (1, 1)], [(0, 1, 3), (1, 2, 3)])
    assert [near.name for near in left_relations(bent)] == ["border@1"]


@pytest.mark.parametrize(("height", "defects"), [(0, []), ("1e-11", [1e-11 / 3 * 3 / 7])])
def test_a_sum_of_kawasaki(height, defects):
    star = [(3, height), (0, 3), (-4, 3), (-3, -4), (0, 0)]  # two opposite sectors of 90 degrees
    edges = [(0, 1), (1, 2), (2, 3), (0, 3), (0, 4), (1, 4), (2, 4), (3, 4)]
    near = left_relations(PanelPattern(star, edges))
    assert [relation.name for relation in near] == ["kawasaki@4"] * len(defects)
    assert [relation.defect for relation in near] == pytest.approx(defects, rel=1e-6)


def _grid(steps: int, moved: Fraction) -> CreasePattern:
    """A triangulated grid with one interior vertex moved to the right."""
    side = range(steps + 1)
    points = [(Fraction(x), Fraction(y)) for y in side for x in side]
    middle = (steps + 2) * (steps // 2)
    points[middle] = (points[middle][0] + moved, points[middle][1])
    corners = [x + (steps + 1) * y for y in range(steps) for x in range(steps)]
    faces = [(c, c + 1, c + steps + 2) for c in corners]
    return CreasePattern(points, [*faces, *((c, c + steps + 2, c + steps + 1) for c in corners)])


@pytest.mark.parametrize("moved", [Fraction(0), Fraction(1, 2**26), Fraction(1, 10**25)])
def test_integers_of_64_bits_and_of_any_size_find_the_same(monkeypatch, moved):
    """Straight lines and sums of Kawasaki at six folds; the last move is beyond 64 bits."""
    one_by_one, rows = left._exact, []
    monkeypatch.setattr(left, "_exact", lambda *args: rows.append(1) or one_by_one(*args))
    found, few = left_relations(_grid(32, moved)), len(rows)
    rows.clear()
    monkeypatch.setattr(left, "_small_integers", lambda points: None)
    assert left_relations(_grid(32, moved)) == found
    assert bool(found) == bool(moved)
    assert (few == 0) == (not moved)
    assert len(rows) > 31 * 31 * 4


@pytest.mark.parametrize(("off", "number"), [(0, 0), ("1e-11", 1)])
def test_a_sum_of_kawasaki_at_six_folds(off, number):
    """No two folds are opposite, but every other sector adds up to 180 degrees."""
    ends = [(-3, -1), (-1, -2), (2, -3 + Fraction(off)), (1, 3), (-3, 2), (-2, 1)]
    edges = [(k, 6) for k in range(6)] + [(k, k + 1) for k in range(5)] + [(0, 5)]
    near = left_relations(PanelPattern([*ends, (0, 0)], edges))
    assert [relation.name for relation in near] == ["kawasaki@6"] * number


def test_few_random_sheets_have_near_relations():
    """At most 0.05 are expected for each sheet, and this seed has fewer."""
    rng, near = random.Random(1), 0
    for _ in range(200):
        x, y = (Fraction(rng.randrange(1, 10**15), 10**15) for _ in "xy")
        near += len(left_relations(CreasePattern([*SQUARE, (x, y)], FAN)))
    assert near == 0


@pytest.mark.parametrize(("digits", "number"), [(2, 0), (3, 0), (12, 1)])
def test_one_relation_that_chance_explains_is_not_near(digits, number):
    third = Fraction(round(Fraction(10**digits, 3)), 10**digits)
    sheet = CreasePattern([*KITE, (third, third + Fraction(1, 10**digits))], FAN)
    assert len(left_relations(sheet)) == number


def test_many_relations_are_near_even_if_each_alone_is_not():
    """A grid in which straight paths bend by 1/3000: one alone would not be believed."""
    rng = random.Random(2)
    points = [
        (Fraction(3 * x) + Fraction(rng.randrange(-9, 10), 9000), Fraction(2 * y))
        for y in range(6)
        for x in range(6)
    ]
    edges = [(6 * y + x, 6 * y + x + 1) for y in range(6) for x in range(5)]
    edges += [(6 * y + x, 6 * y + x + 6) for y in range(5) for x in range(6)]
    near = left_relations(PanelPattern(points, edges))
    assert {"straight", "kawasaki", "border"} == {relation.kind for relation in near}
    bent = [
        f"straight@{v}:{v - 6}-{v + 6}"
        for v in (6 * y + x for y in range(1, 5) for x in range(1, 5))
        if points[v - 6][0] + points[v + 6][0] != 2 * points[v][0]
    ]
    assert sorted(one.name for one in near if one.kind == "straight") == sorted(bent)
    assert len(bent) == 15


def test_noise_of_a_thousandth_of_the_size_is_seen():
    """The ends of parallel creases are moved by up to 1e-3 of the size in x and in y."""
    rng = random.Random(3)
    points = [
        (Fraction(c + 12 * rng.uniform(-1e-3, 1e-3)) for c in (4 * i + j % 2, 4 * j))
        for i in range(4)
        for j in range(4)
    ]
    edges = [(4 * i + j, 4 * i + j + 1) for i in range(4) for j in range(3)]
    edges += [(4 * i + j, 4 * i + j + 4) for i in range(3) for j in range(4)]
    near = left_relations(PanelPattern(points, edges))
    straight = {relation.name for relation in near if relation.kind == "straight"}
    assert straight == {
        f"straight@{4 * i + j}:{4 * i + j - 4}-{4 * i + j + 4}" for i in (1, 2) for j in (1, 2)
    }


NEAR = {
    "straight": CreasePattern([*KITE, ("0.50000001", "0.49999999")], FAN),
    "border": CreasePattern([(0, 0), (1, "-1e-12"), (2, 0), (1, 1)], [(0, 1, 3), (1, 2, 3)]),
    "too short": CreasePattern([*KITE, (Fraction(1, 10**400), Fraction(1, 10**400))], FAN),
    "none": CreasePattern([*KITE, ("0.41", "0.57")], FAN),
    "chance": CreasePattern([*KITE, ("0.33", "0.34")], FAN),
}


@pytest.mark.parametrize("name", NEAR)
def test_plain_floats_and_arrays_find_the_same(monkeypatch, name):
    known = left_relations(NEAR[name])
    monkeypatch.setattr(left, "_SMALL", 0)
    sheet = NEAR[name]
    assert left_relations(CreasePattern(sheet.vertices, sheet.triangles)) == known
    assert bool(known) == (name in ("straight", "border"))
