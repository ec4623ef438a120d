"""Certificates of all motions of a sheet of rigid panels (docs/certificate.md, panels).

The checker takes only the pattern and the folds that are held flat from the file. It finds
everything else again and compares every claim: the flat closure, the lines of motions at each
vertex, the supports with the numbers of their modes, the components, and which modes extend to true
motions. The structure theorem and the extension theorem (docs/panels.md, 2 and 4) show that the
answer is complete. If more than four folds of some vertex may fold, the part of the sheet with this
vertex is split into spaces (`leaves`).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ..core import limits
from ..core.kinds import DocumentKind
from ..core.reading import at_most, counted, items, keys, keys_of, natural, refusing, require, same
from ..sheets.holes import read_sheet
from ..sheets.panels import Edge, Near, PanelSheet, pair, read_edges
from .claims import (
    ListedPart,
    ModeClaim,
    ModesClaims,
    PanelFacts,
    PanelsClaims,
    SupportClaim,
)
from .components import components, times
from .leaves import PartComponents, verified_part
from .loops import MOST_ORDER, Loops
from .modes import Modes, Support, corners_of, name, named
from .trees import verified_trees

MOST_LISTED = limits.MOST_LISTED
MOST_SUPPORTS = limits.MOST_SUPPORTS


@refusing()
def check(data: dict[str, Any]) -> PanelsClaims:
    """Verify every claim of a certificate; raises `CertificateError` at the first failure.

    Returns the verified claims. They are about the pattern in the file, with the folds in `held`
    held flat.
    """
    claims = data["claims"]
    more = [key for key in ("spaces", "trees") if isinstance(claims, dict) and claims.get(key)]
    keys(claims, " ".join([keys_of(ModesClaims), *more]), "claims")
    sheet, digest = read_sheet(data["pattern"])
    held = read_edges(claims["held"], "held")
    for i, j in held:
        require((i, j) in sheet.folds, f"{i}-{j} is held flat, but is not a fold")
    near = sheet.live(held)
    groups = sheet.connected(near)
    trees = verified_trees(sheet, groups, items(claims.get("trees", []), "trees"))
    groups = [group for group in groups if min(group) not in trees]
    large = [
        group
        for group in groups
        if max(group) >= len(sheet.points) or any(len(around) > 4 for around in group.values())
    ]
    small = {v for group in groups if group not in large for v in group}
    modes = Modes(sheet, {v: around for v, around in near.items() if v in small})
    free = [e for e in sheet.free() if e not in held]
    live = {sheet.fold(v, u) for v, around in near.items() for u in around}
    pairs = paired(supports_of(modes), items(claims["supports"], "supports"))
    supports, loops = [support for support, _ in pairs], Loops(modes)
    extending = [_extending(loops, support, entry) for support, entry in pairs]
    parts = _parts(sheet, large, items(claims.get("spaces", []), "spaces"))
    parts += trees.values()
    second = components([(s.vertices, s.count) for s in supports], len(free))
    second = times(second, [part.second for part in parts])
    true = None
    known = [part.true for part in parts if part.true is not None]
    if all(complete for _, complete in extending) and len(known) == len(parts):
        numbers = zip(supports, extending, strict=True)
        true = components([(s.vertices, n) for s, (n, _) in numbers if n], len(free))
        true = times(true, known)
    moves = free or any(n for n, _ in extending) or any(part.folds for part in parts)
    facts: PanelFacts = {
        "interior": len(sheet.interior),
        "border": len(sheet.boundary_set),
        "folds": len(sheet.folds),
        "sha256": digest,
        "held": [list(edge) for edge in held],
        "flat": [list(e) for e in sheet.folds if e not in live and e not in free],
        "free": [list(edge) for edge in free],
        "second_order": second,
        "true": true,
        "rigid": _rigid(second, true, moves),
        "modes": None if large or trees else sum(support.count for support in supports),
    }
    if claims["rigid"] == "undecided":  # "undecided" claims nothing, so that it is always right
        facts["rigid"] = "undecided"
    for key, fact in facts.items():
        require(same(claims[key], fact), f"claim {key} = {claims[key]!a}, but it is {fact!a}")
    proved: PanelsClaims = claims
    return proved


def _rigid(second: dict[str, int], true: dict[str, int] | None, moves: object) -> str:
    if set(second) == {"0"} or (true is not None and set(true) == {"0"}):
        return "proved"
    return "refuted" if moves else "undecided"


def _parts(sheet: PanelSheet, large: list[Near], given: list[Any]) -> list[PartComponents]:
    """Verify each part that has a vertex with more than four folds; return its components."""
    entries: dict[tuple[int, ...], Any] = {}
    for entry in given:
        more = ["isolated"] if isinstance(entry, dict) and entry.get("isolated") else []
        keys(entry, " ".join([keys_of(ListedPart), *more]), "a part")
        vertices = tuple(natural(v, "a vertex") for v in items(entry["vertices"], "vertices"))
        entries[vertices] = entry
    require(len(entries) == len(given), "a part of the sheet appears twice")
    places = [tuple(part) for part in large]
    right = sorted(entries) == sorted(places)
    require(right, "the parts listed are not those with a vertex of more than four folds")
    return [verified_part(sheet, part, entries[tuple(part)]) for part in large]


# --- supports ------------------------------------------------------------------------------------


def supports_of(modes: Modes) -> list[Support]:
    """All supports of a sheet; raises `LimitError` if they are too many."""
    supports = []
    for support in modes.supports():
        supports.append(support)
        at_most(len(supports), MOST_SUPPORTS, "the supports", "MOST_SUPPORTS")
    return supports


def paired(supports: Sequence[Support], given: list[Any]) -> list[tuple[Support, dict[str, Any]]]:
    """Each support with its entry in the file; raises unless the file lists each of them once."""
    known = {support.folds: support for support in supports}
    entries: dict[tuple[Edge, ...], dict[str, Any]] = {}
    for entry in given:
        keys(entry, keys_of(SupportClaim), "a support")
        folds = tuple(read_edges(entry["folds"], "folds of a support"))
        require(folds in known, f"the folds {list(folds)[:20]} are not the folds of a support")
        require(folds not in entries, f"a support with the folds {list(folds)[:20]} appears twice")
        entries[folds] = entry
    for folds, support in known.items():
        require(folds in entries, f"{named(support)} is missing")
        for key, fact in (("vertices", list(support.vertices)), ("count", support.count)):
            claim = entries.get(folds, {}).get(key, fact)
            require(same(claim, fact), f"{key} of {named(support)}: {claim!a}, but it is {fact!a}")
    return [(support, entries[folds]) for folds, support in known.items() if folds in entries]


def _extending(loops: Loops, support: Support, entry: dict[str, Any]) -> tuple[int, bool]:
    """How many modes of a support are verified to extend, and whether all modes are decided."""
    kind = kind_of(loops, support)
    by, number = entry["by"], entry["extending"]
    require(by == kind, f"{named(support)} extends by {kind}, not by {by!a}")
    decided = number is not None or kind == "loops"
    require(decided, f"all modes of {named(support)} extend, but their number is left open")
    if entry["modes"] is None and (number is None or kind != "loops"):
        good = 0 if number is None else support.count
    else:
        at_most(support.count, MOST_LISTED, f"the modes of {named(support)}", "MOST_LISTED")
        rows = loops.modes.listed(support)
        verdicts = [
            _extends(loops, support, row, mode, number is None)
            for row, mode in listed(loops.modes, support, rows, entry["modes"])
        ]
        good = sum(verdict is True for verdict in verdicts)
    shown = f"{good} modes of {named(support)} extend, not {number!a}"
    require(number is None or same(number, good), shown)
    return good, number is not None


def kind_of(loops: Loops, support: Support) -> str:
    """Why the modes of a support extend: "forest", "linear", or "loops" if loops must decide."""
    if not support.loops:
        return "forest"
    # Whether a transmission is linear does not depend on the line, so that any choice will do.
    chosen = {v: choices[0] for v, choices in support.choices.items()}
    steps = [step for loop in support.loops for step in loops.steps(chosen, loop)]
    return "linear" if all(step.quadratic is None for step in steps) else "loops"


def listed(
    modes: Modes, support: Support, rows: list[dict[int, int]], given: Any
) -> list[tuple[dict[int, int], dict[str, Any] | None]]:
    """Each mode with its entry in the file, or with None if the file lists no modes.

    Raises if the file lists some modes, but not each of them once.
    """
    if given is None:
        return [(row, None) for row in rows]
    known = {_choice(support, row): row for row in rows}
    entries: dict[str, dict[str, Any]] = {}
    for mode in items(given, "modes"):
        keys(mode, keys_of(ModeClaim), "a mode")
        choice = mode["choice"]
        require(choice in known, f"{choice!a} is not a mode of {named(support)}")
        require(choice not in entries, f"the mode {choice} of {named(support)} appears twice")
        entries[choice] = mode
    for choice, row in known.items():
        require(choice in entries, f"the mode {choice} of {named(support)} is missing")
        letters = letters_of(modes, support, row)
        mirrored = letters.translate(str.maketrans("MV", "VM"))
        require(
            entries.get(choice, {}).get("assignment", letters) in (letters, mirrored),
            f"the mode {choice} of {named(support)} has the letters {letters}",
        )
    return [(known[choice], mode) for choice, mode in entries.items() if choice in known]


def _choice(support: Support, row: dict[int, int]) -> str:
    """The line that a mode has at each vertex: 0 if there is only one line, else - or +."""
    places = ((support.choices[v], row[v]) for v in support.vertices)
    return "".join("0" if len(lines) == 1 else "-+"[lines.index(k)] for lines, k in places)


def letters_of(modes: Modes, support: Support, row: dict[int, int]) -> str:
    """The letters of the active folds: V if the density has the sign of the first fold, else M."""
    signs = {support.folds[0]: 1}
    waiting = set(support.vertices)
    while waiting:
        v = next(u for u in sorted(waiting) if any(pair(u, w) in signs for w in support.active[u]))
        waiting.remove(v)
        known = next(w for w in sorted(support.active[v]) if pair(v, w) in signs)
        for w in support.active[v]:
            turn = modes.gain(v, row[v], known, w).sign()
            signs[pair(v, w)] = signs[pair(v, known)] * turn
    return "".join("V" if signs[fold] > 0 else "M" for fold in support.folds)


def _extends(
    loops: Loops,
    support: Support,
    row: dict[int, int],
    mode: dict[str, Any] | None,
    open_ones: bool,
) -> bool | None:
    """Whether a mode extends to true motions, None if that is left open.

    Raises if the file says otherwise.
    """
    said = None if mode is None else mode["extends"]
    if mode is not None and said == "refuted":
        loop = tuple(natural(v, "vertex") for v in items(mode["loop"], "a loop"))
        order = natural(mode["order"], "order")
        require(order % 2 and 3 <= order <= MOST_ORDER, f"there is no order {order}")
        for v, before, after in corners_of(loop):
            require(
                {before, after} <= support.active.get(v, frozenset()) and before != after,
                f"{name(loop)} is not a loop of {named(support)}",
            )
        shown = f"the loop {name(loop)} of {named(support)} is not proved to fail at order {order}"
        require(loops.fails(row, loop, order), shown)
        return False
    plain = mode is None or mode["loop"] is mode["order"] is None
    require(plain, f"a mode of {named(support)} names a loop or an order, but is not refuted")
    if open_ones and (mode is None or said == "undecided"):
        return None
    good = all(loops.closes(row, loop) for loop in support.loops)
    verdict = "proved" if good else "refuted"
    require(
        mode is None or said == verdict, f"a mode of {named(support)} is {verdict}, not {said!a}"
    )
    return good


def summary(claims: PanelsClaims) -> str:
    """One line that states the verified claims."""
    shown = ", ".join(f"{n} of dimension {d}" for d, n in claims["second_order"].items())
    true = "are not decided" if claims["true"] is None else "are the same"
    leaves = [leaf for part in claims.get("spaces", ()) for leaf in part["leaves"]]
    folding = sum(leaf["extending"] for leaf in leaves)
    trees = [tree["components"] for tree in claims.get("trees", ())]
    folding += sum(n for counts in trees for d, n in counts.items() if d != "0")
    if claims["true"] is None and folding:
        true += f" (at least {folding} components of its parts extend to true motions)"
    if claims["true"] not in (None, claims["second_order"]):
        true = "are " + ", ".join(f"{n} of dimension {d}" for d, n in claims["true"].items())
    held = f", {counted(len(claims['held']), 'fold', 'folds')} held flat" if claims["held"] else ""
    size = counted(claims["folds"], "fold", "folds")
    inner = counted(claims["interior"], "interior vertex", "interior vertices")
    return (
        f"VALID: the motions of the sheet of {size} and {inner}{held} have the components "
        f"{shown} to second order, and those of the true motions {true}; sha256 {claims['sha256']}"
    )


PANELS = DocumentKind(
    format="exactfold certificate",
    named="panels",
    versions=(3,),
    names="format version kind pattern claims provenance",
    claims=PanelsClaims,
    check=check,
    summary=summary,
)
"""All motions of a sheet of rigid panels (docs/certificate.md)."""
