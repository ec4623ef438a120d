(** Near the flat sheet (docs/motion.md, section 4): the true motions that begin along the solutions of K_v = 0. *)
From Coq Require Import Reals List Permutation Lra Lia Arith Bool FunctionalExtensionality.
From Exactfold Require Import Sums Vectors Nappes Sheet Identities Star KeyLemma Flat Complex Theorems Branches
  Drawing Curve Flex Displacements Motion.
Import ListNotations.
Open Scope R_scope.

Section Ways.
Variable S : sheet.
Notation at_ := (at_ S).
Notation I := (inner S).
Notation vertices := (inner S ++ rim S).
Notation F := (faces S).

(** ** The vertices of a disk *)

Lemma in_a_side v : In v vertices -> exists a, In (v, a) (sides F).
Proof.
  intros Hv. assert (St : exists s, In s (steps (fan S v))).
  { apply in_app_or in Hv. destruct Hv as [Hi|Hr].
    - destruct (inner_full S v Hi) as (u & up & p & q & down & E & _). rewrite E.
      destruct up as [|z up]; eexists; now left.
    - destruct (rim_convex S v Hr) as (u & mid & q & E & _). rewrite E. destruct mid as [|z mid]; eexists; now left. }
  destruct St as ([a b] & Hs). exists a. exact (proj1 (corner_sides F v a b (step_corner S v a b Hv Hs))).
Qed.

Lemma corner_vertices a b c : In (a, b, c) (corners F) -> In a vertices /\ In b vertices /\ In c vertices.
Proof.
  intros H. assert (R : In (b, c, a) (corners F) /\ In (c, a, b) (corners F)).
  { unfold corners in *. rewrite in_flat_map in H. destruct H as ([[x y] z] & Hf & Hc). rewrite !in_flat_map.
    simpl in Hc. destruct Hc as [E|[E|[E|[]]]]; injection E as <- <- <-; split; exists (x, y, z);
      (split; [assumption|simpl; tauto]). }
  destruct R as (R1 & R2). repeat split; eapply faces_on_vertices; eassumption.
Qed.

Lemma glued_in J vs fs : glued S J vs fs -> (forall v, In v vs -> In v vertices) /\
  forall s, In s (sides fs) -> In s (sides F).
Proof.
  assert (Side : forall a b c fs s, In (a, b, c) (corners F) -> (In s (sides fs) -> In s (sides F)) ->
    In s (sides ((a, b, c) :: fs)) -> In s (sides F)).
  { intros a b c fs0 [x y] Hc IH H. destruct (corner_sides F a b c Hc) as (S1 & S2 & S3).
    apply sides_cons in H. destruct H as [E|[E|[E|H]]]; [now rewrite E..|now apply IH]. }
  induction 1 as [a b c Hc|vs fs a b c G (IH & IS) Hc Sd New|vs fs v a b G (IH & IS) Hc _ _ _ _ _ _].
  - destruct (corner_vertices a b c Hc) as (Ha & Hb & Hd). split.
    + intros v [<-|[<-|[<-|[]]]]; assumption.
    + intros s. now apply Side.
  - destruct (corner_vertices a b c Hc) as (_ & _ & Hd). split.
    + intros v [<-|Hv]; auto.
    + intros s. apply (Side a b c); auto.
  - split; [exact IH|]. intros s. apply (Side v a b); auto.
Qed.

Hypothesis Disk : disk S I F.

(** The sheet is glued from its faces, and has all their vertices. *)
Lemma gluing : (forall v, In v I -> In v I /\ all_at S F v) /\ exists vs fs, glued S I vs fs /\
  (forall s, In s (sides F) <-> In s (sides fs)) /\ (forall v, In v vs <-> In v vertices).
Proof.
  destruct Disk as (Inside & vs & fs & G & All). split; [exact Inside|]. exists vs, fs.
  destruct (glued_in I vs fs G) as (On & Sd). split; [exact G|]. split.
  - intros s. split; [apply All|apply Sd].
  - intros v. split; [apply On|]. intros Hv. destruct (in_a_side v Hv) as (a & Ha).
    apply All in Ha. exact (proj1 (glued_on S I vs fs G v a Ha)).
Qed.

(** One vertex is held, and another one on its line with the first. *)
Variables p q : nat.
Hypothesis Hp : In p vertices.
Hypothesis Hq : In q vertices.
Hypothesis Apart : at_ p <> at_ q.
Notation d := (sub (at_ q) (at_ p)).

Lemma apart : dot d d <> 0.
Proof.
  intros E. apply dot_zero in E. apply Apart. destruct (at_ p), (at_ q). unfold sub in E. cbn [fst snd] in E.
  injection E as E1 E2. f_equal; lra.
Qed.

(** A simple solution begins a true motion of the sheet. *)
Theorem true_motion_exists h : solves S (fun _ => 0) h -> nonsingular S h ->
  exists t1 delta C P z, true_motion S I vertices F p q h t1 delta C P z.
Proof.
  intros Sol Non. destruct gluing as (Inside & vs & fs & G & Same & Vs).
  destruct (motion S I vs F fs (inner_once S) Inside G Same p q (proj2 (Vs p) Hp) (proj2 (Vs q) Hq) apart h Sol)
    as (t1 & delta & C & P & z & P1 & Pd & PC & Moves & Lip & Only).
  { intros g Zg Kg. destruct (Non zero) as (w & _ & U).
    rewrite <- (U g), <- (U zero); [reflexivity| |]; split; try easy.
    intros v Hv. apply linear_zero. intros a s b. apply K2_move. }
  exists t1, delta, C, P, z. split; [exact P1|]. split; [exact Pd|]. split; [exact PC|]. split; [exact Moves|]. split.
  - intros t t' Ht Ht' v Hv. apply Lip; try assumption. now apply Vs.
  - intros t P' z' Ht Nt True Held Rim Near High v Hv. apply Only; try assumption; try (now apply Vs).
    + intros u Hu. apply Rim. now apply Vs.
    + intros u Hu. apply Near. now apply Vs.
Qed.
End Ways.
