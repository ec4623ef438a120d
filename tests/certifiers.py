"""The certifiers: whatever is listed here must pass tests/contract/test_certifiers.py."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from rivals import ball_krawczyk

from exactfold._support.verdict import Verdict
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.certify import ball_newton, exact_krawczyk
from exactfold.solve.certify.box import IsolatingBox, Uncertified

Certify = Callable[..., list[IsolatingBox | Uncertified]]
Decide = Callable[[QuadraticSystem, IsolatingBox], Verdict]


@dataclass(frozen=True)
class Certifier:
    """Boxes around candidates, and a verdict on a given box."""

    name: str
    certify: Certify
    decide: Decide

    def __str__(self) -> str:
        return self.name


CERTIFIERS = [
    Certifier("krawczyk", exact_krawczyk.krawczyk, exact_krawczyk.decide_contains_one_zero),
    Certifier(
        "interval_newton",
        ball_newton.interval_newton,
        ball_newton.decide_contains_one_zero,
    ),
    Certifier("arb_krawczyk", ball_krawczyk.arb_krawczyk, ball_krawczyk.decide_contains_one_zero),
]
