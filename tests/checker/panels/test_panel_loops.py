"""Whether loops close: up to which order, and the same answer from intervals and from numbers."""

from __future__ import annotations

from typing import Any

import pytest
from forge_panels import certified

from exactfold.checker.panels import loops as panel_loops
from exactfold.checker.panels.loops import Loops
from exactfold.checker.panels.modes import Modes, Support
from exactfold.checker.sheets.panels import read_panels


def loops_of(name: str) -> tuple[Loops, list[tuple[Support, dict[int, int]]]]:
    """The loops of a sheet, and each of its modes with loops."""
    rebuilt, _ = read_panels(certified(name)["pattern"])
    modes = Modes(rebuilt, rebuilt.live([]))
    supports = [support for support in modes.supports() if support.loops]
    return Loops(modes), [(s, row) for s in supports for row in modes.listed(s)]


def test_loops_are_compared_up_to_the_order_bound(monkeypatch: pytest.MonkeyPatch) -> None:
    """2^k + 1 for k transmissions that are not linear (docs/panels.md, 4)."""
    loops, modes = loops_of("tiling")
    asked: set[tuple[int, int]] = set()
    composed = panel_loops.composed

    def told(steps: Any, order: int, *more: Any) -> Any:
        asked.add((sum(step.quadratic is not None for step in steps), order))
        return composed(steps, order, *more)

    monkeypatch.setattr(panel_loops, "composed", told)
    assert all(loops.closes(row, loop) for support, row in modes for loop in support.loops)
    assert asked == {(4, 17)}


def test_numbers_and_intervals_say_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    """A loop that fails at order 3 and later, one order after the other."""
    loops, modes = loops_of("bent")
    found = {}
    for support, row in modes:
        for loop in support.loops:
            key = (loop, tuple(sorted(row.items())))
            orders = [loops.fails(row, loop, order) for order in (3, 5, 7, 9)]
            found[key] = (loops.closes(row, loop), orders)
    monkeypatch.setattr(panel_loops, "_differs", lambda *_: None)
    again, _ = loops_of("bent")
    for support, row in modes:
        for loop in support.loops:
            key = (loop, tuple(sorted(row.items())))
            orders = [again.fails(row, loop, order) for order in (3, 5, 7, 9)]
            assert (again.closes(row, loop), orders) == found[key]
    assert list(found.values()) == [(False, [True, True, True, True])]
