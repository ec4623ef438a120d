"""Write docs/statements.md and docs/errata.md from the proof objects."""

from __future__ import annotations

import re
import sys
import textwrap
from functools import cache
from itertools import groupby, takewhile
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from proofs import MODULES
from proofs.__main__ import load
from proofs.framework import Proof
from proofs.reading import pieces
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


EQUATIONS = {
    "length": "1",
    "expanded": "2",
    "isometry": "3",
    "expanded2": "4",
    "compat": "5",
    "wheelstress": "7",
    "stressmatrix": "8",
    "Dcount": "9",
    "B distinct": "10",
    "constraint": "A6",
    "outer": "B1",
    "spokes": "B2",
    "outer2": "B3",
    "outer3": "B4",
    "spokepar": "B5 to B7",
    "firstpiece": "B8",
    "simpletrig": "B13",
    "form": "C4",
    "determinant": "C5",
    "equalangleeigs": "C8",
    "ratio": "C9",
}
"""The numbers of the paper's equations, by their labels in its source."""


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
    """A statement that holds as printed, or one of exactfold, with its place and what shows it.

    Of the note only a condition stands here; `python -m proofs KEY` prints all of it. A theorem of
    exactfold is stated on its own page.
    """
    code = f" {code_links(statement.code)}" if statement.code else ""
    key = f"[{statement.key}](../proofs/{proof.name}.py)"
    page, _, title = statement.place.partition(", ")
    shown = basis(statement, proof)
    if page.startswith("docs/"):
        name = page.removeprefix("docs/")
        prefix = "" if title.startswith("Theorem") else f"{name.removesuffix('.md')}, "
        says = f"[{prefix}{title}]({name})."
        shown = "; ".join(part for part in shown.split("; ") if "in words: " not in part)
    else:
        note = sentence(statement.note)
        says = "" if is_numbered_formula(statement) else shortened(mathematics(statement.source))
        says = f"{says} \u2014 {note}" if says and note else says or note
        says += "" if says.endswith(".") or not says else "."
    text = f"- {key}{place(statement)}: {says} *{shown}.*{code}".replace(":  *", ": *")
    return f"{wrapped(numbered(text))}\n"


def shortened(text: str, first: int = 6, last: int = 4) -> str:
    """The beginning and the end of a long text; a formula is one word.

    >>> shortened("one two three four five six seven eight nine ten eleven")
    'one two three four five six seven eight nine ten eleven'
    >>> shortened("\u201ca b c d\u201d e f g h i \u201cj k l m n o\u201d")
    '\u201ca b c d\u201d e f \u2026 \u201cl m n o\u201d'
    """
    parts = re.findall(r"(?:\$`.+?`\$|\S)+", text)
    if len(parts) < first + last + 4:
        return text
    head, tail = " ".join(parts[:first]), " ".join(parts[-last:])
    before, after = is_quoted(head), is_quoted(" ".join(parts[:-last]))
    close, again = "\u201d" * (before and not after), "\u201c" * (after and not before)
    return f"{head}{close} \u2026 {again}{tail}"


def is_quoted(text: str) -> bool:
    """Whether a quotation is open at the end of a text."""
    return text.count("\u201c") > text.count("\u201d")


def is_numbered_formula(statement: Statement) -> bool:
    """Whether it is a formula without words that has a number in the paper."""
    return bool(statement.equation) and not any(
        is_prose and any(c.isalpha() for c in part)
        for is_prose, part in pieces(" ".join(statement.source.split()))
    )


def sentence(note: str) -> str:
    """The first sentence of a note; if it is long, only the condition that it begins with.

    >>> sentence("Remark: the form of a vertex with N = 3 is definite")
    ''
    >>> sentence("for regular ones. The others are counted in docs/theorem.md, 4")
    'for regular ones.'
    >>> sentence("for every triangulated disk: " + "and so on, " * 10)
    'for every triangulated disk.'
    """
    if note.startswith("Remark: "):
        return ""
    text = re.split(r"(?<=[\w)])\. (?=[A-Z])", " ".join(note.split()))[0]
    for mark, most in (("; ", 8), (": ", 10), (" \u2014 ", 10)):
        head = text.partition(mark)[0]
        if len(text.split()) > most and len(head.split()) > 2:
            text = head
    return f"{text}." if text else ""


def place(statement: Statement) -> str:
    """The place without its section, which stands in the heading."""
    if statement.is_own:
        return ""
    text = re.sub(
        r"^(Section [IVX]+( [A-D])?|Appendix [A-D]|Introduction),? ?", "", where(statement)
    )
    return f" ({text})" if text else ""


def basis(statement: Statement, proof: Proof) -> str:
    """What it rests on, without what is true of all that does not hold as printed."""
    text = re.sub(r"proved for all \(\d+ steps?\)", "proved", proof.basis(statement))
    text = re.sub(r"tested on \d+ cases?", "cases", text).replace("shown by an example", "example")
    return re.sub(r"(^|; )the printed form refuted by an example$", "", text) or "refuted"


def where(statement: Statement) -> str:
    """The place in the paper, with the number of the equation; of a quotation only its section."""
    place = numbered(statement.place)
    quotes = mathematics(statement.source).startswith("\u201c")
    if quotes and not re.search(r"Eq\.|Fig|Table|Theorem", place):
        place = place.partition(",")[0]
    number = f"Eq. ({statement.equation})"
    return f"{place}, {number}" if statement.equation and number not in place else place


