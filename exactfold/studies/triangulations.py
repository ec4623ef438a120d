"""Triangulations of a quadrilateral as combinatorial types, and the H1 moves that build them.

A triangulation is the set of its triangles, each counter-clockwise and beginning with its smallest
vertex. No two edges join the same vertices. A type is a class of triangulations up to renumbering
and reflection. Every triangulation with n >= 1 interior vertices has an interior vertex of degree
3, 4 or 5 such that, after its removal, the hole can be filled without a double edge
(`proofs/h1_triangulations.py`, which inserts vertices by this module). So inserting one vertex into
the triangulations with n - 1 interior vertices gives all of them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

Triangle = tuple[int, int, int]
Triangulation = frozenset[Triangle]
Turns = Mapping[tuple[int, int], int]

CORNERS = 4


def triangulation(triangles: Iterable[Triangle]) -> Triangulation:
    """The set of triangles, each rotated so that its smallest vertex comes first."""
    return frozenset(min((a, b, c), (b, c, a), (c, a, b)) for a, b, c in triangles)


def turns(triangles: Iterable[Triangle]) -> dict[tuple[int, int], int]:
    """The third vertex of the triangle on the left of each oriented edge that has one."""
    return {(a, b): c for t in triangles for a, b, c in (t, (*t[1:], t[0]), (*t[2:], *t[:2]))}


def types(interior: int) -> list[Triangulation]:
    """One triangulation of each type with this number of interior vertices; chords are allowed.

    >>> [len(types(n)) for n in range(4)]
    [1, 2, 5, 18]
    """
    level = [triangulation([(0, 1, 2), (0, 2, 3)])]
    for _ in range(interior):
        by_code = {_code(larger): larger for smaller in level for larger in insertions(smaller)}
        level = [by_code[code] for code in sorted(by_code)]
    return level


def has_chord(triangles: Triangulation) -> bool:
    """Whether an interior edge joins two boundary vertices."""
    boundary, turn = boundary_of(triangles), turns(triangles)
    return any(a in boundary and b in boundary and (b, a) in turn for a, b in turn)


def has_low_vertex(triangles: Triangulation) -> bool:
    """Whether an interior vertex has degree 3."""
    boundary, degree = boundary_of(triangles), degrees(triangles)
    return any(d < 4 for v, d in degree.items() if v not in boundary)


def boundary_of(triangles: Triangulation) -> set[int]:
    """The set of boundary vertices."""
    turn = turns(triangles)
    return {v for a, b in turn if (b, a) not in turn for v in (a, b)}


def degrees(triangles: Triangulation) -> dict[int, int]:
    """The number of edges at each vertex."""
    near: dict[int, set[int]] = {}
    for t in triangles:
        for v in t:
            near.setdefault(v, set()).update(t)
    return {v: len(vertices) - 1 for v, vertices in near.items()}


def low_corners(triangles: Triangulation) -> int:
    """The number of boundary vertices of degree 3."""
    degree = degrees(triangles)
    return sum(degree[v] == 3 for v in boundary_of(triangles))


def reverse_moves(triangles: Triangulation) -> int:
    """The largest number of reverse H1 moves that can be made one after the other.

    Such a move removes a boundary vertex of degree 3; its middle neighbour v2 must be interior and
    keep a degree of at least 3 (the paper, Section IV). A triangulation with n interior vertices is
    H1 if n such moves lead to the two triangles of a butterfly.

    >>> reverse_moves(triangulation([(0, 1, 4), (1, 2, 4), (2, 3, 4), (0, 4, 3)]))
    1
    """
    return _moves(triangles, {})


def _moves(triangles: Triangulation, known: dict[Triangulation, int]) -> int:
    if triangles not in known:
        known[triangles] = max((1 + _moves(t, known) for t in _reduced(triangles)), default=0)
    return known[triangles]


def _reduced(triangles: Triangulation) -> Iterator[Triangulation]:
    boundary, degree = boundary_of(triangles), degrees(triangles)
    for corner in boundary:
        if degree[corner] == 3:
            first, second = (t for t in triangles if corner in t)
            (middle,) = {*first} & {*second} - {corner}
            if middle not in boundary and degree[middle] > 3:
                yield triangles - {first, second}


def insertions(triangles: Triangulation) -> Iterator[Triangulation]:
    """Yields all results of inserting a vertex of degree 3, 4 or 5, with the next number.

    >>> len(set(insertions(triangulation([(0, 1, 2), (0, 2, 3)]))))
    3
    """
    turn = turns(triangles)
    new = len({v for t in triangles for v in t})
    for a, b, c in triangles:
        yield _filled(triangles, [(a, b, c)], (a, b, c), new)
    for (a, b), c in turn.items():
        if (b, a) not in turn:
            continue
        d = turn[b, a]
        if a < b:
            yield _filled(triangles, [(a, b, c), (b, a, d)], (a, d, b, c), new)
        if (a, c) in turn and turn[a, c] != d:
            e = turn[a, c]
            yield _filled(triangles, [(a, b, c), (b, a, d), (a, c, e)], (a, d, b, c, e), new)


def _filled(
    triangles: Triangulation, gone: list[Triangle], hole: tuple[int, ...], new: int
) -> Triangulation:
    fan = ((a, b, new) for a, b in zip(hole, (*hole[1:], hole[0]), strict=True))
    return (triangles - triangulation(gone)) | triangulation(fan)


def _code(triangles: Triangulation) -> bytes:
    """A code that is equal for two triangulations exactly if they have the same type.

    A search that starts from a boundary side names the vertices in the order in which it meets
    them. The code is the least result over the four sides and both orientations.
    """
    turn = turns(triangles)
    mirror = {(b, a): c for (a, b), c in turn.items()}
    return min(
        _search(side, which)
        for which in (turn, mirror)
        for side in which
        if side[::-1] not in which
    )


def _search(side: tuple[int, int], turn: Turns) -> bytes:
    names = {side[0]: 0, side[1]: 1}
    queue, seen, code = [side], set(), bytearray()
    for a, b in queue:
        if (a, b) in seen:
            continue
        c = turn.get((a, b))
        if c is None:
            code.append(255)
            continue
        code.append(names.setdefault(c, len(names)))
        seen |= {(a, b), (b, c), (c, a)}
        queue += [(c, b), (a, c)]
    return bytes(code)
