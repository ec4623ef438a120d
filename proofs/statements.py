"""Statements with their rulings, and the steps that a machine establishes."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class Ruling(Enum):
    """The ruling on a statement; it follows from the steps that speak against the statement."""

    AS_PRINTED = "holds as printed"
    CORRECTED = "holds when corrected"
    FALSE = "false"


class Severity(Enum):
    """How much is wrong with a statement that does not hold as printed."""

    TYPO = "typo"
    """A sign, an index or a word that the rest of the paper shows to be a slip."""
    CONSTANT = "wrong constant"
    """A number, a range or a label that is wrong and changes what is computed."""
    CONDITION = "missing condition"
    """True under a condition that is not stated."""
    CLAIM = "wrong claim"
    """Not true in the sense in which it is used."""
    REMARK = "remark"
    """Said with reserve ("seem", "roughly"), and not borne out by further computations."""


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
    """One formula or claim: its place, its text as printed (LaTeX), the ruling, and the correction.

    `key` numbers it within the paper: "C.4" is the fourth statement of Appendix C. `corrected` is
    empty if the statement holds as printed, or cannot be mended. `code` names the part of exactfold
    that implements it, and `equation` is its number in the paper. If the formula `printed` is put
    together from several places, `quoted` has the words of the paper. A statement rests on the
    steps that name it, and besides on `rests` (keys of other statements), `cited` (a theorem of
    others) and `words` (the place of a written proof that is not run). `contradiction` names
    another place of the paper that says something else; no step has to refute it. The ruling is set
    when a proof is finished. What a `note` says after "Remark:" is on no page.
    Where the statement holds as printed, docs/statements.md shows the condition before it.
    """

    key: str
    place: str
    printed: str
    corrected: str = ""
    note: str = ""
    code: str = ""
    equation: str = ""
    severity: Severity | None = None
    rests: str = ""
    cited: str = ""
    words: str = ""
    contradiction: str = ""
    quoted: str = ""
    ruling: Ruling = Ruling.AS_PRINTED

    @property
    def source(self) -> str:
        """The words of the paper."""
        return self.quoted or self.printed

    @property
    def is_own(self) -> bool:
        """Whether the statement is exactfold's own, not the paper's."""
        return self.key.startswith("T.")


@dataclass(frozen=True)
class Step:
    """A checked step; `cases` counts the exact cases where `how` is CASES."""

    text: str
    how: How
    holds: bool
    cases: int = 0
    of: tuple[str, ...] = ()
    """Keys of the statements that it establishes, in part or in whole."""
    against: tuple[str, ...] = ()
    """Keys of the statements whose printed form it refutes."""
    formula: bool = False
    """Whether it evaluates the expressions of a statement (`Claim`)."""
