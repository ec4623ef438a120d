"""Every proof goes through, and every deliberate mistake in one is refused."""

import importlib
import json
import random
import runpy
import sys
from collections.abc import Iterable
from pathlib import Path

import pytest

from proofs import MODULES
from proofs.__main__ import load, main
from proofs.formulas import latex
from proofs.mutation import mutants
from proofs.reading import parse
from proofs.statements import Ruling

ROOT = Path(__file__).parent.parent.parent


LONG = (
    "all_real",
    "branch_angles",
    "discussion_counts",
    "exceptions",
    "force_balance",
    "generic",
    "hub_balance",
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
        if not load(name).holds
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
        assert bool(statement.severity) == (statement.ruling is not Ruling.AS_PRINTED)
        assert bool(statement.corrected) == (statement.ruling is Ruling.CORRECTED)
        assert not (statement.is_own and statement.severity)
    keys = {statement.key for statement in statements}
    named = [key for proof in proofs.values() for s in proof.steps for key in (*s.of, *s.against)]
    rests = [key for statement in statements for key in statement.rests.split()]
    assert {*named, *rests} <= keys
    folder = ROOT / "docs"
    pages = runpy.run_path(str(folder / "make_statements.py"))["pages"]()
    assert sorted(pages) == ["errata.md", "statements.md"]
    for name, text in pages.items():
        assert (folder / name).read_text(encoding="utf-8") == text


LONGEST = {
    *LONG,
    "curvature_expansion",
    "hub_balance",
    "panels",
    "wheel_stress",
    "kapovich_millson",
    "vertex_eigenvalues",
    "vertex_forms",
}
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
    never_failed = {k: s.text for k, s in enumerate(proof.steps) if not s.formula}
    for change in proof.changes:
        changed = module.prove(change)
        assert changed.verdict == "refuted", change
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


SURVIVORS = {
    "C.1": (r"\sum_{n=1}^{N}A_{n+1}",),  # the sum goes round the hub
    "C.5": ("^{N}(", "^{N+1}("),  # the terms that are added have the factor h_N = 0 or h_1 = 0
    "C.8": (r"m=1+1,\dots", "N-2-1"),  # a shorter range says less
    "C.9": (r"m=1+1,\dots", "N-2-1"),
    "C.14": (r"j=2+1,\dots", "N-1-1"),
}
"""Parts of the mutated formulas that hold as well, and why."""


def survivors(name: str, draws: int | None) -> dict[str, list[str]]:
    """The mutated formulas of a script, or as many of each as are drawn, that still hold."""
    found: dict[str, list[str]] = {}
    for claim in load(name).claims:
        every = mutants(claim.right)
        chosen = every if draws is None else random.Random(claim.key).sample(every, draws)
        found[claim.key] = [latex(wrong) for wrong in chosen if claim.holds(wrong)]
    return found


FORMULAS = (
    "counting",
    "discussion_counts",
    "force_balance",
    "hub_balance",
    "kapovich_millson",
    "vertex_eigenvalues",
    "vertex_forms",
)


@pytest.mark.parametrize(
    ("name", "draws"),
    [
        *(pytest.param(x, 3, marks=pytest.mark.slow) for x in ("force_balance", "vertex_forms")),
        *(
            pytest.param(x, None, marks=pytest.mark.survey)
            for x in (*FORMULAS, "curvature_expansion")
        ),
    ],
)
def test_mutated_formulas_are_refuted_or_explained(name: str, draws: int | None) -> None:
    for key, left in survivors(name, draws).items():
        explained = SURVIVORS.get(key, ())
        assert [wrong for wrong in left if not any(part in wrong for part in explained)] == []


def test_a_garbled_correction_and_a_flipped_sign_do_not_hold() -> None:
    claims = {c.key: c for name in ("vertex_forms", "force_balance") for c in load(name).claims}
    continuant, rim = claims["C.7"], claims["B.1"]
    garbled = latex(continuant.right).replace("f_{N+1}", "f_{N}")
    assert continuant.holds(continuant.right)
    assert continuant.is_refuted
    assert not continuant.holds(parse(garbled, ["chi"]))
    assert rim.holds(rim.printed)
    assert not rim.holds(parse(latex(rim.printed).replace("=-", "=")))


def test_formulas_are_read_as_they_are_written() -> None:
    for name in ("vertex_forms", "force_balance"):
        for claim in load(name).claims:
            assert parse(latex(claim.right), ["chi"]) == claim.right


def test_shows_the_steps_of_a_statement(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["C.7"]) == 0
    text = capsys.readouterr().out
    assert "rests on:  proved for all" in text
    assert "[ok] counterexample: C.7 as printed does not hold  [against C.7]" in text


def test_statement_error() -> None:
    with pytest.raises(SystemExit):
        main(["--list", "no_script"])
