"""`exactfold branch`: finds and proves the branches with given vertex signs."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

from exactfold._support.plurals import counted
from exactfold._support.verdict import PROVED
from exactfold.app.options.branches import BranchOptions
from exactfold.app.options.choosing import choice_of, indices, lines
from exactfold.app.options.driving import Angles, driven_angles
from exactfold.app.shell.given import Given
from exactfold.app.shell.patterns import in_doubt, read, tell_doubt
from exactfold.app.shell.shell import Bar, name_of, say
from exactfold.app.verbs.choosing import the_branch
from exactfold.app.verbs.chosen import ChosenBranch
from exactfold.branches.counting.doubted import about
from exactfold.branches.counting.find import BranchFinder
from exactfold.branches.values.branch import Branch
from exactfold.errors import UsageError
from exactfold.pattern.opening import Opened, triangles


class Asked(BranchOptions):
    """The options of one call, and how they are answered."""

    @property
    def given(self) -> Given:
        """The files with boundary heights and angle deficits."""
        return Given(self.boundary_heights, self.curvature)

    @property
    def name(self) -> str:
        """The name of the pattern on the command line."""
        return name_of(self.file)

    def answer(self) -> bool:
        """Find, prove and print the branches; return whether all were proved.

        If there are many branches, none is kept in memory: with --json each is printed when it is
        found, otherwise only its row of the table is kept. Raises the errors of `read` and
        `the_branch`, and `UsageError` if no branch is named.
        """
        from exactfold.app import report

        if self.drive is not None:
            return self._driven(driven_angles(self.drive))
        rows = []
        with Bar("reading") as bar:
            opened = read(self.file, self.reading, "branch", verbose=self.verbose).opened
            if self.batch is None:
                self.require_name()
            proved, first = True, opened
            bar("setting up")
            for name, result in self._found(first, bar):
                one = about(first, result)
                opened = one if one.doubt else opened
                proved &= result.status is PROVED and not one.doubt
                if self.as_json:
                    document = in_doubt(one, result.to_dict(self.name))
                    print(json.dumps(document), flush=True)
                elif name:
                    rows.append(report.branch_row(name, result))
        if not self.as_json:
            tell_doubt(opened)
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
        from exactfold.motion.tubes.driven import Driven

        shape = self.given.curvature is not None or self.way is not None or self.letters is not None
        if self._is_many or shape:
            raise UsageError("--drive goes with --signs or --up, and with --boundary-heights")
        with Bar("reading") as bar:
            opened = read(self.file, self.reading, "branch", verbose=self.verbose).opened
            self.require_name()
            bar("setting up")
            chosen = self._chosen(opened, bar, angles)
            opened = about(opened, chosen.branch)
            if chosen.drive is None:
                raise UsageError("--drive names no fold")
            driven = Driven(chosen.branch, chosen.side, chosen.drive, chosen.others)
            status = driven.status
        if driven.others:
            say(also_found(driven.others))
        self._certify(driven.branch)
        if self.as_json:
            print(json.dumps(in_doubt(opened, driven.to_dict(self.name))))
        else:
            tell_doubt(opened)
            report.show(report.branch_report(driven.branch, driven))
        return not opened.doubt and driven.branch.status is PROVED and status is PROVED

    def _chosen(self, opened: Opened, bar: Bar, angles: Angles | None = None) -> ChosenBranch:
        """The branch that the options name."""
        chosen = the_branch(opened, choice_of(self, opened, self.given, angles), bar)
        if chosen.side < 0 and angles is None:
            say(f"the other side of branch {chosen.branch.sign_text} has these letters")
        return chosen

    @property
    def _is_many(self) -> bool:
        return self.batch is not None or self.pops is not None

    def _found(self, opened: Opened, bar: Bar) -> Iterator[tuple[str, Branch]]:
        if self.batch is not None:
            yield from _of_lines(self._finder(opened), self.batch, bar)
            return
        if self.pops is None:
            yield "", self._chosen(opened, bar).branch
            return
        finder = self._finder(opened)
        popped = None if self.pops == "all" else indices("--neighbours", self.pops)
        if popped == []:
            raise UsageError("--neighbours names no vertex: give vertices such as 5,7, or all")
        choice = choice_of(self, opened, self.given)
        if choice.signs is None and choice.up is None:
            signs = self._chosen(opened, bar).branch.vertex_signs
        else:
            signs = finder.signs(choice.signs, choice.up)
        for v, result in finder.each_neighbour(signs, popped, progress=bar):
            yield f"pop {v}", result

    def _finder(self, opened: Opened) -> BranchFinder:
        return self.given.finder(triangles(opened, "branch"))

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
        "is the one that bends least; --boundary-heights FILE starts from other boundary heights"
    )


def _of_lines(finder: BranchFinder, path: Path, bar: Bar) -> Iterator[tuple[str, Branch]]:
    """The branches of a file of sign vectors; the whole file is checked before any is found."""
    given = list(lines(path))
    if not given:
        raise UsageError(f"{path} holds no sign vector: write one per line")
    for line, text in given:
        try:
            finder.signs(text, None)
        except UsageError as error:
            raise UsageError(f"{path}, line {line}: {error}") from None
    for k, (line, text) in enumerate(given):
        bar("branches", k, len(given))
        try:
            branch = finder.find(finder.signs(text, None))
        except UsageError as error:  # a 0 where no branch is flat
            raise UsageError(f"{path}, line {line}: {error}") from None
        yield f"line {line}", branch
