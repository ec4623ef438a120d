"""Rows of studies: kept one by one, each once, the same whatever computes them."""

from __future__ import annotations

import os
import sqlite3
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
import toy
from toy import TOY

from exactfold.branches.counting.pools import process_pool
from exactfold.errors import (
    ForeignJournalError,
    InputError,
    JournalInUseError,
    RowFailedError,
    UnwritableFileError,
    UsageError,
)
from exactfold.studies import read_row, recompute_row, run_study, study_named
from exactfold.studies.running.runner import normal
from exactfold.studies.running.store import RowStore


def values(run):
    return [(row["size"], row["seed"], row["value"]) for row in run.rows]


def test_rows_are_the_same_in_memory_and_in_a_journal(tmp_path):
    run = run_study(TOY)
    kept = run_study(TOY, tmp_path / "a.sqlite")
    assert list(run.rows) == list(kept.rows) == list(kept.rows)
    assert values(run) == [(2, 0, 4), (2, 1, 5), (2, 2, 6)]
    assert (run.computed, run.journal, run.total, run.undecided) == (3, None, 3, 0)
    assert kept.journal == str(tmp_path / "a.sqlite")
    assert repr(run) == "<StudyRun: toy, seed 0, 3 rows>"


def test_a_run_goes_on_where_another_ended(tmp_path):
    path = tmp_path / "a.sqlite"
    assert run_study(TOY, path, numbers={2: 2}).computed == 2
    more = run_study(TOY, path, numbers={2: 3, 5: 1}, seed=1)
    assert (more.computed, values(more)) == (3, [(2, 1, 5), (2, 2, 6), (2, 3, 7), (5, 1, 26)])
    again = run_study(TOY, path, numbers={2: 3, 5: 1}, seed=1)
    assert (again.computed, values(again)) == (0, values(more))


def test_the_order_of_the_recipes_is_kept_whatever_ends_first(tmp_path):
    def backwards(work, jobs):
        return ((job, work(job)) for job in reversed(list(jobs)))

    run = run_study(TOY, tmp_path / "a.sqlite", engine=backwards)
    assert values(run) == values(run_study(TOY))


def test_progress_counts_rows():
    seen = []
    run_study(TOY, progress=lambda *state: seen.append(state))
    assert seen == [("computing", k, 3) for k in (1, 2, 3)]


def test_an_error_ends_one_row_and_no_other(tmp_path):
    path = tmp_path / "a.sqlite"
    with pytest.raises(RowFailedError, match=r'1 row .*"seed":1.* ZeroDivisionError: by nought'):
        run_study(replace(TOY, row=toy.failing), path)
    with RowStore(path, TOY) as store:
        assert len(store) == 2
    assert run_study(TOY, path).computed == 1


KILLED = """
import sys
sys.path.insert(0, {folder!r})
import os, toy
from dataclasses import replace
from exactfold.studies import run_study
run_study(replace(toy.TOY, row=toy.deadly), {path!r}, numbers={{2: 5}})
"""


def test_a_run_that_is_killed_loses_the_row_under_way_and_doubles_none(tmp_path):
    path, mark = tmp_path / "a.sqlite", tmp_path / "deadly"
    mark.touch()
    script = KILLED.format(folder=str(Path(__file__).parent), path=str(path))
    done = subprocess.run([sys.executable, "-c", script], cwd=tmp_path, check=False)
    assert done.returncode == -9
    mark.unlink()
    run = run_study(TOY, path, numbers={2: 5})
    assert (run.computed, len(values(run))) == (3, 5)
    with sqlite3.connect(path) as rows:
        assert rows.execute("SELECT count(*) FROM rows").fetchone() == (5,)
        assert rows.execute("PRAGMA journal_mode").fetchone() == ("wal",)


@pytest.mark.slow
def test_any_number_of_workers_gives_the_same_rows(tmp_path):
    numbers = {2: 3, 3: 3, 4: 3}
    alone = run_study("table1", numbers=numbers)
    two = run_study("table1", tmp_path / "a.sqlite", numbers=numbers, workers=2)
    assert list(alone.rows) == list(two.rows)


def test_a_row_is_computed_again_and_compared(tmp_path):
    path = tmp_path / "a.sqlite"
    name = next(iter(run_study(TOY, path).rows))["row"]
    found = recompute_row(TOY, path, name[:10])
    assert (found.stored.id, found.agrees, found.differing) == (name, True, ())
    other = recompute_row(replace(TOY, row=lambda r: {"status": "proved", "x": 1}), path, name)
    assert (other.agrees, other.differing) == (False, ("value", "x"))


def test_a_row_that_is_not_there_is_said(tmp_path):
    path = tmp_path / "a.sqlite"
    with pytest.raises(InputError, match="run the study first"):
        read_row(path, TOY, "a")
    run_study(TOY, path)
    with pytest.raises(InputError, match="more than one row"):
        read_row(path, TOY, "")
    with pytest.raises(InputError, match="has no row"):
        read_row(path, TOY, "xyz")


