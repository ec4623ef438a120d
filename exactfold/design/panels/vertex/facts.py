"""What is known of each vertex by itself: whether it folds with its letters, and whether flat."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import combinations
from math import degrees, pi
from typing import Final, NamedTuple

from flint import arb

from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED, Verdict
from exactfold.design.panels.vertex.kawasaki import (
    BITS,
    Turn,
    angle_between,
    angle_of,
    kawasaki,
    turn_for,
)
from exactfold.design.refutations.refutation import Letters
from exactfold.exact.surds import ball
from exactfold.panels.nearby.box import Box
from exactfold.panels.nearby.letters import NearbyFan
from exactfold.panels.vertex.stars import Star, bracket, dot, star_at
from exactfold.panels.vertex.vertex_motions import Fan
from exactfold.pattern.panel_pattern import Edge, PanelPattern, Point

NEAR: Final = 1e-3
"""Two folds are nearly straight if they miss a straight line by less than this angle."""
_CLOSE: Final = 0.1
"""Kawasaki's condition nearly holds if it is off by less than so many degrees."""
_MEANT: Final = 1e-3
"""It was probably meant if it is off by less than so many degrees."""
_FLIPPED: Final = {"M": "V", "V": "M"}
_MOST_FLIPS: Final = 4
_MOST_CHOICES: Final = 64
_MOST_PAIRS: Final = 5


class _Pair(NamedTuple):
    """The places of two nearly straight folds, and by which angle they miss a straight line."""

    one: int
    other: int
    off: float


@dataclass(frozen=True)
class VertexFacts:
    """What is known of one interior vertex, all others left aside.

    `folds` are its folds, counter-clockwise, and `letters` their letters. `starts` says whether the
    vertex has a motion with these letters (docs/vertices.md, Theorem 1); it is PROVED if no fold
    has to move. `able` says whether it moves with any letters if the folds with letter F stay flat.
    `reason` says why it does not start, or why that is open. `flips` are all smallest sets of folds
    whose letters M and V have to be exchanged if it does not start, and `forced` are the letters
    that the others leave to free folds.

    The other facts are about folding the sheet flat, and leave out the folds with letter F. Every
    second sector, from the first fold on, adds up to 180 + `off` degrees; None stands for an odd
    number of folds. `kawasaki` says whether `off` is exactly 0. `maekawa` says whether the numbers
    of mountains and valleys differ by 2; None means that a letter is missing. `turn` mends `off`.
    """

    vertex: int
    folds: tuple[Edge, ...]
    letters: str
    starts: Verdict
    able: bool
    reason: str
    flips: tuple[tuple[Edge, ...], ...]
    forced: Mapping[Edge, str]
    kawasaki: bool
    off: float | None
    maekawa: bool | None
    turn: Turn | None

    @property
    def nearly_kawasaki(self) -> bool:
        """Whether Kawasaki's condition fails by less than 0.1 degrees."""
        return not self.kawasaki and self.off is not None and abs(self.off) < _CLOSE

    @property
    def meant_kawasaki(self) -> bool:
        """Whether Kawasaki's condition fails by so little that it was probably meant."""
        return self.nearly_kawasaki and self.off is not None and abs(self.off) < _MEANT

    @property
    def excess(self) -> int:
        """The number of mountains minus that of valleys."""
        counts = Counter(self.letters)
        return counts["M"] - counts["V"]


def vertex_facts(
    sheet: PanelPattern, letters: Letters, *, exactly: bool = False, box: Box | None = None
) -> tuple[VertexFacts, ...]:
    """The facts about every interior vertex of a sheet with the letters M, V, F and U of its folds.

    All verdicts are exact. Where two folds nearly form a straight crease and the answer depends on
    whether they do, the verdict is UNDECIDED, unless `exactly` says that the coordinates are meant
    as they are. With a `box`, it is UNDECIDED unless it is proved for every sheet in the box. If
    one vertex is refuted, no finite folding of the sheet near the flat state has the letters.

    >>> from exactfold.pattern.opening import open_pattern
    >>> from exactfold.pattern.data import example_path
    >>> opened = open_pattern(example_path("zigzags"))
    >>> [(v.vertex, str(v.starts)) for v in vertex_facts(opened.sheet, opened.letters)][:2]
    [(9, 'refuted'), (10, 'refuted')]
    """
    return tuple(_facts(sheet, star_at(sheet, v), letters, exactly, box) for v in sheet.interior)


