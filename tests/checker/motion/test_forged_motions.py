"""Forged certificates of motions: other names, other curves, pieces that do not fit together."""

from __future__ import annotations

import itertools
import json
from fractions import Fraction
from functools import cache
from types import SimpleNamespace
from typing import Any

import pytest
from forge import Document, beyond, refused, verified, with_one_key_more
from sheets import nested_triangles, reflex_corners, star_in

from exactfold import checker
from exactfold.branches.counting.find import find_branch
from exactfold.checker.core.reading import CertificateError, FormatError, LimitError, shown
from exactfold.checker.motion import bounds as motion_bounds
from exactfold.checker.motion import certificate as motion
from exactfold.checker.motion.bounds import Bounds
from exactfold.checker.motion.chain import Path, chord
from exactfold.checker.motion.equations import LengthEquations
from exactfold.checker.motion.ray import check_half_branch
from exactfold.checker.motion.tubes import Ball, Start, Tube
from exactfold.checker.sheets.sheet import read_sheet
from exactfold.motion.tubes.tracks import follow_proved
from exactfold.pattern.families import two_vertex
from exactfold.pattern.triangulating.random_squares import random_square

SHEETS = {
    "convex": (two_vertex(), "+-", 5),
    "reflex": (star_in(reflex_corners(1)), "-", 2),
    "triangles": (nested_triangles(), "+-+", 2),
}


@cache
def _text(name: str) -> str:
    pattern, signs, tubes = SHEETS[name]
    track = follow_proved(find_branch(pattern, signs), most=tubes)
    return json.dumps(track.certificate())


def given(name: str = "convex") -> Document:
    """A fresh copy of a small certificate."""
    document: Document = json.loads(_text(name))
    return document


@pytest.mark.parametrize("name", SHEETS)
def test_claims_come_with_the_pattern(name: str) -> None:
    document = given(name)
    tubes = len(document["evidence"]["tubes"])
    claims = verified(document)
    digest = read_sheet(document["pattern"])[1]
    assert claims == {**document["claims"], "tubes": tubes, "sha256": digest}
    signs = "".join("-0+"[s + 1] for s in claims["vertex_signs"])
    assert checker.summary(claims) == (
        f"VALID: the motion along the ray {signs} ({len(signs)}), side +, is one curve "
        f"without a gap of length {shown(claims['length'])} or more; {tubes} tubes; sha256 {digest}"
    )


def test_summaries() -> None:
    claims = {"vertex_signs": [1] * 61, "side": -1, "length": "1", "tubes": 1, "sha256": "x"}
    assert motion.summary(claims) == (
        f"VALID: the motion along the ray {'+' * 60}... (61), side -, is one curve "
        "without a gap of length 1 or more; 1 tube; sha256 x"
    )
    assert f"{'+' * 60} (60)" in motion.summary({**claims, "vertex_signs": [1] * 60})


def test_formats() -> None:
    for change in ({"format": "exactfold motions"}, {"version": 2}, {"version": True}, {"more": 1}):
        with pytest.raises(FormatError):
            checker.load(json.dumps(given() | change))


def test_keys() -> None:
    for place, keys in (
        (("claims",), "claims: expected an object with the keys vertex_signs side length"),
        (
            ("evidence",),
            "evidence: expected an object with the keys emptied pinned bits start tubes",
        ),
        (
            ("evidence", "start"),
            "start: expected an object with the keys centre halvings held reach exit",
        ),
        (("evidence", "tubes", 0), "tube: expected an object with the keys centre row reach exit"),
    ):
        refused(with_one_key_more(given(), place), keys)


