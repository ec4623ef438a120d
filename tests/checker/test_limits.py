"""What one certificate may ask for: it is refused quickly, with exit code 3 and the limit."""

from __future__ import annotations

import copy
import json
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from certificates import document, nodes, replaced

from exactfold import checker
from exactfold.checker import command
from exactfold.checker.core import reading
from exactfold.checker.core.limits import MOST_COORDINATE, MOST_NUMBER
from exactfold.checker.core.lines import digest
from exactfold.checker.core.reading import Coordinates, LimitError, parse_integer
from exactfold.checker.core.towers import Tower
from exactfold.checker.sheets import panels as panel_sheet
from exactfold.checker.sheets import sheet
from exactfold.checker.sheets.panels import PanelSheet, read_panels
from exactfold.checker.sheets.sheet import read_sheet

FIXTURES = Path(__file__).parent.parent / "fixtures" / "certificates"
FILES = sorted(path for path in FIXTURES.iterdir() if path.suffix in (".json", ".txt"))
SQUARE = [["0", "0"], ["4", "0"], ["4", "4"], ["0", "4"], ["1", "2"]]
CROSS = {"vertices": SQUARE, "triangles": [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]}


def test_integers_up_to_the_limit():
    assert parse_integer("-" + "9" * MOST_NUMBER) == 1 - 10**MOST_NUMBER
    message = "not checked: the digits of '1{40}', 65537, are more than the limit, 65536"
    with pytest.raises(LimitError, match=message):
        parse_integer("1" * (MOST_NUMBER + 1))


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_no_coordinate_of_any_kind_is_longer(path: Path, tmp_path: Path):
    """The first coordinate of a certificate has a million digits."""
    first, *lines = path.read_text().splitlines()
    data = json.loads(first.partition("\t")[0]) if lines else json.loads(first)
    where, _ = next(
        (where, value)
        for where, value in nodes(data["pattern"]["vertices"])
        if isinstance(value, str)
    )
    for text in ("1" * 10**6, f"1/{'1' * 10**6}"):
        changed = replaced(data, ("pattern", "vertices", *where), text)
        body = json.dumps(changed)
        file = tmp_path / path.name
        file.write_text(f"{body}\t{digest('', body)}\n" if path.suffix == ".txt" else body)
        with pytest.raises(LimitError, match="digits of a coordinate, 1000000, are more than the"):
            checker.verify(file)


