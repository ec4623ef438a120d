"""What the program from the formal proof, and the checker in Python, say of a file."""

import subprocess
from pathlib import Path
from typing import Any

from exactfold import checker


def run(program: Path, certificate: Path, *drawing: Path) -> tuple[int, str]:
    done = subprocess.run(
        [program, certificate, *drawing], capture_output=True, text=True, check=False
    )
    return done.returncode, done.stdout + done.stderr


def valid(path: Path) -> dict[str, Any] | None:
    """The claims that the checker in Python verifies, if it does."""
    try:
        return dict(checker.verify(str(path)))
    except (checker.CertificateError, checker.FormatError):
        return None
