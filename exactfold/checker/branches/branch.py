"""Certificates of one branch with given vertex signs (docs/branch.md).

Why it is a proof: heights with K_v > 0 at every interior vertex bound the distance to the only
solution with the same signs (Theorem 5 of docs/branch.md, which also describes the file); heights
that solve the equations exactly are that solution. The boundary must be convex, or that of a
quadrilateral whose notch is closed here. Vertices inside a 3-cycle of edges stay flat (Theorem 2
(a), applied to the triangle) and are removed. In version 2 the curvatures K_v are not 0 but the
angle deficits that are claimed, for a given rim; Theorem 5 holds as it is, and a vertex with a
positive deficit is not flat. Other folds are flat if the heights are exact and
flat there, or if K_v = 0 at a vertex leaves them no other choice (`close_flat`).
"""

from __future__ import annotations

from fractions import Fraction
from math import lcm
from typing import Any, TypedDict

from ..core.kinds import DocumentKind
from ..core.reading import items, keys, keys_of, parse_integer, parse_rational, refusing, require
from ..sheets.reduced import check_convex, closed, emptied_sheet
from ..sheets.sheet import Sheet, read_sheet, turn
from .branch_proof import Heights, Proof

FLAT, CURVED = 1, 2
"""The versions: of a branch, and of one shape of a sheet with angle deficits."""


class BranchClaims(TypedDict):
    """What a file claims, with exact numbers in quotes (see `check`)."""

    gauge: str
    vertex_signs: list[int]
    assignment: str
    squared_distance: str


class CurvedClaims(BranchClaims, total=False):
    """The same, with the angle deficits that every file of version 2 has."""

    curvature: list[str]


class VerifiedBranch(CurvedClaims):
    """What is verified, with the number of interior vertices and the digest of the pattern."""

    interior: int
    sha256: str


@refusing()
def check(data: dict[str, Any]) -> VerifiedBranch:
    """Verify every claim of a loaded certificate; raises `CertificateError` at the first failure.

    Returns the claims and the SHA-256 of the pattern. The claims are: of all branches, or of all
    solutions with the rim of the heights if `gauge` is "rim", exactly one has these vertex signs,
    all of them exact, 0 where the star is flat; its folds have these letters, "U" making no claim;
    and for its heights h the integral of |grad(h - heights)|^2 is at most `squared_distance`. In
    version 2 "solutions" are those with K_v = `curvature`, in the order of the interior vertices.
    """
    given, digest = read_sheet(data["pattern"])
    claims, evidence = data["claims"], data["evidence"]
    curved = data["version"] == CURVED
    keys(claims, keys_of(CurvedClaims if curved else BranchClaims), "claims")
    keys(evidence, "emptied heights denominator", "evidence")
    place = Place(given, evidence["emptied"])
    targets = place.targets(claims["curvature"]) if curved else {}
    if claims["gauge"] != "rim":
        require(not curved, "angle deficits need a given rim")
        require(claims["gauge"] == "saddle", "the gauge is neither saddle nor rim")
        place.fix_rim()
    check_convex(place.sheet)
    proof = place.proof(evidence["heights"], evidence["denominator"], targets)
    require(
        proof.squared_distance <= parse_rational(claims["squared_distance"]),
        "the distance is larger than claimed",
    )
    _check_signs(place, claims["vertex_signs"], proof)
    _check_letters(place, claims["assignment"], proof)
    proved: CurvedClaims = claims
    return {"sha256": digest, "interior": len(given.interior), **proved}


# --- the sheet -----------------------------------------------------------------------------------


