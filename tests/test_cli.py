"""The command line: exit codes, errors on stderr, JSON with exactly the documented keys."""

import json
import os
import signal
import socket
import subprocess
import sys
from fractions import Fraction

import pytest
from sheets import HEXAGON, SQUARE, TRIANGLE, nested_triangles, scrambled, with_point
from typer.testing import CliRunner

import exactfold
from exactfold import (
    EXAMPLES,
    cli,
    count_branches,
    example_path,
    random_square,
    read_fold,
    write_fold,
)
from exactfold.cli import app
from exactfold.commands.shell import Bar
from exactfold.count.solvers import ALIASES
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.families import FAMILIES

PROVED, INVALID, USAGE, BAD_INPUT, UNDECIDED = range(5)

PATTERN_KEYS = {"interior", "boundary", "folds", "degrees_of_freedom", "sha256", "snapped"}
COUNT_KEYS = {
    *("pattern", "status", "method", "distinct", "with_multiplicity", "real", "nonreal"),
    *("true_branches", "certificate", "seconds", "branches"),
}
EXTRA_KEYS = {"reason", "why", "open_questions", "settings", "dimension", "degree"}
BRANCH_KEYS = {"vertex_signs", "assignment", "multiplicity", "representative", "heights"}

CORNERS = [[0, 0], [1, 0], [1, 1], [0, 1], [0.5, 0.25]]
FACES = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]


def run(*arguments):
    return CliRunner().invoke(app, [str(a) for a in arguments])


@pytest.fixture
def two_vertex():
    return example_path("two-vertex")


@pytest.fixture
def certificate(tmp_path, two_vertex):
    path = tmp_path / "two-vertex.json"
    assert run("count", two_vertex, "--certificate", path).exit_code == PROVED
    return path


def written(tmp_path, document):
    path = tmp_path / "bad.fold"
    path.write_text(document if isinstance(document, str) else json.dumps(document))
    return path


# --- count ---------------------------------------------------------------------------------------


def test_count_prints_a_table_and_exits_0(two_vertex):
    result = run("count", two_vertex)
    assert result.exit_code == PROVED
    assert "PROVED" in result.stdout
    assert "4 distinct, 4 with multiplicity; 4 real, 0 not real" in result.stdout
    assert result.stderr == ""


@pytest.mark.parametrize("name", EXAMPLES)
def test_count_json_has_the_documented_keys(name):
    path = example_path(name)
    result = run("count", path, "--json")
    assert result.exit_code == PROVED
    assert result.stdout.count("\n") == 1
    data = json.loads(result.stdout)
    assert COUNT_KEYS <= set(data) <= COUNT_KEYS | EXTRA_KEYS
    assert set(data["pattern"]) == PATTERN_KEYS
    pattern = read_fold(path)
    assert data["pattern"]["sha256"] == pattern.sha256
    assert data["pattern"]["snapped"] == "0"
    assert data["status"] == "proved"
    assert data["true_branches"] in ("proved", "undecided")
    assert data["certificate"] is None
    vectors = []
    for branch in data["branches"]:
        assert set(branch) == BRANCH_KEYS
        assert list(branch["vertex_signs"]) == [str(v) for v in pattern.interior]
        assert set(branch["vertex_signs"].values()) <= {1, -1, 0}
        assert set(branch["assignment"]) == {f"{i}-{j}" for i, j in pattern.folds}
        assert set(branch["assignment"].values()) <= set("MVF")
        assert set(branch["heights"]) == {str(v) for v in range(len(pattern.vertices))}
        assert list(branch["heights"].values()).count(["0", "0"]) >= 3
        vectors.append(list(branch["vertex_signs"].values()))
    assert vectors == sorted(vectors)


def test_count_json_is_exact(two_vertex):
    data = json.loads(run("count", two_vertex, "--json").stdout)
    pattern = read_fold(two_vertex)
    for branch, expected in zip(data["branches"], count_branches(pattern).branches, strict=True):
        for v, ends in branch["heights"].items():
            assert tuple(map(Fraction, ends)) == expected.heights[int(v)]


