"""Reads FOLD files as other programs write them: frames, planes, letters, missing parts."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any, Final

from exactfold._support.plurals import counted
from exactfold.checker.core.limits import LARGEST, MOST_FRAMES, MOST_INHERITED
from exactfold.errors import (
    FoldedStateError,
    MalformedDrawingError,
    MissingCoordinatesError,
    NotFoldError,
    TooLargeError,
)
from exactfold.exact.numbers import shown
from exactfold.pattern.drawing.drawing import LETTERS, Drawing, Line, Loud, Point
from exactfold.pattern.drawing.formats.fold_json import (
    components,
    exact_points,
    fold_document,
    index_lists,
    list_at,
)
from exactfold.pattern.drawing.formats.fold_surds import surd_points
from exactfold.pattern.drawing.formats.unfolding import unfolded

UNFOLD: Final = (
    "give its crease pattern: the unfolded sheet (in Origami Simulator: save at Fold Percent 0)"
)
_HINT: Final = f"{UNFOLD}, or a frame with flat coordinates"
_UNFOLDED: Final = "vertices_flatUnfoldCoords"
"""The key in which `fold-convert --flat-fold` keeps the coordinates of the crease pattern."""
_FLAT: Final = Fraction(1, 10**9)
_SHOWN: Final = 5
_AXES: Final = {"z": (0, 1), "y": (2, 0), "x": (1, 2)}
"""The two coordinates that remain in a plane, counter-clockwise for a viewer on the normal."""


def read_fold_drawing(text: str) -> Drawing:
    """The drawing in a FOLD file of any program; numbers are read exactly, from their text.

    If the top level has flat coordinates, it is read. Otherwise the first flat frame of
    `file_frames` is read, with all that it inherits. Coordinates have two components, or three in a
    plane z, y or x = constant (up to 1e-9 of the size), which is seen from the side of its normal.
    Those of `vertices_flatUnfoldCoords`, which some folded states have, are preferred. If no frame
    is flat, the first folded state whose faces are rigid is unfolded.
    `vertices_exactfold:surds` and `vertices_exactfold:coords` take precedence over
    `vertices_coords` and make the drawing `exact`. Edges without a letter are U. Sides of faces
    that are not listed as edges become lines: B if they belong to one face, else U. Repeated edges
    are kept; if their letters differ, the remarks name them.

    Raises `NotFoldError`, `NumberError`, a subclass of `FoldError`, `MalformedDrawingError`, and
    `FoldedStateError` if all coordinates belong to folded states that cannot be unfolded.

    >>> drawing = read_fold_drawing('{"vertices_coords": [[0, 0, 5], [0.1, 0, 5]],'
    ...                             ' "edges_vertices": [[0, 1]], "edges_assignment": ["m"]}')
    >>> drawing.points[1], drawing.lines, drawing.remarks
    ((Fraction(1, 10), Fraction(0, 1)), (Line(start=0, end=1, letter='M'),),
    ('read 1 lower-case letter as upper case',))
    """
    document = fold_document(text)
    refusals: list[Exception] = []
    folded: list[tuple[Mapping[str, Any], str, FoldedStateError]] = []
    stated = _frames(document)
    for k, chain in enumerate([_chain(stated, k) for k in range(len(stated))]):
        if k >= MOST_FRAMES:
            raise TooLargeError(
                f"none of the first {MOST_FRAMES} frames of {len(stated)} is flat, and the others "
                "are not read: leave out the folded frames"
            )
        frame = _inherited(stated, chain)
        source = _source(document, frame, k)
        try:
            return _drawing(frame, source)
        except FoldedStateError as error:
            folded.append((frame, source, error))
        except MissingCoordinatesError as error:
            refusals.append(error)
    for frame, source, refusal in folded:
        try:
            return _drawing(frame, source, unfold=True)
        except FoldedStateError as reason:
            refusal.args = (f"{refusal}; it cannot be unfolded: {reason}",)
    raise [*(refusal for *_, refusal in folded), *refusals][0]


def _source(document: Mapping[str, Any], frame: Mapping[str, Any], k: int) -> str:
    spec = document.get("file_spec")
    source = "FOLD" if spec is None else f"FOLD {shown(spec).strip(chr(39))}"
    if not k:
        return source
    title = frame.get("frame_title")
    return f"{source}, frame {k}" + (f" ({shown(title)})" if isinstance(title, str) else "")


# --- frames --------------------------------------------------------------------------------------


def _frames(document: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """The top level and the frames, without the keys that they inherit."""
    stated: list[Mapping[str, Any]] = [document]
    for k, frame in enumerate(list_at(document, "file_frames"), 1):
        if not isinstance(frame, dict):
            raise NotFoldError(f"frame {k} in `file_frames` is {shown(frame)}, not an object")
        stated.append(frame)
    return stated


def _chain(stated: Sequence[Mapping[str, Any]], k: int) -> list[int]:
    """A frame, its parent, the parent's parent, and so on, each by its number."""
    chain = [k]
    while chain[-1] and stated[chain[-1]].get("frame_inherit") is True:
        parent = stated[chain[-1]].get("frame_parent", 0)
        if isinstance(parent, bool) or not isinstance(parent, int) or parent in chain:
            raise NotFoldError(f"frame {chain[-1]} cannot inherit from frame {shown(parent)}")
        if not 0 <= parent < len(stated):
            raise NotFoldError(
                f"frame {chain[-1]} inherits from frame {parent}, but the number of frames is "
                f"{len(stated)}"
            )
        if len(chain) > MOST_INHERITED:
            raise TooLargeError(
                f"frame {k} inherits through more than {MOST_INHERITED} frames, which is not "
                "followed: state in the frame what it needs"
            )
        chain.append(parent)
    return chain


