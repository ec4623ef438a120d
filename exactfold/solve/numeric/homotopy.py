"""A complex total-degree homotopy for square systems of affine quadrics, in batches."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial.polynomial import polyval

from exactfold._support.arrays import BoolArray, ComplexArray, FloatArray, IntArray, inverses
from exactfold._support.progress import Steps
from exactfold.errors import UsageError
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.numeric.candidates import Candidates

_ORDER = 12
_BLOCK = 256
_SLICE = 16
_GAMMAS = 3
_AT_INFINITY = 1e-10
_SAME = 1e-9
_SINGULAR = 1e7
_NEAR_END = 0.99
_STALLED_LATE = 1e-8


@dataclass(frozen=True)
class _Tolerances:
    """The predictor's error, the first accepted correction, the shortest step, the most steps."""

    predict: float = 1e-6
    correct: float = 1e-4
    shortest: float = 1e-12
    rounds: int = 400


_TIGHT = _Tolerances(predict=1e-10, correct=1e-8, shortest=1e-14, rounds=1500)


def homotopy(
    system: QuadraticSystem, *, seed: int = 0, progress: Steps | None = None
) -> Candidates:
    """Candidates for all complex zeros of n affine quadrics, one path for each of the 2^n.

    A linear change of variables and of equations Q balances them first. In projective coordinates w
    and with random complex numbers g_p of modulus one (Sommese and Wampler, The Numerical Solution
    of Systems of Polynomials, 2005, chapters 2 and 8), the paths satisfy

        (1 - T) g_p (w_p^2 - w_0^2) + T Q_p(w) = 0   for p = 1, ..., n,   from T = 0 to T = 1.

    The predictor is a Taylor series from one inverse Jacobian per step, in the affine patch
    orthogonal to the current point. The corrector is Newton's method with the same inverse. All
    paths of a block advance together as arrays. Paths that stall or meet are followed again with
    shorter steps, and then all paths with other g_p. `progress(done, total)` counts paths. The
    result depends only on the system and `seed`.

    `points` has shape (m, n) with m <= 2^n, in the units of the unknowns. `lost` names every path
    that did not arrive: it ended at infinity, or where another path ended, or it stalled. If it
    stalled with T nearly 1, as it does at multiple zeros, its last point is still a candidate. This
    is floating point throughout: nothing here is proved, and a lost path does not mean that there
    are fewer zeros. Raises `UsageError` if the system has no unknowns.

    >>> circle_and_line_pair = QuadraticSystem.from_rational(
    ...     [[[1, 0, 0], [0, 1, 0], [0, 0, -1]], [[0, 1, 0], [1, 0, 0], [0, 0, 0]]])
    >>> candidates = homotopy(circle_and_line_pair)
    >>> sorted((int(x), int(y)) for x, y in candidates.points.real.round()), candidates.lost
    ([(-1, 0), (0, -1), (0, 1), (1, 0)], ())
    """
    if system.size == 0:
        raise UsageError("the system has no unknowns: there are no paths to follow")
    powers, plain = _equilibrate(system.float_tensor)
    scaled = _Balanced(*_operator_scaling(plain), powers, plain)
    runs: list[_Run] = []
    while len(runs) < _GAMMAS and all(run.suspicious for run in runs):
        runs.append(_run(scaled, np.random.default_rng([seed, len(runs)]), progress))
    best = max(runs, key=lambda run: run.distinct)
    settings = {"seed": seed, "gammas": len(runs), "order": _ORDER, "paths": system.bezout_number}
    counts = {"steps": best.steps, "retried": best.retried}
    points, lost = _collect(scaled, best)
    return Candidates("homotopy", points, lost, {**settings, **counts})


@dataclass(frozen=True)
class _Balanced:
    """Forms Q of shape (n, n+1, n+1) in coordinates w, where (x, 1) ~ powers * (to_y @ w)."""

    forms: FloatArray
    to_y: FloatArray
    powers: FloatArray
    plain: FloatArray  # the forms in the coordinates y = (x, 1) / powers


