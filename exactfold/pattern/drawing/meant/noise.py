"""The noise level of a drawing: below it relations are meant, above it nothing is near."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from math import lcm, lgamma, log
from typing import Final

GAP: Final = 100.0
"""The noise is believed only if nothing else is off by less than this many times the noise."""
TOLERANCE: Final = 10.0
"""A relation holds if it is missed by at most this many times the noise."""
CHANCE: Final = 1e-3
"""So many relations by chance are allowed for each relation that is found."""
FINEST: Final = 1e-16
"""No noise level is finer; angles are compared in double precision."""
_EASILY: Final = 0.003
_ALIKE: Final = 1e-6
_EXCESS: Final = 0.05
_TRUST: Final = 10.0
"""How many relations must be expected, but not seen, until rays hardly count as uniform."""
_UNLIKELY: Final = 1e-4
LOOKED_FOR: Final = 1e-5
"""What is looked for in many ways is believed only if chance brings it less often than this."""
_VISIBLE: Final = 1e-3
"""What is missed by a larger share of the size can be seen, and is no noise."""
_FINER: Final = 1.02
"""Counts of near relations are told apart if one is this many times the other."""


@dataclass(frozen=True)
class Noise:
    """The noise level `eps` of a drawing, and how far it stands out; lengths over the size.

    `clear` is the smallest defect above the noise. `chance` is the number of relations that are
    expected to be within the tolerance by chance. `near` counts the defects, from the smallest on,
    that chance does not explain. `reason` says why the level is not believed.
    """

    eps: float
    clear: float
    chance: float
    near: int
    reason: str = ""

    @property
    def gap(self) -> float:
        """How many times the noise the next larger defect is."""
        return self.clear / self.eps

    @property
    def tolerance(self) -> float:
        """A relation of any kind holds if it is missed by no more than this."""
        return TOLERANCE * self.eps


def noise_level(
    found: Sequence[tuple[float, float]], densities: Sequence[float], floor: float, beyond: float
) -> Noise | None:
    """The noise level of a drawing; None if it misses no relation narrowly.

    `found` has the defect and the density of each relation that may be near, and `densities` those
    of all places where there might be one (`local_relations`). `floor` is the last digit of the
    coordinates, and relations that are no longer near are missed by at least `beyond`.

    Defects that are exactly 0 say nothing about noise. The others are cut into levels where one is
    `GAP` times the one before. A level is believed if chance hardly explains its defects
    (`is_rare`). The noise is the largest defect of the highest level that is believed.
    """
    missed = sorted((defect, density) for defect, density in found if defect)
    if not missed:
        return None
    defects = [max(defect, floor) for defect, _ in missed]
    above = [*defects[1:], beyond]
    ends = [k for k, (eps, clear) in enumerate(zip(defects, above, strict=True), 1) if clear > eps]

    def expected(end: int) -> float:
        return _expected(defects[end - 1], defects[end:], densities, beyond)

    clear_ends = [0, *(k for k in ends if above[k - 1] >= GAP * defects[k - 1])]
    for start, end in reversed([*pairwise(clear_ends)]):
        if is_rare(chance := expected(end), end - start):
            return Noise(defects[end - 1], above[end - 1], chance, end)
    near = 0
    for end in ends:
        if defects[end - 1] > _VISIBLE:
            break
        worth = end > _FINER * near or end in clear_ends
        if worth and _suspicious(missed[:end], defects[end - 1], densities):
            near = end
    if not near:
        return None
    eps, clear, chance = defects[near - 1], above[near - 1], expected(near)
    return Noise(eps, clear, chance, near, _refusal(eps, clear, chance, near))


def is_rare(
    expected: float, hits: int, *, share: float = CHANCE, unlikely: float = _UNLIKELY
) -> bool:
    """Whether chance explains less than a share of the hits, and is unlikely to bring as many.

    With expected hits m, chance brings k hits or more with a probability of at most m^k / k!.
    """
    if not hits or not expected:
        return bool(hits)
    return expected < share * hits and hits * log(expected) - lgamma(hits + 1) < log(unlikely)


def stated_level(
    eps: float,
    found: Sequence[tuple[float, float]],
    densities: Sequence[float],
    beyond: float,
) -> Noise:
    """The level with a given noise, of which nothing is doubted; arguments as in `noise_level`."""
    tolerance = TOLERANCE * eps
    above = sorted(defect for defect, _ in found if defect > tolerance)
    near = sum(0 < defect <= tolerance for defect, _ in found)
    return Noise(
        eps, above[0] if above else beyond, _expected(tolerance, above, densities, beyond), near
    )


def _expected(
    eps: float, above: Sequence[float], densities: Sequence[float], beyond: float
) -> float:
    """How many relations chance brings within `eps`, if those in `above` are further off.

    Their number is at least that for defects as dense as those in `above`. Uniform rays give
    another number. The more relations these let expect between `eps` and the first in `above`,
    where there is none, the less uniform the rays are: the number becomes smaller by the factor
    that a gamma distribution of the density, of shape `_TRUST`, gives for it.
    """
    clear = above[0] if above else beyond
    seen = max((k / defect for k, defect in enumerate(above, 1)), default=0.0)
    uniform = sum(min(1.0, density * eps) for density in densities)
    unseen = sum(min(1.0, density * clear) for density in densities) - uniform
    return max(eps * seen, uniform * _TRUST / (_TRUST + unseen))


def _suspicious(
    missed: Sequence[tuple[float, float]], eps: float, densities: Sequence[float]
) -> bool:
    """Whether there are more near relations than chance explains, though perhaps of no clear level.

    Relations of edges so short that chance makes them easily are left out. Defects that agree count
    once, as they are copies of one place in a repeating pattern.
    """
    expected = sum(density for density in densities if density * eps < _EASILY) * eps
    copies = {round(log(defect) / _ALIKE) for defect, density in missed if density * eps < _EASILY}
    hits = len(copies)
    return is_rare(expected, hits, share=_EXCESS, unlikely=LOOKED_FOR)


def _refusal(eps: float, clear: float, chance: float, near: int) -> str:
    if clear < GAP * eps:
        return (
            f"noise and design show no gap: relations are missed by up to {eps:.1g} of the size, "
            f"and others by only {clear / eps:.2g} times as much; {GAP:g} times is needed"
        )
    return (
        f"chance may explain them: {near} relations are missed by up to {eps:.1g} of the size, and "
        f"{chance:.1g} are expected by chance; at most {CHANCE:g} for each relation is allowed"
    )


def last_digit(points: Iterable[tuple[Fraction, Fraction]], size: float) -> float:
    """Half of the last decimal digit of the coordinates, over the size, at least 1e-16.

    By so much rounding moves a coordinate. Fractions without a finite decimal are crossings that
    were computed exactly, and coordinates below 1e-9 of the size are noise about zero; both are
    ignored.
    """
    common = 1
    for point in points:
        for c in point:
            if common % c.denominator and abs(c) > 1e-9 * size:
                longer = lcm(common, c.denominator)
                if _decimals(longer) is not None:
                    common = longer
    return max(FINEST, 0.5 * 10.0 ** -(_decimals(common) or 0) / size)


def _decimals(denominator: int) -> int | None:
    """The number of decimals of a fraction; None if there is no finite decimal."""
    twos = (denominator & -denominator).bit_length() - 1
    rest, fives = denominator >> twos, 0
    while rest % 5 == 0:
        rest, fives = rest // 5, fives + 1
    return max(twos, fives) if rest == 1 else None
