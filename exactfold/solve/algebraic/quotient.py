"""The quotient algebra of a zero-dimensional ideal: monomial basis and multiplication matrices."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import count, product
from typing import TypeAlias

from flint import fmpq, fmpq_mat

from exactfold.rigidity.equations.quadratic import QuadraticSystem

Exponent: TypeAlias = tuple[int, ...]
SparsePolynomial: TypeAlias = Mapping[Exponent, fmpq]


def grevlex_key(exponent: Exponent) -> tuple[int, ...]:
    """A sort key for the graded reverse lexicographic order with x_1 > ... > x_n.

    >>> sorted([(0, 2), (1, 1), (2, 0), (1, 0)], key=grevlex_key)
    [(1, 0), (0, 2), (1, 1), (2, 0)]
    """
    return (sum(exponent), *(-a for a in reversed(exponent)))


def divides(a: Exponent, b: Exponent) -> bool:
    """Whether the monomial x^a divides x^b.

    >>> divides((1, 0), (1, 2)), divides((2, 0), (1, 2))
    (True, False)
    """
    return all(x <= y for x, y in zip(a, b, strict=True))


def standard_monomials(leading: Sequence[Exponent], size: int) -> list[Exponent] | None:
    """The monomials that no leading monomial divides, ascending; None if there are infinitely many.

    There are finitely many iff some power of every variable is a leading monomial (Cox, Little,
    O'Shea, Ideals, Varieties, and Algorithms, chapter 5, section 3, theorem 6).

    >>> standard_monomials([(2, 0), (0, 2)], 2)
    [(0, 0), (0, 1), (1, 0), (1, 1)]
    >>> standard_monomials([(1, 1), (0, 2)], 2) is None
    True
    """
    bounds = []
    for k in range(size):
        powers = [a[k] for a in leading if sum(a) == a[k]]
        if not powers:
            return None
        bounds.append(min(powers))
    monomials = [
        a for a in product(*(range(b) for b in bounds)) if not any(divides(m, a) for m in leading)
    ]
    return sorted(monomials, key=grevlex_key)


def sparse_quadrics(system: QuadraticSystem) -> list[dict[Exponent, int]]:
    """The polynomials z^T S_p z, z = (x, 1), as integer coefficients by exponent.

    >>> sparse_quadrics(QuadraticSystem((((1, 2), (2, 0)),)))
    [{(2,): 1, (1,): 4}]
    """
    size = len(system.matrices[0]) - 1 if system.matrices else 0  # there may be more quadrics
    units = [tuple(int(i == k) for i in range(size)) for k in range(size + 1)]
    result = []
    for matrix in system.matrices:
        terms: dict[Exponent, int] = {}
        for i, row in enumerate(matrix):
            for j, s in enumerate(row):
                if s:
                    exponent = tuple(a + b for a, b in zip(units[i], units[j], strict=True))
                    terms[exponent] = terms.get(exponent, 0) + s
        result.append(terms)
    return result


def separating_forms(size: int) -> Iterator[tuple[int, ...]]:
    """Yields integer linear forms; for any finite set of points, one of them separates it.

    The forms are the coordinates, last first, and then (1, k, k^2, ...) for k = 1, 2, ... At most
    n - 1 of the latter have equal values at two different points. So all but finitely many of them
    separate a finite set.

    >>> from itertools import islice
    >>> list(islice(separating_forms(2), 4))
    [(0, 1), (1, 0), (1, 1), (1, 2)]
    """
    for i in reversed(range(size)):
        yield tuple(int(k == i) for k in range(size))
    for base in count(1):
        yield tuple(base**k for k in range(size))


@dataclass(frozen=True)
class QuotientAlgebra:
    """The algebra A = Q[x_1, ..., x_n]/I of finite dimension, by its multiplication matrices.

    `basis` holds the exponents of the standard monomials, ascending, so that it begins with that of
    1. `matrices[i]` is the multiplication by x_i on column vectors of coordinates, over Q.

    >>> two_points = from_groebner_basis([{(2,): fmpq(1), (0,): fmpq(-3)}], 1)  # x^2 = 3
    >>> two_points.basis, two_points.matrices[0].tolist()
    (((0,), (1,)), [[0, 3], [1, 0]])
    """

    basis: tuple[Exponent, ...]
    matrices: tuple[fmpq_mat, ...]

    def __reduce__(self) -> tuple[object, ...]:
        return _restored, (self.basis, tuple(m.tolist() for m in self.matrices))  # FLINT's do not

    def __repr__(self) -> str:
        return f"<QuotientAlgebra: dimension {self.dimension}, {len(self.matrices)} unknowns>"

    @property
    def dimension(self) -> int:
        """dim_Q A, which is the number of complex zeros of I with multiplicity."""
        return len(self.basis)

    @property
    def one(self) -> fmpq_mat:
        """The column of coordinates of 1."""
        return fmpq_mat(self.dimension, 1, [1] + [0] * (self.dimension - 1))

    def multiplication(self, form: Sequence[int]) -> fmpq_mat:
        """The matrix of the multiplication by sum form_i x_i."""
        total = fmpq_mat(self.dimension, self.dimension)
        for weight, matrix in zip(form, self.matrices, strict=True):
            if weight:
                total = total + matrix * fmpq(weight)
        return total

    @cached_property
    def traces(self) -> fmpq_mat:
        """The row of the traces Tr(b) of the multiplications by the basis elements b."""
        return fmpq_mat(1, self.dimension, [_trace(m) for m in self._basis_matrices])

    @cached_property
    def _basis_matrices(self) -> list[fmpq_mat]:
        """The multiplications by the basis elements; the basis is closed under division."""
        products = {self.basis[0]: _identity(self.dimension)}
        for exponent in self.basis[1:]:
            i = next(k for k, a in enumerate(exponent) if a)
            products[exponent] = self.matrices[i] * products[lowered(exponent, i)]
        return [products[exponent] for exponent in self.basis]

    @cached_property
    def reduced(self) -> QuotientAlgebra:
        """A modulo its nilpotent elements; its dimension is the number of different zeros.

        The nilpotent elements are the kernel of the trace form (a, b) -> Tr(ab) (Basu, Pollack,
        Roy, Algorithms in Real Algebraic Geometry, theorem 4.102). The basis of the result consists
        of the elements of this basis that are standard for the radical ideal, in the same order.
        """
        form = fmpq_mat([(self.traces * m).tolist()[0] for m in self._basis_matrices])
        echelon, rank = form.rref()
        if rank == self.dimension:
            return self
        rows = echelon.tolist()[:rank]
        pivots = [next(k for k, x in enumerate(row) if x != 0) for row in rows]
        project = fmpq_mat(rows)
        matrices = []
        for matrix in self.matrices:
            columns = (project * matrix).tolist()
            matrices.append(fmpq_mat([[row[k] for k in pivots] for row in columns]))
        return QuotientAlgebra(tuple(self.basis[k] for k in pivots), tuple(matrices))


def _restored(
    basis: tuple[Exponent, ...], matrices: Sequence[Sequence[Sequence[fmpq]]]
) -> QuotientAlgebra:
    return QuotientAlgebra(basis, tuple(fmpq_mat(rows) for rows in matrices))


def from_groebner_basis(basis: Sequence[SparsePolynomial], size: int) -> QuotientAlgebra | None:
    """The quotient algebra of a reduced grevlex Groebner basis; None if it is infinite.

    The normal forms of the border monomials x_i b are computed in ascending order, each from a
    basis element or from a smaller normal form, as in the FGLM algorithm (Faugere, Gianni, Lazard,
    Mora 1993, proposition 3.1). The unit ideal gives the zero algebra, of dimension 0.
    """
    rules = {max(p, key=grevlex_key): p for p in basis}
    standard = standard_monomials(list(rules), size)
    if standard is None:
        return None
    position = {b: k for k, b in enumerate(standard)}
    normal: dict[Exponent, list[fmpq]] = {}
    for b, k in position.items():
        normal[b] = [fmpq(int(j == k)) for j in range(len(standard))]
    border = {raised(b, i) for b in standard for i in range(size)} - set(position)
    for monomial in sorted(border, key=grevlex_key):
        normal[monomial] = (
            _tail(rules[monomial], monomial, normal)
            if monomial in rules
            else _shifted(monomial, standard, position, normal)
        )
    matrices = tuple(
        fmpq_mat([list(row) for row in zip(*(normal[raised(b, i)] for b in standard), strict=True)])
        if standard
        else fmpq_mat(0, 0)
        for i in range(size)
    )
    return QuotientAlgebra(tuple(standard), matrices)


def _tail(
    rule: SparsePolynomial, leading: Exponent, normal: Mapping[Exponent, list[fmpq]]
) -> list[fmpq]:
    """The normal form of the leading monomial of a reduced basis element."""
    result = [fmpq(0)] * len(next(iter(normal.values())))
    for exponent, coefficient in rule.items():
        if exponent != leading:
            weight = -coefficient / rule[leading]
            result = [
                x + weight * y if y else x for x, y in zip(result, normal[exponent], strict=True)
            ]
    return result


def _shifted(
    monomial: Exponent,
    standard: Sequence[Exponent],
    position: Mapping[Exponent, int],
    normal: Mapping[Exponent, list[fmpq]],
) -> list[fmpq]:
    """The normal form of a border monomial x_i m, from that of the smaller border monomial m."""
    i, smaller = next(
        (i, m)
        for i, a in enumerate(monomial)
        if a and (m := lowered(monomial, i)) in normal and m not in position
    )
    result = [fmpq(0)] * len(standard)
    for b, weight in zip(standard, normal[smaller], strict=True):
        if weight:
            result = [
                x + weight * y if y else x
                for x, y in zip(result, normal[raised(b, i)], strict=True)
            ]
    return result


def raised(exponent: Exponent, i: int) -> Exponent:
    """The exponent of x_i x^a."""
    return (*exponent[:i], exponent[i] + 1, *exponent[i + 1 :])


def lowered(exponent: Exponent, i: int) -> Exponent:
    """The exponent of x^a / x_i."""
    return (*exponent[:i], exponent[i] - 1, *exponent[i + 1 :])


def _identity(size: int) -> fmpq_mat:
    return fmpq_mat(size, size, [int(i == j) for i in range(size) for j in range(size)])


def _trace(matrix: fmpq_mat) -> fmpq:
    return sum((matrix[i, i] for i in range(matrix.nrows())), fmpq(0))
