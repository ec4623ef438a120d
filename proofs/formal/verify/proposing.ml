(* What the verified program is given besides the certificate: the combinatorics of the sheet, its forms
   in integers, and heights that satisfy strict inequalities. Nothing here is trusted: that the drawing and
   its folds are those of the file is compared in main.ml, and other numbers that are wrong can only make
   the verified program refuse. *)

open Reading
module V = Verified

(* --- the sheet --- *)

let next_of sheet =
  let next = Array.make (Array.length sheet.points) [] in
  List.iter (fun (a, b, c) ->
    List.iter (fun (v, x, y) -> next.(v) <- (x, y) :: next.(v)) [ (a, b, c); (b, c, a); (c, a, b) ]) sheet.triangles;
  next

(* The neighbours of a vertex counter-clockwise, and whether it is inside. *)
let fan v steps =
  if steps = [] then refuse "vertex %d is on no face" v;
  let ends = List.map snd steps in
  let start, inside = match List.filter (fun (a, _) -> not (List.mem a ends)) steps with
    | (a, _) :: _ -> (a, false)
    | [] -> (fst (List.hd steps), true) in
  let rec walk a left = match List.assoc_opt a left with
    | Some b when b <> start -> a :: walk b (List.remove_assoc a left)
    | Some b -> [ a; b ]
    | None -> [ a ] in
  (walk start steps, inside)

let border first fans rim =
  let rec walk v left =
    if left = 0 then refuse "the boundary is not one cycle through its %d vertices" rim;
    let next = List.hd fans.(v) in
    if next = first then [ v ] else v :: walk next (left - 1) in
  walk first rim

let rec rotated k l = if k = 0 then l else rotated (k - 1) (List.tl l @ [ List.hd l ])

let zturn (ax, ay) (bx, by) = Z.sub (Z.mul ax by) (Z.mul ay bx)
let zdot (ax, ay) (bx, by) = Z.add (Z.mul ax bx) (Z.mul ay by)
let minus (ax, ay) (bx, by) = (Z.sub ax bx, Z.sub ay by)

(* The first corner that does not lie in line with the other three comes last, as in the charts. *)
let pinned sheet = function
  | [ _; _; _; _ ] as cycle ->
    let flat l = match List.map (fun v -> sheet.points.(v)) l with
      | a :: b :: c :: _ -> Z.equal (zturn (minus b a) (minus c a)) Z.zero
      | _ -> true in
    let rec choose k = if k > 4 then cycle else let l = rotated k cycle in if flat l then choose (k + 1) else l in
    choose 1
  | cycle -> cycle

(* The sheet without the vertices inside triangulated triangles, which are then on no face; which vertices these are;
   the faces that it shares with the file; and the triangles, with the faces that fill them in the file. *)
let emptied sheet triangles =
  let owner = Array.make (Array.length sheet.points) (-1) in
  List.iteri (fun k (_, inside) -> List.iter (fun v -> owner.(v) <- k) inside) triangles;
  let filling = Array.make (List.length triangles + 1) [] in
  List.iter (fun (a, b, c) -> let k = 1 + max owner.(a) (max owner.(b) owner.(c)) in
    filling.(k) <- (a, b, c) :: filling.(k)) (List.rev sheet.triangles);
  let part k ((a, b, c), inside) : V.part =
    let own = filling.(k + 1) in
    let next = next_of { sheet with triangles = own } in
    let fans = Array.mapi (fun v steps -> if steps = [] then [] else fst (fan v steps)) next in
    { corner_a = a; corner_b = b; corner_c = c; hidden = inside;
      pieces = List.map (fun (x, y, z) -> ((x, y), z)) own; fans_in = Array.to_list fans } in
  let common = filling.(0) in
  ({ sheet with triangles = List.map fst triangles @ common }, Array.map (fun k -> k >= 0) owner, common,
    List.mapi part triangles)

(* The reflex corner on a boundary of four, and the sheet whose first triangle closes its notch. Other boundaries
   with such a corner are refused by name; the verified program refuses them, too. *)
