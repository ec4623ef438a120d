"""Exact coordinates: the field that was meant is found, said, and not found where there is none."""

import random
from fractions import Fraction
from math import cos, pi, sin, sqrt

import numpy as np
import pytest

from exactfold.errors import MalformedPatternError, UsageError
from exactfold.exact.surds import RATIONALS, Surd
from exactfold.pattern.drawing.candidates import candidates, field_of, matches, reduced_match
from exactfold.pattern.drawing.construction import directions
from exactfold.pattern.drawing.coordinates import exact_coordinates, resolution
from exactfold.pattern.drawing.drawing import Drawing, Line

SQUARE = ((0, 0), (1, 0), (1, 1), (0, 1))
TWO, THREE, FIVE = (RATIONALS.adjoined(d).root for d in (2, 3, 5))


def decimal(number, digits):
    return Fraction(f"{float(number):.{digits}f}")


def drawn(points, digits, scale=1, shift=(0, 0), lines=()):
    """The points as a drawing program writes them, so many decimals each."""
    x0, y0 = shift
    return Drawing(
        tuple(
            (decimal(x * scale + x0, digits), decimal(y * scale + y0, digits)) for x, y in points
        ),
        tuple(Line(i, j, letter) for i, j, letter in lines),
        "a test",
    )


@pytest.mark.parametrize(
    ("points", "radicand"),
    [
        ([(Fraction(1, 3), Fraction(2, 7)), (Fraction(5, 12), Fraction(1, 6))], 1),
        ([(TWO - 1, 0), (1 - TWO / 2, TWO - 1)], 2),
        ([(THREE / 3, 0), (Fraction(1, 2), THREE / 6)], 3),
        ([((FIVE - 1) / 2, 0), ((3 - FIVE) / 2, 1)], 5),
    ],
)
@pytest.mark.parametrize("digits", [10, 15])
def test_designs_in_each_field_are_read_as_they_were_meant(points, radicand, digits):
    points = [*SQUARE, *points]
    found = exact_coordinates(drawn(points, digits))
    assert list(found.points) == points
    assert found.radicand == radicand
    assert found.unit == 1
    assert found.kept == ()
    assert 0 < found.largest_move < 10.0**-digits
    assert f"in {found.field_name}, " in found.text
    assert "largest move" in found.text


def test_rational_coordinates_are_fractions_and_irrational_ones_surds_of_one_field():
    found = exact_coordinates(drawn([*SQUARE, (TWO - 1, Fraction(1, 3))], 12))
    assert [type(c) for c in found.points[4]] == [Surd, Fraction]
    assert all(type(c) is Fraction for point in found.points[:4] for c in point)
    fields = {c.field for point in found.points for c in point if isinstance(c, Surd)}
    assert fields == {RATIONALS.adjoined(2)}


def test_pixels_become_units_of_the_width():
    points = [*SQUARE, (TWO - 1, 0), (0, TWO / 2), (1 - TWO / 2, 1)]
    found = exact_coordinates(drawn(points, 9, scale=737, shift=(Fraction("41.5"), -13)))
    assert list(found.points) == points
    assert (found.unit, found.origin) == (737, (Fraction("41.5"), -13))
    assert "in units of 737 from (41.5, -13)" in found.text


@pytest.mark.parametrize(("digits", "tolerance"), [(4, "1e-4"), (5, "1e-5"), (8, "1e-8")])
def test_the_tolerance_is_the_last_digit_of_the_file(digits, tolerance):
    points = [*SQUARE, (Fraction(1, 3), 0), (Fraction(2, 3), 1), (0, Fraction(1, 6))]
    found = exact_coordinates(drawn(points, digits))
    assert found.tolerance == Fraction(tolerance)
    assert list(found.points) == points
    assert f"tolerance {float(tolerance):.1g}" in found.text


def test_noise_beyond_the_last_digits_asks_for_a_coarser_tolerance():
    """Single precision written with 17 digits: off by 1e-8, and the report says 1e-7."""
    noise = Fraction(3, 10**8)
    points = [*SQUARE, *((Fraction(k, 7), Fraction(k, 9)) for k in range(1, 7))]
    moved = [(x + noise * (k % 3 - 1), y) for k, (x, y) in enumerate(points)]
    found = exact_coordinates(drawn(moved, 17))
    assert list(found.points) == points
    assert found.tolerance == Fraction(1, 10**7)
    assert found.largest_move == pytest.approx(3e-8)


def test_a_given_tolerance_is_kept():
    points = drawn([*SQUARE, (Fraction("0.33334"), 0), (Fraction("0.66665"), 0)], 7)
    assert exact_coordinates(points, tolerance=Fraction(1, 10**4)).points[4] == (Fraction(1, 3), 0)
    assert exact_coordinates(points, tolerance=Fraction(1, 10**7)).points == points.points


