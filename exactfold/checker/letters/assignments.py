"""Certificates of all mountain-valley assignments, five corners (docs/any_border.md).

Why it is a proof: for each sign vector the solutions are a circle over the directions of the
boundary heights (Theorem 6 there). The evidence goes round this circle by points; a point is a
height vector inside the nappes of these signs. From each point to the next, the letters of all
solutions are known except at some folds (`arcs`). The letters at the points themselves are shown to
occur. If all letters that are possible between two points are shown to occur somewhere, no other
assignment occurs. Sign vectors that begin with a minus are reflections of the others. A fold from
boundary to boundary bends independently. In this case the checker looks at the sheet without the
corner behind this fold. That sheet has four corners, and one point on each of the two sides of the
flat state is enough.

`assignments` has the letters of all folds, in order, of all solutions that bend every fold but
those in triangulated triangles, which are F. The evidence has `emptied`, the triangulated
triangles, and `circles`, a list of points for each sign vector that begins with a plus; of these
the last sign changes first, plus before minus. A point has integers as texts, up to a positive
factor: heights of the boundary vertices but three, and then of the vertices that can pop, in
increasing order. All other heights are 0. The three are the boundary vertex with the smallest
number, the next one counter-clockwise, and the first after it that is not on a line with them.
"""

from __future__ import annotations

from itertools import product
from typing import Any, TypedDict

from ..branches.branch import Place
from ..core import limits
from ..core.kinds import DocumentKind
from ..core.reading import at_most, counted, items, keys, keys_of, parse_integer, refusing, require
from ..sheets.reduced import check_convex
from ..sheets.sheet import Edge, Sheet, read_sheet, turn
from .arcs import Arcs, Word

MOST_VERTICES = limits.ASSIGNED_VERTICES
"""The largest number of vertices that can pop."""


class AssignmentsClaims(TypedDict):
    """The claims of a file (see `check`)."""

    assignments: list[str]


class VerifiedAssignments(AssignmentsClaims):
    """The verified claims, with the number of interior vertices and the digest of the pattern."""

    interior: int
    sha256: str


@refusing()
def check(data: dict[str, Any]) -> VerifiedAssignments:
    """Verify every claim of a loaded certificate; raises `CertificateError` at the first failure.

    Returns the claims and the SHA-256 of the pattern. The claim is: `assignments` are the
    assignments of all solutions that bend every fold outside triangulated triangles. An assignment
    has one letter for each fold, in lexicographic order of the folds; folds inside triangulated
    triangles have the letter "F".
    """
    given, digest = read_sheet(data["pattern"])
    claims, evidence = data["claims"], data["evidence"]
    keys(claims, keys_of(AssignmentsClaims), "claims")
    keys(evidence, "emptied circles", "evidence")
    texts = _shown(given, evidence)
    listed = items(claims["assignments"], "assignments")
    require(listed == texts, f"the evidence shows {len(texts)} assignments, not those listed")
    return {"sha256": digest, "interior": len(given.interior), "assignments": texts}


def _shown(given: Sheet, evidence: dict[str, Any]) -> list[str]:
    """The assignments that the evidence shows to occur, sorted."""
    sheet = Place(given, evidence["emptied"]).sheet
    require(len(sheet.boundary) == 5, "there are not five boundary vertices")
    check_convex(sheet)
    boundary = set(sheet.boundary)
    chords = [fold for fold in sheet.folds if boundary.issuperset(fold)]
    circles = _Circles(_without_ear(sheet) if chords else sheet)
    words = circles.shown(evidence["circles"])
    return sorted(text for word in words for text in circles.texts(word, given.folds, chords))


def free_boundary(sheet: Sheet) -> list[int]:
    """The boundary vertices except three that are not on a line; modulo planes those are at 0."""
    first, second, *others = sheet.boundary
    p, q = sheet.points[first], sheet.points[second]
    third = next(v for v in others if turn(p, q, sheet.points[v]))
    return [v for v in others if v != third]


