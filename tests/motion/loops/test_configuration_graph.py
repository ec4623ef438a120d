"""The graph of configurations: branch points, arcs on no loop, angles and whole turns."""

from dataclasses import replace
from fractions import Fraction
from functools import cache
from itertools import pairwise
from math import factorial
from types import SimpleNamespace

import networkx as nx
import numpy as np
import pytest
from loops import Tracker

from exactfold import random_square
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches import find_branch
from exactfold.branches.counting.pools import process_pool
from exactfold.motion import find_loops
from exactfold.motion.contacts.fold_ranges import SLACK, Stretch, angles_in, box_angles, fold_ranges
from exactfold.motion.curves.framework import Framework
from exactfold.motion.following import follow
from exactfold.motion.loops import graph_building
from exactfold.motion.loops.configuration_graph import (
    ConfigurationGraph,
    EndAtBranchPoint,
    GraphArc,
)
from exactfold.motion.loops.graph_building import graph_of
from exactfold.motion.loops.loops import LoopFinder
from exactfold.motion.loops.proofs import Loop
from exactfold.motion.loops.rays import Ray
from exactfold.motion.tubes import visits
from exactfold.motion.tubes.piece import Ball
from exactfold.motion.tubes.visits import LocatedBranchPoint, crosses
from exactfold.rigidity.equations.problem import Problem

SHEET, SIGNS = random_square(4, seed=75), "++++"
PROBLEM = Problem.of(SHEET)
FRAMEWORK = Framework.of(PROBLEM.sheet)
SOURCE, TARGET = Ray((1,), 1), Ray((1,), -1)
ONCE = Fraction(1), Fraction(1)


@cache
def loop() -> Loop:
    """A loop that passes a branch point and, later, one with the same star flat."""
    found = LoopFinder(PROBLEM).follow(find_branch(SHEET, SIGNS)).loop
    assert found.status is PROVED
    assert found.through == ((6,), (6,))
    return found


@cache
def node() -> LocatedBranchPoint:
    found = LocatedBranchPoint.of(FRAMEWORK, loop().visits[0])
    assert found is not None
    return found


# --- branch points
# ---------------------------------------------------------------------------------------


def test_a_node_has_two_lines_and_a_mirror_image():
    assert len(node().lines) == 2
    assert node().has_all_lines
    visit = loop().visits[0]
    assert node().meets(visit) is True
    assert node().meets(visit.mirrored) is False
    assert node().mirrored.meets(visit.mirrored) is True
    line, side = node().side(visit)
    assert node().mirrored.side(visit.mirrored) == (line, side)
    back = replace(visit, direction=turned_round(visit.direction))
    assert node().side(back) == (line, -side)


def turned_round(ball: Ball) -> Ball:
    return replace(ball, centre=tuple(-x for x in ball.centre))


def test_a_loop_passes_one_node_on_both_of_its_lines():
    """So it crosses itself there: `docs/matching.md` names the sheet for this loop."""
    first, second = loop().visits
    assert first.time[1] < second.time[0]
    assert node().meets(second) is True
    assert {node().side(first)[0], node().side(second)[0]} == {0, 1}


def test_what_is_not_certain_of_a_node_is_not_said():
    visit = loop().visits[0]
    wide = replace(
        visit.branch_point,
        radii=tuple(1 << visit.branch_point.bits - 4 for _ in visit.branch_point.radii),
    )
    assert node().meets(replace(visit, branch_point=wide)) is None
    assert LocatedBranchPoint.of(FRAMEWORK, replace(visit, branch_point=wide)) is None
    # The same place, with another star said to be flat.
    assert node().meets(replace(visit, flat=(visit.flat[0] + 1,))) is None
    vague = Ball(
        visit.direction.bits,
        visit.direction.centre,
        tuple(1 << visit.direction.bits for _ in visit.direction.radii),
    )
    assert node().side(replace(visit, direction=vague)) is None
    one_line = LocatedBranchPoint(node().point, node().lines[:1])
    assert not one_line.has_all_lines
    assert one_line.side(visit) is None


