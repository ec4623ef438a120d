"""Finds the cell of a periodic sheet in a sheet whose border matches itself."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from math import floor

from exactfold.errors import NotApplicableError, NotPeriodicError, UsageError
from exactfold.exact.numbers import format_rational
from exactfold.exact.surds import rational
from exactfold.pattern.crease_pattern import CreasePattern, Edge, Point
from exactfold.pattern.panel_pattern import PanelPattern
from exactfold.pattern.periodic.cells import Corner, Side
from exactfold.pattern.periodic.periodic_pattern import PeriodicPattern
from exactfold.pattern.triangulating.panels import triangles_by_face

MOST_CELLS = 40
"""How often a sheet may repeat in one direction for `repeated` to notice it."""
MOST_SIDES = 1000
"""Longest border, in edges, that is searched for matching parts: the work grows with its square."""


def drawn_cell(
    sheet: CreasePattern | PanelPattern, cells: tuple[int, int] = (1, 1)
) -> PeriodicPattern:
    """The periodic sheet of which a sheet shows one cell, or I times J, for `cells` = (I, J).

    A polygon tiles the plane by translations exactly if its border is made of parts A, B, C, A', B'
    and C' in this order, where A' is A, moved and passed backwards, and C may be missing (D.
    Beauquier and M. Nivat, "On translating one polyomino to tile the plane", 1991; a convex polygon
    is a parallelogram or a centrally symmetric hexagon). The translations from A to A' and from B
    to B' span the lattice. If there are several such partitions, one without C comes first. The
    first lattice vector is the one that is closer to the x axis, and points to the right. I and J
    divide it and the second one.

    The edges of the border are creases of the periodic sheet. Panels with more than three corners
    are cut into triangles, along the diagonals of `triangulating_edges`, which are the `diagonals`
    of the result.

    Raises `NotPeriodicError` if the border has no such parts, or if the sheet does not repeat I
    times J times; `NotApplicableError` for irrational coordinates, a hole, or over `MOST_SIDES`
    edges in the border; `UsageError` if I or J is below 1.

    >>> import exactfold
    >>> drawn_cell(exactfold.read("two-vertex").sheet)
    <PeriodicPattern: 3 vertices in the cell>
    >>> drawn_cell(exactfold.read("map-fold").sheet, (4, 2)).lattice[1]
    (Fraction(0, 1), Fraction(180147, 250))
    """
    if min(cells) < 1:
        raise UsageError(f"{cells[0]},{cells[1]} cells: both numbers are at least 1")
    points, panels, whole = _glued(sheet)
    first, second, corners, kept = _corners(points, whole, cells)
    chosen = _classes(panels, corners)
    if len(chosen) * cells[0] * cells[1] != len(panels):
        raise NotPeriodicError(
            f"the sheet does not repeat {cells[0]}-fold along {_shown(whole[0])} and "
            f"{cells[1]}-fold along {_shown(whole[1])}: of its {len(panels)} panels, "
            f"{len(chosen)} differ in more than such a translation"
        )
    cut = triangles_by_face(sheet)
    faces: list[tuple[Corner, ...]] = []
    diagonals: list[Side] = []
    for k in chosen.values():
        rim = set(pairwise((*panels[k], panels[k][0])))
        for triangle in cut[k]:
            faces.append(tuple(corners[v] for v in triangle))
            for u, v in pairwise((*triangle, triangle[0])):
                if (u, v) not in rim:
                    (a, i, j), (b, n, m) = corners[u], corners[v]
                    diagonals.append((a, b, n - i, m - j))
    return PeriodicPattern((first, second), kept, faces, diagonals)


def drawn_letters(
    sheet: CreasePattern | PanelPattern,
    letters: Mapping[Edge, str],
    cells: tuple[int, int] = (1, 1),
) -> dict[Side, str]:
    """The letters of the edges of the cell that a sheet shows, from those of the sheet's folds.

    Edges of which no translate has M, V or F, such as those on the border, are left out. Raises
    `NotPeriodicError` if the letters differ between translates, and the errors of `drawn_cell`.

    >>> import exactfold
    >>> grid = exactfold.read("map-fold").sheet
    >>> drawn_letters(grid, {(9, 10): "V"}, (4, 2))
    {(0, 0, 1, 0): 'V'}
    """
    points, _, whole = _glued(sheet)
    *_, corners, _ = _corners(points, whole, cells)
    found: dict[Side, str] = {}
    for edge, letter in letters.items():
        if letter == "U":
            continue
        (a, i, j), (b, n, m) = (corners[v] for v in edge)
        side = min(
            (a, b, n - i, m - j), (b, a, i - n, j - m), key=lambda s: (s[:2], s[2:] < (0, 0))
        )
        if found.setdefault(side, letter) != letter:
            raise NotPeriodicError(
                f"the letters do not repeat: fold {edge[0]}-{edge[1]} is {letter}, and a translate "
                f"of it is {found[side]}: take a larger cell"
            )
    return found


def other_lattices(sheet: CreasePattern | PanelPattern) -> list[tuple[Point, Point]]:
    """Other lattices that carry the border of a sheet to itself than that of `drawn_cell`.

    Raises the errors of `drawn_cell`.

    >>> import exactfold
    >>> other_lattices(exactfold.read("two-vertex").sheet)
    []
    """
    points = _rational(sheet)
    border = _border(sheet.triangles if isinstance(sheet, CreasePattern) else sheet.faces)
    places = [points[v] for v in border]
    first, *others = dict.fromkeys(map(_reduced, _lattices(places)))
    return [lattice for lattice in others if lattice != first]


def repeated(sheet: CreasePattern | PanelPattern) -> tuple[int, int]:
    """How often a sheet that is a cell repeats in it, along the two lattice vectors.

    These are the largest `cells` that `drawn_cell` takes. Raises the errors of `drawn_cell`.

    >>> import exactfold
    >>> repeated(exactfold.read("miura").sheet)
    (4, 2)
    """
    points, panels, whole = _glued(sheet)
    count, most = len(panels), [1, 1]
    for axis in (0, 1):
        for number in range(2, min(count, MOST_CELLS) + 1):
            cells = (number, 1) if axis == 0 else (1, number)
            if count % number == 0:
                *_, corners, _ = _corners(points, whole, cells)
                if len(_classes(panels, corners)) * number == count:
                    most[axis] = number
    return most[0], most[1]


def _glued(
    sheet: CreasePattern | PanelPattern,
) -> tuple[list[Point], Sequence[Sequence[int]], tuple[Point, Point]]:
    """The vertices and panels of a sheet that is a cell, and the lattice of the periodic sheet."""
    if isinstance(sheet, PanelPattern) and sheet.holes:
        raise NotApplicableError("the sheet has a hole: cells of periodic sheets have none")
    points = _rational(sheet)
    panels = sheet.triangles if isinstance(sheet, CreasePattern) else sheet.faces
    border = _border(panels)
    if len(border) > MOST_SIDES:
        raise NotApplicableError(
            f"the border has {len(border)} edges: for the cell of a periodic sheet, at most "
            f"{MOST_SIDES} are compared with each other"
        )
    return points, panels, _lattice([points[v] for v in border], border)


def _rational(sheet: CreasePattern | PanelPattern) -> list[Point]:
    """The vertices as pairs of rational numbers."""
    if isinstance(sheet, PanelPattern) and sheet.radicands:
        raise NotApplicableError(
            f"the sheet has coordinates in {sheet.field_name}: the cell of a periodic sheet has "
            "rational ones. An affine image that has them folds in as many ways"
        )
    return [(rational(x), rational(y)) for x, y in sheet.vertices]


def _border(panels: Sequence[Sequence[int]]) -> list[int]:
    """The vertices of the border, counter-clockwise."""
    sides = {side for panel in panels for side in pairwise((*panel, panel[0]))}
    after = {i: j for i, j in sides if (j, i) not in sides}
    border = [min(after)]
    while (following := after[border[-1]]) != border[0]:
        border.append(following)
    return border


def _lattice(border: Sequence[Point], names: Sequence[int]) -> tuple[Point, Point]:
    """Two translations that carry parts of the border to each other."""
    found = next(_lattices(border), None)
    if found is None:
        raise NotPeriodicError(_unmatched(border, names))
    return found


def _lattices(border: Sequence[Point]) -> Iterator[tuple[Point, Point]]:
    """Two such translations for each partition of the border."""
    count = len(border)
    half, odd = divmod(count, 2)
    for start, one, other in () if odd else _partitions(_steps(border), half):
        vectors = []
        for k, length in ((start, one), (start + one, other)):
            (x, y), (u, v) = border[k % count], border[(k + half + length) % count]
            vectors.append((u - x, v - y))
        first, second = sorted(vectors, key=lambda v: v[1] ** 2 / (v[0] ** 2 + v[1] ** 2))
        if first[0] < 0 or (first[0] == 0 and first[1] < 0):
            first = (-first[0], -first[1])
        if first[0] * second[1] < first[1] * second[0]:
            second = (-second[0], -second[1])
        yield first, second


def _reduced(lattice: tuple[Point, Point]) -> tuple[Point, Point]:
    """A basis of a lattice that is the same for all its bases: Hermite's normal form."""
    (ax, ay), (bx, by) = lattice
    while ay:  # Euclid's algorithm on the second coordinates
        times = floor(by / ay)
        (ax, ay), (bx, by) = (bx - times * ax, by - times * ay), (ax, ay)
    ax = abs(ax)
    if by < 0:
        bx, by = -bx, -by
    return (ax, ay), (bx - floor(bx / ax) * ax, by)


