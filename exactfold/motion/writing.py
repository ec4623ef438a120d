"""Writes a motion as FOLD with frames, glTF, meshes, a table or a robot; or its end alone."""

from __future__ import annotations

import csv
import io
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from exactfold._support.arrays import FloatArray, IndexArray
from exactfold.branches.values.export import BranchExport
from exactfold.errors import UsageError
from exactfold.exact.numbers import shown
from exactfold.interop.fold_frames import NOISE, MotionFrame, motion_document
from exactfold.interop.mechanisms import mjcf_text, urdf_texts
from exactfold.interop.meshes import animated_gltf, gltf_bytes, obj_text, stl_bytes
from exactfold.motion.curves.events import RETURN
from exactfold.motion.curves.in_motion import SheetInMotion
from exactfold.motion.panels.in_motion import PanelsInMotion
from exactfold.motion.solid.plates import Plates
from exactfold.pattern.triangulating.panels import triangles_of
from exactfold.pattern.writing.fold_writing import (
    checked_target,
    document_text,
    write_bytes,
    write_text,
)

ENDINGS = (".fold", ".glb", ".gltf", ".obj", ".stl", ".csv", ".mjcf", ".urdf")


def write_motion(
    motion: SheetInMotion, path: str | PathLike[str], *, title: str | None = None
) -> tuple[Path, ...]:
    """Write a motion in the format that the ending of the path names; return the written files.

    ".fold" is FOLD 1.2: the exact flat sheet, followed by all frames with their fold angles
    (`motion_document`). ".glb" and ".gltf" are glTF 2.0: one file with an animation of the frames,
    for Blender and three.js. ".obj" and ".stl" give a file for each frame: NAME_0000.obj,
    NAME_0001.obj, and so on; STL needs trimesh (`pip install 'exactfold[meshes]'`). ".csv" is a
    table of the fold angles in degrees, with a row for each frame (`angles_csv`). ".mjcf" and
    ".urdf" are the sheet as a mechanism: a model for MuJoCo that starts on the motion
    (`mjcf_text`), and a robot with the meshes of its panels in files NAME_0000.obj and so on
    (`urdf_texts`). FOLD files keep panels as they are; in meshes panels are cut
    into triangles, and with a thickness they are the closed surfaces of plates.
    `title` is the title of the pattern. See docs/folding.md.

    Raises `UsageError` for any other ending, `PackageMissingError`, `UnwritableFileError`.

    >>> import os, tempfile
    >>> from exactfold.branches.counting.find import find_branch
    >>> from exactfold.motion.following import follow
    >>> motion = follow(find_branch("two-vertex", "+-"), until="90deg", frames=3)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     files = write_motion(motion, os.path.join(folder, "two.obj"))
    ...     [file.name for file in files]
    ['two_0000.obj', 'two_0001.obj', 'two_0002.obj']
    """
    if not isinstance(motion, SheetInMotion):
        raise UsageError(
            f"write_motion(motion, path): {shown(motion)} is not a motion: `follow` and "
            "`follow_panels` return one"
        )
    target = Path(path)
    ending = checked_ending(target)
    if ending == ".fold":
        write_text(target, document_text(fold_motion(motion, title=title)))
        return (target,)
    if ending == ".csv":
        write_text(target, angles_csv(motion))
        return (target,)
    name = title or "sheet"
    if ending == ".mjcf":
        write_text(target, mjcf_text(motion.pattern, motion.angles, motion.times, name))
        return (target,)
    if ending == ".urdf":
        text, meshes = urdf_texts(motion.pattern, target.stem, name)
        for beside, mesh in meshes.items():
            write_text(target.with_name(beside), mesh)
        write_text(target, text)
        return (target, *map(target.with_name, meshes))
    frames, triangles = _meshes(motion)
    if ending in (".obj", ".stl"):
        files = [
            target.with_name(f"{target.stem}_{k:04}{ending}") for k in range(len(motion.times))
        ]
        for file, coords in zip(files, frames, strict=True):
            if ending == ".obj":
                write_text(file, obj_text(coords, triangles, name))
            else:
                write_bytes(file, stl_bytes(coords, triangles))
        return tuple(files)
    model = animated_gltf(frames, triangles, name, returns=motion.end == RETURN, facts=motion.facts)
    write_bytes(target, gltf_bytes(model, binary=ending == ".glb"))
    return (target,)


