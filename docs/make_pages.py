"""The pages of the site that follow from the code, written into docs/generated as it is built.

Public names by topic, with signatures and examples from their docstrings; every command with its
options; the JSON Schema of all output; the viewer on the first page. `python docs/make_pages.py`
writes them without a site.
"""

from __future__ import annotations

import ast
import importlib
import inspect
import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from pathlib import Path
from types import ModuleType
from typing import Any, Final

import exactfold
from exactfold.app.cli import app
from exactfold.app.schemas import DOCUMENTS, schema

FOLDER: Final = Path(__file__).with_name("generated")
LIVE: Final = FOLDER / "whole" / "live"
"""Pages of the viewer, which the site has as they are."""
SHOWN_LIVE: Final = (
    *("pinwheel-base", "zigzags", "miura", "yoshimura"),
    *("two-vertex", "flat-octahedron", "waterbomb"),
)
"""The patterns of the gallery that have such a page; the first is on the first page."""
TOPICS: Final[Mapping[str, tuple[str, str, tuple[str, ...]]]] = {
    "top": (
        "exactfold: read and the other verbs",
        "`read` opens a drawing. The other verbs take what it returns, or what it takes.",
        ("",),
    ),
    "branches": (
        "branches",
        "What is behind `count` and `branch` for triangulated sheets.",
        ("branches",),
    ),
    "design": (
        "design",
        "Letters, vertices one by one, and the torques that drive a branch.",
        ("design",),
    ),
    "pattern": (
        "pattern",
        "Sheets of triangles and of panels, families of them, and drawings in files.",
        ("pattern", "pattern.families", "pattern.data"),
    ),
    "layers": ("layers", "Flat-folded states: where the paper lies, and its layers.", ("layers",)),
    "panels": ("panels", "All ways in which a sheet of rigid panels folds.", ("panels",)),
    "motion": (
        "motion",
        "Follow a branch in space up to the first contact (collision), and prove the motion.",
        ("motion",),
    ),
    "studies": ("studies", "Seeded ensembles of patterns: rows, tables and figures.", ("studies",)),
    "certificates": ("certificates", "Write a certificate and read it back.", ("certificates",)),
    "checker": ("checker", "Verify a certificate, without the rest of exactfold.", ("checker",)),
    "app": (
        "app",
        "What the command line prints and draws: tables, pictures, animations and the viewer.",
        ("app.report", "app.viewer"),
    ),
    "interop": ("interop", "Sheets and equations for other programs.", ("interop",)),
    "rigidity": (
        "rigidity",
        "Stresses, curvature forms, and the system of equations that is solved.",
        ("rigidity",),
    ),
    "exact": ("exact", "Exact numbers and linear algebra.", ("exact",)),
    "solve": (
        "solve",
        "Solvers propose points; exact tests prove that there is a solution next to them.",
        ("solve",),
    ),
    "errors": ("errors", "What can go wrong.", ("errors",)),
}
"""Pages of public names: the title, a sentence, and the rooms; the empty name is the package."""
FIRST: Final = (
    *("read", "count", "branch", "match", "vertices", "decompose"),
    *("follow", "prove", "loops", "draw", "view", "actuate", "tolerance", "check"),
)
"""What the first page begins with, in the order in which a program uses it."""


def pages() -> dict[str, str]:
    """The text of each page by its path in the folder."""
    found = {f"api/{name}.md": _topic(*topic) for name, topic in TOPICS.items()}
    found["api/index.md"] = _index()
    found["commands.md"] = _commands()
    found["schemas.md"] = _schemas()
    return found


def write() -> None:
    """Write the pages that have changed."""
    for name, content in pages().items():
        path = FOLDER / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if not path.exists() or path.read_text(encoding="utf-8") != content:
            path.write_text(content, encoding="utf-8")
    LIVE.mkdir(parents=True, exist_ok=True)
    for name in SHOWN_LIVE:
        exactfold.view(name, path=LIVE / f"{name}.html")


# Public names


