"""Forged compact certificates of version 2, whose roots are listed one by one."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from certificates import nodes, replaced, type_changes
from compact_files import bodies
from forge import (
    FIXTURES,
    Lines,
    beyond,
    chained,
    given,
    given_lines,
    refused_lines,
    verified_lines,
)
from old_listing import as_lines
from sampling import slow_after

from exactfold import checker
from exactfold.branches import read_branches
from exactfold.branches.certificates.check import check_compact
from exactfold.checker.branches import compact_roots
from exactfold.checker.core.reading import (
    CertificateError,
    FormatError,
    LimitError,
    UnfinishedError,
)
from exactfold.errors import CertificateFormatError

NAMES = sorted(path.stem for path in FIXTURES.glob("compact-roots-*.txt"))
CHORD, FOURS = "compact-roots-chord", "compact-roots-blocks-of-4"
OLD = sorted(
    path.stem
    for path in FIXTURES.glob("*.json")
    if path.name.startswith(("listing", "algebraic", "rigid", "single"))
)


def test_there_is_one_of_each_kind_of_evidence() -> None:
    kinds = {given_lines(name)[0]["evidence"]["kind"] for name in NAMES}
    assert kinds == {"isolated", "algebraic", "rigid", "single vertex"}
    assert len(given_lines(FOURS)) == 9


@pytest.mark.parametrize("name", OLD)
@pytest.mark.parametrize("block", slow_after(1, [3, 1, 256]))
def test_listings_of_earlier_versions_hold_as_lines(name: str, block: int) -> None:
    old = given(name)
    claims = {key: claim for key, claim in old["claims"].items() if key != "branches"}
    assert dict(checker.check(as_lines(old, block))) == claims


# --- the header ----------------------------------------------------------------------------------


def header(name: str, **evidence: object) -> Lines:
    parts = given_lines(name)
    parts[0]["evidence"] |= evidence
    return parts


@pytest.mark.parametrize(
    ("forged", "message"),
    [
        (header(CHORD, roots=True), "roots is not a natural number"),
        (header(CHORD, roots="1"), "roots is not a natural number"),
        (header(CHORD, roots=-1), "roots is not a natural number"),
        (header(CHORD, block=True), "block is not a natural number"),
        (header(CHORD, block=-1), "block is not a natural number"),
        (header(CHORD, block=0), "malformed: ZeroDivisionError while checking"),
        (header(CHORD, kind="chambers"), "unknown kind of evidence 'chambers'"),
        (
            header(CHORD, more=1),
            "evidence: expected an object with the keys kind triangles chart roots",
        ),
        (
            header("compact-roots-rigid", block=1),
            "evidence: expected an object with the keys kind triangles",
        ),
    ],
)
def test_forged_headers(forged: Lines, message: str) -> None:
    refused_lines(forged, message)


@pytest.mark.parametrize(
    ("evidence", "message"),
    [
        ([], "the evidence is not an object"),
        (["roots"], "malformed: TypeError while checking"),
        (None, "malformed: TypeError while checking"),
        ("roots", "malformed: TypeError while checking"),
    ],
)
def test_evidence_that_is_no_object(evidence: object, message: str) -> None:
    parts = given_lines(CHORD)
    parts[0]["evidence"] = evidence
    refused_lines(parts, message)


def test_versions_say_what_the_evidence_may_be() -> None:
    """Chambers belong to version 1, and all else to version 2."""
    parts = given_lines("compact-convex")
    parts[0]["version"] = 2
    refused_lines(parts, "unknown kind of evidence 'chambers'")
    parts = given_lines(CHORD)
    parts[0]["version"] = 1
    message = "evidence: expected an object with the keys kind triangles chart block"
    refused_lines(parts, message)
    for version in (True, 0, 3, "2"):
        parts[0]["version"] = version
        refused_lines(parts, f"version {version!r} is not known to this checker", FormatError)


# --- the blocks ----------------------------------------------------------------------------------


def moved(parts: Lines) -> None:
    """The first root of the second block stands at the end of the first."""
    parts[1]["roots"].append(parts[2]["roots"].pop(0))


def exchanged(parts: Lines) -> None:
    parts[1], parts[2] = parts[2], parts[1]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (moved, "block 0: roots does not have 4 entries"),
        (exchanged, "block 0 is expected, but here is block 1"),
        (
            lambda parts: parts[1].update(block=False),
            "block 0 is expected, but here is block False",
        ),
        (lambda parts: parts[2].update(block=True), "block 1 is expected, but here is block True"),
        (
            lambda parts: parts[1].update(more=1),
            "block 0: expected an object with the keys block roots",
        ),
        (lambda parts: parts[1].update(roots={}), "block 0: roots is not a list"),
        (lambda parts: parts[1]["roots"][0].pop("root"), "malformed: KeyError while checking"),
        (
            lambda parts: parts[1]["roots"][0].update(more=1),
            "branch 0: expected an object with the keys vertex_signs assignment multiplicity "
            "representative",
        ),
        (
            lambda parts: parts.insert(-1, {"block": 7, "roots": []}),
            "the last line: expected an object with the keys claims",
        ),
        (lambda parts: parts.append(parts[-1]), "a line follows the claims"),
    ],
)
def test_forged_blocks(change: Callable[[Lines], object], message: str) -> None:
    parts = given_lines(FOURS)
    assert verified_lines(parts)["distinct"] == 26
    change(parts)
    refused_lines(parts, message)


def test_files_that_are_not_finished() -> None:
    parts = given_lines(FOURS)
    refused_lines(parts[:-1], "all 7 blocks hold, but the claims are missing", UnfinishedError)
    said = "only {} of 7 blocks are there, and no root is checked"
    refused_lines(parts[:-2], said.format(6), UnfinishedError)
    refused_lines(parts[:1], said.format(0), UnfinishedError)
    parts[1]["roots"][0]["multiplicity"] = 7
    refused_lines(parts[:-2], said.format(6), UnfinishedError)
    refused_lines(parts[:-1], "branch 0: multiplicity is 2")
    rigid = given_lines("compact-roots-rigid")
    message = "all 0 blocks hold, but the claims are missing"
    refused_lines(rigid[:1], message, UnfinishedError)


def test_how_much_a_file_may_ask_for(monkeypatch: pytest.MonkeyPatch) -> None:
    parts = header(CHORD, roots=2**20 + 1)
    message = beyond("the roots", 1048577, 1048576, "MOST_ENTRIES")
    refused_lines(parts, message, LimitError)
    parts = given_lines(FOURS)
    size = sum(len(json.dumps(part, separators=(",", ":"))) for part in parts[1:-1])
    monkeypatch.setattr(compact_roots, "MOST_BYTES", size)
    assert verified_lines(parts)["distinct"] == 26
    monkeypatch.setattr(compact_roots, "MOST_BYTES", size - 1)
    message = beyond("the bytes of the blocks", size, size - 1, "MOST_BYTES")
    refused_lines(parts, message, LimitError)


# --- roots and branches --------------------------------------------------------------------------


@pytest.mark.parametrize("name", NAMES)
def test_what_an_entry_says_is_verified(name: str) -> None:
    """Another sign, letter, number or side of the first branch of a block is refused."""
    swap = str.maketrans("+-0MVFU", "-++VMVM")
    parts = given_lines(name)
    for line in parts[1:-1]:
        kept = line["roots"][0]
        for key, message in (
            ("vertex_signs", "not what is claimed"),
            ("assignment", "not what is claimed"),
            ("multiplicity", "multiplicity is"),
            ("representative", "not what is claimed"),
        ):
            other = {
                "multiplicity": kept["multiplicity"] + 1,
                "representative": "either" if kept["representative"] == "saddle" else "saddle",
            }.get(key) or kept[key][0].translate(swap) + kept[key][1:]
            line["roots"][0] = kept | {key: other}
            with pytest.raises(CertificateError, match=message):
                verified_lines(parts)
        line["roots"][0] = kept
    assert verified_lines(parts) == parts[-1]["claims"]


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("compact-roots-groebner", "two boxes meet"),
        ("compact-roots-classes", "two boxes meet"),
        ("compact-roots-blocks-of-4", "multiplicities add up to 31, not 2^5"),
        ("compact-roots-flat-box", "two boxes meet"),
        ("compact-roots-reflex", "two boxes meet"),
    ],
)
def test_a_root_given_twice_is_refused(name: str, message: str) -> None:
    parts = given_lines(name)
    roots = parts[1]["roots"]
    roots[1] = roots[0]
    refused_lines(parts, message)


@pytest.mark.parametrize("name", NAMES)
def test_every_claim_is_verified(name: str) -> None:
    for key, claim in given_lines(name)[-1]["claims"].items():
        parts = given_lines(name)
        parts[-1]["claims"][key] = claim + 1 if type(claim) is int else f"{claim} "
        refused_lines(parts, f"claim {key} = {parts[-1]['claims'][key]!a}, but it is {claim!a}")
        del parts[-1]["claims"][key]
        with pytest.raises(CertificateError, match="claims: expected an object with the keys"):
            verified_lines(parts)
    parts[-1]["claims"] = {**given_lines(name)[-1]["claims"], "branches": []}
    with pytest.raises(CertificateError, match="claims: expected an object with the keys"):
        verified_lines(parts)


def test_both_checkers_say_the_same(tmp_path_factory: pytest.TempPathFactory) -> None:
    path = tmp_path_factory.mktemp("roots") / "c.txt"
    for name in NAMES:
        data = (FIXTURES / f"{name}.txt").read_bytes()
        path.write_bytes(data)
        for workers in (1, 2):
            assert check_compact(path, workers=workers) == dict(checker.verify(path, workers))
        parts = bodies(data)
        parts[-1]["claims"]["real"] += 1
        path.write_bytes(chained(parts))
        for fast in (True, False):
            with pytest.raises(CertificateError, match="real = "):
                check_compact(path, fast=fast)


def changed(name: str, values: Callable[[object], Iterator[object]]) -> Iterator[Lines]:
    """The file with one value exchanged, for each value of each line but the provenance."""
    parts = given_lines(name)
    for number, line in enumerate(parts):
        for path, value in nodes(line):
            if path and path[0] != "provenance":
                for other in values(value):
                    yield [*parts[:number], replaced(line, path, other), *parts[number + 1 :]]


@pytest.mark.parametrize(
    "name", slow_after(1, [CHORD, "compact-roots-classes", "compact-roots-rigid"])
)
def test_a_value_of_another_type_is_refused(name: str) -> None:
    """By an error of the checker; what is accepted says the same."""
    claims, tried = given_lines(name)[-1]["claims"], 0
    for forged in changed(name, type_changes):
        tried += 1
        with contextlib.suppress(CertificateError, FormatError):
            assert verified_lines(forged) == claims
    assert tried > 300


@pytest.mark.slow
def test_no_malformed_entry_gets_past_the_reader(tmp_path: Path) -> None:
    """Reading trusts the claims of a branch, and raises no error of another class."""
    path, refusals = tmp_path / "c.txt", 0
    for forged in changed("compact-roots-classes", lambda value: iter((None, [], {}, "", -1))):
        path.write_bytes(chained(forged))
        try:
            list(read_branches(path))
        except (CertificateError, CertificateFormatError):
            refusals += 1
    assert refusals > 100
