"""Sheets as objects of PyRigi, Sage, NetworkX and trimesh, judged by what these find in them.

What needs a program that is not installed is skipped, and says so.
"""

import doctest
import re
from fractions import Fraction
from importlib.util import find_spec
from pathlib import Path

import networkx as nx
import numpy as np
import pytest

from exactfold import interop as bridges
from exactfold.branches.counting.collect import count_branches
from exactfold.errors import (
    DisconnectedError,
    FloatRefusedError,
    FoldError,
    InputError,
    MalformedPatternError,
    PackageMissingError,
    PatternError,
    UsageError,
)
from exactfold.interop import export, frameworks
from exactfold.interop.export import chart_names
from exactfold.interop.packages import is_available, optional
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.data import example_path
from exactfold.pattern.drawing.drawing import Drawing, Line
from exactfold.pattern.families import single_vertex, two_vertex
from exactfold.pattern.opening import from_drawing
from exactfold.pattern.triangulating.random_squares import random_square
from exactfold.rigidity.all_real import decide_all_branches_real
from exactfold.rigidity.curvature import curvature_form, wheel_stress
from exactfold.rigidity.equations.branch_system import BranchSystem
from exactfold.rigidity.facts import pattern_facts
from exactfold.rigidity.self_stress import self_stresses

TRIANGLE = CreasePattern(
    [(0, 0), (4, 0), (0, 4), (1, 1), ("3/2", "1/2")],
    [(0, 4, 3), (0, 1, 4), (1, 3, 4), (1, 2, 3), (2, 0, 3)],
)
"""Three corners, two vertices inside: rigid by the theorem of Connelly and Gortler."""
SHEETS = {
    "one vertex": single_vertex(5),
    "square": random_square(3, seed=0),
    "triangle": TRIANGLE,
    "hexagon": single_vertex(6),
}


def pyrigi():
    return pytest.importorskip("pyrigi", reason="PyRigi is not installed")


def sage():
    if not (is_available("sage.all") or is_available("sage.all__sagemath_singular")):
        pytest.skip("neither Sage nor passagemath-singular is installed")


# --- what the docstrings and the page show -------------------------------------------------------


def run_all(text, names, where):
    """Run the examples of a text, also those that are skipped where a package may be missing."""
    text = re.sub(r"\s*(\.\.\. )?# doctest: \+SKIP", "", text)
    example = doctest.DocTestParser().get_doctest(text, names, where, where, 0)
    assert example.examples
    runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE)
    runner.run(example)
    assert runner.failures == 0


@pytest.mark.parametrize("name", ["to_pyrigi", "from_pyrigi"])
def test_docstrings_for_pyrigi(name):
    pyrigi()
    function = getattr(bridges, name)
    run_all(function.__doc__, dict(vars(frameworks)), name)


@pytest.mark.parametrize("name", ["to_sage", "form_to_sage"])
def test_docstrings_for_sage(name):
    sage()
    function = getattr(bridges, name)
    run_all(function.__doc__, dict(vars(export)), name)


def test_the_page_with_pyrigi():
    pyrigi()
    page = Path(__file__).parents[2] / "docs" / "bridges.md"
    (section,) = re.findall(r"(?s)\n## PyRigi\n(.*?)\n##", page.read_text("utf-8"))
    run_all(section.replace("```", ""), {}, page.name)


# --- a package that is missing -------------------------------------------------------------------


@pytest.mark.parametrize(
    ("package", "install", "call"),
    [
        ("pyrigi", r"exactfold\[bridges\]", lambda: bridges.to_pyrigi("two-vertex")),
        ("trimesh", r"exactfold\[bridges\]", lambda: bridges.to_trimesh("two-vertex")),
        ("sage", "passagemath-singular", lambda: bridges.to_sage(BranchSystem("two-vertex"))),
    ],
)
def test_a_missing_package_is_named(monkeypatch, package, install, call):
    monkeypatch.setattr(
        "exactfold.interop.packages.find_spec",
        lambda name: None if name.partition(".")[0] == package else find_spec(name),
    )
    with pytest.raises(PackageMissingError, match=f"{package} is not .*pip install .*{install}"):
        call()


