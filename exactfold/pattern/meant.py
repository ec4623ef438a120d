"""The sheet that was meant: what is inferred from a drawing whose digits are inexact."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import partial
from typing import TYPE_CHECKING, Any, Final, TypeAlias, TypedDict

from exactfold._support.clock import Clock
from exactfold._support.documents import Natural, NotNegative
from exactfold._support.plurals import agreeing, counted
from exactfold.errors import NotApplicableError
from exactfold.exact.numbers import decimal_above
from exactfold.pattern.drawing.meant.left import left_relations, nearly, off_by
from exactfold.pattern.drawing.meant.values import Existence, Kind, Relation

if TYPE_CHECKING:
    from exactfold.pattern.drawing.meant.inference import Inference
    from exactfold.pattern.drawing.meant.values import Angles
    from exactfold.pattern.meant_sheet import Realized
    from exactfold.pattern.panel_pattern import PanelPattern
    from exactfold.pattern.reading import Reading

_KINDS: Final[tuple[tuple[str, tuple[Kind, ...]], ...]] = (
    ("straight", ("straight",)),
    ("Kawasaki", ("kawasaki",)),
    ("border", ("border",)),
    ("grid or mirrored", ("grid", "parallel", "mirrored", "sectors")),
)
"""The kinds of relations in words."""
_DISTANT: Final[tuple[Kind, ...]] = ("sectors", "mirrored", "parallel", "grid")
"""The kinds of relations on which no closing condition depends, as they are left out at need."""

_TURNED: Final[tuple[Kind, ...]] = ("mirrored", "grid")
"""The kinds of relations that a sheet loses if it is turned a little."""
_MOST_EDGES: Final = 1000
_Make: TypeAlias = "Callable[[PanelPattern, Angles, float], Realized]"


class RelationDocument(TypedDict):
    """A relation between the angles of edges."""

    name: str
    """What --without takes."""
    kind: Kind
    defect: NotNegative
    """By how much the drawing misses it: an angle times the shortest edge over the size."""


class MeantDocument(TypedDict):
    """The sheet that was meant by an inexact drawing, and how it was inferred."""

    eps: NotNegative | None
    """The noise level: relations that were meant miss by about so much of the size."""
    clear: NotNegative | None
    """The least defect of a relation that was not meant."""
    gap: NotNegative | None
    """How many times larger that is than the greatest defect of a relation that was meant."""
    chance: NotNegative | None
    """The number of relations that are expected by chance."""
    relations: list[RelationDocument]
    """Those of the meant sheet."""
    independent: Natural
    """So many of the relations imply all of them."""
    free_angles: Natural
    """So many angles stay free."""
    distance: NotNegative | None
    """The largest distance of a vertex from the drawing, by its size."""
    existence: Existence
    """How a sheet with all relations was proved to exist: by exact coordinates, or by exact
    directions of its folds and boxes that contain its vertices."""
    left_out: list[RelationDocument]
    """Relations that were found, too, but no exact sheet that has them."""
    left: list[RelationDocument]
    """Relations that the sheet of the answer nearly has; if there are any, the answer holds for
    these digits only."""
    reason: str
    """Why no sheet was inferred; empty if one was."""


@dataclass(frozen=True)
class Meant:
    """What is known of the sheet that an inexact drawing means.

    `noise` is the noise level, and no other relation is off by less than `clear`; the quotient of
    `clear` and the greatest defect is `gap`. `chance` is the expected number of relations by
    chance. `independent` of the `relations` imply all, and leave `free_angles` angles free. A sheet
    with all relations lies within `distance` of the drawing; `existence` says how that is proved.
    `left` are relations that the sheet of the answer nearly has. `reason` says why no sheet was
    inferred. `realized` has the sheet with the digits as written, and the exact one. `implied` maps
    a relation that was deleted to those that imply it all the same. `left_out` are relations that
    were found, too, but no exact sheet that has them.
    """

    noise: float | None = None
    clear: float | None = None
    gap: float | None = None
    chance: float | None = None
    relations: tuple[Relation, ...] = ()
    independent: int = 0
    free_angles: int = 0
    distance: float | None = None
    existence: Existence = "none"
    left: tuple[Relation, ...] = ()
    reason: str = ""
    realized: Realized | None = field(default=None, repr=False)
    implied: Mapping[str, tuple[str, ...]] = field(default_factory=dict, hash=False)
    left_out: tuple[Relation, ...] = ()

    @property
    def inferred(self) -> bool:
        """Whether the sheet of the answer is the sheet that was meant, not the drawing itself."""
        return self.existence != "none"

    @property
    def doubt(self) -> str:
        """Why an answer about this sheet is one about its digits only; empty if it is not."""
        if not self.left:
            return ""
        text = f"{nearly(self.left)}, so that answers hold only for these digits"
        if not self.reason:
            return text
        return f"{text}; the sheet that was meant is not known, because {self.reason}"

    @property
    def name(self) -> str:
        """What the sheet of the answer is."""
        return f"the sheet that was meant, within {self._within} of the drawing"

    @property
    def _within(self) -> str:
        """The distance in two digits, rounded up, so that what is proved of it still holds."""
        return decimal_above(Fraction(repr(self.distance or 0)), 2)

    @property
    def lines(self) -> tuple[str, ...]:
        """What was inferred, one sentence each."""
        if not self.inferred:
            return ()
        lines = []
        if self.noise is not None and self.clear is not None:
            lines.append(
                f"the drawing is inexact by {self.noise:.0e} of its size; nothing else is off by "
                f"less than {self.clear:.0e}"
            )
        chance = f"; by chance {self.chance:.0e} expected" if self.chance is not None else ""
        lines.append(
            f"{counted(len(self.relations), 'relation')} of angles ({kinds(self.relations)}), "
            f"{self.independent} independent{chance}"
        )
        lines.append(
            f"within {self._within} of the drawing there is a sheet with all of them - PROVED"
        )
        if self.existence == "box":
            lines.append(
                "the directions of its folds are exact; the positions of its vertices are enclosed"
            )
        if self.left_out:
            lines.append(
                f"{counted(len(self.left_out), 'more relation')} such as {self.left_out[0].name} "
                f"{agreeing(len(self.left_out), 'is')} nearly true, but no exact sheet with all "
                "relations was found; no condition at a vertex needs them"
            )
        return (*lines, *self.held)

    @property
    def held(self) -> tuple[str, ...]:
        """The relations that were deleted and hold all the same, one sentence each."""
        return tuple(
            f"{name} holds all the same, because of {', '.join(others)}"
            for name, others in self.implied.items()
        )

    @property
    def brief(self) -> str:
        """What was inferred, in a few words."""
        inexact = "" if self.noise is None else f"inexact by {self.noise:.0e}, "
        relations = counted(len(self.relations), "relation")
        enclosed = ", positions enclosed" if self.existence == "box" else ""
        moved = f"moved by up to {self._within}" if self.distance else "nothing moved"
        return f"{inexact}{relations} inferred, {moved}{enclosed}"

    @property
    def listed(self) -> tuple[str, ...]:
        """The relations, or those that nearly hold if none was inferred, one line each."""
        return off_by(self.relations if self.inferred else self.left)

    def certificate(self) -> dict[str, Any]:
        """The certificate that the sheet exists near the drawing and has all relations.

        Raises `NotApplicableError` if no sheet was inferred.
        """
        if self.realized is None or not self.inferred:
            raise NotApplicableError(f"no sheet was inferred from the drawing: {self.reason}")
        from exactfold.pattern.meant_sheet import certificate

        return certificate(self.realized, self.relations)

    def to_dict(self) -> MeantDocument:
        """The key `meant` of JSON."""
        return {
            "eps": self.noise,
            "clear": self.clear,
            "gap": self.gap,
            "chance": self.chance,
            "relations": [document(relation) for relation in self.relations],
            "independent": self.independent,
            "free_angles": self.free_angles,
            "distance": self.distance,
            "existence": self.existence,
            "left_out": [document(relation) for relation in self.left_out],
            "left": [document(relation) for relation in self.left],
            "reason": self.reason,
        }

    def __repr__(self) -> str:
        what = f"{self.independent} independent" if self.inferred else "nothing inferred"
        return f"<Meant: {counted(len(self.relations), 'relation')}, {what}>"


def document(relation: Relation) -> RelationDocument:
    """A relation as JSON."""
    return {"name": relation.name, "kind": relation.kind, "defect": relation.defect}


def kinds(relations: Iterable[Relation]) -> str:
    """How many relations of each kind there are, in words.

    >>> kinds([Relation("border", "border@1:0-2", (), 1, 0.0)])
    '1 border'
    """
    counts = Counter(relation.kind for relation in relations)
    numbers = [(sum(counts[kind] for kind in group), name) for name, group in _KINDS]
    return ", ".join(f"{number} {name}" for number, name in numbers if number)


def inferred(written: PanelPattern, reading: Reading) -> Meant:
    """The sheet that was meant by a drawing with inexact digits, or why none is inferred.

    `written` is the sheet with the digits as written; its coordinates are rational. If all
    coordinates are small in a frame along an edge, these are taken; if need be without relations to
    a grid of angles, as the drawing may be turned by whole degrees. If no exact sheet is found that
    has all relations, those between distant edges are left out, in the order of `_DISTANT`; this is
    done for sheets of up to 1,000 edges. If that does not help, positions are enclosed, with all
    relations or without all between distant edges. Once half of the time limit has passed, none of
    this is tried. Raises the errors of `infer` for relations that do not exist or contradict each
    other.
    """
    from exactfold.pattern.meant_sheet import NO_FRAME, enclose, in_a_frame, realize, recognise

    clock = Clock(reading.limit).share(1 / 2)
    all_found = _found(written, reading, ())

    def without(dropped: Sequence[Kind], make: _Make | None) -> Meant:
        found = _found(written, reading, dropped)
        make = make or partial(in_a_frame, relations=found.relations)
        fewer = _realized(written, found, make)
        kept = {relation.name for relation in fewer.relations}
        out = tuple(one for one in all_found.relations if one.name not in kept)
        return replace(fewer, left_out=out)

    if not reading.without:
        meant = _realized(written, all_found, partial(in_a_frame, relations=all_found.relations))
        if not meant.inferred and meant.realized is not None and meant.reason != NO_FRAME:
            meant = without(_TURNED, None)
        if meant.inferred and not meant.left:
            return meant
    first = meant = _realized(written, all_found, realize)
    if all_found.angles is None or meant.inferred:
        return meant

    if not clock.passed:
        meant = _realized(written, all_found, partial(recognise, relations=all_found.relations))
    kinds_found = {relation.kind for relation in all_found.relations}
    distant = [kind for kind in _DISTANT if kind in kinds_found]
    attempts = len(distant) if len(written.edges) <= _MOST_EDGES else 0
    for number in range(1, attempts + 1):
        if not meant.inferred and not clock.passed:
            meant = without(distant[:number], realize)
    for dropped in ([], distant) if distant else ([],):
        if not meant.inferred and not clock.passed:
            meant = without(dropped, enclose)
    if meant.inferred:
        return meant
    return replace(meant, reason=f"{first.reason}{f'; {clock.said}' if clock.passed else ''}")


def _found(written: PanelPattern, reading: Reading, dropped: Sequence[Kind]) -> Inference:
    from exactfold.pattern.drawing.meant.inference import infer

    return infer(
        [(Fraction(x), Fraction(y)) for x, y in written.vertices],  # type: ignore[arg-type]
        written.edges,
        written.boundary_edges,
        noise=reading.noise,
        unit=reading.unit,
        without=reading.without,
        also=reading.also,
        kinds_left_out=dropped,
    )


def _realized(
    written: PanelPattern,
    found: Inference,
    make: _Make,
) -> Meant:
    """What is known of the sheet that was meant, once `make` looked for it."""
    known = Meant(
        noise=found.noise if found.near else None,
        clear=found.clear,
        gap=found.gap if found.near else None,
        chance=found.chance,
        relations=found.relations,
        independent=found.independent,
        reason=found.reason,
        implied=found.implied,
    )
    if found.angles is None:
        return known
    made = make(written, found.angles, found.noise)
    known = replace(known, free_angles=len(found.angles.free), realized=made, reason=made.reason)
    if made.sheet is None:
        return known
    left = left_relations(made.sheet)
    return replace(known, distance=float(made.distance), existence=made.existence, left=left)
