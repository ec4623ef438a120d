"""Pictures of a sheet in space: shaded faces with two colours, sorted by depth, in plain SVG."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, radians, sin
from typing import TYPE_CHECKING, Final

import numpy as np

from exactfold.arrays import FloatArray
from exactfold.report.svg import INK, element, path, picture, text

if TYPE_CHECKING:
    from exactfold.motion.motion import Motion

_UPPER: Final = (86, 180, 233)
_LOWER: Final = (240, 228, 66)
"""Blue and yellow of Okabe and Ito: the side that is +z in the flat sheet, and the other."""
_AZIMUTH, _ELEVATION = -62.0, 34.0
_LIGHT = (0.35, -0.5, 0.79)
_PANEL, _MARGIN, _CAPTION = 200.0, 12.0, 22.0


def motion_stills(motion: Motion, number: int = 5, title: str = "") -> str:
    """A row of stills of a motion, from the flat sheet to its end, as an SVG file.

    All have the same scale and point of view; below each stand the largest fold angle and the time.
    """
    places = np.linspace(0, len(motion.times) - 1, max(2, number)).round().astype(int)
    shapes = [_levelled(motion.coords[k], motion.coords[0]) for k in places]
    captions = [
        f"{_largest(motion.angles[k]):.0f}° at {motion.times[k]:.3g}" if k else "flat"
        for k in places
    ]
    faces = motion.branch.pattern.triangles
    name = title or f"branch {motion.branch.sign_text}"
    return stills(shapes, faces, captions, f"{name}: the sheet as it folds")


def stills(
    shapes: Sequence[FloatArray],
    faces: Sequence[Sequence[int]],
    captions: Sequence[str],
    title: str,
) -> str:
    """Shapes of one sheet side by side, each of shape (V, 3), with a caption each.

    >>> flat = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.5]])
    >>> stills([flat], [(0, 1, 2), (0, 2, 3)], ["a & b"], "two faces").count("<path")
    2
    """
    seen = [_seen(np.asarray(shape, dtype=np.float64)) for shape in shapes]
    low = np.min([view.min(axis=0) for view in seen], axis=0)[:2]
    high = np.max([view.max(axis=0) for view in seen], axis=0)[:2]
    span = float(max(*(high - low), 1e-12))
    scale = (_PANEL - 2 * _MARGIN) / span
    height = float((high - low)[1]) * scale + 2 * _MARGIN
    parts = []
    for k, (shape, view, caption) in enumerate(zip(shapes, seen, captions, strict=True)):
        left = k * _PANEL + _MARGIN + ((_PANEL - 2 * _MARGIN) - float((high - low)[0]) * scale) / 2
        flat = np.column_stack(
            [left + (view[:, 0] - low[0]) * scale, _MARGIN + (high[1] - view[:, 1]) * scale]
        )
        parts.append(element("g", _drawn(np.asarray(shape), view, flat, faces), stroke=INK))
        centre = (k + 0.5) * _PANEL
        parts.append(text(caption, centre, height + 12, anchor="middle", size=12))
    return picture(len(shapes) * _PANEL, height + _CAPTION, parts, title)


def _levelled(shape: FloatArray, flat: FloatArray) -> FloatArray:
    """The shape moved and turned to be as close to the flat sheet as can be (Kabsch)."""
    a, b = shape - shape.mean(axis=0), flat - flat.mean(axis=0)
    u, _, v = np.linalg.svd(a.T @ b)
    turn = u @ np.diag([1.0, 1.0, float(np.sign(np.linalg.det(u @ v)))]) @ v
    return np.asarray(a @ turn)


def _seen(shape: FloatArray) -> FloatArray:
    """Right, up and towards the eye, for every vertex: an orthographic view from above."""
    a, e = radians(_AZIMUTH), radians(_ELEVATION)
    right = np.array([-sin(a), cos(a), 0.0])
    towards = np.array([cos(e) * cos(a), cos(e) * sin(a), sin(e)])
    up = np.cross(towards, right)
    return np.asarray(shape @ np.array([right, up, towards]).T)


def _drawn(
    shape: FloatArray, view: FloatArray, flat: FloatArray, faces: Sequence[Sequence[int]]
) -> str:
    """The faces from back to front, each in the colour of the side that is seen."""
    towards = _seen(np.eye(3))[:, 2]
    light = np.array(_LIGHT) / np.linalg.norm(_LIGHT)
    order = sorted(range(len(faces)), key=lambda k: float(view[list(faces[k]), 2].mean()))
    drawn = []
    for k in order:
        corners = list(faces[k])
        a, b, c = shape[corners[:3]]
        normal = np.cross(b - a, c - a)
        normal = normal / max(float(np.linalg.norm(normal)), 1e-300)
        upper = float(normal @ towards) >= 0
        shade = 0.5 + 0.5 * max(0.0, float((normal if upper else -normal) @ light))
        colour = "#" + "".join(f"{round(shade * x):02x}" for x in (_UPPER if upper else _LOWER))
        points = [(float(x), float(y)) for x, y in flat[corners]]
        drawn.append(
            path(points, closed=True, fill=colour, stroke_width=0.6, stroke_linejoin="round")
        )
    return "".join(drawn)


def _largest(angles: FloatArray) -> float:
    return float(np.degrees(np.max(np.abs(angles), initial=0.0)))
