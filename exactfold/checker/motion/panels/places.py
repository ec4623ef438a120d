"""The positions of the vertices while a sheet of panels folds: polynomials with proved errors.

The panels are placed one after the other. Each panel is turned about the fold to the panel before
it. Let R and S be rotations, and |R - P| <= e <= 1 and |S - Q| <= f in the spectral norm. Then
|R S - P Q| <= e + f + e f <= e + 2 f, because R S - P Q = (R - P) S + P (S - Q), |S| = 1 and
|P| <= 1 + e. So the error of a product of many rotations grows like the sum of the errors.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from functools import cmp_to_key, partial
from itertools import pairwise
from math import floor
from operator import itemgetter

from ...core.intervals import Interval
from ...core.reading import require
from ...sheets.panels import Edge, PanelSheet, pair
from ..lengths import GRID
from .cut import panels_of
from .drive import DrivenModes, length
from .series import BITS, DEGREE, ONE, Polynomial, Series, polynomial, scaled, thin, times
from .times import Clock

_SHIFT = BITS - GRID
_THIN = 1 << GRID - 20
_WIDEST = Fraction(1, 16)
_NARROWEST = Fraction(1, 1 << 40)
_STILL: Polynomial = [0] * (DEGREE + 1)
_UNIT: Polynomial = [ONE, *_STILL[1:]]
_TRIES = 4
_ROUNDED = DEGREE + 1  # the largest error of one rounded product with a number
Row = tuple[Polynomial, Polynomial, Polynomial]
Carried = tuple[int, tuple[Interval, Interval, Interval]]
"""A panel, and a point that it carries, where it is in the flat sheet."""


class Piece:
    """Positions for `low` <= x <= `high`: a `boxes.Curved` with 3 coordinates for each vertex."""

    degree = DEGREE

    def __init__(
        self, low: Fraction, high: Fraction, columns: list[Polynomial], errors: list[int]
    ) -> None:
        self.low, self.high, self.columns, self.errors = low, high, columns, errors

    def below(self, s: Fraction) -> int:
        """A parameter mapped to the interval from -1 to 1, over 2^GRID, rounded down."""
        return floor((2 * s - self.low - self.high) / (self.high - self.low) * (1 << GRID))

    def above(self, s: Fraction) -> int:
        """A parameter mapped to the interval from -1 to 1, over 2^GRID, rounded up."""
        return -floor(-(2 * s - self.low - self.high) / (self.high - self.low) * (1 << GRID))


class Places:
    """The positions of the vertices of a `scaled` sheet; a panel in its middle is held.

    So errors grow over half of the sheet only, and panels that fold onto the held panel are not
    turned along with it. `steps` has the other panels in the order in which they are placed, and
    `owner` the first panel of each vertex. If points are given that panels carry, their positions
    take the place of those of the vertices.
    """

    def __init__(
        self, drive: DrivenModes, clock: Clock, carried: Sequence[Carried] | None = None
    ) -> None:
        self.drive, self.clock, sheet = drive, clock, drive.sheet
        ends = [[thin(c) for c in point] for point in sheet.points]
        self._flat = [[(c.low + c.high) >> 1 for c in point] for point in ends]
        self._blur = 1 + max(c.high - c.low for point in ends for c in point)
        self.held = _middle(sheet)
        self.steps = list(_order(sheet, self.held))
        self.owner: dict[int, int] = {}
        for panel in (self.held, *(after for after, *_ in self.steps)):
            for v in sheet.panels[panel]:
                self.owner.setdefault(v, panel)
        if carried is None:
            zero = Interval(0, 0, BITS)
            carried = [(self.owner[v], (x, y, zero)) for v, (x, y) in enumerate(ends)]
        self.carried = carried
        widest = max(c.high - c.low for _, point in carried for c in point)
        self._blur = max(self._blur, 1 + widest)
        farthest = max(sum(max(-c.low, c.high) for c in point) for _, point in carried)
        self._reach = 1 + (farthest >> BITS)
        self._axes: dict[Edge, tuple[int, int, int]] = {}
        for _, _, i, j in self.steps:
            if pair(i, j) in drive.active:
                size = length(sheet, i, j)
                x, y = (thin(c) / size for c in sheet.vector(i, j))
                off = x.high - x.low + y.high - y.low + 2
                self._axes[i, j] = (x.low + x.high) >> 1, (y.low + y.high) >> 1, off

    @property
    def work(self) -> int:
        """The work of computing one piece, in tests of two faces."""
        return 64 * len(self.steps)

    @property
    def bodies(self) -> list[int]:
        """A number for each panel; panels that are joined by flat folds have the same number."""
        sheet, numbers = self.drive.sheet, list(range(len(self.drive.sheet.panels)))
        sides = panels_of(sheet)
        for i, j in sheet.folds:
            if (i, j) not in self.drive.active:
                one, two = numbers[sides[i, j]], numbers[sides[j, i]]
                numbers = [one if body == two else body for body in numbers]
        return numbers

    def each(self, first: Fraction, last: Fraction, said: Callable[[Piece | None], str]) -> None:
        """Raise unless `said` accepts pieces that reach from the parameter `first` to `last`.

        `said` gets a piece, or None where the positions are not known well enough. It returns "" to
        accept, or names what may touch. Then the piece is halved and both halves are tried, down to
        a smallest width.
        """
        count = int((last - first) / _WIDEST) + 1
        ends = [first + (last - first) * k / count for k in range(count + 1)]
        stack = list(pairwise(ends))[::-1] if first < last else []
        while stack:
            low, high = stack.pop()
            what = said(self.piece(low, high))
            if what and high - low > _NARROWEST:
                middle = (low + high) / 2
                stack += [(middle, high), (low, middle)]
            else:
                require(not what, f"{what} may touch where the motion is claimed to be clear")

    def piece(self, low: Fraction, high: Fraction) -> Piece | None:
        """The positions for low <= x <= high; None if they are not known well enough."""
        half = Interval.of((high - low) / 2, BITS)
        try:
            there = self._turns(Interval.of((low + high) / 2, BITS))
            around = self._turns(
                Interval(Interval.of(low, BITS).low, Interval.of(high, BITS).high, BITS)
            )
        except ZeroDivisionError:
            return None
        turns = {
            fold: [polynomial(f, g, half) for f, g in zip(there[fold], around[fold], strict=True)]
            for fold in there
        }
        columns, most = self._placed(turns)
        error = (most >> _SHIFT) + 1 + _ROUNDED
        if error > _THIN:
            return None
        return Piece(low, high, columns, [error] * len(columns))

    def _turns(self, x: Interval) -> dict[Edge, tuple[Series, Series]]:
        """For each fold the sine and 1 - cosine of its angle, as series about x."""
        one = Interval(ONE, ONE, BITS)
        series = {}
        known: dict[tuple[int, ...], tuple[Series, Series]] = {}
        driven = partial(self.clock.driven, x)
        for fold, (c, s) in self.drive.tangents(driven).items():
            key = (*c.ends, *s.ends)
            if key not in known:
                square = s * s
                over = Series([one + one]) / (c * c + square)
                known[key] = c * s * over, square * over
            series[fold] = known[key]
        return series

    def _placed(
        self, turns: dict[Edge, list[tuple[Polynomial, int]]]
    ) -> tuple[list[Polynomial], int]:
        """The coordinates of all vertices over 2^GRID, and a bound of their errors over 2^BITS."""
        rows = [(_UNIT, _STILL, _STILL), (_STILL, _UNIT, _STILL), (_STILL, _STILL, _UNIT)]
        # For each panel: its rotation and a bound of the error, its shift and a bound of the error.
        placed: dict[int, tuple[list[Row], int, list[Polynomial], int]] = {
            self.held: (rows, 0, [_STILL] * 3, 0)
        }
        for panel, before, i, j in self.steps:
            if (i, j) not in self._axes:
                placed[panel] = placed[before]
                continue
            rows, off, shift, missed = placed[before]
            axis = self._axes[i, j]
            (sine, sine_off), (versine, versine_off) = turns[pair(i, j)]
            new, rounded = _turned(rows, sine, versine, axis)
            spin_off = 2 * sine_off + 4 * versine_off + 16 * axis[2]
            new_off = off + 2 * spin_off + rounded
            x, y = self._flat[i]
            moved = []
            for old, fresh, s in zip(rows, new, shift, strict=True):
                a, b = ([p - q for p, q in zip(old[k], fresh[k], strict=True)] for k in (0, 1))
                terms = zip(s, scaled(a, x), scaled(b, y), strict=True)
                moved.append([p + q + r for p, q, r in terms])
            missed += 2 * (off + new_off) + 4 * self._blur + 6 * _ROUNDED
            placed[panel] = new, new_off, moved, missed
        if max(off for _, off, _, _ in placed.values()) > ONE:
            return [], 1 << 2 * BITS
        columns, most = [], 0
        for panel, point in self.carried:
            rows, off, shift, missed = placed[panel]
            most = max(most, missed + self._reach * off + 3 * self._blur + 6 * _ROUNDED)
            x, y, z = ((c.low + c.high) >> 1 for c in point)
            for row, s in zip(rows, shift, strict=True):
                terms = zip(s, scaled(row[0], x), scaled(row[1], y), strict=True)
                column = [p + q + r for p, q, r in terms]
                if z:
                    column = [p + q for p, q in zip(column, scaled(row[2], z), strict=True)]
                columns.append([p >> _SHIFT for p in column])
        return columns, most


def _middle(sheet: PanelSheet) -> int:
    """The panel to hold: the largest of those from which no other panel is many folds away.

    The distances are measured from a few panels only.
    """
    most = [0] * len(sheet.panels)
    for _ in range(_TRIES):
        last = max(enumerate(_depths(sheet, most.index(min(most)))), key=itemgetter(1))[0]
        most = list(map(max, most, _depths(sheet, last)))
    near = [k for k, depth in enumerate(most) if depth <= min(most) + 1]
    areas = {k: sheet.area(sheet.panels[k]) for k in near}

    def larger(i: int, j: int) -> int:
        return (areas[i] - areas[j]).sign()

    return max(near, key=cmp_to_key(larger))


def _depths(sheet: PanelSheet, held: int) -> list[int]:
    depths = [0] * len(sheet.panels)
    for after, before, _, _ in _order(sheet, held):
        depths[after] = depths[before] + 1
    return depths


def _order(sheet: PanelSheet, held: int) -> Iterator[tuple[int, int, int, int]]:
    """Yield the panels in the order in which they are placed, except the held one.

    Each comes with the panel before it, and with i and j: it lies to the left of the fold i to j
    between the two.
    """
    sides = panels_of(sheet)
    seen, waiting = {held}, [held]
    for before in waiting:
        panel = sheet.panels[before]
        for i, j in zip(panel, (*panel[1:], panel[0]), strict=True):
            after = sides.get((j, i))
            if after is not None and after not in seen:
                seen.add(after)
                waiting.append(after)
                yield after, before, j, i


def _turned(
    rows: list[Row], sine: Polynomial, versine: Polynomial, axis: tuple[int, int, int]
) -> tuple[list[Row], int]:
    """The rows times the rotation about an axis (x, y, 0), and a bound of the rounding errors.

    `versine` is 1 - cosine. A row (a, b, c) becomes (a - y q, b + x q, c + z), where
    w = y a - x b, q = c sine + w versine and z = w sine - c versine.
    """
    x, y, _ = axis
    turned, off = [], 0
    for a, b, c in rows:
        w = [p - q for p, q in zip(scaled(a, y), scaled(b, x), strict=True)]
        (cs, e), (wv, f), (ws, g), (cv, h) = (
            times(c, sine),
            times(w, versine),
            times(w, sine),
            times(c, versine),
        )
        q = [r + s for r, s in zip(cs, wv, strict=True)]
        turned.append(
            (
                [r - s for r, s in zip(a, scaled(q, y), strict=True)],
                [r + s for r, s in zip(b, scaled(q, x), strict=True)],
                [p + r - s for p, r, s in zip(c, ws, cv, strict=True)],
            )
        )
        # The error of w is less than 2 _ROUNDED, and sine and versine are at most 2 in size.
        off += 2 * (e + f) + g + h + 16 * _ROUNDED
    return turned, off
