"""The page: one HTML file that contains everything and needs neither a network nor a server."""

from __future__ import annotations

import base64
import colorsys
import hashlib
import html
import json
import re
from collections.abc import Mapping, Sequence
from functools import cache
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from exactfold._support.clock import LIMIT, Clock
from exactfold._support.progress import Progress
from exactfold.app.pictures import crease_style
from exactfold.app.pictures.flat_states import BACK, FRONT, OPAQUE
from exactfold.app.viewer.checking import PageChecker, policy_source
from exactfold.app.viewer.document import FRAMES, ViewDocument, view_document
from exactfold.pattern.loading import PatternLike
from exactfold.pattern.writing.fold_writing import checked_target, write_text

if TYPE_CHECKING:
    from exactfold.branches.values.branch import Branch

_ENDINGS: Final = (".html", ".htm")
_ROOM: Final = Path(__file__).parent
_PAGE: Final = _ROOM / "page"
_LIBRARIES: Final = ("three.bundle.min.js", "gifenc.bundle.min.js")
_IMPORT: Final = re.compile(r'^import \{[^}]*\} from "\./(\w+\.js)";\n', re.MULTILINE)
_EXPORT: Final = re.compile(r"^export (?=async function|function|class|const|let)", re.MULTILINE)
_SELF, _NOBODY = "'self'", "'none'"
_PLACE: Final = re.compile(r"\{\{(\w+)\}\}")
_DARK: Final = {"B": 0.92}
_LIGHTNESS: Final = 0.66
"""The least lightness of a line on dark ground; the boundary is lighter still."""


def view_page(document: Mapping[str, Any], checker: PageChecker | None = None) -> str:
    """The HTML text of the page that shows a `view_document`.

    A content security policy allows its scripts and styles by their digests, and nothing else. So
    no text in a pattern can run as code, and the page sends no requests to any network. With a
    `checker`, the page may load Pyodide from the address that this names, and from no other.

    >>> page = view_page(view_document("single-vertex-4", name="</script>", frames=3))
    >>> page.count("</script>")
    3
    """
    title, served = f"{document['name']} - exactfold", bool(document["served"])
    if checker is None:
        return _page(title, document, served)
    return _page(title, {**document, "checker": checker}, served, policy_source(checker["pyodide"]))


def start_page(name: str, *, begins: bool) -> str:
    """The page of a server: it has no sheet yet, and asks the server for one if `begins`."""
    title = f"{name} - exactfold" if name else "exactfold"
    return _page(title, {"served": True, "begins": begins, "name": name}, served=True)


@cache
def page_policy(*, served: bool, framed: bool = False, python: str = "") -> str:
    """The content security policy of the page: its own scripts and styles, and nothing else.

    With `served`, the page may ask the server that it came from. With `framed`, the policy also
    says that no page may show this one in a frame, which only a header can say. `python` is the
    source of Pyodide (`policy_source`); without it, none may be loaded.
    """
    policy = _policy([_library(), _script()], _style(), served, python)
    return f"{policy}; frame-ancestors 'none'" if framed else policy


def _page(title: str, data: Mapping[str, Any], served: bool, python: str = "") -> str:
    parts = {
        "title": html.escape(title),
        "policy": page_policy(served=served, python=python),
        "style": _style(),
        "data": script_json(data),
        "library": _library(),
        "script": _script(),
    }
    page = (_PAGE / "index.html").read_text(encoding="utf-8")
    return _PLACE.sub(lambda match: parts[match[1]], page)


@cache
def _library() -> str:
    """The libraries of other people that the page uses, as one script."""
    return "\n".join((_ROOM / "vendor" / one).read_text(encoding="utf-8") for one in _LIBRARIES)


@cache
def _style() -> str:
    return look_css() + (_PAGE / "style.css").read_text(encoding="utf-8")


def write_view(
    sheet: PatternLike,
    path: str | PathLike[str],
    *,
    name: str | None = None,
    branches: Sequence[str | Branch] | None = None,
    ways: Sequence[int] | None = None,
    frames: int = FRAMES,
    proving: bool = False,
    flat: bool = True,
    workers: int = 1,
    limit: float | Clock = LIMIT,
    progress: Progress | None = None,
    checker: PageChecker | None = None,
) -> ViewDocument:
    """Write the page of a sheet to a file, and return the document that it shows.

    See `view_document` and, for `checker`, `page_checker`. Raises the errors of `view_document`,
    and `UnwritableFileError`.

    >>> import os, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     document = write_view("single-vertex-4", os.path.join(folder, "cross.html"), frames=3)
    ...     os.listdir(folder), document["answer"][:29]
    (['cross.html'], '2 ways to start folding - PRO')
    """
    document = view_document(
        sheet,
        name=name,
        branches=branches,
        ways=ways,
        frames=frames,
        proving=proving,
        flat=flat,
        workers=workers,
        limit=limit,
        progress=progress,
    )
    write_text(Path(path), view_page(document, checker))
    return document


