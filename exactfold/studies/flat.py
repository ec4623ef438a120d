"""How often a random square is an exception: a vertex outside triangulated triangles can stay flat.

For almost all positions of the vertices this does not happen (docs/generic.md, Theorem 11). On a
grid of multiples of 1/denominator some squares are exceptions. A row is one random square on one
grid. For some squares a bound is computed of the distance to the nearest exception
(`exactfold.studies.nearest`).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from math import ceil
from typing import Any, Final

import networkx as nx
import numpy as np

from exactfold._support.verdict import PROVED
from exactfold.branches.counting.collect import count_branches
from exactfold.interop.graphs import to_networkx
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.families import collinear_folds
from exactfold.studies.nearest import nearest_exception
from exactfold.studies.running.lines import Lines, SignArray
from exactfold.studies.running.squares import square_of, square_recipes
from exactfold.studies.running.statistics import interval_text
from exactfold.studies.running.study import Recipe, Row, Study, StudyFigure, StudyTable, of_size
from exactfold.studies.running.tallies import draw_distributions, draw_rare, tallied

DENOMINATORS: Final = (16, 64, 256, 1024)
"""The denominators of the grids."""

MEASURED: Final = 5
"""For one of so many squares on the finest grid the nearest exception is looked for."""


def recipes(seed: int, numbers: Mapping[int, int]) -> Iterator[Recipe]:
    """Yields random squares in their order, on each grid in turn.

    >>> [(r["seed"], r["denominator"], r["measured"]) for r in recipes(0, {2: 5})][3:]
    [(20000003, 1024, 1), (20000004, 16, 0)]
    """
    grids = len(DENOMINATORS)
    for size, number in numbers.items():
        for place, recipe in enumerate(square_recipes(seed, {size: number})):
            turn, grid = divmod(place, grids)
            measured = int(grid == grids - 1 and not turn % MEASURED)
            yield {**recipe, "denominator": DENOMINATORS[grid], "measured": measured}


def row(recipe: Recipe) -> dict[str, Any]:
    """Whether a branch of one random square has flat vertices outside triangulated triangles.

    `flat` lists each connected set of such vertices once, as the list of their degrees: [[4]] is
    one vertex of degree four. Folds inside triangulated triangles do not count. `straight` says
    whether two folds continue each other at some interior vertex. `path` says whether folds make a
    straight path between two boundary vertices. For a measured square, `distance` is a bound of the
    distance to an exception, in sides of the square, with six digits; it is 0 if the square is one.
    `distance_straight` says whether that exception may have straight folds. Both are None if no
    exception was found.
    """
    pattern = square_of(recipe)
    lines = Lines.of(pattern)
    proved = lines.status is PROVED
    values: dict[str, Any] = {
        "status": str(lines.status),
        "distinct": lines.distinct,
        "flat": clusters(pattern, lines.signs) if proved else None,
        "straight": has_straight_folds(pattern),
        "path": has_straight_path(pattern),
        "distance": None,
        "distance_straight": None,
    }
    if recipe["measured"] and proved:
        if values["flat"]:
            values["distance"], values["distance_straight"] = 0.0, values["straight"]
        elif near := nearest_exception(count_branches(pattern.without_rigid_parts()[0])):
            values["distance"] = float(f"{near.distance * (1 + 1e-5):.5e}")
            values["distance_straight"] = near.straight
    return values


def has_straight_folds(pattern: CreasePattern) -> bool:
    """Whether two folds outside triangulated triangles continue each other at an interior vertex.

    >>> from exactfold.pattern.families import flat_vertex_square, two_vertex
    >>> has_straight_folds(flat_vertex_square()), has_straight_folds(two_vertex())
    (True, False)
    """
    return bool(collinear_folds(pattern.without_rigid_parts()[0]))


def has_straight_path(pattern: CreasePattern) -> bool:
    """Whether folds outside triangulated triangles make a straight path between boundary vertices.

    The sheet that is folded along this path alone is a branch; all vertices off the path are flat.

    >>> from exactfold.pattern.families import flat_vertex_square, two_vertex
    >>> has_straight_path(flat_vertex_square()), has_straight_path(two_vertex())
    (True, False)
    """
    reduced = pattern.without_rigid_parts()[0]
    boundary = set(reduced.boundary)
    after = {
        way for i, v, j in collinear_folds(reduced) for way in (((i, v), (v, j)), ((j, v), (v, i)))
    }
    steps = nx.DiGraph(after)
    return any(
        last[1] in boundary
        for first in steps
        if first[0] in boundary
        for last in nx.descendants(steps, first)
    )


def clusters(pattern: CreasePattern, signs: SignArray) -> list[list[int]]:
    """The connected sets of flat vertices, each as the degrees of its vertices.

    >>> from exactfold.pattern.families import flat_vertex_square
    >>> clusters(flat_vertex_square(), np.array([[1, 1], [-1, 1], [1, 0]], np.int8))
    [[4]]
    """
    rigid = np.array([v in pattern.rigid_vertices for v in pattern.interior], dtype=bool)
    parts: set[frozenset[int]] = set()
    for flat in np.unique((signs == 0) & ~rigid, axis=0).tolist():
        vertices = [v for v, is_flat in zip(pattern.interior, flat, strict=True) if is_flat]
        graph = to_networkx(pattern).subgraph(vertices)
        parts |= {frozenset(part) for part in nx.connected_components(graph)}
    reduced, labels = pattern.without_rigid_parts()
    degrees = {v: reduced.degree(k) for k, v in enumerate(labels)}
    return sorted(sorted(degrees[v] for v in part) for part in parts)


@dataclass
class _FlatTally:
    """The sums over the rows of one number of vertices and one grid."""

    squares: int = 0
    undecided: int = 0
    exceptions: int = 0
    straight: int = 0
    exceptions_straight: int = 0
    paths: int = 0
    exceptions_path: int = 0
    measured: int = 0
    distances: list[float] = field(default_factory=list)
    free: list[float] = field(default_factory=list)
    causes: Counter[str] = field(default_factory=Counter)
    first: int | None = None

    def add(self, row: Row) -> None:
        """Adds a row."""
        self.squares += 1
        if row["status"] != str(PROVED):
            self.undecided += 1
            return
        self.straight += row["straight"]
        self.paths += row["path"]
        self.measured += row["measured"]
        if row["distance"] is not None:
            self.distances.append(row["distance"])
            if not row["distance_straight"]:
                self.free.append(row["distance"])
        if row["flat"]:
            self.exceptions += 1
            self.exceptions_straight += row["straight"]
            self.exceptions_path += row["path"]
            self.causes.update("+".join(map(str, part)) for part in row["flat"])
            seed = row["seed"]
            self.first = seed if self.first is None else min(self.first, seed)

    @property
    def proved(self) -> int:
        """The number of squares whose branches are proved."""
        return self.squares - self.undecided


def _key(row: Row) -> tuple[int, int]:
    return row["interior"], row["denominator"]


def tables(rows: Iterable[Row]) -> list[StudyTable]:
    """How many squares are exceptions, by grid, and which stars are flat on them."""
    tallies = tallied(rows, _FlatTally, _key)
    lines = tuple(
        (
            n,
            d,
            t.squares,
            t.proved,
            t.exceptions,
            interval_text(t.exceptions, t.proved),
            t.first,
        )
        for (n, d), t in tallies.items()
    )
    causes: Counter[str] = Counter()
    for tally in tallies.values():
        causes.update(tally.causes)
    return [
        StudyTable(
            "exceptions",
            "Squares on which a vertex outside triangulated triangles can stay flat",
            (
                "Vi",
                "grid",
                "squares",
                "proved",
                "exceptions",
                "interval, %",
                "first seed",
            ),
            lines,
            (
                "grid d: coordinates are multiples of 1/d; for almost all positions there are no "
                "exceptions. Exact 95 % intervals.",
            ),
        ),
        StudyTable(
            "straight",
            "Squares with straight folds, and the exceptions among them",
            ("grid", "squares", "exceptions", "paths", "exceptions", "straight", "exceptions"),
            tuple(
                (
                    d,
                    sum(t.proved for t in on_grid),
                    sum(t.exceptions for t in on_grid),
                    sum(t.paths for t in on_grid),
                    sum(t.exceptions_path for t in on_grid),
                    sum(t.straight for t in on_grid),
                    sum(t.exceptions_straight for t in on_grid),
                )
                for d in sorted({d for _, d in tallies})
                for on_grid in [[t for (_, e), t in tallies.items() if e == d]]
            ),
            (
                "paths: with folds that make a straight path from corner to corner; straight: with "
                "two folds that continue each other at an interior vertex, outside triangulated "
                "triangles. After each of these stands how many of them are exceptions.",
            ),
        ),
        StudyTable(
            "stars",
            "Which stars are flat",
            ("degrees", "number"),
            tuple(
                (f"degree {name}", number)
                for name, number in sorted(causes.items(), key=lambda item: (-item[1], item[0]))
            ),
            ("degree 4+5: two vertices joined by a fold, with four and five folds.",),
        ),
        *_distances(tallies),
    ]


def _distances(tallies: dict[tuple[int, int], _FlatTally]) -> list[StudyTable]:
    lines = tuple(
        (
            n,
            t.measured,
            len(t.distances),
            *(_quantile(t.distances, part) for part in (0, 0.25, 0.5, 0.75)),
            len(t.free),
            _quantile(t.free, 0),
        )
        for (n, _), t in tallies.items()
        if t.measured
    )
    if not lines:
        return []
    return [
        StudyTable(
            "distances",
            "How far the nearest exception is at most, in sides of the square",
            (
                "Vi",
                "squares",
                "found",
                "least",
                "quarter",
                "half",
                "3 quarters",
                "not straight",
                "least",
            ),
            lines,
            (
                "The distance is the root of the sum of the squared displacements of all "
                "vertices. Bounds are proved, and rounded; nearer exceptions are not excluded. "
                "quarter, half, 3 quarters: of the squares for which one was found. not straight: "
                "the exception is proved to have no two folds that continue each other.",
            ),
        )
    ]


def _quantile(values: Sequence[float], part: float) -> str | None:
    """The least value with at least this share of all values up to it; None if there are none."""
    if not values:
        return None
    return f"{sorted(values)[max(0, ceil(part * len(values)) - 1)]:.2g}"


def figures(rows: Iterable[Row]) -> Sequence[StudyFigure]:
    """The share of exceptions by grid, and the distances to the nearest ones."""
    tallies = {key: t for key, t in tallied(rows, _FlatTally, _key).items() if t.proved}
    if not tallies:
        return []
    near = {n: [d for d in t.distances if d] for (n, _), t in tallies.items() if any(t.distances)}

    def distances(axes: Any) -> None:
        draw_distributions(axes, near)
        axes.set_xscale("log")
        axes.set_xlabel("distance of the exception, in sides of the square")
        axes.set_ylabel("squares with a nearer one (%)")

    def shares(axes: Any) -> None:
        sizes = sorted({n for n, _ in tallies})
        for place, n in enumerate(sizes):
            points = [(d, t) for (m, d), t in tallies.items() if m == n]
            counts = [(t.exceptions, t.proved) for _, t in points]
            places = [d * 2 ** (0.12 * (place - (len(sizes) - 1) / 2)) for d, _ in points]
            draw_rare(axes, places, counts, label=f"$V_i = {n}$", **of_size(n))
        axes.set_xscale("log", base=2)
        axes.set_yscale("log")
        axes.set_xticks(DENOMINATORS, [str(d) for d in DENOMINATORS])
        axes.minorticks_off()
        axes.set_xlabel("denominator of the grid")
        axes.set_ylabel("squares that are exceptions (%)")

    study_figures = [
        StudyFigure(
            "exceptions",
            "Exceptions become rare on fine grids",
            "The figure shows the share of random squares with a vertex outside triangulated "
            "triangles that can stay flat, with exact 95 % intervals. If no square is an "
            "exception, an open triangle shows the upper end of the interval.",
            shares,
        )
    ]
    if near:
        study_figures.append(
            StudyFigure(
                "distances",
                "How far the nearest exception is at most",
                "The figure shows for which share of random squares an exception is proved to lie "
                "within this distance, among squares that are not exceptions and have one found.",
                distances,
            )
        )
    return study_figures


STUDY: Final = Study(
    "flat",
    "How often a random square has a multiple branch, by the grid of its coordinates",
    2,
    dict.fromkeys(range(2, 7), 40_000),
    {7: 40_000, 8: 40_000},
    recipes,
    row,
    tables,
    figures,
)
