"""Components found one by one: real ones, different ones, and none that are not."""

import io
from collections import Counter
from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction

import pytest
from flint import arb, fmpq
from panel_sheets import mesh, miura, outlined, shifted_columns, tiling
from rich.console import Console

from exactfold._support.verdict import REFUTED, UNDECIDED
from exactfold.app.report.panels import panels_answer, panels_report
from exactfold.panels.decomposition import decompose
from exactfold.panels.result import Decomposition
from exactfold.panels.spaces.found import FoundComponent, found_components
from exactfold.panels.spaces.kernel import Rows, first_order, imposed
from exactfold.panels.spaces.quadratics import factors, squares_of
from exactfold.panels.spaces.regular import (
    Forms,
    in_balls,
    is_component,
    outside,
    parameter_folds,
    rank_at_least,
    regular_point,
    truly_folds,
)
from exactfold.panels.spaces.splitting import leaves
from exactfold.panels.spaces.subspaces import Leaf, made_leaf, reduced
from exactfold.panels.vertex.stars import Star, stars
from exactfold.pattern.panel_pattern import Edge, PanelPattern


def triangulated(columns: int, rows: int) -> PanelPattern:
    """A mesh whose quadrilaterals are cut by their diagonals: all vertices have six folds."""
    plain = mesh(columns, rows, seed=columns + 10 * rows)
    up = rows + 2
    diagonals = [
        (i * up + j, (i + 1) * up + j + 1) for i in range(columns + 1) for j in range(up - 1)
    ]
    return PanelPattern(plain.vertices, [*plain.edges, *diagonals])


def printed(result: Decomposition) -> str:
    console = Console(file=io.StringIO(), width=1000)
    console.print(panels_report(result, None, everything=False))
    text = console.file.getvalue()  # type: ignore[attr-defined]
    return str(text)


def found_in(pattern: PanelPattern) -> list[FoundComponent]:
    moving = stars(pattern)
    rows, size, _ = reduced(moving, *first_order(moving), 10**6)
    return found_components(moving, rows, size, 10**7, lambda leaf: False)[0]


@pytest.mark.parametrize(
    ("pattern", "known"),
    [
        (miura(2, 2), {1: 3, 2: 1}),
        (miura(3, 2), {1: 3, 3: 1}),
        (tiling(2, 2), {1: 2}),
        (mesh(1, 4, seed=3), {1: 16}),
    ],
)
def test_all_components_of_small_sheets_are_found(
    pattern: PanelPattern, known: dict[int, int]
) -> None:
    assert decompose(pattern).second_order == known
    assert Counter(one.dimension for one in found_in(pattern)) == known


@pytest.mark.usefixtures("without_spaces")
@pytest.mark.parametrize("size", [3, 5])
def test_a_large_triangulated_mesh_has_a_component_that_truly_folds(size: int) -> None:
    pattern = triangulated(size, size)
    result = decompose(pattern)
    assert result.second_order is None
    assert result.status is UNDECIDED
    assert result.found == result.found_true == {pattern.D: 1}
    assert result.parts[0].dimension == len(pattern.folds) - 2 * size**2 - len(result.free)
    assert result.rigid is REFUTED


@pytest.mark.usefixtures("without_spaces")
def test_the_report_says_what_was_found() -> None:
    text = printed(decompose(triangulated(4, 4)))
    assert "found to second order: at least 1 family of ways to start to fold, of dimension" in text
    assert "known to fold truly: at least 1 family of ways to fold, of dimension" in text
    assert "the part of 16 vertices with vertex 7: splitting its spaces of motions" in text


@pytest.mark.parametrize("shift", [-3, 1, 2])
def test_no_motion_that_fails_at_a_higher_order_is_said_to_fold(shift: int) -> None:
    pattern = shifted_columns(shift)
    known = decompose(pattern)
    assert known.true is not None
    assert known.true != known.second_order
    folding = Counter(one.dimension for one in found_in(pattern) if one.folds)
    assert all(number <= known.true.get(d, 0) for d, number in folding.items())


def _whole(pattern: PanelPattern) -> tuple[Mapping[int, Star], Rows, int, list[Leaf]]:
    moving = stars(pattern)
    rows, size = first_order(moving)
    return moving, rows, size, leaves(moving, rows, size, 10**6)


