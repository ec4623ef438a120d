"""Loops that nearly close in rounded drawings, and the snap that closes them."""

from __future__ import annotations

import json
import pickle
from fractions import Fraction

import pytest
from panel_sheets import regular_twist
from typer.testing import CliRunner

from exactfold.app.cli import app
from exactfold.branches.counting.ways import count_ways
from exactfold.panels import near_misses
from exactfold.panels.decomposition import decompose
from exactfold.panels.near_misses import SNAPS, closes, snapped_misses
from exactfold.panels.result import Decomposition
from exactfold.panels.stars import edge_of
from exactfold.pattern.drawing.drawing import Drawing, Line
from exactfold.pattern.opening import from_drawing
from exactfold.pattern.panel_pattern import PanelPattern
from exactfold.pattern.reading import Reading

PLAIN = regular_twist(4, (Fraction(3), Fraction(-7)))


def pinwheel(digits: int, scale: Fraction = Fraction(1, 3)) -> Drawing:
    """A square twist with corners on thirds, or on another grid, written with some decimals."""
    points = [
        tuple(Fraction(round(Fraction(c) * scale * 10**digits), 10**digits) for c in point)
        for point in PLAIN.vertices
    ]
    folds = set(PLAIN.folds)
    lines = [Line(i, j, "M" if (i, j) in folds else "B") for i, j in PLAIN.edges]
    return Drawing(tuple((x, y) for x, y in points), tuple(lines), "a pinwheel")


def counted(drawing: Drawing) -> Decomposition:
    result = count_ways(drawing, Reading("exact"))
    assert isinstance(result, Decomposition)
    return result


@pytest.mark.parametrize("digits", [7, 8])
def test_auto_closes_a_pinwheel_on_thirds(digits: int) -> None:
    result = counted(pinwheel(digits))
    assert result.second_order == {0: 1}
    assert result.near_misses
    for miss in result.near_misses:
        assert sorted(miss.loop) == [0, 1, 2, 3]
        assert miss.fold == edge_of(*miss.loop[:2])
        assert 0 < miss.off < 1e-6
        assert miss.off == pytest.approx(abs(miss.quotient - 1), abs=1e-15)
        assert (miss.snap, miss.tried) == ("auto", ("auto",))
        assert 0 < (miss.largest_move or 0) < 10**-digits
    snapped = count_ways(pinwheel(digits), Reading("auto"))
    assert isinstance(snapped, Decomposition)
    assert snapped.second_order == {1: 6}
    assert not snapped.near_misses


def test_the_quotient_is_the_product_of_the_gains_round_the_loop() -> None:
    for miss in counted(pinwheel(7)).near_misses:
        product = 1.0
        for k, mode in enumerate(miss.modes):
            assert mode.vertex == miss.loop[k]
            before, after = miss.loop[k - 1], miss.loop[(k + 1) % 4]
            gain = mode.gain(edge_of(mode.vertex, before), edge_of(mode.vertex, after))
            product *= float(gain)
        assert product == pytest.approx(miss.quotient, abs=1e-13)


def test_a_denominator_closes_what_auto_does_not(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(near_misses, "SNAPS", (1, 2, 3, 4))
    result = counted(pinwheel(7))
    assert {(miss.snap, miss.tried) for miss in result.near_misses} == {(3, (1, 2, 3))}
    assert result.warning is not None
    assert "off by" in result.warning
    assert "--snap 3 closes it (largest move" in result.warning


def test_no_snap_closes_what_is_no_small_number(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(near_misses, "SNAPS", SNAPS[1:])
    result = counted(pinwheel(8, Fraction(1000, 3001)))
    assert result.near_misses
    assert all(miss.snap is miss.largest_move is None for miss in result.near_misses)
    assert {miss.tried for miss in result.near_misses} == {SNAPS[1:]}
    assert result.warning is not None
    assert "nearly closes" in result.warning
    assert "none of the snaps that were tried closes it" in result.warning


def test_what_is_not_tried() -> None:
    """A pattern in memory is not read again; large moves and other edges count for nothing."""
    sheet = from_drawing(pinwheel(7), Reading("exact")).sheet
    assert isinstance(sheet, PanelPattern)
    result = decompose(sheet)
    [first, *_] = result.near_misses
    assert (first.snap, first.tried) == (None, ())
    assert result.warning is not None
    assert "the drawing may be rounded (try --snap auto)" in result.warning
    good = from_drawing(pinwheel(7), Reading("auto")).sheet
    assert isinstance(good, PanelPattern)
    assert closes(good, first)
    assert not closes(sheet, first)
    assert snapped_misses([first], sheet, lambda _: (good, 0.0))[0].snap == "auto"
    assert snapped_misses([first], sheet, lambda _: (good, 2e-4))[0].snap is None
    other = PanelPattern([(0, 0), (1, 0), (0, 1)], [(0, 1), (1, 2), (0, 2)])
    assert snapped_misses([first], sheet, lambda _: (other, 0.0))[0].tried == SNAPS


def test_json_and_terminal(tmp_path) -> None:  # type: ignore[no-untyped-def]
    drawing = pinwheel(7)
    coords = [[float(x), float(y)] for x, y in drawing.points]
    edges = [[line.start, line.end] for line in drawing.lines]
    letters = [line.letter for line in drawing.lines]
    path = tmp_path / "pinwheel.fold"
    document = {"vertices_coords": coords, "edges_vertices": edges, "edges_assignment": letters}
    path.write_text(json.dumps(document))
    runner = CliRunner()
    done = runner.invoke(app, ["count", str(path), "--snap", "exact", "--json"])
    assert done.exit_code == 0
    found = json.loads(done.stdout)["near_misses"]
    assert found
    for miss in found:
        assert miss["off"] == pytest.approx(abs(miss["quotient"] - 1), abs=1e-15)
        assert (miss["snap"], miss["tried"]) == ("auto", ["auto"])
        assert sorted(miss["loop"]) == [0, 1, 2, 3]
    said = " ".join(runner.invoke(app, ["count", str(path), "--snap", "exact"]).stdout.split())
    assert "warning: the loop of folds" in said
    assert "--snap auto closes it (largest move" in said


def test_results_are_pickled() -> None:
    result = counted(pinwheel(7))
    assert pickle.loads(pickle.dumps(result)).near_misses == result.near_misses
    opened = from_drawing(pinwheel(7), Reading("exact"))
    again = pickle.loads(pickle.dumps(opened)).again
    assert again is not None
    assert again(Reading("auto")).sheet == from_drawing(pinwheel(7), Reading("auto")).sheet
