"""The checker runs alone: as a folder, as a module, as a zipapp, on certificates of every kind."""

from __future__ import annotations

import ast
import json
import shutil
import subprocess
import sys
import zipapp
from pathlib import Path
from typing import Any

import pytest
from compact_files import bodies, chained, put, raw

from exactfold import checker
from exactfold.checker.command import main

PACKAGE = Path(checker.__file__).parent
FIXTURES = Path(__file__).parent.parent / "fixtures" / "certificates"
KINDS = {
    "listing-isolated.json": "VALID: 8 branches (8 with multiplicity, 8 real) of the sheet with 3",
    "algebraic-grid.json": "VALID: 11 branches (16 with multiplicity, 11 real) of the sheet with 4",
    "rigid-nested.json": "VALID: 0 branches (0 with multiplicity, 0 real) of the sheet with 3",
    "single-vertex-nine-folds.json": "VALID: 1 branch (1 with multiplicity, 1 real) of the sheet",
    "compact-blocks-of-4.txt": "VALID: 16 branches (16 with multiplicity, 16 real) of the sheet",
    "panels-bent.json": "VALID: the motions of the sheet of 12 folds and 4 interior vertices have",
    "loops-one-vertex.txt": "VALID: 1 loop of true motions, which match all 4 rays",
    "branch-reflex.json": "VALID: exactly one branch has the vertex signs +0- (3); 10 of 10",
    "assignments-pentagon.json": "VALID: exactly 32 mountain-valley assignments occur with no fold",
    "letters-random.json": "VALID: exactly 2 halves of branches have the 7 letters asked for on 16",
}
WAYS = ("folder", "zipapp", "module")
USAGE = "usage: python exactfold/checker CERTIFICATE [WORKERS]\n"


