"""Drawings as sets of lines between places, and as files of every format."""

from __future__ import annotations

import json
from fractions import Fraction

from exactfold.pattern.drawing.drawing import Drawing

SQUARE = [
    (("0", "0"), ("1", "0"), "B"),
    (("1", "0"), ("1", "1"), "B"),
    (("1", "1"), ("0", "1"), "B"),
    (("0", "1"), ("0", "0"), "B"),
    (("0", "0"), ("0.5", "0.1"), "M"),
    (("0.5", "0.1"), ("1", "1"), "V"),
]
"""A square with two creases, numbers as text."""

_TYPES = {"B": "1", "M": "2", "V": "3"}
_COLOURS = {"B": "black", "M": "#f00", "V": "#0000FF"}


def places(lines) -> set:
    return {
        (frozenset(tuple(map(Fraction, place)) for place in ends), letter)
        for *ends, letter in lines
    }


def drawn(drawing: Drawing) -> set:
    """The lines of a drawing as sets of two places with a letter."""
    points = drawing.points
    return {(frozenset((points[i], points[j])), letter) for i, j, letter in drawing.lines}


def as_fold(lines, **more) -> str:
    vertices = sorted({place for *ends, _ in lines for place in ends})
    coords = ", ".join(f"[{x}, {y}]" for x, y in vertices)
    edges = [[vertices.index(a), vertices.index(b)] for a, b, _ in lines]
    rest = {"edges_vertices": edges, "edges_assignment": [line[2] for line in lines], **more}
    return f'{{"vertices_coords": [{coords}], {json.dumps(rest)[1:]}'


def as_cp(lines) -> str:
    return "\n".join(f"{_TYPES[c]} {a[0]} {a[1]} {b[0]} {b[1]}" for a, b, c in lines)


def as_opx(lines) -> str:
    """As Java writes it: properties sorted by name, those that are 0 left out."""
    objects = []
    for a, b, letter in lines:
        numbers = {"x0": a[0], "x1": b[0], "y0": a[1], "y1": b[1]}
        stated = [
            f'<void property="{key}"><double>{number}</double></void>'
            for key, number in numbers.items()
            if Fraction(number)
        ]
        kind = f'<void property="type"><int>{_TYPES[letter]}</int></void>'
        objects.append(f'<object class="oripa.OriLineProxy">{kind}{"".join(stated)}</object>')
    return (
        '<?xml version="1.0" encoding="UTF-8"?><java class="java.beans.XMLDecoder">'
        f'<object class="oripa.DataSet"><void property="lines">{"".join(objects)}</void>'
        "</object></java>"
    )


def as_ori(lines) -> str:
    colours = {"B": "BLACK_0", "M": "RED_1", "V": "BLUE_2"}
    segments = [{"a": ",".join(a), "b": ",".join(b), "color": colours[c]} for a, b, c in lines]
    return json.dumps({"@version": "v1.1", "lineSegments": segments, "circles": []})


def as_orh(lines) -> str:
    rows = ["<タイトル>", "タイトル,_", "<線分集合>"]
    for k, (a, b, letter) in enumerate(lines, 1):
        rows += [f"番号,{k}", f"色,{'BMV'.index(letter)}", f"座標,{','.join(a + b)}"]
    return "\n".join([*rows, "<円集合>", "番号,1", "中心と半径と色,5.0,5.0,2.0,3"])


def as_svg(lines) -> str:
    """With y downwards: the picture of the square as it is seen."""
    elements = [
        f'<line x1="{a[0]}" y1="-{a[1]}" x2="{b[0]}" y2="-{b[1]}" stroke="{_COLOURS[letter]}"/>'
        for a, b, letter in lines
    ]
    return svg("".join(elements))


def svg(content: str, attributes: str = "") -> str:
    return f'<svg xmlns="http://www.w3.org/2000/svg" {attributes}>{content}</svg>'
