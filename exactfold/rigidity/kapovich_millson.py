"""Signature of a single flat vertex by counting tracks (Kapovich and Millson 1997, Theorem 1.1)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction

from exactfold.errors import DegenerateFaceError, MalformedPatternError
from exactfold.exact.forms import QuadraticForm
from exactfold.exact.linalg import Inertia
from exactfold.exact.numbers import RationalLike, as_rational

Vector = tuple[Fraction, Fraction]


@dataclass(frozen=True)
class TrackCount:
    """The forward-tracks, back-tracks and winding of a flat vertex, and its vertex form.

    `form` is the vertex form of Appendix C of the paper, which is -2 times the curvature form. Its
    labels are 0 for the hub and 1 to N for the spoke ends. `inertia` is computed from the form, not
    from the count.
    """

    forward: int
    back: int
    winding: int
    form: QuadraticForm

    @property
    def inertia(self) -> Inertia:
        """(positive, negative, zero) of the form, exactly."""
        return self.form.inertia

    @property
    def predicted(self) -> Inertia:
        """The inertia (f - 2w - 1, b + 2w - 1, 3) that Kapovich and Millson's theorem predicts."""
        f, b, w = self.forward, self.back, self.winding
        return f - 2 * w - 1, b + 2 * w - 1, 3


def kapovich_millson(spokes: Iterable[Sequence[RationalLike]]) -> TrackCount:
    """The tracks, winding and form of a flat vertex that may fold back or wind repeatedly.

    `spokes` are the rational vectors from the hub to its neighbours in cyclic order. The angle from
    each spoke to the next (and from the last to the first) is taken in (-pi, pi) and must not be a
    multiple of pi. It is positive at forward-tracks and negative at back-tracks. The angles add up
    to 2 pi times the winding, which is counted by crossings of the positive x-axis.

    Raises `MalformedPatternError` for fewer than two spokes or a spoke that is not a pair,
    `DegenerateFaceError` if two consecutive spokes are parallel (a zero spoke is parallel to every
    other), and a `NumberError` for a coordinate that is not rational.

    >>> star = kapovich_millson([(1, 0), (0, 1), (-1, 0), (0, -1)])
    >>> (star.forward, star.back, star.winding), star.inertia
    ((4, 0, 1), (1, 1, 3))
    >>> pentagram = kapovich_millson([(2, 0), (-2, 1), (1, -2), (1, 2), (-2, -1)])
    >>> (pentagram.forward, pentagram.back, pentagram.winding), pentagram.inertia
    ((5, 0, 2), (0, 3, 3))
    """
    vectors = _vectors(spokes)
    after = [*vectors[1:], vectors[0]]
    crosses = [a[0] * b[1] - a[1] * b[0] for a, b in zip(vectors, after, strict=True)]
    for j, cross in enumerate(crosses):
        if cross == 0:
            k = (j + 1) % len(vectors)
            raise DegenerateFaceError(
                f"spokes {j} and {k} are parallel", vertices=(j, k), faces=(j,)
            )
    forward = sum(cross > 0 for cross in crosses)
    winding = 0
    for a, b, cross in zip(vectors, after, crosses, strict=True):
        if _lower(a) and not _lower(b) and cross > 0:
            winding += 1
        elif not _lower(a) and _lower(b) and cross < 0:
            winding -= 1
    return TrackCount(forward, len(vectors) - forward, winding, _form(vectors, crosses))


def _vectors(spokes: Iterable[Sequence[RationalLike]]) -> list[Vector]:
    vectors = []
    for j, spoke in enumerate(spokes):
        if isinstance(spoke, str) or len(spoke) != 2:
            raise MalformedPatternError(f"spoke {j} is not a pair of numbers", vertices=(j,))
        vectors.append((as_rational(spoke[0]), as_rational(spoke[1])))
    if len(vectors) < 2:
        raise MalformedPatternError(f"a vertex needs at least two spokes, not {len(vectors)}")
    return vectors


def _lower(v: Vector) -> bool:
    """Whether the direction lies in [pi, 2 pi), where [0, pi) is the upper half."""
    return v[1] < 0 or (v[1] == 0 and v[0] < 0)


def _form(vectors: Sequence[Vector], crosses: Sequence[Fraction]) -> QuadraticForm:
    """The form sum_n 2 g_n x_n x_{n+1} + f_n x_n^2, where x_n = h_n - h_0 and g_n = -1 / c_n.

    f_n = (d_{n-1} x d_{n+1}) / (c_{n-1} c_n) is the paper's (cot + cot) / L_n^2.
    """
    size = len(vectors)
    matrix = [[Fraction(0)] * (size + 1) for _ in range(size + 1)]
    for n in range(size):
        before, after = vectors[n - 1], vectors[(n + 1) % size]
        chord = before[0] * after[1] - before[1] * after[0]
        matrix[1 + n][1 + n] += chord / (crosses[n - 1] * crosses[n])
        k = 1 + (n + 1) % size
        matrix[1 + n][k] -= 1 / crosses[n]
        matrix[k][1 + n] -= 1 / crosses[n]
    for n in range(1, size + 1):  # the form is invariant under h -> h + constant
        matrix[n][0] = matrix[0][n] = -sum(matrix[n][1:], Fraction(0))
    matrix[0][0] = -sum(matrix[0][1:], Fraction(0))
    return QuadraticForm(tuple(range(size + 1)), tuple(tuple(row) for row in matrix))
