"""A flat-folded state as a FOLD file: the crease pattern, and the folded sheet with its layers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final, TypeAlias

from exactfold.errors import NotApplicableError
from exactfold.exact.surds import sign
from exactfold.layers.images import Complex, Images
from exactfold.layers.pieces import convex_parts
from exactfold.layers.states import State
from exactfold.pattern.opening import Opened
from exactfold.pattern.validate import orientation
from exactfold.pattern.writing.panel_writing import converted

Pair: TypeAlias = tuple[int, int]

_SHARED: Final = ("edges_vertices", "edges_assignment", "edges_foldAngle", "faces_vertices")
"""What both frames have."""


def state_document(state: State, title: str = "", number: int = 0) -> dict[str, Any]:
    """The FOLD 1.2 object of a flat-folded state, ready for `json.dumps`.

    The first frame is the crease pattern with the letters of the state, as `Converted.document`
    writes it. Programs that fold by themselves, such as Flat-Folder and Oriedita, read this one.
    Frame 1 is the folded form: the same edges and faces, the places of the vertices, rounded to
    floats, and `faceOrders`: [f, g, 1] for panels that overlap if f lies on the side of g to which
    the normal of g points, in the folded form, and [f, g, -1] if it lies on the other side. Panel 0
    keeps its place and faces up. Frame 1 inherits nothing, because Oriedita reads no file with a
    frame that does (commit 8c2935d1, fold 1.1.0).

    Raises `NotApplicableError` if a panel that is not convex lies partly above and partly below
    another one, because FOLD has one order for two faces.

    >>> from exactfold.layers.folding import fold_flat
    >>> document = state_document(fold_flat("single-vertex-4", "MMMV").state())
    >>> document["file_frames"][0]["faceOrders"]
    [[0, 1, -1], [0, 2, -1], [0, 3, 1], [1, 2, -1], [1, 3, 1], [2, 3, -1]]
    """
    sheet = state.images.pieces.sheet
    flat = converted(Opened(sheet, state.letters)).document(title or None)
    images = state.images
    flipped = [
        images.maps[images.pieces.of_panel[panel][0]].flipped for panel in range(len(sheet.faces))
    ]
    return flat | {
        "file_frames": [
            {
                "frame_title": f"flat-folded state {number}",
                "frame_classes": ["foldedForm"],
                "frame_attributes": ["2D"],
                **{key: flat[key] for key in _SHARED},
                "vertices_coords": [list(place) for place in images.places],
                "faceOrders": [
                    [f, g, 1 if above != flipped[g] else -1]
                    for (f, g), above in sorted(panel_orders(state).items())
                ],
            }
        ]
    }


def panel_orders(state: State) -> dict[Pair, bool]:
    """For panels (f, g), f < g, that overlap in the image, whether f lies above g.

    Panels that are not convex consist of several pieces, and a piece can hold several panels that
    are joined by unfolded creases. Raises `NotApplicableError` as `state_document` does.
    """
    panels = state.images.pieces.panels
    orders: dict[Pair, bool] = {}
    meet: dict[Pair, bool] = {}
    for (i, j), up in state.orders.items():
        whole = len(panels[i]) == len(panels[j]) == 1
        for f in panels[i]:
            for g in panels[j]:
                pair, above = ((f, g), up < 0) if f < g else ((g, f), up > 0)
                if not whole:
                    if pair not in meet:
                        meet[pair] = _overlap(state.images, *pair)
                    if not meet[pair]:
                        continue
                if orders.setdefault(pair, above) != above:
                    raise NotApplicableError(
                        f"panel {pair[0]} lies partly above and partly below panel {pair[1]}, and "
                        "FOLD has one order for two faces: cut one of them by a flat crease (F)"
                    )
    return orders


def _overlap(images: Images, one: int, other: int) -> bool:
    """Whether two panels have a common interior point in the image, exactly."""
    return any(
        not _separates(a, b) and not _separates(b, a)
        for a in _parts(images, one)
        for b in _parts(images, other)
    )


def _parts(images: Images, panel: int) -> list[list[Complex]]:
    """The images of convex parts of a panel, counter-clockwise."""
    sheet = images.pieces.sheet
    place = images.maps[images.pieces.of_panel[panel][0]]
    found = []
    for part in convex_parts(sheet.scaled_vertices, sheet.faces[panel]):
        corners = [place(sheet.scaled_vertices[v]) for v in part]
        found.append(corners[::-1] if place.flipped else corners)
    return found


def _separates(polygon: Sequence[Complex], other: Sequence[Complex]) -> bool:
    """Whether a side of a convex polygon has another one on its outer side."""
    sides = zip(polygon, (*polygon[1:], polygon[0]), strict=True)
    return any(all(sign(orientation(a, b, c)) <= 0 for c in other) for a, b in sides)
