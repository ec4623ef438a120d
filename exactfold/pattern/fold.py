"""Reads triangulated sheets in FOLD 1.2 files, every number exactly; `fold_writing` writes them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import nullcontext
from dataclasses import dataclass, field
from fractions import Fraction
from os import PathLike
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

from exactfold._support.notebook import Picture
from exactfold._support.plurals import counted
from exactfold.errors import (
    FoldError,
    InputError,
    MissingCoordinatesError,
    NotFoldError,
)
from exactfold.exact.numbers import over_common_denominator, shown, snap
from exactfold.pattern.crease_pattern import CreasePattern, Edge, Point
from exactfold.pattern.drawing.bounds import check_common_denominator, check_coordinates, read_bytes
from exactfold.pattern.drawing.formats.fold_json import (
    SURDS_KEY,
    components,
    exact_points,
    fold_document,
    index_lists,
    list_at,
)
from exactfold.pattern.validate import rounded_to

OTHER_FORMATS: Final = {
    ".cp": "a CP file (a list of creases, as ORIPA and Oriedita write it)",
    ".opx": "an OPX file (of ORIPA)",
    ".ori": "an ORI file (of Oriedita)",
    ".orh": "an ORH file (of Orihime)",
    ".svg": "an SVG drawing",
}
"""Other formats of crease patterns, which this module does not read, by file name ending."""

ASSIGNMENTS: Final = "MVFUBCJ"
_ONLY_TOP: Final = "; only the top-level frame is read, and `file_frames` is ignored"


@dataclass(frozen=True)
class FoldFile(Picture):
    """The pattern in a FOLD file, and how it was read.

    `snapped` is the largest change of a coordinate by snapping (0 without snapping). `exact` says
    whether the coordinates came from `vertices_exactfold:coords`. `assignment` holds the letters of
    `edges_assignment` by edge (i, j) with i < j; it is empty if the file has none.
    """

    pattern: CreasePattern
    snapped: Fraction = Fraction(0)
    exact: bool = False
    assignment: Mapping[Edge, str] = field(default_factory=dict, hash=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "assignment", MappingProxyType(dict(self.assignment)))

    def __reduce__(self) -> tuple[object, ...]:
        return FoldFile, (self.pattern, self.snapped, self.exact, dict(self.assignment))

    def __repr__(self) -> str:
        letters = f", {len(self.assignment)} letters" if self.assignment else ""
        exact = ", exact coordinates" if self.exact else ""
        moved = ", snapped" if self.snapped else ""
        return f"<FoldFile: {self.pattern!r}{letters}{exact}{moved}>"


def read_fold(path: str | PathLike[str], snap: int | None = None) -> CreasePattern:
    """The crease pattern in a FOLD file; `load_fold` also says how far snapping moved a vertex."""
    return load_fold(path, snap).pattern


def load_fold(
    path: str | PathLike[str], snap: int | None = None, *, name: str | None = None
) -> FoldFile:
    """Reads a FOLD file as `parse_fold` reads its text; also raises `UnreadableFileError`.

    Messages begin with `name`, which is the path of the file by default.

    >>> from exactfold.pattern.data import example_path
    >>> load_fold(example_path("two-vertex")).pattern
    <CreasePattern: 2 interior and 4 boundary vertices>
    """
    raw = read_bytes(path)
    try:
        return parse_bytes(raw, str(path), snap)
    except InputError as error:
        error.args = (f"{str(path) if name is None else name}: {error}",)
        raise


def parse_bytes(raw: bytes, name: str, snap: int | None = None) -> FoldFile:
    """Reads the bytes of a file as `parse_fold` does; raises `NotFoldError` if they are not UTF-8.

    If the ending of `name` belongs to another format of crease patterns, the message names this
    format.
    """
    try:
        return parse_fold(_decoded(raw), snap)
    except NotFoldError as error:
        format_ = OTHER_FORMATS.get(Path(name).suffix.lower())
        if format_ is None:
            raise
        raise type(error)(f"this is {format_}, but only FOLD files are read here") from None


def _decoded(raw: bytes) -> str:
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise NotFoldError(f"not UTF-8 text: byte {error.start} is not valid") from None


def parse_fold(text: str, snap: int | None = None) -> FoldFile:
    """The crease pattern in the text of a FOLD 1.2 file (its top-level frame).

    Numbers are read from their text, so that 0.1 is 1/10. If `vertices_exactfold:coords` holds
    "p/q" pairs, these are used; they must agree with `vertices_coords` up to 1e-9 of the largest
    coordinate. Coordinates have two components, or three with the same z for all vertices. With
    `snap`, every coordinate is rounded to a multiple of 1/snap before anything is checked.

    The faces come from `faces_vertices`. If this key is absent or empty, they are traced in the
    planar graph `edges_vertices`. If both keys are present, each edge must be a side of a face;
    sides that are not listed as edges are folds like any other. Assignments do not change the
    pattern, but an edge between two faces must not be a cut "C" or a boundary "B".

    Raises `NotFoldError`, `NumberError`, a subclass of `FoldError`, `TooLargeError`, or one of
    the `PatternError`s of `CreasePattern`; the message names the vertex, edge or face.

    >>> file = parse_fold('{"vertices_coords": [[0, 0], [0.5, 0], [0, 0.1]],'
    ...                   ' "edges_vertices": [[0, 1], [1, 2], [2, 0]]}')
    >>> file.pattern.vertices[2]
    (Fraction(0, 1), Fraction(1, 10))
    """
    document = fold_document(text)
    frames = _ONLY_TOP if document.get("file_frames") else ""
    points, largest, exact = _points(document, snap, frames)
    edges = index_lists(document, "edges_vertices", "edge", len(points))
    faces = index_lists(document, "faces_vertices", "face", len(points))
    if not edges and not faces:
        raise NotFoldError(f"the file has no `faces_vertices` and no `edges_vertices`{frames}")
    for k, edge in enumerate(edges):
        if len(edge) != 2:
            raise NotFoldError(f"edge {k} has {len(edge)} ends: {shown(edge)}")
    letters = _letters(document, len(edges))
    pairs = [(edge[0], edge[1]) for edge in edges]
    with nullcontext() if snap is None or not largest else rounded_to(snap):
        pattern = _pattern(points, pairs, faces)
    return FoldFile(pattern, largest, exact, _assignment(pattern, pairs, letters))


def _pattern(
    points: Sequence[Point], edges: Sequence[Edge], faces: Sequence[tuple[int, ...]]
) -> CreasePattern:
    """The pattern with the given faces; if there are none, the planar graph is traced."""
    rebuilt = not faces
    if rebuilt:
        from exactfold.pattern.planar import trace_faces  # here: most files list their faces

        flat, _ = over_common_denominator(x for point in points for x in point)
        faces = trace_faces(list(zip(flat[::2], flat[1::2], strict=True)), edges)
    for k, face in enumerate(faces):
        _check_triangle(k, face, rebuilt)
    return CreasePattern(points, faces)


# --- coordinates ---------------------------------------------------------------------------------


def _points(
    document: Mapping[str, Any], denominator: int | None, frames: str
) -> tuple[list[Point], Fraction, bool]:
    if document.get(SURDS_KEY):
        raise FoldError(
            f"coordinates have square roots (`{SURDS_KEY}`): only sheets of panels may have them"
        )
    rows = list_at(document, "vertices_coords")
    if not rows:
        raise MissingCoordinatesError(f"`vertices_coords` is missing or empty{frames}")
    stated = [components(v, row) for v, row in enumerate(rows)]
    exact = exact_points(document, stated)
    points = stated
    if exact:
        points = [(x, y, z) for (x, y), (_, _, z) in zip(exact, stated, strict=True)]
    largest = Fraction(0)
    if denominator is not None:
        moved = [tuple(snap(c, denominator) for c in point) for point in points]
        changes = zip(points, moved, strict=True)
        largest = max(abs(a - b) for p, q in changes for a, b in zip(p, q, strict=True))
        points = [(x, y, z) for x, y, z in moved]
    for v, point in enumerate(points):
        if point[2] != points[0][2]:
            raise FoldError(
                f"vertex {v} has z = {_literal(rows[v])} and vertex 0 has z = {_literal(rows[0])}: "
                "only a flat sheet in a plane z = constant is read"
            )
    flat = [(x, y) for x, y, _ in points]
    check_coordinates(flat)
    check_common_denominator(flat)
    return flat, largest, bool(exact)


def _literal(row: list[Any]) -> str:
    return shown(row[2]) if len(row) > 2 else "0"


# --- edges and faces -----------------------------------------------------------------------------


def _check_triangle(index: int, face: tuple[int, ...], rebuilt: bool) -> None:
    origin = " (rebuilt from the edges)" if rebuilt else ""
    if len(face) > 3:
        raise FoldError(
            f"face {index}{origin} has {len(face)} sides: vertices {shown(face)}; "
            "triangulate the pattern first"
        )
    if len(face) < 3:
        raise NotFoldError(
            f"face {index}{origin} has only {counted(len(face), 'vertex')}: {shown(face)}"
        )


def _letters(document: Mapping[str, Any], count: int) -> list[str]:
    letters = list_at(document, "edges_assignment")
    if letters and len(letters) != count:
        first = min(len(letters), count)
        raise NotFoldError(
            f"`edges_assignment` has {len(letters)} letters for {count} edges: "
            f"edge {first} has {'no letter' if first < count else 'a letter but no ends'}"
        )
    for k, letter in enumerate(letters):
        if not isinstance(letter, str) or len(letter) != 1 or letter not in ASSIGNMENTS:
            raise NotFoldError(
                f"edge {k} has the assignment {shown(letter)}, not one of {', '.join(ASSIGNMENTS)}"
            )
    return letters


def _assignment(
    pattern: CreasePattern, edges: Sequence[Edge], letters: Sequence[str]
) -> Mapping[Edge, str]:
    sides = [(i, j) if i < j else (j, i) for i, j in edges]
    known, rim = set(pattern.edges), set(pattern.boundary_edges)
    assignment = dict(zip(sides, letters, strict=True)) if letters else {}
    cuts = [edge for edge, letter in assignment.items() if letter in "BC"]
    if known.issuperset(sides) and len(assignment) in (0, len(sides)) and rim.issuperset(cuts):
        return assignment
    assignment = {}
    for k, edge in enumerate(sides):
        i, j = edges[k]
        if edge not in known:
            raise FoldError(f"edge {k} ({i}-{j}) is not a side of any face")
        if not letters:
            continue
        letter = letters[k]
        if letter in "BC" and edge not in rim:
            kind = "a cut" if letter == "C" else "a boundary"
            raise FoldError(
                f"edge {k} ({i}-{j}) lies between two faces but is assigned {letter}, {kind}"
            )
        if assignment.setdefault(edge, letter) != letter:
            raise NotFoldError(
                f"edge {k} ({i}-{j}) is assigned {letter}, but {assignment[edge]} before"
            )
    return assignment
