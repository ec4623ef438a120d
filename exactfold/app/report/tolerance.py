"""What `exactfold tolerance` and `exactfold design` print."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from rich.console import Group
from rich.table import Table
from rich.text import Text

from exactfold.app.report.terminal import facts_table, listed, more_text, status_text
from exactfold.exact.numbers import decimal_above, decimal_below, decimal_near
from exactfold.exact.surds import rational

if TYPE_CHECKING:
    from exactfold.design.moving.result import Designed
    from exactfold.design.tolerance.closing import Closing
    from exactfold.design.tolerance.result import Tolerance


def tolerance_report(found: Tolerance, *, everything: bool = False) -> Group:
    """The radius, what limits it, and the radius of each vertex."""
    rows: list[tuple[str, str | Text]] = [
        ("status", Text.assemble(status_text(found.status), f" ({found.reason})")),
    ]
    if found.way:
        rows.append(("way", found.way))
    share = f", {_below(100 * found.relative, 3)} % of the shortest edge ({found.shortest:.3g})"
    known = found.radius or found.upper == 0
    radius = f"{_below(found.radius)}{share if found.radius else ''}"
    rows.append(("radius", radius if known else "none is proved"))
    if found.upper:
        rows.append(("upper", f"{_above(found.upper)}: {found.limit}"))
    if found.estimate is not None:
        guess = found.estimate
        rows.append(
            (
                "estimate",
                f"about one sheet in twenty changes within {guess.radius:.3g} ({guess.samples} "
                f"random moves, seed {guess.seed})",
            )
        )
    parts: list[Table | Text] = [facts_table(list(rows))]
    if any(found.vertices.values()):
        parts += [Text(""), *_vertices(found, everything)]
    if found.closings:
        parts += [Text(""), *_closings(found, everything)]
    return Group(*parts)


def design_report(found: Designed) -> Group:
    """What was reached, from where, and which vertices moved."""
    rows: list[tuple[str, str | Text]] = [
        ("status", Text.assemble(status_text(found.status), f" ({found.reason})")),
    ]
    if found.signs:
        rows.append(("branch", found.signs))
    if found.before is None or found.after is None:
        if found.pattern is not found.original:
            rows.append(("moved", f"by at most {found.largest_move:.3g}"))
        return Group(facts_table(list(rows)), *_moved(found))
    if found.goal == "letters":
        names = {True: "nearly lost at", False: "missing by"}
        for name, value in (("before", found.before), ("after", found.after)):
            rows.append((name, f"{names[value > 0]} {abs(value):.3g}"))
    else:
        rows.append((found.goal, f"from {_below(found.before)} to {_below(found.after)}"))
    rows.append(("moved", f"by at most {found.largest_move:.3g}"))
    return Group(facts_table(list(rows)), *_moved(found))


def _moved(found: Designed) -> list[Table | Text]:
    table = Table(box=None, pad_edge=False)
    for name in ("vertex", "x", "y"):
        table.add_column(name, justify="right")
    pairs = zip(found.original.vertices, found.pattern.vertices, strict=True)
    moved = [(v, after) for v, (before, after) in enumerate(pairs) if before != after]
    for v, (x, y) in moved:
        table.add_row(str(v), *(decimal_near(rational(c), 12) for c in (x, y)))
    return [Text(""), table] if moved else []


def _below(value: float, digits: int = 6) -> str:
    return decimal_below(Fraction(value), digits)


def _above(value: float) -> str:
    return decimal_above(Fraction(value), 6)


def _vertices(found: Tolerance, everything: bool) -> list[Table | Text]:
    table = Table(box=None, pad_edge=False)
    table.add_column("vertex", justify="right")
    table.add_column("may move alone by", justify="right")
    order = sorted(found.vertices.items(), key=lambda item: (item[1], item[0]))
    shown = order[: listed(len(order), everything=everything)]
    for v, radius in shown:
        table.add_row(str(v), _below(radius))
    return [table, *more_text(len(order) - len(shown))]


def _closings(found: Tolerance, everything: bool) -> list[Table | Text]:
    table = Table(box=None, pad_edge=False)
    table.add_column("way", justify="right")
    table.add_column("needs that", overflow="fold")
    table.add_column("off by, for a move of 1", overflow="fold")
    shown = found.closings[: listed(len(found.closings), everything=everything)]
    for way, one in shown:
        table.add_row(str(way), one.text, _compliance(one))
    note = (
        "A loop is off by so large a share of its fold angles, a straight crease by so many "
        "radians, to first order, for each unit of length by which the vertex moves."
    )
    return [table, *more_text(len(found.closings) - len(shown)), Text(""), Text(note)]


def _compliance(one: Closing) -> str:
    order = sorted(one.compliance.items(), key=lambda item: (-item[1], item[0]))
    few = ", ".join(f"vertex {v}: {size:.3g}" for v, size in order[:4])
    return few + (", ..." if len(order) > 4 else "")