def _meshes(motion: SheetInMotion) -> tuple[FloatArray, IndexArray]:
    """The corners of all frames, and the triangles: of the sheet, or of the plates of a motion."""
    if isinstance(motion, PanelsInMotion) and motion.solid is not None:
        plates = Plates(motion.pattern, motion.solid)
        return plates.places(motion.coords), plates.surface
    return motion.coords, np.array(triangles_of(motion.pattern), dtype=np.intp)


def checked_ending(path: Path) -> str:
    """The ending of the path, if it is one of `ENDINGS`; raises the errors of `checked_target`."""
    return checked_target(path, ENDINGS, "a motion")


def angles_csv(motion: SheetInMotion) -> str:
    """The fold angles of a motion as a table: a column for the time and for each fold.

    Angles are in degrees, valleys positive. Each frame has a row.

    >>> from exactfold.branches.counting.find import find_branch
    >>> from exactfold.motion.following import follow
    >>> motion = follow(find_branch("single-vertex-4", "+"), until="90deg", frames=2)
    >>> angles_csv(motion).splitlines()[0]
    'time,0-4,1-4,2-4,3-4'
    """
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(["time", *(f"{i}-{j}" for i, j in motion.pattern.folds)])
    for time, row in zip(motion.times, np.degrees(motion.angles), strict=True):
        table.writerow([repr(float(time)), *(repr(float(angle)) for angle in row)])
    return text.getvalue()


def fold_motion(motion: SheetInMotion, *, title: str | None = None) -> dict[str, Any]:
    """The FOLD object of a motion that `write_motion` writes.

    `edges_foldAngle` of the flat sheet has `motion.leading_angles`: the first-order angles of a
    branch, or the angles of a motion of panels when its driving folds have 30 degrees. With these
    angles, a simulator that reads only this frame stays on the branch or mode (docs/viewer.md,
    The file).
    """
    folds, bounds = motion.pattern.folds, motion.bounds
    frames = [
        MotionFrame(
            float(time),
            coords.tolist(),
            dict(zip(folds, np.degrees(row).tolist(), strict=True)),
            None if bounds is None else bounds.times[k],
            None if bounds is None else bounds.radii[k],
        )
        for k, (time, coords, row) in enumerate(
            zip(motion.times, motion.coords, motion.angles, strict=True)
        )
    ]
    return motion_document(
        motion.pattern,
        motion.assignment,
        motion.leading_angles,
        frames,
        name=f"motion along {motion.name}",
        title=title,
        facts=motion.facts,
        angles_are=motion.leading_angles_are,
    )


def exported_way(motion: SheetInMotion, *, title: str | None = None) -> BranchExport:
    """The last frame of a motion alone, as a FOLD object with the crease pattern.

    `edges_foldAngle` has its fold angles in degrees, and frame 1 is the sheet in space. The letters
    are those with which the motion begins; a fold that is flat then, but bent in this frame, has
    the letter that it has here. `title` names the pattern. `write` of the result writes the file.

    >>> import exactfold
    >>> end = exported_way(exactfold.follow("miura", 2, until="30deg", frames=2), title="miura")
    >>> end.document["file_title"], round(max(end.angles.values()), 6), end.letters[3, 17]
    ('miura, way 2', 30.0, 'M')
    """
    pattern, degrees = motion.pattern, np.degrees(motion.angles[-1]).tolist()
    angles = {
        fold: 0.0 if abs(angle) <= NOISE else angle
        for fold, angle in zip(pattern.folds, degrees, strict=True)
    }
    letters = dict(motion.assignment)
    for fold, angle in angles.items():
        if angle and letters[fold] == "F":
            letters[fold] = "V" if angle > 0 else "M"
    document = motion_document(
        pattern,
        letters,
        angles,
        [MotionFrame(float(motion.times[-1]), motion.coords[-1].tolist(), angles)],
        name=motion.name,
        title=title,
        facts=motion.facts,
        angles_are="the fold angles",
    )
    return BranchExport(pattern, letters, document, angles, motion.length_error, motion.status)
