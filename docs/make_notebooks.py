"""Run the notebooks in docs/notebooks and store what they print.

`python docs/make_notebooks.py [NAME ...]` runs them in place, with the packages of
`pip install 'exactfold[notebooks]'`. What changes from run to run is left out: times of execution,
and the seconds that an answer took. The tests run them again and compare.
"""

from __future__ import annotations

import json
import re
import sys
import tempfile
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).with_name("notebooks")
SECONDS = 300
"""After which a cell is given up."""
_SECONDS = re.compile(r"\(\d+(\.\d+)? s\)")


def executed(path: Path) -> dict[str, Any]:
    """The notebook with the outputs of a run in an empty folder, as JSON.

    Raises `nbclient.exceptions.CellExecutionError` if a cell raises.
    """
    import nbformat
    from nbclient import NotebookClient

    notebook = nbformat.read(path, as_version=4)
    with tempfile.TemporaryDirectory() as folder:
        client = NotebookClient(
            notebook,
            timeout=SECONDS,
            kernel_name="python3",
            record_timing=False,
            coalesce_streams=True,
            resources={"metadata": {"path": folder}},
        )
        client.execute()
    found: dict[str, Any] = json.loads(nbformat.writes(notebook))
    found["metadata"] = {
        "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
        "language_info": {"name": "python"},
    }
    for cell in found["cells"]:
        cell["metadata"] = {}
        for output in cell.get("outputs", ()):
            if "text/html" in (data := output.get("data", {})):
                data["text/html"] = [_SECONDS.sub("(... s)", line) for line in data["text/html"]]
    return found


def main() -> None:
    """Run the notebooks that are named, or all of them."""
    names = sys.argv[1:] or sorted(path.stem for path in FOLDER.glob("*.ipynb"))
    for name in names:
        path = FOLDER / f"{name}.ipynb"
        text = json.dumps(executed(path), indent=1, ensure_ascii=False)
        path.write_text(f"{text}\n", encoding="utf-8")
        print(f"{path.name}: {len(text) // 1024} KB")


if __name__ == "__main__":
    main()
