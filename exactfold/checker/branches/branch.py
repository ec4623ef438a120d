"""Certificates of one branch with given vertex signs (docs/branch.md).

Why it is a proof: the file gives heights with K_v > 0 at every interior vertex. Theorem 5 of
docs/branch.md then bounds the distance to the only solution with the same signs. Heights that solve
the equations exactly are this solution. The boundary must be convex, or it is a quadrilateral whose
notch is closed here. Vertices inside a 3-cycle of edges stay flat (Theorem 2 (a), applied to the
triangle) and are removed. In version 2 the boundary heights are given, and the curvatures K_v are
the claimed angle deficits instead of 0; Theorem 5 holds without change, and a vertex with a
positive deficit is not flat. Any other fold is proved flat in one of two ways: the heights are
exact and do not bend it, or K_v = 0 at one of its vertices leaves it no other choice
(`close_flat`).

The claims are the `gauge` ("saddle", or "rim": about the rim of the heights); `vertex_signs` in the
order of the interior vertices (0 where the star is flat); `assignment` in the order of the folds
("U" claims nothing); `squared_distance` (0 if the heights are exact); and in version 2, of which
the gauge is "rim", `curvature`, rationals in the order of the interior vertices. The evidence has
`emptied`, the triangulated triangles as `corners` and `inside`, and `heights`, numerators of all
vertices over `denominator`, null for the vertices inside. In version 3 it also has `merged`, each
larger triangle with its `corners` and its `others`, the vertices in it or on its sides; their
heights are null.
"""

from __future__ import annotations

from fractions import Fraction
from math import lcm
from typing import Any, TypedDict

from ..core.kinds import DocumentKind
from ..core.reading import items, keys, keys_of, parse_integer, parse_rational, refusing, require
from ..sheets.reduced import check_convex, closed, emptied_sheet, merged_sheet
from ..sheets.sheet import Edge, Sheet, read_sheet, turn
from .branch_proof import Heights, Proof

FLAT, CURVED, MERGED = 1, 2, 3
"""The versions: 1 for one branch of a flat sheet, 2 for one shape of a sheet with angle deficits,
and 3 for one branch on whose sheet larger triangles are merged.
"""


class BranchClaims(TypedDict):
    """The claims of a file of version 1, with exact numbers in quotes (see `check`)."""

    gauge: str
    vertex_signs: list[int]
    assignment: str
    squared_distance: str


class CurvedClaims(BranchClaims, total=False):
    """The claims of a file of version 2, which also has angle deficits."""

    curvature: list[str]


class VerifiedBranch(CurvedClaims):
    """The verified claims, with the number of interior vertices and the digest of the pattern."""

    interior: int
    sha256: str


