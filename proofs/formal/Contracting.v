(** A solution in a linear space of heights, by Krawczyk's test in integers: the curvatures are combinations of as many
    as there are unknowns. *)
From Coq Require Import Reals ZArith List Lra Lia Arith Bool FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Nappes Sheet Identities Star KeyLemma Flat Theorems Branches Krawczyk
  Drawing Tables Rational Certificate Integers Verify Exact Space.
Import ListNotations.
Open Scope R_scope.

Section Contracting.
Variable d : drawing.
Variable p : prepared.
Variable b4 : nat.
Variable top : Z.
Variable sp : space.
Variable signs : nat -> option bool.
Variable kept : nat -> bool.
Notation parts := (parts p sp).
Notation unknowns := (unknowns p sp).
Notation along := (along d b4 sp).
Notation middle := (middle d p b4 top sp).
Notation spanning := (spanning d p b4 top sp).

(** Krawczyk's test. *)
Definition row_small (i : nat) : bool :=
  (Z.abs (zsum parts (fun b => inverse sp i (at_vertex b) * curved b middle)) <=? bound0 sp)%Z &&
  (zsum unknowns (fun j => Z.abs ((if Nat.eqb i j then over sp else 0) -
    zsum parts (fun b => inverse sp i (at_vertex b) * polar b middle (along j)))) <=? bound1 sp)%Z &&
  (zsum unknowns (fun j => zsum unknowns (fun k => Z.abs (
    zsum parts (fun b => inverse sp i (at_vertex b) * polar b (along j) (along k))))) <=? bound2 sp)%Z.
Definition contracts : bool :=
  let c := (bound1 sp + half sp * bound2 sp)%Z in
  (0 <=? half sp)%Z && (0 <? over sp)%Z && (c <? over sp)%Z && (bound0 sp + c * half sp <=? half sp * over sp)%Z &&
  forallb row_small unknowns.

Definition combined (b : hub) : bool :=
  let (times, weights) := combination sp (at_vertex b) in
  negb (times =? 0)%Z && forallb (fun g => forallb (fun h =>
    times * polar b g h =? zsum parts (fun c => weights (at_vertex c) * polar c g h))%Z spanning) spanning.

Definition contracted : bool :=
  contracts && forallb (fun b => flat_or_kept signs kept b || chosen sp (at_vertex b) || combined b) (hubs p).

(** ** What it means *)

Variable ok : check d = true.
Hypothesis sound_p : sound d p = true.
Hypothesis Off : ~ In b4 (inside d).
Notation S := (sheet_of d ok).
Notation U := unknowns.
Notation lifted := (lifted d p b4 top sp).
Notation m := (m p b4 sp).
Notation unknowns_once := (unknowns_once d p sp ok sound_p).
Notation b4_unknown := (b4_unknown d p b4 sp sound_p Off).
Notation lifted_middle := (lifted_middle d p b4 top sp sound_p Off).
Notation lifted_column := (lifted_column d p b4 top sp ok sound_p Off).
Notation polar_R := (polar_R d p ok sound_p).
Notation curved_R := (curved_R d p ok sound_p).

(** ** The solution *)

Definition form (v : nat) (a b : vec) : R := K2 S v (lifted a) (lifted b).
Definition scale_at (v : nat) : R :=
  match find (fun b => Nat.eqb (at_vertex b) v) parts with Some b => IZR (scale b) | None => 0 end.
Definition Y (i v : nat) : R := IZR (inverse sp i v) * scale_at v / IZR (over sp).

Lemma scale_at_part b : In b parts -> scale_at (at_vertex b) = IZR (scale b).
Proof.
  unfold scale_at. pose proof unknowns_once as D. unfold unknowns in D. induction parts as [|c l IH]; [easy|].
  cbn [map] in D. inversion D as [|? ? N D']; subst. intros [->|Hb]; cbn [find].
  - now rewrite Nat.eqb_refl.
  - destruct (Nat.eqb_spec (at_vertex c) (at_vertex b)) as [E|_]; [|now apply IH].
    destruct N. rewrite E. now apply in_map.
Qed.

Lemma form_sum i c x y : sum U (fun v => Y i v * (c * form v x y)) =
  / IZR (over sp) * sum parts (fun b =>
    IZR (inverse sp i (at_vertex b)) * (c * (IZR (scale b) * form (at_vertex b) x y))).
Proof.
  unfold unknowns. rewrite sum_map, <- sum_scal. apply sum_ext. intros b Hb. unfold Y.
  rewrite scale_at_part by assumption. unfold Rdiv. ring.
Qed.

Lemma polar_sum i (g h : zheights) x y : lifted x = reals g -> lifted y = reals h ->
  sum U (fun v => Y i v * (2 * form v x y)) =
  / IZR (over sp) * IZR (zsum parts (fun b => inverse sp i (at_vertex b) * polar b g h)%Z).
Proof.
  intros Ex Ey. rewrite form_sum, zsum_R. f_equal. apply sum_ext. intros b Hb.
  rewrite mult_IZR, polar_R by now apply (parts_in p sp). unfold form. rewrite Ex, Ey. ring.
Qed.

Lemma form_sym v a b : form v a b = form v b a.
Proof. apply K2_sym. Qed.

Lemma form_move v a b s c : form v a (move b s c) = form v a b + s * form v a c.
Proof. unfold form. rewrite lifted_move. apply K2_move. Qed.

Lemma contracts_solution : contracts = true -> exists x, x b4 = 1 /\ zero_off (b4 :: U) x /\
  (forall k, In k U -> Rabs (x k - m k) <= IZR (half sp)) /\ forall k, In k U -> K2 S k (lifted x) (lifted x) = 0.
Proof.
  unfold contracts. cbv zeta. rewrite !andb_true_iff, forallb_forall. intros ((((Ph & Po) & C) & Fit) & Rows).
  apply Z.leb_le, IZR_le in Ph, Fit. apply Z.ltb_lt, IZR_lt in Po, C.
  rewrite plus_IZR, mult_IZR in C. rewrite plus_IZR, !mult_IZR, plus_IZR, mult_IZR in Fit.
  set (o := IZR (over sp)) in *. assert (Pi : 0 < / o) by now apply Rinv_0_lt_compat.
  assert (Abs : forall z, Rabs (/ o * IZR z) = / o * IZR (Z.abs z)).
  { intros z. rewrite Rabs_mult, (Rabs_right (/ o)), Rabs_Zabs by lra. reflexivity. }
  assert (Low : forall a b, (a <=? b)%Z = true -> / o * IZR a <= IZR b / o).
  { intros a b H. unfold Rdiv. rewrite (Rmult_comm (IZR b)). apply Rmult_le_compat_l; [lra|].
    now apply IZR_le, Z.leb_le. }
  destruct (krawczyk U form (fun _ => 0) unknowns_once form_sym form_move m (IZR (half sp)) Y
    (IZR (bound0 sp) / o) (IZR (bound1 sp) / o) (IZR (bound2 sp) / o)) as (x & ((Off_x & Box) & Sol) & _).
  - exact Ph.
  - intros i Hi. specialize (Rows i Hi). unfold row_small in Rows. rewrite !andb_true_iff in Rows.
    destruct Rows as ((R & _) & _).
    unfold residual. rewrite (sum_ext U _ (fun v => Y i v * (1 * form v m m))) by (intros; ring). rewrite form_sum.
    fold o.
    rewrite (sum_ext parts _ (fun b => IZR (inverse sp i (at_vertex b) * curved b middle))).
    + rewrite <- zsum_R, Abs. now apply Low.
    + intros b Hb. rewrite mult_IZR, curved_R by now apply (parts_in p sp). unfold form. rewrite lifted_middle. ring.
  - intros i Hi. specialize (Rows i Hi). unfold row_small in Rows. rewrite !andb_true_iff in Rows.
    destruct Rows as ((_ & R) & _).
    eapply Rle_trans; [|apply Low; exact R]. rewrite zsum_R, <- sum_scal. right. apply sum_ext. intros j Hj.
    unfold entry. rewrite (polar_sum i middle (along j)) by (apply lifted_middle || now apply lifted_column). fold o.
    rewrite <- Abs, minus_IZR. f_equal. unfold delta.
    destruct (Nat.eq_dec i j) as [->|N].
    + rewrite Nat.eqb_refl. fold o. field. lra.
    + apply Nat.eqb_neq in N. rewrite N. ring.
  - intros i Hi. specialize (Rows i Hi). unfold row_small in Rows. rewrite !andb_true_iff in Rows.
    destruct Rows as (_ & R).
    eapply Rle_trans; [|apply Low; exact R]. rewrite zsum_R, <- sum_scal. right. apply sum_ext. intros j Hj.
    rewrite zsum_R, <- sum_scal. apply sum_ext. intros k Hk. unfold second.
    rewrite (polar_sum i (along j) (along k)) by now apply lifted_column. fold o. apply Abs.
  - apply (Rmult_lt_reg_r o); [assumption|].
    replace ((_ + _) * o) with (IZR (bound1 sp) + IZR (half sp) * IZR (bound2 sp)) by (field; lra). lra.
  - apply (Rmult_le_reg_r o); [assumption|].
    replace ((_ + _) * o) with
      (IZR (bound0 sp) + (IZR (bound1 sp) + IZR (half sp) * IZR (bound2 sp)) * IZR (half sp)) by (field; lra).
    exact Fit.
  - exists x. split; [|split; [|split; [exact Box|exact Sol]]].
    + rewrite Off_x; [|intros H; now apply (b4_unknown b4 H)]. unfold m. now destruct Nat.eq_dec.
    + intros k N. rewrite Off_x by (intros H; apply N; now right). now apply m_zero.
Qed.

Lemma contracted_solution : contracted = true -> exists x, solution d p b4 top sp ok signs kept x.
Proof.
  unfold contracted. rewrite andb_true_iff, forallb_forall. intros (Con & Hubs).
  destruct (contracts_solution Con) as (x & X4 & Zx & Box & Sol). exists x.
  split; [exact X4|]. split; [exact Zx|]. split; [exact Box|]. intros b Hb N. specialize (Hubs b Hb). rewrite N in Hubs.
  destruct (hub_forms d p ok sound_p b Hb) as (Hi & Ps & _). rewrite orb_false_l, orb_true_iff in Hubs.
  destruct Hubs as [Ch|Co].
  - apply Sol. apply in_map. now apply filter_In.
  - unfold combined in Co. destruct (combination sp (at_vertex b)) as (times, weights).
    rewrite andb_true_iff, negb_true_iff, Z.eqb_neq, forallb_forall in Co. destruct Co as (Nt & Co).
    set (F := fun g h => IZR times * (2 * IZR (scale b) * K2 S (at_vertex b) g h) -
      sum parts (fun c => IZR (weights (at_vertex c)) * (2 * IZR (scale c) * K2 S (at_vertex c) g h))).
    assert (Z : F (lifted x) (lifted x) = 0).
    { apply (spanned_twice d p b4 top sp ok sound_p Off); [| | |exact Zx].
      - intros a g s h. unfold F. rewrite K2_move.
        rewrite (sum_ext parts _ (fun c =>
          IZR (weights (at_vertex c)) * (2 * IZR (scale c) * K2 S (at_vertex c) a g) +
          s * (IZR (weights (at_vertex c)) * (2 * IZR (scale c) * K2 S (at_vertex c) a h))))
          by (intros; rewrite K2_move; ring).
        rewrite sum_plus, sum_scal. ring.
      - intros g h. unfold F. rewrite K2_sym. f_equal. apply sum_ext. intros c _. now rewrite K2_sym.
      - intros g h Hg Hh. specialize (Co g Hg). rewrite forallb_forall in Co. specialize (Co h Hh).
        apply Z.eqb_eq, (f_equal IZR) in Co. rewrite mult_IZR, zsum_R, polar_R in Co by assumption. unfold F.
        rewrite Co.
        apply Rminus_diag_eq, sum_ext. intros c Hc. rewrite mult_IZR, polar_R by now apply (parts_in p sp).
        reflexivity. }
    unfold F in Z. rewrite sum_zero in Z.
    + rewrite Rminus_0_r in Z. apply Rmult_integral in Z. destruct Z as [Z|Z]; [now apply eq_IZR in Z|].
      apply Rmult_integral in Z. destruct Z; [lra|assumption].
    + intros c Hc. rewrite (Sol (at_vertex c)) by now apply in_map. ring.
Qed.
End Contracting.
