"""Kapovich and Millson's signature of a flat vertex with back-tracks and any winding (Appendix C).

Let p_n = d_1 x d_n. On h_0 = h_1 = h_N = 0 the form is the explicit sum of squares

    sum_{n=2}^{N-1} (p_{n+1} x_n - p_n x_{n+1})^2 / (p_n p_{n+1} c_n),

whose signs are counted by the crossings of the line of d_1.
"""

from __future__ import annotations

import random
import sys
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Any

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import sympy

from exactfold.exact.linalg import rank
from exactfold.rigidity.kapovich_millson import kapovich_millson
from proofs.formulas import Names
from proofs.framework import Proof, Script, run
from proofs.spokes import drawn, wheel
from proofs.statements import Severity
from proofs.vertex_forms import cross, csc, dot, symbols, unit

NAME = "kapovich_millson"
TITLE = "The theorem of Kapovich and Millson on the signature of a flat vertex"
HYPOTHESES = (
    "spokes d_1, ..., d_N of any lengths, angles a_{n,n+1} in (-pi, pi), none of them 0",
    "f angles are positive (forward-tracks), b negative (back-tracks), and their sum is 2 pi w",
)
Spokes = list[tuple[int, int]]
BACK_FIRST: Spokes = [(1, 0), (2, -1), (0, 1), (-1, -1)]
PENTAGRAM: Spokes = [(2, 0), (-2, 1), (1, -2), (1, 2), (-2, -1)]
TWICE_BACK: Spokes = [(1, 0), (-5, 1), (-1, 5), (0, -1), (-5, -2)]


def prove(change: str | None = None) -> Proof:
    """Prove Theorem KM, with a complete count of crossings and the case of vanishing minors."""
    script = Script(NAME, TITLE, HYPOTHESES, change)
    _minors(script)
    _squares(script)
    _crossings(script)
    _vanishing(script)
    _germ(script)
    _changes(script)
    return script.proof()


def _minors(script: Script) -> None:
    *angles, length, front = symbols("t1 tp tq length front")
    first, p, q = map(unit, angles)  # spokes 1, j, j+1
    chi, ratio = front * cross(first, p), cross(first, q) / cross(first, p)
    chi_next = front * csc(p, q) / length**2 * cross(first, q)
    script.identity(
        "chi(j+1)/chi(j) = csc a_{j,j+1} / L_j^2 . sin(a_12 + ... + a_{j,j+1}) / sin(a_12 + ... + "
        "a_{j-1,j})",
        chi_next / chi - csc(p, q) / length ** script.alter("L_j not squared", 2, 1) * ratio,
        of="C.14 C.13",
    )
    d: Spokes = [(5, 0), (4, 3), (-3, 4), (0, -5)]  # all of length 5
    matrix = kapovich_millson(d).form.matrix
    true_ratio = matrix[3][3] - matrix[2][3] ** 2 / matrix[2][2]  # chi(4) / chi(3)
    sines = Fraction(cross(d[0], d[3]), cross(d[0], d[2]))
    i = script.alter("cosecant of the angle before", 2, 1)
    script.counterexample(
        "spokes (5,0), (4,3), (-3,4), (0,-5), j = 3: chi(4)/chi(3) = sines csc a_34 / 25, and not "
        "sines csc a_23 / 25",
        true_ratio == sines / cross(d[i], d[i + 1]) != sines / cross(d[1], d[2]),
        against="C.14",
    )
    script.formula(
        "C.13",
        "Appendix C, proof of Theorem KM",
        r"\Delta_j=\chi(j)",
        r"\Delta_j=\chi(j+2)",
        over=[{**wheel(5), "j": j} for j in (1, 2, 3)],
        at=[{**names, "j": j} for names in drawn(6) for j in (0, 1, 2, 3)],
        functions=["chi"],
        quoted=r"\chi(j)\text{ ``is also an expression for }\Delta_j\text{ of the stress matrix''}",
        note="chi(n) is the determinant on h_2, ..., h_{n-1}: Delta_0 = chi(2) = 1, and the last "
        "minor is Delta_{N-2} = chi(N)",
        code="kapovich_millson",
        severity=Severity.TYPO,
    )
    script.formula(
        "C.14",
        "Appendix C, Eq. (ratio)",
        r"\frac{\Delta_{j+1}}{\Delta_j}=\frac{\csc\alpha_{j-1,j}}{L_j^2}\frac{"
        r"\sin(\sum_{n=1}^{j}\alpha_{n,n+1})}{\sin(\sum_{n=1}^{j-1}\alpha_{n,n+1"
        r"})},\quad j=2,\dots,N-1",
        r"\frac{\Delta_{j-1}}{\Delta_{j-2}}=\frac{\csc\alpha_{j,j+1}}{L_j^2}"
        r"\frac{\sin(\sum_{n=1}^{j}\alpha_{n,n+1})}{\sin(\sum_{n=1}^{j-1}\alpha_"
        r"{n,n+1})},\quad j=2,\dots,N-1",
        over=[wheel(4), wheel(5)],
        at=drawn(4, 5, 6),
        functions=["chi"],
        quoted=r"\frac{\Delta_{j+1}}{\Delta_j}=\frac{\csc\alpha_{j-1,j}}{L_j^2}\frac{"
        r"\sin(\sum_{n=1}^{j}\alpha_{n,n+1})}{\sin(\sum_{n=1}^{j-1}\alpha_{n,n+1})}",
        note="the range is ours; the cosecant is that of the last angle of the numerator, also in "
        "'negative iff alpha_{j-1,j} < 0'; the ratios use the angles 23 to N-1,N only, not 12 and "
        "N1",
        equation="C9",
        severity=Severity.TYPO,
    )


