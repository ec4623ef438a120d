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


_LAYERS = {"B": "CutLine", "M": "MountainLine", "V": "ValleyLine"}


def as_dxf(lines, layers=_LAYERS, **tags) -> str:
    """As Oriedita writes it: lines of R12 on layers, without tables."""
    rows = ["  0", "SECTION", "  2", "ENTITIES"]
    for a, b, letter in lines:
        rows += ["  0", "LINE", "  8", layers[letter]]
        rows += [str(tag) for pair in tags.get(letter, ()) for tag in pair]
        rows += ["10", a[0], "20", a[1], "11", b[0], "21", b[1]]
    return "\n".join([*rows, "  0", "ENDSEC", "  0", "EOF", ""])


def as_tmd5(lines, kinds=(), line_end="\n") -> str:
    """As TreeMaker 5 writes it: a value a row, the tree before the creases; labels can be tags."""
    vertices = sorted({place for *ends, _ in lines for place in ends})
    rows = ["tree", "5.0", *["1.0"] * 3, "false", *["0.0"] * 3, *["true"] * 7]
    rows += ["1", "0", "0", "0", str(len(vertices)), str(len(lines)), "0", "0"]
    rows += ["node", "1", "vrtx", "0.5", "0.5", "crse"]
    for k, (x, y) in enumerate(vertices, 1):
        rows += ["vrtx", str(k), x, y, "0.0", "true", *["0"] * 4, "0.0", "0", "0", "0", "1", "1"]
    for k, (a, b, letter) in enumerate(lines, 1):
        ends = [str(vertices.index(place) + 1) for place in (a, b)]
        kind = kinds[k - 1] if kinds else 0
        rows += ["crse", str(k), str(kind), "2", *ends, "1", "0", str("FMVB".index(letter))]
        rows += ["1", "1", "2", "1"]
    return line_end.join([*rows, "0"])


def as_obj(lines) -> str:
    """A mesh with edges as Freeform Origami writes them."""
    vertices = sorted({place for *ends, _ in lines for place in ends})
    number = {place: k for k, place in enumerate(vertices, 1)}
    rows = ["# a mesh", *(f"v {x} {y} 0" for x, y in vertices)]
    for a, b, letter in lines:
        rows += [f"l {number[a]} {number[b]}"]
        rows += [f"#e {number[a]} {number[b]} {'BMV'.index(letter) + 1} 0"]
    return "\n".join(rows) + "\n"


def svg(content: str, attributes: str = "") -> str:
    return f'<svg xmlns="http://www.w3.org/2000/svg" {attributes}>{content}</svg>'
