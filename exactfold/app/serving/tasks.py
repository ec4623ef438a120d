"""What a process of the server does for the page: read a sheet, move a vertex, list, and follow."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from pathlib import Path
from typing import Any, Final, TypeAlias

from exactfold._support.clock import Clock
from exactfold._support.plurals import counted, visible
from exactfold.app.pictures.film import filmed
from exactfold.app.viewer.document import FRAMES, Known, sheet_json
from exactfold.app.viewer.folded import NOT_ASKED, flat_states, folded_sheet
from exactfold.app.viewer.listing import Listed, listed_ways
from exactfold.app.viewer.ways import Following, Way, branch_way, not_followed
from exactfold.branches.counting.find import BranchFinder, branch_finder
from exactfold.branches.counting.pools import process_pool
from exactfold.errors import ExactfoldError, UsageError
from exactfold.exact.surds import Number
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.loading import PatternLike, open_sheet
from exactfold.pattern.opening import Opened, open_pattern, triangulated
from exactfold.pattern.panel_pattern import PanelPattern
from exactfold.pattern.reading import PLAIN, Reading

Answer: TypeAlias = dict[str, Any]
"""One line of an answer: what is in it depends on its `kind`."""

FREE: Final = 4096
"""A vertex that is moved freely still goes to a grid: the size of the sheet has so many steps."""
_LIVE_SECONDS: Final = 2.0
_SHARE: Final = 0.8
"""This share of the time may go by before no further way is followed."""
_ENDING: Final = re.compile(r"(\.[A-Za-z0-9]{1,8}){1,2}$")


@dataclass(frozen=True)
class Move:
    """A vertex that goes to a point, or to the nearest point of a grid with so many steps."""

    vertex: int
    x: float
    y: float
    grid: int


@dataclass(frozen=True)
class Open:
    """Read a sheet and list its ways.

    `data` is the content of a file with this `name`; without it, `sheet` is anything that `read`
    takes. With `live`, the sheet has just been changed by hand: only the first motion is followed.
    """

    name: str
    sheet: PatternLike | None = None
    data: bytes | None = None
    reading: Reading = PLAIN
    branches: tuple[str, ...] | None = None
    frames: int = FRAMES
    proving: bool = False
    move: Move | None = None
    live: bool = False
    limit: float = 60.0


@dataclass(frozen=True)
class Follow:
    """Follow one way of the sheet that was read last: by its place in the list, or by its signs."""

    way: int | None
    signs: str = ""


@dataclass(frozen=True)
class Film:
    """Make an MP4 file of pictures, each a PNG file, shown so many seconds in all."""

    pictures: tuple[bytes, ...]
    seconds: float


Task: TypeAlias = Open | Follow | Film


@dataclass
class Session:
    """One process: it remembers the sheet that it read last."""

    known: Known | None = None
    _finders: dict[int, BranchFinder] = field(default_factory=dict)

    def answers(self, task: Task) -> Iterator[Answer]:
        """The answers to a task; an error is the last of them."""
        try:
            if isinstance(task, Open):
                yield from self._opened(task)
            elif isinstance(task, Follow):
                yield self._followed(task)
            else:
                yield {"kind": "film", "data": filmed(task.pictures, ".mp4", task.seconds)}
        except ExactfoldError as error:
            yield {"kind": "error", "error": str(error)}
        except RecursionError:
            yield {"kind": "error", "error": "the file is nested too deeply"}

    def _opened(self, task: Open) -> Iterator[Answer]:
        clock = Clock(task.limit)
        opened = _read(task)
        if task.move is not None:
            opened = moved(opened, task.move)
        name = visible(task.name)
        yield {
            "kind": "read",
            "name": name,
            "brief": "; ".join(filter(None, (", ".join(opened.brief), *opened.seen))),
            "read": list(opened.lines),
            "sheet": sheet_json(opened),
        }
        seconds = _LIVE_SECONDS if task.live else task.limit / 2
        listed = listed_ways(
            opened,
            task.branches,
            None,
            task.frames,
            task.proving,
            None,
            Clock(seconds),
            brief=task.live,
        )
        self.known, self._finders = Known(opened, name, listed), {}
        ways = [way for way, _ in listed.ways]
        document = self.known.document(ways, NOT_ASKED, served=True)
        yield {"kind": "listed", "document": document}
        first = 0 if listed.drawn is None else listed.drawn["way"]
        order = [first, *(k for k in range(len(listed.ways)) if k != first)]
        late = clock.share(_SHARE)
        for place, k in enumerate(order[:1] if task.live else order):
            if k >= len(listed.ways) or listed.ways[k][1] is None:
                continue
            if late.passed:
                left = sum(listed.ways[m][1] is not None for m in order[place:])
                yield {"kind": "late", "text": _late(left, task.limit)}
                return
            found = self._motion(listed, k)
            ways[k] = {**ways[k], **found["found"]}
            yield {"kind": "way", "way": k, **found}
        if not task.live:
            yield from _folded(self.known, ways, late)

    def _followed(self, task: Follow) -> Answer:
        if self.known is None:
            raise UsageError("the sheet is no longer open here: open it again")
        listed = self.known.known
        if task.way is not None:
            if not 0 <= task.way < len(listed.ways):
                raise UsageError(f"there is no way {task.way}; the page has {len(listed.ways)}")
            return {"kind": "way", "way": task.way, **self._motion(listed, task.way)}
        pattern, following = self.known.opened.sheet, listed.follower
        if not isinstance(pattern, CreasePattern) or not isinstance(following, Following):
            raise UsageError(
                "this sheet folds along modes of rigid panels, and modes have no vertex signs"
            )
        finder = self._finders.setdefault(0, branch_finder(pattern))
        branch = finder.find(finder.signs(task.signs, None))
        return {"kind": "branch", "branch": {**branch_way(branch), **following(branch)}}

    @staticmethod
    def _motion(listed: Listed, k: int) -> Answer:
        _, job = listed.ways[k]
        found = not_followed("this way is not followed") if job is None else listed.follower(job)
        return {"found": found}


def _folded(known: Known, ways: Sequence[Way], clock: Clock) -> Iterator[Answer]:
    """The flat-folded states of a sheet, and then the ways that end in them, one by one."""
    states = flat_states(known.opened, clock)
    if not states:
        return  # another line says that the time is over
    sheets = [folded_sheet(one, clock) for one in states]
    yield {"kind": "folded", "folded": {"sheets": sheets, "ends": [], "left": ""}}
    for end in known.ends(states, ways, process_pool(1), clock):
        yield {"kind": "end", "end": end}


def _late(left: int, limit: float) -> str:
    ways = counted(left, "way")
    return f"{ways} not followed after {limit:g} seconds: choose one, and it is followed then"


def _read(task: Open) -> Opened:
    """The sheet of a task, from the content of a file or from anything else that is a sheet."""
    if task.data is None:
        if task.sheet is None:
            raise UsageError("there is no sheet to open")
        return open_sheet(task.sheet, task.reading)
    ending = _ENDING.search(task.name)
    with tempfile.TemporaryDirectory(prefix="exactfold-") as folder:
        path = Path(folder) / f"drawing{ending[0] if ending else ''}"
        path.write_bytes(task.data)
        return open_pattern(path, task.reading, name=visible(task.name) or "the drawing")


def moved(opened: Opened, move: Move) -> Opened:
    """The sheet with one vertex moved; its edges and letters stay.

    The new point has rational coordinates on a grid: so many equal steps make the size of the
    sheet, and the grid begins at its lower left corner. Raises `UsageError` for a vertex that does
    not exist, and the errors of `CreasePattern` and `PanelPattern` if edges would cross.

    >>> opened = open_sheet("two-vertex")
    >>> moved(opened, Move(4, 0.26, 0.51, 4)).sheet.vertices[4]
    (Fraction(1, 4), Fraction(1, 2))
    """
    sheet = opened.sheet
    if not 0 <= move.vertex < len(sheet.vertices):
        raise UsageError(f"there is no vertex {move.vertex}")
    if not 1 <= move.grid <= FREE:
        raise UsageError(f"a grid of {move.grid} steps: give a number from 1 to {FREE}")
    corners = [[_fraction(c) for c in point] for point in sheet.vertices]
    low = [min(point[axis] for point in corners) for axis in (0, 1)]
    size = max(max(point[axis] for point in corners) - low[axis] for axis in (0, 1))
    step = size / move.grid
    point = tuple(
        start + step * round((Fraction(value) - start) / step)
        for start, value in zip(low, (move.x, move.y), strict=True)
    )
    points: list[Any] = [*sheet.vertices]
    points[move.vertex] = point
    new: CreasePattern | PanelPattern
    if isinstance(sheet, CreasePattern):
        new = CreasePattern(points, sheet.triangles)
    else:
        new = PanelPattern(points, sheet.edges, sheet.holes)
        if new.folds != sheet.folds or len(new.faces) != len(sheet.faces):
            raise UsageError("the vertex cannot go there: edges would cross")
        new = triangulated(new) or new
    return replace(Opened(new, opened.assignment), lines=opened.lines)


def _fraction(number: Number) -> Fraction:
    """A rational number near a coordinate; the coordinate itself if it is rational."""
    if isinstance(number, int | Fraction):
        return Fraction(number)
    return Fraction(float(number)).limit_denominator(10**6)