def _steps(border: Sequence[Point]) -> list[Point]:
    """The edges of the border as vectors."""
    return [(u - x, v - y) for (x, y), (u, v) in pairwise((*border, border[0]))]


def _partitions(steps: Sequence[Point], half: int) -> Iterator[tuple[int, int, int]]:
    """Where A begins, and the lengths of A and B, for each partition; first those without C.

    The n edges from s match those from s + half, passed backwards, if the edges s + i and
    s + half + n - 1 - i are opposite vectors for each i < n: the outermost two pairs are compared,
    and the inner edges are a shorter part.
    """
    count = len(steps)
    known: dict[Point, int] = {}
    kind = [known.setdefault(step, len(known)) for step in steps]
    opposite = [known.get((-x, -y), -1) for x, y in steps]
    matches = [[True] * (half + 1) for _ in range(count)]
    for length in range(1, half + 1):
        for s in range(count):
            last = (s + half + length - 1) % count
            inner = length < 3 or matches[(s + 1) % count][length - 2]
            matches[s][length] = (
                inner
                and opposite[s] == kind[last]
                and opposite[(s + length - 1) % count] == kind[(s + half) % count]
            )
    for without in (True, False):
        for s in range(half):
            for one in range(1, half):
                if not matches[s][one]:
                    continue
                for other in range(1, half - one + 1):
                    rest = half - one - other
                    if (rest == 0) is without and (
                        matches[(s + one) % count][other]
                        and matches[(s + one + other) % count][rest]
                    ):
                        yield s, one, other


