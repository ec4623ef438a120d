"""Forged motions of panels: folds that do not fold so, times that are too late or too early."""

from __future__ import annotations

import json
from collections.abc import Callable
from fractions import Fraction
from functools import cache
from itertools import product
from math import atan, pi
from typing import Any

import numpy as np
import pytest
from forge import Document, refused, unreadable, verified, without
from forge_panels import SHEETS, bent
from panel_sheets import grid, mesh, miura, tiling

from exactfold import checker
from exactfold.checker import panel_motion
from exactfold.checker.intervals import Interval
from exactfold.checker.motion_lengths import GRID, ONE
from exactfold.checker.panel_cut import cut
from exactfold.checker.panel_drive import Drive
from exactfold.checker.panel_lines import Line, lines_at
from exactfold.checker.panel_places import Places, shrunk
from exactfold.checker.panel_series import BITS
from exactfold.checker.panel_sheet import read_panels
from exactfold.checker.reading import CertificateError
from exactfold.checker.towers import Number
from exactfold.evidence.panels import panels_document
from exactfold.motion import follow_panels, prove_panels
from exactfold.pattern.families import single_vertex
from exactfold.pattern.opening import panels
from exactfold.pattern.panel_pattern import PanelPattern

Change = Callable[[Document, Document], None]


def strip(widths: list[int]) -> PanelPattern:
    """Panels side by side, with a fold from border to border between neighbours."""
    xs = [sum(widths[:k]) for k in range(len(widths) + 1)]
    return grid(len(widths), 1, lambda i, j: (Fraction(xs[i]), Fraction(2 * j)))


MOTIONS: dict[str, Callable[[], Any]] = {
    "flaps": lambda: follow_panels(strip([3, 1, 3]), frames=2),
    "closing": lambda: follow_panels(strip([1, 4]), frames=2),
    "vertex": lambda: follow_panels(panels(single_vertex(4)), until="60deg", frames=2),
    "bent": lambda: follow_panels(mesh(1, 1, 1), until="20deg", frames=2),
    "miura": lambda: follow_panels(miura(2, 2), until="10deg", frames=2),
    "tiling": lambda: follow_panels(tiling(2, 2), until="10deg", frames=2),
    "surds": lambda: follow_panels(SHEETS["surds"](), until="10deg", frames=2),
}
SLOW = "closing", "tiling", "vertex", "miura", "bent"


@cache
def _text(name: str) -> str:
    proof = prove_panels(MOTIONS[name]())
    return json.dumps(proof.certificate())


def whole(name: str) -> Document:
    """A fresh copy of a certificate."""
    document: Document = json.loads(_text(name))
    return document


def given(name: str) -> Document:
    """A certificate that claims the same contact, and to be clear for a short time only."""
    document = whole(name)
    document["claims"]["clear"] = "1/8"
    document["evidence"]["clear"] = 1 << 36
    if "contact" in document["claims"]:
        document["claims"]["contact"]["time"][0] = "1/8"
    return document


def forged(name: str, change: Change) -> Document:
    """That certificate after `change(claims, evidence)`."""
    document = given(name)
    change(document["claims"], document["evidence"])
    return document


def stopped(document: Document, message: str) -> None:
    """Refused with this message, and accepted with the line that says so taken out."""
    refused(document, message)
    with without(message):
        verified(document)


def at_rest(document: Document) -> Document:
    """The certificate with nothing claimed of contacts."""
    document["claims"] |= {"clear": "0"}
    document["claims"].pop("contact", None)
    document["evidence"] |= {"clear": 0}
    document["evidence"].pop("contact", None)
    return document


def padded(line: Line, value: Number) -> list[str]:
    """A density in the field of the sheet, or in that with the root."""
    missing = 0 if line.radicand is None else 2 * len(line.radicand.parts) - len(value.parts)
    return [str(c) for c in value.parts] + ["0"] * missing


