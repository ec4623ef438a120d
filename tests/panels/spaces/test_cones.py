"""Several forms left on a space: components of sheets where they are one, and of a program."""

from __future__ import annotations

import shutil
from fractions import Fraction

import pytest
from flint import arb, ctx
from panel_sheets import crossed_stars, outlined, ring_of_fives, row_of_stars, two_stars
from test_oracles import answers, by_singular, degrees

from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED
from exactfold.panels.decomposition import decompose
from exactfold.panels.spaces import cones
from exactfold.panels.spaces.cones import cone_motions, is_one_family
from exactfold.panels.spaces.kernel import first_order, imposed
from exactfold.panels.spaces.quadratics import squares_of
from exactfold.panels.spaces.regular import Balls, Forms, in_balls, rank_at_least, truly_folds
from exactfold.panels.vertex.stars import bracket, stars
from exactfold.pattern.panel_pattern import PanelPattern

SINGULAR = shutil.which("Singular")


def twins() -> PanelPattern:
    """Two vertices with five folds that share one."""
    points = [(0, 0), (9, 0), (5, -4), (13, -3), (13, 4), (5, 5), (4, 5), (-4, 4), (-4, -3)]
    points += [(4, -4)]
    folds = [(0, 1), (0, 6), (0, 7), (0, 8), (0, 9), (1, 2), (1, 3), (1, 4), (1, 5)]
    return outlined([(Fraction(x), Fraction(y)) for x, y in points], folds, 2)


SHEETS = {
    "two stars": (two_stars(), {5: 1}, True),
    "twins": (twins(), {3: 1}, True),
    "row of stars": (row_of_stars(), {5: 1}, True),
    "crossed stars": (crossed_stars(), {5: 2}, False),
    "ring of fives": (ring_of_fives(), {3: 1}, True),
}


@pytest.mark.parametrize("name", SHEETS)
def test_components(name: str) -> None:
    pattern, known, true = SHEETS[name]
    result = decompose(pattern)
    assert result.status is PROVED
    assert result.second_order == known
    assert result.true == (known if true else None)
    assert result.found_true == (None if true else known)
    assert result.rigid is REFUTED


def motion_of(pattern: PanelPattern) -> Balls | None:
    moving = stars(pattern)
    return next(iter(cone_motions(moving, *first_order(moving), list(moving))), None)


@pytest.mark.parametrize("name", ["two stars", "twins", "row of stars", "ring of fives"])
def test_the_motion_is_a_regular_zero_of_all_forms(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    pattern, *_ = SHEETS[name]
    moving = stars(pattern)
    rows, size = first_order(moving)
    motion = motion_of(pattern)
    assert motion is not None
    forms = Forms(moving)
    monkeypatch.setattr(ctx, "prec", 128)
    for v, star in moving.items():
        sums = [forms.value(v, motion)]
        for axis in (0, 1):
            terms = zip(star.folds, star.directions, strict=True)
            sums.append(sum((motion[e] * arb(int(d[axis])) for e, d in terms), arb(0)))
        assert all(value.contains(0) and value.rad() < 1e-20 for value in sums)
    derivatives = forms.derivatives(moving, motion, in_balls(rows), size)
    assert rank_at_least(derivatives, len(moving))
    assert truly_folds(moving, motion)


def test_a_ring_is_decided_modulo_a_prime(monkeypatch: pytest.MonkeyPatch) -> None:
    """The ring is decided by signs, too; here these are not looked at."""
    pattern = ring_of_fives()
    monkeypatch.setattr(cones, "_by_signs", lambda *_: [])
    result = decompose(pattern)
    assert result.status is PROVED
    assert result.second_order == result.true == {3: 1}
    monkeypatch.setattr(cones, "one_component", lambda *_: False)
    assert motion_of(pattern) is None
    result = decompose(pattern)
    assert result.status is UNDECIDED
    assert result.reason.endswith(
        "conditions of vertices 0, 1, 2 remain, and exactfold could not solve them together"
    )
    assert result.found == {3: 1}


def test_bounds(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cones, "_MOST_FORMS", 2)
    assert motion_of(row_of_stars()) is None
    assert motion_of(two_stars()) is not None


def test_one_family_needs_all_conditions() -> None:
    moving = stars(two_stars())
    _, size = first_order(moving)
    assert is_one_family(moving, size, size, [0, 1])
    assert not is_one_family(moving, size, size, [0])
    assert not is_one_family(moving, size, size - 1, [0, 1])
    assert not is_one_family(moving, size + 1, size + 1, [0, 1])  # one condition depends on others


@pytest.mark.slow
def test_both_signs_of_the_discriminant_are_needed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without a negative one the zeros of the second form could be two sheets over the first."""
    sides = cones._sides
    monkeypatch.setattr(cones, "_sides", lambda *args: (sides(*args)[0], False))
    assert motion_of(two_stars()) is not None  # modulo a prime, both kinds of values are found
    monkeypatch.setattr(cones, "one_component", lambda *_: False)
    assert motion_of(two_stars()) is None


def test_a_form_of_rank_two_is_no_cone() -> None:
    """It is a product of two linear forms, although it has both signs."""
    moving = stars(two_stars())
    rows, size = first_order(moving)
    squares = squares_of(moving[0], rows, size)
    plane = imposed(rows, size, *(functional for _, functional in squares[2:]))
    assert len(squares_of(moving[0], *plane)) == 2
    assert not cone_motions(moving, *plane, [0])
    assert len(cone_motions(moving, rows, size, [0])) == 1


# --- Singular ------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.skipif(SINGULAR is None, reason="Singular is not installed")
@pytest.mark.parametrize("name", ["two stars", "twins", "crossed stars"])
def test_singular_finds_the_same_components(name: str) -> None:
    """Dimensions and degrees of the minimal primes over Q: 2^k for the cone of k forms."""
    pattern, *_ = SHEETS[name]
    assert by_singular(pattern) == degrees(pattern)


@pytest.mark.slow
@pytest.mark.skipif(SINGULAR is None, reason="Singular is not installed")
@pytest.mark.parametrize("name", ["two stars", "twins", "crossed stars"])
def test_singular_finds_no_more_over_the_complex_numbers(name: str) -> None:
    pattern, known, _ = SHEETS[name]
    moving = stars(pattern)
    rows, size = first_order(moving)
    density = {
        edge: "+".join(f"({x})*w({k})" for k, x in enumerate(row) if x)
        for edge, row in rows.items()
    }
    conditions = []
    for star in moving.values():
        pairs = list(zip(star.folds, star.directions, strict=True))
        conditions.append(
            "+".join(
                f"({bracket(d, c)})*({density[e]})*({density[f]})"
                for k, (f, c) in enumerate(pairs)
                for e, d in pairs[:k]
            )
        )
    program = f"""
        LIB "primdec.lib";
        ring r = 0, w(0..{size - 1}), dp;
        ideal i = {", ".join(conditions)};
        def s = absPrimdecGTZ(i); setring s; int k;
        for (k = 1; k <= size(absolute_primes); k++)
        {{ print("@" + string(absolute_primes[k][2])); }}
        quit;
    """
    assert sum(map(int, answers(program))) == sum(known.values())