# --- names ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", SHEETS)
def test_every_sign_is_compared(name: str) -> None:
    document = given(name)
    interior = read_sheet(document["pattern"])[0].interior
    for k, sign in enumerate(document["claims"]["vertex_signs"]):
        for other in [x for x in (-1, 0, 1) if x != sign] + [bool(sign), str(sign), None]:
            forged = given(name)
            forged["claims"]["vertex_signs"][k] = other
            refused(forged, f"vertex {interior[k]} does not have the claimed sign")
    for other in (-1, 0, True, "1", None):
        forged = given(name)
        forged["claims"]["side"] = other
        refused(forged, "the side is not the claimed one")
    forged = given(name)
    forged["claims"]["vertex_signs"].append(1)
    refused(forged, f"vertex_signs does not have {len(interior)} entries")


def test_signs_that_are_not_certain_are_refused() -> None:
    """A box so wide that it holds both signs: of a vertex, of the saddle, of a reflex corner."""
    for name in ("convex", "reflex"):
        document = given(name)
        sheet = read_sheet(document["pattern"])[0]
        equations = LengthEquations(sheet, document["evidence"]["pinned"], 64)
        centre = document["evidence"]["start"]["centre"]
        signs = document["claims"]["vertex_signs"]

        def start(radii: list[int], equations: Any = equations, centre: Any = centre) -> Any:
            box = Ball(centre, radii)
            return SimpleNamespace(equations=equations, enclosure=lambda s: box)

        claims = {"vertex_signs": signs, "side": 1}
        sheets = SimpleNamespace(given=sheet, removed=set())
        check_half_branch(sheets, start([1] * equations.size), claims)
        wide = [1 << 70] * equations.size
        with pytest.raises(CertificateError, match=f"^vertex {sheet.interior[0]} may be flat$"):
            check_half_branch(sheets, start(wide), claims)
        sheets.given = SimpleNamespace(interior=[])
        with pytest.raises(CertificateError, match=r"^the side of the branch is not certain$"):
            check_half_branch(sheets, start(wide), {"vertex_signs": [], "side": 1})


def test_only_sheets_whose_branches_have_names() -> None:
    forged = given()
    forged["pattern"] = {
        "vertices": [["0", "0"], ["2", "0"], ["3", "1"], ["2", "2"], ["0", "2"], ["1", "1"]],
        "triangles": [[0, 1, 5], [1, 2, 5], [2, 3, 5], [3, 4, 5], [4, 0, 5]],
    }
    refused(forged, "there are not four boundary vertices")
    forged["pattern"] = {
        "vertices": [["0", "0"], ["2", "0"], ["2", "2"], ["0", "2"]],
        "triangles": [[0, 1, 2], [0, 2, 3]],
    }
    refused(forged, "no vertex of the sheet can fold")


# --- numbers out of range ------------------------------------------------------------------------


def test_numbers_out_of_range() -> None:
    for change, message in (
        ({"bits": 2049}, beyond("the bits", 2049, 2048, "MOTION_BITS")),
        ({"bits": 59}, "the coordinates need more bits"),
        ({"bits": -1}, "bits is not a natural number"),
        ({"tubes": [None] * 4097}, beyond("the tubes", 4097, 4096, "MOST_TUBES")),
        ({"tubes": {}}, "tubes is not a list"),
        ({"pinned": [0, 1, 2]}, "the pinned vertices are not those of a face"),
        ({"pinned": [0, 0, 1]}, "the pinned vertices are not those of a face"),
        ({"pinned": [0, 1]}, "pinned does not have 3 entries"),
    ):
        forged = given()
        forged["evidence"] |= change
        refused(forged, message)
    large = str(3**60)
    forged = given()
    forged["pattern"]["vertices"] = [
        [str(Fraction(x) * 3**60) if k else x for k, x in enumerate(p)]
        for p in forged["pattern"]["vertices"]
    ]
    refused(forged, "the coordinates need more bits")
    assert len(large) > 20
    for part, change, message in (
        ("start", {"halvings": 2049}, "halvings are out of range"),
        ("start", {"reach": 0}, "the reach is out of range"),
        ("start", {"reach": 16 * 64 + 1}, "the reach is out of range"),
        ("start", {"held": 99}, "the vertex held at its height is not one that can move"),
        ("start", {"exit": 0}, "the motion does not leave the flat state"),
        ("start", {"exit": -1}, "exit is not a natural number"),
        ("tube", {"reach": 0}, "the reach is out of range"),
        ("tube", {"exit": True}, "True is not an integer"),
    ):
        forged = given()
        evidence = forged["evidence"]
        (evidence["start"] if part == "start" else evidence["tubes"][0]).update(change)
        refused(forged, message)
    for part, key in (("start", "centre"), ("tube", "centre"), ("tube", "row")):
        for value in (1 << 124, -(1 << 124) - 1):
            forged = given()
            evidence = forged["evidence"]
            (evidence["start"] if part == "start" else evidence["tubes"][0])[key][0] = value
            refused(forged, f"a number of the {key} is out of range")


