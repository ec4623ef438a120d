"""Forged certificates of periodic sheets: for each refusing line, what it alone stops."""

from __future__ import annotations

import json
from fractions import Fraction
from typing import Any

import pytest
from forge import Document, beyond, given, refused, stopped, verified, with_one_key_more, without

from exactfold.branches.periodic.certificate import periodic_certificate
from exactfold.branches.periodic.counting import count_periodic
from exactfold.branches.periodic.lines import times
from exactfold.checker.branches import periodic, periodic_proof
from exactfold.checker.core.limits import PERIODIC_VERTICES
from exactfold.pattern.periodic.cell_files import parse_cell
from exactfold.pattern.periodic.random_cells import random_cell


def periodic_file(name: str) -> Document:
    """A fresh copy of a certificate."""
    return given(f"periodic-{name}")


@pytest.mark.parametrize("name", ["pleat", "family", "flat", "line", "triangle", "waterbomb"])
def test_true_certificates_verify(name: str) -> None:
    document = periodic_file(name)
    assert verified(document) == document["claims"]


# --- the cell -------------------------------------------------------------------------------------


def faces(document: Document) -> list[Any]:
    found: list[Any] = document["pattern"]["faces"]
    return found


def test_a_cell_that_is_none() -> None:
    for change, message in (
        (
            lambda d: d["pattern"].update(lattice=[["1", "0"], ["2", "0"]]),
            "vectors are parallel",
        ),
        (lambda d: faces(d)[0].reverse(), "is not positive"),
        (lambda d: faces(d).append(faces(d)[0]), "two faces on one side of the edge"),
        (lambda d: d["pattern"]["vertices"].append(["1/3", "1/5"]), "vertex 3 is on no face"),
        (lambda d: faces(d).pop(), "has one face only"),
        (lambda d: faces(d)[0].pop(), "a face does not have 3 corners"),
        (lambda d: faces(d)[0][0].__setitem__(0, 7), "face uses vertex 7"),
        (lambda d: faces(d)[0][0].__setitem__(0, -1), "face uses vertex -1"),
    ):
        document = periodic_file("waterbomb")
        change(document)
        with pytest.raises(Exception, match=message):  # each message is of one line only
            verified(document)


def false(document: Document, line: str) -> None:
    """With the claims that its evidence seems to show, accepted without one line only."""
    with without(line), pytest.MonkeyPatch.context() as patch:
        patch.setattr(periodic, "same", lambda claim, fact: True)
        document["claims"] = dict(verified(document))
    stopped(document, line)


def test_faces_that_cover_the_plane_twice() -> None:
    """One vertex and faces of twice the area: locally a sheet, but each point is covered twice."""
    document = periodic_file("waterbomb")
    document["pattern"] = {
        "lattice": [["1", "0"], ["0", "1"]],
        "vertices": [["0", "0"]],
        "faces": [[[0, 0, 0], [0, 2, 0], [0, 2, 1]], [[0, 0, 0], [0, 2, 1], [0, 0, 1]]],
    }
    document["evidence"]["rays"] = [{"place": 0, "bits": 0, "radius": "1", "center": []}]
    false(document, "the faces do not cover each point once")


# --- triangulated triangles -----------------------------------------------------------------------


def ring(document: Document) -> Document:
    (entry,) = document["evidence"]["triangles"]
    found: Document = entry
    return found


def test_rings_are_what_they_say() -> None:
    for change, message in (
        (lambda d: ring(d)["inside"].clear(), "a ring has no vertex inside"),
        (lambda d: ring(d)["ring"].pop(), "a ring does not have 3 corners"),
        (lambda d: ring(d)["ring"][1].__setitem__(1, 5), "is not an edge"),
        (lambda d: ring(d)["inside"][0].__setitem__(1, 5), "is not inside the ring"),
        (lambda d: d["evidence"]["triangles"].append(ring(d)), "two faces on one side"),
    ):
        document = periodic_file("triangle")
        change(document)
        with pytest.raises(Exception, match=message):
            verified(document)


