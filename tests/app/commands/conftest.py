"""A shipped pattern, and its certificate."""

import pytest
from running import PROVED, run

from exactfold.pattern.data import example_path


@pytest.fixture
def two_vertex():
    return example_path("two-vertex")


@pytest.fixture
def certificate(tmp_path, two_vertex):
    path = tmp_path / "two-vertex.txt"
    assert run("count", two_vertex, "--certificate", path).exit_code == PROVED
    return path
