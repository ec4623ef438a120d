"""Listings of all branches, also with flat stars, in the program from the formal proof."""

import json
import re
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from compact_files import Lines, bodies, chained
from verifying import run, valid

from exactfold.pattern.triangulating.random_squares import sample_random_square

CERTIFICATES = Path(__file__).parent.parent / "fixtures" / "certificates"
TRIANGLE = CERTIFICATES / "compact-roots-triangle.txt"
"""Five branches; vertex 7 lies in a triangulated triangle, and 5 and 6 are flat on the last one."""
FLAT_BOX = CERTIFICATES / "algebraic-flat-box.json"
EITHER = CERTIFICATES / "compact-roots-either-side.txt"
"""Three branches of a sheet with a reflex corner; of the first one no side is told apart."""
Change = Callable[[Lines], object]
FAILED = "NOT VERIFIED  branch {} did not pass the test"


def at(number: int, **changes: object) -> Change:
    """Another claim about a branch."""
    return lambda lines: lines[1]["roots"][number].update(changes)


def claim(**changes: object) -> Change:
    return lambda lines: lines[-1]["claims"].update(changes)


def evidence(**changes: object) -> Change:
    return lambda lines: lines[0]["evidence"].update(changes)


def of_class(**changes: object) -> Change:
    return lambda lines: lines[0]["evidence"]["classes"][0].update(changes)


def root(number: int, **changes: object) -> Change:
    return lambda lines: lines[1]["roots"][number]["root"].update(changes)


def exchanged(lines: Lines) -> None:
    first, second = lines[1]["roots"][:2]
    first["root"], second["root"] = second["root"], first["root"]


def left_out(lines: Lines) -> None:
    lines[1]["roots"].pop(0)
    lines[0]["evidence"]["roots"] = 4
    lines[-1]["claims"].update(distinct=4, real=4)


def twice(lines: Lines) -> None:
    lines[1]["roots"][1] = lines[1]["roots"][0]


FORGERIES: list[tuple[str, Change]] = [
    (FAILED.format(0), at(0, assignment="MVVFVFMMMVVVF")),
    (FAILED.format(4), at(4, assignment="MFMFFFMFFFFFF")),
    (FAILED.format(4), at(4, assignment="FFFFFFMFFFFFF")),
    ("branch 0 has a fold with the letter F that is not flat", at(0, assignment="FVVFVFMMMVVVF")),
    (FAILED.format(0), at(0, vertex_signs="+--0")),
    (FAILED.format(0), at(0, vertex_signs="0--0", multiplicity=4)),
    (FAILED.format(4), at(4, vertex_signs="++00", multiplicity=4)),
    (FAILED.format(0), at(0, multiplicity=1)),
    (FAILED.format(4), at(4, multiplicity=4)),
    (FAILED.format(0), exchanged),
    ("agrees with none of the branches, or with several", left_out),
    ("agrees with none of the branches, or with several", twice),
    ("lies inside a triangulated triangle, and its sign is not 0", at(0, vertex_signs="---+")),
    ("inside a triangulated triangle, and is not F", at(0, assignment="VVVFVFMMMVVVV")),
    ("the numbers of signs and of vertices differ", at(0, vertex_signs="---")),
    ("the number of letters is wrong", at(0, assignment="VVVFVFMMMVVV")),
    ("branch 0 has a vertex with the sign x", at(0, vertex_signs="-x-0")),
    ("root 0 has a fold with the letter X", at(0, assignment="XVVFVFMMMVVVF")),
    ("branch 0: its positive saddle is shown", at(0, representative="either")),
    ("multiplicity is no number", at(0, multiplicity="2")),
    ('the key "more" is not known', at(0, more=1)),
    ('the key "more" is not known', root(0, more=1)),
    ('the key "more" is not known', claim(more=1)),
    ('the key "more" is not known', evidence(more=1)),
    ('the key "more" is not known', of_class(more=1)),
    ('the key "more" is not known', lambda lines: lines[0].update(more=1)),
    ('the key "more" is not known', lambda lines: lines[1].update(more=1)),
    ('the claim "interior" is 3', claim(interior=3)),
    ('the claim "boundary" is 5', claim(boundary=5)),
    ('the claim "folds" is 12', claim(folds=12)),
    ('the claim "degrees_of_freedom" is 2', claim(degrees_of_freedom=2)),
    ('the claim "distinct" is 6', claim(distinct=6)),
    ('the claim "with_multiplicity" is 8', claim(with_multiplicity=8)),
    ('the claim "real" is 4', claim(real=4)),
    ('the claim "nonreal" is 1', claim(nonreal=1)),
    ('the claim "sha256" is 00', claim(sha256="0" * 64)),
    ('the claim "true_branches" is proved, not undecided', claim(true_branches="proved")),
    ('the evidence is "chambers", not a list of roots', evidence(kind="chambers")),
    ("the chart is one of a sheet with a reflex corner", evidence(chart={"4": "1"})),
    ("the number of blocks is wrong", evidence(block=2)),
    ("block 0 has another number of roots", evidence(roots=6)),
    ("block 0 is expected", lambda lines: lines[1].update(block=1)),
    ("is missing, or given twice", lambda lines: lines[1]["roots"][0].pop("root")),
    ("a root is not an object", at(0, root=None)),
    ("a root has another number of heights", root(0, center=["1"])),
    ("a root has another number of heights", of_class(numerators=[["1"]])),
    ("a class polynomial is constant, or its degree is less", of_class(polynomial=["-3"])),
    ("a class polynomial is constant, or its degree is less", of_class(polynomial=["-3", "0"])),
    ("a class polynomial has a double root", of_class(polynomial=["9", "-48", "64"])),
    ("an interval has not two ends", root(4, interval=["3/8"])),
]