def _inherited(stated: Sequence[Mapping[str, Any]], chain: Sequence[int]) -> Mapping[str, Any]:
    """The first frame of a chain, together with all that it inherits from the others."""
    merged: dict[str, Any] = {}
    for index in reversed(chain):
        merged.update(stated[index])
    merged["frame_title"] = stated[chain[0]].get("frame_title")
    merged["frame_classes"] = stated[chain[0]].get("frame_classes")
    return merged


# --- one frame -----------------------------------------------------------------------------------


def _drawing(frame: Mapping[str, Any], source: str, *, unfold: bool = False) -> Drawing:
    rows = list_at(frame, _UNFOLDED) or list_at(frame, "vertices_coords")
    if not rows:
        raise MissingCoordinatesError("`vertices_coords` is missing or empty")
    places = [components(v, row) for v, row in enumerate(rows)]
    edges = index_lists(frame, "edges_vertices", "edge", len(places))
    faces = index_lists(frame, "faces_vertices", "face", len(places))
    exact: Sequence[Point] = ()
    if unfold:
        points, remark = unfolded(places, faces)
        plane, remarks = "", [remark]
    else:
        points, plane, remarks = flattened(places)
        exact = surd_points(frame, points) or [*exact_points(frame, points)]
        check_unfolded(frame, points, faces)
    if _UNFOLDED in frame:
        remarks.append(
            Loud(f"this is a folded state: its crease pattern is read from `{_UNFOLDED}`")
        )
    for k, edge in enumerate(edges):
        if len(edge) != 2:
            raise NotFoldError(f"edge {k} has {len(edge)} ends: {shown(edge)}")
    letters, notes = _letters(frame, len(edges))
    remarks += notes
    lines = [Line(i, j, letter) for (i, j), letter in zip(edges, letters, strict=True)]
    remarks += _repeated(lines)
    lines = _bounding(lines, faces)
    missing = _missing(lines, faces)
    if missing and lines:
        remarks.append(f"added {counted(len(missing), 'line')} for sides of faces without an edge")
    elif missing:
        remarks.append("there are no edges: the lines are the sides of the faces")
    empty = sum(line.start == line.end for line in lines)
    if empty:
        remarks.append(f"left out {counted(empty, 'edge')} from a vertex to itself")
    lines = [line for line in lines if line.start != line.end] + missing
    if not lines:
        raise MalformedDrawingError("the file has no `edges_vertices` and no `faces_vertices`")
    return Drawing(
        tuple(exact or points), tuple(lines), source + plane, tuple(remarks), bool(exact)
    )


