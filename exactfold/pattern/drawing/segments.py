"""Makes a drawing of loose straight lines, and describes a drawing in one line."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Final, TypeAlias

from exactfold._support.plurals import counted
from exactfold.errors import MalformedDrawingError
from exactfold.pattern.drawing.drawing import Drawing, Line

Place: TypeAlias = tuple[Fraction, Fraction]
Segment: TypeAlias = tuple[Place, Place, str]

KINDS: Final = {
    "M": "mountain",
    "V": "valley",
    "B": "boundary",
    "F": "flat",
    "U": "unassigned",
    "C": "cut",
    "J": "join",
}
"""The letters in words, in the order in which they are listed."""


def drawing_of(segments: Iterable[Segment], source: str, remarks: Sequence[str] = ()) -> Drawing:
    """The drawing of straight lines between places; equal places become one point.

    Lines of length zero are left out with a remark. Raises `MalformedDrawingError` if no line
    remains.

    >>> zero, one = Fraction(0), Fraction(1)
    >>> drawing_of([((zero, zero), (one, zero), "B"), ((one, zero), (one, one), "M")], "CP").lines
    (Line(start=0, end=1, letter='B'), Line(start=1, end=2, letter='M'))
    """
    numbers: dict[Place, int] = {}
    lines = []
    empty = 0
    for start, end, letter in segments:
        if start == end:
            empty += 1
            continue
        i, j = (numbers.setdefault(place, len(numbers)) for place in (start, end))
        lines.append(Line(i, j, letter))
    notes = [*remarks, *left_out(empty, "empty line")]
    if not lines:
        why = f" ({'; '.join(notes)})" if notes else ""
        raise MalformedDrawingError(f"the {source} file has no lines of a crease pattern{why}")
    return Drawing(tuple(numbers), tuple(lines), source, tuple(notes))


def boxed(drawing: Drawing) -> Drawing:
    """The drawing with the rectangle round its lines as boundary lines, and a remark.

    >>> drawn = boxed(Drawing(((0, 0), (2, 1), (9, 9)), (Line(0, 1, "M"),), "CP"))
    >>> drawn.points[3:], drawn.lines[1], drawn.remarks
    (((0, 0), (2, 0), (2, 1), (0, 1)), Line(start=3, end=4, letter='B'),
    ('the rectangle round the drawing, 2 x 1, is taken for the edge of the paper',))
    """
    used = [drawing.points[v] for line in drawing.lines for v in line[:2]]
    if not used:
        return drawing
    (left, right), (low, high) = ((min(c), max(c)) for c in zip(*used, strict=True))
    n = len(drawing.points)
    corners = ((left, low), (right, low), (right, high), (left, high))
    rim = tuple(Line(n + k, n + (k + 1) % 4, "B") for k in range(4))
    remark = (
        f"the rectangle round the drawing, {float(right - left):.6g} x {float(high - low):.6g}, is "
        "taken for the edge of the paper"
    )
    return replace(
        drawing,
        points=drawing.points + corners,
        lines=drawing.lines + rim,
        remarks=(*drawing.remarks, remark),
    )


def left_out(number: int, noun: str) -> list[str]:
    """A list with the remark that some things were left out; empty if `number` is 0.

    >>> left_out(2, "auxiliary line"), left_out(0, "auxiliary line")
    (['left out 2 auxiliary lines'], [])
    """
    return [f"left out {counted(number, noun)}"] if number else []


def summary(drawing: Drawing) -> str:
    """The number of lines of a drawing, by kind, in words.

    >>> zero, one = Fraction(0), Fraction(1)
    >>> summary(Drawing(((zero, zero), (one, one)), (Line(0, 1, "M"), Line(0, 1, "B")), ""))
    '2 lines (1 mountain, 1 boundary)'
    """
    numbers = Counter(line.letter for line in drawing.lines)
    kinds = ", ".join(f"{numbers[letter]} {KINDS[letter]}" for letter in KINDS if numbers[letter])
    return f"{counted(len(drawing.lines), 'line')} ({kinds})"