def rooms() -> dict[str, ModuleType]:
    """Every package or module that is public: the package itself, and what it names."""
    found = {"": exactfold}
    for topic in TOPICS.values():
        for room in topic[2]:
            name = f"exactfold.{room}".rstrip(".")
            found[room] = importlib.import_module(name)
    return found


def names(room: str) -> dict[str, Any]:
    """The public names of a room that are no rooms; of one without a list, its own classes."""
    module = rooms()[room]
    listed = getattr(module, "__all__", None)
    if listed is None:
        members = inspect.getmembers(module, lambda x: inspect.isclass(x) or inspect.isfunction(x))
        own = {name: value for name, value in members if value.__module__ == module.__name__}
        return {name: value for name, value in own.items() if not name.startswith("_")}
    values = {name: getattr(module, name) for name in listed}
    return {name: value for name, value in values.items() if not inspect.ismodule(value)}


@cache
def homes() -> dict[str, dict[str, Any]]:
    """By room, the names that are shown there: each name where it is met first."""
    seen: dict[Any, str] = {}
    found: dict[str, dict[str, Any]] = {}
    for topic in TOPICS.values():
        for room in topic[2]:
            found[room] = {}
            for name, value in names(room).items():
                key = value if inspect.isclass(value) or inspect.isroutine(value) else (room, name)
                if seen.setdefault(key, room) == room:
                    found[room][name] = value
    return found


def _index() -> str:
    rows = "\n".join(
        f"| [{title}]({name}.md) | {text} |" for name, (title, text, _) in TOPICS.items()
    )
    entries = "\n".join(TOPICS)
    return (
        "# Public names\n\n"
        "Every public name, one page a room. `help(name)` shows the same text in Python. "
        "Begin with `read`:\n\n"
        "```{eval-rst}\n.. autofunction:: exactfold.read\n   :no-index:\n```\n\n"
        f"| room | what it is for |\n|---|---|\n{rows}\n\n"
        f"```{{toctree}}\n:hidden:\n\n{entries}\n```\n"
    )


def _topic(title: str, sentence: str, listed: tuple[str, ...]) -> str:
    text = f"# {title}\n\n{sentence}\n"
    for room in listed:
        path = f"exactfold.{room}".rstrip(".")
        text += f"\n## `{path}`\n\n"
        if room:
            text += f"{_markdown(_paragraph(rooms()[room]))}\n\n"
        elsewhere = [name for name in names(room) if name not in homes()[room]]
        if elsewhere:
            links = ", ".join(f"{{py:obj}}`{name} <{_shown(room, name)}>`" for name in elsewhere)
            text += f"Shown elsewhere: {links}.\n\n"
        for name, value in sorted(homes()[room].items(), key=_place):
            text += f"```{{eval-rst}}\n{_directive(path, name, value)}```\n\n"
    return text.rstrip() + "\n"


def _place(item: tuple[str, Any]) -> tuple[int, str]:
    """Where a name stands on its page: verbs in the order of their use, others by the alphabet."""
    name, _ = item
    return FIRST.index(name) if name in FIRST else len(FIRST), name.lower()


def _shown(room: str, name: str) -> str:
    value = names(room)[name]
    for home, found in homes().items():
        for other, candidate in found.items():
            if candidate is value:
                return f"exactfold.{home}.{other}".replace("..", ".")
    raise LookupError(f"{room}.{name} is shown nowhere")


def _directive(path: str, name: str, value: Any) -> str:
    if inspect.isclass(value):
        kind = "autoexception" if issubclass(value, BaseException) else "autoclass"
        members = "" if kind == "autoexception" else "   :members:\n"
        return f".. {kind}:: {path}.{name}\n{members}"
    if inspect.isroutine(value):
        return f".. autofunction:: {path}.{name}\n"
    text = "\n".join(f"   {line}" for line in escaped(_comment(path, name)).splitlines())
    shown = "" if len(repr(value)) > 80 else f"   :value: {value!r}\n"
    return f".. py:data:: {path}.{name}\n{shown}\n{text}\n"


