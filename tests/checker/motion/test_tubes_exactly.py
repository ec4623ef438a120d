"""What the checker computes of tubes, against the same numbers in rationals, worked out anew."""

from __future__ import annotations

import itertools
import random
from collections.abc import Sequence
from fractions import Fraction
from types import SimpleNamespace
from typing import Any, NamedTuple

import pytest
from forge import given_lines

from exactfold.checker.core.reading import CertificateError, LimitError
from exactfold.checker.motion import boxes as motion_boxes
from exactfold.checker.motion import contacts as motion_contacts
from exactfold.checker.motion import faces as motion_faces
from exactfold.checker.motion import tubes as motion_tubes
from exactfold.checker.motion.bounds import Bounds
from exactfold.checker.motion.chain import Path as Passed
from exactfold.checker.motion.contacts import Faces
from exactfold.checker.motion.equations import LengthEquations, at
from exactfold.checker.motion.lengths import GRID, ONE, Path, entry
from exactfold.checker.motion.tubes import Ball, Piece, Start, Tube
from exactfold.checker.sheets.sheet import read_sheet

Row = list[Fraction]
Matrix = list[Row]

HEADER, LOOP, _ = given_lines("loops-one-vertex")
BITS = 70
MORE = BITS - HEADER["bits"]


def equations() -> LengthEquations:
    return LengthEquations(read_sheet(HEADER["pattern"])[0], HEADER["pinned"], BITS)


class Made(NamedTuple):
    """A piece, and the P and the weights with which it is proved."""

    piece: Any
    p: Matrix
    weights: Row


def made(kind: Any, *given: Any) -> Made:
    """A piece of the sheet of `equations`, along another curve than the checker would take.

    Any would do. On this one no coefficient of an equation is 0.
    """
    kept: list[Any] = []
    rng, extended, nearest = random.Random(0), motion_tubes.extended, motion_tubes.nearest

    def other(curve: list[list[int]]) -> list[list[int]]:
        first, *rest = curve
        return [first, *([x + rng.randint(-(1 << 40), 1 << 40) for x in row] for row in rest)]

    def seen(*values: Any) -> Bounds:
        kept.extend((values[0], values[-1]))
        return bounds(*values)

    bounds = motion_tubes.bounds
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(motion_tubes, "bounds", seen)
        patch.setattr(motion_tubes, "extended", lambda *values: other(extended(*values)))
        patch.setattr(motion_tubes, "nearest", lambda *values: other(nearest(*values)))
        piece = kind(*given)
    p = [[Fraction(x, 1 << 40) for x in row] for row in kept[0]]
    return Made(piece, p, [Fraction(w, 1 << 16) for w in kept[1]])


def product(a: Matrix, b: Matrix) -> Matrix:
    columns = list(zip(*b, strict=True))
    return [[sum(map(Fraction.__mul__, row, c), Fraction(0)) for c in columns] for row in a]


def norm(rows: Sequence[Fraction], weights: Row) -> Fraction:
    return max(x / w for x, w in zip(rows, weights, strict=True))


def assert_bounds(found: list[int], exact: list[Fraction], room: int = 100) -> None:
    """The bounds are those, rounded up by 2^-room at most, and no other coefficient is left."""
    assert len(found) <= len(exact)
    assert not any(exact[len(found) :])
    for over, y in zip(found, exact, strict=False):
        x = Fraction(over, 1 << 128)
        assert 0 <= x - y <= y / (1 << 50) + Fraction(1, 1 << room)


def edge_vectors(sheet: LengthEquations, row: Sequence[Fraction]) -> list[Row]:
    """a_i - a_j for all edges with a free end, of the unknowns of the free vertices in turn."""
    zero = [Fraction(0)] * 3
    place = {v: list(row[3 * k : 3 * k + 3]) for k, v in enumerate(free(sheet))}
    return [
        [a - b for a, b in zip(place.get(i, zero), place.get(j, zero), strict=True)]
        for i, j in edges(sheet)
    ]


def free(sheet: LengthEquations) -> list[int]:
    return sorted(set(sheet.sheet.points) - set(HEADER["pinned"]))


def edges(sheet: LengthEquations) -> list[tuple[int, int]]:
    return [(i, j) for i, j in sheet.sheet.edges if {i, j} - set(HEADER["pinned"])]


def unit(sheet: LengthEquations) -> Fraction:
    """A power of two over the common denominator of the coordinates, at least as large as all."""
    points = sheet.sheet.points
    x, y = points[HEADER["pinned"][0]]
    far = max(max(abs(a - x), abs(b - y)) for a, b in points.values())
    found = Fraction(1, 512)
    while found <= far:
        found *= 2
    return found