def test_the_work_is_bounded() -> None:
    pattern = random_square(100, seed=0)
    forged = given()
    forged["pattern"] = {
        "vertices": [[str(x), str(y)] for x, y in pattern.vertices],
        "triangles": [list(t) for t in pattern.triangles],
    }
    forged["evidence"] |= {"pinned": list(pattern.triangles[0]), "tubes": [None] * 4000}
    forged["evidence"]["emptied"] = [
        {"corners": list(corners), "inside": list(inside)}
        for corners, inside in pattern.triangulated_triangles
    ]
    with pytest.raises(LimitError, match="the products of numbers that the check needs, "):
        verified(forged)
    forged["evidence"] |= {"tubes": [None] * 100, "bits": 2048}
    with pytest.raises(LimitError, match="the products of numbers that the check needs, "):
        verified(forged)


# --- pieces that prove nothing -------------------------------------------------------------------


def test_a_centre_that_is_no_configuration_is_refused() -> None:
    for size in (1 << 56, 1 << 50):
        forged = given()
        forged["evidence"]["tubes"][1]["centre"][2] += size
        with pytest.raises(CertificateError):
            verified(forged)
    forged = given()
    forged["evidence"]["tubes"][1]["centre"][2] += 1 << 57
    refused(forged, "a tube does not hold one zero for each parameter")
    forged = given()
    forged["evidence"]["start"]["centre"][2] += 1 << 60
    with pytest.raises(CertificateError):
        verified(forged)


def test_a_reach_that_is_too_long_is_refused() -> None:
    for part in ("start", "tube"):
        messages = set()
        for reach in (3 * 64, 4 * 64, 16 * 64):
            forged = given()
            evidence = forged["evidence"]
            (evidence["start"] if part == "start" else evidence["tubes"][0])["reach"] = reach
            with pytest.raises(CertificateError) as caught:
                verified(forged)
            messages.add(str(caught.value))
        assert messages <= {
            "a matrix is not near the inverse of the Jacobian along a tube",
            "a tube does not hold one zero for each parameter",
        }