class Place:
    """The sheet that heights are given for, in integers and without the vertices `removed`.

    Once its rim is fixed, its notch is closed if it has the reflex corner `corner`, and the heights
    are those of one half of a branch. `open` is the sheet with the notch.
    """

    def __init__(self, given: Sheet, emptied: Any) -> None:
        self.given = given
        self.unit = lcm(*(x.denominator for point in given.points.values() for x in point))
        points: dict[int, Any] = {
            v: (int(x * self.unit), int(y * self.unit)) for v, (x, y) in given.points.items()
        }
        self.sheet, self.removed = emptied_sheet(given, points, emptied)
        self.open = self.sheet
        self.corner: int | None = None
        self.fixed = False

    def fix_rim(self) -> None:
        """Ask for a quadrilateral, with its saddle positive or its reflex corner up."""
        require(len(self.sheet.boundary) == 4, "there are not four boundary vertices")
        self.sheet, self.corner = closed(self.sheet)
        self.fixed = True

    def targets(self, texts: Any) -> dict[int, Fraction]:
        """The angle deficits that are not 0, for integer lengths."""
        interior = self.given.interior
        deficits = [parse_rational(text) for text in items(texts, "curvature", len(interior))]
        found = {}
        for v, deficit in zip(interior, deficits, strict=True):
            require(deficit >= 0, f"the angle deficit of vertex {v} is negative")
            bent = not deficit or v not in self.removed
            require(bent, f"vertex {v} is not flat, as it has a deficit")
            if deficit:
                found[v] = deficit / self.unit**2
        return found

    def proof(
        self, numerators: Any, denominator: Any, targets: dict[int, Fraction] | None = None
    ) -> Proof:
        """What heights prove."""
        texts = items(numerators, "heights", len(self.given.points))
        fits = all((texts[v] is None) == (v in self.removed) for v in self.given.points)
        require(fits, "heights do not fit")
        heights = {v: parse_integer(texts[v]) for v in self.sheet.points}
        q = parse_integer(denominator)
        require(q > 0, "the denominator is not positive")
        if self.fixed:
            _check_gauge(self.sheet, heights, self.corner)
        proof = Proof(self.sheet, heights, q, self.corner, targets or {})
        if self.corner is not None:
            require(proof.signs[self.corner] == 1, "the reflex corner does not pop up")
        return proof

    def signs(self, proof: Proof) -> list[int]:
        """The signs of the interior vertices of the given sheet, 0 where the star is flat."""
        seen: dict[int, set[str]] = {v: set() for v in self.sheet.points}
        for fold, letter in proof.letters.items():
            for v in fold:
                seen[v].add(letter)
        signs = []
        for v in self.given.interior:
            sign = 0
            if v not in self.removed and seen[v] != {"F"}:
                bent = seen[v] & {"M", "V"} or v in proof.targets
                require(bent, f"vertex {v} may be flat")
                sign = proof.signs[v]
            signs.append(sign)
        return signs

    def letters(self, proof: Proof) -> list[str]:
        """The letters of the folds of the given sheet, "U" where they are not proved."""
        return [
            "F" if not self.removed.isdisjoint(fold) else proof.letters[fold]
            for fold in self.given.folds
        ]


def _check_gauge(sheet: Sheet, heights: Heights, corner: int | None) -> None:
    if corner is not None:
        require(all(heights[v] == 0 for v in sheet.boundary), "the rim is not flat")
        return
    a, b, c, d = sheet.boundary
    p, q, r, s = (sheet.points[v] for v in sheet.boundary)
    weights = (
        turn(q, r, s),
        -turn(p, r, s),
        turn(p, q, s),
        -turn(p, q, r),
    )
    saddle = sum(w * heights[v] for w, v in zip(weights, (a, b, c, d), strict=True))
    require(saddle * next(w for w in weights if w) > 0, "the saddle is not positive")


def _check_signs(place: Place, signs: Any, proof: Proof) -> None:
    values = items(signs, "vertex_signs", len(place.given.interior))
    for v, sign, expected in zip(place.given.interior, values, place.signs(proof), strict=True):
        require(type(sign) is int and sign == expected, f"vertex {v} has another sign")


def _check_letters(place: Place, letters: Any, proof: Proof) -> None:
    folds = place.given.folds
    require(isinstance(letters, str) and len(letters) == len(folds), "letters do not fit")
    for fold, letter, expected in zip(folds, letters, place.letters(proof), strict=True):
        require(letter == expected or letter == "U", f"fold {fold} is not known to be {letter!a}")


def summary(claims: VerifiedBranch) -> str:
    """One line for verified claims."""
    signs = "".join("-0+"[s + 1] for s in claims["vertex_signs"])
    shown = signs if len(signs) <= 60 else signs[:60] + "..."
    decided = len(claims["assignment"]) - claims["assignment"].count("U")
    what = "solution over the border in the file" if claims["gauge"] == "rim" else "branch"
    if "curvature" in claims:
        what = "shape over the border in the file, with these angle deficits,"
    return (
        f"VALID: exactly one {what} has the vertex signs {shown} ({len(signs)}); "
        f"{decided} of {len(claims['assignment'])} letters decided; sha256 {claims['sha256']}"
    )


BRANCH = DocumentKind(
    format="exactfold branch",
    versions=(FLAT, CURVED),
    names="format version pattern claims evidence",
    claims=VerifiedBranch,
    check=check,
    summary=summary,
)
"""One branch with given vertex signs (docs/branch.md)."""
