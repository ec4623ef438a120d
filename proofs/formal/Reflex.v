(** All branches of a sheet with a reflex corner, one after the other, as in Listed.v. *)
From Coq Require Import Reals ZArith List Lra Lia Arith Bool FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Nappes Sheet Star KeyLemma Flat Complex Theorems Branches Patterns Notch
  Triangles Drawing Tables Rational Certificate Integers Verify Emptied Exact Space Within Listed.
Import ListNotations.
Open Scope R_scope.

(** ** Representatives on which the corner [r] pops up *)

Section Raised.
Variable S : sheet.
Variable r : nat.
Hypothesis Hr : In r (inner S).
Context {A : Type}.
Variable signs : A -> nat -> option bool.

Definition shown_raised (a : A) (h : vec) : Prop := raised S r h /\
  (forall v e, In v (others S r) -> signs a v = Some e -> 0 < sign e * K2 S v (cone S v) h) /\
  (forall v, In v (others S r) -> signs a v = None -> flat_star S v h).

Lemma raised_null h v : raised S r h -> In v (others S r) -> K S v h = 0.
Proof.
  intros (_ & Sol & _) Hv. apply others_in in Hv. destruct Hv as (Hv & N). rewrite (Sol v Hv). unfold one_at.
  apply Nat.eqb_neq in N. now rewrite N.
Qed.

Lemma raised_agrees a h e : shown_raised a h -> (in_nappes S (with_r r e) h <-> agree signs (others S r) e a = true).
Proof.
  intros (Ra & Sg & Fl). unfold agree. rewrite forallb_forall. split.
  - intros Hn v Hv. pose proof Hv as Ho. apply others_in in Ho. destruct Ho as (Hi & N). destruct (Hn v Hi) as (_ & P).
    unfold with_r in P. apply Nat.eqb_neq in N. rewrite N in P. unfold fits.
    destruct (signs a v) as [s|] eqn:E; [|reflexivity].
    specialize (Sg v s Hv E). destruct s, (e v); simpl in *; try reflexivity; lra.
  - intros Ag. apply raised_nappes; [assumption|]. intros v Hv. specialize (Ag v Hv). unfold fits in Ag.
    destruct (signs a v) as [s|] eqn:E.
    + apply Bool.eqb_prop in Ag. rewrite <- Ag. apply Rlt_le. now apply Sg.
    + pose proof Hv as Ho. apply others_in in Ho. destruct Ho as (Hi & _).
      rewrite K2_sym, (flat_null S v h Hi (Fl v Hv E)). lra.
Qed.

Lemma raised_simple a h : shown_raised a h -> (nonsingular S h <-> flats signs (others S r) a = []).
Proof.
  intros (Ra & Sg & Fl). unfold flats. split.
  - intros NS. destruct (filter _ (others S r)) as [|v l] eqn:E; [reflexivity|exfalso].
    assert (Hv : In v (filter (fun v => match signs a v with None => true | Some _ => false end) (others S r)))
      by (rewrite E; now left).
    apply filter_In in Hv. destruct Hv as (Hv & N). destruct (signs a v) eqn:Sv; [discriminate|].
    apply (jacobian_singular S h v); [now apply others_in in Hv|now apply Fl|exact NS].
  - intros E. apply jacobian_nonsingular. intros v Hv. destruct (Nat.eq_dec v r) as [->|N].
    + left. destruct Ra as (_ & Sol & _). rewrite (Sol r Hr), one_at_r. lra.
    + right. assert (Ho : In v (others S r)) by now apply others_in. split; [now apply raised_null|]. intros F.
      destruct (signs a v) as [s|] eqn:Sv.
      * specialize (Sg v s Ho Sv). rewrite K2_sym, (flat_null S v h Hv F) in Sg. lra.
      * assert (H : In v []); [|easy]. rewrite <- E. apply filter_In. now rewrite Sv.
Qed.

Theorem raised_listed l hs : (forall e, exists a, filter (agree signs (others S r) e) l = [a]) ->
  Forall2 shown_raised l hs -> NoDup hs /\ forall h, In h hs <-> raised S r h.
Proof.
  apply (all_listed signs (others S r) (raised S r) (fun e => in_nappes S (with_r r e)) shown_raised).
  - now intros a h (R & _).
  - exact raised_agrees.
  - intros h Rh. exists (Theorems.signs_of S h). apply raised_nappes; [assumption|].
    assert (Pos : forall w, In w (inner S) -> 0 <= K S w h).
    { intros w Hw. destruct Rh as (_ & Sh & _). rewrite (Sh w Hw). apply one_at_nonneg. }
    intros u Hu. apply others_in in Hu. now apply (signs_of_nappes S h Pos).
  - intros e h h' Rh Rh' Hn Hn'. destruct (one_raised S r Hr e) as (x & _ & U). rewrite <- (U h), <- (U h'); auto.
