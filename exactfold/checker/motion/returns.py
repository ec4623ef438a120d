"""Motions that come back to the flat state along another ray (docs/motion.md, 6).

A point of the start tube of the other ray, or of its mirror image, lies on the last tube, and the
two tubes go in opposite directions there. So the motion ends in the flat state along this ray.
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
