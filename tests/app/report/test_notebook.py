"""What notebooks show: by the code that draws pictures, and without loading it before."""

import subprocess
import sys
from dataclasses import replace
from xml.etree import ElementTree

import pytest
from svg_reading import NAME, letters, shipped, tree, words

from exactfold import random_square
from exactfold._support.notebook import shown
from exactfold.app.pictures.crease_drawing import pattern_picture
from exactfold.app.pictures.stills import motion_stills
from exactfold.app.report.notebook import ROWS
from exactfold.branches import count_ways, find_branch
from exactfold.design import match
from exactfold.motion import follow, follow_panels, panel_ways
from exactfold.pattern import read_drawing, read_fold
from exactfold.pattern.data import EXAMPLES, example_path
from exactfold.pattern.fold import load_fold


@pytest.fixture(scope="module")
def zigzags():
    return count_ways("zigzags")


def page(html):
    """The parts of a page as XML."""
    return ElementTree.fromstring(f"<div>{html}</div>")


def pictures(html):
    return page(html).findall(f".//{NAME}svg")


@pytest.mark.parametrize("name", EXAMPLES)
def test_patterns_and_files_are_pictures(name):
    opened = shipped(name)
    assert opened._repr_svg_() == pattern_picture(opened.sheet, opened.assignment)
    assert opened.sheet._repr_svg_() == pattern_picture(opened.sheet)
    drawing = read_drawing(example_path(name))
    assert sum(letters(drawing._repr_svg_()).values()) == len(drawing.lines)


def test_a_fold_file_shows_its_letters():
    file = load_fold(example_path("two-vertex"))
    assert file._repr_svg_() == pattern_picture(file.pattern, file.assignment)


def test_a_branch_is_a_picture_with_its_letters():
    branch = find_branch("two-vertex", "+-")
    text = branch._repr_svg_()
    assert letters(text) == {"B": 4, "M": 3, "V": 4}
    assert tree(text).find(f"{NAME}title").text == "branch +-"


def test_a_branch_of_which_nothing_is_proved_is_drawn_too():
    branch = find_branch("two-vertex", "+-")
    nothing = replace(
        branch, root=None, assignment=dict.fromkeys(branch.assignment, "U"), vertex_signs={}
    )
    assert letters(nothing._repr_svg_()) == {"B": 4, "U": 7}


def test_a_count_is_a_table_with_a_picture_for_each_branch():
    result = count_ways("two-vertex")
    html = result._repr_html_()
    rows = page(html).findall(".//tbody/tr")
    assert len(rows) == len(pictures(html)) == 4
    for k, (row, branch) in enumerate(zip(rows, result.branches, strict=True), 1):
        cells = ["".join(cell.itertext()).strip() for cell in row]
        assert (cells[0], cells[2], cells[3]) == (str(k), branch.sign_text, branch.assignment_text)
        found = {one.get("class") for one in row.iter(f"{NAME}path")} - {None}
        assert found == {*branch.assignment.values(), "B"}
    assert "more</p>" not in html


def test_a_table_is_cut_where_there_are_many():
    html = count_ways(random_square(6, seed=0))._repr_html_()
    assert len(pictures(html)) == ROWS == 30
    assert "<p>and 34 more</p>" in html
    assert len(html) < 300_000


def test_ways_of_panels_are_a_table(zigzags):
    html = zigzags._repr_html_()
    assert len(pictures(html)) == len(panel_ways(zigzags)) == 4
    said = ["".join(cell.itertext()) for cell in page(html).findall(".//td")]
    assert said.count("proved") == sum(str(way.verdict) == "proved" for way in panel_ways(zigzags))


def test_motions_are_rows_of_stills(zigzags):
    motion = follow(find_branch("single-vertex-4", "+"), frames=6)
    assert motion._repr_svg_() == motion_stills(motion)
    panels = follow_panels(zigzags, way=1, frames=6)
    assert panels._repr_svg_() == motion_stills(panels)
    assert len(words(panels._repr_svg_())) == 5
    few = words(follow_panels(zigzags, way=1, frames=3)._repr_svg_())
    assert len(few) == len(set(few)) == 3


def test_other_values_are_not_shown():
    assert shown(3, "svg") is None
    assert shown(read_fold(example_path("two-vertex")), "html") is None


@pytest.mark.slow
def test_values_are_shown_in_a_program_that_has_not_drawn_before():
    script = (
        "import exactfold, sys\n"
        "pattern = exactfold.pattern.load('single-vertex-4')\n"
        "assert not [name for name in sys.modules if name.startswith('exactfold.app.report')]\n"
        "print(pattern._repr_svg_()[:4])"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=False
    )
    assert (done.stdout, done.stderr) == ("<svg\n", "")


def test_a_match_is_a_table_of_halves():
    found = match("two-vertex", {(4, 5): "M"})
    page = found._repr_html_()
    assert f"<p>{len(found.matches)} halves of branches have these letters, <b>proved" in page
    assert page.count("<svg") == len(found.matches)
    assert all(f"<code>{half.sign_text}</code>" in page for half in found.matches)
    none = match("two-vertex", "M" * 7)._repr_html_()
    assert none == "<p>no halves of branches have these letters, <b>proved</b></p>"
