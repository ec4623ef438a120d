"""Self-folding of rigid panels: tilings of random quadrilaterals, and the verdicts on their ways.

Hull and Tachi (arXiv 1809.04243) prove that tilings by a generic quadrilateral and its half-turns
are self-foldable, and that the Miura fold and the "chicken wire" of trapezoids are not. A row is
one sheet cut from such a tiling, and all its ways (docs/actuation.md, 8).
"""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal
from fractions import Fraction
from itertools import product
from typing import Any, Final

import numpy as np

from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.design.actuation.panels.actuate import actuate_panels
from exactfold.design.actuation.panels.motions import WayMotions
from exactfold.design.actuation.panels.self_folding import decide_self_folding
from exactfold.errors import UsageError
from exactfold.panels.decomposition import decompose
from exactfold.pattern.panel_pattern import PanelPattern, Point
from exactfold.studies.running.study import Recipe, Row, Study, StudyFigure, StudyTable, of_size
from exactfold.studies.running.tallies import draw_distribution, tallied

GENERIC: Final = "generic"
_KINDS: Final = (*(GENERIC,) * 4, "Miura", *(GENERIC,) * 4, "chicken wire")
"""The kinds of tilings, in turns."""

_DENOMINATOR: Final = 64
_REACH: Final = 20
"""Corners of a tile are at most so many 64ths from those of a square, in each direction."""
_MOST: Final = 10_000_000
_MARGINS: Final = 2
"""Best margins are computed for so many isolated ways of each sheet."""
_DOWN = Context(prec=5, rounding=ROUND_FLOOR)
_UP = Context(prec=2, rounding=ROUND_CEILING)


def recipes(seed: int, numbers: Mapping[int, int]) -> Iterator[Recipe]:
    """Yields sheets with n x n interior vertices: of ten, eight of generic tiles.

    >>> [(r["seed"], r["kind"]) for r in recipes(0, {2: 10})][3:5]
    [(20000003, 'generic'), (20000004, 'Miura')]
    """
    for size, number in numbers.items():
        if not 0 < size < 100:
            raise UsageError(f"sheets have from 1 x 1 to 99 x 99 vertices, not {size} x {size}")
        if not 0 <= number <= _MOST:
            raise UsageError(f"a study has up to 10^7 sheets of a size, not {number}")
        for k in range(number):
            first = (100 * seed + size) * _MOST
            yield {"size": size, "seed": first + k, "kind": _KINDS[k % len(_KINDS)]}


def sheet_of(recipe: Recipe) -> PanelPattern:
    """The sheet of a recipe; it is the same on every machine."""
    rng = random.Random(int(recipe["seed"]))
    size = int(recipe["size"]) + 1
    if recipe["kind"] == GENERIC:
        tile = _tile(rng)
        return _sheet(size, lambda i, j: _turned(tile, i, j))
    shift = Fraction(rng.randint(4, 28), _DENOMINATOR)
    height = Fraction(rng.randint(32, 128), _DENOMINATOR)
    mirrored = recipe["kind"] != "Miura"

    def place(i: int, j: int) -> Point:
        sign = -1 if mirrored and i % 2 else 1
        return i + sign * shift * (j % 2), height * j

    return _sheet(size, place)


def _tile(rng: random.Random) -> list[Point]:
    """The corners of a convex quadrilateral without parallel sides, counter-clockwise."""
    while True:
        tile: list[Point] = [
            (x + _moved(rng), y + _moved(rng)) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))
        ]
        sides = [(tile[k - 3][0] - tile[k][0], tile[k - 3][1] - tile[k][1]) for k in range(4)]
        turns = [_cross(sides[k - 1], sides[k]) for k in range(4)]
        opposite = [_cross(sides[k], sides[k + 2]) for k in range(2)]
        if min(turns) > 0 and all(opposite):
            return tile


def _moved(rng: random.Random) -> Fraction:
    return Fraction(rng.randint(-_REACH, _REACH), _DENOMINATOR)


def _cross(one: Point, other: Point) -> Any:
    return one[0] * other[1] - one[1] * other[0]


