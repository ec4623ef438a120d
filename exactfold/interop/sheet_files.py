"""Writes one sheet, flat or in space, as a DXF drawing or as an OBJ or STL mesh."""

from __future__ import annotations

import io
from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.interop.meshes import obj_text, stl_bytes
from exactfold.interop.packages import optional
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.triangulating.panels import triangles_of
from exactfold.pattern.writing.fold_writing import checked_target, write_bytes, write_text

if TYPE_CHECKING:
    from exactfold.pattern.crease_pattern import Edge
    from exactfold.pattern.panel_pattern import PanelPattern

FOLD_ENDINGS: Final = (".fold", ".json")
ENDINGS: Final = (".dxf", ".obj", ".stl")

_LAYERS: Final = {
    "M": ("mountain", 1),
    "V": ("valley", 5),
    "B": ("boundary", 7),
    "C": ("cut", 3),
    "F": ("flat", 2),
    "J": ("facet", 2),
    "U": ("crease", 6),
}
"""The layer of the lines with each letter, and its colour in AutoCAD; `read_dxf` knows them."""


def write_sheet(
    pattern: CreasePattern | PanelPattern,
    letters: Mapping[Edge, str],
    path: str | PathLike[str],
    *,
    coords: FloatArray | None = None,
    name: str = "sheet",
) -> None:
    """Write a sheet in the format that the ending of the path names.

    ".dxf" is the crease pattern, with a layer for each letter; it needs ezdxf (`pip install
    'exactfold[dxf]'`). ".obj" and ".stl" are the sheet as a mesh at `coords`, in the shape (V, 3),
    or flat in z = 0. OBJ has a polygon for each panel. STL has triangles, and needs trimesh (`pip
    install 'exactfold[meshes]'`). Coordinates are floats in the unit of the sheet. Edges without a
    letter are boundary edges or creases.

    Raises `UsageError` for any other ending, `PackageMissingError`, `UnwritableFileError`.

    >>> import os, tempfile
    >>> from exactfold.pattern.families import single_vertex
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     write_sheet(single_vertex(4), {}, os.path.join(folder, "sheet.obj"))
    ...     os.listdir(folder)
    ['sheet.obj']
    """
    ending = checked_target(Path(path), ENDINGS, "a sheet")
    if ending == ".dxf":
        write_text(path, dxf_text(pattern, letters))
        return
    if coords is None:
        coords = np.array([[float(x), float(y), 0.0] for x, y in pattern.vertices])
    if ending == ".obj":
        faces = pattern.triangles if isinstance(pattern, CreasePattern) else pattern.faces
        write_text(path, obj_text(coords, faces, name, letters))
    else:
        write_bytes(path, stl_bytes(coords, np.array(triangles_of(pattern), dtype=np.intp)))


def dxf_text(pattern: CreasePattern | PanelPattern, letters: Mapping[Edge, str]) -> str:
    """The crease pattern as a DXF drawing of lines, in a layer for each letter.

    Raises `PackageMissingError` without ezdxf.
    """
    document = optional("ezdxf", "'exactfold[dxf]'").new("R2010")
    space, boundary = document.modelspace(), set(pattern.boundary_edges)
    points = [(float(x), float(y)) for x, y in pattern.vertices]
    for i, j in pattern.edges:
        letter = "B" if (i, j) in boundary else letters.get((i, j), "U")
        layer, colour = _LAYERS.get(letter, _LAYERS["U"])
        if layer not in document.layers:
            document.layers.add(layer, color=colour)
        space.add_line(points[i], points[j], dxfattribs={"layer": layer})
    text = io.StringIO()
    document.write(text)
    return text.getvalue()
