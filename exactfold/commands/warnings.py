"""What a designer should know of a pattern before its count is read."""

from __future__ import annotations

from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.near_degenerate import near_degenerate


def warnings(pattern: CreasePattern) -> list[str]:
    """A sentence for stderr if numbers are almost, but not, those of a simpler pattern."""
    found = near_degenerate(pattern)
    if found is None:
        return []
    advice = "what follows is true of these numbers, and may be of no use for what was meant"
    if found.denominator is not None:
        advice += f"; --snap {found.denominator} rounds to the simpler pattern"
    return [f"warning: {'; '.join(found.sentences)}: {advice}"]