def flat(sheet: LengthEquations) -> list[Row]:
    points, size = sheet.sheet.points, unit(sheet)
    return [
        [(points[i][a] - points[j][a]) / size for a in (0, 1)] + [Fraction(0)]
        for i, j in edges(sheet)
    ]


def gradient(sheet: LengthEquations, rows: list[Row], last: Row) -> Matrix:
    """The matrix of d -> rows_e . (d_i - d_j), and a last row."""
    place = {v: 3 * k for k, v in enumerate(free(sheet))}
    found = []
    for (i, j), row in zip(edges(sheet), rows, strict=True):
        line = [Fraction(0)] * (3 * len(place))
        for v, sign in ((i, 1), (j, -1)):
            if v in place:
                for a in range(3):
                    line[place[v] + a] += sign * row[a]
        found.append(line)
    return [*found, last]


def assert_slopes(proof: Bounds, this: Made, slopes: list[Matrix]) -> None:
    """|P M_k|, less 1 for k = 0."""
    exact = []
    for k, slope in enumerate(slopes):
        image = product(this.p, slope)
        for i, row in enumerate(image):
            row[i] -= int(k == 0)
        sums = [sum((abs(x) * w for x, w in zip(r, this.weights, strict=True))) for r in image]
        exact.append(norm([Fraction(x) for x in sums], this.weights))
    assert_bounds(proof.q, exact, 36)  # of each entry about 62 digits of the largest are read


def assert_bends(proof: Bounds, this: Made, squares: list[Row]) -> None:
    exact = [
        norm(
            [
                sum((abs(x) * s for x, s in zip(row[:-1], square, strict=True)), Fraction(0))
                for row in this.p
            ],
            this.weights,
        )
        for square in squares
    ]
    assert_bounds(proof.kappa, exact, 20)  # one square is rounded up by 2^-32


def assert_residuals(proof: Bounds, this: Made, residuals: Matrix) -> None:
    exact = [
        norm([abs(sum(map(Fraction.__mul__, r, g), Fraction(0))) for r in this.p], this.weights)
        for g in residuals
    ]
    assert_bounds(proof.b, exact)


def coefficients(piece: Any) -> Matrix:
    return [[Fraction(x, 1 << BITS) for x in row] for row in piece.curve]


def widths(sheet: LengthEquations, weights: Row) -> list[Row]:
    """w_i + w_j, 0 where a vertex is held."""
    zero = [Fraction(0)] * 3
    place = {v: list(weights[3 * k : 3 * k + 3]) for k, v in enumerate(free(sheet))}
    return [
        [a + b for a, b in zip(place.get(i, zero), place.get(j, zero), strict=True)]
        for i, j in edges(sheet)
    ]


def test_the_bounds_of_a_tube() -> None:
    """U_e . d_e + |d_e|^2 / 2 for every edge and T(d - c) - s, along d = p(s)."""
    sheet, given = equations(), LOOP["evidence"]["steps"][1]
    assert sheet.unit == unit(sheet)
    tube = made(Tube, sheet, [x << MORE for x in given["centre"]], given["row"], Fraction(1, 2))
    curve, row = coefficients(tube.piece), [Fraction(t, 1 << 20) for t in given["row"]]
    assert curve[0] == [Fraction(x, 1 << 64) for x in given["centre"]]
    parts, rest = [edge_vectors(sheet, c) for c in curve], flat(sheet)
    residuals = []
    for k in range(2 * len(curve)):
        values = [Fraction(0)] * len(rest)
        for e, u in enumerate(rest):
            if k < len(curve):
                values[e] += sum(map(Fraction.__mul__, u, parts[k][e]), Fraction(0))
            for i in range(len(curve)):
                if 0 <= k - i < len(curve):
                    values[e] += sum(map(Fraction.__mul__, parts[i][e], parts[k - i][e])) / 2
        along = Fraction(-1 if k == 1 else 0)
        if 0 < k < len(curve):
            along += sum(map(Fraction.__mul__, row, curve[k]))
        residuals.append([*values, along])
    assert_residuals(tube.piece.proof, tube, residuals)
    here = [[a + b for a, b in zip(u, e, strict=True)] for u, e in zip(rest, parts[0], strict=True)]
    none = [Fraction(0)] * sheet.size
    slopes = [gradient(sheet, here, row)] + [gradient(sheet, part, none) for part in parts[1:]]
    assert_slopes(tube.piece.proof, tube, slopes)
    bends = [sum((a * a for a in w), Fraction(0)) for w in widths(sheet, tube.weights)]
    assert_bends(tube.piece.proof, tube, [bends])
    assert tube.piece.apart == tube.piece.proof.uniqueness(Fraction(1, 2))


