"""`exactfold examples` and `exactfold random`: patterns that come with exactfold or are drawn."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Literal, TypedDict

from exactfold._support.documents import Several
from exactfold._support.plurals import counted
from exactfold.app import report
from exactfold.app.shell.shell import Bar, sheet_written, wrote
from exactfold.errors import UsageError
from exactfold.pattern.data import example_path
from exactfold.pattern.data import examples as described
from exactfold.pattern.periodic.cell_files import cell_text
from exactfold.pattern.periodic.random_cells import random_cell
from exactfold.pattern.triangulating.random_squares import sample_random_square
from exactfold.pattern.writing.fold_writing import checked_target, fold_text, write_text


class Example(TypedDict):
    """A pattern that comes with exactfold."""

    name: str
    description: str
    path: str


class ExamplesDocument(TypedDict):
    """The patterns that come with exactfold."""

    format: Literal["exactfold examples result"]
    version: Literal[1]
    examples: Several[Example]


def show_examples(as_json: bool) -> None:
    """Print the patterns that come with exactfold."""
    if as_json:
        document: ExamplesDocument = {
            "format": "exactfold examples result",
            "version": 1,
            "examples": [
                {"name": name, "description": text, "path": str(example_path(name))}
                for name, text in described().items()
            ],
        }
        print(json.dumps(document))
    else:
        report.show(report.examples_report(described()))


def write_random_square(
    interior: int, seed: int, denominator: int, redraw: bool, output: Path | None
) -> None:
    """Write one of the paper's random squares as a FOLD file, or to standard output."""
    if output is not None and str(output) != "-":
        checked_target(output, (".fold", ".json"), "a sheet")
    title = f"random square, {interior} interior vertices, seed {seed}, denominator {denominator}"
    title += ", points redrawn" if redraw else ""
    with Bar("drawing"):
        sample = sample_random_square(interior, seed, denominator, redraw=redraw)
        text = fold_text(sample.pattern, title=title)
    if output is None or str(output) == "-":
        sys.stdout.write(text)
    else:
        write_text(output, text)
        wrote(output, sheet_written(sample.pattern))


def write_random_cell(
    vertices: int, seed: int, denominator: int, redraw: bool, output: Path | None
) -> None:
    """Write a random cell of a periodic sheet as plain JSON, or to standard output."""
    if redraw:
        raise UsageError("--redraw does not go with --torus: no cell is drawn anew for degree 3")
    if output is not None and str(output) != "-":
        checked_target(output, (".json",), "a cell")
    title = f"random cell, {vertices} vertices, seed {seed}, denominator {denominator}"
    cell = random_cell(vertices, seed, denominator)
    text = cell_text(cell, title)
    if output is None or str(output) == "-":
        sys.stdout.write(text)
    else:
        write_text(output, text)
        wrote(output, f"a periodic sheet: {counted(cell.V, 'vertex')} in the cell")
