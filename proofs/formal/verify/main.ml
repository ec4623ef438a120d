(* exactfold-verify: verifies certificates of exactfold with a program that is proved in Coq. *)

open Reading
open Sheets
module V = Verified

let usage = "usage: exactfold-verify FILE [DRAWING.fold]\n\n\
  Verifies a certificate of all branches or of one branch (version 1) of a triangulated\n\
  sheet that is convex, or has four corners of which one is reflex, and says what of the file it does not verify.\n\
  With a drawing, it also compares the vertices and faces of the sheet with those written there.\n\
  Exit codes: 0 verified; 1 refuted, or not verified; 2 usage; 3 not a certificate that is read here;\n\
  70 a defect, or memory is short.\n"

(* --- all branches --- *)

(* [flat] are the folds with the letter F, of which the formal proof says nothing. *)
type root = { bits : int; center : Z.t array; letters : int -> bool option; flat : int list }

let signed bytes at width =
  let negative = Char.code (Bytes.get bytes (at + width - 1)) > 127 in
  let n = Z.of_bits (Bytes.sub_string bytes at width) in
  if negative then Z.sub n (Z.shift_left Z.one (8 * width)) else n

(* The roots of a block, which are read one by one. *)
let block size folds number length data =
  let j = parse data in
  only "block bits width centers radii folds exact open" j;
  if small "block" (entry "block" j) <> number then refuse "block %d is expected" number;
  if items "open" (entry "open" j) <> [] then invalid "block %d has open roots" number;
  let bits = small ~most:52 "bits" (entry "bits" j) and width = small ~least:1 ~most:8 "width" (entry "width" j) in
  let bytes key each = let found = decoded key (string key (entry key j)) in
    if Bytes.length found <> length * each then refuse "block %d: \"%s\" has another length" number key; found in
  let row = (folds + 7) / 8 in
  let centers = bytes "centers" (size * width) and letters = bytes "folds" row and radii = bytes "radii" 1 in
  let bit index k = Char.code (Bytes.get letters ((index * row) + (k / 8))) lsr (k mod 8) land 1 = 1 in
  let read e =
    only "root bits radius center assignment" e;
    let index = small ~most:(length - 1) "root" (entry "root" e) and text = string "assignment" (entry "assignment" e) in
    ignore (positive "radius" (entry "radius" e));
    if String.length text <> folds then refuse "root %d has another number of letters" index;
    let center = Array.of_list (List.map (whole "center") (items "center" (entry "center" e))) in
    if Array.length center <> size then refuse "root %d has another number of heights" index;
    (index, { bits = small ~most:4000 "bits" (entry "bits" e); letters = letter_of index text; flat = flats text; center }) in
  let exact = List.map read (items "exact" (entry "exact" j)) in
  fun index ->
    let given = List.filter (fun (k, _) -> k = index) exact and radius = Char.code (Bytes.get radii index) in
    if radius <> 255 && radius > 52 then refuse "root %d of block %d has no such radius" index number;
    match given, radius = 255 with
    | [ (_, root) ], true -> root
    | [], false ->
      for k = folds to (8 * row) - 1 do if bit index k then refuse "a bit of no fold is set" done;
      { bits; flat = []; center = Array.init size (fun k -> signed centers (((index * size) + k) * width) width);
        letters = fun k -> Some (bit index k) }
    | _ -> invalid "root %d of block %d is given twice or not at all" index number

(* The chart of a sheet with a reflex corner: the whole weights of a functional, and the height of this corner, in
   units of 2^-bits, over the heights of the vertices inside, so that the functional is 1. *)
let notch_chart j corner inside =
  let vertices = corner :: Array.to_list inside in
  only (String.concat " " (List.map string_of_int vertices)) j;
  let names = match j with Entries pairs -> List.map fst pairs | _ -> refuse "the chart is not that of the closed notch" in
  let weights = List.filter_map (fun v -> let name = string_of_int v in
    if List.mem name names then Some (v, rational "a weight of the chart" (entry name j)) else None) vertices in
  let unit = List.fold_left (fun n (_, (_, q)) -> Z.lcm n q) Z.one weights in
  let whole = List.map (fun (v, (p, q)) -> (v, Z.mul p (Z.div unit q))) weights in
  let lead = match List.assoc_opt corner whole with
    | Some w when not (Z.equal w Z.zero) -> w
    | _ -> refuse "the chart does not fix the height of the reflex corner" in
  let rest h = List.fold_left (fun s (v, w) -> if v = corner then s else Z.add s (Z.mul w h.(v))) Z.zero whole in
  ((fun v -> Option.value (List.assoc_opt v whole) ~default:Z.zero),
    fun h bits -> Z.div (Z.sub (Z.shift_left unit bits) (rest h)) lead)

