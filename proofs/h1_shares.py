"""How many random squares are H1, or can be reduced (Section IV): steps of `random_squares`."""

from __future__ import annotations

from fractions import Fraction
from functools import cache
from itertools import pairwise
from math import comb

from exactfold import random_square
from proofs.framework import Script
from proofs.h1_triangulations import is_h1, reverse_moves
from proofs.statements import Severity

SAMPLES = 400
"""Random squares for each Vi in the shares of Section IV."""


def _agrees(count: int, share: Fraction) -> bool:
    """Whether `count` of SAMPLES is within four standard deviations of a share."""
    variance = SAMPLES * share * (1 - share)
    return (count - SAMPLES * share) ** 2 <= 16 * variance


@cache
def _sampled() -> tuple[dict[int, int], dict[int, int]]:
    """By Vi: squares without a boundary vertex of degree 3, and H1 triangulations."""
    none, h1 = {}, {}
    for n in range(3, 9):
        squares = [random_square(n, seed) for seed in range(SAMPLES)]
        none[n] = sum(min(map(p.degree, p.boundary)) > 3 for p in squares)
        h1[n] = sum(is_h1(frozenset(p.triangles)) for p in squares)
    return none, h1


def shares(script: Script) -> None:
    """Boundary vertices of degree 3, and H1 triangulations, among random squares."""
    none, h1 = _sampled()
    stuck = script.alter("88.5 % and its complement exchanged", "885/1000", "115/1000")
    rare = script.alter("0.0077 misread as 0.077", "77/10000", "77/1000")
    script.cases(
        f"{SAMPLES} random squares for each Vi = 3 to 8, squares without a boundary vertex of "
        f"degree 3: {list(none.values())}; within four standard deviations of 0 and 88.5 % at "
        "Vi = 3 and 8, and increasing",
        [
            none[3] == 0,
            _agrees(none[8], Fraction(stuck)),
            *(none[n] < none[n + 1] for n in range(3, 8)),
        ],
        of="IV.15",
    )
    script.cases(
        f"the same squares, H1 triangulations: {list(h1.values())}; all of them at Vi = 3, within "
        "four standard deviations of the share 0.0077 at Vi = 8, each time at most 3/4 of the "
        "number before",
        [
            h1[3] == SAMPLES,
            _agrees(h1[8], Fraction(rare)),
            *(4 * h1[n + 1] <= 3 * h1[n] for n in range(3, 8)),
        ],
        of="IV.16",
    )
    factor = script.alter("a factor of 3/4", Fraction(107, 200), Fraction(3, 4))
    script.cases(
        f"the share of these squares is not q^(Vi - 3) for any q: for q <= {factor} at least "
        f"{h1[4]} of {SAMPLES} have a probability below 10^-4 at Vi = 4, for larger q at most "
        f"{h1[8]} at Vi = 8",
        [
            _at_least(h1[4], SAMPLES, factor) < RARE,
            _at_most(h1[8], SAMPLES, factor**5) < RARE,
        ],
        against="IV.16",
    )
    least = script.alter("degree two", 3, 2)
    script.cases(
        "H1 triangulations among the first 100 of these squares for Vi = 3 to 6: a boundary vertex "
        "of degree 3, so that their share is at most the other's complement",
        (
            min(map(p.degree, p.boundary)) == least
            for p in (random_square(n, seed) for n in range(3, 7) for seed in range(100))
            if is_h1(frozenset(p.triangles))
        ),
        of="IV.15 IV.16",
    )
    script.state(
        "IV.15",
        "Section IV, fractions",
        r"\text{``an increasing fraction of triangulations had no degree-3 vertices at the "
        r"boundary (starting from 0\% at }V_i=3\text{ to 88.5\% at }V_i=8\text{)''}",
        note=f"data of the paper; in our samples of {SAMPLES} for Vi = 3 to 8: "
        + ", ".join(f"{100 * k / SAMPLES:.1f} %" for k in none.values()),
        code="random_square",
    )
    script.state(
        "IV.16",
        "Section IV, fractions",
        r"\text{``the fraction of H1 triangulations decreased roughly exponentially from 1 at "
        r"}V_i=3\text{ to 0.0077 at }V_i=8\text{''}",
        r"\text{decreased faster than exponentially from 1 at }V_i=3\text{ to 0.0077 at }V_i=8",
        'the two numbers agree. What "roughly" allows is not said; but an exponential with these '
        "two ends has the factor 0.38 throughout, and in 20,000 squares of each size the factors "
        "are 0.64, 0.48, 0.38, 0.25 and 0.24 (docs/studies.md, H1 triangulations). Remark: in our "
        f"samples of {SAMPLES} for Vi = 3 to 8: "
        + ", ".join(f"{k / SAMPLES:.4f}" for k in h1.values()),
        code="random_square, families.sample_h1_sequence",
        severity=Severity.REMARK,
    )


