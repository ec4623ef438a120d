"""Why no motion of rigid panels has given letters: one exact vector at each vertex."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction

from exactfold.design.refutations.refutation import Letters
from exactfold.exact.surds import Number, Surd, exact, sign
from exactfold.panels.vertex.stars import Star, bracket, stars
from exactfold.pattern.panel_pattern import PanelPattern, Point


@dataclass(frozen=True, repr=False)
class PanelRefutation:
    """A proof that no motion to second order in the closed nappes of `signs` has given letters.

    `planes[v]` is a vector y_v. It gives the heights z_v(u) = y_v . d_vu at the neighbours u of v,
    where d_vu = p_u - p_v. At the vertices of `signs`, `heights[v, u]` are the heights z_v(u)
    themselves; there z_v lies in the closed nappe of the sign. Missing entries are 0. Motions w
    with these signs satisfy

        sum_f w_f s_f = sum_v sum_u w_vu z_v(u) >= 0,   s_f = z_v(u) + z_u(v) for f = vu.

    If s_f <= 0 for valleys, s_f >= 0 for mountains and s_f = 0 for free folds, and s_f is not 0 for
    some mountain or valley, the left side is negative, which is a contradiction. Without signs the
    right side is 0, and the letters are refuted to first order (docs/assignment.md, Theorem 1).
    Folds that stay flat may have any s_f.
    """

    planes: Mapping[int, Point]
    signs: Mapping[int, int] = field(default_factory=dict)
    heights: Mapping[tuple[int, int], Number] = field(default_factory=dict)

    def holds(self, pattern: PanelPattern, letters: Letters) -> bool:
        """Whether this refutes these letters of all folds, decided in the field of the coordinates.

        Heights and vectors that are not exact numbers refute nothing.
        """
        return self.holds_on(stars(pattern, held(letters)), letters)

    def holds_on(self, moving: Mapping[int, Star], letters: Letters) -> bool:
        """The same on given stars, from which the folds that stay flat have been removed."""
        numbers = [x for y in self.planes.values() for x in y] + list(self.heights.values())
        if not all(isinstance(x, Surd | Fraction | int) for x in numbers):
            return False
        if any(v not in moving for v in (*self.planes, *self.signs)):
            return False
        if any(v not in self.signs or v in self.planes for v, _ in self.heights):
            return False
        local = {v: self._of(moving[v]) for v in (*self.planes, *self.signs)}
        if not all(in_nappe(moving[v], s, local[v]) for v, s in self.signs.items()):
            return False
        total: dict[tuple[int, int], Number] = {}
        for v, z in local.items():
            for edge, x in zip(moving[v].folds, z, strict=True):
                total[edge] = total[edge] + x if edge in total else x
        return _is_against(total, letters)

    def _of(self, star: Star) -> list[Number]:
        v = star.vertex
        if v in self.planes:
            x, y = self.planes[v]
            return [x * a + y * b for a, b in star.directions]
        return [self.heights.get((v, i + j - v), 0) for i, j in star.folds]

    def __repr__(self) -> str:
        return f"<PanelRefutation: {len(self.signs)} signs, {len(self.planes)} planes>"


def held(letters: Letters) -> list[tuple[int, int]]:
    """The folds that have to stay flat."""
    return [fold for fold, letter in letters.items() if letter == "F"]


def _is_against(total: Mapping[tuple[int, int], Number], letters: Letters) -> bool:
    strict = False
    for fold, s in total.items():
        side = sign(s)
        if side and side != {"M": 1, "V": -1}.get(letters[fold]):
            return False
        strict = strict or side != 0
    return strict


def in_nappe(star: Star, side: int, heights: list[Number]) -> bool:
    """Whether heights of a star, with its hub at 0, lie in the closed up (1) or down (-1) nappe.

    All sectors are smaller than pi. The densities of the heights are w_k = z_(k-1) / c_(k-1,k) +
    z_(k+1) / c_(k,k+1) - z_k c_(k-1,k+1) / (c_(k-1,k) c_(k,k+1)), and the form is sum_k w_k z_k /
    2. Where the form is not negative, the sign of the product with a vector inside the up nappe
    distinguishes the two nappes.

    >>> right = Star(0, ((0, 1), (0, 2), (0, 3), (0, 4)), ((1, 0), (0, 1), (-1, 0), (0, -1)))
    >>> in_nappe(right, 1, [-1, -1, -1, -1]), in_nappe(right, -1, [-1, -1, -1, -1])
    (True, False)
    >>> in_nappe(right, 1, [-1, 0, 0, 0]), in_nappe(right, 1, [-1, 1, -1, 1])
    (True, False)
    """
    if side not in (1, -1) or len(star.folds) < 4:
        return False
    w = bends(star, heights)
    value = sum((x * z for x, z in zip(w, heights, strict=True)), Fraction(0))
    inside = sum((x * z for x, z in zip(_balance(star), heights, strict=True)), Fraction(0))
    return sign(value) >= 0 and side * sign(inside) <= 0


def bends(star: Star, heights: list[Number]) -> list[Number]:
    """The densities of the folds of a star with these heights at their ends; all sectors
    are < pi.
    """
    d, count = star.directions, len(star.folds)
    densities: list[Number] = []
    for k in range(count):
        before, after = k - 1, (k + 1) % count
        left, right = exact(bracket(d[before], d[k])), exact(bracket(d[k], d[after]))
        both = bracket(d[before], d[after])
        here = heights[before] / left + heights[after] / right
        densities.append(here - heights[k] * both / (left * right))
    return densities


def _balance(star: Star) -> list[Number]:
    """Positive weights with sum_k weight_k d_k = 0: the densities of a concave star, negated."""
    d, count = star.directions, len(star.folds)
    weights: list[Number] = [Fraction(1)] * count
    for x, y in d:
        opposite = (-x, -y)
        for i in range(count):
            j = (i + 1) % count
            a, b = bracket(opposite, d[j]), bracket(d[i], opposite)
            if sign(a) >= 0 and sign(b) > 0:
                size = exact(bracket(d[i], d[j]))
                weights[i], weights[j] = weights[i] + a / size, weights[j] + b / size
                break
    return weights


def wedge(star: Star, side: int, normal: Point) -> PanelRefutation:
    """The refutation of one sign by the heights -(n . x)_+ of a star, negated for the down sign."""
    nx, ny = normal
    heights: dict[tuple[int, int], Number] = {}
    for (i, j), (x, y) in zip(star.folds, star.directions, strict=True):
        above = nx * x + ny * y
        if sign(above) > 0:
            heights[star.vertex, i + j - star.vertex] = -side * above
    return PanelRefutation({}, {star.vertex: side}, heights)
