"""`exactfold export`: writes a branch, or one way of rigid panels, as a FOLD file.

With `--coq` it writes the sheet as a file that applies the formal proof to this sheet, and with
`--system` the equations of the sheet for another program.
"""

from __future__ import annotations

import json
import re
import shlex
import sys
from itertools import product
from pathlib import Path
from typing import Literal, TypedDict

from exactfold._support.documents import (
    Assignment,
    Degrees,
    FoldText,
    NotNegative,
    VerdictText,
    VertexSigns,
)
from exactfold._support.verdict import PROVED, UNDECIDED, Verdict
from exactfold.app.options.branches import ExportOptions
from exactfold.app.options.choosing import choice_of
from exactfold.app.shell.given import Given
from exactfold.app.shell.patterns import in_doubt, read, read_any, tell_doubt, verdict
from exactfold.app.shell.shell import EXIT, Bar, name_of, say, tell
from exactfold.app.verbs.choosing import choose, the_branch
from exactfold.app.verbs.chosen import Chosen, ChosenBranch, ChosenPanels
from exactfold.branches.counting.doubted import about
from exactfold.branches.counting.find import find_branches
from exactfold.branches.values.angles import require_amount
from exactfold.branches.values.branch import Branch, GaugeText
from exactfold.branches.values.export import AMOUNT, ENDINGS, BranchExport, exported
from exactfold.errors import NotApplicableError, UndecidedBranchError, UsageError
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.described import PanelsDocument, PatternDocument, described, described_panels
from exactfold.pattern.near_degeneracy import WarningDocument, warnings
from exactfold.pattern.opening import Opened, has_branches, triangles
from exactfold.pattern.writing.fold_writing import checked_target, write_text


class Wanted(ExportOptions):
    """The options of one call, and how they are answered."""

    @property
    def given(self) -> Given:
        """The file with boundary heights."""
        return Given(self.boundary_heights)

    def answer(self) -> int:
        """Find the branch or way, write it, say what was written, and return the exit code.

        A branch that `exported` refuses as undecided is not an error: the reason is printed to
        stderr. Raises the other errors of `read_any`, `the_branch`, `choose`, `exported` and
        `along_panels`, and `UsageError` if no way is named.
        """
        self.check_heights()
        output = self.written
        if output is not None:
            checked_target(output, ENDINGS, "a branch")  # before the work
        if output is None and self.as_json:
            raise UsageError("--json describes the file that is written: name it with -o")
        require_amount(self.largest)
        with Bar("reading") as bar:
            opened = read_any(self.file, self.reading, verbose=self.verbose)
            if self.signs is not None or self.up is not None:
                triangles(opened, "export")  # the error says what else there is
            self.require_name()
            chosen = self._chosen(opened, bar)
            bar("writing")
            if isinstance(chosen, ChosenBranch):
                branch = chosen.branch
                opened = about(opened, branch)
                try:
                    export = exported(
                        branch, amount=self.largest, title=self._title, force=self.force
                    )
                except UndecidedBranchError as error:
                    say(f"not written: {error}; {branch.reason}".rstrip("; "))
                    return EXIT[UNDECIDED]
                status, named = export.status, ("vertex signs", branch.sign_text)
            else:
                export, name = self._of_panels(chosen, bar)
                status = PROVED if chosen.way is None else chosen.way.verdict
                named = "motion", name
            if output is not None:
                export.write(output)
        if output is None:
            sys.stdout.write(export.text)
        elif self.as_json:
            summary = _summary(chosen, export, status, output, name_of(self.file))
            print(json.dumps(in_doubt(opened, summary)))
        else:
            from exactfold.app import report

            tell_doubt(opened)
            report.show(report.export_report(str(output), named, status, export))
        return EXIT[verdict(opened, status)]

    def _chosen(self, opened: Opened, bar: Bar) -> Chosen:
        """The way that the options name; a line says if it is one of infinitely many."""
        sheet = opened.sheet
        named = choice_of(self, opened, self.given)
        if named.of_branches or (isinstance(sheet, CreasePattern) and has_branches(sheet)):
            chosen: Chosen = ChosenBranch(self.branch(opened, bar), number=self.way)
        else:
            chosen = choose(opened, named, bar, default=False)
        if isinstance(chosen, ChosenBranch) and chosen.number is not None:
            _say_family(chosen.number, chosen.branch.pattern.Ve - 3)
        elif isinstance(chosen, ChosenPanels) and chosen.way is not None:
            _say_family(chosen.way.number, chosen.way.dimension)
        return chosen

    def _of_panels(self, chosen: ChosenPanels, bar: Bar) -> tuple[BranchExport, str]:
        """A way of rigid panels, folded by the largest angle, and its name.

        It is followed as `fold` follows it. Lines say what happens on the way, and where the motion
        ends before this angle.
        """
        from exactfold.app.report.motion import event_text
        from exactfold.app.verbs.moving import along_panels
        from exactfold.motion.curves.events import ANGLE
        from exactfold.motion.writing import exported_way

        if chosen.answer.known.warning is not None:
            say(f"warning: {chosen.answer.known.warning}")
        bar("following")
        motion = along_panels(chosen, until=f"{self.largest}deg", frames=2)
        export = exported_way(motion, title=self._title)
        reached = max(map(abs, export.angles.values()), default=0.0)
        for event in motion.events:
            if event.kind != ANGLE:
                say(f"on the way to {self.largest:g} degrees: {event_text(event)}")
        if reached < self.largest - _REACHED:
            say(f"the sheet folds only to {reached:.1f} degrees: it is written there")
        return export, f"{motion.name}: {motion.reason}"

    def branch(self, opened: Opened, bar: Bar) -> Branch:
        """The branch that the options name."""
        chosen = the_branch(opened, choice_of(self, opened, self.given), bar, needs="export")
        if chosen.side < 0:
            say(f"the letters are those of the other side of branch {chosen.branch.sign_text}")
        return chosen.branch

    def check_heights(self) -> None:
        """Raise `UsageError` for boundary heights without vertex signs."""
        if self.boundary_heights is not None and self.signs is None and self.up is None:
            raise UsageError("--boundary-heights goes with --signs or --up")

    @property
    def largest(self) -> float:
        """The largest fold angle in degrees."""
        return AMOUNT if self.amount is None else self.amount

    @property
    def written(self) -> Path | None:
        """The file to write; None for standard output."""
        return None if self.output is None or str(self.output) == "-" else self.output

    @property
    def _title(self) -> str | None:
        return None if str(self.file) == "/dev/stdin" else self.file.stem


