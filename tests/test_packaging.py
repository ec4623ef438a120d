"""Files for those who package exactfold say what pyproject.toml says."""

from __future__ import annotations

import json
import re
import runpy
import subprocess
import tomllib
from pathlib import Path
from typing import Any

import pytest
import yaml

import exactfold

ROOT = Path(__file__).parent.parent
PROJECT: dict[str, Any] = tomllib.loads((ROOT / "pyproject.toml").read_text())
META: dict[str, Any] = PROJECT["project"]
PYTHONS = [
    line.rpartition(" ")[2]
    for line in META["classifiers"]
    if re.fullmatch(r"Programming Language :: Python :: 3\.[0-9]+", line)
]


def words(lines: list[str]) -> dict[str, str]:
    """Names of packages in lower case with their bounds."""
    found = {}
    for line in lines:
        match = re.fullmatch(r"([\w.-]+)\s*(.*)", line)
        assert match is not None
        found[match[1].lower()] = match[2]
    return found


# --- the conda recipe ----------------------------------------------------------------------------


@pytest.fixture(scope="module")
def recipe() -> dict[str, Any]:
    text = (ROOT / "packaging" / "recipe.yaml").read_text()
    context = yaml.safe_load(text)["context"]
    for name, value in context.items():
        text = text.replace(f"${{{{ {name} }}}}", value)
    assert set(re.findall(r"\$\{\{ (\w+) \}\}", text)) == {"PYTHON"}
    loaded: dict[str, Any] = yaml.safe_load(text)
    return loaded


def test_the_recipe_is_of_this_version(recipe: dict[str, Any]) -> None:
    assert recipe["package"] == {"name": META["name"], "version": exactfold.__version__}


def test_the_recipe_needs_what_the_package_needs(recipe: dict[str, Any]) -> None:
    run = words(recipe["requirements"]["run"])
    assert run.pop("python") == META["requires-python"]
    assert run == words(META["dependencies"])
    host = words(recipe["requirements"]["host"])
    assert host.pop("python") == META["requires-python"].removeprefix(">=") + ".*"
    assert host.pop("pip") == ""
    assert host == words(PROJECT["build-system"]["requires"])


def test_the_recipe_has_the_same_commands_and_licences(recipe: dict[str, Any]) -> None:
    commands = [f"{name} = {place}" for name, place in META["scripts"].items()]
    assert recipe["build"]["python"]["entry_points"] == commands
    assert recipe["about"]["license"] == META["license"]
    assert recipe["about"]["license_file"] == META["license-files"]
    assert recipe["about"]["summary"] == META["description"]
    assert all((ROOT / name).is_file() for name in META["license-files"])


def test_the_recipe_tests_with_commands_that_run(recipe: dict[str, Any]) -> None:
    _, commands = recipe["tests"]
    for command in commands["script"]:
        program, *arguments = command.split()
        assert program in META["scripts"]
        assert run_here(arguments) == 0


def run_here(arguments: list[str]) -> int:
    from typer.testing import CliRunner

    from exactfold.app.cli import app

    return CliRunner().invoke(app, arguments).exit_code


# --- the container -------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def steps() -> list[tuple[str, str]]:
    """The instructions of the container file with their arguments."""
    lines = (ROOT / "packaging" / "Containerfile").read_text().splitlines()
    return [(x[0], x[2]) for line in lines if line[:1].isalpha() for x in [line.partition(" ")]]


def test_the_container_has_a_python_that_is_supported(steps: list[tuple[str, str]]) -> None:
    images = [text.split()[0] for name, text in steps if name == "FROM"]
    assert len(images) == 2
    for image in images:
        match = re.fullmatch(r"docker\.io/library/python:(3\.[0-9]+)-slim", image)
        assert match is not None
        assert match[1] in PYTHONS


def test_the_container_copies_what_the_wheel_is_built_of(steps: list[tuple[str, str]]) -> None:
    copied = [x for name, text in steps if name == "COPY" for x in text.split()[:-1]]
    here = [name for name in copied if not name.startswith(("/", "--"))]
    assert all((ROOT / name).exists() for name in here)
    needed = {META["readme"], "pyproject.toml", *(n for n in META["license-files"] if "/" not in n)}
    assert set(here) == needed | set(
        PROJECT["tool"]["hatch"]["build"]["targets"]["wheel"]["packages"]
    )


def test_the_container_runs_the_command(steps: list[tuple[str, str]]) -> None:
    given = dict(steps)  # the last of each name
    (program,) = json.loads(given["ENTRYPOINT"])
    assert program in META["scripts"]
    assert run_here(json.loads(given["CMD"])) == 0
    extras = re.search(r"whl\)\[([\w,]+)\]", given["RUN"])
    assert extras is not None
    assert set(extras[1].split(",")) <= set(META["optional-dependencies"])
    assert given["USER"] in given["RUN"]


# --- citation ------------------------------------------------------------------------------------


