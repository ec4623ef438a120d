(** The chart of a file of all branches with a reflex corner [r]: heights at which a functional is 1. It names
    the side on which [r] pops up if the functional is a positive multiple of K_r(t, .), and [t] is on this side. *)
From Coq Require Import Reals ZArith List Lra Lia Arith Bool FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Nappes Sheet Star Theorems Notch Drawing Tables Rational Certificate
  Integers Verify.
Import ListNotations.
Open Scope R_scope.

(** Heights with positive curvature at a vertex are on the same side there if and only if K_v(t, h) is positive. *)
Lemma same_side S v t h : In v (inner S) -> 0 < K S v t -> 0 < K2 S v (cone S v) t ->
  0 < K S v h -> 0 < K2 S v (cone S v) h -> 0 < K2 S v t h.
Proof.
  intros Hi Pt Tc Ph Hc. assert (Hv : In v (inner S ++ rim S)) by (apply in_or_app; now left).
  destruct (Rlt_le_dec 0 (K2 S v t h)) as [|N]; [assumption|exfalso].
  pose proof (cone_positive S v Hi) as Pc.
  set (a := K2 S v (cone S v) h) in *. set (b := - K2 S v t h).
  set (g := move (move zero b (cone S v)) a t).
  assert (Z : forall x, K2 S v x zero = 0) by (intros x; apply (linear_zero (K2 S v x)); intros y s z; apply K2_move).
  assert (O : K2 S v g h = 0).
  { unfold g. rewrite K2_sym, !K2_move, Z, (K2_sym S v h t), (K2_sym S v h (cone S v)). unfold a, b. ring. }
  assert (Pg : 0 < K S v g).
  { unfold g. rewrite !K_move by assumption. rewrite <- (K_polar_sheet S v zero), Z by assumption.
    rewrite (K2_sym S v zero (cone S v)), Z, (K2_sym S v (move zero b (cone S v)) t), K2_move, Z.
    assert (0 <= b) by (unfold b; lra). rewrite (K2_sym S v t (cone S v)).
    assert (0 <= b * b * K S v (cone S v)) by (apply Rmult_le_pos; [now apply Rmult_le_pos|lra]).
    assert (0 < a * a * K S v t) by (apply Rmult_lt_0_compat; [now apply Rmult_lt_0_compat|assumption]).
    assert (0 <= a * b * K2 S v (cone S v) t) by (apply Rmult_le_pos; [apply Rmult_le_pos|]; lra). lra. }
  pose proof (L S v g h Hi Pg O). lra.
Qed.

Section Charts.
Variable d : drawing.
Variable p : prepared.
Variable r : nat.

(** Twice [scale] times K(t, .), at height 1 of [u] and 0 of the others. *)
Definition weight (b : hub) (t : zheights) (u : nat) : Z :=
  let k h := fst (measured h (h (at_vertex b)) (wedges b)) in
  let one v := if Nat.eqb v u then 1%Z else 0%Z in
  (k (fun v => t v + one v) - k t - k one)%Z.

(** [times] the functional with the weights [w] is such a form, of heights [t] that pop up at [r]. *)
Definition names_side (w t : zheights) (times : Z) : bool :=
  (0 <? times)%Z && existsb (fun b => Nat.eqb (at_vertex b) r &&
    (let (k, s) := measured t (t r) (wedges b) in (0 <? k)%Z && (0 <? s)%Z) &&
    forallb (fun u => weight b t u =? times * w u)%Z (inside d)) (hubs p).

(** Then it is positive on every branch on the side on which [r] pops up. *)
Theorem chart_verified w t times (ok : check d = true) : sound d p = true -> names_side w t times = true ->
  forall h, raised (sheet_of d ok) r h -> 0 < sum (inside d) (fun u => IZR (w u) * h u).
