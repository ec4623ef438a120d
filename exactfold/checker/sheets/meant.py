"""Certificates of the sheet that was meant by a drawing (docs/certificate.md, The meant sheet).

A file has the points of a drawing as they were written, and an exact sheet with the same edges. The
checker finds that both have the same panels, that no vertex lies further from its written point
than claimed, and that the exact sheet has every relation of angles that is claimed.

A relation says that a sum of multiples of edge angles is a multiple of pi / n. The angle of an edge
is that of the vector from its smaller vertex to its larger one, modulo pi. Each kind of relation
has terms of one shape, and some kinds say more than their sum: what they say is verified, too.
"""

from __future__ import annotations

from fractions import Fraction
from functools import cached_property
from itertools import combinations
from typing import Any, TypedDict

from ..core.kinds import DocumentKind
from ..core.limits import MOST_PARTS
from ..core.reading import (
    CertificateError,
    at_most,
    counted,
    integer,
    items,
    keys,
    keys_of,
    natural,
    parse_rational,
    refusing,
    require,
    rounded,
    same,
)
from .panels import Edge, PanelSheet, Vector, cross, dot, pair, read_panels

Terms = list[tuple[Edge, int]]


class RelationClaim(TypedDict):
    """A relation: its kind, its name, and the terms [i, j, n] for n times the angle of edge i-j."""

    kind: str
    name: str
    terms: list[list[int]]
    parts: int


class MeantClaims(TypedDict):
    """The claims of a file (see `check`)."""

    interior: int
    border: int
    folds: int
    panels: int
    drawn: str
    within: str
    relations: list[RelationClaim]
    sha256: str


@refusing()
def check(data: dict[str, Any]) -> MeantClaims:
    """Verify every claim of a loaded certificate; raises `CertificateError` at the first failure.

    Returns the claims. `within` bounds how far each vertex lies from its written point, in units of
    the larger side of the drawing. `drawn` is the digest of the drawing as written, `sha256` that
    of the exact sheet.
    """
    claims = data["claims"]
    keys(claims, keys_of(MeantClaims), "claims")
    drawn, written = read_panels(data["drawn"])
    require(drawn.tower.size == 1, "the drawing has coordinates with square roots")
    sheet, digest = read_panels(data["pattern"])
    require(drawn.edges == sheet.edges, "the drawing and the sheet do not have the same edges")
    require(drawn.panels == sheet.panels, "the drawing and the sheet do not have the same panels")
    facts = {
        "interior": len(sheet.interior),
        "border": len(sheet.boundary_set),
        "folds": len(sheet.folds),
        "panels": len(sheet.panels),
        "drawn": written,
        "sha256": digest,
    }
    for key, fact in facts.items():
        require(same(claims[key], fact), f"claim {key} = {claims[key]!a}, but it is {fact!a}")
    _check_near(drawn, sheet, parse_rational(claims["within"]))
    relations = Relations(sheet)
    for entry in items(claims["relations"], "relations"):
        relations.check(entry)
    proved: MeantClaims = claims
    return proved


def _check_near(drawn: PanelSheet, sheet: PanelSheet, within: Fraction) -> None:
    require(within >= 0, "a distance is negative")
    sides = [[point[k].parts[0] for point in drawn.points] for k in (0, 1)]
    reach = within * max(max(side) - min(side) for side in sides)
    bound = sheet.tower.number(reach * reach)
    for v, ((ax, ay), (x, y)) in enumerate(zip(drawn.points, sheet.points, strict=True)):
        off = (x - sheet.tower.number(ax), y - sheet.tower.number(ay))
        require((bound - dot(off, off)).sign() >= 0, f"vertex {v} lies further from its drawing")


