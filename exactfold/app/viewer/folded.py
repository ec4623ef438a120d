"""What the page shows of a sheet that is folded flat: states, and the ways that end in them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Annotated, Any, Final, Literal, TypeAlias, TypedDict

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.clock import Clock
from exactfold._support.documents import Keywords, Natural, VerdictText
from exactfold._support.verdict import PROVED, REFUTED
from exactfold.app.pictures.flat_conflicts import conflict_picture
from exactfold.app.pictures.flat_layers import bottom_to_top, clipped, edges_on
from exactfold.app.report.flat import flat_answer, reasons
from exactfold.app.viewer.coding import CodedFrames, decoded_frames
from exactfold.app.viewer.ways import FollowingPanels, Letters, Way, letters_of
from exactfold.layers.ends import Reached, WayEnd, way_end
from exactfold.layers.folding import fold_flat
from exactfold.motion.curves.events import FLAT_FOLD
from exactfold.motion.panels.listing import PanelWay, panel_ways
from exactfold.pattern.opening import Opened
from exactfold.pattern.panel_pattern import PanelPattern

if TYPE_CHECKING:
    from exactfold.app.viewer.listing import Listed
    from exactfold.layers.states import FlatStates, State

MOST_STATES: Final = 200
"""At most this many states are drawn, and at most `_MOST_LAYERS` layers of all of them."""
_MOST_LAYERS: Final = 20_000
_THICK: Final = 0.08
"""The height of the layers at the end of a motion, as a share of the size of the folded image."""
_TITLE: Final = "why there is no flat-folded state"
_SECONDS: Final = re.compile(r" \(\d+\.\d+ s\)")

Used: TypeAlias = Literal["drawn", "any"]


class FoldedPiece(TypedDict):
    """A piece of the paper in the folded image, or a part of one that is drawn at once."""

    corners: list[float]
    """x and y in turn, counter-clockwise."""
    front: bool
    """Whether its front, which the crease pattern shows, faces up."""
    folds: list[Annotated[int, Keywords(minimum=-1)]]
    """The lines on it: each a fold by its place in `folds`, or -1 for the border of the sheet."""
    lines: list[float]
    """The ends of these lines: four numbers each."""


class Stack(TypedDict):
    """A flat-folded state."""

    letters: Letters
    layers: list[Natural]
    """From bottom to top, by their place in `shapes`."""


class FoldedSheet(TypedDict):
    """The flat-folded states with some letters, or why there is none."""

    letters: Used
    answer: str
    status: VerdictText
    states: Natural | None
    """Their number, if it is known."""
    shapes: list[FoldedPiece]
    stacks: list[Stack]
    """The first states, from number 0 on."""
    reasons: list[str]
    picture: str
    """Why there is none, as SVG; empty if there are states, or if it is not known."""


class ClosedEnd(TypedDict):
    """Where a way ends of which all folds close together."""

    way: Natural
    """Its place in `ways`, from 0."""
    status: VerdictText
    """Whether it gets there without contact."""
    said: str
    letters: Used | None
    """The letters of the states in which it has a number; null if it has none."""
    state: Natural | None
    """The number of the state that it ends in, among those with these letters."""
    mirrored: Natural | None
    """The number of the state to the other side of the sheet."""
    shapes: list[FoldedPiece]
    stack: Stack | None
    """The state, if it is proved."""
    layered: list[float]
    """Coordinates of the last frame of the motion, in which the layers lie apart in their order."""


class Folded(TypedDict):
    """What is known of the sheet folded flat."""

    sheets: list[FoldedSheet]
    """The states with the letters of the file, and those with any letters."""
    ends: list[ClosedEnd]
    """Where ways end, as far as they close all their folds together."""
    left: str
    """What was not asked for, and why; empty if nothing is left."""


NOT_ASKED: Final[Folded] = {"sheets": [], "ends": [], "left": ""}


def with_holes(opened: Opened) -> bool:
    """Whether the sheet has holes."""
    return isinstance(opened.sheet, PanelPattern) and bool(opened.sheet.holes)


def flat_states(opened: Opened, clock: Clock) -> tuple[FlatStates, ...]:
    """The flat-folded states with the letters of the file, if it has some, and with any letters.

    Those with any letters are not asked for if no letters help, or if the clock has passed. There
    are none of a sheet with holes, which is not folded flat.
    """
    if clock.passed or with_holes(opened):
        return ()
    found = fold_flat(opened, limit=clock.left)
    by_angles = any(one.condition == "kawasaki" for one in found.failures)
    if found.letters_used == "any" or by_angles or clock.passed:
        return (found,)
    return found, fold_flat(opened, "any", limit=clock.left)


def folded_sheet(found: FlatStates, clock: Clock) -> FoldedSheet:
    """What the page shows of these states; only the first state if the clock has passed."""
    shapes = _Shapes()
    stacks: list[Stack] = []
    pieces = 0 if found.images is None else len(found.images.maps)
    for number in range(min(found.listed, MOST_STATES, 1 + _MOST_LAYERS // max(pieces, 1))):
        if stacks and clock.passed:
            break
        stacks.append(shapes.stack(found.state(number)))
    why = reasons(found) or [found.stopped] * bool(found.stopped)
    none = found.as_written is REFUTED
    return {
        "letters": "drawn" if found.letters_used == "drawn" else "any",
        "answer": _SECONDS.sub("", flat_answer(found).plain),
        "status": str(found.status),
        "states": found.count,
        "shapes": shapes.found,
        "stacks": stacks,
        "reasons": why,
        "picture": conflict_picture(found, why, _TITLE, written=False) if none else "",
    }


def closing_ways(listed: Listed, ways: Sequence[Way]) -> list[tuple[int, PanelWay]]:
    """The ways whose motions end with closed folds, by their places; the one shown first is first.

    Ways in spaces of motions, and motions that were not followed, are left out.
    """
    if not isinstance(listed.follower, FollowingPanels):
        return []
    first = 0 if listed.drawn is None else listed.drawn["way"]
    known = {way.number: way for way in panel_ways(listed.follower.ways)}
    found = []
    for k, way in enumerate(ways):
        motion, number = way["motion"], way["number"]
        if motion is None or number is None or motion["end"] != FLAT_FOLD:
            continue
        if known[number].verdict is PROVED and not known[number].spaces:
            found.append((k, known[number]))
    return sorted(found, key=lambda one: one[0] != first)


@dataclass(frozen=True)
class Ending:
    """Finds where ways end. It can be pickled, so that several processes can share the work."""

    follower: FollowingPanels
    states: tuple[FlatStates, ...]
    clock: Clock

    def __call__(self, one: tuple[int, PanelWay, Way]) -> ClosedEnd | None:
        """The end of the way at a place; None if nothing is known of an order of layers."""
        k, panel_way, way = one
        end = way_end(self.follower.ways, panel_way, self.states[0], self.clock)
        if end.reached is None or way["motion"] is None:
            return None
        reached = end.reached
        for states in self.states:
            if states.doubt:
                continue
            state, mirrored = (reached.number_in(states, mirrored=side) for side in (False, True))
            if state is not None or mirrored is not None:
                end = replace(end, state=state, mirrored=mirrored)
                return _end(k, way["motion"], way["name"], end, reached, states.letters_used)
        return _end(k, way["motion"], way["name"], end, reached, None)


def _end(
    k: int, motion: CodedFrames, name: str, end: WayEnd, reached: Reached, used: str | None
) -> ClosedEnd:
    numbered = end.status is PROVED and used is not None
    letters: Used | None = None if not numbered else "drawn" if used == "drawn" else "any"
    shapes, stack = _Shapes(), None
    said, layered = end.reason, list[float]()
    if end.status is PROVED and reached.state is not None:
        stack = shapes.stack(reached.state)
        said = (
            f"{name} folds rigidly from the flat sheet to {_named(end, letters)}, without contact"
        )
        if reached.heights is not None:
            last = decoded_frames(motion)[-1]
            layered = _numbers(_apart(reached.state, reached.heights, last))
    return {
        "way": k,
        "status": str(end.status),
        "said": said,
        "letters": letters,
        "state": end.state if numbered else None,
        "mirrored": end.mirrored if numbered else None,
        "shapes": shapes.found,
        "stack": stack,
        "layered": layered,
    }


def _named(end: WayEnd, letters: Used | None) -> str:
    """The states to both sides of the sheet, as far as they have numbers, in words."""
    those = " of those with any letters" if letters == "any" else ""
    if letters is None:
        return "a flat-folded state"
    if end.state is None:
        return f"a flat-folded state, and to the other side to state {end.mirrored}{those}"
    other = "" if end.mirrored is None else f" (to the other side: {end.mirrored})"
    return f"flat-folded state {end.state}{those}{other}"


def _apart(state: State, heights: FloatArray, last: FloatArray) -> FloatArray:
    """The last frame of a motion with each vertex at its height near closing, shape (V, 3).

    All heights are multiplied by one number, so that the layers keep their order.
    """
    places = np.array(state.images.places, dtype=np.float64)
    size = float(np.ptp(places, axis=0).max())
    spread = float(np.ptp(heights)) or 1.0
    flat = np.column_stack([places, np.zeros(len(places))])
    shape = np.column_stack([places, (heights - heights.mean()) * (_THICK * size / spread)])
    middle, there = flat.mean(axis=0), last.mean(axis=0)
    u, _, v = np.linalg.svd((flat - middle).T @ (last - there))
    turn = u @ np.diag([1.0, 1.0, float(np.sign(np.linalg.det(u @ v)))]) @ v
    return np.asarray((shape - middle) @ turn + there)


class _Shapes:
    """The shapes of some states of one sheet, each of them once."""

    def __init__(self) -> None:
        self.found: list[FoldedPiece] = []
        self._places: dict[Any, int] = {}

    def stack(self, state: State) -> Stack:
        """A state, from bottom to top."""
        images = state.images
        sheet = images.pieces.sheet
        places = np.array(images.places, dtype=np.float64)
        numbers = {fold: k for k, fold in enumerate(sheet.folds)}
        on = edges_on(images)
        layers = []
        for layer in bottom_to_top(state):
            corners = _numbers(layer.corners)
            key = (layer.piece, *corners)
            if key not in self._places:
                ends = {
                    edge: clipped(places[list(edge)], layer.corners) for edge in on[layer.piece]
                }
                drawn = [(numbers.get(e, -1), line) for e, line in ends.items() if line is not None]
                drawn.sort(key=lambda one: one[0])
                self._places[key] = len(self.found)
                self.found.append(
                    {
                        "corners": corners,
                        "front": not images.maps[layer.piece].flipped,
                        "folds": [fold for fold, _ in drawn],
                        "lines": [x for _, line in drawn for x in _numbers(line)],
                    }
                )
            layers.append(self._places[key])
        return {"letters": letters_of(sheet, state.letters), "layers": layers}


def _numbers(points: FloatArray) -> list[float]:
    """Coordinates in turn, to seven digits."""
    return [float(f"{x:.7g}") for x in points.ravel().tolist()]
