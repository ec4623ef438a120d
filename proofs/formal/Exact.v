(** Heights that solve the equations exactly: signs, flat vertices and all letters are decided in integers. *)
From Coq Require Import Reals ZArith List Lra Lia Arith Bool FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Nappes Sheet Identities Star KeyLemma Flat Theorems Branches Notch
  Drawing Tables Rational Certificate Integers Verify.
Import ListNotations.
Open Scope R_scope.

(** A mountain tells the nappes of null vectors apart, as the round cone does. *)
Lemma null_side S v t h e : In v (inner S) -> (forall u, In u (fan S v) -> t u < t v) -> 0 < K2 S v t t ->
  K S v h = 0 -> 0 < sign e * K2 S v t h -> 0 < sign e * K2 S v (cone S v) h.
Proof.
  intros Hv Down Pt Null Side. pose proof (cone_and_mountain S v t Hv Down) as Tc.
  assert (V : In v (inner S ++ rim S)) by (apply in_or_app; now left). rewrite K_polar_sheet in Pt by assumption.
  assert (N0 : K2 S v (cone S v) h <> 0).
  { intros Z. assert (Fl : flat_star S v h) by (apply both_nappes_flat; [assumption|lra|assumption]).
    rewrite K2_sym, (flat_null S v h Hv Fl) in Side. lra. }
  destruct (Rlt_le_dec 0 (sign e * K2 S v (cone S v) h)) as [|N]; [assumption|exfalso].
  set (g := move zero (- sign e) h).
  assert (Lg : forall f, K2 S v f g = - (sign e * K2 S v f h)).
  { intros f. unfold g. rewrite K2_move, (linear_zero (K2 S v f)) by (intros x y z; apply K2_move). ring. }
  assert (Kg : K S v g = 0).
  { rewrite <- K_polar_sheet, Lg, (K2_sym S v g h), Lg, K_polar_sheet, Null by assumption. ring. }
  pose proof (reversed_cauchy S v t g true Hv) as C. rewrite Kg, sqrt_0, Rmult_0_r, !Lg in C.
  change (sign true) with 1 in C.
  assert (0 <= - (sign e * K2 S v t h)) by (apply C; lra). lra.
Qed.

Lemma null_flat_side S v t h : In v (inner S) -> 0 < K2 S v t t -> K S v h = 0 -> K2 S v t h = 0 -> flat_star S v h.
Proof.
  intros Hv Pt Null Side. assert (V : In v (inner S ++ rim S)) by (apply in_or_app; now left).
  rewrite K_polar_sheet in Pt by assumption.
  apply (both_nappes_flat S v h Hv); [lra|].
  destruct (Req_dec (K2 S v (cone S v) h) 0) as [|N]; [assumption|exfalso].
  assert (NF : ~ flat_star S v h) by (intros Fl; apply N; rewrite K2_sym; now apply flat_null).
  rewrite K2_sym in Side. pose proof (L_flat S v h t Hv Null NF Side). lra.
Qed.

(** The sign of a vertex, [None] if it is flat; the letter of a fold, [Some None] if it is flat. *)
Definition exact_hub (kept : nat -> bool) (claimed : nat -> option bool) (h : zheights) (b : hub) : bool :=
  let (k, s) := measured h (h (at_vertex b)) (wedges b) in
  match claimed (at_vertex b) with
  | Some up => (if kept (at_vertex b) then 0 <? k else k =? 0)%Z && (if up then 0 <? s else s <? 0)%Z
  | None => negb (kept (at_vertex b)) && (k =? 0)%Z && (s =? 0)%Z
  end.

Definition exact_fold (h : zheights) (letters : nat -> option letter) (f : fold_form) : bool :=
  match letters (name f) with
  | None => true
  | Some None => (bent h f =? 0)%Z
  | Some (Some valley) => (if valley then 0 <? bent h f else bent h f <? 0)%Z
  end.

Definition exact p (kept : nat -> bool) (claimed : nat -> option bool) h (letters : nat -> option letter) : bool :=
  forallb (exact_hub kept claimed h) (hubs p) && forallb (exact_fold h letters) (folds p).

(** The signs [up] are those claimed; a flat vertex may have any. *)
Definition agrees (d : drawing) (claimed : nat -> option bool) (up : nat -> bool) : Prop :=
  forall v e, In v (inside d) -> claimed v = Some e -> up v = e.