def _squares(script: Script) -> None:
    *points, x, y = symbols("ex ey ax ay bx by cx cy x y")
    e, a, b, c = (points[2 * i : 2 * i + 2] for i in range(4))
    p_before, p, p_after = cross(e, a), cross(e, b), cross(e, c)
    before, after = cross(a, b), cross(b, c)
    sign = script.alter("sign in the three-term relation", 1, -1)
    script.identity(
        "p_{n+1} c_{n-1} + p_{n-1} c_n = p_n (d_{n-1} x d_{n+1}), so f_n = p_{n+1}/(p_n c_n) + "
        "p_{n-1}/(p_n c_{n-1}), where p_1 = 0",
        p_after * before + sign * p_before * after - p * cross(a, c),
    )
    sign = script.alter("squares of sums", 1, -1)
    square = (p_after * x - sign * p * y) ** 2 / (p * p_after * after)
    script.identity(
        "term n of the sum of squares is p_{n+1}/(p_n c_n) x_n^2 - 2/c_n x_n x_{n+1} + "
        "p_n/(p_{n+1} c_n) x_{n+1}^2: summed over n = 2, ..., N-1 with x_N = 0 it is the form, "
        "with pivots chi(n+1)/chi(n) = p_{n+1}/(p_n c_n)",
        square - p_after / (p * after) * x**2 + 2 / after * x * y - p / (p_after * after) * y**2,
        of="C.17",
    )


