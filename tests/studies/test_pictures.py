"""Tables and pictures of few rows, of rows that are not proved, and of none."""

from __future__ import annotations

from dataclasses import replace

import pytest
from toy import TOY

from exactfold.app.report import drawn, study_page
from exactfold.studies import StudyTable, run_study, study_named
from exactfold.studies.running.study import StudyFigure

UNDECIDED = {
    "table1": {"interior": 3, "rigid": 0},
    "mv": {"interior": 3},
    "perturbed": {"interior": 3, "size": "1/10"},
    "flat": {"interior": 3, "denominator": 16},
    "motions": {
        "interior": 1,
        "half_branches": 4,
        "h1": True,
        "rule": None,
        "loops": [],
        "contacts": [{"signs": "+", "end": "open", "time": None, "shared": None}],
    },
    "figures": {"figure": 4, "seed": 1},
}


@pytest.mark.parametrize("name", UNDECIDED)
def test_what_is_not_proved_is_in_tables_and_not_in_pictures(name):
    study = study_named(name)
    row = {"status": "undecided", **UNDECIDED[name]}
    assert any(table.rows for table in study.tables([row]))
    assert list(study.figures([row])) == []


@pytest.mark.parametrize("name", [*UNDECIDED, "h1", "angles"])
def test_without_rows_there_are_no_pictures(name):
    assert list(study_named(name).figures([])) == []
    assert not any(table.rows for table in study_named(name).tables([]))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "size"), [("table1", 3), ("h1", 3), ("mv", 2), ("perturbed", 2), ("flat", 2)]
)
def test_one_row_is_drawn_without_a_warning(name, size):
    pytest.importorskip("matplotlib")
    run = run_study(name, numbers={size: 1})
    assert run.figures
    for figure in run.figures:
        assert drawn(figure).startswith(b"<?xml")


@pytest.mark.slow
def test_legends_are_beside_the_axes_in_the_order_of_sizes():
    pytest.importorskip("matplotlib")
    seen = []

    def draw(axes):
        for label in ("$V_i = 10$", "here", "$V_i = 2$"):
            axes.plot([0, 1], label=label)
        seen.append(axes)

    drawn(StudyFigure("a", "A", "A.", draw))
    legend = seen[0].get_legend()
    assert [text.get_text() for text in legend.get_texts()] == ["here", "$V_i = 2$", "$V_i = 10$"]
    assert legend.get_window_extent().x0 >= seen[0].get_window_extent().x1


def test_the_page_prints_formulas_and_terms():
    table = StudyTable(
        "t",
        "Squares with Vt > 0",
        ("Vi", "(1/4)^Vi", "what is said of them"),
        ((2, "6.25e-02", "a sentence that is longer than a column <b>"), (3, "-1", None)),
        ("what is said of them: for Vi >= 2; also: 2^(Vi - Vt).",),
    )
    empty = StudyTable("e", "Empty", ("a",), ())
    study = replace(TOY, tables=lambda _: [table, empty], figures=lambda _: [])
    page = study_page(run_study(study, numbers={2: 1}), "exactfold study toy")
    for text in (
        "<p>Study <code>toy</code>, version 1, seed 0: 1 row (1 of size 2). Made by",
        "<h2>Squares with <i>V<sub>t</sub></i> &gt; 0</h2>",
        "<th>(1/4)<sup><i>V<sub>i</sub></i></sup></th>",
        "<td>6.25 × 10<sup>\N{MINUS SIGN}2</sup></td>",
        "<td>\N{MINUS SIGN}1</td>",
        '<td class="word long">a sentence that is longer than a column &lt;b&gt;</td>',
        "<em>what is said of them</em>: for <i>V<sub>i</sub></i> ≥ 2; also: 2<sup>",
        "<h2>Empty</h2><p>Nothing can be said of these rows.</p>",
    ):
        assert text in page
