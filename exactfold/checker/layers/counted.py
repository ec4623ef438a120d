"""Certificates of the number of flat-folded states of a sheet of rigid panels (docs/flat.md).

The evidence has the keys of `refuted`, with steps that all states fulfil, and `components`. Each
pair of pieces that overlap has one order in all states, by a letter or by a clause of one order,
or it belongs to one component. A component has

- `pairs`: [a, b], pieces that overlap;
- `states`: for each way to order them hexadecimal digits with one bit a pair, as in `state`, 1 if
  the first piece of the pair lies below;
- `steps`: as in `refuted`, with a contradiction at the end. They may also use that the order of the
  pairs is none of those listed: a clause for each of the `states`, with the next numbers after the
  clauses and steps of all.

So no state has other orders. The checker finds that each choice of one way for each component is a
state, as if it tried them all (`orders`). The number of states is the product.
"""

from __future__ import annotations

from math import prod
from typing import Any, TypedDict

from ..core.kinds import DocumentKind
from ..core.reading import (
    counted,
    items,
    keys,
    keys_of,
    refusing,
    require,
    same,
)
from ..sheets.panels import read_panels
from .folding import FoldedSheet, asked, read_letters, read_pieces
from .orders import Crossings, Orders
from .overlaps import Overlaps
from .places import Clause, read_orders
from .refuted import read_clauses
from .state import read_bits


class FlatCountClaims(TypedDict):
    """The claims of a file (see `check`)."""

    letters: str
    states: int
    components: list[int]


class VerifiedFlatCount(FlatCountClaims):
    """The verified claims, with the digest of the pattern."""

    sha256: str


@refusing()
def check(data: dict[str, Any]) -> VerifiedFlatCount:
    """Verify every claim of a loaded certificate; raises `CertificateError` at the first failure.

    Returns the claims and the SHA-256 of the pattern. The `letters` have one letter for each fold,
    in lexicographic order of the folds, as in `state`. With these letters there are exactly so many
    flat-folded `states`, the product of the numbers of `components`.
    """
    claims, evidence = data["claims"], data["evidence"]
    keys(claims, keys_of(FlatCountClaims), "claims")
    keys(evidence, "pieces places clauses steps components", "evidence")
    sheet, digest = read_panels(data["pattern"])
    letters = read_letters(sheet, claims["letters"])
    folded = FoldedSheet(sheet, letters, read_pieces(sheet, evidence["pieces"]))
    overlaps = Overlaps(folded)
    known = read_clauses(overlaps.plane, evidence)
    known.follow(evidence["steps"])
    orders = Orders(len(folded.pieces))
    open_pairs = set(overlaps.pairs)
    for a, b in known.known:
        pair = min(a, b), max(a, b)
        if pair in open_pairs:
            open_pairs.remove(pair)
            orders.fix((a, b))
    ways = []
    for entry in items(evidence["components"], "components"):
        keys(entry, "pairs states steps", "a component")
        pairs = read_orders(entry["pairs"], len(folded.pieces))
        for a, b in pairs:
            pair = min(a, b), max(a, b)
            require(pair in open_pairs, f"the pair {a}, {b} is not open, or no pair")
            open_pairs.discard(pair)
        states = [
            read_bits(value, len(pairs), "a state") for value in items(entry["states"], "states")
        ]
        require(len(set(states)) == len(states), "a state is listed twice")
        known.contradict([_other_than(state, pairs) for state in states], entry["steps"])
        orders.choose(pairs, states)
        ways.append(len(states))
    require(not open_pairs, f"the order of the pieces {min(open_pairs, default=())} is open")
    Crossings(overlaps, orders).check()
    for key, fact in (("components", ways), ("states", prod(ways))):
        require(same(claims[key], fact), f"claim {key} = {claims[key]!a}, but it is {fact!a}")
    proved: FlatCountClaims = claims
    return {"sha256": digest, **proved}


def _other_than(state: str, pairs: Clause) -> Clause:
    """The clause that some pair has another order than in a state."""
    return tuple((b, a) if bit == "1" else (a, b) for bit, (a, b) in zip(state, pairs, strict=True))


def summary(claims: VerifiedFlatCount) -> str:
    """One line that states the verified claims."""
    number = counted(claims["states"], "flat-folded state", "flat-folded states")
    product = " x ".join(map(str, claims["components"]))
    return (
        f"VALID: the sheet has exactly {number} {asked(claims['letters'])}"
        f"{f' ({product})' if len(claims['components']) > 1 else ''}; sha256 {claims['sha256']}"
    )


FLAT_COUNT = DocumentKind(
    format="exactfold flat-folded states",
    named="flat-count",
    versions=(1,),
    names="format version kind pattern claims evidence",
    claims=VerifiedFlatCount,
    check=check,
    summary=summary,
)
"""The number of flat-folded states of a sheet of rigid panels (docs/flat.md)."""
