"""Certificates of motions: a branch followed from the flat state, without a gap (docs/motion.md).

Why it is a proof: the first piece is a curve of zeros of the equations in blown-up coordinates,
which at the flat state solve the second-order equations with the vertex signs claimed: it belongs
to the one branch with these signs (docs/theorem.md, 3 and 4). Every tube holds one curve of
configurations; where it begins, the one before ends on it and goes the same way. A motion may end
at a node: its last piece is an arc through it, a point of which lies on the last tube.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

from .formats import MOST_TUBES, MOST_WORK, MOTION, MOTION_BITS, MOTION_VERSION, NODE_WORK
from .motion_contacts import check_contacts, said
from .motion_equations import SPARE, LengthEquations
from .motion_nodes import NodeTube
from .motion_patches import Patch
from .motion_paths import Path
from .motion_rim import Rim
from .motion_stretches import Arc, Link
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
from .reduced import closed, emptied_sheet
from .sheet import Sheet, read_sheet, turn

REACH_BITS = 6
PARAMETER_BITS = 40
ROOT_BITS = 20
_MOST_HEIGHTS = 8  # of a border in a summary


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
    `side` is the sign of the factor near the flat state.
    With `clear`, no two faces touch beyond what they share before this length of the motion; with
    `contact`, some do between two lengths (docs/contacts.md). With `node` the motion ends at a
    configuration in which the stars of the vertices `flat` are flat; all before it are regular. If
    `clear` is true there, no two faces touch up to it, nor in it.
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
    rim = ["rim"] if "rim" in claims else []
    keys(claims, " ".join(["vertex_signs side length", *more, *ends, *rim]), "claims")
    found = ["contacts"] if more else []
    keys(evidence, " ".join(["emptied pinned bits start tubes", *found, *ends]), "evidence")
    heights = Rim(given, claims["rim"]) if rim else None
    equations, removed = framework(given, evidence, heights)
    tubes = items(evidence["tubes"], "tubes")
    check_work(equations, len(tubes) + NODE_WORK * len(ends))
    start, tau = first_piece(equations, evidence["start"])
    _check_names(given, removed, start, claims, heights)
    path = Path(start.configuration(tau), equations.bits)
    links: list[Link] = []
    for k, entry in enumerate(tubes):
        onwards = k + 1 < len(tubes) or not ends
        keys(entry, "centre row reach exit" if onwards else "centre row reach", "tube")
        tube, ball, end = tube_of(equations, entry), path.here, None
        path.enter(tube)
        if onwards:
            end = Fraction(natural(entry["exit"], "exit"), 1 << PARAMETER_BITS)
            path.leave(end)
        links.append((tube, ball, end))
    arc = _to_the_node(equations, path, claims["node"], evidence["node"]) if ends else None
    claimed = parse_rational(claims["length"])
    require(claimed <= path.length * equations.unit, "the motion is shorter than claimed")
    if more:
        check_contacts(start, tau, links, claims, evidence["contacts"], arc)
    if ends and claims["node"]["clear"]:
        given_end = (evidence["contacts"]["tube"], evidence["contacts"]["clear"]) if more else None
        shown_to_be = given_end == (len(tubes) + 1, 0)
        require(shown_to_be, "the motion is not shown to be clear up to its node")
    above = {"pinned": equations.pinned} if rim else {}
    return {"sha256": digest, "tubes": len(tubes), **above, **claims}


def _to_the_node(equations: LengthEquations, path: Path, claim: Any, entry: Any) -> Arc:
    """The arc on which a motion comes to a node, and where it meets the tube before."""
    keys(claim, "flat clear", "node")
    require(type(claim["clear"]) is bool, "clear is not true or false")
    keys(entry, "node centre row reach entry", "node")
    arc = arc_of(equations, claim["flat"], entry)
    # Without a rim that it is negative need not be asked for: docs/motion.md, Theorem 6.
    begin = Fraction(integer(entry["entry"]), 1 << PARAMETER_BITS)
    before = begin < 0 or not equations.ties
    require(before, "a motion with a rim meets the arc of its node beyond it")
    path.meet(*arc.configuration(begin))
    path.go(*arc.configuration(Fraction(0)))
    return arc, begin


def framework(
    given: Sheet, evidence: Any, rim: Rim | None = None
) -> tuple[LengthEquations, set[int]]:
    """The equations of what can fold, and the vertices that were removed."""
    sheet, removed = emptied_sheet(given, dict(given.points), evidence["emptied"])
    four = len(sheet.boundary) == 4
    require(four or rim is not None, "there are not four boundary vertices")
    require(sheet.interior, "nothing can fold")
    bits = natural(evidence["bits"], "bits")
    require(bits <= MOTION_BITS, "bits are out of range")
    pinned = [natural(v, "pinned vertex") for v in items(evidence["pinned"], "pinned", 3)]
    return LengthEquations(sheet, pinned, bits, rim), removed


def check_work(equations: LengthEquations, tubes: int) -> None:
    """Raise if so many tubes are too much work."""
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


def names(
    given: Sheet, removed: set[int], start: Start, rim: Rim | None = None
) -> tuple[list[int], int]:
    """The vertex signs, 0 for vertices that were removed, and the side of a half-branch.

    With a rim the side is the sign of its factor. They are those of the heights at the flat state.
    """
    box, place = start.enclosure(Fraction(0)), start.equations.place

    def sign(functional: Mapping[int, Fraction]) -> int:
        """The sign of a functional of the heights, 0 if it is not certain."""
        terms = [(c, place[v] + 2) for v, c in functional.items() if v in place]
        middle = sum((c * box.centre[k] for c, k in terms), Fraction(0))
        spread = sum((abs(c) * box.radii[k] for c, k in terms), Fraction(0))
        return 0 if abs(middle) <= spread else 1 if middle > 0 else -1

    sheet = start.equations.sheet
    signs = [0 if v in removed else sign(sheet.sign_of_vertex(v)) for v in given.interior]
    for v, found in zip(given.interior, signs, strict=True):
        require(found or v in removed, f"vertex {v} may be flat")
    if rim is not None:
        side = sign(rim.factor)
    else:
        whole, corner = closed(sheet)
        side = sign(saddle_of(sheet) if corner is None else whole.sign_of_vertex(corner))
    require(side, "the side of the branch is not certain")
    return signs, side


def saddle_of(sheet: Sheet) -> dict[int, Fraction]:
    """The functional of the boundary heights that vanishes on planes, as docs/conventions.md."""
    p, q, r, s = (sheet.points[v] for v in sheet.boundary)
    weights = (turn(q, r, s), -turn(p, r, s), turn(p, q, s), -turn(p, q, r))
    first = next(w for w in weights if w)
    return {v: w / first for v, w in zip(sheet.boundary, weights, strict=True)}


def summary(claims: dict[str, Any]) -> str:
    """One line for verified claims."""
    signs = "".join("-0+"[s + 1] for s in claims["vertex_signs"])
    letters = signs if len(signs) <= 60 else signs[:60] + "..."
    side = "+" if claims["side"] > 0 else "-"
    tubes = counted(claims["tubes"], "tube", "tubes")
    return (
        f"VALID: the motion along the half-branch {letters} ({len(signs)}), side {side}, is one "
        f"curve without a gap of length {shown(claims['length'])} or more{_end(claims)}"
        f"{_border(claims)}{said(claims)}; {tubes}; "
        f"sha256 {claims['sha256']}"
    )


def _border(claims: dict[str, Any]) -> str:
    """The heights that the border has on a rim path."""
    if "rim" not in claims:
        return ""
    heights = claims["rim"]
    more = ", ..." if len(heights) > _MOST_HEIGHTS else ""
    face = "-".join(map(str, claims["pinned"]))
    ratio = ", ".join(heights[:_MOST_HEIGHTS]) + more
    return f", with the border in the ratio of {ratio} above the face {face}"


def _end(claims: dict[str, Any]) -> str:
    """Where a motion ends, if it is claimed to be at a node."""
    if "node" not in claims:
        return ""
    flat = claims["node"]["flat"]
    several = len(flat) > 1
    names = " and ".join(map(str, flat))
    return f", to a node where {'vertices' if several else 'vertex'} {names} " + (
        "are flat" if several else "is flat"
    )
