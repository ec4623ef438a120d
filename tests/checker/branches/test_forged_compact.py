"""Forged compact certificates, with right digests, refused in integers."""

from __future__ import annotations

import base64
import json
import multiprocessing
from collections.abc import Callable
from typing import Any

import pytest
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
from forge_compact import EXACT, FOUR, moved

from exactfold import checker
from exactfold.checker import command
from exactfold.checker.branches import compact
from exactfold.checker.branches.compact import COMPACT
from exactfold.checker.branches.compact_blocks import CompactSheet
from exactfold.checker.command import kind_in_lines
from exactfold.checker.core import parts as sharing
from exactfold.checker.core.lines import digest, lines, read_object
from exactfold.checker.core.reading import CertificateError, FormatError, LimitError


def test_roots_may_be_given_exactly() -> None:
    for block, index in ((0, 0), (2, 3)):
        parts = given_lines(FOUR)
        moved(parts, block, index)
        assert verified_lines(parts) == parts[-1]["claims"]


# --- lines ---------------------------------------------------------------------------------------


def test_lines_are_chained_by_digests() -> None:
    data = (FIXTURES / f"{FOUR}.txt").read_bytes()
    assert verified_lines(data)["distinct"] == 16
    rows = data.splitlines(keepends=True)
    assert digest("", "a") == "ca978112ca1bbdcafac231b39a23dc4da786eff8147c4e72b9807785afee48bb"
    text = rows[0].partition(b"\t")[0] + b"\t"  # which is JSON, with a space at its end
    spaced = text + b"\t" + digest("", text.decode()).encode() + b"\n"
    for number, changed in (
        (1, data.replace(b'"version":1', b'"version":2', 1)),
        (1, data.replace(b"nappes", b"napp\xe9s")),
        (4, data.replace(b'"block":2', b'"block":3')),
        (3, b"".join([*rows[:2], *rows[3:]])),
        (6, data[:-1]),
        (6, data[:-2] + b"\n"),
        (6, data + b"\n"),
        (1, b"[" * 99 + b"\n"),
        (1, b"{}\n"),
        (7, data + b"more\n"),
        (1, spaced),
    ):
        number = 7 if changed == data + b"\n" else number
        message = f"line {number} is cut off or was altered"
        refused_lines(changed, message, FormatError)
    refused_lines(b"", "the file is empty", FormatError)


def test_the_first_line_may_have_been_read(tmp_path: Any) -> None:
    data = (FIXTURES / f"{FOUR}.txt").read_bytes()
    path = tmp_path / "c.txt"
    path.write_bytes(data)
    with open(path, "rb") as stream:
        first = stream.readline()
        assert len(list(lines(stream, first))) == 6
    assert compact.check(str(path)) == checker.verify(path) == given_lines(FOUR)[-1]["claims"]
    assert kind_in_lines(path) is COMPACT


def test_a_file_is_compact_by_the_format_in_its_first_line(tmp_path: Any) -> None:
    """However its header is written."""
    parts = given_lines(FOUR)
    late = [{"provenance": "x" * 9000, **{k: parts[0][k] for k in list(parts[0])[:-1]}}, *parts[1:]]
    texts = [json.dumps(part) for part in parts]
    texts[0] = texts[0].replace('"format"', '"f\\u006frmat"')
    last, escaped = "", ""
    for text in texts:
        last = digest(last, text)
        escaped += f"{text}\t{last}\n"
    path = tmp_path / "c.txt"
    for data in (chained(late), escaped.encode()):
        path.write_bytes(data)
        assert kind_in_lines(path) is COMPACT
        assert checker.verify(path)["distinct"] == 16
    for data in (b"", b"{}", b"\t\n", b"{}\tx\n", chained(parts)[:-5]):
        path.write_bytes(data)
        assert (kind_in_lines(path) is COMPACT) == (len(data) > 9)
    for text, message in (
        ('{"format" :\t "exactfold compact certificate"}', "line 1 is cut off or was altered"),
        (json.dumps(parts[0]), "line 1 is cut off or was altered"),
        (json.dumps(parts[0]) + "\t" + "0" * 64 + "\n", "line 1 is cut off or was altered"),
        ('{"a": "exactfold branch"}', 'the object has no "format" that this checker knows'),
    ):
        path.write_text(text)
        assert kind_in_lines(path) is not COMPACT
        with pytest.raises(FormatError) as caught:
            checker.verify(path)
        assert str(caught.value) == message


