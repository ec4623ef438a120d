"""Write docs/statements.md and docs/errata.md from the proof objects."""

from __future__ import annotations

import re
import sys
import textwrap
from functools import cache
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from proofs import MODULES
from proofs.__main__ import load
from proofs.framework import Proof
from proofs.mutation import garbled
from proofs.reading import pieces
from proofs.replacements import REPLACEMENTS
from proofs.statements import How, Ruling, Severity, Statement

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


PLAIN = {
    "``": "\u201c",
    "''": "\u201d",
    r"\dots\ ": "\u2026 ",
    r"\dots": "\u2026",
    r"\%": "%",
    "--": "\u2013",
}
EDGES = re.compile(r"((?:\\[,;\s]|\\q?quad|[,;.]|\s)*)(.*?)((?:\\[,;\s]|\\q?quad|[,;.]|\s)*)")


def order(key: str) -> tuple[int, int, str]:
    """Sort key of a statement number such as "IIB.12"."""
    part, _, number = key.partition(".")
    part = part.replace(" ", "")
    rank = list(SECTIONS).index(part) if part in SECTIONS else len(SECTIONS)
    digits = re.match(r"\d+", number)
    return rank, int(digits[0]) if digits else 0, number


def prose(text: str) -> str:
    """The words inside `\\text{...}` as Markdown."""
    text = re.sub(r"\\ref\{(?:eq:)?(\w+)\}", r"\1", text)
    for latex, plain in PLAIN.items():
        text = text.replace(latex, plain)
    if "\\" in text or "$" in text:
        raise ValueError(f"LaTeX that a reader would see as such: {text}")
    return text


def mathematics(latex: str) -> str:
    """A statement on one line: its prose as Markdown, its formulas between dollar signs."""
    words, latex = "", " ".join(latex.split())
    parts = pieces(latex)
    formulas = [part for is_prose, part in parts if not is_prose]
    if any(part.count(a) != part.count(b) for part in formulas for a, b in ("()", "[]", "{}")):
        return f"$`{latex}`$"  # a formula with words in it
    for is_prose, content in parts:
        if is_prose:
            words += prose(content)
            continue
        # spaces and the commas that separate a formula from prose stay outside of it
        before, formula, after = re.fullmatch(EDGES, content).groups()  # type: ignore[union-attr]
        spaced = [re.sub(r"\\(?:,|;|quad|qquad|\s)|\s", " ", edge) for edge in (before, after)]
        words += spaced[0] + (f"$`{formula}`$" if formula else "") + spaced[1]
    return " ".join(words.split())


def code_links(names: str) -> str:
    """Links to the files that define the names in exactfold. Raises `KeyError` if one is not."""
    where = definitions()
    return ", ".join(
        f"[`{n}`](../{where.get(n) or where[n.partition('.')[0]]})" for n in names.split(", ")
    )


@cache
def definitions() -> dict[str, str]:
    """Path in the repository by name of a class, a function or a module of exactfold.

    A function also has an entry with its module before it, as modules may share a name. Dual
    spaces, which only proofs need, are in `proofs`.
    """
    found: dict[str, str] = {}
    root = HERE.parent
    for path in [*sorted(root.glob("proofs/dual_*.py")), *sorted(root.glob("exactfold/**/*.py"))]:
        where = path.relative_to(HERE.parent).as_posix()
        names = re.findall(r"^(?:class|def) (\w+)", path.read_text(encoding="utf-8"), re.MULTILINE)
        found |= dict.fromkeys(names, where)
        found |= dict.fromkeys((f"{path.stem}.{name}" for name in names), where)
        found.setdefault(path.stem, where)
    return found


def entry(statement: Statement, proof: Proof) -> str:
    """One statement in a few lines: its place, what it says, and what shows it.

    Of the note only the first sentence stands here; `python -m proofs KEY` prints all of it. What
    does not hold as printed is on the page of errata, with the words of the paper.
    """
    script = f"[{proof.name}](../proofs/{proof.name}.py)"
    code = f"; {code_links(statement.code)}" if statement.code else ""
    shown = f"*{basis(statement, proof)}*: {script}{code}"
    if statement.ruling is not Ruling.AS_PRINTED:
        ruling = "corrected" if statement.corrected else "false"
        says = f"**{ruling}**, see [errata](errata.md)."
    else:
        note = sentence(statement.note)
        says = mathematics(statement.source) + (f" \u2014 {note}" if note else ".")
    return f"{wrapped(f'- **{statement.key}**{place(statement)}: {says} {shown}')}\n"