def test_a_package_that_is_there_is_imported():
    assert optional("fractions", "nothing").Fraction is Fraction


# --- PyRigi --------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", SHEETS)
def test_pyrigi_finds_the_same_rank_stresses_and_flexes(name):
    pyrigi()
    pattern = SHEETS[name]
    framework, facts = bridges.to_pyrigi(pattern), pattern_facts(pattern)
    assert framework.dim == 3
    assert framework.rigidity_matrix_rank() == facts.rigidity_rank
    assert len(framework.stresses()) == facts.self_stresses == pattern.Vi
    assert len(framework.inf_flexes()) == len(pattern.vertices) - 3


def test_stresses_of_either_are_stresses_of_the_other():
    pyrigi()
    pattern = SHEETS["square"]
    framework = bridges.to_pyrigi(pattern)
    mine = [wheel_stress(pattern, v) for v in pattern.interior] + self_stresses(pattern)
    assert all(framework.is_dict_stress(dict.fromkeys(pattern.edges, 0) | w) for w in mine)
    spoilt = dict.fromkeys(pattern.edges, 0) | mine[0] | {pattern.folds[0]: Fraction(1, 7)}
    assert not framework.is_dict_stress(spoilt)
    theirs = [[Fraction(str(x)) for x in w] for w in framework.stresses(pattern.edges)]
    rows = [[w.get(e, Fraction(0)) for e in pattern.edges] for w in mine[: pattern.Vi]]
    both = np.array([[float(x) for x in row] for row in rows + theirs])
    assert np.linalg.matrix_rank(both) == len(theirs) == pattern.Vi


@pytest.mark.parametrize("name", SHEETS)
def test_there_and_back(name):
    pyrigi()
    assert bridges.from_pyrigi(bridges.to_pyrigi(SHEETS[name])).sha256 == SHEETS[name].sha256


def framework(places, bars):
    package = pyrigi()
    return package.Framework(package.Graph(bars), places)


WHEEL = ["ab", "bc", "ca", "ad", "bd", "cd"]
CORNERS = {"a": (0, 0), "b": (3, 0), "c": (0, 3), "d": (1, 1)}


def test_names_in_the_plane_become_numbers():
    pattern = bridges.from_pyrigi(framework(CORNERS, [tuple(bar) for bar in WHEEL]))
    assert pattern.vertices == tuple(CORNERS.values())
    assert (pattern.boundary, pattern.interior) == ((0, 1, 2), (3,))


def test_a_sheet_at_another_height_is_flat():
    lifted = {name: (x, y, Fraction(2, 3)) for name, (x, y) in CORNERS.items()}
    assert bridges.from_pyrigi(framework(lifted, [tuple(bar) for bar in WHEEL])).Vi == 1


@pytest.mark.parametrize(
    ("moved", "bars", "cause", "words"),
    [
        ({"d": (1.5, 1)}, WHEEL, FloatRefusedError, "vertex 3: the float 1.5"),
        ({"d": ("sqrt(2)", 1)}, WHEEL, FoldError, r"vertex 3: sqrt\(2\)"),
        ({}, WHEEL[:-1], FoldError, "face of 4 sides"),
        ({"d": (5, 5)}, WHEEL, FoldError, "cross"),
        ({"e": (9, 9), "f": (9, 8), "g": (8, 9)}, [*WHEEL, "ef", "fg", "ge"], DisconnectedError, "")
    ],
)  # fmt: skip
def test_what_is_no_crease_pattern_is_refused_with_its_cause(moved, bars, cause, words):
    message = f"the framework is not a crease pattern: .*{words}"
    with pytest.raises(PatternError, match=message) as found:
        bridges.from_pyrigi(framework(CORNERS | moved, [tuple(bar) for bar in bars]))
    assert type(found.value.__cause__) is cause
    assert isinstance(found.value, InputError)


@pytest.mark.parametrize(
    ("places", "cause", "said"),
    [
        ({n: (x, y, x * y) for n, (x, y) in CORNERS.items()}, FoldError, "plane"),
        (
            {name: (k,) for k, name in enumerate(CORNERS)},
            MalformedPatternError,
            "dimension is 1",
        ),
    ],
)
def test_frameworks_that_are_not_flat_are_refused(places, cause, said):
    with pytest.raises(PatternError, match=said) as found:
        bridges.from_pyrigi(framework(places, [tuple(bar) for bar in WHEEL]))
    assert type(found.value.__cause__) is cause


