"""`exactfold count --stream`: what it prints, exit codes, and interruptions that lose nothing."""

from __future__ import annotations

import json
import os
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from exactfold import random_square
from exactfold.app.cli import app
from exactfold.app.commands import stream as stream_command
from exactfold.branches.counting import branch_blocks, by_theorem
from exactfold.branches.counting.stream import stream_branches
from exactfold.certificates.journal import Journal
from exactfold.errors import UnwritableFileError, WorkerDiedError
from exactfold.pattern import families, write_fold
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.data import example_path

PROVED, INVALID, USAGE, BAD_INPUT, UNDECIDED, INTERRUPTED = 0, 1, 2, 3, 4, 130
TWO, FLAT = example_path("two-vertex"), example_path("flat-vertex")


def run(*arguments: object) -> Result:
    return CliRunner().invoke(app, [str(a) for a in arguments])


def folded(path: Path, pattern: CreasePattern) -> Path:
    write_fold(pattern, path)
    return path


def test_the_branches_are_in_the_file_and_the_counts_are_shown(tmp_path: Path) -> None:
    file = tmp_path / "two.txt"
    result = run("count", TWO, "--stream", file)
    assert result.exit_code == PROVED
    assert "4 ways to start folding - PROVED" in result.stdout
    assert "all real, each counted once" in result.stdout
    assert result.stderr == ""
    for more in ((), ("--workers", 2)):
        checked = run("check", file, *more)
        assert checked.exit_code == PROVED
        assert checked.stdout.startswith("VALID: 4 branches")
    claims = json.loads(run("check", file, "--json").stdout)["claims"]
    assert claims["distinct"] == 4


def test_json_has_the_keys_of_count_and_one_more(tmp_path: Path) -> None:
    plain = json.loads(run("count", TWO, "--json").stdout)
    data = json.loads(run("count", TWO, "--json", "--stream", tmp_path / "c.txt").stdout)
    assert set(data) == set(plain) | {"stream"}
    for key in ("pattern", "status", "distinct", "with_multiplicity", "real", "nonreal"):
        assert data[key] == plain[key]
    for key in ("true_branches", "dimension", "degree"):
        assert data[key] == plain[key]
    assert data["branches"] == []
    assert set(data["stream"]) == {
        *("file", "blocks", "resumed", "unproved", "exact", "open", "groups", "cpu_seconds"),
    }
    assert data["stream"]["file"] == str(tmp_path / "c.txt")


def test_a_file_is_never_overwritten(tmp_path: Path) -> None:
    file = tmp_path / "c.txt"
    assert run("count", TWO, "--stream", file).exit_code == PROVED
    before = file.read_bytes()
    refused = run("count", TWO, "--stream", file)
    assert refused.exit_code == USAGE
    assert "--resume continues it" in refused.stderr
    again = run("count", TWO, "--stream", file, "--resume", "--json")
    assert again.exit_code == PROVED
    assert json.loads(again.stdout)["stream"]["resumed"] == 1
    assert file.read_bytes() == before
    other = run("count", FLAT, "--stream", file, "--resume")
    assert other.exit_code == BAD_INPUT
    assert "belongs to another pattern or version" in other.stderr
    assert file.read_bytes() == before


def test_multiple_roots_are_named_and_handed_over(tmp_path: Path) -> None:
    """The streamed run leaves two paths open that meet; the other methods prove them."""
    file, certificate = tmp_path / "c.txt", tmp_path / "c.json"
    result = run("count", FLAT, "--stream", file, "--certificate", certificate)
    assert result.exit_code == PROVED
    assert "2 of 4 sign vectors" in result.stdout
    assert "++, +- at +0" in result.stdout
    assert "3 ways to start folding - PROVED" in result.stdout
    assert run("check", file).exit_code == INVALID
    assert run("check", certificate).stdout.startswith("VALID: 3 branches (4 with multiplicity")


