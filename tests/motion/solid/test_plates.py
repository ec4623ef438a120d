"""Plates: their outlines, when they stop a fold, and where prisms overlap, each in two ways."""

from __future__ import annotations

import pickle
from fractions import Fraction
from math import atan, degrees, pi, tan

import numpy as np
import pytest
import trimesh
from folding_panels import strip
from hypothesis import given, settings
from hypothesis import strategies as st
from panel_sheets import miura
from scipy.optimize import linprog
from scipy.spatial import ConvexHull, HalfspaceIntersection

from exactfold.errors import StuckPlatesError, UsageError
from exactfold.motion import follow_panels, write_motion
from exactfold.motion.solid.contacts import PlateContacts
from exactfold.motion.solid.overlaps import FACES, common_point, overlapping, widest
from exactfold.motion.solid.plates import MIDDLE, VALLEY, Plates, Solid
from exactfold.pattern.panel_pattern import PanelPattern

HALF = Fraction(1, 2)


def plates(pattern, trim=Fraction(1, 10), thickness=Fraction(1, 5), hinge=MIDDLE):
    return Plates(pattern, Solid(thickness, hinge, trim))


def corners_of(made, panel):
    """The corners of a plate in the plane, in floats."""
    rows = [2 * k for k, (owner, _, _) in enumerate(made.corners) if owner == panel]
    return made.flat[rows, :2]


@pytest.mark.parametrize("pattern", [miura(2, 2), strip([3, 1, 3])])
def test_a_convex_plate_is_what_is_far_enough_from_the_folds(pattern):
    """Against the intersection of half-planes, by Qhull."""
    made = plates(pattern)
    for panel, face in enumerate(pattern.faces):
        points = np.array([[float(c) for c in pattern.vertices[v]] for v in face])
        rows = []
        for k, v in enumerate(face):
            w = face[(k + 1) % len(face)]
            d = points[(k + 1) % len(face)] - points[k]
            n = np.array([d[1], -d[0]]) / np.linalg.norm(d)
            inner = (min(v, w), max(v, w)) in pattern.folds
            rows.append([*n, -float(n @ points[k]) + 0.1 * inner])
        found = HalfspaceIntersection(np.array(rows), points.mean(axis=0)).intersections
        wanted = found[ConvexHull(found).vertices]
        ours = corners_of(made, panel)
        assert len(ours) == len(wanted)
        for point in ours:
            assert np.abs(wanted - point).sum(axis=1).min() < 1e-12


def test_a_fold_and_a_part_of_the_border_in_one_line_make_a_step():
    """A panel of width 4, with a fold on the left half of its upper side."""
    points = [(0, 0), (4, 0), (4, 2), (2, 2), (0, 2), (0, 4), (2, 4)]
    edges = [(0, 1), (1, 2), (2, 3), (3, 4), (0, 4), (4, 5), (5, 6), (3, 6)]
    made = plates(PanelPattern(points, edges))
    lower = next(k for k, face in enumerate(made.pattern.faces) if 0 in face)
    outline = sorted(tuple(round(float(c), 12) for c in p) for p in corners_of(made, lower))
    assert outline == [(0, 0), (0, 1.9), (2, 1.9), (2, 2), (4, 0), (4, 2)]
    assert len(made.triangles[lower]) == 4


def test_triangles_make_up_the_plate_of_a_panel_that_is_not_convex():
    points = [(0, 0), (6, 0), (6, 4), (3, 4), (3, 2), (0, 2), (0, 4), (6, 6)]
    ell = PanelPattern(
        points, [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (0, 5), (5, 6), (3, 6), (2, 7), (3, 7)]
    )
    made = plates(ell)
    for panel, triangles in enumerate(made.triangles):
        p = corners_of(made, panel)
        q = np.roll(p, -1, axis=0)
        whole = float((p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]).sum())
        parts = [float(np.linalg.det([p[b] - p[a], p[c] - p[a]])) for a, b, c in triangles]
        assert min(parts) > 0
        assert sum(parts) == pytest.approx(whole)


def test_limits_of_hinges():
    solid = Solid(HALF, MIDDLE, Fraction(1, 3))
    assert solid.limit("V") == solid.limit("M") == pytest.approx(pi - 2 * atan(0.25 / (1 / 3)))
    solid = Solid(HALF, VALLEY, Fraction(1, 3))
    assert solid.limit("V") == pi
    assert degrees(solid.limit("M")) == pytest.approx(180 - 2 * degrees(atan(1.5)))
    assert solid.text == "1/2 thick, hinges in the upper surface, cut back by 1/3 from the folds"


@pytest.mark.parametrize(
    ("thickness", "hinge", "trim", "message"),
    [
        (0, MIDDLE, 1, "the thickness is 0: give a positive number"),
        (-1, MIDDLE, 1, "the thickness is -1: give a positive number"),
        (1, MIDDLE, -1, "the trim is -1: give a positive number, or 0"),
        (1, "top", 1, "the hinge 'top' is neither middle nor valley"),
    ],
)
def test_numbers_that_make_no_plates(thickness, hinge, trim, message):
    with pytest.raises(UsageError, match=message):
        Solid(Fraction(thickness), hinge, Fraction(trim))


