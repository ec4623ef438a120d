"""Writes numbers of things with the right forms of nouns and verbs."""

from __future__ import annotations

from collections.abc import Sequence

_OWN = {
    "vertex": "vertices",
    "family": "families",
    "half": "halves",
    "has": "have",
    "is": "are",
    "stays": "stay",
    "looks": "look",
}


def plural(word: str) -> str:
    """The plural of a noun, or of one of a few verbs.

    >>> [plural(word) for word in ("fold", "vertex", "branch", "unknown", "is")]
    ['folds', 'vertices', 'branches', 'unknowns', 'are']
    """
    if word in _OWN:
        return _OWN[word]
    return f"{word}es" if word.endswith(("ch", "sh", "s", "x")) else f"{word}s"


def counted(number: int | str, noun: str) -> str:
    """A number with its noun, the last word of `noun`; a number given as text is never one.

    >>> counted(1, "vertex"), counted(2, "sign vector"), counted("2^41", "branch")
    ('1 vertex', '2 sign vectors', '2^41 branches')
    """
    first, _, last = noun.rpartition(" ")
    word = last if number == 1 else plural(last)
    return f"{number} {first}{' ' if first else ''}{word}"


def agreeing(number: int, verb: str) -> str:
    """The form of a verb for a number of things, or of their noun without the number.

    >>> agreeing(1, "stays"), agreeing(2, "stays")
    ('stays', 'stay')
    """
    return verb if number == 1 else plural(verb)


def either(names: Sequence[str]) -> str:
    """Names as alternatives.

    >>> either(["count"]), either(["--all", "--also", "--snap"])
    ('count', '--all, --also or --snap')
    """
    return " or ".join(filter(None, [", ".join(names[:-1]), names[-1]]))


def visible(text: str) -> str:
    """Text for a terminal: characters that cannot be printed become escapes, except line ends.

    >>> print(visible("sheet\x1b[2J.fold"))
    sheet\\x1b[2J.fold
    """
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() or c == "\n" else ascii(c)[1:-1] for c in text)
