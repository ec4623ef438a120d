"""Imports optional packages only when a function needs them."""

from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec
from typing import Any

from exactfold.errors import PackageMissingError


def is_available(module: str) -> bool:
    """Whether a module can be found; this imports the packages that contain it.

    >>> is_available("json.decoder"), is_available("no_such_package.part")
    (True, False)
    """
    try:
        return find_spec(module) is not None
    except ModuleNotFoundError:
        return False


def optional(module: str, install: str) -> Any:
    """The module of an optional package; `install` is what pip needs to install it.

    Raises `PackageMissingError` if it is not installed. If it is installed but cannot be imported,
    its own error is raised.

    >>> optional("fractions", "nothing").Fraction(1, 2)
    Fraction(1, 2)
    >>> optional("no_such_package", "'exactfold[bridges]'")
    Traceback (most recent call last):
    exactfold.errors.PackageMissingError: no_such_package is not installed: pip install
    'exactfold[bridges]'
    """
    if not is_available(module):
        raise PackageMissingError(
            f"{module.partition('.')[0]} is not installed: pip install {install}"
        )
    return import_module(module)