@pytest.mark.parametrize("method", ["auto", "newton", "nappes", "popping", "homotopy", "groebner"])
def test_methods(two_vertex, method):
    data = json.loads(run("count", two_vertex, "--json", "--method", method).stdout)
    assert data["distinct"] == 4
    assert data["method"] == ("newton" if method in ("auto", "nappes") else method)


def test_rigid_sheet_has_no_branches(tmp_path):
    path = tmp_path / "triangle.fold"
    write_fold(scrambled(1, TRIANGLE, 3), path)
    result = run("count", path, "--json")
    assert result.exit_code == PROVED
    data = json.loads(result.stdout)
    assert (data["distinct"], data["branches"]) == (0, [])


def test_undecided_exits_4(tmp_path):
    path, out = tmp_path / "hexagon.fold", tmp_path / "out.json"
    write_fold(scrambled(1, HEXAGON, 2, loose=True), path)
    result = run("count", path, "--json", "--certificate", out)
    assert result.exit_code == UNDECIDED
    data = json.loads(result.stdout)
    assert data["status"] == "undecided"
    assert data["distinct"] is None
    assert data["certificate"] is None
    assert "D = 3" in data["reason"]
    assert "no certificate was written" in result.stderr
    assert not out.exists()


def test_undecided_table_lists_what_is_open(tmp_path, monkeypatch):
    path = tmp_path / "flat.fold"
    write_fold(FAMILIES["flat-vertex"](), path)
    monkeypatch.setattr("exactfold.count.hand_over.flat_vertices", lambda chart, points: iter(()))
    result = run("count", path, "--method", "popping")
    assert result.exit_code == UNDECIDED
    assert "UNDECIDED" in result.stdout
    assert "Open" in result.stdout
    assert "no box around the candidate" in result.stdout


def test_long_tables_are_cut_unless_all_is_asked_for():
    short = run("count", example_path("random-8")).stdout
    long = run("count", example_path("random-8"), "--all").stdout
    assert "more (--all shows them)" in short
    assert "--all" not in long
    assert len(long.splitlines()) > 256 > len(short.splitlines())


def test_table_tells_of_rigid_vertices_and_the_certificate(tmp_path):
    path, out = tmp_path / "nested.fold", tmp_path / "nested.json"
    write_fold(nested_triangles(), path)
    result = run("count", path, "--certificate", out)
    assert "3 vertices in triangulated triangles stay flat" in result.stdout
    assert "nested.json" in result.stdout.replace("\n", "").replace(" ", "")


def test_snap_records_the_move(tmp_path):
    document = {"vertices_coords": [*CORNERS[:4], [0.5001, 0.25]], "faces_vertices": FACES}
    path = written(tmp_path, document)
    plain = json.loads(run("count", path, "--json").stdout)
    snapped = json.loads(run("count", path, "--json", "--snap", 100).stdout)
    assert plain["pattern"]["snapped"] == "0"
    assert snapped["pattern"]["snapped"] == "1/10000"
    exact = CreasePattern([*CORNERS[:4], ("1/2", "1/4")], FACES)
    assert snapped["pattern"]["sha256"] == exact.sha256 != plain["pattern"]["sha256"]
    assert "moved by up to 0.0001" in run("count", path, "--snap", 100).stdout


@pytest.mark.skipif(not hasattr(signal, "pthread_sigmask"), reason="signals of POSIX")
def test_the_line_of_progress_leaves_interrupts_to_the_main_thread(monkeypatch):
    """Otherwise one that the main thread holds back would be delivered all the same."""
    masks = []

    def masked(self):
        masks.append(signal.pthread_sigmask(signal.SIG_BLOCK, ()))

    monkeypatch.setattr(Bar, "show", masked)
    with Bar("reading", delay=0) as bar:
        bar.timer.join()
    assert masks == [{signal.SIGINT, signal.SIGTERM}]
    assert signal.SIGINT not in signal.pthread_sigmask(signal.SIG_BLOCK, ())


