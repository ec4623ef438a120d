"""Proved powers and margins: true bounds of any torques, and no margin where there is none."""

from dataclasses import replace
from fractions import Fraction

import driving
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from exactfold import random_square
from exactfold.branches import count_branches, find_branch
from exactfold.design import Directions, actuate
from exactfold.design.actuation.directions import BITS
from exactfold.design.actuation.orthogonal import independent_rows
from exactfold.design.actuation.powers import Powers, exact_weights, margin_bound, rivals
from exactfold.pattern.families import flat_vertex_square, two_vertex

few = settings(max_examples=25, deadline=None)
BRANCHES = count_branches(random_square(3, seed=5)).branches
DIRECTIONS = Directions.of(BRANCHES)
FOLDS = len(DIRECTIONS.folds)
torques = st.lists(
    st.fractions(-1, 1, max_denominator=1000), min_size=FOLDS, max_size=FOLDS
).filter(any)


def test_directions_are_unit_vectors_of_the_fold_angles():
    assert driving.directions(list(BRANCHES)) == pytest.approx(DIRECTIONS.middles, abs=1e-6)
    assert np.linalg.norm(DIRECTIONS.middles, axis=1) == pytest.approx(1, abs=1e-8)
    assert all(
        low < high
        for pair in zip(DIRECTIONS.low, DIRECTIONS.high, strict=True)
        for low, high in zip(*pair, strict=True)
    )


@pytest.mark.parametrize("pattern", [two_vertex(), random_square(4, seed=1)])
def test_bounds_of_a_count_hold_the_sharper_ones_of_single_branches(pattern):
    count = count_branches(pattern)
    wide = Directions.of(count.branches)
    for b, branch in enumerate(count.branches):
        sharp = Directions.of([find_branch(pattern, branch.vertex_signs)])
        sharper = Directions.of([branch.sharpened(128)])
        for other in (sharp, sharper):
            assert wide.meeting(other) == [(b, 1)]
            assert np.all(other.lows[0] <= sharper.lows[0])
            assert np.all(other.highs[0] >= sharper.highs[0])
        assert np.all(wide.lows[b] <= sharper.lows[0])
        assert np.all(wide.highs[b] >= sharper.highs[0])
        both = wide.alone(b, -1).alone(0, -1).narrowed(sharp)
        assert both.meeting(sharper) == [(0, 1)]
        assert all(np.all(both.lows[0] >= other.lows[0]) for other in (sharp, wide.alone(b, 1)))
        assert max((sharper.highs[0] - sharper.lows[0]).tolist()) < 2 ** (BITS - 80)


def test_flat_folds_have_exactly_no_component():
    count = count_branches(flat_vertex_square())
    directions = Directions.of(count.branches)
    for b, branch in enumerate(count.branches):
        for e, fold in enumerate(directions.folds):
            none = directions.low[b][e] == directions.high[b][e] == 0
            assert none == (branch.assignment[fold] == "F")


@few
@given(torques)
def test_powers_of_any_torques_lie_within_their_bounds(tau):
    powers = Powers.of(DIRECTIONS, tau)
    sharp = Powers.of(Directions.of([branch.sharpened(128) for branch in BRANCHES]), tau)
    values = DIRECTIONS.middles @ [float(t) for t in tau]
    for b, value in enumerate(values):
        low, high = powers.bounds(b)
        below, above = sharp.bounds(b)
        assert low <= below <= above <= high
        assert float(below) == pytest.approx(value, abs=1e-7)
    chosen = int(np.argmax(values))
    rest = [abs(v) for b, v in enumerate(values) if b != chosen] + [-values[chosen]]
    low, high = powers.margin(chosen)
    assert low - Fraction(1, 10**7) <= Fraction(values[chosen] - max(rest))
    assert Fraction(values[chosen] - max(rest)) <= high + Fraction(1, 10**7)


@few
@given(torques, st.lists(st.integers(0, 50), min_size=15, max_size=15).filter(any))
def test_no_torques_exceed_a_bound_from_any_weights(tau, whole):
    """Weak duality with weights that no program has chosen, for all folds and for few."""
    rays = rivals(DIRECTIONS, 2)
    weights = [(ray, Fraction(w, sum(whole))) for ray, w in zip(rays, whole, strict=True)]
    margin = Powers.of(DIRECTIONS, tau).margin(2)
    assert margin[0] <= margin_bound(DIRECTIONS, 2, weights)
    few = [t if e < 4 else Fraction(0) for e, t in enumerate(tau)]
    if any(few):
        margin = Powers.of(DIRECTIONS, few).margin(2)
        assert margin[0] <= margin_bound(DIRECTIONS, 2, weights, [True] * FOLDS, 4)
        barred = [e >= 4 for e in range(FOLDS)]
        assert margin[0] <= margin_bound(DIRECTIONS, 2, weights, barred=barred)


