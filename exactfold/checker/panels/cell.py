"""Certificates of the periodic motions of a tessellation of rigid panels.

The pattern is a cell (`periodic`) with `diagonals`, the edges inside panels, each from u to v moved
by (i, j). The fold angles repeat in each cell. The plane has no holes, so that the panels close if
they close at each vertex of the cell: these are the conditions of a sheet of panels with the folds
of the cell, and the checker takes nothing else from the file. It finds all components to second
order again, as for one sheet (docs/panels.md, 5), and compares the claims:

- `folds`: the number of folds; `sha256`: the digest of the cell;
- `motions`: for each component its `dimension`; the `sizes` of its parts, which move by themselves;
  the `letters` of the parts with one parameter, on the side where their first fold is a mountain;
  whether it is `planar`, that is, does not roll up (B = 0); the `direction` n across which all its
  motions roll up, or null if it is not one rational direction; and whether all its parts are lines
  that close for tan(fold angle / 2) = T w and every T (`folds`).
"""

from __future__ import annotations

from collections import Counter
from fractions import Fraction
from itertools import pairwise
from typing import Any, TypedDict

from ..core.kinds import DocumentKind
from ..core.reading import (
    counted,
    integer,
    items,
    keys,
    keys_of,
    refusing,
    require,
    same,
)
from ..core.towers import Number, Tower
from ..sheets.cell import Cell, Side, read_cell
from ..sheets.panels import Edge, PanelSheet, Vector, pair
from .leaves import close_always, components
from .motions import Motion, Space, folds_of
from .spaces import Spaces


class CellMotionClaim(TypedDict):
    """A component of the periodic motions to second order."""

    dimension: int
    sizes: list[int]
    letters: list[str]
    planar: bool
    direction: list[int] | None
    folds: bool


class PanelCellClaims(TypedDict):
    """All components of the periodic motions of rigid panels, for all directions together."""

    folds: int
    motions: list[CellMotionClaim]
    sha256: str


class CellSheet(PanelSheet):
    """The folds of a cell as edges of a finite graph.

    A loop is divided into three equal parts, and folds with the same ends into two. The parts are
    straight pairs at their common points, so that they have the same density.
    """

    def __init__(self, cell: Cell, inside: set[Side]) -> None:
        self.tower, self.cell = Tower(), cell
        self.sides = [edge for edge in cell.edges if edge not in inside]
        several = Counter(edge[:2] for edge in self.sides)
        self.path: dict[Side, list[int]] = {}
        number = len(cell.points)
        for edge in self.sides:
            u, v = edge[:2]
            more = 2 if u == v else int(several[u, v] > 1)
            self.path[edge] = [u, *range(number, number + more), v]
            number += more
        self.vectors: dict[Edge, Vector] = {}
        self.around = {v: list[int]() for v in range(number)}
        for edge, path in self.path.items():
            for a, b in pairwise(path):
                x, y = (self.tower.number(c / (len(path) - 1)) for c in self.along(edge))
                self.vectors[a, b], self.vectors[b, a] = (x, y), (-x, -y)
            for a, b, c in zip(path, path[1:], path[2:], strict=False):
                self.around[b] = [a, c]
        for v, turns in cell.next.items():
            start = spoke = min(turns)
            while True:
                u, i, j = spoke
                if (v, u, i, j) in self.path:
                    self.around[v].append(self.path[v, u, i, j][1])
                elif (u, v, -i, -j) in self.path:
                    self.around[v].append(self.path[u, v, -i, -j][-2])
                spoke = turns[spoke]
                if spoke == start:
                    break
        self.interior, self.boundary_set = [*self.around], set[int]()
        nothing = self.tower.number(0)
        self.points = [(nothing, nothing)] * number  # only their number is asked for

    def along(self, edge: Side) -> tuple[Fraction, Fraction]:
        """The vector along a fold."""
        u, v, i, j = edge
        (ax, ay), (bx, by) = self.cell.place((u, 0, 0)), self.cell.place((v, i, j))
        return bx - ax, by - ay

    def vector(self, v: int, u: int) -> Vector:
        """The vector from v to u."""
        return self.vectors[v, u]

    def density(self, edge: Side, motion: Motion) -> Number:
        """The density of a fold in a motion: fold angle / length."""
        path = self.path[edge]
        share = self.tower.number(Fraction(1, len(path) - 1))
        return motion.get(pair(*path[:2]), self.tower.number(0)) * share

    def bends(self, motion: Motion) -> list[Number]:
        """The entries B_11, B_12 and B_22, times the area of the cell: the sum of w d' d'^T.

        d' is the vector d along a fold, turned by a right angle.
        """
        total = [self.tower.number(0)] * 3
        for edge in self.sides:
            x, y = self.along(edge)
            density = self.density(edge, motion)
            total = [
                t + density * self.tower.number(c)
                for t, c in zip(total, (y * y, -x * y, x * x), strict=True)
            ]
        return total


