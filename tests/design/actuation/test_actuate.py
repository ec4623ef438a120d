"""Torques for one branch: what is best, what is proved, and what does not change with the sheet."""

from fractions import Fraction

import driving
import mpmath
import numpy as np
import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st
from sheets import dart, mapped, mirrored, relabelled, rotated

from exactfold import PROVED, REFUTED, UNDECIDED, random_square
from exactfold.branches import count_branches, find_branch
from exactfold.design import Hinges, actuate
from exactfold.errors import (
    FloatRefusedError,
    NotApplicableError,
    NotCountedError,
    UndecidedBranchError,
    UsageError,
)
from exactfold.pattern import degenerate
from exactfold.pattern.families import flat_vertex_square, hypar, single_vertex, two_vertex

few = settings(max_examples=10, deadline=None)
seeds = st.integers(0, 10**6)


def place_of(found, count):
    """Where the branch stands in a count."""
    return count.branches.index(count[found.branch.sign_text])


# --- the best torques, in another way ------------------------------------------------------------


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("inside", [1, 2, 3, 4])
def test_the_margin_is_the_optimum_of_the_dual_program(inside, seed):
    pattern = random_square(inside, seed=seed)
    count = count_branches(pattern)
    units = driving.directions(list(count.branches))
    for signs in ("+-+-"[:inside], "+" * inside):
        found = actuate(pattern, signs)
        best = driving.dual_optimum(driving.gaps(units, place_of(found, count)))
        assert found.status is PROVED
        assert float(found.bound) == pytest.approx(best, abs=1e-6)
        assert float(found.margin[0]) == pytest.approx(best, rel=2e-4)
        assert 0 < found.margin[0] < found.margin[1] < found.bound


@pytest.mark.parametrize(("inside", "seed", "most"), [(1, 1, 1), (1, 2, 2), (2, 1, 2), (2, 3, 3)])
def test_the_choice_of_creases_is_the_best_of_all(inside, seed, most):
    pattern = random_square(inside, seed=seed)
    count = count_branches(pattern)
    found = actuate(pattern, "+" * inside, creases=most)
    rows = driving.gaps(driving.directions(list(count.branches)), place_of(found, count))
    best = driving.best_choice(rows, most)
    assert found.status is PROVED
    assert 0 < len(found.driven) <= most
    assert float(found.margin[0]) == pytest.approx(best, rel=2e-4)
    assert best - 1e-6 <= float(found.bound) <= best * 1.0002


def test_branches_with_wide_bounds_are_sharpened():
    """A sheet with thin triangles, whose roots are known to a millionth only."""
    found = actuate(random_square(6, seed=44), "-+-+-+")
    assert found.margin[0] >= found.bound * Fraction(9998, 10000)
    assert found.margin[1] - found.margin[0] < found.margin[0] / 10**4


def test_with_few_linear_programs_the_bound_is_larger_and_still_a_bound():
    pattern = random_square(4, seed=1)
    short, long = (actuate(pattern, "+-+-", creases=3, nodes=n) for n in (1, 1000))
    assert len(short.driven) <= 3
    assert short.margin[1] <= long.bound < short.bound
    assert long.bound - long.margin[0] < Fraction(1, 10**4)


def test_all_creases_may_be_driven():
    pattern = random_square(2, seed=1)
    every, free = actuate(pattern, "+-", creases=len(pattern.folds)), actuate(pattern, "+-")
    assert (every.torques, every.margin, every.bound) == (free.torques, free.margin, free.bound)


def test_no_torques_on_one_crease_prefer_a_branch_with_many_rivals():
    """Whatever one crease does, it drives some rival harder: the best margin is 0."""
    found = actuate(random_square(4, seed=1), "+-+-", creases=1)
    assert found.status is UNDECIDED
    assert not found.driven
    assert 0 <= found.bound < Fraction(1, 10**6)


# --- the ray that is driven ----------------------------------------------------------------------


@pytest.mark.parametrize(
    "pattern",
    [
        two_vertex(),
        degenerate.notched(2),
        dart(),
        flat_vertex_square(),
        degenerate.waterbomb_pair(),
    ],
    ids=["two-vertex", "notched", "dart", "flat", "waterbombs"],
)
def test_the_ray_is_that_of_the_branch_with_these_signs(pattern):
    for up in ((), pattern.foldable_vertices[:1]):
        found, branch = actuate(pattern, up=up), find_branch(pattern, up=up)
        assert found.branch.sign_text == branch.sign_text
        expected = driving.direction(branch)
        here = found.directions.middles[found.place]
        assert here == pytest.approx([expected[fold] for fold in pattern.folds], abs=1e-6)
        assert found.power[0] > 0
        first = found.ranking()[0]
        assert (first.signs, first.ray, first.above_next) == (branch.sign_text, 1, True)


def test_opposite_torques_drive_the_opposite_ray():
    found = actuate(random_square(3, seed=2), "+-+")
    turned = found.ranking({fold: -torque for fold, torque in found.torques.items()})
    forth = found.ranking()
    assert [(row.signs, -row.ray, row.power) for row in turned] == [
        (row.signs, row.ray, row.power) for row in forth
    ]


