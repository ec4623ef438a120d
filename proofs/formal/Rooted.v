(** Heights that are polynomials of a root of a polynomial: their curvatures are 0 if the polynomial divides them. *)
From Coq Require Import Reals ZArith List Lra Lia Arith Bool FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Nappes Sheet Identities Star KeyLemma Flat Theorems Branches
  Drawing Tables Rational Certificate Integers Verify Exact Space.
Import ListNotations.
Open Scope R_scope.

(** ** Polynomials, from the constant term up *)

Fixpoint peval (l : list Z) (t : R) : R := match l with [] => 0 | c :: l => IZR c + t * peval l t end.
Fixpoint padd (l l' : list Z) : list Z :=
  match l, l' with
  | [], _ => l'
  | _, [] => l
  | a :: l, b :: l' => (a + b)%Z :: padd l l'
  end.
Definition pscale (c : Z) (l : list Z) : list Z := map (Z.mul c) l.
Fixpoint pmul (l l' : list Z) : list Z := match l with [] => [] | a :: l => padd (pscale a l') (0%Z :: pmul l l') end.

Lemma padd_eval l t : forall l', peval (padd l l') t = peval l t + peval l' t.
Proof.
  induction l as [|a l IH]; intros [|b l']; cbn [padd peval]; try ring. rewrite IH, plus_IZR. ring.
Qed.

Lemma pscale_eval c l t : peval (pscale c l) t = IZR c * peval l t.
Proof. induction l as [|a l IH]; cbn [pscale map peval]; [ring|]. unfold pscale in IH. rewrite IH, mult_IZR. ring. Qed.

Lemma pmul_eval l l' t : peval (pmul l l') t = peval l t * peval l' t.
Proof. induction l as [|a l IH]; cbn [pmul peval]; [ring|]. rewrite padd_eval, pscale_eval. cbn [peval]. rewrite IH.
ring. Qed.

Lemma vanishing l t : forallb (fun c => c =? 0)%Z l = true -> peval l t = 0.
Proof.
  induction l as [|a l IH]; [reflexivity|]. cbn [forallb peval]. rewrite andb_true_iff, Z.eqb_eq. intros (-> & H).
  rewrite (IH H). ring.
Qed.

Lemma peval_continuous l : continuity (peval l).
Proof.
  induction l as [|c l IH]; intros t.
  - apply continuity_pt_const. now intros x y.
  - apply (continuity_pt_plus (fun _ => IZR c) (fun t => t * peval l t)).
    + apply continuity_pt_const. now intros x y.
    + apply (continuity_pt_mult (fun t => t) (peval l)); [apply derivable_continuous_pt, derivable_pt_id|apply IH].
Qed.

(** The value at [a] / [q], times a power of [q]. *)
Fixpoint pvalue (l : list Z) (a q : Z) : Z :=
  match l with [] => 0 | c :: l => c * q ^ Z.of_nat (length l) + a * pvalue l a q end%Z.

Lemma pvalue_R l a q : 0 < IZR q -> IZR (pvalue l a q) * IZR q = IZR q ^ length l * peval l (IZR a / IZR q).
Proof.
  intros Pq. induction l as [|c l IH]; cbn [pvalue peval length pow]; [ring|].
  rewrite plus_IZR, !mult_IZR, <- pow_IZR.
  replace ((IZR c * IZR q ^ length l + IZR a * IZR (pvalue l a q)) * IZR q) with
    (IZR c * IZR q ^ length l * IZR q + IZR a * (IZR (pvalue l a q) * IZR q)) by ring.
  rewrite IH. field. lra.
Qed.

Lemma root_between l a b q : (0 < q)%Z -> (a <= b)%Z -> (pvalue l a q * pvalue l b q <= 0)%Z ->
  exists t, IZR a / IZR q <= t <= IZR b / IZR q /\ peval l t = 0.
Proof.
  intros Pq Le Signs. apply IZR_lt in Pq. apply IZR_le in Le, Signs. rewrite mult_IZR in Signs.
  destruct (IVT_cor (peval l) (IZR a / IZR q) (IZR b / IZR q) (peval_continuous l)) as (t & Ht & Z).
  - unfold Rdiv. apply Rmult_le_compat_r; [apply Rlt_le; now apply Rinv_0_lt_compat|assumption].
  - pose proof (pvalue_R l a q Pq) as Ea. pose proof (pvalue_R l b q Pq) as Eb.
    assert (Pw : 0 < IZR q ^ length l) by now apply pow_lt.
    destruct (Rle_lt_dec (peval l (IZR a / IZR q) * peval l (IZR b / IZR q)) 0) as [|P]; [assumption|exfalso].
    assert (0 < IZR q ^ length l * peval l (IZR a / IZR q) * (IZR q ^ length l * peval l (IZR b / IZR q))).
    { replace (_ * _) with (IZR q ^ length l * IZR q ^ length l *
        (peval l (IZR a / IZR q) * peval l (IZR b / IZR q))) by ring.
      apply Rmult_lt_0_compat; [now apply Rmult_lt_0_compat|assumption]. }
    rewrite <- Ea, <- Eb in H.
    replace (_ * _) with (IZR (pvalue l a q) * IZR (pvalue l b q) * (IZR q * IZR q)) in H by ring.
    assert (0 < IZR q * IZR q) by now apply Rmult_lt_0_compat. nra.
  - now exists t.
Qed.

Lemma powers_close M s t n : Rabs s <= M -> Rabs t <= M -> Rabs (t ^ S n - s ^ S n) <= Rabs (t - s) * INR (S n) * M ^ n.
Proof.
  intros Hs Ht. assert (PM : 0 <= M) by (eapply Rle_trans; [apply Rabs_pos|exact Hs]).
  induction n as [|n IH]; [simpl; rewrite !Rmult_1_r; apply Rle_refl|].
  replace (t ^ S (S n) - s ^ S (S n)) with (t * (t ^ S n - s ^ S n) + (t - s) * s ^ S n) by (simpl; ring).
  eapply Rle_trans; [apply Rabs_triang|]. rewrite !Rabs_mult, <- RPow_abs.
  replace (Rabs (t - s) * INR (S (S n)) * M ^ S n) with
    (M * (Rabs (t - s) * INR (S n) * M ^ n) + Rabs (t - s) * M ^ S n) by (rewrite (S_INR (S n)); simpl; ring).
  apply Rplus_le_compat.
  - apply Rmult_le_compat; try apply Rabs_pos; assumption.
  - apply Rmult_le_compat_l; [apply Rabs_pos|]. apply pow_incr. split; [apply Rabs_pos|assumption].
Qed.

(** ** Heights that are polynomials *)

Section Rooted.
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

(** The unknowns are the powers of the root, times [unit]: [half] is more than they change on its interval. *)
Definition unit_ : Z := (below sp ^ Z.of_nat (length unknowns))%Z.
Definition powers : list zheights := start d b4 top sp :: map (fun k u => unit_ * along k u)%Z unknowns.

Fixpoint paired (b : hub) (gs hs : list zheights) : list Z :=
  match gs with [] => [] | g :: gs => padd (map (polar b g) hs) (0%Z :: paired b gs hs) end.
Definition divides (b : hub) : bool := forallb (fun c => c =? 0)%Z
  (padd (paired b powers powers) (pscale (-1) (pmul (polynomial sp) (quotient sp (at_vertex b))))).

Fixpoint near_powers (j : nat) (l : list nat) : bool :=
  match l with
  | [] => true
  | k :: l =>
    let rest := (below sp ^ Z.of_nat (length l))%Z in
    (centre sp k =? low sp ^ Z.of_nat (S j) * rest)%Z &&
    let most := Z.max (Z.abs (low sp)) (Z.abs (high sp)) in
    ((high sp - low sp) * Z.of_nat (S j) * most ^ Z.of_nat j * rest <=? half sp)%Z &&
    near_powers (S j) l
  end.

Definition rooted : bool :=
  (0 <? below sp)%Z && (low sp <=? high sp)%Z &&
  (pvalue (polynomial sp) (low sp) (below sp) * pvalue (polynomial sp) (high sp) (below sp) <=? 0)%Z &&
  near_powers 0 unknowns && forallb (fun b => flat_or_kept signs kept b || divides b) (hubs p).

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


Fixpoint pvector (hs : list zheights) (t : R) : vec :=
  match hs with [] => zero | h :: hs => move (reals h) t (pvector hs t) end.

Lemma K2_zero v x : K2 S v x zero = 0.
Proof. apply (linear_zero (K2 S v x)). intros a s c. apply K2_move. Qed.

Lemma paired_R b t gs hs : In b (hubs p) ->
  peval (paired b gs hs) t = 2 * IZR (scale b) * K2 S (at_vertex b) (pvector gs t) (pvector hs t).
Proof.
  intros Hb. induction gs as [|g gs IH]; cbn [paired pvector peval].
  - rewrite K2_sym, K2_zero. ring.
  - rewrite padd_eval. cbn [peval]. rewrite IH, (K2_sym S _ (move _ _ _)), K2_move.
    replace (peval (map (polar b g) hs) t) with (2 * IZR (scale b) * K2 S (at_vertex b) (reals g) (pvector hs t)).
    + rewrite (K2_sym S _ (pvector hs t) (reals g)), (K2_sym S _ (pvector hs t) (pvector gs t)). ring.
    + clear IH. induction hs as [|h hs IH]; cbn [map peval pvector]; [rewrite K2_zero; ring|].
      rewrite <- IH, polar_R, K2_move by assumption. ring.
Qed.

(** The place of an unknown, and the powers. *)
Fixpoint place_of (k : nat) (l : list nat) : nat :=
  match l with [] => 0 | a :: l => if Nat.eq_dec a k then 0 else Datatypes.S (place_of k l) end.

Definition x_of (t : R) : vec := fun k =>
  if Nat.eq_dec k b4 then 1 else if in_dec Nat.eq_dec k U then IZR unit_ * t ^ Datatypes.S (place_of k U) else 0.

Lemma x_at t k : In k U -> x_of t k = IZR unit_ * t ^ Datatypes.S (place_of k U).
Proof.
  intros Hk. unfold x_of. destruct (Nat.eq_dec k b4) as [->|]; [now destruct (b4_unknown b4 Hk)|].
  now destruct in_dec.
Qed.

Lemma x_at_b4 t : x_of t b4 = 1.
Proof. unfold x_of. now destruct Nat.eq_dec. Qed.

Lemma sum_powers t (f : nat -> R) l : NoDup l ->
  sum l (fun k => t ^ place_of k l * f k) = fold_right (fun k s => f k + t * s) 0 l.
Proof.
  induction l as [|a l IH]; [reflexivity|]. intros D. inversion D as [|? ? N D']; subst. cbn [sum fold_right].
  rewrite <- (IH D'), <- sum_scal. f_equal.
  - cbn [place_of]. destruct Nat.eq_dec; [simpl; ring|contradiction].
  - apply sum_ext. intros k Hk. cbn [place_of]. destruct (Nat.eq_dec a k) as [->|]; [contradiction|simpl; ring].
Qed.

Lemma lifted_powers t : lifted (x_of t) = pvector powers t.
Proof.
  apply functional_extensionality. intros u. unfold powers. cbn [pvector]. unfold Space.lifted, move. rewrite x_at_b4.
  rewrite (sum_ext U _ (fun k => t * (t ^ place_of k U * (IZR unit_ * reals (along k) u)))).
  2: { intros k Hk. rewrite x_at by assumption. simpl. ring. }
  rewrite sum_scal, (sum_powers t _ U unknowns_once), Rmult_1_l. f_equal. f_equal.
  induction U as [|k l IH]; [reflexivity|]. cbn [fold_right map pvector]. unfold move at 1. rewrite IH.
  unfold reals. rewrite mult_IZR. reflexivity.
Qed.

Lemma near_means t l : 0 < IZR (below sp) -> IZR (low sp) / IZR (below sp) <= t <= IZR (high sp) / IZR (below sp) ->
  forall j, near_powers j l = true -> NoDup l -> forall k, In k l ->
  Rabs (IZR (below sp) ^ (j + length l) * t ^ Datatypes.S (j + place_of k l) - IZR (centre sp k)) <= IZR (half sp).
Proof.
  intros Pq (Lo & Hi). set (q := IZR (below sp)) in *.
  set (M := Z.max (Z.abs (low sp)) (Z.abs (high sp))).
  induction l as [|a l IH]; [easy|]. intros j. cbn [near_powers]. cbv zeta. rewrite !andb_true_iff, Z.eqb_eq, Z.leb_le.
  intros (Ce & Ha & Rest) D k Hk. inversion D as [|? ? N D']; subst. cbn [place_of length].
  destruct (Nat.eq_dec a k) as [->|Na].
  - clear IH Rest. rewrite Nat.add_0_r. apply (f_equal IZR) in Ce. apply IZR_le in Ha.
    repeat rewrite mult_IZR in Ce. repeat rewrite mult_IZR in Ha. repeat rewrite <- pow_IZR in Ce.
    repeat rewrite <- pow_IZR in Ha.
    rewrite minus_IZR, <- INR_IZR_INZ in Ha.
    fold q in Ce, Ha. fold M in Ha. set (s := IZR (low sp) / q) in *. set (n := length l) in *.
    assert (Ls : IZR (low sp) = q * s) by (unfold s; field; lra).
    assert (Bound : forall y, s <= y <= IZR (high sp) / q -> Rabs y <= IZR M / q).
    { intros y (Y1 & Y2). apply Rabs_le.
      assert (X : forall z, (Z.abs z <= M)%Z -> - (IZR M / q) <= IZR z / q <= IZR M / q).
      { intros z Hz. apply Z.abs_le in Hz. destruct Hz as (Z1 & Z2). apply IZR_le in Z1, Z2. rewrite opp_IZR in Z1.
        unfold Rdiv.
        assert (0 < / q) by now apply Rinv_0_lt_compat. split; [|apply Rmult_le_compat_r; lra].
        replace (- (IZR M * / q)) with (- IZR M * / q) by ring. apply Rmult_le_compat_r; lra. }
      pose proof (X (low sp) ltac:(unfold M; lia)) as Xl. pose proof (X (high sp) ltac:(unfold M; lia)). fold s in Xl.
      lra. }
    pose proof (powers_close (IZR M / q) s t j (Bound s ltac:(lra)) (Bound t ltac:(lra))) as C.
    rewrite Ce, Ls. replace (q ^ (j + Datatypes.S n)) with (q ^ n * q ^ Datatypes.S j)
      by (rewrite <- pow_add; f_equal; lia).
    rewrite Rpow_mult_distr.
    replace (q ^ n * q ^ Datatypes.S j * t ^ Datatypes.S j - q ^ Datatypes.S j * s ^ Datatypes.S j * q ^ n) with
      (q ^ n * q ^ Datatypes.S j * (t ^ Datatypes.S j - s ^ Datatypes.S j)) by ring.
    assert (Pn : 0 < q ^ n) by now apply pow_lt. assert (Pj : 0 < q ^ Datatypes.S j) by now apply pow_lt.
    rewrite !Rabs_mult, (Rabs_right (q ^ n)), (Rabs_right (q ^ Datatypes.S j)) by lra.
    eapply Rle_trans; [apply Rmult_le_compat_l; [apply Rlt_le; now apply Rmult_lt_0_compat|exact C]|].
    eapply Rle_trans; [|exact Ha]. rewrite (Rabs_right (t - s)) by lra.
    replace ((IZR M / q) ^ j) with (IZR M ^ j / q ^ j) by (unfold Rdiv; now rewrite Rpow_mult_distr, pow_inv).
    replace (q ^ n * q ^ Datatypes.S j * ((t - s) * INR (Datatypes.S j) * (IZR M ^ j / q ^ j))) with
      ((t * q - s * q) * (INR (Datatypes.S j) * IZR M ^ j * q ^ n)) by (simpl; field; apply pow_nonzero; lra).
    replace ((IZR (high sp) - IZR (low sp)) * INR (Datatypes.S j) * IZR M ^ j * q ^ n) with
      ((IZR (high sp) - IZR (low sp)) * (INR (Datatypes.S j) * IZR M ^ j * q ^ n)) by ring.
    apply Rmult_le_compat_r.
    + repeat apply Rmult_le_pos; try apply pos_INR; [|lra]. apply pow_le. apply IZR_le. unfold M. lia.
    + assert (t * q <= IZR (high sp)); [|rewrite Ls; lra].
      apply (Rmult_le_compat_r q) in Hi; [|lra].
      replace (IZR (high sp) / q * q) with (IZR (high sp)) in Hi by (field; lra).
      exact Hi.
  - destruct Hk as [->|Hk]; [contradiction|]. specialize (IH (Datatypes.S j) Rest D' k Hk).
    replace (j + Datatypes.S (length l))%nat with (Datatypes.S j + length l)%nat by lia.
    replace (j + Datatypes.S (place_of k l))%nat with (Datatypes.S j + place_of k l)%nat by lia. exact IH.
Qed.

Lemma rooted_solution : rooted = true -> exists x, solution d p b4 top sp ok signs kept x.
Proof.
  unfold rooted. rewrite !andb_true_iff, forallb_forall. intros ((((Pq & Le) & Sg) & Near) & Hubs).
  apply Z.ltb_lt in Pq. apply Z.leb_le in Le, Sg. destruct (root_between _ _ _ _ Pq Le Sg) as (t & Ht & Root).
  apply IZR_lt in Pq. exists (x_of t). split; [apply x_at_b4|]. split; [|split].
  - intros k N. unfold x_of. destruct (Nat.eq_dec k b4) as [->|]; [now destruct N; left|].
    destruct in_dec; [now destruct N; right|reflexivity].
  - intros k Hk. rewrite x_at by assumption. pose proof (near_means t U Pq Ht 0 Near unknowns_once k Hk) as C.
    unfold unit_. rewrite <- pow_IZR. cbn [plus] in C. unfold Space.m. destruct (Nat.eq_dec k b4) as [->|].
    + now destruct (b4_unknown b4 Hk).
    + destruct in_dec; [exact C|contradiction].
  - intros b Hb N. specialize (Hubs b Hb). rewrite N, orb_false_l in Hubs. unfold divides in Hubs.
    apply (fun H => vanishing _ t H) in Hubs. rewrite padd_eval, pscale_eval, pmul_eval, Root in Hubs.
    rewrite (paired_R b t powers powers Hb), <- lifted_powers in Hubs.
    destruct (hub_forms d p ok sound_p b Hb) as (_ & Ps & _).
    assert (E : 2 * IZR (scale b) * K2 S (at_vertex b) (lifted (x_of t)) (lifted (x_of t)) = 0) by lra.
    apply Rmult_integral in E. destruct E; [lra|assumption].
Qed.
End Rooted.