@pytest.mark.slow
def test_forged_listings_are_refused(verifier: Path, tmp_path: Path) -> None:
    code, text = run(verifier, TRIANGLE)
    assert code == 0
    assert "exactly 5 branches" in text
    assert "theorem listed_verified" in text
    assert "The 1 triangle with 1 vertex inside stays flat" in text
    path = tmp_path / "forged.txt"
    for said, change in FORGERIES:
        lines = bodies(TRIANGLE.read_bytes())
        change(lines)
        path.write_bytes(chained(lines))
        code, text = run(verifier, path)
        assert code in (1, 3), (said, text)
        assert said in text, (said, text)
        assert "VERIFIED  exactly" not in text
        assert valid(path) is None, said


REVERSED = str.maketrans("+-MV", "-+VM")
REFLEX_FORGERIES: list[tuple[str, Change]] = [
    (FAILED.format(2), at(2, vertex_signs="-+", assignment="VVVMMVM".translate(REVERSED))),
    (FAILED.format(2), at(2, vertex_signs="-+")),
    (FAILED.format(2), at(2, vertex_signs="+-", assignment="MVVMMVM")),
    (FAILED.format(1), at(1, vertex_signs="+0")),
    (FAILED.format(1), at(1, vertex_signs="--", multiplicity=1)),
    (FAILED.format(1), at(1, multiplicity=1)),
    (FAILED.format(0), at(0, vertex_signs="-+")),
    ("branch 1: its positive saddle is shown", at(1, representative="neither")),
    (FAILED.format(1), evidence(chart=None)),
    ("the chart does not fix the height of the reflex corner", evidence(chart={"4": "1"})),
    ("the chart is neither null nor a functional", evidence(chart=[])),
    ("a vertex of the chart is no whole number", evidence(chart={"x": "1"})),
    ("a weight of the chart is no rational number", evidence(chart={"1": "1/0"})),
    ('the claim "distinct" is 4', claim(distinct=4)),
]


@pytest.mark.slow
def test_forged_listings_with_a_reflex_corner_are_refused(verifier: Path, tmp_path: Path) -> None:
    code, text = run(verifier, EITHER)
    assert code == 0
    assert "exactly 3 branches" in text
    assert "theorem reflex_verified" in text
    path = tmp_path / "forged.txt"
    for said, change in REFLEX_FORGERIES:
        lines = bodies(EITHER.read_bytes())
        change(lines)
        path.write_bytes(chained(lines))
        code, text = run(verifier, path)
        assert code in (1, 3), (said, text)
        assert said in text, (said, text)
        assert valid(path) is None, said


