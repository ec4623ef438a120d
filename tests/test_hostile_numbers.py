"""Small files with extreme numbers: bounded time, and still a proof."""

import json
import time

import pytest

import exactfold

FILES = {
    "one vertex": (
        [[0, 0], [4e300, 0], [1, 1], [0, 1], [0.5, 0.25]],
        [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
        2,
    ),
    "two vertices": (
        [[0, 0], [4e300, 0], [4e300, 1], [0, 1], [0.3, 0.4], [0.7, 0.6]],
        [[0, 1, 4], [1, 5, 4], [1, 2, 5], [2, 3, 5], [3, 4, 5], [3, 0, 4]],
        4,
    ),
}


@pytest.mark.parametrize("name", FILES)
def test_a_coordinate_of_300_digits_is_counted_in_seconds(name, tmp_path):
    coordinates, faces, expected = FILES[name]
    path = tmp_path / "huge.fold"
    path.write_text(json.dumps({"vertices_coords": coordinates, "faces_vertices": faces}))
    assert path.stat().st_size < 180
    start = time.process_time()
    result = exactfold.count_branches(exactfold.load(path))
    assert time.process_time() - start < 15  # once more than a minute
    assert result.status is exactfold.PROVED
    assert (result.distinct, result.real) == (expected, expected)
    assert len(set(result.sign_vectors)) == expected // 2
