"""Boxes that hold one zero each, and the proof that 2^n of them hold all zeros of n quadrics."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple, Protocol

from ..core.krawczyk import Krawczyk
from ..core.limits import MOST_BITS
from ..core.reading import at_most, items, keys, natural, parse_integer, require, text_of
from .equations import BranchSystem


class Root(Protocol):
    """A proved real zero of the branch system."""

    @property
    def kind(self) -> object:
        """How the zero is listed.

        The evidence itself shows that zeros of one kind differ. Two zeros of different kinds are
        proved to differ only by their signs.
        """

    def sign(self, row: Sequence[int]) -> int | None:
        """The sign at the zero of c_1 x_1 + ... + c_n x_n + c_0, with row = (c_1, ..., c_n, c_0).

        0 if the functional is proved to vanish, None if its sign is open.
        """


class Box(NamedTuple):
    """The box |x - center / 2^bits| <= radius / 2^bits."""

    center: list[int]
    radius: int
    bits: int

    @property
    def kind(self) -> object:
        """Every box in the unknowns of the system has the same kind."""
        return "box"

    def sign(self, row: Sequence[int]) -> int | None:
        """1 or -1 if the functional has this sign on the whole box, 0 if it is 0, else None."""
        value = row[-1] << self.bits
        reach = 0
        for c, m in zip(row, self.center, strict=False):  # the last entry of row is its constant
            value += c * m
            reach += abs(c)
        reach *= self.radius
        if abs(value) > reach:
            return 1 if value > 0 else -1
        return 0 if value == reach == 0 else None


def read_box(entry: Any, size: int) -> Box:
    """Read a box in `size` unknowns; that it holds a zero must still be shown by `Krawczyk`."""
    keys(entry, "bits radius center", "root")
    bits = natural(entry["bits"], "bits")
    at_most(bits, MOST_BITS, "the bits of a box", "MOST_BITS")
    radius = parse_integer(short(entry["radius"]))
    require(radius > 0, "the radius is not positive")
    return Box(
        [parse_integer(short(m)) for m in items(entry["center"], "center", size)], radius, bits
    )


def short(value: Any) -> str:
    """Return `value` if it is a string of bounded length."""
    text = text_of(value)
    at_most(len(text), MOST_BITS, "the digits of a number of a box", "MOST_BITS")
    return text


def check_disjoint(boxes: list[Box]) -> None:
    """Raise if two boxes meet.

    A fixed functional takes an interval of values on each box. The boxes are sorted by these
    intervals, and two boxes are compared only if their intervals overlap.
    """
    top = max((box.bits for box in boxes), default=0)
    keyed = []
    for index, box in enumerate(boxes):
        weights = [2 * k * k + 3 * k + 5 for k in range(len(box.center))]
        value = sum(w * m for w, m in zip(weights, box.center, strict=True)) << (top - box.bits)
        reach = box.radius * sum(weights) << (top - box.bits)
        keyed.append((value - reach, value + reach, index))
    active: list[tuple[int, int]] = []
    for low, high, index in sorted(keyed):
        active = [(end, other) for end, other in active if end >= low]
        for _, other in active:
            a, b = boxes[index], boxes[other]
            reach = (a.radius << (top - a.bits)) + (b.radius << (top - b.bits))
            require(
                any(
                    abs((x << (top - a.bits)) - (y << (top - b.bits))) > reach
                    for x, y in zip(a.center, b.center, strict=True)
                ),
                "two boxes meet",
            )
        active.append((high, index))


def check_isolated(system: BranchSystem, evidence: Any) -> list[tuple[Root, int]]:
    """All zeros of the system, as a list of (root, multiplicity).

    Krawczyk's test shows that each box holds one zero, and the boxes are disjoint. By refined
    Bezout 2^n such boxes hold all zeros.
    """
    keys(evidence, "kind triangles chart roots", "evidence")
    boxes = [read_box(entry, system.size) for entry in items(evidence["roots"], "roots")]
    if system.size:
        test = Krawczyk(system)
        for box in boxes:
            test.check(box.center, box.radius, box.bits)
        check_disjoint(boxes)
    require(len(boxes) == 1 << system.size, f"{len(boxes)} roots, not 2^{system.size}")
    return [(box, 1) for box in boxes]