Qed.

(** Heights over a rim at height 0 that are on the upper side of a mountain at [r], and have curvature 0 elsewhere, are
    multiples of a representative. *)
Lemma raised_multiple g t : zero_off (inner S) g -> (forall v, In v (others S r) -> K S v g = 0) ->
  (forall u, In u (fan S r) -> t u < t r) -> 0 < K2 S r t t -> 0 < K2 S r t g ->
  exists s, 0 < s /\ raised S r (scaled_up s g).
Proof.
  intros Zg Null Down Pt Side.
  assert (Pk : 0 < K S r g).
  { destruct (Rlt_le_dec 0 (K S r g)) as [|N]; [assumption|exfalso].
    assert (Z : g = zero).
    { apply (key_lemma S); [assumption|]. intros v Hv. destruct (Nat.eq_dec v r) as [->|Nr]; [assumption|].
      rewrite Null; [lra|now apply others_in]. }
    rewrite Z, (linear_zero (K2 S r t)) in Side; [lra|]. intros a s b. apply K2_move. }
  assert (Up : 0 < K2 S r (cone S r) g).
  { replace (K2 S r (cone S r) g) with (1 * K2 S r (cone S r) g) by ring.
    apply (side_by_mountain S r t); try assumption; [|lra]. rewrite K_polar_sheet; [assumption|].
    apply in_or_app. now left. }
  set (q := sqrt (K S r g)). assert (Pq : 0 < q) by now apply sqrt_lt_R0.
  assert (Qq : q * q = K S r g) by (apply sqrt_sqrt; lra). assert (Pi : 0 < / q) by now apply Rinv_0_lt_compat.
  exists (/ q). split; [assumption|]. split; [|split].
  - intros u Hu. unfold scaled_up, move, zero. rewrite (Zg u Hu). ring.
  - intros v Hv. rewrite K_scaled by assumption. unfold one_at. destruct (Nat.eqb_spec v r) as [->|N].
    + rewrite <- Qq. field. lra.
    + rewrite Null; [ring|now apply others_in].
  - rewrite K2_scaled. now apply Rmult_lt_0_compat.
Qed.
End Raised.

(** ** The program *)

Section Reflex.
Variable d : drawing.
Variable p : prepared.
Variable r : nat.
Variable common : list face.
Variable parts : list part.

Definition open_inside : list nat := filter (fun v => negb (Nat.eqb v r)) (inside d).
Definition every_open : list nat := open_inside ++ flat_map hidden parts.
Definition with_corner (x : root) (v : nat) : option bool := if Nat.eqb v r then Some true else signs_of x v.

Definition reflex_ok (b1 : nat) (x : root) : bool :=
  Nat.eqb (times x) (2 ^ length (flats signs_of every_open x)) && forallb (is_flat x) (flat_map hidden parts) &&
  match found x with
  | Near _ => false
  | Within sp => in_space d p b1 0 sp (with_corner x) (letters_of x) (fun v => Nat.eqb v r) r (rise x)
  end.

Definition verify_reflex (roots : list root) : bool :=
  match border d with
  | b1 :: _ =>
    sound d p && closes d r && emptied d (tl (triangles d)) common parts &&
    splits signs_of open_inside roots && forallb (reflex_ok b1) roots
  | _ => false
  end.

(** The sign of the height of the corner, over the other three. *)
Definition rises (x : root) (h : vec) : Prop :=
  match rise x with Some (Some up) => 0 < sign up * h r | Some None => h r = 0 | None => True end.

Lemma reflex_means (ok : check d = true) b1 x : sound d p = true -> In r (inside d) -> ~ In b1 (inside d) ->
  reflex_ok b1 x = true ->
  exists h, shown_raised (sheet_of d ok) r signs_of x h /\ has_letters p (sheet_of d ok) x h /\ rises x h.
