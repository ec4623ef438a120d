"""The arithmetic of spaces of motions in the checker, against sheets and numbers that are known."""

from __future__ import annotations

import json
import random
from fractions import Fraction

import pytest
from panel_sheets import shifted_columns, tiling
from test_forged_spaces import certified, cone, leaves_of, sheet, spaces_of, triangle

from exactfold.checker import check, load
from exactfold.checker.core.intervals import Interval
from exactfold.checker.core.reading import LimitError
from exactfold.checker.core.towers import Number, Tower
from exactfold.checker.panels import reduction as panel_reduction
from exactfold.checker.panels import spaces as panel_spaces
from exactfold.checker.panels.cones import cone_motions
from exactfold.checker.panels.leaves import _closes, _folds, _independent, _rank, _sum, extends
from exactfold.checker.panels.reduction import BITS, Joined, enclosed, inside, reduced, rest_of
from exactfold.checker.panels.spaces import Motion, Spaces
from exactfold.checker.panels.together import vanish_only_at_zero
from exactfold.panels.certificate import certificate_of_panels
from exactfold.panels.decomposition import decompose
from exactfold.pattern.panel_entries import panels_document
from exactfold.pattern.panel_pattern import PanelPattern

RATIONAL = Tower()


def number(value: int | Fraction) -> Number:
    return RATIONAL.number(Fraction(value))


def spaces(pattern: PanelPattern) -> Spaces:
    [found] = spaces_of(panels_document(pattern))
    return found


def rigid() -> PanelPattern:
    """A hub with five folds in a ring of vertices with four: more conditions than folds."""
    hub_and_ring = [(0, 0), (4, 0), (1, 4), (-3, 2), (-3, -3), (2, -4)]
    outer = [(11, 1), (2, 12), (-10, 7), (-9, -8), (5, -11)]
    ring = [(k, k % 5 + 1) for k in range(1, 6)]
    folds = [(0, k) for k in range(1, 6)] + [(k, k + 5) for k in range(1, 6)]
    return sheet([*hub_and_ring, *outer], [*folds, *((min(e), max(e)) for e in ring)], 6)


def half_crossed() -> PanelPattern:
    """Two straight creases that cross; one ends in a vertex with six folds, one at the boundary."""
    points = [(0, 0), (6, 0), (2, -5), (6, -5), (12, 0), (6, 5), (2, 5), (-3, 4), (-5, 0), (-3, -4)]
    folds = [(0, 1), (1, 4), (1, 3), (1, 5), (0, 2), (0, 6), (0, 7), (0, 8), (0, 9)]
    return sheet(points, folds, 2)


# --- linear algebra ------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", range(6))
def test_what_is_left_where_functions_vanish(seed: int) -> None:
    """Five parameters, functions of which some depend on those before or are 0."""
    rng = random.Random(seed)
    found = spaces(cone())
    basis: list[Motion] = [{(0, k): number(1)} for k in range(1, 6)]
    rows = [[number(rng.randint(-2, 2)) for _ in basis] for _ in range(3)]
    twice = [a + a + b for a, b in zip(rows[0], rows[1], strict=True)]
    todo = [rows[0], [number(0)] * 5, rows[1], twice, rows[2]]
    left = found.vanishing(basis, todo)
    for motion in left:
        for row in todo:
            terms = (row[k - 1] * x for (_, k), x in motion.items())
            assert sum(terms, start=number(0)).sign() == 0
    independent = reduced([dict(enumerate(row)) for row in rows])  # type: ignore[arg-type]
    assert len(reduced(left)) == len(left) == 5 - len(independent)


def test_groups_of_folds_meet_at_inner_vertices_only() -> None:
    found = spaces(half_crossed())
    one = number(1)
    at_border: list[Motion] = [{(0, 2): one}, {(1, 3): one}]
    assert len(found.parts(at_border)) == 2
    assert len(found.parts([{(0, 1): one, (0, 2): one}, {(1, 4): one}])) == 1
    assert found.parts([]) == []
    three: list[Motion] = [{(0, 2): one, (1, 3): one}, {(1, 3): one}]
    assert sorted(map(len, found.parts(three))) == [1, 1]


def test_numbers_of_towers_taken_to_one() -> None:
    two, root = RATIONAL.adjoined(number(2))
    first, nested = two.adjoined(two.number(2) + root)
    _, other = two.adjoined(two.number(5) - root - root)
    third, seven = first.adjoined(first.number(7))
    joined = Joined()
    values = [root, nested * root + nested, other, seven * nested - seven, number(3)]
    for value in values:
        taken = joined.of(value)
        assert (taken.enclosed(200) - value.enclosed(200)).sign() == 0
        assert taken.enclosed(200).high - taken.enclosed(200).low < 1 << 30
    assert third.size == 8
    assert joined.tower.size == 16


