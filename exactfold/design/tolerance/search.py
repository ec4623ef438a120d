"""Radii, an upper bound and an estimate, from the zeros that are followed as vertices move."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import replace
from math import isfinite

import numpy as np

from exactfold._support.plurals import counted
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.design.tolerance.distinct import all_distinct
from exactfold.design.tolerance.frame import DOWN, Frame
from exactfold.design.tolerance.nearest import Candidate, candidates
from exactfold.design.tolerance.parts import (
    TrackedPart,
)
from exactfold.design.tolerance.radius import Radii, proved_radii
from exactfold.design.tolerance.result import Changed, Tolerance
from exactfold.design.tolerance.sampling import (
    SAMPLES,
    SHARE,
    Estimate,
    first_changes,
    pinching,
    random_moves,
)
from exactfold.pattern.crease_pattern import CreasePattern, Edge

_TRIED = 6
"""So many candidates for another answer nearby are examined exactly."""

Confirm = Callable[[Candidate], str]
"""What is proved to be different on the sheet of a candidate; empty if nothing is."""


class Search:
    """Radii, upper bound and estimate of the zeros of parts.

    `flat` has the names of ways with their folds that are proved to be flat.
    """

    def __init__(
        self,
        frame: Frame,
        parts: Sequence[TrackedPart],
        way: str,
        seed: int,
        progress: Progress | None,
        flat: Collection[tuple[str, Edge]] = (),
    ) -> None:
        self.frame, self.parts, self.way, self.seed = frame, parts, way, seed
        self.progress, self.flat = progress, flat
        self.radii = [self._radii(part) for part in parts]

    def _radii(self, part: TrackedPart) -> Radii:
        lettered = np.array([bool(name) for name in part.names])
        return proved_radii(part.conditions, part.zeros, self.frame.off, lettered, self.progress)

    def found(self, ways: int, confirm: Confirm, everything: bool) -> Tolerance:
        """The result for the zeros that were asked for."""
        radius, vertices = self.radius(), self._vertices()
        status, reason, limit = PROVED, self._kept(ways, everything), self.frame.pinched
        upper: float | None = self.frame.upper
        changed = None
        if flat := self._bending():
            return self.frame.nothing(
                PROVED, f"{flat}, but not on sheets nearby", self.way, ways, flat
            )
        if self.progress is not None:
            self.progress("other sheets", 0, 0)
        if (nearest := self._nearest(confirm)) is not None:
            candidate, what = nearest
            if candidate.distance < self.frame.upper:
                upper, changed, limit = candidate.distance, Changed(what, candidate.moves), what
        if everything and radius > 0 and (same := self.not_distinct()):
            radius, vertices = 0.0, dict.fromkeys(vertices, 0.0)
            status, reason = UNDECIDED, same
        elif radius == 0:
            status, reason = UNDECIDED, self._unproved()
        return Tolerance(
            self.frame.pattern,
            status,
            reason,
            self.way,
            ways,
            radius,
            upper,
            changed,
            limit,
            self._estimate(),
            vertices,
            (),
            self.frame.shortest,
            motions=self._motions(),
        )

    def _motions(self) -> tuple[tuple[float, ...], ...]:
        """The densities of the folds on the ways that are kept, if one part has all folds."""
        if len(self.parts) != 1 or self.parts[0].conditions.folds != self.frame.pattern.folds:
            return ()
        [part], [radii] = self.parts, self.radii
        if not all(part.names[k] for k in self._used(part)):
            return ()
        rows = radii.densities[self._used(part)].real
        return tuple(tuple(row) for row in rows.tolist())

    def _used(self, part: TrackedPart) -> list[int]:
        """The zeros on which the answer depends."""
        return list(part.of_way)

    def radius(self) -> float:
        """The proved radius of all zeros on which the answer depends."""
        radius = self.frame.largest
        for part, radii in zip(self.parts, self.radii, strict=True):
            radius = min(radius, float(radii.all_move[self._used(part)].min()) * DOWN)
        return radius

    def _vertices(self) -> dict[int, float]:
        alone = {v: self.frame.alone(v) for v in range(len(self.frame.points))}
        for part, radii in zip(self.parts, self.radii, strict=True):
            least = radii.one_moves[self._used(part)].min(axis=0) * DOWN
            alone = {v: min(radius, float(least[v])) for v, radius in alone.items()}
        return alone

    def _kept(self, ways: int, everything: bool) -> str:
        if everything:
            return (
                "all sheets whose vertices move by less than the radius, each in its disk, have "
                f"{counted(ways, 'way')} with the same letters"
            )
        return (
            "all sheets whose vertices move by less than the radius, each in its disk, have this "
            "way with the same letters"
        )

    def _unproved(self) -> str:
        for part, radii in zip(self.parts, self.radii, strict=True):
            for k in self._used(part):
                if not radii.all_move[k] > 0:
                    return (
                        f"{part.names[k] or 'a motion that is not real'} is too nearly singular, "
                        "or a letter too nearly flat, for the test in doubles"
                    )
        return "the panels are too thin for their shape in doubles"

    def _bending(self) -> str:
        """A fold that is flat on a way, and proved to bend on sheets nearby."""
        for part, radii in zip(self.parts, self.radii, strict=True):
            for k in self._used(part):
                if not part.names[k]:
                    continue
                sizes = np.abs(radii.densities[k])
                for e in np.flatnonzero(sizes < 1e-12 * sizes.max()).tolist():
                    i, j = part.conditions.folds[e]
                    is_flat = (part.names[k], (i, j)) in self.flat  # exactly, not only in doubles
                    if is_flat and radii.is_sloping[k, e]:
                        return f"on {part.names[k]} fold {i}-{j} is flat"
        return ""

    def not_distinct(self) -> str:
        """Why the ways are not proved to be different; empty if they are."""
        for part, radii in zip(self.parts, self.radii, strict=True):
            if not part.is_complete:
                return "not all complex motions are listed, so that others may become real"
            if not all_distinct(part, radii):
                return "the boxes of two ways are not proved to be distinct"
        return ""

    def _nearest(self, confirm: Confirm) -> tuple[Candidate, str] | None:
        found: list[tuple[Candidate, TrackedPart]] = []
        for part, radii in zip(self.parts, self.radii, strict=True):
            chosen = np.array([k for k in self._used(part) if part.names[k]], dtype=np.intp)
            real = np.asarray(part.zeros.real)
            plain = replace(
                radii,
                densities=np.asarray(radii.densities.real),
                slopes=np.asarray(radii.slopes.real),
            )
            if len(chosen):
                found += [
                    (one, part) for one in candidates(part.conditions, real, plain, chosen, _TRIED)
                ]
        for candidate, _ in sorted(found, key=lambda pair: pair[0].distance)[:_TRIED]:
            if what := confirm(candidate):
                return candidate, what
        return None

    def _estimate(self) -> Estimate | None:
        if self.progress is not None:
            self.progress("random moves", 0, 0)
        moves = random_moves(np.random.default_rng(self.seed), SAMPLES, len(self.frame.points))
        pattern = self.frame.pattern
        faces = pattern.triangles if isinstance(pattern, CreasePattern) else pattern.faces
        ends = pinching(self.frame.points, faces, moves)
        for part, radii in zip(self.parts, self.radii, strict=True):
            chosen = np.array([k for k in self._used(part) if part.names[k]], dtype=np.intp)
            if len(chosen):
                plain = replace(
                    radii,
                    densities=np.asarray(radii.densities.real),
                    slopes=np.asarray(radii.slopes.real),
                )
                real = np.asarray(part.zeros.real)
                ends = np.minimum(ends, first_changes(part.conditions, real, plain, chosen, moves))
        radius = float(np.sort(ends)[int(SHARE * SAMPLES) - 1])
        return Estimate(radius, SAMPLES, self.seed) if isfinite(radius) else None
