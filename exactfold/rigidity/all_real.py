"""Decides whether the theorem "all branches are real" applies to a pattern, and what it gives."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from exactfold._support.plurals import counted
from exactfold._support.verdict import PROVED, UNDECIDED, Verdict
from exactfold.pattern.loading import PatternLike, as_pattern
from exactfold.rigidity.definite_stresses import definite_stress


@dataclass(frozen=True)
class Reality:
    """Whether all solutions of the branch system are known to be real, and how many there are.

    `solutions` counts with multiplicity. For D = 1 it counts branches as lines, for D > 1 solutions
    for any given boundary heights; for a rigid sheet it is 0, and if undecided None. `multipliers`
    is the definite stress that proves the result, by interior vertex of the sheet (with its notch
    closed if it has one). The theorem is docs/theorem.md, Theorem 2.
    """

    verdict: Verdict
    statement: str
    solutions: int | None = None
    multipliers: dict[int, Fraction] | None = None

    def __repr__(self) -> str:
        number = "?" if self.solutions is None else str(self.solutions)
        return f"<Reality: {self.verdict}, {number} solutions>"


def decide_all_branches_real(pattern: PatternLike) -> Reality:
    """Applies docs/theorem.md, Theorem 2 to a pattern; its hypotheses are checked exactly.

    The theorem covers every triangulated convex polygon, also with boundary angles of pi, chords,
    vertices of degree three and separating triangles, and every quadrilateral. For other sheets the
    answer is UNDECIDED, which does not mean that non-real solutions exist.

    >>> from exactfold.pattern.families import flat_vertex_square
    >>> reality = decide_all_branches_real(flat_vertex_square())
    >>> str(reality.verdict), reality.solutions
    ('proved', 4)
    """
    pattern = as_pattern(pattern)
    if not pattern.is_convex and pattern.Ve != 4:
        return Reality(
            UNDECIDED,
            f"the boundary has a reflex corner at vertex {pattern.reflex_corner} and more than "
            "four vertices",
        )
    stress = definite_stress(pattern.with_notch_closed())
    if stress is None:
        return Reality(UNDECIDED, "the disk multipliers do not give a definite stress")
    count = 1 << pattern.Vi
    if pattern.Ve == 3:
        return Reality(PROVED, "three boundary vertices: the sheet is rigid", 0, stress)
    if pattern.Ve == 4:
        shape = "convex" if pattern.is_convex else "reflex, its notch closed by a triangle"
        text = (
            f"boundary quadrilateral ({shape}): {counted(count, 'branch')} with multiplicity, all "
            "real; a branch with f flat vertices counts 2^f times; if no vertex is flat on any "
            "branch, there are exactly two branches for each pair of opposite vertex sign vectors"
        )
        return Reality(PROVED, text, count, stress)
    text = (
        f"convex boundary: {counted(count, 'solution')} with multiplicity for any given boundary "
        "heights, all real; a solution with f flat vertices counts 2^f times"
    )
    return Reality(PROVED, text, count, stress)
