"""Writes sheets as Coq files, to which the formal proof of the theorem can be applied."""

from __future__ import annotations

import re
from collections.abc import Iterable
from textwrap import fill

from exactfold.errors import NotApplicableError
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.loading import PatternLike, as_pattern
from exactfold.pattern.validate import orientation

_HEAD = """\
(** A sheet, written by exactfold.  Coordinates are multiplied by {denominator}.
    Once `make -C proofs/formal` is done: coqc -Q proofs/formal Exactfold THIS_FILE.v *)
From Coq Require Import Reals ZArith List Lra.
From Exactfold Require Import Vectors Nappes Sheet Flat Complex Theorems Branches Drawing.
Import ListNotations.
Open Scope nat_scope.

Definition sheet_drawing : drawing := {{|
{points};
{inside};
{border};
{triangles};
{fans}
|}}.

(** The hypotheses of a convex sheet, decided by computation. *)
Lemma sheet_checked : check sheet_drawing = true.
Proof. vm_compute. reflexivity. Qed.
Definition this_sheet : sheet := sheet_of sheet_drawing sheet_checked.
Lemma size : length (inner this_sheet) = {n}.
Proof. reflexivity. Qed.

(** For given boundary heights and curvatures > 0: 2^{n} shapes. *)
Theorem shapes (k : nat -> R) (r : vec) : (forall v, In v (inside sheet_drawing) -> (0 < k v)%R) ->
  exists l : list vec, length l = 2 ^ {n} /\\ NoDup l /\\
    forall h, In h l <-> has_rim this_sheet r h /\\ solves this_sheet k h.
Proof.
  intros P. destruct (list_of_solutions this_sheet k r) as (l & Len & Sol & Once).
  - intros v Hv. apply Rlt_le, P, Hv.
  - rewrite size in Len. exists l. refine (conj Len (conj _ Sol)).
    apply Once. intros h _ Hs v Hv. left. rewrite (Hs v Hv). apply P, Hv.
Qed.
"""

_CORNERS = """
Lemma corners : cross (sub (at_R sheet_drawing {b}) (at_R sheet_drawing {a}))
  (sub (at_R sheet_drawing {c}) (at_R sheet_drawing {a})) <> 0%R.
Proof. rewrite cross_IZR. now apply (IZR_neq _ 0). Qed.
"""

_BRANCHES = """
(** At most 2^{n} branches, all real.  The file with all certificates (`--all`) proves that they are
    exactly so many, as its certificates show that no star is flat on any branch. *)
Theorem at_most : exists l : list vec, length l = 2 ^ {n} /\\
  (forall h, In h l <-> representative this_sheet {d} h) /\\
  forall z, complex_solution this_sheet z ->
    complex_affine this_sheet z \\/ exists s h, In h l /\\ on_branch this_sheet z s h.
Proof.
  pose proof (at_most_2_to_the_n this_sheet {a} {b} {c} {d} eq_refl corners) as H.
  rewrite size in H. exact H.
Qed.
"""

_RIGID = """
(** Three corners: the sheet is rigid. *)
Theorem is_rigid z : complex_solution this_sheet z -> complex_affine this_sheet z.
Proof. exact (rigid this_sheet {a} {b} {c} z eq_refl corners). Qed.
"""


def to_coq(pattern: PatternLike) -> str:
    """The sheet as a file for `proofs/formal`, with the theorems that are proved there.

    Coordinates become integers in a suitable unit. Coq decides by computation that the hypotheses
    of the theorem hold (`check` in `proofs/formal/Drawing.v`). With three or four corners the
    number of branches is bounded as well. This file does not state that there are exactly 2^n
    branches, which is false if some star is flat on a branch; `branches_to_coq` adds the
    certificates that show that no star is. Raises `NotApplicableError` if the boundary is not
    convex, and the errors of `load`.

    >>> print(to_coq("two-vertex").splitlines()[8])
      points := [(0, 0); (840, 0); (840, 840); (0, 840); (280, 336); (525, 480)]%Z;
    """
    sheet = as_pattern(pattern)
    if not sheet.is_convex:
        raise NotApplicableError(
            f"the formal proof needs a convex boundary: vertex {sheet.reflex_corner} is reflex"
        )
    points, denominator = sheet.integer_vertices
    boundary = pinned_first(sheet)
    words = {
        "denominator": denominator,
        "points": wrapped("points", points, "%Z"),
        "inside": wrapped("inside", sheet.interior),
        "border": wrapped("border", boundary),
        "triangles": wrapped("triangles", sheet.triangles),
        "fans": wrapped("fans_of", (listed(_fan(sheet, v)) for v in range(len(points)))),
        "n": sheet.Vi,
    }
    words |= dict(zip("abcd", boundary, strict=False))
    parts = {3: [_CORNERS, _RIGID], 4: [_CORNERS, _BRANCHES]}.get(sheet.Ve, [])
    return "".join(part.format(**words) for part in [_HEAD, *parts])


def listed(items: Iterable[object]) -> str:
    """A list in the notation of Coq.

    >>> listed([1, 2])
    '[1; 2]'
    """
    return f"[{'; '.join(map(str, items))}]"


def wrapped(name: str, items: Iterable[object], end: str = "") -> str:
    """A field of the drawing, broken into lines of at most 100 characters."""
    whole = (re.sub("(?<!;) ", "\0", str(item)) for item in items)
    text = f"  {name} := {listed(whole)}{end}"
    lines = fill(
        text, 100, subsequent_indent="    ", break_on_hyphens=False, break_long_words=False
    )
    return lines.replace("\0", " ")


def _fan(sheet: CreasePattern, vertex: int) -> tuple[int, ...]:
    """The neighbours in order; at an interior vertex the first one is repeated at the end."""
    star = sheet.star(vertex)
    return (*star, star[0]) if vertex in sheet.interior_set else star


def pinned_first(sheet: CreasePattern) -> tuple[int, ...]:
    """The boundary, rotated so that its first three vertices form a triangle.

    If there are four, the last is the one to which `BranchSystem` gives the height 1.

    >>> pinned_first(as_pattern("two-vertex"))
    (1, 2, 3, 0)
    """
    points, _ = sheet.integer_vertices
    boundary = sheet.boundary
    turned = [boundary[k:] + boundary[:k] for k in (*range(1, len(boundary)), 0)]
    return next(r for r in turned if orientation(*(points[v] for v in r[:3])) > 0)