def test_a_ring_that_lost_a_corner() -> None:
    """A ring inside another one: its corners are gone."""
    document = periodic_file("triangle")
    entry = ring(document)
    (inner,), corners = entry["inside"], entry["ring"]
    entry["inside"].append(inner)
    document["evidence"]["triangles"].append({"ring": [*corners[:2], inner], "inside": [inner]})
    refused(document, f"{tuple(inner)} is not inside the ring")
    with without(f"{tuple(inner)} is not inside the ring"):
        refused_by = "a ring lost a corner"
        with pytest.raises(Exception, match=refused_by):
            verified(document)


# --- rays -----------------------------------------------------------------------------------------


def rays(document: Document) -> list[Document]:
    found: list[Document] = document["evidence"]["rays"]
    return found


def test_a_ray_that_is_missing_leaves_signs_open() -> None:
    document = periodic_file("waterbomb")
    rays(document).pop()
    false(document, "1 pairs of opposite sign vectors are not covered")


def test_a_ray_that_is_listed_twice_would_be_two_branches() -> None:
    document = periodic_file("waterbomb")
    rays(document).append(rays(document)[0])
    false(document, "another ray has these signs")


def test_a_ray_that_is_a_space_again_would_be_two_branches() -> None:
    """The only solution of one vertex is rational, so that it is a ray and a line over Q."""
    cell = parse_cell(
        json.dumps(
            {
                "format": "exactfold periodic pattern",
                "lattice": [["1", "0"], ["0", "1"]],
                "points": [["0", "0"]],
                "faces": [[[0, 0, 0], [0, 1, 0], [0, 1, 1]], [[0, 0, 0], [0, 1, 1], [0, 0, 1]]],
            }
        )
    )
    document = json.loads(json.dumps(count_periodic(cell, (1, 2)).certificate()))
    assert verified(document)["distinct"] == 1
    spaces(document).append({"basis": [["1"]], "points": [["1"]]})
    false(document, "another ray has these signs")


def test_a_pleat_is_no_ray() -> None:
    """A simple pleat lies in a box with b around 0; it would be a branch whose b has no sign."""
    document = periodic_file("pleat")
    space = spaces(document).pop(0)
    (row,) = space["basis"]
    place = row.index("1")
    center = [str(int(x) << 44) for k, x in enumerate(row) if k != place]
    rays(document).append({"place": place, "bits": 44, "radius": str(1 << 10), "center": center})
    false(document, "the sign of b of a ray is open")


def test_a_solution_with_a_flat_vertex_is_no_simple_ray() -> None:
    """A wide box shows no sign of a vertex; it would be a flat one, with multiplicity 2."""
    document = periodic_file("waterbomb")
    message = "a vertex of a simple ray has no sign"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(periodic_proof.Krawczyk, "check", lambda *_: None)
        rays(document)[0]["radius"] = str(1 << 60)
        refused(document, message)
    flat = periodic_file("flat")
    (row,) = next(s for s in spaces(flat) if len(s["points"]) == 1)["basis"]
    scale = Fraction(row[-1])
    center = [str(int(Fraction(x) / scale * 2**44)) for x in row[:-1]]
    rays(flat).append({"place": 3, "bits": 44, "radius": str(1 << 20), "center": center})
    refused(flat, f"Krawczyk's test fails for the box about {[*map(int, center[:2])]}.../2^44")


def test_places_and_units() -> None:
    document = periodic_file("waterbomb")
    rays(document)[0]["place"] = 3
    refused(document, "there is no such place")
    document = periodic_file("waterbomb")
    document["evidence"]["unit"] = "0"
    refused(document, "the unit is not positive")
    document = periodic_file("waterbomb")
    document["claims"]["direction"] = [0, 0]
    refused(document, "the direction is 0")


# --- spaces ---------------------------------------------------------------------------------------


