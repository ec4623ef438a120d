"""What is singular where loops end, and branches that fold a sheet along one straight line."""

import math
import random
from fractions import Fraction
from itertools import chain, combinations

import numpy as np
import pytest
from sheets import reflex_corners, star_in, wheel

from exactfold._support.verdict import UNDECIDED
from exactfold.branches import count_branches, find_branch
from exactfold.errors import FlatVertexError
from exactfold.exact.linalg import rank
from exactfold.motion import find_loops, follow_proved
from exactfold.motion.curves.angles import fold_angles_of
from exactfold.motion.curves.framework import Framework
from exactfold.motion.curves.straight_folds import straight_fold
from exactfold.motion.loops.loops import LoopFinder
from exactfold.motion.tubes.singular import folds_flat, half_turn
from exactfold.pattern import load
from exactfold.rigidity import Problem

BRANCHING = "motions may branch there"


def test_a_sheet_folded_flat_is_named_by_its_closed_folds():
    """Two folds in one line, in a star with a reflex corner: they close together."""
    star = star_in(reflex_corners(0))
    proof = LoopFinder(Problem.of(star)).follow(find_branch(star, "-"))
    assert proof.loop.status is UNDECIDED
    assert proof.reason == (
        "all faces come to lie in one plane, folded flat, with folds 0-4 and 2-4 at 180 degrees: "
        + BRANCHING
    )


def closes(star, closed):
    """Whether reflections in the closed folds, one after the other, are the identity: in floats."""
    point = np.array([1.0, 2.0])
    for w in star.star(4):
        if (w, 4) in closed:
            x, y = (float(a - b) for a, b in zip(star.vertices[w], star.vertices[4], strict=True))
            angle = 2 * math.atan2(y, x)
            c, s = math.cos(angle), math.sin(angle)
            point = np.array([[c, s], [s, -c]]) @ point
    return np.allclose(point, [1.0, 2.0], atol=1e-9)


def test_what_folds_flat_is_what_reflections_close():
    choose = random.Random(1)
    kawasaki = wheel([(3, 0), (0, 2), (-5, 0), (0, -7)], (0, 0))
    stars = [kawasaki, star_in(reflex_corners(1)), load("single-vertex-4")]
    corners = [[Fraction(choose.randint(3, 9)), Fraction(choose.randint(-2, 2))] for _ in range(4)]
    turned = [(x, y) for x, y in corners]
    turned = [turned[0], (-turned[1][1], turned[1][0]), *((-x, -y) for x, y in turned[2:3])]
    stars.append(wheel([*turned, (turned[1][0], -turned[1][1] - 3)], (0, 0)))
    found = set()
    for star in stars:
        folds = star.folds
        for closed in chain.from_iterable(combinations(folds, k) for k in range(5)):
            assert folds_flat(star, closed) == closes(star, closed), closed
            found.add((len(closed), folds_flat(star, closed)))
    assert {(0, True), (1, False), (2, True), (2, False), (4, True), (4, False)} <= found


@pytest.mark.parametrize(
    ("corners", "edges", "fixed"),
    [
        ([(3, 1), (-1, 2)], [(0, 1), (1, 2), (2, 3), (3, 0)], (0, 0)),
        ([(3, 1), (-1, 2)], [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2)], (0, 1)),  # a diagonal
        ([(3, 1), (-1, 2)], [(0, 1), (1, 2), (2, 3), (3, 0), *((v, 4) for v in range(4))], (1, 0)),
        (
            [(3, 1), (-1, 2), (9, 0), (0, 8)],
            [
                *[(0, 1), (1, 4), (4, 5), (5, 0), (2, 3), (3, 6), (6, 7), (7, 2)],
                *[(0, 2), (1, 3), (4, 6), (5, 7), (0, 3), (1, 6), (4, 7), (5, 2)],
            ],
            (0, 0),  # a ring between two quadrilaterals
        ),
    ],
)
def test_lengths_split_where_a_half_turn_in_space_maps_a_part_to_itself(corners, edges, fixed):
    """Exact ranks in a configuration with this symmetry: motion/tubes/singular.py."""
    rng, m = random.Random(3), len(corners)
    flat = [*corners, *((-x, -y) for x, y in corners)] + [(0, 0)] * fixed[0]
    middle = 2 * m
    image = [(v + m) % middle if v < middle else v for v in range(len(flat))]
    assert {frozenset(image[v] for v in e) for e in edges} == set(map(frozenset, edges))
    heights = [rng.randint(-5, 5) for _ in range(m)]
    place = [(*p, z) for p, z in zip(flat, heights * 2 + [7] * fixed[0], strict=True)]
    turn = (-1, -1, 1)
    found = []
    for side in (1, -1):
        moves = []
        for v in range(len(flat)):
            for axis in range(3):
                move = [[0, 0, 0] for _ in flat]
                move[v][axis] += 1
                move[image[v]][axis] += side * turn[axis]
                moves.append([*chain(*move)])
        rows = [
            [
                sum((place[i][a] - place[j][a]) * (y[3 * i + a] - y[3 * j + a]) for a in range(3))
                for i, j in edges
            ]
            for y in moves
        ]
        found.append((rank(moves), rank(rows)))
    e = (len(edges) - fixed[1]) // 2
    assert found == [(3 * m + fixed[0], e + fixed[1]), (3 * m + 2 * fixed[0], e)]


