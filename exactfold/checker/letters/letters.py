"""Certificates of all rays of branches with given letters (docs/assignment.md).

Why it is a proof: each half of a branch is a solution that is not flat, in the closed nappes of
some sign vector e. Follow e through the tree: at a split go to the sign of e; a forced sign is that
of e, or else all signs of a refuted set belong to e. If a refuted set belongs to e, the half does
not have the letters (`refuted`; docs/assignment.md, Theorem 1), or because a star that bends to one
side only has K_v > 0 unless all its bends lie on one line. Nor does a fold inside a triangulated
triangle bend. Otherwise the end is a leaf with the signs e. Its evidence are two halves with proved
letters, as for a single branch (`branch`): one with these signs and a positive saddle, and the
opposite of one with the signs -e and a positive saddle. A half with a positive saddle is, up to a
plane, a multiple of the solution in the nappes of e with the rim of the first, the only one by
Theorem 5 of docs/branch.md; a half with a negative saddle is the opposite of one in the nappes of
-e. A saddle that is 0 would make the rim, and so all of the solution, plane. With a reflex corner
the same holds for its side instead of the saddle. If the sheet does not have four boundary
vertices, there are no leaves: no solution has the letters if all ends of the tree are refuted.

The evidence has `emptied`, the triangulated triangles, as in certificates of one branch, and:

- `refuted`, sets of `signs`, pairs of a vertex and its sign, that no solution with the letters has.
  `heights` are pairs of a vertex and the heights of its neighbours, counter-clockwise from the one
  with the smallest number; they are integers, because all may be multiplied by one number. They are
  null if all folds of the star bend to one side or stay flat, not all on one line.
- `tree`, steps that are read with a stack of sets of signs. At first it holds the empty set; each
  step takes the last set. `["split", v]` puts the signs with v down there, and then those with v
  up; `["force", k, v]`, where all signs of the k-th refuted set but that of v are there, those with
  the opposite sign of v. `["refuted", k]`: the k-th refuted set is among the signs. `["leaf"]`: all
  signs are there, and the next entry of `leaves` is about them. `["flat", i, j]`: a mountain or a
  valley is asked for inside a triangulated triangle.
- `leaves`, pairs of halves with `heights` and `denominator` as in the certificate of one branch.
  The first half has the signs of the leaf and a positive saddle, or its reflex corner up. The
  second has the opposite signs; turned upside down it is the other half of the leaf.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, TypedDict

from ..branches.branch import Place
from ..branches.branch_proof import Proof
from ..core.kinds import DocumentKind
from ..core.reading import counted, integer, items, keys, keys_of, natural, refusing, require
from ..sheets.sheet import Edge, read_sheet
from .refuted import Signs, Stars

Ray = tuple[tuple[int, ...], int]
"""A ray: the signs of the interior vertices, 0 where the star is flat, and the side."""

_TURNED = str.maketrans("MV", "VM")


class HalfClaim(TypedDict):
    """A ray, named by the signs of the interior vertices and its side of the flat state."""

    vertex_signs: list[int]
    side: int


class LettersClaims(TypedDict):
    """The claims of a file (see `check`)."""

    letters: str
    halves: list[HalfClaim]


class VerifiedLetters(LettersClaims):
    """The verified claims, with the number of interior vertices and the digest of the pattern."""

    interior: int
    sha256: str


@refusing()
def check(data: dict[str, Any]) -> VerifiedLetters:
    """Verify every claim of a loaded certificate; raises `CertificateError` at the first failure.

    Returns the claims and the SHA-256 of the pattern. The claim is: `halves` lists exactly the rays
    of branches with these `letters`. There is one letter for each fold, in lexicographic order of
    the folds; "U" stands for any letter.
    """
    given, digest = read_sheet(data["pattern"])
    claims, evidence = data["claims"], data["evidence"]
    keys(claims, keys_of(LettersClaims), "claims")
    keys(evidence, "emptied refuted tree leaves", "evidence")
    place = Place(given, evidence["emptied"])
    if len(place.sheet.boundary) == 4:
        place.fix_boundary()  # the notch is closed, so that the boundary is convex
    text = claims["letters"]
    fits = isinstance(text, str) and len(text) == len(given.folds) and set(text) <= set("MVFU")
    require(fits, "the letters are not one of M, V, F, U for each fold")
    wanted = dict(zip(given.folds, text, strict=True))
    search = _LetterSearch(place, wanted)
    matching = search.rays(
        items(evidence["refuted"], "refuted"),
        items(evidence["tree"], "tree"),
        items(evidence["leaves"], "leaves"),
    )
    listed = [_ray(entry, len(given.interior)) for entry in items(claims["halves"], "halves")]
    require(len(set(listed)) == len(listed), "a half of a branch is listed twice")
    for ray in listed:
        require(ray in matching, "a listed half of a branch does not have these letters")
    require(len(listed) == len(matching), "a half of a branch with these letters is not listed")
    proved: LettersClaims = claims
    return {"sha256": digest, "interior": len(given.interior), **proved}


def _ray(entry: Any, size: int) -> Ray:
    keys(entry, keys_of(HalfClaim), "half")
    signs = items(entry["vertex_signs"], "vertex_signs", size)
    return tuple(map(integer, signs)), integer(entry["side"])


class _LetterSearch:
    """The walk over the tree, for one sheet and the wanted letters."""

    def __init__(self, place: Place, wanted: dict[Edge, str]) -> None:
        self.place, self.wanted = place, wanted
        self.inside = set(place.open.interior)
        self.rigid = {fold for fold in wanted if not place.removed.isdisjoint(fold)}
        own = {fold: wanted[fold] for fold in place.open.folds}
        self.stars = Stars(place.open, own)

    def rays(self, refuted: list[Any], tree: list[Any], leaves: list[Any]) -> set[Ray]:
        """The rays with the letters; raises unless the whole tree is verified."""
        sets = [self.stars.refuted(entry, f"refuted set {k}") for k, entry in enumerate(refuted)]
        matching: set[Ray] = set()
        entries = iter(leaves)
        for signs in self._left(sets, tree):
            both = items(next(entries, None), "a leaf", 2)
            for side, ray in zip((1, -1), both, strict=True):
                matching |= self._matching(signs, side, ray)
        require(next(entries, None) is None, "the evidence has more leaves than the tree")
        return matching

    def _left(self, sets: list[Signs], tree: list[Any]) -> Iterator[Signs]:
        """Yield the sign vectors at the leaves; raises if the tree does not cover all vectors."""
        stack: list[Signs] = [{}]
        for step in tree:
            signs = stack.pop()
            kind, *given = items(step, "a step")
            at = [natural(k, "a number of a step") for k in given]
            if kind == "leaf":
                require(self.place.fixed, "a leaf needs a sheet with four corners")
                whole = signs.keys() == self.inside
                require(whole, "a leaf does not have the signs of all interior vertices")
                yield signs
            elif kind == "split":
                (v,) = at
                stack += [signs | {v: -1}, signs | {v: 1}]
            elif kind == "force":
                k, v = at
                others = dict(sets[k])
                sign = others.pop(v)
                forced = others.items() <= signs.items()
                require(forced, f"set {k} does not force the sign of vertex {v}")
                stack.append(signs | {v: -sign})
            elif kind == "refuted":
                (k,) = at
                contained = sets[k].items() <= signs.items()
                require(contained, f"the signs of set {k} are not among those of the case")
            else:
                require(kind == "flat", f"a step of the tree is {kind!a}")
                i, j = at
                held = (i, j) in self.rigid and self.wanted[i, j] in "MV"
                require(held, f"fold {i}-{j} can fold, or no mountain or valley is asked for there")
        require(not stack, "the tree does not cover all sign vectors")

    def _matching(self, signs: Signs, side: int, entry: Any) -> set[Ray]:
        """The ray on one side of a leaf, if it has the letters, as a set of one or none."""
        keys(entry, "heights denominator", "half of a leaf")
        proof = self.place.proof(entry["heights"], entry["denominator"])
        for v, sign in signs.items():
            # Where a sign is 0, the heights are exact and the star is flat: in both closed nappes.
            right = proof.signs[v] in (0, side * sign)
            require(right, f"vertex {v} does not have the sign of its leaf, {sign}")
        letters = self._letters(proof, side)
        compared = list(zip(self.wanted.values(), letters, strict=True))
        if any(other not in ("U", letter) and letter != "U" for other, letter in compared):
            return set()
        known = all(letter != "U" for other, letter in compared if other != "U")
        require(known, "a letter of a leaf that is asked for is not known")
        return {(tuple(side * sign for sign in self.place.signs(proof)), side)}

    def _letters(self, proof: Proof, side: int) -> list[str]:
        letters = "".join(self.place.letters(proof))
        return list(letters if side > 0 else letters.translate(_TURNED))


def summary(claims: VerifiedLetters) -> str:
    """One line that states the verified claims."""
    rays, text = len(claims["halves"]), claims["letters"]
    asked = counted(len(text) - text.count("U"), "letter", "letters")
    halves = counted(rays, "half of a branch has", "halves of branches have")
    which = f"exactly {halves}" if rays else "no branch has"
    return f"VALID: {which} the {asked} asked for on {len(text)} folds; sha256 {claims['sha256']}"


LETTERS = DocumentKind(
    format="exactfold letters",
    versions=(1,),
    names="format version pattern claims evidence",
    claims=VerifiedLetters,
    check=check,
    summary=summary,
)
"""All rays of branches with given mountains and valleys (docs/assignment.md)."""
