"""One branch on demand: from a vector of vertex signs to a proven branch, without enumerating.

`sheet` states the equations, `floats`, `path` and `refine` propose heights, and `enclosure`, which
is exact, proves where the branch is. `find` puts them together (docs/branch.md).
"""
