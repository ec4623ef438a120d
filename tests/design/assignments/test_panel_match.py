"""Whether rigid panels start to fold with letters: against all modes, samples, and forgeries."""

import json
import random
from fractions import Fraction
from itertools import combinations, product

import numpy as np
import pytest
from jsonschema import Draft202012Validator
from panel_sheets import tiling
from running import run
from scipy.optimize import linprog

import exactfold
from exactfold import checker
from exactfold._support.verdict import PROVED, REFUTED
from exactfold.design import PanelRefutation, match_certificate, match_panels
from exactfold.design.panels.first_order_program import FirstOrderProgram
from exactfold.design.panels.regular_motion import _System, regular_motion
from exactfold.design.panels.together import going_together
from exactfold.design.panels.vertex.reasons import vertex_reason
from exactfold.errors import NotApplicableError, UsageError
from exactfold.panels import decompose
from exactfold.panels.vertex.stars import Star, stars
from exactfold.pattern.panel_pattern import EnclosedPattern, PanelPattern

TURNED = str.maketrans("MV", "VM")


def assignments(pattern):
    """The letters of all folds in the sums of modes without a common vertex."""
    modes = decompose(pattern).modes
    found = set()
    for size in range(1, len(pattern.interior) + 1):
        for chosen in combinations(modes, size):
            if len({v for m in chosen for v in m.active}) < sum(len(m.active) for m in chosen):
                continue
            for sides in product((False, True), repeat=size):
                letters = dict.fromkeys(pattern.folds, "F")
                for mode, turned in zip(chosen, sides, strict=True):
                    for fold, letter in mode.assignment.items():
                        letters[fold] = letter.translate(TURNED) if turned else letter
                found.add("".join(letters.values()))
    return found


def test_all_letters_of_two_vertices_are_those_of_the_modes():
    pattern = tiling(2, 1)
    expected = assignments(pattern)
    assert expected
    for letters in map("".join, product("MV", repeat=len(pattern.folds))):
        found = match_panels(pattern, letters)
        assert found.starts is (PROVED if letters in expected else REFUTED)
        assert all(r.holds(pattern, found.letters) for r in found.refutations)
        if found.starts is PROVED:
            assert "".join(found.assignment.values()) == letters


def test_letters_with_free_and_flat_folds_are_those_of_the_modes():
    pattern, rng = tiling(2, 2), random.Random(1)
    full = sorted(assignments(pattern))
    answers = set()
    for number in range(14):
        own = list(rng.choice(full))
        for k in rng.sample(range(len(own)), 4):
            own[k] = rng.choice("MVFU" if number % 2 else "U")
        wanted = "".join(own)
        able = any(all(a in ("U", b) for a, b in zip(wanted, x, strict=True)) for x in full)
        found = match_panels(pattern, wanted)
        assert found.starts is (PROVED if able or not set(wanted) & {"M", "V"} else REFUTED)
        answers.add(found.starts)
    assert answers == {PROVED, REFUTED}


@pytest.mark.parametrize(
    "directions",
    [
        ((3, 1), (1, 4), (-3, 1), (-2, -3), (2, -3)),
        ((3, 0), (2, 3), (-1, 2), (-3, 1), (-1, -2), (2, -3)),
    ],
)
def test_a_vertex_is_refused_the_letters_that_no_sample_has(directions):
    count = len(directions)
    star = Star(0, tuple((0, k + 1) for k in range(count)), directions)
    seen = set(sampled(np.array(directions, dtype=float)))
    for letters in map("".join, product("MV", repeat=count)):
        reason = vertex_reason(star, dict(zip(star.folds, letters, strict=True)))
        assert (reason is None) == (letters in seen)


def sampled(d):
    """The letters of many solutions of both conditions at a vertex: two on each random line."""
    count = len(d)
    brackets = np.triu(np.outer(d[:, 0], d[:, 1]) - np.outer(d[:, 1], d[:, 0]), 1)
    form = brackets + brackets.T
    plane = np.linalg.svd(d.T)[2][2:]
    a, b = np.random.default_rng(3).standard_normal((2, 20_000, count - 2)) @ plane
    square, middle, rest = ((x @ form * y).sum(axis=1) for x, y in ((b, b), (a, b), (a, a)))
    bent = middle**2 - square * rest
    real = bent > 0
    for side in (1, -1):
        root = (-middle[real] + side * np.sqrt(bent[real])) / square[real]
        for w in (a[real] + root[:, None] * b[real]) > 0:
            yield "".join("V" if x else "M" for x in w)


