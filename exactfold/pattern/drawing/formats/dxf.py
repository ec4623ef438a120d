"""Reads DXF drawings of CAD and origami programs: lines with layers and colours as letters."""

from __future__ import annotations

import io
import math
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Final
from unicodedata import normalize

from exactfold._support.plurals import counted
from exactfold.checker.core.limits import MOST_DEPTH, MOST_LINES
from exactfold.errors import (
    ExactfoldError,
    FoldedStateError,
    MalformedDrawingError,
    PackageMissingError,
    TooLargeError,
)
from exactfold.exact.numbers import shown
from exactfold.pattern.drawing.drawing import LETTERS, Drawing, Loud, SvgReading
from exactfold.pattern.drawing.formats.svg_path import check_chords
from exactfold.pattern.drawing.formats.svg_strokes import Stroke, lettered
from exactfold.pattern.drawing.segments import Place, drawing_of

if TYPE_CHECKING:
    from ezdxf.document import Drawing as Document

_WORDS: Final = {
    "": "aux|hilf|guide|construct|defpoints|text|dimension|補助",
    "M": "mountain|mtn|berg(?![a-z])|bergfalt|montagne|montana|montanha|monte(?![a-z])|гор|山",
    "V": "valley|tal(?![a-z])|talfalt|vallee|valle|vale(?![a-z])|долин|谷",
    "B": "border|bound|edge|outline|contour|cut ?line|rand(?![a-z])|umriss|bord|kontur|frame|paper|"
    "sheet|границ|кра|輪郭|用紙",
    "C": "cut|schnitt|coupe|corte|taglio|рез|切",
    "F": "flat(?![a-z])|facet",
    "U": "crease|fold|falt|pli|pieg|plieg|dobra|unassigned|сгиб|折",
}
"""Beginnings of words in the names of layers, by letter; the first letter with such a word wins."""
_LAYERS: Final = {
    letter: re.compile(rf"(?:^|[^a-zа-я])(?:{words})") for letter, words in _WORDS.items()
}
_OWN: Final = ("CutLine", "MountainLine", "ValleyLine")
"""The layers of ORIPA, Orihime and Oriedita, which need no remark."""
_CLEAR: Final = {
    **{"B": "#000000", "M": "#ff0000", "V": "#0000ff"},
    **{"C": "#00ff00", "F": "#ffff00", "U": "#ff00ff", "": "#808080"},
}
_STYLES: Final = (("dashdot", "6 2 1 2"), ("center", "6 2 1 2"), ("dot", "1 3"), ("dash", "3 2"))
_STYLES_MORE: Final = (("divide", "6 2 1 2"), ("phantom", "6 2 1 2"), ("hidden", "3 2"))
"""Line types by a part of their names, as dashes of SVG."""
_CURVES: Final = ("ARC", "CIRCLE", "ELLIPSE", "SPLINE")
_SHOWN: Final = 5
_FLAT: Final = 1e-9


@dataclass
class _Found:
    """The strokes of a file, the entities that are not read, and the heights of the lines."""

    chords: int
    curves: int = 0
    strokes: list[Stroke] = field(default_factory=list)
    layers: list[str] = field(default_factory=list)
    omitted: Counter[str] = field(default_factory=Counter)
    heights: list[float] = field(default_factory=list)


def read_dxf(text: str, reading: SvgReading | None = None) -> Drawing:
    """The drawing in a DXF file: straight lines of its model space, with letters.

    Lines, polylines and the blocks that are inserted are read. The name of a layer gives the letter
    if it contains a word such as mountain, valley, border or cut, in several languages; otherwise
    the colour does, as in SVG files, where white is black. `reading.colours` gives letters to
    layers and colours, and `reading.dashes` to line types. Layers that are frozen or off, and
    lines on layers for construction, are left out. Numbers are the decimals of the file, up to the
    precision of floats; only the transforms of blocks round.

    Raises `PackageMissingError` without the package ezdxf, `MalformedDrawingError` for a damaged
    file, a file without lines, and for curves if `reading.chords` is not given, `FoldedStateError`
    for lines that do not lie in a plane z = constant, and `TooLargeError`.

    >>> line = "0\\nLINE\\n8\\nMountainLine\\n10\\n0.1\\n20\\n0\\n11\\n3\\n21\\n4\\n"
    >>> drawing = read_dxf(f"0\\nSECTION\\n2\\nENTITIES\\n{line}0\\nENDSEC\\n0\\nEOF\\n")
    >>> drawing.points[0], drawing.lines[0].letter
    ((Fraction(1, 10), Fraction(0, 1)), 'M')
    """
    reading = reading or SvgReading()
    found = _Found(reading.chords or 1)
    with _damage():
        document = _document(text)
        for name, entity in _entities(document, found.omitted):
            _take(found, document, name, entity)
    _check_flat(found.heights)
    letters, remarks = _letters(found, reading)
    drawn = [(stroke, x) for stroke, x in zip(found.strokes, letters, strict=True) if x]
    remarks += _curves([stroke for stroke, _ in drawn], reading.chords)
    left = [f"left out {counted(n, 'element')} {why}" for why, n in sorted(found.omitted.items())]
    segments = [(*ends, letter) for stroke, letter in drawn for ends in stroke.lines]
    return drawing_of(segments, "DXF", left + remarks)


