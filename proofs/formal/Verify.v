(** The program that verifies certificates (docs/formal.md): what passes is true. The numbers that it is
    given, and what it prepares from them, are not trusted. *)
From Coq Require Import Reals ZArith List Lra Lia Permutation Arith Bool FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Nappes Sheet Star KeyLemma Flat Complex Theorems Branches
  Triangles Notch Drawing Tables Rational Certificate Integers.
Import ListNotations.
Open Scope R_scope.

(** ** One branch *)

(** A drawing is a sheet, and what was prepared belongs to it. *)
Definition sound (d : drawing) (p : prepared) : bool :=
  let places := places d in let fans := fans_table d in
  let known := set_of (inside d ++ border d) in let fold_table := table (folds p) in
  swift_check d places fans &&
  prepared_ok d p (look places (0, 0)%Z) (look fans []) (has known) (fun k => Map.find (key k) fold_table).

(** What a test of one branch proves; vertices that are [kept] have the curvature of the heights [h], others 0. *)
Definition proved (d : drawing) (p : prepared) (ok : check d = true) (kept up : nat -> bool) h asked : Prop :=
  let S := sheet_of d ok in let k := fun v => if kept v then K S v (reals h) else 0 in
  exists g, has_rim S (reals h) g /\ solves S k g /\ in_nappes S up g /\
    (forall b, In b (hubs p) -> is_bent asked b = true ->
      0 < sign (up (at_vertex b)) * K2 S (at_vertex b) (cone S (at_vertex b)) g) /\
    (forall g', has_rim S (reals h) g' -> solves S k g' -> in_nappes S up g' -> g' = g) /\
    (forall f i j l m valley, In f (folds p) -> ends f = (i, j, l, m) -> asked (name f) = Some valley ->
      0 < sign valley * bend S i j l m g).

Lemma sound_means d p : sound d p = true ->
  exists ok : check d = true, inside d = map at_vertex (hubs p) /\
    forall kept up h asked, passes p kept up h asked = true ->
      (forall v, In v (inside d) -> 0 < K (sheet_of d ok) v (reals h)) /\ proved d p ok kept up h asked.
Proof.
  unfold sound. cbv zeta. rewrite andb_true_iff. intros (Sw & Ok). exists (swift_checked d Sw). split.
  { unfold prepared_ok in Ok. rewrite !andb_true_iff in Ok. destruct Ok as ((((E & _) & _) & _) & _).
    symmetry. now apply same_list_eq. }
  intros kept up h asked.
  apply (passed d p _ _ _ _ (swift_checked d Sw)) with (5 := Ok).
  - exact (table_nth _ _).
  - exact (table_nth _ _).
  - intros v Hv. now apply has_In in Hv.
  - intros k f Hf. now apply table_In in Hf.
Qed.

Definition verify_one (d : drawing) (p : prepared) (up : nat -> bool) (h : zheights) (asked : nat -> letter) : bool :=
  sound d p && passes p (fun _ => false) up h asked.

(** Exactly one solution of K_v = 0 with these heights of the rim lies in these closed nappes. *)
Theorem one_verified d p up h asked : verify_one d p up h asked = true ->
  exists ok : check d = true, proved d p ok (fun _ => false) up h asked.
Proof.
  unfold verify_one. rewrite andb_true_iff. intros (So & Pass). destruct (sound_means d p So) as (ok & _ & H).
  exists ok. now apply H.
Qed.

(** The energy of the difference from the heights, times [below], is at most [top]. *)
Definition within (p : prepared) (up : nat -> bool) (h : zheights) (top below : Z) : bool :=
  match distance_of (fun _ => false) up h (hubs p) with
  | Some far => (0 <=? below)%Z && (far * below <=? top * units p)%Z
  | None => false
  end.

Theorem distance_verified d p up h top below (ok : check d = true) : sound d p = true ->
  within p up h top below = true -> let S := sheet_of d ok in
  forall g, has_rim S (reals h) g -> solves S (fun _ => 0) g -> in_nappes S up g ->
    IZR below * energy S (minus g (reals h)) <= IZR top.
