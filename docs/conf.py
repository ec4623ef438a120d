"""How the site is built: `sphinx-build -W -n --keep-going -b html docs site`.

Needs `pip install 'exactfold[docs]'` and no network, and the pages need none to be read: formulas
become MathML, which browsers draw themselves, and the search runs in the page. Pages that follow
from the code (names, commands, schemas) are written into docs/generated first. Notebooks are shown
with the outputs that are stored in them; the tests run them.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx

HERE = Path(__file__).parent
# Sphinx looks for this folder before it is filled.
(HERE / "generated" / "whole").mkdir(parents=True, exist_ok=True)
sys.path.insert(0, str(HERE))

import make_pages  # noqa: E402

import exactfold  # noqa: E402

project = "exactfold"
author = "The exactfold developers"
copyright = f"2026, {author}"
version = release = exactfold.__version__

extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx_copybutton", "sphinx_design"]
exclude_patterns = ["_static", "paper", "pictures"]
myst_enable_extensions = ["dollarmath", "colon_fence", "html_image"]
myst_heading_anchors = 4
nb_execution_mode = "off"
myst_links_external_new_tab = False
nitpicky = True
smartquotes = False  # hyphens and quotes of options can be copied

html_theme = "furo"
html_title = "exactfold"
html_static_path = ["_static"]
html_extra_path = ["generated/whole"]
html_css_files = ["site.css"]
html_search_scorer = str(HERE / "_static" / "scorer.js")
html_math_renderer = "mathml"
html_copy_source = False
html_show_sourcelink = False
html_theme_options = {
    "light_css_variables": {"color-brand-primary": "#0b5c8a", "color-brand-content": "#0b5c8a"},
    "dark_css_variables": {"color-brand-primary": "#6cc0f0", "color-brand-content": "#6cc0f0"},
}

autodoc_member_order = "bysource"
autodoc_typehints_format = "short"
autodoc_preserve_defaults = True
python_use_unqualified_type_names = True
python_display_short_literal_types = True
maximum_signature_line_length = 88
copybutton_prompt_text = r">>> |\.\.\. |\$ "
copybutton_prompt_is_regexp = True


def _mathml(node: nodes.Element, display: str) -> str:
    """A formula as MathML, without spaces round bars, which are norms, and slashes."""
    text = convert(node.astext(), display=display)
    tight = r'<mo\1 lspace="0" rspace="0">\2</mo>'
    return re.sub(r"<mo([^>]*)>(&#x0007C;|\||/|&#x0002F;)</mo>", tight, text)


def _inline(self: Any, node: nodes.Element) -> None:
    """A formula in a line."""
    self.body.append(_mathml(node, "inline"))
    raise nodes.SkipNode


def _block(self: Any, node: nodes.Element) -> None:
    """A formula on its own, in a box that scrolls where the page is narrow."""
    self.body.append(f'<div class="formula">{_mathml(node, "block")}</div>')
    raise nodes.SkipNode


def _formulas(_: Sphinx, __: str, source: list[str]) -> None:
    r"""Formulas in a line as GitHub has them, $`x`$, in the way that MyST reads, $x$."""
    source[0] = re.sub(r"\$`(.+?)`\$", r"$\1$", source[0], flags=re.DOTALL)


def _live(_: Sphinx, page: str, source: list[str]) -> None:
    """Patterns of the gallery that have a page of the viewer lead to it."""
    for name in make_pages.SHOWN_LIVE if page == "gallery" else ():
        link = f'<a class="live" href="live/{name}.html">See it fold in the viewer</a>'
        heading = f"### {name}\n"
        if heading not in source[0]:
            raise LookupError(f"{name} is not in the gallery")
        source[0] = source[0].replace(
            heading, f"{heading}\n```{{raw}} html\n<p>{link}</p>\n```\n", 1
        )


def _docstring(_: Sphinx, __: str, name: str, ___: Any, ____: Any, lines: list[str]) -> None:
    """Docstrings are plain text with code in single backticks, not reStructuredText."""
    text = "\n".join(lines)
    parts = re.split(r"(?m)(^[ \t]*>>>.*\n(?:.*\S.*(?:\n|\Z))*)", f"{text}\n")
    lines[:] = "".join(
        part if part.lstrip().startswith(">>>") else make_pages.escaped(part) for part in parts
    ).splitlines()


def _signature(
    _: Sphinx, __: str, ___: str, ____: Any, _____: Any, given: str | None, returned: str | None
) -> tuple[str | None, str | None]:
    """Types by their short names, and a default that is made anew as an ellipsis."""
    short = re.compile(r"~?\b(?:[a-z_]\w*\.)+(?=[A-Za-z_])")
    if given is not None:
        given = short.sub("", given).replace("~", "").replace("<factory>", "...")
    return given, returned and short.sub("", returned).replace("~", "")


def _options(_: Sphinx, __: str, ___: str, context: dict[str, Any], ____: Any) -> None:
    """Options in code have a class, so that no line ends behind one of their hyphens."""
    found = r'<span class="pre">(--?\w[\w-]*)</span>'
    if "body" in context:
        context["body"] = re.sub(found, r'<span class="pre option">\1</span>', context["body"])


def _write(_: Sphinx) -> None:
    make_pages.write()


def setup(app: Sphinx) -> None:
    """Called by Sphinx."""
    app.add_html_math_renderer("mathml", (_inline, None), (_block, None))
    app.connect("builder-inited", _write, priority=1)
    app.connect("source-read", _formulas)
    app.connect("source-read", _live)
    app.connect("autodoc-process-docstring", _docstring)
    app.connect("autodoc-process-signature", _signature)
    app.connect("missing-reference", make_pages.resolved)
    app.connect("html-page-context", _options)
