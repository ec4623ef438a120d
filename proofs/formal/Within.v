(** A solution in a linear space of heights: stars and folds that are flat on the whole space are flat on it, and it has
    the signs and letters that all heights near the middle have. *)
From Coq Require Import Reals ZArith List Lra Lia Arith Bool FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Nappes Sheet Identities Star KeyLemma Flat Theorems Branches
  Drawing Tables Rational Certificate Integers Verify Exact Space Contracting Rooted.
Import ListNotations.
Open Scope R_scope.

Section Within.
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
Notation parts := (parts p sp).
Notation unknowns := (unknowns p sp).
Notation along := (along d b4 sp).
Notation middle := (middle d p b4 top sp).
Notation spanning := (spanning d p b4 top sp).
Notation beyond := (beyond d p b4 top sp).

Definition space_hub (b : hub) : bool :=
  match signs (at_vertex b) with
  | None => forallb (fun h => exact_hub (fun _ => false) (fun _ => None) h b) spanning
  | Some up => beyond (sided b) up
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

Definition in_space : bool :=
  (contracted d p b4 top sp signs kept || rooted d p b4 top sp signs kept) && forallb space_hub (hubs p) &&
  forallb space_fold (folds p) && risen.

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

Notation beyond_means := (beyond_means d p b4 top sp sound_p Off).
Notation spanned := (spanned d p b4 top sp ok sound_p Off).
Notation inside_hubs := (inside_hubs d p sound_p).

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
  unfold in_space. rewrite !andb_true_iff, !forallb_forall. intros (((Sol & Hubs) & Folds) & Rise).
  assert (Ex : exists x, solution d p b4 top sp ok signs kept x).
  { apply orb_prop in Sol. destruct Sol; [now apply contracted_solution|now apply rooted_solution]. }
  destruct Ex as (x & X4 & Zx & Box & Sol'). clear Sol. rename Sol' into Sol. exists (lifted x).
  assert (Flat : forall b, In b (hubs p) -> signs (at_vertex b) = None -> flat_star S (at_vertex b) (lifted x)).
  { intros b Hb N. specialize (Hubs b Hb). unfold space_hub in Hubs. rewrite N, forallb_forall in Hubs.
    destruct (hub_forms d p ok sound_p b Hb) as (Hi & _). apply flat_star_iff; [exact Hi|]. intros z. rewrite K2_sym.
    apply spanned; [intros a s c; apply K2_move| |exact Zx]. intros g Hg. rewrite K2_sym.
    apply (flat_null S _ _ Hi), (flat_measured d p ok sound_p b g Hb). now apply Hubs. }
  assert (Null : forall b, In b (hubs p) -> kept (at_vertex b) = false -> K2 S (at_vertex b) (lifted x) (lifted x) = 0).
  { intros b Hb Nk. destruct (hub_forms d p ok sound_p b Hb) as (Hi & _). destruct (signs (at_vertex b)) as [e|] eqn:E.
    - apply Sol; [exact Hb|]. unfold flat_or_kept. now rewrite Nk, E.
    - apply flat_null; [exact Hi|now apply Flat]. }
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
    specialize (Hubs b Hb). unfold space_hub in Hubs. rewrite E in Hubs. rename Hubs into Be.
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
End Within.
