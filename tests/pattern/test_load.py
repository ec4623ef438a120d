"""What a public function takes for a pattern."""

import inspect
import json
import os
import tomllib
from importlib.metadata import files, metadata
from pathlib import Path
from types import MappingProxyType

import pytest
import rooms

import exactfold
from exactfold.branches.counting.find import find_branch
from exactfold.branches.counting.ways import count_ways
from exactfold.errors import (
    InputError,
    NotCountedError,
    NotFoldError,
    UnreadableFileError,
    UsageError,
)
from exactfold.pattern.data import BY_OTHERS, DRAWINGS, EXAMPLES, SHEETS, example_path, examples
from exactfold.pattern.families import two_vertex
from exactfold.pattern.fold import load_fold, read_fold
from exactfold.pattern.loading import as_pattern, load, open_sheet
from exactfold.pattern.opening import open_pattern
from exactfold.pattern.writing.fold_writing import write_fold


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_fold(two_vertex(), "sheet.fold")
    return tmp_path


@pytest.mark.parametrize("name", SHEETS)
def test_examples_are_loaded_by_name_from_anywhere(name, here):
    assert load(name) == read_fold(example_path(name))


def test_four_kinds_of_the_same_pattern(here):
    pattern = two_vertex()
    kinds = [pattern, load_fold("sheet.fold"), "sheet.fold", Path("sheet.fold"), "two-vertex"]
    assert [load(kind) for kind in kinds] == [pattern] * 5
    assert as_pattern(pattern) is load(pattern) is pattern


def test_the_name_of_an_example_is_not_a_file(here):
    os.rename("sheet.fold", "waterbomb")
    assert load("waterbomb") == read_fold(example_path("waterbomb"))
    for path in ("./waterbomb", Path("waterbomb"), str(here / "waterbomb")):
        assert load(path) == two_vertex()


@pytest.mark.parametrize("what", ["two_vertex", "sheet", "", "a\0b", "none/sheet.fold", "x" * 5000])
def test_unknown_pattern_error_lists_the_names(what, here):
    with pytest.raises(UnreadableFileError, match="is neither a file nor the name of an") as caught:
        load(what)
    assert str(caught.value).endswith(", ".join(EXAMPLES))
    assert len(str(caught.value)) < 320


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=[pytest.mark.slow] if "bird" in name else [])
        for name in DRAWINGS
        if name != "yoshimura"
    ],
)
def test_a_drawing_is_no_sheet_of_triangles_error(name):
    with pytest.raises(NotCountedError, match=r"`exactfold count` \(`count` in Python\)"):
        load(name)
    assert count_ways(name).status is exactfold.PROVED


def test_a_drawing_of_triangles_is_loaded_by_its_name():
    assert load("yoshimura") == open_pattern(example_path("yoshimura")).sheet


def test_a_path_is_never_the_name_of_an_example(here):
    with pytest.raises(UnreadableFileError, match="cannot read two-vertex: No such file") as caught:
        load(Path("two-vertex"))
    assert type(caught.value) is UnreadableFileError


def test_a_file_that_is_there_is_read_whatever_it_is(here):
    (here / "empty").write_text("")
    with pytest.raises(NotFoldError, match="not JSON at"):
        load("empty")
    with pytest.raises(UnreadableFileError, match="directory"):
        load(".")


@pytest.mark.parametrize("what", [3, None, 0.5, b"sheet.fold", [(0, 0)], object])
def test_anything_else_is_named(what, here):
    with pytest.raises(UsageError, match="is not a pattern: give a pattern, a drawing, FOLD as te"):
        load(what)


def test_fold_is_taken_as_text_and_as_a_dictionary(here):
    text = Path("sheet.fold").read_text()
    document = json.loads(text)
    for given in (text, f"\n {text}", document, MappingProxyType(document)):
        assert open_sheet(given) == open_sheet("sheet.fold")
        assert find_branch(given, "+-") == find_branch(two_vertex(), "+-")