@refusing()
def check(data: dict[str, Any]) -> VerifiedBranch:
    """Verify every claim of a loaded certificate; raises `CertificateError` at the first failure.

    Returns the claims and the SHA-256 of the pattern. The claims are: exactly one branch has these
    vertex signs, or if `gauge` is "rim", exactly one solution over the boundary heights in the
    file. All signs are exact; a sign is 0 where the star is flat. The folds of this branch have
    these letters, where "U" claims nothing. For its heights h the integral of |grad(h - heights)|^2
    is at most `squared_distance`. In version 2 a solution satisfies K_v = `curvature`, with one
    entry for each interior vertex in order.
    """
    given, digest = read_sheet(data["pattern"])
    claims, evidence = data["claims"], data["evidence"]
    curved, merged = data["version"] == CURVED, data["version"] == MERGED
    keys(claims, keys_of(CurvedClaims if curved else BranchClaims), "claims")
    keys(evidence, "emptied heights denominator" + " merged" * merged, "evidence")
    place = Place(given, evidence["emptied"])
    if merged:
        place.merge(evidence["merged"])
    targets = place.targets(claims["curvature"]) if curved else {}
    if claims["gauge"] != "rim":
        require(not curved, 'angle deficits need the gauge "rim"')
        require(claims["gauge"] == "saddle", "the gauge is neither saddle nor rim")
        place.fix_boundary()
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
    """The sheet on which heights are given, in integer coordinates, without the vertices `removed`.

    After `fix_boundary` the heights are those of one ray of a branch. If the sheet has a reflex
    corner, this is `corner`, and `sheet` has its notch closed. `open` is the sheet with the notch.
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
        self.merged: dict[int, Edge | None] = {}

    def merge(self, evidence: Any) -> None:
        """Make the listed triangles single faces; `merged` are the vertices that are left out."""
        self.sheet, self.merged = merged_sheet(self.sheet, evidence)
        self.open = self.sheet

    def fix_boundary(self) -> None:
        """Require four corners, and heights with a positive saddle or with the reflex corner up."""
        require(len(self.sheet.boundary) == 4, "there are not four boundary vertices")
        self.sheet, self.corner = closed(self.sheet)
        self.fixed = True

    def targets(self, texts: Any) -> dict[int, Fraction]:
        """The angle deficits that are not 0, in the unit in which all coordinates are integers."""
        interior = self.given.interior
        deficits = [parse_rational(text) for text in items(texts, "curvature", len(interior))]
        nonzero = {}
        for v, deficit in zip(interior, deficits, strict=True):
            require(deficit >= 0, f"the angle deficit of vertex {v} is negative")
            bent = not deficit or v not in self.removed
            require(bent, f"vertex {v} has an angle deficit, so that it is not flat in a triangle")
            if deficit:
                nonzero[v] = deficit / self.unit**2
        return nonzero

    def proof(
        self, numerators: Any, denominator: Any, targets: dict[int, Fraction] | None = None
    ) -> Proof:
        """Read heights, and work out what they prove."""
        texts = items(numerators, "heights", len(self.given.points))
        gone = self.removed | self.merged.keys()
        fits = all((texts[v] is None) == (v in gone) for v in self.given.points)
        require(fits, "heights must be null for the vertices that are removed, and for no others")
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
            if v in self.merged:
                letter = self._on_side(v, proof)
                require(letter != "U", f"vertex {v} may be flat")
                sign = (letter == "M") - (letter == "V")
            elif v not in self.removed and seen[v] != {"F"}:
                bent = seen[v] & {"M", "V"} or v in proof.targets
                require(bent, f"vertex {v} may be flat")
                sign = proof.signs[v]
            signs.append(sign)
        return signs

    def letters(self, proof: Proof) -> list[str]:
        """The letters of the folds of the given sheet, "U" where they are not proved."""
        return [self._letter(fold, proof) for fold in self.given.folds]

    def _letter(self, fold: Edge, proof: Proof) -> str:
        if not self.removed.isdisjoint(fold):
            return "F"
        if fold in proof.letters:
            return proof.letters[fold]
        # The fold lies in a merged triangle: along a side, or across it, where it is flat.
        i, j = fold
        first, second = self.merged.get(i), self.merged.get(j)
        if first and (second == first or j in first):
            return self._on_side(i, proof)
        if second and i in second:
            return self._on_side(j, proof)
        return "F"

    def _on_side(self, vertex: int, proof: Proof) -> str:
        """The letter of the side on which a merged vertex lies, "F" if it is inside a triangle."""
        side = self.merged[vertex]
        return "F" if side is None else proof.letters[side]


def _check_gauge(sheet: Sheet, heights: Heights, corner: int | None) -> None:
    if corner is not None:
        flat = all(heights[v] == 0 for v in sheet.boundary)
        require(flat, "the boundary vertices are not all at height 0")
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
        right = type(sign) is int and sign == expected
        require(right, f"vertex {v} does not have the claimed sign")


def _check_letters(place: Place, letters: Any, proof: Proof) -> None:
    folds = place.given.folds
    fits = isinstance(letters, str) and len(letters) == len(folds)
    require(fits, "the assignment does not have one letter for each fold")
    for fold, letter, expected in zip(folds, letters, place.letters(proof), strict=True):
        require(letter == expected or letter == "U", f"fold {fold} is not known to be {letter!a}")


def summary(claims: VerifiedBranch) -> str:
    """One line that states the verified claims."""
    signs = "".join("-0+"[s + 1] for s in claims["vertex_signs"])
    shown = signs if len(signs) <= 60 else signs[:60] + "..."
    decided = len(claims["assignment"]) - claims["assignment"].count("U")
    what = "solution over the boundary in the file" if claims["gauge"] == "rim" else "branch"
    if "curvature" in claims:
        what = "shape over the boundary in the file, with these angle deficits,"
    return (
        f"VALID: exactly one {what} has the vertex signs {shown} ({len(signs)}); "
        f"{decided} of {len(claims['assignment'])} letters decided; sha256 {claims['sha256']}"
    )


BRANCH = DocumentKind(
    format="exactfold branch",
    versions=(FLAT, CURVED, MERGED),
    names="format version pattern claims evidence",
    claims=VerifiedBranch,
    check=check,
    summary=summary,
)
"""One branch with given vertex signs (docs/branch.md)."""
