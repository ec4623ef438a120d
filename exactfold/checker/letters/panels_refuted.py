"""Case distinctions that show that no motion of rigid panels has given letters.

Motions to second order lie at each vertex in one of the two closed nappes of its form, and at a
vertex with at most four folds on one of its lines. Each case ends in one of these contradictions
(docs/assignment.md, Theorem 4 and Theorem 5): heights of stars whose sums are on the wrong side, a
star that is curved, a loop round which densities do not fit, or a fold with a letter that stays
flat.
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
from ..sheets.panels import Edge, Near, PanelSheet, Vector, cross, pair

SIDES = {"V": 1, "M": -1}
Signs = dict[int, int]
Way = tuple[int | None, dict[int, int]]
"""A line of motions of a vertex, None if it rests, and the side of the fold to each neighbour."""


@dataclass
class State:
    """One case: signs of vertices, lines of vertices, and the sides to which folds go."""

    signs: Signs = field(default_factory=dict)
    lines: dict[int, Any] = field(default_factory=dict)
    sides: dict[Edge, int] = field(default_factory=dict)


class Cases:
    """The case distinctions for one sheet and its letters; for true motions alone if `true`."""

    def __init__(
        self, sheet: PanelSheet, near: Near, wanted: Mapping[Edge, str], *, true: bool
    ) -> None:
        self.sheet, self.near, self.wanted, self.true = sheet, near, wanted, true
        self.live = {pair(v, u) for v, around in near.items() for u in around}
        self._lines: dict[int, list[Line]] = {}

    def cover(self, refuted: list[Any], tree: list[Any]) -> bool:
        """Verify that all cases end; whether true motions with the letters are excluded as well.

        That is so if all vertices that are named have at most four folds, or a fold that stays
        flat has a letter.
        """
        sets = [self._refuted(entry, f"refuted set {k}") for k, entry in enumerate(refuted)]
        stack = [State()]
        named: set[int] = set()
        for step in tree:
            state = stack.pop()
            kind, *at = items(step, "a step")
            if kind == "split":
                (v,) = (natural(v, "a vertex") for v in at)
                stack += [State(state.signs | {v: s}, state.lines, state.sides) for s in (-1, 1)]
            elif kind == "refuted":
                (k,) = at
                signs, vertices = sets[natural(k, "a set")]
                contained = signs.items() <= state.signs.items()
                require(contained, f"set {k} is not contained in the signs")
                named |= vertices
            elif kind == "curved":
                (v,) = (natural(v, "a vertex") for v in at)
                own = {self.wanted[pair(v, u)] for u in self.near[v]}
                curved = len(self.near[v]) > 3 and own in ({"M"}, {"V"})
                require(curved, f"the star of {v} may be on a motion")
                named.add(v)
            elif kind == "at":
                (v,) = (natural(v, "a vertex") for v in at)
                named.add(v)
                stack += self._chosen(state, v)
            elif kind == "loop":
                self._check_loop(state, *at)
            else:
                require(kind == "flat", f"a step of the tree is {kind!a}")
                i, j = (natural(v, "a vertex") for v in at)
                flat = (i, j) not in self.live and not self.sheet.boundary_set.issuperset((i, j))
                held = flat and self.wanted[i, j] in SIDES
                require(held, f"fold {i}-{j} may fold, or has no letter")
        require(not stack, "the tree does not cover all cases")
        few = all(len(self.near[v]) <= 4 for v in named)
        return few

    # --- lines of vertices -----------------------------------------------------------------------

    def _at(self, v: int) -> list[Line]:
        if v not in self._lines:
            self._lines[v] = lines_at(self.sheet, v, self.near[v])
        return self._lines[v]

    def _chosen(self, state: State, v: int) -> list[State]:
        """The cases of a vertex, one for each of its ways that fit; the last is the first to do.

        There are lines of motions only where there are two or four folds.
        """
        found = []
        for line, sides in ways(self._at(v), self.near[v]):
            folds = {pair(v, u): side for u, side in sides.items()}
            if all(
                side == state.sides.get(fold, side) and fits(self.wanted[fold], side)
                for fold, side in folds.items()
            ):
                lines = {**state.lines, v: line}
                found.append(State(state.signs, lines, {**state.sides, **folds}))
        return found[::-1]

    def _check_loop(self, state: State, value: Any, order: Any = None) -> None:
        """Densities do not fit round a loop; or fold angles do not, at this order of them."""
        loop = tuple(natural(v, "a vertex") for v in items(value, "a loop"))
        lines: dict[int, int] = {v: state.lines[v] for v in loop}
        modes = Modes(self.sheet, {v: self.near[v] for v in lines})
        if order is None:
            require(not modes.closes(loop, lines), f"the loop {name(loop)} closes")
            return
        for _, before, after in corners_of(loop):
            require(before != after, f"the loop {name(loop)} turns back")
        require(self.true, "a loop that fails at a higher order refutes true motions alone")
        require(3 <= natural(order, "order") <= MOST_ORDER, f"there is no order {order}")
        fails = Loops(modes).fails(lines, loop, order)
        require(fails, f"the loop {name(loop)} is not seen to fail at order {order}")

    # --- heights of stars ------------------------------------------------------------------------

    def _refuted(self, entry: Any, what: str) -> tuple[Signs, set[int]]:
        """The signs of an entry that no motion with the letters has, and all its vertices."""
        keys(entry, "signs planes heights", what)
        signs: Signs = {}
        for v, sign in items(entry["signs"], "signs"):
            signs[natural(v, "a vertex")] = integer(sign)  # those of a case are 1 and -1 only
        heights: dict[int, dict[int, Number]] = {}
        for v, values in items(entry["planes"], "planes"):
            y, near = numbers(self.sheet, values, 2), self.near[natural(v, "a vertex")]
            heights[v] = {u: _product(y, self.sheet.vector(v, u)) for u in near}
        for v, values in items(entry["heights"], "heights"):
            around = sorted(self.near[natural(v, "a vertex")])
            heights[v] = dict(zip(around, numbers(self.sheet, values, len(around)), strict=True))
            self._check_nappe(v, signs[v], heights[v], what)
        strict = False
        for i, j in sorted({pair(v, u) for v, star in heights.items() for u in star}):
            zero = self.sheet.tower.number(0)
            total = heights.get(i, {}).get(j, zero) + heights.get(j, {}).get(i, zero)
            side, letter = total.sign(), self.wanted[i, j]
            agrees = side in (0, -SIDES.get(letter, 0))
            require(agrees, f"{what}: the sum at fold {i}-{j} is on the wrong side")
            strict = strict or side != 0
        require(strict, f"{what}: no fold contradicts its letter")
        return signs, {*heights}

    def _check_nappe(self, v: int, sign: int, star: Mapping[int, Number], what: str) -> None:
        """The form is not negative, and the star is on the side of its sign.

        The gradient is constant between two folds, and twice the signed area of the polygon of
        gradients is the form. Positive weights of the folds without a sum are the densities of a
        star that is pushed down, turned round.
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
        require(sign * side.sign() <= 0, f"{what}: the star of {v} is on the other side")


