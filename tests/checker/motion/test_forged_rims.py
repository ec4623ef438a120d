"""Forged certificates of motions along a rim path: other heights, and a false branch point."""

from __future__ import annotations

import json
from fractions import Fraction
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from forge import Document, refused, verified, without

from exactfold.branches.counting.find import find_branch
from exactfold.checker.core.reading import CertificateError
from exactfold.checker.motion import certificate as motion
from exactfold.checker.motion.boundary import BoundaryHeights
from exactfold.checker.motion.equations import LengthEquations
from exactfold.checker.motion.ray import check_half_branch
from exactfold.checker.motion.restriction import saddle_of
from exactfold.checker.motion.tubes import Ball
from exactfold.checker.sheets.sheet import read_sheet
from exactfold.motion.curves.boundary_path import boundary_claim, ties_of
from exactfold.motion.curves.framework import Framework
from exactfold.motion.tubes.branch_point_tube import prove_branch_point_tube
from exactfold.motion.tubes.certificate import motion_certificate
from exactfold.motion.tubes.flat_patches import FlatPatch
from exactfold.motion.tubes.length_equations import LengthEquations as LengthEquationsOfProver
from exactfold.motion.tubes.links import onwards
from exactfold.motion.tubes.tracks import Track, follow_proved
from exactfold.motion.tubes.tube_start import prove_start
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.families import two_vertex
from exactfold.rigidity.equations.gauge import RIM, Gauge

# A star of degree four, and an ear on one of its sides.
STAR = CreasePattern(
    [(0, 0), (8, 1), (7, 9), (-1, 8), (11, 5), (3, 4)],
    [(0, 1, 5), (1, 2, 5), (2, 3, 5), (3, 0, 5), (2, 1, 4)],
)
HEIGHTS = {0: 0, 1: 1, 2: 0, 3: Fraction(1, 2), 4: 3}


@cache
def _track() -> Track:
    return follow_proved(find_branch(STAR, "+", boundary_heights=HEIGHTS), most=1)


@cache
def _text(name: str) -> str:
    if name == "star":
        return json.dumps(_track().certificate())
    return json.dumps(follow_proved(find_branch(two_vertex(), "+-"), most=1).certificate())


def given(name: str = "star") -> Document:
    """A fresh copy of a small certificate."""
    document: Document = json.loads(_text(name))
    return document


def test_the_claims_say_which_rim() -> None:
    claims = verified(given())
    assert claims["rim"] == ["0", "1", "0", "1/2", "3"]
    assert claims["pinned"] == given()["evidence"]["pinned"]
    long = {**claims, "rim": [str(k) for k in range(10)]}
    assert ", in the ratio" not in motion.summary(long)
    assert "the ratio of 0, 1, 2, 3, 4, 5, 6, 7, ... above the face" in motion.summary(long)


def test_the_same_rim_in_other_words() -> None:
    """A multiple, and a plane more: the same rim path, and its other side."""
    document = given()
    vertices = [tuple(map(Fraction, pair)) for pair in document["pattern"]["vertices"]]
    heights = [2 * HEIGHTS[v] + 3 * vertices[v][0] - vertices[v][1] + 1 for v in range(5)]
    document["claims"]["rim"] = [str(h) for h in heights]
    assert verified(document)["side"] == 1
    document["claims"]["rim"] = [str(-h) for h in heights]
    with without("the side is not the claimed one"):
        verified(document)
    refused(document, "the side is not the claimed one")
    document["claims"]["side"] = -1
    assert verified(document)["side"] == -1


def test_another_rim() -> None:
    document = given()
    document["claims"]["rim"][4] = "2"
    refused(document, "a tube does not hold one zero for each parameter")
    del document["claims"]["rim"]
    refused(document, "there are not four boundary vertices")


def test_heights_that_are_no_rim() -> None:
    for rim in (["0", "1", "0", "1/2"], ["0", "1", "0", "1/2", "3", "0"]):
        refused(_with(rim=rim), "rim does not have 5 entries")
    refused(_with(rim="01023"), "rim is not a list")
    refused(_with(rim=["0", "1", "0", "1/2", 3]), "3 is not a rational number in quotes")


def test_a_rim_in_one_plane() -> None:
    """It has no ratio, by which the checker would divide; nothing else says so."""
    for heights in ([x + 2 * y - 3 for x, y in STAR.vertices[:5]], [0] * 5):
        forged = _with(rim=[str(h) for h in heights])
        said = (
            f"the given heights {', '.join(map(str, heights))} lie in one plane: there is no ratio"
        )
        with without(said):
            refused(forged, "malformed: ZeroDivisionError while checking")
        refused(forged, said)


