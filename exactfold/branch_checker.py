"""Checker of the proof that one branch has given vertex signs, standard library only.

    python branch_checker.py CERTIFICATE.json

needs `checker.py` beside it and nothing else. Exit codes as there: 0 every claim holds, 1 some
claim is not supported, 3 not a certificate of one branch. The sheet, its curvature forms and its
sign functionals are rebuilt from the file, by other formulas than those of the program that wrote
it; divisions of integers are rounded in the safe direction.

Why it is a proof: heights with K_v > 0 at every interior vertex bound the distance to the only
solution with the same signs (Theorem 5 of docs/branch.md, which also describes the file); heights
that solve the equations exactly are that solution. The boundary must be convex, or that of a
quadrilateral whose notch is closed here. Vertices inside a 3-cycle of edges stay flat (Theorem 2
(a), applied to the triangle) and are removed. Other folds are flat if the heights are exact and
flat there, or if K_v = 0 at a vertex leaves them no other choice (`close_flat`).
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from fractions import Fraction
from math import isqrt, lcm
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING or __package__:
    from exactfold import checker
else:
    import checker

FORMAT, VERSION = "exactfold branch", 1
MALFORMED = (ArithmeticError, AttributeError, LookupError, TypeError, ValueError)
SPARE = 400  # binary places of a curvature below (height / size)^2
Heights = Mapping[int, int]


def load(text: str) -> dict[str, Any]:
    """The JSON object of a certificate of one branch; raises `FormatError`."""
    names = "format version pattern claims evidence"
    return checker.read_document(text, FORMAT, VERSION, names)


def check(data: dict[str, Any]) -> dict[str, Any]:
    """Verify every claim of a loaded certificate; raises `CertificateError` at the first failure.

    Returns the claims and the SHA-256 of the pattern. The claims are: of all branches, or of all
    solutions with the rim of the heights if `gauge` is "rim", exactly one has these vertex signs,
    all of them exact, 0 where the star is flat; its folds have these letters, "U" making no claim;
    and for its heights h the integral of |grad(h - heights)|^2 is at most `squared_distance`.
    """
    try:
        return _check(data)
    except MALFORMED as error:
        raise checker.CertificateError(
            f"malformed: {type(error).__name__} while checking"
        ) from error


def _check(data: dict[str, Any]) -> dict[str, Any]:
    given, digest = checker.read_sheet(data["pattern"])
    claims, evidence = data["claims"], data["evidence"]
    checker.keys(claims, "gauge vertex_signs assignment squared_distance", "claims")
    checker.keys(evidence, "emptied heights denominator", "evidence")
    unit = lcm(*(x.denominator for point in given.points.values() for x in point))
    points: dict[int, Any] = {
        v: (int(x * unit), int(y * unit)) for v, (x, y) in given.points.items()
    }
    sheet, removed = _emptied(given, points, evidence["emptied"])
    corner = None
    if claims["gauge"] != "rim":
        checker.require(claims["gauge"] == "saddle", "the gauge is neither saddle nor rim")
        checker.require(len(sheet.boundary) == 4, "there are not four boundary vertices")
        sheet, corner = _closed(sheet)
    _check_convex(sheet)
    texts = checker.items(evidence["heights"], "heights", len(points))
    checker.require(all((texts[v] is None) == (v in removed) for v in points), "heights do not fit")
    heights = {v: checker.parse_integer(texts[v]) for v in points if v not in removed}
    q = checker.parse_integer(evidence["denominator"])
    checker.require(q > 0, "the denominator is not positive")
    if claims["gauge"] == "saddle":
        _check_gauge(sheet, heights, corner)
    proof = _Proof(sheet, heights, q, corner)
    checker.require(
        proof.squared_distance <= checker.parse_rational(claims["squared_distance"]),
        "the distance is larger than claimed",
    )
    _check_signs(given, claims["vertex_signs"], proof, removed)
    _check_letters(given, claims["assignment"], proof, removed)
    return {"sha256": digest, "interior": len(given.interior), **claims}


# --- the sheet -----------------------------------------------------------------------------------


def _emptied(
    given: checker.Sheet, points: dict[int, Any], evidence: Any
) -> tuple[checker.Sheet, set[int]]:
    """The sheet in integer coordinates without the vertices inside the 3-cycles of the list."""
    removed: set[int] = set()
    added: list[tuple[int, ...]] = []
    edges = set(given.edges)
    for entry in checker.items(evidence, "emptied"):
        checker.keys(entry, "corners inside", "3-cycle")
        a, b, c = (
            checker.natural(v, "corner") for v in checker.items(entry["corners"], "corners", 3)
        )
        for i, j in ((a, b), (b, c), (a, c)):
            checker.require((min(i, j), max(i, j)) in edges, f"{i}-{j} is no edge")
        for v in (
            checker.natural(v, "vertex inside") for v in checker.items(entry["inside"], "inside")
        ):
            sides = [
                checker.turn(points[i], points[j], points[v]) for i, j in ((a, b), (b, c), (c, a))
            ]
            checker.require(min(sides) > 0, f"vertex {v} is not inside {(a, b, c)}")
            removed.add(v)
        added.append((a, b, c))
    kept = [given.face(t) for t in given.triangles if removed.isdisjoint(t)]
    # What is left is verified again: a disk of positive faces with a simple boundary.
    rest = {v: p for v, p in points.items() if v not in removed}
    return checker.Sheet(rest, [*kept, *added]), removed


def _closed(sheet: checker.Sheet) -> tuple[checker.Sheet, int | None]:
    """The sheet with the notch at its reflex corner closed, and that corner."""
    cycle = sheet.boundary
    for k, v in enumerate(cycle):
        before, after = cycle[k - 1], cycle[(k + 1) % len(cycle)]
        if checker.turn(*(sheet.points[u] for u in (before, v, after))) < 0:
            faces = [sheet.face(t) for t in sheet.triangles]
            return checker.Sheet(sheet.points, [*faces, (before, after, v)]), v
    return sheet, None


def _check_convex(sheet: checker.Sheet) -> None:
    cycle = sheet.boundary
    for k, v in enumerate(cycle):
        corner = (cycle[k - 1], v, cycle[(k + 1) % len(cycle)])
        checker.require(
            checker.turn(*(sheet.points[u] for u in corner)) >= 0, "the boundary is not convex"
        )


def _check_gauge(sheet: checker.Sheet, heights: Heights, corner: int | None) -> None:
    if corner is not None:
        checker.require(all(heights[v] == 0 for v in sheet.boundary), "the rim is not flat")
        return
    a, b, c, d = sheet.boundary
    p, q, r, s = (sheet.points[v] for v in sheet.boundary)
    weights = (
        checker.turn(q, r, s),
        -checker.turn(p, r, s),
        checker.turn(p, q, s),
        -checker.turn(p, q, r),
    )
    saddle = sum(w * heights[v] for w, v in zip(weights, (a, b, c, d), strict=True))
    checker.require(saddle * next(w for w in weights if w) > 0, "the saddle is not positive")


# --- the proof -----------------------------------------------------------------------------------


class _Proof:
    """Signs, bends and the distance for heights over q; lengths are integers.

    `corner` has the target K = 1 / size^2, all other interior vertices 0.
    """

    def __init__(self, sheet: checker.Sheet, heights: Heights, q: int, corner: int | None) -> None:
        self.sheet, self.heights, self.q, self.corner = sheet, heights, q, corner
        xs, ys = zip(*sheet.points.values(), strict=True)
        self.size = int(max(max(xs) - min(xs), max(ys) - min(ys)))
        highest = max(map(abs, heights.values()))
        self.bits = max(0, SPARE + 2 * self.size.bit_length() - 2 * highest.bit_length())
        self.exact = all(self._on_target(v) for v in sheet.interior)
        self.signs = {v: self._sign(v) for v in sheet.interior}
        self.squared_distance = self._distance(int(min(xs) + max(xs)), int(min(ys) + max(ys)))
        self.letters = self._letters()

    def wedges(self, v: int, a: Heights, b: Heights) -> Iterator[tuple[int, int]]:
        """Numerators and denominators of the terms of K_v(a, b), wedge by wedge as defined.

        K_v(a, b) = sum_j [(x_j y_j+1 + y_j x_j+1) L^2 L'^2 - s (x_j y_j L'^2 + x_j+1 y_j+1 L^2)]
        / (2 c L^2 L'^2) with x = a_j - a_v, y = b_j - b_v, L = L_j and L' = L_j+1.
        """
        ring = self.sheet.star(v)
        points: Mapping[int, Any] = self.sheet.points
        for i, j in zip(ring, ring[1:] + ring[:1], strict=True):
            px, py = points[i][0] - points[v][0], points[i][1] - points[v][1]
            qx, qy = points[j][0] - points[v][0], points[j][1] - points[v][1]
            c, s, k, m = px * qy - py * qx, px * qx + py * qy, px * px + py * py, qx * qx + qy * qy
            xi, xj, yi, yj = a[i] - a[v], a[j] - a[v], b[i] - b[v], b[j] - b[v]
            top = (xi * yj + yi * xj) * k * m - s * (xi * yi * m + xj * yj * k)
            yield int(top), int(2 * c * k * m)

    def form(self, v: int, a: Heights, b: Heights) -> tuple[int, int]:
        """Integers that enclose 2^bits K_v(a, b)."""
        terms = [(top << self.bits) // bottom for top, bottom in self.wedges(v, a, b)]
        return sum(terms), sum(terms) + len(terms)

    def exact_form(self, v: int, a: Heights, b: Heights) -> Fraction:
        """K_v(a, b)."""
        return sum((Fraction(*term) for term in self.wedges(v, a, b)), Fraction(0))

    def _on_target(self, v: int) -> bool:
        """Whether K_v is exactly what it is on a solution."""
        low, high = self.form(v, self.heights, self.heights)
        target = Fraction(self.q**2, self.size**2) if v == self.corner else Fraction(0)
        near = low <= target * (1 << self.bits) <= high
        return near and self.exact_form(v, self.heights, self.heights) == target

    def _sign(self, v: int) -> int:
        """The nappe of K_v that holds the heights, by a timelike t that points up.

        t_j - t_v < 0 for all j, and K_v(t) > 0: up, as K_v(t, t') > 0 for the round cone t', which
        is a mountain on all spokes. On a solution, K_v(t, .) is 0 only where the star is flat.
        """
        positive = self.exact or self.form(v, self.heights, self.heights)[0] > 0
        checker.require(positive, f"K is not positive at vertex {v}")
        x, y = self.sheet.points[v]
        bits = 8
        while True:
            cone = {v: 0}
            for j in self.sheet.star(v):
                square = (self.sheet.points[j][0] - x) ** 2 + (self.sheet.points[j][1] - y) ** 2
                cone[j] = -isqrt(int(square) << 2 * bits)
            if self.form(v, cone, cone)[0] > 0:
                break
            bits *= 2
        low, high = self.form(v, cone, self.heights)
        if self.exact and low <= 0 <= high:
            side = self.exact_form(v, cone, self.heights)
            return (side > 0) - (side < 0)
        checker.require(low > 0 or high < 0, f"the side of vertex {v} is not certain")
        return 1 if low > 0 else -1

    def _distance(self, x: int, y: int) -> Fraction:
        """sum_v m_v (sqrt K_v - sqrt k_v)^2 from above, for a disk around (x/2, y/2)."""
        points, unit = self.sheet.points, self.q**2 << self.bits
        if self.exact:
            return Fraction(0)

        def squared(v: int) -> int:
            return int((2 * points[v][0] - x) ** 2 + (2 * points[v][1] - y) ** 2)

        radius = max(squared(v) for v in self.sheet.boundary)
        total = Fraction(0)
        plain = 0
        for v in self.sheet.interior:
            low, high = self.form(v, self.heights, self.heights)
            if v == self.corner:
                target = Fraction(1, self.size**2)
                off = max(abs(Fraction(bound, unit) - target) for bound in (low, high))
                total += Fraction(radius - squared(v), 4) * off**2 / target
            else:
                plain += (radius - squared(v)) * high
        return total + Fraction(plain, 4 * unit)

    def _side(self, fold: tuple[int, int]) -> int | None:
        """The sign of a bend if the distance cannot undo it, None if it can."""
        bend = sum(w * self.heights[v] for v, w in self.sheet.bend(fold).items())
        i, j = fold
        left, right = self.sheet.next[i][j], self.sheet.next[j][i]
        p, q, r, s = (self.sheet.points[v] for v in (i, j, left, right))
        c, d = checker.turn(p, q, r), checker.turn(q, p, s)
        length = (q[0] - p[0]) ** 2 + (q[1] - p[1]) ** 2
        # |omega| L > (squared_distance (2/c + 2/d))^(1/2) with omega = bend / (c d q)
        most = self.squared_distance * self.q**2 * 2 * (c + d) * c * d
        if bend**2 * length > most or self.exact:
            return (bend > 0) - (bend < 0)
        return None

    def _letters(self) -> dict[tuple[int, int], str]:
        """The letters of all folds of the sheet, those left open closed where K_v = 0 can."""
        sides = {fold: self._side(fold) for fold in self.sheet.folds}
        checker.close_flat(self.sheet, sides, self.corner)
        return {fold: "U" if s is None else "MFV"[s + 1] for fold, s in sides.items()}


def _check_signs(given: checker.Sheet, signs: Any, proof: _Proof, removed: set[int]) -> None:
    if proof.corner is not None:
        checker.require(proof.signs[proof.corner] == 1, "the reflex corner does not pop up")
    seen: dict[int, set[str]] = {v: set() for v in proof.sheet.points}
    for fold, letter in proof.letters.items():
        for v in fold:
            seen[v].add(letter)
    values = checker.items(signs, "vertex_signs", len(given.interior))
    for v, sign in zip(given.interior, values, strict=True):
        expected = 0
        if v not in removed and seen[v] != {"F"}:
            checker.require(seen[v] & {"M", "V"}, f"vertex {v} may be flat")
            expected = proof.signs[v]
        checker.require(type(sign) is int and sign == expected, f"vertex {v} has another sign")


def _check_letters(given: checker.Sheet, letters: Any, proof: _Proof, removed: set[int]) -> None:
    checker.require(
        isinstance(letters, str) and len(letters) == len(given.folds), "letters do not fit"
    )
    for fold, letter in zip(given.folds, letters, strict=True):
        rigid = not removed.isdisjoint(fold)
        expected = "F" if rigid else proof.letters[fold]
        checker.require(
            letter == expected or letter == "U", f"fold {fold} is not known to be {letter!a}"
        )


# --- the command ---------------------------------------------------------------------------------


def summary(claims: dict[str, Any]) -> str:
    """One line for verified claims."""
    signs = "".join("-0+"[s + 1] for s in claims["vertex_signs"])
    shown = signs if len(signs) <= 60 else signs[:60] + "..."
    decided = len(claims["assignment"]) - claims["assignment"].count("U")
    return (
        f"VALID: exactly one branch has the vertex signs {shown} ({len(signs)}); "
        f"{decided} of {len(claims['assignment'])} letters decided; sha256 {claims['sha256']}"
    )


def main(arguments: list[str]) -> int:
    """Check one file and print the verdict; the exit code."""
    if len(arguments) != 1:
        print("usage: python branch_checker.py CERTIFICATE.json", file=sys.stderr)
        return 2
    try:
        with open(arguments[0], encoding="utf-8") as stream:
            claims = check(load(stream.read()))
    except checker.CertificateError as error:
        print(f"INVALID: {checker.plain(error)}")
        return 1
    except (checker.FormatError, OSError, UnicodeDecodeError) as error:
        print(f"not a certificate: {checker.plain(error)}", file=sys.stderr)
        return 3
    print(summary(claims))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
