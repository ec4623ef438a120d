"""Signs of densities are exact where an enclosure of 64 bits leaves them open."""

from fractions import Fraction

from exactfold.exact.surds import RATIONALS
from exactfold.panels.modes.densities import Density, Roots


def test_sign_of_a_density_that_almost_cancels() -> None:
    root = RATIONALS.adjoined(2).root
    roots = Roots(root.field)
    p, q = 1, 1
    for _ in range(80):
        p, q = p + 2 * q, p + q  # p^2 - 2 q^2 changes its sign each time
        density = roots.density(p - q * root)
        assert density.sign == p * p - 2 * q * q


def test_sign_of_a_product_with_factors() -> None:
    roots = Roots(RATIONALS)
    gains = [1 - RATIONALS.adjoined(n).root for n in (2, 3, 5, 7, 11)]
    product: Density = roots.density(Fraction(1))
    for count, gain in enumerate(gains, 1):
        product = product.times(roots.density(gain))
        assert product.sign == (-1) ** count
    assert len(product.factors) > 0
    assert product.over(roots.density(gains[-1])).sign == 1
