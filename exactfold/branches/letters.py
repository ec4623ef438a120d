"""The alphabet of vertex signs and mountain-valley letters, in one place."""

from __future__ import annotations

LETTERS = {1: "V", -1: "M", 0: "F", None: "U"}
"""Letter of a fold by its sign: valley, mountain, flat, undecided."""

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
