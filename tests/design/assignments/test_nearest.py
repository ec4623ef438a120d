"""The branches nearest to letters: compared with all branches, by code that knows no refutation."""

import random
from dataclasses import replace

import pytest
from sheets import dart

from exactfold import CreasePattern, random_square
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches import count_branches, find_branch
from exactfold.design import MatchedRay, match, nearest_branches, vertex_conflicts
from exactfold.design.assignments import nearest
from exactfold.design.assignments.conflicts import Clause, Stars, to_blame
from exactfold.pattern import load
from exactfold.pattern.data import example_path
from exactfold.pattern.families import single_vertex

TURNED = str.maketrans("MV", "VM")


def halves(pattern):
    """The letters of both halves of every branch, by their text."""
    for branch in count_branches(pattern).branches:
        yield dict(branch.assignment)
        yield {fold: letter.translate(TURNED) for fold, letter in branch.assignment.items()}


def far(wanted, own):
    return sum(letter not in ("U", own[fold]) for fold, letter in wanted.items())


def text(letters):
    return "".join(letter for _, letter in sorted(letters.items()))


def changed(pattern, number, rng):
    """The letters of a half of a branch with some turned over, some flat, some free."""
    own = rng.choice(list(halves(pattern)))
    for fold in rng.sample(pattern.folds, number):
        own[fold] = rng.choice([own[fold].translate(TURNED), own[fold].translate(TURNED), "F"])
    for fold in rng.sample(pattern.folds, 2):
        own[fold] = "U"
    return own


def compared(pattern, letters):
    """What is found, once it does not contradict the list of all branches."""
    near = nearest_branches(match(pattern, letters))
    known = [(far(letters, own), text(own)) for own in halves(pattern)]
    least = min(distance for distance, _ in known)
    assert near.at_least <= least <= near.distance
    if near.status is PROVED:
        assert near.distance == least
    expected = sorted(letters for distance, letters in known if distance == near.distance)
    found = sorted(text(ray.assignment) for ray in near.rays)
    assert found == expected if near.complete else set(found) <= set(expected)
    for ray in near.rays:
        other = near.differences(ray)
        assert len(other) == near.distance
        assert all(wanted == letters[fold] != actual for fold, (wanted, actual) in other.items())
        assert all(actual == ray.assignment[fold] for fold, (_, actual) in other.items())
    return near


@pytest.fixture
def unlisted(monkeypatch):
    monkeypatch.setattr(nearest, "LISTED", 0)


SHEETS = {
    "single": lambda: load(example_path("single-vertex-4")),
    "two": lambda: load(example_path("two-vertex")),
    "flat": lambda: load(example_path("flat-vertex")),
    "dart": dart,
    "square": lambda: random_square(3, seed=2),
}


@pytest.mark.parametrize("name", SHEETS)
def test_the_nearest_by_the_list(name):
    rng, pattern = random.Random(name), SHEETS[name]()
    near = compared(pattern, changed(pattern, 2, rng))
    assert (near.status, near.complete) == (PROVED, True)


@pytest.mark.usefixtures("unlisted")
@pytest.mark.parametrize(
    "name", [pytest.param(x, marks=pytest.mark.slow) if x == "square" else x for x in SHEETS]
)
def test_the_nearest_by_search(name):
    rng, pattern = random.Random(name), SHEETS[name]()
    near = compared(pattern, changed(pattern, 1, rng))
    assert near.status is PROVED
    assert near.by == ("search" if name in ("single", "square") else "match")
    compared(pattern, {fold: rng.choice("MV") for fold in pattern.folds})


@pytest.mark.survey
@pytest.mark.usefixtures("unlisted")
@pytest.mark.parametrize("seed", range(3))
def test_the_nearest_by_search_on_larger_sheets(seed):
    rng, pattern = random.Random(seed), random_square(7, seed=seed)
    for number in (1, 2, 3):
        assert compared(pattern, changed(pattern, number, rng)).status is PROVED
    compared(pattern, {fold: rng.choice("MVFU") for fold in pattern.folds})


@pytest.mark.survey
@pytest.mark.parametrize("n", [20, 50])
def test_one_or_two_letters_of_a_large_sheet_are_corrected(n):
    rng = random.Random(n)
    branch = find_branch(random_square(n, seed=1), "".join(rng.choice("+-") for _ in range(n)))
    letters = dict(branch.assignment)
    folds = rng.sample(branch.pattern.folds, 2)
    for number, fold in enumerate(folds, 1):
        letters[fold] = letters[fold].translate(TURNED)
        found = match(branch.pattern, letters)
        assert not found.matches
        near = nearest_branches(found)
        assert (near.status, near.distance, near.by) == (PROVED, number, "search")
        assert branch.sign_text in {ray.sign_text for ray in near.rays}


