(* What is read from a certificate. This file is not proved: whoever trusts the verdict trusts that the
   sheet, the signs and the letters that it hands over are those of the file. *)

exception Refused of string  (* no certificate of a kind that is verified here *)
exception Invalid of string  (* a claim or a digest is wrong *)
exception Unverified of string  (* the verified test does not accept *)

let refuse format = Printf.ksprintf (fun text -> raise (Refused text)) format
let unverified format = Printf.ksprintf (fun text -> raise (Unverified text)) format
let invalid format = Printf.ksprintf (fun text -> raise (Invalid text)) format

(* JSON without floating-point numbers and without escapes in texts; a drawing has both, and keeps them as written. *)
type json = Null | Word of string | Text of string | Number of string | Items of json list | Entries of (string * json) list

let parse ?(drawing = false) s =
  let size = String.length s and at = ref 0 in
  let peek () = if !at < size then s.[!at] else '\000' in
  let rec blank () = if !at < size && String.contains " \t\n\r" s.[!at] then (incr at; blank ()) in
  let expect c = blank (); if peek () <> c then refuse "'%c' is expected at byte %d" c !at; incr at in
  let text () =
    expect '"';
    let rec ending k = match String.index_from s k '"' with
      | exception (Not_found | Invalid_argument _) -> refuse "a text does not end"
      | stop ->
        let first = ref stop in
        while drawing && !first > k && s.[!first - 1] = '\\' do decr first done;
        if (stop - !first) mod 2 = 1 then ending (stop + 1) else stop in
    let stop = ending !at in
    let found = String.sub s !at (stop - !at) in
    if not drawing && String.contains found '\\' then refuse "escapes in texts are not read";
    at := stop + 1;
    found
  in
  let sequence close item =
    incr at; blank ();
    if peek () = close then (incr at; [])
    else
      let rec more found =
        let found = item () :: found in
        blank ();
        if peek () = ',' then (incr at; more found) else (expect close; List.rev found)
      in
      more []
  in
  let rec value () =
    blank ();
    match peek () with
    | '"' -> Text (text ())
    | '[' -> Items (sequence ']' value)
    | '{' -> Entries (sequence '}' (fun () -> let key = text () in
      if String.contains key '\\' then refuse "escapes in keys are not read"; expect ':'; (key, value ())))
    | _ ->
      let first = !at in
      while !at < size && not (String.contains ",]} \t\n\r" s.[!at]) do incr at done;
      match String.sub s first (!at - first) with
      | "null" -> Null
    | ("true" | "false") as word -> Word word
      | word when word <> "" && String.for_all (String.contains (if drawing then "-+.eE0123456789" else "-0123456789")) word -> Number word
      | word -> refuse "'%s' at byte %d is not read" word first
  in
  let found = value () in
  blank ();
  if !at < size then refuse "there is more after the object, at byte %d" !at;
  found

let entry key = function
  | Entries pairs -> (match List.filter (fun (k, _) -> k = key) pairs with
    | [ (_, found) ] -> found
    | _ -> refuse "\"%s\" is missing, or given twice" key)
  | _ -> refuse "an object with \"%s\" is expected" key

let only names = function
  | Entries pairs ->
    let wanted = String.split_on_char ' ' names in
    List.iter (fun (k, _) -> if not (List.mem k wanted) then refuse "the key \"%s\" is not known" k) pairs
  | _ -> ()

let items what = function Items l -> l | _ -> refuse "%s is no list" what
let string what = function Text t -> t | _ -> refuse "%s is no text" what
(* Whole numbers as the files have them: digits, without zeros in front, perhaps with a minus sign. *)
let digits what t =
  let size = String.length t in
  let first = if size > 0 && t.[0] = '-' then 1 else 0 in
  let good = size > first && String.for_all (fun c -> '0' <= c && c <= '9') (String.sub t first (size - first))
    && (t.[first] <> '0' || t = "0") in
  if good then Z.of_string t else refuse "%s is no whole number" what

let whole what = function Text t -> digits what t | _ -> refuse "%s is no whole number" what
let positive what j = let n = whole what j in if Z.sign n > 0 then n else refuse "%s is not positive" what

(* A number that stands without quotes, between two limits. *)
let small ?(least = 0) ?(most = max_int / 4) what = function
  | Number t ->
    let n = digits what t in
    if Z.geq n (Z.of_int least) && Z.leq n (Z.of_int most) then Z.to_int n else refuse "%s is out of range" what
  | _ -> refuse "%s is no number" what

let rational what = function
  | Text t -> (match String.split_on_char '/' t with
    | [ p ] -> (digits what p, Z.one)
    | [ p; q ] when Z.gt (digits what q) Z.zero ->
      let p = digits what p and q = digits what q in
      let common = Z.gcd p q in (Z.div p common, Z.div q common)
    | _ -> refuse "%s is no rational number" what)
  | _ -> refuse "%s is no rational number" what