def write_coq(asked: Wanted) -> int:
    """Write the sheet and the requested branches for the formal proof; return the exit code.

    The branch that is named is written, if any, or all branches with `asked.everything`; more than
    `FEW` branches are only written with `asked.force`. Raises the errors of `read`, `the_branch`,
    `find_branches`, `to_coq`, `branch_to_coq` and `branches_to_coq`, and `UsageError` for too many
    branches, for a file name that Coq cannot compile, and for options that do not go with `--coq`.
    """
    from exactfold.branches import branch_certificate
    from exactfold.interop import branch_to_coq, branches_to_coq, to_coq

    for name, given in (
        ("--amount", asked.amount is not None),
        ("--force", asked.force and not asked.everything),
        ("--json", asked.as_json),
    ):
        if given:
            raise UsageError(f"{name} does not go with --coq")
    named = asked.is_named
    if named and asked.everything:
        raise UsageError("--all names all branches: leave out --way, --signs, --up and --letters")
    asked.check_heights()
    output = asked.written
    if output is not None and not _MODULE.match(output.name):
        raise UsageError(
            f"Coq cannot compile a file with the name {output.name}: use a letter, then letters, "
            "digits and _, then .v"
        )
    with Bar("reading") as bar:
        read_sheet = read(asked.file, asked.reading, "--coq", verbose=asked.verbose)
        pattern = read_sheet.pattern
        text = to_coq(pattern)
        branches = []
        if named:
            branches = [asked.branch(read_sheet.opened, bar)]
        elif asked.everything:
            _refuse_uncounted(pattern, asked.force)
            every = map("".join, product("+-", repeat=pattern.Vi))
            branches = list(find_branches(pattern, every, progress=bar))
        for branch in branches:
            if branch.status is not PROVED:
                say(f"not written: the branch is not proved; {branch.reason}".rstrip("; "))
                return EXIT[UNDECIDED]
        certificates = [branch_certificate(branch) for branch in branches]
        if asked.everything:
            text = branches_to_coq(certificates)
        elif named:
            text = branch_to_coq(certificates[0])
    if output is None:
        sys.stdout.write(text)
    else:
        write_text(output, text)
        tell(f"wrote {output}; after `make -C proofs/formal`, verify it with")
        tell(f"coqc -Q proofs/formal Exactfold {shlex.quote(str(output))}")
    return EXIT[PROVED]


