"""Forged blocks of compact certificates, with right digests, refused in integers."""

from __future__ import annotations

import json
from collections.abc import Callable

import pytest
from forge import (
    Document,
    Lines,
    given,
    given_lines,
    put,
    raw,
    refused_lines,
    verified_lines,
)
from forge_compact import EXACT, FOUR, SIZE, moved

from exactfold.checker.branches.compact_blocks import CompactSheet
from exactfold.checker.core.reading import CertificateError
from exactfold.checker.sheets.boxes import Box


def changed_bytes(line: int, key: str, change: Callable[[bytearray], None]) -> Lines:
    parts = given_lines(FOUR)
    data = raw(parts[line], key)
    change(data)
    put(parts[line], key, data)
    return parts


def set_byte(place: int, value: int) -> Callable[[bytearray], None]:
    def change(data: bytearray) -> None:
        data[place] = value

    return change


def test_the_same_box_for_two_sign_vectors() -> None:
    parts = given_lines(FOUR)
    for key, width in (("centers", SIZE * parts[1]["width"]), ("radii", 1), ("folds", 2)):
        data = raw(parts[1], key)
        data[width : 2 * width] = data[:width]
        put(parts[1], key, data)
    sheet = CompactSheet(parts[0])
    first = sheet.emptied.interior[0]
    refused_lines(parts, f"root 1: vertex {first} does not have the sign -1")


def test_every_sign_is_that_of_the_number() -> None:
    """Each root under the number that differs in one bit."""
    for place in range(SIZE):
        parts = given_lines("compact-convex")
        width = parts[1]["width"] * SIZE
        for key, size in (("centers", width), ("radii", 1), ("folds", 2)):
            data = raw(parts[1], key)
            rows = [bytes(data[k * size : (k + 1) * size]) for k in range(16)]
            put(parts[1], key, b"".join(rows[k ^ (1 << place)] for k in range(16)))
        vertex = CompactSheet(parts[0]).emptied.interior[place]
        refused_lines(parts, f"root 0: vertex {vertex} does not have the sign 1")


def test_every_letter_is_compared() -> None:
    sheet = CompactSheet(given_lines(FOUR)[0])
    block = sheet.decode(json.dumps(given_lines(FOUR)[2]), 1)
    folds = len(sheet.fold_rows)
    for index in (0, 3):
        true = sheet.letters(block, index)
        for k in range(folds):

            def flip(data: bytearray, index: int = index, k: int = k) -> None:
                data[index * sheet.letter_bytes + k // 8] ^= 1 << k % 8

            other = true[:k] + "MV"["VM".index(true[k])] * 0 + ("V" if true[k] == "M" else "M")
            other += true[k + 1 :]
            forged = changed_bytes(2, "folds", flip)
            refused_lines(forged, f"root {4 + index}: folds are {true}, not {other}")
    spare = folds % 8
    assert spare

    def beyond(data: bytearray) -> None:
        data[sheet.letter_bytes - 1] |= 1 << spare

    refused_lines(changed_bytes(2, "folds", beyond), "a bit of no fold is set")


def test_boxes_without_a_zero() -> None:
    for place in (2, SIZE * 6 + 2):
        forged = changed_bytes(1, "centers", set_byte(place, 0x55))
        with pytest.raises(CertificateError, match="Krawczyk's test fails for the box about"):
            verified_lines(forged)
    forged = changed_bytes(4, "radii", set_byte(3, 45))
    with pytest.raises(CertificateError, match="Krawczyk's test fails for the box about"):
        verified_lines(forged)


def test_radii() -> None:
    for radius in (53, 200, 254):
        forged = changed_bytes(1, "radii", set_byte(3, radius))
        refused_lines(forged, "root 3: no such radius")
    forged = changed_bytes(1, "radii", set_byte(3, 52))
    with pytest.raises(CertificateError, match="Krawczyk's test fails"):
        verified_lines(forged)
    forged = changed_bytes(1, "radii", set_byte(3, 255))
    refused_lines(forged, "root 3 is given twice or not at all")
    parts = given_lines(FOUR)
    moved(parts)
    radii = raw(parts[1], "radii")
    radii[0] = 0
    put(parts[1], "radii", radii)
    refused_lines(parts, "root 0 is given twice or not at all")


def accepted(check: Callable[[], None]) -> bool:
    try:
        check()
    except CertificateError:
        return False
    return True


def test_radii_are_powers_of_two() -> None:
    """The box of a root is just the one that its byte says, and only that root is looked at."""
    parts = given_lines(FOUR)
    sheet = CompactSheet(parts[0])
    block = sheet.decode(json.dumps(parts[1]), 0)
    center, letters = block.center(0, sheet.size), sheet.letters(block, 0)
    others = [False, True, True, True]
    found = set()
    for byte in range(20, 53):
        box = Box(center, 1 << byte, block.bits)
        changed = block._replace(radii=bytes([byte, 254, 254, 254]))
        right = accepted(lambda box=box: sheet.check_root(box, 0, letters))
        assert accepted(lambda changed=changed: sheet.check_block(changed, others)) == right
        found.add(right)
    assert found == {False, True}
    assert accepted(lambda: sheet.check_block(block))
    assert not accepted(lambda: sheet.check_block(changed, [True, False, True, True]))


def test_letters_may_fill_their_bytes() -> None:
    """16 folds take two bytes."""
    header = given_lines(FOUR)[0]
    header["pattern"] = given("algebraic-ring")["pattern"]
    header["evidence"] |= {"block": 1}
    sheet = CompactSheet(header)
    assert len(sheet.sheet.folds) == 16
    assert sheet.letter_bytes == 2


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"block": 1}, "block 0 is expected, but here is block 1"),
        ({"block": False}, "block 0 is expected, but here is block False"),
        ({"block": "0"}, "block 0 is expected, but here is block '0'"),
        ({"bits": 53}, "block 0 is out of range"),
        ({"bits": -1}, "bits is not a natural number"),
        ({"width": 0}, "block 0 is out of range"),
        ({"width": 9}, "block 0 is out of range"),
        ({"width": "6"}, "width is not a natural number"),
        ({"width": 5}, "block 0: centers has another length"),
        ({"centers": "!" * 128}, "block 0: centers is not base 64"),
        ({"radii": 1}, "block 0: radii is not base 64"),
        ({"radii": "AAAA"}, "block 0: radii has another length"),
        ({"folds": ""}, "block 0: folds has another length"),
        ({"folds": "\u00e9"}, "block 0: folds is not base 64"),
        ({"open": [[2, "flat"]]}, "root 2 is open: 'flat'"),
        ({"open": [[2]]}, "open root does not have 2 entries"),
        ({"open": [2]}, "open root is not a list"),
        ({"open": {}}, "open is not a list"),
        ({"open": [["a", "b"]]}, "malformed: TypeError in block 0"),
        ({"exact": {}}, "exact is not a list"),
        (
            {"exact": [1]},
            "exact root: expected an object with the keys root bits radius center assignment",
        ),
        (
            {"more": 1},
            "block 0: expected an object with the keys block bits width centers radii folds exact "
            "open",
        ),
    ],
)
def test_blocks_that_are_none(change: Document, message: str) -> None:
    parts = given_lines(FOUR)
    parts[1] |= change
    refused_lines(parts, message)


