"""A square with one interior vertex as a FOLD file, for tests of the reader."""

import json

from exactfold.pattern.fold import parse_fold

SQUARE = {
    "vertices_coords": [[0, 0], [1, 0], [1, 1], [0, 1], [0.5, 0.25]],
    "edges_vertices": [[0, 1], [1, 2], [2, 3], [3, 0], [0, 4], [1, 4], [2, 4], [3, 4]],
    "edges_assignment": ["B", "B", "B", "B", "M", "V", "M", "U"],
    "faces_vertices": [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
}


def parse(*drop, snap=None, **changes):
    document = {k: v for k, v in (SQUARE | changes).items() if k not in drop}
    return parse_fold(json.dumps(document), snap)
