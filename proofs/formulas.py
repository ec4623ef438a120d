r"""Formulas as expressions: read from LaTeX, evaluated by a step, written as LaTeX again.

What a page prints as a formula is what a step evaluates: `parse` reads the LaTeX of the paper into
an expression, `Formula.differences` evaluates its sides in an environment that says what the names
mean, and `latex` writes it. `mutants` are all formulas with one small mistake.

>>> f = parse(r"\chi(N+2)=f_{N+1}\chi(N+1)-g_{N,N+1}^2\chi(N)", functions=["chi"])
>>> latex(f)
'\\chi(N+2)=f_{N+1}\\chi(N+1)-g_{N,N+1}^{2}\\chi(N)'
>>> names = {"chi": lambda n: 10 * n, "f": lambda n: n, "g": lambda n, m: n, "N": 2}
>>> f.differences(names)  # 40 - (3 * 30 - 4 * 20)
[-30]
>>> len(mutants(f)) > 10
True
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
_SKIPPED = {r"\left", r"\right", r"\big", r"\Big", r"\,", r"\;", r"\!", r"\quad", r"\qquad", r"\ "}
_DECORATIONS = {r"\mathbf", r"\tilde", r"\bm", r"\mathrm"}
_PREFIXES = {r"\Delta", r"\delta"}
_CLOSING = {"(": ")", "[": "]", r"\{": r"\}"}
_STOPS = {"", "=", "+", "-", ",", ")", "]", r"\}", "}"}


@dataclass(frozen=True)
class Node:
    """One part of an expression: `kind`, its text (a name, a number, signs, brackets), its parts.

    Kinds: number, name (parts: indices), sum (text: signs), product, quotient (text: "frac" or
    "/"), power, function (text: sin, ...), sum over an index or product over one (text: "sum i",
    parts: body, and the two ends unless all indices are meant), group (text: its brackets).
    """

    kind: str
    text: str = ""
    parts: tuple[Node, ...] = ()


@dataclass(frozen=True)
class Formula:
    """A chain of equal expressions, for one index in a range if there is one."""

    sides: tuple[Node, ...]
    index: str = ""
    ends: tuple[Node, ...] = ()

    def differences(self, names: Names) -> list[Any]:
        """Each side less the first, for all indices of the range; all 0 where the formula holds.

        Raises `LookupError` if a name, or a value for an index, is missing.
        """
        if not self.index:
            first, *others = (evaluate(side, names) for side in self.sides)
            return [other - first for other in others]
        low, high = (int(evaluate(end, names)) for end in self.ends)
        free = replace(self, index="", ends=())
        every = [free.differences({**names, self.index: k}) for k in range(low, high + 1)]
        return [d for one in every for d in one]


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
    return _over_index(node, names)


def _over_index(node: Node, names: Names) -> Any:
    operation, _, index = node.text.partition(" ")
    body, *ends = node.parts
    if ends:
        low, high = (int(evaluate(end, names)) for end in ends)
        every: Sequence[int] = range(low, high + 1)
    else:
        every = names["all"]
    values = [evaluate(body, {**names, index: k}) for k in every]
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
        chain = "=".join(map(latex, part.sides))
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
        return "".join(_joined(parts))
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
    operation, _, index = part.text.partition(" ")
    ends = f"_{{{index}={parts[1]}}}^{{{parts[2]}}}" if len(parts) == 3 else f"_{index}"
    return "".join(_joined([rf"\{operation}{ends}", parts[0]]))


def _symbol(text: str) -> str:
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
        yield f" {part}" if command and part[0].isalpha() else part


def parse(text: str, functions: Sequence[str] = ()) -> Formula:
    """The formula of a LaTeX text. Raises `ValueError` where it has something else in it."""
    found = re.fullmatch(r"(.*),\\q?quad\s*([a-z])=(.*),\\dots,(.*)", text, re.DOTALL)
    chain, index, ends = (found[1], found[2], (found[3], found[4])) if found else (text, "", ())
    reader = _Reader(chain, functions)
    sides = [reader.sum()]
    while reader.peek() == "=":
        reader.take()
        sides.append(reader.sum())
    reader.finish()
    return Formula(tuple(sides), index, tuple(expression(end, functions) for end in ends))


def expression(text: str, functions: Sequence[str] = ()) -> Node:
    """One side of a formula."""
    reader = _Reader(text, functions)
    node = reader.sum()
    reader.finish()
    return node


class _Reader:
    """Recursive descent over the tokens of a LaTeX formula."""

    def __init__(self, text: str, functions: Sequence[str]) -> None:
        tokens = re.findall(r"\\[a-zA-Z]+|\\.|\d+|[^\s&]", text)
        self.tokens = [t for t in tokens if t not in _SKIPPED]
        self.functions = functions
        self.at = 0
        self.in_bars = False

    def peek(self, ahead: int = 0) -> str:
        at = self.at + ahead
        return self.tokens[at] if at < len(self.tokens) else ""

    def take(self, *expected: str) -> str:
        token = self.peek()
        if not token or (expected and token not in expected):
            raise ValueError(f"{token or 'the end'} where {expected or 'more'} is expected")
        self.at += 1
        return token

    def finish(self) -> None:
        if self.peek():
            raise ValueError(f"no formula: {''.join(self.tokens[self.at :])}")

    def sum(self) -> Node:
        signs, terms = "", []
        while True:
            signs += self.take() if self.peek() in ("+", "-") else "+"
            terms.append(self.product())
            if self.peek() not in ("+", "-"):
                break
        return terms[0] if signs == "+" else Node("sum", signs, tuple(terms))

    def product(self) -> Node:
        factors = [self.factor()]
        while self.peek() not in _STOPS and not (self.peek() == "|" and self.in_bars):
            if self.peek() == "/":
                self.take()
                top = factors[0] if len(factors) == 1 else Node("product", "", tuple(factors))
                factors = [Node("quotient", "/", (top, self.factor()))]
                continue
            if self.peek() == r"\cdot":
                self.take()
            factors.append(self.factor())
        return factors[0] if len(factors) == 1 else Node("product", "", tuple(factors))

    def factor(self) -> Node:
        base = self.base()
        if self.peek() == "^":
            self.take()
            base = Node("power", "", (base, self.argument()))
        return base

    def argument(self) -> Node:
        """What follows ^, _ or a command: one token, or a group in braces."""
        if self.peek() != "{":
            return self.base()
        self.take("{")
        node = self.sum()
        self.take("}")
        return node

    def base(self) -> Node:
        token = self.take()
        if token.isdigit():
            return Node("number", token)
        if token in (r"\frac", r"\tfrac"):
            return Node("quotient", "frac", (self.argument(), self.argument()))
        if token in _CLOSING:
            inside = self.sum()
            self.take(_CLOSING[token])
            return Node("group", token, (inside,))
        if token == "|":
            self.in_bars = True
            inside = self.sum()
            self.in_bars = False
            self.take("|")
            return Node("group", "|", (inside,))
        if token == "{":
            inside = self.sum()
            self.take("}")
            return inside
        if token in (r"\sum", r"\prod"):
            return self.over_index(token[1:])
        if token[1:] in TRIGONOMETRY:
            return Node("function", token[1:], (self.base(),))
        return self.name(token)

    def over_index(self, operation: str) -> Node:
        self.take("_")
        ends: list[Node] = []
        if self.peek() == "{":
            self.take()
            index = self.take()
            self.take("=")
            ends.append(self.sum())
            self.take("}")
            self.take("^")
            ends.append(self.argument())
        else:
            index = self.take()
        body = self.product()
        return Node("over", f"{operation} {index}", (body, *ends))

    def name(self, token: str) -> Node:
        words = []
        while token in _PREFIXES and (self.peek().isalpha() or self.peek().startswith("\\")):
            words.append(token[1:])
            token = self.take()
        tilde = token == r"\tilde"
        if token in _DECORATIONS:
            token = self.take()
            if token == "{":
                token = self.take()
                self.take("}")
        if not re.fullmatch(r"\\?[a-zA-Z]+", token):
            raise ValueError(f"{token} is no name")
        words.append(token.removeprefix("\\") + "~" * tilde)
        text = " ".join(words)
        if self.peek() == "^" and self.peek(1) == "0" and self.peek(2) == "_":
            self.at += 2
            text += "0"
        indices: list[Node] = []
        if self.peek() == "_":
            self.take()
            if self.peek() == "{":
                self.take()
                indices.append(self.sum())
                while self.peek() == ",":
                    self.take()
                    indices.append(self.sum())
                self.take("}")
            else:
                indices.append(self.base())
        elif text in self.functions and self.peek() == "(":
            self.take()
            inside = self.sum()
            self.take(")")
            return Node("function", text, (Node("group", "(", (inside,)),))
        return Node("name", text, tuple(indices))


_SWAPS = {"sin": "cos", "cos": "sin", "csc": "cot", "cot": "csc", "tan": "cot"}


def mutants(formula: Formula) -> list[Formula]:
    """Every formula with one mistake: a sign, an index, a number, a function, a factor, a place."""
    found = []
    for k, side in enumerate(formula.sides):
        for wrong in _mutated(side):
            found.append(
                replace(formula, sides=(*formula.sides[:k], wrong, *formula.sides[k + 1 :]))
            )
    for k, end in enumerate(formula.ends):
        for shift in "+-":
            moved = Node("sum", f"+{shift}", (end, Node("number", "1")))
            found.append(replace(formula, ends=(*formula.ends[:k], moved, *formula.ends[k + 1 :])))
    return found


def _mutated(node: Node) -> Iterator[Node]:
    """All expressions with one mistake in this one."""
    yield from _mistakes(node)
    for k, part in enumerate(node.parts):
        for wrong in _mutated(part):
            yield replace(node, parts=(*node.parts[:k], wrong, *node.parts[k + 1 :]))


def _mistakes(node: Node) -> Iterator[Node]:
    """Mistakes at the top of an expression."""
    kind, text, parts = node.kind, node.text, node.parts
    if kind == "number":
        yield replace(node, text=str(int(text) + 1))
    elif kind == "sum":
        for k, sign in enumerate(text):
            flipped = "-" if sign == "+" else "+"
            yield replace(node, text=text[:k] + flipped + text[k + 1 :])
        if len(parts) > 1:
            for k in range(len(parts)):
                yield replace(node, text=text[:k] + text[k + 1 :], parts=parts[:k] + parts[k + 1 :])
    elif kind == "product":
        for k in range(len(parts)):
            rest = parts[:k] + parts[k + 1 :]
            yield rest[0] if len(rest) == 1 else replace(node, parts=rest)
    elif kind == "quotient":
        yield replace(node, parts=(parts[1], parts[0]))
        yield parts[0]
    elif kind == "power":
        yield parts[0]
    elif kind == "function" and text in _SWAPS:
        yield replace(node, text=_SWAPS[text])
    elif kind == "name":
        for k, part in enumerate(parts):
            if part.kind != "name" or len(part.text) == 1:
                moved = Node("sum", "++", (part, Node("number", "1")))
                yield replace(node, parts=(*parts[:k], moved, *parts[k + 1 :]))
