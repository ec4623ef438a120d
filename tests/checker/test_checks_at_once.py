"""Several checks at once in one process: none hears what the file of another said."""

from __future__ import annotations

import ast
import importlib
import io
import json
import os
import pkgutil
import random
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing, suppress
from pathlib import Path
from threading import Event, Semaphore
from typing import Any

import pytest
from compact_files import Lines, bodies, chained
from forge import FIXTURES, given_lines

import exactfold
from exactfold import checker, random_square
from exactfold.branches.certificates.check import FLOATS
from exactfold.branches.counting import branch_blocks
from exactfold.branches.counting.stream import stream_branches
from exactfold.checker import CertificateError
from exactfold.checker.branches import compact
from exactfold.checker.core import parts
from exactfold.checker.core.lines import lines
from exactfold.checker.core.parts import Engine
from exactfold.checker.motion import loops as motion_loops
from exactfold.checker.sheets.sheet import read_sheet

Check = Callable[[Iterator[str]], Any]
ENGINES = {"integers": compact.INTEGERS, "floats": FLOATS}


def of_blocks(folder: Path, seed: int) -> Lines:
    """A compact certificate of 16 branches in four blocks."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(branch_blocks, "BLOCK", 4)
        stream_branches(random_square(4, seed=seed), folder / f"{seed}.txt")
    return bodies((folder / f"{seed}.txt").read_bytes())


@pytest.fixture(scope="module")
def blocks(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """Two compact certificates, and one with the header and the claims of another sheet."""
    folder = tmp_path_factory.mktemp("blocks")
    one, other = of_blocks(folder, 1), of_blocks(folder, 2)
    forged = [one[0], *other[1:-1], one[-1]]
    return {"one": chained(one), "forged": chained(forged), "other": chained(other)}


@pytest.fixture(scope="module")
def loops() -> dict[str, bytes]:
    """A certificate of loops, and one with the header and the claims of another sheet."""
    other = given_lines("loops-one-vertex")
    forged = json.loads(json.dumps(other))
    forged[0]["pattern"]["vertices"][4] = ["1/3", "2/5"]
    forged[-1]["claims"]["sha256"] = read_sheet(forged[0]["pattern"])[1]
    node = given_lines("loops-node")
    return {"forged": chained(forged), "other": chained(other), "one": chained(node)}


def answer(check: Check, found: Iterator[str]) -> Any:
    """The claims, or why they do not hold."""
    try:
        return check(found)
    except CertificateError as error:
        return str(error)


def alone(check: Check, content: bytes) -> Any:
    return answer(check, lines(io.BytesIO(content)))


def interleaved(checks: list[tuple[Check, bytes]], source: random.Random) -> list[Any]:
    """The answers of checks in a thread each; who goes on for one line is drawn every time."""
    turns, waits = [Semaphore(0) for _ in checks], Semaphore(0)

    def in_turn(turn: Semaphore, content: bytes) -> Iterator[str]:
        for text in lines(io.BytesIO(content)):
            waits.release()
            turn.acquire()
            yield text

    def run(k: int) -> Any:
        check, content = checks[k]
        try:
            return answer(check, in_turn(turns[k], content))
        finally:
            left.remove(k)
            waits.release()

    left = list(range(len(checks)))
    with ThreadPoolExecutor(len(checks)) as threads:
        found = [threads.submit(run, k) for k in left]
        for _ in checks:
            waits.acquire()
        while left:
            turns[source.choice(left)].release()
            waits.acquire()
    return [future.result() for future in found]


def of_compact(engine: Engine) -> Check:
    return lambda found: compact.check_lines(found, 1, engine)


def test_the_forged_files_are_refused_and_the_others_hold(
    blocks: dict[str, bytes], loops: dict[str, bytes]
) -> None:
    for engine in ENGINES.values():
        said = {name: alone(of_compact(engine), content) for name, content in blocks.items()}
        for name in ("one", "other"):
            assert said[name] == bodies(blocks[name])[-1]["claims"]
        assert said["one"]["sha256"] != said["other"]["sha256"]
        assert said["forged"].startswith("Krawczyk's test fails for the box about ")
    said = {name: alone(motion_loops.check_lines, content) for name, content in loops.items()}
    for name in ("one", "other"):
        assert said[name] == bodies(loops[name])[-1]["claims"]
    assert said["forged"].startswith("loop 0: ")


@pytest.mark.parametrize("seed", range(6))
def test_compact_certificates_in_interleaved_threads(blocks: dict[str, bytes], seed: int) -> None:
    checks = [
        (of_compact(engine), content) for engine in ENGINES.values() for content in blocks.values()
    ]
    expected = [alone(*check) for check in checks]
    assert interleaved(checks, random.Random(seed)) == expected


@pytest.mark.parametrize("seed", range(3))
def test_loops_in_interleaved_threads(
    loops: dict[str, bytes], blocks: dict[str, bytes], seed: int
) -> None:
    checks: list[tuple[Check, bytes]] = [
        (motion_loops.check_lines, content) for content in loops.values()
    ]
    checks += [(of_compact(compact.INTEGERS), blocks[name]) for name in ("forged", "other")]
    expected = [alone(*check) for check in checks]
    assert interleaved(checks, random.Random(seed)) == expected


@pytest.mark.parametrize("kind", [*ENGINES, "loops"])
def test_a_file_through_a_pipe_while_another_is_checked(
    kind: str,
    blocks: dict[str, bytes],
    loops: dict[str, bytes],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Another file is checked from its beginning to its end after the first line of the pipe."""
    if not hasattr(os, "mkfifo"):
        pytest.skip("no named pipes here")
    files = loops if kind == "loops" else blocks
    pipe, other = tmp_path / "pipe", tmp_path / "other"
    os.mkfifo(pipe)
    other.write_bytes(files["other"])
    engine, begun = {**ENGINES, "loops": motion_loops.BY_TUBES}[kind], Event()
    check = motion_loops.check_lines if kind == "loops" else of_compact(engine)
    expected = {name: alone(check, content) for name, content in files.items()}
    make = engine.verifier

    def verifier(header: str) -> parts.Verifier:
        made = make(header)
        begun.set()
        return made

    engine = engine._replace(verifier=verifier)

    def verified(path: Path) -> Any:
        return answer(lambda _: checker.verify(path, 1, lambda _: engine), iter(()))

    with ThreadPoolExecutor(1) as threads:
        for name in ("forged", "one"):
            first, rest = files[name].split(b"\n", 1)
            begun.clear()
            checked = threads.submit(verified, pipe)
            # A file that is refused is not read to its end.
            with suppress(BrokenPipeError), pipe.open("wb") as stream:
                stream.write(first + b"\n")
                stream.flush()
                assert begun.wait(60)
                assert verified(other) == expected["other"]
                stream.write(rest)
            assert checked.result() == expected[name]


