"""The formal proof: nothing is left out of it, its page names what is there, and it builds."""

import json
import re
import subprocess
from contextlib import suppress
from fractions import Fraction
from itertools import product
from pathlib import Path
from typing import Any

import pytest

from exactfold.branches import branch_certificate, find_branch, find_branches
from exactfold.errors import NotApplicableError, NotCountedError
from exactfold.interop import branch_to_coq, branches_to_coq, to_coq
from exactfold.pattern import load
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.data import EXAMPLES, example_path
from exactfold.pattern.opening import open_pattern, triangles
from exactfold.pattern.triangulating.random_squares import random_square
from exactfold.rigidity.curvature import curvature_form

ROOT = Path(__file__).parent.parent.parent
FORMAL = ROOT / "proofs" / "formal"
CERTIFICATES = ROOT / "tests" / "fixtures" / "certificates"
SOURCES = {path.name: path.read_text(encoding="utf-8") for path in sorted(FORMAL.glob("*.v"))}

REALS = {
    "ClassicalDedekindReals.sig_forall_dec",
    "FunctionalExtensionality.functional_extensionality_dep",
}
CLASSICAL = REALS | {"ClassicalDedekindReals.sig_not_dec", "Classical_Prop.classic"}
ASSUMED = {
    "key_lemma": REALS,
    "one_solution_per_sign_vector": CLASSICAL,
    "all_real": REALS,
    "exactly_2_to_the_n": CLASSICAL,
    "distance": REALS | {"ClassicalDedekindReals.sig_not_dec"},
    "branches": CLASSICAL,
    "krawczyk": REALS | {"ClassicalDedekindReals.sig_not_dec"},
    "certified": CLASSICAL,
    "counted": CLASSICAL,
    "all_verified": CLASSICAL,
    "one_verified": CLASSICAL,
    "distance_verified": CLASSICAL,
    "all_notched_verified": CLASSICAL,
    "one_notched_verified": CLASSICAL,
    "chart_verified": REALS | {"ClassicalDedekindReals.sig_not_dec"},
    "emptied_verified": REALS,
    "all_emptied_verified": CLASSICAL,
    "all_notched_emptied_verified": CLASSICAL,
    "exact_verified": CLASSICAL,
    "exact_notched_verified": CLASSICAL,
    "listed_verified": CLASSICAL,
    "reflex_verified": CLASSICAL,
    "disk_moves": REALS,
    "curve": REALS | {"ClassicalDedekindReals.sig_not_dec"},
    "motion": REALS | {"ClassicalDedekindReals.sig_not_dec"},
    "true_motion_exists": REALS | {"ClassicalDedekindReals.sig_not_dec"},
    "ways": CLASSICAL,
    "near_flat": CLASSICAL,
    "all_continue": CLASSICAL,
    "one_continues": CLASSICAL,
    "exact_continues": CLASSICAL,
    "others": CLASSICAL,
}
"""What each theorem rests on: axioms of Coq's real numbers, as docs/formal.md lists them."""


def without_comments(text: str) -> str:
    """A source without its comments, which are not nested."""
    return re.sub(r"\(\*.*?\*\)", "", text, flags=re.DOTALL)


def declared(text: str) -> set[str]:
    """The names that a source defines or proves."""
    kinds = "Theorem|Lemma|Corollary|Definition|Fixpoint|Record"
    return set(re.findall(rf"^(?:{kinds}) (\w+)", without_comments(text), flags=re.MULTILINE))


def test_no_proof_is_left_open() -> None:
    words = r"\b(Admitted|admit|Abort|Axiom|Parameter|Conjecture|give_up|Unset Guard Checking)\b"
    open_ends = {
        name: found
        for name, text in SOURCES.items()
        if (found := re.findall(words, without_comments(text)))
    }
    assert open_ends == {}


def test_every_source_is_built() -> None:
    listed = (FORMAL / "_CoqProject").read_text(encoding="utf-8").split()
    assert sorted(name for name in listed if name.endswith(".v")) == list(SOURCES)


def test_the_page_names_what_is_there() -> None:
    page = (ROOT / "docs" / "formal.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| .* \| ([^|]*) \| ([^|]*) \|$", page, flags=re.MULTILINE)[1:]
    assert len(rows) > 25
    for names, files in rows:
        there = set[str]().union(
            *(declared(SOURCES[file]) for file in re.findall(r"`(.*?)`", files))
        )
        assert set(re.findall(r"`(\w+)`", names)) <= there
    for axiom in CLASSICAL:
        assert f"`{axiom.rpartition('.')[2]}`" in page


