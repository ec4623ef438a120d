"""`exactfold branch`: finds and proves the branches with given vertex signs."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

from exactfold._support.plurals import counted
from exactfold._support.verdict import PROVED
from exactfold.app.commands.driving import Angles, driven_angles
from exactfold.app.options.branches import BranchOptions
from exactfold.app.shell.given import Given
from exactfold.app.shell.patterns import Triangulated, in_doubt, read, tell_doubt
from exactfold.app.shell.shell import Bar, name_of, one_at_least, say
from exactfold.branches.counting.find import BranchFinder
from exactfold.branches.values.branch import Branch
from exactfold.errors import NotCountedError, NumberError, UsageError
from exactfold.exact.numbers import parse_whole
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.drawing.bounds import read_text


class Asked(BranchOptions):
    """The options of one call, and how they are answered."""

    @property
    def given(self) -> Given:
        """The files with boundary heights and angle deficits."""
        return Given(self.boundary_heights, self.curvature)

    @property
    def name(self) -> str:
        """The name of the pattern on the command line."""
        return name_of(self.pattern)

    def answer(self) -> bool:
        """Find, prove and print the branches; return whether all were proved.

        If there are many branches, none is kept in memory: with --json each is printed when it is
        found, otherwise only its row of the table is kept. Raises the errors of `read` and
        `BranchFinder`, and `UsageError` if none of `signs`, `up` and `batch` is given.
        """
        from exactfold.app import report

        if self.drive is not None:
            return self._driven(driven_angles(self.drive))
        rows = []
        with Bar("reading") as bar:
            read_sheet = self._read(bar)
            proved = not read_sheet.opened.doubt
            finder = self.given.finder(read_sheet.pattern)
            for name, result in self._found(finder, bar):
                proved &= result.status is PROVED
                if self.as_json:
                    document = in_doubt(read_sheet.opened, result.to_dict(self.name))
                    print(json.dumps(document), flush=True)
                elif name:
                    rows.append(report.branch_row(name, result))
        if not self.as_json:
            tell_doubt(read_sheet.opened)
        if not self._is_many:
            self._certify(result)
            if not self.as_json:
                report.show(report.branch_report(result))
        elif not self.as_json:
            report.show(report.branches_report(rows))
        return proved

    def _driven(self, angles: Angles) -> bool:
        """Find, prove and print the branch on which folds start in the ratio of these angles."""
        from exactfold.app import report
        from exactfold.motion.tubes.driven import find_driven

        if self._is_many or self.given.curvature is not None:
            raise UsageError("--drive goes with --signs or --up, and with --rim")
        with Bar("reading") as bar:
            read_sheet = self._read(bar)
            pattern = read_sheet.pattern
            finder = self.given.finder(pattern)
            boundary_heights = (
                None if self.given.boundary_heights is None else finder.boundary_heights
            )
            signs = given_signs(finder, self.signs, self.up)
            driven = find_driven(
                pattern, angles, signs, boundary_heights=boundary_heights, progress=bar
            )
            status = driven.status
        if driven.others:
            say(also_found(driven.others))
        self._certify(driven.branch)
        if self.as_json:
            print(json.dumps(in_doubt(read_sheet.opened, driven.to_dict(self.name))))
        else:
            tell_doubt(read_sheet.opened)
            report.show(report.branch_report(driven.branch, driven))
        sure = not read_sheet.opened.doubt
        return sure and driven.branch.status is PROVED and status is PROVED

    def _read(self, bar: Bar) -> Triangulated:
        read_sheet = read(self.pattern, self.reading, "branch", verbose=self.verbose)
        one_at_least("one of --signs, --up and --batch", self.signs, self.up, self.batch)
        bar("setting up")
        return read_sheet

    @property
    def _is_many(self) -> bool:
        return self.batch is not None or self.pops is not None

    def _found(self, finder: BranchFinder, bar: Bar) -> Iterator[tuple[str, Branch]]:
        if self.batch is not None:
            yield from _of_lines(finder, self.batch, bar)
            return
        given = given_signs(finder, self.signs, self.up)
        if self.pops is None:
            yield "", finder.find(given, progress=bar)
            return
        chosen = None if self.pops == "all" else _indices("--neighbours", self.pops)
        if chosen == []:
            raise UsageError("--neighbours names no vertex: give vertices such as 5,7, or all")
        for v, result in finder.each_neighbour(given, chosen, progress=bar):
            yield f"pop {v}", result

    def _certify(self, result: Branch) -> None:
        if self.certificate is None:
            return
        if result.status is PROVED:
            from exactfold.branches.certificates.single import branch_certificate
            from exactfold.certificates.entries import write_certificate

            with Bar("writing"):
                write_certificate(branch_certificate(result), self.certificate)
        else:
            say("no certificate was written: the branch is not proved")


def also_found(others: int) -> str:
    """A sentence that says on how many other branches the folds start in the same ratio."""
    return (
        f"the folds start in this ratio on {counted(others, 'more branch')} with these signs: this "
        "is the one that bends least; --rim FILE starts from other boundary heights"
    )


def chosen(
    pattern: CreasePattern,
    signs: str | None,
    up: str | None,
    place: int | None,
    bar: Bar,
    given: Given | None = None,
) -> Branch:
    """The branch that --signs or --up names, or that has the number `place` in the list of `count`.

    `place` starts at 1. `given` has the files with boundary heights and angle deficits, for the
    commands that take them.

    Raises the errors of `BranchFinder` and `count_branches`, and `UsageError` or `NotCountedError`
    for a number that is not in the list.
    """
    if place is None:
        finder = BranchFinder(pattern) if given is None else given.finder(pattern)
        bar("setting up")
        return finder.find(given_signs(finder, signs, up), progress=bar)
    from exactfold.branches.counting.collect import (
        count_branches,
    )  # imported here: only this needs FLINT

    result = count_branches(pattern, progress=bar)
    if not 1 <= place <= len(result.branches):
        proved = "" if result.status is PROVED else f", undecided: {result.reason}"
        listed = len(result.branches)
        cause = UsageError if listed else NotCountedError
        raise cause(
            f"--branch {place}: `exactfold count` lists "
            f"{counted(listed or 'no', 'branch')} of this pattern{proved}"
        )
    return result.branches[place - 1]


def given_signs(finder: BranchFinder, signs: str | None, up: str | None) -> dict[int, int]:
    """The sign vector that --signs or --up gives; --signs is a text, or @FILE for a file with it.

    Raises `UsageError` and `UnreadableFileError`.
    """
    if signs is None or not signs.startswith("@"):
        return finder.signs(signs, None if up is None else _indices("--up", up))
    path = Path(signs[1:])
    try:
        return finder.signs("".join(text for _, text in _lines(path)), None)
    except UsageError as error:
        raise UsageError(f"{path}: {error}") from None


def _of_lines(finder: BranchFinder, path: Path, bar: Bar) -> Iterator[tuple[str, Branch]]:
    """The branches of a file of sign vectors; the whole file is checked before any is found."""
    lines = list(_lines(path))
    if not lines:
        raise UsageError(f"{path} holds no sign vector: write one per line")
    for line, text in lines:
        try:
            finder.signs(text, None)
        except UsageError as error:
            raise UsageError(f"{path}, line {line}: {error}") from None
    for k, (line, text) in enumerate(lines):
        bar("branches", k, len(lines))
        try:
            branch = finder.find(finder.signs(text, None))
        except UsageError as error:  # a 0 where no branch is flat
            raise UsageError(f"{path}, line {line}: {error}") from None
        yield f"line {line}", branch


def _indices(option: str, text: str) -> list[int]:
    try:
        return [parse_whole(part) for part in text.split(",") if part.strip()]
    except NumberError:
        raise UsageError(f"{option} takes vertex indices such as 5,7, not {text!r}") from None


def _lines(path: Path) -> Iterator[tuple[int, str]]:
    """The lines of a text file that are not blank, with their line numbers from 1."""
    for number, line in enumerate(read_text(path).split("\n"), 1):
        if line.strip():
            yield number, line.strip()
