"""The arithmetic of the checker: linear algebra, polynomials with known roots, long numbers."""

from __future__ import annotations

import json
import math
import random
from fractions import Fraction
from itertools import product
from types import SimpleNamespace

import pytest
from forge import given, refused, unreadable
from forge import product as times

from exactfold.checker.branches.classes import AlgebraicRoot
from exactfold.checker.core import linear, polynomials, reading
from exactfold.checker.core.krawczyk import inverse
from exactfold.checker.core.reading import CertificateError, FormatError
from exactfold.checker.sheets import flat_folds
from exactfold.checker.sheets.sheet import Sheet, read_sheet

Matrix = list[list[Fraction]]


def fractions(*rows: list[object]) -> Matrix:
    return [[Fraction(x) for x in row] for row in rows]  # type: ignore[arg-type]


# --- linear algebra ------------------------------------------------------------------------------


def test_inertia_of_forms_with_known_signs() -> None:
    """P^T D P has the signs of D, for P with determinant not 0."""
    source = random.Random(2)
    for _ in range(300):
        n = source.randint(1, 5)
        signs = [source.choice((-2, 0, 0, 1, 3)) for _ in range(n)]
        while True:
            p = fractions(*([source.randint(-2, 2) for _ in range(n)] for _ in range(n)))
            try:
                inverse(p)
            except ZeroDivisionError:
                continue
            break
        form = [
            [sum(p[k][i] * signs[k] * p[k][j] for k in range(n)) for j in range(n)]
            for i in range(n)
        ]
        counts = [sum(s > 0 for s in signs), sum(s < 0 for s in signs), signs.count(0)]
        before = [list(row) for row in form]
        assert list(linear.inertia(form)) == counts
        assert form == before
    assert linear.inertia(fractions([0, 1, 0], [1, 0, 0], [0, 0, 0])) == (1, 1, 1)
    assert linear.inertia(fractions([0, 1, 1], [1, 0, 1], [1, 1, 0])) == (1, 2, 0)
    assert linear.inertia([]) == (0, 0, 0)


def test_kernels_and_echelon_forms() -> None:
    source = random.Random(4)
    for _ in range(300):
        size, count = source.randint(1, 5), source.randint(0, 5)
        rows = fractions(
            *([source.choice((0, 0, 1, -1, 2, 5)) for _ in range(size)] for _ in range(count))
        )
        lines, basis = linear.echelon(rows), linear.kernel(rows, size)
        assert len(lines) + len(basis) == size
        for line in [*rows, *lines.values()]:
            assert all(sum(a * b for a, b in zip(line, v, strict=True)) == 0 for v in basis)
        for k, line in lines.items():
            assert [other[k] for other in lines.values() if other is not line] == [0] * (
                len(lines) - 1
            )
            assert line[k] == 1
            assert not any(line[:k])
        free = [k for k in range(size) if k not in lines]
        assert [[v[k] for k in free] for v in basis] == [
            [Fraction(int(i == j)) for j in range(len(free))] for i in range(len(free))
        ]
    assert linear.kernel([], 2) == [[1, 0], [0, 1]]


def test_inverses() -> None:
    matrix = fractions([0, 2, 1], [1, 0, 0], [3, 1, 1])
    assert inverse(matrix) == fractions([0, 1, 0], [1, 3, -1], [-1, -6, 2])
    with pytest.raises(ZeroDivisionError):
        inverse(fractions([1, 2], [2, 4]))


@pytest.mark.parametrize(
    ("square", "root"),
    [
        ("4/9", "2/3"),
        ("0", "0"),
        ("1", "1"),
        ("49", "7"),
        ("1/4", "1/2"),
        ("2", None),
        ("3", None),
        ("1/2", None),
        ("4/3", None),
        ("3/4", None),
        ("2/9", None),
        ("9/8", None),
    ],
)
def test_square_roots_are_rational_or_none(square: str, root: str | None) -> None:
    assert linear.rational_sqrt(Fraction(square)) == (None if root is None else Fraction(root))


# --- polynomials ---------------------------------------------------------------------------------


