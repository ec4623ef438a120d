"""`exactfold count` of several files: lines, resumption, failures that stop no other."""

from __future__ import annotations

import hashlib
import json
import os
import signal
import subprocess
import sys
import time
from fractions import Fraction
from pathlib import Path

import pytest
from running import (
    BAD_INPUT,
    DEFECT,
    INTERRUPTED,
    PROVED,
    UNDECIDED,
    USAGE,
    process,
    run,
)
from sheets import DENTED, scrambled

from exactfold import random_square
from exactfold.app.commands.several import batch
from exactfold.app.commands.several.outcome import Line
from exactfold.app.shell.shell import Bar
from exactfold.branches import count_branches
from exactfold.branches.counting.batch import Job, count_many
from exactfold.branches.counting.pools import dask_pool, process_pool
from exactfold.errors import NotFoldError, UnreadableFileError, UsageError, WorkerDiedError
from exactfold.pattern import write_fold
from exactfold.pattern.data import example_path

KEYS = {
    *("format", "version", "name", "sha256", "asked", "status", "exit_code", "error", "known"),
    "result",
}


def squares(folder: Path, count: int) -> list[Path]:
    paths = [folder / f"{k}.fold" for k in range(count)]
    for k, path in enumerate(paths):
        write_fold(random_square(3, seed=k), path)
    return paths


def lines(path: Path) -> list[dict]:
    return [json.loads(line) for line in path.read_text().splitlines()]


@pytest.mark.usefixtures("without_spaces")
def test_a_line_for_each_file_and_the_worst_exit_code(tmp_path: Path) -> None:
    good, open_, bad, out = (tmp_path / n for n in ("a.fold", "b.fold", "c.fold", "o.jsonl"))
    write_fold(random_square(3, seed=1), good)
    write_fold(scrambled(2, DENTED, 4, loose=True), open_)
    bad.write_text("{")
    given = ("count", good, open_, bad, tmp_path / "none.fold", "--jobs", 1, "--jsonl", out)
    result = run(*given)
    assert result.exit_code == BAD_INPUT
    words = " ".join(result.stdout.split())
    assert "4 patterns: 1 proved, 1 undecided (1 known in part), 2 failed; results in" in words
    found = lines(out)
    assert all(set(line) == KEYS for line in found)
    assert [line["name"] for line in found] == [
        *map(str, (good, open_, bad, tmp_path / "none.fold"))
    ]
    assert [line["status"] for line in found] == ["proved", "undecided", "failed", "failed"]
    assert [line["exit_code"] for line in found] == [0, 4, 3, 3]
    assert found[0]["sha256"] == hashlib.sha256(good.read_bytes()).hexdigest()
    alone = json.loads(run("count", good, "--json").stdout)
    counted = found[0]["result"]
    assert {**counted, "seconds": 0} == {**alone, "seconds": 0}
    assert found[2]["error"]["class"] == "NotFoldError"
    assert "not JSON at" in found[2]["error"]["message"]
    assert str(tmp_path / "none.fold") in found[3]["error"]["message"]
    assert found[3]["sha256"] is None
    assert run("count", good, open_, "--jobs", 1).exit_code == UNDECIDED
    assert run("count", good, good).exit_code == PROVED


def test_a_folder_stands_for_the_drawings_in_it(tmp_path: Path) -> None:
    folder = tmp_path / "mine"
    (folder / "below").mkdir(parents=True)
    (folder / "notes.txt").write_text("no drawing")
    squares(folder, 1)
    squares(folder / "below", 2)
    out = tmp_path / "o.jsonl"
    assert run("count", folder, "two-vertex", "--jobs", 1, "--jsonl", out).exit_code == PROVED
    expected = [folder / "0.fold", folder / "below" / "0.fold", folder / "below" / "1.fold"]
    assert [line["name"] for line in lines(out)] == [*map(str, expected), "two-vertex"]


