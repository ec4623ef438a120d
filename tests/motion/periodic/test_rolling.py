"""Periodic sheets that roll up: lengths, screws, the beginning, and what is refused."""

from __future__ import annotations

import math

import numpy as np
import pytest

from exactfold.branches import count_periodic
from exactfold.branches.periodic.sampled import _slopes
from exactfold.errors import NotApplicableError, UsageError
from exactfold.motion.periodic.patch import Patch
from exactfold.motion.periodic.rolling import RollingMotion, roll
from exactfold.motion.periodic.wrapping import Wrapping, shortening
from exactfold.pattern import PeriodicPattern, random_cell, read_cell
from exactfold.rigidity.equations.periodic import PeriodicProblem
from exactfold.solve.numeric.periodic_rays import PeriodicRays


def rolled(cell: str | PeriodicPattern, way: int, **more: object) -> RollingMotion:
    given: dict[str, object] = {"cells": (3, 2), "frames": 4, "until": "40deg", **more}
    return roll(cell, (1, 2), way=way, **given)  # type: ignore[arg-type]


def moved(one: np.ndarray, two: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """The rigid motion that carries some points to others, and by how much it fails (Kabsch)."""
    a, b = one - one.mean(axis=0), two - two.mean(axis=0)
    u, _, v = np.linalg.svd(a.T @ b)
    turn = (u @ np.diag([1, 1, np.linalg.det(u @ v)]) @ v).T
    shift = two.mean(axis=0) - turn @ one.mean(axis=0)
    return turn, shift, float(np.abs(one @ turn.T + shift - two).max())


@pytest.mark.parametrize(
    ("cell", "way"),
    [
        ("waterbomb-cell", 2),
        ("miura-cell", 1),
        (random_cell(5, 5), 3),  # with a vertex inside a triangulated triangle
    ],
)
def test_lengths_are_kept_and_two_commuting_screws_leave_the_sheet_invariant(
    cell: str | PeriodicPattern, way: int
) -> None:
    motion = rolled(cell, way)
    assert motion.end == "angle"
    assert abs(np.abs(motion.largest_angles).max() - 40) < 1e-6
    assert motion.length_error < 1e-11
    number = {corner: k for k, corner in enumerate(motion.patch.corners)}
    frame, screws = motion.coords[-1], []
    for step in ((1, 0), (0, 1)):
        pairs = [
            (k, number[v, i + step[0], j + step[1]])
            for (v, i, j), k in number.items()
            if (v, i + step[0], j + step[1]) in number
        ]
        one, two = np.array(pairs).T
        turn, shift, off = moved(frame[one], frame[two])
        assert off < 1e-10
        screws.append((turn, shift))
    (a, p), (b, q) = screws
    assert np.abs(a @ b - b @ a).max() < 1e-10
    assert np.abs(a @ q + p - b @ p - q).max() < 1e-10
    for (turn, shift), (angle, advance) in zip(screws, motion.screws[-1], strict=True):
        assert math.cos(angle) == pytest.approx((np.trace(turn) - 1) / 2, abs=1e-10)
        axis = np.linalg.svd(turn - np.eye(3))[2][-1]
        assert abs(axis @ shift) == pytest.approx(abs(advance), abs=1e-9)


def test_it_begins_with_the_folds_of_the_branch() -> None:
    motion = rolled("waterbomb-cell", 2, until="1deg", frames=2)
    cell = read_cell("waterbomb-cell")
    problem = PeriodicProblem.of(cell, (1, 2))
    rays = PeriodicRays(problem)
    row = next(k for k, s in enumerate(rays.signs) if s.tolist() == [1, -1, 1])
    slopes = dict(zip(cell.edges, rays.rays()[row] @ _slopes(problem).T, strict=True))
    largest = max(map(abs, slopes.values()))
    for fold, angle in zip(motion.pattern.folds, motion.angles[-1], strict=True):
        (u, i, j), (v, k, m) = (motion.patch.corners[end] for end in fold)
        slope = slopes.get((u, v, k - i, m - j), slopes.get((v, u, i - k, j - m)))
        assert angle / math.radians(1) == pytest.approx(slope / largest, abs=1e-3)
    assert motion.name == "way 2 across 1,2"
    assert "Theorem 18" in motion.reason


def test_letters_of_the_patch_are_those_of_the_angles() -> None:
    motion = rolled("waterbomb-cell", 1, until="20deg")
    for fold, angle in zip(motion.pattern.folds, motion.angles[1], strict=True):
        assert motion.assignment[fold] == ("V" if angle > 0 else "M")


def test_five_cells_of_the_resch_pattern_close_to_a_ring() -> None:
    motion = roll("resch-cell", (1, 0), way=8, cells=(5, 1), frames=3)
    assert motion.end == "contact"
    assert 5 * abs(motion.screws[-1][0][0]) == pytest.approx(2 * math.pi, abs=1e-6)


def test_the_planar_fold_of_miura_is_no_branch_but_its_rolling_ways_are() -> None:
    motion = rolled("miura-cell", 5)
    assert (
        motion.reason == "the frames and the first contact were computed in floats"
    )  # (H) does not hold
    assert motion.at(motion.duration / 2).shape == motion.coords[0].shape


def test_derivatives_are_those_of_differences() -> None:
    problem = PeriodicProblem.of(read_cell("resch-cell"), (2, 1))
    wrapping = Wrapping(problem, PeriodicRays(problem).rays()[3])
    z = wrapping.start()
    assert z is not None
    assert np.abs(wrapping.values(z, 0.0)).max() < 1e-12
    z = z + np.linspace(-0.1, 0.1, len(z))
    found, step = wrapping.jacobian(z, 0.3), 1e-6
    for k in range(len(z)):
        ahead = z.copy()
        ahead[k] += step
        behind = z.copy()
        behind[k] -= step
        slope = (wrapping.values(ahead, 0.3) - wrapping.values(behind, 0.3)) / (2 * step)
        assert found[:, k] == pytest.approx(slope, abs=1e-7)


@pytest.mark.parametrize("x", [0.0, 0.1, 0.49, 0.51, 2.0, 9.0])
def test_the_series_and_the_closed_form_agree(x: float) -> None:
    expected = 1 / 3 if not x else (1 - (math.sin(math.sqrt(x)) ** 2) / x) / x
    assert float(shortening(np.array(x))) == pytest.approx(expected, rel=1e-12 if x > 0.2 else 1e-9)


def test_what_cannot_be_followed_is_refused() -> None:
    with pytest.raises(UsageError, match="`count` lists 4 ways"):
        rolled("waterbomb-cell", 5)
    with pytest.raises(UsageError, match="give contact, or an angle"):
        rolled("waterbomb-cell", 1, until="time=1")
    with pytest.raises(UsageError, match="at least 2"):
        rolled("waterbomb-cell", 1, frames=1)
    with pytest.raises(UsageError, match="give 1 to 40"):
        rolled("waterbomb-cell", 1, cells=(0, 3))
    critical = count_periodic("waterbomb-cell", (0, 1))
    flat = next(k for k, b in enumerate(critical, 1) if "0" in b.vertex_signs)
    with pytest.raises(NotApplicableError, match="has flat vertices"):
        roll("waterbomb-cell", (0, 1), way=flat)


@pytest.mark.parametrize(
    "name", ["waterbomb-cell", "miura-cell", "resch-cell", "square-twist-cell"]
)
def test_patches_of_shipped_cells_have_all_faces(name: str) -> None:
    cell = read_cell(name)
    assert len(Patch.of(cell, (3, 2)).pattern.triangles) == 6 * len(cell.faces)


def test_faces_that_touch_the_patch_in_a_corner_are_left_out() -> None:
    for seed in range(6):
        sheet = random_cell(4, seed, flips=4)
        patch = Patch.of(sheet, (3, 3)).pattern  # a disk, or `CreasePattern` raises
        assert 50 < len(patch.triangles) <= 72
