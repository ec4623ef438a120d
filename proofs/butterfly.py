"""Butterflies and the doubling step of the H1 move (Section IV).

Notation of the move: w is attached to v1, v2, v3; the faces of T at v2 span the angle A, the new
ones beta_1 (between v3 and w) and beta_2 (between w and v1), A + beta_1 + beta_2 = 2 pi; rho are
slopes seen from v2. Only K_{v2} contains the height of w.

Theorem (second order). Let delta be the distance of rho_w from the plane through v1, v2, v3, and Kc
the curvature form at v2 when T is closed by the triangle v1 v2 v3 instead. If A is not pi,

    K_{v2} = Kc - (1/2) (cot beta_1 + cot beta_2) delta^2,

so delta has two real values, one (0) or none as Kc / sin(beta_1 + beta_2) is positive, 0, negative.
  A < pi: Kc = -(1/2) sum of positive multiples of squares of all bends of T at v2: two values
          exactly if T is folded at v2.
  A > pi: with four boundary vertices Kc > 0 on every branch of T: always two values.
          With five or more there may be none.
  A = pi: K_{v2} is linear in rho_w: one value for each branch of T with rho_1 + rho_3 != 0, and one
          more branch, T unfolded and the sheet folded along v1 v2 v3.
What follows for the number of branches is in `h1_doubling`.
"""

from __future__ import annotations

import sys
from fractions import Fraction
from pathlib import Path

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import sympy

from exactfold import CreasePattern
from exactfold.branches import count_branches
from exactfold.pattern import families
from exactfold.rigidity import curvature_form, definite_stress
from proofs.framework import Proof, Script, run
from proofs.mountain_valley import sector
from proofs.statements import Severity

NAME = "butterfly"
TITLE = "Butterflies and the H1 doubling step"

FAN = CreasePattern(
    [(2, -1), (1, 2), (-1, 2), (-2, -1), (0, -2), (0, 0)],
    [(0, 1, 5), (1, 2, 5), (2, 3, 5), (3, 4, 5), (4, 0, 5)],
)
"""w = 4 attached at the reflex corner 5 of the fan 0, 1, 2, 3, which has five boundary vertices."""

_DART = [(-4, -1), (0, 0), (4, -1), (0, 6), (-1, 1), (1, 2), (0, -4)]
_INNER = [(0, 1, 4), (1, 5, 4), (1, 2, 5), (2, 3, 5), (3, 4, 5), (3, 0, 4)]
DART = CreasePattern(_DART[:6], _INNER)
"""A quadrilateral with the reflex corner v2 = 1 of degree 4."""
STRAIGHT = CreasePattern(
    [(1, 0), (0, 1), (-1, 0), (0, -1), (0, 0)], [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]
)
"""w = 1 attached at v1, v2, v3 = 0, 4, 2 in one line, to two faces with the fold 34."""
KITE = CreasePattern(_DART, [*_INNER, (0, 6, 1), (6, 2, 1)])
"""The dart with w = 6 attached at v1, v2, v3 = 0, 1, 2."""


def prove(change: str | None = None) -> Proof:
    """Monotonicity of the butterfly, and the exact hypotheses of the doubling step."""
    script = Script(
        NAME, TITLE, ("non-degenerate triangles; for the doubling step, second order",), change
    )
    _butterfly(script)
    _doubling(script)
    _reflex(script)
    return script.proof()