def _with(**claims: object) -> Document:
    document = given()
    document["claims"] |= claims
    return document


def test_bits_of_the_rim() -> None:
    """Rows of integers that do not fit are refused, not rounded."""
    document = _with(rim=["0", "1", "0", "1/2", f"{10**40 + 1}/{10**40}"])
    refused(document, "the coordinates need more bits")


def test_with_four_corners_a_rim_says_the_same() -> None:
    document = given("square")
    sheet = read_sheet(document["pattern"])[0]
    saddle = saddle_of(sheet)
    first = next(iter(sorted(saddle)))
    rim = [str(int(v == first)) for v in sorted(saddle)]
    document["claims"]["rim"] = rim if saddle[first] > 0 else [f"-{h}" for h in rim]
    assert verified(document)["side"] == 1


def test_a_side_that_is_not_certain() -> None:
    document = given()
    sheet = read_sheet(document["pattern"])[0]
    rim = BoundaryHeights(sheet, document["claims"]["rim"])
    equations = LengthEquations(sheet, document["evidence"]["pinned"], 64, rim)
    centre = document["evidence"]["start"]["centre"]
    place = equations.place
    wide = max((v for v in rim.factor if v in place), key=lambda v: abs(rim.factor[v]))
    radii = [0] * equations.size
    radii[place[wide] + 2] = 1 << 70
    box = Ball(centre, radii)
    start = SimpleNamespace(equations=equations, enclosure=lambda s: box)
    claims = {"vertex_signs": [1], "side": 1}
    with pytest.raises(CertificateError, match="the side of the branch is not certain"):
        check_half_branch(SimpleNamespace(given=sheet, removed={5}), start, claims)


def test_a_border_that_is_not_convex() -> None:
    """A curve with these signs and this rim; but nothing says that it is the only one."""
    points = [(0, 0), (10, -3), (16, 5), (7, 6), (-2, 9), (5, 3)]
    dented = CreasePattern(points, [(k, (k + 1) % 5, 5) for k in range(5)])
    rim = {0: Fraction(0), 1: Fraction(1), 2: Fraction(0), 3: Fraction(0), 4: Fraction(1)}
    gauge = Gauge(RIM, dented, rim)
    ties = ties_of(SimpleNamespace(sheet=dented, gauge=gauge))
    framework = Framework.of(dented, None, ties)
    start = prove_start(framework, gauge, np.array([*map(float, rim.values()), 1.5]))
    document = motion_certificate(dented, range(6), start, [], [boundary_claim(rim)])
    with without("the boundary is not convex"):
        verified(json.loads(json.dumps(document)))
    refused(document, "the boundary is not convex")


def test_the_flat_state_is_no_node_to_come_to() -> None:
    """The ear leaves one height beside the flat star, which the tie fixes.

    So the flat state is a regular zero of the equations of a branch point, and the motion leaves it
    along an arc: it does not come to it.
    """
    track = _track()
    framework, start = track.framework, track.start
    patch = FlatPatch.of(framework, [5])
    assert patch is not None
    along = np.array(start.coefficients[0], dtype=float)
    along[[i for i in range(len(along)) if i % 3 != 2]] = 0
    arc = prove_branch_point_tube(framework, patch, np.zeros(framework.size), along)
    assert arc is not None
    early = start.last // 3  # the arc does not reach as far as the start tube
    ahead = onwards(
        LengthEquationsOfProver.of(framework),
        start.ball(early),
        start.ball_velocity(early),
        start.length(0, early),
        0.02,
    )
    link = next(ahead)
    entry = arc.longest * 15 // 16
    met = link.tube.located(arc.ball(entry))
    assert met is not None
    assert link.entry[1] < met[0]
    document = given()
    document["evidence"]["start"]["exit"] = early
    tube = {
        "centre": list(link.tube.coefficients[0]),
        "row": list(link.tube.row),
        "reach": link.tube.reach,
    }
    document["evidence"]["tubes"] = [tube]
    document["claims"] |= {"length": "1/100", "node": {"flat": [5], "clear": False}}
    document["evidence"]["node"] = {
        "node": list(arc.branch_point.centre),
        "centre": list(arc.coefficients[0]),
        "row": list(arc.row),
        "reach": arc.reach,
        "entry": entry,
    }
    message = "an arc does not lead to its branch point"
    with without(message):
        verified(document)
    refused(document, message)
