"""What `exactfold count --direction` prints: branches and pleats of a periodic sheet."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rich.console import Group
from rich.table import Table
from rich.text import Text

from exactfold._support.plurals import agreeing, counted
from exactfold._support.verdict import PROVED
from exactfold.app.report.terminal import letters_text, listed, more_text, status_text
from exactfold.exact.numbers import format_rational

if TYPE_CHECKING:
    from exactfold.branches.periodic.result import AlgebraicLine, HeightSpace, PeriodicCount


def periodic_report(result: PeriodicCount, certificate: str | None, *, everything: bool) -> Group:
    """The answer, the pleats, and the branches."""
    parts: list[Any] = [_answer(result), *map(Text, _notes(result, certificate))]
    limit = listed(len(result.branches), everything=everything)
    if limit:
        parts += ["", _table(result, limit), *more_text(len(result.branches) - limit)]
    for title, spaces in (("Pleats", result.pleats), ("Families", result.families)):
        if spaces:
            parts += ["", Text(title, style="bold"), *(Text(_space(space)) for space in spaces)]
    if result.open:
        shown = listed(len(result.open), everything=everything)
        parts += ["", Text("Open sign vectors", style="bold")]
        parts += [Text(f"- {signs}") for signs in result.open[:shown]]
        parts += more_text(len(result.open) - shown)
    return Group(*parts)


def _answer(result: PeriodicCount) -> Text:
    x, y = result.direction
    where = f"for the direction {x},{y}"
    found = counted(len(result.branches), "branch")
    if result.status is not PROVED:
        rest = f": {found} found {where}; {result.reason}"
        return Text.assemble(status_text(result.status), rest)
    families = len(result.families)
    if families:
        found += f" and {families} {agreeing(families, 'family')}"
    weight = result.with_multiplicity
    more = "" if weight == len(result.branches) else f", {weight} with multiplicity"
    return Text.assemble(status_text(result.status), f": {found}{more}, all real, {where}")


def _notes(result: PeriodicCount, certificate: str | None) -> list[str]:
    notes = [result.reason] if result.status is PROVED else []
    number = len(result.pleats)
    if number:
        notes.append(
            f"{number} {agreeing(number, 'space')} of pleats, which bend the sheet without rolling "
            "it up"
        )
    elif result.status is PROVED:
        notes.append("no pleats: every way to start folding rolls the sheet up")
    if result.families:
        notes.append("a family is a linear space of two or more dimensions in which b is not 0")
    if certificate is not None:
        notes.append(f"certificate: {certificate}")
    return notes


def _table(result: PeriodicCount, limit: int) -> Table:
    table = Table(box=None, pad_edge=False)
    for heading in ("way", "signs", "b", "multiplicity", "letters"):
        table.add_column(heading, no_wrap=heading != "letters")
    for k, branch in enumerate(result.branches[:limit], 1):
        side = "+" if branch.b > 0 else "-"
        letters = letters_text(branch.letters)
        table.add_row(str(k), branch.vertex_signs, side, str(branch.multiplicity), letters)
    return table


def _space(space: HeightSpace | AlgebraicLine) -> str:
    from exactfold.branches.periodic.result import HeightSpace

    if not isinstance(space, HeightSpace):
        return "- dimension 1, with irrational heights; --json has them"
    rows = ["(" + ", ".join(map(format_rational, row)) + ")" for row in space.basis]
    return f"- dimension {space.dimension}: {', '.join(rows)}"
