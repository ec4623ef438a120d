"""Claims of motions: what each claim needs in a file, how it is checked, and how it is worded.

Each kind of motion has a table of its claims. A certificate makes the claims whose keys it has, and
the check goes through them.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar, TypeVar

from ..core.reading import keys
from ..sheets.sheet import Sheet
from .chain import Chain
from .restriction import Restriction

Document = dict[str, Any]


class Claim:
    """A claim of a motion, constructed from the claims and the evidence of a file.

    `names` are its keys among the claims, and `needs` its keys in the evidence. If `always` is
    true, every motion makes this claim, even if its keys are absent.
    """

    names: ClassVar[tuple[str, ...]]
    needs: ClassVar[tuple[str, ...]] = ()
    always: ClassVar[bool] = False

    def __init__(self, claims: Document, evidence: Document) -> None:
        self.claims, self.evidence = claims, evidence

    @classmethod
    def keys_in(cls, claims: Document) -> tuple[str, ...]:
        """The keys that a file must have for this claim, in view of the keys that it has.

        They are none if the file does not make the claim.
        """
        return cls.names if cls.always or any(name in claims for name in cls.names) else ()

    @classmethod
    def needed_by(cls, claims: Document) -> tuple[str, ...]:
        """The keys that the evidence of a file with these claims must have for this claim."""
        return cls.needs

    @staticmethod
    def said(claims: Document) -> str:
        """The words for this claim in the line that states the verified claims."""
        return ""


class BranchClaim(Claim):
    """A claim of a motion along a branch.

    The check passes the chain of verified pieces to each claim three times: to `begin` when the
    chain has its first piece, to `go_on` when it has all tubes, and to `check` when it is complete.
    If `continues` is true, the claim adds a piece, and the motion does not leave the last tube at
    an exit. `arcs` is the number of arcs through branch points that the claim adds.
    """

    continues: ClassVar[bool] = False
    arcs: ClassVar[int] = 0

    def restriction(self, given: Sheet, sheet: Sheet) -> Restriction | None:
        """The equations that the claim adds, or None; `sheet` is what can fold of `given`."""
        return None

    def begin(self, chain: Chain) -> None:
        """Refuse a chain whose first piece contradicts the claim."""

    def go_on(self, chain: Chain) -> None:
        """Verify the piece after the last tube."""

    def check(self, chain: Chain) -> None:
        """Refuse a complete chain for which the claim does not hold."""


C = TypeVar("C", bound=Claim)


def made(kinds: Sequence[type[C]], claims: Document) -> list[type[C]]:
    """The claims of a table that a file makes."""
    return [kind for kind in kinds if kind.always or kind.keys_in(claims)]


def read_claims(
    kinds: Sequence[type[C]], claims: Document, evidence: Document, always: Sequence[str] = ()
) -> list[C]:
    """Read the claims of a file.

    Raises if a key belongs to no claim, or if the evidence does not have exactly the keys that the
    claims need. `always` are the keys that the evidence of every motion has.
    """
    classes = made(kinds, claims)
    keys(claims, " ".join(key for kind in classes for key in kind.keys_in(claims)), "claims")
    needed = (key for kind in classes for key in kind.needed_by(claims))
    keys(evidence, " ".join([*always, *needed]), "evidence")
    return [kind(claims, evidence) for kind in classes]


def words(kinds: Sequence[type[C]], claims: Document) -> str:
    """The words for the verified claims, in the order of the table."""
    return "".join(kind.said(claims) for kind in made(kinds, claims))
