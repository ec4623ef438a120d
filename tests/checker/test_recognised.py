"""Files that are taken for certificates are called what they are."""

from __future__ import annotations

import json
import re
from concurrent.futures import BrokenExecutor
from pathlib import Path
from typing import Any

import pytest
from forge import FIXTURES, chained, given, given_lines, unreadable

from exactfold import checker
from exactfold.checker import command
from exactfold.checker.branches.compact import COMPACT
from exactfold.checker.command import kind_in_lines

NO_FORMAT = 'the object has no "format" that this checker knows'
FOLD = "this is a FOLD file, which is a crease pattern and not a certificate"
COUNT = (
    "this is the result printed by count --json, and not a certificate; write a certificate with "
    "--certificate or --stream"
)
STREAM = (
    "this is the result printed by count --json, and not a certificate; check the file that "
    "--stream wrote"
)
BRANCH = (
    "this is the result printed by branch --json, and not a certificate; write a certificate with "
    "--certificate"
)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        ({"vertices_coords": [[0.5, 1]]}, FOLD),
        ({"faces_vertices": []}, FOLD),
        ({"edges_vertices": [], "x": 0.5}, FOLD),
        ({"file_spec": 1.1}, FOLD),
        ({"format": "exactfold count result", "seconds": 0.5}, COUNT),
        ({"format": "exactfold count-stream result"}, STREAM),
        ({"format": "exactfold branch result", "vertex_signs": {}}, BRANCH),
        ({"pattern": {}, "a": 0.5}, "a certificate holds no floats, but here is 0.5"),
        ({"status": "proved"}, NO_FORMAT),
        ({"format": ["exactfold branch"]}, NO_FORMAT),
        ({"format": "exactfold certificate", "kind": 2}, "the kind 2 is not known to this checker"),
        (["vertices_coords"], NO_FORMAT),
        ([0.5], "a certificate holds no floats, but here is 0.5"),
    ],
)
def test_strangers(data: Any, message: str) -> None:
    unreadable(json.dumps(data), message)
    if isinstance(data, dict):
        unreadable(f"\n {json.dumps(data)} \n", message)


def test_several_results() -> None:
    """As `count --jsonl` writes them, be it only one."""
    several = (
        "this is a file of results, as count --jsonl writes it, and not a certificate; "
        "count one pattern with --certificate or --stream"
    )
    line = json.dumps({"format": "exactfold batch-line result"})
    unreadable(line, several)
    unreadable(f"\n{line}\n{line}\n", several)


def test_strangers_that_cannot_be_read() -> None:
    for text in ("", "[" * 10**5, "{", "{'a': 1}"):
        with pytest.raises(checker.FormatError, match="not JSON, or cut off"):
            checker.load(text)


def said(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> tuple[int, str, str]:
    code = checker.main(arguments)
    captured = capsys.readouterr()
    return code, captured.out, captured.err


def test_main(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    usage = (2, "", "usage: python exactfold/checker CERTIFICATE [WORKERS]\n")
    for arguments in ([], ["a", "1", "2"], ["a", "x"], ["a", ""], ["a", "\u0662"], ["a", "12345"]):
        assert said(arguments, capsys) == usage
    listing, compact = (str(FIXTURES / n) for n in ("listing-cross.json", "compact-exact.txt"))
    sha = given("listing-cross")["claims"]["sha256"]
    valid = (
        "VALID: 2 branches (2 with multiplicity, 2 real) of the sheet with 1 interior and 4 "
        f"boundary vertices, sha256 {sha}\n"
    )
    for arguments in ([listing], [listing, "1"], [compact], [compact, "1234"]):
        assert said(arguments, capsys) == (0, valid, "")
    code, out, _ = said([str(FIXTURES / "branch-dart.json")], capsys)
    assert (code, out[:37]) == (0, "VALID: exactly one branch has the ver")
    path = tmp_path / "c.json"
    false = given("listing-cross")
    false["claims"]["sha256"] = "\x1b\n"
    path.write_text(json.dumps(false))
    assert said([str(path)], capsys) == (
        1,
        f"INVALID: claim sha256 = '\\x1b\\n', but it is '{sha}'\n",
        "",
    )
    path.write_text("[]")
    assert said([str(path)], capsys) == (
        3,
        "",
        f"not a certificate: {NO_FORMAT}\n",
    )
    path.write_bytes(b"\xff")
    code, out, err = said([str(path)], capsys)
    assert (code, out) == (3, "")
    assert err.startswith("not a certificate: 'utf-8' codec can't decode byte 0xff")
    code, out, err = said([str(tmp_path / "none")], capsys)
    assert (code, out) == (3, "")
    assert re.match(r"not a certificate: \[Errno 2\] No such file", err)


def test_no_shortage_and_no_defect_is_a_verdict(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    nothing = "a worker process died, or memory is short: nothing is known of the file\n"
    for error, message in ((MemoryError, nothing), (BrokenExecutor, nothing), (RuntimeError, None)):

        def fail(*_: object, error: type[Exception] = error) -> None:
            raise error("here")

        monkeypatch.setattr(command, "verify", fail)
        code, out, err = said(["c.json"], capsys)
        assert (code, out) == (70, "")
        assert err == message if message else "RuntimeError: here" in err


def test_workers_are_passed_on(monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[tuple[object, int]] = []
    monkeypatch.setattr(command, "verify", lambda path, workers: seen.append((path, workers)) or {})
    monkeypatch.setattr(command, "summary", lambda verified: "")
    checker.main(["c.json", "7"])
    checker.main(["c.json"])
    assert seen == [("c.json", 7), ("c.json", 1)]


def test_what_is_quoted_in_a_listing_does_not_make_it_compact(tmp_path: Path) -> None:
    """Nor does a compact certificate hold that says that it is a listing."""
    path = tmp_path / "c.json"
    document = given("listing-cross")
    document["provenance"] = {"a": "x" * 5000, "format": "exactfold compact certificate"}
    path.write_text(json.dumps(document))
    assert kind_in_lines(path) is not COMPACT
    assert checker.verify(path) == document["claims"]
    path.write_text("\n\n" + json.dumps(document, indent=1))
    assert checker.verify(path) == document["claims"]
    parts = given_lines("compact-exact")
    parts[0]["format"] = "exactfold certificate"
    path.write_bytes(chained(parts))
    assert kind_in_lines(path) is not COMPACT
    with pytest.raises(checker.FormatError, match='no "format" of a certificate that is writt'):
        checker.verify(path)


@pytest.mark.parametrize("name", ["listing-cross", "branch-dart", "motion-start", "panels-nested"])
def test_an_object_is_read_before_it_is_checked(name: str) -> None:
    """Also one that no file held: what another version claims may mean something else."""
    document = given(name)
    assert checker.check(document).kind.format == document["format"]
    with pytest.raises(checker.FormatError, match=r"^version 99 is not known to this checker$"):
        checker.check(document | {"version": 99})
    with pytest.raises(checker.FormatError, match=r"^the object: expected an object with the keys"):
        checker.check(document | {"more": 1})
