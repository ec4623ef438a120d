"""Writes certificates of branches as Coq files, in which Coq proves their claims."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import product
from math import isqrt
from typing import Any

from exactfold.errors import NotApplicableError
from exactfold.exact.numbers import parse_rational
from exactfold.interop.formal import listed, pinned_first, to_coq, wrapped
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.rigidity.curvature import curvature_form

Heights = Mapping[int, Fraction]
Pair = tuple[Fraction, Fraction]

_RECORD = """\
Definition {name} : certificate := {{|
{near};
{ups};
{cones};
  centre := {centre}%Q;
  radius2 := {radius2}%Q;
  distance2 := {distance2}%Q;
{letters}
|}}.
"""
_BRANCH = """
(** One branch and its certificate (docs/branch.md). *)
From Coq Require Import QArith.
From Exactfold Require Import Rational Certificate.
Open Scope nat_scope.

{definition}
Lemma branch_checked : check_branch sheet_drawing branch_certificate = true.
Proof. vm_compute. reflexivity. Qed.

(** Exactly one solution with these boundary heights has these signs.
    It is near the heights of the certificate, and has these letters. *)
Theorem the_branch :
  let near_by := real_heights (height branch_certificate) in
  let up := pops_up branch_certificate in
  exists h, has_rim this_sheet near_by h /\\ solves this_sheet (fun _ => 0%R) h /\\
  has_signs this_sheet up h /\\
  (forall g, has_rim this_sheet near_by g -> solves this_sheet (fun _ => 0%R) g ->
    in_nappes this_sheet up g -> g = h) /\\
  (energy this_sheet (minus h near_by) <= Q2R (distance2 branch_certificate))%R /\\
  (forall i j l m valley, In (i, j, l, m, valley) (letters branch_certificate) ->
    (0 < sign valley * bend this_sheet i j l m h)%R).
Proof. exact (certified sheet_drawing branch_certificate sheet_checked branch_checked). Qed.
"""


_ALL = """
(** All branches and their certificates (docs/branch.md), one for each sign vector. *)
From Coq Require Import QArith.
From Exactfold Require Import Rational Certificate Counted.
Open Scope nat_scope.

{definitions}
Definition certificates : list certificate := {names}.
Lemma all_checked : check_all sheet_drawing {d} certificates = true.
Proof. vm_compute. reflexivity. Qed.

(** Exactly 2^{n} branches, complex ones included; all are real, one for each sign vector. *)
Theorem exactly_counted : exists l : list vec, length l = 2 ^ {n} /\\ NoDup l /\\
  (forall h, In h l <-> representative this_sheet {d} h) /\\
  (forall e, exists! h, In h l /\\ forall v, In v (inner this_sheet) ->
    (0 < sign (e v) * K2 this_sheet v (cone this_sheet v) h)%R) /\\
  (forall z, complex_solution this_sheet z -> complex_affine this_sheet z \\/
    exists h, In h l /\\ (exists s, on_branch this_sheet z s h) /\\
      forall h' s', In h' l -> on_branch this_sheet z s' h' -> h' = h).
Proof.
  pose proof (counted sheet_drawing {a} {b} {c} {d} certificates sheet_checked eq_refl corners
    all_checked) as H.
  change (sheet_of sheet_drawing sheet_checked) with this_sheet in H. rewrite size in H. exact H.