# --- the dimension of torques that drive one branch alone ----------------------------------------


def rank_to_sixty_digits(branches):
    """The number of singular values of the heights modulo planes above 1e-40, from 60 digits."""
    with mpmath.workdps(60):
        rows = [
            [mpmath.mpf(str(sympy.N(h, 60))) for h in branch.exact_heights.values()]
            for branch in branches
        ]
        values = mpmath.svd_r(mpmath.matrix(rows), compute_uv=False)
        return sum(value > mpmath.mpf(10) ** -40 for value in values)


@pytest.mark.parametrize(
    ("pattern", "dimension"),
    [
        (single_vertex(4), 1),
        (random_square(1, seed=3), 1),
        (two_vertex(), 0),
        (random_square(2, seed=4), 0),
        (flat_vertex_square(), 1),
        pytest.param(degenerate.gridded_square(), 0, marks=pytest.mark.slow),
        pytest.param(hypar(1), 0, marks=pytest.mark.slow),
    ],
)
def test_the_dimension_is_that_of_sixty_digits(pattern, dimension):
    found = actuate(pattern, up=pattern.foldable_vertices[:1])
    others = list(count_branches(pattern, method="groebner").branches)
    others.remove(next(b for b in others if b.sign_text == found.branch.sign_text))
    size = len(pattern.foldable_vertices) + 1
    assert size - rank_to_sixty_digits(others) == dimension
    assert found.orthogonal_dimension == (dimension, dimension)
    assert len(found.independent) == size - dimension
    assert (found.orthogonal is None) == (dimension == 0)


def test_a_dimension_that_no_argument_settles_stays_open():
    """The four branches of one degree-4 field span 3 of 4 dimensions; no test here proves it."""
    found = actuate(degenerate.bent_off_path(), "+00")
    assert found.orthogonal_dimension == (0, 1)
    assert found.orthogonal is None
    assert found.status is PROVED


def test_orthogonal_torques_do_no_work_on_the_others():
    found = actuate(flat_vertex_square(), "+0")
    assert found.orthogonal.share < Fraction(1, 10**12)
    powers = [row.power[1] for row in found.ranking(found.orthogonal.torques)]
    assert powers[0] > 1
    assert max(powers[1:]) < Fraction(1, 10**12)
    assert max(map(abs, found.orthogonal.torques.values())) <= 1


# --- what does not change with the sheet ---------------------------------------------------------


def bests(pattern):
    """The bounds of all branches of a sheet, and whether all are proved."""
    every = [actuate(pattern, branch.vertex_signs) for branch in count_branches(pattern).branches]
    assert all(found.status is PROVED for found in every)
    return sorted(float(found.bound) for found in every)


@few
@given(seeds, st.integers(1, 2), st.randoms(use_true_random=False))
@pytest.mark.slow
def test_labels_position_size_and_side_do_not_matter(seed, inside, source):
    pattern = random_square(inside, seed=seed)
    order = list(range(len(pattern.vertices)))
    source.shuffle(order)
    expected = bests(pattern)
    for other in (
        relabelled(pattern, order),
        mapped(pattern, mirrored),
        mapped(pattern, rotated),
        mapped(pattern, lambda point: (7 * point[0] + 3, 7 * point[1] - 1)),
    ):
        assert bests(other) == pytest.approx(expected, abs=1e-7)


@few
@given(seeds)
def test_the_mirror_image_has_the_same_torques(seed):
    pattern = random_square(2, seed=seed)
    found, image = actuate(pattern, "+-"), actuate(mapped(pattern, mirrored), "+-")
    assert image.margin[0] <= found.bound
    assert found.margin[0] <= image.bound
    given_there = actuate(mapped(pattern, mirrored), "+-", torques=found.torques)
    assert given_there.margin == pytest.approx(found.margin, abs=1e-7)


# --- judging torques -----------------------------------------------------------------------------


def test_torques_of_a_rival_are_refuted():
    pattern = two_vertex()
    other = actuate(pattern, "++")
    judged = actuate(pattern, "+-", torques=other.torques)
    assert judged.status is REFUTED
    assert judged.margin[1] < 0
    assert judged.given
    assert judged.ranking()[0].signs == "++"


def test_the_fold_angles_of_the_branch_have_a_positive_margin():
    """By Cauchy and Schwarz: unit vectors of different lines."""
    pattern = random_square(4, seed=3)
    branch = find_branch(pattern, "+-+-")
    bends = branch.fold_angles.bends
    torques = {
        fold: Fraction(round(bend / branch.fold_angles.largest * 10**6), 10**6)
        for fold, bend in bends.items()
    }
    judged = actuate(pattern, "+-+-", torques=torques)
    assert judged.status is PROVED
    assert judged.margin[0] <= actuate(pattern, "+-+-").bound


