"""Certificates of all branches and pleats of a periodic sheet (docs/tessellations.md).

By theorem all solutions of second order form linear spaces, one for each pair of opposite sign
vectors s: the span of the cone C_s. The evidence shows for every pair which space this is.

  triangles   rings of three edges with the vertices inside: `ring` and `inside` are corners. What
              is inside stays flat, and each such vertex doubles multiplicities. The rest is about
              the sheet with the rings as faces.
  unit        z = (w_1, ..., w_m, c) has c = b / unit.
  rays        boxes in which the entry `place` of z is 1, and which hold one simple solution each,
              by Krawczyk's test. A ray whose vertices all have a sign is the cone of these signs.
              A fold whose row is a factor of a form is flat where the other factor is not 0.
  spaces      a `basis` on which all forms vanish, and points of the space. The cone of every sign
              vector that agrees with a point off its flat vertices F lies in the radical, on all a
              with K_u(point, a) = 0 for u not in F, of the sum of the K_v with v in F. Where a K_v
              is a multiple of a square there, it lies in the radical of K_v, and so on. The last
              of these has to be the space.
  lines       in version 2: points over quadratic fields, each with a line for its space. Those with
              b = 0 are the claims `lines`, by heights w and b.

The claims list each branch by the side on which the first vertex that is not flat pops up:
`vertex_signs`, `multiplicity`, the sign `b`, and `letters` for the edges (u, v, i, j) in increasing
order; `pleats`, the maximal spaces with b = 0, and `families`, the spaces of two or more dimensions
in which b is not 0, by a reduced echelon basis of heights w and b.
"""

from __future__ import annotations

from typing import Any, TypedDict

from ..core.kinds import DocumentKind
from ..core.reading import (
    counted,
    integer,
    items,
    keys,
    parse_rational,
    refusing,
    require,
    same,
)
from ..sheets.cell import read_cell
from .periodic_lines import LineClaim
from .periodic_proof import PeriodicBranchClaim, PeriodicProof, SpaceClaim

_NAMES = "direction distinct with_multiplicity branches pleats families sha256"


class _Lines(TypedDict, total=False):
    lines: list[LineClaim]


class PeriodicClaims(_Lines):
    """All solutions for one direction; the counts are those of the isolated ones with b = 1."""

    direction: list[int]
    distinct: int
    with_multiplicity: int
    branches: list[PeriodicBranchClaim]
    pleats: list[SpaceClaim]
    families: list[SpaceClaim]
    sha256: str


@refusing()
def check(data: dict[str, Any]) -> PeriodicClaims:
    """Verify every claim of a certificate; raises `CertificateError` at the first failure."""
    claims, evidence = data["claims"], data["evidence"]
    more = " lines" if data["version"] > 1 else ""
    keys(claims, _NAMES + more, "claims")
    keys(evidence, "triangles unit rays spaces" + more, "evidence")
    cell = read_cell(data["pattern"])
    x, y = map(integer, items(claims["direction"], "direction", 2))
    require((x, y) != (0, 0), "the direction is 0")
    unit = parse_rational(evidence["unit"])
    require(unit > 0, "the unit is not positive")
    proof = PeriodicProof(cell, (x, y), unit, evidence)
    branches, spaces = proof.branches, [proof.shown(rows) for rows in proof.pleats]
    facts: PeriodicClaims = {
        "direction": [x, y],
        "distinct": len(branches),
        "with_multiplicity": sum(branch["multiplicity"] for branch in branches),
        "branches": branches,
        "pleats": spaces,
        "families": [proof.shown(rows) for rows in proof.families],
        "sha256": cell.sha256(),
    }
    if more:
        facts["lines"] = proof.lines
    for key, fact in facts.items():
        require(same(claims[key], fact), f"the claim {key!r} is not what the evidence shows")
    return facts


def summary(claims: PeriodicClaims) -> str:
    """One line that states the verified claims."""
    x, y = claims["direction"]
    found = counted(claims["distinct"], "branch", "branches")
    pleats = counted(
        len(claims["pleats"]) + len(claims.get("lines", [])), "space of pleats", "spaces of pleats"
    )
    families = counted(len(claims["families"]), "family", "families")
    return (
        f"VALID: {found} of a periodic sheet for the direction {x},{y}, "
        f"{claims['with_multiplicity']} with multiplicity, {pleats}, {families}; "
        f"sha256 {claims['sha256']}"
    )


PERIODIC = DocumentKind(
    format="exactfold periodic certificate",
    versions=(1, 2),
    names="format version pattern claims evidence",
    claims=PeriodicClaims,
    check=check,
    summary=summary,
)
"""All branches and pleats of a periodic sheet for one direction."""
