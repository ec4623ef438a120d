"""Reads boundary heights and angle deficits by vertex from JSON files."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

from exactfold.app.shell.json_numbers import numbers_by_name
from exactfold.errors import (
    BadCurvatureError,
    BoundaryHeightsError,
)

if TYPE_CHECKING:  # a count of all branches does not need it
    from exactfold.branches.counting.find import BranchFinder
    from exactfold.pattern.crease_pattern import CreasePattern


@dataclass(frozen=True)
class Given:
    """The files of --boundary-heights and --curvature; None for an option that is not given."""

    boundary_heights: Path | None = None
    curvature: Path | None = None

    def __bool__(self) -> bool:
        return self.boundary_heights is not None or self.curvature is not None

    @property
    def heights(self) -> dict[Any, Any] | None:
        """The boundary heights in the file, by vertex; None without a file.

        Raises the errors of `numbers_in`.
        """
        if self.boundary_heights is None:
            return None
        return numbers_in(self.boundary_heights, BoundaryHeightsError, "-1/2")

    def finder(self, pattern: CreasePattern) -> BranchFinder:
        """The finder of branches of a pattern with these boundary heights and angle deficits.

        If the pattern needs boundary heights and none are given, default heights are used. Raises
        `UnreadableFileError`, and the errors of `BranchFinder` with the name of the file in front.
        """
        from exactfold.branches.counting.find import branch_finder

        boundary_heights = self.heights
        curvature = None
        if self.curvature is not None:
            curvature = numbers_in(self.curvature, BadCurvatureError, "1/3")
        finder = branch_finder(pattern, boundary_heights, curvature)  # type: ignore[arg-type]
        try:
            finder.problem  # noqa: B018 - set up here, so that errors name the file
        except (BoundaryHeightsError, BadCurvatureError) as error:
            file = self.curvature if isinstance(error, BadCurvatureError) else self.boundary_heights
            if file is None:
                raise
            raise type(error)(f"{file}: {error}", error.vertices) from None
        return finder


def numbers_in(
    path: Path, error: type[BoundaryHeightsError] | type[BadCurvatureError], example: str
) -> dict[int | str, Fraction | Any]:
    """The numbers in a JSON file {"vertex": number}, exact; text such as "1/3" is allowed.

    Raises `UnreadableFileError`, and `error` if the file has another structure. Whether the values
    are numbers and the names are vertices is not checked here.
    """
    shape = f'write {{"0": 0.5, "3": "{example}", ...}}, with a number for each vertex'
    data = numbers_by_name(path, error, "vertex", shape)
    return {_vertex(name): value for name, value in data.items()}


def _vertex(name: str) -> int | str:
    """The number of a vertex; other text is kept, so that a message can name it."""
    # "00" stays text: as vertex 0 it could repeat the key "0" unnoticed.
    plain = name.isascii() and name.isdecimal() and len(name) < 20 and name == str(int(name))
    return int(name) if plain else name
