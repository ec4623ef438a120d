"""Compact certificates to forge, and a root of one given exactly."""

from __future__ import annotations

import json
from typing import Any

from forge import Lines, put, raw

from exactfold.checker.branches.compact_blocks import CompactSheet

FOUR, EXACT, SIZE = "compact-blocks-of-4", "compact-exact", 4  # n = 4 in 4 blocks; n = 1


def moved(parts: Lines, block: int = 0, index: int = 0, **changes: Any) -> None:
    """One root of a block moved to `exact`, as it is but for the changes."""
    sheet = CompactSheet(parts[0])
    line = parts[1 + block]
    known = sheet.decode(json.dumps(line), block)
    entry = {
        "root": index,
        "bits": known.bits,
        "radius": str(1 << known.radii[index]),
        "center": [str(m) for m in known.center(index, sheet.size)],
        "assignment": sheet.letters(known, index),
    }
    radii = raw(line, "radii")
    radii[index] = 255
    put(line, "radii", radii)
    line["exact"] = [*line["exact"], entry | changes]