def of_lines(pattern: PanelPattern, chosen: dict[int, int]) -> Document | None:
    """A certificate of lines of motions, one at each vertex; None if their letters do not fit."""
    document = panels_document(pattern)
    sheet, _ = read_panels(document)
    near = sheet.live([])
    lines = {v: lines_at(sheet, v, near[v])[k] for v, k in chosen.items()}
    signs: dict[tuple[int, int], int] = {}
    for v, line in lines.items():
        own = {tuple(sorted((v, u))): d.sign() for u, d in line.densities.items()}
        turn = next((signs[e] * s for e, s in own.items() if e in signs), 1)
        if any(signs.get(e, s * turn) != s * turn for e, s in own.items()):
            return None
        signs |= {e: s * turn for e, s in own.items()}
    letters = {1: "V", -1: "M", 0: "F"}
    rows = [
        {
            "vertex": v,
            "radicand": line.radicand and [str(c) for c in line.radicand.parts],
            "densities": [[u, padded(line, d)] for u, d in line.densities.items()],
        }
        for v, line in lines.items()
    ]
    return {
        "format": "exactfold panel motion",
        "version": 1,
        "pattern": document,
        "claims": {
            "assignment": "".join(letters[signs.get(fold, 0)] for fold in sheet.folds),
            "drivers": [list(min(signs))],
            "clear": "0",
        },
        "evidence": {"vertices": rows, "clear": 0},
    }


# --- what is true --------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=[pytest.mark.slow] * (n in SLOW)) for n in MOTIONS]
)
def test_what_is_claimed_is_proved(name: str) -> None:
    claims = verified(whole(name))
    line = checker.summary(claims)
    assert line.startswith("VALID: the panels fold, ")
    low = float(Fraction(claims["clear"]))
    ends = {"flaps": "0-2-3-1 and 4-6-7-5 do by ", "closing": "the folds are closed by 3.14159"}
    assert ("contact" in claims) == (name in ends)
    if name in ends:
        high = Fraction(claims["contact"]["time"][1])
        assert claims["clear"] == claims["contact"]["time"][0]
        assert low < high < low + 1e-3
        assert ends[name] in line
    else:
        until = {"vertex": pi / 3, "bent": pi / 9}.get(name, pi / 18)
        assert low == pytest.approx(until)


def test_less_may_be_claimed() -> None:
    for name in ("flaps", "closing"):
        document = given(name)
        document["claims"]["contact"]["time"][1] = "4"
        verified(document)
        verified(at_rest(document))


def test_a_fold_that_is_not_named_closes_in_modes_that_are_not_linear() -> None:
    document = at_rest(given("bent"))
    document["claims"]["contact"] = {
        "kind": "flat-fold",
        "time": ["0", "355/113"],
        "faces": [],
        "folds": [],
    }
    assert ", a fold is closed by 3.14159 (180 degrees)" in checker.summary(verified(document))
    document["claims"]["contact"]["folds"] = document["claims"]["drivers"]
    stopped(document, "a fold is not known to close")


# --- false times and contacts --------------------------------------------------------------------


def test_times_that_are_too_late_or_too_early() -> None:
    for name in ("flaps", "closing"):
        high = Fraction(given(name)["claims"]["contact"]["time"][1])

        def later(claims: Document, _: Document) -> None:
            claims["clear"] = claims["contact"]["time"][0] = "134/1000"

        def earlier(claims: Document, _: Document, high: Fraction = high) -> None:
            claims["contact"]["time"][1] = str(high - Fraction(1, 10**9))

        def not_from_there(claims: Document, _: Document) -> None:
            claims["contact"]["time"][0] = "126/1000"

        stopped(forged(name, later), "what is clear is shorter than claimed")
        stopped(forged(name, earlier), "the contact may be later than claimed")
        message = "a contact is not claimed from where the motion is clear"
        stopped(forged(name, not_from_there), message)


