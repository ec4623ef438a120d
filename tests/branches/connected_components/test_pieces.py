"""Pieces of the solutions of sheets with more than four corners, in independent ways."""

from __future__ import annotations

import json
import random
from fractions import Fraction

import networkx as nx
import pytest
from flint import fmpq
from running import run
from shapes import FOUR_CIRCLES, NEVER_FLAT, joined_by_shapes
from sheets import DENTED, HEXAGON, scrambled, wheel, with_point

from exactfold import PROVED, REFUTED, UNDECIDED, CreasePattern, checker
from exactfold.branches import ConnectedComponents, Joint, count_branches, find_connected_components
from exactfold.branches.connected_components import flat_stars, joining
from exactfold.branches.connected_components.cubes import components
from exactfold.branches.connected_components.no_zero import have_no_common_zero
from exactfold.branches.counting import in_chart
from exactfold.branches.counting.collect import with_true_bounds
from exactfold.errors import NotApplicableError
from exactfold.motion import follow_proved
from exactfold.panels.vertex.stars import Star, edge_of, stars
from exactfold.pattern import write_fold
from exactfold.pattern.degenerate import DEGENERATE
from exactfold.pattern.families import flat_vertex_square, single_vertex, waterbomb
from exactfold.pattern.opening import panels
from exactfold.pattern.triangulating.random_squares import sample_random_square
from exactfold.rigidity.curvature import curvature_form
from exactfold.rigidity.functionals import saddle_functional


def pentagon(seed: int, inside: int) -> CreasePattern:
    return scrambled(seed, HEXAGON[:5], inside, loose=True)


# --- the number of pieces ------------------------------------------------------------------------


def test_four_circles():
    """Degree 4 and D = 2 do not make a flat star: the other vertex has no fold left to bend."""
    connected_components = find_connected_components(FOUR_CIRCLES)
    assert FOUR_CIRCLES.degree(3) == 4
    assert (
        connected_components.number,
        connected_components.graphs,
        connected_components.joints,
    ) == (4, 4, ())
    assert set(connected_components.never_flat) == {3, 4}
    assert joined_by_shapes(FOUR_CIRCLES) == 4


def test_a_convex_star_that_is_never_flat():
    """Four other vertices could bend with it held flat, and have no common zero but 0."""
    around = [edge_of(9, u) for u in NEVER_FLAT.star(9)]
    assert set(NEVER_FLAT.star(9)) == {5, 6, 7, 8}
    assert set(stars(panels(NEVER_FLAT), around)) == {5, 6, 7, 8}
    connected_components = find_connected_components(NEVER_FLAT)
    assert (connected_components.number, connected_components.joints) == (32, ())
    assert connected_components.never_flat[9] == (
        "with its star held flat, the only solution is the flat state"
    )


@pytest.mark.parametrize(
    ("pattern", "number"),
    [(pentagon(0, 2), 2), pytest.param(pentagon(1, 3), 4, marks=pytest.mark.slow)],
    ids=["two", "three"],
)
def test_shapes_over_many_rims_are_joined_alike(pattern, number):
    assert find_connected_components(pattern).number == joined_by_shapes(pattern) == number


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "inside"), [(1, 2), (0, 3), (3, 3), (0, 4), (2, 4)])
def test_shapes_over_many_rims_are_joined_alike_in_more_sheets(seed, inside):
    pattern = pentagon(seed, inside)
    assert find_connected_components(pattern).number == joined_by_shapes(pattern)


@pytest.mark.parametrize("degree", [5, 8])
def test_a_single_vertex_pops_up_or_down(degree):
    pattern = single_vertex(degree)
    result = count_branches(pattern)
    assert result.connected_components == find_connected_components(pattern)
    assert (
        result.connected_components.number,
        result.connected_components.graphs,
        result.distinct,
    ) == (2, 2, 1)


def test_a_fold_from_border_to_border_joins_everything():
    inner = wheel([(0, 0), (4, 0), (4, 4), (0, 4)], (1, 2))
    flap = CreasePattern([*inner.vertices, (7, 2)], [*inner.triangles, (1, 5, 2)])
    connected_components = find_connected_components(flap)
    assert (
        connected_components.chord,
        connected_components.number,
        connected_components.graphs,
    ) == ((1, 2), 1, 2)
    fan = CreasePattern(HEXAGON[:5], [(0, 1, 2), (0, 2, 3), (0, 3, 4)])
    rigid = with_point(fan, 1, (1, 1, 1))  # a triangulated triangle, so that nothing pops
    assert (find_connected_components(rigid).graphs, find_connected_components(rigid).number) == (
        1,
        1,
    )


