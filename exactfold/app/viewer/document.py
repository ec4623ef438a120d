"""What the page shows, as one JSON document: the sheet, its ways to fold, and what is proved."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from contextlib import closing
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final, Literal, TypedDict, TypeVar

from exactfold._support.documents import Fold, Keywords, Natural, ProvedOrNot, Triangle
from exactfold._support.plurals import counted
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.app.viewer.marks import Mark, marks_of
from exactfold.app.viewer.ways import (
    Followed,
    Following,
    FollowingPanels,
    Letters,
    Way,
    branch_way,
    component_way,
    mode_way,
)
from exactfold.branches.counting.find import BranchFinder
from exactfold.branches.counting.pools import Pool, process_pool
from exactfold.branches.counting.ways import count_opened, decompose_opened
from exactfold.errors import ExactfoldError, InputError, UsageError, WorkerDiedError
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.fold_writing import fold_document
from exactfold.pattern.loading import PatternLike, open_sheet
from exactfold.pattern.opening import Opened, has_branches
from exactfold.pattern.triangulating import triangles_of

if TYPE_CHECKING:
    from exactfold.branches.values.branch import Branch
    from exactfold.branches.values.result import BranchCount

MOST_LISTED: Final = 10
"""With up to this many foldable vertices, all branches are listed."""
MOST_NEIGHBOURS: Final = 24
MOST_COMPONENTS: Final = 200
FRAMES: Final = 32
MOST_FRAMES: Final = 1000

_WORTH_A_PROCESS: Final = 6
"""Following this many motions takes about as long as starting a process."""
_LETTER: Final = {"M": "M", "V": "V", "F": "F", "J": "F"}
"""Letters of a file as the page draws them; all other letters are drawn as unassigned."""
_SECONDS: Final = re.compile(r" \(\d+\.\d+ s\)")

J = TypeVar("J")


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


class Facts(TypedDict):
    """What is known of the ways in which a sheet folds."""

    kind: Literal["branches", "panels"]
    answer: str
    status: ProvedOrNot
    complete: bool
    """Whether `ways` are proved to be all."""
    reason: str
    notes: list[str]


class ViewDocument(Facts):
    """What the page shows of a sheet."""

    format: Literal["exactfold view result"]
    version: Literal[1]
    name: str
    sheet: FlatSheet
    read: list[str]
    ways: list[Way]
    served: bool
    """Whether motions that are missing can be asked for."""


def view_document(
    sheet: PatternLike,
    *,
    name: str | None = None,
    branches: Sequence[str] | None = None,
    frames: int = FRAMES,
    proving: bool = False,
    workers: int = 1,
    progress: Progress | None = None,
) -> ViewDocument:
    """All that the page shows of a sheet, as JSON; `view_page` puts it into one HTML file.

    For a triangulated sheet with four corners, the document has its branches, each of which
    represents two mirror images. With up to ten foldable vertices these are all branches. For
    larger sheets they are the branch on which all vertices pop up, and its neighbours. `branches`
    selects branches by their vertex signs instead. For any other sheet, the document has the
    components of the motions of its rigid panels, up to 200, and the modes that cannot be followed.
    Each way is followed in `frames` frames to the first contact; if it cannot be followed, the
    document says why.

    With `proving`, motions along branches are proved, too (`prove`), and so are the first contacts
    of motions of panels that are proved to exist (`prove_contacts`). `workers` is the number of
    processes that share the work. `name` names the sheet.

    Raises the errors of `open_sheet`, `UsageError` for signs that do not fit, and
    `WorkerDiedError`. If nothing can be counted of a sheet, its document says why.

    >>> document = view_document("two-vertex", branches=["+-"], frames=5)
    >>> [(way["signs"], way["letters"], way["motion"]["end"]) for way in document["ways"]]
    [('+-', 'MVVVMVM', 'flat-fold')]
    """
    known = Known.of(
        sheet, name=name, branches=branches, frames=frames, proving=proving, progress=progress
    )
    useful = max(1, len(known.listed) // _WORTH_A_PROCESS)
    return known.document(known.followed(process_pool(min(workers, useful)), progress))


@dataclass(frozen=True)
class Known:
    """A sheet and the ways in which it folds, which have not been followed yet.

    Each entry of `listed` is a way as JSON and the job that follows it, or None if it is not
    followed. `follower` does such a job. `facts` are keys of the document.
    """

    opened: Opened
    name: str
    follower: Callable[[Any], Followed]
    listed: tuple[tuple[Way, Any], ...]
    facts: Facts

    @classmethod
    def of(
        cls,
        sheet: PatternLike,
        *,
        name: str | None = None,
        branches: Sequence[str] | None = None,
        frames: int = FRAMES,
        proving: bool = False,
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
        pattern = opened.sheet
        folds_along_branches = isinstance(pattern, CreasePattern) and has_branches(pattern)
        if branches is not None and not folds_along_branches:
            raise UsageError(
                "vertex signs name branches, but this sheet folds along modes of rigid panels; "
                "leave the signs out, and all modes are shown"
            )
        try:
            if isinstance(pattern, CreasePattern) and folds_along_branches:
                known_branches = _branches(opened, pattern, branches, progress)
                facts, follower = _branch_facts(known_branches), Following(frames, proving)
                listed = tuple((branch_way(branch), branch) for branch in known_branches.branches)
                return cls(opened, title, follower, listed, facts)
            return _panels(opened, title, frames, proving, progress)
        except (InputError, UsageError, WorkerDiedError):
            raise
        except ExactfoldError as error:
            nothing: Facts = {
                "kind": "branches" if folds_along_branches else "panels",
                "answer": "nothing is known about how this sheet folds",
                "status": "undecided",
                "complete": False,
                "reason": str(error),
                "notes": [],
            }
            return cls(opened, title, Following(frames), (), nothing)

    def followed(self, pool: Pool, progress: Progress | None) -> list[Way]:
        """All ways with their motions."""
        ways = [way for way, _ in self.listed]
        jobs = [k for k, (_, job) in enumerate(self.listed) if job is not None]
        for done, (k, followed) in enumerate(_numbered(pool, self.follower, self.listed, jobs), 1):
            ways[k] = {**ways[k], **followed}
            if progress is not None:
                progress("following", done, len(jobs))
        return ways

    def document(self, ways: Sequence[Way], served: bool = False) -> ViewDocument:
        """The whole document; `served` means that the page can ask for missing motions."""
        return {
            "format": "exactfold view result",
            "version": 1,
            "name": self.name,
            "sheet": _sheet_json(self.opened),
            "read": list(self.opened.lines),
            **self.facts,
            "ways": [*ways],
            "served": served,
        }


@dataclass(frozen=True)
class _Branches:
    """Branches of a triangulated sheet, and their count if all branches were counted."""

    pattern: CreasePattern
    branches: tuple[Branch, ...]
    count: BranchCount | None


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


def _branches(
    opened: Opened,
    pattern: CreasePattern,
    chosen: Sequence[str] | None,
    progress: Progress | None,
) -> _Branches:
    foldable = pattern.foldable_vertices
    if chosen is None and len(foldable) <= MOST_LISTED:
        count = count_opened(opened, progress=progress)
        return _Branches(pattern, tuple(count.known), count)  # type: ignore[arg-type]
    finder = BranchFinder(pattern)
    if chosen is not None:
        vectors = [finder.signs(signs, None) for signs in dict.fromkeys(chosen)]
        branches = [finder.find(signs, progress=progress) for signs in vectors]
        return _Branches(pattern, tuple(branches), None)
    up = finder.signs(None, foldable)
    near = finder.neighbours(up, foldable[:MOST_NEIGHBOURS], progress=progress)
    return _Branches(pattern, (finder.find(up), *near.values()), None)


def _branch_facts(known_branches: _Branches) -> Facts:
    if known_branches.count is not None:
        from exactfold.app.report.count import answer

        count = known_branches.count
        whole = count.status is PROVED and len(count) == (count.real or 0)
        return {
            "kind": "branches",
            "answer": _SECONDS.sub("", answer(count).plain),
            "status": str(count.status),
            "complete": whole,
            "reason": count.reason,
            "notes": [] if count.warning is None else [f"warning: {count.warning}"],
        }
    vertices = counted(len(known_branches.pattern.foldable_vertices), "foldable vertex")
    proved = all(branch.status is PROVED for branch in known_branches.branches)
    return {
        "kind": "branches",
        "answer": f"{counted(len(known_branches.branches), 'branch')} of a sheet with {vertices}",
        "status": str(PROVED if proved else UNDECIDED),
        "complete": False,
        "reason": "each branch was found by its vertex signs, and "
        f"{'all are' if proved else 'not all are'} proved; the branches of the sheet were not "
        "counted",
        "notes": [],
    }


def _panels(
    opened: Opened, name: str, frames: int, proving: bool, progress: Progress | None
) -> Known:
    from exactfold.app.report.panels import panels_answer
    from exactfold.motion.panels.followable import (
        open_reason,
        panel_components,
        panel_modes,
        why_nothing_follows,
    )

    answer = decompose_opened(opened, progress=progress)
    ways = answer.known
    modes = panel_modes(ways)
    by_number = {mode.number: mode for mode in modes}
    components = panel_components(ways, modes)
    shown = components[:MOST_COMPONENTS]
    listed: list[tuple[Way, Any]] = [
        (component_way(ways, component, by_number), k) for k, component in enumerate(shown, 1)
    ]
    open_modes = [mode for mode in modes if mode.extends.verdict is not PROVED]
    listed += [(mode_way(mode, open_reason(mode)), None) for mode in open_modes[:MOST_COMPONENTS]]
    notes = [] if ways.warning is None else [f"warning: {ways.warning}"]
    left = len(components) - len(shown)
    if left:
        notes.append(f"{counted(left, 'more component')} left out")
    if not components and ways.rigid is not PROVED:
        notes.append(f"no motion can be followed: {why_nothing_follows(ways, modes)}")
    facts: Facts = {
        "kind": "panels",
        "answer": _SECONDS.sub("", panels_answer(answer).plain),
        "status": str(answer.status),
        "complete": answer.true is not None
        and Counter(component.dimension for component in shown)
        == {dimension: number for dimension, number in answer.true.items() if dimension},
        "reason": answer.reason,
        "notes": notes,
    }
    return Known(opened, name, FollowingPanels(ways, frames, proving), tuple(listed), facts)


def _sheet_json(opened: Opened) -> FlatSheet:
    """The flat sheet: a FOLD object without letters, and everything else the page needs.

    `letters` are those of the file, by fold; they are shown if there is no way to fold.
    """
    pattern = opened.sheet
    if isinstance(pattern, CreasePattern):
        fold = fold_document(pattern)
        foldable = pattern.foldable_vertices if has_branches(pattern) else ()
    else:
        from exactfold.pattern.panel_writing import converted

        fold, foldable = converted(Opened(pattern)).document(None), ()
    return {
        "fold": fold,
        "folds": [list(edge) for edge in pattern.folds],
        "triangles": [list(triangle) for triangle in triangles_of(pattern)],
        "interior": list(pattern.interior),
        "foldable": list(foldable),
        "letters": "".join(
            _LETTER.get(opened.assignment.get(edge, "U"), "U") for edge in pattern.folds
        ),
        "marks": marks_of(opened),
    }