let all_branches header blocks claims =
  let evidence = entry "evidence" header in
  only "format version pattern evidence provenance" header;
  only "kind triangles chart block" evidence;
  only "interior boundary folds degrees_of_freedom sha256 distinct with_multiplicity real nonreal true_branches" claims;
  ignore (entry "provenance" header);
  if string "kind" (entry "kind" evidence) <> "chambers" then refuse "unknown kind of evidence";
  let file = sheet (entry "pattern" header) in
  let triangles = items "triangles" (entry "triangles" evidence) in
  let t = place_of file (List.map (triangulated file true) triangles) in
  let { d; p; corner; inside; _ } = t in
  let size = Array.length inside in
  if t.rim <> 4 then refuse "the sheet has %d boundary vertices, not four" t.rim;
  if size = 0 || size > 30 then refuse "%d vertices inside: between 1 and 30 are verified" size;
  let lifted = match corner, entry "chart" evidence with
    | None, Null -> None
    | None, _ -> refuse "the chart is one of a sheet with a reflex corner"
    | Some r, chart -> Some (notch_chart chart r inside) in
  let length = small ~least:1 "block" (entry "block" evidence) in
  if 1 lsl size mod length <> 0 || List.length blocks <> 1 lsl size / length then refuse "the number of blocks is wrong";
  shown_sheet t;
  check_sheet t;
  (match lifted, corner with
  | Some (weights, _), Some r ->
    let tilted, times = Proposing.form_of d p r weights in
    if not (V.names_side d p r weights tilted times) then
      unverified "the chart does not name the side on which vertex %d pops up when a triangle closes the notch" r
  | _ -> ());
  let folds = List.length p.V.folds and count = string_of_int (1 lsl size) in
  check_claims t claims count;
  let continued = string "true_branches" (entry "true_branches" claims) in
  if continued <> "proved" then invalid "the claim \"true_branches\" is not \"proved\", as in every file of this version";
  let blocks = Array.of_list blocks in
  let slot = Array.make (Array.length file.points) (-1) in
  List.iteri (fun k v -> slot.(v) <- k) d.inside;
  let lights = Array.of_list (List.map (Proposing.light slot) p.V.hubs) and rough = Proposing.rough corner p in
  let number e = let n = ref 0 in Array.iteri (fun k v -> if not (e v) then n := !n lor (1 lsl k)) inside; !n in
  let now = ref (-1, fun _ -> assert false) in
  let root n =
    if fst !now <> n / length then now := (n / length, block size folds (n / length) length blocks.(n / length));
    snd !now (n mod length) in
  let heights root bits =
    let h = Proposing.shifted (Array.length file.points) inside root.center root.bits bits in
    (match lifted, corner with
    | Some (_, height), Some r -> h.(r) <- height h bits
    | _ -> h.(List.nth d.border 3) <- Z.shift_left Z.one bits);
    h in
  let passes e h letters = match corner with
    | None -> V.passes p (fun _ -> false) e (fun u -> h.(u)) letters
    | Some r -> V.raised_passes d p r e (fun u -> h.(u)) letters in
  let current = ref (-1) and flat = ref 0 in
  (* What is proposed for a sign vector. It depends on the sign vector alone, and its array is never changed after
     it is handed over; so the theorem, which is about functions, applies. *)
  let verify careful =
    let proposed = ref (-1, [||], fun _ -> None) in
    current := -1;
    flat := 0;
    let propose e =
      let n = number e in
      if !current <> n then begin
        current := n;
        let root = root n in
        let h = Proposing.refined lights rough corner careful (fun h -> passes e h root.letters) (heights root) in
        let done_ = (1 lsl size) - n in
        if done_ land 4095 = 0 && size > 13 then Printf.eprintf "\r%d of %d roots%!" done_ (1 lsl size);
        refute_flat (Printf.sprintf "root %d" n) p h root.flat (passes e h);
        flat := !flat + List.length root.flat;
        proposed := (n, h, root.letters)
      end in
    let top e = propose e; let _, h, _ = !proposed in h.(List.nth d.border 3) in
    let given e = propose e; let _, h, _ = !proposed in fun u -> h.(u) in
    let asked e = propose e; let _, _, letters = !proposed in letters in
    try match corner with
      | None -> V.verify_all d p top given asked
      | Some r -> V.verify_all_notched d p r given asked
    with Exit -> false in
  if not (verify false || verify true) then begin
    let n = !current in
    if n >= 0 then List.iter (fun (b : V.hub) -> if corner <> Some b.at_vertex && not (V.is_bent (root n).letters b) then
      refuse "root %d: vertex %d has no fold with the letter M or V" n b.at_vertex) p.V.hubs;
    unverified "root %d did not pass the test" n
  end;
  if size > 13 then prerr_newline ();
  Printf.printf "VERIFIED  exactly %s branches to second order, complex ones included; all are real and\n\
    \          %s, one for each sign vector; their folds have the letters M and V of the file.\n\
    \          By theorem %s.\n" count (if t.parts = [] then "simple" else "different")
    (match corner, t.parts with
    | None, [] -> "all_verified"
    | None, _ -> "all_emptied_verified"
    | Some _, [] -> "all_notched_verified"
    | Some _, _ -> "all_notched_emptied_verified");
  Option.iter (fun r -> raised r;
    print_string "          The chart of the file names this side, by theorem chart_verified.\n") corner;
  stay_flat t;
  let continue = meaning_of t in
  if continue then all_continue "all_continue";
  if !flat > 0 then not_verified (Printf.sprintf "%s F" (plural !flat "letter"));
  if t.parts <> [] then not_verified "the multiplicity of each branch";
  if not continue then not_verified "that every branch continues to a true motion"

