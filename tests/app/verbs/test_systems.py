"""`sheet_system` and `certify_points`: equations of every kind of sheet, and proved zeros."""

from __future__ import annotations

import shutil
import subprocess
from fractions import Fraction
from math import prod
from typing import Any

import numpy as np
import pytest
import sympy

import exactfold
from exactfold.app.verbs.systems import PROGRAMS, SheetSystem, certify_points, sheet_system
from exactfold.errors import NotApplicableError, NotCountedError, UsageError
from exactfold.exact.surds import SurdField
from exactfold.panels.vertex.local import local_modes
from exactfold.panels.vertex.stars import stars
from exactfold.pattern.families import single_vertex
from exactfold.pattern.panel_pattern import PanelPattern
from exactfold.solve.certify.box import IsolatingBox


def values(system: SheetSystem, at: dict[str, Any]) -> list[Any]:
    """The polynomials at a point."""
    point = [at[name] for name in system.unknowns]
    return [
        sum((c * prod((point[k] for k in factors), start=Fraction(1)) for c, factors in terms), 0)
        for terms in system.polynomials
    ]


@pytest.mark.parametrize("name", ["two-vertex", "flat-octahedron", "h1-4"])
def test_every_branch_is_a_zero_and_is_certified_again(name: str) -> None:
    system = sheet_system(name)
    count = exactfold.count(name)
    points = [
        [float(branch.heights[int(x[1:])][0]) for x in system.unknowns] for branch in count.branches
    ]
    found = certify_points(system, points)
    assert (len(found.zeros), str(found.complete)) == (2 ** len(system.unknowns), "proved")
    assert all(isinstance(box, IsolatingBox) and box.is_real for box in found.boxes)


def test_given_heights_leave_as_many_equations_as_unknowns() -> None:
    sheet = single_vertex(6)
    heights = {0: 0, 1: 1, 2: 0, 3: 1, 4: 0, 5: Fraction(1, 2)}
    system = sheet_system(sheet, heights)
    forms = sheet_system(sheet)
    assert (system.kind, forms.kind, forms.square) == ("boundary heights", "heights", None)
    found = certify_points(system, [[root] for root in np.roots(coefficients(system))])
    assert str(found.complete) == "proved"
    with pytest.raises(NotApplicableError, match="give boundary heights"):
        certify_points(forms, [])


def coefficients(system: SheetSystem) -> list[int]:
    """The coefficients of x^2, x and 1 of one quadric in one unknown."""
    ((*terms,),) = system.polynomials
    known = {len(factors): c for c, factors in terms}
    return [known.get(k, 0) for k in (2, 1, 0)]


def test_the_form_of_a_sheet_with_six_corners_is_its_curvature() -> None:
    sheet = single_vertex(6)
    system = sheet_system(sheet)
    exact = exactfold.rigidity.curvature_form(sheet, 6)
    at = {name: Fraction(k * k + 1, 7) for k, name in enumerate(system.unknowns)}
    heights = {v: at.get(f"h{v}", Fraction(0)) for v in range(7)}
    (value,) = values(system, at)
    (other,) = values(system, {name: 3 * x for name, x in at.items()})
    assert value * exact(heights) > 0
    assert other == 9 * value


def test_the_modes_of_a_vertex_over_square_roots_are_zeros() -> None:
    root = SurdField(()).adjoined(2).root
    corners = [(3, 0), (2, 2 * root), (-2, 1), (-1, -2)]
    sheet = PanelPattern(
        [*corners, (0, 0)], [(0, 1), (1, 2), (2, 3), (0, 3)] + [(k, 4) for k in range(4)]
    )
    system = sheet_system(sheet)
    assert (system.kind, system.unknowns[-1]) == ("panels", "r1")
    (star,) = stars(sheet).values()
    modes = local_modes(star)
    assert len(modes) == 2
    for mode in modes:
        at: dict[str, Any] = {
            f"w{i}x{j}": w for (i, j), w in zip(mode.folds, mode.values, strict=True)
        }
        field_root = next(
            w.field.number(root) if hasattr(w, "field") else root for w in mode.values
        )
        assert not any(values(system, {**at, "r1": field_root}))
        wrong = dict(at)
        wrong["w0x4"] = wrong["w0x4"] + 1
        assert any(values(system, {**wrong, "r1": field_root}))


@pytest.mark.parametrize("program", PROGRAMS)
@pytest.mark.parametrize("name", ["two-vertex", "waterbomb", "miura"])
def test_every_program_gets_every_unknown(program: str, name: str) -> None:
    system = sheet_system(name)
    text = system.text(program)
    assert all(unknown in text for unknown in system.unknowns)


def test_sympy_reads_its_script() -> None:
    system = sheet_system("two-vertex")
    known: dict[str, Any] = {}
    exec(system.text("sympy"), known)
    at = {known[name]: sympy.Rational(k + 1, 3) for k, name in enumerate(system.unknowns)}
    expected = values(system, {str(name): Fraction(str(x)) for name, x in at.items()})
    assert [Fraction(str(p.subs(at))) for p in known["equations"]] == expected


@pytest.mark.skipif(shutil.which("Singular") is None, reason="Singular is not installed")
@pytest.mark.parametrize(("name", "degree"), [("two-vertex", 4), ("h1-4", 16)])
def test_singular_reads_its_text_and_counts_the_zeros(name: str, degree: int) -> None:
    text = sheet_system(name).text("singular") + "print(vdim(std(I)));\n"
    done = subprocess.run(
        ["Singular", "-q"], input=text, capture_output=True, text=True, check=True
    )
    assert done.stdout.split() == [str(degree)]


def test_sheets_without_a_system() -> None:
    with pytest.raises(NotCountedError, match="three boundary vertices"):
        sheet_system(single_vertex(3))
    with pytest.raises(UsageError, match="triangulated"):
        sheet_system("miura", {0: 1})


def test_points_near_one_zero_count_once_and_far_points_are_not_proved() -> None:
    system = sheet_system("two-vertex")
    found = certify_points(
        system,
        [["0.3383763", "-0.0787291"], ["0.3383764", "-0.0787292"], [5, 5]],  # type: ignore[list-item]
    )
    assert (found.proved, len(found.zeros), found.same) == (2, 1, (0, 0, 2))
    assert str(found.complete) == "undecided"
