"""Proves simple rays of a periodic sheet in boxes, many at once, and decides their signs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from exactfold._support.arrays import FloatArray, IndexArray
from exactfold._support.clock import Clock
from exactfold.branches.values.known_roots import FEW, zero_in
from exactfold.branches.values.letters import LETTERS
from exactfold.branches.values.roots import AlgebraicRoot, BoxRoot
from exactfold.rigidity.equations.periodic import PeriodicProblem, in_chart
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.certify.box import IsolatingBox
from exactfold.solve.certify.float_krawczyk import FloatKrawczyk, FloatSigns

BITS = 44
_PRECISIONS = (64, 128, 256)
_FINER = (*_PRECISIONS, 1024)
_LETTERS = np.array([ord(LETTERS[sign]) for sign in (None, 1, -1)], dtype=np.uint8)
"""By sign: 0 is not proved, and the last is that of -1."""
_OPEN = ord(LETTERS[None])


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
    partners: tuple[tuple[tuple[int, ...], ...], ...] = field(init=False)
    bend: tuple[int, ...] = field(init=False)

    def __post_init__(self) -> None:
        problem, place = self.problem, self.place
        known = {
            "system": problem.system(place),
            "vertices": tuple(tuple(in_chart(r, place)) for r in problem.vertices.values()),
            "folds": tuple(tuple(in_chart(r, place)) for r in problem.folds.values()),
            "partners": tuple(
                tuple(tuple(in_chart(r, place)) for r in rows) for rows in problem.partners.values()
            ),
            "bend": tuple(in_chart(problem.bend, place)),
        }
        for name, value in known.items():
            object.__setattr__(self, name, value)

    def proved(
        self, rows: IndexArray, rays: FloatArray, signs: FloatArray, clock: Clock
    ) -> Iterator[Ray]:
        """The rays that boxes prove to be simple, with these signs and with b other than 0.

        `rays` has shape (m, n + 1), and `rows` are the numbers of its rows. When the time is over,
        no exact tests are begun.
        """
        points = np.delete(rays, self.place, axis=1) / rays[:, self.place, None]
        side = np.sign(rays[:, self.place]).astype(np.int8)
        boxes = FloatKrawczyk(self.system).isolate(points, BITS)
        vertices = FloatSigns(self.vertices).on(boxes) * side[:, None]
        b = FloatSigns((self.bend,)).on(boxes)[:, 0] * side
        good = boxes.proved & (vertices == signs).all(axis=1) & (b != 0)
        letters = _LETTERS[FloatSigns(self.folds).on(boxes) * side[:, None]]
        for k, partners in enumerate(self.partners):
            if not any(self.folds[k]):  # flat in all heights
                letters[:, k] = ord(LETTERS[0])
            elif partners:
                flat = (FloatSigns(partners).on(boxes) != 0).any(axis=1)
                letters[(letters[:, k] == _OPEN) & flat, k] = ord(LETTERS[0])
        names = list(map(tuple, signs.astype(int).tolist()))
        for k, row in enumerate(rows.tolist()):
            if not good[k]:
                if clock.passed:
                    continue
                ray = self._exactly(row, points[k], int(side[k]), names[k])
                if ray is not None:
                    yield self._lettered(ray)
                continue
            root = BoxRoot(boxes.box(k), int(side[k]), self.system)
            text = letters[k].tobytes().decode()
            yield self._lettered(Ray(row, names[k], self.place, root, int(b[k]), text, text))

    def _exactly(
        self, row: int, point: FloatArray, side: int, signs: tuple[int, ...]
    ) -> Ray | None:
        """The same by the exact test, with rising precision."""
        from exactfold.solve.certify.exact_krawczyk import krawczyk  # loads FLINT

        if not np.isfinite(point).all():
            return None
        (box,) = krawczyk(self.system, point[None], precisions=_PRECISIONS)
        root = BoxRoot(box, side, self.system) if isinstance(box, IsolatingBox) else None
        for bits in _FINER:
            if root is None:
                return None
            found = [root.sign(line) for line in self.vertices]
            if any(s is not None and s != e for s, e in zip(found, signs, strict=True)):
                return None
            b = root.sign(self.bend)
            if b and None not in found:
                text = "".join(map(self._letter, map(root.sign, self.folds), self._flat(root)))
                return Ray(row, signs, self.place, root, b, text, text)
            root = root.sharpened(bits)
        return None

    def _flat(self, root: BoxRoot) -> Iterator[bool]:
        """For each fold whether a partner (`PeriodicProblem.partners`) shows that it is flat."""
        return (any(root.sign(line) for line in partners) for partners in self.partners)

    def _letter(self, sign: int | None, flat: bool) -> str:
        return LETTERS[0 if sign is None and flat else sign]

    def _lettered(self, ray: Ray) -> Ray:
        """The ray with letters that its box leaves open, if there are few unknowns."""
        if "U" not in ray.letters or self.problem.size > FEW:
            return ray
        known = zero_in(self.system, ray.root.box)
        if known is None:
            return ray
        exact = AlgebraicRoot(*known, side=ray.root.side)
        letters = [
            LETTERS[exact.sign(line)] if letter == "U" else letter
            for letter, line in zip(ray.letters, self.folds, strict=True)
        ]
        return replace(ray, letters="".join(letters))


def prove_rays(
    problem: PeriodicProblem, rays: FloatArray, signs: FloatArray, clock: Clock
) -> dict[int, Ray]:
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
        for ray in chart.proved(rows, rays[rows], signs[rows], clock):
            found[ray.row] = ray
    return found
