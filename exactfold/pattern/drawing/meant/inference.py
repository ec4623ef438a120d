"""From the decimals of a drawing to exact relations between the angles of its edges."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from math import pi

from exactfold.pattern.drawing.meant.accepted import Accepted
from exactfold.pattern.drawing.meant.drawn import NEAR, Drawn
from exactfold.pattern.drawing.meant.grids import add_distant
from exactfold.pattern.drawing.meant.local import equal_sectors, local_relations
from exactfold.pattern.drawing.meant.noise import Noise, last_digit, noise_level
from exactfold.pattern.drawing.meant.system import System
from exactfold.pattern.drawing.meant.values import Angles, Edge, Relation


@dataclass(frozen=True)
class Inference:
    """The relations that a drawing nearly has, and what follows from them.

    `noise` is the noise level, as a length over the size; it is 0 if nothing is missed narrowly.
    `clear` is the next larger defect, and `gap` is `clear` over `noise`. `chance` is the number of
    relations that are expected by chance. `near` are the relations that the digits miss narrowly,
    and `relations` are those that hold in the meant sheet, including all that hold exactly as
    written; `independent` counts how many of them do not follow from others. `angles` are None if
    nothing was inferred; then `reason` says why, and it is empty if nothing is near. `implied` maps
    a relation that was deleted to relations that imply it all the same.
    """

    noise: float
    clear: float
    chance: float
    near: tuple[Relation, ...] = ()
    relations: tuple[Relation, ...] = ()
    independent: int = 0
    angles: Angles | None = None
    reason: str = ""
    implied: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    @property
    def gap(self) -> float:
        """How many times the noise anything else is off."""
        return self.clear / self.noise if self.noise else float("inf")


def infer(
    points: Sequence[tuple[Fraction, Fraction]],
    edges: Collection[Edge],
    border: Collection[Edge],
    *,
    unit: int | None = None,
) -> Inference:
    """The relations of the sheet that was meant by a drawing.

    `points` are the coordinates as written, `edges` all edges (i, j) of the sheet, and `border`
    those on its boundary.
    """
    drawn = Drawn(points, tuple(sorted(edges)), frozenset(border))
    found, densities = local_relations(drawn)
    beyond = NEAR * min(drawn.lengths.values())
    level = noise_level(
        [(relation.defect, density) for relation, density in found],
        densities,
        last_digit(points, drawn.size),
        beyond,
    )
    local = [relation for relation, _ in found]
    if level is None:
        return Inference(0.0, beyond, 0.0)
    near = sorted((r for r in local if r.defect), key=lambda r: r.defect)[: level.near]
    if level.reason:
        return Inference(level.eps, level.clear, level.chance, tuple(near), reason=level.reason)
    return _solved(drawn, level, [r for r in local if r.defect <= level.tolerance], near, unit)


def _solved(
    drawn: Drawn,
    level: Noise,
    relations: Sequence[Relation],
    near: Sequence[Relation],
    unit: int | None,
) -> Inference:
    accepted = Accepted(drawn, level.tolerance)
    accepted.add(relation for relation in relations if relation.kind != "kawasaki")
    add_distant(accepted, unit)
    accepted.add(relation for relation in relations if relation.kind == "kawasaki")
    accepted.believe(list(equal_sectors(accepted)))
    return Inference(
        level.eps,
        level.clear,
        level.chance + accepted.chance,
        tuple(near),
        tuple(accepted.relations),
        accepted.system.rank,
        _angles(drawn, accepted.system),
    )


def _angles(drawn: Drawn, system: System[Edge]) -> Angles:
    """The edge angles, with values of the free angles that fit the drawing best."""
    sums = {edge: system.expression(edge) for edge in drawn.edges}
    free = sorted({edge for terms, _ in sums.values() for edge in terms})
    number = {edge: k for k, edge in enumerate(free)}
    coefficients = {
        edge: tuple(sorted((number[f], factor) for f, factor in terms.items()))
        for edge, (terms, _) in sums.items()
    }
    constants = {edge: constant for edge, (_, constant) in sums.items()}
    values = _fitted(drawn, constants, coefficients, [drawn.angles[edge] for edge in free])
    return Angles(constants, coefficients, values, tuple(free))


def _fitted(
    drawn: Drawn,
    constants: Mapping[Edge, Fraction],
    coefficients: Mapping[Edge, Sequence[tuple[int, Fraction]]],
    start: Sequence[float],
) -> tuple[float, ...]:
    """Free angles near `start` with the least sum of squares of length times turn of an edge."""
    if not start:
        return ()
    import numpy as np
    from scipy.sparse import csc_array
    from scipy.sparse.linalg import spsolve

    entries, off = [], []
    for row, (edge, terms) in enumerate(coefficients.items()):
        weight = drawn.lengths[edge]
        angle = float(constants[edge]) * pi + sum(float(f) * start[k] for k, f in terms)
        off.append(weight * (drawn.angles[edge] - angle))
        entries += [(weight * float(factor), row, k) for k, factor in terms]
    data, rows, columns = zip(*entries, strict=True)
    matrix = csc_array((data, (rows, columns)), shape=(len(off), len(start)))
    step = spsolve(matrix.T @ matrix, matrix.T @ np.array(off))
    return tuple((np.array(start) + step).tolist())
