"""Which leaves extend to true motions, and whether there are no others (docs/panels.md, 5)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import product
from typing import Any

from ..core.intervals import Interval
from ..core.reading import integer, items, keys, keys_of, natural, require
from ..sheets.panels import Edge, PanelSheet, pair
from .claims import LeafClaim
from .cones import cone_motions
from .isolated import isolated_ways
from .loops import Loops
from .modes import Modes, Support
from .motions import Motion, folds_of
from .reduction import BITS, enclosed, outside, reduced
from .signs import Place
from .spaces import Leaf, Spaces

MOST_POINTS = 4
"""So many motions of a component are tried to show that it folds."""

Component = tuple[Leaf, tuple[list[Place], ...]]
"""A leaf, and for each of its parts motions of the component, if several forms are left on it."""
LeafKind = tuple[tuple[Edge, ...], int, tuple[int, ...]]


@dataclass
class PartComponents:
    """The components of a part, as {dimension: number}.

    `second` counts the components to second order. `true` counts those of the true motions, or is
    None if they are not known. `folds` says whether some component is proved to fold.
    """

    second: dict[int, int]
    true: dict[int, int] | None
    folds: bool


def verified_part(sheet: PanelSheet, near: Mapping[int, list[int]], given: Any) -> PartComponents:
    """Find the components of a part again, and compare them with the entry in the file.

    For each kind of leaf (its folds, dimension and cones) the file says how many leaves there are,
    and how many of these extend to true motions. "complete" claims that there are no other true
    motions.
    """
    what = f"the part of vertex {next(iter(near))}"
    spaces = Spaces(sheet, near)
    if "isolated" in given:
        return _all_isolated(spaces, given, what)
    by_kind: dict[LeafKind, list[Component]] = {}
    leaves = spaces.leaves()
    for leaf in leaves:
        found = components(spaces, leaf, leaves)
        by_kind.setdefault((leaf.folds, leaf.dimension, leaf.cones), []).extend(found)
    claimed = dict(_kinds(given["leaves"]))
    require(len(claimed) == len(given["leaves"]), f"{what} has leaves of one kind twice")
    require(claimed.keys() == by_kind.keys(), f"{what} has other leaves than those listed")
    second: dict[int, int] = {}
    folding = 0
    for kind, (number, extending) in claimed.items():
        found = by_kind.get(kind, [])
        require(number == len(found), f"{what} has {len(found)} leaves of a kind, not {number}")
        shown = sum(extends(spaces, *one) for one in found) if extending else 0
        folds = f"{what}: {shown} leaves of a kind are proved to fold, not {extending}"
        require(extending <= shown, folds)
        second[kind[1]] = second.get(kind[1], 0) + number
        folding += extending
    second = second or {0: 1}
    true = None
    require(type(given["complete"]) is bool, f'{what}: "complete" is neither true nor false')
    if given["complete"]:
        total = sum(number for number, _ in claimed.values())
        require(folding == total, f"{what} has leaves that are not proved to fold")
        regular = complete(spaces, [leaf for found in by_kind.values() for leaf, _ in found])
        require(regular, f"{what} may have other true motions")
        true = second
    return PartComponents(second, true, folding > 0)


def _all_isolated(spaces: Spaces, given: Any, what: str) -> PartComponents:
    """The components of a part whose ways are all isolated; each extends to true motions."""
    folds, full, number = isolated_ways(spaces, given["isolated"])
    kinds = [((folds, 1, full), (number, number))] if number else []
    require(list(_kinds(given["leaves"])) == kinds, f"{what} has other ways than those listed")
    require(given["complete"] is True, f"{what} has isolated ways, so that these are complete")
    counts = {1: number} if number else {0: 1}
    return PartComponents(counts, counts, number > 0)


def _kinds(given: Any) -> Iterable[tuple[LeafKind, tuple[int, int]]]:
    for entry in items(given, "leaves"):
        keys(entry, keys_of(LeafClaim), "a leaf")
        ends = [items(fold, "a fold", 2) for fold in items(entry["folds"], "folds")]
        folds = tuple((integer(i), integer(j)) for i, j in ends)
        cones = tuple(natural(v, "a vertex") for v in items(entry["cones"], "cones"))
        numbers = natural(entry["number"], "number"), natural(entry["extending"], "extending")
        yield (folds, natural(entry["dimension"], "dimension"), cones), numbers


def components(spaces: Spaces, leaf: Leaf, leaves: Sequence[Leaf]) -> list[Component]:
    """The components of a leaf, each with motions on each part with several forms.

    If there are several, each has a motion that lies in the space of no other leaf, so that it lies
    in no other component. Refused are leaves of which not all components are known.
    """
    parts = spaces.parts(leaf.basis)
    known: list[list[list[Place]]] = []
    for part in parts:
        cones = _cones(spaces, part, leaf)
        known.append([[]] if len(cones) < 2 else cone_motions(spaces, part, cones))
        vertices = ", ".join(map(str, cones))
        shown = f"the zeros of the forms of vertices {vertices} may be other components"
        require(bool(known[-1]), shown)
    found: list[Component] = [(leaf, each) for each in product(*known)]
    for _, each in found if len(found) > 1 else ():
        place: Place = {}
        for part, motions in zip(parts, each, strict=True):
            cones = _cones(spaces, part, leaf)
            if cones:
                place |= (motions or next(iter(cone_motions(spaces, part, cones)), [{}]))[0]
            else:
                place |= enclosed(_sum(spaces, part))
        for other in leaves:
            apart = other is leaf or outside(place, other.basis, spaces.work)
            require(apart, "a component of a leaf may lie in another leaf")
    return found


def _cones(spaces: Spaces, part: list[Motion], leaf: Leaf) -> list[int]:
    """The vertices of a part whose forms are left as cones."""
    active = {v for fold in folds_of(part) for v in spaces.at(fold)}
    return [v for v in leaf.cones if v in active]


def extends(spaces: Spaces, leaf: Leaf, motions: Sequence[list[Place]] = ()) -> bool:
    """Whether a leaf is proved to be tangent to true motions.

    Its parts fold independently of each other. A part that consists of all local motions of one
    vertex folds by Morse's lemma. A part with a point at which all closing conditions are
    independent folds by the implicit function theorem. A part with one parameter, and with two or
    four active folds at each vertex, is a mode; it folds if its loops close. `motions` are those of
    `components`, by which one component of the leaf is meant.
    """
    parts = spaces.parts(leaf.basis)
    known = zip(parts, motions or [[]] * len(parts), strict=True)
    return all(_folds(spaces, part, _cones(spaces, part, leaf), some) for part, some in known)


def _folds(
    spaces: Spaces, part: list[Motion], cones: list[int], motions: Sequence[Place] = ()
) -> bool:
    folds = set(folds_of(part))
    near = spaces.sheet.only(spaces.near, folds)
    plain = max(near) < len(spaces.sheet.points)
    if plain and len(near) == 1 and len(part) == len(folds) - 2:
        return True
    inner = Spaces(spaces.sheet, near, spaces.work)
    forms = inner if near.keys() >= {*cones} else spaces
    points = list(motions) or [enclosed(_sum(inner, part))]
    if cones and not motions:
        points = [place for places in cone_motions(forms, part, cones) for place in places]
    if any(_independent(inner, point) for point in points[:MOST_POINTS]):
        return True
    if cones:
        return False
    if not plain:
        return len(part) == 1 and close_always(inner, part[0])
    if len(part) != 1 or any(len(around) > 4 for around in near.values()):
        return False
    return _closes(spaces.sheet, near, part[0])


def close_always(spaces: Spaces, motion: Motion) -> bool:
    """Whether all vertices and holes close for every T if tau = T w (docs/panels.md, 7).

    The turn about the line (x, y, m) is the dual quaternion 1 + tau (x i + y j + m eps k), and the
    vector parts of their product, without eps and with it, must be 0.
    """
    zero, one = spaces.sheet.tower.number(0), spaces.sheet.tower.number(1)
    for lines in spaces.sheet.rounds(spaces.near):
        total = [[one, *[zero] * 7]]
        for fold, line in lines:
            p, q, r = (motion[fold] * x for x in line)
            spaces.work.count(20 * len(total), motion[fold])
            turned = []
            for s, a, b, c, t, d, e, f in total:
                turned.append(
                    [
                        *(-a * p - b * q, s * p - c * q, s * q + c * p, a * q - b * p),
                        *(-d * p - e * q - c * r, t * p - f * q + b * r),
                        *(t * q + f * p - a * r, d * q - e * p + s * r),
                    ]
                )
            rows = zip([*total, [zero] * 8], [[zero] * 8, *turned], strict=True)
            total = [[u + v for u, v in zip(low, high, strict=True)] for low, high in rows]
        if any(x.sign() for row in total for x in (*row[1:4], *row[5:])):
            return False
    return True


def _closes(sheet: PanelSheet, near: Mapping[int, list[int]], motion: Motion) -> bool:
    """Whether the mode of a motion closes its loops.

    Intervals exclude all other modes on the same folds, so that the remaining one is the mode.
    """
    modes = Modes(sheet, near)
    support = modes.support({v: frozenset(around) for v, around in near.items()})
    rows = [row for row in modes.listed(support) if _agrees(modes, support, row, motion)]
    loops = Loops(modes)
    return len(rows) == 1 and all(loops.closes(rows[0], loop) for loop in support.loops)


def _agrees(modes: Modes, support: Support, row: dict[int, int], motion: Motion) -> bool:
    """Whether intervals allow the quotients of the densities to be those of a mode."""
    for v, around in support.active.items():
        first, *others = sorted(around)
        for u in others:
            start, end = (pair(v, w) for w in (first, u))
            quotient = (motion[end] / motion[start]).enclosed(BITS)
            if (quotient - modes.gain(v, row[v], first, u).enclosed(BITS)).sign():
                return False
    return True


def complete(spaces: Spaces, leaves: list[Leaf]) -> bool:
    """Whether the leaves that extend are proved to be all true motions.

    This holds in three cases. The part has one vertex only. Or each leaf is a line, and there the
    derivatives of all forms vanish on this line alone, in the space of first-order motions. Or one
    leaf is the whole space of first-order motions, with the form of every vertex that has a form,
    and the first-order conditions are independent.
    """
    alone = len(spaces.near) == 1 and max(spaces.near) < len(spaces.sheet.points)
    if alone or all(_regular(spaces, leaf) for leaf in leaves):
        return True
    whole = [leaf for leaf in leaves if len(leaf.basis) == len(spaces.first_order)]
    full = [v for v in spaces.near if spaces.sheet.numbers(v, spaces.near)[1]]
    return bool(whole) and sorted(whole[0].cones) == sorted(full) and _all_count(spaces)


def _all_count(spaces: Spaces) -> bool:
    """Whether the first-order conditions are independent.

    Each vertex has two conditions. A vertex with a straight pair has one, and it has no form.
    """
    sheet = spaces.sheet
    folds = {sheet.fold(v, u) for v, around in spaces.near.items() for u in around}
    number = sum(sheet.numbers(v, spaces.near)[0] for v in spaces.near)
    return len(spaces.first_order) == len(folds) - number


def _regular(spaces: Spaces, leaf: Leaf) -> bool:
    if len(leaf.basis) != 1:
        return False
    return _rank(spaces, enclosed(leaf.basis[0])) >= len(spaces.first_order) - 1


def _sum(spaces: Spaces, part: list[Motion]) -> Motion:
    """A motion of a part: once the first basis vector, plus twice the second, and so on."""
    total: Motion = {}
    for weight, motion in enumerate(part, 1):
        total = spaces.plus(total, spaces.sheet.tower.number(weight), motion)
    return total


def _independent(spaces: Spaces, point: Place) -> bool:
    """Whether the first-order conditions, and the derivatives of all forms at a motion, are
    independent."""
    full = [v for v in spaces.near if spaces.sheet.numbers(v, spaces.near)[1]]
    if not _all_count(spaces):
        return False
    if any(len(spaces.near[v]) < 4 and v < len(spaces.sheet.points) for v in full):
        return False
    return _rank(spaces, point) == len(full)


def _rank(spaces: Spaces, place: Place) -> int:
    """A lower bound, by intervals, of the rank of the derivatives of all forms at a point."""
    basis = [enclosed(motion) for motion in spaces.first_order]
    rows = []
    for v in spaces.near:
        weights = spaces.gradient(v, place, BITS)
        row = {}
        for k, motion in enumerate(basis):
            terms = (weights[fold] * motion[fold] for fold in weights.keys() & motion.keys())
            spaces.work.count(len(weights), None)
            row[k, k] = sum(terms, start=Interval.of(Fraction(0), BITS))
        rows.append(row)
    return len(reduced(rows, spaces.work))