Proof.
  unfold sound, names_side. cbv zeta. rewrite !andb_true_iff. intros (_ & Ok) (Pm & Ex).
  set (S := sheet_of d ok). intros h (Rim & Sol & Up).
  apply Z.ltb_lt, IZR_lt in Pm.
  apply existsb_exists in Ex. destruct Ex as (b & Hb & Ex). rewrite !andb_true_iff, forallb_forall, Nat.eqb_eq in Ex.
  destruct Ex as ((Er & Side) & Ws).
  set (places := look (places d) (0, 0)%Z) in Ok. set (fans := look (fans_table d) []) in Ok.
  assert (At : places = place d) by exact (table_nth _ _).
  assert (Fan : fans = fun v => nth v (fans_of d) []) by exact (table_nth _ _).
  pose proof (fun x => hub_R d p _ _ _ _ ok At Fan b (fun _ => true) x Ok Hb) as M. cbv zeta in M.
  destruct (hub_means _ _ _ _ _ _ b Ok Hb) as (Hi & H). rewrite Er in *.
  unfold hub_ok in H. rewrite !andb_true_iff in H. destruct H as ((((((Ps & _) & _) & _) & _) & _) & _).
  apply Z.ltb_lt, IZR_lt in Ps. change (In r (inner S)) in Hi.
  assert (Hv : In r (inner S ++ rim S)) by (apply in_or_app; now left).
  assert (Kz : forall x, IZR (fst (measured x (x r) (wedges b))) = IZR (scale b) * K S r (reals x)).
  { intros x. specialize (M x). destruct (measured x (x r) (wedges b)) as (k, s). now destruct M. }
  assert (Kt : 0 < K S r (reals t) /\ 0 < K2 S r (cone S r) (reals t)).
  { specialize (M t). destruct (measured t (t r) (wedges b)) as (k, s). destruct M as (_ & M).
    rewrite andb_true_iff, !Z.ltb_lt in Side. destruct Side as (Pk & Psd). destruct (M Pk Psd) as (P & Q).
    split; [exact P|]. simpl in Q. change (sheet_of d ok) with S in Q. lra. }
  assert (We : forall u, In u (inside d) -> 2 * IZR (scale b) * K2 S r (reals t) (unit u) = IZR times * IZR (w u)).
  { intros u Hu. specialize (Ws u Hu). apply Z.eqb_eq, (f_equal IZR) in Ws. rewrite mult_IZR in Ws. rewrite <- Ws.
    unfold weight. rewrite Er, !minus_IZR, !Kz.
    replace (reals (fun v => if Nat.eqb v u then 1%Z else 0%Z)) with (unit u).
    2: { apply functional_extensionality. intros v. unfold reals, unit, upd, zero.
      destruct (Nat.eq_dec v u) as [->|N]; [now rewrite Nat.eqb_refl|]. apply Nat.eqb_neq in N. now rewrite N. }
    replace (reals (fun v => (t v + if Nat.eqb v u then 1 else 0)%Z)) with (move (reals t) 1 (unit u)).
    2: { apply functional_extensionality. intros v. unfold reals, unit, upd, zero, move. rewrite plus_IZR.
      destruct (Nat.eq_dec v u) as [->|N]; [rewrite Nat.eqb_refl; ring|]. apply Nat.eqb_neq in N. rewrite N. ring. }
    rewrite K_move by assumption. ring. }
  assert (Ph : 0 < K S r h) by (rewrite (Sol r Hi), one_at_r; lra).
  pose proof (same_side S r (reals t) h Hi (proj1 Kt) (proj2 Kt) Ph) as Pos.
  specialize (Pos Up).
  rewrite (linear_coordinates (K2 S r (reals t)) (inside d) h) in Pos.
  - apply (Rmult_lt_reg_l (IZR times)); [assumption|]. rewrite Rmult_0_r, <- sum_scal.
    rewrite (sum_ext _ _ (fun u => 2 * IZR (scale b) * (K2 S r (reals t) (unit u) * h u))).
    + rewrite sum_scal. apply Rmult_lt_0_compat; [lra|exact Pos].
    + intros u Hu. rewrite <- Rmult_assoc, <- We by assumption. ring.
  - intros x y z. apply K2_move.
  - exact (inner_once S).
  - exact Rim.
Qed.
End Charts.
