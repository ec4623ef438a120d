"""The environment of worker processes: one BLAS thread each, and memory that is kept."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager

_SETTINGS = {
    "OPENBLAS_NUM_THREADS": "1",  # the workers share the cores already
    "MKL_NUM_THREADS": "1",
    "OMP_NUM_THREADS": "1",
    "VECLIB_MAXIMUM_THREADS": "1",
    # glibc: keep 64 MB instead of returning it after every array; saves a fifth of the time.
    "MALLOC_TOP_PAD_": str(1 << 26),
}


@contextmanager
def worker_environment() -> Iterator[None]:
    """Within this block, processes started anew have the settings of a worker."""
    before = {name: os.environ.get(name) for name in _SETTINGS}
    os.environ.update(_SETTINGS)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value
