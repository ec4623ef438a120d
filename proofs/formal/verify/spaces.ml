(* What the verified program is given for the branches of a listing: approximate heights, exact ones, or a space with a
   solution. As in proposing.ml nothing here is trusted: wrong numbers can only make the verified program refuse. *)

open Reading
module V = Verified

(* --- linear algebra over the rational numbers --- *)
let dot u x = let s = ref Q.zero in Array.iteri (fun k a -> if Q.sign a <> 0 then s := Q.add !s (Q.mul a x.(k))) u; !s
let less row f other = Array.map2 (fun x y -> Q.sub x (Q.mul f y)) row other

(* A reduced echelon form with one row more, if it is independent: rows with the places of their leading ones, which lie
   in the first [width] columns. *)
let with_row width found row =
  let row = List.fold_left (fun row (k, r) -> if Q.sign row.(k) = 0 then row else less row row.(k) r) row found in
  let rec lead k = if k = width then None else if Q.sign row.(k) <> 0 then Some k else lead (k + 1) in
  match lead 0 with
  | None -> found
  | Some k ->
    let row = Array.map (fun x -> Q.div x row.(k)) row in
    (k, row) :: List.map (fun (j, r) -> (j, if Q.sign r.(k) = 0 then r else less r r.(k) row)) found

let echelon width rows =
  List.sort (fun (j, _) (k, _) -> Int.compare j k) (List.fold_left (with_row width) [] rows)

let unit_row n k = Array.init n (fun j -> if j = k then Q.one else Q.zero)

(* The inverse of a matrix, if it has one. *)
let inverted a =
  let n = Array.length a in
  let rows = List.mapi (fun i row -> Array.append row (unit_row n i)) (Array.to_list a) in
  let found = echelon n rows in
  if List.length found < n then None else Some (Array.of_list (List.map (fun (_, r) -> Array.sub r n n) found))

(* --- the chart --- *)

let fixed v = fun u -> if u = v then Z.one else Z.zero

(* The unknowns of the file are heights of [inside], in its chart: [basis] has the heights, times a positive number, for each
   unknown and for the constant. The evidence has heights of [own]: if the corner [r] is reflex this is among them, the rim
   is at height 0, and spaces have no constant. Otherwise [last] has the height 1. *)
type chart = { p : V.prepared; inside : int array; own : int array; basis : (int -> Z.t) array; last : int; corner : int option }

(* The heights for the constant, where the first corner has height 1, less a plane: the others but [r] are at height 0. *)
let levelled points rim r =
  let first = List.fold_left min (List.hd rim) rim in
  let turn a b c = let at v = points.(v) in
    let (ax, ay), (bx, by), (cx, cy) = at a, at b, at c in
    Z.sub (Z.mul (Z.sub bx ax) (Z.sub cy ay)) (Z.mul (Z.sub by ay) (Z.sub cx ax)) in
  match List.filter (fun v -> v <> first && v <> r) rim with
  | [ a; b ] when first <> r ->
    let all = turn first a b in
    let sign = Z.of_int (Z.sign all) in
    (Z.abs all, fun u -> Z.mul sign (Z.sub (if u = first then all else Z.zero) (turn u a b)))
  | _ -> (Z.one, fixed r)

let chart_of (d : V.drawing) p inside corner given =
  let n = Array.length inside in
  let units times = Array.map (fun v u -> Z.mul times (fixed v u)) inside in
  match corner with
  | None ->
    let last = List.nth d.border 3 in
    { p; inside; own = inside; basis = Array.append (units Z.one) [| fixed last |]; last; corner }
  | Some r ->
    let basis = match given with
      | Null -> let times, constant = levelled (Array.of_list d.points) (r :: d.border) r in
        Array.append (units times) [| constant |]
      | Entries pairs ->
        let weights = List.map (fun (v, w) -> (digits "a vertex of the chart" v, rational "a weight of the chart" w)) pairs in
        let unit = List.fold_left (fun n (_, (_, q)) -> Z.lcm n q) Z.one weights in
        let weight v = match List.assoc_opt (Z.of_int v) weights with
          | Some (x, q) -> Z.mul x (Z.div unit q) | None -> Z.zero in
        let lead = weight r in
        let signed x = if Z.sign lead < 0 then Z.neg x else x in
        if Z.sign lead = 0 then refuse "the chart does not fix the height of the reflex corner";
        Array.append (Array.map (fun v u -> if u = r then signed (Z.neg (weight v)) else Z.mul (Z.abs lead) (fixed v u)) inside)
          [| (fun u -> if u = r then signed unit else Z.zero) |]
      | _ -> refuse "the chart is neither null nor a functional" in
    { p; inside; own = Array.append inside [| r |]; basis; last = -1; corner }