def test_bounds_that_prove_nothing_are_refused() -> None:
    def bounds(b: Any, q: Any, kappa: Any) -> Bounds:
        return Bounds(*([round(Fraction(x) * (1 << 128))] for x in (b, q, kappa)))

    assert 1 < bounds(1, 0, "1/100").radius(Fraction(1)) < Fraction(11, 10)
    for q in (1, 2):
        with pytest.raises(CertificateError, match=r"^a matrix is not near the inverse"):
            bounds("1/100", q, 1).radius(Fraction(1))
    for b, q, kappa in ((1, 0, "1/2"), (1, 0, 1), ("1/4", "1/2", "1/2"), ("1/100", "99/100", 1)):
        with pytest.raises(CertificateError, match=r"^a tube does not hold one zero"):
            bounds(b, q, kappa).radius(Fraction(1))
    for q, kappa in ((0, 3), ("1/2", 5), ("99/100", "1/7")):
        room = bounds(0, q, kappa).uniqueness(Fraction(1))
        assert Fraction(q) + Fraction(kappa) * room < 1
        assert Fraction(q) + Fraction(kappa) * room > Fraction(q) + (1 - Fraction(q)) * Fraction(
            9, 10
        )
    one = 1 << 128
    steep = Bounds([0, 2 * one], [0, one // 4], [one])
    assert steep.velocity(Fraction(1), Fraction(1, 4)) == Fraction(2 + Fraction(1, 16)) * 2


def test_a_singular_state_is_refused() -> None:
    forged = given()
    tube = forged["evidence"]["tubes"][0]
    tube["centre"] = [int(k % 3 == 2) << 2 for k in range(len(tube["centre"]))]
    tube["centre"][2] *= 3
    refused(forged, "a Jacobian is nearly singular")
    tube["centre"] = [0] * len(tube["centre"])
    refused(forged, "malformed: ZeroDivisionError while checking")


# --- links ---------------------------------------------------------------------------------------


def test_a_gap_is_refused() -> None:
    forged = given()
    forged["claims"]["length"] = "0"
    del forged["evidence"]["tubes"][:-1]
    refused(forged, "a motion enters a tube beyond its reach")
    forged = given()
    forged["evidence"]["tubes"].reverse()
    with pytest.raises(CertificateError):
        verified(forged)


def test_the_next_tube_must_reach_back() -> None:
    forged = given()
    first, second = forged["evidence"]["tubes"][:2]
    first["exit"] //= 2
    second["reach"] = 1
    refused(forged, "a motion enters a tube beyond its reach")


def test_a_tube_must_be_left_within_its_reach_and_after_it_is_entered() -> None:
    forged = given()
    tube = forged["evidence"]["tubes"][-1]
    tube["exit"] = (tube["reach"] << 34) + 1
    refused(forged, "a motion leaves a tube beyond its reach")
    forged = given()
    forged["evidence"]["tubes"][0]["exit"] = 0
    refused(forged, "a motion leaves a tube before it enters")
    forged = given()
    start = forged["evidence"]["start"]
    start["exit"] = 1 << 21
    refused(forged, "a motion leaves a tube beyond its reach")


def test_a_tube_that_is_entered_backwards_is_refused() -> None:
    forged = given()
    tube = forged["evidence"]["tubes"][-1]
    tube["row"] = [-t for t in tube["row"]]
    refused(forged, "a motion may enter a tube backwards")


def test_another_curve_is_not_entered() -> None:
    """The mirror image of a tube is a tube, but not one that this motion enters."""
    forged = given()
    for tube in forged["evidence"]["tubes"]:
        for key in ("centre", "row"):
            tube[key] = [-x if k % 3 == 2 else x for k, x in enumerate(tube[key])]
    with pytest.raises(CertificateError):
        verified(forged)
    document = given()
    sheet = read_sheet(document["pattern"])[0]
    evidence = document["evidence"]
    equations = LengthEquations(sheet, evidence["pinned"], evidence["bits"])
    entry = evidence["tubes"][0]
    tube_ = Tube(equations, entry["centre"], entry["row"], Fraction(entry["reach"], 64))
    ball, velocity = tube_.enclosure(Fraction(0)), tube_.velocity(Fraction(0))
    assert abs(tube_.entered(ball, velocity)) < Fraction(1, 10**6)
    # Across the row, so that only the distance tells.
    i = next(k for k in range(equations.size - 1) if tube_.row[k] and tube_.row[k + 1])
    unit = tube_.apart * Fraction(max(tube_.weights) << equations.bits, 1 << 16)
    size = int(2 * unit) // max(abs(tube_.row[i]), abs(tube_.row[i + 1])) + 1
    away = list(ball.centre)
    away[i] += tube_.row[i + 1] * size
    away[i + 1] -= tube_.row[i] * size
    with pytest.raises(CertificateError) as caught:
        tube_.entered(Ball(away, ball.radii), velocity)
    assert str(caught.value) == "a motion does not enter the next tube where zeros are unique"


def test_a_length_that_is_too_long_is_refused() -> None:
    claims = given()["claims"]
    true = Fraction(claims["length"])
    forged = given()
    forged["claims"]["length"] = str(true * Fraction(1001, 1000))
    refused(forged, "the motion is shorter than claimed")
    forged["claims"]["length"] = "-1"
    verified(forged)
    shorter = given()
    del shorter["evidence"]["tubes"][-1]
    refused(shorter, "the motion is shorter than claimed")


def test_the_centre_of_a_tube_counts_where_it_is_on_the_way() -> None:
    document = given()
    evidence, claims = document["evidence"], document["claims"]
    sheet, entry = read_sheet(document["pattern"])[0], evidence["tubes"][-1]
    equations = LengthEquations(sheet, evidence["pinned"], evidence["bits"])
    tube_ = Tube(equations, entry["centre"], entry["row"], Fraction(entry["reach"], 64))
    early = -entry["reach"] << 31  # an eighth of the reach before the centre
    places = [tube_.enclosure(Fraction(x, 1 << 40)) for x in (early, 0, entry["exit"])]
    before, after = (
        chord(a, b, equations.bits) * equations.unit for a, b in itertools.pairwise(places)
    )
    # The way through the centre is longer than the straight one, and it may be claimed.
    straight = chord(places[0], places[2], equations.bits) * equations.unit
    assert before + after > straight
    reach = tube_.reach / 3
    for begin, end, way in ((-1, 1, (-1, 0, 1)), (-2, -1, (-2, -1)), (1, 2, (1, 2))):
        path = Path((tube_.enclosure(begin * reach), tube_.velocity(begin * reach)), tube_.bits)
        so_far = path.length
        path.enter(tube_)
        path.leave(end * reach)
        balls = [tube_.enclosure(at * reach) for at in way]
        ways = [chord(a, b, tube_.bits) for a, b in itertools.pairwise(balls)]
        assert path.length - so_far == sum(ways)
    # Left before it, it may not: not even the way there and back.
    entry["exit"] = early
    claims["length"] = str(Fraction(claims["length"]) - before - after)
    verified(document)
    claims["length"] = str(Fraction(claims["length"]) + 2 * before)
    refused(document, "the motion is shorter than claimed")


def test_chords_are_lower_bounds() -> None:
    a, b = Ball([0, 0], [0, 0]), Ball([3 << 20, 4 << 20], [0, 0])
    assert 0 <= 5 - chord(a, b, 20) < Fraction(1, 10**5)
    wide = Ball([3 << 20, 4 << 20], [1 << 20, 0])
    assert 0 <= 4 - chord(a, wide, 20) < Fraction(1, 10**5)
    assert chord(a, Ball([1, 0], [5, 5]), 20) == 0


def test_the_start_is_that_of_its_branch() -> None:
    """The start of another branch, put in place of the first, has other signs."""
    other = json.loads(
        json.dumps(follow_proved(find_branch(two_vertex(), "++"), most=2).certificate())
    )
    forged = given()
    forged["evidence"] = other["evidence"]
    refused(forged, "vertex 5 does not have the claimed sign")
    document = given()
    sheet = read_sheet(document["pattern"])[0]
    equations = LengthEquations(sheet, document["evidence"]["pinned"], 64)
    entry = document["evidence"]["start"]
    held = equations.place[entry["held"]] + 2
    start = Start(equations, entry["centre"], entry["halvings"], held, Fraction(1, 64))
    assert start.radius < Fraction(1, 10**8)


def test_roundings_go_up() -> None:
    for h in (Fraction(1, 3), Fraction(7, 4), Fraction(0), Fraction(1, 3**200)):
        for coefficients in ([5], [0, 1], [1, 2, 3], [1 << 128, 0, 1 << 130]):
            exact = sum((c * h**k for k, c in enumerate(coefficients)), Fraction(0))
            assert 0 <= motion_bounds.value(coefficients, h) - exact < 4 * max(1, h) ** 2
    assert [motion_bounds.up(x, 2) for x in (-5, -4, -3, 0, 1, 4, 5)] == [-1, -1, 0, 0, 1, 1, 2]
