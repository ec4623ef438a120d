"""Runs of studies: the rows that are missing are computed, on all cores or on a cluster."""

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
    """A study with the rows of a seed: `rows` can be gone through again, `computed` are new."""

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
        """The figures of the study, to be drawn by `exactfold.app.report`."""
        return tuple(self.study.figures(self.rows))

    @property
    def total(self) -> int:
        """How many rows there are."""
        return self.study.number(self.seed, self.numbers)

    @property
    def undecided(self) -> int:
        """How many rows are not proved."""
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
    """The rows of a study for a seed: those that the journal has, and the others computed.

    The result is the same for any number of `workers`. `numbers`: rows by size, by default those of
    the study. Each row is written to the `journal` as soon as it is ready, so that the same call
    goes on after an interruption; without a journal they are in memory. An `engine`, such as
    `dask_pool`, takes the place of the `workers`. `progress("computing", done, total)`.

    Raises `UsageError`, the errors of `RowStore`, and, once all others are written,
    `RowFailedError` for rows that ended with an error.

    >>> run = run_study("table1", numbers={2: 3})
    >>> [row["distinct"] for row in run.rows]
    [4, 4, 4]
    """
    found = study_named(study) if isinstance(study, str) else study
    if workers < 1:
        raise UsageError(f"at least one worker is needed, not {workers}")
    numbers = dict(found.numbers if numbers is None else numbers)
    recipes = _Plan(found, seed, numbers)
    done = engine or process_pool(workers)
    if journal is None:
        memory: dict[str, Row] = {}

        def keep(recipe: Recipe, row: Row) -> None:
            name = found.id_of(recipe)
            memory[name] = StoredRow(name, recipe, row).whole

        computed = _compute(found, recipes, set(), keep, done, progress)
        rows = tuple(memory[found.id_of(recipe)] for recipe in recipes)
        return StudyRun(found, seed, numbers, rows, computed, None)
    with RowStore(journal, found) as store:
        computed = _compute(found, recipes, store, store.add, done, progress)
    stored = StoredRows(store.path, found, recipes)
    return StudyRun(found, seed, numbers, stored, computed, store.path)


@dataclass(frozen=True, repr=False)
class Recomputed:
    """A row of a journal, computed once more; `agrees` if nothing differs."""

    study: Study
    stored: StoredRow
    row: Row

    def __repr__(self) -> str:
        return f"<Recomputed: {self.stored.id}, {'agrees' if self.agrees else 'differs'}>"

    @property
    def agrees(self) -> bool:
        """Whether the row is the one in the journal."""
        return canonical(self.row) == canonical(self.stored.row)

    @property
    def differing(self) -> tuple[str, ...]:
        """The names of what differs."""
        names = sorted({*self.row, *self.stored.row})
        missing = object()
        return tuple(
            name
            for name in names
            if self.row.get(name, missing) != self.stored.row.get(name, missing)
        )


def recompute_row(study: str | Study, journal: str | os.PathLike[str], name: str) -> Recomputed:
    """Compute a row of a journal once more, from its recipe alone.

    `name` may be cut short. Raises `InputError`, the errors of `RowStore` and those of the
    row.
    """
    found = study_named(study) if isinstance(study, str) else study
    stored = read_row(journal, found, name)
    return Recomputed(found, stored, normal(found.row(stored.recipe), stored.recipe))


def normal(row: Row, recipe: Recipe) -> dict[str, Any]:
    """A row as it comes back from the journal; raises `UsageError` for one that is no row."""
    if row.get("status") not in STATUSES:
        raise UsageError(f"the status of a row is one of {', '.join(STATUSES)}")
    shared = {"row", "sha256", *recipe} & set(row)
    if shared:
        raise UsageError(f"{min(shared)!r} is both of the recipe and of the row")
    try:
        found: dict[str, Any] = json.loads(canonical(row))
    except (ValueError, TypeError) as error:
        raise UsageError(f"a row holds what JSON does not: {error}") from None
    return found


@dataclass(frozen=True)
class _Plan:
    """The recipes of a run, made anew each time they are gone through."""

    study: Study
    seed: int
    numbers: Mapping[int, int]

    def __iter__(self) -> Iterator[Recipe]:
        return iter(self.study.recipes(self.seed, self.numbers))


@dataclass(frozen=True)
class _Work:
    """What a worker does with a recipe; an error ends this row and no other."""

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
    """Compute and keep the rows that are not known; how many there were."""

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
            f"{counted(len(failed), 'row')} ended with an error, one with the recipe "
            f"{canonical(recipe)}: {type(error).__name__}: {error}"
        ) from error
    return total
