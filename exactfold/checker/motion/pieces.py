"""Reading the pieces of a motion from a file: start tubes, tubes, arcs through branch points."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any

from ..core.limits import MOTION_BITS
from ..core.reading import integer, items, keys, natural, require
from .branch_points import BranchPointTube
from .equations import SPARE, LengthEquations
from .patches import Patch
from .tubes import Start, Tube

REACH_BITS = 6
PARAMETER_BITS = 40
ROOT_BITS = 20


MakeTube = Callable[[LengthEquations, list[int], list[int], Fraction], Tube]
"""Proves that a tube with this centre, row and reach holds a curve."""


def tube_of(equations: LengthEquations, entry: Any, make: MakeTube = Tube) -> Tube:
    """Read a tube, and prove that it holds a curve."""
    size = equations.size
    return make(
        equations,
        vector(entry["centre"], "centre", size, equations.bits),
        vector(entry["row"], "row", size, 0),
        reach_of(entry["reach"]),
    )


def arc_of(equations: LengthEquations, flat: Any, entry: Any) -> BranchPointTube:
    """Read an arc through a branch point with these flat vertices, and prove that it exists."""
    size, bits = equations.size, equations.bits
    require(not equations.mixed, "a motion with driven folds cannot have a branch point")
    patch = Patch(equations, [natural(v, "flat vertex") for v in items(flat, "flat")])
    return BranchPointTube(
        patch,
        patch.branch_point(vector(entry["node"], "node", size, bits)),
        vector(entry["centre"], "centre", size, bits),
        vector(entry["row"], "row", size, 0),
        reach_of(entry["reach"]),
    )


def vector(value: Any, what: str, size: int, bits: int) -> list[int]:
    """Read a vector of integers over 2^bits; raises if one is too large."""
    numbers = [integer(x) for x in items(value, what, size)]
    small = all(abs(x) >> bits + SPARE == 0 for x in numbers)
    require(small, f"a number of the {what} is out of range")
    return numbers


def reach_of(value: Any) -> Fraction:
    """Read the reach of a piece: it holds the curve for parameters |s| <= reach."""
    reach = Fraction(natural(value, "reach"), 1 << REACH_BITS)
    require(0 < reach <= 16, "the reach is out of range")
    return reach


def first_piece(equations: LengthEquations, entry: Any) -> tuple[Start, Fraction]:
    """Read the first piece of a motion, and the parameter at which the motion leaves it."""
    keys(entry, "centre halvings held reach exit", "start")
    start = start_of(equations, entry)
    tau = Fraction(natural(entry["exit"], "exit"), 1 << ROOT_BITS)
    require(tau > 0, "the motion does not leave the flat state")
    return start, tau


def start_of(equations: LengthEquations, entry: Any) -> Start:
    """Read a start tube, and prove that it holds a curve."""
    centre = vector(entry["centre"], "centre", equations.size, equations.bits)
    halvings = natural(entry["halvings"], "halvings")
    require(halvings <= MOTION_BITS, "halvings are out of range")
    held = natural(entry["held"], "held vertex")
    require(held in equations.place, "the vertex held at its height is not one that can move")
    place = equations.place[held] + 2
    return Start(equations, centre, halvings, place, reach_of(entry["reach"]))


def parameter_of(value: Any) -> Fraction:
    """Read a parameter within a piece."""
    return Fraction(integer(value), 1 << PARAMETER_BITS)
