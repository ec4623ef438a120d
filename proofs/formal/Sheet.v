(** Convex sheets, their curvature forms and their energy: the definitions of docs/theorem.md. *)
From Coq Require Import Reals List Permutation Lra Lia Arith.
From Exactfold Require Import Sums Vectors.
Import ListNotations.
Open Scope R_scope.

(** ** The plane *)

Definition point := (R * R)%type.
Definition sub (a b : point) : point := (fst a - fst b, snd a - snd b).
Definition dot (a b : point) : R := fst a * fst b + snd a * snd b.
Definition cross (a b : point) : R := fst a * snd b - snd a * fst b.
(** Rotation by a right angle. *)
Definition J (a : point) : point := (- snd a, fst a).

(** ** Combinatorics *)

Definition face := (nat * nat * nat)%type.

(** The corners of the faces: a vertex with the two that follow it counter-clockwise. *)
Definition corners (faces : list face) : list face :=
  flat_map (fun f => let '(a, b, c) := f in [(a, b, c); (b, c, a); (c, a, b)]) faces.

(** The sides of the faces, run through counter-clockwise. *)
Definition sides (faces : list face) : list (nat * nat) :=
  map (fun f => let '(a, b, c) := f in (a, b)) (corners faces).

(** The sides that the faces at [v] have opposite to [v]. *)
Definition link (faces : list face) (v : nat) : list (nat * nat) :=
  map (fun f => let '(u, a, b) := f in (a, b))
    (filter (fun f => let '(u, a, b) := f in Nat.eqb u v) (corners faces)).

(** Consecutive pairs of a list. *)
Fixpoint steps (l : list nat) : list (nat * nat) :=
  match l with
  | a :: (b :: _) as l' => (a, b) :: steps l'
  | _ => []
  end.

Section Turns.
Variable at_ : nat -> point.
Definition spoke (v u : nat) : point := sub (at_ u) (at_ v).

(** The spokes of [v] to the vertices in [l] go round once and return to the first: at first they
    are on its left, up to [p], and from [q] on they are on its right; [q] itself may be opposite. *)
Definition one_turn (v : nat) (l : list nat) : Prop :=
  exists u up p q down, l = u :: up ++ p :: q :: down ++ [u] /\
    (forall z, In z (up ++ [p]) -> 0 < cross (spoke v u) (spoke v z)) /\
    cross (spoke v u) (spoke v q) <= 0 /\
    (forall z, In z down -> cross (spoke v u) (spoke v z) < 0).

(** The spokes of [v] to the vertices in [l] fill an angle of at most pi, between two sides that
    end on the rim. *)
Definition at_most_half_turn (rim : list nat) (v : nat) (l : list nat) : Prop :=
  exists u mid q, l = u :: mid ++ [q] /\ In u rim /\ In q rim /\
    (forall z, In z mid -> 0 < cross (spoke v u) (spoke v z)) /\
    0 <= cross (spoke v u) (spoke v q).
End Turns.

(** ** Sheets

    Nothing global is asked for: that the vertices on the rim have angles of at most pi and the
    others full stars is all that the proof uses of a convex polygon. *)
Record sheet := Sheet {
  at_ : nat -> point;                (* U_v *)
  inner : list nat;                  (* I *)
  rim : list nat;                    (* B *)
  faces : list face;
  fan : nat -> list nat;             (* the neighbours of a vertex, counter-clockwise *)
  vertices_once : NoDup (inner ++ rim);
  faces_on_vertices : forall v a b, In (v, a, b) (corners faces) -> In v (inner ++ rim);
  oriented : forall a b c, In (a, b, c) faces -> 0 < cross (sub (at_ b) (at_ a)) (sub (at_ c) (at_ a));
  sides_once : NoDup (sides faces);
  sides_paired : forall a b, In (a, b) (sides faces) ->
    In (b, a) (sides faces) \/ (In a rim /\ In b rim);
  fans : forall v, In v (inner ++ rim) -> Permutation (steps (fan v)) (link faces v);
  inner_full : forall v, In v inner -> one_turn at_ v (fan v);
  rim_convex : forall v, In v rim -> at_most_half_turn at_ rim v (fan v)
}.

(** ** Forms *)

(** What a face with the spokes [d], [d'] at a vertex contributes to its curvature, if its corners
    on them are [x], [x'] above the vertex (docs/mathematics.md, 1). *)
Definition wedge (d d' : point) (x x' : R) : R :=
  x * x' / cross d d' -
  dot d d' / (2 * cross d d') * (x * x / dot d d + x' * x' / dot d' d').

(** Its polar form. *)
Definition wedge2 (d d' : point) (x x' y y' : R) : R :=
  (x * y' + x' * y) / (2 * cross d d') -
  dot d d' / (2 * cross d d') * (x * y / dot d d + x' * y' / dot d' d').

(** The gradient of the linear function with the values [x] at [d] and [x'] at [d']. *)
Definition gradient (d d' : point) (x x' : R) : point :=
  ((x * snd d' - x' * snd d) / cross d d', (x' * fst d - x * fst d') / cross d d').

Section Forms.
Variable S : sheet.
Notation spoke := (spoke (at_ S)).

(** The curvature form K_v; of a vertex on the rim it is A_b. *)
Definition K (v : nat) (h : vec) : R :=
  sum (steps (fan S v)) (fun s => let '(a, b) := s in
    wedge (spoke v a) (spoke v b) (h a - h v) (h b - h v)).

(** The polar form K_v(g, h). *)
Definition K2 (v : nat) (g h : vec) : R :=
  sum (steps (fan S v)) (fun s => let '(a, b) := s in
    wedge2 (spoke v a) (spoke v b) (g a - g v) (g b - g v) (h a - h v) (h b - h v)).

(** Gradient, area and energy on a face, and the integral of |grad h|^2 over the sheet. *)
Definition face_gradient (f : face) (h : vec) : point :=
  let '(a, b, c) := f in gradient (spoke a b) (spoke a c) (h b - h a) (h c - h a).
Definition area (f : face) : R := let '(a, b, c) := f in cross (spoke a b) (spoke a c) / 2.
Definition energy (h : vec) : R :=
  sum (faces S) (fun f => area f * dot (face_gradient f h) (face_gradient f h)).

(** The round cone at [v]; the vertex sign of [h] at [v] is the sign of K_v(cone v, h). *)
Definition cone (v : nat) : vec := fun u => - sqrt (dot (spoke v u) (spoke v u)).

(** The multipliers R^2 - |U_v - c|^2. *)
Definition multiplier (c : point) (R2 : R) (v : nat) : R :=
  R2 - dot (sub (at_ S v) c) (sub (at_ S v) c).

End Forms.
