"""Unfolds a folded state: its rigid faces side by side in a plane are the crease pattern."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from fractions import Fraction
from math import floor, log10
from typing import Any, Final, TypeAlias

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.plurals import counted
from exactfold.errors import FoldedStateError
from exactfold.pattern.drawing.drawing import Loud

Point: TypeAlias = tuple[Fraction, Fraction]
ComplexArray: TypeAlias = "np.ndarray[Any, np.dtype[np.complexfloating[Any, Any]]]"
Space: TypeAlias = tuple[Fraction, Fraction, Fraction]
_MISFIT: Final = 1e-5
"""Faces that fit together less exactly, as a share of the size, are not rigid."""
_FINEST: Final = 1e-13
_FAR: Final = 10**30
_MOST_SIDES: Final = 4000  # sides of the boundary that are compared pair by pair
_AXES: Final = {0: (1, 2), 1: (2, 0), 2: (0, 1)}
"""The two coordinates that remain in a plane x, y or z = constant, counter-clockwise."""


def unfolded(places: Sequence[Space], faces: Sequence[tuple[int, ...]]) -> tuple[list[Point], str]:
    """The points of the crease pattern, and a remark on how exactly the faces fit together.

    The first face stays where it is if it lies in a plane x, y or z = constant; otherwise the
    longest side of the boundary becomes horizontal. Face after face is placed beside a neighbour.
    Each point is the mean of where its faces have it, rounded to the digits on which they agree.
    Faces are counter-clockwise in the picture; one that is listed the other way round is turned.

    Raises `FoldedStateError` if there are no faces, if they are not connected, not flat, or meet at
    an edge in threes, if they do not fit together round a vertex, and if they overlap.
    """
    used = sorted({v for face in faces for v in face})
    if not used:
        raise FoldedStateError("it has no faces to unfold")
    if any(abs(c) > _FAR for v in used for c in places[v]):
        raise FoldedStateError("its coordinates are too large to unfold it")
    space = np.array([[float(c) for c in places[v]] for v in used])
    number = {v: k for k, v in enumerate(used)}
    rows = [tuple(number[v] for v in face) for face in faces]
    size = float(np.ptp(space, axis=0).max())
    if size < 1 / _FAR:
        raise FoldedStateError("all its vertices are at one place")
    local = [_flat(space, face, k, size) for k, face in enumerate(rows)]
    sides = _sides(rows)
    spots = _placed(rows, local, sides)
    if any(not spot for spot in spots):
        raise FoldedStateError("its faces are not connected along edges")
    flat = np.array([np.mean(spot, axis=0) for spot in spots])
    wide = float(np.ptp(flat, axis=0).max())
    misfit = max(float(np.ptp(spot, axis=0).max()) for spot in spots) / wide
    if misfit > _MISFIT:
        raise FoldedStateError(
            f"its faces fit together only up to {misfit:.1g} of the size, so they are not rigid"
        )
    border = [edge for edge, near in sides.items() if len(near) == 1]
    _check_apart(flat, border)
    flat = _turned(flat, border, space, rows[0])
    digits = floor(-log10(max(misfit, _FINEST) * wide))
    points = [(Fraction(0), Fraction(0))] * len(places)
    for v, (x, y) in zip(used, flat.tolist(), strict=True):
        points[v] = (_rounded(x, digits), _rounded(y, digits))
    return points, Loud(
        f"this is a folded state: its {counted(len(faces), 'face')} are unfolded into a plane, "
        f"where they meet up to {max(misfit, _FINEST):.0e} of the size"
    )


def _rounded(number: float, digits: int) -> Fraction:
    return Fraction(f"{number:.{digits}f}") if digits > 0 else Fraction(round(number))


def _flat(space: FloatArray, face: tuple[int, ...], k: int, size: float) -> FloatArray:
    """The corners of a face in coordinates of its own plane, counter-clockwise."""
    corners = space[list(face)] - space[face[0]]
    normal = np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0)
    length = float(np.linalg.norm(normal))
    if len(set(face)) < max(3, len(face)) or length < _FINEST * size * size:
        raise FoldedStateError(f"face {k} has no area")
    normal /= length
    if np.abs(corners @ normal).max() > _MISFIT * size:
        raise FoldedStateError(f"face {k} is not flat")
    ahead = corners[1] - (corners[1] @ normal) * normal
    ahead /= np.linalg.norm(ahead)
    return np.stack([corners @ ahead, corners @ np.cross(normal, ahead)], axis=1)


def _sides(faces: Sequence[tuple[int, ...]]) -> dict[tuple[int, int], list[tuple[int, bool]]]:
    """For each edge its faces, and whether each runs from the smaller to the larger vertex."""
    sides: dict[tuple[int, int], list[tuple[int, bool]]] = {}
    for k, face in enumerate(faces):
        for i, j in zip(face, [*face[1:], face[0]], strict=True):
            sides.setdefault((min(i, j), max(i, j)), []).append((k, i < j))
    for (i, j), near in sides.items():
        if len(near) > 2:
            raise FoldedStateError(f"edge {i}-{j} has {len(near)} faces")
    return sides


def _placed(
    faces: Sequence[tuple[int, ...]],
    local: Sequence[FloatArray],
    sides: dict[tuple[int, int], list[tuple[int, bool]]],
) -> list[list[FloatArray]]:
    """The places of each vertex in the plane, one for each of its faces that can be reached."""
    spots: list[list[FloatArray]] = [[] for _ in range(1 + max(map(max, faces)))]
    done = {0: local[0]}
    waiting = deque([0])
    turned = {0: False}
    while waiting:
        k = waiting.popleft()
        for v, spot in zip(faces[k], done[k], strict=True):
            spots[v].append(spot)
        for i, j in zip(faces[k], [*faces[k][1:], faces[k][0]], strict=True):
            near = sides[min(i, j), max(i, j)]
            for m, forward in near:
                if m in done:
                    continue
                own = next(direction for face, direction in near if face == k)
                turned[m] = turned[k] ^ (forward == own)
                mirrored = local[m] * (1, -1) if turned[m] else local[m]
                done[m] = _beside(faces, done[k], mirrored, (k, m), (i, j))
                waiting.append(m)
    return spots


def _beside(
    faces: Sequence[tuple[int, ...]],
    placed: FloatArray,
    local: FloatArray,
    pair: tuple[int, int],
    edge: tuple[int, int],
) -> FloatArray:
    """The corners of the second face of a pair, moved to the edge that it shares with the first."""
    ours = placed[[faces[pair[0]].index(v) for v in edge]] @ (1, 1j)
    theirs = local[[faces[pair[1]].index(v) for v in edge]] @ (1, 1j)
    turn = (ours[1] - ours[0]) / (theirs[1] - theirs[0])
    moved = (local @ (1, 1j) - theirs.mean()) * (turn / abs(turn)) + ours.mean()
    return np.stack([moved.real, moved.imag], axis=1)


def _turned(
    flat: FloatArray, border: Sequence[tuple[int, int]], space: FloatArray, face: tuple[int, ...]
) -> FloatArray:
    """The pattern turned to where the first face lies, or with the longest side horizontal."""
    corners = space[list(face)]
    for axis, kept in _AXES.items():
        if np.ptp(corners[:, axis]) <= _FINEST * np.ptp(space, axis=0).max():
            ours = flat[list(face)] @ (1, 1j)
            theirs = corners[:, list(kept)] @ (1, 1j)
            if (turn := _turn(ours, theirs)) is not None:
                moved = (flat @ (1, 1j) - ours.mean()) * turn + theirs.mean()
                return np.stack([moved.real, moved.imag], axis=1)
    ends = np.array(border or [(face[0], face[1])])
    chords = (flat[ends[:, 1]] - flat[ends[:, 0]]) @ (1, 1j)
    longest = chords[int(np.argmax(np.abs(chords)))]
    moved = (flat @ (1, 1j)) * (abs(longest) / longest)
    moved -= moved.real.min() + 1j * moved.imag.min()
    return np.stack([moved.real, moved.imag], axis=1)


def _turn(ours: ComplexArray, theirs: ComplexArray) -> complex | None:
    """The rotation of a face to its place in a plane; None if it lies there face down."""
    ours, theirs = ours - ours.mean(), theirs - theirs.mean()
    turn = complex(np.vdot(ours, theirs))
    length = abs(turn)
    if not length or np.abs(ours * (turn / length) - theirs).max() > _MISFIT * np.abs(ours).max():
        return None
    return turn / length


def _check_apart(flat: FloatArray, border: Sequence[tuple[int, int]]) -> None:
    """Raises `FoldedStateError` if two sides of the boundary cross: the pattern covers itself."""
    if len(border) > _MOST_SIDES:
        raise FoldedStateError(f"its boundary has more than {_MOST_SIDES} sides")
    a, b = (flat[[edge[end] for edge in border]] for end in (0, 1))
    for k in range(len(border)):
        first, second = _side(a, b, a[k]), _side(a, b, b[k])
        third, fourth = _side(a[k], b[k], a), _side(a[k], b[k], b)
        if np.any((first * second < 0) & (third * fourth < 0)):
            raise FoldedStateError("unfolded, its faces overlap")


def _side(a: FloatArray, b: FloatArray, p: FloatArray) -> FloatArray:
    """On which side of the line from a to b a point lies; 0 if it is very near the line."""
    chord, offset = b - a, p - a
    cross = chord[..., 0] * offset[..., 1] - chord[..., 1] * offset[..., 0]
    near = np.abs(cross) <= _MISFIT * np.hypot(*chord.T) * np.hypot(*offset.T)
    result: FloatArray = np.where(near, 0.0, np.sign(cross))
    return result
