r"""Reading formulas, and texts with formulas in them, from the LaTeX of the paper.

>>> text = read(r"D=V_e-3\text{, and }2\text{ lines}")
>>> text.latex
'D=V_{e}-3\\text{, and }2\\text{ lines}'
>>> [latex(formula) for formula in text.formulas]
['D=V_{e}-3']
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from proofs.formulas import RELATIONS, TRIGONOMETRY, Formula, Node, latex

_SKIPPED = {r"\left", r"\right", r"\big", r"\Big", r"\,", r"\;", r"\!", r"\quad", r"\qquad", r"\ "}
_DECORATIONS = {r"\mathbf", r"\tilde", r"\bm", r"\mathrm"}
_PREFIXES = {r"\Delta", r"\delta"}
_CLOSING = {"(": ")", "[": "]", r"\{": r"\}"}
_STOPS = {"", "+", "-", ",", ")", "]", r"\}", "}", *RELATIONS}


@dataclass(frozen=True)
class Text:
    """Words in LaTeX, with the spaces and commas beside them, and formulas."""

    parts: tuple[str | Formula, ...]
    mentions: bool = False

    @property
    def formulas(self) -> tuple[Formula, ...]:
        """The formulas to evaluate; single names and numbers are among them only if `mentions`."""
        return tuple(p for p in self.parts if isinstance(p, Formula) and self.says(p))

    def says(self, formula: Formula) -> bool:
        """Whether a formula of the text says something that has to be evaluated."""
        return self.mentions or not formula.is_mention

    @property
    def expressions(self) -> int:
        """The number of formulas that are neither equations nor inequalities."""
        return sum(not formula.relations for formula in self.formulas)

    @property
    def latex(self) -> str:
        """The text as LaTeX; its formulas are written anew."""
        return "".join(part if isinstance(part, str) else latex(part) for part in self.parts)


_RANGE = re.compile(r"[a-z]=.*\\dots")


def read(text: str, functions: Sequence[str] = (), mentions: bool = False) -> Text:
    """Read a text: words are in `\\text{...}`, and `,\\quad` or `;\\quad` separate formulas.

    Raises `ValueError` if anything else is not a formula.
    """
    parts: list[str | Formula] = []
    for is_prose, content in pieces(" ".join(text.split())):
        if is_prose:
            parts.append(rf"\text{{{content}}}")
            continue
        found = re.split(r"([,;]\\quad\s*)", content)
        while (k := next((k for k, x in enumerate(found) if k and _RANGE.match(x)), 0)) > 0:
            found[k - 2 : k + 1] = ["".join(found[k - 2 : k + 1])]
        for one in found:
            before, formula, after = _trimmed(one)
            parts += [x for x in (before, formula and parse(formula, functions), after) if x]
    return Text(tuple(parts), mentions)


def _trimmed(content: str) -> tuple[str, str, str]:
    """A formula without the spaces and commas before and after it."""
    edges = r"((?:\\(?:quad|qquad|[,;:\s])|[,;:.]|\s)*)"
    found = re.fullmatch(rf"{edges}(.*?){edges}", content)
    return (found[1], found[2], found[3]) if found else ("", content, "")


def pieces(latex: str) -> list[tuple[bool, str]]:
    """LaTeX cut at its outermost `\\text{...}`: pairs (whether it is prose, content)."""
    found, start, at = [], 0, 0
    depth = 0
    while at < len(latex):
        if depth == 0 and latex.startswith(r"\text{", at):
            end, level = at + len(r"\text{"), 1
            while level:
                level += {"{": 1, "}": -1}.get(latex[end], 0)
                end += 1
            found += [(False, latex[start:at]), (True, latex[at + len(r"\text{") : end - 1])]
            start = at = end
            continue
        depth += {"{": 1, "}": -1}.get(latex[at], 0)
        at += 2 if latex[at] == "\\" else 1
    return [*found, (False, latex[start:])]


def parse(text: str, functions: Sequence[str] = ()) -> Formula:
    """Read the formula of a LaTeX text. Raises `ValueError` if the text has anything else in it.

    `functions` are names of functions, which brackets follow; "_" in a name begins its subscript.
    """
    found = re.fullmatch(r"(.*),\\q?quad\s*([a-z])=(.*),\\dots,(.*)", text, re.DOTALL)
    chain, index, ends = (found[1], found[2], (found[3], found[4])) if found else (text, "", ())
    reader = _Reader(chain, functions)
    sides, relations = [reader.sum()], []
    while reader.peek() in RELATIONS:
        relations.append(reader.take())
        sides.append(reader.sum())
    reader.finish()
    limits = tuple(expression(end, functions) for end in ends)
    return Formula(tuple(sides), tuple(relations), index, limits)


def expression(text: str, functions: Sequence[str] = ()) -> Node:
    """One side of a formula."""
    reader = _Reader(text, functions)
    node = reader.sum()
    reader.finish()
    return node


class _Reader:
    """Recursive descent over the tokens of a LaTeX formula."""

    def __init__(self, text: str, functions: Sequence[str]) -> None:
        below = "".join(f"{re.escape(name)}|" for name in functions if "_" in name)
        tokens = re.findall(below + r"\\[a-zA-Z]+|\\.|\d+|[^\s&]", text)
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
        factors, joints = [self.factor()], ""
        while self.peek() not in _STOPS and not (self.peek() == "|" and self.in_bars):
            if self.peek() == "/":
                self.take()
                top = factors[0] if len(factors) == 1 else Node("product", joints, tuple(factors))
                factors, joints = [Node("quotient", "/", (top, self.factor()))], ""
                continue
            dotted = self.peek() == r"\cdot"
            if dotted:
                self.take()
            joints += "." if dotted else " "
            factors.append(self.factor())
        return factors[0] if len(factors) == 1 else Node("product", joints, tuple(factors))

    def factor(self) -> Node:
        base = self.base()
        if self.peek() == "^":
            self.take()
            base = Node("power", "", (base, self.argument()))
        return base

    def argument(self) -> Node:
        """Read the argument of ^, _ or a command: one token, or a group in braces."""
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
            several = [self.sum()]
            if token == "[" and self.peek() in RELATIONS:
                relation = self.take()
                truth = Node("truth", relation, (several[0], self.sum()))
                self.take("]")
                return truth
            while self.peek() == ",":
                self.take()
                several.append(self.sum())
            self.take(_CLOSING[token])
            if len(several) > 1:
                return Node("tuple", "", tuple(several))
            return Node("group", token, (several[0],))
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
            if index == "(":  # over pairs of indices
                index = f"({self.take()}{self.take(',')}{self.take()}{self.take(')')}"
                self.take("}")
            else:
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
        if "_" in token:
            return Node("name", token)
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
        if token.isdigit():  # a vector
            return Node("number", token)
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
