(* Zarith's integers, under a name that the extracted program does not use. *)
include Z