def flattened(
    places: Sequence[tuple[Fraction, Fraction, Fraction]], hint: str = _HINT
) -> tuple[list[tuple[Fraction, Fraction]], str, list[str]]:
    """The points in their plane z, y or x = constant, with a text and remarks.

    The text names the plane if it is not z = constant. A remark says how far the points leave it.
    Raises `FoldedStateError`, whose message ends with the hint, for points in no such plane.
    """
    bounds = [(min(column), max(column)) for column in zip(*places, strict=True)]
    size = max(high - low for low, high in bounds)
    for name, (i, j) in _AXES.items():
        low, high = bounds["xyz".index(name)]
        if high - low <= _FLAT * size:
            points = [(place[i], place[j]) for place in places]
            plane = "" if name == "z" else f" in a plane {name} = constant"
            height = float(min(high - low, 10**LARGEST))
            noise = f"{name} varies by {height:.2g} and is read as constant"
            return points, plane, [noise] if high > low else []
    if size > 10**LARGEST:
        raise TooLargeError(
            f"the vertices fill a box larger than 1e{LARGEST}, and larger ones are not read: scale "
            "the drawing down"
        )
    extent = " x ".join(f"{float(high - low):.3g}" for low, high in bounds)
    low, high = (places.index(find(places, key=lambda p: p[2])) for find in (min, max))
    raise FoldedStateError(
        f"this is a folded state: the vertices fill a box of {extent} (vertex {low} has the least "
        f"z, vertex {high} the largest); {hint}"
    )


def check_unfolded(
    frame: Mapping[str, Any],
    points: Sequence[tuple[Fraction, Fraction]],
    faces: Sequence[tuple[int, ...]],
    hint: str = _HINT,
) -> None:
    """Raises `FoldedStateError`, whose message ends with the hint, for a flat folded state.

    There, faces lie on the same side of an edge that they share, or a frame that calls itself
    `foldedForm` has no faces, or has faces of both orientations.
    """
    areas = [_area([points[v] for v in face]) for face in faces]
    over = _folded_over(faces, areas)
    if over:
        a, b, (i, j) = over[0]
        involved = {face for pair in over for face in pair[:2]}
        raise FoldedStateError(
            f"this is a folded state: {counted(len(involved), 'face')} of {len(faces)} overlap, "
            f"such as faces {a} and {b}, which lie on the same side of edge {i}-{j}; {hint}"
        )
    if "foldedForm" not in list_at(frame, "frame_classes") or _UNFOLDED in frame:
        return
    if not areas or min(areas) < 0 < max(areas):
        raise FoldedStateError(
            "this is a folded state (the frame is a `foldedForm`, and "
            f"{'some of its faces lie upside down' if areas else 'it has no faces'}); {hint}"
        )


def _folded_over(
    faces: Sequence[tuple[int, ...]], areas: Sequence[Fraction]
) -> list[tuple[int, int, tuple[int, int]]]:
    """Pairs of faces on the same side of an edge that exactly they share, with the edge.

    A list of faces may end with the outer face, which is as large as all others together and has
    others along all its sides; it is no such face.
    """
    sides: dict[tuple[int, int], list[tuple[int, bool]]] = {}
    for k, (face, area) in enumerate(zip(faces, areas, strict=True)):
        for i, j in zip(face, [*face[1:], *face[:1]], strict=True):
            if area:
                sides.setdefault((min(i, j), max(i, j)), []).append((k, (i < j) == (area > 0)))
    pairs = [
        (near[0][0], near[1][0], edge)
        for edge, near in sides.items()
        if len(near) == 2 and near[0][1] == near[1][1] and near[0][0] != near[1][0]
    ]
    touched = Counter(face for pair in pairs for face in pair[:2])
    whole = sum(map(abs, areas), Fraction(0))
    outer = {
        k
        for k, number in touched.items()
        if number == len(faces[k]) and 2 * abs(areas[k]) >= whole * (1 - _FLAT)
    }
    return [pair for pair in pairs if not outer & set(pair[:2])]


