(* Compares the sheet of a certificate with a drawing in the FOLD format. What is written there in decimals, or as exact
   fractions by exactfold, is taken as it is written. *)

open Reading

exception Unread of string  (* no drawing that is read here *)

let wanted : string option ref = ref None

let find key = function
  | Entries pairs when List.mem_assoc key pairs -> Some (entry key (Entries pairs))
  | _ -> None

(* A decimal number, such as -12.5e-3, exactly. *)
let decimal = function
  | Number t ->
    let t = String.lowercase_ascii t in
    let mantissa, power = match String.index_opt t 'e' with
      | None -> (t, 0)
      | Some k ->
        let rest = String.sub t (k + 1) (String.length t - k - 1) in
        (String.sub t 0 k, match int_of_string_opt rest with
          | Some n when n >= -4000 && n <= 4000 -> n
          | _ -> refuse "'%s' is no coordinate" t) in
    let whole, part = match String.split_on_char '.' mantissa with
      | [ whole ] -> (whole, "")
      | [ whole; part ] -> (whole, part)
      | _ -> refuse "'%s' is no coordinate" t in
    let negative = whole <> "" && whole.[0] = '-' in
    let all = (if negative then String.sub whole 1 (String.length whole - 1) else whole) ^ part in
    if all = "" || not (String.for_all (fun c -> '0' <= c && c <= '9') all) then refuse "'%s' is no coordinate" t;
    let value = Z.of_string all and power = power - String.length part in
    let p = if negative then Z.neg value else value and ten = Z.pow (Z.of_int 10) (abs power) in
    if power >= 0 then (Z.mul p ten, Z.one) else let common = Z.gcd p ten in (Z.div p common, Z.div ten common)
  | _ -> refuse "a coordinate of the drawing is no number"

let placed key number data =
  let point j = match items "a vertex" j with
    | [ x; y ] -> (number x, number y)
    | [ x; y; z ] when Z.equal (fst (number z)) Z.zero -> (number x, number y)
    | _ -> refuse "a vertex of the drawing is not in the plane" in
  Array.of_list (List.map point (items key (entry key data)))

(* The decimals, or the exact fractions beside them, which may differ from them by roundings only: by 10^-9 of the extent
   of the drawing, and 2^-50 of the coordinate. *)
let points data =
  if find "vertices_exactfold:surds" data <> None then refuse "the drawing has square roots in its coordinates";
  let decimals = placed "vertices_coords" decimal data in
  if find "vertices_exactfold:coords" data = None then decimals else begin
    let exact = placed "vertices_exactfold:coords" (rational "a coordinate") data in
    if Array.length exact <> Array.length decimals then refuse "the drawing has exact coordinates of other vertices";
    let q (p, below) = Q.make p below in
    let extent part =
      let all = List.map (fun v -> q (part v)) (Array.to_list decimals) in
      let most pick = List.fold_left pick (List.hd all) all in Q.sub (most Q.max) (most Q.min) in
    let size = if decimals = [||] then Q.zero else Q.div (Q.max (extent fst) (extent snd)) (Q.of_int 1_000_000_000) in
    let far a b = Q.gt (Q.abs (Q.sub (q a) (q b))) (Q.add size (Q.div_2exp (Q.abs (q b)) 50)) in
    Array.iteri (fun v (x, y) -> let a, b = decimals.(v) in
      if far x a || far y b then refuse "vertex %d of the drawing has two different places, exact and in decimals" v) exact;
    exact
  end

let faces data =
  match find "faces_vertices" data with
  | None -> refuse "the drawing has no faces; `exactfold convert` writes a FOLD file with faces"
  | Some list -> List.map (fun j -> triple "a face of the drawing" (items "a face" j)) (items "faces_vertices" list)

let unordered (a, b, c) = List.sort compare [ a; b; c ]

let read path =
  let text = file path in
  let mark = if String.starts_with ~prefix:"\xef\xbb\xbf" text then 3 else 0 in
  let data = parse ~drawing:true (String.sub text mark (String.length text - mark)) in
  (points data, faces data)

(* Says that a sheet is that of the drawing, if one was named. *)
let compare_with (sheet : sheet) = match !wanted with
  | None -> ()
  | Some path ->
    let points, faces = try read path with Refused why | Sys_error why -> raise (Unread why) in
    if Array.length points <> Array.length sheet.exact then
      invalid "the drawing has %d vertices, the certificate %d" (Array.length points) (Array.length sheet.exact);
    Array.iteri (fun v point -> if point <> sheet.exact.(v) then
      invalid "vertex %d of the drawing is not at its place in the certificate" v) points;
    let set list = List.sort compare (List.map unordered list) in
    if set faces <> set sheet.triangles then invalid "the faces of the drawing are not those of the certificate";
    Printf.printf "drawing   %s has these vertices and faces\n%!" path
