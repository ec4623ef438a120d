"""Why one vertex of a sheet of rigid panels cannot have its letters."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from exactfold.design.panels.refutation import PanelRefutation, wedge
from exactfold.design.refutations.refutation import Letters
from exactfold.exact.surds import sign
from exactfold.panels.vertex.local import local_modes
from exactfold.panels.vertex.stars import Star
from exactfold.pattern.panel_pattern import Edge, Point


@dataclass(frozen=True)
class VertexReason:
    """Why a vertex cannot have the letters of its folds, in words and as refutations.

    `refutations` is either one refutation without signs, or one for each of the two signs. A sign
    in `curved` has no refutation by vectors; it is impossible because a star of mountains alone, or
    of valleys alone, is curved.
    """

    vertex: int
    text: str
    refutations: tuple[PanelRefutation, ...]
    curved: tuple[int, ...] = ()


def vertex_reason(star: Star, letters: Letters) -> VertexReason | None:
    """Why a vertex cannot have these letters, by its own folds alone; None if it can.

    The star is one that the flat closure leaves: a straight pair, or at least four folds with all
    sectors smaller than pi. To first order, sum_k w_k d_k = 0 is refuted by a vector y with y . d_k
    <= 0 for valleys, >= 0 for mountains, and 0 for free folds, not always 0. To second order, the
    vertex pops up only if its mountains lie in no closed half-plane and it has a valley. For
    popping down, mountains and valleys change places (docs/assignment.md, Theorem 1).

    >>> star = Star(4, ((0, 4), (1, 4), (2, 4), (3, 4)), ((2, 1), (-1, 1), (-1, -1), (1, -2)))
    >>> vertex_reason(star, dict(zip(star.folds, "MMMV")))
    >>> vertex_reason(star, dict(zip(star.folds, "MVMV"))).text
    'the folds of vertex 4 have the letters VVVM, VVMV when they fold, or the opposite
    letters, but not MVMV'
    """
    letter = [letters[fold] for fold in star.folds]
    if not {"M", "V"} & set(letter):
        return None
    pair = len(star.folds) == 2  # only a vector along the pair tells its two folds apart
    for y in star.directions if pair else _normals(star):
        if _first_order(star, letter, y):
            text = _first_order_text(star, letter)
            return VertexReason(star.vertex, text, (PanelRefutation({star.vertex: y}),))
    if pair:
        return None
    by_side = {side: refuted_side(star, letters, side) for side in (1, -1)}
    if any(value is None for value in by_side.values()):
        return None
    refutations = tuple(r for r in by_side.values() if isinstance(r, PanelRefutation))
    curved = tuple(side for side, r in by_side.items() if isinstance(r, str))
    return VertexReason(star.vertex, _second_order_text(star, letter), refutations, curved)


def refuted_side(star: Star, letters: Letters, side: int) -> PanelRefutation | str | None:
    """Why a vertex cannot pop up (1) or down (-1) with these letters; None if it may.

    The reason is a text if the vertex has no valley (mountain) with which to pop up (down). Then
    the star is curved, unless all its folds stay flat or it is bent along one straight line; first
    order decides these cases.
    """
    mountain, valley = ("M", "V") if side > 0 else ("V", "M")
    letter = [letters[fold] for fold in star.folds]
    pairs = list(zip(star.directions, letter, strict=True))
    heldback = [d for d, x in pairs if x in (mountain, "U")]
    others = [d for d, x in pairs if x == valley]
    for nx, ny in _normals(star):
        if all(sign(nx * x + ny * y) <= 0 for x, y in heldback) and any(
            sign(nx * x + ny * y) > 0 for x, y in others
        ):
            return wedge(star, side, (nx, ny))
    if set(letter) == {mountain}:
        return "a star of mountains alone, or of valleys alone, is curved"
    return None


def _normals(star: Star) -> Iterator[Point]:
    """Normals of the lines along the folds, in both directions.

    They stand for all closed half-planes: each of them can be turned until a fold lies on its
    boundary.
    """
    for x, y in star.directions:
        yield -y, x
        yield y, -x


def _first_order(star: Star, letter: list[str], y: Point) -> bool:
    strict = False
    for (a, b), x in zip(star.directions, letter, strict=True):
        side = sign(y[0] * a + y[1] * b)
        if side and side != {"M": 1, "V": -1}.get(x):
            return False
        strict = strict or side != 0
    return strict


def _first_order_text(star: Star, letter: list[str]) -> str:
    where = f"at vertex {star.vertex}"
    if len(star.folds) == 2:
        both = _pair(star.folds)
        return f"{where} the folds {both} form one straight crease but have different letters"
    if len(star.folds) == 4:
        return _four_text(star, letter)
    if "U" in letter:
        where += ", whatever its free folds do,"
    return (
        f"{where} the valleys, and the opposite directions of the mountains, lie on one side of "
        "a line, so the folds cannot close up"
    )


def _second_order_text(star: Star, letter: list[str]) -> str:
    where = f"vertex {star.vertex}"
    if len(star.folds) == 4:
        return _four_text(star, letter)
    if len(set(letter)) == 1:
        word = {"M": "mountains", "V": "valleys"}.get(letter[0], "folds")
        return f"{where} has only {word}; when all of them fold, they cannot close up"
    return (
        f"{where} can pop neither up, because its mountains lie in a half-plane or it has no "
        "valley, nor down, because its valleys lie in a half-plane or it has no mountain"
    )


def _four_text(star: Star, letter: list[str]) -> str:
    ways = ", ".join(_four(star))
    return (
        f"the folds of vertex {star.vertex} have the letters {ways} when they fold, or the "
        f"opposite letters, but not {''.join(letter)}"
    )


def _four(star: Star) -> list[str]:
    """The letters of the two modes of four folds; F where a fold stays flat."""
    letters = []
    for mode in local_modes(star):
        values = dict(zip(mode.folds, mode.values, strict=True))
        letters.append("".join("MFV"[sign(values.get(fold, 0)) + 1] for fold in star.folds))
    return letters


def _pair(folds: tuple[Edge, ...]) -> str:
    return " and ".join(f"{i}-{j}" for i, j in folds)
