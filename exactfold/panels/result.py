"""What is known of the motions of a sheet of rigid panels."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib import import_module
from typing import ClassVar, Literal

from exactfold._support.notebook import Page
from exactfold._support.results import Certified, Ways
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED, Verdict
from exactfold.panels.count_document import (
    AsWrittenDocument,
    ComponentsDocument,
    ModeDocument,
    MotionKeys,
    OfDigits,
    PanelCountDocument,
    PanelCountKeys,
    ProposalDocument,
    WayDocument,
)
from exactfold.panels.counts import Counts, by_dimension, of_each_dimension
from exactfold.panels.isolated import IsolatedWays
from exactfold.panels.modes.elementary import Support
from exactfold.panels.modes.extension import Extension
from exactfold.panels.modes.near_misses import NearMiss, near_limit
from exactfold.panels.partial import Drawn, Freedom
from exactfold.panels.spaces.found import FoundComponent
from exactfold.panels.spaces.subspaces import Leaf
from exactfold.panels.vertex.local import LocalMode
from exactfold.pattern.described import described_panels
from exactfold.pattern.meant import Meant
from exactfold.pattern.opened import ReadDocument, digits
from exactfold.pattern.panel_pattern import Edge, PanelPattern
from exactfold.pattern.rounding import half_step


@dataclass(frozen=True)
class Mode:
    """One elementary mode: a one-parameter motion, and whether it truly folds.

    `assignment` gives M or V for each active fold, seen from one side of the sheet; from the other
    side all letters are exchanged. `choice` are the local modes that form the mode.
    """

    active: tuple[int, ...]
    assignment: Mapping[Edge, str]
    extends: Extension
    choice: tuple[LocalMode, ...] = field(default=(), repr=False)

    def to_dict(self) -> ModeDocument:
        """The object of this mode in the JSON output."""
        return {
            "active": list(self.active),
            "assignment": {f"{i}-{j}": letter for (i, j), letter in self.assignment.items()},
            "extends": str(self.extends.verdict),
            "by": self.extends.by,
        }


@dataclass(frozen=True)
class Decomposition(Page, Ways[Mode], Certified):
    """The ways in which a sheet of rigid panels starts to fold, and which of them truly fold.

    `second_order` is {dimension: number} of the components of all motions to second order; some of
    these may not fold. It is None if it is not known, and `status` is PROVED if it is known. `true`
    is the same for the true configurations near the flat state. `rigid` says whether the sheet
    cannot move at all. `theory` is "modes" if all vertices have at most four folds, and "subspaces"
    otherwise.

    `flat` are the folds that stay flat in every real motion. `still` are further folds that are
    flat in every motion to second order. `free` are the folds whose two ends lie on the boundary.
    `held` are the folds that the caller held flat.

    If `second_order` is None, `found` is {dimension: number} of the components that were found and
    proved; there are at least this many. If `true` is None, `found_true` is the same for the
    components that are known to fold truly. If no such component is known, `modes` are modes that
    truly fold; there may be others. `drawn` is the answer for the letters of the drawing, if it was
    asked for. `near_misses` are loops with a product of gains within 1e-3 of 1, and
    `nearly_closing` those that noise or rounding may explain.

    `meant` says what was inferred if the digits of the drawing are inexact, and `as_written` is the
    answer for these digits alone. If `doubt` says why an answer would hold for the digits of the
    sheet only, the status is UNDECIDED, and `as_written` has that answer. `nearby` then has bounds
    of the degrees of freedom that hold for every sheet near the drawing, and `proposal` is a sheet
    that may have been meant.

    If `graphs` is a number n, the sheet is triangulated, and its solutions and its true
    configurations near the flat state are 2^n graphs over the boundary heights, each of dimension
    `pattern.D` (docs/any_border.md, Theorem 6, and docs/any_border.md, Theorem 8). Then the status
    is PROVED although `second_order`, the number of irreducible components, may be None.
    """

    pattern: PanelPattern
    theory: str
    status: Verdict
    rigid: Verdict
    second_order: Counts | None
    true: Counts | None
    flat: tuple[Edge, ...]
    free: tuple[Edge, ...]
    modes: tuple[Mode, ...] = ()
    modes_count: int | None = None
    reason: str = ""
    parts: tuple[Part, ...] = ()
    near_misses: tuple[NearMiss, ...] = ()
    held: tuple[Edge, ...] = ()
    read: ReadDocument | None = None
    found: Counts | None = None
    found_true: Counts | None = None
    still: tuple[Edge, ...] = ()
    meant: Meant | None = None
    doubt: str = ""
    as_written: OfDigits | None = None
    drawn: Drawn | None = None
    nearby: Freedom | None = None
    proposal: Proposal | None = None
    graphs: int | None = None
    seconds: float = field(default=0.0, compare=False)

    WRITER: ClassVar = "exactfold.panels.certificate:certificate_of_panels"
    LISTER: ClassVar = "exactfold.motion.panels.listing:way_documents"

    def listed(self) -> tuple[Mode, ...]:
        """`modes`."""
        return self.modes

    def to_dict(
        self, certificate: str | None = None, name: str | None = None
    ) -> PanelCountDocument:
        """The object printed by `exactfold count --json`: `schema("count")`.

        Fields that only branches of triangulated sheets have are null.
        """
        isolated = None if self.free or len(self.parts) != 1 else self.parts[0].isolated
        keys: PanelCountKeys = {
            "format": "exactfold count result",
            "version": 2,
            "pattern": described_panels(self.pattern, name),
            "ways": self.ways,
            "reason": self.reason,
            "method": self.theory,
            "why": "",
            "distinct": None,
            "with_multiplicity": None,
            "real": None if isolated is None else len(isolated.real),
            "nonreal": None if isolated is None else 2 * len(isolated.nonreal),
            "true_branches": str(
                UNDECIDED if self.true is None and self.graphs is None else PROVED
            ),
            "true_bounds": None,
            "dimension": None,
            "degree": None,
            "pieces": None,
            "certificate": certificate,
            "warnings": [],
            "seconds": round(self.seconds, 3),
            "open_questions": [part.reason for part in self.parts if part.reason],
            "settings": {},
            "branches": [],
            "theory": self.theory,
            "letters": None,
            "rigid": {PROVED: True, REFUTED: False}.get(self.rigid),
            "exceptional_vertices": [],
            "read": None if self.read is None else {**self.read},
            "meant": None if self.meant is None else self.meant.to_dict(),
            "as_written": None if self.as_written is None else self.as_written.of_digits(),
            **self.keys(),
        }
        if self.status is PROVED:
            by: Literal["enumeration", "theorem"] = (
                "enumeration" if self.second_order is not None else "theorem"
            )
            return {**keys, "status": "proved", "by": by}
        return {**keys, "status": "undecided", "by": None}

    def of_digits(self) -> AsWrittenDocument:
        """The key `as_written` of the answer for the sheet that was meant."""
        return {
            "sheet": digits(self.meant, self.read),
            "status": str(self.status),
            "reason": self.reason,
            "rigid": {PROVED: True, REFUTED: False}.get(self.rigid),
            "distinct": None,
            "components": self._components(),
        }

    def _components(self) -> ComponentsDocument:
        return {
            "second_order": by_dimension(self.second_order),
            "true": by_dimension(self.true),
            "found": by_dimension(self.found),
            "found_true": by_dimension(self.found_true),
            "graphs": None
            if self.graphs is None
            else {"vertices": self.graphs, "dimension": self.pattern.D},
        }

    def keys(self) -> MotionKeys:
        """The keys of JSON that belong to motions of panels."""
        return {
            "components": self._components(),
            "freedom": None if self.freedom is None else self.freedom.to_dict(),
            "drawn": None if self.drawn is None else self.drawn.to_dict(),
            "proposal": None if self.proposal is None else self.proposal.to_dict(),
            "modes_count": self.modes_count,
            "modes": [mode.to_dict() for mode in self.modes],
            "way_list": self._way_list(),
            "flat_folds": [f"{i}-{j}" for i, j in self.flat],
            "still_folds": [f"{i}-{j}" for i, j in self.still],
            "free_folds": [f"{i}-{j}" for i, j in self.free],
            "near_misses": [miss.to_dict() for miss in self.nearly_closing],
        }

    def _way_list(self) -> list[WayDocument]:
        """The ways that are listed; the room of motions numbers them, and imports this module."""
        module, _, name = self.LISTER.partition(":")
        listed: list[WayDocument] = getattr(import_module(module), name)(self)
        return listed

    @property
    def freedom(self) -> Freedom | None:
        """Bounds for the degrees of freedom near the flat sheet; None if nothing bounds them."""
        if self.doubt:
            return self.nearby
        bounds = [part.freest for part in self.parts]
        dimensions = [part.dimension for part in self.parts]
        if None in bounds:
            return None
        free = len(self.free)
        return Freedom(
            free + sum(part.least for part in self.parts),
            free + sum(bound or 0 for bound in bounds),
            None if None in dimensions else free + sum(size or 0 for size in dimensions),
        )

    @property
    def known(self) -> Decomposition:
        """This answer, or, if it is doubted, what is known for the digits as they are read."""
        known = self.as_written
        return known if self.doubt and isinstance(known, Decomposition) else self

    @property
    def ways(self) -> int | None:
        """The number of components that truly fold, or if `true` is None, of those to second order;
        0 for a rigid sheet, None if neither is known.
        """
        known = self.second_order if self.true is None else self.true
        if known is None:
            return None
        return sum(number for dimension, number in known.items() if dimension)

    @property
    def warning(self) -> str | None:
        """A warning about the drawing to read before the result: a loop that nearly closes."""
        if not (near := self.nearly_closing):
            return None
        more = len(near) - 1
        return near[0].text + (f"; --json lists {more} more" if more else "")

    @property
    def nearly_closing(self) -> tuple[NearMiss, ...]:
        """Those of `near_misses` that the noise of the drawing explains, or that decimals that may
        be rounded make more likely than chance does."""
        decimals = self.near_misses and half_step(self.pattern.vertices) > 0
        loops = sum(part.loops for part in self.parts) if decimals else 0
        limit = near_limit(None if self.meant is None else self.meant.noise, loops)
        return tuple(miss for miss in self.near_misses if miss.off < limit)

    def __repr__(self) -> str:
        counts = "" if self.second_order is None else f", {dict(self.second_order)}"
        return f"<Decomposition: {self.status}{counts}, {self.pattern!r}>"


@dataclass(frozen=True)
class Proposal:
    """A sheet that may have been meant by a drawing without a clear noise level.

    It is the one that the noise level `noise` gives, and `answer` is what is known of it. It has so
    many `relations`, which the drawing misses by up to `missed`, and lies within `distance` of it;
    both are shares of the size. The noise levels `others` give other sheets.
    """

    noise: float
    missed: float
    relations: int
    distance: float
    answer: OfDigits
    others: tuple[float, ...] = ()

    def to_dict(self) -> ProposalDocument:
        """The key `proposal` of JSON."""
        known = self.answer if isinstance(self.answer, Decomposition) else None
        freedom = None if known is None else known.freedom
        drawn = None if known is None else known.drawn
        return {
            "noise": self.noise,
            "missed": self.missed,
            "relations": self.relations,
            "distance": self.distance,
            "answer": self.answer.of_digits(),
            "freedom": None if freedom is None else freedom.to_dict(),
            "drawn": None if drawn is None else drawn.to_dict(),
            "others": list(self.others),
        }


@dataclass(frozen=True)
class Part:
    """A part of the sheet that moves independently: vertices joined by folds that may fold.

    If some vertices have more than four folds, `spaces` are the leaves, and `spaces_fold` says of
    each whether it is shown to fold. `dimension` is the dimension of the first-order motions, or
    None where it was not needed. `most` is an upper bound for the dimension of true motions, where
    these are not all known. `found` are the components that were found, if not all are known
    or not all are known to fold. `still` are the folds that are flat in every motion to second
    order. `by_tree` says that the vertices form a tree along which the components were counted;
    then each of them is known to fold, and none is listed. `isolated` are all complex motions, if
    these were found by their number (docs/panels.md, Isolated ways). `loops` is the number of loops
    of folds that do not close.
    """

    vertices: tuple[int, ...]
    theory: str
    second_order: Counts | None
    true: Counts | None
    supports: tuple[Support, ...] = ()
    spaces: tuple[Leaf, ...] = ()
    spaces_fold: tuple[bool, ...] = ()
    modes: tuple[Mode, ...] = ()
    dimension: int | None = None
    most: int | None = None
    near_misses: tuple[NearMiss, ...] = ()
    loops: int = 0
    reason: str = ""
    found: tuple[FoundComponent, ...] = ()
    still: tuple[Edge, ...] = ()
    by_tree: bool = False
    isolated: IsolatedWays | None = None

    @property
    def at_least(self) -> Counts | None:
        """{dimension: number} of the components that are known; None if none is."""
        if self.second_order is not None:
            return self.second_order
        return of_each_dimension(one.dimension for one in self.found) or None

    @property
    def folding(self) -> Counts | None:
        """{dimension: number} of the components to second order that are known to fold truly, or
        None.
        """
        if self.true is not None:
            return self.true
        if self.by_tree:
            return self.second_order
        shown = zip(self.spaces, self.spaces_fold, strict=True)
        known = of_each_dimension(leaf.dimension for leaf, folds in shown if folds)
        by_components = of_each_dimension(one.dimension for one in self.found if one.folds)
        return {
            d: max(known.get(d, 0), by_components.get(d, 0)) for d in {**known, **by_components}
        } or None

    @property
    def freest(self) -> int | None:
        """An upper bound for the dimension of true motions; None if nothing bounds it.

        The dimension to second order is none: the tangent cone of real solutions may have a smaller
        dimension than they have, as that of x^2 + y^2 = z^3.
        """
        return self.most if self.true is None else max(self.true)

    @property
    def least(self) -> int:
        """A dimension that some family of true motions is proved to have.

        Modes that move no common vertex fold independently.
        """
        apart: set[int] = set()
        number = 0
        for mode in sorted(self.modes, key=lambda mode: len(mode.active)):
            if mode.extends.verdict is PROVED and not apart.intersection(mode.active):
                apart.update(mode.active)
                number += 1
        return max(number, *(self.folding or {0: 1}))

    @property
    def folds(self) -> bool:
        """Whether some motion of the part is known to fold truly."""
        return bool(self.folding and set(self.folding) != {0})
