"""The exported file as other programs meet it: read by FOLD and Rabbit Ear, folded by a model."""

import json
import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from bar_hinge import Model, read, state

from exactfold import random_square
from exactfold.branches import count_branches, export_branch, find_branch
from exactfold.errors import UsageError
from exactfold.interop.fold_frames import BRANCH_KEY, HEIGHTS_KEY, branch_document
from exactfold.layers import fold_flat
from exactfold.layers.fold_frames import state_document
from exactfold.motion import follow, write_motion
from exactfold.pattern import families, load_fold, write_fold
from exactfold.pattern.writing.fold_writing import document_text

READERS = Path(__file__).with_name("fold_readers.mjs")


def exported(tmp_path, pattern, branch, **options):
    path = tmp_path / "branch.fold"
    export_branch(branch, path, **options)
    return read(path)


# --- the file ------------------------------------------------------------------------------------


def test_two_frames_with_the_keys_that_readers_need(tmp_path):
    pattern = families.two_vertex()
    document = exported(tmp_path, pattern, find_branch(pattern, "-+"), title="two")
    assert document["file_spec"] == 1.2
    assert document["file_title"] == "two, branch -+"
    assert document["frame_classes"] == ["creasePattern"]
    assert document["frame_unit"] == "unit"
    assert {len(point) for point in document["vertices_coords"]} == {2}
    (folded,) = document["file_frames"]
    assert (folded["frame_classes"], folded["frame_attributes"]) == (["foldedForm"], ["3D"])
    assert (folded["frame_parent"], folded["frame_inherit"]) == (0, True)
    assert "second order" in folded["frame_title"]
    assert "not exact" in folded["frame_title"]
    assert np.array(folded["vertices_coords"]).shape == (6, 3)
    facts = document[BRANCH_KEY]
    assert (facts["vertex_signs"], facts["vertices"]) == ("-+", [4, 5])
    assert (facts["status"], facts["gauge"]) == ("proved", "saddle")
    assert facts["pattern"] == pattern.sha256
    assert len(document[HEIGHTS_KEY]) == 6
    keys = [*document, *folded]
    standard = ("file_", "frame_", "vertices_", "edges_", "faces_")
    assert all(key.startswith(standard) for key in keys)
    assert [key for key in keys if ":" in key] == [
        "frame_exactfold:branch",
        "vertices_exactfold:coords",
        "vertices_exactfold:heights",
    ]


@pytest.mark.parametrize("name", ["two-vertex", "flat-vertex", "random", "octahedron", "hypar"])
def test_what_is_read_back_is_the_pattern_and_the_letters(tmp_path, name):
    pattern = {
        "two-vertex": families.two_vertex,
        "flat-vertex": families.flat_vertex_square,
        "random": lambda: random_square(3, seed=0),
        "octahedron": families.flat_octahedron_in_square,
        "hypar": lambda: families.hypar(2),
    }[name]()
    branches = count_branches(pattern).branches[:8]
    texts = set()
    for k, branch in enumerate(branches):
        path = tmp_path / f"{k}.fold"
        export_branch(branch, path)
        file = load_fold(path)
        assert file.pattern == pattern
        assert file.exact
        letters = {fold: file.assignment[fold] for fold in pattern.folds}
        assert letters == dict(branch.assignment)
        texts.add(path.read_text())
    assert len(texts) == len(branches) > 0


def test_branches_with_the_same_letters_make_different_files(tmp_path):
    pattern = random_square(6, seed=24)
    branches = count_branches(pattern).branches
    twins = [
        (a, b)
        for k, a in enumerate(branches)
        for b in branches[:k]
        if a.assignment_text == b.assignment_text
    ]
    for a, b in twins:
        files = [exported(tmp_path, pattern, branch) for branch in (a, b)]
        assert files[0]["edges_assignment"] == files[1]["edges_assignment"]
        assert files[0]["edges_foldAngle"] != files[1]["edges_foldAngle"]
    assert len(twins) == 3


def test_an_angle_against_its_letter_is_refused():
    pattern = families.single_vertex(4)
    common = {"name": "branch", "facts": {}, "heights": []}
    points = [(0, 0, 0)] * 5
    for letters, angles in [
        ({(0, 4): "M"}, {(0, 4): 1.0}),
        ({(0, 4): "V"}, {(0, 4): -1.0}),
        ({(0, 4): "F"}, {(0, 4): 1.0}),
        ({(0, 4): "U"}, {(0, 4): 1.0}),
        ({(0, 4): "V"}, {(0, 4): 181.0}),
        ({(0, 4): "V"}, {(0, 4): float("nan")}),
        ({}, {(0, 1): 1.0}),
        ({}, {(4, 0): 0.0}),
    ]:
        with pytest.raises(UsageError, match=r"angle cannot be|has no edge"):
            branch_document(pattern, letters, angles, points, **common)


# --- folded by a model ---------------------------------------------------------------------------


