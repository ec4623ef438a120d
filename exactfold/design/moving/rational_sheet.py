"""An exact sheet near the places and slopes that floats propose.

All equations are solved in rational numbers, one kind after the other, as each is linear in some of
the unknowns (docs/tolerance.md, 5). What is rounded first is short; what is solved for is as long
as it has to be.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.design.moving.places import Column
from exactfold.design.moving.slopes import Equations
from exactfold.design.moving.vectors import (
    Row,
    Vector,
    area,
    both,
    combined,
    cross,
    difference,
    dot,
    minus,
    mixed,
    solution,
)
from exactfold.errors import FoldError, PatternError
from exactfold.exact.linalg import nullspace
from exactfold.pattern.panel_pattern import PanelPattern

_SMALL = 1e-7
"""Singular values below this share of the largest count as 0."""
_OFF = 0.05
"""An exact sheet is this close to what floats propose, as a share of the box."""
_LONGEST = 2000
"""Slopes with more bits are given up: in a mesh of many loops each is several times as long as
those before."""
_ORDERS = 12
"""So many choices of the slopes that are solved for are tried."""


def rational_sheets(
    equations: Equations, x: FloatArray, several: Sequence[int]
) -> Iterator[tuple[PanelPattern, bool]]:
    """Exact sheets near the solution x, for each number of digits; none where no way leads there.

    If slopes solve the equations on all sheets nearby, places are only rounded. Otherwise a sheet
    has rational slopes that satisfy all equations exactly, and True beside it: this proves that it
    starts to fold with the letters to second order. It has the panels of the given sheet.
    """
    by_slopes = equations.closing(x)[1][:, equations.moves.shape[1] :]
    sizes = np.linalg.svd(by_slopes, compute_uv=False)
    if len(sizes) == len(by_slopes) and sizes[-1] > 1e-4 * sizes[0]:
        for digits in several:
            rounded = nearest_sheet(equations, x, digits)
            if rounded is not None:
                yield rounded, False
    for digits in several:
        made = _Making(equations, x, digits).sheet()
        if made is not None:
            yield made, True


def nearest_sheet(equations: Equations, x: FloatArray, digits: int) -> PanelPattern | None:
    """The sheet with the places of x, rounded; it need not satisfy the equations."""
    places = equations.slopes.places
    shares = [places.unit * _rounded(share, digits) for share in x[: equations.moves.shape[1]]]
    return _as_sheet(equations, x, places.at(shares))


def _rounded(value: float, digits: int) -> Fraction:
    return Fraction(round(value * 10**digits), 10**digits)


def _as_sheet(equations: Equations, x: FloatArray, points: Sequence[Vector]) -> PanelPattern | None:
    """The sheet with these vertices; None if its panels are not those of the given one, or if a
    vertex is far from where floats propose it, or out of its box.
    """
    given = equations.slopes.places.pattern
    unit = float(equations.unit)
    floats = np.array([[float(c) for c in point] for point in points]) / unit
    proposed = equations.places(x[: equations.moves.shape[1]])
    if np.abs(floats - proposed).max() > _OFF * equations.within:
        return None
    pairs = zip(points, given.vertices, strict=True)
    box, moved = equations.box, (d for p, q in pairs for d in (p[0] - q[0], p[1] - q[1]))
    if not all(-box <= d <= box for d in moved):
        return None
    try:
        sheet = PanelPattern(points, given.edges, given.holes)
    except (FoldError, PatternError):
        return None
    return sheet if sheet.faces == given.faces else None


class _Making:
    """The steps to one exact sheet, with so many digits."""

    def __init__(self, equations: Equations, x: FloatArray, digits: int) -> None:
        self.equations, self.digits = equations, digits
        self.slopes, self.places = equations.slopes, equations.slopes.places
        k = equations.moves.shape[1]
        self.p, self.q = x[:k], x[k:]
        self.folds, self.vertices = self._representatives()
        self.maps = [(one, self._panels(one.vertices)) for one in self.places.symmetries]
        self.held = False

    def _representatives(self) -> tuple[list[int], list[int]]:
        """One fold and one vertex of each set of symmetric ones."""
        folds, vertices = [], []
        numbers = {(f.start, f.end): e for e, f in enumerate(self.slopes.folds)}
        maps = [one.vertices for one in self.places.symmetries]
        for (i, j), e in numbers.items():
            images = [(min(m[i], m[j]), max(m[i], m[j])) for m in maps]
            if all(numbers[image] >= e for image in images):
                folds.append(e)
        for v, panels in self.slopes.around.items():
            if len(panels) > 2 and all(m[v] >= v for m in maps):
                vertices.append(v)
        return folds, vertices

    def sheet(self) -> PanelPattern | None:
        """The exact sheet, or None."""
        first = self._placed_first()
        if first is None:
            return None
        early, before, after = first
        self.held = bool(before)
        unit = self.places.unit
        shares = [unit * _rounded(share, self.digits) for share in self.p]
        points = self.places.at([s if k in early else Fraction(0) for k, s in enumerate(shares)])
        slopes = self._slopes(points, before)
        if slopes is None:
            return None
        late = [k for k in range(len(self.p)) if k not in early]
        rows = [self._place_row(e, slopes, points, late) for e in after]
        solved = solution(rows, {k: shares[k] for k in late})
        if solved is None:
            return None
        final = [solved.get(k, shares[k]) for k in range(len(shares))]
        points = self.places.at(final)
        if not self._holds(points, slopes):
            return None
        return _as_sheet(self.equations, np.concatenate([self.p, self.q]), points)

    # --- which places are rounded before the slopes are known ------------------------------------

    def _placed_first(self) -> tuple[set[int], list[int], list[int]] | None:
        """Columns of places that are rounded first, the folds that these leave to the slopes, and
        all other folds, whose equations are independent in the other columns.
        """
        x = np.concatenate([self.p, self.q])
        straight = self.equations.closing(x)[1][: len(self.slopes.folds), : len(self.p)]
        early: set[int] = set()
        while True:
            late = [k for k in range(len(self.p)) if k not in early]
            matrix = straight[np.ix_(self.folds, late)]
            has = [np.abs(row).max(initial=0.0) > 1e-12 for row in matrix]
            before = [e for e, some in zip(self.folds, has, strict=True) if not some]
            after = [e for e, some in zip(self.folds, has, strict=True) if some]
            if not after:
                return early, before, after
            left, sizes, _ = np.linalg.svd(straight[np.ix_(after, late)])
            rank = int((sizes > _SMALL * sizes[0]).sum())
            if rank == len(after):
                return early, before, after
            support = np.abs(left[:, rank:]).max(axis=1) > 1e-6
            more = {
                k
                for e, used in zip(after, support, strict=True)
                if used
                for k in late
                if abs(straight[e, k]) > 1e-12 and not self._slides(k)
            }
            if not more:
                return None
            early |= more

    def _slides(self, k: int) -> bool:
        """Whether a column moves vertices of the border."""
        return any(v in self.places.slides for v in self.places.columns[k])

    # --- slopes ----------------------------------------------------------------------------------

    def _slopes(self, points: Sequence[Vector], before: Sequence[int]) -> list[Vector] | None:
        columns, shares = self._basis(points, before)
        if columns is None:
            return None
        slopes = combined(self.slopes.number, columns, shares)
        if before and self.equations.loops:
            return None
        order, core = self._peeled(slopes)
        if core and set(self.equations.loops).intersection(core):
            return None
        solved = self._with_areas(slopes, core, self._movable(points, before)) if core else slopes
        return solved and self._in_order(solved, order)

    def _basis(
        self, points: Sequence[Vector], before: Sequence[int]
    ) -> tuple[list[Column] | None, list[Fraction]]:
        """Columns of slopes that satisfy the equations of some folds, and rounded shares."""
        columns = self.slopes.columns
        if not before:
            return columns, [_rounded(share, self.digits) for share in self.q]
        made = self._kept(columns, points, before)
        if not made:
            return None, []
        matrix = np.zeros((2 * self.slopes.number, len(made)))
        for k, column in enumerate(made):
            for f, (x, y) in column.items():
                matrix[2 * f : 2 * f + 2, k] = float(x), float(y)
        shares, *_ = np.linalg.lstsq(matrix, self.equations.turns @ self.q, rcond=None)
        return made, [_rounded(share, self.digits) for share in shares]

    def _kept(
        self, columns: Sequence[Column], points: Sequence[Vector], folds: Sequence[int]
    ) -> list[Column]:
        """A basis of the combinations of columns that satisfy the equations of some folds."""
        rows = []
        for e in folds:
            fold = self.slopes.folds[e]
            along = minus(points[fold.end], points[fold.start])
            row = [dot(along, difference(column, fold.left, fold.right)) for column in columns]
            if any(row):
                rows.append(row)
        if not rows:
            return list(columns)
        made = []
        for vector in nullspace(rows):
            total: Column = {}
            for share, column in zip(vector, columns, strict=True):
                if share:
                    for f, (a, b) in column.items():
                        x, y = total.get(f, (Fraction(0), Fraction(0)))
                        total[f] = x + share * a, y + share * b
            made.append(total)
        return made

    def _movable(self, points: Sequence[Vector], before: Sequence[int]) -> list[Column]:
        """Moves of one panel, or of two neighbours, that satisfy the equations of some folds."""
        by_panel: dict[int, list[Column]] = {}
        for column in self.slopes.columns:
            for f in column:
                by_panel.setdefault(f, []).append(column)
        if not before:
            return list(self.slopes.columns)
        found = [c for f in by_panel for c in self._kept(by_panel[f], points, before)]
        for fold in self.slopes.folds:
            two = [*by_panel[fold.left]]
            two += [column for column in by_panel[fold.right] if column not in two]
            found += self._kept(two, points, before)
        return found

    def _peeled(self, slopes: Sequence[Vector]) -> tuple[list[tuple[int, int]], list[int]]:
        """Vertices, each with a panel that no later vertex uses, and the vertices that are left.

        If some positions are rounded first, all vertices are left.
        """
        left = set(self.slopes.around) & {*self.equations.vertices}
        order: list[tuple[int, int]] = []
        if self.held:
            return order, self.vertices
        while left:
            uses: dict[int, int] = {}
            for v in left:
                for f in self.slopes.around[v]:
                    uses[f] = uses.get(f, 0) + 1
            found: tuple[Fraction, int, int] | None = None
            for v in sorted(left):
                around = self.slopes.around[v]
                for k, f in enumerate(around):
                    alike = {image[f] for _, image in self.maps} & set(around)
                    if uses[f] == 1 and not alike - {f}:
                        d = minus(slopes[around[(k + 1) % len(around)]], slopes[around[k - 1]])
                        if found is None or dot(d, d) > found[0]:
                            found = dot(d, d), v, f
            if found is None:
                break
            order.append(found[1:])
            left -= {found[1]} | {one.vertices[found[1]] for one, _ in self.maps}
        return order, [v for v in self.vertices if v in left]

    def _in_order(
        self, slopes: Sequence[Vector], order: Sequence[tuple[int, int]]
    ) -> list[Vector] | None:
        """Slopes that satisfy the equations of the vertices, the last first, by their panels.

        At a loop the panel becomes the mirror image of the one opposite, in the bisector of the two
        between. Elsewhere it moves as little as possible.
        """
        slopes = list(slopes)
        for v, f in reversed(order):
            around = self.slopes.around[v]
            k = around.index(f)
            a, b = slopes[around[k - 1]], slopes[around[(k + 1) % len(around)]]
            d = minus(b, a)
            if not dot(d, d):
                return None
            if v in self.equations.loops:
                far = slopes[around[(k + 2) % 4]]
                twice = 2 * dot(minus(far, a), d) / dot(d, d) - 1
                slopes[f] = far[0] - twice * d[0], far[1] - twice * d[1]
            else:
                share = area(around, slopes) / dot(d, d)
                slopes[f] = slopes[f][0] - share * d[1], slopes[f][1] + share * d[0]
            if max(c.denominator.bit_length() for c in slopes[f]) > _LONGEST:
                return None
            for one, image in self.maps:
                x, y = one.applied(slopes[f])
                slopes[image[f]] = one.turns * x, one.turns * y
        return slopes

    def _panels(self, vertices: Sequence[int]) -> list[int]:
        """Where a symmetry takes the panels."""
        faces = self.places.pattern.faces
        numbers = {frozenset(face): k for k, face in enumerate(faces)}
        image = [0] * self.slopes.number
        for k, face in enumerate(faces):
            other = numbers[frozenset(vertices[v] for v in face)]
            image[self.slopes.panel_of[k]] = self.slopes.panel_of[other]
        return image

    def _with_areas(
        self, slopes: list[Vector], vertices: Sequence[int], columns: Sequence[Column]
    ) -> list[Vector] | None:
        """Slopes whose polygons round the vertices have no area, by some of the columns."""
        around = [self.slopes.around[v] for v in vertices]
        gradient = np.array(
            [[float(mixed(panels, slopes, column)) for column in columns] for panels in around]
        ).reshape(len(vertices), len(columns))
        touching = [
            {k for k, panels in enumerate(around) if column.keys() & set(panels)}
            for column in columns
        ]
        best: tuple[float, list[int]] = (0.0, [])
        source = np.random.default_rng(0)
        size = np.abs(gradient).max(axis=0, initial=0.0)
        for number in range(_ORDERS):
            weights = size * (source.uniform(0.2, 1, len(columns)) if number else 1.0)
            chosen: list[int] = []
            for c in np.argsort(-weights):
                if size[c] > 1e-9 and all(
                    not both(around[k], columns[c], columns[d])
                    for d in [*chosen, c]
                    for k in touching[c] & touching[d]
                ):
                    chosen.append(int(c))
            if len(chosen) >= len(vertices):
                least = np.linalg.svd(gradient[:, chosen], compute_uv=False)[-1]
                if least > best[0]:
                    best = float(least), chosen
        if best[0] < _SMALL:
            return None
        rows = []
        for panels in around:
            coefficients = {c: mixed(panels, slopes, columns[c]) for c in best[1]}
            rows.append(Row({c: a for c, a in coefficients.items() if a}, -area(panels, slopes)))
        solved = solution(rows, dict.fromkeys(best[1], Fraction(0)))
        if solved is None:
            return None
        slopes = list(slopes)
        for c, share in solved.items():
            for f, (x, y) in columns[c].items():
                slopes[f] = slopes[f][0] + share * x, slopes[f][1] + share * y
        return slopes

    # --- places ----------------------------------------------------------------------------------

    def _place_row(
        self, e: int, slopes: Sequence[Vector], points: Sequence[Vector], late: Sequence[int]
    ) -> Row:
        """The equation of a fold in the places that are left; `points` has 0 for these."""
        fold = self.slopes.folds[e]
        jump = minus(slopes[fold.left], slopes[fold.right])
        right = -dot(jump, minus(points[fold.end], points[fold.start]))
        coefficients = {}
        for k in late:
            value = dot(jump, difference(self.places.columns[k], fold.end, fold.start))
            if value:
                coefficients[k] = value
        return Row(coefficients, right)

    def _holds(self, points: Sequence[Vector], slopes: Sequence[Vector]) -> bool:
        """Whether all equations hold exactly, and all letters are as wanted."""
        for fold in self.slopes.folds:
            jump = minus(slopes[fold.left], slopes[fold.right])
            x, y = minus(points[fold.end], points[fold.start])
            if dot(jump, (x, y)):
                return False
            if fold.sign and fold.sign * cross((x, y), jump) <= 0:
                return False
        return not any(
            area(panels, slopes) for panels in self.slopes.around.values() if len(panels) > 2
        )
