"""What `exactfold info` and `exactfold examples` print."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import TYPE_CHECKING

from rich.console import Group
from rich.table import Table
from rich.text import Text

from exactfold._support.plurals import counted
from exactfold.app.report.terminal import facts_table
from exactfold.exact.numbers import decimal_near, format_rational, parse_rational
from exactfold.pattern.data import CELLS

if TYPE_CHECKING:
    from exactfold.branches.counting.motion_facts import PanelFacts
    from exactfold.design.panels.vertex.vertices import Vertices
    from exactfold.rigidity.facts import PatternFacts

DIGITS = 6
"""Numbers that need not be exact have this many significant digits."""

LISTED = 8
"""A list in the table of `exactfold info` has at most this many entries."""


def info_report(
    facts: PatternFacts,
    found: Vertices,
    motions: PanelFacts | None = None,
    *,
    exact: bool = False,
) -> Table:
    """The table; with `exact` also ranks, stresses, forms, the digest and the exact area.

    `motions` are given if `count` decomposes the motions of the sheet.
    """
    pattern = facts.pattern
    rows = [
        *_digits(found),
        ("vertices", f"{pattern.Vi} interior, {pattern.Ve} boundary"),
        (
            "faces, edges, folds",
            f"{len(pattern.triangles)}, {len(pattern.edges)}, {len(pattern.folds)}",
        ),
        ("degrees of freedom", f"D = Ve - 3 = {pattern.degrees_of_freedom}"),
        ("boundary", "convex" if pattern.is_convex else f"reflex at {pattern.reflex_corner}"),
        ("area", _number(pattern.area, exact)),
        (
            "interior degrees",
            ", ".join(f"{n} of degree {d}" for d, n in facts.degree_counts.items()) or "none",
        ),
        (
            "triangles that stay flat",
            _listed(
                [
                    f"{corners} around {_listed(list(map(str, inside)), ', ')}"
                    for corners, inside in pattern.triangulated_triangles
                ]
            ),
        ),
        ("folds that split the sheet", _listed([f"{i}-{j}" for i, j in pattern.chords], ", ")),
    ]
    rows += [] if motions is None else _motion_rows(motions)
    rows += _vertex_rows(found)
    rows += [("expected", expectation(facts, motions))]
    if exact:
        rank = f"{facts.rigidity_rank}, by {facts.rank_by}"
        if facts.rank_by == "theorem":
            rank += " (2V - 3 for every triangulated disk)"
        inertias = _listed([f"{v}: {i}" for v, i in facts.inertias.items()])
        rows += [
            ("rank of rigidity matrix", rank),
            ("self stresses", str(facts.self_stresses)),
            ("inertia of curvature forms", inertias),
            ("sha256", pattern.sha256),
        ]
    return facts_table(list(rows))


def panels_info(facts: PanelFacts, found: Vertices, *, exact: bool = False) -> Table:
    """The table of a sheet of rigid panels; with `exact` also the digest."""
    pattern = facts.pattern
    degrees = ", ".join(f"{n} of degree {d}" for d, n in facts.degree_counts.items())
    rows = [
        *_digits(found),
        ("vertices", f"{len(pattern.interior)} interior, {len(pattern.boundary_set)} boundary"),
        (
            "panels, edges, folds",
            f"{len(pattern.faces)}, {len(pattern.edges)}, {len(pattern.folds)}",
        ),
        *([("holes", str(len(pattern.holes)))] if pattern.holes else []),
        (
            f"folds - 3 interior vertices{' - 6 holes' if pattern.holes else ''}",
            f"D = {pattern.D}",
        ),
        ("coordinates", f"in {pattern.field_name}"),
        ("interior degrees", degrees or "none"),
        *_motion_rows(facts),
        *_vertex_rows(found),
        ("expected", facts.expected),
    ]
    return facts_table([*rows, ("sha256", pattern.sha256)] if exact else list(rows))


def _digits(found: Vertices) -> list[tuple[str, str]]:
    """The row that says so if the facts hold for the digits as written only."""
    if found.meant is None or not found.meant.doubt:
        return []
    return [("these facts", f"hold for the digits as written: {found.meant.doubt}")]


def _motion_rows(facts: PanelFacts) -> list[tuple[str, str]]:
    parts = [
        f"{counted(len(part), 'vertex')} round vertex {part[0]}"
        if len(part) > 1
        else f"vertex {part[0]}"
        for part in facts.parts
    ]
    return [
        ("folds that stay flat", _listed([f"{i}-{j}" for i, j in facts.flat], ", ")),
        ("folds from boundary to boundary", _listed([f"{i}-{j}" for i, j in facts.free], ", ")),
        ("parts that move independently", _listed(parts)),
    ]


def _vertex_rows(found: Vertices) -> list[tuple[str, str]]:
    """What is known of the vertices, each by itself; `exactfold vertices` says more."""
    if not found.facts:
        return []
    rows = [("each vertex by itself", f"{found.headline} - {str(found.starts).upper()}")]
    if found.summary["kawasaki"] or {"M", "V"} & set(found.letters.values()):
        rows.append(("folding flat", found.flat_line))
    return rows


def _number(value: Fraction, exact: bool) -> str:
    """The number itself; if it is long and need not be exact, a decimal near it."""
    text = format_rational(value)
    if exact or len(text) <= DIGITS + 1:
        return text
    near = decimal_near(value, DIGITS)
    return near if parse_rational(near) == value else f"about {near}"


def _listed(entries: list[str], separator: str = "; ") -> str:
    rest = len(entries) - LISTED
    more = [f"... and {rest} more (--json lists all)"] if rest > 0 else []
    return separator.join(entries[:LISTED] + more) or "none"


def expectation(facts: PatternFacts, motions: PanelFacts | None = None) -> str:
    """What `count` will find, from the numbers of vertices, and from `motions` if these
    are given.
    """
    pattern = facts.pattern
    free = pattern.Vi - pattern.Vt
    if motions is not None:
        if not (pattern.is_convex and pattern.interior):
            return motions.expected
        return (
            f"2^{free} graphs over the boundary heights, of dimension "
            f"{pattern.degrees_of_freedom}, and "
            f"how they are joined; as panels: {motions.expected}"
        )
    if pattern.degrees_of_freedom == 0:
        return "rigid: 0 ways to start folding"
    if pattern.degrees_of_freedom == 1:
        ways = f"2^{free} ways to start folding, fewer if a vertex is flat on some of them"
        return ways if free == pattern.Vi else f"{ways}; with multiplicity 2^{pattern.Vi}"
    dimension = pattern.degrees_of_freedom
    return f"one family of ways to start folding, of dimension {dimension} (single vertex)"


def examples_report(examples: Mapping[str, str]) -> Group:
    """The shipped patterns, and how their names are used."""
    table = Table(box=None, show_header=False, pad_edge=False)
    table.add_column(style="bold", no_wrap=True)
    table.add_column()
    for name, text in examples.items():
        table.add_row(name, text)
    use = "A name stands for the file in every command: exactfold count two-vertex"
    cells = (
        f"Cells of tessellations: {', '.join(CELLS)}: exactfold count {CELLS[0]} --direction 1,2"
    )
    return Group(table, "", Text(use), Text(cells))
