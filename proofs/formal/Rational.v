(** Rational heights on a drawing: curvatures, gradients and bends, computed exactly. *)
From Coq Require Import Reals QArith Qreals ZArith List Lra Lia Arith Bool FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Sheet Identities Star KeyLemma Drawing.
Import ListNotations.
Open Scope R_scope.

(** ** Rational numbers among the real ones *)

Lemma Q2R_red x : Q2R (Qred x) = Q2R x.
Proof. apply Qeq_eqR, Qred_correct. Qed.

Lemma Q2R_Z z : Q2R (inject_Z z) = IZR z.
Proof. unfold Q2R, inject_Z. cbn [Qnum Qden]. field. Qed.

Lemma Q2R_over x z : z <> 0%Z -> Q2R (x / inject_Z z) = Q2R x / IZR z.
Proof.
  intros N. rewrite Q2R_div, Q2R_Z; [reflexivity|]. intros E. apply N.
  unfold Qeq in E. simpl in E. lia.
Qed.

Definition below (x y : Q) : bool := Z.ltb (Qnum x * Zpos (Qden y)) (Qnum y * Zpos (Qden x)).
Definition at_most (x y : Q) : bool := Z.leb (Qnum x * Zpos (Qden y)) (Qnum y * Zpos (Qden x)).

Lemma below_R x y : below x y = true -> Q2R x < Q2R y.
Proof. intros H. apply Qlt_Rlt. unfold Qlt. now apply Z.ltb_lt. Qed.

Lemma at_most_R x y : at_most x y = true -> Q2R x <= Q2R y.
Proof. intros H. apply Qle_Rle. unfold Qle. now apply Z.leb_le. Qed.

Definition qsum {A} (l : list A) (f : A -> Q) : Q := fold_right (fun a s => Qred (f a + s)) 0%Q l.

Lemma qsum_R {A} (l : list A) f : Q2R (qsum l f) = sum l (fun a => Q2R (f a)).
Proof.
  induction l as [|a l IH]; cbn [qsum fold_right sum]; [unfold Q2R; simpl; ring|].
  rewrite Q2R_red, Q2R_plus. fold (qsum l f). now rewrite IH.
Qed.

(** ** Vectors with integer coordinates *)

Definition zvector := (Z * Z)%type.
Definition zdot (a b : zvector) : Z := fst a * fst b + snd a * snd b.
Definition zturn (a b : zvector) : Z := fst a * snd b - snd a * fst b.
Definition to_point (a : zvector) : point := (IZR (fst a), IZR (snd a)).

Lemma dot_R a b : dot (to_point a) (to_point b) = IZR (zdot a b).
Proof. unfold dot, zdot, to_point. cbn [fst snd]. now rewrite plus_IZR, !mult_IZR. Qed.

Lemma turn_R a b : cross (to_point a) (to_point b) = IZR (zturn a b).
Proof. unfold cross, zturn, to_point. cbn [fst snd]. now rewrite minus_IZR, !mult_IZR. Qed.

Definition qwedge2 (a b : zvector) (x x' y y' : Q) : Q :=
  let c := (2 * zturn a b)%Z in
  Qred ((x * y' + x' * y) / inject_Z c -
    inject_Z (zdot a b) / inject_Z c * (x * y / inject_Z (zdot a a) + x' * y' / inject_Z (zdot b b))).

Lemma qwedge2_R a b x x' y y' : cross (to_point a) (to_point b) <> 0 ->
  Q2R (qwedge2 a b x x' y y') = wedge2 (to_point a) (to_point b) (Q2R x) (Q2R x') (Q2R y) (Q2R y').
