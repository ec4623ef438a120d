"""Write docs/gallery.md and its pictures: shipped patterns and families, each with its branches.

`python docs/make_gallery.py` writes all, with names only these. Each pattern is counted, and what
the page says of it is what the count says. The lines below each make the same pictures.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from textwrap import fill
from typing import Final
from xml.etree import ElementTree

from exactfold import count, follow, read
from exactfold._support.verdict import PROVED
from exactfold.app.pictures.drawn_ways import DrawnWay
from exactfold.app.pictures.folded import Amount, folded
from exactfold.app.pictures.stills import motion_still
from exactfold.app.pictures.way_sheets import number_listed, sheet_of_ways
from exactfold.app.report import pattern_picture, ways_of
from exactfold.app.report.count import answer
from exactfold.app.report.panels import panels_answer
from exactfold.branches import BranchCount
from exactfold.errors import NotFollowedError
from exactfold.motion import Motion, PanelMotion
from exactfold.panels import Decomposition
from exactfold.pattern import CreasePattern, PanelPattern, families
from exactfold.pattern.data import BY_OTHERS, DRAWINGS, SHEETS, examples
from exactfold.pattern.degenerate import DEGENERATE

PAGE: Final = Path(__file__).with_name("gallery.md")
FOLDER: Final = Path(__file__).with_name("gallery")
MOST: Final = 12
"""Ways that are drawn of each pattern."""
STILL, ALONE, SMALL = 380.0, 300.0, 150.0
"""Widths of a folded sheet, of a pattern without a list, and of those in the table at the top."""
AMOUNT: Final = "90deg"
"""How far a sheet is folded on its still."""
COLUMNS: Final = 4
"""Of the table at the top."""
USUAL: Final = (
    ", each counted once",
    ", as flat vertices count double",
    "; the dimension is the number of folds that can be folded independently",
    "; all real, every one continues to a true motion",
)
"""What the page says once, at its top."""
HEAD: Final = """# Gallery

The patterns that come with exactfold, and one sheet of each family that it can build: all ways to
fold it, up to twelve, and one of them folded in space. Sheets that fold in families have no such
list. Of panels round vertices with more than four folds, only the ways are drawn on which the
tangents of half the fold angles stay in proportion.
"""
READING: Final = f"""\
Every number is proved. Where no more is said of a triangulated sheet, all branches are real, and
each continues to a true motion. In numbers with multiplicity flat vertices count double. The
dimension of a family is the number of folds that can be folded independently.

