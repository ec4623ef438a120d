"""Exact sheets with noise put back, and the angles that their edges are meant to have."""

from __future__ import annotations

import random
from fractions import Fraction
from math import atan2, pi

from exactfold.pattern.drawing.meant.values import Angles, Edge, Relation
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


def relations_of(sheet: PanelPattern, unit: int) -> list[Relation]:
    """The relations of each kind that an exact sheet has, found in floats."""
    angle = {edge: angle_of(sheet, edge) for edge in sheet.edges}

    def holds(*terms: tuple[Edge, int], parts: int = 1) -> bool:
        total = sum(n * angle[edge] for edge, n in terms) * parts / pi
        return abs(total - round(total)) < 1e-9

    made = []
    border = set(sheet.boundary_edges)
    for v in sorted(sheet.boundary_set):
        first, second = [edge for edge in sheet.boundary_edges if v in edge]
        if holds((first, 1), (second, -1)):
            made.append(Relation("border", f"border@{v}", ((first, 1), (second, -1)), 1, 0.0))
    for v, near in sheet.stars.items():
        spokes = [(min(u, v), max(u, v)) for u in near]
        for k, one in enumerate(spokes):
            for m in range(k + 1, len(spokes)):
                if holds((one, 1), (spokes[m], -1)):
                    a, b = sorted((near[k], near[m]))
                    name = f"straight@{v}:{a}-{b}"
                    made.append(Relation("straight", name, ((one, 1), (spokes[m], -1)), 1, 0.0))
        turns = [(edge, (-1) ** k) for k, edge in enumerate(spokes)]
        if len(near) % 2 == 0 and holds(*turns):
            made.append(Relation("kawasaki", f"kawasaki@{v}", tuple(turns), 1, 0.0))
        corners = list(zip(near, [*near[1:], *near[:1]], strict=True))
        for k, (a, b) in enumerate(corners):
            for c, d in corners[k + 1 :]:
                if abs(_sector(sheet, v, a, b) - _sector(sheet, v, c, d)) < 1e-9:
                    total: dict[Edge, int] = {}
                    for u, n in ((a, -1), (b, 1), (c, 1), (d, -1)):
                        edge = (min(u, v), max(u, v))
                        total[edge] = total.get(edge, 0) + n
                    terms = tuple((edge, n) for edge, n in total.items() if n)
                    name = f"sectors@{v}:{a}-{b},{c}-{d}"
                    made.append(Relation("sectors", name, terms, 1, 0.0))
    folds = [edge for edge in sheet.edges if edge not in border]
    for k, (i, j) in enumerate(folds):
        if holds(((i, j), 1), parts=unit):
            made.append(Relation("grid", f"grid:{i}-{j}", (((i, j), 1),), unit, 0.0))
        for m, n in folds[k + 1 :]:
            pair = f"{i}-{j},{m}-{n}"
            if holds(((i, j), 1), ((m, n), -1)):
                terms = (((i, j), 1), ((m, n), -1))
                made.append(Relation("parallel", f"parallel:{pair}", terms, 1, 0.0))
            if holds(((i, j), 1), ((m, n), 1)):
                terms = (((i, j), 1), ((m, n), 1))
                made.append(Relation("mirrored", f"mirrored:{pair}", terms, 1, 0.0))
    return made


def _sector(sheet: PanelPattern, v: int, a: int, b: int) -> float:
    (x, y), (ax, ay), (bx, by) = ([float(c) for c in sheet.vertices[u]] for u in (v, a, b))
    return (atan2(by - y, bx - x) - atan2(ay - y, ax - x)) % (2 * pi)
