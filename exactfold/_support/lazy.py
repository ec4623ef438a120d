"""Imports the public names of a package only when they are first used, as few programs need all."""

from __future__ import annotations

import sys
from functools import cache

TYPE_CHECKING = False  # not from typing, which takes longer to load than all imports here
if TYPE_CHECKING:
    from collections.abc import Callable

# All other modules are imported when a name is asked for, so that the command line starts faster.


def attached(package: str) -> tuple[Callable[[str], object], Callable[[], list[str]]]:
    """`__getattr__` and `__dir__` of a package whose public names are listed in `__init__.pyi`.

    This stub, which type checkers read, is the only list. Each `from home import name as name` in
    it is a public name, and `__all__` contains all of them. `from package import name as name` is a
    module of the package itself. If a name is missing, the error says which of these modules has
    it.

    >>> import exactfold
    >>> exactfold.as_rational
    Traceback (most recent call last):
    AttributeError: module 'exactfold' has no attribute 'as_rational': it is
    exactfold.exact.as_rational
    """

    @cache
    def homes() -> dict[str, str]:
        import ast
        import pkgutil

        stub = pkgutil.get_data(package, "__init__.pyi")
        if stub is None:
            raise ImportError(f"the file __init__.pyi of {package} is missing", name=package)
        return {
            alias.name: node.module
            for node in ast.parse(stub).body
            if isinstance(node, ast.ImportFrom) and node.module
            for alias in node.names
        }

    def get(name: str) -> object:
        from importlib import import_module

        value: object
        if name == "__all__":
            value = sorted(homes())
        elif name not in homes():
            raise AttributeError(_missing(package, name, homes()), name=name, obj=module)
        elif homes()[name] == package:
            value = import_module(f"{package}.{name}")
        else:
            value = getattr(import_module(homes()[name]), name)
        setattr(module, name, value)
        return value

    def names() -> list[str]:
        return sorted({*vars(module), *homes()})

    module = sys.modules[package]
    return get, names


def _missing(package: str, name: str, homes: dict[str, str]) -> str:
    """The message for a name that is missing; it says where the name is instead."""
    from importlib import import_module
    from importlib.util import find_spec

    message = f"module {package!r} has no attribute {name!r}"
    if name.startswith("_") or find_spec(f"{package}.{name}"):  # Python asks before it imports one
        return message
    inside = [import_module(f"{package}.{part}") for part, home in homes.items() if home == package]
    names = [(part.__name__, getattr(part, "__all__", vars(part))) for part in inside]
    qualified_names = [f"{home}.{name}" for home, public in names if name in public]
    return f"{message}: it is {' or '.join(qualified_names)}" if qualified_names else message
