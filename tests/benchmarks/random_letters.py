"""Ask of random letters with which a vertex starts to fold whether it is found that it does.

python tests/benchmarks/random_letters.py [--number 666] [--seed 29]

`match` needs no search for one vertex, so the search for motions is asked by itself, too: from one
point, and from several (docs/assignment.md, Rigid panels). Each vertex has five to eight folds, of
a hexagonal lattice or in random directions. Its letters are those of a random motion to second
order, computed in floating point.
"""

from __future__ import annotations

import argparse
import random
import sys
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "design" / "panels"))

from panel_letters import around, random_directions, random_letters

from exactfold._support.verdict import PROVED
from exactfold.design import match_panels
from exactfold.design.panels.candidates import MotionSearch
from exactfold.design.panels.first_order_program import FirstOrderProgram
from exactfold.design.panels.parts import _found
from exactfold.panels.vertex.stars import stars


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
        sheet = around(directions)
        program = FirstOrderProgram(stars(sheet), dict(zip(sheet.folds, letters, strict=True)))
        start = program.motion()
        answers["search from one point"] += MotionSearch(program).found(start) is not None
        answers["search from several points"] += _found(program, start) is not None
        answers["match"] += match_panels(sheet, letters).truly is PROVED
    for answer, number in answers.items():
        print(f"{number:6} of {arguments.number}: {answer}")


if __name__ == "__main__":
    main()
