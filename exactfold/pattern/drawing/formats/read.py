"""The one way in for drawings: the content of a file shows its format, else its ending does."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from os import PathLike
from pathlib import PurePath
from typing import Final

from exactfold.errors import UnknownFormatError, UsageError
from exactfold.pattern.drawing.bounds import check_drawing, read_bytes
from exactfold.pattern.drawing.drawing import Drawing, SvgReading
from exactfold.pattern.drawing.formats.cp import read_cp
from exactfold.pattern.drawing.formats.dxf import read_dxf
from exactfold.pattern.drawing.formats.fold_drawing import read_fold_drawing
from exactfold.pattern.drawing.formats.obj import read_obj
from exactfold.pattern.drawing.formats.opx import read_opx
from exactfold.pattern.drawing.formats.ori import LINES, read_orh, read_ori
from exactfold.pattern.drawing.formats.svg import read_svg
from exactfold.pattern.drawing.formats.tmd5 import read_tmd5
from exactfold.pattern.drawing.segments import summary

READERS: Final[dict[str, Callable[[str], Drawing]]] = {
    "fold": read_fold_drawing,
    "svg": read_svg,
    "cp": read_cp,
    "opx": read_opx,
    "ori": read_ori,
    "orh": read_orh,
    "dxf": read_dxf,
    "tmd5": read_tmd5,
    "obj": read_obj,
}
"""The reader for the text of each format, by file name ending."""
_CHOOSING: Final = {"svg": read_svg, "dxf": read_dxf}

_CP: Final = re.compile(r"\s*[0-9](\s+[-+.0-9eE]+){4}[ \t\r]*(\n|\Z)")
_ORI: Final = re.compile(r'"lineSegments"\s*:')
_FOLD: Final = re.compile(r'"(file|frame|vertices|edges|faces)_\w+"\s*:')
_SVG: Final = re.compile(r"<(\w+:)?svg[\s>/]")
_DXF: Final = re.compile(r"\s*(999[ \t]*\r?\n.*\n\s*)*0[ \t]*\r?\n[ \t]*SECTION\s")
_TMD5: Final = re.compile(r"tree\s+[0-9.]+\s")
_OBJ: Final = re.compile(r"(\s*(#|(mtllib|o|g|s|usemtl|vn|vt)\b).*\n)*\s*v(\s+[-+.0-9eE]+){3,4}\s")
_TEXTS: Final = (("cp", _CP), ("dxf", _DXF), ("tmd5", _TMD5), ("obj", _OBJ))
_CODE_PAGE: Final = re.compile(rb"\$DWGCODEPAGE\s+3\s+ANSI_([0-9]{3,4})\s")
_ENCODING: Final = re.compile(rb"""<\?xml[^>]*encoding=["']([A-Za-z0-9._-]+)["']""")
_HEADER: Final = 100_000  # bytes in which the code page of a DXF file stands
_NONE: Final = "exactfold reads FOLD, SVG, CP, OPX, ORI, ORH, DXF, TMD5 and OBJ"


def read_drawing(path: str | PathLike[str], reading: SvgReading | None = None) -> Drawing:
    """The drawing in a file of any known format; its `source` is one line on what was read.

    `reading` has the choices for SVG files. Raises `UnreadableFileError` and the errors of
    `parse_drawing`.

    >>> from exactfold.pattern.data import example_path
    >>> read_drawing(example_path("two-vertex")).source
    'read two-vertex.fold: FOLD 1.2, 11 lines (4 boundary, 7 unassigned)'
    """
    return parse_drawing(read_bytes(path), PurePath(path).name, reading)


def parse_drawing(content: str | bytes, name: str, reading: SvgReading | None = None) -> Drawing:
    """The drawing in the content of a file; if the content shows no format, `name` decides.

    Bytes are decoded as UTF-8, as UTF-16 if there is a byte order mark, or as an XML declaration
    says. `reading` has the choices for SVG files. Raises `UnknownFormatError`,
    whose message lists the formats, `TooLargeError`, and the errors of the reader of the format.

    >>> parse_drawing("1 0 0 1 0", "edge").source
    'read edge: CP, 1 line (1 boundary)'
    >>> parse_drawing("%PDF-1.4", "crane.pdf")
    Traceback (most recent call last):
    exactfold.errors.UnknownFormatError: crane.pdf is not a drawing of a known format; exactfold
    reads FOLD, SVG, CP, OPX, ORI, ORH, DXF, TMD5 and OBJ
    """
    text = content if isinstance(content, str) else _decoded(content, name)
    text = text.removeprefix("\ufeff")
    key = _format(text, name)
    if key in _CHOOSING:
        drawing = _CHOOSING[key](text, reading)
    elif reading in (None, SvgReading()):
        drawing = READERS[key](text)
    else:
        raise UsageError(
            f"colours, dashes and chords are for SVG and DXF files, and {name} is {key.upper()}"
        )
    check_drawing(drawing)
    return replace(drawing, source=f"read {name}: {drawing.source}, {summary(drawing)}")


def _decoded(content: bytes, name: str) -> str:
    declared = _ENCODING.match(content.lstrip())
    encoding = declared[1].decode() if declared else "utf-8-sig"
    if content.startswith(b"AutoCAD Binary DXF"):
        raise UnknownFormatError(f"{name} is a binary DXF file: save it as an ASCII DXF file")
    if not _utf8(content) and (page := _CODE_PAGE.search(content[:_HEADER])):
        encoding = f"cp{page[1].decode()}"
    if content.startswith((b"\xff\xfe", b"\xfe\xff")):
        encoding = "utf-16"
    try:
        return content.decode(encoding)
    except (UnicodeDecodeError, LookupError):
        known = "text" if encoding == "utf-8-sig" else f"text in {encoding}, as it says"
        raise UnknownFormatError(f"{name} is not {known}; {_NONE}") from None


def _utf8(content: bytes) -> bool:
    try:
        content.decode()
    except UnicodeDecodeError:
        return False
    return True


def _format(text: str, name: str) -> str:
    """The format of a text, as a key of `READERS`."""
    ending = PurePath(name).suffix.lower().removeprefix(".")
    start = text.lstrip()
    if start.startswith("{"):
        key = "ori" if _ORI.search(text) else "fold" if _FOLD.search(text) else ""
    elif start.startswith("<"):
        key = "orh" if LINES in text else "opx" if "OriLineProxy" in text else ""
        key = key or ("svg" if _SVG.search(text) else "")
    else:
        key = next((key for key, begins in _TEXTS if begins.match(text)), "")
    if key:
        return key
    if ending in READERS:
        return ending
    raise UnknownFormatError(f"{name} is not a drawing of a known format; {_NONE}")
