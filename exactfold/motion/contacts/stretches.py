"""Parts of pieces as polynomials in floats with error bounds, from which fold angles are
computed.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.motion.contacts.fold_ranges import Stretch
from exactfold.motion.curves.framework import Framework
from exactfold.motion.tubes.branch_point_tube import BranchPointTube
from exactfold.motion.tubes.piece import PARAMETER_BITS
from exactfold.motion.tubes.tube import Tube
from exactfold.motion.tubes.tube_start import ROOT_BITS, StartTube

_RELATIVE, _LEAST = 1e-9, 1e-15
"""Radii are enlarged by this share and this length, which covers all rounding errors."""


def on_start_tube(start: StartTube, begin: int, end: int) -> Stretch:
    """The stretch from one tau to another on a start tube; negative tau is on the mirror image."""
    one, m = float(1 << start.bits), start.halvings
    vertical = np.arange(start.framework.size) % 3 == 2
    rows = [np.zeros(start.framework.size)]
    for row in start.coefficients:
        values = np.array([x / one for x in row])
        rows += [
            np.where(vertical, values * 2.0**-m, 0.0),
            np.where(vertical, 0.0, values * 4.0**-m),
        ]
    most = max(abs(begin), abs(end))
    radii = [r / one for r in start.ball(most).radii]
    return _stretch(start.framework, rows, radii, begin, end, ROOT_BITS)


def on_tube(tube: Tube, begin: int, end: int) -> Stretch:
    """The stretch of a tube from one parameter to another."""
    one = float(1 << tube.bits)
    radius = tube.radius_within(max(abs(begin), abs(end)))
    radii = [r / one for r in tube.lengths(radius)]
    return _stretch(tube.framework, tube.in_floats, radii, begin, end, PARAMETER_BITS)


def on_branch_point_tube(tube: BranchPointTube, begin: int, end: int) -> Stretch:
    """The stretch of an arc through a branch point from one parameter to another."""
    one, branch_point = float(1 << tube.bits), tube.branch_point.finer(tube.bits)
    rows = [np.array([x / one for x in row]) for row in (branch_point.centre, *tube.coefficients)]
    radii = [r / one for r in tube.ball(max(abs(begin), abs(end))).radii]
    return _stretch(tube.framework, rows, radii, begin, end, PARAMETER_BITS)


def _stretch(
    framework: Framework,
    rows: Sequence[FloatArray] | FloatArray,
    radii: Sequence[float],
    begin: int,
    end: int,
    bits: int,
) -> Stretch:
    coefficients = framework.displacement(np.array(rows))
    coefficients[0, :, :2] += framework.flat
    radius = framework.displacement(np.array(radii) * (1 + _RELATIVE) + _LEAST)
    return Stretch(coefficients, radius, begin / (1 << bits), end / (1 << bits))