def test_plates_that_are_not_cut_back_stop_the_flat_sheet():
    sheet = strip([3, 1, 3])
    folds = dict(zip(sheet.folds, "VM", strict=True))
    message = (
        "the flat sheet is stuck: plates of thickness 1/5 with hinges in the middle meet at fold "
        "2-3, a valley, as soon as it turns"
    )
    with pytest.raises(StuckPlatesError, match=message):
        PlateContacts(plates(sheet, Fraction(0)), folds)
    with pytest.raises(StuckPlatesError, match="in the upper surface meet at fold 4-5, a mountain"):
        PlateContacts(plates(sheet, Fraction(0), hinge=VALLEY), folds)
    valleys = dict.fromkeys(folds, "V")
    with pytest.raises(UsageError, match="no first contact can be told: give a small --trim"):
        PlateContacts(plates(sheet, Fraction(0), hinge=VALLEY), valleys)


@pytest.mark.parametrize(("trim", "left"), [(Fraction(49, 100), True), (HALF, False)])
def test_nothing_may_be_left_of_a_panel(trim, left):
    made = plates(strip([3, 1, 3]), trim)
    if left:
        assert len(made.prisms) == 6
        return
    with pytest.raises(StuckPlatesError, match=r"panel \S+ cannot be cut back by 1/2 from its"):
        assert made.prisms is not None


def test_places_of_a_turned_sheet_are_turned():
    made = plates(miura(2, 2))
    flat = np.array([[float(x), float(y), 0.0] for x, y in made.pattern.vertices])
    turn, _ = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    there = made.places((flat @ turn.T)[None] + 2)[0]
    assert np.abs(there - made.flat @ turn.T - 2).max() < 1e-13


def test_values_are_pickled():
    made = plates(miura(2, 2))
    again = pickle.loads(pickle.dumps(made))
    assert again == made
    assert again.corners[0][:2] == made.corners[0][:2]


# --- prisms that overlap, against linear programming ---------------------------------------------


def prism(generator):
    """A prism over a random triangle, turned and shifted at random."""
    triangle = generator.normal(size=(3, 2))
    (a, b), (c, d) = triangle[1] - triangle[0], triangle[2] - triangle[0]
    if a * d - b * c < 0:
        triangle = triangle[::-1]
    corners = np.array([[*p, h] for h in (-0.1, 0.1) for p in triangle])
    turn, _ = np.linalg.qr(generator.normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    return corners @ turn.T + generator.normal(size=3) / 2


def meet(a, b):
    """Whether some point is a convex combination of the corners of both."""
    rows = np.zeros((5, 12))
    rows[:3, :6], rows[:3, 6:] = a.T, -b.T
    rows[3, :6] = rows[4, 6:] = 1
    return linprog(np.zeros(12), A_eq=rows, b_eq=[0, 0, 0, 1, 1]).status == 0


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 10**6))
def test_prisms_overlap_where_no_axis_parts_them(seed):
    generator = np.random.default_rng(seed)
    a, b = prism(generator), prism(generator)
    [gap], [n] = widest(a[None], b[None])
    if abs(gap) < 1e-6:
        return
    assert (gap < 0) == meet(a, b)
    both = np.concatenate([a, b])
    found = overlapping(both, np.arange(12).reshape(2, 6), np.array([[0, 1]]))
    assert len(found) == (gap < 0)
    point = common_point(a, b)
    assert (point is None) == (gap > 0)
    if gap > 0:
        assert (a @ n).min() - (b @ n).max() == pytest.approx(gap)
        return
    for body in (a, b):
        for i, j, k in FACES:
            assert np.linalg.det([body[j] - body[i], body[k] - body[i], point - body[i]]) < 0


def test_meshes_of_a_thick_motion_are_closed(tmp_path):
    """Their volume is the thickness times the areas of the outlines, by Green's theorem."""
    solid = Solid(Fraction(1, 5), MIDDLE, Fraction(1, 10))
    motion = follow_panels(miura(2, 2), solid=solid, until="50deg", frames=2)
    files = write_motion(motion, tmp_path / "plates.obj")
    made = Plates(motion.pattern, solid)
    area = 0.0
    for panel in range(len(motion.pattern.faces)):
        p = corners_of(made, panel)
        q = np.roll(p, -1, axis=0)
        area += float((p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]).sum()) / 2
    for file in files:
        mesh = trimesh.load(file, process=False)
        assert mesh.is_watertight
        assert mesh.is_winding_consistent
        assert mesh.body_count == len(motion.pattern.faces)
        assert mesh.volume == pytest.approx(area / 5)


def test_letters_say_which_panels_are_one_body():
    made = plates(strip([3, 1, 3]))
    assert len(made.pairs(dict(zip(made.pattern.folds, "VV", strict=True)))) == 12
    assert len(made.pairs(dict(zip(made.pattern.folds, "VF", strict=True)))) == 8
    assert tan(made.solid.limit("V") / 2) == pytest.approx(1.0)
