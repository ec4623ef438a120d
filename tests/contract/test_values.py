"""What holds of every public value: it pickles, copies, compares, and shows itself in one line."""

from __future__ import annotations

import copy
import inspect
import pickle
from fractions import Fraction
from functools import cached_property

import numpy as np
import pytest
import rooms
from flint import fmpq, fmpq_mat

import exactfold
from exactfold import errors
from exactfold.motion.loops.loops import LoopFinder
from exactfold.panels.isolated import IsolatedWays
from exactfold.pattern.families import H1Triangulation, sample_h1_sequence, single_vertex
from exactfold.pattern.opening import panels
from exactfold.pattern.triangulating.random_squares import sample_random_square
from exactfold.pattern.writing.panel_writing import converted
from exactfold.rigidity.equations.problem import Problem
from exactfold.rigidity.equations.sheet import VertexEquations
from exactfold.rigidity.kapovich_millson import kapovich_millson
from exactfold.solve.algebraic.exact_solution import RootClass
from exactfold.solve.algebraic.quotient import QuotientAlgebra
from exactfold.solve.certify.box import IsolatingBox, Uncertified
from exactfold.solve.numeric.candidates import Candidates

PATTERN = exactfold.pattern.read_fold(exactfold.pattern.data.example_path("two-vertex"))
FLAT = exactfold.pattern.read_fold(exactfold.pattern.data.example_path("flat-octahedron"))
SYSTEM = exactfold.rigidity.BranchSystem(PATTERN)
ENDS = exactfold.solve.newton(SYSTEM.chart)
COUNT = exactfold.branches.count_branches(PATTERN)
EXACT = exactfold.branches.count_branches(
    exactfold.pattern.read_fold(exactfold.pattern.data.example_path("flat-vertex")),
    method="groebner",
)
SOLUTION = exactfold.solve.groebner(SYSTEM.chart.system)


def _streamed(folder):
    return exactfold.branches.stream_branches(PATTERN, folder / "branches.txt")


