"""Certificates that list every branch (docs/certificate.md).

There are four kinds of evidence:

  isolated       2^n disjoint boxes hold exactly one zero each, by Krawczyk's test in integers. By
                 refined Bezout these are all zeros of n quadrics in P^n, all real and simple.
  algebraic      The zeros are roots of squarefree polynomials, or lie in boxes, or in boxes on the
                 sheets that are flat at given vertices. A zero at which f quadrics have order 2 has
                 multiplicity 2^f or more. These bounds add up to 2^n, so that they are exact and no
                 zero is missing.
  rigid          A positive definite stress shows that the sheet cannot fold.
  single vertex  One curvature form has inertia (1, N - 3, 3) with N >= 5, so that the solutions are
                 one double cone.

Every kind has `triangles`: for each maximal triangulated triangle its `corners`, the vertices
`inside`, and positive `multipliers` for which the sum of multiplier times K_v is positive definite
on the heights inside. The rest is about the pattern without rigid parts. `roots` are boxes, with
`center` (n integers), `radius`, both over 2^bits, and `bits`; or those of `algebraic`. `chart` is
null for the chart "boundary saddle = 1"; for a sheet with a reflex corner it may be a functional by
vertex (interior vertices and that corner) that is 1 in the chart, the other three corners being
pinned.

Each branch has `vertex_signs`, "+", "-" or "0" for every interior vertex, in increasing order;
`assignment`, M, V, F (flat) or U (undecided: nothing is claimed) for every fold (i, j), i < j, in
lexicographic order; its `multiplicity`; and its `representative`, the side that is shown: "saddle",
whose boundary saddle is proved positive, or "either" where the saddle is not proved to differ from
0, for a reflex corner only; the signs then hold for one of the two mirror images.
"""

from __future__ import annotations

from typing import Any, TypedDict

from ..core.kinds import DocumentKind
from ..core.reading import (
    CertificateError,
    counted,
    items,
    keys,
    keys_of,
    refusing,
    require,
    text_of,
)
from ..sheets.boxes import Root, check_isolated
from ..sheets.equations import BranchSystem, read_chart
from ..sheets.flat_folds import close_flat
from ..sheets.sheet import Sheet, SheetFacts, facts_of, read_sheet
from ..sheets.stress import check_lorentzian, check_triangles
from .algebraic import check_algebraic

UPSIDE_DOWN = str.maketrans("+-MV", "-+VM")


class Counts(TypedDict):
    """How many branches there are, and whether all are proved to extend to a finite flex."""

    distinct: int
    with_multiplicity: int
    real: int
    nonreal: int
    true_branches: str


class ListedBranch(TypedDict):
    """A branch, named by the signs and letters on one ray.

    `representative` is "saddle" for the ray with the positive saddle, "either" if the saddle is 0
    or its sign is open.
    """

    vertex_signs: str
    assignment: str
    multiplicity: int
    representative: str


class CountClaims(SheetFacts, Counts):
    """The claims about a sheet and about the numbers of its branches."""


class ListingClaims(CountClaims):
    """The same claims, with a list of all branches."""

    branches: list[ListedBranch]


@refusing()
def check(data: dict[str, Any]) -> ListingClaims:
    """Verify every claim of a certificate; raises `CertificateError` at the first failure.

    Returns the verified claims. Passing means that the claims hold for the pattern in the file.
    """
    claims = data["claims"]
    keys(claims, keys_of(ListingClaims), "claims")
    sheet, digest = read_sheet(data["pattern"])
    branches = items(claims["branches"], "branches")
    counts = proved(sheet, data["evidence"], branches)
    facts: CountClaims = {**facts_of(sheet, digest), **counts}
    for key, fact in facts.items():
        require(
            type(claims[key]) is type(fact) and claims[key] == fact,
            f"claim {key} = {claims[key]!a}, but it is {fact!a}",
        )
    return {**facts, "branches": branches}


def proved(sheet: Sheet, evidence: Any, branches: list[Any]) -> Counts:
    """The counts that the evidence proves; raises unless `branches` lists exactly the branches."""
    require(isinstance(evidence, dict), "the evidence is not an object")
    emptied = check_triangles(sheet, evidence.get("triangles"))
    kind = evidence.get("kind")
    if kind == "rigid":
        counts = _rigid(sheet, emptied, evidence, branches)
    elif kind == "single vertex":
        counts = _single_vertex(sheet, emptied, evidence, branches)
    elif kind in ("isolated", "algebraic"):
        counts = _lines(sheet, emptied, evidence, branches)
    else:
        raise CertificateError(f"unknown kind of evidence {kind!a}")
    return counts


def counts_of(
    real: int, with_multiplicity: int, nonreal: int = 0, *, simple: bool = True
) -> Counts:
    """The counts of real and of other branches.

    If all are real and simple, all are proved to extend to a finite flex.
    """
    return {
        "distinct": real + nonreal,
        "with_multiplicity": with_multiplicity,
        "real": real,
        "nonreal": nonreal,
        "true_branches": "proved" if simple and not nonreal else "undecided",
    }


def _rigid(sheet: Sheet, emptied: Sheet, evidence: Any, branches: list[Any]) -> Counts:
    keys(evidence, "kind triangles", "evidence")
    require(
        len(sheet.boundary) == 3 and not emptied.interior and sheet.interior,
        "the sheet is not a triangulated triangle",
    )
    require(not branches, "a rigid sheet has no branches")
    return counts_of(0, 0)


