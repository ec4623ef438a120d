(* exactfold-verify: verifies certificates of exactfold with a program that is proved in Coq. *)

open Reading
module V = Verified

let usage = "usage: exactfold-verify FILE\n\n\
  Verifies a certificate of all branches (version 1 of the compact form) or of one branch (version 1) of\n\
  a convex triangulated sheet. Exit codes: 0 verified, 1 refuted, 2 usage, 3 not a certificate of these kinds.\n"

(* How many letters F the accepted roots have: the formal proof says nothing of them. *)
let flat = ref 0
let flats text = String.fold_left (fun n c -> if c = 'F' then n + 1 else n) 0 text

let not_verified text = Printf.printf "not verified here: %s\n" text

let verified format = Printf.ksprintf (fun text ->
  Printf.printf "VERIFIED  %s\n" text;
  if !flat > 0 then not_verified (Printf.sprintf "the %d letters F" !flat)) format

let agrees key found expected = if found <> expected then invalid "the claim \"%s\" is %s, but %s is true" key found expected

let shown_sheet sheet (d : V.drawing) =
  Printf.printf "sheet     %d vertices, %d inside and %d on the boundary, %d triangles, %d folds\ndigest    %s\n%!"
    (Array.length sheet.points) (List.length d.inside) (List.length d.border) (List.length sheet.triangles)
    (Array.length (folds sheet)) sheet.digest

let whole_claim claims key = Z.to_string (whole key (entry key claims))

let sheet_claims sheet (d : V.drawing) claims =
  agrees "interior" (whole_claim claims "interior") (string_of_int (List.length d.inside));
  agrees "sha256" (string "sha256" (entry "sha256" claims)) sheet.digest

(* --- all branches --- *)

type root = { bits : int; center : Z.t array; letters : int -> bool option; flat : int }

let signed bytes at width =
  let negative = Char.code (Bytes.get bytes (at + width - 1)) > 127 in
  let n = Z.of_bits (Bytes.sub_string bytes at width) in
  if negative then Z.sub n (Z.shift_left Z.one (8 * width)) else n

let letter_of root text k = match text.[k] with
  | 'M' -> Some false
  | 'V' -> Some true
  | 'U' | 'F' -> None
  | c -> refuse "root %d has a fold with the letter %c" root c

(* The roots of a block, which are read one by one. *)
let block size folds number length data =
  let j = parse data in
  only "block bits width centers radii folds exact open" j;
  if small "block" (entry "block" j) <> number then refuse "block %d is expected" number;
  if items "open" (entry "open" j) <> [] then invalid "block %d has open roots" number;
  let bits = small "bits" (entry "bits" j) and width = small "width" (entry "width" j) in
  let bytes key each = let found = decoded key (string key (entry key j)) in
    if Bytes.length found <> length * each then refuse "block %d: \"%s\" has another length" number key; found in
  let row = (folds + 7) / 8 in
  let centers = bytes "centers" (size * width) and letters = bytes "folds" row and radii = bytes "radii" 1 in
  let exact = List.map (fun e -> (small "root" (entry "root" e), e)) (items "exact" (entry "exact" j)) in
  fun index ->
    let given = List.filter (fun (k, _) -> k = index) exact in
    if (List.length given = 1) <> (Bytes.get radii index = '\255') then
      invalid "root %d of block %d is given twice or not at all" index number;
    match List.assoc_opt index given with
    | Some e ->
      let text = string "assignment" (entry "assignment" e) in
      if String.length text <> folds then refuse "root %d has another number of letters" index;
      { bits = small "bits" (entry "bits" e); letters = letter_of index text; flat = flats text;
        center = Array.of_list (List.map (whole "center") (items "center" (entry "center" e))) }
    | None ->
      { bits; flat = 0; center = Array.init size (fun k -> signed centers (((index * size) + k) * width) width);
        letters = fun k -> Some (Char.code (Bytes.get letters ((index * row) + (k / 8))) lsr (k mod 8) land 1 = 1) }

let precisions = [ 56; 72; 96; 128; 256; 512; 1024 ]

