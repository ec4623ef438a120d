"""The certificate of a count: the same lines as a stream writes, and one format for all roots."""

from __future__ import annotations

import json
import pickle
from pathlib import Path
from typing import Any

import pytest
from old_listing import old_listing
from sampling import slow_after
from sheets import SQUARE, TRIANGLE, dart, reflex_corners, scrambled, straight_side, with_point

from exactfold import PROVED, CreasePattern, check, checker, random_square
from exactfold.branches import certificate, count_branches, stream_branches
from exactfold.branches.certificates import listing
from exactfold.branches.certificates.check import check_compact
from exactfold.branches.counting import lines
from exactfold.certificates import write_certificate
from exactfold.checker.branches.compact import CHAMBERS, ROOTS
from exactfold.errors import NotApplicableError
from exactfold.pattern.data import SHEETS
from exactfold.pattern.degenerate import DEGENERATE
from exactfold.pattern.families import FAMILIES, hypar

SIMPLE = {
    **{name: random_square(size, seed=size) for size, name in ((2, "two"), (5, "five"))},
    "several blocks": random_square(11, seed=1),
    "dart": dart(),
    "straight side": straight_side(smallest=True),
    "reflex": scrambled(4, reflex_corners(4), 3),
    "rigid vertex": with_point(random_square(3, seed=1), 1, (1, 2, 2)),
    "cross": DEGENERATE["cross"](),
    "straight path": DEGENERATE["straight-path"](),
}
"""Sheets with one simple root for each sign vector."""

OTHERS = {
    "flat-vertex": ("algebraic", FAMILIES["flat-vertex"]()),
    "grid": ("algebraic", DEGENERATE["grid"]()),
    "bent-off-path": ("algebraic", DEGENERATE["bent-off-path"]()),
    "hypar": ("algebraic", hypar(1, twist=0)),
    "chord": ("isolated", with_point(CreasePattern(SQUARE, [(0, 1, 2), (0, 2, 3)]), 0, (1, 1, 1))),
    "waterbomb": ("single vertex", FAMILIES["waterbomb"]()),
    "triangle": ("rigid", scrambled(1, TRIANGLE, 2)),
}
"""Sheets of which version 1 cannot speak, and the kind of their evidence."""


@pytest.mark.parametrize(
    "name", slow_after(len(SIMPLE) - 1, sorted(SIMPLE, key=lambda name: SIMPLE[name].Vi))
)
def test_a_count_writes_what_a_stream_writes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    monkeypatch.setattr(lines, "FEW", 0)  # plain floats end elsewhere in the last digit
    counted, streamed = tmp_path / "counted.txt", tmp_path / "streamed.txt"
    result = count_branches(SIMPLE[name])
    made = certificate(result)
    write_certificate(made, counted)
    assert stream_branches(SIMPLE[name], streamed).complete
    assert counted.read_bytes() == streamed.read_bytes()
    assert json.loads(made[0])["version"] == CHAMBERS
    assert check_compact(counted) == checker.check(made)
    assert check(made).claims == check(counted).claims
    assert checker.check(made)["distinct"] == result.distinct


@pytest.mark.parametrize("name", SHEETS)
def test_shipped_patterns_have_a_certificate_in_lines(tmp_path: Path, name: str) -> None:
    """Of both versions; it claims what the listing of earlier versions claims, but no branches."""
    result = count_branches(name)
    assert result.status is PROVED
    made = certificate(result)
    write_certificate(made, tmp_path / "c.txt")
    claims = dict(checker.verify(tmp_path / "c.txt"))
    assert claims == dict(checker.check(made))
    known = dict(checker.check(old_listing(result)))
    assert len(known.pop("branches")) == len(result)
    assert claims == known


@pytest.mark.parametrize("name", OTHERS)
def test_other_roots_are_listed_one_by_one(tmp_path: Path, name: str) -> None:
    kind, pattern = OTHERS[name]
    result = count_branches(pattern)
    made = certificate(result)
    header = json.loads(made[0])
    assert (header["version"], header["evidence"]["kind"]) == (ROOTS, kind)
    entries = [entry for line in made[1:-1] for entry in json.loads(line)["roots"]]
    assert [entry["vertex_signs"] for entry in entries] == [b.sign_text for b in result.branches]
    write_certificate(made, tmp_path / "c.txt")
    for fast in (True, False):
        claims = check_compact(tmp_path / "c.txt", fast=fast)
        assert (claims["distinct"], claims["real"]) == (result.distinct, result.real)


@pytest.mark.parametrize("method", ["popping", "homotopy", "groebner"])
def test_other_methods_prove_by_boxes(method: str) -> None:
    result = count_branches(random_square(3, seed=1), method=method)
    made = certificate(result)
    header = json.loads(made[0])
    assert (header["version"], header["evidence"]["kind"]) == (ROOTS, "isolated")
    assert header["provenance"]["method"] == method
    assert checker.check(made)["distinct"] == 8


def test_a_line_is_never_longer_than_what_is_read(monkeypatch: pytest.MonkeyPatch) -> None:
    result = count_branches(DEGENERATE["ring"]())
    whole = certificate(result)
    monkeypatch.setattr(listing, "MOST_LINE", 2000)
    split = certificate(result)
    assert (len(whole), len(split)) == (3, len(split))
    assert len(split) > 5
    assert max(map(len, split[1:-1])) < 2000
    assert checker.check(split) == checker.check(whole)
    monkeypatch.setattr(listing, "MOST_LINE", 200)
    with pytest.raises(NotApplicableError, match="it would have a line of"):
        certificate(result)


def test_lines_are_a_value() -> None:
    made = certificate(count_branches(random_square(2, seed=1)))
    again: Any = pickle.loads(pickle.dumps(made))
    assert again == made
    assert again.text == made.text
    assert repr(made) == "<CertificateLines: 3 lines>"


def test_results_with_a_proof_compare_and_pickle() -> None:
    result = count_branches(random_square(3, seed=1))
    again = pickle.loads(pickle.dumps(result))
    assert again == result == count_branches(random_square(3, seed=1))
    assert certificate(again) == certificate(result)


def test_what_was_streamed_has_no_other_certificate(tmp_path: Path) -> None:
    streamed = stream_branches(random_square(2, seed=1), tmp_path / "c.txt")
    with pytest.raises(NotApplicableError, match="no certificate"):
        certificate(streamed)