def test_rests_of_intervals_and_of_numbers() -> None:
    vectors: list[Motion] = [{(0, 1): number(2), (0, 2): number(3)}, {(0, 2): number(5)}]
    rows = reduced(vectors)
    assert rest_of({(0, 1): number(4), (0, 2): number(1)}, rows) == {}
    rest = rest_of(
        enclosed({(0, 1): number(4), (0, 3): number(1)}), reduced(map(enclosed, vectors))
    )
    assert {fold for fold, value in rest.items() if value.sign()} == {(0, 3)}
    assert reduced([{}, vectors[0], vectors[0]]) == rows[:1]
    assert inside([], vectors)


# --- forms of vertices ---------------------------------------------------------------------------


def test_the_other_factor_is_found_only_for_factors() -> None:
    """The form (x + 2y)^2 - (y + z)^2 = (x + y - z)(x + 3y + z), on x, y, z and one more."""
    found = spaces(cone())

    def row(*values: int) -> list[Number]:
        return [number(x) for x in values]

    form = [(number(1), row(1, 2, 0, 0)), (number(-1), row(0, 1, 1, 0))]
    one, other = row(1, 1, -1, 0), row(1, 3, 1, 0)

    def parts(values: list[Number] | None) -> list[int] | None:
        return None if values is None else [int(x.parts[0]) for x in values]

    assert parts(found.other_factor(form, one)) == parts(other)
    assert parts(found.other_factor(form, other)) == parts(one)
    assert parts(found.other_factor(form, row(3, 3, -3, 0))) == [3, 9, 3, 0]
    for wrong in (
        row(1, 1, -1, 1),  # the fourth parameter is in neither square
        row(0, 1, -1, 0),  # the first is in one square only, and so in both factors
        row(1, 2, 0, 0),  # a square, and no factor
        row(1, 4, 2, 0),  # a sum of multiples of the squares that is no factor
        row(1, 1, -2, 0),  # a factor but for one parameter
    ):
        assert found.other_factor(form, wrong) is None
    swapped = [(number(1), row(0, 1, 1, 0)), (number(-1), row(1, 2, 0, 0))]
    assert parts(found.other_factor(swapped, one)) in ([1, 3, 1, 0], [-1, -3, -1, 0])


@pytest.mark.parametrize("pattern", [cone(), triangle(), half_crossed()])
def test_squares_of_a_vertex_on_all_its_motions_and_on_some(pattern: PanelPattern) -> None:
    """A form is the sum of its squares, whether the space has all local motions or not."""
    found = spaces(pattern)
    some = found.first_order
    cones = set()
    while some:
        for v in found.near:
            squares = found.squares(v, some)
            for k, a in enumerate(some):
                for j, b in enumerate(some):
                    terms = (d * row[k] * row[j] for d, row in squares)
                    value = sum(terms, start=number(0))
                    assert (value - found.form(v, a, b)).sign() == 0
            if found.is_cone(v, some):
                cones.add((v, len(some)))
                signs = sorted(d.sign() for d, _ in squares)
                assert len(squares) == len(found.near[v]) - 2
                assert signs in ([-1] * (len(signs) - 1) + [1], [-1] + [1] * (len(signs) - 1))
        some = found.vanishing(some, [[number(k + 1) for k in range(len(some))]])
    large = {v for v, around in found.near.items() if len(around) > 4}

    assert not any(size < len(found.near[v]) - 2 for v, size in cones)
    assert {v for v, _ in cones} == large


# --- sheets --------------------------------------------------------------------------------------


def test_the_point_of_a_cone_is_on_it() -> None:
    for pattern, at in ((cone(), 4), (half_crossed(), 0)):
        found = spaces(pattern)
        for leaf in found.leaves():
            [part] = [part for part in found.parts(leaf.basis) if len(part) > 1]
            plain, place = _sum(found, part), cone_motions(found, part, [at])[0][0]
            assert place is not None
            assert found.form(at, plain, plain).sign() != 0
            assert inside([plain], part)
            slopes = found.gradient(at, place, BITS)
            terms = (slopes[e] * place[e] for e in slopes.keys() & place.keys())
            value = sum(terms, start=Interval(0, 0, BITS))
            assert value.low <= 0 <= value.high
            assert value.high - value.low < 1 << 40  # of 2^256
            assert any(weight.sign() for weight in slopes.values())
            rows = reduced(map(enclosed, part))
            assert not any(x.sign() for x in rest_of(place, rows).values())
            positive = [motion for motion in part if found.form(at, motion, motion).sign() > 0]
            assert not cone_motions(found, positive[:1], [at])  # of rank 1


