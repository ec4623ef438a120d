"""Exact sheets with noise put back, and the angles that their edges are meant to have."""

from __future__ import annotations

import random
from fractions import Fraction
from math import atan2, pi

from exactfold.pattern.drawing.meant.values import Angles, Edge
from exactfold.pattern.panel_pattern import PanelPattern


def with_noise(sheet: PanelPattern, noise: float, seed: int = 0) -> PanelPattern:
    """The sheet with decimals that are off by up to `noise` times its larger side."""
    rng = random.Random(seed)
    points = [(float(x), float(y)) for x, y in sheet.vertices]
    size = max(max(axis) - min(axis) for axis in zip(*points, strict=True))

    def moved(value: float) -> Fraction:
        return Fraction(str(value + rng.uniform(-noise, noise) * size))

    return PanelPattern([(moved(x), moved(y)) for x, y in points], sheet.edges)


def angle_of(sheet: PanelPattern, edge: Edge) -> float:
    """The angle of an edge in radians, modulo pi."""
    (ax, ay), (bx, by) = ([float(c) for c in sheet.vertices[v]] for v in edge)
    return atan2(by - ay, bx - ax) % pi


def angles_of(sheet: PanelPattern, unit: int) -> Angles:
    """Multiples of pi / unit as constants, and one free angle for each other direction."""
    constants: dict[Edge, Fraction] = {}
    coefficients: dict[Edge, tuple[tuple[int, Fraction], ...]] = {}
    free: list[float] = []
    for edge in sheet.edges:
        angle = angle_of(sheet, edge)
        steps = round(angle / pi * unit)
        constants[edge] = Fraction(0)
        if abs(angle - steps * pi / unit) < 1e-9:
            constants[edge] = Fraction(steps, unit)
            continue
        known = [k for k, other in enumerate(free) if abs(other - angle) < 1e-9]
        if not known:
            known = [len(free)]
            free.append(angle)
        coefficients[edge] = ((known[0], Fraction(1)),)
    return Angles(constants, coefficients, tuple(free))
