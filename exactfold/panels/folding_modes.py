"""Modes of a large part that are known to truly fold, when not all components are known."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import islice
from typing import Final

from exactfold._support.clock import UNLIMITED, Clock
from exactfold._support.verdict import PROVED
from exactfold.exact.surds import exact, sign, simple
from exactfold.panels.clauses import ModeClauses
from exactfold.panels.modes.extension import extension
from exactfold.panels.result import Mode
from exactfold.panels.spaces.found import exact_leaf
from exactfold.panels.spaces.kernel import Rows, entry, number
from exactfold.panels.spaces.proposals import Proposals, is_too_large
from exactfold.panels.spaces.straight import straight_creases
from exactfold.panels.spaces.subspaces import independent_parts
from exactfold.panels.vertex.local import LocalMode
from exactfold.panels.vertex.stars import Star
from exactfold.pattern.panel_pattern import Edge, PanelPattern

MOST_MODES: Final = 12
_TRIES: Final = 5
"""If this many exactly computed proposals give no mode, the search stops."""
_MOST_ROOTS: Final = 3
_MOST_BY_CLAUSES: Final = 200


def folding_modes(
    pattern: PanelPattern,
    moving: Mapping[int, Star],
    rows: Rows,
    size: int,
    most: int,
    clock: Clock = UNLIMITED,
) -> list[Mode]:
    """Modes that are proved to truly fold; those that share no vertex, and then up to twelve.

    Straight creases from boundary to boundary are modes. Others are found by clauses, if python-sat
    is installed (`ModeClauses`). If there are none, or without python-sat, `Proposals` suggests
    linear spaces on which all forms vanish, and each is computed again exactly. `rows` is a space
    that contains all real motions of the part; it is empty if none is known. A proposed space may
    be a direct sum of spaces. If one of these is a line on which no vertex has more than four
    active folds, the line is a mode, and the extension theorem says whether it truly folds
    (docs/panels.md, Which modes truly fold). The motions of a mode need not be a component: they
    may lie in a larger family, and there may be many more modes. The work is limited to `most`
    steps, as in `found_components`, and by the clock. If no mode is found, nothing follows.
    """
    straight = (folding_mode(pattern, moving, line) for line in straight_creases(moving))
    modes = _by_letters(mode for mode in straight if mode is not None)
    clauses = ModeClauses(pattern, moving, clock=clock)
    modes |= _by_letters(islice(clauses, _MOST_BY_CLAUSES))
    if not modes:
        modes |= _by_letters(_proposed(pattern, moving, rows, size, most, clock))
    return _chosen(sorted(modes.values(), key=lambda mode: -len(mode.assignment)))


def _by_letters(modes: Iterable[Mode]) -> dict[tuple[tuple[Edge, str], ...], Mode]:
    return {tuple(sorted(mode.assignment.items())): mode for mode in modes}


def _proposed(
    pattern: PanelPattern,
    moving: Mapping[int, Star],
    rows: Rows,
    size: int,
    most: int,
    clock: Clock,
) -> Iterator[Mode]:
    """Modes on lines that `Proposals` suggests."""
    if not rows or clock.passed or is_too_large(rows, size):
        return
    work, found = 0, False
    for tried, proposal in enumerate(Proposals(moving, rows, size, regular=False, clock=clock)):
        work += (len(proposal.steps) + 1) * len(rows) * size
        if work > most or (tried == _TRIES and not found) or clock.passed:
            return
        leaf = exact_leaf(moving, rows, size, proposal, _MOST_ROOTS)
        if leaf is None or leaf.vertices:
            continue
        lines: Rows = {edge: [entry(x) for x in row] for edge, row in leaf.rows.items()}
        for line, dimension in independent_parts(lines, leaf.size, moving):
            mode = folding_mode(pattern, moving, line) if dimension == 1 else None
            if mode is not None:
                found = True
                yield mode


def _chosen(modes: Sequence[Mode]) -> list[Mode]:
    """Modes without a common vertex, as many as a simple choice finds, and the first of the others.

    The choice takes modes with few vertices first.
    """
    together: set[int] = set()
    kept: list[int] = []
    for k in sorted(range(len(modes)), key=lambda k: len(modes[k].active)):
        if not together.intersection(modes[k].active):
            together.update(modes[k].active)
            kept.append(k)
    others = [k for k in range(len(modes)) if k not in kept]
    kept += others[: max(0, MOST_MODES - len(kept))]
    return [modes[k] for k in sorted(kept)]


def folding_mode(pattern: PanelPattern, moving: Mapping[int, Star], line: Rows) -> Mode | None:
    """The mode on a line of motions if it is known to truly fold; otherwise None.

    All other folds are held flat. None does not show that the mode does not fold: a true motion
    might use the other folds at a higher order.
    """
    choice = [_local(star, line) for star in moving.values() if set(star.folds) & set(line)]
    if any(len(mode.folds) > 4 for mode in choice):
        return None
    stars = {mode.vertex: moving[mode.vertex].only(mode.folds) for mode in choice}
    extends = extension(pattern, stars, choice)
    if extends.verdict is not PROVED:
        return None
    first = min(line)
    up = sign(number(line[first][0]))
    letters = {e: "V" if sign(number(line[e][0])) == up else "M" for e in sorted(line)}
    return Mode(tuple(sorted(stars)), letters, extends, tuple(choice))


def _local(star: Star, line: Rows) -> LocalMode:
    """The motion of one vertex on a space with one parameter."""
    folds = tuple(edge for edge in star.folds if edge in line)
    scale = exact(number(line[folds[0]][0]))
    values = tuple(simple(number(line[edge][0]) / scale) for edge in folds)
    return LocalMode(star.vertex, 0, folds, values)