def test_labels_are_those_of_the_pattern():
    """With a vertex inside a face nothing changes but its place in the list."""
    pattern = pentagon(1, 3)
    connected_components = find_connected_components(pattern)
    more = with_point(pattern, 2, (1, 2, 3))
    moved = CreasePattern(
        [*more.vertices[:5], more.vertices[-1], *more.vertices[5:-1]],
        [
            tuple(5 if v == 8 else v + (v >= 5) for v in triangle)  # the new vertex comes first
            for triangle in more.triangles
        ],
    )
    found = find_connected_components(moved)
    assert moved.Vt == 1
    assert found.number == connected_components.number
    assert found.vertices == tuple(v + 1 for v in connected_components.vertices)
    assert {joint.sign_text for joint in found.joints} == {
        joint.sign_text for joint in connected_components.joints
    }
    assert set(found.never_flat) == {v + 1 for v in connected_components.never_flat}
    assert all(max(edge) <= 8 for joint in found.joints for edge in joint.densities)


def test_two_ways_to_solve_a_sheet_with_a_flat_star(monkeypatch):
    """All complex solutions in boxes, and linear spaces over fields with roots."""
    pattern = pentagon(2, 3)
    boxed = find_connected_components(pattern)
    assert {joint.by for joint in boxed.joints} == {"isolated"}
    monkeypatch.setattr(flat_stars, "_MOST_FINITE", 0)
    split = find_connected_components(pattern)
    assert {joint.by for joint in split.joints} == {"space"}
    assert split.number == boxed.number == 4
    assert _cubes(split) == _cubes(boxed)


def _cubes(connected_components: ConnectedComponents) -> set[frozenset[str]]:
    mirror = str.maketrans("+-", "-+")
    return {
        frozenset({j.sign_text, j.sign_text.translate(mirror)}) for j in connected_components.joints
    }


# --- what a joint shows --------------------------------------------------------------------------


@pytest.mark.parametrize("pattern", [pentagon(0, 2), scrambled(2, HEXAGON, 2, loose=True)])
def test_a_joint_is_a_solution_with_these_signs(pattern):
    connected_components = find_connected_components(pattern)
    assert connected_components.joints
    for joint in connected_components.joints:
        bounds = joint.densities
        for v in pattern.interior:
            w = [bounds.get(edge_of(v, u), (Fraction(0),) * 2) for u in pattern.star(v)]
            x, y = pattern.vertices[v]
            d = [(pattern.vertices[u][0] - x, pattern.vertices[u][1] - y) for u in pattern.star(v)]
            assert any(any(pair) for pair in w) == bool(joint.signs[v])
            middle = [float(low + high) / 2 for low, high in w]
            for axis in (0, 1):
                assert sum(a * float(b[axis]) for a, b in zip(middle, d, strict=True)) == (
                    pytest.approx(0, abs=1e-9)
                )
            area = sum(
                middle[k] * middle[j] * float(d[k][0] * d[j][1] - d[k][1] * d[j][0])
                for j in range(len(d))
                for k in range(j)
            )
            assert area == pytest.approx(0, abs=1e-9)
            bend = -sum(
                a * float(b[0] ** 2 + b[1] ** 2) ** 0.5 for a, b in zip(middle, d, strict=True)
            )
            assert (bend > 1e-9) - (bend < -1e-9) == joint.signs[v]


def test_joints_of_a_family_and_true_pieces():
    """D = 3: solutions with a flat star form families, of which single points are proved."""
    connected_components = find_connected_components(scrambled(2, HEXAGON, 2, loose=True))
    (joint,) = connected_components.joints
    assert (joint.by, joint.folds, connected_components.number, connected_components.true_high) == (
        "regular",
        True,
        2,
        2,
    )
    assert connected_components.complete == (7,)
    assert joint.to_dict()["flat"] == [7]


def test_what_is_not_decided_gives_bounds_and_is_named(monkeypatch):
    pattern = pentagon(0, 3)
    whole = find_connected_components(pattern)
    assert (whole.number, whole.open) == (2, {})
    monkeypatch.setattr(flat_stars, "_MOST_DIMENSION", 1)
    connected_components = find_connected_components(pattern)
    assert (connected_components.status, connected_components.number) == (UNDECIDED, None)
    assert (connected_components.low, connected_components.high) == (2, 8)
    assert set(connected_components.open) == set(whole.complete) == {6, 7}
    assert "have dimension" in connected_components.open[6]
    result = count_branches(pattern)
    assert (result.status, len(result.open_questions)) == (PROVED, 1)
    assert "vertices 6, 7" in result.open_questions[0]
    monkeypatch.setattr(joining, "_MOST_WHOLE", 2)
    assert "only if at most 2 can pop" in find_connected_components(pattern).open[6]


