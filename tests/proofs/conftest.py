"""The formal proof is built once, whatever the number of workers."""

import fcntl
import shutil
import subprocess
from pathlib import Path

import pytest

FORMAL = Path(__file__).parent.parent.parent / "proofs" / "formal"


def made(place: Path, *goals: str) -> str:
    """What `make` prints; a failure shows the end of what it complained of."""
    done = subprocess.run(
        ["make", "-C", str(place), *goals], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr[-2000:]
    return done.stdout


@pytest.fixture(scope="session")
def formal(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the compiled proof and `make.log`; skips where Coq is not installed."""
    if shutil.which("coqc") is None or shutil.which("make") is None:
        pytest.skip("not built here: coqc and make are not installed")
    base = tmp_path_factory.getbasetemp()
    shared = base.parent if base.name.startswith("popen-") else base
    place, log = shared / "formal", shared / "formal" / "make.log"
    with (shared / "formal.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not log.exists():
            sources = [*FORMAL.glob("*.v"), FORMAL / "_CoqProject", FORMAL / "Makefile"]
            sources += [*FORMAL.glob("verify/*.ml"), FORMAL / "verify" / "Extract.v"]
            (place / "verify").mkdir(parents=True, exist_ok=True)
            for source in sources:
                if source.name not in ("verified.ml", "verified.mli"):
                    shutil.copy(source, place / source.relative_to(FORMAL))
            log.write_text(made(place), encoding="utf-8")
    return place


@pytest.fixture(scope="session")
def verifier(formal: Path) -> Path:
    """The program exactfold-verify; skips where OCaml or Zarith is not installed."""
    found = shutil.which("ocamlfind") and subprocess.run(
        ["ocamlfind", "query", "zarith"], capture_output=True, check=False
    )
    if not found or found.returncode:
        pytest.skip("not built here: ocamlfind and zarith are not installed")
    program = formal / "verify" / "exactfold-verify"
    with (formal.parent / "formal.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not program.exists():
            made(formal, "verify")
    return program
