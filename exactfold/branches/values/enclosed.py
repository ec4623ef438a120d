"""What an enclosure means: the branch with given vertex signs, as far as it is proved."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction

from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches.values import reasons
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.letters import LETTERS
from exactfold.branches.values.roots import EnclosedRoot
from exactfold.pattern.crease_pattern import Edge
from exactfold.rigidity.equations.problem import Problem
from exactfold.rigidity.equations.sheet import VertexEquations
from exactfold.rigidity.functionals import saddle_functional
from exactfold.solve.certify.enclosure import Enclosure, height_radius, root_above, round_up
from exactfold.solve.certify.merged import heights_inside


def of_enclosure(
    sheet: VertexEquations,
    proof: Enclosure,
    signs: Mapping[int, int],
    *,
    steps: int = 0,
    seconds: float = 0.0,
) -> Branch:
    """The branch with these vertex signs, by vertex of the pattern, that the enclosure proves.

    The status is PROVED unless some vertex may be flat within the error. A vertex that is proved
    flat has sign 0, whatever sign was asked for (docs/branch.md, Theorem 5).
    """
    problem, labels, unit = sheet.problem, sheet.labels, sheet.height_unit
    squared = round_up(proof.squared_distance * unit**2)
    heights = {v: Fraction(int(h), proof.denominator) * unit for v, h in enumerate(proof.heights)}
    if proof.merged:
        heights |= heights_inside(sheet.pattern.integer_vertices[0], proof.merged, heights)
    merged = tuple(
        ((labels[a], labels[b], labels[c]), tuple(labels[v] for v in others))
        for (a, b, c), others in proof.merged
    )
    root = EnclosedRoot(
        problem.all_heights(heights), height_radius(sheet, squared), squared, merged
    )
    loose = tuple(labels[v] for v in proof.loose)
    flat = tuple(labels[v] for v in proof.flat_vertices)
    error = root_above(squared) if squared else Fraction(0)
    letters = {
        (labels[i], labels[j]): "F" if k in proof.flat_folds else LETTERS[sign or None]
        for (k, (i, j)), sign in zip(enumerate(sheet.pattern.folds), proof.letters, strict=True)
    }
    if loose:
        reason = reasons.undecided(error, loose)
    else:
        noun = "shape" if problem.gauge.curvature else "branch"
        reason = reasons.proved(error, flat, bool(problem.rigid), noun)
    return replace(
        not_enclosed(problem, {**signs, **dict.fromkeys(flat, 0)}, reason),
        status=UNDECIDED if loose else PROVED,
        undecided_vertices=loose,
        assignment=_assignment(problem, letters),
        root=root,
        multiplicity=None if loose else 1 << (len(flat) + len(problem.rigid)),
        saddle=_saddle(problem, root),
        steps=steps,
        seconds=seconds,
    )


def not_enclosed(
    problem: Problem,
    signs: Mapping[int, int],
    reason: str,
    *,
    steps: int = 0,
    seconds: float = 0.0,
) -> Branch:
    """The branch with these vertex signs when nothing is proved of it."""
    pattern = problem.pattern
    return Branch(
        pattern=pattern,
        vertex_signs={v: signs.get(v, 0) for v in pattern.interior},
        assignment=_assignment(problem, {}),
        root=None,
        multiplicity=None,
        gauge=problem.gauge.kind,
        curvature={problem.labels[v]: k for v, k in problem.gauge.curvature.items()},
        saddle=0,
        status=UNDECIDED,
        reason=reason,
        undecided_vertices=problem.foldable,
        steps=steps,
        seconds=seconds,
    )


def _assignment(problem: Problem, letters: Mapping[Edge, str]) -> dict[Edge, str]:
    """The letters of all folds; a fold with an end inside a triangulated triangle is flat."""
    return {
        fold: letters.get(fold, "U") if problem.rigid.isdisjoint(fold) else "F"
        for fold in problem.pattern.folds
    }


def _saddle(problem: Problem, root: EnclosedRoot) -> int:
    """The proved sign of the boundary saddle; boundary heights are exact, a reflex corner
    is not.
    """
    if problem.pattern.Ve != 4:
        return 0
    functional = saddle_functional(problem.pattern)
    value = sum((c * root.centres[v] for v, c in functional.items()), Fraction(0))
    error = Fraction(0)
    if problem.gauge.corner is not None:
        error = abs(functional[problem.labels[problem.gauge.corner]]) * root.radius
    return 0 if abs(value) <= error else 1 if value > 0 else -1