def test_weights_that_are_no_weights_are_refused():
    rays = rivals(DIRECTIONS, 0)
    for wrong in ([Fraction(1, 2)], [Fraction(3, 2), Fraction(-1, 2)], []):
        with pytest.raises(ArithmeticError, match="add up"):
            margin_bound(DIRECTIONS, 0, list(zip(rays, wrong, strict=False)))
    last = len(DIRECTIONS.lows) - 1
    for chosen, ray in ((0, (0, 1)), (last, (-1, 1)), (0, (1, 2)), (0, (last + 1, 1))):
        with pytest.raises(ArithmeticError, match="itself"):  # the first two: best would be 0
            margin_bound(DIRECTIONS, chosen, [(ray, Fraction(1))])
    exact = exact_weights(rays, np.full(len(rays), 0.1))
    assert sum(weight for _, weight in exact) == 1


def forged(found, torques):
    """The margin of other torques for the same branch."""
    tau = [Fraction(torques[fold]) for fold in found.directions.folds]
    return Powers.of(found.directions, tau).margin(found.place)


def test_torques_rounded_too_far_have_no_proved_margin():
    """Of 0, 1 and -1 alone: these do not prefer the branch, and nothing says that they do."""
    found = actuate(random_square(6, seed=5), "--+-+-")
    assert found.margin[0] > 0
    rounded = {fold: Fraction(round(torque)) for fold, torque in found.torques.items()}
    assert forged(found, rounded)[1] < 0


def test_torques_between_two_branches_have_no_proved_margin():
    """On the boundary, where two branches have one power, the bounds hold 0."""
    found = actuate(two_vertex(), "+-")
    units, place = found.directions.middles, found.place
    rival = units[(place + 1) % 4] * np.sign(units[(place + 1) % 4] @ units[place])
    middle = (units[place] + rival).tolist()
    tied = {f: Fraction(x) for f, x in zip(found.directions.folds, middle, strict=True)}
    low, high = forged(found, tied)
    assert low < 0 < high
    assert high - low < Fraction(1, 10**6)


def test_wide_bounds_prove_no_margin():
    """If branches are not known well enough, torques that are right are not proved to be."""
    found = actuate(two_vertex(), "+-")
    spread = 1 << BITS - 2
    wide = replace(
        found.directions,
        low=tuple(tuple(x - spread for x in row) for row in found.directions.low),
        high=tuple(tuple(x + spread for x in row) for row in found.directions.high),
    )
    tau = list(found.torques.values())
    low, high = Powers.of(wide, tau).margin(found.place)
    assert low < 0 < found.margin[0] <= found.margin[1] <= high
    assert independent_rows(found.directions, range(4)) is not None
    assert independent_rows(wide, range(3)) is None


def test_dependent_branches_are_not_called_independent():
    twice = replace(
        DIRECTIONS,
        low=(*DIRECTIONS.low, DIRECTIONS.low[0]),
        high=(*DIRECTIONS.high, DIRECTIONS.high[0]),
    )
    rows, columns = independent_rows(twice, range(len(twice)))
    assert len(rows) == len(columns) == 4  # first-order motions of three vertices
    rows, _ = independent_rows(twice, [0, len(twice) - 1])
    assert len(rows) == 1
    assert independent_rows(twice, []) == ([], [])


def test_a_single_branch_has_one_rival_its_other_side():
    alone = DIRECTIONS.alone(1, 1)
    tau = [Fraction(int(np.sign(x))) for x in DIRECTIONS.middles[1]]
    powers = Powers.of(alone, tau)
    assert rivals(alone, 0) == [(0, -1)]
    assert powers.largest_rival(0) == tuple(-x for x in powers.bounds(0)[::-1])
    low, high = powers.margin(0)
    best = margin_bound(alone, 0, [((0, -1), Fraction(1))])
    assert low <= 2 * sum(map(abs, map(Fraction, DIRECTIONS.middles[1]))) <= high
    assert low < best <= high
    assert independent_rows(alone, []) == ([], [])
