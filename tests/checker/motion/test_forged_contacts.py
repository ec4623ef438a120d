"""Forged contacts: times that are too early or too late, other faces, and what is vaguely near."""

from __future__ import annotations

import json
import random
from collections.abc import Callable
from fractions import Fraction
from functools import cache
from typing import Any

import pytest
from forge import Document, beyond, refusal, refused, verified, without

from exactfold import checker
from exactfold.branches.counting.find import find_branch
from exactfold.checker.core.reading import CertificateError, shown
from exactfold.checker.motion import boxes as motion_boxes
from exactfold.checker.motion import certificate as motion
from exactfold.checker.motion import contacts as motion_contacts
from exactfold.checker.motion import lengths as motion_lengths
from exactfold.checker.motion.bounds import dot
from exactfold.checker.motion.contacts import check_contacts
from exactfold.checker.motion.lengths import GRID, ONE, Path
from exactfold.motion.contacts.claims import certificate_with_contact
from exactfold.motion.contacts.contacts import first_contact
from exactfold.pattern.triangulating.random_squares import random_square

BRANCHES = {
    "contact": (2, 2, "++"),
    "corner": (1, 2, "-"),
    "fold": (1, 3, "-"),
}


@cache
def _text(name: str) -> str:
    n, seed, signs = BRANCHES[name]
    document = certificate_with_contact(
        *first_contact(find_branch(random_square(n, seed=seed), signs))
    )
    if name == "corner":  # faces beside a fold that closes, which touch at the same time
        document["claims"]["contact"] |= {
            "kind": "contact",
            "faces": [[1, 2, 4], [0, 4, 3]],
            "folds": [],
        }
        document["evidence"]["contacts"]["from"] = document["evidence"]["contacts"]["to"]
    return json.dumps(document)


def given(name: str) -> Document:
    """A fresh copy of a certificate that claims a contact."""
    document: Document = json.loads(_text(name))
    return document


@cache
def pieces(name: str) -> tuple[Any, ...]:
    """The verified pieces of a certificate, which forged contacts leave as they are."""
    found: list[tuple[Any, ...]] = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(motion_contacts, "check_contacts", lambda *all_: found.append(all_))
        verified(given(name))
    return found[0][:3]


def judged(document: Document, name: str) -> None:
    """Verify the contacts alone, on the pieces of the certificate."""
    check_contacts(*pieces(name), document["claims"], document["evidence"]["contacts"])


Change = Callable[[Document, Document], None]


def forged(name: str, change: Change) -> Document:
    """The certificate after `change(claims, contacts)`."""
    document = given(name)
    change(document["claims"], document["evidence"]["contacts"])
    return document


def stopped(name: str, message: str, change: Change) -> None:
    """Refused with this message, and accepted with the line that says so taken out."""
    document = forged(name, change)
    with pytest.raises(refusal(message)) as caught:
        judged(document, name)
    assert str(caught.value) == message
    with without(message):
        judged(document, name)


def refused_alone(name: str, message: str, change: Change) -> None:
    """Refused with this message."""
    document = forged(name, change)
    with pytest.raises(CertificateError) as caught:
        judged(document, name)
    assert str(caught.value) == message


def longer(text: str, factor: str) -> str:
    return str(Fraction(text) * Fraction(factor))


# --- what is true --------------------------------------------------------------------------------


@pytest.mark.parametrize("name", BRANCHES)
def test_what_is_claimed_is_proved(name: str) -> None:
    document = given(name)
    claims = verified(document)
    assert claims["clear"] == claims["contact"]["time"][0]
    low, high = map(Fraction, claims["contact"]["time"])
    assert 0 < low < high < low * Fraction(10001, 10000)
    line = checker.summary(claims)
    before, by = shown(str(low)), shown(str(high), up=True)
    assert f"; no two faces touch before {before}, " in line
    faces = [tuple(face) for face in claims["contact"]["faces"]]
    ends = {
        "fold": f"the fold {tuple(claims['contact']['folds'][0]) if name == 'fold' else ''} is "
        f"closed by {by}; ",
        "contact": f"{faces[0]} and {faces[1]} do by {by}; ",
    }
    assert ends["fold" if name == "fold" else "contact"] in line
    shared = len(set(faces[0]) & set(faces[1]))
    assert shared == {"contact": 0, "corner": 1, "fold": 2}[name]


