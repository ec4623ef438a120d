"""The places of the panels of a sheet in space for given fold angles, in floats or exactly."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, TypeAlias

import numpy as np

from exactfold._support.arrays import FloatArray, IndexArray
from exactfold.errors import UsageError
from exactfold.exact.joined_fields import JoinedField
from exactfold.exact.surds import Number, exact, simple
from exactfold.pattern.panel_pattern import Edge, PanelPattern

Spot: TypeAlias = tuple[Number, Number, Number]
Turn: TypeAlias = tuple[Number, Number]
"""(p, q), where p + q d is the quaternion of a fold with vector d; q / p is tan(angle / 2) /
length.
"""


_TRIES = 4


class _Step(NamedTuple):
    """A panel, the panel before it, and the fold between them; the panel is left of i to j."""

    panel: int
    before: int
    fold: int
    i: int
    j: int


@dataclass(frozen=True)
class Placing:
    """Places all panels one after the other, beginning with `held`, each across one fold.

    A panel to the left of its fold from i to j is turned about the fold by the fold angle. A
    positive angle, a valley, lifts it. The folds that are not crossed on the way close if the fold
    angles close round every interior vertex.
    """

    pattern: PanelPattern
    held: int

    def __post_init__(self) -> None:
        if not 0 <= self.held < len(self.pattern.faces):
            raise UsageError(
                f"there is no panel {self.held} to hold: give a number from 0 to "
                f"{len(self.pattern.faces) - 1}"
            )

    @cached_property
    def steps(self) -> tuple[_Step, ...]:
        """The panels in the order in which they are placed, without the panel that is held."""
        numbers = {fold: k for k, fold in enumerate(self.pattern.folds)}
        seen, waiting = {self.held}, [self.held]
        steps: list[_Step] = []
        for before in waiting:
            face = self.pattern.faces[before]
            for i, j in zip(face, (*face[1:], face[0]), strict=True):
                panel = self.pattern.sides.get((j, i))
                if panel is None or panel in seen:
                    continue
                seen.add(panel)
                waiting.append(panel)
                steps.append(_Step(panel, before, numbers[min(i, j), max(i, j)], j, i))
        return tuple(steps)

    @property
    def middle(self) -> int:
        """The largest of those panels from which all others are few folds away.

        Distances are computed only from a few panels.
        """
        most = np.zeros(len(self.pattern.faces), dtype=np.intp)
        for _ in range(_TRIES):
            first = Placing(self.pattern, int(most.argmin()))
            last = Placing(self.pattern, int(first.depths.argmax()))
            most = np.maximum(most, last.depths)
        near = np.flatnonzero(most <= most.min() + 1).tolist()
        return int(max(near, key=lambda panel: self._area(self.pattern.faces[panel])))

    def _area(self, face: tuple[int, ...]) -> float:
        """Twice the area of a panel to a few digits, so that equal panels have equal areas."""
        x, y = self._flat[0][list(face)].T[:2]
        return float(f"{np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)):.6g}")

    @property
    def depths(self) -> IndexArray:
        """For each panel, the least number of folds between it and the panel that is held."""
        depths = np.zeros(len(self.pattern.faces), dtype=np.intp)
        for step in self.steps:
            depths[step.panel] = depths[step.before] + 1
        return depths

    @cached_property
    def owners(self) -> Mapping[int, int]:
        """For each vertex, the first placed panel that has it as a corner."""
        owners: dict[int, int] = {}
        for panel in (self.held, *(step.panel for step in self.steps)):
            for v in self.pattern.faces[panel]:
                owners.setdefault(v, panel)
        return owners

    @cached_property
    def _flat(self) -> tuple[FloatArray, FloatArray]:
        """The flat vertices relative to the first corner of the held panel, and that corner."""
        x, y = self.pattern.vertices[self.pattern.faces[self.held][0]]
        flat = [(float(a - x), float(b - y), 0.0) for a, b in self.pattern.vertices]
        return np.array(flat), np.array([float(x), float(y), 0.0])

    def positions(self, angles: FloatArray) -> tuple[FloatArray, float]:
        """All vertices at fold angles (times, folds), shape (times, V, 3); and the largest gap.

        A gap is the distance between the places that two panels give to a common corner, in the
        unit of the pattern.
        """
        flat, origin = self._flat
        times, panels = len(angles), len(self.pattern.faces)
        turned = np.empty((panels, times, 3, 3))
        moved = np.empty((panels, times, 3))
        turned[self.held], moved[self.held] = np.eye(3), 0.0
        for panel, before, fold, i, j in self.steps:
            axis = flat[j] - flat[i]
            axis = axis / np.abs(axis).max()  # so that squares neither overflow nor underflow
            spin = _rotations(axis / np.linalg.norm(axis), angles[:, fold])
            turned[panel] = turned[before] @ spin
            shift = flat[i] - spin @ flat[i]
            moved[panel] = np.einsum("tij,tj->ti", turned[before], shift) + moved[before]
        coords = np.empty((times, len(flat), 3))
        for v, panel in self.owners.items():
            coords[:, v] = turned[panel] @ flat[v] + moved[panel]
        gap = 0.0
        for panel, face in enumerate(self.pattern.faces):
            corners = list(face)
            there = np.einsum("tij,vj->tvi", turned[panel], flat[corners]) + moved[panel][:, None]
            gap = max(gap, float(np.abs(there - coords[:, corners]).max(initial=0.0)))
        return coords + origin, gap

    def exactly(self, turns: Mapping[Edge, Turn]) -> tuple[Spot, ...]:
        """All vertices exactly, from the quaternions p + q d of the folds; other folds are flat.

        Raises `UsageError` if two panels give different places to a common corner, because then the
        folds do not close, and `NotApplicableError` if the positions of vertices are known only
        nearly.
        """
        self.pattern.check_positions()
        coordinates = [c for point in self.pattern.vertices for c in point]
        tower = JoinedField([*coordinates, *(x for turn in turns.values() for x in turn)])
        flat = [(tower.number(x), tower.number(y)) for x, y in self.pattern.vertices]
        places: dict[int, tuple[Sequence[Spot], Spot]] = {
            self.held: (((1, 0, 0), (0, 1, 0), (0, 0, 1)), (0, 0, 0))
        }
        for panel, before, fold, i, j in self.steps:
            rows, shift = places[before]
            turn = turns.get(self.pattern.folds[fold])
            if turn is None:
                places[panel] = rows, shift
                continue
            p, q = (tower.number(x) for x in turn)
            (ax, ay), (bx, by) = flat[i], flat[j]
            spin = _exact_rotation(p, q, bx - ax, by - ay)
            new = tuple(_spot(_turned(row, spin)) for row in rows)
            # The fold stays where it is: new a + t = old a + shift.
            moved = _spot(
                (row[0] - fresh[0]) * ax + (row[1] - fresh[1]) * ay + s
                for row, fresh, s in zip(rows, new, shift, strict=True)
            )
            places[panel] = new, moved
        spots: dict[int, Spot] = {}
        for panel, face in enumerate(self.pattern.faces):
            rows, shift = places[panel]
            for v in face:
                x, y = flat[v]
                spot = _spot(
                    simple(row[0] * x + row[1] * y + s) for row, s in zip(rows, shift, strict=True)
                )
                if spots.setdefault(v, spot) != spot:
                    raise UsageError(
                        f"the folds do not close: panel {panel} does not meet the other panels at "
                        f"vertex {v}"
                    )
        return tuple(spots[v] for v in range(len(flat)))


def _rotations(axis: FloatArray, angles: FloatArray) -> FloatArray:
    """Rotations about a unit axis, shape (times, 3, 3) (Rodrigues)."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    sine, versine = np.sin(angles), 2 * np.sin(angles / 2) ** 2
    return np.asarray(
        np.eye(3) + sine[:, None, None] * cross + versine[:, None, None] * (cross @ cross)
    )


def _exact_rotation(p: Number, q: Number, x: Number, y: Number) -> tuple[Spot, Spot, Spot]:
    """The rotation of the quaternion p + q (x, y, 0)."""
    squared = q * q * (x * x + y * y)
    unit = 1 / exact(p * p + squared)
    cosine, a, b = (p * p - squared) * unit, 2 * p * q * unit, 2 * q * q * unit
    return (
        (cosine + b * x * x, b * x * y, a * y),
        (b * x * y, cosine + b * y * y, -a * x),
        (-a * y, a * x, cosine),
    )


def _turned(row: Spot, spin: Sequence[Spot]) -> Iterable[Number]:
    """A row times a matrix."""
    a, b, c = row
    return (a * x + b * y + c * z for x, y, z in zip(*spin, strict=True))


def _spot(values: Iterable[Number]) -> Spot:
    x, y, z = values
    return x, y, z
