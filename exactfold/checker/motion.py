"""Certificates of motions: a branch followed from the flat state, without a gap (docs/motion.md).

Why it is a proof: the first piece is a curve of zeros of the equations in blown-up coordinates,
which at the flat state solve the second-order equations with the vertex signs claimed: it belongs
to the one branch with these signs (docs/theorem.md, 3 and 4). Every tube holds one curve of
configurations; where it begins, the one before ends on it and goes the same way. A motion may end
at a node: its last piece is an arc through it, a point of which lies on the last tube.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import zip_longest
from typing import Any

from .formats import MOST_TUBES, MOST_WORK, MOTION, MOTION_BITS, MOTION_VERSION, NODE_WORK
from .motion_contacts import check_contacts, said
from .motion_drive import Drive, driven_of
from .motion_equations import SPARE, LengthEquations
from .motion_names import names
from .motion_nodes import NodeTube
from .motion_patches import Patch
from .motion_paths import Path
from .motion_reached import check_reached
from .motion_rim import Rim, border_of
from .motion_stretches import Arc, Link, Step
from .motion_tubes import Start, Tube
from .reading import (
    MALFORMED,
    CertificateError,
    counted,
    document,
    integer,
    items,
    keys,
    natural,
    parse_rational,
    require,
    shown,
)
from .reduced import emptied_sheet
from .sheet import Sheet, read_sheet

REACH_BITS = 6
PARAMETER_BITS = 40
ROOT_BITS = 20


def read(data: Any) -> dict[str, Any]:
    """`data` if it is a certificate of a motion; raises `FormatError`."""
    return document(data, MOTION, MOTION_VERSION, "format version pattern claims evidence")


def check(data: dict[str, Any]) -> dict[str, Any]:
    """Verify every claim of a loaded certificate; raises `CertificateError` at the first failure.

    Returns the claims and the SHA-256 of the pattern. The claims are: the half-branch with these
    vertex signs and this side, 1 or -1, is that of one simple branch, and from the flat state on it
    is followed by one analytic curve of configurations, all regular, which is at least `length`
    long in the space of the vertices (unit of the sheet, one triangle held). `side` is the sign of
    the boundary saddle or, with a reflex corner, of this corner in the sheet with its notch closed.
    With `rim`, heights of the boundary vertices of a convex border in order, these stay on the
    curve in the ratio of the rim (`Rim`), above the face `pinned` that is held, which is returned;
    `side` is the sign of the factor near the flat state. With `drive`, instead, the curve leaves
    the flat state along a simple solution with these signs, on which its folds are valleys or
    mountains by the signs of the `squares` q, and all along sin(a / 2)^2 of their angles a is in
    the ratio of |q|; then `side` is 1. If it is `reached`, these are |q| themselves at one of them.
    With `clear`, no two faces touch beyond what they share before this length of the motion; with
    `contact`, some do between two lengths (docs/contacts.md). With `node` the motion ends at a
    configuration in which the stars of the vertices `flat` are flat; all before it are regular. If
    `clear` is true there, no two faces touch up to it, nor in it. With `through` the curve goes
    through such configurations, where the vertices listed are flat, in this order; it is regular
    but for them.
    """
    try:
        return _check(data)
    except MALFORMED as error:
        raise CertificateError(f"malformed: {type(error).__name__} while checking") from error


def _check(data: dict[str, Any]) -> dict[str, Any]:
    given, digest = read_sheet(data["pattern"])
    claims, evidence = data["claims"], data["evidence"]
    more = ["clear"] if "clear" in claims else []
    more = ["clear", "contact"] if "contact" in claims else more
    ends = ["node"] if "node" in claims else []
    through = ["through"] if "through" in claims else []
    rim = ["rim"] if "rim" in claims else ["drive"] if "drive" in claims else []
    keys(claims, " ".join(["vertex_signs side length", *more, *ends, *through, *rim]), "claims")
    found = ["contacts"] if more else []
    keys(evidence, " ".join(["emptied pinned bits start tubes", *found, *ends]), "evidence")
    heights = Rim(given, claims["rim"]) if "rim" in claims else None
    equations, removed = framework(given, evidence, heights, claims.get("drive"))
    tubes = items(evidence["tubes"], "tubes")
    check_steps(equations, tubes, len(ends))
    start, tau = first_piece(equations, evidence["start"])
    _check_names(given, removed, start, claims, heights)
    path = Path(start.configuration(tau), equations.bits)
    steps = walked(equations, path, tubes, leaves=not ends)
    if through or any(map(is_node, tubes)):
        _check_passed(claims, [entry["flat"] for entry in tubes if is_node(entry)])
    if equations.drive is not None and equations.drive.reached:
        check_reached(equations, equations.drive, path.here)
    if ends:
        steps.append(_to_the_node(equations, path, claims["node"], evidence["node"]))
    claimed = parse_rational(claims["length"])
    require(claimed <= path.length * equations.unit, "the motion is shorter than claimed")
    if more:
        check_contacts(start, tau, steps, claims, evidence["contacts"])
    if ends and claims["node"]["clear"]:
        given_end = (evidence["contacts"]["tube"], evidence["contacts"]["clear"]) if more else None
        shown_to_be = given_end == (len(tubes) + 1, 0)
        require(shown_to_be, "the motion is not shown to be clear up to its node")
    above = {"pinned": equations.pinned} if heights else {}
    return {"sha256": digest, "tubes": len(tubes), **above, **claims}


def _to_the_node(equations: LengthEquations, path: Path, claim: Any, entry: Any) -> Arc:
    """The arc on which a motion comes to a node, and where it meets the tube before."""
    keys(claim, "flat clear", "node")
    require(type(claim["clear"]) is bool, "clear is not true or false")
    keys(entry, "node centre row reach entry", "node")
    arc = arc_of(equations, claim["flat"], entry)
    begin, end = _parameter(entry["entry"]), Fraction(0)
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
            end = _parameter(entry["exit"])
            path.leave(end)
        steps.append(Link(tube, here, end))
    return steps


def through_a_node(equations: LengthEquations, path: Path, entry: Any) -> Arc:
    """An arc through a node, from before it until after it."""
    keys(entry, "flat node centre row reach entry exit", "node")
    arc = arc_of(equations, entry["flat"], entry)
    begin, end = _parameter(entry["entry"]), _parameter(entry["exit"])
    require(begin < 0 < end, "an arc does not go through its node")
    path.meet(*arc.configuration(begin))
    path.go(*arc.configuration(Fraction(0)))
    path.go(*arc.configuration(end))
    return Arc(arc, begin, end)


def is_node(step: Any) -> bool:
    """Whether a step is an arc through a node, not a tube."""
    return isinstance(step, dict) and "flat" in step


def _parameter(value: Any) -> Fraction:
    return Fraction(integer(value), 1 << PARAMETER_BITS)


def framework(
    given: Sheet, evidence: Any, rim: Rim | None = None, driven: Any = None
) -> tuple[LengthEquations, set[int]]:
    """The equations of what can fold, and the vertices that were removed."""
    sheet, removed = emptied_sheet(given, dict(given.points), evidence["emptied"])
    four = len(sheet.boundary) == 4
    drive = None if driven is None or four else Drive(sheet, driven)
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
    size, digits = equations.size, 1 + equations.bits // 256
    work = (tubes + 1) * size**2 * (size + 200) * digits
    require(work <= MOST_WORK, "the work is out of range")


def tube_of(equations: LengthEquations, entry: Any) -> Tube:
    """A tube of its keys."""
    size = equations.size
    return Tube(
        equations,
        vector(entry["centre"], "centre", size, equations.bits),
        vector(entry["row"], "row", size, 0),
        reach_of(entry["reach"]),
    )


def arc_of(equations: LengthEquations, flat: Any, entry: Any) -> NodeTube:
    """An arc through a node at which some vertices are flat, of its keys."""
    size, bits = equations.size, equations.bits
    require(equations.drive is None, "a driven motion has a node")
    patch = Patch(equations, [natural(v, "flat vertex") for v in items(flat, "flat")])
    return NodeTube(
        patch,
        patch.node(vector(entry["node"], "node", size, bits)),
        vector(entry["centre"], "centre", size, bits),
        vector(entry["row"], "row", size, 0),
        reach_of(entry["reach"]),
    )


def vector(value: Any, what: str, size: int, bits: int) -> list[int]:
    """Integers over 2^bits that are not too large."""
    found = [integer(x) for x in items(value, what, size)]
    small = all(abs(x) >> bits + SPARE == 0 for x in found)
    require(small, f"a number of the {what} is out of range")
    return found


def reach_of(value: Any) -> Fraction:
    """How far a piece reaches."""
    reach = Fraction(natural(value, "reach"), 1 << REACH_BITS)
    require(0 < reach <= 16, "the reach is out of range")
    return reach


def first_piece(equations: LengthEquations, entry: Any) -> tuple[Start, Fraction]:
    """The first piece, and where the motion leaves it."""
    keys(entry, "centre halvings held reach exit", "start")
    start = start_of(equations, entry)
    tau = Fraction(natural(entry["exit"], "exit"), 1 << ROOT_BITS)
    require(tau > 0, "the motion does not leave the flat state")
    return start, tau


def start_of(equations: LengthEquations, entry: Any) -> Start:
    """A start tube of its keys."""
    centre = vector(entry["centre"], "centre", equations.size, equations.bits)
    halvings = natural(entry["halvings"], "halvings")
    require(halvings <= MOTION_BITS, "halvings are out of range")
    held = natural(entry["held"], "held vertex")
    require(held in equations.place, "the vertex held at its height is pinned, or none")
    place = equations.place[held] + 2
    return Start(equations, centre, halvings, place, reach_of(entry["reach"]))


def _check_names(
    given: Sheet, removed: set[int], start: Start, claims: Any, rim: Rim | None = None
) -> None:
    """The vertex signs and the side of the heights at the flat state are those claimed."""
    signs, side = names(given, removed, start, rim)
    values = items(claims["vertex_signs"], "vertex_signs", len(given.interior))
    for v, value, expected in zip(given.interior, values, signs, strict=True):
        require(type(value) is int and value == expected, f"vertex {v} has another sign")
    require(type(claims["side"]) is int and claims["side"] == side, "the side is another")


def summary(claims: dict[str, Any]) -> str:
    """One line for verified claims."""
    signs = "".join("-0+"[s + 1] for s in claims["vertex_signs"])
    letters = signs if len(signs) <= 60 else signs[:60] + "..."
    side = "+" if claims["side"] > 0 else "-"
    tubes = counted(claims["tubes"], "tube", "tubes")
    return (
        f"VALID: the motion along the half-branch {letters} ({len(signs)}), side {side}, is one "
        f"curve without a gap of length {shown(claims['length'])} or more{_nodes(claims)}"
        f"{border_of(claims)}{driven_of(claims)}{said(claims)}; {tubes}; "
        f"sha256 {claims['sha256']}"
    )


def _nodes(claims: dict[str, Any]) -> str:
    """Which nodes a motion passes, and whether it is claimed to end at one."""
    text = "".join(f", through a node where {_flat(flat)}" for flat in claims.get("through", []))
    if "node" in claims:
        text += f", to a node where {_flat(claims['node']['flat'])}"
    return text


def _flat(flat: list[int]) -> str:
    """That vertices are flat."""
    several = len(flat) > 1
    names = " and ".join(map(str, flat))
    return f"{'vertices' if several else 'vertex'} {names} {'are' if several else 'is'} flat"
