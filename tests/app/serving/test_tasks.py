"""What a process of the server does: sheets opened and changed, and films."""

import base64
import io
from fractions import Fraction

import numpy as np
import pytest
from sampling import slow_after
from scipy.spatial import Delaunay

from exactfold.app.pictures.film import filmed
from exactfold.app.serving.tasks import Film, Follow, Move, Open, Session, moved
from exactfold.branches import count_branches
from exactfold.errors import ExactfoldError, UsageError
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.families import single_vertex
from exactfold.pattern.loading import open_sheet

Image = pytest.importorskip("PIL.Image")


def answers(task):
    return list(Session().answers(task))


def test_a_vertex_that_moves_keeps_edges_and_letters_and_goes_to_the_grid():
    opened = open_sheet("bird-base")
    new = moved(opened, Move(8, 211.0, -190.0, 16))
    assert new.sheet.vertices[8] == (200, -200)  # the nearest point of the grid of 25
    assert new.sheet.folds == opened.sheet.folds
    assert new.assignment == opened.assignment
    free = moved(opened, Move(8, 211.0, -190.0, 4096))
    assert free.sheet.vertices[8] == (
        Fraction(400 * round(Fraction(211 * 4096, 400)), 4096),
        -400 + Fraction(400 * round(Fraction(210 * 4096, 400)), 4096),
    )


def test_a_vertex_cannot_go_where_edges_would_cross():
    opened = open_sheet("two-vertex")
    for move in (Move(4, 9.0, 9.0, 16), Move(4, 0.0, 0.0, 16)):
        with pytest.raises(ExactfoldError):
            moved(opened, move)
    with pytest.raises(UsageError, match="there is no vertex 6"):
        moved(opened, Move(6, 0.5, 0.5, 16))
    with pytest.raises(UsageError, match="grid of 0 steps"):
        moved(opened, Move(4, 0.5, 0.5, 0))
    [error] = answers(Open("x", "two-vertex", move=Move(4, 9.0, 9.0, 16)))
    assert error["kind"] == "error"


def test_a_moved_sheet_is_counted_like_any_other():
    task = Open("x", "two-vertex", move=Move(4, 0.3, 0.6, 64), live=True, frames=2)
    read, listed, way = answers(task)
    sheet = moved(open_sheet("two-vertex"), task.move).sheet
    count = count_branches(sheet)
    assert read["sheet"]["fold"]["vertices_exactfold:coords"][4] == ["19/64", "19/32"]
    document = listed["document"]
    assert [one["letters"] for one in document["ways"]] == [b.assignment_text for b in count]
    assert way["way"] == 0  # while it moves, only one motion is followed


def convex(corners, inside, seed):
    """A regular polygon with random points inside, triangulated."""
    generator = np.random.default_rng(seed)
    turns = np.arange(corners) * 2 * np.pi / corners
    rim = np.column_stack([np.cos(turns), np.sin(turns)]) * 1000
    points = np.vstack([rim.round(), generator.integers(-450, 450, (inside, 2))]).astype(int)
    return CreasePattern(points.tolist(), Delaunay(points).simplices.tolist())


@pytest.mark.parametrize(
    "sheet", slow_after(1, [convex(6, 2, 2), convex(5, 3, 1), convex(8, 4, 5)])
)
def test_while_a_vertex_moves_a_theorem_says_how_many_families_there_are(sheet):
    _, whole, *_ = answers(Open("x", sheet, frames=2, limit=20))
    _, brief, way = answers(Open("x", sheet, frames=2, live=True))
    whole, brief = whole["document"], brief["document"]
    assert whole["answer"].startswith(f"{brief['answer']}; with ")
    assert (whole["status"], whole["freedom"]) == (brief["status"], brief["freedom"])
    assert way["found"]["family"]["dimension"] == sheet.Ve - 3
    assert brief["ways"][0]["signs"] == "+" * len(sheet.interior)


@pytest.mark.slow
def test_degrees_of_freedom_are_told_if_they_are_proved():
    for sheet, said in (
        (single_vertex(3), "degrees of freedom: 0"),
        (single_vertex(4), "degrees of freedom: 1"),
        ("waterbomb", "degrees of freedom: 3"),
        ("bird-base", "degrees of freedom: 5"),
        ("miura", "degrees of freedom: 3"),
    ):
        _, listed, *_ = answers(Open("x", sheet, frames=2, live=True))
        assert listed["document"]["freedom"] == said


def test_after_the_time_no_further_way_is_followed():
    *_, late = answers(Open("x", "h1-4", frames=2, limit=0.0))
    assert late["kind"] == "late"
    assert late["text"].startswith("16 ways not followed after 0 seconds")


@pytest.mark.slow
def test_a_way_cannot_be_followed_before_a_sheet_is_open():
    [error] = answers(Follow(0))
    assert error["error"] == "the sheet is no longer open here: open it again"
    session = Session()
    list(session.answers(Open("x", single_vertex(6), frames=2)))
    [found] = session.answers(Follow(None, "-"))
    assert found["branch"]["signs"] == "-"
    list(session.answers(Open("x", "miura", frames=2)))
    [error] = session.answers(Follow(None, "-"))
    assert "modes have no vertex signs" in error["error"]


def pictures(*colours, size=(30, 20)):
    found = []
    for colour in colours:
        target = io.BytesIO()
        Image.new("RGB", size, colour).save(target, "PNG")
        found.append(target.getvalue())
    return tuple(found)


def test_a_film_has_its_pictures_in_turn_for_so_many_seconds():
    data = filmed(pictures("red", "lime", "blue"), ".gif", 1.5)
    gif = Image.open(io.BytesIO(base64.b64decode(data)))
    assert (gif.format, gif.n_frames, gif.size, gif.info["loop"]) == ("GIF", 3, (30, 20), 0)
    assert gif.info["duration"] == 500
    seen = []
    for k in range(3):
        gif.seek(k)
        seen.append(max(range(3), key=gif.convert("RGB").getpixel((15, 10)).__getitem__))
    assert seen == [0, 1, 2]


@pytest.mark.parametrize(
    ("frames", "seconds", "said"),
    [
        (pictures("red"), 1.0, "1 pictures"),
        ((*pictures("red"), b"GIF89a"), 1.0, "not a PNG picture"),
        ((*pictures("red"), *pictures("red", size=(3, 3))), 1.0, "one size"),
        (pictures("red", "red"), 1e9, "seconds"),
        (pictures("red", "red", size=(2000, 2000)), 1.0, "too large"),
        (150 * pictures("red", size=(1400, 1000)), 1.0, "too large together"),
    ],
)
def test_what_is_no_film_is_refused(frames, seconds, said):
    with pytest.raises(UsageError, match=said):
        filmed(frames, ".gif", seconds)


def test_an_mp4_film_is_written_where_its_package_is():
    pytest.importorskip("imageio_ffmpeg")
    [answer] = answers(Film(pictures("red", "lime", "blue", "red"), 1.0))
    data = base64.b64decode(answer["data"])
    assert data[4:8] == b"ftyp"