# --- the count of components ---------------------------------------------------------------------


def test_components_against_a_graph():
    source = random.Random(3)
    for _ in range(60):
        size = source.randrange(1, 7)
        cubes = []
        for _ in range(source.randrange(6)):
            mask = source.randrange(1 << size)
            cubes.append((mask, mask & source.randrange(1 << size)))
        graph = nx.Graph()
        graph.add_nodes_from(range(1 << size))
        for mask, value in cubes:
            inside = [e for e in range(1 << size) if e & mask == value]
            nx.add_path(graph, inside)
        number = nx.number_connected_components(graph)
        assert components(size, cubes) == (number, number)
        far = [(mask << 30, value << 30) for mask, value in cubes]  # counted, not listed
        if all(mask for mask, _ in cubes) and cubes:
            low, high = components(size + 30, far)
            alone = sum(all(e & m != x for m, x in cubes) for e in range(1 << size))
            assert low == high == (number - alone) + (alone << 30)


def test_forms_without_a_common_zero():
    def form(*rows):
        return [[fmpq(x) for x in row] for row in rows]

    circle, cross = form((1, 0), (0, 1)), form((0, 1), (1, 0))
    assert have_no_common_zero([circle, cross])
    # Two complex zeros in common, and a third form that has not both.
    pair = form((1, 0), (0, 1))
    assert not have_no_common_zero([circle, pair])
    assert not have_no_common_zero([cross, form((0, 3), (3, 0))])
    assert not have_no_common_zero([circle])
    assert have_no_common_zero(
        [
            form((1, 0, 0), (0, 0, 0), (0, 0, 0)),
            form((0, 0, 0), (0, 1, 0), (0, 0, 0)),
            form((0, 0, 0), (0, 0, 0), (0, 0, fmpq(1, 3))),
        ]
    )


# --- true branches for four corners --------------------------------------------------------------


def test_a_double_line_that_is_one_true_curve():
    """With the star held flat the sheet truly folds along its diagonal."""
    result = count_branches(flat_vertex_square())
    assert (result.distinct, result.with_multiplicity) == (3, 4)
    assert (result.true_bounds, result.true_branches) == ((3, 3), PROVED)


def test_a_branch_without_a_saddle_is_the_start_of_a_true_one():
    """With a reflex corner the saddle may be 0: true branches are not counted by its sign.

    The boundary is (-1, 0), (3, -3), (-5, 6), (-5, 1) about (0, 0), with the reflex corner 0.
    """
    corners = [(-1, 0), (3, -3), (-5, 6), (-5, 1), (0, 0)]
    dart = CreasePattern(corners, [(k, (k + 1) % 4, 4) for k in range(4)])
    result = count_branches(dart)
    assert (result.true_bounds, result.true_branches) == ((2, 2), PROVED)
    form, saddle = curvature_form(dart, 4), saddle_functional(dart)
    solutions = [(0, 0, 0, 0, -1), (4, 0, 0, 0, 3)]
    values = []
    for heights in solutions:
        h = {v: Fraction(x) for v, x in enumerate(heights)}
        assert form(h) == 0
        assert any(form.functional(h).values())
        values.append(sum(Fraction(weight) * h[v] for v, weight in saddle.items()))
    assert values == [0, 4]
    for branch in result.branches:
        assert follow_proved(branch, until=0.01).status is PROVED


def test_a_double_line_that_is_not_shown_to_be_one_curve():
    result = count_branches(DEGENERATE["ring"]())
    assert (result.distinct, result.with_multiplicity) == (26, 32)
    assert (result.true_bounds, result.true_branches) == ((26, 32), UNDECIDED)
    assert result.true_branches is not REFUTED


def test_a_branch_is_not_taken_for_the_reflection_of_another(monkeypatch):
    """-+0-+ and +-0+- are two branches; a joint with these signs can belong to either."""
    result = count_branches(DEGENERATE["waterbomb-pair"]())
    signs = next(b.vertex_signs for b in result.branches if b.sign_text == "-+0-+")
    joint = Joint(signs, {}, "regular", folds=True)
    for reason, most in (("", 30), ("some may be missing", 32)):
        found = flat_stars.FlatSolutions((joint,), reason)
        monkeypatch.setattr(flat_stars, "flat_solutions", lambda moving, found=found: found)
        assert with_true_bounds(result).true_bounds == (28, most)


