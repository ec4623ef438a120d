"""Certificates of bounds for the degrees of freedom of rigid panels (docs/panels.md, 6).

They are the largest dimension of a family of true motions near the flat sheet. The lower bound is
the dimension of a family in which some folds are held flat: a motion with letters is shown for each
part of the other folds (`panels_motion`), and true motions begin like it. A part with lines at its
vertices adds 1, and a part in which all conditions are independent adds the number of its folds
less that of its conditions. Folds from boundary to boundary add 1 each.

The upper bound: choose vertices of which no two share a fold, each with at least four folds. The
tangent cone at the flat state lies where the first-order conditions hold and the forms of the
chosen vertices vanish (docs/panels.md, 6). At such a vertex of n folds this leaves dimension n - 3,
as the form is not 0 where the two conditions hold. If the densities at all of them are given, those
of all other folds are given up to the kernel of the matrix of the first-order conditions at those
folds. So no family has a larger dimension than the number of folds that the flat closure leaves,
less 3 for each chosen vertex and less the rank of this matrix. A rank modulo a number is a lower
bound of the rank.

The evidence has `letters`, M, V or F for each fold: a motion in which folds with the letter F are
flat; this `motion`, as in certificates of letters (`panels`); the chosen vertices, `apart`; and a
`modulus` with `roots`, residues whose squares are those of the radicands modulo this number.
"""

from __future__ import annotations

from typing import Any, TypedDict

from ..core.kinds import DocumentKind
from ..core.reading import counted, items, keys, keys_of, natural, refusing, require, same
from ..core.towers import Number
from ..sheets.panels import Edge, Near, PanelSheet, connected, pair, read_panels
from .panels_motion import check_motion

Row = dict[int, int]


class FreedomClaims(TypedDict):
    """The claims of a file: bounds of the degrees of freedom."""

    least: int
    most: int


class VerifiedFreedom(FreedomClaims):
    """The verified claims, with numbers of the sheet and the digest of the pattern."""

    interior: int
    folds: int
    sha256: str


@refusing()
def check(data: dict[str, Any]) -> VerifiedFreedom:
    """Verify every claim of a loaded certificate; raises `CertificateError` at the first failure.

    Returns the claims, numbers of the sheet, and the SHA-256 of the pattern.
    """
    claims, evidence = data["claims"], data["evidence"]
    keys(claims, keys_of(FreedomClaims), "claims")
    sheet, digest = read_panels(data["pattern"])
    facts = bounds(sheet, evidence)
    require(same(claims["least"], facts["least"]), f"the lower bound is {facts['least']}")
    require(same(claims["most"], facts["most"]), f"the upper bound is {facts['most']}")
    inner, folds = len(sheet.interior), len(sheet.folds)
    return {"sha256": digest, "interior": inner, "folds": folds, **facts}


def bounds(sheet: PanelSheet, evidence: Any) -> FreedomClaims:
    """The bounds that the evidence shows."""
    keys(evidence, "letters motion apart modulus roots", "evidence")
    free = sum(sheet.boundary_set.issuperset(fold) for fold in sheet.folds)
    apart = [natural(v, "a vertex") for v in items(evidence["apart"], "apart")]
    residues = Residues(sheet, evidence["modulus"], evidence["roots"])
    return {
        "least": free + _family(sheet, evidence["letters"], evidence["motion"]),
        "most": free + _most(sheet.live([]), apart, residues),
    }


def _family(sheet: PanelSheet, text: Any, motion: Any) -> int:
    """The dimension of a family of true motions in which folds with the letter F are flat."""
    fits = isinstance(text, str) and len(text) == len(sheet.folds) and set(text) <= set("MVF")
    require(fits, "the letters are not one of M, V, F for each fold")
    wanted = dict(zip(sheet.folds, text, strict=True))
    near = sheet.live(fold for fold, letter in wanted.items() if letter == "F")
    check_motion(sheet, near, wanted, motion, true=True)
    total = 0
    for group, entry in zip(connected(near), motion, strict=True):
        folds = {pair(v, u) for v, around in group.items() for u in around}
        total += len(folds) - len(entry["unknowns"]) if "unknowns" in entry else 1
    return total


