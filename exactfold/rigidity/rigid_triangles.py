"""Proves that triangulated triangles stay flat and multiply each root by a power of two."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from exactfold.pattern.crease_pattern import CreasePattern, Triangle
from exactfold.rigidity.definite_stresses import definite_stress, inside


@dataclass(frozen=True)
class RigidTriangle:
    """A triangulated triangle with a definite stress of its inside.

    Let w be the heights inside minus the plane through the corners. The curvature forms of the m
    vertices inside depend on w alone. Because of the definite stress, w = 0 is their only common
    complex zero (see `exactfold.rigidity.definite_stress`). So they are a regular sequence of m
    quadrics with local multiplicity 2^m. At w = 0 the remaining forms are those of the sheet
    without these vertices. So an isolated root of multiplicity k of that sheet has multiplicity
    2^m k in the full system: the quotient by the inner forms has length 2^m, and the outer forms
    are a complete intersection over it.
    """

    corners: Triangle
    inside: tuple[int, ...]
    multipliers: tuple[Fraction, ...]


def certify_rigid_triangles(pattern: CreasePattern) -> tuple[RigidTriangle, ...] | None:
    """A `RigidTriangle` for each triangulated triangle; None if a stress was not found.

    >>> from exactfold.pattern.families import single_vertex
    >>> certify_rigid_triangles(single_vertex(3))[0].inside
    (3,)
    """
    result = []
    for cycle, vertices in pattern.triangulated_triangles:
        stress = definite_stress(inside(pattern, cycle, vertices))
        if stress is None:
            return None
        result.append(RigidTriangle(cycle, vertices, tuple(stress[k] for k in sorted(stress))))
    return tuple(result)