def test_times_are_arc_tangents() -> None:
    for x in (0.0, 0.1, 0.25, 0.5, 0.625, 0.875, 1 - 2**-30):
        low, high = panel_motion.time_of(Fraction(x))
        assert high - low < Fraction(1, 10**24)
        assert abs(float(low) - 2 * atan(x / (1 - x))) < 1e-14
    low, high = panel_motion.time_of(Fraction(1))
    digits = Fraction(31415926535897932384626433832795, 10**31)  # of pi, known
    assert low < digits < digits + Fraction(1, 10**31) < high


@pytest.mark.slow
def test_what_is_not_clear_is_refused() -> None:
    document = whole("flaps")
    document["evidence"]["clear"] = document["evidence"]["contact"] + 1
    place = "may touch where the motion is claimed to be clear"
    stopped(document, f"the faces (0, 2, 3, 1) and (4, 6, 7, 5) {place}")


@pytest.mark.slow
def test_a_mode_that_ends_before_is_not_followed() -> None:
    """Driven by a fold that closes after another one."""
    document = given("bent")
    assert document["claims"]["drivers"] == [[4, 5]]
    document["claims"]["drivers"] = [[3, 4]]
    verified(document)
    document["evidence"]["clear"] = (1 << 40) - (1 << 30)
    refused(document, "the panels may touch where the motion is claimed to be clear")
    document = at_rest(document)
    document["claims"]["contact"] = {
        "kind": "contact",
        "time": ["0", "4"],
        "faces": [[0, 3, 4, 1], [4, 7, 8, 5]],
        "folds": [],
    }
    document["evidence"]["contact"] = (1 << 40) - (1 << 30)
    refused(document, "the panels may not come so far: a fold may close before")


def test_parameters_out_of_range() -> None:
    """The flaps cross beyond 180 degrees as before, on the other side."""

    def past(claims: Document, evidence: Document) -> None:
        evidence["contact"] = 6 << 38
        claims["contact"]["time"][1] = "7"

    stopped(forged("flaps", past), "a parameter is out of range")

    def negative(claims: Document, evidence: Document) -> None:
        evidence["clear"] = -1

    refused(forged("flaps", negative), "a parameter is not a natural number")


def test_what_does_not_touch() -> None:
    def not_yet(claims: Document, evidence: Document) -> None:
        evidence["contact"] -= 1 << 20

    message = "no side runs through the other panel"
    stopped(forged("flaps", not_yet), message)

    def others(claims: Document, evidence: Document) -> None:
        claims["contact"]["faces"][0] = [2, 4, 5, 3]

    stopped(forged("flaps", others), message)

    def at_once(claims: Document, evidence: Document) -> None:
        evidence["contact"] = 0

    refused(forged("flaps", at_once), "malformed: ZeroDivisionError while checking")


def test_what_is_no_panel_or_fold() -> None:
    def no_kind(claims: Document, evidence: Document) -> None:
        claims["contact"]["kind"] = "touch"

    stopped(forged("closing", no_kind), "the contact is of no known kind")

    def with_folds(claims: Document, evidence: Document) -> None:
        claims["contact"]["folds"] = [[2, 3]]

    stopped(forged("flaps", with_folds), "a contact has no folds")

    def no_panel(claims: Document, evidence: Document) -> None:
        claims["contact"]["faces"][0] = [0, 2, 3]

    refused(forged("flaps", no_panel), "what touches is no panel")

    def with_faces(claims: Document, evidence: Document) -> None:
        claims["contact"]["faces"] = [[0, 2, 3, 1]]

    stopped(forged("closing", with_faces), "folds that close have no faces")

    def other_fold(claims: Document, evidence: Document) -> None:
        claims["contact"]["folds"] = [[0, 2]]

    stopped(forged("closing", other_fold), "a fold is not known to close")


