"""`exactfold certify`: proves solutions that another program found."""

from __future__ import annotations

import json
from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path
from typing import Any, Literal, TypedDict

from rich.console import Group
from rich.table import Table
from rich.text import Text

from exactfold._support.documents import VerdictText
from exactfold._support.plurals import counted
from exactfold._support.verdict import PROVED, UNDECIDED, Verdict
from exactfold.app.options.branches import CertifyOptions
from exactfold.app.report.terminal import SHOWN, more_text, show
from exactfold.app.shell.given import Given
from exactfold.app.shell.json_numbers import read_json
from exactfold.app.shell.patterns import read
from exactfold.app.shell.shell import EXIT, Bar, name_of
from exactfold.app.verbs.systems import CertifiedPoints, SheetSystem, certify_points, sheet_system
from exactfold.errors import NumberError, PointsError
from exactfold.exact.numbers import parse_rational
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.described import PatternDocument, described
from exactfold.solve.certify.box import IsolatingBox

SHAPE = (
    "write a list of points, each a list of coordinates or an object by unknown, such as "
    '[[0.25, "1/3"], [[0.5, -1], 0]], where [0.5, -1] is a complex number'
)


class Asked(CertifyOptions):
    """The options of one call, and how they are answered."""

    def answer(self) -> int:
        """Print which points are proved, and return the exit code: 4 unless all are.

        Raises the errors of `read`, `sheet_system`, `certify_points` and `points_in`.
        """
        with Bar("reading") as bar:
            sheet = read(self.file, self.reading, "certify", verbose=self.verbose).pattern
            bar("equations")
            system = sheet_system(sheet, Given(self.boundary_heights).heights)
            points = points_in(self.points, system)
            bar("certifying")
            found = certify_points(system, points)
        if self.as_json:
            print(json.dumps(_document(found, sheet, name_of(self.file))))
        else:
            show(_report(found, everything=self.everything))
        return EXIT[_status(found)]


def points_in(path: Path, system: SheetSystem) -> list[list[Any]]:
    """The points in a JSON file, as exact numbers in the order of the unknowns of a system.

    Raises the errors of `read_json`, and `PointsError`, which names the point, for a file with
    another structure.
    """
    data = read_json(path, PointsError, SHAPE)
    if not isinstance(data, list):
        raise PointsError(f"{path} does not hold a list of points: {SHAPE}")
    return [_point(path, k, given, system.unknowns) for k, given in enumerate(data)]


def _point(path: Path, index: int, given: Any, unknowns: tuple[str, ...]) -> list[Any]:
    at = f"{path}: point {index}"
    if isinstance(given, Mapping):
        if missing := [name for name in unknowns if name not in given]:
            raise PointsError(f"{at} has no coordinate {missing[0]}")
        if unknown := [name for name in given if name not in unknowns]:
            raise PointsError(
                f"{at} has a coordinate {unknown[0]!r}: the unknowns are {', '.join(unknowns)}"
            )
        given = [given[name] for name in unknowns]
    if not isinstance(given, list):
        raise PointsError(f"{at} is neither a list nor an object: {SHAPE}")
    if len(given) != len(unknowns):
        raise PointsError(
            f"{at} has {counted(len(given), 'coordinate')}; the system has "
            f"{counted(len(unknowns), 'unknown')}: {', '.join(unknowns)}"
        )
    return [_coordinate(f"{at}, {name}", x) for name, x in zip(unknowns, given, strict=True)]


def _coordinate(at: str, given: Any) -> Fraction | tuple[Fraction, Fraction]:
    if isinstance(given, list) and len(given) == 2:
        real, imag = (_number(at, part) for part in given)
        return (real, imag) if imag else real
    return _number(at, given)


def _number(at: str, given: Any) -> Fraction:
    if isinstance(given, bool) or not isinstance(given, int | str):
        raise PointsError(f"{at}: {given!r} is not a number: {SHAPE}")
    try:
        return parse_rational(str(given))
    except NumberError as error:
        raise PointsError(f"{at}: {error}") from None


def _status(found: CertifiedPoints) -> Verdict:
    return PROVED if found.proved == len(found.boxes) else UNDECIDED


