"""`exactfold view`: where it writes, what it says and refuses; that the server ends cleanly."""

import re
import signal
import subprocess
import sys
from http.client import HTTPConnection
from pathlib import Path

import pytest
from running import BAD_INPUT, USAGE, run

OK = 0


def test_the_page_is_written_beside_the_reader(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = run("view", "single-vertex-4", "--frames", "3", "--workers", "1")
    assert (result.exit_code, result.stderr) == (OK, "")
    assert result.stdout.splitlines() == [
        "2 ways to start folding - PROVED; all real, each counted once, every one",
        "continues to a true motion",
        "wrote single-vertex-4.view.html: 2 branches",
    ]
    assert Path("single-vertex-4.view.html").read_text("utf-8").startswith("<!doctype html>")


@pytest.mark.parametrize("named", [["--signs", "--"], ["--up", ""], ["--way", "1"]])
def test_one_way_alone(named, tmp_path):
    target = tmp_path / "some.html"
    few = ("--frames", "2", "--workers", "1")
    result = run("view", "two-vertex", "-o", target, *named, *few)
    assert result.exit_code == OK
    assert result.stdout.endswith(f"wrote {target}: 1 branch\n")


def test_a_drawing_with_panels_is_shown_by_its_modes(tmp_path):
    target = tmp_path / "panels.html"
    result = run("view", "zigzags", "-o", target, "--frames", "2")
    assert result.exit_code == OK
    assert result.stdout.startswith("3 families of ways to fold")
    assert result.stdout.endswith(
        f"wrote {target}: 3 ways to fold, 1 way not followed (the page says why)\n"
    )
    assert "read zigzags: 12 lines, exact in Q" in result.stderr


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        (["two-vertex", "--branches", "++,+-"], USAGE, "--branches is now --way N"),
        (["two-vertex", "--signs", "+x"], USAGE, "'x' is not a vertex sign"),
        (["two-vertex", "--signs", "+-+"], USAGE, "3 signs for 2 vertices"),
        (["zigzags", "--way", "9"], USAGE, "there is no way 9: `count` lists 1 to 4"),
        (["two-vertex", "--serve"], USAGE, "--serve is now `exactfold serve PATTERN`"),
        (["missing.fold"], BAD_INPUT, "missing.fold"),
        (["two-vertex", "-o", "page.txt"], USAGE, "a page is written as .html, .htm"),
        (["two-vertex", "-o", "no/a.html"], BAD_INPUT, "no/a.html: there is no folder"),
        (
            ["two-vertex", "--frames", "100000"],
            USAGE,
            "a motion in a page needs at least 2 and at most 1000",
        ),
        (["two-vertex", "-o", "-"], USAGE, "give the output file a name"),
    ],
)
def test_what_is_refused(arguments, code, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = run("view", *arguments)
    assert result.exit_code == code
    assert message in result.stderr
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_ctrl_c_ends_the_server():
    command = [sys.executable, "-m", "exactfold", "serve", "two-vertex", "--frames", "2"]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as served:
        line = served.stdout.readline()
        port, path = re.search(r"http://127\.0\.0\.1:(\d+)(/[\w-]+/)", line).groups()
        connection = HTTPConnection("127.0.0.1", int(port), timeout=60)
        connection.request("GET", path)
        assert connection.getresponse().status == 200
        connection.close()
        served.send_signal(signal.SIGINT)
        _, said = served.communicate(timeout=60)
    assert (served.returncode, said) == (OK, "exactfold: the server has ended\n")


@pytest.mark.survey
def test_what_is_written_is_counted_as_count_counts_it(tmp_path):
    """The motion with the letters of the file comes besides the ways that have numbers."""
    target = tmp_path / "bird-base.html"
    result = run("view", "bird-base", "-o", target, "--frames", 2, "--limit", 600)
    assert result.stdout.startswith("16 families of ways to fold")
    said = f"wrote {target}: 16 ways to fold, and the motion with the letters of the file\n"
    assert result.stdout.endswith(said)
