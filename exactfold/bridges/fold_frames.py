"""A branch as a FOLD file of two frames, for programs that fold and draw: see docs/export.md."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.fold_writing import fold_document

BRANCH_KEY: Final = "frame_exactfold:branch"
HEIGHTS_KEY: Final = "vertices_exactfold:heights"


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
    """The FOLD 1.2 object of a branch: the flat sheet, and as frame 1 the sheet in space.

    The first frame is `fold_document(pattern, assignment, angles=angles)`, angles in degrees, with
    the custom keys `frame_exactfold:branch` (`facts`: what the branch is) and
    `vertices_exactfold:heights` (`heights`: bounds "p/q" by vertex). Frame 1 inherits all of it
    and replaces the coordinates by `folded`, three components a vertex. `name` names the branch,
    `title` the pattern. Raises what `fold_document` raises.

    >>> from exactfold.pattern.families import single_vertex
    >>> document = branch_document(
    ...     single_vertex(3), {}, {}, [(0, 0, 0)] * 4, name="branch -", facts={}, heights=[])
    >>> document["file_frames"][0]["frame_classes"], document["frame_classes"]
    (['foldedForm'], ['creasePattern'])
    """
    whole = name if title is None else f"{title}, {name}"
    flat = fold_document(pattern, assignment, whole, angles)
    # The keys of the file come first, then those of the frame, as people read it.
    document = {key: value for key, value in flat.items() if key.startswith("file_")}
    document["frame_title"] = f"flat sheet, with the first-order fold angles of {name}"
    document["frame_unit"] = "unit"
    document[BRANCH_KEY] = dict(facts)
    document |= flat
    document[HEIGHTS_KEY] = [list(row) for row in heights]
    document["file_frames"] = [
        {
            "frame_title": f"{name} to second order: close to a folded state, not exact",
            "frame_classes": ["foldedForm"],
            "frame_attributes": ["3D"],
            "frame_parent": 0,
            "frame_inherit": True,
            "vertices_coords": [list(point) for point in folded],
        }
    ]
    return document
