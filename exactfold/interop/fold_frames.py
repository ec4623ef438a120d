"""Writes branches and motions as FOLD files with frames, for programs that fold and draw."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.opening import Opened
from exactfold.pattern.writing.fold_writing import fold_document

if TYPE_CHECKING:
    from exactfold.pattern.panel_pattern import PanelPattern

BRANCH_KEY: Final = "frame_exactfold:branch"
MOTION_KEY: Final = "frame_exactfold:motion"
TIME_KEY: Final = "frame_exactfold:time"
TIME_BOUNDS_KEY: Final = "frame_exactfold:timeBounds"
RADIUS_KEY: Final = "frame_exactfold:radius"
HEIGHTS_KEY: Final = "vertices_exactfold:heights"
NOISE: Final = 1e-7
"""Angles below this size, in degrees, count as flat."""


def branch_document(
    pattern: CreasePattern,
    assignment: Mapping[Edge, str],
    angles: Mapping[Edge, float],
    folded: Sequence[Sequence[float]],
    *,
    name: str,
    title: str | None = None,
    facts: Mapping[str, Any],
    heights: Sequence[Sequence[str]],
) -> dict[str, Any]:
    """The FOLD 1.2 object of a branch: the flat sheet, and the sheet in space as frame 1.

    See docs/viewer.md, Export to other programs.

    The first frame is `fold_document(pattern, assignment, angles=angles)`, with angles in degrees.
    It has the custom keys `frame_exactfold:branch` (`facts`: what the branch is) and
    `vertices_exactfold:heights` (`heights`: bounds "p/q" by vertex). Frame 1 inherits everything
    and replaces the coordinates by `folded`, with three components for each vertex. `name` names
    the branch, `title` the pattern. Raises the errors of `fold_document`.

    >>> from exactfold.pattern.families import single_vertex
    >>> document = branch_document(
    ...     single_vertex(3), {}, {}, [(0, 0, 0)] * 4, name="branch -", facts={}, heights=[])
    >>> document["file_frames"][0]["frame_classes"], document["frame_classes"]
    (['foldedForm'], ['creasePattern'])
    """
    document = _headed(
        fold_document(pattern, assignment, _titled(name, title), angles),
        f"flat sheet, with the first-order fold angles of {name}",
        {BRANCH_KEY: dict(facts)},
    )
    document[HEIGHTS_KEY] = [list(row) for row in heights]
    document["file_frames"] = [
        {
            "frame_title": f"{name} to second order: close to a folded state, not exact",
            **_in_space(),
            "vertices_coords": [list(point) for point in folded],
        }
    ]
    return document


def motion_document(
    pattern: CreasePattern | PanelPattern,
    assignment: Mapping[Edge, str],
    angles: Mapping[Edge, float],
    frames: Sequence[MotionFrame],
    *,
    name: str,
    title: str | None = None,
    facts: Mapping[str, Any],
    angles_are: str = "the first-order fold angles",
) -> dict[str, Any]:
    """The FOLD 1.2 object of a motion: the flat sheet, and then every frame in space.

    The first frame is that of `branch_document`, with `facts` under `frame_exactfold:motion`. For
    panels it has the exact coordinates and the polygons of `Converted.document`. Each frame of
    `frames` inherits the first one and has its own coordinates and fold angles. It also has its own
    letters if they differ, because programs expect letters and angles to agree. `angles_are`
    describes `angles` in words. Raises the errors of `fold_document`.

    >>> from exactfold.pattern.families import single_vertex
    >>> frame = MotionFrame(0.5, [(0, 0, 0)] * 4, {(0, 3): -1.0})
    >>> document = motion_document(
    ...     single_vertex(3), {(0, 3): "V"}, {}, [frame], name="branch -", facts={})
    >>> document["edges_assignment"][2], document["file_frames"][0]["edges_assignment"][2]
    ('V', 'M')
    >>> document["file_frames"][0]["edges_foldAngle"]
    [0.0, 0.0, -1.0, 0.0, 0.0, 0.0]
    """
    whole = _titled(name, title)
    document = _headed(
        fold_document(pattern, assignment, whole, angles)
        if isinstance(pattern, CreasePattern)
        else _panels_document(pattern, assignment, angles, whole),
        f"flat sheet, with {angles_are} of {name}",
        {MOTION_KEY: dict(facts)},
    )
    letters = dict(zip(pattern.edges, document["edges_assignment"], strict=True))
    document["file_frames"] = [
        _frame(frame, letters, f"{name}, frame {k} of {len(frames)}, time {frame.time:.6g}")
        for k, frame in enumerate(frames, 1)
    ]
    return document


@dataclass(frozen=True)
class MotionFrame:
    """A sheet in space: `coords` has three components for each vertex.

    `angles` are in degrees, by fold. If the frame is proved, there is one true configuration, with
    a time within `time_bounds`, such that every coordinate is within `radius` of it.
    """

    time: float
    coords: Sequence[Sequence[float]]
    angles: Mapping[Edge, float]
    time_bounds: tuple[float, float] | None = None
    radius: float | None = None


def _in_space() -> dict[str, Any]:
    """The keys of a frame in space; it inherits from the flat sheet."""
    return {
        "frame_classes": ["foldedForm"],
        "frame_attributes": ["3D"],
        "frame_parent": 0,
        "frame_inherit": True,
    }


def _titled(name: str, title: str | None) -> str:
    return name if title is None else f"{title}, {name}"


def _panels_document(
    pattern: PanelPattern, assignment: Mapping[Edge, str], angles: Mapping[Edge, float], title: str
) -> dict[str, Any]:
    """The FOLD object of a flat sheet of panels, with the given angles."""
    from exactfold.pattern.writing.panel_writing import (
        converted,  # here, as branches do not need it
    )

    flat = converted(Opened(pattern, assignment)).document(title)
    flat["edges_foldAngle"] = [float(angles.get(edge, 0)) for edge in pattern.edges]
    return flat


def _headed(flat: dict[str, Any], frame_title: str, facts: Mapping[str, Any]) -> dict[str, Any]:
    """The first frame, which is the exact flat sheet, with its title and the facts about it."""
    # The keys of the file come first, then those of the frame, for people who read the file.
    document = {key: value for key, value in flat.items() if key.startswith("file_")}
    document["frame_title"] = frame_title
    document["frame_unit"] = "unit"
    return document | dict(facts) | flat


def _frame(frame: MotionFrame, letters: Mapping[Edge, str], title: str) -> dict[str, Any]:
    angles = dict.fromkeys(letters, 0.0)
    for fold, angle in frame.angles.items():
        angles[fold] = 0.0 if abs(turned := _principal(angle)) <= NOISE else turned
    own = {edge: _letter(letter, angles[edge]) for edge, letter in letters.items()}
    return {
        "frame_title": title,
        TIME_KEY: frame.time,
        **({} if frame.time_bounds is None else {TIME_BOUNDS_KEY: list(frame.time_bounds)}),
        **({} if frame.radius is None else {RADIUS_KEY: frame.radius}),
        **_in_space(),
        "vertices_coords": [[float(x) for x in point] for point in frame.coords],
        **({} if own == letters else {"edges_assignment": list(own.values())}),
        "edges_foldAngle": list(angles.values()),
    }


def _principal(angle: float) -> float:
    """The angle between -180 and 180 degrees; a closed fold keeps the sign of its side."""
    if abs(angle) > 180 + NOISE:
        angle -= 360 * round(angle / 360)
    return max(-180.0, min(180.0, angle))


def _letter(letter: str, angle: float) -> str:
    """The letter of an edge at an angle; a boundary edge keeps B."""
    if letter == "B":
        return letter
    return "F" if not angle else "V" if angle > 0 else "M"
