"""Decompositions against a Gröbner-basis program, random starts and theorems of others."""

from __future__ import annotations

import math
import random
import shutil
import subprocess
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import product
from typing import Any

import numpy as np
import pytest
from panel_sheets import grid, mesh, miura, outlined, shifted_columns, tiling

from exactfold._support.verdict import PROVED
from exactfold.panels.by_spaces import by_spaces
from exactfold.panels.decomposition import decompose
from exactfold.panels.spaces.kernel import Rows, first_order, imposed
from exactfold.panels.spaces.quadratics import factors
from exactfold.panels.spaces.splitting import leaves
from exactfold.panels.spaces.subspaces import Leaf, SubspaceSearch
from exactfold.panels.vertex.stars import bracket, stars
from exactfold.pattern.families import single_vertex
from exactfold.pattern.opening import panels
from exactfold.pattern.panel_pattern import Edge, PanelPattern

SINGULAR = shutil.which("Singular")
SHEETS = {
    "miura": miura(2, 2),
    "strip": mesh(1, 3, seed=2),
    "tiling": tiling(2, 2),
    "mesh": mesh(2, 2, seed=8),
    "shifted": shifted_columns(1),
}
MORE = {
    **{f"miura {m} x {n}": miura(m, n) for m in (1, 2, 3) for n in (1, 2, 3)},
    **{f"strip {seed}": mesh(1, 1 + seed % 4, seed) for seed in range(12)},
    **{f"mesh {seed}": mesh(2, 2, seed) for seed in range(10)},
    **{f"shifted {k}": shifted_columns(k) for k in range(-3, 3)},
    **{f"vertex of {n} folds": panels(single_vertex(n)) for n in (5, 6, 7)},
}


def answers(program: str) -> list[str]:
    """What a program of Singular prints behind an "@", line by line."""
    done = subprocess.run(
        [SINGULAR or "Singular", "-q"],
        input=program,
        capture_output=True,
        text=True,
        timeout=120,
        check=True,
    )
    return [line[1:] for line in done.stdout.splitlines() if line.startswith("@")]


def by_singular(pattern: PanelPattern) -> dict[int, int]:
    """{dimension: sum of the degrees} of the minimal primes of all conditions, over Q."""
    moving = stars(pattern)
    edges = sorted({edge for star in moving.values() for edge in star.folds})
    name = {edge: f"w({k})" for k, edge in enumerate(edges)}
    conditions = []
    for star in moving.values():
        for axis in (0, 1):
            terms = zip(star.folds, star.directions, strict=True)
            conditions.append("+".join(f"({d[axis]})*{name[e]}" for e, d in terms))
        pairs = list(zip(star.folds, star.directions, strict=True))
        conditions.append(
            "+".join(
                f"({bracket(d, c)})*{name[e]}*{name[f]}"
                for k, (f, c) in enumerate(pairs)
                for e, d in pairs[:k]
            )
        )
    program = f"""
        LIB "primdec.lib";
        ring r = 0, w(0..{len(edges) - 1}), dp;
        ideal i = {", ".join(conditions)};
        list l = minAssGTZ(i);
        int k; ideal s;
        for (k = 1; k <= size(l); k++)
        {{ s = std(l[k]); print("@" + string(dim(s)) + " " + string(mult(s))); }}
        quit;
    """
    found: Counter[int] = Counter()
    for line in answers(program):
        dimension, degree = line.split()
        found[int(dimension)] += int(degree)
    return dict(found)


def degrees(pattern: PanelPattern) -> dict[int, int]:
    """The same of what is found here, free folds apart: the cone of k forms has degree 2^k."""
    moving = stars(pattern)
    found: Counter[int] = Counter()
    for leaf in leaves(moving, *first_order(moving), 10**6):
        found[leaf.dimension] += 2 ** len(leaf.vertices)
    return dict(found) or {0: 1}


