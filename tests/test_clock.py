"""Limits of time: they pass, they are shared, and they say so."""

import pytest

from exactfold._support.clock import UNLIMITED, Clock
from exactfold.errors import TooManyModesError


def test_a_clock_without_limit_never_passes() -> None:
    UNLIMITED.check()
    assert (UNLIMITED.left, UNLIMITED.share(0.0).passed) == (None, False)


def test_facts_that_are_always_wanted_have_a_few_seconds(monkeypatch: pytest.MonkeyPatch) -> None:
    now = 100.0
    monkeypatch.setattr("time.monotonic", lambda: now)
    clock = Clock(60, _start=now)
    assert clock.at_least(5) is clock
    assert UNLIMITED.at_least(5) is UNLIMITED
    now = 158.0
    assert (clock.left, clock.at_least(5).left) == (2.0, 5.0)
    assert clock.at_least(5).said == clock.said
    assert clock.share(0.5).at_least(5).left == 5.0


def test_a_share_of_the_time_ends_first(monkeypatch: pytest.MonkeyPatch) -> None:
    now = 100.0
    monkeypatch.setattr("time.monotonic", lambda: now)
    clock = Clock(60, _start=now)
    most = clock.share(0.75)
    now = 144.0
    assert (clock.left, most.left, most.passed) == (16.0, 1.0, False)
    now = 146.0
    assert (clock.passed, most.passed, most.left) == (False, True, 0.0)
    with pytest.raises(TooManyModesError, match=r"time limit, 45 of 60 seconds \(--limit\)"):
        most.check()
