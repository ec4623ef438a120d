(* Changes each number that is proposed for the branches of a listing in one object: the proved test must refuse it. *)

open Sheets
module V = Verified

let () =
  let data = Reading.(parse (file Sys.argv.(1))) in
  let t, classes = Listing.opened data (Reading.entry "evidence" data) in
  let chart = Reading.(entry "chart" (entry "evidence" data)) in
  let roots, _, _ = Listing.roots_of t chart classes (Listing.in_object data) in
  let passes = Listing.passes t in
  let refused = ref 0 and spaces = ref 0 in
  let more = Z.add Z.one and less = Z.pred in
  let forge number (r : V.root) =
    let refuse what r = if passes r then (Printf.printf "branch %d passes with another %s\n" number what; exit 1) else incr refused in
    if not (passes r) then (Printf.printf "branch %d does not pass\n" number; exit 1);
    if t.corner = None then begin
      refuse "height of the corner" { r with top = Z.zero };
      refuse "height of the corner" { r with top = Z.neg r.top }
    end;
    (match r.rise with
    | Some (Some up) -> refuse "side" { r with rise = Some (Some (not up)) }; refuse "side" { r with rise = Some None }
    | _ -> ());
    refuse "multiplicity" { r with times = r.times + 1 };
    List.iter (fun v ->
      let signed s = fun u -> if u = v then s else r.signs_of u in
      match r.signs_of v with
      | Some up ->
        refuse "sign" { r with signs_of = signed (Some (not up)) };
        refuse "sign" { r with signs_of = signed None; times = 2 * r.times }
      | None ->
        refuse "sign" { r with signs_of = signed (Some true); times = r.times / 2 };
        refuse "sign" { r with signs_of = signed (Some false); times = r.times / 2 }) (Array.to_list t.inside);
    List.iter (fun v -> refuse "sign in a triangle"
      { r with signs_of = (fun u -> if u = v then Some true else r.signs_of u); times = r.times / 2 }) t.hidden;
    List.iter (fun (f : V.fold_form) ->
      let lettered l = { r with letters_of = fun k -> if k = f.name then l else r.letters_of k } in
      match r.letters_of f.name with
      | Some (Some valley) -> refuse "letter" (lettered (Some (Some (not valley)))); refuse "letter" (lettered (Some None))
      | Some None -> refuse "letter" (lettered (Some (Some true))); refuse "letter" (lettered (Some (Some false)))
      | None -> ()) t.p.folds;
    let flat = List.filter (fun v -> r.signs_of v = None) (Array.to_list t.inside) in
    match r.found with
    | V.Near h ->
      refuse "side" { r with found = V.Near (fun u -> Z.neg (h u)) };
      refuse "letter of all folds" { r with letters_of = fun _ -> None }
    | V.Within sp ->
      let space what sp = refuse what { r with found = V.Within sp } in
      let raised v h = fun u -> if u = v then more (h u) else h u in
      List.iter (fun v -> space "base" { sp with base = raised v sp.base }) flat;
      let names = List.filter sp.chosen (Array.to_list t.inside) in
      if names <> [] then begin
        incr spaces;
        List.iter (fun k ->
          List.iter (fun v -> space "column" { sp with column = fun j -> if j = k then raised v (sp.column j) else sp.column j }) flat;
          space "centre" { sp with centre = fun j -> Z.add (sp.centre j) (if j = k then Z.of_int 1024 else Z.zero) }) names;
        if sp.polynomial = [] then begin
          space "radius" { sp with half = Z.minus_one };
          space "radius" { sp with half = Z.shift_left (more sp.half) 10_000 };
          space "inverse" { sp with inverse = fun _ _ -> Z.zero };
          space "denominator" { sp with over = Z.neg sp.over };
          space "denominator" { sp with over = Z.mul (Z.of_int 2) sp.over };
          space "bound" { sp with bound0 = less sp.bound0 };
          space "bound" { sp with bound1 = less sp.bound1 };
          space "bound" { sp with bound2 = less sp.bound2 };
          space "bound" { sp with bound0 = Z.mul sp.half sp.over };
          space "bound" { sp with bound1 = sp.over };
          space "bound" { sp with bound2 = sp.over };
        end
        else begin
          space "radius" { sp with half = less sp.half };
          space "polynomial" { sp with polynomial = more (List.hd sp.polynomial) :: List.tl sp.polynomial };
          space "end" { sp with low = less sp.low };
          space "ends" { sp with low = sp.high; high = sp.low };
          space "ends" { sp with low = more sp.low; high = more sp.high };
          space "denominator" { sp with below = Z.neg sp.below };
          List.iter (fun v -> if not (List.mem v flat) then
            space "quotient" { sp with quotient = fun u -> if u = v then [ Z.one ] else sp.quotient u }) (Array.to_list t.inside)
        end;
        space "choice" { sp with chosen = fun _ -> false };
        space "choice" { sp with chosen = fun _ -> true }
      end;
      List.iter (fun v -> if not (sp.polynomial <> [] || sp.chosen v || List.mem v flat) then
        space "combination" { sp with combination = fun u -> if u = v then (Z.zero, fun _ -> Z.zero) else sp.combination u })
        (Array.to_list t.inside) in
  List.iteri forge roots;
  Printf.printf "refused %d changes, with %d spaces\n" !refused !spaces
