"""A study that takes no time: its rows are squares of numbers."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from exactfold.studies.running.study import Recipe, Row, Study, StudyFigure, StudyTable


def recipes(seed: int, numbers: Mapping[int, int]) -> Iterator[Recipe]:
    return ({"size": s, "seed": seed + k} for s, n in numbers.items() for k in range(n))


def row(recipe: Recipe) -> dict[str, Any]:
    return {"status": "proved", "value": int(recipe["size"]) ** 2 + int(recipe["seed"])}


def failing(recipe: Recipe) -> dict[str, Any]:
    if recipe["seed"] == 1:
        raise ZeroDivisionError("by nought")
    return row(recipe)


def deadly(recipe: Recipe) -> dict[str, Any]:
    """Ends its process as a kill does, once: where a file says that it has not yet."""
    if recipe["seed"] == 2 and os.path.exists("deadly"):
        os.kill(os.getpid(), 9)
    return row(recipe)


def tables(rows: Iterable[Row]) -> list[StudyTable]:
    values = tuple((r["size"], r["seed"], r["value"]) for r in rows)
    return [StudyTable("values", "Values", ("size", "seed", "value"), values, ("A <note>.",))]


def figures(rows: Iterable[Row]) -> list[StudyFigure]:
    values = [row["value"] for row in rows]
    return [
        StudyFigure("line", "A line", "Values.", lambda axes: axes.plot(values)),
        StudyFigure("two", "Two", "Twice.", lambda axes: axes[1].plot(values), panels=(1, 2)),
    ]


TOY = Study("toy", "A toy", 1, {2: 3}, {3: 2}, recipes, row, tables, figures)
