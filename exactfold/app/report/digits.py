"""What is known for the digits of an inexact drawing, beside the sheet that was meant."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, cast

from rich.text import Text

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
    if isinstance(result, BranchCount):
        from exactfold.app.report.count import answer

        said = answer(replace(result, meant=None))
    else:
        from exactfold.app.report.panels import panels_answer

        panels = cast("Decomposition", result)
        said = panels_answer(replace(panels, meant=None))
        if panels.second_order is None and panels.freedom is not None:
            said.append(f"; {panels.freedom.text} - PROVED")
    end = " (--snap exact)" if which == "as written" else ""
    return Text.assemble(_SHEETS[which], said, end)
