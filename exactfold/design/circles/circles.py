"""All mountain-valley assignments of a convex sheet with five boundary vertices, by circles.

For each sign vector, the solutions up to a positive factor form a circle; the direction of the
boundary heights is the angle on it (docs/any_border.md, Theorem 13). Along a circle the letters
change only where a fold is flat. All such places are computed exactly, fold by fold, and sorted.
Between two neighbouring places one branch is proved.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise, product

from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches.counting.find import BranchFinder
from exactfold.branches.values.letters import SIGNS, UPSIDE_DOWN
from exactfold.design.circles.assignment_list import AllAssignments, Arc, Circle, Crossing
from exactfold.design.circles.covering import NotCoveredError, covering, verified
from exactfold.errors import NotCountedError
from exactfold.exact.univariate import Interval
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.loading import PatternLike, as_pattern
from exactfold.rigidity.equations.branch_system import BranchSystem, Chart
from exactfold.rigidity.equations.flat_sheets import FlatSheets, flat_sheets
from exactfold.rigidity.functionals import fold_functional, vertex_sign_functional
from exactfold.solve.algebraic.exact_solution import RootClass
from exactfold.solve.algebraic.groebner_bases import groebner

MOST_FOLDABLE = 6
"""Assignments are listed for sheets on which at most this many vertices can pop."""
_MOST_SOLVED = 5
_CHARTS = ((1, 0), (3, 1), (2, 5), (-4, 3))
_BITS = 64
_MOST_BITS = 1 << 14


def all_assignments(pattern: PatternLike, *, progress: Progress | None = None) -> AllAssignments:
    """Every mountain-valley assignment with which a sheet with five corners can start to fold.

    For each fold f the system {K_v = 0 for all v, f flat} is solved exactly in projective space.
    All its zeros are found, because their number with multiplicity is 2^n. The real zeros are
    sorted along the circles. Between two neighbours no fold is flat, so that one branch there shows
    the letters (docs/any_border.md, Theorem 13).

    Where folds are flat along whole arcs, or more than five vertices can pop, the circles are
    covered by points instead, and the stand-alone checker verifies that the points show all
    assignments (Theorem 14). If neither method succeeds, the status is UNDECIDED. Raises
    `NotCountedError` unless the boundary is convex and has five vertices (D = 2), and from one to
    six vertices can pop.

    >>> from exactfold.pattern.families import single_vertex
    >>> listed = all_assignments(single_vertex(5))
    >>> listed.circles, len(listed.assignments)
    ((<Circle -: 10 arcs>, <Circle +: 10 arcs>), 20)
    """
    given = as_pattern(pattern)
    if given.Ve != 5 or not given.is_convex:
        raise NotCountedError(
            "all assignments are listed only if the boundary is convex and has five vertices; this "
            f"boundary has {given.Ve}"
            + ("" if given.is_convex else f", and vertex {given.reflex_corner} is reflex")
        )
    sheet, _ = given.without_rigid_parts()
    if not sheet.interior:
        raise NotCountedError(
            "no vertex of this sheet can pop, so every crease may be a mountain or a valley"
        )
    if sheet.Vi > MOST_FOLDABLE:
        raise NotCountedError(
            f"{sheet.Vi} vertices can pop; all assignments are listed only if at most "
            f"{MOST_FOLDABLE} can"
        )
    listed = None
    if sheet.Vi <= _MOST_SOLVED:
        listed = _CircleSearch(given, progress).found()
        if listed.status is PROVED:
            return listed
    try:
        points = covering(given, progress)
        verified(given, points)
    except NotCoveredError as error:
        reason = f"{listed.reason}; " if listed is not None else ""
        return AllAssignments(given, UNDECIDED, f"{reason}{error}", ())
    return AllAssignments(given, PROVED, "", (), points)


@dataclass(frozen=True)
class _Event:
    """A real zero: the folds that are flat there, the signs of the vertices (0 where flat), its
    slope.
    """

    zeros: RootClass
    row: tuple[Fraction, ...]
    place: int
    folds: tuple[Edge, ...]
    signs: tuple[int, ...]

    def slope(self, bits: int) -> Interval:
        """Bounds of mu / lambda, the direction of the boundary heights in the chart lambda = 1."""
        return _value(self.zeros, self.row, self.place, bits)


class _UndecidedError(Exception):
    """Something could not be decided; the text says what."""


class _CircleSearch:
    def __init__(self, pattern: CreasePattern, progress: Progress | None) -> None:
        self.pattern, self.progress = pattern, progress
        self.sheet, self.labels = pattern.without_rigid_parts()
        self.system = BranchSystem(self.sheet)
        self.free = tuple(v for v in self.system.variables if v in self.sheet.boundary)

    def found(self) -> AllAssignments:
        """The list of all assignments, or the reason why it is undecided."""
        reason = "no chart was found without zeros at infinity"
        for form in _CHARTS:
            try:
                events = list(self._events(form))
            except _AtInfinityError:
                continue
            except _UndecidedError as error:
                reason = str(error)
                break
            try:
                return self._listed(form, events)
            except _UndecidedError as error:
                reason = str(error)
                break
        return AllAssignments(self.pattern, UNDECIDED, reason, ())

    # --- where folds are flat --------------------------------------------------------------------

    def _events(self, form: tuple[int, int]) -> Iterator[_Event]:
        """All real points in the chart at which some fold is flat, each point once."""
        first, second = self.free
        functional = {v: Fraction(c) for v, c in zip(self.free, form, strict=True) if c}
        chart = Chart(self.system, functional, first if form[0] else second)
        for k, fold in enumerate(self.sheet.folds):
            if self.progress is not None:
                self.progress("folds", k, len(self.sheet.folds))
            section = flat_sheets(chart, folds=[fold])
            if section is None:
                raise _AtInfinityError  # the fold is flat where lambda = 0
            if section.system is None:
                raise _UndecidedError(f"fold {self._name(fold)} is flat on a whole family")
            solution = groebner(section.system)
            if solution.dimension is None:
                raise _UndecidedError(f"fold {self._name(fold)} is flat on a whole family")
            if solution.dimension != section.system.bezout_number:
                raise _AtInfinityError
            for zeros in solution.classes:
                yield from self._real(section, fold, zeros, form)

    def _real(
        self, section: FlatSheets, fold: Edge, zeros: RootClass, form: tuple[int, int]
    ) -> Iterator[_Event]:
        """The real zeros of a class, if `fold` is the first of the folds that are flat on the
        class.
        """
        chart = section.chart
        rows = {
            f: section.restrict(chart.restrict(fold_functional(self.sheet, f)))
            for f in self.sheet.folds
        }
        flat = tuple(f for f in self.sheet.folds if zeros.vanishes(rows[f]))
        if fold != flat[0]:
            return
        bent = {v for f in self.sheet.folds if f not in flat for v in f}
        mu = dict(zip(self.free, _second(form), strict=True))
        row = tuple(section.restrict(chart.restrict(mu)))
        for place in range(len(zeros.real_roots(8))):
            signs = []
            for v in self.sheet.interior:
                if v not in bent:
                    signs.append(0)
                    continue
                functional = vertex_sign_functional(self.sheet, v)
                signs.append(_sign(zeros, section.restrict(chart.restrict(functional)), place))
            yield _Event(zeros, row, place, flat, tuple(signs))

    # --- circles ---------------------------------------------------------------------------------

    def _listed(self, form: tuple[int, int], events: list[_Event]) -> AllAssignments:
        circles: dict[tuple[int, ...], Circle] = {}
        count = self.sheet.Vi
        vectors = list(product((-1, 1), repeat=count))
        for k, signs in enumerate(vectors):
            if self.progress is not None:
                self.progress("circles", k, len(vectors))
            mirror = tuple(-s for s in signs)
            if mirror in circles:
                circles[signs] = _reversed(circles[mirror])
                continue
            circles[signs] = self._circle(form, signs, events)
        ordered = tuple(circles[signs] for signs in vectors)
        return AllAssignments(self.pattern, PROVED, "", ordered)

    def _circle(
        self, form: tuple[int, int], signs: tuple[int, ...], events: list[_Event]
    ) -> Circle:
        """One circle: first its half with lambda > 0, sorted by slope, then its half with lambda <
        0.

        A zero with signs e lies on the circle of e, and the opposite zero on the circle of -e. At a
        flat vertex either sign is allowed.
        """
        mirror = tuple(-s for s in signs)
        upper = _in_order(event for event in events if _fits(event.signs, signs))
        lower = _in_order(event for event in events if _fits(event.signs, mirror))
        # The arc after the last event of each half crosses lambda = 0.
        directions = [(Fraction(1), slope) for slope in _between(upper)]
        directions += [(Fraction(0), Fraction(1))] * bool(upper)
        directions += [(Fraction(-1), -slope) for slope in _between(lower)]
        directions += [(Fraction(0), Fraction(-1))] * bool(lower)
        whole = directions or [(Fraction(0), Fraction(1))]
        return Circle(
            "".join(SIGNS[s] for s in signs),
            tuple(self._arc(form, signs, direction) for direction in whole),
            tuple(self._crossing(event) for event, _ in (*upper, *lower)),
        )

    def _arc(
        self, form: tuple[int, int], signs: tuple[int, ...], direction: tuple[Fraction, Fraction]
    ) -> Arc:
        """The arc that contains the direction (lambda, mu) of the boundary heights."""
        (p, q), (x, y) = form, direction
        heights = dict.fromkeys(self.sheet.boundary, Fraction(0))
        heights |= dict(zip(self.free, (p * x - q * y, q * x + p * y), strict=True))
        largest = max(map(abs, heights.values()))
        boundary_heights = {self.labels[v]: height / largest for v, height in heights.items()}
        finder = BranchFinder(self.pattern, boundary_heights)
        branch = finder.find(dict(zip(finder.poppable, signs, strict=True)))
        folds = ((self.labels[i], self.labels[j]) for i, j in self.sheet.folds)
        if branch.status is not PROVED or any(branch.assignment[f] not in "MV" for f in folds):
            raise _UndecidedError(f"the branch {branch.sign_text} of an arc is not proved")
        return Arc(branch)

    def _crossing(self, event: _Event) -> Crossing:
        bent = {v for f in self.sheet.folds if f not in event.folds for v in f}
        return Crossing(
            tuple((self.labels[i], self.labels[j]) for i, j in event.folds),
            tuple(self.labels[v] for v in self.sheet.interior if v not in bent),
        )

    def _name(self, fold: Edge) -> str:
        return f"{self.labels[fold[0]]}-{self.labels[fold[1]]}"


class _AtInfinityError(Exception):
    """Some zeros lie at infinity of this chart."""


def _fits(signs: tuple[int, ...], wanted: tuple[int, ...]) -> bool:
    return all(s in (0, w) for s, w in zip(signs, wanted, strict=True))


def _in_order(events: Iterable[_Event]) -> list[tuple[_Event, Interval]]:
    """The events of one half of a circle sorted by slope, with disjoint bounds of the slopes.

    Two solutions with the same signs and the same boundary heights are equal (docs/branch.md,
    Theorem 5), so different events have different slopes.
    """
    chosen = list(events)
    bits = _BITS
    while bits <= _MOST_BITS:
        slopes = sorted(((event.slope(bits), k) for k, event in enumerate(chosen)))
        if all(a[1] < b[0] for (a, _), (b, _) in pairwise(slopes)):
            return [(chosen[k], slope) for slope, k in slopes]
        bits *= 2
    raise _UndecidedError("two places at which folds are flat are too close to be told apart")


def _between(ordered: list[tuple[_Event, Interval]]) -> list[Fraction]:
    """A fraction with a small denominator between each two neighbours."""
    return [simplest_between(a[1], b[0]) for (_, a), (_, b) in pairwise(ordered)]


def simplest_between(low: Fraction, high: Fraction) -> Fraction:
    """The fraction with the smallest denominator in the middle half of an interval.

    >>> simplest_between(Fraction(0), Fraction(3))
    Fraction(1, 1)
    """
    middle, reach = (low + high) / 2, (high - low) / 4
    denominator = 1
    while True:
        near = middle.limit_denominator(denominator)
        if abs(near - middle) <= reach:
            return near
        denominator *= 2


def _value(zeros: RootClass, row: Sequence[Fraction], place: int, bits: int) -> Interval:
    """Bounds of a functional at one real zero of a class.

    The zero comes from a root with at least `bits` bits.
    """
    while True:
        bounds = zeros.value_on(row, zeros.real_roots(bits)[place])
        if bounds is not None:
            return bounds
        bits *= 2


def _sign(zeros: RootClass, row: Sequence[Fraction], place: int) -> int:
    """The sign of a functional that does not vanish at a real zero."""
    bits = _BITS
    while True:
        low, high = _value(zeros, row, place, bits)
        if low > 0 or high < 0:
            return 1 if low > 0 else -1
        bits *= 2


def _second(form: tuple[int, int]) -> tuple[Fraction, Fraction]:
    """The coefficients of the functional mu that completes lambda to coordinates."""
    return Fraction(-form[1]), Fraction(form[0])


def _reversed(circle: Circle) -> Circle:
    """The circle of the opposite signs: all heights, signs and letters reversed."""
    return Circle(
        circle.signs.translate(UPSIDE_DOWN),
        tuple(Arc(arc.branch, not arc.mirrored) for arc in circle.arcs),
        circle.crossings,
    )
