"""Forged certificates of panels, each of which one line of the checker alone stops."""

from __future__ import annotations

import pytest
from forge import refused, verified
from forge_panels import Document, certified, drawn, matched, stopped

from exactfold.checker.panels import certificate as panels
from exactfold.checker.sheets.panels import PanelSheet

SQUARE = [(0, 0), (4, 0), (4, 4), (0, 4)]


# --- the drawing ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("points", "edges", "message"),
    [
        (  # a panel with a corner that reaches beyond its opposite side
            [(2, 5)],
            [(0, 4), (1, 4), (1, 2), (2, 3), (0, 3)],
            "edges 0-4 and 2-3 meet",
        ),
        (  # two panels with a bend between them that reaches beyond the boundary
            [(2, 0), (2, 4), (5, 2)],
            [(0, 4), (1, 4), (1, 2), (2, 5), (3, 5), (0, 3), (4, 6), (5, 6)],
            "edges 4-6 and 1-2 meet",
        ),
    ],
)
def test_edges_that_cross(
    points: list[tuple[int, int]],
    edges: list[tuple[int, int]],
    message: str,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Combinatorially these are disks, and all areas are positive."""
    with monkeypatch.context() as patch:
        patch.setattr(PanelSheet, "_check_apart", lambda _: None)
        forged = matched(drawn([*SQUARE, *points], edges))
    refused(forged, message)


@pytest.mark.parametrize("count", [5, 6])
def test_vertices_with_more_than_four_folds(count: int) -> None:
    """They are in no support, and have to be listed as spaces."""
    star = [(4, 0), (2, 3), (-2, 3), (-4, 0), (-2, -3), (2, -3)][6 - count :]
    rim = [(k, (k + 1) % count) for k in range(count)]
    made = drawn([*star, (0, 0)], [*map(sorted, rim), *((k, count) for k in range(count))])
    made["claims"]["supports"] = []
    refused(made, "the parts listed are not those with a vertex of more than four folds")


def test_more_keys() -> None:
    made = certified("tiling")
    [support] = made["claims"]["supports"]
    mode = support["modes"][0]
    mode["more"] = 1
    refused(made, "a mode: expected an object with the keys choice assignment extends loop order")
    del mode["more"]
    support["more"] = 1
    names = "vertices folds count extending by modes"
    refused(made, f"a support: expected an object with the keys {names}")


# --- modes ---------------------------------------------------------------------------------------

TILING = "the support of vertices 5-6-9-10"


def tiling() -> tuple[Document, Document, list[Document]]:
    """A certificate with one loop, its support and its two modes, both of which truly fold."""
    made = certified("tiling")
    [support] = made["claims"]["supports"]
    return made, support, support["modes"]


def test_other_letters() -> None:
    made = certified("strip")
    [support] = made["claims"]["supports"]
    mode = support["modes"][7]
    right, where = mode["assignment"], "-".join(map(str, support["vertices"]))
    shown = right if right[0] == "V" else right.translate(str.maketrans("MV", "VM"))
    message = (
        f"the mode {mode['choice']} of the support of vertices {where} has the letters {shown}"
    )
    changed = ["MV"[right[k] == "M"] for k in (0, 4)]
    for other in (changed[0] + right[1:], right[:4] + changed[1] + right[5:], right[1:], "", None):
        mode["assignment"] = other
        stopped(made, message)


@pytest.mark.parametrize("said", ["undecided", None])
def test_a_mode_that_extends_is_proved(said: object) -> None:
    made, _, modes = tiling()
    modes[1]["extends"] = said
    stopped(made, f"a mode of {TILING} is proved, not {said!a}")


def test_a_mode_that_does_not_extend_is_not_proved() -> None:
    made = certified("bent")
    [support] = [
        s for s in made["claims"]["supports"] if any(m["loop"] is not None for m in s["modes"])
    ]
    [mode] = support["modes"]
    mode |= {"extends": "proved", "loop": None, "order": None}
    where = "-".join(map(str, support["vertices"]))
    for number in (0, None):  # so that the number says nothing else
        support["extending"] = number
        stopped(made, f"a mode of the support of vertices {where} is refuted, not 'proved'")


@pytest.mark.parametrize("loop", [[5, 9], [5, 9, 10, 9]])
def test_a_way_back_is_no_loop(loop: list[int]) -> None:
    """From a fold to itself there is no transmission; taken for one, it would not be linear."""
    made, support, modes = tiling()
    support["extending"] = 1
    shown = "-".join(map(str, loop))
    modes[0] |= {"extends": "refuted", "loop": loop, "order": 3}
    stopped(made, f"{shown} is not a loop of {TILING}")


def test_no_loops() -> None:
    made, support, modes = tiling()
    support["extending"] = 1
    for loop in ([5], [5, 9, 6, 10], [0, 1, 5, 4], [5, 9, 10, 6, 5], [99, 98]):
        modes[0] |= {"extends": "refuted", "loop": loop, "order": 3}
        shown = "-".join(map(str, loop))
        refused(made, f"{shown} is not a loop of {TILING}")
    modes[0]["loop"] = []
    refused(made, f"the loop  of {TILING} is not proved to fail at order 3")


def test_what_is_not_decided_does_not_refute_rigidity() -> None:
    made, support, modes = tiling()
    support["extending"] = made["claims"]["true"] = None
    for mode in modes:
        mode["extends"] = "undecided"
    for support["modes"] in (modes, None):
        for said in ("refuted", "proved"):
            made["claims"]["rigid"] = said
            stopped(made, f"claim rigid = {said!a}, but it is 'undecided'")
        made["claims"]["rigid"] = "undecided"
        verified(made)


def test_rigidity() -> None:
    """By the components to second order, by those that truly fold, by any motion."""
    for second, true, moves, verdict in (
        ({"0": 1}, {"0": 1}, 0, "proved"),
        ({"0": 1}, None, 0, "proved"),
        ({"1": 1}, {"0": 1}, 0, "proved"),
        ({"1": 2}, None, 0, "undecided"),
        ({"1": 2}, None, 1, "refuted"),
        ({"1": 2}, {"1": 1}, 1, "refuted"),
    ):
        assert panels._rigid(second, true, moves) == verdict
