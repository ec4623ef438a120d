"""Lines of answers: what stays together, and what is counted instead of spelled out."""

from __future__ import annotations

from dataclasses import replace

from rich.text import Text

from exactfold.app.report.connected_components import piece_notes
from exactfold.app.report.terminal import console
from exactfold.branches import count_branches
from exactfold.branches.connected_components.result import Joint
from exactfold.pattern.families import single_vertex


def test_the_time_stays_beside_the_verdict() -> None:
    out = console()
    for length in range(50, 80):
        with out.capture() as captured:
            out.print(Text(f"{'x' * length} - PROVED (0.03 s); more"), width=80)
        lines = captured.get().splitlines()
        assert len([line for line in lines if "PROVED (0.03 s)" in line]) == 1
        assert all(len(line) <= 80 for line in lines)


def test_signs_of_joints_are_listed_on_small_sheets_only() -> None:
    result = count_branches(single_vertex(6))
    assert result.connected_components is not None

    def said(number: int) -> str:
        joints = tuple(
            Joint({v: int(v < flat) for v in range(number)}, {}, "space", False) for flat in (1, 3)
        )
        known = replace(result.connected_components, vertices=tuple(range(number)), joints=joints)
        return piece_notes(replace(result, connected_components=known))[1]

    assert said(17) == (
        "families meet at 2 solutions on which 14 to 16 of the 17 stars are flat; --json has their "
        "signs"
    )
    assert said(5).endswith("0 where flat, or the opposite signs: +0000, +++00")