def _comment(path: str, name: str) -> str:
    """The string below the line where a constant is defined."""
    place = path
    for node in _lines(_stub(path)):
        if isinstance(node, ast.ImportFrom) and name in {alias.name for alias in node.names}:
            place = node.module or path
    if place != path:
        return _comment(place, name)
    body = list(_lines(importlib.import_module(path).__file__ or ""))
    for node, after in pairwise(body):
        targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
        named = any(isinstance(target, ast.Name) and target.id == name for target in targets)
        if named and isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant):
            return inspect.cleandoc(str(after.value.value))
    return f"Of {path}."


def _stub(path: str) -> str:
    file = Path(importlib.import_module(path).__file__ or "")
    stub = file.with_suffix(".pyi")
    return str(stub if stub.exists() else file)


def _lines(file: str) -> Iterator[ast.stmt]:
    yield from ast.parse(Path(file).read_text(encoding="utf-8")).body


def _paragraph(value: Any) -> str:
    return " ".join((inspect.getdoc(value) or "").split("\n\n")[0].split())


def _markdown(text: str) -> str:
    """Plain text with code in backticks as Markdown, with links where pages are cited."""
    return "".join(
        _plain_markdown(part) if isinstance(part, str) else part.in_markdown()
        for part in cited(text)
    )


def _plain_markdown(text: str) -> str:
    return re.sub(r"([*_<>\[\]$])(?![^`]*`(?:[^`]*`[^`]*`)*[^`]*$)", r"\\\1", text)


def escaped(text: str) -> str:
    """Text of a docstring, which is plain with code in backticks, as reStructuredText.

    >>> escaped("the form `K_v`, at |h| = 1: a_b * c (docs/mathematics.md, Curvature form)")
    'the form ``K_v``, at \\\\|h\\\\| = 1: a\\\\_b \\\\* c
    (:ref:`docs/mathematics.md, Curvature form <def-curvature-form>`)'
    """
    return "".join(
        _plain_rst(part) if isinstance(part, str) else part.in_rst() for part in cited(text)
    )


def _plain_rst(text: str) -> str:
    parts = re.split(r"(`+[^`]+`+)", text)
    return "".join(
        f"``{part.strip('`')}``" if part.startswith("`") else re.sub(r"([\\*|_`])", r"\\\1", part)
        for part in parts
    )


# What docstrings cite


@dataclass(frozen=True)
class Citation:
    """A page that a docstring cites, or a place on it: "docs/mathematics.md, Completeness".

    `target` is the label of the place, "#" and the heading that it is below, or "" for the page.
    """

    text: str
    page: str
    target: str

    @property
    def label(self) -> str:
        """The label, or "" if none leads to the place."""
        return "" if self.target.startswith("#") else self.target

    def in_rst(self) -> str:
        """As reStructuredText, on a page of public names."""
        if self.label:
            return f":ref:`{self.text} <{self.label}>`"
        if self.target:
            return f"`{self.text} <../../{self.page}.html{self.target}>`__"
        return f":doc:`{self.text} </{self.page}>`"

    def in_markdown(self) -> str:
        """As Markdown of Sphinx."""
        if self.label:
            return f"{{ref}}`{self.text} <{self.label}>`"
        return f"{{doc}}`{self.text} </{self.page}>`"


def cited(text: str) -> list[str | Citation]:
    """Text cut at the pages and the places on them that it cites.

    A place is named by its number or by its title: "docs/theorem.md, 3 and Theorem 4" cites two.

    >>> cited("(docs/theorem.md, Key lemma)")[1].target
    'thm-key-lemma'
    """
    found: list[str | Citation] = []
    at = 0
    for page in re.finditer(r"docs/([a-z_-]+)\.md", text):
        if page[1] not in _pages():
            continue
        found.append(text[at : page.start()])
        start, at, first = page.start(), page.end(), True
        while place := re.match(_separated(page[1]), text[at:]):
            name = " ".join(place["name"].split())
            if not first:
                found.append(text[at : at + place.start("name")])
                start = at + place.start("name")
            at += place.end()
            shown = " ".join(text[start:at].split())
            found.append(Citation(shown, page[1], places(page[1])[name]))
            first = False
        if first:
            found.append(Citation(text[start:at], page[1], ""))
    return [part for part in [*found, text[at:]] if part]


