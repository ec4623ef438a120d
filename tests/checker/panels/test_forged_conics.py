"""Leaves with several components: forgeries of their number, and what the checker asks of them."""

from __future__ import annotations

import json
from functools import cache

import pytest
from forge import refused, verified
from forge_panels import Document
from panel_sheets import corner_diagonals
from test_forged_spaces import leaves_of, spaces_of

from exactfold.checker.core.reading import CertificateError, LimitError
from exactfold.checker.panels import conics, leaves
from exactfold.checker.panels.leaves import components
from exactfold.checker.panels.signs import with_own_folds
from exactfold.checker.panels.spaces import Leaf
from exactfold.panels.certificate import certificate_of_panels
from exactfold.panels.decomposition import decompose


@cache
def _text() -> str:
    return json.dumps(certificate_of_panels(decompose(corner_diagonals())))


def certified() -> Document:
    made: Document = json.loads(_text())
    return made


def test_two_components() -> None:
    claims = verified(certified())
    assert claims["second_order"] == {"4": 2}
    assert claims["true"] is None


@pytest.mark.parametrize("number", [1, 3])
def test_the_number_of_components_is_found_again(number: int) -> None:
    made = certified()
    [leaf] = leaves_of(made)
    leaf["number"], leaf["extending"] = number, 1
    made["claims"]["second_order"] = {"4": number}
    refused(made, f"the part of vertex 0 has 2 leaves of a kind, not {number}")


@pytest.mark.slow
def test_without_the_signs_of_roots_nothing_is_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(conics.Conics, "_chain", lambda *_: None)
    refused(certified(), "the zeros of the forms of vertices 0, 1, 2, 3 may be other components")


def test_a_component_lies_in_no_other_leaf(monkeypatch: pytest.MonkeyPatch) -> None:
    [spaces] = spaces_of(certified()["pattern"])
    [leaf] = spaces.leaves()
    assert len(components(spaces, leaf, [leaf])) == 2
    smaller = Leaf(leaf.basis[1:], ())
    assert len(components(spaces, leaf, [leaf, smaller])) == 2
    with pytest.raises(CertificateError, match="may lie in another leaf"):
        components(spaces, leaf, [leaf, Leaf(leaf.basis, ())])


def test_the_roots_of_tangents_are_limited(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(conics, "MOST_ROOTS", -1)
    made = certified()
    [spaces] = spaces_of(made["pattern"])
    with pytest.raises(LimitError, match="the square roots that tangents need"):
        leaves.verified_part(spaces.sheet, spaces.near, made["claims"]["spaces"][0])


def test_each_motion_of_a_basis_moves_a_fold_of_its_own() -> None:
    [spaces] = spaces_of(certified()["pattern"])
    space = spaces.first_order
    one = spaces.sheet.tower.number(1)
    mixed = [space[0]]
    for motion in space[1:]:
        mixed.append(spaces.plus(motion, one, mixed[-1]))
    for basis in (space, mixed):
        found = with_own_folds(spaces, basis)
        users = [set(m) for m in found]
        assert len(found) == len(space)
        for k, folds in enumerate(users):
            assert folds - set().union(*(other for n, other in enumerate(users) if n != k))
