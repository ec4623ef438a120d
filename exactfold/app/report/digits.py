"""What is known for the digits of an inexact drawing, beside the sheet that was meant."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, cast

from rich.text import Text

from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.app.report.terminal import status_text
from exactfold.branches.values.result import BranchCount

if TYPE_CHECKING:
    from exactfold.panels.count_document import OfDigits
    from exactfold.panels.result import Decomposition

_SHEETS = {
    "as written": "the digits as written: ",
    "as read": "the coordinates as they were read: ",
    "inferred": "the digits of the inferred sheet: ",
}


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
        known = panels.second_order is not None or panels.rigid is PROVED
        if not known and panels.freedom is not None:
            freedom = Text(f"{panels.freedom.text} - PROVED")
            return Text.assemble(_SHEETS[which], freedom, "; no more is known", end)
    if not known:
        return Text.assemble(_SHEETS[which], "the number of ways is ", status_text(UNDECIDED), end)
    return Text.assemble(_SHEETS[which], said, end)
