"""`exactfold study`: tables in the terminal, files, rows computed again."""

from __future__ import annotations

import csv
import json
import os
import sqlite3
import sys
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import pytest
from running import BAD_INPUT, INVALID, PROVED, USAGE, error_class, run
from test_schemas import valid

from exactfold.app.shell.parsers import sizes
from exactfold.app.shell.row_numbers import read_numbers, written_numbers, written_sizes
from exactfold.studies import StudyTable, all_studies, table1
from exactfold.studies.running.registry import MODULES

SMALL = ("study", "table1", "--sizes", "2,3", "--number", "3", "--workers", "1")


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    """The journal of a small run."""
    path = tmp_path_factory.mktemp("study") / "a.sqlite"
    assert run(*SMALL, "--journal", path).exit_code == PROVED
    return path


def test_studies_are_listed():
    shown = run("study").stdout
    assert all(name in shown for name in MODULES)
    data = valid(json.loads(run("study", "--json").stdout), "studies")
    assert [study["study"] for study in data["studies"]] == list(all_studies())


def test_tables_are_printed_and_rows_kept(here):
    first = run(*SMALL)
    assert first.exit_code == PROVED
    assert "6 rows of seed 0, 6 computed now; rows in table1.sqlite" in first.stdout
    assert " 2        3       3                  3" in first.stdout
    again = run(*SMALL)
    assert again.stdout == first.stdout.replace("6 computed", "0 computed")


def test_json_has_the_tables(done):
    data = valid(json.loads(run(*SMALL, "--journal", done, "--json").stdout), "study")
    assert (data["rows"], data["computed"], data["undecided"]) == (6, 0, 0)
    assert (data["journal"], data["files"]) == (str(done), [])
    assert data["tables"][0]["rows"] == [[2, 3, 3, 3, 0, 0, 0, 0], [3, 3, 3, 3, 0, 0, 0, 0]]


def test_rows_are_written_as_csv(here, done):
    assert run(*SMALL, "--journal", done, "--csv", "a.csv").exit_code == PROVED
    with open("a.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [(row["interior"], row["distinct"]) for row in rows] == [("2", "4")] * 3 + [
        ("3", "8")
    ] * 3
    assert rows[0]["pairs_of_signs"] == "true"


def test_numbers_by_size(here):
    found = run("study", "table1", "--number", "2:2,3:1", "--workers", "1")
    assert found.exit_code == PROVED
    assert "3 rows of seed 0, 3 computed now" in found.stdout
    more = run(*SMALL, "--number", "2-3:2", "--json")
    assert json.loads(more.stdout)["numbers"] == {"2": 2, "3": 2}
    assert json.loads(more.stdout)["computed"] == 1


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("0", "0 is less than 1"),
        ("", "'' is not a whole number"),
        ("5,", "'5' has no number after a colon"),
        ("5:3,2", "'2' has no number after a colon"),
        ("2-4:3,3:1", "size 3 has two numbers"),
        ("4-2:1", "'4-2' ends before it begins"),
        ("0:4", "the least size is 1, not 0"),
        ("2:-1", "-1 is less than 0"),
        ("2-9999999999:1", "'2-9999999999' is more than 1000 sizes"),
        ("3:x", "'x' is not a whole number"),
    ],
)
def test_numbers_that_cannot_be_read(here, text, said):
    found = run("study", "table1", "--number", text, "--json")
    assert (found.exit_code, error_class(found)) == (USAGE, "UsageError")
    assert f"--number: {said}; write one number for all sizes" in found.stderr
    assert os.listdir() == []


@pytest.mark.parametrize("text", ["2", "2-5,8", "1-3,7,9-12"])
def test_sizes_are_written_as_they_are_read(text):
    assert written_sizes(sizes(text)) == text
    assert written_numbers(read_numbers(f"{text.split(',')[-1]}:4")) == f"{text.split(',')[-1]}:4"


@pytest.mark.slow
def test_rows_are_written_as_parquet(here, done):
    parquet = pytest.importorskip("pyarrow.parquet")
    assert run(*SMALL, "--journal", done, "--parquet", "a.parquet").exit_code == PROVED
    table = parquet.read_table("a.parquet")
    assert table["distinct"].to_pylist() == [4, 4, 4, 8, 8, 8]
    assert len(set(table["row"].to_pylist())) == 6


@pytest.mark.slow
def test_the_report_is_one_file_and_pictures_are_svg_and_pdf(here, done):
    files = ("--number", "2:3,3:3", "--html", "a.html", "--figures", "pictures")
    assert run(*SMALL, "--journal", done, *files).exit_code == PROVED
    page = Path("a.html").read_text(encoding="utf-8")
    assert page.count("<svg") == 2
    assert "src=" not in page
    assert "exactfold study table1 --sizes 2-3 --number 2-3:3 --journal" in page
    names = sorted(os.listdir("pictures"))
    assert names == [f"table1-{k}.{e}" for k in ("digits", "letters") for e in ("pdf", "svg")]
    ElementTree.parse("pictures/table1-digits.svg")
    assert Path("pictures/table1-digits.pdf").read_bytes().startswith(b"%PDF")