@pytest.mark.skipif(SINGULAR is None, reason="Singular is not installed")
@pytest.mark.parametrize("name", SHEETS)
def test_singular_finds_the_same_components(name: str) -> None:
    assert by_singular(SHEETS[name]) == degrees(SHEETS[name])


FOURTH = frozenset(list(MORE)[::4]) - {"strip 3", "strip 7", "strip 11"}
"""Those that CI looks at, but for two long ones, of which a third is like them."""


@pytest.mark.skipif(SINGULAR is None, reason="Singular is not installed")
@pytest.mark.parametrize(
    "name",
    [
        pytest.param(x, marks=getattr(pytest.mark, "slow" if x in FOURTH else "survey"))
        for x in MORE
    ],
)
def test_singular_finds_the_same_components_of_forty_sheets(name: str) -> None:
    assert len(MORE) == 40
    assert by_singular(MORE[name]) == degrees(MORE[name])


# --- random starts -------------------------------------------------------------------------------


class Floats:
    """The conditions of a sheet in floating point, on its first-order motions."""

    def __init__(self, pattern: PanelPattern) -> None:
        moving = stars(pattern)
        self.edges: list[Edge] = sorted({e for star in moving.values() for e in star.folds})
        count = len(self.edges)
        linear, self.forms = [], []
        for star in moving.values():
            at = [self.edges.index(edge) for edge in star.folds]
            d = np.array([[float(x), float(y)] for x, y in star.directions])
            d /= np.abs(d).max()
            for axis in (0, 1):
                row = np.zeros(count)
                row[at] = d[:, axis]
                linear.append(row)
            form = np.zeros((count, count))
            for k in range(len(at)):
                for j in range(k):
                    c = d[j, 0] * d[k, 1] - d[j, 1] * d[k, 0]
                    form[at[j], at[k]] = form[at[k], at[j]] = c
            self.forms.append(form)
        _, values, right = np.linalg.svd(np.array(linear))
        self.space = right[int((values > 1e-10).sum()) :].T

    def solution(self, rng: np.random.Generator) -> np.ndarray | None:
        """A motion of length 1 from a random start, by Levenberg and Marquardt's method."""
        a = rng.standard_normal(self.space.shape[1])
        damping = 1e-2
        for _ in range(400):
            a /= np.linalg.norm(a)
            w = self.space @ a
            values = np.array([w @ form @ w for form in self.forms])
            if np.abs(values).max() < 1e-13:
                return w
            slopes = np.array([2 * (form @ w) @ self.space for form in self.forms])
            normal = slopes.T @ slopes + damping * np.eye(len(a))
            trial = a - np.linalg.solve(normal, slopes.T @ values)
            trial /= np.linalg.norm(trial)
            moved = self.space @ trial
            if sum((moved @ f @ moved) ** 2 for f in self.forms) < values @ values:
                a, damping = trial, max(damping / 5, 1e-12)
            else:
                damping *= 4
        return None


def on_a_leaf(w: np.ndarray, edges: list[Edge], found: list[Leaf]) -> bool:
    """Whether a motion lies, in floating point, in the space of a leaf."""
    for leaf in found:
        rows = np.array([[float(x) for x in leaf.rows.get(e, (0,) * leaf.size)] for e in edges])
        basis = np.linalg.qr(rows)[0]
        if np.linalg.norm(w - basis @ (basis.T @ w)) < 1e-5:
            return True
    return False


@pytest.mark.slow
@pytest.mark.parametrize("name", ["miura", "strip", "tiling", "shifted"])
def test_random_starts_land_on_listed_components(name: str) -> None:
    pattern = SHEETS[name]
    moving = stars(pattern)
    found = leaves(moving, *first_order(moving), 10**6)
    conditions, rng = Floats(pattern), np.random.default_rng(3)
    solutions = [w for _ in range(24) if (w := conditions.solution(rng)) is not None]
    assert len(solutions) >= 4
    assert all(on_a_leaf(w, conditions.edges, found) for w in solutions)
    if name != "shifted":
        few = found[1:]
        assert not all(on_a_leaf(w, conditions.edges, few) for w in solutions)


