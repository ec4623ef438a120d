"""Several forms that are left on one space: sums of them, and their values modulo a prime."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import product

from ..core.towers import Number
from .forms import Forms, Squares
from .modular import MOST_VARIABLES, Matrix, only_zero, reduced_forms
from .proposed import definite_weights
from .reduction import Work, in_floats, zero

MOST_SUMMED = 4


def narrowing_sum(spaces: Forms, forms: Mapping[int, Squares], size: int) -> Squares:
    """A sum of forms that is semidefinite, or a product of two linear functions; or [].

    It vanishes where the forms do. At most `MOST_SUMMED` forms are added: first with signs, and
    then with weights that floating point proposes.
    """
    if not 1 < len(forms) <= MOST_SUMMED:
        return []
    number = spaces.sheet.tower.number
    for signs in product((0, 1, -1), repeat=len(forms)):
        used = [(number(s), form) for s, form in zip(signs, forms.values(), strict=True) if s]
        if len(used) < 2 or used[0][0].sign() < 0:
            continue
        found: Squares = []
        for d, values in spaces.diagonalised(_added(spaces, used, size)):
            found.append((d, values))
            if len(found) > 2 and len({weight.sign() for weight, _ in found}) > 1:
                break
        else:
            if found:
                return found
    weights = definite_weights([in_floats(form) for form in forms.values()], spaces.work)
    if weights is None:
        return []
    used = [(number(Fraction(x)), form) for x, form in zip(weights, forms.values(), strict=True)]
    found = list(spaces.diagonalised(_added(spaces, used, size)))
    return found if len({d.sign() for d, _ in found}) == 1 else []


def vanish_only_at_zero(work: Work, forms: Mapping[int, Squares], size: int) -> bool:
    """Whether the forms are shown to vanish together only at 0.

    There must be at least as many forms as the space has dimensions.
    """
    if not 1 < size <= min(len(forms), MOST_VARIABLES):
        return False
    reduced = modulo_a_prime(list(forms.values()), work)
    return reduced is not None and only_zero(*reduced, work)


def _added(spaces: Forms, forms: Sequence[tuple[Number, Squares]], size: int) -> list[list[Number]]:
    """The matrix of a sum of forms, each times a number, on a basis of so many motions."""
    nothing = spaces.sheet.tower.number(0)
    total = [[nothing] * size for _ in range(size)]
    for s, form in forms:
        for d, values in form:
            some = [(k, x) for k, x in enumerate(values) if not zero(x)]
            spaces.work.count(len(some) ** 2, d)
            for j, x in some:
                scaled = s * (d * x)
                for k, y in some:
                    total[j][k] = total[j][k] + scaled * y
    return total


def modulo_a_prime(forms: Sequence[Squares], work: Work) -> tuple[list[Matrix], int] | None:
    """The matrices of forms modulo a prime, and the prime; None if no prime is found."""
    towers = [x.tower for form in forms for d, row in form for x in (d, *row)]
    tower = max(towers, key=lambda tower: tower.size)
    weighted = [
        [(tower.number(d).parts, [tower.number(x).parts for x in row]) for d, row in form]
        for form in forms
    ]
    return reduced_forms(weighted, tower.radicands, work)
