"""Types of functions that are called as work advances; they may raise an error to stop it."""

from __future__ import annotations

from collections.abc import Callable

Progress = Callable[[str, int, int], None]
"""A function that gets the stage, how much of it is done, and the total."""

Steps = Callable[[int, int], None]
"""A function that gets how much of a single stage is done, and the total."""
