"""The results of `peers.py` as tables and as docs/benchmarks.md."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from statistics import median
from typing import Any

COMPLETE, INCOMPLETE, LIMIT, NOTHING = "complete", "incomplete", "limit reached", "not applicable"
BASE = "exactfold, certificate"
EXACT, RIVAL = "exactfold, exact from roots", "msolve"
_CHECKS = ("check, standard library", "check, compact, floats")

Results = dict[str, Any]
Lines = list[dict[str, Any]]


def of(results: Results, program: str, size: int) -> Lines:
    """All measurements of a program at a size."""
    return [x for x in results["lines"] if (x["program"], x["size"]) == (program, size)]


def programs(results: Results, single: bool) -> list[str]:
    """In the order measured."""
    names = dict.fromkeys(x["program"] for x in results["lines"])
    return [name for name in names if name.startswith("one branch") == single]


def sizes(results: Results, names: Iterable[str]) -> list[int]:
    """Sizes at which one of these programs was measured."""
    wanted = set(names)
    return sorted({x["size"] for x in results["lines"] if x["program"] in wanted})


def seconds(lines: Lines) -> float:
    """Median of the processor time."""
    return float(median(x["cpu"] for x in lines))


def number(value: float) -> str:
    """Two digits, or all before the point."""
    return f"{value:.0f}" if value >= 9.95 else f"{value:.1f}" if value >= 0.95 else f"{value:.2f}"


def cell(results: Results, program: str, size: int) -> str:
    """Seconds and the ratio to the first line of the table."""
    lines = of(results, program, size)
    if not lines or all(x["outcome"] == NOTHING for x in lines):
        return ""
    base = [x for x in of(results, BASE, size) if x["outcome"] == COMPLETE]
    value = seconds(lines)  # with a limit in place of a time it is a lower bound
    more = "> " if any(x["outcome"] == LIMIT for x in lines) else ""
    text = f"{more}{number(value)}"
    if base and program != BASE:
        text += f" ({more}{number(value / seconds(base))}x)"
    short = [x for x in lines if x["outcome"] == INCOMPLETE]
    if short:
        least = min(x["found"] for x in short)
        text += f" **{least} of {1 << size}**" if least < 1 << size else " **not the same**"
    return text


def growth(results: Results, program: str) -> str:
    """Factor a vertex between the two largest sizes at which all answers are complete."""
    whole = []
    for size in sizes(results, [program]):
        lines = of(results, program, size)
        if all(x["outcome"] == COMPLETE for x in lines):
            whole.append((size, seconds(lines)))
    return factor(whole)


def factor(values: Sequence[tuple[int, float]]) -> str:
    """Geometric mean of the growth a vertex between the last two of (size, seconds)."""
    if len(values) < 2:
        return ""
    (small, before), (large, after) = values[-2:]
    return f"{(after / before) ** (1 / (large - small)):.1f}"


def rivals(results: Results) -> str:
    """What msolve takes in units of the exact parametrisation, where both are complete."""
    found = []
    for size in sizes(results, [RIVAL]):
        mine, theirs = of(results, EXACT, size), of(results, RIVAL, size)
        if mine and all(x["outcome"] == COMPLETE for x in mine + theirs):
            found.append(f"{number(seconds(theirs) / seconds(mine))} at {size}")
    return f"Ratio of {RIVAL} to {EXACT}: {', '.join(found)} vertices." if found else ""


def main_table(results: Results) -> list[list[str]]:
    """All programs by size: seconds and ratios, growth, memory."""
    names = [name for name in programs(results, single=False) if name not in _CHECKS]
    columns = sizes(results, names)
    rows = [["program", *map(str, columns), "growth", "MB"]]
    for name in names:
        lines = [x for x in results["lines"] if x["program"] == name]
        memory = max(x["memory"] for x in lines)
        cells = [cell(results, name, size) for size in columns]
        if any(cells):
            rows.append([name, *cells, growth(results, name), f"{memory:.0f}"])
    return rows


def stage_table(results: Results) -> list[list[str]]:
    """The cost of exactfold by stage, without starting Python."""
    parts = (
        ("certificate: solve", BASE, "solve"),
        ("certificate: certify and classify", BASE, "certify"),
        ("certificate: check in integers, whole program", "check, standard library", None),
        ("streaming: solve", "exactfold, streaming", "solve"),
        ("streaming: certify and classify", "exactfold, streaming", "certify"),
        ("streaming: check", "check, compact, floats", "check"),
    )
    columns = sizes(results, [BASE])
    rows = [["stage", *map(str, columns), "growth"]]
    for title, program, stage in parts:
        values = {}
        for size in columns:
            lines = [x for x in of(results, program, size) if x["outcome"] == COMPLETE]
            if lines:
                values[size] = median(x["stages"][stage] if stage else x["cpu"] for x in lines)
        cells = [f"{values[size]:.3f}" if size in values else "" for size in columns]
        rows.append([title, *cells, factor(list(values.items()))])
    return rows


def branch_table(results: Results) -> list[list[str]]:
    """One branch on demand by size."""
    rows = [["program", "vertices", "seconds", "of which finding", "ratio", "MB", "answer"]]
    for size in sizes(results, programs(results, single=True)):
        base = of(results, "one branch, exactfold", size)
        for name in programs(results, single=True):
            lines = of(results, name, size)
            if not lines:
                continue
            late = any(x["outcome"] == LIMIT for x in lines)
            value = "> " * late + number(seconds(lines))
            inside = "" if late else number(median(x["stages"]["find"] for x in lines))
            right = sum(x["outcome"] == COMPLETE for x in lines)
            word = "proved" if name == "one branch, exactfold" else "agrees with it"
            rows.append(
                [
                    name.removeprefix("one branch, "),
                    f"{size}",
                    value,
                    inside,
                    f"{'> ' * late}{number(seconds(lines) / seconds(base))}x",
                    f"{max(x['memory'] for x in lines):.0f}",
                    f"{word}: {right} of {len(lines)}",
                ]
            )
    return rows


def pair_table(lines: Lines) -> list[list[str]]:
    """A row for each command: both medians, and the ratio of the new one to the old one."""
    commits = list(dict.fromkeys(line["commit"] for line in lines))
    rows = [["command", *commits, "ratio", "MB"]]
    for old, new in zip(lines[::2], lines[1::2], strict=True):
        times = [median(line["cpu"]) for line in (old, new)]
        other = "" if old["code"] == new["code"] else f" (exit codes {old['code']}, {new['code']})"
        rows.append(
            [
                old["command"] + other,
                *(
                    ("> " if None in x["code"] else "") + number(median(x["cpu"]))
                    for x in (old, new)
                ),
                f"{times[1] / times[0]:.2f}",
                f"{new['memory']:.0f}",
            ]
        )
    return rows


def as_text(rows: Sequence[Sequence[str]]) -> str:
    """Columns padded."""
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    return "\n".join(
        "  ".join(
            c.ljust(w) if k == 0 else c.rjust(w)
            for k, (c, w) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in rows
    )


def as_markdown(rows: Sequence[Sequence[str]]) -> str:
    """A table of a page."""
    head, *body = ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join([head, "|---" + "|---:" * (len(rows[0]) - 1) + "|", *body])


def report(results: Results) -> str:
    """The tables for a terminal."""
    limit = number(results["limit"])
    parts = [
        "Processor seconds, medians of "
        f"{len(results['seeds'])} random squares, and ratios to the first line; limit {limit} s. "
        f"Starting Python with all its libraries is {number(results['start'])} s of each.\n",
        *(f"{name} is not installed: {how}\n" for name, how in results["missing"].items()),
        as_text(main_table(results)).replace("**", "!"),
        rivals(results),
        "",
        as_text(stage_table(results)),
    ]
    if programs(results, single=True):
        parts += ["", as_text(branch_table(results))]
    if results.get("pairs"):
        parts += ["", as_text(pair_table(results["pairs"]))]
    for name, found in results["profiles"].items():
        parts += ["", f"{name}, {found['size']} vertices, share of the time:"]
        parts += [f"{share:6.0%}  {place}" for share, place in found["shares"]]
    return "\n".join(parts)


_PAGE = """# exactfold, other programs, and exactfold by size

