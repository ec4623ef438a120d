(** Linear spaces of heights, and what holds of all heights of a space that are near its middle. *)
From Coq Require Import Reals ZArith List Lra Lia Arith Bool FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Nappes Sheet Identities Star KeyLemma Flat Theorems Branches
  Drawing Tables Rational Certificate Integers Verify Exact.
Import ListNotations.
Open Scope R_scope.

(** The heights are [base] and, for each vertex that is [chosen], an unknown times its [column]. The unknowns are
    whole numbers, [centre], up to [half]. [inverse] is the matrix of the test, divided by [over]; the bounds are
    those of its three numbers, times [over]. A curvature times the first number of its [combination] is a
    combination of those that are chosen. Or else the unknowns are powers of a root (Rooted.v). *)
Record space := Space {
  chosen : nat -> bool;
  base : zheights;
  column : nat -> zheights;
  centre : nat -> Z; half : Z;
  inverse : nat -> nat -> Z; over : Z;
  bound0 : Z; bound1 : Z; bound2 : Z;
  combination : nat -> Z * (nat -> Z);
  polynomial : list Z; quotient : nat -> list Z; low : Z; high : Z; below : Z
}.

Definition zsum {A} (l : list A) (f : A -> Z) : Z := fold_right (fun a s => f a + s)%Z 0%Z l.

Lemma zsum_R {A} (l : list A) f : IZR (zsum l f) = sum l (fun a => IZR (f a)).
Proof.
  induction l as [|a l IH]; [reflexivity|]. cbn [zsum fold_right sum]. rewrite plus_IZR. unfold zsum in IH.
  now rewrite IH.
Qed.

Section Space.
Variable d : drawing.
Variable p : prepared.
Variable b4 : nat.
Variable top : Z.
Variable sp : space.

Definition parts : list hub := filter (fun b => chosen sp (at_vertex b)) (hubs p).
Definition unknowns : list nat := map at_vertex parts.
Definition start : zheights := with_rim d b4 top (base sp).
Definition along (k : nat) : zheights := with_rim d b4 0 (column sp k).
Definition middle : zheights := fun u => (start u + zsum unknowns (fun k => centre sp k * along k u))%Z.
Definition spanning : list zheights := start :: map along unknowns.

Definition curved (b : hub) (h : zheights) : Z := fst (measured h (h (at_vertex b)) (wedges b)).
Definition sided (b : hub) (h : zheights) : Z := snd (measured h (h (at_vertex b)) (wedges b)).
Definition polar (b : hub) (g h : zheights) : Z := (curved b (fun u => g u + h u) - curved b g - curved b h)%Z.

(** A functional is beyond what the unknowns may change. *)
Definition beyond (f : zheights -> Z) (up : bool) : bool :=
  let far := (half sp * zsum unknowns (fun k => Z.abs (f (along k))))%Z in
  (if up then far <? f middle else f middle <? - far)%Z.

(** ** What it means *)

Variable ok : check d = true.
Hypothesis sound_p : sound d p = true.
Notation S := (sheet_of d ok).
Notation U := unknowns.

Definition lifted (x : vec) : vec := fun u => x b4 * reals start u + sum U (fun k => x k * reals (along k) u).

Lemma lifted_move a s b : lifted (move a s b) = move (lifted a) s (lifted b).
Proof.
  apply functional_extensionality. intros u. unfold lifted, move.
  rewrite (sum_ext U _ (fun k => a k * reals (along k) u + s * (b k * reals (along k) u))) by (intros; ring).
  rewrite sum_plus, sum_scal. ring.
Qed.

Lemma inside_hubs : inside d = map at_vertex (hubs p).
Proof. now destruct (sound_means d p sound_p) as (_ & E & _). Qed.

Lemma parts_in b : In b parts -> In b (hubs p) /\ chosen sp (at_vertex b) = true.
Proof. intros H. now apply filter_In in H. Qed.

Lemma unknowns_once : NoDup U.
Proof.
  unfold unknowns, parts. apply NoDup_map_filter. rewrite <- inside_hubs. exact (inner_once S).
Qed.

