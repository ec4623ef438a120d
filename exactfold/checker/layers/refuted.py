"""Certificates that a sheet of rigid panels has no flat-folded state (docs/flat.md).

The `reason` is one of

- "kawasaki": the folds do not close at the `vertex`, so that there is no folding map (`folding`);
- "maekawa": at the `vertex` the number of mountains less that of valleys is not 2 or -2 (J. Justin,
  Mathematics of origami, part 9, 1986). In a state the paper on a small circle round the vertex
  folds to a closed curve that is drawn over an arc of at most a half circle without crossing
  itself. So it turns by 360 degrees in all, and it turns by 180 degrees at each fold, one way at
  mountains and the other way at valleys;
- "layers": clauses about orders of layers contradict each other, and `vertex` is null.

In the first two cases the evidence has no keys. In the third it has

- `pieces`, as in `state`;
- `places`: [x, y] in the plane, or [i, j, t], the share t of the way from corner i to corner j;
- `clauses`: [place, clause], a clause that is true at the place with this number (`places`). A
  clause is a list of orders [a, b], "piece a lies below piece b", one of which holds;
- `steps`: [clause, hints], a clause that follows from those with the numbers `hints`, which begin
  with the `clauses` and go on with the steps (`refutation`). The last clause has no orders.

Each letter M or V is a clause with one order, which has no number.
"""

from __future__ import annotations

from typing import Any, TypedDict

from ..core.kinds import DocumentKind
from ..core.reading import items, keys, keys_of, natural, refusing, require
from ..sheets.panels import Edge, PanelSheet, pair, read_panels
from .folding import FoldedSheet, asked, closes, read_letters, read_pieces
from .places import Places
from .plane import Plane
from .refutation import Refutation


class FlatRefutedClaims(TypedDict):
    """The claims of a file (see `check`)."""

    letters: str
    reason: str
    vertex: int | None


class VerifiedFlatRefuted(FlatRefutedClaims):
    """The verified claims, with the digest of the pattern."""

    sha256: str


@refusing()
def check(data: dict[str, Any]) -> VerifiedFlatRefuted:
    """Verify every claim of a loaded certificate; raises `CertificateError` at the first failure.

    Returns the claims and the SHA-256 of the pattern. The `letters` have one letter for each fold,
    in lexicographic order of the folds, as in `state`. No flat-folded state has these letters.
    """
    claims, evidence = data["claims"], data["evidence"]
    keys(claims, keys_of(FlatRefutedClaims), "claims")
    sheet, digest = read_panels(data["pattern"])
    letters = read_letters(sheet, claims["letters"])
    reason, vertex = claims["reason"], claims["vertex"]
    if reason == "layers":
        require(vertex is None, "a reason about layers names a vertex")
        keys(evidence, "pieces places clauses steps", "evidence")
        folded = FoldedSheet(sheet, letters, read_pieces(sheet, evidence["pieces"]))
        read_clauses(Plane(folded), evidence).contradict([], evidence["steps"])
    else:
        known_reason = reason in ("kawasaki", "maekawa")
        require(known_reason, f'the reason {reason!a} is not "kawasaki", "maekawa" or "layers"')
        keys(evidence, "", "evidence")
        inside = natural(vertex, "the vertex") in sheet.interior
        require(inside, f"vertex {vertex} is not inside the sheet")
        if reason == "kawasaki":
            require(not closes(sheet, letters, vertex), f"the folds close at vertex {vertex}")
        else:
            _check_excess(sheet, letters, vertex)
    proved: FlatRefutedClaims = claims
    return {"sha256": digest, **proved}


def _check_excess(sheet: PanelSheet, letters: dict[Edge, str], v: int) -> None:
    """Raise unless a vertex has mountains and valleys whose numbers do not differ by 2."""
    around = [letters[pair(v, u)] for u in sheet.around[v]]
    require("U" not in around, f"a fold at vertex {v} has no letter")
    excess = around.count("M") - around.count("V")
    wrong = abs(excess) != 2 and set(around) != {"F"}
    require(wrong, f"the letters at vertex {v} fulfil Maekawa's condition")


def read_clauses(plane: Plane, evidence: dict[str, Any]) -> Refutation:
    """The clauses of a file that are true by letters, or by the layers at a place."""
    known = Refutation(len(plane.folded.pieces), plane.folded.lettered.values())
    places = Places(plane, evidence["places"])
    for entry in items(evidence["clauses"], "clauses"):
        known.add(places.read_clause(entry))
    return known


_REASONS = {
    "kawasaki": "the folds do not close at vertex {}",
    "maekawa": "at vertex {} the mountains and the valleys do not differ by two",
    "layers": "every order of layers has a crossing",
}


def summary(claims: VerifiedFlatRefuted) -> str:
    """One line that states the verified claims."""
    return (
        f"VALID: the sheet has no flat-folded state {asked(claims['letters'])}: "
        f"{_REASONS[claims['reason']].format(claims['vertex'])}; sha256 {claims['sha256']}"
    )


FLAT_REFUTED = DocumentKind(
    format="exactfold flat-folded states",
    named="flat-refuted",
    versions=(1,),
    names="format version kind pattern claims evidence",
    claims=VerifiedFlatRefuted,
    check=check,
    summary=summary,
)
"""That a sheet of rigid panels has no flat-folded state (docs/flat.md)."""
