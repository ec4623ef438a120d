"""The options that choose one way to fold, which every command that needs a way takes."""

from dataclasses import dataclass
from typing import Annotated, TypeAlias

import typer

from exactfold.app.options.reading import ReadingOptions
from exactfold.app.shell.parameters import Pattern, number
from exactfold.errors import UsageError

ONE_OF = "one of --way, --signs, --up and --letters"

Signs: TypeAlias = Annotated[
    str | None,
    typer.Option(
        metavar="+-...",
        help="The branch of a triangulated sheet with these vertex signs, in the order of the "
        "interior vertices; @FILE reads them from a file.",
    ),
]
Up: TypeAlias = Annotated[
    str | None,
    typer.Option(metavar="5,7", help="Like --signs: these vertices pop up, all others pop down."),
]
Letters: TypeAlias = Annotated[
    str | None,
    typer.Option(
        metavar="MVU...|0-4=M,...|drawn",
        help="The way with these mountains and valleys: M, V, F (flat) or U (free) for each fold "
        "in the order of `count`; or letters by fold, the others are free; or those of the "
        "drawing. @FILE reads them from a file.",
    ),
]


@dataclass(frozen=True, eq=False, repr=False, match_args=False)
class WayOptions(ReadingOptions):
    """A sheet, and how one way of it is named; `UsageError` if it is named twice."""

    file: Pattern
    way: Annotated[int | None, number("The N-th way that `count` lists.", "N")] = None
    signs: Signs = None
    up: Up = None
    letters: Letters = None

    def __post_init__(self) -> None:
        if sum(value is not None for value in self.named) > 1:
            raise UsageError(f"give {ONE_OF}")

    @property
    def named(self) -> tuple[object, ...]:
        """The values of the options that name a way."""
        return self.way, self.signs, self.up, self.letters

    @property
    def is_named(self) -> bool:
        """Whether an option names a way."""
        return any(value is not None for value in self.named)

    def require_name(self) -> None:
        """Raise `UsageError` if no option names a way."""
        if not self.is_named:
            raise UsageError(f"give {ONE_OF}")