(* Heights of [own], of unknowns of the file and the constant. *)
let lifted c x constant =
  let n = Array.length c.inside in
  Array.map (fun u ->
    let sum = ref (Q.mul constant (Q.of_bigint (c.basis.(n) u))) in
    Array.iteri (fun k y -> if Q.sign y <> 0 then sum := Q.add !sum (Q.mul y (Q.of_bigint (c.basis.(k) u)))) x;
    !sum) c.own

(* --- roots of the file --- *)

(* Heights of [own], whether they may be exact, and other spaces in which they lie: a point and directions. *)
type near = { heights : Q.t array; exact : bool; others : (Q.t array * Q.t array list) list; root : algebraic option }

(* A root of a polynomial with coprime coefficients, approximately, and heights of [own] for each of its powers from 0. *)
and algebraic = { divisor : Z.t list; about : Q.t; powers : Q.t array list }

let fraction what j = let p, q = rational what j in Q.make p q
let polynomial j = Array.of_list (List.map (fraction "a coefficient") (items "a polynomial" j))
let value f x = Array.fold_right (fun c s -> Q.add c (Q.mul x s)) f Q.zero
let slope f = Array.init (max 0 (Array.length f - 1)) (fun k -> Q.mul (Q.of_int (k + 1)) f.(k + 1))
let coefficient f k = if k < Array.length f then f.(k) else Q.zero

let trimmed f =
  let n = ref (Array.length f) in
  while !n > 0 && Q.sign f.(!n - 1) = 0 do decr n done;
  Array.sub f 0 !n
let times f g = if f = [||] || g = [||] then [||] else begin
  let h = Array.make (Array.length f + Array.length g - 1) Q.zero in
  Array.iteri (fun i a -> Array.iteri (fun j b -> h.(i + j) <- Q.add h.(i + j) (Q.mul a b)) g) f;
  trimmed h
end
let minus f g = trimmed (Array.init (max (Array.length f) (Array.length g)) (fun k -> Q.sub (coefficient f k) (coefficient g k)))

(* Quotient and remainder; [g] is not 0. *)
let divided f g =
  let n = Array.length g in
  let rec go q r =
    if Array.length r < n then (q, r)
    else
      let shift = Array.length r - n in
      let lead = Q.div r.(Array.length r - 1) g.(n - 1) in
      let term = Array.init (shift + 1) (fun k -> if k = shift then lead else Q.zero) in
      go (minus q (Array.map Q.neg term)) (minus r (times term g)) in
  go [||] (trimmed f)

(* The inverse of f modulo p, if they are coprime. *)
let inverse_modulo f p =
  let rec go (r, u) (r', u') = match Array.length r' with
    | 0 -> None
    | 1 -> Some (Array.map (fun x -> Q.div x r'.(0)) u')
    | _ -> let q, rest = divided r r' in go (r', u') (rest, minus u (times q u')) in
  go (p, [||]) (snd (divided f p), [| Q.one |])

(* A root in an interval in which the polynomial changes its sign, to 100 digits and more. *)
let rec narrowed f low high steps =
  let middle = Q.div (Q.add low high) (Q.of_int 2) in
  if Q.equal low high || steps = 0 then middle
  else
    let at = Q.sign (value f middle) in
    if at = 0 then middle
    else if at = Q.sign (value f low) then narrowed f middle high (steps - 1) else narrowed f low middle (steps - 1)

let centre size j =
  let bits = small ~most:(1 lsl 14) "bits" (entry "bits" j) in
  ignore (positive "radius" (entry "radius" j));
  let given = List.map (whole "center") (items "center" (entry "center" j)) in
  if List.length given <> size then refuse "a root has another number of heights";
  Array.of_list (List.map (fun c -> Q.make c (Z.shift_left Z.one bits)) given)

