"""The checker runs alone as a file, and refuses sheets and evidence that prove nothing."""

import json
import random
import shutil
import subprocess
import sys
from fractions import Fraction
from itertools import combinations
from pathlib import Path

import pytest
from sheets import (
    HEXAGON,
    SQUARE,
    TRIANGLE,
    dart,
    mapped,
    nested_triangles,
    random_wheel,
    reflex_corners,
    scrambled,
    straight_side,
    two_triangles,
    wheel,
    with_point,
)

from exactfold import PROVED, certificate, checker, count_branches, random_square
from exactfold.algebra.groebner import groebner
from exactfold.branches.classify import classify
from exactfold.branches.roots import AlgebraicRoot
from exactfold.certify.algebraic import prove_algebraic
from exactfold.errors import NotApplicableError
from exactfold.evidence.entries import algebraic_evidence, class_entry, write_certificate
from exactfold.evidence.entries import document as assemble
from exactfold.exact.linalg import inertia, nullspace
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.families import FAMILIES, hypar, two_vertex
from exactfold.problem.branch_system import BranchSystem
from exactfold.rigidity.curvature import curvature_form
from exactfold.rigidity.functionals import fold_functional

SHEETS = {
    **{name: build() for name, build in FAMILIES.items()},
    "hypar proper": hypar(1, twist=0),
    "random": random_square(5, seed=1),
    "rigid vertex": with_point(two_vertex(), 1, (1, 2, 2)),
    "two rigid vertices": two_triangles(),
    "nested": nested_triangles(),
    "chord": with_point(CreasePattern(SQUARE, [(0, 1, 2), (0, 2, 3)]), 0, (1, 1, 1)),
    "dart": dart(),
    "reflex": scrambled(4, reflex_corners(4), 3),
    "straight side": straight_side(smallest=True),
    "cross": wheel([(1, 0), (0, 2), (-3, 0), (0, -1)]),
    "triangle": scrambled(2, TRIANGLE, 4),
    "nine folds": random_wheel(1, 9),
    "huge numbers": mapped(random_square(2, seed=1), lambda p: (10**4500 * p[0], 10**4500 * p[1])),
}
EVIDENCE = {
    **dict.fromkeys(SHEETS, "isolated"),
    **dict.fromkeys(["flat-vertex", "hypar proper"], "algebraic"),
    **dict.fromkeys(["waterbomb", "nine folds"], "single vertex"),
    "triangle": "rigid",
}
sheets = pytest.mark.parametrize("name", SHEETS)


def proof(name):
    result = count_branches(SHEETS[name])
    assert result.status is PROVED
    return json.loads(json.dumps(certificate(result)))


def alone(folder, *arguments):
    """Run a copy of the checker without site packages or the folder of the package."""
    shutil.copy(checker.__file__, folder / "checker.py")
    command = [sys.executable, "-I", "-S", "checker.py", *map(str, arguments)]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


# --- as a file -----------------------------------------------------------------------------------


def test_package_is_out_of_reach_of_the_copy(tmp_path):
    command = [sys.executable, "-I", "-S", "-c", "import exactfold"]
    result = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert "ModuleNotFoundError" in result.stderr


@pytest.mark.parametrize("name", ["random", "hypar proper", "triangle", "nine folds", "nested"])
def test_runs_alone(tmp_path, name):
    write_certificate(proof(name), tmp_path / "c.json")
    result = alone(tmp_path, "c.json")
    assert (result.returncode, result.stderr) == (0, "")
    assert result.stdout.startswith("VALID: ")
    assert SHEETS[name].sha256 in result.stdout


def test_exit_codes_of_the_file(tmp_path):
    document = proof("two-vertex")
    document["claims"]["distinct"] = 3
    (tmp_path / "false.json").write_text(json.dumps(document))
    (tmp_path / "cut.json").write_text(json.dumps(document)[:-5])
    false, cut, none = (alone(tmp_path, f) for f in ("false.json", "cut.json", "none.json"))
    assert (false.returncode, cut.returncode, none.returncode) == (1, 3, 3)
    assert false.stdout == "INVALID: claim distinct = 3, but it is 4\n"
    assert "not a certificate" in cut.stderr
    assert alone(tmp_path).returncode == 2


def test_imports_the_standard_library_only():
    lines = Path(checker.__file__).read_text().splitlines()
    imported = {
        line.split()[1].split(".")[0] for line in lines if line.startswith(("import", "from"))
    }
    assert imported <= set(sys.stdlib_module_names) | {"__future__"}


