"""Eigenvalues of the form of one vertex: equal angles, all angles, and what follows.

Appendix C from the Toeplitz matrix on, and Section II B on the matrix Q_nm and its null cone.
"""

from __future__ import annotations

import sys
from fractions import Fraction
from pathlib import Path
from typing import Any

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from exactfold import CreasePattern
from exactfold.exact.linalg import inertia, rank
from exactfold.pattern.families import single_vertex
from exactfold.rigidity import curvature_form, rigidity_matrix, wheel_stress
from exactfold.rigidity.kapovich_millson import kapovich_millson
from proofs.framework import Proof, Script, run
from proofs.spokes import equal_angles
from proofs.statements import Severity
from proofs.vertex_forms import cross, dot, symbols, unit
from proofs.wheel_stress import free_wheel

NAME = "vertex_eigenvalues"
TITLE = "Eigenvalues of the form of one vertex, and its null cone"
HYPOTHESES = (
    "a flat vertex of degree N >= 3, all angles in (0, pi) with sum 2 pi, spokes of any lengths",
    "equal angles and lengths for C.8 to C.10 only",
)


def prove(change: str | None = None) -> Proof:
    """Prove the eigenvalue formulas with their ranges, the inertia, and the null cone."""
    script = Script(NAME, TITLE, HYPOTHESES, change)
    _equal_angles(script)
    _all_angles(script)
    _signature(script)
    _three_folds(script)
    _cone(script)
    return script.proof()


def _equal_angles(script: Script) -> None:
    phi, theta, f, g = symbols("phi theta f g")
    (cn, sn), (c1, s1) = unit(phi), unit(theta)  # phi: the angle n theta, free
    sign = script.alter("sign of the cosine", 1, -1)
    script.identity(
        "v_n = sin(n theta) satisfies g v_{n-1} + f v_n + g v_{n+1} = (f + 2 g cos theta) v_n",
        g * (sn * c1 - cn * s1) + f * sn + g * (sn * c1 + cn * s1) - (f + 2 * sign * g * c1) * sn,
        of="C.8 C.9",
    )
    last = script.alter("range of m as printed", 0, 1)
    cosines = [Fraction(1, 2), Fraction(-1, 2), Fraction(-1)]  # of m pi/3, m = 1, 2, 3
    sign = script.alter("plus for minus", -1, 1)
    rows = kapovich_millson([(1, 0), (0, 1), (-1, 0), (0, -1)]).form.matrix[2:4]
    script.example(
        "v_0 = 0 always and v_{N-1} = 0 at theta = m pi/(N-1); m = 1, ..., N-2 gives N-2 "
        "different cosines, so these are all eigenvalues of the N-2 rows. For N = 4 and L = 1 the "
        "matrix is [[0, -1], [-1, 0]], and lambda_1 = -1, lambda_2 = 1 (numbered with minus signs)",
        [list(row[2:4]) for row in rows] == [[0, -1], [-1, 0]]
        and [sign * 2 * c for c in cosines[: 2 + last]] == [-1, 1],
        of="C.8",
    )
    script.formula(
        "C.8",
        "Appendix C, eigenvalues of the Toeplitz matrix",
        r"\lambda_m=f+2|g|\cos(\frac{m\pi}{N-1}),\quad m=1,\dots,N-1",
        r"\lambda_m=f-2|g|\cos(\frac{m\pi}{N-1}),\quad m=1,\dots,N-2",
        quoted=r"\lambda_m=f+2|g|\cos(\frac{m\pi}{N-1})\text{ ``for }m\text{ ranging from }1"
        r"\text{ to }N-1\text{''}",
        at=map(equal_angles, (3, 4, 5, 6)),
        note="range: the matrix has N-2 rows; m = N-1 is no eigenvalue (N = 4, L = 1: -2 or 2 "
        "besides 1 and -1). Label: with the plus sign lambda_m is the lambda_{N-1-m} of Eq. "
        "(equalangleeigs), which does not follow then, nor that lambda_1 is the negative one "
        "(C.10); the set of eigenvalues is the same",
        equation="C7",
        severity=Severity.CONSTANT,
    )
    script.formula(
        "C.9",
        "Appendix C, Eq. (equalangleeigs)",
        r"\lambda_m=2\frac{\csc(2\pi/N)}{L^2}\left[\cos(\frac{2\pi}{N})-\cos("
        r"\frac{m\pi}{N-1})\right],\quad m=1,\dots,N-1",
        r"\lambda_m=2\frac{\csc(2\pi/N)}{L^2}\left[\cos(\frac{2\pi}{N})-\cos("
        r"\frac{m\pi}{N-1})\right],\quad m=1,\dots,N-2",
        at=map(equal_angles, (3, 4, 5, 6)),
        quoted=r"\text{``for }m\text{ ranging from }1\text{ to }N-1\text{'' \dots\ }"
        r"\lambda_m=2\frac{\csc(2\pi/N)}{L^2}\left[\cos(\frac{2\pi}{N})-\cos("
        r"\frac{m\pi}{N-1})\right]",
        note="the range is that of C.8, and too large by one. "
        "Remark: it follows from C.8 as corrected: "
        "the printed line before it would give cos(2 pi/N) + cos(m pi/(N-1))",
        equation="C8",
        severity=Severity.CONSTANT,
    )
    k, j = symbols("k j")  # N = 3 + k, m = 2 + j with k, j >= 0
    N, m = k + 3, 2 + script.alter("m from 1", j, j - 1)
    script.certificate(
        "1/(N-1) < 2/N and m/(N-1) > 2/N for m >= 2: both differences, cleared of denominators, "
        "have positive coefficients in N - 3 >= 0 and m - 2 >= 0; cosine decreases on [0, pi]",
        _positive_coefficients(2 * (N - 1) - N) and _positive_coefficients(m * N - 2 * (N - 1)),
        of="C.10",
    )
    script.state(
        "C.10",
        "Appendix C, after Eq. (equalangleeigs)",
        r"\lambda_1<0\text{ and the other eigenvalues are positive}",
        note="with Eq. (equalangleeigs), m = 1, ..., N-2; with the line before it, it would be "
        "lambda_{N-2}",
        equation="C8",
        rests="C.9",
    )


