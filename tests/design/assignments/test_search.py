"""Which branches have given letters: compared with the list of all branches, and with itself."""

import random
from fractions import Fraction

import pytest
from sheets import dart, reflex_corners, scrambled

from exactfold import CreasePattern, random_square
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches import count_branches, find_branch
from exactfold.checker import check
from exactfold.design import Refutation, match
from exactfold.design.assignments import search
from exactfold.design.refutations.cone_program import ConeProgram
from exactfold.design.refutations.refutation import refuted_at
from exactfold.errors import UsageError
from exactfold.pattern import load
from exactfold.pattern.data import example_path
from exactfold.pattern.families import single_vertex
from exactfold.rigidity.curvature import curvature_form
from exactfold.rigidity.timelike import round_cone

NOTCHED = scrambled(3, reflex_corners(3), 5, loose=True)
TURNED = str.maketrans("+-MV", "-+VM")


def halves(pattern):
    """(signs, letters) of both halves of every branch, from the count."""
    for branch in count_branches(pattern).branches:
        signs = "".join("-0+"[s + 1] for _, s in sorted(branch.vertex_signs.items()))
        yield signs, dict(branch.assignment)
        turned = {fold: letter.translate(TURNED) for fold, letter in branch.assignment.items()}
        yield signs.translate(TURNED), turned


def agrees(letters, found):
    return all(wanted in ("U", found[fold]) for fold, wanted in letters.items())


def compared(pattern, letters):
    """The match, once it names what the count names, with refutations that hold."""
    found = match(pattern, letters)
    assert found.status is PROVED
    expected = sorted(
        (signs, sorted(own.items())) for signs, own in halves(pattern) if agrees(letters, own)
    )
    matched = [(half.sign_text, sorted(half.assignment.items())) for half in found.matches]
    assert sorted(matched) == expected
    own = {
        fold: letters[tuple(sorted(found.labels[v] for v in fold))] for fold in found.sheet.folds
    }
    assert all(refutation.holds(found.sheet, own) for refutation in found.refutations)
    return found


def loosened(letters, chance, rng, by="U"):
    return {fold: by if rng.random() < chance else letter for fold, letter in letters.items()}


@pytest.mark.parametrize("n", [1, 2, 3, 4, 5])
def test_matches_are_those_of_the_list_of_all_branches(n):
    pattern, rng = random_square(n, seed=20 + n), random.Random(n)
    for _, own in rng.sample(list(halves(pattern)), 2):
        compared(pattern, own)
        compared(pattern, loosened(own, 0.4, rng))
        fold = rng.choice(pattern.folds)
        compared(pattern, own | {fold: own[fold].translate(TURNED)})
        compared(pattern, own | {fold: "F"})


@pytest.mark.slow
@pytest.mark.parametrize("n", [4, 6])
@pytest.mark.parametrize("seed", range(2))
def test_letters_of_all_kinds_on_more_sheets(n, seed):
    pattern, rng = random_square(n, seed=100 + seed), random.Random(seed)
    for _, own in rng.sample(list(halves(pattern)), 2):
        for chance in (0.2, 0.7):
            loose = loosened(own, chance, rng)
            compared(pattern, loose)
            compared(pattern, loosened(loose, 0.1, rng, "F"))
            fold = rng.choice(pattern.folds)
            compared(pattern, loose | {fold: own[fold].translate(TURNED)})


@pytest.mark.parametrize("name", ["two-vertex", "single-vertex-4"])
def test_shipped_patterns(name):
    pattern = load(example_path(name))
    for _, own in halves(pattern):
        compared(pattern, own)


def test_a_vertex_that_stays_flat_is_matched_once():
    pattern = load(example_path("flat-vertex"))
    for _, own in halves(pattern):
        compared(pattern, own)
    assert "F" in {letter for _, own in halves(pattern) for letter in own.values()}


def test_all_letters_free_are_all_halves():
    pattern = random_square(3, seed=4)
    assert len(compared(pattern, dict.fromkeys(pattern.folds, "U")).matches) == 16


@pytest.mark.parametrize("n", [20, pytest.param(50, marks=pytest.mark.slow)])
def test_a_branch_is_found_by_its_letters(n):
    rng = random.Random(n)
    branch = find_branch(random_square(n, seed=1), "".join(rng.choice("+-") for _ in range(n)))
    found = match(branch.pattern, branch.assignment)
    assert found.status is PROVED
    assert (branch.sign_text, 1) in {half.names for half in found.matches}
    assert {half.names[0] for half in found.matches if half.side == 1} >= {branch.sign_text}
    turned = match(branch.pattern, branch.assignment_text.translate(TURNED))
    mirrored = {
        (signs.translate(TURNED), -side) for signs, side in (h.names for h in found.matches)
    }
    assert {half.names for half in turned.matches} == mirrored


def test_too_many_sign_vectors_are_undecided():
    pattern = random_square(3, seed=4)
    for most in (1, 2, 4):
        found = match(pattern, {}, most=most)
        assert found.status is UNDECIDED
        assert found.open_signs
        assert found.leaves <= most