def test_two_checks_may_take_turns_in_one_thread(blocks: dict[str, bytes]) -> None:
    """What an engine says of a file does not depend on when it is asked."""
    for engine in ENGINES.values():
        headers, texts = {}, {}
        for name in ("one", "other"):
            headers[name], *texts[name], _ = lines(io.BytesIO(blocks[name]))
        said = {
            name: parts.here(engine, headers[name], zip(texts[name], range(4), strict=True))
            for name in texts
        }
        with closing(said["one"]), closing(said["other"]):
            assert list(zip(*said.values(), strict=True)) == [(None, None)] * 4


# --- what is kept --------------------------------------------------------------------------------


def kept() -> dict[str, str]:
    """All values of the modules of the checker and of its classes, as text."""
    found = {}
    for info in pkgutil.walk_packages(checker.__path__, "exactfold.checker."):
        if info.name.endswith(("__main__", "exactfold_checker")):
            continue
        module = importlib.import_module(info.name)
        for name, value in vars(module).items():
            if name.startswith("__"):
                continue
            assert not hasattr(value, "cache_info"), f"{info.name}.{name} remembers"
            inside = dict(vars(value)) if isinstance(value, type) else value
            found[f"{info.name}.{name}"] = repr(inside)
    return found


def test_modules_of_the_checker_keep_nothing_of_a_file(blocks: dict[str, bytes]) -> None:
    before = kept()
    assert len(before) > 500
    for name in ("compact-exact", "loops-one-vertex"):
        checker.verify(FIXTURES / f"{name}.txt")
    for name in ("listing-cross", "branch-flat-fold", "letters-pentagon", "panels-bent"):
        checker.verify(FIXTURES / f"{name}.json")
    assert kept() == before


@pytest.mark.slow
def test_what_is_assigned_in_modules_at_run_time() -> None:
    """Beside workers, which check one file, the file descriptor to which errors are written."""
    root, found = Path(exactfold.__file__).parent, set()
    for path in root.rglob("*.py"):
        text = path.read_text(encoding="utf-8")
        for node in ast.walk(ast.parse(text)) if "global" in text else ():
            if isinstance(node, ast.Global):
                found |= {(path.relative_to(root).as_posix(), name) for name in node.names}
    assert found == {
        ("checker/core/parts.py", "_of_this_worker"),
        ("app/shell/guard.py", "_errors"),
    }