def _equilibrate(tensor: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Powers of two d that make all S_pij d_i d_j about equal for each p; exact in floats."""
    n, size, _ = tensor.shape
    p, i, j = np.nonzero(tensor)
    rows = np.arange(len(p))
    matrix = np.zeros((len(p), n + size))
    matrix[rows, p] = 1.0
    np.add.at(matrix, (rows, n + i), 1.0)
    np.add.at(matrix, (rows, n + j), 1.0)
    target = -np.log2(np.abs(tensor[p, i, j]))
    solution = np.linalg.lstsq(matrix, target, rcond=None)[0] if len(p) else np.zeros(n + size)
    powers = np.exp2(np.clip(np.round(solution[n:] - solution[n:].mean()), -200, 200))
    plain = tensor * powers[:, None] * powers[None, :]
    largest = np.abs(plain).max(axis=(1, 2), keepdims=True)
    exponent = np.round(np.log2(np.where(largest > 0, largest, 1.0)))
    return powers, np.asarray(plain * np.exp2(-exponent))


def _operator_scaling(forms: FloatArray, rounds: int = 30) -> tuple[FloatArray, FloatArray]:
    """(B, L) with B_p = sum_q R_pq L^T A_q L, trace-orthonormal; sum_p B_p^2 is nearly c I.

    Directions that are null for all forms are not changed.
    """
    n, size, _ = forms.shape
    change = np.eye(size)
    forms = _orthonormal(forms)
    for _ in range(rounds):
        total = np.einsum("pij,pjk->ik", forms, forms) * (size / n)
        values, vectors = np.linalg.eigh(total)
        if np.abs(values - 1.0).max() < 0.1:
            break
        half = (vectors * np.clip(values, 1e-4, 1e4) ** -0.25) @ vectors.T
        change = change @ half
        forms = _orthonormal(half @ forms @ half)
    return forms, change


def _orthonormal(forms: FloatArray) -> FloatArray:
    """The combinations of the forms that are trace-orthonormal and nearest to the forms."""
    n = len(forms)
    flat = forms.reshape(n, -1)
    u, s, vt = np.linalg.svd(flat, full_matrices=False)
    keep = s > 1e-13 * max(float(s[0]), 1e-300)
    flat = (u * keep) @ (vt * keep[:, None])
    result = flat.reshape(forms.shape)
    return np.asarray((result + result.transpose(0, 2, 1)) / 2)


@dataclass(frozen=True)
class _Run:
    """The ends of all paths: w (2^n, n+1), T, |J^-1|, and the path that each one met, or -1."""

    w: ComplexArray
    reached: FloatArray
    condition: FloatArray
    met: IntArray
    retried: int
    steps: int

    @property
    def distinct(self) -> int:
        return int(((self.reached == 1.0) & (self.met < 0)).sum())

    @property
    def suspicious(self) -> bool:
        """Whether a path failed, except at a singular end, where other g_p do not help."""
        stalled = self.reached < _NEAR_END
        jumped = (self.met >= 0) & (self.condition < _SINGULAR)
        return bool((stalled | jumped).any())


def _run(scaled: _Balanced, rng: np.random.Generator, progress: Steps | None) -> _Run:
    n = len(scaled.forms)
    tracker = _Tracker(scaled.forms, np.exp(2j * np.pi * rng.random(n)))
    probe = rng.standard_normal((2, n + 1)) + 1j * rng.standard_normal((2, n + 1))
    total = 1 << n
    w = np.empty((total, n + 1), dtype=np.complex128)
    reached, condition = np.empty(total), np.empty(total)

    def follow(paths: IntArray, tolerances: _Tolerances, report: bool) -> int:
        used = 0
        for start in range(0, len(paths), _BLOCK):
            block = paths[start : start + _BLOCK]
            w[block], reached[block], condition[block], count = tracker.track(
                _start_points(block, n), tolerances
            )
            used += count
            if report and progress is not None:
                progress(min(start + _BLOCK, total), total)
        return used

    steps = follow(np.arange(total), _Tolerances(), True)
    met = _meetings(w, reached, probe)
    doubtful = (met >= 0) | (reached < 1.0)
    doubtful[met[met >= 0]] = True
    again = np.flatnonzero(doubtful)
    if again.size:
        steps += follow(again, _TIGHT, False)
        met = _meetings(w, reached, probe)
    return _Run(w, reached, condition, met, int(again.size), steps)


def _start_points(paths: IntArray, n: int) -> ComplexArray:
    bits = (paths[:, None] >> np.arange(n)) & 1
    w = np.ones((len(paths), n + 1), dtype=np.complex128)
    w[:, :n] = 1.0 - 2.0 * bits
    return np.asarray(w / np.sqrt(n + 1.0))


def _meetings(w: ComplexArray, reached: FloatArray, probe: ComplexArray) -> IntArray:
    """For each path, the first path that ended at the same projective point; -1 if none did."""
    met = np.full(len(w), -1)
    arrived = np.flatnonzero(reached == 1.0)
    if arrived.size < 2:
        return met
    unit = w[arrived] / (w[arrived] @ probe[0])[:, None]
    order = np.argsort((unit @ probe[1]).real, kind="stable")
    unit, arrived = unit[order], arrived[order]
    size = np.linalg.norm(unit, axis=1)
    for shift in range(1, min(8, len(arrived))):
        gap = np.linalg.norm(unit[shift:] - unit[:-shift], axis=1)
        for k in np.flatnonzero(gap < _SAME * size[shift:]):
            first, second = sorted((int(arrived[k]), int(arrived[k + shift])))
            root = first if met[first] < 0 else int(met[first])
            if root != second:
                met[second] = root if met[second] < 0 else min(root, int(met[second]))
    return met


def _collect(scaled: _Balanced, run: _Run) -> tuple[ComplexArray, tuple[str, ...]]:
    """The finite points in the units of the unknowns, and a line for every lost path."""
    y = run.w @ scaled.to_y.T
    y /= np.linalg.norm(y, axis=1, keepdims=True)
    finite = np.abs(y[:, -1]) > _AT_INFINITY
    lost = []
    for k in np.flatnonzero((run.reached < 1.0) | (run.met >= 0) | ~finite):
        if run.reached[k] < 1.0:
            lost.append(f"path {k} stalled at 1 - T = {1 - run.reached[k]:.1e}")
        elif run.met[k] >= 0:
            lost.append(f"path {k} ended at the same point as path {run.met[k]}")
        else:
            lost.append(f"path {k} ended at infinity")
    keep = (run.reached > 1.0 - _STALLED_LATE) & (run.met < 0) & finite
    points = _polish(scaled.plain, y[keep, :-1] / y[keep, -1:])
    points = points * (scaled.powers[:-1] / scaled.powers[-1])
    return points, tuple(lost)


@np.errstate(all="ignore")
def _polish(forms: FloatArray, x: ComplexArray, rounds: int = 3) -> ComplexArray:
    """Newton steps in the affine chart; each step is kept only if it is short."""
    for _ in range(rounds):
        z = np.hstack([x, np.ones((len(x), 1))])
        rows = np.einsum("pij,bj->bpi", forms, z)
        values = np.einsum("bpi,bi->bp", rows, z) / 2
        step = (inverses(rows[:, :, :-1]) @ values[:, :, None])[:, :, 0]
        short = np.linalg.norm(step, axis=1) < 1e-4 * (1 + np.linalg.norm(x, axis=1))
        x = np.where(short[:, None], x - step, x)
    return x


def _times(rows: ComplexArray, matrix: ComplexArray) -> ComplexArray:
    """`rows @ matrix`, in slices too small for a threaded BLAS, which stalls on a busy machine."""
    whole = len(rows) // _SLICE * _SLICE
    result = np.empty((len(rows), matrix.shape[1]), dtype=np.complex128)
    slices = rows[:whole].reshape(-1, _SLICE, rows.shape[1])
    np.matmul(slices, matrix, out=result[:whole].reshape(len(slices), _SLICE, matrix.shape[1]))
    np.matmul(rows[whole:], matrix, out=result[whole:])
    return result


class _Tracker:
    """Follows H(w, T) = (1 - T) g (w_p^2 - w_0^2) + T Q(w) = 0; w_0 is the last coordinate."""

    def __init__(self, forms: FloatArray, gamma: ComplexArray) -> None:
        self.n = n = len(forms)
        self.gamma = gamma
        self.gradient = (2 * forms).transpose(2, 0, 1).reshape(n + 1, -1).astype(np.complex128)
        self.flat = forms.reshape(n, -1).T.astype(np.complex128).copy()

    @np.errstate(all="ignore")
    def track(
        self, w: ComplexArray, tolerances: _Tolerances
    ) -> tuple[ComplexArray, FloatArray, FloatArray, int]:
        """(w, T, |J^-1|) at the end of each path, and the number of path steps."""
        count = len(w)
        end_w, end_t, condition = w.copy(), np.zeros(count), np.full(count, np.inf)
        live = np.arange(count)
        t = np.zeros(count)
        series = self._series(w, t, inverses(self._jacobian(w, t)))
        step = self._step(series, t, tolerances)
        steps = 0
        for _ in range(tolerances.rounds):
            steps += len(live)
            target = np.where(t + step >= 1.0, 1.0, t + step)
            ends = polyval((target - t)[:, None], series, tensor=False)
            guess: ComplexArray = np.asarray(ends, dtype=np.complex128)
            inverse = inverses(self._jacobian(guess, target))
            new, good = self._correct(guess, target, inverse, tolerances)
            step = np.where(good, step, step / 2)
            if good.any():
                w = np.where(good[:, None], new, series[0])
                t = np.where(good, target, t)
                moved = np.flatnonzero(good)
                series[:, moved] = fresh = self._series(w[moved], t[moved], inverse[moved])
                step[moved] = self._step(fresh, t[moved], tolerances)
                end_w[live[moved]], end_t[live[moved]] = w[moved], t[moved]
                condition[live[moved]] = np.linalg.norm(inverse[moved], axis=(1, 2))
            going = (t < 1.0) & ((step > tolerances.shortest) | (t + step >= 1.0))
            if not going.all():
                live, t, step, series = live[going], t[going], step[going], series[:, going]
            if not live.size:
                break
        return end_w, end_t, condition, steps

    def _jacobian(self, w: ComplexArray, t: FloatArray) -> ComplexArray:
        """The matrices (dH/dw; conj(w)), of shape (count, n + 1, n + 1)."""
        n, count = self.n, len(w)
        jacobian = np.empty((count, n + 1, n + 1), dtype=np.complex128)
        rows = _times(w, self.gradient).reshape(count, n, n + 1)
        np.multiply(rows, t[:, None, None], out=jacobian[:, :n])
        start = (2 * (1 - t))[:, None] * self.gamma
        k = np.arange(n)
        jacobian[:, k, k] += start * w[:, :n]
        jacobian[:, :n, n] -= start * w[:, n:]
        jacobian[:, n] = w.conj()
        return jacobian

    def _values(self, square: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
        """The start forms and Q, as linear functions of W = w w^T (shape (count, n+1, n+1))."""
        n = self.n
        k = np.arange(n)
        start = self.gamma * (square[:, k, k] - square[:, n:, n])
        return start, _times(square.reshape(len(square), -1), self.flat)

    def _correct(
        self, w: ComplexArray, t: FloatArray, inverse: ComplexArray, tolerances: _Tolerances
    ) -> tuple[ComplexArray, BoolArray]:
        """Newton with a fixed inverse; good if the steps are short and shrink fast."""
        shift = t[:, None]
        lengths = []
        for _ in range(3):
            start, end = self._values(w[:, :, None] * w[:, None, :])
            residual = (1 - shift) * start + shift * end
            change = (inverse[:, :, :-1] @ residual[:, :, None])[:, :, 0]
            w = w - change
            lengths.append(np.linalg.norm(change, axis=1))
        first, second, third = lengths
        noise = 1e-15 * np.linalg.norm(inverse, axis=(1, 2))
        good = (first < tolerances.correct + noise) & (noise < 1e-4)
        good &= (second < 0.1 * first + noise) & (third < 0.1 * second + noise)
        return w / np.linalg.norm(w, axis=1, keepdims=True), good

    def _series(self, w: ComplexArray, t: FloatArray, inverse: ComplexArray) -> ComplexArray:
        """The Taylor coefficients of the path at (w, t), shape (order + 1, count, n + 1).

        The coefficient of s^k in H(w(t + s), t + s) = 0 is solved for w_k. `inverse` inverts the
        Jacobian at a nearby point, and one Schulz step adapts it.
        """
        jacobian = self._jacobian(w, t)
        inverse = 2 * inverse - inverse @ (jacobian @ inverse)
        count, n = len(w), self.n
        series = np.zeros((_ORDER + 1, count, n + 1), dtype=np.complex128)
        series[0] = w
        by_path = np.zeros((count, n + 1, _ORDER + 1), dtype=np.complex128)
        by_path[:, :, 0] = w
        shift = t[:, None]
        start_before, end_before = self._values(w[:, :, None] * w[:, None, :])
        start = end = np.zeros((count, n), dtype=np.complex128)
        for k in range(1, _ORDER + 1):
            if k > 1:
                inner = by_path[:, :, 1:k]
                start, end = self._values(inner @ inner[:, :, ::-1].transpose(0, 2, 1))
            right = (1 - shift) * start + shift * end + end_before - start_before
            term = -(inverse[:, :, :-1] @ right[:, :, None])[:, :, 0]
            series[k] = by_path[:, :, k] = term
            ends = by_path[:, :, : k + 1]
            start_before, end_before = self._values(ends @ ends[:, :, ::-1].transpose(0, 2, 1))
        return series

    def _step(self, series: ComplexArray, t: FloatArray, tolerances: _Tolerances) -> FloatArray:
        """The step for which the last two terms of the series are below the predictor's error."""
        last = np.linalg.norm(series[-2:], axis=2)
        lengths = (tolerances.predict / last) ** (1.0 / np.array([[_ORDER - 1], [_ORDER]]))
        return np.asarray(np.nan_to_num(np.minimum(lengths.min(axis=0), 1 - t), nan=0.0))
