"""Reads the branches of certificates that hold all branches of a sheet."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from typing import Any

from exactfold.branches.certificates.roots import Roots
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.classify import BranchMaker
from exactfold.branches.values.roots import BoxRoot
from exactfold.certificates.entries import CertificateLines, Document, chart_evidence
from exactfold.checker import load
from exactfold.checker.branches.compact import COMPACT, ROOTS
from exactfold.checker.branches.compact_blocks import UNPROVED, CompactSheet
from exactfold.checker.branches.compact_roots import gathered
from exactfold.checker.branches.listing import LISTING
from exactfold.checker.command import kind_in_lines
from exactfold.checker.core.limits import MOST_BYTES
from exactfold.checker.core.lines import lines
from exactfold.checker.core.reading import (
    MALFORMED,
    CertificateError,
    FormatError,
    at_most,
    require,
)
from exactfold.checker.sheets.equations import read_chart
from exactfold.errors import CertificateFormatError, ExactfoldError, UnreadableFileError
from exactfold.exact.numbers import as_rational
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.rigidity.equations.problem import Problem
from exactfold.solve.certify.box import IsolatingBox


def read_branches(path: str | os.PathLike[str]) -> Iterator[Branch]:
    """Yield the branches of a certificate of all branches, in the order of the file.

    If the file has a root for each sign vector, only one block of it is in memory at a time.
    Certificates in one JSON object, which earlier versions wrote, are read as well. Reading
    verifies digests, not claims; `check_compact` verifies claims. Raises `CertificateFormatError`
    for a file that is of another kind or was altered, `UnreadableFileError`, and
    `checker.CertificateError` if a block is malformed or a root is open.
    """
    try:
        if kind_in_lines(path) is not COMPACT:
            yield from branches_of(read_listing(path))
            return
        with open(path, "rb") as stream:
            yield from _of_lines(lines(stream))
    except FormatError as error:
        raise CertificateFormatError(f"{path}: {error}") from None
    except CertificateFormatError:
        raise
    except (*MALFORMED, ExactfoldError) as error:
        raise CertificateError(f"malformed: {type(error).__name__}: {error}") from None
    except OSError as error:
        raise UnreadableFileError(f"cannot read {path}: {error.strerror}") from None


def read_listing(path: str | os.PathLike[str]) -> Document | CertificateLines:
    """A whole certificate of all branches: its lines, or the JSON object of an earlier version.

    Raises `checker.FormatError` for a file that is of another kind or beyond the limits; `OSError`.
    """
    at_most(
        os.path.getsize(path),
        MOST_BYTES,
        "the bytes of a file that is read as a whole",
        "MOST_BYTES",
    )
    kind = kind_in_lines(path)
    with open(path, "rb") as stream:
        if kind is COMPACT:
            return CertificateLines(lines(stream))
        document = {} if kind else load(stream.read().decode("utf-8", "replace"))
    if document.get("format") != LISTING.format or "kind" in document:
        raise FormatError("this certificate does not list the branches of a triangulated sheet")
    return document


def branches_of(certificate: Document | CertificateLines) -> Iterator[Branch]:
    """The branches of a certificate of all branches, in the order of the file.

    >>> from exactfold.branches.certificates.listing import certificate
    >>> from exactfold.branches.counting.collect import count_branches
    >>> counted = count_branches("two-vertex")
    >>> sorted(branches_of(certificate(counted)), key=Branch.sort_key) == list(counted.branches)
    True
    """
    if isinstance(certificate, CertificateLines):
        return _of_lines(iter(certificate))
    evidence, listed = certificate["evidence"], certificate["claims"]["branches"]
    return _of_roots(certificate["pattern"], evidence, listed)


def _of_lines(texts: Iterator[str]) -> Iterator[Branch]:
    header = COMPACT.header(next(texts, "{}"))
    if header["version"] == ROOTS:
        evidence, listed, _ = gathered(header, texts)
        return _of_roots(header["pattern"], evidence, listed)
    return _of_blocks(header, texts)


def _of_blocks(header: dict[str, Any], texts: Iterator[str]) -> Iterator[Branch]:
    """The branches of a file with a root for each sign vector, from the lines of its blocks."""
    known = CompactSheet(header)
    problem = Problem.of(_pattern(header["pattern"]))
    chart = read_chart(chart_evidence(problem.chart, problem.labels))
    require(
        read_chart(header["evidence"]["chart"]) == chart
        and list(problem.foldable) == known.emptied.interior,
        "the chart or the sheet without rigid parts is not that in which branches are written",
    )
    maker = BranchMaker(problem, problem.chart)
    size = range(problem.size)
    for number in range(known.blocks):
        text = next(texts, None)
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


def _of_roots(
    pattern: Document, evidence: Document, listed: Iterable[Document]
) -> Iterator[Branch]:
    """The branches of a file that lists them one by one, each with its root."""
    if "roots" not in evidence:  # the sheet is rigid, or a single vertex
        return
    problem = Problem.of(_pattern(pattern))
    roots = Roots.of(problem, evidence)
    maker = BranchMaker(problem, roots.chart)
    interior = {v: k for k, v in enumerate(problem.pattern.interior)}
    folds = {fold: k for k, fold in enumerate(problem.pattern.folds)}
    for entry, branch in zip(evidence["roots"], listed, strict=True):
        signs = [_SIGNS[branch["vertex_signs"][interior[v]]] for v in problem.foldable]
        letters = [branch["assignment"][folds[fold]] for fold in maker.folds]
        require(set(letters) <= set("MVFU"), "a branch has no letters")
        multiplicity = branch["multiplicity"] >> problem.pattern.Vt
        yield maker.shown(roots.root(entry), signs, letters, multiplicity)


_SIGNS = {"+": 1, "-": -1, "0": 0}


def _pattern(given: Document) -> CreasePattern:
    vertices = [(as_rational(x), as_rational(y)) for x, y in given["vertices"]]
    return CreasePattern(vertices, given["triangles"])