@pytest.fixture(scope="module")
def copies(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The package copied to a place of its own, as a folder and as a zipapp."""
    place = tmp_path_factory.mktemp("alone")
    shutil.copytree(PACKAGE, place / "judge", ignore=shutil.ignore_patterns("__pycache__"))
    zipapp.create_archive(place / "judge", place / "judge.pyz")
    return {"folder": place / "judge", "zipapp": place / "judge.pyz"}


class Run:
    """One way of running the checker, in a folder that holds nothing but the files to check."""

    def __init__(self, way: str, copies: dict[str, Path], folder: Path) -> None:
        self.folder = folder
        isolated = [sys.executable, "-I", "-S"]
        if way == "module":  # `-I -m` finds the package where a path is given to it only
            root = str(PACKAGE.parent.parent)
            code = f"import runpy, sys; sys.path.insert(0, {root!r}); "
            code += "runpy.run_module('exactfold.checker', run_name='__main__', alter_sys=True)"
            self.command = [*isolated, "-c", code]
        else:
            self.command = [*isolated, str(copies[way])]

    def __call__(self, *arguments: str) -> tuple[int, str, str]:
        done = subprocess.run(
            [*self.command, *arguments],
            cwd=self.folder,
            capture_output=True,
            text=True,
            check=False,
        )
        return done.returncode, done.stdout, done.stderr


@pytest.fixture(params=WAYS)
def run(request: pytest.FixtureRequest, copies: dict[str, Path], tmp_path: Path) -> Run:
    return Run(request.param, copies, tmp_path)


def test_package_is_out_of_reach_of_the_copy(copies: dict[str, Path], tmp_path: Path) -> None:
    run = Run("folder", copies, tmp_path)
    run.command[-1:] = ["-c", "import exactfold"]
    assert "ModuleNotFoundError" in run()[2]


@pytest.mark.parametrize("name", KINDS)
def test_certificates_of_every_kind_are_verified(
    name: str, copies: dict[str, Path], tmp_path: Path
) -> None:
    _verifies(Run("folder", copies, tmp_path), name)


@pytest.mark.parametrize("name", ["listing-isolated.json", "compact-blocks-of-4.txt"])
def test_certificates_are_verified_in_every_way(run: Run, name: str) -> None:
    _verifies(run, name)


def _verifies(run: Run, name: str) -> None:
    shutil.copy(FIXTURES / name, run.folder)
    code, out, err = run(name)
    assert (code, err) == (0, "")
    assert out.startswith(KINDS[name])
    assert out.count("\n") == 1


def test_exit_codes(run: Run) -> None:
    document: dict[str, Any] = json.loads((FIXTURES / "listing-two-vertices.json").read_text())
    document["claims"]["distinct"] = 3
    (run.folder / "false.json").write_text(json.dumps(document))
    (run.folder / "cut.json").write_text(json.dumps(document)[:-5])
    assert run("false.json") == (1, "INVALID: claim distinct = 3, but it is 4\n", "")
    for file in ("cut.json", "none.json"):
        code, out, err = run(file)
        assert (code, out) == (3, "")
        assert err.startswith("not a certificate: ")
    assert run() == (2, "", USAGE)


@pytest.mark.parametrize(
    "arguments",
    [["a", "1", "2"], *(["a", workers] for workers in ("x", "", "-1", "\u0662", "9" * 5000))],
    ids=["three", "letter", "empty", "negative", "Arabic digit", "too many digits"],
)
def test_wrong_usage(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(arguments) == 2
    assert capsys.readouterr() == ("", USAGE)


def test_false_branches_are_refused(run: Run) -> None:
    document: dict[str, Any] = json.loads((FIXTURES / "branch-convex.json").read_text())
    document["claims"]["vertex_signs"][2] *= -1
    (run.folder / "false.json").write_text(json.dumps(document))
    assert run("false.json") == (1, "INVALID: vertex 6 does not have the claimed sign\n", "")


def test_several_processes_are_started_in_every_way(run: Run) -> None:
    shutil.copy(FIXTURES / "compact-blocks-of-4.txt", run.folder / "good.txt")
    assert run("good.txt", "2") == (0, run("good.txt")[1], "")


def test_several_processes_say_the_same(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    written = (FIXTURES / "compact-blocks-of-4.txt").read_bytes()
    lines = bodies(written)
    folds = raw(lines[2], "folds")
    folds[0] ^= 1
    put(lines[2], "folds", folds)
    false = chained(lines)
    rows = false.splitlines(keepends=True)
    both = b"".join([*rows[:3], rows[3][:-9] + b"\n", *rows[4:]])
    # Whichever comes first in the file is what is said, however many look at it.
    for content, code in ((written, 0), (false, 1), (written[:-1], 3), (both, 1)):
        file = tmp_path / "file.txt"
        file.write_bytes(content)
        said = []
        for workers in ("1", "2"):
            assert main([str(file), workers]) == code
            said.append(capsys.readouterr())
        assert said[0] == said[1]


def test_a_pipe_is_read_once(copies: dict[str, Path], tmp_path: Path) -> None:
    run = Run("folder", copies, tmp_path)
    for name in ("compact-blocks-of-4.txt", "listing-isolated.json"):
        with open(FIXTURES / name, "rb") as stream:
            command = [*run.command, "/dev/stdin"]
            done = subprocess.run(
                command, input=stream.read(), cwd=tmp_path, capture_output=True, check=False
            )
        assert (done.returncode, done.stdout[:6], done.stderr) == (0, b"VALID:", b"")


def test_the_module_runs_as_documented(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "exactfold.checker", str(FIXTURES / "branch-dart.json")]
    done = subprocess.run(
        command,
        cwd=tmp_path,
        env={"PYTHONPATH": str(PACKAGE.parent.parent)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("VALID: exactly one branch")


def test_modules_import_the_standard_library_and_each_other_only() -> None:
    modules = sorted(PACKAGE.rglob("*.py"))
    assert len(modules) > 70
    on_the_path = {path.stem for path in PACKAGE.iterdir()}  # the folder stands on the import path
    assert on_the_path & set(sys.stdlib_module_names) == set()
    for path in modules:
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.ImportFrom) and node.level:
                folder = path.parents[node.level - 1]
                assert folder.is_relative_to(PACKAGE)
                home = folder.joinpath(*(node.module or "").split("."))
                inside = [home] if node.module else [home / alias.name for alias in node.names]
                assert all(place.is_dir() or place.with_suffix(".py").exists() for place in inside)
            elif isinstance(node, ast.Import | ast.ImportFrom):
                aliases = [alias.name for alias in node.names]
                found = [node.module or ""] if isinstance(node, ast.ImportFrom) else aliases
                allowed = set(sys.stdlib_module_names)
                if path.stem == "__main__":
                    allowed |= {"exactfold_checker"}
                assert {name.split(".")[0] for name in found} <= allowed


def test_modules_are_small() -> None:
    for path in PACKAGE.rglob("*.py"):
        assert len(path.read_text().splitlines()) <= 300


_SINGLE = ("branches/branch", "branches/branch_proof", "sheets/reduced")


def test_formulas_of_single_branches_are_their_own() -> None:
    """Of the geometry they share the verified sheet, reduced, and what K_v = 0 leaves to folds."""
    found = set()
    for name in _SINGLE:
        for node in ast.walk(ast.parse((PACKAGE / f"{name}.py").read_text())):
            if isinstance(node, ast.ImportFrom) and node.level:
                found |= {(node.module, alias.name) for alias in node.names}
    homes = {(str(module).rpartition(".")[2], name) for module, name in found}
    shared = {pair for pair in homes if pair[0] not in ("reading", "kinds", "branch_proof")}
    assert shared == {
        ("sheet", "Sheet"),
        ("sheet", "Edge"),
        ("sheet", "turn"),
        ("sheet", "read_sheet"),
        ("flat_folds", "close_flat"),
        ("reduced", "check_convex"),
        ("reduced", "closed"),
        ("reduced", "emptied_sheet"),
        ("reduced", "merged_sheet"),
    }
    for name in _SINGLE:
        text = (PACKAGE / f"{name}.py").read_text()
        assert ".curvature(" not in text
        assert ".sign_of_vertex(" not in text


# --- main in this process ------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"\xff\xfe", "codec can't decode"),
        (b"", "not JSON, or cut off"),
        (b"[]", 'no "format" that this checker knows'),
        (b'{"format": "exactfold certificate"}', "version None is not known"),
        (b'{"format": "exactfold branch", "version": 1.0}', "a certificate holds no floats"),
        (b'{"format": "exactfold branch", "version": 4}', "version 4 is not known"),
        (b'{"format": "exactfold compact certificate"}', "line 1 is cut off or was altered"),
    ],
)
def test_main_refuses_other_files(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], content: bytes, message: str
) -> None:
    path = tmp_path / "c.json"
    path.write_bytes(content)
    assert checker.main([str(path)]) == 3
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("not a certificate: ")
    assert message in captured.err


@pytest.mark.parametrize("name", KINDS)
def test_main_prints_the_verdict(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert checker.main([str(FIXTURES / name)]) == 0
    captured = capsys.readouterr()
    assert captured.err == ""
    assert captured.out.startswith(KINDS[name])


def test_main_names_a_folder(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert checker.main([str(tmp_path)]) == 3
    assert "Is a directory" in capsys.readouterr().err
