"""Forged certificates of meant sheets, each of which one line of the checker alone stops."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

import pytest
from forge import Document, beyond, given, refused, verified, with_one_key_more, without

from exactfold.checker.sheets.meant import summary
from exactfold.pattern.drawing.meant.values import Edge, Kind, Relation
from exactfold.pattern.meant_sheet import Realized, certificate
from exactfold.pattern.panel_pattern import PanelPattern

Terms = Sequence[tuple[Edge, int]]


def sheet(points: Sequence[tuple[int, int]], edges: Sequence[Edge], *said: Relation) -> Document:
    """A certificate about a sheet that is drawn exactly."""
    drawn = PanelPattern(points, edges)
    return certificate(Realized(drawn, drawn, Fraction(0), "exact", ""), said)


def claim(kind: Kind, name: str, terms: Terms, parts: int = 1) -> Relation:
    return Relation(kind, name, tuple(terms), parts, 0.0)


def stopped(made: Document, message: str) -> None:
    """Refused with this message, and accepted if the line with this message is taken out."""
    refused(made, message)
    with without(message):
        verified(made)


def star(*tips: tuple[int, int], said: Sequence[Relation] = ()) -> Document:
    """Folds from the origin, which is vertex 0, to the given points on the boundary, in order."""
    count = len(tips)
    rim = [(k, k % count + 1) for k in range(1, count + 1)]
    spokes = [(0, k) for k in range(1, count + 1)]
    return sheet([(0, 0), *tips], [*((min(e), max(e)) for e in rim), *spokes], *said)


CROSS = ((1, 0), (0, 1), (-1, 0), (0, -1))


def test_the_certificates_verify() -> None:
    for name, relations in (("miura", 27), ("bird-base", 115)):
        claims = verified(given(f"meant-{name}"))
        assert len(claims["relations"]) == relations
        kinds = {entry["kind"] for entry in claims["relations"]}
        every = {"straight", "border", "kawasaki", "grid", "parallel", "mirrored", "sectors"}
        assert kinds == every


def test_keys() -> None:
    made = with_one_key_more(given("meant-miura"), ("claims",))
    names = "interior border folds panels drawn within relations sha256"
    refused(made, f"claims: expected an object with the keys {names}")
    made = with_one_key_more(given("meant-miura"), ("claims", "relations", 3))
    refused(made, "a relation: expected an object with the keys kind name terms parts")


# --- the sheets ----------------------------------------------------------------------------------


def test_a_drawing_with_square_roots() -> None:
    made = given("meant-bird-base")
    made["drawn"] = made["pattern"]
    made["claims"]["drawn"] = made["claims"]["sha256"]
    stopped(made, "the drawing has coordinates with square roots")


def test_other_panels() -> None:
    """The mirror image of the sheet, at a distance that is stated rightly."""
    made = given("meant-miura")
    mirrored = PanelPattern(
        [(-Fraction(x[0]), Fraction(y[0])) for x, y in made["drawn"]["vertices"]],
        [(i, j) for i, j in made["drawn"]["edges"]],
    )
    made["drawn"]["vertices"] = [[[str(x)], [str(y)]] for x, y in mirrored.vertices]
    made["claims"] |= {"within": "3", "drawn": mirrored.sha256}
    stopped(made, "the drawing and the sheet do not have the same panels")


@pytest.mark.parametrize("name", ["interior", "border", "folds", "panels", "drawn", "sha256"])
def test_other_numbers(name: str) -> None:
    made = given("meant-miura")
    fact, wrong = made["claims"][name], "0" * 64 if name in ("drawn", "sha256") else 99
    made["claims"][name] = wrong
    stopped(made, f"claim {name} = {wrong!r}, but it is {fact!r}")


@pytest.mark.parametrize("name", ["miura", "bird-base"])
def test_a_smaller_distance(name: str) -> None:
    """The distance is rounded up to three digits: two units less in the last one is too little."""
    made = given(f"meant-{name}")
    within = Fraction(made["claims"]["within"])
    unit = Fraction(1, 10**11)
    assert 100 * unit <= within < 1000 * unit
    verified(made)
    made["claims"]["within"] = str(within - 2 * unit)
    with pytest.raises(Exception, match="lies further from its drawing") as caught:
        verified(made)
    message = str(caught.value)
    assert message.startswith("vertex ")
    stopped(made, message)


def test_a_negative_distance() -> None:
    made = given("meant-miura")
    made["claims"]["within"] = f"-{made['claims']['within']}"
    stopped(made, "a distance is negative")


# --- relations -----------------------------------------------------------------------------------


def test_relations_that_do_not_hold() -> None:
    skew = ((3, 1), (-1, 2), (-2, -1), (2, -3))
    alternate = [((0, k), (-1) ** k) for k in (1, 2, 3, 4)]
    for relation in (
        claim("straight", "straight@0:1-3", [((0, 1), 1), ((0, 3), -1)]),
        claim("border", "border@1", [((1, 2), 1), ((1, 4), -1)]),
        claim("kawasaki", "kawasaki@0", alternate),
        claim("parallel", "parallel:0-1,2-3", [((0, 1), 1), ((2, 3), -1)]),
        claim("mirrored", "mirrored:0-1,0-4", [((0, 1), 1), ((0, 4), 1)], 8),
        claim("mirrored", "mirrored:0-1,0-2", [((0, 1), 1), ((0, 2), 1), ((0, 3), -2)]),
        claim("grid", "grid:0-2", [((0, 2), 1)], 16),
        claim("grid", "grid:0-1,0-2", [((0, 1), 1), ((0, 2), -1)], 16),
        claim("sectors", "sectors@0:1-2,2-3", [((0, 2), 2), ((0, 1), -1), ((0, 3), -1)]),
    ):
        stopped(star(*skew, said=[relation]), f"{relation.name} does not hold")


def test_a_relation_that_nearly_holds() -> None:
    """A grid of 22.5 degrees that a vertex in a field of square roots misses by 1e-20."""
    made = given("meant-bird-base")
    vertex = made["claims"]["interior"]
    coordinate = made["pattern"]["vertices"][vertex][0]
    coordinate[0] = str(Fraction(coordinate[0]) + Fraction(1, 10**20))
    with pytest.raises(Exception, match="claim sha256") as caught:
        verified(made)
    made["claims"]["sha256"] = str(caught.value).split("'")[-2]
    with pytest.raises(Exception, match="does not hold"):
        verified(made)


@pytest.mark.parametrize("kind", ["angles", None, ["grid"]])
def test_kinds_that_do_not_exist(kind: object) -> None:
    made = given("meant-miura")
    made["claims"]["relations"][0]["kind"] = kind
    said = "malformed: TypeError while checking"
    refused(made, f"there is no kind of relation {kind!r}" if kind != ["grid"] else said)


def test_another_name() -> None:
    made = given("meant-miura")
    relation = made["claims"]["relations"][0]
    name, relation["name"] = relation["name"], "border@77"
    stopped(made, f"'border@77' has the terms of {name}")


def test_relations_that_appear_twice() -> None:
    made = given("meant-miura")
    for relation in list(made["claims"]["relations"]):
        again = dict(relation)
        if relation["kind"] in ("kawasaki", "straight", "border"):  # the same relation, negated
            again["terms"] = [[i, j, -n] for i, j, n in relation["terms"]][::-1]
        made["claims"]["relations"] = [relation, again]
        stopped(made, f"{relation['name']} appears twice")


def test_one_fact_under_two_kinds_counts_once() -> None:
    """A straight line is parallel to itself; such claims would only swell the number."""
    once = claim("straight", "straight@0:1-3", [((0, 1), 1), ((0, 3), -1)])
    again = claim("parallel", "parallel:0-3,0-1", [((0, 3), 1), ((0, 1), -1)])
    other = claim("grid", "grid:0-1,0-2", [((0, 1), 1), ((0, 2), -1)], 2)
    made = star(*CROSS, said=[once, again, other])
    said = (
        "with 2 exact relations of angles (1 straight, 1 parallel, 1 grid; 1 is the same as others)"
    )
    assert said in summary(verified(made))
    made = star(*CROSS, said=[again, other])
    assert "with 2 exact relations of angles (1 parallel, 1 grid);" in summary(verified(made))


def test_no_parts() -> None:
    relation = claim("grid", "grid:0-1", [((0, 1), 1)], 0)
    skew = ((3, 1), (-1, 2), (-2, -1), (2, -3))
    stopped(star(*skew, said=[relation]), "grid:0-1 has 0 parts")


@pytest.mark.parametrize(
    ("kind", "name", "terms"),
    [
        ("parallel", "parallel:0-1,0-2", [((0, 1), 1), ((0, 2), -1)]),
        ("straight", "straight@0:1-2", [((0, 1), 1), ((0, 2), -1)]),
        ("border", "border@1", [((1, 2), 1), ((1, 4), -1)]),
        ("kawasaki", "kawasaki@0", [((0, k), (-1) ** k) for k in (1, 2, 3, 4)]),
    ],
)
def test_parts_that_make_a_relation_weaker(kind: Kind, name: str, terms: Terms) -> None:
    """Right angles of a cross are no multiples of pi, but of pi / 2."""
    relation = claim(kind, name, terms, 2)
    stopped(star(*CROSS, said=[relation]), f"{name} has 2 parts, not 1")


def test_sectors_that_are_equal_up_to_a_right_angle() -> None:
    terms = [((0, 2), 1), ((0, 1), -1), ((0, 4), -1), ((0, 3), 1)]
    said = claim("sectors", "sectors@0:1-2,3-4", terms, 4)
    made = star((1, 0), (1, 1), (-1, 0), (0, -1), said=[said])
    stopped(made, "sectors@0:1-2,3-4 has 4 parts, not 1")


def test_too_many_parts() -> None:
    relation = claim("grid", "grid:0-1", [((0, 1), 1)], 361)
    message = beyond("the parts of pi in a relation", 361, 360, "MOST_PARTS")
    stopped(star(*CROSS, said=[relation]), message)


# --- terms ---------------------------------------------------------------------------------------


def test_terms_that_are_no_edges() -> None:
    stopped(star(*CROSS, said=[claim("grid", "grid:1-3", [((1, 3), 1)])]), "1-3 is not an edge")


def test_an_edge_that_appears_twice() -> None:
    """Every edge is parallel to itself, so that such relations would only swell their number."""
    relation = claim("parallel", "parallel:0-1,0-1", [((0, 1), 1), ((0, 1), -1)])
    stopped(star(*CROSS, said=[relation]), "an edge appears twice in a relation")


def test_numbers_of_terms() -> None:
    """Mirrored edges that are named parallel; an edge that is taken twice."""
    tips = ((2, 1), (-2, 1), (-2, -1), (2, -1))
    relation = claim("parallel", "parallel:0-1,0-2", [((0, 1), 1), ((0, 2), 1)])
    stopped(star(*tips, said=[relation]), "the terms of a pair of edges are [1, 1], not 1, -1")
    relation = claim("grid", "grid:0-1", [((0, 1), 8)])
    made = star((2, 2), (-2, 1), (-2, -1), (2, -1), said=[relation])
    stopped(made, "grid: the number of the edge is not 1")


# --- the kinds -----------------------------------------------------------------------------------

NOTCHED = [(0, 0), (4, 0), (4, 4), (2, 4), (2, 2), (0, 2), (2, 0), (4, 2)]
"""A square without its upper left quarter; vertex 4 is the corner of the notch."""
NOTCH = [(0, 6), (1, 6), (1, 7), (2, 7), (2, 3), (3, 4), (4, 5), (0, 5)]


def test_a_straight_border_is_no_straight_fold() -> None:
    relation = claim("straight", "straight@6:0-1", [((0, 6), 1), ((1, 6), -1)])
    made = sheet(NOTCHED, [*NOTCH, (4, 6), (4, 7)], relation)
    stopped(made, "straight: vertex 6 is not inside the sheet")


def test_a_fold_that_goes_on_along_the_border_is_no_straight_border() -> None:
    relation = claim("border", "border@4", [((3, 4), 1), ((4, 6), -1)])
    made = sheet(NOTCHED, [*NOTCH, (4, 6), (4, 7)], relation)
    stopped(made, "border: edge 6-4 is not on the boundary")


def test_lines_without_a_common_end() -> None:
    relation = claim("straight", "straight@0:1-2", [((1, 2), 1), ((3, 4), -1)])
    refused(star(*CROSS, said=[relation]), "the edges of a relation do not meet in one vertex")


def test_kawasaki_at_a_vertex_of_the_boundary() -> None:
    """Without folds there, it says that the border is straight."""
    relation = claim("kawasaki", "kawasaki@6", [((0, 6), 1), ((1, 6), -1)])
    made = sheet(NOTCHED, [*NOTCH, (4, 7)], relation)
    stopped(made, "kawasaki: vertex 6 is not inside the sheet")


def test_kawasaki_at_three_folds() -> None:
    """The angles of the folds are 0, 135 and -45 degrees."""
    points = [(0, 0), (2, 0), (-2, 2), (2, -2), (-3, -3)]
    edges = [(1, 2), (2, 4), (3, 4), (1, 3), (0, 1), (0, 2), (0, 3)]
    terms = [((0, 1), 1), ((0, 2), -1), ((0, 3), 1)]
    made = sheet(points, edges, claim("kawasaki", "kawasaki@0", terms))
    stopped(made, "kawasaki: vertex 0 has an odd number of folds")


@pytest.mark.parametrize("numbers", [(1, 1, -1, -1), (2, -2, 2, -2), (1, 1, 1, 1)])
def test_kawasaki_with_other_numbers(numbers: tuple[int, ...]) -> None:
    terms = [((0, k), n) for k, n in enumerate(numbers, 1)]
    made = star(*CROSS, said=[claim("kawasaki", "kawasaki@0", terms)])
    stopped(made, "kawasaki: the numbers of the folds at vertex 0 do not alternate")


def test_kawasaki_without_a_fold() -> None:
    terms = [((0, 1), 1), ((0, 3), -1)]
    made = star(*CROSS, said=[claim("kawasaki", "kawasaki@0", terms)])
    stopped(made, "kawasaki: the numbers of the folds at vertex 0 do not alternate")


def test_a_sector_outside_the_sheet() -> None:
    """The notch is as wide as the sector beside it."""
    terms = [((3, 4), 2), ((4, 5), -1), ((4, 7), -1)]
    relation = claim("sectors", "sectors@4:7-3,3-5", terms)
    made = sheet(NOTCHED, [*NOTCH, (4, 6), (4, 7)], relation)
    stopped(made, "sectors@4:7-3,3-5: a sector lies outside the sheet")


def test_sectors_that_differ_by_half_a_turn() -> None:
    """The folds have the angles 0, 45 and 270 degrees, and the sectors 45, 225 and 90."""
    points = [(0, 0), (2, 0), (2, 2), (0, -2), (-3, 3), (-3, -3)]
    edges = [(1, 2), (2, 4), (4, 5), (3, 5), (1, 3), (0, 1), (0, 2), (0, 3)]
    terms = [((0, 1), -1), ((0, 2), 2), ((0, 3), -1)]
    made = sheet(points, edges, claim("sectors", "sectors@0:1-2,2-3", terms))
    stopped(made, "sectors@0:1-2,2-3: the sectors differ by pi")


def test_sectors_that_are_none() -> None:
    """Opposite folds of a cross are no sides of one sector."""
    terms = [((0, 1), 1), ((0, 3), -1)]
    made = star(*CROSS, said=[claim("sectors", "sectors@0:1-3", terms)])
    refused(made, "the terms are not those of two sectors at vertex 0")


def test_the_axis_of_mirrored_edges() -> None:
    """The axis is an edge, and the sum is that of two angles minus twice its own."""
    tips = ((1, 0), (1, 1), (0, 1), (-1, -1))
    terms = [((0, 1), 1), ((0, 3), 1), ((0, 2), -2)]
    verified(star(*tips, said=[claim("mirrored", "mirrored:0-1,0-3", terms)]))
    for number in (2, -6):
        relation = claim("mirrored", "mirrored:0-1,0-3", [*terms[:2], ((0, 2), number)])
        made = star(*tips, said=[relation])
        stopped(made, "mirrored: the number of the axis is not -2")
    relation = claim("mirrored", "mirrored:0-1,0-3", [*terms, ((0, 4), 4)])
    made = star(*tips, said=[relation])
    stopped(made, "mirrored: there are more than three edges")
