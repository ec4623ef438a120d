"""What a designer should know of a pattern before its count is read."""

from __future__ import annotations

from exactfold.pattern.crease_pattern import CreasePattern


def warnings(pattern: CreasePattern) -> list[str]:
    """Sentences for stderr, one for each way in which the numbers of a pattern mislead.

    HOOK: `near_degenerate` (vertices that are almost flat, collinear creases that are almost so)
    is to be called here once `exactfold.pattern` has it, each finding as one sentence that names
    the vertex, the nearest pattern with smaller denominators, and --snap.
    """
    return []
