"""Writes a folding sheet as a mechanism of hinged panels, for robotics: MuJoCo's MJCF, and URDF."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Final
from xml.etree import ElementTree

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.interop.meshes import FRONT, obj_text
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.triangulating.panels import triangles_by_face

if TYPE_CHECKING:
    from exactfold.pattern.crease_pattern import Edge
    from exactfold.pattern.panel_pattern import PanelPattern

THICKNESS: Final = 0.004
"""Of the panels in metres, where the longer side of the sheet is a metre. It is for show only."""
DAMPING: Final = 0.001
"""Of each hinge in N m s / rad, so that a simulation without springs comes to rest."""
_FLAT: Final = 1e-6
"""A frame whose fold angles are all smaller, in radians, is the flat sheet."""


@dataclass(frozen=True)
class Hinge:
    """A fold between two panels, with its ends in an order for which `child` lies to the left.

    Then the fold angle, positive for a valley, is the angle by which the child is turned about the
    line from `start` to `end`, by the right-hand rule.
    """

    fold: Edge
    parent: int
    child: int
    start: int
    end: int

    @property
    def name(self) -> str:
        """The name of the joint: that of the fold everywhere in exactfold."""
        return f"{self.fold[0]}-{self.fold[1]}"


@dataclass(frozen=True)
class Mechanism:
    """A sheet as panels that hinges join to a tree, and the hinges that close its loops.

    `points` are the vertices of the flat sheet in metres, shape (V, 3): the longer side of the
    sheet is one metre. Panel k is the face k of the sheet, and `root` is the largest. Each hinge of
    `tree` stands after the one that holds its parent. A rigid sheet of disk shape with V_i interior
    vertices has V_i more folds than a tree of its panels: these are `closing`.
    """

    points: FloatArray
    faces: tuple[tuple[int, ...], ...]
    triangles: tuple[tuple[tuple[int, ...], ...], ...]
    root: int
    tree: tuple[Hinge, ...]
    closing: tuple[Hinge, ...]

    @property
    def areas(self) -> FloatArray:
        """The area of each panel in square metres."""
        return np.array([_areas(self.points[np.array(cut)]).sum() for cut in self.triangles])


def mechanism(pattern: CreasePattern | PanelPattern) -> Mechanism:
    """The panels of a sheet as a tree of hinges, found breadth first from the largest panel.

    >>> import exactfold
    >>> robot = mechanism(exactfold.read("miura").sheet)
    >>> len(robot.faces), len(robot.tree), len(robot.closing)
    (16, 15, 9)
    """
    faces = pattern.triangles if isinstance(pattern, CreasePattern) else pattern.faces
    flat = np.array([[float(x), float(y)] for x, y in pattern.vertices])
    flat = (flat - flat.min(axis=0)) / np.ptp(flat, axis=0).max()
    points = np.column_stack([flat, np.zeros(len(flat))])
    left = {
        side: k
        for k, face in enumerate(faces)
        for side in pairwise((*face, face[0]))  # counter-clockwise: the face lies to the left
    }
    beside: dict[int, list[Hinge]] = {k: [] for k in range(len(faces))}
    for i, j in pattern.folds:
        one, other = left[i, j], left[j, i]
        beside[one].append(Hinge((i, j), one, other, j, i))
        beside[other].append(Hinge((i, j), other, one, i, j))
    cut = triangles_by_face(pattern)
    areas = [float(_areas(points[np.array(triangles)]).sum()) for triangles in cut]
    root = max(range(len(faces)), key=areas.__getitem__)
    tree, reached, queue = [], {root}, deque([root])
    while queue:
        for hinge in beside[queue.popleft()]:
            if hinge.child not in reached:
                reached.add(hinge.child)
                tree.append(hinge)
                queue.append(hinge.child)
    joined = {hinge.fold for hinge in tree}
    closing = tuple(
        hinge
        for hinges in beside.values()
        for hinge in hinges
        if hinge.fold not in joined and hinge.parent < hinge.child
    )
    return Mechanism(points, tuple(faces), cut, root, tuple(tree), closing)


def mjcf_text(
    pattern: CreasePattern | PanelPattern, angles: FloatArray, times: FloatArray, name: str
) -> str:
    """A motion of a sheet as a model for MuJoCo, in its XML format MJCF.

    `angles` has the shape (frames, folds), in radians, valleys positive, in the order of
    `pattern.folds`; `times` has the shape (frames,). Each panel is a body, and the largest is held.
    Folds of a tree are hinge joints, named i-j, whose value is the fold angle. Each other fold
    closes loops: two `connect` constraints keep its ends together. The model starts in the first
    frame that is not flat, because the flat sheet is where all ways meet; a keyframe for each frame
    has the angles of the joints. The longer side of the sheet is a metre, all panels together weigh
    a kilogram, there is no gravity, and panels pass through each other.

    >>> import exactfold
    >>> motion = exactfold.follow("single-vertex-4", signs="+", until="90deg", frames=3)
    >>> text = mjcf_text(motion.pattern, motion.angles, motion.times, "one")
    >>> text.count("<joint name="), text.count("<connect"), text.count("<key ")
    (3, 2, 3)
    """
    robot = mechanism(pattern)
    start = int(np.argmax(np.abs(angles).max(axis=1, initial=0.0) > _FLAT))
    column = {fold: k for k, fold in enumerate(pattern.folds)}
    model = ElementTree.Element("mujoco", model=name)
    model.append(ElementTree.Comment(_about(f"frame {start} of the motion")))
    ElementTree.SubElement(model, "compiler", angle="radian", autolimits="true")
    ElementTree.SubElement(model, "option", gravity="0 0 0", integrator="implicitfast")
    default = ElementTree.SubElement(model, "default")
    ElementTree.SubElement(default, "joint", type="hinge", damping=repr(DAMPING))
    colour = _row((*FRONT, 1.0))
    ElementTree.SubElement(default, "geom", type="mesh", contype="0", conaffinity="0", rgba=colour)
    asset = ElementTree.SubElement(model, "asset")
    world = ElementTree.SubElement(model, "worldbody")
    ElementTree.SubElement(world, "light", pos="0.5 0.5 3", dir="0 0 -1")
    bodies = {robot.root: ElementTree.SubElement(world, "body", name=f"panel {robot.root}")}
    for hinge in robot.tree:
        angle = float(angles[start, column[hinge.fold]])
        a, axis = robot.points[hinge.start], _axis(robot, hinge)
        turn = _rotation(axis, angle)
        bodies[hinge.child] = ElementTree.SubElement(
            bodies[hinge.parent],
            "body",
            name=f"panel {hinge.child}",
            pos=_row(a - turn @ a),
            quat=_row((np.cos(angle / 2), *(np.sin(angle / 2) * axis))),
        )
        ElementTree.SubElement(
            bodies[hinge.child],
            "joint",
            name=hinge.name,
            pos=_row(a),
            axis=_row(axis),
            ref=repr(angle),
        )
    density = 1 / float(robot.areas.sum())
    for panel, body in bodies.items():
        for piece, triangle in enumerate(_convex(robot, panel)):
            corners = robot.points[np.array(triangle)]
            lift = np.array([0.0, 0.0, THICKNESS / 2])
            mesh = f"panel {panel}, piece {piece}"
            ElementTree.SubElement(
                asset,
                "mesh",
                name=mesh,
                vertex=_row(np.concatenate([corners - lift, corners + lift])),
            )
            mass = density * _polygon_area(corners)
            ElementTree.SubElement(body, "geom", mesh=mesh, mass=repr(mass))
    equality = ElementTree.SubElement(model, "equality")
    for hinge in robot.closing:
        for end in (hinge.start, hinge.end):
            ElementTree.SubElement(
                equality,
                "connect",
                name=f"{hinge.name} at {end}",
                body1=f"panel {hinge.parent}",
                body2=f"panel {hinge.child}",
                anchor=_row(robot.points[end]),
            )
    order = {joint.get("name"): k for k, joint in enumerate(world.iter("joint"))}
    columns = sorted((hinge for hinge in robot.tree), key=lambda hinge: order[hinge.name])
    rows = angles[:, [column[hinge.fold] for hinge in columns]]
    frames = ElementTree.SubElement(model, "keyframe")
    for k, (time, row) in enumerate(zip(times, rows, strict=True)):
        ElementTree.SubElement(
            frames, "key", name=f"frame {k}", time=repr(float(time)), qpos=_row(row)
        )
    return _xml(model)


def urdf_texts(
    pattern: CreasePattern | PanelPattern, stem: str, name: str
) -> tuple[str, Mapping[str, str]]:
    """A sheet as a robot in URDF, and the meshes of its panels as OBJ files by file name.

    Each panel is a link. Folds of a tree are revolute joints, named i-j, whose value is the fold
    angle, valleys positive, with the flat sheet at zero. URDF has no loops: the folds that close
    them are no joints, and a comment names them. The loops stay closed if the joints have the
    angles of one frame of a motion, which are the columns of its table (`angles_csv`). Size and
    mass are those of `mjcf_text`; the inertia is that of a thin plate.

    >>> from exactfold.pattern.families import single_vertex
    >>> text, meshes = urdf_texts(single_vertex(4), "one", "one")
    >>> text.count("<joint "), sorted(meshes)[0]
    (3, 'one_0000.obj')
    """
    robot = mechanism(pattern)
    model = ElementTree.Element("robot", name=name)
    model.append(ElementTree.Comment(_about("the flat sheet")))
    if robot.closing:
        names = ", ".join(hinge.name for hinge in robot.closing)
        model.append(
            ElementTree.Comment(
                f" URDF has no loops. These folds are no joints: {names}. The sheet stays whole "
                "where the joints have the angles of a motion. "
            )
        )
    origin = {robot.root: robot.points[0] * 0.0}
    origin.update((hinge.child, robot.points[hinge.start]) for hinge in robot.tree)
    meshes, density = {}, 1 / float(robot.areas.sum())
    for panel, at in sorted(origin.items()):
        corners = robot.points[np.array(robot.faces[panel])] - at
        index = {v: k for k, v in enumerate(robot.faces[panel])}
        cut = np.array([[index[v] for v in triangle] for triangle in robot.triangles[panel]])
        file = f"{stem}_{panel:04}.obj"
        meshes[file] = obj_text(corners, cut, f"panel {panel}")
        link = ElementTree.SubElement(model, "link", name=f"panel {panel}")
        mass, centre, inertia = _plate(corners[cut], density)
        inertial = ElementTree.SubElement(link, "inertial")
        ElementTree.SubElement(inertial, "origin", xyz=_row(centre), rpy="0 0 0")
        ElementTree.SubElement(inertial, "mass", value=repr(mass))
        ElementTree.SubElement(inertial, "inertia", inertia)
        visual = ElementTree.SubElement(link, "visual")
        geometry = ElementTree.SubElement(visual, "geometry")
        ElementTree.SubElement(geometry, "mesh", filename=file)
        material = ElementTree.SubElement(visual, "material", name="paper")
        ElementTree.SubElement(material, "color", rgba=_row((*FRONT, 1.0)))
    for hinge in robot.tree:
        joint = ElementTree.SubElement(model, "joint", name=hinge.name, type="revolute")
        ElementTree.SubElement(joint, "parent", link=f"panel {hinge.parent}")
        ElementTree.SubElement(joint, "child", link=f"panel {hinge.child}")
        step = origin[hinge.child] - origin[hinge.parent]
        ElementTree.SubElement(joint, "origin", xyz=_row(step), rpy="0 0 0")
        ElementTree.SubElement(joint, "axis", xyz=_row(_axis(robot, hinge)))
        limits = {"lower": repr(-np.pi), "upper": repr(np.pi), "effort": "1", "velocity": "10"}
        ElementTree.SubElement(joint, "limit", limits)
        ElementTree.SubElement(joint, "dynamics", damping=repr(DAMPING))
    return _xml(model), meshes


def _about(start: str) -> str:
    return (
        " The longer side of the sheet is 1 m and its mass is 1 kg. The value of a joint is its "
        f"fold angle in radians, positive for a valley. The model starts at {start}. "
    )


def _axis(robot: Mechanism, hinge: Hinge) -> FloatArray:
    along = robot.points[hinge.end] - robot.points[hinge.start]
    return np.asarray(along / np.linalg.norm(along))


def _rotation(axis: FloatArray, angle: float) -> FloatArray:
    """The rotation by an angle about a unit vector, by Rodrigues's formula."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross)


