"""Ends that are no answer: short of memory, interrupted while loading, output that is closed."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest
from running import BAD_INPUT, INTERRUPTED, OUTPUT_FAILED, PROVED, UNDECIDED, run
from sheets import DENTED, scrambled

from exactfold import random_square
from exactfold.pattern import write_fold
from exactfold.pattern.data import example_path

pytestmark = pytest.mark.skipif(os.name != "posix", reason="limits and signals of POSIX")

NO_MEMORY = 71
ROOT = Path(__file__).parents[3]


def shell(command: str, folder: Path, **more: str) -> subprocess.CompletedProcess[str]:
    """Run a line of shell, with `$exactfold` for the program."""
    path = os.pathsep.join([more.pop("FIRST", ""), str(ROOT), os.environ.get("PYTHONPATH", "")])
    environment = {
        **os.environ,
        "exactfold": f"{sys.executable} -m exactfold",
        "PYTHONPATH": path.lstrip(os.pathsep),
        **more,
    }
    return subprocess.run(
        command,
        shell=True,
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )


def written(folder: Path) -> list[Path]:
    """Four patterns of which each takes more memory than Python itself."""
    paths = [folder / f"{seed}.fold" for seed in range(4)]
    for seed, path in enumerate(paths):
        write_fold(random_square(5, seed=seed), path)
    return paths


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("files")
    two = example_path("two-vertex")
    listing = ROOT / "tests/fixtures/certificates/listing-two-vertices.json"
    (folder / "c.json").write_bytes(listing.read_bytes())
    assert run("count", two, "--stream", folder / "s.txt").exit_code == PROVED
    return folder


LIMITS: list[Any] = [200000]
LIMITS += [pytest.param(k, marks=pytest.mark.slow) for k in (60000, 300000)]
LIMITS += [
    pytest.param(k, marks=pytest.mark.survey)
    for k in (80000, 100000, 140000, 150000, 180000, 250000, 400000)
]


@pytest.mark.parametrize("limit", LIMITS)
@pytest.mark.parametrize("command", ["count two-vertex", "check c.json", "check s.txt"])
def test_no_shortage_of_memory_looks_like_a_verdict(files: Path, command: str, limit: int) -> None:
    done = shell(f"ulimit -v {limit}; $exactfold {command}", files)
    assert done.returncode in (PROVED, 70, NO_MEMORY), done.stderr
    if done.returncode == PROVED:
        assert done.stdout.startswith(("4 ways to start folding - PROVED", "VALID: 4 branches"))
    else:
        assert done.stdout == ""
        assert done.stderr.startswith("exactfold: ")
        assert len(done.stderr.splitlines()) == 1


@pytest.mark.slow
@pytest.mark.parametrize("limit", LIMITS)
def test_a_batch_that_is_short_of_memory_ends_and_goes_on(tmp_path: Path, limit: int) -> None:
    names, out = " ".join(map(str, written(tmp_path))), tmp_path / "o.jsonl"
    command = f"$exactfold count {names} --jsonl {out} --jobs 2"
    done = shell(f"ulimit -v {limit}; timeout 60 {command}", tmp_path)
    assert done.returncode in (PROVED, NO_MEMORY), done.stderr
    assert len(done.stderr.splitlines()) == (0 if done.stdout else 1)
    kept = out.read_bytes() if out.exists() else b""
    for line in map(json.loads, kept.splitlines()):
        assert (line["status"], line["exit_code"]) in (("proved", PROVED), ("failed", NO_MEMORY))
    again = shell(f"{command} --json", tmp_path)
    assert (again.returncode, again.stderr) == (PROVED, "")
    assert json.loads(again.stdout)["proved"] == 4
    assert out.read_bytes().startswith(kept)


@pytest.mark.parametrize("limit", LIMITS)
def test_streams_and_branches_that_are_short_of_memory_end(tmp_path: Path, limit: int) -> None:
    write_fold(random_square(14, seed=1), tmp_path / "p.fold")
    for command, said in (
        ("count p.fold --stream s.txt --workers 2", "16384 ways to start folding - PROVED"),
        ("branch p.fold --up 4,5", "PROVED"),
    ):
        done = shell(f"ulimit -v {limit}; timeout 60 $exactfold {command}", tmp_path)
        assert done.returncode in (PROVED, NO_MEMORY), done.stderr
        if done.returncode == PROVED:
            assert said in done.stdout
            assert done.stderr == ""
        else:
            assert done.stdout == ""
            assert done.stderr.startswith("exactfold: ")
            assert "Traceback" not in done.stderr
            assert "not enough memory" in done.stderr.splitlines()[0]


ENDS = "import ctypes; ctypes.CDLL(None).exit({code})"


@pytest.mark.parametrize("code", [0, 1, 4])
def test_a_library_that_ends_the_process_is_seen(files: Path, tmp_path: Path, code: int) -> None:
    (tmp_path / "numpy.py").write_text(ENDS.format(code=code))
    done = shell("ulimit -v 4000000; $exactfold count zigzags", files, FIRST=str(tmp_path))
    assert (done.returncode, done.stdout) == (NO_MEMORY, "")
    assert done.stderr == "exactfold: not enough memory: the program ended without an answer\n"


@pytest.mark.slow
def test_answers_and_errors_pass_through_the_guard(files: Path, tmp_path: Path) -> None:
    write_fold(scrambled(2, DENTED, 4, loose=True), tmp_path / "open.fold")
    (files / "bad.json").write_text(
        (files / "c.json").read_text().replace('"distinct":4', '"distinct":5')
    )
    for command, code in (
        ("count two-vertex", PROVED),
        (f"count {tmp_path / 'open.fold'} --limit 1e-9", UNDECIDED),
        ("check bad.json", 1),
        ("count none.fold", BAD_INPUT),
        ("count --guess", 2),
        ("--version", 0),
        ("count two-vertex > /dev/full", OUTPUT_FAILED),
    ):
        free = shell(f"$exactfold {command}", files)
        limited = shell(f"ulimit -v 4000000; $exactfold {command}", files)
        assert free.returncode == limited.returncode == code
        assert free.stderr == limited.stderr


@pytest.mark.parametrize(
    ("number", "code", "said"),
    [
        (signal.SIGINT, INTERRUPTED, "exactfold: interrupted\n"),
        (signal.SIGTERM, -signal.SIGTERM, ""),  # as without a limit, and no shortage of memory
    ],
)
def test_a_signal_reaches_the_guarded_program(
    files: Path, tmp_path: Path, number: int, code: int, said: str
) -> None:
    (tmp_path / "numpy.py").write_text("open('begun', 'w').close()\nimport time\ntime.sleep(60)")
    command = f"ulimit -v 4000000; exec {sys.executable} -m exactfold count zigzags"
    started = subprocess.Popen(
        command,
        shell=True,
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": f"{tmp_path}{os.pathsep}{ROOT}"},
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    while not (tmp_path / "begun").exists():
        assert started.poll() is None
        time.sleep(0.05)
    (os.killpg if number == signal.SIGINT else os.kill)(started.pid, number)
    assert started.communicate(timeout=20)[1] == said
    assert started.returncode == code


SIGNALS = "import os, signal, time\nos.kill(os.getpid(), signal.SIGINT)\ntime.sleep(20)\n"


@pytest.mark.parametrize("module", ["typing", "typer", "numpy", "rich"])
def test_an_interruption_while_modules_load_has_no_traceback(
    files: Path, tmp_path: Path, module: str
) -> None:
    (tmp_path / f"{module}.py").write_text(SIGNALS)
    done = shell("$exactfold count zigzags", files, FIRST=str(tmp_path))
    assert (done.returncode, done.stdout) == (INTERRUPTED, "")
    *before, last = done.stderr.splitlines()
    assert last == "exactfold: interrupted"
    assert all(line.startswith("exactfold: read zigzags") for line in before)


@pytest.mark.parametrize("command", ["count two-vertex --json", "count two-vertex", "--version"])
def test_closed_output_is_output_that_failed(files: Path, command: str) -> None:
    done = shell(f"$exactfold {command} >&-", files)
    assert (done.returncode, done.stdout) == (OUTPUT_FAILED, "")
    assert done.stderr == "exactfold: cannot write the output: Bad file descriptor\n"


def test_closed_output_that_is_not_needed(files: Path, tmp_path: Path) -> None:
    done = shell(f"$exactfold random --interior 3 --seed 1 -o {tmp_path}/r.fold >&-", files)
    assert (done.returncode, done.stderr) == (0, "")
    assert (tmp_path / "r.fold").read_text().startswith("{")


@pytest.mark.parametrize("closing", ["2>&-", "2>/dev/full"])
def test_errors_that_cannot_be_said_keep_their_code(files: Path, closing: str) -> None:
    done = shell(f"$exactfold count none.fold {closing}", files)
    assert (done.returncode, done.stdout) == (BAD_INPUT, "")
