"""Ask of every crease pattern below a folder whether it starts to fold with its own letters.

python tests/benchmarks/real_letters.py FOLDER [--only TEXT]

Each file has 60 seconds of processor time. The certificates of answers are written and verified by
the stand-alone checker, in time of their own. The last tables are those of docs/assignment.md.
"""

from __future__ import annotations

import argparse
import json
import signal
import time
from collections import Counter
from pathlib import Path

from exactfold import checker
from exactfold._support.verdict import PROVED, REFUTED
from exactfold.design import PanelMatch, match_certificate, match_panels
from exactfold.errors import ExactfoldError, NotApplicableError
from exactfold.pattern.drawing.formats.read import READERS
from exactfold.pattern.opening import open_pattern

LIMIT = 60
KINDS = (
    "starts to fold, true motions proved",
    "starts to fold to second order, proved",
    "does not start to fold, proved",
    "undecided",
    f"not ended in {LIMIT} s",
)


class TimeUpError(Exception):
    """A file has taken all its time."""


def kind_of(found: PanelMatch) -> str:
    """The kind of an answer."""
    if found.starts is PROVED:
        return KINDS[0] if found.truly is PROVED else KINDS[1]
    return KINDS[2] if found.starts is REFUTED else KINDS[3]


def why(found: PanelMatch) -> str:
    """By what a sheet was refuted."""
    if found.starts is not REFUTED:
        return ""
    part = next((p for p in found.parts if p.starts is REFUTED), None)
    if part is None:
        return "a fold with a letter that stays flat"
    if part.reason.startswith("round the loop"):
        return "a loop that does not close" + (", nearly" if "rounded" in part.reason else "")
    if part.reason.startswith("the vertices"):
        return "vectors at several vertices"
    return "a single vertex"


def answered(path: Path) -> tuple[str, PanelMatch | None]:
    """The kind of answer; empty for a file that is refused or has no letters."""
    signal.setitimer(signal.ITIMER_PROF, LIMIT)
    try:
        opened = open_pattern(path)
        if not opened.letters:
            return "", None
        found = match_panels(opened)
        return kind_of(found), found
    except TimeUpError:
        return KINDS[4], None
    except ExactfoldError:
        return "", None
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)


def certified(found: PanelMatch) -> str:
    """Whether the certificate of an answer is verified, with all that was found."""
    try:
        claims = checker.check(checker.load(json.dumps(match_certificate(found))))
    except NotApplicableError:
        return "none"
    except checker.CertificateError as error:
        return f"refused: {error}"
    said = (claims["starts"], claims["truly"])
    return "verified" if said == (str(found.starts), str(found.truly)) else "verified in part"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--only", default="", help="only paths with this text")
    arguments = parser.parse_args()

    def stop(*_: object) -> None:
        raise TimeUpError

    signal.signal(signal.SIGPROF, stop)
    kinds: Counter[str] = Counter()
    causes: Counter[str] = Counter()
    proofs: Counter[str] = Counter()
    split: Counter[str] = Counter()
    for path in sorted(arguments.folder.rglob("*")):
        ending = path.suffix.lower().removeprefix(".")
        if ending not in READERS or not path.is_file() or arguments.only not in str(path):
            continue
        began = time.process_time()
        kind, found = answered(path)
        if not kind:
            continue
        kinds[kind] += 1
        said = ""
        if found is not None:
            causes.update(filter(None, [why(found)]))
            proofs[certified(found)] += 1
            first = found.first_order
            if first is not None and first.undecided:
                split["undecided in part"] += 1
            elif first is not None:
                split["all"] += not first.never
                split["some"] += bool(first.never and first.together)
                split["none"] += not first.together
            said = found.reasons[0] if found.reasons else ""
        print(f"{time.process_time() - began:5.1f} s  {kind}  {path.name}: {said}", flush=True)
    print(f"\n| answer | files ({sum(kinds.values())}) |\n|---|---:|")
    for kind in KINDS:
        print(f"| {kind} | {kinds[kind]} |")
    print("\n| refuted by | files |\n|---|---:|")
    for cause, number in causes.most_common():
        print(f"| {cause} | {number} |")
    for title, table in (("certificate", proofs), ("together to first order", split)):
        print(f"\n| {title} | files |\n|---|---:|")
        for name, number in table.most_common():
            print(f"| {name} | {number} |")


if __name__ == "__main__":
    main()
