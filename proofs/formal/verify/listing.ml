(* Certificates that list all branches, flat stars and multiplicities among them (version 2). *)

open Reading
open Sheets
module V = Verified

let branch_keys = "vertex_signs assignment multiplicity representative"
let claim_keys = "interior boundary folds degrees_of_freedom sha256 distinct with_multiplicity real nonreal true_branches"

(* What is claimed of a branch; whether it is said of the side with a positive saddle. *)
let claimed_of t number j =
  let signs = string "vertex_signs" (entry "vertex_signs" j) in
  let sign k = match signs.[k] with
    | '+' -> 1 | '-' -> -1 | '0' -> 0 | c -> refuse "branch %d has a vertex with the sign %c" number c in
  let claimed = own_signs t (Array.init (String.length signs) sign) in
  let text = own_letters t (string "assignment" (entry "assignment" j)) in
  let saddle = match string "representative" (entry "representative" j) with
    | "saddle" -> true
    | "either" when t.corner <> None -> false
    | side -> invalid "branch %d: its positive saddle is shown, not \"%s\"" number side in
  (claimed, text, saddle, small "multiplicity" (entry "multiplicity" j))

(* The proved test of a branch. *)
let passes t root = match t.corner with
  | None -> V.root_ok t.d t.p t.parts (List.nth t.d.border 3) root
  | Some r -> V.reflex_ok t.d t.p r t.parts (List.hd t.d.border) root

(* The sides from which the claims may be seen: with a reflex corner the test is of the side on which it pops up, where
   its height has the sign of [rise]; seen from the other side signs and letters are reversed. If the file says that the
   saddle is 0 or not known, the second ones, where it is known, refute this. *)
let sides t saddle = match t.corner with
  | None -> ([ (true, None) ], [])
  | Some r ->
    let up = Array.mapi (fun v _ -> if v = r then Z.one else Z.zero) t.file.points in
    let rise = match t.d.border with
      | [ a; b; c ] -> positive_saddle t.file (r, a, b, c) up
      | _ -> refuse "the sheet has not four corners" in
    let shown = [ (true, Some (Some rise)); (false, Some (Some (not rise))) ] in
    if saddle then (shown, []) else
      ([ (true, Some None); (false, Some None); (true, None); (false, None) ], shown @ List.map (fun (s, r) -> (not s, r)) shown)

(* The branches with evidence that is found for them, and how many letters F, and saddles, it does not decide. *)
let roots_of t chart classes entries =
  let { d; p; inside; _ } = t in
  let slot = Array.make (Array.length t.file.points) (-1) in
  List.iteri (fun k v -> slot.(v) <- k) d.inside;
  let lights = Array.of_list (List.map (Proposing.light slot) p.V.hubs) in
  let chart = Spaces.chart_of d p inside t.corner chart in
  let undecided = ref 0 and unknown = ref 0 in
  let root number (j, branch) =
    let claimed, text, saddle, times = claimed_of t number branch in
    let flat = List.filter (fun v -> Hashtbl.find claimed v = 0) (Array.to_list inside) in
    let near = Spaces.read chart classes j in
    let seen (shown, rise) =
      let signs_of v = match Hashtbl.find claimed v with 0 -> None | s -> Some ((s > 0) = shown) in
      let letters decided k = match text.[k] with
        | 'F' -> if decided then Some None else None
        | _ -> Option.map (fun w -> Some (w = shown)) (letter_of number text k) in
      let made (top, found) = let decided = match found with V.Near _ -> false | V.Within _ -> true in
        { V.signs_of; letters_of = letters decided; times; top; rise; found } in
      Option.map made
        (Spaces.evidence d lights chart flat (fun k -> text.[k] = 'F') near (fun e -> passes t (made e))) in
    let possible, refuting = sides t saddle in
    if Option.is_some (List.find_map seen refuting) then invalid "branch %d: its positive saddle is shown, not \"either\"" number;
    match List.find_map seen possible with
    | None -> unverified "branch %d did not pass the test" number
    | Some root ->
      if t.corner <> None && root.rise = None then incr unknown;
      String.iteri (fun k c -> if c = 'F' && root.letters_of k = None then begin
        incr undecided;
        let bent w = passes t { root with letters_of = fun f -> if f = k then Some (Some w) else root.letters_of f } in
        if bent true || bent false then invalid "branch %d has a fold with the letter F that is not flat" number
      end) text;
      root in
  let roots = List.mapi root entries in
  (roots, !undecided, !unknown)