One run of

```sh
{command} --markdown
```

on {machine}.
Without `--markdown` it prints tables alone, among them the cost by stage.

Patterns are random Delaunay squares (`random_square(Vi, seed)`, seeds {seeds}); the system is
that of the chart *boundary saddle = 1*, `Vi` quadrics in `Vi` unknowns with integer coefficients,
and the same for everybody. Every program is a process of its own with one thread. The machine was
shared with other work, so what counts is **processor time**, not the clock. Another machine or run
gives other seconds: compare only the numbers of this page with each other. Starting Python and
loading every library used here takes {start} s. What a program loads is included; it is most of the
time of exactfold at small sizes.

## All solutions

Processor seconds, medians of {count} patterns, by number of interior vertices; in brackets the
ratio to the first line. *Growth* is the factor a vertex between the two largest sizes with
complete answers, *MB* the largest memory of any run.

{main}

{rivals}

- An answer is *complete* if it has `2^Vi` different points at each of which every quadric,
  evaluated in integers, is at most 1e-9 times the sum of the sizes of its terms, and if each of
  the boxes proved by exactfold has a point of its own. **Bold**: the least number of solutions
  found where some are missing. `>`: stopped after {limit} s by the clock; empty: not asked (after a
  limit was reached, beyond the sizes of this run, or beyond 7 vertices for lifting and 10 for
  the parametrisation from roots).{missing}
