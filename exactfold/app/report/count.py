"""What `exactfold count` prints: the answer in plain words, then a line for each way."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from rich.console import Group
from rich.table import Table
from rich.text import Text

from exactfold._support.plurals import agreeing, counted
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.app.report.connected_components import families_answer, piece_notes
from exactfold.app.report.terminal import (
    BY_SIGN,
    COUNTED,
    SHOWN,
    SPELLED,
    facts_table,
    in_numbers,
    letters_text,
    listed,
    more_text,
    status_text,
)
from exactfold.exact.numbers import decimal_above

if TYPE_CHECKING:
    from exactfold.branches.counting.stream import StreamedCount
    from exactfold.branches.values.branch import Branch
    from exactfold.branches.values.lettered import Lettered
    from exactfold.branches.values.result import BranchCount

METHODS = {
    "nappes": "Newton, one start per sign vector",
    "newton": "Newton, one start per sign vector",
    "popping": "popping, a path of real solutions per sign vector",
    "homotopy": "complex homotopy",
    "groebner": "Groebner basis",
    "streaming": "Newton, one start per sign vector, block by block",
    "theorem": "no enumeration",
}
"""The methods in words."""

COLUMNS = 8
"""With up to this many interior vertices, each has a column; with more, those that pop up are
listed.
"""

NAMED = 12
"""At most this many folds are named below the table."""


def count_report(
    result: BranchCount,
    certificate: str | None,
    *,
    everything: bool,
    streamed: StreamedCount | None = None,
    verbose: bool = False,
) -> Group:
    """The answer, the branches, and what is undecided; with `verbose` also how it was found."""
    parts: list[Any] = [answer(result)]
    notes = _notes(result, certificate, streamed)
    if notes:
        parts += ["", *(Text(note) for note in notes)]
    if verbose:
        parts += ["", facts_table(_details(result, streamed))]
    if result.branches:
        parts += ["", *branch_table(result.branches, everything=everything)]
    if result.open_questions:
        limit = listed(len(result.open_questions), everything=everything)
        parts += ["", Text("Open", style="bold")]
        parts += [Text(f"- {question}") for question in result.open_questions[:limit]]
        parts += more_text(len(result.open_questions) - limit)
    return Group(*parts)


def answer(result: BranchCount) -> Text:
    """The number of ways in which the sheet starts to fold, in one sentence.

    >>> from exactfold.branches.counting.collect import count_branches
    >>> from exactfold.pattern.families import single_vertex
    >>> from dataclasses import replace
    >>> print(answer(replace(count_branches(single_vertex(4)), seconds=0.01)))
    2 ways to start folding - PROVED (0.01 s); all real, each counted once, every one continues to a
    true motion
    """
    took = f" ({result.seconds:.2f} s)"
    if result.meant is not None and result.meant.inferred and not result.doubt:
        plain = answer(replace(result, meant=None))
        return Text.assemble(f"{result.meant.name}: ", plain)
    if result.status is not PROVED:
        return _undecided(result, took)
    if result.distinct == 0:
        return Text.assemble(
            "0 ways to start folding - ", status_text(PROVED), took, "; the sheet is rigid"
        )
    if result.connected_components is not None and result.distinct is None:
        number, what = families_answer(result.connected_components)
        return Text.assemble(f"{number} - ", status_text(PROVED), took, f"; {what}")
    if result.pattern.degrees_of_freedom > 1:
        return Text.assemble(
            f"1 family of ways to fold, of dimension {result.pattern.degrees_of_freedom} - ",
            status_text(PROVED),
            took,
            "; the dimension is the number of folds that can be folded independently",
        )
    ways = result.real or 0
    return Text.assemble(
        f"{counted(ways, 'way')} to start folding - ",
        status_text(PROVED),
        took,
        f"; {_reality(result)}, {_multiplicity(result)}, {_motion(result)}",
    )


def _reality(result: BranchCount) -> str:
    if result.nonreal:
        others = counted(result.nonreal, "solution")
        return f"beside {others} that {agreeing(result.nonreal, 'is')} not real"
    return "it is real" if result.real == 1 else "all real"


def _multiplicity(result: BranchCount) -> str:
    if result.with_multiplicity == result.distinct:
        return "counted once" if result.distinct == 1 else "each counted once"
    return f"{result.with_multiplicity} with multiplicity, as flat vertices count double"


def _motion(result: BranchCount) -> str:
    if result.true_branches is PROVED:
        return ("it" if result.real == 1 else "every one") + " continues to a true motion"
    if result.true_bounds is not None:
        low, high = result.true_bounds
        return f"every one continues to a true motion, and there are {low} to {high} true motions"
    return "it is undecided whether each continues to a true motion"


def _undecided(result: BranchCount, took: str) -> Text:
    if result.by == "theorem" and not result.doubt:
        return Text.assemble(
            f"2^{result.pattern.Vi} ways to start folding with multiplicity, all real, by Theorem "
            "2; how many of them are different is ",
            status_text(UNDECIDED),
            f"{took}: {result.reason}",
        )
    known = ""
    if result.branches:
        known = f"; {counted(len(result.branches), 'way')} proved to exist"
    return Text.assemble(
        "the number of ways to start folding is ",
        status_text(UNDECIDED),
        f"{took}: {result.reason}{known}",
    )


def _notes(
    result: BranchCount, certificate: str | None, streamed: StreamedCount | None
) -> list[str]:
    notes, rigid = [], result.pattern.Vt
    if rigid:
        notes.append(
            f"{counted(rigid, 'vertex')} in triangulated triangles {agreeing(rigid, 'stays')} flat"
        )
    if result.exceptional_vertices:
        notes.append(_exception(result))
    if result.connected_components is not None:
        notes += piece_notes(result)
    if result.snapped:
        notes.append(f"coordinates were moved by up to {decimal_above(result.snapped, 3)} (--snap)")
    if result.lettered is not None:
        notes.append(_lettered(result.lettered))
    if streamed is not None:
        notes += [f"{name}: {value}" for name, value in _stream_rows(streamed)]
    if certificate:
        notes.append(f"certificate: {certificate}")
    return notes


def _exception(result: BranchCount) -> str:
    """A sentence: the vertices have an exceptional position, and what happens at almost
    all others.
    """
    vertices, pattern = result.exceptional_vertices, result.pattern
    named = ", ".join(str(v) for v in vertices[:NAMED]) + (", ..." if len(vertices) > NAMED else "")
    word = "vertex" if len(vertices) == 1 else "vertices"
    return (
        f"exceptional: {word} {named} can stay flat; almost all positions of the interior vertices "
        f"give {1 << (pattern.Vi - pattern.Vt)} different ways"
    )


def _lettered(lettered: Lettered) -> str:
    """A sentence that says which ways have the letters of the file."""
    sure = lettered.status is PROVED
    if not lettered.ways:
        if not sure:
            return "no way is proved to have the mountains and valleys of the file"
        return (
            "no way has the mountains and valleys of the file: `exactfold match` says why, and "
            "which are nearest"
        )
    ways = [f"{way}{' (other side)' if side < 0 else ''}" for way, side in lettered.ways[:NAMED]]
    more = f" and {len(lettered.ways) - NAMED} more" if len(lettered.ways) > NAMED else ""
    has = "has" if len(lettered.ways) == 1 else "have"
    word = "way" if len(lettered.ways) == 1 else "ways"
    rest = "" if sure else "; perhaps others have them, too"
    return f"{word} {', '.join(ways)}{more} {has} the mountains and valleys of the file{rest}"


def _details(result: BranchCount, streamed: StreamedCount | None) -> list[tuple[str, Any]]:
    pattern = result.pattern
    rows: list[tuple[str, Any]] = [
        (
            "pattern",
            f"{pattern.Vi} interior and {pattern.Ve} boundary vertices, "
            f"{counted(len(pattern.folds), 'fold')}, D = {pattern.degrees_of_freedom}",
        ),
        ("sha256", pattern.sha256),
        ("status", Text.assemble(status_text(result.status), f" ({result.reason})")),
    ]
    if result.status is PROVED and result.distinct is not None:
        rows.append(
            (
                "branches",
                f"{result.distinct} distinct, {result.with_multiplicity} with "
                f"multiplicity; {result.real} real, {result.nonreal} not real",
            )
        )
        rows.append(("true branches", _true_text(result)))
    elif result.degree is not None:
        rows.append(
            (
                "solutions",
                f"a cone of dimension {result.dimension} and degree {_power(result.degree)} "
                "(complex, modulo planes, with multiplicity)",
            )
        )
    if result.branches:
        rows.append(("sign vectors", _sign_vectors(result)))
        rows.append(("shared folds", _shared(result)))
    degrees = str(result.settings.get("factor_degrees", ""))
    if degrees:
        several = " " in degrees
        form = "factors of degrees" if several else "irreducible over Q of degree"
        rows.append(("polynomial", f"{form} {degrees}"))
    why = f" ({result.why})" if result.why else ""
    rows.append(("method", f"{METHODS.get(result.method, result.method)}{why}"))
    return rows


def _true_text(result: BranchCount) -> Text:
    if result.true_bounds is None or result.true_branches is PROVED:
        return status_text(result.true_branches)
    low, high = result.true_bounds
    return Text.assemble(status_text(UNDECIDED), f" ({low} to {high})")


def _power(value: int) -> str:
    return str(value) if value < 1 << 53 else f"2^{value.bit_length() - 1}"


def _sign_vectors(result: BranchCount) -> str:
    each = sorted(set(result.sign_vectors.values()))
    pairs = len(result.sign_vectors)
    per = counted(each[0], "branch") if len(each) == 1 else f"{each[0]} to {each[-1]} branches"
    if pairs == 1:
        return f"1 pair of opposite ones, with {per}"
    return f"{counted(pairs, 'pair')} of opposite ones, {per} each"


def _shared(result: BranchCount) -> str:
    shared = result.repeated_assignments
    if shared is None:
        return "undecided"
    if not shared:
        return "no two branches have the same mountain-valley assignment"
    return f"{counted(shared, 'branch')} share their mountain-valley assignment with another"


def _stream_rows(streamed: StreamedCount) -> list[tuple[str, str]]:
    rows = [("streamed to", streamed.path)]
    if streamed.resumed:
        there = agreeing(streamed.resumed, "is")
        total = counted(streamed.blocks, "block")
        rows.append(("resumed", f"{streamed.resumed} of {total} {there} taken over"))
    if streamed.unproved:
        rows.append(("open there", f"{streamed.unproved} of {1 << streamed.foldable} sign vectors"))
    for limit, group in list(streamed.groups.items())[:SHOWN]:
        signs = ", ".join(root.signs for root in group[:8]) + (", ..." if len(group) > 8 else "")
        rows.append(("seem to meet", f"{signs} at {limit}"))
    return rows


def branch_table(branches: Sequence[Branch], *, everything: bool = True) -> list[Any]:
    """A line for each branch, or for the first ones, with its number, and how many more there are.

    Letters are spelled out on sheets with few folds, or if everything is asked for.
    """
    pattern, limit = branches[0].pattern, listed(len(branches), everything=everything)
    spelled = everything or len(pattern.folds) <= SPELLED
    vertices, wide = pattern.interior, pattern.Vi <= COLUMNS
    counts = any(branch.multiplicity != 1 for branch in branches)
    table = Table(box=None, pad_edge=False)
    table.add_column("way", justify="right")
    for v in vertices if wide else ():
        table.add_column(f"vertex {v}" if v == vertices[0] else str(v))
    if not wide:
        table.add_column("vertices up", overflow="fold")
    table.add_column("folds", overflow="fold")
    if counts:
        table.add_column("multiplicity", justify="right")
    for k, branch in enumerate(branches[:limit], 1):
        signs = branch.vertex_signs
        cells: list[Any] = [str(k)]
        if wide:
            cells += [BY_SIGN[signs[v]] for v in vertices]
        else:
            cells.append(_up_list(signs))
        letters = branch.assignment_text
        cells.append(letters_text(letters) if spelled else Text(in_numbers(letters)))
        table.add_row(*cells, *([str(branch.multiplicity)] if counts else []))
    return [table, *more_text(len(branches) - limit), "", *_legend(branches, spelled)]


def _up_list(signs: Mapping[int, int]) -> str:
    up = ", ".join(str(v) for v, s in sorted(signs.items()) if s > 0) or "none"
    flat = ", ".join(str(v) for v, s in sorted(signs.items()) if s == 0)
    return up + (f" (flat: {flat})" if flat else "")


def _legend(branches: Sequence[Branch], spelled: bool) -> list[Text]:
    folds = branches[0].pattern.folds
    other_side = Text("Each way is shown on one side; on the other all is reversed.")
    if not spelled:
        return [Text(COUNTED), other_side]
    order = "of --json"
    if len(folds) <= NAMED:
        order = ", ".join(f"{i}-{j}" for i, j in folds)
    letters = {letter for branch in branches for letter in branch.assignment.values()}
    names = {"M": "M mountain", "V": "V valley", "F": "F flat", "U": "U undecided"}
    said = ", ".join(text for letter, text in names.items() if letter in letters)
    return [
        Text(f"Folds in the order {order}; {said}, seen from above."),
        other_side,
    ]