def _most(near: Near, apart: list[int], residues: Residues) -> int:
    """The upper bound, without folds from boundary to boundary."""
    folds = {pair(v, u) for v, around in near.items() for u in around}
    taken: set[Edge] = set()
    for v in apart:
        own = {pair(v, u) for u in near[v]}
        require(len(own) > 3, f"vertex {v} has fewer than four folds")
        require(taken.isdisjoint(own), f"vertex {v} shares a fold with another chosen vertex")
        taken |= own
    place = {fold: k for k, fold in enumerate(sorted(folds - taken))}
    rows = []
    for v, around in near.items():
        for axis in (0, 1):
            spokes = {u: residues.sheet.vector(v, u)[axis] for u in around}
            row = {
                place[pair(v, u)]: residues.of(x) for u, x in spokes.items() if pair(v, u) in place
            }
            rows.append({k: x for k, x in row.items() if x})
    return len(folds) - 3 * len(apart) - residues.rank(rows)


class Residues:
    """Residues of numbers of the field of a sheet, modulo a number that need not be a prime.

    `roots` has residues of the square roots. Their squares are the residues of the radicands, and
    so sums and products of numbers have the sums and products of their residues. A minor is not 0
    if its residue is not 0; the residues of pivots have inverses.
    """

    def __init__(self, sheet: PanelSheet, modulus: Any, roots: Any) -> None:
        self.sheet, self.modulus = sheet, natural(modulus, "the modulus")
        radicands = sheet.tower.radicands
        self.products = [1]
        for parts, given in zip(radicands, items(roots, "roots", len(radicands)), strict=True):
            root = natural(given, "a root")
            square = self._sum(parts)
            require((root * root - square) % self.modulus == 0, f"{root} is no root of {square}")
            self.products += [product * root % self.modulus for product in self.products]

    def of(self, value: Number) -> int:
        """The residue of a number; the denominators of its coefficients have to be invertible."""
        return self._sum(value.parts)

    def _sum(self, parts: Any) -> int:
        total = 0
        for c, product in zip(parts, self.products, strict=True):
            total += c.numerator * pow(c.denominator, -1, self.modulus) * product
        return total % self.modulus

    def rank(self, rows: list[Row]) -> int:
        """The number of pivots of an elimination, the shortest rows first."""
        left, rank = rows, 0
        while left := [row for row in left if row]:
            pivot = min(left, key=len)
            at = min(pivot)
            over = pow(pivot[at], -1, self.modulus)
            rank += 1
            left.remove(pivot)
            for row in left:
                if at in row:
                    self._minus(row, row[at] * over, pivot)
        return rank

    def _minus(self, row: Row, factor: int, other: Row) -> None:
        for k, x in other.items():
            value = (row.get(k, 0) - factor * x) % self.modulus
            if value:
                row[k] = value
            else:
                row.pop(k, None)


def summary(claims: VerifiedFreedom) -> str:
    """One line that states the verified claims."""
    least, most = claims["least"], claims["most"]
    degrees = f"{least}" if least == most else f"between {least} and {most}"
    size = counted(claims["folds"], "fold", "folds")
    inner = counted(claims["interior"], "interior vertex", "interior vertices")
    return (
        f"VALID: the degrees of freedom of the sheet of rigid panels with {size} and {inner} are "
        f"{degrees}; sha256 {claims['sha256']}"
    )


PANEL_FREEDOM = DocumentKind(
    format="exactfold freedom of panels",
    versions=(1,),
    names="format version pattern claims evidence",
    claims=VerifiedFreedom,
    check=check,
    summary=summary,
)
"""Bounds for the degrees of freedom of a sheet of rigid panels (docs/panels.md, 6)."""
