"""Shipped patterns by name, what the shell completes, and what the help shows of flags."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from rich.text import Text
from running import BAD_INPUT, PROVED, run
from typer.main import get_command

from exactfold.app.cli import TAGLINE, app
from exactfold.app.shell.usage import PANELS
from exactfold.branches import METHODS
from exactfold.pattern.data import EXAMPLES, example_path

ROOT = Path(__file__).parents[3]
COMMANDS = ("count", "check", "branch", "export", "actuate", "random", "info", "examples")


@pytest.mark.parametrize("command", [[], *([name] for name in COMMANDS)])
def test_flags_are_shown_without_a_value(command: list[str]) -> None:
    text = run(*command, "--help").stdout
    assert "--help" in text
    assert "bool" not in text
    assert "--no-" not in text
    assert not re.search(r"[{<\[](PATTERN|CERTIFICATE|list|path|certificate)\b", text)


@pytest.mark.parametrize(
    ("command", "usage"), [("count", "PATTERN..."), ("info", "PATTERN"), ("check", "CERTIFICATE")]
)
def test_arguments_in_the_usage_line(command: str, usage: str) -> None:
    shown = run(command, "--help").stdout
    assert re.match(rf"Usage: [\w -]+ {command} \[OPTIONS\] {re.escape(usage)}\n", shown)


def test_examples_are_listed_with_a_line_each() -> None:
    text = run("examples").stdout
    assert all(name in text for name in EXAMPLES)
    assert "exactfold count two-vertex" in text
    rows = json.loads(run("examples", "--json").stdout)["examples"]
    assert [row["name"] for row in rows] == list(EXAMPLES)
    for row in rows:
        assert Path(row["path"]) == example_path(row["name"])
        assert row["description"].endswith(".")


def test_names_stand_for_files_in_every_directory(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for command in (["count"], ["info"], ["branch", "--up", "4"], ["count", "--stream", "s.txt"]):
        result = run(*command, "two-vertex", "--json")
        assert result.exit_code == PROVED
        assert json.loads(result.stdout)["pattern"]["name"] == "two-vertex"
    many = run("count", "two-vertex", "flat-vertex", "--jobs", 1, "--json")
    assert [json.loads(line)["name"] for line in many.stdout.splitlines()] == [
        "two-vertex",
        "flat-vertex",
    ]


def test_a_name_means_the_same_wherever_it_is_used(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As for `load`: the example, whatever files there are; ./two-vertex is a file."""
    monkeypatch.chdir(tmp_path)
    Path("two-vertex").mkdir()
    assert json.loads(run("count", "two-vertex", "--json").stdout)["distinct"] == 4
    Path("two-vertex").rmdir()
    shutil.copy(example_path("flat-vertex"), "two-vertex")
    assert json.loads(run("count", "two-vertex", "--json").stdout)["distinct"] == 4
    copied = tmp_path / "two-vertex"
    assert json.loads(run("count", copied, "--json").stdout)["distinct"] == 3


def test_a_name_that_is_neither_gets_the_names() -> None:
    for command in (["count"], ["info"], ["branch", "--up", "4"], ["count", "two-vertex"]):
        result = run(*command, "two-vertx")
        assert result.exit_code == BAD_INPUT
        said = " ".join((result.stderr + result.stdout).split())
        assert "two-vertx is neither a file nor a shipped pattern" in said
        assert "shipped pattern: did you mean two-vertex" in said
        assert "zigzags" not in said
    said = run("count", "crane").stderr
    assert all(name in said for name in EXAMPLES)
    assert "No such file" in run("count", "x.fold").stderr
    assert "No such file" in run("count", "folder/two-vertex").stderr


def completed(line: str, folder: Path) -> list[str]:
    words = line.split()
    environment = {
        **os.environ,
        "_EXACTFOLD_COMPLETE": "complete_bash",
        "COMP_WORDS": line,
        "COMP_CWORD": str(len(words) - (not line.endswith(" "))),
    }
    script = "from exactfold.app.cli import app; app(prog_name='exactfold')"
    done = subprocess.run(
        [sys.executable, "-c", script],
        env=environment,
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.stderr == ""
    return done.stdout.split()


@pytest.mark.slow
def test_the_shell_completes_names_files_and_methods(tmp_path: Path) -> None:
    (tmp_path / "two.fold").touch()
    (tmp_path / "two.txt").touch()
    (tmp_path / "twofold").mkdir()
    (tmp_path / "twofold" / "a.fold").touch()
    assert completed("exactfold count two", tmp_path) == ["two-vertex", "two.fold", "twofold/"]
    assert completed("exactfold info twofold/", tmp_path) == ["twofold/a.fold"]
    assert completed("exactfold count none/", tmp_path) == []
    assert set(completed("exactfold info ", tmp_path)) >= {*EXAMPLES, "two.fold"}
    assert completed("exactfold count --method ho", tmp_path) == ["homotopy"]
    assert completed("exactfold count --method ", tmp_path) == list(METHODS)
    assert completed("exactfold count --method n", tmp_path) == ["newton"]  # not a former name
    assert set(completed("exactfold ex", tmp_path)) == {"examples", "export"}
    assert completed("exactfold study table1 --sizes ", tmp_path) == ["2-8"]
    by_size = "2:100,3:5000,4-6:1000,7:300,8:50"
    assert completed("exactfold study table1 --number ", tmp_path) == [by_size]
    assert completed("exactfold study --number ", tmp_path) == []


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_a_script_for_every_shell(shell: str) -> None:
    environment = {**os.environ, "_EXACTFOLD_COMPLETE": f"source_{shell}"}
    script = "from exactfold.app.cli import app; app(prog_name='exactfold')"
    done = subprocess.run(
        [sys.executable, "-c", script], env=environment, capture_output=True, text=True, check=False
    )
    assert "_EXACTFOLD_COMPLETE=complete_" in done.stdout


def test_misspelt_commands_and_options_get_the_near_ones() -> None:
    assert run("cuont", "miura").stderr.startswith(
        "exactfold: no such command 'cuont': did you mean count or convert?; see "
    )
    said = run("count", "miura", "--limt", "3").stderr
    assert said.startswith("exactfold: no such option: --limt: did you mean --limit")


def test_the_help_has_groups_and_a_short_name() -> None:
    helped = run("-h")
    assert (helped.exit_code, helped.stdout) == (PROVED, run("--help").stdout)
    assert " ".join(TAGLINE.split()) in " ".join(helped.stdout.split())
    places = [helped.stdout.index(f"\n{panel}:\n") for panel in PANELS]
    assert places == sorted(places)
    assert "Commands" not in helped.stdout
    assert TAGLINE.split("? ")[0] in (ROOT / "README.md").read_text(encoding="utf-8")
    for name in ("count", "check", "random", "examples"):
        assert run(name, "-h").stdout == run(name, "--help").stdout != ""
    text = run("match", "-h").stdout
    headings = ["\nArguments:\n", "\nOptions:\n", "\nHow a drawing is read:\n", "--colours"]
    assert sorted(headings, key=text.index) == headings


def test_no_help_loses_words_in_brackets() -> None:
    """Rich takes words in brackets for a style and leaves them out."""
    for command in get_command(app).commands.values():
        for parameter in command.params:
            text = getattr(parameter, "help", None) or ""
            assert Text.from_markup(text).plain == text, f"{command.name} {parameter.name}"
