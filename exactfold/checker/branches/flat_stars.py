"""The vertex signs of all solutions in which the stars of given vertices are flat.

The unknowns are the densities of the folds that may bend, with the conditions of rigid panels. A
semidefinite form vanishes on its kernel only. The remaining space falls into parts that share no
fold, and a solution is a sum of solutions on parts (docs/any_border.md, How joints are decided).
On a part with m unknowns there are these cases:

- if all forms vanish, the solutions are one line;
- if the products of the forms with all monomials of some degree span all monomials of their own
  degree, modulo a prime, the only solution is 0;
- if there are m - 1 forms, and 2^(m-1) disjoint boxes in a chart hold one zero each, there are no
  other zeros, by refined Bezout;
- if a form has inertia (1, 1), it is a product of two linear factors, and the zeros of each factor
  are a part of their own;
- otherwise boxes show some solutions. If these have all signs of the vertices that may bend, no
  other solution joins more by a flip at a vertex that is flat in all of them.

Evidence that does not hold proves nothing, so that the claims that need it are refused.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from fractions import Fraction
from math import lcm
from typing import Any, NamedTuple

from ..core import limits
from ..core.intervals import Interval
from ..core.krawczyk import Krawczyk, inverse
from ..core.reading import CertificateError, items, keys, natural, parse_rational, require
from ..panels.motions import Motion, Space, folds_of
from ..panels.reduction import BITS
from ..panels.spaces import Spaces
from ..sheets.boxes import Box, check_disjoint, read_box
from ..sheets.panels import Edge, dot, pair
from .ranks import have_no_common_zero

MOST_UNKNOWNS = limits.PIECE_UNKNOWNS

Signs = dict[int, int]
"""The signs of vertices; a vertex that is left out is flat."""
Row = list[Fraction]
Matrix = list[Row]


class Found(NamedTuple):
    """The signs of solutions that are found.

    `closed` says that these are all solutions, apart from sums of solutions on different parts.
    """

    joints: list[Signs]
    closed: bool


@dataclass
class System:
    """Quadrics in the form that `Krawczyk` takes."""

    size: int
    quadrics: list[dict[tuple[int, int], int]]


def solutions(spaces: Spaces, space: Space, evidence: Sequence[Any]) -> Found:
    """The signs of the solutions in a space; the evidence gives boxes for some of its parts."""
    joints: list[Signs] = []
    closed = True
    for part in spaces.parts(space):
        result = _part(spaces, part, evidence)
        joints += result.joints
        closed = closed and result.closed
    return Found(joints, closed)


def _part(spaces: Spaces, part: Space, evidence: Sequence[Any]) -> Found:
    products, curved = [], []
    for v in sorted({v for fold in folds_of(part) for v in fold if v in spaces.near}):
        squares = spaces.squares(v, part)
        signs = [d.sign() for d, _ in squares]
        if signs and abs(sum(signs)) == len(signs):
            less = spaces.vanishing(part, [values for _, values in squares])
            return solutions(spaces, less, evidence)
        if signs:
            curved.append(v)
        if len(signs) == 2:
            products.append(squares)
    if not curved:
        return _line(spaces, part)
    joints: list[Signs] = []
    if all(x.tower.size == 1 for motion in part for x in motion.values()):
        forms = [_values(spaces, part, v) for v in curved]
        if have_no_common_zero(forms):
            return Found([], True)
        for entry in evidence:
            with suppress(ArithmeticError, CertificateError):
                found = _boxes(_Part(spaces, part, curved, forms, entry))
                if found.closed:
                    return found
                joints += found.joints
    closed = False
    if products:
        _, *both = spaces.factors(dict(enumerate(products)), part)
        split = [solutions(spaces, spaces.vanishing(part, [x]), evidence) for x in both]
        joints += [signs for found in split for signs in found.joints]
        closed = all(found.closed for found in split)
    return Found(joints, closed or _are_all(spaces, part, joints))


def _are_all(spaces: Spaces, part: Space, joints: list[Signs]) -> bool:
    """Whether the joints have all signs of the vertices that may bend.

    Other joints are not counted. Then any two sign vectors that differ only at a vertex that is
    held flat are joined.
    """
    touched = sorted({v for fold in folds_of(part) for v in fold if v in spaces.near})
    known = [signs for signs in joints if sorted(signs) == touched]
    seen = {tuple(turn * signs[v] for v in touched) for signs in known for turn in (1, -1)}
    return len(seen) == 1 << len(touched)


def _line(spaces: Spaces, part: Space) -> Found:
    """The solutions of a part on which all forms vanish.

    Such a part is isotropic for each Lorentzian form, so that it is one line.
    """
    enclosed = {fold: value.enclosed(BITS) for fold, value in part[0].items()}
    signs = signs_of(spaces, enclosed) if len(part) == 1 else None
    return Found([], False) if signs is None else Found([signs], True)


def signs_of(spaces: Spaces, densities: dict[Edge, Interval]) -> Signs | None:
    """The sign of -sum_e w_e L_e at each vertex with a bent fold; None if one sign is open."""
    signs = {}
    for v, around in spaces.near.items():
        total = Interval(0, 0, BITS)
        touched = False
        for u in around:
            if pair(v, u) in densities:
                spoke = spaces.sheet.vector(v, u)
                total = total - densities[pair(v, u)] * dot(spoke, spoke).enclosed(BITS).root()
                touched = True
        if touched:
            signs[v] = total.sign()
    return None if 0 in signs.values() else signs


def _values(spaces: Spaces, part: Space, v: int) -> Matrix:
    """The matrix of the form of a vertex in the basis of a rational part."""
    return [[spaces.form(v, a, b).parts[0] for b in part] for a in part]


class _Part:
    """A rational part, with the densities of the folds named by the evidence as coordinates."""

    def __init__(
        self, spaces: Spaces, part: Space, curved: list[int], forms: list[Matrix], entry: Any
    ) -> None:
        self.spaces, self.entry, self.count, self.size = spaces, entry, len(curved), len(part)
        folds = [tuple(fold) for fold in items(entry["folds"], "folds", self.size)]
        known = folds_of(part)
        basis = inverse([[_density(motion, fold) for motion in part] for fold in folds])
        self.rows = {
            fold: _times([[_density(motion, fold) for motion in part]], basis)[0] for fold in known
        }
        self.forms = [_times(_transposed(basis), _times(form, basis)) for form in forms]

    def system(self, lifted: Matrix) -> System:
        """The forms in terms of (x, 1), where the coordinates are `lifted` times (x, 1)."""
        quadrics = []
        for form in self.forms:
            matrix = _times(_transposed(lifted), _times(form, lifted))
            unit = lcm(*(x.denominator for row in matrix for x in row))
            quadrics.append(
                {
                    (i, j): int(x * unit)
                    for i, row in enumerate(matrix)
                    for j, x in enumerate(row)
                    if x
                }
            )
        return System(len(lifted[0]) - 1, quadrics)

    def signs(self, box: Box, lifted: Matrix) -> Signs | None:
        """The vertex signs of the solution in a box; None if one is open."""
        ends = [
            (Fraction(c - box.radius, 1 << box.bits), Fraction(c + box.radius, 1 << box.bits))
            for c in box.center
        ]
        ends.append((Fraction(1), Fraction(1)))
        densities = {}
        for fold, row in self.rows.items():
            weights = _times([row], lifted)[0]
            terms = [sorted((w * a, w * b)) for w, (a, b) in zip(weights, ends, strict=True)]
            low, high = (sum((t[k] for t in terms), Fraction(0)) for k in (0, 1))
            densities[fold] = Interval(
                Interval.of(low, BITS).low, Interval.of(high, BITS).high, BITS
            )
        return signs_of(self.spaces, densities)


def _boxes(part: _Part) -> Found:
    """The solutions that the boxes of the evidence show.

    With a "chart" they are all solutions of the part, with "points" only some of them: at each
    point some coordinates are fixed at given values.
    """
    entry, size = part.entry, part.size
    if "chart" in entry:
        keys(entry, "folds chart roots", "a part")
        require(part.count == size - 1, "the forms are not one less than the unknowns")
        require(size <= MOST_UNKNOWNS, f"a part has more than {MOST_UNKNOWNS} unknowns")
        chart = [parse_rational(c) for c in items(entry["chart"], "chart", size - 1)]
        lifted = [[Fraction(int(i == j)) for j in range(size)] for i in range(size - 1)]
        lifted.append([-c for c in chart] + [Fraction(1)])
        return Found(_all_zeros(part, lifted, items(entry["roots"], "roots")), True)
    keys(entry, "folds points", "a part")
    joints = []
    for point in items(entry["points"], "points"):
        keys(point, "free fixed root", "a point")
        free = [natural(k, "a coordinate") for k in items(point["free"], "free", part.count)]
        rest = [k for k in range(size) if k not in free]
        fixed = dict(zip(rest, map(parse_rational, items(point["fixed"], "fixed")), strict=True))
        lifted = [
            [*(Fraction(int(k == j)) for j in free), fixed.get(k, Fraction(0))] for k in range(size)
        ]
        box = read_box(point["root"], len(free))
        Krawczyk(part.system(lifted)).check(box.center, box.radius, box.bits)
        signs = part.signs(box, lifted)
        joints.append(_known(signs))
    return Found(joints, False)


def _all_zeros(part: _Part, lifted: Matrix, entries: list[Any]) -> list[Signs]:
    """The vertex signs of all real zeros, which 2^n disjoint boxes in C^n hold with the others."""
    system = part.system(lifted)
    both = _doubled(system)
    real: list[Box] = []
    other: list[Box] = []
    for entry in entries:
        length = len(items(entry["center"], "center"))
        box = read_box(entry, length)
        Krawczyk(system if length == system.size else both).check(box.center, box.radius, box.bits)
        (real if length == system.size else other).append(box)
        if length != system.size:
            apart = max(map(abs, box.center[system.size :])) > box.radius
            require(apart, "a box may hold a real zero")
    check_disjoint(real)
    check_disjoint(other)
    require(len(entries) == 1 << system.size, f"{len(entries)} zeros, not 2^{system.size}")
    return [_known(part.signs(box, lifted)) for box in real]


def _known(signs: Signs | None) -> Signs:
    if signs is None:
        raise CertificateError("the sign of a vertex is open")
    return signs


def _doubled(system: System) -> System:
    """The real and the imaginary parts of F(u + i v), as quadrics in (u, v)."""
    n = system.size
    quadrics = []
    for quadric in system.quadrics:
        real: dict[tuple[int, int], int] = {}
        imaginary: dict[tuple[int, int], int] = {}
        for (i, j), w in quadric.items():
            real[_at(i, n), _at(j, n)] = w
            if i < n and j < n:
                real[i + n, j + n] = -w
            if j < n:
                imaginary[_at(i, n), j + n] = w
            if i < n:
                imaginary[i + n, _at(j, n)] = w
        quadrics += [real, imaginary]
    return System(2 * n, quadrics)


def _at(k: int, n: int) -> int:
    """The index in (u, v, 1) of the real part of unknown k, or of the constant if k = n."""
    return 2 * n if k == n else k


def _density(motion: Motion, fold: Any) -> Fraction:
    return motion[fold].parts[0] if fold in motion else Fraction(0)


def _times(a: Iterable[Row], b: Matrix) -> Matrix:
    columns = list(zip(*b, strict=True))
    return [
        [sum((x * y for x, y in zip(row, c, strict=True) if x and y), Fraction(0)) for c in columns]
        for row in a
    ]


def _transposed(a: Matrix) -> Matrix:
    return [list(row) for row in zip(*a, strict=True)]
