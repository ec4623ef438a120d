"""Statements that are formulas, and their evaluation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from proofs.formulas import Formula, Names, compare, evaluate
from proofs.reading import Text

MEANINGLESS = (LookupError, ZeroDivisionError, TypeError, ValueError, AttributeError)
"""What an expression raises that has no value: such a form does not hold."""


@dataclass(frozen=True)
class Claim:
    """The formulas of a statement, and the geometries in which they are evaluated.

    `over` are free geometries. `at` are geometries with numbers, in which a mistake shows quickly.
    The text `right`, as printed or as corrected, must hold in all of them. If it is a correction,
    the `printed` text must fail in one of `at`.
    """

    key: str
    printed: Text
    right: Text
    over: tuple[Names, ...]
    at: tuple[Names, ...]

    def holds(self, text: Text) -> bool:
        """Whether all formulas of a text hold everywhere."""
        return bool(text.formulas) and all(holds(text, names) for names in (*self.at, *self.over))

    @property
    def is_refuted(self) -> bool:
        """Whether the printed form fails in some environment of `at`."""
        return not all(holds(self.printed, names) for names in self.at)


def holds(text: Text, names: Names) -> bool:
    """Whether all formulas of a text hold if the names have these meanings.

    An expression that is not an equation must have a given value: the k-th such expression has the
    k-th value of `names["values"]`.
    """
    values = iter(names.get("values", ()))
    bare = [f for f in text.formulas if not f.relations]
    pairs = list(zip(bare, values, strict=False))
    if len(pairs) != len(bare) or next(values, None) is not None:
        return False
    return all(is_true(f, names) for f in text.formulas if f.relations) and all(
        _is_value(f, value, names) for f, value in pairs
    )


def is_true(formula: Formula, names: Names) -> bool:
    """Whether all relations hold; False if a name or an index has no value.

    If `names` has a "zero", this function decides whether a difference is zero.
    """
    zero = names.get("zero", is_zero)
    try:
        return all(
            zero(right - left) if relation in ("=", r"\approx") else compare(left, relation, right)
            for left, relation, right in formula.comparisons(names)
        )
    except MEANINGLESS:
        return False


def _is_value(formula: Formula, value: Any, names: Names) -> bool:
    try:
        found = evaluate(formula.sides[0], names)
        return bool(found == value) if isinstance(value, tuple) else is_zero(found - value)
    except MEANINGLESS:
        return False


def is_zero(value: Any) -> bool:
    """Whether a number, a SymPy ring or field element, or a SymPy expression is identically 0.

    Ring and field elements are in normal form, so that `== 0` decides. An expression is first
    brought over one denominator and expanded; this decides for rational functions of its symbols.
    An angle is 0 if its sine is 0 and its cosine is 1.
    """
    if hasattr(value, "is_Matrix") and value.is_Matrix:
        return all(is_zero(entry) for entry in value)
    if hasattr(value, "free_symbols"):
        import sympy

        numerator, _ = sympy.fraction(sympy.together(value))
        return bool(sympy.expand(numerator) == 0)
    if hasattr(value, "sin"):
        return is_zero(value.sin) and is_zero(value.cos - 1)
    return bool(value == 0)
