"""Claims of motions: what each one needs in a file, how it is checked, and its words.

A kind of motion has a table of its claims. A certificate makes those of them whose keys it has;
to check it is to go through them.
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
    """A claim of a motion, made of the claims and the evidence of a file.

    `names` are its keys among the claims, `needs` those in the evidence. A claim that is made
    `always` is one that every motion makes, perhaps by leaving out a key.
    """

    names: ClassVar[tuple[str, ...]]
    needs: ClassVar[tuple[str, ...]] = ()
    always: ClassVar[bool] = False

    def __init__(self, claims: Document, evidence: Document) -> None:
        self.claims, self.evidence = claims, evidence

    @classmethod
    def keys_in(cls, claims: Document) -> tuple[str, ...]:
        """The keys that a file has for it, to go by those that are there; none: not claimed."""
        return cls.names if cls.always or any(name in claims for name in cls.names) else ()

    @classmethod
    def needed_by(cls, claims: Document) -> tuple[str, ...]:
        """The keys that a file with these claims has for it in the evidence."""
        return cls.needs

    @staticmethod
    def said(claims: Document) -> str:
        """Its words in the line about verified claims."""
        return ""


class BranchClaim(Claim):
    """A claim of a motion along a branch.

    It sees the chain of verified pieces three times: when it has its first piece, when it has all
    tubes, and when it is whole. If it `continues` the chain, the last tube is not left at an exit.
    `arcs`: how many arcs through branch points it adds.
    """

    continues: ClassVar[bool] = False
    arcs: ClassVar[int] = 0

    def restriction(self, given: Sheet, sheet: Sheet) -> Restriction | None:
        """What it adds to the equations; `sheet` is what can fold of the one that is given."""
        return None

    def begin(self, chain: Chain) -> None:
        """Refuse a chain that begins otherwise than claimed."""

    def go_on(self, chain: Chain) -> None:
        """Verify the piece after the last tube."""

    def check(self, chain: Chain) -> None:
        """Refuse a whole chain of which the claim does not hold."""


C = TypeVar("C", bound=Claim)


def made(kinds: Sequence[type[C]], claims: Document) -> list[type[C]]:
    """The claims that a file makes, of those in a table."""
    return [kind for kind in kinds if kind.always or kind.keys_in(claims)]


def read_claims(
    kinds: Sequence[type[C]], claims: Document, evidence: Document, always: Sequence[str] = ()
) -> list[C]:
    """The claims of a file. Refuses keys that belong to none, and evidence without some.

    `always`: the keys of the evidence of every motion.
    """
    found = made(kinds, claims)
    keys(claims, " ".join(key for kind in found for key in kind.keys_in(claims)), "claims")
    needed = (key for kind in found for key in kind.needed_by(claims))
    keys(evidence, " ".join([*always, *needed]), "evidence")
    return [kind(claims, evidence) for kind in found]


def words(kinds: Sequence[type[C]], claims: Document) -> str:
    """What a line about verified claims says of them, in the order of the table."""
    return "".join(kind.said(claims) for kind in made(kinds, claims))
