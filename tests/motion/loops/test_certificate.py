"""Certificates of loops: what is written verifies, and an interrupted run is continued."""

import json
import os
import shlex
import subprocess
import sys
from fractions import Fraction

import pytest
from sheets import flipped, nested_triangles, reflex_corners, star_in, with_point
from typer.testing import CliRunner

from exactfold import checker, random_square
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.app.cli import app
from exactfold.branches import find_branch
from exactfold.certificates.journal import Journal
from exactfold.errors import ForeignJournalError, NotCountedError, UsageError
from exactfold.motion import find_loops
from exactfold.motion.loops.file import LoopFile
from exactfold.motion.loops.loops import LoopFinder
from exactfold.motion.loops.rays import Ray
from exactfold.pattern import load, write_fold
from exactfold.pattern.data import example_path
from exactfold.rigidity.equations.problem import Problem

INTERRUPTED = 130
FOLDS_FLAT = load(example_path("single-vertex-4"))
TWO = example_path("two-vertex")
NODE_SHEET, NODE_SIGNS = random_square(8, seed=1), "------++"


def reflex():
    """A sheet with a reflex corner and two foldable vertices, all of whose branches are simple."""
    sheet = flipped(with_point(star_in(reflex_corners(0)), 1, (3, 4, 5)), (2, 4))
    assert len(sheet.foldable_vertices) == 2
    return sheet


def loops_in(path):
    """The lines of the loops in a file."""
    bodies = [line.partition("\t")[0] for line in path.read_text().splitlines()]
    return [json.loads(body) for body in bodies if body.startswith('{"from"')]


def ray(entry, pattern):
    signs = dict(zip(pattern.interior, entry["vertex_signs"], strict=True))
    assert all((signs[v] == 0) == (v in pattern.rigid_vertices) for v in pattern.interior)
    return Ray(tuple(signs[v] for v in pattern.foldable_vertices), entry["side"])


@pytest.mark.parametrize(
    "pattern",
    [
        random_square(1, seed=0),
        pytest.param(random_square(2, seed=3), marks=pytest.mark.slow),
        pytest.param(random_square(3, seed=2), marks=pytest.mark.slow),
        pytest.param(nested_triangles(), marks=pytest.mark.survey),
    ],
    ids=["one", "two", "three", "triangles"],
)
def test_what_is_written_verifies(pattern, tmp_path):
    file = tmp_path / "loops.txt"
    found = find_loops(pattern, certificate=file)
    assert found.status is PROVED
    n = len(pattern.foldable_vertices)
    assert checker.verify(file) == {
        "sha256": pattern.sha256,
        "loops": 1 << n - 1,
        "matched": 2 << n,
        "half_branches": 2 << n,
        "complete": True,
    }
    written = loops_in(file)
    assert len(written) == len(found.loops)
    for entry, loop in zip(written, found.loops, strict=True):
        assert ray(entry["from"], pattern) == loop.source
        assert ray(entry["to"], pattern) == loop.target
        low, high = loop.length
        assert low * Fraction(97, 100) < Fraction(entry["length"]) <= high
    assert find_loops(pattern).loops == found.loops


def test_half_branches_of_a_reflex_sheet_are_those_of_its_corner(tmp_path):
    """The corner pops up on half of them; both halves of each name are matched."""
    pattern, file = reflex(), tmp_path / "loops.txt"
    found = find_loops(pattern, certificate=file)
    assert checker.verify(file)["matched"] == len(found.matching) == 8
    assert checker.verify(file)["complete"]
    assert {half.saddle for half in found.matching} == {1, -1}


@pytest.mark.slow
def test_a_loop_through_nodes_verifies(tmp_path):
    problem = Problem.of(NODE_SHEET)
    proof = LoopFinder(problem).follow(find_branch(NODE_SHEET, NODE_SIGNS))
    file = LoopFile.opened(tmp_path / "loops.txt", problem, resume=False, replace=False)
    assert repr(file) == f"<LoopFile: {tmp_path / 'loops.txt'}, 0 loops>"
    file.add(proof.loop, proof.line())
    file.add(proof.loop, proof.line())  # which is in the file already
    file.finish()
    file.close()
    claims = checker.verify(tmp_path / "loops.txt")
    assert (claims["loops"], claims["matched"], claims["complete"]) == (1, 4, False)
    [entry] = loops_in(tmp_path / "loops.txt")
    nodes = [step["flat"] for step in entry["evidence"]["steps"] if "flat" in step]
    assert nodes == [[9], [9]]
    known = LoopFile.opened(tmp_path / "loops.txt", problem, resume=True, replace=False)
    assert known.known == (proof.loop,)
    known.close()


