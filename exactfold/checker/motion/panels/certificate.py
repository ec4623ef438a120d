"""Certificates of motions of rigid panels: how the panels fold, and which touch first.

All positions are analytic functions of a parameter x, which determines the time (`times`). The
evidence proves that the panels fold (`folding`). `CLAIMS` lists the claims that a file may make
about this motion, one class for each (docs/motion.md, 20 to 22).

The claims are `assignment`, with a letter for each fold in lexicographic order; the `drivers`, a
fold of each mode that moves and each free fold that does, which at time t have the angle t; in
version 2 their different `rates`, the largest 1; `clear` and `contact` as for branches; and in
versions 3 and 4 the folds that are `closed` at time pi, all that move, with no contact before, and
in version 4 the order of `layers` in which they end. Version 5 has `rates`, and may say that the
panels are `plates`, of which all contacts are then, and when the first fold reaches its `stop`. The
evidence has the `densities` of the active
folds at each interior vertex, numbers of the field of the sheet or with the square root of one
`radicand` more, the parameters x until which panels are parted, and at which an edge runs through a
panel or a `point` is in two plates, and those before and after a stop.
"""

from __future__ import annotations

from typing import Any, TypedDict, cast

from ...core.kinds import DocumentKind
from ...core.reading import refusing
from ...sheets.panels import read_panels
from ..claims import read_claims, words
from ..contacts import TouchingFaces
from .closing import Closed
from .contacts import Clear, Contact
from .folding import Driven, Folding, OwnRates, PanelClaim, Thick
from .layers import Layers, LayersDocument
from .stops import Stop

CLAIMS: tuple[type[PanelClaim], ...] = (
    Driven,
    OwnRates,
    Thick,
    Clear,
    Closed,
    Layers,
    Contact,
    Stop,
)
"""All claims, in the order in which a summary states them."""


class PlatesClaimed(TypedDict):
    """Panels with a thickness, in the unit of the pattern."""

    thickness: str
    hinge: str
    trim: str


class StopClaimed(TypedDict):
    """The stops of folds, in degrees, and the first that is reached."""

    angles: list[list[int | str]]
    fold: list[int]
    time: list[str]


class _Optional(TypedDict, total=False):
    rates: list[str]
    plates: PlatesClaimed
    stop: StopClaimed
    closed: list[list[int]]
    layers: LayersDocument
    contact: TouchingFaces


class VerifiedPanelMotion(_Optional):
    """The verified claims of a motion of rigid panels, and the digest of the pattern."""

    assignment: str
    drivers: list[list[int]]
    clear: str
    sha256: str


PLAIN, RATED, CLOSING, LAYERED, BUILT = 1, 2, 3, 4, 5
"""The versions: in 2 and 5 each driver has a rate of its own, in the others all move at the same
rate. In 3 and 4 no panels touch until all folds that move close, and 4 states their layers then. In
5 panels may be plates, and folds may have stops.
"""


@refusing()
def check(data: dict[str, Any]) -> VerifiedPanelMotion:
    """Verify every claim of a loaded certificate; raises `CertificateError` at the first failure.

    The classes in `CLAIMS` say what is claimed. Returns the claims and the SHA-256 of the pattern.
    """
    sheet, digest = read_panels(data["pattern"])
    version = data["version"]
    only = {
        OwnRates: (RATED, BUILT),
        Thick: (BUILT,),
        Closed: (CLOSING, LAYERED),
        Layers: (LAYERED,),
        Stop: (BUILT,),
    }
    kinds = [kind for kind in CLAIMS if version in only.get(kind, PANEL_MOTION.versions)]
    claims = read_claims(kinds, data["claims"], data["evidence"])
    folding = Folding(sheet, data["claims"], data["evidence"])
    for claim in claims:
        claim.check(folding)
    return cast("VerifiedPanelMotion", {"sha256": digest, **data["claims"]})


def summary(claims: VerifiedPanelMotion) -> str:
    """One line that states the verified claims."""
    return f"VALID: {words(CLAIMS, dict(claims))}; sha256 {claims['sha256']}"


PANEL_MOTION = DocumentKind(
    format="exactfold panel motion",
    versions=(PLAIN, RATED, CLOSING, LAYERED, BUILT),
    names="format version pattern claims evidence",
    claims=VerifiedPanelMotion,
    check=check,
    summary=summary,
)
"""A motion of rigid panels, and which panels touch first (docs/motion.md, 22)."""
