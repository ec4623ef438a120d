"""Driven folds, whose angles keep a ratio: equations between distances (docs/motion.md, 10).

Let g_k be half the change of the squared distance between the two vertices opposite to fold k. Then
g_k = -8 (A B / l^2) sin(a_k / 2)^2, where A and B are the areas of its faces, l is its length and
a_k is its angle. The angles reach given sizes on the way if they are at least as large at the end.

Near the flat state the equations say what docs/motion.md, 4 asks. Proof: the six distances of the
four vertices of two faces at a fold have one self-stress in the plane. So there are constants c_e
with U_k . u_k + h_k^2 / 2 = sum_e c_e (U_e . u_e + h_e^2 / 2) - 2 (A B / l^2) omega_k(h)^2 for all
u, h, with the five edges e of the two faces: the difference of the first two terms is a quadratic
form of the heights that does not see affine functions, so a multiple of omega_k^2, and the factor
is that of g_k. For (u', h') on which the derivatives of the lengths are 0 the equations therefore
say that omega_k(h) omega_k(h') / |q_k| is the same for all k, that is, omega_k(h') = mu omega_k(h)
for some mu and all k.
"""

from __future__ import annotations

from fractions import Fraction
from math import gcd, lcm
from typing import Any, TypedDict

from ..core.reading import items, keys, natural, parse_rational, require
from ..sheets.sheet import Edge, Sheet, turn
from .bounds import Vector
from .boxes import Boxes, volume_sign
from .chain import Chain
from .claims import BranchClaim, Document
from .equations import LengthEquations
from .restriction import Restriction, Sign
from .tubes import Ball


class DrivenFolds(TypedDict):
    """Driven folds, the ratio that they keep, and whether it is claimed that they reach angles."""

    folds: list[list[int]]
    squares: list[str]
    reached: bool


class DriveClaim(BranchClaim):
    """The curve leaves the flat state along a simple solution, with its driven folds as claimed.

    A driven fold is a valley or a mountain by the sign of its entry q of `squares`. All along, the
    values sin(a / 2)^2 of the angles a are in the ratio of |q|. If `reached` is true, these values
    are |q| or more at the end. The side of the ray is 1.
    """

    names = ("drive",)

    def restriction(self, given: Sheet, sheet: Sheet) -> PrescribedAngles:
        """The equations that keep the ratio."""
        self.drive = PrescribedAngles(sheet, self.claims["drive"])
        return self.drive

    def check(self, chain: Chain) -> None:
        """Refuse a motion that does not reach the angles, if it is claimed to reach them."""
        if self.drive.reached:
            back = "return" in self.claims
            require(
                not back, "a motion that returns to the flat state does not end at given angles"
            )
            check_reached(chain.equations, self.drive, chain.end)

    @staticmethod
    def said(claims: Document) -> str:
        """The driven folds and their ratio."""
        drive = claims["drive"]
        names = ", ".join(f"{i}-{j}" for i, j in drive["folds"])
        ratio = " : ".join(q.removeprefix("-") for q in drive["squares"])
        ways = ", ".join("mountain" if q.startswith("-") else "valley" for q in drive["squares"])
        reached = ", at least that at the end" if drive["reached"] else ""
        return (
            f", driven by the folds {names} ({ways}), sin^2 of half the angle as {ratio}{reached}"
        )