def test_a_cone_beside_a_line() -> None:
    result = decompose(half_crossed())
    document = certificate_of_panels(result)
    claims = check(load(json.dumps(document)))
    assert claims["second_order"] == {"3": 2}
    kinds = [
        (leaf["dimension"], tuple(leaf["cones"]), len(leaf["folds"]))
        for leaf in leaves_of(document)
    ]
    assert sorted(kinds) == [(3, (0,), 7), (3, (0,), 7)]


def test_rigid_parts_have_no_leaves() -> None:
    result = decompose(rigid())
    assert result.second_order == {0: 1}
    document = certificate_of_panels(result)
    assert leaves_of(document) == []
    claims = check(load(json.dumps(document)))
    assert (claims["second_order"], claims["rigid"]) == ({"0": 1}, "proved")


def test_bounds_are_kept_at_their_last_value(monkeypatch: pytest.MonkeyPatch) -> None:
    found = spaces(triangle())
    assert len(found.leaves()) == 8
    used = found.work.steps
    monkeypatch.setattr(panel_spaces, "MOST_LEAVES", 8)
    monkeypatch.setattr(panel_reduction, "MOST_STEPS", used)
    assert len(spaces(triangle()).leaves()) == 8
    monkeypatch.setattr(panel_reduction, "MOST_STEPS", used - 1)
    other = spaces(triangle())
    assert len(other.leaves()) == 8  # in the other order, which is quicker here
    least = other.work.steps
    assert least < used
    monkeypatch.setattr(panel_reduction, "MOST_STEPS", least - 1)
    with pytest.raises(LimitError, match=f"steps to the spaces of motions, {least}, are more than"):
        spaces(triangle()).leaves()
    monkeypatch.setattr(panel_reduction, "MOST_STEPS", used)
    monkeypatch.setattr(panel_spaces, "MOST_LEAVES", 7)
    with pytest.raises(LimitError, match="the spaces of motions, 8, are more than the limit, 7"):
        spaces(triangle()).leaves()
    monkeypatch.setattr(panel_reduction, "MOST_ROOTS", 1)
    two, root = RATIONAL.adjoined(number(2))
    assert Joined().of(root).tower.size == 2
    with pytest.raises(LimitError, match="the square roots that two spaces need, 2, are more"):
        Joined().of(two.adjoined(two.number(3))[1])


# --- what truly folds ----------------------------------------------------------------------------


def test_conditions_that_depend_on_each_other_prove_nothing() -> None:
    """Six lines: at two of them the forms have dependent derivatives, but as modes they fold."""
    found = spaces(triangle((15, 0)))
    shown = []
    for leaf in found.leaves():
        [motion] = leaf.basis
        near = {
            v: [u for u in around if (min(u, v), max(u, v)) in motion]
            for v, around in found.near.items()
        }
        inner = Spaces(found.sheet, {v: around for v, around in near.items() if around})
        shown.append(
            (
                _rank(found, enclosed(motion)),
                _independent(inner, enclosed(motion)),
                extends(found, leaf),
            )
        )
    assert sorted(shown)[0][0] < 3 == sorted(shown)[-1][0]
    assert all(folds for *_, folds in shown)


def test_what_is_not_shown_to_fold() -> None:
    """A cone whose form is not that of the vertex named."""
    found = spaces(cone())
    [leaf] = found.leaves()
    [part] = found.parts(leaf.basis)
    assert leaf.cones == (4,)
    assert _folds(found, part, [4])
    assert not _folds(found, part, [0])  # its form vanishes, and that of 4 does not


def test_conditions_of_first_order_that_depend_on_each_other() -> None:
    """A ring round a hub can turn if its outer creases go on along the spokes."""
    ring = [(4, 0), (1, 4), (-3, 2), (-3, -3), (2, -4)]
    points = [(0, 0), *ring, *((3 * x, 3 * y) for x, y in ring)]
    folds = [(0, k) for k in range(1, 6)] + [(k, k + 5) for k in range(1, 6)]
    folds += [(1, 2), (2, 3), (3, 4), (4, 5), (1, 5)]
    found = spaces(sheet(points, folds, 6))
    assert len(found.first_order) == 15 - 2 * 6 + 1
    assert not _independent(found, enclosed(found.first_order[0]))
    turning = _sum(found, found.first_order)
    assert len(turning) == 15
    assert not _folds(found, [turning], [])  # five folds at the hub make no mode
    # Three folds that are no straight pair have no motions, and are not counted on.
    [star] = spaces_of(certified("star")["pattern"])
    three = Spaces(star.sheet, {6: star.near[6][::2]})
    assert len(three.first_order) == 1
    assert not _independent(three, enclosed(three.first_order[0]))


