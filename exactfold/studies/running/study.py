"""What a study is: recipes, a row for each, and tables and figures made of the rows."""

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
"""What makes a row: numbers and texts by name, such as a size and a seed."""

Row: TypeAlias = Mapping[str, Any]
"""What was found, by name; where tables and figures are made, with the recipe and its `row`."""

Cell: TypeAlias = int | str | None


class TableDocument(TypedDict):
    """A table of a study."""

    name: str
    title: str
    columns: list[str]
    rows: list[list[Cell]]
    notes: list[str]


"""What stands in a table; None where there is nothing to say."""

STATUSES = (str(PROVED), str(UNDECIDED))
"""What the key `status` of a row may be."""


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
        """Which columns hold words and not numbers: these are flush left."""
        return tuple(
            any(isinstance(row[k], str) and row[k][:1].isalpha() for row in self.rows)  # type: ignore[index]
            for k in range(len(self.columns))
        )

    def to_dict(self) -> TableDocument:
        """The table as `exactfold study --json` has it."""
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

    `name` names its file. `width` and `height` are in inches. With `panels` = (rows, columns) other
    than (1, 1), `draw` gets a list of axes, row by row. What is drawn with a label is named in a
    legend beside its axes. What is drawn is a picture; the numbers that are proved stand in the
    tables.
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
    """A function from a seeded recipe to a row, and from rows to tables and figures.

    `recipes(seed, numbers)` yields the recipes of `numbers[size]` rows of each size; different
    sizes and seeds share none. `row(recipe)` is a function of a module, as it is sent to other
    processes; it depends on the recipe only. Its mapping has a `status`, "proved" or "undecided".
    `tables` and `figures` get rows with their recipes. `numbers` are those of the paper, and
    `extended` go past it. Rows of another `version` are not read: it rises when `row` changes.
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
        """The name of the row of a recipe: 16 hexadecimal digits of the SHA-256 of all it means.

        >>> from exactfold.studies.running.registry import study_named
        >>> study_named("table1").id_of({"interior": 4, "seed": 0, "denominator": 1024})
        '546be50257729877'
        """
        return digest([self.name, self.version, recipe])[:16]

    def number(self, seed: int, numbers: Mapping[int, int]) -> int:
        """How many rows a run has."""
        return sum(1 for _ in self.recipes(seed, numbers))

    def chosen(
        self,
        sizes: Iterable[int] | None = None,
        number: int | Mapping[int, int] | None = None,
        *,
        extend: bool = False,
    ) -> dict[int, int]:
        """How many rows of each size: those of the study, of these `sizes` only, or this `number`.

        A `number` by size replaces those of the study for the sizes that it names; with neither
        `sizes` nor `extend` these are all sizes. Raises `UsageError` for a size that has no
        number, and for a number of a size that is not among `sizes`.

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
                f"there is a number of rows for size {beside[0]}, which is not one of the sizes "
                "asked for"
            )
        known.update(by_size)
        missing = [size for size in wanted if size not in known]
        if missing:
            raise UsageError(
                f"the study {self.name} has no number of rows for size {missing[0]}: give --number"
            )
        return {size: known[size] for size in wanted}


def canonical(value: object) -> str:
    """The one JSON text of a value; raises `ValueError` for NaN and infinities.

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
    """The colour of a number of interior vertices in figures: violet to red, 2 to 9.

    From 10 on the same again, with dashes; 1 is grey.

    >>> of_size(2), of_size(10)
    ({'color': '#440154'}, {'color': '#440154', 'linestyle': '--'})
    """
    colour = {"color": _COLOURS[(size - 2) % len(_COLOURS)] if size > 1 else "#8c8c8c"}
    return colour if size < 10 else {**colour, "linestyle": "--"}
