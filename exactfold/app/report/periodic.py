"""What `exactfold count --direction` prints: branches and pleats of a periodic sheet."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from rich.console import Group
from rich.table import Table
from rich.text import Text

from exactfold._support.plurals import agreeing, counted
from exactfold._support.verdict import PROVED, REFUTED
from exactfold.app.report.count import NAMED
from exactfold.app.report.terminal import letters_text, listed, more_text, status_text
from exactfold.exact.numbers import format_rational
from exactfold.panels.periodic.result import fold_name

if TYPE_CHECKING:
    from exactfold._support.verdict import Verdict
    from exactfold.branches.periodic.directions_result import DirectionsCount, ExactDirection
    from exactfold.branches.periodic.result import AlgebraicLine, HeightSpace, PeriodicCount
    from exactfold.panels.periodic.result import PanelCell, PeriodicMotion


def periodic_report(result: PeriodicCount, certificate: str | None, *, everything: bool) -> Group:
    """The answer, the pleats, and the branches."""
    parts: list[Any] = [_answer(result), *map(Text, _notes(result, certificate))]
    limit = listed(len(result.branches), everything=everything)
    if limit:
        parts += ["", _table(result, limit), *more_text(len(result.branches) - limit)]
        parts += ["", *map(Text, _legend(result))]
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
    where, took = f"in the direction {x},{y}", f" ({result.seconds:.2f} s)"
    number, families = len(result.branches), len(result.families)
    if result.status is not PROVED:
        return Text.assemble(
            f"the number of ways to start folding {where} is ",
            status_text(result.status),
            f"{took}: {result.reason}; {counted(number, 'way')} found",
        )
    kinds = [counted(number, "way")] if number or not families else []
    if families:
        kinds.append(f"{families} {agreeing(families, 'family')} of ways")
    found = " and ".join(kinds)
    weight = result.with_multiplicity
    more = "each counted once" if weight == number else f"{weight} with multiplicity"
    return Text.assemble(
        f"{found} to start folding {where} - ",
        status_text(PROVED),
        f"{took}; all real, {more}",
    )


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


def _legend(result: PeriodicCount) -> list[str]:
    edges = result.pattern.edges
    return [
        _order(edges),
        "Each way is shown on one side; on the other all is reversed. Where b is +, it rolls up "
        "towards you.",
    ]


def _order(edges: Sequence[Sequence[int]]) -> str:
    """The order of the letters, and what they mean."""
    order = "of --json"
    if len(edges) <= NAMED:
        order = ", ".join(map(fold_name, edges))
    return (
        f"Folds in the order {order}; M mountain, V valley, F flat, seen from above. (i,j) moves "
        "the second vertex by i and j lattice vectors."
    )


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


def directions_report(result: DirectionsCount, *, everything: bool) -> Group:
    """The answer for all directions, the branches, and where they cross."""
    took = f" ({result.seconds:.2f} s): {result.reason}"
    if result.status is not PROVED:
        answer = Text.assemble(
            "the branches over all directions are ", status_text(result.status), took
        )
    else:
        number = counted(len(result.branches), "branch")
        answer = Text.assemble(f"{number} over all directions - ", status_text(PROVED), took)
    parts: list[Any] = [answer]
    if result.families is not None and result.status is not PROVED:
        parts.append(_family_directions(result.families))
    limit = listed(len(result.branches), everything=everything)
    if limit:
        parts += ["", _branches_table(result, limit), *more_text(len(result.branches) - limit)]
        parts += ["", Text(_half_turn(result))] if result.status is PROVED else []
    limit = listed(len(result.crossings), everything=everything)
    if limit:
        parts += ["", Text("Crossings", style="bold"), _crossings_table(result, limit)]
        parts += more_text(len(result.crossings) - limit)
    if result.branches:
        parts += [
            "",
            Text(
                "Directions are counter-clockwise from 1,0, which comes last. At a crossing the "
                "vertices with sign 0 are flat, and on each branch through it they change their "
                "signs. Signs and b are those of the side on which the first vertex pops up."
            ),
        ]
    return Group(*parts)


def _family_directions(found: Sequence[ExactDirection]) -> Text:
    """In which directions there are families, which is proved."""
    where = ", ".join(f"{n} ({n.angle:.3f} degrees)" for n in found)
    what = f"families only across {where} - " if found else "no families in any direction - "
    return Text.assemble(what, status_text(PROVED))


def _half_turn(result: DirectionsCount) -> str:
    """What happens to the branches as the direction makes a half turn."""
    turns = result.turns or 1
    if turns == 1:
        return "After a half turn of the direction every branch comes back as itself."
    return (
        f"After a half turn of the direction branches come back as others; after {turns} half "
        "turns as themselves."
    )


def _branches_table(result: DirectionsCount, limit: int) -> Table:
    table = Table(box=None, pad_edge=False)
    order = result.permutation
    for heading in ("branch", "signs", "b", *(["after a half turn"] if order else [])):
        table.add_column(heading, no_wrap=True)
    for k, branch in enumerate(result.branches[:limit]):
        cells = [str(k + 1), branch.vertex_signs, "+" if branch.b > 0 else "-"]
        table.add_row(*cells, *([str(order[k] + 1)] if order else []))
    return table


def _crossings_table(result: DirectionsCount, limit: int) -> Table:
    table = Table(box=None, pad_edge=False)
    for heading in ("degrees", "direction", "signs", "b", "flat vertices"):
        table.add_column(heading, no_wrap=True)
    for crossing in result.crossings[:limit]:
        table.add_row(
            f"{crossing.angle:.3f}",
            str(crossing.direction),
            crossing.vertex_signs,
            "+" if crossing.b > 0 else "-",
            ", ".join(map(str, crossing.vertices)),
        )
    return table


def panel_cell_report(result: PanelCell, certificate: str | None, *, everything: bool) -> Group:
    """The answer and the motions of a tessellation of rigid panels."""
    took = f" ({result.seconds:.2f} s)"
    written = [] if certificate is None else [f"certificate: {certificate}"]
    if result.status is not PROVED:
        answer = Text.assemble(
            "the periodic motions of the panels are ",
            status_text(result.status),
            f"{took}: {result.reason}; --direction X,Y counts those that roll up across one "
            "direction if all edges fold",
        )
        return Group(answer)
    if not result.motions:
        answer = Text.assemble("no periodic motion of the panels - ", status_text(PROVED), took)
        return Group(answer, *map(Text, written))
    answer = Text.assemble(
        f"{counted(len(result.motions), 'component')} of periodic motions of rigid panels - ",
        status_text(PROVED),
        f"{took}, to second order, for all directions together",
    )
    table = Table(box=None, pad_edge=False)
    for heading in ("way", "dimension", "rolls up", "letters", "truly folds"):
        table.add_column(heading, no_wrap=heading != "letters")
    limit = listed(len(result.motions), everything=everything)
    for k, motion in enumerate(result.motions[:limit], 1):
        for line, part in enumerate(motion.parts):
            row = [str(k), str(motion.dimension), _rolls(motion)] if not line else ["", "", ""]
            letters = letters_text(part.letters) if part.letters else f"{part.size} parameters"
            folds = "yes" if motion.folds is PROVED else "not known"
            table.add_row(*row, letters, "" if line else folds)
    notes = [_order(result.folds)]
    if any(len(motion.parts) > 1 for motion in result.motions):
        notes.append("Rows without a number are further parts of a way, each of which may be flat.")
    notes.append("A way that truly folds does so with equal fold angles in all cells.")
    fields = [name for name in result.field_names if name != "Q"]
    if fields:
        notes.append(f"Fold angles are in {', '.join(fields)}.")
    more = more_text(len(result.motions) - limit)
    return Group(answer, *map(Text, written), "", table, *more, "", *map(Text, notes))


def _rolls(motion: PeriodicMotion) -> str:
    if motion.planar:
        return "no"
    if motion.direction is None:
        return "yes"
    return "across " + ",".join(map(str, motion.direction))


def letters_report(answer: Verdict, ways: Sequence[int], letters: str) -> Group:
    """Whether a periodic sheet starts to fold with given letters."""
    if answer is PROVED:
        noun = "way" if len(ways) == 1 else "ways"
        text = f"the sheet starts to fold with {letters}, {noun} {', '.join(map(str, ways))} - "
    elif answer is REFUTED:
        text = f"the sheet does not start to fold with {letters} - "
        return Group(Text.assemble(text, status_text(PROVED)))
    else:
        text = f"whether the sheet starts to fold with {letters} is "
    return Group(Text.assemble(text, status_text(answer)))
