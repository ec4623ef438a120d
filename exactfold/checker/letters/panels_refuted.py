"""Case distinctions that show that no motion of rigid panels has given letters.

At each vertex a motion to second order lies in one of the two closed nappes of the form, and on one
of its lines if the vertex has at most four folds. Each case ends in one of these contradictions
(docs/assignment.md, Theorem 1 and Theorem 3): heights of stars whose sums contradict the letters; a
star that is curved; a vertex that cannot have its letters (`vertices`); a loop round which the
densities do not fit; sets of folds that exclude all spaces of motions (`panels_spaces`); or a fold
that has a letter but stays flat.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from ..core.reading import integer, items, keys, natural, parse_rational, require
from ..core.towers import Number
from ..panels.lines import Line, lines_at
from ..panels.loops import MOST_ORDER, Loops
from ..panels.modes import Modes, corners_of, name
from ..sheets.panels import Edge, Near, PanelSheet, Vector, cross, pair, read_edges
from .panels_spaces import Exclusion
from .vertices import can_fold

SIDES = {"V": 1, "M": -1}
Signs = dict[int, int]
Way = tuple[int | None, dict[int, int]]
"""The number of a line of motions of a vertex, None if it rests, and the sides of its folds.

The sides are {neighbour: 1 for a valley, -1 for a mountain, 0 for flat}.
"""


@dataclass
class State:
    """One case: the signs of some vertices, the lines of some vertices, the sides of some folds."""

    signs: Signs = field(default_factory=dict)
    lines: dict[int, Any] = field(default_factory=dict)
    sides: dict[Edge, int] = field(default_factory=dict)


class Cases:
    """The case distinctions for one sheet and its letters.

    If `true`, they refute only true motions. If `truly`, they have to refute true motions as well.
    """

    def __init__(
        self,
        sheet: PanelSheet,
        near: Near,
        wanted: Mapping[Edge, str],
        *,
        true: bool,
        truly: bool = True,
    ) -> None:
        self.sheet, self.near, self.wanted = sheet, near, wanted
        self.true, self.truly = true, truly
        self.live = {pair(v, u) for v, around in near.items() for u in around}
        self._lines: dict[int, list[Line]] = {}

    def cover(self, refuted: list[Any], tree: list[Any]) -> bool:
        """Verify that all cases end in contradictions; say whether this excludes true motions too.

        It does if all vertices that the steps name have at most four folds, or if they name only
        one vertex: a vertex without motions to second order has no configurations near the flat
        state (docs/vertices.md, Theorem 1). It does as well if all cases are refuted by sums that
        are not 0 at any fold of these vertices: the terms of lowest order of a true motion are a
        motion in which each fold follows its letter or is flat, and some fold is not. For the same
        reason one step about the spaces of motions does if 0 is the only such motion in them. A
        step about a fold that stays flat names no vertex.
        """
        sets = [self._refuted(entry, f"refuted set {k}") for k, entry in enumerate(refuted)]
        stack = [State()]
        named: set[int] = set()
        sums: list[set[Edge]] = []
        only_sums, still = True, False
        for step in tree:
            state = stack.pop()
            kind, *at = items(step, "a step")
            only_sums = only_sums and kind in ("split", "refuted")
            if kind == "split":
                (v,) = (natural(v, "a vertex") for v in at)
                stack += [State(state.signs | {v: s}, state.lines, state.sides) for s in (-1, 1)]
            elif kind == "refuted":
                (k,) = at
                signs, vertices, strict = sets[natural(k, "a set")]
                contained = signs.items() <= state.signs.items()
                require(contained, f"the signs of set {k} are not among those of the case")
                named |= vertices
                sums.append(strict)
            elif kind == "curved":
                (v,) = (natural(v, "a vertex") for v in at)
                own = {self.wanted[pair(v, u)] for u in self.near[v]}
                curved = len(self.near[v]) > 3 and own in ({"M"}, {"V"})
                require(curved, f"the letters round vertex {v} do not show that its star is curved")
                named.add(v)
            elif kind == "vertex":
                (v,) = (natural(v, "a vertex") for v in at)
                text = "".join(self.wanted[pair(v, u)] for u in self.near[v])
                stuck = not {"M", "V"}.isdisjoint(text) and not can_fold(
                    [self.sheet.vector(v, u) for u in self.near[v]], text
                )
                require(stuck, f"vertex {v} can have its letters")
                named.add(v)
            elif kind == "at":
                (v,) = (natural(v, "a vertex") for v in at)
                named.add(v)
                stack += self._chosen(state, v)
            elif kind == "loop":
                self._check_loop(state, *at)
            elif kind == "spaces":
                exclusion = self._exclusion(*at)
                require(exclusion.shown(), "the sets of folds do not exclude all spaces of motions")
                named |= exclusion.spaces.near.keys()
                still = len(tree) == 1 and self.truly and exclusion.still()
            else:
                require(kind == "flat", f"a step of the tree is {kind!a}")
                i, j = (natural(v, "a vertex") for v in at)
                flat = (i, j) not in self.live and not self.sheet.boundary_set.issuperset((i, j))
                held = flat and self.wanted[i, j] in SIDES
                require(held, f"fold {i}-{j} may fold, or is not asked to fold")
        require(not stack, "the tree does not cover all cases")
        few = all(len(self.near[v]) <= 4 for v in named)
        folds = {pair(v, u) for v in named for u in self.near[v]}
        strict_sums = only_sums and all(folds <= strict for strict in sums)
        return few or len(named) == 1 or strict_sums or still

    # --- lines of vertices -----------------------------------------------------------------------

    def _at(self, v: int) -> list[Line]:
        if v not in self._lines:
            self._lines[v] = lines_at(self.sheet, v, self.near[v])
        return self._lines[v]

    def _chosen(self, state: State, v: int) -> list[State]:
        """The cases of a vertex, one for each of its ways that agree with the case and the letters.

        They are in reverse order, because the next step takes the last one. A vertex has lines of
        motions only if it has two or four folds.
        """
        cases = []
        for line, sides in ways(self._at(v), self.near[v]):
            folds = {pair(v, u): side for u, side in sides.items()}
            if all(
                side == state.sides.get(fold, side) and fits(self.wanted[fold], side)
                for fold, side in folds.items()
            ):
                lines = {**state.lines, v: line}
                cases.append(State(state.signs, lines, {**state.sides, **folds}))
        return cases[::-1]

    def _check_loop(self, state: State, value: Any, order: Any = None) -> None:
        """Raise unless densities do not fit round a loop.

        If an order is given: unless the fold angles do not fit at this order.
        """
        loop = tuple(natural(v, "a vertex") for v in items(value, "a loop"))
        lines: dict[int, int] = {v: state.lines[v] for v in loop}
        modes = Modes(self.sheet, {v: self.near[v] for v in lines})
        if order is None:
            require(not modes.closes(loop, lines), f"the loop {name(loop)} closes")
            return
        for _, before, after in corners_of(loop):
            require(before != after, f"the loop {name(loop)} turns back")
        require(self.true, "a loop that fails at a higher order refutes only true motions")
        require(3 <= natural(order, "order") <= MOST_ORDER, f"there is no order {order}")
        fails = Loops(modes).fails(lines, loop, order)
        require(fails, f"the loop {name(loop)} is not proved to fail at order {order}")

    def _exclusion(self, vertices: Any, sets: Any) -> Exclusion:
        """The sets of folds of a step, all of which have letters, for the vertices of the step."""
        own = sorted({natural(v, "a vertex") for v in items(vertices, "vertices")})
        sides = {fold: SIDES[letter] for fold, letter in self.wanted.items() if letter in SIDES}
        folds = [read_edges(some, "a set of folds") for some in items(sets, "sets")]
        return Exclusion(self.sheet, {v: self.near[v] for v in own}, sides, folds)

    # --- heights of stars ------------------------------------------------------------------------

    def _refuted(self, entry: Any, what: str) -> tuple[Signs, set[int], set[Edge]]:
        """Verify that no motion with the letters has the signs of an entry.

        Returns the signs, all vertices whose stars the proof uses, and the folds whose sums are not
        0.
        """
        keys(entry, "signs planes heights", what)
        signs: Signs = {}
        for v, sign in items(entry["signs"], "signs"):
            signs[natural(v, "a vertex")] = integer(sign)  # a case only has the signs 1 and -1
        heights: dict[int, dict[int, Number]] = {}
        for v, values in items(entry["planes"], "planes"):
            y, near = numbers(self.sheet, values, 2), self.near[natural(v, "a vertex")]
            heights[v] = {u: _product(y, self.sheet.vector(v, u)) for u in near}
        for v, values in items(entry["heights"], "heights"):
            around = sorted(self.near[natural(v, "a vertex")])
            heights[v] = dict(zip(around, numbers(self.sheet, values, len(around)), strict=True))
            self._check_nappe(v, signs[v], heights[v], what)
        strict: set[Edge] = set()
        for i, j in sorted({pair(v, u) for v, star in heights.items() for u in star}):
            zero = self.sheet.tower.number(0)
            total = heights.get(i, {}).get(j, zero) + heights.get(j, {}).get(i, zero)
            side, letter = total.sign(), self.wanted[i, j]
            agrees = side in (0, -SIDES.get(letter, 0))
            require(agrees, f"{what}: the sum at fold {i}-{j} has the wrong sign")
            if side:
                strict.add((i, j))
        require(bool(strict), f"{what}: no fold contradicts its letter")
        return signs, {*heights}, strict

    def _check_nappe(self, v: int, sign: int, star: Mapping[int, Number], what: str) -> None:
        """Raise unless the form of a star is not negative, and its nappe has the right sign.

        The gradient is constant between two folds, and the form is twice the signed area of the
        polygon of gradients. Positive weights of the folds with sum_k weight_k d_k = 0 are the
        densities of a star that is pushed down, with the opposite sign.
        """
        around = self.near[v]
        spokes = [(self.sheet.vector(v, u), star[u]) for u in around]
        gradients = [
            _gradient(*a, *b) for a, b in zip(spokes, spokes[1:] + spokes[:1], strict=True)
        ]
        area = self.sheet.tower.number(0)
        for before, after in zip(gradients[-1:] + gradients[:-1], gradients, strict=True):
            area = area + cross(before, after)
        require(area.sign() >= 0, f"{what}: K is negative at vertex {v}")
        side = self.sheet.tower.number(0)
        for (_, height), weight in zip(spokes, _weights([d for d, _ in spokes]), strict=True):
            side = side + weight * height
        require(sign * side.sign() <= 0, f"{what}: the star of {v} does not have the sign {sign}")


def numbers(sheet: PanelSheet, values: Any, length: int) -> list[Number]:
    """Read numbers in the field of the sheet, given by their coefficients."""
    return [
        Number(sheet.tower, tuple(map(parse_rational, items(x, "a number", sheet.tower.size))))
        for x in items(values, "numbers", length)
    ]


def ways(lines: Sequence[Line], near: Iterable[int]) -> list[Way]:
    """All ways in which a vertex can move: at rest, or along one of its lines in either direction.

    They are sorted by the sides of the folds, with the neighbours in increasing order.
    """
    around = sorted(near)
    moves: list[Way] = [(None, dict.fromkeys(around, 0))]
    for k, line in enumerate(lines):
        sides = {u: line.densities[u].sign() if u in line.densities else 0 for u in around}
        moves += [(k, sides), (k, {u: -side for u, side in sides.items()})]
    return sorted(moves, key=lambda way: tuple(way[1].values()))


def fits(letter: str, side: int) -> bool:
    """Whether a fold with this side (0 if it is flat) agrees with the letter."""
    return letter == "U" or side == SIDES.get(letter, 0)


def _product(y: list[Number], d: Vector) -> Number:
    return y[0] * d[0] + y[1] * d[1]


def _gradient(a: Vector, at_a: Number, b: Vector, at_b: Number) -> Vector:
    """The vector g with the given products g . a and g . b."""
    size = cross(a, b)
    return (at_a * b[1] - at_b * a[1]) / size, (at_b * a[0] - at_a * b[0]) / size


def _weights(d: list[Vector]) -> list[Number]:
    """Positive weights with sum_k weight_k d_k = 0, if all sectors are less than pi.

    Each -d_k is a sum of the two neighbouring directions between which it lies, with weights >= 0.
    All these equations are added up.
    """
    weights = [x.tower.number(1) for x, _ in d]
    for x, y in d:
        back = (-x, -y)
        for i in range(len(d)):
            j = (i + 1) % len(d)
            first, second = cross(back, d[j]), cross(d[i], back)
            if first.sign() >= 0 and second.sign() > 0:
                size = cross(d[i], d[j])
                weights[i], weights[j] = weights[i] + first / size, weights[j] + second / size
                break
    return weights