def from_roots(*roots: object) -> list[Fraction]:
    p = [Fraction(1)]
    for root in roots:
        p = times(p, [-Fraction(root), Fraction(1)])  # type: ignore[arg-type]
    return p


def test_real_roots_are_counted_by_sturm() -> None:
    circle = [Fraction(2), Fraction(1), Fraction(1)]  # no real root
    for lead in (Fraction(1), Fraction(-3), Fraction(1, 7)):
        for roots in ((), (0,), (1, -2, 3), (5,), (-1, 1), ("1/3", 2, 7, -4), (0, 1, 2, 3, 4)):
            p = [lead * c for c in from_roots(*roots)]
            assert polynomials.count_real_roots(times(p, circle)) == len(roots)
            if roots:
                assert polynomials.count_real_roots(p) == len(roots)
    even = [Fraction(c) for c in (1, 0, 0, 0, 1)]
    assert polynomials.count_real_roots(even) == 0
    assert polynomials.count_real_roots([Fraction(c) for c in (-2, 0, 0, 1)]) == 1


def test_common_roots() -> None:
    assert polynomials.are_coprime(from_roots(1, 2), from_roots(3))
    assert polynomials.are_coprime(from_roots(1, 2), from_roots(3, 4, "1/2"))
    assert polynomials.are_coprime(from_roots(1), [Fraction(5)])
    # Integers stay exact: the quotient of two would be a float.
    assert not polynomials.are_coprime([-3, 10], [-489, 11290, -52300, 67000])
    assert polynomials.count_real_roots([-(10**400), 0, 0, 0, 1]) == 2
    for p, q in (
        (from_roots(1, 2), from_roots(2, 3)),
        (from_roots(1), from_roots(3, 1, 4)),
        (from_roots(1, 2), from_roots(1, 2)),
        (from_roots(1), [Fraction(0)]),
    ):
        assert not polynomials.are_coprime(p, q)
        assert not polynomials.are_coprime([3 * c for c in q], p)


def test_arithmetic_of_polynomials() -> None:
    source = random.Random(6)
    for _ in range(200):
        p, q, r = (
            [Fraction(source.randint(-3, 3)) for _ in range(source.randint(0, 5))] for _ in range(3)
        )
        q += [Fraction(source.choice((1, -2)))]
        x = Fraction(source.randint(-9, 9), 7)
        p_x, q_x, r_x = (sum((c * x**k for k, c in enumerate(f)), Fraction(0)) for f in (p, q, r))
        assert polynomials.value(p, x) == p_x
        assert polynomials.value(polynomials.times(p, q), x) == p_x * q_x
        assert polynomials.value(polynomials.plus(p, r), x) == p_x + r_x
        assert polynomials.value(polynomials.scaled(p, Fraction(3, 2)), x) == p_x * 3 / 2
        before = list(p)
        rest = polynomials.remainder(p, q)
        assert p == before
        assert len(rest) < len(q)
        assert not rest or rest[-1]
        whole = polynomials.plus(polynomials.times(r, q), rest)  # the same modulo q
        assert polynomials.remainder(whole, q) == rest
        d = polynomials.derivative(p)
        assert len(d) == max(len(p) - 1, 0)
        assert d == [k * c for k, c in enumerate(p)][1:]
        low, high = sorted((x, Fraction(source.randint(-9, 9), 5)))
        least, most = polynomials.bounds(p, low, high)
        for k in range(5):
            assert least <= polynomials.value(p, low + k * (high - low) / 4) <= most
    assert polynomials.bounds([Fraction(1), Fraction(2)], Fraction(-1), Fraction(3)) == (-1, 7)
    assert polynomials.bounds([Fraction(1), Fraction(-2)], Fraction(-1), Fraction(3)) == (-5, 3)
    square = [Fraction(0), Fraction(0), Fraction(1)]
    assert polynomials.bounds(square, Fraction(-1), Fraction(3)) == (-3, 9)
    assert polynomials.bounds(square, Fraction(-3), Fraction(-2)) == (4, 9)


# --- numbers and text ----------------------------------------------------------------------------


