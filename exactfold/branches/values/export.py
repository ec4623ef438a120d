"""`export_branch`: a branch as a FOLD file whose fold angles keep simulators on the branch."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from exactfold._support.verdict import PROVED, Verdict
from exactfold.branches.values.angles import Bounds, FoldAngles
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.second_order import second_order_sheet
from exactfold.errors import UndecidedBranchError, UsageError
from exactfold.exact.numbers import format_rational, shown
from exactfold.interop.fold_frames import branch_document
from exactfold.interop.sheet_files import ENDINGS as SHEET_ENDINGS
from exactfold.interop.sheet_files import FOLD_ENDINGS, write_sheet
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.writing.fold_writing import checked_target, document_text, write_text

if TYPE_CHECKING:
    from exactfold.pattern.panel_pattern import PanelPattern

AMOUNT = 30.0
"""The largest fold angle in degrees: visible, and still close to the unfolded state."""

ENDINGS: Final = (*FOLD_ENDINGS, *SHEET_ENDINGS, ".csv")


@dataclass(frozen=True, repr=False)
class BranchExport:
    """A branch as `export_branch` writes it, or a way of rigid panels (`exported_way`).

    `pattern` is its sheet, and `letters` are its mountains and valleys. `document` is the FOLD
    object, and `text` is its JSON. `angles` are degrees by fold, as written. `length_error` is the
    largest relative change of the length of an edge in the frame in space.
    """

    pattern: CreasePattern | PanelPattern = field(repr=False)
    letters: Mapping[Edge, str] = field(repr=False)
    document: Mapping[str, Any]
    angles: Mapping[Edge, float]
    length_error: float
    status: Verdict

    @property
    def text(self) -> str:
        """The text of the file."""
        return document_text(self.document)

    def __repr__(self) -> str:
        name = self.document.get("file_title", "branch")
        return f"<BranchExport: {self.status}, {name}, {len(self.angles)} folds>"

    def write(self, path: str | PathLike[str]) -> None:
        """Write the whole file or nothing, in the format that its ending names.

        ".fold" and ".json" are FOLD. ".dxf" is the crease pattern with the letters of the branch,
        ".obj" and ".stl" are the sheet in space, and ".csv" is a table of letters and angles by
        fold (docs/viewer.md, The file). Raises `UsageError` for any other ending,
        `UnwritableFileError`, and `PackageMissingError`.
        """
        ending = checked_target(Path(path), ENDINGS, "a branch")
        if ending in FOLD_ENDINGS:
            write_text(path, self.text)
        elif ending == ".csv":
            rows = [
                f"{i}-{j},{self.letters[i, j]},{angle!r}" for (i, j), angle in self.angles.items()
            ]
            write_text(path, "\n".join(["fold,letter,degrees", *rows]) + "\n")
        else:
            [frame] = self.document["file_frames"]
            coords = np.array(frame["vertices_coords"], dtype=np.float64)
            write_sheet(self.pattern, self.letters, path, coords=coords)


def export_branch(
    branch: Branch,
    path: str | PathLike[str],
    *,
    amount: float = AMOUNT,
    title: str | None = None,
    force: bool = False,
) -> BranchExport:
    """Write a branch as a FOLD 1.2 file that Origami Simulator and Rabbit Ear open.

    With another ending the file has another format: see `BranchExport.write`.

    `edges_foldAngle` is proportional to the first-order fold angles f_e(h) L_e / (c c') of the
    branch (`fold_angles`), and the largest has the size of `amount` degrees. A second frame is the
    sheet in space at that amplitude, to second order (docs/viewer.md, The file). `title` names
    the pattern in the file. Returns what was written.

    Raises `UndecidedBranchError` for a branch that is not proved; `force` allows it if its heights
    are known. Raises `UsageError` unless 0 < amount <= 180, `NotApplicableError` for lengths that
    floats cannot represent, and `UnwritableFileError`.

    >>> import os, tempfile, exactfold
    >>> pattern = exactfold.pattern.families.two_vertex()
    >>> branch = exactfold.branch(pattern, "-+")
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     written = export_branch(branch, os.path.join(folder, "branch.fold"))
    ...     exactfold.pattern.read_fold(os.path.join(folder, "branch.fold")) == pattern
    True
    >>> round(written.angles[1, 4], 1), round(written.angles[1, 5], 1), branch.assignment_text
    (30.0, -1.2, 'VVMMVVM')
    """
    export = exported(branch, amount=amount, title=title, force=force)
    export.write(path)
    return export


def exported(
    branch: Branch,
    *,
    amount: float = AMOUNT,
    title: str | None = None,
    force: bool = False,
) -> BranchExport:
    """What `export_branch` writes, without writing it; raises the same errors except the last.

    >>> import exactfold
    >>> export = exported(exactfold.branch("two-vertex", "++"), amount=10)
    >>> export.document["file_title"], export.document["frame_exactfold:branch"]["status"]
    ('branch ++', 'proved')
    """
    if not isinstance(branch, Branch):
        raise UsageError(
            f"{shown(branch)} is not a branch: the first argument has to be a branch, which "
            "`find_branch` or a count returns; the second is the path"
        )
    _require_writable(branch, force)
    pattern, heights, bends = branch.pattern, branch.heights, branch.fold_angles
    angles = {
        fold: angle if branch.assignment[fold] in "MV" else 0.0
        for fold, angle in bends.degrees(amount).items()
    }
    folded = second_order_sheet(pattern, _raised(pattern, heights, bends, amount))
    document = branch_document(
        pattern,
        branch.assignment,
        angles,
        folded.coords,
        name=f"branch {_brief(branch.sign_text)}",
        title=title,
        facts={
            "vertex_signs": branch.sign_text,
            "vertices": list(pattern.interior),
            "assignment": branch.assignment_text,
            "status": str(branch.status),
            "gauge": branch.gauge,
            "largest_angle": amount,
            "length_error": folded.length_error,
            "pattern": pattern.sha256,
        },
        heights=[
            [format_rational(bound) for bound in heights[v]] for v in range(len(pattern.vertices))
        ],
    )
    return BranchExport(
        pattern, branch.assignment, document, angles, folded.length_error, branch.status
    )


def _require_writable(branch: Branch, force: bool) -> None:
    if not branch.heights:
        raise UndecidedBranchError(
            f"branch {_brief(branch.sign_text)} has no heights to write, because nothing is "
            "proved of it"
        )
    if branch.status is not PROVED and not force:
        raise UndecidedBranchError(
            f"branch {_brief(branch.sign_text)} is not proved, although its heights are enclosed; "
            "force the export to write it anyway, marked as undecided"
        )


def _raised(
    pattern: CreasePattern, heights: Mapping[int, Bounds], bends: FoldAngles, amount: float
) -> list[Fraction]:
    """The heights at the amplitude of the angles."""
    amplitude = bends.amplitude(amount)
    return [amplitude * sum(heights[v]) / 2 for v in range(len(pattern.vertices))]


def _brief(signs: str, most: int = 60) -> str:
    return signs if len(signs) <= most else f"{signs[:most]}... ({len(signs)} signs)"
