"""`exactfold match --certificate`: a proof that `exactfold check` verifies, or a word why not."""

from __future__ import annotations

from pathlib import Path

import pytest
from running import run

from exactfold.pattern.data import example_path

FILE = str(example_path("two-vertex"))


@pytest.mark.parametrize(
    ("letters", "code", "text"),
    [("4-5=V", 0, "exactly 4 halves of branches have"), ("4-5=F", 1, "no branch has")],
)
def test_the_certificate_is_verified(letters: str, code: int, text: str, tmp_path: Path) -> None:
    path = tmp_path / "letters.json"
    done = run("match", FILE, "--letters", letters, "--tries", "0", "--certificate", str(path))
    assert done.exit_code == code
    checked = run("check", str(path))
    assert checked.exit_code == 0
    assert checked.stdout.startswith(f"VALID: {text} the 1 letter asked for on 7 folds; sha256 ")


def test_no_certificate_of_what_is_not_proved(tmp_path: Path) -> None:
    path = tmp_path / "letters.json"
    done = run("match", FILE, "--letters", "", "--most", "1", "--certificate", str(path))
    assert done.exit_code != 0
    assert not path.exists()


def test_the_pattern_is_not_written_over(tmp_path: Path) -> None:
    path = tmp_path / "sheet.fold"
    path.write_text(Path(FILE).read_text())
    done = run("match", str(path), "--letters", "4-5=V", "--certificate", str(path))
    assert done.exit_code == 2
    assert "this command already reads or writes" in done.stderr
