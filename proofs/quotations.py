r"""The words and formulas that are printed in the paper, compared with its source.

`Statement.source` is the text that a statement gives as printed. It is cut at dots, at quotation
marks and between formulas. Each fragment must stand in the LaTeX source of the paper; spaces,
fonts, braces, square brackets, underscores and the alignment of formulas do not count. The source
is not part of this project: `docs/read_paper.py` reads it and keeps a digest of each statement, and
the tests compare with these digests.

>>> fragments(r"D=V_{e}-3\text{, ``which is \dots\ small''}")
['D=Ve-3', 'whichis', 'small']
>>> stands_in(r"D=V_{e}-3", r"\[D = V_e - 3.\] This is"), stands_in("D=3", "D = V_e = 3")
(True, False)
"""

from __future__ import annotations

import hashlib
import re

UNPRINTED = {"B.23": "printed for three spokes (B.16), and for more in words"}
"""Statements that are not printed in this form, and why: a step evaluates each of them."""

_GONE = re.compile(
    r"(?<!\\)%.*|\\label\{[^}]*\}|\\(?:begin|end)\{(?:align|eqnarray|equation)\*?\}|"
    r"\\(?:left|right)\.?(?![a-zA-Z])|"
    r"\\(?:nonumber|cdot|mathbf|bm|boldsymbol|textrm|mathrm|text|textit|em|big|Big|quad|qquad)"
    r"(?![a-zA-Z])|\\[\\,;! ]|[{}$&~_\s]|(?<!\\)[\[\]]"
)
_CUT = re.compile(r"\\dots|``|''|[,;]\\quad")


def plain(latex: str) -> str:
    """A LaTeX source without the signs that do not count."""
    return _GONE.sub("", re.sub(r"(?<!\\)%.*", "", latex))


def fragments(printed: str) -> list[str]:
    """The fragments that must stand in the paper, in the order in which a statement gives them."""
    found = (plain(part).strip(",;:.") for part in _CUT.split(printed))
    return [part for part in found if part]


def missing(printed: str, paper: str) -> list[str]:
    """The fragments that do not stand in the LaTeX source of the paper."""
    text = plain(paper)
    return [part for part in fragments(printed) if part not in text]


def stands_in(printed: str, paper: str) -> bool:
    """Whether each fragment stands in the LaTeX source of the paper."""
    return not missing(printed, paper)


def digest(printed: str) -> str:
    """A short digest of the fragments."""
    return hashlib.sha256("\n".join(fragments(printed)).encode()).hexdigest()[:12]
