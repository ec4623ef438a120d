"""Sign vectors whose branch a run did not prove: collected, grouped, and put into words."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from exactfold._support.plurals import agreeing, counted
from exactfold.branches.counting.conveyor import Conveyor
from exactfold.branches.values.blocks import OpenEnd, ProvedBlock

MOST_LISTED = 1000


@dataclass(frozen=True)
class OpenRoot:
    """A sign vector whose branch was not proved, as text over the foldable vertices, and why.

    `limit` has 0 in place of the signs of vertices that look flat at the end of the path: paths
    with the same `limit` seem to end at one point. Nothing of this is proved.
    """

    signs: str
    reason: str
    limit: str


def open_root(conveyor: Conveyor, number: int, end: OpenEnd) -> OpenRoot:
    """The open end of a path by its number."""
    signs = "".join("+-"[number >> k & 1] for k in range(conveyor.size))
    limit = "".join("0" if k in end.flat else sign for k, sign in enumerate(signs))
    return OpenRoot(signs, end.reason, limit)


def by_limit(roots: Sequence[OpenRoot]) -> dict[str, list[OpenRoot]]:
    """The open roots whose paths seem to meet others, by the sign vector they share there."""
    found: dict[str, list[OpenRoot]] = {}
    for root in roots:
        if "0" in root.limit:
            found.setdefault(root.limit, []).append(root)
    return found


class Tally:
    """Sums over the blocks of a run; of open roots the first ones are kept."""

    def __init__(self) -> None:
        self.open_roots: list[OpenRoot] = []
        self.unproved = self.exact = self.steps = 0
        self.seconds: Counter[str] = Counter()

    def add(self, conveyor: Conveyor, block: ProvedBlock) -> None:
        """Count one block."""
        self.exact += len(block.exact)
        self.unproved += len(block.open)
        self.steps += block.steps
        self.seconds.update(block.seconds)
        for j, end in block.open.items():
            if len(self.open_roots) < MOST_LISTED:
                number = block.index * conveyor.block_size + j
                self.open_roots.append(open_root(conveyor, number, end))

    def culprits(self, foldable: Sequence[int]) -> str:
        """What keeps the open sign vectors from being proved; `foldable` names their vertices."""
        zeros = {k for root in self.open_roots for k, s in enumerate(root.limit) if s == "0"}
        if not zeros:
            return "for each other the reason is below"
        flat = ", ".join(str(foldable[k]) for k in sorted(zeros))
        noun, verb = agreeing(len(zeros), "vertex"), agreeing(len(zeros), "looks")
        return f"on the others {noun} {flat} {verb} flat"

    def questions(self) -> Iterator[str]:
        """Groups of sign vectors that seem to meet, then what is open by itself."""
        for limit, group in by_limit(self.open_roots).items():
            signs = ", ".join(root.signs for root in group[:8])
            more = f" and {len(group) - 8} more" if len(group) > 8 else ""
            yield f"sign vectors {signs}{more} seem to meet at {limit}: {group[0].reason}"
        for root in self.open_roots:
            if "0" not in root.limit:
                yield f"sign vector {root.signs}: {root.reason}"
        if (rest := self.unproved - len(self.open_roots)) > 0:
            yield f"{counted(rest, 'more sign vector')}, not listed"
