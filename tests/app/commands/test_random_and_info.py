"""`exactfold random` and `exactfold info`."""

import json
from fractions import Fraction

import pytest
from running import (
    BAD_INPUT,
    run,
)
from sheets import HEXAGON, SQUARE, TRIANGLE, nested_triangles, scrambled

from exactfold import random_square
from exactfold.pattern import read_fold, write_fold
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.data import SHEETS, example_path
from exactfold.pattern.families import FAMILIES


def test_random_is_deterministic():
    first, again, other = (
        run("random", "--interior", 5, "--seed", seed).stdout for seed in (3, 3, 4)
    )
    assert first == again != other


def test_random_then_count(tmp_path):
    path = tmp_path / "r.fold"
    result = run("random", "--interior", 4, "--seed", 11, "--denominator", 64, "-o", path)
    assert result.exit_code == 0
    assert result.stdout == f"wrote {path}: 8 vertices, 13 folds, 10 panels\n"
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
    assert "exactfold: cannot write" in result.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", SHEETS)
def test_info_agrees_with_count(name):
    data = json.loads(run("info", example_path(name), "--json").stdout)
    counted = json.loads(run("count", example_path(name), "--json").stdout)
    for key in ("interior", "boundary", "folds", "degrees_of_freedom", "sha256"):
        assert data["pattern"][key] == counted["pattern"][key]
    table = run("info", example_path(name))
    assert table.exit_code == 0
    numbers = data["pattern"]
    assert f"{numbers['interior']} interior, {numbers['boundary']} boundary" in table.stdout


@pytest.mark.parametrize(
    ("pattern", "expected"),
    [
        (CreasePattern(SQUARE, [(0, 1, 2), (0, 2, 3)]), "1 fold from boundary to boundary"),
        (scrambled(1, TRIANGLE, 2), "rigid: 0 ways to start folding"),
        (
            nested_triangles(),
            "2^3 ways to start folding, fewer if a vertex is flat on some of them; with "
            "multiplicity 2^6",
        ),
        (
            FAMILIES["waterbomb"](),
            "one family of ways to start folding, of dimension 3 (single",
        ),
        (
            scrambled(1, HEXAGON, 2, loose=True),
            "2^2 graphs over the boundary heights, of dimension 3, and how they are "
            "joined; as panels: "
            "1 part with vertices that may fold, 1 of them with vertices of more than four folds",
        ),
    ],
)
def test_info_says_what_to_expect(tmp_path, pattern, expected):
    path = tmp_path / "p.fold"
    write_fold(pattern, path)
    assert expected in json.loads(run("info", path, "--json").stdout)["expected"]
    assert run("info", path).exit_code == 0


def test_info_shows_forms_and_digests_when_asked(two_vertex):
    plain, exact = run("info", two_vertex).stdout, run("info", two_vertex, "--exact").stdout
    for words in ("inertia", "self stresses", "rank of rigidity matrix", "sha256"):
        assert words in exact
        assert words not in plain


def test_long_areas_are_decimals_unless_asked_for(tmp_path):
    path = tmp_path / "p.fold"
    corners = [["1/3", 0], [1, "1/1009"], ["10/11", 1], [0, 1]]
    rows = [tuple(map(Fraction, p)) for p in [*corners, ["1/2", "1/2"]]]
    pattern = CreasePattern(rows, [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)])
    write_fold(pattern, path)
    exact = f"{pattern.area.numerator}/{pattern.area.denominator}"
    assert len(exact) > 7
    row = next(line for line in run("info", path).stdout.splitlines() if line.startswith("area"))
    assert row.split()[1:] == ["about", f"{float(pattern.area):.6f}"]
    assert f" {exact}\n" in run("info", path, "--exact").stdout
    assert json.loads(run("info", path, "--json").stdout)["area"] == exact
    assert "about" not in run("info", "two-vertex").stdout


def test_reading_is_one_line_and_v_says_each_step():
    short = run("info", "zigzags").stderr
    assert short == "exactfold: read zigzags: 12 lines, exact in Q, cut at 12 points; -v for more\n"
    long = run("info", "zigzags", "-v").stderr.splitlines()
    assert long[0] == "exactfold: read zigzags: SVG, 12 lines (2 mountain, 6 valley, 4 boundary)"
    assert len(long) > 2
    assert run("info", "zigzags", "--verbose").stderr.splitlines() == long
    assert run("info", "two-vertex").stderr == ""
