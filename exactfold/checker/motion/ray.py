"""Which ray a motion follows, how far, and along which ray it comes back to the flat state.

Signs of the heights at the flat state name a ray. A motion comes back along another ray if a point
of the start tube of this ray, or of its mirror image, lies on the last tube, and the two go in
opposite directions there (docs/motion.md, 6).
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any, TypedDict

from ..core.reading import integer, items, keys, parse_rational, require, shown
from ..sheets.sheet import Sheet
from .chain import Chain
from .claims import BranchClaim, Document
from .pieces import ROOT_BITS, start_of
from .tubes import Ball, Start

_SIGNS = 60  # signs that a summary shows


class NamedHalf(TypedDict):
    """A ray, named by the signs of the interior vertices and its side of the flat state."""

    vertex_signs: list[int]
    side: int


class Ray(BranchClaim):
    """The ray with these vertex signs and this side, 1 or -1, belongs to exactly one simple branch.

    From the flat state one analytic curve of configurations follows the ray. `side` is the sign of
    the boundary saddle; if there is a reflex corner, it is the sign of this corner in the sheet
    with its notch closed. With more than four corners, the claim about the boundary or about driven
    folds defines it.
    """

    names = ("vertex_signs", "side")
    always = True

    def begin(self, chain: Chain) -> None:
        """Refuse a chain whose first piece has other signs."""
        check_half_branch(chain, chain.start, self.claims)

    @staticmethod
    def said(claims: Document) -> str:
        """The ray along which the curve begins."""
        name = text_of(claims)
        return f"the motion along the ray {name}, is one curve without a gap"


class Length(BranchClaim):
    """The curve has at least this length in the space of all vertex positions, with one face held.

    The length is in the unit of the sheet. Chords between configurations on the way prove it.
    """

    names = ("length",)
    always = True

    def check(self, chain: Chain) -> None:
        """Refuse a motion whose chords add up to less than the claimed length."""
        claimed, unit = parse_rational(self.claims["length"]), chain.equations.unit
        require(claimed <= chain.path.length * unit, "the motion is shorter than claimed")

    @staticmethod
    def said(claims: Document) -> str:
        """The length, rounded down."""
        return f" of length {shown(claims['length'])} or more"


class Return(BranchClaim):
    """The motion ends in the flat state, along the ray with these vertex signs and this side."""

    names = ("return",)
    needs = ("landing",)
    continues = True

    def __init__(self, claims: Document, evidence: Document) -> None:
        super().__init__(claims, evidence)
        apart = claims.keys().isdisjoint(("node", "clear", "contact"))
        require(apart, "a motion that returns may not claim a branch point at its end, or contacts")
        keys(claims["return"], "vertex_signs side", "return")

    def go_on(self, chain: Chain) -> None:
        """Verify that the motion lands, and along which ray."""
        end, way = land(chain, self.evidence["landing"])
        check_half_branch(chain, end, self.claims["return"], way)

    @staticmethod
    def said(claims: Document) -> str:
        """The ray along which the motion comes back."""
        return f", and back to the flat state along {text_of(claims['return'], count=False)}"


def land(chain: Chain, entry: Any) -> tuple[Start, int]:
    """Verify that a motion comes back to the flat state along a start tube, against its direction.

    Returns the start tube and a way. A point of the start tube lies on the last tube if the way is
    1, a point of its mirror image if the way is -1.
    """
    keys(entry, "centre halvings held reach tau", "landing")
    end, way = start_of(chain.equations, entry), 1
    tau = Fraction(integer(entry["tau"]), 1 << ROOT_BITS)
    require(tau, "the last tube of a motion must meet the start tube before the flat state")
    point, velocity = end.configuration(tau)
    if tau > 0:
        velocity = Ball([-x for x in velocity.centre], velocity.radii)
    else:
        way = -1
    chain.path.meet(point, velocity)
    chain.path.land()
    return end, way


def check_half_branch(chain: Chain, start: Start, claim: Document, way: int = 1) -> None:
    """Raise unless the heights of a start tube have the vertex signs and the side of a claim.

    If `way` is -1, the claim is about the mirror image.
    """
    given = chain.given
    signs, side = names(given, chain.removed, start)
    values = items(claim["vertex_signs"], "vertex_signs", len(given.interior))
    for v, value, expected in zip(given.interior, values, signs, strict=True):
        right = type(value) is int and value == way * expected
        require(right, f"vertex {v} does not have the claimed sign")
    right = type(claim["side"]) is int and claim["side"] == way * side
    require(right, "the side is not the claimed one")


def names(given: Sheet, removed: set[int], start: Start) -> tuple[list[int], int]:
    """The vertex signs and the side of a ray, from its heights at the flat state.

    The sign of a vertex that was removed is 0.
    """
    box, place = start.enclosure(Fraction(0)), start.equations.place

    def sign(functional: Mapping[int, Fraction]) -> int:
        """The sign of a functional of the heights, 0 if it is not certain."""
        terms = [(c, place[v] + 2) for v, c in functional.items() if v in place]
        middle = sum((c * box.centre[k] for c, k in terms), Fraction(0))
        spread = sum((abs(c) * box.radii[k] for c, k in terms), Fraction(0))
        return 0 if abs(middle) <= spread else 1 if middle > 0 else -1

    sheet = start.equations.sheet
    signs = [0 if v in removed else sign(sheet.sign_of_vertex(v)) for v in given.interior]
    for v, known in zip(given.interior, signs, strict=True):
        require(known or v in removed, f"vertex {v} may be flat")
    side = start.equations.restriction.side(sign)
    require(side, "the side of the branch is not certain")
    return signs, side


def text_of(claim: Document, count: bool = True) -> str:
    """The signs and the side of a ray in words; if `count`, also the number of signs."""
    signs = "".join("-0+"[s + 1] for s in claim["vertex_signs"])
    number = f" ({len(signs)})" if count else ""
    side = "+" if claim["side"] > 0 else "-"
    return f"{shortened(signs)}{number}, side {side}"


def shortened(signs: str) -> str:
    """A text of signs, cut if it is long."""
    return signs if len(signs) <= _SIGNS else signs[:_SIGNS] + "..."
