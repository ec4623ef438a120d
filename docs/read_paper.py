"""Compare the statements with the LaTeX source of the paper, which is no part of this project.

    python docs/read_paper.py PAPER.tex [CORRECTED.tex]

What a statement quotes has to stand in the source word by word and formula by formula
(`proofs/quotations.py`); every passage that `proofs/replacements.py` replaces has to stand there
once. Then the digests with which the tests compare are written to `tests/proofs/quotations.json`,
and the source with all replacements to a second file, if one is named.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from proofs import MODULES
from proofs.__main__ import load
from proofs.quotations import UNPRINTED, digest, missing
from proofs.replacements import REPLACEMENTS


def main(arguments: list[str]) -> int:
    """The exit code is 0 if everything stands in the paper."""
    paper = Path(arguments[0]).read_text(encoding="utf-8")
    statements = [s for name in MODULES for s in load(name).statements if not s.is_own]
    wrong = [
        f"{s.key}: {part}"
        for s in statements
        if s.key not in UNPRINTED
        for part in missing(s.source, paper)
    ]
    corrected = paper
    for key, pairs in REPLACEMENTS.items():
        for old, new in pairs:
            if paper.count(old) != 1 or corrected.count(old) != 1:
                wrong.append(f"{key}: {paper.count(old)} times: {old}")
            corrected = corrected.replace(old, new)
    print("\n".join(wrong) or f"{len(statements)} statements and {len(REPLACEMENTS)} replacements")
    if wrong:
        return 1
    digests = {s.key: digest(s.source) for s in statements}
    text = json.dumps(digests, indent=0, sort_keys=True)
    (HERE.parent / "tests" / "proofs" / "quotations.json").write_text(text + "\n", encoding="utf-8")
    if len(arguments) > 1:
        Path(arguments[1]).write_text(corrected, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
