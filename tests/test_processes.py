"""Work shared among processes without threads, and their environment: nothing waits for ever."""

from __future__ import annotations

import errno
import os
import threading
from multiprocessing import active_children
from multiprocessing.context import SpawnProcess

import pytest

from exactfold._support import processes as module
from exactfold._support.processes import as_they_end, in_order, worker_environment
from exactfold.errors import NotEnoughMemoryError, WorkerDiedError


def square(number: int) -> int:
    if number == 13:
        os._exit(9)
    if number == 17:
        raise ValueError("seventeen")
    return number**2


class Fatal:
    """Work that ends the process which loads it."""

    def __call__(self, number: int) -> int:
        return number

    def __reduce__(self) -> tuple[object, tuple[int]]:
        return os._exit, (3,)


@pytest.mark.slow
def test_results_as_they_end_and_in_order() -> None:
    before = threading.active_count()
    found = []
    for result in as_they_end(2, square, range(10)):
        assert threading.active_count() <= before  # threads of earlier tests may end
        found.append(result)
    assert sorted(found) == [(k, k**2) for k in range(10)]
    assert list(in_order(2, square, range(10), 3)) == [k**2 for k in range(10)]
    assert list(as_they_end(2, square, [])) == []
    assert active_children() == []


def test_jobs_are_taken_as_there_is_room() -> None:
    taken = []

    def jobs() -> object:
        for k in range(12):
            taken.append(k)
            yield k

    for done, result in enumerate(in_order(2, square, jobs(), 2)):
        assert result == done**2
        assert len(taken) <= done + 1 + 4
    assert taken == list(range(12))


@pytest.mark.slow
def test_a_process_that_dies_is_the_result_of_its_job() -> None:
    found = dict(as_they_end(2, square, range(10, 16)))
    assert type(found[13]) is WorkerDiedError
    assert {k: v for k, v in found.items() if k != 13} == {k: k**2 for k in (10, 11, 12, 14, 15)}
    rest = in_order(1, square, range(12, 16), 2)
    assert next(rest) == 144
    with pytest.raises(WorkerDiedError, match="most likely for lack of memory"):
        next(rest)


def test_errors_of_the_work_are_raised_with_their_traceback() -> None:
    with pytest.raises(ValueError, match="seventeen") as caught:
        list(as_they_end(2, square, [16, 17]))
    assert "in square" in caught.value.__notes__[0]
    assert active_children() == []


def test_processes_that_die_before_their_first_job_are_no_loop() -> None:
    with pytest.raises(WorkerDiedError, match="no worker process lived until its first job"):
        list(as_they_end(2, Fatal(), range(10)))
    assert active_children() == []


def starting(monkeypatch: pytest.MonkeyPatch, most: int) -> None:
    """No more than so many processes can be started."""
    started = []
    start = SpawnProcess.start

    def limited(self: SpawnProcess) -> None:
        if len(started) == most:
            raise BlockingIOError(errno.EAGAIN, os.strerror(errno.EAGAIN))
        started.append(self)
        start(self)

    monkeypatch.setattr(SpawnProcess, "start", limited)


def test_fewer_processes_than_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    starting(monkeypatch, 1)
    assert sorted(as_they_end(3, square, range(6))) == [(k, k**2) for k in range(6)]


def test_no_process_at_all(monkeypatch: pytest.MonkeyPatch) -> None:
    starting(monkeypatch, 0)
    message = f"no worker process can be started: {os.strerror(errno.EAGAIN)}"
    with pytest.raises(WorkerDiedError, match=message):
        list(as_they_end(2, square, range(6)))
    monkeypatch.setattr(module, "memory_is_limited", lambda: True)
    with pytest.raises(NotEnoughMemoryError, match=f"{message}: not enough memory"):
        list(as_they_end(2, square, range(6)))


def test_the_environment_is_restored(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OMP_NUM_THREADS", "7")
    monkeypatch.delenv("OPENBLAS_NUM_THREADS", raising=False)
    with worker_environment():
        assert os.environ["OMP_NUM_THREADS"] == os.environ["OPENBLAS_NUM_THREADS"] == "1"
    assert os.environ["OMP_NUM_THREADS"] == "7"
    assert "OPENBLAS_NUM_THREADS" not in os.environ
