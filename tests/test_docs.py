"""Every console example in README and docs is run and its output compared."""

import os
import re
import runpy
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]


def examples(page: Path) -> list[tuple[str, str]]:
    """(command, expected output) of each `$` line in the page's console blocks."""
    found = []
    for block in re.findall(r"```console\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL):
        for part in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
            command, _, output = part.partition("\n")
            found.append((command, output))
    return found


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_console_examples_print_what_is_shown(page: Path, tmp_path: Path) -> None:
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "COLUMNS": "80"}
    for command, expected in examples(page):
        words = shlex.split(command)
        assert words[0] == "exactfold"
        run = subprocess.run(
            [sys.executable, "-c", "from exactfold.cli import main; main()", *words[1:]],
            cwd=tmp_path,
            env=environment,
            capture_output=True,
            text=True,
            check=False,
        )
        pattern = re.escape(expected.rstrip()).replace(re.escape("..."), r"\S+")
        assert re.fullmatch(pattern, run.stdout.rstrip()), f"{command}\n{run.stdout}{run.stderr}"


def commands(page: Path) -> list[str]:
    """The commands of a page in their order: `$` lines of console blocks, first cells of tables."""
    text = page.read_text(encoding="utf-8")
    return [a or b for a, b in re.findall(r"(?m)^(?:\$ (.*)|\| `(exactfold [^`]*)` \|.*)$", text)]


@pytest.mark.parametrize("name", ["README.md", "docs/tutorial.md"])
def test_all_commands_run_as_printed_in_their_order(name: str, tmp_path: Path) -> None:
    """In an empty directory and a shell that finds `exactfold`, as after the first command."""
    program = tmp_path / "bin" / "exactfold"
    program.parent.mkdir()
    program.write_text(f'#!/bin/sh\nexec {sys.executable} -m exactfold "$@"\n')
    program.chmod(0o755)
    place = tmp_path / "empty"
    place.mkdir()
    path = f"{program.parent}{os.pathsep}{os.environ['PATH']}"
    found = commands(ROOT / name)
    assert len(found) > 2
    for command in found:
        done = subprocess.run(
            command,
            shell=True,
            cwd=place,
            env={**os.environ, "PYTHONPATH": str(ROOT), "PATH": path},
            capture_output=True,
            text=True,
            check=False,
        )
        assert (done.returncode, done.stderr) == (0, ""), command
        assert done.stdout or "-o" in command


def test_the_first_commands_of_the_readme_leave_exactfold_where_a_shell_finds_it() -> None:
    first = re.findall(
        r"(?m)^python3 -m venv .*$", (ROOT / "README.md").read_text(encoding="utf-8")
    )
    assert len(first) == 2
    assert all(". .venv/bin/activate && pip install" in line for line in first)
    assert first[0].endswith("&& exactfold count random-8")


def test_examples_are_found() -> None:
    assert sum(len(examples(page)) for page in PAGES) >= 4


def test_statements_and_errata_are_up_to_date() -> None:
    folder = ROOT / "docs"
    pages = runpy.run_path(str(folder / "make_statements.py"))["pages"]()
    assert sorted(pages) == ["errata.md", "statements.md"]
    for name, text in pages.items():
        assert (folder / name).read_text(encoding="utf-8") == text


def test_reference_is_up_to_date() -> None:
    page = ROOT / "docs" / "make_reference.py"
    names = runpy.run_path(str(page))
    assert names["PAGE"].read_text(encoding="utf-8") == names["reference"]()
