"""Writing FOLD files: what is in them, exact round trips, and whole or not at all."""

import json
import os
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pattern_strategies import patterns, quick, similarities, transformed

from exactfold.errors import (
    NotApplicableError,
    StaleExactCoordinatesError,
    UnwritableFileError,
    UsageError,
)
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.data import example_path
from exactfold.pattern.drawing.formats.fold_json import EXACT_KEY
from exactfold.pattern.families import single_vertex, two_vertex
from exactfold.pattern.fold import load_fold, parse_fold, read_fold
from exactfold.pattern.writing.fold_writing import (
    document_text,
    fold_document,
    write_fold,
    write_text,
)


def test_document_has_what_other_programs_need():
    pattern = two_vertex()
    document = fold_document(pattern, {(0, 4): "M", (4, 5): "V", (1, 4): "F"}, title="test")
    assert document["file_spec"] == 1.2
    assert document["file_creator"] == "exactfold"
    assert document["file_title"] == "test"
    assert document["frame_classes"] == ["creasePattern"]
    assert document["frame_attributes"] == ["2D"]
    assert document["vertices_coords"][4] == [1 / 3, 0.4]
    assert document[EXACT_KEY][4] == ["1/3", "2/5"]
    edges = [tuple(edge) for edge in document["edges_vertices"]]
    letters = dict(zip(edges, document["edges_assignment"], strict=True))
    angles = dict(zip(edges, document["edges_foldAngle"], strict=True))
    assert edges == list(pattern.edges)
    assert all((letters[e] == "B") == (e in pattern.boundary_edges) for e in edges)
    assert (letters[0, 4], letters[4, 5], letters[1, 4], letters[1, 5]) == ("M", "V", "F", "U")
    assert (angles[0, 4], angles[4, 5], angles[1, 4], angles[1, 5]) == (-180, 180, 0, 0)
    assert all(angles[e] == 0 for e in pattern.boundary_edges)
    assert [tuple(face) for face in document["faces_vertices"]] == list(pattern.triangles)


@pytest.mark.parametrize(
    "assignment",
    [{(4, 0): "M"}, {(0, 2): "M"}, {(0, 4): "B"}, {(0, 4): ""}, {(0, 1): "M"}, {(0, 4): "MV"}],
)
def test_assignment_usage_error(assignment):
    with pytest.raises(UsageError):
        fold_document(two_vertex(), assignment)


def test_written_file_is_read_back_with_its_assignment(tmp_path):
    path = tmp_path / "pattern.fold"
    write_fold(two_vertex(), path, {(0, 4): "M", (0, 1): "B"})
    file = load_fold(path)
    assert file.pattern == two_vertex()
    assert file.exact
    assert file.assignment[0, 4] == "M"
    assert os.listdir(tmp_path) == ["pattern.fold"]


@quick
@given(patterns(), similarities)
def test_round_trip_is_exact(pattern, similarity):
    moved = transformed(pattern, similarity)
    text = json.dumps(fold_document(moved))
    file = parse_fold(text)
    assert file.pattern == moved
    assert file.pattern.sha256 == moved.sha256
    edges_only = {k: v for k, v in json.loads(text).items() if k != "faces_vertices"}
    assert set(parse_fold(json.dumps(edges_only)).pattern.triangles) == set(moved.triangles)


@quick
@given(patterns(), st.data())
def test_moving_a_written_vertex_is_noticed(pattern, data):
    document = fold_document(pattern)
    v = data.draw(st.integers(0, len(pattern.vertices) - 1))
    document["vertices_coords"][v][data.draw(st.integers(0, 1))] += 2.0**-10
    with pytest.raises(StaleExactCoordinatesError, match=f"vertex {v}:"):
        parse_fold(json.dumps(document))


def test_huge_and_tiny_coordinates(tmp_path):
    tiny = CreasePattern([(0, 0), (Fraction(1, 10**400), 0), (0, 1)], [(0, 1, 2)])
    write_fold(tiny, tmp_path / "tiny.fold")
    assert read_fold(tmp_path / "tiny.fold") == tiny
    huge = CreasePattern([(0, 0), (10**400, 0), (0, 1)], [(0, 1, 2)])
    with pytest.raises(NotApplicableError, match=r"vertex 1 .* scale the pattern down"):
        write_fold(huge, tmp_path / "huge.fold")
    assert not (tmp_path / "huge.fold").exists()
    long = CreasePattern([(0, 0), (Fraction(10**5000 + 1, 10**5000), 0), (0, 1)], [(0, 1, 2)])
    write_fold(long, tmp_path / "long.fold")
    assert read_fold(tmp_path / "long.fold") == long


def test_unwritable_file_error(tmp_path):
    (tmp_path / "file").write_text("x")
    for path in (tmp_path / "none" / "a.fold", tmp_path, tmp_path / "file" / "a.fold", "a\0b"):
        with pytest.raises(UnwritableFileError, match="cannot write"):
            write_fold(single_vertex(4), path)
    assert os.listdir(tmp_path) == ["file"]


def test_a_failed_write_leaves_the_old_file(tmp_path, monkeypatch):
    path = tmp_path / "pattern.fold"
    path.write_text("old")

    def refuse(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "replace", refuse)
    with pytest.raises(UnwritableFileError, match="No space left"):
        write_fold(single_vertex(4), path)
    assert path.read_text() == "old"
    assert os.listdir(tmp_path) == ["pattern.fold"]


def test_write_text_follows_links_and_keeps_devices(tmp_path):
    (tmp_path / "real").write_text("old")
    (tmp_path / "link").symlink_to(tmp_path / "real")
    write_text(tmp_path / "link", "new")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "real").read_text() == "new"
    write_text(os.devnull, "nothing")
    assert not os.path.isfile(os.devnull)


def test_an_example_or_a_file_is_written_like_a_pattern(tmp_path):
    write_fold("two-vertex", tmp_path / "one.fold")
    write_fold(load_fold(tmp_path / "one.fold"), tmp_path / "two.fold")
    write_fold(tmp_path / "two.fold", str(tmp_path / "three.fold"))
    assert read_fold(tmp_path / "three.fold") == read_fold(example_path("two-vertex"))


@pytest.mark.parametrize("path", [two_vertex(), None, 3, b"out.fold", {(0, 4): "M"}])
def test_a_path_that_is_none_is_named(path, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(UsageError, match=r"write_fold\(pattern, path\): .* is not a path; give"):
        write_fold("out.fold", path)
    with pytest.raises(UsageError, match=r"is not a path"):
        write_fold(two_vertex(), path)
    assert os.listdir(tmp_path) == []


def test_what_is_no_pattern_is_named(tmp_path):
    with pytest.raises(UsageError, match="3 is not a pattern"):
        write_fold(3, tmp_path / "out.fold")
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize(
    "rows",
    [
        [[0, 1], [2, 3]],
        [["1/2", "-3"], ["4", "5"]],
        [["], [", "x"]],
        [["], ["], []],
        [[[1, 2], [3]], [4]],
        [[], []],
        [[{"a": 1}], [2]],
        [{"a": [[1, 2], [3]]}, {"b": 2}],
    ],
)
def test_rows_are_on_lines_of_their_own_and_stay_the_same(rows):
    text = document_text({"rows": rows})
    assert json.loads(text) == {"rows": rows}
    assert all(
        isinstance(row, dict) or f"\n    {json.dumps(row)}{end}" in text
        for row, end in zip(rows, [*[",\n"] * (len(rows) - 1), "\n  ]"], strict=True)
    )