def test_no_progress_off_a_terminal():
    result = run("count", example_path("random-8"), "--json")
    assert result.exit_code == PROVED
    assert result.stderr == ""


# --- certificates --------------------------------------------------------------------------------


@pytest.mark.parametrize("name", EXAMPLES)
def test_certificate_is_written_and_valid(tmp_path, name):
    out = tmp_path / "c.json"
    counted = run("count", example_path(name), "--json", "--certificate", out)
    assert counted.exit_code == PROVED
    assert json.loads(counted.stdout)["certificate"] == str(out)
    checked = run("check", out)
    assert checked.exit_code == PROVED
    assert checked.stdout.startswith("VALID: ")


def test_check_json(certificate):
    data = json.loads(run("check", certificate, "--json").stdout)
    assert data["valid"] is True
    assert data["claims"]["distinct"] == 4


def test_tampered_certificate_is_invalid(tmp_path, certificate):
    document = json.loads(certificate.read_text())
    document["claims"]["distinct"] = 5
    bad = tmp_path / "bad.json"
    bad.write_text(json.dumps(document))
    result = run("check", bad)
    assert result.exit_code == INVALID
    assert result.stdout.startswith("INVALID: claim distinct")
    as_json = run("check", bad, "--json")
    assert as_json.exit_code == INVALID
    assert json.loads(as_json.stdout)["valid"] is False


@pytest.mark.parametrize("keep", [0, 1, 100, -2])
def test_truncated_certificate_is_bad_input(tmp_path, certificate, keep):
    bad = tmp_path / "bad.json"
    bad.write_text(certificate.read_text()[:keep])
    result = run("check", bad)
    assert result.exit_code == BAD_INPUT
    assert "CertificateFormatError" in result.stderr
    assert result.stdout == ""


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
    bad = tmp_path / "bad.json"
    bad.write_text(json.dumps(json.loads(certificate.read_text()) | change))
    result = run("check", bad)
    assert result.exit_code == BAD_INPUT
    assert "CertificateFormatError" in result.stderr
    assert culprit in result.stderr


def test_check_of_undecodable_bytes(tmp_path):
    bad = tmp_path / "bad.json"
    bad.write_bytes(b"\xff\xfe\x00")
    result = run("check", bad)
    assert result.exit_code == BAD_INPUT
    assert "CertificateFormatError" in result.stderr


def test_check_of_a_missing_file(tmp_path):
    result = run("check", tmp_path / "none.json")
    assert result.exit_code == BAD_INPUT
    assert "UnreadableFileError" in result.stderr
    assert "none.json" in result.stderr


@pytest.mark.parametrize("place", ["missing/out.json", "folder", "file/out.json"])
def test_unwritable_certificate(tmp_path, two_vertex, place):
    (tmp_path / "folder").mkdir()
    (tmp_path / "file").write_text("kept")
    before = sorted(p.name for p in tmp_path.rglob("*"))
    result = run("count", two_vertex, "--json", "--certificate", tmp_path / place)
    assert result.exit_code == BAD_INPUT
    assert "UnwritableFileError" in result.stderr
    assert str(tmp_path / place) in result.stderr
    assert result.stdout == ""
    assert sorted(p.name for p in tmp_path.rglob("*")) == before
    assert (tmp_path / "file").read_text() == "kept"


# --- bad input -----------------------------------------------------------------------------------

SQUARE_FOLD = {"vertices_coords": CORNERS, "faces_vertices": FACES}


def with_vertex(k, row):
    rows = json.loads(json.dumps(CORNERS))
    rows[k] = row
    return {**SQUARE_FOLD, "vertices_coords": rows}