def test_letters_of_a_branch_are_their_own_nearest():
    found = match("two-vertex", "MVVVMVM")
    near = nearest_branches(found)
    assert (near.distance, near.status, near.complete, near.by) == (0, PROVED, True, "match")
    assert near.rays == found.matches


@pytest.mark.usefixtures("unlisted")
def test_without_a_try_little_is_proved():
    pattern, rng = random_square(5, seed=2), random.Random(4)
    letters = {fold: rng.choice("MV") for fold in pattern.folds}
    found = match(pattern, letters)
    assert not found.matches
    near = nearest_branches(found, tries=0)
    assert not near.complete
    least = min(far(letters, own) for own in halves(pattern))
    assert near.at_least <= least <= near.distance
    assert near.status is (PROVED if near.at_least == near.distance else UNDECIDED)
    assert near.at_least < least


@pytest.mark.usefixtures("unlisted")
def test_letters_that_are_not_known_prove_nothing():
    """With a half that may be nearer, no other is proved to be the nearest."""
    pattern = load(example_path("single-vertex-4"))
    wanted = dict.fromkeys(pattern.folds[:1], "F")
    found = match(pattern, wanted)
    assert nearest_branches(found).status is PROVED
    (signs, pair), *others = found.compared
    unknown = replace(pair[0].branch, assignment=dict.fromkeys(pattern.folds, "U"))
    doubtful = (signs, (MatchedRay(unknown, 1), pair[1]))
    near = nearest_branches(replace(found, compared=(doubtful, *others)))
    assert (near.status, near.at_least, near.complete) == (UNDECIDED, 0, False)
    assert near.distance == 1


def test_a_fold_inside_a_triangulated_triangle_always_differs(unlisted):
    pattern = random_square(2, seed=3)
    first, *others = pattern.triangles
    corners = [pattern.vertices[v] for v in first]
    new, (a, b, c) = len(pattern.vertices), first
    filled = CreasePattern(
        [*pattern.vertices, tuple(sum(x) / 3 for x in zip(*corners, strict=True))],
        [*others, (a, b, new), (b, c, new), (c, a, new)],
    )
    own = next(halves(filled))
    near = compared(filled, own | {(min(first), new): "M"})
    assert (near.status, near.distance, near.complete) == (PROVED, 1, True)


@pytest.mark.parametrize("seed", range(2))
def test_every_branch_differs_at_a_fold_of_each_conflict(seed):
    pattern, rng = random_square(5, seed=seed), random.Random(seed)
    known = list(halves(pattern))
    met = 0
    for _ in range(6):
        letters = {fold: rng.choice("MMMVVVUF") for fold in pattern.folds}
        freed = frozenset(rng.sample(pattern.folds, 2))
        stars = Stars(pattern, letters, range(len(pattern.vertices)))
        for folds in stars.conflicts(freed).values():
            met += 1
            assert folds.isdisjoint(freed)
            for own in known:
                assert any(letters[f] not in ("U", own[f]) for f in folds)
    assert met


def test_only_clauses_that_are_needed_are_to_blame():
    def clause(folds, **signs):
        return Clause(frozenset(signs.items()), frozenset(folds))

    up, down = clause([(0, 1)], a=1), clause([(0, 2)], a=-1, b=1)
    rest, far_off = clause([(0, 3)], b=-1), clause([(0, 9), (0, 8), (0, 7)], c=1)
    assert to_blame([far_off, up, down, rest]) == {(0, 1), (0, 2), (0, 3)}
    square = [clause([(k, 9)], a=s, b=t) for k, (s, t) in enumerate([(1, 1), (1, -1), (-1, 1)])]
    last = clause([(4, 9)], a=-1, b=-1)
    assert to_blame([*square, last]) == {(0, 9), (1, 9), (2, 9), (4, 9)}


def test_reasons_in_words():
    pattern = single_vertex(4)
    one = vertex_conflicts(match(pattern, "MVVU"))
    assert one == {}
    words = {
        "FFMV": "neither up (it has one mountain only, 2-4) nor down (it has one valley only, 3-4)",
        "VVVV": "neither up (it has no mountain) nor down (it has no mountain)",
    }
    for letters, expected in words.items():
        assert vertex_conflicts(match(pattern, letters)) == {4: expected}
