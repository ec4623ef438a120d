"""Certificates written by `exactfold count`, and what `exactfold check` says of them."""

import json

import pytest
from compact_files import bodies, chained
from running import BAD_INPUT, INVALID, PROVED, error_class, run

from exactfold.pattern.data import SHEETS, example_path


@pytest.mark.parametrize("name", SHEETS)
def test_certificate_is_written_and_valid(tmp_path, name):
    out = tmp_path / "c.json"
    counted = run("count", example_path(name), "--json", "--certificate", out)
    assert counted.exit_code == PROVED
    assert json.loads(counted.stdout)["certificate"] == str(out)
    checked = run("check", out)
    assert checked.exit_code == PROVED
    assert checked.stdout.startswith("VALID: ")


@pytest.mark.usefixtures("without_spaces")
def test_certificates_of_panels(tmp_path):
    drawing = tmp_path / "cross.fold"
    points = [[-1, -1], [1, -1], [1, 1], [-1, 1], [0, 0], [0, -1], [1, 0], [0, 1], [-1, 0]]
    rim = [[0, 5], [5, 1], [1, 6], [6, 2], [2, 7], [7, 3], [3, 8], [8, 0]]
    folds = [[4, 5], [4, 6], [4, 7], [4, 8]]
    letters = ["B"] * 8 + ["U"] * 4
    keys = ("vertices_coords", "edges_vertices", "edges_assignment")
    drawing.write_text(json.dumps(dict(zip(keys, (points, rim + folds, letters), strict=True))))
    out = tmp_path / "c.json"
    counted = run("count", drawing, "--json", "--certificate", out)
    assert counted.exit_code == PROVED
    assert json.loads(counted.stdout)["certificate"] == str(out)
    data = json.loads(run("check", out, "--json").stdout)
    assert data["valid"] is True
    assert data["claims"]["second_order"] == data["claims"]["true"] == {"1": 2}
    # A triangle at each of whose corners three more folds end: not decided.
    points = [[0, 0], [8, 0], [3, 7], [-2, 6], [-6, 2], [-4, -4], [2, -6], [6, -6], [12, -4]]
    points += [[13, 3], [8, 10], [3, 13]]
    rim = [[k, k + 1] for k in range(3, 11)] + [[3, 11]]
    folds = [[0, 1], [1, 2], [0, 2], [0, 4], [0, 5], [0, 6], [1, 7], [1, 8], [1, 9]]
    folds += [[2, 10], [2, 11], [2, 3]]
    letters = ["B"] * 9 + ["U"] * 12
    more = dict(zip(keys, (points, rim + folds, letters), strict=True))
    drawing.write_text(json.dumps(more))
    out.unlink()
    counted = run("count", drawing, "--json", "--certificate", out)
    assert json.loads(counted.stdout)["certificate"] == str(out)
    assert "the certificate proves bounds of the degrees of freedom only" in counted.stderr
    data = json.loads(run("check", out, "--json").stdout)
    assert (data["valid"], list(data["claims"])[-2:]) == (True, ["least", "most"])


def test_check_json(certificate):
    data = json.loads(run("check", certificate, "--json").stdout)
    assert data["valid"] is True
    assert data["claims"]["distinct"] == 4


def test_tampered_certificate_is_invalid(tmp_path, certificate):
    lines = bodies(certificate.read_bytes())
    lines[-1]["claims"]["distinct"] = 5
    bad = tmp_path / "bad.txt"
    bad.write_bytes(chained(lines))
    result = run("check", bad)
    assert result.exit_code == INVALID
    assert result.stdout == "INVALID: claim distinct = 5, but it is 4\n"
    as_json = run("check", bad, "--json")
    assert as_json.exit_code == INVALID
    assert json.loads(as_json.stdout)["valid"] is False


@pytest.mark.parametrize("keep", [0, 1, 100, -2])
def test_truncated_certificate_is_bad_input(tmp_path, certificate, keep):
    bad = tmp_path / "bad.json"
    bad.write_text(certificate.read_text()[:keep])
    result = run("check", bad)
    assert result.exit_code == BAD_INPUT
    assert result.stdout == ""
    assert error_class(run("check", bad, "--json")) == "CertificateFormatError"


@pytest.mark.parametrize(
    ("change", "culprit"),
    [
        ({"format": "other"}, "format"),
        ({"version": 3}, "version 3"),
        ({"version": True}, "version True"),
        ({"extra": 1}, "keys"),
        ({"pattern": 0.5}, "floats"),
    ],
)
def test_unknown_certificate_is_bad_input(tmp_path, certificate, change, culprit):
    first, *others = bodies(certificate.read_bytes())
    bad = tmp_path / "bad.txt"
    bad.write_bytes(chained([first | change, *others]))
    result = run("check", bad)
    assert result.exit_code == BAD_INPUT
    assert error_class(run("check", bad, "--json")) == "CertificateFormatError"
    assert culprit in result.stderr


def test_check_of_undecodable_bytes(tmp_path):
    bad = tmp_path / "bad.json"
    bad.write_bytes(b"\xff\xfe\x00")
    result = run("check", bad)
    assert result.exit_code == BAD_INPUT
    assert error_class(run("check", bad, "--json")) == "CertificateFormatError"


def test_check_of_a_missing_file(tmp_path):
    result = run("check", tmp_path / "none.json")
    assert result.exit_code == BAD_INPUT
    assert "cannot read" in result.stderr
    assert "none.json" in result.stderr


@pytest.mark.parametrize("place", ["missing/out.json", "folder", "file/out.json"])
def test_unwritable_certificate(tmp_path, two_vertex, place):
    (tmp_path / "folder").mkdir()
    (tmp_path / "file").write_text("kept")
    before = sorted(p.name for p in tmp_path.rglob("*"))
    result = run("count", two_vertex, "--json", "--certificate", tmp_path / place)
    assert result.exit_code == BAD_INPUT
    assert error_class(result) == "UnwritableFileError"
    assert str(tmp_path / place) in result.stderr
    assert sorted(p.name for p in tmp_path.rglob("*")) == before
    assert (tmp_path / "file").read_text() == "kept"