let all_branches header blocks claims =
  let evidence = entry "evidence" header in
  only "format version pattern evidence provenance" header;
  only "kind triangles chart block" evidence;
  if string "kind" (entry "kind" evidence) <> "chambers" then refuse "unknown kind of evidence";
  only "interior boundary folds degrees_of_freedom sha256 distinct with_multiplicity real nonreal true_branches" claims;
  let sheet = sheet (entry "pattern" header) in
  if items "triangles" (entry "triangles" evidence) <> [] then
    refuse "the sheet has triangulated triangles, which are not in the scope of the formal proof";
  let d = Proposing.drawing sheet in
  if entry "chart" evidence <> Null then refuse "the chart is one of a sheet with a reflex corner";
  let inside = Array.of_list (List.rev d.inside) in
  let size = Array.length inside in
  if List.length d.border <> 4 then refuse "the sheet has %d boundary vertices, not four" (List.length d.border);
  if size = 0 || size > 30 then refuse "%d vertices inside: between 1 and 30 are verified" size;
  let length = small "block" (entry "block" evidence) in
  if length <= 0 || 1 lsl size mod length <> 0 || List.length blocks <> 1 lsl size / length then refuse "the number of blocks is wrong";
  shown_sheet sheet d;
  let p = Proposing.prepared sheet d in
  let folds = List.length p.V.folds in
  let blocks = Array.of_list blocks in
  let slot = Array.make (Array.length sheet.points) (-1) in
  List.iteri (fun k v -> slot.(v) <- k) d.inside;
  let lights = Array.of_list (List.map (Proposing.light slot) p.V.hubs) and rough = Proposing.rough p in
  let unit = List.nth d.border 3 in
  let number e = let n = ref 0 in Array.iteri (fun k v -> if not (e v) then n := !n lor (1 lsl k)) inside; !n in
  let now = ref (-1, fun _ -> assert false) in
  let root n =
    if fst !now <> n / length then now := (n / length, block size folds (n / length) length blocks.(n / length));
    snd !now (n mod length) in
  let heights root bits =
    let h = Array.make (Array.length sheet.points) Z.zero in
    let shift = bits - root.bits in
    Array.iteri (fun k v -> let c = root.center.(k) in
      h.(v) <- if shift >= 0 then Z.shift_left c shift else Z.shift_right c (-shift)) inside;
    h.(unit) <- Z.shift_left Z.one bits;
    h in
  (* what is proposed for a sign vector: with more and more digits, until floating point, or if careful
     the verified test itself, finds all letters decided *)
  let verify careful =
    let proposed = ref (-1, [||], fun _ -> None) in
    flat := 0;
    let propose e =
      let n = number e in
      let known, _, _ = !proposed in
      if known <> n then begin
        let root = root n in
        if Array.length root.center <> size then refuse "root %d has another number of heights" n;
        let rec refine = function
          | [] -> raise Exit
          | bits :: more ->
            let aim = bits - 14 in
            let h = heights root bits in
            if not (careful || more = [] || Proposing.clear rough h bits aim) then refine more
            else begin
              for _ = 0 to (bits - 40) / 40 do Proposing.step lights h bits aim done;
              if careful && not (V.passes p e (fun u -> h.(u)) root.letters) then refine more else h
            end in
        let h = refine precisions in
        let done_ = (1 lsl size) - n in
        if done_ land 4095 = 0 && size > 13 then Printf.eprintf "\r%d of %d roots%!" done_ (1 lsl size);
        flat := !flat + root.flat;
        proposed := (n, h, root.letters)
      end in
    let top e = propose e; let _, h, _ = !proposed in h.(unit) in
    let given e = propose e; let _, h, _ = !proposed in fun u -> h.(u) in
    let asked e = propose e; let _, _, letters = !proposed in letters in
    (try V.verify_all d p top given asked with Exit -> false), !proposed in
  if not (fst (verify false)) then begin
    let good, (last, _, _) = verify true in
    if not good then invalid "the sheet or a root was not verified; the last one was root %d" last
  end;
  if size > 13 then prerr_newline ();
  let count = string_of_int (1 lsl size) in
  sheet_claims sheet d claims;
  List.iter (fun (key, true_) -> agrees key (whole_claim claims key) true_)
    [ ("distinct", count); ("with_multiplicity", count); ("real", count); ("nonreal", "0"); ("boundary", "4");
      ("folds", string_of_int folds); ("degrees_of_freedom", "1") ];
  agrees "true_branches" (string "true_branches" (entry "true_branches" claims)) "proved";
  verified "exactly %s branches to second order, complex ones included; all are real and\n\
    \          simple, one for each sign vector; all letters M and V. By theorem all_verified." count;
  not_verified "that every branch continues to a true motion"

(* --- one branch --- *)

