"""`exactfold check`: files that are taken for certificates, and what they are called."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from exactfold import checker
from exactfold.app.cli import app
from exactfold.pattern.data import example_path

FIXTURES = Path(__file__).parent.parent / "fixtures" / "certificates"
BRANCH = FIXTURES / "branch-dart.json"
TWO = str(example_path("two-vertex"))


def said(*arguments: str) -> tuple[int, str]:
    done = CliRunner().invoke(app, ["check", *arguments])
    return done.exit_code, done.stdout + done.stderr


@pytest.mark.parametrize(
    ("name", "code"), [("listing-cross.json", 0), ("compact-exact.txt", 0), ("branch-dart.json", 0)]
)
def test_every_kind_is_recognised(name: str, code: int) -> None:
    found, text = said(str(FIXTURES / name))
    assert (found, text[:7]) == (code, "VALID: ")


def test_a_fold_file_is_no_certificate() -> None:
    code, text = said(TWO)
    assert code == 3
    assert text.endswith("this is a FOLD file, which is a crease pattern and not a certificate\n")
    assert text.count("\n") == 1


@pytest.mark.parametrize(
    ("command", "advice"),
    [
        (["count", TWO], "count --json, and not a certificate; write a certificate with --cert"),
        (
            ["branch", TWO, "--signs", "+-"],
            "branch --json, and not a certificate; write a certificate with --certificate\n",
        ),
        *(
            (
                command,
                f"{command[0]} --json, and not a certificate; give a certificate: count and branch "
                "write one with --certificate\n",
            )
            for command in (["info", TWO], ["examples"], ["check", str(BRANCH)])
        ),
    ],
)
def test_printed_results_are_no_evidence(
    command: list[str], advice: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "result.json"
    path.write_text(CliRunner().invoke(app, [*command, "--json"]).stdout)
    code, text = said(str(path))
    assert code == 3
    assert f"{path}: this is the result printed by {advice}" in text
    assert checker.main([str(path)]) == 3
    assert advice in capsys.readouterr().err


@pytest.mark.parametrize(
    "text", ['{"pattern": {}}', '{"status": 1.5}', "[1.5]", '{"a": NaN}', "[" * 99999]
)
def test_of_other_files_nothing_is_said_but_what_is_wrong(text: str, tmp_path: Path) -> None:
    path = tmp_path / "other.json"
    path.write_text(text)
    code, message = said(str(path))
    assert code == 3
    assert "this is" not in message


def test_a_pipe_is_called_by_its_name() -> None:
    code, text = said("/dev/null")
    assert code == 3
    assert "exactfold: /dev/null: not JSON, or cut off" in text
    done = CliRunner().invoke(app, ["check", str(FIXTURES / "none.json")])
    assert done.exit_code == 3
    assert f"cannot read {FIXTURES / 'none.json'}: No such file" in done.stderr


def test_claims_that_grow_with_the_pattern_are_left_out() -> None:
    for name in ("listing-cross.json", "branch-dart.json"):
        printed = json.loads(said(str(FIXTURES / name), "--json")[1])
        assert printed["valid"]
        assert not {"branches", "vertex_signs", "assignment"} & printed["claims"].keys()


@pytest.mark.slow
def test_lines_of_results_are_no_evidence(tmp_path: Path) -> None:
    path = tmp_path / "r.jsonl"
    for names in ([TWO], [TWO, "flat-vertex"]):
        path.unlink(missing_ok=True)
        CliRunner().invoke(app, ["count", *names, "--jsonl", str(path)])
        assert said(str(path)) == (
            3,
            f"exactfold: {path}: this is a file of results, as count --jsonl writes it, and "
            "not a certificate; count one pattern with --certificate or --stream\n",
        )