@pytest.mark.parametrize(
    ("content", "code"),
    [(b"\xff\xfe", 3), (b"", 3), (b"[]", 3), (b'{"format": "exactfold certificate"}', 3)],
)
def test_main_refuses_other_files(tmp_path, capsys, content, code):
    path = tmp_path / "c.json"
    path.write_bytes(content)
    assert checker.main([str(path)]) == code
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err != ""


def test_main_prints_the_verdict(tmp_path, capsys):
    write_certificate(proof("dart"), tmp_path / "c.json")
    assert checker.main([str(tmp_path / "c.json")]) == 0
    assert "VALID: 2 branches (2 with multiplicity, 2 real)" in capsys.readouterr().out
    assert checker.main([]) == 2
    capsys.readouterr()
    false = proof("dart")
    false["claims"]["folds"] = 5
    write_certificate(false, tmp_path / "f.json")
    assert checker.main([str(tmp_path / "f.json")]) == 1
    assert capsys.readouterr().out == "INVALID: claim folds = 5, but it is 4\n"


# --- every kind of evidence ----------------------------------------------------------------------


@sheets
def test_certificate_is_valid(name):
    document = proof(name)
    assert document["evidence"]["kind"] == EVIDENCE[name]
    assert checker.check(checker.load(json.dumps(document))) == document["claims"]


@sheets
def test_certificate_has_the_documented_keys_and_no_floats(name):
    document = proof(name)
    assert list(document) == ["format", "version", "pattern", "claims", "evidence", "provenance"]

    def check_no_float(value):
        assert not isinstance(value, float)
        for part in value.values() if isinstance(value, dict) else value:
            if isinstance(part, dict | list):
                check_no_float(part)
            else:
                assert not isinstance(part, float)

    check_no_float(document)


def test_no_certificate_of_an_undecided_count():
    result = count_branches(scrambled(1, HEXAGON, 2, loose=True))
    with pytest.raises(NotApplicableError, match="no certificate: the count is undecided"):
        certificate(result)


# --- its own code against the package ------------------------------------------------------------


def checked_sheet(pattern):
    return checker.Sheet(dict(enumerate(pattern.vertices)), [tuple(t) for t in pattern.triangles])


@sheets
def test_sheet_agrees_with_the_pattern(name):
    pattern = SHEETS[name]
    sheet = checked_sheet(pattern)
    assert tuple(sheet.boundary) == pattern.boundary
    assert tuple(sheet.interior) == pattern.interior
    assert tuple(sheet.folds) == pattern.folds
    assert tuple(sheet.edges) == pattern.edges
    assert {sheet.face(t) for t in sheet.triangles} == set(pattern.triangles)


@sheets
def test_curvature_agrees_with_the_package(name):
    pattern = SHEETS[name]
    sheet = checked_sheet(pattern)
    for v in pattern.interior:
        form = curvature_form(pattern, v)
        assert checker.matrix_of(sheet.curvature(v), list(form.labels)) == [
            list(row) for row in form.matrix
        ]
        checker.check_lorentzian(sheet, v)


@sheets
def test_bends_agree_with_the_package(name):
    pattern = SHEETS[name]
    sheet = checked_sheet(pattern)
    for fold in pattern.folds:
        ours, theirs = fold_functional(pattern, fold), sheet.bend(fold)
        assert set(ours) == set(theirs)
        v = fold[0]
        factor = theirs[v] / ours[v] if ours[v] else theirs[fold[1]] / ours[fold[1]]
        assert factor > 0
        assert all(theirs[u] == factor * ours[u] for u in ours)


@pytest.mark.parametrize(
    "matrix",
    [
        [[0, 1, 0], [1, 0, 0], [0, 0, 0]],
        [[0, 1, 1], [1, 0, 1], [1, 1, 0]],
        [[2, 1], [1, 2]],
        [[-1, 0], [0, 0]],
        [[0, 0], [0, 0]],
    ],
)
def test_inertia_agrees_with_the_package(matrix):
    assert checker.inertia([[Fraction(x) for x in row] for row in matrix]) == inertia(matrix)


def test_kernel_agrees_with_the_package():
    rows = [
        [Fraction(x) for x in row] for row in ([0, 0, 2, 4, 1], [0, 3, 1, 0, 0], [0, 3, 3, 4, 1])
    ]
    assert checker.kernel(rows, 5) == nullspace(rows)
    assert checker.kernel([], 2) == [[1, 0], [0, 1]]


def test_long_integers_survive():
    for n in (0, -7, 10**4000, -(10**9001) + 3, 7**20000):
        assert checker.parse_integer(checker.digits(n)) == n