def numbers(sheet: PanelSheet, values: Any, length: int) -> list[Number]:
    """Numbers in the field of the sheet, from their coefficients."""
    return [
        Number(sheet.tower, tuple(map(parse_rational, items(x, "a number", sheet.tower.size))))
        for x in items(values, "numbers", length)
    ]


def ways(lines: Sequence[Line], near: Iterable[int]) -> list[Way]:
    """All ways of a vertex to move: at rest, and both sides of each line, by the sides of folds.

    Their order is that of these sides, the neighbours taken by number.
    """
    around = sorted(near)
    found: list[Way] = [(None, dict.fromkeys(around, 0))]
    for k, line in enumerate(lines):
        sides = {u: line.densities[u].sign() if u in line.densities else 0 for u in around}
        found += [(k, sides), (k, {u: -side for u, side in sides.items()})]
    return sorted(found, key=lambda way: tuple(way[1].values()))


def fits(letter: str, side: int) -> bool:
    """Whether a fold that goes to this side, or not at all, has the letter."""
    return letter == "U" or side == SIDES.get(letter, 0)


def _product(y: list[Number], d: Vector) -> Number:
    return y[0] * d[0] + y[1] * d[1]


def _gradient(a: Vector, at_a: Number, b: Vector, at_b: Number) -> Vector:
    """g with g . a and g . b given."""
    size = cross(a, b)
    return (at_a * b[1] - at_b * a[1]) / size, (at_b * a[0] - at_a * b[0]) / size


def _weights(d: list[Vector]) -> list[Number]:
    """Positive weights with sum_k weight_k d_k = 0, all sectors being less than pi.

    Each -d_k lies between two neighbouring directions: it is added with these.
    """
    found = [x.tower.number(1) for x, _ in d]
    for x, y in d:
        back = (-x, -y)
        for i in range(len(d)):
            j = (i + 1) % len(d)
            first, second = cross(back, d[j]), cross(d[i], back)
            if first.sign() >= 0 and second.sign() > 0:
                size = cross(d[i], d[j])
                found[i], found[j] = found[i] + first / size, found[j] + second / size
                break
    return found
