"""Counts of the table of random squares, and of Appendix D."""

from __future__ import annotations

import sys
from fractions import Fraction
from pathlib import Path

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import sympy

from exactfold.branches import count_branches
from exactfold.exact.linalg import rank
from exactfold.pattern import families
from exactfold.rigidity.functionals import fold_functional
from proofs.framework import Proof, Script, run
from proofs.statements import Severity

NAME = "table_counts"
TITLE = "Counts of the table and of Appendix D"

TABLE = {2: (100, 0, 0), 3: (5000, 0, 0), 4: (1000, 2, 0), 5: (1000, 1, 17)}
TABLE |= {6: (1000, 1, 28), 7: (300, 0, 17), 8: (50, 0, 8)}
"""Table (summary) by Vi: triangulations generated, with Vt > 0, with MV duplicates."""


def prove(change: str | None = None) -> Proof:
    """Check the numbers that the paper quotes from computations, and Appendix D's dimensions."""
    script = Script(NAME, TITLE, ("a triangulated disk with Vi, Ve vertices",), change)
    _table(script)
    _appendix(script)
    return script.proof()


def _table(script: Script) -> None:
    duplicates = [TABLE[v][2] for v in (5, 6, 7, 8)]
    fractions = [Fraction(TABLE[v][2], TABLE[v][0]) for v in (5, 6, 7, 8)]
    checked = script.alter("numbers instead of fractions", fractions, [*map(Fraction, duplicates)])
    script.counterexample(
        "MV duplicates for Vi = 5 to 8: 17, 28, 17, 8 do not increase, their fractions do",
        sorted(checked) == checked and sorted(duplicates) != duplicates,
        of="IIIA.8",
        against="IIIA.8",
    )
    column = script.alter("column of the duplicates", 1, 2)
    total, special = (sum(row[k] for row in TABLE.values()) for k in (0, column))
    script.certificate(
        "4 of 8450 patterns have triangulated triangles, 4 of the 3350 with Vi >= 4",
        (total, special) == (8450, 4) and sum(TABLE[v][0] for v in range(4, 9)) == 3350,
        of="IIIA.9",
    )
    script.state(
        "IIIA.8",
        "Section III A, last paragraph",
        r"\text{``with }V_i=5,6,7,8\text{ we found an increasing number of crease patterns''}",
        r"\text{an increasing fraction: }1.7\%,\ 2.8\%,\ 5.7\%,\ 16\%",
        "the numbers in Table (summary) are 17, 28, 17, 8; the Discussion says fraction",
        severity=Severity.TYPO,
    )
    script.state(
        "IIIA.9",
        "Section III A and Introduction",
        r"\text{``a very small number of systems (}2\text{ with }V_i=4\text{, }1\text{ with "
        r"}V_i=5\text{ and }1\text{ with }V_i=6\text{'' \dots\ ``appearing with frequency "
        r"}\sim1/1000\text{''}",
        note="Remark: 4 of 3350 with Vi >= 4, where exceptions are possible; 4 of 8450 in all",
    )


