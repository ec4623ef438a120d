"""A patch of cells of a periodic sheet: a finite sheet of triangles that is a disk."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from exactfold.errors import UsageError
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.periodic.cells import Corner, Face
from exactfold.pattern.periodic.periodic_pattern import PeriodicPattern

CELLS: Final = (5, 5)
"""How many cells are shown, along both lattice vectors, unless another number is asked for."""
MOST_CELLS: Final = 40


@dataclass(frozen=True)
class Patch:
    """A sheet of n x m cells: vertex k is the corner `corners[k]` of the periodic sheet."""

    pattern: CreasePattern
    corners: tuple[Corner, ...]

    @classmethod
    def of(cls, sheet: PeriodicPattern, cells: tuple[int, int]) -> Patch:
        """The faces of n x m cells; those that meet the others in a corner only are left out.

        Raises `UsageError` for a bad number of cells.
        """
        if min(cells) < 1 or max(cells) > MOST_CELLS:
            raise UsageError(
                f"{cells[0]},{cells[1]} cells: give 1 to {MOST_CELLS} in each direction"
            )
        faces: list[Face] = [
            (_moved(a, k, m), _moved(b, k, m), _moved(c, k, m))
            for k in range(cells[0])
            for m in range(cells[1])
            for a, b, c in sheet.faces
        ]
        kept = _disk(faces, len(faces) // 2)
        corners = sorted({corner for face in kept for corner in face}, key=lambda c: (c[1:], c))
        number = {corner: k for k, corner in enumerate(corners)}
        triangles = [[number[corner] for corner in face] for face in kept]
        pattern = CreasePattern([sheet.place(corner) for corner in corners], triangles)
        return cls(pattern, tuple(corners))

    def letters(self, sheet: PeriodicPattern, letters: str) -> dict[Edge, str]:
        """The letter of each fold, from one letter for each edge of the cell."""
        known = dict(zip(sheet.edges, letters, strict=True))
        found = {}
        for fold in self.pattern.folds:
            (u, i, j), (v, k, m) = (self.corners[end] for end in fold)
            side = (u, v, k - i, m - j)
            found[fold] = known.get(side) or known[v, u, i - k, j - m]
        return found


def _moved(corner: Corner, i: int, j: int) -> Corner:
    return corner[0], corner[1] + i, corner[2] + j


def _disk(faces: Sequence[Face], first: int) -> list[Face]:
    """Faces that form a disk with one of them: each is added along one, two or three sides.

    Along one side it is added only if its third corner is new.
    """
    sides: dict[frozenset[Corner], list[int]] = {}
    for k, face in enumerate(faces):
        for n in range(3):
            sides.setdefault(frozenset((face[n], face[n - 1])), []).append(k)
    kept, corners, waiting = {first}, set(faces[first]), [first]
    while waiting:
        face = faces[waiting.pop(0)]
        around = {k for n in range(3) for k in sides[frozenset((face[n], face[n - 1]))]} - kept
        for k in sorted(around):
            known = {
                end
                for n in range(3)
                for side in [frozenset((faces[k][n], faces[k][n - 1]))]
                if kept.intersection(sides[side])
                for end in side
            }
            if corners.intersection(faces[k]) == known:
                kept.add(k)
                corners.update(faces[k])
                waiting += [k, *_around(faces, sides, k, kept)]
    return [faces[k] for k in sorted(kept)]


def _around(
    faces: Sequence[Face], sides: Mapping[frozenset[Corner], list[int]], face: int, kept: set[int]
) -> Iterator[int]:
    """The faces that are kept and share a side with a neighbour of a face: it may fit now."""
    for n in range(3):
        for k in sides[frozenset((faces[face][n], faces[face][n - 1]))]:
            for m in range(3):
                near = sides[frozenset((faces[k][m], faces[k][m - 1]))]
                yield from (other for other in near if other in kept and k not in kept)
