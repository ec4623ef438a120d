"""The names of formats and keys of cells, which also tell whether a file is a cell."""

from __future__ import annotations

from typing import Final

FORMAT: Final = "exactfold periodic pattern"
"""The format that a plain file states."""
LATTICE_KEY: Final = "frame_exactfold:lattice"
"""The lattice vectors in a FOLD file, as two pairs of rational numbers in quotes."""
OFFSETS_KEY: Final = "faces_exactfold:offsets"
"""For each face of a FOLD file the pairs (i, j) by which its corners are moved."""


def is_cell(raw: bytes) -> bool:
    """Whether the bytes of a file are the cell of a periodic sheet, well formed or not."""
    if not raw.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"{"):
        return False
    return FORMAT.encode() in raw or LATTICE_KEY.encode() in raw
