"""Colours, widths and dashes of the page, taken from the pictures."""

from __future__ import annotations

import colorsys
import json
from typing import Final

from exactfold.app.pictures import crease_style

_DARK: Final = {"B": 0.92}
_LIGHTNESS: Final = 0.66
"""The least lightness of a line on dark ground; the border is lighter still."""


def look_css() -> str:
    """The colours of lines by letter as CSS custom properties, lighter on dark ground.

    >>> look_css().split(";")[0]
    ':root { --M: #c8202f'
    """
    light = "; ".join(f"--{letter}: {c}" for letter, c in crease_style.COLOUR.items())
    dark = "; ".join(f"--{letter}: {_dark(letter)}" for letter in crease_style.COLOUR)
    return (
        f":root {{ {light} }}\n@media (prefers-color-scheme: dark) {{\n  :root {{ {dark} }}\n}}\n"
    )


def look_script() -> str:
    """The widths and dashes of lines as a constant in the page's script.

    >>> look_script()[:14]
    'const LOOK = {'
    """
    style = crease_style.Style.of(crease_style.FULL)
    letters = {}
    for letter in crease_style.COLOUR:
        attributes = style.attributes(letter)
        letters[letter] = {
            "width": style.width(letter, None),
            "least": style.width(letter, 0.0),
            "most": style.width(letter, 1.0),
            "dash": list(crease_style.DASH.get(letter, ())),
            "cap": attributes["stroke_linecap"],
        }
    look = {"letters": letters, "full": crease_style.FULL, "smallest": crease_style.LEAST}
    return f"const LOOK = {json.dumps(look, separators=(',', ':'))};\n"


def _dark(letter: str) -> str:
    """The colour of a letter on dark ground: the same hue, but light enough to be seen."""
    text = crease_style.COLOUR[letter]
    hue, lightness, saturation = colorsys.rgb_to_hls(
        *(int(text[k : k + 2], 16) / 255 for k in (1, 3, 5))
    )
    lightness = max(lightness, _DARK.get(letter, _LIGHTNESS))
    parts = colorsys.hls_to_rgb(hue, lightness, saturation)
    return "#" + "".join(f"{round(255 * part):02x}" for part in parts)
