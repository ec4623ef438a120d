"""The control experiment: how many zeros stay real when the quadrics come from no pattern.

`python docs/control_experiment.py` prints the table of docs/control.md; every number is proved.
"""

from __future__ import annotations

import argparse
from collections import Counter
from dataclasses import dataclass

from exactfold import PROVED, random_square
from exactfold.branches.roots import BoxRoot
from exactfold.certify import isolate
from exactfold.problem import BranchSystem, perturbed
from exactfold.problem.sign_rows import Functionals
from exactfold.solve import homotopy

SIZES = ("0", "1/100", "1/10", "1/2")
HEAD = (
    "Vi  size   systems  undecided  not real  systems with some  two real in each pair\n"
    "--  -----  -------  ---------  --------  -----------------  ---------------------"
)


@dataclass(frozen=True)
class Row:
    """Counts over perturbed systems of random squares; all but `undecided` ones are proved.

    `nonreal` zeros out of `zeros`; `some` systems with one or more of them; `even` systems with two
    real zeros for each pair of opposite sign vectors, by the vertex functionals of the pattern.
    """

    interior: int
    size: str
    systems: int
    undecided: int
    zeros: int
    nonreal: int
    some: int
    even: int

    def __str__(self) -> str:
        proved = self.systems - self.undecided
        return (
            f"{self.interior:2}  {self.size:5}  {self.systems:7}  {self.undecided:9}  "
            f"{100 * self.nonreal / self.zeros:6.1f} %  {100 * self.some / proved:15.0f} %  "
            f"{100 * self.even / proved:19.0f} %"
        )


def experiment(interior: int, size: str, systems: int) -> Row:
    """Perturb the systems of the random squares with seeds 0 to `systems` - 1, and solve them."""
    undecided = zeros = nonreal = some = even = 0
    for seed in range(systems):
        chart = BranchSystem(random_square(interior, seed)).chart
        system = perturbed(chart.system, size, seed)
        found = isolate(system, homotopy(system, seed=seed))
        if found.complete is not PROVED:
            undecided += 1
            continue
        zeros += len(found.boxes)
        nonreal += found.nonreal
        some += found.nonreal > 0
        rows = Functionals(chart).vertices.values()
        pairs: Counter[tuple[int | None, ...]] = Counter()
        for box in found.boxes:
            if box.is_real:
                signs = [BoxRoot(box).sign(row) for row in rows]
                pairs[tuple(s * (signs[0] or 0) if s else None for s in signs)] += 1
        even += len(pairs) == 1 << (interior - 1) and set(pairs.values()) == {2}
    return Row(interior, size, systems, undecided, zeros, nonreal, some, even)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--systems", type=int, default=100, help="systems a line (default 100)")
    parser.add_argument("--interior", type=int, nargs="*", default=[2, 3, 4, 5, 6], metavar="VI")
    options = parser.parse_args()
    print(HEAD)
    for interior in options.interior:
        for size in SIZES:
            print(experiment(interior, size, options.systems), flush=True)


if __name__ == "__main__":
    main()
