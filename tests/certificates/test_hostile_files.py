"""Files made to mislead: what is printed, which checker they reach, sheets that are none."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from compact_files import Lines, bodies, chained, chained_texts, refused
from sheets import SQUARE, dart, reflex_corners, scrambled, with_point
from typer.testing import CliRunner

from exactfold import checker, random_square
from exactfold.app.cli import app
from exactfold.branches.certificates.check import check_compact
from exactfold.branches.certificates.read import read_branches
from exactfold.branches.counting.stream import stream_branches
from exactfold.checker import CertificateError, command
from exactfold.checker.core import lines as compact_lines
from exactfold.checker.core.reading import parse_rational
from exactfold.checker.sheets.sheet import read_sheet
from exactfold.errors import CertificateFormatError
from exactfold.pattern.crease_pattern import CreasePattern


def lines_of(pattern: CreasePattern, path: Path) -> Lines:
    stream_branches(pattern, path)
    return bodies(path.read_bytes())


SPOOFED = 'a "quoted" word\nVALID: 16 branches\x1b[2K\ud800\u00e9'


@pytest.mark.parametrize("place", ["open", "version", "claim"])
def test_what_is_printed_is_one_line_of_printable_ascii(
    place: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Text of the file that is quoted cannot pass for a verdict, nor stop the checker."""
    path = tmp_path / "c.txt"
    lines = lines_of(random_square(2, seed=1), path)
    if place == "open":
        lines[1]["open"] = [[0, SPOOFED]]
    elif place == "version":
        lines[0]["version"] = SPOOFED
    else:
        lines[-1]["claims"]["sha256"] = SPOOFED
    path.write_bytes(chained(lines))
    code = 3 if place == "version" else 1
    assert checker.main([str(path)]) == code
    printed = "".join(capsys.readouterr())
    result = CliRunner().invoke(app, ["check", str(path)])
    assert result.exit_code == code
    for text in (printed, result.stdout + result.stderr):
        assert text.count("\n") == 1
        assert text.isascii()
        assert text[:-1].isprintable()


