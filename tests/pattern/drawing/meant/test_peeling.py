"""The order in which vertices and free angles follow from those before them."""

from __future__ import annotations

from math import cos, sin

import numpy as np

from exactfold.pattern.drawing.meant.peeling import AngleStep, Lines, VertexStep, peeled
from exactfold.pattern.drawing.meant.values import Edge


def lines(angles: dict[Edge, float], powers: dict[Edge, dict[int, int]] | None = None) -> Lines:
    keys = {edge: round(angle, 6) for edge, angle in angles.items()}
    units = {edge: (cos(angle), sin(angle)) for edge, angle in angles.items()}
    return Lines(keys, units, {edge: (powers or {}).get(edge, {}) for edge in angles})


def drawn(places: list[tuple[float, float]], edges: list[Edge]) -> tuple[np.ndarray, Lines]:
    points = np.array(places)
    angles = {}
    for i, j in edges:
        x, y = points[j] - points[i]
        angles[i, j] = float(np.arctan2(y, x) % np.pi)
    return points, lines(angles)


def test_a_chain_on_one_line_is_one_condition_fewer_for_each_vertex() -> None:
    """The ends of a line keep a condition when the vertices between them are taken out."""
    points, given = drawn([(0, 0), (1, 1), (2, 2), (5, 1)], [(0, 1), (1, 2), (0, 3), (2, 3)])
    order = peeled(points, given, [(0, 1), (1, 2), (0, 3), (2, 3)])
    assert (order.core, order.vertices) == ((), frozenset())
    placed: set[int] = set()
    for step in order.steps:
        assert isinstance(step, VertexStep)
        for line in step.lines:
            assert {line.i, line.j} - {step.vertex} <= placed
        placed.add(step.vertex)
    assert sorted(len(step.lines) for step in order.steps if isinstance(step, VertexStep)) == [
        0,
        1,
        1,
        2,
    ]


def test_a_condition_that_follows_from_others_is_left_out() -> None:
    """All six lines of four points: five of them determine the sixth."""
    edges = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]
    points, given = drawn([(0, 0), (4, 1), (5, 6), (-1, 3)], edges)
    order = peeled(points, given, edges)
    assert order.core == ()
    used = [len(step.lines) for step in order.steps if isinstance(step, VertexStep)]
    assert sorted(used) == [0, 1, 2, 2]


def test_independent_conditions_stay() -> None:
    """Six lines with directions of their own: no four different points have them."""
    edges = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]
    angles = dict(zip(edges, (0.1, 0.5, 1.1, 1.6, 2.2, 2.9), strict=True))
    order = peeled(np.array([(0, 0), (4, 1), (5, 6), (-1, 3.0)]), lines(angles), edges)
    assert len(order.core) == 6
    assert order.vertices == {0, 1, 2, 3}
    assert order.steps == ()


def test_a_free_angle_follows_from_one_condition() -> None:
    """All six lines of four points again; the sixth has a free angle, in the power 1 or 2."""
    edges = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]
    points, given = drawn([(0, 0), (4, 1), (5, 6), (-1, 3)], edges)
    for power, found in ((1, True), (-1, True), (2, False)):
        free = Lines(given.keys, given.units, {**given.powers, (2, 3): {0: power}})
        order = peeled(points, free, edges)
        steps = [step for step in order.steps if isinstance(step, AngleStep)]
        assert ([step.angle for step in steps] == [0]) is found
        assert (order.core == ()) is found
