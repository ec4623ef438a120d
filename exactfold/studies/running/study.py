"""The parts of a study: recipes, a row for each, and tables and figures made of the rows."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeAlias, TypedDict

from exactfold._support.plurals import counted
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.errors import UsageError

Recipe: TypeAlias = Mapping[str, int | str]
"""The numbers and texts, by name, from which a row is made, such as a size and a seed."""

Row: TypeAlias = Mapping[str, Any]
"""The values that were found, by name; for tables and figures also the recipe and its `row`."""

Cell: TypeAlias = int | str | None
"""The content of a cell of a table; None for an empty cell."""


class TableDocument(TypedDict):
    """A table of a study."""

    name: str
    title: str
    columns: list[str]
    rows: list[list[Cell]]
    notes: list[str]


STATUSES = (str(PROVED), str(UNDECIDED))
"""The possible values of the key `status` of a row."""


@dataclass(frozen=True, repr=False)
class StudyTable:
    """A table of a study: plain values, which a terminal, a page or a program shows.

    `name` names the table in files; `notes` are whole sentences below it.
    """

    name: str
    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]
    notes: tuple[str, ...] = ()

    def __repr__(self) -> str:
        return f"<StudyTable: {self.name}, {counted(len(self.rows), 'row')}>"

    @property
    def words(self) -> tuple[bool, ...]:
        """Which columns contain words instead of numbers; these are flush left."""
        return tuple(
            any(isinstance(row[k], str) and row[k][:1].isalpha() for row in self.rows)  # type: ignore[index]
            for k in range(len(self.columns))
        )

    def to_dict(self) -> TableDocument:
        """The table in the form of `exactfold study --json`."""
        return {
            "name": self.name,
            "title": self.title,
            "columns": list(self.columns),
            "rows": [list(row) for row in self.rows],
            "notes": list(self.notes),
        }


@dataclass(frozen=True)
class StudyFigure:
    """A figure of a study: `draw(axes)` draws it on axes of Matplotlib, in the style of the report.

    `name` names its file. `width` and `height` are in inches. If `panels` = (rows, columns) is not
    (1, 1), `draw` gets a list of axes, row by row. A legend beside the axes names everything that
    is drawn with a label. The figure is only a picture; the proved numbers are in the tables.
    """

    name: str
    title: str
    caption: str
    draw: Callable[[Any], None] = field(compare=False)
    width: float = 5.0
    height: float = 3.4
    panels: tuple[int, int] = (1, 1)


@dataclass(frozen=True, repr=False)
class Study:
    """A function that makes a row from a seeded recipe, and functions for tables and figures.

    `recipes(seed, numbers)` yields the recipes of `numbers[size]` rows of each size; different
    sizes and seeds share no recipe. `row(recipe)` must be a function of a module, as it is sent to
    other processes, and must depend on the recipe only. Its mapping has a `status`, "proved" or
    "undecided". `tables` and `figures` get rows with their recipes. `numbers` are those of the
    paper, and `extended` go beyond it. `version` rises when `row` changes; rows of another version
    are not read.
    """

    name: str
    about: str
    version: int
    numbers: Mapping[int, int]
    extended: Mapping[int, int]
    recipes: Callable[[int, Mapping[int, int]], Iterator[Recipe]]
    row: Callable[[Recipe], Row]
    tables: Callable[[Iterable[Row]], Sequence[StudyTable]]
    figures: Callable[[Iterable[Row]], Sequence[StudyFigure]]

    def __repr__(self) -> str:
        return f"<Study: {self.name}, version {self.version}>"

    def id_of(self, recipe: Recipe) -> str:
        """The name of the row of a recipe: 16 hexadecimal digits of a SHA-256.

        The digest is that of the study's name and version and of the recipe.

        >>> from exactfold.studies.running.registry import study_named
        >>> study_named("table1").id_of({"interior": 4, "seed": 0, "denominator": 1024})
        '546be50257729877'
        """
        return digest([self.name, self.version, recipe])[:16]

    def number(self, seed: int, numbers: Mapping[int, int]) -> int:
        """The number of rows of a run."""
        return sum(1 for _ in self.recipes(seed, numbers))

    def chosen(
        self,
        sizes: Iterable[int] | None = None,
        number: int | Mapping[int, int] | None = None,
        *,
        extend: bool = False,
    ) -> dict[int, int]:
        """The number of rows of each size: that of the study, only for `sizes`, or `number`.

        If `number` is a mapping, it replaces the study's numbers for the sizes that it names; and
        without `sizes` and `extend` only these sizes are used. Raises `UsageError` for a size
        without a number, and for a number of a size that is not among `sizes`.

        >>> from exactfold.studies.running.registry import study_named
        >>> study_named("table1").chosen(range(2, 6), {4: 30, 5: 7})
        {2: 100, 3: 5000, 4: 30, 5: 7}
        """
        known = {**self.numbers, **(self.extended if extend else {})}
        by_size = number if isinstance(number, Mapping) else {}
        if sizes is not None:
            wanted = sorted(set(sizes))
        elif by_size and not extend:
            wanted = sorted(by_size)
        else:
            wanted = sorted({*known, *by_size})
        if number is not None and not isinstance(number, Mapping):
            return dict.fromkeys(wanted, number)
        beside = sorted(by_size.keys() - set(wanted))
        if beside:
            raise UsageError(
                f"there is a number of rows for size {beside[0]}, but this size is not among the "
                "chosen sizes"
            )
        known.update(by_size)
        missing = [size for size in wanted if size not in known]
        if missing:
            raise UsageError(
                f"the study {self.name} has no number of rows for size {missing[0]}: give --number"
            )
        return {size: known[size] for size in wanted}


def canonical(value: object) -> str:
    """The canonical JSON text of a value; raises `ValueError` for NaN and infinities.

    >>> canonical({"b": 1, "a": [True, None]})
    '{"a":[true,null],"b":1}'
    """
    return json.dumps(
        value, sort_keys=True, separators=(",", ":"), ensure_ascii=False, allow_nan=False
    )


def digest(value: object) -> str:
    """The SHA-256 of a value as JSON, in hexadecimal digits."""
    return hashlib.sha256(canonical(value).encode("utf-8")).hexdigest()


_COLOURS = ("#440154", "#3b4cc0", "#2a8fd0", "#1fa187", "#5fae2c", "#d9a400", "#e8702a", "#c62828")


def of_size(size: int) -> dict[str, str]:
    """The colour of a number of interior vertices in figures, from violet (2) to red (9).

    From 10 on the same colours come again, dashed; 1 is grey.

    >>> of_size(2), of_size(10)
    ({'color': '#440154'}, {'color': '#440154', 'linestyle': '--'})
    """
    colour = {"color": _COLOURS[(size - 2) % len(_COLOURS)] if size > 1 else "#8c8c8c"}
    return colour if size < 10 else {**colour, "linestyle": "--"}
