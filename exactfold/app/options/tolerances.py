"""The options of the commands that move vertices."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from exactfold.app.options.ways import WayOptions
from exactfold.app.shell.parameters import Json, flag, number, written
from exactfold.app.shell.shell import apart


@dataclass(frozen=True, eq=False, repr=False, match_args=False)
class ToleranceOptions(WayOptions):
    """The options of `exactfold tolerance`; `UsageError` if they do not go together."""

    output: Annotated[
        Path | None,
        written(
            "Draw the sheet with a circle round each vertex: its own radius, and the radius if all "
            "move.",
            "PICTURE.svg",
            "-o",
            "--output",
        ),
    ] = None
    seed: Annotated[int, number("Seed of the random moves.", "S", least=0)] = 0
    as_json: Json = False
    everything: Annotated[bool, flag("--all", text="List every vertex and every relation.")] = False

    def __post_init__(self) -> None:
        super().__post_init__()
        apart(self.output, self.file)
