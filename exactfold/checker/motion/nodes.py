"""Claims about branch points: a motion goes through them, or ends at one.

At a branch point the stars of some vertices are flat, and other curves may cross the motion. The
motion passes it on an arc of one analytic curve; a point of the arc lies on the tube before
(docs/motion.md, 12).

With four corners a motion that passes no branch point before meets the arc, on its last tube and in
the direction of growing s, at a parameter s_1 < 0. Proof: for s not 0 the equations of the arc are
independent combinations of all length equations and T . y = 1, and they are regular on the whole
arc. So all its configurations but the branch point are regular. The branch point is not, because
the wheel stress of a flat star is in the left kernel of J. All configurations of the motion but the
flat state are regular. So s_1 is not 0. Let s_1 > 0. From the common point backwards, the motion
and the arc are the one curve of regular configurations through it, the motion until the flat state,
the arc until the branch point; so these are the same. But the flat state is no branch point: a
patch that is the whole sheet is refused, and the height of a vertex outside the patch changes no
length at the flat state to first order, so that the equations of the branch point are not regular
there. With more corners this last step fails: the ties of docs/motion.md, 9 may fix this height.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TypedDict

from ..core.reading import items, keys, natural, require
from .chain import Chain
from .claims import BranchClaim, Document
from .lengths import Arc
from .pieces import arc_of, parameter_of


class FlatStars(TypedDict):
    """A branch point, named by the vertices whose stars are flat.

    `clear` says whether no faces touch up to this point and at it.
    """

    flat: list[int]
    clear: bool


class Through(BranchClaim):
    """The curve goes through these branch points in this order, and is regular everywhere else.

    For each branch point the vertices that are flat there are listed. A motion without this key is
    claimed to be regular throughout.
    """

    names = ("through",)
    always = True

    @classmethod
    def keys_in(cls, claims: Document) -> tuple[str, ...]:
        """The key of this claim, if the file has it."""
        return cls.names if "through" in claims else ()

    def check(self, chain: Chain) -> None:
        """Refuse a motion that passes other branch points than those claimed."""
        claimed = "through" in self.claims
        message = "a motion passes branch points and claims none, or the other way round"
        require(claimed == bool(chain.passed), message)
        lists = items(self.claims["through"], "through") if claimed else []
        listed = [[natural(v, "flat vertex") for v in items(flat, "flat")] for flat in lists]
        require(listed == chain.passed, "the motion passes other branch points than those claimed")

    @staticmethod
    def said(claims: Document) -> str:
        """The branch points, one after the other."""
        return "".join(
            f", through a branch point where {_flat(flat)}" for flat in claims.get("through", [])
        )


class Node(BranchClaim):
    """The motion ends at a branch point at which the vertices `flat` are flat.

    It is regular up to there, except at the branch points that it goes through. If `clear` is true,
    no two faces touch up to this branch point, nor at it.
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
        """Verify the arc to the branch point, and that it begins on the last tube."""
        entry, path = self.evidence["node"], chain.path
        keys(entry, "node centre row reach entry", "node")
        arc = arc_of(chain.equations, self.claims["node"]["flat"], entry)
        begin, end = parameter_of(entry["entry"]), Fraction(0)
        path.meet(*arc.configuration(begin))
        # This can fail only after another branch point, or with a rim: see the module's docstring.
        require(begin < end, "an arc does not lead to its branch point")
        path.go(*arc.configuration(end))
        chain.steps.append(Arc(arc, begin, end))

    def check(self, chain: Chain) -> None:
        """Refuse "clear" unless the clear part of the motion extends to the branch point.

        The claim `Contacts` verifies the clear part.
        """
        if not self.claims["node"]["clear"]:
            return
        given = self.evidence.get("contacts", {})
        to_the_end = (given.get("tube"), given.get("clear")) == (len(chain.steps), 0)
        require(to_the_end, "the motion is not shown to be clear up to its branch point")

    @staticmethod
    def said(claims: Document) -> str:
        """The branch point."""
        return f", to a branch point where {_flat(claims['node']['flat'])}"


def _flat(flat: list[int]) -> str:
    """The words that say which vertices are flat."""
    several = len(flat) > 1
    names = " and ".join(map(str, flat))
    return f"{'vertices' if several else 'vertex'} {names} {'are' if several else 'is'} flat"
