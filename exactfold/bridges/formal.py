"""Sheets as files of Coq, on which the formal proof of the theorem can be used."""

from __future__ import annotations

from collections.abc import Iterable

from exactfold.errors import NotApplicableError
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.loading import PatternLike, as_pattern
from exactfold.pattern.validate import orientation

_HEAD = """\
(** A sheet, written by exactfold.  Coordinates are multiplied by {denominator}. *)
From Coq Require Import Reals ZArith List Lra.
From Exactfold Require Import Vectors Nappes Sheet Flat Complex Theorems Branches Drawing.
Import ListNotations.
Open Scope nat_scope.

Definition sheet_drawing : drawing := {{|
  points := [{points}]%Z;
  inside := [{inside}];
  border := [{border}];
  triangles := [{triangles}];
  fans_of := [{fans}]
|}}.

(** The hypotheses of a convex sheet, decided by computation. *)
Lemma sheet_checked : check sheet_drawing = true.
Proof. vm_compute. reflexivity. Qed.
Definition this_sheet : sheet := sheet_of sheet_drawing sheet_checked.
Lemma size : length (inner this_sheet) = {n}.
Proof. reflexivity. Qed.

(** With heights of the rim and curvatures > 0: 2^{n} shapes. *)
Theorem shapes (k : nat -> R) (r : vec) : (forall v, In v [{inside}] -> (0 < k v)%R) ->
  exists l : list vec, length l = 2 ^ {n} /\\ NoDup l /\\
    forall h, In h l <-> has_rim this_sheet r h /\\ solves this_sheet k h.
Proof.
  intros P. destruct (list_of_solutions this_sheet k r) as (l & Len & Sol & Once).
  - intros v Hv. apply Rlt_le, P, Hv.
  - rewrite size in Len. exists l. split; [exact Len|]. split; [|exact Sol].
    apply Once. intros h _ Hs v Hv. left. rewrite (Hs v Hv). apply P, Hv.
Qed.
"""

_CORNERS = """
Lemma corners : cross (sub (at_R sheet_drawing {b}) (at_R sheet_drawing {a}))
  (sub (at_R sheet_drawing {c}) (at_R sheet_drawing {a})) <> 0%R.
Proof. rewrite cross_IZR. now apply (IZR_neq _ 0). Qed.
"""

_BRANCHES = """
(** At most 2^{n} branches, all real; as many if no star is flat on any of them. *)
Theorem at_most : exists l : list vec, length l = 2 ^ {n} /\\
  (forall h, In h l <-> representative this_sheet {d} h) /\\
  forall z, complex_solution this_sheet z ->
    complex_affine this_sheet z \\/ exists s h, In h l /\\ on_branch this_sheet z s h.
Proof.
  rewrite <- size. exact (at_most_2_to_the_n this_sheet {a} {b} {c} {d} eq_refl corners).
Qed.

Theorem exactly :
  (forall h, representative this_sheet {d} h ->
    forall v, In v [{inside}] -> ~ flat_star this_sheet v h) ->
  exists l : list vec, length l = 2 ^ {n} /\\ NoDup l /\\
    forall h, In h l <-> representative this_sheet {d} h.
Proof.
  intros NF. destruct (branches this_sheet {a} {b} {c} {d} eq_refl corners NF)
    as (l & Len & Once & Sol & _).
  rewrite size in Len. now exists l.
Qed.
"""

_RIGID = """
(** Three corners: the sheet is rigid. *)
Theorem is_rigid z : complex_solution this_sheet z -> complex_affine this_sheet z.
Proof. exact (rigid this_sheet {a} {b} {c} z eq_refl corners). Qed.
"""


def to_coq(pattern: PatternLike) -> str:
    """The sheet as a file for `proofs/formal`, with what is proved of it there.

    Coordinates are integers, in the unit that makes them so. Coq decides by computation that the
    hypotheses of the theorem hold (`check` in `proofs/formal/Drawing.v`). With three or four
    corners the branches are bounded as well. Raises `NotApplicableError` if the border is not
    convex, and the errors of `load`.

    >>> print(to_coq("two-vertex").splitlines()[7])
      points := [(0, 0); (840, 0); (840, 840); (0, 840); (280, 336); (525, 480)]%Z;
    """
    sheet = as_pattern(pattern)
    if not sheet.is_convex:
        raise NotApplicableError(
            f"the formal proof is about a convex border: vertex {sheet.reflex_corner} is reflex"
        )
    points, denominator = sheet.integer_vertices
    rim = _pinned_first(sheet)
    words = {
        "denominator": denominator,
        "points": _listed(f"({x}, {y})" for x, y in points),
        "inside": _listed(sheet.interior),
        "border": _listed(rim),
        "triangles": _listed(f"({a}, {b}, {c})" for a, b, c in sheet.triangles),
        "fans": _listed(f"[{_listed(_fan(sheet, v))}]" for v in range(len(points))),
        "n": sheet.Vi,
    }
    words |= dict(zip("abcd", rim, strict=False))
    parts = {3: [_CORNERS, _RIGID], 4: [_CORNERS, _BRANCHES]}.get(sheet.Ve, [])
    return "".join(part.format(**words) for part in [_HEAD, *parts])


def _listed(items: Iterable[object]) -> str:
    return "; ".join(map(str, items))


def _fan(sheet: CreasePattern, vertex: int) -> tuple[int, ...]:
    """The neighbours in order; at an interior vertex the first one once more."""
    star = sheet.star(vertex)
    return (*star, star[0]) if vertex in sheet.interior_set else star


def _pinned_first(sheet: CreasePattern) -> tuple[int, ...]:
    """The boundary from a vertex on that it forms a triangle with the next two."""
    points, _ = sheet.integer_vertices
    rim = sheet.boundary
    turned = [rim[k:] + rim[:k] for k in range(len(rim))]
    return next(r for r in turned if orientation(*(points[v] for v in r[:3])) > 0)