@cache
def _pages() -> frozenset[str]:
    return frozenset(path.stem for path in FOLDER.parent.glob("*.md"))


@cache
def _separated(page: str) -> str:
    """A pattern of what goes before the name of a place, and the name."""
    names = sorted(places(page), key=len, reverse=True)
    either = "|".join(re.escape(name).replace(r"\ ", r"\s+") for name in names) or "(?!)"
    return rf"(?:,|,?\s+and|,?\s+to)\s+(?P<name>{either})(?!\w)"


@cache
def places(page: str) -> dict[str, str]:
    """Where the numbers and titles of a page lead: headings, and statements in bold type.

    A line `(label)=` before one of them gives it a label; else the heading above it is named.
    """
    text = (FOLDER.parent / f"{page}.md").read_text(encoding="utf-8")
    found: dict[str, str] = {}
    label = heading = ""
    for line in re.sub(r"(?ms)^ *```.*?^ *```$", "", text).splitlines():
        if given := re.fullmatch(r"\(([a-z0-9-]+)\)=", line):
            label = given[1]
            continue
        if title := re.fullmatch(r"##+ (.+)", line):
            named = title[1]
            heading = f"#{_anchor(named)}"
        elif title := re.match(r"(?:> )?\*\*(.+?)\*\*", line):
            named = title[1]
        else:
            label = label if not line else ""
            continue
        number, _, rest = named.rstrip(".").partition(". ")
        for name in (number, rest) if number.isdigit() else (named.rstrip("."),):
            if name:
                found.setdefault(name, label or heading)
        label = ""
    return found


def _anchor(heading: str) -> str:
    """The name that a heading has in HTML."""
    return re.sub(r"[^a-z0-9]+", "-", heading.lower()).strip("-").lstrip("-0123456789")


def resolved(_: Any, env: Any, node: Any, content: Any) -> Any:
    """Where a type is shown that a signature names by its short name, or by where it is defined.

    Types of other libraries, and those that are not public, stay without a link.
    """
    if node.get("refdomain") != "py" or node.get("reftype") != "class":
        return None
    from sphinx.util.nodes import make_refnode

    target = node["reftarget"].rsplit(".", 1)[-1]
    found = {
        (entry.docname, entry.node_id): name
        for name, entry in env.domaindata["py"]["objects"].items()
        if name.rsplit(".", 1)[-1] == target and not entry.aliased
    }
    if len(found) != 1 or "refdoc" not in node:
        return content
    ((page, place), name) = next(iter(found.items()))
    return make_refnode(env.app.builder, node["refdoc"], page, place, content, name)


# Commands


def commands() -> dict[str, Any]:
    """Every command of the program by its name, in the order of `exactfold --help`."""
    from typer.main import get_command

    group = get_command(app)
    listed = group.list_commands(None)  # type: ignore[attr-defined]
    return {name: group.commands[name] for name in listed}  # type: ignore[attr-defined]


def _commands() -> str:
    text = (
        "# Commands\n\n"
        "What `exactfold COMMAND --help` prints, for every command. Exit codes and files are on "
        "the page [files and exit codes](../files.md).\n"
    )
    for name, command in commands().items():
        context = command.make_context(f"exactfold {name}", [], resilient_parsing=True)
        usage = " ".join(command.collect_usage_pieces(context))
        about = inspect.cleandoc(command.help or "").replace("\f", "")
        text += f"\n## exactfold {name}\n\n```text\nexactfold {name} {usage}\n```\n\n"
        text += f"{_prose(about)}\n\n"
        rows = [
            row for parameter in command.get_params(context) if (row := _row(parameter, context))
        ]
        text += "| option | what it does |\n|---|---|\n" + "".join(rows)
    return text


def _row(parameter: Any, context: Any) -> str:
    if parameter.param_type_name == "argument":
        name = parameter.metavar or parameter.name.upper()
        return f"| `{name}` | {_cell(parameter.help or '')} |\n"
    record = parameter.get_help_record(context)
    if record is None:
        return ""
    flags = record[0].strip().replace("|", "\\|")
    return f"| `{flags}` | {_cell(record[1])} |\n"


