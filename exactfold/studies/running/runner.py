"""Runs studies: computes the missing rows, on all cores or on a cluster."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import closing
from dataclasses import dataclass
from typing import Any

from exactfold._support.plurals import counted
from exactfold._support.progress import Progress
from exactfold._support.verdict import UNDECIDED
from exactfold.branches.counting.pools import Pool, process_pool
from exactfold.errors import RowFailedError, UsageError
from exactfold.studies.running.registry import study_named
from exactfold.studies.running.store import RowStore, StoredRow, StoredRows, read_row
from exactfold.studies.running.study import (
    STATUSES,
    Recipe,
    Row,
    Study,
    StudyFigure,
    StudyTable,
    canonical,
)


@dataclass(frozen=True, repr=False)
class StudyRun:
    """A study with the rows of a seed; `computed` of them are new. `rows` can be read again."""

    study: Study
    seed: int
    numbers: Mapping[int, int]
    rows: Iterable[Row]
    computed: int
    journal: str | None

    @property
    def tables(self) -> tuple[StudyTable, ...]:
        """The tables of the study."""
        return tuple(self.study.tables(self.rows))

    @property
    def figures(self) -> tuple[StudyFigure, ...]:
        """The figures of the study; `exactfold.app.report` draws them."""
        return tuple(self.study.figures(self.rows))

    @property
    def total(self) -> int:
        """The number of rows."""
        return self.study.number(self.seed, self.numbers)

    @property
    def undecided(self) -> int:
        """The number of rows that are not proved."""
        return sum(row["status"] == str(UNDECIDED) for row in self.rows)

    def __repr__(self) -> str:
        return f"<StudyRun: {self.study.name}, seed {self.seed}, {counted(self.total, 'row')}>"


def run_study(
    study: str | Study,
    journal: str | os.PathLike[str] | None = None,
    *,
    seed: int = 0,
    numbers: Mapping[int, int] | None = None,
    workers: int = 1,
    engine: Pool | None = None,
    progress: Progress | None = None,
) -> StudyRun:
    """The rows of a study for a seed: rows of the journal are read, the others are computed.

    The result is the same for any number of `workers`. `numbers` are the numbers of rows by size,
    by default those of the study. Each row is written to the `journal` as soon as it is ready, so
    that the same call continues after an interruption. Without a journal, rows are kept in memory.
    An `engine`, such as `dask_pool`, replaces the `workers`. `progress("computing", done, total)`
    is called after each row.

    Raises `UsageError`, the errors of `RowStore`, and `RowFailedError` for rows that ended
    with an error, after all other rows are written.

    >>> run = run_study("table1", numbers={2: 3})
    >>> [row["distinct"] for row in run.rows]
    [4, 4, 4]
    """
    chosen_study = study_named(study) if isinstance(study, str) else study
    if workers < 1:
        raise UsageError(f"the number of workers must be at least one, not {workers}")
    numbers = dict(chosen_study.numbers if numbers is None else numbers)
    recipes = _Plan(chosen_study, seed, numbers)
    done = engine or process_pool(workers)
    if journal is None:
        memory: dict[str, Row] = {}

        def keep(recipe: Recipe, row: Row) -> None:
            name = chosen_study.id_of(recipe)
            memory[name] = StoredRow(name, recipe, row).whole

        computed = _compute(chosen_study, recipes, set(), keep, done, progress)
        rows = tuple(memory[chosen_study.id_of(recipe)] for recipe in recipes)
        return StudyRun(chosen_study, seed, numbers, rows, computed, None)
    with RowStore(journal, chosen_study) as store:
        computed = _compute(chosen_study, recipes, store, store.add, done, progress)
    stored = StoredRows(store.path, chosen_study, recipes)
    return StudyRun(chosen_study, seed, numbers, stored, computed, store.path)


@dataclass(frozen=True, repr=False)
class Recomputed:
    """A row of a journal and the same row computed again; `agrees` if nothing differs."""

    study: Study
    stored: StoredRow
    row: Row

    def __repr__(self) -> str:
        return f"<Recomputed: {self.stored.id}, {'agrees' if self.agrees else 'differs'}>"

    @property
    def agrees(self) -> bool:
        """Whether the computed row equals the row in the journal."""
        return canonical(self.row) == canonical(self.stored.row)

    @property
    def differing(self) -> tuple[str, ...]:
        """The names of the values that differ."""
        names = sorted({*self.row, *self.stored.row})
        missing = object()
        return tuple(
            name
            for name in names
            if self.row.get(name, missing) != self.stored.row.get(name, missing)
        )


def recompute_row(study: str | Study, journal: str | os.PathLike[str], name: str) -> Recomputed:
    """Computes a row of a journal again, from its recipe alone.

    `name` may be abbreviated. Raises `InputError`, the errors of `RowStore` and those of the
    row.
    """
    chosen_study = study_named(study) if isinstance(study, str) else study
    stored = read_row(journal, chosen_study, name)
    return Recomputed(chosen_study, stored, normal(chosen_study.row(stored.recipe), stored.recipe))


def normal(row: Row, recipe: Recipe) -> dict[str, Any]:
    """A row in the form in which the journal returns it; raises `UsageError` if it is not a row."""
    if row.get("status") not in STATUSES:
        raise UsageError(f"the status of a row must be one of {', '.join(STATUSES)}")
    shared = {"row", "sha256", *recipe} & set(row)
    if shared:
        raise UsageError(
            f"{min(shared)!r} is a name both in the recipe and in the row: rename it in the row"
        )
    try:
        normal_row: dict[str, Any] = json.loads(canonical(row))
    except (ValueError, TypeError) as error:
        raise UsageError(f"a row contains a value that JSON cannot express: {error}") from None
    return normal_row


@dataclass(frozen=True)
class _Plan:
    """The recipes of a run; each iteration makes them anew."""

    study: Study
    seed: int
    numbers: Mapping[int, int]

    def __iter__(self) -> Iterator[Recipe]:
        return iter(self.study.recipes(self.seed, self.numbers))


@dataclass(frozen=True)
class _Work:
    """The job of a worker for a recipe; an error ends this row and no other."""

    row: Callable[[Recipe], Row]

    def __call__(self, recipe: Recipe) -> Row | Exception:
        try:
            return normal(self.row(recipe), recipe)
        except Exception as error:
            return error


def _compute(
    study: Study,
    recipes: Iterable[Recipe],
    known: RowStore | set[str],
    keep: Callable[[Recipe, Row], None],
    pool: Pool,
    progress: Progress | None,
) -> int:
    """Computes and keeps the rows that are not known; returns their number."""

    def missing() -> Iterator[Recipe]:
        return (recipe for recipe in recipes if study.id_of(recipe) not in known)

    total = sum(1 for _ in missing())
    failed: list[tuple[Recipe, Exception]] = []
    if not total:
        return 0
    with closing(pool(_Work(study.row), missing())) as results:
        for done, (recipe, row) in enumerate(results, 1):
            if isinstance(row, Exception):
                failed.append((recipe, row))
            else:
                keep(recipe, row)
            if progress is not None:
                progress("computing", done, total)
    if failed:
        recipe, error = failed[0]
        raise RowFailedError(
            f"{counted(len(failed), 'row')} ended with an error, the first one with the recipe "
            f"{canonical(recipe)}: {type(error).__name__}: {error}"
        ) from error
    return total