def text_with(number):
    return json.dumps(with_vertex(4, ["@", 0.25])).replace('"@"', number)


BAD = {
    "empty": ("", "NotJSONError", ""),
    "not JSON": ("crease pattern", "NotJSONError", ""),
    "cut off": (json.dumps(SQUARE_FOLD)[:-9], "NotJSONError", ""),
    "a list": ("[1, 2]", "NotFoldError", ""),
    "not FOLD": ('{"name": "x"}', "FoldError", ""),
    "no coordinates": ({"faces_vertices": FACES}, "MissingCoordinatesError", "vertices_coords"),
    "empty vertex": (with_vertex(3, []), "MissingCoordinatesError", "vertex 3"),
    "NaN": (text_with("NaN"), "NotANumberError", "vertex 4"),
    "Infinity": (text_with("-Infinity"), "NotANumberError", "vertex 4"),
    "text": (text_with('"left"'), "NotANumberError", "vertex 4"),
    "null": (text_with("null"), "NotANumberError", "vertex 4"),
    "boolean": (text_with("true"), "NotANumberError", "vertex 4"),
    "off the plane": (
        {**SQUARE_FOLD, "vertices_coords": [[*p, int(k == 2)] for k, p in enumerate(CORNERS)]},
        "OffPlaneError",
        "vertex 2",
    ),
    "duplicate": (with_vertex(4, [1, 1]), "DuplicateVertexError", "vertices 2 and 4"),
    "isolated": (
        {**SQUARE_FOLD, "vertices_coords": [*CORNERS, [2, 2]]},
        "IsolatedVertexError",
        "vertex 5",
    ),
    "degenerate": (
        {"vertices_coords": [[0, 0], [1, 0], [2, 0]], "faces_vertices": [[0, 1, 2]]},
        "DegenerateFaceError",
        "face 0",
    ),
    "clockwise mixed": (
        {**SQUARE_FOLD, "faces_vertices": [*FACES[:3], [0, 3, 4]]},
        "MixedOrientationError",
        "face 3",
    ),
    "vertex pulled across": (with_vertex(4, [0.5, -1]), "MixedOrientationError", "face 0"),
    "overlap": (
        {
            "vertices_coords": [[0, 0], [4, 0], [4, 4], [1, 1], [5, 0.5], [2, 4]],
            "faces_vertices": [[0, 1, 3], [1, 2, 3], [3, 4, 5]],
        },
        "Error",
        "3",
    ),
    "edge on three faces": (
        {
            "vertices_coords": [[0, 0], [1, 0], [0, 1], [1, 1], [0.2, 2]],
            "faces_vertices": [[0, 1, 2], [1, 3, 2], [1, 4, 2]],
        },
        "NonManifoldEdgeError",
        "edge 1-2",
    ),
    "two disks": (
        {
            "vertices_coords": [[0, 0], [1, 0], [0, 1], [5, 0], [6, 0], [5, 1]],
            "faces_vertices": [[0, 1, 2], [3, 4, 5]],
        },
        "DisconnectedError",
        "vertex 0 to 3",
    ),
    "hole": (
        {
            "vertices_coords": [[0, 0], [9, 0], [0, 9], [2, 2], [4, 2], [2, 4]],
            "faces_vertices": [
                *([0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3], [2, 3, 5]),
            ],
        },
        "HoleError",
        "vertices 0 and 3",
    ),
    "pinch": (
        {
            "vertices_coords": [[0, 0], [1, 0], [0, 1], [-1, 0], [0, -1]],
            "faces_vertices": [[0, 1, 2], [0, 3, 4]],
        },
        "PinchError",
        "vertex 0",
    ),
    "four sides": (
        {"vertices_coords": CORNERS[:4], "faces_vertices": [[0, 1, 2, 3]]},
        "NonTriangularFaceError",
        "face 0",
    ),
    "nothing to count": (
        {"vertices_coords": CORNERS[:4], "faces_vertices": [[0, 1, 2], [0, 2, 3]]},
        "NoInteriorVertexError",
        "no interior vertex",
    ),
    "no such vertex": (
        {**SQUARE_FOLD, "faces_vertices": [*FACES[:3], [3, 0, 9]]},
        "Error",
        "9",
    ),
}


