"""Write docs/reference.md: every public name, room by room, with what its docstring says first."""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from pathlib import Path
from types import ModuleType
from typing import Any

import exactfold

PAGE = Path(__file__).with_name("reference.md")
HEAD = """# Reference

All public names, with the first sentence of their docstrings; `help(name)` shows the rest, with an
example that runs. What counting branches takes is in `exactfold` itself; everything else is in its
rooms, which are there after `import exactfold`. Written by `python docs/make_reference.py`.
"""


def reference() -> str:
    """The text of the page."""
    on_top = {name: getattr(exactfold, name) for name in exactfold.__all__}
    rooms = {name: value for name, value in on_top.items() if _is_room(name, value)}
    first = {name: value for name, value in on_top.items() if name not in rooms}
    text = HEAD + "\n## `exactfold`\n\n" + _table(first)
    for room, module in rooms.items():
        names = _names(module)
        others = {name: value for name, value in names.items() if first.get(name) is not value}
        known = ", ".join(f"`{name}`" for name in names if name not in others)
        text += f"\n## `exactfold.{room}`\n\n{_sentence(module)}\n"
        text += f"On top already: {known}.\n" if known else ""
        text += "\n" + _table(others) if others else ""
    return text


def _is_room(name: str, value: Any) -> bool:
    return inspect.ismodule(value) and value.__name__ == f"exactfold.{name}"


def _names(module: ModuleType) -> dict[str, Any]:
    """The public names of a room; of one without a list, its classes."""
    listed = getattr(module, "__all__", None)
    if listed is not None:
        return {name: getattr(module, name) for name in listed}
    found = inspect.getmembers(module, inspect.isclass)
    return {name: value for name, value in found if value.__module__ == module.__name__}


def _table(names: Mapping[str, Any]) -> str:
    rows = [f"| `{name}` | {_sentence(names[name])} |\n" for name in sorted(names, key=str.lower)]
    return "| name | what it is |\n|---|---|\n" + "".join(rows)


def _sentence(value: Any) -> str:
    """The first paragraph of a docstring; of a constant, its value."""
    if callable(value) or inspect.ismodule(value):
        text = " ".join((inspect.getdoc(value) or "").split("\n\n")[0].split())
    else:
        text = f"`{value!r}`"
    return text.replace("|", "\\|")


if __name__ == "__main__":
    PAGE.write_text(reference(), encoding="utf-8")
