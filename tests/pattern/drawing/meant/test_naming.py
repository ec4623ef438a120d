"""Relations that users delete and state, by name."""

from __future__ import annotations

from fractions import Fraction

import pytest

from exactfold.errors import UsageError
from exactfold.pattern.drawing.meant.inference import Inference, infer
from exactfold.pattern.drawing.meant.naming import parsed
from tests.pattern.drawing.meant.test_inference import miura, noisy

SHEET = miura()
POINTS = noisy(list(SHEET.vertices), 1e-12)


def inferred(**choices: object) -> Inference:
    return infer(POINTS, SHEET.edges, SHEET.boundary_edges, **choices)  # type: ignore[arg-type]


def names(inference: Inference) -> set[str]:
    return {relation.name for relation in inference.relations}


@pytest.mark.parametrize(
    "text", ["straight@5:4-6", "straight @5: 6 - 4", "STRAIGHT@5 4-6", " straight@5:4-6 "]
)
def test_spaces_and_capitals_do_not_matter(text: str) -> None:
    assert parsed(text).fits(parsed("straight@5:4-6"))


@pytest.mark.parametrize("text", ["", "curved@5", "straight@x", "parallel:3", "5", "grid:3-4;"])
def test_text_that_names_no_relation_is_refused(text: str) -> None:
    with pytest.raises(UsageError, match="names no relation: write the kind"):
        inferred(without=[text])


def test_a_relation_is_deleted_by_its_name_or_by_its_vertex() -> None:
    whole = names(inferred())
    assert whole - names(inferred(without=["straight@5:4-6"])) == {"straight@5:4-6"}
    assert whole - names(inferred(without=["straight@5"])) == {"straight@5:4-6"}
    gone = whole - names(inferred(without=["kawasaki"]))
    assert gone == {name for name in whole if name.startswith("kawasaki")}


def test_a_relation_that_others_imply_is_named_with_them() -> None:
    inference = inferred(without=["kawasaki@5"])
    assert set(inference.implied) == {"kawasaki@5"}
    assert "straight@5:4-6" in inference.implied["kawasaki@5"]
    assert inference.independent == inferred().independent


def test_a_relation_that_nothing_implies_leaves_an_angle_free() -> None:
    inference = inferred(without=["straight@5", "kawasaki@5"])
    assert inference.implied == {}
    assert inference.independent == inferred().independent - 1


def test_a_relation_that_does_not_exist_is_refused_with_those_nearby() -> None:
    with pytest.raises(UsageError, match=r"no relation 'straight@5:1-9': nearby .*straight@5:4-6"):
        inferred(without=["straight@5:1-9"])
    with pytest.raises(UsageError, match="nothing was inferred"):
        infer(SHEET.vertices, SHEET.edges, SHEET.boundary_edges, without=["straight@5"])


def test_a_stated_relation_holds() -> None:
    points = list(SHEET.vertices)
    assert infer(points, SHEET.edges, SHEET.boundary_edges).relations == ()
    inference = infer(points, SHEET.edges, SHEET.boundary_edges, unit=24, also=["grid 0-4"])
    assert inference.angles is not None
    assert inference.angles.constants[0, 4] == Fraction(1, 12)
    assert inference.angles.constants[4, 8] == Fraction(-1, 12)
    assert inference.angles.free == ()
    assert names(inference) > {"straight@5:4-6", "kawasaki@5"}, "exact relations are kept"


def test_a_stated_relation_that_was_found_anyway_counts_once() -> None:
    """Also if it is stated as one of another kind with the same edges, or twice."""
    found = names(inferred())
    assert "straight@5:4-6" in found
    same = ["straight@5:4-6", "parallel:4-5,5-6", "grid:5-6,4-5", "kawasaki@5"]
    assert names(inferred(also=same)) == found
    new = "parallel:1-5,2-6"
    assert new not in found
    assert len(inferred(also=[new, new]).relations) == len(inferred().relations) + 1


def test_a_stated_relation_that_contradicts_others_is_refused_by_name() -> None:
    flat = miura(rise=Fraction(1, 12))
    stated = ["grid:1-5", "sectors@5:6-1,1-4"]  # 1-5 is at 3 degrees, and at 0
    with pytest.raises(UsageError, match=r"sectors@5:6-1,1-4 contradicts .*grid:1-5"):
        infer(list(flat.vertices), flat.edges, flat.boundary_edges, unit=60, also=stated)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("straight@99:1-2", "there is no vertex 99"),
        ("straight@5:4-7", "no edge joins vertices 5 and 7: 5 is joined to"),
        ("straight@5", "does not say which edges"),
        ("parallel:0-4", "does not say which edges"),
        ("parallel:0-4,0-4", "does not say which edges"),
        ("parallel:0-9,0-4", "there is no edge 0-9; nearby there are"),
        ("parallel:0-1,0-4", "by 77 degrees"),
        ("kawasaki@0", "vertices inside the sheet"),
        ("border@5", "not on the boundary"),
    ],
)
def test_stated_relations_that_cannot_be_are_refused(text: str, message: str) -> None:
    with pytest.raises(UsageError, match=message):
        inferred(also=[text])


def test_noise_and_unit_must_be_positive() -> None:
    with pytest.raises(UsageError, match="between 0 and 1, not 0"):
        inferred(noise=0.0)
    with pytest.raises(UsageError, match="positive integer N, not 0"):
        inferred(unit=0)


def test_a_stated_noise_level_overrules_the_gate() -> None:
    points = [(Fraction(round(x * 200), 200), Fraction(round(y * 200), 200)) for x, y in POINTS]
    doubted = infer(points, SHEET.edges, SHEET.boundary_edges)
    assert doubted.relations == ()
    forced = infer(points, SHEET.edges, SHEET.boundary_edges, noise=1e-3)
    assert {"straight@5:4-6", "kawasaki@5"} <= names(forced)
