"""What `exactfold actuate` prints of rigid panels."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from rich.console import Group
from rich.table import Table
from rich.text import Text

from exactfold._support.plurals import counted
from exactfold.app.report.terminal import (
    SPELLED,
    facts_table,
    in_numbers,
    letters_text,
    more_text,
    status_text,
)
from exactfold.design.actuation.hinges import MODEL
from exactfold.exact.numbers import decimal_above, decimal_below, decimal_near

if TYPE_CHECKING:
    from exactfold.design.actuation.hinges import Hinges
    from exactfold.design.actuation.panels.result import PanelActuation
    from exactfold.design.actuation.result import Bounds

_FIRST = 8
"""The number of ways of the ranking that are shown, unless all are asked for."""
_FOLDS = 24
"""The number of folds that are shown, unless all are asked for."""


def panels_actuation(found: PanelActuation, *, everything: bool = False) -> Group:
    """The torques, what is proved of them, and the ways sorted by power."""
    way, folds = found.way, found.pattern.folds
    kind = "one motion" if way.dimension == 1 else f"a family of dimension {way.dimension}"
    letters = "".join(found.assignment.get(fold, "F") for fold in folds)
    spelled = len(folds) <= SPELLED or everything
    rows: list[tuple[str, str | Text]] = [
        ("status", Text.assemble(status_text(found.status), f" ({found.reason})")),
        ("way", f"{way.number}, {kind}"),
        ("mountain-valley", letters_text(letters) if spelled else in_numbers(letters)),
        (
            "self-foldable",
            Text.assemble(status_text(found.self_foldable), f" ({found.self_foldable_reason})"),
        ),
        ("margin", f"{between(found.margin)}; {_best(found)}"),
        ("power", f"{between(found.power)}; on any rival {between(found.largest_rival)}"),
    ]
    if found.orthogonal is not None:
        share = decimal_above(found.orthogonal.share, 1)
        rows.append(("alone", f"torques that do work on this way only, to within {share}: listed"))
    if not found.driven:
        return Group(facts_table(list(rows)))
    parts: list[Table | Text] = [facts_table(list(rows)), Text("")]
    parts += _torques(found, everything)
    parts += [Text(""), *_ranking(found, everything)]
    return Group(*parts, *model_text(found.hinges))


def model_text(hinges: Hinges | None) -> list[Text]:
    """A line that says what torques in N mm assume, if there are any."""
    return [] if hinges is None else [Text(""), Text(f"Model of the torques in N mm: {MODEL}.")]


def newtons(hinges: Hinges, length: float, torque: Fraction) -> list[str]:
    """The length of a fold in mm and its torque in N mm."""
    return [f"{length:.4g}", f"{float(hinges.stiffness) * length * float(torque):.4g}"]


def between(bounds: Bounds) -> str:
    """Bounds as decimals: one number where they agree."""
    low, high = (decimal_below(bounds[0], 6), decimal_above(bounds[1], 6))
    return low if low == high else f"from {low} to {high}"


def _best(found: PanelActuation) -> str:
    most = decimal_above(found.bound, 6)
    if found.given:
        return f"with torques of this size at most {most} is possible"
    if found.creases is not None:
        return f"on {counted(found.creases, 'crease')} at most {most} is possible"
    return f"at most {most} is possible"


def _torques(found: PanelActuation, everything: bool) -> list[Table | Text]:
    """The driven folds, the one first without which the margin is the least."""
    table = Table(box=None, pad_edge=False)
    table.add_column("crease")
    table.add_column("letter")
    table.add_column("torque", justify="right")
    hinges = found.hinges
    if hinges is not None:
        table.add_column("mm", justify="right")
        table.add_column("N mm", justify="right")
        lengths = hinges.lengths(found.pattern)
    alone = {} if found.orthogonal is None else found.orthogonal.torques
    if alone:
        table.add_column("on this way only", justify="right")
    table.add_column("without it at most", justify="right")
    listed = [fold for fold in found.without if found.torques[fold] or alone.get(fold)]
    listed += [fold for fold in found.driven if fold not in found.without]
    shown = listed if everything else listed[:_FOLDS]
    for fold in shown:
        torque = found.torques[fold]
        row: list[str | Text] = [
            f"{fold[0]}-{fold[1]}",
            letters_text(found.assignment.get(fold, "F")),
            decimal_near(torque, 12),
        ]
        if hinges is not None:
            row += newtons(hinges, lengths[fold], torque)
        if alone:
            row.append(decimal_near(alone[fold], 6))
        without = found.without.get(fold)
        row.append("" if without is None else decimal_above(max(without, Fraction(0)), 6))
        table.add_row(*row)
    return [table, *more_text(len(listed) - len(shown))]


def _ranking(found: PanelActuation, everything: bool) -> list[Text | Table]:
    table = Table(box=None, pad_edge=False)
    table.add_column("place", justify="right")
    table.add_column("way", justify="right")
    table.add_column("dimension", justify="right")
    table.add_column("power", justify="right")
    table.add_column("note")
    rows = list(zip(found.ranking, found.above_next, strict=True))
    shown = rows if everything else rows[:_FIRST]
    for place, (row, above) in enumerate(shown, 1):
        notes = [] if above else ["not proved to exceed the next one"]
        notes += ["turned over"] if row.side < 0 else []
        middle = (row.power[0] + row.power[1]) / 2
        table.add_row(
            str(place),
            str(row.number),
            str(row.dimension),
            decimal_near(middle, 6),
            "; ".join(notes),
        )
    return [table, *more_text(len(rows) - len(shown))]
