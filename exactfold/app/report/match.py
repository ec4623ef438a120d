"""What `exactfold match` prints: the branches with the letters, or why there are none."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

from rich.console import Group
from rich.table import Table
from rich.text import Text

from exactfold._support.plurals import agreeing, counted
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED
from exactfold.app.report.terminal import listed, more_text, status_text
from exactfold.design.assignments.why import fold_text

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from exactfold.design.assignments.boundary_result import BoundaryMatch
    from exactfold.design.assignments.nearest import Nearest
    from exactfold.design.assignments.result import Match, MatchedRay
    from exactfold.design.panels.match import PanelMatch

_NEAR = 8
"""The number of nearest branches that are shown, unless all are asked for."""
RIGIDLY = (
    "This is about rigid panels that all move together, from the flat sheet. A model that is "
    "folded step by step, or whose paper bends, can be right all the same: `exactfold vertices` "
    "says at which vertices Maekawa's and Kawasaki's conditions for folding flat hold, and "
    "`exactfold flat` whether the whole sheet folds flat."
)
"""What a refutation does not mean."""
_LETTERS = {"M": "mountain", "V": "valley", "F": "flat fold", "U": "free fold"}


def match_report(
    match: Match, nearest: Nearest | None, seconds: float, *, everything: bool = False
) -> Group:
    """The answer, the letters, and the branches that have them; or the reasons, and the nearest
    ones.
    """
    parts: list[Any] = [_answer(match, seconds), "", Text(_asked(match))]
    if match.matches:
        limit = listed(len(match.matches), everything=everything)
        parts += ["", _table(match.matches[:limit], "vertices up", _up)]
        parts += more_text(len(match.matches) - limit)
    else:
        parts += ["", Text("Why" if match.status is PROVED else "What is known", style="bold")]
        lines = _why(match)
        limit = listed(len(lines), everything=everything)
        parts += [Text(f"- {line}") for line in lines[:limit]]
        parts += more_text(len(lines) - limit)
    if nearest is not None:
        parts += ["", *_nearest(nearest, everything)]
    if match.status is PROVED and not match.matches:
        parts += ["", Text(RIGIDLY)]
    if match.matches or (nearest is not None and nearest.rays):
        parts += [
            "",
            Text(
                "Signs and side are those of `exactfold fold PATTERN --signs SIGNS --side SIDE`; "
                "letters and vertices are seen from above."
            ),
        ]
    return Group(*parts)


NAMED = 12
"""The number of creases that are named, unless all are asked for."""


def panel_match_report(panel_match: PanelMatch, *, everything: bool = False) -> Group:
    """Whether rigid panels start to fold with the letters, and why, in lines of words."""
    answer, *reasons = panel_match.lines
    limit = listed(len(reasons), everything=everything)
    head = Text.assemble(
        f"{answer} - ", status_text(panel_match.status), f" ({panel_match.seconds:.2f} s)"
    )
    rest = [Text(f"- {reason}") for reason in reasons[:limit]]
    more = more_text(len(reasons) - limit)
    first = _first_order(panel_match, everything)
    meaning = [Text(f"\n{RIGIDLY}")] if panel_match.starts is REFUTED else []
    return Group(head, "", Text(_asked(panel_match)), *rest, *more, *first, *meaning)


def _first_order(panel_match: PanelMatch, everything: bool) -> list[str | Text]:
    """Which creases can bend their way together to first order, and which never can."""
    if panel_match.first_order is None:
        return []
    first, asked = panel_match.first_order, sum(x in "MV" for x in panel_match.letters.values())
    lines = [f"{len(first.together)} of {counted(asked, 'crease')} can fold together"]
    for folds, said in ((first.never, "never fold"), (first.undecided, "are undecided")):
        if folds:
            limit = len(folds) if everything else NAMED
            named = ", ".join(fold_text(fold) for fold in folds[:limit])
            more = f" and {len(folds) - limit} more" if len(folds) > limit else ""
            lines.append(f"{len(folds)} {said}: {named}{more}")
    head = "To first order, where no crease goes against its letter"
    return ["", Text(head, style="bold"), *(Text(f"- {line}") for line in lines)]


def boundary_match_report(boundary_match: BoundaryMatch, *, everything: bool = False) -> Group:
    """Whether a sheet with more than four corners starts to fold with the letters, and how."""
    answer = {
        PROVED: "the sheet starts to fold with these mountains and valleys",
        REFUTED: "the sheet does not start to fold with these mountains and valleys",
    }.get(
        boundary_match.starts,
        "whether the sheet starts to fold with these mountains and valleys is open",
    )
    lines = boundary_match.why
    limit = listed(len(lines), everything=everything)
    head = Text.assemble(
        f"{answer} - ", status_text(boundary_match.status), f" ({boundary_match.seconds:.2f} s)"
    )
    rest = [Text(f"- {line}") for line in lines[:limit]]
    rest += more_text(len(lines) - limit)
    rest += [Text(f"\n{RIGIDLY}")] if boundary_match.starts is REFUTED else []
    return Group(head, "", Text(_asked(boundary_match)), *rest)


def _answer(match: Match, seconds: float) -> Text:
    took = f" ({seconds:.2f} s)"
    ways = len({ray.branch.sign_text for ray in match.matches})
    proved = status_text(match.status)
    if not ways:
        if match.status is PROVED:
            text = "no way to start folding has these mountains and valleys - "
            return Text.assemble(text, proved, took)
        return Text.assemble(
            "whether a way to start folding has these mountains and valleys is ", proved, took
        )
    has = agreeing(ways, "has")
    text = f"{counted(ways, 'way')} to start folding {has} these mountains and valleys"
    both = f", {len(match.matches)} with both sides" if ways < len(match.matches) else ""
    if match.status is PROVED:
        return Text.assemble(f"{text}{both} - ", proved, took, "; there is no other")
    return Text.assemble(f"at least {text}{both}; whether others have is ", proved, took)


def _asked(match: Match | PanelMatch | BoundaryMatch) -> str:
    counts = Counter(match.letters.values())
    kinds = [counted(counts[x], name) for x, name in _LETTERS.items() if counts[x]]
    return f"asked for: {', '.join(kinds)}"


def _why(match: Match) -> list[str]:
    """Reasons in plain words: single vertices if these are enough, otherwise what was refuted."""
    alone = match.conflicts
    lines = [f"vertex {v} can pop {text}" for v, text in sorted(alone.items())]
    pairs = ((match.labels[i], match.labels[j]) for i, j in match.sheet.folds)
    moving = {fold_text((min(pair), max(pair))) for pair in pairs}
    stuck = [fold_text(f) for f, x in sorted(match.letters.items()) if x in "MV"]
    stuck = [name for name in stuck if name not in moving]
    if stuck:
        lie, stay = ("lies", "stays") if len(stuck) == 1 else ("lie", "stay")
        name = "crease" if len(stuck) == 1 else "creases"
        lines.insert(
            0, f"{name} {', '.join(stuck)} {lie} in triangulated triangles and {stay} flat"
        )
    if lines:
        return lines
    single = sum(len(refutation.signs) == 1 for refutation in match.refutations)
    single += len(match.reasons)
    several = len(match.refutations) + len(match.reasons) - single
    if single:
        lines.append(
            f"{counted(single, 'sign')} of single vertices {agreeing(single, 'is')} impossible "
            "with the letters around them"
        )
    if several:
        lines.append(
            f"{counted(several, 'choice')} of signs of several vertices "
            f"{agreeing(several, 'is')} refuted, each by an exact sum over the creases"
        )
    if match.leaves:
        lines.append(
            f"{counted(match.leaves, 'choice')} of the signs of all vertices "
            f"{agreeing(match.leaves, 'is')} left: their branches were found, and have other "
            "letters"
        )
    if match.open_signs:
        lines.append(
            f"{counted(len(match.open_signs), 'choice')} of signs {agreeing(1, 'is')} open: "
            "--most N compares more"
        )
    return lines


def _nearest(nearest: Nearest, everything: bool) -> list[Any]:
    least = counted(nearest.at_least, "crease")
    if nearest.distance is None:
        return [Text(f"No near branch was found; it is proved that all differ at {least} or more.")]
    far = counted(nearest.distance, "crease")
    if nearest.status is PROVED:
        text = f"Nearest: {far} to change - "
        rest = ", and no other is as near" if nearest.complete else ", others may be as near"
        if nearest.complete and len(nearest.rays) > 1:
            rest = f", and only these {len(nearest.rays)} are as near"
        head = Text.assemble(text, status_text(PROVED), f"; none is nearer{rest}")
    else:
        head = Text.assemble(
            f"Nearest found: {far} to change; ",
            f"every way needs {least} or more, and whether {least} are enough is ",
            status_text(UNDECIDED),
        )
    limit = len(nearest.rays) if everything else _NEAR
    table = _table(nearest.rays[:limit], "creases to change", lambda h: _changes(nearest, h))
    return [head, "", table, *more_text(len(nearest.rays) - limit)]


def _changes(nearest: Nearest, ray: MatchedRay) -> str:
    differences = nearest.differences(ray)
    return ", ".join(
        f"{fold_text(fold)} {wanted}->{actual}"
        for fold, (wanted, actual) in sorted(differences.items())
    )


def _table(rays: Sequence[MatchedRay], title: str, told: Callable[[MatchedRay], str]) -> Table:
    table = Table(box=None, pad_edge=False)
    table.add_column("signs", overflow="fold")
    table.add_column("side")
    table.add_column(title, overflow="fold")
    for ray in rays:
        table.add_row(ray.branch.sign_text, "+" if ray.side > 0 else "-", told(ray))
    return table


def _up(ray: MatchedRay) -> str:
    signs = ray.vertex_signs
    up = ", ".join(str(v) for v, s in sorted(signs.items()) if s > 0) or "none"
    flat = ", ".join(str(v) for v, s in sorted(signs.items()) if s == 0)
    return up + (f" (flat: {flat})" if flat else "")
