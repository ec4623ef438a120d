"""A vertex with four folds between rigid panels: its modes, and its motions at all fold angles.

The quaternion 1 + tau d, with tau = tan(angle / 2) / length, turns space about a fold along d. It
has real part 1 and the vector part tau (d_1, d_2, 0); all identities hold for any vectors d_1, ...,
d_4 of the plane.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from functools import lru_cache
from itertools import combinations
from pathlib import Path
from typing import Any

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from sympy import QQ
from sympy.polys.rings import ring

from exactfold.exact.linalg import Inertia, inertia_by_elimination, nullspace
from proofs.framework import Proof, Script, run

NAME = "panels"
TITLE = "Rigid panels: the modes and the transmissions of a vertex with four folds"
HYPOTHESES = (
    "d_1, ..., d_4: the vectors along four folds in counter-clockwise order, "
    "c_ij = [d_i, d_j], s_ij = d_i . d_j",
    "where a sign is claimed: all sectors between neighbouring folds less than pi, so that c_12, "
    "c_23, c_34, c_41 > 0",
)
Quaternion = tuple[Any, Any, Any, Any]
Vector = tuple[Any, Any]


def prove(change: str | None = None) -> Proof:
    """Prove the identities of docs/panels.md, sections 1 to 3."""
    script = Script(NAME, TITLE, HYPOTHESES, change)
    script.state(
        "T.51",
        "docs/panels.md, 3 (the first transmission)",
        r"c_{41}c_{13}x^2+2c_{23}c_{41}xy-c_{23}c_{24}y^2=Qx^2y^2,\ "
        r"Q=c_{12}(c_{34}s_{12}+c_{12}s_{34})",
        note="on all configurations near the flat one; Q = 0 iff opposite sectors add up to pi",
        code="Transmission",
    )
    script.state(
        "T.52",
        "docs/panels.md, 3 (the second transmission)",
        r"c_{12}c_{41}x^2(1+|d_3|^2z^2)=c_{23}c_{34}z^2(1+|d_1|^2x^2)",
        note="linear iff the vertex can be folded flat or the two folds are in one line",
        code="Transmission",
    )
    script.state(
        "T.53",
        "docs/panels.md, 2 (the local modes)",
        r"w_3/w_1=\pm\sqrt P/(c_{23}c_{34}),\ P=c_{12}c_{23}c_{34}c_{41}",
        code="local_modes",
    )
    script.state(
        "T.54",
        "docs/panels.md, 1 (inertia)",
        r"\text{on the local motions: }(1,N-3,0),\ (0,N-3,1)\text{ or }(0,N-2,0)",
        note="folds not all on one line: all sectors below pi, one of pi, one above; proved for "
        "triangles in C.1 and C.8. One fold has no local motion but 0, a straight pair one line of "
        "them, with K = 0",
        code="Star.foldable",
        rests="C.11",
    )
    _closing(script)
    _neighbours(script)
    _opposite(script)
    _flat_foldable(script)
    _modes(script)
    _inertia(script)
    return script.proof()


@lru_cache(maxsize=1)
def _symbols() -> tuple[Any, ...]:
    names = "p1,q1,p2,q2,p3,q3,p4,q4,x,y,z,w,l,e"
    return tuple(ring(names, QQ)[1:])


def _directions() -> tuple[Vector, Vector, Vector, Vector]:
    p1, q1, p2, q2, p3, q3, p4, q4, *_ = _symbols()
    return (p1, q1), (p2, q2), (p3, q3), (p4, q4)


def c(i: int, j: int) -> Any:
    """The bracket [d_i, d_j]."""
    a, b = _directions()[i - 1], _directions()[j - 1]
    return a[0] * b[1] - a[1] * b[0]


def s(i: int, j: int) -> Any:
    """The scalar product d_i . d_j."""
    a, b = _directions()[i - 1], _directions()[j - 1]
    return a[0] * b[0] + a[1] * b[1]


def turn(tau: Any, d: Vector) -> Quaternion:
    """The quaternion 1 + tau d."""
    return 1 + 0 * tau, tau * d[0], tau * d[1], 0 * tau


def times(a: Quaternion, b: Quaternion) -> Quaternion:
    """The product of two quaternions."""
    return (
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    )


def conjugate(a: Quaternion) -> Quaternion:
    """The quaternion with its vector part reversed."""
    return a[0], -a[1], -a[2], -a[3]


def _halves() -> tuple[Quaternion, Quaternion]:
    """The two halves (1 + x d_1)(1 + y d_2) and (1 + z d_3)(1 + w d_4) of the closing condition."""
    x, y, z, w = _symbols()[8:12]
    d1, d2, d3, d4 = _directions()
    return times(turn(x, d1), turn(y, d2)), times(turn(z, d3), turn(w, d4))


def _closing(script: Script) -> None:
    """The closing condition: its lowest orders, and as an equation between two halves."""
    x, y, z, w = _symbols()[8:12]
    a, b = _halves()
    whole = times(a, b)
    taus = (x, y, z, w)
    factor = script.alter("K_v with all signs equal", 1, -1)

    def part(polynomial: Any, degree: int) -> Any:
        """The terms of one degree in x, y, z, w."""
        kept = {m: k for m, k in polynomial.terms() if sum(m[8:12]) == degree}
        return polynomial.ring.from_dict(kept)

    for axis in (1, 2):
        script.identity(
            f"to first order, the closing condition along axis {axis} is sum_j tau_j d_j = 0",
            part(whole[axis], 1)
            - script.alter(f"axis {axis} reversed", 1, -1)
            * sum(t * d[axis - 1] for t, d in zip(taus, _directions(), strict=True)),
            of="T.54",
        )
    form = c(1, 2) * x * y + factor * sum(
        taus[i - 1] * taus[j - 1] * c(i, j) for i, j in combinations(range(1, 5), 2) if j > 2
    )
    script.identity(
        "its third component has no linear part, and to second order it is K_v",
        part(whole[3], 1),
        part(whole[3], 2) - form,
        of="T.54",
    )
    other = b if script.alter("the second half not reversed", False, True) else conjugate(b)
    norm = sum(entry * entry for entry in b)
    script.identity(
        "A B is real iff A is a multiple of the conjugate of B: A |B|^2 = (A B) B*",
        *(p * norm - q for p, q in zip(a, times(whole, other), strict=True)),
        of="T.51",
    )


def q_factor(wrong: bool = False) -> Any:
    """The number Q of docs/panels.md, 3."""
    return c(1, 2) * (c(3, 4) * s(1, 2) + (-1 if wrong else 1) * c(1, 2) * s(3, 4))


def _neighbours(script: Script) -> None:
    """The first transmission follows from the four components of A = l B*, with polynomial
    cofactors."""
    x, y, z, w, l = _symbols()[8:13]  # noqa: E741
    a, b = _halves()
    gap = tuple(p - l * q for p, q in zip(a, conjugate(b), strict=True))
    plane = gap[1:3]
    d3, d4 = _directions()[2:]

    def cross(u: Sequence[Any], v: Sequence[Any]) -> Any:
        return u[0] * v[1] - u[1] * v[0]

    e1, e2 = cross(plane, d4), cross(d3, plane)
    script.identity(
        "A = l B*: brackets with d_4 and d_3 give z and w in terms of x, y and l",
        e1 - (l * z * c(3, 4) - x * c(4, 1) + y * c(2, 4)),
        e2
        - (l * w * c(3, 4) - script.alter("wrong sign of c_13", 1, -1) * x * c(1, 3))
        - -y * c(2, 3),
        of="T.51",
    )
    e3, e4 = gap[3], gap[0]
    area = x * y * c(1, 2)
    first, second = c(4, 1) * x - c(2, 4) * y, c(1, 3) * x + c(2, 3) * y
    combination = (
        c(3, 4) * l * e3
        - (s(3, 4) * e3 - c(3, 4) * e4) * area
        - e1 * e2
        - script.alter("one cofactor doubled", 1, 2) * e1 * second
        - e2 * first
    )
    transmission = (
        c(4, 1) * c(1, 3) * x**2
        + script.alter("c_23 c_41 x y once", 2, 1) * c(2, 3) * c(4, 1) * x * y
        - c(2, 3) * c(2, 4) * y**2
        - q_factor(script.alter("wrong sign in Q", False, True)) * x**2 * y**2
    )
    script.identity(
        "the first transmission is a combination of the four components of A - l B*",
        combination - transmission,
        of="T.51",
    )


def _opposite(script: Script) -> None:
    """The second transmission: (1 + x d_1)(1 + y d_2)(1 + z d_3) is a multiple of 1 - w d_4."""
    x, y, z = _symbols()[8:11]
    d1, d2, d3, d4 = _directions()
    three = times(times(turn(x, d1), turn(y, d2)), turn(z, d3))
    beside = three[1] * d4[1] - three[2] * d4[0]
    third = three[3]
    inner = c(3, 4) * s(1, 2) + c(1, 2) * s(3, 4)  # Q / c_12
    script.identity(
        "the part of three turns across d_4, and their third component",
        beside
        - (c(2, 4) * y + c(3, 4) * z - c(4, 1) * x)
        - script.alter("the cubic term reversed", -1, 1) * inner * x * y * z,
        third - y * (c(1, 2) * x + c(2, 3) * z) - x * z * c(1, 3),
        of="T.52",
    )
    near, far = c(1, 2) * c(4, 1), c(2, 3) * c(3, 4)
    if script.alter("d_1 and d_3 exchanged", False, True):
        near, far = far, near
    transmission = near * x**2 * (1 + s(3, 3) * z**2) - far * z**2 * (1 + s(1, 1) * x**2)
    script.identity(
        "the second transmission is a combination of these two",
        (c(2, 4) - inner * x * z) * third - (c(1, 2) * x + c(2, 3) * z) * beside - transmission,
        of="T.52",
    )
    script.identity(
        "between opposite folds the cubic coefficient is c_13 Q / c_12: it is linear iff Q = 0 or "
        "the folds are in one line",
        far * s(1, 1) - near * s(3, 3) - c(1, 3) * inner,
        of="T.51 T.52",
    )


def _flat_foldable(script: Script) -> None:
    """Q / c_12 is |d_1| |d_2| |d_3| |d_4| times the sine of the sum of two opposite sectors."""
    sign = script.alter("the difference of the sectors", 1, -1)

    def sector(i: int, j: int, side: int = 1) -> tuple[Any, Any]:
        """The cosine and the sine of the angle from d_i to d_j, times both lengths."""
        return s(i, j), side * c(i, j)

    def added(a: tuple[Any, Any], b: tuple[Any, Any]) -> tuple[Any, Any]:
        return a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]

    opposite = added(sector(1, 2), sector(3, 4, sign))
    others = added(sector(2, 3), sector(4, 1))
    lengths = s(1, 1) * s(2, 2) * s(3, 3) * s(4, 4)
    around = added(opposite, others)
    script.identity(
        "Q = c_12 |d_1| |d_2| |d_3| |d_4| sin(sector 12 + sector 34), so that Q = 0 iff these two "
        "add up to pi (Kawasaki)",
        q_factor() - c(1, 2) * opposite[1],
        of="T.51",
    )
    script.identity(
        "the four sectors add up to a full turn", around[0] - lengths, around[1], of="T.51"
    )


def _modes(script: Script) -> None:
    """The local modes (docs/panels.md, 2), multiplied by c_23 c_34 c_24; e stands for sqrt P."""
    e = _symbols()[13]
    scale = c(2, 3) * c(3, 4) * c(2, 4)
    root = script.alter("the sign of the root in w_4", 1, -1)
    values = (
        scale,
        c(3, 4) * (c(2, 3) * c(4, 1) - e),
        c(2, 4) * e,
        c(2, 3) * (c(1, 2) * c(3, 4) - root * e),
    )
    product = c(1, 2) * c(2, 3) * c(3, 4) * c(4, 1)

    def reduced(polynomial: Any) -> Any:
        """The expression after e^2 is replaced by P."""
        total = 0 * e
        for m, k in polynomial.terms():
            rest = polynomial.ring.from_dict({(*m[:13], m[13] % 2): k})
            total = total + rest * product ** (m[13] // 2)
        return total

    script.identity(
        "the local modes are first-order motions",
        *(
            reduced(sum(v * d[axis] for v, d in zip(values, _directions(), strict=True)))
            for axis in (0, 1)
        ),
        of="T.53",
    )
    pairs = list(combinations(range(1, 5), 2))
    sign = script.alter("[d_2, d_3] reversed in K_v", 1, -1)
    script.identity(
        "K_v vanishes on them",
        reduced(
            sum(
                (sign if (i, j) == (2, 3) else 1) * values[i - 1] * values[j - 1] * c(i, j)
                for i, j in pairs
            )
        ),
        of="T.53",
    )
    first = (0 * e, c(3, 4), -c(2, 4), c(2, 3))
    second = (c(3, 4), 0 * e, c(4, 1), c(1, 3))

    def bilinear(a: Sequence[Any], b: Sequence[Any]) -> Any:
        return sum((a[i - 1] * b[j - 1] + a[j - 1] * b[i - 1]) * c(i, j) for i, j in pairs)

    form = bilinear(first, second) ** 2 - bilinear(first, first) * bilinear(second, second)
    script.identity(
        "the discriminant of K_v on the plane of motions is 4 c_34^2 P > 0: two real lines",
        form - script.alter("discriminant without 4", 4, 1) * c(3, 4) ** 2 * product,
        of="T.53",
    )


def _inertia(script: Script) -> None:
    """Inertia on the local motions of rational stars, with sectors below, at and above pi."""
    swapped = script.alter("positive and negative exchanged", False, True)

    def found(star: Sequence[tuple[int, int]]) -> Inertia:
        """The inertia of K_v on the densities with sum w_j d_j = 0."""
        pairs = list(combinations(range(len(star)), 2))
        cross = {(i, j): star[i][0] * star[j][1] - star[i][1] * star[j][0] for i, j in pairs}
        basis = nullspace([[Fraction(d[axis]) for d in star] for axis in (0, 1)])
        matrix = [
            [sum((a[m] * b[n] + a[n] * b[m]) * cross[m, n] for m, n in pairs) for b in basis]
            for a in basis
        ]
        return inertia_by_elimination(matrix)

    def stars(case: str) -> Iterator[list[tuple[int, int]]]:
        circle = [(4, 0), (3, 2), (2, 3), (-1, 3), (-3, 2), (-4, 0), (-3, -2), (0, -5), (2, -2)]
        for count in (1, 2, 3, 4, 5, 6):
            for star in combinations(circle, count):
                turns = [
                    (a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1])
                    for a, b in zip(star, (*star[1:], star[0]), strict=True)
                ]
                if not any(t for t, _ in turns):
                    kind = "line"
                elif any(t < 0 for t, _ in turns):
                    kind = "above"
                else:
                    kind = "straight" if any(t == 0 and d < 0 for t, d in turns) else "below"
                if kind == case:
                    yield list(star)

    zero_on_a_line = script.alter("as many motions on one line", -1, -2)
    expected: dict[str, Callable[[int], Inertia]] = {
        "below": lambda n: (1, n - 3, 0),
        "straight": lambda n: (0, n - 3, 1),
        "above": lambda n: (0, n - 2, 0),
        "line": lambda n: (0, 0, n + zero_on_a_line),
    }
    texts = {
        "below": "all sectors below pi",
        "straight": "one of pi",
        "above": "one above pi",
        "line": "one fold, or a straight pair",
    }

    def agree(case: str) -> Iterator[bool]:
        for star in stars(case):
            up, down, zero = expected[case](len(star))
            yield found(star) == ((down, up, zero) if swapped else (up, down, zero))

    for case, text in texts.items():
        script.cases(f"the inertia of K_v on the local motions, {text}", agree(case), of="T.54")


if __name__ == "__main__":
    sys.exit(run(prove()))