def test_directions_cross_only_where_a_minor_is_not_zero():
    east, north = Ball(0, (9, 0, 0), (1, 1, 1)), Ball(0, (0, 9, 0), (1, 1, 1))
    assert crosses(east, north)
    assert not crosses(east, turned_round(east))
    assert not crosses(east, Ball(0, (9, 2, 0), (1, 1, 1)))
    assert crosses(east, Ball(0, (9, 3, 0), (1, 1, 1)))


def test_the_angles_at_a_node_are_flat_where_the_star_is():
    flat = PROBLEM.labels.index(6)
    angles = box_angles(FRAMEWORK, node().point.ball)
    for (low, high), hinge in zip(angles, FRAMEWORK.hinges, strict=True):
        assert low <= high < low + Fraction(1, 1000)
        assert (low <= 0 <= high) == (flat in hinge[:2])


# --- arcs ----------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def graph() -> ConfigurationGraph:
    """From one loop alone: what leaves its branch points elsewhere has to be followed."""
    return graph_of(PROBLEM, [loop()], "the other rays were not tried", process_pool(1))


def test_arcs_go_from_node_to_node_and_to_the_flat_state(graph):
    assert graph.status is UNDECIDED
    assert graph.reason == "the other rays were not tried"
    assert all(arc.status is PROVED for arc in graph.arcs)
    assert all(node.status is PROVED and node.curves == 2 for node in graph.nodes)
    assert graph.independent_cycles is None
    found = graph.to_networkx()
    assert nx.is_connected(found)
    for k, node in enumerate(graph.nodes):
        assert found.degree(k) == 4
        assert node.flat == (6,)
        assert graph.nodes[node.mirror].mirror == k != node.mirror
        assert node.loops == (0,)


def test_the_mirror_image_of_an_arc_is_an_arc(graph):
    for k, arc in enumerate(graph.arcs):
        other = graph.arcs[arc.mirror]
        assert (other.mirror, other.length, other.loop) == (k, arc.length, arc.loop)
        assert (other.start, other.end) == (arc.start.mirrored, arc.end.mirrored)


def test_the_arcs_of_a_loop_are_as_long_as_the_loop(graph):
    parts = [arc for k, arc in enumerate(graph.arcs) if arc.loop == 0 and k % 2 == 0]
    assert parts[0].start == loop().source
    assert parts[-1].end == loop().target
    for before, after in pairwise(parts):
        assert before.end.opposite == after.start
    low, high = loop().length
    assert sum(arc.length[0] for arc in parts) <= high
    assert sum(arc.length[1] for arc in parts) >= low
    assert high - low <= sum(arc.length[1] - arc.length[0] for arc in parts) < Fraction(1, 1000)


@pytest.mark.parametrize(
    ("number", "seed"),
    [
        pytest.param(4, 75, marks=pytest.mark.survey),
        pytest.param(5, 0, marks=pytest.mark.survey),
    ],
)
def test_the_whole_component_of_the_flat_state(number, seed):
    """Arcs from branch points are those of the loops; one of f stars has 2^(f + 1) sides."""
    found = find_loops(random_square(number, seed=seed))
    graph = found.graph
    assert graph.status is PROVED
    degrees = graph.to_networkx().degree
    assert degrees["flat"] == 2 << number
    assert [degrees[k] for k in range(len(graph.nodes))] == [
        2 << len(node.flat) for node in graph.nodes
    ]
    assert graph.independent_cycles == len(graph.arcs) - len(graph.nodes)
    passages = sum(len(loop.through) for loop in found.loops)
    assert len(graph.arcs) >= 2 * (len(found.loops) + passages)
    assert graph.nodes


def test_lines_that_are_missing_and_nodes_that_are_not_located_are_said(monkeypatch):
    monkeypatch.setattr(visits, "directions_at", lambda *_: [node().lines[0].floats[0]])
    found = graph_of(PROBLEM, [loop()], "", process_pool(1))
    assert found.status is UNDECIDED
    assert "not all curves" in found.reason
    assert [node.curves for node in found.nodes] == [1, 1]
    assert all(arc.status is UNDECIDED and arc.reason for arc in found.arcs)
    monkeypatch.setattr(graph_building.LocatedBranchPoint, "of", lambda *_: None)
    found = graph_of(PROBLEM, [loop()], "", process_pool(1))
    assert found.nodes == ()
    assert "could not be located" in found.reason


