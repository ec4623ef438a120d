"""Forged certificates of loops: other ends, false branch points, links that are left out."""

from __future__ import annotations

import io
import json
import random
from fractions import Fraction
from functools import cache
from operator import mul
from typing import Any, cast

import numpy as np
import pytest
from forge import Document, Lines, beyond, chained, given_lines

from exactfold.checker.core.lines import lines
from exactfold.checker.core.reading import (
    CertificateError,
    FormatError,
    LimitError,
    UnfinishedError,
)
from exactfold.checker.motion import bounds as motion_bounds
from exactfold.checker.motion import branch_points as motion_nodes
from exactfold.checker.motion import loops as motion_loops
from exactfold.checker.motion import patches as motion_patches
from exactfold.checker.motion.branch_points import BranchPointTube, Stresses, independent
from exactfold.checker.motion.chain import Path, through
from exactfold.checker.motion.equations import LengthEquations, at
from exactfold.checker.motion.loops import LoopSheet, Matching
from exactfold.checker.motion.patches import Patch, wheel_stress
from exactfold.checker.motion.pieces import PARAMETER_BITS, tube_of, vector
from exactfold.checker.motion.tubes import Ball
from exactfold.checker.sheets.sheet import read_sheet

ONE, NODE = "loops-one-vertex", "loops-node"


def verified(forged: Lines | bytes) -> Document:
    content = forged if isinstance(forged, bytes) else chained(forged)
    return motion_loops.check_lines(lines(io.BytesIO(content)))


def refused(forged: Lines | bytes, message: str, error: type[Exception] = CertificateError) -> None:
    """The checker refuses the file, with exactly this message."""
    with pytest.raises(error) as caught:
        verified(forged)
    assert str(caught.value) == message


def steps_of(forged: Lines) -> list[Document]:
    """The steps of the first loop."""
    found: list[Document] = forged[1]["evidence"]["steps"]
    return found


def test_the_loops_that_are_forged_here_verify() -> None:
    for name in (ONE, NODE):
        forged = given_lines(name)
        claims = verified(forged)
        assert claims == forged[-1]["claims"]
        matched, whole = claims["matched"], claims["half_branches"]
        how = f"all {whole}" if matched == whole else f"{matched} of {whole}"
        assert motion_loops.summary(claims) == (
            f"VALID: 1 loop of true motions, which match {how} rays; "
            f"sha256 {read_sheet(forged[0]['pattern'])[1]}"
        )
    nodes = [step for step in steps_of(given_lines(NODE)) if "flat" in step]
    assert nodes


# --- the file ------------------------------------------------------------------------------------


def test_formats() -> None:
    for change in ({"format": "exactfold loop"}, {"version": 2}, {"version": True}, {"more": 1}):
        forged = given_lines(ONE)
        forged[0] |= change
        with pytest.raises(FormatError):
            verified(forged)
    refused(b"", "the file is empty", FormatError)
    forged = given_lines(ONE)
    forged[0]["emptied"] = [{"corners": [0, 1, None], "inside": []}]
    refused(forged, "corner is not a natural number")
    forged[0]["emptied"] = [{"corners": [0, 1, 4], "inside": [99]}]
    refused(forged, "malformed: KeyError in the first line")


def test_lines_that_were_altered_or_left_out_break_the_chain() -> None:
    content = chained(given_lines(ONE))
    parts = content.splitlines(keepends=True)
    refused(content[:-1], "line 3 is cut off or was altered", FormatError)
    refused(parts[0] + parts[2], "line 2 is cut off or was altered", FormatError)
    refused(parts[0] + parts[2] + parts[1], "line 2 is cut off or was altered", FormatError)
    refused(content.replace(b'"to"', b'"ot"'), "line 2 is cut off or was altered", FormatError)


