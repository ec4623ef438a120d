"""The stand-alone checker of single branches: what it accepts, and that it refuses the rest."""

from __future__ import annotations

import copy
import json
import os
import random
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from itertools import product
from pathlib import Path
from typing import Any

import pytest
from sheets import (
    HEXAGON,
    SQUARE,
    dart,
    mapped,
    nested_triangles,
    reflex_corners,
    relabelled,
    scrambled,
    wheel,
)
from typer.testing import CliRunner

from exactfold import PROVED, checker, random_square
from exactfold.app.cli import app
from exactfold.branches import find_branch
from exactfold.branches.certificates.single import branch_certificate
from exactfold.checker import CertificateError, FormatError
from exactfold.errors import UsageError
from exactfold.pattern import families, read_fold
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.data import example_path
from exactfold.pattern.degenerate import gridded_square, ringed_square
from exactfold.pattern.writing.fold_writing import fold_text

Document = dict[str, Any]
PATTERNS = {
    "random": random_square(6, seed=3),
    "dart": dart(),
    "reflex": scrambled(3, reflex_corners(3), 3),
    "nested triangles": nested_triangles(),
    "thin triangles": scrambled(1, SQUARE, 12),
}


def certificate(name: str, seed: int = 0) -> Document:
    pattern = PATTERNS[name]
    source = random.Random(seed)
    signs = [source.choice((1, -1)) for _ in range(pattern.Vi - pattern.Vt)]
    return branch_certificate(find_branch(pattern, signs))


@pytest.mark.parametrize("name", PATTERNS)
@pytest.mark.parametrize("seed", range(3))
def test_proofs_are_accepted(name: str, seed: int) -> None:
    document = certificate(name, seed)
    read = checker.load(json.dumps(document))
    claims = checker.check(read)
    assert claims["sha256"] == PATTERNS[name].sha256
    assert claims["vertex_signs"] == document["claims"]["vertex_signs"]


def test_a_given_rim_is_accepted() -> None:
    pattern = scrambled(5, HEXAGON, 3)
    rim = {v: Fraction(v * v + 1, 3) for v in pattern.boundary}
    claims = checker.check(branch_certificate(find_branch(pattern, "+-+", boundary_heights=rim)))
    assert claims["gauge"] == "rim"
    assert checker.summary(claims).startswith("VALID: exactly one solution over the boundary")


def shifted(text: str, by: int) -> str:
    return str(int(text) + by)