let closed sheet hidden =
  List.iter (fun (a, b, c) -> let at v = sheet.points.(v) in
    if Z.leq (zturn (minus (at b) (at a)) (minus (at c) (at a))) Z.zero then
      refuse "the face %d, %d, %d does not run counter-clockwise" a b c) sheet.triangles;
  let fans = Array.mapi (fun v steps -> if hidden.(v) then ([], true) else fan v steps) (next_of sheet) in
  let rim = List.filter (fun v -> not (snd fans.(v))) (List.init (Array.length fans) Fun.id) in
  let ends v = let l = fst fans.(v) in (List.hd l, List.nth l (List.length l - 1)) in
  let turned v = let first, last = ends v and p = sheet.points.(v) in
    Z.sign (zturn (minus sheet.points.(first) p) (minus sheet.points.(last) p)) in
  match List.filter (fun v -> turned v < 0) rim with
  | [] -> (sheet, None)
  | r :: _ when List.length rim = 4 ->
    let first, last = ends r in
    ({ sheet with triangles = (r, last, first) :: sheet.triangles }, Some r)
  | r :: _ -> refuse "the corner at vertex %d is reflex, of %d: only sheets with four corners may have one" r (List.length rim)

let drawing sheet hidden : V.drawing =
  let next = next_of sheet in
  let fans = Array.mapi (fun v steps -> if hidden.(v) then ([], true) else fan v steps) next in
  let all = List.filter (fun v -> not hidden.(v)) (List.init (Array.length fans) Fun.id) in
  let inside, rim = List.partition (fun v -> snd fans.(v)) all in
  if rim = [] then refuse "the sheet has no boundary";
  let fans = Array.map fst fans in
  let cycle = border (List.hd rim) fans (List.length rim) in
  if List.length cycle <> List.length rim then refuse "the boundary is not one cycle through its %d vertices" (List.length rim);
  (* the greatest number first, so that the sign vectors come in the order of the roots *)
  { points = Array.to_list sheet.points; inside = List.rev inside; border = pinned sheet cycle;
    triangles = List.map (fun (a, b, c) -> ((a, b), c)) sheet.triangles; fans_of = Array.to_list fans }

(* An order in which the faces can be glued to each other, the last one first: each closes the star of its first
   vertex, or it has a side in common with those before and a third vertex that is new. *)
let gluing (d : V.drawing) =
  let size = List.length d.points in
  let placed = Array.make size false and inner = Array.make size false and left = Array.make size 0 in
  let sides = Hashtbl.create 256 in
  let side a b = Hashtbl.mem sides (a, b) || Hashtbl.mem sides (b, a) in
  List.iter (fun v -> inner.(v) <- true) d.inside;
  List.iter (fun ((a, b), c) -> List.iter (fun v -> left.(v) <- left.(v) + 1) [ a; b; c ]) d.triangles;
  let turns ((a, b), c) = [ (a, b, c); (b, c, a); (c, a, b) ] in
  let closes (a, b, c) = inner.(a) && left.(a) = 1 && side a b && side a c in
  let extends (a, b, c) = side a b && not placed.(c) in
  let place (a, b, c) =
    List.iter (fun v -> placed.(v) <- true; left.(v) <- left.(v) - 1) [ a; b; c ];
    List.iter (fun e -> Hashtbl.replace sides e ()) [ (a, b); (b, c); (c, a) ] in
  let rec glue order faces =
    let try_one (order, rest) face =
      let found test = List.find_opt test (turns face) in
      match found closes, found extends with
      | Some (a, b, c), _ -> place (a, b, c); ((true, ((a, b), c)) :: order, rest)
      | None, Some (a, b, c) -> place (a, b, c); ((false, ((a, b), c)) :: order, rest)
      | None, None -> (order, face :: rest) in
    let longer, rest = List.fold_left try_one (order, []) faces in
    if rest = [] || List.compare_lengths rest faces = 0 then longer else glue longer (List.rev rest) in
  match d.triangles with
  | ((a, b), c) :: faces -> place (a, b, c); glue [ (false, ((a, b), c)) ] faces
  | [] -> []

