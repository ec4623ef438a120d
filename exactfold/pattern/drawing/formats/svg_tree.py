"""Reduces an SVG file to the few elements and attributes of a drawing, within limits.

Styles become attributes. `svg_groups` resolves groups, transforms and `use` of the reduced tree.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final, NoReturn, TypeAlias
from xml.etree.ElementTree import Element

from exactfold.checker.core.limits import (
    MOST_DEPTH,
    MOST_SELECTORS,
    MOST_TEXT,
    MOST_TRANSFORMS,
    MOST_USED,
)
from exactfold.errors import MalformedDrawingError, TooLargeError
from exactfold.exact.numbers import shown

NAMESPACE: Final = "http://www.w3.org/2000/svg"
NUMBER: Final = "exactfold"
"""The attribute that holds the number of an element."""
_DROPPED: Final = ("style", "text", "tspan", "title", "desc", "image", "metadata", "script")
LINK: Final = "{http://www.w3.org/1999/xlink}href"
MEANING: Final = "exactfold-meaning"
"""The attribute that holds the letter which the name of an element or its group stands for."""
INHERITED: Final = (
    "stroke",
    "stroke-dasharray",
    "stroke-width",
    "color",
    "visibility",
    "opacity",
    "stroke-opacity",
    MEANING,
)
"""What holds for an element holds for everything inside it."""
_STYLED: Final = (*INHERITED[:-1], "display", "transform")
_KEPT: Final = ("id", *_STYLED)
_NAME: Final = re.compile(
    r"(mountain|valley|boundar(?=y|ies)|border|outline|cut|unassigned)"
    r"(y|ies|s)?([-_ ]?(fold|crease|line)s?)?([-_ ]?[0-9]*_?)\Z"
)
_LABEL: Final = "{http://www.inkscape.org/namespaces/inkscape}label"
_MEANT: Final = {
    **{"mountain": "M", "valley": "V", "boundar": "B", "border": "B", "outline": "B"},
    **{"cut": "C", "unassigned": "U"},
}
_COMPOUND: Final = re.compile(r"(\*|[\w-]+)?((?:[.#][\w-]+)*)\Z")
_SINGLE: Final = re.compile(r"([.#]?[\w-]+|[\w-]+\.[\w-]+|\*)\Z")
_MARK: Final = re.compile(r"[.#][\w-]+")
_Simple: TypeAlias = frozenset[str]
_PLACED: Final = ("x", "y", "width", "height")
_OF_TAG: Final = {
    "svg": (*_PLACED, "viewBox", "preserveAspectRatio"),
    "use": (*_PLACED, "href", LINK),
    "rect": ("width", "height"),
    "circle": ("r",),
    "ellipse": ("rx", "ry"),
}
"""Other attributes that `svg_groups` needs, by element."""
_MOVE: Final = 32
"""So many characters, at most, are added around the numbers by which `use` moves."""


@dataclass(frozen=True)
class _Cost:
    """The size of an element, including everything that `use` brings in."""

    elements: int = 1
    depth: int = 1
    transforms: int = 0  # characters, counted once for each element that they apply to
    longest: int = 0  # characters of all transforms that apply to one element


def plain_tree(root: Element) -> tuple[Element, list[Mapping[str, str]]]:
    """The tree without the parts that are not read, and the attributes of its elements as written.

    The attribute `NUMBER` of an element is its position among the attributes. Styles have become
    attributes.

    Raises `TooLargeError` if nesting, repetition by `use` or text exceeds the limits, and
    `MalformedDrawingError` for a `use` that refers to itself.
    """
    styles = _Styles("".join(e.text or "" for e in root.iter() if tag_of(e) == "style"))
    given: list[Mapping[str, str]] = []
    plain = _alone(root, styles, (), given)
    waiting: list[tuple[Element, Element, tuple[Element, ...]]] = [(root, plain, (root,))]
    while waiting:
        element, copy, above = waiting.pop()
        if len(above) > MOST_DEPTH:
            _too_deep()
        inside = [child for child in element if tag_of(child) not in _DROPPED]
        copy.extend([_alone(child, styles, above, given) for child in inside])
        waiting += [(a, b, (*above, a)) for a, b in zip(inside, copy, strict=True)]
    _check_cost(plain)
    return plain, given


def tag_of(element: Element) -> str:
    """The tag of an element, without the namespace of SVG."""
    return element.tag.removeprefix(f"{{{NAMESPACE}}}")


def _alone(
    element: Element, styles: _Styles, above: Sequence[Element], given: list[Mapping[str, str]]
) -> Element:
    """A copy of an element without its children; its attributes are appended to `given`.

    `above` are the elements round it, the outermost first.
    """
    tag, own = tag_of(element), dict(element.attrib)
    own |= styles.of(element, above)
    own |= _declarations(own.get("style", ""))
    kept = {key: own[key] for key in (*_KEPT, *_OF_TAG.get(tag, ())) if key in own}
    for key, text in kept.items():
        if len(text) > MOST_TEXT:
            raise TooLargeError(
                f"an attribute ({key.rpartition('}')[2]}) of an SVG element {shown(tag)} has "
                f"{len(text)} characters, but at most {MOST_TEXT} are read: shorten it"
            )
    names = [*own.get("class", "").split(), own.get("id", ""), own.get(_LABEL, "")]
    matches = [match for name in names if (match := _NAME.match(name.strip().lower()))]
    if matches:
        kept[MEANING] = _MEANT[matches[0][1]]
    given.append(own)
    return Element(element.tag, kept | {NUMBER: str(len(given) - 1)})


class _Styles:
    """The declarations of a style sheet.

    For one element, those of `*` come first, then those of its tag, its id and its classes, then
    those of selectors with several parts (`line.red`, `.fold.far`, `#folds > .red`), in their
    order. Selectors with attributes or pseudo-classes are not read.
    """

    def __init__(self, text: str) -> None:
        first, *others = text.split("/*")
        text = first + "".join(part.partition("*/")[2] for part in others)
        text = "\n".join(line.partition("//")[0] for line in text.split("\n"))
        self._single: dict[str, dict[str, str]] = {}
        self._compound: list[tuple[tuple[_Simple, ...], Mapping[str, str]]] = []
        self._by_mark: dict[str, list[int]] = {}
        for rule in text.split("}"):
            selectors, _, body = rule.partition("{")
            if declared := _declarations(body):
                for selector in selectors.split(","):
                    self._add(selector.strip(), declared)

    def _add(self, selector: str, declared: Mapping[str, str]) -> None:
        self._single.setdefault(selector, {}).update(declared)
        words = selector.replace(">", " ").split()
        parts = tuple(match for word in words if (match := _simple(word)))
        if len(parts) == len(words) > 0 and not _SINGLE.match(selector):
            mark = max(parts[-1], default="")
            self._by_mark.setdefault(mark, []).append(len(self._compound))
            self._compound.append((parts, declared))
            if len(self._compound) > MOST_SELECTORS:
                raise TooLargeError(
                    f"the style sheet of the SVG file has more than {MOST_SELECTORS} selectors "
                    "with several parts: give lines their colours as attributes"
                )

    def of(self, element: Element, above: Sequence[Element]) -> dict[str, str]:
        """The declarations that hold for an element inside the elements `above`."""
        declared: dict[str, str] = {}
        own = _marks(element)
        for key in ("*", tag_of(element), f"#{element.get('id')}"):
            declared |= self._single.get(key, {})
        for name in element.get("class", "").split(" "):
            declared |= self._single.get(f".{name}", {})
            declared |= self._single.get(f"{tag_of(element)}.{name}", {})
        for k in sorted(k for mark in ("", *own) for k in self._by_mark.get(mark, ())):
            (*outer, last), found = self._compound[k]
            if last <= own and _are_round(outer, above):
                declared |= found
        return declared


def _simple(text: str) -> _Simple | None:
    """The tag, id and classes of one part of a selector; None if it has anything else."""
    match = _COMPOUND.match(text)
    if match is None:
        return None
    tag = {match[1]} if match[1] and match[1] != "*" else set()
    return frozenset(tag | set(_MARK.findall(match[2])))


def _marks(element: Element) -> _Simple:
    """The tag, id and classes of an element, as in a selector."""
    classes = {f".{name}" for name in element.get("class", "").split()}
    return frozenset({tag_of(element), f"#{element.get('id')}"} | classes)


def _are_round(parts: Sequence[_Simple], above: Sequence[Element]) -> bool:
    """Whether elements that fit the parts of a selector lie inside each other, in this order."""
    waiting = iter(above)
    return all(any(part <= _marks(element) for element in waiting) for part in parts)


def _declarations(text: str) -> dict[str, str]:
    """The values that a style declares for the attributes that are read."""
    pairs = (part.split(":") for part in text.split(";"))
    stated = {pair[0].strip(): pair[1].strip() for pair in pairs if len(pair) == 2}
    return {key: stated[key] for key in _STYLED if key in stated}


# --- what `use` brings in ------------------------------------------------------------------------


def _check_cost(root: Element) -> None:
    """Raises an error if `use` forms a circle, or for too much nesting, repetition, transforms."""
    named = {e.get("id"): e for e in root.iter() if e.get("id")}
    costs: dict[Element, _Cost | None] = {}
    waiting = [root]
    while waiting:
        element = waiting[-1]
        inside = list(element)
        link = element.get("href", element.get(LINK, "")) if tag_of(element) == "use" else ""
        if link and link[1:] in named:
            inside.append(named[link[1:]])
        if element not in costs:
            costs[element] = None  # under way
            for child in inside:
                if child not in costs:
                    waiting.append(child)
                elif costs[child] is None:
                    raise MalformedDrawingError(
                        f"the `use` of {shown(link)} lies inside its own target: remove it"
                    )
            continue
        waiting.pop()
        if costs[element] is None:
            costs[element] = _cost(element, [cost for c in inside if (cost := costs[c])])
    total = costs[root] or _Cost()
    repeated = total.elements - len(costs)
    if total.depth > MOST_DEPTH:
        _too_deep()
    if repeated > MOST_USED:
        raise TooLargeError(
            f"`use` repeats {repeated} elements of the SVG file, but at most {MOST_USED} are read: "
            "draw the lines themselves"
        )
    if total.longest > MOST_TEXT or total.transforms > MOST_TRANSFORMS:
        raise TooLargeError(
            f"the transforms of the SVG file are too long: {total.longest} characters for one "
            f"element and {total.transforms} for all, but at most {MOST_TEXT} and "
            f"{MOST_TRANSFORMS} are read: apply them to the coordinates"
        )


def _cost(element: Element, inside: list[_Cost]) -> _Cost:
    own = len(element.get("transform", ""))
    if tag_of(element) == "use":
        own += len(element.get("x", "")) + len(element.get("y", "")) + _MOVE
    elements = 1 + sum(cost.elements for cost in inside)
    return _Cost(
        elements,
        1 + max((cost.depth for cost in inside), default=0),
        own * elements + sum(cost.transforms for cost in inside),
        own + max((cost.longest for cost in inside), default=0),
    )


def _too_deep() -> NoReturn:
    raise TooLargeError(
        f"elements of the SVG file are nested more than {MOST_DEPTH} deep, which is not read: "
        "ungroup them"
    )
