"""What a certificate of a sheet of rigid panels claims (docs/certificate.md, panels)."""

from __future__ import annotations

from typing import TypedDict


class LeafClaim(TypedDict):
    """Spaces with the same folds, dimension and cones: how many, and how many of them extend."""

    folds: list[list[int]]
    dimension: int
    cones: list[int]
    number: int
    extending: int


class ModeClaim(TypedDict):
    """A mode of a support, by which line of motions it has at each vertex."""

    choice: str
    assignment: str
    extends: str
    loop: list[int] | None
    order: int | None


class SupportClaim(TypedDict):
    """Folds that move together, in how many modes, and how many of these extend by what."""

    vertices: list[int]
    folds: list[list[int]]
    count: int
    extending: int | None
    by: str
    modes: list[ModeClaim] | None


class PartClaim(TypedDict):
    """A part of the sheet with vertices of more than four folds."""

    vertices: list[int]
    complete: bool
    leaves: list[LeafClaim]


class PanelFacts(TypedDict):
    """What the checker finds again: the sheet, its components and the number of its modes."""

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
    """What a file claims, with each support."""

    supports: list[SupportClaim]


class PanelsClaims(ModesClaims, total=False):
    """The same, with the parts that are split into spaces, if there are any."""

    spaces: list[PartClaim]
