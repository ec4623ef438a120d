"""Forged radii: each is stopped by one line of the checker alone; and what the bounds bound."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from forge import Document, beyond, given, refused, stopped, verified

from exactfold import checker
from exactfold.branches import count_branches
from exactfold.branches.counting.ways import count_ways
from exactfold.checker.sheets.panels import read_panels
from exactfold.checker.tolerance import certificate
from exactfold.checker.tolerance.conditions import Conditions, P, S
from exactfold.checker.tolerance.zeros import Zero
from exactfold.design.tolerance.certificate import tolerance_certificate
from exactfold.design.tolerance.tolerance import tolerance_of_branches, tolerance_of_panels
from exactfold.errors import NotApplicableError
from exactfold.pattern import CreasePattern
from exactfold.pattern.families import single_vertex
from exactfold.pattern.opening import panels
from exactfold.pattern.panel_entries import panels_document
from exactfold.pattern.panel_pattern import PanelPattern


def two() -> Document:
    """The radius of all four ways of a sheet with two inner vertices."""
    return given("tolerance-two-vertex")


def alone(way: int) -> Document:
    """The same of one way."""
    document = two()
    document["claims"] |= {"ways": [document["claims"]["ways"][way]], "number": None}
    document["evidence"]["densities"] = [document["evidence"]["densities"][way]]
    return document


def test_a_radius_is_verified() -> None:
    line = checker.summary(verified(two()))
    assert line.startswith(
        "VALID: all sheets whose vertices move by less than 0.00910295, each within a disk, have "
        "4 ways with the letters of the file, and no others; sha256 "
    )
    assert "have 1 way with the letters of the file; sha" in checker.summary(verified(alone(2)))


def test_letters_of_the_other_side_are_those_of_the_same_way() -> None:
    document = alone(1)
    text = document["claims"]["ways"][0]
    document["claims"]["ways"] = [text.translate(str.maketrans("MV", "VM"))]
    verified(document)


def test_densities_need_not_be_exact() -> None:
    document = alone(3)
    [row] = document["evidence"]["densities"]
    document["evidence"]["densities"] = [[c // 10**9 for c in row]]
    verified(document)
    document["evidence"]["densities"] = [[-7 * c for c in row]]
    verified(document)


def test_a_radius_that_is_too_large() -> None:
    document = alone(2)
    document["claims"]["radius"] = "1/25"
    stopped(document, "way 0 is not proved to stay within the radius")
    document["claims"]["radius"] = "-1/1000"
    stopped(document, "the radius is negative")


def test_letters_that_do_not_stay() -> None:
    message = "the letters of way 0 are not proved to stay"
    document = alone(0)
    document["claims"]["ways"] = ["MMMMMMM"]
    stopped(document, message)
    corners = [(0, 0), (10, 0), (10, 1), (0, 1), (5, Fraction(2, 5))]
    sheet = CreasePattern(corners, [(k, (k + 1) % 4, 4) for k in range(4)])
    document = tolerance_certificate(tolerance_of_branches(count_branches(sheet)))
    document["claims"] |= {"ways": document["claims"]["ways"][:1], "number": None}
    document["evidence"]["densities"].pop()
    document["claims"]["radius"] = "1/20"  # the zero stays farther than its letters
    stopped(document, message)


def test_a_panel_that_may_lose_its_shape() -> None:
    """A corner of the border that is nearly straight is on no fold."""
    points = [(0, 0), (Fraction(1, 2), Fraction(-1, 100)), (1, 0), (1, 1), (0, 1)]
    points.append((Fraction(2, 5), Fraction(1, 2)))
    edges = [(0, 1), (1, 2), (2, 3), (3, 4), (0, 4), (0, 5), (2, 5), (3, 5), (4, 5)]
    found = tolerance_of_panels(count_ways(PanelPattern(points, edges)))
    document = tolerance_certificate(found)
    assert verified(document)["number"] == 2
    document["claims"]["radius"] = "1/90"
    stopped(document, "the polygon (0, 1, 2, 3, 4) may lose its shape within the radius")


def test_the_number_of_ways() -> None:
    message = "the ways are not 4, the largest possible number"
    document = two()
    document["claims"]["number"] = 5
    stopped(document, message)
    document = two()
    document["claims"] |= {"ways": document["claims"]["ways"][:3], "number": 3}
    document["evidence"]["densities"].pop()
    stopped(document, message)


def test_two_ways_that_are_the_same() -> None:
    document = two()
    for rows in (document["claims"]["ways"], document["evidence"]["densities"]):
        rows[3] = rows[2]
    stopped(document, "two ways are not proved to differ: pair 5")


def test_sheets_with_other_numbers_of_folds() -> None:
    document = alone(0)
    document["pattern"]["edges"].remove([4, 5])
    document["evidence"]["densities"][0].pop()
    refused(document, "there are 6 folds, not 7")


def test_keys_and_lengths() -> None:
    for place, message in (
        ("claims", "claims: expected an object with the keys radius ways number"),
        ("evidence", "evidence: expected an object with the keys densities"),
    ):
        document = two()
        document[place]["more"] = 1
        refused(document, message)
    document = two()
    document["evidence"]["densities"].pop()
    refused(document, "densities does not have 4 entries")
    document = two()
    document["evidence"]["densities"][1].pop()
    refused(document, "the densities of a way does not have 7 entries")
    document = two()
    document["evidence"]["densities"][0] = [0] * 7
    refused(document, "malformed: ZeroDivisionError while checking")


def test_the_work_is_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(certificate, "TOLERANCE_WORK", 1000)
    message = beyond("the products of the test", 4 * 12**3, 1000, "TOLERANCE_WORK")
    stopped(two(), message)
    monkeypatch.undo()
    monkeypatch.setattr("exactfold.checker.tolerance.conditions.TOLERANCE_UNKNOWNS", 10)
    stopped(two(), beyond("the unknowns of a zero", 12, 10, "TOLERANCE_UNKNOWNS"))


# --- the bounds ----------------------------------------------------------------------------------


def zeros() -> list[Zero]:
    document = two()
    conditions = Conditions(read_panels(document["pattern"])[0])
    rows = document["evidence"]["densities"]
    return [Zero(conditions, [float(c) for c in row]) for row in rows]


def conditions_at(zero: Zero, x: np.ndarray, points: np.ndarray) -> np.ndarray:
    """F, written once more: products of gradients and directions, areas, and the factor."""
    of = zero.of
    g = x.reshape(-1, 2)
    rows = [(g[left] - g[right]) @ (points[j] - points[i]) for i, j, left, right in of.folds]
    rows += list(g.sum(axis=0))
    for ring in of.rings:
        polygon = g[ring]
        after = np.roll(polygon, -1, axis=0)
        rows.append((polygon[:, 0] * after[:, 1] - polygon[:, 1] * after[:, 0]).sum())
    centre = np.array(zero.x) / 2**S
    return np.array([*rows, centre @ x - 1])


@pytest.mark.parametrize("way", range(4))
def test_the_terms_are_bounded(way: int) -> None:
    """Random moves, and random points of the box: xi - Y F stays in it, and letters stay."""
    zero = zeros()[way]
    conditions = zero.of
    r = conditions.radius(Fraction(9, 1000))
    rho = zero.box(r)
    assert rho is not None
    letters = zero.letters(r, rho)
    box, size = np.array(rho) / 2**P, r / 2**P
    y, n = (np.array(m) / 2**S for m in (zero.y, zero.n))
    centre, points = np.array(zero.x) / 2**S, np.array(conditions.points) / 2**S
    generator = np.random.default_rng(way)
    worst = 0.0
    for _ in range(200):
        angles = generator.uniform(0, 2 * np.pi, len(points))
        moves = size * np.stack([np.cos(angles), np.sin(angles)], axis=1)
        xi = box * generator.choice([-1.0, 1.0], len(box))
        x = centre + n @ moves.ravel() + xi
        there = points + moves
        image = xi - y @ conditions_at(zero, x, there)
        worst = max(worst, float((np.abs(image) / box).max()))
        g = x.reshape(-1, 2)
        for i, j, left, right in conditions.folds:
            d, jump = there[j] - there[i], g[left] - g[right]
            bend = d[0] * jump[1] - d[1] * jump[0]
            assert letters[i, j] in ("", "V" if bend > 0 else "M")
    assert 0.05 < worst < 1


def test_sheets_nearby_have_the_letters_that_are_claimed() -> None:
    """Against exact counts of sheets whose vertices move by nearly the radius."""
    document = two()
    radius = float(Fraction(document["claims"]["radius"]))
    pattern = count_branches("two-vertex").pattern
    generator = np.random.default_rng(1)
    for _ in range(6):
        angles = generator.uniform(0, 2 * np.pi, len(pattern.vertices))
        moves = 0.999 * radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)
        points = [
            (Fraction(float(x) + dx).limit_denominator(10**9), Fraction(float(y) + dy))
            for (x, y), (dx, dy) in zip(pattern.vertices, moves, strict=True)
        ]
        found = count_branches(CreasePattern(points, pattern.triangles))
        letters = set()
        for branch in found.branches:
            text = "".join(branch.assignment[fold] for fold in sorted(branch.assignment))
            letters.add(min(text, text.translate(str.maketrans("MV", "VM"))))
        assert letters == set(document["claims"]["ways"])


# --- the writer ----------------------------------------------------------------------------------


def test_the_unit_of_a_sheet_does_not_matter() -> None:
    sheet = count_branches("two-vertex").pattern
    far = CreasePattern([(1000 * x + 5, 1000 * y - 7) for x, y in sheet.vertices], sheet.triangles)
    document = tolerance_certificate(tolerance_of_branches(count_branches(far)))
    radius = float(Fraction(verified(document)["radius"]))
    assert radius == pytest.approx(1000 * float(Fraction(two()["claims"]["radius"])), rel=1e-9)


def test_where_there_is_no_certificate() -> None:
    found = tolerance_of_panels(count_ways("square-twist"), 1)
    with pytest.raises(NotApplicableError, match="only a radius that is proved has a certificate"):
        tolerance_certificate(found)


def test_a_radius_that_the_checker_does_not_reach_is_made_smaller() -> None:
    found = tolerance_of_branches(count_branches(single_vertex(4)))
    object.__setattr__(found, "radius", 4 * found.radius)
    document = tolerance_certificate(found)
    claimed = float(Fraction(verified(document)["radius"]))
    assert 0.2 * found.radius < claimed < 0.9 * found.radius
    sheet = panels(found.pattern)
    conditions = Conditions(read_panels(panels_document(sheet))[0])
    zero = Zero(conditions, [float(c) for c in document["evidence"]["densities"][0]])
    assert "" not in zero.letters(conditions.radius(Fraction(claimed)), [0] * conditions.size)