@pytest.mark.parametrize("what", ["{", '{"pattern": 1}', {"pattern": 1}, {}])
def test_what_is_no_fold_document_says_so(what, here):
    with pytest.raises(InputError, match=r"^FOLD text: "):
        open_sheet(what)


def test_a_dictionary_that_is_no_json_is_refused(here):
    with pytest.raises(UsageError, match="the dictionary is not a FOLD document: "):
        open_sheet({"vertices_coords": object()})


TRIANGLES = """1 0 0 4 0
1 4 0 4 4
1 4 4 0 4
1 0 4 0 0
2 0 0 1.5 2
2 4 0 1.5 2
3 4 4 1.5 2
3 0 4 1.5 2"""


def test_drawings_of_triangles_are_loaded_whatever_their_format(here):
    (here / "star.cp").write_text(TRIANGLES)
    pattern = load("star.cp")
    assert (len(pattern.vertices), len(pattern.triangles)) == (5, 4)
    assert find_branch("star.cp", "+").status is exactfold.PROVED
    assert load("star.cp", snap=1).vertices[4] == (2, 2)


def test_what_is_no_sheet_of_triangles_is_refused_by_a_class_of_its_own(here):
    (here / "panels.cp").write_text(TRIANGLES.rpartition("3 0 4")[0])
    for function in (load, exactfold.branches.count_branches):
        with pytest.raises(NotCountedError, match=r"1 panel with more .* \(`count` in "):
            function("panels.cp")
    (here / "root.cp").write_text(TRIANGLES.replace("1.5", "1.41421356237"))
    with pytest.raises(NotCountedError, match=r"lie in Q\(sqrt 2\): `exactfold count`"):
        load("root.cp")


def test_snapping_whatever_is_loaded(here):
    fine = load("two-vertex").snapped(10)[0]
    kinds = ["two-vertex", "sheet.fold", two_vertex(), load_fold("sheet.fold")]
    assert [load(kind, snap=10) for kind in kinds] == [fine] * 4
    assert fine != two_vertex()


TAKES_PATTERN = {
    "rigidity.curvature_form": (4,),
    "rigidity.wheel_stress": (4,),
    "rigidity.stress_form": ({(0, 1): 1},),
    "rigidity.definite_stress": (),
    "rigidity.project": ([(1, 0, 0), (0, 1, 0), (0, 0, 1)],),
    "rigidity.decide_all_branches_real": (),
    "rigidity.pattern_facts": (),
    "rigidity.rigidity_matrix": (),
    "rigidity.self_stresses": (),
    "motion.find_driven": ({(3, 5): 40},),
    "pattern.near_degenerate": (),
    "rigidity.BranchSystem": (),
    "branches.count_branches": (),
    "branches.find_branch": ("+-",),
    "branches.count_shapes": ({4: 1},),
    "design.actuate": ("+-",),
    "design.actuate_all": (),
    "design.designed": (dict.fromkeys([(0, 4), (3, 4), (4, 5)], "M"),),
    "design.match": ("MVVUUUU",),
}

TAKES_PATTERN_ELSEWHERE = {
    "interop.to_coq",
    "interop.to_networkx",
    "interop.to_pyrigi",
    "interop.to_trimesh",
    "design.all_assignments",
    "design.match_panels",
    "design.panel_assignments",
    "design.match_boundary",
    "branches.components_certificate",
    "branches.BranchFinder",
    "branches.find_branches",
    "branches.fold_angles",
    "branches.neighbours",
    "branches.stream_branches",
    "pattern.write_fold",
    "motion.find_loops",
    "branches.find_connected_components",
}


@pytest.mark.parametrize("name", TAKES_PATTERN)
def test_public_functions_take_a_name_or_a_path(name, here):
    function, more = rooms.public()[name], TAKES_PATTERN[name]
    expected = function(two_vertex(), *more)
    assert function("two-vertex", *more) == expected
    assert function(Path("sheet.fold"), *more) == expected
    with pytest.raises(UsageError, match="3 is not a pattern"):
        function(3, *more)


