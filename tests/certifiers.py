"""The certifiers: whatever is listed here must pass tests/contract/test_certifiers.py."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from exactfold.certify import arb_krawczyk, interval_newton, krawczyk
from exactfold.certify.box import IsolatingBox, Uncertified
from exactfold.problem.quadratic import QuadraticSystem
from exactfold.verdict import Verdict

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
    Certifier("krawczyk", krawczyk.krawczyk, krawczyk.decide_contains_one_zero),
    Certifier(
        "interval_newton",
        interval_newton.interval_newton,
        interval_newton.decide_contains_one_zero,
    ),
    Certifier("arb_krawczyk", arb_krawczyk.arb_krawczyk, arb_krawczyk.decide_contains_one_zero),
]