def test_keys() -> None:
    for name, place, message in (
        (
            "flaps",
            "claims",
            "claims: expected an object with the keys assignment drivers clear contact",
        ),
        ("vertex", "claims", "claims: expected an object with the keys assignment drivers clear"),
        ("vertex", "evidence", "evidence: expected an object with the keys vertices clear"),
        ("flaps", "evidence", "evidence: expected an object with the keys vertices clear contact"),
    ):
        document = given(name)
        document[place]["more"] = 1
        refused(document, message)
    document = given("vertex")
    document["evidence"]["vertices"][0]["more"] = 1
    refused(document, "a vertex: expected an object with the keys vertex radicand densities")
    document = given("flaps")
    document["claims"]["contact"]["more"] = 1
    refused(document, "contact: expected an object with the keys kind time faces folds")
    document = given("flaps")
    document["version"] = 2
    unreadable(json.dumps(document), "version 2 is not known to this checker")
    document = given("vertex")
    document["claims"]["drivers"] = [["a", "b"]]
    refused(document, "a vertex is not a natural number")


def test_the_work_is_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(panel_motion, "MOST_TESTS", 100)
    stopped(given("vertex"), "the contacts take too much work")


# --- motions that are none -----------------------------------------------------------------------


def test_letters() -> None:
    for letters in ("VVM", "VVVVV", "VVMX", 5):
        document = at_rest(given("vertex"))
        document["claims"]["assignment"] = letters
        refused(document, "the assignment has not a letter M, V or F for each fold")
    document = at_rest(given("vertex"))
    letters = document["claims"]["assignment"]
    document["claims"]["assignment"] = letters[:3] + ("M" if letters[3] == "V" else "V")
    stopped(document, "the letters at 4 are others")
    document = at_rest(given("vertex"))
    document["claims"] |= {"assignment": "FFFF", "drivers": []}
    document["evidence"]["vertices"] = []
    stopped(document, "no fold is active")


def test_the_mirror_image_is_a_motion_too() -> None:
    document = given("vertex")
    mirrored = document["claims"]["assignment"].translate(str.maketrans("MV", "VM"))
    document["claims"]["assignment"] = mirrored
    verified(document)


def test_vertices_of_the_evidence() -> None:
    document = at_rest(given("vertex"))
    document["evidence"]["vertices"] *= 2
    stopped(document, "the vertex 4 has no active fold, or is twice")
    document = at_rest(given("flaps"))
    document["evidence"]["vertices"] = [{"vertex": 2, "radicand": None, "densities": []}]
    refused(document, "the vertex 2 has no active fold, or is twice")
    document = at_rest(given("vertex"))
    document["evidence"]["vertices"] = []
    refused(document, "the densities at [4] are missing")
    document = at_rest(given("vertex"))
    document["evidence"]["vertices"][0]["densities"].pop()
    refused(document, "the densities at 4 are not those of its active folds")


def test_a_radicand_that_is_a_square() -> None:
    """The root of 4 as a number of its own: what is 0 would not be known as 0."""
    document = at_rest(given("vertex"))
    [row] = document["evidence"]["vertices"]
    row["radicand"] = ["4"]
    row["densities"] = [[u, [c, "0"]] for u, [c] in row["densities"]]
    refused(document, "the radicand at 4 is a square")
    row["radicand"] = ["-2"]
    refused(document, "the square root of a number that is not positive")
    row["radicand"] = ["2"]
    verified(document)


def test_densities_that_do_not_close_a_vertex() -> None:
    document = at_rest(given("vertex"))
    row = document["evidence"]["vertices"][0]["densities"][3]
    row[1] = [str(Fraction(row[1][0]) * 2)]
    stopped(document, "the vertex 4 does not move so")
    document = at_rest(given("bent"))
    row = document["evidence"]["vertices"][0]["densities"][3]
    row[1] = [str(Fraction(c) * Fraction(1001, 1000)) for c in row[1]]
    stopped(
        document, f"the vertex {document['evidence']['vertices'][0]['vertex']} does not move so"
    )


