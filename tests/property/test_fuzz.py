"""What `fuzz.py` has found is in order now, and it still finds what is wrong."""

from __future__ import annotations

import json
import os
from io import BytesIO
from pathlib import Path
from random import Random
from typing import Any

import damage
import fuzz
import pytest

from exactfold import checker
from exactfold.checker.command import KINDS
from exactfold.checker.core.lines import lines as lines_of
from exactfold.checker.core.reading import MALFORMED
from exactfold.pattern.drawing.formats.read import READERS

STORED = sorted(path for path in fuzz.FOUND.glob("*/*") if path.suffix != ".md")
SQUARE = next(x for x in damage.files() if x.origin == "square.cp")
PROOF = next(x for x in damage.files() if x.origin == "torques-branch-two.json")


@pytest.mark.parametrize("path", STORED, ids=lambda path: path.name)
def test_inputs_that_were_found(path: Path) -> None:
    given = damage.stored(path)
    assert given.kept(fuzz.FOUND) == path
    assert fuzz.defect(given) is None


def test_every_format_and_every_kind_is_changed() -> None:
    read = {Path(x.origin).suffix[1:] for x in damage.files() if x.how == "read"}
    assert read == {*READERS, "json"}
    checked = {_format(x.content) for x in damage.files() if x.how == "check"}
    assert checked == {(kind.format, getattr(kind, "named", None)) for kind in KINDS}


def _format(content: bytes) -> tuple[str, str | None]:
    document = json.JSONDecoder().raw_decode(content.decode())[0]
    return document["format"], document.get("kind")


def test_files_are_really_changed_and_most_lines_have_right_digests() -> None:
    source = Random(3)
    for given in damage.files()[::9]:
        several = {damage.changed(given, source.randrange).content for _ in range(10)}
        assert len(several - {given.content}) > 5
    (lines,) = (x for x in damage.files() if x.origin == "loops-one-vertex.txt")
    messages = []
    for _ in range(40):
        content = damage.changed(lines, source.randrange).content
        try:
            list(lines_of(BytesIO(content)))
        except checker.FormatError as error:
            messages.append(str(error))
    assert 0 < len(messages) < 20


@pytest.mark.parametrize("error", [*MALFORMED, UnicodeError, RecursionError, MemoryError])
def test_other_errors_are_defects(error: type[Exception], monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object) -> None:
        raise error("planted")

    monkeypatch.setattr(fuzz, "opened", broken)
    assert str(fuzz.defect(SQUARE)).startswith(f"{error.__name__} in test_fuzz.py, line ")
    monkeypatch.setattr(checker, "verify", broken)
    assert str(fuzz.defect(PROOF)).startswith(f"{error.__name__} in test_fuzz.py, line ")


def test_endless_work_is_a_defect(monkeypatch: pytest.MonkeyPatch) -> None:
    def endless(*_: object) -> None:
        while True:
            pass

    monkeypatch.setattr(fuzz, "SECONDS", 0.1)
    monkeypatch.setattr(fuzz, "opened", endless)
    assert fuzz.defect(SQUARE) == "more than 0 s"


