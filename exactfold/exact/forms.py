"""Rational quadratic forms on labelled variables."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import FrozenInstanceError, dataclass
from fractions import Fraction
from functools import cached_property
from math import gcd, lcm
from operator import mul
from typing import TYPE_CHECKING, Any

from exactfold.errors import UsageError
from exactfold.exact.numbers import over_common_denominator

if TYPE_CHECKING:
    from exactfold.exact.linalg import Inertia

_SHOWN = 12
"""A notebook writes out forms of at most this many variables."""


@dataclass(frozen=True)
class Diagonal:
    """A quadratic form as the sum over k of weights_k (rows_k . h)^2.

    The rows are independent, and h lists the variables in the order of the form's labels. The
    `weights` are not zero; `zero` is the dimension of the kernel of the form.
    """

    weights: tuple[Fraction, ...]
    rows: tuple[tuple[Fraction, ...], ...]
    zero: int

    @property
    def inertia(self) -> Inertia:
        """(positive, negative, zero), by Sylvester's law of inertia."""
        positive = sum(weight > 0 for weight in self.weights)
        return positive, len(self.weights) - positive, self.zero

    @property
    def signature(self) -> int:
        """The number of positive weights minus the number of negative weights."""
        positive, negative, _ = self.inertia
        return positive - negative

    def __repr__(self) -> str:
        return f"<Diagonal: inertia {self.inertia}>"


