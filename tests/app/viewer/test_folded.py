"""What the page shows of a sheet that is folded flat, against its states and motions."""

import json
from itertools import combinations

import numpy as np
import pytest
from jsonschema import Draft202012Validator, ValidationError

from exactfold import Opened, PanelPattern, schema
from exactfold._support.clock import Clock
from exactfold.app.viewer import view_document
from exactfold.app.viewer.coding import decoded_frames, levelled
from exactfold.app.viewer.folded import flat_states, folded_sheet
from exactfold.layers import fold_flat
from exactfold.motion import follow_panels
from exactfold.pattern.loading import open_sheet

RIM = [(1, 2), (2, 3), (3, 4), (4, 5), (5, 6), (6, 7), (7, 8), (1, 8)]
VERTEX = PanelPattern(
    [(0, 0), (4, 0), (4, 3), (4, 4), (-3, 4), (-4, 4), (-4, -4), (0, -4), (4, -4)],
    [*RIM, (0, 1), (0, 2), (0, 4), (0, 7)],
)
"""A vertex whose four folds bound sectors of about 37, 90, 143 and 90 degrees."""
LETTERS = dict(zip(((0, 1), (0, 2), (0, 4), (0, 7)), "MMMV", strict=True))
"""Letters that fold flat at no order of layers, as the smallest sector lies between mountains."""


@pytest.fixture(scope="module")
def vertex():
    return view_document(Opened(VERTEX, LETTERS), name="vertex", frames=9)


def inside(corners, point, slack=0.0):
    """Whether a point lies in a convex polygon, counter-clockwise."""
    (x, y), (a, b) = (np.roll(corners, -1, axis=0) - corners).T, (point - corners).T
    return bool(np.all(x * b - y * a > -slack))


def test_shapes_lie_in_the_order_of_the_layers():
    found = fold_flat("pinwheel-base", "any")
    sheet = folded_sheet(found, Clock())
    assert (sheet["letters"], sheet["states"], sheet["picture"]) == ("any", 16, "")
    assert sheet["answer"] == "16 flat-folded states with any mountains and valleys - PROVED"
    shapes = [np.array(shape["corners"]).reshape(-1, 2) for shape in sheet["shapes"]]
    images, folds = found.images, found.pattern.folds
    for state, stack in zip(found, sheet["stacks"], strict=True):
        assert stack["letters"] == "".join(state.letters[fold] for fold in folds)
        for corners in (shapes[k] for k in stack["layers"]):
            point = np.average(corners, axis=0, weights=[7, 10, 18, 26, 31, 40][: len(corners)])
            here = [k for k in stack["layers"] if inside(shapes[k], point)]
            pieces = state.stack(point.tolist())[::-1]
            assert len(here) == len(pieces)
            for k, piece in zip(here, pieces, strict=True):
                polygon = np.array([images.places[v] for v in images.pieces.polygons[piece]])
                turned = images.maps[piece].flipped
                around = polygon[::-1] if turned else polygon
                assert all(inside(around, corner, 1e-4) for corner in shapes[k])
                assert sheet["shapes"][k]["front"] is not turned


def test_lines_on_a_shape_are_folds_and_border(vertex):
    sheet = vertex["folded"]["sheets"][1]
    lines = [fold for shape in sheet["shapes"] for fold in shape["folds"]]
    assert sorted(fold for fold in lines if fold >= 0) == [0, 0, 1, 1, 2, 2, 3, 3]
    assert lines.count(-1) == len(RIM)
    for shape in sheet["shapes"]:
        assert len(shape["lines"]) == 4 * len(shape["folds"])


def test_a_sheet_that_does_not_fold_flat_as_drawn_says_why_and_has_other_states(vertex):
    drawn, free = vertex["folded"]["sheets"]
    assert (drawn["letters"], drawn["status"], drawn["states"]) == ("drawn", "refuted", 0)
    assert drawn["stacks"] == []
    assert drawn["reasons"][0] == "crease 0-4 between panels 2 and 1 is a mountain"
    assert drawn["picture"].startswith("<svg")
    assert ">panel 0<" in drawn["picture"]
    assert "panels" not in drawn["picture"]  # the page writes the reasons itself
    assert (free["letters"], free["status"], free["states"]) == ("any", "proved", 4)