def _positive_coefficients(polynomial: Any) -> bool:
    return polynomial.denom == 1 and all(c > 0 for c in polynomial.numer.coeffs())


def _all_angles(script: Script) -> None:
    positive = script.alter("inertia of the form of Appendix C", 1, 0)
    script.example(
        "chi(N) c_1...c_{N-1} = d_1 x d_N = -c_N: with all c_n > 0 chi(N) is negative everywhere "
        "on a connected set (angles: a simplex; lengths: an orthant), so the one negative "
        "eigenvalue of the equal angles (C.10) remains one; library inertia of K_v for N = 3 to 9",
        all(
            curvature_form(single_vertex(n), n).inertia == (positive, n - 2 - positive, 3)
            for n in range(3, 10)
        ),
        of="C.11",
    )
    script.state(
        "C.11",
        "Appendix C, after Eq. (equalangleeigs)",
        r"\text{``there is always one negative eigenvalue so long as the angles between any "
        r"pair of adjacent folds remain between 0 and }\pi\text{. When }N\geq4\text{ there "
        r"are thus eigenvalues of both signs'' \dots\ ``The other }N-3\text{ motions "
        r"correspond to out-of-plane displacements that are stabilized by the pre-stress''}",
        note="in the sign of Appendix C: inertia (N-3, 1, 3), also by C.17. That the N-3 others "
        "'primarily increase' the rim is heuristic",
        code="curvature_form, QuadraticForm.inertia",
        equation="C8",
        rests="C.17",
    )
    _matrix(script)
    wheel = single_vertex(5)
    sign = script.alter("sign of Appendix C", 1, -1)
    script.counterexample(
        "with Eqs. (compat), (wheelstress) as printed the matrix Q of a five-fold star has inertia "
        "(1, 2, 3): two negative eigenvalues",
        inertia([[sign * q for q in row] for row in _stress_matrix(wheel, 5)]) == (1, 2, 3),
        of="IIB.21",
        against="IIB.21",
    )
    script.state(
        "IIB.21",
        "Section II B, after Eq. (stressmatrix)",
        r"Q_{nm}\text{ has }N-2\text{ nonzero eigenvalues, exactly one of which is negative}",
        r"\text{exactly one of which is positive}",
        note="with the signs of Eqs. (compat), (wheelstress): Q = 2 K_v; five equal angles: "
        "inertia (1, 2, 3). As printed if Q belongs to the negative of that stress, as in "
        "Appendix C (-2 K_v) and in all that follows. Remark: the number N-2 and the size N+1 hold",
        code="curvature_form",
        equation="8",
        severity=Severity.CONSTANT,
        rests="C.11",
    )


