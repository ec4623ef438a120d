"""`vertices`: what is known of each vertex of a sheet by itself, and what to change there."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Final

from exactfold._support.plurals import agreeing, counted
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED, Verdict
from exactfold.design.panels.vertex.document import (
    RepairDocument,
    VertexDocument,
    VerticesDocument,
    VerticesSummary,
)
from exactfold.design.panels.vertex.facts import VertexFacts, vertex_facts
from exactfold.design.panels.vertex.repair import Repair, repaired
from exactfold.design.refutations.asked import by_fold
from exactfold.design.refutations.refutation import Letters
from exactfold.panels.nearby.box import box_of
from exactfold.panels.vertex.stars import Star, star_at
from exactfold.panels.vertex.vertex_motions import Fan
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.described import described_panels
from exactfold.pattern.loading import PatternLike, open_sheet
from exactfold.pattern.meant import Meant
from exactfold.pattern.opening import Opened, panels
from exactfold.pattern.panel_pattern import Edge, PanelPattern
from exactfold.pattern.remembered import remembered

_OTHER: Final = {"M": "V", "V": "M"}


@dataclass(frozen=True, repr=False)
class Vertices:
    """What is known of each vertex of a sheet by itself (docs/vertices.md).

    `starts` says whether every vertex starts to fold with its letters. If it is REFUTED, no finite
    folding of the sheet near the flat state has these letters. If it is PROVED, the vertices may
    still not fold together: that is what `match` and `count` decide. `letters` has a letter for
    every fold; if no fold is a mountain or a valley, `starts` is PROVED where it is not open.
    `facts` has one entry for each interior vertex. `meant` says what was inferred if the digits of
    the drawing are inexact.
    """

    pattern: PanelPattern
    letters: Letters
    facts: tuple[VertexFacts, ...]
    meant: Meant | None = None
    seconds: float = field(default=0.0, compare=False)

    @property
    def starts(self) -> Verdict:
        """Whether every vertex starts to fold with its letters."""
        if self.refuted:
            return REFUTED
        return UNDECIDED if self.open else PROVED

    @property
    def status(self) -> Verdict:
        """PROVED if the question is answered, whatever the answer; else UNDECIDED."""
        return UNDECIDED if self.starts is UNDECIDED else PROVED

    @property
    def refuted(self) -> tuple[VertexFacts, ...]:
        """The vertices that cannot have their letters."""
        return tuple(v for v in self.facts if v.starts is REFUTED)

    @property
    def open(self) -> tuple[VertexFacts, ...]:
        """The vertices where nearly straight folds leave the answer open."""
        return tuple(v for v in self.facts if v.starts is UNDECIDED)

    @property
    def unable(self) -> tuple[VertexFacts, ...]:
        """The vertices that do not fold with any letters."""
        return tuple(v for v in self.facts if not v.able)

    @property
    def meant_flat(self) -> bool:
        """Whether at least half of the vertices satisfy Kawasaki's condition to 0.1 degrees."""
        fit = sum(v.kawasaki or v.nearly_kawasaki for v in self.facts)
        return 2 * fit >= len(self.facts) > 0

    @property
    def wrong(self) -> tuple[VertexFacts, ...]:
        """The vertices to look at.

        They do not start to fold, or that is open; these come first. Where the sheet seems meant to
        be folded flat (`meant_flat`), vertices follow at which Kawasaki's condition is off by more
        than 0.1 degrees, or Maekawa's does not hold.
        """
        stuck = tuple(v for v in self.facts if v.starts is not PROVED or not v.able)
        if not self.meant_flat:
            return stuck
        rest = (v for v in self.facts if v not in stuck)
        flawed = (v for v in rest if not (v.kawasaki or v.nearly_kawasaki) or v.maekawa is False)
        return stuck + tuple(flawed)

    @property
    def reason(self) -> str:
        """Why not every vertex starts to fold, by vertex; empty if all do."""
        why = self.refuted or self.open
        return "; ".join(f"vertex {v.vertex}: {v.reason}" for v in why)

    @property
    def headline(self) -> str:
        """The answer in words, without its status."""
        count = len(self.facts)
        if not count:
            if self.pattern.holes:
                return "the sheet has no interior vertex"
            return "the sheet has no interior vertex, so that every fold can move by itself"
        if {"M", "V"}.isdisjoint(self.letters.values()):
            return self._without_letters()
        if count == len(self.refuted) > 1:
            return f"none of the {count} vertices can start to fold with its letters"
        if self.refuted:
            return f"{_which(self.refuted, count)} cannot start to fold with {_their(self.refuted)}"
        if self.open:
            open_ = _which(self.open, count)
            return f"whether {open_} can start to fold with {_their(self.open)} is open"
        if count == 1:
            return "the only interior vertex starts to fold with its letters"
        return f"all {count} vertices start to fold with their letters"

    def _without_letters(self) -> str:
        count = len(self.facts)
        if self.open:
            return f"whether {_which(self.open, count)} can start to fold is open"
        if self.unable:
            stay = agreeing(len(self.unable), "stays")
            return f"{_which(self.unable, count)} {stay} flat, whatever the letters"
        if count == 1:
            return "the only interior vertex starts to fold with some letters"
        return f"each of the {count} vertices starts to fold with some letters"

    @property
    def notes(self) -> tuple[str, ...]:
        """What follows for the sheet, what is asked for, and what is known of folding flat."""
        notes = []
        if self.pattern.holes:
            notes.append(
                "whether the panels round a hole fit together is not looked at here: see "
                "`exactfold count`"
            )
        if self.refuted:
            notes.append(
                "so the sheet as a whole cannot start to fold with these letters if its panels are "
                "rigid and all move together; a model that is folded step by step can be right"
            )
        if self.facts:
            notes.append(self.flat_line)
        return tuple(notes)

    @property
    def flat_line(self) -> str:
        """At how many vertices the conditions for folding flat hold, in words."""
        count = len(self.facts)
        near = sum(v.nearly_kawasaki for v in self.facts)
        nearly = f", to 0.1 degrees at {near} more" if near else ""
        line = f"Kawasaki's condition holds at {_of(sum(v.kawasaki for v in self.facts), count)}"
        known = [v.maekawa for v in self.facts if v.maekawa is not None]
        if not known:
            return f"{line}{nearly}"
        return f"{line}{nearly}, Maekawa's at {_of(sum(known), len(known))}" + (
            "" if len(known) == count else " with all letters"
        )

    def flips(self, facts: VertexFacts) -> tuple[tuple[Edge, ...], ...]:
        """The smallest changes of letters for a vertex, those first after which the fewest
        vertices fail.
        """
        return tuple(sorted(facts.flips, key=lambda flip: (len(self.failing(facts, flip)), flip)))

    def failing(self, facts: VertexFacts, flip: Iterable[Edge]) -> tuple[int, ...]:
        """The other vertices that cannot have their letters after letters were exchanged."""
        exchanged = {e: _OTHER[self.letters[e]] for e in flip}
        ends = {v for e in exchanged for v in e if v in self._fans} - {facts.vertex}
        return tuple(
            v
            for v in sorted(ends)
            if not self._fans[v][1].folds(
                [exchanged.get(e, self.letters[e]) for e in self._fans[v][0].folds]
            )
        )

    @cached_property
    def repair(self) -> Repair | None:
        """The smallest change of letters found for the whole sheet; None if no vertex is refuted.

        The search takes a few seconds where many vertices are refuted.
        """
        return repaired(self._fans, self.letters) if self.refuted else None

    @cached_property
    def _fans(self) -> dict[int, tuple[Star, Fan]]:
        stars = (star_at(self.pattern, v) for v in self.pattern.interior)
        return {star.vertex: (star, Fan(star)) for star in stars}

    @property
    def summary(self) -> VerticesSummary:
        """The facts in short, as in `exactfold info --json`."""
        return {
            "starts": str(self.starts),
            "refuted": [v.vertex for v in self.refuted],
            "never": [v.vertex for v in self.unable],
            "kawasaki": sum(v.kawasaki for v in self.facts),
            "maekawa": sum(v.maekawa is True for v in self.facts),
        }

    def to_dict(self, name: str | None = None) -> VerticesDocument:
        """The object that `exactfold vertices --json` prints: `schema("vertices")`."""
        return {
            "format": "exactfold vertices result",
            "version": 1,
            "pattern": described_panels(self.pattern, name),
            "status": str(self.status),
            "starts": str(self.starts),
            "letters": {_name(e): x for e, x in self.letters.items()},
            "kawasaki": self.summary["kawasaki"],
            "maekawa": self.summary["maekawa"],
            "vertices": [self._document(v) for v in self.facts],
            "repair": self._repair(),
            "reason": self.reason,
            "meant": None if self.meant is None else self.meant.to_dict(),
            "seconds": round(self.seconds, 3),
        }

    def _repair(self) -> RepairDocument | None:
        if self.repair is None:
            return None
        return {
            "folds": [_name(e) for e in self.repair.folds],
            "stuck": list(self.repair.stuck),
        }

    def _document(self, facts: VertexFacts) -> VertexDocument:
        turn = facts.turn
        return {
            "vertex": facts.vertex,
            "degree": len(facts.folds),
            "folds": [_name(e) for e in facts.folds],
            "letters": list(facts.letters),
            "starts": str(facts.starts),
            "able": facts.able,
            "reason": facts.reason,
            "flips": [[_name(e) for e in flip] for flip in self.flips(facts)],
            "forced": {_name(e): x for e, x in facts.forced.items()},
            "kawasaki": facts.kawasaki,
            "off": facts.off,
            "maekawa": facts.maekawa,
            "turn": None if turn is None else {"fold": _name(turn.fold), "degrees": turn.angle},
        }

    def __repr__(self) -> str:
        wrong = f", {len(self.refuted)} refuted" if self.refuted else ""
        return f"<Vertices: {counted(len(self.facts), 'vertex')}, starts {self.starts}{wrong}>"


