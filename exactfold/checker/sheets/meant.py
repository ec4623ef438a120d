"""Certificates of the sheet that was meant by a drawing (docs/certificate.md, The meant sheet).

A file has the points of a drawing as they were written, and an exact sheet with the same edges. The
checker finds that both have the same panels, that no vertex lies further from its written point
than claimed, and that the exact sheet has every relation of angles that is claimed (`relations`).

`drawn` is the drawing, without square roots, and `pattern` the exact sheet with the same vertices
and edges. The claims are numbers of vertices inside (`interior`) and on the boundary (`border`), of
`folds` and `panels`; the digests of both sheets, `drawn` and `sha256`; `within`, so many times the
larger side of the drawing; and the `relations`, each with its `kind`, its `name`, its `terms`
[i, j, n] and its `parts`. There is no other evidence.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any, TypedDict

from ..core.kinds import DocumentKind
from ..core.reading import (
    counted,
    items,
    keys,
    keys_of,
    parse_rational,
    refusing,
    require,
    rounded,
    same,
)
from .panels import PanelSheet, dot, read_panels
from .relations import RelationClaim, Relations, same_terms


class MeantClaims(TypedDict):
    """The claims of a file (see `check`)."""

    interior: int
    border: int
    folds: int
    panels: int
    drawn: str
    within: str
    relations: list[RelationClaim]
    sha256: str


@refusing()
def check(data: dict[str, Any]) -> MeantClaims:
    """Verify every claim of a loaded certificate; raises `CertificateError` at the first failure.

    Returns the claims. `within` bounds how far each vertex lies from its written point, in units of
    the larger side of the drawing. `drawn` is the digest of the drawing as written, `sha256` that
    of the exact sheet.
    """
    claims = data["claims"]
    keys(claims, keys_of(MeantClaims), "claims")
    drawn, written = read_panels(data["drawn"])
    require(drawn.tower.size == 1, "the drawing has coordinates with square roots")
    sheet, digest = read_panels(data["pattern"])
    require(drawn.panels == sheet.panels, "the drawing and the sheet do not have the same panels")
    facts = {
        "interior": len(sheet.interior),
        "border": len(sheet.boundary_set),
        "folds": len(sheet.folds),
        "panels": len(sheet.panels),
        "drawn": written,
        "sha256": digest,
    }
    for key, fact in facts.items():
        require(same(claims[key], fact), f"claim {key} = {claims[key]!a}, but it is {fact!a}")
    _check_near(drawn, sheet, parse_rational(claims["within"]))
    relations = Relations(sheet)
    for entry in items(claims["relations"], "relations"):
        relations.check(entry)
    proved: MeantClaims = claims
    return proved


def _check_near(drawn: PanelSheet, sheet: PanelSheet, within: Fraction) -> None:
    require(within >= 0, "a distance is negative")
    sides = [[point[k].parts[0] for point in drawn.points] for k in (0, 1)]
    reach = within * max(max(side) - min(side) for side in sides)
    bound = sheet.tower.number(reach * reach)
    for v, ((ax, ay), (x, y)) in enumerate(zip(drawn.points, sheet.points, strict=True)):
        off = (x - sheet.tower.number(ax), y - sheet.tower.number(ay))
        require((bound - dot(off, off)).sign() >= 0, f"vertex {v} lies further from its drawing")


def summary(claims: MeantClaims) -> str:
    """One line that states the verified claims.

    A relation that is claimed as one of several kinds, such as straight and parallel, counts once.
    """
    kinds = [entry["kind"] for entry in claims["relations"]]
    each = ", ".join(f"{kinds.count(kind)} {kind}" for kind in dict.fromkeys(kinds))
    different = len({same_terms(entry) for entry in claims["relations"]})
    if different < len(kinds):
        each += f"; {counted(len(kinds) - different, 'is', 'are')} the same as others"
    within = rounded(parse_rational(claims["within"]), 3, up=True)
    return (
        f"VALID: within {within} of the size of the drawing {claims['drawn']} there is a sheet "
        f"with the same {counted(claims['panels'], 'panel', 'panels')} and with "
        f"{counted(different, 'exact relation', 'exact relations')} of angles"
        f"{f' ({each})' if kinds else ''}; sha256 {claims['sha256']}"
    )


MEANT = DocumentKind(
    format="exactfold meant sheet",
    versions=(1,),
    names="format version drawn pattern claims",
    claims=MeantClaims,
    check=check,
    summary=summary,
)
"""An exact sheet near a drawing, with exact relations of angles (docs/certificate.md)."""
