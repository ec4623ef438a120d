"""The comparison with other programs at its smallest size, and that it believes nobody."""

import json
import sys
from fractions import Fraction
from pathlib import Path

import numpy as np
import peers
import pytest
from pairs import remembered
from peer_process import run
from peer_programs import read_macaulay2, read_msolve, read_phcpack
from peer_report import main_table, pair_table
from peer_tasks import TASKS, backward_errors, judged
from plain_splu import plain_branch

from exactfold import random_square
from exactfold.branches import find_branch
from exactfold.rigidity.equations.branch_system import BranchSystem
from exactfold.solve.numeric.popping import popping

MSOLVE = "[0, [1,\n[[[-3 / 2, -1], [5 / 2^3, 7 / 2^3]], [[1, 1], [0, 0]]]\n]]:\n"
PHCPACK = """THE SOLUTIONS : start
 x0 :  9.0E+00   9.0E+00
THE SOLUTIONS :
2 2
solution 1 :
t :  1.0E+00   0.0E+00
the solution for t :
 x1 :  7.5E-01   0.0E+00
 x0 : -1.25E+00   2.0E-20
== err :  0.0E+00 = rco :  1.0E+00 = res :  0.0E+00 ==
"""


@pytest.mark.slow
def test_the_smallest_size_is_complete(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    first = dict([*peers.OWN.items()][:1])  # the others follow below, in this process
    monkeypatch.setattr(peers, "OWN", first)
    peers.main(["--sizes", "2", "--seeds", "1", "--timeout", "60", "--json"])
    text = capsys.readouterr().out
    results = json.loads(text)
    outcomes = {line["program"]: line["outcome"] for line in results["lines"]}
    assert set(first) <= set(outcomes)
    assert set(outcomes.values()) == {"complete"}
    assert {peer.name for peer in peers.PEERS} <= {*outcomes, *results["missing"]}
    assert all(line["cpu"] > 0 and line["memory"] > 1 for line in results["lines"])
    (tmp_path / "results.json").write_text(text)
    for shape in ([], ["--markdown"]):
        peers.main(["--from", str(tmp_path / "results.json"), *shape])
        assert "exactfold, certificate" in capsys.readouterr().out


def test_measurements_are_remembered_by_commit(tmp_path: Path) -> None:
    def line(command: str, commit: str, *cpu: float, code: int | None = 0) -> str:
        words = {"command": command, "commit": commit, "cpu": cpu, "memory": 9.0, "code": [code]}
        return json.dumps(words)

    kept = tmp_path / "kept.jsonl"
    measured = [
        *(line("count", "aaaa", 8.0), line("count", "bbbb", 8.0)),
        *(line("view", "aaaa", 9.0), line("view", "bbbb", 3.0)),
        *(line("count", "aaaa", 4.0), line("count", "cccc", 1.0, 3.0, 2.0)),
        *(line("count", "dddd", 1.0), line("count", "cccc", 5.0)),
        *(line("motions", "aaaa", 90.0, code=None), line("motions", "cccc", 30.0)),
        *(line("count", "aaaa", 6.0), line("count", "cccc", 1.0, 3.0, 2.0)),
    ]
    kept.write_text("\n".join(measured) + "\n")
    assert pair_table(remembered("aaaa1234", kept)) == [
        ["command", "aaaa", "cccc", "ratio", "MB"],
        ["count", "6.0", "2.0", "0.33", "9"],
        ["motions (exit codes [None], [0])", "> 90", "30", "0.33", "9"],
    ]
    with pytest.raises(SystemExit, match="no measurement against bbbb"):
        remembered("bbbb", kept)


def test_every_way_finds_all(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    TASKS["export"](4, 2)
    assert {name: TASKS[name](4, 2)["found"] for name in [*peers.OWN.values(), "check"]} == {
        "count": 16,
        "stream": 16,
        "parametrise": 16,
        "lifting": 16,
        "check": 16,
    }
    assert TASKS["profile_stream"](4, 2)["shares"][0][0] > 0
    TASKS["export"](70, 2)
    assert TASKS["branch"](70, 2)["found"] == 1
    assert TASKS["plain"](70, 2)["found"] == 1


def test_what_is_missing_is_shown() -> None:
    """A program that was stopped, one that lost solutions, one that was wrong."""

    def line(
        program: str, size: int, cpu: float, outcome: str, **more: object
    ) -> dict[str, object]:
        return {
            "program": program,
            "size": size,
            "cpu": cpu,
            "memory": 30.0,
            "outcome": outcome,
            **more,
        }

    results = {
        "lines": [
            line("exactfold, certificate", 4, 2.0, "complete"),
            line("exactfold, certificate", 6, 8.0, "complete"),
            line("a", 4, 4.0, "complete"),
            line("a", 6, 100.0, "limit reached"),
            line("b", 4, 1.0, "incomplete", found=15),
            line("c", 4, 3.0, "incomplete", found=16),
            line("d", 4, 3.0, "not applicable"),
        ]
    }
    assert main_table(results) == [
        ["program", "4", "6", "growth", "MB"],
        ["exactfold, certificate", "2.0", "8.0", "2.0", "30"],
        ["a", "4.0 (2.0x)", "> 100 (> 12x)", "", "30"],
        ["b", "1.0 (0.50x) **15 of 16**", "", "", "30"],
        ["c", "3.0 (1.5x) **not the same**", "", "", "30"],
    ]


def test_answers_are_read() -> None:
    assert read_msolve(MSOLVE) == [[-1.25, 0.75], [1, 0]]
    assert read_phcpack(PHCPACK) == [[-1.25 + 2e-20j, 0.75]]
    text = "\n{toCC(-.5p53e-1,.3p53e-30),toCC(2p53,0p53)}\n"
    assert read_macaulay2(text) == [[-0.05 + 3e-31j, 2]]


@pytest.mark.parametrize("text", ["[-1]:", "[1, 2, -1, []]:", ""])
def test_other_answers_of_msolve_are_refused(text: str) -> None:
    with pytest.raises((ValueError, TypeError)):
        read_msolve(text)


def test_only_complete_answers_are_complete() -> None:
    chart = BranchSystem(random_square(4, seed=1)).chart
    points = popping(chart).points
    proved = points.real
    assert judged(chart.system, proved, points[::-1])["found"] == 16
    assert judged(chart.system, proved, points[::-1])["same"]
    missing = judged(chart.system, proved, points[1:])
    assert (missing["found"], missing["same"]) == (15, False)
    doubled = points.copy()
    doubled[3] = doubled[7] * (1 + 1e-13)
    twice = judged(chart.system, proved, doubled)
    assert (twice["found"], twice["same"]) == (15, False)
    wrong = points.copy()
    wrong[5] += 1e-6
    assert judged(chart.system, proved, wrong)["found"] == 15
    wrong[5] = np.nan
    assert judged(chart.system, proved, wrong)["found"] == 15
    assert judged(chart.system, proved, points + 1.0)["found"] == 0
    # Points near zeros, all different, that are not the zeros proved.
    assert not judged(chart.system, proved + 1.0, points)["same"]


def test_residuals_are_those_of_fractions() -> None:
    system = BranchSystem(random_square(3, seed=2)).chart.system
    x = [Fraction(1, 2), Fraction(1, 4), Fraction(-1)]
    z = [*x, Fraction(1)]
    expected = max(
        abs(value) / sum(abs(matrix[i][j] * z[i] * z[j]) for i in range(4) for j in range(4))
        for value, matrix in zip(system.values_at(x), system.matrices, strict=True)
    )
    found = backward_errors(system, np.array([[0.5, 0.25, -1.0]], dtype=complex))
    assert found[0] == pytest.approx(float(expected), rel=1e-14)


def test_a_process_is_stopped_at_the_limit(tmp_path: Path) -> None:
    late = run([sys.executable, "-c", "while True: pass"], tmp_path, "late", 0.3)
    assert late.code is None
    failed = run([sys.executable, "-c", "raise SystemExit(3)"], tmp_path, "failed", 60.0)
    assert failed.code == 3


def test_the_plain_path_ends_at_the_branch_that_is_proved() -> None:
    pattern = random_square(9, seed=3)
    signs = "+-++-+--+"
    proved = find_branch(pattern, signs).approx_heights
    rim = next(v for v in pattern.boundary if proved[v] == 1.0)
    wanted = np.array([1.0 if sign == "+" else -1.0 for sign in signs])
    heights, steps = plain_branch(pattern, wanted, rim)
    assert heights == pytest.approx([proved[v] for v in range(len(heights))], abs=1e-9)
    assert steps > 1
