"""Compact certificates with anything wrong in them are refused, by both checkers."""

import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from compact_files import Lines, bodies, chained, listed_exactly, put, raw, refused
from sheets import nested_triangles, reflex_corners, scrambled

from exactfold import random_square
from exactfold.branches.certificates.check import check_compact
from exactfold.branches.certificates.read import read_branches
from exactfold.branches.counting import branch_blocks
from exactfold.branches.counting.stream import stream_branches
from exactfold.checker import CertificateError, FormatError
from exactfold.checker.branches.compact_blocks import UNPROVED
from exactfold.checker.core.lines import read_object
from exactfold.errors import CertificateFormatError, UnreadableFileError

SIZE, BLOCK = 6, 16


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    path = tmp_path_factory.mktemp("compact") / "c.txt"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(branch_blocks, "BLOCK", BLOCK)
        stream_branches(random_square(SIZE, seed=2), path)
    return path.read_bytes()


def flip_letter(lines: Lines) -> None:
    folds = raw(lines[2], "folds")
    folds[0] ^= 1
    put(lines[2], "folds", folds)


def swap_roots(lines: Lines) -> None:
    centers, width = raw(lines[1], "centers"), SIZE * lines[1]["width"]
    centers[:width], centers[width : 2 * width] = centers[width : 2 * width], centers[:width]
    put(lines[1], "centers", centers)


def repeat_root(lines: Lines) -> None:
    """The same right box for two sign vectors: the second is a lie."""
    for key, width in (("centers", SIZE * lines[1]["width"]), ("radii", 1), ("folds", 3)):
        data = raw(lines[1], key)
        data[width : 2 * width] = data[:width]
        put(lines[1], key, data)


def repeat_block(lines: Lines) -> None:
    lines[2] = {**lines[1], "block": 1}


def misnumbered_block(lines: Lines) -> None:
    lines[2] = dict(lines[1])


def missing_block(lines: Lines) -> None:
    del lines[-2]


def move_root(lines: Lines) -> None:
    centers = raw(lines[1], "centers")
    centers[2] ^= 0x10
    put(lines[1], "centers", centers)


def widen_box(lines: Lines) -> None:
    radii = raw(lines[3], "radii")
    radii[4] = 41
    put(lines[3], "radii", radii)


def narrow_box(lines: Lines) -> None:
    radii, centers = raw(lines[3], "radii"), raw(lines[3], "centers")
    radii[0] = 0
    centers[0] ^= 0x04
    put(lines[3], "radii", radii)
    put(lines[3], "centers", centers)


def leave_out(lines: Lines) -> None:
    radii = raw(lines[1], "radii")
    radii[3] = UNPROVED
    put(lines[1], "radii", radii)


def impossible_radius(lines: Lines) -> None:
    radii = raw(lines[1], "radii")
    radii[3] = 200
    put(lines[1], "radii", radii)


def given_twice(lines: Lines) -> None:
    entry = {"root": 0, "bits": 4, "radius": "1", "center": ["0"] * SIZE, "assignment": "M"}
    lines[1]["exact"] = [entry]


def spare_bit(lines: Lines) -> None:
    folds = raw(lines[1], "folds")
    folds[2] |= 0x80
    put(lines[1], "folds", folds)


def short_centers(lines: Lines) -> None:
    put(lines[1], "centers", raw(lines[1], "centers")[:-1])


def no_base64(lines: Lines) -> None:
    lines[1]["centers"] = "!" + lines[1]["centers"][1:]


def open_root(lines: Lines) -> None:
    lines[1]["open"] = [[2, "vertex 5 is flat"]]


def too_many_bits(lines: Lines) -> None:
    lines[1]["bits"] = 10**6


def another_claim(lines: Lines) -> None:
    lines[-1]["claims"]["real"] = 63


def true_for_one(lines: Lines) -> None:
    lines[-1]["claims"]["nonreal"] = False


def missing_claim(lines: Lines) -> None:
    del lines[-1]["claims"]["sha256"]


def no_claims(lines: Lines) -> None:
    del lines[-1]


def more_lines(lines: Lines) -> None:
    lines.append(lines[-1])


def moved_vertex(lines: Lines) -> None:
    lines[0]["pattern"]["vertices"][5][0] = "1/3"


def other_blocks(lines: Lines) -> None:
    lines[0]["evidence"]["block"] = 7


def other_kind(lines: Lines) -> None:
    lines[0]["evidence"]["kind"] = "isolated"


def exact_root_true(lines: Lines) -> None:
    listed_exactly(lines, root=True)


def exact_root_elsewhere(lines: Lines) -> None:
    listed_exactly(lines, root=BLOCK)


def exact_root_twice(lines: Lines) -> None:
    listed_exactly(lines)
    lines[1]["exact"] *= 2


def exact_point(lines: Lines) -> None:
    listed_exactly(lines, radius="0")


def exact_with_other_digits(lines: Lines) -> None:
    listed_exactly(lines, radius="\u0661")


def exact_without_end(lines: Lines) -> None:
    listed_exactly(lines, bits=8000)


def exact_long_center(lines: Lines) -> None:
    listed_exactly(lines, center=["1" * 9000] * SIZE)


def exact_flat_fold(lines: Lines) -> None:
    listed_exactly(lines)
    entry = lines[1]["exact"][0]
    entry["assignment"] = "F" + entry["assignment"][1:]


def chart_of_a_notch(lines: Lines) -> None:
    lines[0]["evidence"]["chart"] = {"0": "1"}


def no_such_triangle(lines: Lines) -> None:
    triangle = {"corners": [0, 1, 2], "inside": [4], "multipliers": ["1"]}
    lines[0]["evidence"]["triangles"] = [triangle]