def test_less_may_be_claimed() -> None:
    for name in ("corner", "fold"):

        def only_clear(claims: Document, contacts: Document) -> None:
            del claims["contact"], contacts["from"], contacts["to"]

        document = forged(name, only_clear)
        judged(document, name)
        assert "; no two faces touch before 1" in motion.summary(
            {**document["claims"], "tubes": 1, "sha256": ""}
        )
        document["claims"]["clear"] = longer(document["claims"]["clear"], "1/2")
        judged(document, name)
        document["evidence"]["contacts"]["tube"] -= 1
        document["evidence"]["contacts"]["clear"] = 0
        judged(document, name)

    def wider(claims: Document, contacts: Document) -> None:
        claims["clear"] = claims["contact"]["time"][0] = longer(claims["clear"], "1/3")
        claims["contact"]["time"][1] = longer(claims["contact"]["time"][1], "2")

    judged(forged("contact", wider), "contact")


def test_old_certificates_claim_nothing_of_contacts() -> None:
    document = given("corner")
    del document["claims"]["clear"], document["claims"]["contact"], document["evidence"]["contacts"]
    assert "touch" not in checker.summary(verified(document))
    document["evidence"]["contacts"] = {}
    refused(document, "evidence: expected an object with the keys emptied pinned bits start tubes")
    document = given("corner")
    del document["claims"]["clear"]
    names = "vertex_signs side length clear contact"
    refused(document, f"claims: expected an object with the keys {names}")


def test_a_whole_certificate_with_a_false_contact_is_refused() -> None:
    """Not on pieces that were verified before, as below: the check itself looks at contacts."""
    document = given("contact")
    document["claims"]["clear"] = longer(document["claims"]["clear"], "1.00001")
    document["claims"]["contact"]["time"][0] = document["claims"]["clear"]
    refused(document, "the clear part of the motion is shorter than claimed")
    document = given("contact")
    latest = document["claims"]["contact"]["time"]
    latest[1] = longer(latest[1], "0.99998")
    refused(document, "the contact may be later than claimed")


# --- false times ---------------------------------------------------------------------------------


def test_times_that_are_too_late_or_too_early() -> None:
    def later(claims: Document, contacts: Document) -> None:
        claims["clear"] = claims["contact"]["time"][0] = longer(claims["clear"], "1000001/1000000")
        claims["clear"] = claims["contact"]["time"][0] = longer(claims["clear"], "1.00001")

    def earlier(claims: Document, contacts: Document) -> None:
        time = claims["contact"]["time"]
        time[1] = longer(time[1], "0.99998")

    def not_from_there(claims: Document, contacts: Document) -> None:
        claims["contact"]["time"][0] = longer(claims["clear"], "1.00001")

    for name in BRANCHES:
        stopped(name, "the clear part of the motion is shorter than claimed", later)
        stopped(name, "the contact may be later than claimed", earlier)
        message = 'the first "time" of a contact differs from "clear"'
        stopped(name, message, not_from_there)


