"""Certificates of tessellations of rigid panels: what they say, and forgeries."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import pytest
from forge import Document, given, refused, stopped, verified, with_one_key_more, without

from exactfold import checker
from exactfold.checker.panels import cell
from exactfold.errors import NotApplicableError
from exactfold.panels import count_panel_cell
from exactfold.panels.periodic.certificate import panel_cell_certificate
from exactfold.pattern import PeriodicPattern, random_cell, read_cell


def panel_file(name: str) -> Document:
    """A fresh copy of a certificate."""
    return given(f"periodic-panels-{name}")


def test_miura_and_the_square_twist() -> None:
    rolling, planar = verified(panel_file("miura"))["motions"]
    assert rolling["letters"] == ["FFFFFFMM", "MMFFFFFF"]
    assert (rolling["planar"], rolling["direction"], rolling["folds"]) == (False, [0, 1], True)
    assert (planar["planar"], planar["direction"], planar["sizes"]) == (True, None, [1])
    twist = verified(panel_file("square-twist"))
    assert [motion["planar"] for motion in twist["motions"]] == [True, True]
    assert twist["folds"] == 8


@pytest.mark.parametrize(
    ("base", "diagonals", "number"),
    [
        # Densities over a field, which roll up in rational and in irrational directions.
        (read_cell("waterbomb-cell"), [(0, 1, -1, 1)], 7),
        (read_cell("square-twist-cell"), [(0, 2, 0, -1), (0, 2, 0, 0)], 4),
        # One vertex: all folds are loops.
        (random_cell(1, 5, 8), [], 1),
    ],
)
def test_other_cells(
    base: PeriodicPattern, diagonals: list[tuple[int, int, int, int]], number: int
) -> None:
    result = count_panel_cell(PeriodicPattern(base.lattice, base.points, base.faces, diagonals))
    document = panel_cell_certificate(result)
    assert len(verified(document)["motions"]) == number
    assert f"{number} component" in checker.summary(checker.check(document))


def test_a_sheet_that_rolls_up_across_the_first_axis() -> None:
    """Miura's cell with both coordinates exchanged."""
    miura = read_cell("miura-cell")
    lattice, points = ([(y, x) for x, y in some] for some in (miura.lattice, miura.points))
    faces = [tuple(reversed(face)) for face in miura.faces]
    result = count_panel_cell(PeriodicPattern(lattice, points, faces, miura.diagonals))
    motions = verified(panel_cell_certificate(result))["motions"]
    assert [motion["direction"] for motion in motions] == [[1, 0], None]


def test_what_is_undecided_has_no_certificate() -> None:
    with pytest.raises(NotApplicableError, match="not all known"):
        panel_cell_certificate(count_panel_cell("waterbomb-cell"))


def false(document: Document, line: str) -> None:
    """With the claims that it seems to show, accepted without one line only."""
    seen: list[Any] = []

    def agreeing(_: Any, fact: Any) -> bool:
        seen.append(fact)
        return True

    with without(line), pytest.MonkeyPatch.context() as patch:
        patch.setattr(cell, "same", agreeing)
        verified(document)
    number, motions, digest = seen
    document["claims"] = {"folds": number, "motions": motions, "sha256": digest}
    stopped(document, line)


def test_a_diagonal_that_is_no_edge_would_fold() -> None:
    """It is written from its other end."""
    document = panel_file("square-twist")
    u, v, i, j = document["pattern"]["diagonals"][0]
    document["pattern"]["diagonals"][0] = [v, u, -i, -j]
    false(document, f"the diagonal {(v, u, -i, -j)} is no edge")
    assert document["claims"]["folds"] == 9


def test_the_order_of_keys_and_motions_is_free() -> None:
    document = panel_file("yoshimura")
    known = verified(document)["motions"]
    document["claims"]["motions"].reverse()
    assert verified(json.loads(json.dumps(document, sort_keys=True)))["motions"] == known[::-1]


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("dimension", 1),
        ("sizes", [2]),
        ("letters", ["FFFFFFMM", "MVFFFFFF"]),
        ("planar", True),
        ("direction", [1, 0]),
        ("direction", None),
        ("folds", False),
    ],
)
def test_other_motions(key: str, value: Any) -> None:
    document = panel_file("miura")
    document["claims"]["motions"][0][key] = value
    refused(document, "the claim 'motions' is not what the pattern shows")


def test_other_claims() -> None:
    for key, value in (("folds", 9), ("sha256", "0" * 64)):
        document = panel_file("miura")
        document["claims"][key] = value
        refused(document, f"the claim {key!r} is not what the pattern shows")
    for places in ([0], [0, 1, 1]):
        document = panel_file("miura")
        motions = document["claims"]["motions"]
        document["claims"]["motions"] = [motions[k] for k in places]
        stopped(document, "the claim 'motions' is not what the pattern shows")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda d: d["pattern"].update(diagonals={}), "diagonals is not a list"),
        (lambda d: d["pattern"]["diagonals"][0].append(0), "a diagonal does not have 4 entries"),
        (lambda d: d["claims"].update(motions={}), "motions is not a list"),
    ],
)
def test_other_shapes(change: Callable[[Document], None], message: str) -> None:
    document = panel_file("square-twist")
    change(document)
    refused(document, message)


def test_false_is_no_vertex() -> None:
    document = panel_file("square-twist")
    diagonal = document["pattern"]["diagonals"][0]
    diagonal[diagonal.index(0)] = False
    refused(document, "False is not an integer")


@pytest.mark.parametrize(
    ("place", "names"),
    [("claims", "folds motions sha256"), ("pattern", "lattice vertices faces diagonals")],
)
def test_unknown_keys(place: str, names: str) -> None:
    document = with_one_key_more(panel_file("miura"), (place,))
    refused(document, f"{place}: expected an object with the keys {names}")
