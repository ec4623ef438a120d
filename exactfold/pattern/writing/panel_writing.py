"""Writes FOLD files of sheets with any panels; reading them gives the identical sheet."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from exactfold._support.plurals import counted
from exactfold.errors import FoldError
from exactfold.exact.surds import rational
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.drawing.formats.fold_surds import surd_keys
from exactfold.pattern.opening import Opened, panels
from exactfold.pattern.panel_pattern import Edge, PanelPattern
from exactfold.pattern.triangulating.panels import triangulating_edges
from exactfold.pattern.writing.fold_writing import ANGLES, coordinate_keys, double, headed_document

_FOLDS = frozenset("MVFUJ")


@dataclass(frozen=True)
class Converted:
    """A sheet ready to be written: panels in order, letters of all edges, added edges (as J)."""

    pattern: PanelPattern
    letters: Mapping[Edge, str]
    faces: tuple[tuple[int, ...], ...]
    joins: tuple[Edge, ...] = ()

    def __repr__(self) -> str:
        return f"<Converted: {self.pattern!r}, {counted(len(self.joins), 'edge')} added>"

    def document(self, title: str | None = None) -> dict[str, Any]:
        """The sheet as a FOLD 1.2 object, ready for `json.dumps`.

        `vertices_coords` has the nearest doubles. Exact rational numbers stand in
        `vertices_exactfold:coords`, others in `vertices_exactfold:surds` with
        `frame_exactfold:field` (see `surd_keys`). Raises `NotApplicableError` if a coordinate is
        beyond the range of doubles.
        """
        pattern = self.pattern
        points = pattern.vertices
        if pattern.field.radicands:
            keys: dict[str, Any] = {
                "vertices_coords": [
                    [double(v, x), double(v, y)] for v, (x, y) in enumerate(points)
                ],
                **surd_keys(points),
            }
        else:
            keys = coordinate_keys([(rational(x), rational(y)) for x, y in points])
        return headed_document(title) | {
            **keys,
            "edges_vertices": [list(edge) for edge in pattern.edges],
            "edges_assignment": [self.letters[edge] for edge in pattern.edges],
            "edges_foldAngle": [ANGLES[self.letters[edge]] for edge in pattern.edges],
            "faces_vertices": [list(face) for face in self.faces],
        }


def converted(opened: Opened, *, triangulate: bool = False) -> Converted:
    """Prepares an opened sheet for writing; with `triangulate`, panels are cut into triangles.

    Boundary edges get the letter B. Folds get the letters of the file, or U if it gives none. The
    edges that cut panels into triangles get the letter J. When the file is read as a drawing, J
    edges join the triangles, so that the sheet is the same as before. But a file of triangles with
    rational corners is read unchanged, and then its J edges may bend.

    >>> square = PanelPattern([(0, 0), (2, 0), (2, 2), (0, 2)], [(0, 1), (1, 2), (2, 3), (3, 0)])
    >>> made = converted(Opened(square), triangulate=True)
    >>> made.joins, made.document()["edges_assignment"]
    (((1, 3),), ['B', 'B', 'B', 'J', 'B'])
    """
    sheet = opened.sheet
    pattern = panels(sheet) if isinstance(sheet, CreasePattern) else sheet
    joins = triangulating_edges(pattern) if triangulate else ()
    if joins:
        pattern = PanelPattern(pattern.vertices, (*pattern.edges, *joins), pattern.holes)
        if any(len(face) > 3 for face in pattern.faces):
            raise FoldError("a panel could not be cut into triangles")
    faces = sheet.triangles if isinstance(sheet, CreasePattern) else pattern.faces
    return Converted(pattern, _letters(pattern, opened.assignment, joins), faces, joins)


def _letters(
    pattern: PanelPattern, stated: Mapping[Edge, str], joins: Iterable[Edge]
) -> dict[Edge, str]:
    letters = {edge: stated.get(edge, "U") for edge in pattern.edges}
    letters = {edge: letter if letter in _FOLDS else "U" for edge, letter in letters.items()}
    letters.update(dict.fromkeys(pattern.boundary_edges, "B"))
    letters.update(dict.fromkeys(joins, "J"))
    return letters
