"""Certificates of one flat-folded state of a sheet of rigid panels (docs/flat.md).

The checker finds the flat folding map, all pairs of pieces that overlap, and all places where
layers could cross (`orders`). The evidence has `pieces`, the corners of each convex piece, counter-
clockwise: folded folds run between them, and the first keeps its place, face up. It has the
`order`, hexadecimal digits with one bit for each pair of pieces that overlap: 1 if the piece with
the smaller number lies below. Pairs are sorted, the first bit is the highest bit of the first
digit, and what is left of the last digit is 0.
"""

from __future__ import annotations

import re
from typing import Any, TypedDict

from ..core.kinds import DocumentKind
from ..core.reading import counted, keys, keys_of, refusing, require, same, text_of
from ..sheets.panels import read_panels
from .folding import FoldedSheet, asked, read_letters, read_pieces
from .orders import Crossings, Orders
from .overlaps import Overlaps


class FlatStateClaims(TypedDict):
    """The claims of a file (see `check`)."""

    letters: str
    assignment: str
    pieces: int
    pairs: int


class VerifiedFlatState(FlatStateClaims):
    """The verified claims, with the digest of the pattern."""

    sha256: str


@refusing()
def check(data: dict[str, Any]) -> VerifiedFlatState:
    """Verify every claim of a loaded certificate; raises `CertificateError` at the first failure.

    Returns the claims and the SHA-256 of the pattern. The `letters` have one letter for each fold,
    in lexicographic order of the folds: folds with M, V or U are folded by 180 degrees, U either
    way, and folds with F stay flat. There is a flat-folded state with these letters, and in it the
    folds have the letters `assignment`. There are so many convex `pieces`, and `pairs` of pieces
    that overlap.
    """
    claims, evidence = data["claims"], data["evidence"]
    keys(claims, keys_of(FlatStateClaims), "claims")
    keys(evidence, "pieces order", "evidence")
    sheet, digest = read_panels(data["pattern"])
    letters = read_letters(sheet, claims["letters"])
    folded = FoldedSheet(sheet, letters, read_pieces(sheet, evidence["pieces"]))
    overlaps = Overlaps(folded)
    orders = Orders(len(overlaps.pieces))
    bits = read_bits(evidence["order"], len(overlaps.pairs), "the order")
    lower = {
        pair if bit == "1" else pair[::-1] for pair, bit in zip(overlaps.pairs, bits, strict=True)
    }
    for order in lower:
        orders.fix(order)
    Crossings(overlaps, orders).check()
    said = ""
    for fold in sheet.folds:
        if letters[fold] == "F":
            said += "F"
            continue
        one, other = folded.pieces_of(fold)
        said += "V" if ((one, other) in lower) == folded.up[one] else "M"
    facts = {"assignment": said, "pieces": len(overlaps.pieces), "pairs": len(overlaps.pairs)}
    for key, fact in facts.items():
        require(same(claims[key], fact), f"claim {key} = {claims[key]!a}, but it is {fact!a}")
    proved: FlatStateClaims = claims
    return {"sha256": digest, **proved}


def read_bits(value: Any, count: int, what: str) -> str:
    """Read so many bits from hexadecimal digits, the highest bit of the first digit first."""
    text = text_of(value)
    fits = re.fullmatch("[0-9a-f]*", text) and len(text) == -(-count // 4)
    require(fits, f"{what} does not have {counted(count, 'bit', 'bits')} in hexadecimal digits")
    bits = "".join(f"{int(digit, 16):04b}" for digit in text)
    require("1" not in bits[count:], f"{what} has more bits than pairs")
    return bits[:count]


def summary(claims: VerifiedFlatState) -> str:
    """One line that states the verified claims."""
    return (
        f"VALID: the sheet folds flat {asked(claims['letters'])}: an order of its "
        f"{counted(claims['pieces'], 'piece', 'pieces')}, of which "
        f"{counted(claims['pairs'], 'pair overlaps', 'pairs overlap')}, has no crossing; "
        f"sha256 {claims['sha256']}"
    )


FLAT_STATE = DocumentKind(
    format="exactfold flat-folded states",
    named="flat-state",
    versions=(1,),
    names="format version kind pattern claims evidence",
    claims=VerifiedFlatState,
    check=check,
    summary=summary,
)
"""One flat-folded state of a sheet of rigid panels (docs/flat.md)."""
