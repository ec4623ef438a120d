"""Sums of forms that split a space, and forms that vanish together only at 0."""

from __future__ import annotations

import itertools
import shutil
from collections.abc import Mapping
from fractions import Fraction
from functools import cache

import numpy as np
import pytest
from flint import fmpq
from forge import verified
from panel_sheets import ring
from test_oracles import by_singular, degrees

from exactfold._support.clock import Clock
from exactfold._support.verdict import PROVED
from exactfold.checker.core.reading import CertificateError
from exactfold.checker.panels import certificate as checked
from exactfold.checker.panels import spaces as checked_spaces
from exactfold.checker.panels import together as checked_sums
from exactfold.checker.panels.proposed import definite_weights
from exactfold.checker.panels.reduction import Work
from exactfold.checker.panels.spaces import Spaces
from exactfold.errors import TooManyModesError
from exactfold.panels.certificate import certificate_of_panels
from exactfold.panels.decomposition import decompose
from exactfold.panels.result import Decomposition
from exactfold.panels.spaces import splitting
from exactfold.panels.spaces.kernel import first_order
from exactfold.panels.spaces.sparse import Form
from exactfold.panels.spaces.together import independent, narrowing_sum, vanish_only_at_zero
from exactfold.panels.vertex.stars import stars
from exactfold.pattern.panel_pattern import PanelPattern

SQUARES = [
    *[(0, 5), (0, 1), (5, 10), (5, 6), (10, 15), (10, 11), (15, 20), (15, 16), (20, 21), (1, 6)],
    *[(1, 2), (6, 11), (6, 7), (6, 12), (11, 16), (11, 12), (16, 21), (16, 17), (21, 22), (2, 7)],
    *[(2, 3), (7, 12), (7, 8), (7, 13), (12, 17), (12, 13), (17, 22), (17, 18), (22, 23), (3, 8)],
    *[(3, 4), (3, 9), (8, 13), (8, 9), (13, 18), (13, 14), (18, 23), (18, 19), (23, 24), (4, 9)],
    *[(9, 14), (14, 18), (14, 19), (19, 23), (19, 24)],
]
TURNED = [
    *[(0, 5), (0, 1), (5, 10), (10, 15), (10, 11), (10, 16), (15, 20), (20, 21), (1, 6), (1, 2)],
    *[(1, 7), (6, 10), (11, 16), (11, 12), (11, 17), (16, 21), (21, 22), (2, 7), (2, 3), (2, 8)],
    *[(7, 12), (7, 13), (12, 17), (12, 13), (12, 18), (17, 21), (17, 22), (17, 18), (22, 23)],
    *[(3, 8), (3, 4), (8, 13), (8, 9), (8, 14), (13, 18), (13, 19), (18, 23), (18, 19), (23, 24)],
    *[(4, 8), (4, 9), (9, 14), (14, 19), (19, 24)],
]
DEPENDENT = [
    *[(0, 1), (0, 5), (1, 2), (1, 6), (2, 3), (2, 6), (2, 7), (2, 8), (3, 4), (3, 8)],
    *[(4, 9), (5, 6), (5, 10), (5, 11), (6, 7), (6, 11), (7, 8), (8, 9), (8, 13), (9, 13)],
    *[
        (9, 14),
        (10, 15),
        (11, 12),
        (11, 16),
        (11, 17),
        (12, 13),
        (13, 17),
        (13, 18),
        (14, 19),
        (15, 16),
    ],
    *[
        (15, 20),
        (16, 20),
        (16, 21),
        (17, 22),
        (18, 19),
        (18, 23),
        (18, 24),
        (19, 24),
        (20, 21),
        (21, 22),
    ],
    *[(22, 23), (23, 24)],
]
SHEETS = {
    "squares": (SQUARES, {3: 8, 4: 2, 5: 3}),
    "turned": (TURNED, {2: 1, 3: 4, 4: 2}),
    "dependent": (DEPENDENT, {2: 2, 3: 1}),
}
"""Creases on a grid of 5 x 5 points, and the numbers of components by dimension."""


