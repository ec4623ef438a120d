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
        return CreaseDrawing(lines, self.signs, self.angles, wide, not small, joined)

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


def mode_way(mode: PanelMode) -> DrawnWay:
    """An elementary mode of a sheet of panels; all folds that are not active are flat.

    >>> from exactfold.panels.decomposition import decompose
    >>> from exactfold.motion.panels.followable import panel_modes
    >>> from exactfold.pattern.families import single_vertex
    >>> from exactfold.pattern.opening import panels
    >>> way = mode_way(panel_modes(decompose(panels(single_vertex(4))))[0])
    >>> way.name, sorted(way.letters) == sorted(way.angles)
    ('mode 1', True)
    """
    points = [(float(x), float(y)) for x, y in mode.pattern.vertices]
    first = mode.folds[0]
    rates = {first: 1.0 if mode.letters[first] == "V" else -1.0}
    for k, known in mode.order_from(first):
        for fold in mode.stars[k].folds:
            rates.setdefault(fold, rates[known] * float(mode.choice[k].gain(known, fold)))
    angles = {(i, j): rate * dist(points[i], points[j]) for (i, j), rate in rates.items()}
    letters = {fold: mode.letters.get(fold, "F") for fold in mode.pattern.folds}
    note = _NOTES.get(str(mode.extends.verdict), "")
    return DrawnWay(mode.pattern, f"mode {mode.number}", letters, {}, angles, mode.number, note)


def ways_of(result: BranchCount | Decomposition, most: int | None = None) -> Sequence[DrawnWay]:
    """The ways that a count lists, in its order: all of them or the first `most`.

    If a sheet of panels has only families, no way is listed; then the result has the known ways in
    these families.

    >>> from exactfold.branches.counting.collect import count_branches
    >>> [way.number for way in ways_of(count_branches("two-vertex"))]
    [1, 2, 3, 4]
    """
    if isinstance(result, BranchCount):
        return [branch_way(branch, k) for k, branch in enumerate(result.branches[:most], 1)]
    from exactfold.motion.panels.followable import panel_modes

    known = panel_modes(result)[: len(result.modes) or None]
    return [mode_way(mode) for mode in known[:most]]


def shortened(text: str, most: int = _LONG) -> str:
    """Signs or letters, truncated if there are many.

    >>> shortened("+-+-+-", 5)
    '+-+-…'
    """
    return text if len(text) <= most else f"{text[: most - 1]}…"