let of_class c classes j =
  let size = Array.length c.inside in
  only "class interval" j;
  let classes = Array.of_list (items "classes" classes) in
  let own = classes.(small ~most:(Array.length classes - 1) "class" (entry "class" j)) in
  only "polynomial numerators flat" own;
  let p = polynomial (entry "polynomial" own) in
  let w = Array.of_list (List.map polynomial (items "numerators" (entry "numerators" own))) in
  let d = slope p in
  if Array.length w <> size then refuse "a root has another number of heights";
  if Array.length p < 2 || Q.sign p.(Array.length p - 1) = 0 then refuse "a class polynomial is constant, or its degree is less";
  match List.map (fraction "an end") (items "interval" (entry "interval" j)) with
  | [ low; high ] ->
    let t = narrowed p low high (if Q.equal low high then 0 else 400) in
    let below = value d t in
    if Q.sign below = 0 then refuse "a class polynomial has a double root";
    let last = Array.length d - 1 in
    (* x is the sum of t^k / p'(t) times the coefficients of the numerators, 1 that times those of p' *)
    let origin = Array.map (fun f -> Q.div (coefficient f last) d.(last)) w in
    let direction k = Array.map (fun f -> Q.sub (coefficient f k) (Q.mul d.(k) (Q.div (coefficient f last) d.(last)))) w in
    let common = Array.fold_left (fun n x -> Z.lcm n (Q.den x)) Z.one p in
    let whole = Array.map (fun x -> Q.num (Q.mul (Q.of_bigint common) x)) p in
    let content = Array.fold_left Z.gcd Z.zero whole in
    let of_inverse g =
      let x = Array.map (fun f -> snd (divided (times f g) p)) w in
      let power k = lifted c (Array.map (fun f -> coefficient f k) x) (if k = 0 then Q.one else Q.zero) in
      { divisor = List.map (fun x -> Z.divexact x content) (Array.to_list whole); about = t;
        powers = List.init (Array.length p - 1) power } in
    { heights = lifted c (Array.map (fun f -> Q.div (value f t) below) w) Q.one; exact = Q.sign (value p t) = 0;
      root = Option.map of_inverse (inverse_modulo d p);
      others = [ (lifted c origin Q.one, List.map (fun x -> lifted c x Q.zero) (List.init last direction)) ] }
  | _ -> refuse "an interval has not two ends"

(* --- spaces --- *)

(* Where some folds are flat: a point and directions, in the coordinates of a basis and a constant. *)
let flat_space (p : V.prepared) basis is_flat =
  let n = Array.length basis - 1 in
  let row f = Array.map (fun h -> Q.of_bigint (V.bent h f)) basis in
  let found = echelon (n + 1) (List.map row (List.filter is_flat p.folds)) in
  if List.mem_assoc n found then refuse "no heights in the chart have the flat folds";
  let free = List.filter (fun k -> not (List.mem_assoc k found)) (List.init n Fun.id) in
  let at k j = match List.assoc_opt k found with Some r -> Q.neg r.(j) | None -> if k = j then Q.one else Q.zero in
  (Array.init n (fun k -> at k n), List.map (fun j -> Array.init n (fun k -> at k j)) free)

let touches flat (f : V.fold_form) = let ((i, j), _), _ = f.ends in List.mem i flat || List.mem j flat

let read c classes j =
  let has key = match j with Entries pairs -> List.mem_assoc key pairs | _ -> refuse "a root is not an object" in
  if has "class" then of_class c classes j
  else if has "flat" then begin
    only "center radius bits flat" j;
    let flat = List.map (small "a flat vertex") (items "flat" (entry "flat" j)) in
    let origin, directions = flat_space c.p c.basis (touches flat) in
    let y = centre (List.length directions) j in
    let add (x, k) a = (less x (Q.neg y.(k)) a, k + 1) in
    { heights = lifted c (fst (List.fold_left add (origin, 0) directions)) Q.one; exact = false; others = []; root = None }
  end
  else begin
    only "center radius bits" j;
    { heights = lifted c (centre (Array.length c.inside) j) Q.one; exact = true; others = []; root = None }
  end

let two = Z.of_int 2
let rounded x = Z.fdiv (Z.add (Z.mul two (Q.num x)) (Q.den x)) (Z.mul two (Q.den x))
let scaled x bits = rounded (Q.mul_2exp x bits)

let placed inside xs = fun u ->
  let found = ref Z.zero in Array.iteri (fun k v -> if v = u then found := xs.(k)) inside; !found