def _convex(robot: Mechanism, panel: int) -> Sequence[Sequence[int]]:
    """The panel in convex pieces: itself, or its triangles."""
    face = robot.faces[panel]
    corners = robot.points[np.array(face), :2]
    sides = np.roll(corners, -1, axis=0) - corners
    after = np.roll(sides, -1, axis=0)
    turns = sides[:, 0] * after[:, 1] - sides[:, 1] * after[:, 0]
    return (face,) if turns.min() > -1e-12 else robot.triangles[panel]


def _areas(corners: FloatArray) -> FloatArray:
    """The areas of triangles in the plane, shape (T, 3, 3)."""
    one, other = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    return np.asarray((one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]) / 2)


def _polygon_area(corners: FloatArray) -> float:
    x, y = corners[:, 0], corners[:, 1]
    return float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2


def _plate(corners: FloatArray, density: float) -> tuple[float, FloatArray, dict[str, str]]:
    """Mass, centre of mass and moments of inertia about it, of a plate made of triangles.

    The second moments of a triangle with corners p, about its centre c and by area, are those of
    three points with a twelfth of the area each: the sum of (p - c)(p - c)^T / 12 times the area.
    """
    areas = _areas(corners)
    centres = corners.mean(axis=1)
    mass = density * float(areas.sum())
    centre = np.asarray(areas @ centres / areas.sum())
    spread = corners - centres[:, None]
    away = centres - centre
    second = density * (
        np.einsum("t,tpi,tpj->ij", areas / 12, spread, spread)
        + np.einsum("t,ti,tj->ij", areas, away, away)
    )
    xx, yy, xy = second[0, 0], second[1, 1], second[0, 1]
    moments = {"ixx": yy, "iyy": xx, "izz": xx + yy, "ixy": -xy, "ixz": 0.0, "iyz": 0.0}
    return mass, centre, {key: repr(float(value)) for key, value in moments.items()}


def _row(numbers: FloatArray | Sequence[float]) -> str:
    return " ".join(repr(float(x)) for x in np.asarray(numbers, dtype=np.float64).ravel())


def _xml(root: ElementTree.Element) -> str:
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode") + "\n"
