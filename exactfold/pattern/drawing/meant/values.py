"""Relations between the angles of edges, and the angles that satisfy all of them exactly.

The angle of an edge (i, j), i < j, is that of the vector from vertex i to vertex j, modulo pi.
Closing conditions at the flat sheet depend on these angles alone, and every relation that people
draw by is linear in them, with integer coefficients.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Literal, TypeAlias

Edge: TypeAlias = tuple[int, int]
Kind: TypeAlias = Literal[
    "straight", "border", "kawasaki", "grid", "parallel", "mirrored", "sectors"
]


@dataclass(frozen=True)
class Relation:
    """A sum of integer multiples of edge angles that is a multiple of pi / `parts`.

    `terms` holds the edges and their integers, and `name` is what people type, such as
    "straight@12:3-17". `defect` says by how much the drawing misses the relation: the angle in
    radians, times the shortest of the edges, divided by the size of the drawing.
    """

    kind: Kind
    name: str
    terms: tuple[tuple[Edge, int], ...]
    parts: int
    defect: float


@dataclass(frozen=True)
class Angles:
    """Edge angles that satisfy all accepted relations, as functions of free angles.

    The angle of an edge is pi times its constant plus the sum of its coefficients times the free
    angles. `free` holds the values of the free angles in the drawing, in radians.
    """

    constants: Mapping[Edge, Fraction]
    coefficients: Mapping[Edge, tuple[tuple[int, Fraction], ...]]
    free: tuple[float, ...]