- *exactfold, certificate* proves every branch in a box, with its signs and folds. *Streaming* is
  `stream_branches` on one core: the same with a compact certificate. *Exact* is the rational
  parametrisation of all branches, proved by substitution, in two independent ways.
- msolve's answers are boxes of exact numbers, computed modulo several primes until the result no
  longer changes: exact, though not proved. Its rival is *exact from roots*; the other lines of
  exactfold isolate and prove, but give no polynomials. PHCpack (`phc -0 -b -t1`) and Macaulay2
  (`solveSystem` with the tolerances under which it loses fewest solutions) give floating-point
  numbers and no proof.

{branch}{pairs}{profiles}"""

_BRANCH = """
## One branch on demand

`find_branch` with random signs on random squares of any size (`--redraw`, coordinates over 2^20):
processor seconds, of the whole process and for the branch alone. *Plain splu*
(`tests/benchmarks/plain_splu.py`) follows the popping path of the same signs by Runge and Kutta's
method, with SciPy's general sparse factorisation, and proves nothing. Where it does not agree, its
path stalled just before its end.

{table}
"""

_PAIRS = """
## Against an earlier commit

Processor seconds of whole commands, start included, in turns with those of an earlier commit;
medians of the rounds. `python tests/benchmarks/pairs.py COMMIT --markdown` prints this table alone;
`--keep FILE.jsonl` remembers the times by commit, `--from FILE.jsonl` prints them again, and
`--long` takes commands that people wait for. `>`: stopped.

{table}
"""

_PROFILES = """
## What bounds it

Shares of the time spent in single functions (Python's profiler, seed 1, which makes small
functions look slower than they are).

{table}

- *Certificate*: Newton's method from each sign vector, then Krawczyk's test and the signs of every
  fold in integers, one branch after the other. *Streaming* does the latter in arrays, too:
  what is left is Newton's method, and setting up the exact system in fractions, which does not grow
  with the number of branches.
- *Exact from roots* is bound by the size of its answer: `2^Vi` coefficients for each unknown, each
  of them about twice as long for each further vertex. Products of long polynomials, roots refined
  to that length, and the proof by substitution share the time.
- *One branch*: the sparse factorisations are the largest single part; the others are reading and
  validating the file and the proof in integers, all linear in the number of folds.
"""

_TITLES = {
    "count": "certificate",
    "stream": "streaming",
    "parametrise": "exact from roots",
    "branch": "one branch",
}


def markdown(results: Results) -> str:
    """docs/benchmarks.md."""
    machine = dict(results["machine"])
    first = f"{machine.pop('processor')}, {machine.pop('cores')} cores, {machine.pop('memory')}"
    versions = ", ".join(f"{name} {value.strip(',PHCv')}" for name, value in machine.items())
    missing = "".join(f" {name} was not installed." for name in results["missing"])
    branch = pairs = profiles = ""
    if results.get("pairs"):
        pairs = _PAIRS.format(table=as_markdown(pair_table(results["pairs"])))
    if programs(results, single=True):
        branch = _BRANCH.format(table=as_markdown(branch_table(results)))
    if results["profiles"]:
        rows = [["program", "vertices", "where"]]
        for name, found in results["profiles"].items():
            shares = ", ".join(f"`{p}` {s:.0%}" for s, p in found["shares"])
            rows.append([_TITLES[name], str(found["size"]), shares])
        profiles = _PROFILES.format(table=as_markdown(rows).replace("---:|---:|", "---:|---|"))
    return _PAGE.format(
        command=results["command"],
        machine=f"{first}; {versions}",
        seeds=", ".join(map(str, results["seeds"])),
        count=len(results["seeds"]),
        start=number(results["start"]),
        main=as_markdown(main_table(results)),
        rivals=rivals(results) or "Nothing to compare with the exact parametrisation.",
        limit=number(results["limit"]),
        missing=missing,
        branch=branch,
        pairs=pairs,
        profiles=profiles,
    ).rstrip()
