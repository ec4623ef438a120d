"""Compact certificates of version 2: each entry has a root, and the branch that the root gives.

The module `listing` says what the evidence proves. Its certificates hold the same in one object.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from ..core.limits import MOST_BYTES, MOST_ENTRIES
from ..core.lines import read_object
from ..core.reading import UnfinishedError, at_most, items, keys, natural, refusing, require
from ..sheets.sheet import facts_of, read_sheet
from . import listing


@refusing()
def check_roots(header: dict[str, Any], texts: Iterator[str]) -> tuple[listing.CountClaims, int]:
    """Check the blocks that follow a header: the claims that they prove, and their number."""
    sheet, digest = read_sheet(header["pattern"])
    evidence, branches, blocks = gathered(header, texts)
    counts = listing.proved(sheet, evidence, branches)
    return {**facts_of(sheet, digest), **counts}, blocks


def gathered(header: dict[str, Any], texts: Iterator[str]) -> tuple[dict[str, Any], list[Any], int]:
    """Put the blocks together: the evidence with all roots, the branches, the number of blocks.

    Evidence and branches have the form that they have in a listing of one object.
    """
    evidence, branches, roots = header["evidence"], list[Any](), list[Any]()
    if "roots" not in evidence:  # the sheet is rigid, or has a single vertex that can fold
        return evidence, branches, 0
    number, block = natural(evidence["roots"], "roots"), natural(evidence["block"], "block")
    at_most(number, MOST_ENTRIES, "the roots", "MOST_ENTRIES")
    total, blocks = 0, -(-number // block)
    for k in range(blocks):
        text = next(texts, None)
        if text is None:
            raise UnfinishedError(f"only {k} of {blocks} blocks are there, and no root is checked")
        total += len(text)
        at_most(total, MOST_BYTES, "the bytes of the blocks", "MOST_BYTES")
        what = f"block {k}"
        data = read_object(text, what)
        keys(data, "block roots", what)
        require(
            type(data["block"]) is int and data["block"] == k,
            f"{what} is expected, but here is block {data['block']!a}",
        )
        for entry in items(data["roots"], f"{what}: roots", min(block, number - k * block)):
            roots.append(entry.pop("root"))
            branches.append(entry)
    kept = {key: value for key, value in evidence.items() if key != "block"}
    return kept | {"roots": roots}, branches, blocks
