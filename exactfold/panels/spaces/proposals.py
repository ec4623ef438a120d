"""A floating-point search for the motions of a large part; it proves nothing."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.clock import UNLIMITED, Clock
from exactfold.panels.spaces.kernel import Entry, Rows
from exactfold.panels.vertex.stars import Star, incidence
from exactfold.pattern.panel_pattern import Edge

_TINY: Final = 1e-7
_MOST_NODES: Final = 1_000
_MOST_WORK: Final = 4_000_000_000
_MOST_VISITS: Final = 50_000
_FEWEST_NODES: Final = 4
_STARTS: Final = 4
_MOST_ATTEMPTS: Final = 24
_MOST_PROPOSALS: Final = 60


def is_too_large(rows: Rows, size: int) -> bool:
    """Whether a search in this space would end after a few nodes, and takes long to begin."""
    return len(rows) * size**2 > _MOST_WORK // _FEWEST_NODES


Step: TypeAlias = tuple[int | Edge, Mapping[Edge, float] | None]


@dataclass(frozen=True)
class Proposal:
    """A motion that seems to be a regular point of a component, and the steps that led to it.

    `densities` gives the density of each fold. `steps` are, in order, the vertices whose forms were
    made zero and the folds that were held flat. Where a form split the space, a step also has the
    densities of a motion in the resulting space. `vertices` are those whose forms do not vanish on
    the remaining space, which has dimension `size`.
    """

    densities: Mapping[Edge, float]
    steps: tuple[Step, ...]
    vertices: tuple[int, ...]
    size: int


_Step: TypeAlias = tuple[int | Edge, FloatArray | None]


@dataclass(frozen=True)
class _Kinds:
    """The forms on a space: those that leave their kernel, those that split the space, and the
    others.
    """

    kernels: list[tuple[int, FloatArray]]
    splits: dict[int, tuple[FloatArray, FloatArray]]
    left: list[int]


class Proposals:
    """A depth-first search for motions, with a fixed number of steps and a clock.

    On each space of motions, a semidefinite form leaves its kernel, a form of inertia (1, 1) splits
    the space, and other forms remain. Where no form splits the space any more, Newton's method
    looks for a motion in it. After the search, `complete` says whether it reached its end.

    If `regular` is false, only motions of linear spaces are proposed, whether or not they seem to
    be regular points. Then, where a form neither splits the space nor leaves its kernel, folds of
    its vertex are held flat.
    """

    def __init__(
        self,
        stars: Mapping[int, Star],
        rows: Rows,
        size: int,
        *,
        regular: bool = True,
        clock: Clock = UNLIMITED,
    ) -> None:
        self.complete = False
        self._clock = clock
        self._regular = regular
        self._edges = list(rows)
        place = {edge: k for k, edge in enumerate(self._edges)}
        basis = in_floats(rows.values())
        self._whole: FloatArray = np.linalg.qr(basis)[0]
        self._size = size
        self._folds: dict[int, FloatArray] = {}
        self._forms: dict[int, FloatArray] = {}
        for v, star in stars.items():
            kept = [k for k, edge in enumerate(star.folds) if edge in place]
            if len(kept) < 2:
                continue
            d = np.array([[float(x) for x in star.directions[k]] for k in kept])
            brackets = np.triu(np.outer(d[:, 0], d[:, 1]) - np.outer(d[:, 1], d[:, 0]), 1)
            if (largest := np.abs(brackets).max()) == 0:
                continue
            self._forms[v] = (brackets + brackets.T) / largest
            self._folds[v] = np.array([place[star.folds[k]] for k in kept])
        lengths = sorted({len(folds) for folds in self._folds.values()})
        groups = [[v for v, folds in self._folds.items() if len(folds) == n] for n in lengths]
        self._batches = [
            (
                group,
                np.array([self._folds[v] for v in group]),
                np.array([self._forms[v] for v in group]),
            )
            for group in groups
        ]
        at = incidence(stars)
        self._near = {
            v: [u for edge in star.folds for u in at[edge] if u != v and u in self._forms]
            for v, star in stars.items()
        }
        self._attempts = self._visits = 0
        self._rng = np.random.default_rng(1)

    def __iter__(self) -> Iterator[Proposal]:
        """Yield proposals; none lies in the space of an earlier one."""
        known: list[tuple[FloatArray, FloatArray]] = []
        most = min(_MOST_NODES, _MOST_WORK // (len(self._edges) * self._size**2))
        waiting: list[tuple[FloatArray, tuple[_Step, ...]]] = [(self._whole, ())]
        for _ in range(most):
            if not waiting or len(known) == _MOST_PROPOSALS or self._visits > _MOST_VISITS:
                break
            if self._clock.passed:
                break
            basis, steps = waiting.pop()
            basis, more, kinds = self._reduced(basis)
            steps += tuple((v, None) for v in more)
            if basis.shape[1] == 0:
                continue
            if kinds.splits:
                if not known and (proposal := self._proposed(basis, steps, kinds, known)):
                    yield proposal
                v = self._nearest(kinds.splits, steps)
                for functional in reversed(kinds.splits[v]):
                    half = _without(basis, functional[None, :])
                    inside = half @ self._rng.standard_normal(half.shape[1])
                    waiting.append((half, (*steps, (v, inside))))
                continue
            if kinds.left and not self._regular:
                v = self._nearest(kinds.left, steps)
                for k in self._folds[v]:
                    if np.linalg.norm(basis[k]) > _TINY:
                        less = _without(basis, basis[k][None, :])
                        waiting.append((less, (*steps, (self._edges[k], None))))
                continue
            if proposal := self._proposed(basis, steps, kinds, known):
                yield proposal
        self.complete = not waiting

    def _proposed(
        self,
        basis: FloatArray,
        steps: Sequence[_Step],
        kinds: _Kinds,
        known: list[tuple[FloatArray, FloatArray]],
    ) -> Proposal | None:
        """A regular motion in the space, if it seems to belong to a component that is not known
        yet.
        """
        left = sorted([*kinds.left, *kinds.splits])
        dimension = basis.shape[1] - len(left)
        if dimension < 1 or (left and not self._regular):
            return None
        self._attempts += bool(left)
        if self._attempts > _MOST_ATTEMPTS or (w := self._point(basis, left)) is None:
            return None
        if any(_inside(w, b) and _inside(u, basis) for b, u in known):
            return None
        if self._regular and self._rank(w) < self._size - dimension:
            return None
        known.append((basis, w))
        taken = tuple((v, None if w is None else self._densities(w)) for v, w in steps)
        return Proposal(self._densities(w), taken, tuple(left), basis.shape[1])

    def _densities(self, w: FloatArray) -> dict[Edge, float]:
        return dict(zip(self._edges, map(float, w), strict=True))

    def _reduced(self, basis: FloatArray) -> tuple[FloatArray, tuple[int, ...], _Kinds]:
        steps: tuple[int, ...] = ()
        while True:
            kinds = self._kinds(basis)
            if not kinds.kernels:
                return basis, steps, kinds
            steps += tuple(v for v, _ in kinds.kernels)
            basis = _without(basis, np.vstack([functionals for _, functionals in kinds.kernels]))

    def _kinds(self, basis: FloatArray) -> _Kinds:
        kinds = _Kinds([], {}, [])
        self._visits += len(self._forms)
        for vertices, folds, forms in self._batches:
            rows = basis[folds]
            lengths, axes = np.linalg.eigh(rows @ rows.transpose(0, 2, 1))
            axes = axes * (lengths > 100 * _TINY**2)[:, None, :]  # axes of the local motions
            turned = axes.transpose(0, 2, 1)
            values, vectors = np.linalg.eigh(turned @ forms @ axes)
            kept = np.abs(values) > 1e-10
            for k in np.flatnonzero(kept.any(axis=1)):
                v, some = vertices[k], values[k][kept[k]]
                if (some > 0).all() or (some < 0).all():
                    kinds.kernels.append((v, vectors[k][:, kept[k]].T @ turned[k] @ rows[k]))
                elif len(some) == 2:
                    both = vectors[k][:, kept[k]].T @ turned[k] @ rows[k]
                    x, y = both * np.sqrt(np.abs(some))[:, None]
                    kinds.splits[v] = (x - y, x + y)
                else:
                    kinds.left.append(v)
        return kinds

    def _nearest(self, vertices: Iterable[int], steps: Sequence[_Step]) -> int:
        """The vertex to continue with: one with the most neighbours done, so that loops close
        early.
        """
        done = {v for v, _ in steps}
        return max(vertices, key=lambda v: (sum(u in done for u in self._near[v]), -v))

    def _point(self, basis: FloatArray, left: Sequence[int]) -> FloatArray | None:
        """A motion in the space; if forms remain, Newton's method finds it. None if it fails."""
        for _ in range(_STARTS):
            w = basis @ self._rng.standard_normal(basis.shape[1])
            w /= np.linalg.norm(w)
            if not left:
                return w
            for _ in range(40):
                values = np.array([self._value(v, w) for v in left])
                if np.abs(values).max() < 1e-14:
                    return w
                step = np.linalg.lstsq(self._jacobian(left, w) @ basis, -values, rcond=1e-10)[0]
                w = w + basis @ step
                w /= np.linalg.norm(w)
            if np.abs(values).max() < 1e-12:
                return w
        return None

    def _value(self, v: int, w: FloatArray) -> float:
        local = w[self._folds[v]]
        return float(local @ self._forms[v] @ local)

    def _jacobian(self, vertices: Sequence[int], w: FloatArray) -> FloatArray:
        jacobian = np.zeros((len(vertices), len(self._edges)))
        for k, v in enumerate(vertices):
            jacobian[k, self._folds[v]] = 2 * self._forms[v] @ w[self._folds[v]]
        return jacobian

    def _rank(self, w: FloatArray) -> int:
        jacobian = self._jacobian(list(self._forms), w) @ self._whole
        return int(np.linalg.matrix_rank(jacobian, tol=1e-7))


def in_floats(rows: Iterable[Sequence[Entry]]) -> FloatArray:
    """Rows of exact numbers in floating point."""
    return np.array([[float(x) if x else 0.0 for x in row] for row in rows])


def _without(basis: FloatArray, functionals: FloatArray) -> FloatArray:
    """A basis of the subspace on which functionals of the parameters vanish."""
    _, values, right = np.linalg.svd(functionals, full_matrices=True)
    kept: FloatArray = right[int((values > _TINY).sum()) :]
    return basis @ kept.T


def _inside(w: FloatArray, basis: FloatArray) -> bool:
    return bool(np.linalg.norm(w - basis @ (basis.T @ w)) < 1e-6)