def _crossings(script: Script) -> None:
    """Signs: `step` is the change of floor(partial sum / pi), `back` marks a back-track."""
    table = [(0, 0), (0, 1), (1, 0), (1, -1)]  # (back, step): |angle| < pi allows no others
    flip = script.alter("crossings make no sign", 1, 0)
    script.certificate(
        "the pivot p_{n+1}/(p_n c_n) is negative iff [back-track] + (change of floor(sum/pi)) = 1; "
        "the sum is 0 otherwise (four cases)",
        all(
            ((-1) ** (flip * step) * (-1) ** back < 0) == (back + step == 1)
            and back + step in (0, 1)
            for back, step in table
        ),
        of="C.15 C.17",
    )
    b, w, first, last = symbols("b w first last")
    start = -script.alter("first angle taken for a forward-track", first, 0 * first)
    end = 2 * w - 1 + last
    script.identity(
        "floor(a_12/pi) = -[a_12 < 0], floor((2 pi w - a_N1)/pi) = 2w - 1 + [a_N1 < 0], and b - "
        "[a_12 < 0] - [a_N1 < 0] back-tracks are among the angles 23 to N-1,N: b + 2w - 1 "
        "negative pivots",
        end - start + (b - first - last) - (b + 2 * w - 1),
        of="C.15",
    )
    found = kapovich_millson(BACK_FIRST)
    net = script.alter("net crossings as printed", 2, 1)
    script.counterexample(
        "spokes (1,0), (2,-1), (0,1), (-1,-1): f = 3, b = 1, w = 1, a_12 < 0; from a_12 to 2 pi w "
        "- a_41 there are 2 = 2w net crossings, not 2w - 1",
        (found.forward, found.back, found.winding) == (3, 1, 1)
        and net_crossings(BACK_FIRST) == net,
        against="C.15",
    )
    turned = [d[k:] + d[:k] for d in (BACK_FIRST, PENTAGRAM, TWICE_BACK) for k in range(3)]
    stars = [d for d in (*turned, *_samples()) if all(cross(d[0], e) for e in d[1:])]
    script.formula(
        "C.15",
        "Appendix C, proof of Theorem KM",
        r"\text{``}2w-1\text{ is the net number of times }C_f-C_b\text{'' \dots\ ``this occurs "
        r"}b-C_b\text{ times''}",
        r"2w-1+[\alpha_{1,2}<0]+[\alpha_{N,1}<0]\text{ is the net number of times }C_f-C_b\text{ "
        r"that the angles but the first and the last cross; back-tracks among them do not cross }"
        r"b-[\alpha_{1,2}<0]-[\alpha_{N,1}<0]-C_b\text{ times}",
        at=map(_crossed, stars),
        note="the two gaps cancel, and the sum b + 2w - 1 is right. As printed both counts fail "
        "when the first or the last angle is a back-track: spokes (1,0), (2,-1), (0,1), (-1,-1)",
        code="kapovich_millson",
        severity=Severity.CONSTANT,
    )


def _crossed(d: Spokes) -> Names:
    """The names of a star, with the crossings of its partial sums; signs determine the angles."""
    found, n = kapovich_millson(d), len(d)
    half = Fraction(1, 2)
    signs = [half if cross(d[k], d[(k + 1) % n]) > 0 else -half for k in range(n)]
    crossed = [cross(d[0], a) * cross(d[0], b) < 0 for a, b in pairwise(d[1:])]
    inner = list(zip(signs[1:-1], crossed, strict=True))
    forward, back = inner.count((half, True)), inner.count((-half, True))
    net = net_crossings(d)
    return {
        "N": n,
        "w": found.winding,
        "b": found.back,
        "C_f": forward,
        "C_b": back,
        "pi": sympy.pi,
        "alpha": lambda i, j: {(1, 2): signs[0], (n, 1): signs[-1]}[i, j],
        "values": (net, net, inner.count((-half, False))),
    }


def net_crossings(d: Spokes) -> int:
    """Net crossings of multiples of pi by the partial sums from a_12 to a_12 + ... + a_{N-1,N}."""
    net = 0
    for a, b in pairwise(d[1:]):
        if cross(d[0], a) * cross(d[0], b) < 0:
            net += 1 if cross(a, b) > 0 else -1
    return net


