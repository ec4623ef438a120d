"""Motions that come back to the flat state, along another ray (docs/motions.md).

On the last tube lies a point of the start tube of the other ray, or of its mirror image,
which passes it in the opposite direction: so the motion ends in the flat state along this one.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from ..core.reading import integer, keys, require
from .chain import Chain
from .claims import BranchClaim, Document
from .pieces import ROOT_BITS, start_of
from .ray import check_half_branch, text_of
from .tubes import Ball, Start


class Return(BranchClaim):
    """The motion ends in the flat state, along the ray with these vertex signs and side."""

    names = ("return",)
    needs = ("landing",)
    continues = True

    def __init__(self, claims: Document, evidence: Document) -> None:
        super().__init__(claims, evidence)
        apart = claims.keys().isdisjoint(("node", "clear", "contact"))
        require(apart, "a motion that returns claims a branch point, or contacts")
        keys(claims["return"], "vertex_signs side", "return")

    def go_on(self, chain: Chain) -> None:
        """Where it lands, along which ray, and how long it is in all."""
        end, way = land(chain, self.evidence["landing"])
        check_half_branch(chain, end, self.claims["return"], way)

    @staticmethod
    def said(claims: Document) -> str:
        """Along what."""
        return f", and back to the flat state along {text_of(claims['return'], count=False)}"


def land(chain: Chain, entry: Any) -> tuple[Start, int]:
    """The start tube on which a motion comes back, against its direction, to the flat state.

    A point of it, or of its mirror image for a way of -1, lies on the last tube.
    """
    keys(entry, "centre halvings held reach tau", "landing")
    end, way = start_of(chain.equations, entry), 1
    tau = Fraction(integer(entry["tau"]), 1 << ROOT_BITS)
    require(tau, "a loop does not land before the flat state")
    point, velocity = end.configuration(tau)
    if tau > 0:
        velocity = Ball([-x for x in velocity.centre], velocity.radii)
    else:
        way = -1
    chain.path.meet(point, velocity)
    chain.path.land()
    return end, way