let point base : V.space =
  let zero _ = Z.zero in
  { chosen = (fun _ -> false); base; column = (fun _ -> zero); centre = zero; half = Z.zero;
    inverse = (fun _ -> zero); over = Z.one; bound0 = Z.zero; bound1 = Z.zero; bound2 = Z.zero;
    combination = (fun _ -> (Z.one, zero)); polynomial = []; quotient = (fun _ -> []); low = Z.zero; high = Z.zero;
    below = Z.zero }

(* The height of the last corner, and exact heights. *)
let exactly c xs =
  let top = Array.fold_left (fun n x -> Z.lcm n (Q.den x)) Z.one xs in
  let whole = Array.map (fun x -> Q.num (Q.mul (Q.of_bigint top) x)) xs in
  (top, V.Within (point (placed c.own whole)))

let largest = List.fold_left Z.max Z.zero
let total l f = List.fold_left (fun s x -> Z.add s (f x)) Z.zero l
let rec place v k = function [] -> 0 | w :: l -> if w = v then k else place v (k + 1) l

(* With a reflex corner the space has no constant: that height of a basis which is largest becomes it. *)
let with_constant (origin, directions) xs =
  let rows = echelon (Array.length xs) (origin :: directions) in
  let larger (k, r) (j, r') = if Q.lt (Q.abs xs.(k)) (Q.abs xs.(j)) then (j, r') else (k, r) in
  let k, row = if rows = [] then refuse "the space has no heights but 0" else List.fold_left larger (List.hd rows) rows in
  let times = Q.abs xs.(k) in
  if Q.sign times = 0 then refuse "all heights are 0";
  let signed x = if Q.sign xs.(k) < 0 then Q.neg x else x in
  ((Array.map signed row, List.map snd (List.filter (fun (j, _) -> j <> k) rows)), Array.map (fun x -> Q.div x times) xs)

