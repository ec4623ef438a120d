"""The first contact, enclosed in time: against the motion in floats, rationals, and a library."""

from __future__ import annotations

import json
import random
from fractions import Fraction
from functools import cache
from itertools import combinations

import numpy as np
import pytest
from sheets import mapped, mirrored, nested_triangles, reflex_corners, star_in

from exactfold import checker
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches.counting.find import find_branch
from exactfold.motion.contacts.claims import certificate_with_contact
from exactfold.motion.contacts.contacts import ContactWatch, first_contact
from exactfold.motion.following import follow
from exactfold.motion.tubes.piece import PARAMETER_BITS
from exactfold.motion.tubes.tracks import follow_proved
from exactfold.motion.tubes.tube import sharpened
from exactfold.pattern.triangulating.random_squares import random_square


def signs(n, seed):
    return "".join(random.Random(seed).choice("+-") for _ in range(n))


SHEETS = {
    **{
        f"square {n}, {seed}": (random_square(n, seed=seed), signs(n, seed))
        for n, seeds in ((1, 4), (2, 4), (3, 4), (4, 3), (5, 2), (6, 1))
        for seed in range(seeds)
    },
    "reflex": (star_in(reflex_corners(1)), "-"),
    "reflex, other": (star_in(reflex_corners(3)), "-"),
}


QUICK = ("square 1, 0", "square 3, 1", "square 5, 0", "reflex")
ALL = [name if name in QUICK else pytest.param(name, marks=pytest.mark.survey) for name in SHEETS]


@cache
def proved(name):
    pattern, text = SHEETS[name]
    branch = find_branch(pattern, text)
    return branch, *first_contact(branch)


def minus(a, b):
    return [x - y for x, y in zip(a, b, strict=True)]


def det(p, q, r, s):
    a, b, c = minus(q, p), minus(r, p), minus(s, p)
    return (
        a[0] * (b[1] * c[2] - b[2] * c[1])
        - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
    )


def crossings(faces, points):
    """All (edge, face) where an edge runs through a face it has no corner in, in rationals."""
    edges = {tuple(sorted(pair)) for face in faces for pair in combinations(face, 2)}
    found = []
    for i, j in edges:
        for face in faces:
            if {i, j} & set(face):
                continue
            p, q, (a, b, c) = points[i], points[j], (points[v] for v in face)
            if det(a, b, c, p) * det(a, b, c, q) >= 0:
                continue
            if len({det(p, q, s, t) > 0 for s, t in ((a, b), (b, c), (c, a))}) == 1:
                found.append(((i, j), face))
    return found


def configuration(track, link, parameter):
    """The middle of a box of about 14 digits, in rationals."""
    framework = track.framework
    ball = sharpened(link.tube, parameter)
    points = [[Fraction(x, 1 << framework.bits) for x in (*p, 0)] for p in framework.points]
    for k, v in enumerate(framework.free.tolist()):
        middle = ball.centre[3 * k : 3 * k + 3]
        points[v] = [
            x + Fraction(d, 1 << ball.bits) for x, d in zip(points[v], middle, strict=True)
        ]
    return points


def volumes(framework, points):
    """For every fold 6 times the volume between its faces: positive for a valley."""
    return [det(points[i], points[j], points[a], points[b]) for i, j, a, b in framework.hinges]


@pytest.mark.parametrize("name", ALL)
def test_the_event_in_floats_lies_in_the_enclosure(name):
    branch, track, contact = proved(name)
    assert contact.status is PROVED
    event = contact.event
    low, high = event.time
    assert low <= float(contact.clear) < high < low * (1 + 1e-2)
    motion = follow(branch, side=1, frames=3)
    if motion.end == "node":
        motion = follow(branch, through_branch_points=True, frames=3)
    other = motion.events[-1]
    # The time of `follow` is the length with the same triangle held, of all coordinates.
    assert low * (1 - 1e-6) <= other.time[1]
    assert other.time[0] <= high * (1 + 1e-6)
    assert event.kind == other.kind
    if event.kind == "flat-fold":
        assert event.folds == other.folds
    assert track.reason == "the first contact"