def _appendix(script: Script) -> None:
    square = script.alter("vectors instead of pairs", 2, 1)
    pairs = {v: TABLE[v][0] * 2 ** (square * (v + 1)) for v in TABLE}
    script.certificate(
        "angle pairs for Vi = 8: 2/3 of those for Vi = 7 and 4/5 of those for Vi = 6",
        Fraction(pairs[8], pairs[7]) == Fraction(2, 3)
        and Fraction(pairs[8], pairs[6]) == Fraction(4, 5),
        of="D.7",
    )
    sheets = [families.two_vertex(), families.hypar(1), families.h1_sequence(5)]
    spaces = []
    for pattern in sheets:
        rows = [fold_functional(pattern, f) for f in pattern.folds]
        bends = rank([[row.get(v, 0) for v in range(len(pattern.vertices))] for row in rows])
        spaces.append((len(rows), bends))
    counts = [(p.Vi, 2 * (count_branches(p).distinct or 0)) for p in sheets[:2]]
    state = script.state
    place = "Appendix D"
    script.formula(
        "D.1",
        place,
        r"\text{``lines in the }3V_i+1\text{-dimensional space of infinitesimal changes in "
        r"dihedral angle''}",
        at=[
            {"V_i": p.Vi, "values": (folds,)} for p, (folds, _) in zip(sheets, spaces, strict=True)
        ],
    )
    script.formula(
        "D.2",
        place,
        r"\text{``the branches lie in a }V_i+1\text{-dimensional linear subspace''}",
        at=[
            {"V_i": p.Vi, "values": (bends,)} for p, (_, bends) in zip(sheets, spaces, strict=True)
        ],
        note="Remark: heights modulo planes embed into the bends (IIA.13)",
    )
    script.formula(
        "D.3",
        place,
        r"\text{``we have }2^{V_i+1}\text{ vectors. We then compute the }(2^{V_i+1})^2\text{ "
        r"angles''}",
        at=[{"V_i": n, "values": (ends, ends * ends)} for n, ends in counts],
        note="Remark: 4^(Vi + 1) ordered pairs, each with itself included",
    )
    state(
        "D.4",
        place + " and Fig. (v6)",
        r"\text{``distances between branches as points on the }V_i\text{-dimensional "
        r"sphere'' \dots\ ``randomly distributed points on a 6-dimensional sphere''}",
        note="the unit sphere of R^(Vi+1)",
        rests="D.2",
    )
    state(
        "D.5",
        "Appendix D, Figs. (v6) and (distribution) against the text",
        r"\text{``The bin sizes are }\pi/32\text{'' \dots\ ``using bins of size }\pi/128\text{''}",
        r"\text{one of the two; the source does not say which}",
        "nothing depends on it; the replacement makes the text agree with the captions. "
        "Remark: V=6 in the "
        "text and V=2 -- 8 in a caption are values of Vi",
        severity=Severity.TYPO,
        contradiction="pi/32 in both captions, pi/128 twice in the text, of the same figures",
    )
    a, b = sympy.Matrix(sympy.symbols("a1:3")), sympy.Matrix(sympy.symbols("b1:3"))
    other = script.alter("angle with the other end not turned", -a, a)
    script.identity(
        "cos of the angle with the other end of a branch is minus the cosine: theta and pi - theta",
        other.dot(b) / sympy.sqrt(other.dot(other) * b.dot(b))
        + a.dot(b) / sympy.sqrt(a.dot(a) * b.dot(b)),
        of="D.6",
    )
    state(
        "D.6",
        place,
        r"\text{``for each angle }\theta\text{, we also include the angle "
        r"}\pi-\theta\text{'' \dots\ ``each branch has an angle }0\text{ and }\pi\text{ "
        r"with itself''}",
        note="Remark: all four pairs of ends; a share 2^(-Vi) of the ordered pairs is of a branch "
        "with itself",
    )
    angle, n = sympy.symbols("theta n", positive=True)
    density = sympy.sin(angle) ** (n - 1)
    power = script.alter("sphere of another dimension", n, n + 1)
    script.identity(
        "two random points on S^n: the angle has density sin^(n-1), and (sin^n cos)' = sin^(n-1) "
        "(n cos^2 - sin^2), so that E cos^2 = 1/(n + 1): it tends to pi/2",
        sympy.simplify(
            sympy.diff(sympy.sin(angle) ** power * sympy.cos(angle), angle) / density
            - (n * sympy.cos(angle) ** 2 - sympy.sin(angle) ** 2)
        ),
        of="D.8",
    )
    state(
        "D.8",
        place,
        r"\text{``for random points on a sphere, the angle distribution approaches a Gaussian with "
        r"variance going to zero''}",
        note="the variance is proved here, the Gaussian is cited (Ref. caifanjiang)",
        cited="Ref. caifanjiang (the Gaussian)",
    )
    state(
        "D.7",
        place,
        r"\text{``the number of data points going into the histograms is comparable''}",
        note="Remark: 2/3 of the pairs for Vi = 7",
    )


if __name__ == "__main__":
    sys.exit(run(prove()))
