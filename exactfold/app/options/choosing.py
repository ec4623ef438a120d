"""Reads the values of the options that choose a way: vertex signs, vertices, and letters."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from exactfold._support.plurals import counted
from exactfold.app.options.ways import WayOptions
from exactfold.app.shell.given import Given
from exactfold.app.verbs.chosen import DRAWN, Choice
from exactfold.errors import NumberError, UsageError
from exactfold.exact.numbers import parse_whole
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.drawing.bounds import read_text
from exactfold.pattern.opening import Opened

if TYPE_CHECKING:
    from exactfold.pattern.panel_pattern import PanelPattern


def choice_of(
    options: WayOptions,
    opened: Opened,
    given: Given | None = None,
    drive: Mapping[Edge, float | None] | None = None,
    side: int | None = None,
) -> Choice:
    """The options that name a way as the value that `choose` takes; `given` has boundary heights.

    Raises `UsageError` for text that is not what it should be, and `UnreadableFileError`.
    """
    letters: Mapping[Edge, str] | str | None = options.letters
    if options.letters is not None and options.letters != DRAWN:
        letters = given_letters(opened.sheet, options.letters)
    return Choice(
        options.way,
        None if options.signs is None else given_signs(options.signs, opened),
        None if options.up is None else indices("--up", options.up),
        letters,
        drive=drive,
        side=side,
        finder=given.finder if given else None,
    )


def given_signs(text: str, opened: Opened) -> str:
    """Vertex signs, or those in a file if the text is @FILE.

    Raises `UnreadableFileError`, and `UsageError` for a file whose signs do not fit the sheet; the
    message names the file.
    """
    if not text.startswith("@"):
        return text
    path = Path(text[1:])
    signs = "".join(line for _, line in lines(path))
    if isinstance(opened.sheet, CreasePattern):
        from exactfold.branches.counting.find import BranchFinder

        try:
            BranchFinder(opened.sheet).signs(signs, None)
        except UsageError as error:
            raise UsageError(f"{path}: {error}") from None
    return signs


def indices(option: str, text: str) -> list[int]:
    """The vertices in a list such as 5,7."""
    try:
        return [parse_whole(part) for part in text.split(",") if part.strip()]
    except NumberError:
        raise UsageError(f"{option} takes vertex indices such as 5,7, not {text!r}") from None


def lines(path: Path) -> Iterator[tuple[int, str]]:
    """The lines of a text file that are not blank, with their line numbers from 1."""
    for number_of_line, line in enumerate(read_text(path).split("\n"), 1):
        if line.strip():
            yield number_of_line, line.strip()


def given_letters(pattern: CreasePattern | PanelPattern, text: str) -> dict[Edge, str]:
    """The letters that --letters gives: in the order of the folds, or by fold: "0-4=M,1-5=V".

    @FILE reads them from a file. Folds that are not named are free. Raises `UsageError` and
    `UnreadableFileError`.
    """
    where = ""
    if text.startswith("@"):
        where, text = f"{text[1:]}: ", read_text(text[1:])
    letters = "".join(text.split())
    try:
        return _by_name(pattern, letters) if "=" in letters else _in_order(pattern, letters)
    except UsageError as error:
        raise UsageError(f"{where}{error}") from None


def _in_order(pattern: CreasePattern | PanelPattern, letters: str) -> dict[Edge, str]:
    folds = pattern.folds
    for fold, letter in zip(folds, letters, strict=False):
        _check(fold, letter)
    if len(letters) != len(folds):
        raise UsageError(
            f"{counted(len(letters), 'letter')} for {counted(len(folds), 'fold')}: give one of M, "
            "V, F, U for each, in the order of `exactfold count`, or by fold as in 0-4=M,1-5=V"
        )
    return dict(zip(folds, letters, strict=True))


def _by_name(pattern: CreasePattern | PanelPattern, text: str) -> dict[Edge, str]:
    names = {f"{i}-{j}": (i, j) for i, j in pattern.folds}
    names |= {f"{j}-{i}": (i, j) for i, j in pattern.folds}
    letters: dict[Edge, str] = {}
    for part in filter(None, text.split(",")):
        name, _, letter = part.partition("=")
        if name not in names:
            raise UsageError(f"{part!r} names no fold of the sheet: write 0-4=M for fold 0-4")
        fold = names[name]
        _check(fold, letter)
        if letters.setdefault(fold, letter) != letter:
            raise UsageError(f"fold {fold[0]}-{fold[1]} has two letters: give one")
    return letters


def _check(fold: Edge, letter: str) -> None:
    if letter not in tuple("MVFU"):
        raise UsageError(
            f"fold {fold[0]}-{fold[1]} has the letter {letter!r}: use M (mountain), V (valley), F "
            "(flat) or U (free)"
        )
