"""Torques for all branches of a sheet: the same as one by one, with the same proofs."""

from dataclasses import replace
from fractions import Fraction

import driving
import numpy as np
import pytest

from exactfold import PROVED, UNDECIDED, random_square
from exactfold.branches import count_branches
from exactfold.design import Directions, actuate, actuate_all
from exactfold.design.actuation import every
from exactfold.design.actuation.interior import largest_margins
from exactfold.design.actuation.orthogonal import alone, alone_each
from exactfold.design.actuation.powers import Powers, leading_rivals
from exactfold.errors import NotCountedError, UndecidedBranchError
from exactfold.pattern import degenerate
from exactfold.pattern.families import flat_vertex_square, single_vertex, two_vertex

BRANCHES = list(count_branches(random_square(3, seed=5)).branches)
DIRECTIONS = Directions.of(BRANCHES)
FOLDS = len(DIRECTIONS.folds)


@pytest.mark.parametrize(
    "pattern",
    [
        random_square(2, seed=1),
        random_square(3, seed=2),
        single_vertex(4),
        flat_vertex_square(),
    ],
    ids=["two", "three", "one", "flat"],
)
def test_each_branch_is_that_of_actuate(pattern):
    every_one = actuate_all(pattern)
    assert [f.branch.sign_text for f in every_one] == [
        b.sign_text for b in count_branches(pattern).branches
    ]
    for found in every_one:
        one = actuate(pattern, found.branch.vertex_signs)
        judged = actuate(pattern, found.branch.vertex_signs, torques=found.torques)
        assert found.status is judged.status is PROVED
        assert found.margin[0] <= one.bound
        assert one.margin[0] <= found.bound
        assert judged.margin[0] <= found.margin[1]
        assert found.margin[0] <= judged.margin[1]
        assert found.bound - found.margin[0] < Fraction(1, 10**6)
        assert found.orthogonal_dimension == one.orthogonal_dimension
        assert len(found.independent) == len(one.independent)
        assert found.branch.sign_text not in found.independent
        assert (found.orthogonal is None) == (one.orthogonal is None)
        assert found.ranking()[0].signs == found.branch.sign_text


@pytest.mark.parametrize("pattern", [random_square(3, seed=1), degenerate.notched(2)])
def test_the_opposite_ray_has_the_same_margin_with_opposite_torques(pattern):
    """Its own dual program, and the powers of the opposite torques, to the last digit."""
    every_one = actuate_all(pattern)
    units = driving.directions([found.branch for found in every_one])
    for b, found in enumerate(every_one):
        turned = units.copy()
        turned[b] = -units[b]
        assert float(found.bound) == pytest.approx(
            driving.dual_optimum(driving.gaps(turned, b)), abs=1e-6
        )
        torques = list(found.torques.values())
        over = found.directions.with_row(b, found.directions.alone(b, -1))
        assert Powers.of(over, [-t for t in torques]).margin(b) == Powers.of(
            found.directions, torques
        ).margin(b)


def test_sheets_with_thin_triangles_are_sharpened():
    """One whose roots are known to a millionth: the bounds of margins would be wide."""
    for found in actuate_all(random_square(6, seed=44)):
        assert found.status is PROVED
        assert found.margin[0] >= found.bound * Fraction(9998, 10000)


@pytest.mark.parametrize(
    "spoil", [lambda found: None, lambda found: replace(found, torques=0 * found.torques)]
)
def test_where_the_programs_fail_branches_are_done_one_by_one(monkeypatch, spoil):
    pattern = two_vertex()
    expected = [actuate(pattern, b.vertex_signs) for b in count_branches(pattern).branches]

    def spoilt(units, places):
        return (spoil(found) for found in largest_margins(units, places))

    monkeypatch.setattr(every, "largest_margins", spoilt)
    found = actuate_all(pattern)
    assert [f.torques for f in found] == [f.torques for f in expected]
    assert [float(f.bound) for f in found] == pytest.approx([float(f.bound) for f in expected])