def test_twists_are_refuted_by_vectors_that_forgeries_do_not_have():
    found = match_panels("square-twist")
    assert (found.starts, found.truly) == (REFUTED, REFUTED)
    (good,) = found.refutations
    pattern, letters = found.pattern, found.letters
    assert good.holds(pattern, letters)
    v, (x, y) = next(iter(good.planes.items()))
    for planes in (
        {**good.planes, v: (-x, -y)},
        {**good.planes, v: (float(x), float(y))},
        {**good.planes, v: (x + Fraction(1, 10**9), y)},
        {u: (Fraction(0), Fraction(0)) for u in good.planes},
        {**good.planes, max(pattern.boundary_set): (x, y)},
    ):
        assert not PanelRefutation(planes).holds(pattern, letters)
    free = dict.fromkeys(letters, "U")
    assert not good.holds(pattern, free)


def test_heights_refute_in_the_nappe_of_their_sign_alone():
    star = Star(0, ((0, 1), (0, 2), (0, 3), (0, 4)), ((2, 1), (-1, 1), (-1, -1), (1, -2)))
    letters = dict(zip(star.folds, "MVMV", strict=True))
    both = vertex_reason(star, letters).refutations
    assert {side for r in both for side in r.signs.values()} == {1, -1}
    for r in both:
        (side,) = r.signs.values()
        assert r.holds_on({0: star}, letters)
        assert not PanelRefutation({}, {0: -side}, r.heights).holds_on({0: star}, letters)
        upside = {key: -z for key, z in r.heights.items()}
        assert not PanelRefutation({}, r.signs, upside).holds_on({0: star}, letters)
        assert not PanelRefutation({}, {}, r.heights).holds_on({0: star}, letters)


def test_folds_that_stay_flat_have_no_letters():
    outline = [(0, 0), (4, 0), (4, 4), (0, 4), (2, 2)]
    edges = [(0, 1), (1, 2), (2, 3), (0, 3), (0, 4), (1, 4), (2, 4)]
    pattern = PanelPattern(outline, edges)
    found = match_panels(pattern, {(1, 4): "M"})
    assert (found.starts, found.truly) == (REFUTED, REFUTED)
    assert match_panels(pattern, {(0, 4): "M", (2, 4): "M"}).truly is PROVED
    other = match_panels(pattern, {(0, 4): "M", (2, 4): "V"})
    assert other.truly is REFUTED
    said = "at vertex 4 the folds 2-4 and 0-4 form one straight crease but have different letters"
    assert other.reasons == (said,)
    assert all(r.holds(pattern, other.letters) for r in other.refutations)
    assert match_panels(pattern, "FMU").starts is REFUTED


def test_a_sheet_that_is_asked_for_no_letter_is_not_said_to_fold():
    pattern = PanelPattern(
        [(0, 0), (4, 0), (0, 4), (1, 1)], [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]
    )
    for letters in ("UUU", "FFF"):
        found = match_panels(pattern, letters)
        assert (found.starts, found.densities) == (PROVED, {})
        words = "no fold has to be a mountain or a valley, so the flat sheet has these letters"
        assert found.lines == (words,)
    assert match_panels(pattern, "UUM").starts is REFUTED


def test_rounding_errors_of_the_derivative_are_bounded_where_its_terms_cancel():
    d = ((3, 0), (2, 3), (-1, 2), (-3, 1), (-1, -2), (2, -3))
    star = Star(0, tuple((0, k + 1) for k in range(6)), d)
    first = [cross(d[0], d[k]) for k in range(1, 6)]
    w = [0.7, 0.1, 0.3, -1 / 7, 0.9]
    w.append(-sum(c * x for c, x in zip(first, w[1:], strict=False)) / first[4])
    system = _System({0: star}, dict(zip(star.folds, w, strict=True)))
    matrix, _, terms = system.derivative()
    error = [
        abs(
            Fraction(matrix[2, j])
            - sum(Fraction(x) * cross(*sorted_pair(d, j, k)) for k, x in enumerate(w)) / 9
        )
        for j in range(6)
    ]
    bound = 14 * Fraction(2) ** -52
    assert error[0] > bound * abs(Fraction(matrix[2, 0]))
    assert all(e <= bound * Fraction(t) for e, t in zip(error, terms[2], strict=True))


def cross(a, b):
    return a[0] * b[1] - a[1] * b[0]


def sorted_pair(d, j, k):
    return (d[j], d[k]) if j < k else (d[k], d[j])


def test_larger_stars_are_proved_near_a_candidate_and_not_elsewhere():
    found = match_panels("bird-base")
    moving = stars(found.pattern)
    assert found.assignment == dict(found.letters)
    boxes = regular_motion(moving, found.densities)
    assert boxes is not None
    assert max(radius for _, radius in boxes.values()) > 0
    off = {edge: x * (1 + 0.01 * k) for k, (edge, x) in enumerate(found.densities.items())}
    assert regular_motion(moving, off) is None


