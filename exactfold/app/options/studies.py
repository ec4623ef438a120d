"""The options of the command that runs studies, and their completion by the shell."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from exactfold.app.shell.parameters import Dask, Json, flag, number, written
from exactfold.app.shell.parsers import sizes
from exactfold.errors import UsageError


def _complete(incomplete: str) -> list[str]:
    """The studies whose names begin with the typed text."""
    from exactfold.studies.running.registry import MODULES

    return [name for name in MODULES if name.startswith(incomplete)]


def _numbers_of(ctx: typer.Context) -> dict[int, int]:
    """For each size, the number of rows of the named study; empty without a name."""
    from exactfold.studies.running.registry import MODULES, study_named

    # during completion, the words before an option are not assigned to arguments yet
    named = [word for word in (ctx.params.get("name"), *ctx.args) if word in MODULES]
    if not named:
        return {}
    study = study_named(named[0])
    extended = study.extended if ctx.params.get("extend") else {}
    return {size: n for size, n in {**study.numbers, **extended}.items() if n}


def _complete_sizes(ctx: typer.Context, incomplete: str) -> list[str]:
    """The sizes of the study, in the notation of the option."""
    from exactfold.app.shell.row_numbers import written_sizes

    text = written_sizes(_numbers_of(ctx))
    return [text] if text and text.startswith(incomplete) else []


def _complete_numbers(ctx: typer.Context, incomplete: str) -> list[str]:
    """The numbers of rows of the study by size, in the notation of the option."""
    from exactfold.app.shell.row_numbers import written_numbers

    text = written_numbers(_numbers_of(ctx))
    return [text] if text and text.startswith(incomplete) else []


@dataclass(frozen=True, eq=False, repr=False, match_args=False)
class StudyOptions:
    """The options of `exactfold study`."""

    name: Annotated[
        str | None,
        typer.Argument(
            metavar="NAME",
            autocompletion=_complete,
            help="The name of the study. Without it, all studies are listed.",
            show_default=False,
        ),
    ] = None
    panels: Annotated[
        bool,
        flag("--panels", text="Run the study of rigid panels: `selffold --panels`."),
    ] = False
    seed: Annotated[
        int,
        number(
            "Seed of the random samples. Random square k = 0, 1, ... with n interior vertices has "
            "the seed (100 S + n) 10^7 + k for `random --seed`.",
            "S",
            least=0,
        ),
    ] = 0
    sizes: Annotated[
        tuple[int, ...] | None,
        typer.Option(
            parser=sizes,
            metavar="SIZES",
            autocompletion=_complete_sizes,
            help="Only these sizes, such as 2-5,8. Sizes are usually numbers of interior vertices.",
        ),
    ] = None
    number: Annotated[
        str | None,
        typer.Option(
            "--number",
            metavar="N|SIZES:N,...",
            autocompletion=_complete_numbers,
            help="Number of rows of each size: one number for all sizes, or by size, such as "
            "2-4:1000,5:200. The latter runs only these sizes, unless --sizes or --extend adds "
            "others, which keep the numbers of the study. Default: as many as in the paper.",
        ),
    ] = None
    extend: Annotated[bool, flag("--extend", text="Also run the larger sizes of the study.")] = (
        False
    )
    workers: Annotated[int | None, number("Number of processes. Default: all cores.")] = None
    dask: Dask = None
    journal: Annotated[
        Path | None,
        written(
            "The file that keeps the rows: the same command continues it and does not compute a "
            "row in it again. Default: NAME.sqlite.",
            "FILE.sqlite",
        ),
    ] = None
    csv: Annotated[
        Path | None, written("Write the rows and their recipes as a table.", "OUT.csv")
    ] = None
    parquet: Annotated[Path | None, written("Write the same table as Parquet.", "OUT.parquet")] = (
        None
    )
    html: Annotated[
        Path | None,
        written("Write a report with tables and pictures, in one file.", "OUT.html"),
    ] = None
    figures: Annotated[
        Path | None,
        written("Write each picture into this folder, as SVG and as PDF.", "FOLDER"),
    ] = None
    row: Annotated[
        str | None,
        typer.Option(
            metavar="ID",
            help="Only compute this row of the journal again, and compare. The first digits of its "
            "name are enough.",
        ),
    ] = None
    as_json: Json = False

    def __post_init__(self) -> None:
        if not self.panels:
            return
        from exactfold.studies.running.registry import MODULES

        name = f"{self.name}-panels"
        if name not in MODULES:
            others = [one.removesuffix("-panels") for one in MODULES if one.endswith("-panels")]
            raise UsageError(f"--panels goes with {' and '.join(others)}")
        object.__setattr__(self, "name", name)
