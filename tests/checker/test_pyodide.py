"""The checker that pages contain, under Pyodide in Node, on all stored certificates."""

import base64
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from exactfold import checker
from exactfold.app.viewer.checking import page_checker

HERE = Path(__file__).parent
FOLDER = HERE.parent / "fixtures" / "certificates"
STORED = sorted(path for path in FOLDER.iterdir() if path.suffix in (".json", ".txt"))
NODE = shutil.which("node")
PYODIDE = Path(os.environ.get("NODE_PATH", ""), "pyodide")

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(
        NODE is None or not (PYODIDE / "pyodide.mjs").exists(),
        reason="Node, or the npm package pyodide (in NODE_PATH), is not installed",
    ),
]


def forged(folder):
    """A certificate of another sheet, and one that ends too early."""
    document = json.loads((FOLDER / "algebraic-either-side.json").read_text())
    document["pattern"]["vertices"][0][0] = "1/3"
    (folder / "moved.json").write_text(json.dumps(document))
    (folder / "cut.json").write_text(json.dumps(document)[:-5])
    return [folder / "moved.json", folder / "cut.json"]


@pytest.fixture(scope="module")
def checked(tmp_path_factory):
    """What the checker says of each file in the browser's Python, which is started once."""
    folder = tmp_path_factory.mktemp("pyodide")
    archive = folder / "checker.zip"
    archive.write_bytes(base64.b64decode(page_checker("", "pyodide")["source"]))
    files = [*STORED, *forged(folder)]
    words = [NODE, str(HERE / "in_pyodide.cjs"), str(archive), *map(str, files)]
    done = subprocess.run(words, capture_output=True, text=True, check=True)
    return {Path(line["file"]): line for line in map(json.loads, done.stdout.splitlines())}


def test_all_stored_certificates_are_valid(checked):
    assert len(STORED) > 150
    refused = {file.name: checked[file]["text"] for file in STORED if checked[file]["code"] != 0}
    assert refused == {}


def test_the_words_are_those_of_the_checker(checked):
    for file in [file for file in STORED if file.stat().st_size < 4000][:12]:
        here = subprocess.run(
            [sys.executable, str(Path(checker.__file__).parent), str(file)],
            capture_output=True,
            text=True,
            check=False,
        )
        line = checked[file]
        assert (line["code"], line["text"]) == (here.returncode, here.stdout.strip())


def test_false_certificates_are_refused(checked):
    codes = {file.name: line["code"] for file, line in checked.items() if file not in STORED}
    assert codes == {"moved.json": 1, "cut.json": 3}
