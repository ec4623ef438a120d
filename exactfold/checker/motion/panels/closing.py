"""The last stretch before all folds of a motion of panels close together (docs/motion.md, 21).

Let tan(angle / 2) = g / s for each fold that moves, where s tends to 0. The levelled positions
(x, y, z / s) are analytic in S = s^2 >= 0. With D = S + g^2, a rotation about a unit axis (x, y) is

    1 + (2 g S / D) (0 0 y; 0 0 -x; 0 0 0) + (2 g / D) (0 0 0; 0 0 0; -y x 0)
      + (2 g^2 / D) (-y^2 xy 0; xy -x^2 0; 0 0 -1)

in these coordinates, as the quaternion s + g (x, y, 0) shows. They are linear in those of space, so
that panels touch in both or in neither. Planes part the levelled panels for 0 <= S <= S_0.

Panels may meet at S = 0, but not before: vertical planes part these (`turning`).
"""

from __future__ import annotations

from copy import copy
from fractions import Fraction

from ...core.intervals import Interval
from ...core.reading import items, natural, require
from ...sheets.panels import Edge, Vector, pair
from ..claims import Document
from ..faces import FacePairs
from ..lengths import GRID
from .drive import length
from .folding import Folding, PanelClaim
from .places import Piece, Places
from .series import BITS, DEGREE, ONE, Polynomial, Series, polynomial, thin
from .turning import Place, gap_signs, normals, turned

_SHIFT = BITS - GRID
_THIN = 1 << GRID - 20
_ROUNDED = DEGREE + 1
_NARROWEST = 1 << GRID - 10
_SHORTEST = Fraction(1, 1 << 40)
_POINT = Interval(ONE, ONE, BITS)
_NIL = Interval(0, 0, BITS)


class Closed(PanelClaim):
    """The folds of `closed` are all that move, and all of them close at the time pi.

    From the time `clear` until then no two panels touch beyond what they share.
    """

    names = ("closed",)
    always = True

    def check(self, folding: Folding) -> None:
        """Refuse a motion unless all folds close together and planes part its panels until then."""
        folds = [
            tuple(natural(v, "vertex") for v in items(fold, "fold", 2))
            for fold in items(self.claims["closed"], "closed")
        ]
        drive = folding.drive
        require(folds == sorted(drive.active), "the folds that close are not those that move")
        together = all(mode.linear for mode in drive.modes)
        require(together, "the folds are not proved to close together")
        x = folding.parameter(self.evidence["clear"])
        stretch = LastStretch(folding)
        stretch.check(((1 - x) / x) ** 2)

    @staticmethod
    def said(claims: Document) -> str:
        """That no panels touch later on, if the file says so."""
        return ", nor later, until all folds that move are closed" if "closed" in claims else ""


