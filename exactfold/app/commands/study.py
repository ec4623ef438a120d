"""`exactfold study`: runs a study, or computes one of its rows again."""

from __future__ import annotations

import json
import shlex
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import Annotated, Any, Literal, TypedDict

from exactfold._support.documents import Digest, Keywords, Natural, Positive
from exactfold._support.memory import is_shortage, shortage
from exactfold._support.processes import available_cores
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED
from exactfold.app import report
from exactfold.app.options.studies import StudyOptions
from exactfold.app.shell.row_numbers import read_numbers, written_numbers, written_sizes
from exactfold.app.shell.shell import EXIT, Bar, apart, interruptible, stopped
from exactfold.branches.counting.on_dask import LOCAL
from exactfold.branches.counting.pools import Pool, dask_pool, process_pool
from exactfold.errors import (
    NotEnoughMemoryError,
    RowFailedError,
    UnwritableFileError,
    UsageError,
    WorkerDiedError,
)
from exactfold.pattern.writing.fold_writing import checked_target, write_bytes, write_text
from exactfold.studies import all_studies, recompute_row, run_study, study_named
from exactfold.studies.running.runner import StudyRun
from exactfold.studies.running.study import Study, TableDocument
from exactfold.studies.running.writing import check_parquet, write_csv, write_parquet


class ListedStudy(TypedDict):
    """A study that can be run."""

    study: str
    """Its name."""
    study_version: Positive
    """The version rises when rows change."""
    about: str
    numbers: dict[str, Natural]
    """The number of rows of each size."""
    extended: dict[str, Natural]
    """The number of rows of each size that --extend adds."""


class StudiesDocument(TypedDict):
    """The studies that can be run."""

    format: Literal["exactfold studies result"]
    version: Literal[1]
    studies: list[ListedStudy]


class StudyRowDocument(TypedDict):
    """A row of a journal, and the same row computed again."""

    format: Literal["exactfold study-row result"]
    version: Literal[1]
    study: str
    journal: str
    row: Annotated[str, Keywords(pattern="^[0-9a-f]{16}$")]
    """Its name, which follows from the study, its version and the recipe."""
    sha256: Digest
    """Digest of the recipe and the row as JSON with sorted keys and without blanks."""
    recipe: dict[str, Any]
    """The recipe from which the row is computed."""
    stored: dict[str, Any]
    """The row in the journal."""
    recomputed: dict[str, Any]
    """The row that was computed again."""
    agrees: bool
    differing: list[str]
    """The names of the columns in which the two rows differ."""


class StudyDocument(TypedDict):
    """The result of a run of a study."""

    format: Literal["exactfold study result"]
    version: Literal[1]
    study: str
    study_version: Positive
    """The version rises when rows change; a journal of another version is not read."""
    about: str
    seed: Natural
    numbers: dict[str, Natural]
    """The number of rows of each size."""
    rows: Natural
    """How many rows there are."""
    computed: Natural
    """The number of rows that were computed because the journal did not have them."""
    undecided: Natural
    """The number of rows that are not proved."""
    journal: str
    tables: list[TableDocument]
    files: list[str]
    """The files that were written besides the journal."""


