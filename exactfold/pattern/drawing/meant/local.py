"""Relations at a vertex that closing conditions depend on: straight paths and Kawasaki sums."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations, pairwise
from math import gamma, pi

from exactfold.pattern.drawing.meant.accepted import Accepted, Trial
from exactfold.pattern.drawing.meant.drawn import NEAR, Drawn, Ray
from exactfold.pattern.drawing.meant.values import Edge, Relation


def local_relations(drawn: Drawn) -> tuple[list[tuple[Relation, float]], list[float]]:
    """All near straight, border and Kawasaki relations, each with its density, and all densities.

    Two edges at an interior vertex may be opposite, and so may the two border edges at a vertex of
    the boundary. At an interior vertex of even degree the alternating sum of angles may be a
    multiple of pi. If the rays at a vertex were independent and uniform, such a relation would be
    missed by less than a small x, as a length over the size, with probability x times its density.
    The second list has the density of each place where there might be a relation, near or not.

    Exact relations are among those returned; their defect is 0.
    """
    relations: list[tuple[Relation, float]] = []
    densities: list[float] = []
    for v, rays in sorted(drawn.rays.items()):
        inside = v not in drawn.boundary
        near = rays if inside else [ray for ray in rays if ray.edge in drawn.border]
        for k, a in enumerate(near):
            for b in near[k + 1 :]:
                densities.append(1 / (pi * drawn.shortest((a.edge, b.edge))))
                if abs(b.angle - a.angle - pi) < NEAR:
                    relations.append((straight(drawn, v, a, b), densities[-1]))
        if inside and len(rays) >= 4 and len(rays) % 2 == 0:
            shortest = drawn.shortest(ray.edge for ray in rays)
            densities.append(_kawasaki_density(len(rays)) / shortest)
            odd = sum(b.angle - a.angle for a, b in zip(rays[::2], rays[1::2], strict=True))
            if abs(odd - pi) < NEAR:
                relations.append((kawasaki(drawn, v, rays), densities[-1]))
    return relations, densities


def straight(drawn: Drawn, v: int, a: Ray, b: Ray) -> Relation:
    """The relation that two rays at a vertex are opposite; both are border edges or neither is."""
    terms = ((a.edge, 1), (b.edge, -1))
    if v in drawn.boundary:
        return drawn.relation("border", f"border@{v}", terms)
    i, j = sorted((a.end, b.end))
    return drawn.relation("straight", f"straight@{v}:{i}-{j}", terms)


def kawasaki(drawn: Drawn, v: int, rays: Sequence[Ray]) -> Relation:
    """The relation that the sectors at a vertex of even degree add up to pi, taken in turns."""
    terms = [(ray.edge, 1 if k % 2 else -1) for k, ray in enumerate(rays)]
    return drawn.relation("kawasaki", f"kawasaki@{v}", terms)


def equal_sectors(accepted: Accepted) -> Iterator[Trial]:
    """Looks for equal sectors at each vertex that do not follow from relations accepted before.

    The sectors with the longest sides come first.
    """
    drawn = accepted.drawn
    places = []
    for v, rays in drawn.rays.items():
        sectors = [*pairwise(rays), (rays[-1], rays[0])]
        if v in drawn.boundary:
            sectors = [pair for pair in sectors if not {r.edge for r in pair} <= drawn.border]
        for first, second in combinations(sectors, 2):
            sides = {ray.edge for ray in (*first, *second)}
            places.append((drawn.shortest(sides), v, len(rays), first, second))
    for shortest, v, degree, (a, b), (c, d) in sorted(places, key=lambda place: -place[0]):
        off = (b.angle - a.angle) % (2 * pi) - (d.angle - c.angle) % (2 * pi)
        spread = accepted.tolerance / shortest
        found = None
        if abs(off) <= min(spread, NEAR):
            if accepted.is_implied(_sector_terms((a, b), (c, d))):
                continue
            found = sectors_relation(drawn, v, (a, b), (c, d))
        yield Trial(min(1.0, degree * spread / (2 * pi)), found)


def sectors_relation(
    drawn: Drawn, v: int, first: tuple[Ray, Ray], second: tuple[Ray, Ray]
) -> Relation:
    """The relation that two sectors at a vertex are equal."""
    (a, b), (c, d) = first, second
    name = f"sectors@{v}:{a.end}-{b.end},{c.end}-{d.end}"
    return drawn.relation("sectors", name, _sector_terms(first, second))


def _sector_terms(first: tuple[Ray, Ray], second: tuple[Ray, Ray]) -> list[tuple[Edge, int]]:
    (a, b), (c, d) = first, second
    return [(b.edge, 1), (a.edge, -1), (d.edge, -1), (c.edge, 1)]


def _kawasaki_density(degree: int) -> float:
    """How likely every other of uniform sectors add up to within x of pi, over x, for small x.

    Their sum over 2 pi has the distribution Beta(k, k) with 2 k = degree.
    """
    half = degree / 2
    middle = gamma(2 * half) / gamma(half) ** 2 / 2 ** (2 * half - 2)
    return middle / pi
