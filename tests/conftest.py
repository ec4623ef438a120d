"""What holds for all tests."""

import functools
import os
from typing import Any

import pytest
import typer.testing
from hypothesis import HealthCheck, settings
from xdist.scheduler import WorkStealingScheduling

# Tests start many processes. If they may not keep what they compile, each compiles exactfold again.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)

# Each run draws other examples: some in every run find more than many in a few runs. How long one
# takes on a busy machine is no matter.
settings.register_profile(
    "some", max_examples=20, deadline=None, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("some")

# Typer prepares all commands again for each command line: once is enough for those of one process.
typer.testing._get_command = functools.cache(typer.testing._get_command)


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> WorkStealingScheduling | None:
    """With `-n 2`, each process gets one half of the tests, and at last takes from the other half.

    So what tests of one file share is computed once. By default the tests are dealt out a few at a
    time, and both processes compute it.
    """
    return WorkStealingScheduling(config, log) if config.getvalue("dist") == "load" else None


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """What needs the formal proof comes first: one process builds it, and none waits for it."""
    items.sort(key=lambda item: "formal" not in getattr(item, "fixturenames", ()))


@pytest.fixture
def without_spaces(monkeypatch: pytest.MonkeyPatch) -> None:
    """The search for spaces of motions ends at once, so that not all ways of panels are known."""
    monkeypatch.setattr("exactfold.panels.by_spaces.MOST_STEPS", 0)