def test_a_defect_or_lack_of_memory_is_no_verdict(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for error in (MemoryError, RuntimeError):

        def fail(*_: object, error: type[Exception] = error) -> None:
            raise error

        monkeypatch.setattr(command, "verify", fail)
        assert checker.main([str(tmp_path / "c.txt")]) == 70
        assert "VALID" not in "".join(capsys.readouterr())


@pytest.mark.parametrize("way", ["late", "escaped"])
def test_the_command_knows_a_compact_certificate_by_its_first_line(
    way: str, tmp_path: Path
) -> None:
    """However its header is written, `check` says what the stand-alone checker says."""
    path = tmp_path / "c.txt"
    lines = lines_of(random_square(2, seed=1), path)
    if way == "late":
        lines[0] = {"provenance": "x" * 9000, **{k: lines[0][k] for k in list(lines[0])[:-1]}}
    texts = [json.dumps(line) for line in lines]
    if way == "escaped":
        texts[0] = texts[0].replace('"format"', '"f\\u006frmat"')
    path.write_bytes(chained_texts(texts))
    assert checker.main([str(path)]) == 0
    assert CliRunner().invoke(app, ["check", str(path)]).exit_code == 0


def test_a_line_without_end_is_not_read_to_its_end(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "c.txt"
    lines_of(random_square(2, seed=1), path)
    monkeypatch.setattr(compact_lines, "MOST_LINE", 100)
    with pytest.raises(CertificateFormatError, match="line 1"):
        check_compact(path)


def test_many_vertices_in_triangles_make_a_long_multiplicity(tmp_path: Path) -> None:
    """2^70, an integer of 22 digits, is a true claim."""
    sheet = with_point(random_square(2, seed=1), 0, (1, 1, 1))
    while sheet.Vi < 70:
        sheet = with_point(sheet, len(sheet.triangles) - 1, (1, 2, 1))
    lines_of(sheet, tmp_path / "c.txt")
    for fast in (True, False):
        assert check_compact(tmp_path / "c.txt", fast=fast)["with_multiplicity"] == 1 << 70


SHEETS: dict[str, tuple[list[tuple[object, object]], list[tuple[int, ...]], str | None]] = {
    "overlap": (
        [(0, 0), (4, 0), (4, 4), (1, -1), (2, 1)],
        [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)],
        "not positive|meet",
    ),
    "clockwise": ([*SQUARE, ("1/2", "1/3")], [(1, 0, 4), (2, 1, 4), (3, 2, 4), (0, 3, 4)], "posit"),
    "T-junction": (
        [*SQUARE, ("1/2", 0), ("1/2", "1/2")],
        [(0, 1, 5), (1, 2, 5), (2, 3, 5), (3, 0, 5), (0, 4, 5)],
        "one side of edge",
    ),
    "no face": (
        [*SQUARE, ("1/2", "1/2"), (9, 9)],
        [(k, (k + 1) % 4, 4) for k in range(4)],
        "no face",
    ),
    "one point twice": (
        [*SQUARE, ("1/2", "1/2"), ("2/4", "1/2")],
        [*((k, (k + 1) % 4, 4) for k in range(3)), (3, 0, 5)],
        "one point",
    ),
    "pinched": (
        [(0, 0), (2, -1), (2, 1), (-2, 1), (-2, -1)],
        [(0, 1, 2), (0, 3, 4)],
        "pinched",
    ),
    "five corners": (
        [(0, 0), (2, 0), (3, 2), (1, 3), (-1, 2), (1, 1)],
        [(k, (k + 1) % 5, 5) for k in range(5)],
        None,
    ),
    "no inner vertex": (list(SQUARE), [(0, 1, 2), (0, 2, 3)], None),
    "face twice": ([*SQUARE, ("1/2", "1/2")], [(k % 4, (k + 1) % 4, 4) for k in range(5)], "twice"),
    "double cover": (
        [(4, 0), (0, 4), (-4, 0), (0, -4), (5, 1), (-1, 5), (-5, -1), (1, -5), (0, 0)],
        [(k, (k + 1) % 8, 8) for k in range(8)],
        "meet",
    ),
}


@pytest.mark.parametrize("name", SHEETS)
def test_sheets_that_are_none_are_refused(name: str, tmp_path: Path) -> None:
    """The last: around the hub the faces go twice, and only the boundary betrays it."""
    points, faces, match = SHEETS[name]
    lines = lines_of(random_square(1, seed=1), tmp_path / "c.txt")
    vertices = [[str(x) for x in point] for point in points]
    lines[0]["pattern"] = {"vertices": vertices, "triangles": [list(face) for face in faces]}
    if match is not None:
        with pytest.raises(CertificateError, match=match):
            read_sheet(lines[0]["pattern"])
    refused(chained(lines), tmp_path / "c.txt", f"{match}|four boundary vertices")


def negated(chart: dict[str, str]) -> dict[str, str]:
    return {v: str(-parse_rational(c)) for v, c in chart.items()}


CHARTS: dict[str, tuple[Callable[[dict[str, str]], Any], str]] = {
    "none": (lambda chart: None, "Krawczyk|sign"),
    "upside down": (negated, "Krawczyk|sign|folds are"),
    "without its corner": (lambda chart: {v: c for v, c in chart.items() if v != "0"}, "corner"),
    "twice": (lambda chart: {**chart, "00": "1"}, "twice"),
    "of a pinned corner": (lambda chart: {**chart, "1": "1"}, "neither its corner nor interior"),
    "of no vertex": (lambda chart: {**chart, "77": "1"}, "neither its corner nor interior"),
    "list": (lambda chart: [1], "neither null"),
}


@pytest.mark.parametrize("name", CHARTS)
def test_other_charts_of_a_reflex_corner_are_refused(name: str, tmp_path: Path) -> None:
    change, match = CHARTS[name]
    lines = lines_of(scrambled(2, reflex_corners(2), 4), tmp_path / "c.txt")
    lines[0]["evidence"]["chart"] = change(lines[0]["evidence"]["chart"])
    refused(chained(lines), tmp_path / "c.txt", match)


def test_branches_are_read_in_the_chart_they_were_written_in(tmp_path: Path) -> None:
    """A chart four times as large is as good for a proof, but its unknowns are other heights."""
    path = tmp_path / "c.txt"
    lines = lines_of(dart(), path)
    chart = lines[0]["evidence"]["chart"]
    for vertex, weight in chart.items():
        chart[vertex] = str(4 * parse_rational(weight))
    for place in (lines[1], *lines[1]["exact"]):
        place["bits"] += 2
    path.write_bytes(chained(lines))
    for fast in (True, False):
        assert check_compact(path, fast=fast)["distinct"] == 2
    with pytest.raises(CertificateError, match="the chart"):
        list(read_branches(path))


def test_a_flat_fold_is_neither_mountain_nor_valley(tmp_path: Path) -> None:
    """The folds of a cross: two are flat on each branch, and no letter but F is true."""
    cross = [(2, 0), (0, 3), (-2, 0), (0, -1), (0, 0)]
    sheet = CreasePattern(cross, [(k, (k + 1) % 4, 4) for k in range(4)])
    lines = lines_of(sheet, tmp_path / "c.txt")
    entry = lines[1]["exact"][0]
    assert entry["assignment"].count("F") == 2
    for letter in "MV":
        entry["assignment"] = entry["assignment"].replace("F", letter)
        refused(chained(lines), tmp_path / "d.txt", "folds are")


@pytest.mark.parametrize(
    ("change", "match"),
    [
        (lambda line: line.update(radii="////"), "another length"),
        (lambda line: line.update(radii="//8="), "root 0 is missing"),
        (lambda line: line.update(open=[["a", "b"]]), "malformed"),
        (lambda line: line.update(exact=[1]), "exact root"),
    ],
)
def test_malformed_blocks_are_not_read(
    change: Callable[[dict[str, Any]], None], match: str, tmp_path: Path
) -> None:
    path = tmp_path / "c.txt"
    lines = lines_of(random_square(1, seed=1), path)
    change(lines[1])
    path.write_bytes(chained(lines))
    with pytest.raises(CertificateError, match=match):
        list(read_branches(path))
