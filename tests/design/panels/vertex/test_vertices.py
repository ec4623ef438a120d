"""What is known of each vertex: letters, Kawasaki's and Maekawa's conditions, what to change."""

from __future__ import annotations

import pickle
import random
from fractions import Fraction
from itertools import combinations, product
from math import atan2, cos, degrees, gcd, pi

import pytest

import exactfold
from exactfold import PROVED, REFUTED, UNDECIDED
from exactfold.design import match_panels
from exactfold.design.panels.vertex.facts import VertexFacts, vertex_facts
from exactfold.design.panels.vertex.vertices import Vertices, vertices
from exactfold.errors import UsageError
from exactfold.exact.surds import RATIONALS
from exactfold.panels.vertex.stars import star_at
from exactfold.panels.vertex.vertex_motions import vertex_motion
from exactfold.pattern.drawing.meant.values import Relation
from exactfold.pattern.loading import open_sheet
from exactfold.pattern.meant import Meant
from exactfold.pattern.opening import Opened
from exactfold.pattern.panel_pattern import PanelPattern, Point
from exactfold.pattern.reading import Reading

Letters = dict[tuple[int, int], str]

OTHER = {"M": "V", "V": "M"}
ROOT = RATIONALS.adjoined(3).root


def sheet_of(around: list[Point]) -> PanelPattern:
    """Folds in these directions, counter-clockwise, from vertex 0, and a polygon about their ends.

    Fold k goes to vertex k + 1. In sectors of 180 degrees or more the polygon has more corners.
    """
    corners: list[Point] = []
    rim: list[Point] = []
    for k, (x, y) in enumerate(around):
        rim.append((x, y))
        bx, by = around[(k + 1) % len(around)]
        across, along = x * by - y * bx, x * bx + y * by
        if across < 0 or (across == 0 and (along < 0 or len(around) == 1)):
            between: list[Point] = [(-y, x)]
            between += [(-x, -y)] if across < 0 or along > 0 else []
            between += [(y, -x)] if across <= 0 < along else []
            rim += between
            corners += between
    points: list[Point] = [(0, 0), *around, *corners]
    order = [points.index(point) for point in rim]
    sides = zip(order, order[1:] + order[:1], strict=True)
    return PanelPattern(points, [*sides, *((0, k + 1) for k in range(len(around)))])


def facts_of(around: list[Point], letters: str, *, exactly: bool = False) -> VertexFacts:
    """The facts of the vertex, with one letter for each direction."""
    by_fold = {(0, k): letter for k, letter in enumerate(letters, 1)}
    [facts] = vertex_facts(sheet_of(around), by_fold, exactly=exactly)
    return facts


MIURA: list[Point] = [(2, 0), (1, 2), (-2, 0), (1, -2)]


def test_a_vertex_that_folds_in_every_respect() -> None:
    facts = facts_of(MIURA, "VMMM")
    assert (facts.starts, facts.able, facts.reason) == (PROVED, True, "")
    assert (facts.kawasaki, facts.off, facts.maekawa, facts.turn) == (True, 0.0, True, None)
    assert (facts.flips, facts.forced, facts.excess) == ((), {}, 2)


@pytest.mark.parametrize(
    ("around", "letters", "reason"),
    [
        (MIURA, "MMMM", "all its folds are mountains, and it needs a valley"),
        (
            MIURA,
            "MVVM",
            "its mountains 0-1, 0-4 lie on one side of a line, and so do its valleys 0-2, 0-3",
        ),
        ([(1, 0), (-2, 0)], "MV", "the two halves of a straight crease have different letters"),
        (
            [(1, 0), (0, 1), (-1, 0), (0, -1)],
            "VMMM",
            "its folds form two straight lines, which cannot move at the same time",
        ),
        (
            [(1, 0), (0, 1), (-1, -1)],
            "MVM",
            "three folds with sectors smaller than 180 degrees cannot move",
        ),
        (MIURA, "MFFF", "a vertex with a single fold cannot fold"),
    ],
)
def test_reasons(around: list[Point], letters: str, reason: str) -> None:
    facts = facts_of(around, letters)
    assert (facts.starts, facts.reason) == (REFUTED, reason)


def test_a_wide_sector_is_named_with_its_angle() -> None:
    facts = facts_of([(1, 0), (0, 1)], "MV")
    assert facts.reason == "the sector between folds 0-2 and 0-1 has 270 degrees, more than 180"
    assert not facts.able


