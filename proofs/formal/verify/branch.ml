(* Certificates of one branch. *)

open Reading
open Sheets
module V = Verified

let continues proved theorem =
  if proved then Printf.printf "          It continues to one true motion, with the boundary at multiples of these heights,\n\
    \          by theorem %s.\n" theorem
  else not_verified "that it continues to a true motion"

(* Heights near a solution; [zeros] vertices are claimed to be flat. The squared distance of the heights as integers
   is claimed to be at most [top] / [below]. *)
let near_branch t claimed h text zeros (top, below) =
  let { d; p; corner; _ } = t in
  (* a vertex that is claimed to be flat lies in both closed nappes: the test is made in that of the heights *)
  let ups = Array.make (Array.length h) false in
  List.iter (fun (b : V.hub) ->
    let v = b.at_vertex in
    let curved, side = V.measured (fun u -> h.(u)) h.(v) b.wedges in
    if Z.equal curved Z.zero then
      refuse "the heights have curvature 0 at vertex %d; heights with positive curvatures are verified here" v;
    ups.(v) <- (if Hashtbl.find claimed v = 0 then Z.gt side Z.zero else Hashtbl.find claimed v > 0)) p.V.hubs;
  let letters = letter_of 0 text in
  let up v = ups.(v) and given u = h.(u) in
  let test letters = match corner with
    | None -> V.passes p (fun _ -> false) up given letters
    | Some r -> V.raised_passes d p r up given letters in
  if not (match corner with
    | None -> V.verify_one d p up given letters
    | Some r -> V.verify_one_notched d p r up given letters) then unverified "the branch did not pass the test";
  let bent = List.filter (fun (b : V.hub) -> corner <> Some b.at_vertex && V.is_bent letters b) p.V.hubs in
  List.iter (fun (b : V.hub) -> if Hashtbl.find claimed b.at_vertex = 0 then
    invalid "vertex %d has the sign 0, but a fold with a letter M or V" b.at_vertex) bent;
  let others = Array.length t.inside - List.length bent and flat = flats text in
  refute_flat "the branch" p h flat test;
  Printf.printf "VERIFIED  exactly one %s lies in the closed nappes of %s.\n\
    \          %sBy theorem %s.\n"
    (if corner = None then "solution over these boundary heights" else "branch")
    (if zeros = 0 then "these signs" else "these signs,\n          at vertices with the sign 0 those of the heights")
    (match List.length bent with
    | 0 when not (String.exists (fun c -> c = 'M' || c = 'V') text) -> ""
    | 0 -> "It has the letters M and V of the file. "
    | n -> Printf.sprintf "It has the letters M and V of the file, and the signs of the %s where they\n          end. "
      (if n = 1 then "vertex" else plural n "vertex"))
    (if corner = None then "one_verified" else "one_notched_verified");
  Option.iter raised corner;
  let near = corner = None && V.within p up given top below in
  if near then print_string "          It has the squared distance of the file, by theorem distance_verified.\n";
  stay_flat t;
  continues (meaning_of t && others = 0) "one_continues";
  if flat <> [] then not_verified (Printf.sprintf "%s F" (plural (List.length flat) "letter"));
  if others > 0 then not_verified (Printf.sprintf "the signs of %s, where no such letter is" (plural others "other vertex"));
  if not near then not_verified "the squared distance"