Proof.
  intros C. pose proof (cross_left _ _ C) as A. pose proof (cross_right _ _ C) as B.
  rewrite turn_R in C. rewrite dot_R in A, B.
  assert (C' : (2 * zturn a b)%Z <> 0%Z).
  { intros E. apply C. replace (zturn a b) with 0%Z by lia. reflexivity. }
  assert (A' : zdot a a <> 0%Z) by (intros E; apply A; now rewrite E).
  assert (B' : zdot b b <> 0%Z) by (intros E; apply B; now rewrite E).
  unfold qwedge2, wedge2. rewrite Q2R_red, Q2R_minus, Q2R_mult, Q2R_plus, !Q2R_over by assumption.
  rewrite Q2R_plus, !Q2R_mult, Q2R_Z, !dot_R, turn_R, mult_IZR. reflexivity.
Qed.

Definition qgradient (a b : zvector) (x x' : Q) : Q * Q :=
  let c := inject_Z (zturn a b) in
  (Qred ((x * inject_Z (snd b) - x' * inject_Z (snd a)) / c),
   Qred ((x' * inject_Z (fst a) - x * inject_Z (fst b)) / c)).

Definition to_plane (g : Q * Q) : point := (Q2R (fst g), Q2R (snd g)).

Lemma qgradient_R a b x x' : cross (to_point a) (to_point b) <> 0 ->
  to_plane (qgradient a b x x') = gradient (to_point a) (to_point b) (Q2R x) (Q2R x').
Proof.
  intros C. assert (C' : zturn a b <> 0%Z) by (intros E; apply C; now rewrite turn_R, E).
  unfold qgradient, to_plane, gradient. cbn [fst snd].
  rewrite !Q2R_red, !Q2R_over, !Q2R_minus, !Q2R_mult, !Q2R_Z, turn_R by assumption. reflexivity.
Qed.

(** ** Sheets *)

Section Rational.
Variable d : drawing.
Hypothesis ok : check d = true.
Notation S := (sheet_of d ok).

Definition zspoke (v u : nat) : zvector :=
  (fst (place d u) - fst (place d v), snd (place d u) - snd (place d v))%Z.

Lemma spoke_R v u : spoke (at_ S) v u = to_point (zspoke v u).
Proof.
  unfold spoke, sub, to_point, zspoke. cbn [fst snd at_ sheet_of]. unfold at_R. cbn [fst snd].
  now rewrite !minus_IZR.
Qed.

Definition heights := nat -> Q.
Definition real_heights (h : heights) : vec := fun u => Q2R (h u).

Definition qK2 (v : nat) (g h : heights) : Q :=
  qsum (steps (nth v (fans_of d) [])) (fun s =>
    qwedge2 (zspoke v (fst s)) (zspoke v (snd s))
      (g (fst s) - g v) (g (snd s) - g v) (h (fst s) - h v) (h (snd s) - h v)).

Lemma qK2_R v g h : In v (inside d ++ border d) ->
  Q2R (qK2 v g h) = K2 S v (real_heights g) (real_heights h).
Proof.
  intros Hv. unfold qK2, K2. rewrite qsum_R. apply sum_ext. intros [a b] Hs. cbn [fst snd].
  pose proof (step_left S v a b Hv Hs) as C. rewrite !spoke_R in *.
  rewrite qwedge2_R by lra. now rewrite !Q2R_minus.
Qed.

(** R^2 - |U_v - c|^2 *)
Definition qmultiplier (c : Q * Q) (R2 : Q) (v : nat) : Q :=
  let x := (inject_Z (fst (place d v)) - fst c)%Q in
  let y := (inject_Z (snd (place d v)) - snd c)%Q in Qred (R2 - (x * x + y * y)).

Lemma qmultiplier_R c R2 v :
  Q2R (qmultiplier c R2 v) = multiplier S (to_plane c) (Q2R R2) v.
Proof.
  unfold qmultiplier, multiplier, dot, sub, to_plane. cbn [fst snd at_ sheet_of]. unfold at_R. cbn [fst snd].
  now rewrite Q2R_red, Q2R_minus, Q2R_plus, !Q2R_mult, !Q2R_minus, !Q2R_Z.
Qed.

End Rational.