def test_long_integers_survive() -> None:
    for n in (
        0,
        -7,
        10**4000,
        -(10**9001) + 3,
        10**9001 + 3,
        7**20000,
        2**12999,
        2**13000,
        -(2**13001),
        1 - 10**50,
    ):
        text = reading.digits(n)
        assert reading.parse_integer(text) == n
        assert text.lstrip("-").isdigit()
        assert text.startswith("-") == (n < 0)
        assert text.lstrip("-")[0] != "0" or n == 0
    assert reading.parse_integer("9" * 4000 + "1" * 4001 + "0" * 3) == (
        (10**4000 - 1) * 10**4004 + (10**4001 - 1) // 9 * 1000
    )
    assert reading.parse_integer("-00012") == -12


@pytest.mark.parametrize(
    "text", ["", "-", "+1", "1 ", " 1", "1_0", "0x1", "--1", "1-", "\u0661", "\u00b2", "1.0", "1e3"]
)
def test_other_text_is_no_integer(text: str) -> None:
    with pytest.raises(CertificateError) as caught:
        reading.parse_integer(text)
    assert str(caught.value) == f"{text!a} is not an integer"


def test_rationals() -> None:
    for text, value in (("3", 3), ("-3/6", Fraction(-1, 2)), ("0/5", 0), ("10/2", 5)):
        assert reading.parse_rational(text) == value
    for text in ("1/0", "1/-2"):
        with pytest.raises(CertificateError) as caught:
            reading.parse_rational(text)
        assert str(caught.value) == f"{text!a} has no positive denominator"
    for text in ("1/", "/2", "1/2/3"):
        with pytest.raises(CertificateError, match="is not an integer"):
            reading.parse_rational(text)
    for other in (1, None, 0.5, True, ["1"]):
        with pytest.raises(CertificateError) as caught:
            reading.parse_rational(other)
        assert str(caught.value) == f"{other!a} is not a rational number in quotes"


def test_long_text_is_cut_where_it_is_quoted() -> None:
    for text, quoted in (("x" * 50, "x" * 40), ("y" * 41, "y" * 40)):
        with pytest.raises(CertificateError) as caught:
            reading.parse_integer(text)
        assert str(caught.value) == f"{quoted!a} is not an integer"
    with pytest.raises(CertificateError) as caught:
        reading.parse_rational("1/" + "0" * 60)
    assert str(caught.value) == f"{'1/' + '0' * 38!a} has no positive denominator"


def test_messages_are_one_line_of_printable_ascii() -> None:
    assert reading.plain("a ~b") == "a ~b"
    assert reading.plain("a\nb\x7f\u00e9\ud800\x1b") == "a\\nb\\x7f\\xe9\\ud800\\x1b"
    assert reading.plain("x" * 1001) == "x" * 1000
    assert reading.plain("\n" * 1000) == "\\n" * 500
    assert reading.plain(CertificateError("no")) == "no"


KEYS = "format version pattern claims evidence provenance"


def test_texts_that_are_no_certificates() -> None:
    text = json.dumps(given("listing-one-vertex"))
    for number in ("1.0", "2e0", "NaN", "Infinity", "-Infinity", "1E400"):
        changed = text.replace('"multiplicity": 1', f'"multiplicity": {number}')
        unreadable(changed, f"a certificate holds no floats, but here is {number}")
    unreadable(f"[{'1' * 50}.5]", f"a certificate holds no floats, but here is {'1' * 40}")
    unreadable(
        text.replace('"multiplicity": 1', f'"multiplicity": {"7" * 4001}'),
        f"an integer is too long: {'7' * 40}...",
    )
    refused(
        json.loads(text.replace('"multiplicity": 1', f'"multiplicity": {"7" * 4000}')),
        "branch 0: multiplicity is 1",
    )
    unreadable(text.replace('"bits"', '"bits": 1, "bits"', 1), "a key appears twice in one object")
    for other in ("[]", "1", "null", '"x"', "{}", '{"format": "x"}', '{"format": ["a"]}'):
        unreadable(other, 'the object has no "format" that this checker knows')
    for version in ("1", "3", '"2"', "true", "null", "[2]"):
        shown = repr(json.loads(version))
        unreadable(
            text.replace('"version": 2', f'"version": {version}'),
            f"version {shown} is not known to this checker",
        )
    unreadable(
        text.replace('"provenance"', '"origin"'),
        f"the object: expected an object with the keys {KEYS}",
    )
    branch = json.dumps(given("branch-dart"))
    unreadable(
        branch.replace('"version": 1', '"version": 4'), "version 4 is not known to this checker"
    )
    unreadable(
        branch[:-1] + ', "provenance": 1}',
        "the object: expected an object with the keys format version pattern claims evidence",
    )
    for cut in ("", text[:-1], "[" * 10**5, "{'a': 1}"):
        with pytest.raises(FormatError, match=r"^not JSON, or cut off: "):
            reading.read_json(cut)