@refusing()
def check(data: dict[str, Any]) -> PanelCellClaims:
    """Verify every claim of a certificate; raises `CertificateError` at the first failure."""
    claims, pattern = data["claims"], data["pattern"]
    keys(claims, keys_of(PanelCellClaims), "claims")
    keys(pattern, "lattice vertices faces diagonals", "pattern")
    cell = read_cell({key: pattern[key] for key in pattern if key != "diagonals"})
    inside = []
    for entry in items(pattern["diagonals"], "diagonals"):
        u, v, i, j = map(integer, items(entry, "a diagonal", 4))
        inside.append((u, v, i, j))
        require(inside[-1] in cell.edges, f"the diagonal {inside[-1]} is no edge")
    sheet = CellSheet(cell, set(inside))
    near = sheet.live(())
    found: list[CellMotionClaim] = []
    if near:
        spaces = Spaces(sheet, near)
        leaves = spaces.leaves()
        for leaf in leaves:
            motion = _motion(spaces, sheet, leaf.basis, leaf.dimension)
            found += [motion] * len(components(spaces, leaf, leaves))
    facts: PanelCellClaims = {
        "folds": len(sheet.sides),
        "motions": sorted(found, key=_in_order),
        "sha256": cell.sha256(),
    }
    given = {**claims, "motions": sorted(items(claims["motions"], "motions"), key=_in_order)}
    for key, fact in facts.items():
        require(same(given[key], fact), f"the claim {key!r} is not what the pattern shows")
    proved: PanelCellClaims = claims
    return proved


def _in_order(motion: Any) -> str:
    """A text to sort motions by, which does not depend on the order of their keys."""
    return str(sorted(motion.items()) if isinstance(motion, dict) else motion)


def _motion(spaces: Spaces, sheet: CellSheet, basis: Space, dimension: int) -> CellMotionClaim:
    """What a file says of a component, or of each of several that span one space."""
    parts = spaces.parts(basis)
    lines = [part[0] for part in parts if len(part) == 1]
    bends = [row for row in map(sheet.bends, basis) if any(x.sign() for x in row)]
    return {
        "dimension": dimension,
        "sizes": sorted(map(len, parts)),
        "letters": sorted(_letters(sheet, line) for line in lines),
        "planar": not bends,
        "direction": _direction(bends),
        "folds": len(lines) == len(parts) and all(_closes(sheet, spaces, x) for x in lines),
    }


def _letters(sheet: CellSheet, motion: Motion) -> str:
    signs = [sheet.density(edge, motion).sign() for edge in sheet.sides]
    first = next(s for s in signs if s)
    return "".join("FMV"[s * first] for s in signs)


def _closes(sheet: CellSheet, spaces: Spaces, motion: Motion) -> bool:
    """Whether all vertices close along a line at all angles."""
    near = sheet.only(spaces.near, set(folds_of([motion])))
    return close_always(Spaces(sheet, near, spaces.work), motion)


def _direction(bends: list[list[Number]]) -> list[int] | None:
    """The direction n if all B are multiples of one n n^T and n is rational; else None.

    It is the shortest vector of integers that points up, or (1, 0).
    """
    if not bends:
        return None
    first = bends[0]
    for row in bends:
        if any((first[i] * row[j] - first[j] * row[i]).sign() for i in range(3) for j in range(i)):
            return None
    one, both, other = first
    if (one * other - both * both).sign():
        return None
    if not other.sign():
        return [1, 0]
    whole, *roots = (both / other).parts
    return None if any(roots) else [whole.numerator, whole.denominator]


def summary(claims: PanelCellClaims) -> str:
    """One line that states the verified claims."""
    planar = sum(motion["planar"] for motion in claims["motions"])
    return (
        f"VALID: {counted(len(claims['motions']), 'component', 'components')} of periodic "
        f"motions of rigid panels to second order, {planar} planar; sha256 {claims['sha256']}"
    )


PANEL_CELL = DocumentKind(
    format="exactfold panel cell certificate",
    versions=(1,),
    names="format version pattern claims",
    claims=PanelCellClaims,
    check=check,
    summary=summary,
)
"""All periodic motions of a tessellation of rigid panels."""
