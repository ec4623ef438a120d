"""`exactfold actuate`: finds torques for one way, or judges given torques, with proof."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

from exactfold._support.verdict import UNDECIDED
from exactfold.app.options.choosing import choice_of
from exactfold.app.options.motions import ActuateOptions
from exactfold.app.shell.json_numbers import numbers_by_name
from exactfold.app.shell.patterns import in_doubt, read_any, tell_doubt, verdict
from exactfold.app.shell.shell import EXIT, Bar, name_of, say, wrote
from exactfold.app.verbs.actuating import Actuated, actuate_opened
from exactfold.app.verbs.choosing import the_branch
from exactfold.app.verbs.chosen import Choice
from exactfold.branches.counting.doubted import about
from exactfold.certificates.entries import Document, write_certificate
from exactfold.design.actuation.result import Actuation
from exactfold.errors import InputError, NumberError
from exactfold.exact.numbers import as_rational
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.writing.fold_writing import checked_target, require_folder, write_text

if TYPE_CHECKING:
    from exactfold.pattern.opening import Opened
    from exactfold.pattern.panel_pattern import PanelPattern


class Driven(ActuateOptions):
    """The options of one call, and how they are answered."""

    def answer(self) -> int:
        """Find or judge the torques, write and print the answer, and return the exit code.

        Raises the errors of `read_any` and `actuate_opened`, `InputError`, and `UsageError` if no
        way is named.
        """
        hinges = self.hinges  # before the work
        if self.output is not None:
            checked_target(self.output, (".csv",), "a table of torques")
        if self.certificate is not None:
            require_folder(self.certificate)
        with Bar("reading") as bar:
            opened = read_any(self.file, self.reading, verbose=self.verbose)
            self.require_name()
            torques = None if self.torques is None else torques_in(self.torques, opened.sheet)
            choice = self._listed(opened, choice_of(self, opened), bar)
            found = actuate_opened(opened, choice, self.creases, torques, hinges, bar)
            self._write(found)
            if isinstance(found, Actuation):
                opened = about(opened, found.branch)
        if self.as_json:
            document = in_doubt(opened, found.to_dict(name_of(self.file), self._certificate))
            if opened.doubt:
                document = {**document, "self_foldable": str(UNDECIDED)}
            print(json.dumps(document))
        else:
            from exactfold.app import report

            tell_doubt(opened)
            report.show(report.actuation_report(found, everything=self.everything))
            if self.output is not None:
                wrote(self.output, "the torques in N mm")
        return EXIT[verdict(opened, found.status)]

    def _listed(self, opened: Opened, choice: Choice, bar: Bar) -> Choice:
        """The choice, with the branch that letters name; a line says if they are its other side."""
        if choice.letters is None or not isinstance(opened.sheet, CreasePattern):
            return choice
        chosen = the_branch(opened, choice, bar, needs="actuate")
        if chosen.side < 0:
            say(
                f"the letters are those of the other side of branch {chosen.branch.sign_text}: the "
                "opposite torques drive it"
            )
        return Choice(signs=chosen.branch.vertex_signs)

    @property
    def _certificate(self) -> str | None:
        return None if self.certificate is None else str(self.certificate)

    def _write(self, found: Actuated) -> None:
        """Write the certificate and the torques in N mm, if they are asked for."""
        if self.certificate is not None:
            write_certificate(_certificate_of(found), self.certificate)
        if self.output is not None and self.hinges is not None:
            letters = found.branch.assignment if isinstance(found, Actuation) else found.assignment
            write_text(self.output, self.hinges.table(found.pattern, found.torques, letters))


def _certificate_of(found: Actuated) -> Document:
    if isinstance(found, Actuation):
        from exactfold.design.actuation.certificate import torques_certificate

        return torques_certificate(found)
    from exactfold.design.actuation.panels.certificate import panel_torques_certificate

    return panel_torques_certificate(found)


def torques_in(path: Path, pattern: CreasePattern | PanelPattern) -> dict[Edge, Fraction]:
    """The exact torques in a JSON file {"i-j": number}.

    A number may be text such as "1/3". Raises `UnreadableFileError` and `InputError`.
    """
    shape = 'write {"0-4": 0.5, ...}, with a torque for each crease'
    data = numbers_by_name(path, InputError, "crease", shape)
    names = {f"{i}-{j}": (i, j) for i, j in pattern.folds}
    torques: dict[Edge, Fraction] = {}
    for name, value in data.items():
        if name not in names:
            raise InputError(f"{path}: {name} is not a fold i-j, i < j, of the pattern")
        try:
            torques[names[name]] = as_rational(value)
        except NumberError as error:
            raise InputError(f"{path}: {name}: {error}") from None
    return torques
