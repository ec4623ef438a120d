"""One suite for every certifier: boxes are right, narrow, and refused where there is no proof.

They are listed in tests/certifiers.py: exact Krawczyk in integers, interval Newton on mpmath, and
Krawczyk's operator on Arb's balls.
"""

from __future__ import annotations

import random
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from certifiers import CERTIFIERS, Certify, Decide
from known_systems import (
    CIRCLE_AND_AXES,
    Root,
    approx,
    circle_and_axes,
    conjugate_pair,
    contains,
    is_real,
    magnitude,
    radius,
    random_pairs,
    real_pair,
    roots_of,
    system_of,
)
from sampling import slow_after

from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED
from exactfold.errors import UsageError
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.certify.box import IsolatingBox, Uncertified

NAMES = list(map(str, CERTIFIERS))
every = pytest.mark.parametrize("certify", [c.certify for c in CERTIFIERS], ids=NAMES)
every_decider = pytest.mark.parametrize("decide", [c.decide for c in CERTIFIERS], ids=NAMES)


def check_all(certify: Certify, system: QuadraticSystem, roots: list[Root]) -> None:
    """Each root gets a box of its own, which is narrow and holds it and no other root."""
    boxes = certify(system, np.array([approx(root) for root in roots]))
    assert len(boxes) == len(roots)
    for box, root in zip(boxes, roots, strict=True):
        assert isinstance(box, IsolatingBox), box
        assert contains(box, root)
        assert sum(contains(box, other) for other in roots) == 1
        assert radius(box) <= Fraction(1, 10**15) * max(Fraction(1), magnitude(root))
        assert box.is_real == is_real(root)
        assert box.is_nonreal != is_real(root)
    for i, box in enumerate(boxes):
        for other in boxes[:i]:
            assert isinstance(box, IsolatingBox)
            assert isinstance(other, IsolatingBox)
            assert box.is_disjoint_from(other)
            assert other.is_disjoint_from(box)


@every
def test_circle_and_line_pair(certify: Certify) -> None:
    check_all(certify, CIRCLE_AND_AXES, circle_and_axes())


@every
@pytest.mark.parametrize("n", [1, 2, 3, 4])
@pytest.mark.parametrize("seed", [0, 1])
def test_products_of_rational_forms(certify: Certify, n: int, seed: int) -> None:
    pairs = random_pairs(seed, n)
    check_all(certify, system_of(pairs), roots_of(pairs))