def test_the_number_of_an_open_root_is_that_of_the_file() -> None:
    parts = given_lines(FOUR)
    parts[3]["open"] = [[1, "\x1b"]]
    refused_lines(parts, "root 9 is open: '\\x1b'")


def test_small_widths_and_all_bits_are_read() -> None:
    """Centres in eight bytes, and in as many bits as are allowed."""
    parts = given_lines(FOUR)
    for line in parts[1:-1]:
        width = line["width"]
        data = raw(line, "centers")
        wide = b""
        for k in range(0, len(data), width):
            m = int.from_bytes(data[k : k + width], "little", signed=True)
            wide += (m << 52 - line["bits"]).to_bytes(8, "little", signed=True)
        radii = raw(line, "radii")
        put(line, "radii", bytes(r + 52 - line["bits"] for r in radii))
        put(line, "centers", wide)
        line["width"], line["bits"] = 8, 52
    assert verified_lines(parts) == parts[-1]["claims"]


EXACTLY: list[tuple[Document, str]] = [
    ({"root": True}, "root is not a natural number"),
    ({"root": 4}, "block 0 has no root 4"),
    ({"radius": "0"}, "the radius is not positive"),
    ({"radius": "\u0661"}, "'\\u0661' is not an integer"),
    ({"bits": 4001}, "root 0 is out of range"),
    ({"radius": "0" * 3999 + "12"}, "root 0 is out of range"),
    ({"center": ["0", "0", "0", "1" * 4001]}, "root 0 is out of range"),
    ({"center": ["0"]}, "center does not have 4 entries"),
    ({"assignment": 1}, "1 is not a number in quotes"),
    (
        {"more": 1},
        "exact root: expected an object with the keys root bits radius center assignment",
    ),
]


@pytest.mark.parametrize(("change", "message"), EXACTLY)
def test_exact_roots(change: Document, message: str) -> None:
    parts = given_lines(FOUR)
    moved(parts, **change)
    refused_lines(parts, message)


def test_exact_roots_at_the_limit() -> None:
    parts = given_lines(FOUR)
    moved(parts)
    entry = parts[1]["exact"][0]
    by = 4000 - entry["bits"]
    entry["center"] = [str(int(m) << by) for m in entry["center"]]
    entry["radius"], entry["bits"] = str(int(entry["radius"]) << by).rjust(4000, "0"), 4000
    assert verified_lines(parts)["distinct"] == 16


def test_exact_roots_are_given_once() -> None:
    parts = given_lines(FOUR)
    moved(parts, 1, 2)
    parts[2]["exact"] *= 2
    refused_lines(parts, "root 6 is given twice")
    parts = given_lines(FOUR)
    moved(parts, 1, 2)
    parts[2]["exact"][0]["root"] = 3
    refused_lines(parts, "root 6 is given twice or not at all")
    parts[2]["exact"][0]["root"] = 4
    refused_lines(parts, "block 1 has no root 4")


def test_letters_of_exact_roots() -> None:
    parts = given_lines(EXACT)
    letters = [entry["assignment"] for entry in parts[1]["exact"]]
    assert all("F" in text for text in letters)
    for index, text in enumerate(letters):
        for k, letter in enumerate(text):
            for other in {*"MVFU?"} - {letter}:
                forged = given_lines(EXACT)
                claimed = text[:k] + other + text[k + 1 :]
                forged[1]["exact"][index]["assignment"] = claimed
                if other == "U":
                    verified_lines(forged)
                else:
                    refused_lines(forged, f"root {index}: folds are {text}, not {claimed}")