def test_short_decimals_are_what_was_meant():
    written = Drawing((*SQUARE, (Fraction("0.25"), Fraction("0.7"))), (), "a test")
    found = exact_coordinates(written)
    assert found.points == written.points
    assert found.text == "coordinates in Q, denominators up to 20; nothing moved"


def test_pixels_with_two_decimals_are_rounded_numbers_and_whole_pixels_are_not():
    points = [*SQUARE, (TWO - 1, 0), (0, TWO / 2), (1 - TWO / 2, 1), (Fraction(1, 3), 1)]
    rounded = exact_coordinates(drawn(points, 2, scale=1000))
    assert list(rounded.points) == points
    assert rounded.tolerance == Fraction(1, 10**5)
    whole = drawn(points, 0, scale=1000)
    assert exact_coordinates(whole).points == whole.points


@pytest.mark.parametrize("seed", range(6))
def test_random_decimals_fit_no_field(seed):
    random_ = random.Random(seed)
    points = [*SQUARE, *((random_.random(), random_.random()) for _ in range(60))]
    written = drawn(points, 16)
    found = exact_coordinates(written)
    assert found.points == written.points
    assert found.reason
    assert found.text.startswith("coordinates kept as written: ")


def test_what_fits_nothing_keeps_its_decimals_and_is_counted():
    points = [*SQUARE, *((TWO * k / 20, TWO * k / 24) for k in range(1, 9)), (pi / 10, 0.5)]
    found = exact_coordinates(drawn(points, 14))
    assert found.kept == (12,)
    assert found.points[12] == (decimal(pi / 10, 14), Fraction(1, 2))
    assert "1 vertex of 13 keeps its decimals" in found.text


def test_decimals_that_agree_stay_equal_even_if_they_fit_nothing():
    near = decimal(pi / 10, 14)
    points = [*SQUARE, *((TWO * k / 20, TWO * k / 24) for k in range(1, 9)), (near, 0)]
    written = drawn(points, 14)
    other = Drawing((*written.points, (near + Fraction(1, 10**15), 1)), (), "a test")
    found = exact_coordinates(other)
    assert found.points[12][0] == found.points[13][0]


def test_a_vertex_of_large_height_is_the_crossing_of_its_creases():
    """Two creases at multiples of 22.5 degrees; nothing says which small numbers they cross at."""
    a = (Fraction(5, 31), Fraction(0))
    b = (Fraction(0), Fraction(11, 37))
    slope_a, slope_b = TWO + 1, TWO - 1
    x = (b[1] - a[1] + slope_a * a[0]) / (slope_a - slope_b)
    meeting = (x, slope_b * x + b[1])
    lines = [(4, 6, "M"), (5, 6, "V")]
    points = [*SQUARE, a, b, meeting, (TWO / 2, 0), (TWO - 1, 1), (0, TWO / 4), (1, 2 - TWO)]
    noisy = [(x + Fraction(k % 2, 10**10), y) for k, (x, y) in enumerate(points)]
    found = exact_coordinates(drawn(noisy, 16, lines=lines))
    assert found.points[6] == meeting
    assert found.constructed == 1
    assert "1 vertex is a crossing of lines" in found.text


@pytest.mark.parametrize(("radicand", "count"), [(1, 4), (2, 8), (3, 12), (5, 4)])
def test_directions_divide_half_a_turn_equally(radicand, count):
    found = directions(radicand)
    assert len(found) == count
    for k, (x, y) in enumerate(found):
        length = sqrt(float(x) ** 2 + float(y) ** 2)
        angle = pi * k / count
        assert (float(x) / length, float(y) / length) == pytest.approx((cos(angle), sin(angle)))


@pytest.mark.parametrize("radicand", [1, 2, 3, 5])
def test_candidates_are_what_they_say_and_ranked_by_size(radicand):
    table = candidates(radicand)
    values = (table.numerators + table.roots * sqrt(radicand)) / table.denominators
    assert abs(values - table.values).max() < 1e-12
    assert (table.values >= 0).all()
    assert (table.values < 1).all()
    assert (table.values[1:] >= table.values[:-1]).all()
    one = (table.denominators == 1) & (table.roots == 0)
    assert table.rank[one].tolist() == [1]


def test_chance_matches_are_as_rare_as_promised():
    """Of random numbers at most 2^-6 are matched, by the bound on the rank."""
    random_ = random.Random(5)
    values = [random_.random() for _ in range(20_000)]
    found = [m for m in matches(np.array(values), 1e-6, 2) if m is not None]
    assert 0 < len(found) / len(values) < 2.0**-6
    assert min(m.bits for m in found) >= 6


