"""Every console example in README and docs is run and its output compared."""

import ast
import importlib
import json
import os
import re
import runpy
import shlex
import subprocess
import sys
import tomllib
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from running import run

import exactfold
from exactfold.app.cli import app
from exactfold.app.schemas import DOCUMENTS, schema
from exactfold.app.shell.guard import INTERRUPTED, NO_MEMORY
from exactfold.app.shell.shell import BAD_INPUT, EXIT, INTERNAL, OUTPUT_FAILED, USAGE
from exactfold.pattern.data import EXAMPLES as DATA
from proofs import MODULES
from proofs import __main__ as proofs

ROOT = Path(__file__).parent.parent
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]


GUIDES = [ROOT / "CHANGELOG.md", ROOT / "CONTRIBUTING.md"]


def examples(page: Path) -> list[tuple[str, str]]:
    """(command, expected output) of each `$` line in the page's console blocks."""
    found = []
    for block in re.findall(r"```console\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL):
        for part in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
            command, _, output = part.partition("\n")
            found.append((command, output))
    return found


IN_A_SHELL = "README.md"
"""The page of which all commands are run in a shell, as they are typed."""
QUIET = ("tutorial.md",)
"""Pages of which every command succeeds, and says nothing but how a drawing is read."""


def shows(expected: str, printed: str) -> bool:
    """Whether this is printed, with anything in the place of each `...`."""
    pattern = re.escape(expected.rstrip()).replace(re.escape("..."), r"\S+")
    return re.fullmatch(pattern, printed.rstrip()) is not None


@pytest.mark.parametrize(
    "page",
    [page for page in PAGES if page.name != IN_A_SHELL],
    ids=lambda page: page.name,
)
def test_console_examples_print_what_is_shown(
    page: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")
    for command, expected in examples(page):
        words = shlex.split(command)
        if words[:3] == ["python", "-m", "proofs"]:
            assert proofs.main(words[3:]) == 0
            printed, told = capsys.readouterr()
        else:
            assert words[0] == "exactfold"
            done = run(*words[1:])
            printed, told = done.stdout, done.stderr
            if page.name in QUIET:
                assert done.exit_code == 0, command
                assert [line for line in told.splitlines() if not READ.match(line)] == [], command
        assert shows(expected, printed), f"{command}\n{printed}{told}"


def test_the_paper_is_reproduced_without_gaps() -> None:
    """The page names proofs that there are, and every erratum of the paper."""
    text = (ROOT / "docs" / "reproduce.md").read_text(encoding="utf-8")
    found = re.findall(r"python -m proofs ([a-z_ ]+)[`\n]", text)
    named = {name for names in found for name in names.split()}
    assert len(named) > 15
    assert named <= set(MODULES)
    errata = (ROOT / "docs" / "errata.md").read_text(encoding="utf-8")
    numbers = set(re.findall(r"(?m)^\*\*([IVABCD]+\.\d+)\*\*", errata))
    assert len(numbers) > 20
    assert numbers - set(re.findall(r"\b[IVABCD]+\.\d+\b", text)) == set()


READ = re.compile(
    r"exactfold: read (pinwheel-base|zigzags|miura|sheet\.fold): [0-9]+ lines, exact in Q[,;] "
)
"""What is told of the shipped drawings, and of what `convert` wrote, as they are read."""


def commands(page: Path) -> list[str]:
    """The commands of a page in their order.

    They are `$` lines of console blocks, lines of `sh` blocks, and first cells of tables.
    """
    text = page.read_text(encoding="utf-8")
    found = []
    parts = r"(?ms)^```sh\n(.*?)^```|^\$ ([^\n]*)|^\| `(exactfold [^`]*)` \|"
    for block, typed, cell in re.findall(parts, text):
        lines = block.splitlines() or [typed or cell]
        found += [line for line in lines if line.startswith("exactfold ")]
    return found


OF_EXTRAS = (
    *("cairosvg", "distributed", "ezdxf", "imageio", "imageio_ffmpeg", "matplotlib", "pandas"),
    *("pyarrow", "pyrigi", "pysat", "trimesh"),
)
"""Modules that only extras of exactfold install."""


@pytest.mark.slow
@pytest.mark.parametrize(("name", "number"), [(IN_A_SHELL, 3), ("docs/quickstart.md", 18)])
def test_all_commands_run_as_printed_in_their_order(tmp_path: Path, name: str, number: int) -> None:
    """In an empty directory and a shell that finds `exactfold`, as after the first command.

    No package is found that `pip install .` does not install.
    """
    hidden = tmp_path / "hidden"
    hidden.mkdir()
    (hidden / "sitecustomize.py").write_text(
        f"import sys\nsys.modules.update(dict.fromkeys({OF_EXTRAS!r}))\n"
    )
    program = tmp_path / "bin" / "exactfold"
    program.parent.mkdir()
    program.write_text(f'#!/bin/sh\nexec {sys.executable} -m exactfold "$@"\n')
    program.chmod(0o755)
    place = tmp_path / "empty"
    place.mkdir()
    path = f"{program.parent}{os.pathsep}{os.environ['PATH']}"
    found, shown = commands(ROOT / name), dict(examples(ROOT / name))
    assert len(found) == number
    assert shown.keys() <= set(found)
    for command in found:
        done = subprocess.run(
            command,
            shell=True,
            cwd=place,
            env={
                **os.environ,
                "PYTHONPATH": f"{hidden}{os.pathsep}{ROOT}",
                "PATH": path,
                "COLUMNS": "80",
            },
            capture_output=True,
            text=True,
            check=False,
        )
        told = [line for line in done.stderr.splitlines() if not READ.match(line)]
        assert (done.returncode, told) == (0, []), command
        assert done.stdout or "-o" in command
        if command in shown:
            assert shows(shown[command], done.stdout), f"{command}\n{done.stdout}"


def test_the_first_commands_of_the_readme_leave_exactfold_where_a_shell_finds_it() -> None:
    first = re.findall(
        r"(?m)^python3 -m venv .*$", (ROOT / "README.md").read_text(encoding="utf-8")
    )
    assert len(first) == 2
    assert all(". .venv/bin/activate && pip install" in line for line in first)
    assert first[0].endswith("&& exactfold count pinwheel-base")


def contributing() -> str:
    return (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")


def test_the_rooms_are_the_layers() -> None:
    """The table of CONTRIBUTING.md is the list that import-linter holds the code to."""
    (table,) = re.findall(r"(?m)^\| room \|.*\n(?:\|.*\n)+", contributing())
    rooms = re.findall(r"(?m)^\| `(\w+)` \| .+ \|$", table)
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    contracts = settings["tool"]["importlinter"]["contracts"]
    layers = next(one for one in contracts if one["name"].startswith("Rooms import"))
    apart = next(one for one in contracts if one["name"].startswith("The checker imports"))
    assert [f"exactfold.{room}" for room in rooms] == layers["layers"]
    assert layers["layers"] == apart["forbidden_modules"]


def test_what_the_guide_names_is_there() -> None:
    text = contributing()
    named = re.findall(r"(?<![\w/])(?:exactfold|tests|docs|proofs)(?:/[\w.-]+)+", text)
    linked = re.findall(r"\]\((?!http)([^)#]+)\)", text)
    assert len(named) > 30
    assert [path for path in (*named, *linked) if not (ROOT / path).exists()] == []


def entries() -> list[tuple[str, list[str]]]:
    """(term, names in code) of the glossary."""
    text = (ROOT / "docs" / "glossary.md").read_text(encoding="utf-8")
    joined = re.sub(r"(?<=\S)\n(?=\S)", " ", text)
    found = re.findall(r"(?m)^\*\*(.+?)\*\*(?: \((`[^)]*`)\))?: .+\.$", joined)
    assert len(found) == text.count("\n**")
    return [(term, re.findall(r"`([^`]+)`", names)) for term, names in found]


def test_the_glossary_is_alphabetical_and_linked() -> None:
    terms = [term for term, _ in entries()]
    assert len(terms) > 60
    assert terms == sorted(terms, key=str.lower)
    for page in ("README.md", "CONTRIBUTING.md", "docs/tutorial.md"):
        assert "glossary.md)" in (ROOT / page).read_text(encoding="utf-8"), page


@pytest.mark.parametrize(
    ("word", "page"),
    [("collision", "glossary"), ("animation", "viewer"), ("gif", "viewer"), ("hinge", "glossary")],
)
def test_the_search_finds_words_of_other_people(word: str, page: str) -> None:
    """The search of the site looks for whole words, of code as well."""
    text = (ROOT / "docs" / f"{page}.md").read_text(encoding="utf-8")
    assert word in re.findall(r"\w+", text.lower())


def is_in_the_code(path: str) -> bool:
    """Whether a name of the glossary is public, or a module or its contents in a room."""
    value: object = exactfold
    for part in path.split("."):
        if part in getattr(value, "__dataclass_fields__", {}):
            return path.endswith(f".{part}")
        if not hasattr(value, part):
            try:
                importlib.import_module(f"{getattr(value, '__name__', '')}.{part}")
            except ModuleNotFoundError:
                return False
        value = getattr(value, part)
    return True


@pytest.mark.parametrize("name", sorted({name for _, names in entries() for name in names}))
def test_names_in_the_glossary_are_names_in_the_code(name: str) -> None:
    assert is_in_the_code(name)
    assert not is_in_the_code(f"{name}_of_old")


def test_every_key_of_the_json_is_explained() -> None:
    """By the schema, which is shown on a page of its own, or by the glossary or files.md."""
    pages = [(ROOT / "docs" / page).read_text("utf-8") for page in ("glossary.md", "files.md")]
    words = set(re.findall(r"[a-z_0-9]+", " ".join(re.findall(r"`[^`]+`", "".join(pages)))))
    words |= {term.replace(" ", "_") for term, _ in entries()}
    shown = written_pages()["schemas.md"]
    keys, described = set(), 0
    for name in DOCUMENTS:
        found = schema(name)
        for part in (found, *found.get("$defs", {}).values()):
            for key, value in part.get("properties", {}).items():
                if "description" not in value:
                    keys.add(key)
                elif key not in words:
                    described += 1
                    assert re.search(rf"\| `{key}` \| .+ \| [^ |(]", shown), (name, key)
    assert len(keys) > 60 < described
    assert sorted(keys - words) == []


def test_examples_are_found() -> None:
    assert sum(len(examples(page)) for page in PAGES) >= 4


@cache
def script(name: str) -> dict[str, Any]:
    """The names of a script in docs."""
    return runpy.run_path(str(ROOT / "docs" / f"{name}.py"))


@cache
def written_pages() -> dict[str, str]:
    """The pages that are written with the site."""
    return script("make_pages")["pages"]()


def test_every_public_name_is_shown_once() -> None:
    """In the pages of names: those of the package, and those of every room in the stub."""
    rooms, names, homes = (script("make_pages")[key] for key in ("rooms", "names", "homes"))
    stub = (ROOT / "exactfold" / "__init__.pyi").read_text(encoding="utf-8")
    public = re.findall(r"(?m)^from exactfold import (\w+) as", stub)
    assert sorted({room.split(".")[0] for room in rooms() if room}) == sorted(public)
    shown = homes()
    for room in rooms():
        for name, value in names(room).items():
            places = [home for home, found in shown.items() if found.get(name) is value]
            assert len(places) == 1 or (len(places) > 1 and not callable(value)), name


def test_every_command_and_every_option_is_shown() -> None:
    pages, commands = written_pages(), script("make_pages")["commands"]()
    parts = re.split(r"(?m)^## exactfold ", pages["commands.md"])[1:]
    sections = {part.partition("\n")[0]: part for part in parts}
    assert [*sections] == [*commands]
    assert len(commands) > 10
    for name, command in commands.items():
        flags = {flag for parameter in command.params for flag in parameter.opts if "-" in flag}
        assert {flag for flag in flags if flag not in sections[name]} == set(), name
        assert command.help.split(".")[0] in " ".join(sections[name].split())


def test_every_schema_is_shown() -> None:
    page = written_pages()["schemas.md"]
    assert re.findall(r"(?m)^## (.+)$", page) == [*DOCUMENTS, "Objects inside others"]
    shown = [json.loads(block) for block in re.findall(r"```json\n(.*?)```", page, re.DOTALL)]
    assert shown == [schema(name) for name in DOCUMENTS]


def docstrings() -> dict[str, list[str]]:
    """By module that names pages: docstrings, and strings below lines that define constants."""
    found = {}
    for path in sorted((ROOT / "exactfold").rglob("*.py")):
        text = path.read_text(encoding="utf-8")
        if "docs/" not in text:
            continue
        tree = ast.parse(text)
        strings = [
            node.value.value
            for node in ast.walk(tree)
            if isinstance(node, ast.Expr)
            and isinstance(node.value, ast.Constant)
            and isinstance(node.value.value, str)
        ]
        found[path.relative_to(ROOT).as_posix()] = strings
    return found


LABELLED = {"mathematics", "theorem", "panels", "branch", "conventions"}
"""Pages on which definitions and theorems have labels."""


@pytest.mark.slow
def test_what_docstrings_cite_is_there() -> None:
    """Pages exist; places have a label, or a heading where the page gives no labels."""
    cited, pages = script("make_pages")["cited"], {page.stem for page in PAGES}
    labels, wrong = [], []
    for module, strings in docstrings().items():
        for text in strings:
            parts = [*cited(text), ""]
            for part, after in pairwise(parts):
                if isinstance(part, str):
                    wrong += [(module, name) for name in re.findall(r"docs/[\w-]+\.md", part)]
                    continue
                assert part.page in pages
                if part.label:
                    labels.append(part.label)
                elif part.target and part.page in LABELLED:
                    wrong.append((module, part.text))
                if isinstance(after, str) and re.match(
                    r",\s+(?:\d|[A-Z]|section|statement)|\s+(?:and|to)\s+\d", after
                ):
                    wrong.append((module, f"{part.text}{after[:20]}"))
    assert wrong == []
    assert len(set(labels)) > 25
    there = [
        label
        for page in PAGES
        for label in re.findall(r"(?m)^\(([a-z0-9-]+)\)=$", page.read_text(encoding="utf-8"))
    ]
    assert len(there) == len(set(there))
    assert set(labels) <= set(there)


def test_a_place_that_is_not_there_is_found() -> None:
    cited = script("make_pages")["cited"]
    given = "docs/theorem.md, Key lemma and Theorem 2; docs/theorem.md, Theorem 9; docs/none.md, 1"
    found = [part if isinstance(part, str) else part.target for part in cited(given)]
    assert found == [
        "thm-key-lemma",
        " and ",
        "thm-all-real",
        "; ",
        "",
        ", Theorem 9; docs/none.md, 1",
    ]


def trees(text: str) -> list[str]:
    """The pages that the navigation of a page lists."""
    blocks = re.findall(r"```\{toctree\}\n(.*?)```", text, re.DOTALL)
    lines = [line for block in blocks for line in block.splitlines() if line and line[0] != ":"]
    return [re.sub(r".*<(.*)>$", r"\1", line) for line in lines]


def test_the_navigation_lists_every_page_once() -> None:
    written = written_pages()
    listed = trees((ROOT / "docs" / "index.md").read_text(encoding="utf-8"))
    listed += [f"generated/api/{name}" for name in trees(written["api/index.md"])]
    pages = [page.stem for page in (ROOT / "docs").glob("*.md") if page.stem != "index"]
    pages += [f"notebooks/{page.stem}" for page in (ROOT / "docs" / "notebooks").glob("*.ipynb")]
    pages += [f"generated/{name.removesuffix('.md')}" for name in written]
    assert sorted(listed) == sorted(pages)


def anchors(text: str) -> set[str]:
    """The places that a link into a page can name: its headings."""
    headings = re.findall(r"(?m)^#{1,4} (.+)$", re.sub(r"(?s)```.*?```", "", text))
    plain = [re.sub(r"[^\w\- ]", "", re.sub(r"[`*]", "", found).lower()) for found in headings]
    return {found.strip().replace(" ", "-") for found in plain}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page: Path) -> None:
    """Relative links to files that are there or are written with the site, and their anchors."""
    written = {f"docs/generated/{k}": v for k, v in written_pages().items()}
    text = re.sub(r"(?s)```.*?```|`[^`\n]*`", "", page.read_text(encoding="utf-8"))
    for target in re.findall(r"\]\((?!https?:)([^)\s]+)\)", text):
        path, _, anchor = target.partition("#")
        file = (page.parent / path).resolve() if path else page
        name = file.relative_to(ROOT).as_posix()
        assert name in written or file.exists(), target
        if anchor:
            there = written[name] if name in written else file.read_text(encoding="utf-8")
            assert anchor in anchors(there), target


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_examples_stand_in_fences(page: Path) -> None:
    """Elsewhere a Markdown renderer makes quotations of them."""
    text = page.read_text(encoding="utf-8")
    assert re.findall(r"(?m)^ *>>> .*$", re.sub(r"(?ms)^ *```.*?^ *```$", "", text)) == []


@pytest.mark.parametrize("page", [*PAGES, *GUIDES], ids=lambda page: page.name)
def test_lines_are_not_too_long(page: Path) -> None:
    """Tables, formulas and what commands print may be."""
    text = re.sub(r"(?ms)^ *```.*?^ *```$", "", page.read_text(encoding="utf-8"))
    text = re.sub(r"(?s)\$`.+?`\$", "", text)
    long = [line for line in text.splitlines() if len(line) > 140 and not line.startswith("|")]
    assert long == []


@pytest.mark.parametrize("name", ["two-vertex", "zigzags", "notched", "ring"])
def test_the_gallery_is_up_to_date(name: str) -> None:
    check_gallery(name)


@pytest.mark.slow
def test_all_of_the_gallery_is_up_to_date() -> None:
    gallery = script("make_gallery")
    names = gallery["names"]()
    assert len(names) == len({*names}) > 25
    assert {*DATA} <= {*names}
    page = gallery["PAGE"].read_text(encoding="utf-8")
    sections = [name for name in names if name not in gallery["DEGENERATES"]]
    assert re.findall(r"(?m)^### (.+)$", page) == sections
    cards = [check_gallery(name) for name in names]
    assert page == gallery["page"](cards)
    written = {file for card in cards for file in card.files}
    assert written == {path.name for path in gallery["FOLDER"].iterdir()}


def check_gallery(name: str) -> Any:
    """What the page says of a pattern, and its pictures, are what a count gives."""
    gallery = script("make_gallery")
    card = gallery["card"](name)
    page = gallery["PAGE"].read_text(encoding="utf-8")
    assert card.shown in page
    assert (card.cell in page) == (name not in gallery["DEGENERATES"])
    for file, text in card.files.items():
        assert (gallery["FOLDER"] / file).read_text(encoding="utf-8") == text, file
    return card


@pytest.mark.slow
def test_the_lines_of_the_first_page_make_the_viewer_on_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The page that is written with the site has this name, and these lines write the same."""
    monkeypatch.chdir(tmp_path)
    page = (ROOT / "docs" / "index.md").read_text("utf-8")
    (lines,) = re.findall(r"(?ms)^```python\n(.+?)```$", page)
    exec(lines, {})
    (written,) = tmp_path.iterdir()
    made = script("make_pages")
    assert re.findall(r'<iframe .*src="live/(\S+)"', page) == [written.name]
    assert written.name == f"{made['SHOWN_LIVE'][0]}.html"
    assert written.read_text("utf-8") == exactfold.view(made["SHOWN_LIVE"][0])


@pytest.mark.slow
def test_the_pictures_are_up_to_date() -> None:
    made = script("make_pictures")["pictures"]()
    for name, text in made.items():
        assert (ROOT / "docs" / "pictures" / name).read_text("utf-8") == text, name
    assert {path.name for path in (ROOT / "docs" / "pictures").glob("*.svg")} == {*made}


@pytest.mark.parametrize(
    "name",
    [
        "two-vertex",
        pytest.param("miura", marks=pytest.mark.slow),
        pytest.param("random-8", marks=pytest.mark.slow),
        pytest.param("yoshimura", marks=pytest.mark.slow),
    ],
)
def test_the_commands_of_the_gallery_make_its_pictures(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    page, section = gallery_section(name)
    way = re.search(r"Folded: way (\d+)\.", section)
    lines = re.findall(r"(?ms)^```sh\n(.+?)\n```$", page)[0].splitlines()
    if way is None:
        lines = [lines[0], *re.findall(r"`(exactfold draw NAME -o NAME\.svg)`", page)]
    assert len(lines) == 2 + (way is not None)
    for line in lines:
        words = line.replace("NAME", name).replace("WAY", way[1] if way else "")
        assert run(*shlex.split(words)[1:]).exit_code == 0, line
    drawn = [path.name for path in tmp_path.iterdir()]
    assert len(drawn) == len(lines) - 1
    for file in drawn:
        shown = (ROOT / "docs" / "gallery" / file).read_text("utf-8")
        assert (tmp_path / file).read_text("utf-8") == shown, file


def test_the_commands_of_the_page_on_folding_flat_make_its_pictures(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    page = (ROOT / "docs" / "flat.md").read_text("utf-8")
    lines = re.findall(r"`(exactfold flat \S+ -o \S+\.svg)`", page)
    assert [run(*shlex.split(line)[1:]).exit_code for line in lines] == [0, 1]
    for line in lines:
        file = line.split()[-1]
        assert f"](pictures/{file})" in page
        shown = (ROOT / "docs" / "pictures" / file).read_text("utf-8")
        assert (tmp_path / file).read_text("utf-8") == shown, file


def gallery_section(name: str) -> tuple[str, str]:
    """The page of the gallery, and what it says of this pattern."""
    page = (ROOT / "docs" / "gallery.md").read_text("utf-8")
    return page, page.split(f"\n### {name}\n")[1].split("\n##")[0]


@pytest.mark.parametrize("name", ["hypar-1", "hypar-straight"])
def test_the_python_lines_of_the_gallery_run(name: str) -> None:
    page, section = gallery_section(name)
    (lines,) = re.findall(r"(?ms)^```python\n(.+?)\n```$", page)
    made = re.search(r"`(.+?)`: ", section)
    way = re.search(r"Folded: way (\d+)\.", section)
    number = re.search(r"\*\*(\d+) ways to start folding\*\*", section)
    assert made is not None
    assert way is not None
    assert number is not None
    names: dict[str, Any] = {}
    exec(lines.replace("families.hypar(1)", made[1]).replace("4)", f"{way[1]})"), names)
    assert int(number[1]) == names["found"].distinct
    assert names["motion"].branch in names["found"].branches


def test_the_help_and_the_page_have_the_same_exit_codes() -> None:
    text = (ROOT / "docs" / "files.md").read_text(encoding="utf-8")
    rows = re.findall(r"(?m)^\| (\d+) \| (.+) \|$", text)
    given = re.findall(r"(\d+) ([^;.]+)[;.]", str(app.info.epilog))
    assert [code for code, _ in given] == [code for code, _ in rows]
    assert [code for code, _ in given] == sorted((code for code, _ in given), key=int)
    named = {*EXIT.values(), USAGE, BAD_INPUT, INTERNAL, NO_MEMORY, OUTPUT_FAILED, INTERRUPTED}
    assert {int(code) for code, _ in given} == named


def test_the_page_names_every_kind_of_output() -> None:
    text = (ROOT / "docs" / "files.md").read_text(encoding="utf-8")
    (listed,) = re.findall(r"the JSON Schema of each kind: (.+?)\. ", text.replace("\n", " "))
    assert re.findall(r"`([a-z-]+)`", listed) == list(DOCUMENTS)


def test_every_picture_of_a_page_is_there_and_well_formed() -> None:
    from xml.etree import ElementTree

    found = set()
    for page in (ROOT / "README.md", *(ROOT / "docs").glob("*.md")):
        markdown = page.read_text("utf-8")
        shown = re.findall(r"!\[([^]]*)\]\(([^)]+)\)", markdown)
        shown += [
            (b, a) for a, b in re.findall(r'<img src="(\S+)" alt="(.+?)" width="\d+">', markdown)
        ]
        shown += [(b, a) for a, b in re.findall(r"```\{image\} (\S+)\n:alt: (.+)\n", markdown)]
        for text, name in shown:
            path = (page.parent / name).resolve()
            assert text, f"{page.name}: {name} has no words for those who do not see it"
            found.add(path)
            if path.suffix == ".png":
                assert path.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
                assert path.stat().st_size < 200_000
                continue
            assert ElementTree.parse(path).getroot().tag == "{http://www.w3.org/2000/svg}svg"
    folders = [ROOT / "docs" / folder for folder in ("pictures", "gallery")]
    assert found == {path for folder in folders for path in folder.iterdir()}