def test_more_folds_at_a_vertex_must_be_in_proportion() -> None:
    """Five folds that move to second order: (1, 1, 2, ...) on directions of whole numbers."""
    sheet = panels(single_vertex(5))
    document = panels_document(sheet)
    d = [tuple(Fraction(c) for c in sheet.direction(5, u)) for u in range(5)]
    w = [Fraction(1), Fraction(-1), Fraction(2)]
    rest = [-sum(a * b[k] for a, b in zip(w, d, strict=False)) for k in (0, 1)]
    (p, q), (r, s) = d[3], d[4]
    turn = p * s - q * r
    w += [(rest[0] * s - rest[1] * r) / turn, (p * rest[1] - q * rest[0]) / turn]
    letters = "".join("V" if c > 0 else "M" for c in w)
    made = at_rest(given("vertex"))
    made["pattern"] = document
    order = [tuple(sorted((u, 5))) for u in range(5)]
    made["claims"] |= {"assignment": letters, "drivers": [list(order[0])]}
    made["evidence"]["vertices"] = [
        {"vertex": 5, "radicand": None, "densities": [[u, [str(c)]] for u, c in enumerate(w)]}
    ]
    refused(made, "the vertex 5 does not close, and has not four active folds")


def test_drivers() -> None:
    document = at_rest(given("vertex"))
    document["claims"]["drivers"] *= 2
    [fold] = given("vertex")["claims"]["drivers"]
    message = f"{tuple(fold)} drives nothing, or what another fold drives"
    stopped(document, message)
    document["claims"]["drivers"] = []
    stopped(document, "nothing drives [(0, 4)]")
    document = at_rest(given("flaps"))
    document["claims"]["drivers"] = [[2, 3]]
    stopped(document, "nothing drives [(4, 5)]")


def pinwheel(*arms: complex) -> PanelPattern:
    """Vertices that can be folded flat at the corners of a square, their outer folds turned.

    At each corner opposite sectors add up to pi: one is a right angle, as is that between the outer
    folds, and `arms` turn these from the side before.
    """
    corners, points, edges = [0, 3, 3 + 3j, 3j], [], []
    for k, corner in enumerate(corners):
        points.append(corner)
        edges.append((k, (k + 1) % 4))
        for n in (0, 1):
            edges += [(k, 4 + 2 * k + n), (4 + 2 * k + n, 4 + (2 * k + n + 1) % 8)]
    points += [
        c + a * 1j ** (k + 1 + n)
        for k, (c, a) in enumerate(zip(corners, arms, strict=True))
        for n in (0, 1)
    ]
    return PanelPattern([(Fraction(p.real), Fraction(p.imag)) for p in map(complex, points)], edges)


def test_loops_that_do_not_close() -> None:
    """Lines at four vertices, linear in the tangents, whose letters fit and whose gains do not."""
    sheet, found = pinwheel(1 + 2j, 1 + 1j, 1 + 3j, 2 + 3j), 0
    for lines in product((0, 1), repeat=4):
        document = of_lines(sheet, dict(enumerate(lines)))
        if document is not None:
            stopped(document, "the loop 0-1-2-3 does not close")
            found += 1
    assert found


@pytest.mark.slow
def test_loops_that_do_not_stay_closed() -> None:
    """A mode to second order that does not truly fold."""
    found = set()
    for lines in product((0, 1), repeat=4):
        document = of_lines(bent(), dict(zip((5, 6, 9, 10), lines, strict=True)))
        if document is not None:
            try:
                verified(document)
            except CertificateError as error:
                found.add(str(error))
                if "stay" in str(error):
                    stopped(document, str(error))
    assert "the loop 5-9-10-6 does not stay closed" in found