def test_no_public_function_that_takes_a_pattern_is_missing():
    """Results hold a pattern too; they are made by functions, not by callers."""
    made = {
        "branches.Branch",
        "branches.BranchCount",
        "branches.BranchExport",
        "branches.StreamedCount",
        "pattern.FoldFile",
        "pattern.RandomSquare",
        "rigidity.Problem",
        "rigidity.PatternFacts",
        "rigidity.ProjectiveImage",
        "panels.Decomposition",
        "branches.PanelFacts",
        "pattern.Converted",
        "design.Actuation",
        "design.PanelActuation",
        "design.Designed",
        "design.Tolerance",
        "design.AllAssignments",
        "design.Match",
        "layers.FlatStates",
        "design.PanelMatch",
        "design.PanelAssignments",
        "design.BoundaryMatch",
        "branches.ShapeCount",
        "branches.PeriodicCount",
        "branches.DirectionsCount",
        "panels.PanelCell",
        "motion.RollingMotion",
        "motion.Loops",
        "motion.PanelMode",
        "motion.PanelMotion",
        "motion.Track",
    }
    of_panels = {"panels.decompose", "branches.panel_facts", "pattern.triangulating_edges"}
    taking = {
        name
        for name, value in rooms.public().items()
        if "." in name
        and callable(value)
        and not isinstance(value, type(exactfold.Verdict))
        and "pattern" in _parameters(value)
    }
    assert taking - made - of_panels == {*TAKES_PATTERN, *TAKES_PATTERN_ELSEWHERE}


def _parameters(function):
    try:
        return inspect.signature(function).parameters
    except ValueError:
        return {}


def test_every_example_is_described_in_one_line():
    found = examples()
    assert tuple(found) == EXAMPLES
    for name, text in found.items():
        source = example_path(name).read_text()
        if name in DRAWINGS:
            assert f"<desc>{text}</desc>" in source
        else:
            assert text == json.loads(source)["file_description"]
        assert text.endswith(".")
        assert "\n" not in text
        assert 20 < len(text) < 120


@pytest.mark.parametrize("name", BY_OTHERS)
def test_drawings_by_others_name_their_author_and_licence(name):
    file = example_path(name)
    assert "copyright (c) 2018 Amanda Ghassaei, MIT licence" in file.read_text("utf-8")
    assert f"`{file.name}`" in file.with_name("README.md").read_text("utf-8")
    licence = file.with_name("LICENSE")
    if not licence.exists():  # a wheel has it among its metadata
        stored = "exactfold/pattern/data/origami-simulator/LICENSE"
        licence = next(x.locate() for x in files("exactfold") or [] if str(x).endswith(stored))
    text = Path(licence).read_text("utf-8")
    assert text.startswith("MIT License\n\nCopyright (c) 2018 Amanda Ghassaei\n")


def test_all_licences_are_in_the_wheel():
    root = Path(__file__).parents[2]
    named = tomllib.loads((root / "pyproject.toml").read_text("utf-8"))["project"]["license-files"]
    if not (root / "exactfold").exists():  # tests beside a wheel
        kept = metadata("exactfold").get_all("License-File")
        assert kept is not None
        assert set(kept) == set(named)
        return
    assert all((root / path).is_file() for path in named)
    assert set(named) == {
        path.relative_to(root).as_posix()
        for path in (root / "LICENSE", *(root / "exactfold").rglob("LICENSE"))
    }


DESCRIBED = {
    "two-vertex": "four ways",
    "single-vertex-4": "two ways",
    "flat-vertex": "three branches",
    "hypar-2": "256 branches",
    "random-8": "256 branches",
}
NUMBERS = {"two": 2, "three": 3, "four": 4, "256": 256}


@pytest.mark.parametrize("name", DESCRIBED)
def test_counts_in_descriptions_are_right(name):
    assert DESCRIBED[name] in examples()[name]
    count = exactfold.branches.count_branches(load(name)).distinct
    assert count == NUMBERS[DESCRIBED[name].split()[0]]
