"""Tubes of periodic sheets: the equations in balls, and what a proof refuses."""

from __future__ import annotations

import numpy as np
import pytest
from flint import arb, ctx

from exactfold import Verdict
from exactfold.branches import count_periodic
from exactfold.motion import roll
from exactfold.motion.periodic import tubes
from exactfold.motion.periodic.rolling import _wrapping
from exactfold.motion.periodic.tubes import Balls, prove_curve
from exactfold.motion.periodic.wrapping import Wrapping, shortening
from exactfold.pattern import random_cell


def started(way: int = 2) -> tuple[Wrapping, list[np.ndarray]]:
    """A branch, and three places of its curve."""
    wrapping = _wrapping(count_periodic("waterbomb-cell", (1, 2)), way)
    z = wrapping.start()
    assert z is not None
    places = [np.append(z, 0.0)]
    ahead = np.append(np.zeros(len(z)), 1.0)
    for _ in range(2):
        ahead = wrapping.tangent(places[-1], ahead)
        new = wrapping.corrected(places[-1] + 0.05 * ahead, ahead)
        assert new is not None
        places.append(new)
    return wrapping, places


@pytest.mark.parametrize("cell", ["waterbomb-cell", random_cell(1, 3), random_cell(2, 1)])
def test_values_and_derivatives_in_balls_are_those_in_floats(cell: object) -> None:
    wrapping = _wrapping(count_periodic(cell, (2, 1)), 1)
    z = wrapping.start()
    assert z is not None
    x = np.append(z + np.linspace(-0.1, 0.2, len(z)), 0.4)
    values, rows = Balls(wrapping).both([arb(c) for c in x.tolist()])
    assert [float(v) for v in values] == pytest.approx(wrapping.values(x[:-1], 0.16), abs=1e-12)
    found = np.array([[float(c) for c in row] for row in rows])
    assert np.abs(found - wrapping._derivatives(x)).max() < 1e-12


def test_the_series_is_enclosed() -> None:
    for x in (0.0, 0.3, -2.0, 9.0, 15.9):
        value, slope = tubes._shortening(arb(x))
        step = 1e-5
        ahead, behind = (tubes._shortening(arb(x + s))[0] for s in (step, -step))
        assert float(slope) == pytest.approx(float(ahead - behind) / (2 * step), abs=1e-8)
        if x > 0:
            assert value.contains(arb(float(shortening(np.array(x))))) or float(
                value
            ) == pytest.approx(float(shortening(np.array(x))), rel=1e-12)
    with pytest.raises(OverflowError):
        tubes._shortening(arb(17))


def test_a_motion_is_proved_without_a_gap() -> None:
    motion = roll(
        "waterbomb-cell", (1, 2), way=2, cells=(1, 2), until="30deg", frames=4, proving=True
    )
    assert motion.status is Verdict.PROVED
    assert "without a gap" in motion.reason
    assert 0 < motion.radius < 1e-12
    assert motion.tubes is not None
    before = ctx.prec
    prove_curve(*started())
    assert ctx.prec == before


def test_places_off_the_curve_are_told_by_their_radius() -> None:
    wrapping, places = started()
    proof = prove_curve(wrapping, places)
    assert proof is not None
    assert max(proof.radii) < 1e-12
    off = [places[0], places[1], places[2] + 1e-3]
    moved = prove_curve(wrapping, off)
    assert moved is None or moved.radii[2] > 1e-4


def test_a_proof_begins_at_the_flat_sheet_with_the_branch_that_was_named() -> None:
    wrapping, places = started()
    assert prove_curve(wrapping, places[1:]) is None  # t is not 0
    other, _ = started(1)
    assert prove_curve(Wrapping(wrapping.problem, other.ray), places) is None
    bent = [places[0] + np.append(np.full(len(places[0]) - 1, 1e-3), 0.0), *places[1:]]
    assert prove_curve(wrapping, bent) is None


def test_a_tube_begins_where_the_last_one_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    wrapping, places = started()
    sharp = tubes._Proof._sharp

    def elsewhere(self: object, chart: object, s: float, near: np.ndarray) -> list[arb] | None:
        found = sharp(self, chart, s, near)  # type: ignore[arg-type]
        return None if found is None else [x + arb("1e-4") * bool(s) for x in found]

    monkeypatch.setattr(tubes._Proof, "_sharp", elsewhere)
    assert prove_curve(wrapping, places) is None


def test_boxes_that_are_too_small_or_too_long_are_refused() -> None:
    wrapping, places = started()
    chart = tubes._Chart.at(Balls(wrapping), places[0], None)
    middle = np.zeros(wrapping.size)
    assert chart.zero(arb(0), middle, np.full(wrapping.size, 1e-9)) is not None
    assert chart.zero(arb(0), middle + 1e-6, np.full(wrapping.size, 1e-9)) is None
    long = arb(0).union(arb(1.5))
    assert chart.zero(long, middle, np.full(wrapping.size, 1e-3)) is None