def test_coordinates_up_to_the_limit():
    longest = "7" * MOST_COORDINATE
    assert Coordinates()(longest) == 7 * (10**MOST_COORDINATE // 9)
    assert Coordinates()(f"-1/{longest}") == -1 / Fraction(parse_integer(longest))
    for text in (longest + "7", f"1/{longest}7"):
        with pytest.raises(LimitError, match=r"digits of a coordinate, 10001, are more .* 10000"):
            Coordinates()(text)
    with pytest.raises(checker.CertificateError, match="7 is not a number in quotes"):
        Coordinates()(7)


def test_long_coordinates_are_few(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(reading, "MOST_PRODUCTS", 101 * 50 + 200)
    coordinate = Coordinates()
    for _ in range(1000):
        coordinate("1" * 100 + "/" + "1" * 100)
    coordinate("1" * 101 + "/" + "1" * 50)
    coordinate("1" * 200)
    with pytest.raises(LimitError, match="products of digits in long coordinates, 5351, are more"):
        coordinate("1" * 101)


@pytest.mark.parametrize("kind", ["triangles", "panels"])
def test_sheets_of_long_coordinates(kind: str):
    """Each coordinate is within the limit, and all together are not."""
    long = [f"{10**4000 + k}/{3 * 10**4000 + 7 * k}" for k in range(1, 11)]
    if kind == "triangles":
        with pytest.raises(LimitError, match="products of digits"):
            read_sheet({"vertices": [long[:2], long[2:4], long[4:6], long[6:8]], "triangles": []})
        return
    rows = [[[x], [y]] for x, y in zip(long[::2], long[1::2], strict=True)]
    with pytest.raises(LimitError, match="products of digits"):
        read_panels({"radicands": [], "vertices": rows, "edges": []})


def test_pairs_of_boundary_edges(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(sheet, "MOST_ABOVE", 5)
    monkeypatch.setattr(sheet, "MOST_MEETINGS", 4)
    read_sheet(CROSS)
    monkeypatch.setattr(sheet, "MOST_ABOVE", 4)
    with pytest.raises(
        LimitError, match="pairs of boundary edges whose x-ranges overlap, 5, are more"
    ):
        read_sheet(CROSS)
    monkeypatch.setattr(sheet, "MOST_ABOVE", 5)
    monkeypatch.setattr(sheet, "MOST_MEETINGS", 3)
    with pytest.raises(LimitError, match="boundary edges whose boxes meet, 4, are more than the"):
        read_sheet(CROSS)


PANELS = {
    "radicands": [],
    "vertices": [[[x], [y]] for x, y in SQUARE],
    "edges": [[0, 1], [0, 3], [0, 4], [1, 2], [1, 4], [2, 3], [2, 4], [3, 4]],
}


def test_pairs_of_edges_of_panels(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(panel_sheet, "MOST_ABOVE", 23)
    monkeypatch.setattr(panel_sheet, "MOST_MEETINGS", 0)
    read_panels(PANELS)
    monkeypatch.setattr(panel_sheet, "MOST_ABOVE", 22)
    with pytest.raises(LimitError, match="the pairs of edges whose x-ranges overlap, 23, are more"):
        read_panels(PANELS)
    monkeypatch.setattr(panel_sheet, "MOST_ABOVE", 23)
    near = copy.deepcopy(PANELS)
    near["vertices"][4] = [["4"], ["2"]]
    with pytest.raises(LimitError, match="the pairs of edges whose boxes meet, 2, are more than"):
        read_panels(near)


def fan(number: int) -> PanelSheet:
    """Panels round one vertex inside a polygon that is nearly a circle."""
    points = [(Fraction(0), Fraction(0))]
    for k in range(number):
        quarter, rest = divmod(4 * k, number)
        t = Fraction(rest, number)
        x, y = (1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)
        for _ in range(quarter):
            x, y = -y, x
        points.append((x, y))
    rim = [(k, k + 1) for k in range(1, number)] + [(1, number)]
    tower = Tower()
    vertices = [(tower.number(x), tower.number(y)) for x, y in points]
    return PanelSheet(tower, vertices, sorted([(0, k) for k in range(1, number + 1)] + rim))


def test_panels_round_one_vertex(monkeypatch: pytest.MonkeyPatch):
    """Edges with a common end are not compared with each other in pairs."""
    monkeypatch.setattr(panel_sheet, "MOST_MEETINGS", 2000)
    assert len(fan(800).panels) == 800


def test_long_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    file = tmp_path / "a.json"
    file.write_text(json.dumps(document("one vertex")))
    size = file.stat().st_size
    monkeypatch.setattr(command, "MOST_BYTES", size)
    checker.verify(file)
    monkeypatch.setattr(command, "MOST_BYTES", size - 1)
    with pytest.raises(LimitError, match=f"the bytes of the file, {size}, are more than the limit"):
        checker.verify(file)


def test_the_command_tells_a_limit_from_a_false_claim(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    data: dict[str, Any] = document("one vertex")
    data["pattern"]["vertices"][0][0] = "1" * 20_000
    file = tmp_path / "a.json"
    file.write_text(json.dumps(data))
    assert checker.main([str(file)]) == 3
    said = capsys.readouterr()
    message = "not checked: the digits of a coordinate, 20000, are more than the limit, 10000"
    where = " (MOST_COORDINATE in checker/core/limits.py)\n"
    assert (said.out, said.err) == ("", message + where)
