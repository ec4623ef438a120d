"""Pictures of a sheet in space as SVG: shaded faces in two colours, nearer faces over others."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, radians, sin
from typing import TYPE_CHECKING, Final

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.app.pictures.painting import back_to_front
from exactfold.app.pictures.svg import INK, element, path, picture, text
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.triangulating.panels import triangles_by_face

if TYPE_CHECKING:
    from exactfold.motion.curves.in_motion import SheetInMotion
    from exactfold.pattern.panel_pattern import PanelPattern

_UPPER: Final = (86, 180, 233)
_LOWER: Final = (240, 228, 66)
"""Blue and yellow of Okabe and Ito: blue for the side that is +z in the flat sheet."""
_AZIMUTH, _ELEVATION = -62.0, 34.0
_LIGHT = (0.35, -0.5, 0.79)
_PANEL, _MARGIN, _CAPTION = 200.0, 12.0, 22.0
_EARLIER: Final = 0.02
"""Depths are taken this share of the way back to the previous frame, where layers are
still apart.
"""


def motion_stills(motion: SheetInMotion, number: int = 5, title: str = "") -> str:
    """A row of stills of a motion, from the flat sheet to its end, as an SVG file.

    All stills have the same scale and point of view. Below each are the largest fold angle and the
    time. Layers that lie on each other are drawn in the order in which they arrived. A motion with
    fewer frames than `number` shows each frame once.
    """
    count = min(len(motion.times), max(2, number))
    places = np.linspace(0, len(motion.times) - 1, count).round().astype(int)
    shapes = [levelled(motion.coords[k], motion.coords[0]) for k in places]
    captions = [
        f"{_largest(motion.angles[k]):.0f}°, t = {motion.times[k]:.3g}" if k else "flat"
        for k in places
    ]
    earlier = [levelled(motion.coords[max(k - 1, 0)], motion.coords[0]) for k in places]
    layered = [
        (1 - _EARLIER) * shape + _EARLIER * before
        for shape, before in zip(shapes, earlier, strict=True)
    ]
    pieces = triangles_by_face(motion.pattern)
    faces = faces_of(motion.pattern)
    heading = f"{title or motion.name}: the sheet as it folds"
    return stills(shapes, faces, captions, heading, pieces=pieces, layered=layered)


def motion_still(motion: SheetInMotion, time: float, caption: str, title: str, size: float) -> str:
    """The sheet at one time of a motion, `size` pixels wide, as an SVG file."""
    flat = motion.coords[0]
    shape, before = (levelled(motion.at(t), flat) for t in (time, (1 - _EARLIER) * time))
    pieces, faces = triangles_by_face(motion.pattern), faces_of(motion.pattern)
    return stills([shape], faces, [caption], title, pieces=pieces, layered=[before], panel=size)


def stills(
    shapes: Sequence[FloatArray],
    faces: Sequence[Sequence[int]],
    captions: Sequence[str],
    title: str,
    *,
    pieces: Sequence[Sequence[Sequence[int]]] | None = None,
    layered: Sequence[FloatArray] | None = None,
    panel: float = _PANEL,
) -> str:
    """Shapes of one sheet side by side, each of shape (V, 3) and with a caption.

    `pieces` are the triangles of each face; they are needed if some faces are not triangles.
    `layered` are shapes close to these, in which no faces lie on each other; they decide which face
    is drawn over which. `panel` is the width of each still.

    >>> flat = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.5]])
    >>> stills([flat], [(0, 1, 2), (0, 2, 3)], ["a & b"], "two faces").count("<path")
    2
    """
    seen = [seen_from_above(np.asarray(shape, dtype=np.float64)) for shape in shapes]
    low = np.min([view.min(axis=0) for view in seen], axis=0)[:2]
    high = np.max([view.max(axis=0) for view in seen], axis=0)[:2]
    span = float(max(*(high - low), 1e-12))
    scale = (panel - 2 * _MARGIN) / span
    height = float((high - low)[1]) * scale + 2 * _MARGIN
    parts = []
    cut = pieces or [[face] for face in faces]
    apart = shapes if layered is None else layered
    for k, (shape, view, caption) in enumerate(zip(shapes, seen, captions, strict=True)):
        order = back_to_front(seen_from_above(np.asarray(apart[k], dtype=np.float64)), cut)
        left = k * panel + _MARGIN + ((panel - 2 * _MARGIN) - float((high - low)[0]) * scale) / 2
        flat = np.column_stack(
            [left + (view[:, 0] - low[0]) * scale, _MARGIN + (high[1] - view[:, 1]) * scale]
        )
        parts.append(
            element("g", shaded(np.asarray(shape), flat, [faces[k] for k in order]), stroke=INK)
        )
        centre = (k + 0.5) * panel
        parts.append(text(caption, centre, height + 12, anchor="middle", size=12))
    return picture(len(shapes) * panel, height + _CAPTION, parts, title)


def levelled(shape: FloatArray, flat: FloatArray) -> FloatArray:
    """The shape moved and turned as close to the flat sheet as possible (Kabsch)."""
    a, b = shape - shape.mean(axis=0), flat - flat.mean(axis=0)
    u, _, v = np.linalg.svd(a.T @ b)
    turn = u @ np.diag([1.0, 1.0, float(np.sign(np.linalg.det(u @ v)))]) @ v
    return np.asarray(a @ turn)


def seen_from_above(shape: FloatArray) -> FloatArray:
    """Right, up and towards the eye, for every vertex: an orthographic view from above."""
    a, e = radians(_AZIMUTH), radians(_ELEVATION)
    right = np.array([-sin(a), cos(a), 0.0])
    towards = np.array([cos(e) * cos(a), cos(e) * sin(a), sin(e)])
    up = np.cross(towards, right)
    return np.asarray(shape @ np.array([right, up, towards]).T)


def faces_of(pattern: CreasePattern | PanelPattern) -> Sequence[Sequence[int]]:
    """The faces of a sheet: triangles, or panels as they are."""
    return pattern.triangles if isinstance(pattern, CreasePattern) else pattern.faces


def shaded(shape: FloatArray, flat: FloatArray, faces: Sequence[Sequence[int]]) -> str:
    """The faces in this order, each in the colour of its visible side."""
    drawn = []
    for face, parts in zip(faces, shades(shape, faces), strict=True):
        colour = "#" + "".join(f"{part:02x}" for part in parts)
        points = [(float(x), float(y)) for x, y in flat[list(face)]]
        drawn.append(
            path(points, closed=True, fill=colour, stroke_width=0.6, stroke_linejoin="round")
        )
    return "".join(drawn)


def shades(shape: FloatArray, faces: Sequence[Sequence[int]]) -> list[tuple[int, int, int]]:
    """The colour of the visible side of each face, from 0 to 255."""
    towards = seen_from_above(np.eye(3))[:, 2]
    light = np.array(_LIGHT) / np.linalg.norm(_LIGHT)
    colours = []
    for face in faces:
        corners = list(face)
        ring = shape[corners] - shape[corners[0]]
        normal = np.cross(ring, np.roll(ring, -1, axis=0)).sum(axis=0)
        normal = normal / max(float(np.linalg.norm(normal)), 1e-300)
        upper = float(normal @ towards) >= 0
        shade = 0.5 + 0.5 * max(0.0, float((normal if upper else -normal) @ light))
        red, green, blue = (round(shade * x) for x in (_UPPER if upper else _LOWER))
        colours.append((red, green, blue))
    return colours


def _largest(angles: FloatArray) -> float:
    return float(np.degrees(np.max(np.abs(angles), initial=0.0)))
