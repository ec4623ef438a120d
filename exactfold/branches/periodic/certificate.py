"""Writes certificates of the counts of periodic sheets."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from typing import Any

from exactfold._support.verdict import PROVED
from exactfold.branches.periodic.counting import pleat_spaces
from exactfold.branches.periodic.lines import Pair
from exactfold.branches.periodic.result import AlgebraicLine, HeightSpace, PeriodicCount
from exactfold.branches.periodic.shown import Shown, sorted_branches
from exactfold.branches.periodic.spaces import Cover, Space
from exactfold.certificates.entries import box_entry
from exactfold.checker.branches.periodic import PERIODIC, PeriodicClaims
from exactfold.checker.branches.periodic_proof import PeriodicBranchClaim, SpaceClaim
from exactfold.errors import NotApplicableError
from exactfold.exact.numbers import format_rational
from exactfold.pattern.periodic.cell_files import cell_document
from exactfold.rigidity.equations.periodic import Row


def periodic_certificate(result: PeriodicCount) -> dict[str, Any]:
    """The proof of a count of a periodic sheet, for `exactfold check`.

    The docstring of `exactfold.checker.branches.periodic` says what stands in it. Raises
    `NotApplicableError` if the count is not proved, or was proved by a Groebner basis.

    >>> import exactfold
    >>> counted = exactfold.count("miura-cell", direction=(3, 4))
    >>> exactfold.check(periodic_certificate(counted)).status
    <Verdict.PROVED: 'proved'>
    """
    if result.status is not PROVED:
        raise NotApplicableError("the count is not proved")
    evidence = result.evidence
    if evidence is None:
        raise NotApplicableError(
            "a Groebner basis proved the count, as a solution with flat vertices or a pleat lies "
            "in no quadratic field; no certificate states that"
        )
    shown = Shown(evidence.problem)
    found = [shown.branch(ray.signs, ray.b, ray.in_box) for ray in evidence.rays]
    spaces = dict.fromkeys(cover.space for cover in evidence.covers)
    found += [shown.exact_branch(space.basis[0]) for space in spaces if space.is_ray]
    exact = [line.ray for line in evidence.lines]
    found += [shown.branch(ray.signs, ray.b, ray.letters) for ray in exact if ray.b]
    pleats = [shown.space(basis) for basis in pleat_spaces(spaces)]
    branches: list[PeriodicBranchClaim] = [
        {
            "vertex_signs": branch.vertex_signs,
            "multiplicity": branch.multiplicity,
            "b": branch.b,
            "letters": branch.letters,
        }
        for branch in sorted_branches(found)
    ]
    claims: PeriodicClaims = {
        "direction": list(result.direction),
        "distinct": len(result.branches),
        "with_multiplicity": sum(branch.multiplicity for branch in result.branches),
        "branches": branches,
        "pleats": _claims(pleats),
        "families": _claims(result.families),
        "sha256": result.pattern.sha256,
    }
    points: dict[Space, list[Cover]] = defaultdict(list)
    for cover in evidence.covers:
        points[cover.space].append(cover)
    lines = [_line(line.radicand, line.point) for line in evidence.lines]
    if lines:
        claims["lines"] = [
            {"radicand": line.radicand, "line": _line(0, shown.pairs(line.point))["point"]}
            for line in evidence.lines
            if not line.ray.b
        ]
    cell = cell_document(result.pattern)
    pattern = {"lattice": cell["lattice"], "vertices": cell["points"], "faces": cell["faces"]}
    return {
        "format": PERIODIC.format,
        "version": 2 if lines else 1,
        "pattern": pattern,
        "claims": claims,
        "evidence": {
            "triangles": [
                {"ring": [list(c) for c in ring], "inside": [list(c) for c in inside]}
                for ring, inside in evidence.problem.parts.triangles
            ],
            "unit": format_rational(evidence.problem.unit),
            "rays": [{"place": ray.place, **box_entry(ray.root.box)} for ray in evidence.rays],
            "spaces": [
                {
                    "basis": [_texts(row) for row in space.basis],
                    "points": [_texts(cover.point) for cover in covers],
                }
                for space, covers in points.items()
            ],
            **({"lines": lines} if lines else {}),
        },
    }


def _claims(spaces: Iterable[HeightSpace | AlgebraicLine]) -> list[SpaceClaim]:
    return [
        {"dimension": space.dimension, "basis": [_texts(row) for row in space.basis]}
        for space in spaces
        if isinstance(space, HeightSpace)
    ]


def _line(radicand: int, point: Iterable[Pair]) -> dict[str, Any]:
    return {"radicand": radicand, "point": [_texts(pair) for pair in point]}


def _texts(row: Row) -> list[str]:
    return [format_rational(x) for x in row]