def test_a_sector_of_180_degrees_leaves_the_straight_crease_only() -> None:
    facts = facts_of([(1, 0), (0, 1), (-1, 0)], "MVM")
    assert facts.starts is REFUTED
    assert facts.able
    assert "has 180 degrees, so that only these two can move" in facts.reason
    assert facts.flips == ()
    assert facts_of([(1, 0), (0, 1), (-1, 0)], "MFM").starts is PROVED


def test_without_a_letter_the_question_is_whether_any_letters_do() -> None:
    facts = facts_of([(1, 0), (0, 1), (-1, -1)], "UUU")
    assert (facts.starts, facts.able) == (PROVED, False)
    assert facts_of(MIURA, "UUUU").able


@pytest.mark.parametrize("seed", range(25))
def test_flips_are_all_smallest_changes(seed: int) -> None:
    """Compared with the theorem for every set of folds, as large as the sheet."""
    rng = random.Random(seed)
    grid = [(x, y) for x in range(-3, 4) for y in range(-3, 4) if gcd(x, y) == 1]
    spread = sorted(rng.sample(grid, rng.choice([4, 5, 6])), key=lambda d: atan2(d[1], d[0]))
    star = star_at(sheet_of(list(spread)), 0)
    letters = "".join(rng.choice("MV") for _ in star.folds)
    facts = facts_of(list(spread), letters)
    given = {(0, k): letter for k, letter in enumerate(letters, 1)}
    assert facts.folds == star.folds
    sizes: dict[int, set[tuple[tuple[int, int], ...]]] = {}
    for size in range(len(letters) + 1):
        for chosen in combinations(star.folds, size):
            changed = {e: OTHER[x] if e in chosen else x for e, x in given.items()}
            if vertex_motion(star, changed) is not None:
                sizes.setdefault(size, set()).add(chosen)
    least = min(sizes, default=0)
    assert (facts.starts is PROVED) is (0 in sizes)
    assert set(facts.flips) == (set() if 0 in sizes else sizes.get(least, set()))


def test_forced_letters() -> None:
    facts = facts_of([(2, 1), (-1, 1), (-1, -1), (1, -2)], "MUMV")
    assert facts.starts is PROVED
    assert facts.forced == {(0, 2): "M"}


# --- flat folding --------------------------------------------------------------------------------


def test_kawasaki_in_a_field_of_square_roots() -> None:
    """Sectors 60, 60, 120, 120: the sums of every second one are 180 exactly."""
    half = ROOT / 2
    sixty: list[Point] = [(1, 0), (Fraction(1, 2), half), (Fraction(-1, 2), half)]
    facts = facts_of([*sixty, (Fraction(-1, 2), -half)], "MMMV")
    assert (facts.kawasaki, facts.off) == (True, 0.0)
    nearly = facts_of([*sixty, (Fraction(-1, 2), -half + Fraction(1, 10**13))], "MMMV")
    assert not nearly.kawasaki
    assert nearly.meant_kawasaki
    assert nearly.off == pytest.approx(-degrees(5e-14), rel=1e-3)  # cos 60 = 1/2


@pytest.mark.parametrize("seed", range(20))
def test_off_is_the_alternating_sum_and_the_turn_mends_it(seed: int) -> None:
    rng = random.Random(seed)
    count = rng.choice([4, 6])
    angles = sorted(2 * pi * (k + 0.7 * rng.random()) / count for k in range(count))
    around: list[Point] = [
        (Fraction(round(1e6 * c), 10**6), Fraction(round(1e6 * s), 10**6))
        for c, s in ((cos(a), cos(a - pi / 2)) for a in angles)
    ]
    facts = facts_of(around, "M" * count)
    first = star_at(sheet_of(around), 0)
    seen = [atan2(float(y), float(x)) for x, y in first.directions]
    sectors = [degrees(b - a) % 360 for a, b in zip(seen, seen[1:] + seen[:1], strict=True)]
    assert facts.off == pytest.approx(sum(sectors[::2]) - 180, abs=1e-9)
    assert facts.turn is not None
    k = first.folds.index(facts.turn.fold)
    sectors[k] -= facts.turn.angle
    sectors[k - 1] += facts.turn.angle
    assert min(sectors) > 0
    assert sum(sectors[::2]) == pytest.approx(180, abs=1e-9)


