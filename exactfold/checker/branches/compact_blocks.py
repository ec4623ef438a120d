"""The blocks of a compact certificate, and the tests of their roots.

Root number s lies in a box with exactly one zero, by Krawczyk's test. On the whole box the sign
functional of the k-th foldable vertex is negative if bit k of s is set, and positive if it is not.
So the 2^n zeros differ from each other without any comparison. By refined Bezout these are all
zeros of n quadrics in P^n, and all are simple and real.

A block has these keys; texts are bytes in base 64:

  block    its number k, from 0; it holds the roots number k * block to (k + 1) * block - 1
  bits     centres and radii are in units of 2^-bits; at most 52
  width    of an integer in `centers`, in bytes
  centers  for each root n integers, little-endian, two's complement
  radii    for each root one byte r: the radius is 2^r units; 255 means: see `exact`
  folds    a bit for every fold of the pattern without rigid parts, 1 for a valley, 0 for a
           mountain, lowest bit first, filled up to whole bytes for each root
  exact    roots that need more: `root` (its place in the block), `bits`, `radius`, `center`, and
           `assignment` with the letters M, V, F, or U (undecided: nothing is claimed); at most 4000
           bits and numbers of 4000 digits
  open     [place, reason] of roots that were not proved; a file with such roots proves nothing
           about the number of branches and has no claims
"""

from __future__ import annotations

import base64
import binascii
from collections.abc import Sequence
from typing import Any, NamedTuple

from ..core.krawczyk import Krawczyk
from ..core.limits import MOST_BLOCK, MOST_DIGITS, MOST_UNITS, MOST_UNKNOWNS, MOST_WIDTH
from ..core.lines import read_object
from ..core.reading import CertificateError, at_most, items, keys, natural, require, text_of
from ..sheets.boxes import Box, read_box
from ..sheets.equations import BranchSystem, read_chart
from ..sheets.flat_folds import close_flat
from ..sheets.sheet import facts_of, read_sheet
from ..sheets.stress import check_triangles
from .listing import CountClaims, agrees, counts_of, digit

UNPROVED = 255
"""The radius byte of a root that the block gives under "exact" instead."""


class Block(NamedTuple):
    """The decoded contents of one block, root after root."""

    first: int
    bits: int
    width: int
    centers: bytes
    radii: bytes
    folds: bytes
    exact: dict[int, tuple[Box, str]]

    def center(self, index: int, size: int) -> list[int]:
        """The centre of a root of the block, in units of 2^-bits."""
        width, start = self.width, index * size * self.width
        return [
            int.from_bytes(self.centers[k : k + width], "little", signed=True)
            for k in range(start, start + size * width, width)
        ]


