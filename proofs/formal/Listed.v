(** All branches of a sheet with four corners, one after the other: flat stars, multiplicities and triangulated
    triangles are allowed. *)
From Coq Require Import Reals ZArith List Lra Lia Arith Bool FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Nappes Sheet Star KeyLemma Flat Complex Theorems Branches Patterns
  Triangles Drawing Tables Rational Certificate Integers Verify Emptied Exact Space Within
  Flex Ways.
Import ListNotations.
Open Scope R_scope.

(** Heights inside with slightly positive curvatures, or a space with a solution; exact heights are a space
    without unknowns. *)
Inductive evidence := Near (h : zheights) | Within (sp : space).

(** What is claimed of a branch: signs, [None] where a star is flat; letters, [Some None] of a flat fold; the
    multiplicity. [top] is the height of the last corner in the evidence; with a reflex corner [rise] is the sign of its
    height, [Some None] if it is 0. *)
Record root := Root {
  signs_of : nat -> option bool;
  letters_of : nat -> option letter;
  times : nat;
  top : Z;
  rise : option letter;
  found : evidence
}.

Definition up_of (r : root) (v : nat) : bool := match signs_of r v with Some e => e | None => true end.
Definition asked_of (r : root) (k : nat) : letter := match letters_of r k with Some w => w | None => None end.
Definition is_flat (r : root) (v : nat) : bool := match signs_of r v with None => true | Some _ => false end.

Section Listed.
Variable d : drawing.
Variable p : prepared.
Variable common : list face.
Variable parts : list part.

(** The vertices inside the sheet of the file: those that are left, and those in triangulated triangles. *)
Definition every_inside : list nat := inside d ++ flat_map hidden parts.

Definition near_ok (b4 : nat) (r : root) (h : zheights) : bool :=
  (0 <? top r)%Z && forallb (fun v => negb (is_flat r v)) (inside d) &&
  forallb (fun f => match letters_of r (name f) with Some None => false | _ => true end) (folds p) &&
  forallb (is_bent (asked_of r)) (hubs p) &&
  passes p (fun _ => false) (up_of r) (with_rim d b4 (top r) h) (asked_of r).

Definition root_ok (b4 : nat) (r : root) : bool :=
  Nat.eqb (times r) (2 ^ length (flats signs_of every_inside r)) && forallb (is_flat r) (flat_map hidden parts) &&
  match found r with
  | Near h => near_ok b4 r h
  | Within sp => (0 <? top r)%Z && in_space d p b4 (top r) sp (signs_of r) (letters_of r) (fun _ => false) b4 None
  end.

Definition verify_listed (roots : list root) : bool :=
  match border d with
  | [b1; b2; b3; b4] =>
    sound d p && negb (zcross d b1 b2 b3 =? 0)%Z && emptied d (triangles d) common parts &&
    splits signs_of (inside d) roots && forallb (root_ok b4) roots
  | _ => false
  end.

Definition has_letters S (r : root) (h : vec) : Prop := forall f i j l m w,
  In f (folds p) -> ends f = (i, j, l, m) -> letters_of r (name f) = Some w ->
  match w with Some valley => 0 < sign valley * bend S i j l m h | None => bend S i j l m h = 0 end.

(** A multiple of heights is a representative. *)
Lemma scaled_shown S b4 r t g : 0 < t -> (forall u, ~ In u (inner S) -> g u = t * unit b4 u) ->
  solves S (fun _ => 0) g ->
  (forall v e, In v (inner S) -> signs_of r v = Some e -> 0 < sign e * K2 S v (cone S v) g) ->
  (forall v, In v (inner S) -> signs_of r v = None -> flat_star S v g) -> has_letters S r g ->
  shown S b4 signs_of r (scaled_up (/ t) g) /\ has_letters S r (scaled_up (/ t) g).