def _single_vertex(sheet: Sheet, emptied: Sheet, evidence: Any, branches: list[Any]) -> Counts:
    keys(evidence, "kind triangles", "evidence")
    require(
        len(emptied.interior) == 1
        and len(emptied.star(emptied.interior[0])) == len(emptied.boundary) >= 5,
        "the emptied sheet is not the star of a single vertex of degree 5 or more",
    )
    check_lorentzian(emptied, emptied.interior[0])
    require(not branches, "a branch of dimension two or more is not listed")
    return counts_of(1, 1 << len(sheet.interior) - 1)


def _lines(sheet: Sheet, emptied: Sheet, evidence: Any, branches: list[Any]) -> Counts:
    """The counts if D = 1: each branch is a line, a zero of the branch system."""
    four = len(sheet.boundary) == 4 and sheet.interior
    require(four, "the sheet does not have four boundary vertices and an interior vertex")
    system, nonreal = BranchSystem(emptied, read_chart(evidence.get("chart"))), 0
    if evidence["kind"] == "isolated":
        roots = check_isolated(system, evidence)
    else:
        roots, nonreal = check_algebraic(system, evidence)
    require(len(branches) == len(roots), f"{len(branches)} branches for {len(roots)} roots")
    check_branches(sheet, system, roots, branches)
    simple = all(m == 1 for _, m in roots)
    return counts_of(len(roots), 1 << len(sheet.interior), nonreal, simple=simple)


def check_branches(
    sheet: Sheet, system: BranchSystem, roots: list[tuple[Root, int]], branches: list[Any]
) -> None:
    """Raise unless every listed branch has the signs, letters and multiplicity of its root.

    The letter U claims nothing. Two roots that are listed in different ways must be different
    zeros: their vertex signs, or the letters that are known on all branches, must differ.
    """
    texts: list[tuple[str, str]] = []
    emptied = system.sheet
    removed = len(sheet.interior) - len(emptied.interior)
    vertex_rows = {v: system.row(emptied.sign_of_vertex(v)) for v in emptied.interior}
    fold_rows = {f: system.row(emptied.bend(f)) for f in emptied.folds}
    saddle = system.row(system.saddle)
    for number, ((root, multiplicity), branch) in enumerate(zip(roots, branches, strict=True)):
        keys(branch, keys_of(ListedBranch), f"branch {number}")
        signs = {f: root.sign(row) for f, row in fold_rows.items()}
        close_flat(emptied, signs)
        at = {v: root.sign(row) for v, row in vertex_rows.items()}
        up_down = "".join("-0+?"[1 + digit(at.get(v, 0))] for v in sheet.interior)
        letters = "".join("MFVU"[1 + digit(signs.get(f, 0))] for f in sheet.folds)
        require("?" not in up_down, f"branch {number}: the sign of a vertex is open")
        seen = (up_down, letters)
        texts.append(seen)
        mirror = (up_down.translate(UPSIDE_DOWN), letters.translate(UPSIDE_DOWN))
        side = root.sign(saddle)
        allowed = {1: (seen,), -1: (mirror,)}.get(side or 0, (seen, mirror))
        require(
            any(
                branch["vertex_signs"] == up_down and agrees(text_of(branch["assignment"]), letters)
                for up_down, letters in allowed
            )
            and branch["representative"] == ("saddle" if side else "either"),
            f"branch {number}: {'its positive saddle' if side else 'either side'} shows "
            f"{' or '.join(map(' '.join, allowed))}, not what is claimed",
        )
        require(
            type(branch["multiplicity"]) is int
            and branch["multiplicity"] == multiplicity << removed,
            f"branch {number}: multiplicity is {multiplicity << removed}",
        )
    known = [k for k in range(len(sheet.folds)) if all(text[1][k] != "U" for text in texts)]
    kinds: dict[tuple[str, str], object] = {}
    for (up_down, letters), (root, _) in zip(texts, roots, strict=True):
        key = (up_down, "".join(letters[k] for k in known))
        once = kinds.setdefault(key, root.kind) == root.kind
        require(once, "two entries may be the same root")


def agrees(claimed: str, letters: str) -> bool:
    """Whether every claimed letter is right; the letter U claims nothing."""
    return len(claimed) == len(letters) and all(
        a in (b, "U") for a, b in zip(claimed, letters, strict=True)
    )


def digit(sign: int | None) -> int:
    """The sign itself, or 2 for an open sign."""
    return 2 if sign is None else sign


def summary(claims: CountClaims) -> str:
    """One line that states the verified claims."""
    branches = counted(claims["distinct"], "branch", "branches")
    return (
        f"VALID: {branches} ({claims['with_multiplicity']} with "
        f"multiplicity, {claims['real']} real) of the sheet with {claims['interior']} interior "
        f"and {claims['boundary']} boundary vertices, sha256 {claims['sha256']}"
    )


LISTING = DocumentKind(
    format="exactfold certificate",
    versions=(2,),
    names="format version pattern claims evidence provenance",
    claims=ListingClaims,
    check=check,
    summary=summary,
)
"""All branches of a sheet in one JSON object (docs/certificate.md)."""
