"""Writes the report of a study: one HTML file with tables and pictures, complete in itself."""

from __future__ import annotations

import re
from collections.abc import Iterable
from html import escape
from importlib.metadata import version

from exactfold._support.plurals import counted
from exactfold.studies.report.figures import drawn
from exactfold.studies.running.runner import StudyRun
from exactfold.studies.running.study import StudyFigure, StudyTable

_STYLE = """
body { max-width: 60rem; margin: 2rem auto; padding: 0 1rem; line-height: 1.45;
  font-family: "STIX Two Text", Georgia, serif; color: #1b1b1b; background: #fff; }
h1 { font-size: 1.6rem; } h2 { font-size: 1.15rem; margin-top: 2.2rem; }
.table { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: .2rem .8rem; text-align: right; white-space: nowrap; vertical-align: top; }
th { border-bottom: 1px solid #777; font-weight: 600; } td.word, th.word { text-align: left; }
td.long { white-space: normal; min-width: 8.5rem; } th { vertical-align: bottom; }
sub, sup { line-height: 0; }
tbody tr:nth-child(even) { background: #f5f5f2; }
figure { margin: 1rem 0; } figure svg { max-width: 100%; height: auto; }
figcaption, .note { color: #555; font-size: .92rem; }
code { font-size: .9rem; overflow-wrap: anywhere; }
.table:focus-visible { outline: 2px solid #365c8d; }
@media (max-width: 40rem) { th, td { padding: .2rem .45rem; } table { font-size: .9rem; }
  th { white-space: normal; } }
@media print { body { max-width: none; margin: 0; } .table { overflow: visible; }
  h2 { break-after: avoid; } figure, tr { break-inside: avoid; } }
"""


def study_page(run: StudyRun, command: str) -> str:
    """The page of a run, made by `command`; raises `PackageMissingError`."""
    study = run.study
    sizes = ", ".join(f"{number} of size {size}" for size, number in run.numbers.items() if number)
    rows = counted(run.total, "row") + (f" ({sizes})" if sizes else "")
    undecided = f" Undecided: {run.undecided}." if run.undecided else ""
    parts = [
        "<!doctype html>",
        '<html lang="en"><head><meta charset="utf-8">',
        '<meta name="color-scheme" content="light">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f"<title>{escape(study.name)}: {escape(study.about)}</title>",
        f"<style>{_STYLE}</style></head><body>",
        f"<h1>{escape(study.about)}</h1>",
        f"<p>Study <code>{escape(study.name)}</code>, version {study.version}, seed {run.seed}: "
        f"{escape(rows)}.{undecided} Made by exactfold "
        f"{escape(version('exactfold'))} with</p><p><code>{escape(command)}</code></p>",
        *(_table(table) for table in run.tables),
        *(_figure(figure) for figure in run.figures),
        "</body></html>",
    ]
    return "\n".join(parts) + "\n"


def _table(table: StudyTable) -> str:
    def line(cells: Iterable[str], tag: str) -> str:
        joined = ""
        for word, cell in zip(table.words, cells, strict=True):
            kinds = ["word"] * word + ["long"] * (word and len(cell) > _LONG)
            mark = f' class="{" ".join(kinds)}"' if kinds else ""
            joined += f"<{tag}{mark}>{_typeset(cell)}</{tag}>"
        return f"<tr>{joined}</tr>"

    head = line(
        (re.sub(r" (?=[>%])|(?<=>) ", "\N{NO-BREAK SPACE}", c) for c in table.columns), "th"
    )
    body = "\n".join(
        line(["" if cell is None else str(cell) for cell in row], "td") for row in table.rows
    )
    notes = "".join(f'<p class="note">{_terms(note, table.columns)}</p>' for note in table.notes)
    title = f"<h2>{_typeset(table.title)}</h2>"
    if not table.rows:
        return f"{title}<p>Nothing can be said of these rows.</p>{notes}"
    return (
        f'{title}<div class="table" tabindex="0" role="region" '
        f'aria-label="{escape(table.title)}"><table><thead>{head}</thead>\n'
        f"<tbody>{body}</tbody></table></div>{notes}"
    )


_LONG = 24
"""Texts of more characters than this are broken into lines."""

_TINY = re.compile(r"(\d(?:\.\d+)?)e([+-]\d+)")
_POWER = re.compile(r"\^(-?\w+|\([^()]*\))")
_MINUS = re.compile(r"(?<=[\s>(])-(?=[\s\d])|^-(?=\d)")
_INDEXED = re.compile(r"\bV([it])\b")


def _typeset(text: str) -> str:
    """Plain text of a table in HTML, with indices, powers and signs as in print.

    >>> print(_typeset("2^(Vi - 1) >= 1e-02"))
    2<sup><i>V<sub>i</sub></i> − 1</sup> ≥ 1 × 10<sup>−2</sup>
    """
    text = _TINY.sub(lambda m: f"{m[1]} × 10^{int(m[2])}", text)
    text = escape(text.replace(">=", "≥"), quote=False)
    text = _POWER.sub(lambda m: f"<sup>{m[1].strip('()')}</sup>", text)
    return _INDEXED.sub(r"<i>V<sub>\1</sub></i>", _MINUS.sub("\N{MINUS SIGN}", text))


def _terms(note: str, columns: Iterable[str]) -> str:
    """A note in HTML, in which the names of columns that it explains are in italics."""
    names = "|".join(re.escape(name) for name in columns if name)
    if names:
        words = rf"(?<!\w)((?:{names})(?:(?:, | and )(?:{names}))*)(?=:)"
        note = re.sub(words, "\x02\\1\x03", note)
    return _typeset(note).replace("\x02", "<em>").replace("\x03", "</em>")


def _figure(figure: StudyFigure) -> str:
    svg = drawn(figure).decode("utf-8")
    svg = _named_apart(svg[svg.index("<svg") :], figure.name)
    return (
        f"<h2>{_typeset(figure.title)}</h2><figure>"
        f'<div role="img" aria-label="{escape(figure.title)}">{svg}</div>'
        f"<figcaption>{_typeset(figure.caption)}</figcaption></figure>"
    )


def _named_apart(svg: str, name: str) -> str:
    """The picture with its own names, as a page contains several pictures."""
    for mark in ('id="', 'href="#', "url(#"):
        svg = svg.replace(mark, f"{mark}{name}-")
    return svg
