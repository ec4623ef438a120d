"""Every proof goes through, and every deliberate mistake in one is refused."""

import importlib
import json
import random
import re
import runpy
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pytest

from proofs import MODULES
from proofs.__main__ import load, main
from proofs.claims import Claim
from proofs.formulas import latex
from proofs.framework import Proof, Script, report_statement
from proofs.mutation import garbled, survivors
from proofs.quotations import UNPRINTED, digest, plain
from proofs.reading import Text, read
from proofs.replacements import REPLACEMENTS
from proofs.statements import Ruling, Severity

ROOT = Path(__file__).parent.parent.parent
QUOTATIONS = Path(__file__).parent / "quotations.json"
"""Digests of what the paper prints, by the key of the statement; written by docs/read_paper.py."""


LONG = (
    "all_real",
    "branch_angles",
    "curvature_expansion",
    "discussion_counts",
    "exceptions",
    "force_balance",
    "generic",
    "hub_balance",
    "inertia",
    "inertia_cases",
    "length_equations",
    "multiplicity",
    "periodic",
    "periodic_directions",
    "random_squares",
    "second_order_motions",
    "vertex_eigenvalues",
    "vertex_forms",
)
"""Proofs that take a second or more each: CI goes through them as well."""


def failed(names: Iterable[str]) -> dict[str, list[str]]:
    """The steps that do not hold, of the proofs that do not go through."""
    return {
        name: [step.text for step in load(name).steps if not step.holds]
        for name in names
        if not load(name).holds
    }


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
    check_errata(pages["errata.md"], proofs.values())
    claims = [claim for proof in proofs.values() for claim in proof.claims]
    assert [wrong for claim in claims for wrong in unexplained(claim)] == []
    assert set(SURVIVORS) <= {claim.key for claim in claims}
    digests = json.loads(QUOTATIONS.read_text(encoding="utf-8"))
    assert {s.key: digest(s.source) for s in statements if not s.is_own} == digests
    assert set(UNPRINTED) <= {claim.key for claim in claims}
    for claim in claims:
        check_replacement(claim)


def check_errata(page: str, proofs: Iterable[Proof]) -> None:
    """Everything that does not hold as printed is on the page; the command prints what to paste."""
    stated = [(s, p) for p in proofs for s in p.statements if s.ruling is not Ruling.AS_PRINTED]
    wrong = {s.key for s, _ in stated}
    assert set(re.findall(r"(?m)^\*\*([IVABCD]+\.\d+)\*\* \(", page)) == wrong == set(REPLACEMENTS)
    entries = re.split(r"(?m)^(?=\*\*[IVABCD]+\.\d+\*\* \()", page)[1:]
    for statement, proof in stated:
        (entry,) = (e for e in entries if e.startswith(f"**{statement.key}**"))
        entry = " ".join(entry.split())
        assert f"Eq. ({statement.equation})" in entry or not statement.equation
        assert statement.severity
        assert f"*{statement.severity.value.capitalize()}.*" in entry
        assert "- why: " in entry
        assert f"[{proof.name}](../proofs/{proof.name}.py)" in entry
        printed = report_statement(proof, statement)
        for old, new in REPLACEMENTS[statement.key]:
            assert f"replace\n{old}\nby\n{new}" in printed
    for pairs in REPLACEMENTS.values():
        for old, new in pairs:
            braces = [text.count("{") - text.count("}") for text in (old, new)]
            assert braces[0] == braces[1]
            assert old.count("$") % 2 == new.count("$") % 2


def check_replacement(claim: Claim) -> None:
    """What is to be pasted has the sides of the corrected formulas in it."""
    if claim.printed == claim.right:
        return
    new = plain(" ".join(new for _, new in REPLACEMENTS[claim.key]))
    for formula in claim.right.formulas:
        assert plain(latex(formula.sides[-1])) in new, claim.key


