"""`exactfold count` of one pattern: exit codes, JSON with exactly the documented keys, tables."""

import json
import re
from collections import Counter
from fractions import Fraction

import pytest
from files import CORNERS, FACES, written
from running import (
    PROVED,
    UNDECIDED,
    USAGE,
    run,
)
from sheets import DENTED, SQUARE, TRIANGLE, nested_triangles, scrambled, with_point

from exactfold import check, random_square
from exactfold.branches import count_branches
from exactfold.pattern import read_fold, write_fold
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.data import SHEETS, example_path
from exactfold.pattern.families import FAMILIES

PATTERN_KEYS = {
    *("name", "interior", "boundary", "folds", "degrees_of_freedom", "sha256", "snapped"),
    *("vertices", "faces"),
}
COUNT_KEYS = {
    *("pattern", "status", "method", "distinct", "with_multiplicity", "real", "nonreal"),
    *("true_branches", "certificate", "warnings", "seconds", "branches", "format", "version", "by"),
}
PANEL_KEYS = {
    *("theory", "rigid", "components", "modes_count", "modes", "flat_folds", "free_folds"),
    *("near_misses", "meant", "as_written", "proposal", "read", "still_folds", "pieces", "letters"),
    *("exceptional_vertices", "freedom", "drawn", "way_list"),
}
EXTRA_KEYS = {
    "ways",
    "reason",
    "why",
    "open_questions",
    "settings",
    "dimension",
    "degree",
    "true_bounds",
}
BRANCH_KEYS = {"vertex_signs", "assignment", "multiplicity", "representative", "heights"}


def test_count_prints_a_table_and_exits_0(two_vertex):
    result = run("count", two_vertex)
    assert result.exit_code == PROVED
    text = " ".join(result.stdout.split())
    assert re.match(
        r"4 ways to start folding - PROVED \(\d+\.\d\d s\); all real, each counted once, every one "
        "continues to a true motion way vertex 4 5 folds 1 down down VVVVVVM 2 down up VVMMVVM",
        text,
    )
    for word in ("Bezout", "nappe", "chart", "sha256", "distinct", "sign vector"):
        assert word not in text
    assert result.stderr == ""


def test_verbose_also_says_how(two_vertex):
    text = " ".join(run("count", two_vertex, "--verbose").stdout.split())
    for words in (
        "by refined Bezout there are no others",
        "4 distinct, 4 with multiplicity; 4 real, 0 not real",
        "2 pairs of opposite ones, 2 branches each",
        "method Newton, one start per sign vector",
        read_fold(two_vertex).sha256,
    ):
        assert words in text
    assert "nappe" not in text


@pytest.mark.parametrize(
    ("pattern", "said"),
    [
        (scrambled(1, TRIANGLE, 3), r"0 ways to start folding - PROVED \(.*\); the sheet is rigid"),
        (
            with_point(CreasePattern(SQUARE, [(0, 1, 2), (0, 2, 3)]), 0, (1, 1, 1)),
            r"1 way to start folding - PROVED \(.*\); it is real, 2 with multiplicity, as flat "
            "vertices count double, it continues to a true motion",
        ),
        (
            FAMILIES["waterbomb"](),
            r"1 family of ways to fold, of dimension 3 - PROVED \(.*\); the dimension is the "
            "number of folds that can be folded independently",
        ),
        (
            FAMILIES["flat-vertex"](),
            r"3 ways to start folding - PROVED \(.*\); all real, 4 with multiplicity, as flat "
            "vertices count double, every one continues to a true motion",
        ),
        (
            scrambled(2, DENTED, 4, loose=True),
            r"the number of ways to fold is UNDECIDED \(.*\): the part of 4 vertices with "
            "vertex 6: ",
        ),
    ],
    ids=["none", "one", "infinitely many", "flat", "undecided"],
)
@pytest.mark.usefixtures("without_spaces")
def test_the_answer_in_plain_words(tmp_path, pattern, said):
    path = tmp_path / "p.fold"
    write_fold(pattern, path)
    for more in ((), ("--verbose",)):
        assert re.match(said, " ".join(run("count", path, *more).stdout.split()))


