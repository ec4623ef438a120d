"""Hard stops of folds: the motion ends where the first fold reaches the angle of its stop."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from functools import partial

from ...core.intervals import Interval
from ...core.reading import items, keys, natural, parse_rational, require, rounded
from ...sheets.panels import Edge
from ..claims import Document
from .folding import Folding, PanelClaim
from .series import BITS
from .times import cosine_and_sine, time_of


class Stop(PanelClaim):
    """The `fold` reaches its stop by the second `time`, and no fold does before the first.

    `angles` are the stops: the ends of a fold, and an angle between 0 and 180 degrees. The size of
    each fold angle grows until a fold is closed (docs/motion.md, 18 and 19). So all angles at the
    first parameter, and the one at the second, decide.
    """

    names = ("stop",)
    needs = ("stop",)

    def check(self, folding: Folding) -> None:
        """Refuse a motion whose first stop is not proved to be reached between the times."""
        claim, clock = self.claims["stop"], folding.clock
        keys(claim, "angles fold time", "stop")
        tangents = _tangents(folding, claim["angles"])
        first, last = map(parse_rational, items(claim["time"], "time", 2))
        fold = _edge(claim["fold"])
        begin, end = (
            folding.parameter(x) for x in items(self.evidence["stop"], "parameters of a stop", 2)
        )
        require(first <= clock.time(begin)[0], "a fold may reach its stop earlier than claimed")
        require(clock.time(end)[1] <= last, "the fold may reach its stop later than claimed")
        before = _sines(folding, begin)
        for edge, (c, s) in tangents.items():
            size, below = before.get(edge, (Interval.of(Fraction(0), BITS), None))
            room = s if below is None else s * below - c * size
            require(room.sign() > 0, f"the fold {edge} may have reached its stop before")
        (c, s), (size, below) = tangents[fold], _sines(folding, end)[fold]
        passed = (c * size - s * below).sign() > 0
        require(passed, "the fold is not proved to have reached its stop")

    @staticmethod
    def said(claims: Document) -> str:
        """Which fold reaches its stop, and when."""
        (i, j), times = claims["stop"]["fold"], claims["stop"]["time"]
        low, high = (rounded(parse_rational(t), 12, up=k > 0) for k, t in enumerate(times))
        return f"; the fold {i}-{j} is the first at its stop, between the times {low} and {high}"


def _tangents(folding: Folding, given: object) -> Mapping[Edge, tuple[Interval, Interval]]:
    """The cosine and the sine of half the stop of each fold."""
    pi = time_of(Fraction(1))
    tangents: dict[Edge, tuple[Interval, Interval]] = {}
    for entry in items(given, "angles"):
        i, j, text = items(entry, "a stop", 3)
        fold, degrees = _edge([i, j]), parse_rational(text)
        right = fold in folding.drive.letters and fold not in tangents and 0 < degrees < 180
        require(right, "a stop is at no fold, is the second at one, or is not below 180 degrees")
        half = [Interval.of(bound * degrees / 360, BITS) for bound in pi]
        tangents[fold] = cosine_and_sine(half[0].joined(half[1]))
    return tangents


def _sines(folding: Folding, x: Fraction) -> dict[Edge, tuple[Interval, Interval]]:
    """For each fold that moves (S, C) with S / C the size of tan(angle / 2), at a parameter."""
    driven = partial(folding.clock.driven, Interval.of(x, BITS))
    found = {}
    for fold, (below, above) in folding.drive.tangents(driven).items():
        c, s = below.coefficients[0], above.coefficients[0]
        found[fold] = Interval(max(s.low, -s.high, 0), max(s.high, -s.low), BITS), c
    return found


def _edge(value: object) -> Edge:
    i, j = (natural(v, "a vertex") for v in items(value, "a fold", 2))
    return i, j
