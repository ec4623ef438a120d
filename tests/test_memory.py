"""Shortages of memory: which errors are one, and libraries that are not loaded without room."""

from __future__ import annotations

import errno
import subprocess
import sys

import pytest

from exactfold._support import memory
from exactfold._support.memory import is_shortage, shortage


@pytest.mark.parametrize(
    ("error", "free", "limited"),
    [
        (MemoryError(), True, True),
        (RuntimeError("can't start new thread"), True, True),
        (OSError(errno.ENOMEM, "Cannot allocate memory"), True, True),
        (OSError(errno.ENOSPC, "No space left on device"), False, False),
        (ImportError("failed to map segment from shared object"), False, True),
        (SystemError("error return without exception set"), False, True),
        (RuntimeError("a defect"), False, False),
    ],
)
def test_which_errors_are_shortages(
    monkeypatch: pytest.MonkeyPatch, error: Exception, free: bool, limited: bool
) -> None:
    monkeypatch.setattr(memory, "memory_is_limited", lambda: False)
    assert is_shortage(error) is free
    monkeypatch.setattr(memory, "memory_is_limited", lambda: True)
    assert is_shortage(error) is limited


def test_a_shortage_is_told_in_one_line() -> None:
    assert shortage(MemoryError()) == "not enough memory"
    assert shortage(ImportError("\nwhy\nand much advice\n")) == "not enough memory: why"


LOADING = """
import resource
from exactfold._support.memory import ROOM, require_room
require_room()
resource.setrlimit(resource.RLIMIT_AS, ({megabytes} << 20,) * 2)
require_room()
try:
    import numpy
except MemoryError as error:
    print(error)
else:
    print(numpy.eye(2).sum())
"""


@pytest.mark.skipif(sys.platform != "linux", reason="limits of Linux")
@pytest.mark.parametrize(
    ("megabytes", "said"), [(100, "loading numpy takes 120 MB\n"), (2000, "2.0\n")]
)
def test_a_library_without_room_is_not_loaded(megabytes: int, said: str) -> None:
    code = LOADING.format(megabytes=megabytes)
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (done.stdout, done.stderr, done.returncode) == (said, "", 0)
