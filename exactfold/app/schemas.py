"""Makes JSON Schemas of everything that `--json` prints from the types of the documents.

The type of a document is a `TypedDict` in the module with the function that makes the document. The
type checker compares the function with this type, and `schema` turns it into a JSON Schema.
"""

from __future__ import annotations

import ast
import inspect
from functools import cache
from importlib import import_module
from itertools import pairwise
from types import ModuleType, NoneType, UnionType
from typing import (
    Annotated,
    Any,
    Final,
    Literal,
    NotRequired,
    TypeAlias,
    Union,
    get_args,
    get_origin,
    get_type_hints,
    is_typeddict,
)

from exactfold.errors import UsageError

__all__ = ["schema"]

DOCUMENTS: Final = {
    "count": (
        "exactfold count --json",
        "branches.values.count_document:EnumeratedBranches",
        "branches.values.count_document:BranchesByTheorem",
        "branches.values.count_document:UndecidedBranches",
        "panels.count_document:ProvedPanels",
        "panels.count_document:UndecidedPanels",
    ),
    "count-stream": (
        "exactfold count --stream FILE --json",
        "branches.values.count_document:StreamedBranches",
        "branches.values.count_document:StreamedUndecided",
    ),
    "shapes": ("exactfold count --curvature --json", "branches.counting.shapes:ShapesDocument"),
    "periodic": (
        "exactfold count CELL --direction X,Y --json",
        "branches.periodic.result:PeriodicDocument",
    ),
    "directions": (
        "exactfold count CELL --direction all --json",
        "branches.periodic.directions_result:DirectionsDocument",
    ),
    "panel-cell": (
        "exactfold count CELL --json, of rigid panels",
        "panels.periodic.result:PanelCellDocument",
    ),
    "periodic-match": (
        "exactfold match CELL --json",
        "panels.periodic.result:PeriodicMatchDocument",
    ),
    "branch": (
        "exactfold branch --json, and each line of it",
        "branches.values.branch:BranchDocument",
        "motion.tubes.driven:DrivenBranchDocument",
    ),
    "match": ("exactfold match --json", "design.assignments.result:MatchDocument"),
    "starting": ("exactfold match --json of rigid panels", "design.panels.match:StartingDocument"),
    "vertices": ("exactfold vertices --json", "design.panels.vertex.document:VerticesDocument"),
    "flat": ("exactfold flat --json", "layers.document:FlatDocument"),
    "certify": ("exactfold certify --json", "app.commands.certify:CertifyDocument"),
    "export": ("exactfold export --json", "app.commands.export:ExportDocument"),
    "motion": (
        "exactfold fold --json",
        "motion.curves.motion_document:MotionDocument",
        "motion.curves.motion_document:PanelMotionDocument",
        "motion.curves.motion_document:RollingMotionDocument",
    ),
    "motions": ("exactfold motions --json", "motion.loops.matching:LoopsDocument"),
    "view": ("the document inside a page of exactfold view", "app.viewer.document:ViewDocument"),
    "actuate": (
        "exactfold actuate --json",
        "design.actuation.result:ActuationDocument",
        "design.actuation.panels.result:PanelActuationDocument",
    ),
    "tolerance": ("exactfold tolerance --json", "design.tolerance.result:ToleranceDocument"),
    "design": ("exactfold design --json", "design.moving.result:DesignDocument"),
    "assignments": (
        "exactfold assignments --json",
        "design.circles.assignment_list:AssignmentsDocument",
        "design.panels.panel_assignments:PanelAssignmentsDocument",
    ),
    "info": (
        "exactfold info --json",
        "app.commands.info:BranchesFactsDocument",
        "app.commands.info:DecomposedInfoDocument",
        "app.commands.info:PanelInfoDocument",
    ),
    "convert": ("exactfold convert --json", "app.commands.convert:ConvertDocument"),
    "check": ("exactfold check --json", "app.verbs.check_document:CheckDocument"),
    "examples": ("exactfold examples --json", "app.commands.examples:ExamplesDocument"),
    "study": ("exactfold study NAME --json", "app.commands.study:StudyDocument"),
    "study-row": ("exactfold study NAME --row ID --json", "app.commands.study:StudyRowDocument"),
    "studies": ("exactfold study --json", "app.commands.study:StudiesDocument"),
    "batch-line": (
        "a line of exactfold count --jsonl",
        "app.commands.several.document:CountedLine",
        "app.commands.several.document:FailedLine",
    ),
    "batch": (
        "exactfold count --jsonl OUT.jsonl --json",
        "app.commands.several.document:BatchDocument",
    ),
    "error": (
        "what any command prints with --json if it fails",
        "app.shell.shell:ErrorDocument",
    ),
}
"""For each schema by name: the command that prints such documents, and the types of them."""

