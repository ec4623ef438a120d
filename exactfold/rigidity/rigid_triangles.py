"""Proof that triangulated triangles stay flat and multiply every root by a power of two."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from exactfold.pattern.crease_pattern import CreasePattern, Triangle
from exactfold.rigidity.definite_stresses import definite_stress, inside


@dataclass(frozen=True)
class RigidTriangle:
    """A triangulated triangle with a definite stress of its inside.

    Let w be the heights inside minus the plane through the corners. The curvature forms of the m
    vertices inside depend on w alone, and by the definite stress have no common complex zero but
    w = 0 (see `exactfold.rigidity.definite_stress`): they are a regular sequence of m quadrics with
    local multiplicity 2^m. The remaining forms at w = 0 are those without its vertices, so every
    isolated root of multiplicity k there has multiplicity 2^m k in the full system (the quotient by
    the inner forms has length 2^m, and the outer ones are a complete intersection over it).
    """

    corners: Triangle
    inside: tuple[int, ...]
    multipliers: tuple[Fraction, ...]


def certify_rigid_triangles(pattern: CreasePattern) -> tuple[RigidTriangle, ...] | None:
    """A `RigidTriangle` for each triangulated triangle, or None if a stress was not found.

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
