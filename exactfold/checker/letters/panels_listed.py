"""Certificates of all mountain-valley assignments with which rigid panels start to fold.

The file has no evidence, because the checker finds all assignments again. The motions are those to
second order in which all folds bend that the flat closure leaves (docs/assignment.md, Theorem 5).
Parts of the sheet without a common vertex move independently. A part is cut into blocks at the
folds that alone join their two sides: motions of the sides that agree in the letter of such a fold
can be scaled until they agree there, and so the assignments of the part are those of the blocks
that agree at common folds. A block of one vertex is decided by the theorem of Abel et al.
(`vertices`). The motions of other blocks lie in the spaces that the checker finds
(`panels.spaces`), and each of them has to be a line.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import prod
from typing import Any, TypedDict

from ..core import limits
from ..core.kinds import DocumentKind
from ..core.reading import at_most, counted, items, keys, keys_of, refusing, require, same
from ..panels.spaces import Spaces
from ..sheets.panels import Edge, Near, PanelSheet, connected, pair, read_edges, read_panels
from .vertices import can_fold

_MIRRORED = str.maketrans("MV", "VM")
MOST_ASSIGNMENTS = limits.MOST_ASSIGNMENTS
MOST_STEPS = limits.LETTER_STEPS


class PartAssignments(TypedDict):
    """The assignments of a part, one letter for each of its folds."""

    folds: list[list[int]]
    assignments: list[str]


class ForcingClaim(TypedDict):
    """Folds whose letters force those of all others; no smaller set does for these letters."""

    letters: str
    folds: list[list[int]]


class PanelAssignmentsClaims(TypedDict):
    """The claims of a file (see `check`)."""

    number: int
    parts: list[PartAssignments]
    free: list[list[int]]
    flat: list[list[int]]
    forcing: ForcingClaim | None


class VerifiedPanelAssignments(PanelAssignmentsClaims):
    """The verified claims, with the number of interior vertices and the digest of the pattern."""

    interior: int
    sha256: str


@refusing()
def check(data: dict[str, Any]) -> VerifiedPanelAssignments:
    """Verify every claim of a loaded certificate; raises `CertificateError` at the first failure.

    Returns the claims and the SHA-256 of the pattern. For each of the `parts` of the sheet the
    `assignments` are those with which it starts to fold, with all its folds bent. Folds in `free`,
    from boundary to boundary, may have any letter, and folds in `flat` stay flat in every motion.
    `number` counts the assignments of all folds that are not flat. `forcing` has the `letters` of
    all folds of one assignment, F where a fold is flat: no other assignment agrees with it at all
    of its `folds`, and this holds for no smaller set of folds.
    """
    claims = data["claims"]
    keys(claims, keys_of(PanelAssignmentsClaims), "claims")
    sheet, digest = read_panels(data["pattern"])
    parts = [_part(sheet, group) for group in connected(sheet.live([]))]
    free = [fold for fold in sheet.folds if sheet.boundary_set.issuperset(fold)]
    moving = {fold for folds, _ in parts for fold in folds}
    for entry, (folds, texts) in zip(
        items(claims["parts"], "parts", len(parts)), parts, strict=True
    ):
        keys(entry, keys_of(PartAssignments), "a part")
        right = same(entry["folds"], _lists(folds))
        require(right, f"the folds of a part are {_lists(folds)[:20]}, not those listed")
        where = f"the part of fold {folds[0][0]}-{folds[0][1]}"
        shown = f"there are {len(texts)} assignments of {where}, not those listed"
        require(entry["assignments"] == texts, shown)
    facts: dict[str, Any] = {
        "number": prod(len(texts) for _, texts in parts) << len(free),
        "free": _lists(free),
        "flat": _lists(fold for fold in sheet.folds if fold not in moving and fold not in free),
    }
    for key, fact in facts.items():
        require(same(claims[key], fact), f"claim {key} = {claims[key]!a}, but it is {fact!a}")
    if claims["forcing"] is not None:
        _check_forcing(sheet, parts, free, claims["forcing"])
    proved: PanelAssignmentsClaims = claims
    return {"sha256": digest, "interior": len(sheet.interior), **proved}


def _lists(folds: Iterable[Edge]) -> list[list[int]]:
    return [[i, j] for i, j in folds]


# --- parts ---------------------------------------------------------------------------------------


def _part(sheet: PanelSheet, part: Near) -> tuple[list[Edge], list[str]]:
    """The folds of a part, and all its assignments, sorted."""
    total: list[dict[Edge, str]] = [{}]
    for block in blocks_of(part):
        folds = _folds(block)
        texts = _at_vertex(sheet, block, folds) if len(block) == 1 else _lines(sheet, block, folds)
        own = [
            dict(zip(folds, text, strict=True))
            for half in texts
            for text in (half, half.translate(_MIRRORED))
        ]
        total = [
            {**one, **other}
            for one in total
            for other in own
            if all(one.get(fold, letter) == letter for fold, letter in other.items())
        ]
        at_most(len(total), MOST_ASSIGNMENTS, "the assignments of a part", "MOST_ASSIGNMENTS")
    folds = _folds(part)
    return folds, sorted("".join(one[fold] for fold in folds) for one in total)


def _folds(near: Near) -> list[Edge]:
    return sorted({pair(v, u) for v, around in near.items() for u in around})


def blocks_of(part: Near) -> list[Near]:
    """The blocks of a part, each after the first with a fold of an earlier one.

    Folds that lie on no cycle of the graph of the vertices are found by a search in depth: from the
    branch below such a fold, no other fold leads back.
    """
    first = min(part)
    order, above = {first: 0}, {first: first}
    stack = [(first, iter(part[first]))]
    while stack:
        v, others = stack[-1]
        u = next((u for u in others if u in part and u not in order), None)
        if u is None:
            stack.pop()
        else:
            order[u], above[u] = len(order), v
            stack.append((u, iter(part[u])))
    lowest = dict(order)
    for v in sorted(order, key=order.__getitem__, reverse=True):
        back = (order[u] for u in part[v] if u in part and u != above[v] and above[u] != v)
        below = (lowest[u] for u in part[v] if u in part and above[u] == v and u != v)
        lowest[v] = min([order[v], *back, *below])
    blocks: list[Near] = []
    place: dict[int, Near] = {}
    for v in order:
        if v == first or lowest[v] == order[v]:
            blocks.append({})
            place[v] = blocks[-1]
        else:
            place[v] = place[above[v]]
        place[v][v] = part[v]
    return [dict(sorted(block.items())) for block in blocks]


def _at_vertex(sheet: PanelSheet, block: Near, folds: list[Edge]) -> list[str]:
    """The letters that a vertex can have, a valley at its first fold.

    Letters are tried fold by fold, with those of later folds free.
    """
    ((v, around),) = block.items()
    place = [folds.index(pair(v, u)) for u in around]
    directions = [sheet.vector(v, u) for u in around]
    found, waiting, steps = list[str](), ["V"], 0
    while waiting:
        text = waiting.pop()
        steps += 1
        at_most(steps, MOST_STEPS, f"the letters tried at vertex {v}", "LETTER_STEPS")
        if not can_fold(directions, "".join(text[k] if k < len(text) else "U" for k in place)):
            continue
        if len(text) == len(folds):
            found.append(text)
        else:
            waiting += [text + "M", text + "V"]
    return found


def _lines(sheet: PanelSheet, block: Near, folds: list[Edge]) -> set[str]:
    """The letters of the spaces in which all folds of a block bend, a valley at the first fold."""
    texts = set()
    for leaf in Spaces(sheet, block).leaves():
        if leaf.folds == tuple(folds):
            only = len(leaf.basis) == 1
            require(only, f"the motions of the block of vertex {min(block)} are not lines only")
            sides = [leaf.basis[0][fold].sign() for fold in folds]
            texts.add("".join("V" if side == sides[0] else "M" for side in sides))
    return texts


# --- forcing sets --------------------------------------------------------------------------------


def _check_forcing(
    sheet: PanelSheet,
    parts: Sequence[tuple[list[Edge], list[str]]],
    free: Sequence[Edge],
    given: Any,
) -> None:
    """Raise unless the folds force the letters, and no smaller set of folds does.

    A set forces an assignment of a part if every other assignment differs from it at one of its
    folds. Each free fold has to be in the set.
    """
    keys(given, keys_of(ForcingClaim), "forcing")
    text, folds = given["letters"], read_edges(given["folds"], "the folds that force others")
    letters = dict(zip(sheet.folds, items(list(text), "letters", len(sheet.folds)), strict=True))
    flat = set(sheet.folds).difference(free, *(own for own, _ in parts))
    for fold, letter in letters.items():
        fits = letter == "F" if fold in flat else letter in ("M", "V")
        require(fits, f"fold {fold[0]}-{fold[1]} has the letter {letter!a}, which cannot be")
    left = set(folds).difference(free)
    require(len(folds) - len(left) == len(free), "a free fold is not among those that force others")
    for own, texts in parts:
        place = {fold: k for k, fold in enumerate(own)}
        asked = "".join(letters[fold] for fold in own)
        require(asked in texts, "the letters that are forced are no assignment")
        differ = {_differing(asked, other) for other in texts if other != asked}
        chosen = frozenset(place[fold] for fold in left if fold in place)
        require(all(chosen & some for some in differ), "the folds do not force all others")
        few = list(_minimal(differ))
        smaller = chosen and _hit(few, len(chosen) - 1, [0])
        require(not smaller, "a smaller set of folds forces all others, too")
        left.difference_update(place)
    require(not left, "a fold that stays flat is among those that force others")


def _differing(text: str, other: str) -> frozenset[int]:
    both = enumerate(zip(text, other, strict=True))
    return frozenset(k for k, (letter, another) in both if letter != another)


def _minimal(sets: set[frozenset[int]]) -> list[frozenset[int]]:
    """The sets that contain no other of the sets."""
    kept: list[frozenset[int]] = []
    for some in sorted(sets, key=len):
        if not any(other <= some for other in kept):
            kept.append(some)
    return kept


def _hit(sets: list[frozenset[int]], most: int, steps: list[int]) -> bool:
    """Whether some set of at most so many places meets all the sets."""
    steps[0] += 1
    at_most(steps[0], MOST_STEPS, "the steps to a smaller forcing set", "LETTER_STEPS")
    if not sets:
        return True
    if most == 0:
        return False
    first = min(sets, key=len)
    return any(
        _hit([some for some in sets if place not in some], most - 1, steps) for place in first
    )


def summary(claims: VerifiedPanelAssignments) -> str:
    """One line that states the verified claims."""
    which = counted(claims["number"], "assignment", "assignments")
    folds = sum(len(part["folds"]) for part in claims["parts"]) + len(claims["free"])
    forcing = ""
    if claims["forcing"] is not None:
        few = counted(len(claims["forcing"]["folds"]), "fold forces", "folds force")
        forcing = f"; for one of them {few} the others, and no smaller set does"
    return (
        f"VALID: the sheet of rigid panels starts to fold with exactly {which} of mountains and "
        f"valleys to {counted(folds, 'fold', 'folds')}{forcing}; sha256 {claims['sha256']}"
    )


PANEL_ASSIGNMENTS = DocumentKind(
    format="exactfold assignments",
    named="panel-assignments",
    versions=(1,),
    names="format version kind pattern claims provenance",
    claims=VerifiedPanelAssignments,
    check=check,
    summary=summary,
)
"""All mountain-valley assignments of a sheet of rigid panels (docs/assignment.md)."""
