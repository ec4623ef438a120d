r"""Formulas as expressions that a step can evaluate and that are written as LaTeX.

So a page prints exactly the formula that a step evaluates. `proofs.reading.parse` reads the LaTeX
of the paper into an expression. `Formula.comparisons` evaluates its sides in an environment, which
says what the names mean. `latex` writes it, and `proofs.mutation` puts mistakes into it.

>>> from proofs.reading import parse
>>> f = parse(r"\chi(N+2)=f_{N+1}\chi(N+1)-g_{N,N+1}^2\chi(N)", functions=["chi"])
>>> latex(f)
'\\chi(N+2)=f_{N+1}\\chi(N+1)-g_{N,N+1}^{2}\\chi(N)'
>>> names = {"chi": lambda n: 10 * n, "f": lambda n: n, "g": lambda n, m: n, "N": 2}
>>> f.comparisons(names)  # 3 * 30 - 4 * 20
[(40, '=', 10)]
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import prod
from typing import Any

import sympy

Names = Mapping[str, Any]

TRIGONOMETRY = ("sin", "cos", "tan", "csc", "cot")
RELATIONS = ("=", "<", ">", r"\le", r"\ge", r"\approx")


@dataclass(frozen=True)
class Node:
    """One part of an expression: `kind`, its text (a name, a number, signs, brackets), its parts.

    Kinds: number, name (parts: indices), sum (text: signs), product (text: dots or spaces between),
    quotient (text: "frac" or "/"), power, function (text: sin, ...), sum over an index or product
    over one (text: "sum i", parts: body, and the two ends unless all indices are meant), group
    (text: its brackets), tuple, and truth (a relation in square brackets: 1 if it holds, else 0).
    """

    kind: str
    text: str = ""
    parts: tuple[Node, ...] = ()


@dataclass(frozen=True)
class Formula:
    """A chain of expressions with relations between them, for one index in a range if there is one.

    Without a relation it is an expression. If it is only a name or a number, it is a mention.
    """

    sides: tuple[Node, ...]
    relations: tuple[str, ...] = ()
    index: str = ""
    ends: tuple[Node, ...] = ()

    @property
    def is_mention(self) -> bool:
        """Whether the formula is only a name or a number, so that it says nothing to evaluate."""
        return not self.relations and self.sides[0].kind in ("name", "number")

    def comparisons(self, names: Names) -> list[tuple[Any, str, Any]]:
        """The values of both sides of each relation, for all indices of the range.

        Raises `LookupError` if a name, or a value for an index, is missing.
        """
        if not self.index:
            values = [evaluate(side, names) for side in self.sides]
            return list(zip(values, self.relations, values[1:], strict=False))
        low, high = (int(evaluate(end, names)) for end in self.ends)
        free = replace(self, index="", ends=())
        every = [free.comparisons({**names, self.index: k}) for k in range(low, high + 1)]
        return [one for many in every for one in many]


def evaluate(node: Node, names: Names) -> Any:
    """The value of an expression; names with indices are functions of the indices."""
    kind, text, parts = node.kind, node.text, node.parts
    if kind == "number":
        return int(text)
    if kind == "name":
        written = f"{text}_{','.join(map(latex, parts))}" if parts else text
        if written in names:
            return names[written]
        return names[text](*(evaluate(p, names) for p in parts)) if parts else names[text]
    if kind == "sum":
        terms = [evaluate(p, names) for p in parts]
        signed = [-t if sign == "-" else t for sign, t in zip(text, terms, strict=True)]
        return _total(signed)
    if kind in ("product", "power", "quotient"):
        values = [evaluate(p, names) for p in parts]
        if kind == "product":
            return prod(values[1:], start=values[0])
        if kind == "power":
            return values[0] ** values[1]
        top, bottom = values
        whole = isinstance(top, int) and isinstance(bottom, int)
        return sympy.Rational(top, bottom) if whole else top / bottom
    if kind == "function":
        return _function(text, [evaluate(p, names) for p in parts], names)
    if kind == "group":
        value = evaluate(parts[0], names)
        return abs(value) if text == "|" else value
    if kind == "tuple":
        return tuple(evaluate(p, names) for p in parts)
    if kind == "truth":
        left, right = (evaluate(p, names) for p in parts)
        return int(compare(left, text, right))
    return _over_index(node, names)


def compare(left: Any, relation: str, right: Any) -> bool:
    """Whether an inequality between numbers holds. Equations are decided in `claims`.

    >>> compare(2, r"\\le", 3)
    True
    """
    match relation:
        case "<":
            return bool(left < right)
        case ">":
            return bool(left > right)
        case r"\le":
            return bool(left <= right)
        case r"\ge":
            return bool(left >= right)
    raise ValueError(f"{relation} compares no numbers")


def _over_index(node: Node, names: Names) -> Any:
    operation, _, index = node.text.partition(" ")
    body, *ends = node.parts
    if ends:
        low, high = (int(evaluate(end, names)) for end in ends)
        every: Sequence[int | tuple[int, int]] = range(low, high + 1)
    else:
        every = names["all"]
    bound = re.findall("[a-zA-Z]", index)
    free = [dict(zip(bound, k if isinstance(k, tuple) else (k,), strict=True)) for k in every]
    values = [evaluate(body, {**names, **ks}) for ks in free]
    return _total(values) if operation == "sum" else prod(values[1:], start=values[0])


def _total(values: Sequence[Any]) -> Any:
    total = values[0]
    for value in values[1:]:
        total = total + value
    return total


def _function(text: str, values: list[Any], names: Names) -> Any:
    if text in TRIGONOMETRY:
        (angle,) = values
        if hasattr(angle, "sin"):  # an angle by cosine and sine
            return angle.sin / angle.cos if text == "tan" else getattr(angle, text)
        return getattr(sympy, text)(angle)
    return names[text](*values)


def latex(part: Formula | Node) -> str:
    """The LaTeX of a formula or an expression."""
    if isinstance(part, Formula):
        linked = zip(map(latex, part.sides), (*part.relations, ""), strict=True)
        chain = "".join(_joined([x for pair in linked for x in pair]))
        if part.index:
            low, high = map(latex, part.ends)
            chain += rf",\quad {part.index}={low},\dots,{high}"
        return chain
    kind, text, parts = part.kind, part.text, [latex(p) for p in part.parts]
    if kind == "number":
        return text
    if kind == "name":
        shown = _symbol(text)
        return f"{shown}_{{{','.join(parts)}}}" if parts else shown
    if kind == "sum":
        joined = "".join(sign + term for sign, term in zip(text, parts, strict=True))
        return joined.removeprefix("+")
    if kind == "product":
        dots = [r"\cdot" if joint == "." else "" for joint in text]
        pairs = zip(parts, [*dots, ""], strict=True)
        return "".join(_joined([x for pair in pairs for x in pair if x]))
    if kind == "power":
        return f"{parts[0]}^{{{parts[1]}}}"
    if kind == "quotient":
        return rf"\frac{{{parts[0]}}}{{{parts[1]}}}" if text == "frac" else "/".join(parts)
    if kind == "function":
        known = text in TRIGONOMETRY
        return "".join(_joined([f"\\{text}" if known or len(text) > 1 else text, *parts]))
    if kind == "group":
        closing = {"(": ")", "[": "]", "|": "|", r"\{": r"\}"}[text]
        tall = r"\frac" in parts[0] or r"\sum" in parts[0]
        return rf"\left{text}{parts[0]}\right{closing}" if tall else text + parts[0] + closing
    if kind == "tuple":
        return f"({','.join(parts)})"
    if kind == "truth":
        return f"[{text.join(parts)}]"
    operation, _, index = part.text.partition(" ")
    plain = index if len(index) == 1 else f"{{{index}}}"
    ends = f"_{{{index}={parts[1]}}}^{{{parts[2]}}}" if len(parts) == 3 else f"_{plain}"
    return "".join(_joined([rf"\{operation}{ends}", parts[0]]))


def _symbol(text: str) -> str:
    if "_" in text:  # with what is written below it
        return text
    words = text.split(" ")
    shown = [w if len(w.rstrip("~0")) == 1 else f"\\{w.rstrip('~0')}" for w in words]
    shown[-1] = shown[-1].rstrip("~0")
    if text.endswith("~"):
        shown[-1] = rf"\tilde{{{shown[-1]}}}"
    return "".join(_joined(shown)) + ("^0" if text.endswith("0") else "")


def _joined(parts: list[str]) -> Iterator[str]:
    """Parts, with a space where a command would swallow the letter that follows it."""
    for k, part in enumerate(parts):
        command = k and re.search(r"\\[a-zA-Z]+$", parts[k - 1])
        yield f" {part}" if command and part[:1].isalpha() else part
