"""What `exactfold actuate` prints."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.console import Group
from rich.table import Table
from rich.text import Text

from exactfold._support.plurals import counted
from exactfold.app.report.panel_actuation import between, model_text, newtons, panels_actuation
from exactfold.app.report.terminal import facts_table, letters_text, more_text, status_text
from exactfold.exact.numbers import decimal_above, decimal_near

if TYPE_CHECKING:
    from exactfold.design.actuation.panels.result import PanelActuation
    from exactfold.design.actuation.result import Actuation

_FIRST = 8
"""The number of branches of the ranking that are shown, unless all are asked for."""


def actuation_report(actuation: Actuation | PanelActuation, *, everything: bool = False) -> Group:
    """The torques, what is proved of them, and the branches or ways sorted by power."""
    from exactfold.design.actuation.result import Actuation

    if not isinstance(actuation, Actuation):
        return panels_actuation(actuation, everything=everything)
    branch = actuation.branch
    rows: list[tuple[str, str | Text]] = [
        ("status", Text.assemble(status_text(actuation.status), f" ({actuation.reason})")),
        ("vertex signs", branch.sign_text),
        ("mountain-valley", letters_text(branch.assignment_text)),
        ("margin", f"{between(actuation.margin)}; {_best(actuation)}"),
        (
            "power",
            f"{between(actuation.power)}; on any other ray {between(actuation.largest_rival)}",
        ),
        ("alone", _alone(actuation)),
        ("self-foldable", _folding(actuation)),
    ]
    if not actuation.driven:
        return Group(facts_table(list(rows)))
    return Group(
        facts_table(list(rows)),
        Text(""),
        _torques(actuation),
        Text(""),
        *_ranking(actuation, everything),
        *model_text(actuation.hinges),
    )


def _folding(actuation: Actuation) -> Text:
    verdict = status_text(actuation.self_foldable)
    return Text.assemble(verdict, f" ({actuation.self_foldable_reason})")


def _best(actuation: Actuation) -> str:
    bound = f"{decimal_above(actuation.bound, 6)} is the most that is possible"
    if actuation.given:
        return f"with torques of this size at most {decimal_above(actuation.bound, 6)} is possible"
    if actuation.creases is not None:
        return f"on {counted(actuation.creases, 'crease')} at most {bound.split()[0]} is possible"
    return f"at most {bound.split()[0]} is possible"


def _alone(actuation: Actuation) -> str:
    """What is known of torques that do no work on any other branch."""
    low, high = actuation.orthogonal_dimension
    names = actuation.independent
    if high == 0:
        listed = ", ".join(names[:3]) + (f" and {len(names) - 3} more" if len(names) > 3 else "")
        return (
            "no torques do work on this branch only: the other branches "
            f"{listed} are linearly independent and span all first-order motions"
        )
    if low == 0:
        return (
            f"torques that do work on this branch only: undecided, their dimension is 0 to {high}"
        )
    size = str(low) if low == high else f"{low} to {high}"
    share = ""
    if actuation.orthogonal is not None:
        share = (
            f"; such torques to within {decimal_above(actuation.orthogonal.share, 1)} are listed"
        )
    return f"torques that do work on this branch only: dimension {size}{share}"


def _torques(actuation: Actuation) -> Table:
    table = Table(box=None, pad_edge=False)
    table.add_column("crease")
    table.add_column("letter")
    table.add_column("torque", justify="right")
    hinges = actuation.hinges
    lengths = {} if hinges is None else hinges.lengths(actuation.pattern)
    if hinges is not None:
        table.add_column("mm", justify="right")
        table.add_column("N mm", justify="right")
    alone = actuation.orthogonal.torques if actuation.orthogonal is not None else {}
    if alone:
        table.add_column("on this branch only", justify="right")
    for fold in sorted({*actuation.driven, *(fold for fold, torque in alone.items() if torque)}):
        letter = actuation.branch.assignment[fold]
        row: list[str | Text] = [f"{fold[0]}-{fold[1]}", letters_text(letter)]
        torque = actuation.torques[fold]
        row.append(decimal_near(torque, 12))
        if hinges is not None:
            row += newtons(hinges, lengths[fold], torque)
        if alone:
            row.append(decimal_near(alone[fold], 12))
        table.add_row(*row)
    return table


def _ranking(actuation: Actuation, everything: bool) -> list[Text | Table]:
    table = Table(box=None, pad_edge=False)
    table.add_column("place", justify="right")
    table.add_column("branch", overflow="fold")
    table.add_column("power", justify="right")
    table.add_column("note")
    ranking = actuation.ranking()
    shown = ranking if everything else ranking[:_FIRST]
    for place, row in enumerate(shown, 1):
        last = place == len(ranking)
        note = "" if row.above_next or last else "not proved to exceed the next one"
        note += ("; " if note and row.ray < 0 else "") + ("turned over" if row.ray < 0 else "")
        middle = (row.power[0] + row.power[1]) / 2
        table.add_row(str(place), row.signs, decimal_near(middle, 6), note)
    return [table, *more_text(len(ranking) - len(shown))]
