"""`python -m proofs`: run every script, or show the steps of scripts and statements by name."""

from __future__ import annotations

import argparse
import importlib
import importlib.util
import json
import sys
import time
from functools import cache
from pathlib import Path

from proofs import MODULES
from proofs.framework import Proof, report, report_statement
from proofs.statements import Ruling

LEGEND = """
verdict    proved: every step holds, and most of them prove; tested: every step holds, and at
           least half of them test exact cases; refuted: a step fails
tested     steps that test a stated number of cases and do not prove in general
stated     statements that the script rules on
corrected  those that do not hold as printed in the paper, with the correction and a refutation
python -m proofs NAME shows the steps of a script (kapovich_millson) or of a statement (C.7)."""


@cache
def load(name: str) -> Proof:
    """The proof of one module; it is run once."""
    proof = importlib.import_module(f"proofs.{name}").prove()
    if not isinstance(proof, Proof):
        raise TypeError(f"proofs.{name}.prove() returned no Proof")
    return proof


def main(arguments: list[str] | None = None) -> int:
    """Run proofs; return 0 only if every step of every proof was established."""
    parser = argparse.ArgumentParser(prog="python -m proofs", description=__doc__)
    parser.add_argument(
        "names", nargs="*", metavar="NAME", help="scripts or statements to show (default: a table)"
    )
    parser.add_argument("--list", action="store_true", help="list the scripts and run none")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    options = parser.parse_args(arguments)
    keys = [name for name in options.names if "." in name]
    names = [name for name in options.names if "." not in name]
    unknown = [name for name in names if name not in MODULES]
    if unknown:
        parser.error(f"no proof named {unknown[0]!r}; there are: {', '.join(MODULES)}")
    if options.list:
        for name in names or MODULES:
            print(f"{name:24}{importlib.import_module(f'proofs.{name}').TITLE}")
        return 0
    if options.json:
        proofs = [load(name) for name in names or MODULES]
        failed = sum(not proof.holds for proof in proofs)
        print(json.dumps({"proofs": [proof.to_dict() for proof in proofs], "failed": failed}))
        return 1 if failed else 0
    if not options.names:
        return table()
    missing = [key for key in keys if home(key) is None]
    if missing:
        parser.error(f"no statement {missing[0]!r}; docs/statements.md lists them")
    shown = [load(name) for name in names]
    texts = [report(proof) for proof in shown]
    for key in keys:
        proof = home(key)
        if proof is not None:
            shown.append(proof)
            texts += [report_statement(proof, s) for s in proof.statements if s.key == key]
    print("\n\n".join(texts))
    return 0 if all(proof.holds for proof in shown) else 1


def home(key: str) -> Proof | None:
    """The proof that rules on a statement, or None. Scripts whose text names it are run first."""
    ordered = sorted(MODULES, key=lambda name: f'"{key}"' not in _source(name))
    for name in ordered:
        proof = load(name)
        if any(statement.key == key for statement in proof.statements):
            return proof
    return None


def _source(name: str) -> str:
    specification = importlib.util.find_spec(f"proofs.{name}")
    if specification is None or specification.origin is None:
        return ""
    return Path(specification.origin).read_text(encoding="utf-8")


def table() -> int:
    """Print one line for each script, and the meaning of the columns; return the exit code."""
    print(
        f"{'proof':24}{'verdict':10}{'steps':>6}{'tested':>8}{'stated':>8}{'corrected':>11}  time"
    )
    failed = 0
    for name in MODULES:
        start = time.perf_counter()
        proof = load(name)
        seconds = time.perf_counter() - start
        failed += not proof.holds
        corrected = sum(s.ruling is not Ruling.AS_PRINTED for s in proof.statements)
        print(
            f"{name:24}{proof.verdict:10}{len(proof.steps):6}{proof.tested_only:8}"
            f"{len(proof.statements):8}{corrected:11}  {seconds:.1f} s",
            flush=True,
        )
    print(LEGEND)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
