"""Frames of a motion as short text: levelled, rounded to 24 bits, and coded by differences."""

from __future__ import annotations

from base64 import b64decode, b64encode
from typing import Annotated, Any, Final, TypedDict

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.documents import Keywords

_STEPS: Final = 1 << 23
_ORDER: Final = 4
_BYTES: Final = 6
_PLANE: Final = 1e-6
"""A sheet lies in a plane if its thickness is less than this share of its width."""


class CodedFrames(TypedDict):
    """Coordinates of all frames."""

    frames: Annotated[int, Keywords(minimum=2)]
    scale: Annotated[float, Keywords(exclusiveMinimum=0)]
    data: Annotated[str, Keywords(contentEncoding="base64")]
    """Coded by their fourth differences (exactfold/app/viewer/coding.py)."""


def coded_frames(coords: FloatArray) -> CodedFrames:
    """Frames of shape (frames, V, 3) as JSON: their number, a scale, and base64 text.

    Coordinates are rounded to multiples of scale / 2^23, where the scale is the largest size of a
    coordinate. For a smooth motion, the fourth differences along the frames are small. These are
    written frame by frame as integers. The lowest bit of an integer is its sign. Each byte holds
    seven bits, the lowest first; its highest bit is set if another byte follows.

    >>> line = np.linspace(0, 1, 5)[:, None, None] * np.array([[0.0, 1.0, -2.0]])
    >>> coded = coded_frames(line)
    >>> coded["frames"], coded["scale"], bool(abs(decoded_frames(coded) - line).max() < 1e-6)
    (5, 2.0, True)
    """
    scale = float(np.abs(coords).max(initial=0.0)) or 1.0
    numbers = np.rint(coords / scale * _STEPS).astype(np.int64)
    for _ in range(_ORDER):
        numbers = np.diff(numbers, axis=0, prepend=np.zeros_like(numbers[:1]))
    flat = numbers.ravel()
    return {
        "frames": len(coords),
        "scale": scale,
        "data": b64encode(_bytes((flat << 1) ^ (flat >> 63))).decode("ascii"),
    }


def decoded_frames(coded: CodedFrames) -> FloatArray:
    """The frames that `coded_frames` wrote, shape (frames, V, 3), decoded as the page does it."""
    raw = np.frombuffer(b64decode(coded["data"]), dtype=np.uint8).astype(np.int64)
    last = np.flatnonzero(raw < 128)
    first = np.concatenate([[0], last[:-1] + 1])
    place = np.arange(len(raw)) - np.repeat(first, last - first + 1)
    values = np.add.reduceat((raw & 127) << (7 * place), first)
    numbers = ((values >> 1) ^ -(values & 1)).reshape(coded["frames"], -1, 3)
    for _ in range(_ORDER):
        numbers = np.cumsum(numbers, axis=0)
    return np.asarray(numbers * (coded["scale"] / _STEPS))


def levelled(coords: FloatArray) -> FloatArray:
    """Frames moved and turned, each as close to the previous one as possible (Kabsch).

    So the sheet stays in the middle of the picture and turns no more than necessary. If it ends in
    a plane, it turns steadily until this plane is level.
    """
    frames = [coords[0] - coords[0].mean(axis=0)]
    for shape in coords[1:]:
        centred = shape - shape.mean(axis=0)
        u, _, v = np.linalg.svd(centred.T @ frames[-1])
        turn = u @ np.diag([1.0, 1.0, float(np.sign(np.linalg.det(u @ v))) or 1.0]) @ v
        frames.append(centred @ turn)
    return _settled(np.array(frames))


def _settled(frames: FloatArray) -> FloatArray:
    """Frames that end level if the last one lies in a plane; others as they are."""
    _, sizes, axes = np.linalg.svd(frames[-1])
    normal = axes[2] * (1.0 if axes[2][2] >= 0 else -1.0)
    across = np.cross(normal, [0.0, 0.0, 1.0])
    length = float(np.linalg.norm(across))
    if sizes[2] > _PLANE * sizes[1] or length < _PLANE:
        return frames
    axis, angle = across / length, float(np.arctan2(length, normal[2]))
    share = np.linspace(0.0, 1.0, len(frames))
    turns = (angle * share**2 * (3 - 2 * share))[:, None, None]
    cos, sin = np.cos(turns), np.sin(turns)  # Rodrigues' formula
    return np.asarray(
        cos * frames + sin * np.cross(axis, frames) + (1 - cos) * (frames @ axis)[..., None] * axis
    )


def _bytes(values: np.ndarray[Any, np.dtype[np.int64]]) -> bytes:
    """Nonnegative numbers, each in as many groups of seven bits as it needs."""
    shifts = 7 * np.arange(_BYTES)
    groups = (values[:, None] >> shifts) & 127
    more = (values[:, None] >> (shifts + 7)) > 0
    used = np.concatenate([np.ones((len(values), 1), dtype=bool), more[:, :-1]], axis=1)
    encoded: bytes = (groups | (more * 128))[used].astype(np.uint8).tobytes()
    return encoded
