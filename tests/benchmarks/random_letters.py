"""Ask of random letters with which a vertex starts to fold whether `match` finds that it does.

python tests/benchmarks/random_letters.py [--number 666] [--seed 29]

Each vertex has five to eight folds, of a hexagonal lattice or in random directions. Its letters are
those of a random motion to second order, computed in floating point.
"""

from __future__ import annotations

import argparse
import random
import sys
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "design" / "panels"))

from panel_letters import around, random_directions, random_letters

from exactfold.design import match_panels


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--number", type=int, default=666)
    parser.add_argument("--seed", type=int, default=29)
    arguments = parser.parse_args()
    rng = random.Random(arguments.seed)
    answers: Counter[str] = Counter()
    for _ in range(arguments.number):
        directions = random_directions(rng, rng.choice((5, 6, 7, 8)))
        letters = random_letters(rng, directions)
        found = match_panels(around(directions), letters)
        answers[f"starts {found.starts}, truly {found.truly}"] += 1
        if not found.densities:
            print(letters, directions, flush=True)
    for answer, number in answers.most_common():
        print(f"{number:6} {answer}")


if __name__ == "__main__":
    main()
