"""Files of motions, read back with other programs."""

from __future__ import annotations

import copy
import csv
import io
import json
import pickle
from fractions import Fraction
from functools import cache

import numpy as np
import pygltflib
import pytest
import trimesh
from panel_sheets import regular_twist

from exactfold import random_square
from exactfold.branches import find_branch
from exactfold.errors import PackageMissingError, UnwritableFileError, UsageError
from exactfold.interop import packages
from exactfold.motion import follow, follow_panels, write_motion
from exactfold.pattern import PanelPattern, load_fold, open_pattern
from exactfold.pattern.triangulating.panels import triangles_by_face, triangles_of

PATTERN = random_square(4, seed=1)
BRANCH = find_branch(PATTERN, "+-++")


@cache
def ahead():
    return follow(BRANCH, frames=6)


@cache
def mirror():
    return follow(BRANCH, frames=6, side=-1)


@cache
def closed():
    return follow(find_branch("two-vertex", "+-"), until="return", frames=5)


@cache
def twist():
    return follow_panels(regular_twist(6, (Fraction(0), Fraction(-5))), frames=4)


# --- FOLD ----------------------------------------------------------------------------------------


def written(motion, tmp_path, **options):
    path = tmp_path / "motion.fold"
    assert write_motion(motion, path, **options) == (path,)
    return json.loads(path.read_text()), load_fold(path)


@pytest.mark.parametrize("made", [ahead, mirror, closed])
def test_the_flat_frame_is_exact_and_all_others_follow(made, tmp_path):
    motion = made()
    document, file = written(motion, tmp_path, title="sheet")
    pattern = motion.branch.pattern
    assert file.pattern == pattern
    assert file.exact
    turn = str.maketrans("MV", "MV" if motion.side > 0 else "VM")
    letters = "".join(file.assignment[fold] for fold in pattern.folds)
    assert letters == motion.branch.assignment_text.translate(turn)
    assert document["file_title"].startswith("sheet, motion along branch ")
    facts = document["frame_exactfold:motion"]
    assert facts["vertex_signs"] == motion.branch.sign_text
    assert (facts["side"], facts["end"]) == (motion.side, motion.end)
    assert (facts["status"], facts["reason"]) == (str(motion.status), motion.reason)
    assert motion.reason == "followed in floats along a proved branch"
    assert facts["pattern"] == pattern.sha256
    assert max(map(abs, document["edges_foldAngle"])) == 30
    frames = document["file_frames"]
    assert np.array([f["vertices_coords"] for f in frames]).tolist() == motion.coords.tolist()
    assert [f["frame_exactfold:time"] for f in frames] == motion.times.tolist()
    edges = [tuple(edge) for edge in document["edges_vertices"]]
    for k, frame in enumerate(frames):
        assert (frame["frame_parent"], frame["frame_inherit"]) == (0, True)
        assert f"frame {k + 1} of {len(frames)}, time" in frame["frame_title"]
        angles = dict(zip(edges, frame["edges_foldAngle"], strict=True))
        signs = dict(
            zip(edges, frame.get("edges_assignment", document["edges_assignment"]), strict=True)
        )
        assert all(-180 <= angle <= 180 for angle in angles.values())
        assert not any(angles[edge] for edge in pattern.boundary_edges)
        for fold, angle in zip(pattern.folds, np.degrees(motion.angles[k]), strict=True):
            assert np.cos(np.radians(angles[fold] - angle)) == pytest.approx(1, abs=1e-12)
            letter = "V" if angles[fold] > 0 else "M" if angles[fold] < 0 else "F"
            assert signs[fold] == letter
            assert letter != "F" or k in (0, len(frames) - 1)


def test_letters_change_where_an_angle_does(tmp_path):
    document, _ = written(closed(), tmp_path)
    assert np.max(np.abs(closed().angles)) > np.pi
    changed = [f for f in document["file_frames"] if "edges_assignment" in f]
    assert 2 < len(changed) < 5
    assert set(changed[0]["edges_assignment"]) == {"F", "B"}
    for frame in changed:
        assert frame["edges_assignment"] != document["edges_assignment"]


def test_panels_stay_polygons_with_exact_corners(tmp_path):
    document = json.loads(write_motion(twist(), tmp_path / "p.fold", title="twist")[0].read_text())
    sheet = twist().pattern
    opened = open_pattern(tmp_path / "p.fold")
    assert opened.sheet == sheet
    assert opened.field_name == "Q(sqrt 3)"
    assert {len(face) for face in document["faces_vertices"]} == {3, 4, 6}
    assert document["faces_vertices"] == [list(face) for face in sheet.faces]
    assert document["file_title"] == "twist, motion along way 1"
    assert document["frame_title"].startswith("flat sheet, with the fold angles at time 0.524 of")
    facts = document["frame_exactfold:motion"]
    assert (facts["modes"], facts["way"], facts["free_folds"]) == ([1], 1, [])
    assert (facts["status"], facts["pattern"]) == (str(twist().status), sheet.sha256)
    assert max(map(abs, document["edges_foldAngle"])) == pytest.approx(30)
    edges = [tuple(edge) for edge in document["edges_vertices"]]
    letters = dict(zip(edges, document["edges_assignment"], strict=True))
    assert {fold: letters[fold] for fold in sheet.folds} == dict(twist().assignment)
    assert len(document["file_frames"]) == 4
    for k, frame in enumerate(document["file_frames"]):
        assert frame["vertices_coords"] == twist().coords[k].tolist()
        angles = dict(zip(edges, frame["edges_foldAngle"], strict=True))
        shown = [angles[fold] for fold in sheet.folds]
        assert shown == pytest.approx(np.degrees(twist().angles[k]).tolist(), abs=1e-6)


