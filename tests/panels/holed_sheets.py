"""Sheets with holes whose motions are known."""

from exactfold.pattern.panel_pattern import PanelPattern

RING = PanelPattern(
    [(0, 0), (40, 0), (0, 40), (19, 13), (18, 19), (8, 18), (15, 3)],
    [
        (0, 1),
        (1, 2),
        (0, 2),
        (3, 4),
        (4, 5),
        (5, 6),
        (3, 6),
        (0, 5),
        (0, 6),
        (1, 6),
        (1, 3),
        (1, 4),
        (2, 4),
        (2, 5),
    ],
    holes=[(3, 4, 5, 6)],
)
"""An outer triangle with a quadrilateral hole: 8 complex branches, none of them real."""

BESIDE = PanelPattern(
    [(0, 0), (12, 0), (13, 9), (1, 8), (4, 3), (6, 2), (5, 5), (9, 4), (8, 6)],
    [
        (0, 1),
        (1, 2),
        (2, 3),
        (0, 3),
        (4, 5),
        (5, 6),
        (4, 6),
        (0, 4),
        (0, 5),
        (1, 5),
        (1, 7),
        (5, 7),
        (6, 7),
        (6, 8),
        (7, 8),
        (2, 7),
        (2, 8),
        (3, 8),
        (3, 6),
        (3, 4),
    ],
    holes=[(4, 5, 6)],
)
"""A triangular hole beside two interior vertices; all panels are triangles."""


def spokes(inner, outer=((0, 0), (6, 0), (6, 6), (0, 6))):
    """A hole with four corners, which are joined to those of a quadrilateral."""
    rims_of = [[(k + a, (k + 1) % 4 + a) for k in range(4)] for a in (0, 4)]
    edges = [*rims_of[0], *rims_of[1], *((k, k + 4) for k in range(4))]
    return PanelPattern([*outer, *inner], edges, holes=[(4, 5, 6, 7)])


FLAP = PanelPattern(
    [(0, 0), (8, 0), (8, 8), (0, 8), (2, 2), (6, 2), (6, 6), (2, 6), (4, 3)],
    [
        (0, 1),
        (1, 2),
        (2, 3),
        (0, 3),
        (4, 5),
        (5, 6),
        (6, 7),
        (4, 7),
        (4, 8),
        (5, 8),
        (0, 4),
        (1, 5),
        (2, 6),
        (3, 7),
    ],
    holes=[(4, 8, 5, 6, 7)],
)
"""A triangle in a square hole, folded along a side of the hole; four creases to its corners."""

ACROSS = PanelPattern(
    [(0, 0), (4, 0), (4, 4), (0, 4), (2, 0), (2, 4), (2, 1), (3, 2), (2, 3), (1, 2)],
    [
        (0, 4),
        (1, 4),
        (1, 2),
        (2, 5),
        (3, 5),
        (0, 3),
        (6, 7),
        (7, 8),
        (8, 9),
        (6, 9),
        (4, 6),
        (5, 8),
    ],
    holes=[(6, 7, 8, 9)],
)
"""A straight crease, interrupted by a square hole."""

_POINTS = [
    *((0, 0), (6, 0), (12, 0), (12, 8), (6, 8), (0, 8)),
    *((4, 2), (6, 2), (7, 2), (7, 3), (5, 3), (4, 3)),
    *((4, 5), (5, 5), (7, 5), (7, 6), (6, 6), (4, 6)),
]
POP_UP = PanelPattern(
    _POINTS,
    [
        *((k + a, (k + 1) % 6 + a) for a in (0, 6, 12) for k in range(6)),
        *((1, 7), (4, 16), (11, 12), (10, 13), (9, 14)),
    ],
    holes=[tuple(range(6, 12)), tuple(range(12, 18))],
)
"""A page whose spine is interrupted by a step between two holes: a pop-up with parallel folds."""
