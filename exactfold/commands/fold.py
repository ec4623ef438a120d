"""`exactfold fold`: a branch followed in space, with frames for other programs and a plot."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

from exactfold.branches.branch import Branch
from exactfold.commands.branch import chosen
from exactfold.commands.patterns import read
from exactfold.commands.shell import EXIT, Bar, name_of, say
from exactfold.drawing.drawing import Snap
from exactfold.errors import UndecidedBranchError
from exactfold.motion.following import follow
from exactfold.motion.motion import Motion
from exactfold.motion.writing import checked_ending, write_motion
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.fold_writing import write_text
from exactfold.verdict import PROVED, UNDECIDED


@dataclass(frozen=True)
class Wanted:
    """What was asked for on the command line; at most one of `signs`, `up`, `place` is given."""

    file: Path
    snap: Snap | None
    sheet: int | None
    signs: str | None
    up: str | None
    place: int | None
    side: int
    until: str
    frames: int
    by: Edge | None
    through_nodes: bool
    output: Path | None
    plot: Path | None
    as_json: bool

    def answer(self) -> int:
        """Follow the branch, write what was asked for and print; the exit code.

        0 where the branch is proved, wherever its motion ends. Raises the errors of `read`,
        `chosen`, `follow` and `write_motion`, but for `UndecidedBranchError`, which is said.
        """
        from exactfold import report

        if self.output is not None:
            checked_ending(self.output)  # before the work
        with Bar("reading") as bar:
            pattern = read(self.file, self.snap, self.sheet, "fold").pattern
            branch = self._branch(pattern, bar)
            try:
                motion = self._motion(branch, bar)
            except UndecidedBranchError as error:
                say(f"not followed: {error}; {branch.reason}".rstrip("; "))
                return EXIT[UNDECIDED]
            bar("writing")
            written = self._written(motion)
            if self.plot is not None:
                write_text(self.plot, report.angles_plot(motion, self._title or ""))
                written = [*written, str(self.plot)]
        if self.as_json:
            print(json.dumps(motion.report(name_of(self.file), written)))
        else:
            report.show(report.motion_report(motion, written))
        if branch.status is not PROVED:
            say(f"the branch is not proved: {branch.reason}")
        return EXIT[branch.status]

    @property
    def _title(self) -> str | None:
        return None if str(self.file) == "/dev/stdin" else self.file.stem

    def _branch(self, pattern: CreasePattern, bar: Bar) -> Branch:
        if (self.signs, self.up, self.place) != (None, None, None):
            return chosen(pattern, self.signs, self.up, self.place, bar)
        say(
            "no branch was named (--signs, --up, --branch): this is the one on which all "
            "vertices pop up"
        )
        return chosen(pattern, None, ",".join(map(str, pattern.foldable_vertices)), None, bar)

    def _motion(self, branch: Branch, bar: Bar) -> Motion:
        return follow(
            branch,
            side=self.side,
            until=self.until,
            frames=self.frames,
            by=self.by,
            through_nodes=self.through_nodes,
            progress=bar,
        )

    def _written(self, motion: Motion) -> list[str]:
        if self.output is None:
            return []
        return [str(file) for file in write_motion(motion, self.output, title=self._title)]
