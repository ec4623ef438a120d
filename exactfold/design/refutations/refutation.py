"""Why no branch with given vertex signs has given letters: one exact vector in each nappe."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from exactfold.exact.numbers import integer_row
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.remembered import remembered
from exactfold.rigidity.curvature import curvature_form, spokes
from exactfold.rigidity.timelike import round_cone

Letters = Mapping[Edge, str]
"""By fold (i, j), i < j: "M", "V", "F" for a fold that stays flat, "U" for a free fold."""

_ZERO = Fraction(0)


@dataclass(frozen=True, repr=False)
class Refutation:
    """A proof that no solution in the closed nappes of these signs has given letters.

    The vector z_v holds heights of the neighbours of v, while v itself is at height 0: `heights[v,
    w]` is the height of the neighbour w, and missing entries are 0. If v has a sign in `signs`, z_v
    lies in the closed nappe of that sign; otherwise z_v is affine. Every solution h with these
    signs has K_v(z_v, h) >= 0, with equality where z_v is affine. Let omega_f be positive for a
    valley and negative for a mountain. Then

        sum_v K_v(z_v, h) = 1/2 sum_f omega_f(h) (z_v(w) + z_w(v)),   f = vw.

    If the sums z_v(w) + z_w(v) are <= 0 for valleys, >= 0 for mountains and 0 for free folds, and
    not 0 for some mountain or valley, the right side is negative, which is a contradiction. Folds
    that stay flat may have any sum, because omega is 0 there (docs/assignment.md, Theorem 1).
    """

    signs: Mapping[int, int]
    heights: Mapping[tuple[int, int], Fraction]

    def holds(self, sheet: CreasePattern, letters: Letters) -> bool:
        """Whether this refutes the letters, decided in rational arithmetic.

        `sheet` is triangulated and may have any boundary. `letters` has a letter for each of its
        folds. Heights that are not rational numbers refute nothing.
        """
        inside = sheet.interior_set
        if not all(isinstance(z, Fraction) for z in self.heights.values()):
            return False
        if not all(v in inside and sign in (1, -1) for v, sign in self.signs.items()):
            return False
        if not all(v in inside and w in sheet.star(v) for v, w in self.heights):
            return False
        hubs = {v for v, _ in self.heights}
        return all(self._is_placed(sheet, v) for v in hubs) and self._is_against(sheet, letters)

    def _is_placed(self, sheet: CreasePattern, v: int) -> bool:
        """Whether z_v lies in the closed nappe of the sign of v or, if v has no sign, is affine."""
        star = _star(sheet, v)
        heights = integer_row([self.heights.get((v, w), _ZERO) for w in star.ring])
        if v not in self.signs:
            return star.is_affine(heights)
        return star.form(heights) >= 0 and self.signs[v] * star.side(heights) >= 0

    def _is_against(self, sheet: CreasePattern, letters: Letters) -> bool:
        """Whether no term of the sum over the folds is positive, and at least one is negative."""
        strict = False
        for i, j in {(v, w) if v < w else (w, v) for v, w in self.heights}:
            letter = letters[i, j]
            if letter == "F":
                continue
            total = self.heights.get((i, j), _ZERO) + self.heights.get((j, i), _ZERO)
            sign = {"M": 1, "V": -1}.get(letter, 0)
            if total * sign < 0 or (total and not sign):
                return False
            strict = strict or total != 0
        return strict

    def __repr__(self) -> str:
        return f"<Refutation: {len(self.signs)} signs, {len({v for v, _ in self.heights})} stars>"


@dataclass(frozen=True)
class _Star:
    """The form, the side and the spokes of one star as integers, up to positive factors."""

    ring: tuple[int, ...]
    matrix: tuple[tuple[int, ...], ...]
    towards: tuple[int, ...]
    spokes: tuple[tuple[int, int], ...]

    def form(self, heights: Sequence[int]) -> int:
        """A positive multiple of K_v."""
        return sum(
            x * sum(m * y for m, y in zip(row, heights, strict=True) if m)
            for x, row in zip(heights, self.matrix, strict=True)
            if x
        )

    def side(self, heights: Sequence[int]) -> int:
        """A positive multiple of K_v(t, .), where t is a rational vector near the round cone."""
        return sum(c * x for c, x in zip(self.towards, heights, strict=True))

    def is_affine(self, heights: Sequence[int]) -> bool:
        """Whether the heights lie in one plane with the hub."""
        (ax, ay), (bx, by) = self.spokes[:2]
        area = ax * by - ay * bx
        p = heights[0] * by - heights[1] * ay
        q = heights[1] * ax - heights[0] * bx
        lifted = zip(self.spokes, heights, strict=True)
        return all(area * z == p * x + q * y for (x, y), z in lifted)


@remembered
def _star(sheet: CreasePattern, vertex: int) -> _Star:
    form = curvature_form(sheet, vertex)
    ring, d = spokes(sheet, vertex)
    towards = form.functional(round_cone(sheet, vertex))
    size = len(ring)
    entries = integer_row([x for row in form.matrix[1:] for x in row[1:]])
    flat = integer_row([x for spoke in d for x in spoke])
    return _Star(
        ring,
        tuple(entries[k * size : (k + 1) * size] for k in range(size)),
        integer_row([towards[w] for w in ring]),
        tuple(zip(flat[::2], flat[1::2], strict=True)),
    )


def refuted_at(
    sheet: CreasePattern, letters: Letters, vertex: int, sign: int
) -> Refutation | str | None:
    """Why a vertex cannot have a sign with these letters, by its star alone; None if it may.

    A vertex can pop up only under two conditions; for popping down, mountains and valleys change
    places. First, its mountains lie in no closed half-plane, unless all other folds stay flat.
    Where this fails, the wedge -(n . x)_+, which lies in the up nappe, is a refutation
    (docs/assignment.md, The search). Second, one of its folds is a valley. Where this fails the
    reason is a text: a star without a valley is concave, and so K_v > 0, unless it is flat or bent
    along one straight line.
    """
    ring, d = spokes(sheet, vertex)
    letter = [letters[min(vertex, w), max(vertex, w)] for w in ring]
    mountain, valley = ("M", "V") if sign > 0 else ("V", "M")
    held = [u for u, x in zip(d, letter, strict=True) if x in (mountain, "U")]
    others = [u for u, x in zip(d, letter, strict=True) if x == valley]
    for nx, ny in _normals(held, others):
        if all(nx * x + ny * y <= 0 for x, y in held) and any(
            nx * x + ny * y > 0 for x, y in others
        ):
            heights = {
                (vertex, w): -sign * max(nx * x + ny * y, Fraction(0))
                for w, (x, y) in zip(ring, d, strict=True)
            }
            return Refutation({vertex: sign}, {key: z for key, z in heights.items() if z})
    if "U" not in letter and not others and held:
        (x, y) = held[0]
        if len(held) > 2 or any(a * y - b * x for a, b in held):
            names = {"M": "mountain", "V": "valley"}
            where = {1: "up", -1: "down"}[sign]
            return (
                f"cannot pop {where}: it has no {names[valley]}, and a star of "
                f"{names[mountain]}s alone is curved"
            )
    return None


def _normals(
    held: list[tuple[Fraction, Fraction]], others: list[tuple[Fraction, Fraction]]
) -> list[tuple[Fraction, Fraction]]:
    """Normals to try: if some closed half-plane holds all held spokes, one of these bounds it."""
    return [(s * -y, s * x) for x, y in held for s in (1, -1)] or others
