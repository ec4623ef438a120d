"""What is known for the digits of an inexact drawing, beside the sheet that was meant."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING, cast

from rich.text import Text

from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.app.report.terminal import status_text
from exactfold.branches.values.result import BranchCount
from exactfold.exact.numbers import decimal_above

if TYPE_CHECKING:
    from exactfold.panels.count_document import OfDigits
    from exactfold.panels.result import Decomposition, Proposal

_SHEETS = {
    "as written": "the digits as written: ",
    "as read": "the coordinates as they were read: ",
    "inferred": "the digits of the inferred sheet: ",
}


def proposal_lines(proposal: Proposal) -> list[Text]:
    """The sheet that may have been meant, and what is known of it."""
    missed, distance = (
        decimal_above(Fraction(repr(x)), 2) for x in (proposal.missed, proposal.distance)
    )
    first = (
        f"a proposal (--noise {proposal.noise:g}): within {distance} of the drawing there is a "
        f"sheet with {proposal.relations} relations that it misses by up to {missed} of its size; "
        "nothing proves that it was meant"
    )
    if proposal.others:
        others = ", ".join(f"{other:g}" for other in proposal.others)
        first += f"; --noise {others} gives another sheet"
    answer, said = proposal.answer, "of that sheet: "
    if isinstance(answer, BranchCount):
        from exactfold.app.report.count import answer as counted_answer

        return [Text(first), Text.assemble(said, counted_answer(replace(answer, meant=None)))]
    from exactfold.app.report.panels import known_lines, panels_answer

    panels = replace(cast("Decomposition", answer), meant=None)
    if panels.second_order is not None or panels.rigid is PROVED:
        text = Text.assemble(said, panels_answer(panels))
        if panels.rigid is PROVED:
            text.append("; a loop of folds that was meant to close may miss by the noise")
        return [Text(first), text]
    known = known_lines(panels) or [f"the number of ways is UNDECIDED: {panels.reason}"]
    return [Text(first), *(Text(said + line) for line in known)]


def digits_line(result: OfDigits) -> Text:
    """The answer for the digits of a drawing, in one sentence."""
    which = result.of_digits()["sheet"]
    end = " (--snap exact)" if which == "as written" else ""
    if isinstance(result, BranchCount):
        from exactfold.app.report.count import answer

        said = answer(replace(result, meant=None))
        known = result.status is not UNDECIDED
    else:
        from exactfold.app.report.panels import panels_answer

        panels = cast("Decomposition", result)
        said = panels_answer(replace(panels, meant=None))
        known = panels.status is PROVED or panels.rigid is PROVED
        if not known and panels.freedom is not None:
            freedom = Text(f"{panels.freedom.text} - PROVED")
            return Text.assemble(_SHEETS[which], freedom, "; no more is known", end)
    if not known:
        return Text.assemble(_SHEETS[which], "the number of ways is ", status_text(UNDECIDED), end)
    return Text.assemble(_SHEETS[which], said, end)
