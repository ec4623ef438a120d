"""Why the letters around a single vertex occur on no branch, in plain words."""

from __future__ import annotations

from typing import Protocol

from exactfold.design.refutations.refutation import Letters, refuted_at
from exactfold.pattern.crease_pattern import CreasePattern, Edge

_NAMES = {"M": "mountain", "V": "valley"}
_NAMED = 8
"""Up to this many folds are named; more are only counted."""


class Asked(Protocol):
    """What is needed of a match."""

    @property
    def letters(self) -> Letters:
        """The letter of every fold of the pattern."""

    @property
    def sheet(self) -> CreasePattern:
        """The pattern without what lies in triangulated triangles."""

    @property
    def labels(self) -> tuple[int, ...]:
        """For each vertex of `sheet` its number in the pattern."""


def fold_text(fold: Edge) -> str:
    """A fold as it is printed.

    >>> fold_text((4, 7))
    '4-7'
    """
    return f"{fold[0]}-{fold[1]}"


def vertex_conflicts(asked: Asked) -> dict[int, str]:
    """For each vertex that its letters keep from popping: why it can pop neither up nor down.

    A vertex pops up only if it has a valley, and its mountains and free folds do not all lie in one
    closed half-plane. For popping down, valleys and mountains change places (docs/assignment.md,
    The search).

    >>> from exactfold.design.assignments.search import match
    >>> from exactfold.pattern.families import single_vertex
    >>> vertex_conflicts(match(single_vertex(4), "MMMM"))[4]
    'neither up (it has no valley) nor down (it has no valley)'
    >>> vertex_conflicts(match(single_vertex(4), "MMVV"))[4]
    'neither up (its mountains 0-4, 1-4 lie on one side of a line) nor down (its valleys 2-4, 3-4
    lie on one side of a line)'
    """
    letters, labels = asked.letters, asked.labels
    own = {
        (i, j): letters[min(labels[i], labels[j]), max(labels[i], labels[j])]
        for i, j in asked.sheet.folds
    }
    why = {}
    for v in asked.sheet.interior:
        texts = []
        for sign in (1, -1):
            reason = refuted_at(asked.sheet, own, v, sign)
            if reason is None or not (isinstance(reason, str) or reason.holds(asked.sheet, own)):
                break
            texts.append(_at(asked.sheet, labels, own, v, sign))
        if len(texts) == 2:
            why[labels[v]] = f"neither up ({texts[0]}) nor down ({texts[1]})"
    return why


def _at(
    sheet: CreasePattern, labels: tuple[int, ...], own: dict[Edge, str], vertex: int, sign: int
) -> str:
    """What a vertex lacks that cannot pop to one side."""
    here = {w: own[min(vertex, w), max(vertex, w)] for w in sheet.star(vertex)}
    needed, other = ("M", "V") if sign > 0 else ("V", "M")
    folds = {
        x: [_name(labels, vertex, w) for w, letter in here.items() if letter == x] for x in "MVU"
    }
    if not folds[needed] + folds["U"]:
        return f"it has no {_NAMES[needed]}"
    if not folds[other] + folds["U"]:
        return f"it has no {_NAMES[other]}"
    parts = [_listed(f"{_NAMES[needed]}s", folds[needed]), _listed("free folds", folds["U"])]
    held = " and ".join(part for part in parts if part)
    if len(folds[needed]) == 1 and not folds["U"]:
        return f"it has one {_NAMES[needed]} only, {folds[needed][0]}"
    return f"its {held} lie on one side of a line"


def _listed(name: str, folds: list[str]) -> str:
    if not folds:
        return ""
    return f"{name} {', '.join(sorted(folds))}" if len(folds) <= _NAMED else f"{len(folds)} {name}"


def _name(labels: tuple[int, ...], v: int, w: int) -> str:
    i, j = sorted((labels[v], labels[w]))
    return f"{i}-{j}"
