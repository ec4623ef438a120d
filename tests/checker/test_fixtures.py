"""Certificates that earlier versions wrote: they must verify for ever."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typed_values import misfits

from exactfold import checker
from exactfold.checker.branches.compact import COMPACT
from exactfold.checker.command import kind_in_lines

FOLDER = Path(__file__).parent.parent / "fixtures" / "certificates"
FILES = sorted(path.name for path in FOLDER.iterdir() if path.suffix in (".json", ".txt"))


def test_there_are_certificates_of_every_kind() -> None:
    kinds = {name.split("-")[0] for name in FILES}
    assert kinds == {
        "listing",
        "algebraic",
        "rigid",
        "single",
        "compact",
        "branch",
        "panels",
        "motion",
        "panelmotion",
        "loops",
        "letters",
        "starting",
        "pieces",
        "periodic",
        "assignments",
        "meant",
        "freedom",
        "torques",
        "tolerance",
        "flat",
    }
    assert len(FILES) == 183


@pytest.mark.parametrize("name", FILES)
def test_certificates_of_earlier_versions_verify(name: str) -> None:
    path = FOLDER / name
    claims = checker.verify(path)
    assert list(misfits(claims.claims, claims.kind.claims)) == []
    assert (kind_in_lines(path) is COMPACT) == name.startswith("compact")
    last = path.read_text().splitlines()[-1]
    given = json.loads(last.partition("\t")[0])["claims"]
    assert {key: claims[key] for key in given} == given