@pytest.mark.parametrize("name", ALL)
def test_rationals_see_nothing_before_and_something_after(name):
    _, track, contact = proved(name)
    framework = track.framework
    faces = framework.sheet.triangles
    rng = random.Random(1)
    clear, begin, end = contact.parameters
    for link in rng.sample(track.links[:-1], 3):
        points = configuration(track, link, rng.randint(max(link.entry), link.exit))
        assert crossings(faces, points) == []
    last = track.links[-1]
    before = configuration(track, last, clear)
    after = configuration(track, last, end)
    assert crossings(faces, before) == []
    event = contact.event
    if event.kind == "contact":
        one, two = (set(face) for face in event.faces)
        named = [
            ({track.labels[v] for v in e}, {track.labels[v] for v in f})
            for e, f in crossings(faces, after)
        ]
        assert any((e <= one and f == two) or (e <= two and f == one) for e, f in named)
        assert begin == end
    else:
        [fold] = event.folds
        names = [(track.labels[i], track.labels[j]) for i, j in framework.sheet.folds]
        k = names.index(fold)
        first = volumes(framework, configuration(track, last, begin))[k]
        assert first * volumes(framework, after)[k] < 0
        _, _, a, b = framework.hinges[k]
        near = float(sum(x * x for x in minus(after[a], after[b])))
        flat = float(((framework.flat[a] - framework.flat[b]) ** 2).sum())
        assert near < flat


@pytest.mark.parametrize("name", QUICK)
def test_the_checker_verifies_the_contact(name):
    _, track, contact = proved(name)
    claims = checker.check(json.loads(json.dumps(certificate_with_contact(track, contact))))
    event = contact.event
    low, high = map(Fraction, claims["contact"]["time"])
    assert Fraction(event.time[0]) * Fraction(9999, 10000) < low <= contact.clear
    assert event.time[1] < high < Fraction(event.time[1]) * Fraction(10001, 10000)
    assert claims["contact"]["kind"] == event.kind
    assert [tuple(face) for face in claims["contact"]["faces"]] == list(event.faces)
    assert [tuple(fold) for fold in claims["contact"]["folds"]] == list(event.folds)


def test_triangulated_triangles_are_single_faces():
    track, contact = first_contact(find_branch(nested_triangles(), "+-+"))
    claims = checker.check(certificate_with_contact(track, contact))
    assert contact.clear > 0
    assert Fraction(claims["clear"]) <= contact.clear


def test_the_mirror_image_touches_at_the_same_time():
    pattern, text = SHEETS["square 2, 1"]
    _, _, contact = proved("square 2, 1")
    found = [first_contact(find_branch(mapped(pattern, mirrored), text))[1]]
    found.append(first_contact(find_branch(pattern, text), -1)[1])
    for other in found:
        # The triangle that is held may be another, and its length another; the faces are not.
        assert other.event.kind == contact.event.kind
        assert set(map(frozenset, other.event.faces)) == set(map(frozenset, contact.event.faces))
    assert float(found[1].clear) == pytest.approx(float(contact.clear), rel=1e-4)


def test_a_track_that_ends_before_claims_that_it_is_clear():
    pattern, text = SHEETS["square 3, 0"]
    _, _, whole = proved("square 3, 0")
    watch = ContactWatch()
    track = follow_proved(find_branch(pattern, text), until=float(whole.clear) / 2, stop=watch)
    contact = watch.result(track)
    assert contact.status is UNDECIDED
    assert contact.event is None
    assert contact.open_faces == ()
    assert contact.clear == track.length[0] > 0
    document = certificate_with_contact(track, contact)
    claims = checker.check(document)
    assert "contact" not in claims
    assert contact.clear * Fraction(9999, 10000) < Fraction(claims["clear"]) <= contact.clear


def test_where_nothing_is_known_nothing_is_claimed():
    pattern, text = SHEETS["square 1, 0"]
    track = follow_proved(find_branch(pattern, text), until=1e-3)
    assert not track.links
    contact = ContactWatch().result(track)
    assert contact.parameters is None
    document = certificate_with_contact(track, contact)
    assert document == track.certificate()
    assert "clear" not in checker.check(document)


def test_contacts_agree_with_a_collision_library():
    """Faces made smaller by a thousandth about their middles, so that common parts do not count."""
    pytest.importorskip("fcl")
    collision = pytest.importorskip("trimesh.collision")
    trimesh = pytest.importorskip("trimesh")
    seen = 0
    for name in SHEETS:
        _, track, contact = proved(name)
        if contact.event.kind != "contact":
            continue
        faces = track.framework.sheet.triangles
        last = track.links[-1]

        def collide(points, faces=faces):
            manager = collision.CollisionManager()
            for k, face in enumerate(faces):
                corners = np.array([[float(x) for x in points[v]] for v in face])
                middle = corners.mean(axis=0)
                mesh = trimesh.Trimesh(middle + (corners - middle) * 0.999, [[0, 1, 2]])
                manager.add_object(str(k), mesh)
            return manager.in_collision_internal()

        assert not collide(configuration(track, last, contact.parameters[0]))
        later = min(last.tube.longest, contact.parameters[2] + (1 << PARAMETER_BITS - 5))
        if crossings(faces, configuration(track, last, later)):
            seen += collide(configuration(track, last, later))
    assert seen > 2
