"""Single vertices: the theorem of Abel et al. against motions found in other ways."""

from __future__ import annotations

import math
import random
from fractions import Fraction
from itertools import combinations, product

import numpy as np
import pytest
from panel_sheets import one_vertex, star_of
from sampling import slow_after
from scipy.optimize import least_squares

from exactfold._support.verdict import PROVED, REFUTED
from exactfold.design import match_panels
from exactfold.exact.surds import RATIONALS, sign
from exactfold.panels.vertex.stars import Star, bracket, dot
from exactfold.panels.vertex.vertex_motions import Fan, vertex_motion
from exactfold.pattern.panel_pattern import Point

GRID = [(x, y) for x in range(-3, 4) for y in range(-3, 4) if math.gcd(x, y) == 1]


def directions(rng: random.Random, count: int) -> list[tuple[int, int]]:
    """Different directions, counter-clockwise; straight pairs and crossings are frequent."""
    chosen = rng.sample(GRID, count)
    return sorted(chosen, key=lambda d: math.atan2(d[1], d[0]))


def folds_with(star: Star, letters: str) -> bool:
    return vertex_motion(star, dict(zip(star.folds, letters, strict=True))) is not None


CROSS: list[Point] = [(1, 0), (0, 1), (-1, 0), (0, -1)]
HEXAGON: list[Point] = [(2, 0), (1, 2), (-1, 2), (-2, 0), (-1, -2), (1, -2)]


@pytest.mark.parametrize(
    ("around", "letters", "folds"),
    [
        ([(1, 0)], "M", False),
        ([(1, 0), (-3, 0)], "VV", True),
        ([(1, 0), (-3, 0)], "MV", False),
        ([(1, 0), (0, 1)], "MM", False),
        ([(1, 0), (0, 1), (-1, -1)], "MMM", False),
        ([(1, 0), (0, 1), (-1, -1)], "UUU", False),
        ([(1, 0), (0, 1), (-1, 0)], "MUM", True),  # a straight pair; the third fold stays flat
        ([(1, 0), (0, 1), (-1, 0)], "MVM", False),
        (CROSS, "MFMF", True),
        (CROSS, "MVMV", False),
        (CROSS, "MMMV", False),  # three mountains in a closed half-plane
        ([(1, 0), (1, 2), (0, 1), (-1, 0), (0, -1)], "MVMMM", True),  # a crossing and a valley
        ([(1, 0), (1, 2), (0, 1), (-1, 0), (0, -1)], "MMMMV", False),
        ([(1, 0), (1, 1), (0, 1), (-1, 1)], "MVMM", False),  # a sector of 225 degrees
        ([(1, 0), (1, 1), (0, 1), (-1, 0)], "MVVM", False),  # a sector of 180 degrees
        ([(1, 0), (1, 1), (0, 1), (-1, 0)], "MUFM", True),
        (HEXAGON, "MVMVMV", True),
        (HEXAGON, "MMMMMM", False),
        (HEXAGON, "MMVMMV", True),
        (HEXAGON, "MMMVVV", False),  # mountains and valleys in half-planes
    ],
)
def test_known_vertices(around: list[Point], letters: str, folds: bool) -> None:
    assert folds_with(star_of(around), letters) is folds


def test_the_folds_that_the_theorem_names() -> None:
    star = star_of(HEXAGON)
    motion = vertex_motion(star, dict(zip(star.folds, "MUMUMV", strict=True)))
    assert motion is not None
    assert motion.base == (star.folds[0], star.folds[2], star.folds[4])
    assert motion.toe == star.folds[5]
    assert "".join(motion.letters.values()) == "MFMFMV"
    crossing = star_of([(1, 0), (1, 2), (0, 1), (-1, 0), (0, -1)])
    motion = vertex_motion(crossing, dict(zip(crossing.folds, "VMVVV", strict=True)))
    assert motion is not None
    assert motion.base == tuple(crossing.folds[k] for k in (0, 2, 3, 4))
    assert motion.toe == crossing.folds[1]


def test_the_signs_are_those_of_the_field() -> None:
    """tan(pi / 8) = sqrt 2 - 1: two directions that floats cannot tell from opposite ones."""
    root = RATIONALS.adjoined(2).root
    tiny = Fraction(1, 10**40)
    straight = star_of([(Fraction(1), root - 1), (Fraction(-1), 1 - root)])
    assert folds_with(straight, "MM")
    bent = star_of([(Fraction(1), root - 1), (Fraction(-1), 1 - root + tiny)])
    assert not folds_with(bent, "MM")


@pytest.mark.parametrize("seed", range(40))
def test_folds_in_no_half_plane(seed: int) -> None:
    """Directions span positively if no line through one of them has all others on one side."""
    rng = random.Random(seed)
    star = star_of(directions(rng, rng.randint(1, 7)))
    fan = Fan(star)
    for size in range(len(star.folds) + 1):
        for chosen in combinations(range(len(star.folds)), size):
            d = [star.directions[k] for k in chosen]
            normals = [(s * y, -s * x) for x, y in d for s in (1, -1)]
            on_a_side = any(all(nx * x + ny * y >= 0 for x, y in d) for nx, ny in normals)
            found = fan.spanning(chosen)
            assert (found is None) is (on_a_side or not d)
            if found is not None:
                assert set(found) <= set(chosen)
                assert len(found) in (3, 4)
                assert fan.spanning(found) == found
                assert all(fan.spanning(set(found) - {k}) is None for k in found)


