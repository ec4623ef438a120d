"""Relations as people type them: to delete those that were found, and to state others."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from math import degrees
from typing import Final, NamedTuple, get_args

from exactfold.errors import UsageError
from exactfold.pattern.drawing.meant.drawn import NEAR, Drawn, Ray
from exactfold.pattern.drawing.meant.grids import Grid, grid_relation, mirrored, parallel
from exactfold.pattern.drawing.meant.local import kawasaki, sectors_relation, straight
from exactfold.pattern.drawing.meant.values import Edge, Kind, Relation

KINDS: Final = get_args(Kind)
_FORM: Final = re.compile(r"\s*(?P<kind>[a-z]+)\s*(?:@\s*(?P<vertex>\d+))?[\s:]*(?P<pairs>.*?)\s*")
_PAIR: Final = re.compile(r"(\d+)-(\d+)")
_EXAMPLES: Final = "straight@12, straight@12:3-17, kawasaki@5, grid:3-4, or parallel:3-4,8-9"
_LISTED: Final = 6
_UNIT: Final = 4


class Name(NamedTuple):
    """A relation, or several, as typed: "straight@12:3-17", "straight@12", "parallel 3-4,8-9"."""

    kind: str
    vertex: int | None
    pairs: tuple[tuple[int, int], ...]

    def fits(self, other: Name) -> bool:
        """Whether this name, which may leave out parts, stands for a relation named `other`."""
        own, theirs = ({frozenset(pair) for pair in name.pairs} for name in (self, other))
        return self.kind == other.kind and self.vertex in (None, other.vertex) and own <= theirs


def parsed(text: str) -> Name:
    """The name of a relation; raises `UsageError` for text that is none.

    >>> parsed("Parallel 3-4, 8-9")
    Name(kind='parallel', vertex=None, pairs=((3, 4), (8, 9)))
    """
    match = _FORM.fullmatch(re.sub(r"\s*-\s*", "-", text.lower()))
    parts = re.split(r"[,\s]+", match["pairs"]) if match and match["pairs"] else []
    pairs = [_PAIR.fullmatch(part) for part in parts]
    if match is None or match["kind"] not in KINDS or None in pairs:
        raise UsageError(
            f"{text!r} names no relation: write the kind ({', '.join(KINDS)}) and where, such as "
            f"{_EXAMPLES}"
        )
    vertex = match["vertex"]
    return Name(
        match["kind"],
        None if vertex is None else int(vertex),
        tuple((int(pair[1]), int(pair[2])) for pair in pairs if pair is not None),
    )


def named(relations: Sequence[Relation], texts: Iterable[str]) -> list[Relation]:
    """The relations that the texts stand for, in their order.

    Raises `UsageError` for a text that stands for none; the message lists relations nearby.
    """
    names = [parsed(relation.name) for relation in relations]
    chosen: set[int] = set()
    for text in texts:
        wanted = parsed(text)
        fitting = {k for k, name in enumerate(names) if wanted.fits(name)}
        if not fitting:
            raise UsageError(f"there is no relation {text!r}: {_nearby(relations, names, wanted)}")
        chosen |= fitting
    return [relation for k, relation in enumerate(relations) if k in chosen]


def _nearby(relations: Sequence[Relation], names: Sequence[Name], wanted: Name) -> str:
    """What exists at the vertices of a name that stands for no relation."""
    if not relations:
        return "nothing was inferred about this drawing"
    places = {v for pair in wanted.pairs for v in pair} | {wanted.vertex} - {None}
    near = [
        relation.name
        for relation, name in zip(relations, names, strict=True)
        if name.vertex in places or places & {v for pair in name.pairs for v in pair}
    ]
    where = "nearby there are"
    if not near:
        near = [name.name for name in relations if name.kind == wanted.kind]
        where = f"the {wanted.kind} relations are"
    if not near:
        return f"no {wanted.kind} relation was inferred about this drawing"
    more = f", and {len(near) - _LISTED} more" if len(near) > _LISTED else ""
    return f"{where} {', '.join(near[:_LISTED])}{more}"


def stated(drawn: Drawn, text: str, grid: Grid | None) -> Relation:
    """The relation that a user states to hold in the sheet that was meant.

    Angles on the grid become multiples of its unit, or of 45 degrees if there is no grid. Raises
    `UsageError` if the text names no relation or edges that do not exist, or if the drawing misses
    the relation by far.
    """
    name = parsed(text)
    relation = _built(drawn, text, name, grid or Grid(_UNIT, None))
    off = abs(drawn.residual(relation.terms, relation.parts))
    if off > NEAR:
        raise UsageError(
            f"the drawing misses {text!r} by {degrees(off):.0f} degrees: this is not what it means"
        )
    return relation


def _built(drawn: Drawn, text: str, name: Name, grid: Grid) -> Relation:
    vertex, pairs = name.vertex, name.pairs
    if name.kind in ("grid", "parallel", "mirrored"):
        edges = [_edge(drawn, pair) for pair in pairs]
        if name.kind == "grid" and len(edges) == 1 and edges[0] != grid.reference:
            return grid_relation(drawn, edges[0], grid.unit, grid.reference)
        if len(edges) != 2 or edges[0] == edges[1] or vertex is not None:
            raise _incomplete(text, f"{name.kind} 3-4,8-9")
        edge, other = edges
        if name.kind == "grid":
            return grid_relation(drawn, edge, grid.unit, other)
        if name.kind == "parallel":
            return parallel(drawn, edge, other)
        return mirrored(drawn, edge, other, grid.unit, grid.reference)
    if vertex is None:
        raise _incomplete(text, f"{name.kind}@12")
    if vertex not in drawn.rays:
        raise UsageError(f"{text!r}: there is no vertex {vertex}")
    rays = drawn.rays[vertex]
    if name.kind == "kawasaki":
        if vertex in drawn.boundary or len(rays) % 2:
            raise UsageError(
                f"{text!r}: Kawasaki sums exist at vertices inside the sheet with an even number "
                f"of folds; vertex {vertex} has {len(rays)} edges"
            )
        return kawasaki(drawn, vertex, rays)
    if name.kind == "border":
        sides = [ray for ray in rays if ray.edge in drawn.border]
        if len(sides) != 2:
            raise UsageError(f"{text!r}: vertex {vertex} is not on the boundary of the sheet")
        return straight(drawn, vertex, sides[0], sides[1])
    ends = [tuple(_ray(drawn, vertex, end) for end in pair) for pair in pairs]
    if name.kind == "straight":
        if len(ends) != 1 or vertex in drawn.boundary:
            raise _incomplete(text, "straight@12:3-17, at a vertex inside the sheet")
        return straight(drawn, vertex, ends[0][0], ends[0][1])
    if len(ends) != 2:
        raise _incomplete(text, "sectors@12:3-4,4-7")
    return sectors_relation(drawn, vertex, (ends[0][0], ends[0][1]), (ends[1][0], ends[1][1]))


def _incomplete(text: str, example: str) -> UsageError:
    return UsageError(f"{text!r} does not say which edges: write, for example, {example}")


def _edge(drawn: Drawn, pair: tuple[int, int]) -> Edge:
    edge = min(pair), max(pair)
    if edge not in drawn.lengths:
        i, j = edge
        beside = [f"{min(v, r.end)}-{max(v, r.end)}" for v in edge for r in drawn.rays.get(v, ())]
        known = f"; nearby there are {', '.join(beside[:_LISTED])}" if beside else ""
        raise UsageError(f"there is no edge {i}-{j}{known}")
    return edge


def _ray(drawn: Drawn, vertex: int, end: int) -> Ray:
    for ray in drawn.rays[vertex]:
        if ray.end == end:
            return ray
    ends = ", ".join(str(ray.end) for ray in drawn.rays[vertex])
    raise UsageError(f"no edge joins vertices {vertex} and {end}: {vertex} is joined to {ends}")