def checked_page(path: Path) -> str:
    """The ending of the path of a page; raises the errors of `checked_target`."""
    return checked_target(path, _ENDINGS, "a page")


def script_json(value: object) -> str:
    r"""JSON that can stand in a script element, because `<` is written as an escape sequence.

    Otherwise `<` could end the element or open a comment.

    >>> script_json({"name": "</script><!--"})
    '{"name":"\\u003c/script>\\u003c!--"}'
    """
    return json.dumps(value, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")


@cache
def _script() -> str:
    """The modules of the page joined into one; each comes after the modules that it imports."""
    done: list[str] = []
    parts: list[str] = []

    def add(name: str) -> None:
        if name in done:
            return
        done.append(name)
        text = (_PAGE / name).read_text(encoding="utf-8")
        for other in _IMPORT.findall(text):
            add(other)
        parts.append(f"// --- {name} ---\n\n" + _EXPORT.sub("", _IMPORT.sub("", text)).strip())

    add("main.js")
    return '"use strict";\n\n' + look_script() + "\n" + "\n\n".join(parts) + "\n"


def _policy(scripts: Sequence[str], style: str, served: bool, python: str) -> str:
    """A content security policy that allows only these texts, and Pyodide from its source."""
    allowed = " ".join(_digest(text) for text in scripts)
    if python:
        allowed += f" 'wasm-unsafe-eval' {python}"
    asked = " ".join(dict.fromkeys([*([_SELF] if served else []), *([python] if python else [])]))
    return (
        f"default-src 'none'; script-src {allowed}; style-src {_digest(style)}; "
        f"img-src data: blob:; connect-src {asked or _NOBODY}; "
        "base-uri 'none'; form-action 'none'"
    )


def _digest(text: str) -> str:
    digest = base64.b64encode(hashlib.sha256(text.encode("utf-8")).digest()).decode("ascii")
    return f"'sha256-{digest}'"


# --- colours, widths and dashes: those of the pictures ------------------------------------------


def look_css() -> str:
    """The colours of lines by letter as CSS custom properties, lighter on dark ground.

    >>> look_css().split(";")[0]
    ':root { --M: #c8202f'
    """
    light = "; ".join(f"--{letter}: {c}" for letter, c in crease_style.COLOUR.items())
    dark = "; ".join(f"--{letter}: {_dark(letter)}" for letter in crease_style.COLOUR)
    return (
        f":root {{ {light} }}\n@media (prefers-color-scheme: dark) {{\n  :root {{ {dark} }}\n}}\n"
    )


def look_script() -> str:
    """Widths, dashes and colours of lines, and of paper, as a constant in the page's script.

    >>> look_script()[:14]
    'const LOOK = {'
    """
    style = crease_style.Style.of(crease_style.FULL)
    letters = {}
    for letter in crease_style.COLOUR:
        attributes = style.attributes(letter)
        letters[letter] = {
            "width": style.width(letter, None),
            "least": style.width(letter, 0.0),
            "most": style.width(letter, 1.0),
            "dash": list(crease_style.DASH.get(letter, ())),
            "cap": attributes["stroke_linecap"],
            "colour": crease_style.COLOUR[letter],
        }
    look = {
        "letters": letters,
        "full": crease_style.FULL,
        "smallest": crease_style.LEAST,
        "front": FRONT,
        "back": BACK,
        "opaque": OPAQUE,
    }
    return f"const LOOK = {json.dumps(look, separators=(',', ':'))};\n"


def _dark(letter: str) -> str:
    """The colour of a letter on dark ground: the same hue, but light enough to be seen."""
    text = crease_style.COLOUR[letter]
    hue, lightness, saturation = colorsys.rgb_to_hls(
        *(int(text[k : k + 2], 16) / 255 for k in (1, 3, 5))
    )
    lightness = max(lightness, _DARK.get(letter, _LIGHTNESS))
    parts = colorsys.hls_to_rgb(hue, lightness, saturation)
    return "#" + "".join(f"{round(255 * part):02x}" for part in parts)