def test_an_arc_that_is_not_followed_is_open(monkeypatch):
    alone = replace(loop(), visits=loop().visits[:1])
    monkeypatch.setattr(LoopFinder, "_followed", lambda *_, **__: ([], None, "lost"))
    found = graph_of(PROBLEM, [alone], "", process_pool(1))
    left = [arc for arc in found.arcs if arc.end is None]
    assert len(left) == 4
    assert all(arc.reason == "lost" and arc.length[0] > 0 for arc in left)
    assert found.reason == "4 arcs are not proved from end to end"


def test_loops_that_contradict_each_other_are_a_defect():
    known = Loop(SOURCE, TARGET, (), ONCE, PROVED, "", 1)
    problem = Problem.of(random_square(1, seed=0))
    graph = graph_of(problem, [known], "", process_pool(1))
    assert graph == graph_of(problem, [known, known], "", process_pool(1))
    assert [(arc.start, arc.end) for arc in graph.arcs] == [
        (SOURCE, TARGET),
        (SOURCE.mirrored, TARGET.mirrored),
    ]
    with pytest.raises(ArithmeticError, match="contradict"):
        graph_of(problem, [known, replace(known, target=TARGET.mirrored)], "", process_pool(1))
    with pytest.raises(ArithmeticError, match="its own mirror image"):
        graph_of(problem, [replace(known, target=SOURCE.mirrored)], "", process_pool(1))
    short = replace(known, target=None, status=UNDECIDED, reason="lost")
    assert [arc.reason for arc in graph_of(problem, [short], "", process_pool(1)).arcs] == [
        "lost",
        "lost",
    ]


def arc(start, end):
    return GraphArc(start, end, ONCE, PROVED, "", None, 0)


def test_closed_curves_go_straight_on():
    """An eight through the flat state, and a ring through both of its branch points."""
    arcs = (
        arc(SOURCE, EndAtBranchPoint(0, 0, 1)),
        arc(EndAtBranchPoint(0, 0, -1), TARGET),
        arc(EndAtBranchPoint(0, 1, 1), EndAtBranchPoint(1, 0, -1)),
        arc(EndAtBranchPoint(0, 1, -1), EndAtBranchPoint(1, 0, 1)),
        arc(EndAtBranchPoint(1, 1, 1), EndAtBranchPoint(1, 1, -1)),
    )
    graph = ConfigurationGraph((), arcs, PROVED, "")
    assert graph.closed_curves == ((2, 3), (4,))
    cut = ConfigurationGraph((), (*arcs[:3], arc(EndAtBranchPoint(0, 1, -1), None)), PROVED, "")
    assert cut.closed_curves == ()


# --- angles and turns ----------------------------------------------------------------------------


def test_extreme_angles_and_turns_agree_with_floats():
    pattern = random_square(2, seed=3)
    branch = find_branch(pattern, "+-")
    found = LoopFinder(Problem.of(pattern)).follow(branch).loop
    motion = follow(branch, until="return", frames=400)
    degrees = np.degrees(motion.angles)
    heights = np.array([float(branch.approx_heights[v]) for v in range(len(pattern.vertices))])
    seen = Tracker(pattern).follow(heights)
    assert len(found.folds) == len(pattern.folds)
    for k, fold in enumerate(found.folds):
        assert fold.fold == pattern.folds[k]
        least, greatest = degrees[:, k].min(), degrees[:, k].max()
        assert fold.least[0] <= least < fold.least[1] + 2
        assert fold.greatest[0] - 2 < greatest <= fold.greatest[1]
        assert fold.least[1] - fold.least[0] < Fraction(1, 10)
        assert fold.greatest[1] - fold.greatest[0] < Fraction(1, 10)
        assert fold.turns == seen.turns[k]
        printed = fold.to_dict()
        for key, exact in (("least", fold.least), ("greatest", fold.greatest)):
            assert printed[key] == pytest.approx([float(x) for x in exact], abs=1e-9)
            assert printed[key][0] <= exact[0] <= exact[1] <= printed[key][1]
    assert any(fold.turns for fold in found.folds)
    assert any(fold.least[1] < -1 for fold in found.folds)


