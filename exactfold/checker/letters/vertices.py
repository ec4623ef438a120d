"""Whether one vertex of rigid panels can have its letters: the theorem of Abel et al.

Folds that have to stay flat are taken away. The others fold if and only if two of them are a
straight crease with one letter and all others are flat, or the folds with one letter lie in no
closed half-plane and some fold has the other letter (docs/vertices.md, Theorem 1). This holds for
motions to second order, and for all configurations near the flat state.

Proof that such motions exist. In the first case fold along the line. In the second let the letter
be M, d_k the directions of the folds, and w_k their densities, negative for mountains. Every sector
is less than pi, so that there are at least four folds and K has one positive and no zero square on
the space W of the w with sum_k w_k d_k = 0 (docs/panels.md, 1). The w in W that have the letters
form a convex cone C. It is not empty, and it has in its closure

- densities that are negative at all mountains and 0 at all valleys: the mountains lie in no closed
  half-plane. The gradients of these are the corners of a convex polygon, and K > 0;
- densities of one valley and the two mountains next to it on either side, whose angle is less than
  pi. Three folds inside an angle less than pi have K < 0: if w_1 d_1 + w_2 d_2 + w_3 d_3 = 0, then
  2 K = w_1 w_2 [d_1, d_2], with w_1 w_2 < 0.

Densities in C near these have the same signs of K. So K = 0 somewhere in C, and not at w = 0. There
the derivative of K on W is not 0, because no square of K is zero. So true motions are tangent to
this w (docs/panels.md, 6, Regular points fold).

Proof that there are no others. The panels cut a small sphere about the vertex in a closed polygon P
of length 2 pi. Its corners are the folds. Suppose that P is near the great circle of the flat
sheet, but not on it. If P consists of two half great circles, this is the first case. Otherwise P
lies in an open hemisphere (S. S. Chern, Curves and surfaces in Euclidean space, 1967, lemma to
Fenchel's theorem). Its centre p is near one of the two poles; say that seen from there P turns left
at mountains and right at valleys. In the other case the letters change places. Since P is near the
great circle, it runs once around p, counter-clockwise, and each half-line from p meets it once. The
central projection from the sphere to the plane that touches it at p keeps straight lines, convexity
and the directions of turns. Convex polygons in an open hemisphere have a perimeter less than 2 pi,
and one that is contained in another, and differs from it, has a smaller perimeter.

There is a valley: if P turned left at all corners, it would be a convex polygon, of perimeter less
than 2 pi. The mountains lie in no closed half-plane: a stretch A of P that turns right at all its
inner corners stays on the right of the line of its first side, which passes p on its right. So A is
seen from p under an angle less than pi, and it is not all of P. Now suppose that the mountains lie
in a closed half-plane. There is a mountain, and there are mountains q_1, q_2, perhaps the same,
such that the stretch A from q_1 to q_2 turns right at its inner corners and has a length l >= pi.
By what was said q_1 != q_2. Let h < pi be the length of the segment q_1 q_2, so that A has inner
corners. As A turns right, it lies between p and this segment, and encloses with it a convex polygon
of perimeter l + h inside the triangle p q_1 q_2. The rest B of P is seen from p under an angle
greater than pi. So its convex hull contains p, and with it the triangle, and its perimeter is
greater than l + h. But the hull of the closed curve formed by B and the segment has at most the
perimeter of that curve, which is 2 pi - l + h <= pi + h <= l + h, a contradiction.
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
