"""The motions along which a sheet of rigid panels leaves the flat state, as unit vectors of work.

Every way is the span of some of these motions, which are orthogonal to each other.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Final, TypeAlias

from flint import arb, ctx

from exactfold._support.verdict import PROVED
from exactfold.design.actuation.directions import BITS, Directions, Springs
from exactfold.errors import NotCountedError, UsageError
from exactfold.exact.surds import Number, ball
from exactfold.motion.panels.followable import PanelMode
from exactfold.motion.panels.listing import MOST_WAYS, PanelWay, is_too_many, panel_ways
from exactfold.panels.decomposition import groups_of
from exactfold.panels.modes.densities import Density, Roots
from exactfold.panels.result import Decomposition
from exactfold.panels.spaces.kernel import first_order
from exactfold.panels.spaces.subspaces import Leaf
from exactfold.panels.vertex.local import LocalMode
from exactfold.panels.vertex.stars import stars
from exactfold.pattern.panel_pattern import Edge, EnclosedPattern, PanelPattern

WORKING_BITS: Final = 256
"""Bits of the balls with which unit vectors are computed."""

Key: TypeAlias = "int | Edge | tuple[int, int, int]"
"""A mode by its number, a free fold by its ends, or (leaf, place, 0): a direction of a leaf."""

Balls: TypeAlias = Mapping[Edge, arb]


@dataclass(frozen=True)
class Motion:
    """One motion: a mode, a fold from boundary to boundary, or one direction of a space.

    `vertex` is a vertex of the part of the sheet that moves, or None for a free fold. `column` is
    the number of the direction among those of the space.
    """

    source: PanelMode | Edge | Leaf
    vertex: int | None
    column: int = 0

    def densities(self, roots: Roots) -> Mapping[Edge, Density] | None:
        """The exact fold densities up to a common factor; None if only bounds are known."""
        if isinstance(self.source, PanelMode):
            return self.source.densities_in(roots)
        if isinstance(self.source, tuple):
            return {self.source: roots.density(Fraction(1))}
        if self.source.motion:
            return None
        try:
            return {
                fold: Density(roots.field.number(row[self.column]), {}, roots)
                for fold, row in self.source.rows.items()
                if row[self.column] != 0
            }
        except UsageError:
            return None


@dataclass(frozen=True)
class Way:
    """One way: the `motions` that span it, orthogonal to each other, by their places.

    If `is_cone`, the way is a cone that spans this space.
    """

    number: int
    motions: tuple[int, ...]
    dimension: int
    is_cone: bool = False


@dataclass(frozen=True)
class WayMotions:
    """All ways of a sheet that are proved to truly fold, as spans of unit vectors.

    Row k of `directions` holds bounds of the numbers u_e of motion k by which torques tau are
    multiplied: the power is the sum of tau_e u_e (docs/actuation.md, 7).
    `is_complete` says whether these are all ways, and `unknown` why they may not be. `by_structure`
    says whether the structure theorem gives all ways: every one is spanned by modes. `parts` has
    the smallest vertex of the part of each vertex, and `spans` for these vertices the dimension of
    the first-order motions of the part.
    """

    pattern: PanelPattern
    springs: Springs
    directions: Directions
    motions: tuple[Motion, ...]
    ways: tuple[Way, ...]
    by_structure: bool
    is_complete: bool
    unknown: str
    parts: Mapping[int, int]
    spans: Mapping[int, int]

    @classmethod
    def of(
        cls,
        result: Decomposition,
        listed: Sequence[PanelWay] | None = None,
        springs: Springs = "equal",
    ) -> WayMotions:
        """The ways of a decomposition; raises `NotCountedError` if they are too many for a list.

        >>> from exactfold.branches.counting.ways import count_ways
        >>> motions = WayMotions.of(count_ways("miura"))
        >>> len(motions.ways), motions.is_complete, motions.directions
        (8, True, <Directions: 10 branches, 24 folds>)
        """
        if is_too_many(result):
            raise NotCountedError(
                f"the sheet has more than {MOST_WAYS} ways, and torques are compared with every "
                "one of them: hold some creases flat, or take a smaller sheet"
            )
        if isinstance(result.pattern, EnclosedPattern):
            raise NotCountedError(
                "the vertices of this sheet are only known within a radius, and power depends on "
                "the lengths of the creases: give a drawing with exact coordinates"
            )
        ways = panel_ways(result) if listed is None else listed
        return _Collected(result, ways, springs).made()

    def way(self, number: int) -> Way:
        """The way with this number."""
        return next(way for way in self.ways if way.number == number)

    def part(self, place: int) -> int | None:
        """The smallest vertex of the part of the sheet in which a motion is; None if it is free."""
        vertex = self.motions[place].vertex
        return None if vertex is None else self.parts[vertex]


class _Collected:
    """Collects the motions of the ways of a decomposition."""

    def __init__(self, result: Decomposition, ways: Sequence[PanelWay], springs: Springs) -> None:
        self.result, self.listed, self.springs = result, ways, springs
        self.pattern = result.pattern
        self.gains: dict[tuple[int, Edge, Edge], arb] = {}
        self.keys: dict[Key, int] = {}
        self.motions: list[Motion] = []
        self.rows: list[tuple[tuple[int, ...], tuple[int, ...]]] = []
        moving = stars(self.pattern, result.held)
        self.parts: dict[int, int] = {}
        self.spans: dict[int, int] = {}
        for group in groups_of(moving):
            self.parts.update(dict.fromkeys(group, group[0]))
            self.spans[group[0]] = first_order({v: moving[v] for v in group})[1]
        with ctx.workprec(WORKING_BITS):
            self.lengths = {fold: self._length(fold) for fold in self.pattern.folds}
            # The square roots of the stiffnesses of the springs.
            one = arb(1)
            self.arms = {
                fold: one if springs == "equal" else length.sqrt()
                for fold, length in self.lengths.items()
            }

    def made(self) -> WayMotions:
        """The motions of all ways that truly fold."""
        folding = [way for way in self.listed if way.verdict is PROVED]
        with ctx.workprec(WORKING_BITS):
            ways = tuple(self._way(way) for way in folding)
        known = self.result.true
        number = 0 if known is None else sum(n for d, n in known.items() if d)
        complete = known is not None and number == len(ways)
        return WayMotions(
            self.pattern,
            self.springs,
            Directions(
                self.pattern.folds,
                tuple(low for low, _ in self.rows),
                tuple(high for _, high in self.rows),
            ),
            tuple(self.motions),
            ways,
            self._by_structure,
            complete,
            "" if complete else self._unknown(len(ways)),
            self.parts,
            self.spans,
        )

    @property
    def _by_structure(self) -> bool:
        """Whether the structure theorem gives all ways: every one is spanned by modes."""
        parts = self.result.parts
        few = all(part.theory == "modes" and not part.by_tree for part in parts)
        return few and self.result.second_order is not None

    def _unknown(self, number: int) -> str:
        why = "; ".join(dict.fromkeys(part.reason for part in self.result.parts if part.reason))
        return (
            f"torques are compared with the {number} ways that are proved to fold, and it is not "
            f"known whether there are others{f': {why}' if why else ''}"
        )

    def _way(self, way: PanelWay) -> Way:
        places = [self._mode(mode) for mode in way.modes]
        places += [self._free(fold) for fold in way.free]
        for space in way.spaces:
            places += self._space(space)
        cone = any(space.vertices and not space.motion for space in way.spaces)
        return Way(way.number, tuple(places), way.dimension, cone)

    def _mode(self, mode: PanelMode) -> int:
        if mode.number not in self.keys:
            first = mode.folds[0]
            known = {first: arb(1 if mode.letters[first] == "V" else -1)}
            for k, fold in mode.order_from(first):
                for other in mode.stars[k].folds:
                    if other not in known:
                        known[other] = known[fold] * self._gain(mode.choice[k], fold, other)
            self._add(mode.number, Motion(mode, mode.vertices[0]), [known])
        return self.keys[mode.number]

    def _gain(self, local: LocalMode, start: Edge, end: Edge) -> arb:
        # The modes of a sheet share their local modes, and the list of ways keeps these alive.
        key = id(local), start, end
        if key not in self.gains:
            self.gains[key] = ball(local.gain(start, end), WORKING_BITS)
        return self.gains[key]

    def _free(self, fold: Edge) -> int:
        if fold not in self.keys:
            self._add(fold, Motion(fold, None), [{fold: arb(1)}])
        return self.keys[fold]

    def _space(self, leaf: Leaf) -> list[int]:
        """The places of an orthogonal basis of a space of motions, or of one line."""
        vertex = next(v for fold in leaf.folds for v in fold if v in self.parts)
        vectors: list[Balls] = [{fold: _between(*ends) for fold, ends in leaf.densities.items()}]
        if not leaf.motion:
            vectors = [
                {fold: ball(row[k], WORKING_BITS) for fold, row in leaf.rows.items()}
                for k in range(leaf.size)
            ]
        names: list[Key] = [(id(leaf), k, 0) for k in range(len(vectors))]
        if names[0] not in self.keys:
            for k, name in enumerate(names):
                self._add(name, Motion(leaf, vertex, k), vectors[: k + 1])
        return [self.keys[name] for name in names]

    def _add(self, key: Key, motion: Motion, vectors: Sequence[Balls]) -> None:
        """Add the last of the vectors, without its part along the others, as a unit vector."""
        units: list[Balls] = []
        for vector in map(self._angles, vectors):
            rest = dict(vector)
            for unit in units:
                share = sum((rest[e] * x for e, x in unit.items() if e in rest), arb(0))
                for e, x in unit.items():
                    rest[e] = rest.get(e, arb(0)) - share * x
            norm = sum((x * x for x in rest.values()), arb(0)).sqrt()
            units.append({e: x / norm for e, x in rest.items()})
        unit, still = units[-1], (0, 0)
        ends = [
            _ends(unit[fold] * self.arms[fold]) if fold in unit else still
            for fold in self.pattern.folds
        ]
        self.keys[key] = len(self.motions)
        self.motions.append(motion)
        self.rows.append((tuple(low for low, _ in ends), tuple(high for _, high in ends)))

    def _angles(self, densities: Balls) -> Balls:
        """Fold angles, each times the root of the stiffness of its spring."""
        return {e: w * self.lengths[e] * self.arms[e] for e, w in densities.items()}

    def _length(self, fold: Edge) -> arb:
        (ax, ay), (bx, by) = (self.pattern.vertices[v] for v in fold)
        squared: Number = (bx - ax) * (bx - ax) + (by - ay) * (by - ay)
        return ball(squared, WORKING_BITS).sqrt()


def _between(low: Fraction, high: Fraction) -> arb:
    middle, half = (low + high) / 2, (high - low) / 2
    return _arb(middle) + arb(0, 1) * _arb(half)


def _arb(value: Fraction) -> arb:
    return arb(value.numerator) / arb(value.denominator)


def _ends(value: arb) -> tuple[int, int]:
    """Integers that enclose the value in units of 2^-BITS."""
    if not value.is_finite():
        raise NotCountedError("the fold angles of a way are not known well enough")
    middle, (_, radius) = _floor_and_ceiling(value.mid()), _floor_and_ceiling(value.rad())
    return middle[0] - radius, middle[1] + radius


def _floor_and_ceiling(value: arb) -> tuple[int, int]:
    """Integers below and above an exact number, in units of 2^-BITS."""
    mantissa, exponent = map(int, value.man_exp())
    shift = exponent + BITS
    if shift >= 0:
        return mantissa << shift, mantissa << shift
    return mantissa >> -shift, -(-mantissa >> -shift)
