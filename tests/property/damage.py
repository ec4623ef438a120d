"""Small files of every format and certificates of every kind, and random changes of them."""

from __future__ import annotations

import hashlib
import json
import re
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import NamedTuple

HERE = Path(__file__).resolve().parent
for folder in ("", "checker", "pattern/drawing"):  # for `fuzz.py`, which is no test
    if str(HERE.parent / folder) not in sys.path:
        sys.path.append(str(HERE.parent / folder))

import drawings  # noqa: E402
from certificates import leaf_changes, nodes, replaced, structure_changes, type_changes  # noqa: E402

from exactfold.checker.core.lines import chained  # noqa: E402
from exactfold.pattern.data import CELLS, EXAMPLES, cell_path, example_path  # noqa: E402

CERTIFICATES = HERE.parent / "fixtures" / "certificates"
LARGEST = 22_000  # bytes of the files that are changed

Choose = Callable[[int], int]
"""A whole number from 0 on that is smaller than the argument."""


class Input(NamedTuple):
    """A file to be judged: "read" or "check", the file that was changed, and its content."""

    how: str
    origin: str
    content: bytes

    def kept(self, folder: Path) -> Path:
        """Where this input is stored."""
        stem, dot, ending = self.origin.rpartition(".")
        digest = hashlib.sha256(self.content).hexdigest()[:8]
        return folder / self.how / f"{stem}-{digest}{dot}{ending}"


def stored(path: Path) -> Input:
    """The input that `kept` stored."""
    origin = path.stem.rpartition("-")[0] + path.suffix
    return Input(path.parent.name, origin, path.read_bytes())


# --- the files that are changed ------------------------------------------------------------------

_CURVES = (
    '<svg viewBox="0 0 9 9"><style>.m{stroke:red}</style><defs><g id="a"><path class="m" '
    'transform="rotate(30 1 1) skewX(5)" d="M1 1C2 2 3 1 4 4A2 3 5 0 1 6 6Q1 2 3 3z"/></g></defs>'
    '<use href="#a" x="2"/><rect width="9" height="9" rx="1" stroke="#000"/>'
    '<svg x="1" width="50%" viewBox="0 0 2 2" preserveAspectRatio="xMidYMin slice">'
    '<polyline points="0,0 1,1 2,0" stroke="hsl(240,100%,50%)"/></svg></svg>'
)
_ENDINGS = ("fold", "svg", "cp", "opx", "ori", "orh", "dxf", "tmd5", "obj")


@cache
def files() -> tuple[Input, ...]:
    """Files of all formats and certificates of all kinds; each is read, or verifies."""
    paths = [*map(example_path, EXAMPLES), *map(cell_path, CELLS)]
    read = [Input("read", Path(path).name, Path(path).read_bytes()) for path in paths]
    for ending in _ENDINGS:
        text = getattr(drawings, f"as_{ending}")(drawings.SQUARE)
        read.append(Input("read", f"square.{ending}", text.encode()))
    read += [Input("read", "curves.svg", _CURVES.encode())]
    certificates = sorted(CERTIFICATES.glob("*.json")) + sorted(CERTIFICATES.glob("*.txt"))
    check = [Input("check", path.name, path.read_bytes()) for path in certificates]
    return tuple(x for x in read + check if len(x.content) < LARGEST)


# --- changes -------------------------------------------------------------------------------------

_NUMBER = re.compile(rb"-?[0-9]+(?:\.[0-9]*)?(?:[eE][-+]?[0-9]+)?")
_WORDS = [
    *b"0 -0 1 -1 2 1/0 0/1 1/3 -7/2 0.5 1e-9 1e9 1e400 1e19999 NaN Infinity null true".split(),
    *b'"" [] {} [[ ] } " \' , : < > &#0; </g> % \\ud800 M B + z'.split(),
    *(b"\x00", b"\xff\xfe", b"\t", b"\n", b"\r", b" ", b"\xe2\x80\xa8", b"9" * 30, b"9" * 5000),
]


def _byte(content: bytes, choose: Choose) -> bytes:
    k = choose(len(content) + 1)
    return content[:k] + bytes([choose(256)]) + content[k + 1 :]


def _word(content: bytes, choose: Choose) -> bytes:
    k = choose(len(content) + 1)
    return content[:k] + _WORDS[choose(len(_WORDS))] + content[k + choose(3) :]


def _dropped(content: bytes, choose: Choose) -> bytes:
    k = choose(len(content) + 1)
    return content[:k] + content[k + choose(60) :]


def _moved(content: bytes, choose: Choose) -> bytes:
    """A piece is written again elsewhere."""
    k, size, to = choose(len(content) + 1), choose(60), choose(len(content) + 1)
    return content[:to] + content[k : k + size] + content[to:]


def _number(content: bytes, choose: Choose) -> bytes:
    """A number is replaced by another, of the file or not."""
    numbers = list(_NUMBER.finditer(content))
    if not numbers:
        return _word(content, choose)
    old = numbers[choose(len(numbers))]
    new = _WORDS[choose(len(_WORDS))] if choose(2) else numbers[choose(len(numbers))][0]
    return content[: old.start()] + new + content[old.end() :]


def _line(content: bytes, choose: Choose) -> bytes:
    """A line, or element, is dropped, doubled, or moved to the front."""
    lines = re.split(rb"(?<=[\n>\]}])", content)
    k = choose(len(lines))
    what = choose(3)
    return b"".join([[], [lines[k]], lines[:0]][what] + lines[:k] + lines[k + (what != 1) :])


def _value(content: bytes, choose: Choose) -> bytes:
    """A value of a JSON object is changed, or replaced by another value of it."""
    try:
        document = json.loads(content)
    except (ValueError, RecursionError):
        return _number(content, choose)
    known = list(nodes(document))[1:]
    if not known or not isinstance(document, dict):
        return _word(content, choose)
    path, value = known[choose(len(known))]
    kinds = [
        leaf_changes,
        type_changes,
        structure_changes,
        lambda _: [known[choose(len(known))][1]],
    ]
    new = list(kinds[choose(len(kinds))](value))
    if not new:
        return _number(content, choose)
    return json.dumps(replaced(document, path, new[choose(len(new))])).encode()


_CHANGES = (_value, _number, _word, _byte, _dropped, _moved, _line)


def changed(given: Input, choose: Choose) -> Input:
    """A file with up to four changes; lines of certificates have right digests mostly."""
    content = given.content
    for _ in range(1 + choose(4)):
        lines = content.splitlines()
        sealed = given.how == "check" and given.origin.endswith(".txt") and choose(8) and lines
        if not sealed:
            content = _CHANGES[choose(len(_CHANGES))](content, choose)
            continue
        bodies = [line.partition(b"\t")[0] for line in lines]
        k = choose(len(bodies))
        bodies[k] = _CHANGES[choose(len(_CHANGES))](bodies[k], choose).replace(b"\n", b" ")
        content = chained(body.decode("latin1") for body in bodies).encode("latin1")
    return given._replace(content=content)
