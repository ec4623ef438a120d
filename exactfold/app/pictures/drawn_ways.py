"""What a picture shows of one way to fold: letters, vertex signs, and sizes of fold angles."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import dist
from typing import TYPE_CHECKING, Final

from exactfold.app.pictures.crease_drawing import CreaseDrawing, natural_size
from exactfold.app.pictures.crease_lines import crease_lines
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.letters import UPSIDE_DOWN
from exactfold.branches.values.result import BranchCount
from exactfold.pattern.crease_pattern import CreasePattern, Edge

if TYPE_CHECKING:
    from exactfold.motion.panels.followable import PanelMode
    from exactfold.motion.panels.listing import PanelWay
    from exactfold.panels.result import Decomposition
    from exactfold.pattern.panel_pattern import PanelPattern

_LONG: Final = 24
_NOTES: Final = {"refuted": "does not truly fold", "undecided": "truly folds: undecided"}
"""Notes on modes, by what is known about whether they truly fold."""


@dataclass(frozen=True)
class DrawnWay:
    """One way to fold, as it is drawn; `number` is its place in the list of `exactfold count`.

    `angles` are proportional to the fold angles; they are empty if nothing is proved of the fold
    angles. `note` says if the sheet does not truly fold in this way, or if this is not known.
    """

    pattern: CreasePattern | PanelPattern
    name: str
    letters: Mapping[Edge, str]
    signs: Mapping[int, int] = field(default_factory=dict)
    angles: Mapping[Edge, float] = field(default_factory=dict)
    number: int | None = None
    note: str = ""

    @property
    def text(self) -> str:
        """The letters in the order of the folds."""
        return "".join(self.letters.get(fold, "U") for fold in self.pattern.folds)

    @property
    def shared(self) -> str:
        """A text that is the same for both sides of the sheet: the smaller of their two texts."""
        return min(self.text, self.text.translate(UPSIDE_DOWN))

    @property
    def is_open_family(self) -> bool:
        """Whether folds are mountains in some ways of this family of panels, valleys in others."""
        return not self.signs and "U" in self.text

    def turned(self, side: int) -> DrawnWay:
        """The way itself for side 1; its mirror image, with all signs and letters reversed, for
        side -1.

        >>> from exactfold.branches.counting.find import find_branch
        >>> branch_way(find_branch("two-vertex", "+-")).turned(-1).text
        'VMMMVMV'
        """
        if side > 0:
            return self
        letters = {fold: letter.translate(UPSIDE_DOWN) for fold, letter in self.letters.items()}
        signs = {v: -sign for v, sign in self.signs.items()}
        angles = {fold: -angle for fold, angle in self.angles.items()}
        return replace(self, letters=letters, signs=signs, angles=angles)

    def drawing(self, size: float | None = None, *, small: bool = False) -> CreaseDrawing:
        """The drawing of the pattern with this way; with `small`, vertices have no numbers."""
        lines = crease_lines(self.pattern, self.letters)
        joined = True if small else None
        wide = size or natural_size(lines)
        return CreaseDrawing(
            lines, self.signs, self.angles, wide, not small, joined, self.is_open_family
        )

    def picture(self, title: str = "") -> str:
        """The crease pattern with this way as an SVG file."""
        parts = [part for part in (title, self.name, self.note) if part]
        return self.drawing().picture(", ".join(parts))


def branch_way(branch: Branch, number: int | None = None) -> DrawnWay:
    """A branch, drawn by the ray that represents it.

    >>> from exactfold.branches.counting.find import find_branch
    >>> way = branch_way(find_branch("two-vertex", "+-"))
    >>> way.name, way.text, sorted(way.signs.items())
    ('branch +-', 'MVVVMVM', [(4, 1), (5, -1)])
    """
    angles = {}
    if branch.heights:
        angles = {fold: float(bend) for fold, bend in branch.fold_angles.bends.items()}
    name = f"branch {'' if number is None else f'{number}: '}{shortened(branch.sign_text)}"
    return DrawnWay(branch.pattern, name, branch.assignment, branch.vertex_signs, angles, number)


def panel_way(
    way: PanelWay, pattern: PanelPattern, rates: Mapping[int | Edge, float] | None = None
) -> DrawnWay:
    """A way of a sheet of panels with the given rates, by default those with which it is followed.

    All other folds are flat. Lines have widths if a single mode folds; the modes of a family fold
    independently of each other.

    >>> from exactfold.panels.decomposition import decompose
    >>> from exactfold.motion.panels.listing import panel_ways
    >>> from exactfold.pattern.families import single_vertex
    >>> from exactfold.pattern.opening import panels
    >>> one = decompose(panels(single_vertex(4)))
    >>> way = panel_way(panel_ways(one)[0], one.pattern)
    >>> way.name, sorted(way.letters) == [*one.pattern.folds], len(way.angles)
    ('way 1', True, 4)
    """
    letters = dict.fromkeys(pattern.folds, "F")
    angles: dict[Edge, float] = {}
    if rates:
        for mode in way.modes:
            if rate := rates.get(mode.number, 0.0):
                turn = UPSIDE_DOWN if rate < 0 else {}
                letters |= {fold: x.translate(turn) for fold, x in mode.letters.items()}
                angles = {fold: rate * angle for fold, angle in first_angles(mode).items()}
        free = {fold: rate for fold, rate in rates.items() if fold in way.free}
        letters |= {fold: "V" if rate > 0 else "M" for fold, rate in free.items()}
        if len(rates) > 1:
            angles = {}
    else:
        letters |= way.letters
        if len(way.modes) == 1:
            angles = first_angles(way.modes[0])
    name = f"way {way.number}"
    if way.dimension > 1:
        name = f"{name}, a family of dimension {way.dimension}"
    note = _NOTES.get(str(way.verdict), "")
    return DrawnWay(pattern, name, letters, {}, angles, way.number, note)


def first_rates(mode: PanelMode) -> dict[Edge, float]:
    """Numbers in proportion to the first fold angles over lengths of a mode, in floats."""
    first = mode.folds[0]
    rates = {first: 1.0 if mode.letters[first] == "V" else -1.0}
    for k, known in mode.order_from(first):
        for fold in mode.stars[k].folds:
            rates.setdefault(fold, rates[known] * float(mode.choice[k].gain(known, fold)))
    return rates


def first_angles(mode: PanelMode) -> dict[Edge, float]:
    """Numbers in proportion to the first fold angles of a mode, in floats."""
    points = [(float(x), float(y)) for x, y in mode.pattern.vertices]
    return {(i, j): rate * dist(points[i], points[j]) for (i, j), rate in first_rates(mode).items()}


def ways_of(result: BranchCount | Decomposition, most: int | None = None) -> Sequence[DrawnWay]:
    """The ways that a count lists, in its order: all of them or the first `most`.

    >>> from exactfold.branches.counting.collect import count_branches
    >>> [way.number for way in ways_of(count_branches("two-vertex"))]
    [1, 2, 3, 4]
    """
    if isinstance(result, BranchCount):
        return [branch_way(branch, k) for k, branch in enumerate(result.branches[:most], 1)]
    from exactfold.motion.panels.listing import panel_ways

    return [panel_way(way, result.pattern) for way in panel_ways(result)[:most]]


def shortened(text: str, most: int = _LONG) -> str:
    """Signs or letters, truncated if there are many.

    >>> shortened("+-+-+-", 5)
    '+-+-…'
    """
    return text if len(text) <= most else f"{text[: most - 1]}…"
