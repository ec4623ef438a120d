"""Damages files at random: readers and the checker must answer, or refuse by errors of their own.

    python tests/property/fuzz.py --seconds 120 [--workers 2] [--seed N] [--only TEXT] [--atheris]

Small files of every format that exactfold reads, and the stored certificates of every kind, are
changed in bytes, numbers, lines and JSON values; lines with digests are sealed anew. A defect is

  - an error that is no `InputError` of a reader, no `CertificateError` or `FormatError` of the
    checker;
  - more than `SECONDS` of processor time, more than `MEMORY` bytes, or the end of the process;
  - a changed certificate that is VALID and claims something else than the one that was changed,
    beyond what follows from that (`_says_less`), or is judged in two ways by the two checkers.

Each defect is printed, and the input, made small by hypothesis, is written into
`tests/property/found`, where the quick tests (`test_fuzz.py`) read it again for ever. Each run has
another seed, which is printed first; `--seed` repeats a run. With `--atheris`, atheris (to be
installed by hand) chooses the changes by what they reach in the code.
"""

from __future__ import annotations

import argparse
import contextlib
import gc
import json
import multiprocessing
import re
import resource
import secrets
import signal
import sys
import tempfile
import time
import traceback
from collections import Counter
from functools import cache
from pathlib import Path
from types import FunctionType
from typing import Any

from damage import CERTIFICATES, HERE, Choose, Input, changed, files
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import seed as seeded
from hypothesis import strategies as st

from exactfold import checker
from exactfold.app.verbs.checking import quickest
from exactfold.checker.core.reading import parse_rational
from exactfold.errors import InputError, UsageError
from exactfold.pattern.opening import opened
from exactfold.pattern.periodic.cell_files import parse_cell_bytes
from exactfold.pattern.reading import Reading

FOUND = HERE / "found"
SECONDS = 30.0
"""Of processor time, for one file; a reader is told a limit of 2 seconds."""
MEMORY = 4 << 30
STUCK = 240.0  # seconds by the clock
SHRINKING = 30.0  # seconds after the end of a run in which an input may still be made smaller


class TooLongError(BaseException):
    """A file takes too long."""


# --- what is right -------------------------------------------------------------------------------


def defect(given: Input) -> str | None:
    """What is wrong with the answer to a file; None if nothing is."""

    def too_long(*_: object) -> None:
        raise TooLongError

    before = signal.signal(signal.SIGVTALRM, too_long)
    signal.setitimer(signal.ITIMER_VIRTUAL, SECONDS)
    try:
        return _read(given) if given.how == "read" else _checked(given)
    except TooLongError:
        return f"more than {SECONDS:.0f} s"
    except Exception as error:
        last = traceback.extract_tb(error.__traceback__)[-1]
        own = [x for x in traceback.extract_tb(error.__traceback__) if "exactfold/" in x.filename]
        place = (own or [last])[-1]
        where = f"{Path(place.filename).name}, line {place.lineno}"
        return f"{type(error).__name__} in {where}: {str(error)[:200]!a}"
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        signal.signal(signal.SIGVTALRM, before)


def _read(given: Input) -> None:
    """Reads a drawing, a sheet or a cell; one error of the reader's own is in order."""
    readings = [Reading(limit=2.0)]
    if given.origin.endswith((".svg", ".dxf")):
        readings.append(Reading(limit=2.0, chords=2))
    for reading in readings:
        with contextlib.suppress(InputError, *[UsageError] * (reading.chords is not None)):
            opened(given.content, given.origin, reading)
    if given.origin.endswith(".json"):
        with contextlib.suppress(InputError):
            parse_cell_bytes(given.content, given.origin)


def claims_of(content: bytes) -> dict[str, Any] | None:
    """The verified claims of a certificate; None if it is refused.

    Raises `AssertionError` if the checker with floats, which `exactfold check` uses, judges
    otherwise.
    """
    with tempfile.NamedTemporaryFile() as file:
        file.write(content)
        file.flush()
        answers: list[dict[str, Any] | None] = []
        for engines in ({}, {"engine_of": quickest}) if content.rstrip()[-1:] != b"}" else ({},):
            try:
                answers.append(dict(checker.verify(file.name, **engines)))
            except (checker.CertificateError, checker.FormatError):
                answers.append(None)
    assert all(answer == answers[0] for answer in answers), "the two checkers differ"
    return answers[0]


