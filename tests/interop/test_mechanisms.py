"""Sheets as mechanisms, in the readers of the programs that simulate them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import exactfold
from exactfold.interop.mechanisms import _plate, mechanism, mjcf_text, urdf_texts
from exactfold.motion.curves.in_motion import SheetInMotion
from exactfold.motion.writing import write_motion
from exactfold.pattern.panel_pattern import PanelPattern

WAYS: dict[str, dict[str, Any]] = {
    "miura": {"way": 2},
    "square-twist": {"way": 1},
    "two-vertex": {"signs": "+-"},
}


@pytest.fixture(scope="module", params=WAYS)
def motion(request: pytest.FixtureRequest) -> SheetInMotion:
    found = exactfold.follow(request.param, **WAYS[request.param], until="60deg", frames=4)
    assert isinstance(found, SheetInMotion)
    return found


def distances(points: np.ndarray) -> np.ndarray:
    """All distances between points, as shares of the largest distance in the flat sheet."""
    return np.asarray(np.linalg.norm(points[:, None] - points[None], axis=2))


def test_the_tree_holds_every_panel_once_and_every_other_fold_closes_loops(
    motion: SheetInMotion,
) -> None:
    robot = mechanism(motion.pattern)
    held = [robot.root]
    for hinge in robot.tree:
        assert hinge.parent in held
        assert hinge.child not in held
        held.append(hinge.child)
    assert sorted(held) == list(range(len(robot.faces)))
    assert sorted(hinge.fold for hinge in (*robot.tree, *robot.closing)) == sorted(
        motion.pattern.folds
    )
    assert len(robot.closing) == len(motion.pattern.interior)
    assert robot.root == int(np.argmax(robot.areas))


@pytest.mark.slow
def test_mujoco_has_the_sheet_of_every_frame(motion: SheetInMotion) -> None:
    mujoco = pytest.importorskip("mujoco")
    text = mjcf_text(motion.pattern, motion.angles, motion.times, "sheet")
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    robot = mechanism(motion.pattern)
    unit = float(np.ptp([[float(c) for c in p] for p in motion.pattern.vertices], axis=0).max())
    assert float(model.body_mass.sum()) == pytest.approx(1.0)
    assert model.nkey == len(motion.times)
    for frame in range(-1, model.nkey):
        if frame < 0:  # as it starts: in the first frame that is not flat
            mujoco.mj_forward(model, data)
        else:
            mujoco.mj_resetDataKeyframe(model, data, frame)
            mujoco.mj_forward(model, data)
        assert np.abs(data.efc_pos).max(initial=0.0) < 1e-12
        coords = motion.coords[1 if frame < 0 else frame] / unit
        for panel, face in enumerate(robot.faces):
            body = data.body(f"panel {panel}")
            there = robot.points[list(face)] @ body.xmat.reshape(3, 3).T + body.xpos
            root = data.body(f"panel {robot.root}")
            held = robot.points[list(robot.faces[robot.root])] @ root.xmat.reshape(3, 3).T
            both = [*robot.faces[robot.root], *face]
            assert np.allclose(
                distances(np.concatenate([held + root.xpos, there])),
                distances(coords[both]),
                atol=1e-9,
            )


@pytest.mark.slow
def test_a_simulation_that_drives_one_fold_stays_on_the_way() -> None:
    mujoco = pytest.importorskip("mujoco")
    motion = exactfold.follow("miura", 2, until="120deg", frames=13)
    text = mjcf_text(motion.pattern, motion.angles, motion.times, "miura")
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    robot = mechanism(motion.pattern)
    column = {fold: k for k, fold in enumerate(motion.pattern.folds)}
    joint = max(robot.tree, key=lambda hinge: abs(motion.angles[1, column[hinge.fold]]))
    turn = float(np.sign(motion.angles[1, column[joint.fold]]))
    while abs(data.joint(joint.name).qpos[0]) < 1.0:
        assert data.time < 60
        data.joint(joint.name).qfrc_applied[0] = 0.01 * turn
        mujoco.mj_step(model, data)
    driven = float(data.joint(joint.name).qpos[0])
    angles = turn * motion.angles[:, column[joint.fold]]
    for hinge in robot.tree:
        expected = np.interp(turn * driven, angles, motion.angles[:, column[hinge.fold]])
        assert data.joint(hinge.name).qpos[0] == pytest.approx(expected, abs=0.05)


@pytest.mark.slow
def test_a_robot_reader_has_the_sheet_of_every_frame(motion: SheetInMotion, tmp_path: Path) -> None:
    yourdfpy = pytest.importorskip("yourdfpy")
    written = write_motion(motion, tmp_path / "sheet.urdf")
    assert len(written) == 1 + len(mechanism(motion.pattern).faces)
    robot = yourdfpy.URDF.load(str(written[0]))
    sheet = mechanism(motion.pattern)
    column = {fold: k for k, fold in enumerate(motion.pattern.folds)}
    assert set(robot.actuated_joint_names) == {hinge.name for hinge in sheet.tree}
    masses = [link.inertial.mass for link in robot.robot.links]
    assert sum(masses) == pytest.approx(1.0)
    origin = {sheet.root: np.zeros(3)}
    origin.update((hinge.child, sheet.points[hinge.start]) for hinge in sheet.tree)
    for angles in motion.angles:
        robot.update_cfg({hinge.name: angles[column[hinge.fold]] for hinge in sheet.tree})
        place = {k: robot.get_transform(f"panel {k}") for k in origin}
        at = {
            (k, v): place[k][:3, :3] @ (sheet.points[v] - origin[k]) + place[k][:3, 3]
            for k, face in enumerate(sheet.faces)
            for v in face
        }
        for hinge in (*sheet.tree, *sheet.closing):  # closing folds stay together, too
            for v in hinge.fold:
                assert np.allclose(at[hinge.parent, v], at[hinge.child, v], atol=1e-9)


@pytest.mark.slow
def test_a_panel_that_is_not_convex_is_made_of_triangles() -> None:
    mujoco = pytest.importorskip("mujoco")
    points = [(0, 0), (4, 0), (4, 4), (2, 1), (0, 4), (2, 6)]
    edges = [(0, 1), (1, 2), (2, 3), (3, 4), (0, 4), (2, 5), (4, 5)]
    sheet = PanelPattern(points, edges)
    zero = np.zeros((2, len(sheet.folds)))
    model = mujoco.MjModel.from_xml_string(mjcf_text(sheet, zero, np.arange(2.0), "two"))
    assert model.ngeom == 3 + 1  # three triangles, and a panel that is convex
    assert float(model.body_mass.sum()) == pytest.approx(1.0)


def test_moments_of_a_rectangle() -> None:
    """12 I = m (b^2, a^2, a^2 + b^2) for a plate of the sides a, b."""
    corners = np.array([[0.0, 0, 0], [3, 0, 0], [3, 2, 0], [0, 2, 0]])
    mass, centre, moments = _plate(corners[np.array([[0, 1, 2], [0, 2, 3]])], 2.0)
    assert (mass, *centre) == (12.0, 1.5, 1.0, 0.0)
    assert [float(moments[key]) for key in ("ixx", "iyy", "izz", "ixy")] == pytest.approx(
        [4.0, 9.0, 13.0, 0.0]
    )


def test_files_name_the_folds_that_urdf_cannot_have() -> None:
    text, meshes = urdf_texts(exactfold.read("miura").sheet, "miura", "miura")
    assert len(meshes) == 16
    closing = mechanism(exactfold.read("miura").sheet).closing
    assert ", ".join(hinge.name for hinge in closing) in text