@pytest.mark.parametrize("seed", range(40))
def test_a_wedge_that_is_linear_on_each_face_is_in_the_up_nappe(seed):
    """K = 0 where its line runs along spokes, else K > 0 (docs/assignment.md, The search)."""
    rng = random.Random(seed)
    circle = [(4, 0), (3, 2), (2, 3), (-1, 3), (-3, 2), (-4, 0), (-3, -2), (0, -5), (2, -3)]
    while True:
        spokes = sorted(rng.sample(range(9), rng.randint(3, 7)))
        d = [circle[k] for k in spokes]
        crosses = [a[0] * b[1] - a[1] * b[0] for a, b in zip(d, (*d[1:], d[0]), strict=True)]
        if min(crosses) > 0:
            break
    size = len(d)
    star = CreasePattern([*d, (0, 0)], [(k, (k + 1) % size, size) for k in range(size)])
    form, up = curvature_form(star, size), round_cone(star, size)
    normals = [(-y, x) for x, y in d] + [(rng.randint(-9, 9), rng.randint(1, 9)) for _ in range(9)]
    for nx, ny in normals:
        z = {k: Fraction(-max(nx * x + ny * y, 0)) for k, (x, y) in enumerate([*d, (0, 0)])}
        along = [any(nx * x + ny * y == 0 < s * (nx * y - ny * x) for x, y in d) for s in (1, -1)]
        assert form.polar(up, z) > 0
        assert form(z) == 0 if all(along) else form(z) > 0


def test_a_vertex_whose_folds_are_all_mountains():
    pattern = load(example_path("single-vertex-4"))
    found = compared(pattern, dict.fromkeys(pattern.folds, "M"))
    assert not found.matches
    assert found.reasons == (
        "vertex 4 cannot pop up: it has no valley, and a star of mountains alone is curved",
    )
    assert [dict(refutation.signs) for refutation in found.refutations] == [{4: -1}]


def filled():
    """A random square with a vertex in the middle of one face, by the numbers of its corners."""
    pattern = random_square(2, seed=3)
    first, *others = pattern.triangles
    corners = [pattern.vertices[v] for v in first]
    middle = tuple(sum(x) / 3 for x in zip(*corners, strict=True))
    new = len(pattern.vertices)
    a, b, c = first
    faces = [*others, (a, b, new), (b, c, new), (c, a, new)]
    return CreasePattern([*pattern.vertices, middle], faces), first, new


def test_a_letter_inside_a_triangulated_triangle():
    pattern, first, new = filled()
    for _, own in halves(pattern):
        compared(pattern, own)
    wanted = match(pattern, {(min(first), new): "M"})
    assert (wanted.status, wanted.matches) == (PROVED, ())
    assert wanted.reasons == (
        f"fold {(min(first), new)} lies in a triangulated triangle and stays flat",
    )


def test_reasons_name_vertices_of_the_pattern():
    """Also where a vertex before them lies in a triangulated triangle."""
    pattern = CreasePattern(
        [(0, 0), (10, 1), (11, 12), (-1, 9), (1, "14/3"), (4, 5)],
        [(0, 1, 5), (1, 2, 5), (2, 3, 5), (3, 0, 4), (0, 5, 4), (5, 3, 4)],
    )
    found = match(pattern, {fold: "M" for fold in pattern.folds if 4 not in fold})
    assert [reason.split(":")[0] for reason in found.reasons] == ["vertex 5 cannot pop up"]
    assert not found.matches


def test_lengths_beyond_floats_are_no_failure():
    pattern = random_square(2, seed=1)
    far = CreasePattern(
        [(x * 10**400, y * 10**400) for x, y in pattern.vertices], pattern.triangles
    )
    assert {half.names for half in match(far, {}).matches} == {
        half.names for half in match(pattern, {}).matches
    }


def test_a_sheet_with_a_reflex_corner():
    pattern = dart()
    for _, own in halves(pattern):
        compared(pattern, own)


@pytest.mark.parametrize("sheet", [random_square(5, seed=4), NOTCHED], ids=["square", "notched"])
def test_branches_that_are_found_together_are_those_found_one_by_one(sheet, monkeypatch):
    """Few letters leave many sign vectors."""
    letters = {sheet.folds[0]: "M", sheet.folds[-1]: "V"}
    together = compared(sheet, dict.fromkeys(sheet.folds, "U") | letters)
    monkeypatch.setattr(search, "_MANY", 1 << 20)
    alone = match(sheet, letters)
    assert together.leaves == alone.leaves > 8
    for (signs, rays), (others, other_rays) in zip(together.compared, alone.compared, strict=True):
        assert signs == others
        assert [(ray.names, ray.assignment) for ray in rays] == [
            (ray.names, ray.assignment) for ray in other_rays
        ]
    assert len(check(together.certificate())["halves"]) == len(alone.matches) > 0


