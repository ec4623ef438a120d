"""All assignments of panels: against other lists, and one by one against `match`."""

from itertools import product

import pytest
from panel_letters import HEXAGON, around, crane_base
from panel_sheets import miura, tiling

from exactfold import count, delaunay
from exactfold._support.clock import Clock
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.design import all_assignments, match_panels, panel_assignments
from exactfold.exact.surds import sign
from exactfold.panels import decompose
from exactfold.panels.vertex.stars import stars
from exactfold.panels.vertex.vertex_motions import Fan
from exactfold.pattern.families import hypar

TURNED = str.maketrans("MV", "VM")


def texts(listed):
    """The assignments of a sheet that is one part."""
    (part,) = listed.parts
    return set(part.assignments)


def test_the_square_twist_has_twelve_assignments():
    """Of its 16 flat-foldable assignments 12 fold rigidly, and no others do."""
    listed = panel_assignments("square-twist")
    assert (listed.status, listed.number, listed.at_most) == (PROVED, 12, 12)
    modes = {"".join(mode.assignment.values()) for mode in count("square-twist").modes}
    assert texts(listed) == modes | {text.translate(TURNED) for text in modes}


@pytest.mark.parametrize("sheet", [tiling(2, 1), around(HEXAGON)], ids=["tiling", "hexagon"])
def test_every_assignment_is_found_or_refuted_as_match_does(sheet):
    listed = panel_assignments(sheet)
    assert listed.status is PROVED
    for letters in map("".join, product("MV", repeat=len(sheet.folds))):
        assert (match_panels(sheet, letters).starts is PROVED) == (letters in texts(listed))


def test_the_lines_of_a_bird_base_are_its_assignments():
    sheet = crane_base()
    expected = set()
    for leaf in decompose(sheet).parts[0].spaces:
        if set(sheet.folds) <= leaf.rows.keys():
            text = "".join("V" if sign(leaf.rows[fold][0]) > 0 else "M" for fold in sheet.folds)
            expected |= {text, text.translate(TURNED)}
    listed = panel_assignments(sheet)
    assert len(expected) == listed.number == 32
    assert texts(listed) == expected


def test_spaces_of_several_dimensions_are_cut_by_all_folds():
    listed = panel_assignments("bird-base")
    assert (listed.status, listed.number) == (PROVED, 214)
    chosen = sorted(texts(listed))[::30]
    assert all(match_panels("bird-base", text).starts is PROVED for text in chosen)
    fans = [(star, Fan(star)) for star in stars(listed.pattern).values()]
    for text in chosen:
        near = [text[:k] + text[k:].translate(TURNED)[0] + text[k + 1 :] for k in range(20)]
        for other in set(near) - texts(listed):
            letters = dict(zip(listed.pattern.folds, other, strict=True))
            alone = all(fan.folds([letters[f] for f in star.folds]) for star, fan in fans)
            assert not alone or match_panels(listed.pattern, other).starts is not PROVED


def test_parts_and_free_folds_multiply():
    listed = panel_assignments("fish-base")
    assert [len(part.assignments) for part in listed.parts] == [4, 4]
    assert (len(listed.free), listed.number) == (1, 32)


def test_sides_of_a_fold_that_alone_joins_them_are_put_together():
    points = [(0, 0), (4, 0), (6, 1), (4, 4), (0, 4), (-3, 1), (-3, -2), (1, -4), (6, -3)]
    spokes = [(0, 1), (0, 3), (0, 4), (0, 5), (0, 6), (0, 7), (1, 2), (1, 3), (1, 7), (1, 8)]
    rim = [(2, 3), (3, 4), (4, 5), (5, 6), (6, 7), (7, 8), (2, 8)]
    sheet = type(crane_base())(points, spokes + rim)
    fans = [(star, Fan(star)) for star in stars(sheet).values()]
    expected = set()
    for text in map("".join, product("MV", repeat=len(sheet.folds))):
        letters = dict(zip(sheet.folds, text, strict=True))
        if all(fan.folds([letters[f] for f in star.folds]) for star, fan in fans):
            expected.add(text)
    listed = panel_assignments(sheet)
    assert (listed.status, texts(listed)) == (PROVED, expected)


@pytest.mark.parametrize("sheet", ["two-vertex", "h1-4", hypar(1)])
def test_those_of_four_corners_are_those_of_the_branches(sheet):
    listed = panel_assignments(sheet)
    branches = {branch.assignment_text for branch in count(sheet)}
    assert (listed.status, texts(listed)) == (
        PROVED,
        branches | {text.translate(TURNED) for text in branches},
    )


def test_those_of_five_corners_are_those_of_the_circles():
    sheet = delaunay([(0, 0), (10, -3), (16, 5), (9, 14), (-2, 9), (5, 4), (8, 7)])
    listed = panel_assignments(sheet)
    proved = texts(listed)
    circles = set(all_assignments(sheet).assignments)
    assert proved <= circles <= proved | set(listed.parts[0].undecided)


def test_lines_of_many_folds_are_listed():
    assert panel_assignments(miura(3, 3)).status is PROVED


def test_a_clock_that_has_passed_leaves_the_list_open():
    listed = panel_assignments(around(HEXAGON), clock=Clock(0))
    assert (listed.status, listed.number) == (UNDECIDED, None)
    assert "time limit" in listed.reason
    assert repr(listed).startswith("<PanelAssignments: undecided")
