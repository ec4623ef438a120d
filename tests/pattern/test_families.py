from fractions import Fraction

import pytest

from exactfold.errors import NotApplicableError, PatternError, UsageError
from exactfold.interop.graphs import to_networkx
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.data import SHEETS, example_path
from exactfold.pattern.families import (
    FAMILIES,
    collinear_folds,
    flat_octahedron_in_square,
    flat_vertex_square,
    h1_sequence,
    hypar,
    sample_h1_sequence,
    single_vertex,
    two_vertex,
    waterbomb,
)
from exactfold.pattern.fold import read_fold
from exactfold.pattern.triangulating.random_squares import random_square


@pytest.mark.parametrize("folds", range(3, 41))
def test_single_vertex(folds):
    pattern = single_vertex(folds)
    assert (pattern.Vi, pattern.Ve, pattern.degree(folds)) == (1, folds, folds)
    assert pattern.vertices[folds] == (0, 0)
    assert all(x * x + y * y == 1 for x, y in pattern.vertices[:folds])
    assert set(pattern.boundary_turns) == {1}
    assert collinear_folds(pattern) == ()
    gaps = [
        (ax * bx + ay * by, ax * by - ay * bx)
        for (ax, ay), (bx, by) in zip(
            pattern.vertices[:folds],
            pattern.vertices[1:folds] + pattern.vertices[:1],
            strict=True,
        )
    ]
    assert min(sine for _, sine in gaps) > Fraction(1, folds)  # no sliver: sectors of 1/N at least


def test_single_vertex_error():
    with pytest.raises(UsageError, match="at least three folds, not 2"):
        single_vertex(2)


def test_waterbomb():
    pattern = waterbomb()
    assert (pattern.Vi, pattern.Ve, pattern.degree(6)) == (1, 6, 6)
    assert sorted(pattern.boundary_turns) == [0, 0, 1, 1, 1, 1]
    assert collinear_folds(pattern) == ((0, 6, 2), (1, 6, 3), (4, 6, 5))


def test_two_vertex_is_generic():
    pattern = two_vertex()
    assert (pattern.Vi, pattern.Ve, pattern.Vt) == (2, 4, 0)
    assert (4, 5) in pattern.folds
    assert len(pattern.folds) == 7
    assert collinear_folds(pattern) == ()
    assert pattern.chords == ()


def test_flat_vertex_square_is_the_pattern_of_the_theory():
    third = {(0, 1, 5), (1, 2, 5), (2, 4, 5), (0, 5, 4), (2, 3, 4), (0, 4, 3)}
    assert set(flat_vertex_square().triangles) == third
    assert flat_vertex_square().vertices[5] == (Fraction(7, 10), Fraction(1, 5))
    assert flat_vertex_square().Vt == 0


def test_flat_octahedron():
    pattern = flat_octahedron_in_square()
    assert pattern.triangulated_triangles == (((4, 5, 6), (7, 8, 9)),)
    assert [pattern.degree(v) for v in (7, 8, 9)] == [4, 4, 4]
    assert pattern.foldable_vertices == (4, 5, 6)
    reduced, _ = pattern.without_rigid_parts()
    assert min(reduced.degree(v) for v in reduced.interior) >= 4
    assert collinear_folds(pattern) == ()
    assert pattern.chords == ()
    # Each outer vertex misses exactly the inner vertex across: the graph is the octahedron's.
    inside = to_networkx(pattern).subgraph(range(4, 10))
    assert [d for _, d in inside.degree] == [4] * 6


@pytest.mark.parametrize("rings", [1, 2, 3, 6])
def test_hypar(rings):
    pattern = hypar(rings)
    assert (pattern.Vi, pattern.Ve, pattern.Vt) == (4 * rings, 4, 0)
    assert pattern.boundary == (0, 1, 2, 3)
    assert collinear_folds(pattern) == ()
    assert pattern.chords == ()
    assert min(pattern.degree(v) for v in pattern.interior) >= 4
    size = rings + 1
    assert pattern.area == 4 * size * size


@pytest.mark.parametrize("rings", [1, 2, 3])
def test_hypar_without_twist_has_a_straight_diagonal(rings):
    pattern = hypar(rings, twist=0)
    middle = {v for _, v, _ in collinear_folds(pattern)}
    start = 0 if rings % 2 == 0 else 1
    assert {4 * k + j for k in range(1, rings + 1) for j in (start, start + 2)} <= middle


def test_hypar_error():
    with pytest.raises(UsageError, match="at least one ring"):
        hypar(0)
    with pytest.raises(PatternError):
        hypar(3, twist=1)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("steps", [0, 1, 2, 4, 8])
def test_h1_sequence(steps, seed):
    built = sample_h1_sequence(steps, seed)
    pattern = built.pattern
    assert built.seed == seed
    assert (pattern.Vi, pattern.Ve, pattern.Vt) == (steps, 4, 0)
    assert set(pattern.boundary_turns) == {1}
    assert collinear_folds(pattern) == ()
    assert all(pattern.degree(v) >= 4 for v in pattern.interior)
    assert h1_sequence(steps, seed) == pattern
    # Undoing the moves from the last leads through H1 triangulations back to the butterfly.
    for v1, v2, v3, w in reversed(built.moves):
        assert w == len(pattern.vertices) - 1
        assert pattern.star(w) == (v3, v2, v1)
        pattern = CreasePattern(pattern.vertices[:w], [t for t in pattern.triangles if w not in t])
        assert v2 in pattern.boundary
        assert pattern.degree(v2) >= 3
    assert pattern.triangles == ((0, 1, 2), (0, 2, 3))


def test_h1_sequences_differ_by_seed():
    assert len({h1_sequence(5, seed).sha256 for seed in range(10)}) == 10


def test_h1_long_sequence():
    assert h1_sequence(40, 7).Vi == 40


def test_h1_error():
    with pytest.raises(UsageError, match="must not be negative"):
        h1_sequence(-1)
    with pytest.raises(UsageError, match="must not be negative"):
        h1_sequence(1, -1)
    tight = next(s for s in range(50) if _fails(s))
    with pytest.raises(NotApplicableError, match="1 draws found no place for H1 move 1"):
        sample_h1_sequence(1, tight, max_attempts=1)


def _fails(seed):
    try:
        sample_h1_sequence(1, seed, max_attempts=1)
    except NotApplicableError:
        return True
    return False


@pytest.mark.parametrize("name", FAMILIES)
def test_registry(name):
    pattern = FAMILIES[name]()
    assert pattern.Vi >= 1
    assert FAMILIES[name]() == pattern


def test_registry_is_read_only():
    with pytest.raises(TypeError):
        FAMILIES["other"] = waterbomb


EXPECTED = {
    "two-vertex": two_vertex,
    "single-vertex-4": single_vertex,
    "flat-octahedron": flat_octahedron_in_square,
    "flat-vertex": flat_vertex_square,
    "h1-4": lambda: h1_sequence(4),
    "hypar-2": lambda: hypar(2),
    "waterbomb": waterbomb,
    "random-8": lambda: random_square(8, seed=1),
}


@pytest.mark.parametrize("name", SHEETS)
def test_shipped_examples_are_what_the_builders_make(name):
    assert read_fold(example_path(name)) == EXPECTED[name]()


def test_every_shipped_file_is_listed():
    folder = example_path("two-vertex").parent
    assert {path.stem for path in folder.glob("*.fold")} == set(SHEETS) == set(EXPECTED)


def test_unknown_example_error():
    with pytest.raises(
        UsageError, match=r"no example 'three-vertex'; the examples are: zigzags, m"
    ):
        example_path("three-vertex")
