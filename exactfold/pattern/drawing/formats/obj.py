"""Reads flat `.obj` files: meshes in one plane, as 3D programs and Oriedita write them."""

from __future__ import annotations

from collections import Counter
from fractions import Fraction
from itertools import pairwise
from typing import Final

from exactfold._support.plurals import counted
from exactfold.errors import MalformedDrawingError, NumberError
from exactfold.exact.numbers import parse_rational, parse_whole, shown
from exactfold.pattern.drawing.drawing import Drawing
from exactfold.pattern.drawing.formats.fold_drawing import UNFOLD, check_unfolded, flattened
from exactfold.pattern.drawing.segments import Segment, drawing_of

_COLOURS: Final = {"1": "B", "2": "M", "3": "V"}
"""The letters of edges in comments `#e begin end colour angle`, which Freeform Origami writes."""
_IGNORED: Final = frozenset({"vt", "vn", "vp", "g", "o", "s", "mtllib", "usemtl", "p"})


def read_obj(text: str) -> Drawing:
    """The drawing in an OBJ file whose vertices lie in a plane z, y or x = constant.

    The lines are the sides of faces `f` and the elements `l`. A side of one face is the boundary B.
    Other lines are creases without a letter (U), unless comments `#e begin end colour` give them
    one. Numbers are read exactly. Raises `MalformedDrawingError`, which names the row, and
    `FoldedStateError` for vertices in space and for faces that overlap.

    >>> drawing = read_obj("v 0 0 1\\nv 0.1 0 1\\nv 0 3 1\\nv 0.1 3 1\\nf 1 2 3\\nf 2 4 3\\n")
    >>> drawing.points[1], "".join(line.letter for line in drawing.lines)
    ((Fraction(1, 10), Fraction(0, 1)), 'BUBBB')
    """
    places: list[tuple[Fraction, Fraction, Fraction]] = []
    faces: list[tuple[int, ...]] = []
    loose: list[tuple[int, int]] = []
    stated: dict[tuple[int, int], str] = {}
    others: Counter[str] = Counter()
    for number, row in enumerate(text.splitlines(), 1):
        words = row.split()
        key = words[0] if words else ""
        try:
            if key == "v":
                if len(words) < 4:
                    raise NumberError(f"{shown(row)} does not have three coordinates")
                x, y, z = map(parse_rational, words[1:4])
                places.append((x, y, z))
            elif key in ("f", "l"):
                corners = tuple(_index(word, len(places)) for word in words[1:])
                if len(corners) < (3 if key == "f" else 2):
                    raise NumberError(f"{shown(row)} has {counted(len(corners), 'vertex')}")
                if key == "f":
                    faces.append(corners)
                else:
                    loose += pairwise(corners)
            elif key == "#e" and len(words) >= 4 and words[3] in _COLOURS:
                i, j = (_index(word, len(places)) for word in words[1:3])
                stated[min(i, j), max(i, j)] = _COLOURS[words[3]]
            elif key and not key.startswith("#") and key not in _IGNORED:
                others[key] += 1
        except (NumberError, ValueError) as error:
            raise MalformedDrawingError(f"row {number}: {error}") from None
    if not places:
        raise MalformedDrawingError("the OBJ file has no vertices")
    points, plane, remarks = flattened(places, UNFOLD)
    check_unfolded({}, points, faces, UNFOLD)
    sides: Counter[tuple[int, int]] = Counter()
    for face in faces:
        for i, j in zip(face, [*face[1:], *face[:1]], strict=True):
            sides[min(i, j), max(i, j)] += 1
    letters = {side: "B" if number == 1 else "U" for side, number in sides.items()}
    for i, j in loose:
        letters.setdefault((min(i, j), max(i, j)), "U")
    letters |= {side: letter for side, letter in stated.items() if side in letters}
    segments: list[Segment] = [(points[i], points[j], x) for (i, j), x in letters.items()]
    remarks += [
        f"left out {counted(n, 'element')} {shown(key)}" for key, n in sorted(others.items())
    ]
    if not stated:
        remarks.append("an OBJ file has no mountains and valleys: its creases are unassigned")
    return drawing_of(segments, "OBJ" + plane, remarks)


def _index(word: str, count: int) -> int:
    """The vertex that a word such as 3, 3/1/2 or -1 names, from 0."""
    number = parse_whole(word.partition("/")[0])
    index = number - 1 if number > 0 else count + number
    if number == 0 or not 0 <= index < count:
        raise NumberError(f"there is no vertex {shown(word)} among the first {count}")
    return index
