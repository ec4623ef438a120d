"""The package as a whole."""

import importlib
import importlib.metadata
import inspect
import pkgutil
import subprocess
import sys
from pathlib import Path

import pytest
import rooms

import exactfold

VERBS = {
    "actuate",
    "branch",
    "check",
    "count",
    "decompose",
    "draw",
    "flat",
    "follow",
    "loops",
    "match",
    "prove",
    "read",
    "tolerance",
    "vertices",
    "view",
}


def test_the_version_is_that_of_the_installed_package():
    assert exactfold.__version__ == importlib.metadata.version("exactfold")


def test_every_public_name_is_there():
    found = rooms.public()
    assert all(value is not None for value in found.values())
    assert set(exactfold.__all__) <= set(dir(exactfold))
    assert len(found) > 100


def test_few_names_are_on_top_and_all_of_them_are_in_a_room():
    found = rooms.public()
    modules = {name for name, value in found.items() if inspect.ismodule(value)}
    on_top = {name for name in found if "." not in name} - modules
    assert 20 < len(on_top) <= 39
    inside = {id(value) for name, value in found.items() if "." in name}
    alone = {name for name in on_top if id(found[name]) not in inside}
    verdicts = {"PROVED", "REFUTED", "UNDECIDED", "Verdict"}
    others = {"Checked", "ExactfoldError", "InputError", "Result", "schema"}
    assert alone == verdicts | VERBS | others


def test_no_room_has_the_name_of_a_verb():
    folder = Path(exactfold.__file__).parent
    on_top = {path.stem for path in folder.iterdir()}
    assert {"branches", "checker", "errors"} <= on_top
    assert on_top & VERBS == set()


def test_the_help_names_every_verb_in_one_line():
    lines = [line.split() for line in exactfold.__doc__.splitlines() if line.startswith("    ")]
    assert {words[0] for words in lines} == VERBS
    assert len(lines) == len(VERBS)


def test_a_module_hides_no_public_name_of_its_room():
    """Importing `room/name.py` would put the module in place of the function of that name."""
    for name, value in rooms.public().items():
        room, _, last = name.rpartition(".")
        file = Path(exactfold.__file__).parent.joinpath(*room.split("."), f"{last}.py")
        assert inspect.ismodule(value) or not file.exists(), name


def test_stubs_and_rooms_have_the_same_names():
    folder = Path(exactfold.__file__).parent
    for stub in folder.rglob("__init__.pyi"):
        package = ".".join(("exactfold", *stub.parent.relative_to(folder).parts))
        names: dict[str, object] = {}
        exec(stub.read_text("utf-8").replace("__version__: str", ""), names)
        names.pop("__builtins__")
        module = importlib.import_module(package)
        assert module.__all__ == sorted(names)
        assert all(getattr(module, name) is value for name, value in names.items())


@pytest.mark.parametrize(
    ("name", "home"),
    [
        ("groebner", "exactfold.solve.groebner"),
        ("example_path", "exactfold.pattern.example_path"),
        ("degenerate", "exactfold.pattern.degenerate"),
        ("verify", "exactfold.checker.verify"),
        ("UsageError", "exactfold.errors.UsageError"),
    ],
)
def test_a_name_that_is_not_on_top_is_said_to_be_elsewhere(name, home):
    with pytest.raises(AttributeError) as caught:
        getattr(exactfold, name)
    assert str(caught.value) == f"module 'exactfold' has no attribute {name!r}: it is {home}"


@pytest.mark.parametrize("package", ["exactfold", "exactfold.solve"])
@pytest.mark.parametrize("name", ["brunch", "_hidden"])
def test_a_name_that_is_nowhere_is_missing(package, name):
    with pytest.raises(AttributeError) as caught:
        getattr(importlib.import_module(package), name)
    assert str(caught.value) == f"module {package!r} has no attribute {name!r}"


def test_every_module_is_imported():
    """On each Python, and with each set of packages that is supported (`.ci/matrix`)."""
    found = {module.name for module in pkgutil.walk_packages(exactfold.__path__, "exactfold.")}
    assert {"exactfold.checker.command", "exactfold.app.cli", "exactfold.errors"} <= found
    assert len(found) > 800
    for name in found:
        if not name.endswith("__main__"):
            importlib.import_module(name)


def test_rooms_need_not_be_imported():
    script = (
        "import exactfold, sys\n"
        "assert not [name for name in sys.modules if name.startswith('exactfold.solve')]\n"
        "assert 'numpy' not in sys.modules\n"
        "print(exactfold.solve.krawczyk.__name__, exactfold.pattern.families.two_vertex().Vi)"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=False
    )
    assert (done.stdout, done.stderr) == ("krawczyk 2\n", "")
