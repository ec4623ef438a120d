(** Sheets with integer coordinates, whose hypotheses are decided by computation. *)
From Coq Require Import Reals ZArith List Permutation Lra Lia Arith Bool.
From Exactfold Require Import Sums Vectors Sheet.
Import ListNotations.

(** A drawing: coordinates of the vertices 0, 1, ..., the vertices inside and on the rim, the faces,
    and the neighbours of each vertex, counter-clockwise: all round and the first once more, or from
    one side of the rim to the other. *)
Record drawing := Drawing {
  points : list (Z * Z);
  inside : list nat;
  border : list nat;
  triangles : list face;
  fans_of : list (list nat)
}.

Section Drawing.
Variable d : drawing.
Local Open Scope Z_scope.

Definition place (u : nat) : Z * Z := nth u (points d) (0, 0).
(** The cross product of the vectors from [v] to [a] and to [b]. *)
Definition zcross (v a b : nat) : Z :=
  (fst (place a) - fst (place v)) * (snd (place b) - snd (place v)) -
  (snd (place a) - snd (place v)) * (fst (place b) - fst (place v)).

Definition at_R (u : nat) : point := (IZR (fst (place u)), IZR (snd (place u))).

Lemma cross_IZR v a b : cross (sub (at_R a) (at_R v)) (sub (at_R b) (at_R v)) = IZR (zcross v a b).
Proof. unfold cross, sub, at_R, zcross. cbn [fst snd]. now rewrite minus_IZR, !mult_IZR, !minus_IZR. Qed.

Lemma cross_IZR_spoke v a b : cross (spoke at_R v a) (spoke at_R v b) = IZR (zcross v a b).
Proof. apply cross_IZR. Qed.

Lemma face_eq_dec (a b : nat * nat) : {a = b} + {a <> b}.
Proof. repeat decide equality. Defined.

Definition mem (a : nat) (l : list nat) : bool := if in_dec Nat.eq_dec a l then true else false.
Definition mem2 (a : nat * nat) (l : list (nat * nat)) : bool := existsb (fun b =>
  Nat.eqb (fst a) (fst b) && Nat.eqb (snd a) (snd b)) l.
Fixpoint once (l : list nat) : bool := match l with [] => true | a :: l => negb (mem a l) && once l end.
Fixpoint once2 (l : list (nat * nat)) : bool :=
  match l with [] => true | a :: l => negb (mem2 a l) && once2 l end.

Lemma mem_in a l : mem a l = true <-> In a l.
Proof. unfold mem. destruct in_dec; intuition congruence. Qed.

Lemma mem2_in a l : mem2 a l = true <-> In a l.
Proof.
  unfold mem2. rewrite existsb_exists. split.
  - intros ([x y] & H & E). destruct a as [p q]. cbn in E. apply andb_prop in E. destruct E as (E & F).
    apply Nat.eqb_eq in E, F. now subst.
  - intros H. exists a. split; [assumption|]. now rewrite !Nat.eqb_refl.
Qed.

Lemma once_NoDup l : once l = true -> NoDup l.
Proof.
  induction l as [|a l IH]; simpl; intros H; constructor; apply andb_prop in H; destruct H as (N & H).
  - intros Ha. apply mem_in in Ha. now rewrite Ha in N.
  - auto.
Qed.

Lemma once2_NoDup l : once2 l = true -> NoDup l.
Proof.
  induction l as [|a l IH]; simpl; intros H; constructor; apply andb_prop in H; destruct H as (N & H).
  - intros Ha. apply mem2_in in Ha. now rewrite Ha in N.
  - auto.
Qed.

Definition same2 (l l' : list (nat * nat)) : bool :=
  once2 l && once2 l' && forallb (fun a => mem2 a l') l && forallb (fun a => mem2 a l) l'.

