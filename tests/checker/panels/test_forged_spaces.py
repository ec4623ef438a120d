"""Sheets with vertices of more than four folds: what the checker finds, and forgeries of it."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable
from fractions import Fraction
from functools import cache

import pytest
from forge import refused, verified
from forge_panels import Document, stopped
from panel_sheets import (
    crossed_stars,
    miura,
    outlined,
    regular_twist,
    row_of_stars,
    shifted_columns,
    tiling,
)

from exactfold.checker.core.reading import CertificateError, LimitError
from exactfold.checker.core.towers import Number, Tower
from exactfold.checker.panels import certificate as panels_of_checker
from exactfold.checker.panels import reduction as panel_reduction
from exactfold.checker.panels import spaces as panel_spaces
from exactfold.checker.panels.leaves import complete, extends
from exactfold.checker.panels.reduction import Joined, inside
from exactfold.checker.panels.spaces import Spaces
from exactfold.checker.sheets.panels import connected, read_panels
from exactfold.panels.certificate import certificate_of_panels
from exactfold.panels.decomposition import decompose
from exactfold.pattern.families import single_vertex
from exactfold.pattern.opening import panels
from exactfold.pattern.panel_pattern import PanelPattern

Points = list[tuple[int, int]]


def sheet(points: Points, folds: Points, inner: int) -> PanelPattern:
    """A sheet whose boundary joins the points from number `inner` on."""
    return outlined([(Fraction(x), Fraction(y)) for x, y in points], folds, inner)


def triangle(pleat: tuple[int, int] = (15, 3)) -> PanelPattern:
    """A panel with three corners, of five, four and four folds; the roots of two are rational."""
    points = [(0, 0), (8, 0), (3, 7), (-5, 2), (-6, -3), (-1, -6), (8, -7), pleat, (5, 8), (-2, 14)]
    folds = [(0, 1), (1, 2), (0, 2), (0, 3), (0, 4), (0, 5), (1, 6), (1, 7), (2, 8), (2, 9)]
    return sheet(points, folds, 3)


def cone() -> PanelPattern:
    """A vertex with five folds at the end of a straight row: the row may fold or stay flat."""
    points = [(0, 0), (4, 0), (-1, 3), (5, 4), (12, 0), (5, -4), (11, -4), (16, -1), (16, 3)]
    points += [(11, 4), (9, 6), (6, 9), (1, 8), (-4, 4), (-4, 0), (-1, -4)]
    folds = [(0, 1), (0, 2), (1, 3), (2, 3), (1, 4), (0, 14), (0, 15), (1, 5)]
    folds += [(2, 12), (2, 13), (3, 10), (3, 11), (4, 6), (4, 7), (4, 8), (4, 9)]
    return sheet(points, folds, 5)


def stars(shared: bool) -> PanelPattern:
    """Two vertices with five folds each to the boundary, and one that they share, or none."""
    points = [(0, 0), (9, 0), (3, -5), (6, -5), (12, -4), (14, 0), (12, 4), (6, 5), (3, 5)]
    points += [(-3, 4), (-5, 0), (-3, -4)]
    folds = [(0, 2), (0, 8), (0, 9), (0, 10), (0, 11), (1, 3), (1, 4), (1, 5), (1, 6), (1, 7)]
    return sheet(points, [*folds, (0, 1)] if shared else folds, 2)


SHEETS: dict[str, Callable[[], PanelPattern]] = {
    "star": lambda: panels(single_vertex(6)),
    "triangle": triangle,
    "six lines": lambda: triangle((15, 0)),
    "cone": cone,
    "stars": lambda: stars(shared=False),
    "joined stars": lambda: stars(shared=True),
    "row of stars": row_of_stars,
    "crossed stars": crossed_stars,
}


@cache
def _text(name: str) -> str:
    return json.dumps(certificate_of_panels(decompose(SHEETS[name]())))


def certified(name: str) -> Document:
    """A fresh copy of the certificate of a sheet."""
    document: Document = json.loads(_text(name))
    return document


def leaves_of(made: Document, part: int = 0) -> list[Document]:
    found: list[Document] = made["claims"]["spaces"][part]["leaves"]
    return found


def spaces_of(pattern: Document) -> list[Spaces]:
    rebuilt, _ = read_panels(pattern)
    return [Spaces(rebuilt, near) for near in connected(rebuilt.live([]))]


# --- what is found -------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "second", "true"),
    [
        ("star", {"3": 1}, True),
        ("triangle", {"1": 8}, True),
        ("six lines", {"1": 6}, False),
        ("cone", {"2": 1}, False),
        ("stars", {"4": 1}, True),
        ("joined stars", {"5": 1}, True),
        ("row of stars", {"5": 1}, True),
        ("crossed stars", {"5": 2}, False),
    ],
)
def test_valid(name: str, second: dict[str, int], true: bool) -> None:
    made = certified(name)
    claims = verified(made)
    assert claims["second_order"] == second
    assert claims["true"] == (second if true else None)
    assert claims["rigid"] == "refuted"
    claims = made["claims"]
    for part in claims["spaces"]:
        part["complete"] = False
        for leaf in part["leaves"]:
            leaf["extending"] = 0
    claims["true"] = None
    refused(made, "claim rigid = 'refuted', but it is 'undecided'")
    claims["rigid"] = "undecided"
    verified(made)  # less is claimed


@pytest.mark.parametrize(
    "pattern",
    [miura(2, 2), tiling(2, 2), shifted_columns(1), regular_twist(4, (Fraction(-1), Fraction(-3)))],
)
def test_spaces_are_those_of_the_structure_theorem(pattern: PanelPattern) -> None:
    """With four folds at each vertex there are two ways: modes, and splitting forms."""
    result = decompose(pattern)
    document = certificate_of_panels(result)
    found, true = Counter[int](), Counter[int]()
    for spaces in spaces_of(document["pattern"]):
        for leaf in spaces.leaves():
            found[leaf.dimension] += 1
            true[leaf.dimension] += extends(spaces, leaf)
    assert result.theory == "modes"
    assert found == (result.second_order if set(result.second_order or ()) != {0} else {})
    assert true == found if result.true == result.second_order else true != found


def test_more_lines_may_be_tangent_where_the_derivatives_leave_more() -> None:
    [regular] = spaces_of(certified("triangle")["pattern"])
    [other] = spaces_of(certified("six lines")["pattern"])
    assert complete(regular, regular.leaves())
    assert not complete(other, other.leaves())


def test_summary() -> None:
    said = panels_of_checker.summary(verified(certified("six lines")))
    assert said.startswith(
        "VALID: the motions of the sheet of 10 folds and 3 interior vertices have the components "
        "6 of dimension 1 to second order, and those of the true motions are not decided "
        "(at least 6 components of its parts extend to true motions); sha256"
    )


# --- what is claimed of leaves -------------------------------------------------------------------


def test_a_leaf_is_missing() -> None:
    made = certified("six lines")
    leaves_of(made).pop()
    stopped(made, "the part of vertex 0 has other leaves than those listed")
    made = certified("cone")
    leaves_of(made)[0]["cones"] = []
    refused(made, "the part of vertex 0 has other leaves than those listed")


def test_a_leaf_twice() -> None:
    made = certified("cone")
    leaves_of(made).append(leaves_of(made)[0])
    stopped(made, "the part of vertex 0 has leaves of one kind twice")


def test_number_of_leaves() -> None:
    made = certified("triangle")
    leaves_of(made)[0]["number"] = 5
    made["claims"]["spaces"][0]["complete"] = False
    stopped(made, "the part of vertex 0 has 4 leaves of a kind, not 5")


def test_leaves_that_fold() -> None:
    made = certified("cone")
    [leaf] = leaves_of(made)
    leaf["extending"] = 2
    stopped(made, "the part of vertex 0: 1 leaves of a kind are proved to fold, not 2")


def test_complete() -> None:
    made = certified("cone")
    [part] = made["claims"]["spaces"]
    part["complete"] = True
    refused(made, "the part of vertex 0 may have other true motions")
    part["complete"] = 0
    stopped(made, 'the part of vertex 0: "complete" is neither true nor false')
    made = certified("triangle")
    leaves_of(made)[0]["extending"] = 3
    stopped(made, "the part of vertex 0 has leaves that are not proved to fold")
    made = certified("six lines")
    made["claims"]["spaces"][0]["complete"] = True
    stopped(made, "the part of vertex 0 may have other true motions")


def test_parts() -> None:
    made = certified("stars")
    parts = made["claims"]["spaces"]
    made["claims"]["spaces"] = [parts[0], parts[1], parts[1]]
    stopped(made, "a part of the sheet appears twice")
    made["claims"]["spaces"] = [parts[0]]
    refused(made, "the parts listed are not those with a vertex of more than four folds")
    made["claims"]["spaces"] = [parts[0], {**parts[1], "vertices": [0, 1]}]
    refused(made, "the parts listed are not those with a vertex of more than four folds")
    made = certified("star")
    made["claims"]["modes"] = 0
    refused(made, "claim modes = 0, but it is None")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            {"more": 1},
            "a leaf: expected an object with the keys folds dimension cones number extending",
        ),
        ({"folds": {}}, "folds is not a list"),
        ({"folds": [[0]]}, "a fold does not have 2 entries"),
        ({"dimension": -1}, "dimension is not a natural number"),
        ({"cones": ["6"]}, "a vertex is not a natural number"),
        ({"cones": 6}, "cones is not a list"),
        ({"number": True}, "number is not a natural number"),
        ({"extending": None}, "extending is not a natural number"),
    ],
)
def test_what_a_leaf_is(change: Document, message: str) -> None:
    made = certified("star")
    leaves_of(made)[0].update(change)
    refused(made, message)


# --- limits --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("module", "bound", "message"),
    [
        (panel_reduction, "MOST_STEPS", "the steps to the spaces of motions, "),
        (panel_spaces, "MOST_LEAVES", "the spaces of motions, "),
    ],
)
def test_bounds(module: object, bound: str, message: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, bound, 1)
    made = certificate_of_panels(decompose(miura(2, 2)))
    [spaces] = spaces_of(made["pattern"]) if bound != "MOST_STEPS" else [None]
    with pytest.raises(LimitError, match=message):
        (spaces or spaces_of(made["pattern"])[0]).leaves()


def test_a_space_inside_another_in_a_field_that_neither_names(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """sqrt 2 and sqrt 8 / 2 are one number of two towers; sqrt 3 is another."""
    rational = Tower()
    two, root = rational.adjoined(rational.number(2))
    _, other = rational.adjoined(rational.number(8))
    _, three = rational.adjoined(rational.number(3))
    half = rational.number(Fraction(1, 2))
    one = rational.number(1)
    line = [{(0, 1): one, (0, 2): root}]
    assert inside(line, [{(0, 1): one, (0, 2): half * other}])
    assert not inside(line, [{(0, 1): one, (0, 2): three}])
    assert not inside(line, [{(0, 1): one}])
    joined = Joined()
    assert (joined.of(root) - joined.of(half * other)).sign() == 0
    assert two.size == joined.tower.size == 2
    monkeypatch.setattr(panel_reduction, "MOST_ROOTS", 0)
    with pytest.raises(LimitError, match="the square roots that two spaces need, 1, are more"):
        inside(line, [{(0, 1): one, (0, 2): half * other}])


def test_numbers_of_fields_apart_do_not_go_together() -> None:
    rational = Tower()
    roots = [rational.adjoined(rational.number(k))[1] for k in (2, 3)]
    with pytest.raises(CertificateError, match="neither of which contains the other"):
        Number.__add__(*roots)


def test_products_in_larger_fields_are_more_work() -> None:
    rational = Tower()
    two, _ = rational.adjoined(rational.number(2))
    above, root = two.adjoined(two.number(3))
    work = panel_reduction.Work()
    work.count(2, rational.number(1))
    work.count(3, root)
    work.count(4, root + above.number(1))
    work.count(7, above.number(0))
    work.count(5, root.enclosed(64))
    assert (above.size, work.steps) == (4, 2 + 3 * 4 + 4 * 2 * 4 + 7 * 4 + 5)


def test_numbers_are_not_taken_for_those_of_another_field() -> None:
    rational = Tower()
    two, root = rational.adjoined(rational.number(2))
    three, _ = rational.adjoined(rational.number(3))
    for other in (rational, three):
        with pytest.raises(CertificateError, match="neither of which contains the other"):
            other.number(root)
        with pytest.raises(CertificateError, match="neither of which contains the other"):
            other.adjoined(root)
    assert two.number(root).parts == root.parts
