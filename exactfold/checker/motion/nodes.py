"""Branch points on a motion: that it goes through them, or ends at one.

At a branch point the stars of some vertices are flat and other curves may cross. The motion passes
it on an arc of one analytic curve, a point of which lies on the tube before (docs/motions.md).
"""

from __future__ import annotations

from fractions import Fraction
from typing import TypedDict

from ..core.reading import items, keys, natural, require
from .chain import Chain
from .claims import BranchClaim, Document
from .pieces import arc_of, parameter_of
from .stretches import Arc


class FlatStars(TypedDict):
    """A branch point, by the vertices whose stars are flat; whether it is clear of contacts."""

    flat: list[int]
    clear: bool


class Through(BranchClaim):
    """The curve goes through branch points where the vertices listed are flat, in this order.

    It is regular but for them. A motion without this key is claimed to be regular throughout.
    """

    names = ("through",)
    always = True

    @classmethod
    def keys_in(cls, claims: Document) -> tuple[str, ...]:
        """Its key, if it is there."""
        return cls.names if "through" in claims else ()

    def check(self, chain: Chain) -> None:
        """The branch points that are passed are those claimed."""
        claimed, message = (
            "through" in self.claims,
            "a motion passes branch points that it does not claim",
        )
        require(claimed == bool(chain.passed), f"{message}, or none")
        lists = items(self.claims["through"], "through") if claimed else []
        listed = [[natural(v, "flat vertex") for v in items(flat, "flat")] for flat in lists]
        require(listed == chain.passed, "the branch points that are passed are others")

    @staticmethod
    def said(claims: Document) -> str:
        """Each of them."""
        return "".join(
            f", through a branch point where {_flat(flat)}" for flat in claims.get("through", [])
        )


class Node(BranchClaim):
    """The motion ends at a branch point where the vertices `flat` are flat; before, all is regular.

    If `clear` is true, no two faces touch up to it, nor in it.
    """

    names = ("node",)
    needs = ("node",)
    continues = True
    arcs = 1

    def __init__(self, claims: Document, evidence: Document) -> None:
        super().__init__(claims, evidence)
        keys(claims["node"], "flat clear", "node")
        require(type(claims["node"]["clear"]) is bool, "clear is not true or false")

    def go_on(self, chain: Chain) -> None:
        """The arc on which the motion comes to its end, and where it meets the last tube."""
        entry, path = self.evidence["node"], chain.path
        keys(entry, "node centre row reach entry", "node")
        arc = arc_of(chain.equations, self.claims["node"]["flat"], entry)
        begin, end = parameter_of(entry["entry"]), Fraction(0)
        path.meet(*arc.configuration(begin))
        # Only after another branch point or with a rim can it be otherwise: docs/motion.md, Theorem
        # 6.
        require(begin < end, "an arc does not lead to its node")
        path.go(*arc.configuration(end))
        chain.steps.append(Arc(arc, begin, end))

    def check(self, chain: Chain) -> None:
        """What is clear, which is verified as a claim of its own, goes on to the branch point."""
        if not self.claims["node"]["clear"]:
            return
        given = self.evidence.get("contacts", {})
        to_the_end = (given.get("tube"), given.get("clear")) == (len(chain.steps), 0)
        require(to_the_end, "the motion is not shown to be clear up to its node")

    @staticmethod
    def said(claims: Document) -> str:
        """Where it is."""
        return f", to a branch point where {_flat(claims['node']['flat'])}"


def _flat(flat: list[int]) -> str:
    """That vertices are flat."""
    several = len(flat) > 1
    names = " and ".join(map(str, flat))
    return f"{'vertices' if several else 'vertex'} {names} {'are' if several else 'is'} flat"
