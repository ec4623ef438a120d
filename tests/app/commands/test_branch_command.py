"""`exactfold branch`: what it prints, its exit codes, its errors."""

from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner, Result

from exactfold.app.cli import app
from exactfold.app.commands import branch
from exactfold.branches.counting.find import BranchFinder, find_branch
from exactfold.pattern.data import example_path
from exactfold.pattern.degenerate import ringed_square
from exactfold.pattern.fold import read_fold
from exactfold.pattern.writing.fold_writing import fold_text

TWO = example_path("two-vertex")
KEYS = {
    *(
        "format",
        "version",
        "pattern",
        "status",
        "reason",
        "vertex_signs",
        "undecided_vertices",
        "assignment",
    ),
    *("gauge", "curvature", "straight_border", "saddle", "centres", "radius", "squared_distance"),
    *("steps", "warnings", "seconds"),
}


def run(*arguments: object) -> Result:
    return CliRunner().invoke(app, ["branch", *map(str, arguments)])


@pytest.mark.parametrize("given", [("--signs", "-+"), ("--up", "5"), ("--up", " 5,")])
def test_one_branch(given: tuple[str, str]) -> None:
    result = run(TWO, *given)
    assert result.exit_code == 0
    assert "PROVED" in result.stdout
    assert "VVMMVVM" in result.stdout


def test_json_is_the_result() -> None:
    result = run(TWO, "--signs", "-+", "--json")
    data = json.loads(result.stdout)
    assert set(data) == KEYS
    expected = find_branch(read_fold(TWO), "-+").to_dict(str(TWO))
    for key in KEYS - {"seconds"}:
        assert data[key] == expected[key]


def test_a_vertex_that_may_be_flat_is_exit_code_four(tmp_path) -> None:
    path = tmp_path / "ringed.fold"
    path.write_text(fold_text(ringed_square(4)))
    result = run(path, "--signs", "+++++")
    assert result.exit_code == 4
    assert "UNDECIDED" in result.stdout
    assert "flat to within" in result.stdout


def test_a_flat_vertex_is_shown() -> None:
    result = run(example_path("flat-vertex"), "--signs", "++")
    assert result.exit_code == 0
    text = " ".join(result.stdout.split())
    assert "0 at vertex 5, where it is flat; it is a solution of multiplicity 2" in text
    assert "up vertex 4 down none flat vertex 5 mountain-valley MFFMFFF" in text


def test_signs_from_a_file_and_a_batch(tmp_path) -> None:
    path = tmp_path / "signs.txt"
    path.write_text("-+\n\n++\n")
    table = run(TWO, "--batch", path)
    assert table.exit_code == 0
    assert "VVMMVVM" in table.stdout
    assert "MVMMMVM" in table.stdout
    lines = run(TWO, "--batch", path, "--json").stdout.splitlines()
    assert [json.loads(line)["vertex_signs"] for line in lines] == [
        {"4": -1, "5": 1},
        {"4": 1, "5": 1},
    ]
    path.write_text("-\n+\n")
    assert "VVMMVVM" in run(TWO, "--signs", f"@{path}").stdout


def test_a_batch_is_read_to_its_end_before_anything_is_found(tmp_path) -> None:
    path = tmp_path / "signs.txt"
    path.write_text("-+\n\n+-\n")
    assert [line[:6] for line in run(TWO, "--batch", path).stdout.splitlines()[1:]] == [
        "line 1",
        "line 3",
    ]
    path.write_text("-+\n\n+\n")
    result = run(TWO, "--batch", path, "--json")
    assert (result.exit_code, json.loads(result.stdout)["error"]["class"]) == (2, "UsageError")
    assert f"{path}, line 3: 1 sign for 2 vertices" in result.stderr


def test_nothing_asked_for_is_wrong_usage(tmp_path) -> None:
    path = tmp_path / "signs.txt"
    path.write_text("\n")
    assert run(TWO, "--batch", path).exit_code == 2
    assert run(TWO, "--up", "4", "--neighbours", "").exit_code == 2


def test_branches_are_printed_as_they_are_found(monkeypatch) -> None:
    events: list[str] = []
    find = BranchFinder.find

    def finding(self, signs, **options):
        events.append("find")
        return find(self, signs, **options)

    monkeypatch.setattr(BranchFinder, "find", finding)
    monkeypatch.setattr(branch, "print", lambda *_, **__: events.append("print"), raising=False)
    assert run(TWO, "--up", "4", "--neighbours", "all", "--json").exit_code == 0
    assert events == ["find", "print", "find", "print"]


@pytest.mark.parametrize(("pops", "texts"), [("all", "-- ++"), ("5", "++"), ("5,4", "++ --")])
def test_neighbours(pops: str, texts: str) -> None:
    """Of 4 up and 5 down: with 4 popped both are down, with 5 popped both are up."""
    result = run(TWO, "--up", "4", "--neighbours", pops, "--json")
    assert result.exit_code == 0
    found = [json.loads(line)["vertex_signs"] for line in result.stdout.splitlines()]
    sides = {"--": {"4": -1, "5": -1}, "++": {"4": 1, "5": 1}}
    assert found == [sides[text] for text in texts.split()]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((), "give one of --way, --signs, --up and --letters"),
        (("--drive", "3-5=9"), "give one of --way, --signs, --up and --letters"),
        (("--signs", "++", "--up", "4"), "give one of"),
        (("--signs", "+"), "1 sign for 2 vertices"),
        (("--signs", "+?"), "'?' is not a vertex sign"),
        (("--up", "0"), "vertex 0 is not an interior vertex"),
        (("--up", "x"), "not 'x'"),
        (("--up", "0_4"), "not '0_4'"),
        (("--up", "4", "--neighbours", "y"), "not 'y'"),
        (("--batch", "none.txt", "--neighbours", "all"), "goes with"),
    ],
)
def test_wrong_usage_is_exit_code_two(arguments: tuple[str, ...], message: str) -> None:
    result = run(TWO, *arguments)
    assert result.exit_code == 2
    assert message in result.stderr


def test_a_file_of_signs_that_is_not_there() -> None:
    result = run(TWO, "--signs", "@none.txt")
    assert result.exit_code == 3
    assert "exactfold: cannot read none.txt" in result.stderr


def test_signs_of_a_file_that_are_wrong_name_the_file(tmp_path) -> None:
    path = tmp_path / "signs.txt"
    path.write_text("+x\n")
    result = run(TWO, "--signs", f"@{path}")
    assert result.exit_code == 2
    assert result.stderr.startswith(f"exactfold: {path}: 'x' is not a vertex sign")
    assert result.stderr.count("\n") == 1