def _facts(
    sheet: PanelPattern, star: Star, letters: Letters, exactly: bool, box: Box | None
) -> VertexFacts:
    given = "".join(letters.get(fold, "U") for fold in star.folds)
    fan = Fan(star)
    starts, able = _answers(fan, given)
    reason = _why(star, given, fan) if not starts or not able else ""
    verdict, possible = PROVED if starts else REFUTED, able
    for straight, pairs in () if exactly else _straightened(star):
        straight_starts, straight_able = _answers(Fan(straight), given)
        if straight_starts != starts:
            verdict, reason = UNDECIDED, _open_text(star, pairs, starts)
            break
        if straight_able != able and {"M", "V"}.isdisjoint(given):
            verdict, reason = UNDECIDED, _open_text(star, pairs, able)
            break
        possible = possible or straight_able
    if box is not None:
        nearby = NearbyFan(box, star.vertex)
        possible = possible or nearby.may_fold(["F" if x == "F" else "U" for x in given])
        if verdict is not UNDECIDED and not _holds_nearby(nearby, given, verdict, possible):
            verdict, reason = UNDECIDED, _nearby_text(box, starts and able, reason)
    flat = star.only(f for f, x in zip(star.folds, given, strict=True) if x != "F")
    holds, off = kawasaki(flat)
    kept = given.replace("F", "")
    return VertexFacts(
        star.vertex,
        star.folds,
        given,
        verdict,
        possible,
        reason,
        _flips(star, given, fan) if verdict is REFUTED else (),
        _forced(star, given, fan) if verdict is PROVED else {},
        holds,
        off,
        None if "U" in kept else abs(kept.count("M") - kept.count("V")) == 2 or not kept,
        None if holds or off is None else turn_for(sheet, flat, off),
    )


def _answers(fan: Fan, letters: str) -> tuple[bool, bool]:
    """Whether the vertex has its letters, and whether it moves with any letters."""
    able = fan.folds(["F" if x == "F" else "U" for x in letters])
    return fan.folds(letters) or {"M", "V"}.isdisjoint(letters), able


def _holds_nearby(nearby: NearbyFan, given: str, verdict: Verdict, possible: bool) -> bool:
    """Whether a verdict for the sheet as written is proved for every sheet of a box."""
    if {"M", "V"}.isdisjoint(given):
        return not possible or nearby.must_fold(["F" if x == "F" else "U" for x in given])
    return nearby.must_fold(given) if verdict is PROVED else not nearby.may_fold(given)


def _flips(star: Star, given: str, fan: Fan) -> tuple[tuple[Edge, ...], ...]:
    """The smallest sets of folds that have to exchange M and V; empty if that does not help."""
    moving = [k for k, x in enumerate(given) if x in _FLIPPED]
    found: list[tuple[Edge, ...]] = []
    for size in range(1, min(_MOST_FLIPS, len(moving)) + 1):
        for chosen in combinations(moving, size):
            letters = [_FLIPPED[x] if k in chosen else x for k, x in enumerate(given)]
            if fan.folds(letters):
                found.append(tuple(star.folds[k] for k in chosen))
                if len(found) == _MOST_CHOICES:
                    break
        if found:
            break
    return tuple(found)


def _forced(star: Star, given: str, fan: Fan) -> dict[Edge, str]:
    """The letters of free folds to which the other letters leave no choice."""
    if {"M", "V"}.isdisjoint(given):
        return {}
    forced = {}
    for k, fold in enumerate(star.folds):
        if given[k] == "U":
            possible = [x for x in "MVF" if fan.folds([*given[:k], x, *given[k + 1 :]])]
            if len(possible) == 1:
                forced[fold] = possible[0]
    return forced


def _straightened(star: Star) -> Iterator[tuple[Star, tuple[_Pair, ...]]]:
    """The star with nearly straight pairs made straight: one, several, or all of them."""
    near = [(ball(x, BITS), ball(y, BITS)) for x, y in star.directions]
    pairs = tuple(
        _Pair(i, j, off)
        for i, j in combinations(range(len(star.folds)), 2)
        if not _is_bent(near[i], near[j])
        and 0 < (off := _bend(star.directions[i], star.directions[j])) < NEAR
    )
    for size in range(1, len(pairs) + 1):
        if 1 < size < len(pairs) > _MOST_PAIRS:
            continue
        for chosen in combinations(pairs, size):
            if len({place for pair in chosen for place in pair[:2]}) < 2 * size:
                continue  # a fold is in two pairs, and not both can be straight
            directions = list(star.directions)
            for pair in chosen:
                x, y = directions[pair.one]
                directions[pair.other] = (-x, -y)
            yield Star(star.vertex, star.folds, tuple(directions)), chosen