(* A space with as many unknowns as independent curvatures, with a box around the heights; [bits] are digits. *)
let within c flat space xs =
  let { p; own = inside; last; _ } = c in
  let (origin, directions), xs = if c.corner = None then (space, xs) else with_constant space xs in
  let flat = Option.to_list c.corner @ flat in
  let n = Array.length inside in
  let reduced = echelon n directions in
  let origin = List.fold_left (fun o (k, r) -> less o o.(k) r) origin reduced in
  let unit = List.fold_left (fun m row -> Array.fold_left (fun m x -> Z.lcm m (Q.den x)) m row) Z.one
    (origin :: List.map snd reduced) in
  let whole row = Array.map (fun x -> Q.num (Q.mul (Q.of_bigint unit) x)) row in
  let columns = List.map (fun (_, r) -> placed inside (whole r)) reduced in
  let start times = let base = placed inside (whole origin) in
    fun u -> Z.mul times (if u = last then unit else base u) in
  let spanning = start Z.one :: columns in
  let hubs = List.filter (fun (b : V.hub) -> not (List.mem b.at_vertex flat)) p.hubs in
  let rec pairs_of = function [] -> [] | g :: l -> List.map (fun h -> (g, h)) (g :: l) @ pairs_of l in
  let pairs = pairs_of spanning in
  let row b = Array.of_list (List.map (fun (g, h) -> Q.of_bigint (V.polar b g h)) pairs) in
  let rows = List.map (fun b -> (b, row b)) hubs in
  let width = List.length pairs and size = List.length columns in
  let choose (chosen, found) (b, r) =
    let more = with_row width found r in
    if List.compare_lengths more found = 0 then (chosen, found) else ((b, r) :: chosen, more) in
  let chosen = List.rev (fst (List.fold_left choose ([], []) rows)) in
  if List.length chosen <> size then fun _ -> None
  else begin
    let parts = List.map fst chosen in
    let names = List.map (fun (b : V.hub) -> b.at_vertex) parts in
    let column v = match List.find_opt (fun (w, _) -> w = v) (List.combine names columns) with
      | Some (_, c) -> c | None -> fun _ -> Z.zero in
    (* the weights in the combination: the transposed system, solved with the row as right-hand side *)
    let combination v =
      let own = List.assoc v (List.map (fun ((b : V.hub), r) -> (b.at_vertex, r)) rows) in
      let line k = Array.of_list (List.map (fun (_, r) -> r.(k)) chosen @ [ own.(k) ]) in
      let solved = echelon size (List.init width line) in
      let weights = List.map (fun (_, r) -> r.(size)) solved in
      let times = List.fold_left (fun m x -> Z.lcm m (Q.den x)) Z.one weights in
      let whole = List.combine names (List.map (fun x -> Q.num (Q.mul (Q.of_bigint times) x)) weights) in
      (times, fun u -> Option.value (List.assoc_opt u whole) ~default:Z.zero) in
    let known = List.map (fun (b : V.hub) -> (b.at_vertex,
      if List.mem b.at_vertex names then (Z.one, fun _ -> Z.zero) else combination b.at_vertex)) hubs in
    fun bits ->
    let times = Z.shift_left Z.one bits in
    let m = Array.of_list (List.map (fun (k, _) -> scaled xs.(k) bits) reduced) in
    let start = start times in
    let middle () =
      let h = Hashtbl.create 16 in
      Array.iter (fun u -> Hashtbl.replace h u (Z.add (start u)
        (total (List.mapi (fun k c -> (k, c)) columns) (fun (k, c) -> Z.mul m.(k) (c u))))) inside;
      fun u -> match Hashtbl.find_opt h u with Some x -> x | None -> start u in
    let jacobian h = Array.of_list (List.map (fun b -> Array.of_list (List.map (fun c -> V.polar b h c) columns)) parts) in
    let inverse h =
      let a = jacobian h in
      let most = Array.fold_left (fun s row -> Array.fold_left (fun s x -> Z.max s (Z.abs x)) s row) Z.one a in
      let over = Z.shift_left Z.one (Z.numbits most + 64) in
      Option.map (fun y -> (over, Array.map (Array.map (fun x -> rounded (Q.mul (Q.of_bigint over) x))) y))
        (inverted (Array.map (Array.map Q.of_bigint) a)) in
    let residual y h i = total (List.mapi (fun k b -> (k, b)) parts) (fun (k, b) -> Z.mul y.(i).(k) (V.curved b h)) in
    let rec improve steps =
      match inverse (middle ()) with
      | None -> None
      | Some (over, y) when steps = 0 -> Some (over, y)
      | Some (over, y) ->
        let h = middle () in
        let moves = Array.init size (fun i -> rounded (Q.make (residual y h i) over)) in
        Array.iteri (fun i x -> m.(i) <- Z.sub m.(i) x) moves;
        improve (steps - 1) in
    match improve 6 with
    | None -> None
    | Some (over, y) ->
      let h = middle () and index = List.init size Fun.id in
      let weighted i f = total (List.mapi (fun k b -> (k, b)) parts) (fun (k, b) -> Z.mul y.(i).(k) (f b)) in
      let bound0 = largest (List.map (fun i -> Z.abs (residual y h i)) index) in
      let bound1 = largest (List.map (fun i -> total (List.mapi (fun j c -> (j, c)) columns) (fun (j, c) ->
        Z.abs (Z.sub (if i = j then over else Z.zero) (weighted i (fun b -> V.polar b h c))))) index) in
      let bound2 = largest (List.map (fun i -> total columns (fun c -> total columns (fun c' ->
        Z.abs (weighted i (fun b -> V.polar b c c'))))) index) in
      let half = Z.add two (Z.mul two (Z.cdiv bound0 over)) in
      let place v = place v 0 names in
      Some (start last, V.Within { (point start) with chosen = (fun v -> List.mem v names); column;
        centre = (fun v -> m.(place v)); half; inverse = (fun v w -> y.(place v).(place w)); over; bound0; bound1; bound2;
        combination = fun v -> Option.value (List.assoc_opt v known) ~default:(Z.one, fun _ -> Z.zero) })
  end

(* Heights that are polynomials of a root; [bits] are the digits of its interval. *)
let rooted (d : V.drawing) (p : V.prepared) c flat root bits =
  let hubs = List.filter (fun (b : V.hub) -> not (List.mem b.at_vertex flat || c.corner = Some b.at_vertex)) p.hubs in
  let size = List.length root.powers - 1 in
  if size > List.length p.hubs then None
  else begin
    let names = List.filteri (fun k _ -> k < size) (List.map (fun (b : V.hub) -> b.at_vertex) p.hubs) in
    let common = List.fold_left (fun n row -> Array.fold_left (fun n x -> Z.lcm n (Q.den x)) n row) Z.one root.powers in
    let column times row = placed c.own (Array.map (fun x -> Z.mul times (Q.num (Q.mul (Q.of_bigint common) x))) row) in
    let below = Z.shift_left Z.one bits in
    let low = Q.to_bigint (Q.mul_2exp root.about bits) in
    let low = if Q.lt root.about (Q.make low below) then Z.pred low else low in
    let high = Z.succ low in
    let unit = Z.pow below size in
    let most = Z.max (Z.abs low) (Z.abs high) in
    let pairs = List.combine names (List.map (column Z.one) (List.tl root.powers)) in
    let centre v = let j = place v 0 names in Z.mul (Z.pow low (j + 1)) (Z.pow below (size - j - 1)) in
    let half = largest (List.mapi (fun j _ ->
      Z.mul (Z.mul (Z.of_int (j + 1)) (Z.pow most j)) (Z.pow below (size - j - 1))) names) in
    let sp = { (point (column unit (List.hd root.powers))) with V.chosen = (fun v -> List.mem v names); centre; half;
      column = (fun v -> Option.value (List.assoc_opt v pairs) ~default:(fun _ -> Z.zero));
      polynomial = root.divisor; low; high; below } in
    let top, b4 = if c.corner = None then (Z.mul unit common, c.last) else (Z.zero, List.hd d.border) in
    let powers = V.powers d p b4 top sp in
    let divisor = Array.of_list (List.map Q.of_bigint root.divisor) in
    let quotient (b : V.hub) =
      let paired = Array.of_list (List.map Q.of_bigint (V.paired b powers powers)) in
      (b.at_vertex, List.map Q.num (Array.to_list (fst (divided paired divisor)))) in
    let known = List.map quotient hubs in
    Some (top, V.Within { sp with quotient = fun v -> Option.value (List.assoc_opt v known) ~default:[] })
  end

(* --- evidence for a branch --- *)

(* The heights seen from the side on which a reflex corner pops up. *)
let upright c xs =
  let popped r = List.find (fun (b : V.hub) -> b.at_vertex = r) c.p.hubs in
  match c.corner with
  | Some r when Z.sign (V.sided (popped r) (placed c.own (Array.map (fun x -> scaled x 128) xs))) < 0 -> Array.map Q.neg xs
  | _ -> xs

(* The evidence that the test accepts, if some is found; [flat] are the vertices with the sign 0, [straight] the folds with
   the letter F. *)
let evidence (d : V.drawing) lights c flat straight near accepts =
  let heights = upright c near.heights in
  let first found attempt = match found with Some _ -> found | None -> Option.bind (attempt ()) (fun e ->
    if accepts e then Some e else None) in
  let exact () = if near.exact then Some (exactly c heights) else None in
  let close bits () =
    let h = Array.make (List.length d.points) Z.zero in
    Array.iteri (fun k v -> h.(v) <- scaled heights.(k) bits) c.own;
    h.(c.last) <- Z.shift_left Z.one bits;
    Proposing.improve lights None h bits;
    Some (h.(c.last), V.Near (fun u -> h.(u))) in
  let is_straight (f : V.fold_form) = straight f.name || touches flat f in
  let basis = if c.corner = None then c.basis else Array.append (Array.map fixed c.own) [| (fun _ -> Z.zero) |] in
  let spaces make =
    let space = lazy (match within c flat (make ()) heights with exception Refused _ -> fun _ -> None | found -> found) in
    List.map (fun bits () -> Lazy.force space bits) [ 64; 128; 256; 512 ] in
  let flat_where test = spaces (fun () -> flat_space c.p basis test) in
  let straightened = if List.exists is_straight c.p.folds then flat_where is_straight else [] in
  let rest =
    if flat = [] then (if c.corner = None then List.map close Proposing.precisions else []) @ flat_where (fun _ -> false)
    else flat_where (touches flat) @ List.concat_map (fun s -> spaces (fun () -> s)) near.others in
  let turned = List.map (if heights == near.heights then Fun.id else Array.map Q.neg) in
  let algebraic = match near.root with
    | Some root -> let root = { root with powers = turned root.powers } in
      List.map (fun bits () -> rooted d c.p c flat root bits) [ 64; 128; 256 ]
    | None -> [] in
  List.fold_left first None (exact :: straightened @ rest @ algebraic)
