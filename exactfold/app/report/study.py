"""What `exactfold study` prints: the studies, their tables, and a row computed again."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from rich.console import Group
from rich.table import Table
from rich.text import Text

from exactfold._support.plurals import counted
from exactfold.studies.running.runner import Recomputed, StudyRun
from exactfold.studies.running.study import Study, StudyTable


def studies_report(studies: Mapping[str, Study]) -> Table:
    """A line for each study."""
    table = Table(box=None, pad_edge=False)
    table.add_column("study", style="bold")
    table.add_column("patterns", justify="right")
    table.add_column("what it shows", overflow="fold")
    for name, study in studies.items():
        table.add_row(name, str(sum(study.numbers.values())), study.about)
    return table


def study_report(run: StudyRun, written: Iterable[str]) -> Group:
    """The tables of a study, and where its rows are stored."""
    parts: list[Any] = []
    for table in run.tables:
        parts += [Text(table.title, "bold"), "", table_of(table), *map(Text, table.notes), ""]
    text = f"{counted(run.total, 'row')} of seed {run.seed}, {run.computed} computed now"
    if run.undecided:
        text += f", {run.undecided} undecided"
    files = ([] if run.journal is None else [f"rows in {run.journal}"]) + list(written)
    return Group(*parts, Text("; ".join([text, *files])))


def table_of(table: StudyTable) -> Table:
    """A table of a study; columns of numbers are aligned to the right."""
    shown = Table(box=None, pad_edge=False)
    for name, words in zip(table.columns, table.words, strict=True):
        shown.add_column(name, justify="left" if words else "right")
    for row in table.rows:
        shown.add_row(*("" if cell is None else str(cell) for cell in row))
    return shown


def row_report(row: Recomputed) -> Group:
    """A row of a journal beside the row that was computed again."""
    table = Table(box=None, pad_edge=False)
    table.add_column("value", style="bold")
    table.add_column("in the journal", overflow="fold")
    table.add_column("computed again", overflow="fold")
    for name, value in row.stored.recipe.items():
        table.add_row(name, str(value), "")
    for name in sorted({*row.stored.row, *row.row}):
        style = "bold red" if name in row.differing else ""
        values = (source.get(name, "missing") for source in (row.stored.row, row.row))
        table.add_row(name, *(Text("-" if v is None else str(v), style) for v in values))
    answer = "agrees" if row.agrees else f"differs in {', '.join(row.differing)}"
    return Group(
        Text(f"{row.study.name}, row {row.stored.id}: {answer}", "bold"),
        Text(f"SHA-256 of recipe and row: {row.stored.sha256}"),
        "",
        table,
    )