def sentence(note: str) -> str:
    """The first sentence of a note; if it is long, only the condition that it begins with.

    >>> sentence("for regular ones. The others are counted in docs/theorem.md, 4")
    'for regular ones.'
    >>> sentence("for every triangulated disk: " + "and so on, " * 10)
    'for every triangulated disk.'
    """
    text = re.split(r"(?<=[\w)])\. (?=[A-Z])", " ".join(note.split()))[0]
    for mark, most in (("; ", 20), (": ", 24)):
        head = text.partition(mark)[0]
        if len(text.split()) > most and len(head.split()) > 2:
            text = head
    return f"{text}." if text else ""


def place(statement: Statement) -> str:
    """The place without its section, which stands in the heading."""
    if statement.is_own:
        return f" ({statement.place})"
    text = re.sub(
        r"^(Section [IVX]+( [A-D])?|Appendix [A-D]|Introduction),? ?", "", where(statement)
    )
    return f" ({text})" if text else ""


def basis(statement: Statement, proof: Proof) -> str:
    """What it rests on, without what is true of all that does not hold as printed."""
    text = re.sub(r"proved for all \(\d+ steps?\)", "proved", proof.basis(statement))
    return re.sub(r"(^|; )the printed form refuted by an example$", "", text) or "refuted"


def where(statement: Statement) -> str:
    """The place in the paper, with the number of the equation."""
    number = f", Eq. ({statement.equation})" if statement.equation else ""
    return f"{statement.place}{number}"


def printed(statement: Statement) -> list[str]:
    """What the paper prints, and the formula that is put together from it if there is one."""
    lines = [f"- printed: {mathematics(statement.source)}"]
    return [*lines, f"- that is: {mathematics(statement.printed)}"] if statement.quoted else lines


def erratum(statement: Statement, proof: Proof) -> str:
    """One erratum: place, severity, what is printed, what to print instead, why, and the proof."""
    severity = statement.severity.value if statement.severity else ""
    lines = [f"**{statement.key}** ({where(statement)}). *{severity.capitalize()}.*", ""]
    lines += printed(statement)
    if statement.corrected:
        lines.append(f"- correct: {mathematics(statement.corrected)}")
    else:
        lines.append("- false, and not to be mended by a condition")
    lines.append(f"- why: {' '.join(statement.note.split())}")
    script = f"[`python -m proofs {statement.key}`](../proofs/{proof.name}.py)"
    lines[-1] += f" ({script}: {basis(statement, proof)})"
    text = "\n".join(wrapped(line) for line in lines) + "\n"
    for old, new in REPLACEMENTS[statement.key]:
        instead = [f"% {row}" for row in rows(old, 94)]
        block = "\n".join([*instead, *rows(new, 96)])
        text += f"\n```latex\n{block}\n```\n"
    return f"{text}\n"


def rows(latex: str, width: int) -> list[str]:
    """LaTeX in lines of at most `width` characters, broken at spaces and where it was broken."""
    options = {"break_long_words": False, "break_on_hyphens": False}
    return [row for line in latex.splitlines() for row in textwrap.wrap(line, width, **options)]


def wrapped(line: str) -> str:
    """An item of a list in lines of at most 100 characters, where no formula or link is longer.

    >>> print(wrapped("- a word, " + "one more, " * 11))
    - a word, one more, one more, one more, one more, one more, one more, one more, one more, one
      more, one more, one more,
    """
    kept = re.sub(r"\$`.+?`\$|`[^`]+`", lambda code: code[0].replace(" ", "\0"), line)
    kept = re.sub(r" ([-+*=|<>]) ", "\0\\1\0", kept)
    rows: list[str] = []
    for row in textwrap.wrap(kept, 98, break_long_words=False, break_on_hyphens=False):
        if rows and re.match(r"([-+*>#|=]|\d+[.)])( |$)", row):  # would begin something else
            rows[-1] += f" {row}"
        else:
            rows.append(row)
    return "\n  ".join(rows).replace("\0", " ")


