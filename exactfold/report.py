"""Tables for people: counts, facts and certificates, with rich."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from rich.console import Console, Group, RenderableType
from rich.table import Table
from rich.text import Text

from exactfold.exact.numbers import decimal_above, format_rational
from exactfold.verdict import PROVED, UNDECIDED

if TYPE_CHECKING:
    from exactfold.branches.result import BranchCount
    from exactfold.branches.signed import SignedBranch
    from exactfold.count.stream import StreamedCount
    from exactfold.rigidity.facts import PatternFacts

SHOWN = 32
"""Branches and open questions listed unless all are asked for."""

LISTED = 8
"""Entries of a list in the table of `exactfold info`."""


def _facts_table(rows: list[tuple[str, str]]) -> Table:
    table = Table(box=None, show_header=False, pad_edge=False)
    table.add_column(style="bold")
    table.add_column(overflow="fold")
    for name, value in rows:
        table.add_row(name, value)
    return table


def count_report(
    result: BranchCount,
    certificate: str | None,
    *,
    everything: bool,
    streamed: StreamedCount | None = None,
) -> Group:
    """The summary and the table of branches printed by `exactfold count`."""
    pattern = result.pattern
    rows = [
        (
            "pattern",
            f"{pattern.Vi} interior and {pattern.Ve} boundary vertices, "
            f"{len(pattern.folds)} folds, D = {pattern.degrees_of_freedom}",
        ),
    ]
    if pattern.Vt:
        rows.append(("rigid inside", f"{pattern.Vt} vertices in triangulated triangles stay flat"))
    if result.snapped:
        rows.append(("snapped", f"coordinates moved by up to {decimal_above(result.snapped, 3)}"))
    rows.append(("status", f"{str(result.status).upper()} ({result.reason})"))
    if result.status is PROVED:
        rows += [
            (
                "branches",
                f"{result.distinct} distinct, {result.with_multiplicity} with "
                f"multiplicity; {result.real} real, {result.nonreal} not real",
            ),
            ("true branches", str(result.true_branches)),
        ]
    elif result.degree is not None:
        rows.append(
            (
                "solutions",
                f"a cone of dimension {result.dimension} and degree {result.degree} "
                "(complex, modulo planes, with multiplicity)",
            )
        )
    if result.branches:
        each = sorted(set(result.sign_vectors.values()))
        per = f"{each[0]}" if len(each) == 1 else f"{each[0]} to {each[-1]}"
        rows.append(
            (
                "sign vectors",
                f"{len(result.sign_vectors)} pairs of opposite ones, {per} "
                f"branch{'' if per == '1' else 'es'} each",
            )
        )
        rows.append(
            (
                "shared folds",
                "undecided"
                if result.repeated_assignments is None
                else f"{result.repeated_assignments} branches share their "
                "mountain-valley assignment with another",
            )
        )
    degrees = str(result.settings.get("factor_degrees", ""))
    if degrees:
        several = " " in degrees
        form = "factors of degrees" if several else "irreducible over Q of degree"
        rows.append(("polynomial", f"{form} {degrees}"))
    why = f" ({result.why})" if result.why else ""
    rows.append(("method", f"{result.method}{why}, {result.seconds:.2f} s"))
    if streamed is not None:
        rows += _stream_rows(streamed)
    if certificate:
        rows.append(("certificate", certificate))
    parts: list[Any] = [_facts_table(rows)]
    if result.branches:
        parts += ["", *_branch_table(result, everything)]
    if result.open_questions:
        limit = len(result.open_questions) if everything else SHOWN
        parts += ["", Text("Open", style="bold")]
        parts += [Text(f"- {question}") for question in result.open_questions[:limit]]
        parts += _more(len(result.open_questions) - limit)
    return Group(*parts)


def _stream_rows(streamed: StreamedCount) -> list[tuple[str, str]]:
    rows = [("streamed to", streamed.path)]
    if streamed.resumed:
        rows.append(("resumed", f"{streamed.resumed} of {streamed.blocks} blocks were there"))
    if streamed.unproved:
        rows.append(("open there", f"{streamed.unproved} of {1 << streamed.foldable} sign vectors"))
    for limit, group in list(streamed.groups.items())[:SHOWN]:
        signs = ", ".join(root.signs for root in group[:8]) + (", ..." if len(group) > 8 else "")
        rows.append(("seem to meet", f"{signs} at {limit}"))
    return rows


def _branch_table(result: BranchCount, everything: bool) -> list[Any]:
    limit = len(result.branches) if everything else SHOWN
    table = Table(box=None, pad_edge=False)
    table.add_column("vertex signs", no_wrap=True)
    table.add_column("mountain-valley", overflow="fold")
    table.add_column("multiplicity", justify="right")
    for branch in result.branches[:limit]:
        table.add_row(branch.sign_text, branch.assignment_text, str(branch.multiplicity))
    return [table, *_more(len(result.branches) - limit)]


def _more(count: int) -> list[Text]:
    return [Text(f"... and {count} more (--all shows them)")] if count > 0 else []


def branch_report(result: SignedBranch) -> Group:
    """What `exactfold branch` prints for one branch."""
    pattern = result.pattern
    rows = [
        ("pattern", f"{pattern.Vi} interior and {pattern.Ve} boundary vertices"),
        ("status", f"{str(result.status).upper()} ({result.reason})"),
        ("vertex signs", _cut(result.sign_text)),
    ]
    if result.radius is not None:
        rows.append(("mountain-valley", _cut(result.assignment_text)))
        undecided = len(result.undecided_folds)
        decided = f"{len(result.assignment) - undecided} of {len(result.assignment)} folds"
        rows.append(("letters decided", decided))
        rows.append(
            ("heights", f"each within {decimal_above(result.radius, 2)} (--json lists them)")
        )
    rows.append(("method", f"{result.steps} Newton steps, {result.seconds:.2f} s"))
    return Group(_facts_table(rows))


BatchRow = tuple[str, str, int | None, str]
"""Name, status, number of branches, and what is missing or wrong."""


def batch_report(rows: list[BatchRow], summary: Mapping[str, Any], everything: bool) -> Group:
    """What `exactfold count` prints for several patterns."""
    table = Table(box=None, pad_edge=False)
    table.add_column("", overflow="fold")
    table.add_column("ways", justify="right")
    table.add_column("status")
    table.add_column("", overflow="fold")
    limit = len(rows) if everything else SHOWN
    for name, status, distinct, message in rows[:limit]:
        why = "" if status == str(PROVED) else message
        table.add_row(name, "?" if distinct is None else str(distinct), status, why)
    parts: list[Any] = [table, *_more(len(rows) - limit), ""] if rows else []
    counts = ", ".join(f"{summary[key]} {key}" for key in ("proved", "undecided", "failed"))
    text = f"{summary['files']} patterns: {counts}"
    if summary["skipped"]:
        text += f"; {summary['skipped']} of them were there already"
    if summary["jsonl"]:
        text += f"; results in {summary['jsonl']}"
    return Group(*parts, Text(text))


Row = tuple[str, str, str, str]


def branch_row(name: str, result: SignedBranch) -> Row:
    """The row of a branch in `branches_report`."""
    return name, str(result.status), _cut(result.sign_text), _cut(result.assignment_text)


def branches_report(rows: list[Row]) -> Group:
    """The table that `exactfold branch` prints for a batch or for neighbours."""
    table = Table(box=None, pad_edge=False)
    table.add_column("")
    table.add_column("status")
    table.add_column("vertex signs", overflow="fold")
    table.add_column("mountain-valley", overflow="fold")
    for row in rows:
        table.add_row(*row)
    return Group(table)


def _cut(text: str, most: int = 160) -> str:
    return text if len(text) <= most else f"{text[:most]}... ({len(text)}; --json has all)"


def info_report(facts: PatternFacts) -> Table:
    """The table printed by `exactfold info`."""
    pattern = facts.pattern
    rows = [
        ("vertices", f"{pattern.Vi} interior, {pattern.Ve} boundary"),
        (
            "faces, edges, folds",
            f"{len(pattern.triangles)}, {len(pattern.edges)}, {len(pattern.folds)}",
        ),
        ("degrees of freedom", f"D = Ve - 3 = {pattern.degrees_of_freedom}"),
        ("boundary", "convex" if pattern.is_convex else f"reflex at {pattern.reflex_corner}"),
        ("area", format_rational(pattern.area)),
        (
            "interior degrees",
            ", ".join(f"{n} of degree {d}" for d, n in facts.degree_counts.items()) or "none",
        ),
        (
            "rank of rigidity matrix",
            f"{facts.rigidity_rank} = 2V - 3"
            if facts.rigidity_rank == 2 * len(pattern.vertices) - 3
            else str(facts.rigidity_rank),
        ),
        ("self stresses", str(facts.self_stresses)),
        ("inertia of curvature forms", _listed([f"{v}: {i}" for v, i in facts.inertias.items()])),
        (
            "triangulated triangles",
            _listed(
                [
                    f"{corners} around {_listed(list(map(str, inside)), ', ')}"
                    for corners, inside in pattern.triangulated_triangles
                ]
            ),
        ),
        ("folds that split the sheet", _listed([f"{i}-{j}" for i, j in pattern.chords], ", ")),
        ("expected", expectation(facts)),
        ("sha256", pattern.sha256),
    ]
    return _facts_table(rows)


def _listed(entries: list[str], separator: str = "; ") -> str:
    rest = len(entries) - LISTED
    more = [f"... and {rest} more (--json lists all)"] if rest > 0 else []
    return separator.join(entries[:LISTED] + more) or "none"


def expectation(facts: PatternFacts) -> str:
    """What `count` will settle, from the counts alone."""
    pattern = facts.pattern
    free = pattern.Vi - pattern.Vt
    if not pattern.interior:
        return "no interior vertex: nothing to count"
    if pattern.degrees_of_freedom == 0:
        return "rigid: 0 branches"
    if pattern.degrees_of_freedom == 1:
        return f"2^{pattern.Vi} solutions with multiplicity, 2^{free} branches if no star is flat"
    if free == 1 and not pattern.emptied()[0].chords:
        return "one branch (single vertex)"
    return f"{UNDECIDED}: branches of dimension {pattern.degrees_of_freedom} are not counted"


def examples_report(examples: Mapping[str, str]) -> Group:
    """What `exactfold examples` prints."""
    table = Table(box=None, show_header=False, pad_edge=False)
    table.add_column(style="bold", no_wrap=True)
    table.add_column()
    for name, text in examples.items():
        table.add_row(name, text)
    use = "A name stands for the file in every command: exactfold count two-vertex"
    return Group(table, "", Text(use))


def show(content: RenderableType) -> None:
    """Print to stdout; off a terminal without styles and trailing blanks, 80 columns wide."""
    out = console()
    if out.is_terminal:
        out.print(content)
        return
    with out.capture() as captured:
        out.print(content)
    print("\n".join(line.rstrip() for line in captured.get().splitlines()))


def console(*, stderr: bool = False) -> Console:
    """A console without highlighting, so that text and tables stay as written."""
    return Console(stderr=stderr, highlight=False, emoji=False, markup=False)
