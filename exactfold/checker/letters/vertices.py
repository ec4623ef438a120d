"""Whether one vertex of rigid panels can have its letters: the theorem of Abel et al.

Folds that have to stay flat are taken away. The others fold if and only if two of them are a
straight crease with one letter and all others are flat, or the folds with one letter lie in no
closed half-plane and some fold has the other letter (docs/vertices.md, Theorem 1). This holds for
motions to second order, and for all configurations near the flat state.
"""

from __future__ import annotations

from collections.abc import Sequence

from ..core.towers import Number

Vector = tuple[Number, Number]


def can_fold(directions: Sequence[Vector], letters: str) -> bool:
    """Whether a vertex can have these letters M, V, or U for any of M, V and flat.

    The directions are in counter-clockwise order. Some letter is M or V.
    """
    for letter, other in ("MV", "VM"):
        base = [d for d, x in zip(directions, letters, strict=True) if x in (letter, "U")]
        if other in letters:
            if _span(base):
                return True
            continue
        toes = [d for d, x in zip(directions, letters, strict=True) if x == "U"]
        if any(_span([d for d in base if d is not toe]) for toe in toes):
            return True
        asked = [d for d, x in zip(directions, letters, strict=True) if x == letter]
        pairs = [asked] if len(asked) == 2 else [[*asked, toe] for toe in toes]
        if len(asked) < 3 and any(map(_straight, pairs)):
            return True
    return False


def _span(d: Sequence[Vector]) -> bool:
    """Whether directions in counter-clockwise order lie in no closed half-plane."""
    following = zip(d, (*d[1:], *d[:1]), strict=True)
    return len(d) > 2 and all(_cross(a, b) > 0 for a, b in following)


def _straight(both: Sequence[Vector]) -> bool:
    """Whether two directions are opposite."""
    (a, b), (c, d) = both
    return _cross(*both) == 0 and (a * c + b * d).sign() < 0


def _cross(a: Vector, b: Vector) -> int:
    return (a[0] * b[1] - a[1] * b[0]).sign()