def test_the_assumptions_of_every_theorem_are_printed() -> None:
    text = SOURCES["Assumptions.v"]
    assert re.findall(r"^Print Assumptions (\w+)\.", text, flags=re.MULTILINE) == list(ASSUMED)
    theorems = {
        name
        for source in SOURCES.values()
        for name in re.findall(r"^Theorem (\w+)", without_comments(source), flags=re.MULTILINE)
    }
    assert len(theorems) > 20
    assert theorems - set(re.findall(r"\w+", without_comments(text))) == set()


def test_the_example_is_what_is_written_of_a_pattern() -> None:
    assert to_coq("two-vertex") == SOURCES["Example.v"]


TENT = CreasePattern(
    [(0, 0), (1, 0), (2, 0), (1, 3), (1, 1)], [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]
)
SMALL = (
    TENT,
    CreasePattern([(0, 0), (3, 0), (0, 3), (1, 1)], [(0, 1, 3), (1, 2, 3), (2, 0, 3)]),
    CreasePattern([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1, 2), (0, 2, 3)]),
)
"""A straight corner; three corners; no interior vertex."""


def test_a_straight_corner_is_not_among_the_first_three_of_the_border() -> None:
    assert "border := [1; 2; 3; 0];" in to_coq(TENT)


def test_a_reflex_corner_is_refused() -> None:
    dart = CreasePattern([(0, 0), (4, -4), (1, 0), (4, 4)], [(0, 1, 2), (0, 2, 3)])
    with pytest.raises(NotApplicableError, match="vertex 2 is reflex"):
        to_coq(dart)


def kept(name: str) -> dict[str, Any]:
    """A certificate of the fixtures."""
    found: dict[str, Any] = json.loads((CERTIFICATES / f"branch-{name}.json").read_text("utf-8"))
    return found


def test_the_example_of_a_branch_is_what_is_written_of_a_certificate() -> None:
    assert branch_to_coq(kept("rim")) == SOURCES["BranchExample.v"]


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("dart", "vertex 1 is reflex"),
        ("triangles", "triangulated triangles"),
        ("deficits", "angle deficits"),
        ("hypar-exact", "but vertex 4 has none"),
        ("flat-vertex", "vertex 5 may be flat"),
    ],
)
def test_certificates_that_the_proof_is_not_about(name: str, why: str) -> None:
    with pytest.raises(NotApplicableError, match=why):
        branch_to_coq(kept(name))


def test_a_sign_vector_without_a_certificate_is_named() -> None:
    found = [branch_certificate(find_branch("two-vertex", signs)) for signs in ("++", "-+", "--")]
    with pytest.raises(NotApplicableError, match=r"the branch with the signs \+-"):
        branches_to_coq(found)
    with pytest.raises(NotApplicableError, match="give at least one"):
        branches_to_coq([])


FORGED = """
Definition forged (c : certificate) : list certificate := [
  Certificate (map (fun _ => 0%Q) (near c)) (ups c) (cones c) (centre c) (radius2 c) (distance2 c)
    (letters c);
  Certificate (near c) [] (cones c) (centre c) (radius2 c) (distance2 c) (letters c);
  Certificate (near c) (ups c) (cones c) (centre c) (radius2 c) 0%Q (letters c);
  Certificate (near c) (ups c) (cones c) (centre c) (radius2 c) (distance2 c)
    (map (fun f => let '(i, j, l, m, valley) := f in (i, j, l, m, negb valley)) (letters c))
].
Lemma refused :
  forallb (fun c => negb (check_branch sheet_drawing c)) (forged branch_1) = true.
Proof. vm_compute. reflexivity. Qed.
"""
"""Curvature 0, other signs, a distance too small, reversed letters."""


BOXES = """
From Coq Require Import List QArith Qabs.
From Exactfold Require Import Drawing Rational Boxes.
Import ListNotations.
Definition box_about (x r : Q) : box :=
  Box [1; 0; 0; 0; x]%Q r [[]; []; []; []; [0; 0; 0; 0; {Y}]]%Q ({F} * (x - (1 # 2)) ^ 2 + {G} *
    Qabs.Qabs (x - (1 # 2)))%Q ({F} * 2 * Qabs.Qabs (x - (1 # 2)))%Q {F}.
Lemma one_branch_in_a_box :
  map (check_box Sheet{k}.sheet_drawing) [box_about (501 # 1000) (1 # 100);
    box_about (501 # 1000) (1 # 2000); box_about (7 # 10) (1 # 100); box_about (1 # 2) 1] =
  [true; false; false; false].
Proof. vm_compute. reflexivity. Qed.
"""


