"""Every proof goes through, and every deliberate mistake in one is refused."""

import importlib
import json
import runpy
import sys
from collections.abc import Iterable
from pathlib import Path

import pytest

from exactfold.verdict import PROVED, REFUTED
from proofs import MODULES
from proofs.__main__ import load, main
from proofs.framework import Ruling

ROOT = Path(__file__).parent.parent.parent


LONG = (
    "all_real",
    "branch_angles",
    "discussion_counts",
    "generic",
    "inertia",
    "inertia_cases",
    "multiplicity",
    "random_squares",
)
"""Proofs that take a second or more each: CI goes through them as well."""


def failed(names: Iterable[str]) -> dict[str, list[str]]:
    """The steps that do not hold, of the proofs that do not go through."""
    return {
        name: [step.text for step in load(name).steps if not step.holds]
        for name in names
        if load(name).verdict is not PROVED
    }


def test_every_short_proof_holds() -> None:
    """One test for all, as each process would run them again."""
    assert failed(set(MODULES) - set(LONG)) == {}


@pytest.mark.slow
def test_every_proof_holds_and_the_pages_show_it() -> None:
    assert failed(MODULES) == {}
    proofs = {name: load(name) for name in MODULES}
    statements = [statement for proof in proofs.values() for statement in proof.statements]
    assert len({statement.key for statement in statements}) == len(statements)
    for statement in statements:
        assert bool(statement.corrected) == (statement.ruling is not Ruling.AS_PRINTED)
    folder = ROOT / "docs"
    pages = runpy.run_path(str(folder / "make_statements.py"))["pages"]()
    assert sorted(pages) == ["errata.md", "statements.md"]
    for name, text in pages.items():
        assert (folder / name).read_text(encoding="utf-8") == text


LONGEST = {*LONG, "curvature_expansion", "hub_balance", "panels", "wheel_stress"}
"""Those whose changes take more than five seconds to try: by hand, with `-m survey`."""


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(x, marks=getattr(pytest.mark, "survey" if x in LONGEST else "slow"))
        for x in MODULES
    ],
)
def test_every_change_is_refused_and_every_step_refuses_one(name: str) -> None:
    module, proof = importlib.import_module(f"proofs.{name}"), load(name)
    assert proof.changes, "a proof that cannot be broken proves nothing"
    assert len(set(proof.changes)) == len(proof.changes)
    never_failed = dict(enumerate(step.text for step in proof.steps))
    for change in proof.changes:
        changed = module.prove(change)
        assert changed.verdict is REFUTED, change
        assert len(changed.steps) == len(proof.steps), change
        for k, step in enumerate(changed.steps):
            if not step.holds:
                never_failed.pop(k, None)
    assert list(never_failed.values()) == [], "steps that no deliberate mistake breaks"


def test_is_not_proved_with_an_unknown_change() -> None:
    module = importlib.import_module(f"proofs.{MODULES[0]}")
    with pytest.raises(ValueError, match="no change"):
        module.prove("no such change")


@pytest.mark.parametrize("name", [MODULES[0], "inertia"])  # inertia imports helper modules
def test_runs_alone(
    name: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "argv", [name])
    with pytest.raises(SystemExit) as stop:
        runpy.run_path(str(ROOT / "proofs" / f"{name}.py"), run_name="__main__")
    assert stop.value.code == 0
    assert "Verdict: proved" in capsys.readouterr().out


def test_json_lists_every_step(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([MODULES[0], "--json"]) == 0
    (proof,) = json.loads(capsys.readouterr().out)["proofs"]
    assert len(proof["steps"]) == len(load(MODULES[0]).steps)
