"""Certificates of motions: a branch followed from the flat state, without a gap (docs/motion.md).

Why it is a proof: the first piece is a curve of zeros of the equations in blown-up coordinates,
which at the flat state solve the second-order equations with the vertex signs claimed: it belongs
to the one branch with these signs (docs/theorem.md, 3 and 4). Every tube holds one curve of
configurations; where it begins, the one before ends on it and goes the same way. A motion may end
at a node: its last piece is an arc through it, a point of which lies on the last tube.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import zip_longest
from typing import Any

from ..core.kinds import DocumentKind
from ..core.limits import MOST_TUBES, MOST_WORK, MOTION_BITS, NODE_WORK
from ..core.reading import (
    counted,
    items,
    keys,
    natural,
    parse_rational,
    refusing,
    require,
    shown,
)
from ..sheets.reduced import emptied_sheet
from ..sheets.sheet import Sheet, read_sheet
from .boundary import Rim, border_of
from .contacts import check_contacts, said
from .drive import Drive, driven_of
from .equations import LengthEquations
from .names import names
from .paths import Path
from .pieces import arc_of, first_piece, land, parameter_of, tube_of
from .reached import check_reached
from .stretches import Arc, Link, Step
from .tubes import Start


@refusing()
def check(data: dict[str, Any]) -> dict[str, Any]:
    """Verify every claim of a loaded certificate; raises `CertificateError` at the first failure.

    Returns the claims, the SHA-256 of the pattern, and how many `tubes` there are between the first
    piece and the end, arcs through nodes not counted. The claims are: the half-branch with these
    vertex signs and this side, 1 or -1, is that of one simple branch, and from the flat state on it
    is followed by one analytic curve of configurations, all regular, which is at least `length`
    long in the space of the vertices (unit of the sheet, one triangle held). `side` is the sign of
    the boundary saddle or, with a reflex corner, of this corner in the sheet with its notch closed.
    With `rim`, heights of the boundary vertices of a convex border in order, these stay on the
    curve in the ratio of the rim (`Rim`), above the face `pinned` that is held, which is returned;
    `side` is the sign of the factor near the flat state. With `drive`, instead, the curve leaves
    the flat state along a simple solution with these signs, on which its folds are valleys or
    mountains by the signs of the `squares` q, and all along sin(a / 2)^2 of their angles a is in
    the ratio of |q|; then `side` is 1. If they are `reached`, these are |q| or more at the end.
    With `clear`, no two faces touch beyond what they share before this length of the motion; with
    `contact`, some do between two lengths (docs/contacts.md). With `node` the motion ends at a
    configuration in which the stars of the vertices `flat` are flat; all before it are regular. If
    `clear` is true there, no two faces touch up to it, nor in it. With `through` the curve goes
    through such configurations, where the vertices listed are flat, in this order; it is regular
    but for them. With `return` it ends in the flat state, along the half-branch with these vertex
    signs and this side.
    """
    given, digest = read_sheet(data["pattern"])
    claims, evidence = data["claims"], data["evidence"]
    more = ["clear"] if "clear" in claims else []
    more = ["clear", "contact"] if "contact" in claims else more
    ends = ["node"] if "node" in claims else []
    through = ["through"] if "through" in claims else []
    back = ["return"] if "return" in claims else []
    rim = ["rim"] if "rim" in claims else ["drive"] if "drive" in claims else []
    names_of = ["vertex_signs side length", *more, *ends, *through, *back, *rim]
    keys(claims, " ".join(names_of), "claims")
    found = [*(["contacts"] if more else []), *(["landing"] if back else [])]
    keys(evidence, " ".join(["emptied pinned bits start tubes", *found, *ends]), "evidence")
    require(not (back and (ends or more)), "a motion that returns claims a node, or contacts")
    heights = Rim(given, claims["rim"]) if "rim" in claims else None
    driven = [claims["drive"]] if "drive" in claims else []
    equations, removed = framework(given, evidence, heights, driven)
    bent = equations.drive is not None and equations.drive.reached
    require(not (back and bent), "a motion that returns ends with its driven folds flat")
    tubes = items(evidence["tubes"], "tubes")
    check_steps(equations, tubes, len(ends))
    start, tau = first_piece(equations, evidence["start"])
    _check_names(given, removed, start, claims, heights)
    path = Path(start.configuration(tau), equations.bits)
    steps = walked(equations, path, tubes, leaves=not (ends or back))
    if through or any(map(is_node, tubes)):
        _check_passed(claims, [entry["flat"] for entry in tubes if is_node(entry)])
    if bent and equations.drive is not None:
        check_reached(equations, equations.drive, path.here)
    if ends:
        steps.append(_to_the_node(equations, path, claims["node"], evidence["node"]))
    length = path.length
    if back:
        keys(claims["return"], "vertex_signs side", "return")
        end, side = land(equations, path, evidence["landing"])
        length = path.land()
        _check_names(given, removed, end, claims["return"], heights, side)
    claimed = parse_rational(claims["length"])
    require(claimed <= length * equations.unit, "the motion is shorter than claimed")
    if more:
        check_contacts(start, tau, steps, claims, evidence["contacts"])
    if ends and claims["node"]["clear"]:
        given_end = (evidence["contacts"]["tube"], evidence["contacts"]["clear"]) if more else None
        shown_to_be = given_end == (len(tubes) + 1, 0)
        require(shown_to_be, "the motion is not shown to be clear up to its node")
    above = {"pinned": equations.pinned} if heights else {}
    passed = len(tubes) - sum(map(is_node, tubes))
    return {"sha256": digest, "tubes": passed, **above, **claims}


def _to_the_node(equations: LengthEquations, path: Path, claim: Any, entry: Any) -> Arc:
    """The arc on which a motion comes to a node, and where it meets the tube before."""
    keys(claim, "flat clear", "node")
    require(type(claim["clear"]) is bool, "clear is not true or false")
    keys(entry, "node centre row reach entry", "node")
    arc = arc_of(equations, claim["flat"], entry)
    begin, end = parameter_of(entry["entry"]), Fraction(0)
    path.meet(*arc.configuration(begin))
    # Only after another node or with a rim can it be otherwise: docs/motion.md, Theorem 6.
    require(begin < end, "an arc does not lead to its node")
    path.go(*arc.configuration(end))
    return Arc(arc, begin, end)


def _check_passed(claims: Any, passed: list[Any]) -> None:
    """The nodes that are passed are those claimed."""
    require(passed and "through" in claims, "a motion passes nodes that it does not claim, or none")
    claimed = [
        [natural(v, "flat vertex") for v in items(flat, "flat")]
        for flat in items(claims["through"], "through")
    ]
    require(claimed == passed, "the nodes that are passed are others")


def walked(equations: LengthEquations, path: Path, entries: list[Any], leaves: bool) -> list[Step]:
    """Follow the steps of a motion: tubes, and arcs through nodes.

    A tube is left at its exit unless an arc follows; at the end the last one is if `leaves`.
    """
    steps: list[Step] = []
    for entry, after in zip_longest(entries, entries[1:]):
        if is_node(entry):
            steps.append(through_a_node(equations, path, entry))
            continue
        onwards = leaves if after is None else not is_node(after)
        keys(entry, "centre row reach exit" if onwards else "centre row reach", "tube")
        tube, here, end = tube_of(equations, entry), path.here, None
        path.enter(tube)
        if onwards:
            end = parameter_of(entry["exit"])
            path.leave(end)
        steps.append(Link(tube, here, end))
    return steps


def through_a_node(equations: LengthEquations, path: Path, entry: Any) -> Arc:
    """An arc through a node, from before it until after it."""
    keys(entry, "flat node centre row reach entry exit", "node")
    arc = arc_of(equations, entry["flat"], entry)
    begin, end = parameter_of(entry["entry"]), parameter_of(entry["exit"])
    require(begin < 0 < end, "an arc does not go through its node")
    path.meet(*arc.configuration(begin))
    path.go(*arc.configuration(Fraction(0)))
    path.go(*arc.configuration(end))
    return Arc(arc, begin, end)


def is_node(step: Any) -> bool:
    """Whether a step is an arc through a node, not a tube."""
    return isinstance(step, dict) and "flat" in step


def framework(
    given: Sheet, evidence: Any, rim: Rim | None = None, driven: Sequence[Any] = ()
) -> tuple[LengthEquations, set[int]]:
    """The equations of what can fold, and the vertices that were removed.

    `driven`: the claim of what is driven, if there is one.
    """
    sheet, removed = emptied_sheet(given, dict(given.points), evidence["emptied"])
    four = len(sheet.boundary) == 4
    drive = next((Drive(sheet, claim) for claim in driven), None)
    require(four or rim or drive, "there are not four boundary vertices")
    require(sheet.interior, "nothing can fold")
    bits = natural(evidence["bits"], "bits")
    require(bits <= MOTION_BITS, "bits are out of range")
    pinned = [natural(v, "pinned vertex") for v in items(evidence["pinned"], "pinned", 3)]
    return LengthEquations(sheet, pinned, bits, rim, drive), removed


def check_steps(equations: LengthEquations, entries: list[Any], more: int = 0) -> None:
    """Raise if so many tubes and nodes, and `more` nodes, are too much work."""
    nodes = sum(map(is_node, entries))
    tubes = len(entries) - nodes + NODE_WORK * (nodes + more)
    require(tubes <= MOST_TUBES, "there are too many tubes")
    size, digits = equations.size, 1 + (equations.bits + equations.more) // 256
    work = (tubes + 1) * size**2 * (size + 200) * digits
    require(work <= MOST_WORK, "the work is out of range")


def _check_names(
    given: Sheet, removed: set[int], start: Start, claims: Any, rim: Rim | None = None, way: int = 1
) -> None:
    """The vertex signs and the side of the heights at the flat state are those claimed.

    For a `way` of -1 those of the mirror image.
    """
    signs, side = names(given, removed, start, rim)
    values = items(claims["vertex_signs"], "vertex_signs", len(given.interior))
    for v, value, expected in zip(given.interior, values, signs, strict=True):
        require(type(value) is int and value == way * expected, f"vertex {v} has another sign")
    right = type(claims["side"]) is int and claims["side"] == way * side
    require(right, "the side is another")


def summary(claims: dict[str, Any]) -> str:
    """One line for verified claims."""
    signs = "".join("-0+"[s + 1] for s in claims["vertex_signs"])
    side = "+" if claims["side"] > 0 else "-"
    tubes = counted(claims["tubes"], "tube", "tubes")
    return (
        f"VALID: the motion along the half-branch {shortened(signs)} ({len(signs)}), side {side}, "
        f"is one curve without a gap of length {shown(claims['length'])} or more{_nodes(claims)}"
        f"{border_of(claims)}{driven_of(claims)}{said(claims)}; {tubes}; "
        f"sha256 {claims['sha256']}"
    )


def _nodes(claims: dict[str, Any]) -> str:
    """Which nodes a motion passes, and whether it is claimed to end at one, or to come back."""
    text = "".join(f", through a node where {_flat(flat)}" for flat in claims.get("through", []))
    if "node" in claims:
        text += f", to a node where {_flat(claims['node']['flat'])}"
    if "return" in claims:
        signs = "".join("-0+"[s + 1] for s in claims["return"]["vertex_signs"])
        side = "+" if claims["return"]["side"] > 0 else "-"
        text += f", and back to the flat state along {shortened(signs)}, side {side}"
    return text


def shortened(signs: str) -> str:
    """Signs, cut where there are many."""
    return signs if len(signs) <= 60 else signs[:60] + "..."


def _flat(flat: list[int]) -> str:
    """That vertices are flat."""
    several = len(flat) > 1
    names = " and ".join(map(str, flat))
    return f"{'vertices' if several else 'vertex'} {names} {'are' if several else 'is'} flat"


MOTION = DocumentKind(
    format="exactfold motion",
    versions=(1,),
    names="format version pattern claims evidence",
    check=check,
    summary=summary,
)
"""The motion along a half-branch, as a chain of tubes (docs/motion.md)."""