@pytest.mark.parametrize(
    ("module", "option", "file", "said"),
    [
        ("matplotlib", "--html", "a.html", "need Matplotlib: pip install 'exactfold[study]'"),
        ("matplotlib", "--figures", "a", "need Matplotlib: pip install 'exactfold[study]'"),
        ("pyarrow", "--parquet", "a.parquet", "need pyarrow: pip install 'exactfold[study]'"),
    ],
)
def test_what_is_not_installed_is_said_at_once(here, monkeypatch, module, option, file, said):
    for name in (module, "pyarrow.parquet"):
        monkeypatch.setitem(sys.modules, name, None)
    found = run(*SMALL, option, file)
    assert (found.exit_code, os.listdir()) == (USAGE, [])
    assert said in found.stderr


def test_a_row_is_computed_again(done):
    with sqlite3.connect(done) as rows:
        ((name,),) = rows.execute("SELECT id FROM rows LIMIT 1").fetchall()
    shown = run("study", "table1", "--journal", done, "--row", name)
    assert shown.exit_code == PROVED
    assert f"row {name}: agrees" in shown.stdout
    found = run("study", "table1", "--journal", done, "--row", name[:12], "--json")
    data = valid(json.loads(found.stdout), "study-row")
    assert (data["row"], data["agrees"], data["differing"]) == (name, True, [])
    assert data["stored"] == data["recomputed"]


def test_a_row_that_differs_is_said(here, done, monkeypatch):
    other = replace(table1.STUDY, row=lambda _: {"status": "undecided"})
    monkeypatch.setattr(table1, "STUDY", other)
    with sqlite3.connect(done) as rows:
        ((name,),) = rows.execute("SELECT id FROM rows LIMIT 1").fetchall()
    found = run("study", "table1", "--journal", done, "--row", name)
    assert found.exit_code == INVALID
    assert "differs in closest, digits" in found.stdout


@pytest.mark.parametrize(
    ("arguments", "code", "cause", "said"),
    [
        (("nothing",), USAGE, "UsageError", "no study 'nothing'; the studies are: table1"),
        (("table1", "--row", "00"), BAD_INPUT, "InputError", "there is no journal table1.sqlite"),
        (("table1", "--sizes", "40"), USAGE, "UsageError", "has no number of rows for size 40"),
        (
            ("table1", "--sizes", "2", "--number", "3:1"),
            USAGE,
            "UsageError",
            "rows for size 3, but this",
        ),
        (
            ("table1", "--number", "3:0"),
            USAGE,
            "UsageError",
            "no rows are asked for: raise --number",
        ),
        (
            ("table1", "--row", "00", "--seed", "2"),
            USAGE,
            "UsageError",
            "--row goes with",
        ),
        (("--seed", "2"), USAGE, "UsageError", "name a study; the studies are"),
        (
            ("table1", "--csv", "a.txt"),
            USAGE,
            "UsageError",
            "is written as .csv",
        ),
        (
            ("table1", "--csv", "a.csv", "--journal", "a.csv"),
            USAGE,
            "UsageError",
            "already reads or writes",
        ),
        (
            ("table1", "--dask", "tcp://127.0.0.1:1", "--workers", "2"),
            USAGE,
            "UsageError",
            "has its own workers",
        ),
        (
            ("table1", "--journal", "text"),
            BAD_INPUT,
            "ForeignJournalError",
            "not the journal",
        ),
        (("table1", "--figures", "text"), USAGE, "UsageError", "text is not a folder"),
    ],
)
def test_wrong_usage_is_refused_by_a_sentence_of_its_own(here, arguments, code, cause, said):
    Path("text").write_text("no journal")
    found = run("study", *arguments, "--json")
    assert (found.exit_code, error_class(found)) == (code, cause)
    assert said in found.stderr
    assert os.listdir() == ["text"]


@pytest.mark.parametrize("sizes", ["0", "x", "5-2", "2,,3", "-"])
def test_sizes_that_are_none_are_refused(here, sizes):
    assert run("study", "table1", f"--sizes={sizes}").exit_code == USAGE


def test_columns_of_words_are_known():
    table = StudyTable("t", "T", ("a", "b", "c"), (("x", 1, "0 %"), ("y", 2, "5 %")))
    assert table.words == (True, False, False)


def test_the_study_of_panels_is_named_by_an_option(here):
    command = ("study", "selffold", "--panels", "--sizes", 2, "--number", 1, "--workers", 1)
    result = run(*command)
    assert result.exit_code == PROVED
    assert "1 row of seed 0, 1 computed now; rows in selffold-panels.sqlite" in result.stdout
    refused = run("study", "table1", "--panels")
    assert refused.exit_code == USAGE
    assert "--panels goes with selffold" in refused.stderr