def test_ways_end_in_states_and_the_layers_lie_apart_in_the_last_frame(vertex):
    ends = vertex["folded"]["ends"]
    assert [end["said"] for end in ends] == [
        f"way {way} folds rigidly from the flat sheet to flat-folded state {state} of those with "
        f"any letters (to the other side: {other}), without contact"
        for way, state, other in ((1, 3, 0), (2, 2, 1))
    ]
    states = vertex["folded"]["sheets"][1]["stacks"]
    for end, way in zip(ends, vertex["ways"], strict=True):
        assert (end["status"], end["letters"]) == ("proved", "any")
        assert end["stack"]["letters"] == states[end["state"]]["letters"] == way["letters"]
        turned = way["letters"].translate(str.maketrans("MV", "VM"))
        assert states[end["mirrored"]]["letters"] == turned
        layered = np.array(end["layered"]).reshape(-1, 3)
        closing = follow_panels(VERTEX, way=way["number"], until="179.9deg", frames=2).coords[-1]
        ours, theirs = volumes(layered), volumes(closing)
        assert np.allclose(ours / ours.max(), theirs / theirs.max(), atol=1e-3)
        last = decoded_frames(way["motion"])[-1]
        assert np.allclose(layered[:, :2], last[:, :2], atol=1e-5)


def volumes(points):
    """The signed volumes of all tetrahedra: small ones have the heights of layers, and sides."""
    four = np.array(list(combinations(range(len(points)), 4)))
    return np.linalg.det(points[four[:, 1:]] - points[four[:, :1]])


def test_documents_are_what_their_schema_says(vertex):
    document = json.loads(json.dumps(vertex))
    Draft202012Validator(schema("view")).validate(document)
    document["folded"]["sheets"][1]["stacks"][0]["layers"] = [-1]
    with pytest.raises(ValidationError, match="-1 is less than the minimum"):
        Draft202012Validator(schema("view")).validate(document)


def test_nothing_is_searched_for_when_the_time_is_over():
    opened = open_sheet(VERTEX)
    assert flat_states(opened, Clock(0)) == ()
    [found] = flat_states(opened, Clock())
    assert found.letters_used == "any"  # the sheet has no letters
    assert len(folded_sheet(found, Clock(0))["stacks"]) == 1


def test_a_page_says_that_nothing_was_searched_for(vertex):
    assert vertex["folded"]["left"] == ""
    left = view_document(Opened(VERTEX), frames=3, limit=1e-9)["folded"]
    assert (left["sheets"], left["ends"]) == ([], [])
    assert left["left"].endswith("was reached; `exactfold flat` looks for flat-folded states")


def test_letters_that_cannot_help_are_not_tried():
    straight = PanelPattern(VERTEX.vertices, [*RIM, (0, 1), (0, 2), (0, 3), (0, 7)])
    [found] = flat_states(Opened(straight, LETTERS), Clock())
    assert found.failures[0].condition == "kawasaki"
    drawn, free = flat_states(Opened(VERTEX, dict.fromkeys(LETTERS, "M")), Clock())
    assert (drawn.failures[0].condition, free.count) == ("maekawa", 4)


def test_a_motion_that_ends_in_a_plane_ends_level():
    motion = follow_panels(VERTEX, way=1, until="180deg", frames=9)
    shapes = levelled(motion.coords)
    assert np.ptp(shapes[-1][:, 2]) < 1e-6
    assert np.allclose(shapes[0], motion.coords[0] - motion.coords[0].mean(axis=0))
    apart = [c[:, :, None] - c[:, None] for c in (motion.coords, shapes)]
    assert np.allclose(*(np.linalg.norm(a, axis=3) for a in apart), atol=1e-9)
