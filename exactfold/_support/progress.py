"""What is called as work advances: a function of the caller, which may raise to stop it."""

from __future__ import annotations

from collections.abc import Callable

Progress = Callable[[str, int, int], None]
"""Called with the stage, what is done of it, and the total."""

Steps = Callable[[int, int], None]
"""Called with what is done of a single stage, and the total."""
