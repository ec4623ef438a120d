"""Loops: the matching of rays, by symmetries, by known rules, and at branch points."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from height_signs import HeightSigns
from sixty_digits import assert_holds_the_node

from exactfold import CreasePattern, random_square
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches import find_branch
from exactfold.motion import find_loops
from exactfold.motion.curves.crossing_curves import crossing_ahead, flat_vertices
from exactfold.motion.curves.framework import Framework
from exactfold.motion.following import follow
from exactfold.motion.loops.loops import LoopFinder
from exactfold.motion.loops.matching import _matching
from exactfold.motion.loops.rays import Ray
from exactfold.motion.tubes.branch_point_tube import prove_branch_point_tube
from exactfold.motion.tubes.flat_patches import FlatPatch
from exactfold.motion.tubes.passages import Passage
from exactfold.motion.tubes.piece import PARAMETER_BITS
from exactfold.rigidity.curvature import wheel_stress
from exactfold.rigidity.equations.problem import Problem

NODE_SHEET, NODE_SIGNS = random_square(8, seed=1), "------++"


def sectors(pattern):
    """The angles between neighbouring folds at the one interior vertex, in floats."""
    (v,) = pattern.interior
    x, y = pattern.vertices[v]
    ring = [pattern.vertices[w] for w in pattern.star(v)]
    angles = [np.arctan2(float(b - y), float(a - x)) for a, b in ring]
    return np.diff([*angles, angles[0] + 2 * np.pi]) % (2 * np.pi)


@pytest.mark.parametrize("seed", range(2))
def test_one_vertex_is_a_spherical_four_bar_linkage(seed):
    """Grashof's rule: the vertex pops through iff smallest and largest sector exceed pi."""
    pattern = random_square(1, seed=seed)
    found = find_loops(pattern)
    assert found.status is PROVED
    angles = sectors(pattern)
    pops = angles.min() + angles.max() > np.pi
    for loop in found.loops:
        assert (loop.source.vertex_signs != loop.target.vertex_signs) == pops
        assert (loop.source.saddle != loop.target.saddle) == (not pops)


@pytest.mark.slow
def test_the_matching_is_an_involution_that_commutes_with_the_mirror():
    found = find_loops(random_square(3, seed=2))
    matching = found.matching
    assert found.status is PROVED
    assert len(matching) == 16
    for a, b in matching.items():
        assert a != b
        assert matching[b] == a
        assert matching[a.mirrored] == b.mirrored
        flips = sum(x != y for x, y in zip(a.vertex_signs, b.vertex_signs, strict=True))
        assert flips + (a.saddle != b.saddle) == 1


def test_a_reflected_and_renumbered_sheet_has_the_same_loops():
    sheet = random_square(2, seed=5)
    order = [3, 5, 0, 4, 1, 2]  # the vertex k of the sheet is order[k] of the other
    points = dict(zip(order, sheet.vertices, strict=True))
    other = CreasePattern(
        [(-points[k][0], points[k][1]) for k in range(6)],
        [tuple(order[v] for v in t) for t in sheet.triangles],
    )
    place = [other.interior.index(order[v]) for v in sheet.interior]
    # The saddle is counted from the first boundary vertex, which may be on the other diagonal.
    turned = (-1) ** sheet.boundary.index(order.index(other.boundary[0]))
    there = {
        (tuple(a.vertex_signs[p] for p in place), turned * a.saddle): (
            tuple(b.vertex_signs[p] for p in place),
            turned * b.saddle,
        )
        for a, b in find_loops(other).matching.items()
    }
    here = {
        (a.vertex_signs, a.saddle): (b.vertex_signs, b.saddle)
        for a, b in find_loops(sheet).matching.items()
    }
    assert len(here) == 8
    assert there == here


def test_the_loop_in_floats_ends_at_the_proved_half_branch():
    pattern = random_square(3, seed=1)
    branch = find_branch(pattern, "+--")
    loop = LoopFinder(Problem.of(pattern)).follow(branch).loop
    motion = follow(branch, until="return", through_branch_points=True)
    low, high = loop.length
    assert low <= Fraction(motion.duration) <= high
    near = motion.at(motion.duration * 0.999)
    signs = HeightSigns(pattern).of(near[:, 2])
    assert signs == loop.target


def test_a_sheet_that_folds_flat_is_undecided_there():
    found = find_loops("single-vertex-4")
    assert found.status is UNDECIDED
    assert found.matching == {}
    assert all("folded flat" in loop.reason for loop in found.loops)


def test_a_branch_with_a_flat_vertex_is_skipped():
    found = find_loops("flat-vertex")
    assert found.status is UNDECIDED
    assert found.skipped
    assert "not simple" in found.reason


@pytest.fixture(scope="module")
def passage():
    """The first passage of a branch point of a loop that has two."""
    proof = LoopFinder(Problem.of(NODE_SHEET)).follow(find_branch(NODE_SHEET, NODE_SIGNS))
    assert proof.loop.through == ((9,), (9,))
    assert proof.loop.status is PROVED
    return next(step for step in proof.steps if isinstance(step, Passage))


def test_a_node_holds_the_configuration_with_60_digits(passage):
    assert_holds_the_node(passage.tube.patch, passage.tube.branch_point)


