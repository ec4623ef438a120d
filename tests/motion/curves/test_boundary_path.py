"""Rim paths: sheets with more than four corners, whose boundary keeps the ratio of its heights."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import cache

import flint
import numpy as np
import pytest
from sixty_digits import assert_holds_the_node, holds, newton

from exactfold import CreasePattern, delaunay
from exactfold._support.verdict import PROVED
from exactfold.branches.counting.find import find_branch
from exactfold.branches.values.branch import Branch
from exactfold.checker import check, summary
from exactfold.errors import NotFollowedError, UndecidedBranchError
from exactfold.exact.linalg import rank
from exactfold.motion import follow, prove
from exactfold.motion.curves import boundary_path as rim_path
from exactfold.motion.curves.boundary_path import factor_functional, problem_of, ties_of
from exactfold.motion.curves.framework import Framework
from exactfold.motion.following import Motion
from exactfold.motion.persistence import _another
from exactfold.motion.tubes.tracks import follow_proved
from exactfold.pattern import families
from exactfold.rigidity.functionals import vertex_sign_functional

CORNERS = [(0, 0), (10, -3), (16, 5), (9, 14), (-2, 9)]
PENTAGON = delaunay([*CORNERS, (5, 4), (8, 7)])
OCTAGON = delaunay([(4, 0), (9, 0), (13, 4), (13, 9), (9, 13), (4, 12), (0, 9), (0, 4), (6, 5)])
RIM = {0: Fraction(1), 1: Fraction(-1, 2), 2: Fraction(1, 4), 3: Fraction(0), 4: Fraction(1, 10)}


@cache
def pentagon(signs: str = "+-") -> Branch:
    return find_branch(PENTAGON, signs, boundary_heights=RIM)


def off_the_ratio(motion: Motion) -> float:
    """How far the boundary heights of any frame are from the span of rim, x, y and 1."""
    pattern, rim = motion.pattern, motion.branch.boundary_heights
    assert rim is not None
    columns = [[float(rim[v]), *map(float, pattern.vertices[v]), 1.0] for v in pattern.boundary]
    heights = motion.coords[:, list(pattern.boundary), 2].T
    found = np.linalg.lstsq(np.array(columns), heights, rcond=None)[0]
    return float(np.abs(np.array(columns) @ found - heights).max())


@pytest.mark.parametrize("branch", [pentagon(), find_branch(OCTAGON, "-")])
def test_lengths_are_kept_and_the_border_keeps_its_ratio(branch: Branch) -> None:
    motion = follow(branch, until="40deg", frames=4)
    assert motion.end == "angle"
    assert motion.length_error < 1e-12
    assert off_the_ratio(motion) < 1e-12
    # Another face held is another rim path, which does not keep this one's.
    other = follow(branch, until="40deg", frames=4, pinned=branch.pattern.triangles[0])
    assert other.pinned != motion.pinned
    assert off_the_ratio(other) < 1e-12
    lifted = other.coords.copy()
    lifted[:, branch.pattern.boundary[0], 2] += 1e-3
    assert off_the_ratio(replace(motion, coords=lifted)) > 1e-5


def test_only_the_direction_of_the_rim_matters() -> None:
    motion = follow(pentagon(), until="20deg", frames=3)
    tilted = {v: 3 * h + 2 * x - y + 5 for (v, h), (x, y) in zip(RIM.items(), CORNERS, strict=True)}
    same = follow(find_branch(PENTAGON, "+-", boundary_heights=tilted), until="20deg", frames=3)
    assert np.abs(motion.coords - same.coords).max() < 1e-11
    # The opposite rim has the opposite branch: the motion is the mirror image of the other.
    opposite = find_branch(PENTAGON, "-+", boundary_heights={v: -h for v, h in RIM.items()})
    turned = follow(opposite, until="20deg", frames=3)
    assert np.abs(motion.coords * (1, 1, -1) - turned.coords).max() < 1e-11
    back = follow(opposite, side=-1, until="20deg", frames=3)
    assert np.array_equal(back.coords, turned.coords * (1, 1, -1))


def test_a_mirror_sheet_has_the_mirror_motion() -> None:
    mirror = CreasePattern(
        [(-x, y) for x, y in PENTAGON.vertices], [(b, a, c) for a, b, c in PENTAGON.triangles]
    )
    one = follow(pentagon(), until="40deg", frames=3)
    two = follow(find_branch(mirror, "+-", boundary_heights=RIM), until="40deg", frames=3)
    assert set(one.pinned) == set(two.pinned)
    assert np.abs(one.coords * (-1, 1, 1) - two.coords).max() < 1e-11


def test_with_four_corners_a_rim_changes_nothing() -> None:
    pattern = families.two_vertex()
    plain = follow(find_branch(pattern, "+-"), until="40deg", frames=3)
    rim = {v: Fraction(7 * (v == 0)) for v in pattern.boundary}
    given = follow(find_branch(pattern, "+-", boundary_heights=rim), until="40deg", frames=3)
    assert plain.curve.framework == given.curve.framework
    assert given.boundary_heights is None
    assert plain.end == given.end
    assert np.abs(plain.coords - given.coords).max() < 1e-11


@pytest.mark.parametrize("branch", [pentagon(), find_branch(OCTAGON, "-")])
def test_ties_hold_for_the_rim_and_planes_only(branch: Branch) -> None:
    problem = problem_of(branch)
    sheet, rim = problem.sheet, problem.gauge.boundary_heights
    ties = ties_of(problem)
    rows = [[Fraction(dict(tie).get(v, 0)) for v in sheet.boundary] for tie in ties]
    assert len(ties) == rank(rows) == sheet.Ve - 4
    heights = [rim[v] for v in sheet.boundary]
    for column in (heights, *zip(*(sheet.vertices[v] for v in sheet.boundary), strict=True)):
        assert [sum(c * x for c, x in zip(row, column, strict=True)) for row in rows] == [0] * len(
            rows
        )
    assert [sum(row) for row in rows] == [0] * len(rows)
    factor = factor_functional(sheet, rim)
    x, y = sheet.vertices[sheet.boundary[1]]
    tilted = {v: 5 * rim[v] + 2 * sheet.vertices[v][0] + x - y for v in factor}
    assert sum(c * tilted[v] for v, c in factor.items()) == 5


def test_near_the_flat_state_each_sign_vector_has_one_configuration() -> None:
    """Random starts with a small factor end in 2^n configurations (docs/motion.md, 9)."""
    problem = problem_of(pentagon())
    framework = Framework.of(problem.sheet, None, ties_of(problem))
    functional = factor_functional(problem.sheet, problem.gauge.boundary_heights)
    row, size = np.zeros(framework.size), 0.02
    for k, v in enumerate(framework.free.tolist()):
        row[3 * k + 2] = functional.get(v, 0)
    random, found = np.random.default_rng(0), []
    for _ in range(60):
        x = random.normal(size=framework.size) * size * np.tile([size, size, 2], len(row) // 3)
        for _ in range(40):
            right = np.append(framework.residual(x), row @ x - size)
            jacobian = np.vstack([framework.jacobian(x).toarray(), row])
            step = np.linalg.lstsq(jacobian, right, rcond=None)[0]
            x = x - step * min(1, 0.05 / np.abs(step).max())
        if np.abs(step).max() < 1e-13 and all(np.abs(x - y).max() > 1e-7 for y in found):
            found.append(x)
    signs = []
    for x in found:
        heights = framework.displacement(x)[:, 2]
        rows = [vertex_sign_functional(problem.sheet, v) for v in problem.sheet.interior]
        signs.append(tuple(sum(c * heights[w] for w, c in r.items()) > 0 for r in rows))
    assert sorted(signs) == [(False, False), (False, True), (True, False), (True, True)]


@pytest.mark.slow
def test_a_motion_is_proved_with_its_first_contact() -> None:
    motion = follow(pentagon(), frames=2)
    proof = prove(motion)
    assert proof.status is PROVED
    assert proof.contact is not None
    assert proof.contact.event is not None
    assert proof.contact.event.folds == ((1, 6),)
    low, high = proof.contact.event.time
    assert low < motion.duration < high < low * (1 + 1e-5)
    assert off_the_ratio(proof.motion) < 1e-13
    assert max(proof.motion.bounds.radii) < 1e-13
    claims = check(proof.certificate())
    assert claims["rim"] == ["1", "-1/2", "1/4", "0", "1/10"]
    assert "boundary in the ratio of 1, -1/2, 1/4, 0, 1/10 above the face 1-2-6" in summary(claims)


def test_tubes_hold_what_sixty_digits_give() -> None:
    track = follow_proved(pentagon(), most=3)
    assert (track.vertex_signs, track.side) == ({5: 1, 6: -1}, 1)
    tube = track.links[-1].tube
    with flint.ctx.workprec(240):
        x = newton(track.framework, tube, tube.longest // 2, RIM)
        assert holds(tube.enclosure(tube.longest // 2), x)
        assert not holds(tube.enclosure(tube.longest // 3), x)


@pytest.mark.slow
def test_a_node_is_proved() -> None:
    """A hexagon whose motion comes to a flat star: the arc through it has the ties as well."""
    points = [(10, 1), (4, 9), (-5, 9), (-9, 3), (-4, -9), (8, -7), (-1, 5), (3, 0)]
    branch = find_branch(delaunay(points), "--")
    motion = follow(branch, until="return", frames=3)
    assert motion.end == "node"
    proof = prove(motion)
    assert proof.status is PROVED
    assert proof.branch_point is not None
    assert proof.track.framework.ties
    assert check(proof.certificate())["node"]["flat"] == list(proof.branch_point.vertices)
    assert_holds_the_node(
        proof.branch_point.tube.patch, proof.branch_point.tube.branch_point, branch.boundary_heights
    )


@pytest.mark.slow
def test_a_return_is_proved() -> None:
    """The motion ends in the flat sheet along the ray that floats see there."""
    branch = find_branch(families.single_vertex(5), "+")
    motion = follow(branch, until="return", frames=3)
    assert motion.end == "return"
    proof = prove(motion)
    assert proof.status is PROVED
    assert proof.loop is not None
    assert proof.loop.target is not None
    assert proof.back_text == "-, with the boundary as given"
    assert max(proof.motion.bounds.radii) < 1e-13
    heights = motion.at(motion.duration * 0.999)[:, 2]
    row = vertex_sign_functional(branch.pattern, 5)
    assert proof.loop.target.vertex_signs[0] * sum(c * heights[v] for v, c in row.items()) > 0
    lift = factor_functional(branch.pattern, branch.boundary_heights)
    assert proof.loop.target.saddle * sum(float(c) * heights[v] for v, c in lift.items()) > 0
    certificate = proof.certificate()
    assert certificate is not None
    claims = check(certificate)
    assert claims["return"] == {"vertex_signs": [-1], "side": 1}
    assert "and back to the flat state along -, side +" in summary(claims)
    assert motion.duration * 0.998 < float(Fraction(claims["length"])) < motion.duration


def test_with_a_rim_no_other_face_is_held() -> None:
    ties = ties_of(problem_of(pentagon()))
    assert _another(Framework.of(PENTAGON, None, ties)) is None
    assert _another(Framework.of(PENTAGON)) is not None


def test_what_is_not_followed() -> None:
    with pytest.raises(UndecidedBranchError, match="nothing is proved of it"):
        follow(replace(pentagon(), root=None))
    with pytest.raises(NotFollowedError, match="a branch with given boundary heights"):
        follow(replace(pentagon(), gauge="saddle"))


def test_a_base_is_far_apart() -> None:
    """Ties of a boundary with straight sides have no corner that is on a line with the others."""
    squares = delaunay([(0, 0), (2, 0), (4, 0), (4, 4), (2, 4), (0, 4), (1, 2), (3, 1)])
    branch = find_branch(squares, "+-")
    problem = problem_of(branch)
    base, raised = rim_path._base(problem.sheet, problem.gauge.boundary_heights)
    assert raised not in base
    assert off_the_ratio(follow(branch, until="30deg", frames=3)) < 1e-13
