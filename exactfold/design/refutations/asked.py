"""The letters that a user asks for, by fold."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from exactfold.errors import UsageError
from exactfold.pattern.crease_pattern import Edge

_LETTERS = ("M", "V", "F", "U")


def by_fold(folds: Sequence[Edge], letters: Mapping[Edge, str] | str) -> dict[Edge, str]:
    """A letter for every fold; folds that are left out get "U".

    Raises `UsageError` if a letter belongs to no fold, if the number of letters is not the number
    of folds, or if a letter is none of M, V, F, U.

    >>> by_fold([(0, 4), (1, 4)], "MV"), by_fold([(0, 4), (1, 4)], {(1, 4): "F"})
    ({(0, 4): 'M', (1, 4): 'V'}, {(0, 4): 'U', (1, 4): 'F'})
    """
    if not isinstance(letters, str | Mapping):
        raise UsageError(
            "letters have to be a text such as 'MVU', or a mapping from folds to letters"
        )
    if isinstance(letters, str):
        if len(letters) != len(folds):
            raise UsageError(
                f"{len(letters)} letters for {len(folds)} folds: give one letter for each fold"
            )
        letters = dict(zip(folds, letters, strict=True))
    known = set(folds)
    for fold, letter in letters.items():
        if fold not in known:
            raise UsageError(f"{fold} is not a fold of the sheet")
        if letter not in _LETTERS:
            raise UsageError(f"fold {fold} has the letter {letter!r}, not one of M, V, F, U")
    return {fold: letters.get(fold, "U") for fold in folds}
