"""Sheets that fold in a picture: what is seen at every moment, and what is drawn."""

import io
import re
from xml.etree import ElementTree

import pytest
from PIL import Image

from exactfold.app.report import motion_animation, motion_stills
from exactfold.branches import find_branch
from exactfold.motion import follow


@pytest.fixture(scope="module")
def motion():
    return follow(find_branch("two-vertex", "+-"))


def timetable(picture: str) -> list[list[tuple[float, str]]]:
    """For each frame its steps: from which per cent of a round on it is visible or hidden."""
    found = re.findall(r"@keyframes k(\d+)\{((?:[\d.]+%\{visibility:\w+\})+)\}", picture)
    assert [int(k) for k, _ in found] == list(range(len(found)))
    return [
        [(float(at), state) for at, state in re.findall(r"([\d.]+)%\{visibility:(\w+)\}", steps)]
        for _, steps in found
    ]


def seen(table: list[list[tuple[float, str]]], moment: float) -> list[int]:
    states = [[state for at, state in steps if at <= moment][-1] for steps in table]
    return [k for k, state in enumerate(states) if state == "visible"]


@pytest.mark.parametrize("frames", [2, 3, 12, 40])
def test_one_frame_is_seen_at_a_time_there_and_back(motion, frames):
    table = timetable(motion_animation(motion, frames=frames))
    shown = [seen(table, share / 10) for share in range(1000)]
    assert {len(found) for found in shown} == {1}
    order = [found[0] for found in shown]
    assert order[0] == order[-1] == 0
    assert order[500] == frames - 1
    assert order[:500] == sorted(order[:500])
    assert set(order) == set(range(frames))


def test_every_frame_has_every_face_and_the_ends_are_those_of_the_stills(motion):
    picture = motion_animation(motion, frames=5, title="a & b")
    root = ElementTree.fromstring(picture)
    space = "{http://www.w3.org/2000/svg}"
    assert root.find(f"{space}title").text == "a & b: the sheet folds and unfolds"
    groups = root.findall(f"{space}g")
    assert [len(group) for group in groups] == [len(motion.pattern.triangles)] * 5
    stills = ElementTree.fromstring(motion_stills(motion, 5)).findall(f"{space}g")
    fills = [[face.get("fill") for face in group] for group in groups]
    assert fills == [[face.get("fill") for face in group] for group in stills]
    assert fills[0] != fills[-1]


def test_where_nothing_is_animated_the_middle_frame_stands(motion):
    """For readers who ask for less motion, and in programs that know no animations."""
    (style,) = re.findall(r"<style>(.*)</style>", motion_animation(motion))
    before, _, rule = style.partition("@media (prefers-reduced-motion:reduce)")
    assert before.startswith(".f{visibility:hidden;")
    assert before.endswith(".f20{visibility:visible}")
    assert rule == "{.f{animation:none!important}}"


def test_a_program_without_animations_shows_the_sheet(motion):
    picture = pytest.importorskip("cairosvg").svg2png(motion_animation(motion).encode())
    colours = Image.open(io.BytesIO(picture)).convert("RGB").getcolors(1 << 20)
    assert len(colours) > 20
