"""Certificates of torques that drive a triangulated sheet along one branch (docs/actuation.md, 2).

The claims are about a sheet with four boundary vertices on which `branches` is 2^n, with n vertices
that can pop, and all are real and simple:

- `sha256`: the digest of the pattern;
- `vertex_signs`, `assignment`: those of the ray that is driven, as in a listing (`listing`);
- `self_foldable`: "proved" if some torques do work on this branch and on no other, "refuted" if
  none do; "undecided" claims nothing;
- `torques`, `limit`, `creases`, `margin`, `bound`: as in `panels.torques`, with all other rays as
  rivals.

The evidence has `count`, the evidence of kind "isolated" of a listing, with a box for each branch;
`branch`, the number of the branch, and `side`, 1 for the ray in its box, else -1; and `rays`, each
[number, side, weight], with weights that are not negative and add up to 1.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any, TypedDict

from ..core import limits
from ..core.intervals import Interval
from ..core.kinds import DocumentKind
from ..core.reading import (
    at_most,
    counted,
    items,
    keys,
    keys_of,
    natural,
    refusing,
    require,
    same,
    shown,
    text_of,
)
from ..panels.reduction import BITS, reduced
from ..panels.unit_motions import Torques, Vector, plus, power, weight_of
from ..sheets.boxes import Box, check_isolated
from ..sheets.equations import BranchSystem, read_chart
from ..sheets.sheet import Edge, Sheet, read_sheet
from ..sheets.stress import check_triangles
from .listing import agrees, digit

MOST_RAYS = limits.TORQUE_RAYS


class BranchTorqueClaims(TypedDict):
    """The claims of a file."""

    sha256: str
    branches: int
    vertex_signs: str
    assignment: str
    self_foldable: str
    torques: list[str]
    limit: str
    creases: int | None
    margin: str
    bound: str


class BranchTorqueEvidence(TypedDict):
    """The evidence of a file."""

    count: Any
    branch: int
    side: int
    rays: list[list[Any]]


@refusing()
def check(data: dict[str, Any]) -> BranchTorqueClaims:
    """Verify every claim of a certificate; raises `CertificateError` at the first failure."""
    claims, evidence = data["claims"], data["evidence"]
    keys(claims, keys_of(BranchTorqueClaims), "claims")
    keys(evidence, keys_of(BranchTorqueEvidence), "evidence")
    sheet, digest = read_sheet(data["pattern"])
    require(claims["sha256"] == digest, f"the digest of the pattern is {digest}")
    driven = _Driven(sheet, claims, evidence)
    driven.check_names()
    driven.check_margin()
    driven.check_bound()
    driven.check_self_foldable()
    proved: BranchTorqueClaims = claims
    return proved


class _Driven:
    """The ray that is driven, its rivals, and the torques of a file."""

    def __init__(
        self, sheet: Sheet, claims: BranchTorqueClaims, evidence: BranchTorqueEvidence
    ) -> None:
        self.sheet, self.claims, self.evidence = sheet, claims, evidence
        count = evidence["count"]
        require(isinstance(count, dict), "the count is not an object")
        require(count.get("kind") == "isolated", "the branches are not isolated by boxes")
        emptied = check_triangles(sheet, count.get("triangles"))
        four = len(sheet.boundary) == 4 and emptied.interior
        require(four, "the sheet has not four boundary vertices and a vertex that can pop")
        self.system = BranchSystem(emptied, read_chart(count.get("chart")))
        roots = check_isolated(self.system, count)
        self.boxes = [root for root, _ in roots if isinstance(root, Box)]
        require(same(claims["branches"], len(self.boxes)), f"there are {len(self.boxes)} branches")
        self.place = natural(evidence["branch"], "branch")
        require(self.place < len(self.boxes), f"there is no branch {self.place}")
        self.side = _side(evidence["side"])
        lengths = {fold: _length(emptied, fold) for fold in emptied.folds}
        rows = {fold: _density_row(self.system, fold) for fold in emptied.folds}
        self.units = [_unit(box, rows, lengths) for box in self.boxes]
        self.target = _turned(self.units[self.place], self.side)
        self.torques = Torques(sheet.folds, claims)

    def check_names(self) -> None:
        """Refuse signs and letters that the ray does not have."""
        box, emptied = self.boxes[self.place], self.system.sheet
        at = {v: box.sign(self.system.row(emptied.sign_of_vertex(v))) for v in emptied.interior}
        signs = "".join("-0+?"[1 + self._digit(at.get(v, 0))] for v in self.sheet.interior)
        bent = {fold: box.sign(self.system.row(emptied.bend(fold))) for fold in emptied.folds}
        letters = "".join("MFVU"[1 + self._digit(bent.get(f, 0))] for f in self.sheet.folds)
        require(self.claims["vertex_signs"] == signs, f"the vertex signs of the ray are {signs}")
        right = agrees(text_of(self.claims["assignment"]), letters)
        require(right, f"the letters on the ray are {letters}")

    def _digit(self, sign: int | None) -> int:
        return digit(None if sign is None else sign * self.side)

    def check_margin(self) -> None:
        """Refuse a margin that some rival contradicts."""
        powers = [power(unit, self.torques.by_fold) for unit in self.units]
        target = power(self.target, self.torques.by_fold)
        others = [max(p.high, -p.low) for k, p in enumerate(powers) if k != self.place]
        self.torques.check_margin(target, max(-target.low, *others))

    def check_bound(self) -> None:
        """Refuse a bound that the weights do not prove."""
        rays = items(self.evidence["rays"], "rays")
        at_most(len(rays), MOST_RAYS, "the rays", "TORQUE_RAYS")
        gap, total = dict(self.target), Fraction(0)
        for entry in rays:
            number, side, text = items(entry, "a ray", 3)
            place = natural(number, "branch")
            require(place < len(self.units), f"there is no branch {place}")
            rival = (place, _side(side)) != (self.place, self.side)
            require(rival, "a ray is the one that is driven")
            weight = weight_of(text)
            total += weight
            gap = plus(gap, Interval.of(-weight * side, BITS), self.units[place])
        self.torques.check_bound(gap, total)

    def check_self_foldable(self) -> None:
        """Refuse a verdict that the ranks do not show."""
        others = [unit for k, unit in enumerate(self.units) if k != self.place]
        rank = len(reduced(others))
        all_independent = rank == len(others) and len(reduced(self.units)) > rank
        shows = {
            "undecided": True,
            "refuted": rank == self.system.size + 1,
            "proved": all_independent,
        }
        said = text_of(self.claims["self_foldable"])
        require(shows.get(said), f"the ranks do not show that self-foldable is {said}")


def _side(side: Any) -> int:
    require(type(side) is int and side in (1, -1), "a side is neither 1 nor -1")
    return int(side)


def _turned(unit: Vector, side: int) -> Vector:
    return unit if side > 0 else {fold: -x for fold, x in unit.items()}


def _length(sheet: Sheet, fold: Edge) -> Interval:
    (ax, ay), (bx, by) = (sheet.points[v] for v in fold)
    return Interval.of((bx - ax) ** 2 + (by - ay) ** 2, BITS).root()


def _density_row(system: BranchSystem, fold: Edge) -> list[Fraction]:
    """The fold angle divided by the length, as a function of the unknowns (x, 1)."""
    sheet = system.sheet
    bend = sheet.bend(fold)
    i, j = fold
    over = bend[sheet.next[i][j]] * bend[sheet.next[j][i]]
    row = [Fraction(0)] * (system.size + 1)
    for v, weight in bend.items():
        for place, x in system.lifts[v].items():
            row[place] += weight * x / over
    return row


def _unit(box: Box, rows: dict[Edge, list[Fraction]], lengths: dict[Edge, Interval]) -> Vector:
    """The unit vector of fold angles on the ray in a box."""
    angles: Vector = {}
    for fold, row in rows.items():
        value = row[-1] + sum(
            (c * m for c, m in zip(row, box.center, strict=False)), Fraction(0)
        ) / (1 << box.bits)
        reach = sum(map(abs, row[:-1]), Fraction(0)) * box.radius / (1 << box.bits)
        low, high = Interval.of(value - reach, BITS), Interval.of(value + reach, BITS)
        angles[fold] = low.joined(high) * lengths[fold]
    squares = (angle * angle for angle in angles.values())
    norm = sum(squares, start=Interval.of(Fraction(0), BITS)).root()
    return {fold: angle / norm for fold, angle in angles.items()}


def summary(claims: BranchTorqueClaims) -> str:
    """One line that states the verified claims."""
    others = counted(claims["branches"] - 1, "other branch", "other branches")
    most = "" if claims["creases"] is None else f" on at most {claims['creases']} folds"
    alone = {
        "proved": "; the branch is self-foldable",
        "refuted": "; the branch is not self-foldable",
    }.get(claims["self_foldable"], "")
    return (
        f"VALID: on the ray {claims['vertex_signs']} the torques have at least "
        f"{shown(claims['margin'])} more power than on every ray of the {others}; no torques of "
        f"size at most {shown(claims['limit'])}{most} have more than "
        f"{shown(claims['bound'], up=True)}{alone}; sha256 {claims['sha256']}"
    )


BRANCH_TORQUES = DocumentKind(
    format="exactfold torques",
    named="branch-torques",
    versions=(1,),
    names="format version kind pattern claims evidence",
    claims=BranchTorqueClaims,
    check=check,
    summary=summary,
)
"""Torques that drive a triangulated sheet along one branch (docs/actuation.md)."""