@pytest.mark.parametrize(("document", "error", "culprit"), BAD.values(), ids=BAD.keys())
def test_bad_input(tmp_path, document, error, culprit):
    path, out = written(tmp_path, document), tmp_path / "out.json"
    result = run("count", path, "--json", "--certificate", out)
    assert result.exit_code == BAD_INPUT
    assert result.stdout == ""
    assert result.stderr.startswith("exactfold: ")
    assert f"{error}: " in result.stderr
    assert culprit in result.stderr
    assert result.stderr.count("\n") == 1
    assert sorted(p.name for p in tmp_path.iterdir()) == ["bad.fold"]
    informed = run("info", path)
    if error != "NoInteriorVertexError":
        assert informed.exit_code == BAD_INPUT
        assert informed.stderr == result.stderr


def test_missing_file(tmp_path):
    for command in ("count", "info"):
        result = run(command, tmp_path / "none.fold")
        assert result.exit_code == BAD_INPUT
        assert "UnreadableFileError" in result.stderr


def test_folder_instead_of_file(tmp_path):
    assert run("count", tmp_path).exit_code == BAD_INPUT


def test_chord_is_counted_right_and_named(tmp_path):
    path = tmp_path / "chord.fold"
    write_fold(with_point(CreasePattern(SQUARE, [(0, 1, 2), (0, 2, 3)]), 0, (1, 1, 1)), path)
    data = json.loads(run("count", path, "--json").stdout)
    assert (data["status"], data["distinct"], data["with_multiplicity"]) == ("proved", 1, 2)
    assert "0-2" in run("info", path).stdout


def test_huge_denominators(tmp_path):
    path = tmp_path / "huge.fold"
    pattern = random_square(2, seed=0)
    moved = [(x + Fraction(k, 10**60), y) for k, (x, y) in enumerate(pattern.vertices)]
    write_fold(CreasePattern(moved, pattern.triangles), path)
    out = tmp_path / "huge.json"
    result = run("count", path, "--json", "--certificate", out)
    assert result.exit_code == PROVED
    assert json.loads(result.stdout)["distinct"] == 4
    assert run("check", out).exit_code == PROVED


# --- usage ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "arguments",
    [
        ["count"],
        ["count", "x.fold", "--method", "guess"],
        ["count", "x.fold", "--snap", "0"],
        ["count", "x.fold", "--snap", "half"],
        ["random", "--interior", "0", "--seed", "1"],
        ["random", "--interior", "3"],
        ["random", "--interior", "3", "--seed", "-1"],
        ["random", "--interior", "9", "--seed", "1", "--denominator", "2"],
        ["check"],
        ["fold", "x.fold"],
    ],
)
def test_wrong_usage_exits_2(arguments):
    result = run(*arguments)
    assert result.exit_code == USAGE
    assert result.stdout == ""
    assert result.stderr != ""


def test_version():
    result = run("--version")
    assert result.exit_code == 0
    assert result.stdout.startswith("exactfold ")


@pytest.mark.parametrize("command", [[], ["count"], ["check"], ["random"], ["info"]])
def test_help(command):
    result = run(*command, "--help")
    assert result.exit_code == 0
    assert "Usage" in result.stdout


# --- random and info -----------------------------------------------------------------------------


def test_random_is_deterministic():
    first, again, other = (
        run("random", "--interior", 5, "--seed", seed).stdout for seed in (3, 3, 4)
    )
    assert first == again != other