@pytest.mark.parametrize("name", BRANCHES)
def test_what_is_not_clear_is_refused(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Farther than the contact: the pair that touches is named, whatever else is claimed.

    Other faces touch in the same moment, at the edges that meet or beside the fold that closes.
    They are looked at first, and are left out here.
    """
    document = given(name)
    wanted = set(map(frozenset, document["claims"]["contact"]["faces"]))

    def only(test: Any) -> Any:
        def other(faces: Any, boxes: Any, i: int, j: int, planar: bool) -> bool:
            pair = set(map(frozenset, (faces.faces[i], faces.faces[j])))
            return pair != wanted or test(faces, boxes, i, j, planar)

        return other

    def beyond(claims: Document, contacts: Document) -> None:
        contacts["clear"] = contacts["to"] + (1 << 32)
        del claims["contact"], contacts["from"], contacts["to"]

    with pytest.raises(CertificateError):
        judged(forged(name, beyond), name)
    for key in ("_apart", "_at_corner"):
        monkeypatch.setattr(motion_contacts.Faces, key, only(getattr(motion_contacts.Faces, key)))
    if name == "corner":
        monkeypatch.setattr(motion_contacts.Faces, "_open", lambda *_: True)
    with pytest.raises(CertificateError) as caught:
        judged(forged(name, beyond), name)
    place = "where the motion is claimed to be clear"
    if name == "fold":
        i, j = document["claims"]["contact"]["folds"][0]
        assert str(caught.value) == f"the faces at {i}-{j} may touch {place}"
    else:
        one, two = sorted(map(tuple, map(_turned, document["claims"]["contact"]["faces"])))
        assert str(caught.value) == f"the faces {one} and {two} may touch {place}"


def _turned(face: list[int]) -> list[int]:
    k = face.index(min(face))
    return face[k:] + face[:k]


def test_the_work_is_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    def nothing(claims: Document, contacts: Document) -> None:
        pass

    monkeypatch.setattr(motion_contacts, "MOST_TESTS", 100)
    stopped("corner", beyond("the tests of contacts", 103, 100, "MOST_TESTS"), nothing)


# --- false places --------------------------------------------------------------------------------


def test_parameters_out_of_range() -> None:
    document = given("corner")
    number = document["evidence"]["contacts"]["tube"]
    reach = document["evidence"]["tubes"][number - 1]["reach"] << 34

    for key, value in (("clear", reach + 1), ("clear", -reach - 1), ("to", reach + 1)):

        def moved(claims: Document, contacts: Document, key: str = key, value: int = value) -> None:
            contacts[key] = value

        refused_alone("corner", f'the parameter "{key}" is out of range', moved)

    def back(claims: Document, contacts: Document) -> None:
        contacts["from"] = -reach

    stopped("corner", 'the parameter "from" is out of range', back)

    def against(claims: Document, contacts: Document) -> None:
        contacts["from"] = contacts["to"] + 1

    stopped("corner", 'the parameter "to" is out of range', against)


def test_tubes_that_are_not_there() -> None:
    number = given("corner")["evidence"]["contacts"]["tube"]
    for other in (0, number + 1):

        def moved(claims: Document, contacts: Document, other: int = other) -> None:
            contacts["tube"] = other

        refused_alone("corner", "the contacts name a tube that does not exist", moved)


def test_keys() -> None:
    def more(claims: Document, contacts: Document) -> None:
        contacts["more"] = 1

    refused_alone("corner", "contacts: expected an object with the keys tube clear from to", more)

    def of_contact(claims: Document, contacts: Document) -> None:
        claims["contact"]["more"] = 1

    message = "contact: expected an object with the keys kind time faces folds"
    refused_alone("corner", message, of_contact)

    def less(claims: Document, contacts: Document) -> None:
        del claims["contact"]

    refused_alone("corner", "contacts: expected an object with the keys tube clear", less)


def test_other_tubes_hold_no_contact() -> None:
    """The contact in an earlier tube, and tubes in another order."""
    document = given("contact")
    document["evidence"]["contacts"]["tube"] -= 1
    document["claims"]["clear"] = document["claims"]["contact"]["time"][0] = "0"
    with pytest.raises(CertificateError) as caught:
        judged(document, "contact")
    assert str(caught.value) == "no side of one face is proved to run through the other face"
    for first in (0, 4):
        document = given("corner")
        tubes = document["evidence"]["tubes"]
        tubes[first], tubes[first + 1] = tubes[first + 1], tubes[first]
        with pytest.raises(CertificateError):
            verified(document)


# --- false faces ---------------------------------------------------------------------------------


def positions(name: str, parameter: int) -> dict[int, list[Fraction]]:
    """The middle of the box of a configuration on the tube of the contact."""
    number = given(name)["evidence"]["contacts"]["tube"]
    tube = pieces(name)[2][number - 1][0]
    flat = motion_boxes.flat_of(tube.equations)
    at = tube.enclosure(Fraction(parameter, 1 << 40)).centre
    x = {v: [Fraction(c, 1 << GRID) for c in point] for v, point in flat.items()}
    for v, k in tube.equations.place.items():
        x[v] = [p + Fraction(q, 1 << tube.bits) for p, q in zip(x[v], at[k : k + 3], strict=True)]
    return x


def test_faces_that_do_not_touch() -> None:
    """All pairs of faces, against the signs of volumes at the middle of the box, in rationals."""
    document = given("contact")
    contacts = document["evidence"]["contacts"]
    tube, later = pieces("contact")[2][contacts["tube"] - 1][0], contacts["to"] + (1 << 32)
    equations, x = tube.equations, positions("contact", later)
    faces = motion_contacts.Faces(equations)
    radii, rates = (getattr(tube, f)(tube.reach).radii for f in ("enclosure", "velocity"))
    path = Path.of_tube(tube.curve, tube.bits, tube.reach, radii, rates)
    touching = []
    for one in document["pattern"]["triangles"]:
        for two in document["pattern"]["triangles"]:
            truly = len(set(one) & set(two)) < 2 and crossing(x, one, two)
            assert faces.crossing(path, Fraction(later, 1 << 40), one, two) == truly
            touching += [(one, two)] * truly
    assert len(touching) >= 2

    def other(claims: Document, contacts: Document) -> None:
        claims["contact"]["faces"] = [list(faces.faces[0])] * 2

    stopped("contact", "no side of one face is proved to run through the other face", other)


def crossing(x: dict[int, list[Fraction]], one: Any, two: Any) -> bool:
    """Whether a side of one triangle runs through the inside of the other."""
    for first, second in ((one, two), (two, one)):
        for k in range(3):
            p, q = first[k], first[k - 1]
            if {p, q} & set(second):
                continue
            a, b, c = (x[v] for v in second)
            sides = [
                det(minus(x[q], x[p]), minus(s, x[p]), minus(t, x[p])) > 0
                for s, t in ((a, b), (b, c), (c, a))
            ]
            ends = [det(minus(b, a), minus(c, a), minus(x[v], a)) > 0 for v in (p, q)]
            if ends[0] != ends[1] and len(set(sides)) == 1:
                return True
    return False


def test_a_contact_must_have_happened() -> None:
    def not_yet(claims: Document, contacts: Document) -> None:
        contacts["to"] = contacts["from"] = contacts["clear"]

    stopped("contact", "no side of one face is proved to run through the other face", not_yet)


def test_what_is_no_face_or_fold() -> None:
    def no_kind(claims: Document, contacts: Document) -> None:
        claims["contact"]["kind"] = "touch"

    stopped("fold", "the contact is of no known kind", no_kind)

    def with_folds(claims: Document, contacts: Document) -> None:
        claims["contact"]["folds"] = [[0, 4]]

    stopped("corner", "a contact of two faces names folds", with_folds)
    triangles = given("corner")["pattern"]["triangles"]
    others = [[0, 1, 2], [0, 0, 4], [0, 1, 9]]
    assert not set(map(frozenset, others)) & set(map(frozenset, triangles))
    for face in others:

        def no_face(claims: Document, contacts: Document, face: Any = face) -> None:
            claims["contact"]["faces"][0] = face

        refused_alone("corner", "a face of the contact is not a face of the sheet", no_face)

    def of_a_fold(claims: Document, contacts: Document) -> None:
        claims["contact"]["faces"].reverse()

    stopped("fold", "the faces of the contact are not those at its fold", of_a_fold)


def test_folds_that_do_not_close() -> None:
    document = given("fold")
    [(i, j)] = document["claims"]["contact"]["folds"]
    for folds in ([], [[j, i]], [[i, j], [i, j]], [[0, 1]]):

        def no_fold(claims: Document, contacts: Document, folds: Any = folds) -> None:
            claims["contact"]["folds"] = folds

        refused_alone(
            "fold", "the contact does not name one fold of the sheet that closes", no_fold
        )
    sheet = pieces("fold")[0].equations.sheet
    for other in sheet.folds:
        if other == (i, j):
            continue

        def another(claims: Document, contacts: Document, fold: Any = other) -> None:
            a, b = fold
            faces = [[a, b, sheet.next[a][b]], [a, b, sheet.next[b][a]]]
            claims["contact"] |= {"folds": [list(fold)], "faces": faces}

        stopped("fold", "the fold of the contact is not proved to close", another)

    def not_yet(claims: Document, contacts: Document) -> None:
        contacts["to"] = contacts["clear"]

    stopped("fold", "the fold of the contact is not proved to close", not_yet)

    def too_late(claims: Document, contacts: Document) -> None:
        contacts["from"] = contacts["to"]

    stopped("fold", "the fold of the contact is not proved to close", too_late)


# --- the arithmetic, against rationals -----------------------------------------------------------


def path_of(rng: random.Random, size: int, degree: int) -> Path:
    rows = [
        [Fraction(rng.randint(-(10**9), 10**9), 10**9 * 2**k) for _ in range(size)]
        for k in range(degree + 1)
    ]
    return Path(rows, [Fraction(1, 10**8)] * size, Fraction(0), Fraction(1))


def test_boxes_hold_the_polynomials() -> None:
    rng = random.Random(0)
    flat = {0: [1 << 59, -(1 << 58), 0], 1: [0, 0, 0], 2: [1 << 60, 1 << 60, 0]}
    for degree in (8, 18):
        path = path_of(rng, 6, degree)
        for _ in range(20):
            low, high = sorted(rng.randint(-ONE, ONE) for _ in range(2))
            high = low + (high - low >> rng.randint(0, 20))
            boxes = motion_boxes.boxes_on(path, flat, {1: 0, 2: 3}, low, high, False)
            plane = motion_boxes.boxes_on(path, flat, {1: 0, 2: 3}, low, high, True)
            middle = (low + high) >> 1
            half = high - middle
            for x in (low, high, middle, rng.randint(low, high)):
                y = Fraction(x - middle + half, 2 * half) if half else Fraction(0)
                for v, k in ((1, 0), (2, 3)):
                    a, b, error = boxes[v]
                    for axis in range(3):
                        q = flat[v][axis] + sum(
                            c * Fraction(x, ONE) ** m for m, c in enumerate(path.columns[k + axis])
                        )
                        off = abs((1 - y) * a[axis] + y * b[axis] - q)
                        assert off + path.errors[k + axis] <= error
                        assert axis == 2 or plane[v][0][axis] == a[axis]
                    assert plane[v][0][2] == plane[v][1][2] == 0
            assert boxes[0] == (flat[0], flat[0], 1)


def test_boxes_are_not_much_wider_than_they_must() -> None:
    path = path_of(random.Random(1), 3, 8)
    boxes = motion_boxes.boxes_on(path, {0: [0, 0, 0]}, {0: 0}, 0, 1 << 20, False)
    assert boxes[0][2] < max(path.errors) + 200


def random_boxes(rng: random.Random, count: int, error: int) -> motion_boxes.Boxes:
    def point() -> list[int]:
        return [rng.randint(-100, 100) for _ in range(3)]

    found = {}
    for v in range(count):
        a = point()
        found[v] = a, [x + rng.randint(-9, 9) for x in a], error
    return found


def places(rng: random.Random, boxes: motion_boxes.Boxes) -> dict[int, list[int]]:
    """Some positions that the boxes allow, times 8."""
    y = rng.choice([0, 8, rng.randint(0, 8)])
    return {
        v: [(8 - y) * s + y * t + 8 * rng.choice([-e, 0, e]) for s, t in zip(a, b, strict=True)]
        for v, (a, b, e) in boxes.items()
    }


def minus(a: Any, b: Any) -> list[Any]:
    return [x - y for x, y in zip(a, b, strict=True)]


def det(a: Any, b: Any, c: Any) -> Any:
    return (
        a[0] * (b[1] * c[2] - b[2] * c[1])
        - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
    )


def test_tests_of_boxes_hold_for_all_that_is_in_them() -> None:
    rng = random.Random(2)
    seen = {"parted": 0, "corner": 0, "volume": 0, "upright": 0, "far": 0, "near": 0}
    for _ in range(1500):
        boxes = random_boxes(rng, 6, rng.choice([0, 1, 5]))
        n = [rng.randint(-9, 9) for _ in range(3)]
        one, two = (0, 1, 2), (3, 4, 5)
        limit = rng.randint(1, 40_000)
        told = {
            "parted": motion_boxes.parted(boxes, one, two, n),
            "corner": motion_boxes.parted_at(boxes, 0, (1, 2), (3, 4), n),
            "volume": motion_boxes.volume_sign(boxes, 0, 1, 2, 3),
            "upright": motion_boxes.upright(boxes, 0, 1, 2),
            "far": motion_boxes.open_by_distance(boxes, 0, 1, limit),
            "near": motion_boxes.nearer(boxes, 0, 1, limit),
        }
        truth = []
        for _ in range(12):
            x = places(rng, boxes)
            arms = [minus(x[v], x[0]) for v in (1, 2, 3, 4)]
            volume = det(*arms[:3])
            square = dot(arms[0], arms[0])
            heights = [dot(n, arm) for arm in arms]
            truth.append(
                {
                    "parted": min(dot(n, x[v]) for v in one) > max(dot(n, x[v]) for v in two),
                    "corner": min(heights[:2]) > 0 > max(heights[2:]),
                    "volume": (volume > 0) - (volume < 0),
                    "upright": arms[0][0] * arms[1][1] > arms[0][1] * arms[1][0],
                    "far": square > 64 * limit,
                    "near": square < 64 * limit,
                }
            )
        for key, said in told.items():
            if said:
                seen[key] += 1
                assert all(one_[key] == said for one_ in truth)
        exact = {v: (a, a, 0) for v, (a, _, _) in boxes.items()}
        x = {v: a for v, (a, _, _) in exact.items()}
        arms = [minus(x[v], x[0]) for v in (1, 2, 3)]
        turn = arms[0][0] * arms[1][1] - arms[0][1] * arms[1][0]
        assert motion_boxes.upright(exact, 0, 1, 2) == (turn > 0)
        square = dot(arms[0], arms[0])
        assert motion_boxes.open_by_distance(exact, 0, 1, square - 1)
        assert not motion_boxes.open_by_distance(exact, 0, 1, square)
        assert motion_boxes.nearer(exact, 0, 1, square + 1)
        assert not motion_boxes.nearer(exact, 0, 1, square)
    assert min(seen.values()) > 20


def test_a_volume_is_seen_as_soon_as_it_is_certain() -> None:
    size = 1 << GRID
    for lift, error, expected in (
        (1 << 40, 0, 1),
        (1 << 40, 1 << 50, 0),
        (-(1 << 59), 1 << 40, -1),
    ):
        at = {0: [0, 0, 0], 1: [size, 0, 0], 2: [0, size, 0], 3: [0, 0, lift]}
        boxes = {v: (x, x, error) for v, x in at.items()}
        assert motion_boxes.volume_sign(boxes, 0, 1, 2, 3) == expected


def test_directions_are_found_where_there_are_some() -> None:
    """For triangles a plane apart, and for corners on both sides of a plane through the vertex."""
    rng = random.Random(3)
    one, two = (0, 1, 2), (3, 4, 5)
    for k in range(400):
        planar = k % 2 == 0
        n = [rng.uniform(-1, 1), rng.uniform(-1, 1), 0 if planar else rng.uniform(-1, 1)]
        size = sum(c * c for c in n) ** 0.5
        boxes: motion_boxes.Boxes = {6: ([0, 0, 0], [0, 0, 0], 0)}
        for v in range(6):
            x = [rng.uniform(-1, 1) for _ in range(3)]
            height = sum(p * q for p, q in zip(n, x, strict=True)) / size
            wanted = rng.uniform(0.01, 1) * (1 if v < 3 else -1)
            x = [p + (wanted - height) * q / size for p, q in zip(x, n, strict=True)]
            if planar:
                x[2] = 0.0
            whole = [round(c * ONE) for c in x]
            boxes[v] = whole, whole, 1
        found = motion_boxes.best_apart(boxes, one, two, planar)
        assert motion_boxes.parted(boxes, one, two, found)
        assert not planar or found[2] == 0
        found = motion_boxes.best_corner(boxes, 6, (0, 1), (3, 4), planar)
        assert motion_boxes.parted_at(boxes, 6, (0, 1), (3, 4), found)
        assert not planar or found[2] == 0


def test_lengths_are_bounded() -> None:
    """Of a straight line, of a parabola, and with a velocity that is off."""
    line = Path(
        [[Fraction(0)] * 2, [Fraction(3), Fraction(4)]], [Fraction(0)] * 2, Fraction(0), Fraction(1)
    )
    assert 0 <= 5 - line.shortest(0, ONE) < Fraction(1, 10**12)
    assert 0 <= line.longest(0, ONE) - 5 < Fraction(1, 10**7)
    zero, one = Fraction(0), Fraction(1)
    rows = [[zero, zero], [one, zero], [zero, one / 2]]
    curve = Path(rows, [zero] * 2, zero, one)
    exact = 1.1477935746963190  # (sqrt 2 + arsinh 1) / 2
    assert exact * (1 - 1e-4) < curve.shortest(0, ONE) < exact < curve.longest(0, ONE)
    assert curve.longest(0, ONE) < exact * (1 + 1e-4)
    off = Path(rows, [zero] * 2, Fraction(1, 10), one)
    assert float(curve.shortest(0, ONE) - off.shortest(0, ONE)) == pytest.approx(0.1)
    assert float(off.longest(0, ONE) - curve.longest(0, ONE)) == pytest.approx(0.1)
    assert curve.shortest(5, 5) == curve.longest(5, 5) == curve.longest(6, 5) == 0
    assert curve.below(Fraction(1, 3)) + 1 == curve.above(Fraction(1, 3))
    assert curve.below(Fraction(1, 2)) == curve.above(Fraction(1, 2)) == ONE // 2
    assert motion_lengths.norm([Fraction(3), Fraction(4)]) >= 5


def test_the_distance_of_corners_at_a_closed_fold() -> None:
    sheet = pieces("corner")[0].equations.sheet
    equations = pieces("corner")[0].equations
    for i, j in sheet.folds:
        left, right = sheet.next[i][j], sheet.next[j][i]
        (p, q, a, b) = (sheet.points[v] for v in (i, j, left, right))
        e = minus(q, p)
        share = dot(minus(b, p), e) / dot(e, e)
        foot = [x + share * y for x, y in zip(p, e, strict=True)]
        mirror = [2 * x - y for x, y in zip(foot, b, strict=True)]
        near, far = minus(a, mirror), minus(a, b)
        closed, flat = motion_contacts.folded_over(equations, (i, j), left, right)
        assert closed * equations.unit**2 == dot(near, near)
        assert flat * equations.unit**2 == dot(far, far)
        assert closed < flat
