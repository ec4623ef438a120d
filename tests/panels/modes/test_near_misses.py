"""Loops that nearly close in rounded drawings."""

from __future__ import annotations

import json
import pickle
from dataclasses import replace
from fractions import Fraction

import pytest
from panel_sheets import regular_twist
from typer.testing import CliRunner

from exactfold.app.cli import app
from exactfold.branches.counting.ways import count_ways
from exactfold.panels.decomposition import decompose
from exactfold.panels.modes.near_misses import near_limit
from exactfold.panels.result import Decomposition
from exactfold.panels.vertex.stars import edge_of
from exactfold.pattern.drawing.drawing import Drawing, Line
from exactfold.pattern.meant import Meant
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
def test_a_pinwheel_on_thirds_nearly_closes(digits: int) -> None:
    result = counted(pinwheel(digits))
    assert result.second_order == {0: 1}
    assert result.nearly_closing
    for miss in result.nearly_closing:
        assert sorted(miss.loop) == [0, 1, 2, 3]
        assert miss.fold == edge_of(*miss.loop[:2])
        assert 0 < miss.off < 1e-6
        assert miss.off == pytest.approx(abs(miss.quotient - 1), abs=1e-15)
    snapped = count_ways(pinwheel(digits), Reading("auto"))
    assert isinstance(snapped, Decomposition)
    assert snapped.second_order == {1: 6}
    assert not snapped.nearly_closing


def test_the_quotient_is_the_product_of_the_gains_round_the_loop() -> None:
    for miss in counted(pinwheel(7)).near_misses:
        product = 1.0
        for k, mode in enumerate(miss.modes):
            assert mode.vertex == miss.loop[k]
            before, after = miss.loop[k - 1], miss.loop[(k + 1) % 4]
            gain = mode.gain(edge_of(mode.vertex, before), edge_of(mode.vertex, after))
            product *= float(gain)
        assert product == pytest.approx(miss.quotient, abs=1e-13)


def test_noise_widens_what_is_near() -> None:
    """Four digits: loops miss 1 by more than 1e-6, but by less than the noise explains.

    Without a noise level it is too near for chance: there are few loops.
    """
    sheet = from_drawing(pinwheel(4, Fraction(1, 7)), Reading("exact")).sheet
    assert isinstance(sheet, PanelPattern)
    ways = decompose(sheet)
    parts = tuple(replace(part, loops=10**5) for part in ways.parts)
    many = replace(ways, parts=parts)
    assert all(1e-6 < miss.off < 1e-3 for miss in ways.nearly_closing)
    assert many.nearly_closing == ()
    assert ways.nearly_closing == replace(many, meant=Meant(noise=1e-5)).nearly_closing != ()
    assert (near_limit(None), near_limit(1e-5)) == (1e-6, pytest.approx(1e-3))


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
        assert miss.keys() == {"fold", "quotient", "loop", "off"}
        assert sorted(miss["loop"]) == [0, 1, 2, 3]
    said = " ".join(runner.invoke(app, ["count", str(path), "--snap", "exact"]).stdout.split())
    assert "warning: the loop of folds" in said


def test_results_are_pickled() -> None:
    result = counted(pinwheel(7))
    assert pickle.loads(pickle.dumps(result)).near_misses == result.near_misses
    opened = from_drawing(pinwheel(7), Reading("exact"))
    again = pickle.loads(pickle.dumps(opened)).again
    assert again is not None
    assert again(Reading("auto")).sheet == from_drawing(pinwheel(7), Reading("auto")).sheet
