"""Compact certificates checked at scale: floats with proved bounds first, integers for the rest."""

from __future__ import annotations

import os
from collections.abc import Sequence
from concurrent.futures import BrokenExecutor

import numpy as np
import numpy.typing as npt

from exactfold import checker, compact_checker
from exactfold.certify.float_krawczyk import UNPROVED, FloatBoxes, FloatKrawczyk, FloatSigns
from exactfold.errors import CertificateFormatError, UnreadableFileError, WorkerDiedError
from exactfold.problem.quadratic import QuadraticSystem
from exactfold.solve.dense_newton import sign_vectors
from exactfold.workers import become_worker, worker_environment

CertificateError = checker.CertificateError

LEAST = 32
"""Blocks for each worker that make starting processes worth while."""


def check_compact(
    path: str | os.PathLike[str], *, workers: int = 1, fast: bool = True
) -> dict[str, object]:
    """Verify every claim of a compact certificate; returns the claims.

    The sheet and its system are rebuilt by the code of `exactfold.checker`. With `fast`, most roots
    are verified by `FloatKrawczyk` and `FloatSigns`, whose rounding errors are bounded, and only
    those that they leave open in integers; without it, all in integers and by the standard library
    alone, as `python compact_checker.py` does. Several `workers` are processes; a script that asks
    for them needs the usual `if __name__ == "__main__"`.

    Raises `checker.CertificateError` if a claim is not supported, `CertificateFormatError` if the
    file is no compact certificate or was altered, `UnreadableFileError`, `WorkerDiedError`.
    """
    start, work, least = (
        (start_fast_worker, check_line_fast, LEAST)
        if fast
        else (compact_checker.start_worker, compact_checker.check_line, 1)
    )
    try:
        with worker_environment():
            return compact_checker.check(os.fspath(path), workers, start, work, least)
    except checker.FormatError as error:
        raise CertificateFormatError(f"{path}: {checker.plain(error)}") from None
    except BrokenExecutor:
        raise WorkerDiedError("a worker process died; nothing is known of the file") from None
    except OSError as error:
        raise UnreadableFileError(f"cannot read {path}: {error.strerror}") from None


class FastChecker:
    """The tests of one file in floats, on the system that `compact_checker.Chambers` rebuilt."""

    def __init__(self, chambers: compact_checker.Chambers) -> None:
        self.chambers = chambers
        n = chambers.size
        matrices = []
        for quadric in chambers.system.quadrics:
            matrix = [[0] * (n + 1) for _ in range(n + 1)]
            for (i, j), weight in quadric.items():
                matrix[i][j] = weight
            matrices.append(matrix)
        self.test = FloatKrawczyk(QuadraticSystem.from_rational(matrices))
        self.vertices = FloatSigns(tuple(map(tuple, chambers.vertex_rows)))
        self.folds = FloatSigns(tuple(map(tuple, chambers.fold_rows)))

    def verified(self, block: compact_checker.Block) -> npt.NDArray[np.bool_]:
        """Which roots of the block have one regular zero in their box, and the signs given."""
        count, n = self.chambers.block, self.chambers.size
        raw = np.zeros((count, n, 8), dtype=np.uint8)
        raw[:, :, : block.width] = np.frombuffer(block.centers, dtype=np.uint8).reshape(
            count, n, block.width
        )
        # Moved to the top and back, so that the sign fills the missing bytes.
        missing = 8 * (8 - block.width)
        centers = (raw.view("<i8")[:, :, 0] << missing) >> missing
        exponents = np.frombuffer(block.radii, dtype=np.uint8).astype(np.int64)
        proved = exponents <= compact_checker.MOST_BITS
        boxes = FloatBoxes(block.bits, centers, np.where(proved, exponents, UNPROVED))
        letters = np.frombuffer(block.folds, dtype=np.uint8).reshape(count, -1)
        valleys = np.unpackbits(letters, axis=1, bitorder="little")
        folds = np.where(valleys == 1, 1, -1)
        given, spare = np.split(folds, [len(self.chambers.fold_rows)], axis=1)
        signs = sign_vectors(block.first, count, n)
        return np.asarray(
            self.test.verify(boxes)
            & (self.vertices.on(boxes) == signs).all(axis=1)
            & (self.folds.on(boxes) == given).all(axis=1)
            & (spare == -1).all(axis=1)
        )

    def refusal(self, text: str, number: int) -> str | None:
        """Verify one block: None, or why it does not hold."""
        try:
            block = self.chambers.decode(text, number)
            done: Sequence[bool] = self.verified(block).tolist()
            self.chambers.check_block(block, done)
        except checker.CertificateError as error:
            return str(error)
        except compact_checker.MALFORMED as error:
            return f"malformed: {type(error).__name__} in block {number}"
        return None


_fast: FastChecker | None = None  # of a worker process


def start_fast_worker(header: str) -> None:
    """Rebuild the sheet in a worker process."""
    global _fast
    become_worker()
    _fast = FastChecker(compact_checker.Chambers(compact_checker.read_header(header)))


def check_line_fast(text: str, number: int) -> str | None:
    """Verify one block in a worker process: None, or why it does not hold."""
    if _fast is None:
        raise RuntimeError("the worker was not started")
    return _fast.refusal(text, number)