def test_what_stays_open_is_undecided(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("exactfold.branches.counting.stream.HANDED_OVER", 0)
    file, certificate = tmp_path / "c.txt", tmp_path / "c.json"
    given = ("count", FLAT, "--stream", file, "--certificate", certificate)
    result = run(*given)
    assert result.exit_code == UNDECIDED
    assert "2 of 4 solutions isolated" in " ".join(result.stdout.split())
    assert "sign vectors ++, +- seem to meet at +0: vertex 5 flat" in " ".join(
        result.stdout.split()
    )
    assert not certificate.exists()
    assert "the count is not proved" in result.stderr
    data = json.loads(run(*given, "--resume", "--json").stdout)
    assert data["status"] == "undecided"
    assert data["reason"] == (
        "2 of 4 solutions isolated; on the others vertex 5 looks flat: "
        "count without --stream also looks for multiple roots"
    )
    assert data["distinct"] is data["real"] is data["nonreal"] is data["degree"] is None
    assert data["stream"]["groups"] == {"+0": ["++", "+-"]}
    assert [root["signs"] for root in data["stream"]["open"]] == ["++", "+-"]


def test_both_methods_say_what_is_open(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        "exactfold.branches.counting.in_chart.flat_vertices", lambda chart, points: iter(())
    )
    monkeypatch.setattr("exactfold.branches.counting.in_chart.GROEBNER_LIMIT", 0)
    data = json.loads(run("count", FLAT, "--stream", tmp_path / "c.txt", "--json").stdout)
    assert data["status"] == "undecided"
    assert data["open_questions"][0].startswith("sign vectors ++, +- seem to meet at +0")
    assert len(data["open_questions"]) > 1
    assert len(data["branches"]) == 2


def test_a_certificate_is_not_written_twice(tmp_path: Path) -> None:
    file, certificate = tmp_path / "c.txt", tmp_path / "c.json"
    result = run("count", TWO, "--stream", file, "--certificate", certificate)
    assert result.exit_code == PROVED
    assert f"the proof is in {file}" in result.stderr
    assert not certificate.exists()


@pytest.mark.parametrize(
    ("options", "word"),
    [
        (["--resume"], "go with --stream"),
        (["--workers", "2"], "go with --stream"),
        (["--dask", "local"], "go with --stream"),
        (["--stream", "x.txt", "--method", "groebner"], "--method"),
        (["--stream", "x.txt", "--dask", "tcp://h:1", "--workers", "2"], "--dask local"),
    ],
)
def test_options_that_do_not_go_together(options: list[str], word: str) -> None:
    result = run("count", TWO, *options)
    assert result.exit_code == USAGE
    assert word in result.stderr
    assert not Path("x.txt").exists()


def test_patterns_that_are_not_streamed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stream_command, "ADVISED", 2)
    monkeypatch.setattr(by_theorem, "LIMIT", 3)
    triangle = CreasePattern([(0, 0), (1, 0), (0, 1)], [(0, 1, 2)])
    for k, (pattern, code, word) in enumerate(
        (
            (families.single_vertex(5), USAGE, "four boundary vertices"),
            (triangle, UNDECIDED, "no interior vertex"),
            (random_square(4, seed=1), UNDECIDED, "exactfold branch"),
        )
    ):
        file = tmp_path / f"{k}.txt"
        result = run("count", folded(tmp_path / f"{k}.fold", pattern), "--stream", file)
        assert result.exit_code == code
        assert word in result.stderr
        assert not file.exists()


def test_large_counts_are_told_of_the_faster_way(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stream_command, "ADVISED", 2)
    result = run("count", TWO, "--json")
    assert result.exit_code == PROVED
    assert result.stderr == "exactfold: 2^2 branches take less memory with --stream FILE\n"
    assert stream_command.advice(families.single_vertex(5)) is None
    monkeypatch.setattr(stream_command, "IN_MEMORY", 1)
    assert stream_command.advice(random_square(2, seed=1)) is None  # nothing is counted