(* --- its forms --- *)

let two = Z.of_int 2
let spoke sheet v u = minus sheet.points.(u) sheet.points.(v)
let rec steps = function a :: (b :: _ as l) -> (a, b) :: steps l | _ -> []

let hub sheet here v fan =
  let corner (a, b) =
    let x = spoke sheet v a and y = spoke sheet v b in
    let c = zturn x y and s = zdot x y in
    (a, b, c, s, Z.mul (Z.mul two c) (zdot x x), Z.mul (Z.mul two c) (zdot y y)) in
  let corners = List.map corner (steps fan) in
  let needed scale (_, _, c, s, m, n) =
    List.fold_left (fun d (top, below) -> Z.lcm d (Z.div below (Z.gcd top below))) scale [ (Z.one, c); (s, m); (s, n) ] in
  let scale = List.fold_left needed Z.one corners in
  let rec with_cone bits =
    let cone = Hashtbl.create 8 in
    List.iter (fun u -> let x = spoke sheet v u in
      Hashtbl.replace cone u (Z.neg (Z.sqrt (Z.shift_left (zdot x x) (2 * bits))))) fan;
    let mountain_at u = Option.value (Hashtbl.find_opt cone u) ~default:Z.zero in
    let wedge (a, b, c, s, m, n) : V.wedge_form =
      let mixed = Z.div scale c and square = Z.div (Z.mul scale s) m and square' = Z.div (Z.mul scale s) n in
      let y = mountain_at a and y' = mountain_at b in
      { left = a; right = b; mixed; square; square';
        side = Z.sub (Z.mul mixed y') (Z.mul two (Z.mul square y));
        side' = Z.sub (Z.mul mixed y) (Z.mul two (Z.mul square' y')) } in
    let wedges = List.map wedge corners in
    let curved, _ = V.measured mountain_at Z.zero wedges in
    if bits < 4000 && (Z.leq curved Z.zero || List.exists (fun u -> Z.geq (mountain_at u) Z.zero) fan)
    then with_cone (2 * bits) else (wedges, mountain_at) in
  let wedges, mountain_at = with_cone 8 in
  ({ at_vertex = v; scale; wedges; mountain_at; share = Z.zero; here } : V.hub)

let fold sheet name (i, j, l, m) : V.fold_form =
  let e = spoke sheet i j and a = spoke sheet i l and b = spoke sheet i m in
  let c = zturn e a and c' = zturn b e and n = zdot e e in
  { name; ends = (((i, j), l), m); along = Z.neg (Z.add (Z.mul c' (zdot a e)) (Z.mul c (zdot b e)));
    toward_l = Z.mul c' n; toward_m = Z.mul c n;
    slack2 = Z.mul (Z.mul two n) (Z.mul (Z.add c c') (Z.mul c c')) }

let prepared sheet (d : V.drawing) : V.prepared =
  let all = folds sheet in
  let here = Array.make (Array.length sheet.points) [] in
  for k = Array.length all - 1 downto 0 do
    let i, j, _, _ = all.(k) in
    here.(i) <- k :: here.(i);
    here.(j) <- k :: here.(j)
  done;
  let fans = Array.of_list d.fans_of in
  let hubs = List.map (fun v -> hub sheet here.(v) v fans.(v)) d.inside in
  let range part = Array.fold_left (fun (low, high) p -> (Z.min low (part p), Z.max high (part p)))
    (part sheet.points.(0), part sheet.points.(0)) sheet.points in
  let middle part = let low, high = range part in Z.add low high in
  let centre2 = (middle fst, middle snd) in
  let far (x, y) = let q = minus (Z.mul two x, Z.mul two y) centre2 in zdot q q in
  let radius4 = Array.fold_left (fun r p -> Z.max r (far p)) Z.zero sheet.points in
  let largest = List.fold_left (fun m (b : V.hub) -> Z.max m b.scale) Z.one hubs in
  let units = Z.shift_left largest 20 in
  let shared (b : V.hub) =
    let weight = Z.sub radius4 (far sheet.points.(b.at_vertex)) in
    { b with share = Z.cdiv (Z.mul weight units) (Z.mul (Z.of_int 4) b.scale) } in
  { hubs = List.map shared hubs; folds = Array.to_list (Array.mapi (fold sheet) all); centre2; radius4; units }

(* Heights t, and a number, so that K(t, .) at the corner [r] of a closed notch has the weights [w] times this number;
   if there are none, others. The form does not change with a plane: t is 0 on the triangle that closes the notch. *)
let form_of (d : V.drawing) (p : V.prepared) r w =
  let b = List.find (fun (b : V.hub) -> b.at_vertex = r) p.hubs in
  let closing = match d.triangles with ((x, y), z) :: _ -> [ x; y; z ] | [] -> [] in
  let around = List.sort_uniq compare (List.concat_map (fun (w : V.wedge_form) -> [ w.left; w.right ]) b.wedges) in
  let free = Array.of_list (List.filter (fun u -> not (List.mem u closing)) around) in
  let n = Array.length free in
  let at v u = if u = v then Z.one else Z.zero in
  let row u = Array.init (n + 1) (fun k -> Q.of_bigint (if k = n then w u else V.weight b (at free.(k)) u)) in
  let rest = ref (List.map row (r :: List.filter (fun u -> List.mem u d.inside) around)) in
  let solved = Array.make n [||] in
  for k = 0 to n - 1 do
    match List.partition (fun row -> Q.sign row.(k) <> 0) !rest with
    | [], _ -> ()
    | first :: more, others ->
      let first = Array.map (fun x -> Q.div x first.(k)) first in
      let less row = let f = row.(k) in Array.map2 (fun x y -> Q.sub x (Q.mul f y)) row first in
      rest := List.map less more @ others;
      Array.iteri (fun j row -> if row <> [||] then solved.(j) <- less row) solved;
      solved.(k) <- first
  done;
  let t = Array.map (fun row -> if row = [||] then Q.zero else row.(n)) solved in
  let times = Array.fold_left (fun m x -> Z.lcm m (Q.den x)) Z.one t in
  let heights = Hashtbl.create 8 in
  Array.iteri (fun k x -> Hashtbl.replace heights free.(k) (Q.num (Q.mul (Q.of_bigint times) x))) t;
  ((fun u -> Option.value (Hashtbl.find_opt heights u) ~default:Z.zero), times)

(* --- heights with small positive curvatures near a root --- *)

let ratio p q =
  let down x = let n = max 0 (Z.numbits x - 60) in (Z.to_float (Z.shift_right x n), n) in
  let p, m = down p and q, n = down q in
  ldexp (p /. q) (m - n)

(* Solves a x = b in place, with partial pivots. *)
let solve a b =
  let n = Array.length b in
  for k = 0 to n - 1 do
    let best = ref k in
    for i = k + 1 to n - 1 do if Float.abs a.(i).(k) > Float.abs a.(!best).(k) then best := i done;
    let row = a.(k) in a.(k) <- a.(!best); a.(!best) <- row;
    let x = b.(k) in b.(k) <- b.(!best); b.(!best) <- x;
    let pivot = a.(k) in
    for i = k + 1 to n - 1 do
      let row = a.(i) in
      let f = row.(k) /. pivot.(k) in
      if f <> 0. then begin
        for j = k + 1 to n - 1 do Array.unsafe_set row j (Array.unsafe_get row j -. f *. Array.unsafe_get pivot j) done;
        b.(i) <- b.(i) -. f *. b.(k)
      end
    done
  done;
  for k = n - 1 downto 0 do
    let s = ref b.(k) in
    for j = k + 1 to n - 1 do s := !s -. a.(k).(j) *. b.(j) done;
    b.(k) <- !s /. a.(k).(k)
  done

(* A vertex with its forms in floating point: corners as places of the heights, -1 for the rim. *)
type light = { hub : V.hub; place : int; corners : (int * int * int * int * float * float * float) array }

let light slot (b : V.hub) =
  let corner (w : V.wedge_form) =
    (w.left, w.right, slot.(w.left), slot.(w.right), ratio w.mixed b.scale, ratio w.square b.scale, ratio w.square' b.scale) in
  { hub = b; place = slot.(b.at_vertex); corners = Array.of_list (List.map corner b.wedges) }

(* One step of Newton's method from heights h in units of 2^-bits towards curvatures 2^-aim; that of the vertex
   [kept] stays as it is. *)
let step lights kept h bits aim =
  let n = Array.length lights in
  let unit = Z.shift_left Z.one bits in
  let f = Array.map (fun x -> ratio x unit) h in
  let a = Array.make_matrix n n 0. and b = Array.make n 0. in
  let unit2 = Z.shift_left Z.one (2 * bits) in
  Array.iteri (fun row t ->
    let v = t.hub.V.at_vertex in
    let k, _ = V.measured (fun u -> h.(u)) h.(v) t.hub.V.wedges in
    b.(row) <- if kept = Some v then 0. else ldexp 1. (-aim) -. ratio k (Z.mul t.hub.V.scale unit2);
    let line = a.(row) in
    let add slot x = if slot >= 0 then line.(slot) <- line.(slot) +. x in
    Array.iter (fun (l, r, sl, sr, p, q, q') ->
      let x = f.(l) -. f.(v) and y = f.(r) -. f.(v) in
      let dx = p *. y -. 2. *. q *. x and dy = p *. x -. 2. *. q' *. y in
      add sl dx; add sr dy; add t.place (-. dx -. dy)) t.corners) lights;
  solve a b;
  Array.iter (fun t ->
    let v = t.hub.V.at_vertex in
    if Float.is_finite b.(t.place) then begin
      let mantissa, exponent = Float.frexp b.(t.place) in  (* as an integer times a power of two *)
      let digits = Z.of_float (ldexp mantissa 53) and shift = exponent - 53 + bits in
      h.(v) <- Z.add h.(v) (if shift >= 0 then Z.shift_left digits shift else Z.shift_right digits (-shift))
    end) lights

(* Folds in floating point, to guess whether heights with curvatures 2^-aim decide all letters: ends,
   coefficients, and what the squared bend has to exceed. *)
let rough kept (p : V.prepared) =
  let float x = ratio x Z.one in
  let total = List.fold_left (fun s (b : V.hub) ->
    if kept = Some b.at_vertex then s else Z.add s (Z.mul b.share b.scale)) Z.zero p.hubs in
  let fold (f : V.fold_form) =
    let ((i, j), l), m = f.ends in
    (i, j, l, m, float f.along, float f.toward_l, float f.toward_m, ratio (Z.mul f.slack2 total) p.units) in
  Array.of_list (List.map fold p.folds)

let clear rough h bits aim =
  let unit = Z.shift_left Z.one bits in
  let at v = ratio h.(v) unit in
  Array.for_all (fun (i, j, l, m, a, b, c, slack) ->
    let x = at i in
    let bend = a *. (at j -. x) +. b *. (at l -. x) +. c *. (at m -. x) in
    bend *. bend > 4. *. ldexp slack (-aim)) rough

(* Heights in units of 2^-bits, from whole numbers in units of 2^-own. *)
let shifted size inside center own bits =
  let h = Array.make size Z.zero and shift = bits - own in
  Array.iteri (fun k v -> h.(v) <- if shift >= 0 then Z.shift_left center.(k) shift else Z.shift_right center.(k) (-shift)) inside;
  h

let precisions = [ 56; 72; 96; 128; 256; 512; 1024; 2048 ]

let improve lights kept h bits = for _ = 0 to (bits - 40) / 40 do step lights kept h bits (bits - 14) done

(* Heights with more and more digits, until floating point, or if [careful] the verified test itself, finds all letters
   decided. *)
let refined lights rough kept careful passes heights =
  let rec refine = function
    | [] -> raise Exit
    | bits :: more ->
      let h = heights bits in
      if not (careful || more = [] || clear rough h bits (bits - 14)) then refine more
      else begin
        improve lights kept h bits;
        if careful && not (passes h) then refine more else h
      end in
  refine precisions
