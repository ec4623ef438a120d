"""The claims in a certificate of a sheet of rigid panels (docs/certificate.md, panels)."""

from __future__ import annotations

from typing import TypedDict


class LeafClaim(TypedDict):
    """The leaves with the same folds, dimension and cones.

    `number` says how many there are, `extending` how many of them extend to true motions.
    """

    folds: list[list[int]]
    dimension: int
    cones: list[int]
    number: int
    extending: int


class ModeClaim(TypedDict):
    """A mode of a support. `choice` says which line of motions it has at each vertex."""

    choice: str
    assignment: str
    extends: str
    loop: list[int] | None
    order: int | None


class SupportClaim(TypedDict):
    """A support: folds that move together.

    `count` is the number of its modes, `extending` the number of modes that extend to true motions,
    and `by` the reason why they extend.
    """

    vertices: list[int]
    folds: list[list[int]]
    count: int
    extending: int | None
    by: str
    modes: list[ModeClaim] | None


class PartClaim(TypedDict):
    """A part of the sheet in which some vertex has more than four folds."""

    vertices: list[int]
    complete: bool
    leaves: list[LeafClaim]


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