def move_vertex(c: Document) -> None:
    unit = int(c["evidence"]["denominator"])
    c["evidence"]["heights"][6] = shifted(c["evidence"]["heights"][6], unit // 50)


def tilt_rim(c: Document) -> None:
    # Another rim with the opposite saddle: the other side of some branch.
    c["evidence"]["heights"] = [str(-int(h)) for h in c["evidence"]["heights"]]


def flip_letter(c: Document) -> None:
    text = c["claims"]["assignment"]
    c["claims"]["assignment"] = ("V" if text[0] == "M" else "M") + text[1:]


def flat_letter(c: Document) -> None:
    c["claims"]["assignment"] = "F" + c["claims"]["assignment"][1:]


def flip_sign(c: Document) -> None:
    c["claims"]["vertex_signs"][2] *= -1


def zero_sign(c: Document) -> None:
    c["claims"]["vertex_signs"][2] = 0


def smaller_distance(c: Document) -> None:
    text = c["claims"]["squared_distance"]
    top, bottom = text.split("/")
    c["claims"]["squared_distance"] = f"{top}/{int(bottom) * 2}"


def rough_heights(c: Document) -> None:
    c["evidence"]["heights"] = [str(int(h) >> 60) for h in c["evidence"]["heights"]]
    c["evidence"]["denominator"] = str(int(c["evidence"]["denominator"]) >> 60)


def move_corner(c: Document) -> None:
    c["pattern"]["vertices"][2] = ["1/2", "1/2"]


def no_face(c: Document) -> None:
    c["pattern"]["triangles"].pop()


def other_gauge(c: Document) -> None:
    c["claims"]["gauge"] = "none"


def fewer_signs(c: Document) -> None:
    c["claims"]["vertex_signs"].pop()


def fewer_letters(c: Document) -> None:
    c["claims"]["assignment"] = c["claims"]["assignment"][1:]


def no_height(c: Document) -> None:
    c["evidence"]["heights"][5] = None


def no_denominator(c: Document) -> None:
    c["evidence"]["denominator"] = "0"


def remove_vertex(c: Document) -> None:
    c["evidence"]["emptied"] = [{"corners": [0, 1, 2], "inside": [5]}]


def extra_key(c: Document) -> None:
    c["claims"]["more"] = 1


TAMPERING = [
    move_vertex,
    tilt_rim,
    flip_letter,
    flat_letter,
    flip_sign,
    zero_sign,
    smaller_distance,
    rough_heights,
    move_corner,
    no_face,
    other_gauge,
    fewer_signs,
    fewer_letters,
    no_height,
    no_denominator,
    remove_vertex,
    extra_key,
]


@pytest.mark.parametrize("tamper", TAMPERING, ids=lambda t: t.__name__)
def test_altered_certificates_are_refused(tamper: Callable[[Document], None]) -> None:
    document = certificate("random")
    altered = copy.deepcopy(document)
    tamper(altered)
    assert altered != document
    with pytest.raises(CertificateError):
        checker.check(altered)


FLAT = {  # vertices and folds that are flat: by K_v = 0 at a vertex, or with exact heights
    "flat vertex": (read_fold(example_path("flat-vertex")), "++", False),
    "dart": (dart(), "+", False),
    "folded along a line": (gridded_square(3, 3), "+++++++", True),
    "straight hypar": (families.hypar(2, 0), "++++++++", True),
}


@pytest.mark.parametrize("name", FLAT)
def test_flat_folds_and_vertices_are_proved_and_nothing_else_passes(name: str) -> None:
    pattern, signs, exact = FLAT[name]
    document = branch_certificate(find_branch(pattern, signs))
    claims = document["claims"]
    assert "F" in claims["assignment"]
    assert "U" not in claims["assignment"]
    assert (claims["squared_distance"] == "0") == exact
    checker.check(document)
    forged = []
    for k, letter in enumerate(claims["assignment"]):
        text = claims["assignment"]
        forged += [{"assignment": text[:k] + x + text[k + 1 :]} for x in "MVF" if x != letter]
    for k, sign in enumerate(claims["vertex_signs"]):
        values = claims["vertex_signs"]
        others = {-1, 0, 1} - {sign}
        forged += [{"vertex_signs": [*values[:k], x, *values[k + 1 :]]} for x in others]
    forged += [] if exact else [{"squared_distance": "0"}]
    for change in forged:
        with pytest.raises(CertificateError):
            checker.check({**document, "claims": {**claims, **change}})


@pytest.mark.parametrize(
    ("pattern", "signs", "bits"),
    [
        (random_square(6, seed=0, denominator=4), "+-++++", 20),  # K = 0 at the other vertices
        (gridded_square(3, 3), "+++++++", 300),  # K is of the order of 1 / denominator^2
    ],
)
def test_heights_that_are_almost_exact_are_refused(
    pattern: CreasePattern, signs: str, bits: int
) -> None:
    document = branch_certificate(find_branch(pattern, signs))
    assert document["claims"]["squared_distance"] == "0"
    evidence = document["evidence"]
    evidence["denominator"] = str(int(evidence["denominator"]) << bits)
    finer = [h and str(int(h) << bits) for h in evidence["heights"]]
    evidence["heights"] = finer
    checker.check(document)
    for v, by in product(range(4, len(finer)), (1, -1)):
        if finer[v] is not None:
            evidence["heights"] = [*finer[:v], shifted(finer[v], by), *finer[v + 1 :]]
            with pytest.raises(CertificateError, match="K is not positive"):
                checker.check(document)


def test_a_vertex_that_may_be_flat_is_refused() -> None:
    found = find_branch(ringed_square(4), "+++++")
    document = branch_certificate(replace(found, status=PROVED))
    with pytest.raises(CertificateError, match="vertex 8 may be flat"):
        checker.check(document)


def test_the_curvature_of_the_reflex_corner_counts() -> None:
    document = certificate("reflex")
    evidence, claims = document["evidence"], document["claims"]
    evidence["heights"] = [h and str(2 * int(h)) for h in evidence["heights"]]
    claims["assignment"] = "U" * len(claims["assignment"])
    claims["squared_distance"] = str(Fraction(claims["squared_distance"]) * 1000)
    with pytest.raises(CertificateError, match="distance is larger"):
        checker.check(document)


def test_folds_are_not_flat_by_what_is_around_the_reflex_corner(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # K is 1 there. With K = 0 at a vertex of degree 3 all its folds would be flat.
    pattern = wheel([(4, -4), ("1/10", 0), (4, 4), (-4, 0)], (0, "1/1000"))
    assert find_branch(pattern, "-").assignment_text == "VMVV"
    monkeypatch.setattr(
        "exactfold.solve.certify.enclosed._LEVELS", (6,)
    )  # too rough for fold (1, 4)
    document = branch_certificate(find_branch(pattern, "-"))
    assert document["claims"]["assignment"] == "VUVV"
    checker.check(document)
    document["claims"]["assignment"] = "VFVV"
    with pytest.raises(CertificateError, match="not known to be 'F'"):
        checker.check(document)


def test_a_letter_may_be_left_open() -> None:
    document = certificate("random")
    document["claims"]["assignment"] = "U" * len(document["claims"]["assignment"])
    claims = checker.check(document)
    assert set(claims["assignment"]) == {"U"}
    assert "; 0 of 19 letters decided; " in checker.summary(claims)


def test_a_reflex_corner_that_pops_down_is_refused() -> None:
    document = certificate("reflex")
    document["evidence"]["heights"] = [
        None if h is None else str(-int(h)) for h in document["evidence"]["heights"]
    ]
    document["claims"]["vertex_signs"] = [-s for s in document["claims"]["vertex_signs"]]
    swap = str.maketrans("MV", "VM")
    document["claims"]["assignment"] = document["claims"]["assignment"].translate(swap)
    with pytest.raises(CertificateError, match="corner does not pop up"):
        checker.check(document)


def test_a_boundary_that_is_not_convex_needs_its_notch_closed() -> None:
    document = certificate("dart")
    document["claims"]["gauge"] = "rim"
    with pytest.raises(CertificateError, match="not convex"):
        checker.check(document)


def test_vertices_of_triangulated_triangles_must_be_the_ones_inside() -> None:
    document = certificate("nested triangles")
    entry = document["evidence"]["emptied"][0]
    entry["inside"] = entry["inside"][1:]
    with pytest.raises(CertificateError):
        checker.check(document)


@pytest.mark.parametrize(
    "text",
    ["", "[]", "{}", '{"format": "exactfold branch"}', '{"format": 1.5}', '{"a": NaN}', "[" * 9999],
)
def test_other_files_are_no_certificates(text: str) -> None:
    with pytest.raises(FormatError):
        checker.load(text)


def test_a_repeated_key_is_refused() -> None:
    text = json.dumps(certificate("dart")).replace('"claims":', '"claims": {}, "claims":')
    with pytest.raises(FormatError, match="a key appears twice"):
        checker.load(text)


def test_a_truth_value_is_no_vertex() -> None:
    order = [0, 7, 2, 3, 4, 5, 6, 1, 8, 9]  # vertex 1 lies in the triangle
    document = branch_certificate(find_branch(relabelled(nested_triangles(), order), "+-+"))
    inside = document["evidence"]["emptied"][0]["inside"]
    inside[inside.index(1)] = True
    with pytest.raises(CertificateError, match="not a natural number"):
        checker.check(document)


@pytest.mark.parametrize("letter", ["\ud800", "\u00e9", "\x1b"])
def test_verdicts_can_be_printed_whatever_the_file_holds(letter: str, tmp_path: Path) -> None:
    path = tmp_path / "c.json"
    for place in ("letter", "height"):
        document = certificate("random")
        if place == "letter":
            document["claims"]["assignment"] = letter + document["claims"]["assignment"][1:]
        else:
            document["evidence"]["heights"][5] = letter
        path.write_text(json.dumps(document))
        command = [sys.executable, str(Path(checker.__file__).parent), str(path)]
        ascii_only = {**os.environ, "PYTHONIOENCODING": "ascii"}
        run = subprocess.run(command, capture_output=True, text=True, check=False, env=ascii_only)
        assert (run.returncode, run.stderr) == (1, "")
        assert run.stdout.startswith("INVALID")
        assert run.stdout.strip().isprintable()


def test_low_heights_over_a_long_denominator_are_accepted() -> None:
    # Coordinates of 150 bits and a rim of height 2^-400: curvatures far below 1 / denominator^2.
    tiny = Fraction(1, 10**40)
    pattern = mapped(scrambled(5, HEXAGON, 3), lambda p: (p[0] + tiny, p[1] * (1 + tiny)))
    rim = {v: Fraction(v * v + 1, 3 << 400) for v in pattern.boundary}
    document = branch_certificate(find_branch(pattern, "+-+", boundary_heights=rim))
    assert checker.check(document)["vertex_signs"] == [1, -1, 1]


def test_versions_and_keys_are_checked() -> None:
    document = certificate("dart")
    for wrong in ({**document, "version": 4}, {**document, "more": 1}):
        with pytest.raises(FormatError):
            checker.load(json.dumps(wrong))
    with pytest.raises(CertificateError, match="squared_distance curvature"):
        checker.check(checker.load(json.dumps({**document, "version": 2})))


def test_nothing_undecided_gets_a_certificate() -> None:
    flat = find_branch(ringed_square(4), "+++++")
    with pytest.raises(UsageError, match="has proved it"):
        branch_certificate(flat)


def test_commands_write_and_check(tmp_path: Path) -> None:
    path = tmp_path / "c.json"
    two = example_path("two-vertex")
    runner = CliRunner()
    done = runner.invoke(app, ["branch", str(two), "--signs", "+-", "--certificate", str(path)])
    assert done.exit_code == 0
    checked = runner.invoke(app, ["check", str(path)])
    assert checked.exit_code == 0
    assert "exactly one branch has the vertex signs +-" in checked.stdout
    short = json.loads(runner.invoke(app, ["check", str(path), "--json"]).stdout)
    assert short["valid"]
    assert set(short["claims"]) == {"sha256", "interior", "gauge", "squared_distance"}
    document = json.loads(path.read_text())
    flip_letter(document)
    path.write_text(json.dumps(document))
    refused = runner.invoke(app, ["check", str(path)])
    assert refused.exit_code == 1
    assert "INVALID" in refused.stdout


def test_undecided_and_several_branches_write_nothing(tmp_path: Path) -> None:
    path = tmp_path / "c.json"
    flat = str(tmp_path / "ringed.fold")
    Path(flat).write_text(fold_text(ringed_square(4)))
    runner = CliRunner()
    done = runner.invoke(app, ["branch", flat, "--signs", "+++++", "--certificate", str(path)])
    assert done.exit_code == 4
    assert "no certificate was written" in done.stderr
    several = ["branch", flat, "--up", "4", "--neighbours", "all", "--certificate", str(path)]
    assert runner.invoke(app, several).exit_code == 2
    assert not path.exists()


def test_main_prints_the_verdict(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "c.json"
    document = certificate("thin triangles")
    path.write_text(json.dumps(document))
    assert checker.main([str(path)]) == 0
    assert capsys.readouterr().out.startswith("VALID")
    flip_sign(document)
    path.write_text(json.dumps(document))
    assert checker.main([str(path)]) == 1
    assert capsys.readouterr().out.startswith("INVALID")
    path.write_text('{"format": "exactfold branch", "version": 1.0}')
    assert checker.main([str(path)]) == 3
    assert checker.main([str(tmp_path / "none")]) == 3
    assert checker.main([]) == 2
