"""The ways of rigid panels that `count` numbers."""

from __future__ import annotations

from dataclasses import replace

import pytest
from sheets import DENTED, scrambled

import exactfold
from exactfold._support.verdict import PROVED
from exactfold.motion.panels.listing import panel_ways
from exactfold.panels.result import Decomposition


def counted() -> Decomposition:
    found = exactfold.count(scrambled(2, DENTED, 4, loose=True))
    assert isinstance(found, Decomposition)
    return found


@pytest.mark.slow
def test_a_space_that_is_found_again_in_another_field_is_one_way() -> None:
    found = counted()
    (part,) = found.parts
    assert found.second_order == {3: 2}
    assert part.spaces_fold == (False, True)
    assert len(part.found) == 2
    assert [way.verdict for way in panel_ways(found)] == [PROVED, PROVED]


@pytest.mark.slow
def test_of_several_components_of_a_space_none_folds_because_one_was_found() -> None:
    found = counted()
    (part,) = found.parts
    leaf, other = part.spaces
    twice = replace(part, spaces=(leaf, leaf, other), spaces_fold=(False, False, True))
    ways = panel_ways(replace(found, parts=(twice,)))
    assert sorted(str(way.verdict) for way in ways) == ["proved", "undecided", "undecided"]