RARE = Fraction(1, 10**4)
"""A probability below this rules a law out."""


def _at_most(k: int, number: int, share: Fraction) -> Fraction:
    """The probability of at most k successes in so many trials; it falls as the share grows."""
    return sum(
        (comb(number, i) * share**i * (1 - share) ** (number - i) for i in range(k + 1)),
        Fraction(0),
    )


def _at_least(k: int, number: int, share: Fraction) -> Fraction:
    """The probability of at least k successes; it grows with the share."""
    return _at_most(number - k, number, 1 - share)


def moves_left(triangles: frozenset[tuple[int, int, int]]) -> int:
    """The largest number of reverse H1 moves in sequence.

    >>> moves_left(frozenset(random_square(3, seed=0).triangles))
    3
    """
    return max((1 + moves_left(smaller) for smaller in reverse_moves(triangles)), default=0)


@cache
def _reducible() -> tuple[int, ...]:
    """How many squares with Vi = 8 admit at least 0, 1, 2, ... reverse H1 moves."""
    most = [moves_left(frozenset(random_square(8, seed).triangles)) for seed in range(SAMPLES)]
    return tuple(sum(m >= k for m in most) for k in range(max(most) + 1))


def reductions(script: Script) -> None:
    """How many reverse moves can still be made: the share falls more slowly than exponentially."""
    counts = _reducible()
    share = script.alter("no decay", Fraction(3, 4), Fraction(1, 20))
    script.cases(
        f"{SAMPLES} random squares with Vi = 8, those with at least 0, 1, 2, ... reverse H1 moves: "
        f"{list(counts)}: each time at most 3/4 of the number before, down to the seed",
        (after <= share * before for before, after in pairwise(counts[:6])),
        of="IV.17",
    )
    factor = script.alter("a factor of 1/3", Fraction(9, 50), Fraction(1, 3))
    script.cases(
        f"these numbers do not fall by one factor r: for r >= {factor} at most {counts[1]} of "
        f"{counts[0]} have a probability below 10^-4, for smaller r at least {counts[2]} of "
        f"{counts[1]}",
        [
            _at_most(counts[1], counts[0], factor) < RARE,
            _at_least(counts[2], counts[1], factor) < RARE,
        ],
        against="IV.17",
    )
    script.state(
        "IV.17",
        "Section IV, fractions",
        r"\text{``the number of triangulations in this data set that can be reduced further with "
        r"more reverse H1 moves appears to decay exponentially''}",
        r"\text{decays more slowly than exponentially}",
        "of 20,000 squares with Vi = 8 the shares that admit one more move are 0.11, 0.35, 0.44, "
        "0.55 and 0.73 (docs/studies.md, H1 triangulations). Remark: in samples of "
        f"{SAMPLES}, those with at least 0, 1, 2, ... moves: {', '.join(map(str, counts))}. A "
        "triangulation that can be reduced to Vi = 3 can be reduced to the seed (IV.10), unless it "
        "has a chord by then",
        code="random_square",
        severity=Severity.REMARK,
    )