def test_a_hole_is_refused_and_the_vertices_are_named():
    """Two squares, one in the other, joined: the inner square is a face with four sides."""
    outer, inner = [(0, 0), (9, 0), (9, 9), (0, 9)], [(3, 3), (6, 3), (6, 6), (3, 6)]
    bars = [(k, (k + 1) % 4) for k in range(4)] + [(4 + k, 4 + (k + 1) % 4) for k in range(4)]
    bars += [(k, 4 + k) for k in range(4)] + [(k, 4 + (k + 1) % 4) for k in range(4)]
    with pytest.raises(PatternError, match="4-5-6-7 enclose a face of 4 sides"):
        bridges.from_pyrigi(framework(dict(enumerate(outer + inner)), bars))


# --- second-order rigidity -----------------------------------------------------------------------


@pytest.mark.parametrize("name", ["square", "triangle"])
def test_pyrigi_does_not_decide_second_order_rigidity_of_several_stresses(name):
    """What the notebook and the page say of PyRigi; if it fails, PyRigi has learned it."""
    pyrigi()
    with pytest.raises(ValueError, match="not implemented"):
        bridges.to_pyrigi(SHEETS[name]).is_second_order_rigid()


def test_one_stress_is_decided_alike():
    pyrigi()
    for pattern in (single_vertex(3), single_vertex(4)):
        rigid = decide_all_branches_real(pattern).solutions == 0
        assert bridges.to_pyrigi(pattern).is_second_order_rigid() is rigid


def test_rigid_by_a_stress_that_pyrigi_accepts():
    """Three corners: exactfold's multipliers give a stress that is definite on all flexes."""
    pyrigi()
    reality = decide_all_branches_real(TRIANGLE)
    assert (str(reality.verdict), reality.solutions) == ("proved", 0)
    stress = dict.fromkeys(TRIANGLE.edges, Fraction(0))
    for v, weight in reality.multipliers.items():
        for edge, w in wheel_stress(TRIANGLE, v).items():
            stress[edge] += weight * w
    rigid = bridges.to_pyrigi(TRIANGLE)
    assert rigid.is_dict_stress(stress)
    order = sorted(rigid.graph.vertex_list())
    matrix = rigid.stress_matrix([stress[e] for e in TRIANGLE.edges], TRIANGLE.edges, order)
    inside = [order.index(v) for v in TRIANGLE.interior]  # the corners held, as a triangle is rigid
    assert matrix.extract(inside, inside).is_positive_definite


def test_every_branch_is_a_flex_to_second_order_in_pyrigi():
    """The energies of all stresses of PyRigi vanish on the heights, which are rational here."""
    pyrigi()
    pattern = single_vertex(4)
    sheet = bridges.to_pyrigi(pattern)
    count = count_branches(pattern, method="groebner")
    assert len(count) == 2
    for branch in count:
        heights = branch.exact_heights
        flex = {v: (0, 0, heights[v]) for v in range(len(pattern.vertices))}
        assert sheet.is_dict_nontrivial_inf_flex(flex)
        (stress,) = sheet.stresses(pattern.edges)
        bent = zip(stress, pattern.edges, strict=True)
        assert sum(w * (heights[i] - heights[j]) ** 2 for w, (i, j) in bent) == 0


# --- Sage ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("pattern", [single_vertex(4), SHEETS["square"]], ids=["one", "three"])
def test_sage_finds_every_solution(pattern):
    sage()
    chart = BranchSystem(pattern).chart
    ideal = bridges.to_sage(chart.system, chart_names(chart))
    assert ideal.vector_space_dimension() == chart.system.bezout_number
    expected, symbols = bridges.to_sympy(chart.system, chart_names(chart))
    point = {str(s): Fraction(3 * k + 1, k + 2) for k, s in enumerate(symbols)}
    for generator, expression in zip(ideal.gens(), expected, strict=True):
        value = generator(**{str(s): ideal.base_ring()(point[str(s)]) for s in symbols})
        wanted = expression.subs({s: point[str(s)] for s in symbols})
        assert Fraction(int(value.numerator()), int(value.denominator())) == Fraction(str(wanted))


