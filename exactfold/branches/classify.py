"""What distinguishes the branches: vertex signs and mountain-valley folds, decided exactly."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TypeVar

from exactfold.branches.branch import Branch
from exactfold.branches.functionals import Functionals, Row
from exactfold.branches.roots import BoxRoot, FlatBoxRoot, Root
from exactfold.certify.box import IsolatingBox
from exactfold.certify.krawczyk import krawczyk_at
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.problem.branch_system import Chart
from exactfold.rigidity.flat_folds import flat_folds

K = TypeVar("K")
R = TypeVar("R", bound=Root)

LETTERS = {1: "V", -1: "M", 0: "F", None: "U"}
"""Letter of a fold by its sign."""

_RISING = (256, 1024)


@dataclass(frozen=True)
class Undecided:
    """A root whose vertex signs or folds could not all be decided, and which."""

    root: Root
    what: tuple[str, ...]


def classify(
    pattern: CreasePattern,
    chart: Chart,
    labels: Sequence[int],
    roots: Sequence[tuple[Root, int]],
) -> tuple[list[Branch], list[Undecided]]:
    """Branches for proved roots of the emptied pattern's chart, sorted by vertex signs.

    `chart` belongs to the emptied pattern, whose vertex k is `labels[k]` of `pattern`; each root
    comes with its multiplicity there and is mirrored if its boundary saddle is negative. A sign
    that a box does not decide is tried on sharper boxes of the same root, then by `flat_folds`. All
    roots with an open sign are returned apart; where only folds are open, there is a branch as
    well, on which these have the letter "U".
    """
    functionals = Functionals(chart)
    height_rows = vertex_height_rows(pattern, functionals, labels)
    branches, undecided = [], []
    for given, multiplicity in roots:
        root, vertex_signs, fold_signs = _decide(chart, functionals, given)
        still_open = [f"vertex {labels[v]}" for v, s in vertex_signs.items() if s is None]
        still_open += [
            f"fold {labels[i]}-{labels[j]}" for (i, j), s in fold_signs.items() if s is None
        ]
        if still_open:
            undecided.append(Undecided(root, tuple(still_open)))
        if None in vertex_signs.values():
            continue
        signs = dict.fromkeys(pattern.interior, 0)
        signs |= {labels[v]: s for v, s in vertex_signs.items() if s is not None}
        letters = dict.fromkeys(pattern.folds, "F")
        letters |= {(labels[i], labels[j]): LETTERS[s] for (i, j), s in fold_signs.items()}
        shown = "saddle" if root.sign(functionals.saddle) else "either"
        weight = multiplicity << pattern.Vt
        branches.append(Branch(signs, letters, weight, root, shown, height_rows))
    branches.sort(key=Branch.sort_key)
    return branches, undecided


def _decide(
    chart: Chart, functionals: Functionals, root: Root
) -> tuple[Root, dict[int, int | None], dict[Edge, int | None]]:
    """`decide_signs` at the root or, if its saddle is negative, at its mirror image."""
    for bits in _RISING:
        if root.sign(functionals.saddle) is None:
            root = _sharpen(chart, root, bits) or root
    if root.sign(functionals.saddle) == -1:
        root = root.mirrored()
    return decide_signs(chart, functionals, root)


def decide_signs(
    chart: Chart, functionals: Functionals, root: R
) -> tuple[R, dict[int, int | None], dict[Edge, int | None]]:
    """The root, on a sharper box if that was needed, and the signs of all vertices and folds there.

    None where a sign is not decided; a fold may then be flat.
    """
    emptied = chart.branch_system.pattern
    vertices = {v: root.sign(row) for v, row in functionals.vertices.items()}
    folds = {fold: root.sign(row) for fold, row in functionals.folds.items()}
    _add_flat(emptied, folds)
    for bits in _RISING:
        done = None not in vertices.values() and None not in folds.values()
        # A fold that is still open on a sharp box is most likely flat.
        likely_flat = bits > _RISING[0] and None not in vertices.values()
        sharper = None if done or likely_flat else _sharpen(chart, root, bits)
        if sharper is None:
            break
        root = sharper
        _fill(vertices, functionals.vertices, root)
        _fill(folds, functionals.folds, root)
        _add_flat(emptied, folds)
    return root, vertices, folds


def _add_flat(emptied: CreasePattern, folds: dict[Edge, int | None]) -> None:
    """Enter the folds that the signs of the others prove to be flat."""
    if None in folds.values():
        for fold in flat_folds(emptied, folds):
            folds[fold] = 0


def _fill(signs: dict[K, int | None], rows: Mapping[K, Row], root: Root) -> None:
    for key, sign in signs.items():
        if sign is None:
            signs[key] = root.sign(rows[key])


def _sharpen(chart: Chart, root: R, bits: int) -> R | None:
    if not isinstance(root, BoxRoot | FlatBoxRoot) or root.box.bits >= bits:
        return None
    system = chart.system if isinstance(root, BoxRoot) else root.sheets.system
    if system is None:
        return None
    sharper = krawczyk_at(system, root.box, bits)
    return replace(root, box=sharper) if isinstance(sharper, IsolatingBox) else None


def vertex_height_rows(
    pattern: CreasePattern, functionals: Functionals, labels: Sequence[int]
) -> dict[int, tuple[Fraction, ...]]:
    """Heights as rows on (x, 1): rigid vertices lie in the plane of their 3-cycle."""
    rows = {labels[v]: row for v, row in functionals.heights.items()}
    for cycle, inside in pattern.triangulated_triangles:
        for v in inside:
            weights = barycentric(pattern, cycle, v)
            rows[v] = tuple(
                sum((w * x for w, x in zip(weights, column, strict=True)), Fraction(0))
                for column in zip(*(rows[c] for c in cycle), strict=True)
            )
    return dict(sorted(rows.items()))


def barycentric(
    pattern: CreasePattern, cycle: Sequence[int], vertex: int
) -> tuple[Fraction, Fraction, Fraction]:
    """Barycentric coordinates of a vertex in a triangle, exactly."""
    (ax, ay), (bx, by), (cx, cy) = (pattern.vertices[v] for v in cycle)
    x, y = pattern.vertices[vertex]
    whole = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    beta = ((x - ax) * (cy - ay) - (y - ay) * (cx - ax)) / whole
    gamma = ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / whole
    return 1 - beta - gamma, beta, gamma