@cache
def _truth(origin: str) -> dict[str, Any]:
    claims = claims_of((CERTIFICATES / origin).read_bytes())
    assert claims is not None, origin
    return claims


def _checked(given: Input) -> str | None:
    claims = claims_of(given.content)
    if claims is None:
        return None
    truth = _truth(given.origin)
    if _asked(claims) != _asked(truth):
        return None
    other = [key for key in truth.keys() | claims.keys() if not _follows(key, claims, truth)]
    said = "; ".join(f"{key!a}: {truth.get(key)!a} -> {claims.get(key)!a}"[:400] for key in other)
    return f"VALID with other claims, {' '.join(sorted(other))}: {said}" if other else None


_QUESTIONS = ("sha256", "letters", "direction", "vertex", "relations", "drivers", "rates")
"""What a proof is about: that of another sheet, say, is another proof, and may be right."""
_AT_LEAST = ("margin", "length", "clear", "radius")
_AT_MOST = ("squared_distance", "within", "bound")
_WITHIN = ("time",)


def _asked(claims: dict[str, Any]) -> list[Any]:
    """The sheet and what was asked about it."""
    return [*map(claims.get, _QUESTIONS), claims.get("stop", {}).get("angles")]


def _follows(key: str, claims: dict[str, Any], truth: dict[str, Any]) -> bool:
    """Whether a claim is one of the true claims, or says less."""
    if key not in claims or key not in truth:
        return False
    claim, true = claims[key], truth[key]
    if key == "branches" and isinstance(claim, list):
        claim, true = (sorted(json.dumps(x, sort_keys=True) for x in y) for y in (claim, true))
    return _says_less(key, claim, true)


def _says_less(key: str, claim: Any, true: Any) -> bool:
    if type(claim) is not type(true):
        return False
    if key in _AT_LEAST + _AT_MOST or isinstance(true, str):
        with contextlib.suppress(checker.CertificateError):  # of numbers; letters follow below
            claim, true = parse_rational(claim), parse_rational(true)
            return claim == true or (
                claim < true if key in _AT_LEAST else key in _AT_MOST and claim > true
            )
    if key in _WITHIN:
        (low, high), (least, most) = (map(parse_rational, pair) for pair in (claim, true))
        return low <= least and most <= high
    if isinstance(true, dict):
        return claim.keys() == true.keys() and all(_says_less(k, claim[k], true[k]) for k in true)
    return json.dumps(claim, sort_keys=True) == json.dumps(true, sort_keys=True)


# --- the search ----------------------------------------------------------------------------------


class DefectError(AssertionError):
    """What hypothesis makes small."""


class OverError(BaseException):
    """The time of the run is over; hypothesis ends."""


class Search:
    """Looks for defects in one process, and keeps what it finds."""

    def __init__(self, folder: Path, chosen: list[Input], current: Path) -> None:
        self.folder, self.current = folder, current
        groups = [[x for x in chosen if x.how == how] for how in ("read", "check")]
        self.groups = [group for group in groups if group]  # as often one as the other
        self.known: set[str] = set()
        self.counts: Counter[str] = Counter()

    def input(self, choose: Choose) -> Input:
        """A changed file."""
        group = self.groups[choose(len(self.groups))]
        return changed(group[choose(len(group))], choose)

    def judge(self, given: Input) -> tuple[str, str] | None:
        """A defect that was not known, without and with its details."""
        self.counts[given.how] += 1
        self.current.write_text(
            json.dumps([given.how, given.origin, given.content.decode("latin1")])
        )
        found = defect(given)
        kind = f"{given.origin.partition('-')[0]} {re.sub(r'[(:].*', '', found)}" if found else ""
        return None if found is None or kind in self.known else (kind, found)

    def keep(self, given: Input, kind: str, found: str) -> None:
        """Stores the input with a defect and tells of it."""
        self.known.add(kind)
        self.counts["defects"] += 1
        path = given.kept(self.folder)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(given.content)
        print(f"DEFECT {path.relative_to(self.folder)}: {found}", flush=True)

    def round(self, seed: int, examples: int, until: float) -> None:
        """One run of hypothesis."""
        last: list[tuple[Input, str, str]] = []

        @seeded(seed)
        @settings(
            max_examples=examples,
            database=None,
            deadline=None,
            phases=(Phase.generate, Phase.shrink),
            suppress_health_check=list(HealthCheck),
            report_multiple_bugs=False,
        )
        @given(st.data())
        def damaged(data: st.DataObject) -> None:
            wrong = self.input(lambda n: data.draw(st.integers(0, n - 1)))
            if time.monotonic() > until + (SHRINKING if last else 0):
                raise OverError
            answer = self.judge(wrong)
            if answer is None:
                return
            if "more than" in answer[1] or "MemoryError" in answer[1]:
                self.keep(wrong, *answer)  # each attempt to make it smaller would take as long
                return
            if not last or last[0][1] == answer[0]:
                last[:] = [(wrong, *answer)]
                raise DefectError(answer[0])

        with contextlib.suppress(DefectError, OverError):
            damaged()
        if last:
            self.keep(*last[0])


