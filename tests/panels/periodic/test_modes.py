"""Tessellations of rigid panels, beside pleats of the same cells cut into triangles."""

from __future__ import annotations

from fractions import Fraction

import pytest

import exactfold
from exactfold import UNDECIDED, Verdict
from exactfold.branches import HeightSpace, count_periodic
from exactfold.errors import MalformedPatternError
from exactfold.panels import PanelCell, count_panel_cell
from exactfold.panels.periodic.torus import Torus
from exactfold.pattern import PeriodicPattern, drawn_cell, random_cell, read_cell
from exactfold.pattern.periodic.cell_files import cell_document
from exactfold.rigidity.equations.periodic import PeriodicProblem, bend_of


def letters_of(cell: PeriodicPattern, heights: list[float]) -> str | None:
    """Letters of the folds of periodic heights, M first; None if a diagonal is not flat."""
    problem = PeriodicProblem.of(cell, (1, 0))
    signs = {}
    for edge in cell.edges:
        row = bend_of(cell, edge, problem.height)
        value = sum(float(c) * h for c, h in zip(row, [*heights[1:], 0.0], strict=True))
        signs[edge] = 0 if abs(value) < 1e-9 else (1 if value > 0 else -1)
    if any(signs[edge] for edge in cell.diagonals):
        return None
    folds = [signs[edge] for edge in cell.edges if edge not in cell.diagonals]
    first = next(s for s in folds if s)
    return "".join("FVM"[-s * first] for s in folds)


@pytest.mark.parametrize("name", ["miura-cell", "herringbone-cell", "square-twist-cell"])
def test_planar_motions_are_the_pleats_with_flat_diagonals(name: str) -> None:
    cell = read_cell(name)
    found = []
    for pleat in count_periodic(cell, (3, 4)).pleats:
        if isinstance(pleat, HeightSpace):
            (row,) = pleat.basis
            heights = [float(x) for x in row[:-1]]
        else:
            low, high = pleat.interval
            t = (low + high) / 2
            heights = [float(sum(c * t**k for k, c in enumerate(p))) for p in pleat.heights]
        found.append(letters_of(cell, heights))
    planar = [m for m in count_panel_cell(cell) if m.planar and m.dimension == 1]
    # two straight lines that fold against each other are a pleat, too
    lines = [m for m in count_panel_cell(cell) if not m.planar]
    assert sorted(filter(None, found)) == sorted(
        [*(m.letters or "" for m in planar), *("MMFFFFVV" for _ in lines)]
    )


def test_lines_that_roll_up_are_a_family_for_one_direction() -> None:
    cell = read_cell("miura-cell")
    (lines,) = (m for m in count_panel_cell(cell) if not m.planar)
    x, y = (Fraction(str(value)) for value in lines.direction or ())
    families = count_periodic(cell, (x, y)).families
    problem = PeriodicProblem.of(cell, (x, y))
    inside = [bend_of(cell, edge, problem.height) for edge in cell.diagonals]
    assert [space.dimension for space in families] == [lines.dimension]
    for row in families[0].basis:
        z = [*row[1:-1], row[-1] / problem.unit]
        assert all(sum(c * h for c, h in zip(form, z, strict=True)) == 0 for form in inside)
    assert not count_periodic(cell, (1, 0)).families


def test_the_square_twist_has_two_planar_modes_over_the_root_of_five() -> None:
    twist = count_panel_cell("square-twist-cell")
    assert [(m.dimension, m.planar, m.folds) for m in twist] == [(1, True, Verdict.PROVED)] * 2
    assert twist.field_names == ("Q(sqrt 5)",)
    for motion in twist:  # the conditions at a vertex, in floats
        torus = Torus(twist.pattern)
        (part,) = motion.parts
        for v in range(4):
            total, area = [0.0, 0.0], 0.0
            for (u, i, j), (x, y) in zip(
                twist.pattern.star(v), twist.pattern.spokes(v), strict=True
            ):
                fold = next(
                    (f for f in ((v, u, i, j), (u, v, -i, -j)) if f in part.densities), None
                )
                if fold is not None:
                    w = float(part.densities[fold][0])
                    step = (w * float(x), w * float(y))
                    area += total[0] * step[1] - total[1] * step[0]
                    total = [total[0] + step[0], total[1] + step[1]]
            assert total == pytest.approx([0, 0], abs=1e-12)
            assert area == pytest.approx(0, abs=1e-12)
        assert len(torus.folds) == 8


def test_a_drawing_has_the_motions_of_its_cell() -> None:
    sheet = exactfold.read("miura").sheet
    small, large = (count_panel_cell(drawn_cell(sheet, cells)) for cells in ((4, 2), (2, 1)))
    assert [(m.dimension, m.planar) for m in small] == [(2, False)]
    assert [(m.dimension, m.planar) for m in large] == [(4, False), (1, True)]
    assert large[0].parts[0].letters != large[0].parts[1].letters


def test_affine_maps_keep_components_and_letters() -> None:
    cell = read_cell("square-twist-cell")
    moved = [[(2 * x + y, y - x) for x, y in points] for points in (cell.lattice, cell.points)]
    other = PeriodicPattern(*moved, cell.faces, cell.diagonals)
    assert {m.letters for m in count_panel_cell(other)} == {
        m.letters for m in count_panel_cell(cell)
    }


def test_letters_of_parts_are_chosen_one_by_one() -> None:
    miura = count_panel_cell("miura-cell")
    assert miura.with_letters("MMFFFFVV") == (Verdict.PROVED, (1,))
    assert miura.with_letters("MVUUUUUU") == (Verdict.PROVED, (2,))
    assert miura.with_letters("MVFUUUUU") == (Verdict.REFUTED, ())
    open_ = PanelCell(miura.pattern, miura.folds, UNDECIDED, "", miura.motions[:1])
    assert open_.with_letters("MVUUUUUU") == (UNDECIDED, ())
    yoshimura = count_panel_cell("yoshimura-cell")
    assert yoshimura[0].parts[0].letters is None
    assert yoshimura.with_letters("UUMVUU")[0] is UNDECIDED


def test_triangles_roll_up_in_all_directions_and_are_said_to_be_open() -> None:
    result = count_panel_cell("waterbomb-cell")
    assert result.status is UNDECIDED
    assert "second-order conditions" in result.reason
    assert count_panel_cell(random_cell(3, 0, 64), limit=0).status is UNDECIDED


def test_diagonals_are_edges_and_are_written() -> None:
    cell = read_cell("miura-cell")
    assert read_cell(cell_document(cell)) == cell
    with pytest.raises(MalformedPatternError, match=r"0-3 moved by \(5, 0\) is no edge"):
        PeriodicPattern(cell.lattice, cell.points, cell.faces, [(0, 3, 5, 0)])
    with pytest.raises(MalformedPatternError, match=r"0-3 moved by \(an integer of 16610 bits, 0"):
        PeriodicPattern(cell.lattice, cell.points, cell.faces, [(0, 3, 10**5000, 0)])
    with pytest.raises(MalformedPatternError, match=r"not \[u, v, i, j\]"):
        PeriodicPattern(cell.lattice, cell.points, cell.faces, [(0, 3)])
    turned = [(v, u, -i, -j) for u, v, i, j in cell.diagonals]
    assert PeriodicPattern(cell.lattice, cell.points, cell.faces, turned) == cell
