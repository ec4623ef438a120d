"""`exactfold actuate`: finds torques for one branch, or judges given torques, with proof."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path

from exactfold.app.options.choosing import choice_of
from exactfold.app.options.motions import ActuateOptions
from exactfold.app.shell.json_numbers import numbers_by_name
from exactfold.app.shell.patterns import in_doubt, read, tell_doubt, verdict
from exactfold.app.shell.shell import EXIT, Bar, name_of
from exactfold.app.verbs.choosing import the_branch
from exactfold.branches.counting.find import BranchFinder
from exactfold.design.actuation.actuate import actuate
from exactfold.errors import InputError, NumberError
from exactfold.exact.numbers import as_rational
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.opening import Opened, triangles


class Driven(ActuateOptions):
    """The options of one call, and how they are answered."""

    def answer(self) -> int:
        """Find or judge the torques, print the answer, and return the exit code.

        Raises the errors of `read`, `the_branch` and `actuate`, `InputError`, and `UsageError` if
        no way is named.
        """
        with Bar("reading") as bar:
            read_sheet = read(self.file, self.reading, "actuate", verbose=self.verbose)
            pattern = read_sheet.pattern
            self.require_name()
            torques = None if self.torques is None else torques_in(self.torques, pattern)
            actuation = actuate(
                pattern,
                self._signs(read_sheet.opened, bar),
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

    def _signs(self, opened: Opened, bar: Bar) -> dict[int, int]:
        """The vertex signs of the side that is to be driven."""
        choice = choice_of(self, opened)
        if choice.signs is not None or choice.up is not None:
            finder = BranchFinder(triangles(opened, "actuate"))
            return finder.signs(choice.signs, choice.up)
        chosen = the_branch(opened, choice, bar, needs="actuate")
        return {v: chosen.side * sign for v, sign in chosen.branch.vertex_signs.items()}


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