def write_system(asked: Wanted) -> int:
    """Write the equations of the sheet for another program; return the exit code.

    Raises the errors of `read_any`, `sheet_system` and `numbers_in`.
    """
    from exactfold.app.verbs.systems import PROGRAMS, sheet_system

    with Bar("reading") as bar:
        opened = read_any(asked.file, asked.reading, doubted=False)  # the error says it
        bar("equations")
        system = sheet_system(opened, asked.given.heights)
        text = system.text(str(asked.system))
    if not PROGRAMS[str(asked.system)][1]:  # the text has no comments
        tell(system.about)
    if asked.written is None:
        sys.stdout.write(text)
    else:
        write_text(asked.written, text)
        tell(f"wrote {asked.written}")
    return EXIT[PROVED]


def _say_family(number: int, dimension: int) -> None:
    if dimension > 1:
        say(
            f"way {number} is a family of dimension {dimension}: this is one of infinitely many "
            "motions of it"
        )


_REACHED = 1e-6
"""A motion that ends so close to the largest fold angle, in degrees, has reached it."""
FEW = 64
"""Most branches that are written without `force`. With five vertices, Coq takes 1.4 s for each."""


def _refuse_uncounted(pattern: CreasePattern, force: bool) -> None:
    """Raise, before any branch is looked for, if Coq cannot count them or would take long.

    The error is `NotApplicableError` if a vertex lies in a triangulated triangle, else
    `UsageError`.
    """
    if pattern.Ve != 4:
        raise UsageError(f"--all is for sheets with four corners, not {pattern.Ve}")
    if flat := sorted(pattern.interior_set - set(pattern.foldable_vertices)):
        raise NotApplicableError(
            f"vertex {flat[0]} lies in a triangulated triangle and is flat on every branch: the "
            "formal proof counts branches of sheets on which no vertex can stay flat"
        )
    if 2**pattern.Vi > FEW and not force:
        raise UsageError(
            f"{pattern.Vi} interior vertices have {2**pattern.Vi} sign vectors, and Coq takes a "
            f"second or more for the branch of each: to write more than {FEW}, add --force"
        )


_MODULE = re.compile(r"[A-Za-z][A-Za-z0-9_]*\.v\Z", re.ASCII)


class ExportDocument(TypedDict):
    """A branch, or a way of rigid panels, that was written as a FOLD file."""

    format: Literal["exactfold export result"]
    version: Literal[2]
    pattern: PatternDocument | PanelsDocument
    status: VerdictText
    way: int | None
    """The number of the way of rigid panels; null for a branch or a motion that is not listed."""
    vertex_signs: VertexSigns | None
    """By interior vertex: 1 up, -1 down, 0 flat; null for rigid panels."""
    assignment: Assignment
    """By fold i-j: M (mountain), V (valley), F (flat) or U (undecided), seen from +z."""
    gauge: GaugeText | None
    """Null for rigid panels."""
    output: str
    """The FOLD file that was written."""
    angles: dict[FoldText, Degrees]
    """The written angle of each fold i-j in degrees, positive for a valley."""
    length_error: NotNegative
    """Largest relative change of an edge length in the frame that shows the sheet in space."""
    warnings: list[WarningDocument]


def _summary(
    chosen: Chosen, export: BranchExport, status: Verdict, output: Path, name: str | None
) -> ExportDocument:
    """The object that --json prints: `schema("export")`."""
    branch = chosen.branch if isinstance(chosen, ChosenBranch) else None
    way = chosen.way if isinstance(chosen, ChosenPanels) else None
    sheet = export.pattern
    return {
        "format": "exactfold export result",
        "version": 2,
        "pattern": described(sheet, name)
        if isinstance(sheet, CreasePattern)
        else described_panels(sheet, name),
        "output": str(output),
        "status": str(status),
        "way": None if way is None else way.number,
        "vertex_signs": (
            None if branch is None else {str(v): s for v, s in sorted(branch.vertex_signs.items())}
        ),
        "assignment": {f"{i}-{j}": a for (i, j), a in sorted(export.letters.items())},
        "gauge": None if branch is None else branch.gauge,
        "angles": {f"{i}-{j}": angle for (i, j), angle in sorted(export.angles.items())},
        "length_error": export.length_error,
        "warnings": warnings(sheet) if isinstance(sheet, CreasePattern) else [],
    }