def follows(document, branch, targets=None):
    """Whether the model that is driven by the file ends on the branch, and how far it is folded."""
    model = Model.of(document, targets)
    points = model.folded()
    seen = state(model, points)
    signs = all(seen.signs[v] == sign for v, sign in branch.vertex_signs.items() if sign)
    letters = all(
        seen.letters[fold] == letter for fold, letter in branch.assignment.items() if letter in "MV"
    )
    bent = np.degrees(np.max(np.abs(model.angles(points)[0])))
    return signs and letters, float(bent)


def test_the_slopes_of_the_model_are_those_of_its_forces(tmp_path):
    pattern = families.two_vertex()
    model = Model.of(exported(tmp_path, pattern, find_branch(pattern, "+-")))
    noise = 0.1 * np.random.default_rng(1).normal(size=model.points.shape)
    x = (model.points + noise).ravel()
    steps = 1e-6 * np.eye(len(x))
    differences = [(model.forces(x + s, 0.7) - model.forces(x - s, 0.7)) / 2e-6 for s in steps]
    assert np.max(np.abs(np.transpose(differences) - model.slopes(x, 0.7))) < 1e-7


@pytest.mark.slow
@pytest.mark.parametrize("amount", [pytest.param(10, marks=pytest.mark.slow), 30])
@pytest.mark.parametrize("name", ["two-vertex", "three", "four", "flat-vertex", "reflex"])
def test_the_model_stays_on_every_branch(tmp_path, name, amount):
    pattern = {
        "two-vertex": families.two_vertex,
        "three": lambda: random_square(3, seed=0),
        "four": lambda: random_square(4, seed=0),
        "flat-vertex": families.flat_vertex_square,
        "reflex": _reflex,
    }[name]()
    branches = count_branches(pattern).branches
    for branch in branches:
        document = exported(tmp_path, pattern, branch, amount=amount)
        on_branch, bent = follows(document, branch)
        assert on_branch, branch.sign_text
        assert bent == pytest.approx(amount, rel=0.05)
    expected = {"two-vertex": 4, "three": 8, "four": 16, "flat-vertex": 3, "reflex": 4}
    assert len(branches) == expected[name]


def test_letters_alone_do_not_lead_to_the_branch(tmp_path):
    """The same angle on every fold leaves the branch: why the angles are written."""
    pattern = families.two_vertex()
    path = tmp_path / "letters.fold"
    same = []
    for branch in count_branches(pattern).branches:
        write_fold(pattern, path, branch.assignment)
        document = read(path)
        assert {abs(angle) for angle in document["edges_foldAngle"]} == {0, 180}
        sixth = [angle / 6 for angle in document["edges_foldAngle"]]
        same.append(follows(document, branch, sixth)[0])
    assert sorted(same) == [False, False, True, True]


def _reflex():
    from sheets import reflex_corners, scrambled

    return scrambled(1, reflex_corners(1), 2, loose=True)


# --- read by other programs ----------------------------------------------------------------------


def node_modules():
    """The folder on NODE_PATH with both packages, or None."""
    for folder in filter(None, os.environ.get("NODE_PATH", "").split(os.pathsep)):
        if all(Path(folder, name, "package.json").is_file() for name in ("fold", "rabbit-ear")):
            return Path(folder).resolve()
    return None


@pytest.fixture
def readers(tmp_path):
    """Runs `fold_readers.mjs` on files."""
    modules, node = node_modules(), shutil.which("node")
    if node is None:
        pytest.skip("not run: node is not installed")
    if modules is None:
        pytest.skip("not run: npm packages fold and rabbit-ear are not installed (NODE_PATH)")
    folder = tmp_path / "node"
    folder.mkdir()
    (folder / "node_modules").symlink_to(modules)
    shutil.copy(READERS, folder)

    def run(*paths):
        done = subprocess.run(
            [node, READERS.name, *paths], cwd=folder, capture_output=True, text=True, check=False
        )
        assert (done.returncode, done.stderr) == (0, "")
        return [json.loads(line) for line in done.stdout.splitlines()]

    return run


def test_fold_and_rabbit_ear_read_every_branch(tmp_path, readers):
    pattern = random_square(3, seed=0)
    branches = count_branches(pattern).branches
    paths = [tmp_path / f"{k}.fold" for k in range(len(branches))]
    for branch, path in zip(branches, paths, strict=True):
        export_branch(branch, path, amount=10)
    seen = readers(*paths)
    assert len(seen) == len(branches) == 8
    for branch, path, programs in zip(branches, paths, seen, strict=True):
        _check_fold_library(pattern, branch, read(path), programs["fold"])
        _check_rabbit_ear(pattern, branch, read(path), programs["ear"])


