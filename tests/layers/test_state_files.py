"""FOLD files of flat-folded states: what is read back, and the orders of panels in them."""

from __future__ import annotations

import json

import numpy as np
import pytest

import exactfold
from exactfold.app.pictures.flat_layers import corners_of
from exactfold.app.pictures.painting import area, common_part
from exactfold.errors import NotApplicableError
from exactfold.layers.fold_frames import panel_orders, state_document
from exactfold.pattern.panel_pattern import PanelPattern
from exactfold.pattern.writing.fold_writing import document_text

KEYS = [
    "frame_title",
    "frame_classes",
    "frame_attributes",
    "vertices_coords",
    "edges_vertices",
    "edges_assignment",
    "edges_foldAngle",
    "faces_vertices",
    "faceOrders",
]
"""Keys that the reader of Oriedita takes in frames after the first, among others (fold 1.1.0)."""


def arms() -> PanelPattern:
    """A comb with three teeth, and a bar at the end of the middle one, which folds over all."""
    comb = [(0, 0), (5, 0), (5, 4), (3.25, 4), (3.25, 1), (3, 1), (3, 4.5)]
    bar = [(3, 6), (5, 6), (5, 7), (0, 7), (0, 6), (2, 6)]
    rest = [(2, 4.5), (2, 1), (1.75, 1), (1.75, 4), (0, 4)]
    points = [(int(4 * x), int(4 * y)) for x, y in [*comb, *bar, *rest]]
    ring = [(k, k + 1) for k in range(len(points) - 1)]
    return PanelPattern(points, [*ring, (0, len(points) - 1), (6, 13)])


def halves() -> PanelPattern:
    """A strip folded twice, whose last panel is cut by a crease that stays flat."""
    points = [(0, 0), (4, 0), (8, 0), (10, 0), (12, 0), (12, 4), (10, 4), (8, 4), (4, 4), (0, 4)]
    ring = [(k, k + 1) for k in range(9)]
    return PanelPattern(points, [*ring, (0, 9), (1, 8), (2, 7), (3, 6)])


@pytest.mark.parametrize(
    ("sheet", "letters"),
    [("miura", None), ("waterbomb", "any"), ("square-twist", "any"), (halves(), "UUF")],
    ids=["miura", "waterbomb", "square-twist", "halves"],
)
def test_the_orders_of_faces_are_those_of_the_layers(sheet, letters):
    """By the definition of FOLD, from the coordinates of the frame, for pieces at a point."""
    for state in exactfold.flat(sheet, letters):
        document = json.loads(document_text(state_document(state)))
        (frame,) = document["file_frames"]
        assert not {key for key in frame if key not in KEYS}  # Oriedita refuses any other
        places = np.array(frame["vertices_coords"])
        assert all(document[key] == frame[key] for key in ("edges_vertices", "faces_vertices"))
        faces = [places[face] for face in frame["faces_vertices"]]
        small = 1e-9 * np.ptp(places) ** 2
        pieces = corners_of(state)
        orders = {(f, g): s for f, g, s in frame["faceOrders"]}
        assert len(orders) == len(frame["faceOrders"])
        for f, one in enumerate(faces):
            for g in range(f + 1, len(faces)):
                common = common_part(one, faces[g])
                assert ((f, g) in orders) == (abs(area(common)) > small)
                if (f, g) not in orders:
                    continue
                point = np.mean(common, axis=0)
                (a,), (b,) = (
                    [k for k in state.images.pieces.of_panel[panel] if _holds(pieces[k], point)]
                    for panel in (f, g)
                )
                normal = 1 if area(faces[g]) > 0 else -1
                assert orders[f, g] == (1 if state.above(a, b) else -1) * normal


def _holds(corners, point):
    after = np.roll(corners, -1, axis=0)
    turns = (after - corners)[:, 0] * (point - corners)[:, 1]
    return (turns - (after - corners)[:, 1] * (point - corners)[:, 0]).min() >= -1e-9


def test_a_crease_that_is_not_folded_gives_orders_of_panels():
    """The third and the fourth panel are one piece, and the fourth lies over none."""
    state = exactfold.flat(halves(), "VVF").state()
    assert [set(some) for some in state.images.pieces.panels] == [{0}, {1}, {2, 3}]
    assert set(panel_orders(state)) == {(0, 1), (0, 2), (0, 3), (1, 2), (1, 3)}


def test_what_is_read_back_is_the_sheet_with_the_letters_of_the_state(tmp_path):
    file = tmp_path / "state.fold"
    texts = set()
    for state in exactfold.flat("waterbomb", "any"):
        file.write_text(document_text(state_document(state, "base")), encoding="utf-8")
        read = exactfold.read(file)
        assert dict(read.letters) == dict(state.letters)
        again = exactfold.flat(file)
        assert again.pattern == state.images.pieces.sheet
        assert state.orders in [one.orders for one in again]
        texts.add("".join(state.letters.values()))
    assert len(texts) > 1


def test_the_letters_of_a_state_are_those_that_were_asked_for():
    for name in ("miura", "bird-base", "map-fold"):
        found = exactfold.flat(name)
        assert dict(found.state().letters) == dict(found.letters)


def test_a_panel_above_and_below_another_one_has_no_order_in_fold():
    found = exactfold.flat(arms(), "V")
    assert found.count == 4
    torn = [state for state in found if len({state.above(*pair) for pair in state.orders}) > 1]
    for state in torn:
        with pytest.raises(NotApplicableError, match="panel 0 lies partly above and partly below"):
            state_document(state)
    whole = [state_document(state) for state in found if state not in torn]
    assert [one["file_frames"][0]["faceOrders"] for one in whole] == [[[0, 1, 1]]]
