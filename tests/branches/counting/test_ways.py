"""Any sheet in, the right theory out: branches of triangles, motions of panels."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import pytest
from drawings import SQUARE, as_cp, as_fold
from sampling import slow_after
from sheets import DENTED, HEXAGON, scrambled

from exactfold import PROVED, REFUTED
from exactfold.app.report.panels import panels_answer
from exactfold.branches import count_branches, count_many, find_connected_components
from exactfold.branches.counting.by_theorem import graphs_over_boundary
from exactfold.branches.counting.motion_facts import panel_facts
from exactfold.branches.counting.ways import count_ways
from exactfold.errors import SeveralSheetsError, UnreadableFileError, UsageError
from exactfold.exact.surds import RATIONALS, real_root
from exactfold.panels.decomposition import decompose
from exactfold.panels.result import Decomposition
from exactfold.pattern import write_fold
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.drawing.formats.read import parse_drawing
from exactfold.pattern.families import single_vertex, two_vertex
from exactfold.pattern.opening import has_branches, open_pattern, panels
from exactfold.pattern.panel_pattern import EnclosedPattern, PanelPattern
from exactfold.pattern.reading import Reading

BORDER = [(0, 1), (1, 2), (2, 3), (0, 3)]
CORNERS = [(0, 0), (2, 0), (2, 2), (0, 2)]
CROSS = PanelPattern([*CORNERS, (1, 1)], [*BORDER, (0, 4), (1, 4), (2, 4), (3, 4)])
"""A square with both diagonals: one vertex of degree 4."""
PENTAGON = CreasePattern(
    [(0, 0), (4, 0), (5, 3), (2, 5), (-1, 3), (1, 2), (3, 2)],
    [(0, 1, 5), (1, 6, 5), (1, 2, 6), (2, 3, 6), (3, 5, 6), (3, 4, 5), (4, 0, 5)],
)
"""Triangulated, with two interior and five boundary vertices."""


def test_sheets_with_branches_have_branches() -> None:
    for pattern in (two_vertex(), single_vertex(5)):
        assert has_branches(pattern)
        found = count_ways(pattern)
        assert found.to_dict()["theory"] == "branches"
        assert found.distinct == count_branches(pattern).distinct


def test_convex_sheets_with_more_freedom_are_also_decomposed() -> None:
    assert not has_branches(PENTAGON)
    found = count_ways(PENTAGON)
    assert found.status is PROVED
    assert found.families == decompose(panels(PENTAGON))
    assert dict(found.families.second_order) == {2: 2}
    assert found.to_dict()["components"]["second_order"] == {"2": 2}
    assert (found.connected_components.graphs, found.connected_components.number) == (4, 2)


@pytest.mark.usefixtures("without_spaces")
def test_sheets_with_more_freedom_and_a_reflex_corner_are_decomposed() -> None:
    sheet = scrambled(2, DENTED, 4, loose=True)
    found = count_ways(sheet)
    ways = decompose(panels(sheet))
    assert found.reason.startswith(f"{ways.reason}; the sheet has 6 boundary vertices")
    assert "a reflex corner, vertex 3" in found.reason
    assert found.found == ways.found


def _sheared(sheet: CreasePattern) -> PanelPattern:
    """The image of a sheet under a shear and a reflection over Q(sqrt 3)."""
    root = real_root(3, RATIONALS)
    return PanelPattern([(y + root * x, x) for x, y in sheet.vertices], sheet.edges)


@pytest.mark.parametrize(
    "sheet",
    [
        PENTAGON,
        single_vertex(7),
        *slow_after(2, (scrambled(seed, HEXAGON, 5) for seed in range(4))),
        *(scrambled(seed, [(0, 0), (4, 0), (4, 2), (4, 4), (0, 4)], 4) for seed in range(3)),
    ],
)
def test_graphs_do_not_change_with_an_affine_map(sheet: CreasePattern) -> None:
    """K_v is a form of curvature, which an affine map of the plane multiplies by a number."""
    graphs = find_connected_components(sheet).graphs
    assert graphs_over_boundary(panels(sheet)) == graphs.bit_length() - 1
    assert graphs_over_boundary(_sheared(sheet)) == graphs.bit_length() - 1


@pytest.mark.parametrize(
    "sheet",
    [scrambled(2, DENTED, 4), two_vertex(), CreasePattern([(0, 0), (1, 0), (0, 1)], [(0, 1, 2)])],
)
def test_graphs_need_a_convex_boundary_of_five_vertices(sheet: CreasePattern) -> None:
    assert graphs_over_boundary(_sheared(sheet)) is None


def test_graphs_need_triangles_and_known_positions() -> None:
    pentagon = _sheared(PENTAGON)
    rest = [edge for edge in pentagon.edges if edge != (1, 6)]
    assert graphs_over_boundary(PanelPattern(pentagon.vertices, rest)) is None
    directions = {(i, j): pentagon.direction(i, j) for i, j in pentagon.edges}
    nearly = EnclosedPattern(pentagon.vertices, pentagon.edges, directions, Fraction(1, 9))
    assert graphs_over_boundary(nearly) is None


@pytest.mark.slow
@pytest.mark.usefixtures("without_spaces")
def test_a_convex_sheet_with_roots_has_graphs_where_its_motions_are_too_many() -> None:
    found = count_ways(_sheared(scrambled(1, HEXAGON, 5, loose=True)))
    assert isinstance(found, Decomposition)
    assert (found.status, found.rigid, found.graphs) == (PROVED, REFUTED, 5)
    assert (found.second_order, found.to_dict()["by"]) == (None, "theorem")
    assert found.to_dict()["components"]["graphs"] == {"vertices": 5, "dimension": 3}
    assert "2^5 graphs over the boundary heights, of dimension 3" in found.reason
    lines = " ".join(str(panels_answer(found)).split())
    assert lines.startswith("16 families of ways to fold, each of dimension 3 - PROVED")


def test_a_convex_sheet_with_roots_has_its_components_where_they_are_known() -> None:
    found = count_ways(_sheared(PENTAGON))
    assert isinstance(found, Decomposition)
    assert (found.second_order, found.graphs) == ({2: 2}, None)


def test_a_sheet_without_interior_vertex_folds_at_each_fold() -> None:
    sheet = CreasePattern(CORNERS, [(0, 1, 2), (0, 2, 3)])
    assert not has_branches(sheet)
    found = count_ways(sheet)
    assert (dict(found.true), found.free, found.ways) == ({1: 1}, ((0, 2),), 1)
    blank = count_ways(PanelPattern(CORNERS, BORDER))
    assert (dict(blank.true), blank.ways) == ({0: 1}, 0)


def test_panels_drawings_and_files_are_one_sheet(tmp_path: Path) -> None:
    path = tmp_path / "s.cp"
    path.write_text(as_cp(SQUARE))
    expected = count_ways(open_pattern(path).sheet)
    assert dict(expected.second_order) == {0: 1}
    for given in (path, str(path), parse_drawing(as_fold(SQUARE), "s"), open_pattern(path)):
        found = count_ways(given)
        assert len(found.pattern.folds) == len(expected.pattern.folds) == 2
        assert found.second_order == expected.second_order
        assert "6 lines (1 mountain, 1 valley, 4 boundary)" in found.read["lines"][0]


def test_rounding_is_never_silent(tmp_path: Path) -> None:
    path = tmp_path / "p.fold"
    write_fold(PENTAGON, path)
    near = [(x + Fraction(k, 10**6), y) for k, (x, y) in enumerate(PENTAGON.vertices)]
    write_fold(CreasePattern(near, PENTAGON.triangles), path)
    assert count_ways(path).read is None
    rounded = count_ways(path, Reading(1))
    assert rounded.pattern == PENTAGON
    assert rounded.read["lines"] == ["rounding moved coordinates by up to 6e-06"]


def test_what_is_no_sheet_is_refused(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="3 is not a pattern"):
        count_ways(3)  # type: ignore[arg-type]
    with pytest.raises(UnreadableFileError, match="two-vertex"):
        count_ways("crane")
    with pytest.raises(UsageError, match="--snap auto is for drawings"):
        count_ways(two_vertex(), Reading("auto"))
    for given in (two_vertex(), CROSS):
        assert count_ways(given, Reading(number=1)) == count_ways(given)
        with pytest.raises(SeveralSheetsError, match="there is no sheet 2"):
            count_ways(given, Reading(number=2))


@pytest.mark.parametrize(
    ("sheet", "degrees", "flat", "free", "parts", "words"),
    [
        (CROSS, {4: 4}, (), (), ((4,),), "1 part with vertices that may fold, at most four"),
        (
            PanelPattern([*CORNERS, (1, 1)], [*BORDER, (0, 4), (1, 4), (2, 4)]),
            *({4: 3}, ((1, 4),), (), ((4,),), "1 part with vertices that may fold, at most four"),
        ),
        (
            PanelPattern([*CORNERS, (Fraction(1, 2), 1)], [*BORDER, (0, 4), (1, 4), (2, 4)]),
            *({4: 3}, ((0, 4), (1, 4), (2, 4)), (), (), "rigid: no fold can fold"),
        ),
        (
            PanelPattern(CORNERS, [*BORDER, (0, 2)]),
            *({}, (), ((0, 2),), (), "1 fold from boundary to boundary, folds freely"),
        ),
        (panels(PENTAGON), {5: 4, 6: 4}, (), (), ((5, 6),), ""),
    ],
    ids=["cross", "straight pair", "rigid", "free", "pentagon"],
)
def test_facts_of_panels_agree_with_the_count(sheet, degrees, flat, free, parts, words) -> None:
    facts, found = panel_facts(sheet), decompose(sheet)
    if words:
        assert facts.degrees == degrees
        assert (facts.flat, facts.free, facts.parts) == (flat, free, parts)
        assert facts.expected.startswith(words)
    assert (facts.flat, facts.free) == (found.flat, found.free)
    assert facts.parts == tuple(part.vertices for part in found.parts)


def test_many_sheets_of_all_kinds_and_one_number_for_drawings_with_several(tmp_path) -> None:
    apart = [((str(3 + float(a)), b), (str(3 + float(c)), d), e) for (a, b), (c, d), e in SQUARE]
    two = tmp_path / "two.cp"
    two.write_text(as_cp([*SQUARE[:4], *apart]))
    found = dict(count_many([two, CROSS], reading=Reading(number=2)))
    assert len(found[str(two)].pattern.folds) == 2
    assert isinstance(found["1"], SeveralSheetsError)
    assert isinstance(dict(count_many([two]))[str(two)], SeveralSheetsError)
    assert dict(count_many([CROSS]))["0"].to_dict()["theory"] == "modes"
