"""Proves simple rays of a periodic sheet in boxes, many at once, and decides their signs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.branches.values.letters import LETTERS
from exactfold.branches.values.roots import AlgebraicRoot, BoxRoot
from exactfold.rigidity.equations.periodic import PeriodicProblem, in_chart
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.certify.box import IsolatingBox
from exactfold.solve.certify.float_krawczyk import FloatKrawczyk, FloatSigns

BITS = 44
_PRECISIONS = (64, 128, 256)
_LETTERS = np.array([ord(LETTERS[sign]) for sign in (-1, 0, 1)], dtype=np.uint8)


@dataclass(frozen=True)
class Ray:
    """A simple ray, in the chart z_place = 1; `root` is on the side with the signs of its row.

    `b` is the sign of b on this side. `letters` are those of the folds of the sheet, and `in_box`
    those that the box alone shows.
    """

    row: int
    signs: tuple[int, ...]
    place: int
    root: BoxRoot
    b: int
    letters: str
    in_box: str


@dataclass(frozen=True)
class RayChart:
    """One chart z_place = 1 of a problem, with its tests."""

    problem: PeriodicProblem
    place: int
    system: QuadraticSystem = field(init=False)
    vertices: tuple[tuple[int, ...], ...] = field(init=False)
    folds: tuple[tuple[int, ...], ...] = field(init=False)
    bend: tuple[int, ...] = field(init=False)

    def __post_init__(self) -> None:
        problem, place = self.problem, self.place
        known = {
            "system": problem.system(place),
            "vertices": tuple(tuple(in_chart(r, place)) for r in problem.vertices.values()),
            "folds": tuple(tuple(in_chart(r, place)) for r in problem.folds.values()),
            "bend": tuple(in_chart(problem.bend, place)),
        }
        for name, value in known.items():
            object.__setattr__(self, name, value)

    def proved(self, rows: FloatArray, rays: FloatArray, signs: FloatArray) -> Iterator[Ray]:
        """The rays that boxes prove to be simple, with these signs and with b other than 0.

        `rays` has shape (m, n + 1), and `rows` are the numbers of its rows.
        """
        points = np.delete(rays, self.place, axis=1) / rays[:, self.place, None]
        side = np.sign(rays[:, self.place])
        boxes = FloatKrawczyk(self.system).isolate(points, BITS)
        vertices = FloatSigns(self.vertices).on(boxes)
        rest = FloatSigns((*self.folds, self.bend)).on(boxes) * side[:, None].astype(np.int8)
        good = boxes.proved & (vertices * side[:, None] == signs).all(axis=1) & (rest != 0).all(1)
        letters = _LETTERS[rest[:, :-1] + 1]
        names = list(map(tuple, signs.astype(int).tolist()))
        for k, row in enumerate(rows.tolist()):
            if good[k]:
                root = BoxRoot(boxes.box(k), int(side[k]), self.system)
                text = letters[k].tobytes().decode()
                yield Ray(row, names[k], self.place, root, int(rest[k, -1]), text, text)
            else:
                ray = self._exactly(row, points[k], int(side[k]), signs[k])
                if ray is not None:
                    yield ray

    def _exactly(self, row: int, point: FloatArray, side: int, signs: FloatArray) -> Ray | None:
        from exactfold.solve.certify.exact_krawczyk import krawczyk  # loads FLINT

        if not np.isfinite(point).all():
            return None
        (box,) = krawczyk(self.system, point[None], precisions=_PRECISIONS)
        if not isinstance(box, IsolatingBox):
            return None
        root: BoxRoot | None = BoxRoot(box, side, self.system)
        best: Ray | None = None
        for bits in (*_PRECISIONS, 1024):
            if root is None:
                break
            found = [root.sign(line) for line in self.vertices]
            if any(s is not None and s != e for s, e in zip(found, signs.tolist(), strict=True)):
                return None
            b = root.sign(self.bend)
            if b and None not in found:
                text = "".join(LETTERS[root.sign(line)] for line in self.folds)
                names = tuple(map(int, signs.tolist()))
                best = Ray(row, names, self.place, root, b, text, text)
                if "U" not in text:
                    return best
            root = root.sharpened(bits)
        return None if best is None else replace(best, letters=self._letters(best.root))

    def _letters(self, root: BoxRoot) -> str:
        """The letters at a root; those that its box leaves open, if its exact zero is found."""
        from exactfold.branches.values.known_roots import zero_in  # loads FLINT

        found = [root.sign(line) for line in self.folds]
        known = zero_in(self.system, root.box)
        if known is not None:
            exact = AlgebraicRoot(*known, side=root.side)
            found = [
                exact.sign(line) if sign is None else sign
                for sign, line in zip(found, self.folds, strict=True)
            ]
        return "".join(map(LETTERS.__getitem__, found))


def prove_rays(problem: PeriodicProblem, rays: FloatArray, signs: FloatArray) -> dict[int, Ray]:
    """The proved simple rays by the number of their sign vector, from one candidate for each.

    The chart of a ray is that of its largest entry. A ray that is missing may be multiple, have
    b = 0, or belong to a space of more dimensions.
    """
    usable = np.flatnonzero(np.isfinite(rays).all(axis=1))
    places = np.abs(rays[usable]).argmax(axis=1)
    found: dict[int, Ray] = {}
    for place in np.unique(places).tolist():
        rows = usable[places == place]
        chart = RayChart(problem, place)
        for ray in chart.proved(rows, rays[rows], signs[rows]):
            found[ray.row] = ray
    return found
