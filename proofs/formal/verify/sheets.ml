(* The sheet of a certificate as it is verified, and what is said of it. *)

open Reading
module V = Verified

let plural n word =
  let ending = if n = 1 then word else if word.[String.length word - 1] = 'x' then
    String.sub word 0 (String.length word - 2) ^ "ices" else word ^ (if word = "branch" then "es" else "s") in
  Printf.sprintf "%d %s" n ending
let not_verified text = Printf.printf "not verified here: %s\n" text
let agrees key found expected = if found <> expected then invalid "the claim \"%s\" is %s, not %s" key found expected

(* The sheet of a file, without the vertices inside its triangulated triangles, and if a corner is reflex with a
   first triangle that closes its notch; [inside] are the vertices inside the sheet without these two. *)
type place = {
  file : sheet; thin : sheet; d : V.drawing; p : V.prepared; corner : int option; hidden : int list;
  common : (int * int * int) list; parts : V.part list; inside : int array; rim : int
}

(* A triangle of the file; the multipliers of a file of all branches are not needed for the proof. *)
let triangulated sheet multipliers j =
  only (if multipliers then "corners inside multipliers" else "corners inside") j;
  let one j = ignore (rational "a multiplier" j) in
  if multipliers then List.iter one (items "multipliers" (entry "multipliers" j));
  let vertex j = small ~most:(Array.length sheet.points - 1) "a vertex of a triangle" j in
  match List.map vertex (items "corners" (entry "corners" j)), items "inside" (entry "inside" j) with
  | [ a; b; c ], inside -> ((a, b, c), List.map vertex inside)
  | _ -> refuse "a triangle has not three corners"

(* Whether the boundary saddle of heights is positive: their sum with the weights of the affine dependency of the
   four boundary vertices. The vertex with the smallest number has a positive weight, or, if the others are in
   line, both ends of this line. The order of the four does not matter. *)
let positive_saddle sheet (a, b, c, d) h =
  let turn x y z =
    let (px, py), (qx, qy), (rx, ry) = sheet.points.(x), sheet.points.(y), sheet.points.(z) in
    Z.sub (Z.mul (Z.sub qx px) (Z.sub ry py)) (Z.mul (Z.sub qy py) (Z.sub rx px)) in
  let weights = [ (a, turn b c d); (b, Z.neg (turn a c d)); (c, turn a b d); (d, Z.neg (turn a b c)) ] in
  let first = Z.sign (List.assoc (min (min a b) (min c d)) weights) in
  let most = List.fold_left (fun n (_, w) -> n + Z.sign w) 0 weights in
  let sum = List.fold_left (fun s (v, w) -> Z.add s (Z.mul w h.(v))) Z.zero weights in
  Z.sign sum * (if first <> 0 then first else most) > 0

let place_of file triangles =
  let thin, hidden, common, parts = Proposing.emptied file triangles in
  let closed, corner = Proposing.closed thin hidden in
  let d = Proposing.drawing closed hidden in
  let p = Proposing.prepared thin d in
  let inside = List.filter (fun v -> corner <> Some v) d.inside in
  (* the drawings and the numbered folds that are proposed are those of the file *)
  let pair (a, b, c) = ((a, b), c) in
  let numbered = List.mapi (fun name (i, j, l, m) -> (name, (((i, j), l), m))) (Array.to_list (folds thin)) in
  if d.points <> Array.to_list file.points
    || List.sort compare (List.concat_map (fun (q : V.part) -> q.pieces) parts @ List.map pair common)
      <> List.sort compare (List.map pair file.triangles)
    || List.map (fun (f : V.fold_form) -> (f.name, f.ends)) p.folds <> numbered
  then failwith "the sheet that is proposed is not that of the file";
  (match d.border, corner with
  | [ w; x; y; z ], None ->
    (* the branches of a convex sheet are those with the height 1 at the last corner, 0 at the others *)
    let unit = Array.mapi (fun v _ -> if v = z then Z.one else Z.zero) file.points in
    if not (positive_saddle file (w, x, y, z) unit) then failwith "the last corner that is proposed does not have a positive saddle"
  | _ -> ());
  { file; thin; d; p; corner; hidden = List.concat_map snd triangles; common; parts;
    inside = Array.of_list (List.rev inside); rim = List.length d.border + List.length d.inside - List.length inside }

let shown_sheet t =
  Printf.printf "sheet     %s, %d inside and %d on the boundary, %s, %s\ndigest    %s\n%!"
    (plural (Array.length t.file.points) "vertex") (Array.length t.inside + List.length t.hidden) t.rim
    (plural (List.length t.file.triangles) "triangle") (plural (Array.length (folds t.file)) "fold") t.file.digest;
  Drawing.compare_with t.file

let check_sheet t =
  let opened = if t.corner = None then t.d.triangles else List.tl t.d.triangles in
  if not (V.sound t.d t.p && match t.corner with None -> true | Some r -> V.closes t.d r) then
    unverified "the sheet is not a convex triangulated one, nor one with a notch";
  if not (V.emptied t.d opened (List.map (fun (a, b, c) -> ((a, b), c)) t.common) t.parts) then
    unverified "the triangulated triangles are not those of the sheet"