class PrescribedAngles(Restriction):
    """The driven folds and numbers q_k of a claim, and the equations that keep their ratio.

    The values sin(a_k / 2)^2 are in the ratio of |q_k| if and only if w_m g_k = w_k g_m with
    w_k = |q_k| A B / l^2. Each of `rows` is one equation: integers over 2^row_bits, one for each of
    the `diagonals` k.
    """

    def __init__(self, sheet: Sheet, claim: Any) -> None:
        super().__init__(sheet)
        keys(claim, "folds squares reached", "drive")
        require(type(claim["reached"]) is bool, "reached is not true or false")
        self.reached: bool = claim["reached"]
        number = len(sheet.boundary) - 3
        require(number > 1, "a single driven fold has no ratio")
        self.folds = _folds(sheet, items(claim["folds"], "driven folds", number))
        texts = items(claim["squares"], "squares", number)
        self.squares = [parse_rational(text) for text in texts]
        possible = all(0 < abs(q) <= 1 for q in self.squares)
        require(possible, "each of the squares must be from -1 to 1, and not 0")
        self.diagonals = [(sheet.next[i][j], sheet.next[j][i]) for i, j in self.folds]
        weights = [
            abs(q) * _areas_over_length(sheet, fold)
            for fold, q in zip(self.folds, self.squares, strict=True)
        ]
        most = self.most = weights.index(max(weights))
        self.weight = weights[most]
        rows = [_row(weights, k, most) for k in range(number) if k != most]
        self.row_bits = max(map(_length, rows), default=0)
        self.rows = [[c << self.row_bits - _length(row) for c in row] for row in rows]

    def side(self, sign: Sign) -> int:
        """1; raises unless all driven folds start as valleys or mountains as claimed."""
        for fold, q in zip(self.folds, self.squares, strict=True):
            right = sign(self.sheet.bend(fold)) * q > 0
            require(right, f"the driven fold {fold} may start to the other side")
        return 1


def _folds(sheet: Sheet, given: list[Any]) -> list[Edge]:
    """Read folds of a sheet; raises if one of them is named twice."""
    folds: list[Edge] = []
    for fold in given:
        i, j = (natural(v, "vertex") for v in items(fold, "fold", 2))
        folds.append((i, j))
    there = set(folds) <= set(sheet.folds) and len(set(folds)) == len(folds)
    require(there, "a driven fold is not a fold of the sheet, or is named twice")
    return folds


def _areas_over_length(sheet: Sheet, fold: Edge) -> Fraction:
    """4 A B / l^2 for a fold of length l between faces with the areas A and B."""
    i, j = fold
    a, b, c, d = (sheet.points[v] for v in (i, j, sheet.next[i][j], sheet.next[j][i]))
    square = (b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2
    return turn(a, b, c) * turn(b, a, d) / square


def _row(weights: list[Fraction], k: int, most: int) -> Vector:
    common = lcm(weights[k].denominator, weights[most].denominator)
    row = [0] * len(weights)
    row[k], row[most] = int(weights[most] * common), -int(weights[k] * common)
    divisor = gcd(*row)
    return [c // divisor for c in row]


def _length(row: Vector) -> int:
    return max(abs(c).bit_length() for c in row)


def check_reached(equations: LengthEquations, drive: PrescribedAngles, here: Ball) -> None:
    """Raise unless all driven folds are bent at least as far as claimed in the box `here`, the end.

    There g <= -2 w for one of them, and so for all of them, and they are valleys or mountains as
    claimed. So at some earlier time all these angles have exactly the claimed sizes. Nothing is
    said of the side to which the folds are bent at that time.
    """
    bits, k = equations.bits, len(equations.edges) + drive.most
    u, e = equations.flat[k], equations.along(here.centre)[k]
    (wide,) = equations.weight_sums(here.radii)[k : k + 1]
    g = sum(2 * a * x + x * x for a, x in zip(u, e, strict=True))
    g += sum((2 * abs(a) + 2 * abs(x) + r) * r for a, x, r in zip(u, e, wide, strict=True))
    beyond = Fraction(g, 2 << 2 * bits) * equations.unit**2 <= -2 * drive.weight
    require(beyond, "the driven folds are not proved to reach the sizes of their angles")
    boxes = _boxes(equations, here)
    for fold, pair, q in zip(drive.folds, drive.diagonals, drive.squares, strict=True):
        right = volume_sign(boxes, *fold, *pair) * q > 0
        require(right, f"the driven fold {fold} may end on the other side")


def _boxes(equations: LengthEquations, here: Ball) -> Boxes:
    """Boxes with the positions of all vertices, over 2^bits."""
    one = Fraction(1 << equations.bits) / equations.unit
    points, error = equations.sheet.points, max(here.radii) + 1
    x, y = points[equations.pinned[0]]
    boxes: Boxes = {}
    for v, (a, b) in points.items():
        at = [int((a - x) * one), int((b - y) * one), 0]
        if v in equations.place:
            k = equations.place[v]
            at = [p + d for p, d in zip(at, here.centre[k : k + 3], strict=True)]
        boxes[v] = at, at, error
    return boxes
