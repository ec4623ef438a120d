(* SHA-256 (FIPS 180-4), in hexadecimal. *)

let primes count =
  let rec next found n =
    if List.length found = count then List.rev found
    else next (if List.exists (fun p -> n mod p = 0) found then found else n :: found) (n + 1)
  in
  next [] 2

(* The first 32 bits of the fractional part of the k-th root of n. *)
let fraction k n = Z.to_int (Z.extract (Z.root (Z.shift_left (Z.of_int n) (32 * k)) k) 0 32)
let start = Array.of_list (List.map (fraction 2) (primes 8))
let constants = Array.of_list (List.map (fraction 3) (primes 64))
let mask = 0xffffffff
let rotate x n = ((x lsr n) lor (x lsl (32 - n))) land mask

let block state words bytes at =
  for t = 0 to 15 do
    words.(t) <- Int32.to_int (Bytes.get_int32_be bytes (at + (4 * t))) land mask
  done;
  for t = 16 to 63 do
    let x = words.(t - 15) and y = words.(t - 2) in
    let s0 = rotate x 7 lxor rotate x 18 lxor (x lsr 3) in
    let s1 = rotate y 17 lxor rotate y 19 lxor (y lsr 10) in
    words.(t) <- (words.(t - 16) + s0 + words.(t - 7) + s1) land mask
  done;
  let rec rounds t a b c d e f g h =
    if t = 64 then
      List.iteri (fun k x -> state.(k) <- (state.(k) + x) land mask) [ a; b; c; d; e; f; g; h ]
    else
      let s1 = rotate e 6 lxor rotate e 11 lxor rotate e 25 in
      let choice = e land f lxor (lnot e land g) in
      let one = h + s1 + choice + constants.(t) + words.(t) in
      let s0 = rotate a 2 lxor rotate a 13 lxor rotate a 22 in
      let two = s0 + (a land b lxor (a land c) lxor (b land c)) in
      rounds (t + 1) ((one + two) land mask) a b c ((d + one) land mask) e f g
  in
  rounds 0 state.(0) state.(1) state.(2) state.(3) state.(4) state.(5) state.(6) state.(7)

let hex text =
  let length = String.length text in
  let padded = Bytes.make ((length + 72) / 64 * 64) '\000' in
  Bytes.blit_string text 0 padded 0 length;
  Bytes.set padded length '\128';
  Bytes.set_int64_be padded (Bytes.length padded - 8) (Int64.of_int (8 * length));
  let state = Array.copy start and words = Array.make 64 0 in
  for k = 0 to (Bytes.length padded / 64) - 1 do
    block state words padded (64 * k)
  done;
  String.concat "" (Array.to_list (Array.map (Printf.sprintf "%08x") state))
