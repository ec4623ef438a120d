"""Boxes with one zero each, and the proof that 2^n of them hold all zeros."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple, Protocol

from ..core.krawczyk import Krawczyk
from ..core.limits import MOST_BITS
from ..core.reading import at_most, items, keys, natural, parse_integer, require, text_of
from .equations import BranchSystem


class Root(Protocol):
    """A proved real zero; zeros of different kinds must be told apart by their signs."""

    @property
    def kind(self) -> object:
        """How the zero is listed: zeros of one kind are told apart by what shows them."""

    def sign(self, row: Sequence[int]) -> int | None:
        """Sign of the functional (c_1, ..., c_n, c_0); 0 if proved to vanish, None if open."""


class Box(NamedTuple):
    """A box |x - center / 2^bits| <= radius / 2^bits."""

    center: list[int]
    radius: int
    bits: int

    @property
    def kind(self) -> object:
        """A box in the unknowns of the system."""
        return "box"

    def sign(self, row: Sequence[int]) -> int | None:
        """1 or -1 if the functional keeps that sign on the box, 0 if it is 0, else None."""
        value = row[-1] << self.bits
        reach = 0
        for c, m in zip(row, self.center, strict=False):  # the row is longer by its constant
            value += c * m
            reach += abs(c)
        reach *= self.radius
        if abs(value) > reach:
            return 1 if value > 0 else -1
        return 0 if value == reach == 0 else None


def read_box(entry: Any, size: int) -> Box:
    """The box of an entry with `size` unknowns; that it holds a zero is for `Krawczyk` to show."""
    keys(entry, "bits radius center", "root")
    bits = natural(entry["bits"], "bits")
    at_most(bits, MOST_BITS, "the bits of a box", "MOST_BITS")
    radius = parse_integer(short(entry["radius"]))
    require(radius > 0, "the radius is not positive")
    return Box(
        [parse_integer(short(m)) for m in items(entry["center"], "center", size)], radius, bits
    )


def short(value: Any) -> str:
    """`value` if it is a string of bounded length."""
    text = text_of(value)
    at_most(len(text), MOST_BITS, "the digits of a number of a box", "MOST_BITS")
    return text


def check_disjoint(boxes: list[Box]) -> None:
    """No two boxes meet. Sorted by a fixed functional; compared only where values overlap."""
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
    """All zeros by Krawczyk and refined Bezout: a list of (root, multiplicity)."""
    keys(evidence, "kind triangles chart roots", "evidence")
    boxes = [read_box(entry, system.size) for entry in items(evidence["roots"], "roots")]
    if system.size:
        test = Krawczyk(system)
        for box in boxes:
            test.check(box.center, box.radius, box.bits)
        check_disjoint(boxes)
    require(len(boxes) == 1 << system.size, f"{len(boxes)} roots, not 2^{system.size}")
    return [(box, 1) for box in boxes]