Lemma same2_permutation l l' : same2 l l' = true -> Permutation l l'.
Proof.
  unfold same2. rewrite !andb_true_iff, !forallb_forall. intros (((D & D') & H) & H').
  apply NoDup_Permutation; [now apply once2_NoDup|now apply once2_NoDup|].
  intros a. split; intros Ha; apply mem2_in; auto.
Qed.

(** The longest beginning of a list in which [f] holds, and the rest. *)
Fixpoint span (f : nat -> bool) (l : list nat) : list nat * list nat :=
  match l with
  | [] => ([], [])
  | a :: l' => if f a then let (x, y) := span f l' in (a :: x, y) else ([], l)
  end.

Lemma span_app f l : l = fst (span f l) ++ snd (span f l) /\ forall a, In a (fst (span f l)) -> f a = true.
Proof.
  induction l as [|a l (E & H)]; simpl; [easy|]. destruct (f a) eqn:Fa; [|easy].
  destruct (span f l) as (x, y). cbn in *. split; [congruence|]. intros b [<-|Hb]; auto.
Qed.

Definition full_star (v : nat) : bool :=
  match nth v (fans_of d) [] with
  | [] => false
  | u :: l =>
    match span (fun z => 0 <? zcross v u z) l with
    | (_ :: _, q :: b :: r) =>
      let down := b :: r in
      (zcross v u q <=? 0) && forallb (fun z => zcross v u z <? 0) (removelast down) &&
      Nat.eqb (last down q) u
    | _ => false
    end
  end.

Definition convex_at (v : nat) : bool :=
  match nth v (fans_of d) [] with
  | u :: a :: l' =>
    let l := a :: l' in
    mem u (border d) && mem (last l u) (border d) &&
    forallb (fun z => 0 <? zcross v u z) (removelast l) && (0 <=? zcross v u (last l u))
  | _ => false
  end.

(** All hypotheses of a sheet. *)
Definition check : bool :=
  once (inside d ++ border d) &&
  forallb (fun f => let '(v, a, b) := f in mem v (inside d ++ border d)) (corners (triangles d)) &&
  forallb (fun f => let '(a, b, c) := f in 0 <? zcross a b c) (triangles d) &&
  once2 (sides (triangles d)) &&
  forallb (fun s => mem2 (snd s, fst s) (sides (triangles d)) ||
    (mem (fst s) (border d) && mem (snd s) (border d))) (sides (triangles d)) &&
  forallb (fun v => same2 (steps (nth v (fans_of d) [])) (link (triangles d) v)) (inside d ++ border d) &&
  forallb full_star (inside d) && forallb convex_at (border d).

Lemma full_star_turn v : full_star v = true -> one_turn at_R v (nth v (fans_of d) []).
Proof.
  unfold full_star. destruct (nth v (fans_of d) []) as [|u l]; [easy|].
  pose proof (span_app (fun z => 0 <? zcross v u z) l) as (E & Pos).
  destruct (span _ l) as ([|a up], [|q [|b r]]); try easy. cbn [fst snd] in *.
  rewrite !andb_true_iff, forallb_forall. intros ((Q & Neg) & La). apply Nat.eqb_eq in La.
  set (down := b :: r) in *. assert (Nd : down <> []) by easy.
  pose proof (app_removelast_last q Nd) as D. rewrite La in D.
  assert (Na : a :: up <> []) by easy. pose proof (app_removelast_last u Na) as A.
  exists u, (removelast (a :: up)), (last (a :: up) u), q, (removelast down). split; [|split; [|split]].
  - rewrite E. rewrite A at 1. rewrite D at 1. now rewrite <- app_assoc.
  - intros z Hz. rewrite <- A in Hz. specialize (Pos z Hz). apply Z.ltb_lt in Pos.
    rewrite cross_IZR_spoke. now apply IZR_lt.
  - rewrite cross_IZR_spoke. apply IZR_le. now apply Z.leb_le.
  - intros z Hz. specialize (Neg z Hz). apply Z.ltb_lt in Neg. rewrite cross_IZR_spoke. now apply IZR_lt.
Qed.

Lemma convex_at_turn v : convex_at v = true -> at_most_half_turn at_R (border d) v (nth v (fans_of d) []).
Proof.
  unfold convex_at. destruct (nth v (fans_of d) []) as [|u [|a l]]; try easy. cbv zeta.
  rewrite !andb_true_iff, forallb_forall. intros (((Hu & Hq) & Pos) & Q).
  assert (Na : a :: l <> []) by easy. pose proof (app_removelast_last u Na) as A.
  exists u, (removelast (a :: l)), (last (a :: l) u). split; [now rewrite <- A|].
  apply mem_in in Hu, Hq. repeat split; try assumption.
  - intros z Hz. specialize (Pos z Hz). apply Z.ltb_lt in Pos. rewrite cross_IZR_spoke. now apply IZR_lt.
  - rewrite cross_IZR_spoke. apply IZR_le. now apply Z.leb_le.
Qed.

(** A drawing that passes is a sheet. *)
Lemma checked : check = true ->
  NoDup (inside d ++ border d) /\
  (forall v a b, In (v, a, b) (corners (triangles d)) -> In v (inside d ++ border d)) /\
  (forall a b c, In (a, b, c) (triangles d) -> (0 < cross (sub (at_R b) (at_R a)) (sub (at_R c) (at_R a)))%R) /\
  NoDup (sides (triangles d)) /\
  (forall a b, In (a, b) (sides (triangles d)) ->
    In (b, a) (sides (triangles d)) \/ (In a (border d) /\ In b (border d))) /\
  (forall v, In v (inside d ++ border d) ->
    Permutation (steps (nth v (fans_of d) [])) (link (triangles d) v)) /\
  (forall v, In v (inside d) -> one_turn at_R v (nth v (fans_of d) [])) /\
  (forall v, In v (border d) -> at_most_half_turn at_R (border d) v (nth v (fans_of d) [])).
Proof.
  unfold check. rewrite !andb_true_iff, !forallb_forall.
  intros (((((((H1 & H2) & H3) & H4) & H5) & H6) & H7) & H8). repeat apply conj.
  - now apply once_NoDup.
  - intros v a b Hc. specialize (H2 _ Hc). now apply mem_in in H2.
  - intros a b c Hf. specialize (H3 _ Hf). apply Z.ltb_lt in H3. rewrite cross_IZR. now apply IZR_lt.
  - now apply once2_NoDup.
  - intros a b Hs. specialize (H5 _ Hs). cbn [fst snd] in H5.
    now rewrite orb_true_iff, andb_true_iff, mem2_in, !mem_in in H5.
  - intros v Hv. now apply same2_permutation, H6.
  - intros v Hv. now apply full_star_turn, H7.
  - intros v Hv. now apply convex_at_turn, H8.
Qed.

Definition sheet_of (ok : check = true) : sheet :=
  let p := checked ok in
  Sheet at_R (inside d) (border d) (triangles d) (fun v => nth v (fans_of d) [])
    (proj1 p) (proj1 (proj2 p)) (proj1 (proj2 (proj2 p))) (proj1 (proj2 (proj2 (proj2 p))))
    (proj1 (proj2 (proj2 (proj2 (proj2 p))))) (proj1 (proj2 (proj2 (proj2 (proj2 (proj2 p))))))
    (proj1 (proj2 (proj2 (proj2 (proj2 (proj2 (proj2 p)))))))
    (proj2 (proj2 (proj2 (proj2 (proj2 (proj2 (proj2 p))))))).

End Drawing.