def vertices(pattern: PatternLike, letters: Mapping[Edge, str] | str | None = None) -> Vertices:
    """What is known of each interior vertex of a sheet by itself, exactly, and what to change.

    `letters` is a mapping from folds (i, j), i < j, or a text in the order of the folds, with M, V,
    F (stays flat) or U (free); None takes the letters of the file. Each vertex is decided both ways
    by the theorem of Abel et al. (docs/vertices.md, Theorem 1). A verdict is UNDECIDED only where
    two folds nearly form a straight crease and the answer depends on whether they do, or where it
    is not the same for all sheets near a drawing that is too inexact to infer the one that was
    meant; with the snap "exact" the coordinates are taken as they are. Raises `UsageError` for
    letters that do not fit, and the errors of `open_pattern`.

    >>> vertices("bird-base")
    <Vertices: 5 vertices, starts proved>
    >>> found = vertices("zigzags")
    >>> found.starts, found.facts[0].flips
    (<Verdict.REFUTED: 'refuted'>, (((9, 13),),))
    """
    opened = open_sheet(pattern)
    given = opened.letters if letters is None else letters
    return _vertices(opened, tuple(by_fold(opened.sheet.folds, given).items()))


@remembered
def _vertices(opened: Opened, letters: tuple[tuple[Edge, str], ...]) -> Vertices:
    start = time.perf_counter()
    asked = dict(letters)
    sheet = panels(opened.sheet) if isinstance(opened.sheet, CreasePattern) else opened.sheet
    exactly = opened.reading.snap == "exact"
    facts = vertex_facts(sheet, asked, exactly=exactly, box=box_of(opened))
    return Vertices(sheet, asked, facts, opened.meant, time.perf_counter() - start)


def open_vertices(opened: Opened, letters: Letters) -> str:
    """Why letters that are refuted at no vertex by itself are open at one; else empty."""
    if opened.reading.snap == "exact" or opened.doubt:
        return ""
    found = vertices(opened, letters)
    return found.reason if found.starts is UNDECIDED else ""


def _which(some: Sequence[VertexFacts], count: int) -> str:
    if len(some) == 1:
        return f"vertex {some[0].vertex}"
    return f"all {count} vertices" if len(some) == count else f"{len(some)} of {count} vertices"


def _their(some: Sequence[VertexFacts]) -> str:
    return f"{'its' if len(some) == 1 else 'their'} letters"


def _of(some: int, count: int) -> str:
    if some == count:
        return "the only vertex" if count == 1 else f"all {count} vertices"
    return f"{some or 'none'} of {counted(count, 'vertex')}"


def _name(fold: Edge) -> str:
    return f"{fold[0]}-{fold[1]}"
