"""Popping and mountain-valley assignments of one vertex (Sections III A and III C), second order.

Notation at a vertex: unit spokes e_j at angles theta_j, slopes rho_j = (h_j - h_v) / L_j, sector
angles a_j from e_j to e_{j+1}, and the bend (valley positive)

    b_j = (rho_{j+1} - rho_j cos a_j) / sin a_j + (rho_{j-1} - rho_j cos a_{j-1}) / sin a_{j-1}.

Theorem. On a null vector h of K_v that is not flat at v:
  (1) v is popped down exactly if sum_j b_j > 0, popped up exactly if sum_j b_j < 0;
  (2) if v is popped down, the valleys lie in no closed half-plane and some fold is a mountain,
      unless the sheet just folds along one straight valley line; and likewise for popped up.
If no fold were a mountain, subtracting a plane with gradient inside the convex polygon of
gradients would make all slopes positive, and K = (1/2) sum rho_j b_j > 0.
A set of directions in no closed half-plane contains a tripod (three directions with all angles
between neighbours below pi) or a cross (two opposite pairs).
"""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import combinations
from pathlib import Path
from typing import Any

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import sympy

from exactfold import CreasePattern
from exactfold.branches import count_branches
from exactfold.pattern import families
from exactfold.rigidity import curvature_form
from exactfold.rigidity.functionals import fold_functional, vertex_sign_functional
from proofs.framework import Proof, Script, run
from proofs.statements import Severity
from proofs.vertex_forms import star

NAME = "mountain_valley"
TITLE = "Popping both ways with one mountain-valley assignment"

WATERBOMB = {
    +1: {0: -3, 1: -3, 4: 1, 2: -2, 3: -2, 5: -3, 6: 0},
    -1: {0: 3, 1: 3, 4: 3, 2: 2, 3: 2, 5: -1, 6: 0},
}
"""Heights of the waterbomb base, popped up and popped down, both folded MVMVMV."""

