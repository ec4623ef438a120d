"""Files that ask for too much, in every command; names of files with escape sequences."""

import io
import json
import shutil
from pathlib import Path

import pytest
from rich.text import Text
from running import BAD_INPUT, PROVED, error_class, process, run

from exactfold._support.plurals import visible
from exactfold.app.report.terminal import _Console

LINE = '<line x2="1" y2="1" stroke="red"/>'
SVG = '<svg xmlns="http://www.w3.org/2000/svg">{}</svg>'
SQUARE = (
    '{{"vertices_coords": [[0, 0], [{0}, 0], [{0}, {0}], [0, {0}], [0.5, 0.25]], '
    '"faces_vertices": [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]}}'
)
FILES = {
    "circle.svg": SVG.format(f'<g id="a">{LINE}<use href="#a"/></g>'),
    "deep.svg": SVG.format("<g>" * 990 + LINE + "</g>" * 990),
    "bomb.svg": SVG.format(
        f'<g id="l0">{LINE}</g>'
        + "".join(f'<g id="l{k}">' + f'<use href="#l{k - 1}"/>' * 10 + "</g>" for k in range(1, 12))
    ),
    "transform.svg": SVG.format(f'<g transform="{"translate(" * 20000}">{LINE}</g>'),
    "long.fold": SQUARE.format("1" * 100_000),
    "longer.fold": SQUARE.format("1" * 2_000_000),
    "exponent.fold": SQUARE.format("1e-15000"),
    "huge.cp": "1 0 0 1e308 0\n1 1e308 0 0 1e308\n1 0 1e308 0 0\n",
    "crossing.cp": "\n".join(f"2 {k} 0 {k} 500\n3 0 {k} 500 {k}" for k in range(1, 500)),
}
COMMANDS = {
    "count": [],
    "info": [],
    "draw": ["-o", "out.svg"],
    "convert": ["out.fold"],
    "match": ["--letters", "MMMV"],
    "fold": ["--signs", "+"],
    "branch": ["--signs", "+"],
    "export": ["--signs", "+", "-o", "out.fold"],
    "motions": [],
    "actuate": ["--signs", "+"],
    "tolerance": [],
    "design": ["--maximise", "tolerance"],
    "assignments": [],
    "view": ["-o", "out.html"],
}


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name, text in FILES.items():
        Path(name).write_text(text)
    return tmp_path


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_refuses_them_with_one_sentence(here, command):
    before = sorted(here.iterdir())
    for name in FILES:
        done = run(command, name, *COMMANDS[command])
        assert done.exit_code == BAD_INPUT, (name, done.output)
        assert done.stderr.startswith(f"exactfold: {name}: ")
        assert done.stderr.count("\n") == 1
        assert done.stdout == ""
    assert sorted(here.iterdir()) == before


def test_the_class_of_their_errors(here):
    for name, error in (("bomb.svg", "TooLargeError"), ("long.fold", "NumberError")):
        assert error_class(run("count", name, "--json")) == error


def test_heights_of_many_digits(here):
    Path("pentagon.fold").write_text(
        json.dumps(
            {
                "vertices_coords": [[0, 0], [4, 0], [5, 3], [2, 5], [-1, 3], [2, 2]],
                "faces_vertices": [[0, 1, 5], [1, 2, 5], [2, 3, 5], [3, 4, 5], [4, 0, 5]],
            }
        )
    )
    for number in ("1" * 70_000, "0." + "1" * 70_000, "1e30000"):
        Path("rim.json").write_text(f'{{"0": 0, "1": 0, "2": {number}, "3": 0, "4": 1}}')
        done = run("branch", "pentagon.fold", "--signs", "+", "--boundary-heights", "rim.json")
        assert done.exit_code == BAD_INPUT, done.output
        assert "rim.json: " in done.stderr
        assert len(done.stderr.splitlines()) == 1


NAME = "a\x1b[2J\x1b]0;b\x07\x9bc.fold"
SHOWN = r"a\x1b[2J\x1b]0;b\x07\x9bc.fold"


def test_names_do_not_steer_the_terminal(tmp_path, monkeypatch, two_vertex):
    monkeypatch.chdir(tmp_path)
    shutil.copy(two_vertex, NAME)
    for arguments, said in (
        (["info", NAME + "x"], SHOWN + "x"),
        (["convert", NAME, "2" + NAME], "wrote 2" + SHOWN),
        (["draw", NAME, "-o", "\x1b[31m.svg"], r"wrote \x1b[31m.svg"),
        (["count", NAME, "two-vertex"], r"a\x1b[2J\x1b]"),
        (["match", NAME], SHOWN),
    ):
        done = run(*arguments)
        assert said in done.output
        assert not set("\x1b\x07\x9b") & set(done.output)


def test_names_in_json_are_as_they_are(tmp_path, monkeypatch, two_vertex):
    monkeypatch.chdir(tmp_path)
    shutil.copy(two_vertex, NAME)
    done = run("info", NAME, "--json")
    assert done.exit_code == PROVED
    assert json.loads(done.stdout)["pattern"]["name"] == NAME
    assert "\x1b" not in done.stdout


@pytest.mark.slow
def test_names_that_are_no_text(tmp_path, two_vertex):
    """Bytes that are not UTF-8 in the name of a file."""
    shutil.copy(two_vertex, tmp_path / "b\udcff.fold")
    for arguments in (["count"], ["view", "-o", "out.html"]):
        done = process(arguments[0], "b\udcff.fold", *arguments[1:], cwd=tmp_path)
        assert (done.returncode, done.stderr) == (PROVED, "")


def test_a_terminal_gets_colours_and_no_other_escapes():
    out = _Console(file=io.StringIO(), force_terminal=True, color_system="standard")
    out.print(Text("a\x1b[2J\nb", "red"))
    assert out.file.getvalue() == "\x1b[31ma\\x1b[2J\x1b[0m\n\x1b[31mb\x1b[0m\n"


def test_what_is_visible_stays():
    assert visible("Käse 線\n√2") == "Käse 線\n√2"
    assert visible("\x00\t\r\x1b\x7f\x9b\u202e\udcff") == r"\x00\t\r\x1b\x7f\x9b\u202e\udcff"
