"""Relations between the angles of the edges of a sheet, each verified exactly.

A relation says that a sum of multiples of edge angles is a multiple of pi / parts. The angle of an
edge is that of the vector from its smaller vertex to its larger one, modulo pi. `parts` is 1 but
for "grid" and "mirrored". Each kind of relation has terms of one shape, and some kinds say more
than their sum; this is verified, too:

  straight  Two folds at an interior vertex, with the numbers 1 and -1. As edges do not overlap,
            they point in opposite directions.
  border    The same for the two boundary edges at a vertex.
  kawasaki  All folds at an interior vertex of even degree, in their order, with the numbers 1 and
            -1 in turn. Every other sector adds up to pi: the sum is between 0 and 2 pi.
  grid      One edge, or two with the numbers 1 and -1: the angle to the x-axis, or to the other
            edge.
  parallel  Two edges with the numbers 1 and -1.
  mirrored  Two edges with the number 1, and perhaps the axis with the number -2; without it, the
            axis is at a multiple of pi / (2 parts) to the x-axis.
  sectors   Two sectors of paper between neighbouring edges at one vertex. They are equal, and not
            only up to half a turn.
"""

from __future__ import annotations

from itertools import permutations
from typing import Any, TypedDict

from ..core.limits import MOST_PARTS
from ..core.reading import (
    CertificateError,
    at_most,
    integer,
    items,
    keys,
    keys_of,
    natural,
    require,
)
from .panels import Edge, PanelSheet, Vector, cross, dot, pair

Terms = list[tuple[Edge, int]]


class RelationClaim(TypedDict):
    """A relation: its kind, its name, and the terms [i, j, n] for n times the angle of edge i-j."""

    kind: str
    name: str
    terms: list[list[int]]
    parts: int


def same_terms(entry: RelationClaim) -> frozenset[tuple[int, ...]]:
    """What relations with the same terms have in common, whatever their kinds and signs."""
    signs = ([(i, j, sign * n) for i, j, n in entry["terms"]] for sign in (1, -1))
    return frozenset(max(sorted(terms) for terms in signs))