class Wanted(StudyOptions):
    """The options of one call, and how they are answered."""

    def answer(self) -> int:
        """Run the study, or compute its row, print the answer, and return the exit code.

        Raises the errors of `run_study`, `recompute_row` and `dask_pool`, and `UsageError`.
        """
        if self.name is None:
            return self._list()
        study = study_named(self.name)
        return self._again(study) if self.row is not None else self._run(study)

    @property
    def _journal(self) -> Path:
        return self.journal or Path(f"{self.name}.sqlite")

    @property
    def _files(self) -> tuple[Path | None, ...]:
        return self.csv, self.parquet, self.html

    @property
    def _asks_for_rows(self) -> bool:
        given = (self.sizes, self.number, self.workers, self.dask, self.figures, *self._files)
        return self.extend or self.seed != 0 or any(value is not None for value in given)

    @property
    def again(self) -> str:
        """The command that makes the same tables and files."""
        words = ["exactfold", "study", str(self.name)]
        if self.seed:
            words += ["--seed", str(self.seed)]
        if self.sizes is not None:
            words += ["--sizes", written_sizes(self.sizes)]
        if self.number is not None:
            words += ["--number", written_numbers(read_numbers(self.number))]
        words += ["--extend"] if self.extend else []
        for key in ("journal", "csv", "parquet", "html", "figures"):
            if (value := getattr(self, key)) is not None:
                words += [f"--{key}", str(value)]
        return shlex.join(words)

    def _list(self) -> int:
        if self._asks_for_rows or self.row is not None or self.journal is not None:
            raise UsageError(f"name a study; the studies are: {', '.join(all_studies())}")
        if self.as_json:
            document: StudiesDocument = {
                "format": "exactfold studies result",
                "version": 1,
                "studies": [*map(_described, all_studies().values())],
            }
            print(json.dumps(document))
        else:
            report.show(report.studies_report(all_studies()))
        return EXIT[PROVED]

    def _again(self, study: Study) -> int:
        if self._asks_for_rows:
            raise UsageError("--row goes with --journal and --json only")
        recomputed = recompute_row(study, self._journal, str(self.row))
        if self.as_json:
            document: StudyRowDocument = {
                "format": "exactfold study-row result",
                "version": 1,
                "study": study.name,
                "journal": str(self._journal),
                "row": recomputed.stored.id,
                "sha256": recomputed.stored.sha256,
                "recipe": dict(recomputed.stored.recipe),
                "stored": dict(recomputed.stored.row),
                "recomputed": dict(recomputed.row),
                "agrees": recomputed.agrees,
                "differing": list(recomputed.differing),
            }
            print(json.dumps(document))
        else:
            report.show(report.row_report(recomputed))
        return EXIT[PROVED if recomputed.agrees else REFUTED]

    def _run(self, study: Study) -> int:
        if self.workers is not None and self.dask not in (None, LOCAL):
            raise UsageError(
                "a running cluster has its own workers: leave out --workers, or use --dask local"
            )
        self._check_files()
        given = None if self.number is None else read_numbers(self.number)
        numbers = study.chosen(self.sizes, given, extend=self.extend)
        if not study.number(self.seed, numbers):
            raise UsageError("no rows are asked for: raise --number, or choose other --sizes")
        with Bar("starting") as bar, self._resumable(), self._pool() as pool:
            run = run_study(
                study,
                self._journal,
                seed=self.seed,
                numbers=numbers,
                engine=pool,
                progress=_with_rate(bar),
            )
            bar("reading the rows")
            undecided = run.undecided
            tables = [table.to_dict() for table in run.tables] if self.as_json else []
            bar("writing")
            written = self._write(run)
        if self.as_json:
            print(json.dumps(_document(run, str(self._journal), undecided, tables, written)))
        else:
            report.show(report.study_report(run, written))
        return EXIT[UNDECIDED if undecided else PROVED]

    def _check_files(self) -> None:
        """Raise, before anything is computed, if an output could not be written."""
        for path, ending in zip(self._files, (".csv", ".parquet", ".html"), strict=True):
            if path is not None:
                checked_target(path, (ending,), "this output")
                apart(path, self._journal, *(other for other in self._files if other is not path))
        if self.figures is not None and self.figures.exists() and not self.figures.is_dir():
            raise UsageError(f"{self.figures} is not a folder")
        if self.parquet is not None:
            check_parquet()
        if self.html is not None or self.figures is not None:
            report.check_figures()

    def _write(self, run: StudyRun) -> list[str]:
        """Write all requested files and return their names."""
        written = [str(path) for path in self._files if path is not None]
        if self.csv is not None:
            write_csv(run.rows, self.csv)
        if self.parquet is not None:
            write_parquet(run.rows, self.parquet)
        if self.html is not None:
            write_text(self.html, report.study_page(run, self.again))
        if self.figures is not None:
            try:
                self.figures.mkdir(exist_ok=True)
            except OSError as error:
                raise UnwritableFileError(
                    f"cannot write {self.figures}: {error.strerror}"
                ) from None
            for figure in run.figures:
                for kind in ("svg", "pdf"):
                    path = self.figures / f"{run.study.name}-{figure.name}.{kind}"
                    write_bytes(path, report.drawn(figure, kind))
                    written.append(str(path))
        return written

    @contextmanager
    def _pool(self) -> Iterator[Pool]:
        ready = nullcontext(process_pool(self.workers or available_cores()))
        with ready if self.dask is None else dask_pool(self.dask, self.workers) as pool:
            yield pool

    @contextmanager
    def _resumable(self) -> Iterator[None]:
        """If the study stops early, say how to continue it."""
        again = "the same command goes on"
        try:
            with interruptible():
                yield
        except KeyboardInterrupt:
            stopped(again)
        except RowFailedError as error:
            raise RowFailedError(f"{error}; the same command tries them again") from None
        except (WorkerDiedError, UnwritableFileError) as error:
            raise type(error)(f"{error}; {again}") from None
        except Exception as error:
            if not is_shortage(error):
                raise
            raise NotEnoughMemoryError(f"{shortage(error)}; {again}") from None


def _document(
    run: StudyRun, journal: str, undecided: int, tables: list[TableDocument], files: list[str]
) -> StudyDocument:
    return {
        "format": "exactfold study result",
        "version": 1,
        "study": run.study.name,
        "study_version": run.study.version,
        "about": run.study.about,
        "seed": run.seed,
        "numbers": {str(size): number for size, number in run.numbers.items()},
        "rows": run.total,
        "computed": run.computed,
        "undecided": undecided,
        "journal": journal,
        "tables": tables,
        "files": files,
    }


def _described(study: Study) -> ListedStudy:
    return {
        "study": study.name,
        "study_version": study.version,
        "about": study.about,
        "numbers": {str(size): number for size, number in study.numbers.items()},
        "extended": {str(size): number for size, number in study.extended.items()},
    }


def _with_rate(bar: Bar, clock: Callable[[], float] = time.monotonic) -> Progress:
    """A progress function that also shows how many rows are ready per second."""
    start = clock()

    def progress(stage: str, done: int, total: int) -> None:
        passed = clock() - start
        bar(stage, done, total, f", {done / passed:.3g} a second" if passed > 1 else "")

    return progress
