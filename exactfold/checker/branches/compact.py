"""Compact certificates (docs/certificate.md) are checked in one pass, block by block.

In version 1 the memory that this takes does not grow with the file, and several processes may share
the blocks. In version 2 all entries are kept.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing

from ..core.kinds import LineKind
from ..core.lines import lines, read_object
from ..core.parts import Engine, here, on_processes
from ..core.reading import (
    CertificateError,
    FormatError,
    UnfinishedError,
    keys,
    keys_of,
    refusing,
    require,
)
from .compact_blocks import CompactSheet
from .compact_roots import check_roots
from .listing import CountClaims, summary

CHAMBERS, ROOTS = 1, 2
"""The versions: 1 has one simple root for each sign vector, 2 an entry for each root of any kind.
"""


class IntegerVerifier:
    """Verifies the blocks of one file in integers."""

    def __init__(self, header: str) -> None:
        self.sheet = CompactSheet(COMPACT.header(header))

    def refusal(self, text: str, number: int) -> str | None:
        """Verify one block; say why it does not hold, or None if it holds."""
        try:
            with refusing(f"in block {number}"):
                self.sheet.check_block(self.sheet.decode(text, number))
        except CertificateError as error:
            return str(error)
        return None


INTEGERS = Engine(IntegerVerifier, 1, on_processes)
"""The engine that verifies all blocks in integers, by the standard library alone."""


def check(path: str, workers: int = 1, engine: Engine = INTEGERS) -> CountClaims:
    """Verify every claim of a compact certificate; returns the claims.

    Raises `CertificateError` if a claim is not supported, `FormatError` if the file is not a
    compact certificate, `OSError` if it cannot be read, and `BrokenExecutor` if a worker process
    died.
    """
    with open(path, "rb") as stream:
        return check_lines(lines(stream), workers, engine)


def check_lines(texts: Iterator[str], workers: int = 1, engine: Engine = INTEGERS) -> CountClaims:
    """Verify every claim, given the lines of a file; returns the claims.

    If `workers` is more than 1, that many processes share the blocks.
    """
    first = next(texts, None)
    if first is None:
        raise FormatError("the file is empty")
    header = COMPACT.header(first)
    if header["version"] == ROOTS:
        facts, blocks = check_roots(header, texts)
    else:
        with refusing("in the first line"):
            sheet = CompactSheet(header)
        _check_blocks(texts, first, sheet.blocks, workers, engine)
        facts, blocks = sheet.claims(), sheet.blocks
    _check_claims(texts, facts, blocks)
    return facts


def _check_claims(texts: Iterator[str], facts: CountClaims, blocks: int) -> None:
    """Raise unless the last line claims exactly the facts that were proved."""
    last = next(texts, None)
    if last is None:
        raise UnfinishedError(f"all {blocks} blocks hold, but the claims are missing")
    claims = read_object(last, "the last line")
    keys(claims, "claims", "the last line")
    require(next(texts, None) is None, "a line follows the claims")
    keys(claims["claims"], keys_of(CountClaims), "claims")
    for key, fact in facts.items():
        claim = claims["claims"][key]
        right = type(claim) is type(fact) and claim == fact
        require(right, f"claim {key} = {claim!a}, but it is {fact!a}")


def _check_blocks(
    texts: Iterator[str], header: str, blocks: int, workers: int, engine: Engine
) -> None:
    missing: list[CertificateError | FormatError] = []

    def there() -> Iterator[tuple[str, int]]:
        for number in range(blocks):
            try:
                text = next(texts, None)
            except FormatError as error:
                missing.append(error)
                return
            if text is None:
                missing.append(UnfinishedError(f"only {number} of {blocks} blocks are there"))
                return
            yield text, number

    if workers > 1 and blocks >= engine.least * workers:
        said = engine.share(engine, workers, header, there())
    else:
        said = here(engine, header, there())
    with closing(said):
        for reason in said:
            if reason is not None:
                raise CertificateError(reason)
    if missing:  # a block that does not hold has already been refused above
        raise missing[0]


COMPACT = LineKind(
    format="exactfold compact certificate",
    versions=(CHAMBERS, ROOTS),
    names="format version pattern evidence provenance",
    claims=CountClaims,
    check=check_lines,
    summary=summary,
    engine=INTEGERS,
)
"""All branches of a triangulated sheet, line by line (docs/certificate.md)."""
