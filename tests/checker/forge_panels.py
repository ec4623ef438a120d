"""Certificates of sheets of panels, and forgeries that one line of the checker alone stops."""

from __future__ import annotations

import ast
import json
import re
from collections.abc import Iterable
from fractions import Fraction
from functools import cache
from typing import Any

from forge import refused, verified, without
from panel_sheets import grid, mesh, miura, tiling

from exactfold.checker.core.reading import CertificateError
from exactfold.checker.panels.certificate import kind_of
from exactfold.checker.panels.loops import Loops
from exactfold.checker.panels.modes import Modes
from exactfold.checker.sheets.panels import read_panels
from exactfold.exact.surds import RATIONALS
from exactfold.panels.certificate import certificate_of_panels
from exactfold.panels.decomposition import decompose
from exactfold.pattern.panel_pattern import Edge, PanelPattern

Document = dict[str, Any]


def twist() -> PanelPattern:
    """A square twist on thirds: a pinwheel of four pleats round a square."""
    corners, along = [(1, -1)], [(2, 1)]
    for _ in range(3):
        corners.append((-corners[-1][1], corners[-1][0]))
        along.append((-along[-1][1], along[-1][0]))
    points, edges, rim = list(corners), [(k, (k + 1) % 4) for k in range(4)], []
    for k, (x, y) in enumerate(along):
        for v in (k, (k + 1) % 4):
            rim.append(len(points))
            edges.append((v, len(points)))
            points.append((corners[v][0] + 2 * x, corners[v][1] + 2 * y))
    edges += [(rim[k], rim[(k + 1) % 8]) for k in range(8)]
    return PanelPattern([(Fraction(x, 3), Fraction(y, 3)) for x, y in points], edges)


def bent() -> PanelPattern:
    """Two zigzags with equal second differences and different slopes across two straight rows."""
    offsets = (0, 1, 0, 3)
    columns = [(0, 0), (1, 0), (1, 1), (0, 0)]

    def place(i: int, j: int) -> tuple[Fraction, Fraction]:
        moves, slope = columns[i]
        return Fraction(8 * i + moves * offsets[j] + slope * j), Fraction(4 * j)

    return grid(3, 3, place)


def split() -> PanelPattern:
    """The bent zigzags with a vertex on a fold, a third of the way along it."""
    points, edges = list(bent().vertices), set(bent().edges) - {(5, 9)}
    (ax, ay), (bx, by) = points[5], points[9]
    points.append((ax + (bx - ax) / 3, ay + (by - ay) / 3))
    return PanelPattern(points, sorted(edges | {(5, 16), (9, 16)}))


def square() -> PanelPattern:
    """A fold from boundary to boundary."""
    return PanelPattern(
        [(0, 0), (3, 0), (3, 3), (0, 3), (1, 0), (1, 3)],
        [(0, 4), (4, 1), (1, 2), (2, 5), (5, 3), (3, 0), (4, 5)],
    )


_ROOT = RATIONALS.adjoined(2).root
_NESTED = RATIONALS.adjoined(2).adjoined(2 + _ROOT).root
SHEETS = {
    "miura": lambda: miura(1, 3),
    "two rows": lambda: miura(2, 2),
    "three rows": lambda: miura(3, 3),
    "strip": lambda: mesh(1, 5, 5),
    "long strip": lambda: mesh(1, 20, 20),
    "tiling": lambda: tiling(2, 2),
    "rigid": lambda: mesh(3, 3, 5),
    "twist": twist,
    "crossing": lambda: grid(3, 3, lambda i, j: (i, j)),
    "square": square,
    "bent": bent,
    "split": split,
    "surds": lambda: grid(
        3, 2, lambda i, j: (4 * i + j % 2 * _ROOT / 2, 3 * j + i % 2 * (_ROOT - 1))
    ),
    "nested": lambda: grid(2, 2, lambda i, j: (i * _NESTED + j % 2, 2 * j + i % 2 * _ROOT / 2)),
}


@cache
def _text(name: str, held: tuple[Edge, ...]) -> str:
    return json.dumps(certificate_of_panels(decompose(SHEETS[name](), flat=held)))


def certified(name: str, held: Iterable[Edge] = ()) -> Document:
    """A fresh copy of the certificate of a sheet."""
    document: Document = json.loads(_text(name, tuple(held)))
    return document


def drawn(points: Iterable[tuple[int, int]], edges: Iterable[tuple[int, int]]) -> Document:
    """A certificate of a drawing that no reader would take; its supports are to be found."""
    made = certified("square")
    made["pattern"] = {
        "radicands": [],
        "vertices": [[[str(x)], [str(y)]] for x, y in points],
        "edges": sorted([i, j] for i, j in edges),
    }
    made["claims"]["supports"] = None
    return made


def supports(document: Document) -> list[Document]:
    """What the checker itself finds in the pattern, all of it said to fold if that is decided."""
    sheet, _ = read_panels(document["pattern"])
    modes = Modes(sheet, sheet.live([]))
    loops = Loops(modes)
    found = []
    for support in modes.supports():
        kind = kind_of(loops, support)
        entry = {"vertices": list(support.vertices), "folds": [list(e) for e in support.folds]}
        entry |= {"count": support.count, "by": kind, "modes": None}
        found.append(entry | {"extending": None if kind == "loops" else support.count})
    return found


_CLAIM = re.compile(r"claim (\w+) = .*, but it is (.*)")


def matched(document: Document) -> Document:
    """The certificate with the facts that its pattern and supports seem to show."""
    made: Document = json.loads(json.dumps(document))
    if made["claims"]["supports"] is None:
        made["claims"]["supports"] = supports(made)
    while True:
        try:
            verified(made)
            return made
        except CertificateError as error:
            found = _CLAIM.match(str(error))
            if found is None:
                raise
            made["claims"][found[1]] = ast.literal_eval(found[2])


def stopped(document: Document, message: str) -> None:
    """Refused with this message, and accepted without that line once its facts match."""
    with without(message):
        forged = matched(document)
    refused(forged, message)
