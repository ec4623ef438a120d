"""Evidence that proves nothing is refused."""

import json
from fractions import Fraction

import pytest
from listed import checked_sheet, proof
from old_listing import assembled, old_listing
from sheets import (
    dart,
)

from exactfold import checker
from exactfold.branches import count_branches
from exactfold.branches.values.classify import classify
from exactfold.branches.values.roots import AlgebraicRoot
from exactfold.certificates.entries import algebraic_evidence, class_entry
from exactfold.checker.sheets import stress
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.rigidity.equations.branch_system import BranchSystem
from exactfold.rigidity.equations.problem import Problem
from exactfold.solve.algebraic.groebner_bases import groebner
from exactfold.solve.certify.algebraic import prove_algebraic


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
        stress.check_definite(sheet, [4], [Fraction(1)])


def test_finiteness_of_a_non_convex_sheet_closes_the_notch():
    sheet = checked_sheet(dart())
    closed = dart().with_notch_closed()
    assert len(closed.interior) == 2
    stress.check_finite(sheet, ["1", "1"])
    with pytest.raises(checker.CertificateError, match="does not have 2 entries"):
        stress.check_finite(sheet, ["1"])


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
    with pytest.raises(checker.CertificateError, match="not a triangulated triangle"):
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
    branches, undecided = classify(Problem.of(pattern), chart, roots)
    assert undecided == []
    entries = [class_entry(proved, b.root.root_class, b.root.index) for b in branches]
    evidence = {
        "kind": "algebraic",
        "triangles": [],
        "chart": None,
        **algebraic_evidence(proved, range(5)),
        "roots": entries,
    }
    claims = proof("dart")["claims"]
    rest = {k: v for k, v in claims.items() if k not in ("interior", "boundary", "folds")}
    made = assembled(pattern, rest, evidence, {})
    assert checker.check(json.loads(json.dumps(made))) == claims


def test_chart_with_collinear_pins_is_refused() -> None:
    """Three pinned corners on a line would leave a rigid rotation, which is no branch."""
    sheet = [("0", "2"), ("-2", "0"), ("0", "0"), ("2", "0"), ("1/2", "1")]
    pattern = CreasePattern(sheet, [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)])
    forged = old_listing(count_branches(pattern))
    forged["evidence"] = {**forged["evidence"], "chart": {"0": "1"}}
    with pytest.raises(checker.CertificateError, match="reflex"):
        checker.check(forged)


ZERO_SADDLE = [(2, -2), ("2/3", 0), (2, 2), (-2, 0), (0, 0)]


def test_branch_of_zero_saddle_may_be_shown_from_either_side() -> None:
    pattern = CreasePattern(ZERO_SADDLE, [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)])
    made = old_listing(count_branches(pattern))
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