@pytest.mark.slow
def test_roots_are_proposals(verifier: Path, tmp_path: Path) -> None:
    """The program finds its own evidence near them, where the checker in Python refuses."""
    path = tmp_path / "changed.txt"
    for change in (root(0, radius=str(1 << 70)), evidence(multipliers=[]), evidence(separating=[])):
        lines = bodies(TRIANGLE.read_bytes())
        change(lines)
        path.write_bytes(chained(lines))
        assert run(verifier, path)[0] == 0
        assert valid(path) is None


@pytest.mark.slow
def test_listings_in_one_object(verifier: Path, tmp_path: Path) -> None:
    given = json.loads(FLAT_BOX.read_text(encoding="utf-8"))
    path = tmp_path / "forged.json"

    def forged(part: str, key: str, value: Any) -> tuple[int, str]:
        path.write_text(json.dumps(given | {part: given[part] | {key: value}}), encoding="utf-8")
        assert valid(path) is None
        return run(verifier, path)

    branches, roots = given["claims"]["branches"], given["evidence"]["roots"]
    code, text = forged("claims", "branches", branches[1:])
    assert (code, "the numbers of roots and of branches differ" in text) == (1, True)
    code, text = forged("claims", "branches", [branches[0] | {"more": 1}, *branches[1:]])
    assert (code, 'the key "more" is not known' in text) == (3, True)
    number = next(k for k, entry in enumerate(roots) if "flat" in entry)
    entry = roots[number] | {"flat": list(range(4, 8))}
    code, text = forged("evidence", "roots", [*roots[:number], entry, *roots[number + 1 :]])
    assert (code, "no heights in the chart have the flat folds" in text) == (3, True)


@pytest.mark.slow
def test_more_than_thirty_vertices_are_too_many(verifier: Path, tmp_path: Path) -> None:
    given = json.loads(FLAT_BOX.read_text(encoding="utf-8"))
    sheet = sample_random_square(31, 1, redraw=True).pattern
    given["pattern"] = {
        "vertices": [[str(x) for x in point] for point in sheet.vertices],
        "triangles": [list(face) for face in sheet.triangles],
    }
    path = tmp_path / "many.json"
    path.write_text(json.dumps(given), encoding="utf-8")
    code, text = run(verifier, path)
    assert (code, "31 vertices inside are too many" in text) == (3, True)
    assert valid(path) is None


@pytest.fixture(scope="module")
def forger(formal: Path, verifier: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A program that changes what is proposed to the proved test (forged_evidence.ml)."""
    folder = tmp_path_factory.mktemp("forged")
    source = folder / "forged.ml"
    shutil.copy(Path(__file__).with_name("forged_evidence.ml"), source)
    made = ["integer", "verified", "sha256", "reading", "drawing", "proposing"]
    made += ["spaces", "sheets", "branch", "listing"]
    command = ["ocamlfind", "ocamlopt", "-w", "-a", "-package", "zarith", "-linkpkg"]
    command += [f"{name}.cmx" for name in made] + [
        str(source),
        "-o",
        str(folder / "forged"),
    ]
    done = subprocess.run(command, cwd=verifier.parent, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return folder / "forged"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "spaces"),
    [
        ("flat-box", 2),
        ("ring", 26),
        ("triangle", 0),
        ("open-folds", 0),
        ("reflex", 12),
        ("waterbomb-pair", 28),
    ],
)
def test_the_proved_test_refuses_other_evidence(forger: Path, name: str, spaces: int) -> None:
    path = CERTIFICATES / f"algebraic-{name}.json"
    shown = subprocess.run([forger, path], capture_output=True, text=True, check=False)
    found = re.fullmatch(r"refused (\d+) changes, with (\d+) spaces\n", shown.stdout)
    assert found is not None, shown.stdout + shown.stderr
    assert int(found[1]) > 100
    assert int(found[2]) == spaces