def test_random_then_count(tmp_path):
    path = tmp_path / "r.fold"
    result = run("random", "--interior", 4, "--seed", 11, "--denominator", 64, "-o", path)
    assert result.exit_code == 0
    assert result.stdout == ""
    assert read_fold(path) == random_square(4, 11, 64)
    assert run("random", "--interior", 4, "--seed", 11, "--denominator", 64).stdout == (
        path.read_text()
    )
    data = json.loads(run("count", path, "--json").stdout)
    assert data["distinct"] == 16
    assert data["pattern"]["sha256"] == random_square(4, 11, 64).sha256


def test_random_to_an_unwritable_path(tmp_path):
    result = run("random", "--interior", 2, "--seed", 1, "-o", tmp_path / "no" / "r.fold")
    assert result.exit_code == BAD_INPUT
    assert "UnwritableFileError" in result.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", EXAMPLES)
def test_info_agrees_with_count(name):
    data = json.loads(run("info", example_path(name), "--json").stdout)
    counted = json.loads(run("count", example_path(name), "--json").stdout)
    for key in ("interior", "boundary", "folds", "degrees_of_freedom", "sha256"):
        assert data[key] == counted["pattern"][key]
    table = run("info", example_path(name))
    assert table.exit_code == 0
    assert f"{data['interior']} interior, {data['boundary']} boundary" in table.stdout


@pytest.mark.parametrize(
    ("pattern", "expected"),
    [
        (CreasePattern(SQUARE, [(0, 1, 2), (0, 2, 3)]), "nothing to count"),
        (scrambled(1, TRIANGLE, 2), "rigid: 0 branches"),
        (nested_triangles(), "2^6 solutions with multiplicity, 2^3 branches"),
        (FAMILIES["waterbomb"](), "one branch (single vertex)"),
        (scrambled(1, HEXAGON, 2, loose=True), "undecided: branches of dimension 3"),
    ],
)
def test_info_says_what_to_expect(tmp_path, pattern, expected):
    path = tmp_path / "p.fold"
    write_fold(pattern, path)
    assert expected in json.loads(run("info", path, "--json").stdout)["expected"]
    assert run("info", path).exit_code == 0


# --- as a process --------------------------------------------------------------------------------


def process(*arguments, **options):
    command = [sys.executable, "-m", "exactfold", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False, **options)


def test_pipeline_random_count_check(tmp_path):
    made = process("random", "--interior", 3, "--seed", 5)
    (tmp_path / "r.fold").write_text(made.stdout)
    counted = process("count", "r.fold", "--certificate", "c.json", "--json", cwd=tmp_path)
    assert (counted.returncode, counted.stderr) == (PROVED, "")
    assert json.loads(counted.stdout)["certificate"] == "c.json"
    checked = process("check", "c.json", cwd=tmp_path)
    assert (checked.returncode, checked.stderr) == (PROVED, "")


def test_bad_input_of_a_process(tmp_path):
    result = process("count", written(tmp_path, "{}"), "--json")
    assert (result.returncode, result.stdout) == (BAD_INPUT, "")
    assert "Traceback" not in result.stderr


def test_progress_on_a_terminal(monkeypatch):
    """One line for the stage under way, with a total or without."""
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("TERM", "xterm")
    with Bar("reading", delay=3600) as bar:
        bar.show()  # as the timer does
        assert bar.display is not None
        tasks = bar.display.progress.tasks
        assert [task.description for task in tasks] == ["reading"]
        for stage in ("solving", "certifying"):
            for done in range(3):
                bar(stage, done, 2)
        (task,) = bar.display.progress.tasks
        assert (task.description, task.completed, task.total) == ("certifying", 2, 2)
        bar("writing")
        (task,) = bar.display.progress.tasks
        assert (task.description, task.total) == ("writing", None)
        display = bar.display
    assert bar.display is None
    assert display.progress.live.is_started is False


def test_a_stage_that_reports_nothing_is_shown_by_the_timer(monkeypatch):
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("TERM", "xterm")
    with Bar("reading", delay=0) as bar:
        bar.timer.join()
        assert bar.display is not None


