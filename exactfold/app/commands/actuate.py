"""`exactfold actuate`: finds torques for one branch, or judges given torques, with proof."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path

from exactfold.app.commands.branch import given_signs
from exactfold.app.options.motions import ActuateOptions
from exactfold.app.shell.json_numbers import numbers_by_name
from exactfold.app.shell.patterns import in_doubt, read, tell_doubt, verdict
from exactfold.app.shell.shell import EXIT, Bar, name_of, one_at_least
from exactfold.branches.counting.find import BranchFinder
from exactfold.design.actuation.actuate import actuate
from exactfold.errors import InputError, NumberError
from exactfold.exact.numbers import as_rational
from exactfold.pattern.crease_pattern import CreasePattern, Edge


class Driven(ActuateOptions):
    """The options of one call, and how they are answered."""

    def answer(self) -> int:
        """Find or judge the torques, print the answer, and return the exit code.

        Raises the errors of `read`, `BranchFinder` and `actuate`, `InputError`, and
        `UsageError` if neither `signs` nor `up` is given.
        """
        with Bar("reading") as bar:
            read_sheet = read(self.file, self.reading, "actuate", verbose=self.verbose)
            pattern = read_sheet.pattern
            one_at_least("either --signs or --up", self.signs, self.up)
            torques = None if self.torques is None else torques_in(self.torques, pattern)
            actuation = actuate(
                pattern,
                given_signs(BranchFinder(pattern), self.signs, self.up),
                creases=self.creases,
                torques=torques,
                progress=bar,
            )
        if self.as_json:
            document = actuation.to_dict(name_of(self.file))
            print(json.dumps(in_doubt(read_sheet.opened, document)))
        else:
            from exactfold.app import report

            tell_doubt(read_sheet.opened)
            report.show(report.actuation_report(actuation, everything=self.everything))
        return EXIT[verdict(read_sheet.opened, actuation.status)]


def torques_in(path: Path, pattern: CreasePattern) -> dict[Edge, Fraction]:
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