def _document(text: str) -> Document:
    try:
        import ezdxf
    except ModuleNotFoundError:
        raise PackageMissingError(
            "DXF files need ezdxf, which is not installed: pip install 'exactfold[dxf]'"
        ) from None
    return ezdxf.read(io.StringIO(text.replace("\r\n", "\n")))  # type: ignore[attr-defined]


@contextmanager
def _damage() -> Iterator[None]:
    """Turns the errors of the library, which are of many kinds, into `MalformedDrawingError`."""
    try:
        yield
    except (ExactfoldError, MemoryError):
        raise
    except Exception as error:
        reason = " ".join(str(error).split()) or type(error).__name__
        raise MalformedDrawingError(
            f"the DXF file is damaged: {reason}; save it again as an ASCII DXF file"
        ) from None


def _entities(document: Any, omitted: Counter[str]) -> Iterator[tuple[str, Any]]:
    """The visible entities with their names, those of inserted blocks instead of the inserts."""
    seen: Counter[str] = Counter()
    waiting: list[tuple[Iterator[Any], int]] = [(iter(document.modelspace()), 0)]
    passed = 0
    while waiting:
        entities, depth = waiting[-1]
        entity = next(entities, None)
        if entity is None:
            waiting.pop()
            continue
        passed += 1
        if passed > MOST_LINES:
            raise TooLargeError(
                f"the DXF file has more than {MOST_LINES} elements after its blocks are inserted: "
                "leave out what is not a crease"
            )
        kind = entity.dxftype()
        if not _visible(document, entity):
            omitted["on layers that are off or frozen"] += 1
        elif kind != "INSERT":
            seen[kind] += 1
            yield f"{kind} {seen[kind]}", entity
        elif depth >= MOST_DEPTH:
            raise TooLargeError(
                f"blocks are inserted in each other more than {MOST_DEPTH} deep: explode them"
            )
        else:
            copies = entity.multi_insert() if entity.mcount > 1 else [entity]
            waiting.append((_exploded(copies), depth + 1))


def _exploded(inserts: Any) -> Iterator[Any]:
    for insert in inserts:
        yield from insert.virtual_entities()


def _visible(document: Any, entity: Any) -> bool:
    if entity.dxf.get("invisible", 0):
        return False
    name = entity.dxf.layer
    if not document.layers.has_entry(name):
        return True
    layer = document.layers.get(name)
    return not (layer.is_off() or layer.is_frozen())


# --- lines ---------------------------------------------------------------------------------------


def _take(found: _Found, document: Any, name: str, entity: Any) -> None:
    """Add an entity to what was found."""
    kind, layer = entity.dxftype(), str(entity.dxf.layer)
    bent: list[str] = []
    if kind == "LINE":
        places: Sequence[Any] = [entity.dxf.start, entity.dxf.end]
    elif kind == "LWPOLYLINE" or (kind == "POLYLINE" and not entity.is_poly_face_mesh):
        bent = ["a polyline has arcs"] * _arcs(entity)
        found.curves += len(bent)
        places = _sampled(entity, found) if bent else _corners(entity)
    elif kind in _CURVES:
        bent = [f"a curve ({kind.lower()})"]
        found.curves += 1
        places = _sampled(entity, found)
    else:
        found.omitted[f"of the kind {kind}"] += 1
        return
    numbers = [(place.x, place.y, place.z) for place in places]
    if not all(math.isfinite(number) for row in numbers for number in row):
        raise MalformedDrawingError(
            f"{name} on layer {shown(layer)} has a number that is not finite"
        )
    found.heights += [z for _, _, z in numbers]
    exact: list[Place] = [(Fraction(repr(x)), Fraction(repr(y))) for x, y, _ in numbers]
    lines = [(a, b) for a, b in pairwise(exact) if a != b]
    colour, dashes = _style(document, entity)
    found.strokes.append(
        Stroke(f"{name} on layer {shown(layer)}", "", colour, dashes, lines, bent=bent)
    )
    found.layers.append(layer)


def _closed(entity: Any) -> bool:
    return bool(entity.closed if entity.dxftype() == "LWPOLYLINE" else entity.is_closed)


def _arcs(entity: Any) -> int:
    """The number of arcs of a polyline."""
    bulges = (
        [bulge for *_, bulge in entity.get_points("xyb")]
        if entity.dxftype() == "LWPOLYLINE"
        else [vertex.dxf.get("bulge", 0.0) for vertex in entity.vertices]
    )
    return sum(bool(bulge) for bulge in (bulges if _closed(entity) else bulges[:-1]))


def _corners(entity: Any) -> Sequence[Any]:
    """The corners of a polyline without arcs; the first comes again at the end of a closed one."""
    lightweight = entity.dxftype() == "LWPOLYLINE"
    places = list(entity.vertices_in_wcs() if lightweight else entity.points_in_wcs())
    return [*places, *places[:1]] if _closed(entity) else places