Proof.
  unfold sound, within. cbv zeta. rewrite andb_true_iff. intros (_ & Ok).
  destruct (distance_of _ up h (hubs p)) as [far|] eqn:D; [|discriminate].
  rewrite andb_true_iff, !Z.leb_le. intros (Pb & Le). apply IZR_le in Pb, Le. rewrite !mult_IZR in Le.
  set (S := sheet_of d ok). intros g Gr Gs Gn.
  assert (At : look (places d) (0, 0)%Z = place d) by exact (table_nth _ _).
  assert (Fan : look (fans_table d) [] = fun v => nth v (fans_of d) []) by exact (table_nth _ _).
  destruct (distance_means d p _ _ _ _ ok At Fan (fun _ => false) up h far Ok D) as (Vs & Far).
  unfold prepared_ok in Ok. rewrite !andb_true_iff, !forallb_forall in Ok. destruct Ok as ((_ & Pu) & Ws).
  apply Z.ltb_lt, IZR_lt in Pu. rewrite At in *.
  set (c := (IZR (fst (centre2 p)) / 2, IZR (snd (centre2 p)) / 2) : point).
  assert (Weight : forall v, multiplier S c (IZR (radius4 p) / 4) v = IZR (multiplier4 p (place d) v) / 4).
  { intros v. unfold multiplier, multiplier4, c, dot, sub. cbn [fst snd at_ sheet_of S]. unfold at_R. cbn [fst snd].
    repeat rewrite ?plus_IZR, ?minus_IZR, ?mult_IZR, ?opp_IZR. field. }
  destruct (near_solution S up (fun _ => false) (reals h) c (IZR (radius4 p) / 4) (IZR far / IZR (units p)) [])
    as (g' & _ & _ & _ & _ & U & En & _).
  - intros v Hv. now apply Vs.
  - intros v Hv. rewrite Weight. specialize (Ws v Hv). apply Z.leb_le, IZR_le in Ws. lra.
  - rewrite (sum_ext _ _ (fun v => / 4 * (IZR (multiplier4 p (place d) v) * K S v (reals h)))).
    + rewrite sum_scal. unfold Rdiv in *. change (inner S) with (inside d). fold S in Far. lra.
    + intros v _. rewrite Weight. field.
  - easy.
  - rewrite (U g Gr Gs Gn). eapply Rle_trans; [apply Rmult_le_compat_l; [exact Pb|exact En]|].
    apply (Rmult_le_reg_r (IZR (units p))); [assumption|].
    replace (IZR below * (IZR far / IZR (units p)) * IZR (units p)) with (IZR far * IZR below) by (field; lra).
    exact Le.
Qed.

(** ** Multiples of heights *)

Definition scaled_up (s : R) (h : vec) : vec := move zero s h.

Lemma K2_scaled S v s g h : K2 S v g (scaled_up s h) = s * K2 S v g h.
Proof.
  unfold scaled_up. rewrite K2_move, (linear_zero (K2 S v g)) by (intros x y z; apply K2_move). ring.
Qed.

Lemma K_scaled S v s h : In v (inner S) -> K S v (scaled_up s h) = s * s * K S v h.
Proof.
  intros Hv. apply inner_vertex in Hv. rewrite <- !K_polar_sheet by assumption.
  rewrite K2_scaled, K2_sym, K2_scaled. ring.
Qed.

Lemma bend_scaled S i j l m s h : bend S i j l m (scaled_up s h) = s * bend S i j l m h.
Proof. unfold bend, tilt, gradient, scaled_up, move, zero, dot, sub, J, Rdiv. cbn [fst snd]. ring. Qed.

(** ** All branches *)

(** A test of all sign vectors, one after the other. *)
Fixpoint every (l : list nat) (test : (nat -> bool) -> bool) : bool :=
  match l with
  | [] => test (fun _ => false)
  | v :: l => every l test && every l (fun e => test (fun u => if Nat.eqb u v then true else e u))
  end.

Lemma every_all l test : every l test = true -> forall e, In e (sign_vectors l) -> test e = true.
Proof.
  revert test. induction l as [|v l IH]; intros test; simpl.
  - intros H e [<-|[]]. exact H.
  - rewrite andb_true_iff. intros (H & H') e He. apply in_app_or in He. destruct He as [He|He]; [now apply (IH test)|].
    apply in_map_iff in He. destruct He as (e' & <- & He'). exact (IH _ H' e' He').
Qed.

Section All.
Variable d : drawing.
Variable p : prepared.
(** For each sign vector: the height of the last corner, the heights inside, and letters of folds. *)
Variable top : (nat -> bool) -> Z.
Variable given : (nat -> bool) -> zheights.
Variable asked : (nat -> bool) -> nat -> letter.

(** Heights of a representative, times [top]: the other corners are at height 0. *)
Definition with_rim (b4 : nat) (s : Z) (h : zheights) : zheights := fun u =>
  if mem u (inside d) then h u else if Nat.eqb u b4 then s else 0%Z.

Definition test (b4 : nat) (e : nat -> bool) : bool :=
  (0 <? top e)%Z && forallb (is_bent (asked e)) (hubs p) && 
  passes p (fun _ => false) e (with_rim b4 (top e) (given e)) (asked e).

Definition verify_all : bool :=
  match border d with
  | [b1; b2; b3; b4] =>
    sound d p && negb (zcross d b1 b2 b3 =? 0)%Z && every (inside d) (test b4)
  | _ => false
  end.

(** Exactly 2^n branches, complex ones included, all real and simple, one for each sign vector, with the
    letters that were asked for. *)
Theorem all_verified : verify_all = true ->
  exists (ok : check d = true) (b1 b2 b3 b4 : nat), border d = [b1; b2; b3; b4] /\
  let S := sheet_of d ok in exists l : list vec,
    length l = (2 ^ length (inside d))%nat /\ NoDup l /\
    (forall h, In h l <-> representative S b4 h) /\
    (forall h, In h l -> nonsingular S h) /\
    (forall e, exists! h, In h l /\ has_signs S e h) /\
    (forall z, complex_solution S z -> complex_affine S z \/
       exists h, In h l /\ (exists s, on_branch S z s h) /\
         forall h' s', In h' l -> on_branch S z s' h' -> h' = h) /\
    (forall e h f i j l m valley, In e (sign_vectors (inside d)) -> representative S b4 h -> has_signs S e h ->
       In f (folds p) -> ends f = (i, j, l, m) -> asked e (name f) = Some valley ->
       0 < sign valley * bend S i j l m h).
Proof.
  unfold verify_all. destruct (border d) as [|b1 [|b2 [|b3 [|b4 [|b5 r]]]]] eqn:Rim; try discriminate.
  rewrite !andb_true_iff. intros ((So & Cor) & All). destruct (sound_means d p So) as (ok & Hubs & Ok).
  exists ok, b1, b2, b3, b4. split; [reflexivity|].
  set (S := sheet_of d ok). assert (All' := every_all _ _ All).
  (* every representative has a certified multiple *)
  assert (Near : forall h, representative S b4 h -> forall e, In e (sign_vectors (inside d)) -> in_nappes S e h ->
    exists s, 0 < s /\ has_signs S e h /\ forall f i j l m valley,
      In f (folds p) -> ends f = (i, j, l, m) -> asked e (name f) = Some valley -> 0 < sign valley * bend S i j l m h).
  { intros h (Hr & Hs) e He Hn. specialize (All' e He). unfold test in All'.
    rewrite !andb_true_iff, forallb_forall in All'.
    destruct All' as ((Pt & Bent) & Pass). apply Z.ltb_lt, IZR_lt in Pt. set (s := IZR (top e)) in *.
    destruct (Ok _ e _ _ Pass) as (_ & g & Gr & Gs & _ & Gb & U & Lt).
    change (sheet_of d ok) with S in Gr, Gs, Gb, U, Lt.
    assert (E : scaled_up s h = g).
    { apply U.
      - intros u Hu. unfold scaled_up, move, zero. rewrite (Hr u Hu). unfold reals, with_rim.
        assert (M : mem u (inside d) = false) by (unfold mem; now destruct in_dec).
        rewrite M. unfold unit, upd, zero. fold s. destruct (Nat.eq_dec u b4) as [->|N].
        + rewrite Nat.eqb_refl. fold s. ring.
        + apply Nat.eqb_neq in N. rewrite N. ring.
      - intros v Hv. rewrite K_scaled, (Hs v Hv) by assumption. ring.
      - intros v Hv. destruct (Hn v Hv) as (P & Q). rewrite K_scaled, K2_scaled by assumption. split.
        + repeat apply Rmult_le_pos; lra.
        + replace (sign (e v) * (s * K2 S v (cone S v) h)) with (s * (sign (e v) * K2 S v (cone S v) h)) by ring.
          apply Rmult_le_pos; lra. }
    exists s. split; [assumption|]. split.
    - intros v Hv. change (inner S) with (inside d) in Hv. rewrite Hubs in Hv. apply in_map_iff in Hv.
      destruct Hv as (b & <- & Hb). pose proof (Gb b Hb (Bent b Hb)) as Gn. rewrite <- E, K2_scaled in Gn.
      apply (Rmult_lt_reg_l s); [assumption|]. lra.
    - intros f i j l m valley Hf En As. specialize (Lt f i j l m valley Hf En As). rewrite <- E, bend_scaled in Lt.
      apply (Rmult_lt_reg_l s); [assumption|]. lra. }
  assert (NF : forall h, representative S b4 h -> forall v, In v (inner S) -> ~ flat_star S v h).
  { intros h Rh v Hv Fl. destruct (Near h Rh (signs_of S h)) as (s & Ps & Sg & _).
    - apply sign_vectors_all. intros u Hu. unfold signs_of. now destruct in_dec.
    - apply signs_of_nappes. intros u Hu. destruct Rh as (_ & Hs). rewrite (Hs u Hu). lra.
    - specialize (Sg v Hv). rewrite K2_sym, (flat_null S v h Hv Fl) in Sg. lra. }
  apply negb_true_iff, Z.eqb_neq in Cor.
  destruct (branches S b1 b2 b3 b4 Rim) as (l & Len & D & Rep & Signs & Complete).
  { change (cross (sub (at_R d b2) (at_R d b1)) (sub (at_R d b3) (at_R d b1)) <> 0). rewrite cross_IZR.
    intros E. apply Cor. now apply eq_IZR. }
  { exact NF. }
  exists l. split; [exact Len|]. split; [exact D|]. split; [exact Rep|]. split.
  { intros h Hh. apply Rep in Hh. apply simple_iff_no_flat_star; [now destruct Hh|now apply NF]. }
  split; [exact Signs|].
  split; [exact Complete|].
  intros e h f i j l' m valley He Rh Sg Hf En As. destruct (Near h Rh e He) as (s & _ & _ & Lt).
  - intros v Hv. destruct Rh as (_ & Hs). rewrite (Hs v Hv). specialize (Sg v Hv). split; lra.
  - exact (Lt f i j l' m valley Hf En As).
Qed.
End All.

(** ** Sheets with a reflex corner

    The drawing is that of the sheet whose notch is closed: its first triangle has the corners [r], and two on
    the rim; the other triangles are those of the sheet with the notch. *)

Lemma link_other a b c fs v : v <> a -> v <> b -> v <> c -> link ((a, b, c) :: fs) v = link fs v.
Proof.
  intros Na Nb Nc. unfold link. cbn [corners flat_map app filter].
  apply not_eq_sym, Nat.eqb_neq in Na, Nb, Nc. now rewrite Na, Nb, Nc.
Qed.

Section Notched.
Variable d : drawing.
Variable p : prepared.
Variable r : nat.

(** The first triangle closes the notch at [r]. *)
Definition closes : bool :=
  match triangles d, border d with
  | (a, b, c) :: _, [b1; b2; b3] =>
    Nat.eqb a r && mem b (border d) && mem c (border d) && mem r (inside d) && negb (zcross d b1 b2 b3 =? 0)%Z
  | _, _ => false
  end.

(** What it means: [opened] are the faces of the sheet with the notch. *)
Definition notch_closed (ok : check d = true) (opened : list face) : Prop :=
  let S := sheet_of d ok in exists b c b1 b2 b3,
    triangles d = (r, b, c) :: opened /\ In b (rim S) /\ In c (rim S) /\ In r (inner S) /\ rim S = [b1; b2; b3] /\
    cross (sub (at_ S b2) (at_ S b1)) (sub (at_ S b3) (at_ S b1)) <> 0.

Lemma closes_means (ok : check d = true) : closes = true -> exists opened, notch_closed ok opened.
Proof.
  unfold closes, notch_closed. destruct (triangles d) as [|[[a b] c] opened]; [easy|].
  destruct (border d) as [|b1 [|b2 [|b3 [|b4 l]]]] eqn:Rim; try easy.
  rewrite !andb_true_iff, Nat.eqb_eq, !mem_in. intros ((((-> & Hb) & Hc) & Hr) & Cor).
  exists opened, b, c, b1, b2, b3. cbn [rim inner at_ sheet_of]. rewrite Rim. repeat split; try assumption.
  change (cross (sub (at_R d b2) (at_R d b1)) (sub (at_R d b3) (at_R d b1)) <> 0). rewrite cross_IZR.
  apply negb_true_iff, Z.eqb_neq in Cor. intros E. apply Cor. now apply eq_IZR.
Qed.

(** At the vertices inside the sheet with the notch its faces alone give the curvature. *)
Lemma opened_curvature ok opened v z : notch_closed ok opened -> In v (others (sheet_of d ok) r) ->
  faces_curvature (at_ (sheet_of d ok)) opened v z = KC (sheet_of d ok) v z.
Proof.
  intros (b & c & b1 & b2 & b3 & Tr & Hb & Hc & Hr & _) Hv. apply others_in in Hv. destruct Hv as (Hv & N).
  rewrite <- faces_curvature_fan by now apply inner_vertex. cbn [faces sheet_of]. rewrite Tr.
  unfold faces_curvature. rewrite link_other; [reflexivity|assumption| |];
    intros ->; revert Hv; now apply rim_not_inner.
Qed.

(** A test with [r] up whose rim is at height 0 is one of a representative. *)
Lemma raised_means ok (up : nat -> bool) h asked : In r (inside d) -> (forall u, ~ In u (inside d) -> h u = 0%Z) ->
  0 < K (sheet_of d ok) r (reals h) -> proved d p ok (fun v => Nat.eqb v r) (with_r r up) h asked ->
  let S := sheet_of d ok in
  exists g, raised S r g /\ in_nappes S (with_r r up) g /\
    (forall b, In b (hubs p) -> is_bent asked b = true ->
      0 < sign (with_r r up (at_vertex b)) * K2 S (at_vertex b) (cone S (at_vertex b)) g) /\
    (forall g', raised S r g' -> in_nappes S (with_r r up) g' -> g' = g) /\
    (forall f i j l m valley, In f (folds p) -> ends f = (i, j, l, m) -> asked (name f) = Some valley ->
      0 < sign valley * bend S i j l m g).
Proof.
  intros Hr Rim Pk (g & Gr & Gs & Gn & Gb & _ & Lt). cbv zeta. set (S := sheet_of d ok) in *.
  set (k := K S r (reals h)) in *. set (s := sqrt k). assert (Ps : 0 < s) by now apply sqrt_lt_R0.
  assert (Ss : s * s = k) by (apply sqrt_sqrt; lra). assert (Pt : 0 < / s) by now apply Rinv_0_lt_compat.
  assert (Hr' : In r (inner S)) by exact Hr.
  assert (Nap : in_nappes S (with_r r up) (scaled_up (/ s) g)).
  { intros v Hv. destruct (Gn v Hv) as (P & Q). rewrite K_scaled, K2_scaled by assumption. split.
    - repeat apply Rmult_le_pos; lra.
    - replace (sign _ * (/ s * _)) with (/ s * (sign (with_r r up v) * K2 S v (cone S v) g)) by ring.
      apply Rmult_le_pos; lra. }
  assert (Rg : raised S r (scaled_up (/ s) g)).
  { assert (Sol : solves S (one_at r) (scaled_up (/ s) g)).
    { intros v Hv. rewrite K_scaled, (Gs v Hv) by assumption. unfold one_at.
      destruct (Nat.eqb_spec v r) as [->|N]; [|ring]. fold k. rewrite <- Ss. field. lra. }
    split; [|split; [exact Sol|]].
    - intros u Hu. unfold scaled_up, move, zero. rewrite (Gr u Hu). unfold reals. rewrite (Rim u Hu). ring.
    - assert (Pr : 0 < K S r (scaled_up (/ s) g)) by (rewrite (Sol r Hr'), one_at_r; lra).
      pose proof (r_pops S r Hr' _ Pr) as N0. destruct (Nap r Hr') as (_ & Q). unfold with_r in Q.
      rewrite Nat.eqb_refl in Q. simpl in Q. lra. }
  exists (scaled_up (/ s) g). split; [exact Rg|]. split; [exact Nap|]. split; [|split].
  - intros b Hb Bn. specialize (Gb b Hb Bn). rewrite K2_scaled.
    replace (sign _ * (/ s * _)) with
      (/ s * (sign (with_r r up (at_vertex b)) * K2 S (at_vertex b) (cone S (at_vertex b)) g)) by ring.
    now apply Rmult_lt_0_compat.
  - intros g' Rg' Ng'. destruct (one_raised S r Hr' up) as (x & _ & U).
    rewrite <- (U g' (conj Rg' Ng')). now apply U.
  - intros f i j l m valley Hf En As. specialize (Lt f i j l m valley Hf En As). rewrite bend_scaled.
    replace (sign valley * (/ s * _)) with (/ s * (sign valley * bend S i j l m g)) by ring.
    now apply Rmult_lt_0_compat.
Qed.

(** Heights inside, the rim at height 0. *)
Definition on_zero (h : zheights) : zheights := fun u => if mem u (inside d) then h u else 0%Z.

Lemma on_zero_off h u : ~ In u (inside d) -> on_zero h u = 0%Z.
Proof. intros N. unfold on_zero. destruct (mem u (inside d)) eqn:M; [|reflexivity]. now apply mem_in in M. Qed.

Definition raised_passes (up : nat -> bool) (h : zheights) (asked : nat -> letter) : bool :=
  passes p (fun v => Nat.eqb v r) (with_r r up) (on_zero h) asked.

Definition verify_one_notched (up : nat -> bool) (h : zheights) (asked : nat -> letter) : bool :=
  sound d p && closes && raised_passes up h asked.

(** Exactly one branch has these signs where [r] pops up; it has the letters that were asked for. *)
Theorem one_notched_verified up h asked : verify_one_notched up h asked = true ->
  exists (ok : check d = true) opened, notch_closed ok opened /\ let S := sheet_of d ok in
  exists g, raised S r g /\ in_nappes S (with_r r up) g /\
    (forall b, In b (hubs p) -> is_bent asked b = true ->
      0 < sign (with_r r up (at_vertex b)) * K2 S (at_vertex b) (cone S (at_vertex b)) g) /\
    (forall g', raised S r g' -> in_nappes S (with_r r up) g' -> g' = g) /\
    (forall f i j l m valley, In f (folds p) -> ends f = (i, j, l, m) -> asked (name f) = Some valley ->
      0 < sign valley * bend S i j l m g).
Proof.
  unfold verify_one_notched, raised_passes. rewrite !andb_true_iff. intros ((So & Cl) & Pass).
  destruct (sound_means d p So) as (ok & _ & H). destruct (H _ _ _ _ Pass) as (Pos & Pr).
  destruct (closes_means ok Cl) as (opened & Op). exists ok, opened. split; [exact Op|].
  destruct Op as (_ & _ & _ & _ & _ & _ & _ & _ & Hr & _).
  apply (raised_means ok up (on_zero h)); [exact Hr|apply on_zero_off|now apply Pos|exact Pr].
Qed.

(** A test of all sign vectors of the vertices inside the sheet with the notch. *)
Variable given : (nat -> bool) -> zheights.
Variable asked : (nat -> bool) -> nat -> letter.

Definition verify_all_notched : bool :=
  sound d p && closes && every (filter (fun v => negb (Nat.eqb v r)) (inside d)) (fun e =>
    forallb (fun b => Nat.eqb (at_vertex b) r || is_bent (asked e) b) (hubs p) && raised_passes e (given e) (asked e)).

(** Exactly 2^n branches, complex ones included, all real and simple, one for each sign vector, with the
    letters that were asked for. The equations are those of the faces [opened]. *)
Theorem all_notched_verified : verify_all_notched = true ->
  exists (ok : check d = true) opened, notch_closed ok opened /\
  let S := sheet_of d ok in exists l : list vec,
    length l = (2 ^ length (others S r))%nat /\ NoDup l /\
    (forall h, In h l <-> raised S r h) /\
    (forall h, In h l -> nonsingular S h) /\
    (forall e, exists! h, In h l /\ has_open_signs S r e h) /\
    (forall z, (forall v, In v (others S r) -> faces_curvature (at_ S) opened v z = real 0) -> complex_affine S z \/
       exists h, In h l /\ (exists s, on_branch S z s h) /\
         forall h' s', In h' l -> on_branch S z s' h' -> h' = h) /\
    (forall e h f i j l m valley, In e (sign_vectors (others S r)) -> raised S r h -> has_open_signs S r e h ->
       In f (folds p) -> ends f = (i, j, l, m) -> asked e (name f) = Some valley ->
       0 < sign valley * bend S i j l m h).
Proof.
  unfold verify_all_notched. rewrite !andb_true_iff. intros ((So & Cl) & All).
  destruct (sound_means d p So) as (ok & Hubs & Ok). destruct (closes_means ok Cl) as (opened & Op).
  exists ok, opened. split; [exact Op|]. set (S := sheet_of d ok). assert (All' := every_all _ _ All).
  assert (Hr : In r (inner S)) by (destruct Op as (? & ? & ? & ? & ? & _ & _ & _ & Hr & _); exact Hr).
  assert (Near : forall h, raised S r h -> forall e, In e (sign_vectors (others S r)) -> in_nappes S (with_r r e) h ->
    has_open_signs S r e h /\ forall f i j l m valley,
      In f (folds p) -> ends f = (i, j, l, m) -> asked e (name f) = Some valley -> 0 < sign valley * bend S i j l m h).
  { intros h Rh e He Hn. specialize (All' e He). cbv beta in All'. rewrite andb_true_iff, forallb_forall in All'.
    destruct All' as (Bent & Pass). destruct (Ok _ _ _ _ Pass) as (Pos & Pr).
    destruct (raised_means ok e _ _ Hr (on_zero_off (given e)) (Pos r Hr) Pr) as (g & _ & _ & Gb & U & Lt).
    change (sheet_of d ok) with S in Gb, U, Lt. rewrite (U h Rh Hn). split; [|exact Lt].
    intros v Hv. apply others_in in Hv. destruct Hv as (Hv & N). change (inner S) with (inside d) in Hv.
    rewrite Hubs in Hv. apply in_map_iff in Hv. destruct Hv as (b & <- & Hb). apply Nat.eqb_neq in N.
    specialize (Bent b Hb). rewrite N in Bent. specialize (Gb b Hb Bent). unfold with_r in Gb. now rewrite N in Gb. }
  assert (NF : forall h, raised S r h -> forall v, In v (others S r) -> ~ flat_star S v h).
  { intros h Rh v Hv Fl. set (e := fun u => if in_dec Nat.eq_dec u (others S r) then signs_of S h u else false).
    destruct (Near h Rh e) as (Sg & _).
    - apply sign_vectors_all. intros u Hu. unfold e. now destruct in_dec.
    - apply raised_nappes; [assumption|]. intros u Hu. unfold e. destruct in_dec as [_|]; [|contradiction].
      assert (Pos : forall w, In w (inner S) -> 0 <= K S w h).
      { intros w Hw. destruct Rh as (_ & Sh & _). rewrite (Sh w Hw). apply one_at_nonneg. }
      apply others_in in Hu. now apply (signs_of_nappes S h Pos).
    - specialize (Sg v Hv). apply others_in in Hv. rewrite K2_sym, (flat_null S v h) in Sg by tauto. lra. }
  pose proof Op as (_ & _ & b1 & b2 & b3 & _ & _ & _ & _ & Rim & Cor).
  destruct (notched S b1 b2 b3 r Rim Cor Hr NF) as (l & Len & D & Rep & Sim & Signs & Complete).
  exists l. split; [exact Len|]. split; [exact D|]. split; [exact Rep|].
  split; [exact Sim|]. split; [exact Signs|]. split.
  - intros z Hz. apply Complete. intros v Hv.
    rewrite <- (Hz v Hv). symmetry. exact (opened_curvature ok opened v z Op Hv).
  - intros e h f i j l' m valley He Rh Sg Hf En As. destruct (Near h Rh e He) as (_ & Lt).
    + apply raised_nappes; [assumption|]. intros v Hv. apply Rlt_le. now apply Sg.
    + exact (Lt f i j l' m valley Hf En As).
Qed.
End Notched.
