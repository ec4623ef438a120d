"""Kawasaki's condition at a vertex, which folding flat needs, and the fold to turn for it."""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees, pi
from typing import Final

from flint import arb

from exactfold.exact.surds import Number, ball
from exactfold.panels.vertex.stars import Star, bracket, dot
from exactfold.panels.vertex.vertex_motions import Fan
from exactfold.pattern.panel_pattern import Edge, PanelPattern, Point

BITS: Final = 64


@dataclass(frozen=True)
class Turn:
    """A fold that, turned about the vertex, makes the vertex satisfy Kawasaki's condition.

    `angle` is in degrees, positive if the fold turns counter-clockwise.
    """

    fold: Edge
    angle: float


def kawasaki(star: Star) -> tuple[bool, float | None]:
    """Whether every second sector adds up to pi exactly, and by how many degrees the sum is off.

    The folds of the star are the folded creases at a vertex; None stands for an odd number of them.
    The alternating sum of all sectors is the argument of a product of numbers d' / d, or of their
    inverses, where d and d' are neighbouring directions as complex numbers. It lies between -2 pi
    and 2 pi, so that it is 0 if and only if the product is positive.

    >>> kawasaki(Star(0, ((0, 1), (0, 2), (0, 3), (0, 4)), ((1, 0), (0, 1), (-1, 0), (0, -1))))
    (True, 0.0)
    """
    d, count = star.directions, len(star.directions)
    if count == 0:
        return True, 0.0
    if count % 2:
        return False, None
    re: Number = 1
    im: Number = 0
    near = 0.0
    for k in range(count):
        a, b = d[k], d[(k + 1) % count]
        along, across = dot(a, b), bracket(a, b)
        near += (angle_between(a, b)) * (-1) ** k
        if k % 2:
            across = -across
        re, im = re * along - im * across, re * across + im * along
    if im == 0 and re > 0:
        return True, 0.0
    angle = angle_of(im, re)
    angle += 2 * pi * round((near - angle) / (2 * pi))
    return False, degrees(angle) / 2


def turn_for(sheet: PanelPattern, star: Star, off: float) -> Turn | None:
    """The fold to turn by the smallest angle: one that ends in the border and is not straight.

    A fold between an odd and an even sector takes from one what it gives to the other. Returns None
    if the fold would have to pass another one.
    """
    best: tuple[tuple[bool, bool], Turn] | None = None
    count = len(star.folds)
    straight = Fan(star).opposite
    for k, fold in enumerate(star.folds):
        angle = off if k % 2 == 0 else -off
        towards = (k + 1) % count if angle > 0 else k - 1
        room = degrees(angle_between(star.directions[k], star.directions[towards]))
        room = room if angle > 0 else 360 - room
        if room <= abs(angle):
            continue
        end = sum(fold) - star.vertex
        rank = end not in sheet.boundary_set, straight[k] is not None
        if best is None or rank < best[0]:
            best = rank, Turn(fold, angle)
    return None if best is None else best[1]


def angle_between(a: Point, b: Point) -> float:
    """The angle from one direction to another, counter-clockwise, between 0 and 2 pi."""
    return angle_of(bracket(a, b), dot(a, b)) % (2 * pi)


def angle_of(across: Number, along: Number) -> float:
    """The angle with these exact multiples of its sine and cosine, to the precision of floats."""
    bits = BITS
    while True:
        y, x = ball(across, bits), ball(along, bits)
        clear = [value.rel_accuracy_bits() > BITS // 2 for value in (y, x)]
        if (clear[0] or across == 0) and (clear[1] or along == 0):
            return float(arb.atan2(y, x))
        bits *= 2
