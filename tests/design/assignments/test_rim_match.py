"""Sheets with more than four corners: a rim whose branch has given letters, or why none has."""

import json
import random

import pytest
from jsonschema import Draft202012Validator
from running import run
from sheets import wheel

from exactfold import CreasePattern, checker, delaunay
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED
from exactfold.app.schemas import schema
from exactfold.branches import find_branch
from exactfold.design import all_assignments, match_boundary, match_certificate, match_panels
from exactfold.design.assignments.bend_program import BendProgram
from exactfold.design.refutations.cone_program import ConeProgram
from exactfold.design.refutations.refutation import Refutation
from exactfold.errors import NotApplicableError, NotCountedError, UsageError
from exactfold.pattern import write_fold
from exactfold.pattern.families import single_vertex
from exactfold.pattern.triangulating.random_squares import random_square

TURNED = {"M": "V", "V": "M"}
CORNERS = [(0, 0), (10, -3), (16, 5), (9, 14), (-2, 9)]
PENTAGON = delaunay([*CORNERS, (5, 4), (8, 7)])
SEVEN = delaunay(
    [*CORNERS[:2], (15, 1), *CORNERS[2:], (-3, 4), (5, 2), (3, 7), (9, 3), (11, 8), (6, 10)]
)
SQUARE = wheel([(0, 0), (4, 0), (4, 4), (0, 4)], (1, 2))
FLAP = CreasePattern([*SQUARE.vertices, (7, 2)], [*SQUARE.triangles, (1, 5, 2)])
"""A vertex, and a fold from boundary to boundary, 1-2, with a triangle behind it."""
RIM = [(4, -4), ("1/10", 0), (4, 4), (-4, 4), (-4, -4)]
DENTED = CreasePattern([*RIM, (0, 0)], [(k, (k + 1) % 5, 5) for k in range(5)])


def checked(found):
    """What the checker says of the certificate of a match."""
    return checker.check(match_certificate(found))


def compared(pattern, letters, occurs):
    """The answer, once it is that of the list, and its certificate is verified."""
    found = match_boundary(pattern, letters)
    assert found.starts is (PROVED if occurs else REFUTED)
    if occurs:
        assert found.branch.assignment_text == letters
        assert checked(found)["assignment"] == letters
    elif not found.listed:
        claims = checked(found)
        assert (claims["letters"], claims["halves"]) == (letters, [])
        own = dict(zip(pattern.folds, letters, strict=True))
        assert all(refutation.holds(found.sheet, own) for refutation in found.refutations)
    return found


def with_flips(letters, rng):
    """Letters, and some of those that differ at one fold."""
    yield letters
    for k in rng.sample(range(len(letters)), 3):
        yield letters[:k] + TURNED[letters[k]] + letters[k + 1 :]


def test_the_answers_are_those_of_the_list_of_all_assignments():
    occurring, rng = set(all_assignments(PENTAGON).assignments), random.Random(1)
    for letters in with_flips(rng.choice(sorted(occurring)), rng):
        compared(PENTAGON, letters, letters in occurring)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2])
def test_the_answers_are_those_of_longer_lists(seed):
    rng = random.Random(seed)
    inside = [(rng.randint(2, 12), rng.randint(1, 9)) for _ in range(3)]
    pattern = delaunay([*CORNERS, *inside])
    occurring = set(all_assignments(pattern).assignments)
    for own in rng.sample(sorted(occurring), 6):
        for letters in with_flips(own, rng):
            compared(pattern, letters, letters in occurring)


@pytest.mark.slow
def test_what_no_cone_program_refutes_is_looked_up_in_the_list():
    pattern, letters = delaunay([*CORNERS, (2, 3), (7, 2), (8, 8)]), "VVMVVVVVMVM"
    assert letters not in all_assignments(pattern).assignments
    found = match_boundary(pattern, letters)
    assert (found.starts, found.listed, found.leaves, found.open_signs) == (REFUTED, True, 1, ())
    claims = checker.check(match_certificate(found))
    assert letters not in claims["assignments"]
    assert len(claims["assignments"]) == len(all_assignments(pattern).assignments)


@pytest.mark.slow
def test_letters_of_a_branch_and_what_differs_at_one_fold():
    rng = random.Random(2)
    signs = {v: rng.choice((1, -1)) for v in SEVEN.interior}
    branch = find_branch(
        SEVEN, signs, boundary_heights={v: rng.randint(-9, 9) for v in SEVEN.boundary}
    )
    assert SEVEN.D == 4
    own = dict(branch.assignment)
    found = compared(SEVEN, branch.assignment_text, True)
    assert set(found.branch.boundary_heights) == set(SEVEN.boundary)
    for fold in rng.sample(SEVEN.folds, 6):
        flipped = match_boundary(SEVEN, {**own, fold: TURNED[own[fold]]})
        if flipped.status is PROVED:
            checked(flipped)
    free = {fold: x for fold, x in own.items() if rng.random() < 0.6}
    assert match_boundary(SEVEN, free).starts is PROVED


