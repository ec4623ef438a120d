"""Draws figures of studies with Matplotlib in one style: SVG and PDF for print, SVG for pages."""

from __future__ import annotations

import io
from typing import Any

from exactfold.errors import PackageMissingError
from exactfold.studies.running.study import StudyFigure

STYLE = {
    "font.family": "serif",
    "font.serif": ["STIX Two Text", "STIXGeneral", "DejaVu Serif"],
    "mathtext.fontset": "stix",
    "font.size": 9,
    "axes.labelsize": 9,
    "legend.fontsize": 8,
    "legend.frameon": False,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.6,
    "lines.linewidth": 1.2,
    "lines.markersize": 4,
    "errorbar.capsize": 2,
    "axes.prop_cycle": "cycler('color', ['#365c8d', '#e07b39', '#1fa187', '#7b3294'])",
    "axes.formatter.min_exponent": 3,
    "svg.fonttype": "path",
    "svg.hashsalt": "exactfold",
    "pdf.fonttype": 42,
    "figure.constrained_layout.use": True,
}
"""The style of all figures; the salt makes the files of equal figures equal."""


def check_figures() -> None:
    """Raises `PackageMissingError` unless figures can be drawn."""
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        raise PackageMissingError(
            "pictures of studies need Matplotlib: pip install 'exactfold[study]'"
        ) from None


def drawn(figure: StudyFigure, kind: str = "svg") -> bytes:
    """A figure as a file of the kind "svg", "pdf" or "png", without a date.

    A legend beside the axes names everything that is drawn with a label, where it hides nothing.
    Raises `PackageMissingError`.
    """
    check_figures()
    import matplotlib as mpl
    from matplotlib.figure import Figure

    with mpl.rc_context(STYLE):
        sheet = Figure(figsize=(figure.width, figure.height))
        axes: Any = sheet.subplots(*figure.panels)
        figure.draw(axes if figure.panels == (1, 1) else list(axes.flat))
        for each in sheet.axes:
            _name_beside(each)
        out = io.BytesIO()
        dates = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}.get(kind, {})
        sheet.savefig(out, format=kind, dpi=200, metadata=dates)
    return out.getvalue()


def _name_beside(axes: Any) -> None:
    """Puts the legend of axes to their right."""
    handles, labels = axes.get_legend_handles_labels()
    if handles:
        order = sorted(range(len(labels)), key=lambda k: _number_in(labels[k]))
        axes.legend(
            [handles[k] for k in order],
            [labels[k] for k in order],
            loc="upper left",
            bbox_to_anchor=(1.0, 1.0),
        )


def _number_in(label: str) -> int:
    """The size that a label names; 0 for a label without a size, which keeps its place."""
    digits = label.removeprefix("$V_i = ").removesuffix("$")
    return int(digits) if digits.isdecimal() else 0