def _report(found: CertifiedPoints, *, everything: bool) -> Group:
    """The answer, and a table of the points."""
    zeros = found.zeros
    real = sum(box.is_real for box in zeros)
    nonreal = sum(box.is_nonreal for box in zeros)
    lines = [
        f"{found.proved} of {counted(len(found.boxes), 'point')} proved: "
        f"{counted(len(zeros), 'zero')} in disjoint boxes, {real} real, {nonreal} not real"
    ]
    if found.complete is PROVED:
        lines.append("these are all zeros of the system - PROVED (as many as Bezout's number)")
    table = Table("point", "answer", "radius of the box", box=None, pad_edge=False)
    rows = list(enumerate(zip(found.boxes, found.same, strict=True)))
    for k, (box, same) in rows if everything else rows[:SHOWN]:
        if not isinstance(box, IsolatingBox):
            table.add_row(str(k), Text(f"not proved: {box.reason}"), "")
            continue
        kind = "real" if box.is_real else "not real" if box.is_nonreal else "real or not"
        again = "" if same == k else f", as point {same}"
        table.add_row(str(k), f"proved, {kind}{again}", f"{_radius(box):.1e}")
    shown = len(rows) if everything else SHOWN
    return Group(*map(Text, lines), "", table, *more_text(len(rows) - shown))


def _radius(box: IsolatingBox) -> float:
    """The radius rounded up, for people."""
    exact = Fraction(box.radius, 1 << box.bits)
    return float(exact) * (1 + 2**-50)


class PointDocument(TypedDict):
    """A point, and what is proved of the zero near it."""

    status: VerdictText
    real: bool | None
    """Whether the zero is real; null if this is not known."""
    same_as: int | None
    """The first point before that may have the same zero, as the boxes meet."""
    centre: dict[str, str | list[str]]
    """The exact centre of the box by unknown; [real part, imaginary part] of a complex box."""
    radius: str | None
    """Half the side of the box, exact."""
    reason: str
    """Why no box was proved; empty if one was."""


class CertifyDocument(TypedDict):
    """What is proved of points that another program found."""

    format: Literal["exactfold certify result"]
    version: Literal[1]
    pattern: PatternDocument
    status: VerdictText
    """Proved if a zero is proved near every point."""
    complete: VerdictText
    """Proved if the disjoint boxes hold all zeros of the system."""
    distinct: int
    """The number of disjoint boxes."""
    real: int
    """How many zeros in them are proved real."""
    nonreal: int
    """How many zeros in them are proved not real."""
    unknowns: list[str]
    """Their names."""
    equations: str
    """What the unknowns and the equations are."""
    points: list[PointDocument]


def _document(found: CertifiedPoints, sheet: CreasePattern, name: str | None) -> CertifyDocument:
    """The object that --json prints: `schema("certify")`."""
    zeros = found.zeros
    return {
        "format": "exactfold certify result",
        "version": 1,
        "pattern": described(sheet, name),
        "status": str(_status(found)),
        "complete": str(found.complete),
        "distinct": len(zeros),
        "real": sum(box.is_real for box in zeros),
        "nonreal": sum(box.is_nonreal for box in zeros),
        "unknowns": list(found.system.unknowns),
        "equations": found.system.about,
        "points": [_point_document(found, k) for k in range(len(found.boxes))],
    }


def _point_document(found: CertifiedPoints, k: int) -> PointDocument:
    box = found.boxes[k]
    if not isinstance(box, IsolatingBox):
        return {
            "status": str(UNDECIDED),
            "real": None,
            "same_as": None,
            "centre": {},
            "radius": None,
            "reason": box.reason,
        }
    parts = [[str(Fraction(x, 1 << box.bits)) for x in row] for row in (box.real, box.imag) if row]
    rows = zip(*parts, strict=True)
    return {
        "status": str(PROVED),
        "real": True if box.is_real else False if box.is_nonreal else None,
        "same_as": None if found.same[k] == k else found.same[k],
        "centre": {
            x: row[0] if len(row) == 1 else list(row)
            for x, row in zip(found.system.unknowns, rows, strict=True)
        },
        "radius": str(Fraction(box.radius, 1 << box.bits)),
        "reason": "",
    }
