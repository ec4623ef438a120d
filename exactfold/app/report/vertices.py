"""What `exactfold vertices` prints: the answer, and the vertices to look at."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rich.console import Group
from rich.table import Table
from rich.text import Text

from exactfold._support.plurals import counted
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED
from exactfold.app.report.terminal import letters_text, more_text, status_text
from exactfold.design.assignments.why import fold_text

if TYPE_CHECKING:
    from collections.abc import Sequence

    from exactfold.design.panels.vertex.facts import VertexFacts
    from exactfold.design.panels.vertex.repair import Repair
    from exactfold.design.panels.vertex.vertices import Vertices

FIRST = 10
"""At most this many vertices have a line of their own, unless all are asked for."""
MOST_WORDS = 12
"""At most this many reasons are listed, unless all are asked for."""
MOST_FOLDS = 24
"""At most this many folds are named, unless all are asked for."""
MOST_NAMED = 12
"""At most this many vertices are named in a line."""


def vertices_report(found: Vertices, *, everything: bool = False) -> Group:
    """The answer, the table of the vertices to look at, and what to change there."""
    parts: list[Any] = [vertices_answer(found), *(Text(line) for line in found.notes)]
    rows = found.facts if everything else found.wrong
    shown = rows if everything else rows[:FIRST]
    if len(found.facts) > FIRST and not everything:
        parts += ["", _summary(found.facts)]
    if shown:
        parts += ["", _table(shown), *more_text(len(rows) - len(shown))]
        words = _grouped(found, rows)
        limit = len(words) if everything else MOST_WORDS
        if words:
            parts += ["", Text("Why, and what to change", style="bold"), *map(Text, words[:limit])]
            parts += more_text(len(words) - limit)
        if found.repair is not None and found.repair.folds:
            parts += ["", Text(_repair(found.repair, everything))]
    elif rows != found.facts:
        parts += ["", Text("--all lists every vertex")]
    return Group(*parts)


def _repair(repair: Repair, everything: bool) -> str:
    """The change of letters for the whole sheet, in words."""
    count = len(repair.folds)
    shown = repair.folds if everything else repair.folds[:MOST_FOLDS]
    named = ", ".join(map(fold_text, shown))
    more = f" and {count - len(shown)} more (--all)" if count > len(shown) else ""
    then = "every vertex starts to fold by itself"
    if repair.stuck:
        then = f"all but {_vertices(repair.stuck)} start to fold by themselves"
    letters = "letter" if count == 1 else "letters"
    return (
        f"Smallest change found for the whole sheet: exchange the {letters} of "
        f"{counted(count, 'fold')}: {named}{more}. Then {then}."
    )


def _grouped(found: Vertices, rows: Sequence[VertexFacts]) -> list[str]:
    """The advice for all vertices; vertices with the same advice share a line."""
    by_text: dict[str, list[int]] = {}
    for facts in rows:
        for text in advice(found, facts):
            by_text.setdefault(text, []).append(facts.vertex)
    return [
        f"- {_vertices(some)}{', each' if len(some) > 1 else ''}: {text}"
        for text, some in by_text.items()
    ]


def vertices_answer(found: Vertices) -> Text:
    """Whether all vertices start to fold with their letters, in one sentence."""
    sheet = f"{found.meant.name}: " if found.meant is not None and found.meant.inferred else ""
    took = f" ({found.seconds:.2f} s)"
    return Text.assemble(f"{sheet}{found.headline} - ", status_text(found.starts), took)


def vertices_line(found: Vertices) -> Text:
    """The answer in one line, for a sheet of which not all ways to fold are known."""
    text = f"each vertex by itself: {found.headline} - "
    return Text.assemble(text, status_text(found.starts), "; see `exactfold vertices`")


def advice(found: Vertices, facts: VertexFacts) -> list[str]:
    """Why a vertex is listed and what would mend it, one text for each cause.

    >>> from exactfold.design.panels.vertex.vertices import vertices
    >>> found = vertices("zigzags")
    >>> print(*advice(found, found.facts[1]), sep="; ")
    its mountains 10-14, 6-10 lie on one side of a line, and so do its valleys 9-10, 10-11: exchange
    the letter of 6-10
    """
    texts = []
    if facts.reason:
        change = f": {_flips(found, facts)}" if facts.starts is REFUTED else ""
        texts.append(facts.reason + change)
    if facts.forced:
        letters = ", ".join(f"{fold_text(fold)}={x}" for fold, x in facts.forced.items())
        texts.append(f"its letters leave its free folds no choice: {letters}")
    if not found.meant_flat or facts.kawasaki or facts.nearly_kawasaki:
        return texts
    if facts.off is None:
        texts.append("with an odd number of folds it does not fold flat")
    elif facts.turn is not None:
        angle, end = facts.turn.angle, sum(facts.turn.fold) - facts.vertex
        which = "counter-clockwise" if angle > 0 else "clockwise"
        also = f", which changes vertex {end}, too" if end in found.pattern.stars else ""
        texts.append(
            f"to fold flat, turn fold {fold_text(facts.turn.fold)} by {abs(angle):.3g} degrees "
            f"{which}{also}"
        )
    return texts


def _flips(found: Vertices, facts: VertexFacts) -> str:
    """The smallest change of letters after which the fewest other vertices fail."""
    flips = found.flips(facts)
    if not flips:
        return "no letters help"
    failing = found.failing(facts, flips[0])
    after = f" (then {_vertices(failing)} cannot fold)" if failing else ""
    letters = "letter" if len(flips[0]) == 1 else "letters"
    are, left = "is" if len(flips) == 2 else "are", len(flips) - 1
    others = f"; there {are} {counted(left, 'other choice')}" if left else ""
    return f"exchange the {letters} of {' and '.join(map(fold_text, flips[0]))}{after}{others}"


def _vertices(some: Sequence[int]) -> str:
    if len(some) == 1:
        return f"vertex {some[0]}"
    if len(some) == 2:
        return f"vertices {some[0]} and {some[1]}"
    more = f" and {len(some) - MOST_NAMED} more" if len(some) > MOST_NAMED else ""
    return f"vertices {', '.join(map(str, some[:MOST_NAMED]))}{more}"


def _table(facts: Sequence[VertexFacts]) -> Table:
    table = Table(box=None, pad_edge=False)
    for title in ("vertex", "degree"):
        table.add_column(title, justify="right", no_wrap=True)
    table.add_column("letters", overflow="fold")
    for title in ("starts to fold", "Kawasaki", "Maekawa"):
        table.add_column(title)
    for v in facts:
        table.add_row(
            str(v.vertex),
            str(len(v.folds)),
            letters_text(v.letters),
            _starts(v),
            _kawasaki(v),
            _maekawa(v),
        )
    return table


def _summary(facts: Sequence[VertexFacts]) -> Table:
    """A line for each kind of vertices: of one degree, with the same answers."""
    kinds: dict[tuple[int, str, str, str], list[VertexFacts]] = {}
    for v in facts:
        kawasaki = "near" if v.off is not None and not v.kawasaki else _kawasaki(v)
        kind = (len(v.folds), _starts(v), kawasaki, _maekawa(v))
        kinds.setdefault(kind, []).append(v)
    table = Table(box=None, pad_edge=False)
    table.add_column("vertices", justify="right", no_wrap=True)
    table.add_column("degree", justify="right", no_wrap=True)
    for title in ("starts to fold", "Kawasaki", "Maekawa"):
        table.add_column(title)
    for (degree, starts, kawasaki, maekawa), some in sorted(kinds.items()):
        if kawasaki == "near":
            kawasaki = _off_between([abs(v.off) for v in some if v.off is not None])
        table.add_row(str(len(some)), str(degree), starts, kawasaki, maekawa)
    return table


def _off_between(off: Sequence[float]) -> str:
    """By how many degrees Kawasaki's condition is missed, from the least to the most.

    >>> _off_between([44.1, 45.93]), _off_between([1e-7])
    ('off by 44.1 to 45.9 degrees', 'off by 1e-07 degrees')
    """
    least, most = f"{min(off):.3g}", f"{max(off):.3g}"
    return f"off by {least} degrees" if least == most else f"off by {least} to {most} degrees"


def _starts(facts: VertexFacts) -> str:
    if facts.starts is UNDECIDED:
        return "open"
    if not facts.able:
        return "never"
    return "yes" if facts.starts is PROVED else "no"


def _kawasaki(facts: VertexFacts) -> str:
    if facts.kawasaki:
        return "holds"
    if facts.off is None:
        return f"no: {counted(len(facts.letters.replace('F', '')), 'fold')}"
    if facts.meant_kawasaki:
        return f"off by {abs(facts.off):.0e} degrees, meant 0"
    return f"off by {abs(facts.off):.3g} degrees"


def _maekawa(facts: VertexFacts) -> str:
    if facts.maekawa is None:
        return "-"
    return "holds" if facts.maekawa else f"no: M - V = {facts.excess}"