class Relations:
    """Verifies relations between the angles of the edges of a sheet, each at most once."""

    def __init__(self, sheet: PanelSheet) -> None:
        self.sheet = sheet
        self.known: set[tuple[str, frozenset[tuple[Edge, int]]]] = set()
        self.edges = set(sheet.edges)
        self._interior = set(sheet.interior)
        self._boundary = self.edges - set(sheet.folds)
        self._slopes: dict[Edge, Vector] = {}
        self._multiples: dict[tuple[Any, ...], bool] = {}

    def check(self, entry: Any) -> None:
        """Raise unless a relation has the terms of its kind and name, and holds exactly."""
        keys(entry, keys_of(RelationClaim), "a relation")
        kind, terms, parts = entry["kind"], self._terms(entry["terms"]), entry["parts"]
        shapes = {
            "straight": self._straight,
            "border": self._border,
            "kawasaki": self._kawasaki,
            "parallel": self._parallel,
            "grid": self._grid,
            "mirrored": self._mirrored,
            "sectors": self._sectors,
        }
        if kind not in shapes:
            raise CertificateError(f"there is no kind of relation {kind!a}")
        name = shapes[kind](terms)
        require(entry["name"] == name, f"{entry['name']!a} has the terms of {name}")
        key = kind, min((_set(terms, 1), _set(terms, -1)), key=sorted)
        require(key not in self.known, f"{name} appears twice")
        self.known.add(key)
        require(natural(parts, "parts"), f"{name} has 0 parts")
        require(parts == 1 or kind in ("grid", "mirrored"), f"{name} has {parts} parts, not 1")
        at_most(parts, MOST_PARTS, "the parts of pi in a relation", "MOST_PARTS")
        require(self._holds(terms, parts), f"{name} does not hold")

    def _terms(self, value: Any) -> Terms:
        terms = []
        for entry in items(value, "terms"):
            i, j, factor = (integer(part) for part in items(entry, "a term", 3))
            require((i, j) in self.edges, f"{i}-{j} is not an edge")
            terms.append(((i, j), factor))
        edges = [edge for edge, _ in terms]
        require(len(edges) == len(set(edges)), "an edge appears twice in a relation")
        return terms

    # --- the kinds: each returns the name of the relation with these terms -----------------------

    def _straight(self, terms: Terms) -> str:
        """Two folds at an interior vertex that form a straight line."""
        v, (a, b) = self._line(terms)
        require(v in self._interior, f"straight: vertex {v} is not inside the sheet")
        return f"straight@{v}:{a}-{b}"

    def _border(self, terms: Terms) -> str:
        """The two boundary edges at a vertex, which form a straight line."""
        v, ends = self._line(terms)
        for u in ends:
            require(pair(u, v) in self._boundary, f"border: edge {u}-{v} is not on the boundary")
        return f"border@{v}"

    def _line(self, terms: Terms) -> tuple[int, list[int]]:
        """The common end of two edges, and their other ends.

        The edges of a sheet do not overlap. So two edges with a common end point in opposite
        directions if they are parallel.
        """
        first, second = self._two(terms, -1)
        v = self._centre(terms)
        return v, sorted({*first, *second} - {v})

    def _kawasaki(self, terms: Terms) -> str:
        """Every other sector at an interior vertex of even degree; their sum is pi.

        The sum is positive and less than 2 pi, so that it is pi if it is a multiple of pi.
        """
        v = self._centre(terms)
        near = self.sheet.around[v]
        require(v in self._interior, f"kawasaki: vertex {v} is not inside the sheet")
        require(len(near) % 2 == 0, f"kawasaki: vertex {v} has an odd number of folds")
        turns = [(pair(v, u), (-1) ** k) for k, u in enumerate(near)]
        alternate = _set(terms, 1) in (_set(turns, 1), _set(turns, -1))
        require(alternate, f"kawasaki: the numbers of the folds at vertex {v} do not alternate")
        return f"kawasaki@{v}"

    def _sectors(self, terms: Terms) -> str:
        """Two sectors of paper between neighbouring edges at one vertex, which are equal."""
        v = self._centre(terms)
        near = self.sheet.around[v]
        for (a, b), (c, d) in permutations(zip(near, [*near[1:], *near[:1]], strict=True), 2):
            total: dict[Edge, int] = {}
            for u, factor in ((a, -1), (b, 1), (c, 1), (d, -1)):
                total[pair(v, u)] = total.get(pair(v, u), 0) + factor
            if _set(terms, 1) == {(edge, n) for edge, n in total.items() if n}:
                name = f"sectors@{v}:{a}-{b},{c}-{d}"
                for ends in ((a, b), (c, d)):
                    outside = all(pair(v, u) in self._boundary for u in ends)
                    require(not outside, f"{name}: a sector lies outside the sheet")
                one, other = self._turn(v, a, b), self._turn(v, c, d)
                require(dot(one, other).sign() > 0, f"{name}: the sectors differ by pi")
                return name
        raise CertificateError(f"the terms are not those of two sectors at vertex {v}")

    def _parallel(self, terms: Terms) -> str:
        first, second = self._two(terms, -1)
        return f"parallel:{_name(first)},{_name(second)}"

    def _grid(self, terms: Terms) -> str:
        """An edge whose angle, from the x-axis or another edge, is a multiple of pi / parts."""
        if len(terms) == 1:
            require(terms[0][1] == 1, "grid: the number of the edge is not 1")
            return f"grid:{_name(terms[0][0])}"
        first, second = self._two(terms, -1)
        return f"grid:{_name(first)},{_name(second)}"

    def _mirrored(self, terms: Terms) -> str:
        """Two edges that are mirrored in some line.

        The angle of this line, from the x-axis or from an edge with the number -2, is a multiple of
        pi / (2 parts).
        """
        require(len(terms) < 3 or terms[2][1] == -2, "mirrored: the number of the axis is not -2")
        first, second = self._two(terms[:2], 1)
        require(len(terms) < 4, "mirrored: there are more than three edges")
        return f"mirrored:{_name(first)},{_name(second)}"

    # --- terms -----------------------------------------------------------------------------------

    def _two(self, terms: Terms, sign: int) -> tuple[Edge, Edge]:
        numbers = [n for _, n in terms]
        require(numbers == [1, sign], f"the terms of a pair of edges are {numbers}, not 1, {sign}")
        (first, _), (second, _) = terms
        return first, second

    def _centre(self, terms: Terms) -> int:
        """The vertex that all edges have in common."""
        common = {*terms[0][0]}.intersection(*(edge for edge, _ in terms))
        require(len(common) == 1, "the edges of a relation do not meet in one vertex")
        return common.pop()

    def _turn(self, v: int, a: int, b: int) -> Vector:
        """The cosine and the sine of the angle from edge v-a to v-b, times a positive number."""
        one, other = self.sheet.vector(v, a), self.sheet.vector(v, b)
        return dot(one, other), cross(one, other)

    def _slope(self, edge: Edge) -> Vector:
        """A vector along an edge, (1, slope) or (0, 1): these numbers are often short."""
        if edge not in self._slopes:
            x, y = self.sheet.vector(*edge)
            one, zero = (self.sheet.tower.number(n) for n in (1, 0))
            self._slopes[edge] = (one, y / x) if x.sign() else (zero, one)
        return self._slopes[edge]

    def _holds(self, terms: Terms, parts: int) -> bool:
        """Whether the sum of angles is a multiple of pi / parts.

        The angle of a product of complex numbers is the sum of their angles. So the product of all
        directions, to the power of `parts`, is a real number.
        """
        factors = tuple((self._slope(edge), n * parts) for edge, n in terms)
        key = tuple((x.parts, y.parts, n) for (x, y), n in factors)
        if key not in self._multiples:
            real, imaginary = self.sheet.tower.number(1), self.sheet.tower.number(0)
            for (x, y), n in factors:
                if n < 0:
                    y = -y
                for _ in range(abs(n)):
                    real, imaginary = real * x - imaginary * y, real * y + imaginary * x
            self._multiples[key] = imaginary.sign() == 0
        return self._multiples[key]


def _set(terms: Terms, sign: int) -> frozenset[tuple[Edge, int]]:
    return frozenset((edge, sign * n) for edge, n in terms)


def _name(edge: Edge) -> str:
    return f"{edge[0]}-{edge[1]}"
