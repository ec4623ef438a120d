"""What a count records and reports."""

import numpy as np

from exactfold import PROVED, random_square
from exactfold.branches import count_branches
from exactfold.pattern.families import two_vertex
from exactfold.solve.numeric.dense_newton import NappeSystem, SweptPoints


def test_progress_is_reported():
    seen = []
    count_branches(random_square(3, seed=0), progress=lambda *event: seen.append(event))
    assert [stage for stage, done, total in seen if done == total == 8] == ["solving", "certifying"]


def test_progress_of_the_exact_engine_is_reported():
    seen = []
    count_branches(two_vertex(), method="groebner", progress=lambda *event: seen.append(event))
    assert seen[:2] == [("computing a Groebner basis", 0, 1), ("computing a Groebner basis", 1, 1)]


def test_settings_and_time_are_recorded():
    result = count_branches(two_vertex(), method="homotopy", seed=7)
    assert result.method == "homotopy"
    assert result.settings["seed"] == 7
    assert result.settings["lost"] == 0
    assert result.seconds > 0


def test_auto_turns_to_the_exact_engine_where_newton_loses_a_zero(monkeypatch):
    real = NappeSystem.ends_of_block

    def spoiled(system, first, count):
        ends = real(system, first, count)
        points = np.vstack([ends.points[:-1], ends.points[:1]])  # the last path is lost
        return SweptPoints(points, np.arange(count) < count - 1, ends.steps)

    monkeypatch.setattr(NappeSystem, "ends_of_block", spoiled)
    exactly = count_branches(random_square(2, seed=0))
    assert (exactly.status, exactly.method) == (PROVED, "groebner")
