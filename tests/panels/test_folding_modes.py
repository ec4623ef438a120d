"""Modes that truly fold, of sheets whose ways to fold are not all known."""

import io
from itertools import product

import pytest
from rich.console import Console

from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED
from exactfold.app.pictures.way_sheets import sheet_of_ways
from exactfold.app.report.panels import panels_report
from exactfold.motion.panels.followable import panel_modes
from exactfold.motion.panels.listing import panel_ways
from exactfold.panels import by_spaces
from exactfold.panels import folding_modes as by_modes
from exactfold.panels.decomposition import decompose
from exactfold.panels.folding_modes import MOST_MODES, folding_modes
from exactfold.panels.result import Decomposition
from exactfold.panels.spaces.kernel import first_order
from exactfold.panels.vertex.stars import stars
from exactfold.pattern.panel_pattern import PanelPattern


def boxes(size: int, slants: str) -> PanelPattern:
    """A square grid, with the diagonals of some squares, column by column."""
    up = size + 1
    edges = [(i * up + j, (i + 1) * up + j) for i in range(size) for j in range(up)]
    edges += [(j * up + i, j * up + i + 1) for i in range(size) for j in range(up)]
    for i, j in product(range(size), repeat=2):
        low, slant = i * up + j, slants[(i + 2 * j) % len(slants)]
        if slant == "/":
            edges.append((low, low + up + 1))
        elif slant == "\\":
            edges.append((low + up, low + 1))
    return PanelPattern([(i, j) for i in range(up) for j in range(up)], edges)


@pytest.fixture(
    scope="module",
    params=[("/  ", True), ("/ \\ ", True), ("/  ", False), ("/ \\ ", False)],
    ids=["one way", "both ways", "one way by spaces", "both ways by spaces"],
)
def result(request: pytest.FixtureRequest) -> Decomposition:
    # Whether the search in floats finds a component depends on their roundings.
    slants, solver = request.param
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(by_spaces, "found_components", lambda *_: ([], False))
        patch.setattr(by_spaces, "MOST_STEPS", 0)
        if not solver:
            patch.setattr(by_modes, "ModeClauses", lambda *_, **__: [])
            patch.setattr(by_modes, "straight_creases", lambda _: [])
        found = decompose(boxes(5, slants))
    assert (found.status, found.found) == (UNDECIDED, None)
    return found


def test_the_sheet_is_known_to_fold(result: Decomposition) -> None:
    assert result.rigid is REFUTED
    assert 0 < len(result.modes) <= MOST_MODES
    sizes = [len(mode.assignment) for mode in result.modes]
    assert sizes == sorted(sizes, reverse=True)
    assert len({tuple(mode.assignment.items()) for mode in result.modes}) == len(sizes)


def test_each_is_a_motion_to_second_order(result: Decomposition) -> None:
    moving = stars(result.pattern)
    for mode in result.modes:
        densities = next(m for m in panel_modes(result) if m.letters == mode.assignment).densities
        w = {fold: density.base for fold, density in densities.items() if not density.factors}
        assert set(w) == set(mode.assignment)
        for star in moving.values():
            values = [w.get(fold, 0) for fold in star.folds]
            pairs = list(zip(values, star.directions, strict=True))
            assert sum(x * d[0] for x, d in pairs) == sum(x * d[1] for x, d in pairs) == 0
            assert star.form(values) == 0


def test_with_all_other_folds_flat_the_structure_theorem_has_it(result: Decomposition) -> None:
    for mode in result.modes:
        others = set(result.pattern.folds) - set(mode.assignment)
        alone = decompose(result.pattern, flat=others)
        assert alone.theory == "modes"
        known = [dict(m.assignment) for m in alone.modes if m.extends.verdict is PROVED]
        turned = {fold: {"M": "V", "V": "M"}[letter] for fold, letter in mode.assignment.items()}
        assert dict(mode.assignment) in known or turned in known


def test_they_can_be_followed_and_are_shown(result: Decomposition) -> None:
    assert [mode.letters for mode in panel_modes(result)] == [m.assignment for m in result.modes]
    assert panel_ways(result)
    console = Console(file=io.StringIO(), width=200)
    console.print(panels_report(result, None, everything=False))
    text = console.file.getvalue()  # type: ignore[attr-defined]
    assert "each way listed below truly folds, and there may be others" in text
    assert "known to truly fold; there may be others" in sheet_of_ways(result, "boxes")
    assert result.to_dict()["rigid"] is False
    assert len(result.to_dict()["modes"]) == len(result.modes)


@pytest.mark.slow
def test_lines_with_more_than_four_folds_at_a_vertex_are_left_out() -> None:
    moving = stars(boxes(5, "/"))
    rows, size = first_order(moving)
    for mode in folding_modes(boxes(5, "/"), moving, rows, size, 10**7):
        assert all(len(local.folds) <= 4 for local in mode.choice)
        assert mode.extends.verdict is PROVED
