"""Tells mountains, valleys and the boundary of an SVG drawing apart by colours and dashes."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from colorsys import rgb_to_hsv
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Final, TypeAlias

from exactfold._support.plurals import counted
from exactfold.errors import NumberError, UsageError
from exactfold.exact.numbers import parse_rational, shown
from exactfold.pattern.drawing.drawing import LETTERS, Loud, SvgReading
from exactfold.pattern.drawing.segments import Place

RGB: TypeAlias = tuple[int, int, int]
Dashes: TypeAlias = tuple[Fraction, ...]

_COLOURS: Final = {
    (0, 0, 0): "B",
    (255, 0, 0): "M",
    (0, 0, 255): "V",
    (0, 255, 0): "C",
    (0, 128, 0): "C",  # the colour that SVG calls green
    (255, 255, 0): "F",
    (255, 0, 255): "U",
}
_HUES: Final = {0: "M", 60: "F", 120: "C", 240: "V", 300: "U", 360: "M"}
_NEAR: Final = 20  # degrees of hue
_SOLID: Final = "solid"
_KINDS: Final = (_SOLID, "dashed", "dash-dotted", "dotted")
_PALE: Final = 0.8
"""Lines of this lightness or more are taken for a grid in the background, not for creases."""
_WITH_COMMAS: Final = re.compile(r"(rgb|hsl)a?\(([^()]*)\)\Z", re.IGNORECASE)
"""Colours are written with commas or, since CSS 4, without them."""


@dataclass(frozen=True)
class Stroke:
    """The lines of one element, with the colour and the dashes of its stroke as written.

    `named` is the letter for which a name of the element or its group stands ("mountains"), if any.
    `unbent` and `bent` are those of `PathLines`. `faint` says that the stroke has an opacity, and
    `fault` why its lines cannot be read.
    """

    name: str
    named: str
    colour: str
    dashes: str
    lines: Sequence[tuple[Place, Place]]
    unbent: int = 0
    bent: Sequence[str] = ()
    faint: bool = False
    fault: Exception | None = None


def lettered(strokes: Sequence[Stroke], reading: SvgReading) -> tuple[list[str], list[str]]:
    """The letter of each stroke, empty if it is left out, and remarks on how letters were found.

    The maps `reading.dashes` and `reading.colours` come first, in this order. Other strokes have
    the letters of the colours of Origami Simulator. Where these say nothing, or only that a line is
    black, a class, id or label such as "mountains" says more, of the element or of a group round
    it. But if neither colour nor name says which lines are creases, then all lines are creases
    without a letter (U), also those in colours that have no meaning. Such lines get letters only if
    some are dashed and others are dash-dotted: by the convention of Yoshizawa and Randlett these
    are valleys and mountains. The outermost lines become the boundary by repair.

    Raises `UsageError` for a colour or dashes in a map that no line has; the message lists those
    that the lines have.
    """
    patterns = [_dashes(stroke.dashes) for stroke in strokes]
    by_dashes = _mapped(
        strokes, [(p, _kind(p)) for p in patterns], reading.dashes, _stated_dashes, "dashes"
    )
    by_map = _mapped(strokes, [(_key(s),) for s in strokes], reading.colours, _rgb, "colours")
    usual = [_usual(stroke.colour) for stroke in strokes]
    named = [
        stroke.named if letter in ("", "B") and not own and stroke.named != letter else ""
        for stroke, (letter, _), own in zip(strokes, usual, by_map, strict=True)
    ]
    letters = [
        own or name or letter for own, name, (letter, _) in zip(by_map, named, usual, strict=True)
    ]
    plain: list[int] = []
    remarks: list[str] = []
    known = {k for k in range(len(strokes)) if by_map[k] or by_dashes[k] or named[k]}
    sure = known | {k for k, (_, exactly) in enumerate(usual) if exactly}
    told = {x for k, x in enumerate(letters) if not by_dashes[k] and (x in ("M", "V") or k in sure)}
    if not {"M", "V", "U"} & told:
        plain = [
            k
            for k, (letter, exactly) in enumerate(usual)
            if k not in known
            and not _pale(strokes[k].colour)
            and (letter in ("", "B") or not exactly)
        ]
        guessed = {} if reading.dashes else _by_convention({k: patterns[k] for k in plain})
        for k in plain:
            letters[k] = guessed.get(k, "U")
        remarks = _one_colour([strokes[k] for k in plain], bool(guessed))
    letters = [own or letter for own, letter in zip(by_dashes, letters, strict=True)]
    sure |= {*plain}
    omitted = Counter(s.colour for s, x in zip(strokes, letters, strict=True) if not x)
    taken = Counter(
        (s.colour, x)
        for k, (s, x) in enumerate(zip(strokes, letters, strict=True))
        if x and k not in sure
    )
    left = [
        Loud(
            f"left out {counted(number, 'element')} of colour {shown(colour)} (`--colours` gives "
            "it a letter)"
        )
        for colour, number in sorted(omitted.items())
    ]
    took = [
        f"took {counted(number, 'element')} of colour {shown(colour)} for {letter}"
        for (colour, letter), number in sorted(taken.items())
    ]
    by_name = Counter(x for k, x in enumerate(letters) if named[k] and not by_dashes[k])
    took += [
        f"took {counted(number, 'element')} for {letter} by the name of their class, id or layer"
        for letter, number in sorted(by_name.items())
    ]
    return letters, left + took + remarks


def _mapped(
    strokes: Sequence[Stroke],
    keys: Sequence[tuple[object, ...]],
    stated: Mapping[str, str] | None,
    parsed: Callable[[str], object],
    what: str,
) -> list[str]:
    """The letter that a map gives to each stroke; empty if it gives none."""
    letters: dict[object, str] = {}
    known = {key for several in keys for key in several}
    for text, letter in (stated or {}).items():
        if letter not in tuple(LETTERS):
            raise UsageError(
                f"--{what}: the letter {shown(letter)} is not one of {', '.join(LETTERS)}"
            )
        key = parsed(text.strip().lower()) or text.strip().lower()
        if key not in known:
            raise UsageError(
                f"--{what}: no line has {shown(text)}; the lines have {_listed(strokes, what)}"
            )
        letters[key] = letter
    return [next((letters[k] for k in several if k in letters), "") for several in keys]


def _listed(strokes: Sequence[Stroke], what: str) -> str:
    """The colours or dashes of strokes with their numbers of lines, the most frequent first."""
    numbers: Counter[object] = Counter()
    texts: dict[object, str] = {}
    for stroke in strokes:
        pattern = _dashes(stroke.dashes)
        key: object = _key(stroke) if what == "colours" else pattern
        numbers[key] += len(stroke.lines)
        texts.setdefault(key, stroke.colour if what == "colours" else _words(pattern))
    return ", ".join(
        f"{texts[key]} ({counted(number, 'line')})" for key, number in numbers.most_common()
    )


# --- one colour ----------------------------------------------------------------------------------


def _by_convention(dashes: Mapping[int, Dashes]) -> dict[int, str]:
    """V for dashed and M for dash-dotted lines if there are lines of both kinds; else nothing."""
    kinds = {k: _kind(pattern) for k, pattern in dashes.items()}
    if not {"dashed", "dash-dotted"} <= set(kinds.values()):
        return {}
    known = {"dashed": "V", "dash-dotted": "M"}
    return {k: known[kind] for k, kind in kinds.items() if kind in known}


def _kind(dashes: Dashes) -> str:
    """How a stroke looks: solid, dashed, dash-dotted or dotted."""
    if not dashes:
        return _SOLID
    marks = dashes[::2]
    if max(marks) >= 2 * min(marks):
        return "dash-dotted"
    return "dotted" if 2 * max(marks) < min(dashes[1::2]) else "dashed"


def _one_colour(strokes: Sequence[Stroke], guessed: bool) -> list[str]:
    """The remark on lines that are creases although no colour says so."""
    if not strokes:
        return []
    numbers: Counter[object] = Counter()
    names: dict[object, str] = {}
    for stroke in strokes:
        pattern = _dashes(stroke.dashes)
        key = (_key(stroke), pattern)
        numbers[key] += len(stroke.lines)
        style = f"{_kind(pattern)} ({_words(pattern)})" if pattern else _SOLID
        names.setdefault(key, f"{style} {stroke.colour}")
    kinds = ", ".join(
        f"{counted(number, 'line')} {names[key]}" for key, number in numbers.most_common()
    )
    how = "creases without a letter"
    if guessed:
        how = f"valleys where dashed, mountains where dash-dotted, else {how}"
    return [
        Loud(
            f"no colour says which lines are mountains or valleys ({kinds}): all are read as "
            f"{how}, except the outermost, which are the boundary (`--colours` and `--dashes` give "
            "letters)"
        )
    ]


# --- colours and dashes --------------------------------------------------------------------------


@lru_cache(1024)
def _rgb(text: str) -> RGB | None:
    """The components of a colour; None for a text that is no colour. Opacity is passed over."""
    from PIL.ImageColor import getrgb  # here: loading it takes longer than reading a pattern

    function = _WITH_COMMAS.match(text.strip())
    if function:
        words = function[2].replace(",", " ").partition("/")[0].split()
        text = f"{function[1]}({','.join(words[:3])})".lower().replace("deg", "")
    try:
        red, green, blue = getrgb(text)[:3]
    except ValueError:
        return None
    return min(red, 255), min(green, 255), min(blue, 255)


@lru_cache(1024)
def _usual(text: str) -> tuple[str, bool]:
    """The letter of a colour (empty if it has none), and whether it is exactly that colour."""
    rgb = _rgb(text)
    if rgb is None:
        return "", False
    if rgb in _COLOURS:
        return _COLOURS[rgb], True
    hue, saturation, value = rgb_to_hsv(*(component / 255 for component in rgb))
    if value < 0.25:
        return "B", False
    near = min(_HUES, key=lambda pure: abs(360 * hue - pure))
    if saturation < 0.5 or abs(360 * hue - near) > _NEAR:
        return "", False
    return _HUES[near], False


def _pale(text: str) -> bool:
    rgb = _rgb(text)
    return rgb is None or min(rgb) >= 255 * _PALE


def _key(stroke: Stroke) -> RGB | str:
    return _rgb(stroke.colour) or stroke.colour


@lru_cache(1024)
def _dashes(text: str) -> Dashes:
    """The lengths of dashes and gaps in turn, an even number of them; () for a solid line."""
    try:
        numbers = [parse_rational(w.removesuffix("px")) for w in text.replace(",", " ").split()]
    except NumberError:
        return ()
    if len(numbers) % 2:
        numbers *= 2
    return tuple(numbers) if any(numbers[1::2]) and min(numbers) >= 0 else ()


def _stated_dashes(text: str) -> Dashes | str:
    """Dashes in a map: the lengths, or the name of a kind."""
    return _SOLID if text == "none" else text if text in _KINDS else _dashes(text)


def _words(dashes: Iterable[Fraction]) -> str:
    return " ".join(f"{float(length):g}" for length in dashes) or _SOLID
