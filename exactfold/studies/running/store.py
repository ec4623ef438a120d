"""Rows of a study in an SQLite file: the journal with which an interrupted run continues."""

from __future__ import annotations

import io
import json
import os
import sqlite3
from collections.abc import Iterable, Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass
from typing import Any

from exactfold.certificates.durable import locked, unwritable
from exactfold.errors import ForeignJournalError, InputError
from exactfold.studies.running.study import Recipe, Row, Study, canonical, digest

FORMAT = "exactfold study rows"
VERSION = 1

_MAGIC = b"SQLite format 3\0"
_FULL = (sqlite3.SQLITE_FULL, sqlite3.SQLITE_IOERR, sqlite3.SQLITE_READONLY)
_TABLES = """
CREATE TABLE about (name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE rows (
    id TEXT PRIMARY KEY, recipe TEXT NOT NULL, row TEXT NOT NULL, sha256 TEXT NOT NULL
) WITHOUT ROWID;
"""


@dataclass(frozen=True, repr=False)
class StoredRow:
    """A row of a journal: its name, its recipe, and its values."""

    id: str
    recipe: Recipe
    row: Row

    def __repr__(self) -> str:
        return f"<StoredRow: {self.id}, {self.row['status']}>"

    @property
    def sha256(self) -> str:
        """The SHA-256 of recipe and row as JSON; the journal stores it beside them."""
        return digest([self.recipe, self.row])

    @property
    def whole(self) -> dict[str, Any]:
        """Name, recipe, row and digest in one mapping, for tables, figures and files."""
        return {"row": self.id, **self.recipe, **self.row, "sha256": self.sha256}


class RowStore:
    """The journal of a study, open for more rows; only one process at a time writes it.

    Each row is committed by itself (SQLite, write-ahead log). A run that is killed loses only the
    rows under way, and no row is there twice. Raises `JournalInUseError`, `UnwritableFileError`,
    and `ForeignJournalError` for the journal of another study or version and for a file that is not
    a journal. Such files are not changed.
    """

    def __init__(self, path: str | os.PathLike[str], study: Study) -> None:
        self.path, self.study = os.fspath(path), study
        new = _check_kind(self.path)
        self._lock: io.FileIO = locked(self.path)
        try:
            with _told(self.path):
                self._rows = sqlite3.connect(self.path, isolation_level=None)
                if new:
                    self._rows.execute("PRAGMA journal_mode=WAL")
                    about = _about(study)
                    inserted = "".join(
                        f"INSERT INTO about VALUES ('{name}', '{value}');"
                        for name, value in about.items()
                    )
                    self._rows.executescript(f"BEGIN;{_TABLES}{inserted}COMMIT;")
                _check_about(self._rows, self.path, study)
                self._rows.execute("PRAGMA synchronous=NORMAL")
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> RowStore:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __contains__(self, row: str) -> bool:
        with _told(self.path):
            match = self._rows.execute("SELECT 1 FROM rows WHERE id = ?", (row,)).fetchone()
        return match is not None

    def __len__(self) -> int:
        with _told(self.path):
            return int(self._rows.execute("SELECT count(*) FROM rows").fetchone()[0])

    def add(self, recipe: Recipe, row: Row) -> None:
        """Writes one row completely; raises `UnwritableFileError`."""
        stored = StoredRow(self.study.id_of(recipe), recipe, row)
        values = (stored.id, canonical(recipe), canonical(row), stored.sha256)
        with _told(self.path):
            self._rows.execute("INSERT INTO rows VALUES (?, ?, ?, ?)", values)

    def close(self) -> None:
        """Merges the write-ahead log into the file, and releases the file."""
        if hasattr(self, "_rows"):
            self._rows.close()
        self._lock.close()