def _stress_matrix(wheel: CreasePattern, hub: int) -> list[list[Any]]:
    """Q_nm of Eq. (stressmatrix) for the wheel stress, in the order of the curvature form."""
    stress, labels = wheel_stress(wheel, hub), curvature_form(wheel, hub).labels
    return [
        [
            sum(d for edge, d in stress.items() if a in edge)
            if a == b
            else -stress.get((min(a, b), max(a, b)), Fraction(0))
            for b in labels
        ]
        for a in labels
    ]


def _matrix(script: Script) -> None:
    """Q_nm of Eq. (stressmatrix) from the stress densities w = sigma/|U_n - U_m|."""
    w, h, k = symbols("w h k")
    sign = script.alter("off-diagonal entries with the sign of the diagonal", -1, 1)
    script.identity(
        "each edge adds w to Q_nn and Q_mm and -w to Q_nm and Q_mn: w (h_n - h_m)^2",
        w * (h - k) ** 2 - (w * h**2 + w * k**2 + 2 * sign * w * h * k),
        of="IIB.20",
    )
    factor = script.alter("factor two dropped", 2, 1)
    differences = []
    for n in (3, 4):
        wheel = free_wheel(n)
        pairs = zip(_stress_matrix(wheel, n), curvature_form(wheel, n).matrix, strict=True)
        differences += [entry - factor * k for row in pairs for entry, k in zip(*row, strict=True)]
    script.identity(
        "over the field of all spokes, N = 3, 4: with the wheel stress this Q is 2 K_v",
        *differences,
        of="IIB.20 IIB.21",
    )
    script.state(
        "IIB.20",
        "Section II B, Eq. (stressmatrix)",
        r"\sum_{n,m}Q_{nm}h_n h_m=0\text{ \dots\ ``}Q_{nm}\text{ be the symmetric matrix "
        r"corresponding to }\bm{\sigma}\text{ so that the quadratic form in Eq. "
        r"(\ref{eq:compat}) is written in terms of the vector of vertical displacements''}",
        note="Remark: Q_nm = -sigma_(n,m)/|U_n - U_m| for n != m, and the rows add up to 0",
        code="stress_form",
        equation="8",
    )


def _signature(script: Script) -> None:
    """Jacobi's rule for tridiagonal matrices, by completing squares from the first variable on."""
    p, f, g, x, y, before = symbols("p f g x y before")  # p: pivot of x, Delta_{j-1} / Delta_{j-2}
    square = p * (x + g * y / p) ** 2
    sign = script.alter("pivot with the wrong sign", -1, 1)
    script.identity(
        "p x^2 + 2 g x y + f y^2 = p (x + g y/p)^2 + (f - g^2/p) y^2: the new pivot is f - g^2/p",
        p * x**2 + 2 * g * x * y + f * y**2 - square - (f + sign * g**2 / p) * y**2,
        of="C.22",
    )
    sign = script.alter("sign in the continuant", -1, 1)
    # Delta_{j-1} = p Delta_{j-2}; the continuant Delta_j = f Delta_{j-1} - g^2 Delta_{j-2}
    script.identity(
        "and the next minor is the product of the pivots: Delta_j / Delta_{j-1} = f - g^2/p",
        (f * p * before + sign * g**2 * before) / (p * before) - (f - g**2 / p),
        of="C.22",
    )
    script.state(
        "C.22",
        "Appendix C, proof of Theorem KM",
        r"\text{``provided none of the }\Delta_j\text{ vanish, }N_-\text{ is equal to the "
        r"number of sign changes of the sequence "
        r"}\Delta_0=1,\Delta_1,\dots,\Delta_k\text{''}",
        note="proved for tridiagonal matrices, all that is needed: the form is a sum of squares "
        "with the factors Delta_j / Delta_{j-1}",
        code="QuadraticForm.inertia",
    )