def test_lists_objects_and_naturals() -> None:
    assert reading.items([1, 2], "x") == [1, 2]
    assert reading.items([1, 2], "x", 2) == [1, 2]
    assert reading.natural(0, "x") == 0
    assert reading.integer(-3) == -3
    assert reading.text_of("a") == "a"
    reading.keys({"a": 1, "b": 2}, "b a", "x")
    for call, message in (
        (lambda: reading.items((1,), "x"), "x is not a list"),
        (lambda: reading.items([1], "x", 0), "x does not have 0 entries"),
        (lambda: reading.natural(-1, "x"), "x is not a natural number"),
        (lambda: reading.natural(True, "x"), "x is not a natural number"),
        (lambda: reading.integer(True), "True is not an integer"),
        (lambda: reading.integer("1"), "'1' is not an integer"),
        (lambda: reading.text_of(1), "1 is not a number in quotes"),
        (lambda: reading.keys({"a": 1}, "a b", "x"), "x: expected an object with the keys a b"),
        (lambda: reading.keys([], "a b", "x"), "x: expected an object with the keys a b"),
    ):
        with pytest.raises(CertificateError) as caught:
            call()
        assert str(caught.value) == message


# --- folds that are flat -------------------------------------------------------------------------


def test_flat_folds_of_a_cross_and_of_a_generic_vertex() -> None:
    """K_v = 0 on the cross: one straight crease folds, and the other is flat; else none is."""
    for name, signs, expected in (
        ("listing-cross", (0, None, None, None), set()),  # any such sheet has K_v = 0
        ("listing-cross", (1, None, None, None), {(1, 4), (3, 4)}),
        ("listing-cross", (None, -1, None, None), {(0, 4), (2, 4)}),
        ("listing-cross", (None, None, None, None), set()),
        ("listing-cross", (0, None, 0, None), set()),
        ("listing-cross", (0, 0, None, None), {(2, 4), (3, 4)}),
        ("listing-one-vertex", (1, None, None, None), set()),
        ("listing-one-vertex", (0, None, None, None), {(1, 4), (2, 4), (3, 4)}),
        ("listing-one-vertex", (0, 0, None, None), {(2, 4), (3, 4)}),
    ):
        sheet, _ = read_sheet(given(name)["pattern"])
        folds = tuple((min(4, j), max(4, j)) for j in sheet.star(4))
        assert folds == ((0, 4), (1, 4), (2, 4), (3, 4))
        assert set(flat_folds.flat_at(sheet, 4, folds, signs)) == expected