def numbered(text: str) -> str:
    """Text that names equations of the paper by their numbers, where a statement has their labels.

    >>> numbered("Eqs. (outer) and (spokes), after Eq. (Dcount)")
    'Eqs. (B1) and (B2), after Eq. (9)'
    """
    pattern = rf"\(({'|'.join(EQUATIONS)})\)"
    return re.sub(pattern, lambda label: f"({EQUATIONS[label[1]]})", text)


def erratum(statement: Statement, proof: Proof) -> str:
    """One erratum: place, severity, the proof, what is printed, what to print instead, and why."""
    severity = statement.severity.value if statement.severity else ""
    script = f"[{proof.name}](../proofs/{proof.name}.py)"
    lines = [
        f"**{statement.key}** ({where(statement)}). *{severity.capitalize()}.* "
        f"{script}: {basis(statement, proof)}.",
        "",
        f"- printed: {shortened(mathematics(statement.source), 12, 8)}",
        f"- correct: {changed(mathematics(statement.source), mathematics(statement.corrected))}"
        if statement.corrected
        else "- false, and not to be mended by a condition",
        f"- why: {' '.join(statement.note.partition(' Remark: ')[0].split())}",
    ]
    return "\n".join(wrapped(numbered(line)) for line in lines) + "\n\n"


def changed(printed: str, corrected: str) -> str:
    """The correction without the words with which the printed passage begins as well.

    >>> changed("\u201cthe number of the folds is $`3`$\u201d", "the number of the folds is $`4`$")
    '\u2026 is $`4`$'
    """
    old, new = printed.lstrip("\u201c").split(), corrected.split()
    same = len(list(takewhile(lambda k: old[k : k + 1] == new[k : k + 1], range(len(new)))))
    return f"\u2026 {' '.join(new[same - 1 :])}" if same > 3 else corrected


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
    steps = [step for proof in proofs for step in proof.steps]
    head = STATEMENTS.format(
        papers=len(papers),
        printed=counts[Ruling.AS_PRINTED],
        corrected=counts[Ruling.CORRECTED],
        false=counts[Ruling.FALSE],
        own=len(stated) - len(papers),
        steps=len(steps),
        tested=sum(step.how is How.CASES for step in steps),
    )
    wrong = [(s, p) for s, p in stated if s.ruling is not Ruling.AS_PRINTED]
    body, errata = head, ERRATA + severities([s for s, _ in wrong])
    for title, group in groupby(stated, lambda pair: section(pair[0].key)):
        pairs = list(group)
        held = [entry(s, p) for s, p in pairs if s.ruling is Ruling.AS_PRINTED]
        body += f"\n## {title}\n\n{''.join(held)}"
    errata += "".join(erratum(statement, proof) for statement, proof in wrong)
    return {"statements.md": body.rstrip() + "\n", "errata.md": errata.rstrip() + "\n"}


def section(key: str) -> str:
    """The heading below which a statement stands."""
    return SECTIONS.get(key.partition(".")[0].replace(" ", ""), "Further statements")


def severities(statements: list[Statement]) -> str:
    """A table of the errata by how much is wrong."""
    lines = ["| severity | what it means |", "|---|---|"]
    for severity, meaning in MEANINGS.items():
        number = sum(s.severity is severity for s in statements)
        lines.append(f"| {severity.value} ({number}) | {meaning} |")
    return "\n".join(lines) + "\n\n"


MEANINGS = {
    Severity.TYPO: "a slip, as the rest of the paper shows",
    Severity.CONSTANT: "a number, a range or a label that changes what is computed",
    Severity.CONDITION: "true under a condition that is not stated",
    Severity.CLAIM: "not true in the sense in which it is used",
    Severity.REMARK: "said with reserve (\u201cseem\u201d, \u201croughly\u201d), and not borne out",
}


STATEMENTS = """# The paper, statement by statement

Chen & Santangelo, "Branches of triangulated origami near the unfolded state", makes {papers}
statements. {printed} hold as printed and are listed here, {corrected} hold when corrected, and
{false} is false: keys that are missing are [errata](errata.md). Theorems of exactfold come last.
Each entry links the script that checks the statement, and names the place. Then it gives what the
paper prints (no formula that has a number; of long passages the beginning and the end), a
condition, *what shows it*, and the code that uses it.

*Proved* means: a step holds in general. *Cases* are exact tests: evidence, and no proof. *In words*
is a proof that no machine runs. `python -m proofs KEY` prints the whole statement, its note and its
steps; `python -m proofs` runs all {steps} steps, {tested} of which test cases.
[Mutation](mutation.md) says which deliberate mistakes the steps refuse. Written by
`python docs/make_statements.py`.

**The standard.** A statement is judged as it is worded, for the patterns that its section admits.
Special patterns do not count against a statement about generic ones; otherwise one exact
counterexample does. Inferences (\u201cwe have thus shown\u201d) and conjectures are judged as well.
Reports of computations are taken as reported, and compared with samples of our own.
"""


ERRATA = """# Errata of the paper

Every statement of Chen & Santangelo, "Branches of triangulated origami near the unfolded state",
that does not hold as printed ([the standard](statements.md)). For each an exact example refutes
what is printed, or another place of the paper says otherwise. None touches the paper's main
observation, which is a theorem: all branches are real ([Theorem 2](theorem.md)), and on almost
every sheet $`2^{V_i - V_t}`$ of them differ ([Theorem 11](generic.md)).

`python -m proofs C.7` runs the steps of C.7 and prints the LaTeX that replaces the passage;
`python docs/read_paper.py PAPER.tex CORRECTED.tex` makes all replacements. Written by
`python docs/make_statements.py`.

"""


if __name__ == "__main__":
    for name, text in pages().items():
        (HERE / name).write_text(text, encoding="utf-8")