# --- flexible meshes of quadrilaterals -----------------------------------------------------------

Gauss = tuple[Fraction, Fraction]


def times(a: Gauss, b: Gauss) -> Gauss:
    return a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]


def minus(a: Gauss, b: Gauss) -> Gauss:
    return a[0] - b[0], a[1] - b[1]


def spokes(corners: list[Gauss], k: int, first: Gauss) -> list[Gauss]:
    """The four creases at a corner, counter-clockwise, with alternating sum of sectors zero."""
    after = minus(corners[(k + 1) % 4], corners[k])
    before = minus(corners[k - 1], corners[k])
    x, y = times(times(after, first), (before[0], -before[1]))
    scale = max(abs(x), abs(y))
    return [after, before, first, (-x / scale, -y / scale)]


def flat_foldable(corners: list[Gauss], outward: list[Gauss]) -> PanelPattern:
    """A quadrilateral with two creases at each corner, all four vertices flat-foldable."""
    points, folds = list(corners), [(k, (k + 1) % 4) for k in range(4)]
    for k, corner in enumerate(corners):
        for x, y in spokes(corners, k, outward[k])[2:]:
            folds.append((k, len(points)))
            points.append((corner[0] + x, corner[1] + y))
    return outlined(points, folds, 4)


def turned(axis: complex, angle: float) -> np.ndarray:
    """The rotation about a direction in the plane."""
    x, y = axis.real / abs(axis), axis.imag / abs(axis)
    cross = np.array([[0, 0, y], [0, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross


def ratios(around: list[Gauss]) -> list[float]:
    """tan(first / 2) / tan(second / 2) in the two modes of a flat-foldable vertex.

    Tachi 2009: opposite fold angles are equal up to sign, one pair with opposite signs, and the
    ratio is one of sines or cosines of half the difference and half the sum of two neighbouring
    sectors. Which of them it is is seen by folding: four rotations compose to the identity.
    """
    axes = [complex(x, y) for x, y in around]
    alpha, beta = (float(np.angle(axes[k + 1] / axes[k])) % (2 * math.pi) for k in (0, 1))
    sines = math.sin((alpha - beta) / 2) / math.sin((alpha + beta) / 2)
    cosines = math.cos((alpha - beta) / 2) / math.cos((alpha + beta) / 2)
    found = []
    for one, other in ((-1, 1), (1, -1)):
        closing = []
        for size in (sines, cosines, 1 / sines, 1 / cosines):
            for ratio in (size, -size):
                second = 0.3
                first = 2 * math.atan(ratio * math.tan(second / 2))
                angles = (first, second, one * first, other * second)
                whole = np.eye(3)
                for axis, angle in zip(axes, angles, strict=True):
                    whole = whole @ turned(axis, angle)
                if np.abs(whole - np.eye(3)).max() < 1e-12:
                    closing.append(ratio)
        assert closing
        assert max(closing) - min(closing) < 1e-12  # at a right angle two agree
        found.append(closing[0])
    return found


def ways(corners: list[Gauss], outward: list[Gauss]) -> int:
    """Tachi's theorem: in how many choices of modes the ratios round the panel multiply to 1."""
    modes = [ratios(spokes(corners, k, outward[k])) for k in range(4)]
    return sum(abs(math.prod(choice) - 1) < 1e-9 for choice in product(*modes))


def point(x: int, y: int, below: int = 1) -> Gauss:
    return Fraction(x, below), Fraction(y, below)


def mirrored() -> tuple[list[Gauss], list[Gauss]]:
    """A trapezoid whose creases are their own mirror image."""
    corners = [point(-3, -1), point(3, -1), point(2, 2), point(-2, 2)]
    left = [point(-1, 1, 5), point(0, 0), point(0, 0), point(1, 4, 4)]
    for k, other in ((0, 1), (3, 2)):
        x, y = spokes(corners, k, left[k])[3]
        left[other] = (-x, y)
    return corners, left


def in_general_position(seed: int) -> tuple[list[Gauss], list[Gauss]]:
    rng = random.Random(seed)
    corners = [
        point(10 * x + rng.randint(-2, 2), 10 * y + rng.randint(-2, 2), 5)
        for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))
    ]
    sides = [(-10, 0), (0, -10), (10, 0), (0, 10)]
    outward = [point(x + rng.randint(-3, 3), y + rng.randint(-3, 3), 10) for x, y in sides]
    return corners, outward


def test_a_mesh_that_is_its_mirror_image_folds_as_tachi_says() -> None:
    corners, outward = mirrored()
    number = ways(corners, outward)
    assert number >= 4
    result = decompose(flat_foldable(corners, outward))
    assert result.second_order == result.true == {1: number}
    assert all(mode.extends.verdict is PROVED for mode in result.modes)


@pytest.mark.parametrize("seed", [0, 2, 3, 4, 5])
def test_a_flat_foldable_mesh_in_general_position_is_rigid_as_tachi_says(seed: int) -> None:
    corners, outward = in_general_position(seed)
    assert ways(corners, outward) == 0
    result = decompose(flat_foldable(corners, outward))
    assert result.true == {0: 1}
    assert result.rigid is PROVED


@pytest.mark.parametrize("size", [1, 2, 3])
def test_a_tiling_by_one_quadrilateral_folds_as_kokotsakis_says(size: int) -> None:
    result = decompose(tiling(size + 1, size + 1))
    assert result.true == {1: 2}


def test_a_tiling_with_one_vertex_moved_no_longer_folds() -> None:
    plain = tiling(2, 2)
    moved = list(plain.vertices)
    x, y = moved[5]
    moved[5] = (x + Fraction(1, 7), y)
    result = decompose(PanelPattern(moved, plain.edges))
    assert result.true == {0: 1}
    assert result.rigid is PROVED


def plainly_split(search: SubspaceSearch, rows: Rows, size: int) -> Iterator[tuple[Rows, int]]:
    """The spaces of a splitting that takes both factors of every form, without leaving any out."""
    rows, size, products, _ = search.reduced(rows, size)
    if not products:
        yield rows, size
        return
    for functional in factors(products[:1], rows):
        yield from plainly_split(search, *imposed(rows, size, functional))


@pytest.mark.parametrize("name", sorted(SHEETS))
def test_splitting_leaves_out_only_spaces_that_lie_in_others(name: str) -> None:
    moving = stars(SHEETS[name])
    rows, size = first_order(moving)
    found = leaves(moving, rows, size, 10**6)
    edges = sorted(rows)

    def basis(some: Mapping[Edge, Sequence[Any]], dimension: int) -> np.ndarray:
        return np.array([[float(x) for x in some.get(e, (0,) * dimension)] for e in edges])

    bases = [basis(leaf.rows, leaf.size) for leaf in found]
    sizes: Counter[int] = Counter()
    for space, dimension in plainly_split(SubspaceSearch(moving, 10**8), rows, size):
        if dimension:
            inner = basis(space, dimension)
            both = [(b, np.linalg.matrix_rank(np.hstack([b, inner]), 1e-8)) for b in bases]
            around = [b for b, rank in both if rank == b.shape[1]]
            assert around
            sizes[dimension] += any(b.shape[1] == dimension for b in around)
    assert all(sizes[leaf.size] for leaf in found)


def test_a_grid_of_more_than_sixteen_dimensions_folds_along_rows_or_along_columns() -> None:
    """Where a row crosses a column, one of the two is flat, so only all of one kind can fold."""
    pattern = grid(10, 10, lambda i, j: (Fraction(i), Fraction(j)))
    moving = stars(pattern)
    part = by_spaces(pattern, moving)
    assert (part.dimension, part.second_order, part.true) == (18, {9: 2}, None)
    spaces = [set(leaf.rows) for leaf in part.spaces]
    assert sorted(map(len, spaces)) == [90, 90]
    assert not spaces[0] & spaces[1]