def spaces(document: Document) -> list[Document]:
    found: list[Document] = document["evidence"]["spaces"]
    return found


def test_bases_and_points_are_needed() -> None:
    for change, message in (
        (lambda d: spaces(d)[0]["basis"].clear(), "a basis is not in reduced echelon form"),
        (
            lambda d: spaces(d)[0].update(basis=[["0", "2", "2", "0"]]),
            "a basis is not in reduced echelon form",
        ),
        (lambda d: spaces(d)[0]["points"].clear(), "a space has no point"),
    ):
        document = periodic_file("pleat")
        change(document)
        refused(document, message)


def test_a_space_that_is_listed_twice() -> None:
    document = periodic_file("flat")
    spaces(document).append(spaces(document)[0])
    false(document, "a space is listed twice")


def test_a_point_of_another_space() -> None:
    """The points of one pleat would cover its signs, while another pleat is listed for them."""
    for points in ([["0"] * 4], None):
        document = periodic_file("pleat")
        spaces(document)[0]["points"] = points or spaces(document)[1]["points"]
        refused(document, "a point is 0, or not in its space")


def test_a_space_on_which_a_form_does_not_vanish() -> None:
    document = periodic_file("pleat")
    spaces(document)[0] = {"basis": [["1", "5", "0", "0"]], "points": [["1", "5", "0", "0"]]}
    refused(document, "a form does not vanish on a space")


def test_a_line_inside_a_larger_space() -> None:
    """A solution of a family is not isolated: it would count as a branch of its own."""
    document = periodic_file("family")
    wide = next(space for space in spaces(document) if len(space["basis"]) == 2)
    basis = [a for a in wide["basis"] if a[-1] != "0"]
    spaces(document).append({"basis": basis, "points": basis})
    false(document, "a point of a space lies in a larger one")


# --- lines over quadratic fields ------------------------------------------------------------------


def lines(document: Document) -> list[Document]:
    found: list[Document] = document["evidence"]["lines"]
    return found


def with_lines(document: Document, *found: Document) -> Document:
    """A certificate of the first version, with lines."""
    document["version"] = 2
    document["claims"]["lines"] = []
    document["evidence"]["lines"] = [*found]
    return document


def test_a_line_over_a_square_is_two_points() -> None:
    """With sqrt 4 = 2 the point and its conjugate are two rational branches.

    On the first a fold is flat, on the other it is not, so that it would get a letter.
    """
    document = periodic_certificate(count_periodic(random_cell(2, 3, 4, flips=2), (1, 0)))
    branch = document["claims"]["branches"][1]
    assert (branch["vertex_signs"], branch["letters"]) == ("++", "MVMFFM")
    ray = document["evidence"]["rays"].pop(0)
    assert Fraction(int(ray["center"][0]), 1 << ray["bits"]) == Fraction(3, 32)
    with_lines(document, {"radicand": 4, "point": [["1", "0"], ["20/3", "2"]]})
    false(document, "a radicand is a square")
    assert document["claims"]["branches"][1]["letters"] == "MVMMMM"


def test_a_rational_line_is_a_space_again() -> None:
    point = [["1", "0"], ["1", "0"], ["0", "0"], ["0", "0"]]
    document = with_lines(periodic_file("pleat"), {"radicand": 5, "point": point})
    spaces(document).pop(0)  # the same line
    false(document, "a line is rational")


@pytest.mark.parametrize(
    ("radicand", "times", "one"), [(5, 1, "1"), (5, 1, "2/2"), (20, Fraction(1, 2), "1")]
)
def test_a_line_that_is_listed_twice_would_be_two_pleats(
    radicand: int, times: Fraction, one: str
) -> None:
    """Also if its numbers are written in another way, or with another root."""
    document = periodic_file("line")
    again = [[a, str(times * Fraction(c))] for a, c in lines(document)[0]["point"]]
    again[0][0] = one
    lines(document).append({"radicand": radicand, "point": again})
    false(document, "the signs of a line are covered before")