class CompactSheet:
    """The verified sheet of a header, and everything that the tests of its roots need."""

    def __init__(self, header: dict[str, Any]) -> None:
        evidence = header["evidence"]
        keys(evidence, "kind triangles chart block", "evidence")
        require(evidence["kind"] == "chambers", "unknown kind of evidence")
        faces, vertices = (len(header["pattern"][k]) for k in ("triangles", "vertices"))
        require(  # by Euler's formula; so the boundary is known to be short before it is walked
            faces == 2 * vertices - 6 > 2,
            "the sheet does not have four boundary vertices and an interior vertex",
        )
        self.sheet, self.sha256 = read_sheet(header["pattern"])
        require(len(self.sheet.boundary) == 4, "the sheet does not have four boundary vertices")
        self.emptied = check_triangles(self.sheet, evidence["triangles"])
        self.system = BranchSystem(self.emptied, read_chart(evidence["chart"]))
        self.size = self.system.size
        require(self.size > 0, "the number of unknowns is out of range")
        at_most(self.size, MOST_UNKNOWNS, "the unknowns", "MOST_UNKNOWNS")
        self.block = natural(evidence["block"], "block")
        at_most(self.block, MOST_BLOCK, "the roots in a block", "MOST_BLOCK")
        require(
            self.block > 0 and (1 << self.size) % self.block == 0,
            "the size of a block does not divide the number of roots",
        )
        self.blocks = (1 << self.size) // self.block
        self.krawczyk = Krawczyk(self.system)
        self.vertex_rows = [
            self.system.row(self.emptied.sign_of_vertex(v)) for v in self.emptied.interior
        ]
        self.fold_rows = [self.system.row(self.emptied.bend(f)) for f in self.emptied.folds]
        self.letter_bytes = (len(self.fold_rows) + 7) // 8

    def claims(self) -> CountClaims:
        """The claims that a complete file proves."""
        counts = counts_of(1 << self.size, 1 << len(self.sheet.interior))
        return {**facts_of(self.sheet, self.sha256), **counts}

    def decode(self, text: str, number: int) -> Block:
        """Decode the block of a line, which must be block `number`."""
        what = f"block {number}"
        data = read_object(text, what)
        keys(data, "block bits width centers radii folds exact open", what)
        require(
            type(data["block"]) is int and data["block"] == number,
            f"{what} is expected, but here is block {data['block']!a}",
        )
        bits, width = natural(data["bits"], "bits"), natural(data["width"], "width")
        require(bits <= MOST_UNITS and 0 < width <= MOST_WIDTH, f"{what} is out of range")
        first = number * self.block
        for entry in items(data["open"], "open"):
            index, reason = items(entry, "open root", 2)
            raise CertificateError(f"root {first + index} is open: {reason!a}")
        parts = []
        for name, length in (("centers", self.size * width), ("radii", 1), ("folds", 0)):
            try:
                part = base64.b64decode(data[name], validate=True)
            except (binascii.Error, TypeError, ValueError):
                raise CertificateError(f"{what}: {name} is not base 64") from None
            length = length or self.letter_bytes
            require(len(part) == self.block * length, f"{what}: {name} has another length")
            parts.append(part)
        exact: dict[int, tuple[Box, str]] = {}
        for entry in items(data["exact"], "exact"):
            keys(entry, "root bits radius center assignment", "exact root")
            index = natural(entry["root"], "root")
            require(index < self.block, f"{what} has no root {index}")
            require(index not in exact, f"root {first + index} is given twice")
            box = read_box({k: entry[k] for k in ("bits", "radius", "center")}, self.size)
            require(
                box.bits <= MOST_DIGITS
                and all(len(text) <= MOST_DIGITS for text in (entry["radius"], *entry["center"])),
                f"root {first + index} is out of range",
            )
            exact[index] = (box, text_of(entry["assignment"]))
        centers, radii, folds = parts
        return Block(first, bits, width, centers, radii, folds, exact)

    def check_block(self, block: Block, done: Sequence[bool] | None = None) -> None:
        """Verify every root of a block that is not marked in `done`; raises `CertificateError`."""
        for index in range(self.block):
            given = index in block.exact
            what = f"root {block.first + index}"
            require(
                given == (block.radii[index] == UNPROVED), f"{what} is given twice or not at all"
            )
            if given:
                root, letters = block.exact[index]
                self.check_root(root, block.first + index, letters)
            elif done is None or not done[index]:
                require(block.radii[index] <= MOST_UNITS, f"{what}: no such radius")
                center = block.center(index, self.size)
                root = Box(center, 1 << block.radii[index], block.bits)
                self.check_root(root, block.first + index, self.letters(block, index))

    def letters(self, block: Block, index: int) -> str:
        """The assignment of a root: a fold is V if its bit is set, else M."""
        start = index * self.letter_bytes
        bits = int.from_bytes(block.folds[start : start + self.letter_bytes], "little")
        require(not bits >> len(self.fold_rows), "a bit of no fold is set")
        return "".join("MV"[bits >> k & 1] for k in range(len(self.fold_rows)))

    def check_root(self, root: Box, number: int, letters: str) -> None:
        """Raise unless the box holds one regular zero with the right vertex signs and letters.

        The bits of `number` give the vertex signs.
        """
        self.krawczyk.check(root.center, root.radius, root.bits)
        for k, row in enumerate(self.vertex_rows):
            vertex, sign = self.emptied.interior[k], -1 if number >> k & 1 else 1
            shown = f"root {number}: vertex {vertex} does not have the sign {sign}"
            require(root.sign(row) == sign, shown)
        signs = {
            f: root.sign(row) for f, row in zip(self.emptied.folds, self.fold_rows, strict=True)
        }
        if None in signs.values():
            close_flat(self.emptied, signs)
        proved = "".join("MFVU"[1 + digit(signs[f])] for f in self.emptied.folds)
        require(agrees(letters, proved), f"root {number}: folds are {proved}, not {letters}")
