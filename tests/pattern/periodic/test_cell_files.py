"""Files of cells: plain JSON and FOLD, and what is wrong with them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from exactfold.errors import FoldError, InputError, NotFoldError, NumberError, UsageError
from exactfold.pattern import PeriodicPattern, cell_document, read_cell
from exactfold.pattern.opening import open_pattern
from exactfold.pattern.periodic.cell_files import as_cell, cell_text

GRID: dict[str, Any] = {
    "format": "exactfold periodic pattern",
    "lattice": [["1", "0"], ["1/3", "1"]],
    "points": [["0", "1/7"]],
    "faces": [[[0, 0, 0], [0, 1, 0], [0, 1, 1]], [[0, 0, 0], [0, 1, 1], [0, 0, 1]]],
}
FOLD: dict[str, Any] = {
    "vertices_coords": [[0, 0.25]],
    "faces_vertices": [[0, 0, 0], [0, 0, 0]],
    "frame_exactfold:lattice": [["1", "0"], ["0", "1"]],
    "faces_exactfold:offsets": [[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]],
}


def test_every_way_in_leads_to_the_same_cell(tmp_path: Path) -> None:
    cell = read_cell(GRID)
    assert cell == as_cell(cell) == read_cell(json.dumps(GRID)) == read_cell(cell_document(cell))
    file = tmp_path / "grid.json"
    file.write_text(cell_text(cell, "a grid"))
    assert json.loads(file.read_text())["title"] == "a grid"
    assert read_cell(file) == read_cell(str(file)) == cell


def test_fold_with_a_lattice() -> None:
    cell = read_cell(json.dumps(FOLD))
    assert cell == PeriodicPattern([(1, 0), (0, 1)], [(0, "1/4")], GRID["faces"])
    exact = {**FOLD, "vertices_exactfold:coords": [["0", "1/4"]]}
    assert read_cell(exact) == cell
    whole = {**FOLD, "frame_exactfold:lattice": [[1, 0], [0, 1]]}
    assert read_cell(whole) == cell


@pytest.mark.parametrize(
    ("document", "error", "message"),
    [
        ({**GRID, "format": "other"}, NotFoldError, "not the cell of a periodic sheet"),
        ({**GRID, "points": "0"}, NotFoldError, "`points` is '0', not a list"),
        ({**GRID, "lattice": [["1", "x"], ["0", "1"]]}, NumberError, "lattice vector 0: 'x'"),
        ({**FOLD, "frame_exactfold:lattice": 1}, NotFoldError, "1 is not a list of pairs"),
        ({**FOLD, "faces_exactfold:offsets": [[]]}, NotFoldError, "1 entries for 2 faces"),
        ({**FOLD, "faces_exactfold:offsets": [[], 1]}, NotFoldError, "face 0 in"),
        ({**FOLD, "faces_exactfold:offsets": [[1, 2, 3]] * 2}, InputError, "face 0: "),
    ],
)
def test_files_that_are_no_cells(document: Any, error: type[InputError], message: str) -> None:
    with pytest.raises(error, match=message):
        read_cell(json.dumps(document))


def test_messages_name_the_file(tmp_path: Path) -> None:
    file = tmp_path / "bad.json"
    file.write_text(json.dumps({**GRID, "points": []}))
    with pytest.raises(InputError, match=r"bad\.json: a periodic pattern needs"):
        read_cell(file)
    file.write_bytes(b'{"format": "exactfold periodic pattern \xff"}')
    with pytest.raises(NotFoldError, match=r"bad\.json: not UTF-8"):
        read_cell(file)


def test_other_commands_say_which_one_takes_a_cell(tmp_path: Path) -> None:
    file = tmp_path / "grid.json"
    for document in (GRID, FOLD):
        file.write_text(json.dumps(document))
        with pytest.raises(
            FoldError, match="cell of a periodic sheet, which only `exactfold count"
        ):
            open_pattern(file)


def test_what_is_no_sheet_at_all() -> None:
    with pytest.raises(UsageError, match="3 is not a periodic sheet"):
        as_cell(3)
