"""`exactfold draw`: which picture, where it goes, and what is said."""

import importlib.util
import json
import sys
from xml.etree import ElementTree

import pytest
from running import PROVED, UNDECIDED, USAGE, run

from exactfold.app.commands import draw
from exactfold.app.pictures.folded import Amount, folded
from exactfold.app.report import branch_way, panel_way, pattern_picture, sheet_of_multiples, ways_of
from exactfold.branches import count_ways, find_branch
from exactfold.motion import follow, follow_panels, panel_ways
from exactfold.pattern import load, open_pattern
from exactfold.pattern.data import example_path

NAME = "{http://www.w3.org/2000/svg}"
HOLE = """<svg xmlns="http://www.w3.org/2000/svg" width="60" height="60">
<path stroke="black" fill="none" d="M0 0L60 0L60 60L0 60Z"/>
<path stroke="black" fill="none" d="M20 20L40 20L40 40L20 40Z"/>
<path stroke="red" d="M0 0L20 20M60 0L40 20M60 60L40 40M0 60L20 40"/></svg>"""


def drawn(*arguments):
    result = run("draw", *arguments)
    assert result.exit_code == PROVED, result.stderr
    return result.stdout


def title(text):
    return ElementTree.fromstring(text).find(f"{NAME}title").text


def test_without_a_way_the_letters_of_the_file_are_drawn():
    opened = open_pattern(example_path("zigzags"))
    text = drawn("zigzags")
    assert text == pattern_picture(opened.sheet, opened.assignment, title="zigzags")
    assert (text.count('class="M"'), text.count('class="V"')) == (6, 6)


@pytest.mark.parametrize("which", [("--signs", "-+"), ("--up", "5"), ("--letters", "VVMMVVM")])
def test_a_branch_by_its_signs(which):
    expected = branch_way(find_branch("two-vertex", "-+")).picture("two-vertex")
    assert drawn("two-vertex", *which) == expected


def test_a_branch_by_signs_in_a_file(tmp_path):
    (tmp_path / "signs").write_text("-+\n")
    assert drawn("two-vertex", "--signs", f"@{tmp_path / 'signs'}") == drawn(
        "two-vertex", "--signs", "-+"
    )


def test_a_branch_by_its_number():
    branch = count_ways("two-vertex").branches[2]
    assert drawn("two-vertex", "--way", 3) == branch_way(branch, 3).picture("two-vertex")
    assert title(drawn("two-vertex", "--way", 3)) == "two-vertex, branch 3: +-"


def test_a_way_of_panels_by_its_number():
    counted = count_ways("zigzags")
    ways = panel_ways(counted)
    text = drawn("zigzags", "--way", 2)
    assert text == panel_way(ways[1], counted.pattern).picture("zigzags")
    assert title(text) == "zigzags, way 2"
    assert title(drawn("zigzags", "--way", 3)) == "zigzags, way 3, a family of dimension 2"
    other = run("draw", "zigzags", "--way", 4)
    assert other.exit_code == 1  # refuted
    assert "way 4 does not truly fold" in other.stderr
    assert title(other.stdout) == "zigzags, way 4, does not truly fold"


def test_letters_choose_the_side_of_each_mode_of_a_family():
    ways = panel_ways(count_ways("zigzags"))
    first, second = ways[2].modes
    letters = dict.fromkeys(first.pattern.folds, "F")
    letters |= first.letters
    letters |= {fold: "M" if x == "V" else "V" for fold, x in second.letters.items()}
    asked = "".join(letters[fold] for fold in first.pattern.folds)
    one = run("fold", "zigzags", "--letters", asked, "--json")
    data = json.loads(one.stdout)
    assert (data["way"], data["modes"]) == (3, [first.number, second.number])
    assert "".join(data["assignment"][f"{i}-{j}"] for i, j in first.pattern.folds) == asked
    both = drawn("zigzags", "--letters", asked)
    assert both.count('class="M"') == sum(letter == "M" for letter in asked)


