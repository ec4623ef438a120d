"""All branches streamed to a compact certificate: right, resumable, and never lost silently."""

import json
import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from compact_files import bodies, chained, refused
from sheets import SQUARE, dart, nested_triangles, reflex_corners, scrambled

from exactfold import Branch, random_square
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches import count_branches
from exactfold.branches.certificates.check import CertificateError, check_compact
from exactfold.branches.certificates.read import read_branches
from exactfold.branches.counting import branch_blocks
from exactfold.branches.counting.branch_blocks import BranchBlocks
from exactfold.branches.counting.stream import stream_branches
from exactfold.branches.values import classify
from exactfold.checker.branches import compact_blocks
from exactfold.errors import ForeignJournalError, NotApplicableError, UnwritableFileError
from exactfold.pattern import families, read_fold
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.data import example_path
from exactfold.pattern.degenerate import straight_path
from exactfold.pattern.triangulating.random_squares import sample_random_square


def gap(tiny: Fraction) -> CreasePattern:
    """Vertex 5 is flat on two branches that coincide at tiny = 0."""
    points = [(0, 0), (1, 0), (1, 1), (0, 1), ("1/2", Fraction(1, 2) + tiny), ("7/10", "1/5")]
    faces = [(0, 1, 5), (1, 2, 5), (2, 4, 5), (4, 0, 5), (2, 3, 4), (3, 0, 4)]
    return CreasePattern(points, faces)


PATTERNS = {
    "random square": random_square(5, seed=3),
    "thin triangles": scrambled(1, SQUARE, 6),
    "reflex corner": scrambled(0, reflex_corners(0), 5),
    "reflex, triangulated triangle": scrambled(2, reflex_corners(2), 6),
    "dart": dart(),
    "nested triangles": nested_triangles(),
    "hypar": families.hypar(1),
    "gap 1e-6": gap(Fraction(1, 10**6)),
    "gap 1e-30": gap(Fraction(1, 10**30)),
}


@pytest.fixture(autouse=True)
def _small_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(branch_blocks, "BLOCK", 8)


def described(branch: Branch) -> tuple[str, str, int, str]:
    return branch.sign_text, branch.assignment_text, branch.multiplicity, branch.representative


@pytest.mark.parametrize("name", PATTERNS)
def test_branches_agree_with_the_other_pipeline(name: str, tmp_path: Path) -> None:
    """Popping paths, exact Krawczyk and sorting by boxes find the same branches."""
    pattern = PATTERNS[name]
    result = stream_branches(pattern, tmp_path / "c.txt")
    # Popping paths stall where two ends are 1e-30 apart.
    other = count_branches(pattern, method="groebner" if name == "gap 1e-30" else "popping")
    assert result.status is other.status is PROVED
    assert (result.distinct, result.with_multiplicity) == (other.distinct, other.with_multiplicity)
    assert result.unproved == 0

    found = list(read_branches(tmp_path / "c.txt"))
    if any(b.representative == "either" for b in other.branches):
        assert len(found) == len(other.branches)
    else:
        assert sorted(map(described, found)) == sorted(map(described, other.branches))
    for fast in (True, False):
        claims = check_compact(tmp_path / "c.txt", fast=fast)
        assert claims["distinct"] == other.distinct
        assert claims["with_multiplicity"] == other.with_multiplicity
        assert claims["sha256"] == pattern.sha256


def test_heights_agree_with_the_other_pipeline(tmp_path: Path) -> None:
    pattern = random_square(4, seed=9)
    stream_branches(pattern, tmp_path / "c.txt")
    for mine, other in zip(
        sorted(read_branches(tmp_path / "c.txt"), key=lambda b: b.sort_key()),
        count_branches(pattern).branches,
        strict=True,
    ):
        for v, (low, high) in mine.heights.items():
            a, b = other.heights[v]
            assert low <= b
            assert a <= high
            assert high - low < Fraction(1, 10**6)