Proof.
  intros So Hr Off. unfold reflex_ok. rewrite !andb_true_iff. intros (_ & Ev). destruct (found x) as [|sp]; [easy|].
  set (S := sheet_of d ok).
  destruct (space_solution d p b1 0 sp (with_corner x) (letters_of x) (fun v => Nat.eqb v r) r (rise x) ok So Off Ev)
    as (g & Gr & Gs & Sg & Fl & Lt & Rise). fold S in Gs, Sg, Fl, Lt.
  assert (Null : forall v, In v (others S r) -> K S v g = 0).
  { intros v Hv. apply others_in in Hv. apply Gs; [tauto|]. now apply Nat.eqb_neq. }
  assert (Own : forall v, In v (others S r) -> with_corner x v = signs_of x v).
  { intros v Hv. apply others_in in Hv. unfold with_corner. destruct Hv as (_ & N). apply Nat.eqb_neq in N.
    now rewrite N. }
  assert (Zg : zero_off (inner S) g) by (intros u Hu; rewrite (Gr u Hu); ring).
  destruct (Sg r true Hr) as (t & Down & Pt & Side); [unfold with_corner; now rewrite Nat.eqb_refl|].
  simpl in Side. rewrite Rmult_1_l in Side.
  destruct (raised_multiple S r Hr g t Zg Null Down Pt Side) as (s & Ps & Ra).
  exists (scaled_up s g). split; [split; [exact Ra|split]|split].
  - intros v e Hv E. pose proof Hv as Ho. apply others_in in Ho. destruct Ho as (Hi & _).
    rewrite <- (Own v Hv) in E. destruct (Sg v e Hi E) as (t' & Down' & Pt' & Side').
    rewrite K2_scaled. replace (_ * (s * _)) with (s * (sign e * K2 S v (cone S v) g)) by ring.
    apply Rmult_lt_0_compat; [assumption|]. apply (null_side S v t'); auto.
  - intros v Hv E. pose proof Hv as Ho. apply others_in in Ho. destruct Ho as (Hi & _). rewrite <- (Own v Hv) in E.
    apply flat_star_iff; [assumption|]. intros z. rewrite K2_sym, K2_scaled, K2_sym.
    rewrite (flat_null S v g Hi (Fl v Hi E)). ring.
  - intros f i j l m w Hf E As. specialize (Lt f i j l m w Hf E As). rewrite bend_scaled. destruct w as [valley|].
    + replace (_ * (s * _)) with (s * (sign valley * bend S i j l m g)) by ring. now apply Rmult_lt_0_compat.
    + rewrite Lt. ring.
  - unfold rises, scaled_up, move, zero. destruct (rise x) as [[up|]|]; [|rewrite Rise; ring|exact Logic.I].
    replace (_ * (0 + s * g r)) with (s * (sign up * g r)) by ring. now apply Rmult_lt_0_compat.
Qed.

(** What is verified of a branch, seen from the side on which [r] pops up. *)
Definition verified_raised S (x : root) (h : vec) : Prop :=
  shown_raised S r signs_of x h /\ has_letters p S x h /\ rises x h /\
  (nonsingular S h <-> flats signs_of open_inside x = []) /\
  (forall e, in_nappes S (with_r r e) h <-> agree signs_of every_open e x = true) /\
  length (filter (fun e => agree signs_of every_open e x) (sign_vectors every_open)) = times x.

Theorem reflex_verified roots : verify_reflex roots = true ->
  exists (ok : check d = true), notch_closed d r ok (tl (triangles d)) /\
  let S := sheet_of d ok in exists hs : list vec,
    Forall2 (verified_raised S) roots hs /\ NoDup hs /\
    (forall h, In h hs <-> raised S r h) /\
    list_sum (map times roots) = (2 ^ length every_open)%nat /\
    (forall z, file_solution d open_inside common parts z ->
       (forall q, In q parts -> flat_in d z q) /\ (complex_affine S z \/
       exists h, In h hs /\ (exists s, on_branch S z s h) /\
         forall h' s', In h' hs -> on_branch S z s' h' -> h' = h)) /\
    (forall z, open_solution S r z -> (forall q, In q parts -> flat_in d z q) ->
       file_solution d open_inside common parts z).
Proof.
  unfold verify_reflex. destruct (border d) as [|b1 rim'] eqn:Bd; [easy|].
  rewrite !andb_true_iff, forallb_forall. intros ((((So & Cl) & Em) & Sp) & Roots).
  destruct (sound_means d p So) as (ok & _ & _). destruct (closes_means d r ok Cl) as (opened & Op). exists ok.
  assert (Tl : tl (triangles d) = opened).
  { destruct Op as (b & c & x1 & x2 & x3 & Tr & _). now rewrite Tr. }
  rewrite Tl in *. split; [exact Op|]. set (S := sheet_of d ok).
  pose proof Op as (_ & _ & x1 & x2 & x3 & _ & _ & _ & Hr & Rim & Cor).
  assert (Off : ~ In b1 (inside d)).
  { apply (rim_not_inner S). change (In b1 (border d)). rewrite Bd. now left. }
  pose proof (splits_one signs_of open_inside roots Sp) as One.
  assert (Once : NoDup every_open).
  { unfold emptied in Em. cbv zeta in Em. rewrite !andb_true_iff in Em. destruct Em as ((_ & Fr) & _).
    destruct (fresh_NoDup _ _ Fr) as (D & _). apply NoDup_parts in D. destruct D as (DH & Ap).
    apply NoDup_app_intro; [apply NoDup_filter; exact (inner_once S)|exact DH|].
    intros v Hv. apply Ap, in_or_app. left. now apply filter_In in Hv. }
  assert (More : forall x, In x roots -> forall e, agree signs_of every_open e x = agree signs_of open_inside e x).
  { intros x Hx e. apply agree_more. intros v Hv. specialize (Roots x Hx). unfold reflex_ok in Roots.
    rewrite !andb_true_iff, forallb_forall in Roots. destruct Roots as ((_ & Fl) & _). specialize (Fl v Hv).
    unfold is_flat in Fl. now destruct (signs_of x v). }
  assert (Ex : exists hs, Forall2 (verified_raised S) roots hs).
  { assert (Each : forall x, In x roots -> exists h, verified_raised S x h).
    { intros x Hx. destruct (reflex_means ok b1 x So Hr Off (Roots x Hx)) as (h & Sh & Lt & Ri). exists h.
      split; [exact Sh|]. split; [exact Lt|]. split; [exact Ri|].
      split; [exact (raised_simple S r Hr signs_of x h Sh)|].
      split.
      - intros e. rewrite (More x Hx). exact (raised_agrees S r signs_of x h e Sh).
      - rewrite (agree_count signs_of _ x Once). specialize (Roots x Hx). unfold reflex_ok in Roots.
        rewrite !andb_true_iff, Nat.eqb_eq in Roots. destruct Roots as ((E & _) & _). now symmetry. }
    clear - Each. induction roots as [|x l IH]; [exists []; constructor|].
    destruct (Each x) as (h & Hh); [now left|]. destruct IH as (hs & H); [intros; apply Each; now right|].
    exists (h :: hs). now constructor. }
  destruct Ex as (hs & Hs). exists hs.
  assert (Sh : Forall2 (shown_raised S r signs_of) roots hs).
  { clear - Hs. induction Hs as [|x h l hs (H & _) _ IH]; now constructor. }
  destruct (raised_listed S r Hr signs_of roots hs One Sh) as (D & Rep).
  assert (Sub : forall v, In v open_inside -> In v (inside d)) by (intros v Hv; now apply filter_In in Hv).
  pose proof (emptied_verified d open_inside opened common parts Em Sub) as E.
  split; [exact Hs|]. split; [exact D|]. split; [exact Rep|]. split; [|split].
  - rewrite <- (all_counted signs_of every_open roots Once).
    + f_equal. clear - Roots. induction roots as [|x l IH]; [reflexivity|]. cbn [map]. f_equal.
      * specialize (Roots x (or_introl eq_refl)). unfold reflex_ok in Roots.
        rewrite !andb_true_iff, Nat.eqb_eq in Roots.
        now destruct Roots as ((E & _) & _).
      * apply IH. intros y Hy. apply Roots. now right.
    + intros e. destruct (One e) as (x & Er). exists x. rewrite <- Er. apply filter_ext_in. intros y Hy. now apply More.
  - intros z Hz. apply E in Hz. destruct Hz as (Sol & Fl). split; [exact Fl|].
    destruct (open_solution_on_a_branch S x1 x2 x3 r Rim Cor Hr z) as [|(s & h & Rh & Oh)]; [|now left|right].
    { intros v Hv. transitivity (faces_curvature (at_R d) opened v z); [|now apply Sol].
      symmetry. exact (opened_curvature d r ok opened v z Op Hv). }
    exists h. split; [now apply Rep|]. split; [now exists s|]. intros h' s' Hh' Oh'. apply Rep in Hh'.
    exact (branch_has_one_raised S x1 x2 x3 r Rim Cor Hr z s s' h h' Rh Hh' Oh Oh').
  - intros z Hz Fl. apply E. split; [|exact Fl]. intros v Hv.
    transitivity (KC S v z); [exact (opened_curvature d r ok opened v z Op Hv)|now apply Hz].
Qed.
End Reflex.