def test_folds_held_flat_are_no_creases_for_flat_folding() -> None:
    facts = facts_of([(2, 0), (1, 1), (1, 2), (-2, 0), (1, -2)], "VFMMM")
    assert (facts.kawasaki, facts.maekawa) == (True, True)
    odd = facts_of([(2, 0), (1, 1), (1, 2), (-2, 0), (1, -2)], "VMMMM")
    assert (odd.kawasaki, odd.off, odd.maekawa) == (False, None, False)
    assert facts_of(MIURA, "VMMU").maekawa is None


# --- nearly straight folds -----------------------------------------------------------------------


def test_where_a_nearly_straight_line_decides_the_answer_is_open() -> None:
    """Two lines that cross do not fold; with one of them bent by 1e-9 the vertex does."""
    bent: list[Point] = [(1, 0), (0, 1), (-1, 0), (Fraction(1, 10**9), -1)]
    facts = facts_of(bent, "VMMM")
    assert facts.starts is UNDECIDED
    assert facts.reason == (
        "folds 0-2 and 0-4 miss a straight line by 6e-08 degrees: the vertex starts to fold as it "
        "is written, and with a straight line it does not"
    )
    assert facts_of(bent, "VMMM", exactly=True).starts is PROVED
    assert facts_of(bent, "MVMV").starts is REFUTED  # with or without the line
    clear: list[Point] = [(1, 0), (0, 1), (-1, 0), (Fraction(1, 100), -1)]
    assert facts_of(clear, "VMMM").starts is PROVED


def test_one_of_several_nearly_straight_lines_may_decide() -> None:
    """Straight on one side, a line keeps the vertex; with both lines straight, nothing folds."""
    tiny = Fraction(1, 10**9)
    both: list[Point] = [(1, 0), (tiny, 1), (-1, -tiny), (0, -1)]
    for letters in map("".join, product("MV", repeat=4)):
        answers = {facts_of(both, letters, exactly=True).starts}
        for one in (0, tiny):
            for other in (0, tiny):
                bent: list[Point] = [(1, 0), (one, 1), (-1, -other), (0, -1)]
                answers.add(facts_of(bent, letters, exactly=True).starts)
        starts = facts_of(both, letters).starts
        assert starts is (UNDECIDED if len(answers) > 1 else answers.pop())


def test_the_snap_exact_takes_nearly_straight_folds_as_they_are() -> None:
    sheet = sheet_of([(1, 0), (0, 1), (-1, 0), (Fraction(1, 10**9), -1)])
    letters = {(0, k): letter for k, letter in enumerate("VMMM", 1)}
    assert vertices(Opened(sheet, letters)).starts is UNDECIDED
    found = vertices(Opened(sheet, letters, reading=Reading("exact")))
    assert (found.starts, found.status) == (PROVED, PROVED)


def test_folds_are_nearly_straight_to_the_noise_of_a_drawing() -> None:
    """Bent by 1/100 the vertex folds; a drawing inexact by as much may mean a straight line."""
    around: list[Point] = [(1, 0), (0, 1), (-1, 0), (Fraction(1, 100), -1)]
    sheet = sheet_of(around)
    letters = {(0, k): letter for k, letter in enumerate("VMMM", 1)}
    near = Relation("straight", "straight@0:2-4", (((0, 2), 1), ((0, 4), -1)), 1, 5e-3)
    assert vertices(Opened(sheet, letters, meant=Meant(left=(near,)))).starts is UNDECIDED
    exact = Opened(sheet, letters, reading=Reading("exact"))
    assert (vertices(Opened(sheet, letters)).starts, vertices(exact).starts) == (PROVED, PROVED)
    bent: list[Point] = [(1, 0), (0, 1), (-1, 0), (Fraction(1, 3), -1)]
    assert vertices(Opened(sheet_of(bent), letters, meant=Meant(left=(near,)))).starts is PROVED


# --- whole sheets --------------------------------------------------------------------------------


def moved(
    sheet: PanelPattern, letters: Letters, a: Point, b: Point
) -> tuple[PanelPattern, Letters]:
    """The sheet under a linear map with these columns."""
    points = [(x * a[0] + y * b[0], x * a[1] + y * b[1]) for x, y in sheet.vertices]
    return PanelPattern(points, sheet.edges), letters


