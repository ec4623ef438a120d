"""Certificates of all motions of a sheet of rigid panels (docs/certificate.md, panels).

Only the pattern and the folds that are held flat are taken from the file. The flat closure, the
lines of motions at each vertex, the supports with the numbers of their modes, the components and
which modes truly fold are found again, and every claim is compared. Why the answer is complete:
the structure theorem, and the theorem of transmissions, in docs/panels.md, 2 and 4. Vertices with
more than four folds are verified where their folds have no first-order motion at all.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from .formats import LISTING, PANELS, PANELS_VERSION
from .panel_components import components
from .panel_loops import MOST_ORDER, Loops
from .panel_modes import Modes, Support, corners_of, name, named
from .panel_sheet import Edge, pair, read_panels
from .reading import (
    MALFORMED,
    CertificateError,
    FormatError,
    document,
    items,
    keys,
    natural,
    require,
)

MOST_LISTED = 1 << 12  # modes of one support that are looked at one by one
MOST_SUPPORTS = 1 << 15

FACTS = "interior border folds sha256 held flat free second_order true rigid modes"


def read(data: Any) -> dict[str, Any]:
    """`data` if it is a certificate of a sheet of panels; raises `FormatError`."""
    names = "format version kind pattern claims provenance"
    if document(data, LISTING, PANELS_VERSION, names)["kind"] != PANELS:
        raise FormatError(f"the kind {data['kind']!a} is not known to this checker")
    return dict(data)


def check(data: dict[str, Any]) -> dict[str, Any]:
    """Verify every claim of a certificate; raises `CertificateError` at the first failure.

    Returns the verified claims. They hold for the pattern in the file, if the folds in `held` are
    held flat.
    """
    try:
        return _check(data)
    except MALFORMED as error:
        raise CertificateError(f"malformed: {type(error).__name__} while checking") from error


def _check(data: dict[str, Any]) -> dict[str, Any]:
    claims = data["claims"]
    keys(claims, f"{FACTS} supports", "claims")
    sheet, digest = read_panels(data["pattern"])
    held = _edges(claims["held"], "held")
    for i, j in held:
        require((i, j) in sheet.folds, f"{i}-{j} is held flat, and no fold")
    near = sheet.live(held)
    for v, around in near.items():
        require(len(around) <= 4, f"vertex {v} has {len(around)} folds that may fold")
    modes = Modes(sheet, near)
    found, loops = _supports(modes), Loops(modes)
    free = [e for e in sheet.folds if sheet.border.issuperset(e) and e not in held]
    live = {tuple(sorted((v, u))) for v, around in near.items() for u in around}
    extending = [
        _extending(loops, support, entry)
        for support, entry in _paired(found, items(claims["supports"], "supports"))
    ]
    second = components([(s.vertices, s.count) for s in found], len(free))
    true = None
    if None not in extending:
        counted = zip(found, extending, strict=True)
        true = components([(s.vertices, n) for s, n in counted if n], len(free))
    facts = {
        "interior": len(sheet.interior),
        "border": len(sheet.border),
        "folds": len(sheet.folds),
        "sha256": digest,
        "held": [list(edge) for edge in held],
        "flat": [list(e) for e in sheet.folds if e not in live and e not in free],
        "free": [list(edge) for edge in free],
        "second_order": second,
        "true": true,
        "rigid": _rigid(second, true, free or any(extending)),
        "modes": sum(support.count for support in found),
    }
    for key, fact in facts.items():
        require(_same(claims[key], fact), f"claim {key} = {claims[key]!a}, but it is {fact!a}")
    return dict(claims)


def _rigid(second: dict[str, int], true: dict[str, int] | None, moves: object) -> str:
    if set(second) == {"0"} or (true is not None and set(true) == {"0"}):
        return "proved"
    return "refuted" if moves else "undecided"


def _same(claim: Any, fact: Any) -> bool:
    """Equal, and whole numbers where there are whole numbers."""
    if isinstance(fact, dict):
        return (
            isinstance(claim, dict)
            and claim == fact
            and all(map(_same, claim.values(), fact.values()))
        )
    if isinstance(fact, list):
        return isinstance(claim, list) and len(claim) == len(fact) and all(map(_same, claim, fact))
    return type(claim) is type(fact) and bool(claim == fact)


# --- supports ------------------------------------------------------------------------------------


def _supports(modes: Modes) -> list[Support]:
    found = []
    for support in modes.supports():
        found.append(support)
        require(len(found) <= MOST_SUPPORTS, f"there are more than {MOST_SUPPORTS} supports")
    return found


def _paired(found: Sequence[Support], given: list[Any]) -> Iterator[tuple[Support, Any]]:
    """Each support with what the file says of it: all of them, each once, and no other."""
    entries: dict[tuple[Edge, ...], Any] = {}
    for entry in given:
        keys(entry, "vertices folds count extending by modes", "a support")
        folds = tuple(_edges(entry["folds"], "folds"))
        require(folds not in entries, f"the support with folds {folds[:20]} appears twice")
        entries[folds] = entry
    for support in found:
        entry = entries.pop(support.folds, None)
        if entry is None:
            raise CertificateError(f"{named(support)} is missing")
        require(
            _same(entry["vertices"], list(support.vertices)), f"{named(support)} has other vertices"
        )
        require(
            _same(entry["count"], support.count),
            f"{named(support)} has {support.count} modes, not {entry['count']!a}",
        )
        yield support, entry
    for folds in entries:
        raise CertificateError(f"the folds {folds[:20]} are no support")


def _extending(loops: Loops, support: Support, entry: dict[str, Any]) -> int | None:
    """How many modes of a support truly fold, as claimed and verified; None if nothing is said."""
    kind = kind_of(loops, support)
    by, number = entry["by"], entry["extending"]
    require(by == kind, f"{named(support)} extends by {kind}, not by {by!a}")
    require(number is not None or kind == "loops", f"all modes of {named(support)} extend")
    if entry["modes"] is None and (number is None or kind != "loops"):
        good = support.count
    else:
        require(support.count <= MOST_LISTED, f"the modes of {named(support)} are too many")
        rows = loops.modes.listed(support)
        listed = _listed(loops.modes, support, rows, entry["modes"])
        verdicts = [
            _extends(loops, support, row, mode, number is None)
            for row, mode in zip(rows, listed, strict=True)
        ]
        good = sum(verdict is True for verdict in verdicts)
    if number is None:
        return None
    require(_same(number, good), f"{good} modes of {named(support)} extend, not {number!a}")
    return good


def kind_of(loops: Loops, support: Support) -> str:
    """Why the modes of a support extend, or by what it is to be decided."""
    if not support.loops:
        return "forest"
    chosen = {v: choices[0] for v, choices in support.choices.items()}  # all are linear, or none
    steps = [found for loop in support.loops for found in loops.steps(chosen, loop)]
    return "linear" if all(found.quadratic is None for found in steps) else "loops"


def _listed(
    modes: Modes, support: Support, rows: list[dict[int, int]], given: Any
) -> list[dict[str, Any] | None]:
    """What the file says of each mode of a support: all of them, if any are listed."""
    if given is None:
        return [None] * len(rows)
    entries: dict[str, dict[str, Any]] = {}
    for mode in items(given, "modes"):
        keys(mode, "choice assignment extends loop order", "a mode")
        require(mode["choice"] not in entries, f"a mode of {named(support)} appears twice")
        entries[mode["choice"]] = mode
    found = []
    for row in rows:
        choice = "".join(
            "0" if len(support.choices[v]) == 1 else "-+"[support.choices[v].index(row[v])]
            for v in support.vertices
        )
        mode = entries.pop(choice, None)
        if mode is None:
            raise CertificateError(f"the mode {choice} of {named(support)} is missing")
        letters = letters_of(modes, support, row)
        mirrored = letters.translate(str.maketrans("MV", "VM"))
        require(
            mode["assignment"] in (letters, mirrored),
            f"the mode {choice} of {named(support)} has the letters {letters}",
        )
        found.append(mode)
    for choice in entries:
        raise CertificateError(f"{choice!a} is no mode of {named(support)}")
    return found


def letters_of(modes: Modes, support: Support, row: dict[int, int]) -> str:
    """V or M for each active fold, as its density has the sign of the first or not."""
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
    """Whether a mode truly folds, which must be what the file says of it; None if it is open."""
    said = None if mode is None else mode["extends"]
    if mode is not None and said == "refuted":
        loop = tuple(natural(v, "vertex") for v in items(mode["loop"], "a loop"))
        order = natural(mode["order"], "order")
        require(order % 2 and 3 <= order <= MOST_ORDER, f"there is no order {order}")
        for v, before, after in corners_of(loop):
            require(
                {before, after} <= support.active.get(v, frozenset()) and before != after,
                f"{name(loop)} is no loop of {named(support)}",
            )
        shown = f"the loop {name(loop)} of {named(support)} is not seen to fail at order {order}"
        require(loops.fails(row, loop, order), shown)
        return False
    require(mode is None or mode["loop"] is mode["order"] is None, "a loop that fails nothing")
    if open_ones and said in (None, "undecided"):
        return None
    good = all(loops.closes(row, loop) for loop in support.loops)
    verdict = "proved" if good else "refuted"
    require(said in (None, verdict), f"a mode of {named(support)} is {verdict}, not {said!a}")
    return good


def _edges(value: Any, what: str) -> list[Edge]:
    found = []
    for edge in items(value, what):
        i, j = (natural(v, "a vertex") for v in items(edge, "an edge", 2))
        found.append((i, j))
    require(found == sorted(set(found)), f"{what} are not sorted")
    return found


def summary(claims: dict[str, Any]) -> str:
    """One line for verified claims."""
    shown = ", ".join(f"{n} of dimension {d}" for d, n in claims["second_order"].items())
    true = "not decided" if claims["true"] is None else "the same"
    if claims["true"] not in (None, claims["second_order"]):
        true = ", ".join(f"{n} of dimension {d}" for d, n in claims["true"].items())
    held = f", {len(claims['held'])} folds held flat" if claims["held"] else ""
    return (
        f"VALID: the motions of the sheet of {claims['folds']} folds and {claims['interior']} "
        f"interior vertices{held} have the components {shown} to second order, truly {true}; "
        f"sha256 {claims['sha256']}"
    )
