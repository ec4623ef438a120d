"""What the checker takes for a flat-folded state, against the definition, order by order.

The definition is looked at in vertical sections: beside each piece of the image of an edge, between
two points where it meets others. Nothing here knows of the conditions of `orders`.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from itertools import pairwise, permutations, product

import pytest
from flat_files import grid, roofs, strip

from exactfold.checker.core.reading import CertificateError
from exactfold.checker.layers.folding import FoldedSheet
from exactfold.checker.layers.orders import Crossings, Orders
from exactfold.checker.layers.overlaps import Overlaps
from exactfold.checker.layers.places import Strand, holds, uncrossed
from exactfold.checker.sheets.panels import read_panels
from exactfold.pattern.panel_entries import panels_document
from exactfold.pattern.panel_pattern import PanelPattern

Point = tuple[Fraction, Fraction]
Order = tuple[int, int]
STAMPS = [1, 2, 6, 16, 50, 144]  # A000136


def overlaps_of(sheet: PanelPattern, letters: str) -> Overlaps:
    read, _ = read_panels(panels_document(sheet))
    return Overlaps(FoldedSheet(read, dict(zip(read.folds, letters, strict=True)), read.panels))


def accepted(overlaps: Overlaps, lower: tuple[Order, ...]) -> bool:
    """Whether the checker takes orders for a state."""
    orders = Orders(len(overlaps.pieces))
    for order in lower:
        orders.fix(order)
    try:
        Crossings(overlaps, orders).check()
    except CertificateError:
        return False
    return True


# --- the definition ------------------------------------------------------------------------------


def reflected(p: Point, a: Point, b: Point) -> Point:
    """The mirror image of p in the line through a and b."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    twice = 2 * ((p[0] - a[0]) * dy - (p[1] - a[1]) * dx) / (dx * dx + dy * dy)
    return p[0] - twice * dy, p[1] + twice * dx


def images(
    sheet: PanelPattern, letters: dict[Order, str]
) -> tuple[list[dict[int, Point]], list[bool]]:
    """The images of the corners of each panel, and whether it is turned over."""
    start = {v: (Fraction(x), Fraction(y)) for v, (x, y) in enumerate(sheet.vertices)}
    whole, over, waiting = {0: start}, {0: False}, [0]
    while waiting:
        panel = waiting.pop()
        for fold in sheet.folds:
            two = sheet.sides[fold], sheet.sides[fold[::-1]]
            if panel in two and (other := sum(two) - panel) not in whole:
                there, fixed = whole[panel], letters[fold] == "F"
                a, b = (there[v] for v in fold)
                whole[other] = there if fixed else {v: reflected(p, a, b) for v, p in there.items()}
                over[other] = over[panel] == fixed
                over[other] = over[panel] if fixed else not over[panel]
                waiting.append(other)
    count = len(sheet.faces)
    return [{v: whole[k][v] for v in sheet.faces[k]} for k in range(count)], [
        over[k] for k in range(count)
    ]


def turn(a: Point, b: Point, c: Point) -> Fraction:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def sections(
    sheet: PanelPattern, letters: dict[Order, str]
) -> Iterator[tuple[list[int], list[int], list[tuple[int, int, bool]]]]:
    """The panels on the left and on the right of each piece of an edge, and the folds along it."""
    places, over = images(sheet, letters)
    ends = {}
    for panel, spots in enumerate(places):
        corners = sheet.faces[panel]
        for i, j in zip(corners, (*corners[1:], corners[0]), strict=True):
            ends[min(i, j), max(i, j)] = spots[min(i, j)], spots[max(i, j)]
    for a, b in ends.values():
        cuts = {Fraction(0), Fraction(1)}
        for c, d in ends.values():
            one, two = turn(a, b, c), turn(a, b, d)
            dx, dy = b[0] - a[0], b[1] - a[1]
            if one == two == 0:
                cuts |= {
                    ((x - a[0]) * dx + (y - a[1]) * dy) / (dx * dx + dy * dy) for x, y in (c, d)
                }
            elif one * two <= 0:
                x, y = (c[k] + (d[k] - c[k]) * one / (one - two) for k in (0, 1))
                cuts.add(((x - a[0]) * dx + (y - a[1]) * dy) / (dx * dx + dy * dy))
        for low, high in pairwise(sorted(cut for cut in cuts if 0 <= cut <= 1)):
            share = (low + high) / 2
            m = a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])
            normal = a[1] - b[1], b[0] - a[0]
            beside: list[list[int]] = []
            for side in (1, -1):
                beside.append([])
                n = m[0] + side * normal[0], m[1] + side * normal[1]
                for panel, spots in enumerate(places):
                    corners = [spots[v] for v in sheet.faces[panel]][:: -1 if over[panel] else 1]
                    around = zip(corners, (*corners[1:], corners[0]), strict=True)
                    if all(
                        (turn(p, q, m), turn(p, q, n) - turn(p, q, m)) > (0, 0) for p, q in around
                    ):
                        beside[-1].append(panel)
            joined = [
                (sheet.sides[fold], sheet.sides[fold[::-1]], letters[fold] != "F")
                for fold in sheet.folds
                if turn(*ends[fold], m) == 0 and min(ends[fold]) <= m <= max(ends[fold])
            ]
            yield beside[0], beside[1], joined


