"""Whether each vertex of a sheet folds flat by itself: the conditions of Kawasaki and Maekawa."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, TypeAlias

from exactfold.design.panels.vertex.kawasaki import kawasaki
from exactfold.layers.images import closes, doubled_directions
from exactfold.panels.vertex.stars import star_at
from exactfold.pattern.panel_pattern import Edge, PanelPattern

Condition: TypeAlias = Literal["kawasaki", "maekawa"]


@dataclass(frozen=True)
class Failure:
    """A vertex that does not fold flat by itself, and the condition that fails there.

    For Kawasaki's condition, every second sector between folded creases adds up to 180 + `off`
    degrees, and `off` is None if the number of folded creases is odd. For Maekawa's condition,
    `excess` is the number of mountains minus that of valleys, which is not 2 or -2.
    """

    vertex: int
    condition: Condition
    off: float | None = None
    excess: int | None = None

    @property
    def text(self) -> str:
        """The failure in words.

        >>> Failure(3, "kawasaki", 2.5).text
        'at vertex 3 every second sector adds up to 182.5 degrees instead of 180 (Kawasaki)'
        >>> Failure(3, "maekawa", excess=4).text
        'at vertex 3 there are 4 more mountains than valleys, and it has to be 2 (Maekawa)'
        """
        if self.condition == "maekawa":
            excess = self.excess or 0
            more, fewer = ("mountains", "valleys") if excess >= 0 else ("valleys", "mountains")
            if not excess:
                said = "as many mountains as valleys"
            else:
                said = f"{abs(excess)} more {more} than {fewer}"
            return f"at vertex {self.vertex} there are {said}, and it has to be 2 (Maekawa)"
        if self.off is None:
            return f"at vertex {self.vertex} the number of folded creases is odd (Kawasaki)"
        if abs(self.off) < 0.01:
            return (
                f"at vertex {self.vertex} every second sector adds up to 180 degrees only up to "
                f"{abs(self.off):.1g} degrees (Kawasaki)"
            )
        return (
            f"at vertex {self.vertex} every second sector adds up to {180 + self.off:.5g} degrees "
            "instead of 180 (Kawasaki)"
        )


def failures(sheet: PanelPattern, letters: Mapping[Edge, str]) -> tuple[Failure, ...]:
    """The interior vertices at which Kawasaki's or Maekawa's condition fails, exactly.

    `letters` has M, V, F or U for every fold; creases with F are left out. Maekawa's condition is
    looked at where Kawasaki's holds and all folded creases have M or V. Neither condition says that
    a vertex folds flat, and both are necessary.

    >>> import exactfold
    >>> bird = exactfold.read("bird-base")
    >>> failures(bird.sheet, bird.letters)
    ()
    """
    found = []
    doubled = doubled_directions(sheet)
    for v in sheet.interior:
        star = star_at(sheet, v)
        star = star.only(fold for fold in star.folds if letters.get(fold, "U") != "F")
        if not closes([doubled[fold] for fold in star.folds]):
            found.append(Failure(v, "kawasaki", kawasaki(star)[1]))
            continue
        given = [letters.get(fold, "U") for fold in star.folds]
        excess = given.count("M") - given.count("V")
        if given and "U" not in given and abs(excess) != 2:
            found.append(Failure(v, "maekawa", excess=excess))
    return tuple(found)
