"""Certificates of flat-folded states, for `exactfold check` (docs/flat.md, Certificates)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import combinations
from typing import Any, Final, TypeAlias

from exactfold._support.clock import UNLIMITED, Clock
from exactfold._support.verdict import UNDECIDED
from exactfold.checker.core.kinds import DocumentKind
from exactfold.checker.layers.counted import FLAT_COUNT, FlatCountClaims
from exactfold.checker.layers.folding import FoldedSheet
from exactfold.checker.layers.overlaps import Overlaps, members
from exactfold.checker.layers.refuted import FLAT_REFUTED, FlatRefutedClaims
from exactfold.checker.layers.state import FLAT_STATE, FlatStateClaims
from exactfold.checker.sheets.panels import read_panels
from exactfold.errors import NotApplicableError, SolverError
from exactfold.layers.clauses import Clauses
from exactfold.layers.placing import Placing
from exactfold.layers.proofs import Clause, Prover, needed
from exactfold.layers.states import Component, FlatStates
from exactfold.pattern.panel_entries import panels_document

Document: TypeAlias = dict[str, Any]
MOST_PAIRS: Final = 1 << 16
"""The number of pairs that overlap up to which certificates state their orders."""


def states_certificate(found: FlatStates, clock: Clock = UNLIMITED) -> Document:
    """The certificate of what is known of the flat-folded states of a sheet.

    It says how many states there are, if all are listed and at most 65,536 pairs of pieces overlap;
    else that there is one; or that there is none. Raises `NotApplicableError` if that is not
    decided, and the error of `clock` if the time is over.

    >>> from exactfold.layers.folding import fold_flat
    >>> made = states_certificate(fold_flat("miura"))
    >>> made["kind"], made["claims"]["states"]
    ('flat-count', 1)
    """
    if found.status is UNDECIDED:
        raise NotApplicableError(f"nothing is decided: {found.reason}")
    letters = "".join(found.letters[fold] for fold in found.pattern.folds)
    head = {"pattern": panels_document(found.pattern)}
    if found.images is None:
        first = found.failures[0]
        return _refuted(head, letters, {}, first.condition, first.vertex)
    writer = _Writer(found, head["pattern"])
    if found.conflict:
        return _refuted(head, letters, writer.contradiction(clock))
    if len(found.pairs) > MOST_PAIRS or found.count != found.listed:
        return _state(found, head, letters, writer)
    claims: FlatCountClaims = {
        "letters": letters,
        "states": found.listed,
        "components": [len(component.states) for component in found.components],
    }
    return _document(FLAT_COUNT, head, claims, writer.count(clock))


def _document(
    kind: DocumentKind[Any], head: Document, claims: Mapping[str, Any], evidence: Document
) -> Document:
    start = {"format": kind.format, "version": kind.version, "kind": kind.named}
    return {**start, **head, "claims": claims, "evidence": evidence}


def _refuted(
    head: Document,
    letters: str,
    evidence: Document,
    reason: str = "layers",
    vertex: int | None = None,
) -> Document:
    claims: FlatRefutedClaims = {"letters": letters, "reason": reason, "vertex": vertex}
    return _document(FLAT_REFUTED, head, claims, evidence)


def _state(found: FlatStates, head: Document, letters: str, writer: _Writer) -> Document:
    """The certificate of the first state."""
    orders = found.state().orders
    bits = [orders[pair] > 0 for pair in writer.pairs]
    said = ""
    for fold, letter in zip(found.pattern.folds, letters, strict=True):
        if letter == "F":
            said += "F"
            continue
        one, other = writer.folded.pieces_of(fold)
        above = orders[one, other] > 0 if one < other else orders[other, one] < 0
        said += "V" if above == writer.folded.up[one] else "M"
    claims: FlatStateClaims = {
        "letters": letters,
        "assignment": said,
        "pieces": len(writer.folded.pieces),
        "pairs": len(bits),
    }
    return _document(FLAT_STATE, head, claims, {"pieces": writer.pieces, "order": digits_of(bits)})


class _Writer:
    """Finds evidence about a sheet whose folding map exists.

    The checker's own map and overlaps say where layers could cross.
    """

    def __init__(self, found: FlatStates, pattern: Document) -> None:
        if found.images is None:
            raise SolverError("there is no folding map")
        self.found = found
        polygons = found.images.pieces.polygons
        self.pieces = [list(polygon) for polygon in polygons]
        sheet, _ = read_panels(pattern)
        self.folded = FoldedSheet(sheet, found.letters, list(polygons))
        self.pairs = list(found.pairs)
        self.clauses = Clauses(self.folded, self.pairs)

    def contradiction(self, clock: Clock) -> Document:
        """Evidence that the conditions of the conflict contradict each other."""
        prover = Prover(len(self.pairs), self.clauses.given(), clock=clock)
        for one in self.found.conflict:
            for clause in self.clauses.of(one.constraint):
                prover.add(clause)
        prover.refute(sorted({abs(x) for clause in prover.clauses for x in clause}))
        return self._evidence(prover, [prover.clauses.index(())])[0]

    def count(self, clock: Clock) -> Document:
        """Evidence that there are no other states than those that are listed."""
        overlaps = Overlaps(self.folded)
        self.clauses.plane = overlaps.plane
        closing = _Closing(self.clauses, overlaps)
        prover = Prover(len(self.pairs), self.clauses.given(), closing.more, clock)
        for clause in self.clauses.crossings(overlaps):
            prover.add(clause)
        prover.propagate()
        for clause in closing.open(prover):
            prover.add(clause)
        fixed = [value * k for k, value in enumerate(self.found.fixed, 1) if value]
        for literal in fixed:
            prover.settle(literal, [])
        known = set(fixed)
        about: dict[int, list[int]] = {}
        for number, clause in enumerate(prover.clauses):
            if not known.intersection(clause):
                for literal in clause:
                    about.setdefault(abs(literal), []).append(number)
        parts = [_Part(prover, one, known, about, clock) for one in self.found.components]
        single = {clause[0]: k for k, clause in enumerate(prover.clauses) if len(clause) == 1}
        wanted = [single[literal] for literal in fixed if literal in single]
        wanted += [number for part in parts for number in part.used]
        evidence, place = self._evidence(prover, wanted)
        first = len(evidence["clauses"]) + len(evidence["steps"])
        evidence["components"] = [part.document(self.clauses, place, first) for part in parts]
        return evidence

    def _evidence(self, prover: Prover, wanted: Iterable[int]) -> tuple[Document, dict[int, int]]:
        """The clauses that are needed for some, and the numbers of those in the file."""
        numbers = needed(prover, wanted)
        found = [number for number in numbers if number in prover.hints]
        given = [number for number in numbers if number not in prover.hints]
        place = {number: k for k, number in enumerate([*given, *found])}
        placing = Placing(self.clauses.plane)
        clauses = []
        for number in given:
            axiom = self.clauses.axioms[prover.clauses[number]]
            clauses.append([axiom.place(placing), [list(order) for order in axiom.orders]])
        evidence = {
            "pieces": self.pieces,
            "places": placing.entries,
            "clauses": clauses,
            "steps": [
                [self.clauses.orders(prover.clauses[k]), [place[hint] for hint in prover.hints[k]]]
                for k in found
            ],
        }
        return evidence, place


class _Closing:
    """Finds clauses of transitivity where they matter.

    These are those of three pieces with two known orders that imply the third, and those with at
    most one known order. In any other case the third order is free.
    """

    def __init__(self, clauses: Clauses, overlaps: Overlaps) -> None:
        self.clauses, self.overlaps = clauses, overlaps
        self._above = [0] * len(overlaps.pieces)
        self._below = [0] * len(overlaps.pieces)

    def more(self, prover: Prover, literal: int) -> Iterator[Clause]:
        """The clauses by which a new order, and an old one, imply a third one."""
        low, high = self.clauses.order(literal)
        self._above[low] |= 1 << high
        self._below[high] |= 1 << low
        over = self.overlaps.over
        literal_of = self.clauses.literal
        for c in members(self._above[high] & over[low] & ~self._above[low]):
            if not prover.holds(literal_of(low, c)):
                yield from self._line(low, high, c)
        for c in members(self._below[low] & over[high] & ~self._below[high]):
            if not prover.holds(literal_of(c, high)):
                yield from self._line(c, low, high)

    def open(self, prover: Prover) -> Iterator[Clause]:
        """The clauses of three pieces with at least two open orders."""
        near: dict[int, set[int]] = {}
        for k, (a, b) in enumerate(self.clauses.pairs, 1):
            if not prover.holds(k) and not prover.holds(-k):
                near.setdefault(a, set()).add(b)
                near.setdefault(b, set()).add(a)
        seen = set()
        for a, others in near.items():
            for b, c in combinations(sorted(others), 2):
                triple = tuple(sorted((a, b, c)))
                if triple not in seen and self.overlaps.over[b] >> c & 1:
                    seen.add(triple)
                    yield from self._line(*triple)

    def _line(self, a: int, b: int, c: int) -> Iterator[Clause]:
        if self.overlaps.have_common_point((a, b, c)):
            yield from self.clauses.line(a, b, c)


class _Part:
    """The proof that a component has no other orders than those listed.

    `used` has the numbers of the clauses of all that it uses.
    """

    def __init__(
        self,
        whole: Prover,
        component: Component,
        known: set[int],
        about: Mapping[int, Sequence[int]],
        clock: Clock,
    ) -> None:
        self.component = component
        numbers = sorted({n for pair in component.pairs for n in about.get(pair + 1, ())})
        own = {pair + 1 for pair in component.pairs}
        names = sorted(own.union(abs(x) for n in numbers for x in whole.clauses[n]))
        self._names = names
        short = {name: k for k, name in enumerate(names, 1)}
        given = [short[x] for x in names if x in known] + [-short[x] for x in names if -x in known]
        self._prover = prover = Prover(len(names), given, clock=clock)

        def shortened(clause: Iterable[int]) -> Clause:
            return tuple(short[x] if x > 0 else -short[-x] for x in clause)

        whose = {prover.add(shortened(whole.clauses[n])): n for n in numbers}
        self._listed = {}
        for k, state in enumerate(component.states):
            signs = zip(component.pairs, state, strict=True)
            self._listed[prover.add(shortened(-sign * (pair + 1) for pair, sign in signs))] = k
        prover.refute([short[name] for name in sorted(own)])
        self._needed = needed(prover, [prover.clauses.index(())])
        self._whose = {k: whose[k] for k in self._needed if k in whose}
        self.used = list(self._whose.values())

    def document(self, clauses: Clauses, place: Mapping[int, int], first: int) -> Document:
        """The component in the file, where the clauses of all end before number `first`."""
        numbers = {k: place[number] for k, number in self._whose.items()}
        numbers |= {k: first + number for k, number in self._listed.items()}
        first += len(self.component.states)
        steps: list[Any] = []
        for k in self._needed:
            if k in self._prover.hints:
                numbers[k] = first + len(steps)
                clause = [
                    self._names[abs(x) - 1] * (1 if x > 0 else -1) for x in self._prover.clauses[k]
                ]
                hints = [numbers[hint] for hint in self._prover.hints[k]]
                steps.append([clauses.orders(clause), hints])
        return {
            "pairs": [list(clauses.pairs[pair]) for pair in self.component.pairs],
            "states": [digits_of([sign > 0 for sign in state]) for state in self.component.states],
            "steps": steps,
        }


def digits_of(bits: Sequence[bool]) -> str:
    """Bits as hexadecimal digits, the first bit as the highest of the first digit."""
    text = "".join("01"[bit] for bit in bits)
    text += "0" * (-len(text) % 4)
    return f"{int(text, 2):0{len(text) // 4}x}" if text else ""
