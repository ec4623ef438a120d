"""Draw the pictures of the documentation: `python docs/make_pictures.py` writes docs/pictures."""

from __future__ import annotations

from pathlib import Path

from exactfold import count_ways, find_branch, follow, load, open_pattern
from exactfold.data import example_path
from exactfold.motion import follow_panels
from exactfold.report import (
    branch_way,
    motion_stills,
    pattern_picture,
    sheet_of_multiples,
    ways_of,
)
from exactfold.report.folded import Amount, folded

FOLDER = Path(__file__).with_name("pictures")
MOTIONS = {
    "single-vertex": ("single-vertex-4", "+"),
    "two-vertex": ("two-vertex", "+-"),
    "random-8": ("random-8", "++++++++"),
    "flat-octahedron": ("flat-octahedron", "+-+"),
}
"""The name of the picture; the shipped pattern, and the signs of the branch."""
PANELS = {"zigzags": ("zigzags", 1), "zigzags-strips": ("zigzags", 3)}
"""The same of sheets of panels, with the number of the component."""


def pictures() -> dict[str, str]:
    """Each picture by the name of its file."""
    branches = {
        f"{name}.svg": motion_stills(
            follow(find_branch(load(pattern), signs)), 5, f"{pattern}, branch {signs}"
        )
        for name, (pattern, signs) in MOTIONS.items()
    }
    panels = {}
    for name, (pattern, component) in PANELS.items():
        motion = follow_panels(count_ways(pattern), component=component)
        panels[f"{name}.svg"] = motion_stills(motion, 5, f"{pattern}, component {component}")
    return branches | panels | drawings()


def drawings() -> dict[str, str]:
    """Those of the page on drawing, as `exactfold draw` makes them."""
    opened = open_pattern(example_path("waterbomb"))
    branch = find_branch("random-8", "+-++--+-")
    all_branches, all_modes = count_ways("two-vertex"), count_ways("zigzags")
    octahedron = ways_of(count_ways("flat-octahedron"))
    title = "{}: {} ways to start folding, proved"
    return {
        "draw-waterbomb.svg": pattern_picture(opened.sheet, opened.assignment, title="waterbomb"),
        "draw-branch.svg": branch_way(branch).picture("random-8"),
        "draw-folded.svg": folded(follow(branch), Amount.of("60deg"), "random-8").text,
        "draw-all.svg": sheet_of_multiples(octahedron, title.format("flat-octahedron", 8)),
        "draw-two-vertex.svg": sheet_of_multiples(
            ways_of(all_branches), title.format("two-vertex", len(all_branches))
        ),
        "draw-modes.svg": sheet_of_multiples(ways_of(all_modes), "zigzags: 5 modes, proved"),
    }


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    for name, text in pictures().items():
        (FOLDER / name).write_text(text, encoding="utf-8")
