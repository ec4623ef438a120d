"""What is known for the digits of an inexact drawing, beside the sheet that was meant."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.text import Text

from exactfold.branches.values.result import BranchCount

if TYPE_CHECKING:
    from exactfold.panels.result import Decomposition


def digits_line(result: BranchCount | Decomposition) -> Text:
    """The answer for the digits of a drawing, in one sentence."""
    if isinstance(result, BranchCount):
        from exactfold.app.report.count import answer

        said = answer(result)
    else:
        from exactfold.app.report.panels import panels_answer

        said = panels_answer(result)
    if result.read is not None and result.read["largest_move"]:
        return Text.assemble("the coordinates as they were read: ", said)
    return Text.assemble("the digits as written: ", said, " (--snap exact)")
