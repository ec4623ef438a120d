"""Torques for ways of rigid panels: published verdicts, rivals in floats, proofs, refusals."""

from dataclasses import replace
from fractions import Fraction
from itertools import pairwise

import driving
import numpy as np
import pytest
from mode_vectors import elementary_modes
from panel_sheets import Number, grid, mesh, miura, shifted_columns, tiling

from exactfold import PROVED, REFUTED, UNDECIDED, PanelPattern
from exactfold.design import Hinges, actuate_panels
from exactfold.errors import NotCountedError, UsageError
from exactfold.motion.panels.listing import panel_ways
from exactfold.panels import decompose
from exactfold.pattern.families import single_vertex
from exactfold.pattern.opening import panels


def trapezoids(rows: int, zigzags: int) -> PanelPattern:
    """The "chicken wire": straight rows, and zigzags of which every other one is mirrored."""

    def place(i: int, j: int) -> tuple[Number, Number]:
        return Fraction(4 * i + (-1) ** i * (j % 2)), Fraction(3 * j)

    return grid(zigzags + 1, rows + 1, place)


def verdicts(pattern: PanelPattern) -> dict[int, list[str]]:
    """Whether the ways are self-foldable, by their dimensions."""
    result = decompose(pattern)
    found: dict[int, list[str]] = {}
    for way in panel_ways(result):
        one = actuate_panels(result, way.number)
        found.setdefault(way.dimension, []).append(str(one.self_foldable))
    return found


# --- self-foldable ways: Hull and Tachi, arXiv 1809.04243 ----------------------------------------


@pytest.mark.parametrize("sheet", [miura, trapezoids], ids=["miura", "chicken wire"])
def test_miura_and_chicken_wire_are_not_self_foldable(sheet):
    """They say of both: "no set of driving forces" is guaranteed to fold them in a known way."""
    assert verdicts(sheet(2, 2)) == {1: ["refuted"] * 3, 2: ["proved"]}
    assert verdicts(sheet(1, 2)) == {1: ["refuted"] * 4}


@pytest.mark.slow
def test_larger_miura_sheets_are_not_self_foldable():
    assert verdicts(miura(3, 4)) == {1: ["refuted"] * 15, 3: ["proved"]}
    assert verdicts(trapezoids(3, 3)) == {1: ["refuted"] * 7, 3: ["proved"]}


@pytest.mark.parametrize("sheet", [miura, trapezoids])
def test_one_zigzag_alone_is_self_foldable(sheet):
    """All other ways turn the rows only, and leave the zigzag flat."""
    assert verdicts(sheet(2, 1)) == {1: ["proved"], 2: ["proved"]}


@pytest.mark.parametrize("size", [(1, 1), (2, 2)])
def test_a_tiling_by_a_quadrilateral_and_its_half_turns_is_self_foldable(size):
    """They prove it for tilings by a generic tile that half-turns about its sides map to itself."""
    assert verdicts(tiling(*size)) == {1: ["proved", "proved"]}


def test_two_vertices_of_a_tiling_alone_are_not():
    """Their four ways lie in a space of three dimensions."""
    assert verdicts(tiling(2, 1)) == {1: ["refuted"] * 4}


@pytest.mark.parametrize(
    ("sheet", "ways"),
    [(miura(2, 2), 5), (trapezoids(2, 2), 5), (tiling(2, 2), 2), (tiling(2, 1), 4)],
)
def test_ranks_in_floats_give_the_same_verdicts(sheet, ways):
    modes = np.array(elementary_modes(sheet))
    assert len(modes) == ways
    result = decompose(sheet)
    for way in panel_ways(result):
        if way.dimension == 1:
            found = actuate_panels(result, way.number)
            letters = [found.assignment.get(fold, "F") for fold in sheet.folds]
            signs = np.array([{"M": -1, "V": 1, "F": 0}[letter] for letter in letters])
            bent = np.abs(signs).sum()
            [k] = [
                k for k, u in enumerate(np.sign(modes)) if abs(u @ signs) == bent == np.abs(u).sum()
            ]
            others = np.delete(modes, k, axis=0)
            outside = np.linalg.matrix_rank(modes, 1e-7) > np.linalg.matrix_rank(others, 1e-7)
            assert found.self_foldable is (PROVED if outside else REFUTED)


