"""The line about the digits of an inexact drawing."""

from exactfold._support.clock import Clock
from exactfold.app.report.digits import digits_line
from exactfold.panels.decomposition import decompose
from exactfold.pattern.panel_pattern import PanelPattern


def test_bounds_are_said_where_not_all_ways_are_known() -> None:
    edges = [(6 * i + j, 6 * i + j + 6) for i in range(5) for j in range(6)]
    edges += [(6 * i + j, 6 * i + j + 1) for i in range(6) for j in range(5)]
    edges += [(6 * i + j, 6 * i + j + 7) for i in range(5) for j in range(5) if not (i - j) % 3]
    sheet = PanelPattern([(i, j) for i in range(6) for j in range(6)], edges)
    said = str(digits_line(decompose(sheet, clock=Clock(0))))
    assert said == (
        "the digits as written: degrees of freedom: between 3 and 12 - PROVED; no more is known "
        "(--snap exact)"
    )
    cross = PanelPattern(
        [(0, 0), (1, 0), (0, 1), (-1, 0), (0, -1)],
        [(1, 2), (2, 3), (3, 4), (4, 1), (0, 1), (0, 2), (0, 3), (0, 4)],
    )
    assert "degrees of freedom" not in str(digits_line(decompose(cross)))
