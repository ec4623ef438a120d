"""How a schema is made from the type of a document."""

from __future__ import annotations

from typing import Annotated, Any, Literal, NotRequired, TypedDict

import pytest
from jsonschema import Draft202012Validator

from exactfold._support.documents import FoldText, Keywords, Natural, Pair, Rational, Several
from exactfold.app.schemas import DOCUMENTS, Parts, _any_of, _at, _object, _schema, schema
from exactfold.errors import UsageError


class Named(TypedDict):
    name: str
    """What it is
    called."""


class Corner(Named):
    """A corner.

    More is not said.
    """

    vertex: Natural
    """By its number."""
    folds: NotRequired[list[FoldText]]


Keyed = TypedDict("Keyed", {"from": Corner, "to": Corner | None})


def valid(kind: Any, data: object) -> bool:
    parts: Parts = {}
    found = _schema(kind, parts)
    return Draft202012Validator(
        {**found, "$defs": {one.__name__: part for one, part in parts.items()}}
    ).is_valid(data)


def test_a_type_has_its_keys_and_no_others() -> None:
    assert _object(Corner, {}) == {
        "description": "A corner.",
        "type": "object",
        "properties": {
            "name": {"type": "string", "description": "What it is called."},
            "vertex": {"type": "integer", "minimum": 0, "description": "By its number."},
            "folds": {"type": "array", "items": {"type": "string", "pattern": "^[0-9]+-[0-9]+$"}},
        },
        "required": ["name", "vertex"],
        "additionalProperties": False,
    }


def test_types_inside_others_are_parts() -> None:
    parts: Parts = {}
    found = _object(Keyed, parts)
    assert found["properties"] == {
        "from": {"$ref": "#/$defs/Corner"},
        "to": {"anyOf": [{"$ref": "#/$defs/Corner"}, {"type": "null"}]},
    }
    assert list(parts) == [Corner]


@pytest.mark.parametrize(
    ("kind", "right", "wrong"),
    [
        (Natural, 0, -1),
        (int, 1, True),
        (int, 1, 1.5),
        (float, 1.5, "1.5"),
        (bool, True, 1),
        (str | None, None, 0),
        (Rational, "-2/3", "2/0"),
        (Pair[Rational], ["0", "1/2"], ["0"]),
        (Pair[Rational], ["0", "1/2"], ["0", 0.5]),
        (Several[int], [1], []),
        (Literal["a"], "a", "b"),
        (Literal["a", "b"], "b", "c"),
        (dict[FoldText, Natural], {"0-1": 2}, {"0": 2}),
        (dict[FoldText, Natural], {"0-1": 2}, {"0-1": -2}),
        (dict[str, Natural], {"any": 2}, {"any": "2"}),
        (dict[str, Any], {"any": None}, []),
        (Natural | Literal["auto"] | None, "auto", "automatic"),
        (Annotated[Natural, Keywords(maximum=3)], 3, 4),
        (Annotated[Natural, Keywords(maximum=3)], 0, -1),
        (Corner, {"name": "a", "vertex": 1}, {"name": "a"}),
        (Corner, {"name": "a", "vertex": 1, "folds": ["0-1"]}, {"name": "a", "vertex": 1, "b": 1}),
        (Keyed, {"from": {"name": "a", "vertex": 1}, "to": None}, {"from": None, "to": None}),
    ],
)
def test_what_a_type_says(kind: Any, right: object, wrong: object) -> None:
    assert valid(kind, right)
    assert not valid(kind, wrong)


def test_a_type_without_a_schema_is_a_defect() -> None:
    with pytest.raises(KeyError):
        _any_of([complex], {})


@pytest.mark.parametrize("name", DOCUMENTS)
def test_every_document_says_what_it_is(name: str) -> None:
    """A format and a version; `count --stream` prints a count with one key more."""
    title, *places = DOCUMENTS[name]
    for place in places:
        found = _object(_at(place), {})
        kind = name.removesuffix("-stream")
        assert found["properties"]["format"] == {"const": f"exactfold {kind} result"}
        assert list(found["properties"]["version"]) == ["const"]
        assert {"format", "version"} <= set(found["required"])
    assert schema(name)["title"] == title


def test_a_schema_that_there_is_not() -> None:
    with pytest.raises(UsageError, match="count-stream"):
        schema("fold")


def test_no_two_types_have_one_name() -> None:
    """The parts of a schema are named by their types."""
    parts: Parts = {}
    _any_of([_at(place) for _, *places in DOCUMENTS.values() for place in places], parts)
    assert len(parts) > 60
    assert len({kind.__name__ for kind in parts}) == len(parts)
