"""Relations between the angles of edges, and the angles that satisfy all of them exactly.

The angle of an edge (i, j), i < j, is that of the vector from vertex i to vertex j. A relation
holds modulo pi, so that the sense of an edge does not matter to it. Closing conditions at the flat
sheet depend on these angles alone, and every relation that people draw by is linear in them, with
integer coefficients.
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
Existence: TypeAlias = Literal["exact", "box", "none"]


@dataclass(frozen=True)
class Relation:
    """A sum of integer multiples of edge angles that is a multiple of pi / `parts`.

    `terms` holds the edges and their integers, and `name` is what people type, such as
    "straight@12:3-17". `defect` says by how much the drawing misses the relation: the angle in
    radians, times the shortest of the edges, divided by the size of the drawing. It is 0 only if
    the digits of the drawing satisfy the relation exactly.
    """

    kind: Kind
    name: str
    terms: tuple[tuple[Edge, int], ...]
    parts: int
    defect: float


@dataclass(frozen=True)
class Angles:
    """Edge angles that satisfy all accepted relations, as functions of free angles.

    The angle of an edge (i, j), i < j, is pi times its constant plus the sum of its coefficients
    times the free angles. It lies near that of the drawn vector from i to j, modulo 2 pi. `free`
    holds values of the free angles, in radians, that fit the drawing best; each free angle is the
    angle of the edge in `free_edges`.
    """

    constants: Mapping[Edge, Fraction]
    coefficients: Mapping[Edge, tuple[tuple[int, Fraction], ...]]
    free: tuple[float, ...]
    free_edges: tuple[Edge, ...] = ()
