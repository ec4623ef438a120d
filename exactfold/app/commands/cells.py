"""Reads the cell of a periodic sheet: from a file, or from a drawing that shows one."""

from __future__ import annotations

from pathlib import Path

from exactfold._support.plurals import counted
from exactfold.app.shell.patterns import located, read_any
from exactfold.app.shell.shell import name_of, say
from exactfold.app.verbs.counting import opened_cell
from exactfold.errors import UsageError
from exactfold.exact.numbers import format_rational
from exactfold.pattern.drawing.bounds import read_bytes
from exactfold.pattern.opening import Opened, is_cell_file
from exactfold.pattern.periodic.cells import Side
from exactfold.pattern.periodic.periodic_pattern import PeriodicPattern
from exactfold.pattern.reading import Reading


def asked_cell(
    file: Path, reading: Reading, number: tuple[int, int] | None, *, verbose: bool
) -> PeriodicPattern:
    """The cell in the file; or the one that a drawing shows, which a line describes.

    `number` is the value of --cell. Raises the errors of `read_any` and `opened_cell`.
    """
    return _asked(file, reading, number, verbose=verbose)[0]


def asked_cell_with_letters(
    file: Path, reading: Reading, number: tuple[int, int] | None, *, verbose: bool
) -> tuple[PeriodicPattern, dict[Side, str]]:
    """The same, with the letters of a drawing by edges of the cell; there are none in a cell file.

    Raises the errors of `drawn_letters`, too.
    """
    from exactfold.pattern.periodic.drawn import drawn_letters

    cell, opened = _asked(file, reading, number, verbose=verbose)
    if opened is None:
        return cell, {}
    return cell, drawn_letters(opened.sheet, opened.letters, number or (1, 1))


def _asked(
    file: Path, reading: Reading, number: tuple[int, int] | None, *, verbose: bool
) -> tuple[PeriodicPattern, Opened | None]:
    from exactfold.pattern.periodic.cell_files import parse_cell_bytes
    from exactfold.pattern.periodic.drawn import other_lattices, repeated

    path = located(file)
    if is_cell_file(path):
        if number is not None:
            raise UsageError(f"{file} is a cell: leave out --cell")
        return parse_cell_bytes(read_bytes(path), name_of(file)), None
    opened = read_any(file, reading, verbose=verbose, doubted=False)
    cell = opened_cell(opened, number or (1, 1))
    first, second = (", ".join(map(format_rational, vector)) for vector in cell.lattice)
    say(
        f"taken for a periodic sheet with {counted(cell.V, 'vertex')} in a cell and the "
        f"translations ({first}) and ({second}); the border of the drawing counts as creases"
    )
    if others := other_lattices(opened.sheet):
        texts = [f"({', '.join(map(format_rational, vector))})" for vector in others[0]]
        say(
            f"its border matches itself in {counted(len(others), 'other way')}, too, such as "
            f"with {' and '.join(texts)}: a cell file says which is meant"
        )
    if number is None and (most := repeated(opened.sheet)) != (1, 1):
        say(
            f"it shows {most[0]} x {most[1]} equal cells: --cell {most[0]},{most[1]} takes one "
            "of them"
        )
    return cell, opened
