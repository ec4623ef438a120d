"""Reports of large sheets and of many sheets stay short enough to be read."""

from __future__ import annotations

from typing import Any

from exactfold.app.report.batch import BatchRow, batch_report
from exactfold.app.report.panels import panels_report
from exactfold.app.report.terminal import console
from exactfold.panels.decomposition import decompose
from exactfold.pattern.panel_pattern import PanelPattern


def printed(report: Any) -> str:
    out = console()
    with out.capture() as captured:
        out.print(report, crop=False)
    return "".join(f"{line.rstrip()}\n" for line in captured.get().splitlines())


def crossings(number: int) -> PanelPattern:
    """A strip with `number` separate crossings of two lines, and a line between any two of them."""
    points, edges = [], []
    for k in range(number):
        x, at = 4 * k, 6 * k
        points += [(x, 0), (x, 4), (x + 2, 0), (x + 2, 4), (x + 1, 2), (x + 3, 0)]
        edges += [(at, at + 1), (at, at + 2), (at + 1, at + 3), (at + 2, at + 5)]
        edges += [(at + 4, at + e) for e in (0, 1, 2, 3)]
        end = 6 * number if k == number - 1 else at + 6
        edges += [(at + 5, end), (at + 3, end + 1)]
    x = 4 * number
    return PanelPattern([*points, (x, 0), (x, 4)], [*edges, (6 * number, 6 * number + 1)])


def rows(message: str, *names: str) -> list[BatchRow]:
    return [(name, "failed", "?", message) for name in names]


SUMMARY = dict.fromkeys(
    ("files", "proved", "undecided", "failed", "in_part", "warned", "skipped"), 0
)


def test_on_large_sheets_letters_are_counted_not_spelled_out() -> None:
    small, large = decompose(crossings(3)), decompose(crossings(40))
    assert "1          5  FVVFFFVVFFFVVF  yes: no loop of folds" in printed(
        panels_report(small, None, everything=False)
    )
    assert len(large.pattern.folds) == 199
    brief = " ".join(printed(panels_report(large, None, everything=False)).split())
    assert "1 2 valleys, 197 flat yes: no loop of folds" in brief
    assert "--all shows the letter of each fold" in brief
    full = printed(panels_report(large, None, everything=True))
    assert "FFFFFFFFFFFFFFFFFFFF" in full
    assert "flat yes" not in full
    assert "Folds in the order of --json" in full


def test_a_sheet_without_folds_says_so() -> None:
    square = PanelPattern([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)])
    said = printed(panels_report(decompose(square), None, everything=False))
    assert said.startswith("rigid - PROVED")
    assert said.rstrip().endswith("; the sheet has no folds")


def test_a_long_message_stands_once_below_the_table() -> None:
    message = " ".join(["word"] * 30)
    said = printed(batch_report(rows(message, "a/b.svg", "a/c.svg"), SUMMARY, None, False))
    table, below = said.rpartition("\n\n")[0].split("\n\n")
    assert [line.split() for line in table.splitlines()] == [
        ["ways", "status", "pattern"],
        ["?", "FAILED", "b.svg"],
        ["?", "FAILED", "c.svg"],
    ]
    assert " ".join(below.split()) == f"b.svg: c.svg: {message}"


def test_names_of_files_are_not_broken() -> None:
    folder = "a long folder/" * 8
    names = [f"{folder}1/{'x' * 70}.svg", f"{folder}2/{'y' * 70}.svg"]
    said = printed(batch_report(rows("word " * 9, *names), SUMMARY, None, False))
    for name in names:
        short = name.removeprefix(folder)
        assert f"       ?  FAILED     {short}\n" in said
        assert f"\n{short}:\n" in said


def test_a_very_long_message_is_shortened_unless_all_is_asked_for() -> None:
    message = "x" * 500
    assert "(--json has all)" in printed(batch_report(rows(message, "a"), SUMMARY, None, False))
    full = printed(batch_report(rows(message, "a"), SUMMARY, None, True))
    assert full.count("x") == 500


def test_a_short_message_stands_beside_the_name() -> None:
    said = printed(batch_report(rows("no folds", "b.svg"), SUMMARY, None, False))
    assert said.splitlines()[1].split() == ["?", "FAILED", "b.svg:", "no", "folds"]
