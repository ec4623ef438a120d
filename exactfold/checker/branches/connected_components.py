"""Certificates of the pieces of the solutions of a sheet (docs/any_border.md).

The pieces are the connected components of the solutions without the flat state.

Why it is a proof: if the boundary is convex and has five or more vertices, the solutions are 2^n
graphs, one for each sign vector of the n vertices that can pop (Theorem 6). Sign vectors e and e'
that differ at v only are joined if a non-zero solution in the nappes of e is flat at v (Theorem 7).
So the joints that are shown give the upper bound. For the lower bound let v be in `complete`, and
let such a solution be given. It has no bend at the folds around v, nor at those of the flat
closure: it is in the linear space of first-order motions that the checker finds (`flat_stars`), and
in the kernels of the semidefinite forms. A part of it that is not 0 is a solution, flat at v, with
signs that agree with e; so take the solution to be on one part. There are these cases:

- Where all forms vanish, every form is isotropic and has one positive direction. So at each vertex
  the solutions are one line, and they are one line in all, as the part is connected.
- If multiples of the forms span all monomials of some degree modulo a prime, they do so over Q, and
  there is no common zero.
- 2^(m-1) zeros of m - 1 forms in disjoint boxes are all, at infinity as well, by refined Bezout. A
  box of real and imaginary parts holds one complex zero, as these parts of the forms are quadrics
  in them, and it is none of the real ones.
- If the signs of all vertices at which a part may bend occur in all ways, up to reflection, one of
  these joints agrees with e.

In each case a joint that is shown joins e and e'. At vertices that are not in `complete` all sign
vectors that differ there only are taken to be joined. A fold from boundary to boundary joins
everything.

The claims are the `vertices` that can pop, in increasing order; `at_least` and `at_most`, bounds of
the number of pieces; `joints`, the signs of all solutions with flat stars that the evidence shows
("+", "-", or "0" where the star is flat; one of each and its reflection, and none that joins only
sign vectors that another one joins; no list with a `chord`); and `complete`, the vertices of which
it is shown that no other sign vectors that differ there only are joined. The evidence has
`emptied`, the triangulated triangles; `chord`, null or a fold from boundary to boundary; and
`flat`, a list of sets of stars that are held flat. Each has `held`, these vertices; `complete`,
those of which this shows all joints, because the same folds are left with the star of that vertex
flat alone; and `parts`. An entry of `parts` has `folds`, whose densities p_1, ..., p_m are
coordinates of a part that is not decided without it, and one of these: `chart`, the numbers c_k of
the chart p_m + sum_{k<m} c_k p_k = 1, and `roots`, 2^(m-1) boxes as in listings for the other
coordinates (a box of a zero that is not real has the centres of all real parts and then those of
all imaginary parts; some imaginary part differs from 0 on it); or `points`, boxes for the
coordinates `free`, one for each form, all others being `fixed`.
"""

from __future__ import annotations

from typing import Any, TypedDict

from ..core import limits
from ..core.kinds import DocumentKind
from ..core.reading import at_most, counted, items, keys, keys_of, natural, refusing, require, same
from ..core.towers import Tower
from ..panels.spaces import Spaces
from ..sheets.panels import PanelSheet, pair
from ..sheets.reduced import check_convex
from ..sheets.sheet import read_sheet
from .branch import Place
from .flat_stars import Signs, solutions

MOST_VERTICES = limits.PIECE_VERTICES
_REFLECTED = str.maketrans("+-", "-+")
Cube = tuple[int, int]
"""A pair (mask, value): all sign vectors that agree with `value` on the bits of `mask`."""


class PiecesClaims(TypedDict):
    """The claims of a file (see `check`)."""

    vertices: list[int]
    at_least: int
    at_most: int
    joints: list[str]
    complete: list[int]


class _Chord(TypedDict, total=False):
    chord: list[int]


class VerifiedPieces(PiecesClaims, _Chord):
    """The verified claims, with the fold from boundary to boundary that joins all, if any."""

    interior: int
    sha256: str


