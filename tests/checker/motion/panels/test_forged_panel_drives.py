"""Forged motions of panels: folds that do not fold so."""

from __future__ import annotations

from fractions import Fraction
from itertools import product

from forge import refused, stopped, verified
from forge_panel_motions import at_rest, given, of_lines
from forge_panels import bent

from exactfold.checker.core.reading import CertificateError
from exactfold.pattern.panel_entries import panels_document
from exactfold.pattern.panel_pattern import PanelPattern


def test_letters() -> None:
    message = "the assignment does not have a letter M, V or F for each fold"
    for wrong in ("VVM", "VVVVV", 5):
        document = at_rest(given("vertex"))
        document["claims"]["assignment"] = wrong
        refused(document, message)
    document = at_rest(given("vertex"))
    document["claims"]["assignment"] = document["claims"]["assignment"].replace("M", "X")
    stopped(document, message)
    document = at_rest(given("vertex"))
    letters = document["claims"]["assignment"]
    document["claims"]["assignment"] = letters[:3] + ("M" if letters[3] == "V" else "V")
    stopped(document, "the densities at 4 do not have the signs of the letters")
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
    message = "the vertices with densities are not those with active folds, each once"
    document = at_rest(given("vertex"))
    document["evidence"]["vertices"] *= 2
    stopped(document, message)
    document["evidence"]["vertices"] = []
    refused(document, message)
    document = at_rest(given("flaps"))
    document["evidence"]["vertices"] = [{"vertex": 2, "radicand": None, "densities": []}]
    refused(document, message)


def test_densities_of_other_folds() -> None:
    message = "the densities at 4 are not those of its active folds"
    document = at_rest(given("vertex"))
    [row] = document["evidence"]["vertices"]
    row["densities"].append([4, ["1"]])
    stopped(document, message)
    del row["densities"][-2:]
    refused(document, message)


def test_a_radicand_that_is_a_square() -> None:
    """Its root is no number of its own, so that what is 0 is known as 0."""
    document = at_rest(given("vertex"))
    [row] = document["evidence"]["vertices"]
    row["radicand"] = ["4"]
    verified(document)
    row["densities"] = [[u, [c, "0"]] for u, [c] in row["densities"]]
    refused(document, "a number does not have 1 entries")
    row["radicand"] = ["-2"]
    refused(document, "a square root is taken of a number that is not positive")
    row["radicand"] = ["2"]
    verified(document)


def test_densities_that_do_not_close_a_vertex() -> None:
    document = at_rest(given("vertex"))
    row = document["evidence"]["vertices"][0]["densities"][3]
    row[1] = [str(Fraction(row[1][0]) * 2)]
    stopped(document, "the densities at 4 are not those of a motion to second order")
    document = at_rest(given("bent"))
    row = document["evidence"]["vertices"][0]["densities"][3]
    row[1] = [str(Fraction(c) * Fraction(1001, 1000)) for c in row[1]]
    vertex = document["evidence"]["vertices"][0]["vertex"]
    stopped(document, f"the densities at {vertex} are not those of a motion to second order")


def test_more_folds_at_a_vertex_must_be_in_proportion() -> None:
    """Five folds that solve the equations to second order, by densities of whole numbers."""
    ends = [(4, 0), (1, 1), (-2, 4), (-4, -2), (4, -2)]
    points = [(Fraction(x), Fraction(y)) for x, y in [*ends, (0, 0)]]
    spokes = [(k, 5) for k in range(5)]
    sheet = PanelPattern(points, [*spokes, *((k, (k + 1) % 5) for k in range(5))])
    w = [2, -4, 2, 1, 1]
    made = at_rest(given("vertex"))
    made["pattern"] = panels_document(sheet)
    made["claims"] |= {"assignment": "VMVVV", "drivers": [[0, 5]]}
    made["evidence"]["vertices"] = [
        {"vertex": 5, "radicand": None, "densities": [[u, [str(c)]] for u, c in enumerate(w)]}
    ]
    stopped(made, "vertex 5 does not close, and does not have four active folds")


def test_drivers() -> None:
    document = at_rest(given("vertex"))
    document["claims"]["drivers"] *= 2
    [fold] = given("vertex")["claims"]["drivers"]
    message = f"the driver {tuple(fold)} is not active, or another driver moves it already"
    stopped(document, message)
    document["claims"]["drivers"] = []
    stopped(document, "no driver moves the fold [(0, 4)]")
    document = at_rest(given("flaps"))
    document["claims"]["drivers"] = [[2, 3]]
    stopped(document, "no driver moves the fold [(4, 5)]")


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