def test_torques_that_do_work_on_one_way_only():
    result = decompose(tiling(2, 2))
    found = actuate_panels(result, 1)
    assert found.self_foldable is PROVED
    assert found.orthogonal is not None
    assert 0 < found.orthogonal.share < Fraction(1, 10**10)
    judged = actuate_panels(result, 1, torques=found.orthogonal.torques)
    assert judged.largest_rival[1] < judged.power[0] * Fraction(1, 10**10)


# --- the best torques ----------------------------------------------------------------------------


@pytest.mark.parametrize("sheet", [tiling(1, 1), mesh(2, 1, 3)])
def test_the_margin_is_the_optimum_of_the_dual_program(sheet):
    """All ways are isolated, and their fold angles are computed again in floats."""
    units = np.array(elementary_modes(sheet))
    result = decompose(sheet)
    best = sorted(driving.dual_optimum(driving.gaps(units, k)) for k in range(len(units)))
    found = [actuate_panels(result, way.number) for way in panel_ways(result)]
    assert sorted(float(one.bound) for one in found) == pytest.approx(best, abs=1e-6)
    for one in found:
        assert one.status is PROVED
        assert float(one.margin[0]) == pytest.approx(float(one.bound), rel=2e-4)


def test_the_rivals_of_a_family_are_its_rays_with_one_mode_turned():
    """No other way bends the rows alone, so that each row may have the largest torque."""
    found = actuate_panels(decompose(miura(2, 2)), 4)
    assert (found.way.dimension, found.status) == (2, PROVED)
    # Each row has three folds of one length: its unit vector is (1, 1, 1) / sqrt 3.
    assert float(found.bound) == pytest.approx(np.sqrt(6), abs=1e-5)
    assert float(found.power[0]) == pytest.approx(np.sqrt(6), abs=1e-5)


def test_a_family_is_a_rival_with_the_length_of_the_projection():
    result = decompose(miura(2, 2))
    sheet = result.pattern
    modes = elementary_modes(sheet)
    rows = [u for u in modes if (np.abs(u) > 1e-9).sum() == 3]
    found = actuate_panels(result, 1)
    tau = np.array([float(found.torques[fold]) for fold in sheet.folds])
    [family] = [row for row in found.ranking if row.dimension == 2]
    expected = np.linalg.norm([u @ tau for u in rows])
    assert float(family.power[0]) == pytest.approx(expected, abs=1e-9)
    most = max(abs(float(u @ tau)) for u in modes if (np.abs(u) > 1e-9).sum() > 3)
    assert float(found.power[0]) == pytest.approx(most, abs=1e-9)
    assert found.margin[0] > 0


def test_few_creases_and_their_bound():
    result = decompose(tiling(1, 1))
    bounds = [actuate_panels(result, 1, creases=k) for k in (1, 2, 3)]
    assert [len(found.driven) for found in bounds] == [1, 2, 3]
    for few, more in pairwise(bounds):
        assert few.status is PROVED
        assert few.margin[0] <= few.bound
        assert few.bound < more.margin[0]


def test_a_fold_that_is_not_driven_costs_what_is_said():
    result = decompose(tiling(1, 1))
    found = actuate_panels(result, 1)
    fold, bound = next(iter(found.without.items()))
    torques = {**found.torques, fold: Fraction(0)}
    assert actuate_panels(result, 1, torques=torques).margin[1] <= bound < found.margin[0]
    assert list(found.without.values()) == sorted(found.without.values())


def test_given_torques_of_another_way_are_refuted():
    result = decompose(tiling(1, 1))
    other = actuate_panels(result, 2).torques
    found = actuate_panels(result, 1, torques=other)
    assert (found.status, found.given) == (REFUTED, True)
    assert found.ranking[0].number == 2


def test_opposite_rates_drive_the_other_side():
    result = decompose(tiling(1, 1))
    [mode] = panel_ways(result)[0].modes
    found = actuate_panels(result, 1)
    turned = actuate_panels(result, 1, rates={mode.number: -1.0})
    assert turned.bound == found.bound
    assert all(turned.assignment[e] != letter for e, letter in found.assignment.items())
    assert found.ranking[0].side == -turned.ranking[0].side == 1