def test_a_line_with_another_factor_is_not_the_listed_one() -> None:
    for factor in ((Fraction(2), Fraction(0)), (Fraction(1), Fraction(1))):  # 2, and 1 + sqrt 5
        document = periodic_file("line")
        pairs = [tuple(map(Fraction, pair)) for pair in lines(document)[0]["point"]]
        scaled = [[str(x) for x in times(pair, factor, 5)] for pair in pairs]
        lines(document)[0] = {"radicand": 5, "point": scaled}
        false(document, "the first entry of a line that is not 0 is not 1")


def test_a_line_that_is_no_solution() -> None:
    document = periodic_file("line")
    lines(document)[0]["point"][2] = ["-27/5", "5/2"]
    false(document, "a form does not vanish on a line")


def test_a_line_of_a_family_would_be_a_branch_of_its_own() -> None:
    """Two lines have the signs of the plane that they span, and would take its place."""
    document = periodic_certificate(count_periodic("yoshimura-cell", (0, 1)))
    assert [space["dimension"] for space in document["claims"]["families"]] == [2]
    spaces(document).clear()
    found = [{"radicand": 2, "point": [["1", "0"], ["0", c]]} for c in ("1/8", "8")]
    with_lines(document, *found)
    false(document, "a line lies in a larger space of solutions")
    assert document["claims"]["families"] == []


def test_a_line_without_which_signs_are_open() -> None:
    document = periodic_file("line")
    lines(document).pop()
    false(document, "1 pairs of opposite sign vectors are not covered")


def test_what_a_line_is() -> None:
    for change, message in (
        (lambda d: lines(d)[0]["point"].pop(), "point does not have 4 entries"),
        (lambda d: lines(d)[0]["point"][1].pop(), "number does not have 2 entries"),
        (lambda d: lines(d)[0].update(radicand=-5), "radicand is not a natural number"),
        (lambda d: lines(d)[0].update(more=1), "line: expected an object with the keys"),
        (lambda d: d.update(version=1), "expected an object with the keys"),
        (lambda d: d["claims"].pop("lines"), "expected an object with the keys"),
        (lambda d: d["claims"].update(lines=[]), "the claim 'lines' is not what"),
    ):
        document = periodic_file("line")
        change(document)
        with pytest.raises(Exception, match=message):
            verified(document)


# --- claims ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("with_multiplicity", 2),
        ("pleats", []),
        ("sha256", "0" * 64),
        ("families", [{"dimension": 1, "basis": [["0"] * 5]}]),
    ],
)
def test_other_claims(key: str, value: Any) -> None:
    document = periodic_file("pleat")
    document["claims"][key] = value if value != document["claims"][key] else 99
    stopped_claim = f"the claim {key!r} is not what the evidence shows"
    stopped(document, stopped_claim)


def test_the_direction_belongs_to_the_evidence() -> None:
    document = periodic_file("waterbomb")
    document["claims"]["direction"] = [2, 1]
    with pytest.raises(Exception, match="Krawczyk"):
        verified(document)


@pytest.mark.parametrize(
    "place",
    [
        ("claims",),
        ("evidence",),
        ("pattern",),
        ("evidence", "rays", 0),
        ("evidence", "spaces", 0),
    ],
)
def test_unknown_keys(place: tuple[str | int, ...]) -> None:
    with pytest.raises(Exception, match="expected an object with the keys"):
        verified(with_one_key_more(periodic_file("pleat"), place))


def test_unknown_keys_of_a_triangle() -> None:
    document = with_one_key_more(periodic_file("triangle"), ("evidence", "triangles", 0))
    refused(document, "triangle: expected an object with the keys ring inside")


def test_too_many_vertices(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(periodic_proof, "PERIODIC_VERTICES", 2)
    message = beyond("the vertices of the cell", 3, 2, "PERIODIC_VERTICES")
    refused(periodic_file("waterbomb"), message)
    assert PERIODIC_VERTICES > 2