def test_lattice_reduction_finds_large_numbers_only_with_enough_digits():
    number = (1621 - 1145 * TWO) / 104
    assert reduced_match(decimal(number, 15), Fraction(1, 10**15), field_of(2)).value == number
    assert reduced_match(decimal(number, 6), Fraction(1, 10**6), field_of(2)) is None
    assert reduced_match(decimal(pi / 10, 14), Fraction(1, 10**14), field_of(2)) is None


def test_snap_to_a_denominator_reports_the_move():
    found = exact_coordinates(drawn([*SQUARE, (0.2499, 0.5)], 6), 8)
    assert found.points[4] == (Fraction(1, 4), Fraction(1, 2))
    assert found.largest_move == pytest.approx(1e-4)
    assert found.denominator == 4


def test_snap_exact_changes_nothing():
    written = drawn([*SQUARE, (1 / 3, 0.5)], 12)
    found = exact_coordinates(written, "exact")
    assert found.drawing is written
    assert found.text == "coordinates kept as written: as requested"


def test_what_is_refused():
    with pytest.raises(MalformedPatternError):
        exact_coordinates(Drawing((), (), "nothing"))
    with pytest.raises(MalformedPatternError):
        exact_coordinates(Drawing(((1, 1), (1, 1)), (), "one point"))
    square = Drawing(SQUARE, (), "a square")
    with pytest.raises(UsageError):
        exact_coordinates(square, "nearly")
    with pytest.raises(UsageError):
        exact_coordinates(square, tolerance=Fraction(0))
    with pytest.raises(UsageError):
        exact_coordinates(Drawing(((TWO, 0), (0, 0)), (), "exact already"))


def test_the_resolution_is_the_last_digit():
    assert resolution(Drawing(((Fraction("0.333"), 4), (0, 0)), (), "")) == Fraction(1, 4000)
    assert resolution(Drawing(((Fraction("0.25"), 4), (0, 0)), (), "")) == Fraction(1, 10**9)
    assert resolution(Drawing(((Fraction(1, 3), 4), (0, 0)), (), "")) == Fraction(1, 10**9)


SLANTED = RATIONALS.adjoined(2).adjoined(2 + TWO).root / 2  # the cosine of 22.5 degrees
WIDE = [
    *SQUARE,
    (TWO - 1, Fraction(1, 3)),
    (Fraction(3, 4), 1 - TWO / 2),
    (TWO / 4, Fraction(1, 2)),
]


def test_lengths_along_slanted_lines_lie_in_a_field_with_one_more_root():
    points = [*WIDE, (SLANTED, SLANTED * (TWO - 1)), (1 - SLANTED / 2, TWO * SLANTED / 3)]
    found = exact_coordinates(drawn(points, 16))
    assert list(found.points) == points
    assert found.field_name == "Q(sqrt 2, sqrt (2 + r1))"
    assert (found.kept, found.radicand) == ((), 2)
    assert "coordinates in Q(sqrt 2, sqrt (2 + r1)), denominators up to 6; " in found.text


def test_two_roots_of_rational_numbers_are_found_as_well():
    both = RATIONALS.adjoined(2).adjoined(3)
    points = [*WIDE, (both.root / 3, TWO * both.root / 4)]
    found = exact_coordinates(drawn(points, 16))
    assert list(found.points) == points
    assert found.field_name == "Q(sqrt 2, sqrt 3)"


@pytest.mark.parametrize(
    ("digits", "odd"),
    [
        (9, [(SLANTED * (3 * TWO - 4) / 5 + TWO / 7, SLANTED * 5 / 11)]),
        (16, [(pi / 4, 1 / pi), (pi / 5, 2 / pi)]),
    ],
)
def test_no_root_is_added_for_numbers_that_chance_would_fit_as_well(digits, odd):
    found = exact_coordinates(drawn([*WIDE, *odd], digits))
    assert found.field_name == "Q(sqrt 2)"
    assert found.kept == tuple(range(len(WIDE), len(WIDE) + len(odd)))


def test_what_is_said_of_coordinates_that_are_kept_as_written():
    """A FOLD file that states exact coordinates is exact; digits that are kept are digits."""
    points = ((Fraction(0), Fraction(0)), (Fraction(1, 3), Fraction(0)), (Fraction(1), Fraction(2)))
    stated = Drawing(points, (Line(0, 1, "B"),), "three points", exact=True)
    digits = Drawing(points, (Line(0, 1, "B"),), "three points")
    assert exact_coordinates(stated, "exact").brief == "exact in Q"
    assert exact_coordinates(digits, "exact").brief == "decimals as written"
