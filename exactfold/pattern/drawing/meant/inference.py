"""From the decimals of a drawing to exact relations between the angles of its edges."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from math import inf, pi
from typing import Final

from exactfold.errors import UsageError
from exactfold.pattern.drawing.meant.accepted import Accepted
from exactfold.pattern.drawing.meant.drawn import NEAR, Drawn
from exactfold.pattern.drawing.meant.grids import add_distant
from exactfold.pattern.drawing.meant.local import equal_sectors, local_relations
from exactfold.pattern.drawing.meant.naming import named, stated
from exactfold.pattern.drawing.meant.noise import FINEST, last_digit, noise_level, stated_level
from exactfold.pattern.drawing.meant.system import System
from exactfold.pattern.drawing.meant.values import Angles, Edge, Kind, Relation

_NAMED: Final = 3
"""So many relations are named that contradict another one."""


@dataclass(frozen=True)
class Inference:
    """The relations that a drawing nearly has, and what follows from them.

    `noise` is the noise level, as a length over the size; it is 0 if no relation is missed
    narrowly. `clear` is the next larger defect, and `gap` is `clear` over `noise`. `chance` is the
    number of relations that are expected by chance. `near` are the straight, border and Kawasaki
    relations that the digits miss narrowly. `relations` are those that hold in the meant sheet,
    including all that hold exactly as written; `independent` counts those that do not follow from
    others. Angles on a grid are multiples of 180 / `unit` degrees. `angles` are None if nothing was
    inferred; then `reason` says why, and it is empty if nothing is near. `implied` maps a relation
    that was deleted to the relations that imply it all the same.
    """

    noise: float
    clear: float
    chance: float
    near: tuple[Relation, ...] = ()
    relations: tuple[Relation, ...] = ()
    independent: int = 0
    unit: int | None = None
    angles: Angles | None = None
    reason: str = ""
    implied: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    @property
    def gap(self) -> float:
        """How many times the noise anything else is off."""
        return self.clear / self.noise if self.noise else inf


def infer(
    points: Sequence[tuple[Fraction, Fraction]],
    edges: Collection[Edge],
    border: Collection[Edge],
    *,
    noise: float | None = None,
    unit: int | None = None,
    without: Collection[str] = (),
    also: Collection[str] = (),
    kinds_left_out: Collection[Kind] = (),
) -> Inference:
    """The relations of the sheet that was meant by a drawing.

    `points` are the coordinates as written, `edges` all edges (i, j) of the sheet, and `border`
    those on its boundary. A `noise` level, over the size of the drawing, overrules the one that is
    found, and all that makes it doubtful. `unit` forces a grid of 180 / `unit` degrees. `without`
    names relations that do not hold, and `also` relations that hold, even if nothing is near. Of
    `kinds_left_out` only those relations are taken that `also` states.

    Raises `UsageError` for a noise level or a unit that is not positive, for names of relations
    that do not exist, and for stated relations that contradict others.
    """
    if noise is not None and not 0 < noise < 1:
        raise UsageError(
            f"the noise level is a length over the size of the drawing, between 0 and 1, not "
            f"{noise:g}; a drawing without noise is read exactly as written with --snap exact"
        )
    if unit is not None and unit < 1:
        raise UsageError(f"the grid has 180 / N degrees for a positive integer N, not {unit}")
    drawn = Drawn(points, tuple(sorted(edges)), frozenset(border))
    found, densities = local_relations(drawn)
    beyond = NEAR * min(drawn.lengths.values())
    places = [(relation.defect, density) for relation, density in found]
    floor = last_digit(points, drawn.size)
    if noise is not None:
        level = stated_level(noise, places, densities, beyond)
    else:
        known = noise_level(places, densities, floor, beyond)
        if known is None and not also:
            if without:
                named((), without)
            return Inference(0.0, beyond, 0.0)
        level = known or stated_level(FINEST, places, densities, beyond)
    local = [relation for relation, _ in found]
    near = sorted((r for r in local if r.defect), key=lambda r: r.defect)[: level.near]
    plain = Inference(level.eps, level.clear, level.chance, tuple(near), reason=level.reason)
    if level.reason:
        return plain
    accepted = Accepted(drawn, level.tolerance, floor)
    exact = [relation for relation in local if relation.defect <= level.tolerance]
    accepted.add(relation for relation in exact if relation.kind != "kawasaki")
    grid = add_distant(accepted, unit)
    accepted.add(relation for relation in exact if relation.kind == "kawasaki")
    accepted.believe(list(equal_sectors(accepted)))
    plain = replace(
        plain,
        chance=level.chance + accepted.chance,
        unit=None if grid is None else grid.unit,
    )
    found_all = [*accepted.relations, *accepted.contradicting]
    deleted = named(found_all, without)
    gone = {relation.name for relation in deleted}
    gone |= {relation.name for relation in found_all if relation.kind in kinds_left_out}
    if gone or also:
        accepted = Accepted(drawn, level.tolerance, floor)
        accepted.add(relation for relation in found_all if relation.name not in gone)
    if not accepted.contradicting:
        for text in also:
            relation = stated(drawn, text, grid)
            if not accepted.has(relation):
                accepted.add([relation])
        if accepted.contradicting:
            conflict = _conflict(accepted, accepted.contradicting[0])
            raise UsageError(f"{conflict}: leave it out, or leave one of these out (--without)")
    if accepted.contradicting:
        wrong = accepted.contradicting[0]
        remedy = f"--without {wrong.name} leaves it out"
        return replace(plain, reason=f"{_conflict(accepted, wrong)}; {remedy}")
    implied = [r for r in deleted if accepted.is_implied(r.terms, r.parts)]
    return replace(
        plain,
        relations=tuple(accepted.relations),
        independent=accepted.system.rank,
        angles=_angles(drawn, accepted.system),
        implied=_reasons(accepted, implied),
    )


def _reasons(accepted: Accepted, implied: Sequence[Relation]) -> dict[str, tuple[str, ...]]:
    if not implied:
        return {}
    names = [relation.name for relation in implied]
    return dict(zip(names, accepted.reasons(implied), strict=True))


def _conflict(accepted: Accepted, relation: Relation) -> str:
    (others,) = accepted.reasons([relation])
    more = f" and {len(others) - _NAMED} more" if len(others) > _NAMED else ""
    return f"the relation {relation.name} contradicts {', '.join(others[:_NAMED])}{more}"


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