(* --- files --- *)

let other format version why = refuse "the file is \"%s\", version %s%s; only \"exactfold compact certificate\", version 2 of \
  \"exactfold certificate\" and version 1 of \"exactfold branch\" are verified here" format version why

let verify path =
  let text = file path in
  let first = try String.sub text 0 (String.index text '\n') with Not_found -> text in
  let size = String.length first in
  let kind data = match entry "format" data, entry "version" data with
    | Text format, Number version -> (format, version)
    | _ -> refuse "the format or the version is missing" in
  if size > 65 && first.[size - 65] = '\t' then
    match lines text with
    | header :: (_ :: _ as rest) ->
      let header = parse header in
      let reversed = List.rev rest in
      let claims () = match parse (List.hd reversed) with
        | Entries [ ("claims", c) ] -> c
        | _ -> invalid "the file is UNFINISHED: its last line has no claims" in
      let all = match kind header with
        | "exactfold compact certificate", "1" -> all_branches
        | "exactfold compact certificate", "2" -> Listing.of_lines
        | format, version -> other format version "" in
      all header (List.rev (List.tl reversed)) (claims ())
    | _ -> invalid "the file is UNFINISHED: it has no blocks"
  else begin
    let data = parse text in
    match kind data with
    | "exactfold branch", "1" -> Branch.one_branch data
    | "exactfold certificate", "2" -> Listing.of_object data
    | ("exactfold branch" as format), "2" -> other format "2" ", of a sheet with angle deficits"
    | ("exactfold branch" as format), "3" -> other format "3" ", with merged faces"
    | format, version -> other format version ""
  end

let main path =
  let fail ?(name = path) code format = Printf.ksprintf (fun why ->
    Printf.eprintf "exactfold-verify: %s: %s\n" name why; exit code) format in
  try verify path; flush stdout with
    | Invalid why -> Printf.printf "INVALID   %s\n" why; exit 1
    | Unverified why -> Printf.printf "NOT VERIFIED  %s\n" why; exit 1
    | Refused why -> fail 3 "%s" why
    | Drawing.Unread why -> fail ~name:(Option.get !Drawing.wanted) 3 "%s" why
    | Stack_overflow -> fail 70 "the stack is too small for this file: run `ulimit -s unlimited` first"
    | Sys_error why -> fail 3 "%s" why
    | error -> fail 70 "nothing is known of this file: %s" (Printexc.to_string error)

let () = match Sys.argv with
  | [| _; ("-h" | "--help") |] -> print_string usage
  | [| _; path |] -> main path
  | [| _; path; drawing |] -> Drawing.wanted := Some drawing; main path
  | _ -> prerr_string usage; exit 2
