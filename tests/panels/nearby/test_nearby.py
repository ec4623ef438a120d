"""What is said of every sheet near a drawing, against random sheets near it."""

import json
from dataclasses import replace
from fractions import Fraction
from random import Random

import numpy as np
import pytest
from jsonschema import Draft202012Validator
from sampling import slow_after

from exactfold._support.clock import Clock
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED, Verdict
from exactfold.app.schemas import schema
from exactfold.app.verbs.completing import counted_with_letters
from exactfold.design.panels.vertex.vertices import vertices
from exactfold.errors import FoldError, NotADiskError, PatternError
from exactfold.panels.decomposition import decompose
from exactfold.panels.nearby.box import Box, box_of
from exactfold.panels.nearby.freedom import nearby_freedom
from exactfold.panels.nearby.letters import NearbyFan, refuted_vertices, still_folds
from exactfold.panels.nearby.rank import UNIT, keeps_full_rank
from exactfold.panels.result import Decomposition
from exactfold.panels.spaces.kernel import first_order
from exactfold.panels.vertex.stars import star_at, stars
from exactfold.panels.vertex.vertex_motions import Fan
from exactfold.pattern.drawing.meant.values import Relation
from exactfold.pattern.loading import open_sheet
from exactfold.pattern.meant import Meant
from exactfold.pattern.opening import Opened, panels
from exactfold.pattern.panel_pattern import PanelPattern

NAMES = ("zigzags", "bird-base", "miura", "random-8", "waterbomb", "flapping-bird")
_SMALL = ("zigzags", "waterbomb")


def sheet_of(name: str) -> PanelPattern:
    sheet = open_sheet(name).sheet
    return sheet if isinstance(sheet, PanelPattern) else panels(sheet)


def size_of(sheet: PanelPattern) -> float:
    return max(float(max(c) - min(c)) for c in zip(*sheet.vertices, strict=True))


def near(sheet: PanelPattern, within: float, rng: Random) -> PanelPattern | None:
    """A random sheet in the box; None if its panels are other ones."""
    size = size_of(sheet)
    points = []
    for x, y in sheet.vertices:
        angle, far = rng.uniform(0, 6.3), within * size * rng.choice((0, 0.5, 0.999))
        move = (far * np.cos(angle), far * np.sin(angle))
        old = (Fraction(float(x)), Fraction(float(y)))
        both = zip(old, move, strict=True)
        points.append(tuple(c + Fraction(round(m * 2**40), 2**40) for c, m in both))
    try:
        moved = PanelPattern(points, sheet.edges)
    except (FoldError, PatternError, NotADiskError):
        return None
    return moved if moved.faces == sheet.faces else None


def letters_of(sheet: PanelPattern, rng: Random) -> dict[tuple[int, int], str]:
    return {fold: rng.choice("MMVVUF") for fold in sheet.folds}


@pytest.mark.parametrize("within", slow_after(1, ["0.01", "0.0001", "0.04"]))
@pytest.mark.parametrize("name", NAMES)
def test_sheets_in_the_box_have_what_is_proved_of_them(name: str, within: str) -> None:
    rng = Random(name + within)
    sheet = sheet_of(name)
    box = Box(sheet, Fraction(within))
    fans = {v: NearbyFan(box, v) for v in sheet.interior}
    still = still_folds(fans.values())
    bounds = nearby_freedom(box, still)
    assert bounds is not None
    letterings = [letters_of(sheet, rng) for _ in range(12)]
    seen = 0
    for _ in range(5):
        other = near(sheet, float(within), rng)
        if other is None:
            continue
        seen += 1
        moving = stars(other)
        assert not still & {fold for star in moving.values() for fold in star.folds}
        if bounds.first_order is not None:
            everything = {v: star_at(other, v) for v in other.interior}
            free = [e for e in other.folds if not set(e) & set(other.interior)]
            assert first_order(everything)[1] + len(free) == bounds.first_order
        if name in _SMALL:
            known = decompose(other)
            assert known.second_order is not None
            assert bounds.least <= max(known.second_order) <= bounds.most
        for letters in letterings:
            refuted = refuted_vertices(fans, letters, ())
            for v, fan in fans.items():
                star = star_at(other, v)
                given = [letters[fold] for fold in star.folds]
                assert sorted(fan.folds) == sorted(star.folds)
                folds = Fan(star).folds(given)
                if v in refuted:
                    assert not folds
                if fan.must_fold([letters[fold] for fold in fan.folds]):
                    assert folds
    assert seen


@pytest.mark.slow
def test_a_large_sheet_has_bounds_too() -> None:
    side = 16
    points = [(x, y) for y in range(side + 1) for x in range(side + 1)]
    across = [(k, k + 1) for k in range(len(points)) if k % (side + 1) < side]
    along = [(k, k + side + 1) for k in range(len(points) - side - 1)]
    sheet = PanelPattern(points, [*across, *along])
    bounds = nearby_freedom(Box(sheet, Fraction(1, 10**5)), ())
    assert bounds is not None
    assert bounds.first_order == first_order(stars(sheet))[1] == 2 * (side - 1)
    assert bounds.most < bounds.first_order


