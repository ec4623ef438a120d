"""Several files checked at once by the package: in threads, through pipes, on processes."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from itertools import product
from pathlib import Path
from threading import Event

import pytest
from compact_files import Lines, bodies, chained

from exactfold import random_square
from exactfold._support.processes import worker_environment
from exactfold.branches.certificates import check
from exactfold.branches.certificates.check import check_compact
from exactfold.branches.counting import branch_blocks
from exactfold.branches.counting.stream import stream_branches
from exactfold.checker import CertificateError
from exactfold.checker.branches import compact
from exactfold.checker.core.parts import Verifier

REFUSED = "Krawczyk's test fails for the box about "


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Two compact certificates, and one with the header and the claims of another sheet."""
    folder = tmp_path_factory.mktemp("at once")
    paths = {name: folder / name for name in ("one", "forged", "other")}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(branch_blocks, "BLOCK", 8)
        for seed, name in enumerate(("one", "other")):
            stream_branches(random_square(5, seed=seed), paths[name])
    one, other = (bodies(paths[name].read_bytes()) for name in ("one", "other"))
    forged: Lines = [one[0], *other[1:-1], one[-1]]
    paths["forged"].write_bytes(chained(forged))
    return paths


def answer(path: Path, *, fast: bool, workers: int = 1) -> object:
    """The claims; of a file that is refused the beginning of the reason."""
    try:
        return check_compact(path, workers=workers, fast=fast)
    except CertificateError as error:
        return str(error)[: len(REFUSED)]


def expected(path: Path) -> object:
    return REFUSED if path.name == "forged" else bodies(path.read_bytes())[-1]["claims"]


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes here")
@pytest.mark.parametrize("fast", [True, False])
def test_a_file_through_a_pipe_while_others_are_checked(
    files: dict[str, Path], fast: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After its first line, others are checked from their beginnings to their ends."""
    pipe, begun = tmp_path / "pipe", Event()
    os.mkfifo(pipe)

    def told(make: Callable[[str], Verifier]) -> Callable[[str], Verifier]:
        def verifier(header: str) -> Verifier:
            made = make(header)
            begun.set()
            return made

        return verifier

    for module, name in ((check, "FLOATS"), (compact, "INTEGERS")):
        engine = getattr(module, name)
        monkeypatch.setattr(module, name, engine._replace(verifier=told(engine.verifier)))
    with ThreadPoolExecutor(1) as threads:
        for path in files.values():
            begun.clear()
            first, rest = path.read_bytes().split(b"\n", 1)
            checked = threads.submit(answer, pipe, fast=fast)
            # A file that is refused is not read to its end.
            with suppress(BrokenPipeError), pipe.open("wb") as stream:
                stream.write(first + b"\n")
                stream.flush()
                assert begun.wait(60)
                for other in files.values():
                    for way in (True, False):
                        assert answer(other, fast=way) == expected(other)
                stream.write(rest)
            assert checked.result() == expected(path)


@pytest.mark.slow
def test_files_on_processes_of_their_own_in_threads(
    files: dict[str, Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(check, "FLOATS", check.FLOATS._replace(least=1))
    jobs = list(product(files.values(), (True, False), (1, 2)))

    def answered(path: Path, fast: bool, workers: int) -> object:
        return answer(path, fast=fast, workers=workers)

    # The variables of the environment that workers get are set once for all threads.
    with worker_environment(), ThreadPoolExecutor(3) as threads:
        said = list(threads.map(answered, *zip(*jobs, strict=True)))
    assert said == [expected(path) for path, *_ in jobs]
