"""Driven folds: sheets with more than four corners, folded by the angles of chosen folds."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from functools import cache

import flint
import mpmath
import numpy as np
import pytest
from sampling import slow_after
from sixty_digits import driven_newton, holds

from exactfold import CreasePattern, delaunay
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches import find_branch
from exactfold.checker import check, summary
from exactfold.errors import BadDriveError, NotFollowedError
from exactfold.motion import Motion, find_driven, follow, prove
from exactfold.motion.curves.drive import PrescribedAngles
from exactfold.motion.tubes.driven import Driven, off_the_ratio
from exactfold.motion.tubes.tracks import follow_proved
from exactfold.pattern import families

PENTAGON = delaunay([(0, 0), (10, -3), (16, 5), (9, 14), (-2, 9), (5, 4), (8, 7)])
ANGLES = {(1, 5): 60.0, (2, 6): -45.0}
STAR = families.single_vertex(7)
FOUR = {(0, 7): 60.0, (2, 7): -30.0, (3, 7): 40.0, (5, 7): 50.0}


@cache
def pentagon() -> Driven:
    return find_driven(PENTAGON, ANGLES)


@cache
def star() -> Driven:
    return find_driven(STAR, FOUR)


def along(driven: Driven, **options: object) -> Motion:
    options = {"until": "return", "frames": 4} | options
    return follow(driven.branch, side=driven.side, drive=driven.drive, **options)  # type: ignore[arg-type]


def sines(motion: Motion) -> np.ndarray:
    """Of half the angles of the driven folds, over those at the goal, shape (frames, folds)."""
    assert motion.drive is not None
    at = [motion.pattern.folds.index(fold) for fold in motion.drive.folds]
    return np.sin(motion.angles[:, at] / 2) / np.array(motion.drive.sines)


@pytest.mark.parametrize("found", [pentagon, star])
def test_the_sines_of_half_the_angles_keep_their_ratio_up_to_the_goal(
    found: Callable[[], Driven],
) -> None:
    driven = found()
    motion = along(driven)
    assert motion.end == "driven"
    assert motion.length_error < 1e-12
    ratios = sines(motion)
    assert np.abs(ratios - ratios[:, :1]).max() < 1e-12
    assert np.abs(ratios[-1] - 1).max() < 1e-12
    assert (np.diff(ratios[:, 0]) > 0).all()
    [event] = [event for event in motion.events if event.kind == "driven"]
    assert event.folds == driven.drive.folds
    # The branch starts in that ratio, with the signs asked for.
    assert off_the_ratio(driven.branch, driven.side, driven.drive) < 1e-8
    signs = driven.branch.vertex_signs
    assert find_driven(motion.pattern, driven.drive.angles, signs).branch == driven.branch


def test_around_a_vertex_the_turns_about_all_folds_are_the_identity() -> None:
    """Closure, by rotations about the creases: no length is used."""
    motion = along(star())
    spokes = [np.array([float(x) for x in STAR.vertices[w]]) for w in STAR.star(7)]
    for row in motion.angles[1:]:
        whole = np.eye(3)
        for w, spoke in zip(STAR.star(7), spokes, strict=True):
            x, y = spoke / np.linalg.norm(spoke)
            across = np.array([[0, 0, y], [0, 0, -x], [-y, x, 0]])
            angle = row[STAR.folds.index((w, 7))]
            whole = whole @ (
                np.eye(3) + np.sin(angle) * across + (1 - np.cos(angle)) * across @ across
            )
        assert np.abs(whole - np.eye(3)).max() < 1e-12


def test_with_four_corners_one_fold_is_driven_along_the_branch() -> None:
    square = families.two_vertex()
    driven = find_driven(square, {(3, 5): 40}, "++")
    motion = along(driven, frames=3)
    plain = follow(find_branch(square, "++"), until=motion.duration, frames=3)
    assert motion.end == "driven"
    assert np.degrees(motion.angles[-1, square.folds.index((3, 5))]) == pytest.approx(40, abs=1e-9)
    assert np.abs(motion.coords - plain.coords).max() < 1e-11
    # The other way: the mirror image of the branch with the opposite signs.
    other = find_driven(square, {(3, 5): -40}, "++")
    assert (other.side, other.branch.sign_text) == (-1, "--")
    with pytest.raises(NotFollowedError, match="the fold goes the other way, or stays flat"):
        find_driven(square, {(3, 5): -40}, "++", side=1)


def test_a_mirror_sheet_has_the_mirror_motion() -> None:
    mirror = CreasePattern(
        [(-x, y) for x, y in PENTAGON.vertices], [(b, a, c) for a, b, c in PENTAGON.triangles]
    )
    one, two = along(pentagon()), along(find_driven(mirror, ANGLES, pentagon().branch.vertex_signs))
    assert set(one.pinned) == set(two.pinned)
    assert np.abs(one.coords * (-1, 1, 1) - two.coords).max() < 1e-10
    # Turned over: all angles and signs are the opposite ones.
    opposite = {v: -s for v, s in pentagon().branch.vertex_signs.items()}
    over = along(find_driven(PENTAGON, {f: -a for f, a in ANGLES.items()}, opposite))
    assert np.abs(one.coords * (1, 1, -1) - over.coords).max() < 1e-10


@pytest.mark.slow
def test_which_face_is_held_does_not_matter() -> None:
    """Unlike on a rim path: the distances of all vertices are the same at the goal."""
    one = along(pentagon())
    two = along(pentagon(), pinned=PENTAGON.triangles[0])
    assert one.pinned != two.pinned
    apart = [
        np.linalg.norm(motion.coords[-1][:, None] - motion.coords[-1][None], axis=-1)
        for motion in (one, two)
    ]
    assert np.abs(apart[0] - apart[1]).max() < 1e-10


def test_a_fold_without_an_angle_goes_along_as_on_the_branch() -> None:
    signs = pentagon().branch.vertex_signs
    rim = {
        0: Fraction(1),
        1: Fraction(-1, 2),
        2: Fraction(1, 4),
        3: Fraction(0),
        4: Fraction(1, 10),
    }
    branch = find_branch(PENTAGON, "+-", boundary_heights=rim)
    angles = branch.fold_angles.degrees(1.0)
    driven = find_driven(
        PENTAGON, {(1, 6): None, (2, 6): 50 * angles[2, 6]}, "+-", boundary_heights=rim
    )
    first, second = driven.drive.sines
    assert first / second == pytest.approx(angles[1, 6] / angles[2, 6], rel=1e-4)
    free = find_driven(PENTAGON, {(1, 6): None, (2, 6): None}, signs)
    assert max(map(abs, free.drive.squares)) == 1


def test_what_cannot_be_driven() -> None:
    def refused(angles: dict[tuple[int, int], float | None], message: str) -> None:
        with pytest.raises(BadDriveError, match=message) as caught:
            find_driven(PENTAGON, angles, "+-")
        assert caught.value.folds

    refused({(0, 6): 90, (1, 5): 90}, "there is no fold 0-6 to drive")
    refused({(0, 1): 90, (1, 5): 90}, "0-1 is an edge of the boundary, not a fold to drive")
    refused({(1, 5): 0, (2, 6): 90}, "fold 1-5 cannot be driven to 0 degrees: at 0 it stays")
    refused({(1, 5): 181, (2, 6): 90}, "fold 1-5 cannot be driven to 181 degrees: the limit is")
    refused(
        {(1, 5): 9, (2, 6): 9, (3, 6): 9}, "3 folds cannot be driven at once: .* at most 2 folds"
    )
    # Both are at vertex 5, which has four folds: the angle of one gives that of the other.
    refused({(1, 5): 9, (4, 5): 9}, "fold 4-5 cannot be driven together with 1-5")
    inside = CreasePattern(
        [*STAR.vertices, (Fraction(1, 2), Fraction(1, 5))],
        [t for t in STAR.triangles if set(t) != {0, 1, 7}] + [(0, 1, 8), (1, 7, 8), (7, 0, 8)],
    )
    with pytest.raises(BadDriveError, match="fold 0-8 lies inside a triangulated triangle"):
        find_driven(inside, {(0, 8): 90, **FOUR})


def test_a_solution_with_exactly_the_ratio_is_proved() -> None:
    driven = pentagon()
    assert driven.status is PROVED
    # Of folds that go the other way nothing is.
    flipped = replace(driven.drive, squares=tuple(-q for q in driven.drive.squares))
    assert replace(driven, drive=flipped).status is UNDECIDED
    assert find_driven(families.two_vertex(), {(3, 5): 40}, "++").status is PROVED


def test_folds_that_are_missing_are_named_and_can_be_driven() -> None:
    with pytest.raises(BadDriveError, match="for instance also ") as caught:
        find_driven(STAR, {(0, 7): 30}, "+")
    text = str(caught.value).partition("for instance also ")[2].partition(" (")[0]
    more = [tuple(map(int, fold.split("-"))) for fold in text.split(", ")]
    assert len(more) == 3
    driven = find_driven(STAR, {(0, 7): -30, **dict.fromkeys(more)}, "+")
    assert along(driven, frames=2, until="20deg").end == "angle"


def test_a_ratio_that_is_not_met() -> None:
    """At a vertex with four folds the signs of all depend on its own: here 1-5 is no valley."""
    with pytest.raises(NotFollowedError, match="the nearest ratio that was found is") as caught:
        find_driven(PENTAGON, {(1, 5): 90, (2, 6): -45}, "+-")
    assert caught.value.folds == ((1, 5), (2, 6))
    with pytest.raises(BadDriveError, match="have to start in the ratio"):
        follow(find_branch(PENTAGON, "+-"), drive=PrescribedAngles.of(ANGLES))
    with pytest.raises(BadDriveError, match="there is no fold 0-6"):
        follow(find_branch(PENTAGON, "+-"), drive=PrescribedAngles.of({(0, 6): 3, (2, 6): 3}))


@pytest.mark.slow
def test_at_a_dead_point_the_drive_ends() -> None:
    """Fold 0-5 closes at the vertex with four folds, so that those at the next cannot go on."""
    motion = along(find_driven(PENTAGON, {(2, 6): 150, (3, 6): 170}), frames=20)
    assert motion.end == "dead-point"
    assert abs(motion.angles[-1, PENTAGON.folds.index((0, 5))]) == pytest.approx(np.pi, abs=1e-6)
    assert sines(motion)[-1, 0] < 0.9
    assert (np.diff(sines(motion)[:, 0]) > 0).all()


def test_a_driven_motion_is_proved_to_reach_its_angles() -> None:
    motion = along(pentagon(), frames=2)
    proof = prove(motion)
    assert (proof.status, proof.reached) == (PROVED, True)
    assert max(proof.motion.bounds.radii) < 1e-13
    last = sines(proof.motion)[-1]  # at a time that is known to about 1e-7
    assert abs(last[0] - last[1]) < 1e-12 < abs(last[0] - 1) < 1e-6
    certificate = proof.certificate()
    assert certificate is not None
    claims = check(certificate)
    assert claims["drive"]["folds"] == [[1, 5], [2, 6]]
    assert claims["drive"]["squares"] == [str(q) for q in motion.drive.squares]
    assert claims["drive"]["reached"] is True
    assert "driven by the folds 1-5, 2-6 (valley, mountain)" in summary(claims)
    # A motion that ends before has not reached them.
    early = prove(along(pentagon(), frames=2, until=motion.duration / 2))
    assert (early.status, early.reached) == (PROVED, False)


def test_folds_pass_their_goals_only_if_that_is_certain() -> None:
    """Two wings, turned about the sides of a face a little farther than their goals."""
    goals = {(1, 5): 30.0, (2, 6): -45.0}
    points = [[Fraction(x), Fraction(y), Fraction(0)] for x, y in PENTAGON.vertices]
    for ((i, j), goal), wing in zip(goals.items(), (0, 3), strict=True):
        o, a, p = (np.array([float(x) for x in points[v]]) for v in (i, j, wing))
        axis, turn = (a - o) / np.linalg.norm(a - o), np.radians(goal * (1 + 1e-9))
        arm = p - o
        across = arm - axis * (axis @ arm)
        spot = o + axis * (axis @ arm) + across * np.cos(turn)
        points[wing] = [Fraction(x) for x in spot.tolist()]
        points[wing][2] = Fraction(float(np.linalg.norm(across) * np.sin(turn)))

    def passed(factor: float, radius: Fraction = Fraction(0), up: bool = False) -> bool:
        drive = PrescribedAngles.of({f: (abs(a) if up else a) * factor for f, a in goals.items()})
        return drive.passed(PENTAGON, range(len(points)), points, radius)

    assert passed(1)
    assert not passed(1.0001)
    assert not passed(1, Fraction(1, 10**6))
    assert not passed(1, up=True)


@pytest.mark.parametrize(
    ("angle", "why"),
    [
        (float("nan"), "that is not a number"),
        (float("inf"), "the limit is 180 degrees"),
        (0.0, "at 0 it stays flat; give another angle, or leave the fold out"),
        (1e-5, "give at least 0.0001 degrees"),
    ],
)
def test_an_angle_that_is_no_goal(angle: float, why: str) -> None:
    with pytest.raises(BadDriveError) as caught:
        PrescribedAngles.of({(1, 5): angle})
    assert str(caught.value) == f"fold 1-5 cannot be driven to {angle:g} degrees: {why}"


@pytest.mark.slow
def test_two_folds_that_close_at_once_are_not_proved_to_close() -> None:
    driven = find_driven(families.single_vertex(5), {(0, 5): 180, (1, 5): 180})
    proof = prove(along(driven, frames=2))
    assert proof.status is UNDECIDED
    assert proof.reason.startswith("the angles of the driven folds come to depend on the lengths")


def test_tubes_hold_what_sixty_digits_give() -> None:
    """The angles themselves are equations there, by the normals of the faces."""
    driven = pentagon()
    track = follow_proved(driven.branch, drive=driven.drive, most=2)
    assert (track.side, track.drive) == (1, driven.drive)
    tube = track.links[-1].tube
    with mpmath.workdps(60), flint.ctx.workprec(240):
        x = driven_newton(track.framework, tube, tube.longest // 2, driven.drive)
        assert holds(tube.enclosure(tube.longest // 2), x)
        assert not holds(tube.enclosure(tube.longest // 3), x)


@pytest.mark.parametrize("seed", slow_after(1, range(3)))
def test_at_one_vertex_the_solutions_are_those_of_a_quadratic_equation(seed: int) -> None:
    """Given angles leave a line of heights, up to planes, which meets the cone of the vertex."""
    random = np.random.default_rng(seed)
    star = [STAR, families.single_vertex(5), families.single_vertex(6)][seed % 3]
    hub, folds = star.interior[0], star.folds
    chosen = sorted(random.choice(len(folds), len(folds) - 3, replace=False).tolist())
    angles = {folds[k]: float(random.choice([-1, 1]) * random.integers(20, 150)) for k in chosen}
    drive = PrescribedAngles.of(angles)
    spokes = np.array([[float(c) for c in star.vertices[v]] for v in star.star(hub)])
    rows = np.zeros((len(spokes), len(spokes)))  # first-order angles, the hub at height 0
    for k in range(len(spokes)):
        around = [spokes[k - 1], spokes[k], spokes[(k + 1) % len(spokes)]]
        for m, sign in ((0, 1), (2, 1)):
            across = around[m][0] * around[1][1] - around[m][1] * around[1][0]
            along = around[m] @ around[1] / (around[1] @ around[1])
            far = np.linalg.norm(around[1]) / abs(across)
            rows[k, (k + m - 1) % len(spokes)] += sign * far
            rows[k, k] -= sign * far * along
    place = [folds.index((v, hub)) for v in star.star(hub)]
    driven_rows = rows[[place.index(k) for k in chosen]]
    base = np.linalg.lstsq(driven_rows, np.array(drive.sines), rcond=None)[0]
    null = np.linalg.svd(driven_rows)[2][-3:]
    bends = rows @ null.T  # of three heights, two are planes
    way = null.T @ np.linalg.svd(bends)[2][0]

    def form(h: np.ndarray) -> float:
        """K, from the turns of unit normals: a spherical polygon's area (docs/mathematics.md)."""
        tiny = 1e-4
        normals = [
            np.cross([*a, tiny * x], [*b, tiny * y])
            for a, x, b, y in zip(spokes, h, np.roll(spokes, -1, 0), np.roll(h, -1), strict=True)
        ]
        flat = np.array([n[:2] / n[2] for n in normals]) / tiny
        after = np.roll(flat, -1, 0)
        return float((flat[:, 0] * after[:, 1] - flat[:, 1] * after[:, 0]).sum() / 2)

    values = [form(base + t * way) for t in (-1.0, 0.0, 1.0)]
    c, b, a = values[1], (values[2] - values[0]) / 2, (values[2] + values[0]) / 2 - values[1]
    real = 2 if b * b - 4 * a * c > 0 else 0
    found = 0
    for signs in "+-":
        try:
            found += 1 + find_driven(star, angles, signs).others
        except NotFollowedError:
            continue
    assert found == real
