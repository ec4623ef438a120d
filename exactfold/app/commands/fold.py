"""`exactfold fold`: follows a sheet as it folds, and writes frames, pictures and a proof."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, cast

from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.app.commands.branch import also_found
from exactfold.app.commands.cells import asked_cell
from exactfold.app.options.choosing import choice_of
from exactfold.app.options.driving import driven_angles
from exactfold.app.options.motions import FoldOptions
from exactfold.app.pictures.film import FILMS, checked_encoder, checked_film, write_film
from exactfold.app.pictures.picture_files import checked_picture, write_picture
from exactfold.app.shell.given import Given
from exactfold.app.shell.patterns import in_doubt, located, read_any, tell_doubt, verdict
from exactfold.app.shell.shell import EXIT, Bar, name_of, say
from exactfold.app.verbs.choosing import choose
from exactfold.app.verbs.chosen import ChosenBranch, ChosenPanels
from exactfold.app.verbs.moving import along, along_panels, prove
from exactfold.branches.counting.doubted import about
from exactfold.certificates.entries import write_certificate
from exactfold.errors import NotApplicableError, UndecidedBranchError, UsageError
from exactfold.motion.curves.motion import Motion
from exactfold.motion.following import Goal
from exactfold.motion.writing import ENDINGS, write_motion
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.opening import Opened, has_branches, is_cell_file
from exactfold.pattern.writing.fold_writing import checked_target, require_folder

if TYPE_CHECKING:  # following branches does not need it
    from collections.abc import Callable

    from exactfold.motion.panels.families import FamilyMotion
    from exactfold.motion.panels.motion import PanelMotion
    from exactfold.motion.panels.proving import PanelProof
    from exactfold.motion.periodic.rolling import RollingMotion
    from exactfold.motion.proving import MotionProof


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
        an error: the reason is printed to stderr. If no way was named, a line says which way was
        taken, and why. The certificate of a motion of a family proves how true motions begin.
        Raises the other errors of `read_any`, `choose`, `along`, `along_panels` and `write_motion`,
        and `UsageError` for options that belong to the other kind of sheet.
        """
        from exactfold.app import report

        self._check_outputs()  # before the work
        if self.direction is not None or is_cell_file(located(self.file)):
            return self._rolling()
        with Bar("reading") as bar:
            opened = read_any(self.file, self.reading, verbose=self.verbose)
            chosen = self._chosen(opened, bar)
            if chosen.why:
                say(chosen.why)
            motion: Motion | PanelMotion | FamilyMotion
            if isinstance(chosen, ChosenBranch):
                opened = about(opened, chosen.branch)
                try:
                    motion = self._along(chosen, bar)
                except UndecidedBranchError as error:
                    say(f"not followed: {error}; {chosen.branch.reason}".rstrip("; "))
                    return EXIT[UNDECIDED]
            else:
                motion = self._panels(chosen, bar)
            proof = self._proof(motion, chosen, bar)
            motion = motion if proof is None else proof.motion
            bar("writing")
            written = self._written(motion, proof, opened)
        if self.as_json:
            document = in_doubt(opened, motion.to_dict(name_of(self.file), written))
            print(json.dumps({**document, "proof": None if proof is None else proof.to_dict()}))
        else:
            tell_doubt(opened)
            report.show(report.motion_report(motion, written, proof))
        if isinstance(motion, Motion) and motion.branch.status is not PROVED:
            say(f"the branch is not proved: {motion.branch.reason}")
            return EXIT[motion.branch.status]
        unproved = UNDECIDED if self.certificate is not None else PROVED
        return EXIT[verdict(opened, unproved if proof is None else proof.status)]

    def _rolling(self) -> int:
        """Follow a periodic sheet, shown as a patch of cells."""
        from exactfold.app import report
        from exactfold.motion.periodic.patch import CELLS
        from exactfold.motion.periodic.rolling import roll

        if self.direction is None:
            raise UsageError(
                f"{self.file} is the cell of a periodic sheet: give --direction X,Y, across which "
                "it rolls up, and --way N of `count --direction`"
            )
        if self.certificate is not None:
            raise UsageError(
                "motions of periodic sheets have no --certificate; --prove proves them"
            )
        for option, value in (
            ("--letters", self.letters),
            ("--by", self.by),
            ("--side", self.side),
            ("--thickness", self.thickness),
            ("--stop", self.stop or None),
        ):
            if value is not None:
                raise UsageError(
                    f"{option} does not go with --direction; a way is named by --way N"
                )
        self._refuse_branches()
        with Bar("reading") as bar:
            cell = asked_cell(self.file, self.reading, self.cell, verbose=self.verbose)
            motion = roll(
                cell,
                self.direction,
                way=self.way or 1,
                cells=self.patch or CELLS,
                until=self.until,
                frames=self.frames,
                proving=self.proving,
                progress=bar,
            )
            bar("writing")
            written = self._files(motion)
        if self.as_json:
            print(json.dumps(motion.to_dict(name_of(self.file), written)))
        else:
            report.show(report.motion_report(motion, written))
        return EXIT[motion.status if self.proving else motion.counted.status]

    @property
    def _is_film(self) -> bool:
        """Whether the output is a picture or an animation; checks its place then."""
        path = self.output
        return path is not None and path.suffix.lower() in FILMS and bool(checked_film(path))

    def _check_outputs(self) -> None:
        """Raise `UsageError` for a wrong ending, `UnwritableFileError` for a missing folder."""
        if self.output is not None:
            if not self._is_film:
                checked_target(self.output, (*ENDINGS, *FILMS), "a motion")
            else:
                checked_encoder(self.output.suffix.lower())
        for drawn in (self.plot, self.picture):
            if drawn is not None:
                checked_picture(drawn)
        if self.certificate is not None:
            require_folder(self.certificate)

    @property
    def _title(self) -> str | None:
        return None if str(self.file) == "/dev/stdin" else self.file.stem

    # --- ways ------------------------------------------------------------------------------------

    def _chosen(self, opened: Opened, bar: Bar) -> ChosenBranch | ChosenPanels:
        """The way to follow."""
        sheet = opened.sheet
        drive = None if self.drive is None else driven_angles(self.drive)
        if not isinstance(sheet, CreasePattern):
            self._refuse_branches()
        elif drive is not None and self.side is not None and sheet.Ve > 4:
            raise UsageError(
                "--side does not go with --drive: the angles say to which side the sheet folds"
            )
        elif drive is not None or has_branches(sheet):
            Goal.of(self.until)  # before the work
        bar("setting up")
        choice = choice_of(self, opened, self.given, drive, self.side)
        chosen = choose(opened, choice, bar)
        if isinstance(chosen, ChosenBranch) and chosen.others:
            say(also_found(chosen.others))
        return chosen

    def _along(
        self, chosen: ChosenBranch, bar: Bar, held: tuple[int, ...] | None = None
    ) -> Motion | FamilyMotion:
        return along(
            chosen,
            until=self.until,
            frames=self.frames,
            by=self.by,
            through_branch_points=self.through_branch_points,
            held=held,
            solid=self.solid,
            stops=self.stop,
            progress=bar,
        )

    def _panels(self, chosen: ChosenPanels, bar: Bar) -> PanelMotion | FamilyMotion:
        self._refuse_branches()
        warning = chosen.answer.known.warning
        if warning is not None:
            say(f"warning: {warning}")
        bar("following")
        return along_panels(
            chosen,
            until=self.until,
            frames=self.frames,
            by=self.by,
            solid=self.solid,
            stops=self.stop,
        )

    def _refuse_branches(self) -> None:
        """Raise `UsageError` for an option that only branches have."""
        given = {
            "--signs": self.signs,
            "--up": self.up,
            "--boundary-heights": self.boundary_heights,
            "--drive": self.drive,
            "--through-nodes": self.through_branch_points or None,
        }
        for option, value in given.items():
            if value is not None:
                raise UsageError(
                    f"{option} is for branches of triangulated sheets, and this sheet folds along "
                    "ways of rigid panels: name one by --way or --letters"
                )

    # --- proof -----------------------------------------------------------------------------------

    def _proof(
        self,
        motion: Motion | PanelMotion | FamilyMotion,
        chosen: ChosenBranch | ChosenPanels,
        bar: Bar,
    ) -> MotionProof | PanelProof | None:
        if self.certificate is None or self._is_of_family(motion):
            return None
        if isinstance(motion, Motion) and isinstance(chosen, ChosenBranch):
            from exactfold.motion.persistence import prove_persistently

            # without plates, which are no `Motion`
            again = cast("Callable[[tuple[int, ...]], Motion]", partial(self._along, chosen, bar))
            return prove_persistently(motion, again, progress=bar)
        bar("proving")
        return prove(motion)

    def _is_of_family(self, motion: Motion | PanelMotion | FamilyMotion) -> bool:
        from exactfold.motion.panels.families import FamilyMotion

        return isinstance(motion, FamilyMotion)

    def _beginning(
        self, opened: Opened, motion: Motion | PanelMotion | FamilyMotion, file: Path
    ) -> bool:
        """Write the certificate that true motions begin with the letters of a motion of a family.

        Nothing more is proved of such a motion. The folds that stay flat at first are left free. If
        this is not proved either, the reason is printed.
        """
        from exactfold.design.assignments.certificate import match_certificate
        from exactfold.design.panels.match import match_panels

        letters = {fold: x for fold, x in motion.assignment.items() if x in "MV"}
        matched = match_panels(opened, letters)
        try:
            certificate = match_certificate(matched)
        except NotApplicableError as error:
            say(f"no certificate was written: {error}")
            return False
        write_certificate(certificate, file)
        say(
            "the certificate proves that true motions begin with these mountains and valleys; "
            "nothing more is proved of this one, which was followed in floats"
        )
        return True

    # --- files -----------------------------------------------------------------------------------

    def _written(
        self,
        motion: Motion | PanelMotion | FamilyMotion,
        proof: MotionProof | PanelProof | None,
        opened: Opened,
    ) -> list[str]:
        written = self._files(motion)
        if self.certificate is not None and proof is None:
            if self._beginning(opened, motion, self.certificate):
                written.append(str(self.certificate))
        elif self.certificate is not None and proof is not None:
            if proof.write(self.certificate):
                written.append(str(self.certificate))
            else:
                say(f"no certificate was written: {proof.reason}")
        return written

    def _files(self, motion: Motion | PanelMotion | FamilyMotion | RollingMotion) -> list[str]:
        """Write the frames and pictures that were asked for."""
        from exactfold.app import report

        title, written = self._title or "", []
        if self.output is not None and self._is_film:
            write_film(motion, self.output)
            written = [str(self.output)]
        elif self.output is not None:
            written = [str(f) for f in write_motion(motion, self.output, title=self._title)]
        if self.plot is not None:
            write_picture(report.angles_plot(motion, title), self.plot)
            written.append(str(self.plot))
        if self.picture is not None:
            name = f"{title}, {motion.name}" if title else motion.name
            write_picture(report.motion_stills(motion, title=name), self.picture)
            written.append(str(self.picture))
        return written
