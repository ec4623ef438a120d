"""Certificates of loops: what is written verifies, and an interrupted run is continued."""

import json
import os
import shlex
import signal
import subprocess
import sys
from fractions import Fraction

import pytest
from sheets import flipped, nested_triangles, reflex_corners, star_in, with_point
from typer.testing import CliRunner

from exactfold import checker, find_branch, random_square, write_fold
from exactfold.checker import motion_loops
from exactfold.cli import app
from exactfold.data import example_path
from exactfold.errors import ForeignJournalError, NotCountedError, UsageError
from exactfold.evidence.journal import Journal
from exactfold.motion import find_loops
from exactfold.motion.half_branches import HalfBranch
from exactfold.motion.loop_file import LoopFile
from exactfold.motion.loops import LoopFinder
from exactfold.problem.problem import Problem
from exactfold.verdict import PROVED, UNDECIDED

INTERRUPTED = 130
NODE_SHEET, NODE_SIGNS = random_square(8, seed=1), "------++"


def reflex():
    """A sheet with a reflex corner and two foldable vertices, all of whose branches are simple."""
    sheet = flipped(with_point(star_in(reflex_corners(0)), 1, (3, 4, 5)), REFLEX_FLIP)
    assert len(sheet.foldable_vertices) == 2
    return sheet


def loops_in(path):
    """The lines of the loops in a file."""
    bodies = [line.partition("\t")[0] for line in path.read_text().splitlines()]
    return [json.loads(body) for body in bodies if body.startswith('{"from"')]


def half_branch(entry, pattern):
    signs = dict(zip(pattern.interior, entry["vertex_signs"], strict=True))
    assert all((signs[v] == 0) == (v in pattern.rigid_vertices) for v in pattern.interior)
    return HalfBranch(tuple(signs[v] for v in pattern.foldable_vertices), entry["side"])


@pytest.mark.parametrize(
    "pattern",
    [random_square(1, seed=0), random_square(2, seed=3), random_square(3, seed=2)]
    + [nested_triangles()],
    ids=["one", "two", "three", "triangles"],
)
def test_what_is_written_verifies(pattern, tmp_path):
    file = tmp_path / "loops.txt"
    found = find_loops(pattern, certificate=file)
    assert found.status is PROVED
    n = len(pattern.foldable_vertices)
    assert checker.verify(file) == {
        "sha256": pattern.sha256,
        "loops": 1 << n - 1,
        "matched": 2 << n,
        "half_branches": 2 << n,
        "complete": True,
    }
    written = loops_in(file)
    assert len(written) == len(found.loops)
    for entry, loop in zip(written, found.loops, strict=True):
        assert half_branch(entry["from"], pattern) == loop.source
        assert half_branch(entry["to"], pattern) == loop.target
        low, high = loop.length
        assert low * Fraction(97, 100) < Fraction(entry["length"]) <= high
    assert find_loops(pattern).loops == found.loops
