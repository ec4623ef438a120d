"""Reads and writes sizes and numbers of rows of a study: 1000, or by size 2-4:1000,5:200."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from exactfold.errors import NumberError, UsageError
from exactfold.exact.numbers import parse_whole

MOST_SIZES = 1000
"""Most sizes in a range; a longer range is taken for a slip."""

_FORMS = "write one number for all sizes, such as 1000, or numbers by size, such as 2-4:1000,5:200"


def read_sizes(text: str) -> range:
    """One size from 1 on, or a range of sizes such as 2-4; raises `UsageError`.

    >>> read_sizes("2-4")
    range(2, 5)
    """
    first, _, last = text.strip().partition("-")
    low, high = _whole(first), _whole(last or first)
    if low < 1:
        raise UsageError(f"the least size is 1, not {low}")
    if high < low:
        raise UsageError(f"{text.strip()!r} ends before it begins")
    if high - low >= MOST_SIZES:
        raise UsageError(f"{text.strip()!r} is more than {MOST_SIZES} sizes")
    return range(low, high + 1)


def read_numbers(text: str) -> int | dict[int, int]:
    """One number of rows for all sizes, or a number for each size; raises `UsageError`.

    >>> read_numbers("1000"), read_numbers("2-4:1000,5:200")
    (1000, {2: 1000, 3: 1000, 4: 1000, 5: 200})
    """
    try:
        return _numbers(text)
    except UsageError as error:
        raise UsageError(f"--number: {error}; {_FORMS}") from None


def _numbers(text: str) -> int | dict[int, int]:
    if ":" not in text and "," not in text:
        number = _whole(text)
        if number < 1:
            raise UsageError(f"{number} is less than 1")
        return number
    numbers: dict[int, int] = {}
    for part in text.split(","):
        sizes, colon, number_text = part.partition(":")
        if not colon:
            raise UsageError(f"{part.strip()!r} has no number after a colon")
        number = _whole(number_text)
        if number < 0:
            raise UsageError(f"{number} is less than 0")
        for size in read_sizes(sizes):
            if size in numbers:
                raise UsageError(f"size {size} has two numbers")
            numbers[size] = number
    return numbers


def _whole(text: str) -> int:
    try:
        return parse_whole(text)
    except NumberError as error:
        raise UsageError(str(error)) from None


def written_sizes(sizes: Iterable[int]) -> str:
    """Sizes in the notation of `--sizes`, with consecutive sizes as ranges.

    >>> written_sizes([2, 3, 4, 8])
    '2-4,8'
    """
    return ",".join(_range(first, last) for first, last, _ in _runs(dict.fromkeys(sizes, 0)))


def written_numbers(numbers: int | Mapping[int, int]) -> str:
    """Numbers of rows in the notation of `--number`.

    >>> written_numbers(7), written_numbers({2: 1000, 3: 1000, 4: 1000, 5: 200})
    ('7', '2-4:1000,5:200')
    """
    if isinstance(numbers, int):
        return str(numbers)
    return ",".join(f"{_range(first, last)}:{number}" for first, last, number in _runs(numbers))


def _range(first: int, last: int) -> str:
    return str(first) if first == last else f"{first}-{last}"


def _runs(numbers: Mapping[int, int]) -> list[tuple[int, int, int]]:
    """For each run of consecutive sizes with the same number: first size, last size, number."""
    runs: list[tuple[int, int, int]] = []
    for size, number in sorted(numbers.items()):
        if runs and runs[-1][1:] == (size - 1, number):
            runs[-1] = (runs[-1][0], size, number)
        else:
            runs.append((size, size, number))
    return runs