def _sampled(entity: Any, found: _Found) -> Sequence[Any]:
    """Points of a curve; each of its arcs has as many chords as `found` says."""
    from ezdxf.path import make_path

    check_chords(found.curves, found.chords)
    return list(make_path(entity).approximate(found.chords))


def _check_flat(heights: Sequence[float]) -> None:
    low, high = min(heights, default=0.0), max(heights, default=0.0)
    if high - low > _FLAT * max(1.0, abs(low), abs(high)):
        raise FoldedStateError(
            f"the lines do not lie in a plane: z goes from {low:g} to {high:g}; give the crease "
            "pattern in a plane z = constant"
        )


def _curves(strokes: Sequence[Stroke], chords: int | None) -> list[str]:
    """The remark on curves; raises `MalformedDrawingError` if there are no chords for them."""
    bent = [stroke for stroke in strokes if stroke.bent]
    if not bent:
        return []
    number = sum(len(stroke.bent) for stroke in bent)
    names = ", ".join(stroke.name for stroke in bent[:_SHOWN])
    more = f", ... {len(bent) - _SHOWN} more" if len(bent) > _SHOWN else ""
    if chords is None:
        raise MalformedDrawingError(
            f"{bent[0].name}: {bent[0].bent[0]}; creases must be straight, and the drawing has "
            f"{counted(number, 'curve')} ({names}{more}): `--chords 8` reads each of their arcs as "
            "8 straight lines, and the answer is about that sheet"
        )
    return [
        f"read {counted(number, 'curve')} ({names}{more}) as {counted(chords, 'chord')} for each "
        "arc: all answers are about the sheet with these straight lines and rigid panels, not "
        "about the curved one"
    ]


# --- letters -------------------------------------------------------------------------------------


def _letters(found: _Found, reading: SvgReading) -> tuple[list[str], list[str]]:
    """The letter of each stroke, empty if it is left out, and remarks."""
    names = {normalize("NFKC", layer).casefold() for layer in found.layers}
    stated = {
        normalize("NFKC", k).strip().casefold(): v for k, v in (reading.colours or {}).items()
    }
    by_layer = {key: letter for key, letter in stated.items() if key in names}
    others = {key: letter for key, letter in stated.items() if key not in names}
    strokes, remarks = [], Counter[tuple[str, str]]()
    for stroke, layer in zip(found.strokes, found.layers, strict=True):
        key = normalize("NFKC", layer).casefold()
        letter = by_layer.get(key, layer_letter(layer))
        if letter is not None:
            remarks[layer, letter] += len(stroke.lines)
            stroke = replace(stroke, colour=_CLEAR.get(letter, "#ff00ff"))
        strokes.append(stroke)
    letters, notes = lettered(strokes, replace(reading, colours=others or None))
    said = [
        f"{counted(number, 'line')} of the layer {shown(layer)} read as {letter}"
        if letter
        else Loud(f"{counted(number, 'line')} of the layer {shown(layer)} left out")
        for (layer, letter), number in remarks.items()
        if layer not in _OWN
    ]
    return letters, said + notes


def layer_letter(layer: str) -> str | None:
    """The letter of a layer by its name: empty for construction lines, None for other names.

    >>> [layer_letter(name) for name in ("MountainLine", "valley-folds", "CutLine", "Hilfslinien")]
    ['M', 'V', 'B', '']
    >>> layer_letter("0"), layer_letter("Metal"), layer_letter("山折り"), layer_letter("Vallée")
    (None, None, 'M', 'V')
    """
    name = re.sub("(?<=[a-z])(?=[A-Z])", " ", normalize("NFKD", layer))
    plain = "".join(c for c in name.casefold() if not "\u0300" <= c <= "\u036f")
    if plain.strip().upper() in tuple(LETTERS):
        return plain.strip().upper()
    return next((letter for letter, words in _LAYERS.items() if words.search(plain)), None)


def _style(document: Any, entity: Any) -> tuple[str, str]:
    """The colour of an entity, and its line type as dashes; white is black."""
    from ezdxf import colors

    name = entity.dxf.layer
    layer = document.layers.get(name) if document.layers.has_entry(name) else None
    true, index = entity.rgb, entity.dxf.get("color", colors.BYLAYER)
    style = str(entity.dxf.get("linetype", "BYLAYER"))
    if layer is not None and true is None and index == colors.BYLAYER:
        true, index = layer.rgb, abs(layer.dxf.get("color", 7))
    if layer is not None and style.upper() == "BYLAYER":
        style = str(layer.dxf.get("linetype", ""))
    known = true or (colors.aci2rgb(index) if 0 < index < colors.BYLAYER else (0, 0, 0))
    rgb = (0, 0, 0) if tuple(known) == (255, 255, 255) else known
    marks = (dashes for part, dashes in _STYLES + _STYLES_MORE if part in style.casefold())
    return "#{:02x}{:02x}{:02x}".format(*rgb), next(marks, "")
