"""Proves exactly that a branch lies near given heights (docs/branch.md), without floats."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import isqrt

import numpy as np

from exactfold._support.arrays import BigArray, FloatArray, IndexArray, IntArray
from exactfold.rigidity.equations.sheet import Folds, VertexEquations

_LENGTH_BITS = 64
_CLEAR = 2.0**-20
"""Sums of floats have a sign if they are at least this share of the sum of the sizes; vertices have
fewer than 2^30 folds."""
_LEAST_SIZE, _LARGEST_SIZE = 2.0**-800, 2.0**900
_LEAST_COST = 2.0**-500
"""Smaller costs are rounded up to this, as their squares may be too small for normal floats."""


@dataclass(frozen=True)
class Enclosure:
    """What is proved by heights `heights[v] / denominator` that pass the test of `enclose`.

    `signs[v]` says in which nappe of K_v the heights lie. `squared_distance` bounds the integral of
    |grad(h - heights)|^2 for the only solution h in these closed nappes. `letters` lists the folds
    of the sheet in order: h has a valley (+1) or a mountain (-1), or the letter is undecided (0).
    `loose` are the vertices at which no fold is decided. `flat_folds` (indices of folds with letter
    0) and `flat_vertices` are proved flat (`exactfold.solve.certify.enclosed_flat`). `merged` are
    larger triangles that are proved flat, each with its corners and the other vertices in it or on
    it (`exactfold.solve.certify.merged`); these vertices have no entry in `heights`, but lie in the
    planes of the corners.
    """

    heights: BigArray
    denominator: int
    signs: dict[int, int]
    squared_distance: Fraction
    letters: tuple[int, ...]
    loose: tuple[int, ...]
    flat_folds: frozenset[int] = frozenset()
    flat_vertices: tuple[int, ...] = ()
    merged: tuple[tuple[tuple[int, int, int], tuple[int, ...]], ...] = ()

    @property
    def complete(self) -> bool:
        """Whether every fold is proved a mountain, a valley or flat."""
        return self.letters.count(0) == len(self.flat_folds)


@dataclass(frozen=True)
class Curvatures:
    """Integer bounds low_v <= 2^`bits` * 2 * denominator^2 * K_v <= high_v of all curvatures.

    The heights are integers over `denominator`; `bends` are the fold functionals f_e of these
    integers.
    """

    bits: int
    bends: BigArray
    low: BigArray
    high: BigArray


def curvatures(folds: Folds, heights: BigArray, bits: int) -> Curvatures:
    """Bounds of all K_v: 2 K_v = sum_w omega_vw (h_w - h_v), with each term rounded down.

    They are right at the vertices all of whose folds are among `folds`.
    """
    i, j = folds.corners[:, 0], folds.corners[:, 1]
    bends = folds.bends(heights)
    terms = (bends * (heights[j] - heights[i]) << bits) // folds.areas
    low = folds.summed(terms, ~terms, len(heights))  # -x >= -(floor(x) + 1), which is ~floor(x)
    degree = np.bincount(folds.corners[:, :2].ravel(), minlength=len(heights))
    return Curvatures(bits, bends, low, low + degree.astype(object))


def enclose(
    sheet: VertexEquations,
    heights: BigArray,
    denominator: int,
    bits: int,
    known: Curvatures | None = None,
) -> Enclosure | tuple[int, ...]:
    """The branch near rational heights, or the vertices at which the test fails.

    *Theorem 5* (docs/branch.md, How far heights are from a branch). Let the boundary be convex, let
    h' have the given boundary heights and K_v(h') > 0 for all interior v, and let e_v be the nappe
    of h' at v. Then K_v(h) = k_v has exactly one solution in the closed nappes e, and it satisfies

        int |grad(h - h')|^2 <= sum_v m_v (sqrt K_v(h') - sqrt k_v)^2,  m_v = R^2 - |U_v - c|^2,

    for every disk (c, R) that contains the sheet. The letter of a fold is decided if its bend in h'
    is too large for gradients of that size to undo it. A vertex with a decided fold is not flat. If
    every vertex has one, the solution is simple and its signs are e.

    `heights` are integers over `denominator`; they must reproduce the boundary heights exactly.
    `bits` is the extra precision of the rounded divisions, and `known` are the curvatures of these
    heights with it, if they have been computed already. Arithmetic is exact, or rounded in the
    safe direction. A vertex is returned if K_v(h') > 0 or the nappe of h' could not be proved at
    it.

    Raises `ValueError` if the boundary heights are not those of the sheet, or the boundary is not
    convex.
    """
    check_hypotheses(sheet, heights, denominator)
    curvature = curvatures(sheet.folds, heights, bits) if known is None else known
    signs = nappes(sheet, curvature.bends)
    failed = tuple(v for v in sheet.unknowns if curvature.low[v] <= 0 or not signs[v])
    if failed:
        return failed
    distance = _squared_distance(sheet, curvature, denominator)
    letters = _letters(sheet, curvature.bends, distance * denominator**2)
    ends = sheet.folds.corners[np.array(letters, dtype=bool), :2]
    decided = set(ends.ravel().tolist())
    loose = tuple(v for v in sheet.poppable if v not in decided and v not in sheet.targets)
    return Enclosure(heights, denominator, signs, distance, letters, loose)


def check_hypotheses(sheet: VertexEquations, heights: BigArray, denominator: int) -> None:
    """Raises `ValueError` unless the boundary is convex and has the given heights."""
    if not sheet.pattern.is_convex:
        raise ValueError("the theorem needs a convex boundary")
    if set(sheet.boundary_heights) != set(sheet.pattern.boundary) or any(
        heights[v] * sheet.boundary_denominator != height * denominator
        for v, height in sheet.boundary_heights.items()
    ):
        raise ValueError("the heights of the boundary vertices are not those of the sheet")


def nappes(sheet: VertexEquations, bends: BigArray) -> dict[int, int]:
    """The nappe at each vertex, the sign of -sum_j L_j omega_vj; 0 if it is not proved.

    This sum is 2 K_v(t, h) for the round cone t, t_j - t_v = -L_j, which is timelike and points up.
    The lengths are rounded to `_LENGTH_BITS` binary places, and omega to as many below its largest
    value.
    """
    near = _nappes_in_floats(sheet, bends)
    if near.all():
        return dict(zip(sheet.unknowns, near.tolist(), strict=True))
    folds, signs = sheet.folds, np.zeros(len(sheet.pattern.vertices), dtype=np.int64)
    signs[list(sheet.unknowns)] = near
    open_ = (signs[folds.corners[:, :2]] == 0).any(axis=1)
    squares, areas = folds.squared_length[open_], folds.areas[open_]
    lengths = np.array([isqrt(s << 2 * _LENGTH_BITS) for s in squares], dtype=object)
    # omega has the size of bends / areas; keep _LENGTH_BITS binary places of the smallest one.
    shift = max((int(c).bit_length() for c in areas), default=0) + _LENGTH_BITS
    omega = (bends[open_] << shift) // areas
    # |L omega - lengths omega| <= (lengths + 1) + |omega| + 1 in units of the last place.
    terms, slack = lengths * omega, lengths + abs(omega) + 2
    total, error = (np.array([0] * len(signs), dtype=object) for _ in range(2))
    for end in (0, 1):
        np.add.at(total, folds.corners[open_, end], terms)
        np.add.at(error, folds.corners[open_, end], slack)
    return {
        v: int(signs[v]) or (0 if abs(total[v]) <= error[v] else -1 if total[v] > 0 else 1)
        for v in sheet.unknowns
    }


def _nappes_in_floats(sheet: VertexEquations, bends: BigArray) -> IntArray:
    """The nappes at the unknowns that floats prove; 0 at the others.

    Each omega_vj is rounded once, and each L_j twice. So a sum of n products L_j omega_vj is off by
    less than (n + 5) 2^-53 times the sum of their sizes (Higham, Accuracy and Stability of
    Numerical Algorithms, section 3.1), if no number leaves the normal range.
    """
    folds, count = sheet.folds, len(sheet.pattern.vertices)
    none = np.zeros(len(sheet.unknowns), dtype=np.int64)
    try:
        omega = (bends / folds.areas).astype(np.float64)
        lengths = np.sqrt(folds.squared_length.astype(np.float64))
    except OverflowError:
        return none
    ends = folds.corners[:, :2].T.ravel()
    with np.errstate(all="ignore"):
        terms = np.tile(lengths * omega, 2)
        total = np.bincount(ends, terms, count)[list(sheet.unknowns)]
        sizes = np.bincount(ends, abs(terms), count)[list(sheet.unknowns)]
        # Below the normal range, a product is off by less than 2^-900.
        normal = (sizes > _LEAST_SIZE) & (sizes < _LARGEST_SIZE) & (lengths.max() < _LARGEST_SIZE)
        clear = abs(total) > _CLEAR * sizes
    return np.where(normal & clear, -np.sign(total), none).astype(np.int64)


def _squared_distance(sheet: VertexEquations, curvature: Curvatures, denominator: int) -> Fraction:
    """An upper bound of sum_v m_v (sqrt K_v - sqrt k_v)^2; `off_target` is used where k_v > 0."""
    points = sheet.pattern.integer_vertices[0]
    x, y = (min(p[a] for p in points) + max(p[a] for p in points) for a in (0, 1))

    def squared(v: int) -> int:  # four times the squared distance from the middle (x / 2, y / 2)
        return (2 * points[v][0] - x) ** 2 + (2 * points[v][1] - y) ** 2

    radius = max(squared(b) for b in sheet.pattern.boundary)
    unit = 2 * denominator**2 << curvature.bits
    targets = sheet.targets
    total = sum(
        (radius - squared(v)) * curvature.high[v] for v in sheet.unknowns if v not in targets
    )
    distance = Fraction(total, 4 * unit)
    for v, target in targets.items():
        bounds = (Fraction(bound[v], unit) for bound in (curvature.low, curvature.high))
        distance += Fraction(radius - squared(v), 4) * off_target(bounds, target)
    return distance


def off_target(bounds: Iterable[Fraction], target: Fraction) -> Fraction:
    """An upper bound of (sqrt K - sqrt k)^2, from bounds of K, for a target k > 0.

    It is at most |K - k|, and at most (K - k)^2 / k.
    """
    off = max(abs(bound - target) for bound in bounds)
    return min(off, off**2 / target)


def _letters(sheet: VertexEquations, bends: BigArray, squared: Fraction) -> tuple[int, ...]:
    """The signs of the bends that no change w with int |grad w|^2 <= squared can undo, else 0.

    Let g and g' be the gradients of w on the two faces of the fold e. As
    c/2 |g|^2 + c'/2 |g'|^2 <= squared, |omega_e(w)| L_e <= |g| + |g'| <= sqrt(squared (2/c +
    2/c')). With omega_e = f_e / (c c'), the sign of the bend is safe if
    f_e^2 L_e^2 > squared * 2 (c + c') c c'.
    """
    folds = sheet.folds
    top, bottom = squared.numerator, squared.denominator
    most = 2 * top * (folds.left + folds.right) * folds.areas
    safe = bends * bends * folds.squared_length * bottom > most
    return tuple((f > 0) - (f < 0) if ok else 0 for f, ok in zip(bends, safe, strict=True))


def height_radius(sheet: VertexEquations, squared: Fraction) -> Fraction:
    """A short rational bound of |w| if w is 0 on the boundary and int |grad w|^2 <= squared.

    Along a side of length L of a face of area c/2, w changes by at most L |grad w| <=
    sqrt(2 L^2 / c) sqrt(squared). So the shortest path from the boundary bounds |w_v|. The sums are
    floats; each has a relative error below (V + 3) 2^-52, which the factor 1 + 2^-20 covers.
    """
    if not squared:
        return Fraction(0)
    folds = sheet.folds
    widest = np.maximum(folds.left, folds.right)
    costs = (2 * folds.squared_length / widest).astype(np.float64) ** 0.5
    costs = np.maximum(costs, _LEAST_COST)
    far = _distances(
        len(sheet.pattern.vertices), folds.corners[:, :2], costs, sheet.pattern.boundary
    )
    reached = float(far[list(sheet.pattern.interior)].max(initial=0.0))
    longest = Fraction(reached) * (1 + Fraction(1, 1 << 20))
    return round_up(longest * root_above(squared))


def _distances(
    count: int, ends: IndexArray, costs: FloatArray, sources: Sequence[int]
) -> FloatArray:
    """The length of a shortest path to each vertex, by the method of Bellman and Ford.

    SciPy is not used, as it takes longer to load than a small proof.
    """
    begin, end = np.concatenate([ends, ends[:, ::-1]]).T
    far, nearer = np.full(count, np.inf), np.full(count, np.inf)
    nearer[list(sources)] = 0.0
    while not np.array_equal(far, nearer):
        far = nearer.copy()
        np.minimum.at(nearer, end, far[begin] + np.tile(costs, 2))
    return far


def root_above(value: Fraction) -> Fraction:
    """A rational number at least sqrt(value), with a relative error below 2^-30; value >= 0."""
    product = value.numerator * value.denominator
    shift = max(0, 32 - product.bit_length() // 2)
    return Fraction(isqrt(product << 2 * shift) + 1, value.denominator << shift)


def round_up(value: Fraction) -> Fraction:
    """The least multiple of a power of two, with 24 binary digits, that is at least value > 0."""
    shift = 24 - value.numerator.bit_length() + value.denominator.bit_length()
    if shift >= 0:
        return Fraction(-((-value.numerator << shift) // value.denominator), 1 << shift)
    return Fraction(-(-value.numerator // (value.denominator << -shift)) << -shift)