@pytest.mark.parametrize("text", ["", "-", "+1", "1 ", "1_0", "0x1", "--1", "\u0661", "1.0"])
def test_other_text_is_no_integer(text):
    with pytest.raises(checker.CertificateError):
        checker.parse_integer(text)


@pytest.mark.parametrize("text", ["1/0", "1/-2", "1/", "/2", "1/2/3", 1, None, 0.5, True])
def test_other_values_are_no_rational(text):
    with pytest.raises(checker.CertificateError):
        checker.parse_rational(text)


def test_real_roots_are_counted_by_sturm():
    def expanded(*roots):
        p = [Fraction(1)]
        for root in roots:
            p = checker.times(p, [Fraction(-root), Fraction(1)])
        return p

    assert checker.count_real_roots(expanded(1, -2, 3)) == 3
    assert checker.count_real_roots([Fraction(1), Fraction(0), Fraction(1)]) == 0
    mixed = checker.times(expanded(5), [Fraction(2), Fraction(1), Fraction(1)])
    assert checker.count_real_roots(mixed) == 1
    assert checker.are_coprime(expanded(1, 2), expanded(3))
    assert not checker.are_coprime(expanded(1, 2), expanded(2, 3))


# --- sheets that are refused ---------------------------------------------------------------------

BAD_SHEETS = {
    "clockwise": (SQUARE, [(0, 2, 1), (0, 3, 2)], "not positive"),
    "degenerate": ([(0, 0), (1, 0), (2, 0)], [(0, 1, 2)], "not positive"),
    "repeated corner": (SQUARE, [(0, 1, 1), (0, 2, 3)], "bad face"),
    "no such vertex": (SQUARE, [(0, 1, 2), (0, 2, 9)], "bad face"),
    "duplicate point": ([*SQUARE, (1, 1)], [(0, 1, 2), (0, 4, 3)], "two vertices at one point"),
    "same side twice": (
        [*SQUARE, ("1/2", 2)],
        [(0, 1, 2), (0, 2, 3), (0, 1, 4)],
        "two faces on one side",
    ),
    "isolated": ([*SQUARE, (5, 5)], [(0, 1, 2), (0, 2, 3)], "on no face"),
    "pinch": (
        [(0, 0), (1, 0), (0, 1), (-1, 0), (0, -1)],
        [(0, 1, 2), (0, 3, 4)],
        "pinched",
    ),
    "two disks": (
        [(0, 0), (1, 0), (0, 1), (5, 0), (6, 0), (5, 1)],
        [(0, 1, 2), (3, 4, 5)],
        "not one cycle",
    ),
    "hole": (
        [(0, 0), (9, 0), (0, 9), (2, 2), (4, 2), (2, 4)],
        [(0, 1, 4), (0, 4, 3), (1, 2, 5), (1, 5, 4), (2, 0, 3), (2, 3, 5)],
        "not one cycle",
    ),
    "spiral": (
        # Eight triangles around vertex-free space that wind once and a bit: the ends overlap.
        [(2, 0), (0, 2), (-2, 0), (0, -2), (3, 0), (0, 3), (-3, 0), (0, -3), (2, 1), (3, 2)],
        [
            *((0, 4, 5), (0, 5, 1), (1, 5, 6), (1, 6, 2), (2, 6, 7), (2, 7, 3)),
            *((3, 7, 9), (3, 9, 8)),
        ],
        "meet",
    ),
}


@pytest.mark.parametrize(("points", "faces", "message"), BAD_SHEETS.values(), ids=BAD_SHEETS.keys())
def test_bad_sheet_is_refused(points, faces, message):
    exact = {k: (Fraction(x), Fraction(y)) for k, (x, y) in enumerate(points)}
    with pytest.raises(checker.CertificateError, match=message):
        checker.Sheet(exact, faces)


def test_sides_that_meet_are_found_as_by_comparing_all_pairs():
    """On random polygons of a small grid, many of them simple, many touching themselves."""
    rng = random.Random(1)
    seen = set()
    for _ in range(2000):
        count = rng.randint(3, 7)
        grid = [(Fraction(x), Fraction(y)) for x in range(4) for y in range(4)]
        sheet = checker.Sheet.__new__(checker.Sheet)
        sheet.points = dict(enumerate(rng.sample(grid, count)))
        sides = [(k, (k + 1) % count) for k in range(count)]
        simple = not any(sheet._meet(a, b) for a, b in combinations(sides, 2))
        seen.add(simple)
        try:
            sheet._check_simple(sides)
        except checker.CertificateError:
            assert not simple
        else:
            assert simple
    assert seen == {True, False}