def _is_bent(a: tuple[arb, arb], b: tuple[arb, arb]) -> bool:
    """Whether enclosures show that two directions miss a straight line by more than `NEAR`."""
    along = a[0] * b[0] + a[1] * b[1]
    across = a[0] * b[1] - a[1] * b[0]
    return bool(along > 0 or abs(across) > 2 * NEAR * abs(along))


def _bend(a: Point, b: Point) -> float:
    """The angle by which two directions miss a straight line, in radians; 0 only if they do not."""
    across = bracket(a, b)
    if not across:
        return 0.0
    return abs(angle_of(across, -dot(a, b))) if dot(a, b) < 0 else pi


# --- reasons -------------------------------------------------------------------------------------


def _why(star: Star, given: str, fan: Fan) -> str:
    """Why a vertex does not move, with its letters or with any."""
    kept = [k for k, x in enumerate(given) if x != "F"]
    moving = [k for k, x in enumerate(given) if x in _FLIPPED]
    able = fan.folds(["F" if x == "F" else "U" for x in given])
    if not able or not _any_letters(fan, given, moving):
        alone = star.only(star.folds[k] for k in kept)
        return _geometry_text(alone, [star.folds[k] for k in moving])
    if len(kept) == 2:
        return "the two halves of a straight crease have different letters"
    mountains, valleys = ([star.folds[k] for k in moving if given[k] == x] for x in "MV")
    free = len(moving) < len(kept)
    if mountains and valleys:
        do = "do" if free or len(valleys) > 1 else "does"
        return (
            f"{_folds('mountain', mountains, free)} {_lie(mountains, free)} on one side of a line, "
            f"and so {do} {_folds('valley', valleys, free)}"
        )
    kind, other = ("mountain", "valley") if mountains else ("valley", "mountain")
    if free:
        folds = mountains or valleys
        return (
            f"it needs a {other}, and as soon as a free fold is one, {_folds(kind, folds, free)} "
            f"{_lie(folds, free)} on one side of a line"
        )
    return f"all its folds are {kind}s, and it needs a {other}"


def _folds(kind: str, folds: list[Edge], free: bool) -> str:
    named = f"its {kind}s {_named(folds)}" if len(folds) > 1 else f"its only {kind} {_named(folds)}"
    return f"{named} and its free folds" if free else named


def _lie(folds: list[Edge], free: bool) -> str:
    return "lie" if free or len(folds) > 1 else "lies"


def _any_letters(fan: Fan, given: str, moving: list[int]) -> bool:
    """Whether all folds with a letter can move together, with whatever letters."""
    if not moving:
        return True
    for toe in range(len(given)):
        if given[toe] != "F":
            letters = ["M" if x in _FLIPPED else x for x in given]
            letters[toe] = "V"
            if fan.folds(letters):
                return True
    return fan.folds(["M" if x in _FLIPPED else x for x in given])


def _geometry_text(star: Star, moving: Iterable[Edge]) -> str:
    """Why folds cannot move with any letters, where these are all that are not held flat."""
    count, fan = len(star.folds), Fan(star)
    if count < 2:
        return "a vertex with a single fold cannot fold" if count else "all its folds are held flat"
    for k in range(count):
        following = (k + 1) % count
        if fan.reach[k] == 0:
            sector = degrees(angle_between(star.directions[k], star.directions[following]))
            where = f"between folds {_named((star.folds[k], star.folds[following]), ' and ')}"
            if fan.opposite[k] is None:
                return f"the sector {where} has {sector:.4g} degrees, more than 180"
            return (
                f"the sector {where} has 180 degrees, so that only these two can move, which form "
                "a straight crease"
            )
    if count == 3:
        return "three folds with sectors smaller than 180 degrees cannot move"
    if count == 4 and None not in fan.opposite:
        return "its folds form two straight lines, which cannot move at the same time"
    return f"the folds {_named(moving)} cannot move together while the others stay flat"


def _open_text(star: Star, pairs: tuple[_Pair, ...], starts: bool) -> str:
    pair = pairs[0]
    folds = _named((star.folds[pair.one], star.folds[pair.other]), " and ")
    written, straight = ("starts", "does not") if starts else ("does not start", "does")
    return (
        f"folds {folds} miss a straight line by {degrees(pair.off):.1g} degrees: the vertex "
        f"{written} to fold as it is written, and with a straight line it {straight}"
    )


def _nearby_text(box: Box, starts: bool, reason: str) -> str:
    written = "it starts to fold" if starts else f"it does not start to fold: {reason}"
    return f"as written {written}; this is not proved for every {box.text}"


def _named(folds: Iterable[Edge], separator: str = ", ") -> str:
    return separator.join(f"{i}-{j}" for i, j in folds)