REAL = {
    "squares": {3: 3, 2: 4, 1: 8},
    "turned": {4: 6, 3: 8, 2: 1},
    "dependent": {3: 4, 2: 4},
}
"""The sums of the degrees of these components by dimension, free folds apart."""


@cache
def counted(name: str) -> Decomposition:
    points = [(Fraction(x), Fraction(y)) for y in range(5) for x in range(5)]
    return decompose(PanelPattern(points, SHEETS[name][0]))


@pytest.mark.parametrize("name", SHEETS)
def test_a_sum_of_forms_splits_a_space(name: str) -> None:
    result = counted(name)
    assert result.status is PROVED
    assert result.second_order == SHEETS[name][1]


@pytest.mark.parametrize("name", ["squares", "turned"])
def test_the_checker_splits_the_same_spaces(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    made = certificate_of_panels(counted(name))
    verified(made)
    monkeypatch.setattr(checked_spaces, "narrowing_sum", lambda *_: [])
    with pytest.raises(CertificateError, match="may be other components"):
        checked.PANELS.check(made)


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("Singular") is None, reason="Singular is not installed")
@pytest.mark.parametrize(
    ("name", "over_q"),
    [
        ("squares", {3: 3, 2: 4, 1: 8}),
        ("turned", {4: 6, 3: 8 + 2}),
        ("dependent", {3: 4, 2: 4}),
    ],
)
def test_singular_finds_the_same_components(name: str, over_q: dict[int, int]) -> None:
    """A sum of two squares is a pair of planes that are not real, and meet in a real one of one
    dimension less.
    """
    pattern = counted(name).pattern
    assert by_singular(pattern) == over_q
    assert degrees(pattern) == REAL[name]