# --- where the panels are ------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["flaps", "bent", pytest.param("tiling", marks=pytest.mark.slow)])
def test_positions_are_those_of_the_frames(name: str) -> None:
    """Against frames in floats, and the boxes against pieces that are a thousand times thinner."""
    motion = MOTIONS[name]()
    document = whole(name)
    sheet, _ = read_panels(document["pattern"])
    before = sheet.points
    shrunk(sheet)
    i, j = sheet.edges[0]
    sizes = [
        np.hypot(*(c.enclosed(90).low for c in minus(p[j], p[i]))) for p in (sheet.points, before)
    ]
    factor = sizes[0] / sizes[1]
    claims = document["claims"]
    drive = Drive(sheet, claims["assignment"], claims["drivers"], document["evidence"]["vertices"])
    places = Places(drive)
    x = Fraction(document["evidence"]["clear"], 1 << 40)
    pieces = [places.piece(x * (1 - Fraction(1, k)), x) for k in (6, 6000)]
    ends = []
    for piece in pieces:
        assert piece is not None
        y = piece.above(x)
        assert y == ONE
        ends.append([sum(column) / ONE for column in piece.columns])
        assert all(error < 1 << GRID - 20 for error in piece.errors)
    off = np.abs(np.array(ends[0]) - ends[1]).max() * ONE
    assert off <= pieces[0].errors[0] + pieces[1].errors[0] + 64
    there = np.array(ends[1]).reshape(-1, 3) / factor
    coords = motion.at(min(2 * atan(float(x / (1 - x))), motion.duration))
    held = sheet.panels[0]
    assert np.abs(distances(there) - distances(coords)).max() < 1e-8
    flat = np.array([[float(Fraction(c.parts[0])) for c in point] for point in before])
    moved = there[list(held), :2] - (flat - flat[held[0]])[list(held)]
    assert np.abs(moved).max() < 1e-9


def minus(p: Any, q: Any) -> Any:
    return [a - b for a, b in zip(p, q, strict=True)]


def distances(points: Any) -> Any:
    return np.linalg.norm(points[:, None] - points[None], axis=2)


def test_a_panel_that_passes_a_corner_twice() -> None:
    """A triangle that hangs in a square at one of its corners."""
    points = [(0, 0), (4, 0), (4, 4), (0, 4), (2, 1), (1, 2), (8, 0), (8, 4)]
    edges = [(0, 1), (1, 2), (2, 3), (0, 3), (0, 4), (4, 5), (0, 5), (1, 6), (6, 7), (2, 7)]
    document = at_rest(given("closing"))
    document["pattern"] = {
        "radicands": [],
        "vertices": [[[str(x)], [str(y)]] for x, y in points],
        "edges": sorted([i, j] for i, j in edges),
    }
    document["claims"] |= {"drivers": [[1, 2]]}
    sheet, _ = read_panels(document["pattern"])
    document["claims"]["assignment"] = "".join("V" if f == (1, 2) else "F" for f in sheet.folds)
    [panel] = [p for p in sheet.panels if len(set(p)) < len(p)]
    refused(document, f"the panel {panel} passes a corner twice")


def test_panels_are_cut_into_triangles_of_the_same_area() -> None:
    """Also where three corners lie on a line, and where a panel is not convex."""
    points = [(0, 0), (2, 0), (4, 0), (4, 4), (3, 1), (2, 4), (1, 1), (0, 4)]
    document = {
        "radicands": [],
        "vertices": [[[str(x)], [str(y)]] for x, y in points],
        "edges": sorted(sorted((k, (k + 1) % 8)) for k in range(8)),
    }
    sheet, _ = read_panels(document)
    [panel] = sheet.panels
    triangles = cut(sheet, panel)
    areas = [sheet.area(t) for t in triangles]
    assert all(area.sign() > 0 for area in areas)
    assert sum(area.parts[0] for area in areas) == sheet.area(panel).parts[0]
    assert len(triangles) == len(panel) - 2


def test_intervals_hold_products_of_all_signs() -> None:
    for ends in product((-3, -1, 0, 2, 5), repeat=4):
        if ends[0] <= ends[1] and ends[2] <= ends[3]:
            one = Interval(ends[0] << BITS, ends[1] << BITS, BITS)
            two = Interval(ends[2] << BITS, ends[3] << BITS, BITS)
            every = [a * b for a in ends[:2] for b in ends[2:]]
            found = one * two
            assert (found.low >> BITS, found.high >> BITS) == (min(every), max(every))
