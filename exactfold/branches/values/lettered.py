"""Which of the listed branches have the letters of a file."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from exactfold._support.verdict import PROVED, UNDECIDED, Verdict
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.letters import UPSIDE_DOWN, differing
from exactfold.pattern.crease_pattern import Edge

if TYPE_CHECKING:
    from exactfold.branches.values.count_document import LetteredDocument, LetteredWay


@dataclass(frozen=True)
class Lettered:
    """The listed branches that have the letters of a file.

    `ways` are pairs of the place in the list, beginning with 1, and the side: 1 with the letters of
    the branch, -1 with all of them reversed. `status` is PROVED if there are no others. `unclear`
    are those that agree as far as is known but have an unknown letter.
    """

    status: Verdict
    ways: tuple[tuple[int, int], ...]
    unclear: tuple[tuple[int, int], ...] = ()

    def to_dict(self) -> LetteredDocument:
        """The key `letters` of `exactfold count --json`."""
        ways: list[LetteredWay] = [{"way": way, "side": side} for way, side in self.ways]
        return {"status": str(self.status), "ways": ways}


def lettered(branches: Iterable[Branch], letters: Mapping[Edge, str], all_listed: bool) -> Lettered:
    """Which of some branches have the letters of a file, on either side of the sheet.

    `all_listed` says that the sheet has no other branches; only then the answer can be PROVED.
    """
    turned = {fold: x.translate(UPSIDE_DOWN) for fold, x in letters.items()}
    ways: list[tuple[int, int]] = []
    unclear: list[tuple[int, int]] = []
    for k, branch in enumerate(branches, 1):
        for side, wanted in ((1, letters), (-1, turned)):
            other, unknown = differing(wanted, branch.assignment)
            if not other:
                (unclear if unknown else ways).append((k, side))
    status = PROVED if all_listed and not unclear else UNDECIDED
    return Lettered(status, tuple(ways), tuple(unclear))
