"""Draw the pictures of the documentation: `python docs/make_pictures.py` writes docs/pictures."""

from __future__ import annotations

from pathlib import Path

from exactfold import find_branch, follow, load
from exactfold.report.stills import motion_stills

FOLDER = Path(__file__).with_name("pictures")
MOTIONS = {
    "single-vertex": ("single-vertex-4", "+"),
    "two-vertex": ("two-vertex", "+-"),
    "random-8": ("random-8", "++++++++"),
    "flat-octahedron": ("flat-octahedron", "+-+"),
}
"""The name of the picture; the shipped pattern, and the signs of the branch."""


def pictures() -> dict[str, str]:
    """Each picture by the name of its file."""
    return {
        f"{name}.svg": motion_stills(
            follow(find_branch(load(pattern), signs)), 5, f"{pattern}, branch {signs}"
        )
        for name, (pattern, signs) in MOTIONS.items()
    }


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    for name, text in pictures().items():
        (FOLDER / name).write_text(text, encoding="utf-8")