let stay_flat t = if t.parts <> [] then
  Printf.printf "          The %s with %s inside %s flat, by theorem emptied_verified.\n"
    (plural (List.length t.parts) "triangle") (plural (List.length t.hidden) "vertex")
    (if List.length t.parts = 1 then "stays" else "stay")

(* Whether the equations of the file are proved to be those of a motion; of many faces this takes long. The answer is
   whether, moreover, the disk is the sheet in which branches are verified, with all its faces. *)
let meaning_of t =
  let faces = List.map (fun (a, b, c) -> ((a, b), c)) t.file.triangles in
  let none = Array.make (Array.length t.file.points) false in
  let whole () = Proposing.drawing (fst (Proposing.closed t.file none)) none in
  let disk (whole : V.drawing) =
    let inside = List.filter (fun v -> t.corner <> Some v) whole.inside in
    V.moves_as_a_disk whole inside faces (Proposing.gluing { whole with inside; triangles = faces }) in
  if List.length faces <= 1000 && disk (whole ()) then begin
    print_string "          Heights solve the equations if and only if they begin a motion that keeps all\n\
      \          lengths to second order, by theorem disk_moves.\n";
    t.d = whole () && t.d.triangles = faces
  end else (not_verified "that the equations are those of motions to second order"; false)

let all_continue theorem = Printf.printf "          Near the flat sheet each branch continues to one true motion, and there are no others:\n\
  \          by theorem %s.\n" theorem

let raised r = Printf.printf "          Signs and letters are those of the side on which vertex %d pops up when a triangle\n\
  \          closes the notch.\n" r

let flats text = List.filter (fun k -> text.[k] = 'F') (List.init (String.length text) Fun.id)

(* A letter F is refuted if the test passes with the letter of the heights in its place, and no others. *)
let refute_flat what (p : V.prepared) h flat passes =
  let own = Array.of_list (if flat = [] then [] else p.folds) in
  List.iter (fun k ->
    let bend = Z.sign (V.bent (fun u -> h.(u)) own.(k)) and ((i, j), _), _ = own.(k).ends in
    if bend <> 0 && passes (fun f -> if f = k then Some (bend > 0) else None) then
      invalid "%s: the fold %d, %d has the letter F and is not flat" what i j) flat

let letter_of root text k = match text.[k] with
  | 'M' -> Some false
  | 'V' -> Some true
  | 'U' | 'F' -> None
  | c -> refuse "root %d has a fold with the letter %c" root c

(* The claimed signs of all vertices inside the sheet of the file, by vertex; 0 in triangulated triangles. *)
let own_signs t signs =
  let all = Array.of_list (List.sort compare (t.hidden @ Array.to_list t.inside)) in
  if Array.length signs <> Array.length all then refuse "the numbers of signs and of vertices differ";
  let claimed = Hashtbl.create 64 in
  Array.iteri (fun k v -> Hashtbl.replace claimed v signs.(k)) all;
  List.iter (fun v -> if Hashtbl.find claimed v <> 0 then
    invalid "vertex %d lies inside a triangulated triangle, and its sign is not 0" v) t.hidden;
  claimed

(* The letters of the folds that are left without the triangulated triangles, of those of all folds. *)
let own_letters t text =
  let ends = Array.map (fun (i, j, _, _) -> (i, j)) (folds t.file) in
  if String.length text <> Array.length ends then refuse "the number of letters is wrong";
  let gone = Array.make (Array.length t.file.points) false in
  List.iter (fun v -> gone.(v) <- true) t.hidden;
  let places = Hashtbl.create 64 in
  Array.iteri (fun k (i, j) ->
    if (gone.(i) || gone.(j)) && not (String.contains "FU" text.[k]) then
      invalid "the fold %d, %d lies inside a triangulated triangle, and is not F" i j;
    Hashtbl.replace places (i, j) k) ends;
  let own = Array.of_list t.p.V.folds in
  String.init (Array.length own) (fun k -> let ((i, j), _), _ = own.(k).V.ends in text.[Hashtbl.find places (i, j)])

(* The claims of a file of all branches: how many there are, and of which sheet. *)
let check_claims t claims count =
  let claim key = match entry key claims with
    | Number n -> Z.to_string (digits key n)
    | _ -> refuse "%s is no number" key in
  let vertices = Array.length t.inside + List.length t.hidden in
  List.iter (fun (key, expected) -> agrees key (claim key) expected)
    [ ("interior", string_of_int vertices); ("boundary", "4");
      ("folds", string_of_int (Array.length (folds t.file))); ("degrees_of_freedom", "1"); ("distinct", count);
      ("with_multiplicity", Z.to_string (Z.shift_left Z.one vertices)); ("real", count); ("nonreal", "0") ];
  agrees "sha256" (string "sha256" (entry "sha256" claims)) t.file.digest
