"""Branches out of compact certificates."""

from __future__ import annotations

import os
from collections.abc import Iterator

from exactfold.branches.branch import Branch
from exactfold.branches.classify import vertex_height_rows
from exactfold.branches.named import UPSIDE_DOWN
from exactfold.branches.roots import BoxRoot, Root
from exactfold.certify.box import IsolatingBox
from exactfold.checker.compact_blocks import CompactSheet
from exactfold.checker.compact_lines import lines, read_header
from exactfold.checker.equations import read_chart
from exactfold.checker.formats import UNPROVED
from exactfold.checker.reading import MALFORMED, CertificateError, FormatError, require
from exactfold.errors import CertificateFormatError, ExactfoldError, UnreadableFileError
from exactfold.exact.numbers import as_rational
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.scale.chambers import Chambers


def read_branches(path: str | os.PathLike[str]) -> Iterator[Branch]:
    """The branches of a compact certificate in the order of the file, one block in memory.

    Reading verifies digests, not claims: that is `check_compact`. Raises `CertificateFormatError`
    for a file of another kind or an altered one, `UnreadableFileError`; `checker.CertificateError`
    where a block is malformed or a root open.
    """
    try:
        with open(path, "rb") as stream:
            yield from _branches(lines(stream))
    except FormatError as error:
        raise CertificateFormatError(f"{path}: {error}") from None
    except (*MALFORMED, ExactfoldError) as error:
        raise CertificateError(f"malformed: {type(error).__name__}: {error}") from None
    except OSError as error:
        raise UnreadableFileError(f"cannot read {path}: {error.strerror}") from None


def _branches(found: Iterator[str]) -> Iterator[Branch]:
    """The branches of the lines of a file."""
    header = read_header(next(found, "{}"))
    known = CompactSheet(header)
    vertices = [(as_rational(x), as_rational(y)) for x, y in header["pattern"]["vertices"]]
    chambers = Chambers.of(CreasePattern(vertices, header["pattern"]["triangles"]))
    chart = read_chart(chambers.evidence()["chart"])
    require(
        read_chart(header["evidence"]["chart"]) == chart
        and [chambers.labels[v] for v in chambers.emptied.interior] == known.emptied.interior,
        "the chart or the emptied sheet is not the one in which exactfold writes branches",
    )
    maker = _Maker(chambers)
    for number in range(known.blocks):
        text = next(found, None)
        if text is None:
            raise FormatError(f"only {number} of {known.blocks} blocks are there")
        block = known.decode(text, number)
        for j in range(known.block):
            if j in block.exact:
                root, letters = block.exact[j]
                require(set(letters) <= set("MVFU"), f"root {block.first + j}: no letters")
                box = IsolatingBox(tuple(root.center), (), root.radius, root.bits)
            else:
                require(block.radii[j] != UNPROVED, f"root {block.first + j} is missing")
                center = tuple(block.center(j, known.size))
                box = IsolatingBox(center, (), 1 << block.radii[j], block.bits)
                letters = known.letters(block, j)
            yield maker.branch(block.first + j, box, letters)


class _Maker:
    """Branches of one pattern from boxes, numbers and letters."""

    def __init__(self, chambers: Chambers) -> None:
        self.chambers = chambers
        self.rows = vertex_height_rows(chambers.pattern, chambers.functionals, chambers.labels)
        self.vertices = [chambers.labels[v] for v in chambers.emptied.interior]
        self.folds = [
            (chambers.labels[i], chambers.labels[j]) for i, j in sorted(chambers.emptied.folds)
        ]
        self.rigid = dict.fromkeys(chambers.pattern.interior, 0)
        self.flat = dict.fromkeys(chambers.pattern.folds, "F")

    def branch(self, number: int, box: IsolatingBox, letters: str) -> Branch:
        """The branch, seen from the side of its positive saddle."""
        root: Root = BoxRoot(box)
        side = root.sign(self.chambers.functionals.saddle)
        signs = [-1 if number >> k & 1 else 1 for k in range(self.chambers.size)]
        if side == -1:
            root, signs = root.mirrored(), [-s for s in signs]
            letters = letters.translate(UPSIDE_DOWN)
        return Branch(
            self.rigid | dict(zip(self.vertices, signs, strict=True)),
            self.flat | dict(zip(self.folds, letters, strict=True)),
            1 << self.chambers.pattern.Vt,
            root,
            "saddle" if side else "either",
            self.rows,
        )
