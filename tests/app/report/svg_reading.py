"""What an SVG picture holds, read back as XML."""

from __future__ import annotations

from collections import Counter
from functools import cache
from xml.etree import ElementTree

from exactfold.pattern import open_pattern
from exactfold.pattern.data import example_path

NAME = "{http://www.w3.org/2000/svg}"


@cache
def shipped(name):
    """A shipped pattern, read once."""
    return open_pattern(example_path(name))


def tree(text):
    return ElementTree.fromstring(text)


def of_class(text, name):
    return [one for one in tree(text).iter() if one.get("class") == name]


def letters(text):
    """How many lines there are of each letter."""
    found = (one.get("class") for one in tree(text).iter(f"{NAME}path"))
    return Counter(name for name in found if name)


def group_of(text, name):
    """The group of the lines with this letter."""
    (found,) = [g for g in tree(text).iter(f"{NAME}g") if any(p.get("class") == name for p in g)]
    return found


def ends(path):
    """The two ends of a line."""
    numbers = path.get("d").replace("M", "").replace("L", " ").split()
    x1, y1, x2, y2 = map(float, numbers)
    return (x1, y1), (x2, y2)


def words(text):
    return [one.text for one in tree(text).iter(f"{NAME}text")]


def numbered(text, *kinds):
    """The vertices with a number, of these classes."""
    groups = [g for kind in kinds for g in of_class(text, kind)]
    return {int(g.get("data-vertex")) for g in groups if g.find(f"{NAME}text") is not None}
