"""Files of proved loops, written as loops are found; interrupted runs can be continued."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

from exactfold._support.verdict import PROVED
from exactfold.certificates.journal import Journal
from exactfold.motion.contacts.fold_ranges import FoldRange
from exactfold.motion.curves.framework import Framework
from exactfold.motion.loops.certificate import OPENING, claims_line, header_line
from exactfold.motion.loops.proofs import Loop
from exactfold.motion.loops.rays import Ray
from exactfold.motion.tubes.arclength import Interval
from exactfold.motion.tubes.length_equations import LengthEquations
from exactfold.motion.tubes.piece import Ball
from exactfold.motion.tubes.tube_start import StartTube
from exactfold.motion.tubes.visits import Visit
from exactfold.rigidity.equations.problem import Problem


@dataclass(repr=False)
class LoopFile:
    """A certificate of loops that is being written; no ray occurs in it twice.

    `known` are the loops that an earlier run has left in the file.
    """

    journal: Journal
    problem: Problem
    known: tuple[Loop, ...]
    matched: set[Ray] = field(default_factory=set)

    @classmethod
    def opened(
        cls,
        path: str | os.PathLike[str],
        problem: Problem,
        resume: bool,
        replace: bool,
        *,
        like: StartTube | None = None,
    ) -> LoopFile:
        """A new file, or with `resume` the continuation of a file; raises the errors of `Journal`.

        All loops of a file hold the same triangle and have the same number of bits: those of
        `like`, or by default those of `LoopFinder`.
        """
        framework = Framework.of(problem.sheet) if like is None else like.framework
        pinned = [problem.labels[v] for v in framework.pinned]
        bits = LengthEquations.of(framework).bits if like is None else like.bits
        header = header_line(problem.pattern, pinned, bits)
        if not resume:
            return cls(Journal(path, header, replace=replace), problem, ())
        known: list[Loop] = []
        matched: set[Ray] = set()

        def refusal(text: str, _: int) -> str | None:
            loop = _loop_of(text, problem, bits)
            if loop is None or not matched.isdisjoint(loop.ends):
                return "it is not a loop of this sheet, or it repeats an earlier loop"
            known.append(loop)
            matched.update(loop.ends)
            return None

        journal = Journal.resumed(
            path, header, refusal, opening=OPENING, kind="certificate of loops"
        )
        return cls(journal, problem, tuple(known), matched)

    def add(self, loop: Loop, line: str) -> None:
        """Write a loop, unless the file already has it, possibly mirrored or run through
        backwards.
        """
        ends = loop.ends
        if self.matched.isdisjoint(ends):
            self.journal.append(line)
            self.matched |= ends

    def finish(self) -> None:
        """Write the claims; raises `UnwritableFileError`."""
        pattern = self.problem.pattern
        self.journal.finish(claims_line(pattern, self.journal.blocks, len(self.matched)))

    def close(self) -> None:
        """Close the file; everything that was written stays."""
        self.journal.close()

    def __repr__(self) -> str:
        return f"<LoopFile: {self.journal.path}, {self.journal.blocks} loops>"


def _loop_of(text: str, problem: Problem, bits: int) -> Loop | None:
    """The loop of a line; None if this program did not write the line."""
    try:
        data = json.loads(text)
        source, target = (_ray(data[key], problem) for key in ("from", "to"))
        steps = data["evidence"]["steps"]
        known = data["provenance"]
        nodes = [step for step in steps if "flat" in step]
        through = tuple(tuple(step["flat"]) for step in nodes)
        visits = tuple(
            _visit(step, branch_point, problem, bits)
            for step, branch_point in zip(nodes, known["nodes"], strict=True)
        )
        folds = tuple(
            FoldRange((i, j), turns, _interval(least), _interval(greatest))
            for i, j, turns, least, greatest in known["folds"]
        )
        length = _interval(known["length"])
    except (ValueError, LookupError, TypeError, ZeroDivisionError):
        return None
    return Loop(source, target, through, length, PROVED, "", len(steps) + 1, visits, folds)


def _visit(
    step: dict[str, Any], branch_point: dict[str, Any], problem: Problem, bits: int
) -> Visit:
    flat = tuple(problem.labels.index(v) for v in step["flat"])
    place = Ball(bits, tuple(step["node"]), tuple(branch_point["radii"]))
    along = Ball(bits, tuple(step["centre"]), tuple(branch_point["spread"]))
    return Visit(flat, place, along, _interval(branch_point["time"]))


def _interval(texts: list[str]) -> Interval:
    low, high = (Fraction(x) for x in texts)
    return low, high


def _ray(data: dict[str, Any], problem: Problem) -> Ray:
    signs = dict(zip(problem.pattern.interior, data["vertex_signs"], strict=True))
    side = data["side"]
    if side not in (1, -1) or any(signs[v] not in (1, -1) for v in problem.foldable):
        raise ValueError("a ray needs a side 1 or -1 and a sign for every foldable vertex")
    return Ray(tuple(signs[v] for v in problem.foldable), 1 if side == 1 else -1)