@pytest.mark.parametrize(("pattern", "folds"), [(tiling(2, 2), True), (shifted_columns(1), False)])
def test_a_part_with_two_parameters_is_no_mode(pattern: PanelPattern, folds: bool) -> None:
    """Modes of four vertices with dependent forms: those that fold do so as modes alone."""
    found = spaces(pattern)
    whole = [leaf.basis for leaf in found.leaves() if len(leaf.folds) == 12]
    assert whole
    for [motion] in whole:
        twice = {fold: x + x for fold, x in motion.items()}
        assert not _independent(found, enclosed(motion))
        assert not _folds(found, [motion, twice], [])
        assert _folds(found, [motion], []) is folds


def test_a_motion_that_is_no_mode_does_not_close() -> None:
    found = spaces(tiling(2, 2))
    [motion] = next(leaf.basis for leaf in found.leaves() if len(leaf.folds) == 12)
    fold = min(motion)
    assert _closes(found.sheet, found.near, motion)
    assert not _closes(found.sheet, found.near, {**motion, fold: motion[fold] + motion[fold]})


def test_spaces_that_are_no_sums_are_one_part() -> None:
    found = spaces(half_crossed())
    one = number(1)
    joined = [{(0, 2): one, (1, 3): one}]
    assert found.parts(joined) == [joined]
    assert len(found.parts([{(0, 2): one}, {(1, 3): one}])) == 2


def test_squares_have_the_values_of_the_form_also_where_motions_leave_a_vertex_flat() -> None:
    found = spaces(tiling(2, 2))
    space = found.first_order
    for v, around in found.near.items():
        squares = found.squares(v, space)
        assert all(len(values) == len(space) for _, values in squares)
        for k, one in enumerate(space):
            for j, other in enumerate(space):
                total = number(0)
                for d, values in squares:
                    total = total + d * values[k] * values[j]
                assert not (total - found.form(v, one, other)).sign()
        touching = {
            k for k, m in enumerate(space) if any((min(v, u), max(v, u)) in m for u in around)
        }
        assert {k for _, values in squares for k, x in enumerate(values) if x.sign()} <= touching


def test_a_vertex_with_settled_neighbours_is_split_first() -> None:
    found = spaces(tiling(2, 2))
    _, products, _, settled = found._forms(found.first_order)
    assert (sorted(products), settled) == (sorted(found.near), frozenset())
    for v, around in found.near.items():
        neighbours = {u for u in around if u in found.near}
        left = {u: squares for u, squares in products.items() if u != v}
        assert found.factors(left, found.first_order, frozenset({v}))[0] in neighbours


def test_of_equally_near_vertices_one_without_a_new_root_is_split_first() -> None:
    found = spaces(tiling(2, 2))
    _, products, _, _ = found._forms(found.first_order)

    def chosen(plain: set[int], settled: frozenset[int]) -> int:
        """The choice if the forms of these vertices need no root, and all others sqrt 2."""
        given = {
            v: [(number(1), one), (number(-1 if v in plain else -2), other)]
            for v, ((_, one), (_, other)) in products.items()
            if v not in settled
        }
        return found.factors(given, found.first_order, settled)[0]

    for v, around in found.near.items():
        far = products.keys() - {v, *around}
        assert far
        found.avoids_roots = False
        assert chosen({v}, frozenset()) == v
        assert chosen(far, frozenset({v})) in around
        found.avoids_roots = True
        assert chosen(far, frozenset({v})) in far


def test_forms_that_vanish_only_at_zero_leave_zero() -> None:
    found = spaces(half_crossed())
    values = {0: (1, -1), 1: (1, -2), 2: (3, -5)}
    rows = [number(1), number(0)], [number(0), number(1)]
    forms = {
        v: [(number(d), row) for d, row in zip(pair, rows, strict=True)]
        for v, pair in values.items()
    }
    assert vanish_only_at_zero(found.work, forms, 2)
    assert not vanish_only_at_zero(found.work, {0: forms[0], 2: forms[0]}, 2)
    assert not vanish_only_at_zero(found.work, {0: forms[0]}, 2)
    assert not vanish_only_at_zero(found.work, forms, 1)


def test_what_follows_the_search_has_the_steps_that_are_left() -> None:
    found = spaces(half_crossed())
    found.leaves()
    found.work.count(panel_reduction.MOST_STEPS - found.work.steps, number(1))
    with pytest.raises(LimitError, match="the steps to the spaces of motions"):
        found.work.count(1, number(1))