Proof.
  intros Pt Gr Gs Sg Fl Lt. assert (Pi : 0 < / t) by now apply Rinv_0_lt_compat. split; [split; [split|split]|].
  - intros u Hu. unfold scaled_up, move, zero. rewrite Gr by assumption. field. lra.
  - intros v Hv. rewrite K_scaled, Gs by assumption. ring.
  - intros v e Hv E. rewrite K2_scaled. replace (_ * (/ t * _)) with (/ t * (sign e * K2 S v (cone S v) g)) by ring.
    apply Rmult_lt_0_compat; auto.
  - intros v Hv E. apply flat_star_iff; [assumption|]. intros z. rewrite K2_sym, K2_scaled, K2_sym.
    rewrite (flat_null S v g Hv (Fl v Hv E)). ring.
  - intros f i j l m w Hf E As. specialize (Lt f i j l m w Hf E As). rewrite bend_scaled. destruct w as [valley|].
    + replace (_ * (/ t * _)) with (/ t * (sign valley * bend S i j l m g)) by ring. now apply Rmult_lt_0_compat.
    + rewrite Lt. ring.
Qed.

Lemma root_means (ok : check d = true) b4 r : sound d p = true -> inside d = map at_vertex (hubs p) ->
  (forall kept up h asked, passes p kept up h asked = true ->
    (forall v, In v (inside d) -> 0 < K (sheet_of d ok) v (reals h)) /\ proved d p ok kept up h asked) ->
  ~ In b4 (inside d) -> root_ok b4 r = true ->
  exists h, shown (sheet_of d ok) b4 signs_of r h /\ has_letters (sheet_of d ok) r h.
Proof.
  intros So Hubs Pr Off. unfold root_ok. rewrite !andb_true_iff. intros (_ & Ev).
  destruct (found r) as [h|sp].
  - unfold near_ok in Ev. rewrite !andb_true_iff, !forallb_forall in Ev.
    destruct Ev as ((((Pt & Nf) & Lf) & Bent) & Pass).
    apply Z.ltb_lt, IZR_lt in Pt. apply Pr in Pass. destruct Pass as (_ & g & Gr & Gs & _ & Gb & _ & Lt).
    exists (scaled_up (/ IZR (top r)) g). apply scaled_shown; [exact Pt| |exact Gs| | |].
    + intros u Hu. rewrite (Gr u Hu). change (inner (sheet_of d ok)) with (inside d) in Hu.
      assert (Mu : mem u (inside d) = false) by (unfold mem; now destruct in_dec).
      unfold reals, with_rim. rewrite Mu. unfold unit, upd, zero.
      destruct (Nat.eq_dec u b4) as [->|N]; [rewrite Nat.eqb_refl; ring|]. apply Nat.eqb_neq in N. rewrite N. ring.
    + intros v e Hv E. change (inner (sheet_of d ok)) with (inside d) in Hv. rewrite Hubs in Hv.
      apply in_map_iff in Hv. destruct Hv as (b & <- & Hb). specialize (Gb b Hb (Bent b Hb)).
      unfold up_of in Gb. now rewrite E in Gb.
    + intros v Hv E. specialize (Nf v Hv). unfold is_flat in Nf. now rewrite E in Nf.
    + intros f i j l m w Hf E As. specialize (Lf f Hf). rewrite As in Lf. destruct w as [valley|]; [|discriminate].
      apply (Lt f i j l m valley Hf E). unfold asked_of. now rewrite As.
  - apply andb_prop in Ev. destruct Ev as (Pt & Ev). apply Z.ltb_lt, IZR_lt in Pt.
    destruct (space_solution d p b4 (top r) sp (signs_of r) (letters_of r) _ b4 None ok So Off Ev)
      as (g & Gr & Gs & Sg & Fl & Lt & _).
    exists (scaled_up (/ IZR (top r)) g). apply scaled_shown; try assumption.
    + intros v Hv. now apply Gs.
    + intros v e Hv E. destruct (Sg v e Hv E) as (t & Down & Pos & Side).
      apply (null_side _ _ t); try assumption. now apply Gs.
Qed.

(** What is verified of a branch: its signs, flat stars, letters and multiplicity. The multiplicity is the number of
    sign vectors in whose closed nappes it lies; the vertices inside triangles may have any signs. *)
Definition verified_root S (b4 : nat) (r : root) (h : vec) : Prop :=
  shown S b4 signs_of r h /\ has_letters S r h /\ (nonsingular S h <-> flats signs_of (inside d) r = []) /\
  (forall e, in_nappes S e h <-> agree signs_of every_inside e r = true) /\
  length (filter (fun e => agree signs_of every_inside e r) (sign_vectors every_inside)) = times r.