def test_no_progress_off_a_terminal_or_after_the_end(monkeypatch):
    with Bar("reading", delay=3600) as bar:
        bar.show()
        assert bar.display is None
    monkeypatch.setenv("FORCE_COLOR", "1")
    bar.show()
    assert bar.display is None


def test_colours_on_a_terminal_only(monkeypatch):
    plain = run("count", example_path("two-vertex")).stdout
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("TERM", "xterm")
    styled = run("count", example_path("two-vertex")).stdout
    assert "\x1b[" in styled
    assert "\x1b[" not in plain


def test_main_runs_the_application(monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["exactfold", "info", str(example_path("two-vertex"))])
    with pytest.raises(SystemExit) as stopped:
        cli.main()
    assert stopped.value.code in (0, None)
    assert "2 interior, 4 boundary" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("error", "said"), [(BrokenPipeError(), ""), (OSError(28, "full"), "full")]
)
def test_output_that_cannot_be_written(monkeypatch, capsys, error, said):
    def failing():
        raise error

    monkeypatch.setattr(cli, "app", failing)
    monkeypatch.setattr(sys, "stdout", sys.stdout)  # `main` replaces it
    with pytest.raises(SystemExit) as stopped:
        cli.main()
    assert stopped.value.code == 74
    assert said in capsys.readouterr().err