LIES: dict[Callable[[Lines], None], str] = {
    flip_letter: "folds are",
    swap_roots: "does not have the sign",
    repeat_root: "root 1: vertex",
    repeat_block: "root 16: vertex",
    misnumbered_block: "block 1 is expected",
    missing_block: "an object with the keys block",
    move_root: "Krawczyk|does not have the sign",
    widen_box: "Krawczyk",
    narrow_box: "Krawczyk",
    leave_out: "root 3 is given twice or not at all",
    impossible_radius: "root 3: no such radius",
    given_twice: "root 0 is given twice",
    spare_bit: "a bit of no fold",
    short_centers: "centers has another length",
    no_base64: "centers is not base 64",
    open_root: "root 2 is open: 'vertex 5 is flat'",
    too_many_bits: "out of range",
    another_claim: "claim real = 63, but it is 64",
    true_for_one: "claim nonreal = False, but it is 0",
    missing_claim: "claims: expected an object",
    no_claims: "blocks hold, but the claims are missing",
    more_lines: "a line follows the claims",
    moved_vertex: "Krawczyk|face|sign",
    other_blocks: "does not divide",
    other_kind: "unknown kind",
    exact_root_true: "root is not a natural number",
    exact_root_elsewhere: "block 0 has no root 16",
    exact_root_twice: "root 0 is given twice",
    exact_point: "radius is not positive",
    exact_with_other_digits: "is not an integer",
    exact_without_end: "root 0 is out of range",
    exact_long_center: "root 0 is out of range",
    exact_flat_fold: "root 0: folds are",
    chart_of_a_notch: "needs a reflex corner",
    no_such_triangle: "is not a 3-cycle",
}


@pytest.mark.parametrize("lie", LIES, ids=lambda lie: lie.__name__)
def test_lies_with_right_digests_are_refused(
    lie: Callable[[Lines], None], written: bytes, tmp_path: Path
) -> None:
    lines = bodies(written)
    lie(lines)
    refused(chained(lines), tmp_path / "c.txt", LIES[lie])


def test_the_file_itself_is_accepted(written: bytes, tmp_path: Path) -> None:
    path = tmp_path / "c.txt"
    lines = bodies(written)
    path.write_bytes(chained(lines))
    assert path.read_bytes() == written
    assert check_compact(path) == check_compact(path, fast=False)
    listed_exactly(lines)
    path.write_bytes(chained(lines))
    assert check_compact(path) == check_compact(path, fast=False)


def test_random_bytes_of_a_block_never_pass_for_another_count(
    written: bytes, tmp_path: Path
) -> None:
    """Whatever is changed, the answer is a refusal or the same true claims."""
    source, path = random.Random(1), tmp_path / "c.txt"
    path.write_bytes(written)
    claims, refusals = check_compact(path), 0
    for _ in range(30):
        lines = bodies(written)
        line = lines[source.randrange(1, 5)]
        key = source.choice(("centers", "radii", "folds"))
        data = raw(line, key)
        data[source.randrange(len(data))] = source.randrange(256)
        put(line, key, data)
        path.write_bytes(chained(lines))
        try:
            assert check_compact(path) == claims
        except CertificateError:
            refusals += 1
    assert refusals > 15


@pytest.mark.parametrize(
    ("change", "match"),
    [
        (lambda data: data[:-1], "cut off or was altered"),
        (lambda data: data.replace(b'"block":2', b'"block":3'), "line 4 is cut off"),
        (lambda data: b"", "the file is empty"),
        (lambda data: b"{}\n", "line 1"),
        (lambda data: chained([{"format": "other"}]), "has no .format."),
        (lambda data: chained([{**bodies(data)[0], "version": 9}]), "version 9"),
        (
            lambda data: chained([{**bodies(data)[0], "more": 1}]),
            "expected an object with the keys",
        ),
        (lambda data: chained([{**bodies(data)[0], "more": 1.5}]), "float"),
        (lambda data: chained([{**bodies(data)[0], "more": 10**4001}]), "integer is too long"),
        (lambda data: data.replace(b"newton", b"n\xe9wton"), "line 1"),
        (lambda data: b"[" * 99 + b"\n", "line 1"),
    ],
)
def test_other_files_are_no_compact_certificates(
    change: Callable[[bytes], bytes], match: str, written: bytes, tmp_path: Path
) -> None:
    path = tmp_path / "c.txt"
    path.write_bytes(change(written))
    with pytest.raises(CertificateFormatError, match=match):
        check_compact(path)


def test_missing_files_are_unreadable(tmp_path: Path) -> None:
    with pytest.raises(UnreadableFileError):
        check_compact(tmp_path / "none")
    with pytest.raises(UnreadableFileError):
        next(read_branches(tmp_path / "none"))


def test_lines_of_json_that_is_no_object_are_refused() -> None:
    for text, match in (("[1]", "not an object"), ('{"a":1,"a":2}', "twice"), ("{", "not JSON")):
        with pytest.raises(FormatError, match=match):
            read_object(text, "a line")


@pytest.mark.parametrize("sheet", [nested_triangles(), scrambled(2, reflex_corners(2), 6)])
def test_triangulated_triangles_and_charts_are_rebuilt(sheet: Any, tmp_path: Path) -> None:
    stream_branches(sheet, tmp_path / "c.txt")
    lines = bodies((tmp_path / "c.txt").read_bytes())
    assert lines[0]["evidence"]["triangles"]
    lines[0]["evidence"]["triangles"] = []
    refused(chained(lines), tmp_path / "d.txt", "another length|malformed|does not divide|chart")