def pages() -> dict[str, str]:
    """The text of both pages by file name."""
    proofs = [load(name) for name in MODULES]
    stated = sorted(
        ((s, p) for p in proofs for s in p.statements), key=lambda pair: order(pair[0].key)
    )
    papers = [s for s, _ in stated if not s.is_own]
    counts = {ruling: sum(s.ruling is ruling for s in papers) for ruling in Ruling}
    names = {
        Ruling.AS_PRINTED: "hold as printed",
        Ruling.CORRECTED: "hold when corrected",
        Ruling.FALSE: "is false" if counts[Ruling.FALSE] == 1 else "are false",
    }
    summary = ", ".join(f"{number} {names[ruling]}" for ruling, number in counts.items())
    steps = [step for proof in proofs for step in proof.steps]
    tested = sum(step.how is How.CASES for step in steps)
    formulas = sum(len(proof.claims) for proof in proofs)
    mutants = sum(1 for proof in proofs for claim in proof.claims for _ in garbled(claim.right))
    mistakes = sum(len(proof.changes) for proof in proofs)
    head = (
        "# The paper, statement by statement\n\n"
        'Chen & Santangelo, "Branches of triangulated origami near the unfolded state". '
        f"{len(papers)} statements of the paper: {summary}. {len(stated) - len(papers)} statements "
        "of exactfold come last. In quotation marks or as a formula stands what the paper "
        "prints, word by word, then a condition or a remark, then *what shows it*, the script, and "
        "the code that uses it. *Proved* is a step that holds for all, "
        "*tested on cases* is evidence and no proof. `python -m proofs KEY` runs the steps of a "
        "statement and prints its whole note; `python -m proofs` runs "
        f"all {len(steps)} steps, {tested} of which test exact cases. {formulas} statements are "
        f"formulas that a step evaluates; of {mutants} small mistakes in them all are "
        "noticed but for a few that leave them true, each with its reason in the tests. The other "
        f"statements are in words; their steps refuse at least one of {mistakes} deliberate "
        f"mistakes each. Written by `python docs/make_statements.py`.\n\n{STANDARD}"
    )
    head = "\n".join(textwrap.fill(part, 100) for part in head.split("\n")) + "\n"
    wrong = [(s, p) for s, p in stated if s.ruling is not Ruling.AS_PRINTED]
    body, errata, section = head, ERRATA + severities([s for s, _ in wrong]), ""
    for statement, proof in stated:
        title = SECTIONS.get(statement.key.partition(".")[0].replace(" ", ""), "Further statements")
        if title != section:
            section = title
            body += f"\n## {section}\n\n"
        body += entry(statement, proof)
    errata += "".join(erratum(statement, proof) for statement, proof in wrong)
    return {"statements.md": body.rstrip() + "\n", "errata.md": errata.rstrip() + "\n"}


def severities(statements: list[Statement]) -> str:
    """A table of the errata by how much is wrong."""
    lines = ["| severity | what it means | statements |", "|---|---|---|"]
    for severity, meaning in MEANINGS.items():
        keys = [s.key for s in statements if s.severity is severity]
        lines.append(f"| {severity.value} ({len(keys)}) | {meaning} | {', '.join(keys)} |")
    return "\n".join(lines) + "\n\n"


MEANINGS = {
    Severity.TYPO: "a slip, as the rest of the paper shows",
    Severity.CONSTANT: "a number, a range or a label that changes what is computed",
    Severity.CONDITION: "true under a condition that is not stated",
    Severity.CLAIM: "not true in the sense in which it is used",
    Severity.REMARK: "said with reserve (\u201cseem\u201d, \u201croughly\u201d), and not borne out",
}


STANDARD = (
    "**The standard.** A statement is judged as it is worded, for the patterns that its section "
    "admits. If it is about generic patterns, special ones that break it are named in a note and "
    "do not count against it; otherwise one exact counterexample does. Inferences "
    "(\u201cwe have thus shown\u201d) and conjectures are judged as well; a remark with reserve is "
    "named as such. Reports of computations are taken as reported, and compared with samples of "
    "our own."
)


ERRATA = """# Errata of the paper

Every statement of Chen & Santangelo, "Branches of triangulated origami near the unfolded state",
that does not hold as printed, with the correction and the script that checks it. For each an exact
example refutes what is printed, or another place of the paper says otherwise. None touches the
paper's main observation, which is a theorem: all branches are real ([Theorem 2](theorem.md)), and
on almost every sheet $`2^{V_i - V_t}`$ of them differ ([Theorem 11](generic.md)). The
[standard](statements.md) is that of all statements. Written by `python docs/make_statements.py`.

The blocks of LaTeX can be pasted: below a passage of the paper's source, which is a comment, stands
what to put in its place. `python docs/read_paper.py PAPER.tex CORRECTED.tex` does it for all of
them.

"""


if __name__ == "__main__":
    for name, text in pages().items():
        (HERE / name).write_text(text, encoding="utf-8")