@pytest.mark.parametrize("halvings", [1, 3])
def test_the_bounds_of_the_first_piece(halvings: int) -> None:
    """U . u + h^2 / 2 + s |u|^2 / 2 / 4^halvings for every edge, and the height that is held."""
    sheet, given = equations(), LOOP["evidence"]["start"]
    held = sheet.place[given["held"]] + 2
    centre = [x << MORE for x in given["centre"]]
    start = made(Start, sheet, centre, halvings, held, Fraction(1, 2))
    curve, rest = coefficients(start.piece), flat(sheet)
    parts = [edge_vectors(sheet, c) for c in curve]
    small, zero = Fraction(1, 4**halvings), Fraction(0)
    residuals = []
    for k in range(2 * len(curve) + 1):
        values = [zero] * len(rest)
        for e, u in enumerate(rest):
            if k < len(curve):
                values[e] += u[0] * parts[k][e][0] + u[1] * parts[k][e][1]
            for i in range(len(curve)):
                if 0 <= k - i < len(curve):
                    values[e] += parts[i][e][2] * parts[k - i][e][2] / 2
                if 0 <= k - 1 - i < len(curve):
                    a, b = parts[i][e], parts[k - 1 - i][e]
                    values[e] += (a[0] * b[0] + a[1] * b[1]) * small / 2
        residuals.append([*values, curve[k][held] if 0 < k < len(curve) else zero])
    assert_residuals(start.piece.proof, start, residuals)
    none = [zero] * sheet.size
    slopes = []
    for k in range(len(curve) + 1):
        rows = []
        for e, u in enumerate(rest):
            x, y = (u[0], u[1]) if k == 0 else (small * parts[k - 1][e][a] for a in (0, 1))
            rows.append([x, y, parts[k][e][2] if k < len(curve) else zero])
        last = [Fraction(int(i == held)) for i in range(sheet.size)] if k == 0 else none
        slopes.append(gradient(sheet, rows, last))
    assert_slopes(start.piece.proof, start, slopes)
    wide = widths(sheet, start.weights)
    bends = [[w[2] ** 2 for w in wide], [(w[0] ** 2 + w[1] ** 2) * small for w in wide]]
    assert_bends(start.piece.proof, start, bends)


# --- boxes ---------------------------------------------------------------------------------------


def curve_of(rng: random.Random, size: int, degree: int) -> list[list[int]]:
    return [[rng.randint(-999, 999) for _ in range(size)] for _ in range(degree + 1)]


def polynomial(curve: list[list[int]], i: int, s: Fraction) -> Fraction:
    return sum((row[i] * s**k for k, row in enumerate(curve)), Fraction(0))


def slope(curve: list[list[int]], i: int, s: Fraction) -> Fraction:
    return sum((k * row[i] * s ** (k - 1) for k, row in enumerate(curve) if k), Fraction(0))


def bounds(b: list[str], q: list[str], kappa: list[str]) -> Bounds:
    return Bounds(*([round(Fraction(x) * (1 << 128)) for x in part] for part in (b, q, kappa)))


def test_boxes_hold_what_is_proved_and_little_more() -> None:
    """Numbers so small that every rounding shows; q, kappa and b that grow with s."""
    rng = random.Random(1)
    weights = [1 << 16, 1 << 15, 3 << 14]
    for proof in (
        bounds(["0"], ["0"], ["1"]),
        bounds(["0", "1/64"], ["1/8", "1/16"], ["1", "1/4"]),
    ):
        for _ in range(60):
            curve = curve_of(rng, 3, 3)
            given: Any = SimpleNamespace(bits=9)
            piece = Piece(given, curve, weights, proof, Fraction(1))
            s = Fraction(rng.randint(-99, 99), 99)
            r = proof.radius(abs(s))
            rate = proof.velocity(abs(s), r)
            for box, value, radius in (
                (piece.enclosure(s), polynomial, r),
                (piece.velocity(s), slope, rate),
            ):
                assert all(type(x) is int for x in (*box.centre, *box.radii))
                for i, w in enumerate(weights):
                    room = radius * w * 512 / (1 << 16)
                    off = abs(value(curve, i, s) - box.centre[i])
                    assert off + room <= box.radii[i] <= room + 3
    edge = Piece(given, curve, weights, proof, Fraction(1))
    assert edge.enclosure(Fraction(-1)).centre == at(curve, Fraction(-1))
    for s in (Fraction(-65, 64), Fraction(65, 64)):
        with pytest.raises(CertificateError, match=r"^a motion leaves a tube beyond its reach$"):
            edge.enclosure(s)