@every
@pytest.mark.parametrize("n", [1, 2, 3])
def test_nonreal_zeros_over_the_gaussian_rationals(certify: Certify, n: int) -> None:
    pairs = random_pairs(10 + n, n, conjugate=(n + 1) // 2)
    roots = roots_of(pairs)
    assert not all(map(is_real, roots))
    check_all(certify, system_of(pairs), roots)


@every
@pytest.mark.parametrize("seed", range(5))
def test_planted_root_of_a_random_system(certify: Certify, seed: int) -> None:
    source = random.Random(seed)
    n = 5
    root = [Fraction(source.randint(-50, 50), source.randint(1, 50)) for _ in range(n)]
    matrices = []
    for _ in range(n):
        matrix = [[Fraction(source.randint(-99, 99)) for _ in range(n + 1)] for _ in range(n + 1)]
        matrix = [[matrix[i][j] + matrix[j][i] for j in range(n + 1)] for i in range(n + 1)]
        z = [*root, Fraction(1)]
        matrix[n][n] -= sum(a * matrix[i][j] * b for i, a in enumerate(z) for j, b in enumerate(z))
        matrices.append(matrix)
    system = QuadraticSystem.from_rational(matrices)
    assert system.values_at(root) == [0] * n
    check_all(certify, system, [tuple((x, Fraction(0)) for x in root)])


@every
def test_coefficients_of_seventy_bits(certify: Certify) -> None:
    source = random.Random(7)
    big = [source.randint(2**69, 2**70) * source.choice((1, -1)) for _ in range(12)]
    forms = [tuple(Fraction(x) for x in big[k : k + 3]) for k in range(0, 12, 3)]
    pairs = [real_pair(forms[0], forms[1]), real_pair(forms[2], forms[3])]
    check_all(certify, system_of(pairs), roots_of(pairs))


@every
def test_unknowns_of_very_different_size(certify: Certify) -> None:
    one, zero, big = Fraction(1), Fraction(0), Fraction(2**70 + 12345)
    pairs = [
        real_pair((one, zero, -big), (one, zero, big + 3)),
        real_pair((one, one, -7 * one), (one, -2 * one, one / 3)),
    ]
    check_all(certify, system_of(pairs), roots_of(pairs))


def cluster(gap: Fraction) -> tuple[QuadraticSystem, list[Root]]:
    """Two zeros at distance `gap` near (1/3, 2/7), and two others."""
    one, zero = Fraction(1), Fraction(0)
    first, second = (one, one, Fraction(-13, 21)), (one, one, Fraction(-13, 21) - gap)
    pairs = [
        real_pair((one, -one, Fraction(-1, 21)), (one, zero, 5 * one)),
        real_pair(first, second),
    ]
    return system_of(pairs), roots_of(pairs)


@every
def test_cluster_at_distance_1e_8(certify: Certify) -> None:
    system, roots = cluster(Fraction(2, 10**8))
    check_all(certify, system, roots)


@every
def test_cluster_below_double_precision_gives_a_true_box_or_none(certify: Certify) -> None:
    system, roots = cluster(Fraction(1, 10**20))
    for result in certify(system, np.array([approx(root) for root in roots])):
        if isinstance(result, IsolatingBox):
            assert sum(contains(result, root) for root in roots) == 1


def nonreal_cluster(gap: Fraction) -> tuple[QuadraticSystem, list[Root]]:
    """x = +-i, and x + y is 1/3 or 1/3 + gap: two pairs of non-real zeros at distance `gap`."""
    one, zero = Fraction(1), Fraction(0)
    pairs = [
        conjugate_pair((one, zero, zero), (zero, zero, one)),
        real_pair((one, one, -one / 3), (one, one, -one / 3 - gap)),
    ]
    return system_of(pairs), roots_of(pairs)


@every
@pytest.mark.parametrize("digits", [8, 12, 16, 20, 30, 60])
@pytest.mark.parametrize("build", [cluster, nonreal_cluster])
def test_cluster_from_exact_candidates(
    certify: Certify, build: Callable[[Fraction], Any], digits: int
) -> None:
    system, roots = build(Fraction(1, 10**digits))
    nudge = Fraction(1, 10 ** (digits + 2))
    candidates = [[(re + nudge, im) for re, im in root] for root in roots]
    boxes = certify(system, candidates)
    for box, root in zip(boxes, roots, strict=True):
        assert isinstance(box, IsolatingBox), box
        assert [contains(box, other) for other in roots].count(True) == 1
        assert contains(box, root)
        assert (box.is_real, box.is_nonreal) == (is_real(root), not is_real(root))
        assert radius(box) < nudge * 100


@every
@pytest.mark.parametrize("digits", [4, 15, 31, 60])
@pytest.mark.parametrize("sign", [1, -1])
def test_nearly_double_zero(certify: Certify, digits: int, sign: int) -> None:
    """(x - 1/3)^2 = +-10^(-2 digits) and y = x^2: zeros at distance 2 10^-digits, real or not."""
    gap, third = Fraction(1, 10**digits), Fraction(1, 3)
    system = QuadraticSystem.from_rational(
        [
            [[1, 0, -third], [0, 0, 0], [-third, 0, third**2 - sign * gap**2]],
            [[1, 0, 0], [0, 0, Fraction(-1, 2)], [0, Fraction(-1, 2), 0]],
        ]
    )
    near = Fraction(99, 100) * gap
    x = (third + near, Fraction(0)) if sign > 0 else (third, near)
    y = (x[0] ** 2 - x[1] ** 2, 2 * x[0] * x[1])
    (box,) = certify(system, [[x, y]])
    (middle,) = certify(system, [[third, third**2]])
    assert isinstance(box, IsolatingBox), box
    assert (box.is_real, box.is_nonreal) == (sign > 0, sign < 0)
    root = third + gap if sign > 0 else third
    assert abs(Fraction(box.real[0], 1 << box.bits) - root) <= radius(box) < gap / 100
    assert isinstance(middle, Uncertified) or sign > 0  # no zero between two that are not real


@every
@pytest.mark.parametrize("seed", range(3))
def test_ill_scaled_systems(certify: Certify, seed: int) -> None:
    """Unknowns in units of 10^12, 1 and 10^-12, equations in units of 1, 10^40 and 10^-40."""
    units = [Fraction(10) ** k for k in (12, 0, -12)]
    factors = [Fraction(10) ** k for k in (0, 40, -40)]
    pairs = []
    for (first, second), factor in zip(random_pairs(50 + seed, 3), factors, strict=True):
        scaled = [
            tuple(c / u for c, u in zip(form[0], [*units, Fraction(1)], strict=True))
            for form in (first, second)
        ]
        pairs.append(real_pair(tuple(factor * c for c in scaled[0]), scaled[1]))
    system, roots = system_of(pairs), roots_of(pairs)
    boxes = certify(system, [[x for x, _ in root] for root in roots])
    for box, root in zip(boxes, roots, strict=True):
        assert isinstance(box, IsolatingBox), box
        assert contains(box, root)
        assert sum(contains(box, other) for other in roots) == 1


DOUBLE: list[tuple[list[list[list[Any]]], list[float]]] = [
    ([[[1, 0], [0, 0]]], [0.0]),
    ([[[9, -3], [-3, 1]]], [1 / 3]),
    ([[[1, 0, 0], [0, 1, 0], [0, 0, -1]], [[0, 0, 0], [0, 0, 1], [0, 1, -2]]], [0.0, 1.0]),
    ([[[1, 0, 0], [0, 1, 0], [0, 0, -1]]] * 2, [0.6, 0.8]),
    ([[[0, 0], [0, 0]]], [0.5]),
]


@every
@pytest.mark.parametrize("offset", [0.0, 1e-300, 1e-40, 1e-12, 1e-5, 1e-3 + 1e-3j, 1e-9j])
@pytest.mark.parametrize("case", range(5))
def test_multiple_zero_is_refused(certify: Certify, case: int, offset: complex) -> None:
    matrices, point = DOUBLE[case]
    system = QuadraticSystem.from_rational(matrices)
    (result,) = certify(system, [[x + offset for x in point]])
    assert isinstance(result, Uncertified)
    assert result.reason
    assert len(result.point) == system.size


@every
@pytest.mark.parametrize("point", [0.3, 0.0, 1e-3, 2.0 + 1e-12j, -5.0])
def test_real_candidate_without_a_real_zero(certify: Certify, point: complex) -> None:
    (result,) = certify(QuadraticSystem.from_rational([[[1, 0], [0, 1]]]), [[point]])
    assert isinstance(result, Uncertified) or not result.is_real


@every
def test_constants_have_no_zeros(certify: Certify) -> None:
    system = QuadraticSystem.from_rational([[[0, 0], [0, 1]]])
    (result,) = certify(system, [[0.5]])
    assert isinstance(result, Uncertified)


@every
@pytest.mark.parametrize("seed", slow_after(4, range(10)))
def test_wrong_candidates_give_a_true_box_or_none(certify: Certify, seed: int) -> None:
    source = random.Random(seed)
    pairs = random_pairs(100 + seed, 2, conjugate=seed % 2)
    system, roots = system_of(pairs), roots_of(pairs)
    points = [[complex(source.gauss(0, 5), source.gauss(0, 5)) for _ in range(2)] for _ in range(6)]
    points += [[complex(source.gauss(0, 5)) for _ in range(2)] for _ in range(6)]
    for result in certify(system, points):
        if isinstance(result, IsolatingBox):
            assert sum(contains(result, root) for root in roots) == 1


@every
def test_candidate_far_from_every_zero_is_refused(certify: Certify) -> None:
    wrong = [[1000.0, -993.0], [300.0, 4e5], [0.9, 0.5], [1.0, 0.1], [1 + 0.1j, 0.0], [1j, 2j]]
    for result in certify(CIRCLE_AND_AXES, wrong):
        assert isinstance(result, Uncertified), result
    (box,) = certify(CIRCLE_AND_AXES, [[1.0, 0.1]], reach=None)
    assert isinstance(box, IsolatingBox)
    assert contains(box, circle_and_axes()[0])


@every
@pytest.mark.parametrize("offset", [Fraction(1, 70), Fraction(1, 60)])
def test_reach_is_an_exact_bound(certify: Certify, offset: Fraction) -> None:
    (result,) = certify(CIRCLE_AND_AXES, [[1 + offset, offset]])
    assert isinstance(result, IsolatingBox) == (offset <= Fraction(1, 64) * (1 + offset))


@every
@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, complex(0, np.nan), complex(1, np.inf)])
def test_candidates_that_are_not_finite(certify: Certify, bad: complex) -> None:
    good = [1.0, 0.0]
    first, second, third = certify(CIRCLE_AND_AXES, np.array([good, [bad, 1.0], [0.0, 1.0]]))
    assert isinstance(first, IsolatingBox)
    assert isinstance(second, Uncertified)
    assert "not finite" in second.reason
    assert isinstance(third, IsolatingBox)


