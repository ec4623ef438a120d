"""Drives: folds whose angles grow together, in the ratio of their goals."""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import atan2, copysign, cos, degrees, gcd, prod, radians, sqrt
from typing import TypeAlias, TypedDict

from exactfold._support.documents import Degrees, FoldText, Rational
from exactfold.errors import BadDriveError
from exactfold.exact.numbers import format_rational, integer_row
from exactfold.motion.claims import Claim
from exactfold.motion.curves.coupling import NO_COUPLING, Coupling
from exactfold.pattern.crease_pattern import CreasePattern, Edge

_DENOMINATOR = 10**12


class GoalDocument(TypedDict):
    """The angle to which a fold is driven."""

    angle: Degrees
    """Positive for a valley."""
    square: Rational
    """sin^2 of half this angle, exactly, with the sign of the angle."""


Goals: TypeAlias = dict[FoldText, GoalDocument]


@dataclass(frozen=True)
class PrescribedAngles:
    """Folds that are driven from 0 to given angles, with a fixed ratio of the sines of half angles.

    Let a_k be the fold angles. The ratio of the numbers sin(a_k / 2) is constant during the motion
    and equals that at the goal. `squares[k]` is exactly sin(a_k / 2)^2 at the goal, with the sign
    of the angle, which is positive for a valley. It is 1/2 for 90 degrees. For most angles sin(a_k
    / 2)^2 is not rational; then the square is a rational number with a denominator up to 10^12,
    with an error of at most 1e-12. `folds` are folds of a pattern.

    >>> PrescribedAngles.of({(3, 7): 90, (4, 9): -45})
    <Drive: 3-7 to 90, 4-9 to -45 degrees>
    """

    folds: tuple[Edge, ...]
    squares: tuple[Fraction, ...]

    @classmethod
    def of(cls, angles: Mapping[Edge, float]) -> PrescribedAngles:
        """A drive from angles in degrees by fold; raises `BadDriveError` for an angle that is no
        goal.
        """
        for fold, angle in angles.items():
            if not 0 < abs(angle) <= 180 or not square_of(angle):
                raise BadDriveError(
                    f"fold {fold_text(fold)} cannot be driven to {angle:g} degrees: "
                    f"{_why_not(angle)}",
                    [fold],
                )
        return cls(tuple(angles), tuple(square_of(angle) for angle in angles.values()))

    @property
    def angles(self) -> dict[Edge, float]:
        """The goals in degrees."""
        return {
            fold: copysign(degrees(2 * atan2(sqrt(abs(q)), sqrt(1 - abs(q)))), q)
            for fold, q in zip(self.folds, self.squares, strict=True)
        }

    @property
    def sines(self) -> tuple[float, ...]:
        """sin(a_k / 2) at the goal; near the flat sheet the angles have this ratio to
        first order.
        """
        return tuple(copysign(sqrt(abs(q)), q) for q in self.squares)

    @property
    def text(self) -> str:
        """The folds and their goals, in words."""
        goals = ", ".join(f"{fold_text(fold)} to {a:.6g}" for fold, a in self.angles.items())
        return f"{goals} degrees"

    @property
    def ratio(self) -> str:
        """The ratio of the angles to first order, scaled so that the largest is 1, in words."""
        largest = max(map(abs, self.sines))
        pairs = zip(self.folds, self.sines, strict=True)
        return ", ".join(f"{fold_text(fold)} {sine / largest:.4g}" for fold, sine in pairs)

    def to_dict(self) -> Goals:
        """By fold: its goal in degrees, and its exact square."""
        return {
            fold_text(fold): {"angle": angle, "square": format_rational(q)}
            for (fold, angle), q in zip(self.angles.items(), self.squares, strict=True)
        }

    def claim(self, reached: bool) -> Claim:
        """That the angles keep their ratio, and whether they reach the goals at the end."""
        return Claim(
            {
                "drive": {
                    "folds": [list(fold) for fold in self.folds],
                    "squares": [format_rational(q) for q in self.squares],
                    "reached": reached,
                }
            }
        )

    def coupling(self, sheet: CreasePattern, place: Mapping[int, int]) -> Coupling:
        """The equations of the drive on a sheet.

        Vertex v of the pattern is vertex `place[v]` of the sheet. Let the two faces at fold k have
        the areas A and B, and let l be its length. Half the change of the squared distance of its
        two opposite vertices is g_k = -8 (A B / l^2) sin(a_k / 2)^2. So these squares are in the
        ratio of q_k if and only if w_m g_k = w_k g_m with w_k = q_k A B / l^2, for one m and all
        other k (docs/motion.md, 10). For a single fold there are no equations.

        >>> from exactfold.pattern.families import single_vertex
        >>> star = single_vertex(5)
        >>> PrescribedAngles.of({(0, 5): 90, (2, 5): 90}).coupling(star, range(6)).diagonals
        ((4, 1), (1, 3))
        """
        if len(self.folds) < 2:
            return NO_COUPLING
        diagonals, weights = [], []
        for (v, w), q in zip(self.folds, self.squares, strict=True):
            i, j = sorted((place[v], place[w]))
            left, right = sheet.opposite((i, j))
            (ax, ay), (bx, by), (px, py), (rx, ry) = (
                sheet.vertices[u] for u in (i, j, left, right)
            )
            ux, uy = bx - ax, by - ay
            areas = (ux * (py - ay) - uy * (px - ax)) * (uy * (rx - ax) - ux * (ry - ay))
            diagonals.append((left, right))
            weights.append(abs(q) * areas / (ux * ux + uy * uy))
        most = max(range(len(weights)), key=weights.__getitem__)
        rows = []
        for k, weight in enumerate(weights):
            if k != most:
                row = [Fraction(0)] * len(weights)
                row[k], row[most] = weights[most], -weight
                whole = integer_row(row)
                rows.append(tuple(c // gcd(*whole) for c in whole))
        return Coupling(tuple(diagonals), _alike(rows))

    def passed(
        self,
        sheet: CreasePattern,
        place: Mapping[int, int],
        points: Sequence[Sequence[Fraction]],
        radius: Fraction,
    ) -> bool:
        """Whether all folds are proved to be bent to their goals or beyond, each to its own side.

        `points` are those of the vertices of the sheet in its unit; each coordinate has an error of
        at most `radius`. `place` is that of `coupling`. In terms of the diagonal of fold k the
        condition is g_k <= -8 (A B / l^2) |q_k|, together with the sign of the volume of its two
        faces. False proves nothing.

        >>> from exactfold.pattern.families import single_vertex
        >>> star = single_vertex(5)
        >>> flat = [(*point, Fraction(0)) for point in star.vertices]
        >>> PrescribedAngles.of({(0, 5): 90, (2, 5): 90}).passed(star, range(6), flat, Fraction(0))
        False
        """
        for (v, w), q in zip(self.folds, self.squares, strict=True):
            i, j = sorted((place[v], place[w]))
            left, right = sheet.opposite((i, j))
            flat = [(*sheet.vertices[u], Fraction(0)) for u in (i, j, left, right)]
            moved = [points[u] for u in (i, j, left, right)]
            (ux, uy, _), (px, py, _), (rx, ry, _) = (_minus(x, flat[0]) for x in flat[1:])
            turned, other = ux * py - uy * px, uy * rx - ux * ry
            gap = _minus(flat[2], flat[3])
            off = _minus(_minus(moved[2], moved[3]), gap)
            g = sum(((a + x / 2) * x for a, x in zip(gap, off, strict=True)), Fraction(0))
            spread = 2 * radius
            g += sum(abs(a) + abs(x) + spread / 2 for a, x in zip(gap, off, strict=True)) * spread
            if g > -2 * abs(q) * turned * other / (ux * ux + uy * uy):
                return False
            arms = [_minus(x, moved[0]) for x in moved[1:]]
            sizes = [sum(map(abs, arm)) for arm in arms]
            most = prod(size + 3 * spread for size in sizes) - prod(sizes)
            if not _volume(*arms) * (1 if q > 0 else -1) > most:
                return False
        return True

    def ways(self, labels: Sequence[int]) -> tuple[tuple[Edge, int], ...]:
        """The folds, each with 1 if it has to become a valley or -1 if a mountain.

        The folds are given by vertices of the framework's sheet. Vertex v of that sheet is vertex
        `labels[v]` of the pattern.
        """
        place = {label: v for v, label in enumerate(labels)}
        return tuple(
            ((min(place[v], place[w]), max(place[v], place[w])), 1 if q > 0 else -1)
            for (v, w), q in zip(self.folds, self.squares, strict=True)
        )

    def __repr__(self) -> str:
        return f"<Drive: {self.text}>"


def _why_not(angle: float) -> str:
    """Why an angle in degrees is no goal."""
    if angle != angle:
        return "that is not a number"
    if abs(angle) > 180:
        return "the limit is 180 degrees"
    if angle:
        return "give at least 0.0001 degrees"
    return "at 0 it stays flat; give another angle, or leave the fold out"


def _alike(rows: list[tuple[int, ...]]) -> tuple[tuple[int, ...], ...]:
    """The rows multiplied by powers of 2 such that their largest numbers have the same
    bit length.
    """
    lengths = [max(abs(c).bit_length() for c in row) for row in rows]
    most = max(lengths)
    return tuple(tuple(c << most - n for c in row) for row, n in zip(rows, lengths, strict=True))


def _minus(a: Sequence[Fraction], b: Sequence[Fraction]) -> list[Fraction]:
    return [x - y for x, y in zip(a, b, strict=True)]


def _volume(a: Sequence[Fraction], b: Sequence[Fraction], c: Sequence[Fraction]) -> Fraction:
    return (
        a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
    )


def square_of(angle: float) -> Fraction:
    """sin(a / 2)^2 of an angle in degrees, with its sign, rounded as in `PrescribedAngles`."""
    square = Fraction((1 - cos(radians(abs(angle)))) / 2).limit_denominator(_DENOMINATOR)
    return square if angle > 0 else -square


def fold_text(fold: Edge) -> str:
    """A fold as it is printed."""
    return f"{fold[0]}-{fold[1]}"


def not_a_fold(edges: Container[Edge], pair: Edge, purpose: str) -> str:
    """Why two vertices are not a fold: they form an edge of the boundary, or no edge.

    >>> not_a_fold([(0, 1), (0, 4)], (0, 1), "to drive")
    '0-1 is an edge of the boundary, not a fold to drive'
    >>> not_a_fold([(0, 1), (0, 4)], (1, 4), "to drive")
    'there is no fold 1-4 to drive'
    """
    if pair in edges:
        return f"{fold_text(pair)} is an edge of the boundary, not a fold {purpose}"
    return f"there is no fold {fold_text(pair)} {purpose}"
