"""What `exactfold motions` prints."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from typing import TYPE_CHECKING

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from exactfold._support.plurals import counted
from exactfold.app.report.terminal import facts_table, status_text

if TYPE_CHECKING:
    from exactfold.motion.loops.matching import Loops
    from exactfold.motion.loops.proofs import Loop
    from exactfold.motion.loops.rays import Ray

_LISTED = 40
_REASONS = 10


def motions_report(loops: Loops) -> Group:
    """The matching of the rays, loop by loop."""
    rays = 2 ** (len(loops.pattern.foldable_vertices) + 1)
    matched = f"{len(loops.matching)} of {counted(rays, 'ray')}"
    rows: list[tuple[str, RenderableType]] = [
        ("matched", Text.assemble(matched, ", ", status_text(loops.status))),
    ]
    if loops.reason:
        rows.append(("left", loops.reason))
    rows += _graph(loops)
    return Group(facts_table(rows), Text(""), _table(loops.loops), *_notes(loops))


def _graph(loops: Loops) -> list[tuple[str, RenderableType]]:
    """What can be reached from the flat state, in one or two lines."""
    graph = loops.graph
    arcs = counted(len(graph.arcs), "arc")
    nodes = counted(len(graph.nodes), "branch point") if graph.nodes else "no branch points"
    parts: list[str | Text] = [f"the flat state, {nodes}, {arcs}, ", status_text(graph.status)]
    if graph.closed_curves:
        curves = counted(len(graph.closed_curves), "closed curve")
        parts.insert(1, f"{curves} beside the loops, ")
    rows: list[tuple[str, RenderableType]] = [("graph", Text.assemble(*parts))]
    if graph.reason != loops.reason:
        rows.append(("", graph.reason))
    return rows


def _table(loops: Iterable[Loop]) -> Table:
    table = Table(box=None, pad_edge=False)
    for name in ("from", "to", "changes", "length", "through flat"):
        table.add_column(name)
    for loop in list(loops)[:_LISTED]:
        low, high = loop.length
        nodes = ", ".join("+".join(map(str, flat)) for flat in loop.through)
        if loop.target is None:
            table.add_row(str(loop.source), "undecided", "", f"{float(low):.6g}...", nodes)
            continue
        changes = _changes(loop.source, loop.target)
        table.add_row(str(loop.source), str(loop.target), changes, _within(low, high), nodes)
    return table


def _changes(source: Ray, target: Ray) -> str:
    """The number of signs that differ, and whether the saddle differs."""
    signs = zip(source.vertex_signs, target.vertex_signs, strict=True)
    number = sum(a != b for a, b in signs)
    parts = [counted(number, "sign")] if number else []
    if source.saddle != target.saddle:
        parts.append("saddle")
    return ", ".join(parts)


def _within(low: Fraction, high: Fraction) -> str:
    """The digits that both bounds of a number have in common."""
    a, b = float(low), float(high)
    for digits in range(12, 0, -1):
        if f"{a:.{digits}g}" == f"{b:.{digits}g}":
            return f"{a:.{digits}g}"
    return f"{a:.3g} to {b:.3g}"


def _notes(loops: Loops) -> list[RenderableType]:
    notes = [
        "",
        "One loop of each pair of mirror images is listed, in one of its two directions; contact "
        "is ignored.",
    ]
    if loops.pattern.reflex_corner is not None:
        notes.append(
            "This sheet has a reflex corner. The sign after 'saddle' is that of vertex "
            f"{loops.pattern.reflex_corner} in the sheet whose notch is closed."
        )
    if len(loops.loops) > _LISTED:
        notes.append(f"{counted(len(loops.loops) - _LISTED, 'more loop')}: --json lists all.")
    reasons = sorted({loop.reason for loop in loops.loops if loop.reason})
    notes += [f"undecided: {reason}" for reason in reasons[:_REASONS]]
    skipped = [f"{signs} is not followed: {why}" for signs, why in loops.skipped.items()]
    notes += skipped[:_REASONS]
    if max(len(reasons), len(skipped)) > _REASONS:
        notes.append("More reasons: --json lists all.")
    return [Text(note) for note in notes]