def test_all_ways_as_they_are_counted():
    result = count_ways("two-vertex")
    text = drawn("two-vertex", "--all")
    assert text == sheet_of_multiples(
        ways_of(result), "two-vertex: 4 ways to start folding, proved"
    )
    assert title(drawn("zigzags", "--all")) == "zigzags: 4 ways, 3 of them known to truly fold"


def test_many_ways_are_cut_with_a_word():
    result = run("draw", "flat-octahedron", "--all", "--most", 3)
    assert result.stdout.count("data-way=") == 3
    assert "the first 3 of 8 are drawn: --most N draws more" in result.stderr


def test_the_folded_sheet_is_drawn_in_space():
    text = drawn("two-vertex", "--signs", "+-", "--folded", "60deg")
    assert title(text) == "two-vertex, branch +-, folded to 60°"
    assert text.count("<path") == len(load("two-vertex").triangles)
    assert title(drawn("zigzags", "--way", "1", "--folded", "45deg")).endswith("to 45°")


@pytest.mark.slow
def test_the_other_side_of_a_branch_is_its_mirror_image():
    asked = ("two-vertex", "--signs", "+-", "--folded", "60deg")
    motion = follow(find_branch("two-vertex", "+-"), side=-1)
    mirror = drawn(*asked, "--side", "-")
    assert mirror == folded(motion, Amount.of("60deg"), "two-vertex").text
    assert mirror != drawn(*asked) == drawn(*asked, "--side", "+")
    asked = ("zigzags", "--way", "1", "--folded", "45deg")
    ways = count_ways("zigzags")
    number = panel_ways(ways)[0].modes[0].number
    below = follow_panels(ways, way=1, amounts={number: -1})
    assert drawn(*asked, "--side", "-") == folded(below, Amount.of("45deg"), "zigzags").text
    assert drawn(*asked, "--side", "-") != drawn(*asked)


def test_a_sheet_with_a_hole_is_drawn(tmp_path):
    (tmp_path / "hole.svg").write_text(HOLE)
    result = run("draw", tmp_path / "hole.svg")
    assert result.exit_code == PROVED
    assert result.stdout.count('class="B"') == 8
    assert "the sheet has 1 hole" in result.stderr
    assert run("draw", tmp_path / "hole.svg", "--all").exit_code == PROVED
    cut = run("draw", tmp_path / "hole.svg", "--colours", "red=V,black=C")
    assert cut.stdout.count('class="V"') == 4


def test_names_of_files_are_made_safe(tmp_path):
    path = tmp_path / "a<b>&\"c'.fold"
    path.write_bytes(example_path("two-vertex").read_bytes())
    assert title(drawn(path)) == path.stem


SHEET = "6 vertices, 7 folds, 6 panels"
"""`two-vertex`, as `random` and `convert` say it, too."""

# --- where it goes -------------------------------------------------------------------------------


def test_files_are_written_by_their_ending(tmp_path):
    result = run("draw", "two-vertex", "-o", tmp_path / "p.svg")
    assert (result.exit_code, result.stdout) == (PROVED, f"wrote {tmp_path / 'p.svg'}: {SHEET}\n")
    assert (tmp_path / "p.svg").read_text("utf-8") == drawn("two-vertex")
    assert drawn("two-vertex", "-o", "-") == drawn("two-vertex")
    wrong = run("draw", "two-vertex", "-o", tmp_path / "p.gif")
    assert wrong.exit_code == USAGE
    assert ".svg, .png, .pdf" in wrong.stderr


