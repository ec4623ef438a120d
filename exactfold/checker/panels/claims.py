"""The claims in a certificate of a sheet of rigid panels (docs/certificate.md, panels).

The pattern has the `radicands` of its field, one after the other: for the k-th, counted from 0, the
2^k coefficients of the number that it is the root of; of each of the `vertices` the coefficients of
x and of y, 2^m rationals for m roots, where bit i of the place stands for root i; and the `edges`,
pairs i < j, sorted. A sheet with holes has `holes`, too, cycles of vertices that are sorted,
counter-clockwise from the smallest vertex. In its claims hole k, from 0, counts as the vertices
V + 3 k + a for V vertices and a = 0, 1, 2 (`exactfold/checker/sheets/holes.py`). The claims are

- `interior`, `border`, `folds`, `sha256`: numbers of vertices and folds, and the digest;
- `held`: folds that were not to fold; everything else holds if they are held flat;
- `flat`, `free`: folds that are flat in every motion by the flat closure; folds from boundary to
  boundary, which are in no condition;
- `second_order`, `true`: {dimension: number} of the components, to second order and truly; `true`
  is null if it is not known;
- `rigid`: "proved", "refuted" or, which claims nothing, "undecided";
- `modes`: the number of elementary modes; null if vertices have more than four folds that may fold,
  or holes, or if there are `trees`;
- `supports`: all sets of vertices that move together;
- `spaces`, `trees`: the parts that have vertices with more than four folds that may fold, or
  holes, and those whose components are counted along a tree; left out if there are none.
"""

from __future__ import annotations

from typing import Any, TypedDict


class LeafClaim(TypedDict):
    """The leaves of one kind: components of the motions of a part to second order.

    They have the same active `folds`, `dimension` and `cones`, the vertices whose forms are left
    (none for a linear space). `number` says how many there are, `extending` how many of them, at
    least, extend to true motions.
    """

    folds: list[list[int]]
    dimension: int
    cones: list[int]
    number: int
    extending: int


class ModeClaim(TypedDict):
    """A mode of a support.

    `choice` says which line of motions it has at each vertex: "0" if only one has these active
    folds. If two have, compare the density of the fold to the second neighbour over an active fold,
    divided by that of the fold to the first, with neighbours taken by number: it is smaller for "-"
    and larger for "+". `assignment` has the letters M and V of the folds, or all of them exchanged.
    `extends` is "proved", "undecided", or "refuted", with a `loop` of vertices round which the
    transmissions differ from the identity at the `order` in the fold angle; both are else null.
    """

    choice: str
    assignment: str
    extends: str
    loop: list[int] | None
    order: int | None


class SupportClaim(TypedDict):
    """A support: folds that move together.

    `count` is the number of its modes, `extending` the number of modes that extend to true motions,
    or null if it is not known, and `by` the reason why they extend: "forest" if the active graph
    has no loop, "linear" if all transmissions round its loops are linear, else "loops". `modes` is
    null, or lists all of them.
    """

    vertices: list[int]
    folds: list[list[int]]
    count: int
    extending: int | None
    by: str
    modes: list[ModeClaim] | None


class ListedPart(TypedDict):
    """A part of the sheet in which some vertex has more than four folds.

    `complete` says whether the leaves are all true motions near the flat state. If it is false,
    nothing is claimed of others.
    """

    vertices: list[int]
    complete: bool
    leaves: list[LeafClaim]


class IsolatedClaim(TypedDict):
    """All complex motions of a part, each of which is isolated.

    `chart` has a fold i-j and a weight in each entry. The sum of all weights times densities is 1;
    the densities of all these folds but the last are the unknowns. `real` has a box for each real
    motion, as in a listing. `nonreal` has a box for one of each pair of conjugate motions; the
    imaginary parts of its unknowns follow the real parts.
    """

    chart: list[list[int]]
    real: list[dict[str, Any]]
    nonreal: list[dict[str, Any]]


class PartClaim(ListedPart, total=False):
    """The same claims, with all complex motions if these are isolated and were found by number."""

    isolated: IsolatedClaim


class TreeClaim(TypedDict):
    """A part of the sheet whose vertices form a tree, and its components by dimension.

    All of them extend to true motions, and there are no others if no vertex has more than four
    folds.
    """

    vertices: list[int]
    components: dict[str, int]


class PanelFacts(TypedDict):
    """The claims that the checker finds again: the sheet, its components, the number of modes."""

    interior: int
    border: int
    folds: int
    sha256: str
    held: list[list[int]]
    flat: list[list[int]]
    free: list[list[int]]
    second_order: dict[str, int]
    true: dict[str, int] | None
    rigid: str
    modes: int | None


class ModesClaims(PanelFacts):
    """The claims of a file, which also list each support."""

    supports: list[SupportClaim]


class PanelsClaims(ModesClaims, total=False):
    """The same claims, with the parts that are split into spaces if there are any, and those that
    are counted along trees."""

    spaces: list[PartClaim]
    trees: list[TreeClaim]
