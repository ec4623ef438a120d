"""Drawings with inexact digits: headlines and exit codes are about the sheet that was meant."""

from __future__ import annotations

import json
import random
import re
from collections.abc import Sequence
from fractions import Fraction
from math import cos, radians, sin
from pathlib import Path
from typing import Any

import pytest
from noise_put_back import SHEETS, noisy, turned
from running import INVALID, PROVED, UNDECIDED, USAGE, run
from sampling import slow_after

import exactfold
from exactfold.errors import NotApplicableError, UsageError
from exactfold.pattern.drawing.meant import inference, positions, turning
from exactfold.pattern.loading import open_sheet
from exactfold.pattern.reading import Reading


def written(tmp_path: Path, document: dict[str, Any], name: str = "noisy") -> Path:
    path = tmp_path / f"{name}.fold"
    path.write_text(json.dumps(document))
    return path


@pytest.fixture
def miura(tmp_path: Path) -> Path:
    """A turned Miura sheet with noise of 1e-9, and letters."""
    document = turned(noisy(SHEETS["miura"], 1e-9))
    letters = exactfold.read("miura").letters
    edges = [tuple(edge) for edge in document["edges_vertices"]]
    document["edges_assignment"] = [letters.get(edge, "B") for edge in edges]
    return written(tmp_path, document)


@pytest.fixture
def by_hand(tmp_path: Path) -> Path:
    """A map whose lines miss being straight by 1e-7 to 1e-2, so that nothing can be inferred."""
    rng, document = random.Random(5), turned(noisy(SHEETS["map-fold"], 0.0))
    size = max(max(point) for point in document["vertices_coords"])
    for point in document["vertices_coords"]:
        for k in (0, 1):
            point[k] += rng.choice((-1, 1)) * size * 10 ** rng.uniform(-7, -2.3)
    return written(tmp_path, document, "by-hand")


def test_the_headline_is_about_the_sheet_that_was_meant(miura: Path) -> None:
    result = run("count", miura)
    said = " ".join(result.stdout.split())
    assert result.exit_code == PROVED
    assert said.startswith("the sheet that was meant, within ")
    assert "of the drawing: 8 families of ways to fold, 7 of dimension 1 and 1 of" in said
    assert "the digits as written: rigid - PROVED" in said
    assert said.endswith("(--snap exact)")
    (line,) = result.stderr.splitlines()
    assert re.fullmatch(
        r"exactfold: read noisy.fold: 40 lines, inexact by .e-09, "
        r"46 relations inferred, moved by up to \d\.\de-9; -v for more",
        line,
    )
    lines = run("count", miura, "-v").stderr.splitlines()
    lines = [line.removeprefix("exactfold: ") for line in lines]
    assert any(line.startswith("the drawing is inexact by ") for line in lines)
    assert any(" relations of angles (" in line and " independent; by " in line for line in lines)
    assert any(line.endswith("there is a sheet with all of them - PROVED") for line in lines)
    exact = run("count", miura, "--snap", "exact")
    assert exact.exit_code == PROVED
    assert exact.stdout.startswith("rigid - PROVED")


def test_json_has_both_answers(miura: Path) -> None:
    data = json.loads(run("count", miura, "--json").stdout)
    assert (data["status"], data["components"]["true"]) == ("proved", {"1": 7, "3": 1})
    assert (data["as_written"]["rigid"], data["as_written"]["sheet"]) == (True, "as written")
    meant = data["meant"]
    assert (meant["existence"], meant["reason"], meant["left"]) == ("exact", "", [])
    assert 0 < meant["eps"] < 1e-8
    assert meant["gap"] == pytest.approx(meant["clear"] / meant["eps"])
    assert meant["gap"] > 100
    assert 0 < meant["distance"] < 1e-8
    assert meant["independent"] <= len(meant["relations"])
    listed = run("count", miura, "--relations").stderr
    for relation in meant["relations"]:
        assert f"{relation['name']} is off by {relation['defect']:.1e}" in listed
    assert json.loads(run("count", "two-vertex", "--json").stdout)["meant"] is None


@pytest.mark.slow
def test_match_and_python_answer_about_the_same_sheet(miura: Path) -> None:
    matched = run("match", miura, "--json")
    assert matched.exit_code == PROVED
    assert json.loads(matched.stdout)["meant"]["existence"] == "exact"
    assert run("match", miura, "--snap", "exact").exit_code == INVALID
    opened = exactfold.read(miura)
    assert opened.meant is not None
    assert opened.meant.inferred
    assert exactfold.match(opened).starts is exactfold.Verdict.PROVED
    assert exactfold.count(opened).meant == opened.meant
    assert exactfold.read(miura, snap="exact").meant is None


