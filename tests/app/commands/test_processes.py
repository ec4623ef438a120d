"""Usage, processes, standard input and output, pipes, one file for two things."""

import json
import os
import re
import socket
import subprocess
import sys

import pytest
from files import written
from running import BAD_INPUT, PROVED, USAGE, error_class, process, run

from exactfold.app import cli
from exactfold.pattern.data import example_path


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
        ["xyz", "x.fold"],
    ],
)
def test_wrong_usage_exits_2(arguments):
    result = run(*arguments)
    assert result.exit_code == USAGE
    assert result.stdout == ""
    assert result.stderr != ""


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (
            ["count", "x", "--method", "nope"],
            "--method: 'nope' is not one of auto, newton, popping, homotopy, groebner",
        ),
        (["random", "--interior", "3", "--seed", "abc"], "--seed: 'abc' is not a whole number"),
        (["random", "--interior", "1_0"], "--interior: '1_0' is not a whole number"),
        (["count", "x", "--seed", "-1"], "--seed: -1 is less than 0"),
        (["count", "x", "--jobs", "0"], "--jobs: 0 is less than 1"),
        (["export", "x", "--amount", "wide"], "--amount: 'wide' is not a number"),
        (["count"], "missing argument 'PATTERN'"),
        (["xyz"], "no such command 'xyz'"),
    ],
)
def test_wrong_usage_is_one_plain_line(arguments, said):
    result = run(*arguments)
    assert result.exit_code == USAGE
    assert re.fullmatch(rf"exactfold: {re.escape(said)}; see [a-z -]+ --help\n", result.stderr)


def test_without_arguments_the_help_is_shown():
    result = run()
    assert result.exit_code == USAGE
    assert "Usage" in result.stdout + result.stderr
    assert "exactfold: " not in result.stderr


def test_version():
    result = run("--version")
    assert result.exit_code == 0
    assert result.stdout.startswith("exactfold ")


@pytest.mark.parametrize("command", [[], ["count"], ["check"], ["random"], ["info"]])
def test_help(command):
    result = run(*command, "--help")
    assert result.exit_code == 0
    assert "Usage" in result.stdout


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
    assert (result.returncode, error_class(result)) == (BAD_INPUT, "NotFoldError")
    assert "Traceback" not in result.stderr


def test_main_runs_the_application(monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["exactfold", "info", str(example_path("two-vertex"))])
    with pytest.raises(SystemExit) as stopped:
        cli.main()
    assert stopped.value.code == 0
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
        "import atexit, os; from exactfold.app.cli import main\n"
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


def test_a_name_that_the_terminal_cannot_show(tmp_path, two_vertex):
    environment = {**os.environ, "PYTHONIOENCODING": "ascii"}
    arguments = ["count", two_vertex.absolute(), "--certificate", "z\u00e4hlung.json"]
    result = process(*arguments, env=environment, cwd=tmp_path)
    assert (result.returncode, result.stderr) == (PROVED, "")
    assert "z\\xe4hlung.json" in result.stdout


@pytest.mark.slow
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
            assert "exactfold: cannot read s" in result.stderr


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
