"""Triangulated disks with four corners: all up to symmetry, and what their cycles enclose."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import combinations

import networkx as nx

from exactfold.pattern.crease_pattern import Triangle

Disk = tuple[Triangle, ...]

RIM = frozenset(range(4))
"""The corners."""


def graph(disk: Iterable[Triangle]) -> nx.Graph:
    """The vertices and edges of a triangulated disk."""
    found = nx.Graph()
    for a, b, c in disk:
        found.add_edges_from([(a, b), (b, c), (c, a)])
    return found


def enclosed(disk: Iterable[Triangle], size: int) -> set[frozenset[int]]:
    """All sets of interior vertices that fill the inside of some cycle of `size` vertices, 3 or 4.

    When the vertices of the cycle are taken away, such a set is a component without corners. The
    cycle is not the boundary.
    """
    return {part for parts in separating(disk, size).values() for part in parts}


def separating(disk: Iterable[Triangle], size: int) -> dict[tuple[int, ...], set[frozenset[int]]]:
    """The sets of `size` vertices that separate others from the corners, with what they separate.

    The boundary is not counted.
    """
    edges = graph(disk)
    found: dict[tuple[int, ...], set[frozenset[int]]] = {}
    for ring in combinations(sorted(edges), size):
        if set(ring) != RIM:
            left = edges.subgraph(set(edges) - set(ring))
            inside = {frozenset(p) for p in nx.connected_components(left) if not p & RIM}
            found |= {ring: inside} if inside else {}
    return found


def triangulations(n: int) -> list[Disk]:
    """All triangulated disks with 4 corners and n inner vertices, none inside a triangle of edges.

    The corners are 0 to 3 in their order. Disks that differ only by names of the other vertices and
    a symmetry of the square count once. They are found by flips, starting from one disk, and
    sorted.

    >>> [len(triangulations(n)) for n in range(1, 5)]
    [1, 1, 2, 6]
    """
    first: list[Triangle] = [(0, 1, 2), (0, 2, 3)]
    for v in range(4, 4 + n):
        a, b, c = first.pop(0)
        first += [(a, b, v), (b, c, v), (c, a, v)]
    found = {_renamed(first)}
    left = list(found)
    while left:
        new = {_renamed(disk) for disk in _flips(left.pop())} - found
        found |= new
        left += new
    return sorted(disk for disk in found if not enclosed(disk, 3))


def to_the_left(disk: Iterable[Triangle]) -> dict[tuple[int, int], int]:
    """The third vertex of the face to the left of each directed edge."""
    return {half: w for a, b, c in disk for half, w in (((a, b), c), ((b, c), a), ((c, a), b))}


def _flips(disk: Disk) -> Iterator[list[Triangle]]:
    third = to_the_left(disk)
    for (a, b), c in third.items():
        d = third.get((b, a))
        if a < b and d is not None and not {(c, d), (d, c)} & set(third):
            yield [t for t in disk if not {a, b} <= set(t)] + [(c, d, b), (d, c, a)]


def _renamed(disk: Iterable[Triangle]) -> Disk:
    """A normal form: the same for disks that differ by names and a symmetry of the square."""
    left = to_the_left(disk)
    right = {(b, a): c for (a, b), c in left.items()}
    return min(
        _walk(third, [(k + side * i) % 4 for i in range(4)])
        for side, third in ((1, left), (-1, right))
        for k in range(4)
    )


def _walk(third: dict[tuple[int, int], int], corners: list[int]) -> Disk:
    """The faces, with vertices renamed in the order in which a walk from the rim meets them."""
    names = {corner: i for i, corner in enumerate(corners)}
    queue = [(corners[i - 1], corners[i]) for i in range(4)]
    faces: dict[frozenset[int], Triangle] = {}
    for a, b in queue:
        c = third.get((a, b))
        if c is not None and frozenset((a, b, c)) not in faces:
            face = names[a], names[b], names.setdefault(c, len(names))
            k = face.index(min(face))
            faces[frozenset((a, b, c))] = (face[k], face[k - 2], face[k - 1])
            queue += [(a, c), (c, b)]
    return tuple(sorted(faces.values()))