@pytest.mark.parametrize(
    ("letters", "message"),
    [
        ("MV", "2 letters for 7 folds"),
        ("MVXMVMV", "fold (1, 5) has the letter 'X', not one of M, V, F, U"),
        ({(0, 1): "M"}, "(0, 1) is not a fold of the sheet"),
        ({(1, 5): 1}, "fold (1, 5) has the letter 1, not one of M, V, F, U"),
        (None, "letters have to be a text"),
    ],
)
def test_letters_that_do_not_fit(letters, message):
    with pytest.raises(UsageError) as caught:
        match(load(example_path("two-vertex")), letters)
    assert message in str(caught.value)


# --- forgeries: one for each condition -----------------------------------------------------------


def forged():
    """A sheet, letters and a refutation by a cone program with signs and affine stars."""
    branch = find_branch(random_square(20, seed=2), "+-" * 10)
    for fold in branch.pattern.folds:
        letters = branch.assignment | {fold: branch.assignment[fold].translate(TURNED)}
        found = match(branch.pattern, letters)
        for refutation in found.refutations:
            if 1 < len(refutation.signs) < 20:
                return found.sheet, dict(letters), refutation
    raise AssertionError


SHEET, LETTERS, TRUE = forged()


def test_the_refutation_that_is_forged_holds():
    assert TRUE.holds(SHEET, LETTERS)


def test_other_signs_are_refused():
    for v, sign in TRUE.signs.items():
        if any(TRUE.heights.get((v, w)) for w in SHEET.star(v)):
            assert not Refutation({**TRUE.signs, v: -sign}, TRUE.heights).holds(SHEET, LETTERS)


def test_names_that_are_none_are_refused():
    rim = SHEET.boundary[0]
    assert not Refutation({**TRUE.signs, rim: 1}, TRUE.heights).holds(SHEET, LETTERS)
    v = next(iter(TRUE.signs))
    assert not Refutation({**TRUE.signs, v: 2}, TRUE.heights).holds(SHEET, LETTERS)
    strange = {**TRUE.heights, (v, v): Fraction(1)}
    assert not Refutation(TRUE.signs, strange).holds(SHEET, LETTERS)


def test_a_star_outside_of_its_nappe_is_refused():
    for v in TRUE.signs:
        flat = {key: z for key, z in TRUE.heights.items() if key[0] != v}
        w = SHEET.star(v)[0]
        bent = {**flat, (v, w): Fraction(1, 10**9)}  # one fold alone: K_v < 0 at a convex corner
        if not Refutation(TRUE.signs, bent)._is_placed(SHEET, v):
            assert not Refutation(TRUE.signs, bent).holds(SHEET, LETTERS)
            return
    raise AssertionError


def test_a_star_without_a_sign_has_to_be_affine():
    v = next(v for v in SHEET.interior if v not in TRUE.signs)
    w = SHEET.star(v)[0]
    moved = {**TRUE.heights, (v, w): TRUE.heights.get((v, w), Fraction(0)) + Fraction(1, 1 << 60)}
    assert not Refutation(TRUE.signs, moved).holds(SHEET, LETTERS)


def test_sums_on_the_wrong_side_and_sums_that_are_all_zero_are_refused():
    assert not Refutation(TRUE.signs, {}).holds(SHEET, LETTERS)
    for fold in SHEET.folds[::5]:
        total = sum(TRUE.heights.get(pair, Fraction(0)) for pair in (fold, fold[::-1]))
        assert TRUE.holds(SHEET, LETTERS | {fold: "F"})
        if total:
            for wrong in (LETTERS[fold].translate(TURNED), "U"):
                assert not TRUE.holds(SHEET, LETTERS | {fold: wrong})


def test_heights_that_are_no_rational_numbers_refute_nothing():
    """The form of floats this small is 0, in floats; here it would refute a branch."""
    pattern = single_vertex(4)
    letters = dict.fromkeys(pattern.folds, "V") | {(0, 4): "M"}
    assert "-" in {half.sign_text for half in match(pattern, letters).matches}
    for height in (Fraction(1, 10**200), 1e-200):
        assert not Refutation({4: -1}, {(4, 0): height}).holds(pattern, letters)


def test_flat_folds_alone_refute_nothing():
    assert not TRUE.holds(SHEET, dict.fromkeys(SHEET.folds, "F"))


# --- any boundary: solutions with given rims are never refuted ------------------------------------


@pytest.mark.parametrize("corners", [5, 6, 7])
def test_letters_of_a_rim_are_not_refuted(corners):
    pattern, rng = single_vertex(corners), random.Random(corners)
    (hub,) = pattern.interior
    refuted = 0
    for sign in (1, -1):
        for _ in range(8):
            rim = {v: Fraction(rng.randint(-50, 50)) for v in pattern.boundary}
            branch = find_branch(pattern, {hub: sign}, boundary_heights=rim)
            assert branch.status is PROVED
            letters = dict(branch.assignment)
            program = ConeProgram(pattern, letters)
            assert refuted_at(pattern, letters, hub, sign) is None
            assert program.refutation({hub: sign}) is None
            assert program.refutation({}) is None
            other = refuted_at(pattern, letters, hub, -sign)
            refuted += isinstance(other, Refutation) and other.holds(pattern, letters)
    assert refuted