def test_turning_and_scaling_changes_nothing():
    """The order of the ways may change."""
    sheet = tiling(1, 1)
    c, s = Fraction(9, 5), Fraction(12, 5)
    turned = PanelPattern([(c * x - s * y, s * x + c * y) for x, y in sheet.vertices], sheet.edges)
    bounds = []
    for result in map(decompose, (sheet, turned)):
        found = [actuate_panels(result, number) for number in (1, 2)]
        assert all(one.self_foldable is PROVED for one in found)
        bounds.append(sorted(float(one.bound) for one in found))
    assert bounds[0] == pytest.approx(bounds[1], abs=1e-9)


# --- what is not known ---------------------------------------------------------------------------


def test_rivals_that_are_not_known_are_said():
    partial = replace(decompose(tiling(2, 2)), true=None)
    found = actuate_panels(partial, 1)
    assert (found.status, found.self_foldable) == (UNDECIDED, UNDECIDED)
    assert found.margin[0] > 0
    assert "compared with the 2 ways that are proved to fold" in found.unknown
    assert found.to_dict()["rivals"]["complete"] is False


def test_refuted_stays_refuted_where_other_ways_are_not_known():
    partial = replace(decompose(miura(1, 2)), true=None)
    assert actuate_panels(partial, 1).self_foldable is REFUTED


# --- hinges --------------------------------------------------------------------------------------


def test_torques_in_newton_millimetres():
    result = decompose(miura(1, 1))
    hinges = Hinges(Fraction(1, 2), Fraction(80))
    found = actuate_panels(result, 1, hinges=hinges)
    assert found.springs == "by length"
    lengths = hinges.lengths(result.pattern)
    across = [float(x) for x, _ in result.pattern.vertices]
    scale = 80 / (max(across) - min(across))
    for i, j in result.pattern.folds:
        (ax, ay), (bx, by) = result.pattern.vertices[i], result.pattern.vertices[j]
        assert lengths[i, j] == pytest.approx(scale * np.hypot(float(bx - ax), float(by - ay)))
    table = hinges.table(result.pattern, found.torques, found.assignment).splitlines()
    assert table[0] == "crease,letter,length in mm,rest angle in rad,torque in N mm"
    for line in table[1:]:
        _, _, length, angle, torque = line.split(",")
        assert float(torque) == pytest.approx(float(length) * float(angle) / 2, rel=1e-4)


def test_springs_by_length_have_the_least_energy_where_the_power_is_largest():
    """The energy of springs is minimised on each way, in floats."""
    result = decompose(tiling(1, 1))
    sheet = result.pattern
    found = actuate_panels(result, 1, hinges=Hinges(Fraction(1), Fraction(1)))
    points = np.array([[float(x), float(y)] for x, y in sheet.vertices])
    stiff = np.array([np.linalg.norm(points[j] - points[i]) for i, j in sheet.folds])
    rest = np.array([float(found.torques[fold]) for fold in sheet.folds])
    gains = sorted(abs((stiff * rest) @ u) / np.sqrt(stiff @ u**2) for u in elementary_modes(sheet))
    powers = sorted(float(row.power[0]) for row in found.ranking)
    assert powers == pytest.approx(gains, abs=1e-9)


@pytest.mark.parametrize(("stiffness", "width"), [(0, 1), (-1, 1), (1, 0)])
def test_hinges_that_are_impossible(stiffness, width):
    with pytest.raises(UsageError, match="is impossible: give more than 0"):
        Hinges(Fraction(stiffness), Fraction(width))


# --- refusals ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"creases": 1}, "has 2 degrees of freedom: drive at least 2 creases, not 1"),
        ({"creases": 13}, "from 1 to 12"),
        ({"creases": 2, "torques": {(1, 5): 1}}, "not both"),
        ({"torques": {(1, 5): 0}}, "all torques are 0"),
        ({"nodes": 0}, "at least one linear program"),
    ],
)
def test_wrong_usage(options, message):
    with pytest.raises(UsageError, match=message):
        actuate_panels(decompose(miura(2, 2)), 4, **options)


def test_a_way_that_does_not_truly_fold():

    result = decompose(shifted_columns(1))
    [number] = [w.number for w in panel_ways(result) if w.verdict is REFUTED][:1]
    with pytest.raises(UsageError, match=r"does not truly fold: .*: name a way that truly folds"):
        actuate_panels(result, number)


def test_a_family_in_a_space_of_motions_is_refused():
    result = decompose(panels(single_vertex(5)))
    with pytest.raises(NotCountedError, match="way 1 is a family in a space of motions"):
        actuate_panels(result, 1)
