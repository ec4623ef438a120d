"""The first contact of a motion: how long no faces touch, and by when some do (docs/contacts.md).

Two faces without a common vertex do not touch if a plane parts them; two with one common vertex
touch only there if a plane through it does; two at a fold touch only there unless it is closed.
Near the flat state the same is shown of the projections to the plane of the face that is held.
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
from .lengths import GRID, Path
from .stretches import Step, stretches_of
from .tubes import Start

_KINDS = "contact", "flat-fold"
_PARAMETER_BITS = 40


class TouchingFaces(TypedDict):
    """A contact between two bounds, of two faces or of the faces of folds that are closed."""

    kind: str
    time: list[str]
    faces: list[list[int]]
    folds: list[list[int]]


class Contacts(BranchClaim):
    """No two faces touch beyond what they share before the length `clear` of the motion.

    With `contact`, some do between two lengths, the first of which is that one.
    """

    names = ("clear", "contact")
    needs = ("contacts",)

    @classmethod
    def keys_in(cls, claims: Document) -> tuple[str, ...]:
        """A contact is claimed together with what is clear before."""
        return cls.names if "contact" in claims else cls.names[:1] if "clear" in claims else ()

    def check(self, chain: Chain) -> None:
        """On the stretches of the pieces that the motion passes."""
        check_contacts(chain.start, chain.tau, chain.steps, self.claims, self.evidence["contacts"])

    @staticmethod
    def said(claims: Document) -> str:
        """How long no faces touch, and by when some do."""
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
    """The pairs of faces of a triangulated sheet, and the test that a fold closes."""

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
        """Whether a fold is closed between two parameters.

        It is a valley at one of them and a mountain at the other; between, its two faces lie in
        one plane, and near each other: nearer than at 90 degrees.
        """
        left, right, _ = self.folds[fold]
        signs = [volume_sign(self.at(path, s, s), *fold, left, right) for s in (first, last)]
        return signs[0] * signs[1] == -1 and nearer(
            self.at(path, first, last), left, right, self.means[fold]
        )


def folded_over(
    equations: LengthEquations, fold: Edge, left: int, right: int
) -> tuple[Fraction, Fraction]:
    """The squared distance of two corners at a fold that is closed, and flat, over unit^2.

    Along the fold the corners keep their places; across it the distances are subtracted or added.
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
    """Refuse unless the claims `clear` and, if there is one, `contact` hold.

    `given`: the step, by its number from 1 on, in which what is clear ends at the parameter
    `clear`, and in which a contact is proved at `to`, or a fold closes between `from` and `to`. The
    arc to a branch point at the end comes after the last tube.
    """
    keys(given, "tube clear from to" if "contact" in claims else "tube clear", "contacts")
    number = natural(given["tube"], "tube")
    require(1 <= number <= len(steps), "there is no such tube")
    stretches = stretches_of(start, tau, steps[:number])
    last = stretches[-1]

    def parameter(key: str, least: Fraction) -> Fraction:
        found = Fraction(integer(given[key]), 1 << _PARAMETER_BITS)
        require(least <= found <= last.most, f'the parameter "{key}" is out of range')
        return found

    lengths = [stretch.length() for stretch in stretches[:-1]]
    last.end_at(parameter("clear", last.least))
    clear, unit = parse_rational(claims["clear"]), start.equations.unit
    shortest = sum((low for low, _ in lengths), last.length()[0])
    require(clear <= shortest * unit, "what is clear is shorter than claimed")
    faces = Faces(start.equations)
    if "contact" in claims:
        keys(claims["contact"], "kind time faces folds", "contact")
        first, latest = map(parse_rational, items(claims["contact"]["time"], "time", 2))
        require(first == clear, "a contact is not claimed from where the motion is clear")
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
    """The faces claimed touch by the parameter `end`."""
    require(claim["kind"] in _KINDS, "the contact is of no known kind")
    pair = [
        tuple(natural(v, "corner") for v in items(face, "face", 3))
        for face in items(claim["faces"], "faces", 2)
    ]
    known = {frozenset(face) for face in faces.faces}
    require(known.issuperset(map(frozenset, pair)), "what touches is no face")
    folds = [
        tuple(natural(v, "vertex") for v in items(fold, "fold", 2))
        for fold in items(claim["folds"], "folds")
    ]
    one, two = pair
    if claim["kind"] == "contact":
        require(not folds, "a contact has no folds")
        require(faces.crossing(path, end, one, two), "no side runs through the other face")
        return
    require(len(folds) == 1 and folds[0] in faces.folds, "what closes is no fold")
    [(i, j)] = folds
    left, right = faces.folds[i, j][:2]
    require([set(one), set(two)] == [{i, j, left}, {i, j, right}], "the faces are not at the fold")
    require(faces.closes(path, begin, end, (i, j)), "the fold does not close")