# --- the parts -----------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", range(3))
def test_the_largest_rival_is_a_leading_one(seed):
    source = np.random.default_rng(seed)
    rows = source.integers(-(10**12), 10**12, (len(BRANCHES), FOLDS), endpoint=True)
    sharp = Directions.of([branch.sharpened(128) for branch in BRANCHES])
    leading = leading_rivals(DIRECTIONS, range(len(BRANCHES)), rows)
    for b, others in enumerate(leading):
        tau = [Fraction(t, 10**12) for t in rows[b].tolist()]
        low, high = Powers.of(DIRECTIONS, tau, [b, *others]).margin(0)
        wide, true = Powers.of(DIRECTIONS, tau).margin(b), Powers.of(sharp, tau).margin(b)
        assert wide[0] <= low <= true[1]
        assert true[0] <= high <= wide[1]
    assert sum(map(len, leading)) <= len(BRANCHES)


def test_all_rivals_of_no_torques_lead():
    assert leading_rivals(DIRECTIONS, [2], np.zeros((1, FOLDS), dtype=np.int64)) == [
        [0, 1, 3, 4, 5, 6, 7]
    ]


def test_all_rivals_lead_where_one_is_not_known():
    nothing = replace(
        DIRECTIONS.alone(0, 1),
        low=((-(1 << 96),) * FOLDS,),
        high=((1 << 96,) * FOLDS,),
    )
    wide = DIRECTIONS.with_row(3, nothing)
    rows = np.full((1, FOLDS), 10**12)
    assert leading_rivals(wide, [0], rows) == [[1, 2, 3, 4, 5, 6, 7]]


def test_torques_larger_than_one_are_refused():
    """They would overflow 64 bits."""
    rows = np.full((1, FOLDS), 10**12 + 1)
    with pytest.raises(ArithmeticError, match="larger than 1"):
        leading_rivals(DIRECTIONS, [0], rows)


def test_independent_branches_are_the_same_for_few_and_none_contain_the_branch():
    for branches in (BRANCHES, BRANCHES[:5], BRANCHES[:2]):
        directions = Directions.of(branches)
        found = list(alone_each(directions, branches, 4))
        for place, one in enumerate(found):
            assert place not in one.independent
            assert one.dimension == alone(directions, branches, place, 4).dimension
    assert [one.dimension for one in alone_each(DIRECTIONS, BRANCHES, 4)] == [(0, 0)] * 8


def test_programs_are_solved_in_parts_as_well(monkeypatch):
    from exactfold.design.actuation import interior

    units = DIRECTIONS.middles
    whole = list(largest_margins(units, np.arange(8)))
    monkeypatch.setattr(interior, "_ENTRIES", 24)
    for one, other in zip(whole, largest_margins(units, np.arange(8)), strict=True):
        assert one.torques == pytest.approx(other.torques, abs=1e-6)
        assert one.rays == other.rays


# --- what is refused -----------------------------------------------------------------------------


def test_sheets_without_a_list_of_rivals_are_refused(monkeypatch):
    with pytest.raises(NotCountedError, match=r"13 vertices can pop: .* 12"):
        actuate_all(random_square(13, seed=1))
    with pytest.raises(NotCountedError, match="boundary"):
        actuate_all("waterbomb")
    from exactfold.design.actuation import actuate as drive

    unproved = replace(count_branches(two_vertex()), status=UNDECIDED, reason="for a test")
    monkeypatch.setattr(drive, "count_branches", lambda pattern, **_: unproved)
    with pytest.raises(UndecidedBranchError, match="for a test"):
        actuate_all(two_vertex())


def test_progress_and_the_same_value_twice():
    stages = []
    one = actuate_all(two_vertex(), progress=lambda stage, *_: stages.append(stage))
    assert "torques" in stages
    assert one == actuate_all(two_vertex())