def _three_folds(script: Script) -> None:
    *points, h0, x, y, z = symbols("ax ay bx by cx cy h0 x y z")
    a, b, c = points[:2], points[2:4], points[4:]
    areas = cross(b, c), cross(c, a), cross(a, b)
    heights, spokes = (x, y, z), (a, b, c)
    curvature = 0 * x
    for j in range(3):
        p, q = spokes[j], spokes[(j + 1) % 3]
        u, v = heights[j] - h0, heights[(j + 1) % 3] - h0
        ratio = dot(p, q) / (2 * cross(p, q))
        curvature += u * v / cross(p, q) - ratio * (u**2 / dot(p, p) + v**2 / dot(q, q))
    lift = sum(w * (h - h0) for w, h in zip(areas, heights, strict=True))
    product = areas[0] * areas[1] * areas[2]
    script.identity(
        "N = 3: 2 K_v = (w_1 x_1 + w_2 x_2 + w_3 x_3)^2 / (w_1 w_2 w_3) with w_1 = d_2 x d_3 > 0 "
        "and so on: K_v vanishes only where hub and ring are coplanar",
        2 * curvature - lift**2 / product * script.alter("factor of the rank one form", 1, 2),
        of="C.12",
    )
    pattern = single_vertex(3)
    # first-order changes do not see the heights; the wheel stress makes one length dependent
    lengths = script.alter(
        "all lengths independent", rank(rigidity_matrix(pattern)), len(pattern.edges)
    )
    script.example(
        "N = 3: the star has one height motion that is no rigid motion, and its lengths are kept "
        "to first order, so it is not infinitesimally rigid in the usual (first-order) sense",
        3 * len(pattern.vertices) - lengths - 6 == 1,
        of="C.12",
    )
    script.state(
        "C.12",
        "Appendix C, after Eq. (equalangleeigs)",
        r"\text{``the vertex is infinitesimally rigid when all eigenvalues have the same "
        r"sign (as happens when }N=3\text{, for instance)''}",
        note="infinitesimally rigid to second order, hence rigid; with angles in (0, pi) exactly "
        "for N = 3. In the usual sense (no first-order motions) no vertex is: it has N - 2 of them",
        code="count_branches",
    )


def _cone(script: Script) -> None:
    motions = script.alter("two rigid motions", 3, 2)
    script.example(
        "N + 1 heights less 3 rigid motions leave N - 2; the form there is nondegenerate (chi(N) "
        "is not 0), so its null cone is a hypersurface, smooth but for 0: dimension N - 3",
        all(
            (n + 1) - motions == sum(curvature_form(single_vertex(n), n).inertia[:2])
            for n in range(3, 9)
        ),
        of="IIB.22",
    )
    t, y1, y2, s = symbols("t y1 y2 s")
    all_axes = script.alter("one axis not rescaled", s, s**0)
    script.identity(
        "in axes of the form, K = t^2 - y_1^2 - ... - y_{N-3}^2: each nappe is t = +-|y|, a graph "
        "over R^{N-3}; rescaling by s > 0 keeps it, so it is the cone over |y| = 1, a sphere of "
        "dimension N-4",
        (s * t) ** 2 - (s * y1) ** 2 - (all_axes * y2) ** 2 - s**2 * (t**2 - y1**2 - y2**2),
        of="IIB.23",
    )
    script.state(
        "IIB.22",
        "Section II B, after Eq. (stressmatrix)",
        r"\text{``a single }N-\text{fold vertex has }N-2\text{ first-order motions once "
        r"translations and rotations have been removed'' \dots\ ``which defines a "
        r"}(N-3)\text{-dimensional surface in the linear space of first-order motions, "
        r"namely, the null-cone''}",
        note="first-order motions: height motions modulo rigid ones. For N = 3 the cone is the "
        "point 0, of dimension 0",
        code="BranchSystem",
        equation="8",
    )
    script.state(
        "IIB.23",
        "Section II B, after Eq. (stressmatrix)",
        r"\text{``its null-cone has two conical components'' \dots\ ``that meet at the "
        r"unfolded state'' \dots\ ``Topologically, the nappes are cones over "
        r"}(N-4)\text{-dimensional spheres''}",
        note="N >= 4. For N = 4 the sphere is two points: a nappe is two rays, and the cone two "
        "lines",
    )


if __name__ == "__main__":
    sys.exit(run(prove()))