def test_a_velocity_is_bounded_by_the_derivative_of_the_equations() -> None:
    """(b' + q' r + kappa' r^2 / 2) / (1 - q - kappa r), with ' for the derivative by h."""
    proof = bounds(["1/64", "1/32", "1/16"], ["1/8", "1/16", "1/32"], ["1/2", "1/4", "1/8"])
    h, r = Fraction(3, 4), Fraction(1, 8)
    b, q, kappa = (
        c[1] + 2 * c[2] * h
        for c in (
            [Fraction(1, 64), Fraction(1, 32), Fraction(1, 16)],
            [Fraction(1, 8), Fraction(1, 16), Fraction(1, 32)],
            [Fraction(1, 2), Fraction(1, 4), Fraction(1, 8)],
        )
    )
    q_at = Fraction(1, 8) + h / 16 + h * h / 32
    kappa_at = Fraction(1, 2) + h / 4 + h * h / 8
    exact = (b + q * r + kappa * r * r / 2) / (1 - q_at - kappa_at * r)
    assert 0 <= proof.velocity(h, r) - exact < Fraction(1, 1 << 50)
    room = (1 - q_at) / kappa_at
    assert room * Fraction(98, 100) < proof.uniqueness(h) <= room * Fraction(63, 64)
    found = proof.radius(h)
    size = Fraction(1, 64) + h / 32 + h * h / 16
    assert size + q_at * found + kappa_at * found**2 / 2 < found
    assert q_at + kappa_at * found < 1


@pytest.mark.parametrize("halvings", [0, 2])
def test_configurations_of_the_first_piece(halvings: int) -> None:
    """(t^2 u, t h) and its derivative by tau, t = tau / 2^halvings, for tau of both signs."""
    rng = random.Random(halvings)
    proof = bounds(["1/64", "1/32"], ["1/8"], ["1"])
    weights = [1 << 16, 1 << 15, 3 << 14, 1 << 14, 1 << 16, 1 << 15]
    for _ in range(40):
        start = object.__new__(Start)
        curve, one = curve_of(rng, 6, 2), 1 << 8
        given: Any = SimpleNamespace(bits=8, size=6)
        Piece.__init__(start, given, curve, weights, proof, Fraction(1))
        start.halvings = halvings
        tau = Fraction(rng.choice((-1, 1)) * rng.randint(1, 60), 64)
        s, t = tau * tau, Fraction(tau, 1 << halvings)
        boxes = start.configuration(tau)
        r = proof.radius(s)
        rate = proof.velocity(s, r)
        for i, w in enumerate(weights):
            off, fast = (x * w * one / (1 << 16) for x in (r, rate))
            y, dy = polynomial(curve, i, s), slope(curve, i, s)
            p = 1 if i % 3 == 2 else 2
            exact = t**p * y, p * t ** (p - 1) * y / (1 << halvings) + t**p * 2 * tau * dy
            room = (
                abs(t**p) * off,
                abs(p * t ** (p - 1)) * off / (1 << halvings) + abs(t**p * 2 * tau) * fast,
            )
            for box, x, most in zip(boxes, exact, room, strict=True):
                assert abs(x - box.centre[i]) + most <= box.radii[i] <= most + 20


# --- links ---------------------------------------------------------------------------------------


def link(apart: Fraction, reach: Fraction = Fraction(4)) -> Any:
    """T = (1, -1/2), p(s) = (s, 3 s - 7) over 2^4, weights 1 and 1/2."""
    return SimpleNamespace(
        bits=4,
        row=[1 << 20, -(1 << 19)],
        curve=[[0, -7], [16, 48], [0, 0]],
        reach=reach,
        apart=apart,
        weights=[1 << 16, 1 << 15],
    )


def met(tube: Any, centre: list[int], radii: list[int], velocity: Ball) -> Any:
    return Tube.met(tube, Ball(centre, radii), velocity)


ONWARDS = Ball([3, 1], [1, 2])