@refusing()
def check(data: dict[str, Any]) -> VerifiedPieces:
    """Verify every claim of a loaded certificate; raises `CertificateError` at the first failure.

    Returns the claims, the SHA-256 of the pattern, and the `chord` that joins all, if there is one.
    The claims are: `vertices` are the vertices that can pop. Without the flat state the solutions
    fall into `at_least` to `at_most` pieces. `joints` are the signs of all solutions with flat
    stars that the evidence shows, with "0" at these stars; of a joint and its reflection one is
    listed, and a joint that joins only what another joins is left out. No other solution joins two
    sign vectors that differ only at one vertex of `complete`.
    """
    given, digest = read_sheet(data["pattern"])
    claims, evidence = data["claims"], data["evidence"]
    keys(claims, keys_of(PiecesClaims), "claims")
    keys(evidence, "emptied chord flat", "evidence")
    place = Place(given, evidence["emptied"])
    require(len(place.sheet.boundary) > 4, "there are fewer than five boundary vertices")
    check_convex(place.sheet)
    search = _JointSearch(place)
    vertices = search.vertices
    require(same(claims["vertices"], vertices), f"the vertices that can pop are {vertices}")
    chord = evidence["chord"]
    if chord is not None:
        i, j = (natural(v, "a vertex") for v in items(chord, "chord", 2))
        require((i, j) in search.chords, f"{i}-{j} is not a fold from boundary to boundary")
        low = high = 1
    else:
        require(not search.chords, "a fold goes from boundary to boundary, and no chord is named")
        for entry in items(evidence["flat"], "flat"):
            search.hold(entry)
        low, high = search.bounds()
    _check_joints(items(claims["joints"], "joints"), search)
    complete = sorted(search.complete)
    shown = f"the evidence is complete at the vertices {complete}"
    require(same(claims["complete"], complete), shown)
    shown = f"the evidence shows {low} to {high} pieces"
    require(same([claims["at_least"], claims["at_most"]], [low, high]), shown)
    more: _Chord = {} if chord is None else {"chord": chord}
    proved: PiecesClaims = claims
    return {"sha256": digest, "interior": len(given.interior), **more, **proved}


def _check_joints(listed: list[Any], search: _JointSearch) -> None:
    """Raise unless the listed joints are the largest that are shown, each once up to reflection."""
    largest = search.largest()
    known: set[str] = set()
    for text in listed:
        require(text in largest, f"the joint {text!a} is not shown, or another one joins more")
        require(text not in known, f"the joint {text!a} is listed twice, or with its reflection")
        known |= {text, text.translate(_REFLECTED)}
    left = sorted(largest - known)
    require(not left, f"the joint {left[:1]} is not listed")