Lemma unknowns_inside k : In k U -> In k (inside d).
Proof.
  intros H. apply in_map_iff in H. destruct H as (b & <- & H). apply parts_in in H. rewrite inside_hubs.
  now apply in_map.
Qed.

Hypothesis Off : ~ In b4 (inside d).

Lemma b4_unknown k : In k U -> k <> b4.
Proof. intros H ->. now apply Off, unknowns_inside. Qed.

Lemma lifted_base : lifted (unit b4) = reals start.
Proof.
  apply functional_extensionality. intros u. unfold lifted. unfold unit at 1. rewrite upd_same, sum_zero; [ring|].
  intros k Hk. unfold unit. rewrite upd_other by now apply b4_unknown. unfold zero. ring.
Qed.

Lemma lifted_column k : In k U -> lifted (unit k) = reals (along k).
Proof.
  intros Hk. apply functional_extensionality. intros u. unfold lifted.
  rewrite (sum_unit U k (fun j => reals (along j) u) unknowns_once Hk).
  unfold unit. rewrite upd_other by (apply not_eq_sym; now apply b4_unknown). unfold zero. ring.
Qed.

(** Where the unknowns are in the middle. *)
Definition m : vec := fun k => if Nat.eq_dec k b4 then 1 else if in_dec Nat.eq_dec k U then IZR (centre sp k) else 0.

Lemma m_zero : zero_off (b4 :: U) m.
Proof.
  intros k N. unfold m. destruct (Nat.eq_dec k b4) as [->|]; [now destruct N; left|].
  destruct in_dec as [H|]; [now destruct N; right|reflexivity].
Qed.

Lemma lifted_middle : lifted m = reals middle.
Proof.
  apply functional_extensionality. intros u. unfold lifted, reals, middle. rewrite plus_IZR, zsum_R. f_equal.
  - unfold m. destruct Nat.eq_dec; [ring|contradiction].
  - apply sum_ext. intros k Hk. rewrite mult_IZR. f_equal. unfold m.
    destruct (Nat.eq_dec k b4); [now apply b4_unknown in Hk|]. destruct in_dec; [reflexivity|contradiction].
Qed.

Lemma curved_R b h : In b (hubs p) -> IZR (curved b h) = IZR (scale b) * K2 S (at_vertex b) (reals h) (reals h).
Proof. intros Hb. destruct (hub_forms d p ok sound_p b Hb) as (_ & _ & _ & _ & M). now apply M. Qed.

Lemma reals_plus g h : reals (fun u => (g u + h u)%Z) = move (reals g) 1 (reals h).
Proof. apply functional_extensionality. intros u. unfold reals, move. rewrite plus_IZR. ring. Qed.

Lemma polar_R b g h : In b (hubs p) ->
  IZR (polar b g h) = 2 * IZR (scale b) * K2 S (at_vertex b) (reals g) (reals h).
Proof.
  intros Hb. unfold polar. rewrite !minus_IZR, !curved_R, reals_plus by assumption.
  rewrite K2_move, !(K2_sym S _ (move _ _ _)), !K2_move, (K2_sym S _ (reals h) (reals g)). ring.
Qed.

(** What vanishes where the space is spanned vanishes on the space. *)
Lemma spanned (F : vec -> R) : linear F -> (forall g, In g spanning -> F (reals g) = 0) ->
  forall x, zero_off (b4 :: U) x -> F (lifted x) = 0.
Proof.
  intros Lin Z x Zx. assert (Once : NoDup (b4 :: U)).
  { constructor; [|exact unknowns_once]. intros H. now apply (b4_unknown b4 H). }
  rewrite (linear_coordinates (fun w => F (lifted w)) (b4 :: U) x);
    [|intros a s b; now rewrite lifted_move, Lin|exact Once|exact Zx].
  apply sum_zero. intros k [<-|Hk].
  - rewrite lifted_base, Z by now left. ring.
  - rewrite lifted_column, Z by (assumption || (right; now apply in_map)). ring.
Qed.

Lemma spanned_twice (F : vec -> vec -> R) : (forall a, linear (F a)) -> (forall a b, F a b = F b a) ->
  (forall g h, In g spanning -> In h spanning -> F (reals g) (reals h) = 0) ->
  forall x, zero_off (b4 :: U) x -> F (lifted x) (lifted x) = 0.