def test_unwritable_files_are_bad_input(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    result = run("count", TWO, "--stream", tmp_path / "none" / "c.txt")
    assert result.exit_code == BAD_INPUT
    assert "exactfold: cannot write" in result.stderr
    assert "--resume" not in result.stderr

    def full(self: Journal, body: str) -> None:
        raise UnwritableFileError("cannot write: No space left on device")

    monkeypatch.setattr(Journal, "append", full)
    result = run("count", TWO, "--stream", tmp_path / "c.txt")
    assert result.exit_code == BAD_INPUT
    assert f"--stream {tmp_path / 'c.txt'} --resume" in result.stderr


def test_a_dead_worker_is_no_verdict(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def died(*_: object, **__: object) -> None:
        (tmp_path / "c.txt").write_text("some blocks")
        raise WorkerDiedError("a worker process died")

    monkeypatch.setattr("exactfold.branches.counting.stream.stream_branches", died)
    more = ("--workers", 3, "--seed", 0, "--certificate", "c.json")
    result = run("count", TWO, "--stream", tmp_path / "c.txt", *more)
    assert result.exit_code == 70
    assert "a worker process died; go on with" in result.stderr
    assert "--resume --workers 3 --certificate c.json\n" in result.stderr


SIGNALLED = """
import os, signal, sys
from contextlib import suppress
from exactfold.app.cli import main
from exactfold.certificates import journal
from exactfold.branches.counting import branch_blocks, engines, stream

append = journal.Journal.append

def then_signal(self, body):
    append(self, body)
    if self.blocks == 3:
        if os.environ["SENT_TO"] == "lost":
            with suppress(KeyboardInterrupt):  # as Python does while it collects garbage
                os.kill(os.getpid(), signal.SIGINT)
        elif os.environ["SENT_TO"] == "group":
            os.killpg(0, signal.SIGINT)
        else:
            os.kill(os.getpid(), signal.SIGTERM)

if __name__ == "__main__":
    journal.Journal.append, branch_blocks.BLOCK, engines.LEAST = then_signal, 16, 1
    main()
"""


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
@pytest.mark.parametrize(
    ("sent", "engine"),
    [
        pytest.param("group", "--workers 2", marks=pytest.mark.slow),
        ("process", "--workers 2"),
        ("lost", "--workers 1"),
        pytest.param("group", "--dask local", marks=pytest.mark.slow),
    ],
)
def test_interruptions_leave_a_file_to_resume(
    sent: str, engine: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Ctrl-C reaches all processes of a terminal, SIGTERM only the one that is meant."""
    if "dask" in engine:
        pytest.importorskip("distributed")
    pattern, script = random_square(8, seed=1), tmp_path / "run.py"
    script.write_text(SIGNALLED)
    fold, file = folded(tmp_path / "a pattern.fold", pattern), tmp_path / "c.txt"
    given = ["count", str(fold), "--stream", str(file), *engine.split()]
    done = subprocess.run(  # returns when every worker has closed stderr: none is left behind
        [sys.executable, str(script), *given],
        env={**os.environ, "SENT_TO": sent},
        capture_output=True,
        text=True,
        start_new_session=True,
        check=False,
    )
    assert done.returncode == INTERRUPTED, done.stderr
    first, again = done.stderr.splitlines()
    assert first == "exactfold: interrupted; go on with"
    kept = file.read_bytes()
    assert kept.count(b"\n") == 4

    monkeypatch.setattr(branch_blocks, "BLOCK", 16)
    words = shlex.split(again)
    assert (words[0], words[-2:]) == ("exactfold", engine.split())
    result = run(*words[1:-2], "--workers", 1, "--json")
    assert result.exit_code == PROVED
    assert json.loads(result.stdout)["stream"]["resumed"] == 3
    assert file.read_bytes().startswith(kept)
    stream_branches(pattern, tmp_path / "whole.txt")
    assert file.read_bytes() == (tmp_path / "whole.txt").read_bytes()


def test_an_interrupted_hand_over_can_be_resumed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stop(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    file = tmp_path / "c.txt"
    with monkeypatch.context() as patch:
        patch.setattr("exactfold.branches.counting.stream.count_branches", stop)
        result = run("count", FLAT, "--stream", file)
    assert result.exit_code == INTERRUPTED
    again = shlex.split(result.stderr.splitlines()[-1])
    assert run(*again[1:]).exit_code == PROVED


def test_every_command_ends_with_130_on_ctrl_c(monkeypatch: pytest.MonkeyPatch) -> None:
    def stop(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("exactfold.app.commands.count.counted_with_letters", stop)
    result = run("count", TWO)
    assert result.exit_code == INTERRUPTED
    assert result.stderr == "exactfold: interrupted\n"


def test_progress_names_what_is_verified_and_what_is_proved(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(branch_blocks, "BLOCK", 8)
    square, file = random_square(5, seed=1), tmp_path / "c.txt"

    def stop(stage: str, done: int, total: int) -> None:
        if done == 16:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        stream_branches(square, file, progress=stop)
    seen: list[tuple[str, int, int]] = []
    stream_branches(
        square,
        file,
        resume=True,
        progress=lambda *at: seen.append(at),
    )
    assert seen == [
        ("verifying", 0, 32),
        ("verifying", 8, 32),
        ("proving", 24, 32),
        ("proving", 32, 32),
    ]
