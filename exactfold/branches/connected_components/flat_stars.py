"""All solutions of a sheet with some stars held flat, as far as their signs matter."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import chain
from typing import Any, Final

import numpy as np
from flint import arb, ctx, fmpq
from scipy.linalg import qr

from exactfold._support.arrays import FloatArray
from exactfold._support.verdict import PROVED
from exactfold.branches.connected_components.no_zero import have_no_common_zero
from exactfold.branches.connected_components.result import Joint, PartProof, RegularPoint
from exactfold.errors import TooManyModesError
from exactfold.exact.linalg import from_fmpq
from exactfold.exact.surds import Surd, ball
from exactfold.panels.spaces.kernel import Entry, Rows, entry, first_order
from exactfold.panels.spaces.quadratics import squares_of
from exactfold.panels.spaces.regular import (
    BITS,
    Balls,
    Forms,
    parameter_folds,
    regular_point,
    truly_folds,
)
from exactfold.panels.spaces.splitting import leaves
from exactfold.panels.spaces.subspaces import Leaf, independent_parts, made_leaf, reduced
from exactfold.panels.vertex.stars import Star
from exactfold.pattern.panel_pattern import Edge
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.certify.isolation import isolate
from exactfold.solve.numeric.homotopy import homotopy

_MOST_DIMENSION: Final = 12
_MOST_STEPS: Final = 60_000
_MOST_FINITE: Final = 9
_MOST_SIGNS: Final = 7
_STARTS_A_VECTOR: Final = 24
_STEPS: Final = 40


@dataclass(frozen=True)
class FlatSolutions:
    """The signs of the nonzero solutions on some stars, while all other stars are flat.

    Every sign vector of a joint occurs, on the vertices of the stars. If `open` is empty, the signs
    of every other solution agree with one of these wherever the solution is not flat; its flat
    vertices may have any sign there.
    """

    joints: tuple[Joint, ...]
    open: str = ""
    proofs: tuple[PartProof, ...] = ()


def flat_solutions(moving: Mapping[int, Star]) -> FlatSolutions:
    """The signs of the solutions that bend only the folds of these stars.

    Semidefinite forms leave their kernels. The remaining space falls into parts that share no fold.
    A solution is a sum of solutions on parts, so its signs are those of one or more parts. A part
    with as many forms as unknowns is shown to contain no solution. A part with one form less is
    shown to contain finitely many. Other parts are split into linear spaces on which fewer forms
    remain (docs/any_border.md, How joints are decided).
    """
    rows, size = first_order(moving)
    if size > _MOST_DIMENSION:
        return FlatSolutions(
            (),
            f"its first-order motions have dimension {size}, and at most {_MOST_DIMENSION} is "
            "solved",
        )
    rows, size, _ = reduced(moving, rows, size, _MOST_STEPS)
    if not size:
        return FlatSolutions(())
    return _together(_part(moving, part) for part in _parts(moving, [made_leaf(rows, size, ())]))


def _part(moving: Mapping[int, Star], part: Leaf) -> FlatSolutions:
    """The solutions on one part. If they cannot be decided directly, the part is split."""
    solutions = _decided(moving, part)
    if solutions is not None:
        return solutions
    try:
        split = leaves(moving, _entries(part), part.size, _MOST_STEPS)
    except TooManyModesError as error:
        split = []
        reason = str(error)
    else:
        reason = ""
    if not split:
        sampled = _sampled(moving, part, part) if reason else FlatSolutions(())
        return replace(sampled, open=f"{reason}; {sampled.open}") if sampled.open else sampled
    return _together(
        _decided(moving, small) or _sampled(moving, small, part) for small in _parts(moving, split)
    )


def _together(solutions_of_parts: Iterable[FlatSolutions]) -> FlatSolutions:
    joints: list[Joint] = []
    proofs: list[PartProof] = []
    reasons: dict[str, None] = {}
    for solutions in solutions_of_parts:
        joints += solutions.joints
        proofs += solutions.proofs
        if solutions.open:
            reasons[solutions.open] = None
    return FlatSolutions(tuple(joints), "; ".join(reasons), tuple(proofs))


def _parts(moving: Mapping[int, Star], split_leaves: Sequence[Leaf]) -> list[Leaf]:
    """The parts of leaves that share no fold, each once, with the vertices whose forms remain."""
    parts: dict[object, Leaf] = {}
    for leaf in split_leaves:
        for rows, size in independent_parts(_entries(leaf), leaf.size, moving):
            left = [v for v in _active(moving, rows) if squares_of(moving[v], rows, size)]
            part = made_leaf(rows, size, left)
            parts.setdefault((tuple(part.rows.items()), part.vertices), part)
    return list(parts.values())


def _active(moving: Mapping[int, Star], folds: Mapping[Edge, Any]) -> list[int]:
    return [v for v, star in moving.items() if not set(star.folds).isdisjoint(folds)]


def _decided(moving: Mapping[int, Star], part: Leaf) -> FlatSolutions | None:
    """All solutions on one part, if they are finitely many or form one line; otherwise None."""
    if not part.vertices:
        # All forms vanish, so the motions of each vertex form a line; as the part is connected,
        # all of them together form one line.
        joint = _joint(moving, _exact_balls(part), "space", exactly=part)
        return FlatSolutions((joint,)) if joint else None
    forms = _forms(moving, part)
    rows = chain(part.rows.values(), *forms)
    if any(isinstance(x, Surd) for row in rows for x in row):
        return None
    surplus = part.size - len(forms)
    if surplus <= 0:
        return FlatSolutions(()) if have_no_common_zero(forms) else None
    if surplus == 1 and part.size <= _MOST_FINITE:
        return _isolated(moving, part, forms)
    return None


def _forms(moving: Mapping[int, Star], part: Leaf) -> list[list[list[Any]]]:
    rows = _entries(part)
    return [_matrix(squares_of(moving[v], rows, part.size)) for v in part.vertices]


def _entries(part: Leaf) -> Rows:
    return {edge: [entry(x) for x in row] for edge, row in part.rows.items()}


def _matrix(squares: Sequence[tuple[Entry, Sequence[Entry]]]) -> list[list[Entry]]:
    """The matrix sum d l l^T of a form."""
    size = len(squares[0][1])
    total: list[list[Entry]] = [[fmpq(0)] * size for _ in range(size)]
    for d, functional in squares:
        for i, x in enumerate(functional):
            if x:
                for j, y in enumerate(functional):
                    if y:
                        total[i][j] = total[i][j] + d * x * y
    return total


# --- finitely many solutions ---------------------------------------------------------------------


def _isolated(
    moving: Mapping[int, Star], part: Leaf, forms: Sequence[Sequence[Sequence[Entry]]]
) -> FlatSolutions | None:
    """The solutions of m - 1 forms in m unknowns, or None.

    2^(m-1) complex lines are found in boxes; as there are no more, these are all. None if this
    fails.
    """
    size = part.size
    chart = [[Fraction(int(i == j)) for j in range(size)] for i in range(size)]
    # The last unknown is 1 - a weighted sum of the others; unequal weights miss few lines.
    weights = tuple(Fraction(3 * k + 2, 7 + k) for k in range(size - 1))
    chart[-1] = [*(-weight for weight in weights), Fraction(1)]
    system = QuadraticSystem.from_rational([_transformed(form, chart) for form in forms])
    isolation = isolate(system, homotopy(system))
    if isolation.complete is not PROVED:
        return None
    joints: list[Joint] = []
    for box in isolation.boxes:
        if box.is_real:
            x = [_between(*box.interval(k)) for k in range(size - 1)] + [arb(1)]
            parameters = [_sum(x, row) for row in chart]
            w = {edge: _sum(parameters, row) for edge, row in part.rows.items()}
            joint = _joint(moving, w, "isolated")
            if joint is None:
                return None
            joints.append(joint)
    folds = tuple(parameter_folds(part.rows, size))
    return FlatSolutions(tuple(joints), proofs=(PartProof(folds, weights, tuple(isolation.boxes)),))


def _transformed(
    form: Sequence[Sequence[Entry]], chart: Sequence[Sequence[Fraction]]
) -> list[list[Fraction]]:
    """The form T^t M T."""
    size = range(len(chart))
    matrix = [[from_fmpq(x) for x in row] for row in form]
    half = [
        [sum((matrix[i][k] * chart[k][j] for k in size), Fraction(0)) for j in size] for i in size
    ]
    return [
        [sum((chart[k][i] * half[k][j] for k in size), Fraction(0)) for j in size] for i in size
    ]


def _between(low: Fraction, high: Fraction) -> arb:
    return ball(low, BITS).union(ball(high, BITS))


def _sum(values: Sequence[arb], weights: Sequence[Any]) -> arb:
    pairs = zip(values, weights, strict=True)
    return sum((x * ball(weight, BITS) for x, weight in pairs if weight), arb(0))


# --- families of solutions -----------------------------------------------------------------------


def _sampled(moving: Mapping[int, Star], part: Leaf, whole: Leaf) -> FlatSolutions:
    """Points of a family with as many different signs as are found, each proved.

    `part` was split from the rational part `whole`, whose coordinates go into proofs.
    """
    if not part.vertices:
        return FlatSolutions(
            (), "in one solution a vertex is so nearly flat that its sign is undecided"
        )
    forms = _forms(moving, part)
    names = _active(moving, part.rows)
    wanted = 1 << len(names)
    prover = Forms(moving)
    joints: dict[tuple[int, ...], Joint] = {}
    folds, all_forms = tuple(parameter_folds(whole.rows, whole.size)), _forms(moving, whole)
    points: list[RegularPoint] = []
    tried: set[tuple[int, ...]] = set()
    lengths = {v: _lengths(moving[v]) for v in names}
    for densities in _points(part, forms, min(wanted, 1 << _MOST_SIGNS) * _STARTS_A_VECTOR):
        guess = tuple(
            -int(np.sign(sum(densities.get(e, 0.0) * length for e, length in lengths[v].items())))
            for v in names
        )
        if guess in tried or guess in joints:
            continue
        tried.add(guess)
        w = regular_point(prover, part, densities)
        joint = None if w is None else _joint(moving, w, "regular")
        if joint is not None:
            signs = tuple(joint.signs[v] for v in names)
            joints[signs] = joint
            points.append(_regular(all_forms, [densities.get(fold, 0.0) for fold in folds]))
            joints.setdefault(tuple(-sign for sign in signs), joint)
        if len(joints) == wanted:
            return FlatSolutions(tuple(joints.values()), proofs=(_witnesses(folds, points),))
    kind = "a family of solutions" if part.dimension > 0 else "a space of motions"
    return FlatSolutions(
        tuple(joints.values()),
        f"only {len(joints)} of {wanted} sign vectors were found in {kind} of dimension "
        f"{max(part.dimension, part.size)}",
        (_witnesses(folds, points),) if points else (),
    )


def _witnesses(folds: tuple[Edge, ...], points: Sequence[RegularPoint]) -> PartProof:
    return PartProof(folds, points=tuple(points))


def _regular(forms: Sequence[Sequence[Sequence[Entry]]], at: list[float]) -> RegularPoint:
    """A point, and the coordinates with respect to which the derivatives of the forms are
    independent.
    """
    tensor = np.array([[[float(x) for x in row] for row in form] for form in forms])
    tensor /= np.abs(tensor).max(axis=(1, 2), keepdims=True)
    free = qr(tensor @ np.array(at), pivoting=True, mode="r")[1][: len(forms)]
    return RegularPoint(tuple(at), tuple(sorted(int(k) for k in free)))


def _lengths(star: Star) -> dict[Edge, float]:
    pairs = zip(star.folds, star.directions, strict=True)
    return {edge: float(np.hypot(float(d[0]), float(d[1]))) for edge, d in pairs}


def _points(
    part: Leaf, forms: Sequence[Sequence[Sequence[Entry]]], count: int
) -> Iterator[Mapping[Edge, float]]:
    """Zeros of the forms in floating point, by Newton's method from random starts."""
    basis = np.array([[float(x) for x in row] for row in part.rows.values()])
    tensor = np.array([[[float(x) for x in row] for row in form] for form in forms])
    tensor /= np.abs(tensor).max(axis=(1, 2), keepdims=True)
    scale, directions = np.linalg.qr(basis)[1], np.random.default_rng(0)
    inverse = np.linalg.inv(scale)  # starts are uniform in the densities, not in the parameters
    for _ in range(count):
        p: FloatArray = inverse @ directions.normal(size=part.size)
        for _ in range(_STEPS):
            slopes = 2 * tensor @ p
            values = slopes @ p / 2
            step = np.linalg.lstsq(slopes, values, rcond=None)[0]
            p = p - step
            if np.abs(step).max() < 1e-14 * np.abs(p).max():
                break
        w = basis @ p
        if not np.isfinite(w).all() or np.abs(tensor @ p @ p).max() > 1e-10 * (p @ p):
            continue
        w /= np.abs(w).max()
        yield dict(zip(part.rows, w.tolist(), strict=True))


