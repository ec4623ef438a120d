"""Forged lists of all assignments: for each refusing line, a false proof that it alone stops."""

from __future__ import annotations

from math import cos, pi, sin

import pytest
from forge import Document, beyond, given, refused, verified, with_one_key_more, without
from sheets import wheel

from exactfold import CreasePattern, checker
from exactfold.certificates.entries import pattern_document
from exactfold.checker.letters import arcs, assignments
from exactfold.checker.sheets.sheet import read_sheet
from exactfold.design.circles.nappe_points import NappePoints


def listed(name: str = "pentagon") -> Document:
    """A fresh copy of a certificate."""
    return given(f"assignments-{name}")


def stopped(document: Document, message: str) -> None:
    """Refused with this message, and accepted without that line, with the claims it then shows."""
    sheet, _ = read_sheet(document["pattern"])
    with without(message):
        document["claims"]["assignments"] = assignments._shown(sheet, document["evidence"])
        verified(document)
    refused(document, message)


def round_a_circle(pattern: CreasePattern, boundaries: list[list[float]]) -> Document:
    """A certificate of a sheet with one vertex, by points over some rims."""
    free = assignments.free_boundary(read_sheet(pattern_document(pattern))[0])
    solver = NappePoints(pattern, free, 17)
    points = [solver.solved([1], rim) for rim in boundaries]
    assert None not in points
    document = listed("side")
    document["pattern"] = pattern_document(pattern)
    document["evidence"]["circles"] = [[[str(z) for z in point or ()] for point in points]]
    return document


def turns(number: int) -> list[list[float]]:
    """Directions all round a circle."""
    return [
        [cos(2 * pi * (k + 0.3) / number), sin(2 * pi * (k + 0.3) / number)] for k in range(number)
    ]


# --- what is said --------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("pentagon", "32 mountain-valley assignments occur"),
        ("triangle", "32 mountain-valley assignments occur"),
        ("chord", "8 mountain-valley assignments occur"),
        ("cross", "0 mountain-valley assignments occur"),
        ("side", "12 mountain-valley assignments occur"),
    ],
)
def test_what_is_said(name: str, text: str) -> None:
    document = listed(name)
    claims = verified(document)
    digest = read_sheet(document["pattern"])[1]
    assert checker.summary(claims) == f"VALID: exactly {text} with no fold flat; sha256 {digest}"


def test_what_is_in_a_triangle_stays_flat_and_a_chord_bends_by_itself() -> None:
    triangle = verified(listed("triangle"))["assignments"]
    assert all(text.count("F") == 3 for text in triangle)
    assert {t.replace("F", "") for t in triangle} == set(verified(listed())["assignments"])
    chord = verified(listed("chord"))["assignments"]
    assert len({text[:2] + text[3:] for text in chord}) == 4


# --- forgeries -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("place", "message"),
    [
        (("claims",), "claims: expected an object with the keys assignments"),
        (("evidence",), "evidence: expected an object with the keys emptied circles"),
    ],
)
def test_keys(place: tuple[str | int, ...], message: str) -> None:
    refused(with_one_key_more(listed(), place), message)


def test_the_list_is_the_one_shown() -> None:
    message = "the evidence shows 32 assignments, not those listed"
    for change in (lambda t: t[1:], lambda t: [*t, "M" * 8], lambda t: [t[1], t[0], *t[2:]]):
        document = listed()
        texts = document["claims"]["assignments"]
        document["claims"]["assignments"] = change(texts)
        with without(message):
            verified(document)
        refused(document, message)


def test_six_corners_have_more_than_circles() -> None:
    """A circle of directions of the boundary is not all of a sphere."""
    hexagon = wheel([(0, 0), (7, -2), (11, 3), (9, 8), (2, 9), (-2, 5)], (4, 3))
    document = round_a_circle(hexagon, [[*rim, 0.3] for rim in turns(300)])
    stopped(document, "there are not five boundary vertices")


def test_the_border_is_convex() -> None:
    dented = wheel([(-4, -4), (4, -4), (3, 0), (4, 4), (-4, 4)])
    stopped(round_a_circle(dented, turns(120)), "the boundary is not convex")


