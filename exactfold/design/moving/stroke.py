"""How far a branch folds before faces touch, and places of vertices where it folds farther."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.clock import Clock
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED
from exactfold.branches.counting.find import find_branch
from exactfold.branches.values.branch import Branch
from exactfold.errors import ExactfoldError
from exactfold.motion.curves.events import CONTACT, FLAT_FOLD
from exactfold.motion.curves.motion import Motion
from exactfold.motion.following import follow
from exactfold.motion.proving import prove
from exactfold.pattern.crease_pattern import CreasePattern, Triangle

_TRIALS = 60
"""So many places are tried."""
_FIRST = 0.3
"""The first places are so large a share of the box away."""


class Stroke:
    """The stroke of one branch: the time of its motion until two faces touch or a fold closes.

    The time is the length of the path of all vertices, with `held` held: the face that is held on
    the given sheet. Sheets on which the branch has other letters have the stroke 0.
    """

    def __init__(self, branch: Branch) -> None:
        self.branch = branch
        self.held: Triangle = follow(branch, frames=2).pinned

    def followed(self, sheet: CreasePattern) -> Motion | None:
        """The motion until the first contact, in floats; None if it has no such end."""
        try:
            branch = find_branch(sheet, self.branch.sign_text)
            if branch.status is not PROVED or branch.assignment != self.branch.assignment:
                return None
            motion = follow(branch, frames=2, pinned=self.held)
        except ExactfoldError:
            return None
        return motion if motion.end in (CONTACT, FLAT_FOLD) else None

    def proved(self, sheet: CreasePattern) -> float:
        """A proved lower bound of the stroke; 0 if nothing is proved."""
        motion = self.followed(sheet)
        if motion is None:
            return 0.0
        try:
            proof = prove(motion)
        except ExactfoldError:
            return 0.0
        contact = proof.contact
        if proof.status is not PROVED or contact is None or contact.event is None:
            return 0.0
        return contact.event.time[0]

    def raised(
        self,
        made: Callable[[FloatArray], CreasePattern | None],
        start: FloatArray,
        within: float,
        clock: Clock,
        progress: Progress | None,
    ) -> Iterator[FloatArray]:
        """Places with larger and larger strokes in floats, by the method of Nelder and Mead.

        `made` gives the sheet of some places. Places stay within a box round the start. What a
        KeyboardInterrupt leaves is yielded before it goes on.
        """
        from scipy.optimize import minimize

        found: list[tuple[float, FloatArray]] = []

        def lost(shares: FloatArray) -> float:
            if clock.passed:
                raise _OverError
            places = start + within * shares
            sheet = made(places)
            motion = None if sheet is None else self.followed(sheet)
            stroke = 0.0 if motion is None else motion.duration
            found.append((stroke, places))
            if progress is not None:
                best = max(stroke for stroke, _ in found)
                progress(f"stroke, at most {best:.3g}", len(found), _TRIALS)
            return -stroke

        first = np.zeros(len(start))
        simplex = np.vstack([first, _FIRST * np.eye(len(start))])
        options = {"maxfev": _TRIALS, "initial_simplex": simplex, "xatol": 1e-3, "fatol": 1e-6}
        bounds = [(-1.0, 1.0)] * len(start)
        try:
            minimize(lost, first, method="Nelder-Mead", bounds=bounds, options=options)
        except _OverError:
            pass
        except KeyboardInterrupt:
            yield from _best(found)
            raise
        yield from _best(found)


class _OverError(Exception):
    """The time is over."""


def _best(found: list[tuple[float, FloatArray]]) -> Iterator[FloatArray]:
    """The two best places, the best first."""
    for stroke, places in sorted(found, key=lambda one: -one[0])[:2]:
        if stroke > 0:
            yield places
