"""The first contact of a motion: until when no faces touch, and by when some do.

See docs/motion.md, 16 and 17.

Two faces without a common vertex do not touch if a plane parts them. Two faces with one common
vertex touch only there if a plane through this vertex parts them. Two faces at a fold touch only
there unless the fold is closed. Near the flat state the same is shown for the projections to the
plane of the held face.

The claims are `clear`, a time before which no two faces touch, and `contact`, with its `kind`,
bounds of its `time`, the `faces`, and the `folds` that close. The evidence names the `tube`,
numbered from 1 on with arcs through branch points included, and the parameter `clear` in it up to
which the faces are separated. With a contact it also has `from` and `to`: the edge runs through the
face at `to`, or the fold closes between them.
"""

from __future__ import annotations

from fractions import Fraction
from math import ceil, floor
from typing import Any, TypedDict

from ..core.limits import MOST_TESTS
from ..core.reading import integer, items, keys, natural, parse_rational, require, shown
from ..sheets.sheet import Edge
from .boxes import flat_of, nearer, volume_sign
from .chain import Chain
from .claims import BranchClaim, Document
from .equations import LengthEquations
from .faces import FacePairs, Hinge
from .lengths import GRID, Path, Step, stretches_of
from .tubes import Start

_KINDS = "contact", "flat-fold"
_PARAMETER_BITS = 40


class TouchingFaces(TypedDict):
    """A contact of two faces, or of the faces at folds that are closed.

    `time` has a lower and an upper bound of when it happens.
    """

    kind: str
    time: list[str]
    faces: list[list[int]]
    folds: list[list[int]]


class Contacts(BranchClaim):
    """Before the length `clear` of the motion no two faces touch beyond what they share.

    If there is a `contact`, some faces touch between two lengths, the first of which is `clear`.
    """

    names = ("clear", "contact")
    needs = ("contacts",)

    @classmethod
    def keys_in(cls, claims: Document) -> tuple[str, ...]:
        """A file that claims a contact also claims until when the motion is clear."""
        return cls.names if "contact" in claims else cls.names[:1] if "clear" in claims else ()

    def check(self, chain: Chain) -> None:
        """Test the stretches of the pieces that the motion passes."""
        check_contacts(chain.start, chain.tau, chain.steps, self.claims, self.evidence["contacts"])

    @staticmethod
    def said(claims: Document) -> str:
        """Until when no faces touch, and by when some do."""
        text = f"; no two faces touch before {shown(claims['clear'])}"
        if "node" in claims and claims["node"]["clear"]:
            clear = shown(claims["clear"])
            text = (
                f"; no two faces touch before the branch point, which is at {clear} or "
                "later, nor at it"
            )
        if "contact" not in claims:
            return text
        contact = claims["contact"]
        last = shown(contact["time"][1], up=True)
        if contact["kind"] == "contact":
            return f"{text}, {' and '.join(str(tuple(f)) for f in contact['faces'])} do by {last}"
        return f"{text}, the fold {tuple(contact['folds'][0])} is closed by {last}"


class Faces(FacePairs):
    """The pairs of faces of a triangulated sheet, and the test whether a fold closes."""

    def __init__(self, equations: LengthEquations) -> None:
        sheet = equations.sheet
        faces = sorted(sheet.face(t) for t in sheet.triangles)
        folds: dict[Edge, Hinge] = {}
        self.means: dict[Edge, int] = {}
        for i, j in sheet.folds:
            left, right = sheet.next[i][j], sheet.next[j][i]
            closed, flat = folded_over(equations, (i, j), left, right)
            unit = Fraction(1 << 2 * GRID)
            folds[i, j] = left, right, ceil(closed * unit)
            self.means[i, j] = floor((closed + flat) / 2 * unit)
        bodies, places = range(len(faces)), flat_of(equations)
        super().__init__(faces, faces, bodies, folds, places, equations.place, MOST_TESTS)

    def closes(self, path: Path, first: Fraction, last: Fraction, fold: Edge) -> bool:
        """Whether a fold is proved to be closed at some moment between two parameters.

        It is a valley at one of them and a mountain at the other, so that its two faces lie in one
        plane at some moment between. All along the two opposite corners are nearer to each other
        than at a fold of 90 degrees, so that the fold is closed at this moment, not flat.
        """
        left, right, _ = self.folds[fold]
        signs = [volume_sign(self.at(path, s, s), *fold, left, right) for s in (first, last)]
        return signs[0] * signs[1] == -1 and nearer(
            self.at(path, first, last), left, right, self.means[fold]
        )


