"""Sheets as DXF drawings, OBJ and STL meshes, and what `convert` and `export` refuse."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh

import exactfold
from exactfold.branches import export_branch
from exactfold.errors import PackageMissingError, UnwritableFileError, UsageError
from exactfold.interop import packages
from exactfold.interop.sheet_files import write_sheet
from exactfold.pattern import PanelPattern
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.opening import panels

BRANCH = exactfold.branch("two-vertex", "+-")


def as_panels(sheet: CreasePattern | PanelPattern) -> PanelPattern:
    return panels(sheet) if isinstance(sheet, CreasePattern) else sheet


@pytest.mark.parametrize("ending", [".dxf", ".obj"])
@pytest.mark.parametrize("name", ["two-vertex", "miura", "square-twist"])
def test_a_drawing_or_polygons_are_read_as_the_same_sheet(
    name: str, ending: str, tmp_path: Path
) -> None:
    opened = exactfold.read(name)
    letters = opened.letters or dict(BRANCH.assignment)
    write_sheet(opened.sheet, letters, tmp_path / f"sheet{ending}")
    back = exactfold.read(tmp_path / f"sheet{ending}")
    sheet, again = as_panels(opened.sheet), as_panels(back.sheet)
    places = {tuple(map(float, point)): v for v, point in enumerate(sheet.vertices)}
    number = [places[x, y] for x, y in np.array(again.vertices, dtype=float).tolist()]
    folds = {tuple(sorted((number[i], number[j]))): back.letters[i, j] for i, j in again.folds}
    assert folds == letters


@pytest.mark.parametrize("ending", [".obj", ".stl"])
def test_meshes_are_flat_or_in_space(ending: str, tmp_path: Path) -> None:
    pattern = BRANCH.pattern
    write_sheet(pattern, {}, tmp_path / f"flat{ending}")
    flat = trimesh.load(tmp_path / f"flat{ending}", process=False)
    assert flat.area == pytest.approx(1)
    assert flat.bounds[:, 2].tolist() == [0, 0]
    export_branch(BRANCH, tmp_path / f"b{ending}")
    mesh = trimesh.load(tmp_path / f"b{ending}", process=False)
    assert len(mesh.faces) == len(pattern.triangles)
    assert mesh.area == pytest.approx(1, rel=1e-2)
    assert np.ptp(mesh.vertices[:, 2]) > 0.05


def test_a_branch_as_a_table_and_as_a_drawing(tmp_path: Path) -> None:
    written = export_branch(BRANCH, tmp_path / "b.csv")
    head, *rows = (tmp_path / "b.csv").read_text().splitlines()
    assert head == "fold,letter,degrees"
    table = [row.split(",") for row in rows]
    assert [(fold, letter) for fold, letter, _ in table] == [
        (f"{i}-{j}", BRANCH.assignment[i, j]) for i, j in BRANCH.pattern.folds
    ]
    assert [float(angle) for *_, angle in table] == [*written.angles.values()]
    export_branch(BRANCH, tmp_path / "b.dxf")
    assert sorted(exactfold.read(tmp_path / "b.dxf").letters.values()) == sorted(
        BRANCH.assignment.values()
    )


def test_other_endings_are_refused(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"a sheet is written as \.dxf, \.obj, \.stl"):
        write_sheet(BRANCH.pattern, {}, tmp_path / "a.ply")
    with pytest.raises(UsageError, match=r"a branch is written as \.fold, \.json, \.dxf"):
        export_branch(BRANCH, tmp_path / "a.pdf")
    with pytest.raises(UnwritableFileError):
        write_sheet(BRANCH.pattern, {}, tmp_path / "no" / "a.obj")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(("ending", "extra"), [(".dxf", "dxf"), (".stl", "meshes")])
def test_without_the_package_the_extra_is_named(
    ending: str, extra: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(packages, "find_spec", lambda name: None)
    with pytest.raises(PackageMissingError, match=rf"pip install 'exactfold\[{extra}\]'"):
        write_sheet(BRANCH.pattern, {}, tmp_path / f"a{ending}")
    assert not list(tmp_path.iterdir())
