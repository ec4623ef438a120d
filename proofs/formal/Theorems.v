(** The theorems of docs/theorem.md and docs/branch.md. *)
From Coq Require Import Reals List Permutation Lra Lia Arith FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Nappes Sheet Identities Star KeyLemma Flat Complex.
Import ListNotations.
Open Scope R_scope.

Section Theorems.
Variable S : sheet.
Notation I := (inner S).
Notation n := (length (inner S)).

(** [h] has the heights [r] on the rim. *)
Definition has_rim (r h : vec) : Prop := forall u, ~ In u I -> h u = r u.

(** [h] is a solution of K_v(h) = k_v. *)
Definition solves (k : nat -> R) (h : vec) : Prop := forall v, In v I -> K S v h = k v.

(** [h] lies in the closed nappes of the signs [e]: up (+1) where [e] is true, else down (-1). *)
Definition in_nappes (e : nat -> bool) (h : vec) : Prop :=
  forall v, In v I -> 0 <= K S v h /\ 0 <= sign (e v) * K2 S v (cone S v) h.

Lemma cone_K2 v : In v I -> 0 < K2 S v (cone S v) (cone S v).
Proof.
  intros Hi. rewrite K_polar_sheet by now apply inner_vertex. now apply cone_positive.
Qed.

Lemma cone_cauchy v w : In v I ->
  K2 S v (cone S v) (cone S v) * K2 S v w w <= K2 S v (cone S v) w * K2 S v (cone S v) w.
Proof.
  intros Hi. rewrite !K_polar_sheet by now apply inner_vertex.
  apply one_positive_direction; [assumption|]. now apply cone_positive.
Qed.

Lemma key_K2 w : zero_off I w -> (forall v, In v I -> K2 S v w w <= 0) -> w = zero.
Proof.
  intros Z N. apply (key_lemma S); [assumption|]. intros v Hv.
  rewrite <- K_polar_sheet by now apply inner_vertex. auto.
Qed.