def test_one_way_has_no_plural(tmp_path):
    path = tmp_path / "p.fold"
    write_fold(with_point(CreasePattern(SQUARE, [(0, 1, 2), (0, 2, 3)]), 0, (1, 1, 1)), path)
    text = run("count", path, "--verbose").stdout + run("info", path, "--exact").stdout
    assert not re.search(
        r"(?<![\d.-])1 (\w+ )?(pairs|vertices|branches|solutions|ways|folds)", text
    )


def test_many_vertices_are_listed_and_not_in_columns(tmp_path):
    path = tmp_path / "p.fold"
    write_fold(random_square(9, seed=1), path)
    head, first, second = run("count", path).stdout.splitlines()[3:6]
    assert head.split() == ["way", "vertices", "up", "folds"]
    assert first.split()[:2] == ["1", "none"]
    assert second.split()[:2] == ["2", str(read_fold(path).interior[-1])]


@pytest.mark.parametrize("name", SHEETS)
def test_count_json_has_the_documented_keys(name):
    path = example_path(name)
    result = run("count", path, "--json")
    assert result.exit_code == PROVED
    assert result.stdout.count("\n") == 1
    data = json.loads(result.stdout)
    assert COUNT_KEYS | PANEL_KEYS <= set(data) <= COUNT_KEYS | PANEL_KEYS | EXTRA_KEYS
    assert data["theory"] == "branches"
    assert (data["components"], data["modes_count"], data["read"]) == (None, None, None)
    assert data["modes"] == data["flat_folds"] == data["free_folds"] == data["near_misses"] == []
    assert set(data["pattern"]) == PATTERN_KEYS
    pattern = read_fold(path)
    assert data["pattern"]["sha256"] == pattern.sha256
    assert data["pattern"]["snapped"] == "0"
    assert data["status"] == "proved"
    assert data["true_branches"] == "proved"
    if data["pieces"] is None:
        assert data["true_bounds"] == [data["distinct"]] * 2
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


@pytest.mark.parametrize("method", ["auto", "nappes", "newton", "popping", "homotopy", "groebner"])
def test_methods(two_vertex, method):
    data = json.loads(run("count", two_vertex, "--json", "--method", method).stdout)
    assert data["distinct"] == 4
    assert data["method"] == {"auto": "newton", "nappes": "newton"}.get(method, method)


def test_rigid_sheet_has_no_branches(tmp_path):
    path = tmp_path / "triangle.fold"
    write_fold(scrambled(1, TRIANGLE, 3), path)
    result = run("count", path, "--json")
    assert result.exit_code == PROVED
    data = json.loads(result.stdout)
    assert (data["distinct"], data["branches"]) == (0, [])


@pytest.mark.usefixtures("without_spaces")
def test_undecided_exits_4(tmp_path):
    path, out = tmp_path / "dented.fold", tmp_path / "out.json"
    write_fold(scrambled(2, DENTED, 4, loose=True), path)
    result = run("count", path, "--json", "--certificate", out)
    assert result.exit_code == UNDECIDED
    data = json.loads(result.stdout)
    assert data["status"] == "undecided"
    assert data["distinct"] is None
    assert data["certificate"] == str(out)
    bounds, claims = data["freedom"], check(out).claims
    assert claims["least"] <= bounds["least"] <= bounds["most"] <= claims["most"]
    assert "the certificate proves bounds of the degrees of freedom only" in result.stderr
    assert data["theory"] == "subspaces"
    found = {"found": {"3": 2}, "found_true": {"3": 2}}
    assert data["components"] == {"second_order": None, "true": None, **found, "graphs": None}
    assert data["reason"].startswith("the part of 4 vertices with vertex 6: ")
    assert "and a reflex corner, vertex 3: for such a sheet" in data["reason"]