_PRIMITIVE: Final = {
    str: "string",
    int: "integer",
    float: "number",
    bool: "boolean",
    NoneType: "null",
}

Parts: TypeAlias = dict[type, dict[str, Any]]
"""The schemas of the types inside a document."""


def schema(name: str) -> dict[str, Any]:
    """The JSON Schema (draft 2020-12) of a kind of output; it refers to no other file.

    Raises `UsageError` if no schema has this name.

    >>> schema("shapes")["properties"]["format"]
    {'const': 'exactfold shapes result'}
    """
    if name not in DOCUMENTS:
        raise UsageError(f"no schema {name!r}; there are: {', '.join(DOCUMENTS)}")
    title, *places = DOCUMENTS[name]
    types = [_at(place) for place in places]
    parts: Parts = {}
    head = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "$id": f"urn:exactfold:schema:{name}",
        "title": title,
    }
    whole = _object(types[0], parts) if len(types) == 1 else _any_of(types, parts)
    named = {kind.__name__: part for kind, part in parts.items()}
    return {**head, **whole, **({"$defs": dict(sorted(named.items()))} if parts else {})}


def _at(place: str) -> Any:
    module, _, name = place.partition(":")
    return getattr(import_module(f"exactfold.{module}"), name)


def _schema(kind: Any, parts: Parts) -> dict[str, Any]:
    """The schema of a type; for a `TypedDict` a reference to its schema, which goes to `parts`."""
    origin, arguments = get_origin(kind), get_args(kind)
    if origin is Annotated:
        constrained = _schema(arguments[0], parts)
        for constraint in arguments[1:]:
            constrained |= constraint.keywords
        return constrained
    if origin in (Union, UnionType):
        return _any_of(arguments, parts)
    if origin is Literal:
        return {"const": arguments[0]} if len(arguments) == 1 else {"enum": [*arguments]}
    if origin is list:
        return {"type": "array", "items": _schema(arguments[0], parts)}
    if origin is dict:
        return _by_key(*(_schema(argument, parts) for argument in arguments))
    if is_typeddict(kind):
        if kind not in parts:
            parts[kind] = _object(kind, parts)
        return {"$ref": f"#/$defs/{kind.__name__}"}
    return {} if kind is Any else {"type": _PRIMITIVE[kind]}


def _any_of(kinds: Any, parts: Parts) -> dict[str, Any]:
    return {"anyOf": [_schema(kind, parts) for kind in kinds]}


def _by_key(key: dict[str, Any], value: dict[str, Any]) -> dict[str, Any]:
    """The schema of a dictionary whose keys are texts; `key` may restrict them by a pattern."""
    if "pattern" not in key:
        return {"type": "object", "additionalProperties": value}
    by_pattern = {"patternProperties": {key["pattern"]: value}, "additionalProperties": False}
    return {"type": "object", **by_pattern}


def _object(kind: type, parts: Parts) -> dict[str, Any]:
    """The schema of a `TypedDict`, which allows its keys and no others."""
    properties, required = {}, []
    described = _described(kind)
    for key, value in get_type_hints(kind, include_extras=True).items():
        optional = get_origin(value) is NotRequired
        inner = _schema(get_args(value)[0] if optional else value, parts)
        properties[key] = inner | ({"description": described[key]} if key in described else {})
        if not optional:
            required.append(key)
    return {
        **({"description": inspect.cleandoc(kind.__doc__).split("\n")[0]} if kind.__doc__ else {}),
        "type": "object",
        "properties": properties,
        "required": required,
        "additionalProperties": False,
    }


def _described(kind: type) -> dict[str, str]:
    """For each key of a `TypedDict`, the string that follows it in the source."""
    module = import_module(kind.__module__)
    descriptions: dict[str, str] = {}
    if (definition := _classes(module).get(kind.__name__)) is None:
        return descriptions  # made by a call, which keys like "from" need
    for base in definition.bases:
        if isinstance(base, ast.Name) and is_typeddict(vars(module)[base.id]):
            descriptions |= _described(vars(module)[base.id])
    for field, text in pairwise(definition.body):
        match field, text:
            case (
                ast.AnnAssign(target=ast.Name(id=key)),
                ast.Expr(value=ast.Constant(value=str() as words)),
            ):
                descriptions[key] = " ".join(inspect.cleandoc(words).split())
    return descriptions


@cache
def _classes(module: ModuleType) -> dict[str, ast.ClassDef]:
    tree = ast.parse(inspect.getsource(module))
    return {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}