def test_every_proved_loop_of_a_sheet_has_its_angles():
    found = find_loops(random_square(3, seed=9901))
    assert [len(loop.folds) for loop in found.loops] == [10] * 4


def test_at_every_vertex_an_even_number_of_folds_wind():
    """The product of the half-turn quaternions around a vertex is 1: docs/matching.md."""
    for v in SHEET.interior:
        assert sum(fold.turns for fold in loop().folds if v in fold.fold) % 2 == 0


def test_a_box_of_configurations_bounds_the_angles_of_all_of_them():
    box = node().point.ball
    wide = Ball(box.bits, box.centre, tuple(1 << box.bits - 12 for _ in box.radii))
    (middle,), (spread,) = angles_in(FRAMEWORK, wide)
    (exact,), (small,) = angles_in(FRAMEWORK, box)
    known = np.isfinite(spread)
    assert known.any()
    assert (small < 1e-6).all()
    assert (spread[known] > 2.0**-14).all()
    assert (np.abs(middle - exact)[known] <= spread[known]).all()
    far = Ball(box.bits, box.centre, tuple(1 << box.bits for _ in box.radii))
    assert np.isinf(angles_in(FRAMEWORK, far)[1]).all()
    assert set(box_angles(FRAMEWORK, far)) == {(-180, 180)}  # nothing is known, and so it is said


def test_angles_that_are_not_followed_are_not_guessed():
    """A fold whose positions are known too roughly: on the whole chain, or on one part of it."""
    names = PROBLEM.sheet.folds
    still = Stretch.at(FRAMEWORK, Ball(8, (0,) * FRAMEWORK.size, (0,) * FRAMEWORK.size))
    ranges = fold_ranges(FRAMEWORK, [still, still], names)
    assert ranges is not None
    assert all(fold.turns == 0 and fold.least[1] == fold.greatest[0] == 0 for fold in ranges)
    rough = replace(still, radius=np.full_like(still.radius, 0.3), end=1.0)
    assert fold_ranges(FRAMEWORK, [still, rough, still], names) is None


def hinge(turn, begin, end, unit=1.0):
    """A stretch on which one fold has the angle `turn` + s / `unit`, and its framework."""
    points = ((0, 0), (0, 1), (-1, 0), (1, 0))
    framework = SimpleNamespace(points=points, bits=4, hinges=np.array([[0, 1, 2, 3]]))
    coefficients = np.zeros((21, 4, 3))
    coefficients[0, :, :2] = np.array(points) / 16
    for k in range(21):
        quarter = turn + k * np.pi / 2
        scale = 16 * factorial(k) * unit**k
        coefficients[k, 2] = -np.cos(quarter) / scale, 0, np.sin(quarter) / scale
    return framework, Stretch(coefficients, np.full((4, 3), 1e-7), begin * unit, end * unit)


def test_a_fold_that_turns_fast_where_stretches_meet_is_not_guessed():
    """Where within `SLACK` of its beginning a stretch meets the last one is not known.

    If it is where the fold is flat, angles from before it are none of the chain.
    """
    framework, still = hinge(0.0, 0.0, 0.0)
    _, spin = hinge(0.0, -3.5, 0.0)
    ranges = fold_ranges(framework, [still, hinge(0.0, 0.0, -3.5)[1], spin, still], [(0, 1)])
    assert [fold.turns for fold in ranges] == [0]
    assert -201 < ranges[0].least[0] < np.degrees(-3.5) < ranges[0].least[1] < -200
    _, fast = hinge(0.0, -3.5, 0.0, unit=SLACK / 4)
    assert fold_ranges(framework, [still, fast, still], [(0, 1)]) is None