def test_boundary_edges_on_one_line_need_not_meet():
    """A sheet shaped like a U: both tops lie on one line, apart from each other."""
    points = [(0, 0), (6, 0), (6, 5), (4, 5), (4, 2), (2, 2), (2, 5), (0, 5)]
    faces = [(0, 5, 7), (5, 6, 7), (0, 4, 5), (0, 1, 4), (1, 2, 4), (2, 3, 4)]
    sheet = checked_sheet(CreasePattern(points, faces))
    assert sheet.boundary == list(range(8))
    assert sheet.interior == []


def test_face_given_twice_is_refused():
    document = proof("dart")
    faces = document["pattern"]["triangles"]
    document["pattern"]["triangles"] = [*faces, [faces[0][1], faces[0][2], faces[0][0]]]
    with pytest.raises(checker.CertificateError, match="a face appears twice"):
        checker.check(document)


# --- evidence that proves nothing ----------------------------------------------------------------


def test_box_that_holds_two_roots_is_refused():
    """A box wide enough for both roots of one vertex cannot pass Krawczyk's test."""
    document = proof("single-vertex")
    for root in document["evidence"]["roots"]:
        root["radius"] = str(1 << (root["bits"] + 4))
    with pytest.raises(checker.CertificateError, match="Krawczyk's test fails"):
        checker.check(document)


def test_box_without_a_root_is_refused():
    document = proof("single-vertex")
    root = document["evidence"]["roots"][0]
    root["center"] = [str(int(root["center"][0]) + (1 << root["bits"] - 20))]
    with pytest.raises(checker.CertificateError, match="Krawczyk's test fails"):
        checker.check(document)


def test_point_box_is_refused():
    document = proof("single-vertex")
    document["evidence"]["roots"][0]["radius"] = "0"
    with pytest.raises(checker.CertificateError, match="radius is not positive"):
        checker.check(document)


def test_overlapping_boxes_are_refused():
    document = proof("single-vertex")
    document["evidence"]["roots"][1] = document["evidence"]["roots"][0]
    document["claims"]["branches"][1] = document["claims"]["branches"][0]
    with pytest.raises(checker.CertificateError, match="two boxes meet"):
        checker.check(document)


def test_indefinite_stress_is_refused():
    document = proof("triangle")
    entry = document["evidence"]["triangles"][0]
    entry["multipliers"] = [str(10 ** (9 * k)) for k in range(len(entry["inside"]))]
    with pytest.raises(checker.CertificateError, match="not definite"):
        checker.check(document)
    entry["multipliers"][0] = "-1"
    with pytest.raises(checker.CertificateError, match="a multiplier is not positive"):
        checker.check(document)


def test_open_notch_has_no_definite_stress():
    """theory: hub (0,0) of the dart has negative curvature form, whatever the multiplier."""
    sheet = checked_sheet(dart())
    with pytest.raises(checker.CertificateError, match="a stress is not definite"):
        checker.check_definite(sheet, [4], [Fraction(1)])


def test_finiteness_of_a_non_convex_sheet_closes_the_notch():
    sheet = checked_sheet(dart())
    closed = dart().with_notch_closed()
    assert len(closed.interior) == 2
    checker.check_finite(sheet, ["1", "1"])
    with pytest.raises(checker.CertificateError, match="has not 2 entries"):
        checker.check_finite(sheet, ["1"])


def test_triangle_that_is_not_one_is_refused():
    document = proof("rigid vertex")
    entry = document["evidence"]["triangles"][0]
    for corners in (entry["corners"][::-1], [0, 1, 2], [0, 0, 1]):
        changed = json.loads(json.dumps(document))
        changed["evidence"]["triangles"][0]["corners"] = corners
        with pytest.raises(checker.CertificateError):
            checker.check(changed)


def test_rigid_evidence_for_a_foldable_sheet_is_refused():
    document = proof("two-vertex")
    document["evidence"] = {"kind": "rigid", "triangles": []}
    with pytest.raises(checker.CertificateError, match="no triangulated triangle"):
        checker.check(document)


def test_single_vertex_evidence_for_degree_four_is_refused():
    document = proof("single-vertex")
    document["evidence"] = {"kind": "single vertex", "triangles": []}
    with pytest.raises(checker.CertificateError, match="degree 5 or more"):
        checker.check(document)