class _JointSearch:
    """The joints of one sheet that the evidence shows."""

    def __init__(self, place: Place) -> None:
        sheet = self.sheet = place.sheet
        self.vertices = list(sheet.interior)
        require(self.vertices, "no vertex can pop")
        at_most(len(self.vertices), MOST_VERTICES, "the vertices that can pop", "PIECE_VERTICES")
        boundary = set(sheet.boundary)
        self.chords = {fold for fold in sheet.folds if boundary.issuperset(fold)}
        self._kept = sorted(sheet.points)
        self._new = {v: k for k, v in enumerate(self._kept)}
        tower = Tower()
        points = [tuple(tower.number(x) for x in sheet.points[v]) for v in self._kept]
        edges = sorted((self._new[i], self._new[j]) for i, j in sheet.edges)
        self._panels = PanelSheet(tower, [(x, y) for x, y in points], edges)
        self.joints: set[str] = set()
        self.cubes: set[Cube] = set()
        self.complete: set[int] = set()

    def hold(self, entry: Any) -> None:
        """Find the solutions in which the stars that an entry names are flat."""
        keys(entry, "held complete parts", "a set of flat stars")
        near = self._near([natural(v, "a vertex") for v in items(entry["held"], "held")])
        parts = [self._renamed(part) for part in items(entry["parts"], "parts")]
        all_found = True
        if near:
            spaces = Spaces(self._panels, near)
            joints, all_found = solutions(spaces, spaces.first_order, parts)
            for signs in joints:
                self._add(signs)
        for v in (natural(v, "a vertex") for v in items(entry["complete"], "complete")):
            require(all_found, f"not all solutions with vertex {v} flat are shown")
            require(self._near([v]) == near, f"other folds may bend with vertex {v} flat")
            self.complete.add(v)

    def _near(self, held: list[int]) -> dict[int, list[int]]:
        inside = set(self.vertices)
        inner = held and inside.issuperset(held)
        require(inner, f"{held[:20]}, held flat, are not one or more vertices that can pop")
        flat = {pair(self._new[v], self._new[u]) for v in held for u in self.sheet.star(v)}
        return self._panels.live(flat)

    def _renamed(self, part: Any) -> Any:
        folds = [
            pair(*(self._new[v] for v in items(fold, "a fold", 2)))
            for fold in items(part["folds"], "folds")
        ]
        return {**part, "folds": folds}

    def _add(self, signs: Signs) -> None:
        own = {self._kept[k]: sign for k, sign in signs.items()}
        for turn in (1, -1):
            values = [turn * own.get(v, 0) for v in self.vertices]
            self.joints.add("".join("-0+"[value + 1] for value in values))
            mask = sum(1 << k for k, value in enumerate(values) if value)
            self.cubes.add((mask, sum(1 << k for k, value in enumerate(values) if value > 0)))

    def largest(self) -> set[str]:
        """The joints that are not contained in another joint, with their reflections."""
        return {
            text
            for text in self.joints
            if not any(_within(text, other) for other in self.joints if other != text)
        }

    def bounds(self) -> tuple[int, int]:
        """A lower and an upper bound of the number of pieces."""
        high = components(len(self.vertices), self.cubes)
        kept = [k for k, v in enumerate(self.vertices) if v in self.complete]
        cut = {(_bits(mask, kept), _bits(value, kept)) for mask, value in self.cubes}
        return components(len(kept), cut), high


def _within(joint: str, other: str) -> bool:
    """Whether another joint joins everything that this joint joins."""
    return all(b in (a, "0") for a, b in zip(joint, other, strict=True))


def _bits(number: int, kept: list[int]) -> int:
    return sum(1 << n for n, k in enumerate(kept) if number >> k & 1)


def components(size: int, cubes: set[Cube]) -> int:
    """The number of components of 2^size sign vectors, if all vectors of each cube are joined."""
    waiting = set(cubes)
    number = 0
    while waiting:
        number += 1
        reached = [waiting.pop()]
        while reached:
            mask, value = reached.pop()
            near = {(m, x) for m, x in waiting if not (x ^ value) & m & mask}
            waiting -= near
            reached += near
    alone = sum(
        all((vector ^ value) & mask for mask, value in cubes) for vector in range(1 << size)
    )
    return number + alone


def summary(claims: VerifiedPieces) -> str:
    """One line that states the verified claims."""
    low, high = claims["at_least"], claims["at_most"]
    graphs = 1 << len(claims["vertices"])
    pieces = counted(high, "piece", "pieces") if low == high else f"{low} to {high} pieces"
    joints = f"with {counted(len(claims['joints']), 'joint', 'joints')} shown"
    if "chord" in claims:
        joints = "joined by the fold {}-{} from boundary to boundary".format(*claims["chord"])
    return (
        f"VALID: the solutions are {graphs} graphs in {pieces}, {joints}; sha256 {claims['sha256']}"
    )


PIECES = DocumentKind(
    format="exactfold pieces",
    versions=(1,),
    names="format version pattern claims evidence",
    claims=VerifiedPieces,
    check=check,
    summary=summary,
)
"""The number of pieces of the solutions, with more than four corners (docs/any_border.md)."""
