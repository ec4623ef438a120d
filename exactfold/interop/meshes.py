"""Writes sheets in space as meshes: OBJ, STL, animated glTF, and objects of trimesh."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from exactfold._support.arrays import FloatArray, IndexArray
from exactfold.errors import UsageError
from exactfold.interop.packages import optional
from exactfold.pattern.loading import PatternLike, as_pattern
from exactfold.pattern.panel_pattern import Edge, PanelPattern
from exactfold.pattern.triangulating.panels import triangles_of

if TYPE_CHECKING:
    import trimesh
    from numpy.typing import ArrayLike
    from pygltflib import GLTF2

FRONT: Final = (0.80, 0.24, 0.16)
"""Linear RGB (red) of the side that shows +z in the flat sheet; the other is paper-coloured."""
BACK: Final = (0.91, 0.88, 0.80)
OBJ_COLOURS: Final = {"M": 2, "V": 3}
"""The colour of a mountain and a valley in an OBJ file; `read_obj` knows them."""
SECONDS: Final = 4.0
"""The animation takes so many seconds from the first frame to the last."""

_FLOAT, _UINT = 5126, 5125
_VERTICES, _INDICES = 34962, 34963


def obj_text(
    coords: FloatArray,
    faces: Iterable[Sequence[int]] | IndexArray,
    name: str,
    letters: Mapping[Edge, str] = MappingProxyType({}),
) -> str:
    """A sheet in space as an OBJ file: `coords` has the shape (V, 3), `faces` are cycles.

    Vertices and faces keep their order; OBJ counts from 1. Seen from the side that shows +z in the
    flat sheet, the faces are counter-clockwise. Mountains and valleys are comments
    `#e begin end colour`, as Freeform Origami writes them.

    >>> print(obj_text(np.eye(3), np.array([[0, 1, 2]]), "one"))
    o one
    v 1.0 0.0 0.0
    v 0.0 1.0 0.0
    v 0.0 0.0 1.0
    f 1 2 3
    <BLANKLINE>
    """
    lines = [f"o {name}"]
    lines += [f"v {float(x)!r} {float(y)!r} {float(z)!r}" for x, y, z in coords]
    lines += [" ".join(("f", *(str(v + 1) for v in face))) for face in faces]
    lines += [
        f"#e {i + 1} {j + 1} {OBJ_COLOURS[letter]}"
        for (i, j), letter in letters.items()
        if letter in OBJ_COLOURS
    ]
    return "\n".join(lines) + "\n"


def stl_bytes(coords: FloatArray, triangles: IndexArray) -> bytes:
    """A sheet in space as a binary STL file, by trimesh.

    Raises `PackageMissingError` without trimesh.
    """
    package = optional("trimesh", "'exactfold[meshes]'")
    mesh = package.Trimesh(coords, triangles, process=False)
    return bytes(mesh.export(file_type="stl"))


def animated_gltf(
    coords: FloatArray, triangles: IndexArray, name: str, *, returns: bool, facts: dict[str, Any]
) -> GLTF2:
    """Frames of a sheet in space as glTF 2.0, with an animation of morph targets.

    `coords` has the shape (frames, V, 3). The mesh is the first frame; each face has its own
    corners and one normal. Every other frame is a morph target, named by its number. Both sides of
    the paper are faces with their own material, and each is hidden from behind. The animation takes
    `SECONDS` from the first frame to the last, and as long back, unless the motion `returns` to the
    first frame by itself. One unit of the sheet is a metre. The z axis is turned into the y axis of
    glTF, which points up. `facts` are kept as extras.
    """
    import pygltflib as gltf

    corners = coords[:, triangles].astype(np.float64)
    normals = np.cross(corners[:, :, 1] - corners[:, :, 0], corners[:, :, 2] - corners[:, :, 0])
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    shape = (len(coords), -1, 3)
    points = corners.reshape(shape)
    up = np.repeat(normals, 3, axis=1)
    order = np.arange(3 * len(triangles), dtype=np.uint32).reshape(-1, 3)
    file = _File(gltf)
    first, *others = file.morphs(points, bounds=True)
    primitives = []
    for side, (sign, faces) in enumerate(((1, order), (-1, order[:, ::-1]))):
        base, *moved = file.morphs(sign * up)
        primitives.append(
            gltf.Primitive(
                attributes=gltf.Attributes(POSITION=first, NORMAL=base),
                indices=file.add(faces.reshape(-1, 1), _UINT, _INDICES),
                material=side,
                targets=[{"POSITION": p, "NORMAL": n} for p, n in zip(others, moved, strict=True)],
            )
        )
    keys, weights = _keys(len(coords), returns)
    animation = gltf.Animation(
        name="fold",
        samplers=[
            gltf.AnimationSampler(
                input=file.add(keys.reshape(-1, 1), _FLOAT, bounds=True),
                output=file.add(weights.reshape(-1, 1), _FLOAT),
                interpolation="LINEAR",
            )
        ],
        channels=[
            gltf.AnimationChannel(
                sampler=0, target=gltf.AnimationChannelTarget(node=0, path="weights")
            )
        ],
    )
    targets = len(coords) - 1
    file.model.asset = gltf.Asset(version="2.0", generator="exactfold", extras=facts)
    file.model.materials = [
        _paper(gltf, "front", FRONT),
        _paper(gltf, "back", BACK),
    ]
    file.model.meshes = [
        gltf.Mesh(
            name=name,
            primitives=primitives,
            weights=[0.0] * targets,
            extras={"targetNames": [f"frame {k}" for k in range(1, targets + 1)]},
        )
    ]
    half = float(np.sqrt(0.5))
    file.model.nodes = [gltf.Node(name=name, mesh=0, rotation=[-half, 0.0, 0.0, half])]
    file.model.scenes = [gltf.Scene(name=name, nodes=[0])]
    file.model.scene = 0
    file.model.animations = [animation]
    return file.finished()


def to_trimesh(
    pattern: PatternLike | PanelPattern, coords: ArrayLike | None = None
) -> trimesh.Trimesh:
    """The sheet as a `trimesh.Trimesh`, in floats, in the unit of the pattern.

    `coords` gives the places of the vertices, in the shape (V, 3): for example a frame
    `motion.coords[k]`, or `motion.at(time)`. Without it the sheet lies flat in z = 0. Vertices and
    triangles keep their order, and nothing is merged; panels are cut into triangles. Seen from the
    side that shows +z in the flat sheet, the faces are counter-clockwise. The mesh is a surface
    with a boundary, so that trimesh calls it not watertight.

    Raises `PackageMissingError` without trimesh, `UsageError` for coordinates of another shape, and
    the errors of `load`.

    >>> mesh = to_trimesh("two-vertex")
    >>> mesh.faces.shape, round(float(mesh.area), 12)
    ((6, 3), 1.0)
    """
    package = optional("trimesh", "'exactfold[bridges]'")
    sheet = pattern if isinstance(pattern, PanelPattern) else as_pattern(pattern)
    if coords is None:
        points = np.array([[float(x), float(y), 0.0] for x, y in sheet.vertices])
    else:
        points = np.array(coords, dtype=np.float64)
        if points.shape != (len(sheet.vertices), 3):
            raise UsageError(
                f"the coordinates of this sheet must have the shape ({len(sheet.vertices)}, 3), "
                f"not {points.shape}"
            )
    return package.Trimesh(points, triangles_of(sheet), process=False)


def gltf_bytes(model: GLTF2, *, binary: bool) -> bytes:
    """A GLB file, or a .gltf file of JSON that contains its data."""
    if binary:
        return bytes(b"".join(model.save_to_bytes()))
    import pygltflib as gltf

    model.convert_buffers(gltf.BufferFormat.DATAURI)
    text: str = model.to_json(separators=(",", ":"))
    return f"{text}\n".encode()


def _keys(frames: int, returns: bool) -> tuple[FloatArray, FloatArray]:
    """The times of the animation keys in seconds, and the weights of all targets at each key."""
    steps = list(range(frames))
    if not returns:
        steps += steps[-2::-1]
    times = np.arange(len(steps), dtype=np.float64) * (SECONDS / (frames - 1))
    weights = np.zeros((len(steps), frames))
    weights[np.arange(len(steps)), steps] = 1.0
    return times, np.ascontiguousarray(weights[:, 1:])


def _paper(gltf: Any, name: str, colour: tuple[float, float, float]) -> Any:
    return gltf.Material(
        name=name,
        doubleSided=False,
        pbrMetallicRoughness=gltf.PbrMetallicRoughness(
            baseColorFactor=[*colour, 1.0], metallicFactor=0.0, roughnessFactor=0.9
        ),
    )


class _File:
    """A glTF model with one buffer, which grows."""

    def __init__(self, gltf: Any) -> None:
        self.gltf = gltf
        self.model = gltf.GLTF2()
        self.data = bytearray()

    def morphs(self, frames: FloatArray, *, bounds: bool = False) -> list[int]:
        """The accessors of the first frame, and of the displacements of all others from it."""
        moved = np.vstack([frames[:1], frames[1:] - frames[:1]])
        return [self.add(rows, _FLOAT, _VERTICES, bounds=bounds) for rows in moved]

    def add(
        self, rows: Any, component: int, target: int | None = None, *, bounds: bool = False
    ) -> int:
        """The number of a new accessor with these rows."""
        stored = np.ascontiguousarray(rows, dtype=np.float32 if component == _FLOAT else np.uint32)
        raw = stored.tobytes()
        view = self.gltf.BufferView(
            buffer=0, byteOffset=len(self.data), byteLength=len(raw), target=target
        )
        self.data += raw  # each part has a multiple of four bytes
        self.model.bufferViews.append(view)
        accessor = self.gltf.Accessor(
            bufferView=len(self.model.bufferViews) - 1,
            componentType=component,
            count=len(stored),
            type="SCALAR" if stored.shape[1] == 1 else "VEC3",
        )
        if bounds:
            accessor.min = [float(x) for x in stored.min(axis=0)]
            accessor.max = [float(x) for x in stored.max(axis=0)]
        self.model.accessors.append(accessor)
        return len(self.model.accessors) - 1

    def finished(self) -> Any:
        self.model.buffers = [self.gltf.Buffer(byteLength=len(self.data))]
        self.model.set_binary_blob(bytes(self.data))
        return self.model