(** The heights are the only solution with these signs, curvatures at the vertices that are kept, and rim. *)
Definition exactly d p (kept : nat -> bool) claimed h (letters : nat -> option letter) (ok : check d = true) : Prop :=
  let S := sheet_of d ok in let k := fun v => if kept v then K S v (reals h) else 0 in
  solves S k (reals h) /\
  (forall v e, In v (inside d) -> claimed v = Some e -> 0 < sign e * K2 S v (cone S v) (reals h)) /\
  (forall v, In v (inside d) -> claimed v = None -> flat_star S v (reals h)) /\
  (forall v, In v (inside d) -> kept v = true -> 0 < K S v (reals h)) /\
  (forall up g, agrees d claimed up -> has_rim S (reals h) g -> solves S k g -> in_nappes S up g -> g = reals h) /\
  (forall f i j l m w, In f (folds p) -> ends f = (i, j, l, m) -> letters (name f) = Some w ->
    match w with Some valley => 0 < sign valley * bend S i j l m (reals h) | None => bend S i j l m (reals h) = 0 end).

Section Exact.
Variable d : drawing.
Variable p : prepared.
Variable ok : check d = true.
Hypothesis sound_p : sound d p = true.
Notation S := (sheet_of d ok).

(** What is measured of heights at a vertex: the curvature and the side of the mountain. *)
Lemma hub_forms b : In b (hubs p) -> let v := at_vertex b in let t := reals (mountain_at b) in
  In v (inside d) /\ 0 < IZR (scale b) /\ 0 < K2 S v t t /\ (forall u, In u (fan S v) -> t u < t v) /\
  forall h, IZR (fst (measured h (h v) (wedges b))) = IZR (scale b) * K2 S v (reals h) (reals h) /\
    IZR (snd (measured h (h v) (wedges b))) = 2 * IZR (scale b) * K2 S v t (reals h).
Proof.
  intros Hb. pose proof sound_p as O. unfold sound in O. cbv zeta in O. rewrite andb_true_iff in O.
  destruct O as (_ & Ok).
  set (at_z := look (places d) (0, 0)%Z) in *. set (fan_of := look (fans_table d) []) in *.
  assert (At : at_z = place d) by exact (table_nth _ _).
  assert (Fan : fan_of = fun v => nth v (fans_of d) []) by exact (table_nth _ _).
  destruct (hub_means d p at_z fan_of _ _ b Ok Hb) as (Hi & H). cbv zeta. set (v := at_vertex b) in *.
  assert (Hv : In v (inside d ++ border d)) by (apply in_or_app; now left).
  unfold hub_ok in H. fold v in H. rewrite Fan in H. rewrite !andb_true_iff in H.
  destruct H as ((((((Ps & Ss) & Ws) & Pt) & Down) & _) & _). apply Z.ltb_lt, IZR_lt in Ps.
  rewrite forallb_forall in Down. set (t := mountain_at b) in *.
  pose proof (fun h => measured_R d at_z ok At v (scale b) t h (wedges b) _ Hv (fun s Hs => Hs) Ss Ws) as M.
  cbv zeta in M. split; [exact Hi|]. split; [exact Ps|]. split; [|split; [|exact M]].
  - apply Z.ltb_lt, IZR_lt in Pt. destruct (M t) as (Mt & _). rewrite Mt in Pt.
    change (0 < IZR (scale b) * K2 S v (reals t) (reals t)) in Pt.
    apply (Rmult_lt_reg_l (IZR (scale b))); [assumption|]. now rewrite Rmult_0_r.
  - intros u Hu. unfold reals. apply IZR_lt, Z.ltb_lt. now apply Down.
Qed.

Lemma flat_measured b h : In b (hubs p) -> exact_hub (fun _ => false) (fun _ => None) h b = true ->
  flat_star S (at_vertex b) (reals h).