def is_state(
    lower: set[Order], cuts: list[tuple[list[int], list[int], list[tuple[int, int, bool]]]]
) -> bool:
    for left, right, joined in cuts:
        stacks = []
        for side in (left, right):
            stack = sorted(side, key=lambda p: sum((q, p) in lower for q in side))
            if any((q, p) in lower for k, p in enumerate(stack) for q in stack[k + 1 :]):
                return False
            stacks.append({panel: height for height, panel in enumerate(stack)})
        one, other = stacks
        level = [(one[p], other[p]) for p in one if p in other]
        level += [
            (one[a], other[b]) if a in one else (one[b], other[a])
            for a, b, bent in joined
            if not bent
        ]
        if any((x[0] < y[0]) != (x[1] < y[1]) for x in level for y in level if x != y):
            return False
        for k, stack in enumerate(stacks):
            arcs = [sorted((stack[a], stack[b])) for a, b, bent in joined if bent and a in stack]
            if any(a < x[k] < b for a, b in arcs for x in level):
                return False
            if any(a < c < b < d for a, b in arcs for c, d in arcs):
                return False
    return True


SHEETS = {
    "strip": (strip(3, 2, 2, 1), "UUU"),
    "flat fold": (strip(2, 3, 1, 2, 2), "UFUU"),
    "flat folds": (strip(2, 3, 3, 1, 1, 3), "FUFUF"),
    "flat along folded": (strip(1, 1, 2, 2), "FUU"),
    "letters": (strip(4, 1, 2, 1), "MUV"),
    "grid": (grid((0, 2, 5), (0, 1, 3)), "UUUU"),
    "flat row": (grid((0, 2, 3), (0, 1, 2)), "FUUF"),
    "vertex": (
        PanelPattern(
            [(0, 0), (4, 0), (4, 4), (0, 4), (-4, 4), (-4, 0), (-4, -4), (4, -4)],
            [
                (1, 2),
                (2, 3),
                (3, 4),
                (4, 5),
                (5, 6),
                (6, 7),
                (1, 7),
                (0, 2),
                (0, 3),
                (0, 4),
                (0, 5),
                (0, 7),
                (0, 1),
            ],
        ),
        "UUFFUU",
    ),
}


@pytest.mark.parametrize("name", SHEETS)
def test_the_states_are_those_of_the_definition(name: str) -> None:
    sheet, letters = SHEETS[name]
    overlaps = overlaps_of(sheet, letters)
    by_fold = dict(zip(sheet.folds, letters, strict=True))
    cuts = list(sections(sheet, by_fold))
    pairs = sorted(
        {
            (p, q)
            for left, right, _ in cuts
            for side in (left, right)
            for p in side
            for q in side
            if p < q
        }
    )
    assert overlaps.pairs == pairs
    wanted = {fold: letter for fold, letter in by_fold.items() if letter in ("M", "V")}
    _, over = images(sheet, by_fold)
    states = 0
    for lower in product(*((pair, pair[::-1]) for pair in pairs)):
        fits = all(
            ((one, other) in lower) == ((letter == "V") != over[one])
            for (i, j), letter in wanted.items()
            for one, other in [(sheet.sides[i, j], sheet.sides[j, i])]
        )
        expected = fits and is_state({*lower}, cuts)
        assert accepted(overlaps, lower) == expected
        states += expected
    assert states > 0


