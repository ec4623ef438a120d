"""The pattern as it stands in every result, so that a result can be read without its file."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from exactfold.exact.numbers import format_rational
from exactfold.pattern.crease_pattern import CreasePattern


def described(
    pattern: CreasePattern, name: str | None = None, snapped: Fraction | None = None
) -> dict[str, Any]:
    """Name, counts, digest, and the exact vertices and faces of a pattern, as JSON.

    >>> pattern = CreasePattern([(0, 0), (1, 0), ("1/2", 1)], [(0, 1, 2)])
    >>> data = described(pattern, "mine")
    >>> data["name"], data["boundary"], data["vertices"][2], data["faces"]
    ('mine', 3, ['1/2', '1'], [[0, 1, 2]])
    """
    return {
        "name": name,
        "interior": pattern.Vi,
        "boundary": pattern.Ve,
        "folds": len(pattern.folds),
        "degrees_of_freedom": pattern.degrees_of_freedom,
        "sha256": pattern.sha256,
        **({} if snapped is None else {"snapped": format_rational(snapped)}),
        "vertices": [[format_rational(x), format_rational(y)] for x, y in pattern.vertices],
        "faces": [list(triangle) for triangle in pattern.triangles],
    }
