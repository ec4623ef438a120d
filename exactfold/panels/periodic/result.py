"""What is known of the periodic motions of a tessellation of rigid panels."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Annotated, ClassVar, Literal, TypedDict

from exactfold._support.documents import Keywords, NotNegative, Pair, Positive, VerdictText
from exactfold._support.plurals import counted
from exactfold._support.results import Certified, Ways
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED, Verdict
from exactfold.errors import UsageError
from exactfold.exact.surds import Number, common_field
from exactfold.pattern.periodic.cells import Side
from exactfold.pattern.periodic.periodic_pattern import PeriodicPattern

_OTHER = str.maketrans("MV", "VM")


@dataclass(frozen=True)
class PeriodicPart:
    """A part of a motion that moves by itself: folds that are connected through their vertices.

    `densities` has a row for each fold that is not flat: fold angle / length as a linear function
    of `size` parameters. With one parameter, `letters` has M, V or F for each fold of the cell, on
    one side of the sheet; on the other all are exchanged.
    """

    size: int
    densities: Mapping[Side, tuple[Number, ...]] = field(repr=False)
    letters: str | None

    def signs_for(self, wanted: str) -> list[int]:
        """Of a part with letters: which of 1, -1 (reversed) and 0 (flat) agree with given ones."""
        letters = self.letters or ""
        forms = {1: letters, -1: letters.translate(_OTHER), 0: "F" * len(letters)}
        here = [k for k, letter in enumerate(letters) if letter != "F"]
        return [s for s, form in forms.items() if all(wanted[k] in (form[k], "U") for k in here)]


@dataclass(frozen=True)
class PeriodicMotion:
    """A component of the periodic motions to second order.

    It is `planar` if the folded sheet does not roll up (B = 0 on all of it); else `direction` is
    the vector n across which it rolls up, or None if n varies. `parts` move independently of each
    other. `folds` says whether all of its motions are proved to be the beginning of true ones.
    """

    dimension: int
    planar: bool
    direction: tuple[Number, Number] | None
    parts: tuple[PeriodicPart, ...]
    folds: Verdict

    @property
    def letters(self) -> str | None:
        """The letters of a motion with one part and one parameter, with M for the first fold."""
        return self.parts[0].letters if len(self.parts) == 1 else None

    @property
    def field_name(self) -> str:
        """The field of the densities."""
        rows = (x for part in self.parts for row in part.densities.values() for x in row)
        return common_field(rows).name

    def has(self, wanted: str) -> Verdict:
        """Whether some motion of the component has given letters, one for each fold; U is free."""
        active = {k for part in self.parts for k, x in enumerate(part.letters or "") if x != "F"}
        if any(part.letters is None for part in self.parts):
            return UNDECIDED
        if any(x in "MV" for k, x in enumerate(wanted) if k not in active):
            return REFUTED
        choices = [part.signs_for(wanted) for part in self.parts]
        if not all(choices):
            return REFUTED
        return PROVED if any(any(choice) for choice in choices) else REFUTED

    def to_dict(self) -> PeriodicMotionDocument:
        """The object in the JSON."""
        return {
            "dimension": self.dimension,
            "planar": self.planar,
            "direction": None if self.direction is None else [str(x) for x in self.direction],
            "field": self.field_name,
            "letters": self.letters,
            "parts": [
                {
                    "size": part.size,
                    "letters": part.letters,
                    "densities": {
                        "{}-{}({},{})".format(*fold): [str(x) for x in row]
                        for fold, row in part.densities.items()
                    },
                }
                for part in self.parts
            ],
            "folds": str(self.folds),
        }


class PeriodicPartDocument(TypedDict):
    """A part of a motion that moves by itself."""

    size: Positive
    """The number of its parameters."""
    letters: Annotated[str, Keywords(pattern="^[MVF]*$")] | None
    """With one parameter: a letter for each fold."""
    densities: dict[str, list[str]]
    """For each fold "u-v(i,j)" that moves: fold angle / length, linear in the parameters."""


class PeriodicMotionDocument(TypedDict):
    """A component of the periodic motions of rigid panels."""

    dimension: Positive
    """Its dimension."""
    planar: bool
    """Whether the folded sheet does not roll up."""
    direction: Pair[str] | None
    """The vector n across which it rolls up; null if it does not, or if n varies."""
    field: str
    """The field of all numbers; r1, r2, ... are its roots."""
    letters: Annotated[str, Keywords(pattern="^[MVF]*$")] | None
    """The letters, if it has one part with one parameter."""
    parts: list[PeriodicPartDocument]
    """Parts that move independently of each other."""
    folds: VerdictText
    """Whether all its motions are proved to begin true ones."""


class PanelCellDocument(TypedDict):
    """The periodic motions of a tessellation of rigid panels."""

    format: Literal["exactfold panel-cell result"]
    version: Literal[1]
    name: str | None
    """The file or the name of the cell."""
    status: Annotated[str, Keywords(enum=["proved", "undecided"])]
    """Proved: these are all components of the motions to second order."""
    reason: str
    """How it was proved, or what is open."""
    vertices: Positive
    """The number of vertices in the cell."""
    folds: list[list[int]]
    """The folds [u, v, i, j] in the order of the letters."""
    motions: list[PeriodicMotionDocument]
    """The components, the largest dimension first."""
    certificate: str | None
    """The certificate that was written."""
    seconds: NotNegative
    """The time that it took."""


class PeriodicMatchDocument(TypedDict):
    """Whether a periodic sheet starts to fold with given letters."""

    format: Literal["exactfold periodic-match result"]
    version: Literal[1]
    name: str | None
    """The file or the name of the cell."""
    letters: Annotated[str, Keywords(pattern="^[MVFU]*$")]
    """The letters, in the order of `folds`."""
    folds: list[list[int]]
    """The folds [u, v, i, j]."""
    direction: list[int] | None
    """The direction across which all edges roll up; null for rigid panels in all directions."""
    starts: VerdictText
    """Whether it starts to fold with them."""
    ways: list[Positive]
    """The ways of `count` that have the letters."""


@dataclass(frozen=True, repr=False)
class PanelCell(Ways[PeriodicMotion], Certified):
    """All motions of a tessellation of rigid panels to second order, with equal cells.

    `folds` are the edges that fold, in the order of the letters. With the status PROVED, `motions`
    are all irreducible components of the motions, for all directions n together.
    """

    WRITER: ClassVar[str] = "exactfold.panels.periodic.certificate:panel_cell_certificate"

    pattern: PeriodicPattern
    folds: tuple[Side, ...]
    status: Verdict
    reason: str
    motions: tuple[PeriodicMotion, ...]
    seconds: float = field(default=0.0, compare=False)

    def listed(self) -> tuple[PeriodicMotion, ...]:
        """The components."""
        return self.motions

    @property
    def field_names(self) -> tuple[str, ...]:
        """The fields of the densities of the components, each once."""
        return tuple(dict.fromkeys(motion.field_name for motion in self.motions))

    def with_letters(self, letters: str) -> tuple[Verdict, tuple[int, ...]]:
        """Whether the sheet starts to fold with given letters, and the components that do so.

        `letters` has M, V, F (flat) or U (free) for each fold. A motion and its mirror image are
        the same. Components are numbered from 1. Raises `UsageError` for other letters.
        """
        if len(letters) != len(self.folds) or set(letters) - set("MVFU"):
            raise UsageError(
                f"{letters!r}: give one of M, V, F, U for each of the "
                f"{counted(len(self.folds), 'fold')} of the cell"
            )
        answers = [motion.has(letters) for motion in self.motions]
        found = tuple(k + 1 for k, answer in enumerate(answers) if answer is PROVED)
        if found:
            return PROVED, found
        if self.status is not PROVED or UNDECIDED in answers:
            return UNDECIDED, ()
        return REFUTED, ()

    def __repr__(self) -> str:
        found = counted(len(self.motions), "component")
        return f"<PanelCell: {self.status}, {found}, {self.pattern!r}>"

    def to_dict(self, certificate: str | None = None, name: str | None = None) -> PanelCellDocument:
        """The object printed by `exactfold count CELL --json`."""
        return {
            "format": "exactfold panel-cell result",
            "version": 1,
            "name": name,
            "status": str(self.status),
            "reason": self.reason,
            "vertices": self.pattern.V,
            "folds": [list(fold) for fold in self.folds],
            "motions": [motion.to_dict() for motion in self.motions],
            "certificate": certificate,
            "seconds": round(self.seconds, 3),
        }


def fold_name(fold: Sequence[int]) -> str:
    """A fold in words: its ends, and how the second is moved.

    >>> fold_name((0, 1, -1, 0)), fold_name((0, 1, 0, 0))
    ('0-1(-1,0)', '0-1')
    """
    u, v, i, j = fold
    return f"{u}-{v}" + (f"({i},{j})" if i or j else "")