def test_lines_are_not_read_to_their_end(monkeypatch: pytest.MonkeyPatch, tmp_path: Any) -> None:
    from exactfold.checker.core import lines as compact_lines

    path = tmp_path / "c.txt"
    path.write_bytes((FIXTURES / f"{FOUR}.txt").read_bytes())
    longest = max(map(len, path.read_bytes().splitlines(keepends=True)))
    for most, right in ((longest, True), (longest - 1, False)):
        monkeypatch.setattr(compact_lines, "MOST_LINE", most)
        monkeypatch.setattr(command, "MOST_LINE", most)
        if right:
            assert checker.verify(path)["distinct"] == 16
        else:
            with pytest.raises(FormatError, match="line 1 is cut off or was altered"):
                checker.verify(path)


def test_objects_of_lines() -> None:
    for text, message in (
        ("[1]", "a line is not an object"),
        ('{"a":1,"a":2}', "a line: a key appears twice in one object"),
        ('{"a":1.5}', "a line: a certificate holds no floats, but here is 1.5"),
    ):
        with pytest.raises(FormatError) as caught:
            read_object(text, "a line")
        assert str(caught.value) == message
    assert read_object('{"a":1}', "a line") == {"a": 1}
    parts = given_lines(FOUR)
    keys = "format version pattern evidence provenance"
    for change, message in (
        (
            {"format": "exactfold certificate"},
            'the object has no "format": "exactfold compact certificate"',
        ),
        ({"version": 3}, "version 3 is not known to this checker"),
        ({"more": 1}, f"the object: expected an object with the keys {keys}"),
    ):
        forged = [{**parts[0], **change}, *parts[1:]]
        refused_lines(forged, message, FormatError)
    refused_lines([parts[0], [1], *parts[2:]], "block 0 is not an object", FormatError)  # type: ignore[list-item]
    assert compact.COMPACT.header(json.dumps(parts[0])) == parts[0]


# --- the header ----------------------------------------------------------------------------------


def header(**evidence: Any) -> Lines:
    parts = given_lines(FOUR)
    parts[0]["evidence"] |= evidence
    return parts


@pytest.mark.parametrize(
    ("forged", "message"),
    [
        (header(kind="isolated"), "unknown kind of evidence"),
        (header(more=1), "evidence: expected an object with the keys kind triangles chart block"),
        (header(block=3), "the size of a block does not divide the number of roots"),
        (header(block=32), "the size of a block does not divide the number of roots"),
        (header(block=0), "the size of a block does not divide the number of roots"),
        (header(block=-4), "block is not a natural number"),
        (header(block=True), "block is not a natural number"),
        (header(chart={"0": "1"}), "a chart other than the saddle's needs a reflex corner"),
        (
            header(triangles=[{"corners": [0, 1, 2], "inside": [4], "multipliers": ["1"]}]),
            "[0, 1, 2] is not a 3-cycle of edges",
        ),
        (header(triangles=None), "triangles is not a list"),
    ],
)
def test_headers(forged: Lines, message: str) -> None:
    refused_lines(forged, message)


FOURTH = "the sheet does not have four boundary vertices and an interior vertex"


def test_sheets_of_other_shapes() -> None:
    for name, message in (
        ("single-vertex-nine-folds", FOURTH),
        ("rigid-nested", FOURTH),
        ("listing-chord", "the number of unknowns is out of range"),
    ):
        other, forged = given(name), given_lines(FOUR)
        forged[0]["pattern"] = other["pattern"]
        forged[0]["evidence"]["triangles"] = other["evidence"]["triangles"]
        refused_lines(forged, message)
    forged[0]["pattern"] = {
        "vertices": [["0", "0"], ["1", "0"], ["1", "1"], ["0", "1"]],
        "triangles": [[0, 1, 2], [0, 2, 3]],
    }
    refused_lines(forged, FOURTH)
    forged[0]["pattern"] = 1  # type: ignore[assignment]
    refused_lines(forged, "malformed: TypeError in the first line")


