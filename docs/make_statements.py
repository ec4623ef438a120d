"""Write docs/statements.md and docs/errata.md from the proof objects."""

from __future__ import annotations

import re
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from proofs import MODULES
from proofs.__main__ import load
from proofs.framework import How, Proof, Ruling, Statement

SECTIONS = {
    "I": "Introduction",
    "II": "Section II A: the model",
    "IIA": "Section II A: the model",
    "IIB": "Section II B: wheel stresses, curvature, single vertices",
    "IIC": "Section II C: degrees of freedom and branches",
    "III": "Section III: numerical results",
    "IIIA": "Section III A: counting branches",
    "IIIB": "Section III B: vertex sign patterns",
    "IIIC": "Section III C: mountain-valley assignments",
    "IV": "Section IV: H1 triangulations and butterflies",
    "V": "Section V: discussion",
    "A": "Appendix A: the quadratic constraint",
    "B": "Appendix B: the self stress",
    "C": "Appendix C: vertex quadratic forms",
    "D": "Appendix D: high-dimensional geometry",
    "T": "Statements of exactfold",
}


def order(key: str) -> tuple[int, int, str]:
    """Sort key of a statement number such as "IIB.12"."""
    part, _, number = key.partition(".")
    part = part.replace(" ", "")
    rank = list(SECTIONS).index(part) if part in SECTIONS else len(SECTIONS)
    digits = re.match(r"\d+", number)
    return rank, int(digits[0]) if digits else 0, number


def mathematics(text: str) -> str:
    """LaTeX between dollar signs, on one line."""
    return f"$`{' '.join(text.split())}`$"


def entry(statement: Statement, proof: Proof) -> str:
    """One statement with its ruling, correction, note and proof."""
    lines = [
        f"**{statement.key}** ({statement.place}). *{statement.ruling.value.capitalize()}.*",
        "",
    ]
    lines.append(f"- printed: {mathematics(statement.printed)}")
    if statement.corrected:
        lines.append(f"- correct: {mathematics(statement.corrected)}")
    if statement.note:
        lines.append(f"- {' '.join(statement.note.split())}")
    where = f"`python -m proofs {proof.name}`"
    lines.append(f"- proof: {where}" + (f"; code: `{statement.code}`" if statement.code else ""))
    return "\n".join(lines) + "\n\n"


def pages() -> dict[str, str]:
    """The text of both pages by file name."""
    proofs = [load(name) for name in MODULES]
    stated = sorted(
        ((s, p) for p in proofs for s in p.statements), key=lambda pair: order(pair[0].key)
    )
    counts = {ruling: sum(s.ruling is ruling for s, _ in stated) for ruling in Ruling}
    names = {
        Ruling.AS_PRINTED: "hold as printed",
        Ruling.CORRECTED: "hold when corrected",
        Ruling.FALSE: "are false",
    }
    summary = ", ".join(f"{number} {names[ruling]}" for ruling, number in counts.items())
    steps = [step for proof in proofs for step in proof.steps]
    tested = sum(step.how is How.CASES for step in steps)
    head = (
        "# The paper, statement by statement\n\n"
        'Chen & Santangelo, "Branches of triangulated origami near the unfolded state". '
        f"{len(stated)} statements: {summary}. Each is settled by a script that a machine runs "
        f"(`python -m proofs`, {len(steps)} steps; {tested} of them test exact cases rather than "
        "prove, and say so). Written by `python docs/make_statements.py`.\n"
    )
    body, errata, section = head, ERRATA, ""
    for statement, proof in stated:
        title = SECTIONS.get(statement.key.partition(".")[0].replace(" ", ""), "Further statements")
        if title != section:
            section = title
            body += f"\n## {section}\n\n"
        body += entry(statement, proof)
        if statement.ruling is not Ruling.AS_PRINTED and not statement.key.startswith("T"):
            errata += entry(statement, proof)
    return {"statements.md": body.rstrip() + "\n", "errata.md": errata.rstrip() + "\n"}


ERRATA = (
    "# Errata of the paper\n\nWhat an author could act upon: every statement of Chen & Santangelo, "
    '"Branches of triangulated origami near the unfolded state", that does not hold as printed, '
    "with the correction and the script that checks it. None of them touches the paper's main "
    "observation, which is a theorem ([all branches are real](theorem.md)). Written by "
    "`python docs/make_statements.py`.\n\n"
)


if __name__ == "__main__":
    for name, text in pages().items():
        (HERE / name).write_text(text, encoding="utf-8")