def test_where_a_motion_meets_a_tube() -> None:
    wide, least = Fraction(1000), Fraction(1, 1 << 30)
    # x - c = (12, 8): s = (12 - 4) / 16; the radii 2 and 4 let s be off by (2 + 2) / 16.
    assert met(link(wide), [12, 1], [2, 4], ONWARDS) == (Fraction(1, 4), Fraction(3, 4))
    assert Tube.entered(_with_met(link(wide)), Ball([12, 1], [2, 4]), ONWARDS) == Fraction(3, 4)
    met(link(wide, Fraction(3, 4)), [12, 1], [2, 4], ONWARDS)
    met(link(wide, Fraction(3, 4)), [-12, -15], [2, 4], ONWARDS)
    for centre in ([12, 1], [-12, -15]):
        with pytest.raises(CertificateError, match=r"^a motion enters a tube beyond its reach$"):
            met(link(wide, Fraction(3, 4) - least), centre, [2, 4], ONWARDS)
    # p(1/2) = (8, 17) is (4, 16) away; and one for rounding, the radii, and 1/4 of p' = (16, 48).
    for gaps in ((4 + 1 + 2 + 4, 16 + 1 + 4 + 12),):
        room = max(Fraction(gaps[0], 16), Fraction(gaps[1], 16) * 2)
        met(link(room + least), [12, 1], [2, 4], ONWARDS)
        with pytest.raises(CertificateError, match=r"^a motion does not enter the next tube"):
            met(link(room), [12, 1], [2, 4], ONWARDS)
    flat_one = link(Fraction(11, 16))
    flat_one.weights = [1 << 16, 1 << 26]
    with pytest.raises(CertificateError, match=r"^a motion does not enter the next tube"):
        met(flat_one, [12, 1], [2, 4], ONWARDS)


def _with_met(tube: Any) -> Any:
    tube.met = lambda ball, velocity: Tube.met(tube, ball, velocity)
    return tube


def test_how_fast_a_curve_moves_away() -> None:
    """p = (8 s^2 - 8 s^3, 0): |p'| is at most 16 reach + 24 reach^2."""
    tube = link(Fraction(0), Fraction(2))
    tube.row, tube.curve = [0, 1 << 20], [[0, 0], [0, 16], [8, 0], [-8, 0]]
    tube.weights = [1 << 16, 1 << 30]
    room = Fraction(1 + 16 * 2 + 24 * 4, 16)
    tube.apart = room
    with pytest.raises(CertificateError, match=r"^a motion does not enter the next tube"):
        met(tube, [0, 0], [0, 16], Ball([0, 1], [0, 0]))
    tube.apart = room + Fraction(1, 1 << 30)
    assert met(tube, [0, 0], [0, 16], Ball([0, 1], [0, 0])) == (-1, 1)


def test_the_direction_in_which_a_tube_is_entered() -> None:
    """T . x' = 3 - 1/2 with 2 + 1/2 to spare is not certain; with less it is."""
    for centre, radii, onwards in (
        ([3, 1], [2, 1], False),
        ([3, 1], [1, 2], True),
        ([3, 0], [2, 1], True),
        ([-3, 1], [1, 1], False),
        ([0, 0], [0, 0], False),
    ):
        velocity = Ball(centre, radii)
        if onwards:
            met(link(Fraction(1000)), [12, 1], [2, 4], velocity)
        else:
            with pytest.raises(CertificateError, match=r"^a motion may enter a tube backwards$"):
                met(link(Fraction(1000)), [12, 1], [2, 4], velocity)


def test_a_tube_may_be_left_and_met_where_it_is_entered() -> None:
    path = Passed((Ball([0, 0], [0, 0]), ONWARDS), 4)
    tube = _with_met(link(Fraction(1000)))
    tube.entered = lambda ball, velocity: Tube.entered(tube, ball, velocity)
    tube.enclosure = tube.velocity = lambda s: Ball([0, 0], [0, 0])
    path.here = Ball([12, 1], [2, 4])
    path.enter(tube)
    assert path.entered == Fraction(3, 4)
    for s in (Fraction(3, 4) - Fraction(1, 1 << 40), Fraction(-1)):
        with pytest.raises(CertificateError, match=r"^a motion leaves a tube before it enters$"):
            path.leave(s)
    # (21, 2): s = (21 - 4.5) / 16, with 4.5 / 16 to spare on both sides: 3/4 at least.
    with pytest.raises(CertificateError, match=r"^a motion meets another piece before it enters"):
        path.meet(Ball([21, 2], [2, 6]), ONWARDS)
    path.meet(Ball([21, 2], [2, 5]), ONWARDS)
    path = Passed((Ball([12, 1], [2, 4]), ONWARDS), 4)
    path.enter(tube)
    path.leave(Fraction(3, 4))


# --- stretches -----------------------------------------------------------------------------------


