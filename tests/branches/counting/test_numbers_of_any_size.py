"""Numbers of any size: huge denominators, thin and shifted sheets, coordinates of 300 digits."""

import json
import random
from fractions import Fraction

import pytest
from counting import check_generic, summary
from sheets import mapped

import exactfold
from exactfold import CreasePattern, random_square
from exactfold.branches import count_branches
from exactfold.pattern.families import FAMILIES


def test_huge_denominators():
    source = random.Random(0)
    noise = Fraction(1, 10**60)
    pattern = mapped(
        random_square(3, seed=1),
        lambda p: tuple(x + noise * source.randint(-(10**50), 10**50) for x in p),
    )
    assert max(x.denominator for p in pattern.vertices for x in p) > 10**57
    check_generic(pattern, count_branches(pattern))


@pytest.mark.parametrize("scale", [Fraction(10**40), Fraction(1, 10**40), Fraction(10**150)])
@pytest.mark.parametrize("method", ["newton", "popping", "homotopy", "groebner"])
def test_scale_does_not_matter(scale, method):
    pattern = random_square(3, seed=8)
    scaled = mapped(pattern, lambda p: (scale * p[0], scale * p[1]))
    result = count_branches(scaled, method=method)
    check_generic(scaled, result)
    assert summary(result) == summary(count_branches(pattern))


def test_far_from_the_origin():
    pattern = mapped(random_square(3, seed=8), lambda p: (p[0] + 10**30, p[1] - 10**31))
    assert summary(count_branches(pattern)) == summary(count_branches(random_square(3, seed=8)))


def test_thin_sheet():
    pattern = mapped(random_square(3, seed=4), lambda p: (p[0], p[1] / 10**4))
    check_generic(pattern, count_branches(pattern))


def test_nearly_straight_path_is_counted_apart():
    # The flat-vertex example with its path bent by 1e-12: four simple branches, two of them close.
    vertices = list(FAMILIES["flat-vertex"]().vertices)
    vertices[4] = (vertices[4][0] + Fraction(1, 10**12), vertices[4][1])
    pattern = CreasePattern(vertices, FAMILIES["flat-vertex"]().triangles)
    check_generic(pattern, count_branches(pattern))


FILES = {
    "one vertex": (
        [[0, 0], [4e300, 0], [1, 1], [0, 1], [0.5, 0.25]],
        [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
        2,
    ),
    "two vertices": (
        [[0, 0], [4e300, 0], [4e300, 1], [0, 1], [0.3, 0.4], [0.7, 0.6]],
        [[0, 1, 4], [1, 5, 4], [1, 2, 5], [2, 3, 5], [3, 4, 5], [3, 0, 4]],
        4,
    ),
}


@pytest.mark.parametrize("name", FILES)
def test_a_coordinate_of_300_digits_is_counted(name, tmp_path):
    coordinates, faces, expected = FILES[name]
    path = tmp_path / "huge.fold"
    path.write_text(json.dumps({"vertices_coords": coordinates, "faces_vertices": faces}))
    assert path.stat().st_size < 180
    result = exactfold.branches.count_branches(exactfold.pattern.load(path))
    assert result.status is exactfold.PROVED
    assert (result.distinct, result.real) == (expected, expected)
    assert len(set(result.sign_vectors)) == expected // 2


@pytest.mark.parametrize("exponent", [400, -400])
def test_sheets_beyond_the_range_of_floats_are_counted(exponent):
    small = random_square(2, seed=3)
    scale = Fraction(10) ** exponent
    points = [(x * scale, y * scale) for x, y in small.vertices]
    found = exactfold.count(CreasePattern(points, small.triangles))
    known = exactfold.count(small)
    assert found.status is exactfold.PROVED
    assert [b.assignment for b in found] == [b.assignment for b in known]
