"""What a proof is made of: statements with verdicts, and steps that a machine establishes."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from dataclasses import dataclass, field
from enum import Enum
from typing import Any, TypeVar

from exactfold.verdict import PROVED, REFUTED, Verdict

T = TypeVar("T")


class Ruling(Enum):
    """What became of a statement of the paper."""

    AS_PRINTED = "holds as printed"
    CORRECTED = "holds when corrected"
    FALSE = "false"


class How(Enum):
    """How a step is established. Only the first three establish it in general."""

    IDENTITY = "identity"
    """A rational function of the geometry vanishes identically."""
    CERTIFICATE = "certificate"
    """An explicit certificate: sign-definite factorisation, sum of squares, finite enumeration."""
    COUNTEREXAMPLE = "counterexample"
    """An exact rational example, evaluated exactly."""
    CASES = "exact cases"
    """Tested on a stated number of exact cases; evidence, not proof."""


@dataclass(frozen=True)
class Statement:
    """One formula or claim: where it stands, as printed (LaTeX), the ruling, and the correction.

    `key` numbers it within the paper, as in "C.4" for the fourth statement of Appendix C;
    `corrected` is empty if it holds as printed; `code` names what in exactfold implements it.
    """

    key: str
    place: str
    printed: str
    ruling: Ruling
    corrected: str = ""
    note: str = ""
    code: str = ""


@dataclass(frozen=True)
class Step:
    """A checked step; `cases` counts the exact cases where `how` is CASES."""

    text: str
    how: How
    holds: bool
    cases: int = 0


@dataclass(frozen=True)
class Proof:
    """Hypotheses, statements and checked steps; PROVED if every step was established."""

    name: str
    title: str
    hypotheses: tuple[str, ...]
    statements: tuple[Statement, ...]
    steps: tuple[Step, ...]
    changes: tuple[str, ...] = ()
    """Names of the deliberate mistakes that `prove(change)` can make; each must be refused."""

    @property
    def verdict(self) -> Verdict:
        """PROVED if every step holds, else REFUTED."""
        return PROVED if self.steps and all(step.holds for step in self.steps) else REFUTED

    @property
    def tested_only(self) -> int:
        """Number of steps that rest on exact cases only."""
        return sum(step.how is How.CASES for step in self.steps)

    def to_dict(self) -> dict[str, Any]:
        """The object printed by `python -m proofs --json`."""
        return {
            "name": self.name,
            "title": self.title,
            "verdict": str(self.verdict),
            "hypotheses": list(self.hypotheses),
            "statements": [
                {
                    "key": s.key,
                    "place": s.place,
                    "printed": s.printed,
                    "ruling": s.ruling.value,
                    "corrected": s.corrected,
                    "note": s.note,
                    "code": s.code,
                }
                for s in self.statements
            ],
            "steps": [
                {"text": s.text, "how": s.how.value, "holds": s.holds, "cases": s.cases}
                for s in self.steps
            ],
        }


@dataclass
class Script:
    """Collects the steps of one proof; a formula passes through `alter`, so that it can be broken.

    >>> script = Script("demo", "Squares", ())
    >>> sign = script.alter("wrong sign", 1, -1)
    >>> script.identity("2 + 2 is 4", 2 + sign * 2 - 4)
    >>> str(script.proof().verdict), script.proof().changes
    ('proved', ('wrong sign',))
    """

    name: str
    title: str
    hypotheses: Iterable[str]
    change: str | None = None
    statements: list[Statement] = field(default_factory=list)
    steps: list[Step] = field(default_factory=list)
    changes: list[str] = field(default_factory=list)

    def alter(self, name: str, right: T, wrong: T) -> T:
        """`right`, or `wrong` if this change was asked for; registers the change."""
        self.changes.append(name)
        return wrong if self.change == name else right

    def state(self, *args: Any, **kwargs: Any) -> None:
        """Add a `Statement`."""
        self.statements.append(Statement(*args, **kwargs))

    def identity(self, text: str, *differences: Any) -> None:
        """Every difference (number, polynomial, rational function) is identically zero."""
        self.steps.append(Step(text, How.IDENTITY, all(is_zero(d) for d in differences)))

    def certificate(self, text: str, holds: bool) -> None:
        """An inequality or finite claim with an explicit certificate that was just checked."""
        self.steps.append(Step(text, How.CERTIFICATE, bool(holds)))

    def counterexample(self, text: str, holds: bool) -> None:
        """An exact counterexample was just evaluated and does what it should."""
        self.steps.append(Step(text, How.COUNTEREXAMPLE, bool(holds)))

    def cases(self, text: str, outcomes: Iterable[bool]) -> None:
        """Exact cases, counted: tested, not proved."""
        results = [bool(outcome) for outcome in outcomes]
        self.steps.append(Step(text, How.CASES, bool(results) and all(results), len(results)))

    def example(self, text: str, holds: bool) -> None:
        """One exact example of a general claim that is argued in words: tested, not proved."""
        self.steps.append(Step(text, How.CASES, bool(holds), 1))

    def proof(self) -> Proof:
        """The finished proof. Raises `ValueError` if the change asked for does not exist."""
        if self.change is not None and self.change not in self.changes:
            raise ValueError(f"{self.name} has no change {self.change!r}")
        return Proof(
            self.name,
            self.title,
            tuple(self.hypotheses),
            tuple(self.statements),
            tuple(self.steps),
            tuple(self.changes),
        )


def is_zero(value: Any) -> bool:
    """Whether a number, a SymPy ring or field element, or a SymPy expression is identically 0.

    Ring and field elements are in normal form, so `== 0` decides; an expression is first brought
    over one denominator and expanded, which decides for rational functions of its symbols.
    """
    if hasattr(value, "is_Matrix") and value.is_Matrix:
        return all(is_zero(entry) for entry in value)
    if hasattr(value, "free_symbols"):
        import sympy

        numerator, _ = sympy.fraction(sympy.together(value))
        return bool(sympy.expand(numerator) == 0)
    return bool(value == 0)


def report(proof: Proof) -> str:
    """The text that a proof script prints."""
    lines = [proof.title, "=" * len(proof.title), "", "Hypotheses"]
    lines += [f"  - {h}" for h in proof.hypotheses] or ["  none"]
    lines += ["", "Statements"]
    for s in proof.statements:
        lines.append(f"  {s.key}  {s.ruling.value}: {s.place}")
        lines.append(f"      printed:   {s.printed}")
        lines += [f"      corrected: {s.corrected}"] if s.corrected else []
        lines += [f"      note:      {s.note}"] if s.note else []
    lines += ["", "Steps"]
    for step in proof.steps:
        count = f" ({step.cases})" if step.how is How.CASES else ""
        lines.append(f"  [{'ok' if step.holds else 'FAILS'}] {step.how.value}{count}: {step.text}")
    lines += ["", f"Verdict: {proof.verdict}"]
    return "\n".join(lines)


def run(proof: Proof) -> int:
    """Print a proof; the exit code: 0 only if every step was established."""
    sys.stdout.write(report(proof) + "\n")
    return 0 if proof.verdict is PROVED else 1
