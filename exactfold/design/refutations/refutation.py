"""Why no branch with some vertex signs has given letters: one vector in each nappe, exactly."""

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
"""By fold (i, j), i < j: "M", "V", "F" for a fold that stays flat, "U" where anything may be."""

_ZERO = Fraction(0)


@dataclass(frozen=True, repr=False)
class Refutation:
    """No solution in the closed nappes of these signs has given letters.

    `heights[v, w]` is the height of the neighbour w of v in a star z_v whose hub is at height 0;
    what is left out is 0. At a vertex of `signs` z_v lies in the closed nappe of that sign,
    elsewhere it is affine. For solutions h with these signs K_v(z_v, h) >= 0, and 0 where z_v is
    affine. With omega_f, which is positive for a valley and negative for a mountain,

        sum_v K_v(z_v, h) = 1/2 sum_f omega_f(h) (z_v(w) + z_w(v)),   f = vw,

    which is negative for letters whose valleys have sums <= 0, mountains >= 0, and free folds 0, if
    one sum of a mountain or valley is not 0; folds that stay flat may have any, as omega is 0 there
    (docs/assignment.md, Theorem 1).
    """

    signs: Mapping[int, int]
    heights: Mapping[tuple[int, int], Fraction]

    def holds(self, sheet: CreasePattern, letters: Letters) -> bool:
        """Whether it refutes these letters, decided in rational numbers.

        `sheet`: triangulated, any border; `letters` of all its folds. Heights that are not rational
        numbers refute nothing.
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
        """Whether z_v is in the closed nappe of the sign of v, or affine."""
        star = _star(sheet, v)
        heights = integer_row([self.heights.get((v, w), _ZERO) for w in star.ring])
        if v not in self.signs:
            return star.is_affine(heights)
        return star.form(heights) >= 0 and self.signs[v] * star.side(heights) >= 0

    def _is_against(self, sheet: CreasePattern, letters: Letters) -> bool:
        """Whether no term of the sum over the folds is positive, and one is negative."""
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
    """One star in integers: positive multiples of its form, of its side, and of its spokes."""

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
        """A positive multiple of K_v(t, .) for a rational t near the round cone."""
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

    It can pop up only if its mountains lie in no closed half-plane, unless all other folds stay
    flat, and one of its folds is a valley: turned round for down. The first is refuted by the
    wedge -(n . x)_+, which lies in the up nappe (docs/assignment.md, The search); the second, a
    text, because a star without a valley is concave, and has K_v > 0 then unless it is flat or bent
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
    """Normals of lines of which one bounds a half-plane with all held spokes, if there is any."""
    return [(s * -y, s * x) for x, y in held for s in (1, -1)] or others