CROSS_SPOKES = ((1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (0, -1), (1, -2))
CROSS_FOLDS = "VMVMVVM"
CROSS = {+1: (-9, -9, -6, -1, -9, -6, -1, 0), -1: (1, 3, 1, 3, 1, 0, 3, 0)}
"""A vertex with four valleys on a cross that pops both ways, though no valleys form a tripod."""


def prove(change: str | None = None) -> Proof:
    """Prove second-order versions of the statements of Section III C on popping and bird's feet."""
    script = Script(
        NAME,
        TITLE,
        (
            "an interior vertex of degree N >= 4 with sector angles in (0, pi)",
            "K_v has one positive direction (Appendix C; docs/mathematics.md, 1)",
        ),
        change,
    )
    _bends(script)
    _inequality(script)
    _directions(script)
    _examples(script)
    return script.proof()


def sector(rho: Any, sigma: Any, t: Any) -> Any:
    """The part of K_v in a sector of angle 2 arctan t between slopes rho and sigma."""
    sine, cosine = 2 * t / (1 + t**2), (1 - t**2) / (1 + t**2)
    return rho * sigma / sine - cosine / sine * (rho**2 + sigma**2) / 2


def half_bend(rho: Any, sigma: Any, t: Any) -> Any:
    """The part of the bend at the spoke of slope rho that comes from this sector."""
    sine, cosine = 2 * t / (1 + t**2), (1 - t**2) / (1 + t**2)
    return (sigma - rho * cosine) / sine


def _bends(script: Script) -> None:
    """The identity K = (1/2) sum rho_j b_j, its polar form, the closed polygon of bends, flat
    spokes."""
    r, s, p, q, t = sympy.symbols("rho sigma rho_1 sigma_1 t")
    sine, cosine = 2 * t / (1 + t**2), (1 - t**2) / (1 + t**2)
    half = script.alter("factor one half dropped", sympy.Rational(1, 2), 1)
    polar = (sector(r + p, s + q, t) - sector(r, s, t) - sector(p, q, t)) / 2
    script.identity(
        "each sector's polar form is (1/2) (rho' b + sigma' c) with its parts b, c of the bends; "
        "summed over the sectors: K(g, h) = (1/2) sum_j rho_j(g) b_j(h), for every degree",
        polar - half * (p * half_bend(r, s, t) + q * half_bend(s, r, t)),
        of="IIIC.1",
    )
    gx, gy = sympy.symbols("g_x g_y")
    value = gx * cosine + gy * sine
    turn = script.alter("gradient rotated the wrong way", 1, -1)
    script.identity(
        "seen from e_j = (1, 0) the parts of a bend are the components of the gradients along "
        "e_j^perp: b_j e_j^perp is the jump of the gradient, so sum_j b_j e_j = 0 by telescoping",
        half_bend(gx, value, t) - turn * gy,
        half_bend(gx, gx * cosine - gy * sine, t) + turn * gy,
        of="IIIC.1",
    )
    u = sympy.Symbol("u")
    whole = (t + u) / (1 - t * u)  # tangent of half the sum of the angles
    near, far = script.alter("weights of the neighbours exchanged", (u, t), (t, u))
    weights = 2 * near / (1 + near**2), 2 * far / (1 + far**2)
    inside = (r * weights[0] + s * weights[1]) / (2 * whole / (1 + whole**2))
    script.identity(
        "a spoke drawn into a sector, with the slope of the plane there, changes no K and bends 0",
        sector(r, s, whole) - sector(r, inside, t) - sector(inside, s, u),
        half_bend(inside, r, t) + half_bend(inside, s, u),
        of="IIIC.1",
    )
    script.identity(
        "the round cone rho_j = -1 has K(t, h) = -(1/2) sum_j b_j(h), and "
        "K(t) = sum_j tan(a_j / 2) > 0",
        sector(-1, -1, t) - script.alter("cotangent for tangent", t, 1 / t),
        of="IIIC.1",
    )


def _inequality(script: Script) -> None:
    """At a vertex that is popped down the valleys cannot all lie in a closed half-plane y >= 0."""
    x = sympy.Matrix(sympy.symbols("x1:4"))
    y = sympy.Matrix(sympy.symbols("y1:4"))
    s = script.alter("wrong sign of the spacelike part", -1, 1)
    script.identity(
        "(1, x), (1, y) with |x|, |y| <= 1: 2 (1 - x.y) = |x - y|^2 + (1 - |x|^2) + "
        "(1 - |y|^2), so B > 0 unless they are proportional",
        2 * (1 + s * x.dot(y)) - (x - y).dot(x - y) - (1 - x.dot(x)) - (1 - y.dot(y)),
        of="IIIC.1",
    )
    t = sympy.Symbol("t")
    slope = script.alter("the sheet bent down", 1, -1) * 2 * t / (1 + t**2)  # at the angle of t
    script.identity(
        "the line fold g = |y|: slopes 0 where it bends (along the line), so K(g) = 0; there "
        "each half contributes the bend 1 > 0: a valley, popped down",
        sector(0, slope, t) + sector(slope, 0, 1 / t),
        half_bend(0, slope, t) - 1,
        of="IIIC.1",
    )
    outcomes: list[bool] = []
    for pattern, hub, heights in _null_vectors():
        form = curvature_form(pattern, hub)
        for nx, ny in ((0, 1), (1, 0), (1, 2), (3, -1)):
            sides = {
                j: nx * x + ny * y
                for j in pattern.star(hub)
                for x, y in [_direction(pattern, hub, j)]
            }
            fold = {hub: Fraction(0), **{j: abs(y) for j, y in sides.items()}}
            bends = {j: _bend(pattern, hub, j, heights) for j in sides}
            fault = script.alter(f"half the mountains, {nx} {ny}", 2, 1) if not outcomes else 2
            below = sum(b * abs(sides[j]) for j, b in bends.items() if sides[j] < 0)
            outcomes += [
                2 * form.polar(fold, heights) == sum(b * fold[j] for j, b in bends.items()),
                sum(b * sides[j] for j, b in bends.items()) == 0,
                2 * form.polar(fold, heights) == fault * below,
            ]
    script.cases(
        "2 K(g, h) = sum b|y| = sum b y + 2 sum_(y < 0) b |y| and sum b y = 0 for the line fold g "
        "= |y|, b the bends over the lengths of the folds, on four null vectors and four lines: "
        "with all valleys in y >= 0 it is <= 0, while K(g, h) >= 0 if h is popped down; so h = c g",
        outcomes,
        of="IIIC.1",
    )


def _null_vectors() -> list[tuple[CreasePattern, int, dict[int, Fraction]]]:
    """The waterbomb and the vertex with a cross, popped up and down."""
    wheel = CreasePattern([*CROSS_SPOKES, (0, 0)], [(k, (k + 1) % 7, 7) for k in range(7)])
    found = [(families.waterbomb(), 6, h) for h in WATERBOMB.values()]
    crossed = [(wheel, 7, dict(enumerate(h))) for h in CROSS.values()]
    return [(p, v, {j: Fraction(x) for j, x in h.items()}) for p, v, h in (*found, *crossed)]


def _bend(pattern: CreasePattern, hub: int, j: int, heights: Mapping[int, Fraction]) -> Fraction:
    """The quotient b_j / L_j, which is rational, from the two sectors at a spoke."""
    ring, d = pattern.star(hub), {k: _direction(pattern, hub, k) for k in pattern.star(hub)}
    x = {k: heights[k] - heights[hub] for k in ring}
    size, total, at = d[j][0] ** 2 + d[j][1] ** 2, Fraction(0), ring.index(j)
    for k in (ring[at - 1], ring[(at + 1) % len(ring)]):
        turn = abs(d[j][0] * d[k][1] - d[j][1] * d[k][0])
        total += (x[k] - x[j] * (d[j][0] * d[k][0] + d[j][1] * d[k][1]) / size) / turn
    return total


def _directions(script: Script) -> None:
    """Directions in no closed half-plane contain a tripod or a cross."""
    size = 12
    least = script.alter("tripods only", 2, 1)
    fails = 0
    for count in range(1, 7):
        for subset in combinations(range(size), count):
            if not _in_half_plane(subset, size):
                kinds = (_has_tripod(subset, size), _has_cross(subset, size))
                fails += not any(kinds[:least])
    script.example(
        "a set of directions in no closed half-plane contains a tripod or a cross: all sets of at "
        "most 6 of 12 directions (minimal ones have at most 4, and every order of 4 directions "
        "and their opposites occurs among 8)",
        fails == 0,
        of="IIIC.2",
    )
    most = script.alter("three directions", 2, 3)
    script.certificate(
        "any two directions lie in a closed half-plane (all pairs of 12): valleys and mountains "
        "in no closed half-plane are at least 3 + 3 folds",
        all(_in_half_plane(pair, size) for pair in combinations(range(size), most)),
        of="IIIC.1",
    )


def _examples(script: Script) -> None:
    """The waterbomb, and the cross that replaces a bird's foot."""
    pattern = families.waterbomb()
    ring = pattern.star(6)
    flipped = script.alter("the same side twice", {+1: +1, -1: -1}, {+1: -1, -1: -1})
    outcome = []
    for side in (+1, -1):
        heights = {v: Fraction(x) for v, x in WATERBOMB[side].items()}
        outcome += [
            curvature_form(pattern, 6)(heights) == 0,
            assignment(pattern, 6, heights) == "MVMVMV",
            popped(pattern, 6, heights) == flipped[side],
        ]
    turns = [_direction(pattern, 6, j) for j in ring]
    feet = all(_positively_spans(turns[k::2]) and len(turns[k::2]) == 3 for k in (0, 1))
    script.counterexample(
        "the waterbomb base pops up and down with the same folds MVMVMV, and has both bird's feet",
        all(outcome) and feet,
        of="IIIC.1 IIIC.3 IIIA.20",
    )
    wheel = CreasePattern([*CROSS_SPOKES, (0, 0)], [(k, (k + 1) % 7, 7) for k in range(7)])
    valleys = [s for s, f in zip(CROSS_SPOKES, CROSS_FOLDS, strict=True) if f == "V"]
    outcome = []
    for side in (+1, -1):
        heights = {v: Fraction(x) for v, x in enumerate(CROSS[side])}
        outcome += [
            curvature_form(wheel, 7)(heights) == 0,
            assignment(wheel, 7, heights) == CROSS_FOLDS,
            popped(wheel, 7, heights) == side,
        ]
    foot = any(_positively_spans(triple) for triple in combinations(valleys, 3))
    script.counterexample(
        "a vertex of degree 7 pops both ways with the same folds VMVMVVM; its valleys are a cross "
        "and contain no bird's foot",
        all(outcome) and foot is script.alter("a bird's foot in the cross", False, True),
        against="IIIC.2",
    )
    script.state(
        "IIIC.1",
        "Section III C, after Fig. (mvexample1)",
        r"\text{``a vertex which can both pop up and pop down must have degree at least 6''}",
        note="with one and the same assignment, as the context says; proved here to second order, "
        "collinear folds included; attained by the waterbomb",
        words="theorem in proofs/mountain_valley.py",
    )
    script.state(
        "IIIC.2",
        "Section III C, after Fig. (mvexample1)",
        r"\text{``must contain both a mountain ``bird's foot'' and a valley bird's foot''}",
        r"\text{for each of the two signs a bird's foot of that sign or, if folds are collinear, a "
        r"cross of four folds of that sign}",
        "hub (0,0), spokes (1,0), (1,1), (0,1), (-1,1), (-1,0), (0,-1), (1,-2), folds VMVMVVM: "
        "heights (1,3,1,3,1,0,3) pop down, (-9,-9,-6,-1,-9,-6,-1) up. Holds as printed without "
        "collinear folds",
        severity=Severity.CONDITION,
        words="theorem in proofs/mountain_valley.py",
    )
    narrow = star((1, 0), (1, 1), (0, 1), (-1, -2))
    letters = {b.assignment_text for b in count_branches(narrow).branches}
    odd = script.alter("the last of the three counted as the odd one", "VVVM", "MVVV")
    script.counterexample(
        "spokes (1,0), (1,1), (0,1), (-1,-2): no branch is VVVM or MMMV, although the angles from "
        "the first to the second and from the second to the third are below pi",
        letters.isdisjoint({odd, odd.translate(str.maketrans("MV", "VM"))}) and len(letters) == 2,
        against="IIIC.6",
    )
    script.state(
        "IIIC.6",
        "Section III C, definition of a bird's foot",
        r"\text{``a sequence of four not-necessarily adjacent folds }c_1,c_2,c_3,c_4\text{ "
        r"in counter-clockwise order around the vertex such that the angles between "
        r"}c_1,c_2,c_3\text{ are between 0 and }\pi\text{ and }c_1,c_2,c_3\text{ have the "
        r"same sign (all mountains or all valleys) and }c_4\text{ has the opposite sign''}",
        r"\text{the three angles from }c_1\text{ to }c_2\text{, from }c_2\text{ to }c_3\text{ and "
        r"from }c_3\text{ to }c_1\text{ are between 0 and }\pi",
        "which angles are meant is not said. With the first two alone three folds within a right "
        "angle would do, and no vertex folds so. "
        "Remark: the third holds c_4: the directions of one sign "
        "lie in no closed half-plane",
        severity=Severity.CONDITION,
        words="theorem in proofs/mountain_valley.py",
    )
    script.state(
        "IIIC.3",
        "Section III C",
        r"\text{``the waterbomb vertex contains both a mountain bird's foot and a valley bird's "
        r"foot''}",
        code="families.waterbomb",
    )
    script.state(
        "IIIA.20",
        "Section III A, last paragraph",
        r"\text{``the 6-fold origami vertex with alternating mountain and valley folds "
        r"(MVMVMV in cyclic order around the vertex)'' \dots\ ``the distribution of "
        r"mountain and valley folds do not distinguish different branches in configuration "
        r"space''}",
        note="Remark: heights (-3,-3,1,-2,-2,-3) and (3,3,3,2,2,-1) at the ends of its folds in "
        "ccw order: same folds, one popped up, one popped down. As D = 3 both lie on one branch",
    )


def assignment(pattern: CreasePattern, hub: int, heights: Mapping[int, Fraction]) -> str:
    """The letters M, V, F of the folds at a hub, counter-clockwise."""
    letters = []
    for j in pattern.star(hub):
        weights = fold_functional(pattern, (min(hub, j), max(hub, j)))
        bend = sum(w * heights[v] for v, w in weights.items())
        letters.append("V" if bend > 0 else "M" if bend < 0 else "F")
    return "".join(letters)


def popped(pattern: CreasePattern, hub: int, heights: Mapping[int, Fraction]) -> int:
    """+1 popped up, -1 popped down, 0 flat."""
    value = sum(w * heights[v] for v, w in vertex_sign_functional(pattern, hub).items())
    return (value > 0) - (value < 0)


def _direction(pattern: CreasePattern, hub: int, j: int) -> tuple[Fraction, Fraction]:
    (x, y), (a, b) = pattern.vertices[j], pattern.vertices[hub]
    return x - a, y - b


def _positively_spans(d: Sequence[tuple[Fraction | int, Fraction | int]]) -> bool:
    """Whether counter-clockwise directions have all angles between neighbours in (0, pi)."""
    pairs = zip(d, [*d[1:], d[0]], strict=True)
    return all(a[0] * b[1] - a[1] * b[0] > 0 for a, b in pairs)


def _in_half_plane(subset: Sequence[int], size: int) -> bool:
    return any(all((k - start) % size <= size // 2 for k in subset) for start in range(size))


def _has_tripod(subset: Sequence[int], size: int) -> bool:
    return any(
        all(0 < (b - a) % size < size // 2 for a, b in ((p, q), (q, r), (r, p)))
        for p, q, r in combinations(sorted(subset), 3)
    )


def _has_cross(subset: Sequence[int], size: int) -> bool:
    pairs = [k for k in subset if k < size // 2 and (k + size // 2) in subset]
    return len(pairs) >= 2


if __name__ == "__main__":
    sys.exit(run(prove()))