@pytest.mark.parametrize(
    ("points", "faces"),
    [
        # a hub of degree 4 with an ear: two planes of sheets, not one cone
        (
            [(0, 0), (4, 0), (4, 4), (0, 4), (6, 2), ("3/2", "7/5")],
            [*((k, (k + 1) % 4, 5) for k in range(4)), (1, 4, 2)],
        ),
        # a hub of degree 3 with two ears: one plane of sheets that counts twice
        (
            [(0, 0), (4, 0), (2, 4), (4, -3), (6, 3), (2, 1)],
            [(0, 1, 5), (1, 2, 5), (2, 0, 5), (0, 3, 1), (1, 4, 2)],
        ),
    ],
)
def test_single_vertex_evidence_for_a_hub_not_joined_to_all_corners_is_refused(points, faces):
    """With one interior vertex there are as many faces as corners, whatever the degree."""
    pattern = CreasePattern(points, faces)
    assert pattern.Vi == 1
    assert pattern.Ve == len(pattern.triangles) == 5
    document = proof("nine folds")
    corners = [[str(x), str(y)] for x, y in pattern.vertices]
    document["pattern"] = {"vertices": corners, "triangles": [list(t) for t in pattern.triangles]}
    document["claims"] |= {"boundary": 5, "folds": 5, "degrees_of_freedom": 2}
    document["claims"]["sha256"] = pattern.sha256
    with pytest.raises(checker.CertificateError, match="degree 5 or more"):
        checker.check(document)


def test_branch_lists_where_none_belong_are_refused():
    for name, message in (("triangle", "no branches"), ("nine folds", "not listed")):
        document = proof(name)
        document["claims"]["branches"] = [{"vertex_signs": "", "assignment": "", "multiplicity": 1}]
        with pytest.raises(checker.CertificateError, match=message):
            checker.check(document)


def test_true_branches_cannot_be_claimed_where_roots_are_multiple():
    document = proof("flat-vertex")
    assert document["claims"]["true_branches"] == "undecided"
    document["claims"]["true_branches"] = "proved"
    with pytest.raises(checker.CertificateError, match="claim true_branches"):
        checker.check(document)


def test_algebraic_evidence_for_simple_roots_is_accepted():
    """The engine of multiple roots proves simple ones as well; both kinds claim the same."""
    pattern = dart()
    chart = BranchSystem(pattern).chart
    proved = prove_algebraic(chart, groebner(chart.system).classes)
    roots = [(AlgebraicRoot(c, k), m) for c, k, m in proved.roots]
    branches, undecided = classify(pattern, chart, range(5), roots)
    assert undecided == []
    entries = [class_entry(proved, b.root.root_class, b.root.index) for b in branches]
    evidence = {
        "kind": "algebraic",
        "triangles": [],
        "chart": None,
        **algebraic_evidence(proved, entries, range(5)),
    }
    claims = proof("dart")["claims"]
    rest = {k: v for k, v in claims.items() if k not in ("interior", "boundary", "folds")}
    made = assemble(pattern, rest, evidence, {})
    assert checker.check(json.loads(json.dumps(made))) == claims


def test_chart_with_collinear_pins_is_refused() -> None:
    """Three pinned corners on a line would leave a rigid rotation, which is no branch."""
    sheet = [("0", "2"), ("-2", "0"), ("0", "0"), ("2", "0"), ("1/2", "1")]
    pattern = CreasePattern(sheet, [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)])
    forged = certificate(count_branches(pattern))
    forged["evidence"] = {**forged["evidence"], "chart": {"0": "1"}}
    with pytest.raises(checker.CertificateError, match="reflex"):
        checker.check(forged)


ZERO_SADDLE = [(2, -2), ("2/3", 0), (2, 2), (-2, 0), (0, 0)]


def test_branch_of_zero_saddle_may_be_shown_from_either_side() -> None:
    pattern = CreasePattern(ZERO_SADDLE, [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)])
    made = certificate(count_branches(pattern))
    shown = [branch["representative"] for branch in made["claims"]["branches"]]
    assert sorted(shown) == ["either", "saddle"]
    assert checker.check(made)["distinct"] == 2
    flip = str.maketrans("+-MV", "-+VM")
    for index, representative in enumerate(shown):
        mirrored = json.loads(json.dumps(made))
        branch = mirrored["claims"]["branches"][index]
        for key in ("vertex_signs", "assignment"):
            branch[key] = branch[key].translate(flip)
        if representative == "either":
            assert checker.check(mirrored)["distinct"] == 2
        else:
            with pytest.raises(checker.CertificateError, match="positive saddle"):
                checker.check(mirrored)
