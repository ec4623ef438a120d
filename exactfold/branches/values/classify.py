"""What distinguishes the branches: vertex signs and mountain-valley folds, decided exactly."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import TypeVar, cast

from exactfold.branches.values.branch import Branch
from exactfold.branches.values.letters import LETTERS, UPSIDE_DOWN
from exactfold.branches.values.roots import BoxRoot, ChartRoot, FlatBoxRoot
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.rigidity.equations.branch_system import Chart
from exactfold.rigidity.equations.problem import Problem
from exactfold.rigidity.equations.sign_rows import Functionals, Row
from exactfold.rigidity.flat_folds import flat_folds
from exactfold.rigidity.functionals import saddle_functional

K = TypeVar("K")
R = TypeVar("R", bound=ChartRoot)

_RISING = (256, 1024)


@dataclass(frozen=True)
class Undecided:
    """A root for which some vertex signs or folds could not be decided, and which ones."""

    root: ChartRoot
    what: tuple[str, ...]


def classify(
    problem: Problem, chart: Chart, roots: Sequence[tuple[ChartRoot, int]]
) -> tuple[list[Branch], list[Undecided]]:
    """Branches for proved roots in a chart of the problem's sheet, sorted by vertex signs.

    Each root has its multiplicity, and is mirrored if its boundary saddle is negative. If a box
    does not decide a sign, sharper boxes of the same root are tried, and then `flat_folds`. All
    roots with an undecided sign are returned separately. If only folds are undecided, there is a
    branch as well, and these folds have the letter "U".
    """
    functionals, labels = Functionals(chart), problem.labels
    maker = BranchMaker(problem, chart)
    branches, undecided = [], []
    for given, multiplicity in roots:
        root, vertex_signs, fold_signs = _decide(chart, functionals, given)
        still_open = [f"vertex {labels[v]}" for v, s in vertex_signs.items() if s is None]
        still_open += [
            f"fold {labels[i]}-{labels[j]}" for (i, j), s in fold_signs.items() if s is None
        ]
        if still_open:
            undecided.append(Undecided(root, tuple(still_open)))
        signs = [s for s in vertex_signs.values() if s is not None]
        if len(signs) == len(vertex_signs):
            letters = [LETTERS[s] for _, s in sorted(fold_signs.items())]
            branches.append(maker.shown(root, signs, letters, multiplicity))
    branches.sort(key=Branch.sort_key)
    return branches, undecided


@dataclass(frozen=True)
class BranchMaker:
    """Makes the branches of one problem from roots in one chart, with their signs and letters."""

    problem: Problem
    chart: Chart

    def branch(
        self, root: ChartRoot, signs: Sequence[int], letters: str, multiplicity: int = 1
    ) -> Branch:
        """The branch at a root, seen from the side of positive saddle.

        `signs` are in the order of the foldable vertices, and `letters` in that of the folds of the
        sheet.
        """
        root = _with_saddle(root, self._saddle)
        if root.sign(self._saddle) == -1:
            root, signs = root.mirrored(), [-s for s in signs]
            letters = letters.translate(UPSIDE_DOWN)
        return self.shown(root, signs, letters, multiplicity)

    def shown(
        self, root: ChartRoot, signs: Sequence[int], letters: Sequence[str], multiplicity: int
    ) -> Branch:
        """The branch at a root that already has a positive saddle."""
        pattern = self.problem.pattern
        saddle = 1 if self._saddle_is_one or root.sign(self._saddle) else 0
        return Branch(
            pattern,
            self._rigid | dict(zip(self.problem.foldable, signs, strict=True)),
            self._flat | dict(zip(self.folds, letters, strict=True)),
            root,
            multiplicity << pattern.Vt,
            "saddle" if saddle else "notch",
            saddle,
            self._rows,
            () if self._saddle_is_one or not saddle else self._saddle_row,
        )

    @cached_property
    def _saddle(self) -> Row:
        return Functionals(self.chart).saddle

    @cached_property
    def _saddle_is_one(self) -> bool:
        return not any(self._saddle[:-1])

    @cached_property
    def _saddle_row(self) -> tuple[Fraction, ...]:
        return tuple(self.chart.restrict(saddle_functional(self.problem.sheet)))

    @cached_property
    def _rows(self) -> dict[int, tuple[Fraction, ...]]:
        return self.problem.height_rows(self.chart)

    @cached_property
    def _rigid(self) -> dict[int, int]:
        return dict.fromkeys(self.problem.pattern.interior, 0)

    @cached_property
    def _flat(self) -> dict[Edge, str]:
        return dict.fromkeys(self.problem.pattern.folds, "F")

    @cached_property
    def folds(self) -> list[Edge]:
        """The folds of the sheet without rigid parts, in the order of the letters."""
        labels = self.problem.labels
        return [(labels[i], labels[j]) for i, j in sorted(self.problem.sheet.folds)]


def _decide(
    chart: Chart, functionals: Functionals, root: ChartRoot
) -> tuple[ChartRoot, dict[int, int | None], dict[Edge, int | None]]:
    """The result of `decide_signs` at the root or, if its saddle is negative, at its
    mirror image.
    """
    root = _with_saddle(root, functionals.saddle)
    if root.sign(functionals.saddle) == -1:
        root = root.mirrored()
    return decide_signs(chart, functionals, root)


def _with_saddle(root: ChartRoot, saddle: Row) -> ChartRoot:
    """The root, in a sharper box if that decides the sign of the boundary saddle."""
    for bits in _RISING:
        if root.sign(saddle) is None:
            root = _sharpen(root, bits) or root
    return root


def decide_signs(
    chart: Chart, functionals: Functionals, root: R
) -> tuple[R, dict[int, int | None], dict[Edge, int | None]]:
    """The signs of all vertices and folds at a root, and the root, in a sharper box if necessary.

    A sign is None if it is not decided; then a fold may be flat.
    """
    reduced = chart.branch_system.pattern
    vertices = {v: root.sign(row) for v, row in functionals.vertices.items()}
    folds = {fold: root.sign(row) for fold, row in functionals.folds.items()}
    _add_flat(reduced, folds)
    for bits in _RISING:
        done = None not in vertices.values() and None not in folds.values()
        # A fold whose sign is still undecided on a sharp box is most likely flat.
        likely_flat = bits > _RISING[0] and None not in vertices.values()
        sharper = None if done or likely_flat else _sharpen(root, bits)
        if sharper is None:
            break
        root = sharper
        _fill(vertices, functionals.vertices, root)
        _fill(folds, functionals.folds, root)
        _add_flat(reduced, folds)
    return root, vertices, folds


def _add_flat(reduced: CreasePattern, folds: dict[Edge, int | None]) -> None:
    """Enter the folds that are proved flat by the signs of the other folds."""
    if None in folds.values():
        for fold in flat_folds(reduced, folds):
            folds[fold] = 0


def _fill(signs: dict[K, int | None], rows: Mapping[K, Row], root: ChartRoot) -> None:
    for key, sign in signs.items():
        if sign is None:
            signs[key] = root.sign(rows[key])


def _sharpen(root: R, bits: int) -> R | None:
    sharpened = root.sharpened(bits) if isinstance(root, BoxRoot | FlatBoxRoot) else None
    return cast("R | None", sharpened)
