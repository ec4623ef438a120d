"""Decides whether torques can drive one way of rigid panels and no other (Tachi and Hull).

The criterion and its proof are in docs/actuation.md, 8.
"""

from __future__ import annotations

from collections.abc import Sequence

from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED, Verdict
from exactfold.design.actuation.orthogonal import independent_rows
from exactfold.design.actuation.panels.motions import Way, WayMotions
from exactfold.exact.linalg import rank
from exactfold.exact.surds import Surd
from exactfold.panels.modes.densities import Roots


def decide_self_folding(motions: WayMotions, way: Way) -> tuple[Verdict, str]:
    """Whether some torques do work on every motion of the way, and none on the other ways.

    It is so if and only if no motion of the way is a sum of multiples of motions that only other
    ways have. Intervals decide this by ranks where they can, and otherwise it is decided exactly.

    >>> from exactfold.branches.counting.ways import count_ways
    >>> motions = WayMotions.of(count_ways("miura"))
    >>> decide_self_folding(motions, motions.ways[0])[0]
    <Verdict.REFUTED: 'refuted'>
    """
    others = rival_motions(motions, way)
    verdicts = []
    for part in {motions.part(place) for place in way.motions}:
        if part is not None:  # no other motion bends a fold that is in no condition
            own = [place for place in way.motions if motions.part(place) == part]
            beside = [place for place in others if motions.part(place) == part]
            verdicts += _outside(motions, part, own, beside)
    if REFUTED in verdicts:
        if motions.by_structure or (motions.is_complete and way.dimension == 1):
            return REFUTED, _why(others)
        return UNDECIDED, "the motions of other ways span it, but they may have ways in common"
    if not motions.is_complete:
        return UNDECIDED, motions.unknown
    if UNDECIDED in verdicts:
        return (
            UNDECIDED,
            "the fold angles of the ways are not known exactly, or need too many square roots",
        )
    return PROVED, "some torques do work on this way and on no other"


def rival_motions(motions: WayMotions, way: Way) -> list[int]:
    """The places of the motions of other ways that the way itself does not have."""
    places = {place for other in motions.ways for place in other.motions}
    return sorted(places.difference(way.motions))


def _why(others: Sequence[int]) -> str:
    return (
        "torques that do no work on the other ways do none on this one: the "
        f"{len(others)} motions of the other ways span it"
    )


def _outside(
    motions: WayMotions, part: int, own: Sequence[int], beside: Sequence[int]
) -> list[Verdict]:
    """Whether each of the motions `own` of a part is no sum of multiples of those `beside`."""
    known = independent_rows(motions.directions, beside)
    basis = [] if known is None else known[0]
    if len(basis) == motions.spans[part]:
        return [REFUTED] * len(own)
    if len(basis) == len(beside):
        more = [independent_rows(motions.directions, [*beside, place]) for place in own]
        if all(rows is not None and len(rows[0]) > len(basis) for rows in more):
            return [PROVED] * len(own)
    vectors = _vectors(motions, [*beside, *own])
    if vectors is None:
        return [UNDECIDED] * len(own)
    rest = [vectors[k] for k in beside]
    below = _rank(rest)
    if below == len(basis):
        rest = [vectors[k] for k in basis]
    return [PROVED if _rank([*rest, vectors[k]]) > below else REFUTED for k in own]


def _vectors(motions: WayMotions, places: Sequence[int]) -> dict[int, list[Surd]] | None:
    """The exact densities of motions in one field; None if they need too many square roots."""
    roots = Roots(motions.pattern.field)
    rows = {place: motions.motions[place].densities(roots) for place in places}
    folds = sorted({fold for row in rows.values() if row is not None for fold in row})
    zero, vectors = roots.field.number(0), {}
    for place, row in rows.items():
        if row is None or any(density.factors for density in row.values()):
            return None
        vectors[place] = [roots.field.number(row[e].base) if e in row else zero for e in folds]
    return vectors


def _rank(vectors: Sequence[Sequence[Surd]]) -> int:
    """The rank over the field: that over Q of all multiples by products of its roots, divided by
    the number of these products.
    """
    if not vectors:
        return 0
    field = vectors[0][0].field
    size = field.dimension
    rows = []
    for k in range(size):
        product = Surd(field, [int(j == k) for j in range(size)])
        rows += [[c for x in vector for c in (x * product).coefficients] for vector in vectors]
    return rank(rows) // size
