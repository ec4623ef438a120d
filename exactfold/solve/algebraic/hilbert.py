"""Dimension and degree of an ideal, from the leading monomials of a graded Groebner basis."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

from exactfold.solve.algebraic.quotient import Exponent, standard_monomials


def dimension_and_degree(leading: Sequence[Exponent], size: int) -> tuple[int, int]:
    """The Krull dimension and the degree of an ideal with these leading monomials; (-1, 0) for (1).

    The order of monomials must compare total degrees first. Then the number of standard monomials
    of degree at most s is the affine Hilbert function of the ideal. For large s it is a polynomial
    e s^d / d! + ..., where d is the dimension of the zero set over C and e its degree, the sum of
    the degrees of its components of dimension d with their multiplicities (Cox, Little, O'Shea,
    Ideals, Varieties, and Algorithms, chapter 9, section 3). For finitely many zeros e is their
    number with multiplicity.

    Up to O(s^(d-1)), the standard monomials of degree at most s lie in coordinate subspaces of
    dimension d in which no power of the free variables is a leading monomial. Each subspace
    contributes s^d / d! times a number of monomials in the other variables: those that are standard
    if the free variables are set to 1.

    >>> dimension_and_degree([(1, 1)], 2)  # x y = 0: two lines
    (1, 2)
    >>> dimension_and_degree([(2, 0), (0, 2)], 2), dimension_and_degree([(0, 0)], 2)
    ((0, 4), (-1, 0))
    """
    if any(not any(a) for a in leading):
        return -1, 0
    degree, dimension = 0, size
    while not degree:  # this ends: without free variables the monomial 1 is standard
        for free in combinations(range(size), dimension):
            bound = [k for k in range(size) if k not in free]
            rest = [tuple(a[k] for k in bound) for a in leading]
            if all(any(a) for a in rest):  # standard_monomials is finite: no larger set is free
                degree += len(standard_monomials(rest, len(bound)) or ())
        dimension -= 1
    return dimension + 1, degree
