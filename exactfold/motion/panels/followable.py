"""What a sheet of rigid panels can be followed along: elementary modes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, fields
from fractions import Fraction
from functools import cached_property
from types import MappingProxyType
from typing import Final

from exactfold._support.plurals import counted
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.errors import UsageError
from exactfold.exact.joined_fields import joined
from exactfold.exact.surds import Number, exact, sign, simple
from exactfold.panels.modes.densities import Density, Roots
from exactfold.panels.modes.extension import LINEAR, Extension, extension
from exactfold.panels.result import Decomposition, Part
from exactfold.panels.spaces.subspaces import Leaf
from exactfold.panels.vertex import holes
from exactfold.panels.vertex.holes import conditions
from exactfold.panels.vertex.local import LocalMode
from exactfold.panels.vertex.stars import Star
from exactfold.pattern.panel_pattern import Edge, PanelPattern, Point

_REASONS: Final = 3


@dataclass(frozen=True, repr=False)
class PanelMode:
    """One elementary mode of a sheet that can be followed.

    It consists of its vertices, their stars and their local modes. `number` is that of the mode in
    the table of `exactfold count`, beginning with 1; modes that are not listed there get the next
    numbers. `choice[k]` is the local mode at the vertex of `stars[k]`, and this star has only the
    active folds. `letters` gives M or V of the active folds on the side that is followed.
    """

    pattern: PanelPattern
    number: int
    stars: tuple[Star, ...]
    choice: tuple[LocalMode, ...]
    letters: Mapping[Edge, str]
    extends: Extension

    @property
    def vertices(self) -> tuple[int, ...]:
        """The active vertices."""
        return tuple(star.vertex for star in self.stars)

    @property
    def folds(self) -> tuple[Edge, ...]:
        """The active folds, sorted."""
        return tuple(sorted(self.letters))

    @cached_property
    def is_linear(self) -> bool:
        """Whether every vertex closes for every T if `tau_e = c_e T` on all folds.

        True is proved exactly. With tau = tan(angle / 2) / length, a vertex closes if and only if
        the vector part of the product of the quaternions 1 + tau_j d_j vanishes (docs/panels.md,
        All fold angles). On the line of its local mode this is a polynomial in T. It is expanded,
        and all its coefficients have to be 0. The same is done with the lines of the folds round a
        hole (`exactfold.panels.vertex.holes.closes_always`).
        """
        for star, mode in zip(self.stars, self.choice, strict=True):
            if star.hole is None:
                closes = closes_always(star.directions, mode.values)
            else:
                lines = dict(zip(star.hole.folds, star.hole.twists, strict=True))
                closes = holes.closes_always([lines[fold] for fold in star.folds], mode.values)
            if not closes:
                return False
        return True

    def order_from(self, start: Edge) -> tuple[tuple[int, Edge], ...]:
        """A walk through all vertices: positions in `stars`, each with a fold known by then.

        The walk is breadth first, from the ends of the fold `start`.
        """
        at: dict[Edge, list[int]] = {}
        for k, star in enumerate(self.stars):
            for fold in star.folds:
                at.setdefault(fold, []).append(k)
        walk: list[tuple[int, Edge]] = []
        seen: set[int] = set()
        waiting = [start]
        for fold in waiting:
            for k in at[fold]:
                if k not in seen:
                    seen.add(k)
                    walk.append((k, fold))
                    waiting += [other for other in self.stars[k].folds if other != fold]
        return tuple(walk)

    @cached_property
    def densities(self) -> Mapping[Edge, Density]:
        """Fold angle / length to first order, up to a common factor; the signs are those of
        `letters`.
        """
        return MappingProxyType(self.densities_in(Roots(self.pattern.field)))

    def densities_in(self, roots: Roots) -> dict[Edge, Density]:
        """`densities` with the square roots of `roots`, which several modes may share."""
        first = self.folds[0]
        known = {first: roots.density(Fraction(1 if self.letters[first] == "V" else -1))}
        for k, fold in self.order_from(first):
            for other in self.stars[k].folds:
                if other not in known:
                    gain = roots.density(self.choice[k].gain(fold, other))
                    known[other] = known[fold].times(gain)
        return dict(sorted(known.items()))

    def __reduce__(self) -> tuple[object, ...]:
        # Cached values are not pickled.
        return PanelMode, tuple(getattr(self, field.name) for field in fields(self))

    def __repr__(self) -> str:
        return (
            f"<PanelMode: {self.number}, {counted(len(self.stars), 'vertex')}, "
            f"{counted(len(self.letters), 'fold')}, {self.extends.verdict} by {self.extends.by}>"
        )


def panel_modes(result: Decomposition) -> tuple[PanelMode, ...]:
    """The modes of a decomposition: first those it lists, in its order, then others it contains.

    If a set of vertices has too many modes to be listed, the only known example is given. For parts
    with more than four folds at some vertex, the modes are the components of dimension one that
    close for all fold angles (`PanelMode.is_linear`).

    >>> from exactfold.panels.decomposition import decompose
    >>> from exactfold.pattern.families import single_vertex
    >>> from exactfold.pattern.opening import panels
    >>> panel_modes(decompose(panels(single_vertex(4))))[0]
    <PanelMode: 1, 1 vertex, 4 folds, proved by forest>
    """
    moving = conditions(result.pattern, result.held)
    modes: list[PanelMode] = []
    narrowed: dict[tuple[int, tuple[Edge, ...]], Star] = {}

    def star_of(mode: LocalMode) -> Star:
        key = mode.vertex, mode.folds
        if key not in narrowed:
            narrowed[key] = moving[mode.vertex].only(mode.folds)
        return narrowed[key]

    def add(
        choice: Sequence[LocalMode], letters: Mapping[Edge, str], extends: Extension
    ) -> PanelMode:
        around = tuple(star_of(mode) for mode in choice)
        number = len(modes) + 1
        return PanelMode(result.pattern, number, around, tuple(choice), dict(letters), extends)

    for mode in result.modes:
        modes.append(add(mode.choice, mode.assignment, mode.extends))
    for part in result.parts:
        for choice in _examples(part):
            extends = extension(result.pattern, moving, choice)
            modes.append(add(choice, _letters(choice), extends))
        for leaf in _lines(part):
            line = line_mode(result, leaf, moving, len(modes) + 1)
            if line.is_linear:
                modes.append(line)
    return tuple(modes)


def line_mode(
    result: Decomposition, leaf: Leaf, moving: Mapping[int, Star], number: int = 0
) -> PanelMode:
    """The motions on a space with one parameter as a mode, which folds if it `is_linear`."""
    choice = _on_line(leaf, moving)
    around = tuple(moving[mode.vertex].only(mode.folds) for mode in choice)
    extends = Extension(PROVED, LINEAR)
    return PanelMode(result.pattern, number, around, choice, _letters(choice), extends)


def closes_always(directions: Sequence[Point], values: Sequence[Number]) -> bool:
    """Whether a vertex closes exactly with tau_j = T values[j] for every T.

    It does if the vector part of prod_j (1 + T values[j] d_j), a quaternion of polynomials in T, is
    0.

    >>> closes_always(((1, 0), (0, 1), (-1, 0), (0, -1)), (1, 0, 1, 0))
    True
    >>> closes_always(((1, 0), (0, 1), (-1, 0), (0, -1)), (1, 1, 1, 1))
    False
    """
    [*coordinates, weights] = joined([*zip(*directions, strict=True), values])
    product: list[list[Number]] = [[1, 0, 0, 0]]
    for x, y, weight in zip(*coordinates, weights, strict=True):
        p, q = weight * x, weight * y
        turned = [
            [-a * p - b * q, s * p - c * q, s * q + c * p, a * q - b * p] for s, a, b, c in product
        ]
        zero: list[Number] = [0, 0, 0, 0]
        product = [
            [u + v for u, v in zip(one, other, strict=True)]
            for one, other in zip([*product, zero], [zero, *turned], strict=True)
        ]
    return all(part == 0 for quaternion in product for part in quaternion[1:])


def _examples(part: Part) -> Iterable[tuple[LocalMode, ...]]:
    """One mode of each set of vertices whose modes are not listed."""
    listed = {mode.active for mode in part.modes}
    return (s.example for s in part.supports if s.vertices not in listed and s.example)


def _lines(part: Part) -> list[Leaf]:
    """The components of dimension one of a part with more than four folds at a vertex."""
    lines: list[Leaf] = []
    for leaf in (*part.spaces, *(one.leaf for one in part.found)):
        if leaf.size == 1 and not leaf.vertices and not any(_same(leaf, one) for one in lines):
            lines.append(leaf)
    return lines


def _same(one: Leaf, other: Leaf) -> bool:
    """Whether two lines have the same densities; their numbers may lie in different fields."""
    if one.rows.keys() != other.rows.keys():
        return False
    these, those = joined([[leaf.rows[fold][0] for fold in one.rows] for leaf in (one, other)])
    return these == those


def _letters(choice: Sequence[LocalMode]) -> dict[Edge, str]:
    """M or V of each fold, where the first fold of the first vertex is a valley."""
    signs = {choice[0].folds[0]: 1}
    waiting = list(choice)
    while waiting:
        ready = [mode for mode in waiting if signs.keys() & set(mode.folds)]
        if not ready:
            raise UsageError(
                f"the local modes are not connected by active folds: vertex {waiting[0].vertex} "
                "shares none with the others"
            )
        for mode in ready:
            known = next(fold for fold in mode.folds if fold in signs)
            for fold in mode.folds:
                signs.setdefault(fold, signs[known] * sign(mode.gain(known, fold)))
        waiting = [mode for mode in waiting if mode not in ready]
    return {fold: "V" if s > 0 else "M" for fold, s in sorted(signs.items())}


def _on_line(leaf: Leaf, moving: Mapping[int, Star]) -> tuple[LocalMode, ...]:
    """The motions of all active vertices on a space with one parameter."""
    local_modes = []
    for v, star in sorted(moving.items()):
        folds = tuple(fold for fold in star.folds if fold in leaf.rows)
        if folds:
            scale = exact(leaf.rows[folds[0]][0])
            values = tuple(simple(leaf.rows[fold][0] / scale) for fold in folds)
            local_modes.append(LocalMode(v, 0, folds, values))
    return tuple(local_modes)


def open_reason(mode: PanelMode) -> str:
    """Why a mode that is not proved to truly fold cannot be followed."""
    if mode.extends.verdict is UNDECIDED:
        return f"it is undecided whether mode {mode.number} truly folds: {mode.extends.by}"
    return f"mode {mode.number} does not truly fold: {mode.extends.by}"


def why_nothing_follows(result: Decomposition, known: Sequence[PanelMode]) -> str:
    """Why a sheet cannot be followed of which no way can (`panel_ways`)."""
    if known:
        more = f"; and so on for {len(known) - _REASONS} more" if len(known) > _REASONS else ""
        return "; ".join(open_reason(mode) for mode in known[:_REASONS]) + more
    families = any(d > 1 for d in {**(result.found_true or {}), **(result.true or {})})
    what = (
        "the sheet folds only in families of several dimensions"
        if families
        else "no motion with one parameter is known"
    )
    return (
        f"{what}; if vertices have more than four folds, exactfold follows only motions with one "
        "parameter that are linear in the half-angle tangents"
    )