def test_an_arc_through_a_node_keeps_all_lengths(passage):
    tube = passage.tube
    framework = tube.framework
    for k in (-6, -3, -1, 1, 3, 6):
        ball = tube.ball(tube.longest * k // 8)
        centre, radii = ball.floats
        assert np.abs(framework.stretch(centre)).max() <= 4 * radii.max() + 1e-15
        assert radii.max() < 1e-7
    # Both velocities at the branch point are along one line: the arc goes straight on.
    before, after = (tube.ball_velocity(s << (PARAMETER_BITS - 20)).floats[0] for s in (-1, 1))
    assert np.abs(before - after).max() < 1e-5


def test_the_law_of_parity_needs_nothing_more_at_a_proved_node(passage):
    """Theorem 1a of docs/matching.md in floats: corank f, and the star's form is not 0 there."""
    tube = passage.tube
    framework, x = tube.framework, tube.branch_point.floats[0]
    _, sizes, right = np.linalg.svd(framework.jacobian(x).toarray())
    assert (sizes < 1e-9).tolist() == [False] * (len(sizes) - 1) + [True]
    kernel = right[len(sizes) - 1 :]
    velocity = tube.ball_velocity(0).floats[0]
    assert np.abs(velocity - kernel.T @ (kernel @ velocity)).max() < 1e-9
    [v] = tube.patch.flat
    stress = wheel_stress(framework.sheet, v)
    weights = np.array([float(stress.get(tuple(edge), 0)) for edge in framework.edges.tolist()])
    xi, basis = framework.along(velocity), framework.along(kernel)
    form = np.einsum("e,ea,kea->k", weights, xi, basis)
    size = np.abs(weights).max() * np.linalg.norm(velocity)
    assert abs(form @ (kernel @ velocity)) < 1e-9 * size
    assert np.abs(form).max() > 1e-3 * size


def test_a_loop_against_the_law_of_parity_is_a_defect():
    """One sign flips; two, or one through a single branch point, contradict it."""
    loop = find_loops(random_square(1, seed=0)).loops[0]
    assert _matching([loop]) == [loop]
    signs, saddle = loop.target.vertex_signs, loop.target.saddle
    turned = Ray(tuple(-s for s in signs), saddle)
    for lie in (replace(loop, target=turned), replace(loop, through=((4,),))):
        with pytest.raises(ArithmeticError, match="contradicts the law of parity"):
            _matching([lie])
    _matching([replace(loop, through=((4,), (4,)))])


def test_the_other_arc_through_a_node_has_another_direction(passage):
    """The kernel of the Jacobian at a branch point is a plane with two tangents of arcs."""
    tube = passage.tube
    framework = tube.framework
    node = tube.branch_point.floats[0]
    jacobian = framework.jacobian(node).toarray()
    _, sizes, rows = np.linalg.svd(jacobian)
    assert sizes[-1] < 1e-12 < 1e-4 < sizes[-2]
    plane = rows[-2:]
    first = tube.ball_velocity(0).floats[0]
    assert np.linalg.norm(plane @ first) > 0.999999 * np.linalg.norm(first)
    found = []
    for angle in np.linspace(0, np.pi, 40, endpoint=False):
        along = np.cos(angle) * plane[0] + np.sin(angle) * plane[1]
        arc = prove_branch_point_tube(framework, tube.patch, node, along)
        if arc is not None:
            found.append(arc.ball_velocity(0).floats[0])
    lines = [v / np.linalg.norm(v) for v in found]
    apart = [abs(u @ (first / np.linalg.norm(first))) for u in lines]
    assert {a > 1 - 1e-9 for a in apart} == {True, False}
    others = [u for u, a in zip(lines, apart, strict=True) if a < 1 - 1e-9]
    assert all(abs(u @ others[0]) > 1 - 1e-9 for u in others)


def test_a_patch_that_does_not_span_its_equations_is_refused():
    framework = Framework.of(NODE_SHEET)
    degrees = {v: NODE_SHEET.degree(v) for v in NODE_SHEET.interior}
    assert set(degrees.values()) > {4}
    for v, degree in degrees.items():
        assert (FlatPatch.of(framework, [v]) is not None) == (degree == 4)
    assert FlatPatch.of(framework, []) is None


@pytest.mark.slow
def test_nodes_are_found_from_a_distance(passage):
    proof = LoopFinder(Problem.of(NODE_SHEET)).follow(find_branch(NODE_SHEET, NODE_SIGNS))
    first = next(k for k, step in enumerate(proof.steps) if isinstance(step, Passage))
    link = proof.steps[first - 1]
    framework = link.tube.framework
    crossing = crossing_ahead(
        framework, link.tube.enclosure(link.exit).floats[0], link.tube.velocity(link.exit).floats[0]
    )
    assert crossing is not None
    assert flat_vertices(framework, crossing[0]) == (9,)
    assert np.abs(crossing[0] - passage.tube.branch_point.floats[0]).max() < 1e-6


def test_a_reflex_corner_hides_no_half_branch():
    """The saddle and the corner name branches differently; all sign vectors are followed."""
    pattern = CreasePattern(
        [
            (3, -5),
            (6, 7),
            (2, -7),
            (6, 0),
            (Fraction(20, 7), Fraction(-489, 91)),
            (Fraction(1748, 413), Fraction(-16014, 5369)),
        ],
        [(0, 4, 5), (0, 5, 3), (2, 3, 5), (2, 5, 4), (0, 1, 4), (1, 2, 4)],
    )
    assert pattern.reflex_corner is not None
    found = find_loops(pattern)
    assert found.status is PROVED
    assert len(found.matching) == 8


@pytest.mark.parametrize(("n", "seed", "signs"), [(4, 6, "+-++"), (4, 24, "----")])
def test_loops_on_which_two_curves_nearly_cross(n: int, seed: int, signs: str) -> None:
    """Tubes become as short as 1e-5 of the sheet there, and longer again."""
    sheet = random_square(n, seed=seed)
    proof = LoopFinder(Problem.of(sheet)).follow(find_branch(sheet, signs))
    assert proof.loop.status is PROVED
    lengths = [float(step.left[0] - step.entered[0]) for step in proof.steps]
    assert min(lengths[:-5]) < 2e-5 < 1e-2 < max(lengths)
