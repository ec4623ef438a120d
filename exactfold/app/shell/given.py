"""Numbers by vertex in JSON files: boundary heights, angle deficits."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

from exactfold.app.shell.json_numbers import numbers_by_name
from exactfold.branches.counting.find import BranchFinder, branch_finder
from exactfold.errors import (
    BadCurvatureError,
    BoundaryHeightsError,
)
from exactfold.pattern.crease_pattern import CreasePattern


@dataclass(frozen=True)
class Given:
    """The files that --rim and --curvature name, None where the option is not there."""

    boundary_heights: Path | None = None
    curvature: Path | None = None

    def __bool__(self) -> bool:
        return self.boundary_heights is not None or self.curvature is not None

    def finder(self, pattern: CreasePattern) -> BranchFinder:
        """The finder of branches of a pattern with what is given, and a chosen rim if need be.

        Raises `UnreadableFileError` and the errors of `BranchFinder`, after the name of the file.
        """
        boundary_heights = (
            None
            if self.boundary_heights is None
            else numbers_in(self.boundary_heights, BoundaryHeightsError, "-1/2")
        )
        curvature = None
        if self.curvature is not None:
            curvature = numbers_in(self.curvature, BadCurvatureError, "1/3")
        finder = branch_finder(pattern, boundary_heights, curvature)  # type: ignore[arg-type]
        try:
            finder.problem  # noqa: B018 - it is set up here, so that errors name the file
        except (BoundaryHeightsError, BadCurvatureError) as error:
            file = self.curvature if isinstance(error, BadCurvatureError) else self.boundary_heights
            if file is None:
                raise
            raise type(error)(f"{file}: {error}", error.vertices) from None
        return finder


def numbers_in(
    path: Path, error: type[BoundaryHeightsError] | type[BadCurvatureError], example: str
) -> dict[int | str, Fraction | Any]:
    """The numbers in a JSON file {"vertex": number}, as they are written; text such as "1/3" too.

    Raises `UnreadableFileError`, and `error` for a file of another shape. What the numbers and the
    vertices are is not checked here.
    """
    shape = f'write {{"0": 0.5, "3": "{example}", ...}}, a number for each vertex'
    data = numbers_by_name(path, error, "vertex", shape)
    return {_vertex(name): value for name, value in data.items()}


def _vertex(name: str) -> int | str:
    """A vertex by its number; other text stays, to be named in a message."""
    # "00" stays text: it would be vertex 0 a second time, unseen where keys are compared.
    plain = name.isascii() and name.isdecimal() and len(name) < 20 and name == str(int(name))
    return int(name) if plain else name