def test_fold_and_rabbit_ear_read_flat_folds(tmp_path, readers):
    pattern = families.flat_vertex_square()
    branch = next(b for b in count_branches(pattern).branches if "F" in b.assignment_text)
    path = tmp_path / "flat.fold"
    export_branch(branch, path, amount=10)
    (programs,) = readers(path)
    _check_fold_library(pattern, branch, read(path), programs["fold"])
    _check_rabbit_ear(pattern, branch, read(path), programs["ear"])


@pytest.mark.parametrize("until", ["contact", "return"])
def test_rabbit_ear_reads_every_frame_of_a_motion(tmp_path, readers, until):
    pattern = random_square(3, seed=0)
    motion = follow(find_branch(pattern, "+-+"), until=until, through_branch_points=True, frames=12)
    path = tmp_path / "motion.fold"
    write_motion(motion, path)
    document = read(path)
    (programs,) = readers(path)
    frames = programs["ear"]["motion"]
    assert len(frames) == 12
    for seen, frame, coords in zip(frames, document["file_frames"], motion.coords, strict=True):
        assert seen["problems"] == []
        assert seen["edges"] == len(pattern.edges)
        assert seen["coords"] == coords.tolist()
        own = frame.get("edges_assignment", document["edges_assignment"])
        assert seen["letters"] == "".join(own)
        inner = [letter != "B" for letter in own]
        turned = np.radians(np.array(seen["angles"]) - frame["edges_foldAngle"])[inner]
        assert np.cos(turned) == pytest.approx(np.ones(len(turned)), abs=1e-9)


def test_fold_and_rabbit_ear_read_flat_folded_states(tmp_path, readers):
    """The frames, the folded coordinates, and layers that agree with the letters."""
    state = fold_flat("miura").state()
    sheet = state.images.pieces.sheet
    path = tmp_path / "state.fold"
    path.write_text(document_text(state_document(state)), encoding="utf-8")
    document = read(path)
    (programs,) = readers(path)
    assert programs["fold"]["json"]
    assert programs["fold"]["traced"] == programs["fold"]["stated"]
    seen = programs["ear"]
    assert (seen["frames"], seen["folded"], seen["problems"]) == (2, 1, [[], []])
    assert seen["classes"] == [["creasePattern"], ["foldedForm"]]
    assert seen["components"] == [[2], [2]]
    assert seen["isFoldedForm"] == [False, True]
    assert len(seen["orders"]) == len(state.orders)
    assert seen["orders"] == document["file_frames"][0]["faceOrders"]
    folded = np.array(seen["foldedByEar"])  # by the other program, from the letters alone
    places = np.array(state.images.places)
    lengths = [np.linalg.norm(p[:, None] - p[None], axis=2) for p in (folded[:, :2], places)]
    assert lengths[0] == pytest.approx(lengths[1], abs=1e-9)
    assert len(folded) == len(sheet.vertices)


def _check_fold_library(pattern, branch, document, seen):
    assert seen["json"]
    edges = [tuple(edge) for edge in document["edges_vertices"]]
    assert (seen["vertices"], seen["edges"], seen["faces"]) == (
        len(pattern.vertices),
        len(pattern.edges),
        len(pattern.triangles),
    )
    for letter, key in (("M", "mountains"), ("V", "valleys")):
        expected = {fold for fold, found in branch.assignment.items() if found == letter}
        assert {edges[k] for k in seen[key]} == expected
    assert {edges[k] for k in seen["boundary"]} == set(pattern.boundary_edges)
    assert seen["traced"] == seen["stated"]
    assert seen["sides"] == sorted(f"{i},{j}" for i, j in pattern.edges)
    assert seen["once"] == pattern.Ve
    x, y = pattern.vertices[0]
    assert seen["moved"] == pytest.approx([float(x) + 1, float(y) + 2])
    assert seen["short"] == [len(edges) - 1] * 3
    for face, sides in zip(document["faces_vertices"], seen["facesEdges"], strict=True):
        pairs = zip(face, face[1:] + face[:1], strict=True)
        assert [edges[k] for k in sides] == [(min(pair), max(pair)) for pair in pairs]


def _check_rabbit_ear(pattern, branch, document, seen):
    assert (seen["frames"], seen["folded"]) == (2, 1)
    assert seen["problems"] == [[], []]
    assert seen["vertices"] == [len(pattern.vertices)] * 2
    assert seen["components"] == [[2], [3]]
    assert seen["inherited"] == len(pattern.edges)
    assert seen["classes"] == [["creasePattern"], ["foldedForm"]]
    assert seen["isFoldedForm"] == [False, True]
    # Its angles of the frame in space are those of the file, but for what second order leaves.
    written = np.array(document["edges_foldAngle"])
    inner = np.array([letter != "B" for letter in document["edges_assignment"]])
    found = np.array(seen["angles"])
    assert np.max(np.abs(found - written)[inner]) < 0.2
    clear = inner & (np.abs(written) > 0.2)
    assert np.array_equal(np.sign(found[clear]), np.sign(written[clear]))
    assert np.count_nonzero(clear) >= 2