@pytest.mark.parametrize("seed", range(30))
def test_free_letters_mean_some_letters(seed: int) -> None:
    """A free fold is a mountain, a valley or flat; F is a fold that is not there."""
    rng = random.Random(seed)
    star = star_of(directions(rng, rng.randint(2, 5)))
    count = len(star.folds)
    plain: dict[str, bool] = {}
    for letters in map("".join, product("MVF", repeat=count)):
        kept = [k for k in range(count) if letters[k] != "F"]
        alone = star.only(star.folds[k] for k in kept)
        plain[letters] = bool(kept) and folds_with(alone, "".join(letters[k] for k in kept))
    for letters in map("".join, product("MVFU", repeat=count)):
        choices = product(*({"U": "MVF"}.get(x, x) for x in letters))
        assert folds_with(star, letters) is any(plain["".join(x)] for x in choices)
        motion = vertex_motion(star, dict(zip(star.folds, letters, strict=True)))
        if motion is not None:
            completed = "".join(motion.letters.values())
            assert plain[completed]
            assert all(x in ("U", y) for x, y in zip(letters, completed, strict=True))


def starts_to_second_order(star: Star, letters: str) -> bool:
    """Whether K vanishes at densities with these letters, by the extreme rays of their cone.

    The densities with sum w_k d_k = 0 and these letters, or 0, are the cone of those with at most
    three folds. If every fold moves on some ray, the open cone holds a zero of K if and only if K
    has both signs on it, or is 0 on all of it. Many exact points of the cone are tried.
    """
    rays = []
    for size in (2, 3):
        for chosen in combinations(range(len(letters)), size):
            d = [star.directions[k] for k in chosen]
            if size == 2:
                opposite = bracket(*d) == 0
                w = [dot(d[1], d[1]), -dot(*d)] if opposite else []
            else:
                w = [bracket(d[1], d[2]), bracket(d[2], d[0]), bracket(d[0], d[1])]
            for side in (1, -1):
                if w and all(
                    x and ("V" if side * x > 0 else "M") == letters[k]
                    for k, x in zip(chosen, w, strict=True)
                ):
                    ray = [Fraction(0)] * len(letters)
                    for k, x in zip(chosen, w, strict=True):
                        ray[k] = side * Fraction(x)
                    rays.append(ray)
    if not rays or not all(any(ray[k] for ray in rays) for k in range(len(letters))):
        return False
    rng = random.Random(len(rays))
    signs = set()
    for _ in range(300):
        weights = [Fraction(rng.choice([0, 0, 1, 1, 2, 30])) for _ in rays]
        w = [
            sum((x * ray[k] for x, ray in zip(weights, rays, strict=True)), Fraction(0))
            for k in range(len(letters))
        ]
        signs.add(sign(star.form(w)))
    for one, other in product(rays, repeat=2):
        signs |= {
            sign(star.form([a + t * b for a, b in zip(one, other, strict=True)]))
            for t in (0, 1, 7, Fraction(1, 7))
        }
    return {1, -1} <= signs or signs == {0}


@pytest.mark.parametrize("seed", slow_after(1, [1, 2, 0, *range(3, 12)]))
def test_agrees_with_the_second_order(seed: int) -> None:
    """All letterings of random vertices, with straight pairs and crossings, sectors of any size."""
    rng = random.Random(seed)
    star = star_of(directions(rng, rng.choice([2, 3, 4, 4, 5, 5, 6])))
    for letters in map("".join, product("MV", repeat=len(star.folds))):
        if letters[0] == "M":  # the opposite letters do the same
            assert folds_with(star, letters) is starts_to_second_order(star, letters)


@pytest.mark.parametrize("seed", range(12))
def test_agrees_with_match(seed: int) -> None:
    rng = random.Random(seed)
    for _ in range(5):
        sheet = one_vertex(directions(rng, rng.choice([2, 3, 4, 4, 5, 6, 7])))
        star = star_of(sheet)
        letters = {fold: rng.choice("MMVV" + rng.choice(["", "FU"])) for fold in star.folds}
        folds = vertex_motion(star, letters) is not None
        folds = folds or {"M", "V"}.isdisjoint(letters.values())
        matched = match_panels(sheet, letters)
        if len(star.folds) <= 4:
            assert matched.truly is (PROVED if folds else REFUTED)
        assert matched.starts is not (REFUTED if folds else PROVED)
        assert matched.truly is not (REFUTED if folds else PROVED)


def _closing(angles: np.ndarray, around: np.ndarray) -> np.ndarray:
    """The vector part of the product of the rotations about the folds, doubled."""
    total = np.eye(3)
    for angle, (x, y) in zip(angles, around, strict=True):
        cross = np.array([[0, 0, y], [0, 0, -x], [-y, x, 0]])
        total = total @ (
            np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross
        )
    return np.array(
        [total[2, 1] - total[1, 2], total[0, 2] - total[2, 0], total[1, 0] - total[0, 1]]
    )


@pytest.mark.slow
def test_folded_vertices_have_letters_that_fold() -> None:
    """Necessity at finite angles: near the flat sheet, every configuration has such letters."""
    compared = 0
    for seed in range(60):
        rng = np.random.default_rng(seed)
        drawn = directions(random.Random(seed), 4 + seed % 4)
        star = star_of(drawn)
        around = np.array([(x / math.hypot(x, y), y / math.hypot(x, y)) for x, y in drawn])
        start = 0.15 * rng.normal(size=len(drawn)) * rng.choice([0, 1, 1, 1], size=len(drawn))
        found = least_squares(_closing, start, args=(around,), xtol=1e-15, ftol=1e-15, gtol=1e-15)
        size = np.abs(found.x)
        unclear = ((size > 1e-7) & (size < 1e-3)).any()
        if unclear or np.abs(found.fun).max() > 1e-13 or not 0.01 < size.max() < 0.6:
            continue
        letters = "".join("F" if abs(a) < 1e-7 else "MV"[int(a > 0)] for a in found.x)
        assert folds_with(star, letters)
        compared += 1
    assert compared >= 30