@pytest.mark.parametrize(
    "command",
    slow_after(4, [["fold"], ["draw", "--way", "1"], ["info"], ["convert"], ["view"]]),
)
def test_all_commands_take_the_sheet_that_was_meant(
    miura: Path, tmp_path: Path, command: Sequence[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    name, *more = command
    output = {"draw": ["-o", "a.svg"], "view": ["-o", "a.html"], "convert": ["a.fold"]}
    result = run(name, miura, *more, *output.get(name, []), "-v")
    assert result.exit_code == PROVED
    said = result.stderr + result.stdout
    assert "of the drawing there is a sheet with all of them - PROVED" in said


@pytest.mark.slow
def test_a_batch_takes_the_sheet_that_was_meant(miura: Path, by_hand: Path) -> None:
    result = run("count", miura, by_hand, "--json", "--jobs", 1)
    lines = {line["name"]: line for line in map(json.loads, result.stdout.splitlines())}
    assert lines[str(miura)]["result"]["meant"]["existence"] == "exact"
    assert [lines[str(path)]["status"] for path in (miura, by_hand)] == ["proved", "undecided"]
    assert result.exit_code == UNDECIDED


def test_the_certificate_of_the_sheet_is_checked(miura: Path, tmp_path: Path) -> None:
    sheet, evidence = tmp_path / "sheet.fold", tmp_path / "meant.json"
    done = run("convert", miura, sheet, "--certificate", evidence, "--json")
    assert done.exit_code == PROVED
    assert json.loads(done.stdout)["meant"]["existence"] == "exact"
    checked = run("check", evidence)
    assert checked.exit_code == PROVED
    assert checked.stdout.startswith("VALID: within ")
    again = run("count", sheet, "--json")  # an exact file, of which nothing need be inferred
    assert json.loads(again.stdout)["meant"] is None
    assert json.loads(again.stdout)["components"]["true"] == {"1": 7, "3": 1}
    none = run("convert", "two-vertex", tmp_path / "two.fold", "--certificate", tmp_path / "n.json")
    assert "no certificate was written" in none.stderr
    assert not (tmp_path / "n.json").exists()


def test_what_was_inferred_can_be_overruled(miura: Path) -> None:
    meant = json.loads(run("count", miura, "--json").stdout)["meant"]
    names = [relation["name"] for relation in meant["relations"]]
    kawasaki = next(name for name in names if name.startswith("kawasaki"))
    result = run("count", miura, "--without", kawasaki, "--json")
    left = json.loads(result.stdout)["meant"]
    assert kawasaki not in [relation["name"] for relation in left["relations"]]
    stated = json.loads(run("count", miura, "--noise", "1e-8", "--json").stdout)["meant"]
    assert stated["eps"] == 1e-8


@pytest.mark.parametrize(
    ("options", "code", "said"),
    [
        (("--noise", "0"), USAGE, "0 is not positive; --snap exact takes the digits as written"),
        (("--noise", "2"), USAGE, "between 0 and 1, not 2"),
        (("--unit", "0"), USAGE, "0 is less than 1"),
        (("--without", "straight@99999"), USAGE, "there is no relation 'straight@99999'"),
        (("--without", "nonsense"), USAGE, "'nonsense' names no relation"),
        (("--also", "parallel 0-1,0-99"), USAGE, "there is no edge 0-1"),
        (("--snap", "exact", "--unit", "24"), USAGE, "--snap exact takes the digits as written"),
    ],
)
def test_bad_overruling_is_an_error_of_its_own(
    miura: Path, options: tuple[str, ...], code: int, said: str
) -> None:
    result = run("count", miura, *options)
    assert result.exit_code == code
    assert said in " ".join(result.stderr.replace("│", " ").split())


def test_what_changes_nothing_about_an_exact_drawing_is_said() -> None:
    result = run("info", "miura", "--unit", 24)
    assert result.exit_code == PROVED
    said = " ".join(result.stderr.split())
    assert (
        "no relation between creases holds nearly but not exactly: --unit changed nothing" in said
    )
    assert "changed nothing" not in run("info", "miura").stderr
    stated = run("info", "miura", "--unit", 12, "--noise", "1e-9").stderr
    assert "--noise, --unit changed nothing" in " ".join(stated.split())
    assert "inferred" not in stated


def test_a_relation_that_the_drawing_misses_by_far_is_refused(miura: Path) -> None:
    with pytest.raises(UsageError, match="the drawing misses 'parallel 0-9,0-10' by"):
        exactfold.read(miura, also=["parallel 0-9,0-10"])


@pytest.fixture
def fan(tmp_path: Path) -> Path:
    """Twelve lines through a point, 15 degrees apart, with noise of 1e-9."""
    rng, points = random.Random(1), [(0.0, 0.0)]
    for k in range(24):
        x, y = cos(radians(15 * k)), sin(radians(15 * k))
        largest = max(abs(x), abs(y))
        points.append((x / largest, y / largest))
    noise = [[x + rng.uniform(-1e-9, 1e-9) for x in point] for point in points]
    edges = [(0, k) for k in range(1, 25)] + [(k, k % 24 + 1) for k in range(1, 25)]
    data: dict[str, Any] = {"vertices_coords": noise, "edges_vertices": edges}
    return written(tmp_path, {**data, "edges_assignment": ["U"] * 24 + ["B"] * 24}, "fan")


@pytest.mark.parametrize(
    ("pattern", "options", "said"),
    [
        ("fan", ["parallel 0-1,0-2"], "parallel:0-1,0-2 contradicts grid:0-2, grid:0-1"),
        (
            "thin",
            ["grid 0-4", "grid 2-4", "straight@4:0-2"],
            "straight@4:0-2 contradicts grid:0-4, grid:2-4",
        ),
    ],
)
def test_a_relation_that_contradicts_others_is_refused_with_the_remedy(
    pattern: str, options: Sequence[str], said: str, request: pytest.FixtureRequest
) -> None:
    """Those of the fan are inferred; those of the thin sheet, at multiples of 4 degrees, stated."""
    unit = ["--unit", 45] if pattern == "thin" else []
    also = [word for option in options for word in ("--also", option)]
    result = run("count", request.getfixturevalue(pattern), *unit, *also)
    assert (result.exit_code, result.stdout) == (USAGE, "")
    remedy = "leave it out, or leave one of these out (--without)"
    assert f"the relation {said}: {remedy}" in " ".join(result.stderr.split())


@pytest.fixture
def thin(tmp_path: Path) -> Path:
    """A square with five folds at a vertex, two of which are 4 degrees apart; it is exact."""
    path = tmp_path / "thin.fold"
    points = [(0, 0), (1, 0), (1, 1), (0, 1), (0.51, 0.47), (0.05, 0)]
    border = [(0, 5), (5, 1), (1, 2), (2, 3), (3, 0)]
    folds = [(v, 4) for v in (0, 5, 1, 2, 3)]
    data = {"vertices_coords": points, "edges_vertices": border + folds}
    path.write_text(json.dumps({**data, "edges_assignment": list("BBBBBMVMVM")}))
    return path


@pytest.mark.parametrize("options", [("--also", "parallel 0-4,4-5"), ("--noise", "0.05")])
def test_a_sheet_that_would_lose_a_panel_is_refused_with_the_place(
    thin: Path, options: tuple[str, ...]
) -> None:
    """The panel 0-5-4 collapses if its sides at 4 are parallel."""
    result = run("count", thin, *options)
    assert (result.exit_code, result.stdout) == (USAGE, "")
    assert "no sheet near the drawing is as asked for" in result.stderr
    assert "vertices 0 and 5 are at the same point" in result.stderr


def test_what_is_stated_of_an_exact_drawing_has_no_noise(thin: Path) -> None:
    meant = json.loads(run("count", thin, "--also", "straight@4:0-2", "--json").stdout)["meant"]
    assert "straight@4:0-2" in [relation["name"] for relation in meant["relations"]]
    assert (meant["eps"], meant["gap"], meant["existence"]) == (None, None, "exact")
    assert meant["distance"] > 0.02
    sectors = exactfold.read(thin, also=["sectors@4:0-1,1-2", "sectors@4:1-2,2-3"]).meant
    assert sectors is not None
    assert {"sectors@4:0-1,1-2", "sectors@4:1-2,2-3"} <= {r.name for r in sectors.relations}


@pytest.mark.slow
def test_a_doubt_without_a_noise_level_says_so(
    miura: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(inference, "noise_level", lambda *_: None)
    result = run("count", miura)
    assert result.exit_code == UNDECIDED
    said = " ".join(result.stdout.split())
    assert "is not known, because no noise level stands out from chance (--noise EPS states" in said


def test_a_denominator_takes_no_relations(thin: Path) -> None:
    result = run("count", thin, "--snap", 100, "--noise", "1e-3")
    assert result.exit_code == USAGE
    assert "--snap 100 rounds all digits: leave out" in result.stderr


@pytest.mark.slow
def test_nothing_is_inferred_from_a_drawing_by_hand(by_hand: Path) -> None:
    result = run("count", by_hand)
    assert result.exit_code == UNDECIDED
    said = " ".join(result.stdout.split())
    assert said.startswith("the number of ways to fold is UNDECIDED")
    assert "relations nearly hold, such as" in said
    assert (
        "so that answers hold only for these digits; the sheet that was meant is not known" in said
    )
    assert "(--snap exact)" in said
    assert run("count", by_hand, "--snap", "exact").exit_code == PROVED
    meant = exactfold.read(by_hand).meant
    assert meant is not None
    with pytest.raises(NotApplicableError, match="no sheet was inferred"):
        meant.certificate()


def test_a_batch_counts_again_what_was_overruled_or_taken_literally(
    miura: Path, tmp_path: Path
) -> None:
    lines = tmp_path / "o.jsonl"

    def skipped(*options: object) -> int:
        done = run("count", miura, "--jsonl", lines, "--jobs", 1, "--json", *options)
        return int(json.loads(done.stdout)["skipped"])

    assert [skipped(), skipped(), skipped("--noise", "1e-8"), skipped("--noise", "1e-8")] == [
        *(0, 1),
        *(0, 1),
    ]
    first, second = (json.loads(line) for line in lines.read_text().splitlines())
    assert (first["asked"]["overruled"], second["asked"]["overruled"]) == ([], ["--noise", "1e-08"])
    del first["result"]["meant"]  # as versions wrote that took every drawing literally
    lines.write_text(json.dumps(first) + "\n")
    assert skipped() == 0


def test_a_denominator_that_leaves_near_relations_is_no_remedy(miura: Path) -> None:
    result = run("count", miura, "--snap", 10**7)
    assert result.exit_code == UNDECIDED
    assert "--snap 10000000 leaves them" in " ".join(result.stdout.split())


@pytest.fixture
def too_long(miura: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The turned Miura sheet, seen from no edge; coordinates of more than 10 bits are too long."""
    monkeypatch.setattr(positions, "_MOST_BITS", 10)
    monkeypatch.setattr(turning, "_FRAMES", 0)
    return miura


def test_ways_are_counted_from_directions_if_coordinates_are_too_long(too_long: Path) -> None:
    result = run("count", too_long, "--json")
    data = json.loads(result.stdout)
    assert (result.exit_code, data["components"]["true"]) == (PROVED, {"1": 7, "3": 1})
    assert data["meant"]["existence"] == "box"
    assert 0 < data["meant"]["distance"] < 1e-7
    pattern = data["pattern"]
    assert 0 < Fraction(pattern["radius"]) < Fraction(1, 10**20)
    folds = exactfold.read(too_long).sheet.folds
    assert {f"{i}-{j}" for i, j in folds} <= set(pattern["directions"])
    said = run("count", too_long, "-v").stderr
    assert "directions of its folds are exact; the positions of its vertices are enclosed" in said


def test_no_second_way_to_an_exact_sheet_is_tried_after_the_time_limit(too_long: Path) -> None:
    opened = open_sheet(too_long, Reading(limit=0))
    assert opened.meant is not None
    assert opened.meant.existence == "none"
    assert opened.doubt.endswith("share of the time limit, 0 of 0 seconds (--limit), was used up")


@pytest.mark.slow
@pytest.mark.parametrize(
    "command",
    [
        ("count", "--certificate", "out.json"),
        ("match", "--certificate", "out.json"),
        ("convert", "out.fold", "--certificate", "out.json"),
        ("fold", "--certificate", "out.json"),
    ],
)
def test_no_certificate_has_enclosed_positions(
    too_long: Path, tmp_path: Path, command: Sequence[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    name, *more = command
    result = run(name, too_long, *more)
    assert "positions of its vertices are too long to be written down" in " ".join(
        (result.stderr + result.stdout).split()
    )
    assert not (tmp_path / "out.json").exists()


@pytest.mark.parametrize(
    "command", slow_after(1, [["info"], ["fold"], ["vertices"], ["view", "-o", "a.html"]])
)
def test_other_commands_take_enclosed_positions(
    too_long: Path, tmp_path: Path, command: Sequence[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    name, *more = command
    result = run(name, too_long, *more)
    assert result.exit_code == PROVED, result.stderr


@pytest.mark.slow
def test_a_doubt_is_said_once_and_no_letters_of_the_digits_are_listed(by_hand: Path) -> None:
    for command in ("count", "match", "info", "assignments"):
        letters = ["--letters", "M" * 10] if command == "match" else []
        result = run(command, by_hand, *letters)
        said = " ".join((result.stderr + result.stdout).split())
        assert said.count("the sheet that was meant is not known") == 1, command
    assert run("count", by_hand, "--json").stderr.count("is not known") == 1
    data = json.loads(run("assignments", by_hand, "--json").stdout)
    assert (data["status"], data["number"], data["at_most"]) == ("undecided", None, None)
    assert [part["assignments"] for part in data["parts"]] == [[]]
    assert "--snap exact lists the assignments of the digits" in data["reason"]
    assert run("assignments", by_hand, "--snap", "exact").exit_code == PROVED


def test_relations_say_so_where_none_is_near() -> None:
    for pattern in ("miura", "two-vertex"):
        for more in ([], ["--snap", "exact"]):
            said = run("count", pattern, "--relations", *more).stderr
            assert said.endswith("no relation between creases holds nearly but not exactly\n")
    assert "nearly but not exactly" not in run("count", "miura").stderr