def boxes(place: int) -> str:
    """Boxes with and without the branch of `single-vertex-4` at which the vertex has height 1/2.

    Not held: the branch is outside, or far, or the box is so large that it holds two of them.
    """
    pattern = load("single-vertex-4")
    form, unit = curvature_form(pattern, 4), Fraction(1, pattern.integer_vertices[1] ** 2)
    at, up = (
        {0: Fraction(1), 1: Fraction(0), 2: Fraction(0), 3: Fraction(0), 4: Fraction(1, 2)},
        {0: Fraction(0), 1: Fraction(0), 2: Fraction(0), 3: Fraction(0), 4: Fraction(1)},
    )
    assert form(at) == 0
    slope, bend = 2 * form.polar(at, up), 2 * form(up)
    inverse, ratio = 1 / (slope * unit), abs(bend / slope)
    words = {"Y": inverse, "F": ratio, "G": Fraction(1)}
    return BOXES.format(
        k=place, **{name: f"({x.numerator} # {x.denominator})%Q" for name, x in words.items()}
    )


def in_scope() -> dict[str, CreasePattern]:
    """The shipped patterns that are triangulated, with rational coordinates."""
    found = {}
    for name in EXAMPLES:
        with suppress(NotCountedError):
            found[name] = triangles(open_pattern(example_path(name)), "the proof")
    return found


def test_the_page_names_the_shipped_patterns_that_it_is_about() -> None:
    patterns = in_scope()
    assert all(pattern.is_convex for pattern in patterns.values())
    page = (ROOT / "docs" / "formal.md").read_text(encoding="utf-8")
    scope = r"The shipped patterns (.*?) are,\s.*Not in scope are (.*?),\s+which"
    found = re.search(scope, page, re.DOTALL)
    assert found is not None
    assert re.findall(r"`(.*?)`", found[1]) == [n for n in EXAMPLES if n in patterns]
    assert re.findall(r"`(.*?)`", found[2]) == [n for n in EXAMPLES if n not in patterns]


def test_an_exported_sheet_has_no_hypothesis_that_may_be_false_of_it() -> None:
    """On `flat-vertex` and `flat-octahedron` some star is flat: "exactly 2^n if none is" is empty.

    What is assumed is what can be chosen freely: boundary heights, curvatures above 0.
    """
    for name, pattern in in_scope().items():
        text = without_comments(to_coq(pattern))
        assert "flat_star" not in text, name
        theorems = re.findall(r"(?ms)^Theorem (\w+)(.*?)^Proof", text)
        assert [x for x, _ in theorems][:1] == ["shapes"]
        assert not any("forall h" in stated.split("exists")[0] for _, stated in theorems)


def test_exactly_as_many_branches_are_not_claimed_where_a_star_is_flat() -> None:
    """Those of the shipped sheets with at most 16 sign vectors that have fewer branches."""
    refused = {}
    for name, pattern in in_scope().items():
        if pattern.Ve == 4 and pattern.Vi <= 4:
            signs = map("".join, product("+-", repeat=pattern.Vi))
            found = [branch_certificate(branch) for branch in find_branches(pattern, signs)]
            try:
                assert "Theorem exactly_counted" in branches_to_coq(found)
            except NotApplicableError as error:
                refused[name] = str(error)
    assert list(refused) == ["flat-vertex"]
    assert refused["flat-vertex"].startswith("vertex 5 is flat on the branch with the signs +0: ")


def test_the_lines_of_an_exported_sheet_are_short() -> None:
    text = to_coq(random_square(20, seed=1))
    assert max(map(len, text.splitlines())) <= 100
    assert "\0" not in text


def test_the_lines_of_the_sources_are_short() -> None:
    assert max(len(line) for text in SOURCES.values() for line in text.splitlines()) <= 120


@pytest.mark.slow
def test_it_builds_and_assumes_no_more_than_the_reals(formal: Path) -> None:
    log = (formal / "make.log").read_text(encoding="utf-8")
    printed = log.split("COQC Assumptions.v", 1)[1].split("make", 1)[0]
    blocks = printed.split("Axioms:\n")[1:]
    axioms = [set(re.findall(r"^([\w.]+)(?= :|$)", block, flags=re.MULTILINE)) for block in blocks]
    assert dict(zip(ASSUMED, axioms, strict=True)) == ASSUMED
    sheets = [*in_scope().values(), random_square(20, seed=1), *SMALL]
    exported = [
        f"Module Sheet{k}.\n{to_coq(sheet)}\nEnd Sheet{k}.\n" for k, sheet in enumerate(sheets)
    ]
    every = [find_branch("two-vertex", signs) for signs in ("++", "+-", "-+", "--")]
    exported += [branches_to_coq([branch_certificate(branch) for branch in every]), FORGED]
    exported.append(boxes(list(in_scope()).index("single-vertex-4")))
    (formal / "Exported.v").write_text("".join(exported), encoding="utf-8")
    verified = subprocess.run(
        ["coqc", "-Q", ".", "Exactfold", "Exported.v"],
        cwd=formal,
        capture_output=True,
        text=True,
        check=False,
    )
    assert verified.returncode == 0, verified.stderr[-2000:]