def _unmatched(border: Sequence[Point], names: Sequence[int]) -> str:
    """Why the border does not match itself; for a parallelogram, the vertex without a partner."""
    remedy = (
        "draw one cell, or whole cells, so that opposite sides have vertices at the same places"
    )
    steps = _steps(border)
    turns = [
        k
        for k in range(len(border))
        if steps[k - 1][0] * steps[k][1] != steps[k - 1][1] * steps[k][0]
    ]
    if len(turns) == 4:
        a, b, c, d = (border[k] for k in turns)
        if (b[0] - a[0], b[1] - a[1]) == (c[0] - d[0], c[1] - d[1]):
            places = set(border)
            moves = ((b[0] - a[0], b[1] - a[1]), (d[0] - a[0], d[1] - a[1]))
            for v, (x, y) in zip(names, border, strict=True):
                if not any((x + s * p, y + s * q) in places for p, q in moves for s in (1, -1)):
                    return (
                        f"vertex {v} at ({format_rational(x)}, {format_rational(y)}) on the border "
                        f"has no vertex opposite it: {remedy}"
                    )
    return f"no two translations carry the border of the sheet to itself: {remedy}"


def _corners(
    points: Sequence[Point], whole: tuple[Point, Point], cells: tuple[int, int]
) -> tuple[Point, Point, list[Corner], list[Point]]:
    """The lattice of the cells, each vertex as a corner (v, i, j), and the points v.

    The points lie in the cell that begins at vertex 0.
    """
    (ax, ay), (bx, by) = ((x / n, y / n) for (x, y), n in zip(whole, cells, strict=True))
    area = ax * by - ay * bx
    (x0, y0) = points[0]
    classes: dict[Point, int] = {}
    kept: list[Point] = []
    corners: list[Corner] = []
    for x, y in points:
        along = ((x - x0) * by - (y - y0) * bx) / area
        across = (ax * (y - y0) - ay * (x - x0)) / area
        i, j = floor(along), floor(across)
        place = (along - i, across - j)
        if place not in classes:
            classes[place] = len(kept)
            kept.append((x - i * ax - j * bx, y - i * ay - j * by))
        corners.append((classes[place], i, j))
    return (ax, ay), (bx, by), corners, kept


def _classes(
    panels: Sequence[Sequence[int]], corners: Sequence[Corner]
) -> dict[tuple[Corner, ...], int]:
    """One panel of each class of translates."""
    return {_moved_to_cell([corners[v] for v in panel]): k for k, panel in enumerate(panels)}


def _moved_to_cell(panel: Sequence[Corner]) -> tuple[Corner, ...]:
    """The translate of a panel that starts at its least corner, which is not moved."""
    turned = min(tuple(panel[k:]) + tuple(panel[:k]) for k in range(len(panel)))
    _, i, j = turned[0]
    return tuple((v, p - i, q - j) for v, p, q in turned)


def _shown(vector: Point) -> str:
    return f"({format_rational(vector[0])}, {format_rational(vector[1])})"