def _prose(text: str) -> str:
    return "\n\n".join(_markdown(_coded(part)) for part in text.split("\n\n"))


def _cell(text: str) -> str:
    return _markdown(_coded(text)).replace("|", "\\|")


def _coded(text: str) -> str:
    """The text in one line, with options and JSON in backticks: their quotes stay straight.

    >>> _coded('without --rim the default, else {"5": 1}; `--all` "as drawn"')
    'without `--rim` the default, else `{"5": 1}`; `--all` "as drawn"'
    """
    parts = " ".join(text.split()).split("`")
    for k in range(0, len(parts), 2):
        parts[k] = re.sub(r'(?<![\w-])--[a-z][a-z-]*|\{"[^}]*\}|"\d+/\d+"', r"`\g<0>`", parts[k])
    return "`".join(parts)


# Schemas


INSIDE: Final = "Objects inside others"


def _schemas() -> str:
    text = (
        "# JSON schemas\n\n"
        "The JSON Schema (draft 2020-12) of everything that is printed with `--json`, and of the "
        'lines of `--jsonl`. In Python `exactfold.schema("count")` returns the same. Keys that '
        "need more words, and those that mean the same everywhere, are explained on the page "
        "[files and exit codes](../files.md#json). Types whose names begin with a capital letter "
        f"are [objects inside others](#{INSIDE.lower().replace(' ', '-')}).\n"
    )
    parts: dict[str, dict[str, Any]] = {}
    shown: list[dict[str, Any]] = []
    for name in DOCUMENTS:
        found = schema(name)
        objects = _objects(found)
        parts |= found.get("$defs", {})
        shown += objects
        version = objects[0]["properties"]["version"]["const"]
        text += f"\n## {name}\n\n{found['title']}; version {version}.\n\n{_keys(objects)}"
        text += f":::{{dropdown}} The schema\n```json\n{json.dumps(found, indent=1)}\n```\n:::\n"
    text += f"\n## {INSIDE}\n"
    inside = {name: part for name, part in sorted(parts.items()) if part not in shown}
    for name, part in inside.items():
        text += f"\n### {name}\n\n{_cell(part.get('description', ''))}\n\n{_keys([part])}"
    return re.sub(
        rf"(?<= )({'|'.join(inside)})(?= or | \|)",
        lambda found: f"[{found[0]}](#{found[0].lower()})",
        text,
    )


def _objects(found: Mapping[str, Any]) -> list[dict[str, Any]]:
    """The schemas of the objects of one kind: one, or several of which each object is one."""
    if "properties" in found:
        return [dict(found)]
    return [found["$defs"][part["$ref"].rpartition("/")[2]] for part in found["anyOf"]]


def _keys(objects: list[dict[str, Any]]) -> str:
    """A table of all keys that such objects have."""
    text = "| key | type | what it is |\n|---|---|---|\n"
    for key in dict.fromkeys(key for one in objects for key in one["properties"]):
        values = [one["properties"][key] for one in objects if key in one["properties"]]
        kinds = dict.fromkeys(kind for value in values for kind in _kind(value).split(" or "))
        told = next((value["description"] for value in values if "description" in value), "")
        always = all(key in one["required"] for one in objects)
        text += f"| `{key}` | {' or '.join(kinds)} | {_cell(told)}"
        text += f"{'' if always else ' (may be left out)'} |\n"
    return f"{text}\n"


def _kind(value: Mapping[str, Any]) -> str:
    if "const" in value:
        return f"`{json.dumps(value['const'])}`"
    if "enum" in value:
        return ", ".join(f"`{json.dumps(item)}`" for item in value["enum"])
    if "$ref" in value:
        return str(value["$ref"]).rsplit(":", 1)[-1].rsplit("/", 1)[-1]
    if value.get("type") == "array" and "items" in value:
        return f"list of {_kind(value['items'])}"
    if "type" in value:
        kinds = value["type"] if isinstance(value["type"], list) else [value["type"]]
        return " or ".join(kinds)
    for key in ("anyOf", "oneOf"):
        if key in value:
            return " or ".join(_kind(item) for item in value[key])
    return "any"


if __name__ == "__main__":
    write()