def test_letters_of_a_fold_from_border_to_border():
    """It bends as it likes, and the vertex on its one side is refuted as without it."""
    assert FLAP.folds[1] == (1, 2)
    for letters, occurs in (("MVM", True), ("VVV", False)):
        for chord in "MV":
            text = f"M{chord}{letters}"
            found = compared(FLAP, text, occurs)
            assert match_panels(FLAP, text).starts is found.starts
    own = dict(zip(FLAP.folds, "MVMMM", strict=True))
    assert isinstance(BendProgram(FLAP, own).solved({4: -1}), Refutation)


def test_programs_in_bends_refute_what_is_possible_elsewhere():
    """Bends on other vertices do not matter, and in `ConeProgram` they do."""
    two = delaunay([(0, 0), (8, 0), (8, 6), (0, 6), (4, 9), (3, 3), (5, 2), (4, 5)])
    branch = find_branch(two, dict.fromkeys(two.interior, 1))
    v = two.interior[0]
    own = dict(branch.assignment)
    other = dict.fromkeys(two.interior, 1) | {v: -1}
    found = BendProgram(two, own).solved(other)
    assert isinstance(found, Refutation)
    assert found.holds(two, own)
    assert set(found.signs.items()) <= set(other.items())
    assert not isinstance(ConeProgram(two, own).solved(other), Refutation)


def test_a_border_that_is_not_convex_is_refuted_or_open():
    answers = {letters: match_boundary(DENTED, letters) for letters in ("MMMMM", "MMMVV", "MMVMM")}
    assert [found.starts for found in answers.values()] == [REFUTED, REFUTED, UNDECIDED]
    for found in answers.values():
        assert found.branch is None
        if found.starts is REFUTED:
            checked(found)
        else:
            assert found.open_signs
            with pytest.raises(NotApplicableError, match="undecided"):
                match_certificate(found)


def test_folds_that_stay_flat():
    """No rim is looked for: over rational rims folds are flat by chance only."""
    sheet = single_vertex(5)
    assert match_boundary(sheet, "FMMVM").starts is UNDECIDED
    assert checked(match_boundary(sheet, "FFFMV"))["letters"] == "FFFMV"


def test_how_many_sign_vectors_are_tried():
    letters = {SEVEN.folds[0]: "F", SEVEN.folds[1]: "M"}
    for most in (1, 3):
        found = match_boundary(SEVEN, letters, most=most)
        assert found.starts is UNDECIDED
        assert found.leaves <= most < len(found.open_signs) + 2


def test_what_is_refused():
    with pytest.raises(NotCountedError, match="this sheet has 4"):
        match_boundary(random_square(2, seed=1), {})
    with pytest.raises(UsageError, match="1 letters for 5 folds"):
        match_boundary(single_vertex(5), "M")
    with pytest.raises(NotCountedError, match="no vertex of this sheet can pop"):
        match_boundary(CreasePattern(CORNERS, [(0, 1, 2), (0, 2, 3), (0, 3, 4)]), {})


def test_the_command(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_fold(PENTAGON, "p.fold")
    occurring = sorted(all_assignments(PENTAGON).assignments)
    yes = run("match", "p.fold", "--letters", occurring[0], "--json", "--certificate", "c.json")
    data = json.loads(yes.stdout)
    Draft202012Validator(schema("starting")).validate(data)
    assert (yes.exit_code, data["starts"], data["truly"], data["ways"]) == (
        0,
        "proved",
        "proved",
        1,
    )
    (match,) = data["matches"]
    signs = "".join("-0+"[s + 1] for s in match["vertex_signs"].values())
    branch = find_branch(
        PENTAGON, signs, boundary_heights={int(v): h for v, h in match["rim"].items()}
    )
    assert branch.assignment_text == occurring[0] == "".join(match["assignment"].values())
    assert run("check", "c.json").exit_code == 0
    no = run("match", "p.fold", "--letters", "M" * 8, "--json", "--certificate", "d.json")
    data = json.loads(no.stdout)
    Draft202012Validator(schema("starting")).validate(data)
    assert (no.exit_code, data["starts"], data["matches"], data["ways"]) == (1, "refuted", [], 0)
    assert data["vertices"] == [5, 6]
    assert "can pop neither up" in data["reasons"][0]
    assert "no branch has the 8 letters" in run("check", "d.json").stdout
    assert run("match", "p.fold", "--letters", "0-5=F", "--certificate", "e.json").exit_code == 0
    assert run("check", "e.json").exit_code == 0  # a motion of rigid panels