@pytest.mark.parametrize(
    ("key", "claim", "wrong"),
    [
        ("margin", "1", True),
        ("margin", "1/500000000000000", False),
        ("margin", "491018020530223/500000000000000", False),
        ("assignment", [], True),
        ("self_foldable", None, True),
        ("limit", None, True),
        ("more", 1, True),
    ],
)
def test_other_claims_that_are_valid_are_defects(
    key: str, claim: Any, wrong: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    verified = checker.verify(damage.CERTIFICATES / PROOF.origin)
    monkeypatch.setattr(checker, "verify", lambda _: {**verified, key: claim})
    monkeypatch.setattr(fuzz, "_truth", lambda _: dict(verified))
    found = fuzz.defect(PROOF)
    assert (found is not None) == wrong
    if found:
        assert found.startswith(f"VALID with other claims, {key}: '{key}': ")


@pytest.mark.parametrize(
    ("key", "claim", "true", "less"),
    [
        ("length", "1/3", "2/6", True),
        ("length", "1/4", "1/3", True),
        ("length", "1/2", "1/3", False),
        ("radius", "1/1" + 5000 * "0", "1/3", True),
        ("limit", "1/4", "1/3", False),
        ("bound", "1/4", "1/3", False),
        ("bound", "1/2", "1/3", True),
        ("squared_distance", "2", "1", True),
        ("squared_distance", "1/2", "1", False),
        ("contact", {"time": ["0", "3"]}, {"time": ["1", "2"]}, True),
        ("contact", {"time": ["1", "3/2"]}, {"time": ["1", "2"]}, False),
        ("contact", {"time": ["3/2", "2"]}, {"time": ["1", "2"]}, False),
        ("contact", {}, {"time": ["1", "2"]}, False),
        ("number", True, 1, False),
        ("number", 1, 1, True),
        ("vertex_signs", "+-", "-+", False),
        ("branches", [2, 1], [1, 2], True),
        ("branches", [1, 1], [1, 2], False),
    ],
)
def test_which_claims_say_less(key: str, claim: Any, true: Any, less: bool) -> None:
    assert fuzz._follows(key, {key: claim}, {key: true}) == less


def test_another_question_is_another_proof() -> None:
    claims = {"sha256": "a", "stop": {"angles": [[2, 3, "80"]], "fold": [2, 3]}}
    assert fuzz._asked(claims) == fuzz._asked({**claims, "margin": 1})
    assert fuzz._asked(claims) != fuzz._asked({**claims, "sha256": "b"})
    assert fuzz._asked(claims) != fuzz._asked({**claims, "stop": {"angles": []}})


def test_the_two_checkers_must_agree(monkeypatch: pytest.MonkeyPatch) -> None:
    def of_two_minds(_: str, engine_of: object = None) -> dict[str, int]:
        if engine_of is None:
            raise checker.CertificateError("no")
        return {}

    (lines,) = (x for x in damage.files() if x.origin == "loops-one-vertex.txt")
    monkeypatch.setattr(checker, "verify", of_two_minds)
    assert "the two checkers differ" in str(fuzz.defect(lines))


def run(folder: Path, *more: str) -> int:
    options = ["--seconds", "3", "--workers", "1", "--only", "square.cp", "--folder", str(folder)]
    return fuzz.main([*options, *more])


def test_a_run_without_defects(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert fuzz.defect(SQUARE) is None  # which loads what reads it
    assert run(tmp_path) == 0
    first, last = capfd.readouterr().out.splitlines()
    assert first.startswith("1 files, --seed ")
    assert last.endswith(" read, 0 checked, 0 defects")
    assert int(last.split()[0]) > 10
    assert list(tmp_path.iterdir()) == []


def test_a_run_with_a_defect(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """What it finds is made small, and the stored file shows the defect again."""

    def broken(content: bytes, *_: object) -> None:
        assert b"x" not in content.lower(), "planted"

    monkeypatch.setattr(fuzz, "opened", broken)
    monkeypatch.setattr(damage, "_WORDS", [b"x", b"X", b"0"])
    assert run(tmp_path, "--seed", "5") == 1
    (path,) = (tmp_path / "read").iterdir()
    _, told, last = capfd.readouterr().out.splitlines()
    assert told.startswith(f"DEFECT read/{path.name}: AssertionError in test_fuzz.py, line ")
    assert last.endswith(", 1 defects")
    given = damage.stored(path)
    assert (given.how, given.origin) == ("read", "square.cp")
    assert "planted" in str(fuzz.defect(given))
    assert abs(len(given.content) - len(SQUARE.content)) < 3


def test_the_end_of_a_process_is_a_defect(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(fuzz, "opened", lambda *_: os._exit(5))
    assert run(tmp_path) == 1
    assert "DEFECT read/square-" in (out := capfd.readouterr().out)
    assert "the process ended with 5" in out
    assert len(list((tmp_path / "read").iterdir())) == 1


def test_no_file_of_that_name(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        fuzz.main(["--only", "no such file"])
    assert "no file has 'no such file' in its name" in capsys.readouterr().err