@pytest.mark.parametrize("name", ["zigzags", "bird-base", "pinwheel-base", "miura"])
@pytest.mark.parametrize(
    ("a", "b", "mirrored"),
    [
        ((Fraction(3, 5), Fraction(4, 5)), (Fraction(-4, 5), Fraction(3, 5)), False),
        ((7, 0), (0, 7), False),
        ((1, 0), (0, -1), True),
    ],
    ids=["rotated", "scaled", "reflected"],
)
def test_symmetries(name: str, a: Point, b: Point, *, mirrored: bool) -> None:
    """A motion of the plane changes no fact; a reflection reverses the order round a vertex."""
    opened = exactfold.read(name)
    sheet = opened.sheet
    assert isinstance(sheet, PanelPattern)
    before = vertex_facts(sheet, opened.letters)
    after = vertex_facts(*moved(sheet, opened.letters, a, b))
    for one, other in zip(before, after, strict=True):
        assert (one.vertex, one.starts, one.able) == (other.vertex, other.starts, other.able)
        assert (one.kawasaki, one.maekawa) == (other.kawasaki, other.maekawa)
        assert {frozenset(f) for f in one.flips} == {frozenset(f) for f in other.flips}
        order = one.folds[::-1] if mirrored else one.folds
        start = order.index(other.folds[0])
        assert order[start:] + order[:start] == other.folds
        assert abs(one.off or 0) == pytest.approx(abs(other.off or 0), abs=1e-9)


@pytest.mark.parametrize("name", ["zigzags", "bird-base", "pinwheel-base", "miura"])
def test_turning_the_sheet_over_exchanges_the_letters(name: str) -> None:
    opened = exactfold.read(name)
    sheet = opened.sheet
    assert isinstance(sheet, PanelPattern)
    turned = {e: OTHER.get(x, x) for e, x in opened.letters.items()}
    over = vertex_facts(*moved(sheet, turned, (-1, 0), (0, 1)))
    for one, other in zip(vertex_facts(sheet, opened.letters), over, strict=True):
        assert (one.starts, one.maekawa, one.excess) == (other.starts, other.maekawa, -other.excess)
        assert {frozenset(f) for f in one.flips} == {frozenset(f) for f in other.flips}


def test_a_refuted_vertex_refutes_the_sheet() -> None:
    found = exactfold.vertices("zigzags")
    assert isinstance(found, Vertices)
    assert (found.starts, found.status) == (REFUTED, PROVED)
    assert found.headline == "none of the 4 vertices can start to fold with its letters"
    assert match_panels("zigzags").truly is REFUTED
    assert found.reason.startswith("vertex 9: its mountains 9-13, 4-9 lie on one side of a line")


def test_flips_that_leave_the_other_vertices_folding_come_first() -> None:
    found = exactfold.vertices("miura", {**exactfold.read("miura").letters, (11, 20): "V"})
    [one, two] = found.refuted
    assert (one.vertex, two.vertex) == (11, 20)
    assert found.flips(one)[0] == ((11, 20),)
    assert found.failing(one, ((11, 20),)) == ()
    assert found.headline == "2 of 9 vertices cannot start to fold with their letters"
    assert found.wrong[:2] == (one, two)


def test_letters_are_those_of_the_file_unless_others_are_given() -> None:
    assert exactfold.vertices("miura").letters == exactfold.read("miura").letters
    assert exactfold.vertices("miura", "drawn").facts == exactfold.vertices("miura").facts
    free = exactfold.vertices("two-vertex")
    assert set(free.letters.values()) == {"U"}
    assert free.headline == "each of the 2 vertices starts to fold with some letters"
    with pytest.raises(UsageError):
        exactfold.vertices("two-vertex", "MV")
    with pytest.raises(UsageError):
        exactfold.vertices("two-vertex", "drawn")


def test_a_sheet_without_interior_vertices() -> None:
    square = PanelPattern(
        [(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (0, 3), (0, 2)]
    )
    found = exactfold.vertices(square, "M")
    assert (found.starts, found.facts, found.notes) == (PROVED, (), ())
    assert (
        found.headline == "the sheet has no interior vertex, so that every fold can move by itself"
    )


def test_results_pickle_and_compare() -> None:
    found = exactfold.vertices("zigzags")
    found.flips(found.facts[0])
    assert pickle.loads(pickle.dumps(found)) == found
    assert repr(found) == "<Vertices: 4 vertices, starts refuted, 4 refuted>"


def test_the_vertices_of_an_open_sheet_are_computed_once() -> None:
    opened = open_sheet("bird-base")
    found = vertices(opened)
    assert vertices(opened) is found
    assert vertices(opened, "U" * len(opened.sheet.folds)) is not found
    again = pickle.loads(pickle.dumps(opened))
    assert again == opened
    assert vertices(again) == found
