"""The vertices that the page marks: each cannot start to fold, or not be folded flat."""

from __future__ import annotations

from typing import Literal, TypedDict

from exactfold._support.documents import Natural
from exactfold._support.verdict import REFUTED, UNDECIDED
from exactfold.app.report.vertices import advice
from exactfold.design.panels.vertex.vertices import vertices
from exactfold.pattern.opening import Opened


class Mark(TypedDict):
    """A vertex to look at: `exactfold vertices` lists it."""

    vertex: Natural
    kind: Literal["refuted", "open", "flat"]
    """It does not start to fold; that is open; or the sheet does not fold flat there."""
    text: str


def marks_of(opened: Opened) -> list[Mark]:
    """The vertices to look at, with the letters of the file, and why."""
    found = vertices(opened)
    marks: list[Mark] = []
    for facts in found.wrong:
        words = "; ".join(advice(found, facts))
        mark: Mark = {"vertex": facts.vertex, "kind": "flat", "text": f"As drawn, {words}"}
        if facts.starts is UNDECIDED:
            mark = {
                **mark,
                "kind": "open",
                "text": f"Whether it can start to fold is open: {words}",
            }
        elif not facts.able:
            mark = {**mark, "kind": "refuted", "text": f"It cannot fold: {words}"}
        elif facts.starts is REFUTED:
            text = f"It cannot start to fold with the letters of the file: {words}"
            mark = {**mark, "kind": "refuted", "text": text}
        elif not words:
            mark["text"] = "It does not fold flat: mountains and valleys do not differ by 2"
        marks.append(mark)
    return marks
