"""The options of every command that reads a drawing: how it becomes an exact sheet."""

from dataclasses import dataclass

from exactfold.app.shell.parameters import Force, Sheet, Snap
from exactfold.pattern.reading import Reading


@dataclass(frozen=True, eq=False, repr=False, match_args=False, kw_only=True)
class ReadingOptions:
    """How a drawing is read; these options follow the others in the help of a command."""

    snap: Snap = None
    sheet: Sheet = None
    force: Force = False

    @property
    def reading(self) -> Reading:
        """These options as the value that `open_pattern` takes."""
        return Reading(self.snap, self.sheet, force=self.force)
