"""A sheet as it folds and unfolds, as one moving picture: SVG with a style sheet, no script."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.app.pictures.painting import back_to_front
from exactfold.app.pictures.stills import faces_of, levelled, seen_from_above, shaded
from exactfold.app.pictures.svg import INK, element, number, picture
from exactfold.pattern.triangulating.panels import triangles_by_face

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
    places, shapes, earlier = _shapes(motion, frames)
    groups, height = _frames(motion, shapes, earlier)
    style = element("style", _style(len(places), seconds))
    heading = f"{title or motion.name}: the sheet folds and unfolds"
    return picture(_SIZE, height, [style, *groups], heading)


def _shapes(
    motion: SheetInMotion, frames: int
) -> tuple[list[int], list[FloatArray], list[FloatArray]]:
    """The places of so many frames, their shapes, and the shapes just before."""
    places = np.unique(np.linspace(0, len(motion.times) - 1, max(2, frames)).round().astype(int))
    shapes = [levelled(motion.coords[k], motion.coords[0]) for k in places]
    earlier = [levelled(motion.coords[max(k - 1, 0)], motion.coords[0]) for k in places]
    return places.tolist(), shapes, earlier


class Seen(NamedTuple):
    """A frame as it is drawn: the shape, where its vertices are in the picture, and its faces.

    The faces are ordered from back to front.
    """

    shape: FloatArray
    flat: FloatArray
    faces: list[Sequence[int]]


def seen_frames(motion: SheetInMotion, frames: int, size: float) -> tuple[list[Seen], float]:
    """So many frames of a motion, all at one scale and place, and the height of the picture.

    `size` is its width.
    """
    _, shapes, earlier = _shapes(motion, frames)
    return _seen(motion, shapes, earlier, size)


def _seen(
    motion: SheetInMotion, shapes: list[FloatArray], earlier: list[FloatArray], size: float
) -> tuple[list[Seen], float]:
    margin = size * _MARGIN / _SIZE
    views = [seen_from_above(shape) for shape in shapes]
    low = np.min([view.min(axis=0) for view in views], axis=0)[:2]
    high = np.max([view.max(axis=0) for view in views], axis=0)[:2]
    scale = (size - 2 * margin) / float(max(*(high - low), 1e-12))
    left = (size - float((high - low)[0]) * scale) / 2
    pieces, faces = triangles_by_face(motion.pattern), faces_of(motion.pattern)
    found = []
    for shape, view, before in zip(shapes, views, earlier, strict=True):
        order = back_to_front(seen_from_above((1 - _EARLIER) * shape + _EARLIER * before), pieces)
        flat = np.column_stack(
            [left + (view[:, 0] - low[0]) * scale, margin + (high[1] - view[:, 1]) * scale]
        )
        found.append(Seen(shape, flat, [faces[f] for f in order]))
    return found, float((high - low)[1]) * scale + 2 * margin


def _frames(
    motion: SheetInMotion, shapes: list[FloatArray], earlier: list[FloatArray]
) -> tuple[list[str], float]:
    """A group for each shape, all at one scale and place, and the height of the picture."""
    seen, height = _seen(motion, shapes, earlier, _SIZE)
    groups = [
        element("g", shaded(one.shape, one.flat, one.faces), class_=f"f f{k}", stroke=INK)
        for k, one in enumerate(seen)
    ]
    return groups, height


def _style(frames: int, seconds: float) -> str:
    """The times at which each frame is seen: once on the way there, and once on the way back.

    The middle frame is seen where nothing is animated: in programs that ignore animations, and by
    readers who prefer reduced motion.
    """
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
    lines.append(f".f{frames // 2}{{visibility:visible}}")
    lines.append("@media (prefers-reduced-motion:reduce){.f{animation:none!important}}")
    return "".join(lines)
