"""The report of a study: one HTML file with its tables and pictures, which needs no other file."""

from __future__ import annotations

from html import escape
from importlib.metadata import version

from exactfold.report.study_figures import drawn
from exactfold.studies.runner import StudyRun
from exactfold.studies.study import StudyFigure, StudyTable

_STYLE = """
body { max-width: 60rem; margin: 2rem auto; padding: 0 1rem; line-height: 1.45;
  font-family: "STIX Two Text", Georgia, serif; color: #1b1b1b; background: #fff; }
h1 { font-size: 1.6rem; } h2 { font-size: 1.15rem; margin-top: 2.2rem; }
.table { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: .2rem .8rem; text-align: right; white-space: nowrap; }
th { border-bottom: 1px solid #777; font-weight: 600; } td.word, th.word { text-align: left; }
tbody tr:nth-child(even) { background: #f5f5f2; }
figure { margin: 1rem 0; } figure svg { max-width: 100%; height: auto; }
figcaption, .note { color: #555; font-size: .92rem; }
code { font-size: .9rem; }
"""


def study_page(run: StudyRun, command: str) -> str:
    """The page of a run; `command` is what made it. Raises `StudyPartsMissingError`."""
    study = run.study
    sizes = ", ".join(f"{number} of size {size}" for size, number in run.numbers.items() if number)
    undecided = f" {run.undecided} of them are undecided." if run.undecided else ""
    parts = [
        "<!doctype html>",
        '<html lang="en"><head><meta charset="utf-8">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f"<title>{escape(study.name)}: {escape(study.about)}</title>",
        f"<style>{_STYLE}</style></head><body>",
        f"<h1>{escape(study.about)}</h1>",
        f"<p>Study <code>{escape(study.name)}</code>, version {study.version}, seed {run.seed}: "
        f"{run.total} rows, {escape(sizes)}.{undecided} Made by exactfold "
        f"{escape(version('exactfold'))} with</p><p><code>{escape(command)}</code></p>",
        *(_table(table) for table in run.tables),
        *(_figure(figure) for figure in run.figures),
        "</body></html>",
    ]
    return "\n".join(parts) + "\n"


def _table(table: StudyTable) -> str:
    def line(cells: list[str], tag: str) -> str:
        marks = [' class="word"' if word else "" for word in table.words]
        joined = "".join(f"<{tag}{m}>{c}</{tag}>" for m, c in zip(marks, cells, strict=True))
        return f"<tr>{joined}</tr>"

    head = line([escape(name) for name in table.columns], "th")
    body = "\n".join(
        line(["" if cell is None else escape(str(cell)) for cell in row], "td")
        for row in table.rows
    )
    notes = "".join(f'<p class="note">{escape(note)}</p>' for note in table.notes)
    return (
        f'<h2>{escape(table.title)}</h2><div class="table"><table><thead>{head}</thead>\n'
        f"<tbody>{body}</tbody></table></div>{notes}"
    )


def _figure(figure: StudyFigure) -> str:
    svg = drawn(figure).decode("utf-8")
    svg = _named_apart(svg[svg.index("<svg") :], figure.name)
    return (
        f'<h2>{escape(figure.title)}</h2><figure role="img" aria-label="{escape(figure.title)}">'
        f"{svg}<figcaption>{escape(figure.caption)}</figcaption></figure>"
    )


def _named_apart(svg: str, name: str) -> str:
    """The picture with names of its own: a page holds several, and names are of the page."""
    for mark in ('id="', 'href="#', "url(#"):
        svg = svg.replace(mark, f"{mark}{name}-")
    return svg