def test_a_loop_that_is_not_proved_to_its_end_has_no_line(tmp_path):
    proof = LoopFinder(Problem.of(FOLDS_FLAT)).follow(find_branch(FOLDS_FLAT, "+"))
    with pytest.raises(NotCountedError, match="folded flat"):
        proof.line()
    found = find_loops(FOLDS_FLAT, certificate=tmp_path / "loops.txt")
    assert found.status is UNDECIDED
    claims = checker.verify(tmp_path / "loops.txt")
    assert (claims["loops"], claims["matched"], claims["complete"]) == (0, 0, False)


# --- interruptions -------------------------------------------------------------------------------


@pytest.mark.slow
def test_an_interrupted_run_is_continued(tmp_path, monkeypatch):
    pattern, file = random_square(3, seed=2), tmp_path / "loops.txt"
    whole = find_loops(pattern, certificate=tmp_path / "whole.txt")
    append = Journal.append

    def then_stop(self, body):
        append(self, body)
        if self.blocks == 2:
            raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(Journal, "append", then_stop)
        with pytest.raises(KeyboardInterrupt):
            find_loops(pattern, certificate=file)
    kept = file.read_bytes()
    assert kept.count(b"\n") == 3
    with pytest.raises(checker.CertificateError, match=r"^2 loops hold, but the claims are miss"):
        checker.verify(file)
    file.write_bytes(kept + b'{"from":{"vertex_signs"')  # a line that was cut off

    followed = []
    follow = LoopFinder.follow_from

    def seen(self, branch, source):
        followed.append(source)
        return follow(self, branch, source)

    monkeypatch.setattr(LoopFinder, "follow_from", seen)
    found = find_loops(pattern, certificate=file, resume=True)
    assert found.loops == whole.loops
    assert [loop.source for loop in whole.loops[2:]] == followed
    assert file.read_bytes() == (tmp_path / "whole.txt").read_bytes()
    # A complete file has nothing left to follow.
    followed.clear()
    assert find_loops(pattern, certificate=file, resume=True).loops == whole.loops
    assert not followed
    assert file.read_bytes() == (tmp_path / "whole.txt").read_bytes()


def test_files_of_others_are_refused(tmp_path):
    file = tmp_path / "loops.txt"
    find_loops(random_square(1, seed=0), certificate=file)
    kept = file.read_bytes()
    with pytest.raises(UsageError, match="exists already"):
        find_loops(random_square(1, seed=0), certificate=file, replace=False)
    with pytest.raises(ForeignJournalError, match="another pattern"):
        find_loops(random_square(1, seed=3), certificate=file, resume=True)
    assert file.read_bytes() == kept
    file.write_text("something else\n")
    with pytest.raises(ForeignJournalError, match="is not a certificate of loops"):
        find_loops(random_square(1, seed=0), certificate=file, resume=True)
    assert file.read_text() == "something else\n"


@pytest.fixture(scope="module")
def kept(tmp_path_factory):
    """The file of the loops of a sheet with one vertex."""
    file = tmp_path_factory.mktemp("loops") / "loops.txt"
    find_loops(random_square(1, seed=0), certificate=file, processes=1)
    return file.read_bytes()


@pytest.mark.parametrize(
    "change",
    [
        {"from": None},
        {"from": {"vertex_signs": [0], "side": 1}},
        {"to": {"vertex_signs": [1], "side": 2}},
        {"to": {"vertex_signs": [1, 1], "side": 1}},
        {"provenance": {}},
        {"provenance": {"length": ["1", "1/0"]}},
        {"evidence": {"steps": 1}},
    ],
)
def test_lines_that_are_no_loops_are_written_anew(change, kept, tmp_path):
    file = tmp_path / "loops.txt"
    header, entry, _ = (json.loads(line.partition(b"\t")[0]) for line in kept.splitlines())
    journal = Journal(file, json.dumps(header, separators=(",", ":")))
    journal.append(json.dumps(entry | change, separators=(",", ":")))
    journal.close()
    find_loops(random_square(1, seed=0), certificate=file, resume=True, processes=1)
    assert file.read_bytes() == kept


# --- the command line ----------------------------------------------------------------------------


def run(*arguments):
    return CliRunner().invoke(app, [str(a) for a in arguments])