def test_the_first_piece_as_a_path() -> None:
    """All coefficients, and errors that hold the farthest corner of what the boxes allow."""
    rng, halvings, bits, tau = random.Random(4), 2, 20, Fraction(3, 4)
    curve = [[rng.randint(-(1 << 20), 1 << 20) for _ in range(6)] for _ in range(3)]
    radii, rates = ([rng.randint(1, 1 << 10) for _ in range(6)] for _ in range(2))
    path = Path.of_start(curve, bits, halvings, tau, radii, rates)
    t, one, total = tau / 4, 1 << bits, Fraction(0)
    assert (path.scale, path.degree) == (tau, 6)
    for i in range(6):
        p = 1 if i % 3 == 2 else 2
        exact = [Fraction(0)] * 7
        for k in range(3):
            exact[2 * k + p] = Fraction(curve[k][i], one) * t**p * tau ** (2 * k)
        assert all(0 <= x * ONE - c < 1 for x, c in zip(exact, path.columns[i], strict=True))
        off = Fraction(radii[i], one) * t**p
        assert off * ONE + 6 <= path.errors[i] <= off * ONE + 9
        total += ((p * radii[i] + 2 * tau**2 * rates[i]) * t**p / one) ** 2
    assert total <= path.off**2 <= total * Fraction(1001, 1000)


def test_a_tube_as_a_path() -> None:
    rng, bits, reach = random.Random(5), 20, Fraction(5, 4)
    curve = [[rng.randint(-(1 << 20), 1 << 20) for _ in range(3)] for _ in range(4)]
    radii, rates = ([rng.randint(1, 1 << 10) for _ in range(3)] for _ in range(2))
    path = Path.of_tube(curve, bits, reach, radii, rates)
    one = 1 << bits
    assert (path.scale, path.degree) == (reach, 3)
    for i in range(3):
        exact = [Fraction(row[i], one) * reach**k for k, row in enumerate(curve)]
        assert all(0 <= x * ONE - c < 1 for x, c in zip(exact, path.columns[i], strict=True))
        off = Fraction(radii[i], one) * ONE
        assert off + 4 <= path.errors[i] <= off + 6
    total = sum((Fraction(r, one) * reach) ** 2 for r in rates)
    assert total <= path.off**2 <= total * Fraction(1001, 1000)
    tube: Any = SimpleNamespace(bits=4, row=[1 << 20, -(1 << 19)], curve=[[0, -7], [1, 1]])
    assert entry(tube, Ball([12, 1], [2, 4])) == (Fraction(1, 4), Fraction(3, 4))


def test_roundings_of_a_path_are_counted() -> None:
    """Coefficients below a unit: what is left out is in the errors, and in the bound of dq/dx."""
    tiny = Fraction(ONE - 1, ONE) / ONE
    path = Path([[tiny] * 2 for _ in range(5)], [Fraction(0)] * 2, Fraction(0), Fraction(1))
    assert path.columns == [[0] * 5] * 2
    assert all(e >= 5 * tiny * ONE for e in path.errors)
    steep = sum(k * tiny for k in range(5))
    assert path.off**2 >= 2 * steep**2


def test_the_flat_sheet_on_the_grid() -> None:
    sheet = equations()
    points, size = sheet.sheet.points, unit(sheet)
    found = motion_boxes.flat_of(sheet)
    assert found.keys() == points.keys()
    origin = points[HEADER["pinned"][0]]
    for v, place in found.items():
        exact = [(a - b) / size * ONE for a, b in zip(points[v], origin, strict=True)]
        assert all(0 <= x - c < 1 for x, c in zip(exact, place, strict=False))
        assert place[2:] == [0]


def test_lengths_below_a_unit_are_bounded_too() -> None:
    """Of straight lines so slow that every rounding shows, where the length is exact."""
    rng = random.Random(9)
    for _ in range(40):
        across, along = rng.choice(((3, 4), (5, 12), (8, 15))), rng.randint(1, 9)
        size = {3: 5, 5: 13, 8: 17}[across[0]] * along
        rows = [[Fraction(0)] * 2, [Fraction(x * along, ONE) for x in across]]
        path = Path(rows, [Fraction(0)] * 2, Fraction(0), Fraction(1))
        path.off = Fraction(0)
        low, high = sorted(rng.randint(-ONE, ONE) for _ in range(2))
        exact = Fraction(size * (high - low), ONE * ONE)
        assert path.shortest(low, high) <= exact <= path.longest(low, high)
        path.off = Fraction(1, 100)
        assert path.shortest(low, high) == 0
        assert path.longest(low, high) >= exact + Fraction(high - low, 100 * ONE)