def test_a_folder_without_drawings_is_wrong_usage(tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("no drawing")
    result = run("count", tmp_path)
    assert result.exit_code == USAGE
    assert f"the folder {tmp_path} has no file that ends in cp, " in " ".join(result.stderr.split())


TRIANGLES = {1: ("M",), 2: ("M", "V")}
"""Creases from the first corner to the opposite side of a triangle, by the number of the sheet."""


def several_sheets(path: Path, creases=TRIANGLES) -> Path:
    """A CP file with a triangle for each number, side by side."""
    rows = []
    for k, letters in creases.items():
        corners = [(3 * k, 0), (3 * k + 2, 0), (3 * k, 2)]
        rows += [
            f"1 {a} {b} {c} {d}"
            for (a, b), (c, d) in zip(corners, [*corners[1:], corners[0]], strict=True)
        ]
        for j, letter in enumerate(letters, 1):
            share = Fraction(2 * j, len(letters) + 1)
            end = f"{float(3 * k + 2 - share)} {float(share)}"
            rows.append(f"{' BMV'.index(letter)} {3 * k} 0 {end}")
    path.write_text("\n".join(rows))
    return path


def test_all_sheets_have_an_answer_each(tmp_path: Path) -> None:
    path, plain = several_sheets(tmp_path / "two.cp", {1: "M", 2: "MM"}), example_path("zigzags")
    result = run("count", path, "--sheet", "all", "--json", "--jobs", 1)
    assert result.exit_code == 0
    lines = [json.loads(line) for line in result.stdout.splitlines()]
    assert [line["name"] for line in lines] == [f"{path} sheet 1", f"{path} sheet 2"]
    assert [line["asked"]["sheet"] for line in lines] == [1, 2]
    assert [line["result"]["pattern"]["folds"] for line in lines] == [1, 2]
    alone = json.loads(run("count", path, "--sheet", 2, "--json").stdout)
    assert lines[1]["result"]["components"] == alone["components"]
    assert lines[1]["result"]["pattern"]["sha256"] == alone["pattern"]["sha256"]
    table = run("count", path, plain, "--sheet", "all", "--jobs", 1)
    words = " ".join(table.stdout.split())
    assert words.endswith("3 patterns: 3 proved, 0 undecided, 0 failed")
    assert words.count("sheet 1") == words.count("sheet 2") == 1


def test_without_a_choice_each_sheet_has_a_line_of_json(tmp_path: Path) -> None:
    path = several_sheets(tmp_path / "two.cp", {1: "M", 2: ""})
    result = run("count", path, "--json", "--jobs", 1, "--sheet", "all")
    plain = run("count", path, "--json")
    assert (plain.exit_code, result.exit_code) == (BAD_INPUT, BAD_INPUT)  # the worst of the sheets
    assert "holds 2 sheets" in plain.stderr
    lines = [json.loads(line) for line in plain.stdout.splitlines()]
    assert sorted((line["name"], line["status"]) for line in lines) == [
        (f"{path} sheet 1", "proved"),
        (f"{path} sheet 2", "failed"),
    ]


def test_the_sheets_of_a_drawing_share_its_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    jobs: list[Job] = []
    line_of = batch.line_of

    def noted(job: Job) -> Line:
        jobs.append(job)
        return line_of(job)

    monkeypatch.setattr(batch, "line_of", noted)
    path, alone = several_sheets(tmp_path / "two.cp"), example_path("zigzags")
    result = run("count", path, alone, "--sheet", "all", "--limit", 90, "--jobs", 1)
    assert result.exit_code == 0
    first, second, other = [job.limit for job in jobs]
    assert 30 < first <= 36, "half of four fifths of the time"
    assert 60 < second < 72, "what the first has left"
    assert 89 < other <= 90, "another file has a limit of its own"
    assert [job.reading.limit for job in jobs] == [first, second, other]


def test_a_sheet_that_is_refused_takes_no_other_with_it(tmp_path: Path) -> None:
    path = several_sheets(tmp_path / "two.cp", {1: "M", 2: ""})
    out = tmp_path / "out.jsonl"
    result = run("count", path, "--sheet", "all", "--jsonl", out, "--jobs", 1)
    assert result.exit_code == BAD_INPUT
    assert "the sheet has no folds" in " ".join(result.stdout.split())
    statuses = {line["name"]: line["status"] for line in map(json.loads, out.open())}
    assert statuses == {f"{path} sheet 1": "proved", f"{path} sheet 2": "failed"}
    forced = run("count", path, "--sheet", "all", "--force", "--jsonl", out, "--jobs", 1)
    assert forced.exit_code == 0
    words = " ".join(forced.stdout.split())
    assert words.startswith("2 patterns: 2 proved, 0 undecided, 0 failed; results in")
    again = run("count", path, "--sheet", "all", "--force", "--jsonl", out, "--jobs", 1)
    assert "2 counted in an earlier run" in " ".join(again.stdout.split())


def test_a_file_that_cannot_be_read_is_one_line_of_all_sheets(tmp_path: Path) -> None:
    (tmp_path / "bad.cp").write_text("1 0 0 1")
    result = run("count", tmp_path / "bad.cp", "none.cp", "--sheet", "all", "--json", "--jobs", 1)
    assert result.exit_code == BAD_INPUT
    names = [json.loads(line)["name"] for line in result.stdout.splitlines()]
    assert names == [str(tmp_path / "bad.cp"), "none.cp"]


def test_all_sheets_go_with_count_only(tmp_path: Path) -> None:
    path = several_sheets(tmp_path / "two.cp")
    for command in (["info"], ["match"], ["convert", tmp_path / "out.fold"]):
        result = run(command[0], path, *command[1:], "--sheet", "all")
        assert result.exit_code == USAGE
        assert "--sheet all goes with `exactfold count`" in result.stderr
    assert run("count", path, "--sheet", "all", "--certificate", "c.json").exit_code == USAGE
    assert run("count", path, "--sheet", "some").exit_code == USAGE
    assert run("count", path, "--sheet", 0).exit_code == USAGE


@pytest.mark.slow
def test_without_a_choice_the_sheets_are_listed(tmp_path: Path) -> None:
    path = several_sheets(tmp_path / "two.cp")
    listed = "sheet 1 with 1 fold, 2 x 2 at (3, 0); sheet 2 with 2 folds, 2 x 2 at (6, 0)"
    remedy = "choose one with --sheet N (`number=` in Python), or count all with"
    result = run("info", path)
    assert result.exit_code == BAD_INPUT
    assert f"the drawing holds 2 sheets ({listed}): {remedy}" in result.stderr
    every = run("count", path)
    asked = run("count", path, "--sheet", "all")
    assert (every.exit_code, every.stdout) == (asked.exit_code, asked.stdout)
    assert f"holds 2 sheets ({listed}): each is counted, as with --sheet all; " in every.stderr
    assert "choose one with --sheet N" in run("count", path, "--certificate", "c.json").stderr
    result = run("count", path, "--sheet", 3)
    assert f"there is no sheet 3: the drawing holds 2 sheets ({listed})" in result.stderr
    many = several_sheets(tmp_path / "many.cp", dict.fromkeys(range(1, 15), "M"))
    assert "sheet 12 with 1 fold, 2 x 2 at (36, 0); and 2 more): " in run("info", many).stderr


def test_the_same_from_one_process_and_from_two(tmp_path: Path) -> None:
    paths = squares(tmp_path, 5)
    found = []
    for jobs in (1, 2):
        out = tmp_path / f"{jobs}.jsonl"
        assert run("count", *paths, "--jobs", jobs, "--jsonl", out).exit_code == PROVED
        found.append({d["name"]: d["result"]["branches"] for d in lines(out)})
    assert found[0] == found[1]
    assert set(found[0]) == set(map(str, paths))


def test_files_that_were_counted_are_skipped_and_failed_ones_tried_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    paths, out = squares(tmp_path, 4), tmp_path / "o.jsonl"
    bad = tmp_path / "bad.fold"
    bad.write_text("[]")
    assert run("count", *paths[:2], bad, "--jsonl", out, "--jobs", 1).exit_code == BAD_INPUT
    before = out.read_bytes()
    result = run("count", *paths, bad, "--jsonl", out, "--jobs", 1, "--json")
    assert result.exit_code == BAD_INPUT
    summary = json.loads(result.stdout)
    assert (summary["files"], summary["skipped"]) == (5, 2)
    assert (summary["proved"], summary["failed"], summary["undecided"]) == (4, 1, 0)
    assert out.read_bytes().startswith(before)
    assert sorted(d["name"] for d in lines(out)) == sorted(map(str, [*paths, bad, bad]))
    monkeypatch.setenv("COLUMNS", "300")
    again = run("count", *paths, bad, "--jsonl", out, "--jobs", 1).stdout
    assert f"? FAILED {bad.name} {bad.name}: a FOLD file contains one JSON object" in " ".join(
        again.split()
    )
    assert "1 failed; 4 counted in an earlier run" in " ".join(again.split())
    write_fold(random_square(3, seed=9), paths[0])  # another pattern under the same name
    assert (
        json.loads(run("count", *paths, "--jsonl", out, "--jobs", 1, "--json").stdout)["skipped"]
        == 3
    )
    moved = paths[1].rename(tmp_path / "moved.fold")  # the same under another name
    assert (
        json.loads(run("count", moved, "--jsonl", out, "--jobs", 1, "--json").stdout)["skipped"]
        == 1
    )
    # What was asked differs: the line there is no answer.
    snapped = run("count", moved, "--jsonl", out, "--jobs", 1, "--json", "--snap", 1024)
    assert json.loads(snapped.stdout)["skipped"] == 0


def test_two_files_with_one_content_have_a_line_each(tmp_path: Path) -> None:
    (one,) = squares(tmp_path, 1)
    two, out = tmp_path / "two.fold", tmp_path / "o.jsonl"
    two.write_bytes(one.read_bytes())
    run("count", two, "--jsonl", out, "--jobs", 1)
    run("count", one, two, "--jsonl", out, "--jobs", 1)
    assert [d["name"] for d in lines(out)] == [str(two), str(one)]


def test_a_torn_last_line_is_dropped(tmp_path: Path) -> None:
    paths, out = squares(tmp_path, 2), tmp_path / "o.jsonl"
    run("count", *paths, "--jsonl", out, "--jobs", 1)
    whole = out.read_bytes()
    first = whole.index(b"\n") + 1
    for length in (first + 1, first + 100, len(whole) - 1):
        out.write_bytes(whole[:length])
        result = run("count", *paths, "--jsonl", out, "--jobs", 1, "--json")
        assert json.loads(result.stdout)["skipped"] == 1
        assert out.read_bytes()[:first] == whole[:first]
        assert [d["name"] for d in lines(out)] == list(map(str, paths))
    out.write_bytes(whole[:10])  # not even a line
    assert (
        json.loads(run("count", *paths, "--jsonl", out, "--jobs", 1, "--json").stdout)["skipped"]
        == 0
    )


@pytest.mark.parametrize("text", ["notes", '{"format": "exactfold count result"}\n', "[]\n", "\n"])
def test_a_file_of_another_kind_is_left_alone(tmp_path: Path, text: str) -> None:
    (path,), out = squares(tmp_path, 1), tmp_path / "o.jsonl"
    out.write_text(text)
    result = run("count", path, "--jsonl", out, "--jobs", 1)
    assert result.exit_code == BAD_INPUT
    assert "not a line of results" in result.stderr
    assert out.read_text() == text


def test_options_that_do_not_go_together(tmp_path: Path) -> None:
    path, out = example_path("two-vertex"), tmp_path / "o.jsonl"
    for options in (
        [path, path, "--certificate", "c.json"],
        [path, "--jsonl", out, "--stream", "s.txt"],
        [path, path, "--workers", 2],
        [path, path, "--resume"],
        [path, "--jobs", 2],
        [path, "-", "--jsonl", out],
        [path, "--jsonl", "-"],
        [path, "--jsonl", path],
        [path, path, "--dask", "tcp://h:1", "--jobs", 2],
    ):
        result = run("count", *options)
        assert result.exit_code == USAGE
        assert result.stdout == ""
    assert not out.exists()
    assert not Path("c.json").exists()


def test_without_a_file_the_lines_are_printed() -> None:
    names = ("two-vertex", "single-vertex-4")
    paths = [example_path(name) for name in names]
    result = run("count", *paths, "--json", "--jobs", 1)
    assert [json.loads(line)["name"] for line in result.stdout.splitlines()] == [*map(str, paths)]
    table = run("count", *paths, "waterbomb", "--jobs", 1).stdout
    assert "3 patterns: 3 proved, 0 undecided, 0 failed" in table
    rows = [line.split()[:2] for line in table.splitlines()[:4]]
    assert rows == [["ways", "status"], ["4", "PROVED"], ["2", "PROVED"], ["1", "PROVED"]]


@pytest.mark.usefixtures("without_spaces")
def test_the_line_of_progress_tells_of_what_is_not_proved(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, bad = tmp_path / "a.fold", tmp_path / "b.fold"
    write_fold(scrambled(2, DENTED, 4, loose=True), path)
    bad.write_text("")
    seen = []
    monkeypatch.setattr(Bar, "__call__", lambda self, *state: seen.append(state))
    run("count", path, example_path("two-vertex"), bad, "--jobs", 1)
    assert seen == [
        ("counting", 1, 3, ", 1 undecided"),
        ("counting", 2, 3, ", 1 undecided"),
        ("counting", 3, 3, ", 1 undecided, 1 failed"),
    ]
    monkeypatch.undo()
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("TERM", "xterm")
    with Bar("reading", delay=3600) as bar:
        bar.show()
        bar("counting", 412, 2000, ", 3 undecided")
        assert bar.display is not None
        assert bar.display.progress.tasks[0].fields["count"] == "412/2000, 3 undecided"


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
@pytest.mark.parametrize(
    "sent", [signal.SIGINT, pytest.param(signal.SIGTERM, marks=pytest.mark.slow)]
)
def test_an_interruption_leaves_a_file_that_goes_on(tmp_path: Path, sent: signal.Signals) -> None:
    """No worker is left behind, although one is in the middle of a long count."""
    paths, out = squares(tmp_path, 3), tmp_path / "o.jsonl"
    long = tmp_path / "long.fold"
    write_fold(random_square(16, seed=1), long)
    given = ["count", *paths, long, long, long, "--jsonl", out, "--jobs", 2]
    command = [sys.executable, "-m", "exactfold", *map(str, given)]
    started = subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    while not out.exists() or out.read_bytes().count(b"\n") < 3:
        assert started.poll() is None
        time.sleep(0.05)
    started.send_signal(sent)
    _, errors = started.communicate(timeout=60)  # also waits for every worker's end of the pipe
    assert started.returncode == INTERRUPTED
    assert errors == "exactfold: interrupted; the same command goes on\n"
    kept = out.read_bytes()
    result = run("count", *paths, "--jsonl", out, "--json")
    assert (result.exit_code, json.loads(result.stdout)["skipped"]) == (PROVED, 3)
    assert out.read_bytes() == kept


@pytest.mark.slow
def test_a_batch_in_one_process_is_a_pipeline(tmp_path: Path) -> None:
    paths = squares(tmp_path, 2)
    done = process("count", *paths, "--json", "--jobs", 2)
    assert (done.returncode, done.stderr) == (PROVED, "")
    assert len(done.stdout.splitlines()) == 2


# --- Python --------------------------------------------------------------------------------------


def test_count_many_in_this_process(tmp_path: Path) -> None:
    (path,), bad = squares(tmp_path, 1), tmp_path / "bad.fold"
    bad.write_text("x")
    seen = []
    given = [path, random_square(2, seed=1), bad, tmp_path / "none"]
    found = list(count_many(given, progress=lambda *state: seen.append(state)))
    assert [name for name, _ in found] == [str(path), "1", str(bad), str(tmp_path / "none")]
    assert found[0][1].distinct == 8
    assert found[1][1].distinct == 4
    assert isinstance(found[2][1], NotFoldError)
    assert "not JSON at" in str(found[2][1])
    assert isinstance(found[3][1], UnreadableFileError)
    assert seen == [("counting", k, 4) for k in range(1, 5)]


@pytest.mark.parametrize("wrong", [{"method": "guess"}, {"seed": -1}, {"jobs": 0}])
def test_count_many_refuses_at_once(wrong: dict) -> None:
    with pytest.raises(UsageError):
        count_many([random_square(2, seed=1)], **wrong)


@pytest.mark.slow
def test_count_many_on_processes() -> None:
    patterns = [random_square(3, seed=k) for k in range(4)]
    found = dict(count_many(patterns, jobs=2))
    for k, pattern in enumerate(patterns):
        expected = count_branches(pattern)
        assert found[str(k)].pattern == pattern
        assert found[str(k)].distinct == expected.distinct
        signs = [branch.sign_text for branch in found[str(k)].branches]
        assert signs == [branch.sign_text for branch in expected.branches]


def square_or_die(number: int) -> int:
    if number == 13:
        os._exit(9)
    return number**2


@pytest.mark.slow
def test_a_process_that_dies_takes_no_other_job_with_it() -> None:
    found = dict(process_pool(2)(square_or_die, range(20)))
    assert isinstance(found.pop(13), WorkerDiedError)
    assert found == {k: k**2 for k in range(20) if k != 13}


def test_a_dead_process_is_a_line_that_is_tried_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (path,), out = squares(tmp_path, 1), tmp_path / "o.jsonl"
    with monkeypatch.context() as patch:
        patch.setattr(batch, "line_of", lambda job: WorkerDiedError("it died"))
        result = run("count", path, "--jsonl", out, "--jobs", 1, "--json")
    assert result.exit_code == DEFECT
    assert lines(out)[0]["error"] == {"class": "WorkerDiedError", "message": "it died"}
    again = run("count", path, "--jsonl", out, "--jobs", 1, "--json")
    assert (again.exit_code, json.loads(again.stdout)["skipped"]) == (PROVED, 0)
    assert [d["status"] for d in lines(out)] == ["failed", "proved"]


@pytest.mark.slow
def test_on_dask(tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    patterns = [random_square(2, seed=k) for k in range(5)]
    quiet = {"dashboard_address": "127.0.0.1:0", "dashboard": False}
    with (
        distributed.LocalCluster(
            n_workers=1, processes=False, dashboard_address=None, scheduler_kwargs=quiet
        ) as cluster,
        dask_pool(cluster.scheduler_address) as pool,
    ):
        found = dict(count_many(patterns, engine=pool))
    assert {name: result.distinct for name, result in found.items()} == {
        str(k): 4 for k in range(5)
    }


@pytest.mark.usefixtures("without_spaces")
def test_what_is_known_in_part_is_counted(tmp_path: Path) -> None:
    path, out = tmp_path / "partly.fold", tmp_path / "o.jsonl"
    write_fold(scrambled(2, DENTED, 4, loose=True), path)
    result = run("count", path, "two-vertex", "--jobs", 1, "--jsonl", out)
    partly, complete = sorted(lines(out), key=lambda line: line["name"] != str(path))
    assert partly["known"] == ["degrees of freedom: between 3 and 6"]
    assert complete["known"] == []
    words = " ".join(result.stdout.split())
    assert "2 patterns: 1 proved, 1 undecided (1 known in part), 0 failed" in words
    again = run("count", path, "two-vertex", "--jobs", 1, "--jsonl", out)
    assert "1 undecided (1 known in part)" in " ".join(again.stdout.split())


def test_what_went_wrong_does_not_repeat_the_folders_of_a_file(tmp_path: Path) -> None:
    """Otherwise a long path would be broken at the end of the line."""
    folder = tmp_path / ("long" * 12) / ("name" * 12)
    missing = folder / "missing.svg"
    result = run("count", "two-vertex", missing, "--jobs", 1)
    assert result.exit_code == BAD_INPUT
    lines = result.stdout.splitlines()
    assert f"{missing}:" in lines
    assert "  cannot read missing.svg: No such file or directory" in lines


def test_an_edge_of_the_paper_that_is_not_drawn_is_said_in_a_table_too(tmp_path: Path) -> None:
    (tmp_path / "open.cp").write_text("2 0 0 3 2\n3 3 0 0 2\n2 1 0 1 2\n")
    result = run("count", tmp_path / "open.cp", "two-vertex", "--jobs", 1)
    assert result.exit_code == 0
    said = " ".join(result.stdout.split())
    assert "the drawing has no edge of the paper, so the rectangle round it is taken" in said