def test_undecided_table_lists_what_is_open(tmp_path, monkeypatch):
    path = tmp_path / "flat.fold"
    write_fold(FAMILIES["flat-vertex"](), path)
    monkeypatch.setattr(
        "exactfold.branches.counting.in_chart.flat_vertices", lambda chart, points: iter(())
    )
    result = run("count", path, "--method", "popping")
    assert result.exit_code == UNDECIDED
    assert "UNDECIDED" in result.stdout
    assert "Open" in result.stdout
    assert "no box around the candidate" in result.stdout


@pytest.mark.slow
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


def test_factors_of_the_branch_polynomial_are_reported(two_vertex):
    result = run("count", two_vertex, "--method", "groebner", "--verbose")
    assert "irreducible over Q of degree 4" in result.stdout
    result = run("count", example_path("flat-vertex"), "--method", "groebner", "--verbose")
    assert "factors of degrees 1 2" in result.stdout


BOXES = {
    "file_spec": 1.1,
    "vertices_coords": [[i, j] for i in range(6) for j in range(6)],
    "edges_vertices": [
        *([6 * i + j, 6 * i + j + 6] for i in range(5) for j in range(6)),
        *([6 * i + j, 6 * i + j + 1] for i in range(6) for j in range(5)),
        *([6 * i + j, 6 * i + j + 7] for i in range(5) for j in range(5) if (i + 2 * j) % 3 == 0),
    ],
}
BOXES["edges_assignment"] = [
    "B" if any({i // 6, j // 6} == {k} or {i % 6, j % 6} == {k} for k in (0, 5)) else "V"
    for i, j in BOXES["edges_vertices"]
]


def test_what_is_proved_of_a_large_drawing_is_printed_in_time(tmp_path):
    path = tmp_path / "boxes.fold"
    path.write_text(json.dumps(BOXES))
    result = run("count", path, "--limit", "1e-6")
    assert result.exit_code == UNDECIDED
    text = " ".join(result.stdout.split())
    assert "the time limit, 6.75e-07 of 1e-06 seconds (--limit), was used up" in text
    assert "degrees of freedom: between 3 and 12 - PROVED" in text
    assert text.count("dimension 17") == 1
    assert (
        "it does not start to fold with the drawn mountains and valleys, with rigid panels that "
        "all move together - PROVED: the folds of "
        "vertex "
    ) in text
    assert "see `exactfold match`" not in text


@pytest.mark.parametrize("limit", ["0", "-1", "nan", "soon"])
def test_a_limit_is_a_positive_number_of_seconds(tmp_path, limit):
    path = tmp_path / "boxes.fold"
    path.write_text(json.dumps(BOXES))
    for command in ("count", "match"):
        result = run(command, path, "--limit", limit)
        assert result.exit_code == USAGE
        assert "seconds" in " ".join(result.stderr.split())


@pytest.mark.parametrize("name", ["miura", "bird-base", "flapping-bird"])
def test_the_ways_of_panels_are_in_the_json_with_the_numbers_and_letters_of_the_table(name):
    """Modes, spaces, and lines of motions beside them: each row of the table stands in the JSON."""
    data = json.loads(run("count", name, "--json").stdout)
    table = run("count", name, "--all").stdout
    rows = re.findall(r"^ *(\d+) +(?:\d+ +)?([MVFU]{8,}) +yes", table, re.MULTILINE)
    assert len(rows) == data["ways"] == len(data["way_list"])
    for (number, letters), way in zip(rows, data["way_list"], strict=True):
        assert way["number"] == int(number)
        assert "".join(way["assignment"].values()) == letters
        assert way["extends"] == "proved"
    dimensions = Counter(str(way["dimension"]) for way in data["way_list"])
    assert dimensions == data["components"]["second_order"]