def test_sage_has_the_same_form():
    sage()
    pattern = SHEETS["square"]
    for v in pattern.interior:
        form = curvature_form(pattern, v)
        found = bridges.form_to_sage(form)
        assert tuple(found.signature_vector()) == form.inertia
        heights = {u: Fraction(u + 1, u + 3) for u in form.labels}
        value = found([found.base_ring()(heights[u]) for u in form.labels])
        assert Fraction(int(value.numerator()), int(value.denominator())) == form(heights)


# --- what a pattern may be ------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["to_pyrigi", "to_networkx", "to_trimesh"])
def test_names_paths_and_nothing_else_stand_for_a_pattern(name):
    if name == "to_pyrigi":
        pyrigi()
    function = getattr(bridges, name)
    vertices = {
        "to_pyrigi": lambda framework: framework.graph.vertex_list(),
        "to_networkx": lambda graph: graph.nodes,
        "to_trimesh": lambda mesh: mesh.vertices,
    }[name]
    for what in ("two-vertex", example_path("two-vertex"), two_vertex()):
        assert len(vertices(function(what))) == 6
    with pytest.raises(UsageError, match="3 is not a pattern"):
        function(3)


# --- NetworkX ------------------------------------------------------------------------------------


def test_the_graph_has_points_letters_and_faces():
    pattern = SHEETS["square"]
    (branch, *_) = count_branches(pattern)
    graph = bridges.to_networkx(pattern, branch.assignment)
    assert [graph.nodes[v]["pos"] for v in sorted(graph)] == list(pattern.vertices)
    letters = {tuple(sorted(e)): letter for *e, letter in graph.edges(data="letter")}
    assert letters == branch.assignment | dict.fromkeys(pattern.boundary_edges, "B")
    assert {v for v, inside in graph.nodes(data="interior") if inside} == set(pattern.interior)
    # Euler's formula, and the pattern again from what the graph holds.
    assert len(graph) - graph.size() + len(graph.graph["faces"]) == 1
    places = [graph.nodes[v]["pos"] for v in sorted(graph)]
    assert CreasePattern(places, graph.graph["faces"]) == pattern
    mountains = nx.Graph(e for *e, letter in graph.edges(data="letter") if letter == "M")
    assert mountains.size() == list(branch.assignment.values()).count("M")


def test_a_graph_of_panels():
    crossed = Drawing(
        ((0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (1, 2)),
        (Line(0, 1, "B"), Line(1, 2, "B"), Line(2, 3, "B"), Line(3, 0, "B"), Line(4, 5, "M")),
        "a square with one crease",
    )
    opened = from_drawing(crossed)
    graph = bridges.to_networkx(opened.sheet, opened.assignment)
    assert [e for *e, letter in graph.edges(data="letter") if letter == "M"] == [[4, 5]]
    assert sorted(map(len, graph.graph["faces"])) == [4, 4]


# --- trimesh -------------------------------------------------------------------------------------


def test_the_mesh_is_the_sheet():
    pattern = SHEETS["square"]
    mesh = bridges.to_trimesh(pattern)
    assert mesh.faces.tolist() == [list(t) for t in pattern.triangles]
    assert mesh.area == pytest.approx(float(pattern.area))
    assert mesh.face_normals == pytest.approx(np.tile([0, 0, 1], (len(pattern.triangles), 1)))
    assert not mesh.is_watertight
    assert len(mesh.face_adjacency) == len(pattern.folds)


def test_a_mesh_in_space_has_the_angles_of_its_folds():
    pattern = CreasePattern([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1, 2), (0, 2, 3)])
    places = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0.5, 0.5, 0.5**0.5)]
    mesh = bridges.to_trimesh(pattern, places)
    assert mesh.face_adjacency_angles == pytest.approx([np.pi / 2])


def test_coordinates_of_another_shape_are_refused():
    with pytest.raises(UsageError, match=r"\(6, 3\), not \(6, 2\)"):
        bridges.to_trimesh("two-vertex", np.zeros((6, 2)))