def _point(leaf: Leaf) -> dict[Edge, float]:
    """Densities with 1, 2, 3... for the parameters, for leaves without forms."""
    folds = parameter_folds(leaf.rows, leaf.size)
    return {edge: float(k + 1) for k, edge in enumerate(folds)}


def test_a_line_in_a_plane_of_motions_is_no_component() -> None:
    moving, rows, size, found = _whole(miura(2, 2))
    forms, whole = Forms(moving), in_balls(rows)
    [plane] = [leaf for leaf in found if leaf.size == 2]
    w = regular_point(forms, plane, _point(plane))
    assert w is not None
    assert is_component(forms, whole, size, w, 2)
    assert not is_component(forms, whole, size, w, 1)
    assert all(
        is_component(forms, whole, size, w, 1)
        for leaf in found
        if leaf.size == 1
        if (w := regular_point(forms, leaf, _point(leaf))) is not None
    )


def test_a_point_where_components_cross_is_on_no_single_one() -> None:
    moving, rows, size, found = _whole(mesh(1, 2, seed=4))
    forms, whole = Forms(moving), in_balls(rows)
    origin = {edge: arb(0) for edge in rows}
    assert len(found) == 4
    assert not is_component(forms, whole, size, origin, 1)
    assert not truly_folds(moving, origin)


def test_points_are_outside_other_components_and_not_their_own() -> None:
    moving, _, _, found = _whole(mesh(1, 3, seed=9))
    forms = Forms(moving)
    points = [regular_point(forms, leaf, _point(leaf)) for leaf in found]
    for i, w in enumerate(points):
        assert w is not None
        assert [outside(w, leaf) for leaf in found] == [i != k for k in range(len(found))]


def test_a_zero_of_the_forms_is_enclosed_only_near_one() -> None:
    pattern = triangulated(2, 2)
    moving, rows, size, _ = *_whole_space(pattern), None
    forms = Forms(moving)
    leaf = made_leaf(rows, size, sorted(moving))
    [one] = found_in(pattern)
    near = {edge: float(x.mid()) for edge, x in one.motion.items()}
    w = regular_point(forms, leaf, near)
    assert w is not None
    assert all(forms.value(v, w).contains(0) for v in moving)
    far = {edge: x + 0.01 * (k % 3) for k, (edge, x) in enumerate(near.items())}
    assert regular_point(forms, leaf, far) is None


def _whole_space(pattern: PanelPattern) -> tuple[Mapping[int, Star], Rows, int]:
    moving = stars(pattern)
    return (moving, *first_order(moving))


def test_a_rank_is_never_said_to_be_larger() -> None:
    one = arb(1)
    assert rank_at_least([[one, one], [one, 2 * one]], 2)
    assert not rank_at_least([[one, one], [one, one]], 2)
    assert not rank_at_least([[one, one], [one, arb(1, 1e-30)]], 2)
    assert not rank_at_least([[one, one]], 2)


def test_a_definite_form_leaves_nothing_and_a_motion_stays() -> None:
    moving, rows, size = _whole_space(mesh(1, 1, seed=6))
    assert size == 2
    line = imposed(rows, size, [fmpq(1), fmpq(7)])
    assert reduced(moving, *line, 10**6) == ({}, 0, False)
    [star] = moving.values()
    motion, _ = factors([squares_of(star, rows, size)], rows)
    kept, left, _ = reduced(moving, *imposed(rows, size, motion), 10**6)
    assert left == 1
    assert set(kept) == set(star.folds)


def test_all_fold_and_others_are_excluded_to_second_order_only() -> None:
    """Six lines fold, two of which are double: a second true curve might be tangent to these."""
    points = [(0, 0), (8, 0), (3, 7), (-5, 2), (-6, -3), (-1, -6), (8, -7), (15, 0), (5, 8)]
    points.append((-2, 14))
    folds = [(0, 1), (1, 2), (0, 2), (0, 3), (0, 4), (0, 5), (1, 6), (1, 7), (2, 8), (2, 9)]
    sheet = outlined([(Fraction(x), Fraction(y)) for x, y in points], folds, 3)
    result = decompose(sheet)
    assert (result.second_order, result.true) == ({1: 6}, None)
    assert result.found_true == {1: 6}
    assert result.parts[0].spaces_fold == (True,) * 6
    said = str(panels_answer(replace(result, seconds=0.01)))
    assert said == (
        "6 ways to fold - PROVED (0.01 s); each truly folds; it is proved only to second order "
        "that there are no others"
    )
