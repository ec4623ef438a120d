"""Certificates for the checker: whether rigid panels start to fold with given letters."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from itertools import combinations
from math import ceil, log2
from typing import Any, Final

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED, Verdict
from exactfold.certificates.entries import Document
from exactfold.checker.letters.panels import PANEL_LETTERS, PanelLettersClaims
from exactfold.design.panels.cells import CellSearch, Steps
from exactfold.design.panels.excluding import excluded
from exactfold.design.panels.match import PanelMatch, flat_with_letters, rests
from exactfold.design.panels.parts import PartAnswer
from exactfold.design.panels.refutation import PanelRefutation, held
from exactfold.design.panels.regular_motion import regular_motion
from exactfold.errors import NotApplicableError
from exactfold.exact.surds import Number, exact
from exactfold.panels.modes.extension import Loops, extension
from exactfold.panels.vertex.stars import Star, bracket, stars
from exactfold.pattern.panel_entries import number_document, panels_document
from exactfold.pattern.panel_pattern import Edge, PanelPattern

_BITS: Final = 62
_SLACK: Final = 8  # more bits of the inverse than |1 - Y J| < 1 needs


def starting_certificate(matched: PanelMatch) -> Document:
    """The proof, as a JSON object, that panels start to fold with given letters or do not.

    Raises `NotApplicableError` if the question is undecided or was answered by splitting forms, or
    if the positions of vertices are known only nearly.
    """
    if matched.starts is UNDECIDED:
        raise NotApplicableError(
            "this match is undecided; only a match that is proved has a certificate"
        )
    matched.pattern.check_positions()
    moving = stars(matched.pattern, held(matched.letters))
    truly, evidence = matched.truly, dict[str, Any]()
    if matched.starts is PROVED:
        evidence["motion"] = [motion_evidence(matched, moving, part) for part in matched.parts]
        if truly is REFUTED:
            part = next(part for part in matched.parts if part.truly is REFUTED)
            evidence |= {
                "refuted": [],
                "tree": _failing(matched, {v: moving[v] for v in part.vertices}),
            }
    else:
        evidence, truly = _refuted(matched, moving)
        truly = REFUTED if rests(matched, moving) else truly
    first = matched.first_order
    claims: PanelLettersClaims = {
        "letters": "".join(matched.letters[fold] for fold in matched.pattern.folds),
        "starts": str(matched.starts),
        "truly": str(truly),
        "together": [] if first is None else _pairs(first.together),
        "never": [] if first is None else _pairs(first.never),
    }
    evidence |= _first_order(matched)
    return {
        "format": PANEL_LETTERS.format,
        "version": PANEL_LETTERS.version,
        "pattern": panels_document(matched.pattern),
        "claims": claims,
        "evidence": evidence,
    }


# --- no motion -----------------------------------------------------------------------------------


def _refuted(matched: PanelMatch, moving: Mapping[int, Star]) -> tuple[Document, Verdict]:
    """The evidence of one part that cannot move with its letters.

    A part for which true motions are refuted is preferred.
    """
    parts = [part for part in matched.parts if part.starts is REFUTED]
    if not parts:
        i, j = flat_with_letters(matched.pattern, matched.letters, moving)[0]
        return {"refuted": [], "tree": [["flat", i, j]]}, REFUTED
    part = min(parts, key=lambda part: part.truly is not REFUTED)
    own = {v: moving[v] for v in part.vertices}
    if part.by_list:
        truly = part.truly is REFUTED
        step = excluded(matched.pattern, matched.letters, part.vertices, truly=truly)
        return {"refuted": [], "tree": [step]}, part.truly
    if part.vertex is not None:
        return {"refuted": [], "tree": [["vertex", part.vertex]]}, part.truly
    if not part.refutations:
        return {"refuted": [], "tree": _open_loops(matched, own, part.named)}, part.truly
    sets = [_set(matched, own, refutation) for refutation in part.refutations]
    if part.tree:
        return {"refuted": sets, "tree": [list(step) for step in part.tree]}, part.truly
    signs = [(v, s) for refutation in part.refutations for v, s in refutation.signs.items()]
    if not signs:
        return {"refuted": sets, "tree": [["refuted", 0]]}, part.truly
    v, first = signs[0]
    if len(sets) == 1:  # all letters of the vertex are equal, which refutes both signs
        return {"refuted": [], "tree": [["curved", v]]}, part.truly
    ends = [["refuted", 0], ["refuted", 1]]  # the case in which the vertex is up comes first
    return {
        "refuted": sets,
        "tree": [["split", v], *(ends if first > 0 else ends[::-1])],
    }, part.truly


def _set(matched: PanelMatch, moving: Mapping[int, Star], refutation: PanelRefutation) -> Document:
    """The vectors of a refutation, and the heights of all neighbours that a moving fold reaches.

    The neighbours are sorted by number.
    """
    field, scale, heights = matched.pattern.field, _scale(matched.pattern), []
    for v in sorted({v for v, _ in refutation.heights}):
        around = sorted(i + j - v for i, j in moving[v].folds)
        star = [number_document(refutation.heights.get((v, u), 0), field) for u in around]
        heights.append([v, star])
    return {
        "signs": [[v, s] for v, s in sorted(refutation.signs.items())],
        "planes": [
            [v, [number_document(x * scale, field) for x in y]]
            for v, y in sorted(refutation.planes.items())
        ],
        "heights": heights,
    }


def _scale(pattern: PanelPattern) -> Number:
    """The factor by which the directions of stars are longer than in the drawing."""
    i, j = pattern.edges[0]
    axis = 0 if pattern.direction(i, j)[0] else 1
    drawn = pattern.vertices[j][axis] - pattern.vertices[i][axis]
    return pattern.direction(i, j)[axis] / exact(drawn)


def _open_loops(matched: PanelMatch, own: Mapping[int, Star], loop: Iterable[int]) -> list[Any]:
    """The cases of the vertices of one loop if they suffice, else of all with at most
    four folds.
    """
    few = {v: star for v, star in own.items() if len(star.folds) <= 4}
    for stars_ in ({v: few[v] for v in loop}, few):
        search = CellSearch(stars_, matched.letters, matched.pattern.field)
        if stars_ and next(iter(search), None) is None:
            return _tree(search.cases, [])
    raise NotApplicableError(
        "no certificate can be written: the loop of vertices with at most four folds that refutes "
        "the letters was not found again"
    )


def _failing(matched: PanelMatch, own: Mapping[int, Star]) -> list[Any]:
    """All cells with the letters, each with a loop that does not close at some order in
    the angle.
    """
    search = CellSearch(own, matched.letters, matched.pattern.field)
    known: Loops = {}
    failing = []
    for cell in search:
        each = (extension(matched.pattern, own, mode, known) for mode in cell.modes)
        fails = next(each for each in each if each.verdict is REFUTED)
        failing.append(["loop", list(fails.cycle), fails.order])
    return _tree(search.cases, failing)


def _tree(cases: Steps, cells: list[list[Any]]) -> list[list[Any]]:
    """The steps as the file contains them; `cells` gives the steps that stand for cells."""
    tree = []
    for kind, at in cases:
        if kind == "cell":
            tree.append(cells[at])
        else:
            tree.append([kind, list(at) if kind == "loop" else at])
    return tree


# --- to first order ------------------------------------------------------------------------------


def _first_order(matched: PanelMatch) -> Document:
    """The motion of `matched.first_order`, and its vectors, step by step."""
    if matched.first_order is None:
        return {"flat": [], "densities": []}
    field, scale = matched.pattern.field, _scale(matched.pattern)
    steps = [
        [[v, [number_document(x * scale, field) for x in y]] for v, y in sorted(step.items())]
        for step in matched.first_order.steps
    ]
    motion = sorted(matched.first_order.motion.items())
    densities = [[i, j, number_document(x, field)] for (i, j), x in motion]
    return {"flat": steps, "densities": densities}


def _pairs(folds: Iterable[Edge]) -> list[list[int]]:
    return [[i, j] for i, j in folds]


# --- motions -------------------------------------------------------------------------------------


def motion_evidence(
    matched: PanelMatch, moving: Mapping[int, Star], part: PartAnswer
) -> Document | None:
    """The evidence of a part that moves: None if no letters are asked of it, signs, or densities.

    If all vertices have at most four folds, the signs of the folds are enough.
    """
    own = {v: moving[v] for v in part.vertices}
    folds = sorted({edge for star in own.values() for edge in star.folds})
    if not any(matched.letters[edge] in "MV" for edge in folds):
        return None
    if all(len(star.folds) <= 4 for star in own.values()):
        letters = ("FVM"[int(np.sign(part.densities.get(edge, 0)))] for edge in folds)
        return {"sides": "".join(letters)}
    near = {edge: part.densities.get(edge, 0.0) for edge in folds}
    boxes = regular_motion(own, near)
    if boxes is None:
        raise NotApplicableError(
            "no certificate can be written: the motion was found by splitting forms, and the "
            "checker knows no such proof"
        )
    unknowns = [k for k, edge in enumerate(folds) if boxes[edge][1]]
    radius = 2 * max(radius for _, radius in boxes.values())
    longest = max(abs(float(x)) for s in own.values() for d in s.directions for x in d)
    true = longest / float(_scale(matched.pattern))
    unit = round(log2(true))
    matrix = _derivative(own, near, true / longest / 2.0**unit)
    inverse = np.linalg.inv(matrix[:, unknowns])
    shift = _SLACK + max(0, ceil(log2(np.abs(matrix).sum())))
    return {
        "densities": [round(near[edge] * 2**_BITS) for edge in folds],
        "bits": _BITS,
        "unit": unit,
        "unknowns": unknowns,
        "inverse": [[round(x * 2**shift) for x in row] for row in inverse.tolist()],
        "shift": shift,
        "radius": ceil(radius * 2**_BITS),
    }


def _derivative(own: Mapping[int, Star], near: Mapping[Edge, float], scale: float) -> FloatArray:
    """The derivatives of all conditions in the order of the checker: x, y, and the form.

    In the form, the fold to the neighbour with the smallest number comes first.
    """
    place = {edge: k for k, edge in enumerate(sorted(near))}
    rows = []
    for _, star in sorted(own.items()):
        at = [place[edge] for edge in star.folds]
        pair = len(star.folds) == 2
        axes = [0 if star.directions[0][0] else 1] if pair else [0, 1]
        for axis in axes:
            row = np.zeros(len(place))
            row[at] = [scale * float(d[axis]) for d in star.directions]
            rows.append(row)
        if pair:
            continue
        row = np.zeros(len(place))
        spokes = list(zip(star.folds, star.directions, strict=True))
        first = min(range(len(spokes)), key=lambda k: sum(spokes[k][0]))
        for (e, c), (f, d) in combinations(spokes[first:] + spokes[:first], 2):
            size = scale**2 * float(bracket(c, d))
            row[place[e]] += size * near[f]
            row[place[f]] += size * near[e]
        rows.append(row)
    return np.array(rows)
