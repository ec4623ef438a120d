"""Lets values show themselves in a notebook: they ask a table, which the room `report` fills.

Values lie below the room that draws them, so they must not import it. The table imports neither
and lies below both. `app.report.notebook` is loaded when a value is first shown.
"""

from __future__ import annotations

TYPE_CHECKING = False  # not from typing, as in `lazy`: patterns are loaded without it
if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import Any

_FILLED_BY = "exactfold.app.report.notebook"
_TABLE: dict[str, dict[type, Callable[[Any], str | None]]] = {"svg": {}, "html": {}}


def shows(kind: str, *types: type) -> Callable[[Callable[[Any], str | None]], Any]:
    """A decorator for a function that shows values of these types as "svg" or "html"."""

    def enter(function: Callable[[Any], str | None]) -> Callable[[Any], str | None]:
        _TABLE[kind].update(dict.fromkeys(types, function))
        return function

    return enter


def shown(value: object, kind: str) -> str | None:
    """A value as "svg" or "html"; None if no function shows it like this.

    >>> shown(3, "svg") is None
    True
    """
    from importlib import import_module

    import_module(_FILLED_BY)
    functions = (_TABLE[kind].get(base) for base in type(value).__mro__)
    function = next((one for one in functions if one is not None), None)
    return None if function is None else function(value)


class Picture:
    """A value that a notebook shows as a picture."""

    def _repr_svg_(self) -> str | None:
        return shown(self, "svg")


class Page:
    """A value that a notebook shows as text with pictures."""

    def _repr_html_(self) -> str | None:
        return shown(self, "html")