@dataclass(frozen=True)
class StoredRows:
    """The rows of some recipes in a journal, in the order of the recipes.

    Each iteration reads them from the file. Recipes without a row are left out. Raises
    `ForeignJournalError` for a row that differs from what was written.
    """

    path: str
    study: Study
    recipes: Iterable[Recipe]

    def __iter__(self) -> Iterator[Row]:
        with _reading(self.path, self.study) as rows:
            for recipe in self.recipes:
                stored = _row(rows, self.path, self.study, self.study.id_of(recipe))
                if stored is not None:
                    yield stored.whole


def read_row(path: str | os.PathLike[str], study: Study, name: str) -> StoredRow:
    """The row whose name begins with a given text.

    Raises `InputError` if there is no such row or several, and the errors of `RowStore`.
    """
    path = os.fspath(path)
    if not os.path.exists(path):
        raise InputError(f"there is no journal {path}: run the study first")
    with _reading(path, study) as rows, _told(path):
        matches = rows.execute(
            "SELECT id FROM rows WHERE substr(id, 1, ?) = ? LIMIT 2", (len(name), name)
        ).fetchall()
        if len(matches) != 1:
            what = "no row" if not matches else "more than one row"
            raise InputError(f"{path} has {what} whose name begins with {name!r}")
        row = _row(rows, path, study, matches[0][0])
    if row is None:  # although its name was read a moment ago
        raise ForeignJournalError(f"{path} lost the row {name}")
    return row


@contextmanager
def _reading(path: str, study: Study) -> Iterator[sqlite3.Connection]:
    if _check_kind(path):
        raise ForeignJournalError(f"{path} is empty: it is not the journal of a study")
    with _told(path):
        rows = sqlite3.connect(path, isolation_level=None)
    with closing(rows):
        with _told(path):
            _check_about(rows, path, study)
        yield rows


def _row(rows: sqlite3.Connection, path: str, study: Study, name: str) -> StoredRow | None:
    with _told(path):
        cursor = rows.execute("SELECT recipe, row, sha256 FROM rows WHERE id = ?", (name,))
        texts = cursor.fetchone()
    if texts is None:
        return None
    try:
        stored = StoredRow(name, json.loads(texts[0]), json.loads(texts[1]))
        good = (study.id_of(stored.recipe), stored.sha256) == (name, texts[2])
    except (ValueError, TypeError):
        good = False
    if not good:
        raise ForeignJournalError(f"{path}: the row {name} differs from what was written")
    return stored


def _about(study: Study) -> dict[str, str]:
    return {
        "format": FORMAT,
        "version": str(VERSION),
        "study": study.name,
        "study version": str(study.version),
    }


def _check_about(rows: sqlite3.Connection, path: str, study: Study) -> None:
    tables = {name for (name,) in rows.execute("SELECT name FROM sqlite_master")}
    if not {"about", "rows"} <= tables:
        raise ForeignJournalError(f"{path} is not the journal of a study")
    about = dict(rows.execute("SELECT name, value FROM about"))
    if (about.get("format"), about.get("version")) != (FORMAT, str(VERSION)):
        raise ForeignJournalError(f"{path} is not the journal of a study")
    if about != _about(study):
        other = f"{about.get('study')}, version {about.get('study version')}"
        raise ForeignJournalError(
            f"{path} contains rows of the study {other}, not of {study.name}, version "
            f"{study.version}: name another file"
        )


def _check_kind(path: str) -> bool:
    """Whether the journal is new; raises an error for a file of another kind, and leaves it."""
    try:
        with open(path, "rb") as file:
            begin = file.read(len(_MAGIC))
    except FileNotFoundError:
        return True
    except OSError as error:
        raise unwritable(path, error) from None
    if begin and begin != _MAGIC:
        raise ForeignJournalError(f"{path} is not the journal of a study")
    return not begin


@contextmanager
def _told(path: str) -> Iterator[None]:
    """Turns errors of SQLite into errors of this package."""
    try:
        yield
    except sqlite3.DatabaseError as error:
        code = getattr(error, "sqlite_errorcode", 0) & 0xFF
        if code in _FULL or code == sqlite3.SQLITE_CANTOPEN:
            raise unwritable(path, OSError(str(error))) from None
        raise ForeignJournalError(f"{path} is damaged: {error}") from None
