"""A sheet that folds, as GIF, MP4 and PNG files."""

import numpy as np
import pytest
from PIL import Image
from running import run

from exactfold.app.pictures import film as film_module
from exactfold.app.pictures.film import write_film
from exactfold.branches import find_branch
from exactfold.errors import UnwritableFileError, UsageError
from exactfold.motion import follow


@pytest.fixture(scope="module")
def motion():
    return follow(find_branch("two-vertex", "+-"), frames=9)


def pixels(picture):
    return np.asarray(picture.convert("RGB"), dtype=int)


def test_a_gif_folds_there_and_back(motion, tmp_path):
    path = tmp_path / "two.gif"
    write_film(motion, path, frames=5, seconds=2.4, size=120)
    gif = Image.open(path)
    assert (gif.format, gif.n_frames, gif.width) == ("GIF", 8, 120)
    assert gif.info["loop"] == 0
    shots = []
    for k in range(gif.n_frames):
        gif.seek(k)
        shots.append(pixels(gif))
        assert gif.info["duration"] == 300
    for k in (1, 2, 3):  # the way back shows the same pictures
        assert np.abs(shots[k] - shots[8 - k]).max() < 60
    assert np.abs(shots[0] - shots[4]).max() > 150
    dark = [(shot.sum(axis=2) < 3 * 250).mean() for shot in shots[:5]]
    assert dark[0] > dark[-1]  # a sheet that folds covers less of the picture


def test_a_png_shows_the_end(motion, tmp_path):
    write_film(motion, tmp_path / "end.png", frames=5, size=120)
    write_film(motion, tmp_path / "two.gif", frames=5, size=120)
    end, gif = Image.open(tmp_path / "end.png"), Image.open(tmp_path / "two.gif")
    assert (end.format, end.width) == ("PNG", 120)
    gif.seek(4)
    assert np.abs(pixels(end) - pixels(gif)).mean() < 6


def test_an_mp4_is_written_where_its_package_is(motion, tmp_path):
    pytest.importorskip("imageio_ffmpeg")
    write_film(motion, tmp_path / "two.mp4", frames=5, size=121)
    data = (tmp_path / "two.mp4").read_bytes()
    assert data[4:8] == b"ftyp"


def test_where_a_film_cannot_be_written(motion, tmp_path):
    with pytest.raises(UsageError, match=r"an animation is written as \.gif, \.mp4, \.png"):
        write_film(motion, tmp_path / "two.avi")
    with pytest.raises(UnwritableFileError, match="there is no folder"):
        write_film(motion, tmp_path / "no" / "two.gif")


@pytest.mark.parametrize("ending", [".gif", ".png"])
def test_fold_writes_films_and_says_so(tmp_path, ending):
    path = tmp_path / f"two{ending}"
    result = run("fold", "two-vertex", "--signs", "+-", "--frames", "4", "-o", path)
    assert result.exit_code == 0
    assert path.name in result.stdout
    assert Image.open(path).format == ending[1:].upper()


def test_without_ffmpeg_the_extra_is_named_before_the_work(tmp_path, monkeypatch):
    real = film_module.find_spec
    monkeypatch.setattr(
        film_module, "find_spec", lambda name: None if name == "imageio_ffmpeg" else real(name)
    )
    result = run("fold", "two-vertex", "-o", tmp_path / "two.mp4")
    assert result.exit_code == 2
    assert "pip install 'exactfold[animation]', or write .gif" in result.stderr
    assert not list(tmp_path.iterdir())