def test_how_to_cite_a_theorem() -> None:
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    assert citation["version"] == exactfold.__version__
    example = re.search(r'"exactfold ([\d.]+), (Theorem \d+) \((.*?)\)"', citation["message"])
    assert example is not None
    assert example[1] == exactfold.__version__
    assert f"**{example[2]}.**" in (ROOT / example[3]).read_text()
    zenodo = json.loads((ROOT / ".zenodo.json").read_text())
    (article,) = citation["references"]
    assert article["doi"] == zenodo["related_identifiers"][0]["identifier"]
    assert zenodo["license"] == citation["license"] == META["license"]


# --- Pythons and lowest versions -----------------------------------------------------------------


def test_ci_tries_every_python_that_is_named() -> None:
    tried = re.search(r"^pythons=\(([0-9. ]+)\)$", (ROOT / ".ci" / "matrix").read_text(), re.M)
    assert tried is not None
    assert set(PYTHONS) <= set(tried[1].split())
    assert META["requires-python"] == f">={PYTHONS[0]}"
    assert tried[1].split()[0] == PYTHONS[0]


def test_ci_tries_tests_that_exist() -> None:
    part = re.search(r"^part=\((.*?)\)$", (ROOT / ".ci" / "matrix").read_text(), re.M | re.S)
    assert part is not None
    assert all((ROOT / name).exists() for name in part[1].split())
    assert len(part[1].split()) > 5


def test_every_dependency_has_a_lowest_version() -> None:
    for bound in words(META["dependencies"]).values():
        assert re.fullmatch(r">=[0-9][\w.]*", bound)


def test_the_matrix_refuses_what_it_does_not_know(tmp_path: Path) -> None:
    done = subprocess.run(
        ["bash", str(ROOT / ".ci" / "matrix"), "2.7"], capture_output=True, text=True, check=False
    )
    assert done.returncode == 2
    assert done.stderr == "2.7 is none of 3.11 3.12 3.13 3.14 lowest\n"


def test_supported_versions_are_those_of_the_project() -> None:
    """The table in CONTRIBUTING.md has the lowest versions, and every Python that is named."""
    text = (ROOT / "CONTRIBUTING.md").read_text()
    named = re.findall(r"^\| (Python|NumPy|SciPy) ([0-9.]+) \|", text, re.M)
    assert [version for name, version in named if name == "Python"][: len(PYTHONS)] == PYTHONS
    bounds = words(META["dependencies"])
    for package in ("NumPy", "SciPy"):
        lowest = next(version for name, version in named if name == package)
        assert bounds[package.lower()] == f">={lowest}"


# --- the site of each version --------------------------------------------------------------------

PAGE = '<script src="_static/documentation_options.js"></script><body>text</body>'


def made_by_versions(name: str) -> Any:
    return runpy.run_path(str(ROOT / "docs" / "make_versions.py"))[name]


def test_pages_lead_to_the_same_page_of_other_versions(tmp_path: Path) -> None:
    pages = {"1.1": ["index", "deep/new"], "1.0": ["index"], "a-branch": ["index", "deep/new"]}
    for version, names in pages.items():
        for name in names:
            path = tmp_path / version / f"{name}.html"
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(PAGE)
    viewer = tmp_path / "1.1" / "viewer.html"
    viewer.write_text("<body>a viewer</body>")
    made_by_versions("link")(tmp_path, ["1.1", "1.0", "a/branch"])
    assert viewer.read_text() == "<body>a viewer</body>"
    assert 'url=1.1/index.html"' in (tmp_path / "index.html").read_text()
    text = (tmp_path / "1.1" / "deep" / "new.html").read_text()
    assert text.count("Version 1.1; others: ") == 1
    links = re.findall(r'href="([^"]*)"', text)
    assert links == ["../../1.0/index.html", "../../a-branch/deep/new.html"]
    for page in tmp_path.glob("*/*/*.html"):
        for address in re.findall(r'href="([^"]*)"', page.read_text()):
            assert (page.parent / address).is_file()


@pytest.mark.slow
def test_two_commits_have_sites_of_their_own(tmp_path: Path) -> None:
    """In a small repository: each site is built of the code of its commit."""
    pytest.importorskip("sphinx")
    repository, site = tmp_path / "repository", tmp_path / "site"

    def git(*arguments: str) -> None:
        who = ["-c", "user.name=a", "-c", "user.email=a@b"]
        subprocess.run(["git", "-C", str(repository), *who, *arguments], check=True)

    (repository / "docs").mkdir(parents=True)
    git("init", "-q", "-b", "main")
    (repository / "docs" / "conf.py").write_text("import exactfold; project = exactfold.NAME")
    (repository / "docs" / "index.rst").write_text("Page\n====\n")
    for tag in ("v0.9", "v0.10"):
        (repository / "exactfold.py").write_text(f"NAME = 'of {tag}'")
        git("add", ".")
        git("commit", "-q", "-m", tag)
        git("tag", tag)
    made_by_versions("main")([str(site), "--repository", str(repository)])
    assert 'url=v0.10/index.html"' in (site / "index.html").read_text()
    for version, others in {"v0.10": "v0.9", "v0.9": "v0.10"}.items():
        text = (site / version / "index.html").read_text()
        assert f"of {version}" in text
        assert f'<p class="versions">Version {version}; others: ' in text
        assert f'href="../{others}/index.html"' in text
    assert "of v0.10" in (site / "main" / "index.html").read_text()
