"""Rational quadratic forms on labelled variables."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from exactfold.errors import UsageError

if TYPE_CHECKING:
    from exactfold.exact.linalg import Inertia

_SHOWN = 12
"""Variables of the largest form that a notebook writes out."""


@dataclass(frozen=True)
class Diagonal:
    """sum_k weights_k (rows_k . h)^2 with independent rows, h in the order of the form's labels.

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
        """Number of positive less number of negative weights."""
        positive, negative, _ = self.inertia
        return positive - negative

    def __repr__(self) -> str:
        return f"<Diagonal: inertia {self.inertia}>"


@dataclass(frozen=True)
class QuadraticForm:
    """Q(h) = h^T M h on the variables named by `labels`, with M symmetric over Q.

    >>> form = QuadraticForm((4, 7), ((Fraction(1), Fraction(0)), (Fraction(0), Fraction(-1))))
    >>> form({4: Fraction(3), 7: Fraction(2)}), form.inertia
    (Fraction(5, 1), (1, 1, 0))
    """

    labels: tuple[int, ...]
    matrix: tuple[tuple[Fraction, ...], ...]

    def polar(self, a: Mapping[int, Fraction], b: Mapping[int, Fraction]) -> Fraction:
        """The symmetric bilinear form B(a, b) with B(h, h) = Q(h)."""
        left = [a[v] for v in self.labels]
        right = [b[v] for v in self.labels]
        return sum(
            (
                x * m * y
                for x, row in zip(left, self.matrix, strict=True)
                if x
                for m, y in zip(row, right, strict=True)
                if m
            ),
            Fraction(0),
        )

    def __call__(self, heights: Mapping[int, Fraction]) -> Fraction:
        """Q(h)."""
        return self.polar(heights, heights)

    def functional(self, a: Mapping[int, Fraction]) -> dict[int, Fraction]:
        """The linear functional h -> B(a, h), as coefficients by label."""
        left = [a[v] for v in self.labels]
        return {
            v: sum((m * x for m, x in zip(row, left, strict=True)), Fraction(0))
            for v, row in zip(self.labels, self.matrix, strict=True)
        }

    def __repr__(self) -> str:
        return f"<QuadraticForm: {len(self.labels)} variables>"

    @property
    def inertia(self) -> Inertia:
        """(positive, negative, zero), exactly."""
        from exactfold.exact.linalg import inertia  # FLINT, for this alone

        return inertia(self.matrix)

    @property
    def diagonalised(self) -> Diagonal:
        """The form as a sum of weighted squares of independent linear forms, exactly.

        By Lagrange's reduction, see `sum_of_squares`; its inertia is an independent second way to
        `inertia`, which goes by the characteristic polynomial.

        >>> one, two = Fraction(1), Fraction(2)
        >>> QuadraticForm((4, 7), ((two, two), (two, one))).diagonalised.weights
        (Fraction(2, 1), Fraction(-1, 1))
        """
        from exactfold.exact.linalg import sum_of_squares  # as in `inertia`

        squares = sum_of_squares(self.matrix)
        return Diagonal(
            tuple(weight for weight, _ in squares),
            tuple(tuple(row) for _, row in squares),
            len(self.labels) - len(squares),
        )

    def to_sympy(self, symbols: Mapping[int, Any] | None = None) -> Any:
        """Q(h) as an expanded SymPy expression with rational coefficients.

        `symbols` gives a symbol or expression by label; by default the height of vertex 4 is the
        symbol `h4`, as in `exactfold.bridges.to_sympy`. Raises `UsageError` if a label has none.

        >>> form = QuadraticForm((4, 7), ((Fraction(1), Fraction(1)), (Fraction(1), Fraction(0))))
        >>> form.to_sympy()
        h4**2 + 2*h4*h7
        """
        import sympy  # here, as it takes long to load

        if symbols is None:
            symbols = {v: sympy.Symbol(f"h{v}") for v in self.labels}
        missing = [v for v in self.labels if v not in symbols]
        if missing:
            raise UsageError(f"there is no symbol for the height of vertex {missing[0]}")
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
        import sympy  # as in `to_sympy`

        return f"$Q(h) = {sympy.latex(self.to_sympy())}$"