@pytest.mark.slow
def test_the_command_line(tmp_path):
    file = tmp_path / "loops.txt"
    first = run("motions", TWO, "--certificate", file, "--workers", 1)
    assert first.exit_code == 0
    checked = run("check", file, "--workers", 1)
    assert checked.exit_code == 0
    assert checked.stdout.startswith(
        "VALID: 2 loops of true motions, which match all 8 rays; sha256 "
    )
    claims = json.loads(run("check", file, "--json").stdout)["claims"]
    assert claims["complete"] is True
    assert claims["loops"] == 2
    again = run("motions", TWO, "--certificate", file)
    assert again.exit_code == 2
    assert f"{file} exists already; --resume continues it" in again.stderr
    resumed = run("motions", TWO, "--certificate", file, "--resume", "--workers", 1)
    assert resumed.exit_code == 0
    assert resumed.stdout == first.stdout
    alone = run("motions", TWO, "--resume")
    assert alone.exit_code == 2
    assert "--resume continues a file" in alone.stderr
    itself = run("motions", TWO, "--certificate", TWO)
    assert itself.exit_code == 2
    folder = run("motions", TWO, "--certificate", tmp_path, "--resume")
    assert folder.exit_code == 2
    assert "is not a file" in folder.stderr


def test_a_forged_file_is_invalid_on_the_command_line(kept, tmp_path):
    file = tmp_path / "loops.txt"
    bodies = [line.partition(b"\t")[0].decode() for line in kept.splitlines()]
    journal = Journal(file, bodies[0])
    journal.finish(bodies[2])
    journal.close()
    result = run("check", file)
    assert result.exit_code == 1
    assert result.stdout.startswith("INVALID: claim loops = 1, but it is 0")


@pytest.mark.slow
def test_what_an_interrupted_run_leaves_is_unfinished(tmp_path, capsys):
    """Never valid, and invalid only with a loop that does not hold."""
    file = tmp_path / "loops.txt"
    find_loops("two-vertex", certificate=file)
    whole = file.read_text()
    bodies = [line.partition("\t")[0] for line in whole.splitlines()]
    for lines, said in (
        (bodies[:1], "0 loops hold, but the claims are missing"),
        (bodies[:3], "2 loops hold, but the claims are missing"),
    ):
        journal = Journal(file, lines[0])
        for line in lines[1:]:
            journal.append(line)
        journal.close()
        assert whole.startswith(file.read_text())
        result = run("check", file)
        assert (result.exit_code, result.stdout) == (1, f"UNFINISHED: {said}\n")
        as_json = run("check", file, "--json")
        document = json.loads(as_json.stdout)
        assert (as_json.exit_code, document["valid"], document["claims"]) == (1, False, {})
        assert document["reason"] == f"unfinished: {said}"
        assert checker.main([str(file)]) == 1
        assert capsys.readouterr().out == f"UNFINISHED: {said}\n"
    false = json.loads(bodies[1])
    false["length"] = "100"
    journal = Journal(file, bodies[0])
    journal.append(json.dumps(false, separators=(",", ":")))
    journal.close()
    result = run("check", file)
    assert (result.exit_code, result.stdout) == (1, "INVALID: loop 0: it is shorter than claimed\n")


SIGNALLED = """
import os, signal
from exactfold.app.cli import main
from exactfold.certificates import journal

append = journal.Journal.append

def then_signal(self, body):
    append(self, body)
    os.kill(os.getpid(), signal.SIGTERM)

if __name__ == "__main__":
    journal.Journal.append = then_signal
    main()
"""


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
@pytest.mark.slow
def test_an_interruption_says_how_to_go_on(tmp_path):
    pattern, fold, file = random_square(3, seed=2), tmp_path / "a b.fold", tmp_path / "c.txt"
    write_fold(pattern, fold)
    script = tmp_path / "run.py"
    script.write_text(SIGNALLED)
    done = subprocess.run(
        [sys.executable, script, "motions", fold, "--certificate", file, "--workers", "2"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == INTERRUPTED, done.stderr
    first, again = done.stderr.splitlines()
    assert first == "exactfold: interrupted; go on with"
    assert len(loops_in(file)) == 1
    words = shlex.split(again)
    assert words[:2] == ["exactfold", "motions"]
    assert words[-2:] == ["--workers", "2"]
    assert run(*words[1:-1], 1).exit_code == 0
    assert checker.verify(file)["complete"]