def test_boxes_of_vertices_with_other_errors() -> None:
    """Each vertex has the largest error of its own places, and a unit more for every rounding."""
    rng = random.Random(8)
    for degree in (1, 2, 4, 8, 18):
        path: Any = SimpleNamespace(degree=degree)
        for _ in range(10):
            path.columns = [[rng.randint(-9, 9) for _ in range(degree + 1)] for _ in range(9)]
            path.errors = [rng.choice((0, 100, 1000)) for _ in range(9)]
            low, high = sorted(rng.randint(-ONE, ONE) for _ in range(2))
            rest = {v: [rng.randint(-ONE, ONE) for _ in range(3)] for v in range(3)}
            boxes = motion_boxes.boxes_on(path, rest, {v: 3 * v for v in rest}, low, high, False)
            half = high - ((low + high) >> 1)
            for v, (a, b, error) in boxes.items():
                assert type(error) is int
                known = max(path.errors[3 * v : 3 * v + 3])
                assert error >= known + degree * (degree + 1) // 2 + 4
                for x in (low, high, rng.randint(low, high)):
                    y = Fraction(x - high + 2 * half, 2 * half)
                    for i in range(3):
                        column = path.columns[3 * v + i]
                        q = sum(c * Fraction(x, ONE) ** m for m, c in enumerate(column))
                        off = abs((1 - y) * a[i] + y * b[i] - rest[v][i] - q)
                        assert off + path.errors[3 * v + i] <= error