@pytest.mark.parametrize("other", [{"name": "table1"}, {"version": 2}])
def test_the_journal_of_another_study_is_left_alone(tmp_path, other):
    path = tmp_path / "a.sqlite"
    run_study(TOY, path)
    before = path.read_bytes()
    with pytest.raises(ForeignJournalError, match="rows of the study toy, version 1, not of"):
        run_study(replace(TOY, **other), path)
    assert path.read_bytes() == before


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"SQLite", "is not the journal of a study"),
        (b"no journal", "is not the journal of a study"),
        (b"SQLite format 3\0 and then not", "is damaged"),
    ],
)
def test_a_file_of_another_kind_is_left_alone(tmp_path, content, said):
    path = tmp_path / "a.sqlite"
    path.write_bytes(content)
    with pytest.raises(ForeignJournalError, match=said):
        run_study(TOY, path)
    assert path.read_bytes() == content


def test_a_database_of_another_program_is_left_alone(tmp_path):
    path = tmp_path / "a.sqlite"
    with sqlite3.connect(path) as rows:
        rows.execute("CREATE TABLE rows (id)")
    with pytest.raises(ForeignJournalError, match="not the journal of a study"):
        run_study(TOY, path)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ("UPDATE rows SET row = replace(row, '4', '5')", "differs from what was written"),
        ("UPDATE rows SET row = '{'", "differs from what was written"),
        ("UPDATE rows SET sha256 = 'no'", "differs from what was written"),
        ('UPDATE rows SET recipe = \'{"size":2,"seed":7}\'', "differs from what was written"),
        ("UPDATE about SET value = '9' WHERE name = 'version'", "is not the journal of a study"),
        ("DROP TABLE about", "is not the journal of a study"),
    ],
)
def test_a_changed_journal_is_found(tmp_path, change, said):
    path = tmp_path / "a.sqlite"
    run_study(TOY, path, numbers={2: 1})
    rows = sqlite3.connect(path)
    rows.execute(change)
    rows.commit()
    rows.close()
    with pytest.raises(ForeignJournalError, match=said):
        list(run_study(TOY, path, numbers={2: 1}).rows)


def test_two_runs_do_not_write_one_journal(tmp_path):
    path = tmp_path / "a.sqlite"
    with RowStore(path, TOY), pytest.raises(JournalInUseError):
        run_study(TOY, path)
    assert run_study(TOY, path).computed == 3


def test_a_journal_that_cannot_be_written_is_said(tmp_path):
    for path in (tmp_path, tmp_path / "none" / "a.sqlite"):
        with pytest.raises(UnwritableFileError):
            run_study(TOY, path)


def test_wrong_usage_is_refused_before_anything_is_computed(tmp_path):
    with pytest.raises(UsageError, match="no study 'x'; the studies are: table1"):
        run_study("x")
    with pytest.raises(UsageError, match="must be at least one"):
        run_study(TOY, workers=0)
    with pytest.raises(UsageError, match="must not be negative"):
        run_study("table1", seed=-1)
    with pytest.raises(UsageError, match="from 1 to 99 vertices"):
        run_study("table1", numbers={100: 1})
    with pytest.raises(UsageError, match=r"up to 10\^7"):
        run_study("table1", numbers={2: 10**7 + 1})
    assert not os.listdir(tmp_path)


@pytest.mark.parametrize(
    ("row", "said"),
    [
        ({"value": 1}, "status"),
        ({"status": "proved", "size": 1}, "both in the recipe and in the row"),
        ({"status": "proved", "x": float("nan")}, "that JSON cannot express"),
        ({"status": "proved", "x": {1, 2}}, "that JSON cannot express"),
    ],
)
def test_what_is_no_row_is_refused(row, said):
    with pytest.raises(UsageError, match=said):
        normal(row, {"size": 2})


def test_sizes_and_numbers_are_chosen():
    study = study_named("table1")
    assert study.chosen() == study.numbers
    assert study.chosen([5, 2]) == {2: 100, 5: 1000}
    assert study.chosen(number=7, sizes=[20]) == {20: 7}
    assert sum(study.chosen(extend=True).values()) == sum(study.numbers.values()) + 6000
    with pytest.raises(UsageError, match="no number of rows for size 9: give --number"):
        study.chosen([9])
    assert study.chosen(number={5: 7, 20: 0}) == {5: 7, 20: 0}
    assert study.chosen([4, 5], {5: 7}) == {4: 1000, 5: 7}
    extended = study.chosen(number={5: 7, 20: 1}, extend=True)
    assert extended == {**study.numbers, **study.extended, 5: 7, 20: 1}
    with pytest.raises(UsageError, match="for size 5, but this size is not among"):
        study.chosen([2, 3], {2: 1, 5: 7})


def test_no_row_is_named_twice():
    names = [TOY.id_of(recipe) for recipe in toy.recipes(0, {2: 50, 3: 50})]
    assert len(set(names)) == 100
    assert TOY.id_of({"size": 2, "seed": 0}) == TOY.id_of({"seed": 0, "size": 2})


def test_process_pools_take_the_work_of_a_study():
    assert values(run_study(TOY, engine=process_pool(1))) == values(run_study(TOY))
