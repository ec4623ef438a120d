"""The line of progress and colours: on a terminal only."""

import re
import signal

import pytest
from running import (
    PROVED,
    run,
)

from exactfold.app.shell.shell import Bar
from exactfold.pattern.data import example_path


@pytest.mark.skipif(not hasattr(signal, "pthread_sigmask"), reason="signals of POSIX")
def test_the_line_of_progress_leaves_interrupts_to_the_main_thread(monkeypatch):
    """Otherwise one that the main thread holds back would be delivered all the same."""
    masks = []

    def masked(self):
        masks.append(signal.pthread_sigmask(signal.SIG_BLOCK, ()))

    monkeypatch.setattr(Bar, "show", masked)
    with Bar("reading", delay=0) as bar:
        bar.timer.join()
    assert masks == [{signal.SIGINT, signal.SIGTERM}]
    assert signal.SIGINT not in signal.pthread_sigmask(signal.SIG_BLOCK, ())


def test_no_progress_off_a_terminal():
    result = run("count", example_path("random-8"), "--json")
    assert result.exit_code == PROVED
    assert result.stderr == ""


def test_progress_on_a_terminal(monkeypatch):
    """One line for the stage under way, with a total or without."""
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("TERM", "xterm")
    with Bar("reading", delay=3600) as bar:
        bar.show()  # as the timer does
        assert bar.display is not None
        tasks = bar.display.progress.tasks
        assert [task.description for task in tasks] == ["reading"]
        for stage in ("solving", "certifying"):
            for done in range(3):
                bar(stage, done, 2)
        (task,) = bar.display.progress.tasks
        assert (task.description, task.completed, task.total) == ("certifying", 2, 2)
        bar("writing")
        (task,) = bar.display.progress.tasks
        assert (task.description, task.total) == ("writing", None)
        display = bar.display
    assert bar.display is None
    assert display.progress.live.is_started is False


def test_a_stage_that_reports_nothing_is_shown_by_the_timer(monkeypatch):
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("TERM", "xterm")
    with Bar("reading", delay=0) as bar:
        bar.timer.join()
        assert bar.display is not None


def test_no_progress_off_a_terminal_or_after_the_end(monkeypatch):
    with Bar("reading", delay=3600) as bar:
        bar.show()
        assert bar.display is None
    monkeypatch.setenv("FORCE_COLOR", "1")
    bar.show()
    assert bar.display is None


def test_colours_on_a_terminal_only(monkeypatch):
    plain = run("count", example_path("two-vertex")).stdout
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("TERM", "xterm")
    styled = run("count", example_path("two-vertex")).stdout
    assert "\x1b[" not in plain
    for styled_word in ("[1;32mPROVED", "[31mM", "[34mV", "[32mup", "[35mdown"):
        assert f"\x1b{styled_word}" in styled
    monkeypatch.setenv("NO_COLOR", "1")
    bare = run("count", example_path("two-vertex")).stdout
    assert not re.search(r"\x1b\[[\d;]*3\d", bare)