LONGEST = {
    *LONG,
    "panels",
    "wheel_stress",
    "kapovich_millson",
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


@pytest.mark.slow
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


@pytest.mark.slow
def test_json_lists_every_step(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([MODULES[0], "--json"]) == 0
    (proof,) = json.loads(capsys.readouterr().out)["proofs"]
    assert len(proof["steps"]) == len(load(MODULES[0]).steps)


SHORTER = "a shorter range says less"
SURVIVORS = {
    "B.19": {r"\beta_{i}=-\pi-\alpha_{i-1,i}-\alpha_{i,i+1}": "-pi and pi are the same angle"},
    "C.1": {r"-h_{0}^{2}\sum_{n=1}^{N}A_{n+1}": "the sum goes round the hub"},
    "C.5": {
        r"0=\sum_{n=2}^{N+1}(": "the terms that are added have the factor h_N = 0 or h_1 = 0",
        r"0=\sum_{n=2}^{N}(": "the term that is added has the factor h_N = 0",
    },
    "C.8": {r",\quad m=1+1,\dots": SHORTER, r"\dots,N-2-1": SHORTER},
    "C.9": {r",\quad m=1+1,\dots": SHORTER, r"\dots,N-2-1": SHORTER},
    "C.14": {r",\quad j=2+1,\dots": SHORTER, r"\dots,N-1-1": SHORTER},
    "IIIA.12": {
        r"\le3^{V_{i}-V_{t}}": "a weaker bound",
        r"\le2^{V_{i}+V_{t}}": "a weaker bound",
        r"\le2^{V_{i}}\text": "a weaker bound",
    },
}
"""The formulas with one mistake that hold all the same, by what is wrong in them, and why."""


def unexplained(claim: Claim) -> list[str]:
    """The formulas with a mistake that hold and are not in the list, and what of it does not."""
    explained = SURVIVORS.get(claim.key, {})
    left = survivors(claim)
    return [
        *(wrong for wrong in left if not any(part in wrong for part in explained)),
        *(part for part in explained if not any(part in wrong for wrong in left)),
    ]


def drawn(claim: Claim, number: int) -> list[Text]:
    """Formulas with one mistake, drawn at random."""
    return random.Random(claim.key).sample(list(garbled(claim.right)), number)


def test_formulas_with_mistakes_drawn_at_random_do_not_hold() -> None:
    claims = [c for name in sorted(set(MODULES) - set(LONG)) for c in load(name).claims]
    assert len(claims) > 15
    held = [text.latex for c in claims for text in drawn(c, 3) if c.holds(text)]
    known = [part for parts in SURVIVORS.values() for part in parts]
    assert [text for text in held if not any(part in text for part in known)] == []


@pytest.mark.slow
def test_a_word_or_a_sign_that_the_paper_does_not_print_is_noticed() -> None:
    digests = json.loads(QUOTATIONS.read_text(encoding="utf-8"))
    for name in ("vertex_forms", "kapovich_millson"):
        for statement in load(name).statements:
            assert digest(statement.source) == digests[statement.key]
            for wrong in (
                statement.source.replace("+", "-", 1),
                statement.source.replace("the", "no", 1),
                "0" + statement.source,
            ):
                assert wrong == statement.source or digest(wrong) != digests[statement.key]


def test_rulings_that_do_not_follow_are_refused() -> None:
    def stated(**fields: Any) -> Proof:
        script = Script("demo", "Demo", ())
        script.example("a step", True, of="A.1")
        script.state("A.1", "Demo", "0=0", **fields)
        return script.proof()

    assert stated().statements[0].ruling is Ruling.AS_PRINTED
    for fields in ({"severity": Severity.TYPO}, {"corrected": "1=1"}, {"contradiction": "x"}):
        with pytest.raises(ValueError, match="go together"):
            stated(**fields)


def test_as_many_expressions_are_evaluated_in_both_forms() -> None:
    script = Script("demo", "Demo", ())
    with pytest.raises(ValueError, match="the same number of expressions"):
        script.formula("A.1", "Demo", r"1+1\text{ or }1+2", "1+1", at=[{"values": (2,)}])


@pytest.mark.slow
def test_a_garbled_correction_and_a_flipped_sign_do_not_hold() -> None:
    claims = {c.key: c for name in ("vertex_forms", "force_balance") for c in load(name).claims}
    continuant, rim = claims["C.7"], claims["B.1"]
    garbled_text = continuant.right.latex.replace("f_{N+1}", "f_{N}")
    assert continuant.holds(continuant.right)
    assert continuant.is_refuted
    assert not continuant.holds(read(garbled_text, ["chi"]))
    assert rim.holds(rim.printed)
    assert not rim.holds(read(rim.printed.latex.replace("=-", "=")))


def test_formulas_are_read_as_they_are_written() -> None:
    for name in ("vertex_forms", "kapovich_millson", "counting"):
        for claim in load(name).claims:
            again = read(claim.right.latex, ["chi"], claim.right.mentions)
            assert again.formulas == claim.right.formulas


def test_shows_the_steps_of_a_statement(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["C.7"]) == 0
    text = capsys.readouterr().out
    assert "rests on:  proved for all" in text
    assert "[ok] counterexample: C.7 as printed does not hold  [against C.7]" in text


def test_statement_error() -> None:
    with pytest.raises(SystemExit):
        main(["--list", "no_script"])