@every
def test_huge_candidates_do_not_break(certify: Certify) -> None:
    for result in certify(CIRCLE_AND_AXES, np.array([[1e300, 1e300], [1e-300, 1.0 + 1e-300]])):
        if isinstance(result, IsolatingBox):
            assert contains(result, circle_and_axes()[2])


@every
def test_no_candidates(certify: Certify) -> None:
    assert certify(CIRCLE_AND_AXES, np.empty((0, 2))) == []


@every
def test_no_equation_has_one_zero_and_wrong_rows_are_refused(certify: Certify) -> None:
    assert certify(QuadraticSystem(()), [[]]) == [IsolatingBox((), (), 1, 0)]
    with pytest.raises(UsageError, match="1 coordinates, not 2"):
        certify(CIRCLE_AND_AXES, [[1.0]])
    (result,) = certify(CIRCLE_AND_AXES, [[1.0, 0.0]], precisions=())
    assert isinstance(result, Uncertified)
    assert "no precision" in result.reason


@pytest.mark.parametrize("conjugate", [0, 1, 3])
def test_each_certifier_confirms_the_boxes_of_the_others(conjugate: int) -> None:
    pairs = random_pairs(5, 3, conjugate=conjugate)
    system, roots = system_of(pairs), roots_of(pairs)
    points = np.array([approx(root) for root in roots])
    found = [certifier.certify(system, points) for certifier in CERTIFIERS]
    for boxes in zip(*found, strict=True):
        for box in boxes:
            assert isinstance(box, IsolatingBox)
            assert box.is_real == boxes[0].is_real  # type: ignore[union-attr]
            assert not box.is_disjoint_from(boxes[0])  # type: ignore[arg-type]
            assert {certifier.decide(system, box) for certifier in CERTIFIERS} == {PROVED}


