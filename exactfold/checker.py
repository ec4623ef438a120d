"""Stand-alone checker of exactfold certificates: believes nothing, needs the standard library only.

    python checker.py CERTIFICATE.json

rebuilds the sheet and its curvature forms from the vertices and triangles in the file by code of
its own, and verifies every claim. Exit code 0: every claim holds. 1: some claim is not supported.
3: not a certificate. What each kind of evidence proves is set out in docs/certificate.md; in short

  isolated       2^n disjoint boxes, each with exactly one zero by Krawczyk's test in integers:
                 by refined Bezout these are all zeros of n quadrics in P^n, all real and simple;
  algebraic      zeros as roots of squarefree polynomials, in boxes, or in boxes on the sheets
                 that are flat at given vertices; a zero at which f of the
                 quadrics have order 2 has multiplicity 2^f or more, and the sum reaches 2^n, so
                 that the bounds are exact and nothing is missing;
  rigid          a positive definite stress: the sheet cannot fold;
  single vertex  the inertia (1, N - 3, 3) of one curvature form, N >= 5: one double cone.

Floating point is used in one place, to choose the matrix Y of Krawczyk's test, which may be any.
"""

from __future__ import annotations

import functools
import hashlib
import itertools
import json
import sys
from collections.abc import Iterable, Iterator
from contextlib import suppress
from decimal import MAX_EMAX, MIN_EMIN, Context, Decimal, localcontext
from fractions import Fraction
from math import gcd, isqrt, lcm
from typing import Any, NoReturn

Point = tuple[Fraction, Fraction]
Edge = tuple[int, int]
Form = dict[tuple[int, int], Fraction]
Poly = list[Any]

FORMAT, VERSION = "exactfold certificate", 2
MOST_BITS = 1 << 14  # a bound on the work one file can ask for


class CertificateError(Exception):
    """A claim of the certificate is not supported by its evidence."""


class FormatError(Exception):
    """The file is not a certificate of a known format and version."""


def require(condition: object, message: str) -> None:
    """Raise `CertificateError` unless the condition holds."""
    if not condition:
        raise CertificateError(message)


def plain(error: object) -> str:
    """A message in printable ASCII on one line, at most 1000 characters, whatever it quotes."""
    return "".join(c if " " <= c <= "~" else ascii(c)[1:-1] for c in str(error)[:1000])[:1000]


# --- reading -------------------------------------------------------------------------------------


def parse_integer(text: str) -> int:
    """Exact integer of any length from decimal digits."""
    sign, digits = (-1, text[1:]) if text[:1] == "-" else (1, text)
    if not (digits.isascii() and digits.isdigit()):
        raise CertificateError(f"{text[:40]!a} is not an integer")
    value = 0
    for start in range(0, len(digits), 4000):
        part = digits[start : start + 4000]
        value = value * 10 ** len(part) + int(part)
    return sign * value


def parse_rational(text: Any) -> Fraction:
    """Exact rational from "p" or "p/q"."""
    require(isinstance(text, str), f"{text!a} is not a rational number in quotes")
    numerator, slash, denominator = text.partition("/")
    q = parse_integer(denominator) if slash else 1
    require(q > 0, f"{text[:40]!a} has no positive denominator")
    return Fraction(parse_integer(numerator), q)


def read_json(text: str) -> Any:
    """A JSON value without floats, repeated keys or integers that Python would not print."""

    def refuse(number: str) -> NoReturn:
        raise FormatError(f"a certificate holds no floats, but here is {number[:40]}")

    def integer(number: str) -> int:
        if len(number) > 4000:  # longer ones are written as text; Python would not print them
            raise FormatError(f"an integer is too long: {number[:40]}...")
        return int(number)

    def unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        keys = [key for key, _ in pairs]
        if len(set(keys)) != len(keys):
            raise FormatError("a key appears twice in one object")
        return dict(pairs)

    try:
        return json.loads(
            text,
            parse_float=refuse,
            parse_constant=refuse,
            parse_int=integer,
            object_pairs_hook=unique,
        )
    except (ValueError, RecursionError) as error:
        raise FormatError(f"not JSON, or cut off: {error}") from None


def read_document(text: str, form: str, version: int, names: str) -> dict[str, Any]:
    """The JSON object of a file of the given format and version with the keys `names`."""
    data = read_json(text)
    if not isinstance(data, dict) or data.get("format") != form:
        raise FormatError(f'the object has no "format": "{form}"')
    if type(data.get("version")) is not int or data["version"] != version:
        raise FormatError(f"version {data.get('version')!a} is not known to this checker")
    keys(data, names, "the object", FormatError)
    return data


def load(text: str) -> dict[str, Any]:
    """The JSON object of a certificate; raises `FormatError`."""
    return read_document(text, FORMAT, VERSION, "format version pattern claims evidence provenance")


def keys(value: Any, names: str, what: str, error: type[Exception] = CertificateError) -> None:
    """Raise unless `value` is an object with exactly these keys."""
    if not isinstance(value, dict) or sorted(value) != sorted(names.split()):
        raise error(f"{what}: expected an object with the keys {names}")


def items(value: Any, what: str, length: int | None = None) -> list[Any]:
    """`value` if it is a list (of the given length)."""
    require(isinstance(value, list), f"{what} is not a list")
    require(length is None or len(value) == length, f"{what} has not {length} entries")
    return list(value)


def natural(value: Any, what: str) -> int:
    """`value` if it is an integer >= 0."""
    if type(value) is not int or value < 0:
        raise CertificateError(f"{what} is not a natural number")
    return value


# --- the sheet -----------------------------------------------------------------------------------


