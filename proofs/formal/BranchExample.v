(** A sheet, written by exactfold.  Coordinates are multiplied by 1115615.
    Once `make -C proofs/formal` is done: coqc -Q proofs/formal Exactfold THIS_FILE.v *)
From Coq Require Import Reals ZArith List Lra.
From Exactfold Require Import Vectors Nappes Sheet Flat Complex Theorems Branches Drawing.
Import ListNotations.
Open Scope nat_scope.

Definition sheet_drawing : drawing := {|
  points := [(0, 0); (5578075, -2231230); (10040535, 1115615); (8924920, 6693690);
    (3346845, 8924920); (-1115615, 4462460); (5557605, -716450); (7072029, 2570765);
    (6530735, 6267500)]%Z;
  inside := [6; 7; 8];
  border := [1; 2; 3; 4; 5; 0];
  triangles := [(0, 1, 6); (1, 2, 6); (2, 3, 7); (3, 4, 8); (4, 5, 8); (3, 8, 7); (0, 7, 5);
    (5, 7, 8); (0, 6, 7); (2, 7, 6)];
  fans_of := [[1; 6; 7; 5]; [2; 6; 0]; [3; 7; 6; 1]; [4; 8; 7; 2]; [5; 8; 3]; [0; 7; 8; 4]; [0; 1;
    2; 7; 0]; [0; 6; 2; 3; 8; 5; 0]; [3; 4; 5; 7; 3]]
|}.

(** The hypotheses of a convex sheet, decided by computation. *)
Lemma sheet_checked : check sheet_drawing = true.
Proof. vm_compute. reflexivity. Qed.
Definition this_sheet : sheet := sheet_of sheet_drawing sheet_checked.
Lemma size : length (inner this_sheet) = 3.
Proof. reflexivity. Qed.

(** For given boundary heights and curvatures > 0: 2^3 shapes. *)
Theorem shapes (k : nat -> R) (r : vec) : (forall v, In v (inside sheet_drawing) -> (0 < k v)%R) ->
  exists l : list vec, length l = 2 ^ 3 /\ NoDup l /\
    forall h, In h l <-> has_rim this_sheet r h /\ solves this_sheet k h.
Proof.
  intros P. destruct (list_of_solutions this_sheet k r) as (l & Len & Sol & Once).
  - intros v Hv. apply Rlt_le, P, Hv.
  - rewrite size in Len. exists l. refine (conj Len (conj _ Sol)).
    apply Once. intros h _ Hs v Hv. left. rewrite (Hs v Hv). apply P, Hv.
Qed.

(** One branch and its certificate (docs/branch.md). *)
From Coq Require Import QArith.
From Exactfold Require Import Rational Certificate.
Open Scope nat_scope.

Definition branch_certificate : certificate := {|
  near := [(1 # 3); (2 # 3); (5 # 3); (10 # 3); (17 # 3); (26 # 3);
    (77599976339733763733624529 # 77371252455336267181195264);
    (16234491050328005764496145 # 19342813113834066795298816);
    (359231276331530998732621711 # 77371252455336267181195264)]%Q;
  ups := [6; 8];
  cones := [[]; []; []; []; []; []; [(0, (-1434520251)%Z); (1, (-387819085)%Z);
    (2, (-1239767681)%Z); (7, (-926538325)%Z)]; [(0, (-1926345599)%Z); (6, (-926538325)%Z);
    (2, (-846330323)%Z); (3, (-1157157255)%Z); (8, (-956455497)%Z); (5, (-2151253533)%Z)];
    [(3, (-622546510)%Z); (4, (-1061676062)%Z); (5, (-2011267999)%Z); (7, (-956455497)%Z)]];
  centre := ((4462460 # 1), (3346845 # 1))%Q;
  radius2 := (36093308018525 # 1)%Q;
  distance2 := (18978981 # 633825300114114700748351602688)%Q;
  letters := [(0, 6, 7, 1, false); (0, 7, 5, 6, true); (1, 6, 0, 2, false); (2, 6, 1, 7, false);
    (2, 7, 6, 3, true); (3, 7, 2, 8, true); (3, 8, 7, 4, false); (4, 8, 3, 5, false);
    (5, 7, 8, 0, false); (5, 8, 4, 7, false); (6, 0, 1, 7, false); (6, 1, 2, 0, false);
    (6, 2, 7, 1, false); (6, 7, 0, 2, true); (7, 0, 6, 5, true); (7, 2, 3, 6, true);
    (7, 3, 8, 2, true); (7, 5, 0, 8, false); (7, 6, 2, 0, true); (7, 8, 5, 3, true);
    (8, 3, 4, 7, false); (8, 4, 5, 3, false); (8, 5, 7, 4, false); (8, 7, 3, 5, true)]
|}.

Lemma branch_checked : check_branch sheet_drawing branch_certificate = true.
Proof. vm_compute. reflexivity. Qed.

(** Exactly one solution with these boundary heights has these signs.
    It is near the heights of the certificate, and has these letters. *)
Theorem the_branch :
  let near_by := real_heights (height branch_certificate) in
  let up := pops_up branch_certificate in
  exists h, has_rim this_sheet near_by h /\ solves this_sheet (fun _ => 0%R) h /\
  has_signs this_sheet up h /\
  (forall g, has_rim this_sheet near_by g -> solves this_sheet (fun _ => 0%R) g ->
    in_nappes this_sheet up g -> g = h) /\
  (energy this_sheet (minus h near_by) <= Q2R (distance2 branch_certificate))%R /\
  (forall i j l m valley, In (i, j, l, m, valley) (letters branch_certificate) ->
    (0 < sign valley * bend this_sheet i j l m h)%R).
Proof. exact (certified sheet_drawing branch_certificate sheet_checked branch_checked). Qed.