def _vanishing(script: Script) -> None:
    e1, e2, r, a1, a2, c1, c2, eps = symbols("e1 e2 r a1 a2 c1 c2 eps")
    e, a, b, c = (e1, e2), (a1, a2), (r * e1, r * e2), (c1, c2)  # p_n = 0: d_n = r d_1
    before, after = cross(a, b), cross(b, c)
    script.identity(
        "where p_n = 0: chi(n+1)/chi(n-1) = -g_{n-1,n}^2 < 0, so the two pivots at n-1 and n have "
        "opposite signs, as with either sign for chi(n)",
        cross(e, c) / (cross(e, a) * before * after)
        + script.alter("sign at a vanishing minor", 1, -1) / before**2,
        of="C.21 C.17",
    )
    turn = script.alter("turned the other way", eps, -eps)
    turned = (b[0] - turn * b[1], b[1] + turn * b[0])
    script.identity(
        "turning d_n a little gives p_n = eps d_1 . d_n, (d_1 . d_n)^2 = |d_1|^2 |d_n|^2 > 0; f, "
        "b, w and chi(N) c_1...c_{N-1} = -c_N (2 < n < N) do not change sign, so the inertia does "
        "not change",
        cross(e, turned) - eps * dot(e, b),
        dot(e, b) ** 2 - dot(e, e) * dot(b, b),
        of="C.21",
    )
    script.formula(
        "C.16",
        "Appendix C, end of the proof of Theorem KM",
        r"\sum_{n=1}^{N-1}\alpha_{n,n+1}=2\pi-\alpha_{N,1}",
        r"\sum_{n=1}^{N-1}\alpha_{n,n+1}=2\pi w-\alpha_{N,1}",
        at=[_winding_star(5, 1), _winding_star(5, 2), _winding_star(7, 3)],
        quoted=r"\text{``the angle sum in }\chi(N)\text{ is equal to }2\pi-\alpha_{N,1}\text{''}",
        note="the theorem is about any winding w; the sine of the sum is the same",
        severity=Severity.TYPO,
    )
    script.state(
        "C.21",
        "Appendix C, end of the proof of Theorem KM",
        r"\text{``we can perturb the angles }\alpha\text{ to avoid these cases'' \dots\ "
        r"``and hence without changing the signature. Such a perturbation can also be "
        r"chosen small enough so that }f,b,w\text{ do not change''}",
        note="Remark: turn the spokes d_n, 2 < n < N, that are parallel to d_1. It can be avoided: "
        "two minors in sequence never vanish, and C.7 gives opposite signs around one that does",
    )


def _samples() -> list[Spokes]:
    source = random.Random(5)
    found: list[Spokes] = []
    while len(found) < 60:
        n, reach = source.randint(3, 8), source.choice((1, 2, 9))
        d = [(source.randint(-reach, reach), source.randint(-reach, reach)) for _ in range(n)]
        found += [d] if all(cross(d[k - 1], d[k]) for k in range(n)) else []
    return found


def _germ(script: Script) -> None:
    shift = script.alter("signature with 2w + 1", 0, 1)
    results = [kapovich_millson(d) for d in _samples()]
    script.cases(
        "inertia of the library's form is (f - 2w - 1, b + 2w - 1, 3); in many of these stars "
        "spokes are parallel to the first, so that minors vanish",
        (r.inertia == (r.predicted[0] - shift, r.predicted[1] + shift, 3) for r in results),
        of="C.17",
    )
    stresses = script.alter("lengths without a self stress", 1, 0)
    script.example(
        "a spoke adds two unknowns and two lengths, independent since consecutive spokes are not "
        "parallel: the 2N lengths have rank 2N - 1, and one equation remains (pentagram: rank 9)",
        rank(_lengths(PENTAGRAM)) == 2 * len(PENTAGRAM) - stresses,
        of="C.17",
    )
    script.state(
        "C.17",
        "Appendix C, Theorem 1 (Kapovich and Millson)",
        r"\text{``The germ of the configuration space of an origami vertex with }f\text{ "
        r"forward-tracks, }b\text{ back-tracks, and winding }w\text{ is isomorphic to the "
        r"germ of the null-cone of a quadratic form with nullity 3, and signature "
        r"}(f-2w-1,b+2w-1)\text{''}",
        note="in the sign of Appendix C, -2 K_v. Nullity 3 by C.4 and chi(N) = "
        "-c_N/(c_1...c_{N-1}), which hold for any tracks. The germ: the lengths have rank 2N - 1 "
        "in the plane, so they leave one analytic equation in the heights modulo rigid motions, "
        "whose second-order part is the form (its one self stress); that is nondegenerate, and "
        "the Morse lemma gives the isomorphism",
        code="kapovich_millson",
        rests="C.4",
        cited="the Morse lemma",
    )


def _lengths(d: Spokes) -> list[list[int]]:
    """Rigidity matrix of the wheel in the plane, hub first."""
    points, n, rows = [(0, 0), *d], len(d), []
    for i, j in [(0, k + 1) for k in range(n)] + [(k + 1, (k + 1) % n + 1) for k in range(n)]:
        row = [0] * (2 * n + 2)
        for axis in (0, 1):
            row[2 * i + axis] = points[i][axis] - points[j][axis]
            row[2 * j + axis] = -row[2 * i + axis]
        rows.append(row)
    return rows


