"""How long motions take: run with `-m survey --benchmark-enable -s`."""

from __future__ import annotations

import itertools

import pytest

from exactfold import random_square
from exactfold.branches import find_branch, find_branches
from exactfold.motion import follow
from exactfold.pattern.triangulating.random_squares import sample_random_square


@pytest.mark.survey
@pytest.mark.parametrize(("n", "frames"), [(8, 60), (100, 60), (1000, 60)])
def test_one_motion_until_contact(benchmark, n, frames):
    pattern = sample_random_square(n, 1, 1 << 16, redraw=True).pattern
    branch = find_branch(pattern, "+-" * (n // 2))
    motion = benchmark.pedantic(
        follow, (branch,), {"frames": frames, "until": "contact"}, rounds=1, iterations=1
    )
    assert motion.end in ("contact", "flat-fold", "node")
    assert motion.length_error < 1e-11
    print(f"\n{n} vertices, {frames} frames: {motion.seconds:.2f} s, {motion!r}")


@pytest.mark.survey
def test_all_branches_of_eight_vertices_until_contact(benchmark):
    pattern = random_square(8, seed=1)
    signs = ["".join(s) for s in itertools.product("+-", repeat=8)]
    branches = list(find_branches(pattern, signs))

    def all_of_them():
        return [follow(branch, frames=2) for branch in branches]

    motions = benchmark.pedantic(all_of_them, rounds=1, iterations=1)
    ends = sorted(motion.end for motion in motions)
    assert len(motions) == 256
    assert "singular" not in ends
    seconds = sum(motion.seconds for motion in motions)
    counted = {end: ends.count(end) for end in dict.fromkeys(ends)}
    print(f"\n256 branches of 8 vertices: {seconds:.1f} s of one process, {counted}")
