"""The public names of exactfold and of its rooms."""

import inspect
from typing import Any

import exactfold


def public() -> dict[str, Any]:
    """Every public name with its value, as in "certify.krawczyk"; those on top without a room."""
    on_top = {name: getattr(exactfold, name) for name in exactfold.__all__}
    rooms = {name: value for name, value in on_top.items() if inspect.ismodule(value)}
    inside = {
        f"{room}.{name}": getattr(module, name)
        for room, module in rooms.items()
        for name in getattr(module, "__all__", ())
    }
    return on_top | inside