@pytest.mark.parametrize("option", ["--help", "--version"])
def test_full_disk(option):
    with open("/dev/full", "w") as full:
        result = subprocess.run(
            [sys.executable, "-m", "exactfold", option],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    assert result.returncode == 74
    assert result.stderr == "exactfold: cannot write the output: No space left on device\n"


def test_one_thread_unless_the_environment_says_otherwise():
    script = (
        "import atexit, os; from exactfold.cli import main\n"
        "atexit.register(lambda: print(os.environ['OPENBLAS_NUM_THREADS']))\n"
        "main()"
    )
    for given, expected in (({}, "1"), ({"OPENBLAS_NUM_THREADS": "3"}, "3")):
        environment = {k: v for k, v in os.environ.items() if k != "OPENBLAS_NUM_THREADS"} | given
        command = [sys.executable, "-c", script, "--version"]
        result = subprocess.run(
            command, capture_output=True, text=True, check=False, env=environment
        )
        assert result.stdout.splitlines()[-1] == expected


def test_closed_standard_output(two_vertex):
    script = "import sys; sys.stdout = None; from exactfold.cli import main; main()"
    command = [sys.executable, "-c", script, "count", str(two_vertex)]
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (result.returncode, result.stderr) == (PROVED, "")


def test_a_name_that_the_terminal_cannot_show(tmp_path, two_vertex):
    environment = {**os.environ, "PYTHONIOENCODING": "ascii"}
    arguments = ["count", two_vertex.absolute(), "--certificate", "z\u00e4hlung.json"]
    result = process(*arguments, env=environment, cwd=tmp_path)
    assert (result.returncode, result.stderr) == (PROVED, "")
    assert "z\\xe4hlung.json" in result.stdout


# --- standard input, pipes, one file for two things ----------------------------------------------


def test_dash_is_standard_input(tmp_path, two_vertex, certificate):
    stream = tmp_path / "stream.txt"
    assert run("count", two_vertex, "--stream", stream).exit_code == PROVED
    told = process("info", "-", input=two_vertex.read_text())
    assert (told.returncode, told.stdout) == (0, run("info", two_vertex).stdout)
    for file in (certificate, stream):
        checked = process("check", "-", input=file.read_text())
        assert (checked.returncode, checked.stdout[:6]) == (PROVED, "VALID:")


@pytest.mark.skipif(not hasattr(socket, "AF_UNIX"), reason="no such sockets here")
def test_what_cannot_be_opened_is_bad_input(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with socket.socket(socket.AF_UNIX) as listener:
        listener.bind("s")
        for command in ("check", "count"):
            result = run(command, "s")
            assert result.exit_code == BAD_INPUT
            assert "UnreadableFileError: cannot read s" in result.stderr


def test_dash_as_an_output(tmp_path, monkeypatch, two_vertex):
    monkeypatch.chdir(tmp_path)
    drawn = run("random", "--interior", 3, "--seed", 1, "-o", "-")
    assert drawn.stdout == run("random", "--interior", 3, "--seed", 1).stdout
    for command in (["count"], ["branch", "--up", "4"]):
        assert run(*command, two_vertex, "--certificate", "-").exit_code == USAGE
    assert run("count", two_vertex, "--stream", "-").exit_code == USAGE
    assert list(tmp_path.iterdir()) == []


def test_an_output_never_replaces_another_file_of_the_command(tmp_path, two_vertex):
    path, link = tmp_path / "p.fold", tmp_path / "link.fold"
    text = two_vertex.read_text()
    path.write_text(text)
    link.symlink_to(path)
    for arguments in (
        ["count", path, "--certificate", path],
        ["count", path, "--certificate", link],
        ["branch", path, "--up", 4, "--certificate", path],
        ["count", path, "--stream", link, "--resume"],
        ["count", path, "--stream", tmp_path / "s.txt", "--certificate", tmp_path / "s.txt"],
    ):
        result = run(*arguments)
        assert result.exit_code == USAGE
        assert "name another file" in result.stderr
        assert path.read_text() == text
    assert not (tmp_path / "s.txt").exists()


def test_only_files_are_streamed_to(two_vertex):
    # A device has no lines to continue, and /dev/full never ends when it is read.
    for device in ("/dev/null", "/dev/full"):
        result = run("count", two_vertex, "--stream", device, "--resume")
        assert result.exit_code == USAGE
        assert "is not a file" in result.stderr


# --- what is loaded ------------------------------------------------------------------------------

HEAVY = ("mpmath", "sympy", "networkx", "scipy", "distributed", "asyncio")


@pytest.mark.parametrize(
    ("arguments", "idle"),
    [
        (["--help"], ("numpy", "flint", "multiprocessing", *HEAVY)),
        (["random", "--interior", "3", "--seed", "1"], ("numpy", "flint", "rich", *HEAVY)),
        (["info"], ("numpy", "multiprocessing", *HEAVY)),
        (["branch", "--up", "4"], ("flint", "multiprocessing", "exactfold.algebra", *HEAVY)),
        (["count"], HEAVY),
    ],
    ids=lambda value: value[0],
)
def test_commands_load_what_they_need(two_vertex, arguments, idle):
    script = (
        "import sys\n"
        "from exactfold.cli import main\n"
        "try: main()\n"
        "except SystemExit as end: code = end.code\n"
        f"print(code, *(m for m in {idle!r} if m in sys.modules), file=sys.stderr)"
    )
    pattern = [] if arguments[0] in ("--help", "random") else [str(two_vertex)]
    command = [sys.executable, "-c", script, *arguments, *pattern]
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    assert result.stderr == "0\n"
    assert result.stdout != ""


def test_public_names():
    assert set(exactfold._HOME) < set(exactfold.__all__) <= set(dir(exactfold))
    for name in exactfold.__all__:
        assert getattr(exactfold, name) is not None
    with pytest.raises(AttributeError, match="no attribute 'brunch'"):
        exactfold.brunch  # noqa: B018


def test_methods_of_the_command_line():
    assert tuple(method.value for method in cli.Method) == (*exactfold.METHODS, *ALIASES)


def test_factors_of_the_branch_polynomial_are_reported(two_vertex):
    result = run("count", two_vertex, "--method", "groebner")
    assert "irreducible over Q of degree 4" in result.stdout
    result = run("count", example_path("flat-vertex"), "--method", "groebner")
    assert "factors of degrees 1 2" in result.stdout