let one_branch data =
  let claims = entry "claims" data and evidence = entry "evidence" data in
  only "format version pattern claims evidence provenance" data;
  only "gauge vertex_signs assignment squared_distance" claims;
  only "emptied heights denominator" evidence;
  let sheet = sheet (entry "pattern" data) in
  if items "emptied" (entry "emptied" evidence) <> [] then
    refuse "the sheet has triangulated triangles, which are not in the scope of the formal proof";
  let d = Proposing.drawing sheet in
  shown_sheet sheet d;
  let p = Proposing.prepared sheet d in
  let h = Array.of_list (List.map (whole "a height") (items "heights" (entry "heights" evidence))) in
  let inside = Array.of_list (List.rev d.V.inside) in
  let signs = Array.of_list (List.map (small "a vertex sign") (items "vertex_signs" (entry "vertex_signs" claims))) in
  if Array.length h <> Array.length sheet.points || Array.length signs <> Array.length inside then
    refuse "the numbers of heights, signs and vertices differ";
  (* a vertex that is claimed to be flat lies in both closed nappes: it is verified in one *)
  let ups = Array.make (Array.length h) false in
  Array.iteri (fun k v -> ups.(v) <- signs.(k) > 0) inside;
  let claimed = Hashtbl.create 64 in
  Array.iteri (fun k v -> Hashtbl.replace claimed v signs.(k)) inside;
  List.iter (fun (b : V.hub) ->
    let v = b.at_vertex in
    if Hashtbl.find claimed v = 0 then ups.(v) <- Z.gt (snd (V.measured (fun u -> h.(u)) h.(v) b.wedges)) Z.zero) p.V.hubs;
  List.iter (fun (b : V.hub) ->
    if Z.sign (fst (V.measured (fun u -> h.(u)) h.(b.at_vertex) b.wedges)) = 0 then
      refuse "the heights have curvature 0 at vertex %d; heights with positive curvatures are verified here" b.at_vertex) p.V.hubs;
  let text = string "assignment" (entry "assignment" claims) in
  if String.length text <> List.length p.V.folds then refuse "the number of letters is wrong";
  let letters = letter_of 0 text in
  flat := flats text;
  if not (V.verify_one d p (fun v -> ups.(v)) (fun u -> h.(u)) letters) then
    invalid "the sheet or the branch was not verified";
  let bent = List.filter (fun b -> V.is_bent letters b) p.V.hubs in
  List.iter (fun (b : V.hub) -> if Hashtbl.find claimed b.at_vertex = 0 then
    invalid "vertex %d has the sign 0, but a fold with a letter M or V" b.at_vertex) bent;
  let others = Array.length inside - List.length bent in
  verified "exactly one solution over these boundary heights lies in the closed nappes of these\n\
    \          signs. It has the signs of %d vertices and all letters M and V. By theorem one_verified." (List.length bent);
  if others > 0 then not_verified (Printf.sprintf "whether %d vertices are flat" others);
  not_verified "the squared distance"

let verify path =
  let text = file path in
  let first = try String.sub text 0 (String.index text '\n') with Not_found -> text in
  if String.contains first '\t' then
    match List.map Fun.id (lines text) with
    | header :: rest when rest <> [] ->
      let header = parse header in
      if string "format" (entry "format" header) <> "exactfold compact certificate" || whole_claim header "version" <> "1" then
        refuse "only version 1 of compact certificates is verified here";
      let reversed = List.rev rest in
      let claims = match parse (List.hd reversed) with
        | Entries [ ("claims", c) ] -> c
        | _ -> invalid "the file is UNFINISHED: its last line has no claims" in
      all_branches header (List.rev (List.tl reversed)) claims
    | _ -> refuse "the file has no blocks"
  else begin
    let data = parse text in
    if string "format" (entry "format" data) <> "exactfold branch" || whole_claim data "version" <> "1" then
      refuse "only version 1 of certificates of one branch is verified here";
    one_branch data
  end

let () =
  match Sys.argv with
  | [| _; ("-h" | "--help") |] -> print_string usage
  | [| _; path |] -> (try verify path with
    | Invalid why -> Printf.printf "INVALID   %s\n" why; exit 1
    | Refused why -> Printf.eprintf "exactfold-verify: %s\n" why; exit 3
    | Sys_error why -> Printf.eprintf "exactfold-verify: %s\n" why; exit 3)
  | _ -> prerr_string usage; exit 2