def test_arms_that_turn_past_each_other() -> None:
    """Upright in the middle, and not at an end: each time one product of two changes decides."""
    for one, two in (
        (([-10, 3, 0], [10, 3, 0]), ([-3, 10, 0], [-3, -10, 0])),
        (([3, -10, 0], [3, 10, 0]), ([-10, 3, 0], [10, 3, 0])),
    ):
        boxes = {0: ([0] * 3, [0] * 3, 0), 1: (*one, 0), 2: (*two, 0)}
        middle = [[(a + b) // 2 for a, b in zip(*ends, strict=True)] for ends in (one, two)]
        assert middle[0][0] * middle[1][1] - middle[0][1] * middle[1][0] == 9
        assert not motion_boxes.upright(boxes, 0, 1, 2)


def test_a_volume_that_drifts_and_is_off() -> None:
    """z >= 1 along the line, but off by 2."""
    size = 10**6
    m = [0, 0, size], [4 * size, 4 * size, 5 * size], 2 * size
    boxes = {0: ([0] * 3, [0] * 3, 0), 3: m}
    for v, x in ((1, [1000 * size, 0, 0]), (2, [0, 1000 * size, 0])):
        boxes[v] = x, x, 0
    assert motion_boxes.volume_sign(boxes, 0, 1, 2, 3) == 0
    boxes[3] = m[0], m[0], size // 16
    assert motion_boxes.volume_sign(boxes, 0, 1, 2, 3) == 1


def test_boxes_of_a_few_units() -> None:
    """What is said of small boxes holds in all their corners, at both ends."""
    rng, seen = random.Random(10), {"volume": 0, "upright": 0}
    for _ in range(3000):
        boxes: motion_boxes.Boxes = {}
        for v in range(4):
            a = [rng.randint(-6, 6) for _ in range(3)]
            boxes[v] = a, [x + rng.choice((0, 0, -1, 1, 5)) for x in a], rng.choice((0, 0, 0, 1))
        volume = motion_boxes.volume_sign(boxes, 0, 1, 2, 3)
        upright = motion_boxes.upright(boxes, 0, 1, 2)
        for end in (0, 1):
            for _ in range(4 if volume or upright else 0):
                x = [[c + rng.choice((-e, e)) for c in (a, b)[end]] for a, b, e in boxes.values()]
                (p, q, r), (s, t, u), (f, g, h) = (
                    [b - a for a, b in zip(x[0], x[k], strict=True)] for k in (1, 2, 3)
                )
                exact = p * (t * h - u * g) - q * (s * h - u * f) + r * (s * g - t * f)
                assert not volume or exact * volume > 0
                assert not upright or p * t - q * s > 0
        seen["volume"] += volume != 0
        seen["upright"] += upright
    assert min(seen.values()) > 20


def test_when_a_fold_is_closed() -> None:
    """Farther than closed, and nearer than at 90 degrees, which no flat fold is: on the grid."""
    sheet = equations()
    faces = Faces(sheet)
    assert sorted(faces.folds) == sorted(sheet.sheet.folds)
    for fold, (left, right, closed) in faces.folds.items():
        mean = faces.means[fold]
        near, far = (x * 4**GRID for x in motion_contacts.folded_over(sheet, fold, left, right))
        assert 0 <= closed - near < 1
        assert 0 <= (near + far) / 2 - mean < 1
        assert near < mean < far


def faces_for(accepted: Any, pairs: str) -> tuple[Faces, dict[str, list[tuple[int, int]]]]:
    """Faces whose tests accept some stretches, and what they accept."""
    seen: dict[str, list[tuple[int, int]]] = {"apart": [], "corner": [], "open": []}

    class Told(Faces):
        def __init__(self) -> None:
            self.faces = self.names = [(0, 1, 2), (3, 4, 5)]
            self.work, self.spent, self.flat = 10**6, 0, {}
            self.place = {}
            self.apart = [(0, 1)] if "apart" in pairs else []
            self.corner = [(0, 1)] if "corner" in pairs else []
            self.folds = {(7, 8): (0, 0, 0)} if "open" in pairs else {}

        def told(self, key: str, boxes: Any, planar: bool) -> bool:
            a, b, plane = boxes
            assert plane == planar
            if accepted(a, b):
                seen[key].append((a, b))
                return True
            return False

        def _apart(self, boxes: Any, i: int, j: int, planar: bool) -> bool:
            return self.told("apart", boxes, planar)

        def _at_corner(self, boxes: Any, i: int, j: int, planar: bool) -> bool:
            return self.told("corner", boxes, planar)

        def _open(self, boxes: Any, i: int, j: int, planar: bool) -> bool:
            return self.told("open", boxes, planar)

    return Told(), seen


@pytest.fixture
def plain_boxes(monkeypatch: pytest.MonkeyPatch) -> None:
    """The boxes of a stretch are its ends."""
    monkeypatch.setattr(
        motion_faces,
        "boxes_on",
        lambda path, flat, place, low, high, planar: (low, high, planar),
    )


@pytest.mark.usefixtures("plain_boxes")
@pytest.mark.parametrize("planar", [False, True])
@pytest.mark.parametrize("kept", [1, 2, 1 << 10])
def test_every_moment_of_a_stretch_is_looked_at(
    planar: bool, kept: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The stretches that are accepted follow each other from the first moment to the last."""
    monkeypatch.setattr(motion_faces, "_KEPT", kept)
    rng = random.Random(6)
    path: Any = None
    for _ in range(20):
        low = rng.randint(-ONE, ONE)
        high = low + rng.randint(1, ONE)
        hard = rng.randint(low, high)

        def accepted(a: int, b: int, hard: int = hard) -> bool:
            return b - a < 1 << 17 or max(hard - b, a - hard) > (b - a) // 8

        faces, seen = faces_for(accepted, "apart corner open")
        faces.clear(path, low, high, planar)
        for parts in seen.values():
            ordered = sorted(parts)
            assert ordered[0][0] == low
            assert ordered[-1][1] == high
            assert len(ordered) > 10
            for (_, end), (begin, _) in itertools.pairwise(ordered):
                assert end == begin
    faces, seen = faces_for(lambda a, b: True, "apart corner open")
    faces.clear(path, 5, 4, planar)
    assert not any(seen.values())
    faces.clear(path, 5, 5, planar)
    assert all(parts == [(5, 5)] for parts in seen.values())


@pytest.mark.usefixtures("plain_boxes")
def test_what_is_never_accepted_is_refused() -> None:
    path: Any = None
    for pairs, what in (
        ("apart", "the faces (0, 1, 2) and (3, 4, 5)"),
        ("corner", "the faces (0, 1, 2) and (3, 4, 5)"),
        ("open", "the faces at 7-8"),
    ):
        for hard in (0, ONE // 3, ONE):
            faces, _ = faces_for(lambda a, b, hard=hard: not a <= hard <= b, pairs)
            with pytest.raises(CertificateError) as caught:
                faces.clear(path, 0, ONE)
            assert str(caught.value) == f"{what} may touch where the motion is claimed to be clear"
            assert faces.spent < 4 * GRID


@pytest.mark.usefixtures("plain_boxes")
def test_tests_and_boxes_are_counted() -> None:
    path: Any = None
    faces, _ = faces_for(lambda a, b: True, "apart corner open")
    faces.flat = {0: [0, 0, 0], 1: [0, 0, 0]}
    faces.work = 5  # boxes once, for two vertices, and three tests
    faces.clear(path, 0, ONE)
    assert faces.spent == 5
    with pytest.raises(LimitError, match="the tests of contacts, 6, are more than the limit, 5"):
        faces.clear(path, 0, ONE)
