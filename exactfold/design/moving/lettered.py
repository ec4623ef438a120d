"""A triangulated sheet that starts to fold with given mountains and valleys."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED, Verdict
from exactfold.design.assignments.search import match
from exactfold.design.moving.distances import fold_distances
from exactfold.design.moving.goals import Distances, signs_of
from exactfold.design.moving.result import Designed
from exactfold.design.moving.search import Search
from exactfold.pattern.crease_pattern import CreasePattern, Edge

_CANDIDATES = 12
_STEPS = 40
_TARGET = 1e-3
"""Letters are reached if every fold is this share of the shortest edge from another letter."""


@dataclass(frozen=True)
class _Wanted:
    """A branch, its side, and how far it is from the wanted letters at the start."""

    branch: int
    side: int
    distance: float


def with_letters(search: Search, letters: Mapping[Edge, str]) -> Designed:
    """A sheet that starts to fold with the letters, or the closest one that was found."""
    if why := _impossible(search.pattern, letters):
        return _nothing(search, letters, REFUTED, why)
    signs = signs_of(search.sheets.part, letters)
    points = np.repeat(search.sheets.part.points[None], len(search.zeros), axis=0)
    distances, _ = fold_distances(search.sheets.part, search.zeros, points)
    wanted = [
        _Wanted(k, side, float((side * signs * row)[signs != 0].min()))
        for k, row in enumerate(distances)
        for side in (1, -1)
    ]
    wanted.sort(key=lambda one: -one.distance)
    before = wanted[0].distance
    best: tuple[float, FloatArray, _Wanted] = (before, search.sheets.start, wanted[0])
    for one in wanted[:_CANDIDATES]:
        if best[0] >= _TARGET * search.shortest:
            break
        goal = Distances(
            search.sheets, search.zeros[[one.branch]], (one.side * signs)[None], with_faces=False
        )
        near = 2 * (abs(one.distance) + _TARGET * search.shortest)
        for place in search.followed(goal, _STEPS, "letters", first=near):
            if place.least > best[0]:
                best = place.least, place.point, one
            if place.least >= _TARGET * search.shortest:
                break
        if search.interrupted or search.clock.passed:
            break
    return _proved(search, letters, before, *best)


def _nothing(search: Search, letters: Mapping[Edge, str], status: Verdict, reason: str) -> Designed:
    """The result if no vertex is moved."""
    return Designed(
        search.pattern,
        search.pattern,
        status,
        reason,
        "letters",
        "",
        dict(letters),
        None,
        None,
        search.steps,
        search.interrupted,
    )


def _proved(
    search: Search,
    letters: Mapping[Edge, str],
    before: float,
    least: float,
    places: FloatArray,
    wanted: _Wanted,
) -> Designed:
    base = replace(_nothing(search, letters, UNDECIDED, ""), before=before, after=least)
    for sheet in search.rounded(places):
        found = match(sheet, letters)
        if found.matches:
            ray = found.matches[0]
            signs = ray.branch.sign_text
            return replace(
                base,
                pattern=sheet,
                status=PROVED,
                reason=f"the sheet starts to fold with the letters, along branch {signs}",
                signs=signs,
            )
        closest = sheet
    branch = search.branches[wanted.branch].sign_text
    signs_ = signs_of(search.sheets.part, letters) * wanted.side
    goal = Distances(search.sheets, search.zeros[[wanted.branch]], signs_[None], with_faces=False)
    i, j = _stuck(search, goal, places, signs_)
    why = "the search was interrupted" if search.interrupted else search.why_stuck(places)
    return replace(
        base,
        pattern=closest,
        reason=(
            f"the letters were not reached: nearest comes branch {branch}, on which fold "
            f"{i}-{j} keeps another letter ({why})"
        ),
        signs=branch,
    )


def _stuck(search: Search, goal: Distances, places: FloatArray, signs: FloatArray) -> Edge:
    values = goal(places[None])[0][0]
    folds = [f for f, s in zip(search.sheets.part.folds, signs, strict=True) if s]
    if not np.isfinite(values).all():
        return folds[0]
    return folds[int(np.argmin(values))]


def _impossible(pattern: CreasePattern, letters: Mapping[Edge, str]) -> str:
    """A vertex that has the letters on no sheet with these folds; empty if there is none.

    A vertex pops up only if three folds at least have one letter, and one the other
    (docs/vertices.md, Theorem 1).
    """
    for v in pattern.foldable_vertices:
        given = [letters.get((min(v, u), max(v, u)), "U") for u in pattern.star(v)]
        most = {x: given.count(x) + given.count("U") for x in "MV"}
        if min(most.values()) < 1 or max(most.values()) < 3:
            return (
                f"vertex {v} has these letters on no sheet with these folds: three folds have to "
                "have one letter, and one the other"
            )
    return ""