Lemma NoDup_parts {A} (l l' : list A) : NoDup (l ++ l') -> NoDup l' /\ forall a, In a l -> ~ In a l'.
Proof.
  induction l as [|a l IH]; [easy|]. cbn [app]. intros D. inversion D as [|? ? N D']; subst.
  destruct (IH D') as (D1 & Ap).
  split; [exact D1|]. intros b [<-|Hb]; [|now apply Ap]. intros H. apply N, in_or_app. now right.
Qed.

(** These are all branches, complex ones included; all are real, and their multiplicities add up to 2^n. *)
Theorem listed_verified roots : verify_listed roots = true ->
  exists (ok : check d = true) b1 b2 b3 b4, border d = [b1; b2; b3; b4] /\
  let S := sheet_of d ok in exists hs : list vec,
    Forall2 (verified_root S b4) roots hs /\ NoDup hs /\
    (forall h, In h hs <-> representative S b4 h) /\
    list_sum (map times roots) = (2 ^ length every_inside)%nat /\
    (forall z, file_solution d (inside d) common parts z ->
       (forall q, In q parts -> flat_in d z q) /\ (complex_affine S z \/
       exists h, In h hs /\ (exists s, on_branch S z s h) /\
         forall h' s', In h' hs -> on_branch S z s' h' -> h' = h)) /\
    (forall z, complex_solution S z -> (forall q, In q parts -> flat_in d z q) ->
       file_solution d (inside d) common parts z).
Proof.
  unfold verify_listed. destruct (border d) as [|b1 [|b2 [|b3 [|b4 [|b5 t]]]]] eqn:Rim; try discriminate.
  rewrite !andb_true_iff, forallb_forall. intros ((((So & Cor) & Em) & Sp) & Roots).
  destruct (sound_means d p So) as (ok & Hubs & Pr). exists ok, b1, b2, b3, b4. split; [reflexivity|].
  set (S := sheet_of d ok).
  assert (Cor' : cross (sub (at_ S b2) (at_ S b1)) (sub (at_ S b3) (at_ S b1)) <> 0).
  { apply negb_true_iff, Z.eqb_neq in Cor.
    change (cross (sub (at_R d b2) (at_R d b1)) (sub (at_R d b3) (at_R d b1)) <> 0). rewrite cross_IZR.
    intros E. apply Cor. now apply eq_IZR. }
  assert (Off : ~ In b4 (inside d)).
  { apply (rim_not_inner S). change (In b4 (border d)). rewrite Rim. simpl. auto 6. }
  pose proof (splits_one signs_of (inside d) roots Sp) as One.
  assert (Once : NoDup every_inside).
  { unfold emptied in Em. cbv zeta in Em. rewrite !andb_true_iff in Em. destruct Em as ((_ & Fr) & _).
    destruct (fresh_NoDup _ _ Fr) as (D & _). apply NoDup_parts in D. destruct D as (DH & Ap).
    apply NoDup_app_intro; [exact (inner_once S)|exact DH|]. intros v Hv. apply Ap, in_or_app. now left. }
  assert (More : forall r, In r roots -> forall e, agree signs_of every_inside e r = agree signs_of (inside d) e r).
  { intros r Hr e. apply agree_more. intros v Hv. specialize (Roots r Hr). unfold root_ok in Roots.
    rewrite !andb_true_iff, forallb_forall in Roots. destruct Roots as ((_ & Fl) & _). specialize (Fl v Hv).
    unfold is_flat in Fl. now destruct (signs_of r v). }
  assert (Ex : exists hs, Forall2 (verified_root S b4) roots hs).
  { assert (Each : forall r, In r roots -> exists h, verified_root S b4 r h).
    { intros r Hr. destruct (root_means ok b4 r So Hubs Pr Off (Roots r Hr)) as (h & Sh & Lt). exists h.
      split; [exact Sh|]. split; [exact Lt|]. split; [exact (shown_simple S b4 signs_of r h Sh)|]. split.
      - intros e. rewrite (More r Hr). exact (shown_nappes S b4 signs_of r h e Sh).
      - rewrite (agree_count signs_of _ r Once). specialize (Roots r Hr). unfold root_ok in Roots.
        rewrite !andb_true_iff, Nat.eqb_eq in Roots. destruct Roots as ((E & _) & _). now symmetry. }
    clear - Each. induction roots as [|r l IH]; [exists []; constructor|].
    destruct (Each r) as (h & Hh); [now left|]. destruct IH as (hs & H); [intros; apply Each; now right|].
    exists (h :: hs). now constructor. }
  destruct Ex as (hs & Hs). exists hs.
  assert (Sh : Forall2 (shown S b4 signs_of) roots hs).
  { clear - Hs. induction Hs as [|r h l hs (H & _) _ IH]; now constructor. }
  destruct (listed S b1 b2 b3 b4 Rim Cor' signs_of roots hs One Sh) as (D & Rep & Complete).
  pose proof (emptied_verified d (inside d) (triangles d) common parts Em (fun v H => H)) as E.
  assert (Eq : forall v z, In v (inside d) -> faces_curvature (at_R d) (triangles d) v z = KC S v z).
  { intros v z Hv. apply (faces_curvature_fan S). apply in_or_app. now left. }
  split; [exact Hs|]. split; [exact D|]. split; [exact Rep|]. split; [|split].
  - rewrite <- (all_counted signs_of every_inside roots Once).
    + f_equal. clear - Roots. induction roots as [|r l IH]; [reflexivity|]. cbn [map]. f_equal.
      * specialize (Roots r (or_introl eq_refl)). unfold root_ok in Roots. rewrite !andb_true_iff, Nat.eqb_eq in Roots.
        now destruct Roots as ((E & _) & _).
      * apply IH. intros x Hx. apply Roots. now right.
    + intros e. destruct (One e) as (r & Er). exists r. rewrite <- Er. apply filter_ext_in. intros x Hx. now apply More.
  - intros z Hz. apply E in Hz. destruct Hz as (Sol & Fl). split; [exact Fl|]. apply Complete.
    intros v Hv. rewrite <- Eq by exact Hv. now apply Sol.
  - intros z Hz Fl. apply E. split; [|exact Fl]. intros v Hv. rewrite Eq by exact Hv. now apply Hz.
Qed.
End Listed.

(** If no star is flat on any branch, and the sheet is a disk, these are the ways to fold. *)
Theorem listed_continue d p common parts roots ms : verify_listed d p common parts roots = true ->
  (forall r, In r roots -> flats signs_of (inside d) r = []) -> moves_as_a_disk d (inside d) (triangles d) ms = true ->
  exists (ok : check d = true) b1 b2 b3 b4, border d = [b1; b2; b3; b4] /\ these_ways_only (sheet_of d ok) b1 b2 b4.
Proof.
  intros V NF M. destruct (listed_verified d p common parts roots V)
    as (ok & b1 & b2 & b3 & b4 & Rim & hs & Hs & _ & Rep & _).
  exists ok, b1, b2, b3, b4. split; [exact Rim|]. unfold moves_as_a_disk in M. apply andb_prop in M.
  apply (near_flat _ b1 b2 b3 b4); [exact Rim| |exact (disk_checked d (inside d) ok (triangles d) ms (proj2 M))|].
  - unfold verify_listed in V. rewrite Rim, !andb_true_iff, negb_true_iff, Z.eqb_neq in V.
    destruct V as ((((_ & N) & _) & _) & _).
    change (cross (sub (at_R d b2) (at_R d b1)) (sub (at_R d b3) (at_R d b1)) <> 0). rewrite cross_IZR.
    intros E. apply N. now apply eq_IZR.
  - intros h Hh v Hv Fl. apply Rep in Hh. clear - Hs Hh NF Hv Fl.
    induction Hs as [|r g l hs (_ & _ & Simple & _) _ IH]; [easy|]. destruct Hh as [->|Hh].
    + apply (jacobian_singular _ h v Hv Fl), Simple, NF. now left.
    + apply IH; [intros x Hx; apply NF; now right|exact Hh].
Qed.