def test_larger_torques_have_a_larger_bound():
    pattern = two_vertex()
    found = actuate(pattern, "+-")
    tenfold = {fold: 10 * torque for fold, torque in found.torques.items()}
    judged = actuate(pattern, "+-", torques=tenfold)
    assert judged.margin[1] <= judged.bound
    assert float(judged.bound) == pytest.approx(10 * float(found.bound), rel=1e-9)
    assert float(judged.margin[0]) == pytest.approx(10 * float(found.margin[0]), rel=1e-9)


def test_folds_that_are_not_named_have_no_torque():
    judged = actuate(two_vertex(), "+-", torques={(0, 4): "-1/3"})
    assert judged.torques[0, 4] == Fraction(-1, 3)
    assert judged.driven == ((0, 4),)


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        ({"creases": 0}, UsageError, "from 1 to 7"),
        ({"creases": 8}, UsageError, "from 1 to 7"),
        ({"creases": 1, "torques": {(0, 4): 1}}, UsageError, "either torques"),
        ({"torques": {(0, 4): 0.5}}, FloatRefusedError, "0.5"),
        ({"torques": {(4, 0): 1}}, UsageError, "not a fold"),
        ({"torques": {}}, UsageError, "all torques are 0"),
        ({"creases": 1, "nodes": 0}, UsageError, "at least one"),
    ],
)
def test_what_is_refused(arguments, error, message):
    with pytest.raises(error, match=message):
        actuate(two_vertex(), "+-", **arguments)


def test_sheets_without_a_list_of_rivals_are_refused():
    with pytest.raises(NotCountedError, match=r"13 vertices can pop: .* 12"):
        actuate(random_square(13, seed=1), "+" * 13)
    with pytest.raises(NotCountedError, match="boundary"):
        actuate("waterbomb", "+")


def test_rivals_that_are_not_proved(monkeypatch):
    from dataclasses import replace

    from exactfold.design.actuation import actuate as drive

    def unproved(pattern, **_):
        return replace(count_branches(pattern), status=UNDECIDED, reason="for a test")

    monkeypatch.setattr(drive, "count_branches", unproved)
    with pytest.raises(UndecidedBranchError, match="for a test"):
        actuate(two_vertex(), "+-")


def test_progress_names_the_stages():
    stages = []
    actuate(two_vertex(), "+-", creases=2, progress=lambda stage, *_: stages.append(stage))
    assert {"fold angles", "torques", "choice of creases", "orthogonal torques"} <= set(stages)


def test_the_same_call_gives_the_same_value():
    one, two = (actuate(random_square(3, seed=1), "+-+", creases=3) for _ in range(2))
    assert one == two
    assert repr(one).startswith("<Actuation of +-+: proved, margin 0.29")


def test_numbers_of_the_object_are_those_of_the_value():
    found = actuate(two_vertex(), "+-", creases=3)
    data = found.to_dict("name")
    assert {fold: Fraction(text) for fold, text in data["torques"].items()} == {
        f"{i}-{j}": torque for (i, j), torque in found.torques.items()
    }
    assert [Fraction(text) for text in data["margin"]] == list(found.margin)
    assert np.all([row["signs"] in found.signs for row in data["ranking"]])
    assert len(data["ranking"]) == 4


@pytest.mark.survey
@pytest.mark.parametrize("inside", range(1, 9))
def test_fifty_random_squares(inside):
    """Proved, within a ten-thousandth of the best, and with no torques for one branch alone."""
    for seed in range(50):
        signs = "".join(np.random.default_rng(seed).choice(["+", "-"], inside))
        found = actuate(random_square(inside, seed=seed), signs)
        assert found.status is PROVED
        assert found.margin[0] >= found.bound * Fraction(9998, 10000)
        dimension = 1 if inside == 1 else 0
        assert found.orthogonal_dimension == (dimension, dimension)
        assert len(found.independent) == inside + 1 - dimension
        assert found.ranking()[0].signs == signs


# --- hinges --------------------------------------------------------------------------------------


def test_springs_by_length_have_the_least_energy_where_the_power_is_largest():
    """Springs of stiffness l_e that rest at t_e: sum l t phi, where sum l phi^2 is 1, in floats."""
    pattern = random_square(2, seed=1)
    found = actuate(pattern, "+-", hinges=Hinges(Fraction(1), Fraction(2)))
    points = np.array([[float(x), float(y)] for x, y in pattern.vertices])
    stiff = np.array([np.linalg.norm(points[j] - points[i]) for i, j in pattern.folds])
    rest = np.array([float(found.torques[fold]) for fold in pattern.folds])
    units = driving.directions(list(count_branches(pattern).branches))
    gains = sorted(abs((stiff * rest) @ u) / np.sqrt(stiff @ u**2) for u in units)
    powers = sorted(float(row.power[0]) for row in found.ranking())
    assert powers == pytest.approx(gains, abs=1e-6)
    assert 0 < float(found.margin[0]) == pytest.approx(gains[-1] - gains[-2], abs=1e-6)
    with pytest.raises(NotApplicableError, match="springs of the same stiffness only"):
        found.certificate()
