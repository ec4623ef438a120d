"""Certificates of flat-folded states of small sheets, as the writer makes them."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

from exactfold.exact.surds import RATIONALS
from exactfold.layers.certificate import states_certificate
from exactfold.layers.folding import fold_flat
from exactfold.pattern.panel_pattern import PanelPattern

Document = dict[str, Any]


def made(
    sheet: PanelPattern | str, letters: Mapping[tuple[int, int], str] | str, **how: Any
) -> Document:
    """The certificate of a sheet with letters, read as from a file."""
    document: Document = json.loads(
        json.dumps(states_certificate(fold_flat(sheet, letters, **how)))
    )
    return document


def strip(*widths: int) -> PanelPattern:
    """Stamps in a row; stamp k has the corners 2 k to 2 k + 3."""
    places = [sum(widths[:k]) for k in range(len(widths) + 1)]
    edges = [(2 * k, 2 * k + 1) for k in range(len(places))]
    edges += [(k, k + 2) for k in range(2 * len(widths))]
    return PanelPattern([(x, y) for x in places for y in (0, 1)], edges)


def roofs() -> PanelPattern:
    """An arrow, not convex, with a flap on a side; in Q(sqrt 2)."""
    root = RATIONALS.adjoined(2).root
    points = [(0, 0), (2, 0), (2 * root, 3), (1, 1), (0, 2), (2, -1), (0, -1), (3, -2), (0, -2)]
    edges = [(0, 1), (1, 2), (2, 3), (3, 4), (0, 4), (1, 5), (5, 6), (0, 6), (5, 7), (7, 8), (6, 8)]
    return PanelPattern(points, edges)


def grid(xs: Sequence[int], ys: Sequence[int]) -> PanelPattern:
    """Rectangles between straight lines."""
    number = {(i, j): i * len(ys) + j for i in range(len(xs)) for j in range(len(ys))}
    edges = [(number[i, j], number[i + 1, j]) for i, j in number if (i + 1, j) in number]
    edges += [(number[i, j], number[i, j + 1]) for i, j in number if (i, j + 1) in number]
    return PanelPattern([(x, y) for x in xs for y in ys], edges)