def _changes(script: Script) -> None:
    f, b, w = symbols("f b w")
    size = script.alter("size of the matrix", 1, 0) + f + b
    script.identity(
        "(f - 2w - 1) + (b + 2w - 1) + 3 = N + 1 with f + b = N; f = N, b = 0, w = 1: (N - 3, 1)",
        (f - 2 * w - 1) + (b + 2 * w - 1) + 3 - size,
        of="C.20 C.24",
    )
    script.state(
        "C.24",
        "Appendix C, proof of Theorem KM",
        r"\text{``the defining symmetric matrix is }(n+1)\times(n+1)\text{ and }f+b=n\text{''}",
        r"\text{the defining symmetric matrix is }(N+1)\times(N+1)\text{ and }f+b=N",
        "the number of folds is N; n is the index of the sums",
        severity=Severity.TYPO,
        contradiction="N folds in all of Appendix C, and f = N a few lines before",
    )
    script.state(
        "C.20",
        "Appendix C, after Theorem 1",
        r"\text{``We showed above the case of this theorem when "
        r"}f=N,b=0\text{ and }w=1\text{, and in fact our sign convention for the sign of "
        r"the quadratic form also agrees with theirs''}",
        note="with the sign of Appendix C: (N - 3, 1); Eq. (compat) has the other sign (IIB.21)",
    )
    second = script.alter("stars of different signature", TWICE_BACK, BACK_FIRST)
    stars = [kapovich_millson(d) for d in (PENTAGRAM, second)]
    script.counterexample(
        "pentagram (f, b, w) = (5, 0, 2) and spokes (1,0), (-5,1), (-1,5), (0,-1), (-5,-2) with "
        "(3, 2, 1): both have inertia (0, 3, 3)",
        [(s.forward, s.back, s.winding, s.inertia) for s in stars]
        == [(5, 0, 2, (0, 3, 3)), (3, 2, 1, (0, 3, 3))],
        against="C.19",
    )
    jump = script.alter("winding kept at pi", 1, 0)
    kept = script.alter("winding changed at 0", 0, 1)
    for name, change, expected in (("0", kept, -1), ("pi", jump, 1)):
        script.identity(
            f"as one forward-track turns into a back-track through {name}, the signature changes "
            f"by ({expected:+}, {-expected:+})",
            (f - 1 - 2 * (w - change) - 1) - (f - 2 * w - 1) - expected,
            (b + 1 + 2 * (w - change) - 1) - (b + 2 * w - 1) + expected,
            of="C.19",
        )
    script.state(
        "C.18",
        "Appendix C, after Theorem 1",
        r"\text{``only vanishes when one of the }\alpha\text{ is an integer multiple of "
        r"}\pi\text{''}",
        note="by C.6 it vanishes iff alpha_{N,1} is; where another angle tends to such a multiple "
        "it is unbounded",
        equation="C5",
        rests="C.6",
    )
    script.state(
        "C.19",
        "Appendix C, after Theorem 1",
        r"\text{``the signature changes when any of }f,b,w\text{ change''}",
        r"\text{the signature changes each time one angle passes a multiple of }\pi,\text{ by "
        r"}(-1,1)\text{ or }(1,-1)",
        note="two such changes can cancel: (f, b, w) and (f - 2, b + 2, w - 1) have the same "
        "signature, as the pentagram (5, 0, 2) and spokes (1,0), (-5,1), (-1,5), (0,-1), (-5,-2) "
        "with (3, 2, 1), both (0, 3)",
        code="kapovich_millson",
        severity=Severity.CLAIM,
    )


def _winding_star(n: int, winding: int) -> dict[str, Any]:
    """The names of a star with n different angles that goes round the hub `winding` times."""
    weights = [2 * n + k for k in range(n)]

    def alpha(i: int, j: int) -> Any:
        if (j - i) % n != 1:
            raise LookupError(f"no sector from {i} to {j}")
        return 2 * sympy.pi * winding * weights[i % n] / sum(weights)

    return {"N": n, "w": winding, "pi": sympy.pi, "alpha": alpha}


if __name__ == "__main__":
    sys.exit(run(prove()))
