"""Certificates of how far the vertices of a sheet may move (docs/tolerance.md, 1).

The claims are about all sheets with the same panels whose vertices each lie within a disk of the
`radius` round those of the pattern:

- `ways`: the sheet starts to fold with these letters, M or V for each fold in lexicographic order,
  along a way that is isolated, or along its mirror image, with all letters reversed;
- `number`: there are so many ways and no others, as many as are listed; null claims nothing.

The evidence has the `densities`, angle / length of each fold to first order, of each way, up to a
factor, as integers. Nothing depends on how exact they are.

The number holds because m conditions of degree two on a space of dimension m + 1 have at most 2^m
isolated zeros, by Bezout's theorem, and the test finds 2^m regular ones, which are different.
"""

from __future__ import annotations

from itertools import combinations
from typing import Any, TypedDict

from ..core.kinds import DocumentKind
from ..core.limits import TOLERANCE_WORK
from ..core.reading import (
    at_most,
    counted,
    integer,
    items,
    keys,
    keys_of,
    natural,
    parse_rational,
    refusing,
    require,
    rounded,
)
from ..sheets.panels import read_panels
from .conditions import Conditions
from .zeros import Zero


class ToleranceClaims(TypedDict):
    """The claims of a file."""

    radius: str
    ways: list[str]
    number: int | None


class VerifiedTolerance(ToleranceClaims):
    """The verified claims, and the digest of the pattern."""

    sha256: str


@refusing()
def check(data: dict[str, Any]) -> VerifiedTolerance:
    """Verify every claim of a certificate; raises `CertificateError` at the first failure."""
    claims, evidence = data["claims"], data["evidence"]
    keys(claims, keys_of(ToleranceClaims), "claims")
    keys(evidence, "densities", "evidence")
    sheet, digest = read_panels(data["pattern"])
    conditions = Conditions(sheet)
    radius = parse_rational(claims["radius"])
    require(radius >= 0, "the radius is negative")
    r = conditions.radius(radius)
    lost = conditions.shape_stays(r)
    require(not lost, f"{lost} may lose its shape within the radius")
    ways = items(claims["ways"], "ways")
    given = items(evidence["densities"], "densities", len(ways))
    work = len(ways) * conditions.size**3
    at_most(work, TOLERANCE_WORK, "the products of the test", "TOLERANCE_WORK")
    found = []
    for number, (letters, values) in enumerate(zip(ways, given, strict=True)):
        folds = items(values, "the densities of a way", len(conditions.folds))
        zero = Zero(conditions, [float(integer(value)) for value in folds])
        rho = zero.box(r)
        if rho is None:
            require(False, f"way {number} is not proved to stay within the radius")
            continue
        stay = "".join(zero.letters(r, rho).values())
        other = stay.translate(str.maketrans("MV", "VM"))
        require(letters in (stay, other), f"the letters of way {number} are not proved to stay")
        found.append((zero, rho))
    if claims["number"] is not None:
        _check_number(conditions, natural(claims["number"], "the number of ways"), found)
    verified: ToleranceClaims = claims
    return {"sha256": digest, **verified}


def _check_number(conditions: Conditions, number: int, found: list[tuple[Zero, list[int]]]) -> None:
    """Raise unless the zeros are all, and different."""
    most = 1 << len(conditions.rings)
    require(number == len(found) == most, f"the ways are not {most}, the largest possible number")
    for k, ((one, rho), (other, box)) in enumerate(combinations(found, 2)):
        require(one.differs(rho, other, box), f"two ways are not proved to differ: pair {k}")


def summary(claims: VerifiedTolerance) -> str:
    """One line that states the verified claims."""
    number = claims["number"]
    others = "" if number is None else ", and no others"
    radius = rounded(parse_rational(claims["radius"]), 6, up=False)
    return (
        f"VALID: all sheets whose vertices move by less than {radius}, each within a disk, have "
        f"{counted(len(claims['ways']), 'way', 'ways')} with the letters of the file{others}; "
        f"sha256 {claims['sha256']}"
    )


TOLERANCE = DocumentKind(
    format="exactfold tolerance",
    versions=(1,),
    names="format version pattern claims evidence",
    claims=VerifiedTolerance,
    check=check,
    summary=summary,
)
"""How far the vertices of a sheet may move before its ways change (docs/tolerance.md, 1)."""
