"""All formulas and texts with one mistake, which a step must refuse.

`survivors` puts each of them in place of the right statement, and evaluates it in the geometries
of the step: first in those with numbers, where nearly all fail at once.

>>> from proofs.formulas import latex
>>> from proofs.reading import parse
>>> " ".join(latex(wrong) for wrong in mutants(parse("D=V_e-3")))
'e=V_{e}-3 D=V_{D}-3 D=-V_{e}-3 D=V_{e}+3 D=-3 D=V_{e} D=V_{e+1}-3 D=V_{e}-4'
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from proofs.claims import Claim
from proofs.formulas import Formula, Node
from proofs.reading import Text

_SWAPS = {"sin": "cos", "cos": "sin", "csc": "cot", "cot": "csc", "tan": "cot"}
_OPPOSITE = {"<": ">", ">": "<", r"\le": r"\ge", r"\ge": r"\le"}


def survivors(claim: Claim) -> list[str]:
    """The texts with one mistake that hold nevertheless, as LaTeX."""
    return [wrong.latex for wrong in garbled(claim.right) if claim.holds(wrong)]


def garbled(text: Text) -> Iterator[Text]:
    """Every text with one mistake in one of its formulas."""
    for k, part in enumerate(text.parts):
        if isinstance(part, Formula) and text.says(part):
            for wrong in mutants(part):
                yield replace(text, parts=(*text.parts[:k], wrong, *text.parts[k + 1 :]))


def mutants(formula: Formula) -> list[Formula]:
    """Every formula with one mistake.

    The mistake is in a sign, an index, a number, a function, a factor, a name, a relation or a
    range.
    """
    found = [
        replace(formula, sides=(*formula.sides[:k], wrong, *formula.sides[k + 1 :]))
        for k, side in enumerate(formula.sides)
        for wrong in _renamed(side, sorted({n.text for s in formula.sides for n in _names(s)}))
    ]
    for k, side in enumerate(formula.sides):
        for wrong in _mutated(side):
            found.append(
                replace(formula, sides=(*formula.sides[:k], wrong, *formula.sides[k + 1 :]))
            )
    for k, relation in enumerate(formula.relations):
        if relation in _OPPOSITE:
            other = (*formula.relations[:k], _OPPOSITE[relation], *formula.relations[k + 1 :])
            found.append(replace(formula, relations=other))
    for k, end in enumerate(formula.ends):
        for shift in "+-":
            moved = Node("sum", f"+{shift}", (end, Node("number", "1")))
            found.append(replace(formula, ends=(*formula.ends[:k], moved, *formula.ends[k + 1 :])))
    return found


def _names(node: Node) -> Iterator[Node]:
    """All names without indices."""
    if node.kind == "name" and not node.parts:
        yield node
    for part in node.parts:
        yield from _names(part)


def _renamed(node: Node, names: list[str]) -> Iterator[Node]:
    """All expressions with another name in one place; indices of sums are not changed."""
    if node.kind == "name" and not node.parts:
        yield from (replace(node, text=other) for other in names if other != node.text)
    for k, part in enumerate(node.parts):
        for wrong in _renamed(part, names):
            yield replace(node, parts=(*node.parts[:k], wrong, *node.parts[k + 1 :]))


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
            yield rest[0] if len(rest) == 1 else Node(kind, " " * (len(rest) - 1), rest)
    elif kind == "quotient":
        yield replace(node, parts=(parts[1], parts[0]))
        yield parts[0]
    elif kind == "power":
        yield parts[0]
    elif kind == "truth":
        yield replace(node, text=_OPPOSITE[text])
    elif kind == "tuple":
        yield replace(node, parts=parts[::-1])
    elif kind == "function" and text in _SWAPS:
        yield replace(node, text=_SWAPS[text])
    elif kind == "name":
        for k, part in enumerate(parts):
            if part.kind != "name" or len(part.text) == 1:
                moved = Node("sum", "++", (part, Node("number", "1")))
                yield replace(node, parts=(*parts[:k], moved, *parts[k + 1 :]))