def orders_of(overlaps: Overlaps) -> Iterator[tuple[Order, ...]]:
    """All orders of layers that lie on top of each other, all in one place."""
    count = len(overlaps.pieces)
    assert len(overlaps.pairs) == count * (count - 1) // 2
    for height in permutations(range(count)):
        yield tuple((a, b) if height[a] < height[b] else (b, a) for a, b in overlaps.pairs)


@pytest.mark.parametrize(("number", "states"), [*enumerate(STAMPS, 1)])
def test_stamps_have_the_published_number_of_states(number: int, states: int) -> None:
    overlaps = overlaps_of(strip(*[1] * number), "U" * (number - 1))
    assert sum(accepted(overlaps, lower) for lower in orders_of(overlaps)) == states


@pytest.mark.parametrize(("columns", "states"), [(1, 2), (2, 8), (3, 60)])  # A001415
def test_maps_have_the_published_number_of_states(columns: int, states: int) -> None:
    sheet = grid(range(columns + 1), range(3))
    overlaps = overlaps_of(sheet, "U" * len(sheet.folds))
    assert sum(accepted(overlaps, lower) for lower in orders_of(overlaps)) == states


@pytest.mark.slow
def test_larger_maps_have_the_published_number_of_states() -> None:
    for sheet, states in ((strip(*[1] * 7), 462), (grid(range(5), range(3)), 320)):
        overlaps = overlaps_of(sheet, "U" * len(sheet.folds))
        assert sum(accepted(overlaps, lower) for lower in orders_of(overlaps)) == states


# --- layers at one place -------------------------------------------------------------------------

LEFT, RIGHT = Strand((0, 1), ()), Strand((), (0, 1))


@pytest.mark.parametrize(
    ("strands", "orders"),
    [
        ([Strand((0,), (0,)), Strand((1,), (1,))], 2),  # two pieces
        ([LEFT, Strand((2,), (2,))], 4),  # a piece is not between: 3! - 2
        ([LEFT, Strand((2,), (3,))], 4),  # nor a flat fold
        ([LEFT, Strand((2,), ())], 6),  # the border of a piece may be
        ([LEFT, Strand((2, 3), ())], 16),  # two folded folds: 4! - 8
        ([LEFT, Strand((), (2, 3))], 4),  # on two sides
        ([Strand((0,), (1,)), Strand((2,), (3,))], 2),  # two flat folds
        ([Strand((0,), (1,)), Strand((2,), (2,))], 2),
        ([Strand((0,), ()), Strand((1,), ()), Strand((2,), (2,))], 6),
    ],
)
def test_orders_of_layers_that_do_not_cross(strands: list[Strand], orders: int) -> None:
    assert len(list(uncrossed(strands))) == orders


def test_clauses_at_a_place() -> None:
    tacos = [LEFT, Strand((2, 3), ())]
    assert holds(tacos, ((2, 0), (1, 2), (3, 1)))
    assert holds(tacos, ((0, 2), (3, 0), (1, 3)))
    assert not holds(tacos, ((2, 0), (1, 2)))
    assert not holds(tacos, ())
    assert holds([LEFT, Strand((2,), (2,))], ((0, 2), (2, 1)))
    assert not holds([LEFT, Strand((2,), ())], ((0, 2), (2, 1)))
    flat = [Strand((0,), (1,)), Strand((2,), (3,))]
    assert holds(flat, ((0, 2), (3, 1)))
    assert not holds(flat, ((0, 2), (1, 3)))


def test_the_sheet_in_pieces_is_folded_as_the_sheet() -> None:
    """A panel that is not convex, in two pieces, covers the same as the panel."""
    sheet, _ = read_panels(panels_document(roofs()))
    pieces = [(0, 1, 3, 4), (1, 2, 3), (0, 6, 5, 1), (5, 6, 8, 7)]
    folded = FoldedSheet(sheet, dict.fromkeys(sheet.folds, "U"), pieces)
    assert folded.folds == [(0, 1), (1, 3), (5, 6)]
    assert folded.letters == {(0, 1): "U", (1, 3): "F", (5, 6): "U"}
    assert folded.up == [True, True, False, True]
