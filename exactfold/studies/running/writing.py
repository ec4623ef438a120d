"""Writes the rows of a study as files for other programs: CSV, Parquet, and frames of pandas."""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from exactfold.errors import PackageMissingError
from exactfold.pattern.writing.fold_writing import checked_target, write_bytes
from exactfold.studies.running.study import Row, canonical

_INSTALL = "pip install 'exactfold[study]'"
_BATCH = 10_000


def columns(rows: Iterable[Row]) -> list[str]:
    """The names of all values, in the order of their first occurrence."""
    names: dict[str, None] = {}
    for row in rows:
        names.update(dict.fromkeys(row))
    return list(names)


def write_csv(rows: Iterable[Row], path: str | os.PathLike[str]) -> None:
    """Writes rows as CSV (RFC 4180, UTF-8): a header, None as an empty field, lists as JSON.

    Raises `UsageError` if the file name does not end in .csv, and `UnwritableFileError`.
    """
    checked_target(Path(path), (".csv",), "a table")
    text = io.StringIO(newline="")
    names = columns(rows)
    writer = csv.writer(text, lineterminator="\r\n")
    writer.writerow(names)
    writer.writerows([_field(row.get(name)) for name in names] for row in rows)
    write_bytes(path, text.getvalue().encode("utf-8"))


def _field(value: Any) -> Any:
    return canonical(value) if isinstance(value, list | dict | bool) else value


def check_parquet() -> None:
    """Raises `PackageMissingError` unless Parquet files can be written."""
    try:
        import pyarrow.parquet  # noqa: F401
    except ImportError:
        raise PackageMissingError(f"Parquet files need pyarrow: {_INSTALL}") from None


def write_parquet(rows: Iterable[Row], path: str | os.PathLike[str]) -> None:
    """Writes rows as a Parquet file, with pyarrow, which is in the extra `exactfold[study]`.

    Raises `PackageMissingError` without pyarrow, `UsageError` if the file name does not end in
    .parquet, and `UnwritableFileError`.
    """
    checked_target(Path(path), (".parquet",), "a table")
    check_parquet()
    import pyarrow as pa
    import pyarrow.parquet as pq

    names = columns(rows)
    parts = [
        pa.Table.from_pylist([{name: row.get(name) for name in names} for row in part])
        for part in _parts(rows)
    ]
    table = pa.concat_tables(parts, promote_options="permissive") if parts else pa.table({})
    sink = io.BytesIO()
    pq.write_table(table, sink)
    write_bytes(path, sink.getvalue())


def frame(rows: Iterable[Row]) -> Any:
    """The rows as a frame of pandas, which is in the extra `exactfold[study]`.

    Raises `PackageMissingError` without pandas.
    """
    try:
        import pandas as pd
    except ImportError:
        raise PackageMissingError(f"data frames need pandas: {_INSTALL}") from None
    return pd.DataFrame.from_records([dict(row) for row in rows], columns=columns(rows))


def _parts(rows: Iterable[Row]) -> Iterator[list[Row]]:
    part: list[Row] = []
    for row in rows:
        part.append(row)
        if len(part) == _BATCH:
            yield part
            part = []
    if part:
        yield part
