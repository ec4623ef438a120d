"""How values show themselves in a notebook: they ask a table that the room `report` fills.

Values lie below the room that draws them and must not know it; so the table, which knows neither,
lies below both. `app.report.notebook` is loaded when a value is first shown.
"""

from __future__ import annotations

TYPE_CHECKING = False  # as in `lazy`: patterns are loaded without it
if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import Any

_FILLED_BY = "exactfold.app.report.notebook"
_TABLE: dict[str, dict[type, Callable[[Any], str | None]]] = {"svg": {}, "html": {}}


def shows(kind: str, *types: type) -> Callable[[Callable[[Any], str | None]], Any]:
    """A decorator: the function shows values of these types as "svg" or "html"."""

    def enter(function: Callable[[Any], str | None]) -> Callable[[Any], str | None]:
        _TABLE[kind].update(dict.fromkeys(types, function))
        return function

    return enter


def shown(value: object, kind: str) -> str | None:
    """A value as "svg" or "html"; None if it is not shown so.

    >>> shown(3, "svg") is None
    True
    """
    from importlib import import_module

    import_module(_FILLED_BY)
    found = (_TABLE[kind].get(base) for base in type(value).__mro__)
    function = next((one for one in found if one is not None), None)
    return None if function is None else function(value)


class Picture:
    """What a notebook shows as a picture."""

    def _repr_svg_(self) -> str | None:
        return shown(self, "svg")


class Page:
    """What a notebook shows as text with pictures."""

    def _repr_html_(self) -> str | None:
        return shown(self, "html")
