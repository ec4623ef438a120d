"""`python -m proofs`: run every proof, or those named, and print one line each."""

from __future__ import annotations

import argparse
import importlib
import json
import sys
import time
from functools import cache

from proofs import MODULES
from proofs.framework import Proof, Ruling


@cache
def load(name: str) -> Proof:
    """The proof of one module, run once."""
    proof = importlib.import_module(f"proofs.{name}").prove()
    if not isinstance(proof, Proof):
        raise TypeError(f"proofs.{name}.prove() returned no Proof")
    return proof


def main(arguments: list[str] | None = None) -> int:
    """Run proofs; the exit code is 0 only if every step of every proof was established."""
    parser = argparse.ArgumentParser(prog="python -m proofs", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help="proofs to run (default: all)")
    parser.add_argument("--list", action="store_true", help="list the proofs and run none")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    options = parser.parse_args(arguments)
    unknown = [name for name in options.names if name not in MODULES]
    if unknown:
        parser.error(f"no proof named {unknown[0]!r}; there are: {', '.join(MODULES)}")
    names = options.names or list(MODULES)
    if options.list:
        for name in names:
            print(f"{name:24}{importlib.import_module(f'proofs.{name}').TITLE}")
        return 0
    proofs, failed = [], 0
    if not options.json:
        print(f"{'proof':24}{'verdict':10}{'steps':>6}{'tested':>8}{'stated':>8}{'wrong':>7}  time")
    for name in names:
        start = time.perf_counter()
        proof = load(name)
        seconds = time.perf_counter() - start
        proofs.append(proof)
        failed += any(not step.holds for step in proof.steps) or not proof.steps
        wrong = sum(s.ruling is not Ruling.AS_PRINTED for s in proof.statements)
        if not options.json:
            print(
                f"{name:24}{proof.verdict!s:10}{len(proof.steps):6}{proof.tested_only:8}"
                f"{len(proof.statements):8}{wrong:7}  {seconds:.1f} s",
                flush=True,
            )
    if options.json:
        print(json.dumps({"proofs": [proof.to_dict() for proof in proofs], "failed": failed}))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