def _without_ear(sheet: Sheet) -> Sheet:
    """The sheet without a corner that lies on one face only."""
    tip, *_ = (v for v in sheet.boundary if len(sheet.next[v]) == 1)
    faces = [sheet.face(t) for t in sheet.triangles if tip not in t]
    return Sheet({v: p for v, p in sheet.points.items() if v != tip}, faces)


class _Circles:
    """The solutions of one sheet: for each sign vector a circle, or two rays with four corners."""

    def __init__(self, sheet: Sheet) -> None:
        self.sheet = sheet
        require(sheet.interior, "no vertex can pop")
        number = len(sheet.interior)
        at_most(number, MOST_VERTICES, "the vertices that can pop", "ASSIGNED_VERTICES")
        free = free_boundary(sheet)
        self.free = len(free)
        self.arcs = Arcs(sheet, [*free, *sheet.interior])
        self.signs = [(1, *rest) for rest in product((1, -1), repeat=number - 1)]

    def shown(self, entries: Any) -> set[Word]:
        """The letters at the points; raises unless every solution that bends all folds has some."""
        circles = [
            self._points(entry, signs, f"circle {k}")
            for k, (entry, signs) in enumerate(
                zip(items(entries, "circles", len(self.signs)), self.signs, strict=True)
            )
        ]
        seen = {self.arcs.letters(a, a) for points in circles for a in points}
        known = {tuple(turn * x for x in word) for word in seen if all(word) for turn in (1, -1)}
        for k, (points, signs) in enumerate(zip(circles, self.signs, strict=True)):
            for j, (a, b) in enumerate(self._steps(points)):
                left = self.arcs.possible(self.arcs.letters(a, b), signs) - known
                require(not left, f"circle {k}: other letters are possible after point {j}")
        return known

    def _points(self, entry: Any, signs: Word, name: str) -> list[list[int]]:
        """Read the points of a circle; raises unless they lie in the nappes and go all round."""
        points = []
        for heights in items(entry, name):
            point = items(heights, "heights", self.free + len(self.sheet.interior))
            points.append([parse_integer(z) for z in point])
            self.arcs.check_nappes(points[-1], signs, name)
        if self.free == 1:
            first, last = points
            sides = first[0] > 0 > last[0]
            require(sides, f"{name}: the two points are not on the two sides of the flat state")
        else:
            for j, (a, b) in enumerate(self._steps(points)):
                ahead = a[0] * b[1] - a[1] * b[0] > 0
                require(ahead, f"{name}: the boundary heights do not turn on after point {j}")
            require(points, f"{name} has no points")
        return points

    def _steps(self, points: list[list[int]]) -> list[tuple[list[int], list[int]]]:
        """Each point with the next one; with four corners, each point with itself."""
        after = points if self.free == 1 else points[1:] + points[:1]
        return list(zip(points, after, strict=True))

    def texts(self, word: Word, folds: list[Edge], chords: list[Edge]) -> list[str]:
        """The assignments of the given sheet with these letters.

        A fold from boundary to boundary may have either letter.
        """
        own = {fold: "MV"[x > 0] for fold, x in zip(self.sheet.folds, word, strict=True)}
        either = [own.get(fold, "MV" if fold in chords else "F") for fold in folds]
        return ["".join(letters) for letters in product(*either)]


def summary(claims: VerifiedAssignments) -> str:
    """One line that states the verified claims."""
    number = len(claims["assignments"])
    which = counted(
        number, "mountain-valley assignment occurs", "mountain-valley assignments occur"
    )
    return f"VALID: exactly {which} with no fold flat; sha256 {claims['sha256']}"


ASSIGNMENTS = DocumentKind(
    format="exactfold assignments",
    versions=(1,),
    names="format version pattern claims evidence",
    claims=VerifiedAssignments,
    check=check,
    summary=summary,
)
"""All mountain-valley assignments of a sheet with five corners (docs/any_border.md)."""