def test_without_sums_the_sheet_is_not_decided(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(splitting, "narrowing_sum", lambda *_: None)
    assert decompose(counted("squares").pattern).second_order is None


def test_a_form_that_others_determine_is_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two forms that are multiples of each other leave one cone, of one dimension less."""
    made = certificate_of_panels(counted("dependent"))
    verified(made)
    assert [leaf.vertices for leaf in counted("dependent").parts[0].spaces if leaf.size == 3] == [
        (6,),
        (6,),
    ]
    monkeypatch.setattr(Spaces, "_independent", lambda _, forms: tuple(forms))
    with pytest.raises(CertificateError, match="may be other components"):
        checked.PANELS.check(made)
    monkeypatch.setattr(splitting, "independent", lambda _, vertices, clock: vertices)
    assert decompose(counted("dependent").pattern).second_order is None


def test_the_clock_ends_the_search_for_forms_that_others_determine() -> None:
    with pytest.raises(TooManyModesError, match="0 seconds"):
        independent({1: ONE}, [1], Clock(0))


def squares(*rows: tuple[int, Mapping[int, int]]) -> Form:
    return [(fmpq(d), {k: fmpq(x) for k, x in row.items()}) for d, row in rows]


ONE = squares((1, {0: 1}), (-1, {1: 1}), (-1, {2: 1}))


@pytest.mark.parametrize(
    ("other", "inertia"),
    [
        (squares((-1, {0: 1}), (2, {1: 1}), (2, {2: 1})), [1, 1]),  # the sum is definite
        (squares((1, {0: 1}), (-2, {1: 1}), (-2, {2: 1})), [1, 1]),  # the difference is
        (squares((1, {0: 1}), (-1, {1: 1}), (-2, {3: 1})), [1, -1]),  # the difference splits
        (squares((1, {0: 1}), (-3, {1: 1}), (-2, {3: 1})), None),
        (ONE, None),  # the difference is 0
    ],
)
def test_which_sum_is_taken(other: Form, inertia: list[int] | None) -> None:
    found = narrowing_sum({3: ONE, 5: other}, [3, 5])
    signs = None if found is None else sorted((1 if d > 0 else -1 for d, _ in found), reverse=True)
    assert signs == inertia


def test_one_form_or_five_are_not_summed() -> None:
    definite = squares((-1, {0: 1}), (2, {1: 1}), (2, {2: 1}))
    assert narrowing_sum({0: ONE}, [0]) is None
    assert narrowing_sum({0: ONE, 1: definite}, [0, 1]) is not None
    five = {k: definite if k else ONE for k in range(5)}
    assert narrowing_sum(five, list(five)) is None


def test_forms_that_vanish_only_at_zero() -> None:
    cones = {
        0: ONE,
        1: squares((1, {1: 1}), (-1, {0: 1}), (-1, {2: 1})),
        2: squares((1, {0: 1}), (2, {1: 1}), (-5, {2: 1})),
    }
    assert vanish_only_at_zero(cones, [0, 1, 2], 3)
    assert not vanish_only_at_zero(cones, [0, 1], 3)
    assert not vanish_only_at_zero(cones, [0, 1, 2], 4)


def test_weights_for_which_a_sum_is_definite() -> None:
    """Two rays of weights bound those that are wanted; the forms have skew coordinates."""
    narrow = [
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1e-8]],
        [[-0.9, 0, 0], [0, -0.9, 0], [0, 0, 1e-8]],
    ]
    weights = definite_weights(narrow, Work())
    assert weights is not None
    assert (np.tensordot(weights, np.diagonal(narrow, axis1=1, axis2=2), 1) > 0).all()
    crossed = [[[1.0, 0, 0], [0, -1, 0], [0, 0, 0]], [[0.0, 0, 1], [0, 0, 0], [1, 0, 0]]]
    assert definite_weights(crossed, Work()) is None


def test_weights_are_numbers() -> None:
    """Forms of a real drawing, two of them equal, for which floats end in nan."""
    forms = np.zeros((3, 5, 5))
    forms[::2, 1, 1] = forms[1, 0, 0] = forms[1, 3, 3] = -4
    forms[::2, [0, 4], [4, 0]] = 2
    forms[1, [0, 2], [2, 0]], forms[1, [0, 3], [3, 0]] = 12, 4
    assert definite_weights(forms.tolist(), Work()) is None


def _without_real_zeros(pattern: PanelPattern) -> int:
    """The choices of local modes at vertices of degree 4 that leave two forms without real zeros.

    By the theorem of Finsler these are those with a definite sum of multiples of the forms.
    """
    moving = stars(pattern)
    rows, _ = first_order(moving)
    edges = list(rows)
    space = np.array([[float(x) for x in rows[edge]] for edge in edges])
    products, cones = [], []
    for star in moving.values():
        form = np.zeros((len(edges), len(edges)))
        for k, (e, d) in enumerate(zip(star.folds, star.directions, strict=True)):
            for f, c in zip(star.folds[:k], star.directions[:k], strict=True):
                form[edges.index(e), edges.index(f)] = float(c[0] * d[1] - c[1] * d[0])
        local = space.T @ (form + form.T) @ space
        (products if len(star.folds) == 4 else cones).append(local)
    factors = []
    for form in products:
        values, vectors = np.linalg.eigh(form)
        below, above = vectors[:, 0] * np.sqrt(-values[0]), vectors[:, -1] * np.sqrt(values[-1])
        factors.append((above - below, above + below))
    count = 0
    for chosen in itertools.product(*factors):
        inner = np.linalg.svd(np.array(chosen))[2][len(chosen) :]
        one, other = (inner @ form @ inner.T for form in cones)
        angles = np.linspace(0, 2 * np.pi, 2_000)
        pencil = np.cos(angles)[:, None, None] * one + np.sin(angles)[:, None, None] * other
        count += bool((np.linalg.eigvalsh(pencil)[:, 0] > 0).any())
    return count


@pytest.mark.slow
def test_forms_without_common_zeros_on_one_of_two_spaces(monkeypatch: pytest.MonkeyPatch) -> None:
    sheet = ring(9, (4, 5, 5))
    result = decompose(sheet)
    assert result.second_order == {2: 1}
    assert _without_real_zeros(sheet) == 1
    made = certificate_of_panels(result)
    verified(made)
    for weights in (None, [1.0, 1.0]):  # what is proposed proves nothing
        monkeypatch.setattr(checked_sums, "definite_weights", lambda *_, w=weights: w)
        with pytest.raises(CertificateError, match="may be other components"):
            checked.PANELS.check(made)