def _butterfly(script: Script) -> None:
    """d^2 as a function of the dihedral angle theta, tau = tan(theta / 2) in (0, oo)."""
    a, b, p, q, tau = sympy.symbols("a b p q tau", positive=True)
    sine, cosine = 2 * tau / (1 + tau**2), (1 - tau**2) / (1 + tau**2)
    wing = sympy.Matrix([a, p, 0])
    other = sympy.Matrix([b, q * cosine, q * sine])
    square = (wing - other).dot(wing - other)
    sign = script.alter("wrong sign of the cosine", -1, 1)
    script.identity(
        "d^2 = (a - b)^2 + p^2 + q^2 - 2 p q cos theta, with heights p, q over the shared fold",
        square - (a - b) ** 2 - p**2 - q**2 - sign * 2 * p * q * cosine,
        of="IV.2 IV.1",
    )
    slope = sympy.factor(sympy.diff(square, tau))
    expected = script.alter("derivative with the wrong sign", 1, -1)
    script.certificate(
        "d(d^2)/d tau = 8 p q tau / (1 + tau^2)^2 > 0 for tau > 0; even in theta, hence decreasing "
        "from pi to 2 pi",
        sympy.simplify(slope - expected * 8 * p * q * tau / (1 + tau**2) ** 2) == 0,
        of="IV.2",
    )
    ends = script.alter("theta measured from the unfolded state", (0, sympy.oo), (sympy.oo, 0))
    limits = [sympy.limit(square, tau, end) for end in ends]
    script.identity(
        "d_min^2 = (a - b)^2 + (p - q)^2 when folded flat, d_max^2 = (a - b)^2 + (p + q)^2 "
        "unfolded",
        limits[0] - (a - b) ** 2 - (p - q) ** 2,
        limits[1] - (a - b) ** 2 - (p + q) ** 2,
        of="IV.2",
    )
    mirrored = other.subs(tau, script.alter("theta and theta + pi", -tau, -1 / tau))
    script.identity(
        "theta and 2 pi - theta have the same d and differ by the reflection in the plane of a "
        "wing",
        (wing - mirrored).dot(wing - mirrored) - square,
        mirrored[0] - other[0],
        mirrored[1] - other[1],
        mirrored[2] + other[2],
        of="IV.3",
    )
    script.state(
        "IV.1",
        "Section IV, definition of a butterfly",
        r"\text{``Its configuration space is topologically a circle, parametrized by the "
        r"dihedral angle at the shared fold''}",
        note="modulo rigid motions; self-intersection (theta = 0) allowed",
    )
    script.state(
        "IV.2",
        "Section IV",
        r"\text{``the distance }d\text{ increases monotonically from its minimum value "
        r"}d_{min}\text{ in the flat folded state, to its maximum value }d_{max}\text{ when "
        r"the butterfly is flat and unfolded, and then decreases monotonically again to "
        r"}d_{min}\text{''}",
        note="Remark: strictly: d^2 = const - 2 p q cos(theta)",
    )
    script.state(
        "IV.3",
        "Section IV",
        r"\text{``for each value }d_{min}<d<d_{max}\text{, there are two distinct "
        r"configurations of the butterfly that are related by reflection''}",
    )


def _doubling(script: Script) -> None:
    """Complete the square in the slope of w; sum of squares when A < pi."""
    r, s, m, t, u = sympy.symbols("rho_3 rho_1 rho_w t u")
    whole = (t + u) / (1 - t * u)
    sin1, sin2 = 2 * t / (1 + t**2), 2 * u / (1 + u**2)
    cot1, cot2 = (1 - t**2) / (2 * t), (1 - u**2) / (2 * u)
    sine = 2 * whole / (1 + whole**2)
    delta = m - (r * sin2 + s * sin1) / sine
    weight = script.alter("weight with the wrong sign", 1, -1) * (cot1 + cot2) / 2
    script.identity(
        "sector(rho_3, rho_w) + sector(rho_w, rho_1) = sector(rho_3, rho_1) - (1/2) (cot beta_1 + "
        "cot beta_2) delta^2",
        sector(r, m, t) + sector(m, s, u) - sector(r, s, whole) + weight * delta**2,
        of="IV.4 IV.5",
    )
    script.identity(
        "cot beta_1 + cot beta_2 = sin(beta_1 + beta_2) / (sin beta_1 sin beta_2)",
        cot1 + script.alter("difference of cotangents", 1, -1) * cot2 - sine / (sin1 * sin2),
        of="IV.4",
    )
    turned = script.alter("closing sector not reversed", -1, 1)
    script.identity(
        "a sector of angle 2 pi - A is minus the sector of angle A: for A < pi the form Kc is the "
        "faces of T minus the flat sector across them, and merging two sectors at a time (the "
        "first "
        "identity, cot x + cot y > 0 for x + y < pi) leaves minus a sum of squares of bends",
        sector(r, s, -t) - turned * sector(r, s, t),
        of="IV.4",
    )
    script.identity(
        "over the single fold of a seed Kc = -(1/2) (cot a_1 + cot a_2) bend^2, so that "
        "delta^2 = -(cot a_1 + cot a_2) / (cot beta_1 + cot beta_2) bend^2",
        sector(r, m, t) + sector(m, s, u) + sector(r, s, -whole) + weight * delta**2,
        of="IV.4",
    )
    h1 = families.sample_h1_sequence(3, seed=1)
    v1, v2, v3, w = h1.moves[script.alter("first move for last", -1, 0)]
    only = [v for v in h1.pattern.interior if w in curvature_form(h1.pattern, v).labels]
    script.example(
        "only K_{v2} contains the height of w (an H1 sequence; v1 and v3 are boundary vertices), "
        "so "
        "the Jacobian is block triangular: simple branches of T with delta != 0 stay simple",
        only == [v2] and {v1, v3} <= set(h1.pattern.boundary),
        of="IV.4",
    )