def folded_over(
    equations: LengthEquations, fold: Edge, left: int, right: int
) -> tuple[Fraction, Fraction]:
    """The squared distances, over unit^2, of the corners opposite to a fold, if closed and if flat.

    Along the fold the corners keep their places. Across it their distances from the fold are
    subtracted if it is closed, and added if it is flat.
    """
    (ix, iy), (jx, jy), (lx, ly), (rx, ry) = (
        equations.sheet.points[v] for v in (*fold, left, right)
    )
    ex, ey = jx - ix, jy - iy
    square = (ex * ex + ey * ey) * equations.unit**2
    along = (lx - rx) * ex + (ly - ry) * ey
    one, two = ex * (ly - iy) - ey * (lx - ix), ey * (rx - ix) - ex * (ry - iy)
    return (along**2 + (one - two) ** 2) / square, (along**2 + (one + two) ** 2) / square


def check_contacts(
    start: Start,
    tau: Fraction,
    steps: list[Step],
    claims: Any,
    given: Any,
) -> None:
    """Raise unless the claim `clear` holds, and the claim `contact` if there is one.

    `given` names a step by its number, from 1 on. In this step the clear part of the motion ends at
    the parameter `clear`. A contact is proved at the parameter `to`, or a fold closes between
    `from` and `to`. If the motion ends at a branch point, the arc to it is the step after the last
    tube.
    """
    keys(given, "tube clear from to" if "contact" in claims else "tube clear", "contacts")
    number = natural(given["tube"], "tube")
    require(1 <= number <= len(steps), "the contacts name a tube that does not exist")
    stretches = stretches_of(start, tau, steps[:number])
    last = stretches[-1]

    def parameter(key: str, least: Fraction) -> Fraction:
        value = Fraction(integer(given[key]), 1 << _PARAMETER_BITS)
        require(least <= value <= last.most, f'the parameter "{key}" is out of range')
        return value

    lengths = [stretch.length() for stretch in stretches[:-1]]
    last.end_at(parameter("clear", last.least))
    clear, unit = parse_rational(claims["clear"]), start.equations.unit
    shortest = sum((low for low, _ in lengths), last.length()[0])
    require(clear <= shortest * unit, "the clear part of the motion is shorter than claimed")
    faces = Faces(start.equations)
    if "contact" in claims:
        keys(claims["contact"], "kind time faces folds", "contact")
        first, latest = map(parse_rational, items(claims["contact"]["time"], "time", 2))
        require(first == clear, 'the first "time" of a contact differs from "clear"')
        begin = parameter("from", last.high)
        end = parameter("to", begin)
        longest = last.path.longest(last.path.below(last.low), last.path.above(end))
        longest += sum((high for _, high in lengths), Fraction(0))
        require(longest * unit <= latest, "the contact may be later than claimed")
        _check_contact(faces, last.path, begin, end, claims["contact"])
    for k, stretch in enumerate(stretches):
        path = stretch.path
        faces.clear(path, path.below(stretch.low), path.above(stretch.last), planar=k == 0)


def _check_contact(faces: Faces, path: Path, begin: Fraction, end: Fraction, claim: Any) -> None:
    """Raise unless the claimed faces touch by the parameter `end`."""
    require(claim["kind"] in _KINDS, "the contact is of no known kind")
    pair = [
        tuple(natural(v, "corner") for v in items(face, "face", 3))
        for face in items(claim["faces"], "faces", 2)
    ]
    known = {frozenset(face) for face in faces.faces}
    there = known.issuperset(map(frozenset, pair))
    require(there, "a face of the contact is not a face of the sheet")
    folds = [
        tuple(natural(v, "vertex") for v in items(fold, "fold", 2))
        for fold in items(claim["folds"], "folds")
    ]
    one, two = pair
    if claim["kind"] == "contact":
        require(not folds, "a contact of two faces names folds")
        through = faces.crossing(path, end, one, two)
        require(through, "no side of one face is proved to run through the other face")
        return
    known_fold = len(folds) == 1 and folds[0] in faces.folds
    require(known_fold, "the contact does not name one fold of the sheet that closes")
    [(i, j)] = folds
    left, right = faces.folds[i, j][:2]
    beside = [set(one), set(two)] == [{i, j, left}, {i, j, right}]
    require(beside, "the faces of the contact are not those at its fold")
    closes = faces.closes(path, begin, end, (i, j))
    require(closes, "the fold of the contact is not proved to close")
