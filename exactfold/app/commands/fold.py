"""`exactfold fold`: follows a sheet as it folds, and writes frames, pictures and a proof."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from exactfold._support.plurals import counted
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.app.commands.branch import also_found, chosen, given_signs
from exactfold.app.commands.driving import driven_angles
from exactfold.app.options.motions import FoldOptions
from exactfold.app.pictures.picture_files import checked_picture, write_picture
from exactfold.app.shell.given import Given
from exactfold.app.shell.patterns import in_doubt, read_any, tell_doubt, verdict
from exactfold.app.shell.shell import EXIT, Bar, name_of, say
from exactfold.branches.values.branch import Branch
from exactfold.errors import UndecidedBranchError, UsageError
from exactfold.motion.curves.drive import PrescribedAngles
from exactfold.motion.curves.motion import Motion
from exactfold.motion.following import Goal, follow
from exactfold.motion.writing import checked_ending, write_motion
from exactfold.pattern.crease_pattern import CreasePattern, Triangle
from exactfold.pattern.fold_writing import require_folder
from exactfold.pattern.opening import Opened, has_branches

if TYPE_CHECKING:  # following branches does not need it
    from exactfold.motion.panels.motion import PanelMotion
    from exactfold.motion.panels.proving import PanelProof
    from exactfold.motion.proving import MotionProof
    from exactfold.panels.result import Decomposition


@dataclass(frozen=True)
class _Begin:
    """A ray, and the folds that are driven along it."""

    branch: Branch
    side: int
    drive: PrescribedAngles | None = None


class Wanted(FoldOptions):
    """The options of one call, and how they are answered."""

    @property
    def given(self) -> Given:
        """The file with boundary heights."""
        return Given(self.boundary_heights)

    def answer(self) -> int:
        """Follow the sheet, write the requested files, print the answer, return the exit code.

        The exit code is 0 if the branch is proved or the modes provably fold, wherever the motion
        ends; with a certificate the motion must be proved, too. A branch that is undecided is not
        an error: the reason is printed to stderr. Raises the other errors of `read_any`, `chosen`,
        `follow`, `follow_panels` and `write_motion`, and `UsageError` for options that belong to
        the other kind of sheet.
        """
        from exactfold.app import report

        self._check_outputs()  # before the work
        with Bar("reading") as bar:
            opened = read_any(self.file, self.reading, verbose=self.verbose)
            sheet = opened.sheet
            motion: Motion | PanelMotion
            if isinstance(sheet, CreasePattern) and (self._named or has_branches(sheet)):
                begin = self._begin(sheet, bar)
                try:
                    motion = self._along(begin, bar)
                except UndecidedBranchError as error:
                    say(f"not followed: {error}; {begin.branch.reason}".rstrip("; "))
                    return EXIT[UNDECIDED]
            else:
                motion = self._panels(opened, bar)
            proof = self._proof(motion, bar)
            motion = motion if proof is None else proof.motion
            bar("writing")
            written = self._written(motion, proof)
        if self.as_json:
            document = in_doubt(opened, motion.to_dict(name_of(self.file), written))
            print(json.dumps({**document, "proof": None if proof is None else proof.to_dict()}))
        else:
            tell_doubt(opened)
            report.show(report.motion_report(motion, written, proof))
        if isinstance(motion, Motion) and motion.branch.status is not PROVED:
            say(f"the branch is not proved: {motion.branch.reason}")
            return EXIT[motion.branch.status]
        return EXIT[verdict(opened, PROVED if proof is None else proof.status)]

    def _check_outputs(self) -> None:
        """Raise `UsageError` for a wrong ending, `UnwritableFileError` for a missing folder."""
        if self.output is not None:
            checked_ending(self.output)
        for drawn in (self.plot, self.picture):
            if drawn is not None:
                checked_picture(drawn)
        if self.certificate is not None:
            require_folder(self.certificate)

    @property
    def _title(self) -> str | None:
        return None if str(self.file) == "/dev/stdin" else self.file.stem

    # --- branches --------------------------------------------------------------------------------

    @property
    def _named(self) -> bool:
        """Whether the options name a branch. More than four corners have branches only then."""
        return (self.signs or self.up or self.drive) is not None or bool(self.given)

    def _begin(self, pattern: CreasePattern, bar: Bar) -> _Begin:
        """The ray to follow, and the folds that are driven."""
        if self.drive is None:
            return _Begin(self._branch(pattern, bar), self.side or 1)
        angles = driven_angles(self.drive)
        Goal.of(self.until)  # before the work
        if self.side is not None and pattern.Ve > 4:
            raise UsageError(
                "--side does not go with --drive: the angles say to which side the sheet folds"
            )
        from exactfold.motion.tubes.driven import find_driven

        finder = self.given.finder(pattern)
        bar("setting up")
        signs = None
        if (self.signs, self.up) != (None, None):
            signs = given_signs(finder, self.signs, self.up)
        boundary_heights = None if self.given.boundary_heights is None else finder.boundary_heights
        driven = find_driven(
            pattern, angles, signs, boundary_heights=boundary_heights, side=self.side, progress=bar
        )
        if signs is None:
            say(
                "no branch was named (--signs, --up): this is the first branch found on which the "
                f"folds start in this ratio: {driven.branch.sign_text}"
            )
        if driven.others:
            say(also_found(driven.others))
        return _Begin(driven.branch, driven.side, driven.drive)

    def _branch(self, pattern: CreasePattern, bar: Bar) -> Branch:
        given = {"--component": self.component, "--modes": self.modes}
        _refuse(
            given,
            "motions of rigid panels, and this sheet of triangles folds along branches: name one "
            "by --signs, --up or --branch",
        )
        Goal.of(self.until)  # before the work
        if (self.signs, self.up, self.place) != (None, None, None):
            return chosen(pattern, self.signs, self.up, self.place, bar, self.given)
        up = ",".join(map(str, pattern.foldable_vertices))
        branch = chosen(pattern, None, up, None, bar, self.given)
        say(
            "no branch was named (--signs, --up, --branch): this is the one on which all "
            "vertices pop up"
        )
        return branch

    def _along(self, begin: _Begin, bar: Bar, pinned: Triangle | None = None) -> Motion:
        return follow(
            begin.branch,
            side=begin.side,
            until=self.until,
            frames=self.frames,
            by=self.by,
            through_branch_points=self.through_branch_points,
            pinned=pinned,
            drive=begin.drive,
            progress=bar,
        )

    # --- panels ----------------------------------------------------------------------------------

    def _panels(self, opened: Opened, bar: Bar) -> PanelMotion:
        from exactfold.branches.counting.ways import decompose_opened
        from exactfold.motion.panels.following import follow_panels

        given = {
            "--signs": self.signs,
            "--up": self.up,
            "--branch": self.place,
            "--side": self.side,
            "--rim": self.given.boundary_heights,
            "--drive": self.drive,
            "--through-nodes": self.through_branch_points or None,
        }
        _refuse(
            given,
            "branches of triangulated sheets with four corners, or with more and --rim, and this "
            "sheet folds along modes of rigid panels: name them by --component or --modes",
        )
        answer = decompose_opened(opened, progress=bar)
        ways = answer.known
        if ways.warning is not None:
            say(f"warning: {ways.warning}")
        bar("following")
        motion = follow_panels(
            answer,
            component=self.component,
            modes=self.modes,
            until=self.until,
            frames=self.frames,
            by=self.by,
        )
        if motion.component is not None and self.component is None:
            say(_first(ways, motion))
        return motion

    # --- proof -----------------------------------------------------------------------------------

    def _proof(self, motion: Motion | PanelMotion, bar: Bar) -> MotionProof | PanelProof | None:
        if self.certificate is None:
            return None
        if not isinstance(motion, Motion):
            from exactfold.motion.panels.proving import prove_panels

            bar("proving")
            return prove_panels(motion)
        from exactfold.motion.persistence import prove_persistently

        begin = _Begin(motion.branch, motion.side, motion.drive)
        return prove_persistently(motion, lambda held: self._along(begin, bar, held), progress=bar)

    # --- files -----------------------------------------------------------------------------------

    def _written(
        self, motion: Motion | PanelMotion, proof: MotionProof | PanelProof | None
    ) -> list[str]:
        from exactfold.app import report

        title, written = self._title or "", []
        if self.output is not None:
            written = [str(f) for f in write_motion(motion, self.output, title=self._title)]
        if self.plot is not None:
            write_picture(report.angles_plot(motion, title), self.plot)
            written.append(str(self.plot))
        if self.picture is not None:
            name = f"{title}, {motion.name}" if title else motion.name
            write_picture(report.motion_stills(motion, title=name), self.picture)
            written.append(str(self.picture))
        if self.certificate is not None and proof is not None:
            if proof.write(self.certificate):
                written.append(str(self.certificate))
            else:
                say(f"no certificate was written: {proof.reason}")
        return written


def _refuse(given: Mapping[str, object], why: str) -> None:
    """Raise `UsageError` for the first of these options that was given, with the reason `why`."""
    for option, value in given.items():
        if value is not None:
            raise UsageError(f"{option} is for {why}")


def _first(ways: Decomposition, motion: PanelMotion) -> str:
    """A sentence that says which component was chosen, and from how many."""
    from exactfold.motion.panels.followable import panel_components

    number = len(panel_components(ways))
    if number == 1:
        return f"the only component that can be followed: {motion.name}"
    return (
        f"no component was named (--component, --modes): this is the first of "
        f"{counted(number, 'component')} that can be followed, with most folds: {motion.name}"
    )