def test_a_vertex_whose_sign_is_not_decided_leaves_the_joint_open(monkeypatch):
    monkeypatch.setattr(flat_stars, "_joint", lambda *args, **options: None)
    fold = Star(0, ((0, 1), (0, 2)), ((1, 0), (-2, 0)))
    found = flat_stars.flat_solutions({0: fold})
    assert (found.joints, "so nearly flat" in found.open) == ((), True)


def test_true_branches_are_bounded_also_where_the_count_is_undecided(monkeypatch):
    monkeypatch.setattr(in_chart, "flat_vertices", lambda chart, points: iter(()))
    result = count_branches(flat_vertex_square(), method="popping")
    assert (result.status, result.true_bounds) == (UNDECIDED, (1, 4))
    large = count_branches(sample_random_square(60, seed=1, redraw=True).pattern)
    assert large.true_bounds == (1, 2**60)
    assert large.to_dict()["true_bounds"] == [1, "2^60"]


# --- what is printed -----------------------------------------------------------------------------


def test_the_answer_in_plain_words(tmp_path):
    write_fold(pentagon(0, 2), tmp_path / "p.fold")
    result = run("count", tmp_path / "p.fold", "--certificate", tmp_path / "c.json")
    assert result.exit_code == 0
    text = " ".join(result.stdout.split())
    for words in (
        "2 families of ways to fold, each of dimension 2 - PROVED",
        "one for each choice of the vertices that pop up, seen from one side; with their mirror "
        "images they form 2 connected components",
        "ways 1 to 2 are the families",
        "1 vertex is never flat when the sheet starts to fold: 6",
        "the true motions near the flat state form as many families, with 2 connected components",
        "irreducible components that the families lie in: 2 of dimension 2",
    ):
        assert words in text
    assert "irreducible components has a certificate of its own" in result.stderr
    assert checker.verify(tmp_path / "c.components.json")["second_order"] == {"2": 2}
    assert checker.verify(tmp_path / "c.json")["joints"] == ["0-"]
    data = json.loads(run("count", tmp_path / "p.fold", "--json").stdout)
    assert (data["by"], data["distinct"], data["theory"]) == ("theorem", None, "branches")
    assert (data["pieces"]["at_least"], data["pieces"]["at_most"]) == (2, 2)
    assert data["pieces"]["joints"][0]["flat"] == [5]
    assert data["components"]["second_order"] == {"2": 2}


# --- a boundary that is not convex
# -----------------------------------------------------------------

NOTCHED = wheel([(4, -4), ("1/10", 0), (4, 4), (-4, 4), (-4, -4)], (0, 0))


def test_shapes_over_a_rim_need_not_be_real():
    """Five corners, one of them reflex: the height of the hub over some rims is not real."""
    form = curvature_form(NOTCHED, 5)
    up = {v: Fraction(int(v == 5)) for v in form.labels}
    assert not NOTCHED.is_convex
    assert NOTCHED.D == 2

    def discriminant(rim):
        heights = {v: Fraction(rim.get(v, 0)) for v in form.labels}
        return form.polar(up, heights) ** 2 - form(up) * form(heights)

    real = [discriminant({3: x, 4: y}) > 0 for x in range(-3, 4) for y in range(-3, 4) if x or y]
    assert True in real
    assert False in real


def test_pieces_are_for_convex_borders_with_more_than_four_corners():
    with pytest.raises(NotApplicableError, match="reflex corner, vertex 3"):
        find_connected_components(scrambled(1, DENTED, 2, loose=True))
    with pytest.raises(NotApplicableError, match="its solutions are branches"):
        find_connected_components(flat_vertex_square())


def test_patterns_are_given_by_name_or_path(tmp_path):
    expected = find_connected_components(waterbomb())
    write_fold(waterbomb(), tmp_path / "p.fold")
    assert (
        find_connected_components("waterbomb")
        == find_connected_components(tmp_path / "p.fold")
        == expected
    )


def test_values_show_themselves():
    connected_components = find_connected_components(pentagon(0, 2))
    assert repr(connected_components) == "<Pieces: proved, 2 of 4 graphs>"
    (joint,) = connected_components.joints
    assert isinstance(joint, Joint)
    assert repr(joint) == "<Joint: 0-, isolated>"
    assert joint.flat == (5,)