def test_unknowns_are_at_most_forty() -> None:
    """With more, nothing is tried; 40 are as many as the header may ask for."""
    pattern = given("branch-random")["pattern"]
    assert len(pattern["vertices"]) == 44
    forged = given_lines(FOUR)
    forged[0]["pattern"] = pattern
    forged[0]["evidence"]["block"] = 3
    refused_lines(forged, "the size of a block does not divide the number of roots")
    forged[0]["evidence"]["block"] = 1 << 16
    sheet = CompactSheet(forged[0])
    assert (sheet.size, sheet.blocks) == (40, 1 << 24)
    forged[0]["evidence"]["block"] = 1 << 17
    message = beyond("the roots in a block", 1 << 17, 1 << 16, "MOST_BLOCK")
    refused_lines(forged, message, LimitError)
    from fractions import Fraction

    a, b, c = pattern["triangles"].pop()
    points = [[Fraction(x) for x in pattern["vertices"][v]] for v in (a, b, c)]
    middle = [str(sum(axis) / 3) for axis in zip(*points, strict=True)]
    pattern["vertices"].append(middle)
    pattern["triangles"] += [[a, b, 44], [b, c, 44], [c, a, 44]]
    refused_lines(forged, beyond("the unknowns", 41, 40, "MOST_UNKNOWNS"), LimitError)


# --- the end -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda parts: parts.pop(), "all 4 blocks hold, but the claims are missing"),
        (lambda parts: parts.append(parts[-1]), "a line follows the claims"),
        (lambda parts: parts.__delitem__(slice(3, None)), "only 2 of 4 blocks are there"),
        (
            lambda parts: parts[-1].update(more=1),
            "the last line: expected an object with the keys claims",
        ),
        (
            lambda parts: parts[-1]["claims"].pop("sha256"),
            "claims: expected an object with the keys interior boundary folds degrees_of_freedom "
            "sha256 distinct with_multiplicity real nonreal true_branches",
        ),
    ],
)
def test_files_that_end_otherwise(change: Callable[[Lines], Any], message: str) -> None:
    parts = given_lines(FOUR)
    change(parts)
    refused_lines(parts, message)


def test_every_claim_is_compared() -> None:
    for name in (EXACT, "compact-reflex"):
        for key, fact in given_lines(name)[-1]["claims"].items():
            others = [fact + 1, str(fact), [fact]] if type(fact) is int else [fact + " ", None]
            for other in [*others, False] if fact == 0 else others:
                forged = given_lines(name)
                forged[-1]["claims"][key] = other
                refused_lines(forged, f"claim {key} = {other!a}, but it is {fact!a}")


# --- workers -------------------------------------------------------------------------------------


def test_only_a_new_worker_keeps_the_verifier_of_a_file(monkeypatch: pytest.MonkeyPatch) -> None:
    header, text = (json.dumps(part) for part in given_lines(FOUR)[:2])
    not_kept = "only a new worker process may keep the verifier of a file"
    with pytest.raises(RuntimeError, match=not_kept):
        sharing._become_worker(compact.IntegerVerifier, header)
    with pytest.raises(RuntimeError, match="this process is not a worker of a check"):
        sharing._in_worker(text, 0)
    monkeypatch.setattr(multiprocessing, "parent_process", lambda: "as in a worker")
    monkeypatch.setattr(sharing, "_of_this_worker", None)  # forgotten after the test
    sharing._become_worker(compact.IntegerVerifier, header)
    assert sharing._in_worker(text, 0) is None
    with pytest.raises(RuntimeError, match=not_kept):
        sharing._become_worker(compact.IntegerVerifier, header)


def test_what_verifiers_answer() -> None:
    parts = given_lines(FOUR)
    verifier = compact.IntegerVerifier(json.dumps(parts[0]))
    text = json.dumps(parts[2])
    assert verifier.refusal(text, 1) is None
    assert verifier.refusal(text, 0) == "block 0 is expected, but here is block 1"
    bad = json.dumps({**parts[2], "open": [["a", "b"]]})
    assert verifier.refusal(bad, 1) == "malformed: TypeError in block 1"


def test_engines_may_be_others() -> None:
    started, seen = [], []

    class Verifier:
        def __init__(self, header: str) -> None:
            started.append(header)

        def refusal(self, text: str, number: int) -> str | None:
            seen.append((json.loads(text)["block"], number))
            return "no" if number == 2 else None

    engine = sharing.Engine(Verifier, 1, sharing.on_processes)
    with pytest.raises(CertificateError, match=r"^no$"):
        compact.check(str(FIXTURES / f"{FOUR}.txt"), 1, engine)
    assert seen == [(0, 0), (1, 1), (2, 2)]
    assert [json.loads(text) for text in started] == given_lines(FOUR)[:1]

    def share(*_: object) -> sharing.Said:
        raise AssertionError("processes are started")

    engine = compact.INTEGERS._replace(least=5, share=share)
    # There are too few blocks for processes.
    claims = checker.verify(FIXTURES / f"{FOUR}.txt", 2, lambda _: engine)
    assert claims == given_lines(FOUR)[-1]["claims"]
    assert base64.b64decode(given_lines(FOUR)[1]["radii"])
