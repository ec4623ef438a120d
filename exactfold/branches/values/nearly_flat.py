"""Folds that are nearly flat on branches: perhaps only because coordinates are rounded.

If coordinates are rounded, a fold that was flat on a branch bends by about as much as they were
moved, and a multiple branch, on which the star of a vertex is flat, becomes several branches that
are as near to each other. Floats measure such folds, and exact letters tell them from flat ones.
Nothing here is part of a proof.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import log2
from typing import TYPE_CHECKING, Final

import numpy as np

from exactfold._support.arrays import FloatArray, IndexArray, IntArray
from exactfold._support.plurals import agreeing, counted
from exactfold.branches.values.roots import BoxRoot
from exactfold.exact.numbers import decimal_above
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.drawing.meant.left import chance
from exactfold.pattern.remembered import remembered
from exactfold.pattern.rounding import half_step

if TYPE_CHECKING:
    from exactfold.branches.values.branch import Branch
    from exactfold.pattern.near_degeneracy import WarningDocument

NEAREST: Final = 10
"""No fold is nearly flat that bends by more than 2^-10, about a thousandth, of the largest."""
_DENSITY: Final = 10.0
"""On random sheets, a share of at most about 10 x of all folds bends by less than a small x."""
_CHANCE: Final = 1e-3
_EXPLAINED: Final = 1e-2
_STEPS: Final = 16
"""Rounding easily explains angles of up to so many half steps of the last digit."""
_FAR: Final = 64
"""It hardly explains those of more half steps."""
_NOISE: Final = 1e-5
"""Coordinates may be off by this, however many digits they have."""
_INDEPENDENT: Final = 64
_BINS: Final = 64
_LARGE: Final = 1 / 8
"""Larger angles are never denser than `_DENSITY` says."""
_CHUNK: Final = 4096
_NAMED: Final = 6


@dataclass(frozen=True)
class NearlyFlat:
    """Folds that are nearly flat on some branches of a sheet with decimals.

    They bend by at most `off` times as much as the fold that bends most on the same branch.
    `vertices` are those at which all folds are flat or nearly flat on some branch. `branches` is
    the number of these branches, of `number` that were looked at.
    """

    off: float
    folds: tuple[tuple[int, int], ...]
    vertices: tuple[int, ...]
    branches: int
    number: int

    def labelled(self, labels: Sequence[int]) -> NearlyFlat:
        """The same, where vertex k of a sheet without rigid parts is vertex `labels[k]`."""
        folds = tuple((labels[i], labels[j]) for i, j in self.folds)
        return replace(self, folds=folds, vertices=tuple(labels[v] for v in self.vertices))

    @property
    def text(self) -> str:
        """What is nearly flat, and what it means for answers."""
        names = [str(v) for v in self.vertices] or [f"{i}-{j}" for i, j in self.folds]
        what = agreeing(len(names), "vertex" if self.vertices else "fold")
        named = ", ".join(names[:_NAMED]) + (", ..." if len(names) > _NAMED else "")
        where = f" on {self.branches} of {counted(self.number, 'way')}" if self.number > 1 else ""
        off = decimal_above(Fraction(self.off), 1)
        return (
            f"{what} {named} {agreeing(len(names), 'is')} nearly flat{where}, with angles of at "
            f"most {off} of the largest, which chance hardly explains, so that answers hold only "
            "for these digits"
        )

    def to_dict(self) -> WarningDocument:
        """The warning as JSON: the vertices at which something is nearly flat, and the text."""
        ends = sorted({v for fold in self.folds for v in fold})
        return {"vertices": list(self.vertices) or ends, "text": self.text}


@dataclass(frozen=True)
class Bends:
    """How many of the angles of a sheet's folds on branches are how small.

    Column k of each array counts values between 2^-(k + 1) and 2^-k of the largest angle on the
    same branch: for each of the `folds`, for the largest angle at each of the `vertices`, and for
    the least angle on each of the `number` `branches`. Angles that are exactly 0 are left out. So
    are values too large to matter: of folds above 1/8, of the others where no fold is nearly flat.
    """

    folds: IntArray
    vertices: IntArray
    branches: IntArray
    number: int

    @classmethod
    def of(cls, sheet: CreasePattern, angles: FloatArray) -> Bends:
        """Those of branches with the sizes of the angles of all folds, of shape (m, folds)."""
        with np.errstate(all="ignore"):
            shares = angles / angles.max(axis=1, keepdims=True, initial=0.0)
        rows, columns = np.nonzero(shares < _LARGE)
        small = shares[rows, columns]
        near = shares[np.unique(rows[(small < 2.0**-NEAREST) & (small > 0)])]
        stars = np.stack([near[:, k].max(axis=1) for k in _stars(sheet)], axis=1)
        least = np.where(near > 0, near, 1.0).min(axis=1, initial=1.0)
        return cls(
            _binned(small, columns, shares.shape[1]),
            _binned(stars.ravel(), np.tile(np.arange(stars.shape[1]), len(near)), stars.shape[1]),
            _binned(least, np.zeros(len(near), dtype=np.intp), 1)[0],
            len(angles),
        )

    def __add__(self, other: Bends) -> Bends:
        return Bends(
            self.folds + other.folds,
            self.vertices + other.vertices,
            self.branches + other.branches,
            self.number + other.number,
        )

    def nearly_flat(self, sheet: CreasePattern, off: float | None = None) -> NearlyFlat | None:
        """The folds of the sheet that are flatter than chance explains; None if there are none.

        Let T be the number of angles. Chance makes one as small as x with a probability of at most
        10 T x. If k are as small, these are k / 2 events, as angles at a vertex depend on each
        other; Chernoff's bound limits their probability, where 10 T x are expected, or as many as
        the larger angles let expect, if those are more. As far vertices hardly matter to a fold,
        many branches count as only `_INDEPENDENT`. The largest x with a probability below a
        thousandth is taken, or below a hundredth where x is at most `_STEPS` half steps of the last
        digit. Neither is it more than 1e-5 or, if that is larger, `_FAR` half steps, nor more than
        a thousandth. With `off`, of which this is known from other branches of the sheet, angles of
        at most this size are near.
        """
        if off is not None:
            known = round(-log2(off))
            return self._at_most(known, sheet) if self.folds[:, known:].any() else None
        of_size = self.folds.sum(axis=0)
        within = of_size[::-1].cumsum()[::-1]  # at most 2^-k
        uniform = _DENSITY * len(self.folds) * self.number
        share = min(1.0, _INDEPENDENT / self.number)
        seen, step = 0.0, half_step(sheet.vertices)
        largest = min(2.0**-NEAREST, max(_NOISE, _FAR * step))
        for k in np.flatnonzero(of_size).tolist():
            expected = max(uniform, seen) * 2.0**-k
            seen = max(seen, float(within[k]) * 2.0 ** (k + 1))
            events = int(within[k] * share) // 2
            limit = _EXPLAINED if 2.0**-k <= _STEPS * step else _CHANCE
            unlikely = min(chance(expected, 1), chance(share * expected, events)) < limit
            if unlikely and 2.0**-k <= largest:
                return self._at_most(k, sheet)
        return None

    def _at_most(self, k: int, sheet: CreasePattern) -> NearlyFlat:
        folds, vertices = (rows[:, k:].sum(axis=1).tolist() for rows in (self.folds, self.vertices))
        return NearlyFlat(
            2.0**-k,
            tuple(fold for fold, near in zip(sheet.folds, folds, strict=True) if near),
            tuple(v for v, near in zip(sheet.interior, vertices, strict=True) if near),
            int(self.branches[k:].sum()),
            self.number,
        )


def bends_of(branches: Sequence[Branch]) -> Bends | None:
    """The angles of the folds on the branches of one sheet; None if nothing is proved of them.

    Folds with the letter F or U are flat, or may be; they are left out.
    """
    known = [branch for branch in branches if branch.root is not None]
    total: Bends | None = None
    for first in range(0, len(known), _CHUNK):
        chunk = known[first : first + _CHUNK]
        sheet = chunk[0].pattern
        angles = np.abs(angles_on(sheet, _heights(chunk).T)).T
        largest = angles.max(axis=1, initial=0.0)
        folds = sheet.folds
        for row, k in np.argwhere(angles < 2.0**-NEAREST * largest[:, None]).tolist():
            if chunk[row].assignment[folds[k]] in "FU":
                angles[row, k] = 0.0
        part = Bends.of(sheet, angles)
        total = part if total is None else total + part
    return total


def angles_on(sheet: CreasePattern, rows: FloatArray) -> FloatArray:
    """The first-order angles of all folds, up to one factor, for heights of shape (vertices, m).

    A fold of length L between faces of twice the areas c and c' bends by L f(h) / (c c'), where f
    is its functional (`fold_functional`).
    """
    corners, weights = _bending(sheet)
    return np.asarray(sum(weights[:, k, None] * rows[corners[:, k]] for k in range(4)))


@remembered
def _bending(sheet: CreasePattern) -> tuple[IndexArray, FloatArray]:
    """The corners i, j, left and right of each fold ij, and their coefficients in its angle."""
    corners = np.array([(*fold, *sheet.opposite(fold)) for fold in sheet.folds], dtype=np.intp)
    exact, _ = sheet.integer_vertices
    points = np.array(exact, dtype=object)
    size = np.ptp(points, axis=0).max()
    seen = (points[corners[:, 1:]] - points[corners[:, :1]]) / size  # from i, each rounded once
    along, left, right = np.moveaxis(seen.astype(np.float64), 1, 0)
    over, under = _cross(along, left), -_cross(along, right)
    across = _cross(left, right)
    weights = np.stack([-(over + across + under), across, under, over], axis=1)
    with np.errstate(all="ignore"):
        return corners, weights * (np.hypot(*along.T) / (over * under))[:, None]


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


def _heights(branches: Sequence[Branch]) -> FloatArray:
    """The heights of all vertices on the branches, up to a factor for each."""
    rows = branches[0].height_rows
    roots = [branch.root for branch in branches]
    if all(isinstance(root, BoxRoot) for root in roots) and all(
        branch.height_rows is rows for branch in branches
    ):
        boxes = [root.box for root in roots if isinstance(root, BoxRoot)]
        places = np.array([box.real for box in boxes], dtype=np.float64)
        places *= np.array([0.5**box.bits for box in boxes])[:, None]
        floats = _floats(rows)
        return np.asarray(places @ floats[:, :-1].T + floats[:, -1])
    return np.array([[h for _, h in sorted(b.approx_heights.items())] for b in branches])


def _floats(rows: Mapping[int, Iterable[Fraction]]) -> FloatArray:
    return np.array([[float(c) for c in row] for _, row in sorted(rows.items())])


@remembered
def _stars(sheet: CreasePattern) -> tuple[IntArray, ...]:
    """The places of the folds at each interior vertex."""
    at: dict[int, list[int]] = {v: [] for v in sheet.interior}
    for k, fold in enumerate(sheet.folds):
        for v in fold:
            if v in at:
                at[v].append(k)
    return tuple(np.array(places) for places in at.values())


def _binned(values: FloatArray, columns: IndexArray, number: int) -> IntArray:
    """For each column, how many of the shares in it have which size; zeros are left out."""
    _, exponents = np.frexp(values)
    places = np.clip(-exponents, 0, _BINS - 1) + _BINS * columns
    counts = np.bincount(places[values > 0], minlength=_BINS * number)
    return counts.reshape(number, _BINS)