def test_some_vertex_can_pop_and_not_too_many(monkeypatch: pytest.MonkeyPatch) -> None:
    fan = CreasePattern(
        [(0, 0), (4, 0), (5, 3), (2, 6), (-2, 3)], [(0, 1, 2), (0, 2, 3), (0, 3, 4)]
    )
    document = listed("chord")
    document["pattern"] = pattern_document(fan)
    refused(document, "no vertex can pop")
    monkeypatch.setattr(assignments, "MOST_VERTICES", 1)
    verified(listed("side"))
    stopped(listed(), beyond("the vertices that can pop", 2, 1, "ASSIGNED_VERTICES"))


def test_there_are_circles_for_all_signs() -> None:
    document = listed()
    del document["evidence"]["circles"][1]
    refused(document, "circles does not have 2 entries")


def test_a_point_is_inside_its_nappes() -> None:
    """Below the null cone nothing is known; in the other nappes are other solutions."""
    document = listed()
    point = document["evidence"]["circles"][0][3]
    point[2] = str(int(point[2]) - (1 << 44))
    stopped(document, "circle 0: K is not positive at vertex 5")
    document = listed("side")
    (circle,) = document["evidence"]["circles"]
    circle[:] = [[str(-int(z)) for z in point] for point in circle]
    stopped(document, "circle 0: vertex 5 does not have the sign 1")


def test_points_go_all_round_the_border() -> None:
    document = listed("side")
    circle = document["evidence"]["circles"][0]
    near = next(k for k in range(1, len(circle)) if _is_known(document, circle[k - 1 : k + 1]))
    document["evidence"]["circles"][0] = circle[near - 1 : near + 1]
    stopped(document, "circle 0: the boundary heights do not turn on after point 1")
    assert len(document["claims"]["assignments"]) < 12
    document = listed()
    document["evidence"]["circles"][1] = []
    stopped(document, "circle 1 has no points")
    assert len(document["claims"]["assignments"]) < 32


def _is_known(document: Document, two: list[list[str]]) -> bool:
    """Whether a point has all the letters that are possible up to the next."""
    document["evidence"]["circles"][0] = two
    sheet, _ = read_sheet(document["pattern"])
    with without("circle 0: the boundary heights do not turn on after point 1"):
        try:
            assignments._shown(sheet, document["evidence"])
        except checker.CertificateError:
            return False
    return True


def test_both_sides_of_a_border_with_four_corners() -> None:
    document = listed("chord")
    circle = document["evidence"]["circles"][0]
    circle[1] = circle[0]
    stopped(document, "circle 0: the two points are not on the two sides of the flat state")
    assert len(document["claims"]["assignments"]) == 4


def test_all_letters_between_two_points_occur() -> None:
    document = listed()
    for circle in document["evidence"]["circles"]:
        circle[:] = circle[::6]
    sheet, _ = read_sheet(document["pattern"])
    with pytest.raises(checker.CertificateError) as caught:
        assignments._shown(sheet, document["evidence"])
    message = str(caught.value)
    assert message.startswith("circle 0: other letters are possible after point ")
    with without(message), pytest.raises(checker.CertificateError):
        verified(document)


def test_what_is_open_is_not_too_much(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(arcs, "MOST_OPEN", 1)
    stopped(listed(), beyond("the ways to complete open letters", 3, 1, "MOST_OPEN"))


def test_an_ear_is_one_face() -> None:
    """A vertex in the corner behind a chord has to be named as one in a triangle."""
    document = listed("chord")
    points, faces = (document["pattern"][key] for key in ("vertices", "triangles"))
    points.append(["1", "4"])
    faces[-1:] = [[2, 3, 6], [3, 4, 6], [2, 6, 4]]
    refused(document, "malformed: ValueError while checking")
    document["evidence"]["emptied"] = [{"corners": [2, 3, 4], "inside": [6]}]
    texts = document["claims"]["assignments"]
    refused(document, "the evidence shows 8 assignments, not those listed")
    sheet, _ = read_sheet(document["pattern"])
    shown = assignments._shown(sheet, document["evidence"])
    assert sorted(text.replace("F", "") for text in shown) == texts