Proof.
  intros Hb. destruct (hub_forms b Hb) as (Hi & Ps & Pt & _ & M). destruct (M h) as (Mk & Ms). unfold exact_hub.
  assert (Hv : In (at_vertex b) (inside d ++ border d)) by (apply in_or_app; now left).
  destruct (measured h (h (at_vertex b)) (wedges b)) as (k, s). cbn [fst snd negb andb] in *.
  rewrite andb_true_iff, !Z.eqb_eq. intros (-> & ->). rewrite (K_polar_sheet S _ (reals h)) in Mk by exact Hv.
  symmetry in Mk, Ms. apply Rmult_integral in Mk, Ms.
  apply (null_flat_side S _ (reals (mountain_at b))); [exact Hi|exact Pt| |].
  - now destruct Mk; [lra|].
  - now destruct Ms; [lra|].
Qed.

(** What is measured of heights at a fold. *)
Lemma fold_forms f i j l m : In f (folds p) -> ends f = (i, j, l, m) ->
  exists w, 0 < w /\ forall h, IZR (bent h f) = w * bend S i j l m (reals h).
Proof.
  intros Hf E. pose proof sound_p as O. unfold sound in O. cbv zeta in O. rewrite andb_true_iff in O.
  destruct O as (_ & Ok).
  unfold prepared_ok in Ok. rewrite !andb_true_iff, !forallb_forall in Ok. destruct Ok as (((_ & Forms) & _) & _).
  set (at_z := look (places d) (0, 0)%Z) in *. set (fan_of := look (fans_table d) []) in *.
  set (known := has (set_of (inside d ++ border d))) in *.
  assert (At : at_z = place d) by exact (table_nth _ _).
  assert (Fan : fan_of = fun v => nth v (fans_of d) []) by exact (table_nth _ _).
  assert (Kn : forall v, known v = true -> In v (inside d ++ border d)) by (intros v Hv; now apply has_In in Hv).
  pose proof (fun h => bent_R d at_z fan_of known ok At Fan Kn h f i j l m E (Forms f Hf)) as B. cbv zeta in B.
  destruct (B (fun _ => 0%Z)) as (C1 & C2 & _).
  exists (cross (spoke (at_ S) i j) (spoke (at_ S) i l) * cross (spoke (at_ S) i m) (spoke (at_ S) i j)). split.
  - apply Rmult_lt_0_compat; [exact (face_of_corner S _ _ _ C1)|exact (face_of_corner S _ _ _ C2)].
  - intros h. now destruct (B h) as (_ & _ & E' & _).
Qed.

Lemma exact_means kept claimed h letters : exact p kept claimed h letters = true ->
  exactly d p kept claimed h letters ok.
Proof.
  unfold exact, exactly. cbv zeta. rewrite !andb_true_iff, !forallb_forall. intros (Hubs & Folds).
  assert (Same : inside d = map at_vertex (hubs p)) by now destruct (sound_means d p sound_p) as (_ & E & _).
  assert (Vertex : forall v, In v (inside d) ->
    (forall e, claimed v = Some e -> 0 < sign e * K2 S v (cone S v) (reals h)) /\
    (claimed v = None -> flat_star S v (reals h)) /\ (kept v = true -> 0 < K S v (reals h)) /\
    (kept v = false -> K S v (reals h) = 0)).
  { intros v Hv. rewrite Same in Hv. apply in_map_iff in Hv. destruct Hv as (b & <- & Hb). specialize (Hubs b Hb).
    destruct (hub_forms b Hb) as (Hi & Ps & Pt & Down & M). set (v := at_vertex b) in *.
    set (t := reals (mountain_at b)) in *. destruct (M h) as (Mk & Ms). clear M.
    assert (Hv : In v (inside d ++ border d)) by (apply in_or_app; now left).
    unfold exact_hub in Hubs. fold v in Hubs. destruct (measured h (h v) (wedges b)) as (k, s). cbn [fst snd] in Mk, Ms.
    rewrite (K_polar_sheet S v (reals h)) in Mk by exact Hv.
    assert (Null : k = 0%Z -> K S v (reals h) = 0).
    { intros ->. symmetry in Mk. apply Rmult_integral in Mk. destruct Mk; [lra|assumption]. }
    assert (Pos : (0 < k)%Z -> 0 < K S v (reals h)).
    { intros Pk. apply IZR_lt in Pk. rewrite Mk in Pk. apply (Rmult_lt_reg_l (IZR (scale b))); [assumption|].
      now rewrite Rmult_0_r. }
    destruct (claimed v) as [up|] eqn:Cl.
    - rewrite andb_true_iff in Hubs. destruct Hubs as (Hk & Hs).
      assert (Sd : 0 < sign up * K2 S v t (reals h)).
      { assert (Two : 0 < 2 * IZR (scale b)) by lra.
        apply (Rmult_lt_reg_l (2 * IZR (scale b))); [assumption|]. rewrite Rmult_0_r.
        destruct up; apply Z.ltb_lt, IZR_lt in Hs; rewrite Ms in Hs; unfold sign; lra. }
      split; [|split; [easy|]].
      + intros e [= <-]. destruct (kept v).
        * apply Z.ltb_lt in Hk. apply (side_by_mountain S v t); try assumption.
          rewrite K_polar_sheet by exact Hv. now apply Pos.
        * apply Z.eqb_eq in Hk. apply (null_side S v t); try assumption. now apply Null.
      + destruct (kept v); (split; [|try easy]).
        * intros _. apply Pos. now apply Z.ltb_lt in Hk.
        * easy.
        * intros _. apply Null. now apply Z.eqb_eq in Hk.
    - rewrite !andb_true_iff, negb_true_iff in Hubs. destruct Hubs as ((Nk & Hk) & Hs). apply Z.eqb_eq in Hk, Hs.
      split; [easy|]. rewrite Nk. split; [|split; [easy|intros _; now apply Null]].
      intros _. apply (null_flat_side S v t); try assumption; [now apply Null|].
      rewrite Hs in Ms. symmetry in Ms. apply Rmult_integral in Ms. destruct Ms; [lra|assumption]. }
  split; [|split; [|split; [|split; [|split]]]].
  - intros v Hv. destruct (Vertex v Hv) as (_ & _ & _ & Z). destruct (kept v); [reflexivity|now apply Z].
  - intros v e Hv. now apply Vertex.
  - intros v Hv. now apply Vertex.
  - intros v Hv. now apply Vertex.
  - intros up g Ag Gr Gs Gn. set (k := fun v => if kept v then K S v (reals h) else 0).
    assert (Pk : forall v, In v (inner S) -> 0 <= k v).
    { intros v Hv. unfold k. destruct (Vertex v Hv) as (_ & _ & P & _). destruct (kept v); [apply Rlt_le; auto|lra]. }
    destruct (one_solution_per_sign_vector S k (reals h) up Pk) as (x & _ & U).
    rewrite <- (U g (conj Gr (conj Gs Gn))). apply U. split; [intros u _; reflexivity|]. split.
    + intros v Hv. unfold k. destruct (Vertex v Hv) as (_ & _ & _ & Z). destruct (kept v); [reflexivity|now apply Z].
    + intros v Hv. destruct (Vertex v Hv) as (Sg & Fl & P & Z). split.
      * destruct (kept v); [apply Rlt_le; auto|rewrite Z by reflexivity; lra].
      * destruct (claimed v) as [e|] eqn:Cl.
        -- rewrite (Ag v e Hv Cl). apply Rlt_le. now apply Sg.
        -- rewrite K2_sym, (flat_null S v (reals h) Hv (Fl eq_refl)). lra.
  - intros f i j l m w Hf E As. specialize (Folds f Hf). unfold exact_fold in Folds. rewrite As in Folds.
    destruct (fold_forms f i j l m Hf E) as (a & Pa & B). specialize (B h). destruct w as [valley|].
    + apply (Rmult_lt_reg_l a); [assumption|]. rewrite Rmult_0_r.
      destruct valley; apply Z.ltb_lt, IZR_lt in Folds; rewrite B in Folds; unfold sign; lra.
    + apply Z.eqb_eq, (f_equal IZR) in Folds. rewrite B in Folds. apply Rmult_integral in Folds.
      destruct Folds; [lra|assumption].
Qed.
End Exact.

Definition verify_exact d p kept claimed h letters : bool := sound d p && exact p kept claimed h letters.

Theorem exact_verified d p kept claimed h letters : verify_exact d p kept claimed h letters = true ->
  exists ok : check d = true, exactly d p kept claimed h letters ok.
Proof.
  unfold verify_exact. rewrite andb_true_iff. intros (So & Ex). destruct (sound_means d p So) as (ok & _).
  exists ok. now apply exact_means.
Qed.

(** The same with a reflex corner [r], which pops up: the only representative with these signs is a multiple. *)
Definition verify_exact_notched d p r (claimed : nat -> option bool) h letters : bool :=
  closes d r && match claimed r with Some true => true | _ => false end &&
  verify_exact d p (fun v => Nat.eqb v r) claimed (on_zero d h) letters.

Theorem exact_notched_verified d p r claimed h letters : verify_exact_notched d p r claimed h letters = true ->
  exists (ok : check d = true) opened, notch_closed d r ok opened /\
  let S := sheet_of d ok in let h := reals (on_zero d h) in exists s, 0 < s /\ raised S r (scaled_up s h) /\
  (forall v e, In v (inside d) -> claimed v = Some e -> 0 < sign e * K2 S v (cone S v) h) /\
  (forall v, In v (inside d) -> claimed v = None -> flat_star S v h) /\
  (forall up g, agrees d claimed (with_r r up) -> raised S r g -> in_nappes S (with_r r up) g -> g = scaled_up s h) /\
  (forall f i j l m w, In f (folds p) -> ends f = (i, j, l, m) -> letters (name f) = Some w ->
    match w with Some valley => 0 < sign valley * bend S i j l m h | None => bend S i j l m h = 0 end).
Proof.
  unfold verify_exact_notched. rewrite !andb_true_iff. intros ((Cl & Up) & Ver).
  destruct (exact_verified _ _ _ _ _ _ Ver) as (ok & Sol & Sg & Fl & Pos & U & Lt).
  destruct (closes_means d r ok Cl) as (opened & Op). exists ok, opened. split; [exact Op|].
  destruct (claimed r) as [[|]|] eqn:Cr; try discriminate. cbv zeta. set (S := sheet_of d ok) in *.
  set (x := reals (on_zero d h)) in *.
  assert (Hr : In r (inner S)) by (destruct Op as (? & ? & ? & ? & ? & _ & _ & _ & Hr & _); exact Hr).
  assert (Pk : 0 < K S r x) by (apply Pos; [exact Hr|apply Nat.eqb_refl]).
  set (q := sqrt (K S r x)). assert (Pq : 0 < q) by now apply sqrt_lt_R0.
  assert (Qq : q * q = K S r x) by (apply sqrt_sqrt; lra). assert (Pi : 0 < / q) by now apply Rinv_0_lt_compat.
  assert (Twice : forall a b g, scaled_up a (scaled_up b g) = scaled_up (a * b) g).
  { intros a b g. apply functional_extensionality. intros u. unfold scaled_up, move, zero. ring. }
  exists (/ q). split; [assumption|]. split; [|split; [exact Sg|split; [exact Fl|split; [|exact Lt]]]].
  - split; [|split].
    + intros u Hu. unfold scaled_up, move, zero, x, reals. rewrite on_zero_off by exact Hu. ring.
    + intros v Hv. rewrite K_scaled, (Sol v Hv) by assumption. unfold one_at.
      destruct (Nat.eqb_spec v r) as [->|N]; [|ring]. rewrite <- Qq. field. lra.
    + rewrite K2_scaled. apply Rmult_lt_0_compat; [assumption|]. pose proof (Sg r true Hr Cr) as P. simpl in P. lra.
  - intros up g Ag (Rg & Sg' & _) Gn.
    assert (E : scaled_up q g = x).
    { apply (U (with_r r up)); [exact Ag| | |].
      - intros u Hu. unfold scaled_up, move. rewrite (Rg u Hu). unfold zero, x, reals.
        rewrite on_zero_off by exact Hu. ring.
      - intros v Hv. rewrite K_scaled, (Sg' v Hv) by assumption. unfold one_at.
        destruct (Nat.eqb_spec v r) as [->|N]; [rewrite <- Qq|]; ring.
      - intros v Hv. destruct (Gn v Hv) as (P & Q). rewrite K_scaled, K2_scaled by assumption. split.
        + repeat apply Rmult_le_pos; lra.
        + replace (sign _ * (q * _)) with (q * (sign (with_r r up v) * K2 S v (cone S v) g)) by ring.
          apply Rmult_le_pos; lra. }
    rewrite <- E, Twice. rewrite Rinv_l by lra. apply functional_extensionality. intros u.
    unfold scaled_up, move, zero. ring.
Qed.