class QuadraticForm:
    """The quadratic form Q(h) = h^T M h on the variables named by `labels`, M symmetric over Q.

    `matrix` has the entries of M as fractions. `integers` / `denominator` is M in lowest terms: the
    denominator is positive, and no integer above 1 divides it and all entries of `integers`.

    >>> form = QuadraticForm((4, 7), ((Fraction(1), Fraction(0)), (Fraction(0), Fraction(-1))))
    >>> form({4: Fraction(3), 7: Fraction(2)}), form.inertia
    (Fraction(5, 1), (1, 1, 0))
    """

    labels: tuple[int, ...]

    def __init__(self, labels: Iterable[int], matrix: Iterable[Iterable[Fraction]]) -> None:
        vars(self).update(labels=tuple(labels), matrix=tuple(map(tuple, matrix)))

    @classmethod
    def over(
        cls, denominator: int, labels: Iterable[int], integers: Iterable[Sequence[int]]
    ) -> QuadraticForm:
        """The form with the matrix `integers` / `denominator`; the denominator must be positive.

        >>> QuadraticForm.over(4, [7], [[2]]).matrix
        ((Fraction(1, 2),),)
        """
        rows = list(integers)
        common = gcd(denominator, *(x for row in rows for x in row))
        form = object.__new__(cls)
        vars(form).update(
            labels=tuple(labels),
            integers=tuple(tuple(x // common for x in row) for row in rows),
            denominator=denominator // common,
        )
        return form

    def __setattr__(self, name: str, value: object) -> None:
        raise FrozenInstanceError(f"a quadratic form cannot be changed: {name}")

    def __delattr__(self, name: str) -> None:
        raise FrozenInstanceError(f"a quadratic form cannot be changed: {name}")

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, QuadraticForm):
            return NotImplemented
        return (self.labels, self.matrix) == (other.labels, other.matrix)

    def __hash__(self) -> int:
        return hash((self.labels, self.matrix))

    @cached_property
    def matrix(self) -> tuple[tuple[Fraction, ...], ...]:
        """The rows of the matrix M as fractions."""
        return tuple(tuple(Fraction(x, self.denominator) for x in row) for row in self.integers)

    @cached_property
    def integers(self) -> tuple[tuple[int, ...], ...]:
        """`denominator` times M, row by row."""
        return tuple(
            tuple(x.numerator * (self.denominator // x.denominator) for x in row)
            for row in self.matrix
        )

    @cached_property
    def denominator(self) -> int:
        """The least d > 0 for which d M has integer entries."""
        return lcm(*(x.denominator for row in self.matrix for x in row))

    def polar(self, a: Mapping[int, Fraction], b: Mapping[int, Fraction]) -> Fraction:
        """The symmetric bilinear form B(a, b), for which B(h, h) = Q(h)."""
        if not self._is_rational(a, b):
            row = self.functional(a)
            return sum((row[v] * b[v] for v in self.labels if b[v]), Fraction(0))
        right, below = over_common_denominator(b[v] for v in self.labels)
        images, denominator = self._images(a)
        value = sum(x * y for x, y in zip(images, right, strict=True))
        return Fraction(value, denominator * below)

    def __call__(self, heights: Mapping[int, Fraction]) -> Fraction:
        """Q(h)."""
        return self.polar(heights, heights)

    def functional(self, a: Mapping[int, Fraction]) -> dict[int, Fraction]:
        """The linear functional h -> B(a, h), as coefficients by label."""
        if not self._is_rational(a):
            terms = {
                v: zip(row, self.labels, strict=True)
                for v, row in zip(self.labels, self.matrix, strict=True)
            }
            return {v: sum((m * a[u] for m, u in row), Fraction(0)) for v, row in terms.items()}
        images, denominator = self._images(a)
        return {v: Fraction(x, denominator) for v, x in zip(self.labels, images, strict=True)}

    def integer_functional(self, a: Mapping[int, Fraction]) -> dict[int, int]:
        """The least positive multiple of the functional h -> B(a, h) with integer coefficients.

        >>> form = QuadraticForm((4, 7), [[Fraction(1, 3), 1], [1, 0]])
        >>> form.integer_functional({4: Fraction(1), 7: Fraction(1)})
        {4: 4, 7: 3}
        """
        images, denominator = self._images(a)
        common = gcd(denominator, *images)
        return {v: x // common for v, x in zip(self.labels, images, strict=True)}

    def _is_rational(self, *points: Mapping[int, object]) -> bool:
        """Whether M and all points are rational; other entries (floats, symbols) need `matrix`."""
        values = (point[v] for point in points for v in self.labels)
        return all(isinstance(x, int | Fraction) for x in values) and (
            "integers" in vars(self)
            or all(isinstance(x, int | Fraction) for row in self.matrix for x in row)
        )

    def _images(self, a: Mapping[int, Fraction]) -> tuple[list[int], int]:
        """The vector M a as integers, and their common denominator."""
        vector, below = over_common_denominator(a[v] for v in self.labels)
        return [sum(map(mul, row, vector)) for row in self.integers], self.denominator * below

    def __repr__(self) -> str:
        return f"<QuadraticForm: {len(self.labels)} variables>"

    @property
    def inertia(self) -> Inertia:
        """The exact numbers of positive, negative and zero eigenvalues of M."""
        from exactfold.exact.linalg import inertia  # here: only this property needs FLINT

        return inertia(self.matrix)

    @property
    def diagonalised(self) -> Diagonal:
        """The form as a sum of weighted squares of independent linear forms, exactly.

        `sum_of_squares` finds it by Lagrange's reduction. So the inertia of the result is computed
        independently of `inertia`, which uses the characteristic polynomial.

        >>> one, two = Fraction(1), Fraction(2)
        >>> QuadraticForm((4, 7), ((two, two), (two, one))).diagonalised.weights
        (Fraction(2, 1), Fraction(-1, 1))
        """
        from exactfold.exact.linalg import sum_of_squares  # here, as in `inertia`

        squares = sum_of_squares(self.matrix)
        return Diagonal(
            tuple(weight for weight, _ in squares),
            tuple(tuple(row) for _, row in squares),
            len(self.labels) - len(squares),
        )

    def to_sympy(self, symbols: Mapping[int, Any] | None = None) -> Any:
        """Q(h) as an expanded SymPy expression with rational coefficients.

        `symbols` gives a symbol or an expression for each label. By default the height of vertex 4
        is the symbol `h4`, as in `exactfold.interop.to_sympy`. Raises `UsageError` if a label has
        no symbol.

        >>> form = QuadraticForm((4, 7), ((Fraction(1), Fraction(1)), (Fraction(1), Fraction(0))))
        >>> form.to_sympy()
        h4**2 + 2*h4*h7
        """
        import sympy  # here, as it takes long to load

        if symbols is None:
            symbols = {v: sympy.Symbol(f"h{v}") for v in self.labels}
        missing = [v for v in self.labels if v not in symbols]
        if missing:
            raise UsageError(
                f"vertex {missing[0]} has no symbol for its height: add it to `symbols`"
            )
        heights = [symbols[v] for v in self.labels]
        return sympy.expand(
            sum(
                sympy.Rational(m.numerator, m.denominator) * a * b
                for a, row in zip(heights, self.matrix, strict=True)
                for b, m in zip(heights, row, strict=True)
                if m
            )
        )

    def _repr_latex_(self) -> str | None:
        if len(self.labels) > _SHOWN:
            return None
        import sympy  # here, as in `to_sympy`

        return f"$Q(h) = {sympy.latex(self.to_sympy())}$"