[Pictures](viewer.md#pictures) explains lines and marks. These commands make the pictures of a
pattern NAME, folded along way WAY. Without a list of ways the pattern alone is drawn, by
`exactfold draw NAME -o NAME.svg`.

```sh
exactfold count NAME
exactfold draw NAME --all --most {MOST} -o NAME.svg
exactfold draw NAME --way WAY --folded {AMOUNT} -o NAME-folded.svg
```
"""
IN_PYTHON: Final = """\
The sheets from here on are no files. Each is built by the expression below its name:

```python
import exactfold
from exactfold.pattern import families
from exactfold.pattern.degenerate import DEGENERATE

found = exactfold.count(families.hypar(1))
motion = exactfold.follow(found, 4)
```
"""
ROWS: Final = """\
Small sheets with an exception: a vertex that stays flat, a straight crease, a reflex corner. Each
is `DEGENERATE[NAME]()` in the lines above, and is shown folded along one of its ways.

| | sheet, and ways to start folding | what it is |
|---|---|---|
"""
FOOT: Final = """## Where they come from

`python docs/make_gallery.py` counts every pattern anew and writes this page. The windmill, fish and
bird bases are traditional forms. The Miura fold is Koryo Miura's; the Yoshimura pattern is named
after Yoshimaru Yoshimura, who described how thin tubes buckle. The files below "Drawn by others"
were drawn by Amanda Ghassaei for
[Origami Simulator](https://github.com/amandaghassaei/OrigamiSimulator), copyright 2018, with the
MIT licence, which is installed beside them. All other files come with the licence of exactfold.
"""
DEGENERATES: Final = tuple(
    name for name in DEGENERATE if name not in ("flat-vertex", "hypar-straight")
)
"""Those that are shown nowhere else."""
BUILT: Final[dict[str, str]] = {
    "single-vertex-5": "families.single_vertex(5)",
    "hypar-1": "families.hypar(1)",
    "hypar-straight": "families.hypar(1, twist=0)",
    "h1-3": "families.h1_sequence(3)",
    **{name: f'DEGENERATE["{name}"]()' for name in DEGENERATES},
}
"""Sheets that are no files: the Python expression that builds each."""
SHOWN: Final = {
    "single-vertex-5": "One interior vertex with five folds.",
    "hypar-1": "A square, turned a little, in another square.",
    "hypar-straight": "The same without the turn, so that creases on the diagonals line up.",
    "h1-3": "Three interior vertices, made one by one by H1 moves.",
    "nested-triangles": "A triangle that is triangulated twice over: what is inside stays flat.",
    "several-triangles": "Two vertices of degree four beside two triangulated triangles.",
    "chord": "A crease from corner to corner: both halves are rigid, and only this crease folds.",
    "cross": "Two straight creases that cross: the sheet folds along one or the other.",
    "straight-path": "Two vertices on a straight crease from corner to corner.",
    "bent-off-path": "A straight crease from corner to corner, with a vertex on either side.",
    "ring": "A square round a smaller one with a vertex in its middle.",
    "grid": "Four vertices on a grid with diagonals.",
    "waterbomb-pair": "Two cells of the waterbomb tiling on top of each other.",
    "notched": "A sheet with four corners, one of them reflex.",
}
"""What each of them is, in one line."""
GROUPS: Final[dict[str, tuple[str, ...]]] = {
    "Drawings": tuple(name for name in DRAWINGS if name not in BY_OTHERS),
    "Drawn by others": tuple(BY_OTHERS),
    "Triangulated sheets": SHEETS,
    "Families": tuple(name for name in BUILT if name not in DEGENERATES),
    "Flat vertices and straight creases": DEGENERATES,
}


@dataclass(frozen=True)
class Card:
    """What the page shows of a pattern: a picture of its ways, a small one, and a way folded.

    `way` is the number of the way that is folded, 0 if there is none.
    """

    name: str
    found: BranchCount | Decomposition
    ways: str
    small: str
    still: str | None = None
    way: int = 0

    @property
    def files(self) -> dict[str, str]:
        """The pictures by the names of their files."""
        if self.name in DEGENERATES:
            return {f"{self.name}-small.svg": self.small}
        stills = {} if self.still is None else {f"{self.name}-folded.svg": self.still}
        return {f"{self.name}.svg": self.ways, f"{self.name}-small.svg": self.small} | stills

    @property
    def answer(self) -> tuple[str, str]:
        """How many ways there are, and what else the count says, without the time it took."""
        found = self.found
        said = answer(found) if isinstance(found, BranchCount) else panels_answer(found)
        timeless = re.sub(r" \(\d+\.\d\d s\)", "", said.plain)
        number, _, more = timeless.partition(f" - {str(PROVED).upper()}")
        for said_above in USUAL:
            more = more.replace(said_above, "")
        real, moves = "(?:all|it is) real", "(?:every one|it) continues to a true motion"
        simple = re.match(rf"; {real}, (.+), {moves}$", more)
        return number, f"; {simple[1]}" if simple else more

    @property
    def what(self) -> str:
        """What the pattern is, in one line."""
        return SHOWN[self.name] if self.name in BUILT else examples()[self.name]

    @property
    def shown(self) -> str:
        """What the page says of the pattern, once the table at the top has named it."""
        return self.row if self.name in DEGENERATES else self.section

    @property
    def row(self) -> str:
        """A line of the table of degenerate sheets."""
        number, more = self.answer
        small = image(f"{self.name}-small", f"{self.name}, folded", SMALL)
        count = f"{number}{more}".replace(" to start folding", "")
        return f"| {small} | {self.name}<br>{count} | {self.what} |\n"

    @property
    def section(self) -> str:
        """A section of its own."""
        number, more = self.answer
        wide = width(self.ways) if number_listed(self.found) else ALONE
        pictures = [image(self.name, f"ways to fold {self.name}", wide)]
        told = f"**{number[:1].upper()}{number[1:]}**{more}."
        if self.still is not None:
            pictures.append(image(f"{self.name}-folded", f"{self.name}, folded", STILL))
            told += f" Folded: way {self.way}."
        what = f"`{BUILT[self.name]}`: {self.what}" if self.name in BUILT else self.what
        parts = [f"### {self.name}", fill(what, 100), fill(told, 100), "\n".join(pictures)]
        return "\n\n".join(parts) + "\n"

    @property
    def cell(self) -> str:
        """The place of the pattern in the table at the top."""
        number, _ = self.answer
        short = re.sub(r"( of ways)? to (start )?fold(ing)?|,.*", "", number)
        shown = image(f"{self.name}-small", self.name, SMALL)
        return f"[{shown}](#{self.name})<br>[{self.name}](#{self.name})<br>{short}"


def image(name: str, words: str, wide: float) -> str:
    """A picture of this width in pixels, for Markdown and for the site."""
    return f'<img src="gallery/{name}.svg" alt="{words}" width="{wide:.0f}">'


def width(picture: str) -> float:
    """The width of an SVG picture in pixels."""
    return float(ElementTree.fromstring(picture).get("width", "0"))


def names() -> list[str]:
    """Everything in the gallery, in its order."""
    return [name for group in GROUPS.values() for name in group]


def counted(name: str) -> BranchCount | Decomposition:
    """All ways to fold an entry of the gallery."""
    if name in BUILT:
        return count(eval(BUILT[name], {"families": families, "DEGENERATE": DEGENERATE}))
    return count(name)


def card(name: str) -> Card:
    """An entry of the gallery: the pattern counted, drawn and folded."""
    found = counted(name)
    if number_listed(found):
        ways, followed = sheet_of_ways(found, name, MOST), fullest(found)
        if followed is None:
            return Card(name, found, ways, small_sheet(name, found))
        way, motion = followed
        still = folded(motion, Amount.of(AMOUNT), name).text
        time = Amount.of(AMOUNT).time(motion)
        return Card(name, found, ways, motion_still(motion, time, "", name, SMALL), still, way)
    sheet, letters = drawn(name, found)
    return Card(name, found, pattern_picture(sheet, letters, title=name), small_sheet(name, found))


def drawn(
    name: str, found: BranchCount | Decomposition
) -> tuple[CreasePattern | PanelPattern, Mapping[tuple[int, int], str]]:
    """The sheet, and the letters of its file."""
    if name in BUILT:
        return found.pattern, {}
    opened = read(name)
    return opened.sheet, opened.assignment


def small_sheet(name: str, found: BranchCount | Decomposition) -> str:
    """The crease pattern, small."""
    return pattern_picture(*drawn(name, found), size=SMALL, keyed=False, labelled=False)


def fullest(found: BranchCount | Decomposition) -> tuple[int, Motion | PanelMotion] | None:
    """Of the ways that can be followed, one that folds most creases, in both senses; its number."""
    for way in sorted(ways_of(found), key=folds, reverse=True):
        number = way.number or 1
        try:
            return number, follow(found, number)
        except NotFollowedError:
            continue
    return None


def folds(way: DrawnWay) -> tuple[int, int]:
    """How many creases fold, and how many at least are mountains and are valleys."""
    mountains, valleys = (way.text.count(letter) for letter in "MV")
    return mountains + valleys, min(mountains, valleys)


def written(name: str) -> Card:
    """An entry of which the pictures are written."""
    made = card(name)
    FOLDER.mkdir(exist_ok=True)
    for file, text in made.files.items():
        (FOLDER / file).write_text(text, encoding="utf-8")
    return made


def page(cards: Iterable[Card]) -> str:
    """The page on all of these."""
    by_name = {made.name: made for made in cards}
    cells = [made.cell for made in cards_on_top(by_name.values())]
    cells += [""] * (-len(cells) % COLUMNS)
    rows = [cells[k : k + COLUMNS] for k in range(0, len(cells), COLUMNS)]
    table = [rows[0], [":---:"] * COLUMNS, *rows[1:]]
    parts = [HEAD, "\n".join(f"| {' | '.join(row)} |" for row in table) + "\n"]
    parts.append(READING)
    for title, group in GROUPS.items():
        parts += [f"## {title}\n", *([IN_PYTHON] if title == "Families" else [])]
        shown = [by_name[name].shown for name in group]
        parts += [f"{ROWS}{''.join(shown)}"] if group == DEGENERATES else shown
    return "\n".join([*parts, FOOT])


def cards_on_top(cards: Iterable[Card]) -> list[Card]:
    """Those in the table at the top: the others stand in a table of their own."""
    return [made for made in cards if made.name not in DEGENERATES]


def write(wanted: Iterable[str]) -> None:
    """Write the pictures of these, and the page if all are wanted."""
    cards = [written(name) for name in wanted]
    if len(cards) == len(names()):
        PAGE.write_text(page(cards), encoding="utf-8")


if __name__ == "__main__":
    write(sys.argv[1:] or names())
