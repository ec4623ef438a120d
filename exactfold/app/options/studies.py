"""What the command that runs studies takes: its options, and how the shell completes them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from exactfold.app.shell.parameters import Dask, Json, flag, number, sizes, written


def _complete(incomplete: str) -> list[str]:
    """The studies that begin with what is typed."""
    from exactfold.studies.running.registry import MODULES

    return [name for name in MODULES if name.startswith(incomplete)]


def _numbers_of(ctx: typer.Context) -> dict[int, int]:
    """The numbers of rows, by size, of the study that is named; none without a name."""
    from exactfold.studies.running.registry import MODULES, study_named

    # while the shell completes an option, the words before it are not given to the arguments yet
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


@dataclass(frozen=True)
class StudyOptions:
    """What `exactfold study` takes."""

    name: Annotated[
        str | None,
        typer.Argument(
            metavar="NAME",
            autocompletion=_complete,
            help="The study. Without a name, the studies are listed.",
            show_default=False,
        ),
    ] = None
    seed: Annotated[
        int,
        number(
            "Seed of all that is drawn at random. The k-th square with n interior vertices, from 0 "
            "on, has the seed (100 S + n) 10^7 + k: see `random --seed`.",
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
            help="Only these sizes, such as 2-5,8: most often numbers of interior vertices.",
        ),
    ] = None
    number: Annotated[
        str | None,
        typer.Option(
            "--number",
            metavar="N|SIZES:N,...",
            autocompletion=_complete_numbers,
            help="Rows of each size: one number for all, or by size, such as 2-4:1000,5:200; "
            "then these sizes only, unless --sizes or --extend names more, which keep the "
            "study's numbers. Default: as many as in the paper.",
        ),
    ] = None
    extend: Annotated[bool, flag("--extend", text="Also the larger sizes of the study.")] = False
    workers: Annotated[int | None, number("Processes. Default: all cores.")] = None
    dask: Dask = None
    journal: Annotated[
        Path | None,
        written(
            "Where rows are kept: the same command goes on with them, and a row that is there is "
            "not computed again. Default: NAME.sqlite.",
            "FILE.sqlite",
        ),
    ] = None
    csv: Annotated[Path | None, written("Write the rows as a table, with recipes.", "OUT.csv")] = (
        None
    )
    parquet: Annotated[Path | None, written("The same for Parquet.", "OUT.parquet")] = None
    html: Annotated[
        Path | None,
        written("Write a report with tables and pictures, one file.", "OUT.html"),
    ] = None
    figures: Annotated[
        Path | None,
        written("Write each picture into this folder, as SVG and as PDF.", "FOLDER"),
    ] = None
    row: Annotated[
        str | None,
        typer.Option(
            metavar="ID",
            help="Instead: compute one row of the journal again, and compare. The first digits "
            "of its name are enough.",
        ),
    ] = None
    as_json: Json = False