def test_panels_that_are_not_convex_are_cut_into_triangles(tmp_path):
    corners = [(0, 0), (4, 0), (4, 4), (0, 4), (3, 2)]  # the crease 0-4-3 leaves a dart
    sheet = PanelPattern(corners, [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (4, 3)])
    assert [len(face) for face in sheet.faces] == [5, 3]
    triangles = np.array(triangles_of(sheet))
    flat = np.array([[float(x), float(y), 0] for x, y in sheet.vertices])
    across = np.cross(*(flat[triangles[:, k]] - flat[triangles[:, 0]] for k in (1, 2)))[:, 2]
    assert (across > 0).all()
    assert across.sum() / 2 == 16
    assert [len(piece) for piece in triangles_by_face(sheet)] == [3, 1]
    for ending in ("glb", "obj"):
        path = write_motion(twist(), tmp_path / f"p.{ending}")[0]
        found = trimesh.load(path)
        mesh = next(iter(found.geometry.values())) if ending == "glb" else found
        expected = sum(len(face) - 2 for face in twist().pattern.faces)
        assert len(mesh.faces) == expected
        assert mesh.area == pytest.approx(area_of(twist().pattern), rel=1e-6)


def area_of(sheet):
    points = [(float(x), float(y)) for x, y in sheet.vertices]
    return sum(
        (points[a][0] * points[b][1] - points[b][0] * points[a][1]) / 2
        for face in sheet.faces
        for a, b in zip(face, (*face[1:], face[0]), strict=True)
    )


# --- glTF ----------------------------------------------------------------------------------------


class Reader:
    """What an animation shows, from the accessors of a file."""

    def __init__(self, path):
        self.model = pygltflib.GLTF2().load(str(path))
        if path.suffix == ".gltf":
            [buffer] = self.model.buffers
            self.blob = self.model.get_data_from_buffer_uri(buffer.uri)
        else:
            self.blob = self.model.binary_blob()

    def rows(self, number):
        accessor = self.model.accessors[number]
        view = self.model.bufferViews[accessor.bufferView]
        kind = {5126: "<f4", 5125: "<u4"}[accessor.componentType]
        width = {"SCALAR": 1, "VEC3": 3}[accessor.type]
        raw = self.blob[view.byteOffset : view.byteOffset + view.byteLength]
        rows = np.frombuffer(raw, dtype=kind).reshape(-1, width)
        assert len(rows) == accessor.count
        if accessor.min:
            assert rows.min(axis=0).tolist() == accessor.min
            assert rows.max(axis=0).tolist() == accessor.max
        return rows.astype(np.float64)

    def keys(self):
        [animation] = self.model.animations
        [sampler] = animation.samplers
        assert sampler.interpolation == "LINEAR"
        times = self.rows(sampler.input)[:, 0]
        return times, self.rows(sampler.output).reshape(len(times), -1)

    def shown(self, primitive, name, time):
        times, weights = self.keys()
        weight = [np.interp(time, times, column) for column in weights.T]
        base = self.rows(getattr(primitive.attributes, name))
        moved = [self.rows(target[name]) for target in primitive.targets]
        return base + sum(w * rows for w, rows in zip(weight, moved, strict=True))


@pytest.mark.parametrize("ending", ["glb", "gltf"])
def test_the_animation_shows_the_frames(tmp_path, ending):
    path = tmp_path / f"motion.{ending}"
    assert write_motion(ahead(), path, title="sheet") == (path,)
    reader = Reader(path)
    model = reader.model
    assert model.asset.extras["vertex_signs"] == "+-++"
    assert [m.name for m in model.materials] == ["front", "back"]
    assert not any(m.doubleSided for m in model.materials)
    [mesh] = model.meshes
    assert mesh.name == model.nodes[0].name == "sheet"
    assert mesh.extras["targetNames"] == [f"frame {k}" for k in range(1, 6)]
    times, _ = reader.keys()
    assert times.tolist() == pytest.approx(np.arange(11) * 0.8)  # there and back
    triangles = np.array(PATTERN.triangles)
    for key, frame in [(0, 0), (3, 3), (5, 5), (7, 3), (10, 0)]:
        corners = ahead().coords[frame][triangles]
        across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        up = across / np.linalg.norm(across, axis=1, keepdims=True)
        for side, primitive in zip((1, -1), mesh.primitives, strict=True):
            points = reader.shown(primitive, "POSITION", times[key])
            normals = reader.shown(primitive, "NORMAL", times[key])
            faces = reader.rows(primitive.indices)[:, 0].astype(int).reshape(-1, 3)
            assert sorted(faces.ravel()) == list(range(3 * len(triangles)))
            assert points.reshape(-1, 3, 3) == pytest.approx(corners, abs=1e-6)
            for k, (a, b, c) in enumerate(faces):
                seen = np.cross(points[b] - points[a], points[c] - points[a])
                assert seen @ normals[a] > 0
                assert normals[a] == pytest.approx(side * up[k], abs=1e-6)
                assert normals[a].tolist() == normals[b].tolist() == normals[c].tolist()