# --- joints --------------------------------------------------------------------------------------


def _exact_balls(part: Leaf) -> Balls:
    return {edge: ball(row[0], BITS) for edge, row in part.rows.items()}


def _joint(
    moving: Mapping[int, Star], w: Balls, by: str, *, exactly: Leaf | None = None
) -> Joint | None:
    """The joint of enclosed densities; None if some sign is undecided.

    The sign of a vertex is that of -sum_e w_e L_e over its folds (docs/branch.md, (1)).
    """
    before = ctx.prec
    ctx.prec = BITS
    try:
        signs: dict[int, int] = {}
        for v, star in moving.items():
            total, flat = arb(0), True
            for edge, (x, y) in zip(star.folds, star.directions, strict=True):
                if edge in w:
                    flat = False
                    total -= w[edge] * (ball(x, BITS) ** 2 + ball(y, BITS) ** 2).sqrt()
            if not flat and total.contains(0):
                return None
            signs[v] = 0 if flat else (1 if total > 0 else -1)
        bounds = {edge: _bounds(x) for edge, x in w.items()}
    finally:
        ctx.prec = before
    if exactly is not None:
        for edge, row in exactly.rows.items():
            if not isinstance(row[0], Surd):
                bounds[edge] = (Fraction(row[0]), Fraction(row[0]))
    return Joint(signs, bounds, by, truly_folds(moving, w))


def _bounds(value: arb) -> tuple[Fraction, Fraction]:
    return _fraction(value.lower()), _fraction(value.upper())


def _fraction(value: arb) -> Fraction:
    mantissa, exponent = (int(x) for x in value.man_exp())
    return Fraction(mantissa) * Fraction(2) ** exponent