@pytest.mark.parametrize(
    ("asked", "name"),
    [((), "two-vertex-drawn.svg"), (("--way", "2"), "two-vertex-way.svg")],
)
def test_on_a_terminal_a_file_is_written(asked, name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(draw, "on_a_terminal", lambda: True)
    result = run("draw", "two-vertex", *asked)
    assert result.stdout == f"wrote {name}: {SHEET}\n"
    assert (tmp_path / name).read_text("utf-8").startswith("<svg")


def test_the_pattern_is_not_replaced_by_its_picture(tmp_path):
    path = tmp_path / "p.svg"
    path.write_bytes(example_path("zigzags").read_bytes())
    result = run("draw", path, "-o", path)
    assert result.exit_code == USAGE
    assert path.read_bytes() == example_path("zigzags").read_bytes()


@pytest.mark.skipif(importlib.util.find_spec("cairosvg") is None, reason="CairoSVG is an extra")
@pytest.mark.parametrize(("ending", "start"), [("png", b"\x89PNG\r\n\x1a\n"), ("PDF", b"%PDF-")])
def test_png_and_pdf(ending, start, tmp_path):
    path = tmp_path / f"p.{ending}"
    assert run("draw", "two-vertex", "--signs", "+-", "-o", path).exit_code == PROVED
    raw = path.read_bytes()
    assert raw.startswith(start)
    if ending == "png":  # twice as wide as the SVG picture, from the header
        svg = ElementTree.fromstring(drawn("two-vertex", "--signs", "+-"))
        assert int.from_bytes(raw[16:20], "big") == pytest.approx(
            2 * float(svg.get("width")), abs=2
        )


def test_png_without_cairosvg_names_the_extra(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "cairosvg", None)
    result = run("draw", "two-vertex", "-o", tmp_path / "p.png")
    assert result.exit_code == USAGE
    assert "pip install 'exactfold[pictures]'" in result.stderr
    assert not (tmp_path / "p.png").exists()


# --- wrong usage ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        (("--way", "1", "--all"), "give one of"),
        (("--way", "1", "--up", "4"), "give one of"),
        (("--most", "3"), "--most goes with --all"),
        (("--folded", "60deg"), "--folded needs a way"),
        (("--way", "1", "--side", "-"), "--side goes with --folded"),
        (("--way", "1", "--folded", "60"), "60deg"),
        (("--way", "1", "--folded", "190deg"), "up to 180deg"),
        (("--way", "1", "--folded", "nan"), "60deg"),
        (("--way", "9"), "there is no way 9: `count` lists 1 to 4"),
        (("--signs", "+"), "1 sign for 2 vertices"),
        (("--signs", "x+"), "is not a vertex sign"),
    ],
)
def test_wrong_usage_is_told(asked, message):
    result = run("draw", "two-vertex", *asked)
    assert result.exit_code == USAGE
    assert message in result.stderr


def test_signs_are_not_for_panels():
    result = run("draw", "zigzags", "--signs", "+-")
    assert result.exit_code == USAGE
    assert "name one by way or letters" in result.stderr
    assert "`count` lists 1 to 4" in run("draw", "zigzags", "--way", "5").stderr


def test_a_sheet_without_ways_is_told(tmp_path):
    square = '<svg xmlns="http://www.w3.org/2000/svg"><path stroke="black" d="M0 0H9V9H0Z"/></svg>'
    (tmp_path / "s.svg").write_text(square)
    result = run("draw", tmp_path / "s.svg", "--all", "--force")
    assert result.exit_code == UNDECIDED
    assert "the sheet is rigid: no fold can fold" in result.stderr


def test_free_folds_are_a_way_to_fold(tmp_path):
    lines = "".join(f'<path stroke="red" d="M{x} 0V9"/>' for x in (2, 5))
    (tmp_path / "s.svg").write_text(
        '<svg xmlns="http://www.w3.org/2000/svg"><path fill="none" stroke="black" d="M0 0H9V9H0Z"/>'
        f"{lines}</svg>"
    )
    assert title(drawn(tmp_path / "s.svg", "--all")) == "s: 1 way, known to truly fold"
    alone = drawn(tmp_path / "s.svg", "--way", 1)
    assert title(alone) == "s, way 1, a family of dimension 2"
    assert alone.count('class="V"') == 2
