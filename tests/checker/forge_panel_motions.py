"""Certificates of motions of panels, and forgeries that one line of the checker alone stops."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from functools import cache
from typing import Any

from forge import Document
from forge_panels import SHEETS
from panel_sheets import grid, mesh, miura, tiling

from exactfold.checker.core.towers import Number
from exactfold.checker.panels.lines import Line, lines_at
from exactfold.checker.sheets.panels import read_panels
from exactfold.motion import follow_panels, prove_panels
from exactfold.motion.panels.certificate import certificate_of_panel_motion
from exactfold.pattern.families import single_vertex
from exactfold.pattern.opening import panels
from exactfold.pattern.panel_entries import panels_document
from exactfold.pattern.panel_pattern import PanelPattern

Change = Callable[[Document, Document], None]


def strip(widths: list[int]) -> PanelPattern:
    """Panels side by side, with a fold from boundary to boundary between neighbours."""
    xs = [sum(widths[:k]) for k in range(len(widths) + 1)]
    return grid(len(widths), 1, lambda i, j: (Fraction(xs[i]), Fraction(2 * j)))


def with_a_corner() -> PanelPattern:
    """A vertex that is not linear, and a fold across the corner of the sheet."""
    sheet = mesh(1, 1, 1)
    points, edges = list(sheet.vertices), set(sheet.edges) - {(0, 1), (0, 3)}
    for v in (1, 3):
        points.append(tuple((a + 2 * b) / 3 for a, b in zip(points[0], points[v], strict=True)))
    return PanelPattern(points, sorted(edges | {(0, 9), (1, 9), (0, 10), (3, 10), (9, 10)}))


MOTIONS: dict[str, Callable[[], Any]] = {
    "flaps": lambda: follow_panels(strip([3, 1, 3]), frames=2),
    "rated": lambda: follow_panels(strip([3, 1, 3]), amounts={(2, 3): 1.0, (4, 5): 0.5}, frames=2),
    "mixed": lambda: follow_panels(
        with_a_corner(), until="40deg", amounts={1: 0.625, (9, 10): -1.0}, frames=2
    ),
    "closing": lambda: follow_panels(strip([1, 4]), frames=2),
    "vertex": lambda: follow_panels(panels(single_vertex(4)), until="60deg", frames=2),
    "bent": lambda: follow_panels(mesh(1, 1, 1), until="20deg", frames=2),
    "miura": lambda: follow_panels(miura(2, 2), until="10deg", frames=2),
    "tiling": lambda: follow_panels(tiling(2, 2), until="10deg", frames=2),
    "surds": lambda: follow_panels(SHEETS["surds"](), until="10deg", frames=2),
}


@cache
def _text(name: str) -> str:
    proof = prove_panels(MOTIONS[name]())
    contacts = proof.contacts
    assert contacts is not None
    if name == "closing":  # as in version 1, where nothing is said of the last stretch
        contacts = replace(contacts, closes_from=None)
    return json.dumps(certificate_of_panel_motion(proof.motion, contacts))


def whole(name: str) -> Document:
    """A fresh copy of a certificate."""
    document: Document = json.loads(_text(name))
    return document


def given(name: str) -> Document:
    """A certificate that claims the same contact, and to be clear for a short time only."""
    document = whole(name)
    document["claims"]["clear"] = "1/8"
    document["evidence"]["clear"] = 1 << 36
    if "contact" in document["claims"]:
        document["claims"]["contact"]["time"][0] = "1/8"
    return document


def forged(name: str, change: Change) -> Document:
    """That certificate after `change(claims, evidence)`."""
    document = given(name)
    change(document["claims"], document["evidence"])
    return document


def at_rest(document: Document) -> Document:
    """The certificate with nothing claimed of contacts."""
    document["claims"] |= {"clear": "0"}
    document["claims"].pop("contact", None)
    document["evidence"] |= {"clear": 0}
    document["evidence"].pop("contact", None)
    return document


def padded(line: Line, value: Number) -> list[str]:
    """A density in the field of the sheet, or in that with the root."""
    missing = 0 if line.radicand is None else 2 * len(line.radicand.parts) - len(value.parts)
    return [str(c) for c in value.parts] + ["0"] * missing


def of_lines(pattern: PanelPattern, chosen: dict[int, int]) -> Document | None:
    """A certificate of lines of motions, one at each vertex; None if their letters do not fit."""
    document = panels_document(pattern)
    sheet, _ = read_panels(document)
    near = sheet.live([])
    lines = {v: lines_at(sheet, v, near[v])[k] for v, k in chosen.items()}
    signs: dict[tuple[int, int], int] = {}
    for v, line in lines.items():
        own = {tuple(sorted((v, u))): d.sign() for u, d in line.densities.items()}
        turn = next((signs[e] * s for e, s in own.items() if e in signs), 1)
        if any(signs.get(e, s * turn) != s * turn for e, s in own.items()):
            return None
        signs |= {e: s * turn for e, s in own.items()}
    letters = {1: "V", -1: "M", 0: "F"}
    rows = [
        {
            "vertex": v,
            "radicand": line.radicand and [str(c) for c in line.radicand.parts],
            "densities": [[u, padded(line, d)] for u, d in line.densities.items()],
        }
        for v, line in lines.items()
    ]
    return {
        "format": "exactfold panel motion",
        "version": 1,
        "pattern": document,
        "claims": {
            "assignment": "".join(letters[signs.get(fold, 0)] for fold in sheet.folds),
            "drivers": [list(min(signs))],
            "clear": "0",
        },
        "evidence": {"vertices": rows, "clear": 0},
    }
