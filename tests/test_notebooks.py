"""The notebooks are small and tidy, and print what is stored when they are run."""

import json
import re
import runpy
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))


def cells(path, kind):
    notebook = json.loads(path.read_text("utf-8"))
    return [cell for cell in notebook["cells"] if cell["cell_type"] == kind]


def printed(cell):
    """What a cell shows as text, and in which other kinds, such as pictures."""
    texts, kinds = [], []
    for output in cell["outputs"]:
        assert output["output_type"] in ("stream", "display_data", "execute_result"), output
        assert output.get("name") != "stderr", output
        data = output.get("data", {})
        texts.append("".join(output.get("text", data.get("text/plain", ""))))
        kinds.append(set(data))
    return texts, kinds


def test_there_is_one_for_each_kind_of_reader():
    names = [path.stem for path in NOTEBOOKS]
    assert names == ["engineer", "mathematician", "physicist"]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebooks_are_small_and_hold_no_traces_of_a_machine(path):
    text = path.read_text("utf-8")
    assert len(text) < 400_000
    assert not re.search(r"/home/|/work/|/tmp/|/root/|0x[0-9a-f]{6,}|\d\.\d+ ?s\b", text)
    code = cells(path, "code")
    assert 10 <= len(code) <= 20
    assert [cell["execution_count"] for cell in code] == list(range(1, len(code) + 1))


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_links_of_notebooks_lead_somewhere(path):
    text = "".join(line for cell in cells(path, "markdown") for line in cell["source"])
    links = re.findall(r"\]\((?!http)([^)#]+)\)", text)
    assert links
    assert [link for link in links if not (path.parent / link).exists()] == []


@pytest.mark.slow
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebooks_print_what_is_stored(path):
    for package in ("nbclient", "ipykernel", "pyrigi", "trimesh"):
        pytest.importorskip(package, reason=f"{package} is not installed")
    executed = runpy.run_path(str(ROOT / "docs" / "make_notebooks.py"))["executed"]
    again = [cell for cell in executed(path)["cells"] if cell["cell_type"] == "code"]
    for before, after in zip(cells(path, "code"), again, strict=True):
        (texts, kinds), (old_texts, old_kinds) = printed(after), printed(before)
        assert texts == old_texts, "".join(before["source"])
        assert all(old <= new for old, new in zip(old_kinds, kinds, strict=True))
