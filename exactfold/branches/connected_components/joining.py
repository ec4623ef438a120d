"""The connected components of the solutions of a convex sheet: which sign vectors are joined."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Final

from exactfold._support.progress import Progress
from exactfold.branches.connected_components.cubes import Cube, components
from exactfold.branches.connected_components.flat_stars import FlatSolutions, flat_solutions
from exactfold.branches.connected_components.result import ConnectedComponents, FlatStars, Joint
from exactfold.errors import NotApplicableError
from exactfold.panels.vertex.stars import Star, edge_of, stars
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.loading import PatternLike, as_pattern
from exactfold.pattern.opening import panels
from exactfold.pattern.panel_pattern import PanelPattern

_MOST_WHOLE: Final = 16
"""On sheets with up to this many foldable vertices, joints are looked for at every vertex."""
_MOST_LOCAL: Final = 300
"""On sheets with up to this many foldable vertices, joints are looked for at all."""


def find_connected_components(
    pattern: PatternLike, *, progress: Progress | None = None
) -> ConnectedComponents:
    """The connected components of the solutions of a convex sheet with D >= 2, and their joints.

    There is exactly one solution for each sign vector and all boundary heights modulo planes. So
    the solutions are 2^n graphs over R^D. Without the flat state, their connected components
    correspond to those of a graph of sign vectors. In it, e and the vector that differs from e at v
    are joined if some nonzero solution with these signs is flat at v (docs/any_border.md, Theorem
    7). For each vertex, the sheet with its star held flat is solved exactly. What is not decided
    there is named in `open`, and the number of components is only bounded.

    Raises `NotApplicableError` for a boundary with a reflex corner, and for D < 2.

    >>> from exactfold.pattern.families import single_vertex
    >>> find_connected_components(single_vertex(6))
    <Pieces: proved, 2 of 2 graphs>
    """
    pattern = as_pattern(pattern)
    require_convex(pattern)
    sheet, labels = pattern.without_rigid_parts()
    whole = ConnectedComponents(tuple(labels[v] for v in sheet.interior), pattern.D, 1, 1, 1)
    if sheet.chords:
        i, j = sheet.chords[0]
        return replace(whole, chord=(labels[i], labels[j]))
    return _labelled(_JointSearch(sheet, progress).found(), labels)


def require_convex(pattern: CreasePattern) -> None:
    """Raise `NotApplicableError` unless the boundary is convex and has at least five vertices."""
    if pattern.D < 2:
        raise NotApplicableError(
            f"the sheet has {pattern.Ve} boundary vertices, so its solutions are branches; "
            "connected components are computed for at least five boundary vertices"
        )
    if not pattern.is_convex:
        raise NotApplicableError(
            f"the boundary has a reflex corner, vertex {pattern.reflex_corner}; with more "
            "than four "
            "corners the shapes of such a sheet need not be real"
        )


class _JointSearch:
    """What is known of the joints of a sheet that has no rigid parts and no chords."""

    def __init__(self, sheet: CreasePattern, progress: Progress | None) -> None:
        self.sheet = sheet
        self.progress = progress
        self.panels: PanelPattern = panels(sheet)
        self.vertices = sheet.interior
        self.joints: list[Joint] = []
        self.true_cubes: list[Cube] = []
        self.never: dict[int, str] = {}
        self.complete: list[int] = []
        self.open: dict[int, str] = {}
        self.proofs: list[FlatStars] = []

    def found(self) -> ConnectedComponents:
        """The components; their number is bounded where joints are undecided."""
        waiting = self._classes()
        if len(self.vertices) <= _MOST_LOCAL:
            self._look_locally()
        small = len(self.vertices) <= _MOST_WHOLE
        for number, (moving, vertices) in enumerate(waiting):
            if self.progress is not None:
                self.progress("joining", number, len(waiting))
            if self._count(()) == (1, 1):
                self.open |= dict.fromkeys(vertices, "not needed: all sign vectors are joined")
                continue
            if not small:
                reason = (
                    f"joints are looked for at every vertex only if at most {_MOST_WHOLE} can pop"
                )
                self.open |= dict.fromkeys(vertices, reason)
                continue
            solutions = flat_solutions(moving)
            self._add(solutions.joints)
            done = () if solutions.open else tuple(vertices)
            self.proofs.append(FlatStars((vertices[0],), done, solutions.proofs))
            if solutions.open:
                self.open |= dict.fromkeys(vertices, solutions.open)
            elif solutions.joints:
                self.complete += vertices
            else:
                reason = "with its star held flat, the only solution is the flat state"
                self.never |= dict.fromkeys(vertices, reason)
        low, _ = self._count(tuple(self.open))
        _, high = self._count(())
        return ConnectedComponents(
            self.vertices,
            self.sheet.D,
            low,
            high,
            components(len(self.vertices), self.true_cubes)[1],
            tuple(self.joints),
            dict(sorted(self.never.items())),
            tuple(sorted(self.complete)),
            dict(sorted(self.open.items())) if low < high else {},
            proofs=tuple(self.proofs),
        )

    def _classes(self) -> list[tuple[Mapping[int, Star], list[int]]]:
        """The stars that can still bend when the star of a vertex is held flat.

        Vertices that leave the same stars are treated together. If no star can bend, the star of
        the vertex is never flat.
        """
        classes: dict[frozenset[Edge], tuple[Mapping[int, Star], list[int]]] = {}
        for v in self.vertices:
            around = [edge_of(v, u) for u in self.sheet.star(v)]
            moving = stars(self.panels, around)
            if not moving:
                self.never[v] = "with its star held flat, no fold can bend"
                self.proofs.append(FlatStars((v,), (v,), ()))
                continue
            key = frozenset(edge for star in moving.values() for edge in star.folds)
            classes.setdefault(key, (moving, []))[1].append(v)
        return list(classes.values())

    def _look_locally(self) -> None:
        """Look for joints at which all stars are flat except one, two, or those along a straight
        crease.
        """
        for chosen in self._groups():
            held = [
                (i, j)
                for i, j in self.panels.folds
                if any(v in self.sheet.interior_set and v not in chosen for v in (i, j))
            ]
            moving = stars(self.panels, held)
            solutions = flat_solutions(moving) if moving else FlatSolutions(())
            if solutions.joints:
                self._add(solutions.joints)
                flat = tuple(v for v in self.vertices if v not in chosen)
                self.proofs.append(FlatStars(flat, (), solutions.proofs))

    def _groups(self) -> Iterator[frozenset[int]]:
        """Vertices and pairs of neighbours with enough folds of their own, and straight creases."""
        inside = self.sheet.interior_set
        boundary = {v: sum(u not in inside for u in self.sheet.star(v)) for v in self.vertices}
        seen: set[frozenset[int]] = set()
        groups = [frozenset([v]) for v in self.vertices if boundary[v] >= 4]
        groups += [
            frozenset(fold)
            for fold in self.sheet.folds
            if inside.issuperset(fold) and min(boundary[v] for v in fold) >= 3
        ]
        groups += self._straight()
        for group in groups:
            if len(group) < len(self.vertices) and group not in seen:
                seen.add(group)
                yield group

    def _straight(self) -> list[frozenset[int]]:
        """The interior vertices of straight creases that run from boundary to boundary."""
        inside = self.sheet.interior_set
        paths = []
        for b in self.sheet.boundary:
            for v in self.sheet.star(b):
                path, before = [], b
                while v in inside:
                    path.append(v)
                    after = self._ahead(before, v)
                    if after is None:
                        path = []
                        break
                    before, v = v, after
                if path:
                    paths.append(frozenset(path))
        return paths

    def _ahead(self, before: int, v: int) -> int | None:
        """The neighbour of v that lies straight ahead if one comes from `before`."""
        (ax, ay), (bx, by) = self.sheet.vertices[before], self.sheet.vertices[v]
        for u in self.sheet.star(v):
            x, y = self.sheet.vertices[u]
            across = (bx - ax) * (y - by) - (by - ay) * (x - bx)
            if not across and (bx - ax) * (x - bx) + (by - ay) * (y - by) > 0:
                return u
        return None

    def _add(self, joints: Iterable[Joint]) -> None:
        """Keep joints that join more than the known ones do; flat vertices have sign 0."""
        for joint in joints:
            signs = {v: joint.signs.get(v, 0) for v in self.vertices}
            if all(signs.values()):
                continue
            mine = _cubes(signs, self.vertices)
            if joint.folds:
                self.true_cubes += mine
            if any(_within(mine[0], cube) for cube in self._cubes(self.joints)):
                continue
            self.joints = [
                other
                for other in self.joints
                if not any(_within(_cubes(other.signs, self.vertices)[0], cube) for cube in mine)
            ]
            self.joints.append(replace(joint, signs=signs))

    def _cubes(self, joints: Sequence[Joint]) -> list[Cube]:
        return [cube for joint in joints for cube in _cubes(joint.signs, self.vertices)]

    def _count(self, free: Sequence[int]) -> tuple[int, int]:
        """Bounds of the number of components if all flips at the vertices of `free` are joints,
        too.
        """
        kept = [v for v in self.vertices if v not in set(free)]
        cubes = [cube for joint in self.joints for cube in _cubes(joint.signs, kept)]
        return components(len(kept), cubes)


def _cubes(signs: Mapping[int, int], vertices: Sequence[int]) -> tuple[Cube, Cube]:
    """The sign vectors that a solution joins, and those that its reflection joins."""
    up = sum(1 << k for k, v in enumerate(vertices) if signs[v] > 0)
    down = sum(1 << k for k, v in enumerate(vertices) if signs[v] < 0)
    return (up | down, up), (up | down, down)


def _within(small: Cube, large: Cube) -> bool:
    return small[0] & large[0] == large[0] and small[1] & large[0] == large[1]


def _labelled(
    connected_components: ConnectedComponents, labels: Sequence[int]
) -> ConnectedComponents:
    """The same result with the pattern's numbers of the vertices."""
    if all(k == v for k, v in enumerate(labels)):
        return connected_components

    def edge(pair: Edge) -> Edge:
        return labels[pair[0]], labels[pair[1]]

    return replace(
        connected_components,
        vertices=tuple(labels[v] for v in connected_components.vertices),
        joints=tuple(
            replace(
                joint,
                signs={labels[v]: sign for v, sign in joint.signs.items()},
                densities={edge(pair): bounds for pair, bounds in joint.densities.items()},
            )
            for joint in connected_components.joints
        ),
        never_flat={labels[v]: why for v, why in (connected_components.never_flat or {}).items()},
        complete=tuple(labels[v] for v in connected_components.complete),
        open={labels[v]: why for v, why in (connected_components.open or {}).items()},
        proofs=tuple(
            FlatStars(
                tuple(labels[v] for v in proof.held),
                tuple(labels[v] for v in proof.complete),
                tuple(
                    replace(part, folds=tuple(edge(fold) for fold in part.folds))
                    for part in proof.parts
                ),
            )
            for proof in connected_components.proofs
        ),
    )