def test_a_sheet_remembers_which_folds_are_flat_up_to_a_limit(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(flat_folds, "MOST_KNOWN", 2)
    sheet, _ = read_sheet(given("listing-cross")["pattern"])
    folds = ((0, 4), (1, 4), (2, 4), (3, 4))
    for side, most in ((1, 1), (0, 2), (0, 2), (-1, 1), (0, 2)):
        signs = (side, None, None, None)
        first = flat_folds.flat_at(sheet, 4, folds, signs)
        assert first == flat_folds.forced_flat(sheet, 4, folds, signs)
        assert flat_folds.flat_at(sheet, 4, folds, signs) is first
        assert len(sheet.forced_flat) == most


def random_star(source: random.Random, spokes: int) -> Sheet:
    """A vertex 0 with as many neighbours around it, all angles below pi."""
    while True:
        steps = sorted(source.sample(range(24), spokes))
        if max(b - a for a, b in zip(steps, [*steps[1:], steps[0] + 24], strict=True)) > 10:
            continue
        ring = []
        for k in steps:  # near the angle k pi / 12
            x, y = round(30 * math.cos(k * math.pi / 12)), round(30 * math.sin(k * math.pi / 12))
            length = Fraction(source.randint(3, 9), 7)
            ring.append((x * length, y * length))
        points = {0: (Fraction(0), Fraction(0)), **dict(enumerate(ring, 1))}
        faces = [(0, k, k % spokes + 1) for k in range(1, spokes + 1)]
        return Sheet(points, faces)


def test_folds_are_flat_where_the_form_leaves_nothing_else() -> None:
    """Bends that agree with the flat folds, in dimension 1 or 2, where K_v is definite."""
    source, seen = random.Random(8), {True: 0, False: 0}
    for _ in range(250):
        spokes = source.randint(4, 7)
        sheet = random_star(source, spokes)
        folds = tuple((0, j) for j in sheet.star(0))
        free = sheet.star(0)[2:]
        flat = source.sample(range(spokes), source.randint(0, spokes - 2))
        signs = tuple(0 if k in flat else None for k in range(spokes))
        rows = [[Fraction(sheet.bend(fold).get(j, 0)) for j in free] for fold in folds]
        basis = linear.kernel([rows[k] for k in flat], len(free))
        form = linear.matrix_of(sheet.curvature(0), free)
        inner = [
            [
                sum(
                    (u[i] * form[i][j] * v[j] for i, j in product(range(len(free)), repeat=2)),
                    Fraction(0),
                )
                for v in basis
            ]
            for u in basis
        ]
        definite = linear.inertia(inner) in ((0, len(basis), 0), (len(basis), 0, 0))
        found = flat_folds.forced_flat(sheet, 0, folds, signs)
        if len(basis) <= 2 and definite:
            assert found == [fold for fold, sign in zip(folds, signs, strict=True) if sign is None]
            seen[True] += 1
        elif len(basis) > 2:
            assert found == []
            seen[False] += 1
    assert min(seen.values()) > 30


# --- signs at algebraic numbers ------------------------------------------------------------------


def root_of(p: list[int], low: object, high: object) -> AlgebraicRoot:
    """x = t at the root of p between the ends, as a root of a class with the one unknown x."""
    entry = SimpleNamespace()
    entry.p = [Fraction(c) for c in p]
    entry.slope = polynomials.derivative(entry.p)
    entry.w = [polynomials.remainder([Fraction(0), *entry.slope], entry.p)]
    return AlgebraicRoot(entry, Fraction(low), Fraction(high))  # type: ignore[arg-type]


@pytest.mark.parametrize(("low", "high"), [("1", "2"), ("0", "100"), ("-1", "1415/1000")])
def test_signs_at_the_square_root_of_two(low: str, high: str) -> None:
    """On either side of it by 10^-40, for the polynomial, its negative and the other root."""
    unit = 10**40
    near = math.isqrt(2 * unit * unit)
    for p in ([-2, 0, 1], [4, 0, -2]):
        for row, expected in (
            ([unit, -near], 1),
            ([unit, -near - 1], -1),
            ([0, 5], 1),
            ([0, 0], 0),
        ):
            assert root_of(p, low, high).sign(row) == expected
            turned = root_of(p, -Fraction(high), -Fraction(low))
            assert turned.sign([-row[0], row[1]]) == expected
            assert turned.sign([row[0], -row[1]]) == -expected


def test_signs_where_halving_meets_the_root() -> None:
    assert root_of([-1, 1], "1", "1").sign([1, 0]) == 1
    assert root_of([1, -1], "1", "1").sign([1, 0]) == 1
    for low, high in (("0", "2"), ("1", "1"), ("-1/2", "5/2"), ("1/2", "9/8")):
        for row, expected in (
            ([1, -1], 0),
            ([1, -2], -1),
            ([1, 0], 1),
            ([-3, 3], 0),
            ([-1, 0], -1),
        ):
            if high != "9/8" or expected:
                assert root_of([-1, 0, 1], low, high).sign(row) == expected
