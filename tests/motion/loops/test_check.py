"""The quick check of loops: tubes in floats are those in integers, which have the last word."""

from __future__ import annotations

import json
from fractions import Fraction
from functools import partial
from pathlib import Path

import pytest

from exactfold.checker.motion.loops import LOOPS, LoopSheet, LoopVerifier
from exactfold.checker.motion.pieces import tube_of
from exactfold.checker.motion.tubes import Tube
from exactfold.motion import find_loops
from exactfold.motion.loops import check
from exactfold.motion.loops.check import TUBES_IN_FLOATS
from exactfold.pattern.triangulating.random_squares import random_square


@pytest.fixture(scope="module")
def texts(tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    """The lines of a file of loops: the sheet, the loops, and the claims."""
    path: Path = tmp_path_factory.mktemp("loops") / "loops.txt"
    find_loops(random_square(2, seed=4), certificate=path)
    whole = path.read_text(encoding="utf-8").splitlines()
    return [line.partition("\t")[0] for line in whole]


def entries(texts: list[str]) -> tuple[str, list[dict]]:
    header, *loops, _ = texts
    return header, [json.loads(text) for text in loops]


def no_integers(*given: object) -> None:
    raise AssertionError("integers are asked")


def test_floats_verify_loops_alone(texts, monkeypatch) -> None:
    monkeypatch.setattr(LoopVerifier, "refusal", no_integers)
    monkeypatch.setattr(Tube, "__init__", no_integers)
    verifier = TUBES_IN_FLOATS.verifier(texts[0])
    for number, text in enumerate(texts[1:-1]):
        assert verifier.refusal(text, number) is None


def test_bounds_in_floats_hold_those_in_integers(texts) -> None:
    header, loops = entries(texts)
    equations = LoopSheet(LOOPS.header(header)).equations
    make = partial(check._TubeInFloats, check._Equations.of(equations))
    for step in loops[0]["evidence"]["steps"][:3]:
        quick, exact = tube_of(equations, step, make), tube_of(equations, step)
        for h in (Fraction(0), exact.reach / 2, exact.reach):
            ball, other = quick.enclosure(h), exact.enclosure(h)
            for x, r, y, s in zip(ball.centre, ball.radii, other.centre, other.radii, strict=True):
                assert abs(x - y) <= r + s  # both hold the same configuration
            assert max(other.radii) <= 2 * max(ball.radii)
        assert abs(float(quick.apart / exact.apart) - 1) < 0.1


@pytest.mark.parametrize("key", ["reach", "centre", "exit", "row"])
def test_what_floats_do_not_verify_is_refused_by_integers(texts, key) -> None:
    header, (first, *_) = entries(texts)
    step = first["evidence"]["steps"][2]
    if key == "centre":
        step[key][4] += 1 << 50
    elif key == "row":
        step[key] = [-x for x in step[key]]
    else:
        step[key] *= 3
    text = json.dumps(first)
    expected = LoopVerifier(header).refusal(text, 0)
    assert expected is not None
    assert TUBES_IN_FLOATS.verifier(header).refusal(text, 0) == expected


def test_long_coordinates_are_left_to_integers(texts, monkeypatch) -> None:
    header, (first, *_) = entries(texts)
    monkeypatch.setattr(check, "_BITS", 10)
    verifier = TUBES_IN_FLOATS.verifier(header)
    assert check._Equations.of(verifier.sheet.equations) is None
    assert verifier.refusal(json.dumps(first), 0) is None
