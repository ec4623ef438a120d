"""The parts of a sheet whose ways are isolated, with their zeros, and the relations of the others.

A part whose m vertices have four folds or more each, and 3 m + 1 folds together, has as many
conditions as unknowns. If it has 2^m simple zeros, these are all motions (docs/panels.md, Isolated
ways). With more folds its ways are families; with fewer, it folds only if loops close.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from exactfold._support.arrays import ComplexArray
from exactfold.branches.values.branch import Branch
from exactfold.design.tolerance.closing import Closing, closings
from exactfold.design.tolerance.gradients import Gradients
from exactfold.design.tolerance.shape import turning_radius
from exactfold.errors import NotCountedError
from exactfold.exact.surds import sign
from exactfold.motion.panels.followable import PanelMode
from exactfold.motion.panels.listing import PanelWay
from exactfold.panels.decomposition import groups_of
from exactfold.panels.result import Decomposition, Part
from exactfold.panels.spaces.subspaces import Leaf
from exactfold.panels.vertex.stars import Star, bracket, star_at, stars
from exactfold.pattern.opening import panels
from exactfold.pattern.panel_pattern import Edge, PanelPattern
from exactfold.solve.certify.float_balls import Mids

_MOST = 1 << 24
"""The most entries of a tensor for one zero."""


@dataclass(frozen=True, eq=False)
class TrackedPart:
    """A part with isolated ways: its conditions and its zeros, as gradients with shape (B, 2R).

    `names` say of each zero which way it is; it is empty for zeros that are not real. `of_way` are
    the zeros on the way that was asked for, or all. If `is_complete`, there are no other zeros.
    """

    conditions: Gradients
    zeros: Mids
    names: tuple[str, ...]
    of_way: tuple[int, ...]
    is_complete: bool


def branch_part(branches: Sequence[Branch]) -> TrackedPart:
    """The only part of a triangulated sheet with four corners, and its branches as zeros."""
    pattern = branches[0].pattern
    inside = pattern.rigid_vertices
    flat = [fold for fold in pattern.folds if inside.intersection(fold)]
    sheet = panels(pattern)
    conditions = _conditions(sheet, stars(sheet, flat))
    zeros = []
    for branch in branches:
        bounds = branch.fold_angles.densities
        known = {fold: float(sum(bounds[fold])) for fold in conditions.folds}
        zeros.append(conditions.from_densities(known).real)
    return TrackedPart(
        conditions,
        conditions.newton(np.array(zeros), conditions.points),
        tuple(f"branch {branch.sign_text}" for branch in branches),
        tuple(range(len(branches))),
        len(branches) == 1 << len(conditions.vertices),
    )


def _conditions(sheet: PanelPattern, moving: Mapping[int, Star]) -> Gradients:
    conditions = Gradients.of(sheet, moving)
    if conditions.size**3 > _MOST:
        raise NotCountedError(
            f"{len(conditions.vertices)} vertices move together: exactfold bounds how far they may "
            "move only if there are at most about 60"
        )
    return conditions


@dataclass(frozen=True)
class PanelParts:
    """The parts of a sheet of rigid panels.

    `closings` are the relations that ways need, each with the number of its first way. `guard` is a
    radius within which the folds that cannot fold stay so, `guards` has one for moves of each
    vertex alone. `unknown` says why not all ways are followed.
    """

    tracked: tuple[TrackedPart, ...]
    closings: tuple[tuple[int, Closing], ...]
    guard: float
    guards: Mapping[int, float]
    unknown: str


def panel_parts(
    result: Decomposition, ways: Sequence[PanelWay], chosen: PanelWay | None
) -> PanelParts:
    """The parts of a decomposition, with the zeros of its ways or of the chosen one.

    Raises `NotCountedError` if a part has families of motions.
    """
    pattern = result.pattern
    moving = stars(pattern, result.held)
    named: dict[int, int] = {}
    for way in reversed(ways):
        named.update({id(space): way.number for space in way.spaces})
        named.update({-mode.number: way.number for mode in way.modes})
    modes = {mode.number: mode for way in ways for mode in way.modes}
    wanted = ways if chosen is None else (chosen,)
    numbers = {mode.number for way in wanted for mode in way.modes}
    spaces = [space for way in wanted for space in way.spaces]
    by_group = {part.vertices: part for part in result.parts}
    tracked: list[TrackedPart] = []
    relations: list[tuple[int, Closing]] = []
    unknown = ""
    for group in groups_of(moving):
        around = {v: moving[v] for v in group}
        part = by_group[group]
        here = [modes[k] for k in sorted(modes) if modes[k].vertices[0] in around]
        ours = [mode for mode in here if mode.number in numbers]
        leaves = [leaf for leaf in spaces if set(leaf.folds) & _folds(around)]
        if chosen is not None and not ours and not leaves:
            continue
        excess = len(_folds(around)) - 3 * len(around)
        full = all(len(star.folds) > 2 for star in around.values())
        if full and excess > 1:
            _refuse_families(group, excess)
        found = [(named[-mode.number], one) for mode in ours for one in closings(mode)]
        relations += found
        if found:
            continue
        if not full or excess < 1:
            unknown = unknown or (
                f"the part of the sheet with vertex {group[0]} has more conditions than unknowns, "
                "and none of its ways is spanned by modes"
            )
            continue
        one = _tracked(pattern, around, part, here, named, ours, leaves, chosen is None)
        if chosen is None and not one.is_complete:
            unknown = unknown or (
                f"not all complex motions of the part of the sheet with vertex {group[0]} are "
                f"listed as isolated ways{': ' + part.reason if part.reason else ''}"
            )
        tracked.append(one)
    guard, guards = _guards(pattern, result.held)
    return PanelParts(tuple(tracked), tuple(relations), guard, guards, unknown)


def _folds(around: Mapping[int, Star]) -> set[Edge]:
    return {fold for star in around.values() for fold in star.folds}


def _refuse_families(group: Sequence[int], excess: int) -> None:
    raise NotCountedError(
        f"the part of the sheet with vertex {group[0]} folds in families of at least {excess} "
        "dimensions, in which letters change with the motion: a tolerance is known for isolated "
        "ways"
    )


def _tracked(
    pattern: PanelPattern,
    around: Mapping[int, Star],
    part: Part,
    here: Sequence[PanelMode],
    named: Mapping[int, int],
    ours: Sequence[PanelMode],
    leaves: Sequence[Leaf],
    everything: bool,
) -> TrackedPart:
    conditions = _conditions(pattern, around)
    zeros: list[ComplexArray] = []
    names: list[str] = []
    wanted: list[int] = []

    def add(densities: Mapping[Edge, complex], name: str, of_way: bool) -> None:
        if of_way:
            wanted.append(len(zeros))
        known = {fold: densities.get(fold, 0.0) for fold in conditions.folds}
        zeros.append(conditions.from_densities(known))
        names.append(name)

    for mode in here:
        bent = {fold: density.approx for fold, density in mode.densities.items()}
        add(bent, f"way {named[-mode.number]}", everything or mode in ours)
    listed = [leaf for leaf in part.spaces if id(leaf) in named]
    for leaf in listed:
        if leaf.motion or leaf.size == 1:
            mine = everything or any(leaf is one for one in leaves)
            add(_line(leaf), f"way {named[id(leaf)]}", mine)
    real = len(zeros)
    if part.isolated is not None and listed:
        for box in part.isolated.nonreal:
            known = [complex(x, y) / 2**box.bits for x, y in zip(box.real, box.imag, strict=True)]
            chart = part.isolated.chart
            last = 1 - sum(c * z for c, z in zip(chart, known, strict=False))
            parameters = [*known, last / chart[-1]]
            add(_at(listed[0], parameters), "", everything)
    number = real + 2 * (len(zeros) - real)
    whole: ComplexArray = np.array(zeros)
    stacked: Mids = whole.real if real == len(zeros) else whole
    return TrackedPart(
        conditions,
        conditions.newton(stacked, conditions.points),
        tuple(names),
        tuple(wanted),
        number == 1 << len(around),
    )


def _line(leaf: Leaf) -> dict[Edge, complex]:
    """The densities of one motion on a line."""
    if leaf.motion:
        return {fold: float(sum(ends)) for fold, ends in leaf.densities.items()}
    return {fold: float(row[0]) for fold, row in leaf.rows.items()}


def _at(leaf: Leaf, parameters: Sequence[complex]) -> dict[Edge, complex]:
    return {
        fold: sum((float(x) * z for x, z in zip(row, parameters, strict=True)), 0j)
        for fold, row in leaf.rows.items()
    }


def _guards(pattern: PanelPattern, held: Iterable[Edge]) -> tuple[float, dict[int, float]]:
    """Radii within which folds that cannot fold stay so, for the steps that `stars` takes.

    At a vertex with at most three folds that are not flat yet, no two of them may become one
    straight line; at a vertex with more, the sector that exceeds pi stays.
    """
    gone = set(held)
    guard, guards = float("inf"), dict.fromkeys(range(len(pattern.vertices)), float("inf"))
    points = np.array([[float(x), float(y)] for x, y in pattern.vertices])
    waiting = dict.fromkeys(pattern.interior)
    while waiting:
        v, _ = waiting.popitem()
        star = star_at(pattern, v, gone)
        kept = star.foldable()
        if len(kept) == len(star.folds):
            continue
        if kept:  # a straight pair holds the other folds flat
            return 0.0, dict.fromkeys(guards, 0.0)
        number = len(star.folds)
        ends = [sum(fold) - v for fold in star.folds]
        turns = [
            sign(bracket(d, star.directions[(k + 1) % number]))
            for k, d in enumerate(star.directions)
        ]
        # Two folds are not straight, nor are two of three; else one sector exceeds pi.
        sectors = range(min(number - 1, 1) if number < 3 else number)
        for k in sectors if number <= 3 else [turns.index(-1)]:
            a, b = ends[k], ends[(k + 1) % number]
            radius = turning_radius(points, v, a, b)
            guard = min(guard, radius)
            for u in (v, a, b):
                guards[u] = min(guards[u], radius)
        gone.update(star.folds)
        for u in ends:
            if u in pattern.stars:
                waiting[u] = None
    return guard, guards
