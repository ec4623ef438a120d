"""What the page shows, as one JSON document: the sheet, its ways to fold, and what is proved."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final, Literal, TypedDict

from exactfold._support.clock import LIMIT, UNLIMITED, Clock
from exactfold._support.documents import Fold, Keywords, Natural, Triangle
from exactfold._support.progress import Progress
from exactfold.app.viewer.folded import (
    NOT_ASKED,
    ClosedEnd,
    Ending,
    Folded,
    closing_ways,
    flat_states,
    folded_sheet,
    with_holes,
)
from exactfold.app.viewer.listing import Drawn, Facts, Listed, file_letters, listed_ways
from exactfold.app.viewer.marks import Mark, marks_of
from exactfold.app.viewer.ways import Followed, FollowingPanels, Letters, Way, not_followed
from exactfold.branches.counting.pools import Pool, process_pool
from exactfold.errors import UsageError, WorkerDiedError
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.loading import PatternLike, open_sheet
from exactfold.pattern.opening import Opened, has_branches
from exactfold.pattern.triangulating.panels import triangles_of
from exactfold.pattern.writing.fold_writing import fold_document

if TYPE_CHECKING:
    from exactfold.branches.values.branch import Branch
    from exactfold.layers.states import FlatStates

FRAMES: Final = 32
MOST_FRAMES: Final = 1000

_WORTH_A_PROCESS: Final = 6
"""Following this many motions takes about as long as starting a process."""
_FOLLOWING: Final = 0.9
"""This share of the time may go by before no further way is followed."""


class FlatSheet(TypedDict):
    """The sheet before it folds."""

    fold: Annotated[
        dict[str, Any], Keywords(required=["vertices_coords", "edges_vertices", "faces_vertices"])
    ]
    """The flat sheet as a FOLD object."""
    folds: list[Fold]
    triangles: list[Triangle]
    interior: list[Natural]
    foldable: list[Natural]
    """Vertices that can be popped through: where vertex signs name branches."""
    letters: Letters
    """Those of the file, by fold."""
    marks: list[Mark]
    """The vertices to look at."""


class ViewDocument(Facts):
    """What the page shows of a sheet."""

    format: Literal["exactfold view result"]
    version: Literal[2]
    name: str
    sheet: FlatSheet
    read: list[str]
    ways: list[Way]
    drawn: Drawn | None
    """The way with the letters of the file, if it is known."""
    folded: Folded
    """The sheet folded flat."""
    served: bool
    """Whether motions that are missing can be asked for."""


def view_document(
    sheet: PatternLike,
    *,
    name: str | None = None,
    branches: Sequence[str | Branch] | None = None,
    ways: Sequence[int] | None = None,
    frames: int = FRAMES,
    proving: bool = False,
    flat: bool = True,
    workers: int = 1,
    limit: float | Clock = LIMIT,
    progress: Progress | None = None,
) -> ViewDocument:
    """All that the page shows of a sheet, as JSON; `view_page` puts it into one HTML file.

    For a triangulated sheet with four corners, the document has its branches, each of which
    represents two mirror images. With up to ten foldable vertices these are all branches. For
    larger sheets they are the branch on which all vertices pop up, and its neighbours. `branches`
    selects branches instead, by their vertex signs or as they were found, and `ways` selects ways
    of rigid panels by their numbers. A convex triangulated sheet with more corners has one branch
    for each choice of vertices that pop up, and each represents a family over all boundary heights.
    For any other sheet, the document has the ways of its rigid panels, up to 200, in the order in
    which `count` lists them; a family is represented by one of its motions. If no way in the list
    has the letters of the file, but the sheet is proved to fold with them, that motion comes first.
    Each way is followed in `frames` frames to the first contact; if it cannot be followed, the
    document says why.

    In the time that is left, the flat-folded states of the sheet are searched for, and which of
    them its ways end in ([flat folding](docs/flat.md)), unless `flat` is false.

    With `proving`, motions along branches are proved, too (`prove`), and so are the first contacts
    of motions of panels that are proved to exist (`prove_contacts`). `workers` is the number of
    processes that share the work. `name` names the sheet. All this takes `limit` seconds, or
    ends with a clock that runs already: half of the time is for the search for ways, a quarter at
    most for the letters of the file, and a quarter at least for following ways. A way that is
    left says so.

    Raises the errors of `open_sheet`, `UsageError` for signs that do not fit, and
    `WorkerDiedError`. If nothing can be counted of a sheet, its document says why.

    >>> document = view_document("two-vertex", branches=["+-"], frames=5)
    >>> [(way["signs"], way["letters"], way["motion"]["end"]) for way in document["ways"]]
    [('+-', 'MVVVMVM', 'flat-fold')]
    """
    clock = limit if isinstance(limit, Clock) else Clock(limit)
    known = Known.of(
        sheet,
        name=name,
        branches=branches,
        ways=ways,
        frames=frames,
        proving=proving,
        clock=clock.share(3 / 4),
        progress=progress,
    )
    useful = max(1, len(known.listed) // _WORTH_A_PROCESS)
    pool = process_pool(min(workers, useful))
    following = clock.share(_FOLLOWING).at_least((clock.limit or 0.0) / 4)
    followed = known.followed(pool, following, progress)
    folded = known.folded(followed, pool, clock, progress) if flat else NOT_ASKED
    return known.document(followed, folded)


@dataclass(frozen=True)
class Known:
    """A sheet and the ways in which it folds, which have not been followed yet."""

    opened: Opened
    name: str
    known: Listed

    @property
    def listed(self) -> tuple[tuple[Way, Any], ...]:
        """The ways with the jobs that follow them."""
        return self.known.ways

    @property
    def follower(self) -> Callable[[Any], Followed]:
        """It does the job of a way."""
        return self.known.follower

    @classmethod
    def of(
        cls,
        sheet: PatternLike,
        *,
        name: str | None = None,
        branches: Sequence[str | Branch] | None = None,
        ways: Sequence[int] | None = None,
        frames: int = FRAMES,
        proving: bool = False,
        clock: Clock = UNLIMITED,
        progress: Progress | None = None,
    ) -> Known:
        """Compute what is known of a sheet; see `view_document`."""
        if not 2 <= frames <= MOST_FRAMES:
            raise UsageError(
                f"{frames} frames: a motion in a page needs at least 2 and at most {MOST_FRAMES}"
            )
        opened = open_sheet(sheet)
        title = name or (
            Path(sheet).stem if isinstance(sheet, str | PathLike) else "crease pattern"
        )
        listed = listed_ways(opened, branches, ways, frames, proving, progress, clock)
        return cls(opened, title, listed)

    def followed(self, pool: Pool, clock: Clock, progress: Progress | None) -> list[Way]:
        """All ways with their motions; first the one with the letters of the file.

        A way that is not begun before the clock has passed says that it was left.
        """
        ways = [way for way, _ in self.listed]
        first = -1 if self.known.drawn is None else self.known.drawn["way"]
        jobs = [k for k, (_, job) in enumerate(self.listed) if job is not None]
        jobs.sort(key=lambda k: k != first)
        begun = itertools.takewhile(lambda _: not clock.passed, jobs)
        left = set(jobs)
        for done, (k, followed) in enumerate(_numbered(pool, self.follower, self.listed, begun), 1):
            ways[k] = {**ways[k], **followed}
            left.discard(k)
            if progress is not None:
                progress("following", done, len(jobs))
        for k in left:
            ways[k] = {**ways[k], **not_followed(_left(ways[k], clock))}
        return ways

    def folded(
        self, ways: Sequence[Way], pool: Pool, clock: Clock, progress: Progress | None
    ) -> Folded:
        """The flat-folded states, and the ways that end in them, as far as the clock allows."""
        states = flat_states(self.opened, clock)
        sheets = [folded_sheet(one, clock) for one in states]
        ends = [] if not states else [*self.ends(states, ways, pool, clock, progress)]
        left = f"{clock.said}; `exactfold flat` looks for flat-folded states"
        if states:
            left = ""
        elif with_holes(self.opened):
            left = "folding flat is not done yet for sheets with holes"
        return {"sheets": sheets, "ends": sorted(ends, key=lambda end: end["way"]), "left": left}

    def ends(
        self,
        states: tuple[FlatStates, ...],
        ways: Sequence[Way],
        pool: Pool,
        clock: Clock,
        progress: Progress | None = None,
    ) -> Iterator[ClosedEnd]:
        """The ends of followed ways that close all their folds, as they are found."""
        if not isinstance(self.follower, FollowingPanels):
            return
        found = closing_ways(self.known, ways)
        jobs = ((k, way, ways[k]) for k, way in found)
        begun = itertools.takewhile(lambda _: not clock.passed, jobs)
        results = pool(Ending(self.follower, states, clock), begun)
        with closing(results):
            for done, (_, end) in enumerate(results, 1):
                if isinstance(end, WorkerDiedError):
                    raise end
                if progress is not None:
                    progress("closing", done, len(found))
                if end is not None:
                    yield end

    def document(self, ways: Sequence[Way], folded: Folded, served: bool = False) -> ViewDocument:
        """The whole document; `served` means that the page can ask for missing motions."""
        return {
            "format": "exactfold view result",
            "version": 2,
            "name": self.name,
            "sheet": sheet_json(self.opened),
            "read": list(self.opened.lines),
            **self.known.facts,
            "ways": [*ways],
            "drawn": self.known.drawn,
            "folded": folded,
            "served": served,
        }


def _left(way: Way, clock: Clock) -> str:
    """Why a way was not followed, and what to do."""
    name = f"--way {way['number']}" if way["number"] else "the options that name a way"
    return f"{clock.said}; `exactfold view` or `fold` with {name} follows it alone"


class _Numbered:
    """Does the work of a job that has a number."""

    def __init__(self, work: Callable[[Any], Followed]) -> None:
        self.work = work

    def __call__(self, numbered: tuple[int, Any]) -> Followed:
        return self.work(numbered[1])


def _numbered(
    pool: Pool,
    work: Callable[[Any], Followed],
    listed: Sequence[tuple[Any, Any]],
    jobs: Iterable[int],
) -> Iterable[tuple[int, Followed]]:
    """The number of each job with its result, in the order in which the jobs end."""
    results = pool(_Numbered(work), ((k, listed[k][1]) for k in jobs))
    with closing(results):
        for (k, _), outcome in results:
            if isinstance(outcome, WorkerDiedError):
                raise outcome
            yield k, outcome


def sheet_json(opened: Opened) -> FlatSheet:
    """The flat sheet: a FOLD object without letters, and everything else the page needs.

    `letters` are those of the file, by fold; they are shown if there is no way to fold.
    """
    pattern = opened.sheet
    if isinstance(pattern, CreasePattern):
        fold = fold_document(pattern)
        foldable = pattern.foldable_vertices if has_branches(pattern) else ()
    else:
        from exactfold.pattern.writing.panel_writing import converted

        fold, foldable = converted(Opened(pattern)).document(None), ()
    return {
        "fold": fold,
        "folds": [list(edge) for edge in pattern.folds],
        "triangles": [list(triangle) for triangle in triangles_of(pattern)],
        "interior": list(pattern.interior),
        "foldable": list(foldable),
        "letters": file_letters(opened),
        "marks": marks_of(opened),
    }
