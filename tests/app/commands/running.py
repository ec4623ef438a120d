"""The command line in this process and as one of its own."""

from __future__ import annotations

import json
import subprocess
import sys
from typing import Any

from typer.testing import CliRunner, Result

from exactfold.app.cli import app

PROVED, INVALID, USAGE, BAD_INPUT, UNDECIDED = range(5)
DEFECT, OUTPUT_FAILED, INTERRUPTED = 70, 74, 130


def run(*arguments: object) -> Result:
    return CliRunner().invoke(app, [str(a) for a in arguments])


def process(*arguments: object, **options: Any) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "exactfold", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False, **options)


def error_class(result: Any) -> str:
    """The class in the JSON object of an error, whose message is the one line on stderr."""
    data = json.loads(result.stdout)
    assert (data["format"], data["version"]) == ("exactfold error result", 1)
    assert result.stderr.endswith(f"exactfold: {data['error']['message']}\n")
    assert data["error"]["class"] not in result.stderr
    return str(data["error"]["class"])
