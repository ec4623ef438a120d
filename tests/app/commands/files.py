"""Files of the tests of the command line."""

import json

CORNERS = [[0, 0], [1, 0], [1, 1], [0, 1], [0.5, 0.25]]
FACES = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]


def written(tmp_path, document):
    path = tmp_path / "bad.fold"
    path.write_text(document if isinstance(document, str) else json.dumps(document))
    return path