def test_a_motion_that_returns_goes_one_way(tmp_path):
    write_motion(closed(), tmp_path / "loop.glb")
    reader = Reader(tmp_path / "loop.glb")
    times, weights = reader.keys()
    assert times.tolist() == [0, 1, 2, 3, 4]
    assert weights.tolist() == [[0] * 4, *np.eye(4).tolist()]


def test_another_reader_sees_the_flat_sheet_with_y_up(tmp_path):
    write_motion(ahead(), tmp_path / "motion.glb")
    scene = trimesh.load(tmp_path / "motion.glb")
    front, back = scene.geometry.values()
    assert len(front.faces) == len(back.faces) == len(PATTERN.triangles)
    assert front.area == pytest.approx(1) == pytest.approx(back.area)
    assert scene.bounds == pytest.approx(np.array([[0, 0, -1], [1, 0, 0]]), abs=1e-6)


# --- STL and CSV ---------------------------------------------------------------------------------


def test_stl_has_a_mesh_for_each_frame(tmp_path):
    files = write_motion(ahead(), tmp_path / "m.stl")
    assert [file.name for file in files] == [f"m_000{k}.stl" for k in range(6)]
    for file, coords in zip(files, ahead().coords, strict=True):
        mesh = trimesh.load(file, process=False)
        corners = coords[np.array(PATTERN.triangles)].reshape(-1, 3)
        assert np.asarray(mesh.triangles).reshape(-1, 3) == pytest.approx(corners, abs=1e-6)


def test_stl_without_trimesh_names_the_extra(tmp_path, monkeypatch):
    monkeypatch.setattr(packages, "find_spec", lambda name: None)
    with pytest.raises(PackageMissingError, match=r"pip install 'exactfold\[meshes\]'"):
        write_motion(ahead(), tmp_path / "m.stl")
    assert not list(tmp_path.iterdir())


def test_csv_has_the_angles_of_each_frame_in_a_row(tmp_path):
    [file] = write_motion(ahead(), tmp_path / "m.csv")
    with file.open(newline="") as text:
        head, *rows = csv.reader(text)
    assert head == ["time", *(f"{i}-{j}" for i, j in PATTERN.folds)]
    table = np.array(rows, dtype=float)
    assert (table[:, 0] == ahead().times).all()
    assert (table[:, 1:] == np.degrees(ahead().angles)).all()


# --- OBJ -----------------------------------------------------------------------------------------


def test_a_file_for_each_frame(tmp_path):
    files = write_motion(ahead(), tmp_path / "m.obj")
    assert [file.name for file in files] == [f"m_000{k}.obj" for k in range(6)]
    assert sorted(tmp_path.iterdir()) == list(files)
    for file, coords in zip(files, ahead().coords, strict=True):
        mesh = trimesh.load(
            io.StringIO(file.read_text()), file_type="obj", process=False, maintain_order=True
        )
        assert mesh.faces.tolist() == [list(face) for face in PATTERN.triangles]
        assert mesh.vertices == pytest.approx(coords, abs=1e-7)


# --- what is refused -----------------------------------------------------------------------------


def test_refusals(tmp_path):
    for name in ("motion", "motion.dxf", "fold"):
        with pytest.raises(UsageError, match=r"\.fold, \.glb, \.gltf, \.obj"):
            write_motion(ahead(), tmp_path / name)
    with pytest.raises(UsageError, match="is not a motion"):
        write_motion(BRANCH, tmp_path / "motion.fold")
    for name in ("none/m.fold", "none/m.glb", "none/m.obj"):
        with pytest.raises(UnwritableFileError):
            write_motion(ahead(), tmp_path / name)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("made", [ahead, twist], ids=["branch", "panels"])
def test_arrays_of_a_motion_cannot_be_written_to(made):
    motion = made()
    for same in (motion, pickle.loads(pickle.dumps(motion)), copy.deepcopy(motion)):
        assert same == motion
        for array in (same.times, same.coords, same.angles):
            with pytest.raises(ValueError, match="read-only"):
                array[0] = 1.0
