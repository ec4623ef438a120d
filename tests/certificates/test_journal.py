"""The file of a streamed count: one writer at a time, and on the disk when it says so."""

from __future__ import annotations

import errno
import io
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from compact_files import bodies, chained, chained_texts
from typer.testing import CliRunner

from exactfold import random_square
from exactfold._support.verdict import PROVED
from exactfold.app.cli import app
from exactfold.branches.counting import branch_blocks
from exactfold.branches.counting.stream import stream_branches
from exactfold.certificates import durable, journal
from exactfold.certificates.journal import Journal
from exactfold.errors import (
    ForeignJournalError,
    JournalInUseError,
    UnwritableFileError,
    UsageError,
)
from exactfold.pattern.data import example_path

TWO, SQUARE = example_path("two-vertex"), random_square(5, seed=1)
posix = pytest.mark.skipif(os.name != "posix", reason="locks of POSIX")


@pytest.fixture(autouse=True)
def _small_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(branch_blocks, "BLOCK", 8)


@pytest.fixture
def whole(tmp_path: Path) -> bytes:
    stream_branches(SQUARE, tmp_path / "whole.txt")
    return (tmp_path / "whole.txt").read_bytes()


@posix
def test_one_run_at_a_time_writes_a_file(tmp_path: Path, whole: bytes) -> None:
    """Others stop at once, whatever they meant to do, and the first loses nothing."""
    path, refusals = tmp_path / "c.txt", 0

    def others(stage: str, done: int, total: int) -> None:
        nonlocal refusals
        before = path.read_bytes()
        for how in ({}, {"resume": True}, {"replace": False}):
            with pytest.raises(JournalInUseError, match=str(path)):
                stream_branches(SQUARE, path, **how)
            refusals += 1
        assert path.read_bytes() == before

    stream_branches(SQUARE, path, progress=others)
    assert path.read_bytes() == whole
    path.write_bytes(whole[: len(whole) // 2])
    stream_branches(SQUARE, path, resume=True, progress=others)
    assert path.read_bytes() == whole
    assert refusals > 20


@posix
def test_the_command_names_the_file_in_use(tmp_path: Path) -> None:
    path = tmp_path / "c.txt"
    held = Journal(path, "{}")
    try:
        given = ["count", str(TWO), "--stream", str(path)]
        assert CliRunner().invoke(app, given).exit_code == 2  # it is there already
        result = CliRunner().invoke(app, [*given, "--resume"])
        assert result.exit_code == 3
        assert f"exactfold: another run is writing {path}" in result.stderr
    finally:
        held.close()


def test_a_file_that_appears_in_the_last_moment_is_left_alone(tmp_path: Path, whole: bytes) -> None:
    path = tmp_path / "whole.txt"
    with pytest.raises(UsageError, match="exists already"):
        stream_branches(SQUARE, path, replace=False)
    assert path.read_bytes() == whole
    path.write_bytes(b"")
    assert stream_branches(SQUARE, path, replace=False).status is PROVED
    assert path.read_bytes() == whole


KILLED = """
import os, signal, sys
from exactfold import random_square
from exactfold.certificates import journal
from exactfold.branches.counting import branch_blocks, engines, stream

append = journal.Journal.append

def then_die(self, body):
    append(self, body)
    if self.blocks == 2:
        os.kill(os.getpid(), signal.SIGKILL)

if __name__ == "__main__":
    journal.Journal.append, branch_blocks.BLOCK, engines.LEAST = then_die, 8, 1
    stream.stream_branches(random_square(5, seed=1), sys.argv[1], workers=2)
"""


@pytest.mark.slow
@posix
def test_a_run_that_is_killed_leaves_whole_blocks_and_no_lock(tmp_path: Path, whole: bytes) -> None:
    script, path = tmp_path / "run.py", tmp_path / "c.txt"
    script.write_text(KILLED)
    done = subprocess.run([sys.executable, str(script), str(path)], check=False)
    assert done.returncode == -9
    assert whole.startswith(path.read_bytes())
    assert stream_branches(SQUARE, path, resume=True).resumed == 2
    assert path.read_bytes() == whole


@posix
def test_file_systems_without_locks_are_written_all_the_same(
    tmp_path: Path, whole: bytes, monkeypatch: pytest.MonkeyPatch
) -> None:
    import fcntl

    def none(*_: object) -> None:
        raise OSError(errno.ENOLCK, "No locks available")

    monkeypatch.setattr(fcntl, "flock", none)
    stream_branches(SQUARE, tmp_path / "c.txt")
    assert (tmp_path / "c.txt").read_bytes() == whole


def test_claims_are_on_the_disk_when_the_run_ends(
    tmp_path: Path, whole: bytes, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, seen = tmp_path / "c.txt", list[int]()
    monkeypatch.setattr(journal, "synced", lambda file: seen.append(path.stat().st_size))
    stream_branches(SQUARE, path)
    header = whole.index(b"\n") + 1
    assert seen == [header, len(whole), len(whole)]  # begun, finished, closed
    monkeypatch.setattr(journal, "SYNC", -1.0)
    seen.clear()
    stream_branches(SQUARE, path)
    assert len(seen) == 3 + 4  # and each block


def test_what_cannot_be_brought_to_the_disk_is_no_certificate(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(number: int) -> None:
        raise OSError(number, os.strerror(number))

    monkeypatch.setattr(durable.os, "fsync", lambda _: fail(errno.EINVAL))  # a pipe, say
    assert stream_branches(SQUARE, tmp_path / "c.txt").status is PROVED
    monkeypatch.setattr(durable.os, "fsync", lambda _: fail(errno.EIO))
    with pytest.raises(UnwritableFileError, match="cannot write"):
        stream_branches(SQUARE, tmp_path / "c.txt")


def test_a_full_disk_leaves_a_file_to_resume(
    tmp_path: Path, whole: bytes, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Written in pieces, then not at all: the error is that of the write, not of the closing."""
    room, path = len(whole) - 300, tmp_path / "c.txt"

    class Full(io.FileIO):
        def write(self, data: object) -> int:
            left = room - os.fstat(self.fileno()).st_size
            if left <= 0:
                raise OSError(errno.ENOSPC, "No space left on device")
            return super().write(memoryview(data)[: min(left, 97)])  # type: ignore[arg-type]

    with monkeypatch.context() as patch:
        patch.setattr(journal, "locked", lambda path: Full(path, "a+"))
        with pytest.raises(UnwritableFileError, match="No space left"):
            stream_branches(SQUARE, path)
    assert path.read_bytes() == whole[:room]
    assert stream_branches(SQUARE, path, resume=True).resumed == 3
    assert path.read_bytes() == whole


@posix
@pytest.mark.parametrize("put_back", [False, True])
def test_a_file_taken_away_while_it_is_written_is_missed(put_back: bool, tmp_path: Path) -> None:
    path = tmp_path / "c.txt"

    def take(stage: str, done: int, total: int) -> None:
        if done == 16:
            path.unlink()
            if put_back:
                path.write_text("another")

    with pytest.raises(UnwritableFileError, match="removed or replaced"):
        stream_branches(SQUARE, path, progress=take)


@pytest.mark.parametrize("change", ["true", "1.0", "deep", "twice"])
def test_headers_that_only_look_the_same_are_foreign(
    change: str, tmp_path: Path, whole: bytes
) -> None:
    """What `check` would refuse is not continued."""
    texts = [json.dumps(line, separators=(",", ":")) for line in bodies(whole)]
    assert chained_texts(texts) == chained(bodies(whole)) == whole
    if change == "deep":
        texts[0] = '{"format":' + "[" * 10**5 + "]" * 10**5 + "}"
    elif change == "twice":
        texts[0] = '{"version":1,' + texts[0][1:]
    else:
        texts[0] = texts[0].replace('"version":1', f'"version":{change}')
    path = tmp_path / "c.txt"
    path.write_bytes(chained_texts(texts))
    with pytest.raises(ForeignJournalError, match="another pattern or version"):
        stream_branches(SQUARE, path, resume=True)
    assert path.read_bytes() == chained_texts(texts)
