"""Cones of several forms: what the checker shows of them, and what it refuses."""

from __future__ import annotations

import json
import random
from fractions import Fraction
from typing import cast

import pytest
from forge import beyond, refused, verified
from forge_panels import Document, stopped
from panel_sheets import crossed_stars, ring_of_fives, row_of_stars, two_stars
from test_forged_spaces import certified, leaves_of, spaces_of

from exactfold.checker.core.intervals import Interval
from exactfold.checker.core.reading import LimitError
from exactfold.checker.panels import cones as panel_cones
from exactfold.checker.panels import reduction as panel_reduction
from exactfold.checker.panels import signs as panel_signs
from exactfold.checker.panels.cones import cone_motions
from exactfold.checker.panels.leaves import complete
from exactfold.checker.panels.reduction import BITS, Work, enclosed, reduced, rest_of
from exactfold.checker.panels.signs import Place
from exactfold.checker.panels.spaces import Leaf, Spaces
from exactfold.panels.certificate import certificate_of_panels
from exactfold.panels.decomposition import decompose
from exactfold.pattern.panel_entries import panels_document
from exactfold.pattern.panel_pattern import PanelPattern


def spaces(pattern: PanelPattern) -> Spaces:
    [found] = spaces_of(panels_document(pattern))
    return found


def total(weights: Place, motion: Place) -> Interval:
    """The sum of products of what stands at the same fold."""
    terms = (weights[e] * motion[e] for e in weights.keys() & motion.keys())
    return sum(terms, start=Interval(0, 0, BITS))


@pytest.mark.parametrize("pattern", [two_stars(), row_of_stars()])
def test_the_motion_is_a_regular_zero_of_all_forms(pattern: PanelPattern) -> None:
    found = spaces(pattern)
    [[place, *_]] = cone_motions(found, found.first_order, list(found.near))
    derivatives = []
    for v in found.near:
        slopes = found.gradient(v, place, BITS)
        value = total(slopes, place)
        assert value.low <= 0 <= value.high
        assert value.high - value.low < 1 << 60  # of 2^256
        basis = map(enclosed, found.first_order)
        derivatives.append({(0, k): total(slopes, motion) for k, motion in enumerate(basis)})
    assert len(reduced(derivatives)) == len(found.near)
    space = reduced(map(enclosed, found.first_order))
    assert not any(x.sign() for x in rest_of(place, space).values())


def test_a_ring_is_decided_modulo_a_prime(monkeypatch: pytest.MonkeyPatch) -> None:
    """The ring is decided by signs, too; here these are not looked at."""
    monkeypatch.setattr(panel_cones, "by_signs", lambda *_: [])
    found = spaces(ring_of_fives())
    orders = [0, 1, 2], [2, 1, 0]
    for cones in orders:
        assert len(cone_motions(found, found.first_order, cones)) == 1
    made = certificate_of_panels(decompose(ring_of_fives()))
    verified(made)
    monkeypatch.setattr(panel_cones, "one_component", lambda *_: False)
    for cones in orders:
        assert not cone_motions(found, found.first_order, cones)
    refused(made, "the zeros of the forms of vertices 0, 1, 2 may be other components")


@pytest.mark.slow
def test_both_signs_of_the_discriminant_are_needed(monkeypatch: pytest.MonkeyPatch) -> None:
    """One direction is enough, as with one sign only none of them shows anything."""
    sides = panel_signs._sides
    monkeypatch.setattr(panel_signs, "DIRECTIONS", 1)
    monkeypatch.setattr(panel_signs, "_sides", lambda *args: (sides(*args)[0], False))
    made = certified("joined stars")
    verified(made)  # modulo a prime, both kinds of values are found
    monkeypatch.setattr(panel_cones, "one_component", lambda *_: False)
    refused(made, "the zeros of the forms of vertices 0, 1 may be other components")
    verified(certified("star"))  # one form has rank 3, and needs no sign


class Difference:
    """The form x^2 - y^2 of two densities in place of that of a vertex."""

    work = Work()

    def gradient(self, _: int, motion: Place, __: int) -> Place:
        return {fold: x if fold == (0, 1) else -x for fold, x in motion.items()}


def test_a_discriminant_that_vanishes_is_not_negative() -> None:
    """The discriminant along x is y^2, which is 0 at some of the places and below 0 at none."""
    x, y = ({(0, k): Interval.of(Fraction(1), BITS)} for k in (1, 2))
    zeros, below = panel_signs._sides(cast(Spaces, Difference()), 0, [{}], [y], x, 4)
    assert zeros
    assert not below