class Relations:
    """Verifies relations between the angles of the edges of a sheet, each at most once."""

    def __init__(self, sheet: PanelSheet) -> None:
        self.sheet = sheet
        self.names: set[str] = set()
        self.edges = set(sheet.edges)
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
        require(kind in shapes, f"there is no kind of relation {kind!a}")
        name = shapes[kind](terms)
        require(entry["name"] == name, f"{entry['name']!a} has the terms of {name}")
        require(name not in self.names, f"{name} appears twice")
        self.names.add(name)
        require(natural(parts, "parts"), f"{name} has 0 parts")
        require(parts == 1 or kind in ("grid", "mirrored"), f"{name} has {parts} parts, not 1")
        at_most(parts, MOST_PARTS, "the parts of pi in a relation", "MOST_PARTS")
        require(self._holds(terms, parts), f"{name} does not hold")

    def _terms(self, value: Any) -> Terms:
        """The terms, sorted by edges; each edge appears once, and the first number is positive."""
        terms = []
        for entry in items(value, "terms"):
            i, j, factor = (integer(part) for part in items(entry, "a term", 3))
            require((i, j) in self.edges, f"{i}-{j} is not an edge")
            terms.append(((i, j), factor))
        edges = [edge for edge, _ in terms]
        require(terms and edges == sorted(set(edges)), "the terms of a relation are not sorted")
        require(terms[0][1] > 0, "the first number of a relation is not positive")
        return terms

    # --- the kinds: each returns the name of the relation with these terms -----------------------

    def _straight(self, terms: Terms) -> str:
        """Two folds at an interior vertex that point in opposite directions."""
        v, a, b = self._opposite(terms)
        require(v in self.sheet.interior, f"straight: vertex {v} is not inside the sheet")
        return f"straight@{v}:{a}-{b}"

    def _border(self, terms: Terms) -> str:
        """The two boundary edges at a vertex, which point in opposite directions."""
        v, a, b = self._opposite(terms)
        for u in (a, b):
            sides = self.sheet.boundary_set.issuperset((u, v)) and pair(u, v) not in self._folds
            require(sides, f"border: edge {u}-{v} is not on the boundary")
        return f"border@{v}"

    def _opposite(self, terms: Terms) -> tuple[int, int, int]:
        """The common end of two edges that point in opposite directions, and their other ends."""
        first, second = self._two(terms, -1)
        ends = {*first, *second}
        require(len(ends) == 3, "two edges that form a line have no common end")
        [v] = {*first} & {*second}
        a, b = sorted(ends - {v})
        apart = dot(self.sheet.vector(v, a), self.sheet.vector(v, b)).sign() < 0
        require(apart, f"the edges from {v} to {a} and {b} do not point in opposite directions")
        return v, a, b

    def _kawasaki(self, terms: Terms) -> str:
        """Every other sector at an interior vertex of even degree; their sum is pi.

        The sum is positive and less than 2 pi, so that it is pi if it is a multiple of pi.
        """
        v = self._centre(terms)
        near = self.sheet.around[v]
        require(v in self.sheet.interior, f"kawasaki: vertex {v} is not inside the sheet")
        require(len(near) % 2 == 0, f"kawasaki: vertex {v} has an odd number of folds")
        turns = sorted((pair(v, u), (-1) ** k) for k, u in enumerate(near))
        require(terms == _signed(turns), f"kawasaki: the folds at {v} do not alternate")
        return f"kawasaki@{v}"

    def _sectors(self, terms: Terms) -> str:
        """Two sectors between neighbouring edges at one vertex, which are equal."""
        v = self._centre(terms)
        near = self.sheet.around[v]
        sectors = list(zip(near, [*near[1:], *near[:1]], strict=True))
        for (a, b), (c, d) in combinations(sectors, 2):
            total: dict[Edge, int] = {}
            for u, factor in ((a, -1), (b, 1), (c, 1), (d, -1)):
                total[pair(v, u)] = total.get(pair(v, u), 0) + factor
            if _signed(sorted((e, n) for e, n in total.items() if n)) == terms:
                one, other = self._turn(v, a, b), self._turn(v, c, d)
                require(dot(one, other).sign() > 0, f"sectors at {v} differ by pi")
                return f"sectors@{v}:{a}-{b},{c}-{d}"
        raise CertificateError(f"sectors: the terms are not those of two sectors at {v}")

    def _parallel(self, terms: Terms) -> str:
        (i, j), (k, m) = self._two(terms, -1)
        return f"parallel@{i}-{j},{k}-{m}"

    def _grid(self, terms: Terms) -> str:
        """An edge whose angle is a multiple of pi / parts."""
        require([n for _, n in terms] == [1], "grid: the terms are not one edge")
        [((i, j), _)] = terms
        return f"grid@{i}-{j}"

    def _mirrored(self, terms: Terms) -> str:
        """Two edges that are mirrored in a line whose angle is a multiple of pi / (2 parts)."""
        (i, j), (k, m) = self._two(terms, 1)
        return f"mirrored@{i}-{j},{k}-{m}"

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
        [v] = common
        return v

    @cached_property
    def _folds(self) -> set[Edge]:
        return set(self.sheet.folds)

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


def _signed(terms: Terms) -> Terms:
    """The terms with the sign that makes the first number positive."""
    return terms if terms[0][1] > 0 else [(edge, -n) for edge, n in terms]


def summary(claims: MeantClaims) -> str:
    """One line that states the verified claims."""
    kinds = [entry["kind"] for entry in claims["relations"]]
    each = ", ".join(f"{kinds.count(kind)} {kind}" for kind in dict.fromkeys(kinds))
    within = rounded(parse_rational(claims["within"]), 3, up=True)
    return (
        f"VALID: within {within} of the size of the drawing {claims['drawn']} there is a sheet "
        f"with the same {counted(claims['panels'], 'panel', 'panels')} and with "
        f"{counted(len(kinds), 'exact relation', 'exact relations')} of angles"
        f"{f' ({each})' if kinds else ''}; sha256 {claims['sha256']}"
    )


MEANT = DocumentKind(
    format="exactfold meant sheet",
    versions=(1,),
    names="format version drawn pattern claims",
    claims=MeantClaims,
    check=check,
    summary=summary,
)
"""An exact sheet near a drawing, with exact relations of angles (docs/certificate.md)."""
