"""Certificates of motions: a branch followed from the flat state, without a gap (docs/motion.md).

The evidence is a chain of verified pieces of one curve (`chain`). `CLAIMS` lists the claims that a
file may make about this curve. Each claim is a class in the module that knows why it holds.

The evidence has the `start` tube and the `tubes`, of each its centre `c`, row `T`, reach `h` and
the parameter `exit` at which the motion leaves it; and for the end the arc to a `node` or the start
tube of the `landing`. No matrix and no polynomial is taken from the file.
"""

from __future__ import annotations

from typing import Any, TypedDict, cast

from ..core.kinds import DocumentKind
from ..core.reading import counted, items, refusing
from ..sheets.reduced import emptied_sheet
from ..sheets.sheet import read_sheet
from .boundary import BoundaryClaim
from .chain import Chain, check_work, equations_of
from .claims import BranchClaim, read_claims, words
from .contacts import Contacts, TouchingFaces
from .drive import DriveClaim, DrivenFolds
from .nodes import FlatStars, Node, Through
from .ray import Length, NamedHalf, Ray, Return

CLAIMS: tuple[type[BranchClaim], ...] = (
    Ray,
    Length,
    Through,
    Node,
    Return,
    BoundaryClaim,
    DriveClaim,
    Contacts,
)
"""All claims, in the order in which a summary states them."""

_Return = TypedDict("_Return", {"return": NamedHalf}, total=False)  # "return" is a keyword


class _Optional(_Return, total=False):
    through: list[list[int]]
    node: FlatStars
    rim: list[str]
    drive: DrivenFolds
    clear: str
    contact: TouchingFaces
    pinned: list[int]


class VerifiedMotion(NamedHalf, _Optional):
    """The verified claims of a motion along a branch: the keys of its `CLAIMS`.

    The checker adds the digest of the pattern, the number of `tubes` and, if there is a `rim`, the
    vertices of the face that is held, `pinned`.
    """

    length: str
    tubes: int
    sha256: str


_EVIDENCE = ("emptied", "pinned", "bits", "start", "tubes")


@refusing()
def check(data: dict[str, Any]) -> VerifiedMotion:
    """Verify every claim of a loaded certificate; raises `CertificateError` at the first failure.

    The classes in `CLAIMS` say what is claimed. Returns the claims, the SHA-256 of the pattern, and
    the number of `tubes` between the first piece and the end, without arcs through branch points.
    If boundary heights are claimed, the face `pinned` above which they are measured is added.
    """
    given, digest = read_sheet(data["pattern"])
    evidence = data["evidence"]
    claims = read_claims(CLAIMS, data["claims"], evidence, _EVIDENCE)
    sheet, removed = emptied_sheet(given, dict(given.points), evidence["emptied"])
    restrictions = [r for claim in claims if (r := claim.restriction(given, sheet)) is not None]
    equations = equations_of(sheet, evidence["pinned"], evidence["bits"], restrictions)
    tubes = items(evidence["tubes"], "tubes")
    check_work(equations, tubes, sum(claim.arcs for claim in claims))
    chain = Chain(given, removed, equations, evidence["start"])
    for claim in claims:
        claim.begin(chain)
    chain.walk(tubes, leaves=not any(claim.continues for claim in claims))
    for claim in claims:
        claim.go_on(chain)
    for claim in claims:
        claim.check(chain)
    return cast("VerifiedMotion", {"sha256": digest, **chain.facts, **data["claims"]})


def summary(claims: VerifiedMotion) -> str:
    """One line that states the verified claims."""
    tubes = counted(claims["tubes"], "tube", "tubes")
    return f"VALID: {words(CLAIMS, dict(claims))}; {tubes}; sha256 {claims['sha256']}"


MOTION = DocumentKind(
    format="exactfold motion",
    versions=(1,),
    names="format version pattern claims evidence",
    claims=VerifiedMotion,
    check=check,
    summary=summary,
)
"""The motion along a ray of a branch, as a chain of tubes (docs/motion.md)."""