(* A sheet: coordinates multiplied by a common denominator and divided by a common factor, and the digest of
   the pattern. *)
type sheet = { exact : ((Z.t * Z.t) * (Z.t * Z.t)) array; points : (Z.t * Z.t) array; triangles : (int * int * int) list; digest : string }

let triple what = function
  | [ a; b; c ] -> (small what a, small what b, small what c) | _ -> refuse "%s has not three vertices" what

let sheet pattern =
  only "vertices triangles" pattern;
  let pair j = match items "a vertex" j with
    | [ x; y ] -> (rational "a coordinate" x, rational "a coordinate" y)
    | _ -> refuse "a vertex has not two coordinates" in
  let exact = Array.of_list (List.map pair (items "vertices" (entry "vertices" pattern))) in
  let triangles = List.map (fun j -> triple "a face" (items "a face" j)) (items "triangles" (entry "triangles" pattern)) in
  let inside v = 0 <= v && v < Array.length exact in
  List.iter (fun (a, b, c) -> if not (inside a && inside b && inside c) then refuse "a face has a vertex that is not there") triangles;
  let unit = Array.fold_left (fun n ((_, q), (_, s)) -> Z.lcm n (Z.lcm q s)) Z.one exact in
  let common = Array.fold_left (fun n ((p, q), (r, s)) ->
    Z.gcd n (Z.gcd (Z.mul p (Z.div unit q)) (Z.mul r (Z.div unit s)))) Z.zero exact in
  let scaled (p, q) = Z.div (Z.mul p (Z.div unit q)) (Z.max Z.one common) in
  let shown (p, q) = if Z.equal q Z.one then Z.to_string p else Z.to_string p ^ "/" ^ Z.to_string q in
  let first (a, b, c) = min (a, b, c) (min (b, c, a) (c, a, b)) in
  let lines = "exactfold pattern 1"
    :: List.map (fun (x, y) -> Printf.sprintf "v %s %s" (shown x) (shown y)) (Array.to_list exact)
    @ List.map (fun (a, b, c) -> Printf.sprintf "t %d %d %d" a b c) (List.sort compare (List.map first triangles)) in
  { exact; points = Array.map (fun (x, y) -> (scaled x, scaled y)) exact; triangles;
    digest = Sha256.hex (String.concat "\n" lines ^ "\n") }

(* The folds in order, as the letters count them, with the third corners on their left and right. *)
let folds sheet =
  let left = Hashtbl.create 64 in
  List.iter (fun (a, b, c) -> List.iter (fun (e, l) -> Hashtbl.replace left e l) [ ((a, b), c); ((b, c), a); ((c, a), b) ]) sheet.triangles;
  Hashtbl.fold (fun (i, j) l found -> match Hashtbl.find_opt left (j, i) with
    | Some m when i < j -> (i, j, l, m) :: found
    | _ -> found) left []
  |> List.sort compare |> Array.of_list

(* Texts in base 64 (RFC 4648). *)
let decoded what text =
  let size = String.length text in
  if size mod 4 <> 0 then refuse "%s is not base 64" what;
  let padding = if size = 0 || text.[size - 1] <> '=' then 0 else if text.[size - 2] = '=' then 2 else 1 in
  let digit c = match c with
    | 'A' .. 'Z' -> Char.code c - 65 | 'a' .. 'z' -> Char.code c - 71 | '0' .. '9' -> Char.code c + 4
    | '+' -> 62 | '/' -> 63 | _ -> refuse "%s is not base 64" what in
  let bits k = if k >= size - padding then 0 else digit text.[k] in
  Bytes.init ((size / 4 * 3) - padding) (fun k ->
    let group = k / 3 * 4 in
    let all = (bits group lsl 18) lor (bits (group + 1) lsl 12) lor (bits (group + 2) lsl 6) lor bits (group + 3) in
    Char.chr ((all lsr (16 - (k mod 3 * 8))) land 255))

(* The JSON texts of a certificate in lines, whose digests are chained. *)
let lines text =
  let previous = ref "" in
  let read number line =
    let tab = try String.index line '\t' with Not_found -> invalid "line %d is cut off or was altered" number in
    let body = String.sub line 0 tab in
    previous := Sha256.hex (!previous ^ body);
    if String.sub line (tab + 1) (String.length line - tab - 1) <> !previous then
      invalid "line %d is cut off or was altered" number;
    body in
  match List.rev (String.split_on_char '\n' text) with
  | "" :: rest -> List.mapi (fun k line -> read (k + 1) line) (List.rev rest)
  | _ -> invalid "the last line is cut off"

let file path =
  let channel = open_in_bin path in
  Fun.protect ~finally:(fun () -> close_in channel) (fun () -> really_input_string channel (in_channel_length channel))
