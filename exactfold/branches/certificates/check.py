"""Checks compact certificates fast: first in floats with proved bounds, the rest in integers."""

from __future__ import annotations

import os
from collections.abc import Sequence

import numpy as np

from exactfold._support.arrays import BoolArray
from exactfold.certificates.sharing import shared
from exactfold.checker.branches import compact
from exactfold.checker.branches.compact_blocks import Block, CompactSheet
from exactfold.checker.branches.listing import CountClaims
from exactfold.checker.core.limits import MOST_UNITS
from exactfold.checker.core.parts import Engine
from exactfold.checker.core.reading import CertificateError, FormatError, plain, refusing
from exactfold.errors import CertificateFormatError, UnreadableFileError, WorkerDiedError
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.certify.float_krawczyk import UNPROVED, FloatBoxes, FloatKrawczyk, FloatSigns
from exactfold.solve.numeric.nappe_newton import sign_vectors

LEAST = 32
"""A worker process is worth starting if it gets at least this many blocks."""


def check_compact(
    path: str | os.PathLike[str],
    *,
    workers: int = 1,
    fast: bool = True,
    name: str | os.PathLike[str] | None = None,
) -> CountClaims:
    """Verify every claim of a compact certificate and return the claims.

    The code of `exactfold.checker` rebuilds the sheet and its system. With `fast`, `FloatKrawczyk`
    and `FloatSigns`, whose rounding errors are bounded, verify most roots, and integers verify the
    roots that these leave open. Without `fast`, integers and the standard library alone verify all
    roots, as in `python exactfold/checker`. More than one of `workers` are processes; a script that
    uses them needs the usual `if __name__ == "__main__"`. Messages call the file `name`, which is
    `path` by default.

    Raises `checker.CertificateError` if a claim is not supported, `CertificateFormatError` if the
    file is not a compact certificate or was altered, `UnreadableFileError`, `WorkerDiedError`.
    """
    engine = FLOATS if fast else compact.INTEGERS._replace(share=shared)
    name = path if name is None else name
    try:
        return compact.check(os.fspath(path), workers, engine)
    except FormatError as error:
        raise CertificateFormatError(f"{name}: {plain(error)}") from None
    except WorkerDiedError as error:
        raise type(error)(f"{error}; nothing is known of the file") from None
    except OSError as error:
        raise UnreadableFileError(f"cannot read {name}: {error.strerror}") from None


class FastChecker:
    """Tests the roots of one file in floats, on the system that `CompactSheet` rebuilt."""

    def __init__(self, sheet: CompactSheet) -> None:
        self.sheet = sheet
        n = sheet.size
        matrices = []
        for quadric in sheet.system.quadrics:
            matrix = [[0] * (n + 1) for _ in range(n + 1)]
            for (i, j), weight in quadric.items():
                matrix[i][j] = weight
            matrices.append(matrix)
        self.test = FloatKrawczyk(QuadraticSystem.from_rational(matrices))
        self.vertices = FloatSigns(tuple(map(tuple, sheet.vertex_rows)))
        self.folds = FloatSigns(tuple(map(tuple, sheet.fold_rows)))

    def verified(self, block: Block) -> BoolArray:
        """For each root of the block, whether floats verify its box and its signs.

        They do if the box holds exactly one zero, which is regular, with the stated vertex signs
        and folds. A root that is not verified here may still be right.
        """
        count, n = self.sheet.block, self.sheet.size
        raw = np.zeros((count, n, 8), dtype=np.uint8)
        raw[:, :, : block.width] = np.frombuffer(block.centers, dtype=np.uint8).reshape(
            count, n, block.width
        )
        # Shift left and right again, so that the sign bit fills the missing bytes.
        missing = 8 * (8 - block.width)
        centers = (raw.view("<i8")[:, :, 0] << missing) >> missing
        exponents = np.frombuffer(block.radii, dtype=np.uint8).astype(np.int64)
        proved = exponents <= MOST_UNITS
        boxes = FloatBoxes(block.bits, centers, np.where(proved, exponents, UNPROVED))
        letters = np.frombuffer(block.folds, dtype=np.uint8).reshape(count, -1)
        valleys = np.unpackbits(letters, axis=1, bitorder="little")
        folds = np.where(valleys == 1, 1, -1)
        given, spare = np.split(folds, [len(self.sheet.fold_rows)], axis=1)
        signs = sign_vectors(block.first, count, n)
        return np.asarray(
            self.test.verify(boxes)
            & (self.vertices.on(boxes) == signs).all(axis=1)
            & (self.folds.on(boxes) == given).all(axis=1)
            & (spare == -1).all(axis=1)
        )

    def refusal(self, text: str, number: int) -> str | None:
        """Verify one block: None, or the reason why it does not hold."""
        try:
            with refusing(f"in block {number}"):
                block = self.sheet.decode(text, number)
                done: Sequence[bool] = self.verified(block).tolist()
                self.sheet.check_block(block, done)
        except CertificateError as error:
            return str(error)
        return None


def _fast(header: str) -> FastChecker:
    return FastChecker(CompactSheet(compact.COMPACT.header(header)))


FLOATS = Engine(_fast, LEAST, shared)
"""The engine that lets `FastChecker` verify roots in floats first."""