(* Heights that solve the equations exactly. *)
let exact_branch t claimed h text distance =
  let { d; p; corner; _ } = t in
  let sign v = match Hashtbl.find claimed v with 0 -> None | s -> Some (s > 0) in
  let kept v = corner = Some v and given u = h.(u) in
  let letters k = match text.[k] with
    | 'U' -> None
    | 'F' -> Some None
    | _ -> Some (letter_of 0 text k) in
  List.iter (fun (b : V.hub) -> if not (V.exact_hub kept sign given b) then
    invalid "vertex %d does not have the claimed sign" b.at_vertex) p.V.hubs;
  List.iter (fun (f : V.fold_form) -> if not (V.exact_fold given letters f) then
    let ((i, j), _), _ = f.ends in invalid "the fold %d, %d does not have its letter" i j) p.V.folds;
  if not (match corner with
    | None -> V.verify_exact d p kept sign given letters
    | Some r -> V.verify_exact_notched d p r sign given letters) then unverified "the branch did not pass the test";
  if corner = None && Z.lt (fst distance) Z.zero then
    invalid "the squared distance is 0, which is more than claimed";
  Printf.printf "VERIFIED  exactly one %s has these signs, 0 where a vertex is flat.\n\
    \          Its heights are %sthose of the file, and it has all letters of the file,\n\
    \          F among them. By theorem %s.\n"
    (if corner = None then "solution over these boundary heights" else "branch")
    (if corner = None then "" else "a multiple of ")
    (if corner = None then "exact_verified" else "exact_notched_verified");
  Option.iter raised corner;
  stay_flat t;
  continues (meaning_of t && List.for_all (fun v -> sign v <> None) d.V.inside) "exact_continues";
  if corner <> None then not_verified "the squared distance"

let one_branch data =
  let claims = entry "claims" data and evidence = entry "evidence" data in
  only "format version pattern claims evidence provenance" data;
  only "gauge vertex_signs assignment squared_distance" claims;
  only "emptied heights denominator" evidence;
  let file = sheet (entry "pattern" data) in
  let triangles = items "emptied" (entry "emptied" evidence) in
  let t = place_of file (List.map (triangulated file false) triangles) in
  let { d; p; corner; inside; _ } = t in
  shown_sheet t;
  check_sheet t;
  let given = Array.of_list (items "heights" (entry "heights" evidence)) in
  if Array.length given <> Array.length file.points then refuse "the numbers of heights and of vertices differ";
  let gone = Array.make (Array.length given) false in
  List.iter (fun v -> gone.(v) <- true) t.hidden;
  let height v j = match j with
    | Null when gone.(v) -> Z.zero
    | _ when gone.(v) -> invalid "vertex %d lies inside a triangulated triangle and has a height" v
    | j -> whole "a height" j in
  let h = Array.mapi height given in
  let denominator = whole "denominator" (entry "denominator" evidence) in
  if Z.leq denominator Z.zero then invalid "the denominator is not positive";
  let sign j = small ~least:(-1) ~most:1 "a vertex sign" j in
  let signs = Array.of_list (List.map sign (items "vertex_signs" (entry "vertex_signs" claims))) in
  let claimed = own_signs t signs in
  let gauge = string "gauge" (entry "gauge" claims) in
  if gauge = "saddle" then begin
    match d.border with
    | [ _; _; _ ] when corner <> None ->
      if List.exists (fun v -> not (Z.equal h.(v) Z.zero)) d.border then
        invalid "the boundary vertices other than the reflex corner are not all at height 0"
    | [ w; x; y; z ] -> if not (positive_saddle file (w, x, y, z) h) then invalid "the boundary saddle is not positive"
    | _ -> invalid "the gauge \"saddle\" needs four boundary vertices"
  end
  else if gauge <> "rim" then invalid "the gauge is neither saddle nor rim"
  else if corner <> None then invalid "the gauge \"rim\" needs a convex boundary";
  Option.iter (fun r -> Hashtbl.replace claimed r 1) corner;
  let text = own_letters t (string "assignment" (entry "assignment" claims)) in
  let distance = rational "the squared distance" (entry "squared_distance" claims) in
  let exact (b : V.hub) = corner = Some b.at_vertex
    || Z.equal Z.zero (fst (V.measured (fun u -> h.(u)) h.(b.at_vertex) b.wedges)) in
  if List.for_all exact p.V.hubs then exact_branch t claimed h text distance
  else begin
    let zeros = Array.fold_left (fun n s -> if s = 0 then n + 1 else n) (- List.length t.hidden) signs in
    near_branch t claimed h text zeros (Z.mul (fst distance) (Z.mul denominator denominator), snd distance)
  end
