"""Write docs/reference.md: every public name with the first sentence of its docstring."""

from __future__ import annotations

import inspect
from pathlib import Path

import exactfold

PAGE = Path(__file__).with_name("reference.md")
HEAD = """# Reference

Everything `import exactfold` offers, with the first sentence of its docstring; `help(name)` shows
the rest, with an example that runs. Written by `python docs/make_reference.py`.

| name | what it is |
|---|---|
"""


def reference() -> str:
    """The text of the page."""
    rows = []
    for name in sorted(exactfold.__all__, key=str.lower):
        value = getattr(exactfold, name)
        if callable(value) or inspect.ismodule(value):
            sentence = " ".join((inspect.getdoc(value) or "").split("\n\n")[0].split())
        else:
            sentence = f"`{value!r}`"
        rows.append(f"| `{name}` | {sentence.replace('|', chr(92) + '|')} |\n")
    return HEAD + "".join(rows)


if __name__ == "__main__":
    PAGE.write_text(reference(), encoding="utf-8")
