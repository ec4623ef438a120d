"""Branches are read back from certificates as they were counted, whatever wrote these."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from compact_files import bodies, chained
from old_listing import as_lines, old_listing
from sheets import dart, reflex_corners, scrambled, with_point

from exactfold import checker, random_square
from exactfold.branches import certificate, count_branches, read_branches
from exactfold.branches.certificates.read import branches_of, read_listing
from exactfold.branches.counting import multiple_roots
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.roots import AlgebraicRoot, BoxRoot, FlatBoxRoot
from exactfold.errors import CertificateFormatError
from exactfold.pattern.degenerate import DEGENERATE
from exactfold.pattern.families import FAMILIES, hypar, two_vertex

FIXTURES = Path(__file__).parents[2] / "fixtures" / "certificates"
OLD = sorted(
    path.name
    for path in FIXTURES.glob("*.json")
    if path.name.startswith(("listing", "algebraic", "rigid", "single"))
)
ROOTS = sorted(path.name for path in FIXTURES.glob("compact-roots-*.txt"))

SHEETS = {
    **{name: build() for name, build in (FAMILIES | DEGENERATE).items()},
    "random": random_square(6, seed=2),
    "dart": dart(),
    "reflex": scrambled(4, reflex_corners(4), 3),
    "rigid vertex": with_point(two_vertex(), 1, (1, 2, 2)),
}


@pytest.mark.parametrize("name", SHEETS)
def test_branches_are_those_of_the_count(name: str) -> None:
    """With the same heights, to the last digit; so are those of a listing in one object."""
    result = count_branches(SHEETS[name])
    for given in (certificate(result), old_listing(result), as_lines(old_listing(result))):
        found = sorted(branches_of(given), key=Branch.sort_key)
        assert found == list(result.branches)
        assert [b.entry() for b in found] == [b.entry() for b in result.branches]


@pytest.mark.slow
def test_every_kind_of_root_is_read_back(monkeypatch: pytest.MonkeyPatch) -> None:
    result = count_branches(DEGENERATE["grid"]())
    found = list(branches_of(certificate(result)))
    assert {type(branch.root) for branch in found} == {BoxRoot, AlgebraicRoot}
    monkeypatch.setattr(multiple_roots, "GROEBNER_LIMIT", 0)
    result = count_branches(hypar(2, 0))
    found = list(branches_of(certificate(result)))
    assert FlatBoxRoot in {type(branch.root) for branch in found}
    assert found == list(result.branches)


@pytest.mark.parametrize("name", OLD)
def test_listings_of_earlier_versions_are_read(name: str) -> None:
    """Their branches are those that they claim, in the same order."""
    found = list(read_branches(FIXTURES / name))
    claimed = json.loads((FIXTURES / name).read_text())["claims"]["branches"]
    assert [_claim(branch) for branch in found] == claimed
    for branch in found:
        assert all(low <= high for low, high in branch.heights.values())


@pytest.mark.parametrize("name", ROOTS)
def test_entries_are_read(name: str) -> None:
    found = list(read_branches(FIXTURES / name))
    blocks = bodies((FIXTURES / name).read_bytes())[1:-1]
    entries = [entry for block in blocks for entry in block["roots"]]
    keys = ("vertex_signs", "assignment", "multiplicity", "representative")
    assert [_claim(branch) for branch in found] == [{k: e[k] for k in keys} for e in entries]


def _claim(branch: Branch) -> dict[str, Any]:
    return {
        "vertex_signs": branch.sign_text,
        "assignment": branch.assignment_text,
        "multiplicity": branch.multiplicity,
        "representative": branch.representative,
    }


@pytest.mark.parametrize("name", ["branch-dart.json", "loops-one-vertex.txt", "panels-bent.json"])
def test_other_certificates_list_no_branches(name: str) -> None:
    message = "does not list the branches of a triangulated sheet"
    with pytest.raises(checker.FormatError, match=message):
        read_listing(FIXTURES / name)
    with pytest.raises(CertificateFormatError, match=message):
        next(read_branches(FIXTURES / name))


def _file(tmp_path: Path, name: str, change: Any) -> Path:
    lines = bodies((FIXTURES / name).read_bytes())
    change(lines)
    path = tmp_path / "c.txt"
    path.write_bytes(chained(lines))
    return path


def _chart(lines: Any) -> None:
    lines[0]["evidence"]["chart"] = {"4": "1", "5": "1/7"}


def _wide(lines: Any) -> None:
    _interval(lines, "-1000000", "1000000")


def _away(lines: Any) -> None:
    _interval(lines, "1000000", "1000001")


def _interval(lines: Any, low: str, high: str) -> None:
    entry = next(e for e in lines[1]["roots"] if "class" in e["root"])
    assert Fraction(low) < Fraction(high)
    entry["root"]["interval"] = [low, high]


def _letters(lines: Any) -> None:
    lines[1]["roots"][0]["assignment"] = "X" * len(lines[1]["roots"][0]["assignment"])


def _flat(lines: Any) -> None:
    entry = next(e for e in lines[1]["roots"] if "flat" in e["root"])
    entry["root"]["flat"] = [4, 5, 6, 7]


@pytest.mark.parametrize(
    ("name", "change", "message"),
    [
        ("compact-roots-classes", _chart, "exactfold writes no branches in the chart"),
        ("compact-roots-blocks-of-4", _wide, "an interval holds more than one root"),
        ("compact-roots-blocks-of-4", _away, "an interval shows no root"),
        ("compact-roots-classes", _letters, "a branch has no letters"),
        ("compact-roots-flat-box", _flat, "no heights in the chart are flat at the flat vertices"),
        ("compact-roots-classes", lambda lines: lines[0].pop("pattern"), "the object: expected"),
        (
            "compact-roots-classes",
            lambda lines: lines[1]["roots"].pop(),
            "roots does not have 3 entries",
        ),
        ("compact-roots-classes", lambda lines: lines[1]["roots"][0].pop("root"), "malformed: Key"),
        ("compact-roots-classes", lambda lines: lines.pop(1), "block 0: expected an object with"),
    ],
)
def test_malformed_entries(tmp_path: Path, name: str, change: Any, message: str) -> None:
    path = _file(tmp_path, f"{name}.txt", change)
    error = CertificateFormatError if "the object" in message else checker.CertificateError
    with pytest.raises(error, match=message):
        list(read_branches(path))
