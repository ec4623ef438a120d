"""Draw the pictures of the documentation: `python docs/make_pictures.py` writes docs/pictures."""

from __future__ import annotations

from pathlib import Path

from exactfold import PROVED, branch, count, decompose, draw, flat, follow
from exactfold.app.pictures.crease_drawing import CreaseDrawing
from exactfold.app.pictures.crease_lines import crease_lines
from exactfold.app.pictures.directions_plot import directions_plot
from exactfold.app.pictures.flat_conflicts import conflict_picture
from exactfold.app.pictures.flat_states import state_picture
from exactfold.app.pictures.folded import Amount, folded
from exactfold.app.pictures.svg import element, number, picture, text
from exactfold.app.report import motion_animation, motion_stills
from exactfold.app.report.flat import reasons
from exactfold.motion import follow_panels, roll
from exactfold.pattern import CreasePattern

FOLDER = Path(__file__).with_name("pictures")
MOTIONS = {
    "single-vertex": ("single-vertex-4", "+"),
    "two-vertex": ("two-vertex", "+-"),
    "random-8": ("random-8", "++++++++"),
    "flat-octahedron": ("flat-octahedron", "+-+"),
}
"""The name of the picture; the shipped pattern, and the signs of the branch."""
PANELS = {"zigzags": ("zigzags", 1), "zigzags-strips": ("zigzags", 3)}
"""The same of sheets of panels, with the number of the way."""


def pictures() -> dict[str, str]:
    """Each picture by the name of its file."""
    branches = {
        f"{name}.svg": motion_stills(follow(pattern, signs=signs), 5, f"{pattern}, branch {signs}")
        for name, (pattern, signs) in MOTIONS.items()
    }
    panels = {}
    for name, (pattern, way) in PANELS.items():
        motion = follow_panels(decompose(pattern), way=way)
        panels[f"{name}.svg"] = motion_stills(motion, 5, f"{pattern}, way {way}")
    others = {"folding.svg": folding(), "rim.svg": rim(), "rim-path.svg": rim_path()}
    turning = directions_plot(count("waterbomb-cell", direction="all"), "waterbomb-cell", 2)
    others["waterbomb-directions.svg"] = turning
    rolling = roll("waterbomb-cell", (1, 2), way=2)
    others["waterbomb-rolling.svg"] = motion_stills(rolling, 4, "waterbomb-cell, way 2")
    return branches | panels | drawings() | folded_flat() | others


def rim_path() -> str:
    """A sheet with six corners, folded with the heights of its border in a given ratio."""
    motion = follow("waterbomb", signs="+", until="150deg")
    return motion_stills(motion, 5, "waterbomb, branch +")


def rim() -> str:
    """Two squares with one vertex inside: four creases to the corners, and a fifth to a side."""
    corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
    hub, side = ("2/5", "11/20"), (1, "1/2")
    four = CreasePattern([*corners, hub], [(k, (k + 1) % 4, 4) for k in range(4)])
    five = CreasePattern(
        [*corners, hub, side], [(0, 1, 4), (1, 5, 4), (5, 2, 4), (2, 3, 4), (3, 0, 4)]
    )
    size, gap, parts = 200.0, 60.0, []
    for k, pattern in enumerate((four, five)):
        drawing = CreaseDrawing(crease_lines(pattern, None), {}, {}, size, True, None)
        wide, high = drawing.extent
        left = 10 + k * (wide + gap)
        parts.append(element("g", drawing.body(), transform=f"translate({number(left)} 6)"))
        caption = f"{len(pattern.boundary)} vertices on the rim"
        parts.append(text(caption, left + wide / 2, high + 22, anchor="middle", size=13))
    return picture(2 * wide + gap + 20, high + 34, parts, "A crease that ends in a side")


def folding() -> str:
    """The sheet of the first page, which folds along a motion that is proved."""
    motion = follow("miura")
    if motion.closes is not PROVED:
        raise RuntimeError("the motion on the first page is not proved")
    return motion_animation(motion, title="miura")


def drawings() -> dict[str, str]:
    """Those of the page on drawing, as `exactfold draw` makes them."""
    one = branch("random-8", "+-++--+-")
    return {
        "draw-zigzags.svg": draw("zigzags", title="zigzags"),
        "draw-branch.svg": draw(one, title="random-8"),
        "draw-folded.svg": folded(follow(one), Amount.of("60deg"), "random-8").text,
        "draw-all.svg": draw(count("flat-octahedron"), title="flat-octahedron"),
    }


def folded_flat() -> dict[str, str]:
    """Those of the page on folding flat, as `exactfold flat -o` makes them."""
    twist = flat("square-twist")
    return {
        "flat-state.svg": state_picture(flat("miura").state(), "miura, flat-folded state 0"),
        "flat-why.svg": conflict_picture(
            twist, reasons(twist), "square-twist, no flat-folded state"
        ),
    }


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    for name, text in pictures().items():
        (FOLDER / name).write_text(text, encoding="utf-8")