class LastStretch:
    """The levelled positions of a motion whose folds close together, and what parts its panels."""

    def __init__(self, folding: Folding) -> None:
        self.places: Places = folding.places
        self.panels: FacePairs = folding.panels
        self.sheet = folding.drive.sheet
        both = Series([_POINT])
        pairs = folding.drive.tangents(lambda driver: (both, both))
        self.gains = {fold: s.coefficients[0] / c.coefficients[0] for fold, (c, s) in pairs.items()}
        self._axes: dict[Edge, tuple[Interval, Interval]] = {}
        for _, _, i, j in self.places.steps:
            if pair(i, j) in self.gains:
                size = length(self.sheet, i, j)
                dx, dy = self.sheet.vector(i, j)
                self._axes[i, j] = thin(dx) / size, thin(dy) / size
        self._flat = [(thin(x), thin(y)) for x, y in self.sheet.points]

    def check(self, last: Fraction) -> None:
        """Raise unless no two panels touch for 0 < S <= last."""
        panels, piece, end = self.panels, None, last
        while piece is None:
            piece = self.piece(Fraction(0), end)
            end /= 2
            require(
                end > _SHORTEST, "the positions near the closed state are not known well enough"
            )
        there = panels.at(piece, Fraction(0), Fraction(0))
        meeting = copy(panels)
        meeting.apart, meeting.corner = panels.not_parted(there)
        others = copy(panels)
        others.apart = [row for row in panels.apart if row not in set(meeting.apart)]
        others.corner = [row for row in panels.corner if row not in set(meeting.corner)]
        what = self._touching(others, Fraction(0), last)
        if not what and (meeting.apart or meeting.corner):
            what = self._touching(meeting, self._meeting(meeting, last), last)
        require(not what, f"{what} may touch before the folds close")

    def _touching(self, panels: FacePairs, first: Fraction, last: Fraction) -> str:
        """Names of panels that planes are not found to part for first <= S <= last; "" if none."""
        stack = [(first, last)] if first < last else []
        while stack:
            low, high = stack.pop()
            panels.spend(self.places.work)
            piece = self.piece(low, high)
            what = "the panels"
            if piece is not None:
                what = panels.may_touch(piece, -1 << GRID, 1 << GRID, _NARROWEST)
            if what and high - low <= _SHORTEST:
                return what
            if what:
                middle = (low + high) / 2
                stack += [(middle, high), (low, middle)]
        return ""

    # --- panels that meet in the end -------------------------------------------------------------

    def _meeting(self, panels: FacePairs, last: Fraction) -> Fraction:
        """An S until which panels that meet at S = 0 do not touch for S > 0; 0 if none is known."""
        series = self.series(_NIL), self.series(Interval.of(last, BITS).joined(_NIL))
        images = self.images()
        for i, j in (*panels.apart, *panels.corner):
            panels.spend(self.places.work)
            one, two = panels.faces[i], panels.faces[j]
            shared = set(one) & set(two)
            both = [(a, b) for a in one for b in two]
            for v in shared:
                both = [(a, v) for a in one if a != v] + [(v, b) for b in two if b != v]
            until = (
                turned(series, normal, gaps, both, last)
                for normal in normals(images, one, two)
                if min(gaps := gap_signs(images, normal, both)) >= 0
            )
            last = next(filter(None, until), Fraction(0))
            if not last:
                break
        return last

    def images(self) -> list[Vector]:
        """The images of all vertices when all folds that move are closed."""
        sheet = self.sheet
        one, zero = sheet.tower.number(1), sheet.tower.number(0)
        maps = {self.places.held: ((one, zero), (zero, one), (zero, zero))}
        for panel, before, i, j in self.places.steps:
            maps[panel] = maps[before]
            if pair(i, j) not in self.gains:
                continue
            rows, shift = maps[before][:2], maps[before][2]
            x, y = sheet.vector(i, j)
            square = x * x + y * y
            c, s = (x * x - y * y) / square, (x * y + x * y) / square
            new = [(a * c + b * s, a * s - b * c) for a, b in rows]
            px, py = sheet.points[i]
            moved = [
                t + (a - d) * px + (b - e) * py
                for (a, b), (d, e), t in zip(rows, new, shift, strict=True)
            ]
            maps[panel] = new[0], new[1], (moved[0], moved[1])
        images = []
        for v, (x, y) in enumerate(sheet.points):
            first, second, shift = maps[self.places.owner[v]]
            images.append(
                (first[0] * x + first[1] * y + shift[0], second[0] * x + second[1] * y + shift[1])
            )
        return images

    # --- positions -------------------------------------------------------------------------------

    def piece(self, low: Fraction, high: Fraction) -> Piece | None:
        """The levelled positions for low <= S <= high; None if they are not known well enough.

        Heights are divided by a power of 2.
        """
        ends = Interval.of(low, BITS).joined(Interval.of(high, BITS))
        half = Interval.of((high - low) / 2, BITS)
        there, around = self.series(Interval.of((low + high) / 2, BITS)), self.series(ends)
        found = [
            [polynomial(f, g, half) for f, g in zip(*both, strict=True)]
            for both in zip(there, around, strict=True)
        ]
        highest = max(sum(map(abs, z)) + error for _, _, (z, error) in found)
        lower = max(highest.bit_length() - BITS, 0)
        columns: list[Polynomial] = []
        errors: list[int] = []
        for place in found:
            for axis, (row, error) in enumerate(place):
                shift = _SHIFT + (lower if axis == 2 else 0)
                columns.append([c >> shift for c in row])
                errors.append((error >> shift) + 1 + _ROUNDED)
        return None if max(errors) > _THIN else Piece(low, high, columns, errors)

    def series(self, square: Interval) -> list[Place]:
        """The levelled positions of all vertices as series about S."""
        about = Series([square, _POINT])
        turns = {}
        for fold, g in self.gains.items():
            below = Series([g + g]) / (about + Series([g * g]))
            turns[fold] = below, below * about, below.times(g)
        nil, one = Series([]), Series([_POINT])
        still = [(one, nil, nil, nil), (nil, one, nil, nil), (nil, nil, one, nil)]
        placed = {self.places.held: still}
        for panel, before, i, j in self.places.steps:
            placed[panel] = placed[before]
            if pair(i, j) not in self.gains:
                continue
            below, above, versine = turns[pair(i, j)]
            x, y = self._axes[i, j]
            px, py = self._flat[i]
            off = y * px - x * py
            rows = []
            for a, b, c, origin in placed[before]:
                across = a.times(y) - b.times(x)
                lifted = below * c + versine * across
                rows.append(
                    (
                        a - lifted.times(y),
                        b + lifted.times(x),
                        c - versine * c + above * across,
                        origin + lifted.times(off),
                    )
                )
            placed[panel] = rows
        places = []
        for v, (x, y) in enumerate(self._flat):
            rows = placed[self.places.owner[v]]
            first, second, third = (a.times(x) + b.times(y) + t for a, b, _, t in rows)
            places.append((first, second, third))
        return places