def test_multiple_roots_are_handed_on_by_name(tmp_path: Path) -> None:
    counted = stream_branches(gap(Fraction(0)), tmp_path / "c.txt")
    assert (counted.status, counted.distinct, counted.complete) == (PROVED, 3, False)
    assert counted.proof is not None
    result = stream_branches(gap(Fraction(0)), tmp_path / "c.txt", fallback=False)
    assert result.status is UNDECIDED
    assert result.distinct is None
    assert [root.signs for root in result.open_roots] == ["++", "+-"]
    assert all("vertex 5 flat" in root.reason for root in result.open_roots)
    assert [root.limit for root in result.open_roots] == ["+0", "+0"]
    assert "in double precision" in result.open_roots[1].reason
    assert result.unproved == 2
    for fast in (True, False):
        with pytest.raises(CertificateError, match="root 0 is open"):
            check_compact(tmp_path / "c.txt", fast=fast)


def test_paths_that_the_solver_loses_are_proved_exactly() -> None:
    """A solver that returns nonsense costs time, never a branch."""
    branch_blocks = BranchBlocks.of(random_square(3, seed=1))
    points = branch_blocks.ends(0).points
    points[0] = np.nan
    points[1] = points[2]  # the branch of another sign vector
    points[3] += 0.4
    block = branch_blocks.prove(0)
    assert sorted(block.exact) == [0, 1, 3]
    assert not block.open
    assert block.boxes.proved.sum() == 5


def test_interrupted_runs_continue_to_the_same_file(tmp_path: Path) -> None:
    pattern, whole, path = random_square(5, seed=1), tmp_path / "whole.txt", tmp_path / "c.txt"
    stream_branches(pattern, whole)

    def stop(stage: str, done: int, total: int) -> None:
        if done == 16:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        stream_branches(pattern, path, progress=stop)
    result = stream_branches(pattern, path, resume=True)
    assert (result.status, result.resumed, result.blocks) == (PROVED, 2, 4)
    assert path.read_bytes() == whole.read_bytes()
    again = stream_branches(pattern, path, resume=True)
    assert (again.status, again.resumed) == (PROVED, 4)
    assert path.read_bytes() == whole.read_bytes()


def test_a_file_of_an_earlier_version_is_continued(tmp_path: Path) -> None:
    """Its header calls the method by its earlier name; new files do not."""
    folder, path = Path(__file__).parents[2] / "fixtures" / "certificates", tmp_path / "c.txt"
    old = folder / "compact-reflex.txt"
    data = old.read_bytes()
    header = json.loads(data.split(b"\t")[0])
    assert header["provenance"]["method"] == "nappes"
    sheet = header["pattern"]
    pattern = CreasePattern(sheet["vertices"], sheet["triangles"])
    path.write_bytes(data[: data.rindex(b"\n", 0, -1) + 1])  # without the claims
    result = stream_branches(pattern, path, resume=True)
    assert (result.status, result.resumed, result.blocks) == (PROVED, 1, 1)
    assert check_compact(path) == check_compact(old)
    stream_branches(pattern, path)
    new = json.loads(path.read_bytes().split(b"\t")[0])
    assert new["provenance"]["method"] == "newton"
    assert {**new, "provenance": 0} == {**header, "provenance": 0}


def test_a_file_cut_anywhere_is_continued_to_the_same_file(tmp_path: Path) -> None:
    pattern, whole, path = random_square(4, seed=1), tmp_path / "whole.txt", tmp_path / "c.txt"
    stream_branches(pattern, whole)
    data = whole.read_bytes()
    for cut in [0, 1, 40, *range(100, len(data), 97), len(data) - 1]:
        path.write_bytes(data[:cut])
        assert stream_branches(pattern, path, resume=True).status is PROVED
        assert path.read_bytes() == data
    path.unlink()
    assert stream_branches(pattern, path, resume=True).resumed == 0
    assert path.read_bytes() == data


def test_only_files_of_the_same_pattern_are_continued(tmp_path: Path) -> None:
    path = tmp_path / "c.txt"
    stream_branches(random_square(3, seed=1), path)
    before = path.read_bytes()
    with pytest.raises(ForeignJournalError, match="another pattern"):
        stream_branches(random_square(3, seed=2), path, resume=True)
    assert path.read_bytes() == before
    path.write_text("my notes\n")
    with pytest.raises(ForeignJournalError, match="not a compact certificate"):
        stream_branches(random_square(3, seed=2), path, resume=True)
    assert path.read_text() == "my notes\n"