Proof.
  intros Lin Sym Z x Zx. apply spanned; [apply Lin| |exact Zx]. intros g Hg. rewrite Sym.
  apply spanned; [apply Lin| |exact Zx]. intros h Hh. now apply Z.
Qed.

(** A linear functional that is beyond the change. *)
Lemma beyond_means (f : zheights -> Z) (F : vec -> R) (w : R) up x : 0 < w -> linear F ->
  (forall h, IZR (f h) = w * F (reals h)) -> beyond f up = true ->
  x b4 = 1 -> (forall k, In k U -> Rabs (x k - m k) <= IZR (half sp)) -> 0 < sign up * F (lifted x).
Proof.
  intros Pw Lin E B X4 Box. unfold beyond in B. set (far := (half sp * zsum U (fun k => Z.abs (f (along k))))%Z) in *.
  assert (D : lifted x = move (lifted m) 1 (fun u => sum U (fun k => (x k - m k) * reals (along k) u))).
  { apply functional_extensionality. intros u. unfold lifted, move. rewrite X4.
    replace (m b4) with 1 by (unfold m; now destruct Nat.eq_dec).
    rewrite (sum_ext U (fun k => (x k - m k) * reals (along k) u)
      (fun k => x k * reals (along k) u + (-1) * (m k * reals (along k) u))) by (intros; ring).
    rewrite sum_plus, sum_scal. ring. }
  assert (Fs : forall l, F (fun u => sum l (fun k => (x k - m k) * reals (along k) u)) =
    sum l (fun k => (x k - m k) * F (reals (along k)))).
  { induction l as [|k l IH]; [exact (linear_zero F Lin)|]. cbn [sum]. rewrite <- IH.
    replace (fun u => (x k - m k) * reals (along k) u + sum l (fun k => (x k - m k) * reals (along k) u)) with
      (move (fun u => sum l (fun k => (x k - m k) * reals (along k) u)) (x k - m k) (reals (along k)))
      by (apply functional_extensionality; intros u; unfold move; ring).
    rewrite Lin. ring. }
  assert (Near : Rabs (w * F (lifted x) - IZR (f middle)) <= IZR far).
  { rewrite D, Lin, Fs, lifted_middle, E.
    replace (w * _ - _) with (sum U (fun k => (x k - m k) * (w * F (reals (along k))))).
    2: { rewrite (sum_ext U (fun k => (x k - m k) * (w * F (reals (along k))))
           (fun k => w * ((x k - m k) * F (reals (along k))))) by (intros; ring). rewrite sum_scal. ring. }
    eapply Rle_trans; [apply sum_abs|]. unfold far. rewrite mult_IZR, zsum_R, <- sum_scal. apply sum_le. intros k Hk.
    rewrite Rabs_mult, <- E, Rabs_Zabs.
    apply Rmult_le_compat_r; [rewrite <- Rabs_Zabs; apply Rabs_pos|now apply Box]. }
  apply (Rmult_lt_reg_l w); [assumption|]. rewrite Rmult_0_r.
  pose proof (Rle_abs (w * F (lifted x) - IZR (f middle))).
  pose proof (Rle_abs (- (w * F (lifted x) - IZR (f middle)))).
  rewrite Rabs_Ropp in *. destruct up; apply Z.ltb_lt, IZR_lt in B; rewrite ?opp_IZR in B; unfold sign; lra.
Qed.

(** Heights of the space near its middle, with curvature 0 where a sign is claimed, unless the vertex is [kept]. *)
Definition flat_or_kept (signs : nat -> option bool) (kept : nat -> bool) (b : hub) : bool :=
  kept (at_vertex b) || match signs (at_vertex b) with None => true | Some _ => false end.

Definition solution signs kept (x : vec) : Prop := x b4 = 1 /\ zero_off (b4 :: U) x /\
  (forall k, In k U -> Rabs (x k - m k) <= IZR (half sp)) /\
  forall b, In b (hubs p) -> flat_or_kept signs kept b = false -> K2 S (at_vertex b) (lifted x) (lifted x) = 0.
End Space.