(* The sheet of a listing, and the classes in its evidence. *)
let opened header evidence =
  ignore (entry "provenance" header);
  let classes = match string "kind" (entry "kind" evidence) with
    | "isolated" -> only "kind triangles chart roots block" evidence; Items []
    | "algebraic" -> only "kind triangles chart multipliers separating classes roots block" evidence; entry "classes" evidence
    | kind -> refuse "the evidence is \"%s\", not a list of roots" kind in
  let file = sheet (entry "pattern" header) in
  let triangles = items "triangles" (entry "triangles" evidence) in
  let t = place_of file (List.map (triangulated file true) triangles) in
  let size = Array.length t.inside in
  if t.rim <> 4 then refuse "the sheet has %d boundary vertices, not four" t.rim;
  if t.corner = None && entry "chart" evidence <> Null then refuse "the chart is one of a sheet with a reflex corner";
  if size > 30 || size + List.length t.hidden > 60 then refuse "%d vertices inside are too many" size;
  (t, classes)

let all_roots header entries claims =
  let t, classes = opened header (entry "evidence" header) in
  let { d; p; parts; _ } = t in
  shown_sheet t;
  check_sheet t;
  check_claims t claims (string_of_int (List.length entries));
  let roots, undecided, unknown = roots_of t (entry "chart" (entry "evidence" header)) classes entries in
  let common = List.map (fun (a, b, c) -> ((a, b), c)) t.common in
  if not (match t.corner with
    | None -> V.verify_listed d p common parts roots
    | Some r -> V.verify_reflex d p r common parts roots) then unverified "some sign vector agrees with none of the branches, or with several";
  let simple = List.for_all (fun (r : V.root) -> List.for_all (fun v -> r.signs_of v <> None) (Array.to_list t.inside)) roots in
  let continued = string "true_branches" (entry "true_branches" claims) in
  agrees "true_branches" continued (if simple then "proved" else "undecided");
  Printf.printf "VERIFIED  exactly %s to second order, complex ones included; all are real and different.\n\
    \          They have the signs, flat vertices and letters M and V of the file. %s agrees with one;\n\
    \          the multiplicity of the file is how many agree with a branch. By theorem %s.\n"
    (plural (List.length roots) "branch")
    (match t.corner with
    | None -> "Each sign vector"
    | Some r -> Printf.sprintf "Seen from the side on which\n\
      \          vertex %d pops up when a triangle closes the notch, each sign vector" r)
    (if t.corner = None then "listed_verified" else "reflex_verified");
  if t.corner <> None then print_string "          The file shows a branch from the side with the positive saddle; \"either\": from one of both.\n";
  stay_flat t;
  let continue = meaning_of t && simple && t.corner = None in
  if continue then all_continue "listed_continue";
  if unknown > 0 then not_verified (Printf.sprintf "that the saddle of %s is not known" (plural unknown "branch"));
  if undecided > 0 then not_verified (Printf.sprintf "%s F" (plural undecided "letter"));
  if simple && not continue then not_verified "that every branch continues to a true motion"

(* The entries of the blocks, each with its root and what is claimed of it. *)
let in_blocks evidence blocks =
  match evidence with
  | Entries pairs when List.mem_assoc "roots" pairs ->
    let number = small "roots" (entry "roots" evidence) and block = small ~least:1 "block" (entry "block" evidence) in
    if List.length blocks <> (number + block - 1) / block then invalid "the number of blocks is wrong";
    let read k text =
      let j = parse text in
      only "block roots" j;
      if small "block" (entry "block" j) <> k then invalid "block %d is expected" k;
      let roots = items "roots" (entry "roots" j) in
      if List.length roots <> min block (number - (k * block)) then invalid "block %d has another number of roots" k;
      List.map (fun e -> only ("root " ^ branch_keys) e; (entry "root" e, e)) roots in
    List.concat (List.mapi read blocks)
  | _ -> []

let of_lines header blocks claims =
  only "format version pattern evidence provenance" header;
  only claim_keys claims;
  all_roots header (in_blocks (entry "evidence" header) blocks) claims

(* The entries of a listing in one object. *)
let in_object data =
  let evidence = entry "evidence" data in
  let roots = match evidence with
    | Entries pairs when List.mem_assoc "roots" pairs -> items "roots" (entry "roots" evidence)
    | _ -> [] in
  let branches = items "branches" (entry "branches" (entry "claims" data)) in
  if List.length roots <> List.length branches then invalid "the numbers of roots and of branches differ";
  List.iter (only branch_keys) branches;
  List.combine roots branches

let of_object data =
  only "format version pattern claims evidence provenance" data;
  only (claim_keys ^ " branches") (entry "claims" data);
  all_roots data (in_object data) (entry "claims" data)
