"""Certificates of loops, line by line: motions from the flat state back to it (docs/motion.md, 15).

Why it is a proof: a loop leaves the flat state like any motion along a branch. It passes from tube
to tube, and through branch points on arcs that are analytic there (`branch_points`). A point of the
start tube of another ray lies on the last tube, and the two go in opposite directions there. So the
loop ends in the flat state along this other ray. Only one curve begins along each ray. So the loops
match rays in pairs, and the matching is complete if all 2^(n + 1) rays occur in it.

The first line has the sheet. Each loop has the rays `from` and `to` at its ends, a lower bound of
its `length`, and the evidence: `start`, `steps`, which are tubes or branch points, and `landing`. A
branch point has its vertices `flat`, its displacements, nearly (`node`), the `centre`, `row` and
`reach` of the arc, and the parameters `entry` below 0 and `exit` above 0. The last line claims how
many `loops` there are, how many rays they match (`matched`) of how many (`half_branches`), and
whether the matching is `complete`.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing
from typing import Any, TypedDict

from ..core.kinds import LineKind
from ..core.lines import read_object
from ..core.parts import Engine, here, on_processes
from ..core.reading import (
    CertificateError,
    FormatError,
    UnfinishedError,
    counted,
    integer,
    items,
    keys,
    keys_of,
    parse_rational,
    refusing,
    require,
)
from ..sheets.reduced import emptied_sheet
from ..sheets.sheet import read_sheet
from .chain import Chain, check_work, equations_of
from .pieces import MakeTube
from .ray import land, names
from .tubes import Start, Tube

Ray = tuple[tuple[int, ...], int]
"""A ray: the signs of the interior vertices, 0 if a vertex cannot fold, and the side."""


class LoopSheet:
    """The verified sheet of a file, and the check of its loops."""

    def __init__(self, header: dict[str, Any]) -> None:
        self.given, self.sha256 = read_sheet(header["pattern"])
        points = dict(self.given.points)
        sheet, self.removed = emptied_sheet(self.given, points, header["emptied"])
        self.equations = equations_of(sheet, header["pinned"], header["bits"])

    @property
    def rays(self) -> int:
        """The number of rays of the sheet."""
        return 2 << len(self.equations.sheet.interior)

    def ray(self, entry: Any) -> Ray:
        """Read a ray."""
        keys(entry, "vertex_signs side", "ray")
        signs = items(entry["vertex_signs"], "vertex_signs", len(self.given.interior))
        return tuple(map(integer, signs)), integer(entry["side"])

    def check_loop(self, entry: dict[str, Any], make: MakeTube = Tube) -> None:
        """Raise unless the evidence of a loop proves its claims; its keys are verified already.

        The claims are: one analytic curve of configurations begins in the flat state along the ray
        `from`, and ends in the flat state along the ray `to`. All its configurations are regular
        except the branch points that it passes. Its length is at least `length`, as for motions.
        `make` proves tubes.
        """
        evidence = entry["evidence"]
        keys(evidence, "start steps landing", "evidence")
        steps = items(evidence["steps"], "steps")
        check_work(self.equations, steps)
        chain = Chain(self.given, self.removed, self.equations, evidence["start"], make)
        require(
            self._named(chain.start) == self.ray(entry["from"]),
            'it does not begin along the ray "from"',
        )
        chain.walk(steps, leaves=False)
        end, side = land(chain, evidence["landing"])
        signs, saddle = self._named(end)
        target = tuple(side * s for s in signs), side * saddle
        require(target == self.ray(entry["to"]), 'it does not end along the ray "to"')
        claimed = parse_rational(entry["length"])
        require(claimed <= chain.path.length * self.equations.unit, "it is shorter than claimed")

    def _named(self, start: Start) -> Ray:
        signs, side = names(self.given, self.removed, start)
        return tuple(signs), side


# --- files ---------------------------------------------------------------------------------------


class LoopVerifier:
    """The verifier of the loops of one file."""

    def __init__(self, header: str) -> None:
        self.sheet = LoopSheet(LOOPS.header(header))

    def refusal(self, text: str, number: int) -> str | None:
        """Verify one loop; say why it does not hold, or None if it holds."""
        try:
            with refusing():
                self.sheet.check_loop(read_object(text, "a loop"))
        except CertificateError as error:
            return f"loop {number}: {error}"
        return None


class Matching:
    """The rays that loops match: the two ends of each loop, and those of its mirror image."""

    def __init__(self) -> None:
        self.loops, self.matched = 0, set[Ray]()

    def add(self, source: Ray, target: Ray) -> None:
        """Add a loop; raises if it matches a ray with itself, or a ray that is matched already."""
        require(source != target, f"loop {self.loops}: a ray is matched with itself")
        ends = {source, target}
        ends |= {(tuple(-s for s in signs), -side) for signs, side in ends}
        new = self.matched.isdisjoint(ends)
        require(new, f"loop {self.loops}: a ray is matched twice")
        self.loops += 1
        self.matched |= ends


class LoopsClaims(TypedDict):
    """The numbers of loops, of the rays that they match, and of all rays."""

    sha256: str
    loops: int
    matched: int
    half_branches: int
    complete: bool


BY_TUBES = Engine(LoopVerifier, 1, on_processes)
"""The engine that follows loops from tube to tube."""


def check_lines(texts: Iterator[str], workers: int = 1, engine: Engine = BY_TUBES) -> LoopsClaims:
    """Verify every claim, given the lines of a file; returns the claims.

    If `workers` is more than 1, that many processes share the loops. The claims are: the file has
    `loops` loops, each as `LoopSheet.check_loop` says. They match `matched` of the `half_branches`
    rays, none twice and none with itself. `complete` says whether these are all rays.
    """
    first = next(texts, None)
    if first is None:
        raise FormatError("the file is empty")
    header = LOOPS.header(first)
    with refusing("in the first line"):
        sheet = LoopSheet(header)
    matching, last, late = Matching(), list[Any](), list[Exception]()

    def loops() -> Iterator[tuple[str, int]]:
        try:
            for text in texts:
                entry = read_object(text, "a line")
                require(not last, "a line follows the claims")
                if "claims" in entry:
                    keys(entry, "claims", "the last line")
                    last.append(entry["claims"])
                    continue
                keys(entry, "from to length evidence provenance", "loop")
                ends = (sheet.ray(entry[key]) for key in ("from", "to"))
                matching.add(*ends)
                yield text, matching.loops - 1
        except (CertificateError, FormatError) as error:
            late.append(error)

    if workers > 1:
        said = engine.share(engine, workers, first, loops())
    else:
        said = here(engine, first, loops())
    with closing(said):
        for reason in said:
            if reason is not None:
                raise CertificateError(reason)
    if late:  # a loop that does not hold has already been refused above
        raise late[0]
    if not last:
        number = counted(matching.loops, "loop holds", "loops hold")
        raise UnfinishedError(f"{number}, but the claims are missing")
    facts: LoopsClaims = {
        "sha256": sheet.sha256,
        "loops": matching.loops,
        "matched": len(matching.matched),
        "half_branches": sheet.rays,
        "complete": len(matching.matched) == sheet.rays,
    }
    (claims,) = last
    keys(claims, keys_of(LoopsClaims), "claims")
    for key, fact in facts.items():
        claim = claims[key]
        right = type(claim) is type(fact) and claim == fact
        require(right, f"claim {key} = {claim!a}, but it is {fact!a}")
    return facts


def summary(claims: LoopsClaims) -> str:
    """One line that states the verified claims."""
    loops = counted(claims["loops"], "loop", "loops")
    matched, all_of_them = claims["matched"], claims["half_branches"]
    how = f"all {all_of_them}" if claims["complete"] else f"{matched} of {all_of_them}"
    digest = claims["sha256"]
    return f"VALID: {loops} of true motions, which match {how} rays; sha256 {digest}"


LOOPS = LineKind(
    format="exactfold loops",
    versions=(1,),
    names="format version pattern emptied pinned bits",
    claims=LoopsClaims,
    check=check_lines,
    summary=summary,
    engine=BY_TUBES,
)
"""The loops of true motions through the flat state, line by line (docs/motion.md, 15)."""
