"""What `exactfold branch` prints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

from rich.console import Group
from rich.table import Table
from rich.text import Text

from exactfold._support.plurals import counted
from exactfold._support.verdict import Verdict
from exactfold.app.report.terminal import cut, facts_table, letters_text, status_text
from exactfold.exact.numbers import decimal_above, format_rational
from exactfold.pattern.crease_pattern import CreasePattern

if TYPE_CHECKING:
    from exactfold.branches.counting.shapes import ShapeCount
    from exactfold.branches.values.branch import Branch
    from exactfold.branches.values.export import BranchExport
    from exactfold.motion.tubes.driven import Driven

Row = tuple[str, str, str, str]


def branch_report(result: Branch, driven: Driven | None = None) -> Group:
    """One branch: what is proved of it, which vertices pop up, and the folds.

    `driven` has the driven folds by which it was found, if it was found in this way.
    """
    rows: list[tuple[str, str | Text]] = [
        ("status", Text.assemble(status_text(result.status), f" ({result.reason})")),
        ("up", cut(_with_sign(result, 1))),
        ("down", cut(_with_sign(result, -1))),
    ]
    if flat := _with_sign(result, 0):
        rows.append(("flat", cut(flat)))
    if result.curvature:
        deficits = _by_vertex(dict(sorted(result.curvature.items())))
        rows.append(("angle deficits", cut(deficits)))
    if result.boundary_heights is not None:
        rows.append(("boundary heights", cut(boundary_heights_text(result.boundary_heights))))
        if straight := result.straight_boundary:
            rows.append(("on a straight side", f"{_vertices(straight)}: the side may bend there"))
    if driven is not None:
        ratio = cut(f"{driven.drive.ratio}; this ratio is exact on a solution near it, ")
        rows.append(("folds start as", Text.assemble(ratio, status_text(driven.status))))
    if result.radius is not None:
        rows.append(("mountain-valley", letters_text(cut(result.assignment_text))))
        if undecided := len(result.undecided_folds):
            rows.append(("undecided", counted(undecided, "fold")))
        rows.append(
            ("heights", f"each within {decimal_above(result.radius, 2)} (--json lists them)")
        )
    rows.append(("method", f"{counted(result.steps, 'Newton step')}, {result.seconds:.2f} s"))
    return Group(facts_table(list(rows)))


def _with_sign(result: Branch, sign: int) -> str:
    chosen = [v for v, s in sorted(result.vertex_signs.items()) if s == sign]
    if not chosen:
        return "none" if sign else ""
    return _vertices(chosen)


def _vertices(chosen: Sequence[int]) -> str:
    return f"{'vertex' if len(chosen) == 1 else 'vertices'} {', '.join(map(str, chosen))}"


def boundary_heights_text(heights: Mapping[int, Fraction]) -> str:
    """Heights by vertex; heights that are 0 are not listed.

    >>> boundary_heights_text({0: Fraction(1), 1: Fraction(0), 3: Fraction(-11, 20)})
    '0: 1, 3: -11/20, others 0'
    """
    raised = {v: height for v, height in heights.items() if height}
    if not raised:
        return "all 0"
    return _by_vertex(raised) + (", others 0" if len(raised) < len(heights) else "")


def _by_vertex(numbers: Mapping[int, Fraction]) -> str:
    return ", ".join(f"{v}: {format_rational(x)}" for v, x in numbers.items())


def shapes_report(result: ShapeCount, *, everything: bool = False) -> Group:
    """The number of shapes with given angle deficits."""
    low, high = result.bounds
    number = f"{low}" if low == high else f"at least {low}, at most {high}"
    deficits = _by_vertex(dict(sorted(result.curvature.items())))
    rows: list[tuple[str, str | Text]] = [
        ("status", Text.assemble(status_text(result.status), f" ({result.reason})")),
        ("shapes", f"{number}; {result.with_multiplicity} with multiplicity"),
        ("angle deficits", cut(deficits)),
        ("boundary heights", cut(boundary_heights_text(result.boundary_heights))),
    ]
    if result.signs:
        texts = ", ".join(result.signs)
        rows.append(("vertex signs", texts if everything else cut(texts)))
    return Group(facts_table(list(rows)))


def branch_row(name: str, result: Branch) -> Row:
    """The row of a branch in `branches_report`."""
    return name, str(result.status), cut(result.sign_text), cut(result.assignment_text)


def branches_report(rows: list[Row]) -> Group:
    """The table for several patterns, or for a branch and its neighbours."""
    table = Table(box=None, pad_edge=False)
    table.add_column("branch")
    table.add_column("status")
    table.add_column("vertex signs", overflow="fold")
    table.add_column("mountain-valley", overflow="fold")
    for name, status, signs, letters in rows:
        table.add_row(name, status_text(status), signs, letters_text(letters))
    return Group(table)


def export_report(
    output: str, named: tuple[str, str], status: Verdict, export: BranchExport
) -> Table:
    """What `exactfold export` prints about the file that it wrote.

    `named` says what was written: the signs of a branch, or the name of a way.
    """
    sizes = [abs(angle) for angle in export.angles.values()]
    frame = f"second order: lengths change by up to {100 * export.length_error:.2g} %"
    if not isinstance(export.pattern, CreasePattern):
        frame = f"panels stay rigid: lengths are kept to {export.length_error:.2g} of each"
    letters = "".join(export.letters[fold] for fold in export.pattern.folds)
    return facts_table(
        [
            ("wrote", output),
            ("status", status_text(status)),
            (named[0], cut(named[1])),
            ("mountain-valley", letters_text(cut(letters))),
            ("fold angles", f"largest {max(sizes):.4g}, smallest {min(sizes):.4g} degrees"),
            ("folded frame", frame),
        ]
    )