def _turned(tile: Sequence[Point], i: int, j: int) -> Point:
    """The vertex (i, j) of the tiling by a tile and its half-turns about the middles of sides."""
    a, b, c, d = tile
    along = [b[k] - a[k] + c[k] - d[k] for k in (0, 1)]
    up = [d[k] - a[k] + c[k] - b[k] for k in (0, 1)]
    corner = ((a, d), (b, c))[i % 2][j % 2]
    x, y = (corner[k] + i // 2 * along[k] + j // 2 * up[k] for k in (0, 1))
    return x, y


def _sheet(size: int, place: Any) -> PanelPattern:
    """A sheet of `size` x `size` panels."""
    number = {(i, j): i * (size + 1) + j for i, j in product(range(size + 1), repeat=2)}
    edges = [(k, number[i + 1, j]) for (i, j), k in number.items() if i < size]
    edges += [(k, number[i, j + 1]) for (i, j), k in number.items() if j < size]
    return PanelPattern([place(i, j) for i, j in number], edges)


def row(recipe: Recipe) -> dict[str, Any]:
    """Which ways of one sheet are self-foldable, and the best margins of its first isolated ways.

    `verdicts` has entries [dimension, verdict, ways]. `margins` are proved lower bounds of the
    margins of the torques found, rounded down to five digits, and `gap` is the largest difference
    between a proved upper bound of all margins and such a margin, rounded up to two.
    """
    result = decompose(sheet_of(recipe))
    motions = WayMotions.of(result)
    values: dict[str, Any] = {"status": str(UNDECIDED), "verdicts": None, "margins": None}
    values["gap"] = None
    counts = Counter(
        (way.dimension, str(decide_self_folding(motions, way)[0])) for way in motions.ways
    )
    first = [way.number for way in motions.ways if way.dimension == 1][:_MARGINS]
    found = [actuate_panels(result, number) for number in first]
    if any(verdict == str(UNDECIDED) for _, verdict in counts):
        return values
    if any(one.status is not PROVED for one in found):
        return values
    gap = max((one.bound - one.margin[0] for one in found), default=Fraction(0))
    return {
        "status": str(PROVED),
        "verdicts": [[*key, number] for key, number in sorted(counts.items())],
        "margins": [_rounded(one.margin[0], _DOWN) for one in found],
        "gap": _rounded(gap, _UP),
    }


def _rounded(number: Fraction, context: Context) -> float:
    return float(context.divide(Decimal(number.numerator), Decimal(number.denominator)))


@dataclass
class _Tally:
    """The sums over the sheets of one kind and size."""

    sheets: int = 0
    undecided: int = 0
    ways: Counter[tuple[bool, str]] = field(default_factory=Counter)
    margins: list[float] = field(default_factory=list)
    gap: float = 0.0

    def add(self, row: Row) -> None:
        """Adds a row."""
        self.sheets += 1
        if row["status"] != str(PROVED):
            self.undecided += 1
            return
        for dimension, verdict, number in row["verdicts"]:
            self.ways[dimension > 1, verdict] += number
        self.margins += row["margins"]
        self.gap = max(self.gap, row["gap"])


_ORDER: Final = (GENERIC, "Miura", "chicken wire")


def _tallied(rows: Iterable[Row]) -> dict[tuple[int, int], _Tally]:
    return tallied(rows, _Tally, lambda row: (_ORDER.index(row["kind"]), int(row["size"])))


def tables(rows: Iterable[Row]) -> list[StudyTable]:
    """The verdicts on isolated ways and on families, and the best margins of isolated ways."""
    tallies = _tallied(rows)
    verdicts = tuple(
        (
            _ORDER[kind],
            f"{size} x {size}",
            t.sheets,
            t.sheets - t.undecided,
            *(t.ways[family, v] for family in (False, True) for v in ("proved", "refuted")),
        )
        for (kind, size), t in tallies.items()
    )
    margins = tuple(
        (
            _ORDER[kind],
            f"{size} x {size}",
            len(t.margins),
            *(f"{x:.3g}" for x in np.quantile(t.margins, [0, 0.25, 0.5, 0.75, 1]).tolist()),
            f"{t.gap:.1e}",
        )
        for (kind, size), t in tallies.items()
        if t.margins
    )
    return [
        StudyTable(
            "verdicts",
            "Ways of tilings that torques can drive alone",
            (
                "tiling",
                "vertices",
                "sheets",
                "decided",
                "self-foldable",
                "not",
                "families",
                "not",
            ),
            verdicts,
            (
                "self-foldable, not: isolated ways; families, not: families of ways that are "
                "self-foldable, and that are not.",
            ),
        ),
        StudyTable(
            "margins",
            "Best margins of isolated ways over all other ways",
            (
                "tiling",
                "vertices",
                "ways",
                "least",
                "quartile",
                "median",
                "quartile",
                "largest",
                "gap",
            ),
            margins,
            (
                f"The first {_MARGINS} isolated ways of each sheet. Torques of size at most 1 on "
                "all folds; proved lower bounds; no torques do better by more than the gap.",
            ),
        ),
    ]


def figures(rows: Iterable[Row]) -> Sequence[StudyFigure]:
    """The distributions of the best margins of generic tilings."""
    tallies = {size: t for (kind, size), t in _tallied(rows).items() if not kind and t.margins}

    def margins(axes: Any) -> None:
        for size, tally in tallies.items():
            label = f"{size} x {size} vertices"
            draw_distribution(axes, tally.margins, label=label, **of_size(size))
        axes.set_xlabel("best margin, torques of size at most 1")
        axes.set_ylabel("ways with a smaller margin (%)")
        axes.set_ylim(0, 100)
        axes.legend(loc="lower right")

    return [
        StudyFigure(
            "margins",
            "Best margins of generic tilings",
            "The share of ways of sheets of generic tiles whose best margin is smaller.",
            margins,
        )
    ]


STUDY: Final = Study(
    "selffold-panels",
    "Self-folding of rigid panels: tilings by quadrilaterals",
    1,
    {2: 500, 3: 450, 4: 300},
    {5: 50, 6: 20},
    recipes,
    row,
    tables,
    figures,
)