@pytest.mark.slow
def test_edges_that_depend_are_named():
    """The outer ring of the hypar, which a half-turn maps to itself, is singular on a motion."""
    sheet = load("hypar-2")
    ring = range(8)
    assert half_turn(sheet, ring)
    assert not half_turn(sheet, range(9))
    proof = LoopFinder(Problem.of(sheet)).follow(find_branch(sheet, "--------"))
    assert proof.landing is None
    assert proof.reason == (
        "the lengths of edges between vertices 0, 1, 2, 3, 4, 5, 6 and 7, which a half-turn of the "
        f"flat sheet maps to themselves, come to depend on each other: {BRANCHING}"
    )
    # On the way there the ring in space has a half-turn as well.
    framework = proof.start.framework
    for step in proof.steps[::7]:
        place = framework.positions(step.tube.enclosure(step.exit).floats[0])[list(ring)]
        image = place[[2, 3, 0, 1, 6, 7, 4, 5]]
        gaps = [np.linalg.norm(x[:, None] - x[None], axis=2) for x in (place, image)]
        assert np.abs(gaps[0] - gaps[1]).max() < 1e-9


@pytest.mark.slow
def test_a_fold_along_a_straight_line_is_named():
    found = find_loops("flat-vertex")
    assert found.skipped == {
        "+0": "a vertex is flat on it: the sheet turns exactly about the straight line 0-4-2, and "
        f"at 180 degrees, where it is folded flat, {BRANCHING.removesuffix(' there')}"
    }
    assert found.reason == "1 branch is not simple"
    with pytest.raises(FlatVertexError, match="a rotation about the straight line 0-4-2, and"):
        follow_proved(find_branch("flat-vertex", "+0"))


def test_a_rotation_about_the_line_keeps_all_lengths():
    """And closes its folds together, at 180 degrees, where the sheet is folded flat."""
    branch = find_branch("flat-vertex", "+0")
    line = straight_fold(branch)
    pattern = branch.pattern
    framework = Framework.of(pattern)
    flat = np.array([[float(x), float(y), 0.0] for x, y in pattern.vertices])
    start, end = flat[line[0]], flat[line[-1]]
    axis = (end - start) / np.linalg.norm(end - start)
    moved = [v for v in range(6) if np.cross(axis, flat[v] - start)[2] > 1e-9]
    for angle in (0.3, 2.0, math.pi):
        place = flat.copy()
        for v in moved:
            arm = flat[v] - start
            along = (arm @ axis) * axis
            across = arm - along
            turn = math.cos(angle) * across + math.sin(angle) * np.cross(axis, across)
            place[v] = start + along + turn
        for i, j in pattern.edges:
            assert abs(np.linalg.norm(place[i] - place[j]) - np.linalg.norm(flat[i] - flat[j])) < (
                1e-12
            )
        folded = np.abs(fold_angles_of(place, framework.hinges)) > 1e-9
        active = {fold for fold, on in zip(pattern.folds, folded, strict=True) if on}
        assert active == {(0, 4), (2, 4)}
    assert folds_flat(pattern, [(0, 4), (2, 4)])


def test_other_branches_are_no_straight_folds():
    assert [straight_fold(b) for b in count_branches("two-vertex").branches] == [()] * 4
