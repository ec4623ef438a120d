"""A sheet as it folds and unfolds, as one moving picture: SVG with a style sheet, no script."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.app.pictures.painting import back_to_front
from exactfold.app.pictures.stills import faces_of, levelled, seen_from_above, shaded
from exactfold.app.pictures.svg import INK, element, number, picture
from exactfold.pattern.triangulating import triangles_by_face

if TYPE_CHECKING:
    from exactfold.motion.curves.in_motion import SheetInMotion

_SIZE, _MARGIN = 360.0, 12.0
_REST: Final = 0.08
"""The share of a round for which the sheet rests, both flat and folded."""
_EARLIER: Final = 0.02
"""Depths are taken this share of the way back to the previous frame, where layers are
still apart.
"""


def motion_animation(
    motion: SheetInMotion, *, frames: int = 40, seconds: float = 8, title: str = ""
) -> str:
    """A motion from the flat sheet to its end and back, repeated for ever, as an SVG file.

    `frames` pictures are shown in turn at equal steps of time, in rounds of `seconds`. A style
    sheet moves them, so every browser shows them, also as an image in a page. If the reader asks
    for less motion (`prefers-reduced-motion`), the sheet stands still half-way.

    >>> from exactfold.branches import find_branch
    >>> from exactfold.motion import follow
    >>> text = motion_animation(follow(find_branch("two-vertex", "+-")), frames=12)
    >>> text.count('<g class="f'), text.count("@keyframes")
    (12, 12)
    """
    places = np.linspace(0, len(motion.times) - 1, max(2, frames)).round().astype(int)
    places = np.unique(places)
    shapes = [levelled(motion.coords[k], motion.coords[0]) for k in places]
    earlier = [levelled(motion.coords[max(k - 1, 0)], motion.coords[0]) for k in places]
    groups, height = _frames(motion, shapes, earlier)
    style = element("style", _style(len(places), seconds))
    heading = f"{title or motion.name}: the sheet folds and unfolds"
    return picture(_SIZE, height, [style, *groups], heading)


def _frames(
    motion: SheetInMotion, shapes: list[FloatArray], earlier: list[FloatArray]
) -> tuple[list[str], float]:
    """A group for each shape, all at one scale and place, and the height of the picture."""
    seen = [seen_from_above(shape) for shape in shapes]
    low = np.min([view.min(axis=0) for view in seen], axis=0)[:2]
    high = np.max([view.max(axis=0) for view in seen], axis=0)[:2]
    scale = (_SIZE - 2 * _MARGIN) / float(max(*(high - low), 1e-12))
    left = (_SIZE - float((high - low)[0]) * scale) / 2
    pieces, faces = triangles_by_face(motion.pattern), faces_of(motion.pattern)
    groups = []
    for k, (shape, view, before) in enumerate(zip(shapes, seen, earlier, strict=True)):
        order = back_to_front(seen_from_above((1 - _EARLIER) * shape + _EARLIER * before), pieces)
        flat = np.column_stack(
            [left + (view[:, 0] - low[0]) * scale, _MARGIN + (high[1] - view[:, 1]) * scale]
        )
        drawn = shaded(shape, flat, [faces[f] for f in order])
        groups.append(element("g", drawn, class_=f"f f{k}", stroke=INK))
    return groups, float((high - low)[1]) * scale + 2 * _MARGIN


def _style(frames: int, seconds: float) -> str:
    """The times at which each frame is seen: once on the way there, and once on the way back."""
    lines = [
        f".f{{visibility:hidden;animation-duration:{number(seconds)}s;"
        "animation-iteration-count:infinite;animation-timing-function:step-end}"
    ]
    starts = [0.0, *np.linspace(_REST, 0.5 - _REST, frames - 1).tolist(), 0.5]
    for k in range(frames):
        start, end = (100 * share for share in starts[k : k + 2])
        steps = {0.0: "hidden", start: "visible", end: "hidden"}
        steps |= {100 - end: "visible", 100 - start: "hidden"}
        keys = "".join(
            f"{number(place)}%{{visibility:{state}}}" for place, state in sorted(steps.items())
        )
        lines.append(f".f{k}{{animation-name:k{k}}}@keyframes k{k}{{{keys}}}")
    half = f".f{{animation:none!important}}.f{frames // 2}{{visibility:visible}}"
    lines.append(f"@media (prefers-reduced-motion:reduce){{{half}}}")
    return "".join(lines)
