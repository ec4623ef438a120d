"""Zeros listed in more than one way, and classes stretched to say more than they prove."""

from __future__ import annotations

import copy
import json
from fractions import Fraction
from functools import cache
from typing import Any

import pytest
from old_listing import old_listing

from exactfold import checker
from exactfold.branches import count_branches
from exactfold.branches.counting import multiple_roots
from exactfold.checker.branches import listing
from exactfold.checker.sheets.equations import BranchSystem
from exactfold.checker.sheets.sheet import read_sheet
from exactfold.pattern.degenerate import DEGENERATE


@cache
def _text(name: str, method: str) -> str:
    return json.dumps(old_listing(count_branches(DEGENERATE[name](), method=method)))


def document(name: str, method: str = "auto") -> dict[str, Any]:
    """A fresh copy of an algebraic certificate."""
    loaded: dict[str, Any] = json.loads(_text(name, method))
    assert loaded["evidence"]["kind"] == "algebraic"
    return loaded


def refuse(forged: dict[str, Any], message: str | None = None) -> None:
    """The checker says no, and says it as a checker does."""
    with pytest.raises(checker.CertificateError, match=message):
        checker.check(checker.load(json.dumps(forged)))


def product(p: list[Fraction], q: list[Fraction]) -> list[Fraction]:
    result = [Fraction(0)] * (len(p) + len(q) - 1)
    for i, a in enumerate(p):
        for j, b in enumerate(q):
            result[i + j] += a * b
    return result


def merged(given: dict[str, Any], first: int, second: int) -> dict[str, Any]:
    """Two classes as one with a reducible polynomial; the vertices flat on the first stay flat."""
    made = copy.deepcopy(given)
    evidence = made["evidence"]
    a, b = (evidence["classes"][k] for k in (first, second))
    p, q = ([Fraction(c) for c in entry["polynomial"]] for entry in (a, b))
    numerators = []
    for v, w in zip(a["numerators"], b["numerators"], strict=True):
        terms = [Fraction(0)] * (len(p) + len(q) - 2)
        for factor, other in ((v, q), (w, p)):
            for k, c in enumerate(product([Fraction(x) for x in factor] or [Fraction(0)], other)):
                terms[k] += c
        numerators.append([str(c) for c in terms])
    evidence["classes"][first] = {
        "polynomial": [str(c) for c in product(p, q)],
        "numerators": numerators,
        "flat": a["flat"],
    }
    del evidence["classes"][second]
    for root in evidence["roots"]:
        if root.get("class") == second:
            root["class"] = first
        if root.get("class", -1) > second:
            root["class"] -= 1
    return made


def test_reducible_class_proves_the_same_where_the_same_vertices_are_flat():
    given = document("ring")
    flat = [entry["flat"] for entry in given["evidence"]["classes"]]
    assert flat == [[8], [8], [8]]
    assert checker.check(merged(given, 0, 2)) == given["claims"]


def test_reducible_class_cannot_lend_flat_vertices_to_other_zeros():
    given = document("grid", "groebner")
    flat = [entry["flat"] for entry in given["evidence"]["classes"]]
    assert sorted(flat) == [[], [5, 6], [6]]
    for first in range(3):
        for second in range(3):
            if first != second:
                forged = merged(given, first, second)
                refuse(forged, None if flat[first] else "multiplicities add up to")
                forged["claims"]["distinct"] = 16
                refuse(forged)


def test_numerators_of_high_degree_are_refused():
    """They would say the same modulo the polynomial, but could cost as much as one likes."""
    forged = document("bent-off-path")
    entry = forged["evidence"]["classes"][0]
    p = [Fraction(c) for c in entry["polynomial"]]
    longer = product(p, [Fraction(1)] * 5)
    longer[0] += Fraction(entry["numerators"][0][0])
    entry["numerators"][0] = [str(c) for c in longer]
    refuse(forged, "too high a degree")


def test_zero_in_a_class_and_on_flat_sheets_is_counted_once(monkeypatch):
    """Simple zeros are left out in favour of a second listing of a multiple one."""
    given = document("grid")
    monkeypatch.setattr(multiple_roots, "GROEBNER_LIMIT", 0)
    other = json.loads(json.dumps(old_listing(count_branches(DEGENERATE["grid"]()))))
    assert checker.check(other) == checker.check(given)
    listed = other["evidence"]["roots"]
    places = [k for k, root in enumerate(listed) if "flat" in root]
    assert [listed[k]["flat"] for k in places] == [[6], [6]]
    for place in places:
        forged = copy.deepcopy(given)
        roots, branches = forged["evidence"]["roots"], forged["claims"]["branches"]
        simple = [k for k, root in enumerate(roots) if "bits" in root]
        for k in reversed(simple[:2]):
            del roots[k], branches[k]
        roots.append(listed[place])
        branches.append(other["claims"]["branches"][place])
        forged["claims"]["distinct"] -= 1
        forged["claims"]["real"] -= 1
        refuse(forged, "counted twice")


def test_real_zeros_cannot_pass_for_others():
    """A dropped interval leaves a zero that Sturm's sequence finds real."""
    forged = document("ring")
    roots, branches = forged["evidence"]["roots"], forged["claims"]["branches"]
    place = next(k for k, root in enumerate(roots) if "class" in root)
    del roots[place], branches[place]
    forged["claims"]["real"] -= 1
    forged["claims"]["nonreal"] += 1
    refuse(forged, "a real root is missing")


def test_finiteness_needs_positive_multipliers_for_every_vertex():
    for change in ("0", "-1"):
        forged = document("bent-off-path")
        forged["evidence"]["multipliers"][1] = change
        refuse(forged, "multiplier")
    forged = document("bent-off-path")
    del forged["evidence"]["multipliers"][1]
    refuse(forged, "multipliers does not have 3 entries")


def test_zeros_listed_in_two_ways_are_not_told_apart_by_an_open_fold(monkeypatch):
    """A zero in a class, with a fold that is flat, and once more in a box that leaves it open."""
    monkeypatch.setattr(listing, "close_flat", lambda sheet, signs: None)
    sheet, _ = read_sheet(old_listing(count_branches(DEGENERATE["cross"]()))["pattern"])
    system = BranchSystem(sheet, None)
    rows = [system.row(sheet.bend(f)) for f in sheet.folds]

    class Shown:
        def __init__(self, kind, first_fold):
            self.kind, self.first_fold = kind, first_fold

        def sign(self, row):
            return self.first_fold if row == rows[0] else 1

    def claim(*roots):
        branches = [
            {
                "vertex_signs": "+",
                "assignment": "".join({0: "F", 1: "V", None: "U"}[r.sign(row)] for row in rows),
                "multiplicity": 1,
                "representative": "saddle",
            }
            for r in roots
        ]
        listing.check_branches(sheet, system, [(r, 1) for r in roots], branches)

    claim(Shown("box", 1), Shown("class", 0))
    claim(Shown("box", None), Shown("box", 1))  # boxes are compared elsewhere
    with pytest.raises(checker.CertificateError, match="counted twice"):
        claim(Shown("box", None), Shown("class", 0))