# --- given boxes ---------------------------------------------------------------------------------


def box_about(
    root: Root, r: Fraction, bits: int = 12, *, nonreal: bool = False, shift: int = 0
) -> IsolatingBox:
    """A box whose centre is the root rounded to 2^-bits, moved by `shift` of these."""
    scale = 1 << bits
    real = tuple(round(re * scale) + shift for re, _ in root)
    imag = tuple(round(im * scale) + shift for _, im in root)
    return IsolatingBox(real, imag if nonreal else (), round(r * scale), bits)


ONE_ZERO = circle_and_axes()[0]  # (1, 0); the others are at distance 1 or more


@every_decider
@pytest.mark.parametrize("nonreal", [False, True])
def test_box_that_is_right_is_proved(decide: Decide, nonreal: bool) -> None:
    for r in (Fraction(1, 10), Fraction(1, 1000)):
        assert decide(CIRCLE_AND_AXES, box_about(ONE_ZERO, r, nonreal=nonreal)) is PROVED
    off_centre = box_about(ONE_ZERO, Fraction(1, 10), nonreal=nonreal, shift=200)
    assert decide(CIRCLE_AND_AXES, off_centre) is PROVED


@every_decider
@pytest.mark.parametrize("nonreal", [False, True])
@pytest.mark.parametrize("r", [Fraction(6, 10), Fraction(9, 10)])
def test_box_that_is_right_but_too_wide_is_refused(
    decide: Decide, r: Fraction, nonreal: bool
) -> None:
    """It holds one zero, but also a point (t, t) where the Jacobian is singular."""
    box = box_about(ONE_ZERO, r, nonreal=nonreal)
    assert sum(contains(box, root) for root in circle_and_axes()) == 1
    assert decide(CIRCLE_AND_AXES, box) is UNDECIDED


