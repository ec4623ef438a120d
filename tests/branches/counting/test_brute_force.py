"""Proven counts against brute force in SymPy, for one and two vertices."""

from fractions import Fraction
from itertools import product

import pytest
import sympy
from counting import counts
from sheets import dart, random_wheel, reflex_corners, scrambled, star_in, wheel, with_point

from exactfold import random_square
from exactfold.branches import count_branches
from exactfold.pattern.families import FAMILIES, single_vertex, two_vertex


def brute_force_system(pattern):
    """Curvature polynomials in the interior heights, by angles between spokes alone (SymPy).

    Twice the second-order angle deficit: sum over faces of the expansion of the angle at v. The
    first corner with weight in the affine dependency of the boundary is at height 1, others at 0.
    """
    corners = pattern.boundary
    plane = sympy.Matrix([[1, *map(to_sympy, pattern.vertices[v])] for v in corners])
    (dependency,) = plane.T.nullspace()
    unit = next(v for v, weight in zip(corners, dependency, strict=True) if weight != 0)
    unknowns = sympy.symbols(f"h0:{pattern.Vi}")
    height = dict.fromkeys(corners, sympy.Integer(0)) | {unit: sympy.Integer(1)}
    height |= dict(zip(pattern.interior, unknowns, strict=True))
    forms = []
    for v in pattern.interior:
        total = sympy.Integer(0)
        for face in pattern.triangles:
            if v not in face:
                continue
            k = face.index(v)
            a, b = (
                [
                    to_sympy(p - q)
                    for p, q in zip(pattern.vertices[u], pattern.vertices[v], strict=True)
                ]
                for u in (face[(k + 1) % 3], face[(k + 2) % 3])
            )
            x, y = height[face[(k + 1) % 3]] - height[v], height[face[(k + 2) % 3]] - height[v]
            cross, dot = a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]
            squares = x**2 / (a[0] ** 2 + a[1] ** 2) + y**2 / (b[0] ** 2 + b[1] ** 2)
            total += (2 * x * y - dot * squares) / cross
        forms.append(sympy.expand(total))
    return forms, unknowns


def to_sympy(x):
    return sympy.Rational(x.numerator, x.denominator)


def brute_wheels():
    patterns = [random_wheel(seed, 4) for seed in range(6)]
    patterns += [star_in(reflex_corners(seed)) for seed in range(4)]
    return [*patterns, dart(), wheel([(1, 0), (0, 2), (-3, 0), (0, -1)])]


@pytest.mark.parametrize("pattern", brute_wheels())
def test_one_vertex_against_the_quadratic_formula(pattern):
    (form,), (h,) = brute_force_system(pattern)
    a, b, c = sympy.Poly(form, h).all_coeffs()
    assert a != 0
    assert b * b - 4 * a * c > 0
    roots = sorted((-b + s * sympy.sqrt(b * b - 4 * a * c)) / (2 * a) for s in (1, -1))
    result = count_branches(pattern)
    assert counts(result) == (2, 2, 2, 0)
    boxes = sorted(branch.heights[pattern.interior[0]] for branch in result.branches)
    for root, (low, high) in zip(roots, boxes, strict=True):
        assert to_sympy(low) <= root <= to_sympy(high)
        assert high - low < Fraction(1, 10**9) * (1 + abs(low))


def brute_pairs():
    patterns = [random_square(2, seed=s, denominator=16) for s in range(4)]
    patterns += [two_vertex(), scrambled(3, reflex_corners(3), 2, loose=True)]
    return [*patterns, FAMILIES["flat-vertex"]()]


@pytest.mark.parametrize("pattern", brute_pairs())
def test_two_vertices_against_a_resultant(pattern):
    (first, second), (x, y) = brute_force_system(pattern)
    resultant = sympy.Poly(sympy.resultant(first, second, y), x)
    result = count_branches(pattern)
    assert resultant.degree() == result.with_multiplicity == 4
    assert resultant.count_roots() == len({*resultant.real_roots()}) == result.real
    v = pattern.interior[0]
    for branch in result.branches:
        low, high = (to_sympy(bound) for bound in branch.heights[v])
        multiplicity = [
            m for r, m in sympy.Poly(resultant, x).sqf_list()[1] if r.count_roots(low, high)
        ]
        assert multiplicity == [branch.multiplicity]


def test_multiplicities_agree_with_the_full_system():
    """The roots without rigid parts have multiplicity 2^Vt: the quotient of the full ideal has
    dimension 2^Vi, and its radical 2^(Vi - Vt)."""
    pattern = with_point(single_vertex(4), 1, (1, 2, 3))
    forms, unknowns = brute_force_system(pattern)
    basis = sympy.groebner(forms, *unknowns, order="grevlex")
    assert basis.is_zero_dimensional
    leading = [sympy.Poly(g, *unknowns).monoms(order="grevlex")[0] for g in basis.exprs]
    standard = [
        m
        for m in product(range(8), repeat=2)
        if not any(all(a >= b for a, b in zip(m, lead, strict=True)) for lead in leading)
    ]
    result = count_branches(pattern)
    assert len(standard) == result.with_multiplicity == 4
    assert result.distinct == 2