def _area(corners: Sequence[tuple[Fraction, Fraction]]) -> Fraction:
    """Twice the signed area of a polygon."""
    following = [*corners[1:], *corners[:1]]
    products = (a[0] * b[1] - a[1] * b[0] for a, b in zip(corners, following, strict=True))
    return sum(products, Fraction(0))


# --- lines ---------------------------------------------------------------------------------------


def _letters(frame: Mapping[str, Any], count: int) -> tuple[list[str], list[str]]:
    stated = list_at(frame, "edges_assignment")
    if not stated:
        note = "the file has no `edges_assignment`: all edges are unassigned"
        return ["U"] * count, [note] if count else []
    if len(stated) != count:
        raise NotFoldError(f"`edges_assignment` has {len(stated)} letters for {count} edges")
    letters = []
    lower = none = 0
    for k, letter in enumerate(stated):
        if letter is None:
            none += 1
            letters.append("U")
            continue
        if not isinstance(letter, str) or len(letter) != 1 or letter.upper() not in LETTERS:
            raise NotFoldError(
                f"edge {k} has the assignment {shown(letter)}, not one of {', '.join(LETTERS)}"
            )
        lower += letter.islower()
        letters.append(letter.upper())
    remarks = [f"read {counted(lower, 'lower-case letter')} as upper case"] if lower else []
    remarks += [f"read {counted(none, 'edge')} without a letter as unassigned"] if none else []
    return letters, remarks


def _repeated(lines: Sequence[Line]) -> list[str]:
    """Remarks on edges that are given more than once; edges with different letters are named."""
    first: dict[tuple[int, int], int] = {}
    same = 0
    differing = []
    for k, (i, j, letter) in enumerate(lines):
        before = first.setdefault((min(i, j), max(i, j)), k)
        if before == k:
            continue
        if lines[before].letter == letter:
            same += 1
        else:
            differing.append(
                f"edges {before} and {k} ({i}-{j}) have the letters {lines[before].letter} and "
                f"{letter}"
            )
    remarks = [f"{counted(same, 'edge')} repeated with the same letter"] if same else []
    remarks += differing[:_SHOWN]
    if len(differing) > _SHOWN:
        remarks.append(f"and {len(differing) - _SHOWN} more repeated edges with different letters")
    return remarks


def _bounding(lines: Sequence[Line], faces: Sequence[tuple[int, ...]]) -> list[Line]:
    """The lines; those without a direction that are the side of one face bound the sheet: B.

    So they do not lie between two panels, and the holes are what the faces do not cover.
    """
    number: Counter[frozenset[int]] = Counter()
    for face in faces:
        number.update(map(frozenset, zip(face, [*face[1:], *face[:1]], strict=True)))
    return [
        Line(i, j, "B") if letter in tuple("UFJ") and number[frozenset((i, j))] == 1 else line
        for line in lines
        for i, j, letter in [line]
    ]


def _missing(lines: Sequence[Line], faces: Sequence[tuple[int, ...]]) -> list[Line]:
    """Lines for the sides of faces that are not edges: B for a side of one face, else U."""
    known = {frozenset(line[:2]) for line in lines}
    sides: Counter[tuple[int, int]] = Counter()
    for face in faces:
        following = [*face[1:], *face[:1]]
        for i, j in zip(face, following, strict=True):
            if i != j and frozenset((i, j)) not in known:
                sides[min(i, j), max(i, j)] += 1
    return [Line(i, j, "B" if number == 1 else "U") for (i, j), number in sides.items()]
