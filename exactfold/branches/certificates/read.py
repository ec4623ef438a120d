"""Branches out of compact certificates."""

from __future__ import annotations

import os
from collections.abc import Iterator

from exactfold.branches.values.branch import Branch
from exactfold.branches.values.classify import BranchMaker
from exactfold.branches.values.roots import BoxRoot
from exactfold.certificates.entries import chart_evidence
from exactfold.checker.branches.compact import COMPACT
from exactfold.checker.branches.compact_blocks import UNPROVED, CompactSheet
from exactfold.checker.core.lines import lines
from exactfold.checker.core.reading import MALFORMED, CertificateError, FormatError, require
from exactfold.checker.sheets.equations import read_chart
from exactfold.errors import CertificateFormatError, ExactfoldError, UnreadableFileError
from exactfold.exact.numbers import as_rational
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.rigidity.equations.problem import Problem
from exactfold.solve.certify.box import IsolatingBox


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
    header = COMPACT.header(next(found, "{}"))
    known = CompactSheet(header)
    vertices = [(as_rational(x), as_rational(y)) for x, y in header["pattern"]["vertices"]]
    problem = Problem.of(CreasePattern(vertices, header["pattern"]["triangles"]))
    chart = read_chart(chart_evidence(problem.chart, problem.labels))
    require(
        read_chart(header["evidence"]["chart"]) == chart
        and list(problem.foldable) == known.emptied.interior,
        "the chart or the sheet without rigid parts is not that in which branches are written",
    )
    maker = BranchMaker(problem, problem.chart)
    size = range(problem.size)
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
            signs = [-1 if block.first + j >> k & 1 else 1 for k in size]
            yield maker.branch(BoxRoot(box, system=problem.chart.system), signs, letters)
