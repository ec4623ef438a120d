"""Chains of rotations in floats, against the same in 60 digits."""

import numpy as np
import pytest
from flint import arb, arb_mat, ctx
from panel_sheets import chicken_wire, mesh, miura

from exactfold.checker.motion.panels.places import _middle
from exactfold.checker.sheets.panels import read_panels
from exactfold.motion.panels.chain import Turned, hinged, moved, product, size, spun, still
from exactfold.motion.panels.places import Placing
from exactfold.pattern.panel_entries import panels_document

ORDER = 6


def random_rotations(count):
    """Axes, and sines and versines of linear angles as truncated series, with what they leave."""
    rng = np.random.default_rng(4)
    for _ in range(count):
        axis = rng.normal(size=2)
        axis /= np.linalg.norm(axis)
        start, slope = rng.uniform(-2, 2), rng.uniform(-0.1, 0.1)
        powers = slope ** np.arange(ORDER + 1) / np.cumprod([1, *range(1, ORDER + 1)])
        phases = start + np.pi / 2 * np.arange(ORDER + 1)
        sine, versine = np.sin(phases) * powers, -np.cos(phases) * powers
        versine[0] += 1
        rest = abs(slope) ** (ORDER + 1) + 1e-15
        yield axis, (start, slope), Turned(sine[None], rest), Turned(versine[None], rest)


def exact_rotation(axis, angle):
    x, y = (arb(float(c)) for c in axis)
    length = (x * x + y * y).sqrt()
    x, y = x / length, y / length
    s, v = angle.sin(), 1 - angle.cos()
    rows = [[1 - v * y * y, v * x * y, s * y], [v * x * y, 1 - v * x * x, -s * x]]
    return arb_mat([*rows, [-s * y, s * x, 1 - v]])


def at(polynomial, y):
    return [sum((arb(float(c)) * y**k for k, c in enumerate(row)), arb(0)) for row in polynomial]


@pytest.mark.parametrize("y", [-1.0, 0.3, 1.0])
def test_errors_hold_what_products_and_places_are_off(y):
    with ctx.workprec(200):
        (rotation, shift), point = still(ORDER), np.array([0.3, -0.4])
        exact, away = arb_mat([[int(i == j) for j in range(3)] for i in range(3)]), [arb(0)] * 3
        there = arb_mat([[arb(float(c))] for c in (*point, 0.0)])
        for axis, (start, slope), sine, versine in random_rotations(12):
            new = product(rotation, spun(sine, versine, axis, 1e-15))
            shift = hinged(rotation, new, point, 0.0, shift)
            before = exact
            exact = exact * exact_rotation(axis, arb(start) + arb(slope) * arb(y))
            step = before * there - exact * there
            away = [a + step[k, 0] for k, a in enumerate(away)]
            rotation = new
            for i in range(3):
                for j, value in enumerate(at(rotation.polynomial[i], arb(y))):
                    assert abs(value - exact[i, j]) <= rotation.error
            place = moved(rotation, point, 0.0, shift)
            spot = [(exact * there)[k, 0] + a for k, a in enumerate(away)]
            for value, known in zip(at(place.polynomial, arb(y)), spot, strict=True):
                assert abs(value - known) <= place.error
    assert rotation.error < 1e-5


def test_what_is_dropped_is_an_error():
    """(1 + y)^2 I up to the order 1: y^2 I is left out, of norm sqrt(3) here."""
    line = np.zeros((3, 3, 2))
    line[..., 0] = line[..., 1] = np.eye(3)
    found = product(Turned(line, 0.0), Turned(line, 0.0))
    assert np.array_equal(found.polynomial[0, 0], [1.0, 2.0])
    assert found.error == pytest.approx(3**0.5)
    assert size(line) == pytest.approx(2 * 3**0.5)


@pytest.mark.parametrize("sheet", [miura(4, 4), mesh(1, 7, 1), chicken_wire(3, 3)])
def test_the_panel_in_the_middle_is_near_all_others(sheet):
    """For the checker, too: no other panel has all within fewer folds, but by two."""
    far = [Placing(sheet, panel).depths.max() for panel in range(len(sheet.faces))]
    middle = Placing(sheet, 0).middle
    assert far[middle] <= min(far) + 2
    checked, _ = read_panels(panels_document(sheet))
    assert set(checked.panels[_middle(checked)]) == set(sheet.faces[middle])