Qed.
"""


def branch_to_coq(certificate: Mapping[str, Any]) -> str:
    """The file of `to_coq`, and one branch with its certificate, which Coq verifies.

    `certificate` is an object that `exactfold.branches.branch_certificate` returns. Coq computes
    with `check_branch` of `proofs/formal/Certificate.v`, which is proved to be right. So exactly
    one solution has these vertex signs and these boundary heights, it is as near to the heights of
    the certificate as claimed, and its folds have all letters M and V that this distance decides.
    Flat folds are not claimed. Raises `NotApplicableError` for certificates that the formal proof
    does not cover: with a reflex corner, triangulated triangles, angle deficits, heights that solve
    the equations exactly, or a vertex that may be flat.
    """
    pattern = _pattern(certificate)
    record = _record("branch_certificate", pattern, certificate)
    return to_coq(pattern) + _BRANCH.format(definition=record)


def branches_to_coq(certificates: Sequence[Mapping[str, Any]]) -> str:
    """The file of `to_coq` for a sheet with four corners, with certificates of all branches.

    The certificates are those of `branch_to_coq` in the gauge "saddle", one for each of the 2^n
    sign vectors. Then no star is flat on any branch, and Coq proves that there are exactly 2^n
    branches, complex ones included, and that all of them are real. Raises `NotApplicableError` if a
    vertex is flat on a branch, if a sign vector has no certificate, or if the sheet does not have
    four corners. Also raises the errors of `branch_to_coq`.
    """
    if not certificates:
        raise NotApplicableError("branches are counted by their certificates: give at least one")
    pattern = _pattern(certificates[0])
    text, signs = to_coq(pattern), {tuple(c["claims"]["vertex_signs"]) for c in certificates}
    if pattern.Ve != 4:
        raise NotApplicableError(f"branches are counted for four corners, not for {pattern.Ve}")
    if flat := [s for s in signs if 0 in s]:
        shown, v = _shown(min(flat)), pattern.interior[min(flat).index(0)]
        raise NotApplicableError(
            f"vertex {v} is flat on the branch with the signs {shown}: the formal proof counts "
            "only branches of sheets on which no vertex can stay flat"
        )
    if missing := set(product((1, -1), repeat=pattern.Vi)) - signs:
        raise NotApplicableError(
            f"the branch with the signs {_shown(max(missing))} has no certificate: give all"
        )
    names = [f"branch_{k}" for k in range(len(certificates))]
    records = zip(names, certificates, strict=True)
    words = dict(zip("abcd", pinned_first(pattern), strict=True))
    definitions = "\n".join(_record(name, pattern, c) for name, c in records)
    return text + _ALL.format(definitions=definitions, names=listed(names), n=pattern.Vi, **words)


def _shown(signs: Sequence[int]) -> str:
    return "".join("0+-"[x] for x in signs)


def _pattern(certificate: Mapping[str, Any]) -> CreasePattern:
    document = certificate["pattern"]
    points = [tuple(map(parse_rational, point)) for point in document["vertices"]]
    return CreasePattern(points, document["triangles"])


def _record(name: str, pattern: CreasePattern, certificate: Mapping[str, Any]) -> str:
    """The definition of a certificate in Coq; raises the errors of `branch_to_coq`."""
    claims, evidence = certificate["claims"], certificate["evidence"]
    if evidence["emptied"]:
        raise NotApplicableError("the formal proof does not cover triangulated triangles")
    if "curvature" in claims:
        raise NotApplicableError("the formal proof does not cover angle deficits")
    denominator = int(evidence["denominator"])
    heights = {v: Fraction(int(h), denominator) for v, h in enumerate(evidence["heights"])}
    for v in pattern.interior:
        if curvature_form(pattern, v)(heights) <= 0:
            raise NotApplicableError(
                "the formal proof needs heights with positive curvature at every vertex, but "
                f"vertex {v} has none"
            )
    points, _ = pattern.integer_vertices
    distance = parse_rational(claims["squared_distance"])
    letters = sorted(_letters(pattern, heights, claims["assignment"], distance))
    if missing := set(pattern.interior) - {int(i) for i, *_ in letters}:
        raise NotApplicableError(
            f"vertex {min(missing)} may be flat: no letter of the certificate shows that it bends"
        )
    signs = zip(pattern.interior, claims["vertex_signs"], strict=True)
    twice = [min(x) + max(x) for x in zip(*points, strict=True)]
    far = [
        sum((2 * x - m) ** 2 for x, m in zip(points[v], twice, strict=True))
        for v in pattern.boundary
    ]
    inside = pattern.interior_set
    cones = (_cone(pattern, v) if v in inside else () for v in range(len(points)))
    words = {
        "near": wrapped("near", map(_number, heights.values()), "%Q"),
        "ups": wrapped("ups", (v for v, sign in signs if sign > 0)),
        "cones": wrapped("cones", (listed(f"({j}, ({x})%Z)" for j, x in cone) for cone in cones)),
        "centre": f"({', '.join(_number(Fraction(m, 2)) for m in twice)})",
        "radius2": _number(Fraction(max(far), 4)),
        "distance2": _number(distance),
        "letters": wrapped("letters", (f"({', '.join(map(str, fold))})" for fold in letters)),
    }
    return _RECORD.format(name=name, **words)


def _number(x: Fraction) -> str:
    return f"({x.numerator} # {x.denominator})"


def _cone(pattern: CreasePattern, v: int) -> list[tuple[int, int]]:
    """Integer heights of a mountain around a vertex with K_v > 0: the rounded lengths."""
    points, _ = pattern.integer_vertices
    form, bits = curvature_form(pattern, v), 8
    while True:
        cone = {v: 0}
        for j in pattern.star(v):
            square = sum((a - b) ** 2 for a, b in zip(points[j], points[v], strict=True))
            cone[j] = -isqrt(square << 2 * bits)
        if form({j: Fraction(x) for j, x in cone.items()}) > 0:
            return [(j, x) for j, x in cone.items() if x]
        bits *= 2


def _letters(
    pattern: CreasePattern, heights: Heights, letters: str, distance: Fraction
) -> Iterator[tuple[int, int, int, int, str]]:
    """Yields, from both ends, each fold whose letter M or V holds within the distance."""
    for (a, b), letter in zip(pattern.folds, letters, strict=True):
        left, right = pattern.opposite((a, b))
        if letter in "MV" and _is_far(pattern, heights, (a, b, left, right), distance):
            valley = str(letter == "V").lower()
            yield a, b, left, right, valley
            yield b, a, right, left, valley


def _is_far(
    pattern: CreasePattern, heights: Heights, fold: tuple[int, int, int, int], distance: Fraction
) -> bool:
    """Whether the squared (bend times length) exceeds L^2 (2/c + 2/c') times `distance`."""
    i, j, left, right = fold
    along = _spoke(pattern, i, j)
    c, g = _slope(pattern, heights, (i, j, left))
    d, k = _slope(pattern, heights, (i, right, j))
    bend = (g[1] - k[1]) * along[0] - (g[0] - k[0]) * along[1]
    return bend**2 > (along[0] ** 2 + along[1] ** 2) * (2 / c + 2 / d) * distance


def _spoke(pattern: CreasePattern, i: int, j: int) -> Pair:
    (x, y), (z, w) = pattern.vertices[i], pattern.vertices[j]
    return z - x, w - y


def _slope(
    pattern: CreasePattern, heights: Heights, corner: tuple[int, int, int]
) -> tuple[Fraction, Pair]:
    """Twice the area of a face, and the gradient of the heights on it."""
    i, j, k = corner
    a, b = _spoke(pattern, i, j), _spoke(pattern, i, k)
    x, y = heights[j] - heights[i], heights[k] - heights[i]
    c = a[0] * b[1] - a[1] * b[0]
    return c, ((x * b[1] - y * a[1]) / c, (y * a[0] - x * b[0]) / c)