def test_certificates_of_random_letters_verify():
    pattern, rng = tiling(2, 1), random.Random(2)
    answers = set()
    for number in range(10):
        letters = "".join(rng.choice("MV" if number % 2 else "MVVU") for _ in pattern.folds)
        found = match_panels(pattern, letters)
        claims = checker.check(checker.load(json.dumps(match_certificate(found))))
        assert (claims["starts"], claims["truly"]) == (str(found.starts), str(found.truly))
        answers.add(claims["starts"])
        if found.starts is REFUTED:
            first = found.first_order
            named = {*first.together, *first.never, *first.undecided}
            assert named == {fold for fold, x in found.letters.items() if x in "MV"}
            assert [list(fold) for fold in first.never] == claims["never"]
    assert answers == {"proved", "refuted"}


def test_no_certificate_is_written_of_positions_that_are_known_only_nearly():
    """The first edge of such a sheet may have no direction: only its folds need one."""
    exact = tiling(2, 1)
    directions = {fold: exact.direction(*fold) for fold in exact.folds}
    assert exact.edges[0] not in directions
    sheet = EnclosedPattern(exact.vertices, exact.edges, directions, Fraction(1, 10**9))
    found = match_panels(sheet, "M" * len(exact.folds))
    assert found.starts is REFUTED
    with pytest.raises(NotApplicableError, match="they are known only within"):
        match_certificate(found)


@pytest.mark.parametrize(("seed", "count"), [(0, 8), (1, 0), (6, 5)])
def test_folds_that_never_fold_are_those_that_no_program_moves(seed, count):
    """Against one linear program for each fold."""
    pattern, rng = tiling(2, 2), random.Random(seed)
    letters = {fold: rng.choice("MV") for fold in pattern.folds}
    moving = stars(pattern)
    found = going_together(moving, letters)
    assert (len(found.together), found.undecided) == (count, ())
    program = FirstOrderProgram(moving, letters)
    sides = {"V": (0, 1), "M": (-1, 0)}
    for k, fold in enumerate(program.folds):
        goal = np.zeros(len(program.folds))
        goal[k] = -1 if letters[fold] == "V" else 1
        bounds = [sides[letters[e]] for e in program.folds]
        zero = np.zeros(program.matrix.shape[0])
        best = linprog(goal, A_eq=program.matrix, b_eq=zero, bounds=bounds, method="highs")
        assert (-best.fun > 1e-9) == (fold in found.together)


def test_what_the_programs_propose_for_some_of_the_folds():
    found = match_panels("square-twist")
    program = FirstOrderProgram(stars(found.pattern), found.letters)
    assert program.motion() is None
    (refutation,) = found.refutations
    some = program.lettered[:2]
    motion = program.motion(some)
    assert all((motion[f] > 0) == (found.letters[f] == "V") for f in some)
    assert program.refutation(some) is None
    assert program.refutation().planes.keys() == refutation.planes.keys()


@pytest.mark.parametrize("letters", ["M", {(0, 1): "M"}, "X" * 12, 3, {(0, 99): "V"}])
def test_letters_that_do_not_fit_are_refused(letters):
    with pytest.raises(UsageError):
        match_panels("square-twist", letters)


def test_the_command_says_whether_panels_start_to_fold(tmp_path):
    schema = Draft202012Validator(exactfold.schema("starting"))
    for name, starts, code in (("bird-base", "proved", 0), ("square-twist", "refuted", 1)):
        done = run("match", name, "--json")
        data = json.loads(done.stdout)
        schema.validate(data)
        assert (data["starts"], data["status"], done.exit_code) == (starts, "proved", code)
        assert len(data["matches"]) == (starts == "proved")
    assert (data["together"], len(data["never"])) == ([], 12)
    proof = tmp_path / "proof.json"
    words = run("match", "square-twist", "--certificate", proof).stdout
    assert checker.verify(proof)["starts"] == "refuted"
    assert "- 12 never fold: 4-5, 4-7" in words
    assert "does not start to fold" in words
    assert "4, 5, 6, 7" in words
    assert "not even to first order" in words.replace("\n", " ")


def test_a_motion_far_from_the_first_order_ones_is_found():
    """A bird base with a diagonal: the forms are far from 0 where the search begins."""
    x = Fraction(7, 3)
    points = [(-4, -4), (-4, 0), (0, -4), (4, 4), (0, 4), (4, 0), (0, 0), (-4, 4), (4, -4)]
    points += [(-x, 0), (x, 0), (0, x), (0, -x)]
    border = "0-1 1-7 4-7 3-4 3-5 5-8 2-8 0-2"
    mountains = "0-9 0-12 3-10 3-11 6-9 6-10 6-11 6-12 7-9 7-11 8-10 8-12"
    valleys = "1-9 2-12 4-11 5-10 6-7 6-8"
    edges = [tuple(map(int, e.split("-"))) for e in f"{border} {mountains} {valleys}".split()]
    letters = dict.fromkeys(edges[8:20], "M") | dict.fromkeys(edges[20:], "V")
    found = match_panels(PanelPattern(points, edges), letters)
    assert (found.starts, found.truly) == (PROVED, PROVED)
    assert checker.check(match_certificate(found))["truly"] == "proved"
