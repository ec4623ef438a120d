"""GIF and MP4 files of a sheet as it folds, or of pictures in turn."""

from __future__ import annotations

import base64
import io
import tempfile
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from exactfold.app.pictures.animation import seen_frames
from exactfold.app.pictures.stills import shades
from exactfold.app.pictures.svg import INK
from exactfold.errors import PackageMissingError, UsageError
from exactfold.pattern.writing.fold_writing import checked_target, write_bytes

if TYPE_CHECKING:
    from PIL.Image import Image

    from exactfold.motion.curves.in_motion import SheetInMotion

ENDINGS: Final = (".gif", ".mp4")
FILMS: Final = (*ENDINGS, ".png")
_FINER: Final = 3
MOST_PICTURES: Final = 400
MOST_PIXELS: Final = 2_000_000
"""Of one picture."""
MOST_PIXELS_IN_ALL: Final = 200_000_000
_COLOURS: Final = 192
_FEW: Final = 6
_LEAST_PAUSE: Final = 0.02
"""Seconds for one picture of a GIF file: viewers slow down anything faster."""


def write_film(
    motion: SheetInMotion, path: Path, *, frames: int = 40, seconds: float = 6, size: int = 480
) -> None:
    """Write a motion from the flat sheet to its end and back as .gif or .mp4; as .png its end.

    `frames` pictures are shown on the way there, and again on the way back, in `seconds`. `size` is
    the width in pixels. Raises `UsageError` for another ending, `PackageMissingError`, and
    `UnwritableFileError`.
    """
    ending = checked_film(path)
    there = _drawn(motion, frames, size)
    if ending == ".png":
        target = io.BytesIO()
        there[-1].save(target, "PNG")
        write_bytes(path, target.getvalue())
        return
    write_bytes(path, film([*there, *there[-2:0:-1]], ending, seconds))


def checked_film(path: Path) -> str:
    """The ending of the path of a film; raises the errors of `checked_target`."""
    return checked_target(path, FILMS, "an animation")


def _drawn(motion: SheetInMotion, frames: int, size: int) -> list[Image]:
    """Pictures of a motion, drawn at a larger scale first, so that lines are smooth."""
    module, pen = _pillow(), _pen()
    large = _FINER * size
    seen, height = seen_frames(motion, frames, large)
    found = []
    for one in seen:
        picture = module.new("RGB", (large, round(height)), "white")
        drawing = pen.Draw(picture)
        for face, colour in zip(one.faces, shades(one.shape, one.faces), strict=True):
            corners = [(float(x), float(y)) for x, y in one.flat[list(face)]]
            drawing.polygon(corners, fill=colour)
            drawing.line([*corners, corners[0]], fill=INK, width=_FINER, joint="curve")
        found.append(picture.resize((size, round(height / _FINER)), module.Resampling.LANCZOS))
    return found


def filmed(pictures: Sequence[bytes], ending: str, seconds: float) -> str:
    """The file, in base64, of PNG pictures that are shown in turn, so many seconds in all.

    Raises `UsageError` for anything that is not a picture of moderate size, and
    `PackageMissingError`.
    """
    if not 2 <= len(pictures) <= MOST_PICTURES:
        raise UsageError(f"{len(pictures)} pictures: an animation has 2 to {MOST_PICTURES}")
    if not 0.1 <= seconds <= 600:
        raise UsageError(f"{seconds:g} seconds: an animation lasts 0.1 to 600")
    opened: list[Image] = []
    for data in pictures:
        opened.append(_opened(data))
        if opened[0].width * opened[0].height * len(pictures) > MOST_PIXELS_IN_ALL:
            raise UsageError("the pictures of the animation are too large together")
    if len({picture.size for picture in opened}) != 1:
        raise UsageError("the pictures of an animation have one size")
    return base64.b64encode(film(opened, ending, seconds)).decode("ascii")


def film(pictures: Sequence[Image], ending: str, seconds: float) -> bytes:
    """A GIF or MP4 file of pictures of one size; a GIF repeats for ever."""
    if ending == ".gif":
        return _gif(pictures, seconds)
    if ending == ".mp4":
        return _mp4(pictures, seconds)
    raise UsageError(f"an animation ends in {' or '.join(ENDINGS)}, not in {ending!r}")


def checked_encoder(ending: str) -> None:
    """Check, before the work, that files with this ending can be written.

    Raises `PackageMissingError` for MP4 files without imageio and ffmpeg.
    """
    if ending == ".mp4" and not all(find_spec(name) for name in ("imageio", "imageio_ffmpeg")):
        raise PackageMissingError(
            "MP4 files need imageio with ffmpeg: pip install 'exactfold[animation]', or write .gif"
        )


def _pillow() -> Any:
    """Pillow is imported only where pictures are read or written, because that takes time."""
    from PIL import Image

    return Image


def _pen() -> Any:
    from PIL import ImageDraw

    return ImageDraw


def _opened(data: bytes) -> Image:
    module = _pillow()
    try:
        picture = module.open(io.BytesIO(data), formats=["PNG"])
        if picture.width * picture.height > MOST_PIXELS:
            raise UsageError(f"a picture of {picture.width} x {picture.height} pixels is too large")
        found: Image = picture.convert("RGB")
    except (OSError, SyntaxError, ValueError) as error:
        raise UsageError(f"not a PNG picture: {error}") from None
    return found


def _gif(pictures: Sequence[Image], seconds: float) -> bytes:
    pause = max(seconds / len(pictures), _LEAST_PAUSE)
    palette = _side_by_side(pictures).quantize(_COLOURS)
    first, *others = (
        one.quantize(palette=palette, dither=_pillow().Dither.NONE) for one in pictures
    )
    target = io.BytesIO()
    milliseconds = 10 * max(round(100 * pause), 2)
    first.save(target, "GIF", save_all=True, append_images=others, duration=milliseconds, loop=0)
    return target.getvalue()


def _side_by_side(pictures: Sequence[Image]) -> Image:
    """A few of the pictures in one, so that their colours are those of the animation."""
    some = pictures[:: -(-len(pictures) // _FEW)]
    width, height = some[0].size
    sheet: Image = _pillow().new("RGB", (width * len(some), height))
    for k, picture in enumerate(some):
        sheet.paste(picture, (k * width, 0))
    return sheet


def _mp4(pictures: Sequence[Image], seconds: float) -> bytes:
    checked_encoder(".mp4")
    import numpy as np
    from imageio.v3 import imwrite

    width, height = (side - side % 2 for side in pictures[0].size)
    frames = [np.asarray(one.crop((0, 0, width, height))) for one in pictures]
    with tempfile.TemporaryDirectory(prefix="exactfold-") as folder:
        path = Path(folder) / "film.mp4"
        rate = len(frames) / seconds
        imwrite(path, frames, fps=rate, codec="libx264", macro_block_size=2, quality=8)
        return path.read_bytes()
