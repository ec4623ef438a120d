"""The parts of a proof: statements with verdicts, and steps that a machine establishes."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import Any, TypeVar

from proofs.claims import Claim, is_zero
from proofs.formulas import Names
from proofs.reading import read
from proofs.replacements import REPLACEMENTS
from proofs.statements import How, Ruling, Statement, Step

T = TypeVar("T")


@dataclass(frozen=True)
class Proof:
    """Hypotheses, statements and checked steps; PROVED if every step was established."""

    name: str
    title: str
    hypotheses: tuple[str, ...]
    statements: tuple[Statement, ...]
    steps: tuple[Step, ...]
    changes: tuple[str, ...] = ()
    """Names of deliberate mistakes that `prove(change)` can make; some step must refuse each."""
    claims: tuple[Claim, ...] = field(default=(), compare=False)
    """Statements that are formulas, with the geometries in which they are evaluated."""

    @property
    def holds(self) -> bool:
        """Whether every step was established."""
        return bool(self.steps) and all(step.holds for step in self.steps)

    @property
    def verdict(self) -> str:
        """`refuted` if a step fails; else `tested` if half of the steps or more only test cases;
        else `proved`."""
        if not self.holds:
            return "refuted"
        return "tested" if 2 * self.tested_only >= len(self.steps) else "proved"

    def steps_of(self, key: str) -> list[Step]:
        """The steps that name a statement: those for it, and those against its printed form."""
        return [step for step in self.steps if key in (*step.of, *step.against)]

    def kind(self, statement: Statement) -> str:
        """The kind of the text of a statement: a formula that a step evaluates, or words."""
        return "formula" if any(c.key == statement.key for c in self.claims) else "in words"

    def basis(self, statement: Statement) -> str:
        """In words, what a statement rests on, from the strongest to the weakest."""
        steps = [step for step in self.steps if statement.key in step.of]
        kinds = {how: [s for s in steps if s.how is how] for how in How}
        general = len(kinds[How.IDENTITY]) + len(kinds[How.CERTIFICATE])
        tested = sum(step.cases for step in kinds[How.CASES])
        parts = [
            f"proved for all ({general} step{'s' * (general > 1)})" if general else "",
            "shown by an example" if kinds[How.COUNTEREXAMPLE] else "",
            f"tested on {tested} case{'s' * (tested > 1)}" if tested else "",
            f"from {', '.join(statement.rests.split())}" if statement.rests else "",
            f"cited: {statement.cited}" if statement.cited else "",
            f"in words: {statement.words}" if statement.words else "",
        ]
        if statement.contradiction:
            parts.append(f"the paper says otherwise: {statement.contradiction}")
        elif statement.ruling is not Ruling.AS_PRINTED:
            parts.append("the printed form refuted by an example")
        return "; ".join(part for part in parts if part)

    @property
    def tested_only(self) -> int:
        """Number of steps that rest on exact cases only."""
        return sum(step.how is How.CASES for step in self.steps)

    def to_dict(self) -> dict[str, Any]:
        """The object printed by `python -m proofs --json`."""
        return {
            "name": self.name,
            "title": self.title,
            "verdict": self.verdict,
            "hypotheses": list(self.hypotheses),
            "statements": [
                {
                    "key": s.key,
                    "place": s.place,
                    "printed": s.printed,
                    "quoted": s.quoted,
                    "ruling": s.ruling.value,
                    "corrected": s.corrected,
                    "note": s.note,
                    "code": s.code,
                    "equation": s.equation,
                    "severity": s.severity.value if s.severity else None,
                    "kind": self.kind(s),
                    "basis": self.basis(s),
                }
                for s in self.statements
            ],
            "steps": [
                {
                    "text": s.text,
                    "how": s.how.value,
                    "holds": s.holds,
                    "cases": s.cases,
                    "of": list(s.of),
                    "against": list(s.against),
                }
                for s in self.steps
            ],
        }


@dataclass
class Script:
    """Collects the steps of one proof. Formulas pass through `alter`, so that tests can break them.

    >>> script = Script("demo", "Squares", ())
    >>> sign = script.alter("wrong sign", 1, -1)
    >>> script.identity("2 + 2 is 4", 2 + sign * 2 - 4)
    >>> script.proof().verdict, script.proof().changes
    ('proved', ('wrong sign',))
    >>> script.state("D.1", "Demo", "0 = 1 is proved here")
    >>> script.proof()
    Traceback (most recent call last):
    ValueError: D.1 rests on nothing
    """

    name: str
    title: str
    hypotheses: Iterable[str]
    change: str | None = None
    statements: list[Statement] = field(default_factory=list)
    steps: list[Step] = field(default_factory=list)
    changes: list[str] = field(default_factory=list)
    claims: list[Claim] = field(default_factory=list)

    def alter(self, name: str, right: T, wrong: T) -> T:
        """Register a change; return `wrong` if this change was asked for, else `right`."""
        self.changes.append(name)
        return wrong if self.change == name else right

    def state(self, *args: Any, **kwargs: Any) -> None:
        """Add a `Statement`."""
        self.statements.append(Statement(*args, **kwargs))

    def identity(self, text: str, *differences: Any, of: str = "", against: str = "") -> None:
        """Add a step: every difference (number, polynomial, rational function) is identically 0."""
        self._step(text, How.IDENTITY, all(is_zero(d) for d in differences), of, against)

    def certificate(self, text: str, holds: bool, *, of: str = "", against: str = "") -> None:
        """Add a step: an inequality or finite claim, with a certificate that was just checked."""
        self._step(text, How.CERTIFICATE, holds, of, against)

    def counterexample(self, text: str, holds: bool, *, of: str = "", against: str = "") -> None:
        """Add a step: an exact counterexample, which was just evaluated and does what it should."""
        self._step(text, How.COUNTEREXAMPLE, holds, of, against)

    def cases(
        self, text: str, outcomes: Iterable[bool], *, of: str = "", against: str = ""
    ) -> None:
        """Add a step: exact cases, which are counted; it is tested, not proved."""
        results = [bool(outcome) for outcome in outcomes]
        holds = bool(results) and all(results)
        self._step(text, How.CASES, holds, of, against, cases=len(results))

    def example(self, text: str, holds: bool, *, of: str = "", against: str = "") -> None:
        """Add a step: one exact example of a general claim that is argued in words.

        It is tested, not proved.
        """
        self._step(text, How.CASES, holds, of, against, cases=1)

    def _step(
        self, text: str, how: How, holds: bool, of: str, against: str, cases: int = 0
    ) -> None:
        named = tuple(of.split()), tuple(against.split())
        self.steps.append(Step(text, how, bool(holds), cases, *named))

    def formula(
        self,
        key: str,
        place: str,
        printed: str,
        corrected: str = "",
        *,
        over: Iterable[Names] = (),
        at: Iterable[Names] = (),
        functions: Iterable[str] = (),
        mentions: bool = False,
        **fields: Any,
    ) -> None:
        """State formulas and evaluate them, as they stand or as corrected.

        `over` and `at` say what the names mean. `over` are free geometries; the formulas must hold
        in them identically. `at` are geometries with numbers. If the formulas are a correction, the
        printed form must fail in `at`, or in `over` if `at` is empty. If `over` is empty, the
        formulas are only tested, on each of `at`. With `mentions`, single names and numbers among
        the words are evaluated too.
        """
        names = tuple(functions)
        first = read(printed, names, mentions)
        right = read(corrected, names, mentions) if corrected else first
        if first.formulas and first.expressions != right.expressions:
            raise ValueError(f"{key}: the two forms need the same number of expressions")
        free = tuple(over)
        claim = Claim(key, first, right, free, tuple(at) or free)
        self.claims.append(claim)
        which = "corrected" if corrected else "printed"
        one, many = ("free geometry", "free geometries") if free else ("case", "cases")
        count = len(free or claim.at)
        self.steps.append(
            Step(
                f"{key} as {which}, evaluated in {count} {one if count == 1 else many}",
                How.IDENTITY if free else How.CASES,
                bool(claim.at) and claim.holds(right),
                cases=0 if free else len(claim.at),
                of=(key,),
                formula=True,
            )
        )
        if corrected and first.formulas:
            self.steps.append(
                Step(
                    f"{key} as printed does not hold",
                    How.COUNTEREXAMPLE,
                    claim.is_refuted,
                    against=(key,),
                    formula=True,
                )
            )
        self.state(key, place, first.latex, right.latex if corrected else "", **fields)

    def proof(self) -> Proof:
        """The finished proof. Raises `ValueError` if the requested change does not exist."""
        if self.change is not None and self.change not in self.changes:
            raise ValueError(f"{self.name} has no change {self.change!r}")
        return Proof(
            self.name,
            self.title,
            tuple(self.hypotheses),
            tuple(map(self._ruled, self.statements)),
            tuple(self.steps),
            tuple(self.changes),
            tuple(self.claims),
        )

    def _ruled(self, statement: Statement) -> Statement:
        """The statement with its ruling. Raises `ValueError` if it rests on nothing."""
        key = statement.key
        refuted = bool(statement.contradiction)
        refuted = refuted or any(key in step.against for step in self.steps)
        named = any(key in step.of for step in self.steps)
        if not (named or refuted or statement.rests or statement.cited or statement.words):
            raise ValueError(f"{key} rests on nothing")
        if refuted != bool(statement.severity) or (statement.corrected and not refuted):
            raise ValueError(f"{key}: a correction, its severity and a refutation go together")
        if not refuted:
            return statement
        return replace(statement, ruling=Ruling.CORRECTED if statement.corrected else Ruling.FALSE)


def report(proof: Proof) -> str:
    """The text that a proof script prints."""
    lines = [proof.title, "=" * len(proof.title), "", "Hypotheses"]
    lines += [f"  - {h}" for h in proof.hypotheses] or ["  none"]
    lines += ["", "Statements"]
    for s in proof.statements:
        lines += stated(proof, s)
    lines += ["", "Steps", *map(shown, proof.steps), "", f"Verdict: {proof.verdict}"]
    return "\n".join(lines)


def stated(proof: Proof, s: Statement) -> list[str]:
    """The lines about one statement: its place, its text, its correction, why, what it rests on."""
    where = f"{s.place}, Eq. ({s.equation})" if s.equation else s.place
    lines = [
        f"  {s.key}  {s.ruling.value}; {proof.kind(s)}: {where}",
        f"      printed:   {s.source}",
    ]
    lines += [f"      that is:   {s.printed}"] if s.quoted else []
    lines += [f"      corrected: {s.corrected}"] if s.corrected else []
    lines += [f"      severity:  {s.severity.value}"] if s.severity else []
    lines += [f"      note:      {s.note}"] if s.note else []
    return [*lines, f"      rests on:  {proof.basis(s)}"]


def shown(step: Step) -> str:
    """The line about one step."""
    count = f" ({step.cases})" if step.how is How.CASES else ""
    names = [*step.of, *(f"against {key}" for key in step.against)]
    ends = f"  [{', '.join(names)}]" if names else ""
    return f"  [{'ok' if step.holds else 'FAILS'}] {step.how.value}{count}: {step.text}{ends}"


def report_statement(proof: Proof, statement: Statement) -> str:
    """The text that `python -m proofs KEY` prints: one statement and the steps that name it.

    What does not hold as printed ends with the LaTeX of the paper's source and its replacement.
    """
    steps = [shown(step) for step in proof.steps_of(statement.key)]
    lines = [*stated(proof, statement), "", "Steps", *(steps or ["  none is run"])]
    for old, new in REPLACEMENTS.get(statement.key, ()):
        lines += ["", "In the source, replace", old, "by", new]
    return "\n".join(lines)


def run(proof: Proof) -> int:
    """Print a proof; return the exit code, which is 0 only if every step was established."""
    sys.stdout.write(report(proof) + "\n")
    return 0 if proof.holds else 1
