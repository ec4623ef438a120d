"""What every result has: a verdict, a reason, a document of its schema; ways and certificates."""

from __future__ import annotations

import inspect
import json
from functools import cache

import pytest
import rooms
from jsonschema import Draft202012Validator

import exactfold
from exactfold import PROVED, UNDECIDED, Result, Verdict
from exactfold._support.results import Certified, Ways
from exactfold.errors import NotApplicableError
from exactfold.motion.panels.families import follow_family
from exactfold.pattern.families import single_vertex
from exactfold.pattern.opening import panels

RESULTS = {
    "branches of a sheet": lambda: exactfold.count("two-vertex"),
    "branches with exact roots": lambda: exactfold.count("flat-vertex", method="groebner"),
    "a single vertex": lambda: exactfold.count(single_vertex(5)),
    "branches undecided": lambda: exactfold.branches.count_branches(
        exactfold.random_square(4, seed=0), method="homotopy"
    ),
    "modes of panels": lambda: exactfold.count("zigzags"),
    "spaces of panels": lambda: exactfold.decompose(panels(single_vertex(5))),
    "a sheet that is rigid": lambda: exactfold.decompose("two-vertex"),
    "a branch": lambda: exactfold.branch("two-vertex", "+-"),
    "a branch with a rim": lambda: exactfold.branch(single_vertex(5), "+"),
    "shapes": lambda: exactfold.branches.count_shapes("two-vertex", {4: 1}),
    "letters of branches": lambda: exactfold.match("two-vertex", "MVVVMVM"),
    "letters of no branch": lambda: exactfold.match("two-vertex", "MMMMMMM"),
    "letters undecided": lambda: exactfold.match("random-8", {}, most=1),
    "letters over a rim": lambda: exactfold.match(single_vertex(5), "MMVMV"),
    "letters over no rim": lambda: exactfold.match(single_vertex(5), "MMVVV"),
    "letters of panels": lambda: exactfold.match("miura"),
    "letters of no panels": lambda: exactfold.match("zigzags"),
    "all letters": lambda: exactfold.design.all_assignments(single_vertex(5)),
    "all letters of panels": lambda: exactfold.design.panel_assignments("fish-base"),
    "flat-folded states": lambda: exactfold.flat("waterbomb"),
    "no flat-folded state": lambda: exactfold.flat("square-twist"),
    "no flat vertex": lambda: exactfold.flat("zigzags"),
    "torques": lambda: exactfold.actuate("two-vertex", "+-"),
    "a tolerance": lambda: exactfold.tolerance("two-vertex"),
    "a tolerance of panels": lambda: exactfold.tolerance("zigzags"),
    "a design": lambda: exactfold.design.designed(
        exactfold.pattern.load("two-vertex"), maximise="tolerance"
    ),
    "a motion": lambda: _motion(),
    "a motion of panels": lambda: _panel_motion(),
    "a motion of a family": lambda: _family_motion(),
    "a proved motion": lambda: exactfold.prove(_motion()).motion,
    "a proof": lambda: exactfold.prove(_motion()),
    "a proof of panels": lambda: exactfold.prove(_panel_motion()),
    "loops": lambda: exactfold.loops("two-vertex"),
    "loops undecided": lambda: exactfold.loops("single-vertex-4"),
    "a certificate checked": lambda: exactfold.check(_result("branches of a sheet").certificate()),
}


def _motion():
    return exactfold.follow("two-vertex", signs="+-", until="30deg", frames=2)


def _panel_motion():
    return exactfold.follow("zigzags", 3, until="30deg", frames=2)


def _family_motion():
    known = exactfold.match("bird-base")
    return follow_family(known.pattern, known.densities, frames=2)


@cache
def _result(name):
    return RESULTS[name]()


@pytest.fixture(params=RESULTS)
def result(request):
    return _result(request.param)


def test_every_public_class_with_a_status_is_told_by_a_verdict():
    for name, kind in rooms.public().items():
        if inspect.isclass(kind) and "status" in getattr(kind, "__annotations__", {}):
            assert kind.__annotations__["status"] == "Verdict", name


def test_a_result_is_one(result):
    assert isinstance(result, Result)
    assert isinstance(result.status, Verdict)
    assert isinstance(result.reason, str)
    assert "\n" not in result.reason
    assert result.reason or result.status is PROVED


def test_its_document_is_what_its_schema_says(result):
    document = result.to_dict()
    assert json.loads(json.dumps(document)) == document
    if "format" in document:
        kind = document["format"].removeprefix("exactfold ").removesuffix(" result")
        Draft202012Validator(exactfold.schema(kind)).validate(document)
    else:
        assert "proof" in repr(result).lower()


def test_a_sequence_of_ways_is_one(result):
    if not hasattr(result, "__len__"):
        assert not isinstance(result, Ways)
        return
    assert isinstance(result, Ways)
    assert result
    ways = [*result]
    assert len(ways) == len(result)
    assert [result[k] for k in range(len(result))] == ways
    assert list(result[:2]) == ways[:2]
    assert all(way in result for way in ways)


def test_a_certificate_of_what_is_proved_holds(result):
    if not hasattr(result, "certificate"):
        assert not isinstance(result, Certified)
        return
    if result.status is UNDECIDED:
        with pytest.raises(NotApplicableError):
            result.certificate()
        return
    assert exactfold.check(result.certificate()).status is PROVED
