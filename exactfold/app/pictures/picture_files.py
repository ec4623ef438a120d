"""Pictures as files: SVG directly, PNG and PDF by CairoSVG."""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import Final

from exactfold.errors import PackageMissingError
from exactfold.pattern.writing.fold_writing import checked_target, write_bytes

ENDINGS: Final = (".svg", ".png", ".pdf")
_SCALE: Final = 2.0
"""A PNG file has this many pixels for each pixel of the SVG file."""


def checked_picture(path: Path) -> str:
    """The format that the path of a picture names; raises the errors of `checked_target`."""
    return checked_target(path, ENDINGS, "a picture")


def write_picture(text: str, path: str | PathLike[str]) -> None:
    """Write an SVG picture in the format that the ending of the path names.

    ".svg" is written as it is. ".png", with twice the number of pixels, and ".pdf" are written by
    CairoSVG, which is in the extra `exactfold[pictures]`. Raises `UsageError` for another ending,
    `PackageMissingError` without CairoSVG, and `UnwritableFileError`.
    """
    ending = checked_picture(Path(path))
    if ending == ".svg":
        write_bytes(path, text.encode("utf-8"))
        return
    try:
        import cairosvg
    except (ImportError, OSError) as error:  # OSError: Cairo itself is missing
        raise PackageMissingError(
            f"{path}: PNG and PDF files need CairoSVG ({error}): "
            "pip install 'exactfold[pictures]', or write .svg"
        ) from None
    raw = text.encode("utf-8")
    if ending == ".png":
        write_bytes(path, cairosvg.svg2png(bytestring=raw, scale=_SCALE))
    else:
        write_bytes(path, cairosvg.svg2pdf(bytestring=raw))