DRAWING = exactfold.pattern.read_drawing(exactfold.pattern.data.example_path("zigzags"))
SHEETS = exactfold.pattern.exact_sheets(DRAWING)
BENT = {  # the path 0-4-2 is straight but for the last digits
    "vertices_coords": [
        [0, 0],
        [3.0123456789, 0.1234567890123],
        [2.2345678901234, 2.3456789012345],
        [0.1112131415161, 1.0987654321],
        [0.8267901193457, 0.8679011934568],
    ],
    "faces_vertices": [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
}
CELL = exactfold.pattern.read_cell("yoshimura-cell")
ROLLED = exactfold.branches.count_periodic(CELL, (1, 2))
TURNED = exactfold.branches.count_directions("waterbomb-cell")
PANEL_CELL = exactfold.panels.count_panel_cell("miura-cell")
ROLLING = exactfold.motion.roll(
    "waterbomb-cell", (1, 2), way=2, cells=(1, 2), until="20deg", frames=2
)
LINE = exactfold.branches.AlgebraicLine((-2, 0, 1), (Fraction(1), Fraction(2)), ((Fraction(0),),))
OPENED = exactfold.pattern.open_pattern(exactfold.pattern.data.example_path("zigzags"))
PIECES = exactfold.branches.find_connected_components(
    exactfold.CreasePattern(
        [(0, 0), (4, 0), (5, 3), (2, 5), (-1, 3), (1, 2), (3, 2)],
        [(0, 1, 5), (1, 6, 5), (1, 2, 6), (2, 3, 6), (3, 5, 6), (3, 4, 5), (4, 0, 5)],
    )
)
MOTIONS = exactfold.panels.decompose(OPENED.sheet)
SPACES = exactfold.panels.decompose(panels(single_vertex(5)))
MOTION = exactfold.motion.follow(exactfold.branches.find_branch(PATTERN, "+-"), frames=4)
BY_FOLDS = exactfold.motion.find_driven(single_vertex(5), {(0, 5): 9, (2, 5): 6})
HINGES = exactfold.design.Hinges(Fraction(1, 2), Fraction(100))
DRIVEN = exactfold.design.actuate(exactfold.pattern.data.example_path("single-vertex-4"), "+")
ALL = exactfold.design.all_assignments(single_vertex(5))
MATCH = exactfold.design.match(PATTERN, exactfold.branches.find_branch(PATTERN, "+-").assignment)
OVER_A_RIM = exactfold.design.match_boundary(single_vertex(5), "MMVMV")
TWIST = exactfold.design.match_panels("square-twist")
TWELVE = exactfold.design.panel_assignments("square-twist")
ONE = exactfold.random_square(1, seed=0)
LEAVING = exactfold.branches.find_branch(ONE, "+")
TRACK = exactfold.motion.follow_proved(LEAVING, until=0.3)
LOOPS = exactfold.motion.find_loops(ONE)
FLAT_FOLDABLE = exactfold.panels.decompose(panels(single_vertex(4)))
PROVING = {
    "plates": exactfold.motion.Solid(Fraction(1, 5), "middle", Fraction(1, 4)),
    "stops": exactfold.motion.Stops(Fraction(90), {(0, 4): Fraction(30)}),
    "motion of panels": exactfold.motion.follow_panels(FLAT_FOLDABLE, frames=3),
    "clearance of panels": exactfold.motion.prove_contacts(
        exactfold.motion.follow_panels(FLAT_FOLDABLE, until="20deg", frames=2)
    ),
    "proof of panels": exactfold.motion.prove_panels(
        exactfold.motion.follow_panels(FLAT_FOLDABLE, until="20deg", frames=2)
    ),
    "way of panels": exactfold.motion.panel_ways(FLAT_FOLDABLE)[0],
    "mode of panels": exactfold.motion.panel_modes(FLAT_FOLDABLE)[0],
    "track": TRACK,
    "frame of a track": TRACK.frame(0.2),
    "link": TRACK.links[0],
    "tube": TRACK.links[0].tube,
    "start tube": TRACK.start,
    "ball": TRACK.frame(0.2).ball,
    "proof of a motion": exactfold.motion.prove(
        exactfold.motion.follow(LEAVING, until="30deg", frames=2)
    ),
    "first contact": exactfold.motion.first_contact(LEAVING)[1],
    "loops": LOOPS,
    "loop": LOOPS.loops[0],
    "half-branch": LOOPS.loops[0].source,
    "range of a fold": LOOPS.loops[0].folds[0],
    "configuration graph": LOOPS.graph,
    "arc of a graph": LOOPS.graph.arcs[0],
    "proof of a loop": LoopFinder(Problem.of(ONE)).follow(LEAVING),
}
RUN = exactfold.studies.run_study("table1", numbers={2: 1})
STUDIES = {
    "study": RUN.study,
    "run of a study": RUN,
    "table of a study": RUN.tables[0],
    "stored row": exactfold.studies.StoredRow("0", {"seed": 1}, {"status": "proved"}),
    "row computed again": exactfold.studies.Recomputed(
        RUN.study,
        exactfold.studies.StoredRow("0", {"seed": 1}, {"status": "proved"}),
        {"status": "undecided"},
    ),
}
FLAT_TWIST = exactfold.flat("square-twist")
FLAT_MAP = exactfold.flat("map-fold", "any")
FISH_END = exactfold.layers.reached(exactfold.follow("fish-base", 3, until="180deg", frames=2))
LAYERS = {
    "state that a motion reaches": FISH_END,
    "end of a way": exactfold.layers.WayEnd(
        3, dict(FISH_END.motion.assignment), FISH_END.status, "", 0, None, FISH_END
    ),
    "flat-folded states": FLAT_MAP,
    "no flat-folded state": FLAT_TWIST,
    "state": FLAT_MAP.state(3),
    "part of states": FLAT_MAP.components[0],
    "images": FLAT_MAP.images,
    "isometry": FLAT_MAP.images.maps[1],
    "convex pieces": FLAT_MAP.images.pieces,
    "conflict": FLAT_TWIST.conflict[0],
    "constraint": FLAT_TWIST.conflict[0].constraint,
    "failure of a vertex": exactfold.flat("zigzags").failures[0],
}
VALUES = {
    **PROVING,
    **STUDIES,
    **LAYERS,
    "pattern": PATTERN,
    "cell": CELL,
    "periodic count": ROLLED,
    "periodic branch": ROLLED[0],
    "all directions": TURNED,
    "rolling motion": ROLLING,
    "tessellation of panels": PANEL_CELL,
    "periodic motion": PANEL_CELL[0],
    "part of a periodic motion": PANEL_CELL[0].parts[0],
    "crossing of branches": TURNED.crossings[0],
    "exact direction": TURNED.crossings[0].direction,
    "rolling branch": TURNED.branches[0],
    "space of heights": ROLLED.pleats[0],
    "algebraic line": LINE,
    "pattern with long coordinates": exactfold.CreasePattern(
        [(0, 0), (10**5000, 0), (0, "1/7"), (1, "1/50")], [(0, 1, 3), (1, 2, 3), (2, 0, 3)]
    ),
    "file": exactfold.pattern.load_fold(exactfold.pattern.data.example_path("waterbomb")),
    "snapped file": exactfold.pattern.load_fold(
        exactfold.pattern.data.example_path("random-8"), snap=1000
    ),
    "family": sample_h1_sequence(40, seed=0),
    "sample": sample_random_square(4, seed=3),
    "form": exactfold.rigidity.curvature_form(PATTERN, 4),
    "facts": exactfold.rigidity.pattern_facts(FLAT),
    "reality": exactfold.rigidity.decide_all_branches_real(PATTERN),
    "projective image": exactfold.rigidity.project(PATTERN, [(9, 0, 0), (1, 9, 0), (0, 0, 9)]),
    "tracks": kapovich_millson([(1, 0), (0, 1), (-1, 0), (0, -1)]),
    "branch system": SYSTEM,
    "chart": SYSTEM.chart,
    "quadrics": SYSTEM.chart.system,
    "warning": exactfold.pattern.near_degenerate(
        exactfold.CreasePattern(
            [*PATTERN.vertices[:5], ("2/3", "0.3333333333333")], PATTERN.triangles
        )
    ),
    "problem": Problem.of(PATTERN),
    "all assignments": ALL,
    "all assignments of panels": TWELVE,
    "assignments of a part": TWELVE.parts[0],
    "forcing set": exactfold.design.forcing_set(TWELVE),
    "circle": ALL.circles[0],
    "arc of a circle": ALL.circles[0].arcs[0],
    "crossing": ALL.circles[0].crossings[0],
    "number of shapes": exactfold.branches.count_shapes(PATTERN, {4: 1}),
    "gauge": Problem.of(PATTERN).gauge,
    "sheet": VertexEquations(Problem.of(PATTERN)),
    "candidates": ENDS,
    "box": exactfold.solve.krawczyk(SYSTEM.chart.system, ENDS.points)[0],
    "complex box": exactfold.solve.krawczyk(
        exactfold.rigidity.QuadraticSystem.from_rational([[[1, 0], [0, 2]]]), [[1.41421356j]]
    )[0],
    "no box": exactfold.solve.krawczyk(SYSTEM.chart.system, [[1e9, 1e9]])[0],
    "isolation": exactfold.solve.isolate(SYSTEM.chart.system, ENDS),
    "solution": SOLUTION,
    "class": SOLUTION.classes[0],
    "algebra": exactfold.solve.quotient_algebra(SYSTEM.chart.system),
    "drawing": DRAWING,
    "line": DRAWING.lines[0],
    "sheets": SHEETS,
    "repair": SHEETS.repairs[0],
    "exact coordinates": SHEETS.coordinates,
    "opened drawing": OPENED,
    "sheet that was meant": exactfold.read(BENT).meant,
    "converted drawing": converted(OPENED),
    "panels": OPENED.sheet,
    "facts of panels": exactfold.branches.panel_facts(OPENED.sheet),
    "pieces": PIECES,
    "joint": PIECES.joints[0],
    "decomposition": MOTIONS,
    "mode": MOTIONS.modes[0],
    "extension": MOTIONS.modes[0].extends,
    "support": MOTIONS.parts[0].supports[0],
    "leaf": SPACES.parts[0].spaces[0],
    "isolated ways": IsolatedWays(((0, 1), (0, 2)), (1, -1), (IsolatingBox((3,), (), 1, 2),), ()),
    "count": COUNT,
    "exact count": EXACT,
    "count with flat vertices": exactfold.branches.count_branches(FLAT),
    "branch": COUNT.branches[0],
    "exact branch": EXACT.branches[0],
    "angles": COUNT.branches[0].fold_angles,
    "export": exactfold.branches.exported(COUNT.branches[0]),
    "solver": exactfold.branches.solvers()["newton"],
    "finder": exactfold.branches.BranchFinder(PATTERN),
    "signed branch": exactfold.branches.find_branch(PATTERN, "+-"),
    "motion": MOTION,
    "event": MOTION.events[-1],
    "driven": BY_FOLDS,
    "drive": BY_FOLDS.drive,
    "framework": MOTION.curve.framework,
    "start": exactfold.motion.Start.of(
        MOTION.curve.framework, np.array([0.0, 0.0, 0.0, 1.0, 0.3, -0.1])
    ),
    "actuation": DRIVEN,
    "actuation of panels": exactfold.actuate("zigzags", way=1, hinges=HINGES),
    "hinges": HINGES,
    "tolerance": exactfold.tolerance("two-vertex", "+-"),
    "design": exactfold.design.designed(PATTERN, maximise="tolerance"),
    "tolerance of panels": exactfold.tolerance("zigzags", way=1),
    "relation of panels": exactfold.tolerance("zigzags", way=1).closings[0][1],
    "lines of a certificate": exactfold.branches.certificate(COUNT),
    "checked certificate": exactfold.check(exactfold.branches.certificate(COUNT)),
    "match": MATCH,
    "half of a branch": MATCH.matches[0],
    "nearest branches": exactfold.design.nearest_branches(MATCH),
    "branches with letters": exactfold.branches.Lettered(exactfold.PROVED, ((1, -1),)),
    "refutation of letters": MATCH.refutations[0],
    "match of panels": TWIST,
    "match over a rim": OVER_A_RIM,
    "refutation of panels": TWIST.refutations[0],
    "directions": DRIVEN.directions,
    "orthogonal torques": DRIVEN.orthogonal,
    "ranked": DRIVEN.ranking()[0],
    "verdict": exactfold.UNDECIDED,
    "streamed": None,  # made for each test, in a folder of its own
}


@pytest.fixture(params=VALUES)
def value(request, tmp_path):
    return _streamed(tmp_path) if request.param == "streamed" else VALUES[request.param]


def warmed(value):
    """The value after each of its cached properties was asked for, as after a day's work."""
    for name, attribute in inspect.getmembers(type(value)):
        if isinstance(attribute, cached_property) or name == "sha256":
            getattr(value, name)
    return value


def test_no_public_class_is_missing(tmp_path):
    public = {
        thing
        for thing in rooms.public().values()
        if inspect.isclass(thing) and not issubclass(thing, BaseException)
    }
    shown = {type(value) for value in VALUES.values()} | {type(_streamed(tmp_path))}
    assert public - shown == {exactfold.Result}
    assert {RootClass, H1Triangulation, QuotientAlgebra, Uncertified, Candidates} <= shown


def test_a_pickle_gives_an_equal_value(value):
    again = pickle.loads(pickle.dumps(warmed(value)))
    assert type(again) is type(value)
    assert again == value


def test_a_deep_copy_is_an_equal_value(value):
    assert copy.deepcopy(warmed(value)) == value
    assert copy.copy(value) == value


def test_equal_values_have_equal_hashes(value):
    again = pickle.loads(pickle.dumps(value))
    try:
        expected = hash(value)
    except TypeError:  # it holds a mapping
        with pytest.raises(TypeError, match="unhashable"):
            hash(again)
    else:
        assert hash(again) == expected
        assert {value: 1}[again] == 1


def test_a_value_differs_from_those_of_other_kinds(value):
    assert value != "something else"
    assert sum(value == other for other in VALUES.values()) <= 1


def test_a_value_shows_itself_in_one_line(value):
    text = repr(value)
    assert "\n" not in text
    assert 0 < len(text) < 200


# --- patterns ------------------------------------------------------------------------------------


def test_a_pickled_pattern_holds_no_caches():
    size = len(pickle.dumps(warmed(PATTERN)))
    fresh = exactfold.CreasePattern(PATTERN.vertices, PATTERN.triangles)
    assert size == len(pickle.dumps(fresh))


def test_an_unpickled_pattern_works_like_the_one_it_came_from():
    again = pickle.loads(pickle.dumps(PATTERN))
    assert (again.boundary, again.interior, again.folds) == (
        PATTERN.boundary,
        PATTERN.interior,
        PATTERN.folds,
    )
    assert [again.star(v) for v in range(6)] == [PATTERN.star(v) for v in range(6)]
    assert again.sha256 == PATTERN.sha256
    with pytest.raises(AttributeError):
        again.vertices = ()


def test_an_unpickled_pattern_is_not_validated_again(monkeypatch):
    stored = pickle.dumps(PATTERN)
    monkeypatch.setattr(exactfold.CreasePattern, "__init__", None)
    assert pickle.loads(stored) == PATTERN


def test_the_letters_of_a_file_cannot_be_changed():
    letters = {(0, 1): "M"}
    file = exactfold.pattern.FoldFile(PATTERN, assignment=letters)
    letters[0, 1] = "V"
    assert file.assignment == {(0, 1): "M"}
    for one in (file, pickle.loads(pickle.dumps(file)), copy.deepcopy(file)):
        with pytest.raises(TypeError):
            one.assignment[0, 1] = "V"


# --- verdicts, errors, arrays --------------------------------------------------------------------


@pytest.mark.parametrize("verdict", exactfold.Verdict)
def test_there_is_one_of_each_verdict(verdict):
    assert pickle.loads(pickle.dumps(verdict)) is verdict
    assert copy.deepcopy(verdict) is verdict


@pytest.mark.parametrize(
    "kind",
    [
        kind
        for _, kind in inspect.getmembers(errors, inspect.isclass)
        if issubclass(kind, errors.ExactfoldError)
    ],
)
def test_errors_come_back_from_a_worker_with_all_they_say(kind):
    named = {"vertices": [3], "edges": [(0, 3)], "faces": [1, 2]}
    error = kind("it is so", **named if issubclass(kind, errors.PatternError) else {})
    for again in (pickle.loads(pickle.dumps(error)), copy.deepcopy(error)):
        assert type(again) is kind
        assert str(again) == "it is so"
        assert again.__dict__ == error.__dict__
    if issubclass(kind, errors.PatternError):
        assert (again.vertices, again.edges, again.faces) == ((3,), ((0, 3),), (1, 2))


@pytest.mark.parametrize("change", ["method", "points", "lost", "settings"])
def test_candidates_compare_by_all_they_hold(change):
    one = Candidates("by hand", np.array([[1.0 + 0j]]), ("lost",), {"seed": 1})
    values = {"method": "other", "points": np.array([[2.0 + 0j]]), "lost": (), "settings": {}}
    fields = {name: getattr(one, name) for name in values}
    assert Candidates(**fields) == one
    assert Candidates(**fields | {change: values[change]}) != one


def test_algebras_compare_by_basis_and_matrices():
    one = QuotientAlgebra(((0,), (1,)), (fmpq_mat([[0, 3], [1, 0]]),))
    assert QuotientAlgebra(one.basis, (fmpq_mat([[0, fmpq(1, 3)], [1, 0]]),)) != one


def test_forms_compare_by_all_they_hold():
    form = exactfold.exact.QuadraticForm(
        (4, 5), ((Fraction(1), Fraction(0)), (Fraction(0), Fraction(2)))
    )
    assert exactfold.exact.QuadraticForm((4, 6), form.matrix) != form
    assert exactfold.exact.QuadraticForm((4, 5), form.matrix[::-1]) != form