def test_zeros_are_real_wherever_the_search_begins(monkeypatch: pytest.MonkeyPatch) -> None:
    found, rng = spaces(ring_of_fives()), random.Random(0)
    size, order = len(found.first_order), [0, 1, 2]
    starts = [[rng.uniform(-1, 1) for _ in range(size)] for _ in range(12)]
    monkeypatch.setattr(panel_cones, "near_zeros", lambda *_: starts)
    rooms = [found.first_order]
    for v in order:
        rows = [[found.form(v, b, m) for m in rooms[-1]] for b in found.first_order]
        rooms.append(found.vanishing(rooms[-1], rows))
    placed = [
        (v, room, found.squares(v, found.first_order))
        for v, room in zip(order, rooms, strict=False)
    ]
    places = list(panel_cones._regular_zeros(found, found.first_order, placed))
    assert 0 < len(places) < len(starts)
    for place in places:
        for v in order:
            value = total(found.gradient(v, place, BITS), place)
            assert value.low <= 0 <= value.high
            assert value.high - value.low < 1 << 60  # of 2^256


def test_a_form_of_rank_two_is_no_cone() -> None:
    """It is a product of two linear forms, although it has both signs."""
    found = spaces(two_stars())
    squares = found.squares(0, found.first_order)
    plane = found.vanishing(found.first_order, [values for _, values in squares[2:]])
    assert len(found.squares(0, plane)) == 2
    assert not cone_motions(found, plane, [0])


def test_number_of_forms(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(panel_cones, "MOST_FORMS", 2)
    verified(certified("joined stars"))
    message = beyond("the vertices whose forms one space has", 3, 2, "CONE_FORMS")
    stopped(certified("row of stars"), message)


@pytest.mark.slow
def test_the_forms_that_are_left_are_compared() -> None:
    made = certified("row of stars")
    for other in ([0, 1], [0, 2, 1], []):
        [leaf] = leaves_of(made)
        leaf["cones"] = other
        refused(made, "the part of vertex 0 has other leaves than those listed")
    made = certified("row of stars")
    leaves_of(made)[0]["dimension"] = 6
    refused(made, "the part of vertex 0 has other leaves than those listed")


@pytest.mark.slow
def test_one_family_is_all_first_order_motions_with_all_forms() -> None:
    found = spaces(two_stars())
    [leaf] = found.leaves()
    assert complete(found, [leaf])
    assert not complete(found, [Leaf(leaf.basis, (0,))])
    assert not complete(found, [Leaf(leaf.basis[1:], (0, 1))])
    made: Document = json.loads(json.dumps(certified("crossed stars")))
    made["claims"]["spaces"][0]["complete"] = True
    stopped(made, "the part of vertex 0 may have other true motions")


def test_too_much_work_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    found = spaces(crossed_stars())
    [first, _] = found.leaves()
    monkeypatch.setattr("exactfold.checker.panels.reduction.MOST_STEPS", found.work.steps)
    with pytest.raises(LimitError, match="the steps to the spaces of motions, "):
        cone_motions(found, first.basis, first.cones)


TWICE = [
    *[(0, 5), (0, 1), (5, 10), (1, 5), (10, 15), (10, 11), (6, 10), (10, 16), (15, 20), (15, 21)],
    *[(1, 6), (1, 2), (1, 7), (6, 11), (6, 7), (11, 16), (11, 12), (16, 21), (16, 17), (20, 21)],
    *[(2, 7), (2, 3), (7, 12), (7, 8), (12, 17), (12, 13), (17, 21), (17, 22), (17, 18), (17, 23)],
    *[(3, 7), (3, 8), (3, 4), (3, 9), (8, 13), (8, 14), (13, 18), (13, 14), (18, 23), (21, 22)],
    *[(22, 23), (4, 9), (9, 14), (14, 18), (14, 19), (19, 23), (19, 24), (23, 24)],
]
"""Creases on a grid of 5 x 5 points."""


@pytest.mark.slow
def test_a_zero_is_taken_at_which_the_folds_fold(monkeypatch: pytest.MonkeyPatch) -> None:
    """At the first zero that is found of the form of vertex 7, some folds stay flat.

    The sheet has families, so that no homotopy looks for isolated ways.
    """

    def fail(*_: object, **__: object) -> None:
        raise AssertionError

    monkeypatch.setattr("exactfold.panels.isolated.homotopy", fail)
    points = [(Fraction(x), Fraction(y)) for y in range(5) for x in range(5)]
    made = json.loads(json.dumps(certificate_of_panels(decompose(PanelPattern(points, TWICE)))))
    verified(made)


@pytest.mark.parametrize("missing", [0, 1])
def test_a_proof_modulo_a_prime_keeps_to_the_limit(
    missing: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    found, other = (spaces(ring_of_fives()) for _ in range(2))
    assert len(cone_motions(found, found.first_order, [0, 1, 2])) == 1
    monkeypatch.setattr(panel_reduction, "MOST_STEPS", found.work.steps - missing)
    if not missing:
        assert len(cone_motions(other, other.first_order, [0, 1, 2])) == 1
        return
    with pytest.raises(LimitError, match=f"motions, {found.work.steps}, are more than the limit"):
        cone_motions(other, other.first_order, [0, 1, 2])
