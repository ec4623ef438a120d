"""What moving vertices reaches on random squares: `python tests/design/moving/shown.py 20`.

Margins: of one branch of each square with four inner vertices, before and after. Near misses: the
letters of a branch of a sheet nearby, which the square has on no branch; they are asked for.
"""

from __future__ import annotations

import random
import sys
from fractions import Fraction

from exactfold import PROVED, CreasePattern, random_square
from exactfold.branches import count_branches
from exactfold.branches.values.letters import UPSIDE_DOWN
from exactfold.design import designed
from exactfold.errors import PatternError

AWAY = Fraction(1, 20)


def near_miss(seed, inner=4):
    """A square, and letters that a sheet nearby has on some branch and the square on none."""
    rng = random.Random(seed)
    while True:
        pattern = random_square(inner, seed=rng.randrange(10**6))
        points = list(pattern.vertices)
        for v in pattern.interior:
            x, y = points[v]
            dx, dy = (AWAY * Fraction(rng.randint(-100, 100), 100) for _ in range(2))
            points[v] = x + dx, y + dy
        try:
            other = CreasePattern(points, pattern.triangles)
        except PatternError:
            continue
        own = {text for branch in count_branches(pattern) for text in both(branch)}
        for branch in count_branches(other):
            if branch.assignment_text not in own:
                return pattern, dict(branch.assignment)


def both(branch):
    return branch.assignment_text, branch.assignment_text.translate(UPSIDE_DOWN)


def main(number: int) -> None:
    print("seed  branch  margin before  after")
    more = 0
    for seed in range(number):
        pattern = random_square(4, seed=seed)
        branch = count_branches(pattern)[seed % 16]
        found = designed(pattern, branch=branch, maximise="margin")
        more += found.status is PROVED
        print(f"{seed:4}  {branch.sign_text:6}  {found.before:13.4f}  {found.after:.4f}")
    print(f"{more} of {number} margins are proved to be larger")
    print("seed  missing by  moved by  status")
    reached = 0
    for seed in range(number):
        pattern, letters = near_miss(seed)
        found = designed(pattern, letters)
        reached += found.status is PROVED
        print(f"{seed:4}  {-found.before:10.4f}  {found.largest_move:8.4f}  {found.status}")
    print(f"{reached} of {number} near misses are repaired")


if __name__ == "__main__":
    main(int(sys.argv[1]))