@every_decider
@pytest.mark.parametrize("nonreal", [False, True])
def test_box_with_more_zeros_or_none(decide: Decide, nonreal: bool) -> None:
    zero, far = (Fraction(0), Fraction(0)), (Fraction(700), Fraction(0))
    several = box_about((zero, zero), Fraction(11, 10), nonreal=nonreal)
    assert decide(CIRCLE_AND_AXES, several) is UNDECIDED
    nothing = box_about((far, zero), Fraction(1, 2), nonreal=nonreal)
    assert decide(CIRCLE_AND_AXES, nothing) is REFUTED


@every_decider
def test_box_that_the_zero_touches_is_not_proved(decide: Decide) -> None:
    """The zero is on the boundary: it is in the closed box, but no test can tell."""
    box = IsolatingBox((5, 0), (), 1, 2)  # |x - 5/4| <= 1/4, |y| <= 1/4
    assert contains(box, ONE_ZERO)
    assert decide(CIRCLE_AND_AXES, box) is UNDECIDED
    point = IsolatingBox((1, 0), (), 0, 0)
    assert decide(CIRCLE_AND_AXES, point) is UNDECIDED


@every_decider
@pytest.mark.parametrize("case", range(5))
@pytest.mark.parametrize("nonreal", [False, True])
def test_box_about_a_double_zero_is_refused(decide: Decide, case: int, nonreal: bool) -> None:
    matrices, point = DOUBLE[case]
    system = QuadraticSystem.from_rational(matrices)
    root = tuple((Fraction(x).limit_denominator(100), Fraction(0)) for x in point)
    for bits, r in ((20, Fraction(1, 100)), (300, Fraction(1, 10**80))):
        assert decide(system, box_about(root, r, bits, nonreal=nonreal)) is UNDECIDED


@every_decider
@pytest.mark.parametrize("digits", [8, 20, 30])
def test_box_about_a_cluster(decide: Decide, digits: int) -> None:
    gap = Fraction(1, 10**digits)
    for system, roots in (cluster(gap), nonreal_cluster(gap)):
        root = min(roots, key=lambda r: abs(r[0][0] - Fraction(1, 3)) + abs(r[1][0]))
        (other,) = (
            r
            for r in roots
            if r != root
            and abs(r[1][0] - root[1][0]) <= gap
            and abs(r[0][0] - root[0][0]) <= gap
            and r[0][1] == root[0][1]
        )
        nonreal = not is_real(root)
        narrow = box_about(root, gap / 100, 5 * digits, nonreal=nonreal)
        wide = box_about(root, gap * 2, 5 * digits, nonreal=nonreal)
        assert contains(wide, other)
        assert not contains(narrow, other)
        assert (decide(system, narrow), decide(system, wide)) == (PROVED, UNDECIDED)


@every_decider
@pytest.mark.parametrize("seed", range(4))
def test_verdicts_on_random_boxes_are_true(decide: Decide, seed: int) -> None:
    """Every verdict against the known zeros; all three occur."""
    source = random.Random(seed)
    pairs = random_pairs(200 + seed, 2, conjugate=seed % 2)
    system, roots = system_of(pairs), roots_of(pairs)
    seen = set()
    for _ in range(40):
        root, bits = source.choice(roots), source.choice((4, 10, 40))
        r, shift = (
            Fraction(source.randint(1, 64), 1 << source.choice((4, 9))),
            source.randint(-9, 9),
        )
        box = box_about(root, r, bits, nonreal=not is_real(root), shift=shift)
        verdict = decide(system, box)
        inside = sum(contains(box, other) for other in roots)
        assert inside == 1 or verdict is not PROVED
        assert inside == 0 or verdict is not REFUTED
        seen.add(verdict)
    assert {PROVED, REFUTED, UNDECIDED} <= seen


@every_decider
def test_no_equation(decide: Decide) -> None:
    assert decide(QuadraticSystem(()), IsolatingBox((), (), 1, 0)) is PROVED
