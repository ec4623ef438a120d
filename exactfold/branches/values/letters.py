"""The alphabet of vertex signs and of mountain-valley letters."""

from __future__ import annotations

from collections.abc import Mapping

LETTERS = {1: "V", -1: "M", 0: "F", None: "U"}
"""The letter of a fold by its sign: valley, mountain, flat, undecided."""

UPSIDE_DOWN = str.maketrans("+-MV", "-+VM")
"""For `str.translate`: signs and letters seen from the other side of the sheet."""

SIGNS = {1: "+", -1: "-", 0: "0"}
"""The sign of a vertex as a character: up, down, flat."""

_VALUES = (*((text, sign) for sign, text in SIGNS.items()), *((sign, sign) for sign in SIGNS))


def sign_value(sign: object) -> int | None:
    """A sign as an integer, from a character or a number; None for anything else.

    >>> sign_value("-"), sign_value(1), sign_value("x")
    (-1, 1, None)
    """
    return next((value for name, value in _VALUES if sign == name), None)


def differing(
    wanted: Mapping[tuple[int, int], str], letters: Mapping[tuple[int, int], str]
) -> tuple[list[tuple[int, int]], list[tuple[int, int]]]:
    """The folds whose letter differs from the wanted one, and those of which this is not known.

    Where "U" is wanted, any letter will do. Where a letter is "U", it is not known.

    >>> differing({(0, 4): "M", (1, 4): "V", (2, 4): "U"}, {(0, 4): "V", (1, 4): "U", (2, 4): "M"})
    ([(0, 4)], [(1, 4)])
    """
    other = [f for f, letter in wanted.items() if letter != "U" and letters[f] != letter]
    return [f for f in other if letters[f] != "U"], [f for f in other if letters[f] == "U"]