@pytest.mark.parametrize("seed", range(50))
def test_a_turn_is_open_as_soon_as_a_line_meets_all_three_discs(seed: int) -> None:
    """Three discs of radius r about the corners of a triangle meet a line if its least height is
    at most 2 r; then three points of them are on one line.
    """
    rng = Random(seed)
    points = [(rng.randint(0, 100), rng.randint(0, 100)) for _ in range(3)]
    (ax, ay), (bx, by), (cx, cy) = points
    area = abs((bx - ax) * (cy - ay) - (by - ay) * (cx - ax))
    if not area:
        return
    sides = [np.hypot(bx - ax, by - ay), np.hypot(cx - bx, cy - by), np.hypot(ax - cx, ay - cy)]
    sheet = PanelPattern(points, [(0, 1), (1, 2), (0, 2)])
    half = area / max(sides) / 2
    for factor, settled in ((1.001, False), (0.3, True)):
        box = Box(sheet, Fraction(half * factor / size_of(sheet)))
        assert bool(box.turn(0, 1, 2)) is settled


@pytest.mark.parametrize("seed", range(20))
def test_a_rank_is_kept_up_to_the_least_singular_value(seed: int) -> None:
    rng = np.random.default_rng(seed)
    rows = int(rng.integers(1, 30))
    matrix = np.rint(rng.normal(size=(rows, rows + int(rng.integers(0, 9)))) * UNIT)
    least = float(np.linalg.svd(matrix / UNIT)[1].min())
    assert not keeps_full_rank(matrix, Fraction(least * (1 + 1e-12)))
    if least > 0.01:
        assert keeps_full_rank(matrix, Fraction(least * 0.99 - 0.001))


def test_more_rows_than_columns_are_dependent() -> None:
    assert not keeps_full_rank(np.eye(3)[:, :2] * UNIT, Fraction(0))


def doubted(sheet: str | Opened, missed: float) -> Opened:
    """A sheet of which it is pretended that relations are missed by so much."""
    relation = Relation("straight", "straight@9:0-1", (), 1, missed)
    return replace(open_sheet(sheet), meant=Meant(left=(relation,), reason="there is no gap"))


def almost_straight(bend: Fraction) -> Opened:
    """Three mountains and a valley at one vertex; two mountains almost form a line."""
    points: list[tuple[int | Fraction, int | Fraction]] = [
        (1, -1),
        (1, 0),
        (1, 1),
        (0, 1),
        (-1, 1),
        (-1, bend),
        (-1, -1),
        (0, -1),
        (0, 0),
    ]
    rim = [(k, (k + 1) % 8) for k in range(8)]
    letters = {(1, 8): "M", (3, 8): "M", (5, 8): "M", (7, 8): "V"}
    return Opened(PanelPattern(points, [*rim, *letters]), letters)


def counted(opened: Opened) -> Decomposition:
    found = counted_with_letters(opened, "auto", 0, Clock(10.0))
    assert isinstance(found, Decomposition)
    return found


def test_wrong_letters_are_refuted_for_every_sheet_near_the_drawing() -> None:
    found = counted(doubted("zigzags", 3e-3))
    assert found.status is UNDECIDED
    assert found.drawn is not None
    assert found.freedom is not None
    assert (found.drawn.starts, found.drawn.truly) == (REFUTED, REFUTED)
    assert found.drawn.within == found.freedom.within == 0.009
    assert "vertices 9, 10, 13, 14" in found.drawn.reasons[0]
    document = found.to_dict()
    Draft202012Validator(schema("count")).validate(json.loads(json.dumps(document)))
    assert document["drawn"] is not None
    assert document["drawn"]["within"] == 0.009


@pytest.mark.slow
def test_letters_that_fit_are_not_proved_for_the_whole_sheet() -> None:
    found = counted(doubted("bird-base", 1e-4))
    assert found.drawn is not None
    assert found.drawn.starts is UNDECIDED


def test_no_vertex_that_starts_is_no_proof_that_none_does() -> None:
    found = counted(doubted(almost_straight(Fraction(1, 50)), 0.002))
    assert found.drawn is not None
    assert found.drawn.starts is UNDECIDED
    (reason,) = found.drawn.reasons
    assert reason == "of no vertex by itself is it proved that it starts to fold with its letters"


def test_the_box_is_three_times_the_noise_that_was_not_believed() -> None:
    opened = doubted("zigzags", 2e-3)
    box = box_of(opened)
    assert box is not None
    assert box.within == Fraction(6, 1000)
    assert opened.meant is not None
    known = replace(opened, meant=replace(opened.meant, noise=1.1e-4))
    box = box_of(known)
    assert box is not None
    assert box.within == Fraction(4, 10000)


def test_an_exact_sheet_has_no_box() -> None:
    assert box_of(open_sheet("zigzags")) is None
    found = counted(open_sheet("zigzags"))
    assert found.nearby is None


@pytest.mark.parametrize(("bend", "starts"), [(1, REFUTED), (-1, PROVED)])
def test_vertices_are_open_where_noise_decides(bend: int, starts: Verdict) -> None:
    """The least radius at which the two mountains may be straight is 0.0025 of the size."""
    opened = almost_straight(Fraction(bend, 50))
    assert vertices(opened).starts is starts
    assert vertices(doubted(opened, 0.0006)).starts is starts
    found = vertices(doubted(opened, 0.0018))
    assert found.starts is UNDECIDED
    assert "not proved for every sheet with these panels" in found.facts[0].reason


def test_letters_that_no_angles_allow_stay_refuted() -> None:
    """Two mountains and two valleys at each vertex: neither lie on all sides of a vertex."""
    assert {facts.starts for facts in vertices(doubted("zigzags", 0.3)).facts} == {REFUTED}
