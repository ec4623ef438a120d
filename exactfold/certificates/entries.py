"""Writes the entries of certificates, without floats: patterns, evidence and roots."""

from __future__ import annotations

import json
import os
from collections.abc import Collection, Iterable, Sequence
from typing import TYPE_CHECKING, Any

from exactfold._support.plurals import counted
from exactfold.checker.core.lines import chained
from exactfold.exact.numbers import format_integer, format_rational
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.writing.fold_writing import write_text
from exactfold.rigidity.equations.branch_system import Chart
from exactfold.rigidity.equations.flat_sheets import FlatSheets
from exactfold.rigidity.rigid_triangles import RigidTriangle
from exactfold.solve.certify.box import IsolatingBox

if TYPE_CHECKING:  # most counts do not need the exact engine
    from exactfold.solve.algebraic.exact_solution import RootClass
    from exactfold.solve.certify.algebraic import AlgebraicProof

Document = dict[str, Any]


class CertificateLines(tuple[str, ...]):
    """A certificate of several lines, each the text of a JSON object.

    >>> CertificateLines(["{}", "{}"])
    <CertificateLines: 2 lines>
    """

    __slots__ = ()

    @property
    def text(self) -> str:
        """The text of the file: each line has a digest that chains it to the line before."""
        return chained(self)

    def __repr__(self) -> str:
        return f"<CertificateLines: {counted(len(self), 'line')}>"


def pattern_document(pattern: CreasePattern) -> Document:
    """The exact vertices and the triangles of a pattern."""
    return {
        "vertices": [[format_rational(x), format_rational(y)] for x, y in pattern.vertices],
        "triangles": [list(t) for t in pattern.triangles],
    }


def emptied_evidence(pattern: CreasePattern, curved: Collection[int] = ()) -> list[Document]:
    """Each triangulated triangle by its corners and the vertices inside, without stresses.

    A triangle with one of the vertices `curved` inside is left out, because it is not flat.
    """
    return [
        {"corners": list(corners), "inside": list(inside)}
        for corners, inside in pattern.triangulated_triangles
        if not set(curved) & set(inside)
    ]


def triangle_evidence(triangles: Iterable[RigidTriangle]) -> list[Document]:
    """The triangulated triangles with their definite stresses."""
    return [
        {
            "corners": list(t.corners),
            "inside": list(t.inside),
            "multipliers": [format_rational(m) for m in t.multipliers],
        }
        for t in triangles
    ]


def chart_evidence(chart: Chart, labels: Sequence[int]) -> Document | None:
    """None for the chart `saddle = 1`, else the weights of the functional that equals 1.

    The weights are given by vertex, without pinned vertices, whose heights are 0. `labels` has the
    names of the vertices in the certificate.
    """
    system = chart.branch_system
    if chart.is_saddle:
        return None
    free = {labels[v]: c for v, c in chart.functional.items() if v not in system.pinned}
    return {str(v): format_rational(c) for v, c in sorted(free.items())}


def box_entry(box: IsolatingBox) -> Document:
    """An isolating box; the imaginary parts of its centre, if there are any, follow the real."""
    return {
        "bits": box.bits,
        "radius": format_integer(box.radius),
        "center": [format_integer(m) for m in (*box.real, *box.imag)],
    }


def algebraic_evidence(proof: AlgebraicProof, labels: Sequence[int]) -> dict[str, Any]:
    """The evidence for exact classes; `labels` has the names of vertices in the certificate."""
    return {
        "multipliers": [format_rational(m) for m in proof.multipliers],
        "separating": list(proof.classes[0][0].separating) if proof.classes else [],
        "classes": [
            {
                "polynomial": [format_integer(c) for c in root_class.polynomial],
                "numerators": [[format_rational(c) for c in w] for w in root_class.numerators],
                "flat": [labels[v] for v in flat],
            }
            for root_class, flat in proof.classes
        ],
    }


def flat_box_entry(sheets: FlatSheets, box: IsolatingBox, labels: Sequence[int]) -> dict[str, Any]:
    """A root that lies in a box on flat sheets."""
    return {"flat": sorted(labels[v] for v in sheets.vertices), **box_entry(box)}


def class_entry(
    proof: AlgebraicProof, root_class: RootClass, index: int, bits: int = 64
) -> dict[str, Any]:
    """The `index`-th real root of a class of the proof."""
    number = next(k for k, (c, _) in enumerate(proof.classes) if c is root_class)
    interval = root_class.real_roots(bits)[index]
    return {"class": number, "interval": [format_rational(x) for x in interval]}


def write_certificate(
    certificate: Document | CertificateLines, path: str | os.PathLike[str]
) -> None:
    """Write a certificate; if this fails, no part of it is left. Raises `UnwritableFileError`."""
    write_text(path, certificate_text(certificate))


def certificate_text(certificate: Document | tuple[str, ...]) -> str:
    """The text of the file of a certificate, or of its lines."""
    if isinstance(certificate, tuple):
        return CertificateLines(certificate).text
    return json.dumps(certificate, separators=(",", ":")) + "\n"
