"""Which rays true motions join, on random squares: one line of a table for each size.

    python tests/benchmarks/matching_census.py --sizes 1 2 3 4 --sheets 300 250 200 100

Floats throughout: evidence, not proof. Sheets are `random_square(n, seed)` (or `h1_sequence`) for
the seeds 0, 1, ..., without those on which a branch is not simple or a vertex cannot fold. A loop
is followed once, together with its mirror image, so that it is seen whether the ends of loops are
all different, as they must be in a perfect matching: `clash` counts those that are not. Columns:
`sheets`, `H1` of them, `loops`, `lost` ones that could not be followed; `nodes` loops that pass
nodes, `other` those that pass crossings where no star is flat, which count nowhere below; `1`, `2`,
`3`, `4+` loops by the number of signs that flip; `plain >1` loops without nodes that flip more than
one sign, `H1 >1` those of H1 sheets; `odd` loops against the parity law; `fans` loops of fans,
`missed` those not as the rule says; `winding` the number of folds that wind, in all; `uneven` the
vertices of loops with an odd number of winding folds; `flip = 2` and `flip other` loops that flip
one vertex sign only, by whether exactly two folds wind at that vertex; `kinds` loops by the number
of flips and, in brackets, of flat vertices at each node.
"""

from __future__ import annotations

import argparse
import sys
import warnings
from collections import Counter

import numpy as np
from loops import Loop, LostError, Tracker
from matching_rule import is_h1

from exactfold import CreasePattern, random_square
from exactfold.branches import count_branches
from exactfold.pattern.families import h1_sequence
from exactfold.studies.fans import fan

COLUMNS = (
    "sheets", "H1", "loops", "lost", "clash", "nodes", "other", "1", "2", "3", "4+", "plain >1",
    "H1 >1", "odd",
    "fans", "missed", "winding", "uneven", "flip = 2", "flip other",
)  # fmt: skip


def seen(tracker: Tracker, loop: Loop) -> Counter[str]:
    """What one loop adds to the columns."""
    sheet, n = tracker.sheet, tracker.sheet.Vi
    flips = len(loop.flipped)
    winding = [bool(turns) for turns in loop.turns]
    at = {
        v: sum(w for w, fold in zip(winding, sheet.folds, strict=True) if v in fold)
        for v in sheet.interior
    }
    if not all(loop.crossings):
        return Counter({"loops": 1, "other": 1})
    found = Counter({"loops": 1, str(flips) if flips < 4 else "4+": 1, "winding": sum(winding)})
    found["nodes"] += bool(loop.flat_stars)
    found["plain >1"] += not loop.flat_stars and flips > 1
    found["odd"] += (flips + 1 + sum(map(len, loop.flat_stars))) % 2
    found["uneven"] += sum(
        sum(t for t, fold in zip(loop.turns, sheet.folds, strict=True) if v in fold) % 2 for v in at
    )
    if flips == 1 and loop.flipped[0] < n:
        two = at[sheet.interior[loop.flipped[0]]] == 2
        found["flip = 2" if two else "flip other"] += 1
    return found


def sheet_census(pattern: CreasePattern, kinds: Counter[str]) -> Counter[str] | None:
    """The columns of one sheet, None if some branch is not simple or a vertex cannot fold."""
    if pattern.without_rigid_parts()[0].Vi != pattern.Vi:
        return None
    branches = count_branches(pattern).branches
    if any(branch.multiplicity != 1 for branch in branches):
        return None
    tracker, whole = Tracker(pattern), fan(pattern)
    total = Counter({"sheets": 1, "H1": int(is_h1(pattern))})
    partner: dict[tuple[int, ...], tuple[int, ...]] = {}
    for branch in branches:
        heights = np.array([float(branch.approx_heights[v]) for v in range(len(pattern.vertices))])
        if tracker.signs(heights) in partner:
            continue
        try:
            loop = tracker.follow(heights)
        except LostError:
            total["lost"] += 1
            continue
        mirrored = [tuple(-s for s in signs) for signs in (loop.start, loop.end)]
        for a, b in ((loop.start, loop.end), (mirrored[0], mirrored[1])):
            total["clash"] += partner.get(b, a) != a or a == b
            partner[a], partner[b] = b, a
        one = seen(tracker, loop)
        one["H1 >1"] += total["H1"] * one["plain >1"]
        if whole is not None and not one["other"]:
            one["fans"] += 1
            one["missed"] += loop.flipped != (whole.flipped(),)
        # A loop and its mirror image are two loops, unless the mirror image is the loop itself.
        times = 1 if loop.end == mirrored[0] else 2
        if not one["other"]:
            nodes = "".join(f"[{len(vertices)}]" for vertices in loop.flat_stars)
            kinds[f"{len(loop.flipped)}{nodes}"] += times
        total.update({key: times * value for key, value in one.items()})
    return total


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sizes", type=int, nargs="+", default=[1, 2, 3])
    parser.add_argument("--sheets", type=int, nargs="+", default=[10], help="for each size")
    parser.add_argument("--family", choices=["square", "h1"], default="square")
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    build = random_square if options.family == "square" else h1_sequence
    numbers = options.sheets * (len(options.sizes) if len(options.sheets) == 1 else 1)
    print("| n | " + " | ".join((*COLUMNS, "kinds")) + " |")
    print("|--:" * (len(COLUMNS) + 2) + "|")
    for n, wanted in zip(options.sizes, numbers, strict=True):
        total: Counter[str] = Counter()
        kinds: Counter[str] = Counter()
        seed = 0
        while total["sheets"] < wanted:
            total.update(sheet_census(build(n, seed), kinds) or {})
            seed += 1
        cells = [str(total[c]) for c in COLUMNS]
        cells.append(", ".join(f"{kind}: {kinds[kind]}" for kind in sorted(kinds)))
        print(f"| {n} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    sys.exit(main())