@pytest.fixture
def believed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Loops are believed: what is tested are the claims about all of them."""
    monkeypatch.setattr(LoopSheet, "check_loop", lambda sheet, entry: None)


@pytest.mark.usefixtures("believed")
def test_the_claims_come_last_and_once() -> None:
    header, loop, claims = given_lines(ONE)
    refused([header, loop], "1 loop holds, but the claims are missing", UnfinishedError)
    refused([header], "0 loops hold, but the claims are missing", UnfinishedError)
    refused([header, claims, loop], "a line follows the claims")
    refused([header, loop, claims, claims], "a line follows the claims")
    refused(
        [header, loop, claims | {"more": 1}],
        "the last line: expected an object with the keys claims",
    )


@pytest.mark.usefixtures("believed")
def test_every_claim_is_compared() -> None:
    parts = given_lines(ONE)
    true = parts[-1]["claims"]
    for key, others in {
        "sha256": ["", None],
        "loops": [2, 0, True, "1"],
        "matched": [2, 8, "4"],
        "half_branches": [8, 4.5],
        "complete": [False, 1, None],
    }.items():
        for other in others:
            forged = given_lines(ONE)
            forged[-1]["claims"][key] = other
            if other == 4.5:
                with pytest.raises(FormatError):
                    verified(forged)
            else:
                refused(forged, f"claim {key} = {other!a}, but it is {true[key]!a}")
    forged = given_lines(ONE)
    forged[-1]["claims"]["more"] = 1
    refused(
        forged,
        "claims: expected an object with the keys sha256 loops matched half_branches complete",
    )


@pytest.mark.usefixtures("believed")
def test_what_is_not_complete_is_not_claimed_complete() -> None:
    forged = given_lines(ONE)
    del forged[1]
    forged[-1]["claims"] |= {"loops": 0, "matched": 0}
    refused(forged, "claim complete = True, but it is False")
    forged[-1]["claims"]["complete"] = False
    assert verified(forged)["matched"] == 0
    forged = given_lines(NODE)
    assert forged[-1]["claims"]["complete"] is False


@pytest.mark.usefixtures("believed")
def test_no_half_branch_is_matched_twice() -> None:
    header, loop, claims = given_lines(ONE)
    claims["claims"]["loops"] = 2
    refused([header, loop, loop, claims], "loop 1: a ray is matched twice")
    back = loop | {"from": loop["to"], "to": loop["from"]}
    refused([header, loop, back, claims], "loop 1: a ray is matched twice")
    matching = Matching()
    up = ((1, -1, 0), 1)
    with pytest.raises(CertificateError, match=r"^loop 0: a ray is matched with itself$"):
        matching.add(up, up)
    matching.add(up, ((-1, 1, 0), -1))  # its own mirror image
    assert (matching.loops, len(matching.matched)) == (1, 2)
    matching.add(((1, 1, 0), 1), ((1, 1, 0), -1))
    assert (matching.loops, len(matching.matched)) == (2, 6)
    for other in (up, ((-1, -1, 0), 1), ((-1, -1, 0), -1)):
        with pytest.raises(CertificateError, match=r"^loop 2: a ray is matched twice$"):
            matching.add(((1, -1, 0), -1), other)


def test_the_first_line_that_does_not_hold_decides() -> None:
    header, loop, claims = given_lines(ONE)
    false = json.loads(json.dumps(loop))
    false["length"] = "100"
    for last in ([claims, claims], [loop, claims], [{"more": 1}], []):
        refused([header, false, *last], "loop 0: it is shorter than claimed")


def test_several_processes_say_the_same() -> None:
    parts = given_lines(ONE)
    content = chained(parts)
    assert motion_loops.check_lines(lines(io.BytesIO(content)), 2) == parts[-1]["claims"]
    parts[1]["length"] = "100"
    with pytest.raises(CertificateError, match=r"^loop 0: it is shorter than claimed$"):
        motion_loops.check_lines(lines(io.BytesIO(chained(parts))), 2)


def test_keys() -> None:
    for place, message in (
        ((), "loop: expected an object with the keys from to length evidence provenance"),
        (("from",), "ray: expected an object with the keys vertex_signs side"),
        (("to",), "ray: expected an object with the keys vertex_signs side"),
        (("evidence",), "evidence: expected an object with the keys start steps landing"),
        (
            ("evidence", "start"),
            "start: expected an object with the keys centre halvings held reach exit",
        ),
        (
            ("evidence", "steps", 0),
            "tube: expected an object with the keys centre row reach exit",
        ),
        (("evidence", "steps", -1), "tube: expected an object with the keys centre row reach"),
        (
            ("evidence", "landing"),
            "landing: expected an object with the keys centre halvings held reach tau",
        ),
    ):
        forged = given_lines(ONE)
        value: Any = forged[1]
        for key in place:
            value = value[key]
        value["more"] = 1
        outside = len(place) == 0 or place[0] in ("from", "to")
        refused(forged, message if outside else f"loop 0: {message}")
    forged = given_lines(ONE)
    forged[1]["evidence"]["start"] = None
    refused(
        forged,
        "loop 0: start: expected an object with the keys centre halvings held reach exit",
    )
    forged = given_lines(ONE)
    forged[1]["evidence"]["steps"] = [None]
    refused(forged, "loop 0: tube: expected an object with the keys centre row reach")
    forged[1]["evidence"]["steps"] = {}
    refused(forged, "loop 0: steps is not a list")


def test_numbers_out_of_range() -> None:
    forged = given_lines(ONE)
    forged[1]["evidence"]["steps"] = [None] * 4097
    refused(forged, beyond("the tubes", 4097, 4096, "MOST_TUBES"), LimitError)
    forged[1]["evidence"]["steps"] = [{"flat": []}] * 257
    refused(forged, beyond("the tubes", 257 * 16, 4096, "MOST_TUBES"), LimitError)
    for key in ("halvings", "held"):
        forged = given_lines(ONE)
        forged[1]["evidence"]["landing"][key] = 10**6
        with pytest.raises(CertificateError):
            verified(forged)
    for huge in (1 << 12000, -(1 << 12000)):
        forged = given_lines(ONE)
        forged[1]["evidence"]["landing"]["tau"] = huge
        refused(forged, "loop 0: a motion leaves a tube beyond its reach")
        forged = given_lines(ONE)
        steps_of(forged)[0]["exit"] = huge
        with pytest.raises(CertificateError):
            verified(forged)
    forged = given_lines(ONE)
    forged[0]["bits"] = 4096
    refused(forged, beyond("the bits", 4096, 2048, "MOTION_BITS"), LimitError)


# --- where a loop begins and ends ----------------------------------------------------------------


def test_other_names_are_refused() -> None:
    for end, message in (
        ("from", 'it does not begin along the ray "from"'),
        ("to", 'it does not end along the ray "to"'),
    ):
        for change in ({"side": -1}, {"side": 0}, {"vertex_signs": [0]}, {"vertex_signs": None}):
            forged = given_lines(ONE)
            entry = forged[1][end]
            if "side" in change:
                change = {"side": change["side"] * entry["side"]}
            elif change["vertex_signs"] is None:
                change = {"vertex_signs": [-s for s in entry["vertex_signs"]]}
            entry |= change
            if forged[1]["from"] == forged[1]["to"]:
                refused(forged, "loop 0: a ray is matched with itself")
            else:
                refused(forged, f"loop 0: {message}")
        for sign in (True, "1", None, 1.0):
            forged = given_lines(ONE)
            forged[1][end]["vertex_signs"] = [sign]
            with pytest.raises((CertificateError, FormatError), match=r"is not an integer|floats"):
                verified(forged)
        forged = given_lines(ONE)
        forged[1][end]["vertex_signs"].append(1)
        refused(forged, "vertex_signs does not have 1 entries")


def test_a_landing_on_the_mirror_image_is_refused() -> None:
    forged = given_lines(ONE)
    forged[1]["evidence"]["landing"]["tau"] *= -1
    with pytest.raises(CertificateError, match=r"^loop 0: a motion (enters|does not enter)"):
        verified(forged)
    forged = given_lines(ONE)
    forged[1]["evidence"]["landing"]["tau"] = 0
    refused(
        forged, "loop 0: the last tube of a motion must meet the start tube before the flat state"
    )


def test_a_landing_may_be_described_by_its_mirror_image() -> None:
    """A negative tau on the start tube of the mirror image: the same curve, the same names."""
    forged = given_lines(ONE)
    landing = forged[1]["evidence"]["landing"]
    landing["centre"] = [-x if k % 3 == 2 else x for k, x in enumerate(landing["centre"])]
    landing["tau"] *= -1
    assert verified(forged) == forged[-1]["claims"]
    forged[1]["to"]["side"] *= -1
    refused(forged, 'loop 0: it does not end along the ray "to"')


def test_a_landing_in_the_same_direction_is_refused() -> None:
    """The start itself, taken for the landing: the loop passes it away from the flat state."""
    forged = given_lines(ONE)
    evidence = forged[1]["evidence"]
    start = evidence["start"]
    evidence["landing"] = {key: x for key, x in start.items() if key != "exit"}
    evidence["landing"]["tau"] = start["exit"] + (1 << 10)
    evidence["steps"] = [{k: x for k, x in evidence["steps"][0].items() if k != "exit"}]
    refused(forged, "loop 0: a motion may enter a tube backwards")


def test_a_loop_lands_after_it_has_entered_the_last_tube() -> None:
    """A landing before it, as the path says; and none at all."""
    sheet, evidence = LoopSheet(given_lines(ONE)[0]), given_lines(ONE)[1]["evidence"]
    tube = tube_of(sheet.equations, evidence["steps"][0])
    here, later = (
        (tube.enclosure(s), tube.velocity(s)) for s in (Fraction(-1, 1000), Fraction(1, 1000))
    )
    path = Path(later, sheet.equations.bits)
    with pytest.raises(
        CertificateError, match=r"^a motion meets a branch point, or lands, where it is on no tube$"
    ):
        path.meet(*later)
    path.enter(tube)
    with pytest.raises(CertificateError, match=r"^a motion meets another piece before it enters"):
        path.meet(*here)
    with pytest.raises(CertificateError, match=r"^a motion leaves a tube before it enters$"):
        path.leave(Fraction(-1, 1000))
    forged = given_lines(ONE)
    forged[1]["evidence"]["steps"] = []
    refused(forged, "loop 0: a motion meets a branch point, or lands, where it is on no tube")
    forged = given_lines(ONE)
    steps_of(forged)[1]["exit"] = -steps_of(forged)[1]["exit"]
    refused(forged, "loop 0: a motion leaves a tube before it enters")


def test_links_that_are_left_out_leave_a_gap() -> None:
    for first, last in ((0, 3), (5, 9), (-4, -1)):
        forged = given_lines(ONE)
        del steps_of(forged)[first:last]
        with pytest.raises(CertificateError, match=r"^loop 0: a motion (enters|does not enter)"):
            verified(forged)
    forged = given_lines(ONE)
    del steps_of(forged)[-1]
    del steps_of(forged)[-1]["exit"]
    with pytest.raises(CertificateError, match=r"^loop 0: a motion (enters|does not enter)"):
        verified(forged)


def test_a_length_that_is_too_long_is_refused() -> None:
    length = Fraction(given_lines(ONE)[1]["length"])
    forged = given_lines(ONE)
    forged[1]["length"] = str(length * Fraction(1001, 1000))
    refused(forged, "loop 0: it is shorter than claimed")
    forged[1]["length"] = "-1"
    verified(forged)


def test_the_length_of_a_path_is_that_of_its_chords() -> None:
    def at(x: int, y: int) -> Ball:
        return Ball([x << 20, y << 20], [0, 0])

    path = Path((at(3, 4), at(0, 0)), 20)
    path.go(at(3, 16), at(0, 0))
    path.go(at(8, 16), at(0, 0))
    path.go(at(8, 6), at(0, 0))
    path.land()
    assert 0 <= 5 + 12 + 5 + 10 + 10 - path.length < Fraction(1, 10**4)


# --- branch points
# ---------------------------------------------------------------------------------------


@cache
def _node() -> tuple[LoopSheet, str, str]:
    """The sheet, the first branch point that its loop passes, and the tube before it."""
    header, loop, _ = given_lines(NODE)
    steps = loop["evidence"]["steps"]
    k = next(k for k, step in enumerate(steps) if "flat" in step)
    return LoopSheet(header), json.dumps(steps[k]), json.dumps(steps[k - 1])


def node() -> Document:
    entry: Document = json.loads(_node()[1])
    return entry


def passed(entry: Any, backwards: bool = False) -> Path:
    """The path that enters the tube before the branch point at its centre, and passes it."""
    sheet, _, before = _node()
    tube = tube_of(sheet.equations, json.loads(before))
    if backwards:
        tube.row = [-t for t in tube.row]
        tube.curve = [[(-1) ** k * x for x in row] for k, row in enumerate(tube.curve)]
    path = Path((tube.enclosure(Fraction(0)), tube.velocity(Fraction(0))), sheet.equations.bits)
    path.enter(tube)
    through(sheet.equations, path, entry)
    return path


def not_passed(entry: Any, message: str, backwards: bool = False) -> None:
    with pytest.raises(CertificateError) as caught:
        passed(entry, backwards)
    assert str(caught.value) == message


def test_a_node_is_passed() -> None:
    path = passed(node())
    assert path.tube is None
    assert path.length > 0


def test_keys_of_a_node() -> None:
    not_passed(
        node() | {"more": 1},
        "node: expected an object with the keys flat node centre row reach entry exit",
    )
    for key, value, message in (
        ("flat", None, "flat is not a list"),
        ("flat", ["9"], "flat vertex is not a natural number"),
        ("node", [], f"node does not have {_node()[0].equations.size} entries"),
        ("centre", [1 << 200], f"centre does not have {_node()[0].equations.size} entries"),
        ("entry", None, "None is not an integer"),
        ("exit", True, "True is not an integer"),
        ("reach", 0, "the reach is out of range"),
    ):
        not_passed(node() | {key: value}, message)
    for key in ("node", "centre", "row"):
        entry = node()
        entry[key][0] = 1 << 124
        not_passed(entry, f"a number of the {key} is out of range")


def test_vertices_that_are_not_flat_are_refused() -> None:
    sheet = _node()[0]
    interior, flat = sheet.given.interior, node()["flat"]
    inner = "the flat vertices of a branch point are none, or not sorted interior vertices"
    for other in ([], [*flat, *flat], [sheet.given.boundary[0]], [99], [*reversed(interior)]):
        not_passed(node() | {"flat": other}, inner)
    square = "with a flat patch there are no unknowns, or not as many equations as these"
    not_passed(node() | {"flat": interior}, square)  # the flat state
    for v in interior:
        degree = len(sheet.given.star(v))
        if degree != 4:
            not_passed(node() | {"flat": [v]}, square)
        elif [v] != flat:
            with pytest.raises(CertificateError):
                passed(node() | {"flat": [v]})
    assert any(len(sheet.given.star(v)) != 4 for v in interior)


def test_a_node_that_is_none_is_refused() -> None:
    for size in (1 << 58, 1 << 61):
        entry = node()
        entry["node"] = [x + size * (k % 3) for k, x in enumerate(entry["node"])]
        with pytest.raises(CertificateError):
            passed(entry)
    entry = node()
    entry["node"] = [0] * len(entry["node"])
    with pytest.raises((CertificateError, ZeroDivisionError)):  # the second: "malformed"
        passed(entry)


def test_what_nothing_else_refuses_in_a_loop_is_malformed() -> None:
    forged = given_lines(NODE)
    step = next(step for step in steps_of(forged) if "node" in step)
    step["node"] = [0] * len(step["node"])
    refused(forged, "loop 0: malformed: ZeroDivisionError while checking")


def test_another_arc_is_refused() -> None:
    entry = node()
    entry["centre"][0] += 1 << 61
    with pytest.raises(CertificateError):
        passed(entry)
    entry = node()
    largest = max(range(len(entry["row"])), key=lambda k: abs(entry["centre"][k]))
    entry["row"][largest] += 1 << 22
    with pytest.raises(CertificateError):
        passed(entry)
    entry = node()
    entry["reach"] = 16 * 64
    with pytest.raises(CertificateError, match=r"^(a matrix is not near|a tube does not hold)"):
        passed(entry)


def test_a_node_must_be_passed_in_the_direction_of_the_loop() -> None:
    entry = node()
    entry["centre"] = [-x for x in entry["centre"]]
    entry["row"] = [-t for t in entry["row"]]
    begin, end = entry["entry"], entry["exit"]
    entry["entry"], entry["exit"] = -begin, end
    not_passed(entry, "an arc does not go through its branch point")
    # The same arc run through the other way: its point on the tube is now after the branch point.
    sheet, _, before = _node()
    tube = tube_of(sheet.equations, json.loads(before))
    arc = _arc(sheet, entry)
    path = Path((tube.enclosure(Fraction(0)), tube.velocity(Fraction(0))), sheet.equations.bits)
    path.enter(tube)
    with pytest.raises(CertificateError, match=r"^a motion may enter a tube backwards$"):
        path.meet(*arc.configuration(Fraction(-begin, 1 << PARAMETER_BITS)))


def _arc(sheet: LoopSheet, entry: Document) -> BranchPointTube:
    equations = sheet.equations
    patch = Patch(equations, entry["flat"])
    near = vector(entry["node"], "node", equations.size, equations.bits)
    reach = Fraction(entry["reach"], 64)
    return BranchPointTube(patch, patch.branch_point(near), entry["centre"], entry["row"], reach)


def test_an_arc_must_go_through_its_node() -> None:
    for begin, end in ((None, 0), (None, -1), (0, None), (1, None)):
        entry = node()
        entry["entry"] = entry["entry"] if begin is None else begin
        entry["exit"] = entry["exit"] if end is None else end
        not_passed(entry, "an arc does not go through its branch point")
    for key in ("entry", "exit"):
        entry = node()
        entry[key] *= 1 << 20
        not_passed(entry, "a motion leaves a tube beyond its reach")


def test_nodes_follow_tubes() -> None:
    header, loop, claims = given_lines(NODE)
    steps = loop["evidence"]["steps"]
    k = next(k for k, step in enumerate(steps) if "flat" in step)
    loop["evidence"]["steps"] = steps[k : k + 1]
    refused(
        [header, loop, claims],
        "loop 0: a motion meets a branch point, or lands, where it is on no tube",
    )


def test_an_arc_holds_configurations() -> None:
    """No box refutes the lengths of the edges, and the patch is flat at the branch point."""
    sheet = _node()[0]
    equations, arc = sheet.equations, _arc(sheet, node())
    one = Fraction(1 << equations.bits)
    for k in (-3, -1, 0, 2, 5):
        ball, _ = arc.configuration(arc.reach * Fraction(k, 8))
        assert max(ball.radii) < one / 10**6
        for u, d, r in zip(
            equations.flat,
            equations.along(ball.centre),
            equations.weight_sums(ball.radii),
            strict=True,
        ):
            change = sum((2 * a + b) * b for a, b in zip(u, d, strict=True))
            room = sum(2 * abs(a + b) * c + c * c for a, b, c in zip(u, d, r, strict=True))
            assert abs(change) <= room
    low, high = (arc.configuration(Fraction(k, 10**6)) for k in (-1, 1))
    speed = arc.configuration(Fraction(0))[1]
    for a, b, c, r in zip(low[0].centre, high[0].centre, speed.centre, speed.radii, strict=True):
        slack = r + 4 + 2 * 10**6 * (max(low[0].radii) + 2)
        assert abs((b - a) * 10**6 // 2 - c) < slack


def test_wheel_stresses_are_in_equilibrium() -> None:
    sheet = _node()[0].given
    for v in sheet.interior:
        stress = wheel_stress(sheet, v)
        assert all(stress[e] for e in stress if v not in e)
        for i in {v, *sheet.star(v)}:
            force = [Fraction(0), Fraction(0)]
            for e, w in stress.items():
                if i in e:
                    j = sum(e) - i
                    for a in (0, 1):
                        force[a] += w * (sheet.points[j][a] - sheet.points[i][a])
            assert force == [0, 0]


def test_stresses_that_are_not_independent_are_refused() -> None:
    assert independent([{0: 1, 3: 5}, {3: 1, 4: -7}]) == [3, 4]
    assert sorted(independent([{0: 4, 1: 2}, {0: 4, 1: 3}])) == [0, 1]
    with pytest.raises(CertificateError, match=r"^the stresses of flat vertices are not independ"):
        independent([{0: 4, 1: 2}, {0: 2, 1: 1}])
    with pytest.raises(CertificateError, match=r"^the stresses of flat vertices are not independ"):
        independent([{0: 0}])


def test_stresses_out_of_range() -> None:
    points = [["0", "0"], ["1", "0"], ["1", "1"], [f"1/{3**700}", "1"], ["1/2", f"1/{5**600}"]]
    pattern = {"vertices": points, "triangles": [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]}
    equations = LengthEquations(read_sheet(pattern)[0], [0, 1, 4], 2048 * 2)
    with pytest.raises(CertificateError, match=r"^the stresses are out of range$"):
        Stresses(equations, [4])


def test_a_panel_is_spanned_by_what_is_pinned_in_it() -> None:
    sheet = _node()[0].given
    corners = {0, 1, 2, *sheet.interior[:1]}
    for pinned in ([], [0], [0, 2], [0, 1, 2]):
        base = motion_patches._base(sheet, pinned, corners)
        assert base[: len(pinned)] == pinned
        assert len(set(base)) == 3
        weights = motion_patches._weights(sheet, base, corners)
        for v, row in weights.items():
            assert sum(row) == 1
            for a in (0, 1):
                point = sum(w * sheet.points[b][a] for w, b in zip(row, base, strict=True))
                assert point == sheet.points[v][a]
    assert motion_nodes.MOTION_BITS == 2048


# --- boxes are large enough ----------------------------------------------------------------------


def holds(box: Ball, centre: list[int], slack: int) -> bool:
    return all(
        abs(x - y) <= r + slack for x, y, r in zip(centre, box.centre, box.radii, strict=True)
    )


def moved(row: list[int], size: int, seed: int) -> list[int]:
    """Other integers, up to `size` away."""
    spread = random.Random(seed)
    return [x + spread.randint(-size, size) for x in row]


@pytest.mark.parametrize("seed", range(3))
def test_the_box_of_a_node_holds_it_wherever_one_begins(seed: int) -> None:
    sheet = _node()[0]
    patch, near = Patch(sheet.equations, node()["flat"]), node()["node"]
    fine = patch.branch_point(near)
    assert max(fine.radii) < 1 << 10
    for size in (1 << 20, 1 << 36):
        box = patch.branch_point(moved(near, size, seed))
        assert holds(box, fine.centre, 1 << 10)
        assert size >> 8 < max(box.radii) < size << 8
        # Corners of the panel stay where the base takes them.
        radius = max(box.radii)
        assert all(0 < r <= radius for r in box.radii)


@pytest.mark.parametrize("seed", range(3))
def test_an_arc_holds_the_curve_of_every_node_in_its_box(seed: int) -> None:
    sheet, entry = _node()[0], node()
    patch = Patch(sheet.equations, entry["flat"])
    fine = patch.branch_point(entry["node"])
    reach = Fraction(entry["reach"], 64)
    true = BranchPointTube(patch, fine, entry["centre"], entry["row"], reach)
    size = 1 << 30
    wide = Ball(moved(fine.centre, size, seed), [size + r for r in fine.radii])
    other = BranchPointTube(
        patch, wide, moved(entry["centre"], size, seed + 9), entry["row"], reach
    )
    for k in (-2, -1, 0, 1, 2):
        s = reach * Fraction(k, 32)
        for exact, box in zip(true.configuration(s), other.configuration(s), strict=True):
            assert max(exact.radii) < size
            assert holds(box, exact.centre, max(exact.radii))
            assert max(box.radii) < size << 16


def bound(coefficients: list[int], at_most: Fraction) -> Fraction:
    return Fraction(motion_bounds.value(coefficients, at_most), 1 << 128)


def test_what_the_box_of_a_node_does_to_an_arc_is_counted() -> None:
    """With exact numbers: the equations and their slope, at every corner that was tried."""
    sheet, entry = _node()[0], node()
    equations, patch = sheet.equations, Patch(sheet.equations, entry["flat"])
    fine, size = patch.branch_point(entry["node"]), 1 << 44
    wide = Ball(fine.centre, [size] * equations.size)
    kept: dict[str, Any] = {}
    bounds = motion_nodes.bounds

    def seen(*given: Any) -> Any:
        kept["p"], kept["weights"] = given[0], given[-1]
        return bounds(*given)

    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(motion_nodes, "bounds", seen)
        arc = BranchPointTube(patch, wide, entry["centre"], entry["row"], Fraction(1, 64))
    stresses, one = Stresses(equations, entry["flat"]), Fraction(1, 1 << equations.bits)
    weights = [Fraction(w, 1 << 16) for w in kept["weights"]]
    choose = random.Random(5)

    def vectors(row: list[int]) -> list[list[Fraction]]:
        return [[a * one for a in e] for e in equations.along(row)]

    def norm(values: list[Fraction]) -> Fraction:
        """|P v|."""
        return max(
            abs(sum((a * v for a, v in zip(line, values, strict=True)), Fraction(0))) / w / 2**40
            for line, w in zip(kept["p"], weights, strict=True)
        )

    def dots(a: list[list[Fraction]], b: list[list[Fraction]]) -> list[Fraction]:
        return [
            sum((x * y for x, y in zip(u, v, strict=True)), Fraction(0))
            for u, v in zip(a, b, strict=True)
        ]

    def stressed(values: list[Fraction]) -> list[Fraction]:
        return [
            sum((w * values[e] for e, w in row.items()), Fraction(0)) / (1 << stresses.bits)
            for row in stresses.rows
        ]

    for trial in range(8):
        corner = [c + choose.choice((-size, size)) for c in wide.centre]
        flat = [[a * one for a in e] for e in equations.flat]
        x = [
            [a + b for a, b in zip(*e, strict=True)]
            for e in zip(flat, vectors(corner), strict=True)
        ]
        s = Fraction(choose.randint(-64, 64), 4096)
        point = at(arc.curve, s)
        y = vectors(point)
        values = [a + s * b / 2 for a, b in zip(dots(x, y), dots(y, y), strict=True)]
        for edge, value in zip(stresses.replaced, stressed(dots(y, y)), strict=True):
            values[edge] = value / 2
        last = sum((t * a for t, a in zip(entry["row"], point, strict=True)), 0) * one
        rounding = Fraction(1, 1 << 40)
        assert norm([*values, last / 2**20 - 1]) <= bound(arc.proof.b, abs(s)) + rounding
        z = [choose.choice((-1, 1)) * w for w in weights]
        dz = [[a / one for a in e] for e in vectors(cast("list[int]", z))]
        slope = [a + s * b for a, b in zip(dots(x, dz), dots(y, dz), strict=True)]
        for edge, value in zip(stresses.replaced, stressed(dots(y, dz)), strict=True):
            slope[edge] = value
        last = sum((t * a for t, a in zip(entry["row"], z, strict=True)), Fraction(0))
        image = [*slope, last / 2**20]
        off = max(
            abs(a - sum(map(mul, line, image), Fraction(0)) / 2**40) / w
            for a, line, w in zip(z, kept["p"], weights, strict=True)
        )
        assert off <= bound(arc.proof.q, abs(s)) + rounding, trial
        again = [choose.choice((-1, 1)) * w for w in weights]
        da = [[a / one for a in e] for e in vectors(cast("list[int]", again))]
        far = Fraction(choose.randint(-1000, 1000))
        bend = [far * a for a in dots(dz, da)]
        for edge, value in zip(stresses.replaced, stressed(dots(dz, da)), strict=True):
            bend[edge] = value
        assert norm([*bend, Fraction(0)]) <= bound(arc.proof.kappa, abs(far))
    assert bound(arc.proof.q, Fraction(0)) > Fraction(size) * one


def test_the_bars_of_a_panel_bend_as_much_as_is_counted() -> None:
    """The second derivative of the equations of a branch point, with exact numbers."""
    sheet, entry = _node()[0], node()
    patch = Patch(sheet.equations, entry["flat"])
    kept: list[Any] = []
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(motion_patches, "bounds", lambda *given: kept.extend(given))
        with pytest.raises(AttributeError):  # there is no proof
            patch.branch_point(entry["node"])
    [squares] = kept[5]
    size, scale = kept[2] - 2 * sheet.equations.bits - 1, 1 << 32
    assert 1 << size <= patch.denominator**2 < 4 << size
    choose = random.Random(3)
    for _ in range(20):
        y, z = ([[choose.choice((-1, 1)) for _ in range(3)] for _ in patch.moving] for _ in "yz")
        for (i, j), most in zip(patch.bars, squares, strict=True):
            sides = [
                [
                    sum(c * v[m][a] for m, c in patch.rows[i].items())
                    - sum(c * v[m][a] for m, c in patch.rows[j].items())
                    for a in range(3)
                ]
                for v in (y, z)
            ]
            assert abs(sum(map(mul, *sides))) * scale <= most << size


def test_a_node_exists_whichever_face_is_held() -> None:
    """The same configuration, moved as a whole: three corners of the panel are held, or fewer."""
    entry, first, held = node(), _node()[0].equations, set[int]()
    sheet, one = first.sheet, 1 << first.bits
    unit = float(first.unit)
    flat = {v: np.array([float(x), float(y), 0.0]) / unit for v, (x, y) in sheet.points.items()}
    place = dict(flat)
    for v, k in first.place.items():
        place[v] = flat[v] + np.array(entry["node"][k : k + 3]) / one
    for face in sheet.triangles:
        equations = LengthEquations(sheet, sorted(face), first.bits)
        a, b, c = equations.pinned
        frames = []
        for points in (place, flat):
            u = points[b] - points[a]
            w = np.cross(u, points[c] - points[a])
            frames.append(
                np.array(
                    [
                        u / np.linalg.norm(u),
                        np.cross(w, u) / np.linalg.norm(np.cross(w, u)),
                        w / np.linalg.norm(w),
                    ]
                )
            )
        turned = frames[1].T @ frames[0]
        near = []
        for v in equations.free:
            d = turned @ (place[v] - place[a]) + flat[a] - flat[v]
            near += [round(x * one * float(first.unit / equations.unit)) for x in d]
        patch = Patch(equations, entry["flat"])
        held.add(len(patch.vertices & set(equations.pinned)))
        ball = patch.branch_point(near)
        assert max(ball.radii) < one >> 40
        for u, d, r in zip(
            equations.flat,
            equations.along(ball.centre),
            equations.weight_sums(ball.radii),
            strict=True,
        ):
            change = sum((2 * p + q) * q for p, q in zip(u, d, strict=True))
            room = sum(2 * abs(p + q) * t + t * t for p, q, t in zip(u, d, r, strict=True))
            assert abs(change) <= room
    assert held >= {1, 2, 3}