def turn(a: Point, b: Point, c: Point) -> Fraction:
    """Twice the signed area of the triangle abc."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


class Sheet:
    """A flat triangulated disk, verified."""

    def __init__(self, points: dict[int, Point], triangles: Iterable[tuple[int, ...]]) -> None:
        self.points = points
        self.next: dict[int, dict[int, int]] = {v: {} for v in points}
        for a, b, c in triangles:
            require(len({a, b, c}) == 3 and {a, b, c} <= points.keys(), f"bad face {(a, b, c)}")
            require(turn(points[a], points[b], points[c]) > 0, f"face {(a, b, c)} is not positive")
            for i, j, k in ((a, b, c), (b, c, a), (c, a, b)):
                require(j not in self.next[i], f"two faces on one side of edge {i}-{j}")
                self.next[i][j] = k
        require(len(set(points.values())) == len(points), "two vertices at one point")
        self.triangles = {frozenset(t) for t in triangles}
        self.edges = sorted(
            {(min(i, j), max(i, j)) for t in self.triangles for i in t for j in t if i != j}
        )
        self._disk()
        self.interior = sorted(set(points) - set(self.boundary))
        rim = set(zip(self.boundary, self.boundary[1:] + self.boundary[:1], strict=True))
        self.folds = [(i, j) for i, j in self.edges if (i, j) not in rim and (j, i) not in rim]

    def _disk(self) -> None:
        follow = {}
        for v, fan in self.next.items():
            require(fan, f"vertex {v} is on no face")
            ends = [a for a in fan if v not in self.next[a]]
            at, steps = (ends or list(fan))[0], 0
            start = at
            while at in fan:
                at, steps = fan[at], steps + 1
                if at == start:
                    break
            require(len(ends) <= 1 and steps == len(fan), f"the sheet is pinched at vertex {v}")
            if ends:
                follow[v] = ends[0]
        require(follow, "the sheet has no boundary")
        cycle = [min(follow)]
        while follow[cycle[-1]] != cycle[0]:
            cycle.append(follow[cycle[-1]])
        require(len(cycle) == len(follow), "the boundary is not one cycle")
        euler = len(self.points) - len(self.edges) + len(self.triangles)
        seen, stack = {cycle[0]}, [cycle[0]]
        while stack:
            for a, b in self.next[stack.pop()].items():
                stack += [v for v in (a, b) if v not in seen]
                seen |= {a, b}
        require(euler == 1 and len(seen) == len(self.points), "the sheet is not one disk")
        self.boundary = cycle
        self._check_simple(list(zip(cycle, cycle[1:] + cycle[:1], strict=True)))

    def _check_simple(self, sides: list[Edge]) -> None:
        """No two sides meet; compared only where their intervals of x do."""
        spans = {side: sorted(self.points[v][0] for v in side) for side in sides}
        active: list[Edge] = []
        for side in sorted(sides, key=lambda side: spans[side]):
            active = [other for other in active if spans[other][1] >= spans[side][0]]
            for other in active:
                require(not self._meet(side, other), f"boundary edges {side}, {other} meet")
            active.append(side)

    def _meet(self, first: Edge, second: Edge) -> bool:
        shared = set(first) & set(second)
        if shared:
            apex, end, other = shared, set(first) - shared, set(second) - shared
            p, q, r = (self.points[min(only)] for only in (apex, end, other))
            along = sum((q[k] - p[k]) * (r[k] - p[k]) for k in (0, 1))
            return turn(p, q, r) == 0 and along > 0
        a, b, c, d = (self.points[v] for v in first + second)
        abc, abd, cda, cdb = turn(a, b, c), turn(a, b, d), turn(c, d, a), turn(c, d, b)
        if abc == abd == 0:
            return all(
                min(a[k], b[k]) <= max(c[k], d[k]) and min(c[k], d[k]) <= max(a[k], b[k])
                for k in (0, 1)
            )
        return abc * abd <= 0 and cda * cdb <= 0

    def star(self, vertex: int) -> list[int]:
        """Neighbours of an interior vertex, counter-clockwise."""
        fan = self.next[vertex]
        cycle = [min(fan)]
        while fan[cycle[-1]] != cycle[0]:
            cycle.append(fan[cycle[-1]])
        return cycle

    def curvature(self, vertex: int) -> Form:
        """The curvature form K_v as {(i, j): coefficient}, symmetric, over all pairs of the star.

        K_v(h) = sum_j x_j x_{j+1} / c_j - (s_j / 2 c_j) (x_j^2 / L_j^2 + x_{j+1}^2 / L_{j+1}^2)
        with x_j = h_j - h_v, c_j and s_j the cross and dot product of neighbouring spokes.
        """
        ring, (x, y) = self.star(vertex), self.points[vertex]
        spoke = {j: (self.points[j][0] - x, self.points[j][1] - y) for j in ring}
        form: Form = {}

        def add(
            i: int, j: int, weight: Fraction
        ) -> None:  # weight * x_i * x_j, with x_i = h_i - h_v
            for a, s in ((i, 1), (vertex, -1)):
                for b, t in ((j, 1), (vertex, -1)):
                    form[a, b] = form.get((a, b), 0) + weight * s * t / 2
                    form[b, a] = form.get((b, a), 0) + weight * s * t / 2

        for i, j in zip(ring, ring[1:] + ring[:1], strict=True):
            (ax, ay), (bx, by) = spoke[i], spoke[j]
            c, s = Fraction(ax * by - ay * bx), ax * bx + ay * by
            add(i, j, 1 / c)
            add(i, i, -s / (2 * c) / (ax * ax + ay * ay))
            add(j, j, -s / (2 * c) / (bx * bx + by * by))
        return form

    def sign_of_vertex(self, vertex: int) -> dict[int, Fraction]:
        """Coefficients of h -> K_v(t, h) for a rational t with K_v(t) > 0 that points up."""
        form, (x, y) = self.curvature(vertex), self.points[vertex]
        bits = 16
        while True:
            cone = {vertex: Fraction(0)}
            for j in self.star(vertex):
                square = (self.points[j][0] - x) ** 2 + (self.points[j][1] - y) ** 2
                product = square.numerator * square.denominator << 2 * bits
                cone[j] = -Fraction(isqrt(product), square.denominator << bits)
            if sum(w * cone[i] * cone[j] for (i, j), w in form.items()) > 0:
                row: dict[int, Fraction] = {}
                for (i, j), w in form.items():
                    row[j] = row.get(j, 0) + w * cone[i]
                return row
            bits *= 2

    def bend(self, fold: Edge) -> dict[int, Fraction]:
        """Coefficients of the bend across a fold, positive where the sheet is locally convex."""
        i, j = fold
        k, m = self.next[i][j], self.next[j][i]
        p, q, r, s = (self.points[v] for v in (i, j, k, m))
        return {i: -turn(q, r, s), j: turn(p, r, s), k: -turn(p, q, s), m: turn(p, q, r)}

    def emptied(self, corners: list[int], inside: list[int]) -> Sheet:
        """The sheet with the vertices inside a 3-cycle removed."""
        faces = [self.face(t) for t in self.triangles if not t & set(inside)]
        points = {v: p for v, p in self.points.items() if v not in set(inside)}
        return Sheet(points, [*faces, tuple(corners)])

    def face(self, triangle: frozenset[int]) -> tuple[int, int, int]:
        """The triangle counter-clockwise from its smallest vertex."""
        a = min(triangle)
        b = next(v for v in triangle - {a} if self.next[a].get(v) in triangle)
        return a, b, self.next[a][b]


def inertia(matrix: list[list[Fraction]]) -> tuple[int, int, int]:
    """(positive, negative, zero) of a symmetric rational matrix, by completing squares."""
    work, live, counts = [list(row) for row in matrix], list(range(len(matrix))), [0, 0]
    while live:
        k = next((i for i in live if work[i][i]), None)
        if k is None:
            pair = next(((i, j) for i in live for j in live if work[i][j]), None)
            if pair is None:
                break
            k, j = pair
            for c in live:
                work[k][c] += work[j][c]
            for r in live:
                work[r][k] += work[r][j]
        counts[work[k][k] < 0] += 1
        live.remove(k)
        beside = [c for c in live if work[k][c]]
        for i in beside:
            factor = work[i][k] / work[k][k]
            for c in beside:
                work[i][c] -= factor * work[k][c]
    return counts[0], counts[1], len(matrix) - sum(counts)


def matrix_of(form: Form, labels: list[int]) -> list[list[Fraction]]:
    """The matrix of a form on the given variables, the others being 0."""
    return [[Fraction(form.get((i, j), 0)) for j in labels] for i in labels]


def check_lorentzian(sheet: Sheet, vertex: int) -> None:
    """The curvature form of a flat vertex of degree N has inertia (1, N - 3, 3)."""
    labels = [*sheet.star(vertex), vertex]  # in this order elimination fills in two columns only
    expected = (1, len(labels) - 4, 3)
    require(
        inertia(matrix_of(sheet.curvature(vertex), labels)) == expected,
        f"the curvature form of vertex {vertex} has not inertia {expected}",
    )


def check_definite(sheet: Sheet, inside: list[int], weights: list[Fraction]) -> None:
    """sum_v weight_v K_v is positive definite on heights that vanish outside `inside`.

    Then the K_v have no common complex zero w = a + i b but 0 there: K_v(a) = K_v(b) and
    B_v(a, b) = 0, and if b is not 0 some K_v(b) > 0, though K_v has one positive direction only.
    """
    total: Form = {}
    for v, weight in zip(inside, weights, strict=True):
        require(weight > 0, "a multiplier is not positive")
        check_lorentzian(sheet, v)
        for pair, w in sheet.curvature(v).items():
            total[pair] = total.get(pair, 0) + weight * w
    require(inertia(matrix_of(total, inside)) == (len(inside), 0, 0), "a stress is not definite")


def check_triangles(sheet: Sheet, evidence: Any) -> Sheet:
    """Remove the triangulated triangles, each by a definite stress; the emptied sheet."""
    emptied = sheet
    for entry in items(evidence, "triangles"):
        keys(entry, "corners inside multipliers", "triangle")
        corners, inside = items(entry["corners"], "corners", 3), items(entry["inside"], "inside")
        for v in corners + inside:
            require(type(v) is int and v in emptied.points, f"{v!a} is no vertex")
        a, b, c = (emptied.points[v] for v in corners)
        require(turn(a, b, c) > 0, f"the 3-cycle {corners} is not counter-clockwise")
        for i, j in ((0, 1), (0, 2), (1, 2)):
            edge = (min(corners[i], corners[j]), max(corners[i], corners[j]))
            require(edge in emptied.edges, f"{corners} is no 3-cycle of edges")
        within = [
            v
            for v in emptied.interior
            if all(turn(p, q, emptied.points[v]) > 0 for p, q in ((a, b), (b, c), (c, a)))
        ]
        require(within and sorted(inside) == within, f"not the vertices inside {corners}")
        weights = [
            parse_rational(m) for m in items(entry["multipliers"], "multipliers", len(inside))
        ]
        check_definite(emptied, inside, weights)
        emptied = emptied.emptied(corners, inside)
    return emptied


# --- the branch system ---------------------------------------------------------------------------


class BranchSystem:
    """K_v = 0 with three boundary vertices at height 0, in an affine chart.

    By default the fourth boundary vertex, `unit`, has height 1: it is the first, in cyclic order
    from the smallest index, at which the affine dependency of the four (the boundary saddle) does
    not vanish, so that the saddle is positive. Given a functional, `unit` is the reflex corner and
    its height is such that the functional is 1.
    """

    def __init__(self, sheet: Sheet, functional: dict[int, Fraction] | None) -> None:
        self.sheet, b = sheet, sheet.boundary
        corners = [sheet.points[v] for v in b]
        saddle = [turn(*(corners[:k] + corners[k + 1 :])) * (-1) ** k for k in range(4)]
        first = next(k for k in range(4) if saddle[k])
        self.saddle = {v: weight / saddle[first] for v, weight in zip(b, saddle, strict=True)}
        self.unit = b[first]
        if functional is not None:
            turns = [turn(corners[k - 1], corners[k], corners[(k + 1) % 4]) for k in range(4)]
            reflex = [v for v, t in zip(b, turns, strict=True) if t < 0]
            require(reflex, "a chart other than the saddle's needs a reflex corner")
            self.unit = reflex[0]  # the other three corners span a triangle
            require(set(functional) <= {self.unit, *sheet.interior}, "a bad chart functional")
        functional = functional or {self.unit: Fraction(1)}
        lead = functional.get(self.unit)
        require(lead, "the chart functional does not fix the height of its corner")
        self.size = len(sheet.interior)
        self.lifts: dict[int, dict[int, Fraction]] = {v: {} for v in b}  # heights over (x, 1)
        self.lifts |= {v: {k: Fraction(1)} for k, v in enumerate(sheet.interior)}
        weights = {k: -functional.get(v, Fraction(0)) for k, v in enumerate(sheet.interior)}
        weights[self.size] = Fraction(1)
        self.lifts[self.unit] = {k: w / Fraction(lead or 1) for k, w in weights.items() if w}
        self.quadrics = [self._quadric(sheet.curvature(v)) for v in sheet.interior]

    def _quadric(self, form: Form) -> dict[tuple[int, int], int]:
        """A form on (x, 1), with coprime integer coefficients."""
        rows: Form = {}
        for (i, j), w in form.items():
            for p, x in self.lifts[i].items():
                for q, y in self.lifts[j].items():
                    rows[p, q] = rows.get((p, q), Fraction(0)) + w * x * y
        scale = lcm(*(w.denominator for w in rows.values()))
        whole = {pq: int(w * scale) for pq, w in rows.items() if w}
        common = gcd(*whole.values())
        return {pq: w // common for pq, w in whole.items()}

    def row(self, functional: dict[int, Fraction]) -> list[int]:
        """A linear functional of the heights as integers (c_1, ..., c_n, c_0), signs kept."""
        row = [Fraction(0)] * (self.size + 1)
        for v, weight in functional.items():
            for place, x in self.lifts[v].items():
                row[place] += weight * x
        scale = lcm(*(w.denominator for w in row))
        return [int(w * scale) for w in row]


def read_chart(evidence: Any) -> dict[int, Fraction] | None:
    """The functional of the chart, if the evidence names one."""
    if evidence is None:
        return None
    if not isinstance(evidence, dict):
        raise CertificateError("the chart is neither null nor a functional")
    chart = {parse_integer(v): parse_rational(c) for v, c in evidence.items()}
    require(len(chart) == len(evidence), "a vertex appears twice in the chart")
    return chart


# --- isolated roots ------------------------------------------------------------------------------


class Krawczyk:
    """Krawczyk's test for the quadrics F_p(x) = (1/2) z^T S_p z, z = (x, 1), in integers."""

    def __init__(self, system: BranchSystem | FlatSheets) -> None:
        self.n = system.size
        self.quadrics = system.quadrics
        top = max(abs(w) for q in self.quadrics for w in q.values()).bit_length()
        self.quadrics = [
            {pq: w << top - max(map(abs, q.values())).bit_length() for pq, w in q.items()}
            for q in self.quadrics
        ]
        self.scale = top
        self.norms = [
            sum(abs(w) for (i, j), w in q.items() if self.n not in (i, j)) for q in self.quadrics
        ]

    def check(self, center: list[int], radius: int, bits: int) -> None:
        """Raise unless the box |x - center/2^bits| <= radius/2^bits holds exactly one zero.

        With eta = |Y F(m)|, k0 = |I - Y F'(m)|, M >= max_i sum_jk |sum_p Y_ip (H_p)_jk| it is
        enough that k0 + r M < 1 and eta + (k0 + r M) r < r.
        """
        n, z = self.n, [*center, 1 << bits]
        gradients, values = [], []
        for quadric in self.quadrics:
            row = [0] * (n + 1)
            for (i, j), w in quadric.items():
                row[i] += w * z[j]
            gradients.append(row)  # 2^bits times the gradient
            values.append(sum(a * b for a, b in zip(row, z, strict=True)))  # 2^(2 bits + 1) F
        for y, shift in self._preconditioners(gradients, bits):
            if shift + bits < 0:
                continue
            unit, k0, bound, eta = 1 << (shift + bits), 0, 0, 0
            for i, weights in enumerate(y):
                sums = [0] * n
                for w, row in zip(weights, gradients, strict=True):
                    for k in range(n) if w else ():
                        sums[k] += w * row[k]
                sums[i] -= unit
                k0 = max(k0, sum(map(abs, sums)))
                bound = max(
                    bound, sum(abs(w) * s for w, s in zip(weights, self.norms, strict=True))
                )
                eta = max(eta, abs(sum(w * v for w, v in zip(weights, values, strict=True))))
            contraction = k0 + radius * bound
            if contraction < unit and eta < 2 * radius * (unit - contraction):
                return
        raise CertificateError(f"Krawczyk's test fails for the box about {center[:2]}.../2^{bits}")

    def _preconditioners(
        self, gradients: list[list[int]], bits: int
    ) -> Iterator[tuple[list[list[int]], int]]:
        """Approximate inverses Y = y / 2^shift of F'(m): from doubles, then to many digits.

        If any Y passes the test, so does F'(m)^-1, for which eta, k0, M become at most
        eta / (1 - k0), 0, M / (1 - k0). The second Y is as good up to 2^-29 of these bounds: it is
        rounded to 2^-30 / sum |F'(m)|, and its digits allow for |Y| <= 2^(bits + scale), which
        r M < 1 implies if every quadric has a quadratic part; if not, it is found in rationals.
        """
        n, down = self.n, 1 << (self.scale + bits)
        jacobian = [row[:n] for row in gradients]
        with suppress(ArithmeticError, ValueError):
            yield self._rounded(inverse([[g / down for g in row] for row in jacobian]), 56)
        total = sum(abs(g) for row in jacobian for g in row).bit_length() - (self.scale + bits)
        if all(self.norms):
            room = 2 * (max(total, 0) + max(bits, 64) + self.scale + n)
            with localcontext(Context(room * 31 // 100 + 30, Emin=MIN_EMIN, Emax=MAX_EMAX)):
                many = [[Decimal(g) / down for g in row] for row in jacobian]
                found = _inverse_or_none(many)
        else:
            found = _inverse_or_none([[Fraction(g, down) for g in row] for row in jacobian])
        if found is not None:
            yield self._rounded(found, bits + 8, total + 30)

    def _rounded(
        self, matrix: list[list[Any]], digits: int, least: int | None = None
    ) -> tuple[list[list[int]], int]:
        largest = Fraction(max(abs(x) for row in matrix for x in row))
        size = largest.numerator.bit_length() - largest.denominator.bit_length()
        q = digits - size if least is None else max(digits - size, least)
        power = Fraction(2) ** q
        return [[round(Fraction(x) * power) for x in row] for row in matrix], q + self.scale


def inverse(matrix: list[list[Any]]) -> list[list[Any]]:
    """Gauss-Jordan inverse with partial pivoting, in the numbers of the matrix."""
    n = len(matrix)
    one = matrix[0][0] * 0 + 1
    work = [list(row) + [one * (i == j) for j in range(n)] for i, row in enumerate(matrix)]
    for k in range(n):
        pivot = max(range(k, n), key=lambda i: abs(work[i][k]))
        work[k], work[pivot] = work[pivot], work[k]
        lead = work[k][k]
        work[k] = [x / lead for x in work[k]]
        for i in range(n):
            factor = work[i][k]
            if i != k and factor:
                work[i] = [x - factor * y for x, y in zip(work[i], work[k], strict=True)]
    return [row[n:] for row in work]


def _inverse_or_none(matrix: list[list[Any]]) -> list[list[Any]] | None:
    try:
        return inverse(matrix)
    except ArithmeticError:  # singular
        return None


class Root:
    """A proved real zero; zeros of different kinds must be told apart by their signs."""

    kind: object = None

    def sign(self, row: list[int]) -> int | None:
        """Sign of the functional (c_1, ..., c_n, c_0); 0 if proved to vanish, None if open."""
        raise NotImplementedError


class Box(Root):
    """A box that holds one real zero; signs of functionals over the whole box."""

    def __init__(self, entry: Any, size: int) -> None:
        keys(entry, "bits radius center", "root")
        self.kind = "box"
        self.bits = natural(entry["bits"], "bits")
        require(self.bits <= MOST_BITS, "bits are out of range")
        self.radius = parse_integer(short(entry["radius"]))
        require(self.radius > 0, "the radius is not positive")
        self.center = [parse_integer(short(m)) for m in items(entry["center"], "center", size)]

    def sign(self, row: list[int]) -> int | None:
        """1 or -1 if the functional keeps that sign on the box, 0 if it is 0, else None."""
        value = (row[-1] << self.bits) + sum(
            c * m for c, m in zip(row[:-1], self.center, strict=True)
        )
        reach = self.radius * sum(map(abs, row[:-1]))
        if abs(value) > reach:
            return 1 if value > 0 else -1
        return 0 if value == reach == 0 else None


def short(value: Any) -> str:
    """`value` if it is a string of bounded length."""
    text = text_of(value)
    require(len(text) <= MOST_BITS, "a number of a box is out of range")
    return text


def text_of(value: Any) -> str:
    """`value` if it is a string."""
    if not isinstance(value, str):
        raise CertificateError(f"{value!a} is not a number in quotes")
    return value


def check_disjoint(boxes: list[Box]) -> None:
    """No two boxes meet. Sorted by a fixed functional; compared only where values overlap."""
    top = max((box.bits for box in boxes), default=0)
    keyed = []
    for index, box in enumerate(boxes):
        weights = [2 * k * k + 3 * k + 5 for k in range(len(box.center))]
        value = sum(w * m for w, m in zip(weights, box.center, strict=True)) << (top - box.bits)
        reach = box.radius * sum(weights) << (top - box.bits)
        keyed.append((value - reach, value + reach, index))
    active: list[tuple[int, int]] = []
    for low, high, index in sorted(keyed):
        active = [(end, other) for end, other in active if end >= low]
        for _, other in active:
            a, b = boxes[index], boxes[other]
            reach = (a.radius << (top - a.bits)) + (b.radius << (top - b.bits))
            require(
                any(
                    abs((x << (top - a.bits)) - (y << (top - b.bits))) > reach
                    for x, y in zip(a.center, b.center, strict=True)
                ),
                "two boxes meet",
            )
        active.append((high, index))


def check_isolated(system: BranchSystem, evidence: Any) -> list[tuple[Root, int]]:
    """All zeros by Krawczyk and refined Bezout: a list of (root, multiplicity)."""
    keys(evidence, "kind triangles chart roots", "evidence")
    boxes = [Box(entry, system.size) for entry in items(evidence["roots"], "roots")]
    if system.size:
        test = Krawczyk(system)
        for box in boxes:
            test.check(box.center, box.radius, box.bits)
        check_disjoint(boxes)
    require(len(boxes) == 1 << system.size, f"{len(boxes)} roots, not 2^{system.size}")
    return [(box, 1) for box in boxes]


# --- algebraic roots -----------------------------------------------------------------------------


def trim(p: Iterable[Any]) -> Poly:
    """A polynomial (constant term first) without leading zeros."""
    p = list(p)
    while p and not p[-1]:
        p.pop()
    return p


def times(p: Poly, q: Poly) -> Poly:
    """Product of two polynomials."""
    result = [Fraction(0)] * max(len(p) + len(q) - 1, 0)
    for i, a in enumerate(p):
        for j, b in enumerate(q) if a else ():
            result[i + j] += a * b
    return result


def plus(p: Poly, q: Poly) -> Poly:
    """Sum of two polynomials."""
    size = max(len(p), len(q))
    return [(p[k] if k < len(p) else 0) + (q[k] if k < len(q) else 0) for k in range(size)]


def scaled(p: Poly, c: Any) -> Poly:
    """c times a polynomial."""
    return [c * a for a in p]


def remainder(p: Poly, modulus: Poly) -> Poly:
    """p modulo a polynomial with non-zero leading coefficient."""
    p = trim(p)
    while len(p) >= len(modulus):
        factor = Fraction(p[-1]) / modulus[-1]
        start = len(p) - len(modulus)
        for k, b in enumerate(modulus):
            p[start + k] -= factor * b
        p = trim(p[:-1])
    return p


def are_coprime(p: Poly, q: Poly) -> bool:
    """Whether two polynomials have no common root."""
    p, q = trim(p), trim(q)
    while q:
        p, q = q, remainder(p, q)
        q = scaled(q, 1 / q[-1]) if q else q
    return len(p) == 1


def derivative(p: Poly) -> Poly:
    """The derivative of a polynomial."""
    return [k * a for k, a in enumerate(p)][1:]


def value(p: Poly, x: Fraction) -> Fraction:
    """p(x)."""
    result = Fraction(0)
    for a in reversed(p):
        result = result * x + a
    return result


def bounds(p: Poly, low: Fraction, high: Fraction) -> tuple[Fraction, Fraction]:
    """Bounds of p on [low, high] by interval Horner."""
    a = b = Fraction(0)
    for c in reversed(p):
        ends = (a * low, a * high, b * low, b * high)
        a, b = min(ends) + c, max(ends) + c
    return a, b


def count_real_roots(p: Poly) -> int:
    """Number of distinct real roots of a squarefree polynomial (Sturm)."""
    chain = [trim(p), trim(derivative(p))]
    while len(chain[-1]) > 1:
        last = remainder(chain[-2], chain[-1])
        chain.append(scaled(last, -1 / abs(last[-1])))
    changes = []
    for side in (-1, 1):
        signs = [(q[-1] > 0) == (side > 0 or len(q) % 2 == 1) for q in chain]
        changes.append(sum(a != b for a, b in itertools.pairwise(signs)))
    before, after = changes
    return int(before - after)


class FlatSheets:
    """The sheets that are flat at given vertices, x = A (y, 1), and the quadrics on them.

    The y are the unknowns x that are not pivots of "fold flat". Of the quadrics a basis of their
    span is kept, which must have as many elements as there are unknowns y.
    """

    def __init__(self, system: BranchSystem, flat: list[Any]) -> None:
        sheet, n = system.sheet, system.size
        require(flat and all(type(v) is int for v in flat), "flat vertices are no vertices")
        require(
            flat == sorted(set(flat)) and set(flat) <= set(sheet.interior),
            "the flat vertices are not sorted inner vertices",
        )
        folds = [fold for fold in sheet.folds if set(fold) & set(flat)]
        lines = echelon([[Fraction(c) for c in system.row(sheet.bend(f))] for f in folds])
        require(n not in lines, "no sheet is flat at the flat vertices")
        free = [k for k in range(n) if k not in lines]
        self.system, self.size, self.multiplicity = system, len(free), 1 << len(flat)
        self.lifts = [
            [-lines[i][k] for k in (*free, n)]
            if i in lines
            else [Fraction(int(k == i)) for k in (*free, n)]
            for i in range(n)
        ]
        self.lifts.append([Fraction(int(k == n)) for k in (*free, n)])
        places = [(i, j) for i in range(self.size + 1) for j in range(i + 1)]
        span = echelon([self._restricted(quadric, places) for quadric in system.quadrics])
        require(len(span) == self.size > 0, "quadrics and unknowns on flat sheets differ in number")
        self.quadrics: list[dict[tuple[int, int], int]] = []
        for line in span.values():
            scale = lcm(*(c.denominator for c in line))
            quadric = {ij: int(c * scale) for ij, c in zip(places, line, strict=True) if c}
            # c x_i x_j as c/2 each of (i, j) and (j, i), over integers
            both = {(i, j): c * (1 + (i == j)) for (i, j), c in quadric.items()}
            self.quadrics.append(both | {(j, i): c for (i, j), c in both.items()})

    def _restricted(
        self, quadric: dict[tuple[int, int], int], places: list[tuple[int, int]]
    ) -> list[Fraction]:
        """Coefficients of y_i y_j, i >= j."""
        total = dict.fromkeys(places, Fraction(0))
        for (p, q), c in quadric.items():
            for i, x in enumerate(self.lifts[p]):
                for j, y in enumerate(self.lifts[q]) if x else ():
                    if y:
                        total[max(i, j), min(i, j)] += c * x * y
        return list(total.values())

    def row(self, row: list[int]) -> list[int]:
        """A functional on these sheets, signs kept."""
        total = [Fraction(0)] * (self.size + 1)
        for c, line in zip(row, self.lifts, strict=True):
            if c:
                total = [a + c * b for a, b in zip(total, line, strict=True)]
        scale = lcm(*(c.denominator for c in total))
        return [int(c * scale) for c in total]


class FlatBox(Root):
    """A box that holds one real zero of the quadrics on flat sheets."""

    def __init__(self, entry: Any, sheets: FlatSheets) -> None:
        self.sheets = sheets
        self.kind = tuple(entry["flat"])
        self.box = Box({k: v for k, v in entry.items() if k != "flat"}, sheets.size)

    def sign(self, row: list[int]) -> int | None:
        """1 or -1 if the functional keeps that sign on the box, 0 if it is 0 there, else None."""
        return self.box.sign(self.sheets.row(row))


def echelon(rows: list[list[Fraction]]) -> dict[int, list[Fraction]]:
    """Reduced echelon form: nonzero rows by pivot column."""
    lines: dict[int, list[Fraction]] = {}
    for row in rows:
        for k, line in lines.items():
            if row[k]:
                row = [a - row[k] * b for a, b in zip(row, line, strict=True)]
        pivot = next((k for k, c in enumerate(row) if c), None)
        if pivot is None:
            continue
        row = [c / row[pivot] for c in row]
        for k, line in lines.items():
            if line[pivot]:
                lines[k] = [a - line[pivot] * b for a, b in zip(line, row, strict=True)]
        lines[pivot] = row
    return lines


class RootClass:
    """Zeros x_i = w_i(t) / p'(t) of the branch system, one for each root t of p."""

    def __init__(self, system: BranchSystem, separating: list[int], entry: Any) -> None:
        keys(entry, "polynomial numerators flat", "class")
        n = system.size
        self.p = [parse_integer(text_of(c)) for c in items(entry["polynomial"], "polynomial")]
        require(len(self.p) > 1 and self.p[-1], "a class polynomial is constant")
        self.slope = derivative(self.p)
        require(are_coprime(self.p, self.slope), "a class polynomial has a double root")
        self.w = [
            [parse_rational(c) for c in items(w, "numerator")]
            for w in items(entry["numerators"], "numerators", n)
        ]
        require(all(len(w) < len(self.p) for w in self.w), "a numerator has too high a degree")
        flat = set(items(entry["flat"], "flat vertices"))
        require(
            len(flat) == len(entry["flat"]) and flat <= set(system.sheet.interior),
            "the flat vertices are no inner vertices, or appear twice",
        )
        z = [*self.w, self.slope]
        for v, quadric in zip(system.sheet.interior, system.quadrics, strict=True):
            gradient: list[Poly] = [[] for _ in z]
            for (i, j), c in quadric.items():
                gradient[i] = plus(gradient[i], scaled(z[j], c))
            total: Poly = []
            for a, b in zip(gradient, z, strict=True):
                total = plus(total, times(a, b))
            require(not remainder(total, self.p), "the parametrisation misses a quadric")
            require(
                v not in flat or not any(remainder(g, self.p) for g in gradient[:n]),
                f"the quadric of vertex {v} has order 1",
            )
        self.multiplicity = 1 << len(flat)  # at least: the product of the orders of the quadrics
        form: Poly = []
        for s, w in zip(separating, self.w, strict=True):
            form = plus(form, scaled(w, s))
        require(
            not remainder(plus(form, scaled([0, *self.slope], -1)), self.p),
            "the separating form is not the root of its polynomial",
        )


class AlgebraicRoot(Root):
    """One real root of a class, in an interval on whose ends its polynomial changes sign."""

    kind = "class"

    def __init__(self, root_class: RootClass, low: Fraction, high: Fraction) -> None:
        self.root_class, self.low, self.high = root_class, low, high
        left, right = value(root_class.p, low), value(root_class.p, high)
        require(
            (low < high and left * right < 0) or (low == high and right == 0),
            "an interval shows no root",
        )
        self.rising = value(root_class.slope, low) > 0 if low == high else right > 0

    def sign(self, row: list[int]) -> int | None:
        """Sign of a functional at the root; 0 if it vanishes identically on the class."""
        p = self.root_class.p
        f: Poly = []
        for c, w in zip(row, [*self.root_class.w, self.root_class.slope], strict=True):
            f = plus(f, scaled(w, c))
        f = remainder(f, p)
        if not f:
            return 0
        for _ in range(4000):
            low, high = bounds(f, self.low, self.high)
            if low > 0 or high < 0:
                return 1 if (low > 0) == self.rising else -1
            if self.low == self.high:
                return 0
            middle = (self.low + self.high) / 2
            at = value(p, middle)
            if at == 0:
                self.low = self.high = middle
            elif (at > 0) == self.rising:
                self.high = middle
            else:
                self.low = middle
        return None


def check_finite(sheet: Sheet, multipliers: Any) -> None:
    """The branch system has finitely many zeros, so that multiplicities add up to 2^n exactly.

    A definite stress of the sheet (its notch closed by a triangle if the boundary is not convex)
    leaves no common zero of the curvature forms on heights that vanish on the outer boundary:
    these fill a hyperplane (a quadric cone's section) that every curve of zeros would meet.
    """
    corners = sheet.boundary
    for k, v in enumerate(corners):
        before, after = corners[k - 1], corners[(k + 1) % len(corners)]
        if turn(*(sheet.points[u] for u in (before, v, after))) < 0:
            faces = [sheet.face(t) for t in sheet.triangles]
            sheet = Sheet(sheet.points, [*faces, (before, after, v)])
            break
    weights = [parse_rational(m) for m in items(multipliers, "multipliers", len(sheet.interior))]
    check_definite(sheet, sheet.interior, weights)


def check_algebraic(system: BranchSystem, evidence: Any) -> tuple[list[tuple[Root, int]], int]:
    """All zeros, in classes or boxes: (real roots with multiplicities, number of the others).

    That no zero is listed in two ways is left to `check_branches`.
    """
    keys(evidence, "kind triangles chart multipliers separating classes roots", "evidence")
    check_finite(system.sheet, evidence["multipliers"])
    separating = [natural_or_negative(s) for s in items(evidence["separating"], "separating")]
    entries = items(evidence["classes"], "classes")
    listed = items(evidence["roots"], "roots")
    require(all(isinstance(entry, dict) for entry in listed), "a root is not an object")
    flat_sets = [
        tuple(items(entry["flat"], "flat vertices")) for entry in listed if "flat" in entry
    ]
    in_boxes = sum("flat" not in entry and "class" not in entry for entry in listed)
    total = in_boxes + sum(1 << min(len(flat), system.size) for flat in flat_sets)
    for entry in entries:  # before any arithmetic, so that a small file cannot ask for much
        keys(entry, "polynomial numerators flat", "class")
        degree = len(items(entry["polynomial"], "polynomial")) - 1
        total += degree << min(len(items(entry["flat"], "flat vertices")), system.size)
    require(total == 1 << system.size, f"multiplicities add up to {total}, not 2^{system.size}")
    require(not entries or len(separating) == system.size, "the separating form has a wrong length")
    classes = [RootClass(system, separating, entry) for entry in entries]
    for k, a in enumerate(classes):
        for b in classes[:k]:
            require(are_coprime(a.p, b.p), "two classes share a root")
    sheets = {flat: FlatSheets(system, list(flat)) for flat in dict.fromkeys(flat_sets)}
    roots: list[tuple[Root, int]] = []
    boxes: dict[object, list[Box]] = {}
    intervals: list[list[tuple[Fraction, Fraction]]] = [[] for _ in classes]
    for entry in listed:
        if "flat" in entry:
            flat_box = FlatBox(entry, sheets[tuple(entry["flat"])])
            boxes.setdefault(flat_box.kind, []).append(flat_box.box)
            roots.append((flat_box, flat_box.sheets.multiplicity))
        elif "class" in entry:
            keys(entry, "class interval", "root")
            index = natural(entry["class"], "class")
            require(index < len(classes), "no such class")
            low, high = (parse_rational(x) for x in items(entry["interval"], "interval", 2))
            intervals[index].append((low, high))
            roots.append((AlgebraicRoot(classes[index], low, high), classes[index].multiplicity))
        else:
            box = Box(entry, system.size)
            boxes.setdefault(box.kind, []).append(box)
            roots.append((box, 1))
    for kind, group in boxes.items():
        test = Krawczyk(
            system if kind == "box" else next(s for f, s in sheets.items() if f == kind)
        )
        for box in group:
            test.check(box.center, box.radius, box.bits)
        check_disjoint(group)
    nonreal = 0
    for root_class, ends in zip(classes, intervals, strict=True):
        ends.sort()
        require(
            all(a[1] <= b[0] and a != b for a, b in itertools.pairwise(ends)),
            "two intervals overlap",
        )
        degree = len(root_class.p) - 1
        if len(ends) < degree:
            require(len(ends) == count_real_roots(root_class.p), "a real root is missing")
        nonreal += degree - len(ends)
    return roots, nonreal


def natural_or_negative(value: Any) -> int:
    """`value` if it is an integer."""
    if type(value) is not int:
        raise CertificateError(f"{value!a} is not an integer")
    return value


# --- folds that are exactly flat -----------------------------------------------------------------


def rational_sqrt(x: Fraction) -> Fraction | None:
    """The square root of a rational >= 0, or None if it is irrational."""
    p, q = isqrt(x.numerator), isqrt(x.denominator)
    return Fraction(p, q) if p * p == x.numerator and q * q == x.denominator else None


def kernel(rows: list[list[Fraction]], size: int) -> list[list[Fraction]]:
    """A basis of the vectors of length `size` that all rows annihilate."""
    work, pivots = [list(map(Fraction, row)) for row in rows], list[int]()
    for column in range(size):
        lead = next((r for r in range(len(pivots), len(work)) if work[r][column]), None)
        if lead is None:
            continue
        k = len(pivots)
        work[k], work[lead] = work[lead], work[k]
        work[k] = [x / work[k][column] for x in work[k]]
        for r, row in enumerate(work):
            if r != k and row[column]:
                work[r] = [x - row[column] * y for x, y in zip(row, work[k], strict=True)]
        pivots.append(column)
    basis = []
    for free in (c for c in range(size) if c not in pivots):
        vector = [Fraction(int(c == free)) for c in range(size)]
        for k, column in enumerate(pivots):
            vector[column] = -work[k][free]
        basis.append(vector)
    return basis


@functools.lru_cache(maxsize=4096)  # many branches ask with the same signs
def flat_at(
    sheet: Sheet, vertex: int, folds: tuple[Edge, ...], signs: tuple[int | None, ...]
) -> list[Edge]:
    """Those of the folds around a vertex that must be flat, given right signs (None where open).

    The bends at the vertex that agree with the flat folds span a space on which the curvature form
    vanishes at the branch. In dimension 1 a non-zero form leaves only 0; in dimension 2 a form that
    splits into rational lines leaves the lines that agree with the known signs.
    """
    ring = sheet.star(vertex)
    free = ring[2:]  # hub and two neighbouring rim vertices at 0: heights modulo planes
    if len(free) - signs.count(0) > 2:
        return []
    rows = [[Fraction(sheet.bend(f).get(j, 0)) for j in free] for f in folds]
    basis = kernel([r for r, sign in zip(rows, signs, strict=True) if sign == 0], len(free))
    form = matrix_of(sheet.curvature(vertex), free)

    def polar(a: list[Fraction], b: list[Fraction]) -> Fraction:
        terms = (
            x * w * y
            for x, line in zip(a, form, strict=True)
            for w, y in zip(line, b, strict=False)
        )
        return sum(terms, Fraction(0))

    lines: list[list[Fraction]] = []  # where the form vanishes
    if (len(basis) == 1 and polar(basis[0], basis[0]) == 0) or len(basis) > 2:
        return []
    if len(basis) == 2:
        u, v = basis
        a, b, c = polar(u, u), polar(u, v), polar(v, v)
        square = b * b - a * c
        root = rational_sqrt(square) if square >= 0 else None
        if (square >= 0 and root is None) or not (a or b or c):
            return []
        if root is not None:
            pairs = [(-b + root, a), (-b - root, a)] if a else [(Fraction(1), 0 * b), (-c, 2 * b)]
            lines = [[s * x + t * y for x, y in zip(u, v, strict=True)] for s, t in pairs]
    vectors = [
        [sum((r * h for r, h in zip(row, line, strict=True)), Fraction(0)) for row in rows]
        for line in lines
    ]
    known = [(k, sign) for k, sign in enumerate(signs) if sign is not None]

    def agrees(vector: list[Fraction]) -> bool:
        one = [(vector[k] > 0) - (vector[k] < 0) for k, _ in known]
        return not any(s for _, s in known) or any(
            all(x * side == s for x, (_, s) in zip(one, known, strict=True)) for side in (1, -1)
        )

    left = [vector for vector in vectors if agrees(vector)]
    return [
        f
        for k, f in enumerate(folds)
        if signs[k] is None and all(vector[k] == 0 for vector in left)
    ]


def close_flat(sheet: Sheet, signs: dict[Edge, int | None], corner: int | None = None) -> None:
    """Settle open folds by `flat_at` until nothing changes.

    `corner`: an interior vertex at which the curvature form does not vanish.
    """
    inner = set(sheet.interior) - {corner}
    pending = {v for fold, sign in signs.items() if sign is None for v in fold} & inner
    while pending:
        vertex = pending.pop()
        folds = tuple((min(vertex, j), max(vertex, j)) for j in sheet.star(vertex))
        for fold in flat_at(sheet, vertex, folds, tuple(signs[f] for f in folds)):
            signs[fold] = 0
            pending |= set(fold) & inner


# --- claims --------------------------------------------------------------------------------------


def read_sheet(data: Any) -> tuple[Sheet, str]:
    """The verified sheet and its SHA-256."""
    keys(data, "vertices triangles", "pattern")
    points: dict[int, Point] = {}
    for k, pair in enumerate(items(data["vertices"], "vertices")):
        x, y = items(pair, f"vertex {k}", 2)
        points[k] = (parse_rational(x), parse_rational(y))
    triangles = []
    for face in items(data["triangles"], "triangles"):
        triangles.append(tuple(natural(v, "vertex") for v in items(face, "face", 3)))
    require(len(set(map(frozenset, triangles))) == len(triangles), "a face appears twice")
    sheet = Sheet(points, triangles)

    def text(x: Fraction) -> str:
        whole = digits(x.numerator)
        return whole if x.denominator == 1 else f"{whole}/{digits(x.denominator)}"

    rotated = sorted(min((t[k:] + t[:k]) for k in range(3)) for t in triangles)
    lines = ["exactfold pattern 1"]
    lines += [f"v {text(x)} {text(y)}" for x, y in points.values()]
    lines += [f"t {a} {b} {c}" for a, b, c in rotated]
    digest = hashlib.sha256("".join(line + "\n" for line in lines).encode()).hexdigest()
    return sheet, digest


def digits(n: int) -> str:
    """Decimal text of an integer of any length."""
    if n < 0:
        return "-" + digits(-n)
    if n.bit_length() < 13000:  # fewer than 4000 digits, which Python prints
        return str(n)
    half = n.bit_length() * 3 // 20
    high, low = divmod(n, 10**half)
    return digits(high) + digits(low).rjust(half, "0")


UPSIDE_DOWN = str.maketrans("+-MV", "-+VM")
COUNTS = "distinct with_multiplicity real nonreal true_branches"


def check(data: dict[str, Any]) -> dict[str, Any]:
    """Verify every claim of a loaded certificate; raises `CertificateError` at the first failure.

    Returns the verified claims. Passing means that the claims hold for the pattern in the file.
    """
    try:
        return _check(data)
    except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError) as error:
        raise CertificateError(f"malformed: {type(error).__name__} while checking") from error


def _check(data: dict[str, Any]) -> dict[str, Any]:
    claims, evidence = data["claims"], data["evidence"]
    keys(claims, f"interior boundary folds degrees_of_freedom sha256 {COUNTS} branches", "claims")
    require(isinstance(evidence, dict), "the evidence is not an object")
    sheet, digest = read_sheet(data["pattern"])
    facts = {
        "interior": len(sheet.interior),
        "boundary": len(sheet.boundary),
        "folds": len(sheet.folds),
        "degrees_of_freedom": len(sheet.boundary) - 3,
        "sha256": digest,
    }
    emptied = check_triangles(sheet, evidence.get("triangles"))
    removed = len(sheet.interior) - len(emptied.interior)
    kind = evidence.get("kind")
    branches = items(claims["branches"], "branches")
    if kind == "rigid":
        keys(evidence, "kind triangles", "evidence")
        require(
            len(sheet.boundary) == 3 and not emptied.interior and sheet.interior,
            "the sheet is no triangulated triangle",
        )
        facts |= dict(zip(COUNTS.split(), (0, 0, 0, 0, "proved"), strict=True))
        require(not branches, "a rigid sheet has no branches")
    elif kind == "single vertex":
        keys(evidence, "kind triangles", "evidence")
        require(
            len(emptied.interior) == 1
            and len(emptied.star(emptied.interior[0])) == len(emptied.boundary) >= 5,
            "the emptied sheet is no single vertex of degree 5 or more",
        )
        check_lorentzian(emptied, emptied.interior[0])
        facts |= dict(zip(COUNTS.split(), (1, 1 << removed, 1, 0, "proved"), strict=True))
        require(not branches, "a branch of dimension two or more is not listed")
    elif kind in ("isolated", "algebraic"):
        require(len(sheet.boundary) == 4 and sheet.interior, "the sheet has not D = 1")
        system, nonreal = BranchSystem(emptied, read_chart(evidence.get("chart"))), 0
        if kind == "isolated":
            roots = check_isolated(system, evidence)
        else:
            roots, nonreal = check_algebraic(system, evidence)
        simple = all(m == 1 for _, m in roots)
        facts |= dict(
            zip(
                COUNTS.split(),
                (
                    len(roots) + nonreal,
                    1 << len(sheet.interior),
                    len(roots),
                    nonreal,
                    "proved" if simple and not nonreal else "undecided",
                ),
                strict=True,
            )
        )
        require(len(branches) == len(roots), f"{len(branches)} branches for {len(roots)} roots")
        check_branches(sheet, system, roots, branches, removed)
    else:
        raise CertificateError(f"unknown kind of evidence {kind!a}")
    for key, fact in facts.items():
        require(
            type(claims[key]) is type(fact) and claims[key] == fact,
            f"claim {key} = {claims[key]!a}, but it is {fact!a}",
        )
    return dict(claims)


def check_branches(
    sheet: Sheet,
    system: BranchSystem,
    roots: list[tuple[Root, int]],
    branches: list[Any],
    removed: int,
) -> None:
    """Vertex signs, mountain-valley assignment and multiplicity of every branch.

    The letter U claims nothing. The signs that are known on all branches must tell zeros listed in
    different ways apart.
    """
    texts: list[tuple[str, str]] = []
    emptied = system.sheet
    vertex_rows = {v: system.row(emptied.sign_of_vertex(v)) for v in emptied.interior}
    fold_rows = {f: system.row(emptied.bend(f)) for f in emptied.folds}
    saddle = system.row(system.saddle)
    for number, ((root, multiplicity), branch) in enumerate(zip(roots, branches, strict=True)):
        keys(branch, "vertex_signs assignment multiplicity representative", f"branch {number}")
        signs = {f: root.sign(row) for f, row in fold_rows.items()}
        close_flat(emptied, signs)
        at = {v: root.sign(row) for v, row in vertex_rows.items()}
        up_down = "".join("-0+?"[1 + digit(at.get(v, 0))] for v in sheet.interior)
        letters = "".join("MFVU"[1 + digit(signs.get(f, 0))] for f in sheet.folds)
        require("?" not in up_down, f"branch {number}: signs are open")
        seen = (up_down, letters)
        texts.append(seen)
        mirror = (up_down.translate(UPSIDE_DOWN), letters.translate(UPSIDE_DOWN))
        side = root.sign(saddle)
        allowed = {1: (seen,), -1: (mirror,)}.get(side or 0, (seen, mirror))
        require(
            any(
                branch["vertex_signs"] == up_down and agrees(text_of(branch["assignment"]), letters)
                for up_down, letters in allowed
            )
            and branch["representative"] == ("saddle" if side else "either"),
            f"branch {number}: not {' or '.join(map(' '.join, allowed))} as shown by "
            f"{'its positive saddle' if side else 'either side'}",
        )
        require(
            type(branch["multiplicity"]) is int
            and branch["multiplicity"] == multiplicity << removed,
            f"branch {number}: multiplicity is {multiplicity << removed}",
        )
    known = [k for k in range(len(sheet.folds)) if all(text[1][k] != "U" for text in texts)]
    kinds: dict[tuple[str, str], object] = {}
    for (up_down, letters), (root, _) in zip(texts, roots, strict=True):
        key = (up_down, "".join(letters[k] for k in known))
        require(kinds.setdefault(key, root.kind) == root.kind, "a root may be counted twice")


def agrees(claimed: str, letters: str) -> bool:
    """Whether every letter claimed is right; U claims nothing."""
    return len(claimed) == len(letters) and all(
        a in (b, "U") for a, b in zip(claimed, letters, strict=True)
    )


def digit(sign: int | None) -> int:
    """-1, 0 or 1 for a sign, 2 for an open one."""
    return 2 if sign is None else sign


def main(arguments: list[str]) -> int:
    """Check one file and print the verdict; the exit code."""
    if len(arguments) != 1:
        print("usage: python checker.py CERTIFICATE.json", file=sys.stderr)
        return 2
    try:
        with open(arguments[0], encoding="utf-8") as stream:
            data = load(stream.read())
        claims = check(data)
    except CertificateError as error:
        print(f"INVALID: {plain(error)}")
        return 1
    except (FormatError, OSError, UnicodeDecodeError) as error:
        print(f"not a certificate: {plain(error)}", file=sys.stderr)
        return 3
    print(summary(claims))
    return 0


def summary(claims: dict[str, Any]) -> str:
    """One line for verified claims."""
    return (
        f"VALID: {claims['distinct']} branches ({claims['with_multiplicity']} with "
        f"multiplicity, {claims['real']} real) of the sheet with {claims['interior']} interior "
        f"and {claims['boundary']} boundary vertices, sha256 {claims['sha256']}"
    )


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