Lemma inner_once : NoDup I.
Proof.
  pose proof (vertices_once S) as D. induction I as [|v l IH]; [constructor|].
  cbn [app] in D. inversion D as [|? ? N D']; subst. constructor; [|auto].
  intros H. apply N, in_or_app. now left.
Qed.

(** ** One solution for each sign vector (docs/mathematics.md, 12; Theorem 5 (b)) *)

Theorem one_solution_per_sign_vector (k : nat -> R) (r : vec) (e : nat -> bool) :
  (forall v, In v I -> 0 <= k v) ->
  exists! h, has_rim r h /\ solves k h /\ in_nappes e h.
Proof.
  intros Pk.
  destruct (one_solution I (K2 S) (cone S) inner_once (K2_sym S) (K2_move S) cone_K2 cone_cauchy key_K2 e k r Pk)
    as (h & (Hr & Hh) & U).
  exists h. split.
  - split; [exact Hr|]. split.
    + intros v Hv. destruct (Hh v Hv) as (E & _). now rewrite K_polar_sheet in E by now apply inner_vertex.
    + intros v Hv. destruct (Hh v Hv) as (E & P). rewrite K_polar_sheet in E by now apply inner_vertex.
      rewrite E. auto.
  - intros g (Gr & Gs & Gn). apply U. split; [exact Gr|]. intros v Hv.
    rewrite K_polar_sheet by now apply inner_vertex. split; [now apply Gs|]. now apply Gn.
Qed.

(** ** (L) *)

Theorem L_flat v h w : In v I -> K S v h = 0 -> ~ flat_star S v h -> K2 S v h w = 0 -> K S v w <= 0.
Proof.
  intros Hi Z NF O. destruct (Rle_lt_dec (K S v w) 0) as [|P]; [assumption|exfalso].
  apply NF, flat_star_iff; [assumption|]. intros z.
  destruct (Req_dec (K2 S v h z) 0) as [|N]; [assumption|exfalso].
  (* z', the part of z that is orthogonal to w *)
  set (z' := move z (- (K2 S v w z / K S v w)) w).
  assert (Oz : K2 S v w z' = 0).
  { unfold z'. rewrite K2_move, K_polar_sheet by now apply inner_vertex. field. lra. }
  assert (Hz : K2 S v h z' = K2 S v h z) by (unfold z'; rewrite K2_move, O; ring).
  assert (H : forall s, 2 * s * K2 S v h z + K S v z' <= 0).
  { intros s. rewrite <- Hz. assert (X : K S v (move z' s h) <= 0).
    { apply (L S v w); [assumption|assumption|]. rewrite K2_move, Oz, (K2_sym S v w h), O. ring. }
    rewrite K_move, Z, (K2_sym S v z' h) in X by now apply inner_vertex. lra. }
  specialize (H ((1 - K S v z') / (2 * K2 S v h z))).
  replace (2 * ((1 - K S v z') / (2 * K2 S v h z)) * K2 S v h z) with (1 - K S v z') in H by (field; assumption).
  lra.
Qed.

(** [h] has positive curvature, or curvature 0 and a star that is not flat, at every vertex. *)
Definition regular (h : vec) : Prop :=
  forall v, In v I -> 0 < K S v h \/ (K S v h = 0 /\ ~ flat_star S v h).

Lemma regular_kernel h w : regular h -> zero_off I w -> (forall v, In v I -> K2 S v h w = 0) -> w = zero.
Proof.
  intros P Z O. apply (key_lemma S); [assumption|]. intros v Hv.
  destruct (P v Hv) as [Pos|(Null & NF)].
  - apply (L S v h); auto.
  - apply (L_flat v h); auto.
Qed.

(** ** Theorem 2 *)

(** (a), its first half: no complex zeros at infinity. *)
Theorem no_zero_at_infinity (z : cvec) :
  (forall u, ~ In u I -> z u = real 0) -> (forall v, In v I -> KC S v z = real 0) ->
  forall u, z u = real 0.
Proof.
  intros Zr E.
  assert (Za : zero_off I (re_part z)) by (intros u Hu; unfold re_part; now rewrite (Zr u Hu)).
  assert (Zb : zero_off I (im_part z)) by (intros u Hu; unfold im_part; now rewrite (Zr u Hu)).
  assert (N : forall v, In v I -> K S v (im_part z) <= 0).
  { intros v Hv. destruct (KC_equation S v z 0 Hv (E v Hv)) as (E1 & E2).
    destruct (Rle_lt_dec (K S v (im_part z)) 0) as [|P]; [assumption|].
    apply (L S v (re_part z)); [assumption| |assumption]. lra. }
  assert (B : im_part z = zero) by now apply (key_lemma S).
  assert (A : re_part z = zero).
  { apply (key_lemma S); [assumption|]. intros v Hv.
    destruct (KC_equation S v z 0 Hv (E v Hv)) as (E1 & _). specialize (N v Hv). lra. }
  intros u. apply (f_equal (fun h => h u)) in A, B. unfold re_part, im_part, zero, re, im in *.
  destruct (z u) as [x y]. cbn in *. now subst.
Qed.

(** Statement 6 of docs/mathematics.md, for any multipliers. *)
Theorem definite_stress (m : nat -> R) (z : cvec) :
  (forall v, In v I -> 0 < m v) ->
  (forall w, zero_off I w -> w <> zero -> 0 < sum I (fun v => m v * K S v w)) ->
  (forall u, ~ In u I -> z u = real 0) -> (forall v, In v I -> KC S v z = real 0) ->
  forall u, z u = real 0.
Proof.
  intros Pm Def Zr E.
  assert (D : forall w, zero_off I w -> (forall v, In v I -> K S v w <= 0) -> w = zero).
  { intros w Z N. destruct (Rle_lt_dec (norm I w) 0) as [H|H]; [now apply (norm_zero I)|exfalso].
    assert (Nz : w <> zero).
    { intros ->. assert (norm I zero = 0); [|lra].
      apply sum_zero. intros. unfold zero. apply Rabs_R0. }
    specialize (Def w Z Nz). assert (sum I (fun v => m v * K S v w) <= 0); [|lra].
    apply sum_nonpos. intros v Hv. specialize (N v Hv). specialize (Pm v Hv).
    pose proof (Rmult_le_pos (m v) (- K S v w)). lra. }
  assert (Za : zero_off I (re_part z)) by (intros u Hu; unfold re_part; now rewrite (Zr u Hu)).
  assert (Zb : zero_off I (im_part z)) by (intros u Hu; unfold im_part; now rewrite (Zr u Hu)).
  assert (N : forall v, In v I -> K S v (im_part z) <= 0).
  { intros v Hv. destruct (KC_equation S v z 0 Hv (E v Hv)) as (E1 & E2).
    destruct (Rle_lt_dec (K S v (im_part z)) 0) as [|P]; [assumption|].
    apply (L S v (re_part z)); [assumption| |assumption]. lra. }
  assert (B : im_part z = zero) by now apply D.
  assert (A : re_part z = zero).
  { apply D; [assumption|]. intros v Hv.
    destruct (KC_equation S v z 0 Hv (E v Hv)) as (E1 & _). specialize (N v Hv). lra. }
  intros u. apply (f_equal (fun h => h u)) in A, B. unfold re_part, im_part, zero, re, im in *.
  destruct (z u) as [x y]. cbn in *. now subst.
Qed.

(** (b) All complex solutions are real. *)
Theorem all_real (k : nat -> R) (r : vec) (z : cvec) : (forall v, In v I -> 0 <= k v) ->
  (forall u, ~ In u I -> z u = real (r u)) -> (forall v, In v I -> KC S v z = real (k v)) ->
  forall u, im (z u) = 0.
Proof.
  intros Pk Zr E.
  assert (Zb : zero_off I (im_part z)) by (intros u Hu; unfold im_part; now rewrite (Zr u Hu)).
  assert (B : im_part z = zero).
  { apply (key_lemma S); [assumption|]. intros v Hv.
    destruct (KC_equation S v z (k v) Hv (E v Hv)) as (E1 & E2). specialize (Pk v Hv).
    destruct (Rle_lt_dec (K S v (im_part z)) 0) as [|P]; [assumption|].
    apply (L S v (re_part z)); [assumption| |assumption]. lra. }
  intros u. now apply (f_equal (fun h => h u)) in B.
Qed.

(** (c) The Jacobian is nonsingular: its equations have exactly one solution, for every right side. *)
Definition nonsingular (h : vec) : Prop :=
  forall b : vec, exists! w, zero_off I w /\ forall v, In v I -> K2 S v h w = b v.

Theorem jacobian_nonsingular h : regular h -> nonsingular h.
Proof.
  intros P b. destruct (solve I (fun v => K2 S v h)) with (b := b) as (w & Z & E).
  - exact inner_once.
  - intros v _ a s c. apply K2_move.
  - intros w Z. now apply regular_kernel.
  - exists w. split; [now split|]. intros w' (Z' & E').
    assert (D : minus w w' = zero).
    { apply (regular_kernel h); [assumption| |].
      - intros u Hu. unfold minus. rewrite (Z u Hu), (Z' u Hu). ring.
      - intros v Hv. rewrite minus_move, K2_move, (E v Hv), (E' v Hv). ring. }
    rewrite <- (move_minus w w'), D. vec.
Qed.

(** Where a star is flat its row is 0. *)
Theorem jacobian_singular h v : In v I -> flat_star S v h -> ~ nonsingular h.
Proof.
  intros Hv Fl N. destruct (N (fun _ => 1)) as (w & (_ & E) & _). specialize (E v Hv).
  rewrite (flat_null S v h Hv Fl) in E. lra.
Qed.

(** ** Sign vectors *)

(** Two closed nappes with K >= 0 meet at [v] only where the star is flat. *)
Lemma both_nappes_flat v h : In v I -> 0 <= K S v h -> K2 S v (cone S v) h = 0 -> flat_star S v h.
Proof.
  intros Hv P O. pose proof (cone_positive S v Hv) as Pc.
  assert (Z : K S v h = 0) by (pose proof (L S v (cone S v) h Hv Pc O); lra).
  apply flat_star_iff; [assumption|]. intros z.
  (* on the complement of the cone -K is positive semidefinite, so that h is orthogonal to it *)
  set (z' := move z (- (K2 S v (cone S v) z / K S v (cone S v))) (cone S v)).
  assert (Oz : K2 S v (cone S v) z' = 0).
  { unfold z'. rewrite K2_move, K_polar_sheet by now apply inner_vertex. field. lra. }
  assert (Hz : K2 S v h z' = K2 S v h z).
  { unfold z'. rewrite K2_move, (K2_sym S v h (cone S v)), O. ring. }
  rewrite <- Hz. destruct (Req_dec (K2 S v h z') 0) as [|N]; [assumption|exfalso].
  assert (H : forall s, 2 * s * K2 S v h z' + K S v z' <= 0).
  { intros s. assert (X : K S v (move z' s h) <= 0).
    { apply (L S v (cone S v)); [assumption|assumption|]. rewrite K2_move, Oz, O. ring. }
    rewrite K_move, Z, (K2_sym S v z' h) in X by now apply inner_vertex. lra. }
  specialize (H ((1 - K S v z') / (2 * K2 S v h z'))).
  replace (2 * ((1 - K S v z') / (2 * K2 S v h z')) * K2 S v h z') with (1 - K S v z') in H by (field; assumption).
  lra.
Qed.

Lemma regular_sign h v : regular h -> In v I -> K2 S v (cone S v) h <> 0.
Proof.
  intros P Hv O. destruct (P v Hv) as [Pos|(Null & NF)].
  - pose proof (L S v (cone S v) h Hv (cone_positive S v Hv) O). lra.
  - apply NF. apply both_nappes_flat; [assumption|lra|assumption].
Qed.

(** The signs of a vector of heights. *)
Definition signs_of (h : vec) (v : nat) : bool :=
  if in_dec Nat.eq_dec v I then if Rle_dec 0 (K2 S v (cone S v) h) then true else false else false.

Lemma signs_of_nappes h : (forall v, In v I -> 0 <= K S v h) -> in_nappes (signs_of h) h.
Proof.
  intros P v Hv. split; [auto|]. unfold signs_of. destruct in_dec; [|contradiction].
  destruct Rle_dec; simpl; lra.
Qed.

(** All sign vectors, as functions that are [false] off the list. *)
Fixpoint sign_vectors (l : list nat) : list (nat -> bool) :=
  match l with
  | [] => [fun _ => false]
  | v :: l => sign_vectors l ++ map (fun e u => if Nat.eqb u v then true else e u) (sign_vectors l)
  end.

Lemma sign_vectors_length l : length (sign_vectors l) = (2 ^ length l)%nat.
Proof. induction l as [|v l IH]; [reflexivity|]. simpl. rewrite app_length, map_length, IH. lia. Qed.

Lemma sign_vectors_off l e u : In e (sign_vectors l) -> ~ In u l -> e u = false.
Proof.
  revert e. induction l as [|v l IH]; intros e He Hu.
  - now destruct He as [<-|[]].
  - simpl in He. apply in_app_or in He. simpl in Hu. destruct He as [He|He]; [apply IH; tauto|].
    apply in_map_iff in He. destruct He as (f & <- & Hf).
    destruct (Nat.eqb_spec u v) as [->|]; [tauto|]. apply IH; tauto.
Qed.

Lemma sign_vectors_all l e : (forall u, ~ In u l -> e u = false) -> In e (sign_vectors l).
Proof.
  revert e. induction l as [|v l IH]; intros e Off; simpl.
  - left. apply functional_extensionality. intros u. symmetry. now apply Off.
  - apply in_or_app. destruct (e v) eqn:Ev; [right|left].
    + apply in_map_iff. destruct (in_dec Nat.eq_dec v l) as [Hv|Hv].
      * exists e. split; [|apply IH; intros u Hu; apply Off; intros [->|H]; contradiction].
        apply functional_extensionality. intros u. destruct (Nat.eqb_spec u v) as [->|]; congruence.
      * exists (fun u => if Nat.eqb u v then false else e u). split.
        -- apply functional_extensionality. intros u. destruct (Nat.eqb_spec u v) as [->|]; congruence.
        -- apply IH. intros u Hu. destruct (Nat.eqb_spec u v) as [->|N]; [reflexivity|].
           apply Off. intros [->|H]; contradiction.
    + apply IH. intros u Hu. destruct (Nat.eq_dec u v) as [->|N]; [assumption|].
      apply Off. intros [->|H]; contradiction.
Qed.

Lemma NoDup_app_intro {A} (l l' : list A) :
  NoDup l -> NoDup l' -> (forall a, In a l -> ~ In a l') -> NoDup (l ++ l').
Proof.
  induction l as [|a l IH]; intros D D' N; [assumption|]. inversion D; subst. simpl. constructor.
  - intros H. apply in_app_or in H. destruct H; [contradiction|]. apply (N a); simpl; auto.
  - apply IH; auto. intros b Hb. apply N. now right.
Qed.

Lemma sign_vectors_once l : NoDup l -> NoDup (sign_vectors l).
Proof.
  induction l as [|v l IH]; intros D; simpl; [repeat constructor; easy|].
  inversion D as [|? ? Nv Dl]; subst. specialize (IH Dl).
  apply NoDup_app_intro; [assumption| |].
  - assert (Off : forall e, In e (sign_vectors l) -> e v = false) by (intros; now apply (sign_vectors_off l)).
    clear D. induction (sign_vectors l) as [|e t IHt]; simpl; [constructor|].
    inversion IH as [|? ? Ne Dt]; subst. constructor; [|apply IHt; simpl in Off; auto].
    intros H. apply in_map_iff in H. destruct H as (f & E & Hf). apply Ne.
    replace e with f; [assumption|]. apply functional_extensionality. intros u.
    destruct (Nat.eq_dec u v) as [->|N].
    + rewrite (Off e), (Off f); simpl; auto.
    + apply (f_equal (fun g => g u)) in E. apply Nat.eqb_neq in N. now rewrite N in E.
  - intros e He H. apply in_map_iff in H. destruct H as (f & <- & Hf).
    apply (sign_vectors_off l _ v He) in Nv. now rewrite Nat.eqb_refl in Nv.
Qed.

(** The solutions, one for each sign vector; they are different if all are regular. *)
Theorem list_of_solutions (k : nat -> R) (r : vec) : (forall v, In v I -> 0 <= k v) ->
  exists l : list vec, length l = (2 ^ n)%nat /\
    (forall h, In h l <-> has_rim r h /\ solves k h) /\
    ((forall h, has_rim r h -> solves k h -> regular h) -> NoDup l).
Proof.
  intros Pk.
  assert (Ex : forall t, exists l : list vec,
    Forall2 (fun e h => has_rim r h /\ solves k h /\ in_nappes e h) t l).
  { induction t as [|e t (l & H)]; [exists []; constructor|].
    destruct (one_solution_per_sign_vector k r e Pk) as (h & Hh & _). exists (h :: l). now constructor. }
  destruct (Ex (sign_vectors I)) as (l & H). clear Ex. exists l. split; [|split].
  - rewrite <- sign_vectors_length. induction H; simpl; congruence.
  - intros h. split.
    + intros Hin. clear - H Hin. induction H as [|e h' t l (A & B & _) H IH]; [easy|].
      destruct Hin as [->|Hin]; auto.
    + intros (Hr & Hs).
      assert (Hn : in_nappes (signs_of h) h).
      { apply signs_of_nappes. intros v Hv. rewrite (Hs v Hv). auto. }
      assert (He : In (signs_of h) (sign_vectors I)).
      { apply sign_vectors_all. intros u Hu. unfold signs_of. now destruct in_dec. }
      induction H as [|e h' t l (A & B & C) H IH]; [easy|].
      destruct He as [->|He]; [left|right; auto].
      destruct (one_solution_per_sign_vector k r (signs_of h) Pk) as (x & _ & U).
      rewrite <- (U h'), <- (U h); auto.
  - intros Reg. pose proof (sign_vectors_once I inner_once) as D.
    assert (Off : forall e, In e (sign_vectors I) -> forall u, ~ In u I -> e u = false)
      by (intros; now apply (sign_vectors_off I)).
    induction H as [|e h t l (Hr & Hs & Hn) H IH]; [constructor|].
    inversion D as [|? ? Ne Dt]; subst. constructor; [|apply IH; [assumption|simpl in Off; auto]].
    intros Hin. apply Ne.
    assert (X : exists e', In e' t /\ in_nappes e' h).
    { clear - H Hin. induction H as [|e' h' t l (_ & _ & N) H IH]; [easy|].
      destruct Hin as [->|Hin]; [exists e'; simpl; auto|]. destruct (IH Hin) as (f & ? & ?).
      exists f. simpl. auto. }
    destruct X as (e' & He' & Hn'). replace e with e'; [assumption|].
    apply functional_extensionality. intros u.
    destruct (in_dec Nat.eq_dec u I) as [Hu|Hu].
    + pose proof (regular_sign h u (Reg h Hr Hs) Hu) as N.
      destruct (Hn u Hu) as (_ & P), (Hn' u Hu) as (_ & P').
      destruct (e u), (e' u); simpl in *; try reflexivity; exfalso; apply N; lra.
    + rewrite (Off e), (Off e'); simpl; auto.
Qed.

(** (d) For k > 0 there are exactly 2^n complex solutions; they are real, and there is exactly one
    for each vector of vertex signs. *)
Theorem exactly_2_to_the_n (k : nat -> R) (r : vec) : (forall v, In v I -> 0 < k v) ->
  exists l : list vec, length l = (2 ^ n)%nat /\ NoDup l /\
    (forall z : cvec, ((forall u, ~ In u I -> z u = real (r u)) /\ forall v, In v I -> KC S v z = real (k v)) <->
      exists h, In h l /\ forall u, z u = real (h u)) /\
    (forall h, In h l -> forall v, In v I -> K2 S v (cone S v) h <> 0) /\
    forall e, exists! h, In h l /\ forall v, In v I -> 0 < sign (e v) * K2 S v (cone S v) h.
Proof.
  intros Pk. assert (Pk' : forall v, In v I -> 0 <= k v) by (intros; apply Rlt_le; auto).
  assert (Reg : forall h, has_rim r h -> solves k h -> regular h).
  { intros h _ Hs v Hv. left. rewrite (Hs v Hv). auto. }
  destruct (list_of_solutions k r Pk') as (l & Len & Sol & D). specialize (D Reg). exists l.
  split; [assumption|]. split; [assumption|]. split; [|split].
  - intros z. split.
    + intros (Zr & E). pose proof (all_real k r z Pk' Zr E) as Im.
      exists (re_part z). split.
      * apply Sol. split.
        -- intros u Hu. unfold re_part. now rewrite (Zr u Hu).
        -- intros v Hv. destruct (KC_equation S v z (k v) Hv (E v Hv)) as (E1 & _). rewrite E1.
           replace (im_part z) with zero by (apply functional_extensionality; intro; symmetry; apply Im).
           rewrite <- K_polar_sheet by now apply inner_vertex.
           rewrite (linear_zero (K2 S v zero)) by (intros a s b; apply K2_move). ring.
      * intros u. specialize (Im u). unfold re_part, real, re, im in *. destruct (z u). cbn in *. now subst.
    + intros (h & Hh & E). apply Sol in Hh. destruct Hh as (Hr & Hs). split.
      * intros u Hu. rewrite E, (Hr u Hu). reflexivity.
      * intros v Hv. rewrite KC_parts by now apply inner_vertex.
        replace (re_part z) with h by (apply functional_extensionality; intro; unfold re_part; now rewrite E).
        replace (im_part z) with zero by (apply functional_extensionality; intro; unfold im_part; now rewrite E).
        rewrite <- (K_polar_sheet S v zero) by now apply inner_vertex.
        rewrite !(linear_zero (K2 S v _)) by (intros a s b; apply K2_move).
        rewrite (Hs v Hv). unfold real. f_equal; ring.
  - intros h Hh v Hv. apply Sol in Hh. apply regular_sign; [apply Reg; tauto|assumption].
  - intros e. destruct (one_solution_per_sign_vector k r e Pk') as (h & (Hr & Hs & Hn) & U).
    exists h. split.
    + split; [now apply Sol|]. intros v Hv. destruct (Hn v Hv) as (_ & P).
      pose proof (regular_sign h v (Reg h Hr Hs) Hv) as N.
      destruct P as [P|P]; [assumption|]. exfalso. apply N. destruct (e v); simpl in P; lra.
    + intros g (Hg & Ps). apply Sol in Hg. destruct Hg as (Gr & Gs). apply U. split; [assumption|].
      split; [assumption|]. intros v Hv. rewrite (Gs v Hv). split; [auto|]. apply Rlt_le. auto.
Qed.

(** (e) For k = 0. *)
Theorem simple_iff_no_flat_star h : solves (fun _ => 0) h ->
  (nonsingular h <-> forall v, In v I -> ~ flat_star S v h).
Proof.
  intros Hs. split.
  - intros N v Hv Fl. exact (jacobian_singular h v Hv Fl N).
  - intros NF. apply jacobian_nonsingular. intros v Hv. right. split; [now apply Hs|auto].
Qed.

Theorem different_sign_vectors (r h h' : vec) (e : nat -> bool) :
  has_rim r h -> has_rim r h' -> solves (fun _ => 0) h -> solves (fun _ => 0) h' ->
  in_nappes e h -> in_nappes e h' -> h = h'.
Proof.
  intros Hr Hr' Hs Hs' Hn Hn'.
  destruct (one_solution_per_sign_vector (fun _ => 0) r e) as (x & _ & U); [intros; lra|].
  rewrite <- (U h), <- (U h'); auto.
Qed.

(** ** Theorem 5 (a) of docs/branch.md *)

Lemma reversed_cauchy v a b e : In v I -> 0 <= K S v a -> 0 <= K S v b ->
  0 <= sign e * K2 S v (cone S v) a -> 0 <= sign e * K2 S v (cone S v) b ->
  sqrt (K S v a) * sqrt (K S v b) <= K2 S v a b.
Proof.
  intros Hi Pa Pb Sa Sb.
  pose proof (n_cauchy I (K2 S) (cone S) (K2_sym S) (K2_move S) cone_K2 cone_cauchy v Hi a b) as C.
  pose proof (n_pos I (K2 S) (cone S) cone_K2 cone_cauchy v Hi a) as Na.
  pose proof (n_pos I (K2 S) (cone S) cone_K2 cone_cauchy v Hi b) as Nb.
  unfold Nappes.p in C. pose proof (Rle_abs (Nappes.n (K2 S) (cone S) v a b)) as Ab.
  assert (Ea : K S v a = l (K2 S) (cone S) v a * l (K2 S) (cone S) v a - Nappes.n (K2 S) (cone S) v a a).
  { unfold Nappes.n. rewrite K_polar_sheet by now apply inner_vertex. ring. }
  assert (Eb : K S v b = l (K2 S) (cone S) v b * l (K2 S) (cone S) v b - Nappes.n (K2 S) (cone S) v b b).
  { unfold Nappes.n. rewrite K_polar_sheet by now apply inner_vertex. ring. }
  assert (Eab : K2 S v a b = l (K2 S) (cone S) v a * l (K2 S) (cone S) v b - Nappes.n (K2 S) (cone S) v a b).
  { unfold Nappes.n. ring. }
  pose proof (root_t I (K2 S) (cone S) cone_K2 v Hi) as Pt.
  assert (Div : forall x, 0 <= sign e * K2 S v (cone S v) x -> 0 <= sign e * l (K2 S) (cone S) v x).
  { intros x Hx. unfold l. replace (sign e * (K2 S v (cone S v) x / _)) with
      (sign e * K2 S v (cone S v) x / sqrt (K2 S v (cone S v) (cone S v))) by (unfold Rdiv; ring).
    apply Rmult_le_pos; [assumption|]. now apply Rlt_le, Rinv_0_lt_compat. }
  apply Div in Sa, Sb. clear Div.
  set (la := l _ _ v a) in *. set (lb := l _ _ v b) in *.
  set (na := Nappes.n _ _ v a a) in *. set (nb := Nappes.n _ _ v b b) in *.
  set (nab := Nappes.n _ _ v a b) in *.
  set (x := sign e * la) in *. set (y := sign e * lb) in *.
  assert (Exx : la * la = x * x).
  { unfold x. replace (sign e * la * (sign e * la)) with (sign e * sign e * (la * la)) by ring.
    rewrite sign_sqr. ring. }
  assert (Eyy : lb * lb = y * y).
  { unfold y. replace (sign e * lb * (sign e * lb)) with (sign e * sign e * (lb * lb)) by ring.
    rewrite sign_sqr. ring. }
  assert (Exy : la * lb = x * y).
  { unfold x, y. replace (sign e * la * (sign e * lb)) with (sign e * sign e * (la * lb)) by ring.
    rewrite sign_sqr. ring. }
  assert (Qa : sqrt (K S v a) * sqrt (K S v a) = K S v a) by now apply sqrt_sqrt.
  assert (Qb : sqrt (K S v b) * sqrt (K S v b) = K S v b) by now apply sqrt_sqrt.
  assert (Ra : sqrt na * sqrt na = na) by now apply sqrt_sqrt.
  assert (Rb : sqrt nb * sqrt nb = nb) by now apply sqrt_sqrt.
  pose proof (sqrt_pos (K S v a)). pose proof (sqrt_pos (K S v b)).
  pose proof (sqrt_pos na). pose proof (sqrt_pos nb).
  set (ka := sqrt (K S v a)) in *. set (kb := sqrt (K S v b)) in *.
  set (ma := sqrt na) in *. set (mb := sqrt nb) in *.
  (* x^2 = ka^2 + ma^2 and y^2 = kb^2 + mb^2, so ka kb + ma mb <= x y *)
  assert (Hx : x * x = ka * ka + ma * ma) by lra. assert (Hy : y * y = kb * kb + mb * mb) by lra.
  assert (ka * kb + ma * mb <= x * y).
  { apply Rsqr_incr_0_var; [|now apply Rmult_le_pos]. unfold Rsqr.
    replace (x * y * (x * y)) with (x * x * (y * y)) by ring. rewrite Hx, Hy.
    pose proof (Rle_0_sqr (ka * mb - ma * kb)) as Sq. unfold Rsqr in Sq. lra. }
  lra.
Qed.

Theorem distance (c : point) (R2 : R) (e : nat -> bool) (h h' : vec) :
  (forall v, In v (inner S ++ rim S) -> 0 <= multiplier S c R2 v) ->
  in_nappes e h -> in_nappes e h' -> (forall u, ~ In u I -> h u = h' u) ->
  energy S (minus h h') <= sum I (fun v =>
    multiplier S c R2 v * ((sqrt (K S v h) - sqrt (K S v h')) * (sqrt (K S v h) - sqrt (K S v h')))).
Proof.
  intros Pm Hn Hn' E.
  eapply Rle_trans; [apply (key_energy S c R2 (minus h h'))|].
  - intros b Hb. apply Pm, in_or_app. now right.
  - intros u Hu. unfold minus. rewrite (E u Hu). ring.
  - apply sum_le. intros v Hv. apply Rmult_le_compat_l; [now apply Pm, inner_vertex|].
    rewrite minus_move, K_move by now apply inner_vertex.
    destruct (Hn v Hv) as (P & Sg), (Hn' v Hv) as (P' & Sg').
    pose proof (reversed_cauchy v h h' (e v) Hv P P' Sg Sg') as C.
    assert (Q : sqrt (K S v h) * sqrt (K S v h) = K S v h) by now apply sqrt_sqrt.
    assert (Q' : sqrt (K S v h') * sqrt (K S v h') = K S v h') by now apply sqrt_sqrt.
    lra.
Qed.

End Theorems.
