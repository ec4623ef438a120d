"""All zeros of a branch system, also multiple ones: in classes, in boxes, and on flat sheets.

A class has a squarefree `polynomial` p and `numerators` w_i of lower degree, with coefficients from
the constant term up: x_i = w_i(T) / p'(T), where T is the form `separating` of the x_i. Its list
`flat` has vertices whose quadrics have order 2 there: f of them give each zero the multiplicity
2^f. A root is one of three things:

- a box: `center`, `radius` and `bits`;
- the number of its `class` and an `interval` in which p changes sign, or a rational root twice;
- a box with a list `flat` of vertices, in the unknowns that the equations "all folds at these
  vertices are flat" leave free: those that are no pivots of the reduced echelon form. There the
  quadrics span a space with as many dimensions as there are unknowns, and a basis of it passes
  Krawczyk's test.
"""

from __future__ import annotations

import itertools
from fractions import Fraction
from typing import Any

from ..core.krawczyk import Krawczyk
from ..core.polynomials import are_coprime, count_real_roots
from ..core.reading import integer, items, keys, natural, parse_rational, require
from ..sheets.boxes import Box, Root, check_disjoint, read_box
from ..sheets.equations import BranchSystem
from ..sheets.stress import check_finite
from .classes import AlgebraicRoot, RootClass
from .flat_sheets import FlatBox, FlatSheets


def check_algebraic(system: BranchSystem, evidence: Any) -> tuple[list[tuple[Root, int]], int]:
    """All zeros: a list of (real root, multiplicity), and the number of zeros that are not real.

    A zero might still be listed in two different ways; `check_branches` excludes that.
    """
    keys(evidence, "kind triangles chart multipliers separating classes roots", "evidence")
    check_finite(system.sheet, evidence["multipliers"])
    separating = [integer(s) for s in items(evidence["separating"], "separating")]
    entries = items(evidence["classes"], "classes")
    listed = items(evidence["roots"], "roots")
    require(all(isinstance(entry, dict) for entry in listed), "a root is not an object")
    flat_sets = [
        tuple(items(entry["flat"], "flat vertices")) for entry in listed if "flat" in entry
    ]
    in_boxes = sum("flat" not in entry and "class" not in entry for entry in listed)
    total = in_boxes + sum(1 << min(len(flat), system.size) for flat in flat_sets)
    for entry in entries:  # counted before any arithmetic, so that a small file cannot ask for much
        keys(entry, "polynomial numerators flat", "class")
        degree = len(items(entry["polynomial"], "polynomial")) - 1
        total += degree << min(len(items(entry["flat"], "flat vertices")), system.size)
    require(total == 1 << system.size, f"multiplicities add up to {total}, not 2^{system.size}")
    require(not entries or len(separating) == system.size, "the separating form has a wrong length")
    classes = [RootClass(system, separating, entry) for entry in entries]
    for k, a in enumerate(classes):
        for b in classes[:k]:
            require(are_coprime(a.p, b.p), "two classes share a root")
    sheets = {flat: FlatSheets(system, list(flat)) for flat in dict.fromkeys(flat_sets)}
    roots: list[tuple[Root, int]] = []
    boxes: dict[object, list[Box]] = {}
    intervals: list[list[tuple[Fraction, Fraction]]] = [[] for _ in classes]
    for entry in listed:
        if "flat" in entry:
            flat_box = FlatBox(entry, sheets[tuple(entry["flat"])])
            boxes.setdefault(flat_box.kind, []).append(flat_box.box)
            roots.append((flat_box, flat_box.sheets.multiplicity))
        elif "class" in entry:
            keys(entry, "class interval", "root")
            index = natural(entry["class"], "class")
            require(index < len(classes), f"there is no class {index}")
            low, high = (parse_rational(x) for x in items(entry["interval"], "interval", 2))
            intervals[index].append((low, high))
            roots.append((AlgebraicRoot(classes[index], low, high), classes[index].multiplicity))
        else:
            box = read_box(entry, system.size)
            boxes.setdefault(box.kind, []).append(box)
            roots.append((box, 1))
    for kind, group in boxes.items():
        test = Krawczyk(
            system if kind == "box" else next(s for f, s in sheets.items() if f == kind)
        )
        for box in group:
            test.check(box.center, box.radius, box.bits)
        check_disjoint(group)
    nonreal = 0
    for root_class, ends in zip(classes, intervals, strict=True):
        ends.sort()
        require(
            all(a[1] <= b[0] and a != b for a, b in itertools.pairwise(ends)),
            "two intervals overlap",
        )
        degree = len(root_class.p) - 1
        if len(ends) < degree:
            require(len(ends) == count_real_roots(root_class.p), "a real root is missing")
        nonreal += degree - len(ends)
    return roots, nonreal
