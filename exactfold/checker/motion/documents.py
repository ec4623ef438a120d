"""What is claimed of motions as it stands in a file, with exact numbers in quotes.

What the claims mean is written at their classes, which `certificate` lists.
"""

from __future__ import annotations

from typing import TypedDict


class NamedHalf(TypedDict):
    """A half of a branch, by the signs of the interior vertices and its side of the flat state."""

    vertex_signs: list[int]
    side: int


class DrivenFolds(TypedDict):
    """Folds in a given ratio, and whether they are said to reach their angles."""

    folds: list[list[int]]
    squares: list[str]
    reached: bool


class FlatStars(TypedDict):
    """A branch point, by the vertices whose stars are flat; whether it is clear of contacts."""

    flat: list[int]
    clear: bool


class TouchingFaces(TypedDict):
    """A contact between two bounds, of two faces or of the faces of folds that are closed."""

    kind: str
    time: list[str]
    faces: list[list[int]]
    folds: list[list[int]]


_Return = TypedDict("_Return", {"return": NamedHalf}, total=False)  # a keyword of Python


class _Contacts(TypedDict, total=False):
    clear: str
    contact: TouchingFaces


class _More(_Return, _Contacts, total=False):
    through: list[list[int]]
    node: FlatStars
    rim: list[str]
    drive: DrivenFolds
    pinned: list[int]


class VerifiedMotion(NamedHalf, _More):
    """What is verified of a motion along a branch.

    To its claims the checker adds the digest of the pattern, the number of `tubes` and, with a
    `rim`, the vertices of the face that is held, `pinned`.
    """

    length: str
    tubes: int
    sha256: str


class _Driven(TypedDict, total=False):
    rates: list[str]
    contact: TouchingFaces


class VerifiedPanelMotion(_Driven):
    """What is verified of a motion of rigid panels: its claims, and the digest of the pattern."""

    assignment: str
    drivers: list[list[int]]
    clear: str
    sha256: str
