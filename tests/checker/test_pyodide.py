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


def checked(folder, files):
    """The exit code and the words of the checker for each file, in the browser's Python."""
    archive = folder / "checker.zip"
    archive.write_bytes(base64.b64decode(page_checker("", "pyodide")["source"]))
    words = [NODE, str(HERE / "in_pyodide.cjs"), str(archive), *map(str, files)]
    done = subprocess.run(words, capture_output=True, text=True, check=True)
    return {line["file"]: line for line in map(json.loads, done.stdout.splitlines())}


def test_all_stored_certificates_are_valid(tmp_path):
    assert len(STORED) > 150
    found = checked(tmp_path, STORED)
    assert {name: line["text"] for name, line in found.items() if line["code"] != 0} == {}
    assert len(found) == len(STORED)


def test_the_words_are_those_of_the_checker(tmp_path):
    some = [file for file in STORED if file.stat().st_size < 4000][:12]
    found = checked(tmp_path, some)
    for file in some:
        here = subprocess.run(
            [sys.executable, str(Path(checker.__file__).parent), str(file)],
            capture_output=True,
            text=True,
            check=False,
        )
        line = found[str(file)]
        assert (line["code"], line["text"]) == (here.returncode, here.stdout.strip())


def test_false_certificates_are_refused(tmp_path):
    name = "algebraic-either-side.json"
    document = json.loads((FOLDER / name).read_text())
    document["pattern"]["vertices"][0][0] = "1/3"
    (tmp_path / "moved.json").write_text(json.dumps(document))
    (tmp_path / "cut.json").write_text(json.dumps(document)[:-5])
    found = checked(tmp_path, [tmp_path / "moved.json", tmp_path / "cut.json"])
    assert [line["code"] for line in found.values()] == [1, 3]