def _worker(search: Search, seed: int, until: float, atheris: bool, counts: Any) -> None:
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    if atheris:
        _by_atheris(search, seed, until, counts)
    k = 0
    while time.monotonic() < until:
        search.round(seed + k, 200, until)
        k += 1
        counts.update(search.counts)


def _by_atheris(search: Search, seed: int, until: float, counts: Any) -> None:
    """Ends the process, as atheris does; the functions that the files use are followed."""
    import atheris

    for chosen in (x for group in search.groups for x in group):
        defect(chosen)  # which loads all modules
    for function in [x for x in gc.get_objects() if isinstance(x, FunctionType)]:
        if str(function.__module__).startswith("exactfold."):
            atheris.instrument_func(function)

    def one(data: bytes) -> None:
        source = atheris.FuzzedDataProvider(data)
        wrong = search.input(lambda n: source.ConsumeIntInRange(0, n - 1))
        answer = search.judge(wrong)
        if answer is not None:
            search.keep(wrong, *answer)
        if sum(search.counts.values()) % 50 == 0 or answer is not None:
            counts.update(search.counts)

    left = max(1, int(until - time.monotonic()))
    options = [f"-max_total_time={left}", f"-seed={seed % 2**31}", "-rss_limit_mb=0"]
    atheris.Setup([sys.argv[0], *options, "-verbosity=0", "-len_control=0", "-max_len=96"], one)
    atheris.Fuzz()


def main(arguments: list[str] | None = None) -> int:
    """Runs the search; 1 if it found defects."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--seconds", type=float, default=120, help="by the clock")
    parser.add_argument("--workers", type=int, default=2, help="processes")
    parser.add_argument("--seed", type=int, help="repeats a run; another one each time")
    parser.add_argument("--only", default="", help="only files with this in their name")
    parser.add_argument("--folder", type=Path, default=FOUND, help="where inputs are written")
    parser.add_argument("--atheris", action="store_true", help="let atheris choose the changes")
    options = parser.parse_args(arguments)
    chosen = [x for x in files() if options.only in f"{x.how}/{x.origin}"]
    if not chosen:
        parser.error(f"no file has {options.only!r} in its name")
    seed = secrets.randbelow(10**9) if options.seed is None else options.seed
    print(f"{len(chosen)} files, --seed {seed}", flush=True)
    return _run(options, chosen, seed)


def _run(options: argparse.Namespace, chosen: list[Input], seed: int) -> int:
    until = time.monotonic() + options.seconds
    total: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as place, multiprocessing.Manager() as manager:
        running = []
        for k in range(options.workers):
            search = Search(options.folder, chosen, Path(place) / str(k))
            counts = manager.dict()
            passed = (search, seed + 10**6 * k, until, options.atheris, counts)
            process = multiprocessing.get_context("fork").Process(target=_worker, args=passed)
            process.start()
            running.append((process, search, counts))
        for process, search, counts in running:
            found = _awaited(process, search.current)
            total.update(dict(counts))
            if found and search.current.exists():
                how, origin, content = json.loads(search.current.read_text())
                search.keep(Input(how, origin, content.encode("latin1")), "", found)
                total["defects"] += 1
    print(f"{total['read']} read, {total['check']} checked, {total['defects']} defects")
    return 1 if total["defects"] else 0


def _awaited(process: Any, current: Path) -> str:
    """How a process ended; empty if by itself."""
    while process.is_alive():
        process.join(1)
        with contextlib.suppress(FileNotFoundError):
            if time.time() - current.stat().st_mtime > STUCK:
                process.kill()
                process.join()
                return f"no answer for {STUCK:.0f} s"
    return f"the process ended with {process.exitcode}" if process.exitcode else ""


if __name__ == "__main__":
    sys.exit(main())
