(** A solution in a linear space of heights, by Krawczyk's test in integers: stars that are flat on the whole space
    are flat on it, and the curvatures of the other vertices are combinations of as many as there are unknowns. *)
From Coq Require Import Reals ZArith List Lra Lia Arith Bool FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Nappes Sheet Identities Star KeyLemma Flat Theorems Branches Krawczyk
  Drawing Tables Rational Certificate Integers Verify Exact.
Import ListNotations.
Open Scope R_scope.

(** The heights are [base] and, for each vertex that is [chosen], an unknown times its [column]. The unknowns are
    whole numbers, [centre], up to [half]. [inverse] is the matrix of the test, divided by [over]; the bounds are
    those of its three numbers, times [over]. A curvature times the first number of its [combination] is a
    combination of those that are chosen. *)
Record space := Space {
  chosen : nat -> bool;
  base : zheights;
  column : nat -> zheights;
  centre : nat -> Z; half : Z;
  inverse : nat -> nat -> Z; over : Z;
  bound0 : Z; bound1 : Z; bound2 : Z;
  combination : nat -> Z * (nat -> Z)
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
Variable signs : nat -> option bool.
Variable letters : nat -> option letter.
(** Vertices whose curvature is not 0; and a vertex with the sign of its height, [Some None] if it is 0. *)
Variable kept : nat -> bool.
Variable corner : nat.
Variable rise : option letter.

Definition parts : list hub := filter (fun b => chosen sp (at_vertex b)) (hubs p).
Definition unknowns : list nat := map at_vertex parts.
Definition start : zheights := with_rim d b4 top (base sp).
Definition along (k : nat) : zheights := with_rim d b4 0 (column sp k).
Definition middle : zheights := fun u => (start u + zsum unknowns (fun k => centre sp k * along k u))%Z.
Definition spanning : list zheights := start :: map along unknowns.

Definition curved (b : hub) (h : zheights) : Z := fst (measured h (h (at_vertex b)) (wedges b)).
Definition sided (b : hub) (h : zheights) : Z := snd (measured h (h (at_vertex b)) (wedges b)).
Definition polar (b : hub) (g h : zheights) : Z := (curved b (fun u => g u + h u) - curved b g - curved b h)%Z.

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

(** A functional is beyond what the unknowns may change. *)
Definition beyond (f : zheights -> Z) (up : bool) : bool :=
  let far := (half sp * zsum unknowns (fun k => Z.abs (f (along k))))%Z in
  (if up then far <? f middle else f middle <? - far)%Z.

Definition space_hub (b : hub) : bool :=
  match signs (at_vertex b) with
  | None => forallb (fun h => exact_hub (fun _ => false) (fun _ => None) h b) spanning
  | Some up => (kept (at_vertex b) || chosen sp (at_vertex b) || combined b) && beyond (sided b) up
  end.

Definition space_fold (f : fold_form) : bool :=
  match letters (name f) with
  | None => true
  | Some None => forallb (fun h => bent h f =? 0)%Z spanning
  | Some (Some valley) => beyond (fun h => bent h f) valley
  end.

Definition risen : bool :=
  match rise with
  | None => true
  | Some None => forallb (fun h => h corner =? 0)%Z spanning
  | Some (Some up) => beyond (fun h => h corner) up
  end.

Definition in_space : bool := contracts && forallb space_hub (hubs p) && forallb space_fold (folds p) && risen.

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
  rewrite mult_IZR, polar_R by now apply parts_in. unfold form. rewrite Ex, Ey. ring.
Qed.

Lemma form_sym v a b : form v a b = form v b a.
Proof. apply K2_sym. Qed.

Lemma form_move v a b s c : form v a (move b s c) = form v a b + s * form v a c.
Proof. unfold form. rewrite lifted_move. apply K2_move. Qed.

Lemma solution : contracts = true -> exists x, x b4 = 1 /\ zero_off (b4 :: U) x /\
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
    + intros b Hb. rewrite mult_IZR, curved_R by now apply parts_in. unfold form. rewrite lifted_middle. ring.
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

(** Heights of the space that solve the equations; they have the signs, flat stars and letters. *)
Lemma space_solution : in_space = true -> exists g,
  (forall u, ~ In u (inside d) -> g u = IZR top * unit b4 u) /\ (forall v, In v (inside d) -> kept v = false ->
    K S v g = 0) /\
  (forall v e, In v (inside d) -> signs v = Some e -> exists t, (forall u, In u (fan S v) -> t u < t v) /\
    0 < K2 S v t t /\ 0 < sign e * K2 S v t g) /\
  (forall v, In v (inside d) -> signs v = None -> flat_star S v g) /\
  (forall f i j l r w, In f (folds p) -> ends f = (i, j, l, r) -> letters (name f) = Some w ->
    match w with Some valley => 0 < sign valley * bend S i j l r g | None => bend S i j l r g = 0 end) /\
  match rise with Some (Some up) => 0 < sign up * g corner | Some None => g corner = 0 | None => True end.
Proof.
  unfold in_space. rewrite !andb_true_iff, !forallb_forall. intros (((Con & Hubs) & Folds) & Rise).
  destruct (solution Con) as (x & X4 & Zx & Box & Sol). exists (lifted x).
  assert (Flat : forall b, In b (hubs p) -> signs (at_vertex b) = None -> flat_star S (at_vertex b) (lifted x)).
  { intros b Hb N. specialize (Hubs b Hb). unfold space_hub in Hubs. rewrite N, forallb_forall in Hubs.
    destruct (hub_forms d p ok sound_p b Hb) as (Hi & _). apply flat_star_iff; [exact Hi|]. intros z. rewrite K2_sym.
    apply spanned; [intros a s c; apply K2_move| |exact Zx]. intros g Hg. rewrite K2_sym.
    apply (flat_null S _ _ Hi), (flat_measured d p ok sound_p b g Hb). now apply Hubs. }
  assert (Null : forall b, In b (hubs p) -> kept (at_vertex b) = false -> K2 S (at_vertex b) (lifted x) (lifted x) = 0).
  { intros b Hb Nk. destruct (hub_forms d p ok sound_p b Hb) as (Hi & Ps & _).
    destruct (signs (at_vertex b)) as [e|] eqn:E.
    2: { apply flat_null; [exact Hi|now apply Flat]. }
    specialize (Hubs b Hb). unfold space_hub in Hubs. rewrite E, Nk, andb_true_iff, orb_false_l, orb_true_iff in Hubs.
    destruct Hubs as ([Ch|Co] & _).
    - apply Sol. apply in_map. now apply filter_In.
    - unfold combined in Co. destruct (combination sp (at_vertex b)) as (times, weights).
      rewrite andb_true_iff, negb_true_iff, Z.eqb_neq, forallb_forall in Co. destruct Co as (Nt & Co).
      set (F := fun g h => IZR times * (2 * IZR (scale b) * K2 S (at_vertex b) g h) -
        sum parts (fun c => IZR (weights (at_vertex c)) * (2 * IZR (scale c) * K2 S (at_vertex c) g h))).
      assert (Z : F (lifted x) (lifted x) = 0).
      { apply spanned_twice; [| | |exact Zx].
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
          apply Rminus_diag_eq, sum_ext. intros c Hc. rewrite mult_IZR, polar_R by now apply parts_in. reflexivity. }
      unfold F in Z. rewrite sum_zero in Z.
      + rewrite Rminus_0_r in Z. apply Rmult_integral in Z. destruct Z as [Z|Z]; [now apply eq_IZR in Z|].
        apply Rmult_integral in Z. destruct Z; [lra|assumption].
      + intros c Hc. rewrite (Sol (at_vertex c)) by now apply in_map. ring. }
  assert (Which : forall v, In v (inside d) -> exists b, In b (hubs p) /\ at_vertex b = v).
  { intros v Hv. rewrite inside_hubs in Hv. apply in_map_iff in Hv. destruct Hv as (b & E & Hb). now exists b. }
  split; [|split; [|split; [|split; [|split]]]].
  - intros u Hu. assert (Mu : mem u (inside d) = false) by (unfold mem; now destruct in_dec).
    unfold lifted. rewrite X4, sum_zero.
    + unfold reals, start, with_rim. rewrite Mu. unfold unit, upd, zero.
      destruct (Nat.eq_dec u b4) as [->|N]; [rewrite Nat.eqb_refl; ring|]. apply Nat.eqb_neq in N. rewrite N. ring.
    + intros k _. unfold reals, along, with_rim. rewrite Mu. destruct (Nat.eqb u b4); ring.
  - intros v Hv Nk. destruct (Which v Hv) as (b & Hb & <-). rewrite <- K_polar_sheet; [now apply Null|].
    apply in_or_app. now left.
  - intros v e Hv E. destruct (Which v Hv) as (b & Hb & <-).
    destruct (hub_forms d p ok sound_p b Hb) as (_ & Ps & Pt & Down & M).
    exists (reals (mountain_at b)). split; [exact Down|]. split; [exact Pt|].
    specialize (Hubs b Hb). unfold space_hub in Hubs. rewrite E, andb_true_iff in Hubs. destruct Hubs as (_ & Be).
    apply (beyond_means (sided b) (K2 S (at_vertex b) (reals (mountain_at b))) (2 * IZR (scale b)));
      try assumption; [lra| |].
    + intros a s c. apply K2_move.
    + intros h. now destruct (M h).
  - intros v Hv E. destruct (Which v Hv) as (b & Hb & <-). now apply Flat.
  - intros f i j l r w Hf E As. destruct (fold_forms d p ok sound_p f i j l r Hf E) as (t & Pt & B).
    assert (Lin : linear (bend S i j l r)).
    { intros a s c. unfold bend, tilt, gradient, move, dot, sub, J, Rdiv. cbn [fst snd]. ring. }
    specialize (Folds f Hf). unfold space_fold in Folds. rewrite As in Folds. destruct w as [valley|].
    + now apply (beyond_means (fun h => bent h f) (bend S i j l r) t).
    + apply spanned; [exact Lin| |exact Zx]. intros g Hg. rewrite forallb_forall in Folds. specialize (Folds g Hg).
      apply Z.eqb_eq, (f_equal IZR) in Folds. rewrite B in Folds. apply Rmult_integral in Folds.
      destruct Folds; [lra|assumption].
  - unfold risen in Rise. destruct rise as [[up|]|]; [| |exact Logic.I].
    + apply (beyond_means (fun h => h corner) (fun h => h corner) 1); try assumption; [lra|now intros a s c|].
      intros h. unfold reals. ring.
    + rewrite forallb_forall in Rise. apply (spanned (fun h => h corner)); [now intros a s c| |exact Zx].
      intros g Hg. unfold reals. apply f_equal. now apply Z.eqb_eq, Rise.
Qed.
End Space.
