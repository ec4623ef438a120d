"""Isolating boxes: disjointness against brute force, reality, intervals."""

from __future__ import annotations

from fractions import Fraction

from hypothesis import given
from hypothesis import strategies as st

from exactfold.solve.certify.box import IsolatingBox, Uncertified

small = st.integers(-12, 12)


@st.composite
def boxes(draw: st.DrawFn) -> IsolatingBox:
    n = 2
    real = tuple(draw(small) for _ in range(n))
    imag = draw(st.sampled_from([(), (draw(small), draw(small))]))
    return IsolatingBox(real, imag, draw(st.integers(0, 6)), draw(st.integers(0, 3)))


def sides(box: IsolatingBox) -> list[tuple[Fraction, Fraction]]:
    """The box as 2n intervals; a real box lies in imaginary part zero."""
    scale = 1 << box.bits
    parts = [(c - box.radius, c + box.radius) for c in (*box.real, *box.imag)]
    parts += [(0, 0)] * (2 * len(box.real) - len(parts))
    return [(Fraction(low, scale), Fraction(high, scale)) for low, high in parts]


def grid(box: IsolatingBox) -> list[set[Fraction]]:
    """All multiples of 1/8 in each side: end points are multiples of 1/8 as bits <= 3."""
    step = Fraction(1, 8)
    return [{step * k for k in range(int(low * 8), int(high * 8) + 1)} for low, high in sides(box)]


@given(boxes(), boxes())
def test_disjointness_against_brute_force(a: IsolatingBox, b: IsolatingBox) -> None:
    # Real boxes are thick in no imaginary direction, so they meet a complex box on the real plane.
    common = all(x & y for x, y in zip(grid(a), grid(b), strict=True))
    if a.is_disjoint_from(b):
        assert not common  # what is claimed disjoint has no common point
    if a.is_real == b.is_real:
        assert a.is_disjoint_from(b) == (not common)
    assert a.is_disjoint_from(b) == b.is_disjoint_from(a)


@given(boxes())
def test_a_box_meets_itself_and_finer_copies(box: IsolatingBox) -> None:
    finer = IsolatingBox(
        tuple(4 * x for x in box.real),
        tuple(4 * x for x in box.imag),
        4 * box.radius,
        box.bits + 2,
    )
    assert not box.is_disjoint_from(box)
    assert not box.is_disjoint_from(finer)
    assert [box.interval(k) for k in (0, 1)] == [finer.interval(k) for k in (0, 1)]
    assert (box.is_real, box.is_nonreal) == (finer.is_real, finer.is_nonreal)


@given(boxes())
def test_reality_is_never_claimed_twice(box: IsolatingBox) -> None:
    assert not (box.is_real and box.is_nonreal)
    meets_the_real_plane = all(low <= 0 <= high for low, high in sides(box)[2:])
    assert box.is_nonreal == (not meets_the_real_plane)


def test_touching_boxes_are_not_disjoint() -> None:
    assert not IsolatingBox((0,), (), 1, 0).is_disjoint_from(IsolatingBox((2,), (), 1, 0))
    assert IsolatingBox((0,), (), 1, 0).is_disjoint_from(IsolatingBox((9,), (), 1, 2))


def test_conjugate_boxes_are_disjoint_if_nonreal() -> None:
    upper, lower = IsolatingBox((5,), (3,), 2, 4), IsolatingBox((5,), (-3,), 2, 4)
    assert upper.is_nonreal
    assert upper.is_disjoint_from(lower)


def test_uncertified_keeps_the_point_and_the_reason() -> None:
    result = Uncertified((1j,), "no contraction")
    assert result.point == (1j,)
    assert result.reason == "no contraction"


@given(boxes(), boxes())
def test_inclusion_against_brute_force(a: IsolatingBox, b: IsolatingBox) -> None:
    if a.is_real != b.is_real:
        return
    included = all(
        c <= low and high <= d for (low, high), (c, d) in zip(sides(a), sides(b), strict=True)
    )
    assert a.is_inside(b) == included
    assert a.is_inside(a)
    if included:
        assert not a.is_disjoint_from(b)