def test_unwritable_files_and_other_patterns_are_refused(tmp_path: Path) -> None:
    with pytest.raises(UnwritableFileError):
        stream_branches(random_square(3, seed=1), tmp_path / "none" / "c.txt")
    with pytest.raises(UnwritableFileError):
        stream_branches(random_square(3, seed=1), tmp_path, resume=True)
    large = sample_random_square(41, 1, 1 << 20, redraw=True).pattern
    for sheet in (families.single_vertex(5), families.single_vertex(3), large):
        with pytest.raises(NotApplicableError):
            BranchBlocks.of(sheet)


WORKERS = """
import multiprocessing, sys
from exactfold import random_square
from exactfold.errors import WorkerDiedError
from exactfold.branches.certificates import check
from exactfold.branches.counting import branch_blocks, engines, stream

def seen(stage, done, total):
    dones.append(done)

def kill(stage, done, total):
    for process in multiprocessing.active_children():
        process.kill()

if __name__ == "__main__":
    check.LEAST, engines.LEAST, branch_blocks.BLOCK = 1, 1, 16
    pattern, dones = random_square(8, seed=1), []
    one, two, three = sys.argv[1:]
    stream.stream_branches(pattern, one)
    stream.stream_branches(pattern, two, workers=2, progress=seen)
    try:
        stream.stream_branches(pattern, three, workers=2, progress=kill)
    except WorkerDiedError:
        print("died")
    result = stream.stream_branches(pattern, three, resume=True)
    print(result.resumed < 16, dones == list(range(16, 257, 16)))
    print(check.check_compact(two, workers=2)["distinct"])
"""


@pytest.mark.slow
def test_workers_write_the_same_file_and_may_be_killed(tmp_path: Path) -> None:
    """In a process of its own, as workers are started anew."""
    script = tmp_path / "run.py"
    script.write_text(WORKERS)
    files = [tmp_path / name for name in ("one.txt", "two.txt", "three.txt")]
    command = [sys.executable, str(script), *map(str, files)]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    assert run.stdout.split() == ["died", "True", "True", "256"], run.stderr
    assert len({file.read_bytes() for file in files}) == 1


def test_a_flat_fold_and_a_wide_block_are_written(tmp_path: Path) -> None:
    """A fold that is proved flat (a cross) has no bit: such roots are listed exactly."""
    result = stream_branches(read_fold(example_path("flat-octahedron")), tmp_path / "c.txt")
    assert result.status is PROVED
    cross = CreasePattern(
        [(2, 0), (0, 3), (-2, 0), (0, -1), (0, 0)],
        [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)],
    )
    crossed = stream_branches(cross, tmp_path / "cross.txt")
    assert (crossed.status, crossed.exact) == (PROVED, 2)
    assert all("F" in b.assignment_text for b in read_branches(tmp_path / "cross.txt"))
    assert check_compact(tmp_path / "cross.txt")["distinct"] == 2


@pytest.mark.parametrize("fast", [True, False])
def test_a_fold_that_stays_open_costs_its_letter_only(
    fast: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As for a flat fold that nothing proves to be flat."""
    monkeypatch.setattr(classify, "flat_folds", lambda pattern, signs: frozenset())
    path = tmp_path / "c.txt"
    result = stream_branches(straight_path(2), path)
    assert (result.status, result.distinct, result.unproved) == (PROVED, 4, 0)
    letters = [branch.assignment_text for branch in read_branches(path)]
    assert any("U" in text for text in letters)
    assert check_compact(path, fast=fast)["distinct"] == 4
    monkeypatch.setattr(compact_blocks, "close_flat", lambda sheet, signs: None)
    assert check_compact(path, fast=fast)["distinct"] == 4
    lines = bodies(path.read_bytes())
    entry = next(e for e in lines[1]["exact"] if "U" in e["assignment"])
    for letter in "MVF?":
        text = entry["assignment"]
        entry["assignment"] = text.replace("U", letter, 1)
        refused(chained(lines), path, "folds are")
        entry["assignment"] = text
    entry["assignment"] = text.replace("U", "?")
    path.write_bytes(chained(lines))
    with pytest.raises(CertificateError, match="no letters"):
        list(read_branches(path))