def _reflex(script: Script) -> None:
    """A > pi: fine for four boundary vertices, not for five."""
    heights = dict(zip(range(4), (0, 1, -1, 0), strict=True))
    c, b, a = quadratic(FAN, 5, 4, heights)
    bend = script.alter("the folded fan replaced by a flat one", 1, 0)
    script.counterexample(
        "five boundary vertices: the fan folded to heights 0, 1, -1, 0 admits no height of w "
        "(discriminant < 0), and it is folded at v2",
        b * b - 4 * a * c < 0 and bool(heights[1] * bend),
        against="IV.4",
    )
    closed = script.alter("the notch left open", DART.with_notch_closed(), DART)
    script.example(
        "four boundary vertices, A > pi: closing T at v2 gives a triangulated triangle, whose "
        "definite "
        "stress makes m Kc = sum_v m_v K_v > 0 on every branch (docs/mathematics.md, 6; here: the "
        "dart)",
        closed.Ve == 3 and definite_stress(closed) is not None and DART.reflex_corner == 1,
        of="IV.4",
    )
    before, after = count_branches(DART), count_branches(KITE)
    factor = script.alter("no doubling at a reflex corner", 2, 1)
    script.example(
        "dart of degree 4 at its reflex corner: 4 branches; with w attached: 8, all real",
        before.distinct == 4 and after.real == factor * before.distinct,
        of="IV.4",
    )
    heights = script.alter("T unfolded", {0: 1, 2: 1, 3: 0}, {0: 1, 2: -1, 3: 0})
    script.counterexample(
        "angle pi and degree 3: v1, v4, v3 = (1,0), (0,-1), (-1,0) at heights 1, 0, 1, hub 0, and "
        "w = (0,1): K = 2 h_w, so that there is one height of w and not two",
        list(quadratic(STRAIGHT, 4, 1, heights)) == [0, 2, 0],
        of="IV.4",
    )
    script.state(
        "IV.4",
        "Section IV, key property of H1 moves",
        r"\text{``given a configuration of }T\text{ where the faces around }v_2\text{ are "
        r"in a folded configuration, there are always two distinct folded configurations of "
        r"}T'\text{''}",
        r"\text{near the unfolded state: two if the angle of }T\text{ at }v_2\text{ is less than "
        r"}\pi\text{; if it is larger, two if }v_2\text{ has degree 3 in }T\text{ or (to second "
        r"order) if }V_e=4\text{; only one can be sure if it is }\pi",
        "hub (0,0) with spokes (2,-1), (1,2), (-1,2), (-2,-1) at heights 0, 1, -1, 0 and w = "
        "(0,-2): |v1 v3| exceeds d_max and nothing can be attached, to second order and hence near "
        "the unfolded state. At an angle of pi K is linear in the height of w: (1,0), (0,-1), "
        "(-1,0) at heights 1, 0, 1, hub 0, with w = (0,1) have h_w = 0 only (the other attachment "
        "is folded over). Remark: below pi it holds for true configurations too: the faces at v2 "
        "are a chain of arcs on a sphere, of length below pi, so that |v1 v3| < d_max as soon as "
        "it is bent",
        "families.sample_h1_sequence",
        severity=Severity.CONDITION,
        words="docstring of proofs/butterfly.py",
    )
    half = script.alter("half of the flat-folded angle", sympy.Integer(1), sympy.Integer(0))
    p, q, tau = sympy.symbols("p q tau", positive=True)
    square = -2 * p * q * (1 - tau**2) / (1 + tau**2)  # d^2 less a constant, IV.2
    script.counterexample(
        "in the unfolded state d = d_max, which is the angle pi of the new butterfly (tau = oo); "
        "the angle 0 (tau = 0) is d_min",
        sympy.limit(square, tau, sympy.oo) == 2 * p * q * half
        and square.subs(tau, 0) == -2 * p * q * half,
        of="IV.19",
        against="IV.19",
    )
    script.state(
        "IV.19",
        "Section IV, the first H1 move",
        r"\text{``a small enough interval around the unfolded state \dots\ where the dihedral "
        r"angle of the new butterfly never reaches }\pi\text{''}",
        r"\text{never reaches }0\text{; it is }\pi\text{ in the unfolded state, and nowhere else "
        r"if }v_1,v_2,v_3\text{ are not collinear}",
        "the angle is pi iff d = d_max (IV.2). What a small interval excludes is d = d_min, the "
        "angle 0, where the two attachments meet again",
        severity=Severity.TYPO,
        rests="IV.2",
    )
    script.state(
        "IV.5",
        "Section IV",
        r"\text{``when the faces around }v_2\text{ are unfolded \dots\ we can only attach the "
        r"butterfly "
        r"in its unfolded state''}",
        note="Remark: delta = 0 is then a double root; if v1, v2, v3 are collinear the unfolded "
        "butterfly can still turn about that line",
    )


def quadratic(
    pattern: CreasePattern, hub: int, free: int, heights: dict[int, int]
) -> tuple[Fraction, Fraction, Fraction]:
    """Coefficients c, b, a of K_hub = c + b x + a x^2 in the height x of one vertex, hub at 0."""
    form = curvature_form(pattern, hub)
    known = {**{v: Fraction(x) for v, x in heights.items()}, hub: Fraction(0), free: Fraction(0)}
    unit = {v: Fraction(v == free) for v in form.labels}
    return form(known), 2 * form.polar(known, unit), form(unit)


if __name__ == "__main__":
    sys.exit(run(prove()))
